#!/usr/bin/env python3
"""Use runs one way: reads the includes of the whole tree and reports each that a layer may not use.

    layers.py ROOT             exit code 1 if there is a violation
    layers.py ROOT --graph     prints which layers use which, as counted

A line for each violation: FILE:LINE: INCLUDE: RULE.
"""

import collections
import os
import re
import sys

# The layers, from below. A layer is made of folders, of the public headers whose implementation it
# holds, and of the layers that it may use besides itself. What it uses of "public" layers it may use
# through their public headers alone.
Layer = collections.namedtuple("Layer", "name folders headers uses public", defaults=((), ()))

LAYERS = [
    # name, folders, public headers, uses, uses through public headers
    Layer("base", [], ["error.h"]),
    Layer("memory", ["src/memory"], []),
    Layer("machine", ["src/machine"], []),
    Layer("archive", ["src/archive"], [], ["base"]),
    Layer("kernels", ["kernels"], ["accuracy.h"], ["base", "memory"]),
    # Functions with the same bits everywhere are double-double, and sizes are drawn by them.
    Layer("random", ["src/random"], [], ["kernels"]),
    Layer("composition", ["src/composition"], ["composition.h", "distribution.h"], ["random"]),
    # Where the needles of a state are, the box and its images.
    Layer("box", ["src/box"], ["state.h"], ["kernels"]),
    Layer("theory", ["src/theory"], ["theory.h", "body_rates.h", "diffusion.h"],
          ["base", "composition"]),
    Layer("trajectory", ["src/trajectory"],
          ["collision.h", "happening.h", "described.h", "totals.h", "series.h", "counters.h", "stop.h"],
          ["base", "archive", "kernels"]),
    Layer("physics", ["src/physics"], ["predict.h"],
          ["base", "memory", "archive", "composition", "kernels", "box"]),
    # What an effect reports has a kind, as the trajectory knows it.
    Layer("effects", ["src/effects"], [],
          ["base", "memory", "archive", "composition", "random", "kernels", "box", "trajectory",
           "physics"]),
    Layer("search", ["src/search"], [],
          ["base", "memory", "composition", "kernels", "box", "trajectory", "physics"]),
    Layer("calendar", ["src/calendar"], [], ["base", "memory", "kernels", "physics"]),
    # Which calendars a scene may name is what the list of calendars says, and which sums that of totals.
    Layer("boltzmann", ["src/boltzmann"], ["boltzmann.h"],
          ["base", "composition", "random", "kernels", "physics"], ["theory"]),
    Layer("scene", ["src/scene"],
          ["scene.h"],
          ["base", "machine", "archive", "composition", "random", "kernels", "box", "calendar"],
          ["trajectory"]),
    # Scenes as text. Only it uses libraries that read TOML and JSON.
    Layer("scene_text", ["src/scene_text"], ["parse.h", "user_data.h"], ["base", "machine", "scene"]),
    Layer("engine", ["src/engine"], ["simulation.h", "initial_state.h"],
          ["base", "memory", "machine", "archive", "composition", "random", "kernels", "box",
           "trajectory", "scene", "physics", "effects", "search", "calendar"]),
    Layer("observe", ["src/observe"], [],
          ["archive", "composition", "box", "scene"], ["base", "theory", "trajectory", "engine"]),
    Layer("io", ["src/io"], ["h5md.h"], ["machine", "archive", "box", "trajectory"],
          ["base", "composition", "scene", "scene_text", "engine"]),
    Layer("audit", ["src/audit"], [], [], ["base", "composition", "trajectory", "scene", "engine"]),
    Layer("runs", ["src/runs"], [],
          ["base", "machine", "archive", "composition", "kernels", "trajectory", "scene", "scene_text",
           "search", "calendar", "observe", "io"],
          ["box", "theory", "engine"]),
    Layer("picture", ["src/picture"], [], ["base", "box", "scene"]),
    Layer("json", ["src/json"], [], ["base", "composition", "observe", "runs"],
          ["scene", "trajectory", "engine"]),
    # Front ends for other programs: C, Python, a pipe.
    Layer("bindings", ["src/c", "src/python", "src/serve"], ["needlework.h"],
          ["base", "machine", "composition", "kernels", "scene", "observe", "runs", "json"],
          ["box", "scene_text", "theory", "trajectory", "physics", "engine", "io"]),
    # Pages for browsers; their arrays are in base64, as those over a pipe are.
    Layer("report", ["src/report"], [],
          ["base", "composition", "box", "scene", "io", "picture", "json"],
          ["scene_text", "theory"]),
    # `needlework bench` is a command of the program, and measures the engine from within.
    Layer("program", ["src/cli", "bench/strategies"], [],
          ["base", "machine", "composition", "scene", "scene_text", "search", "calendar", "observe",
           "io", "audit", "runs", "picture", "json", "bindings", "report"],
          ["kernels", "box", "theory", "trajectory", "physics", "boltzmann", "engine"]),
]
FREE = ["bench", "tests"]  # may use anything; nothing else may use them

