"""Hits on walls: in callbacks, totals and files."""

import unittest

import needlework
import numpy as np
from needlework import Simulation

from support import InFolder

WALLED = {"needles": {"count": 80, "box": 5.0, "seed": 3},
          "walls": [{"axis": "z", "side": "both"}, {"axis": "x", "side": "low"}],
          "forces": {"gravity": [-0.5, 0, 0]}}


class Walls(InFolder):
    def test_hits_are_reported_counted_and_recorded(self):
        batches, collisions = [], []
        file = self.folder / "run.h5"
        with Simulation({**WALLED, "output": {"file": str(file), "events": True}}) as sim:
            sim.on_happenings(batches.append, 100, states=True)
            sim.on_collisions(collisions.append, 100)
            sim.run(time=3)
            totals, walls = sim.totals, sim.wall_totals
        rows = np.concatenate(batches)
        with needlework.read(file) as recording:
            events = recording.events[:]
            np.testing.assert_array_equal(recording.events["kind"], rows["kind"])
            for name in events.dtype.names:
                np.testing.assert_array_equal(events[name], rows[name])
            table = recording.observable("walls")
            self.assertEqual([wall.hits for wall in walls], list(table.hits[-1]))
        self.assertEqual(rows.dtype, needlework.HAPPENING_WITH_STATES)
        self.assertEqual({needlework.KINDS[kind] for kind in set(rows["kind"])}, {"pair", "wall"})
        self.assertEqual(sum(map(len, collisions)), totals.collisions)
        self.assertEqual(np.sum(rows["kind"] == 0), totals.collisions)
        self.assertEqual([(wall.axis, wall.side) for wall in walls],
                         [("z", "low"), ("z", "high"), ("x", "low")])
        hits = rows[rows["kind"] == 1]
        for index, wall in enumerate(walls):
            mine = hits[hits["pair"][:, 1] == index]
            self.assertEqual(wall.hits, len(mine))
            self.assertGreater(wall.hits, 5)
            self.assertAlmostEqual(wall.impulse, np.sum(np.abs(mine["impulse"])), places=9)
        self.assertTrue(np.all(hits["normal_velocity"] < 0))
        self.assertTrue(np.all(np.abs(hits["arms"][:, 0]) == 0.5))

    def test_there_are_none_without_walls(self):
        self.assertEqual(Simulation({"needles": {"count": 9, "box": 5.0}}).wall_totals, [])


class Order(InFolder):
    def test_order_and_director_of_tensors(self):
        direction = np.array([0.6, 0, 0.8])
        parallel = 1.5 * np.outer(direction, direction) - np.eye(3) / 2
        in_plane = np.diag([0.25, -0.5, 0.25])
        found = needlework.nematic_order([[parallel, in_plane], [np.full((3, 3), np.nan)] * 2])
        self.assertEqual(found.order.shape, (2, 2))
        np.testing.assert_allclose(found.order[0], [1, 0.25])
        np.testing.assert_allclose(found.eigenvalues[0], [[1, -0.5, -0.5], [0.25, 0.25, -0.5]])
        self.assertAlmostEqual(abs(found.director[0, 0] @ direction), 1)
        self.assertTrue(np.isnan(found.order[1]).all() and np.isnan(found.director[1]).all())
        for bad in (np.eye(2), 3, "x"):
            with self.assertRaises(needlework.InputError):
                needlework.nematic_order(bad)

    def test_directors_lie_along_near_walls(self):
        file = self.folder / "run.h5"
        scene = {"needles": {"count": 2000, "box": [9, 9, 2]}, "walls": WALLED["walls"][:1],
                 "output": {"file": str(file), "observables": ["wall_profiles"]}}
        with Simulation(scene) as sim:
            sim.run(time=0)
        with needlework.read(file) as recording:
            rows = recording.observable("wall_profiles")
            tensor, p2 = rows.order_tensor[0, 0], rows.p2[0, 0]
        self.assertEqual(tensor.shape, (16, 3, 3))
        np.testing.assert_allclose(tensor[:, 2, 2], p2, atol=1e-12)
        found = needlework.nematic_order(tensor)
        # (x^2 - 1)/2 with x from 0 to 1/4 across, half of that in the plane.
        for slab in (0, 15):
            self.assertAlmostEqual(found.eigenvalues[slab, 2], -0.49, delta=0.02)
            self.assertLess(abs(found.director[slab, 2]), 0.1)
            self.assertGreater(found.order[slab], 0.2)


