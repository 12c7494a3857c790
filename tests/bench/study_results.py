#!/usr/bin/python3
"""The scripts of bench/ keep rounds, take scenes and a time budget, and write what was measured.

    tests/bench/study_results.py PROGRAM
"""

import json
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock
from xml.etree import ElementTree

sys.dont_write_bytecode = True
sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "bench" / folder)
                for folder in ("", "scaling")]
import instructions  # noqa: E402
import measured  # noqa: E402
import performance  # noqa: E402
import readme  # noqa: E402
import scaling  # noqa: E402
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

    def test_that_would_pass_the_end_of_the_budget_do_not_begin_or_are_stopped(self):
        done = []

        def sleeps(seconds):
            def measure():
                done.append(seconds)
                measured.output_of(["sleep", str(seconds)])
                return "command", [case("s", "auto", 1.0)]
            return measure

        self.store.add_round("long", "command", [case("s", "auto", 1.0)], seconds=1e6)
        parts = {"long": (2, sleeps(60)), "short": (1, sleeps(0)), "unknown": (1, sleeps(60))}
        begin = time.monotonic()
        self.assertEqual(measured.measure_rounds(self.store, parts, 0.2), ["long", "unknown"])
        self.assertEqual(done, [0, 60])
        self.assertLess(time.monotonic() - begin, 30)
        self.assertEqual(measured.output_of(["echo", "later"]), "later\n")

    def test_that_were_stopped_go_on_where_they_were(self):
        measured_here = []

        def one(build, name, kind, n, file):
            measured_here.append((kind, n))
            if len(measured_here) == 2:
                raise measured.OutOfTime
            return {"name": f"{name}/{kind}/threads:{n}", "threads": n, "us_per_collision": [1.0],
                    "hashes": ["a"]}

        with mock.patch.object(scaling, "measure_one", one):
            measure = lambda: scaling.measure(None, "dilute", 2, 1, [], self.store)
            parts = {scaling.part_of("dilute", []): (1, measure)}
            self.assertEqual(measured.measure_rounds(self.store, parts, 100), list(parts))
            self.assertEqual(measured.measure_rounds(self.store, parts, 100), [])
        self.assertEqual(measured_here, [("alone", 1), ("together", 2), ("together", 2),
                                         ("apart", 2), ("crowded", 8)])
        part, = parts
        self.assertEqual(len(self.store.load(part)["cases"]), 4)
        self.assertEqual(self.store.begun(part), [])

    def test_become_tables_of_medians_and_ranges_and_a_picture(self):
        for baseline, other in ((30.0, 10.0), (33.0, 12.0), (60.0, 11.0)):
            self.add(baseline, other)
        contents = {"density": self.store.load("density")}
        study.write_results(contents, "m", self.folder)
        text = (self.folder / "README.md").read_text()
        self.assertIn("median (range) of 3 interleaved repetitions; commit c", text)
        self.assertIn("| 33.0 (30.0–60.0) |", text)  # baseline
        self.assertIn("| 11.0 (10.0–12.0) |", text)  # auto
        self.assertIn("| 3.00 (2.75–5.45) |", text)  # speed-up
        picture = (self.folder / "density.svg").read_text()
        ElementTree.fromstring(picture.encode())
        self.assertIn("needles per L³", picture)
        self.assertLess(picture.count("\n"), 300)

    def test_become_words_of_a_document_in_its_line(self):
        self.add(30.0, 10.0)
        words = performance.faster_words({"cases": self.store.load("density")["cases"]})
        self.assertEqual(words, "3.0 to 3.0 times (dilute gas, n L³ up to 1) and 3 times "
                                "(n L³ = 0.5)")
        document = self.folder / "a.md"
        document.write_text("is <!-- a -->old<!-- end of a --> b\n<!-- c -->\n<!-- end of c -->\n")
        with mock.patch.object(readme, "DOCS", self.folder):
            readme.put_table("a", "new\n", "a.md")
            readme.put_table("c", "table\n", "a.md")
            with self.assertRaisesRegex(ValueError, "expected once, found 0 times"):
                readme.put_table("d", "", "a.md")
        self.assertEqual(document.read_text(), "is <!-- a -->new<!-- end of a --> b\n<!-- c -->\n"
                                               "table\n<!-- end of c -->\n")

    def test_are_where_links_lead(self):
        (self.folder / "bench/results/here").mkdir(parents=True)
        (self.folder / "bench/results/here/a.md").touch()
        document = self.folder / "b.md"
        document.write_text("[a](bench/results/far-1/a.md#x) [c](../bench/results/far-1/c.md)\n")
        with (mock.patch.object(readme, "ROOT", self.folder),
              mock.patch.object(readme, "RESULTS", self.folder / "bench/results")):
            readme.lead_links_to("here")
        self.assertEqual(document.read_text(), "[a](bench/results/here/a.md#x) "
                                               "[c](../bench/results/far-1/c.md)\n")

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
        unknown = measured.Store(self.folder, {**ABOUT, "commit": measured.UNKNOWN})
        for store, complete in ((self.store, False), (changed, True), (quick, True),
                                (unknown, True)):
            self.assertEqual(store.place(inside.name, complete), store.folder / "results")
            self.assertFalse(inside.exists())
        self.assertEqual(self.store.place(inside.name, True), inside)


