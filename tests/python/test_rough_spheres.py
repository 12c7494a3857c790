"""Rough spheres keep their moments of inertia on every way from one simulation to the next."""

import unittest
import warnings

import needlework
import numpy as np
from needlework import SceneWarning, Simulation

from support import InFolder

SPHERES = {"needles": {"box": 6.0}, "collisions": {"beta": 0.5},
           "species": [{"name": "s", "count": 40, "length": 0, "diameter": 0.8, "inertia": 0.05}]}
SILENT = {"needles": {"box": 6.0}, "collisions": {"beta": 0.5}}
GROWING = {**SPHERES, "driving": {"growth": {"rate": 0.1}}}


class RoughSpheres(InFolder):
    def expect_same(self, again, sim):
        np.testing.assert_allclose(again.inertia, sim.inertia, rtol=1e-15)
        self.assertAlmostEqual(again.totals.t_rot / sim.totals.t_rot, 1, places=13)
        self.assertAlmostEqual(again.totals.energy / sim.totals.energy, 1, places=13)

    def saved(self, sim):
        path = self.folder / "state.h5"
        sim.save(path, force=True)
        return Simulation({"initial": {"file": str(path)}, "collisions": {"beta": 0.5}})

    def test_of_states_and_frames(self):
        path = self.folder / "run.h5"
        with Simulation({**SPHERES, "output": {"file": str(path)}}) as sim:
            sim.run(time=1)
        np.testing.assert_allclose(sim.inertia, 0.05, rtol=1e-15)
        self.expect_same(Simulation(SILENT, **sim.state), sim)
        with needlework.read(path) as recording:
            frame = recording.frames[-1]
            np.testing.assert_array_equal(frame.inertia, sim.inertia)
            self.expect_same(Simulation(SILENT, **frame.state), sim)

    def test_of_two_species(self):
        other = {"name": "t", "count": 20, "length": 0, "diameter": 1.1, "mass": 2.0,
                 "inertia": 0.1}
        sim = Simulation({**SPHERES, "species": [*SPHERES["species"], other]})
        np.testing.assert_allclose(sim.state.bodies.inertia, [0.05, 0.1], rtol=1e-15)
        self.expect_same(Simulation(SILENT, **sim.state), sim)

    def test_of_growing_ones(self):
        sim = Simulation(GROWING)
        sim.run(time=2)
        self.assertGreater(sim.scale, 1.2)
        np.testing.assert_allclose(sim.inertia, 0.05, rtol=1e-15)
        by_file, by_state = self.saved(sim), Simulation(SILENT, **sim.state)
        for again in by_file, by_state:
            self.expect_same(again, sim)
            again.run(collisions=300)
        self.assertEqual(by_file.hash, by_state.hash)

    def test_of_gsd(self):
        try:
            import gsd.hoomd  # noqa: F401
        except ImportError:
            self.skipTest("needs python3-gsd")
        sim, path = Simulation(GROWING), str(self.folder / "a.gsd")
        sim.run(time=1)
        needlework.to_gsd(sim, path)
        bodies = needlework.from_gsd(path).state.bodies
        np.testing.assert_array_equal(bodies.inertia, sim.state.bodies.inertia)

    def test_given_as_an_array(self):
        sim = Simulation(SPHERES)
        count = len(sim.id)
        arrays = {name: sim.state[name] for name in ("position", "orientation", "velocity",
                                                     "angular_velocity")}
        sizes = {"length": np.zeros(count), "diameter": np.full(count, 0.8)}
        inertia = np.where(np.arange(count) % 2, 0.05, 0.03)
        for more in {}, {"mass": np.ones(count)}:
            again = Simulation(SILENT, **arrays, **sizes, **more, inertia=inertia)
            np.testing.assert_array_equal(again.inertia, inertia)

    def test_a_state_that_contradicts_itself(self):
        sim = Simulation({"needles": {"count": 40, "box": 6.0, "diameter": 0.1}})
        bodies = {**sim.state.bodies, "inertia": 2 * sim.state.bodies.inertia}
        with self.assertRaisesRegex(needlework.InputError, "inertia = .* expected"):
            Simulation({"needles": {"box": 6.0}}, **{**sim.state, "bodies": bodies})
        # Where it does not say k, that follows.
        del bodies["k"]
        again = Simulation({"needles": {"box": 6.0}}, **{**sim.state, "bodies": bodies})
        np.testing.assert_allclose(again.inertia, 2 * sim.inertia, rtol=1e-14)

    def test_fixed_ones_have_infinite_ones(self):
        fixed = {"name": "f", "count": 5, "length": 0, "diameter": 0.5, "fixed": True}
        sim = Simulation({**SPHERES, "species": [*SPHERES["species"], fixed]})
        self.assertTrue(np.all(np.isinf(sim.inertia[-5:])))
        self.expect_same(Simulation(SILENT, **sim.state), sim)

    def test_velocities_without_spins(self):
        for beta, expected in (0.5, 1), (-1.0, 0):
            sim = Simulation({**SPHERES, "collisions": {"beta": beta}})
            with warnings.catch_warnings(record=True) as found:
                warnings.simplefilter("always")
                sim.set_velocities(sim.velocity)
            self.assertEqual([each.category for each in found], [SceneWarning] * expected)

    def test_sizes_are_the_same_bits_everywhere(self):
        for diameter in 0.8, 0.7, 0.45:
            other = {"name": "t", "count": 20, "length": 0, "diameter": diameter}
            sim = Simulation({**GROWING, "species": [*SPHERES["species"], other]})
            self.assertEqual(sim.scale, 1)
            self.assertEqual(sim.diameter[-1], diameter)
            sim.run(time=1)
            np.testing.assert_array_equal(self.saved(sim).diameter, sim.diameter)


if __name__ == "__main__":
    unittest.main()
