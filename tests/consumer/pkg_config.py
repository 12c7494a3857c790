"""Installs the build into a new prefix, compiles programs in C or Fortran there as their users do,
with pkg-config, and runs them: examples/, the programs that docs/c.md shows, and those of tests/consumer/fortran.

    pkg_config.py c|fortran BUILD ROOT FLAGS

FLAGS are those of the C++ compiler, of which programs need the sanitizers. Exits with 77 if there
is no compiler or no pkg-config.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]

# What examples/c prints.
EXAMPLES = {
    "data": """\
notes: {"lid": "open"}
""",
    "first_contact": """\
time 1, 0.25 from the centre of the rod
""",
    "mixture": """\
light: T_tr 0.456, T_rot 0.470
heavy: T_tr 0.678, T_rot 0.570
light with heavy: 2008
""",
    "continued": "time 10, energy 1.64307\n",
    "every_collision": "energy lost per needle: 1.2809\n",
    "sizes": """\
shorter than 1: 239, T_tr 0.090
longer than 1: 161, T_tr 0.067
""",
}

# What fortran/images.f90 prints: the first needle has left the box twice, once at either end.
IMAGES = """\
images of the first needle 8 -8 8
images of the second needle -2147481599 0 2147481599
the first needle is now at  1.0000  1.0000  4.0000
state: needle 1: image = -2147483648: expected a whole number from -2147481599 to 2147481599
"""

# What fortran/all.f90 prints.
ALL = """\
has scalar and nonsense: 10
box 5.0 6.0 7.0
stopped by 1
events counted: T
counters have names: T
effects: elastic
needles have no width 0.0 0.0 0.0833
contacts 0 0.0 0.0
growth  1.0 0.0 0.0
kinds: 1 -1
data: 0 3 T
named bytes
data: notes = {"a": expected JSON in UTF-8
first contact 2.0000 0.2500
of a rod and a sphere 1.3876 0.2500
theory T  1.0  0.0T
"""

# What fortran/mixture.f90 prints: the long needle, of four times the mass, gives the short one 8/5 of
# its velocity and keeps 3/5, as both are hit in their centres.
MIXTURE = """\
species short 1  0.50  1.00  0.8533
species long 2  1.00  4.00  0.2400
long with short: 1  1.0 -1.0
species of the needles 1 0 1
lengths and masses  1.0  0.5  1.0  4.0  1.0  9.0
"""


def skip_without(*programs):
    for program in programs:
        if not shutil.which(program):
            print(f"skipped: {program} is not installed")
            sys.exit(77)


def check(name, condition, out):
    print(f"{name}:\n{out}")
    assert condition, name


class Installed:
    def __init__(self, build, folder, flags):
        self.folder = folder
        prefix = folder / "prefix"
        self.run("cmake", "--install", build, "--prefix", prefix)
        library, = prefix.glob("lib*/**/libneedlework.so")
        self.environment = {**os.environ, "LD_LIBRARY_PATH": str(library.parent),
                            "PKG_CONFIG_PATH": str(library.parent / "pkgconfig")}
        self.sanitizers = [flag for flag in flags.split() if flag.startswith("-fsanitize=")]

    def run(self, *command):
        done = subprocess.run([str(part) for part in command], cwd=self.folder, text=True,
                              capture_output=True, timeout=600,
                              env=getattr(self, "environment", None))
        assert done.returncode == 0, (command, done.returncode, done.stdout, done.stderr)
        return done.stdout

    def build_and_run(self, compiler, *sources):
        """What the program prints."""
        options = self.run("pkg-config", "--cflags", "--libs", "needlework").split()
        self.run(*compiler, *WARNINGS, *sources, *options, *self.sanitizers, "-o", "program")
        return self.run("./program")


def in_c(installed, root):
    compiler = ["cc", "-std=c11"]
    version = re.search(r"project\(Needlework VERSION (\S+)", (root / "CMakeLists.txt").read_text())
    assert installed.run("pkg-config", "--modversion", "needlework").strip() == version[1]

    out = installed.build_and_run(compiler, root / "examples/c/smallest.c")
    check("smallest.c", re.search(r", 10000 collisions, .*\nhash [0-9a-f]{32}\n$", out), out)
    out = installed.build_and_run(compiler, root / "examples/c/own_arrays.c")
    check("own_arrays.c", out.startswith("9/10 of the energy lost after "), out)
    for name, expected in EXAMPLES.items():
        out = installed.build_and_run(compiler, root / f"examples/c/{name}.c")
        check(f"{name}.c", out == expected, out + "expected:\n" + expected)

    # What the guide shows, and what it says that it prints.
    text = (root / "docs/c.md").read_text()
    programs = re.findall(r"^```c\n(#include.*?)^```\n(?:.*?^```\n(.*?)^```)?", text,
                          flags=re.M | re.S)
    assert programs, "docs/c.md: expected programs"
    for number, (program, expected) in enumerate(programs):
        source = installed.folder / f"guide{number}.c"
        source.write_text(program)
        out = installed.build_and_run(compiler, source)
        check(source.name, out == expected, out + "expected:\n" + expected)


def in_fortran(installed, root):
    compiler = ["gfortran", "-std=f2018"]
    folder = root / "examples/fortran"
    out = installed.build_and_run(compiler, folder / "needlework.f90", folder / "cooling.f90")
    seen = re.search(r"^(\d+) collisions seen", out, re.M)
    last = re.findall(r", (\d+) collisions$", out, re.M)[-1]
    check("cooling.f90", seen and seen[1] == last == "2560", out)

    out = installed.build_and_run(compiler, folder / "needlework.f90",
                                  root / "tests/consumer/fortran/images.f90")
    check("images.f90", out == IMAGES, out + "expected:\n" + IMAGES)

    out = installed.build_and_run(compiler, folder / "needlework.f90",
                                  root / "tests/consumer/fortran/all.f90")
    check("all.f90", out == ALL, out + "expected:\n" + ALL)

    out = installed.build_and_run(compiler, folder / "needlework.f90",
                                  root / "tests/consumer/fortran/mixture.f90")
    check("mixture.f90", out == MIXTURE, out + "expected:\n" + MIXTURE)

    # The module has all functions of the header.
    declared = set(re.findall(r"NEEDLEWORK_API[^;]*?\b(needlework_\w+)\(",
                              (root / "include/needlework.h").read_text()))
    missing = declared - set(re.findall(r"(?:function|subroutine) (needlework_\w+)\(",
                                        (folder / "needlework.f90").read_text()))
    check("needlework.f90", declared and not missing, f"missing: {sorted(missing)}")


def main(language, build, root, flags=""):
    skip_without("pkg-config", "gfortran" if language == "fortran" else "cc")
    with tempfile.TemporaryDirectory() as folder:
        installed = Installed(Path(build).resolve(), Path(folder), flags)
        (in_fortran if language == "fortran" else in_c)(installed, Path(root).resolve())


if __name__ == "__main__":
    main(*sys.argv[1:])
