#!/usr/bin/python3
"""bench/peers/peers.py measures what engines take, in turn, and compares only what is the same;
cross_check.py sees whether two engines do the same.

    tests/bench/peers.py PROGRAM

The peers are stand-ins, peer_stand_in.py, which take a known time for a collision.
"""

import contextlib
import io
import math
import os
import re
import runpy
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import h5py

sys.dont_write_bytecode = True
BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path[:0] = [str(BENCH / "peers"), str(BENCH)]
import cross_check  # noqa: E402
import measured  # noqa: E402
import readme  # noqa: E402
import scenes  # noqa: E402
import versus  # noqa: E402

PROGRAM = sys.argv.pop() if len(sys.argv) > 1 else ""
SCRIPT = str(BENCH / "peers/peers.py")
STAND_IN = Path(__file__).resolve().parent / "peer_stand_in.py"
ABOUT = {"commit": "c", "machine": "m", "cores": 2, "compiler": "g", "flags": "f", "version": "0"}
SMALL = {"dilute": (1000, 11.2, 40), "dense": (500, 4.0, 40)}
SPHERES = {"spheres-0.1": (500, 0.1, 40), "spheres-0.3": (500, 0.3, 40),
           "spheres-falling": (500, 0.1, 4)}


def executable(file, text):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("#!/bin/sh\n" + text + "\n")
    file.chmod(0o755)


def rows(table, begin="d"):
    return [line.strip("| ").split(" | ") for line in table.splitlines()
            if re.match(rf"\| [{begin}]", line) and not line.startswith("| scene")]


def figures(cell):
    """Median and interval."""
    return tuple(map(float, re.fullmatch(r"(\S+) \((\S+)–(\S+)\)", cell).groups()))


