"""Tables and pictures of the work-precision study, of what accuracy.py has measured."""

import math
import statistics

import measured
from measured import spread

FAMILY_NAMES = {"thermal-k6": "thermal"}


def hard_families(pairs):
    """Those of hard pairs whose answer the numbers given determine, but for two in a hundred."""
    return [f for f, result in pairs.items()
            if not f.startswith("thermal") and result["near"] < 0.02 * result["pairs"]]


def number(value, digits=2):
    if value is None:
        return "–"
    if value == 0:
        return "0"
    if 0.01 <= abs(value) < 10000:
        return f"{value:.{digits + 1}g}" if abs(value) < 100 else f"{value:.0f}"
    return f"{value:.{digits - 1}e}"


def row(*cells):
    return "| " + " | ".join(str(c) for c in cells) + " |"


def head(*names):
    return [row(*names), row(*["---"] * len(names))]


def by(results, *keys):
    return {tuple(r[k] for k in keys): r for r in results}


def cost_of(data):
    """(gas, setting): its case."""
    return {tuple(case["name"].split("/", 1)): case for case in data["cost"]["cases"]}


def summary(data, names):
    """What do I pay, what do I get: one line for each setting."""
    cost = cost_of(data)
    audit = by(data["audit"]["results"], "gas", "accuracy")
    lines = head("accuracy", "us per collision, dilute", "dense", "over `standard`, dilute", "dense",
                 "ns per thermal pair", "missed per 1e6 thermal pairs", "of 1e6 nearly parallel",
                 "median, greatest error of a thermal time", "contacts missed in audited runs")
    pairs = data["pairs"]["results"]
    found = {f: by(p["results"], "accuracy") for f, p in pairs.items()}
    for name in names:
        us = [spread(cost[gas, name]["us_per_collision"]) for gas in ("dilute", "dense")]
        ratio = [spread(cost[gas, name]["over_standard"]) for gas in ("dilute", "dense")]
        audits = [audit.get((gas, name)) for gas in ("dilute", "dense")]
        missed = ", ".join("fails" if a is None or "error" in a
                           else f"{a['missed']} of {a['collisions']}" for a in audits)
        cells = [f"`{name}`" if name in ("fast", "standard", "rigorous") else name,
                 *us, *ratio]
        thermal = found["thermal-k6"].get((name,))
        if thermal:
            per_million = [1e6 * found[f][name,]["missed"] / pairs[f]["pairs"]
                           for f in ("thermal-k6", "parallel")]
            cells += [spread(thermal["ns_per_pair"]), *[number(m) for m in per_million],
                      f"{number(thermal['time_error']['median'])}, "
                      f"{number(thermal['time_error']['max'])}"]
        else:
            level = "rigorous" if "rigorous" in name else "standard"
            cells += [f"as `{level}`", "", "", ""]
        lines.append(row(*cells, missed))
    return lines


# Lines of the table in docs/accuracy.md.
BRIEF = ["fast", "standard", "rigorous", "rigorous, filter float", "sampling 1/4", "sampling 1/32",
         "root 1e-3"]


def brief(data):
    """What do I pay, what do I get, in short."""
    cost = cost_of(data)
    audit = by(data["audit"]["results"], "gas", "accuracy")
    pairs = data["pairs"]["results"]
    families = hard_families(pairs)
    lines = head("accuracy", "dilute", "dense", "wrong, of 1e6 thermal pairs",
                 "wrong, of 1e6 hard pairs", "99 % of times within", "missed in runs")
    for name in BRIEF:
        us = [spread(cost[gas, name]["us_per_collision"]) for gas in ("dilute", "dense")]
        of_pairs = "rigorous" if name.startswith("rigorous") else name
        found = {f: by(p["results"], "accuracy")[of_pairs,] for f, p in pairs.items()}
        thermal = found["thermal-k6"]
        wrong = [1e6 * sum(found[f]["missed"] + found[f]["spurious"] for f in group)
                 / sum(pairs[f]["pairs"] for f in group)
                 for group in (["thermal-k6"], families)]
        both = [audit[gas, name] for gas in ("dilute", "dense")]
        missed = f"{sum(a['missed'] for a in both)} of {sum(a['collisions'] for a in both)}"
        label = f"`{name}`" if name in ("fast", "standard", "rigorous") else name
        lines.append(row(label, *us, *[number(w) for w in wrong],
                         number(thermal["time_error"]["q99"]), missed))
    return lines


