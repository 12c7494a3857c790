"""Frames of H5MD files in all layouts that initial.file can have."""

import unittest

import needlework
import numpy as np
from needlework import InputError, IoError, Simulation, read

from support import InFolder, require

require("h5py")

import h5py

COUNT = 4
BOX = np.array([5.0, 6.0, 7.0])
ROOT = "particles/rods/"


def numbers(frames):
    """Needles in several frames, [F, N, 3] each."""
    random = np.random.default_rng(1)
    shape = (frames, COUNT, 3)
    u = random.normal(size=shape)
    u /= np.linalg.norm(u, axis=2, keepdims=True)
    w = random.normal(size=shape)
    w -= np.sum(u * w, axis=2, keepdims=True) * u
    return {"position": random.uniform(0, 5, shape), "velocity": random.normal(size=shape),
            "orientation": u, "angular_velocity": w}


class ForeignFiles(InFolder):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "other.h5"

    def make(self, frames=3, change=lambda file: None):
        """Elements without step and time, a box as [3], no ids and images."""
        self.path.unlink(missing_ok=True)
        self.arrays = numbers(frames)
        with h5py.File(self.path, "w") as file:
            for name, values in self.arrays.items():
                file[f"{ROOT}{name}/value"] = values
            file[ROOT + "box/edges"] = BOX
            change(file)
        return self.path

    def assert_read(self, frames=3):
        """Each frame has its numbers, and the last is what a simulation starts from."""
        with read(self.path) as recording:
            self.assertEqual(len(recording.frames), frames)
            for index, frame in enumerate(recording.frames):
                for name, values in self.arrays.items():
                    np.testing.assert_array_equal(getattr(frame, name), values[index])
                np.testing.assert_array_equal(frame.box, BOX)
            last = recording.frames[-1]
            sim = Simulation({"initial": {"file": str(self.path)}})
            for name in ("id", "image", "box", "velocity"):
                np.testing.assert_array_equal(getattr(last, name), getattr(sim, name))
            again = Simulation({"needles": {"box": list(last.box)}}, **last.state)
            np.testing.assert_array_equal(again.position, sim.position)
            return last

    def test_the_least_that_is_needed_is_read(self):
        self.make()
        last = self.assert_read()
        self.assertTrue(np.isnan(last.time))
        self.assertIsNone(last.collisions)
        self.assertEqual(repr(last), "<Frame 2 at time nan>")
        with read(self.path) as recording:
            self.assertTrue(np.isnan(recording.frames.time).all())
            self.assertIn("not recorded", recording._repr_html_())
            for missing in ("series", "events", "parameters", "gas"):
                with self.assertRaisesRegex(InputError, "is missing: expected"):
                    getattr(recording, missing)

    def test_bodies_go_along_with_a_state(self):
        rods = {"needles": {"box": 9.0}, "species": [
            {"name": "rod", "count": 4, "length": 2, "mass": 4, "k": 2, "diameter": 0.5},
            {"name": "ball", "count": 3, "length": 0, "diameter": 1}]}
        sim = Simulation(rods)
        sim.save(str(self.path), force=True)
        with read(self.path) as recording:
            state = recording.frames[-1].state
        self.assertEqual(state.bodies.name, ("rod", "ball"))
        self.assertEqual(state.to_pandas().shape, (7, 17))
        for source in (state, sim.state):
            again = Simulation({"needles": {"box": 9.0}}, **source)
            self.assertEqual(again.totals.t_rot, sim.totals.t_rot)
            self.assertEqual(again.gas.species, ("rod", "ball"))
            with self.assertRaisesRegex(InputError, "needles.k = 6: expected 2, as in the state"):
                Simulation({"needles": {"box": 9.0, "k": 6}}, **source)
        with self.assertRaisesRegex(InputError, "bodies: color: expected name, length"):
            Simulation({"needles": {"box": 9.0}}, **{**state, "bodies": {"color": [1]}})

    def test_bodies_of_other_programs_have_their_mass(self):
        def masses(values):
            def change(file):
                file[ROOT + "mass"] = values
            return change
        self.make(change=masses(np.full(4, 3.0)))
        with read(self.path) as recording:
            bodies = recording.frames[-1].state.bodies
            self.assertEqual(dict(bodies), {"mass": [3.0]})
        with self.assertWarnsRegex(UserWarning, "says no length, no diameter, no k of its bodies"):
            sim = Simulation({"initial": {"file": str(self.path)}})
        self.assertEqual(sim.gas.mass, 3.0)

    def test_needles_is_preferred_to_other_groups(self):
        self.make(change=lambda file: file.move("particles/rods", "particles/needles"))
        with h5py.File(self.path, "a") as file:
            file.create_group("particles/walls")
        with read(self.path) as recording:
            self.assertEqual(len(recording.frames), 3)

    def test_box_edges_of_all_shapes_are_read(self):
        matrix = np.diag(BOX)
        for frames in (1, 2, 3, 4):
            for name in ("box/edges", "box/edges/value"):
                for edges in (BOX, matrix, np.tile(BOX, (frames, 1)), np.tile(matrix, (frames, 1, 1))):
                    if name.endswith("value") and frames == 3 and edges.shape == (3, 3) and edges[0, 1] == 0:
                        continue  # in an element of three frames, [3][3] is three rows

                    def change(file, name=name, edges=edges):
                        del file[ROOT + "box/edges"]
                        file[ROOT + name] = edges

                    with self.subTest(frames=frames, name=name, shape=edges.shape):
                        self.make(frames, change)
                        self.assert_read(frames)

    def test_a_box_may_change_in_time(self):
        def change(file):
            del file[ROOT + "box/edges"]
            file[ROOT + "box/edges/value"] = np.array([BOX + 2, BOX + 1, BOX])

        self.make(3, change)
        with read(self.path) as recording:
            np.testing.assert_array_equal([frame.box for frame in recording.frames],
                                          [BOX + 2, BOX + 1, BOX])

    def test_steps_and_times_may_be_increments(self):
        def change(file):
            for name in self.arrays:
                file[f"{ROOT}{name}/step"] = 10
                file[f"{ROOT}{name}/step"].attrs["offset"] = 5
                file[f"{ROOT}{name}/time"] = 0.5
            # An offset of times only.
            file[ROOT + "position/time"].attrs["offset"] = 2.0

        self.make(3, change)
        last = self.assert_read()
        self.assertEqual((last.collisions, last.time), (25, 3.0))
        with read(self.path) as recording:
            np.testing.assert_array_equal(recording.frames.time, [2, 2.5, 3])

    def test_plain_datasets_are_one_frame(self):
        def change(file):
            for name, values in self.arrays.items():
                del file[ROOT + name]
                file[ROOT + name] = values[0]
            file[ROOT + "id"] = [7, 3, 9, 1]

        self.make(1, change)
        with read(self.path) as recording:
            self.assertEqual(len(recording.frames), 1)
            frame = recording.frames[0]
            np.testing.assert_array_equal(frame.id, [7, 3, 9, 1])
            np.testing.assert_array_equal(frame.position, self.arrays["position"][0])

    def test_elements_are_matched_by_step(self):
        def change(file):
            for name in self.arrays:
                file[f"{ROOT}{name}/step"] = [0, 4, 8]
            file[ROOT + "image/value"] = np.arange(24).reshape(2, COUNT, 3)
            file[ROOT + "image/step"] = [4, 8]

        self.make(3, change)
        with read(self.path) as recording:
            self.assertEqual(len(recording.frames), 2)
            for index, frame in enumerate(recording.frames):
                np.testing.assert_array_equal(frame.position, self.arrays["position"][index + 1])
                self.assertEqual(frame.image[0, 0], 12 * index)
                self.assertEqual(frame.collisions, 4 * index + 4)

    def test_numbers_of_other_kinds_are_read(self):
        def change(file):
            del file[ROOT + "velocity/value"]
            file[ROOT + "velocity/value"] = np.ones((3, COUNT, 3), dtype=">i2")
            file[ROOT + "image/value"] = np.full((3, COUNT, 3), 2.0, dtype="f4")
            self.arrays["velocity"] = np.ones((3, COUNT, 3))

        self.make(3, change)
        last = self.assert_read()
        self.assertEqual(last.velocity.dtype, np.float64)
        self.assertEqual(last.image.dtype, np.int32)

    def test_what_cannot_be_read_is_an_input_error(self):
        def without(name):
            return lambda file: file.__delitem__(name)

        def with_other(name, values):
            def change(file):
                if ROOT + name in file:
                    del file[ROOT + name]
                file[ROOT + name] = values
            return change

        several = lambda file: [file.create_group(f"particles/{name}") for name in "ab"]
        dangling = lambda file: (without(ROOT + "velocity")(file), file.__setitem__(
            ROOT + "velocity", h5py.SoftLink("/nothing")))
        for change, message in (
                (without("particles"), "/particles: 0 groups: expected the file of a run, or an H5MD"),
                (several, "/particles: 3 groups: expected the file of a run, or an H5MD"),
                (without(ROOT + "velocity"), "/particles/rods/velocity: missing: expected a dataset"),
                (dangling, "/particles/rods/velocity: missing: expected a dataset"),
                (without(ROOT + "box"), "/particles/rods/box/edges: missing: expected edges"),
                (with_other("velocity", ["text"]), "velocity: the values are not numbers"),
                (with_other("velocity", np.ones((3, COUNT + 1, 3))), r"velocity: shape \[3, 5, 3\]: "),
                (with_other("position/value", np.ones(3)), "position/value: shape"),
                (with_other("id", np.ones(COUNT + 1)), r"id: shape \[5\]: expected \[4\]"),
                (with_other("box/edges", np.ones((2, 2))), r"box/edges: shape \[2, 2\]: expected"),
                (with_other("position/step", [0, 2, 1]), "position/value: steps that go back"),
                (with_other("position/step", [0, 1, 2, 3]), "4 steps: expected 3"),
                (with_other("position/step", "abc"), "position/value: step of type"),
                (with_other("position/step", 2**62), "steps up to .*: expected numbers of 64 bits"),
        ):
            with self.assertRaisesRegex(InputError, f"{self.path}: .*{message}"):
                read(self.make(change=change))
        for change, name, message in (
                (with_other("box/edges", np.arange(1, 10).reshape(3, 3)), "box", "not along the axes"),
                (with_other("box/edges", -BOX), "box", "expected edges above 0"),
                (with_other("image", np.full((3, COUNT, 3), 0.5)), "image", "whole numbers"),
                (with_other("id", np.full(COUNT, -1)), "id", "whole numbers that uint32 can hold"),
                (with_other("velocity/value", np.ones((2, COUNT, 3))), "velocity", "2 frames: expected 3"),
        ):
            with read(self.make(change=change)) as recording:
                with self.assertRaisesRegex(InputError, message):
                    getattr(recording.frames[0], name)
        with read(self.make()) as recording:
            frame = recording.frames[0]
        with self.assertRaisesRegex(IoError, "is closed: expected an open file"):
            frame.position
        self.path.write_text("no HDF5")
        with self.assertRaisesRegex(IoError, "cannot be read"):
            read(self.path)


if __name__ == "__main__":
    unittest.main()
