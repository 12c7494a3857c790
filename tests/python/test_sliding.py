"""Contacts of needles that slide on each other, in totals, callbacks and files."""

import unittest

import needlework
import numpy as np
from needlework import Simulation

from support import InFolder


class Sliding(InFolder):
    def test_contacts_are_counted_reported_and_recorded(self):
        batches = []
        file = self.folder / "run.h5"
        with Simulation({"needles": {"count": 100, "box": 5.0},
                         "collisions": {"epsilon": 0.2, "sliding": True},
                         "output": {"file": str(file), "series_every": 0.5}}) as sim:
            sim.on_happenings(batches.append, 100)
            sim.run(time=2)
            contacts = sim.sliding_contacts
        with needlework.read(file) as recording:
            table = recording.observable("contacts")
        kinds = np.concatenate(batches)["kind"]
        self.assertGreater(contacts.entered, 10)
        self.assertEqual(np.sum(kinds == 2), contacts.entered)
        self.assertEqual(np.sum(kinds == 3), contacts.ended_by_force + contacts.ended_by_tip +
                         contacts.ended_by_strike)
        self.assertEqual(table.entered[-1], contacts.entered)
        self.assertEqual(table.time[-1], contacts.time)
        self.assertEqual(table.share[-1], contacts.share)
        self.assertEqual(contacts.share, 2 * contacts.time / (100 * 2))

    def test_there_are_none_without_sliding(self):
        self.assertIsNone(Simulation({"needles": {"count": 9, "box": 5.0}}).sliding_contacts)


if __name__ == "__main__":
    unittest.main()
