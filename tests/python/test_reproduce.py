"""Figures of runs of a few needles, and of files whose numbers are known."""

import contextlib
import io
import json
import math
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import small_paper
from support import InFolder, require, script

require("matplotlib", "h5py")
import h5py  # noqa: E402
import numpy as np  # noqa: E402
from needlework import InputError, IoError  # noqa: E402
from needlework.reproduce import FIGURES, PAPER, PaperRuns, read_claims  # noqa: E402
from needlework.reproduce.__main__ import main, make  # noqa: E402
from needlework.reproduce.course import at_collisions  # noqa: E402
from needlework.reproduce.figure import csv_text, read_table  # noqa: E402
from needlework.reproduce.folder import claim_folder  # noqa: E402
from needlework.reproduce.runs import Conditions  # noqa: E402

HERE = Path(__file__).resolve().parent


def reproduce(*words):
    """Exit code, standard output and messages of the command."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(["--program", small_paper.PROGRAM, *map(str, words)])
    return code, out.getvalue(), err.getvalue()


class SmallPaper(InFolder):
    def setUp(self):
        super().setUp()
        self.paper = small_paper.write(self.folder / "paper")

    def test_measures_each_claim_and_makes_data_and_picture_of_each_figure(self):
        words = ("all", "--paper", self.paper, "--out", self.folder / "out", "--json", "--quiet")
        code, text, err = reproduce(*words)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual((self.folder / "out/claims-all.json").read_text(), text)
        rows = json.loads(text)["claims"]
        self.assertEqual(len({row["id"] for row in rows}), len(rows))
        self.assertEqual({row["claim"] for row in rows}, set(read_claims(PAPER / "claims.toml")))
        self.assert_equal_to_the_committed(rows)
        for figure in FIGURES.values():
            self.assertGreater(read_table(self.folder / "out" / figure.data_file).rows, 1)
            picture = (self.folder / "out" / figure.picture_file).read_text()
            self.assertIn("</svg>", picture)
            self.assertIn(figure.title, picture)

        # All runs are there, so the same comes out at once.
        one = reproduce("8", *words[1:])
        self.assertEqual((one[0], json.loads(one[1])["claims"]),
                         (0, [row for row in rows if row["figure"] == "8"]))
        # From the data alone come the same pictures.
        again = self.folder / "again"
        for name in ("3", "cells"):
            words = (name, "--from", self.folder / "out", "--out", again)
            self.assertEqual(reproduce(*words), (0, f"1 picture is in {again}\n", ""))
            self.assertEqual((again / FIGURES[name].picture_file).read_bytes(),
                             (self.folder / "out" / FIGURES[name].picture_file).read_bytes())
        (self.folder / "out" / FIGURES["7"].data_file).write_text("x,y\n1,2\n")
        code, _, err = reproduce("7", "--from", self.folder / "out")
        self.assertEqual(code, 3)
        self.assertIn("expected the data of figure 7", err)

    def assert_equal_to_the_committed(self, rows):
        """Trajectories are the same everywhere, and so are the numbers, but for the rounding of
        sums. The file is of the analysis in C++ that this one replaced, but for D and D_R of the
        liquid, whose integrals are more exact now; test_reproduce_equation.py has known ones."""
        committed = {}
        for line in (HERE / "small_paper_claims.txt").read_text().splitlines():
            if not line.startswith("#"):
                verdict, measured, error, name = line.split(maxsplit=3)
                committed[name] = verdict, float(measured), float(error)
        self.assertEqual(set(committed), {row["id"] for row in rows})
        for row in rows:
            verdict, measured, error = committed[row["id"]]
            self.assertEqual(row["verdict"], verdict, row["id"])
            for name, expected in (("measured", measured), ("error", error)):
                number = math.nan if row[name] is None else row[name]
                np.testing.assert_allclose(number, expected, rtol=1e-8, atol=1e-9,
                                           err_msg=f"{row['id']}: {name}")

    def test_is_the_same_after_an_interruption(self):
        words = ("3", "--paper", self.paper, "--quiet", "--json")
        whole = reproduce(*words, "--out", self.folder / "whole")
        self.assertEqual(whole[0], 0)
        # A program that ends like one that a signal stops once some members are finished.
        stopping = script(self.folder / "stopping",
                          f'"{small_paper.PROGRAM}" "$@" --member 1/2\nexit 75\n')
        parts = self.folder / "parts"
        code, out, err = reproduce(*words, "--out", parts, "--program", stopping)
        self.assertEqual((code, out), (75, ""))
        self.assertEqual(err, "needlework: stopped; what is finished is kept, and needlework "
                              f"reproduce 3 --out {parts} continues\n")
        first = {file: file.stat().st_mtime_ns for file in (parts / "runs/ratio").glob("*seed*.h5")}
        self.assertEqual(len(first), 3)
        self.assertEqual(reproduce(*words, "--out", parts), whole)
        self.assertEqual({file: file.stat().st_mtime_ns for file in first}, first)
        for file in (FIGURES["3"].data_file, FIGURES["3"].picture_file):
            self.assertEqual((parts / file).read_bytes(),
                             (self.folder / "whole" / file).read_bytes())

    def test_says_that_the_program_for_its_runs_is_missing(self):
        code, _, err = reproduce("3", "--paper", self.paper, "--out", self.folder / "out",
                                 "--quiet", "--program", "/none/needlework")
        self.assertEqual((code, err), (5, "needlework: --program /none/needlework: cannot be run: "
                                          "No such file or directory\n"))

    def test_needs_finished_runs_of_all_points(self):
        runs = PaperRuns(self.folder / "out", "full", self.paper)
        with self.assertRaisesRegex(InputError, "dense: expected finished runs of all points of "
                                                ".*dense.toml: there are none with needles.count "
                                                "= 40.*needles.k = 6, initial.t_rot = 1"):
            runs.points("dense")


class Folders(InFolder):
    def test_of_something_else_are_refused(self):
        mine = self.folder / "mine"
        mine.mkdir()
        (mine / "thesis.txt").write_text("mine")
        with self.assertRaisesRegex(InputError, "expected a new folder, one of needlework "
                                                "reproduce, or --force"):
            claim_folder(mine, "full", force=False)
        claim_folder(mine, "full", force=True)
        self.assertEqual((mine / "thesis.txt").read_text(), "mine")
        claim_folder(mine, "full", force=False)
        with self.assertRaisesRegex(InputError, "holds another reproduction than the quick one"):
            claim_folder(mine, "quick", force=False)
        with self.assertRaisesRegex(IoError, "cannot be made"):
            claim_folder(mine / "thesis.txt" / "below", "full", force=False)

    def test_of_the_quick_size_have_no_tests_of_why(self):
        quick, full = PaperRuns("quick", "quick"), PaperRuns("full", "full")
        for figure in FIGURES.values():
            for name in figure.sets:
                self.assertTrue(full.has(name), name)
                self.assertEqual(quick.has(name), not name.endswith(("-tc", "-sliding")), name)
        code, _, err = reproduce("tc-dense", "--quick", "--out", self.folder / "none")
        self.assertEqual(code, 2)
        self.assertEqual(err, "needlework: tc-dense --quick: expected no --quick: its runs belong "
                              "to the full set only\n")
        self.assertFalse((self.folder / "none").exists())


class KnownRuns(InFolder):
    """Finished runs of the dense set, in which S, the second moment and the order of rotation
    grow in a known way."""

    NEEDLES = 40
    COLLISIONS = 100.0 * np.arange(13)  # per needle

    def setUp(self):
        super().setUp()
        self.paper = small_paper.write(self.folder / "paper")
        self.runs = PaperRuns(self.folder / "known", "full", self.paper)
        self.runs.folder_of("dense").mkdir(parents=True)
        for k in (6, 2):
            for t_rot in (1, 0):
                for seed in (1, 2, 3):
                    name = f"k={k},t_rot={t_rot},seed={seed}.h5"
                    self.write(self.runs.folder_of("dense") / name, seed)

    def s(self, seed, collisions):
        """The seeds differ by a tenth."""
        return 0.05 + 0.004 * collisions + 0.1 * (seed - 2)

    def write(self, path, seed):
        collisions = self.COLLISIONS
        total = collisions * self.NEEDLES / 2
        temperature = np.exp(-np.arange(13.0))
        columns = {"t_tr": temperature, "t_rot": temperature, "energy": 2.5 * temperature,
                   "momentum": np.zeros((13, 3)), "collisions": total, "tc_collisions": total // 10}
        orders = {"translational": self.s(seed, collisions),
                  "rotational": 0.25 * (1 + collisions / 1200),  # 8 cells, so 8 / 32 at random
                  "second_moment": 0.05 * (1 + 5 * np.where(collisions <= 500,
                                                            collisions / 400, 0))}
        with h5py.File(path, "w") as file:
            for name in ("position", "velocity", "orientation", "angular_velocity"):
                file[f"particles/needles/{name}/step"] = [0]
                file[f"particles/needles/{name}/time"] = [0.0]
                file[f"particles/needles/{name}/value"] = np.zeros((1, 1, 3))
            file["particles/needles/box/edges"] = np.ones(3)
            file["series/step"], file["series/time"] = total, np.arange(13.0)
            for name, column in columns.items():
                file[f"series/{name}/value"] = column
            for name, column in orders.items():
                file[f"series/flow_order/{name}/value"] = column

    def test_give_their_numbers_to_the_claims(self):
        claims = read_claims(PAPER / "claims.toml")
        rows = {row.id: row for figure in ("5a", "moment", "rotation")
                for row in make(FIGURES[figure], self.runs, claims)}
        start = "k = 2, T_rot(0) = 0"
        s600 = rows[f"flow-order [{start}, at 600]"]
        np.testing.assert_allclose(s600.measured, (2.45, 0.1 / math.sqrt(3), 3), rtol=1e-12)
        self.assertEqual((s600.figure, s600.verdict), ("5a", "open"))
        s1200 = rows[f"flow-order [{start}, at 1200]"]
        self.assertAlmostEqual(s1200.measured.value, 4.85, 12)
        self.assertEqual(s1200.verdict, "differs")
        moment = rows[f"moment-growth [{start}, at 400]"]
        self.assertAlmostEqual(moment.measured.value, 6, 12)
        self.assertEqual(moment.verdict, "agrees")
        for name, expected in ((f"moment-peak [{start}]", 500),
                               (f"rotation-growth [{start}, at 600]", 0.5),
                               (f"tc-instances [dense, {start}]", math.log10(2400))):
            self.assertAlmostEqual(rows[name].measured.value, expected, 12)

    def test_are_read_as_they_were_written(self):
        point = self.runs.points("dense")[3]
        self.assertEqual((point.conditions.k, point.conditions.t_rot, point.seeds), (2, 0, 3))
        run = point.runs[1]
        self.assertEqual((run.seed, run.collisions[6], run.sample_near(610)), (2, 600, 6))
        self.assertEqual(run.observable("flow_order", "translational")[6], self.s(2, 600))
        with self.assertRaisesRegex(InputError, "/series/flow_order/none is missing: expected one "
                                                "of rotational, second_moment, translational"):
            run.observable("flow_order", "none")

    def test_are_interpolated_between_samples(self):
        run = self.runs.points("dense")[0].first
        values = np.arange(13.0)
        np.testing.assert_array_equal(at_collisions(run, values, [0, 50, 1200]), [0, 0.5, 12])
        self.assertTrue(np.isnan(at_collisions(run, values, [-1, 1200.1])).all())


class Units(InFolder):
    def test_of_time_are_those_of_the_paper(self):
        scene = {"needles": {"count": 10000, "box": 24}}
        gamma = 2 / 3 * math.sqrt(math.pi) * Conditions.of(scene).density
        self.assertAlmostEqual(gamma, 0.854771, 6)

    def test_of_data_are_seven_digits_and_nothing_for_nan(self):
        text = csv_text(("a", "b"), [(1, 2.5), (math.nan, -1e-9)])
        self.assertEqual(text, "a,b\n1,2.5\n,-1e-09\n")
        path = self.folder / "table.csv"
        path.write_text(text)
        table = read_table(path)
        np.testing.assert_array_equal(table.a, [1, math.nan])
        for wrong, expected in (("a,b\n1\n", "line 2: 1 numbers: expected 2, a, b"),
                                ("a,b\n1,2\n1,x\n", "line 3: 1,x: expected numbers"),
                                ("a,b\n", "expected lines of numbers")):
            path.write_text(wrong)
            with self.assertRaisesRegex(InputError, expected):
                read_table(path)
        with self.assertRaises(IoError):
            read_table(self.folder / "none.csv")


class Program(InFolder):
    """needlework reproduce, which hands over to Python."""

    def run_program(self, *words, **environment):
        return subprocess.run([small_paper.PROGRAM, "reproduce", *map(str, words)],
                              capture_output=True, text=True, cwd=self.folder,
                              env={**os.environ, "PYTHONPATH": "", **environment})

    def python(self, *options):
        """An interpreter with options."""
        return str(script(self.folder / "python",
                          f'exec "{sys.executable}" {" ".join(options)} "$@"\n'))

    def test_makes_a_figure_with_its_claims(self):
        words = ("relaxation", "--quick", "--out", "all", "--json", "--quiet")
        outcome = self.run_program(*words)
        self.assertEqual((outcome.returncode, outcome.stderr), (0, ""))
        result = json.loads(outcome.stdout)
        self.assertEqual(result["size"], "quick")
        in_equilibrium = [row for row in result["claims"]
                          if row["claim"] == "elastic-equipartition"]
        self.assertEqual(len(in_equilibrium), 2)  # the runs at half the density are too short
        for row in in_equilibrium:
            self.assertEqual((row["figure"], row["seeds"]), ("relaxation", 3))
            self.assertAlmostEqual(row["measured"], 1, delta=0.1)  # 3 to 15 standard errors
        self.assertEqual((self.folder / "all/claims-relaxation.json").read_text(), outcome.stdout)
        # Nothing is left to run, so the same is there at once; the other size is an error.
        self.assertEqual(self.run_program(*words).stdout, outcome.stdout)
        other = self.run_program("relaxation", "--out", "all")
        self.assertEqual(other.returncode, 3)
        self.assertIn("holds another reproduction than the full one", other.stderr)

    def test_stops_at_a_signal_and_says_how_to_continue(self):
        process = subprocess.Popen(
            [small_paper.PROGRAM, "reproduce", "2", "--quick", "--out", "part", "--threads", "1"],
            cwd=self.folder, stderr=subprocess.PIPE, text=True)
        while not list((self.folder / "part/runs/dilute").glob("*.part")):
            self.assertIsNone(process.poll(), process.stderr)
            time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 75, err)
        self.assertIn("needlework reproduce 2 --quick --out part continues", err)
        self.assertFalse((self.folder / "part" / FIGURES["2"].data_file).exists())

    def test_knows_the_figures_of_the_package(self):
        outcome = self.run_program("9")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn(f"9: expected one of {', '.join(['all', *FIGURES])}", outcome.stderr)

    def test_draws_from_data(self):
        table = csv_text(("needles_per_cell", "growth", "error"), [(20, 19, 2), (39, 35, 4)])
        (self.folder / FIGURES["cells"].data_file).write_text(table)
        outcome = self.run_program("cells", "--from", ".")
        self.assertEqual((outcome.returncode, outcome.stderr), (0, ""))
        self.assertTrue((self.folder / FIGURES["cells"].picture_file).exists())

    def test_says_what_to_install_before_it_runs_anything(self):
        outcome = self.run_program("3", "--quick", NEEDLEWORK_PYTHON=self.python("-S"))
        self.assertEqual(outcome.returncode, 5)
        self.assertIn("cannot import numpy, h5py, matplotlib: expected `apt install python3-numpy "
                      "python3-h5py python3-matplotlib` or `pip install numpy h5py matplotlib`",
                      outcome.stderr)
        outcome = self.run_program("3", "--quick", NEEDLEWORK_PYTHON="/none/python")
        self.assertEqual(outcome.returncode, 5)
        self.assertIn("NEEDLEWORK_PYTHON = /none/python: cannot be run", outcome.stderr)
        self.assertFalse((self.folder / "reproduction-quick").exists())

    def test_refuses_what_does_not_go_together(self):
        for words in (("3", "--from", ".", "--quick"), ("3", "--from", ".", "--json"), ()):
            self.assertEqual(self.run_program(*words).returncode, 2)
        outcome = self.run_program("all", "--from", ".")
        self.assertEqual(outcome.returncode, 3)
        self.assertIn("--from .: expected a folder with figure-2.csv", outcome.stderr)


if __name__ == "__main__":
    unittest.main()
