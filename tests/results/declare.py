#!/usr/bin/python3
"""Declares the numbers of results where a language or a page needs them written out, from the one list
that the library has of each kind (include/needlework/totals.h, src/runs/results.h).

    declare.py DESCRIBE          writes between the marks of the files below
    declare.py DESCRIBE --check  exit code 1, and the files that differ, if something else stands there

DESCRIBE is the program that prints the lists, build/release/describe_results. Marks are comments,
"numbers of KIND" and "end of numbers"; "series of GROUP" and "sums of runs" in pages about files.
"""

import json
import re
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def size_of(number):
    """The extent of an array of fixed length, as C writes it; of others a structure has the sum."""
    return f"[{number['size']}]" if "size" in number else ""


def in_c(number):
    kind = "uint64_t" if number["type"] == "count" else "double"
    sums = number["type"] == "reals" and "size" not in number
    unit = f" [{number['unit']}]" if number["unit"] else ""
    lines = textwrap.wrap(f"{number['meaning']}{', of all' if sums else ''}{unit}", 94)
    comment = "\n   * ".join(lines)
    return f"  /* {comment} */\n  {kind} {number['name']}{size_of(number)};\n"


def in_fortran(number):
    kind = "integer(c_int64_t)" if number["type"] == "count" else "real(c_double)"
    return f"    {kind} :: {number['name']}{size_of(number).translate({91: '(', 93: ')'})}\n"


def as_attribute(number, kind, shape=""):
    unit = f" [{number['unit']}]" if number["unit"] else ""
    text = textwrap.fill(f'\"\"\"{number["meaning"]}{unit}{shape}.\"\"\"', 96,
                         initial_indent="    ", subsequent_indent="    ")
    return f"    {number['name']}: {kind}\n{text}\n"


def in_python(number):
    kind = {"count": "int", "real": "float", "reals": "np.ndarray"}[number["type"]]
    return as_attribute(number, kind, f", {size_of(number)}" if "size" in number else "")


def with_rows(number, row):
    """The shape of a column of rows, where it is not that of the others."""
    return f", [{row}, {number['size']}]" if "size" in number else ""


def in_series(number):
    return as_attribute(number, "np.ndarray", with_rows(number, "S"))


def in_changes(number):
    """What a caller who sets velocities changes, which times and counts are not."""
    if number["name"] == "time" or number["type"] == "count":
        return ""
    return as_attribute(number, "np.ndarray", with_rows(number, "C, 2") or ", [C, 2]")


def in_table(number):
    return f"| `{number['name']}` | {number['meaning']} | {number['unit']} |\n"


def in_file(name, field):
    unit = f", {field['unit']}" if field["unit"] else ""
    return f"| `/series/{name}` | {field['meaning']} | `{field['type']}`{unit} |\n"


def type_in_file(number, rows):
    return f"{'int64' if number['type'] == 'count' else 'float64'}{rows}{size_of(number)}"


def sum_of_run(number):
    unit = f", {number['unit']}" if number["unit"] else ""
    row = (f"| `/series/{number['name']}`, `/observables/{number['name']}` | {number['meaning']} | "
           f"`{type_in_file(number, '[samples or frames]')}`{unit} |\n")
    if number["type"] != "count":
        row += (f"| `/velocities_set/{number['name']}` | {number['name']} before and after | "
                f"`{type_in_file(number, '[changes][2]')}`{unit} |\n")
    return row


def sum_of_sweep(number):
    unit = f", {number['unit']}" if number["unit"] else ""
    path = f"/series/*/{number['name']}"
    if "size" not in number:
        return f"| `/results/{number['name']}`, `{path}` | {number['meaning']} | group{unit} |\n"
    rows = f"`{type_in_file(number, '[samples]')}`"
    return (f"| `{path}` | {number['meaning']} | group{unit} |\n"
            f"| `{path}/mean` | Mean over the runs of the point | {rows} |\n"
            f"| `{path}/standard_error` | Standard error of the mean "
            f"| {rows} |\n")


# What goes around the marks in a file, and how a number looks there, by the word before "of".
FILES = {
    "include/needlework.h": ("  /* ", " */\n", {"numbers": in_c}),
    "examples/fortran/needlework.f90": ("    ! ", "\n", {"numbers": in_fortran}),
    "python/needlework/simulation.py": ("    # ", "\n", {"numbers": in_python}),
    "python/needlework/reading.py": ("    # ", "\n", {"numbers": in_series, "changes": in_changes}),
    "docs/json.md": ("<!-- ", " -->\n", {"numbers": in_table}),
    "docs/file-format.md": ("<!-- ", " -->\n", {"series": in_file}),
    "docs/observables.md": ("<!-- ", " -->\n", {"series": in_file}),
}
# Sums over all needles, in the tables of docs/file-format.md.
SUMS = {"runs": sum_of_run, "sweeps": sum_of_sweep}


def declared(file, text, lists):
    begin, end, looks = FILES[file]
    pattern = re.compile(f"({re.escape(begin)}(numbers|changes|series|sums) of (\\w+){re.escape(end)})"
                         f"(.*?)({re.escape(begin)}end of \\2{re.escape(end)})", re.S)

    def block(match):
        what, kind = match[2], match[3]
        if what == "series":
            rows = "".join(in_file(name, field) for name, field in lists["series"].items()
                           if name.split("/")[0] in lists["groups"].get(kind, [kind]))
        elif what == "sums":
            rows = "".join(SUMS[kind](number) for number in lists["results"]["totals"]["numbers"]
                           if number["name"] != "time")
        else:
            rows = "".join(looks[what](number) for number in lists["results"][kind]["numbers"])
        if not file.endswith(".md"):
            head = ""
        elif what == "numbers":
            head = "| key | meaning | unit |\n|---|---|---|\n"
        else:
            head = "| path | meaning | type, shape, unit |\n|---|---|---|\n"
        return match[1] + head + rows + match[5]

    if not pattern.search(text):
        raise SystemExit(f"{file}: expected marks such as \"{begin}numbers of walls{end.strip()}\"")
    return pattern.sub(block, text)


def main():
    describe, *options = sys.argv[1:]
    lists = json.loads(subprocess.run([describe], stdout=subprocess.PIPE, check=True).stdout)
    differ = []
    for file in FILES:
        path = ROOT / file
        text = path.read_text()
        new = declared(file, text, lists)
        if new == text:
            continue
        if "--check" in options:
            differ.append(file)
        else:
            path.write_text(new)
    for file in differ:
        print(f"{file}: what it says of results is not what the lists say: run "
              f"tests/results/declare.py {describe}")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
