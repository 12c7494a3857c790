#!/usr/bin/python3
"""Compares two builds of the program, run side by side on the paper's elastic scenes, or on yours.

    bench/versus.py OLD NEW
    bench/versus.py OLD NEW --scene dense --repetitions 40
    bench/versus.py OLD NEW --scene own.toml --set until.collisions_per_needle=5
    bench/versus.py PROGRAM PROGRAM --second-without-huge-pages
    bench/versus.py PROGRAM PROGRAM --second engine.queue=bucket

Prints, for each scene, the CPU time of the event loop per collision, the least of each, and how much
the second takes of the first's: the median over repetitions of the quotient of neighbours in time,
with an interval that holds the true median in 95 of 100 cases or more. With several threads, it is the
wall time. A machine that changes its
speed does so for both. Runs count from their start on, when no needle is about to leave its bounding
volume: costs are a little lower than those of `needlework bench`. A scene of yours runs to its own end,
without its output file; --set changes it. Fails when the trajectories differ;
builds of commits between which they were changed are compared by --other-trajectory.
"""

import argparse
import ctypes
import json
import math
import statistics
import subprocess
import sys
from pathlib import Path

SCENES = {  # needles, box, collisions per needle
    "dilute": (10000, 24.0, 10),
    "dense": (20000, 12.0, 4),
    "dilute-1e5": (100000, 24 * 10 ** (1 / 3), 2),
    "dilute-1e6": (1000000, 24 * 100 ** (1 / 3), 0.5),
    "dense-1e5": (100000, 12 * 5 ** (1 / 3), 2),
}
PR_SET_THP_DISABLE = 41  # of linux/prctl.h; kept by programs that are started


def scene_arguments(scene):
    """The file of a scene, and settings that make it what is to be run."""
    if scene not in SCENES:
        return scene, ["output.file=''"]
    needles, box, collisions = SCENES[scene]
    return "/dev/null", [f"needles.count={needles}", f"needles.box={box!r}",
                         f"until.collisions_per_needle={collisions}"]


def run(program, scene, settings, huge_pages):
    file, of_scene = scene_arguments(scene)
    command = [program, "run", file, "--json", "--quiet"]
    for setting in (*of_scene, *settings):
        command += ["--set", setting]

    def without_huge_pages():
        if ctypes.CDLL(None).prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0) != 0:
            raise OSError("prctl(PR_SET_THP_DISABLE) failed")

    try:
        done = subprocess.run(command, capture_output=True, text=True,
                              preexec_fn=None if huge_pages else without_huge_pages)
    except (OSError, subprocess.SubprocessError) as error:
        sys.exit(f"versus.py: {program}: {error}")
    if done.returncode != 0:
        sys.exit(f"versus.py: {' '.join(command)}: exit code {done.returncode}: {done.stderr}")
    result = json.loads(done.stdout)
    if result["collisions"] == 0:
        sys.exit(f"versus.py: {' '.join(command)}: expected collisions, there were none")
    seconds = result["cpu_s" if result["threads"] == 1 else "wall_s"]
    return 1e6 * seconds / result["collisions"], result["trajectory_hash"]


def interval(values):
    """Two of at least six values between which their distribution's median lies, with 95 % or more:
    those of the sign test."""
    values, n = sorted(values), len(values)
    below, low = 0, -1  # share of cases in which not more than `low` values are below the median
    while below + math.comb(n, low + 1) / 2**n <= 0.025:
        low += 1
        below += math.comb(n, low) / 2**n
    return values[low], values[n - 1 - low]


def scene_name(text):
    if text not in SCENES and not Path(text).is_file():
        raise argparse.ArgumentTypeError(f"{text}: expected {', '.join(SCENES)} or a scene file")
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first")
    parser.add_argument("second")
    parser.add_argument("--scene", type=scene_name, action="append", metavar="SCENE",
                        help=f"{', '.join(SCENES)} or a scene file; may be given several times; "
                             "else dilute and dense")
    parser.add_argument("--repetitions", type=int, default=20)
    parser.add_argument("--set", dest="both", action="append", default=[], metavar="KEY=VALUE",
                        help="a setting for both")
    parser.add_argument("--second", dest="settings", action="append", default=[],
                        metavar="KEY=VALUE", help="a setting for the second alone")
    parser.add_argument("--second-without-huge-pages", action="store_true")
    parser.add_argument("--other-trajectory", action="store_true",
                        help="the second may have other collisions")
    arguments = parser.parse_args()
    if arguments.repetitions < 6:
        parser.error("--repetitions: expected at least 6, fewer have no interval")
    for scene in arguments.scene or ["dilute", "dense"]:
        costs = ([], [])
        for repetition in range(arguments.repetitions):
            hashes = set()
            for which in (0, 1) if repetition % 2 == 0 else (1, 0):
                cost, trajectory = run(
                    (arguments.first, arguments.second)[which], scene,
                    arguments.both + (arguments.settings if which else []),
                    not (which and arguments.second_without_huge_pages))
                costs[which].append(cost)
                hashes.add(trajectory)
            if len(hashes) > 1 and not arguments.other_trajectory:
                sys.exit(f"versus.py: {scene}: the trajectories differ")
        quotients = [b / a for a, b in zip(*costs)]
        low, high = interval(quotients)
        print(f"{scene}: {min(costs[0]):.2f} and {min(costs[1]):.2f} us per collision at best; "
              f"the second takes {statistics.median(quotients):.3f} of the first "
              f"({low:.3f} to {high:.3f}, {len(quotients)} repetitions)", flush=True)


if __name__ == "__main__":
    main()
