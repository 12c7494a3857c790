#!/usr/bin/python3
"""Measures what accuracy costs in time: cost against error, for each level and knob.

    bench/accuracy/accuracy.py                    everything; continues where it was stopped
    bench/accuracy/accuracy.py pairs tc           some parts
    bench/accuracy/accuracy.py --time-budget 20   for 20 minutes; the same command continues later
    bench/accuracy/accuracy.py tables             no measuring: tables and pictures of what there is

Parts: pairs (first contacts against the oracle), cost, audit, long-audit, drift,
long-drift, return, parting, rates, tc.
README.md says what each measures. Writes accuracy.md, accuracy.svg, tc.svg and the compact
accuracy.json to bench/results/MACHINE-ISA/ when all parts are complete, of one commit and of
the same build; until then to study/results/ in the folder of the build. Needs a build with
NEEDLEWORK_BENCH=ON and tests.
"""

import argparse
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import measured  # noqa: E402
import readme  # noqa: E402
import tables  # noqa: E402

# name of a setting: what differs from the defaults, as keys of [engine]
SETTINGS = {
    "fast": {"accuracy": "fast"},
    "standard": {},
    "rigorous": {"accuracy": "rigorous"},
    "sampling 1/4": {"isolation": "sampling", "sampling_step": 0.25},
    "sampling 1/8": {"isolation": "sampling", "sampling_step": 0.125},
    "sampling 1/32": {"isolation": "sampling", "sampling_step": 1 / 32},
    "sampling 1/128": {"isolation": "sampling", "sampling_step": 1 / 128},
    "intervals": {"isolation": "intervals"},
    "never escalated": {"escalation": "never"},
    "always escalated": {"escalation": "always"},
    "filter double": {"filter": "double"},
    "rigorous, filter float": {"accuracy": "rigorous", "filter": "float"},
    "root 1e-3": {"root_tolerance": 1e-3},
    "root 1e-5": {"root_tolerance": 1e-5},
    "root 1e-7": {"root_tolerance": 1e-7},
}
# Elastic, at the densities of the paper: n L^3 = 0.72 and 11.6.
GASES = {"dilute": 0.7234, "dense": 11.574}


