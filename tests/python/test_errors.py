"""Errors: what is wrong is named as the program names it."""

import copy
import json
import os
import pickle
import re
import unittest
import warnings
from pathlib import Path

import needlework
import numpy as np
from needlework import InputError, IoError, Simulation

from support import GAS, InFolder, gas

COLLAPSE = {"needles": {"count": 50, "box": 2.5}, "collisions": {"epsilon": 0.1}}


class Scenes(InFolder):
    def rejects(self, scene, message, error=InputError, **arguments):
        with self.assertRaisesRegex(error, message), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            Simulation(scene, **arguments)

    def test_keys_of_dictionaries_are_named(self):
        self.rejects(gas(needles={"count": -1}), r"^scene: needles.count = -1: expected a whole number")
        self.rejects(gas(needles={"cuont": 1}), r"^scene: needles.cuont = 1: expected .*count")
        self.rejects(gas(collisions={"epsilon": "high"}),
                     r'^scene: collisions.epsilon = "high": expected a number')
        self.rejects({"needles": {"count": 5}}, r"^scene: needles.box is missing: expected")
        self.rejects(gas(engine={"isa": "mmx"}), r'^scene: engine.isa = "mmx": expected')
        self.rejects(gas(needles={"box": object()}),
                     r"^scene: needles.box = <object .*>: expected a number")
        self.rejects({3: {}}, "key 3: expected a string")

    def test_lines_of_text_are_named(self):
        self.rejects("title = 'x'\nneedles.count = -1\n",
                     r"^scene: line 2: needles.count = -1: expected")
        path = self.folder / "gas.toml"
        path.write_text("needles = { count = 10, box = 1 }")
        self.rejects(path, rf"^{path}: line 1: needles.box = 1: expected")

    def test_words_are_those_of_every_way_in(self):
        # tests/cli/one_validity_test.cpp reads the same table for the other ways.
        table = Path(__file__).parent.parent / "scene" / "invalid_scenes.json"
        for scene in json.loads(table.read_text()):
            if not scene.get("front_ends", True):
                continue
            key, _, value = scene.get("set", "").partition("=")
            entry = re.fullmatch(r"((?:species|pairs|walls)\.)[^.]*\.(.*)", key)
            base = scene.get("base", "needles = { count = 10, box = 12 }\nuntil.time = 5\n")
            text = f"{base}{entry[2]} = {value}\n" if entry else f"{key} = {value}\n{base}"
            key = scene.get("file_key", scene.get("key", entry[1] + entry[2] if entry else key))
            with self.subTest(scene):
                place = rf"line \d+: {re.escape(key)} = .*: " if key else ""
                self.rejects(scene.get("text", text),
                             f"^scene: {place}{re.escape(scene['message'])}$")

    def test_types_of_scenes_are_checked(self):
        self.rejects(5, "^scene = 5: expected a dictionary of sections, TOML text or a path")
        self.rejects("no-such-scene.toml", "^no-such-scene.toml: cannot be read", IoError)

    def test_warnings_are_given(self):
        with self.assertWarnsRegex(needlework.SceneWarning, "tc_relative"):
            Simulation(gas(collisions={"tc_relative": None}))

    def test_states_are_checked(self):
        rows = np.zeros((3, 3))
        self.rejects(GAS, "^orientation is missing: expected position and orientation",
                     position=rows)
        arrays = {"velocity": rows, "orientation": rows + [1, 0, 0], "angular_velocity": rows}
        positions = np.arange(9.0).reshape(3, 3)
        scene = {"needles": {"box": 20}}
        self.rejects(scene, r"^position: shape \(3,\): expected \(N, 3\)", position=rows[0],
                     **arrays)
        self.rejects(scene, r"^velocity: shape \(3, 3\): expected \(2, 3\)",
                     position=positions[:2], **arrays)
        for values, expected in (
                (np.ma.masked_array(rows, mask=np.eye(3)), "without masked values"),
                (rows + 1j, "of numbers: not complex128"),
                (rows.astype("datetime64[s]"), "of numbers: not datetime64")):
            self.rejects(scene, f"^velocity: expected an array {expected}", position=positions,
                         orientation=arrays["orientation"], velocity=values)
        self.rejects({"needles": {"count": 4, "box": 20}}, r"needles.count = 4: expected 3",
                     position=positions, **arrays)
        self.rejects({}, "needles.box is missing", position=positions, **arrays)
        self.rejects(gas(initial={"t_tr": 2.0}), "initial.t_tr = 2.0: expected none",
                     position=positions, **arrays)
        self.rejects(scene, "director|orientation", position=positions,
                     **{**arrays, "orientation": rows})
        self.rejects(scene, "^position: expected an array of numbers", position="abc", **arrays)

    def test_images_and_ids_are_checked(self):
        zeros = np.zeros((3, 3))
        scene = {"needles": {"box": 20}}
        whole = {"position": zeros, "orientation": zeros + [1, 0, 0]}
        for name in ("image", "id"):
            self.rejects(scene, "^position is missing: expected position and orientation",
                         **{name: zeros})
        images = "expected a whole number from -[0-9]+ to [0-9]+$"
        ids = "expected a whole number from 0 to 4294967295$"
        for image, message in (
                (zeros[:2], r"^image: shape \(2, 3\): expected \(3, 3\)$"),
                (zeros[0], r"^image: shape \(3,\): expected \(3, 3\)$"),
                ("abc", "^image: expected an array of numbers"),
                ([[0] * 3, [0, 2**31, 0], [0] * 3], rf"^image\[1, 1\] = 2147483648: {images}"),
                ([[0] * 3, [0] * 3, [0, 0, -2**31]], rf"^image\[2, 2\] = -2147483648: {images}"),
                (zeros + np.uint64(2**64 - 1), rf"^image\[0, 0\] = .*: {images}"),
                (zeros + 0.5, rf"^image\[0, 0\] = 0.5: {images}"),
                (zeros + np.nan, rf"^image\[0, 0\] = nan: {images}")):
            self.rejects(scene, message, image=image, **whole)
        for id, message in (
                (zeros, r"^id: shape \(3, 3\): expected \(3,\)$"),
                ([1, 2], r"^id: shape \(2,\): expected \(3,\)$"),
                ([1, 2, -3], rf"^id\[2\] = -3: {ids}"),
                ([1, 2**32, 3], rf"^id\[1\] = 4294967296: {ids}"),
                ([1, 2, 2.5], rf"^id\[2\] = 2.5: {ids}"),
                ([7, 2, 7], "^state: id 7 twice: expected distinct ids$")):
            self.rejects(scene, message, id=id, **whole)
        most = [[2**31 - 2**11 - 1, 2**11 + 1 - 2**31, 0]] * 3
        np.testing.assert_array_equal(Simulation(scene, image=most, **whole).image, most)

    def test_names_that_are_not_utf8_are_names(self):
        for path in (os.path.join(os.fsencode(self.folder), b"a\xff.toml"),
                     os.fsdecode(os.path.join(os.fsencode(self.folder), b"b\xff.toml"))):
            path = Path(os.fsdecode(path))
            with self.assertRaisesRegex(IoError, r"\\xff.toml: .*No such file"):
                Simulation(path)
            path.write_text("needles = { count = 5, box = 5 }\nwrong = 1\n")
            with self.assertRaisesRegex(InputError, r"\\xff.toml: line 2: wrong"):
                Simulation(path)
            path.write_text("needles = { count = 5, box = 5 }\n")
            state = path.with_suffix(".h5")
            Simulation(path).save(state)
            with self.assertRaisesRegex(IoError, r"\udcff.h5: exists"):
                Simulation(path).save(os.fsencode(state))
            with self.assertRaisesRegex(InputError, r"\udcff.h5.checkpoint: missing"):
                Simulation.resume(state)

    def test_what_cannot_be_pickled_says_what_to_do(self):
        sim = Simulation(GAS)
        for use in (pickle.dumps, copy.copy, copy.deepcopy):
            with self.assertRaisesRegex(TypeError, r"Simulation cannot be pickled.*sim\.state"):
                use(sim)
        for value in (sim.state, sim.totals, sim.gas, sim.counters):
            self.assertEqual(repr(pickle.loads(pickle.dumps(value))), repr(value))

    def test_values_print_as_one_line(self):
        sim = Simulation(GAS)
        for value in (sim.totals, sim.gas, sim.counters, sim.state):
            self.assertNotIn("\n", str(value))
            self.assertLess(len(str(value)), 1500, str(value))

    def test_classes_are_those_of_python_too(self):
        self.assertTrue(issubclass(InputError, (needlework.Error, ValueError)))
        self.assertTrue(issubclass(InputError, ValueError))
        self.assertTrue(issubclass(IoError, OSError))
        for error in (InputError, IoError, needlework.InvalidStateError):
            self.assertTrue(issubclass(error, needlework.Error))


