#!/usr/bin/python3
"""Measures everything on this machine and makes the tables and the picture.

    bench/study.py                 all but matrix, 20 minutes; build first, with NEEDLEWORK_BENCH=ON
    bench/study.py density size    some parts only
    bench/study.py matrix          each search by each queue, 40 minutes
    bench/study.py tables          no measuring: tables and picture anew from the files

Writes results/MACHINE-ISA/: one JSON file for each part, README.md and density.svg. A machine is
called by its processor; --machine gives it another name.
"""

import argparse
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

BENCH = Path(__file__).resolve().parent
ROOT = BENCH.parent

# Parts of the study that `needlework bench` measures, with the flags for it.
SCENES = {
    "steps": [],
    "searches": [],
    "queues": [],
    "isa": [],
    "density": [],
    "size": ["--repetitions", "3"],  # a baseline of 1e6 needles takes its time
    "matrix": ["--repetitions", "2", "--min-time", "0.5"],
    "storage": ["--repetitions", "3"],
    "hulls": ["--repetitions", "3"],
    "cloud": ["--repetitions", "3"],
    "effects": [],
}
# Parts that have an executable of their own, with Google Benchmark.
ALONE = ["kernels", "calendars"]
PROGRAM_OF = {"kernels": "bench_kernels", "calendars": "bench_queues"}


def output_of(command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def commit():
    """The commit that is measured, and whether files differ from it."""
    head = output_of(["git", "-C", str(ROOT), "rev-parse", "--short=12", "HEAD"]).strip()
    changed = output_of(["git", "-C", str(ROOT), "status", "--porcelain", "--untracked-files=no",
                         "--", ":!bench/results"])
    return head + (" with changes" if changed.strip() else "")


def write_json(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1) + "\n")
    print(f"wrote {path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path}")


def measure_scenes(build, part, flags):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "results.json"
        subprocess.run([str(build / "needlework"), "bench", part, "--json", str(file), *flags],
                       check=True)
        results = json.loads(file.read_text())
    command = " ".join(["needlework", "bench", part, *flags])
    return {"command": command, "commit": commit(), **results}


def measure_alone(build, part, repetitions=3):
    """Best of interleaved repetitions, by name."""
    flags = [f"--benchmark_repetitions={repetitions}", "--benchmark_min_time=0.1",
             "--benchmark_enable_random_interleaving=true", "--benchmark_format=json"]
    program = str(build / PROGRAM_OF[part])
    names = output_of([program, "--benchmark_list_tests"]).split()
    raw = json.loads(output_of([program, *flags]))
    best = {}
    for one in raw["benchmarks"]:
        if one["run_type"] != "iteration":
            continue
        rate = one["items_per_second"]
        figures = {"ns_per_item": 1e9 / rate}
        for counter in "pairs_per_cycle", "evaluations_per_pair":
            if counter in one:
                figures[counter] = one[counter]
        name = one["run_name"].removesuffix("/repeats:%d" % repetitions)
        if name not in best or figures["ns_per_item"] < best[name]["ns_per_item"]:
            best[name] = figures
    about = json.loads(output_of([str(build / "needlework"), "bench", "smoke", "--repetitions", "1",
                                  "--min-time", "0", "--json"]))
    return {"command": " ".join([PROGRAM_OF[part], *flags[:-1]]), "commit": commit(),
            **{key: about[key] for key in ("machine", "cores", "compiler", "flags", "version",
                                           "date")},
            "best": {name: best[name] for name in names}}


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines) + "\n"


def number(x):
    """Three digits."""
    if x == 0 or not math.isfinite(x):
        return "-"
    x = float(f"{x:.2e}")
    digits = max(0, 2 - math.floor(math.log10(abs(x))))
    return f"{x:.{digits}f}"


def engine_of(case):
    """What is special about a case: its name without scene, accuracy and threads."""
    words = case["name"].split("/")
    return "/".join([words[1], words[2], words[4], *words[6:]])


