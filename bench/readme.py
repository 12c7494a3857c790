"""Tables of README.md that scripts write: each stands between two comments that name it."""

import re
from pathlib import Path

README = Path(__file__).resolve().parent / "README.md"


def put_table(name, text, readme=README):
    """Replaces what stands between <!-- NAME --> and <!-- end of NAME -->."""
    old = readme.read_text()
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    pattern = re.escape(begin) + ".*?" + re.escape(end)
    new, count = re.subn(pattern, lambda _: f"{begin}\n{text.strip()}\n{end}", old, flags=re.S)
    if count != 1:
        raise ValueError(f"{readme}: {begin} ... {end}: expected once, found {count} times")
    readme.write_text(new)
