#!/usr/bin/python3
"""Measures how a run gains from threads, and what limits it.

    bench/scaling/scaling.py                 all scenes on 1 to all cores, 15 minutes on two
    bench/scaling/scaling.py dilute weak     some of them
    bench/scaling/scaling.py tables          no measuring: table and picture anew from the file

Repetitions of all settings are interleaved. Of the wall time of the event loop per collision the
best is told, of speed-ups the median: each is over the run by one thread in the same repetition, so
that a machine which changes its speed does so for both. "alone" is one thread with whatever search and queue is best for one; "apart" is
as many runs of that as there are threads, at once, and their collisions together: what the cores
can give; "crowded" has four threads for each core. "ensemble" is `needlework sweep` on twelve
members. Writes scaling.json, scaling.md and scaling.svg to bench/results/MACHINE-ISA/.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import study  # noqa: E402

DILUTE = 24 / 10000 ** (1 / 3)  # box over N^(1/3)
DENSE = 12 / 20000 ** (1 / 3)

# name: (needles, box, collisions per needle)
STRONG = {
    "dilute": (10000, 24.0, 10),
    "dense": (20000, 12.0, 5),
    "dilute-1e5": (100000, DILUTE * 1e5 ** (1 / 3), 4),
    "dilute-1e6": (1000000, DILUTE * 1e6 ** (1 / 3), 1.5),
}
WEAK = {"weak": (100000, DILUTE, 4)}  # needles for each thread
CROWDED = ["dilute", "dense"]
ENSEMBLE = {"ensemble": (2000, 14.0, 40)}  # each member
SCENES = STRONG | WEAK | ENSEMBLE
GRID = """scene = "member.toml"
seeds = { first = 1, count = 12 }
"""


def scene(needles, box, collisions):
    return (f"[needles]\ncount = {needles}\nbox = {box}\n"
            f"[until]\ncollisions_per_needle = {collisions}\n")


def start(program, file, threads):
    return subprocess.Popen([program, "run", file, "--json", "--quiet", "--threads", str(threads)],
                            stdout=subprocess.PIPE, text=True)


def end(process):
    out, _ = process.communicate()
    if process.returncode:
        sys.exit(f"{process.args}: exit {process.returncode}")
    return json.loads(out)


def sweep(program, name, folder, threads):
    """Twelve runs, so many at a time, as if they were one."""
    needles, box, collisions = ENSEMBLE[name]
    (folder / "member.toml").write_text(scene(needles, box, collisions))
    (folder / "grid.toml").write_text(GRID)
    with tempfile.TemporaryDirectory() as out:
        begin = time.perf_counter()
        report = json.loads(study.output_of(
            [program, "sweep", folder / "grid.toml", "--out", out, "--threads", str(threads),
             "--json", "--quiet"]))
        wall = time.perf_counter() - begin
    point, = report["points"]
    return {"scene": name, "kind": "together" if threads > 1 else "alone", "threads": threads,
            "needles": needles, "wall_s": wall,
            "collisions_per_s": len(point["seeds"]) * point["results"]["collisions"]["mean"] / wall}


def gain(rates, other_rates):
    """The median quotient of repetitions."""
    return statistics.median(a / b for a, b in zip(rates, other_rates))


def measure_ensemble(program, name, counts, repetitions):
    with tempfile.TemporaryDirectory() as folder:
        runs = [sweep(program, name, Path(folder), n) for _ in range(repetitions) for n in counts]
    results = [max((r for r in runs if r["threads"] == n), key=lambda r: r["collisions_per_s"])
               for n in counts]
    rates = {n: [r["collisions_per_s"] for r in runs if r["threads"] == n] for n in counts}
    for r in results:
        r["us_per_collision"] = 1e6 / r["collisions_per_s"]
        r["speed_up"] = gain(rates[r["threads"]], rates[1])
        print(f"{name:11} {r['kind']:9} {r['threads']:2}  {r['us_per_collision']:7.3f} us per collision",
              flush=True)
    return results


def measure(program, names, most, repetitions):
    results = []
    counts = sorted({1, most} | {n for n in (2, 3, 4, 6, 8, 12, 16, 24, 32) if n <= most})
    for name in names:
        if name in ENSEMBLE:
            results += measure_ensemble(program, name, counts, repetitions)
            continue
        weak = name in WEAK
        needles, box, collisions = SCENES[name]
        settings = [("alone", 1)] + [("together", n) for n in counts if n > 1]
        settings += [("apart", n) for n in counts if n > 1]
        settings += [("crowded", 4 * most)] * (name in CROWDED)
        best, rates = {}, {}
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(repetitions):
                for kind, n in settings:
                    count = needles * n if weak and kind == "together" else needles
                    side = box * count ** (1 / 3) if weak else box
                    file = Path(folder) / f"{name}-{count}.toml"
                    file.write_text(scene(count, side, collisions))
                    runs = [end(p) for p in [start(program, file, 1 if kind == "apart" else n)
                                             for _ in range(n if kind == "apart" else 1)]]
                    rate = sum(r["collisions"] / r["wall_s"] for r in runs)
                    rates.setdefault((kind, n), []).append(rate)
                    if rate > best.get((kind, n), (0, None))[0]:
                        best[kind, n] = rate, runs[0]
        for (kind, n), (rate, run) in best.items():
            results.append({"scene": name, "kind": kind, "threads": n, "needles": run["needles"],
                            "collisions_per_s": rate, "us_per_collision": 1e6 / rate,
                            "speed_up": gain(rates[kind, n], rates["alone", 1]),
                            "cpu_us_per_collision": run["us_per_collision"],
                            "hash": run["trajectory_hash"], "queue": run["queue"],
                            "search": run["search"], "events": run["events"], "wall_s": run["wall_s"],
                            "stats": run["stats"]})
            print(f"{name:11} {kind:9} {n:2}  {1e6 / rate:7.3f} us per collision", flush=True)
        if not weak and len({r["hash"] for r in results if r["scene"] == name}) > 1:
            sys.exit(f"{name}: the trajectory depends on the number of threads")
    return results


def table(data):
    rows = ["| scene | needles | threads | us per collision | speed-up | efficiency | of runs apart |"
            " border tries per event | events per turn | time blocked | phases undone |",
            "|---|---|---|---|---|---|---|---|---|---|---|"]
    by = {(r["scene"], r["kind"], r["threads"]): r for r in data["results"]}
    for (name, kind, n), r in by.items():
        if kind == "apart":
            continue
        cells = [name, f"{r['needles']}", f"{n}", f"{r['us_per_collision']:.2f}"]
        if kind == "crowded" or (kind == "together" and name in ENSEMBLE):
            cells += [f"{r['speed_up']:.2f}", f"{r['speed_up'] / n:.2f}"] + [""] * 5
        elif kind == "together":
            apart = by[name, "apart", n]["speed_up"]
            s = r["stats"]
            cells += [f"{r['speed_up']:.2f}", f"{r['speed_up'] / n:.2f}", f"{r['speed_up'] / apart:.2f}",
                      f"{s['border'] / r['events']:.2f}",
                      f"{r['events'] / s['turns']:.1f}",
                      f"{100 * s['blocked_s'] / (n * r['wall_s']):.0f} %",
                      f"{s['redone']} of {s['phases']}"]
        else:
            cells += ["1", "1"] + [""] * 5
        rows.append("| " + " | ".join(cells) + " |")
    return "\n".join(rows)


def draw(data, file):
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    matplotlib.rcParams["svg.hashsalt"] = "needlework"
    figure, axes = plt.subplots(figsize=(5.2, 4))
    by = {}
    for r in data["results"]:
        by.setdefault(r["scene"], {})[r["kind"], r["threads"]] = r["speed_up"]
    most = max((r["threads"] for r in data["results"] if r["kind"] == "together"), default=1)
    for name, gains in by.items():
        points = [(n, gain) for (kind, n), gain in sorted(gains.items())
                  if kind in ("alone", "together")]
        axes.plot(*zip(*points), "o-", label=name)
    axes.plot([1, most], [1, most], color="0.7", linestyle="--", label="ideal")
    axes.set_xticks(range(1, most + 1) if most < 9 else [1, 2, 4, 8, 16, 32])
    axes.set_xlabel("threads")
    axes.set_ylabel("speed-up over the best setting for one thread")
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(file, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", help=", ".join([*SCENES, "tables"]))
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--machine", help="its name among the results")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--repetitions", type=int, default=5)
    arguments = parser.parse_args()
    names = arguments.scenes or list(SCENES)
    folder = study.BENCH / "results" / (arguments.machine or study.machine_name(arguments.build))
    file = folder / "scaling.json"
    if names != ["tables"]:
        for name in names:
            if name not in SCENES:
                parser.error(f"{name}: expected some of {', '.join([*SCENES, 'tables'])}")
        new = measure(arguments.build / "needlework", names, arguments.threads,
                      arguments.repetitions)
        old = json.loads(file.read_text())["results"] if file.exists() else []
        kept = [r for r in old if r["scene"] not in names]
        order = list(SCENES)
        study.write_json(file, {"commit": study.commit(), "results": sorted(
            kept + new, key=lambda r: order.index(r["scene"]))})
    data = json.loads(file.read_text())
    (folder / "scaling.md").write_text(
        "# Threads\n\nMade by `bench/scaling/scaling.py`; bench/README.md says what the columns are.\n\n"
        + table(data) + "\n")
    draw(data, folder / "scaling.svg")
    print(table(data))


if __name__ == "__main__":
    main()