COUNTERS = ["events", "searches", "candidates", "evaluated", "rebuilds"]  # per collision


def case_table(results):
    rows = []
    for case in results["cases"]:
        per_collision = case["per_collision"]
        rows.append([case["scene"], engine_of(case) + (" (baseline)" if case["baseline"] else ""),
                     case["search"], number(case["best_us_per_collision"]),
                     number(case["median_us_per_collision"]), number(case["times_baseline"]),
                     f"{case['collisions_per_cpu_s']:.0f}",
                     *(number(per_collision[name]) for name in COUNTERS),
                     f"{min(case['bytes_per_needle']):.0f}", number(min(case["setup_s"]))])
    return table(["scene", "search/queue/ISA", "search in use", "us per collision, best", "median",
                  "times baseline", "collisions per CPU s", *COUNTERS,
                  "bytes per needle", "set-up s"], rows)


def by_scene(results):
    """Scene to {search as asked for, or "baseline": case}, in the order measured."""
    out = {}
    for case in results["cases"]:
        asked = "baseline" if case["baseline"] else case["name"].split("/")[1]
        out.setdefault(case["scene"], {})[asked] = case
    return out


def density_table(results):
    rows, cost = [], {}
    for cases in by_scene(results).values():
        best = {asked: case["best_us_per_collision"] for asked, case in cases.items()}
        by_hand = min(best["linked-cells"], best["capsules"])
        density = next(iter(cases.values()))["density"]
        cost[density] = best["auto"]
        rows.append([number(density), *(number(best[asked]) for asked in
                                        ("baseline", "linked-cells", "capsules", "auto")),
                     cases["auto"]["search"], f"{100 * (best['auto'] / by_hand - 1):+.0f} %",
                     number(best["baseline"] / best["auto"]),
                     *(number(cases["auto"]["per_collision"][name]) for name in COUNTERS)])
    wide = [us for density, us in cost.items() if 0.49 < density < 51]
    text = table(["n L^3", "baseline", "linked-cells", "capsules", "auto", "which is",
                  "auto over best by hand", "times baseline",
                  *(f"{name}, auto" for name in COUNTERS)], rows)
    return text + f"\nSpread of `auto` over n L^3 = 0.5 to 50: {number(max(wide) / min(wide))}.\n"


def size_table(results):
    rows, cost = [], {}
    for cases in by_scene(results).values():
        auto, baseline = cases["auto"], cases["baseline"]
        needles, density = auto["needles"], auto["density"]
        cost[needles, round(density, 2)] = auto["best_us_per_collision"]
        rows.append([needles, number(density), number(baseline["best_us_per_collision"]),
                     number(auto["best_us_per_collision"]), number(auto["times_baseline"]),
                     f"{min(auto['bytes_per_needle']):.0f}", number(min(auto["setup_s"]))])
    text = table(["needles", "n L^3", "baseline", "auto", "times baseline", "bytes per needle",
                  "set-up s"], rows)
    if {(10**6, 0.72), (10**4, 0.72)} <= cost.keys():
        ratio = cost[10**6, 0.72] / cost[10**4, 0.72]
        text += f"\nCost at 1e6 needles over that at 1e4, n L^3 = 0.72: {number(ratio)}.\n"
    return text


def hull_table(results):
    """Sizes of hulls by hand, beside the one that the search chooses."""
    scenes, baselines = {}, {}
    for case in results["cases"]:
        if case["baseline"]:
            baselines[case["scene"]] = case["best_us_per_collision"]
        else:
            scenes.setdefault(case["scene"], []).append(case)
    rows = []
    for scene, cases in scenes.items():
        us = [case["best_us_per_collision"] for case in cases]
        chosen = next(case["best_us_per_collision"] for case in cases
                      if not re.search("/(side|radius):", case["name"]))
        rows.append([scene, cases[0]["search"], *map(number, us),
                     f"{100 * (chosen / min(us) - 1):.0f} %", number(baselines[scene])])
    return table(["scene", "search", "half of it", "0.7", "0.85", "as chosen", "1.2", "1.4",
                  "twice", "chosen over best", "baseline"], rows)


