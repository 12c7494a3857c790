#!/usr/bin/python3
"""How many event loops are compiled, how large they and the program are, and how long the compiler
takes: bench/results/build.md.

    bench/build_cost.py                  about three minutes on two quiet cores
    bench/build_cost.py --dry            prints the table, changes no file

Builds the program once more, without tests and benchmarks and without a compiler cache, in a temporary
folder. Times are of a core, and those of all processes together.
"""

import argparse
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path

import measured
from instructions import build_of
from readme import put_result

LOOPS = r"needlework::((?:Event|Parallel)Loop<.*?>)::advance"


def output_of(*command, cwd=None):
    return subprocess.run(command, cwd=cwd, check=True, stdout=subprocess.PIPE, text=True).stdout


def cpu_seconds(*command, cwd=None):
    """Of the command and of all that it started."""
    def used():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before = used()
    output_of(*command, cwd=cwd)
    return used() - before


def machine_code(*files):
    """Bytes of instructions and constants."""
    rows = output_of("size", *map(str, files)).splitlines()[1:]
    return sum(int(row.split()[0]) for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, metavar="FILE",
                        default=measured.ROOT / "build/release/needlework",
                        help="names the compiler and its flags")
    parser.add_argument("--dry", action="store_true", help="change no file")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        build = Path(name)
        os.environ["CCACHE_DISABLE"] = "1"
        output_of("cmake", "--preset", "release", "-B", name, "-D", "NEEDLEWORK_TESTS=OFF",
                  "-D", "NEEDLEWORK_BENCH=OFF", cwd=measured.ROOT)
        targets = output_of("ninja", "-C", name, "-t", "targets", "all")
        objects = re.findall(r"^(\S*/engine/loops/\S*\.o):", targets, re.M)
        others = ("--quiet", "needlework")
        seconds_of_loops = cpu_seconds("ninja", "-C", name, "--quiet", *objects)
        seconds = seconds_of_loops + cpu_seconds("ninja", "-C", name, *others)
        program = build / "needlework"
        loops = set(re.findall(LOOPS, output_of("nm", "-C", "--defined-only", str(program))))
        several = sum(loop.startswith("Parallel") for loop in loops)
        rows = [
            ["event loops", f"{len(loops)}, of these {several} of several threads"],
            ["their machine code", f"{machine_code(*(build / o for o in objects)) / 1e6:.2f} MB"],
            ["that of the program", f"{machine_code(program) / 1e6:.2f} MB"],
            ["compiling the loops", f"{seconds_of_loops:.0f} s of a core"],
            ["building the program", f"{seconds:.0f} s of a core"],
        ]
    about, _ = build_of(arguments.program)
    text = (f"`bench/build_cost.py`: commit {measured.commit()}, {about['compiler']}, "
            f"{about['flags']}.\n\n") + measured.table(["what", "how much"], rows)
    print(text)
    if not arguments.dry:
        put_result("build.md", "What is compiled, and what that takes", text)


if __name__ == "__main__":
    main()
