#!/usr/bin/python3
"""Measures how a run gains from threads, and what limits it.

    bench/scaling/scaling.py                     all scenes on 1 to all cores; continues where it was
                                                 stopped
    bench/scaling/scaling.py dilute weak         some of them
    bench/scaling/scaling.py own.toml            a scene of yours, to its own end
    bench/scaling/scaling.py --no-load           not beside busy programs
    bench/scaling/scaling.py --time-budget 20    for 20 minutes; the same command continues later
    bench/scaling/scaling.py tables              no measuring: table and picture of what there is

Repetitions of all settings are interleaved. Times are wall times of the event loop per collision.
A speed-up is over the run by one thread in the same repetition; the table gives medians and ranges.
"alone" is one thread with whatever search and calendar is best for one; "apart" is as many runs of that
as there are threads, at once, and their collisions together: what the cores can give; "crowded" has
four threads for each core. "Cache line" is how long one takes from core to core, measured before each
run of as many threads as cores or fewer (cores.cpp). Beside other programs that never rest, a speed-up
is over one thread beside them. "ensemble" is `needlework sweep` on twelve members. Writes scaling.md,
scaling.svg and the compact scaling.json to study/results/ in the folder of the build. What is kept in
bench/results is measured by bench/performance.py.
"""

import argparse
import hashlib
import json
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
COLUMNS = (
    "\nSpeed-up: over the best setting for one thread. Of runs apart: compared with as many separate "
    "runs at the same time as there are threads. Border try: an attempt at an event that has to "
    "compare times with other threads and lock cells. Turn: a sequence of events until the thread is "
    "blocked. Time blocked: a share of the time of all threads. Phases undone: stretches that one "
    "thread had to repeat. Cache line: how long one takes from one core to another (`bench_scaling`), "
    "measured before each run of several threads without other programs; a virtual machine whose "
    "cores are moved changes it. *weak* has 100000 needles for each thread, *ensemble* as many runs "
    "of 2000 needles as threads.\n")
ENSEMBLE = {"ensemble": (2000, 14.0, 40)}  # each member
SCENES = STRONG | WEAK | ENSEMBLE
GRID = """scene = "member.toml"
seeds = { first = 1, count = 12 }
"""
REPETITIONS = 7


def scene(needles, box, collisions):
    return (f"[needles]\ncount = {needles}\nbox = {box}\n"
            f"[until]\ncollisions_per_needle = {collisions}\n")


def run_at_once(program, file, threads, times):
    """So many runs side by side, to their ends."""
    command = [program, "run", str(file), "--json", "--quiet", "--threads", str(threads), "--set",
               "output.file=''"]
    processes = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(times)]
    try:
        outs = [process.communicate(timeout=measured.budget.left())[0] for process in processes]
    except subprocess.TimeoutExpired:
        raise measured.OutOfTime from None
    finally:
        for process in processes:
            process.kill()
            process.wait()
    if any(process.returncode for process in processes):
        sys.exit(f"{' '.join(map(str, command))}: exit code "
                 f"{max(process.returncode for process in processes)}")
    return [json.loads(out) for out in outs]


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
    """Time [ns] that a cache line takes from one core to another, in a list."""
    report = json.loads(measured.output_of([measured.built(build, "bench_scaling"),
                                            "--benchmark_format=json"]))
    return [run["real_time"] for run in report["benchmarks"]]


def settings_of(name, most, loads):
    """(kind, threads) of all runs of a scene, beside none and so many busy programs."""
    counts = sorted({1, most} | {n for n in (2, 3, 4, 6, 8, 12, 16, 24, 32) if n <= most})
    settings = [("alone", 1)] + [("together", n) for n in counts if n > 1]
    if name not in ENSEMBLE:
        settings += [("apart", n) for n in counts if n > 1]
    if name in CROWDED:
        settings += [("crowded", 4 * most)]
        settings += [(f"beside-{programs}", n) for programs in loads for n in (1, most, 4 * most)]
    return settings


def scene_file(name, kind, threads, shorter, folder):
    """The scene of a run."""
    if name not in SCENES:
        return Path(name)
    needles, box, collisions = SCENES[name]
    needles, collisions = round(needles / shorter), max(1, collisions / shorter)
    if name in WEAK:
        needles *= threads if kind == "together" else 1
        box *= needles ** (1 / 3)
    else:
        box /= shorter ** (1 / 3)
    file = Path(folder) / "scene.toml"
    file.write_text(scene(needles, box, collisions))
    return file


def measure_one(build, name, kind, n, file):
    """One run, or as many at once as there are threads."""
    case = {"name": f"{short_name(name)}/{kind}/threads:{n}", "threads": n}
    if kind == "together":
        case["cache_line_ns"] = cache_line(build)
    with load(int(kind.removeprefix("beside-")) if "beside" in kind else 0):
        runs = run_at_once(build / "needlework", file, *((1, n) if kind == "apart" else (n, 1)))
    run = runs[0]
    if run["collisions"] == 0:
        sys.exit(f"{name}: expected collisions, there were none")
    stats = run["stats"]
    return case | {"needles": run["needles"],
                   "hashes": sorted({one["trajectory_hash"] for one in runs}),
                   "border_tries": [stats["border"] / run["events"]],
                   "events_per_turn": [run["events"] / max(1, stats["turns"])],
                   "blocked": [stats["blocked_s"] / (n * run["wall_s"])],
                   "undone": [stats["redone"]], "phases": [stats["phases"]],
                   "us_per_collision": [1e6 / sum(one["collisions"] / one["wall_s"]
                                                  for one in runs)]}


