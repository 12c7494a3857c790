"""Velocities that a caller sets, and data of its own: what files say of them."""

import json
import unittest

from support import InFolder, gas, printed_by, require

require("h5py")

import needlework  # noqa: E402
import numpy as np  # noqa: E402
from needlework import Error, InputError, Simulation, read  # noqa: E402


class Files(InFolder):
    def setUp(self):
        super().setUp()
        self.path = str(self.folder / "gas.h5")

    def simulation(self, **output):
        return Simulation(gas(output={"file": self.path, "series_every": 0.5, **output}))


class VelocitiesSet(Files):
    def heat(self, sim):
        sim.set_velocities(2 * sim.velocity, 2 * sim.angular_velocity)

    def test_files_say_when_and_by_how_much(self):
        with self.simulation() as sim:
            self.assertEqual(sim.gas.undisturbed_until, np.inf)
            sim.run(time=0.25)
            before = sim.totals
            self.heat(sim)
            sim.run(time=1)
            self.heat(sim)
            self.assertEqual(sim.gas.undisturbed_until, 0.25)
        with read(self.path) as run:
            changes = run.velocities_set
            np.testing.assert_array_equal(changes.time, [0.25, 1])
            self.assertEqual(changes.collisions[0], before.collisions)
            self.assertEqual(changes.energy[0, 0], before.energy)
            np.testing.assert_allclose(changes.energy[:, 1], 4 * changes.energy[:, 0])
            np.testing.assert_allclose(changes.momentum[:, 1], 2 * changes.momentum[:, 0])
            self.assertEqual(run.gas.undisturbed_until, 0.25)
            theory = run.observable("theory").energy
            np.testing.assert_array_equal(np.isnan(theory), run.series.time > 0.25)

    def test_files_without_them_have_no_rows(self):
        self.simulation().close()
        with read(self.path) as run:
            self.assertEqual(run.velocities_set.rows, 0)
            self.assertEqual(run.gas.undisturbed_until, np.inf)
            self.assertEqual(run.data, {})

    def test_samples_of_that_instant_hold_both(self):
        with self.simulation() as sim:
            sim.run(time=0.5)
            old = sim.totals.energy
            sim.sample(frame=True)
            self.heat(sim)
            sim.run(time=0.75)
        with self.assertRaises(Error):
            sim.sample()
        with read(self.path) as run:
            there = run.series.time == 0.5
            np.testing.assert_allclose(run.series.energy[there], [old, 4 * old])
        with self.assertRaisesRegex(Error, "no output file"):
            Simulation(gas()).sample()

    def test_the_program_says_nothing_of_theory_any_more(self):
        with self.simulation() as sim:
            sim.run(time=0.25)
            self.heat(sim)
        resumed = json.loads(printed_by("resume", self.path, "--set", "until.time=0.75", "--quiet",
                                        "--json"))
        self.assertEqual((resumed["time"], resumed["theory"]), (0.75, None))
        self.assertIn("/velocities_set: 1 change, time 0.25 to 0.25", printed_by("info", self.path))
        page = self.path + ".html"
        printed_by("report", self.path, "-o", page)
        with open(page, encoding="utf-8") as file:
            text = file.read()
        self.assertIn('"velocities_set":0.25', text)
        self.assertIn('"ratio_of_theory":null', text)

    def test_pictures_end_the_theory_there(self):
        require("matplotlib")
        import matplotlib
        matplotlib.use("Agg")
        with self.simulation() as sim:
            sim.run(time=1)
            self.heat(sim)
            sim.run(time=3)
        for draw in (needlework.plot.cooling, needlework.plot.temperature_ratio):
            theory, measured = draw(self.path).get_lines()
            self.assertEqual(theory.get_xdata().max(), 1)
            self.assertEqual(measured.get_xdata().max(), 3)


class Data(Files):
    def test_comes_back_from_checkpoints_and_files(self):
        rng = np.random.default_rng(5)
        with self.simulation() as sim:
            sim.data["notes"] = {"lid": "offen, µ", "n": [1, 2.5, None, True]}
            sim.data["generator"] = rng.bit_generator.state  # with whole numbers of 128 bits
            sim.data["bytes"] = bytearray(b"\0\xff\n")
            sim.data["array"] = np.arange(3)
            sim.data["gone"] = 1
            del sim.data["gone"]
            expected = dict(sim.data)
            sim.save(self.path + ".state")
        self.assertEqual(expected["bytes"], b"\0\xff\n")
        self.assertEqual(expected["array"], [0, 1, 2])
        self.assertEqual(expected["generator"], rng.bit_generator.state)
        resumed = Simulation.resume(self.path)
        self.assertEqual(dict(resumed.data), expected)
        for path in (self.path, self.path + ".state"):
            with read(path) as run:
                self.assertEqual(run.data, expected)

    def test_is_refused_if_it_cannot_be_carried(self):
        sim = Simulation(gas())
        for name, value, message in (("", 1, "^data: name"), ("a\nb", 1, "^data: name"),
                                     (5, 1, "^data: name = 5: expected a string"),
                                     ("x", float("nan"), "^data: x: expected bytes or what JSON"),
                                     ("x", object(), "^data: x: expected bytes or what JSON"),
                                     ("x", b"x" * (2**24 + 1), "expected at most 16777216")):
            with self.assertRaisesRegex(InputError, message):
                sim.data[name] = value
        self.assertEqual(len(sim.data), 0)
        with self.assertRaises(KeyError):
            sim.data["x"]
        with self.assertRaises(KeyError):
            del sim.data["x"]


if __name__ == "__main__":
    unittest.main()