class WithStandIns(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.log = self.folder / "log"
        executable(self.folder / "ours/needlework",
                   f'echo ours "$@" >> {self.log}\nexec {PROGRAM} "$@"')
        executable(self.folder / "dynamo/bin/dynarun",
                   f'exec {sys.executable} -S -E {STAND_IN} dynarun "$@"')
        executable(self.folder / "edmd/md", f'exec {sys.executable} -S -E {STAND_IN} md "$@"')

    def run_main(self, main, script, *arguments, **settings):
        """Exit code or message, and what was printed."""
        environment = {"STAND_IN_LOG": str(self.log), "STAND_IN_US": "5",
                       "STAND_IN_PROGRAM": PROGRAM,
                       "STAND_IN_H5PY": str(Path(h5py.__file__).parents[1]), **settings}
        arguments = [script, "--program", str(self.folder / "ours/needlework"),
                     *map(str, arguments)]
        with mock.patch.dict(os.environ, environment), mock.patch.dict(versus.SCENES, SMALL), \
                mock.patch.dict(scenes.FALLING, {"falling": (500, 8.0, 40)}), \
                mock.patch.dict(scenes.SPHERES, SPHERES), \
                mock.patch.object(scenes, "SETTLED", 2.0), \
                mock.patch.object(measured, "about", lambda build: ABOUT), \
                mock.patch.object(sys, "argv", arguments), \
                contextlib.redirect_stdout(io.StringIO()) as out, \
                contextlib.redirect_stderr(io.StringIO()), self.assertRaises(SystemExit) as end:
            main()
        return end.exception.code, out.getvalue()

    def run_script(self, *arguments, **settings):
        """Of peers.py, for small scenes."""
        return self.run_main(lambda: runpy.run_path(SCRIPT, run_name="__main__"), SCRIPT,
                             "--repetitions", "6", *arguments, **settings)


class Peers(WithStandIns):
    def test_dynamo_does_the_same_from_the_same_state_in_turn_with_ours(self):
        code, table = self.run_script("--dynamo", self.folder / "dynamo", "--scene", "dilute",
                                      "--scene", "dense-inelastic", STAND_IN_US="100")
        self.assertEqual(code, 0, table)
        self.assertIn("6 interleaved repetitions", table)
        found = rows(table)
        self.assertEqual([row[0] for row in found], ["dilute"] * 2 + ["dense-inelastic"] * 2)
        for ours, theirs in (found[:2], found[2:]):
            self.assertEqual(ours[1:3] + theirs[1:3], ["Needlework", "0", "DynamO", "unknown"])
            # The stand-in reads what was exported, and has the same collisions, of which a tenth
            # are measured.
            self.assertEqual(int(ours[3]), 10 * int(theirs[3]))
            self.assertAlmostEqual(float(ours[4]) / float(theirs[4]), 1, delta=0.05)
            # The start of Python takes as long as many hundred collisions, but is not counted.
            self.assertAlmostEqual(figures(theirs[5])[0], 100, delta=40)
            self.assertEqual(ours[7], "1")
            quotient = figures(theirs[5])[0] / figures(ours[5])[0]
            self.assertAlmostEqual(figures(theirs[7])[0] / quotient, 1, delta=0.5)
        self.assertEqual([row[3] for row in found[::2]], ["20000", "10000"])

        calls = self.log.read_text().splitlines()
        self.assertTrue(all("--threads 1" in call for call in calls if call.startswith("ours run")))
        begin = next(i for i, call in enumerate(calls) if call.startswith("dynarun")) + 1
        self.assertNotIn("-E", calls[begin - 1])
        names = {"ours": ["ours run", "ours run least"], "theirs": ["dynarun 2000", "dynarun 1"]}
        expected = sum((names["ours"] + names["theirs"], names["theirs"] + names["ours"]), []) * 3

        def short(call):
            if call.startswith("dynarun"):
                return "dynarun " + re.search(r"start.xml -c (\d+) .*-E", call)[1]
            return "ours run least" if "per_needle=0.001" in call else call[:8]

        self.assertEqual([short(call) for call in calls[begin:begin + 24]], expected)

    def test_all_goes_to_results_and_quotients_into_a_document(self):
        document = self.folder / "performance.md"
        document.write_text("<!-- peers -->\n<!-- end of peers -->\n")
        with mock.patch.object(readme, "DOCS", self.folder), \
                mock.patch.object(readme, "RESULTS", self.folder / "results"), \
                mock.patch.object(measured, "machine_name", lambda build: "m"):
            code, table = self.run_script("--dynamo", self.folder / "dynamo", "--scene", "dilute",
                                          "--document")
        self.assertEqual(code, 0, table)
        self.assertEqual((self.folder / "results/m/peers.md").read_text(), table)
        brief = document.read_text()
        self.assertIn("| scene | Needlework, µs | DynamO, times that |", brief)
        self.assertRegex(brief, r"\n\| dilute \| [\d.]+ \| [\d.]+ \|\n")

    def test_spheres_start_from_one_state_in_all_engines_and_variants(self):
        executable(self.folder / "edmd/Multi/md", f'exec {sys.executable} -S -E {STAND_IN} md')
        out = self.folder / "spheres.md"
        code, printed = self.run_script(
            "--dynamo", self.folder / "dynamo", "--edmd", self.folder / "edmd", "--scene",
            "spheres-0.1", "--scene", "spheres-0.3", "--out", out, STAND_IN_THERMOSTAT="1")
        table = out.read_text()
        self.assertEqual((code, printed), (0, ""), table)
        found = rows(table, "s")
        engines = ["Needlework", "DynamO", "EDMD Multi, with thermostat", "EDMD, with thermostat"]
        self.assertEqual([row[1] for row in found], 2 * engines)
        for group, rate in ((found[:4], 1.75), (found[4:], 10.1)):
            for row in group:
                self.assertAlmostEqual(float(row[4]) / rate, 1, delta=0.05, msg=row)
            self.assertEqual([row[3] for row in group[:2]], ["10000", "1000"])
            # As long as EDMD was built for: to 10.
            self.assertAlmostEqual(int(group[3][3]) / (500 * rate / 2 * 10), 1, delta=0.05)
            # At least what collisions cost; the start of Python is counted here.
            self.assertGreater(figures(group[3][5])[0], 5)
        calls = self.log.read_text().splitlines()
        order = [call.split()[0] for call in calls
                 if call.startswith(("md", "dynarun start.xml -c 1000 -o end.xml --out-data-file "
                                     "data.xml -E")) or "initial.file=start.h5" in call
                 and "per_needle=40" in call]
        # EDMD runs once before, to see whether it has a thermostat.
        turn = ["ours", "dynarun", "md", "md"]
        self.assertEqual(order[2:18], sum((turn[i:] + turn[:i] for i in range(4)), []))

    def test_walls_and_gravity_are_those_of_dynamo(self):
        out = self.folder / "falling.md"
        code, _ = self.run_script("--dynamo", self.folder / "dynamo", "--scene", "falling",
                                  "--scene", "spheres-falling", "--out", out)
        self.assertEqual(code, 0, out.read_text())
        self.assertIn("walls of DynamO stop balls", out.read_text())
        self.assertEqual([row[3] for row in rows(out.read_text(), "fs")],
                         ["10000", "1000", "1000", "100"])

    def test_other_rates_are_not_compared(self):
        out = self.folder / "peers.md"
        code, _ = self.run_script("--edmd", self.folder / "edmd", "--scene", "spheres-0.1", "--out",
                                  out, STAND_IN_SLOW="0.9")
        self.assertEqual(code, 1)
        self.assertRegex(out.read_text(), r"\*\*spheres-0.1, EDMD: its rate differs from ours by "
                         r"-\d+\.\d %, more than 5 %")

    def test_a_peer_that_fails_is_quoted_and_nothing_is_written(self):
        out = self.folder / "peers.md"
        for option, name in (("--dynamo", "dynarun"), ("--edmd", "md")):
            code, printed = self.run_script(option, self.folder / option[2:], "--scene",
                                            "spheres-0.1", "--out", out, STAND_IN_FAILS=name)
            self.assertRegex(code, rf"(?s)^peers.py: .*/{name}.*exit code 1; its last lines are\n"
                             r"two\nthree\nfour\nInitialising\nMain\(\): Particle 7 has no species$")
            self.assertEqual(printed, "")
            self.assertFalse(out.exists())

    def test_output_of_another_kind_is_refused(self):
        executable(self.folder / "edmd/md", "echo Starting configuration from fcc crystal")
        code, _ = self.run_script("--edmd", self.folder / "edmd", "--scene", "spheres-0.1")
        self.assertIn("expected a build that reads init.sph", code)
        executable(self.folder / "dynamo/bin/dynarun", "echo '<OutputData/>' > data.xml")
        code, _ = self.run_script("--dynamo", self.folder / "dynamo", "--scene", "dense")
        self.assertIn("expected TwoParticleEvents and Time", code)


class CrossCheck(WithStandIns):
    """Of first collisions and of long runs, in small."""

    def check(self, *arguments, **settings):
        with mock.patch.dict(cross_check.LONG, {
                "long-lines-dilute": (cross_check.NEEDLES, 200, 0.0, 7.0),
                "long-spheres-0.1": (cross_check.SPHERES, 500, 1.0, 13.8)}), \
                mock.patch.object(cross_check, "PER_BLOCK", 5):
            return self.run_main(cross_check.main, "cross_check.py", "--dynamo",
                                 self.folder / "dynamo", "--edmd", self.folder / "edmd", *arguments,
                                 STAND_IN_US="0", **settings)

    def test_first_collisions_are_compared(self):
        for case in ("lines", "lines-falling", "spheres-falling"):
            code, table = self.check("--case", case, "--events", 20)
            self.assertEqual(code, 0, table)
            self.assertRegex(table, rf"\| {case} \| first 20 events \| 20 with the same partners and "
                             r"time \| times within \d\.\de-1\d \| same \|")

    def test_another_pair_is_seen(self):
        code, table = self.check("--case", "lines", "--events", 20, STAND_IN_SWAPS="7")
        self.assertEqual(code, 1, table)
        self.assertRegex(table, r"\| 6 with the same partners and time \| .*; then ours (\d+) and \d+ at "
                         r"(0\.\d+), theirs \1 and \d+ at 0\.\d+ \| \*\*differ\*\* \|")

    def test_long_runs_are_compared_within_their_errors(self):
        arguments = ("--case", "long-lines-dilute", "--case", "long-spheres-0.1", "--blocks", 6)
        code, table = self.check(*arguments)
        self.assertEqual(code, 0, table)
        self.assertEqual(table.count("| same |"), 7, table)
        self.assertIn("exact", table)
        code, table = self.check(*arguments, STAND_IN_SLOW="0.9")
        self.assertEqual(code, 1, table)
        self.assertRegex(table, r"long-spheres-0.1 \| rate .* EDMD [^|]*\| -\d+\.\d standard errors "
                         r"\| \*\*differ")

    def test_small_inputs_have_known_answers(self):
        code, table = self.check("--case", "small")
        self.assertEqual(code, 0, table)
        self.assertEqual(table.count("ours: 0 and 1 at 1.00000000; DynamO: 0 and 1 at 1.0000000"), 4,
                         table)


class Usage(unittest.TestCase):
    def refused(self, *arguments):
        done = subprocess.run([sys.executable, "-B", SCRIPT, *map(str, arguments)],
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        return done.stderr

    def test_without_a_peer_it_says_how_to_get_one(self):
        message = self.refused()
        for words in ("expected --dynamo FOLDER or --edmd FOLDER", "make -C EDMD/Single",
                      "git clone --recurse-submodules https://github.com/toastedcrumpets/DynamO",
                      "peers.py --dynamo DynamO/build"):
            self.assertIn(words, message)
        self.assertNotIn("What is compared", message)

    def test_wrong_arguments_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            program = ("--program", PROGRAM)
            self.assertIn(f"--dynamo {folder}: expected an executable program dynarun or bin/dynarun",
                          self.refused("--dynamo", folder, *program))
            self.assertIn(f"--edmd {folder}: expected an executable program md or Single/md",
                          self.refused("--edmd", folder, *program))
            executable(Path(folder) / "md", "exit 0")
            edmd = ("--edmd", folder, *program)
            self.assertIn("EDMD has spheres in a periodic box only",
                          self.refused(*edmd, "--scene", "dense-inelastic"))
            self.assertIn("expected at least 6", self.refused(*edmd, "--repetitions", "5"))
            self.assertIn(f"expected a folder {folder}/none",
                          self.refused(*edmd, "--out", f"{folder}/none/a.md"))
            self.assertIn("expected an executable program needlework",
                          self.refused("--edmd", folder, "--program", f"{folder}/needlework"))


if __name__ == "__main__":
    unittest.main()
