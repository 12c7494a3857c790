"""Dictionaries become TOML that says the same."""

import enum
import os
import tomllib
import unittest
from pathlib import Path

import numpy as np
from needlework import InputError, Simulation
from needlework.scene_text import scene_text, toml_text

SCENE = {
    "title": "quotes \" and \\, lines\n, tabs\t, \x01\x7f, µ and 😀",
    "needles": {"count": 3, "box": [5.0, 6, 7.5], "seed": 2**62},
    "a key": {"b.c": True, "list": [[1, 2], ["x", "y"]], "empty": []},
    "numbers": {"small": 5e-324, "large": 1.7976931348623157e308, "third": 1 / 3, "minus": -0.0},
    "walls": [{"axis": "x", "motion": {"amplitude": 0.1}}, {"axis": "y"}],
}


class SceneText(unittest.TestCase):
    def test_says_what_the_dictionary_says(self):
        self.assertEqual(tomllib.loads(toml_text(SCENE)), SCENE)
        self.assertEqual(toml_text({}), "")

    def test_numbers_of_numpy_and_paths_are_plain_values(self):
        text = toml_text({"needles": {"count": np.int64(3), "box": np.array([5.0, 6, 7])},
                          "output": {"events": np.bool_(True), "file": Path("a") / "b.h5"},
                          "until": {"time": np.float32(0.5), "limit": float("inf")}})
        self.assertEqual(tomllib.loads(text), {
            "needles": {"count": 3, "box": [5, 6, 7]},
            "output": {"events": True, "file": "a/b.h5"},
            "until": {"time": 0.5, "limit": float("inf")}})

    def test_numbers_and_paths_of_all_kinds_are_plain_values(self):
        class Side(enum.IntEnum):
            SHORT = 6

        class Named(str, enum.Enum):
            SEARCH = "all-pairs"

        class Shown(float):
            def __repr__(self):
                return "1\n[collisions]"

        class Bytes(os.PathLike):
            def __fspath__(self):
                return b"a.h5"

        text = toml_text({"needles": {"count": Side.SHORT, "box": [np.longdouble(6), Shown(7), 8],
                                      "k": np.float16(0.5)},
                          "engine": {"search": Named.SEARCH}, "output": {"file": Bytes()}})
        self.assertEqual(tomllib.loads(text), {
            "needles": {"count": 6, "box": [6, 7, 8], "k": 0.5},
            "engine": {"search": "all-pairs"}, "output": {"file": "a.h5"}})

    def test_what_utf8_does_not_have_is_named(self):
        file = os.fsdecode(b"a\xff.h5")
        for scene in ({"output": {"file": file}}, f"title = '{file}'\n"):
            with self.assertRaisesRegex(InputError, r"^scene: .*\\udcff.*expected text that UTF-8"):
                scene_text(scene)

    def test_none_is_left_out(self):
        self.assertEqual(toml_text({"title": None, "until": {"time": None}}), "[until]\n")

    def test_what_toml_does_not_have_is_named(self):
        with self.assertRaisesRegex(InputError, "^scene: until.time = 1j: expected a number"):
            toml_text({"until": {"time": 1j}})
        with self.assertRaisesRegex(InputError, "^scene: key 5: expected a string"):
            toml_text({"until": {5: 1}})

    def test_species_are_lists_of_dictionaries(self):
        sim = Simulation({"needles": {"box": 5}, "species": [
            {"name": "short", "count": 50, "length": 0.5, "mass": 2.0}]})
        self.assertEqual((len(sim), sim.gas.length, sim.gas.mass), (50, 0.5, 2))


if __name__ == "__main__":
    unittest.main()
