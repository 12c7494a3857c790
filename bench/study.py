#!/usr/bin/python3
"""Measures strategies on this machine, one thread, and makes tables and a picture.

    bench/study.py                     all parts; continues where it was stopped
    bench/study.py density size        some parts only
    bench/study.py --time-budget 60    for an hour; the same command continues later
    bench/study.py tables              no measuring: tables and picture of what there is

Build first, with NEEDLEWORK_BENCH=ON. Repetitions are interleaved: all cases of all parts are
measured once, then all a second time, and so on; tables give the median and the range.
Writes README.md, density.svg and a compact file for each part, which `needlework bench --compare` and
`--results` take, to study/results/ in the folder of the build. What is kept in bench/results is measured
by bench/performance.py.
"""

import argparse
import json
import re
import statistics

import measured
from measured import number, quotients, spread, table

# Parts that `needlework bench` measures, and how often: less often where 1e6 needles take their time.
SCENES = {"steps": 7, "searches": 7, "queues": 7, "isa": 7, "density": 7, "size": 5, "storage": 5,
          "hulls": 5, "cloud": 7, "mixtures": 5, "effects": 7, "matrix": 3}
# Parts that have an executable of their own, with Google Benchmark.
ALONE = {"kernels": 7, "calendars": 5}
MIXTURES = ("Needles of length 1 and longer ones, over needles of one length that collide as often, as "
            "many per cube of the mean length ⟨L⟩: CPU time per collision; behind the semicolon, what "
            "one grid for all needles takes, as `cell_side` or `capsule_radius` have it, over that.\n\n")
PROGRAM_OF = {"kernels": "bench_kernels", "calendars": "bench_queues"}


def measure_scenes(build, part, quick):
    """One repetition of a part by `needlework bench`."""
    flags = ["--repetitions", "1", "--min-time", "0" if quick else "0.25"]
    out = measured.output_of([str(build / "needlework"), "bench", part, *flags, "--json", "--quiet"])
    return f"needlework bench {part}", json.loads(out)["cases"]


def measure_alone(build, part, quick):
    """One repetition of a part by Google Benchmark."""
    flags = [f"--benchmark_min_time={0.001 if quick else 0.1}", "--benchmark_format=json"]
    out = json.loads(measured.output_of([measured.built(build, PROGRAM_OF[part]), *flags]))
    cases = []
    for one in out["benchmarks"]:
        case = {"name": one["run_name"], "ns_per_item": [1e9 / one["items_per_second"]]}
        if "pairs_per_cycle" in one:
            case["pairs_per_cycle"] = [one["pairs_per_cycle"]]
        cases.append(case)
    return PROGRAM_OF[part], cases


def engine_of(case):
    """What is special about a case: its name without scene, accuracy and threads."""
    words = case["name"].split("/")
    return "/".join([words[1], words[2], words[4], *words[6:]])


def by_scene(content):
    """Scene to {search as asked for, or "baseline": case}, in the order measured."""
    out = {}
    for case in content["cases"]:
        asked = "baseline" if case["baseline"] else case["name"].split("/")[1]
        out.setdefault(case["scene"], {})[asked] = case
    return out


def us(case):
    return spread(case["us_per_collision"])


def times(case, baseline):
    """How many times less than the baseline a case takes, by repetition."""
    if case is baseline:
        return "1"
    return spread(quotients(baseline["us_per_collision"], case["us_per_collision"]))


def bytes_of(case):
    return f"{statistics.median(case['bytes_per_needle']):.0f}"


def case_table(content):
    rows = []
    for cases in baselines_first(content).values():
        for case in cases:
            engine = engine_of(case) + (" (baseline)" if case["baseline"] else "")
            rows.append([case["scene"], engine, case["search"], us(case), times(case, cases[0]), bytes_of(case),
                         spread(case["setup_s"])])
    return table(["scene", "search/calendar/ISA", "search in use", "us per collision",
                  "speed-up", "bytes per needle", "set-up s"], rows)


