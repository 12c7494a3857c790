"""Simulations: limits, states, velocities, and the same trajectory as the program."""

import enum
import json
import threading
import unittest
import warnings
from pathlib import Path

import needlework
import numpy as np
from needlework import Simulation

from support import ELASTIC, GAS, InFolder, gas, printed_by

PROFILES = Path(__file__).resolve().parents[2] / "profiles"
TOML = """
title = "Cooling needles"
needles = { count = 200, box = 6.0, seed = 3 }
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
until.collisions_per_needle = 20
"""


def run_program(*arguments):
    return json.loads(printed_by("run", *arguments, "--json", "--quiet"))


class SameAsTheProgram(InFolder):
    def test_hash_of_the_quickstart_is_that_of_the_program(self):
        scene = PROFILES / "quickstart.toml"
        sim = Simulation(scene)
        self.assertEqual(sim.run(), "energy")
        expected = run_program(scene)
        self.assertEqual(sim.hash, expected["trajectory_hash"])
        self.assertEqual(sim.totals.collisions, expected["collisions"])
        self.assertEqual(sim.time, expected["time"])
        self.assertEqual(sim.totals.energy, expected["energy"])

    def test_dictionary_text_and_path_are_the_same_scene(self):
        path = self.folder / "gas.toml"
        path.write_text(TOML)
        hashes = []
        for scene in (GAS, TOML, path, str(path)):
            sim = Simulation(scene)
            self.assertEqual(sim.run(), "collisions")
            hashes.append(sim.hash)
        self.assertEqual(len(set(hashes)), 1)

    def test_file_is_that_of_the_program(self):
        import h5py
        ours, its = self.folder / "ours.h5", self.folder / "its.h5"
        scene = self.folder / "gas.toml"
        scene.write_text(TOML + "output = { events = true, frames = 5 }\n")
        run_program(scene, "--out", its)
        with Simulation(gas(output={"events": True, "frames": 5, "file": str(ours)})) as sim:
            for _ in range(9):
                sim.advance(collisions=77)
                sim.position  # looking on changes nothing
            sim.run()
        with h5py.File(ours) as a, h5py.File(its) as b:
            names = []
            b.visititems(lambda name, item: names.append(name)
                         if isinstance(item, h5py.Dataset) else None)
            for name in names:
                if name != "parameters/scene":
                    np.testing.assert_array_equal(a[name][()], b[name][()], err_msg=name)
        self.assertGreater(len(names), 30)


class Limits(unittest.TestCase):
    def test_limits_of_run_count_from_the_start(self):
        sim = Simulation(ELASTIC)
        self.assertEqual(sim.run(time=1), "time")
        self.assertEqual(sim.run(time=2.5), "time")
        self.assertEqual(sim.time, 2.5)
        self.assertEqual(sim.run(collisions_per_needle=10), "collisions")
        self.assertEqual(sim.totals.collisions, 1000)
        for limit, expected in ((1010, 1010), (5, 1010)):
            self.assertEqual(sim.run(collisions=limit), "collisions")
            self.assertEqual(sim.totals.collisions, expected)

    def test_limits_are_numbers_of_any_kind(self):
        class Count(enum.IntEnum):
            FEW = 30

        sim = Simulation(ELASTIC)
        for collisions, time in ((Count.FEW, None), (np.float32(60), np.longdouble(1e9)),
                                 (np.int16(90), np.float32(1e9)), (np.longdouble(120), Count.FEW),
                                 (1.5e2, 1e9)):
            sim.run(collisions=collisions, time=time)
            self.assertEqual(sim.totals.collisions, int(collisions))
        for wrong in (np.bool_(True), np.float32(0.5), "3", float("inf")):
            with self.assertRaisesRegex(needlework.InputError, "collisions = .*whole number"):
                sim.run(collisions=wrong)

    def test_limits_of_advance_count_from_now(self):
        sim = Simulation(GAS)
        for expected in (300, 600, 900):
            self.assertEqual(sim.advance(collisions=300), "collisions")
            self.assertEqual(sim.totals.collisions, expected)
        sim.advance(collisions=1e2)
        self.assertEqual(sim.totals.collisions, 1000)
        time, energy = sim.time, sim.totals.energy
        self.assertEqual(sim.advance(time=0.5), "time")
        self.assertAlmostEqual(sim.time, time + 0.5, places=12)
        energy = sim.totals.energy
        self.assertEqual(sim.advance(energy_ratio=0.5), "energy")
        self.assertLessEqual(sim.totals.energy, 0.5 * energy)
        self.assertGreater(sim.totals.energy, 0.49 * energy)

    def test_wall_time_ends_a_run(self):
        sim = Simulation(ELASTIC)
        self.assertEqual(sim.run(time=1e9, wall_s=0.01), "wall_time")
        self.assertEqual(sim.run(time=sim.time), "time")

    def test_a_gas_at_rest_says_that_nothing_can_happen(self):
        rest = gas(initial={"t_tr": 0, "t_rot": 0})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertEqual(Simulation(rest).run(), "nothing_can_happen")

    def test_interrupt_before_a_run_stops_it(self):
        sim = Simulation(GAS)
        sim.interrupt()
        self.assertEqual(sim.run(), "interrupted")
        self.assertEqual(sim.totals.collisions, 0)
        self.assertEqual(sim.run(), "collisions")

    def test_interrupt_by_another_thread_stops_a_run(self):
        sim = Simulation(ELASTIC)
        timer = threading.Timer(0.2, sim.interrupt)
        timer.start()
        self.assertEqual(sim.run(time=1e12, wall_s=100), "interrupted")
        timer.join()


