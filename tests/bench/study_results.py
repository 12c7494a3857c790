#!/usr/bin/python3
"""bench/measured.py and bench/study.py keep rounds, and what they write is what was measured.

    tests/bench/study_results.py PROGRAM
"""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock
from xml.etree import ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
import measured  # noqa: E402
import study  # noqa: E402

PROGRAM = sys.argv.pop() if len(sys.argv) > 1 else ""
ABOUT = {"commit": "c", "machine": "m", "cores": 2, "compiler": "g", "flags": "f", "version": "0"}


def case(scene, asked, us, baseline=False):
    return {"name": f"{scene}/{asked}/auto/standard/scalar/threads:1", "scene": scene,
            "baseline": baseline, "us_per_collision": [us], "setup_s": [0.1], "density": 0.5,
            "bytes_per_needle": [500.0], "search": "capsules", "warm_up_hash": "0"}


class Rounds(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.store = measured.Store(self.folder, ABOUT)

    def add(self, baseline, other, part="density"):
        self.store.add_round(part, "command", [
            case("n=0.5", "linked-lists", baseline, True), case("n=0.5", "linked-cells", 9.0),
            case("n=0.5", "capsules", 8.0), case("n=0.5", "auto", other)])

    def test_are_kept_until_code_or_build_change(self):
        self.add(30.0, 10.0)
        self.add(33.0, 12.0)
        self.assertEqual(self.store.rounds("density"), 2)
        self.assertEqual(self.store.load("density")["cases"][0]["us_per_collision"], [30.0, 33.0])
        for key in ("commit", "compiler", "machine"):
            other = measured.Store(self.folder, {**ABOUT, key: "other"})
            self.assertEqual(other.rounds("density"), 0)

    def test_of_other_cases_or_trajectories_are_refused(self):
        self.add(30.0, 10.0)
        with self.assertRaisesRegex(ValueError, "expected the cases of the rounds before"):
            self.store.add_round("density", "command", [case("n=1", "auto", 1.0)])
        cases = self.store.load("density")["cases"]
        with self.assertRaisesRegex(ValueError, "the trajectory is not that"):
            self.store.add_round("density", "command",
                                 [{**one, "warm_up_hash": "1"} for one in cases])

    def test_are_measured_in_turn_until_complete_or_out_of_budget(self):
        done = []

        def part(name):
            return lambda: (done.append(name) or name, [case("s", "auto", 1.0)])

        parts = {"a": (2, part("a")), "b": (1, part("b")), "c": (2, part("c"))}
        self.assertEqual(measured.measure_rounds(self.store, parts, 100), [])
        self.assertEqual(done, ["a", "b", "c", "a", "c"])
        measured.measure_rounds(self.store, parts, 100)
        self.assertEqual(len(done), 5)
        parts["d"] = (1, part("d"))
        self.assertEqual(measured.measure_rounds(self.store, parts, -1), ["d"])
        self.assertEqual(len(done), 5)

    def test_become_tables_of_medians_and_ranges_and_a_picture(self):
        for baseline, other in ((30.0, 10.0), (33.0, 12.0), (60.0, 11.0)):
            self.add(baseline, other)
        contents = {"density": self.store.load("density")}
        study.write_results(contents, "m", self.folder)
        text = (self.folder / "README.md").read_text()
        self.assertIn("median (range) of 3 interleaved repetitions; commit c", text)
        self.assertIn("| 33.0 (30.0–60.0) |", text)  # baseline
        self.assertIn("| 11.0 (10.0–12.0) |", text)  # auto
        self.assertIn("| 3.00 (2.75–5.45) |", text)  # times baseline
        picture = (self.folder / "density.svg").read_text()
        ElementTree.fromstring(picture.encode())
        self.assertIn("needles per L³", picture)
        self.assertLess(picture.count("\n"), 300)

    def test_become_a_file_that_the_program_reads(self):
        for baseline, other in ((30.0, 10.0), (33.0, 12.00004), (60.0, 11.0)):
            self.add(baseline, other)
        study.write_results({"density": self.store.load("density")}, "m", self.folder)
        file = self.folder / "density.json"
        self.assertEqual(sum('"name"' in line for line in file.read_text().splitlines()), 4)
        kept = json.loads(file.read_text())
        self.assertEqual(kept["cases"][3].keys(), {"name", "baseline", "us_per_collision"})
        self.assertEqual(kept["cases"][3]["us_per_collision"], [10.0, 12.0, 11.0])
        done = subprocess.run([PROGRAM, "bench", "--results", str(file), "--compare", str(file)],
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"auto/auto/\S+ +11.0 +10.0-12.0 +3.00\n")

    def test_are_tracked_only_when_complete_and_committed(self):
        replaced = mock.patch.object(measured, "BENCH", self.folder)
        replaced.start()
        self.addCleanup(replaced.stop)
        inside = self.folder / "results/machine"
        changed = measured.Store(self.folder, {**ABOUT, "commit": "c with changes"})
        quick = measured.Store(self.folder, ABOUT, quick=True)
        for store, complete in ((self.store, False), (changed, True), (quick, True)):
            self.assertEqual(store.place(inside.name, complete), store.folder / "results")
            self.assertFalse(inside.exists())
        self.assertEqual(self.store.place(inside.name, True), inside)


if __name__ == "__main__":
    unittest.main()
