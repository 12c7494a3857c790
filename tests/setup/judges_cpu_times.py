#!/usr/bin/env python3
"""tests/cpu_times.py names tests above 3 s and fails above 8 s, of logs as ctest writes them."""

import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).parents[1] / "cpu_times.py"


def judge(seconds):
    log = "".join(f"""{n}/9 Testing: Suite.Takes{time}
Output:
----------------------------------------------------------
CPU time 99.00 s is what a test may print itself
CPU time {time} s
<end of output>
""" for n, time in enumerate(seconds, 1))
    with tempfile.NamedTemporaryFile("w", suffix=".log") as file:
        file.write(log)
        file.flush()
        return subprocess.run([sys.executable, SCRIPT, file.name], capture_output=True, text=True)


def main():
    quick, long, endless, none = judge(["0.01", "2.99"]), judge(["0.01", "3.01"]), \
        judge(["7.9", "8.01"]), judge([])
    slow_hour = ["2.5"] * 300
    in_it, too_long = judge(slow_hour + ["14"]), judge(slow_hour + ["18"])
    assert quick.returncode == 0 and "Takes" not in quick.stdout, quick
    assert "2 tests took 3 s of CPU, the longest 3.0 s." in quick.stdout, quick
    assert long.returncode == 0 and "3.0 s of CPU: Suite.Takes3.01" in long.stdout, long
    assert endless.returncode == 1 and "Takes8.01" in endless.stdout, endless
    assert "Takes7.9" in endless.stdout and "at most 8 s" in endless.stderr, endless
    assert in_it.returncode == 0 and "Takes14" in in_it.stdout, in_it
    assert too_long.returncode == 1 and "at most 15.4 s" in too_long.stderr, too_long
    assert none.returncode == 1 and "has no CPU times" in none.stderr, none


if __name__ == "__main__":
    main()
