#!/usr/bin/python3
"""Audits long runs of all effects: every pair of bodies between all its collisions, every hit, kick and
contact. Writes bench/results/audits.md.

    bench/audits/audits.py FOLDER            keeps a result for each scene in FOLDER, and runs those it lacks
    bench/audits/audits.py FOLDER SCENE...   these scenes; the rows of others stay as they are

The scenes beside this script take more than an hour on one core, 1.3e7 collisions together. Exit code 1 if
anything was missed, spurious, late, early, in wrong order or by a wrong rule.
"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "bench/results/audits.md"
WRONG = ("missed", "spurious", "late", "early", "wrong_order", "wrong_rule", "wrong_start", "wrong_end")


def commit():
    return subprocess.run(["git", "-C", ROOT, "rev-parse", "--short=8", "HEAD"],
                          capture_output=True, text=True, check=False).stdout.strip()


def audited(program, scene, folder):
    result = folder / f"{scene.stem}.json"
    if not result.exists():
        done = subprocess.run([program, "audit", scene, "--json", "--quiet"], capture_output=True,
                              text=True, check=False)
        if done.returncode not in (0, 1):
            raise SystemExit(f"{scene.name}: {done.stderr.strip()}")
        result.write_text(json.dumps({**json.loads(done.stdout), "commit": commit()}))
    return json.loads(result.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("scenes", nargs="*", help="names of files beside this script, without .toml")
    parser.add_argument("--program", default=ROOT / "build/release/needlework")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    rows = rows_of_earlier() if arguments.scenes else {}
    wrong = 0
    for scene in sorted(HERE.glob("*.toml")):
        if arguments.scenes and scene.stem not in arguments.scenes:
            continue
        found = audited(arguments.program, scene, arguments.folder)
        bad = sum(found[name] for name in WRONG)
        wrong += bad
        rows[scene.stem] = (f"| [{scene.stem}](../audits/{scene.name}) | {found['collisions']} | "
                            f"{found['checked']:.3g} | {found['hits'] + found['draws'] + found['kicks']} | "
                            f"{bad} | {found['undecided']} | {found['commit']} |")
        print(rows[scene.stem], flush=True)
    all_of = sum(int(row.split("|")[2]) for row in rows.values())
    text = f"""# Long audits

Made by `bench/audits/audits.py`. Each scene has 60 to 120 bodies; the audit follows every pair between all collisions. With none wrong in {all_of} collisions, fewer than {3 / all_of:.2g} of the contacts of such scenes are missed, on average over them (95 %).

| scene | collisions | flights of pairs | hits, kicks, draws of the thermostat | missed, spurious, late, early, in wrong order, by a wrong rule, wrong start or end | undecided | commit |
| --- | --- | --- | --- | --- | --- | --- |
"""
    RESULTS.write_text(text + "".join(f"{row}\n" for _, row in sorted(rows.items())))
    return 1 if wrong else 0


def rows_of_earlier():
    """By scene."""
    return {match[1]: match[0] for match in re.finditer(r"^\| \[(\w+)\].*$", RESULTS.read_text(), re.M)}


if __name__ == "__main__":
    sys.exit(main())
