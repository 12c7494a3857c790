#!/usr/bin/python3
"""What Python adds to the cost of a run: calls, callbacks, snapshots.

    PYTHONPATH=build/release/python bench/python_overhead.py [--rounds N] [--needles N] [--json FILE]

Simulations of one scene (elastic, 0.72 needles per L^3, one thread) go through the same collisions,
each in a way of its own, in turns of 20000 collisions. Prints the CPU time of a way per collision,
least of all turns, and how much more it takes than one call without callback: the median over turns
of the quotient of neighbours in time, with an interval that holds the true median in 95 of 100 cases
or more.
"""

import argparse
import json
import statistics
import sys
import time

from versus import interval

try:
    import needlework
except ImportError:
    sys.exit("needlework: not found: cmake --build --preset release; "
             "PYTHONPATH=build/release/python /usr/bin/python3 bench/python_overhead.py")

COLLISIONS = 20000  # of a turn


def whole(sim):
    sim.advance(collisions=COLLISIONS)


def calls_of(size, look=lambda sim: None):
    def turn(sim):
        for _ in range(COLLISIONS // size):
            sim.advance(collisions=size)
            look(sim)
    return turn


# name, what is passed to on_collisions, a turn
WAYS = [
    ("one call", None, whole),
    ("calls of 1000 collisions", None, calls_of(1000)),
    ("calls of 100 collisions", None, calls_of(100)),
    ("calls of 1000, and the position after each", None, calls_of(1000, lambda s: s.position)),
    ("calls of 1000, and the totals after each", None, calls_of(1000, lambda s: s.totals)),
    ("callback, batches of 1024", {"batch": 1024}, whole),
    ("callback, batches of 1024 with states", {"batch": 1024, "states": True}, whole),
    ("callback, batches of 10", {"batch": 10}, whole),
]


def simulation(arguments, options):
    sim = needlework.Simulation({
        "needles": {"count": arguments.needles, "box": 24 * (arguments.needles / 10000) ** (1 / 3)},
        "engine": {"threads": 1}})
    if options:
        # What a user does at least: looks at a field of each batch.
        sim.on_collisions(lambda rows: rows["normal_velocity"].sum(), **options)
    sim.advance(collisions=COLLISIONS)  # the first turn is not measured
    return sim


def measure(arguments):
    sims = [simulation(arguments, options) for _, options, _ in WAYS]
    costs = [[] for _ in WAYS]
    for turn in range(arguments.rounds):
        order = [(turn + place) % len(WAYS) for place in range(len(WAYS))]
        for way in order:
            start = time.process_time()
            WAYS[way][2](sims[way])
            costs[way].append((time.process_time() - start) / COLLISIONS)
    if len({sim.hash for sim in sims}) > 1:
        sys.exit("python_overhead.py: the trajectories differ")
    return costs


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=30)
    parser.add_argument("--needles", type=int, default=10000)
    parser.add_argument("--json", help="writes all turns to this file [s per collision]")
    arguments = parser.parse_args()
    if arguments.rounds < 6:
        parser.error("--rounds: expected at least 6, fewer have no interval")
    costs = measure(arguments)
    print("| way | us per collision | more than one call, 95 % interval |\n|---|---|---|")
    for (name, _, _), own in zip(WAYS, costs):
        quotients = [100 * (cost / first - 1) for cost, first in zip(own, costs[0])]
        low, high = interval(quotients)
        more = "" if own is costs[0] else (f"{statistics.median(quotients):.1f} % "
                                           f"({low:.1f} to {high:.1f})")
        print(f"| {name} | {1e6 * min(own):.2f} | {more} |")
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump({name: own for (name, _, _), own in zip(WAYS, costs)}, file)


if __name__ == "__main__":
    main()
