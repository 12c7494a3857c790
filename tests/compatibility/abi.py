#!/usr/bin/python3
"""The C interface of libneedlework.so is the one that is described in libneedlework.abi.

    abi.py LIBRARY            exit code 1, and what has changed, if it is another
    abi.py LIBRARY --write    describes it; functions and structures may have changed with the soname
    abi.py LIBRARY --faults   changes in copies of the header are found

What is described is needlework.h alone: a library is compiled from it with functions that do nothing,
so that the description depends neither on how the real one is compiled nor on C++ behind it. That the
real one exports the same functions, of which the compiler has seen the same declarations, is what
tests/c/exports.py tests. Exit code 77: abidw and abidiff (Debian's abigail-tools) are not installed.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DESCRIPTION = Path(__file__).with_name("libneedlework.abi")
HEADER = (ROOT / "include/needlework.h").read_text()
# Bits of the exit code of abidiff.
ERROR, USAGE, CHANGED, INCOMPATIBLE = 1, 2, 4, 8


def run(*command):
    return subprocess.run([str(part) for part in command], text=True, capture_output=True, check=False)


def soname_of(library):
    dynamic = run("readelf", "--dynamic", "--wide", library).stdout
    return re.search(r"\(SONAME\).*\[(.*)\]", dynamic)[1]


def compile_stubs(header, soname, folder):
    """A library with all functions that the header declares."""
    (folder / "needlework.h").write_text(header)
    code = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
    functions = re.findall(r"^NEEDLEWORK_API\b[^;]*?\bneedlework_\w+\([^;]*\)(?=;)", code, flags=re.M)
    assert len(functions) > 20, functions
    source = folder / "stubs.c"
    source.write_text("#include \"needlework.h\"\n" + "".join(
        f"{function} {{ __builtin_trap(); }}\n" for function in functions))
    library = folder / soname
    done = run("cc", "-std=c11", "-g", "-O0", "-fPIC", "-shared", "-w", f"-Wl,-soname,{soname}",
               f"-ffile-prefix-map={folder}=.", f"-Wl,--version-script={ROOT / 'src/c/needlework.map'}",
               source, "-o", library)
    assert done.returncode == 0, done.stderr
    return library


def described_soname():
    return re.search(r"soname='([^']*)'", DESCRIPTION.read_text())[1]


def describe(library, to):
    done = run("abidw", "--no-corpus-path", "--no-comp-dir-path", "--no-show-locs",
               "--out-file", to, library)
    assert done.returncode == 0, done.stderr


def compare(description, header, soname):
    """The exit code of abidiff, and what it says."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        library = compile_stubs(header, soname, folder)
        done = run("abidiff", "--no-show-locs", description, library)
        assert not done.returncode & (ERROR | USAGE), done.stdout + done.stderr
        return done.returncode, done.stdout


def breaks_nothing(said):
    """Whether nothing but functions is new in what abidiff says."""
    counts = re.findall(r"^(?:Functions|Variables) changes summary: (\d+) Removed, (\d+) Changed.*, \d+ Added",
                        said, re.M)
    return all(removed == changed == "0" for removed, changed in counts)


def faults(soname):
    """What a change of the header must be."""
    member = re.search(r"^  double t_tr;", HEADER, re.M)
    parameter = re.search(r"^(NEEDLEWORK_API \w+ needlework_run_until\()[^)]*\)", HEADER, re.M)
    assert member and parameter, "expected totals with t_tr, and needlework_run_until()"
    after = HEADER.index("NEEDLEWORK_API", parameter.end())
    changes = {
        "an unchanged header": (HEADER, 0),
        "a new function": (HEADER[:after] + "NEEDLEWORK_API int needlework_new(int number);\n"
                           + HEADER[after:], CHANGED),
        "a function less": (HEADER.replace(parameter[0], "int needlework_hidden(void)", 1),
                            CHANGED | INCOMPATIBLE),
        "a new member": (HEADER[:member.start()] + "  double added;\n" + HEADER[member.start():],
                         CHANGED),
        "another type": (HEADER[:member.start()] + "  float t_tr;" + HEADER[member.end():], CHANGED),
    }
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        description = folder / "described.abi"
        describe(compile_stubs(HEADER, soname, folder), description)
        for what, (header, expected) in changes.items():
            code, said = compare(description, header, soname)
            assert code == expected, f"{what}: abidiff ended with {code}, not {expected}\n{said}"
            is_compatible = what in ("an unchanged header", "a new function")
            assert breaks_nothing(said) == is_compatible, f"{what}: {said}"


def main(library, *options):
    if not shutil.which("abidw") or not shutil.which("abidiff"):
        print("skipped: expected abidw and abidiff (package abigail-tools)")
        return 77
    soname = soname_of(library)
    if "--faults" in options:
        faults(soname)
        return 0
    code, said = compare(DESCRIPTION, HEADER, soname)
    if "--write" in options and (soname != described_soname() or breaks_nothing(said)):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            describe(compile_stubs(HEADER, soname, folder), DESCRIPTION)
        return 0
    if code:
        print(f"""{said}
The C interface is not what {DESCRIPTION.relative_to(ROOT)} says. Functions may be added in a minor
version. Where structures or functions changed, compiled programs break: count SOVERSION in
CMakeLists.txt up, once for a release. Then describe the interface again: tests/compatibility/write.sh""")
    return 1 if code else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
