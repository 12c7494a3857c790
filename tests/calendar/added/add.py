#!/usr/bin/env python3
"""Adds a calendar to a copy of the sources, by the steps of src/calendar/README.md and no others.

    add.py SOURCE COPY    SOURCE: the root of the sources; COPY: a folder for what changes
"""

import re
import shutil
import sys
from pathlib import Path


def replace(file, pattern, new):
    """Replaces the one place of a file that a pattern fits."""
    text, count = re.subn(pattern, new, file.read_text())
    if count != 1:
        sys.exit(f"{file}: {pattern}: expected one place, there are {count}")
    file.write_text(text)


def main():
    source, copy = Path(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(source / "src/calendar", copy / "src/calendar")
    (copy / "docs").mkdir()
    shutil.copy(source / "docs/scenes.md", copy / "docs")

    # 1. The class in a file of its own.
    shutil.copy(source / "tests/calendar/added/scan.h", copy / "src/calendar")
    # 2. The list.
    replace(copy / "src/calendar/all.h", r'(#include "src/calendar/lazy_heap.h"\n)',
            r'\1#include "src/calendar/scan.h"\n')
    # As the first, so that its tests have the number 0.
    replace(copy / "src/calendar/all.h", r"(using AllCalendars = List<)", r"\1Scan, ")
    # 3. The documents.
    replace(copy / "docs/scenes.md", r'(\n\| `queue` .*"cell-calendar"`)', r'\1, `"scan"`')
    with (copy / "src/calendar/README.md").open("a") as readme:
        readme.write("| `scan` | looks through all needles | O(n) | 64 |\n")


main()
