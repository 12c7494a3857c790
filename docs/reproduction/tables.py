#!/usr/bin/env python3
"""Writes what claims-all.json says, which `needlework reproduce all` has written and judge.py
judges again: claims.csv beside the data of the figures has all of it, and documents have tables between
<!-- table NAME --> and <!-- end -->, "paper", the summary of the paper's claims, and "verdicts", which
counts them.

    tables.py           writes the tables
    tables.py --check   exit code 1 if they are others, or if a verdict does not follow from its numbers
"""

import csv
import io
import json
import math
import re
import sys
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
CLAIMS = HERE / "claims-all.json"
TABLE_OF_ALL = HERE / "claims.csv"
PAPER = ("2", "3", "4", "5a", "5b", "6", "7", "8", "fluctuations", "moment", "rotation",
         "relaxation")
TABLE = re.compile(r"(<!-- table (\S+) -->\n).*?(<!-- end -->)", re.S)
COLUMNS = ("figure", "claim", "quantity", "of", "stated", "precision", "reason", "measured",
           "standard error", "half width of the 99 % interval", "seeds", "verdict")

# Student's t within which so many percent lie, by the number of seeds: from tables, apart from the
# program.
STUDENT = {99: {2: 63.6567, 3: 9.92484, 4: 5.84091, 5: 4.60409, 6: 4.03214, 8: 3.49948, 10: 3.24984,
                12: 3.10581, 16: 2.94671},
           95: {2: 12.7062, 3: 4.30265, 4: 3.18245, 5: 2.77645, 6: 2.57058, 8: 2.36462, 10: 2.26216,
                12: 2.20099, 16: 2.13145}}


def number(value):
    """In five digits, without an exponent where one can do without."""
    return "–" if value is None else f"{value:.5g}".replace("-", "−")


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


def half_width(row, percent=99):
    """Of the confidence interval; None without one."""
    if row["seeds"] is None:
        return 0
    if row["seeds"] < 2 or row["error"] is None:
        return None
    return row["error"] * STUDENT[percent][row["seeds"]]


def verdict(row, percent=99):
    """By the rule of the document, apart from the program's own."""
    half = half_width(row, percent)
    if row["paper"] is None or row["measured"] is None or half is None:
        return "open"
    low, high = row["measured"] - half, row["measured"] + half
    least, most = row["paper"] - row["precision"], row["paper"] + row["precision"]
    if least <= low and high <= most:
        return "agrees"
    return "differs" if high < least or low > most else "open"


def table_of_all(rows):
    """A row for each measurement. Without a stated number there is no verdict."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        half = half_width(row)
        judged = row["verdict"].replace("open", "undecided") if row["paper"] is not None else None
        values = (row["figure"], row["statement"], row["quantity"], row["variant"], row["paper"],
                  row["precision"], row["reading"], row["measured"], row["error"],
                  f"{half:.2g}" if half else None, row["seeds"], judged)
        writer.writerow(["" if value is None else value for value in values])
    return text.getvalue()


def summary(rows):
    """A line for each claim of the figures of the paper, with all its measurements."""
    lines = ["| claim | stated | measured | agree/differ/undecided |", "|---|---|---|---|"]
    rows = [row for row in rows if row["figure"] in PAPER and row["paper"] is not None]
    for claim in dict.fromkeys(row["claim"] for row in rows):
        mine = sorted((row for row in rows if row["claim"] == claim),
                      key=lambda row: row["measured"])
        least, most = mine[0], mine[-1]
        found = measured(least) if len(mine) == 1 else short(least)
        if short(most) != short(least):
            found += f" to {short(most)}"
        count = Counter(row["verdict"] for row in mine)
        lines.append(f"| {least['statement']} | {stated(least)} | {found} | "
                     f"{count['agrees']}/{count['differs']}/{count['open']} |")
    return "\n".join(lines) + "\n"


def short(row):
    """A measurement in three digits, or four if they begin with 1."""
    value = row["measured"]
    return f"{value:.{4 if f'{abs(value):e}'[0] == '1' else 3}g}".replace("-", "−")


def verdicts(rows):
    """How many there are of each verdict."""
    lines = ["| measurements | agree | differ | undecided | without number |",
             "|---|---|---|---|---|"]
    paper = [row for row in rows if row["figure"] in PAPER]
    for name, mine, percent in (("of the figures in the summary", paper, 99), ("all", rows, 99),
                                ("all, at 95 %", rows, 95)):
        count = Counter(verdict(row, percent) for row in mine if row["paper"] is not None)
        lines.append(f"| {name} | {count['agrees']} | {count['differs']} | {count['open']} | "
                     f"{len(mine) - sum(count.values())} |")
    return "\n".join(lines) + "\n"


def main():
    rows = json.loads(CLAIMS.read_text())["claims"]
    wrong = [row["id"] for row in rows if row["verdict"] != verdict(row)]
    if wrong:
        sys.exit(f"{CLAIMS}: the verdicts do not follow from the numbers of {', '.join(wrong)}")
    written = {"paper": summary(rows), "verdicts": verdicts(rows)}
    texts = {document: document.read_text() for document in sorted(HERE.parent.rglob("*.md"))}
    places = {match[2] for text in texts.values() for match in TABLE.finditer(text)}
    if unknown := places - written.keys():
        sys.exit(f"{HERE.parent}: expected the tables paper and verdicts, not "
                 f"{', '.join(sorted(unknown))}")
    new = {document: TABLE.sub(lambda match: match[1] + written[match[2]] + match[3], text)
           for document, text in texts.items()}
    new[TABLE_OF_ALL] = table_of_all(rows)
    texts[TABLE_OF_ALL] = TABLE_OF_ALL.read_text() if TABLE_OF_ALL.exists() else ""
    for document, text in new.items():
        if text == texts[document]:
            continue
        if "--check" in sys.argv:
            sys.exit(f"{document}: its tables are not those of {CLAIMS.name}: "
                     "docs/reproduction/tables.py writes them")
        document.write_text(text)


if __name__ == "__main__":
    main()