class State(InFolder):
    def test_a_state_is_taken_as_it_is(self):
        first = Simulation(GAS)
        first.run()
        scene = gas(needles={"count": None})
        sim = Simulation(scene, position=first.position, velocity=first.velocity,
                         orientation=first.orientation, angular_velocity=first.angular_velocity)
        self.assertEqual(len(sim), 200)
        for name in ("position", "velocity"):
            np.testing.assert_array_equal(getattr(sim, name), getattr(first, name))
        for name in ("orientation", "angular_velocity"):  # normalised, projected
            np.testing.assert_allclose(getattr(sim, name), getattr(first, name), rtol=1e-12)
        np.testing.assert_array_equal(sim.id, np.arange(200))
        self.assertEqual(sim.run(), "collisions")

    def test_a_state_is_handed_over_with_ids_and_images(self):
        ids = np.random.default_rng(1).permutation(1000)[:200] + 2**32 - 1000
        drawn = Simulation(GAS).state
        first = Simulation(gas(needles={"count": None}),
                           **{**drawn, "id": ids, "image": np.arange(600).reshape(200, 3) - 300})
        order = np.argsort(ids)
        np.testing.assert_array_equal(first.id, ids[order])
        np.testing.assert_array_equal(first.image, drawn.image[order] + 3 * order[:, None]
                                      + np.arange(3) - 300)
        first.advance(collisions=2000)
        self.assertTrue(np.any(first.image != Simulation(GAS).image))
        again = Simulation(gas(needles={"count": None}), **first.state)
        self.assertEqual(list(again.state), list(first.state))
        for name in ("id", "image", "position", "velocity"):
            np.testing.assert_array_equal(again.state[name], first.state[name])
        for name in ("orientation", "angular_velocity"):  # normalised, projected
            np.testing.assert_allclose(again.state[name], first.state[name], rtol=1e-12,
                                       atol=1e-15)

    def test_displacements_go_on_in_a_simulation_of_a_state(self):
        elastic = {"needles": {"box": 6.0}}
        whole = Simulation(ELASTIC)
        whole.advance(time=5)
        part = Simulation(elastic, **whole.state)
        for sim in (whole, part):
            sim.advance(time=0.5)
        self.assertGreater(part.totals.collisions, 10)
        self.assertTrue(np.any(part.image != 0))
        np.testing.assert_allclose(part.position + part.image * part.box,
                                   whole.position + whole.image * whole.box, rtol=0, atol=1e-9)

    def test_positions_beyond_the_box_count_on_from_their_images(self):
        for image in ([[4, 0, -2]], [[4.0, 0.0, -2.0]]):
            sim = Simulation({"needles": {"box": 3.0}}, position=[[7, 1, -1]],
                             orientation=[[0, 0, 1]], image=image)
            np.testing.assert_array_equal(sim.position, [[1, 1, 2]])
            np.testing.assert_array_equal(sim.image, [[6, 0, -3]])

    def test_shapes_and_types(self):
        sim = Simulation(GAS)
        for name in ("position", "velocity", "orientation", "angular_velocity"):
            self.assertEqual((getattr(sim, name).shape, getattr(sim, name).dtype),
                             ((200, 3), np.float64))
        self.assertEqual((sim.image.shape, sim.image.dtype), ((200, 3), np.int32))
        self.assertEqual((sim.id.shape, sim.id.dtype), ((200,), np.uint32))
        self.assertEqual(sim.totals.momentum.shape, (3,))
        np.testing.assert_array_equal(sim.box, [6, 6, 6])

    def test_snapshots_stay_valid_and_cannot_be_written(self):
        sim = Simulation(GAS)
        first = sim.position
        copy = first.copy()
        self.assertIs(sim.position, first)
        sim.advance(collisions=500)
        self.assertFalse(np.array_equal(sim.position, copy))
        velocity = sim.velocity
        kept = velocity.copy()
        for array in (sim.box, sim.gas.box, sim.state.bodies.length, sim.totals.momentum, sim.mass):
            with self.assertRaises(ValueError):
                array[0] = 3
        del sim
        np.testing.assert_array_equal(first, copy)
        np.testing.assert_array_equal(velocity, kept)
        for array in (first, velocity):
            self.assertTrue(array.flags.owndata)
            with self.assertRaises(ValueError):
                array[0] = 0

    def test_a_saved_state_is_an_initial_file(self):
        first = Simulation(GAS)
        first.run()
        path = self.folder / "state.h5"
        first.save(path)
        with self.assertRaisesRegex(needlework.IoError, "exists already: .* force=True"):
            first.save(path)
        first.save(path, force=True)
        again = Simulation({"initial": {"file": path},
                            "collisions": {"epsilon": 0.8, "tc_relative": 1e-3}})
        np.testing.assert_array_equal(again.position, first.position)
        np.testing.assert_array_equal(again.image, first.image)

    def test_paths_cross_the_boundaries(self):
        # What is not given is at rest.
        sim = Simulation({"needles": {"count": 1, "box": 3.0}}, position=[[1, 1, 1]],
                         velocity=[[2, 0, 0]], orientation=[[0, 0, 1]])
        sim.run(time=10)
        np.testing.assert_allclose(sim.position + sim.image * sim.box, [[21, 1, 1]])

    def test_totals_are_those_of_the_state(self):
        sim = Simulation(GAS)
        sim.run()
        self.assertAlmostEqual(sim.totals.t_tr, np.mean(sim.velocity**2), places=12)
        inertia = 1 / (2 * sim.gas.k)
        self.assertAlmostEqual(sim.totals["t_rot"],
                               inertia * np.mean(np.sum(sim.angular_velocity**2, axis=1)) / 2,
                               places=12)
        self.assertGreater(sim.counters.events, 2000)
        self.assertEqual(sim.engine.effects, "inelastic tc")

    def test_replaced_velocities_are_used(self):
        sim = Simulation(GAS)
        sim.advance(collisions=100)
        before = sim.velocity
        sim.set_velocities(2 * sim.velocity, 2 * sim.angular_velocity)
        np.testing.assert_array_equal(sim.velocity, 2 * before)
        self.assertEqual(sim.totals.collisions, 100)
        sim.advance(collisions=100)

    def test_velocities_alone_stop_all_rotation(self):
        sim = Simulation(GAS)
        with self.assertWarnsRegex(UserWarning, "angular_velocity: not given: .* are 0 now"):
            sim.set_velocities(sim.velocity)
        self.assertEqual(sim.totals.t_rot, 0)

    def test_values_are_read_only_mappings(self):
        totals = Simulation(GAS).totals
        self.assertEqual(dict(totals)["energy"], totals.energy)
        with self.assertRaises(AttributeError):
            totals.energy = 1
        with self.assertRaises(AttributeError):
            totals.enthalpy
        self.assertIn("energy", dir(totals))


