"""Files of runs: series, frames and events as they were simulated."""

import errno
import os
import pickle
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path
from unittest import mock

import needlework
import numpy as np
from needlework import InputError, IoError, Simulation, read

from support import GAS, InFolder, gas, require

require("h5py", "pandas")


class Summaries(InFolder):
    def test_of_a_sweep_has_a_column_for_each_parameter_and_result(self):
        (self.folder / "scene.toml").write_text(
            "needles = { count = 20, box = 4 }\nuntil.collisions_per_needle = 5\n")
        (self.folder / "grid.toml").write_text(
            'scene = "scene.toml"\nseeds = [1, 2]\n[parameters]\n'
            '"collisions.epsilon" = [1.0, 0.9]\n"collisions.tc" = 0.1\n')
        subprocess.run([os.environ["NEEDLEWORK_PROGRAM"], "sweep", "grid.toml", "--quiet",
                        "--out", "all"], cwd=self.folder, check=True)
        summary = read(Path(self.folder, "all", "summary.h5"))
        np.testing.assert_equal(summary["collisions.epsilon"], [1, 0.9])
        np.testing.assert_equal(summary.members, [2, 2])
        np.testing.assert_equal(summary.collisions, [50, 50])
        np.testing.assert_equal(summary.collisions_error, [0, 0])
        self.assertGreater(summary.time_error[0], 0)
        self.assertLess(summary.energy[1], summary.energy[0])
        self.assertEqual(list(summary.to_pandas()["members"]), [2, 2])
        self.assertEqual([list(seeds) for seeds in summary.seeds], [[1, 2], [1, 2]])
        np.testing.assert_allclose(summary.series[0].energy[0], summary.energy[0])
        self.assertIn("[parameters]", summary.about.grid)
        self.assertEqual(repr(summary)[:22], "SweepSummary of 2 rows")
        again = pickle.loads(pickle.dumps(summary))
        np.testing.assert_equal(again.series[1].time, summary.series[1].time)


