#!/usr/bin/python3
"""Measures what docs/performance.md shows, on this machine and at one commit, and puts its tables there.

    bench/performance.py                     about 15 minutes on two quiet cores
    bench/performance.py --time-budget 20    no longer than that; the same command continues
    bench/performance.py tables              no measuring: puts what there is into the document

Build first, with NEEDLEWORK_BENCH=ON, from a commit without changes. Repetitions of everything are
interleaved. When all are complete, tables, pictures and compact files replace those of this machine in
bench/results/MACHINE-ISA/, and the tables between comments in docs/performance.md, and words of the
README, are written again; until then they are in study/results/ in the folder of the build, and the
documents stay as they are. What the document has no place for, such as instruction sets, mixtures and
busy machines, is in bench/results alone.
Instructions per collision, which do not depend on the machine, are counted last, after the time budget;
`--no-instructions` leaves them out.
"""

import argparse
import statistics
import subprocess
import sys
from pathlib import Path

BENCH = Path(__file__).resolve().parent
sys.path.append(str(BENCH / "scaling"))
import measured  # noqa: E402
import scaling  # noqa: E402
import study  # noqa: E402
from measured import quotients, spread, table  # noqa: E402
from readme import lead_links_to, put_table  # noqa: E402

DOCUMENT = "performance.md"
# Parts of study.py and how often they are measured; a round of all takes 4 minutes, one of all scenes
# of scaling.py 2.
PARTS = {"steps": 4, "isa": 4, "density": 4, "size": 3, "cloud": 4, "mixtures": 3, "queues": 3,
         "kernels": 3, "calendars": 3}
SCALING_ROUNDS = 4


def cost(case):
    return spread(case["us_per_collision"])


def origin_line(content):
    return measured.origin(content) + "\n\n"


def classical_table(content):
    """The classical method and `auto`, over the density."""
    rows, middles = [], []
    for cases in study.by_scene(content).values():
        auto, baseline = cases["auto"], cases["baseline"]
        if 0.49 < auto["density"] < 51:
            middles.append(statistics.median(auto["us_per_collision"]))
        rows.append([auto["needles"], f"{auto['density']:.3g}", cost(baseline), cost(auto),
                     study.times(auto, baseline)])
    return (table(["needles", "n L³", "classical", "`auto`", "times faster"], rows)
            + f"\nFrom n L³ = 0.5 to 50 the cost of `auto` varies by a factor of "
            f"{max(middles) / min(middles):.2f}.\n")


def faster_words(content):
    """For the README."""
    gains = [(cases["auto"]["density"], statistics.median(quotients(
        cases["baseline"]["us_per_collision"], cases["auto"]["us_per_collision"])))
        for cases in study.by_scene(content).values()]
    dilute = [gain for density, gain in gains if density < 1.5]
    density, dense = max(gains)
    return (f"{min(dilute):.1f} to {max(dilute):.1f} times (dilute gas, n L³ up to 1) and "
            f"{dense:.0f} times (n L³ = {density:.3g})")


def step_table(content):
    rows = []
    for scene, (baseline, *steps) in study.baselines_first(content).items():
        isa = steps[-1]["name"].split("/")[4]
        labels = ["classical", f"search `{steps[0]['search']}`", f"+ SIMD ({isa})",
                  f"+ calendar `{steps[-1]['queue']}`"]
        for case, label in zip([baseline, *steps], labels, strict=True):
            first = f"{scene}: {case['needles']} needles, n L³ = {case['density']:.3g}"
            rows.append([first if case is baseline else "", label, cost(case),
                         study.times(case, baseline)])
    return table(["scene", "setting", "cost", "times faster"], rows)


def size_table(content):
    rows, cost_of = [], {}
    for cases in study.by_scene(content).values():
        auto, baseline = cases["auto"], cases["baseline"]
        cost_of[auto["needles"], f"{auto['density']:.2g}"] = auto["us_per_collision"]
        rows.append([auto["needles"], f"{auto['density']:.3g}", cost(baseline), cost(auto),
                     study.bytes_of(auto), f"{statistics.median(auto['setup_s']):.2g} s"])
    text = table(["needles", "n L³", "classical", "`auto`", "bytes per needle", "set-up"], rows)
    if (1000000, "0.72") in cost_of:
        ratio = spread(quotients(cost_of[1000000, "0.72"], cost_of[10000, "0.72"]))
        text += f"\nA million dilute needles cost {ratio} times as much per collision as ten thousand.\n"
    return text