def baselines_first(content):
    """Scene to its cases, of which the baseline is the first, as they were measured."""
    out = {}
    for case in content["cases"]:
        out.setdefault(case["scene"], []).append(case)
    return out


def density_table(content):
    rows, cost = [], {}
    for cases in by_scene(content).values():
        auto = cases["auto"]
        cost[auto["density"]] = statistics.median(auto["us_per_collision"])
        by_hand = min((cases[search] for search in ("linked-cells", "capsules")),
                      key=lambda case: statistics.median(case["us_per_collision"]))
        rows.append([number(auto["density"]), *(us(cases[asked]) for asked in
                                                ("baseline", "linked-cells", "capsules", "auto")),
                     auto["search"],
                     spread(quotients(auto["us_per_collision"], by_hand["us_per_collision"])),
                     times(auto, cases["baseline"])])
    wide = [cost_here for density, cost_here in cost.items() if 0.49 < density < 51]
    text = table(["n L^3", "baseline", "linked-cells", "capsules", "auto", "which is",
                  "auto over best by hand", "speed-up"], rows)
    return (text + f"\nGreatest over least median of `auto`, n L^3 = 0.5 to 50: "
            f"{number(max(wide) / min(wide))}.\n")


def size_table(content):
    rows, cost = [], {}
    for cases in by_scene(content).values():
        auto, baseline = cases["auto"], cases["baseline"]
        cost[auto["needles"], round(auto["density"], 2)] = auto["us_per_collision"]
        rows.append([auto["needles"], number(auto["density"]), us(baseline), us(auto),
                     times(auto, baseline), bytes_of(auto), spread(auto["setup_s"])])
    text = table(["needles", "n L^3", "baseline", "auto", "speed-up", "bytes per needle",
                  "set-up s"], rows)
    ratio = spread(quotients(cost[10**6, 0.72], cost[10**4, 0.72]))
    return text + f"\nCost at 1e6 needles over that at 1e4, n L^3 = 0.72: {ratio}.\n"


def volume_size_table(content):
    """Sizes of cells and capsules by hand, beside those that the search chooses."""
    rows = []
    for scene, (baseline, *cases) in baselines_first(content).items():
        chosen = next(case for case in cases if not re.search("/(side|radius):", case["name"]))
        best = min(cases, key=lambda case: statistics.median(case["us_per_collision"]))
        rows.append([scene, cases[0]["search"], *map(us, cases),
                     spread(quotients(chosen["us_per_collision"], best["us_per_collision"])),
                     us(baseline)])
    return table(["scene", "search", "half of it", "0.7", "0.85", "as chosen", "1.2", "1.4",
                  "twice", "chosen over best", "baseline"], rows)


def matrix_table(content):
    """One line for each gas and search: every calendar; and for the better search, how far the
    tournament, which `auto` takes, is from the best."""
    rows, calendars = [], []
    for scene, (baseline, *cases) in baselines_first(content).items():
        found = {tuple(case["name"].split("/")[1:3]): case for case in cases}
        calendars = list(dict.fromkeys(calendar for _, calendar in found))
        best = min(cases, key=lambda case: statistics.median(case["us_per_collision"]))
        for search in dict.fromkeys(search for search, _ in found):
            mine = found[search, "tournament"]
            better = best["name"].split("/")[1] == search
            rows.append([scene, search, *(us(found[search, calendar]) for calendar in calendars),
                         spread(quotients(mine["us_per_collision"], best["us_per_collision"]))
                         if better else "", us(baseline), times(mine, baseline)])
    return table(["scene", "search", *calendars, "tournament over best", "baseline",
                  "tournament, speed-up"], rows)