class Reading(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name, "run.h5")
        cls.rows = []
        output = {"file": str(cls.path), "events": True, "frames": [0.5, 1.0],
                  "observables": ["flow_order", "alignment"]}
        with Simulation(gas(output=output)) as sim:
            sim.on_collisions(cls.rows.append)
            cls.first = sim.position
            sim.run()
        cls.sim = sim
        cls.rows = np.concatenate(cls.rows)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.recording = read(self.path)
        self.addCleanup(self.recording.close)

    def test_series_ends_with_the_totals(self):
        series = self.recording.series
        for name, value in self.sim.totals.items():
            np.testing.assert_array_equal(series[name][-1], value)
        self.assertEqual(series.time[0], 0)
        self.assertEqual(series.momentum.shape, (series.rows, 3))
        self.assertEqual(series.rows, len(series.energy))

    def test_observables_are_read_by_name(self):
        rows = self.recording.series.rows
        self.assertEqual(self.recording.observable("flow_order").translational.shape, (rows,))
        alignment = self.recording.observable("alignment")
        self.assertEqual(alignment.along_axes.shape, (rows, 3, len(alignment.borders) - 1))
        self.assertEqual(self.recording.observable("theory").energy[0],
                         self.recording.series.energy[0])
        for name in ("fields", "species", "energy", ""):
            with self.assertRaisesRegex(InputError, f"observable\\('{name}'\\): expected one of those of "
                                        "this run, .*flow_order, .*theory; output.observables of its"):
                self.recording.observable(name)

    def test_frames_are_read_by_index(self):
        frames = self.recording.frames
        self.assertEqual(len(frames), 4)
        np.testing.assert_array_equal(frames.time, [0, 0.5, 1, self.sim.time])
        np.testing.assert_array_equal(frames[0].position, self.first)
        last = frames[-1]
        for name in ("position", "velocity", "orientation", "angular_velocity", "image", "id",
                     "box"):
            np.testing.assert_array_equal(getattr(last, name), getattr(self.sim, name))
        self.assertEqual(last.collisions, 2000)
        self.assertEqual([frame.time for frame in frames[1:3]], [0.5, 1.0])
        self.assertEqual(len(list(frames)), 4)
        for index in (4, -5):
            with self.assertRaisesRegex(IndexError, rf"^frames\[{index}\]: expected an index from "
                                                    "-4 to 3$"):
                frames[index]

    def test_events_are_read_in_parts(self):
        events = self.recording.events
        self.assertEqual(len(events), 2000)
        whole = events[:]
        for name in events.dtype.names:
            np.testing.assert_array_equal(events[name], self.rows[name])
            np.testing.assert_array_equal(whole[name], self.rows[name])
        np.testing.assert_array_equal(events[10:20], whole[10:20])
        np.testing.assert_array_equal(events[10:30:7], whole[10:30:7])
        np.testing.assert_array_equal(events[20:10:-3], whole[20:10:-3])
        np.testing.assert_array_equal(events[5:1], whole[5:1])
        self.assertEqual(events[-1], whole[-1])
        self.assertEqual(sum(1 for _ in events), 2000)
        with self.assertRaisesRegex(InputError, "expected one of time, epoch"):
            events["colour"]
        with self.assertRaisesRegex(IndexError, r"^events\[2000\]: expected an index from -2000"):
            events[2000]
        with self.assertRaisesRegex(InputError, "^events: an index of the type ndarray: expected"):
            events[events["tc"]]
        np.testing.assert_array_equal(events[:][events["tc"]], whole[whole["tc"]])

    def test_tables_for_pandas(self):
        series = self.recording.series.to_pandas()
        self.assertEqual(len(series), self.recording.series.rows)
        np.testing.assert_array_equal(series["momentum_y"], self.recording.series.momentum[:, 1])
        events = self.recording.events.to_pandas()
        np.testing.assert_array_equal(events["pair_2"], self.rows["pair"][:, 1])

    def test_parameters_and_gas(self):
        self.assertEqual(self.recording.parameters.seed, 3)
        self.assertIn("tc_relative", self.recording.parameters.scene)
        for name, value in self.sim.gas.items():
            np.testing.assert_array_equal(self.recording.gas[name], value)

    def test_the_recorded_scene_runs_again(self):
        scene = tomllib.loads(self.recording.parameters.scene)
        del scene["output"]
        again = Simulation(scene)
        again.run()
        self.assertEqual(again.hash, self.sim.hash)

    def test_notebooks_show_tables(self):
        for shown in (self.recording, self.recording.series, self.sim, self.sim.totals):
            self.assertIn("<table>", shown._repr_html_())

    def test_arrays_stay_when_the_file_is_closed(self):
        recording = read(self.path)
        energy = recording.series.energy
        recording.close()
        self.assertGreater(energy[0], energy[-1])
        with self.assertRaisesRegex(IoError, "is closed"):
            recording.frames

    def test_a_run_can_be_read_while_it_lasts(self):
        path = Path(self.folder.name, "long.h5")
        with Simulation(gas(output={"file": str(path), "frames": [0.1]})) as sim:
            sim.run(time=1)
            with read(path) as recording:
                self.assertEqual(len(recording.frames), 2)
            sim.run()
        with read(path) as recording:
            self.assertEqual(len(recording.frames), 3)
            with self.assertRaisesRegex(InputError, r"/events is missing: expected a run with"):
                recording.events

    def test_a_forgotten_simulation_completes_its_file(self):
        path = Path(self.folder.name, "forgotten.h5")
        sim = Simulation(gas(output={"file": str(path)}))
        sim.run()
        del sim
        with read(path) as recording:
            self.assertEqual(recording.series.collisions[-1], 2000)
            self.assertEqual(recording.frames[-1].collisions, 2000)

    def test_a_file_is_read_while_it_is_written(self):
        path = Path(self.folder.name, "growing.h5")
        with Simulation(gas(output={"file": str(path), "frames": 1})) as sim:
            sim.run()
            with read(path) as recording:
                self.assertGreater(len(recording.frames), 1)
                self.assertTrue(recording._file.swmr_mode)
        with read(path) as recording:
            self.assertFalse(recording._file.swmr_mode)

    def test_what_is_open_keeps_its_rows_while_the_file_grows(self):
        path = Path(self.folder.name, "held.h5")
        with Simulation(gas(output={"file": str(path), "frames": 100, "events": True})) as sim:
            sim.run(time=0.2)
            with read(path) as recording:
                # HDF5 keeps little of what it has read.
                cache = recording._file.id.get_mdc_config()
                cache.set_initial_size = True
                cache.initial_size = cache.min_size = cache.max_size = 1024
                cache.incr_mode = cache.flash_incr_mode = cache.decr_mode = 0
                recording._file.id.set_mdc_config(cache)
                frames, events = len(recording.frames), len(recording.events)
                self.assertGreater(frames, 1)
                sim.run()
                self.assertGreater(recording.series.rows, 1)
                self.assertEqual((len(recording.frames), len(recording.events)), (frames, events))
            with read(path) as recording:
                self.assertGreater(len(recording.frames), frames)
                self.assertGreater(len(recording.events), events)

    def test_counts_are_read_before_what_they_count(self):
        import h5py
        path = Path(self.folder.name, "counts.h5")
        with Simulation(gas(output={"file": str(path), "frames": 100, "events": True})) as sim:
            sim.run(time=0.2)
            visit = h5py.Group.visit

            def slowly(group, function):
                def each(name):
                    if name == "events/arms":
                        sim.run()
                    return function(name)
                return visit(group, each)

            with mock.patch.object(h5py.Group, "visit", slowly), read(path) as recording:
                events = recording.events
                self.assertGreater(len(recording._file["events/epoch"]), len(events))
                for field in events.dtype.names:
                    self.assertEqual(len(events[field]), len(events), field)

    def test_a_growing_file_that_cannot_be_listed_is_refused(self):
        import h5py
        path = Path(self.folder.name, "unlisted.h5")
        damage = mock.patch.object(h5py.Group, "visit", side_effect=RuntimeError("wrong checksum"))
        with Simulation(gas(output={"file": str(path)})), damage:
            with self.assertRaisesRegex(IoError, "unlisted.h5: cannot be read: wrong checksum"):
                read(path)

    def test_other_files_are_refused(self):
        import h5py
        with self.assertRaisesRegex(IoError, "no-such.h5: cannot be read: No such file"):
            read("no-such.h5")
        text, other = Path(self.folder.name, "text.h5"), Path(self.folder.name, "other.h5")
        text.write_text("not HDF5")
        with self.assertRaisesRegex(IoError, "cannot be read"):
            read(text)
        h5py.File(other, "w").close()
        with self.assertRaisesRegex(InputError, "expected the file of a run"):
            read(other)

    def test_a_file_may_lack_what_later_versions_have_added(self):
        import h5py
        path = Path(self.folder.name, "earlier.h5")
        path.write_bytes(self.path.read_bytes())
        with h5py.File(path, "r+") as file:
            del file["series/tc_collisions"], file["velocities_set/t_rot"]
        with read(path) as recording:
            self.assertEqual([*recording.series, "tc_collisions"], list(self.recording.series))
            np.testing.assert_array_equal(recording.series.energy, self.recording.series.energy)
            with self.assertRaisesRegex(AttributeError, "Series has no tc_collisions: expected time"):
                recording.series.tc_collisions
            self.assertNotIn("t_rot", recording.velocities_set)

    def test_series_of_totals(self):
        sim = Simulation(GAS)
        samples = [sim.totals]
        for time in (0.5, 1.0):
            sim.run(time=time)
            samples.append(sim.totals)
        series = needlework.Series.of(samples)
        np.testing.assert_array_equal(series.time, [0, 0.5, 1])
        self.assertEqual(series.momentum.shape, (3, 3))
        self.assertEqual(list(series), list(self.recording.series))