class Runs(InFolder):
    def test_limits_are_checked(self):
        sim = Simulation({"needles": {"count": 3, "box": 3}})
        for call, message in ((lambda: sim.run(time=-1), "time = -1: expected a number >= 0"),
                              (lambda: sim.run(time=True), "time = .*: expected a number >= 0"),
                              (lambda: sim.run(time=float("nan")), "time = nan: expected"),
                              (lambda: sim.run(time="soon"), "time = 'soon': expected a number"),
                              (lambda: sim.advance(collisions=-1), "collisions = -1: expected"),
                              (lambda: sim.advance(collisions=2.5), "collisions = 2.5: expected"),
                              (lambda: sim.advance(), "no end condition: expected"),
                              (lambda: sim.run(), "no end condition: expected")):
            with self.assertRaisesRegex(InputError, message):
                call()

    def test_a_collapse_is_an_invalid_state_that_can_be_looked_at(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            sim = Simulation(COLLAPSE)
        with self.assertRaisesRegex(needlework.InvalidStateError, "collapse of needles"):
            sim.run(collisions_per_needle=10000)
        self.assertTrue(np.all(np.isfinite(sim.velocity)))
        self.assertGreater(sim.totals.collisions, 0)

    def test_velocities_are_checked(self):
        sim = Simulation(GAS)
        good = np.zeros((200, 3))
        with self.assertRaisesRegex(InputError, r"^velocity: shape \(3, 3\): expected \(200, 3\)"):
            sim.set_velocities(good[:3], good)
        before = sim.velocity
        with self.assertRaisesRegex(InputError, "finite"):
            sim.set_velocities(good + np.nan, good)
        np.testing.assert_array_equal(sim.velocity, before)

    def test_files_are_kept_unless_forced(self):
        path = self.folder / "run.h5"
        path.write_text("precious")
        scene = gas(output={"file": str(path)})
        with self.assertRaisesRegex(
                IoError, rf'^scene: output.file = "{path}": exists already: expected a new '
                         "file, or force=True to replace it"):
            Simulation(scene)
        self.assertEqual(path.read_text(), "precious")
        with Simulation(scene, force=True) as sim:
            with self.assertRaisesRegex(IoError, "another .* simulation has the file open for"):
                Simulation(scene, force=True)
            sim.run()
        with needlework.read(path) as recording:
            self.assertEqual(recording.series.collisions[-1], 2000)
        with self.assertRaisesRegex(IoError, "folder that exists"):
            Simulation(gas(output={"file": str(Path(self.folder, "none", "run.h5"))}))

    def test_a_file_that_cannot_be_closed_is_left_to_others(self):
        there, away = self.folder / "there", self.folder / "away"
        there.mkdir()
        path = there / "run.h5"
        sim = Simulation(gas(output={"file": str(path)}))
        sim.advance(collisions=100)
        sim.checkpoint()
        there.rename(away)  # as a folder of a network may go
        with self.assertRaises(IoError):
            sim.close()
        sim.close()  # it has been told
        away.rename(there)
        with Simulation.resume(path) as again:
            self.assertEqual(again.hash, sim.hash)

    def test_a_closed_simulation_can_be_read_only(self):
        sim = Simulation(GAS)
        sim.advance(collisions=10)
        sim.close()
        sim.close()
        self.assertEqual(sim.totals.collisions, 10)
        with self.assertRaisesRegex(needlework.Error, "is closed"):
            sim.run()


if __name__ == "__main__":
    unittest.main()