def matrix_table(results):
    """One line for each gas and search: every queue; and for the better search, how far the
    tournament, which `auto` takes, is from the best."""
    scenes, spreads = {}, []
    for case in results["cases"]:
        scenes.setdefault(case["scene"], []).append(case)
        spreads.append(max(case["us_per_collision"]) / min(case["us_per_collision"]))
    rows, queues = [], []
    for scene, cases in scenes.items():
        us = {tuple(case["name"].split("/")[1:3]): case["best_us_per_collision"] for case in cases
              if not case["baseline"]}
        baseline = next(case["best_us_per_collision"] for case in cases if case["baseline"])
        queues = list(dict.fromkeys(queue for _, queue in us))
        best = min(us.values())
        for search in dict.fromkeys(search for search, _ in us):
            mine = us[search, "tournament"]
            better = best in (us[search, queue] for queue in queues)
            over = f"{100 * (mine / best - 1):+.0f} %" if better else ""
            rows.append([scene, search, *(number(us[search, queue]) for queue in queues), over,
                         number(baseline), number(baseline / mine)])
    repetitions = len(results["cases"][0]["us_per_collision"])
    spread = sorted(spreads)[len(spreads) // 2]
    return table(["scene", "search", *queues, "tournament over best", "baseline",
                  "tournament, times baseline"], rows) + (
        f"\nBest of {repetitions} repetitions each, which differ by {100 * (spread - 1):.0f} % at the "
        f"median and by {100 * (max(spreads) - 1):.0f} % at most: queues that differ by less are not "
        f"told apart here.\n")


def kernel_table(results):
    best = results["best"]
    lanes = [name for name in best if name.count("/") == 2]
    isas = list(dict.fromkeys(name.split("/")[2] for name in lanes))
    rows = []
    for kernel in dict.fromkeys(name.rsplit("/", 1)[0] for name in lanes):
        ns = {isa: best[f"{kernel}/{isa}"]["ns_per_item"] for isa in isas}
        rows.append([kernel, *(number(ns[isa]) for isa in isas),
                     number(best[f"{kernel}/{isas[-1]}"]["pairs_per_cycle"]),
                     number(ns["scalar"] / min(ns.values()))])
    text = table(["by lanes", *isas, f"pairs per cycle, {isas[-1]}", "times scalar"], rows)
    rows = [[name, number(one["ns_per_item"]), number(one["pairs_per_cycle"])]
            for name, one in best.items() if name not in lanes]
    return text + "\n" + table(["in double", "ns per pair", "pairs per cycle"], rows)


def calendar_table(results):
    best = results["best"]
    sizes = sorted({int(name.split("/")[2]) for name in best})
    rows = [[row + (" (baseline)" if "indexed-heap" in row else ""),
             *(number(best[f"{row}/{size}"]["ns_per_item"]) for size in sizes)]
            for row in dict.fromkeys(name.rsplit("/", 1)[0] for name in best)]
    return table(["ns per event", *(f"{size:.0e}".replace("e+0", "e") for size in sizes)], rows)


SECTIONS = [  # part, title, what makes its table
    ("steps", "From the baseline on, step by step", case_table),
    ("searches", "Searches", case_table),
    ("density", "Density: us per collision of 10000 needles", density_table),
    ("size", "Size: us per collision", size_table),
    ("matrix", "Every search by every queue: us per collision", matrix_table),
    ("storage", "Storage by place or by id", case_table),
    ("hulls", "Sides of cells and radii of capsules: us per collision", hull_table),
    ("cloud", "A cloud: cells for the whole box, and as chosen", case_table),
    ("queues", "Queues", case_table),
    ("isa", "Instruction sets", case_table),
    ("effects", "Effects", case_table),
    ("calendars", "Calendars by themselves", calendar_table),
    ("kernels", "Kernels by themselves: ns per pair", kernel_table),
]


def draw_density(results, file):
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "needlework", "font.size": 11})
    from matplotlib import pyplot
    from matplotlib.ticker import FixedLocator, NullLocator

    figure, axes = pyplot.subplots(figsize=(6.4, 4.2))
    styles = {"baseline": ("0.45", "o", "classical method"), "linked-cells": ("C0", "s", None),
              "capsules": ("C3", "^", None)}
    scenes = by_scene(results)
    for asked, (colour, marker, label) in styles.items():
        points = [(cases[asked]["density"], cases[asked]["best_us_per_collision"])
                  for cases in scenes.values()]
        axes.loglog(*zip(*points), color=colour, marker=marker)
        axes.annotate(label or asked, points[-1], xytext=(8, 0), textcoords="offset points",
                      color=colour, va="center")
    axes.set_xlabel("needles per L$^3$")
    axes.set_ylabel("CPU time per collision [µs]")
    axes.set_title("10000 needles, one thread", fontsize=11)
    axes.set_xlim(right=300)  # room for the names
    for axis, ticks in (axes.xaxis, [0.1, 0.5, 1, 5, 10, 50]), (axes.yaxis, [5, 10, 20, 50, 100, 200]):
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
    axes.grid(True, color="0.9")
    for side in "top", "right":
        axes.spines[side].set_visible(False)
    figure.tight_layout()
    figure.savefig(file, metadata={"Date": None})


