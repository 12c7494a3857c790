#!/usr/bin/python3
"""What a run costs more when it is made by many requests to `needlework serve`.

    bench/pipe_overhead.py [NEEDLEWORK]

CPU time of the server for the same collisions of 10000 needles, one thread: one request, and
requests of 1000 collisions each. Repetitions are interleaved; prints the median of the quotients of
neighbours in time, with their range.
"""

import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

import measured

SCENE = "needles = { count = 10000, box = 24 }"
COLLISIONS = 100000
REPETITIONS = 9


def cpu_time(program, size):
    """Of a server that runs in pieces of so many collisions [s]."""
    server = subprocess.Popen([program, "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              text=True)

    def ask(**request):
        server.stdin.write(json.dumps(request) + "\n")
        server.stdin.flush()
        answer = json.loads(server.stdout.readline())
        assert answer["ok"], answer

    ask(do="create", scene=SCENE)
    for _ in range(COLLISIONS // size):
        ask(do="advance", simulation=1, collisions=size)
    server.stdin.close()
    _, status, used = os.wait4(server.pid, 0)
    assert status == 0, status
    return used.ru_utime + used.ru_stime


def main(program=measured.ROOT / "build/release/needlework"):
    program = measured.built(Path(program).parent, Path(program).name)
    more = []
    for _ in range(REPETITIONS):
        whole = cpu_time(program, COLLISIONS)
        more.append(100 * (cpu_time(program, 1000) / whole - 1))
    print(f"{statistics.median(more):.1f} % ({min(more):.1f} to {max(more):.1f})")


if __name__ == "__main__":
    main(*sys.argv[1:])