class Threads(unittest.TestCase):
    def test_two_simulations_run_in_two_threads(self):
        def run(seed):
            sim = Simulation(gas(needles={"seed": seed}))
            sim.run()
            hashes[seed] = sim.hash

        hashes = {}
        expected = {}
        for seed in (1, 2):
            sim = Simulation(gas(needles={"seed": seed}))
            sim.run()
            expected[seed] = sim.hash
        threads = [threading.Thread(target=run, args=(seed,)) for seed in (1, 2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(hashes, expected)

    def test_a_running_simulation_refuses_other_threads(self):
        sim = Simulation(ELASTIC)
        stops = []
        thread = threading.Thread(target=lambda: stops.append(sim.run(time=1e12, wall_s=100)))
        thread.start()
        while True:  # until it runs
            try:
                sim.time
            except needlework.Error:
                break
        for use in (lambda: sim.position, lambda: sim.totals, lambda: sim.time, lambda: sim.hash,
                    lambda: sim.counters, lambda: sim.run(time=1), lambda: sim.advance(time=1),
                    sim.close, sim.checkpoint, lambda: sim.on_collisions(print),
                    lambda: sim.set_velocities(np.zeros((200, 3)), np.zeros((200, 3)))):
            with self.assertRaisesRegex(needlework.Error, "is running"):
                use()
        sim.interrupt()
        thread.join()
        self.assertEqual(stops, ["interrupted"])


if __name__ == "__main__":
    unittest.main()
