"""Uniform shear: pressure tensor, velocities beside the flow, states and files of sheared boxes."""

import tempfile
import unittest
from pathlib import Path

import h5py
import needlework
import numpy as np
from needlework import InputError, Simulation

COLLISIONS = {"epsilon": 0.9, "tc_relative": 1e-3}
SCENE = {"needles": {"count": 60, "box": 4.0}, "collisions": COLLISIONS,
         "shear": {"rate": 1.5, "offset": 0.5}}


class Shear(unittest.TestCase):
    def test_pressure_is_a_tensor(self):
        with Simulation(SCENE) as sim:
            sim.run(time=3)
            tensor, budget = sim.pressure_tensor, sim.energy_budget
            trace = sum(getattr(tensor, f"collisional_{axis}{axis}") for axis in "xyz")
            self.assertAlmostEqual(trace, 0, places=12)
            self.assertEqual(tensor.kinetic_xy, tensor.kinetic_yx)
            self.assertEqual(tensor.shear_stress, -(tensor.kinetic_yx + tensor.collisional_yx))
            self.assertAlmostEqual(tensor.viscosity, tensor.shear_stress / 1.5, places=12)
            work = 1.5 * tensor.shear_stress * 64 * 3 / 60
            self.assertAlmostEqual(budget.shear, work, delta=0.05 * abs(work) + 0.2)
        with Simulation({"needles": {"count": 9, "box": 5.0}}) as sim:
            self.assertIsNone(sim.pressure_tensor)

    def test_velocities_are_of_the_stored_image_or_beside_the_flow(self):
        sim = Simulation(SCENE)
        sim.run(time=1)
        flow = np.zeros((60, 3))
        flow[:, 0] = 1.5 * sim.position[:, 1]
        np.testing.assert_allclose(sim.velocity - flow, sim.peculiar_velocity, atol=1e-12)
        still = Simulation({"needles": {"count": 9, "box": 5.0}})
        np.testing.assert_array_equal(still.velocity, still.peculiar_velocity)

    def test_states_go_on(self):
        sim = Simulation(SCENE)
        sim.run(time=1)
        scene = {"needles": {"box": 4.0}, "collisions": COLLISIONS, "shear": {"rate": 1.5}}
        again = Simulation(scene, **sim.state)
        np.testing.assert_array_equal(again.velocity, sim.velocity)
        self.assertEqual(again.state["flow"], sim.state["flow"])
        with self.assertRaises(TypeError):
            sim.state.flow["slide"] = 5.5
        state = {key: sim.state[key] for key in ("position", "orientation", "angular_velocity")}
        beside = Simulation({**scene, "shear": {"rate": 3.0}}, peculiar_velocity=sim.peculiar_velocity,
                            **state)
        np.testing.assert_allclose(beside.peculiar_velocity, sim.peculiar_velocity, atol=1e-12)
        with self.assertRaisesRegex(InputError, "expected one of them"):
            Simulation(scene, velocity=sim.velocity, peculiar_velocity=sim.velocity, **state)
        with self.assertRaisesRegex(InputError, "expected a scene with \\[shear\\]"):
            Simulation({"needles": {"box": 4.0}}, **sim.state)

    def test_files_have_the_tilt_and_go_on(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "run.h5")
            with Simulation({**SCENE, "output": {"file": str(file), "series_every": 0.5}}) as sim:
                sim.run(time=2)
                state, beside = sim.state, sim.peculiar_velocity
                viscosity = sim.pressure_tensor.viscosity
            with needlework.read(file) as recording:
                means = recording.observable("pressure_tensor").viscosity
                self.assertAlmostEqual(np.nanmean(means), viscosity, places=12)
                self.assertEqual(recording.observable("energy_budget").shear[0], 0)
            on = Simulation({"initial": {"file": str(file)}, "collisions": COLLISIONS,
                             "shear": {"rate": 1.5}})
            np.testing.assert_array_equal(on.position, state.position)
            with needlework.read(file) as recording:
                last = recording.frames[-1]
                self.assertEqual(last.state["flow"], state["flow"])
                again = Simulation({"needles": {"box": list(last.box)}, "collisions": COLLISIONS,
                                    "shear": {"rate": 1.5}}, **last.state)
                np.testing.assert_array_equal(again.velocity, on.velocity)
                np.testing.assert_array_equal(again.image, state.image)
            np.testing.assert_allclose(on.peculiar_velocity, beside, atol=1e-13)
            with self.assertRaisesRegex(InputError, "expected a scene with \\[shear\\]"):
                Simulation({"initial": {"file": str(file)}})

    def test_observables_are_of_the_lattice_and_beside_the_flow(self):
        observables = ["structure_factor", "time_correlation", "alignment", "profiles"]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "run.h5")
            output = {"file": str(path), "series_every": 0.3, "frames_every": 0.3, "grid": 4,
                      "observables": observables}
            with Simulation({**SCENE, "output": output}) as sim:
                sim.run(time=3)
            with h5py.File(path) as file:
                r, c, u, w = (file[f"particles/needles/{name}/value"][:] for name in (
                    "position", "peculiar_velocity", "orientation", "angular_velocity"))
                a = file["particles/needles/box/edges/value"][:]
                waves, paths, order, profiles = (file[f"series/{name}"] for name in observables)
                # Of each two frames, in the order of ids.
                for lag in (0, 1, 3):
                    products = np.sum(c[lag:] * c[:len(c) - lag], axis=2).mean(axis=1)
                    np.testing.assert_allclose(paths["velocity/value"][lag:, lag], products,
                                               atol=1e-13)
                np.testing.assert_allclose(
                    order["spin_over_rate/value"][:], w[:, :, 2].mean(axis=1) / 1.5, rtol=1e-9)
                for n in range(len(r)):
                    k = np.zeros((3, 16, 3))
                    for axis in range(3):
                        k[axis, :, axis] = waves["k"][axis]
                    k[0, :, 1] = waves["k_y/value"][n]
                    # Whole waves along the vectors of the lattice.
                    whole = k @ a[n].T / (2 * np.pi)
                    np.testing.assert_allclose(whole, np.round(whole), atol=1e-12)
                    s = np.abs(np.exp(1j * k @ r[n].T).sum(axis=2))**2 / 60
                    np.testing.assert_allclose(waves["s/value"][n], s, atol=1e-10)
                    q = (3 * u[n].T @ u[n] / 60 - np.eye(3)) / 2
                    angle = np.arctan2(2 * q[0, 1], q[0, 0] - q[1, 1]) / 2
                    self.assertAlmostEqual(order["flow_angle/value"][n], angle, places=10)
                    slab = np.floor(r[n, :, 1]).astype(int)
                    flow = [c[n, slab == y].sum(axis=0) / max(1, (slab == y).sum())
                            for y in range(4)]
                    np.testing.assert_allclose(profiles["flow/value"][n, 1], flow, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