PISTONS = {"walls": [{"axis": "z", "side": "low", "motion": {"velocity": 0.5}},
                     {"axis": "z", "side": "high", "motion": {"velocity": -0.25, "stop_at": 4.75}}]}


class Pistons(InFolder):
    def start(self, **sections):
        return Simulation({"needles": {"count": 80, "box": 5.0}, **PISTONS, **sections})

    def test_the_box_is_where_they_are(self):
        sim = self.start()
        self.assertEqual((list(sim.box), list(sim.low)), ([5, 5, 5], [0, 0, 0]))
        sim.run(time=2)
        self.assertEqual((list(sim.box), list(sim.low)), ([5, 5, 3.75], [0, 0, 1]))
        self.assertEqual(list(sim.gas.box), [5, 5, 3.75])
        self.assertEqual([wall.place for wall in sim.wall_totals], [1, 4.75])
        self.assertTrue(np.all((sim.position[:, 2] >= 1) & (sim.position[:, 2] <= 4.75)))
        resting = Simulation({"needles": {"count": 9, "box": 5.0}})
        self.assertEqual(list(resting.low), [0, 0, 0])
        self.assertFalse({"box", "low"} & set(resting.state.keys()))

    def test_a_state_starts_where_they_are(self):
        sim = self.start()
        sim.run(time=2)
        closing = {"walls": [{"axis": "z", "side": "both", "motion": {"velocity": 0}}]}
        other = Simulation(closing, **sim.state)
        self.assertEqual((list(other.box), list(other.low)), ([5, 5, 3.75], [0, 0, 0]))
        np.testing.assert_array_equal(other.position, sim.position - [0, 0, 1])
        np.testing.assert_array_equal(other.velocity, sim.velocity)
        with self.assertRaisesRegex(needlework.InputError, "needles.box"):
            Simulation({"needles": {"box": 5.0}, **closing}, **sim.state)
        with self.assertRaisesRegex(needlework.InputError, "low: shape"):
            Simulation(closing, **{**sim.state, "low": [1, 2]})
        with self.assertRaisesRegex(needlework.InputError, "box is missing"):
            Simulation(closing, **{**sim.state, "box": None})

    def test_frames_say_where_they_are(self):
        file = self.folder / "run.h5"
        with self.start(output={"file": str(file), "frames": [1.0]}) as sim:
            sim.run(time=2)
            last = sim.state
        with needlework.read(file) as run:
            self.assertEqual([list(frame.low) for frame in run.frames],
                             [[0, 0, 0], [0, 0, 0.5], [0, 0, 1]])
            self.assertEqual([frame.box[2] for frame in run.frames], [5, 4.25, 3.75])
            state = run.frames[-1].state
            for name in ("position", "box", "low"):
                np.testing.assert_array_equal(state[name], last[name])
            other = Simulation({"walls": WALLED["walls"][:1]}, **state)
            np.testing.assert_array_equal(other.position, last.position - [0, 0, 1])

    def test_walls_meet(self):
        sim = self.start()
        self.assertEqual(sim.run(collisions_per_needle=1e9), "walls_meet")
        self.assertAlmostEqual(sim.box[2], 1)


# A needle on end that bounces on a floor in motion and hits it at its highest, where it is at rest:
# its height is known at each phase.
AMPLITUDE = 0.005
BOUNCING = {"needles": {"count": 1, "box": 3.0},
            "walls": [{"axis": "z", "side": "low",
                       "motion": {"amplitude": AMPLITUDE, "frequency": 1, "phase": -np.pi / 2}}],
            "forces": {"gravity": [0, 0, -1]},
            "output": {"observables": ["centre_of_mass", "wall_profiles"], "series_every": 1 / 16}}
START = {"position": [[1, 1, 0.5 + AMPLITUDE + 1 / 8]], "velocity": [[0, 0, 0]],
         "orientation": [[0, 0, 1]], "angular_velocity": [[0, 0, 0]]}


