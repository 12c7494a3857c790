"""Simulations of the Boltzmann equation beside runs: which are asked for, kept and asked again."""

import json
import unittest
from pathlib import Path

import small_paper
from support import InFolder, require, script

require("matplotlib", "h5py")
import numpy as np  # noqa: E402
from needlework import InputError  # noqa: E402
from needlework.reproduce import PaperRuns  # noqa: E402
from needlework.reproduce.equation import (ENCOUNTERS, SINGLE, questions, solutions,  # noqa: E402
                                           times)
from needlework.reproduce.liquid import correlations, transport  # noqa: E402
from needlework.reproduce.runs import Conditions, FinishedRun  # noqa: E402
from needlework.reproduce.sweeps import STOPPED, run_set  # noqa: E402


class Equation(InFolder):
    SET = "boltzmann-encounters"

    def setUp(self):
        super().setUp()
        self.paper = small_paper.write(self.folder / "paper")
        self.runs = PaperRuns(self.folder / "out", "full", self.paper)

    def solve(self, program=small_paper.PROGRAM):
        return run_set(self.runs, self.SET, str(program), quiet=True)

    def answered(self):
        return [question.is_answered for question in questions(self.runs, self.SET)]

    def change(self, file, old, new):
        text = (self.paper / file).read_text()
        self.assertIn(old, text)
        (self.paper / file).write_text(text.replace(old, new))

    def test_is_solved_once(self):
        with self.assertRaisesRegex(InputError, "encounters,k=2,seed=1.json: expected the answer "
                                                "to needlework theory --boltzmann encounters"):
            solutions(self.runs, self.SET, ENCOUNTERS)[0].first.tau
        self.assertEqual(self.solve(), 0)
        self.assertEqual(self.answered(), [True] * 6)
        written = {file: file.stat().st_mtime_ns
                   for file in self.runs.folder_of(self.SET).glob("*.json")}
        self.assertEqual((len(written), self.solve()), (6, 0))
        self.assertEqual({file: file.stat().st_mtime_ns for file in written}, written)
        two, six = solutions(self.runs, self.SET, ENCOUNTERS)
        self.assertEqual([two.conditions.k, six.conditions.k], [2, 6])
        self.assertEqual([run.seed for run in six.runs], [1, 2, 3])
        self.assertEqual(six.first.tau.tolist(), [0, 1])
        np.testing.assert_allclose(six.first.energy, 2.5)
        self.assertEqual(solutions(self.runs, self.SET, SINGLE), [])

    def test_is_asked_again_where_the_question_is_another(self):
        self.assertEqual(self.solve(), 0)
        self.change("full/boltzmann-encounters.toml", "seeds = [1, 2, 3]", "seeds = [2, 3, 4]")
        self.assertEqual(self.answered(), [True, True, False] * 2)
        self.change("full/boltzmann-encounters.toml", "needles = 4000", "needles = 4001")
        self.assertEqual(self.answered(), [False] * 6)
        self.change("full/boltzmann-encounters.toml", "needles = 4001", "needles = 4000")
        self.change("elastic.toml", "box = 24.0", "box = 25.0")
        self.assertEqual(self.answered(), [False] * 6)
        damaged = questions(self.runs, self.SET)[0].path
        for text in ("", "{", "[]", "{}", '{"answer": {}}'):
            damaged.write_text(text)
            self.assertEqual(self.answered(), [False] * 6, text)

    def test_keeps_what_is_solved_before_it_is_stopped(self):
        stopping = script(self.folder / "stopping",
                          'case "$*" in *"--seed 3"*) kill -TERM $$;; esac\n'
                          f'exec "{small_paper.PROGRAM}" "$@"\n')
        self.assertEqual(self.solve(stopping), STOPPED)
        self.assertEqual(self.answered(), [True, True, False, False, False, False])
        self.assertEqual(self.solve(), 0)
        self.assertEqual(self.answered(), [True] * 6)
        refusing = script(self.folder / "refusing", "echo no JSON\n")
        questions(self.runs, self.SET)[0].path.unlink()
        with self.assertRaisesRegex(InputError, "expected JSON of the program"):
            self.solve(refusing)

    def test_has_times_at_equal_steps_or_per_decade(self):
        self.assertEqual(times({"first": 0.5, "last": 2, "step": 0.5}), [0, 0.5, 1, 1.5, 2])
        np.testing.assert_allclose(times({"first": 1, "last": 100, "per_decade": 1}),
                                   [0, 1, 10, 100])


class KnownRun(FinishedRun):
    """One whose needles move and turn in a known way, at n L^3 = 1 or 64."""

    def observable(self, name, field):
        lag = 0.01 * np.array([0, 1, 2, 3, 4, 5, 6, 7, 8, *(s * 2**n for n in range(1, 10)
                                                            for s in (5, 6, 7, 8))])
        values = {"lag": lag, "parallel": 6 * lag, "perpendicular": 6 * lag,
                  "velocity": 3 * np.exp(-lag / 2), "velocity_parallel": np.exp(-lag / 20),
                  "velocity_perpendicular": 2 * np.exp(-2 * lag), "angular_velocity":
                  24 * np.exp(-4 * lag), "p1": np.exp(-2 * 0.1 * lag), "p2": np.exp(-0.6 * lag)}
        # Each lag in every second row, as longer ones are; the last lag in none.
        rows = np.full((6, len(lag)), np.nan)
        rows[::2] = values[field] + np.array([[-0.1], [0], [0.1]]) * (lag > 0)
        rows[:, -1] = np.nan
        return rows


class TurningRun(KnownRun):
    """One whose needles turn round before they collide: their velocity along themselves is then
    opposite to that before."""

    def observable(self, name, field):
        rows = super().observable(name, field)
        if field == "velocity_parallel":
            lag = super().observable(name, "lag")[2]
            rows[::2] = (1 - 2 * lag) * np.exp(-3 * lag)
        return rows


class Liquid(unittest.TestCase):
    def run_at(self, density, kind=KnownRun):
        scene = {"needles": {"count": 2000, "box": (2000 / density) ** (1 / 3)}}
        run = kind(Path(f"at-{density}"), 1, Conditions.of(scene))
        time = np.array([0.0, 60.0])
        object.__setattr__(run, "series", type("Series", (), {
            "time": time, "collisions": np.array([0, 30000])}))
        return run

    def test_constants_are_those_of_the_motion(self):
        for density, d_rot in ((1, 3), (64, 0.1)):
            numbers = transport(self.run_at(density))
            self.assertAlmostEqual(numbers.rate, 0.5)
            # What lies where the correlation is taken for noise is 1 % of this.
            self.assertAlmostEqual(numbers.d, 2, delta=0.001)
            # Most of it is beyond the longest lag.
            self.assertAlmostEqual(numbers.d_parallel, 20, delta=0.001)
            self.assertAlmostEqual(numbers.d_perpendicular, 0.5, delta=0.0003)
            self.assertAlmostEqual(numbers.d_rot, d_rot, delta=0.001 * d_rot)
            self.assertAlmostEqual(numbers.anisotropy, 2, places=10)
        # A quarter of the run, and no lag without a value.
        self.assertLessEqual(correlations(self.run_at(1)).lag[-1], 15)

    def test_motion_back_along_the_director_counts(self):
        self.assertAlmostEqual(transport(self.run_at(1, TurningRun)).d_parallel, 1 / 9, delta=0.0003)


if __name__ == "__main__":
    unittest.main()
