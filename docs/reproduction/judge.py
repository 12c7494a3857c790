#!/usr/bin/env python3
"""Judges the measurements in claims-all.json again, by the claims of profiles/paper as they
are now, and prints each verdict that is another. No run is needed.

    PYTHONPATH=build/release/python /usr/bin/python3 docs/reproduction/judge.py
"""

import json
import math
from pathlib import Path

from needlework.reproduce import Measured, Measurement, Row, read_claims
from needlework.reproduce.claims import json_text
from needlework.reproduce.figures import FIGURES

HERE = Path(__file__).resolve().parent
PAPER = HERE.parents[1] / "profiles/paper"


def judged(row, claims):
    value, error = (math.nan if row[key] is None else row[key] for key in ("measured", "error"))
    measured = Measured(value, error, row["seeds"])
    return Row.of(FIGURES[row["figure"]],
                  Measurement(row["claim"], measured, row["variant"] or ""), claims)


if __name__ == "__main__":
    path = HERE / "claims-all.json"
    results = json.loads(path.read_text())
    claims = read_claims(PAPER / "claims.toml")
    new = [judged(row, claims) for row in results["claims"]]
    for row, old in zip(new, results["claims"]):
        if row.verdict != old["verdict"]:
            print(f"{old['verdict']} -> {row.verdict}: {row.id}")
    path.write_text(json_text(new, results["size"]))
