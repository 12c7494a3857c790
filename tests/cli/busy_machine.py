"""Several threads are not much slower than one beside other programs that keep all cores busy.

    busy_machine.py NEEDLEWORK [SCENE] [--load N] [--threads 2,8] [--repetitions N] [--most RATIO]

Prints the median wall time of interleaved runs for each number of threads, over that of one thread.
"""

import argparse
import contextlib
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENE = """
[needles]
count = 2000
box = 14.0
[until]
collisions_per_needle = 50
"""
BUSY = "while True: pass"


@contextlib.contextmanager
def load(programs):
    busy = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(programs)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def seconds(program, scene, threads):
    begin = time.perf_counter()
    subprocess.run([program, "run", scene, "--threads", str(threads), "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)
    return time.perf_counter() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("scene", nargs="?")
    parser.add_argument("--load", type=int, default=os.cpu_count(), help="busy programs")
    parser.add_argument("--threads", default="2,8")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--most", type=float, default=3, help="largest ratio that passes")
    arguments = parser.parse_args()
    settings = [1] + [int(threads) for threads in arguments.threads.split(",")]
    times = {threads: [] for threads in settings}
    with tempfile.TemporaryDirectory() as folder, load(arguments.load):
        scene = arguments.scene or Path(folder) / "scene.toml"
        if not arguments.scene:
            scene.write_text(SCENE)
        for _ in range(arguments.repetitions):
            for threads in settings:
                times[threads].append(seconds(arguments.program, scene, threads))
    one = statistics.median(times[1])
    failed = False
    for threads in settings:
        median = statistics.median(times[threads])
        print(f"{threads} threads: {median:.2f} s, {median / one:.2f} of one thread "
              f"({min(times[threads]) / one:.2f} to {max(times[threads]) / one:.2f})")
        failed |= median > arguments.most * one
    sys.exit(failed)


if __name__ == "__main__":
    main()
