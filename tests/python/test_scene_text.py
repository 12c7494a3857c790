"""Dictionaries become TOML that says the same."""

import tomllib
import unittest
from pathlib import Path

import numpy as np
from needlework import InputError, Simulation
from needlework.scene_text import toml_text

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