def pairs_table(data):
    lines = []
    for family, result in data["pairs"]["results"].items():
        lines += [f"\n### {FAMILY_NAMES.get(family, family)}: {result['pairs']} pairs, "
                  f"{result['contacts']} contacts, {result['near']} inside the condition limit\n"]
        lines += head("accuracy", "ns per pair", "evaluations", "in double-double", "missed",
                      "spurious", "inside the limit: missed, spurious",
                      "error of times: median", "99 %", "greatest")
        for r in result["results"]:
            t = r["time_error"]
            lines.append(row(r["accuracy"], spread(r["ns_per_pair"]), f"{r['evaluations']:.1f}",
                             f"{r['escalations']:.2f}", r["missed"], r["spurious"],
                             f"{r['near_missed']}, {r['near_spurious']}", number(t["median"]),
                             number(t["q99"]), number(t["max"])))
    return lines


def long_audit_table(data):
    lines = head("gas", "collisions", "flights checked", "missed", "spurious", "late", "early",
                 "wrong order", "undecided", "missed at most, 95 %")
    for r in data["long-audit"]["results"]:
        lines.append(row(r["gas"], r["collisions"], r["checked"], r["missed"], r["spurious"],
                         r["late"], r["early"], r["wrong_order"], r["undecided"],
                         number(3 / r["collisions"] if r["missed"] == 0 else None)))
    return lines


def audit_table(data):
    lines = head("gas", "accuracy", "collisions", "flights checked", "missed", "spurious", "late",
                 "early", "wrong order", "undecided")
    for r in data["audit"]["results"]:
        if "error" in r:
            lines.append(row(r["gas"], r["accuracy"], "the run fails: " + r["error"],
                             *[""] * 7))
        else:
            lines.append(row(r["gas"], r["accuracy"], r["collisions"], r["checked"], r["missed"],
                             r["spurious"], r["late"], r["early"], r["wrong_order"],
                             r["undecided"]))
    return lines


def drift_table(data, part="drift"):
    lines = head("gas", "accuracy", "collisions", "energy off by", "per collision",
                 "momentum off by, per needle")
    for r in data[part]["results"]:
        lines.append(row(r["gas"], r["accuracy"], r["collisions"], number(r["energy"]),
                         number(r["energy"] / r["collisions"]), number(r["momentum"])))
    return lines


def return_table(data):
    results = by(data["return"]["results"], "gas", "accuracy", "collisions_per_needle")
    counts = sorted({k[2] for k in results})
    lines = head("gas", "accuracy", *[f"{n:g}" for n in counts])
    for gas, name in dict.fromkeys(k[:2] for k in results):
        lines.append(row(gas, name, *[number(results[gas, name, n]["distance"]) for n in counts]))
    return lines


def parting_table(data):
    lines = head("gas", "accuracy", "first collision of another pair", "collisions per needle then")
    for r in data["parting"]["results"]:
        if "error" in r:
            lines.append(row(r["gas"], r["accuracy"], "the run fails: " + r["error"], ""))
        else:
            first = r["collision"]
            lines.append(row(r["gas"], r["accuracy"], "none" if first is None else first,
                             number(r["collisions_per_needle"])))
    return lines


def rates_table(data):
    lines = head("gas", "accuracy", "runs", "collision rate off by", "in standard errors",
                 "E/E(0) of the cooling gas at the end",
                 "its curve off most from `standard`", "in standard errors")
    for r in data["rates"]["results"]:
        cells = [r["gas"], r["accuracy"], r["runs"]]
        if "rate_off" in r:
            cells += [f"{100 * r['rate_off']:+.2f} % ± {100 * r['rate_error']:.2f}",
                      f"{r['rate_off'] / r['rate_error']:+.1f}"]
        else:
            cells += ["the runs fail", ""]
        if "energy_ratio" in r:
            failed = r["runs"] - r["cooling_runs"]
            cells += [f"{r['energy_ratio']:.4f} ± {r['energy_error']:.4f}"
                      + (f" ({failed} failed)" if failed > 0 else ""),
                      *(["compared with", ""] if r["accuracy"] == "standard" else curve_cells(r))]
        else:
            cells += ["the runs fail", "", ""]
        lines.append(row(*cells))
    return lines


