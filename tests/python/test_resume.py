"""Runs that go on after their process has ended, and what cannot go on says why."""

import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

import needlework
import numpy as np
from needlework import Simulation

from support import GAS, InFolder, gas, printed_by



def hash_at(collisions):
    sim = Simulation(GAS)
    sim.run(collisions=collisions)
    return sim.hash


class Resume(InFolder):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "gas.h5"

    def scene(self, **output):
        return gas(output={"file": str(self.file), **output})

    def test_a_closed_run_goes_on_with_the_same_trajectory(self):
        with Simulation(self.scene()) as first:
            first.run(collisions=300)
            position = first.position
        with Simulation.resume(self.file) as second:
            self.assertIsInstance(second, Simulation)
            self.assertEqual(second.totals.collisions, 300)
            np.testing.assert_array_equal(second.position, position)
            self.assertEqual(second.file, str(self.file))
            second.run(collisions=500)  # from the start of the run
            self.assertEqual(second.hash, hash_at(500))
            self.assertEqual(second.run(), "collisions")  # as [until] says
            self.assertEqual(second.hash, hash_at(2000))

    def test_a_killed_run_goes_on_from_its_checkpoint(self):
        program = ("import json, os, sys, needlework\n"
                   "sim = needlework.Simulation(json.loads(sys.argv[1]))\n"
                   "sim.run(collisions=300)\n"
                   "sim.checkpoint()\n"
                   "sim.run(collisions=400)\n"
                   "os.kill(os.getpid(), 9)\n")
        killed = subprocess.run([sys.executable, "-c", program, json.dumps(self.scene())])
        self.assertEqual(killed.returncode, -9)
        sim = Simulation.resume(str(self.file))
        self.assertEqual(sim.totals.collisions, 300)
        sim.run(collisions=500)
        self.assertEqual(sim.hash, hash_at(500))

    def test_collisions_after_the_checkpoint_are_passed_on(self):
        with Simulation(self.scene()) as first:
            first.run(collisions=300)
        with Simulation.resume(self.file) as second:
            seen = []
            second.on_collisions(lambda rows: seen.extend(rows["time"]))
            second.advance(collisions=20)
        self.assertEqual(len(seen), 20)

    def test_the_program_continues_a_run_of_python(self):
        with Simulation(self.scene()) as first:
            first.run(collisions=300)
        printed = printed_by("resume", self.file, "--json", "--quiet")
        self.assertEqual(json.loads(printed)["trajectory_hash"], hash_at(2000))

    def test_a_damaged_checkpoint_is_passed_over_with_a_warning(self):
        sim = Simulation(self.scene())
        for collisions in (100, 200):
            sim.run(collisions=collisions)
            sim.checkpoint()
        sim.close()  # the third, so that the one before is of 200
        newest = Path(f"{self.file}.checkpoint")
        newest.write_bytes(newest.read_bytes()[:1000])
        with self.assertWarnsRegex(RuntimeWarning, "damaged"):
            again = Simulation.resume(self.file)
        self.assertEqual(again.totals.collisions, 200)

    def test_what_cannot_be_continued_says_why(self):
        with self.assertRaisesRegex(needlework.IoError, "No such file or directory"):
            Simulation.resume(self.file)
        with Simulation(self.scene()) as writes:
            writes.run(collisions=10)
            with self.assertRaisesRegex(needlework.IoError, "open for writing"):
                Simulation.resume(self.file)
        self.file.unlink()
        with self.assertRaisesRegex(needlework.IoError, "gas.h5"):
            Simulation.resume(self.file)

    def test_what_cannot_be_saved_says_why(self):
        with self.assertRaisesRegex(needlework.Error, "has no output file, .*: expected output.fi"):
            Simulation(GAS).checkpoint()
        with Simulation(self.scene(checkpoint_every=0)) as off:
            with self.assertRaisesRegex(needlework.Error, "checkpoint_every = 0: turns"):
                off.checkpoint()
        with Simulation(self.scene(), force=True) as closed:
            pass
        with self.assertRaisesRegex(needlework.Error, "is closed: expected"):
            closed.checkpoint()


if __name__ == "__main__":
    unittest.main()