class Performance(unittest.TestCase):
    """The tables of docs/performance.md."""

    @staticmethod
    def content(*cases):
        return {**ABOUT, "date": "2026-01-01T", "command": "c", "rounds": 2, "cases": list(cases)}

    @staticmethod
    def case_of(scene, words, times, **more):
        search, queue, isa = words.split()
        return {"name": f"{scene}/{search}/{queue}/standard/{isa}/threads:1", "scene": scene,
                "us_per_collision": times, "baseline": False, "needles": 10000, "density": 0.72,
                "search": "capsules", "queue": "tournament", "bytes_per_needle": [500.0],
                "setup_s": [0.021], **more}

    def contents(self):
        one = self.case_of
        baseline = one("s", "linked-lists indexed-heap scalar", [30.0, 32.0], baseline=True)
        auto = one("s", "auto auto avx2", [6.0, 8.0])
        heap = one("s", "auto indexed-heap scalar", [15.0, 16.0])
        return {"density": self.content(baseline, auto),
                "size": self.content(baseline, auto),
                "isa": self.content(baseline, auto),
                "cloud": self.content(baseline, heap, auto),
                "steps": self.content(baseline, heap, one("s", "auto indexed-heap avx2", [8.0, 8.0]),
                                      auto)}

    def test_compare_mixtures_with_needles_of_one_length(self):
        one, times = self.case_of, {"N=9": (9.0, 6.0), "1:4,50%": (8.0, 12.0), "1:4,1%": (24.0, 9.0)}
        cases = [one(f"n={n},{what}", words, [factor * t[k] for factor in (1, 2)], baseline=k == 0)
                 for n in ("0.1", "1") for what, t in times.items() if (n, what) != ("1", "1:4,1%")
                 for k, words in enumerate(("linked-cells auto avx2", "auto auto avx2"))]
        text = study.mixture_table(self.content(*cases))
        self.assertIn("| long needles | n ⟨L⟩³ = 0.1 | n ⟨L⟩³ = 1 |", text)
        self.assertIn("| 1:4, half of all | 2.00 (2.00–2.00); 0.67 | 2.00 (2.00–2.00); 0.67 |", text)
        self.assertIn("| 1:4, 1 % of all | 1.50 (1.50–1.50); 2.67 | the box is too small |", text)

    def threads(self):
        def run(kind, n, us):
            return {"name": f"dilute/{kind}/threads:{n}", "threads": n, "needles": 10000,
                    "us_per_collision": [us]}

        return {"dilute": self.content(
            run("alone", 1, 6.0), run("together", 2, 4.0), run("apart", 2, 3.0), run("crowded", 8, 5.0),
            *(run(f"beside-{load}", n, us) for load in (1, 2, 4)
              for n, us in ((1, 8.0), (2, 10.0), (8, 9.0))))}

    def test_have_a_place_in_the_document(self):
        document = (Path(performance.__file__).parents[1] / "docs/performance.md").read_text()
        blocks = performance.blocks(self.contents(), self.threads())
        self.assertEqual(len(blocks), 4)
        for name in blocks:
            for mark in (f"<!-- {name} -->", f"<!-- end of {name} -->"):
                self.assertEqual(document.count(mark), 1, mark)

    def test_say_what_was_measured_and_where(self):
        blocks = performance.blocks(self.contents(), self.threads())
        self.assertIn("| 10000 | 0.72 | 31.0 (30.0–32.0) | 7.00 (6.00–8.00) | 4.50 (4.00–5.00) |",
                      blocks["classical"])
        self.assertIn("of 2 interleaved repetitions; commit c", blocks["classical"])
        self.assertIn("varies by a factor of 1.00", blocks["classical"])
        self.assertIn("|  | + SIMD (avx2) | 8.00", blocks["steps"])
        self.assertIn("|  | + calendar `tournament` | 7.00", blocks["steps"])
        self.assertIn("| 500 | 0.021 s |", blocks["size"])
        self.assertIn("| dilute | 10000 | 6.00 | 4.00 | 1.50 | 0.75 |", blocks["threads"])
        self.assertIn("| dilute | 1.25 | 1.25 | 1.25 |", scaling.busy_table(self.threads()))

    def test_of_effects_are_short_for_users(self):
        whole = ("of 2000 needles\n\n| effect | off | on | costs | in action | two threads (5 without) "
                 "| bytes per needle |\n|---|---|---|---|---|---|---|\n"
                 "| kicks | 100 | 101 | +1.0 % | 350 | 7 | +0.6 |\n"
                 "| walls | 100 | 108 * | +8.0 % |  | 7 | +13.8 |\n"
                 "| rest | 1000 | 999 | -0.1 % |  |  |  |\n")
        self.assertEqual(instructions.brief_effects(whole).splitlines()[2:], [
            "| kicks | +250 % | +0.6 |", "| walls | +8 % | +13.8 |", "| rest | +0 % |  |"])


