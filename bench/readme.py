"""Tables and words that scripts write into documents: each stands between two comments that name it,
words with these in one line."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
RESULTS = ROOT / "bench/results"
LINK = re.compile(r"(bench/results/)([\w-]+)/([\w.-]+)(?=[)#])")


def put_table(name, text, document):
    """Replaces what stands between <!-- NAME --> and <!-- end of NAME --> in this file, as seen from
    docs/."""
    path = DOCS / document
    old = path.read_text()
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    pattern = re.escape(begin) + "(.*?)" + re.escape(end)

    def put(match):
        around = "\n" if "\n" in match[1] else ""
        return begin + around + text.strip() + around + end

    new, count = re.subn(pattern, put, old, flags=re.S)
    if count != 1:
        raise ValueError(f"{path}: {begin} ... {end}: expected once, found {count} times")
    path.write_text(new)


def put_result(name, title, text):
    """A table of its own, of what does not depend on the machine or is of one machine only."""
    RESULTS.mkdir(parents=True, exist_ok=True)
    (RESULTS / name).write_text(f"# {title}\n\n{text.strip()}\n")


def lead_links_to(machine):
    """Of all documents outside of bench/results, lets links to a file of results lead to that of the
    same name of this machine, where there is one."""
    def lead(match):
        folder, _, file = match.groups()
        return f"{folder}{machine}/{file}" if (RESULTS / machine / file).exists() else match[0]

    for path in ROOT.rglob("*.md"):
        if path.is_relative_to(RESULTS) or path.is_relative_to(ROOT / "build"):
            continue
        old = path.read_text()
        new = LINK.sub(lead, old)
        if new != old:
            path.write_text(new)
