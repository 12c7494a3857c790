#!/usr/bin/env python3
"""Writes the tables of claims-all.json, which `needlework reproduce all` has written. ../reproduction.md
keeps those of its figures between <!-- table FIGURE --> and <!-- end -->; claims/README.md has those of
all others.

    tables.py           replaces the tables
    tables.py --check   exit code 1 if they are others, or if a verdict does not follow from its numbers
"""

import json
import math
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
DOCUMENT = HERE.parent / "reproduction.md"
CLAIMS = HERE / "claims-all.json"
TABLES = HERE / "claims/README.md"
HEAD = """# Claims and measurements

Written by [tables.py](../tables.py) from [claims-all.json](../claims-all.json). *Stated* is a number with its
precision, *measured* a mean over so many seeds with its standard error.
[Reproduction](../../reproduction.md#how-to-read-the-tables) says what a verdict means.
"""
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
    text = DOCUMENT.read_text()
    places = [match[2] for match in TABLE.finditer(text)]
    figures = list(dict.fromkeys(row["figure"] for row in rows))
    if unknown := set(places).difference(figures):
        sys.exit(f"{DOCUMENT}: expected tables of figures with claims: {', '.join(sorted(unknown))}")

    # A claim that several variants measure stays together.
    def of(figure):
        mine = [row for row in rows if row["figure"] == figure]
        order = list(dict.fromkeys(row["claim"] for row in mine))
        return table(sorted(mine, key=lambda row: order.index(row["claim"])))

    new = {DOCUMENT: TABLE.sub(lambda match: match[1] + of(match[2]) + match[3], text),
           TABLES: "\n".join([HEAD, *(f"## {name}\n\n{of(name)}" for name in figures
                                      if name not in places)])}
    for document, text in new.items():
        if "--check" not in sys.argv:
            document.write_text(text)
        elif not document.exists() or document.read_text() != text:
            sys.exit(f"{document}: its tables are not those of {CLAIMS.name}: "
                     "docs/reproduction/tables.py writes them")


if __name__ == "__main__":
    main()
