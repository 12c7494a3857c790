#!/usr/bin/python3
"""bench/peers/peers.py measures what engines take, in turn, and compares only what is the same.

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

sys.dont_write_bytecode = True
BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))
import measured  # noqa: E402
import versus  # noqa: E402

PROGRAM = sys.argv.pop() if len(sys.argv) > 1 else ""
SCRIPT = str(BENCH / "peers/peers.py")
STAND_IN = Path(__file__).resolve().parent / "peer_stand_in.py"
ABOUT = {"commit": "c", "machine": "m", "cores": 2, "compiler": "g", "flags": "f", "version": "0"}
SMALL = {"dilute": (1000, 11.2, 4), "dense": (500, 4.0, 4)}


def executable(file, text):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("#!/bin/sh\n" + text + "\n")
    file.chmod(0o755)


def rows(table):
    return [line.strip("| ").split(" | ") for line in table.splitlines() if line.startswith("| d")]


def figures(cell):
    """Median and interval."""
    return tuple(map(float, re.fullmatch(r"(\S+) \((\S+)–(\S+)\)", cell).groups()))


class Peers(unittest.TestCase):
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

    def run_script(self, *arguments, **settings):
        """Exit code or message, and what was printed, for small scenes."""
        environment = {"STAND_IN_LOG": str(self.log), "STAND_IN_US": "5",
                       "STAND_IN_PROGRAM": PROGRAM, **settings}
        arguments = [SCRIPT, "--program", str(self.folder / "ours/needlework"),
                     "--repetitions", "6", *map(str, arguments)]
        with mock.patch.dict(os.environ, environment), mock.patch.dict(versus.SCENES, SMALL), \
                mock.patch.object(measured, "about", lambda build: ABOUT), \
                mock.patch.object(sys, "argv", arguments), \
                contextlib.redirect_stdout(io.StringIO()) as out, \
                contextlib.redirect_stderr(io.StringIO()), self.assertRaises(SystemExit) as end:
            runpy.run_path(SCRIPT, run_name="__main__")
        return end.exception.code, out.getvalue()

    def test_dynamo_does_the_same_from_the_same_state_in_turn_with_ours(self):
        code, table = self.run_script("--dynamo", self.folder / "dynamo", "--scene", "dilute",
                                      "--scene", "dense-inelastic", STAND_IN_US="100")
        self.assertEqual(code, 0, table)
        self.assertIn("6 interleaved repetitions", table)
        found = rows(table)
        self.assertEqual([row[0] for row in found], ["dilute"] * 2 + ["dense-inelastic"] * 2)
        for ours, theirs in (found[:2], found[2:]):
            self.assertEqual(ours[1:3] + theirs[1:3], ["Needlework", "0", "DynamO, lines", "unknown"])
            # The stand-in reads what was exported, and has the same collisions at the same times.
            self.assertEqual(ours[3:5], theirs[3:5])
            # The start of Python takes as long as many hundred collisions, but is not counted.
            self.assertAlmostEqual(figures(theirs[5])[0], 100, delta=40)
            self.assertEqual(ours[7], "1")
            quotient = figures(theirs[5])[0] / figures(ours[5])[0]
            self.assertAlmostEqual(figures(theirs[7])[0] / quotient, 1, delta=0.5)
        self.assertEqual([row[3] for row in found[::2]], ["2000", "1000"])

        calls = self.log.read_text().splitlines()
        self.assertTrue(all("--threads 1" in call for call in calls if call.startswith("ours run")))
        for epsilon in ("1.0", "0.98"):
            self.assertEqual(sum(f"collisions.epsilon={epsilon} " in call for call in calls), 14)
        begin = next(i for i, call in enumerate(calls) if call.startswith("dynarun")) + 1
        self.assertNotIn("-E", calls[begin - 1])
        names = {"ours": ["ours run", "ours run least"], "theirs": ["dynarun 2000", "dynarun 1"]}
        expected = sum((names["ours"] + names["theirs"], names["theirs"] + names["ours"]), []) * 3

        def short(call):
            if call.startswith("dynarun"):
                return "dynarun " + re.search(r"start.xml -c (\d+) .*-E", call)[1]
            return "ours run least" if "per_needle=0.001" in call else call[:8]

        self.assertEqual([short(call) for call in calls[begin:begin + 24]], expected)

    def test_spheres_of_edmd_collide_as_often_as_needles(self):
        out = self.folder / "spheres.md"
        code, printed = self.run_script("--edmd", self.folder / "edmd", "--out", out,
                                        STAND_IN_THERMOSTAT="1")
        table = out.read_text()
        self.assertEqual((code, printed), (0, ""), table)
        found = rows(table)
        self.assertEqual([row[0] for row in found], ["dilute", "dilute", "dense", "dense"])
        self.assertIn("Spheres are another problem", table)
        for ours, theirs, exact in ((*found[:2], 0.881), (*found[2:], 9.67)):
            self.assertEqual(theirs[1], "EDMD, spheres, with thermostat")
            self.assertAlmostEqual(float(theirs[4]) / exact, 1, delta=0.01)
            self.assertAlmostEqual(float(ours[4]) / exact, 1, delta=0.05)
            # As long as EDMD ran, to 10, of which it does not collide for the first 0.5.
            self.assertAlmostEqual(int(theirs[3]) / int(ours[3]), 0.95, delta=0.05)
            # At least what collisions cost; the start of Python is counted here.
            self.assertGreater(figures(theirs[5])[0], 5)

    def test_other_rates_are_not_compared(self):
        out = self.folder / "peers.md"
        code, _ = self.run_script("--edmd", self.folder / "edmd", "--scene", "dilute", "--out", out,
                                  STAND_IN_SLOW="0.9")
        self.assertEqual(code, 1)
        self.assertRegex(out.read_text(), r"\*\*dilute, EDMD, spheres: its rate differs from ours by "
                         r"-\d+\.\d %, more than 5 %")

    def test_a_peer_that_fails_is_quoted_and_nothing_is_written(self):
        out = self.folder / "peers.md"
        for option, name in (("--dynamo", "dynarun"), ("--edmd", "md")):
            code, printed = self.run_script(option, self.folder / option[2:], "--scene", "dilute",
                                            "--out", out, STAND_IN_FAILS=name)
            self.assertRegex(code, rf"(?s)^peers.py: .*/{name}.*exit code 1; its last lines are\n"
                             r"two\nthree\nfour\nInitialising\nMain\(\): Particle 7 has no species$")
            self.assertEqual(printed, "")
            self.assertFalse(out.exists())

    def test_output_of_another_kind_is_refused(self):
        executable(self.folder / "edmd/md", "echo Starting configuration from fcc crystal")
        code, _ = self.run_script("--edmd", self.folder / "edmd", "--scene", "dense")
        self.assertIn("expected a build that reads init.sph", code)
        executable(self.folder / "dynamo/bin/dynarun", "echo '<OutputData/>' > data.xml")
        code, _ = self.run_script("--dynamo", self.folder / "dynamo", "--scene", "dense")
        self.assertIn("expected TwoParticleEvents and Time", code)

    def test_spheres_do_not_overlap(self):
        peers = runpy.run_path(SCRIPT)
        file = self.folder / "init.sph"
        for count, rate in ((500, 14.32), (343, 14.32), (500, 0.895)):
            peers["write_spheres"](count, peers["density_of_spheres"](rate), file)
            box = float(file.read_text().split()[1])
            spheres = [[float(x) for x in line.split()[1:4]]
                       for line in file.read_text().splitlines()[2:]]
            self.assertEqual(len(spheres), count)
            for i, a in enumerate(spheres):
                for b in spheres[:i]:
                    self.assertGreater(math.dist([0, 0, 0], [math.remainder(x - y, box)
                                                             for x, y in zip(a, b)]), 1)


class Usage(unittest.TestCase):
    def refused(self, *arguments):
        done = subprocess.run([sys.executable, "-B", SCRIPT, *map(str, arguments)],
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        return done.stderr

    def test_without_a_peer_it_says_how_to_get_one(self):
        message = self.refused()
        for words in ("expected --dynamo FOLDER or --edmd FOLDER", "git clone https://github.com/"
                      "dynamomd/DynamO", "make -C EDMD/Single", "peers.py --dynamo DynamO/build"):
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
            self.assertIn("EDMD has elastic collisions only",
                          self.refused(*edmd, "--scene", "dense-inelastic"))
            self.assertIn("expected at least 6", self.refused(*edmd, "--repetitions", "5"))
            self.assertIn(f"expected a folder {folder}/none",
                          self.refused(*edmd, "--out", f"{folder}/none/a.md"))
            self.assertIn("expected an executable program needlework",
                          self.refused("--edmd", folder, "--program", f"{folder}/needlework"))


if __name__ == "__main__":
    unittest.main()
