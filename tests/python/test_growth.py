"""Bodies that grow: present sizes in simulations, files and what starts from them."""

import unittest

import needlework
import numpy as np
from needlework import Simulation

from support import InFolder

SCENE = {"needles": {"count": 60, "box": 6.0, "diameter": 0.3},
         "driving": {"growth": {"rate": 0.1, "until_packing": 0.2}}}


class Growth(InFolder):
    def grown(self, **more):
        sim = Simulation({**SCENE, **more})
        self.assertEqual(sim.run(time=1000), "grown")
        return sim

    def test_sizes_packing_and_pressure(self):
        sim = Simulation(SCENE)
        self.assertAlmostEqual(sim.growth.scale, 1, places=14)
        self.assertTrue(np.isnan(sim.growth.pressure))
        sim = self.grown()
        growth = sim.growth
        self.assertAlmostEqual(growth.packing_fraction, 0.2, places=12)
        self.assertEqual(sim.rod_totals.packing_fraction, growth.packing_fraction)
        self.assertGreater(growth.pressure, 1)
        self.assertEqual(sim.scale, growth.scale)
        np.testing.assert_allclose(sim.length, growth.scale, rtol=1e-14)
        np.testing.assert_allclose(sim.diameter, 0.3 * growth.scale, rtol=1e-14)
        self.assertIsNone(Simulation({"needles": {"count": 9, "box": 5.0}}).growth)

    def test_growth_is_an_end_of_its_own(self):
        self.assertEqual(Simulation(SCENE).run(), "grown")
        with self.assertRaisesRegex(needlework.InputError, "no end condition"):
            Simulation({"needles": {"count": 60, "box": 6.0}}).run()

    def test_bodies_of_arrays_grow(self):
        drawn = Simulation({"needles": {"count": 60, "box": 6.0, "diameter": 0.3}})
        arrays = {name: drawn.state[name] for name in
                  ("position", "orientation", "velocity", "angular_velocity")}
        diameter = np.linspace(0.2, 0.3, 60)
        scene = {"needles": {"box": 6.0}, "driving": {"growth": {"rate": 0.1}}}
        sim = Simulation(scene, **arrays, diameter=diameter)
        sim.run(time=1)
        self.assertGreater(sim.scale, 1)
        np.testing.assert_allclose(sim.diameter, diameter * sim.scale, rtol=1e-14)
        with self.assertRaisesRegex(needlework.InputError, "expected bodies with a diameter"):
            Simulation(scene, **arrays)

    def test_a_state_starts_another_simulation(self):
        sim = self.grown()
        self.assertNotIn("length", sim.state)
        np.testing.assert_allclose(sim.state.bodies.diameter, [0.3 * sim.scale], rtol=1e-14)
        again = Simulation({"needles": {"box": 6.0}}, **sim.state)
        np.testing.assert_allclose(again.diameter, sim.diameter, rtol=1e-14)
        np.testing.assert_allclose(again.inertia, sim.inertia, rtol=1e-13)
        self.assertAlmostEqual(again.rod_totals.packing_fraction, 0.2, places=12)
        again.run(collisions=100)
        with self.assertRaisesRegex(needlework.InputError, "diameter = 0.3: expected"):
            Simulation({"needles": {"box": 6.0, "diameter": 0.3}}, **sim.state)

    def test_frames_have_present_sizes(self):
        path = self.folder / "run.h5"
        sim = self.grown(output={"file": str(path), "frames_every": 2.0})
        sim.close()
        with needlework.read(path) as recording:
            first, last = recording.frames[0], recording.frames[-1]
            self.assertAlmostEqual(first.scale, 1, places=14)
            self.assertAlmostEqual(last.scale, sim.scale, places=14)
            np.testing.assert_allclose(last.length, sim.length, rtol=1e-14)
            np.testing.assert_allclose(last.diameter, sim.diameter, rtol=1e-14)
            np.testing.assert_allclose(last.inertia, first.inertia, rtol=1e-13)
            table = recording.observable("growth")
            self.assertEqual(table.scale[-1], last.scale)
            again = Simulation({"needles": {"box": 6.0}}, **last.state)
        np.testing.assert_allclose(again.diameter, sim.diameter, rtol=1e-14)

    def test_saved_states_have_present_sizes(self):
        sim = self.grown()
        path = self.folder / "state.h5"
        sim.save(path)
        again = Simulation({"initial": {"file": str(path)}})
        np.testing.assert_allclose(again.diameter, sim.diameter, rtol=1e-14)
        again.run(collisions=100)

    def test_gsd_has_present_sizes(self):
        try:
            import gsd.hoomd  # noqa: F401
        except ImportError:
            self.skipTest("needs python3-gsd")
        path = self.folder / "a.gsd"
        sim = self.grown()
        needlework.to_gsd(sim, str(path))
        state = needlework.from_gsd(str(path)).state
        np.testing.assert_allclose(state.bodies.diameter, 0.3 * sim.scale, rtol=1e-14)


if __name__ == "__main__":
    unittest.main()