def make_tables(folder):
    found = {part: json.loads((folder / f"{part}.json").read_text())
             for part, _, _ in SECTIONS if (folder / f"{part}.json").exists()}
    if not found:
        sys.exit(f"{folder}: expected results; measure first")
    text = f"# Measured on {folder.name}\n\nMade by `bench/study.py`; see [bench](../../README.md).\n"
    if "density" in found:
        draw_density(found["density"], folder / "density.svg")
        text += "\n![Time per collision against density](density.svg)\n"
    for part, title, make in SECTIONS:
        if part not in found:
            continue
        results = found[part]
        text += (f"\n## {title}\n\n`{results['command']}`, commit {results['commit']}, "
                 f"{results['date'][:10]}; {results['machine']}, {results['cores']} cores; "
                 f"{results['compiler']}, {results['flags']}.\n\n{make(results)}")
    (folder / "README.md").write_text(text)


def machine_name(build):
    version = output_of([str(build / "needlework"), "--version"])
    widest = re.search(r"^ISA +(.*)$", version, re.M)[1].split()[-1]
    processor = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(), re.M)
    words = re.sub(r"[^a-z0-9]+", "-", processor[1].lower() if processor else "machine").strip("-")
    return f"{words}-{widest}"


def main():
    parts = [*SCENES, *ALONE]
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART",
                        help=f"{', '.join(parts)} or tables; all if none is named")
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--machine", help="name of the folder in results/")
    parser.add_argument("--quick", action="store_true",
                        help="one short repetition of each: to try the study itself")
    arguments = parser.parse_args()
    chosen = arguments.parts or [part for part in parts if part != "matrix"]
    unknown = set(chosen) - {*parts, "tables"}
    if unknown:
        parser.error(f"PART {' '.join(unknown)}: expected {', '.join(parts)} or tables")
    folder = BENCH / "results" / (arguments.machine or machine_name(arguments.build))
    for part in chosen:
        if part in SCENES:
            flags = ["--repetitions", "1", "--min-time", "0"] if arguments.quick else SCENES[part]
            write_json(folder / f"{part}.json", measure_scenes(arguments.build, part, flags))
        elif part in ALONE:
            repetitions = 1 if arguments.quick else 3
            write_json(folder / f"{part}.json",
                       measure_alone(arguments.build, part, repetitions))
    make_tables(folder)
    print(f"wrote {folder}/README.md")


if __name__ == "__main__":
    main()