class Bench:
    def __init__(self, build):
        self.program = str(build / "needlework")
        self.pairs_program = str(build / "bench_accuracy")
        self.folder = Path(tempfile.mkdtemp(prefix="accuracy-"))

    def scene(self, needles, density, until, **sections):
        text = f"[needles]\ncount = {needles}\nbox = {max(2.01, (needles / density) ** (1 / 3))}\n"
        text += f"seed = {sections.pop('seed', 1)}\n"
        for section, keys in {"until": until, **sections}.items():
            text += f"[{section}]\n" + "".join(f"{k} = {json.dumps(v)}\n" for k, v in keys.items())
        file = self.folder / "scene.toml"
        file.write_text(text)
        return str(file)

    def run(self, scene, out=None, may_fail=False):
        command = [self.program, "run", scene, "--json", "--quiet", "--threads", "1"]
        if out:
            command += ["--out", str(out), "--force"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode and not may_fail:
            sys.exit(f"{' '.join(command)}: exit {done.returncode}: {done.stderr}")
        if done.returncode:
            return {"error": done.stderr.strip().splitlines()[-1]}
        return json.loads(done.stdout)


def measure_pairs(bench, scale):
    """Each family by each setting that distinguishes pairs: time, misses, errors of times."""
    names = [n for n in SETTINGS if "filter" not in SETTINGS[n]]
    texts = {n: ",".join([SETTINGS[n].get("accuracy", "standard")] + [
        f"{k}={v}" for k, v in SETTINGS[n].items() if k != "accuracy"]) for n in names}
    out = {}
    for family in measured.output_of([bench.pairs_program, "--families"]).split():
        count = int(scale * (200_000 if family.startswith("thermal") else 20_000))
        answer = json.loads(measured.output_of([bench.pairs_program, family, "--pairs", str(count),
                                             "--accuracy", *texts.values()]))
        for name, result in zip(names, answer["results"]):
            result["accuracy"] = name
        out[family] = answer
        print(family, flush=True)
    return out


def measure_cost(bench, scale):
    """CPU time of the event loop per collision, one repetition: each setting, and a run of
    `standard` just before it, so that its ratio to that is of the same moment."""
    def run(gas, name):
        per_needle = scale * (1 if "rigorous" in name else 6)
        return bench.run(bench.scene(8000, GASES[gas], {"collisions_per_needle": per_needle},
                                     engine=SETTINGS[name]))["us_per_collision"]

    cases = []
    for gas in GASES:
        of_standard = []
        for name in SETTINGS:
            if name == "standard":
                continue
            before, after = run(gas, "standard"), run(gas, name)
            of_standard.append(before)
            cases.append({"name": f"{gas}/{name}", "us_per_collision": [after],
                          "over_standard": [after / before]})
        cases.append({"name": f"{gas}/standard", "over_standard": [1.0],
                      "us_per_collision": [statistics.median(of_standard)]})
    return "bench/accuracy/accuracy.py", cases


def measure_audit(bench, scale):
    """Every contact of a small gas, checked by the audit."""
    out = []
    for gas, density in GASES.items():
        for name, engine in SETTINGS.items():
            scene = bench.scene(400, density, {"collisions_per_needle": 40 * scale}, engine=engine)
            done = subprocess.run([bench.program, "audit", scene, "--json", "--quiet"],
                                  capture_output=True, text=True)
            if done.returncode not in (0, 1):
                out.append({"gas": gas, "accuracy": name, "error": done.stderr.strip()})
                continue
            report = json.loads(done.stdout)
            out.append({"gas": gas, "accuracy": name, **{
                k: report[k] for k in ("collisions", "checked", "missed", "spurious", "late",
                                       "early", "wrong_order", "undecided") if k in report}})
        print(gas, flush=True)
    return out


def measure_long_audit(bench, scale):
    """A million collisions at `standard`, every flight of every pair checked."""
    out = []
    for gas, density in GASES.items():
        scene = bench.scene(400, density, {"collisions_per_needle": 5000 * scale})
        done = subprocess.run([bench.program, "audit", scene, "--json", "--quiet"],
                              capture_output=True, text=True)
        out.append({"gas": gas, "accuracy": "standard", **json.loads(done.stdout)})
        print(gas, flush=True)
    return out


def drift(bench, gas, name, per_needle):
    report = bench.run(bench.scene(1000, GASES[gas], {"collisions_per_needle": per_needle},
                                   engine=SETTINGS[name]))
    return {"gas": gas, "accuracy": name, "collisions": report["collisions"],
            "energy": abs(report["energy"] / report["energy_initial"] - 1),
            "momentum": max(abs(p) for p in report["momentum"]) / 1000}


def measure_drift(bench, scale):
    """Energy and momentum of elastic gases."""
    return [drift(bench, gas, name, (20 if name == "rigorous" else 400) * scale)
            for gas in GASES for name in ("fast", "standard", "rigorous")]


def measure_long_drift(bench, scale):
    """The same over 1e8 collisions."""
    return [drift(bench, "dense", "standard", 200_000 * scale)]


def reverse(source, target):
    """The last frame of a file as a state that flies back."""
    with h5py.File(source) as old, h5py.File(target, "w") as new:
        needles, to = old["particles/needles"], new.create_group("particles/needles")
        old.copy("h5md", new)
        for key in ("position", "velocity", "orientation", "angular_velocity", "image"):
            sign = -1 if key in ("velocity", "angular_velocity") else 1
            group = to.create_group(key)
            group["value"] = sign * needles[key]["value"][-1:]
            group["step"], group["time"] = [0], [0.0]
        old.copy(needles["box"], to, "box")
        for key in ("value", "step", "time"):
            path = f"particles/needles/box/edges/{key}"
            if path in new:
                last = new[path][-1:] if new[path].ndim and len(new[path]) > 3 else new[path][()]
                del new[path]
                new[path] = last


def frames(file):
    with h5py.File(file) as data:
        group = data["particles/needles"]
        box = numpy.asarray(group["box/edges"]["value"] if "value" in group["box/edges"]
                            else group["box/edges"])
        edges = box.reshape(-1, 3)[0] if box.ndim < 3 else numpy.diagonal(box[0])
        return (group["position/value"][0], group["orientation/value"][0],
                group["position/value"][-1], group["orientation/value"][-1], edges)


def measure_return(bench, scale):
    """Distance to the start after n collisions per needle, velocities reversed, and back."""
    out = []
    needles = 200
    for gas, density in GASES.items():
        for name in ("root 1e-3", "root 1e-7", "fast", "standard", "rigorous"):
            for n in (0.5, 1, 2, 3, 4, 6, 8):
                there, turned, back = (bench.folder / f"{f}.h5" for f in ("there", "turned", "back"))
                probe = bench.run(bench.scene(needles, density, {"collisions_per_needle": n},
                                              engine=SETTINGS[name]))
                # Not at the collision, but halfway to the next.
                turn = probe["time"] * (1 + 0.5 / probe["collisions"])
                first = bench.run(bench.scene(needles, density, {"time": turn},
                                              engine=SETTINGS[name]), there)
                reverse(there, turned)
                text = (f"[initial]\nfile = \"{turned}\"\n[until]\ntime = {turn!r}\n[engine]\n"
                        + "".join(f"{k} = {json.dumps(v)}\n" for k, v in SETTINGS[name].items()))
                file = bench.folder / "back.toml"
                file.write_text(text)
                second = bench.run(str(file), back)
                r0, u0, _, _, edges = frames(there)
                _, _, r1, u1, _ = frames(back)
                way = r1 - r0
                way -= edges * numpy.round(way / edges)
                distance = math.sqrt(numpy.mean(numpy.sum(way ** 2, 1) + numpy.sum((u1 - u0) ** 2, 1)))
                out.append({"gas": gas, "accuracy": name, "collisions_per_needle": n,
                            "there": first["collisions"], "back": second["collisions"],
                            "distance": distance})
        print(gas, flush=True)
    return out


def measure_parting(bench, scale):
    """The first collision whose pair differs from that of the rigorous run."""
    out = []
    for gas, density in GASES.items():
        pairs = {}
        for name, engine in SETTINGS.items():
            if "filter" in engine or name == "intervals":
                continue
            file = bench.folder / "events.h5"
            report = bench.run(bench.scene(1000, density, {"collisions_per_needle": 60},
                                           engine=engine, output={"events": True}), file,
                               may_fail=name != "rigorous")
            if "error" in report:
                out.append({"gas": gas, "accuracy": name, **report})
                continue
            with h5py.File(file) as data:
                pairs[name] = data["events/pair"][()]
        truth = pairs.pop("rigorous")
        for name, other in pairs.items():
            size = min(len(truth), len(other))
            differs = numpy.flatnonzero((truth[:size] != other[:size]).any(1))
            first = int(differs[0]) if len(differs) else None
            out.append({"gas": gas, "accuracy": name, "collision": first,
                        "collisions_per_needle": None if first is None else 2 * first / 1000})
        print(gas, flush=True)
    return out


def cooling_curves(bench, scenes):
    """Of each run log10(E/E(0)) at the same times, 10 per decade, up to where the first of them
    ended; the reports of all; and the errors of those that failed."""
    curves, reports, errors = [], [], set()
    for scene in scenes:
        file = bench.folder / "curve.h5"
        report = bench.run(scene, file, may_fail=True)
        if "error" in report:
            errors.add(report["error"])
            continue
        with h5py.File(file) as data:
            times, energy = data["series/energy/time"][()], data["series/energy/value"][()]
        late = times > 0
        curves.append((numpy.log10(times[late]), numpy.log10(energy[late] / energy[0])))
        reports.append(report)
    if not curves:
        return [], [], reports, errors
    begin = max(t[0] for t, _ in curves)
    end = min(t[-1] for t, _ in curves)
    grid = numpy.arange(math.ceil(10 * begin), math.floor(10 * end) + 1) / 10
    return grid, numpy.array([numpy.interp(grid, t, e) for t, e in curves]), reports, errors


def apart(grid, curves, other_grid, other_curves):
    """Where two sets of cooling curves differ most, in standard errors of the difference of means:
    by how many, and by how much there, as a share of E."""
    _, here, there = numpy.intersect1d(numpy.rint(10 * numpy.asarray(grid)),
                                       numpy.rint(10 * numpy.asarray(other_grid)),
                                       return_indices=True)
    if not len(here):
        return {}
    a, b = curves[:, here], other_curves[:, there]
    off = a.mean(0) - b.mean(0)
    error = numpy.sqrt(a.var(0, ddof=1) / len(a) + b.var(0, ddof=1) / len(b))
    known = error > 0
    if not known.any():
        return {"curve_off": 0.0, "curve_errors": 0.0}
    worst = numpy.flatnonzero(known)[numpy.argmax(abs(off[known]) / error[known])]
    return {"curve_off": float(10 ** off[worst] - 1),
            "curve_errors": float(off[worst] / error[worst])}


def measure_rates(bench, scale):
    """Collision rate against the exact one, and the cooling curve against that at standard, in
    standard errors."""
    out = []
    seeds = range(1, 9)
    cooling = {"epsilon": 0.8, "tc_relative": 1e-4}
    names = ["fast", "standard", "rigorous", "sampling 1/4", "sampling 1/8", "sampling 1/32",
             "never escalated", "root 1e-3"]
    for gas, density in GASES.items():
        standard = None
        for name in ["standard", *(n for n in names if n != "standard")]:
            rates, errors = [], set()
            for seed in seeds:
                per_needle = scale * (5 if name == "rigorous" else 40)
                report = bench.run(bench.scene(1000, density, {"collisions_per_needle": per_needle},
                                               engine=SETTINGS[name], seed=seed), may_fail=True)
                if "error" in report:
                    errors.add(report["error"])
                else:
                    rates.append(report["collision_rate"] / report["collision_rate_exact"] - 1)
            grid, curves, reports, failures = cooling_curves(bench, (
                bench.scene(1000, density, {"time": 60 * scale / density}, engine=SETTINGS[name],
                            seed=seed, collisions=cooling) for seed in seeds))
            entry = {"gas": gas, "accuracy": name, "runs": len(rates),
                     "errors": sorted(errors | failures), "cooling_runs": len(reports)}
            if len(rates) > 1:
                error = statistics.stdev(rates) / math.sqrt(len(rates))
                entry |= {"rate_off": statistics.mean(rates), "rate_error": error}
            if len(reports) > 1:
                ratios = [r["energy"] / r["energy_initial"] for r in reports]
                entry |= {"energy_ratio": statistics.mean(ratios),
                          "energy_error": statistics.stdev(ratios) / math.sqrt(len(ratios))}
                standard = standard or (grid, curves)
                entry |= apart(grid, curves, *standard)
            out.append(entry)
            print(gas, name, flush=True)
    return out


def measure_tc(bench, scale):
    """Cost, share of collisions by the t_c rule, and cooling curve against tc_relative; the curves
    are compared with that of the least tc_relative that gets to the end."""
    out = []
    for epsilon in (0.9, 0.8, 0.5):
        reference = None
        for tc in (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1):
            grid, curves, reports, errors = cooling_curves(bench, (
                bench.scene(1000, GASES["dilute"],
                            {"energy_ratio": 1e-3, "collisions_per_needle": 400 * scale,
                             "wall_s": 60}, seed=seed,
                            collisions={"epsilon": epsilon, "tc_relative": tc})
                for seed in range(1, 5)))
            entry = {"epsilon": epsilon, "tc_relative": tc, "runs": len(reports),
                     "errors": sorted(errors)}
            if len(reports) > 1:
                if not reference and all(r["stop"] == "energy" for r in reports):
                    reference = (grid, curves)
                    entry["reference"] = True
                entry |= {"stop": sorted({r["stop"] for r in reports}),
                          "share": statistics.mean(r["tc_collisions"] / r["collisions"]
                                                   for r in reports),
                          **{key: statistics.mean(r[key] for r in reports) for key in
                             ("us_per_collision", "collisions_per_needle", "time")},
                          "energy_ratio": statistics.mean(r["energy"] / r["energy_initial"]
                                                          for r in reports),
                          "log10_time": [round(float(t), 4) for t in grid],
                          "log10_energy": [round(float(e), 4) for e in curves.mean(0)],
                          "log10_error": [round(float(e), 5) for e in
                                          curves.std(0, ddof=1) / math.sqrt(len(curves))]}
                entry["_curves"] = (grid, curves)
            out.append(entry)
            print(epsilon, tc, flush=True)
        for entry in out:
            curves = entry.pop("_curves", None)
            if curves and reference and "reference" not in entry:
                entry |= apart(*curves, *reference)
    return out


PARTS = {"pairs": measure_pairs, "cost": measure_cost, "audit": measure_audit,
         "long-audit": measure_long_audit, "drift": measure_drift, "long-drift": measure_long_drift,
         "return": measure_return, "parting": measure_parting,
         "rates": measure_rates, "tc": measure_tc}
COST_ROUNDS = 7


def measure_part(store, bench, part, scale):
    start = time.monotonic()
    store.save(stored(part), {"scale": scale, "rounds": 1, "command": "bench/accuracy/accuracy.py",
                              "results": PARTS[part](bench, scale)})
    print(f"{part}: {time.monotonic() - start:.0f} s", flush=True)


def certainty_words(cost):
    """For the README: what `standard` takes more than `fast`."""
    over = {case["name"]: statistics.median(case["over_standard"]) for case in cost["cases"]}
    more = sorted(max(0.0, 1 / over[f"{gas}/fast"] - 1) for gas in GASES)
    return f"{100 * more[0]:.0f} to {100 * more[-1]:.0f} %"


def stored(part):
    return f"accuracy-{part}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join([*PARTS, "tables"]))
    parser.add_argument("--readme", action="store_true",
                        help="put the short table into docs/accuracy.md, and words into README.md")
    measured.add_options(parser)
    measured.add_machine(parser)
    arguments = parser.parse_args()
    unknown = set(arguments.parts) - {*PARTS, "tables"}
    if unknown:
        parser.error(f"PART {' '.join(sorted(unknown))}: expected some of "
                     f"{', '.join([*PARTS, 'tables'])}")
    store = measured.store_of(arguments)
    measured.built(arguments.build, "bench_accuracy")
    bench = Bench(arguments.build)
    begin, budget = time.monotonic(), 60 * arguments.time_budget
    scale = 0.02 if arguments.quick else 1
    cost_rounds = 1 if arguments.quick else COST_ROUNDS
    for part in [part for part in arguments.parts or PARTS if part != "tables"]:
        left = budget - (time.monotonic() - begin)
        if part == "cost":
            measured.measure_rounds(store, {stored(part): (cost_rounds, lambda: measure_cost(
                bench, scale))}, left)
        elif left > 0 and store.load(stored(part)) is None:
            measure_part(store, bench, part, scale)
    missing = [part for part in PARTS
               if store.rounds(stored(part)) < (cost_rounds if part == "cost" else 1)]
    data = {name.removeprefix(stored("")): content for name, content in
            measured.kept_of(store, map(stored, PARTS)).items()}
    place = store.place(arguments.machine or measured.machine_name(arguments.build), not missing)
    tables.write(data, SETTINGS, place)
    if arguments.readme:
        if not {"cost", "audit", "pairs"} <= data.keys():
            sys.exit("--readme: expected cost, audit and pairs to be measured")
        readme.put_table("accuracy", "\n".join(tables.brief(data)), "accuracy.md")
        readme.put_table("certainty", certainty_words(data["cost"]), "../README.md")
    if place.is_relative_to(readme.RESULTS):
        readme.lead_links_to(place.name)
    measured.report_missing(store, missing, place, tracked=True)


if __name__ == "__main__":
    measured.run(main)
