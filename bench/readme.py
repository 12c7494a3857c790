"""Tables and words that scripts write into documents: each stands between two comments that name it,
words with these in one line."""

import re
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1] / "docs"


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
