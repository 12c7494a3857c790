#!/usr/bin/env python3
"""Writes the tables of ../reproduction.md, and of the pages of what goes beyond the paper, from
claims-all.json, which `needlework reproduce all` has written. Each table stands in one of the
documents, between <!-- table FIGURE --> and <!-- end -->.

    tables.py           replaces the tables
    tables.py --check   exit code 1 if they are others, or if a verdict does not follow from its numbers
"""

import json
import math
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
DOCUMENTS = [HERE.parent / f"{name}.md" for name in (
    "reproduction", "driven-gas", "vibrated-layer", "cooling-between-walls", "sedimentation", "rods",
    "needle-liquid")]
CLAIMS = HERE / "claims-all.json"
TABLE = re.compile(r"(<!-- table (\S+) -->\n).*?(<!-- end -->)", re.S)


def number(value):
    """In four digits, without an exponent where one can do without."""
    return "–" if value is None else f"{value:.4g}".replace("-", "−")


def measured(row):
    value, error = row["measured"], row["error"]
    if value is None:
        return "–"
    if not error or not math.isfinite(error):
        return f"{value:.7g}".replace("-", "−")
    digits = max(0, 1 - math.floor(math.log10(error)))
    return f"{value:.{digits}f} ± {error:.{digits}f}".replace("-", "−")


def stated(row):
    if row["paper"] is None:
        return "–"
    precision = row["precision"]
    return number(row["paper"]) + ("" if precision is None else f" ± {number(precision)}")


def verdict(row):
    """By the rule of the document, apart from the program's own."""
    paper, precision, value, error = (row[k] for k in ("paper", "precision", "measured", "error"))
    if None in (paper, precision, value, error) or error > precision:
        return "open"
    if row["seeds"] is not None and row["seeds"] < 3:
        return "open"
    return "agrees" if abs(value - paper) <= 3 * error + precision else "differs"


def table(rows):
    lines = ["| statement | of | stated | measured | seeds | verdict |", "|---|---|---|---|---|---|"]
    last = None
    for row in rows:
        statement = row["statement"] + " *" + row["quantity"] + "*"
        if row["reading"]:
            statement += f" ({row['reading']})"
        lines.append(" | ".join(["| " + (statement if row["claim"] != last else ""),
                                 row["variant"] or "", stated(row), measured(row),
                                 "–" if row["seeds"] is None else str(row["seeds"]),
                                 f"**{row['verdict']}** |"]))
        last = row["claim"]
    return "\n".join(lines) + "\n"


def main():
    rows = json.loads(CLAIMS.read_text())["claims"]
    wrong = [row["id"] for row in rows if row["verdict"] != verdict(row)]
    if wrong:
        sys.exit(f"{CLAIMS}: the verdicts do not follow from the numbers of {', '.join(wrong)}")
    texts = {document: document.read_text() for document in DOCUMENTS}
    places = [match[2] for text in texts.values() for match in TABLE.finditer(text)]
    figures = {row["figure"] for row in rows}
    if missing := figures.symmetric_difference(places):
        sys.exit(f"{HERE.parent}: expected one table of each figure of the claims: "
                 f"{', '.join(sorted(missing))}")
    # A claim that several variants measure stays together.
    def of(figure):
        mine = [row for row in rows if row["figure"] == figure]
        order = list(dict.fromkeys(row["claim"] for row in mine))
        return table(sorted(mine, key=lambda row: order.index(row["claim"])))

    for document, text in texts.items():
        new = TABLE.sub(lambda match: match[1] + of(match[2]) + match[3], text)
        if "--check" not in sys.argv:
            document.write_text(new)
        elif new != text:
            sys.exit(f"{document}: its tables are not those of {CLAIMS.name}: "
                     "docs/reproduction/tables.py writes them")


if __name__ == "__main__":
    main()
