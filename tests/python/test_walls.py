"""Hits on walls: in callbacks, totals and files."""

import tempfile
import unittest
from pathlib import Path

import needlework
import numpy as np
from needlework import Simulation

WALLED = {"needles": {"count": 80, "box": 5.0, "seed": 3},
          "walls": [{"axis": "z", "side": "both"}, {"axis": "x", "side": "low"}],
          "forces": {"gravity": [-0.5, 0, 0]}}


class Walls(unittest.TestCase):
    def test_hits_are_reported_counted_and_recorded(self):
        batches, collisions = [], []
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "run.h5")
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


if __name__ == "__main__":
    unittest.main()
