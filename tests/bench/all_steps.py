#!/usr/bin/python3
"""bench/all.py says how long it takes, does each step once, and goes on where it was stopped; the scripts
that it calls take the options that it gives them.

    tests/bench/all_steps.py PROGRAM
"""

import re
import runpy
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))
import measured  # noqa: E402

PROGRAM = Path(sys.argv.pop()) if len(sys.argv) > 1 else None
ABOUT = {"commit": "c", "machine": "m", "cores": 2, "compiler": "g", "flags": "f", "version": "0"}


class All(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.log = self.folder / "log"
        self.log.write_text("")
        # A folder of scripts in which each step writes its name and options; the second fails once.
        bench = self.folder / "bench"
        bench.mkdir()
        for name in ("all.py", "measured.py"):
            (bench / name).write_text((BENCH / name).read_text())
        about = "\n\ndef about(build):\n    import json, os\n    return json.loads(os.environ['ABOUT'])\n"
        (bench / "measured.py").write_text((BENCH / "measured.py").read_text() + about)
        for script in ("performance.py", "accuracy/accuracy.py", "rods_price.py", "instructions.py",
                       "build_cost.py", "peers/peers.py", "peers/cross_check.py"):
            (bench / script).parent.mkdir(exist_ok=True)
            (bench / script).write_text(
                "import pathlib, sys\n"
                f"with open({str(self.log)!r}, 'a') as log:\n"
                f"    print({script!r}, *sys.argv[1:], file=log)\n"
                f"fails = pathlib.Path({str(self.folder / 'fails')!r})\n"
                f"sys.exit(1 if fails.exists() and {script!r}.startswith(fails.read_text()) else 0)\n")
        self.script = bench / "all.py"

    def run_script(self, *arguments, commit="c"):
        import json
        environment = {"ABOUT": json.dumps({**ABOUT, "commit": commit}), "PATH": "/usr/bin:/bin"}
        return subprocess.run([sys.executable, "-B", str(self.script), "--build",
                               str(self.folder / "build"), *map(str, arguments)],
                              capture_output=True, text=True, env=environment)

    def called(self):
        lines = self.log.read_text().splitlines()
        self.log.write_text("")
        return [line.split(" --build")[0].split(" --program")[0] for line in lines]

    ALL = ["performance.py --no-instructions", "accuracy/accuracy.py --readme", "rods_price.py",
           "instructions.py effects", "instructions.py shares", "build_cost.py"]

    def test_says_how_long_it_takes_and_does_each_step_once(self):
        done = self.run_script()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        first = done.stdout.split("== ")[0]
        self.assertIn("6 of 6 steps are left, about 47 min", first)
        self.assertLess(sum(step.minutes for step in runpy.run_path(str(BENCH / "all.py"))["STEPS"]),
                        180)
        self.assertEqual(self.called(), self.ALL)
        done = self.run_script()
        self.assertIn("0 of 6 steps are left", done.stdout)
        self.assertEqual(self.called(), [])
        # At another commit all is measured again, and times are those of before.
        done = self.run_script("--list", commit="d")
        self.assertIn("6 of 6 steps are left, about 1 min", done.stdout)
        self.assertEqual(self.called(), [])

    def test_goes_on_where_a_step_failed_and_where_time_was_used_up(self):
        (self.folder / "fails").write_text("rods")
        done = self.run_script()
        self.assertEqual(done.returncode, 1)
        self.assertIn("not complete: rods (exit code 1); the same command continues", done.stderr)
        self.assertEqual(self.called(), self.ALL)
        (self.folder / "fails").unlink()
        self.assertEqual(self.run_script().returncode, 0)
        self.assertEqual(self.called(), ["rods_price.py"])
        done = self.run_script("--time-budget", "-1", commit="d")
        self.assertIn("the time budget is used up before performance", done.stdout)
        self.assertEqual(self.called(), [])

    def test_other_engines_are_measured_where_they_are(self):
        done = self.run_script("--only", "peers", "shares")
        self.assertEqual(done.returncode, 2)
        self.assertIn("expected --dynamo FOLDER or --edmd FOLDER", done.stderr)
        self.run_script("--only", "peers", "cross-check", "--dynamo", "a", "--edmd", "b")
        self.assertEqual(self.called(), [
            "peers/peers.py --document --dynamo a --edmd b",
            "peers/cross_check.py --document --dynamo a --edmd b"])

    def test_quick_leaves_documents_alone(self):
        self.assertEqual(self.run_script("--quick", "--dynamo", "a").returncode, 0)
        for call in self.called():
            self.assertNotRegex(call, "--readme|--document|shares")
            self.assertRegex(call, "--quick|--dry|--out|--case small")

    def test_scripts_take_these_options(self):
        for step in runpy.run_path(str(BENCH / "all.py"))["STEPS"]:
            said = subprocess.run([sys.executable, "-B", str(BENCH / step.script), "--help"],
                                  capture_output=True, text=True, check=True).stdout
            for option in (*step.options, *step.quick):
                if option.startswith("--") or option in ("effects", "shares", "pairs"):
                    self.assertRegex(said, rf"(?<!\w){re.escape(option)}\b", step)

    @unittest.skipUnless(PROGRAM, "no program")
    def test_a_step_in_quick_mode(self):
        build = self.folder / "quick"
        build.mkdir()
        for name in ("needlework", "bench_accuracy"):
            if not (PROGRAM.parent / name).exists():
                self.skipTest(f"{PROGRAM.parent / name} is not built")
            (build / name).symlink_to(PROGRAM.parent / name)
        status = measured.output_of(["git", "-C", str(BENCH), "status", "--porcelain", "."])
        command = [sys.executable, "-B", str(BENCH / "all.py"), "--quick", "--only", "accuracy",
                   "--build", str(build)]
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertTrue((build / "study-quick/results/accuracy.md").exists(), done.stdout)
        again = subprocess.run(command, capture_output=True, text=True)
        self.assertIn("0 of 1 steps are left", again.stdout)
        self.assertEqual(status, measured.output_of(["git", "-C", str(BENCH), "status",
                                                     "--porcelain", "."]))


if __name__ == "__main__":
    unittest.main()
