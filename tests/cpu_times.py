#!/usr/bin/env python3
"""Names the tests of a run of ctest that took much CPU time, with their children.

    tests/cpu_times.py LOG [--warn SECONDS] [--fail SECONDS]

LOG is Testing/Temporary/LastTest.log of the build folder. Tests above --warn (3 s) belong to the long
ones: their names should end in _long, or scripts have that label (tests/CMakeLists.txt), beside a short
test of the same subject. One above --fail (8 s) ends this with exit code 1, unless it is below --share
(2 %) of what all tests took: a slow hour of a machine must not fail it, and all tests are slower then.
"""

import argparse
import re
import sys

TEST = re.compile(r"^\d+/\d+ Testing: (.*)$")
TIME = re.compile(r"^CPU time ([0-9.]+) s$")


def times(lines):
    """(name, CPU seconds) of each test of the log."""
    name, seconds, found = None, None, []
    for line in lines:
        if begins := TEST.match(line):
            if seconds is not None:
                found.append((name, seconds))
            name, seconds = begins[1], None
        elif took := TIME.match(line):
            seconds = float(took[1])  # the last one: a test may run others
    if seconds is not None:
        found.append((name, seconds))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("log")
    parser.add_argument("--warn", type=float, default=3)
    parser.add_argument("--fail", type=float, default=8)
    parser.add_argument("--share", type=float, default=0.02)
    arguments = parser.parse_args()
    with open(arguments.log, encoding="utf-8", errors="replace") as log:
        found = times(log.read().splitlines())
    if not found:
        sys.exit(f"{arguments.log}: has no CPU times: expected the log of tests that ran")
    for name, seconds in sorted(found, key=lambda each: -each[1]):
        if seconds > arguments.warn:
            print(f"{seconds:6.1f} s of CPU: {name}")
    slowest = max(seconds for _, seconds in found)
    total = sum(seconds for _, seconds in found)
    print(f"{len(found)} tests took {total:.0f} s of CPU, the longest {slowest:.1f} s.")
    most = max(arguments.fail, arguments.share * total)
    if slowest > most:
        sys.exit(f"expected at most {most:.3g} s for each: name it ..._long, or shorten it")


if __name__ == "__main__":
    main()