def mixture_table(content):
    """Needles of two lengths over those of one length that collide as often, as `auto` has them, and
    what one grid for all of them takes of that; then all cases."""
    cost_of, densities, mixtures = {}, [], []
    for scene, (one_grid, auto) in baselines_first(content).items():
        density, mixture = scene.split(",", 1)
        cost_of[mixture, density] = auto["us_per_collision"], one_grid["us_per_collision"]
        densities += [density] if density not in densities else []
        mixtures += [mixture] if mixture not in mixtures else []
    of_one_length = mixtures.pop(0)

    def cells(mixture):
        for density in densities:
            if (mixture, density) not in cost_of:
                yield "the box is too small"
                continue
            auto, one_grid = cost_of[mixture, density]
            alone, _ = cost_of[of_one_length, density]
            over = statistics.median(quotients(one_grid, auto))
            yield f"{spread(quotients(auto, alone))}; {over:.2f}"

    def words(mixture):
        lengths, share = mixture.split(",")
        return f"{lengths}, {'half of all' if share == '50%' else f'{share[:-1]} % of all'}"

    heads = [density.replace("n=", "n ⟨L⟩³ = ") for density in densities]
    relative = table(["long needles", *heads],
                     [[words(mixture), *cells(mixture)] for mixture in mixtures])
    return MIXTURES + relative + "\n" + case_table(content)


def kernel_table(content):
    found = {case["name"]: case for case in content["cases"]}
    by_isa = [name for name in found if name.count("/") == 2]
    isas = list(dict.fromkeys(name.split("/")[2] for name in by_isa))
    rows = []
    for kernel in dict.fromkeys(name.rsplit("/", 1)[0] for name in by_isa):
        ns = {isa: found[f"{kernel}/{isa}"]["ns_per_item"] for isa in isas}
        best = min(ns.values(), key=statistics.median)
        rows.append([kernel, *(spread(ns[isa]) for isa in isas),
                     spread(found[f"{kernel}/{isas[-1]}"]["pairs_per_cycle"]),
                     spread(quotients(ns["scalar"], best))])
    text = table(["SIMD", *isas, f"pairs per cycle, {isas[-1]}", "times scalar"], rows)
    rows = [[name, spread(case["ns_per_item"]), spread(case["pairs_per_cycle"])]
            for name, case in found.items() if name not in by_isa]
    return text + "\n" + table(["in double", "ns per pair", "pairs per cycle"], rows)


def calendar_table(content):
    found = {case["name"]: case["ns_per_item"] for case in content["cases"]}
    sizes = sorted({int(name.split("/")[2]) for name in found})
    rows = [[row + (" (baseline)" if "indexed-heap" in row else ""),
             *(spread(found[f"{row}/{size}"]) for size in sizes)]
            for row in dict.fromkeys(name.rsplit("/", 1)[0] for name in found)]
    text = table(["ns per event", *(f"{size:.0e}".replace("e+0", "e") for size in sizes)], rows)
    return text + "\n`hold` and `mix` are explained in bench/README.md.\n"


SECTIONS = {  # part: title, what makes its table
    "steps": ("From the baseline on, step by step", case_table),
    "searches": ("Searches", case_table),
    "density": ("Density: us per collision of 10000 needles", density_table),
    "size": ("Size: us per collision", size_table),
    "matrix": ("Every search by every calendar: us per collision", matrix_table),
    "storage": ("Storage by place or by id", case_table),
    "hulls": ("Sides of cells and radii of capsules: us per collision", volume_size_table),
    "cloud": ("A cloud: cells for the whole box, and as chosen", case_table),
    "mixtures": ("Mixtures: in one grid, and as chosen", mixture_table),
    "queues": ("Calendars", case_table),
    "isa": ("Instruction sets", case_table),
    "effects": ("Effects", case_table),
    "calendars": ("Calendars by themselves", calendar_table),
    "kernels": ("Kernels by themselves: ns per pair", kernel_table),
}


