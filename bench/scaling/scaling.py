#!/usr/bin/python3
"""Measures how a run gains from threads, and what limits it.

    bench/scaling/scaling.py                     all scenes on 1 to all cores; continues where it was
                                                 stopped
    bench/scaling/scaling.py dilute weak         some of them
    bench/scaling/scaling.py --time-budget 20    for 20 minutes; the same command continues later
    bench/scaling/scaling.py tables              no measuring: table and picture of what there is

Repetitions of all settings are interleaved. Times are wall times of the event loop per collision.
A speed-up is over the run by one thread in the same repetition; the table gives medians and ranges.
"alone" is one thread with whatever search and calendar is best for one; "apart" is as many runs of that
as there are threads, at once, and their collisions together: what the cores can give; "crowded" has
four threads for each core. "Cache line" is how long one takes from core to core, measured before each
run of as many threads as cores or fewer (cores.cpp). Beside other programs that never rest, a speed-up
is over one thread beside them. "ensemble" is `needlework sweep` on twelve members. Writes scaling.md,
scaling.svg and the compact scaling.json to bench/results/MACHINE-ISA/ when all scenes are complete, of
one commit and of the same build; until then to study/results/ in the folder of the build.
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
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "tests/cli")]
import measured  # noqa: E402
from busy_machine import load  # noqa: E402
from measured import quotients, spread  # noqa: E402

DILUTE = 24 / 10000 ** (1 / 3)  # box over N^(1/3)
DENSE = 12 / 20000 ** (1 / 3)

# name: (needles, box, collisions per needle): runs of about half a second, in which the first trials of
# all threads and of one take little of the time
STRONG = {
    "dilute": (10000, 24.0, 25),
    "dense": (20000, 12.0, 12),
    "dilute-1e5": (100000, DILUTE * 1e5 ** (1 / 3), 4),
    "dilute-1e6": (1000000, DILUTE * 1e6 ** (1 / 3), 1.5),
}
WEAK = {"weak": (100000, DILUTE, 4)}  # needles for each thread
CROWDED = ["dilute", "dense"]
LOADS = [1, 2, 4]  # programs beside the crowded scenes
ENSEMBLE = {"ensemble": (2000, 14.0, 40)}  # each member
SCENES = STRONG | WEAK | ENSEMBLE
GRID = """scene = "member.toml"
seeds = { first = 1, count = 12 }
"""
REPETITIONS = 7


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


def sweep(program, folder, needles, box, collisions, threads):
    """Twelve runs, so many at a time: wall time per collision of all."""
    (folder / "member.toml").write_text(scene(needles, box, collisions))
    (folder / "grid.toml").write_text(GRID)
    with tempfile.TemporaryDirectory() as out:
        begin = time.perf_counter()
        report = json.loads(measured.output_of(
            [program, "sweep", folder / "grid.toml", "--out", out, "--threads", str(threads),
             "--json", "--quiet"]))
        wall = time.perf_counter() - begin
    point, = report["points"]
    return 1e6 * wall / (len(point["seeds"]) * point["results"]["collisions"]["mean"])


def cache_line(build):
    """Time [ns] that a cache line takes from one core to another, in a list; empty if not built."""
    program = build / "bench_scaling"
    if not program.exists():
        return []
    report = json.loads(measured.output_of([program, "--benchmark_format=json"]))
    return [run["real_time"] for run in report["benchmarks"]]


def settings_of(name, most):
    """(kind, threads) of all runs of a scene."""
    counts = sorted({1, most} | {n for n in (2, 3, 4, 6, 8, 12, 16, 24, 32) if n <= most})
    settings = [("alone", 1)] + [("together", n) for n in counts if n > 1]
    if name not in ENSEMBLE:
        settings += [("apart", n) for n in counts if n > 1]
    if name in CROWDED:
        settings += [("crowded", 4 * most)]
        settings += [(f"beside-{programs}", n) for programs in LOADS for n in (1, most, 4 * most)]
    return settings


def measure(build, name, most, shorter):
    """One repetition of all settings of a scene."""
    needles, box, collisions = SCENES[name]
    needles, collisions = round(needles / shorter), max(1, collisions / shorter)
    box = box if name in WEAK else box / shorter ** (1 / 3)
    program = build / "needlework"
    cases, hashes = [], set()
    with tempfile.TemporaryDirectory() as folder:
        for kind, n in settings_of(name, most):
            case = {"name": f"{name}/{kind}/threads:{n}", "threads": n, "needles": needles}
            if kind == "together":
                case["cache_line_ns"] = cache_line(build)
            if name in ENSEMBLE:
                us = sweep(program, Path(folder), needles, box, collisions, n)
            else:
                if name in WEAK and kind == "together":
                    case["needles"] = needles * n
                side = box * case["needles"] ** (1 / 3) if name in WEAK else box
                file = Path(folder) / "scene.toml"
                file.write_text(scene(case["needles"], side, collisions))
                with load(int(kind.removeprefix("beside-")) if "beside" in kind else 0):
                    processes = [start(program, file, 1 if kind == "apart" else n)
                                 for _ in range(n if kind == "apart" else 1)]
                    runs = [end(process) for process in processes]
                us = 1e6 / sum(run["collisions"] / run["wall_s"] for run in runs)
                hashes |= {run["trajectory_hash"] for run in runs}
                stats = runs[0]["stats"]
                case |= {"border_tries": [stats["border"] / runs[0]["events"]],
                         "events_per_turn": [runs[0]["events"] / max(1, stats["turns"])],
                         "blocked": [stats["blocked_s"] / (n * runs[0]["wall_s"])],
                         "undone": [stats["redone"]], "phases": [stats["phases"]]}
            cases.append({**case, "us_per_collision": [us]})
    if name not in WEAK and len(hashes) > 1:
        sys.exit(f"{name}: the trajectory depends on the number of threads")
    return "bench/scaling/scaling.py", cases


def speed_ups(content):
    """Of each case: how many times faster than one thread beside the same load, by repetition."""
    cases = {tuple(case["name"].split("/")[1:]): case["us_per_collision"]
             for case in content["cases"]}
    return {(kind, threads): quotients(
        cases[kind if "beside" in kind else "alone", "threads:1"], us)
        for (kind, threads), us in cases.items()}


def table(contents):
    rows = []
    for name, content in contents.items():
        gains = speed_ups(content)
        for case in content["cases"]:
            _, kind, threads = case["name"].split("/")
            if kind == "apart":
                continue
            gain, n = gains[kind, threads], case["threads"]
            scene = f"{name} {kind.replace('-', ' ')} busy" if "beside" in kind else name
            cells = [scene, case["needles"], n, spread(case["us_per_collision"])]
            cells.append("1" if n == 1 else spread(gain))
            if kind == "together":  # a core for each thread, and nothing beside them
                cells.append(spread([g / n for g in gain]))
            if kind == "together" and ("apart", threads) in gains:
                cells += [spread(quotients(gain, gains["apart", threads])),
                          *(spread(case[key]) for key in ("border_tries", "events_per_turn")),
                          f"{100 * statistics.median(case['blocked']):.0f} %",
                          f"{sum(case['undone'])} of {sum(case['phases'])}"]
            lines = case.get("cache_line_ns")
            cells += [""] * (11 - len(cells)) + [f"{spread(lines)} ns" if lines else ""]
            rows.append(cells)
    return measured.table(["scene", "needles", "threads", "us per collision", "speed-up",
                           "efficiency", "of runs apart", "border tries per event",
                           "events per turn", "time blocked", "phases undone", "cache line"], rows)


def model(contents):
    """What a collision costs more than in runs apart, as a line over border tries per event."""
    tries, costs, most = [], [], 0
    for name, content in contents.items():
        gains = speed_ups(content)
        for case in content["cases"]:
            _, kind, threads = case["name"].split("/")
            if kind == "together" and ("apart", threads) in gains:
                most = case["threads"]
                tries.append(statistics.median(case["border_tries"]))
                costs.append(statistics.median(quotients(gains["apart", threads],
                                                         gains[kind, threads])))
    if len(set(tries)) < 3:
        return ""
    slope, base = statistics.linear_regression(tries, costs)
    error = max(abs(base + slope * x - y) / y for x, y in zip(tries, costs))
    predicted = ", ".join(f"{1 / (base + slope * x):.2f} at {x:g}" for x in (0.5, 1, 1.5, 2))
    return (f"\n## A model for more cores\n\nA collision on several threads takes {base:.2f} + "
            f"{slope:.2f} × (border tries per event) of what it takes in runs apart: the line that "
            f"fits the {len(tries)} scenes above best, to {100 * error:.0f} %. On more threads more "
            "events are near a border, so the model predicts these shares of runs apart for so many "
            f"tries: {predicted}. It is a prediction, measured on {most} threads "
            "only, and leaves out that more threads wait for each other more often.\n")


def draw(lines, file):
    """Speed-ups by repetition, as {scene: {threads: values}}."""
    figure, axes = measured.pyplot().subplots(figsize=(5.2, 4))
    most = max(n for gains in lines.values() for n in gains)
    for place, (name, gains) in enumerate(lines.items()):
        aside = 1 + 0.008 * (place - len(lines) / 2)  # bars of several scenes side by side
        measured.bars(axes, [n * aside for n in gains], list(gains.values()), marker="o", label=name)
    axes.plot([1, most], [1, most], color="0.7", linestyle="--", label="ideal")
    axes.set_xticks(range(1, most + 1) if most < 9 else [1, 2, 4, 8, 16, 32])
    axes.set_xlabel("threads")
    axes.set_ylabel("speed-up over the best setting for one thread")
    axes.legend()
    measured.save_picture(figure, file)


def write_results(contents, folder):
    last = list(contents.values())[-1]
    (folder / "scaling.md").write_text(
        "# Threads\n\n"
        "Made by `bench/scaling/scaling.py`; docs/performance.md says what the columns are.\n"
        f"{measured.origin(last)}\n\n" + table(contents) + model(contents))
    draw({name: {int(threads.split(":")[1]): gain
                 for (kind, threads), gain in speed_ups(content).items()
                 if kind in ("alone", "together")} for name, content in contents.items()},
         folder / "scaling.svg")
    measured.write_compact(folder / "scaling.json",
                           {key: last[key] for key in last if key != "cases"},
                           [case for content in contents.values() for case in content["cases"]],
                           "us_per_collision")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join([*SCENES, "tables"]))
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--repetitions", type=int, default=REPETITIONS)
    measured.add_options(parser)
    arguments = parser.parse_args()
    unknown = set(arguments.scenes) - {*SCENES, "tables"}
    if unknown:
        parser.error(f"SCENE {' '.join(sorted(unknown))}: expected some of "
                     f"{', '.join([*SCENES, 'tables'])}")
    if arguments.threads < 1 or arguments.repetitions < 1:
        parser.error("--threads, --repetitions: expected at least 1")
    store = measured.store_of(arguments)
    rounds = 1 if arguments.quick else arguments.repetitions
    shorter = 10 if arguments.quick else 1

    def part(name):
        return f"scaling-{name}"

    chosen = [name for name in arguments.scenes or SCENES if name != "tables"]
    if chosen:
        measured.measure_rounds(store, {part(name): (rounds, lambda name=name: measure(
            arguments.build, name, arguments.threads, shorter))
            for name in chosen}, 60 * arguments.time_budget)
    missing = [name for name in SCENES if store.rounds(part(name)) < rounds]
    contents = {name.removeprefix(part("")): content for name, content in
                measured.kept_of(store, map(part, SCENES)).items()}
    place = store.place(arguments.machine or measured.machine_name(arguments.build), not missing)
    write_results(contents, place)
    print(table(contents))
    measured.report_missing(store, missing, place)


if __name__ == "__main__":
    measured.run(main)
