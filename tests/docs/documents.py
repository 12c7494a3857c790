"""Links among the documents lead somewhere, files and tests that they name exist, tables are tables,
the container is built as the front page says, which stays short, as do all pages together."""

import csv
import re
import unittest
from datetime import date
from functools import lru_cache
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\(([^)\s]+)\)|(?:src|href)=\"([^\"]+)\"")
CODE = re.compile(r"^```.*?^```|`[^`\n]+`", re.M | re.S)


# A file of the project by its path, such as `src/scene/scene.h`; not NAME.h, which stands for many.
FILE = re.compile(r"`((?:[a-z_.-]+/)+[a-z0-9_.-]+\.(?:h|cpp|py|toml|md|txt))`")


def documents():
    folders = ["docs", "src", "kernels", "include", "tests", "bench", "profiles", "cmake",
               "examples", "packaging", "paper"]
    found = [*ROOT.glob("*.md"), *(d for f in folders for d in (ROOT / f).rglob("*.md"))]
    assert len(found) > 20, found
    return sorted(found)


@lru_cache
def anchors(path):
    """Those that GitHub makes of headings, and those in HTML."""
    found = set()
    text = re.sub(r"^```.*?^```", "", path.read_text(), flags=re.M | re.S)
    for heading in re.findall(r"^#+ +(.*?) *$", text, flags=re.M):
        plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        anchor = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        number = 0
        while (numbered := f"{anchor}-{number}" if number else anchor) in found:
            number += 1
        found.add(numbered)
    return found | set(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", text))


def broken_links(path):
    text = CODE.sub("", path.read_text())
    for match in LINK.finditer(text):
        link = match[1] or match[2]
        if re.match(r"[a-z]+:", link):
            continue  # elsewhere
        file, _, anchor = unquote(link).partition("#")
        target = path.parent / file if file else path
        if not target.exists():
            yield f"{path.relative_to(ROOT)}: {link}: expected a file"
        elif anchor and anchor not in anchors(target.resolve()):
            yield f"{path.relative_to(ROOT)}: {link}: expected a heading"


def missing_files(path):
    for name in FILE.findall(path.read_text()):
        if not (ROOT / name).exists() and not (path.parent / name).exists():
            yield f"{path.relative_to(ROOT)}: {name}: expected a file"


def tables_without_head(path):
    """Rows that a blank line cuts off from the head of their table, so that they are shown as text."""
    text = re.sub(r"^```.*?^```", "", path.read_text(), flags=re.M | re.S)
    for table in re.findall(r"(?:^\|.*\n?)+", text, flags=re.M):
        rows = table.splitlines()
        if len(rows) < 2 or not re.fullmatch(r"[|: -]+", rows[1]):
            yield f"{path.relative_to(ROOT)}: {rows[0]}: expected a head and a line below it"


# A test by its name, such as `ResumeCommand` or `resume.20_kills`; not `output.file`.
TEST = re.compile(r"`((?:[A-Z][a-z]+)+|(?:cli|python|resume|slow)\.\w+)`")
# One of the tests of a case, by how its name begins: `Collapse.StruckBy`; or a family of pairs.
BEGINNING = re.compile(r"`([A-Z]\w+(?:\.\w+)?)`")
FAMILY = re.compile(r"`([a-z][a-z-]+)`")
PAGES_OF_TESTS = ["docs/reliability.md", "docs/accuracy.md", "src/audit/README.md"]


def tests():
    """Expressions for their names: suites, scripts of Python, and tests of CMake, some of which have
    a variable."""
    folder = ROOT / "tests"
    suites = {suite for path in folder.rglob("*.cpp")
              for suite in re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),", path.read_text(), re.M)}
    scripts = re.findall(r"script_test\((\w+\.\S+)",
                         "".join((ROOT / f / "CMakeLists.txt").read_text() for f in ["tests", "bench"]))
    python = {f"python.{path.stem.removeprefix('test_')}" for path in folder.glob("python/test_*.py")}
    return suites | python | {re.sub(r"\$\{\w+\}", r"\\w+", name) for name in scripts}


def tests_in_full():
    """Such as Collapse.StruckByAThirdNeedleStaysOnItsSide."""
    return {f"{suite}.{name}" for path in (ROOT / "tests").rglob("*.cpp")
            for suite, name in re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),\s*(\w+)", path.read_text(),
                                          re.M)}


def hard_cases():
    """The rows of all tables of the page, each a list of its cells; without their heads."""
    rows = re.findall(r"^\| (?!case \|)(.*) \|$", (ROOT / "docs/hard-cases.md").read_text(), re.M)
    return [re.split(r" (?<!\\)\| ", row) for row in rows]


