"""Compares docs/file-format.md and docs/observables.md with the files that the program writes.

    file_format_document.py NEEDLEWORK SOURCE_FOLDER

Each dataset of a file must have a `description` and a row in a table of the document that says the
same, with the right shape and type; groups need a description alone. Each row must fit an object. The
commands and the programs of each document are run, and must print what the document says.
"""
import os
import re
import subprocess
import sys
import tempfile

import h5py

SWEEP = """
seeds = [1, 2, 3]
needles = { count = 20, box = 5 }
until.time = 1
driving.kicks = { every = 0.5, translational = 1, rotational = 1 }
walls = [{ axis = "z", side = "low" }, { axis = "z", side = "high" }]
[parameters]
"collisions.epsilon" = [0.9, 0.8]
"engine.search" = ["capsules", "linked-cells"]
"""

MIXTURE = """
needles.box = 6
collisions.epsilon = 0.9
until.time = 1
species = [{ name = "a", count = 30 }, { name = "b", count = 20, length = 2 },
           { name = "c", count = 10, mass = 3 }]
pairs = [{ between = ["a", "c"], meet = false }]
"""

WALLED = """
needles = { count = 30, box = 6, seed = 3 }
until.time = 1
output.events = true
output.observables = ["wall_profiles", "centre_of_mass"]
driving.kicks = { every = 0.3, translational = 1, rotational = 1 }
driving.andersen = { rate = 1, temperature = 1 }
walls = [{ axis = "z", side = "both", motion = { amplitude = 0.1, frequency = 1, phase = 0 } },
         { axis = "x", side = "low", temperature = 1 },
         { axis = "x", side = "high", motion = { velocity = 0 } }]
"""


PISTON = """
needles = { count = 30, box = 6, seed = 3 }
until.time = 1
walls = [{ axis = "z", side = "low", motion = { velocity = 1 } }, { axis = "z", side = "high" }]
"""


RODS = """
needles = { count = 20, box = 4, diameter = 0.2 }
until.time = 0.1
"""


# A thermostat is refused beside such gravity.
CHANNEL = """
needles = { count = 30, box = 6, seed = 3 }
until.time = 1
forces.gravity = [0.1, 0, 0]
walls = [{ axis = "z", side = "both", temperature = 1 }]
"""


SLIDING = """
needles = { count = 60, box = 4 }
collisions = { epsilon = 0.3, sliding = true }
until.time = 0.5
"""


DIFFERING = """
needles.box = 9
until.time = 0.1
[[species]]
name = "a"
count = 20
length = { distribution = "uniform", mean = 1, width = 0.2 }
diameter.aspect = 5
"""


GROWING = """
needles = { count = 20, box = 4, diameter = 0.2 }
until.time = 0.5
driving.growth.rate = 0.1
output.observables = ["contact_network"]
"""
OF_GROWTH = ("/energy_budget/growth", "/energy_budget/cooling")


SHEARED = """
needles = { count = 60, box = 5 }
until.time = 0.5
shear = { rate = 0.5, offset = 1 }
output.frames = 3
output.observables = ["alignment", "structure_factor", "displacement"]
"""
OF_FLOW = ("/energy_budget/shear", "/flow_angle", "/spin_over_rate", "/k_y")


class Row:
    """`/path`, `/other` | meaning | `float64[samples or frames][3]`, unit: alternatives are those of the
    paths, in their order."""

    def __init__(self, line):
        paths, self.meaning, text = line.strip().strip("|").strip().split(" | ")
        self.paths = re.findall("`(.*?)`", paths)
        self.patterns = [re.compile(re.escape(path).replace(r"\*", "[^/]+")) for path in self.paths]
        text, _, self.unit = text.partition(", ")
        kind, self.shape, other = re.fullmatch(
            r"(\w+)((?:\[[^]]*\])*)((?: or \w+)?)", text.replace("`", "")).groups()
        self.type = kind + other
        self.types = set()
        self.unused = set(self.paths)

    def fits(self, path):
        return any(pattern.fullmatch(path) for pattern in self.patterns)

    def use(self, path):
        """The shape of the object at this path."""
        index = next(n for n, pattern in enumerate(self.patterns) if pattern.fullmatch(path))
        self.unused.discard(self.paths[index])
        return re.sub(r"\[([^]]* or [^]]*)\]", lambda of: f"[{of[1].split(' or ')[index]}]", self.shape)

    def sentence(self, shape):
        text = self.meaning
        if self.unit:
            text += ", in units of " + re.sub("^per ", "1/", self.unit)
        if shape:
            text += ", with shape " + shape
        return text + "."