class Phases(InFolder):
    def test_means_by_phase_are_those_of_a_periodic_orbit(self):
        file = self.folder / "run.h5"
        scene = {**BOUNCING, "output": {**BOUNCING["output"], "file": str(file)}}
        with Simulation(scene, **START) as sim:
            sim.run(time=2.5)
            sim.checkpoint()
        with Simulation.resume(file) as sim:
            sim.run(time=10)
            hits, = sim.wall_totals
            self.assertEqual(hits.hits, 10)
            self.assertAlmostEqual(hits.phase, 3 * np.pi / 2, places=12)
            self.assertAlmostEqual(hits.pressure, 10 * 1 / (9 * 10), places=12)
        with needlework.read(file) as recording:
            height = recording.observable("centre_of_mass").position[:, 0]
            folded = recording.by_phase(height)
            late = recording.by_phase(height, bins=4, since=9)
            profiles = recording.observable("wall_profiles")
            slabs = recording.by_phase(profiles.t_normal[:, 0], weights=profiles.density[:, 0])
            pressure = recording.observable("walls").pressure[:, 0]
            for arguments in ({"values": height[1:]}, {"values": height, "bins": 0},
                              {"values": height, "wall": 1},
                              {"values": height, "weights": [1, 2]}):
                with self.assertRaises(needlework.InputError):
                    recording.by_phase(**arguments)
        np.testing.assert_allclose(folded.phase, np.arange(16) * np.pi / 8)
        self.assertEqual(folded.samples.sum(), 161)
        self.assertEqual(sorted(folded.samples), [10] * 15 + [11])
        turns = (folded.phase / (2 * np.pi) - 0.25) % 1  # since the hit
        np.testing.assert_allclose(folded.mean, 0.5 + AMPLITUDE + turns * (1 - turns) / 2,
                                   atol=1e-9)
        self.assertEqual(late.samples.sum(), 17)
        # Twice the mean energy of the motion along the axis, (1/2 - turns)^2, in one slab each.
        found = np.nansum(slabs.mean, axis=1)
        apart = np.abs(turns - 0.5) > 1e-3
        self.assertEqual(slabs.mean.shape, (16, len(profiles.position[0])))
        self.assertTrue(np.all(np.isclose(found, (0.5 - turns) ** 2) | ~apart), found)
        # A hit turns the momentum 1/2 around; each is in one interval of 1/16.
        self.assertTrue(np.isnan(pressure[0]))
        self.assertEqual(np.sum(pressure[1:] > 0), 10)
        np.testing.assert_allclose(np.sum(pressure[1:]) / 16, 10 * 1 / 9)

    def test_walls_at_rest_have_no_phase(self):
        file = self.folder / "run.h5"
        with Simulation({**WALLED, "output": {"file": str(file)}}) as sim:
            self.assertTrue(np.isnan(sim.wall_totals[0].phase))
            sim.run(time=0.1)
        with needlework.read(file) as recording:
            with self.assertRaises(needlework.InputError):
                recording.by_phase(recording.series.t_tr)


class Budget(InFolder):
    def test_is_the_change_of_the_energy_at_each_sample(self):
        file = self.folder / "run.h5"
        scene = {"needles": {"count": 80, "box": 5.0, "seed": 3},
                 "collisions": {"epsilon": 0.8, "tc_relative": 1e-3},
                 "walls": [{"axis": "z", "side": "low", "epsilon": 0.9, "motion": {
                                "amplitude": 0.1, "frequency": 2}},
                           {"axis": "x", "side": "both", "temperature": 2.0}],
                 "driving": {"kicks": {"every": 0.1, "translational": 1, "rotational": 1}},
                 "forces": {"gravity": [0, 0, -2]}, "output": {"file": str(file)}}
        with Simulation(scene) as sim:
            sim.run(time=1)
            sim.set_velocities(2 * sim.velocity, sim.angular_velocity)
            sim.checkpoint()
        with Simulation.resume(file) as sim:
            sim.run(time=3)
            budget, energy = sim.energy_budget, sim.totals.energy
        with needlework.read(file) as recording:
            series, rows = recording.series, recording.observable("energy_budget")
        self.assertEqual(set(budget), {"pairs", "walls", "kicks", "velocities_set"})
        self.assertEqual(len(budget.walls), 3)
        self.assertGreater(budget.velocities_set, 1)
        self.assertLess(budget.pairs, -1)
        self.assertAlmostEqual(budget.total, energy - series.energy[0], places=11)
        total = sum(rows[name].reshape(series.rows, -1).sum(axis=1) for name in rows)
        np.testing.assert_allclose(total, series.energy - series.energy[0], atol=2e-11)
        for name in budget:
            np.testing.assert_array_equal(budget[name], rows[name][-1])

    def test_has_pairs_alone_in_a_gas_without_effects(self):
        with Simulation({"needles": {"count": 60, "box": 4.0},
                         "collisions": {"epsilon": 0.8, "tc_relative": 1e-3}}) as sim:
            start = sim.totals.energy
            sim.run(time=2)
            self.assertAlmostEqual(sim.energy_budget.pairs, sim.totals.energy - start, places=12)
            self.assertEqual(set(sim.energy_budget), {"pairs", "velocities_set"})


if __name__ == "__main__":
    unittest.main()
