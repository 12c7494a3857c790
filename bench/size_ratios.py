#!/usr/bin/python3
"""Whether `auto` chooses well among bodies of two sizes: CPU time per collision, over size ratios and
shares of large ones, of `auto` over that of the best other search.

    bench/size_ratios.py            all of it, about 10 minutes on a free core
    bench/size_ratios.py --quick    less than a minute

The last line says the worst of them; with --limit, the exit code is 1 if that is above it. Searches take
turns, so that others on the machine disturb all alike; of each the quickest of three runs counts, and
where `auto` is above the limit, of nine.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BODIES = 2000
SEARCHES = ("auto", "linked-cells", "capsules", "all-pairs")
SHARES = {"none": 0, "one": 1, "1 %": BODIES // 100, "half": BODIES // 2}
# Of a body of size 1: length and diameter; and how dense, as packing fractions or as needles per
# cube of their mean length.
SHAPES = {"spheres": (0.0, 1.0, (0.02, 0.2, 0.3)), "rods": (0.8, 0.2, (0.01, 0.1)),
          "needles": (1.0, 0.0, (0.1, 1.0, 10.0))}


def volume(length, diameter):
    return math.pi * diameter**2 * (length / 4 + diameter / 6)


def scene_of(shape, ratio, large, density):
    """The text of a scene, or nothing if the box would not hold the large ones."""
    length, diameter, _ = SHAPES[shape]
    counts = (BODIES - large, large)
    if diameter:
        filled = counts[0] * volume(length, diameter) + counts[1] * volume(length * ratio,
                                                                           diameter * ratio)
        edge = math.cbrt(filled / density)
    else:
        mean = (counts[0] + counts[1] * ratio) / BODIES
        edge = math.cbrt(BODIES / density) * mean
    if large:
        edge = max(edge, 2.02 * ratio)
    text = f"needles.box = {edge!r}\nuntil.collisions_per_needle = 8\n"
    for name, count, size in (("small", counts[0], 1.0), ("large", counts[1], ratio)):
        text += (f"[[species]]\nname = '{name}'\ncount = {count}\nlength = {length * size!r}\n"
                 f"diameter = {diameter * size!r}\nmass = {size**3!r}\n")
    return text


def cost(program, scene, search):
    done = subprocess.run([program, "run", str(scene), "--json", "--quiet", "--set",
                           f"engine.search={search}"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None
    return json.loads(done.stdout)["us_per_collision"]


def measure(program, scene, searches, rounds, limit):
    """The least cost of each search, and how many times that of the best other `auto` takes; nothing
    if there is no place for the bodies."""
    least = dict.fromkeys(searches, math.inf)
    for turn in range(3 * rounds):
        for search in searches:
            us = cost(program, scene, search)
            if us is None:
                return None
            least[search] = min(least[search], us)
        over = least["auto"] / min(least[search] for search in searches[1:])
        if turn + 1 >= rounds and over <= limit:
            break
    return least, over


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/needlework"))
    parser.add_argument("--shape", choices=SHAPES, action="append")
    parser.add_argument("--ratios", type=float, nargs="+", default=[1, 2, 3, 5, 8, 14, 20, 50])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--quick", action="store_true", help="few ratios, one round, no all-pairs")
    parser.add_argument("--limit", type=float, default=math.inf)
    arguments = parser.parse_args()
    ratios = [3, 20] if arguments.quick else arguments.ratios
    searches = SEARCHES[:-1] if arguments.quick else SEARCHES
    rounds = 1 if arguments.quick else arguments.rounds
    worst = (0, "")
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        for shape in arguments.shape or SHAPES:
            for density in SHAPES[shape][2]:
                for ratio in ratios:
                    for share, large in SHARES.items():
                        scene.write_text(scene_of(shape, ratio, large, density))
                        name = f"{shape} {density} 1:{ratio:g} {share}"
                        measured = measure(arguments.program, scene, searches, rounds,
                                           arguments.limit)
                        if measured is None:
                            print(f"{name}: no place", flush=True)
                            continue
                        least, over = measured
                        worst = max(worst, (over, name))
                        print(f"{name}: {over:.2f}  " +
                              ", ".join(f"{search} {us:.2f} us" for search, us in least.items()),
                              flush=True)
    print(f"worst: {worst[0]:.2f} ({worst[1]})")
    return 1 if worst[0] > arguments.limit else 0


if __name__ == "__main__":
    sys.exit(main())