# Headers of libraries, and the layers that may include them. Free folders may.
LIBRARIES = [
    (r"hdf5\.h|H5.*", ["io", "runs"]),
    (r"toml\+\+/.*", ["scene_text"]),
    (r"bzlib\.h", ["io"]),
    (r"pugixml\.hpp", ["io", "picture"]),
    (r"png\.h", ["picture"]),
    (r"CLI/.*", ["program"]),
    (r"nlohmann/.*", ["scene_text", "program", "bindings", "json", "report"]),
    (r"mpi\.h", ["program"]),
    (r"pybind11/.*", ["bindings"]),
    (r"csignal|signal\.h", ["io", "program"]),
]

SOURCES = (".h", ".hpp", ".cpp", ".c")
INCLUDE = re.compile(r'^\s*#\s*(?:include|define\s+HWY_TARGET_INCLUDE)\s+([<"])([^>"]+)[>"]')
STANDARD = re.compile(r"[a-z0-9_]+|std(def|int)\.h")  # <vector>: no folder, no ending; or of C


def in_folder(path, folder):
    return path.startswith(folder + "/")


class Tree:
    def __init__(self, root):
        self.root = root
        self.by_name = {layer.name: layer for layer in LAYERS}
        self.header_layer = {header: layer.name for layer in LAYERS for header in layer.headers}

    def exists(self, path):
        return os.path.isfile(os.path.join(self.root, path))

    def sources(self):
        for top in ("include", "kernels", "src", "bench", "tests"):
            for folder, _, names in os.walk(os.path.join(self.root, top)):
                for name in sorted(names):
                    if name.endswith(SOURCES):
                        yield os.path.relpath(os.path.join(folder, name), self.root)

    def layer_of(self, path):
        """Name of the layer, of the free folder, or None."""
        if in_folder(path, "include"):
            return self.header_layer.get(os.path.basename(path))
        for layer in LAYERS:
            if any(in_folder(path, folder) for folder in layer.folders):
                return layer.name
        return next((folder for folder in FREE if in_folder(path, folder)), None)

    def includes(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8") as file:
            for number, line in enumerate(file, 1):
                found = INCLUDE.match(line)
                if found:
                    yield number, found[1] == '"', found[2]

    def target_of(self, name):
        """The file of the tree that an include names, or None."""
        candidates = (name, "include/" + name)
        return next((path for path in candidates if self.exists(path)), None)

    def broken_rule(self, path, quoted, name):
        """The rule that an include breaks, or None."""
        user = self.layer_of(path)
        target = self.target_of(name)
        if in_folder(path, "include"):
            if not name.startswith("needlework/") and (quoted or not STANDARD.fullmatch(name)):
                return "public headers include the standard library and needlework/... alone"
        if target is None:
            if quoted:
                return "there is no such file; paths start at the root of the project"
            for pattern, users in LIBRARIES:
                if re.fullmatch(pattern, name) and user not in users and user not in FREE:
                    return f"only {', '.join(users)} may include {name}, not {user}"
            return None
        used = self.layer_of(target)
        if used is None:
            return f"{target} is in no layer: expected one in the table of {os.path.basename(__file__)}"
        if used == user or user in FREE:
            return None
        if used in FREE:
            return f"nothing but bench and tests may use {used}"
        layer = self.by_name[user]
        if used in layer.uses:
            return None
        if used in layer.public:
            if in_folder(target, "include"):
                return None
            return f"{user} may use {used} through its public headers alone"
        may = list(layer.uses) + [f"{name} (public headers)" for name in layer.public]
        return f"{user} may use {', '.join(may) or 'no other layer'}, not {used}"

    def violations(self):
        for path in self.sources():
            if self.layer_of(path) is None:
                yield f"{path}:1: in no layer: expected one in the table of {os.path.basename(__file__)}"
                continue
            for number, quoted, name in self.includes(path):
                rule = self.broken_rule(path, quoted, name)
                if rule:
                    shown = f'"{name}"' if quoted else f"<{name}>"
                    yield f"{path}:{number}: {shown}: {rule}"

        for header, layer in self.header_layer.items():
            if not any(self.exists(folder + header) for folder in ("include/", "include/needlework/")):
                yield f"layers.py: {header} of {layer} is not in include/needlework"

    def graph(self):
        uses = collections.Counter()
        for path in self.sources():
            for _, _, name in self.includes(path):
                target = self.target_of(name)
                if target and self.layer_of(target) != self.layer_of(path):
                    uses[self.layer_of(path), self.layer_of(target)] += 1
        return uses


def check_table():
    """The table itself runs one way: a layer uses those above it in the list."""
    known = []
    for layer in LAYERS:
        for used in (*layer.uses, *layer.public):
            if used not in known:
                sys.exit(f"layers.py: {layer.name} uses {used}, which does not stand below it")
        known.append(layer.name)


def main():
    check_table()
    tree = Tree(sys.argv[1])
    if "--graph" in sys.argv:
        for (user, used), count in sorted(tree.graph().items(), key=str):
            print(f"{user} -> {used}: {count}")
        return 0
    violations = list(tree.violations())
    print("\n".join(violations) or "use runs one way")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