def curve_cells(result):
    if "curve_off" not in result:
        return ["", ""]
    return [f"{100 * result['curve_off']:+.1f} %", f"{result['curve_errors']:+.1f}"]


def tc_table(data):
    lines = head("epsilon", "tc_relative", "us per collision", "share of t_c collisions",
                 "collisions per needle", "time", "E/E(0) at the end", "its curve off most by",
                 "in standard errors")
    for r in sorted(data["tc"]["results"], key=lambda r: (-r["epsilon"], -r["tc_relative"])):
        cells = [r["epsilon"], number(r["tc_relative"])]
        if "share" in r:
            cells += [f"{r['us_per_collision']:.1f}", f"{100 * r['share']:.1f} %",
                      f"{r['collisions_per_needle']:.1f}", f"{r['time']:.4g}",
                      f"{r['energy_ratio']:.2g}",
                      *(["compared with", ""] if "reference" in r else curve_cells(r))]
        else:
            cells += ["fails: " + "; ".join(r["errors"]), *[""] * 6]
        lines.append(row(*cells))
    return lines


TABLES = [
    ("long-audit", "A million collisions, audited",
     "400 needles at `standard`, every flight of every pair.", long_audit_table),
    ("audit", "Whole runs, audited", "Every flight of every pair of 400 needles.", audit_table),
    ("drift", "Energy and momentum", "Elastic gases of 1000 needles.", drift_table),
    ("long-drift", "1e8 collisions", "The same.",
     lambda data: drift_table(data, "long-drift")),
    ("return", "There and back",
     "Root mean square distance of centres and directors of 200 needles from their start, after so "
     "many collisions per needle, velocities reversed, and as long back. It grows with the gas's own "
     "chaos from what one collision is off by.", return_table),
    ("parting", "Where trajectories part",
     "1000 needles, 60 collisions per needle, against `rigorous`.", parting_table),
    ("rates", "What a user would notice",
     "8 runs each of 1000 needles, 40 collisions per needle (5 at `rigorous`): the elastic collision rate against the exact one, and the energy "
     "of a cooling gas (epsilon 0.8, tc_relative 1e-4), its curve at 10 times per decade: among so "
     "many points one is off by 2 to 3 standard errors by chance.", rates_table),
    ("tc", "Contact time", "4 runs each of 1000 needles, n L^3 = 0.72, cooling to E/E(0) = 1e-3, or "
     "to 400 collisions per needle. Curves are compared, at 10 times per decade, with that of the "
     "least tc_relative that got there; bands are one standard error.\n\n"
     "![cooling curves](tc.svg)", tc_table),
]


def write(data, settings, folder):
    lines = ["# What accuracy costs in time", "",
             "Made by `bench/accuracy/accuracy.py`; bench/accuracy/README.md says what is measured. "
             "A time is the median of interleaved repetitions, with their range in parentheses.", ""]
    if {"cost", "audit", "pairs"} <= data.keys():
        lines += ["![cost against error](accuracy.svg)", "", measured.origin(data["cost"]), "",
                  *summary(data, settings), ""]
        draw(data, folder / "accuracy.svg")
    if "cost" in data:
        content = data["cost"]
        measured.write_compact(folder / "accuracy.json",
                               {key: content[key] for key in content if key != "cases"},
                               content["cases"], "us_per_collision")
    if "tc" in data:
        draw_tc(data["tc"]["results"], folder / "tc.svg")
    for part, title, text, table in TABLES:
        if part in data:
            lines += [f"## {title}", "", text, "", *table(data), ""]
    lines += ["Measured at: " + "; ".join(f"{part} {data[part]['commit']}" for part in data), ""]
    if "pairs" in data:
        lines += ["## Families of pairs", "", "Times of pairs are of five portions of them.",
                  *pairs_table(data), ""]
    (folder / "accuracy.md").write_text("\n".join(lines))


