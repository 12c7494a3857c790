"""Several threads are not much slower than one beside other programs that keep all cores busy.

    busy_machine.py NEEDLEWORK SCENE [--load N] [--threads 2,8] [--repetitions N] [--most RATIO]
                    [--attempts N] [--set SECTION.KEY=VALUE]

Prints the median wall time of interleaved runs for each number of threads, over that of one thread.
Fails if in each attempt one of them is larger than the largest ratio: other programs may disturb one.
"""

import argparse
import contextlib
import os
import statistics
import subprocess
import sys
import time

# Ends with the program that started it, also when a signal ends that one.
BUSY = """
import os, sys
while os.getppid() == int(sys.argv[1]):
    for _ in range(1000000):
        pass
"""


@contextlib.contextmanager
def load(programs):
    busy = [subprocess.Popen([sys.executable, "-c", BUSY, str(os.getpid())]) for _ in range(programs)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def seconds(arguments, threads):
    command = [arguments.program, "run", arguments.scene, "--threads", str(threads), "--quiet"]
    for setting in arguments.set:
        command += ["--set", setting]
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begin


def largest_ratio(arguments, settings):
    times = {threads: [] for threads in settings}
    for _ in range(arguments.repetitions):
        for threads in settings:
            times[threads].append(seconds(arguments, threads))
    one = statistics.median(times[1])
    for threads in settings:
        median = statistics.median(times[threads])
        print(f"{threads} threads: {median:.2f} s, {median / one:.2f} of one thread "
              f"({min(times[threads]) / one:.2f} to {max(times[threads]) / one:.2f})")
    return max(statistics.median(each) for each in times.values()) / one


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("--load", type=int, default=os.cpu_count(), help="busy programs")
    parser.add_argument("--threads", default="2,8")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--most", type=float, default=1.3, help="largest ratio that passes")
    parser.add_argument("--attempts", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], help="a key of the scene")
    arguments = parser.parse_args()
    settings = [1] + [int(threads) for threads in arguments.threads.split(",")]
    with load(arguments.load):
        for _ in range(arguments.attempts):
            if largest_ratio(arguments, settings) <= arguments.most:
                return
    sys.exit(f"larger than {arguments.most:g}")


if __name__ == "__main__":
    main()
