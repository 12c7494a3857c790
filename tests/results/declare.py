#!/usr/bin/python3
"""Declares the numbers of results where a language or a page needs them written out, from the one list
that the library has of each kind (include/needlework/totals.h, src/runs/results.h).

    declare.py DESCRIBE          writes between the marks of the files below
    declare.py DESCRIBE --check  exit code 1, and the files that differ, if something else stands there

DESCRIBE is the program that prints the lists, build/release/describe_results. Marks are comments,
"numbers of KIND" and "end of numbers"; in file-format.md "series of GROUP".
"""

import json
import re
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def in_c(number):
    kind = "uint64_t" if number["type"] == "count" else "double"
    meaning = number["meaning"] + (", of all" if number["type"] == "reals" else "")
    unit = f" [{number['unit']}]" if number["unit"] else ""
    lines = textwrap.wrap(f"{meaning}{unit}", 94)
    comment = "\n   * ".join(lines)
    return f"  /* {comment} */\n  {kind} {number['name']};\n"


def in_fortran(number):
    kind = "integer(c_int64_t)" if number["type"] == "count" else "real(c_double)"
    return f"    {kind} :: {number['name']}\n"


def in_python(number):
    kind = {"count": "int", "real": "float", "reals": "np.ndarray"}[number["type"]]
    unit = f" [{number['unit']}]" if number["unit"] else ""
    text = textwrap.fill(f'\"\"\"{number["meaning"]}{unit}.\"\"\"', 96, initial_indent="    ",
                         subsequent_indent="    ")
    return f"    {number['name']}: {kind}\n{text}\n"


def in_table(number):
    return f"| `{number['name']}` | {number['meaning']} | {number['unit']} |\n"


def in_file(name, field):
    unit = f", {field['unit']}" if field["unit"] else ""
    return f"| `/series/{name}` | {field['meaning']} | `{field['type']}`{unit} |\n"


# How a number looks in a file, and what goes around the marks there.
FILES = {
    "include/needlework.h": (in_c, "  /* ", " */\n"),
    "examples/fortran/needlework.f90": (in_fortran, "    ! ", "\n"),
    "python/needlework/simulation.py": (in_python, "    # ", "\n"),
    "docs/json.md": (in_table, "<!-- ", " -->\n"),
}


def declared(file, text, lists):
    look, begin, end = FILES.get(file, (None, "<!-- ", " -->\n"))
    pattern = re.compile(f"({re.escape(begin)}(numbers|series) of (\\w+){re.escape(end)})(.*?)"
                         f"({re.escape(begin)}end of \\2{re.escape(end)})", re.S)

    def block(match):
        what, kind = match[2], match[3]
        if what == "series":
            head = "| path | meaning | type, shape, unit |\n|---|---|---|\n"
            rows = "".join(in_file(name, field) for name, field in lists["series"].items()
                           if name.split("/")[0] == kind)
        else:
            head = "| key | meaning | unit |\n|---|---|---|\n" if file.endswith(".md") else ""
            rows = "".join(look(number) for number in lists["results"][kind]["numbers"])
        return match[1] + head + rows + match[5]

    if not pattern.search(text):
        raise SystemExit(f"{file}: expected marks such as \"{begin}numbers of walls{end.strip()}\"")
    return pattern.sub(block, text)


def main():
    describe, *options = sys.argv[1:]
    lists = json.loads(subprocess.run([describe], stdout=subprocess.PIPE, check=True).stdout)
    differ = []
    for file in [*FILES, "docs/file-format.md"]:
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