def rows_of(document, heading):
    section = document.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return [Row(line) for line in section.splitlines() if line.startswith("| `/")]


def links(group):
    """All paths of a file, those of hard links to one object included."""
    yield group.name
    for name, item in group.items():
        if isinstance(item, h5py.Group):
            yield from links(item)
        else:
            yield group.name.rstrip("/") + "/" + name


def is_element(item):
    return isinstance(item, h5py.Group) and "value" in item


def type_of(item):
    if is_element(item):
        return type_of(item["value"])
    if isinstance(item, h5py.Group):
        return "group"
    return "string" if h5py.check_string_dtype(item.dtype) else str(item.dtype)


class Comparison:
    """Of a file with rows that must all fit, and with others of which some may. Groups need a
    description, but no row."""

    def __init__(self, file, rows, others=()):
        self.file, self.rows, self.others = file, rows, others
        self.sizes = {}
        self.problems = []

    def run(self):
        rows = {path: self.row_of(path) for path in links(self.file)}
        documented = {self.address(path) for path, row in rows.items() if row}
        for path, row in rows.items():
            parent = self.file[path].parent if path != "/" else None
            if row:
                self.compare(path, row)
            elif parent is not None and is_element(parent) and path.endswith("/value"):
                self.require(path, self.description(path) == self.description(parent.name),
                             "has another description than its element")
            elif parent is not None and is_element(parent):
                self.require(path, self.address(path) in documented, "is not in the document")
            elif isinstance(self.file[path], h5py.Group) and not is_element(self.file[path]):
                self.require(path, self.description(path), "has no description")
            else:
                self.require(path, False, "is not in the document")
        for row in self.rows:
            for path in row.unused:
                self.require(path, False, "is in the document, but in no file")
            if not row.unused:
                found = " or ".join(sorted(row.types))
                self.require(row.paths[0], row.type == found, f"has the type {found}, not {row.type}")

    def row_of(self, path):
        return next((row for row in [*self.rows, *self.others] if row.fits(path)), None)

    def address(self, path):
        return h5py.h5o.get_info(self.file[path].id).addr

    def description(self, path):
        return self.file[path].attrs.get("description", "")

    def require(self, path, condition, problem):
        if not condition:
            self.problems.append(f"{self.file.filename}: {path} {problem}")

    def compare(self, path, row):
        shape = row.use(path)
        item = self.file[path]
        found, expected = self.description(path), row.sentence(shape)
        # Rows of files whose events are collisions serve those with other events, too.
        if "/events/kind" in self.file and path.startswith("/events/") and found != expected:
            expected = expected.replace("collision", "event")
        self.require(path, found == expected,
                     f"is described as\n    {found!r}, but in the document as\n    {expected!r}")
        self.require(path, "unit" not in item.attrs, "has an attribute `unit`")
        row.types.add(type_of(item))
        plain = re.search(r"/(series|series/\d+|position)/(step|time)$|/(mean|standard_error)$", path)
        of_rows = shape.startswith(("[frames]", "[samples]")) and not plain
        self.require(path, is_element(item) == of_rows, "should be an element" if of_rows else "is one")
        self.compare_shape(path, shape, item["value"] if is_element(item) else item)

    def compare_shape(self, path, shape, item):
        if isinstance(item, h5py.Group):
            self.require(path, not shape, "is a group, which has no shape")
            return
        extents = re.findall(r"\[(.*?)\]", shape)
        fits = len(extents) == len(item.shape) and all(
            self.size(extent, size) == size for extent, size in zip(extents, item.shape))
        self.require(path, fits, f"has the shape {item.shape}, not {shape or 'that of a scalar'}")

    def size(self, extent, found):
        """The number that a shape names: the first to be found holds for the whole file."""
        name, _, more = extent.partition(" + ")
        if name.isdigit():
            return int(name)
        return self.sizes.setdefault(name, found - int(more or 0)) + int(more or 0)


