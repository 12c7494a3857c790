"""Bodies that differ within a species, and fixed ones, as arrays of states and of files."""

import unittest

import support

support.require("numpy", "h5py")

import h5py
import needlework
import numpy as np

SIZES = {"distribution": "lognormal", "mean": 1, "width": 0.3}
SCENE = {"needles": {"box": 7.0, "seed": 5},
         "species": [{"name": "a", "count": 60, "length": SIZES, "diameter": {"aspect": 5},
                      "mass": {"density": 3}},
                     {"name": "wall", "count": 8, "length": 1.5, "diameter": 0.5, "fixed": True}],
         "until": {"collisions_per_needle": 3}}
NUMBERS = ("length", "diameter", "mass", "inertia")


class OwnBodies(support.InFolder):
    def test_states_have_them(self):
        sim = needlework.Simulation(SCENE)
        state = sim.state
        self.assertEqual([name for name in state if name in NUMBERS], list(NUMBERS))
        moving = state.species == 0
        self.assertGreater(len(np.unique(state.length[moving])), 50)
        np.testing.assert_array_equal(state.diameter[moving], state.length[moving] / 5)
        volume = np.pi * state.diameter**2 * (state.length / 4 + state.diameter / 6)
        np.testing.assert_allclose(state.mass[moving], 3 * volume[moving], rtol=1e-14)
        self.assertTrue(np.all(np.isinf(state.mass[~moving])))
        self.assertTrue(np.isinf(state.bodies.mass[1]))
        self.assertTrue(np.isinf(sim.gas.mass[1]))
        for name in NUMBERS:
            np.testing.assert_array_equal(getattr(sim, name), state[name])
            with self.assertRaises(ValueError):
                state[name][0] = 1

    def test_of_bodies_that_are_alike_only_where_asked_for(self):
        sim = needlework.Simulation(support.GAS)
        self.assertNotIn("length", sim.state)
        np.testing.assert_array_equal(sim.length, np.ones(200))
        np.testing.assert_array_equal(sim.diameter, np.zeros(200))
        np.testing.assert_array_equal(sim.mass, np.ones(200))
        np.testing.assert_array_equal(sim.inertia, np.full(200, 1 / 12))

    def test_a_state_goes_on_with_its_bodies(self):
        first = needlework.Simulation(SCENE)
        first.run(collisions=60)
        second = needlework.Simulation({"needles": {"box": 7.0}}, **first.state)
        for name in NUMBERS:
            np.testing.assert_array_equal(second.state[name], first.state[name])
        self.assertAlmostEqual(second.totals.energy, first.totals.energy, places=13)
        self.assertAlmostEqual(second.totals.t_rot, first.totals.t_rot, places=13)
        second.run(collisions=60)

    def test_files_have_them(self):
        path = str(self.folder / "run.h5")
        with needlework.Simulation({**SCENE, "output": {"file": path}}) as sim:
            sim.run()
        with needlework.read(path) as run:
            frame = run.frames[-1]
            for name in NUMBERS:
                np.testing.assert_array_equal(getattr(frame, name), sim.state[name])
                np.testing.assert_array_equal(frame.state[name], sim.state[name])
            again = needlework.Simulation({"needles": {"box": 7.0}}, **frame.state)
            self.assertEqual(again.state.bodies.mass[1], np.inf)
        of_file = needlework.Simulation({"initial": {"file": path}})
        again.run(collisions=50)
        of_file.run(collisions=50)
        self.assertEqual(again.hash, of_file.hash)

    def test_of_thin_needles_in_files_have_a_diameter_of_0(self):
        path = str(self.folder / "thin.h5")
        scene = {"needles": {"box": 6.0}, "species": [{"name": "a", "count": 30, "length": SIZES}]}
        needlework.Simulation(scene).save(path)
        with needlework.read(path) as run:
            self.assertNotIn("diameter", h5py.File(path)["particles/needles"])
            np.testing.assert_array_equal(run.frames[0].state.diameter, np.zeros(30))
            self.assertEqual(len(run.frames[0].state.to_pandas().columns), 21)

    def test_resumed_runs_have_them(self):
        path = str(self.folder / "run.h5")
        with needlework.Simulation({**SCENE, "output": {"file": path}}) as sim:
            sim.run(collisions=60)
        again = needlework.Simulation.resume(path)
        for name in NUMBERS:
            np.testing.assert_array_equal(again.state[name], sim.state[name])
        again.run(collisions=120)
        whole = needlework.Simulation(SCENE)
        whole.run(collisions=120)
        self.assertEqual(again.hash, whole.hash)

    def test_what_is_not_given_follows_from_the_scene(self):
        start = needlework.Simulation({"needles": {"box": 5.0, "count": 10}}).state
        arrays = {name: start[name] for name in ("position", "orientation")}
        length = np.linspace(0.5, 1.4, 10)
        scene = {"needles": {"box": 5.0}, "species": [{"name": "a", "mass": {"density": 2}}]}
        sim = needlework.Simulation(scene, **arrays, length=length)
        np.testing.assert_array_equal(sim.length, length)
        np.testing.assert_array_equal(sim.mass, 2 * length)
        np.testing.assert_allclose(sim.inertia, 2 * length**3 / 12, rtol=1e-15)

    def test_bad_arrays_are_named(self):
        start = needlework.Simulation({"needles": {"box": 5.0, "count": 4}}).state
        arrays = {name: start[name] for name in ("position", "orientation")}
        for numbers, message in [
                ({"length": [1, 2, 3]}, "length: shape (3,): expected (4,)"),
                ({"mass": [[1, 2, 3, 4]]}, "mass: shape (1, 4): expected (4,)"),
                ({"mass": ["a", "b", "c", "d"]}, "mass: expected an array of numbers"),
                ({"length": [1, 1, -1, 1]}, "needle 2: length = -1: expected from 1e-06 to 1e+06"),
                ({"mass": [1, np.nan, 1, 1]}, "needle 1: mass = nan: expected from"),
                ({"mass": [1, 1, 1, np.inf]}, "needle 3: mass = inf: expected from"),
                ({"inertia": [1, 1, 1, 1e300]}, "needle 3: inertia = 1e+300: expected one with"),
                ({"diameter": [0.1, 0.1, 0, 0.1], "length": [1, 1, 1, 1]},
                 "needle 2: diameter = 0: expected a number above 0")]:
            with self.assertRaisesRegex(needlework.InputError, self.quoted(message)):
                needlework.Simulation({"needles": {"box": 5.0}}, **arrays, **numbers)
        with self.assertRaisesRegex(needlework.InputError, "position is missing"):
            needlework.Simulation({"needles": {"box": 5.0}}, mass=[1, 2])

    @staticmethod
    def quoted(text):
        return "".join("\\" + char if char in "()[].+" else char for char in text)

    def test_bad_arrays_of_files_are_named(self):
        path = str(self.folder / "run.h5")
        needlework.Simulation(SCENE).save(path)
        with h5py.File(path, "r+") as file:
            del file["particles/needles/mass"]
            file["particles/needles/mass"] = [1.0, 2.0]
        with self.assertRaisesRegex(needlework.InputError,
                                    r"mass: type float64 and shape \[2\]: expected a number for each"):
            needlework.read(path)
        with self.assertRaisesRegex(needlework.InputError,
                                    "/particles/needles/mass: 2 numbers: expected 68"):
            needlework.Simulation({"initial": {"file": path}})


if __name__ == "__main__":
    unittest.main()