def draw_density(content, file):
    pyplot = measured.pyplot()
    from matplotlib.ticker import FixedLocator, NullLocator

    figure, axes = pyplot.subplots(figsize=(6.4, 4.2))
    axes.set_xscale("log")
    axes.set_yscale("log")
    styles = {"baseline": ("0.45", "o", "classical method"), "linked-cells": ("C0", "s", None),
              "capsules": ("C3", "^", None)}
    scenes = by_scene(content).values()
    densities = [cases["baseline"]["density"] for cases in scenes]
    for asked, (colour, marker, label) in styles.items():
        middles = measured.bars(axes, densities,
                                [cases[asked]["us_per_collision"] for cases in scenes],
                                color=colour, marker=marker)
        axes.annotate(label or asked, (densities[-1], middles[-1]), xytext=(8, 0),
                      textcoords="offset points", color=colour, va="center")
    axes.set_xlabel("needles per L³")
    axes.set_ylabel("CPU time per collision [µs]")
    what = "median and range of repetitions" if content["rounds"] > 1 else "one repetition"
    axes.set_title(f"10000 needles, one thread; {what}", fontsize=10)
    axes.set_xlim(right=300)  # room for the names
    for axis, ticks in (axes.xaxis, [0.1, 0.5, 1, 5, 10, 50]), (axes.yaxis, [5, 10, 20, 50, 100, 200]):
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
    axes.grid(True, color="0.9")
    measured.save_picture(figure, file)


def write_results(contents, machine, folder, made_by="study.py"):
    """The tables, the picture and the compact files of what was measured, by part."""
    text = (f"# Measured on {machine}\n\nMade by `bench/{made_by}`. Times are CPU times of the event "
            f"loop; a figure is the median of the repetitions, with their range in parentheses. "
            f"Quotients are taken within each repetition.\n")
    if "density" in contents:
        draw_density(contents["density"], folder / "density.svg")
        text += "\n![Time per collision against density](density.svg)\n"
    for part, (title, make) in SECTIONS.items():
        if part not in contents:
            continue
        content = contents[part]
        text += f"\n## {title}\n\n{measured.origin(content)}\n\n{make(content)}"
        about = {key: content[key] for key in content if key != "cases"}
        if part in SCENES:
            about = {"format": 2, "subset": part, **about}
        measured.write_compact(folder / f"{part}.json", about, content["cases"],
                               "us_per_collision" if part in SCENES else "ns_per_item")
    (folder / "README.md").write_text(text)


def main():
    all_parts = {**SCENES, **ALONE}
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART",
                        help=f"{', '.join(all_parts)} or tables; all if none is named")
    parser.add_argument("--repetitions", type=int, metavar="N",
                        help=f"at most so many; else {min(all_parts.values())} to "
                             f"{max(all_parts.values())}, by part")
    measured.add_options(parser)
    arguments = parser.parse_args()
    unknown = set(arguments.parts) - {*all_parts, "tables"}
    if unknown:
        parser.error(f"PART {' '.join(sorted(unknown))}: expected {', '.join(all_parts)} or tables")
    if arguments.repetitions is not None and arguments.repetitions < 1:
        parser.error(f"--repetitions {arguments.repetitions}: expected at least 1")
    store = measured.store_of(arguments)
    most = arguments.repetitions or (1 if arguments.quick else max(all_parts.values()))

    def jobs(names):
        return {part: (min(most, all_parts[part]), lambda part=part: (
            measure_scenes if part in SCENES else measure_alone)(
                arguments.build, part, arguments.quick)) for part in names}

    chosen = [part for part in arguments.parts or all_parts if part != "tables"]
    if chosen:
        measured.measure_rounds(store, jobs(chosen), 60 * arguments.time_budget)
    missing = [part for part, (rounds, _) in jobs(chosen or all_parts).items()
               if store.rounds(part) < rounds]
    machine = measured.machine_name(arguments.build)
    place = store.place(machine, complete=False)
    write_results(measured.kept_of(store, all_parts), machine, place)
    measured.report_missing(store, missing, place)


if __name__ == "__main__":
    measured.run(main)