def draw_tc(results, file):
    plt = measured.pyplot()
    epsilons = sorted({r["epsilon"] for r in results}, reverse=True)
    figure, panels = plt.subplots(2, len(epsilons), figsize=(9.6, 5.4), sharey="row", sharex="col")
    limits = sorted({r["tc_relative"] for r in results})
    for (axes, ratio), epsilon in zip(panels.T, epsilons):
        group = [r for r in results if r["epsilon"] == epsilon and "log10_time" in r]
        truth = next((dict(zip(r["log10_time"], r["log10_energy"])) for r in group
                      if "reference" in r), {})
        for r in group:
            style = {"color": plt.cm.viridis(0.9 * limits.index(r["tc_relative"])
                                             / (len(limits) - 1)), "linewidth": 1.2}
            points = list(zip(r["log10_time"], r["log10_energy"]))
            axes.plot([10 ** t for t, _ in points], [10 ** e for _, e in points], **style,
                      label=f"{r['tc_relative']:.0e}")
            errors = r.get("log10_error", [0] * len(points))
            points = [(t, e - truth[t], error) for (t, e), error in zip(points, errors) if t in truth]
            times = [10 ** t for t, _, _ in points]
            ratio.plot(times, [10 ** e for _, e, _ in points], **style)
            if any(errors):
                ratio.fill_between(times, [10 ** (e - error) for _, e, error in points],
                                   [10 ** (e + error) for _, e, error in points],
                                   color=style["color"], alpha=0.25, linewidth=0)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(f"ε = {epsilon}", fontsize=9)
        ratio.set_xlabel("time")
    panels[0, 0].set_ylabel("E / E(0)")
    panels[1, 0].set_ylabel("E over that of the least\ntc_relative that got to the end")
    panels[0, 0].legend(fontsize=7, title="tc_relative", title_fontsize=7)
    measured.save_picture(figure, file)


def draw(data, file):
    plt = measured.pyplot()
    from matplotlib.ticker import LogLocator

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    groups = {"levels": ["fast", "standard", "rigorous"],
              "isolation by sampling": ["sampling 1/4", "sampling 1/8", "sampling 1/32",
                                        "sampling 1/128"],
              "root tolerance": ["root 1e-3", "root 1e-5", "root 1e-7"],
              "isolation by intervals": ["intervals"],
              "escalation": ["never escalated", "always escalated"]}
    pairs = data["pairs"]["results"]
    hard = hard_families(pairs)
    thermal = by(pairs["thermal-k6"]["results"], "accuracy")
    total = sum(pairs[f]["pairs"] for f in hard)
    markers = "osD^v"

    def label(axes, name, x, y):
        short = name.removeprefix("sampling ").removeprefix("root ").removesuffix(" escalated")
        axes.annotate(short, (x, y), fontsize=7, textcoords="offset points",
                      xytext=(3, -10 if name.endswith("escalated") else 4))

    def plot(axes, points, marker, group=None):
        middles = [statistics.median(ns) for ns, _, _ in points]
        ranges = [[m - min(p[0]) for m, p in zip(middles, points)],
                  [max(p[0]) - m for m, p in zip(middles, points)]]
        axes.errorbar(middles, [p[1] for p in points], xerr=ranges, fmt=marker, capsize=2,
                      label=group)

    for marker, (group, names) in zip(markers, groups.items()):
        points = [(thermal[n,]["ns_per_pair"], thermal[n,]["time_error"]["q99"], n)
                  for n in names]
        plot(left, points, marker, group)
        for ns, y, n in points:
            label(left, n, statistics.median(ns), y)
        points = []
        for n in names:
            results = [by(pairs[f]["results"], "accuracy")[n,] for f in hard]
            # Of all families, by portion.
            ns = [sum(r["ns_per_pair"][k] * pairs[f]["pairs"] for f, r in zip(hard, results)) / total
                  for k in range(min(len(r["ns_per_pair"]) for r in results))]
            wrong = sum(r["missed"] + r["spurious"] for r in results) / total
            points.append((ns, wrong, n))
        floor = 0.3 / total
        plot(right, [(ns, max(y, floor), n) for ns, y, n in points], marker)
        for ns, y, n in points:
            if y > 0 or n in groups["levels"]:
                label(right, n, statistics.median(ns), max(y, floor))
    right.axhline(0.3 / total, color="0.8", linewidth=0.8)
    right.annotate("none", (0.01, 0.3 / total), xycoords=("axes fraction", "data"), fontsize=7,
                   color="0.5", xytext=(0, 3), textcoords="offset points")
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
    left.set_xlabel("ns per thermal pair")
    left.set_ylabel("relative error of contact times (99 % are below)")
    right.set_xlabel("ns per hard pair")
    right.set_ylabel("share of hard pairs decided wrongly")
    left.legend(fontsize=8)
    measured.save_picture(figure, file)