def blocks(document, language):
    return re.findall(rf"^```{language}\n(.*?)^```", document, re.MULTILINE | re.DOTALL)


def run(command, folder):
    result = subprocess.run(command, cwd=folder, timeout=240, text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE)
    assert result.returncode == 0, (command, result.returncode, result.stderr)
    return result.stdout


def read(source, name):
    with open(os.path.join(source, "docs", name), encoding="utf-8") as file:
        return file.read()


def problems_of_examples(document, name, folder):
    """Those of the programs of the document, which are run after the commands."""
    for text in blocks(document, "toml"):
        with open(os.path.join(folder, "observed.toml"), "w", encoding="utf-8") as file:
            file.write(text)
    for command in "".join(blocks(document, "sh")).replace("\\\n", "").splitlines():
        run(["sh", "-c", "PATH=.:$PATH; " + command], folder)
    examples, outputs = blocks(document, "python"), blocks(document, "text")
    assert len(examples) == len(outputs) > 0, (name, len(examples), len(outputs))
    printed = [run([sys.executable, "-c", example], folder) for example in examples]
    return [f"{name}: prints\n{out}not\n{expected}"
            for out, expected in zip(printed, outputs) if out != expected]


def main(program, source):
    document, observables = read(source, "file-format.md"), read(source, "observables.md")
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(program, os.path.join(folder, "needlework"))
        os.symlink(os.path.join(source, "profiles"), os.path.join(folder, "profiles"))
        problems += problems_of_examples(document, "file-format.md", folder)
        problems += problems_of_examples(observables, "observables.md", folder)
        for name, scene in {"grid": SWEEP, "mixture": MIXTURE, "walled": WALLED, "rods": RODS,
                            "sliding": SLIDING, "channel": CHANNEL, "sheared": SHEARED,
                            "piston": PISTON, "growing": GROWING,
                            "differing": DIFFERING}.items():
            with open(os.path.join(folder, f"{name}.toml"), "w", encoding="utf-8") as file:
                file.write(scene)
            if name != "grid":
                run(["./needlework", "run", f"{name}.toml", "--out", f"{name}.h5", "--quiet"], folder)
        run(["./needlework", "sweep", "grid.toml", "--out", "sweep", "--threads", "1", "--quiet"],
            folder)
        runs = rows_of(document, "Files of runs")
        walls, of_gravity, of_pistons, at_rest = [], [], [], []
        of_flow = rows_of(document, "Files of sheared gases")
        growing = rows_of(document, "Files of bodies that grow")
        for row in rows_of(document, "Files with walls"):
            (growing if row.paths[0].endswith(OF_GROWTH) else
             of_flow if row.paths[0].endswith(OF_FLOW) else
             of_gravity if row.paths[0].endswith("/gravity") else
             of_pistons if row.paths[0].startswith("/particles/") else walls).append(row)
        for row in rows_of(observables, "Datasets"):
            (growing if "/contact_network/" in row.paths[0] else
             of_flow if row.paths[0].endswith(OF_FLOW) else at_rest).append(row)
        rods = rows_of(document, "Files of rods")
        for name, rows, others in [
                ("run.h5", runs, ()),
                ("observed.h5", at_rest, runs),
                ("sheared.h5", of_flow, runs + at_rest + walls),
                ("mixture.h5", rows_of(document, "Files of mixtures"), runs),
                ("rods.h5", rods, runs),
                ("differing.h5", rows_of(document, "Files of bodies that differ"), rods + runs),
                ("growing.h5", growing, rods + walls + runs),
                ("sliding.h5", rows_of(document, "Files with sliding contact"), runs),
                ("walled.h5", walls + rows_of(observables, "Datasets of axes with walls"), runs),
                ("channel.h5", of_gravity, walls + runs),
                ("piston.h5", of_pistons, walls + runs),
                ("sweep/summary.h5", rows_of(document, "Summaries of sweeps"), ()),
                ("run.vtkhdf", rows_of(document, "Exports for ParaView and VTK"), ())]:
            with h5py.File(os.path.join(folder, name), "r") as file:
                comparison = Comparison(file, rows, others)
                comparison.run()
                problems += comparison.problems
    print("\n".join(problems) or "the documents and the files agree")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