class Documents(unittest.TestCase):
    def test_links_lead_somewhere(self):
        self.assertEqual([link for path in documents() for link in broken_links(path)], [])

    def test_files_that_are_named_exist(self):
        self.assertEqual([file for path in documents() for file in missing_files(path)], [])

    def test_tests_that_are_named_exist(self):
        named = [name for page in PAGES_OF_TESTS for name in TEST.findall((ROOT / page).read_text())]
        self.assertGreater(len(named), 60)
        there = re.compile("|".join(tests()))
        self.assertEqual([name for name in named if not there.fullmatch(name)], [])

    def test_every_hard_case_has_a_test(self):
        names = sorted(tests_in_full())
        families = re.findall(r'^ +{"([a-z0-9-]+)", \w+, \w+, draw_',
                              (ROOT / "tests/support/pair_families.cpp").read_text(), re.M)
        self.assertGreater(len(families), 10)
        for case in hard_cases():
            named = BEGINNING.findall(case[-1])
            drawn = FAMILY.findall(case[-1])
            self.assertTrue(named or drawn, case)
            for begin in named:
                self.assertTrue(any(name.startswith(begin) for name in names), begin)
            self.assertEqual([family for family in drawn if family not in families], [])

    def test_hard_cases_are_as_many_as_is_said(self):
        for page in ("docs/hard-cases.md", "docs/accuracy.md"):
            said = re.search(r"\b(\d+) cases, (?:each )?with a test", (ROOT / page).read_text())
            self.assertEqual(int(said[1]), len(hard_cases()), page)

    def test_documents_are_listed_in_their_index(self):
        index = (ROOT / "docs/README.md").read_text()
        missing = [path.name for path in (ROOT / "docs").glob("*.md")
                   if path.name != "README.md" and f"({path.name})" not in index]
        self.assertEqual(missing, [])

    def test_columns_of_the_figures_data_are_explained(self):
        folder = ROOT / "docs/reproduction"
        with open(folder / "columns.csv", encoding="utf-8", newline="") as table:
            explained = [(row["figure"], row["column"]) for row in csv.DictReader(table) if row["meaning"]]
        data = {path.stem.removeprefix("figure-"): path for path in folder.glob("figure-*.csv")}
        self.assertGreater(len(data), 30)
        there = [(name, column) for name, path in data.items()
                 for column in path.read_text().splitlines()[0].split(",")]
        self.assertEqual(sorted(explained), sorted(there))

    def test_tables_have_heads(self):
        self.assertEqual([row for path in documents() for row in tables_without_head(path)], [])

    def test_container_is_built_by_the_command_of_the_front_page(self):
        command = re.search(r"^RUN (\S+)", (ROOT / "Containerfile").read_text(), re.M)[1]
        start = re.search(r"^## Start\n(.*?)^## ", (ROOT / "README.md").read_text(), re.M | re.S)[1]
        self.assertIn(f"\n    {command}\n", start)

    def test_citation_and_changelog_have_the_version(self):
        version = re.search(r"^project\(Needlework VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(),
                            re.M)[1]
        citation = (ROOT / "CITATION.cff").read_text()
        self.assertEqual(re.search(r"^version: (.*)$", citation, re.M)[1], version)
        changelog = (ROOT / "docs/changelog.md").read_text()
        heading, day = re.search(r"^## (\S+), (.*)$", changelog, re.M).groups()
        self.assertEqual(heading, version)
        released = re.search(r"^date-released: (.*)$", citation, re.M)[1]
        self.assertEqual(f"{date.fromisoformat(released):%-d %B %Y}", day)

    def test_all_pages_together_are_short(self):
        words = sum(len(path.read_text().split()) for path in (ROOT / "docs").rglob("*.md"))
        self.assertLessEqual(words, 60000)

    def test_paper_is_short_and_its_references_are_those_that_it_cites(self):
        text = (ROOT / "paper/paper.md").read_text()
        body = text[text.index("# Summary"):text.index("# Numbers and their commands")]
        self.assertLessEqual(len(body.split()), 1600)
        listed = re.findall(r"^@\w+\{(\w+),", (ROOT / "paper/paper.bib").read_text(), re.M)
        self.assertEqual(sorted(listed), sorted(set(re.findall(r"@([A-Za-z]\w+)", body))))

    def test_front_page_is_short(self):
        text = (ROOT / "README.md").read_text()
        self.assertLessEqual(len(text.splitlines()), 150)
        self.assertLessEqual(len(text.split()), 1500)


if __name__ == "__main__":
    unittest.main()
