"""Builds the module needlework._core with CMake, for pip; the rest is in pyproject.toml."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
VERSION = re.search(r"project\(Needlework VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


class BuildWithCMake(build_ext):
    def build_extension(self, extension):
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja",
                        "-DCMAKE_BUILD_TYPE=Release", "-DNEEDLEWORK_TESTS=OFF",
                        f"-DNEEDLEWORK_PYTHON={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "needlework_python"], check=True)
        built, = (build / "python/needlework").glob("_core*.so")
        self.copy_file(str(built), str(target))
        # Scenes and claims of the paper, which CMake has put into the package.
        paper = Path("needlework/reproduce/paper")
        shutil.copytree(build / "python" / paper, target.parent.parent / paper, dirs_exist_ok=True)


setup(version=VERSION, ext_modules=[Extension("needlework._core", sources=[])],
      cmdclass={"build_ext": BuildWithCMake})
