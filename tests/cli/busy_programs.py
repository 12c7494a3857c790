"""Busy programs of busy_machine.py end with the program that started them, also when it is killed."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

SCRIPT = """
import time
from busy_machine import load
with load(2):
    print("busy", flush=True)
    time.sleep(600)
"""


def children(pid):
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def main():
    for ending in (signal.SIGTERM, signal.SIGKILL):
        script = subprocess.Popen([sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE,
                                  cwd=Path(__file__).resolve().parent)
        script.stdout.readline()
        busy = children(script.pid)
        assert len(busy) == 2, busy
        script.send_signal(ending)
        script.wait()
        latest = time.monotonic() + 60
        while any(map(runs, busy)):
            if time.monotonic() > latest:
                for pid in filter(runs, busy):
                    os.kill(pid, signal.SIGKILL)
                sys.exit(f"{ending.name}: busy programs run on")
            time.sleep(0.05)


main()
