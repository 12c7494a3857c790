"""Builds the module needlework._core with CMake, for pip; the rest is in pyproject.toml."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
VERSION = re.search(r"project\(Needlework VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


class BuildWithCMake(build_ext):
    """Of a build folder that is there, if NEEDLEWORK_BUILD names one, or of one of its own."""

    def build_extension(self, extension):
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = os.environ.get("NEEDLEWORK_BUILD")
        if not build:
            build = Path(self.build_temp).resolve()
            build.mkdir(parents=True, exist_ok=True)
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja",
                            "-DCMAKE_BUILD_TYPE=Release", "-DNEEDLEWORK_TESTS=OFF",
                            f"-DNEEDLEWORK_PYTHON={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "needlework_python",
                        "needlework_python_files"], check=True)
        with tempfile.TemporaryDirectory() as prefix:
            subprocess.run(["cmake", "--install", build, "--component", "python", "--strip",
                            "--prefix", prefix], check=True)
            built, = Path(prefix).rglob("needlework/_core*.so")
            self.copy_file(str(built), str(target))
            # Scenes and claims of the paper, which CMake has put into the package.
            paper = Path("reproduce/paper")
            shutil.copytree(built.parent / paper, target.parent / paper, dirs_exist_ok=True)


setup(version=VERSION, ext_modules=[Extension("needlework._core", sources=[])],
      cmdclass={"build_ext": BuildWithCMake})