class Scripts(unittest.TestCase):
    def test_say_which_processor_and_at_which_clock(self):
        with tempfile.TemporaryDirectory() as folder:
            said = Path(folder) / "cpuinfo"
            said.write_text("processor\t: 0\nvendor_id\t: A\ncpu family\t: 25\nmodel\t\t: 17\n"
                            "model name\t: AMD EPYC\ncpu MHz\t\t: 2599.998\n\nprocessor\t: 1\n"
                            "model name\t: other\n")
            self.assertEqual(measured.processor(said), "AMD EPYC, cpu family 25, model 17, 2.60 GHz")
            said.write_text("processor\t: 0\nBogoMIPS\t: 50.00\n")
            self.assertEqual(measured.processor(said), "")
            self.assertEqual(measured.processor(Path(folder) / "none"), "")
        content = {**ABOUT, "date": "2026-01-01T", "command": "c", "rounds": 1}
        self.assertIn("; m, 2 cores", measured.origin(content))
        self.assertIn("; p, 3 GHz, 2 cores", measured.origin({**content, "processor": "p, 3 GHz"}))

    def test_work_outside_of_a_git_checkout(self):
        with tempfile.TemporaryDirectory() as folder:
            with mock.patch.object(measured, "ROOT", Path(folder).resolve()):
                self.assertEqual(measured.commit(), measured.UNKNOWN)
            with mock.patch.dict("os.environ", {"PATH": folder}):
                self.assertEqual(measured.commit(), measured.UNKNOWN)  # without git

    def test_name_the_target_that_is_not_built(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaises(SystemExit) as ended:
                measured.built(Path(folder), "bench_kernels")
            self.assertIn(f"cmake --build {folder} --target bench_kernels", str(ended.exception))
            with self.assertRaises(SystemExit) as ended:
                measured.built(Path(folder), "needlework")
            self.assertIn("--target needlework_program", str(ended.exception))


class OwnScenes(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.scene = self.folder / "own.toml"
        self.scene.write_text("needles = { count = 60, box = 5 }\noutput.file = 'out.h5'\n"
                              "until.collisions_per_needle = 2\n")

    def run_script(self, *words):
        root = Path(measured.__file__).resolve().parent
        done = subprocess.run([sys.executable, str(root / words[0]), *words[1:]],
                              capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse((self.folder / "out.h5").exists())
        return done.stdout

    def test_are_compared_by_two_programs(self):
        out = self.run_script("versus.py", PROGRAM, PROGRAM, "--scene", str(self.scene),
                              "--repetitions", "6", "--second", "engine.queue=bucket")
        self.assertRegex(out, r"own.toml: .* us per collision at best; .* 6 repetitions")

    def test_are_run_on_several_threads(self):
        build = self.folder / "build"
        build.mkdir()
        (build / "needlework").symlink_to(PROGRAM)
        stand_in = build / "bench_scaling"
        stand_in.write_text("#!/bin/sh\necho '{\"benchmarks\": [{\"real_time\": 30}]}'\n")
        stand_in.chmod(0o755)
        out = self.run_script("scaling/scaling.py", str(self.scene), "--build", str(build),
                              "--repetitions", "1", "--threads", "2")
        self.assertRegex(out, r"\| own \| 60 \| 1 \|")
        self.assertRegex(out, r"\| own \| 60 \| 2 \|")
        self.assertTrue((build / "study/results/scaling.md").exists())


if __name__ == "__main__":
    unittest.main()