class WithoutLocks(unittest.TestCase):
    @unittest.skipUnless(os.environ.get("NEEDLEWORK_NO_LOCKS"), "sanitizers come first")
    def test_files_are_read_on_file_systems_without_locks(self):
        script = """
import needlework, warnings
warnings.simplefilter("error")
try:
    needlework.Simulation({"needles": {"count": 50, "box": 5}, "output": {"file": "run.h5"}})
except needlework.SceneWarning as warning:
    assert "cannot be noticed" in str(warning), warning
else:
    raise AssertionError("no warning")
warnings.simplefilter("ignore")
scene = {"needles": {"count": 50, "box": 5}, "output": {"file": "run.h5"}}
with needlework.Simulation(scene, force=True) as sim:
    sim.run(collisions=50)
    sim.checkpoint()
    with needlework.read("run.h5") as run:
        assert len(run.frames) == 1
with needlework.read("run.h5") as run:
    assert run.series.rows > 1
"""
        for error in (errno.ENOLCK, errno.EOPNOTSUPP, 524):
            with tempfile.TemporaryDirectory() as folder:
                environment = {**os.environ, "NO_LOCKS": str(error),
                               "LD_PRELOAD": os.environ["NEEDLEWORK_NO_LOCKS"]}
                done = subprocess.run([sys.executable, "-c", script], cwd=folder, env=environment,
                                      capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
