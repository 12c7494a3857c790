#!/usr/bin/env python3
"""First contacts that `standard` misses or invents, against the oracle, family by family.

The oracle settles in double what is far from every limit, and the rest in many digits; one pair in
128 is settled both ways. Takes up where it was stopped: what has been counted stays in the file,
and a family that has fewer pairs than asked for continues with others. Stop it at any time (Ctrl-C). Exits
with 1 when a contact was missed or invented outside of the condition limit.

    bench/accuracy/misses.py --file FILE --thermal 5e8 --hard 1e7     # 1 + 3 hours on one core
    bench/accuracy/misses.py --program build/release/bench_rod_accuracy --portion 10000 --file FILE
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import measured  # noqa: E402

THERMAL = ["thermal-k6", "thermal-k2", "any", "contact"]  # of needles; of rods


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=measured.ROOT / "build/release/bench_accuracy")
    parser.add_argument("--file", type=pathlib.Path, required=True, help="results, JSON")
    parser.add_argument("--families", nargs="+", help="only these")
    parser.add_argument("--accuracy", default="standard")
    parser.add_argument("--thermal", type=float, default=5e8, help="pairs of each thermal family")
    parser.add_argument("--hard", type=float, default=1e7, help="pairs of each hard family")
    parser.add_argument("--portion", type=int, default=100_000,
                        help="pairs between two writings of the file, a seed each")
    options = parser.parse_args()
    if not (options.thermal > 0 and options.hard > 0 and options.portion > 0):
        parser.error("--thermal, --hard, --portion: expected a number of pairs above 0")
    program = pathlib.Path(options.program)
    measured.built(program.parent, program.name)
    known = subprocess.run([options.program, "--families"], capture_output=True, text=True,
                           check=True).stdout.split()
    families = options.families or known
    for family in families:
        if family not in known:
            parser.error(f"--families {family}: expected some of {', '.join(known)}")
    counts = json.loads(options.file.read_text()) if options.file.exists() else {}
    if counts.setdefault("accuracy", options.accuracy) != options.accuracy:
        parser.error(f"{options.file}: is about {counts['accuracy']}, not {options.accuracy}")
    before = 100_000 if "families" in counts else options.portion
    if counts.setdefault("portion", before) != options.portion:
        parser.error(f"{options.file}: has portions of {counts['portion']}, not {options.portion}")
    commit = measured.commit()
    asked = {family: options.thermal if family in THERMAL else options.hard for family in families}
    done = counts.setdefault("families", {})
    keep(options.file, counts)  # writes the table also where nothing is left to count
    # Whoever has the least of what is asked of it is next, so that stopping leaves all balanced.
    while True:
        shares = {f: done.get(f, {"pairs": 0})["pairs"] / asked[f] for f in families}
        family = min(families, key=lambda f: shares[f])
        if shares[family] >= 1:
            break
        add_portion(done, family, options)
        if commit not in done[family].setdefault("commits", []):
            done[family]["commits"].append(commit)
        keep(options.file, counts)
    wrong = [f for f in families if done[f]["missed"] or done[f]["spurious"]]
    if wrong:
        print(f"missed or invented: {', '.join(wrong)}; see {options.file.with_suffix('.md')}")
    return 1 if wrong else 0


def add_portion(done, family, options):
    sums = done.setdefault(family, {"pairs": 0, "contacts": 0, "near": 0, "missed": 0,
                                    "spurious": 0, "near_missed": 0, "near_spurious": 0,
                                    "worst_time_error": 0})
    seed = 1 + sums["pairs"] // options.portion
    answer = json.loads(subprocess.run(
        [options.program, family, "--pairs", str(options.portion), "--seed", str(seed), "--accuracy",
         options.accuracy, "--fewest-digits"], capture_output=True, text=True, check=True).stdout)
    result = answer["results"][0]
    for key in ("pairs", "contacts", "near"):
        sums[key] += answer[key]
    for key in ("missed", "spurious", "near_missed", "near_spurious"):
        sums[key] += result[key]
    worst = result["time_error"]["max"]
    sums["worst_time_error"] = max(sums["worst_time_error"], worst or 0)
    clear = sums["pairs"] - sums["near"]
    for kind in ("missed", "spurious"):
        wrong = sums[kind]
        sums[f"{kind}_below"] = (upper_limit(wrong) if wrong else 3) / clear


def upper_limit(count):
    """The Poisson mean at which so few have a chance of 5 %, within 2 %: Wilson and Hilferty's."""
    n = count + 1
    return n * (1 - 1 / (9 * n) + 1.645 / (3 * math.sqrt(n))) ** 3


def keep(path, counts):
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_suffix(".new")
    families = ",\n".join(f"  {json.dumps(name)}: {json.dumps(sums)}"
                          for name, sums in counts["families"].items())
    fresh.write_text(f'{{\n "accuracy": {json.dumps(counts["accuracy"])},\n "portion": {counts["portion"]},\n'
                     f' "families": {{\n{families}\n }}\n}}\n')
    fresh.replace(path)
    path.with_suffix(".md").write_text(table(counts))


def table(counts):
    rows = [["family", "pairs", "contacts", "missed", "spurious",
             "missed at most, per contact, 95 %", "inside the condition limit",
             "of these missed, spurious", "greatest error of a time, inside the limit too", "commit"]]
    rows.append(["---"] * len(rows[0]))
    for family, s in counts["families"].items():
        rows.append([family, f"{s['pairs']:.3g}", s["contacts"], s["missed"], s["spurious"],
                     missed_per_contact(s), s["near"],
                     f"{s['near_missed']}, {s['near_spurious']}", f"{s['worst_time_error']:.1e}",
                     ", ".join(s["commits"])])
    text = "".join("| " + " | ".join(str(cell) for cell in row) + " |\n" for row in rows)
    return (f"# First contacts missed by `{counts['accuracy']}`\n\n"
            "Made by `bench/accuracy/misses.py`: first contacts of one pair at a time (of needles by "
            "`predict()`), against an oracle. No neighbour search, filter in single precision or "
            "calendar takes part. The bound per contact counts contacts without as many as there are "
            "pairs inside the condition limit; `bench/accuracy/README.md` says what that is.\n\n"
            f"{text}")


def missed_per_contact(sums):
    contacts = sums["contacts"] - sums["near"]
    if contacts <= 0:
        return "–"
    return f"{(upper_limit(sums['missed']) if sums['missed'] else 3) / contacts:.1e}"


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
