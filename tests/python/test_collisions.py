"""Callbacks: every collision once and in order, and what happens when they fail."""

import gc
import unittest
import warnings
import weakref

import needlework
import numpy as np
from needlework import Simulation

from support import ELASTIC, GAS, InFolder, gas


def batches_of(scene, batch, **options):
    batches = []
    sim = Simulation(scene)
    sim.on_collisions(batches.append, batch, **options)
    sim.run(collisions_per_needle=20)
    return sim, batches


class Batches(InFolder):
    def test_hold_every_collision_once_and_in_order(self):
        file = self.folder / "run.h5"
        with Simulation(gas(output={"file": str(file), "events": True})) as sim:
            sim.run()
        with needlework.read(file) as recording:
            expected = recording.events[:]
        for batch in (1, 7, 1024, 10**6):
            sim, batches = batches_of(GAS, batch)
            self.assertTrue(all(len(rows) == batch for rows in batches[:-1]))
            rows = np.concatenate(batches)
            self.assertEqual(len(rows), sim.totals.collisions)
            for name in expected.dtype.names:
                np.testing.assert_array_equal(rows[name], expected[name])

    def test_pieces_pass_on_what_is_left(self):
        batches = []
        sim = Simulation(GAS)
        sim.on_collisions(batches.append, 30)
        for done in (100, 200, 300):
            sim.advance(collisions=100)
            self.assertEqual(sum(map(len, batches)), done)

    def test_rows_have_the_documented_type(self):
        _, batches = batches_of(GAS, 100)
        self.assertEqual(batches[0].dtype, needlework.COLLISION)
        _, batches = batches_of(GAS, 100, states=True)
        self.assertEqual(batches[0].dtype, needlework.COLLISION_WITH_STATES)
        self.assertEqual(batches[0]["after"]["velocity"].shape, (100, 2, 3))

    def test_rows_obey_the_physics(self):
        sim, batches = batches_of(GAS, 100, states=True)
        rows = np.concatenate(batches)
        self.assertTrue(np.all(np.diff(rows["time"]) >= 0))
        self.assertTrue(np.all(rows["pair"][:, 0] < rows["pair"][:, 1]))
        self.assertTrue(np.all(np.abs(rows["arms"]) <= 0.5))
        # The impulse is along the normal, and the loss of energy is that of its velocity.
        cross = np.cross(*np.moveaxis(rows["after"]["orientation"], 1, 0))
        np.testing.assert_allclose(np.linalg.norm(cross, axis=1), rows["sin_angle"], rtol=1e-9)
        normal = cross / rows["sin_angle"][:, None]
        size = np.linalg.norm(rows["impulse"], axis=1)
        np.testing.assert_allclose(np.abs(np.sum(rows["impulse"] * normal, axis=1)), size,
                                   rtol=1e-9)
        loss = np.where(rows["tc"], 0, (1 - 0.8) / 2 * size * np.abs(rows["normal_velocity"]))
        np.testing.assert_allclose(rows["energy_change"], -loss, rtol=1e-6, atol=1e-12)
        total = 200 * 2.5 + np.sum(rows["energy_change"])
        self.assertAlmostEqual(total, 200 * sim.totals.energy, places=9)

    def test_all_that_happens_are_collisions_in_a_gas_without_walls(self):
        collisions, happenings = [], []
        sim = Simulation(GAS)
        sim.on_collisions(collisions.append, 100, states=True)
        sim.on_happenings(happenings.append, 30, states=True)
        sim.run(collisions_per_needle=5)
        expected, rows = np.concatenate(collisions), np.concatenate(happenings)
        self.assertEqual(rows.dtype, needlework.HAPPENING_WITH_STATES)
        self.assertTrue(np.all(rows["kind"] == 0))
        for name in expected.dtype.names:
            np.testing.assert_array_equal(rows[name], expected[name])
        sim.on_happenings(None)
        sim.advance(collisions=50)
        self.assertEqual(len(np.concatenate(happenings)) + 50, len(np.concatenate(collisions)))

    def test_threads_see_the_same_collisions(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of fewer cores than threads
            rows = [np.concatenate(batches_of(gas(engine={"threads": threads}), 100)[1])
                    for threads in (1, 2)]
        np.testing.assert_array_equal(rows[0], rows[1])

    def test_none_ends_it(self):
        batches = []
        sim = Simulation(GAS)
        sim.on_collisions(batches.append, 10)
        sim.advance(collisions=50)
        sim.on_collisions(None)
        sim.advance(collisions=50)
        self.assertEqual(sum(map(len, batches)), 50)

    def test_callbacks_belong_to_no_trajectory(self):
        sim, _ = batches_of(GAS, 10)
        plain = Simulation(GAS)
        plain.run()
        self.assertEqual(sim.hash, plain.hash)


class Failures(InFolder):
    def test_an_exception_stops_the_advance_and_nothing_is_lost(self):
        class Broken(Exception):
            pass

        def callback(rows):
            batches.append(rows)
            if len(batches) == 3:
                raise Broken("third batch")

        batches = []
        sim = Simulation(GAS)
        sim.on_collisions(callback, 50)
        with self.assertRaisesRegex(Broken, "third batch"):
            sim.run()
        self.assertLess(sim.totals.collisions, 1000)
        self.assertEqual(sim.run(), "collisions")
        plain, expected = batches_of(GAS, 50)
        self.assertEqual(sim.hash, plain.hash)
        np.testing.assert_array_equal(np.concatenate(batches), np.concatenate(expected))

    def test_a_callback_cannot_use_the_simulation_but_may_interrupt_it(self):
        def callback(rows):
            seen.append(len(rows))
            with self.assertRaisesRegex(needlework.Error, "is running"):
                sim.position
            with self.assertRaisesRegex(needlework.Error, "is running"):
                sim.advance(time=1)
            sim.interrupt()

        seen = []
        sim = Simulation(ELASTIC)
        sim.on_collisions(callback, 10)
        self.assertEqual(sim.run(time=1e9), "interrupted")
        self.assertGreaterEqual(len(seen), 1)

    def test_a_callback_that_knows_its_simulation_does_not_keep_it(self):
        sim = Simulation(gas(output={"file": str(self.folder / "run.h5")}))
        sim.on_collisions(lambda rows, its=sim: its.interrupt(), 1)
        gone = weakref.ref(sim)
        self.assertEqual(sim.run(), "interrupted")
        del sim
        gc.collect()
        self.assertIsNone(gone())
        Simulation(gas(output={"file": str(self.folder / "run.h5")}), force=True).close()

    def test_wrong_arguments_are_named(self):
        sim = Simulation(GAS)
        for arguments, message in (((5,), "callback = 5: expected a function"),
                                   ((print, 0), "batch = 0: expected a whole number, 1 or more"),
                                   ((print, 1.5), "batch = 1.5: expected a whole number")):
            with self.assertRaisesRegex(needlework.InputError, message):
                sim.on_collisions(*arguments)


if __name__ == "__main__":
    unittest.main()