def measure_ensemble(build, name, kind, n, shorter, folder):
    needles, box, collisions = SCENES[name]
    needles = round(needles / shorter)
    us = sweep(build / "needlework", Path(folder), needles, box / shorter ** (1 / 3),
               max(1, collisions / shorter), n)
    case = {"name": f"{name}/{kind}/threads:{n}", "threads": n, "needles": needles,
            "us_per_collision": [us]}
    return case | ({"cache_line_ns": cache_line(build)} if kind == "together" else {})


def measure(build, name, most, shorter, loads, store):
    """One repetition of all settings of a scene. It continues one that was stopped."""
    part = part_of(name, loads)
    cases = store.begun(part)
    with tempfile.TemporaryDirectory() as folder:
        for kind, n in settings_of(name, most, loads)[len(cases):]:
            if name in ENSEMBLE:
                cases.append(measure_ensemble(build, name, kind, n, shorter, folder))
            else:
                file = scene_file(name, kind, n, shorter, folder)
                cases.append(measure_one(build, name, kind, n, file))
            store.keep_begun(part, cases)
    hashes = {one for case in cases for one in case.pop("hashes", [])}
    if name not in WEAK and len(hashes) > 1:
        sys.exit(f"{name}: the trajectory depends on the number of threads")
    return "bench/scaling/scaling.py", cases


def short_name(name):
    """Of a scene in tables: a file by its name alone."""
    return name if name in SCENES else Path(name).stem


def part_of(name, loads):
    """The name under which results are kept: those of a file are of its content, too."""
    if name in SCENES:
        return f"scaling-{name}" + ("" if loads or name not in CROWDED else "-no-load")
    return f"scaling-{short_name(name)}-{hashlib.sha256(Path(name).read_bytes()).hexdigest()[:12]}"


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


def busy_table(contents):
    """Wall time of as many threads as cores, over that of one, beside the same programs that never
    rest; empty if that was not measured."""
    rows = []
    for name in CROWDED:
        if name not in contents:
            continue
        gains = speed_ups(contents[name])
        counts = sorted({int(threads.split(":")[1]) for kind, threads in gains if "beside" in kind})
        if not counts:
            continue
        cores = counts[1]  # one, as many as cores, four for each core
        rows.append([name, *(f"{1 / statistics.median(gains[f'beside-{n}', f'threads:{cores}']):.2f}"
                             for n in LOADS)])
    if not rows:
        return ""
    return ("\n## Beside busy programs\n\nWall time of as many threads as cores, over that of one "
            "thread beside the same programs, which never rest.\n\n" + measured.table(
                ["scene", *(f"{n} busy program{'s' if n > 1 else ''}" for n in LOADS)], rows))


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
        f"Made by `bench/scaling/scaling.py`.\n{measured.origin(last)}\n\n"
        + table(contents) + COLUMNS + busy_table(contents) + model(contents))
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
    parser.add_argument("scenes", nargs="*", metavar="SCENE",
                        help=f"{', '.join([*SCENES, 'tables'])}, or a scene file")
    parser.add_argument("--threads", type=int, default=measured.cores())
    parser.add_argument("--repetitions", type=int, default=REPETITIONS)
    parser.add_argument("--no-load", action="store_true", help="no runs beside busy programs")
    measured.add_options(parser)
    arguments = parser.parse_args()
    own = [name for name in arguments.scenes if name.endswith(".toml") and Path(name).is_file()]
    unknown = set(arguments.scenes) - {*SCENES, "tables", *own}
    if unknown:
        parser.error(f"SCENE {' '.join(sorted(unknown))}: expected some of "
                     f"{', '.join([*SCENES, 'tables'])}, or scene files that end in .toml")
    if arguments.threads < 1 or arguments.repetitions < 1:
        parser.error("--threads, --repetitions: expected at least 1")
    store = measured.store_of(arguments)
    rounds = 1 if arguments.quick else arguments.repetitions
    shorter = 10 if arguments.quick else 1
    loads = [] if arguments.no_load else LOADS
    asked = [name for name in arguments.scenes if name != "tables"]
    chosen = asked or ([] if arguments.scenes else list(SCENES))
    # What is measured of the scenes here is one set of results; a scene of the user stands alone.
    shown = asked if own else list(SCENES)
    if chosen:
        measured.measure_rounds(store, {part_of(name, loads): (rounds, lambda name=name: measure(
            arguments.build, name, arguments.threads, shorter, loads, store))
            for name in chosen}, 60 * arguments.time_budget)
    parts = {part_of(name, loads): name for name in shown}
    missing = [name for part, name in parts.items() if store.rounds(part) < rounds]
    contents = {short_name(parts[part]): content
                for part, content in measured.kept_of(store, parts).items()}
    place = store.place(measured.machine_name(arguments.build), complete=False)
    write_results(contents, place)
    print(table(contents))
    measured.report_missing(store, missing, place)


if __name__ == "__main__":
    measured.run(main)