def thread_table(contents):
    rows = []
    for name in (*scaling.STRONG, *scaling.ENSEMBLE):
        if name not in contents:
            continue
        gains = scaling.speed_ups(contents[name])
        cases = {tuple(case["name"].split("/")[1:]): case for case in contents[name]["cases"]}
        most = max(case["threads"] for (kind, _), case in cases.items() if kind == "together")
        alone, together = cases["alone", "threads:1"], cases["together", f"threads:{most}"]
        apart = gains.get(("apart", f"threads:{most}"))
        gain = gains["together", f"threads:{most}"]
        rows.append([name, alone["needles"], cost(alone), cost(together), spread(gain),
                     f"{statistics.median(quotients(gain, apart)):.2f}" if apart else ""])
    return table(["scene", "needles", "µs per collision, one thread", "as many as cores", "speed-up",
                  "share of what separate runs reach"], rows)


def blocks(contents, threads):
    """What stands between comments in the document, by name."""
    out = {}
    for part, name, make in (("density", "classical", classical_table), ("steps", "steps", step_table),
                             ("size", "size", size_table)):
        if part in contents:
            out[name] = origin_line(contents[part]) + make(contents[part])
    if threads:
        out["threads"] = origin_line(list(threads.values())[-1]) + thread_table(threads)
    return out


def count_instructions(build):
    for what in ("effects", "shares"):
        subprocess.run([sys.executable, str(BENCH / "instructions.py"), what, "--program",
                        measured.built(build, "needlework")], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="?", choices=["tables"])
    parser.add_argument("--no-instructions", action="store_true",
                        help="no counts of instructions per collision")
    measured.add_options(parser)
    measured.add_machine(parser)
    arguments = parser.parse_args()
    store = measured.store_of(arguments)
    for target in ("bench_kernels", "bench_queues", "bench_scaling"):
        measured.built(arguments.build, target)
    shorter, most = (10, 1) if arguments.quick else (1, 1000)
    threads = measured.cores()
    if threads == 1:
        sys.exit("expected two cores or more, to measure what threads gain")

    def part_job(part):
        measure = study.measure_scenes if part in study.SCENES else study.measure_alone
        return min(most, PARTS[part]), lambda: measure(arguments.build, part, arguments.quick)

    def scaling_job(name):
        return min(most, SCALING_ROUNDS), lambda: scaling.measure(
            arguments.build, name, threads, shorter, scaling.LOADS, store)

    jobs = {part: part_job(part) for part in PARTS}
    jobs |= {scaling.part_of(name, scaling.LOADS): scaling_job(name) for name in scaling.SCENES}
    if arguments.what != "tables":
        measured.measure_rounds(store, jobs, 60 * arguments.time_budget)
    missing = [part for part, (rounds, _) in jobs.items() if store.rounds(part) < rounds]
    kept = measured.kept_of(store, jobs)
    contents = {part: content for part, content in kept.items() if part in PARTS}
    of_threads = {name: kept[part] for name in scaling.SCENES
                  if (part := scaling.part_of(name, scaling.LOADS)) in kept}
    machine = arguments.machine or measured.machine_name(arguments.build)
    place = store.place(machine, not missing)
    if contents:
        study.write_results(contents, machine, place, "performance.py")
    if of_threads:
        scaling.write_results(of_threads, place)
    texts = blocks(contents, of_threads)
    (store.folder / "blocks.md").write_text("\n".join(
        f"<!-- {name} -->\n{text}<!-- end of {name} -->\n" for name, text in texts.items()))
    measured.report_missing(store, missing, place, tracked=True)
    if place.is_relative_to(BENCH):
        for name, text in texts.items():
            put_table(name, text, DOCUMENT)
        put_table("faster", faster_words(contents["density"]), "../README.md")
        lead_links_to(machine)
        print(f"tables put into docs/{DOCUMENT}")
        if not arguments.no_instructions and arguments.what != "tables":
            count_instructions(arguments.build)


if __name__ == "__main__":
    measured.run(main)
