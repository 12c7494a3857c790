"""Scenes that the tests of the Python package share."""

import copy
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

GAS = {
    "title": "Cooling needles",
    "needles": {"count": 200, "box": 6.0, "seed": 3},
    "collisions": {"epsilon": 0.8, "tc_relative": 1e-3},
    "until": {"collisions_per_needle": 20},
}
ELASTIC = {"needles": {"count": 200, "box": 6.0}}


def gas(**sections):
    """GAS with keys replaced: gas(needles={"count": 3}, output={...})."""
    scene = copy.deepcopy(GAS)
    for section, keys in sections.items():
        scene[section] = {**scene.get(section, {}), **keys}
    return scene


def require(*modules):
    """Ends the test as skipped (77) where one of these modules is missing."""
    for module in modules:
        if importlib.util.find_spec(module) is None:
            print(f"skipped: {module} is missing: expected the packages of packages.txt")
            sys.exit(77)


class InFolder(unittest.TestCase):
    """A test with a folder of its own, self.folder."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)


def printed_by(*words, **options):
    """What the program prints; it has to succeed."""
    return subprocess.run([os.environ["NEEDLEWORK_PROGRAM"], *map(str, words)], check=True,
                          capture_output=True, text=True, **options).stdout


def script(path, text):
    """A program of the shell at this path."""
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(0o755)
    return path
