#!/usr/bin/env python3
"""layers.py finds what it should: each kind of wrong include is tried in a tree of its own."""

import os
import sys
import tempfile

import layers

# file, its include, a part of the rule that it breaks; or none
CASES = [
    ("src/search/a.h", '"src/physics/gas.h"', None),
    ("src/physics/a.h", '"src/search/grid.h"', "physics may use base, memory, archive, composition, kernels, box, not search"),
    ("src/physics/a.cpp", '"needlework/simulation.h"', "not engine"),
    ("kernels/a_body.h", '"src/physics/gas.h"', "kernels may use base, memory, not physics"),
    ("src/theory/a.cpp", '"needlework/totals.h"', "theory may use base, composition, not trajectory"),
    ("src/engine/a.cpp", '"needlework/h5md.h"', "not io"),
    ("src/engine/a.cpp", '"src/runs/drive.h"', "not runs"),
    ("src/runs/a.cpp", '"src/cli/messages.h"', "not program"),
    ("src/runs/a.cpp", '"src/engine/run.h"', "engine through its public headers alone"),
    ("src/runs/a.cpp", '"needlework/simulation.h"', None),
    ("src/io/a.cpp", '"src/scene/check.h"', "scene through its public headers alone"),
    ("src/observe/a.h", '"needlework/scene.h"', None),
    ("src/audit/a.cpp", '"kernels/isa.h"', "not kernels"),
    ("src/audit/a.cpp", '"src/trajectory/sum.h"', "trajectory through its public headers alone"),
    ("src/scene/a.cpp", '"bench/strategies/cases.h"', "not program"),
    ("src/scene/a.cpp", '"tests/support/a.h"', "nothing but bench and tests may use tests"),
    ("src/cli/a.cpp", '"bench/strategies/cases.h"', None),
    ("tests/a.cpp", '"src/cli/messages.h"', None),
    ("src/search/a.cpp", "<hdf5.h>", "only io, runs may include hdf5.h, not search"),
    ("src/io/a.cpp", "<hdf5.h>", None),
    ("src/runs/a.cpp", "<toml++/toml.h>", "only scene_text may include"),
    ("src/runs/a.cpp", "<CLI/CLI.hpp>", "only program may include"),
    ("src/runs/a.cpp", "<nlohmann/json.hpp>", "only scene_text, program, bindings, json, report may include"),
    ("src/runs/a.cpp", "<csignal>", "only io, program may include"),
    ("include/needlework/scene.h", "<vector>", None),
    ("include/needlework/scene.h", "<fmt/format.h>", "public headers include the standard"),
    ("include/needlework/scene.h", "<unistd.h>", "public headers include the standard"),
    ("include/needlework/scene.h", '"src/scene/check.h"', "public headers include the standard"),
    ("include/needlework/scene.h", '"needlework/h5md.h"', "not io"),
    ("include/needlework/mine.h", "<vector>", "in no layer"),
    ("src/new/a.cpp", "<vector>", "in no layer"),
    ("src/engine/a.cpp", '"absent.h"', "there is no such file"),
]


def write(root, path, text):
    os.makedirs(os.path.join(root, os.path.dirname(path)), exist_ok=True)
    with open(os.path.join(root, path), "w", encoding="utf-8") as file:
        file.write(text)


def main():
    wrong = 0
    headers = [header for layer in layers.LAYERS for header in layer.headers]
    for path, include, expected in CASES:
        with tempfile.TemporaryDirectory() as root:
            for header in headers:
                write(root, "include/needlework/" + header, "")
            for _, other, _ in CASES:
                if other.startswith('"src') or other.startswith('"kernels') or "cases.h" in other:
                    write(root, other.strip('"'), "")
            write(root, "tests/support/a.h", "")
            write(root, path, f"// A file.\n#include {include}\n")
            found = list(layers.Tree(root).violations())
            place = f"{path}:1: " if "in no layer" in (expected or "") else f"{path}:2: {include}: "
            good = not found if expected is None else (
                len(found) == 1 and found[0].startswith(place) and expected in found[0])
            if not good:
                wrong += 1
                print(f"{path} includes {include}: expected {expected}, got {found}")
    print(f"{len(CASES)} includes tried, {wrong} judged wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
