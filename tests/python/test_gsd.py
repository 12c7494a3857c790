"""GSD files hold the frames of a run and the state of a simulation."""

import unittest

import support

support.require("numpy", "h5py", "gsd")

import gsd.hoomd
import needlework
import numpy as np
from needlework.gsd_file import capsule, quaternions

# The package's names before version 2.8, and since.
RECENT = hasattr(gsd.hoomd, "Frame")
SNAPSHOT = gsd.hoomd.Frame if RECENT else gsd.hoomd.Snapshot
MODE = {"r": "r", "w": "w"} if RECENT else {"r": "rb", "w": "wb"}


def turned(q):
    """What the quaternions (w, x, y, z) make of (0, 0, 1)."""
    w, x, y, z = q.T
    return np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x**2 + y**2)], axis=1)


class GsdFiles(support.InFolder):
    def setUp(self):
        super().setUp()
        self.run = self.path("run.h5")
        scene = support.gas(output={"file": self.run, "frames": [0.5, 1.0]})
        with needlework.Simulation(scene) as sim:
            sim.run()

    def path(self, name):
        return str(self.folder / name)

    def assert_same(self, snapshot, frame):
        close = np.testing.assert_allclose
        close(snapshot.configuration.box[:3], frame.box)
        close(snapshot.particles.position, frame.position - frame.box / 2, atol=1e-6)
        close(snapshot.particles.velocity, frame.velocity, atol=1e-6)
        close(turned(snapshot.particles.orientation.astype(float)), frame.orientation, atol=1e-6)
        np.testing.assert_array_equal(snapshot.particles.image, frame.image)
        np.testing.assert_array_equal(snapshot.log["particles/angular_velocity"],
                                      frame.angular_velocity)
        self.assertEqual(snapshot.log["time"][0], frame.time)

    def test_all_frames_of_a_file(self):
        out = self.path("run.gsd")
        with needlework.read(self.run) as run:
            self.assertEqual(needlework.to_gsd(self.run, out), len(run.frames))
            with gsd.hoomd.open(out, MODE["r"]) as file:
                self.assertEqual(len(file), len(run.frames))
                for snapshot, frame in zip(file, run.frames):
                    self.assert_same(snapshot, frame)
                    self.assertEqual(snapshot.configuration.step, frame.collisions)

    def test_axes_with_walls(self):
        walled, out = self.path("walled.h5"), self.path("walled.gsd")
        scene = support.gas(output={"file": walled, "frames": [0.5]})
        scene["walls"] = [{"axis": "z", "side": "both"}]
        with needlework.Simulation(scene) as sim:
            self.assertEqual(sim.periodic.tolist(), [True, True, False])
            sim.run()
            needlework.to_gsd(sim, self.path("state.gsd"))
        needlework.to_gsd(walled, out)
        for path, last in ((out, 0), (self.path("state.gsd"), 0), (self.path("run.gsd"), 1)):
            if last:
                needlework.to_gsd(self.run, path)
            with gsd.hoomd.open(path, MODE["r"]) as file:
                self.assertEqual(file[0].log["periodic"].tolist(), [1, 1, last])

    def test_bodies_beyond_the_edges(self):
        scene = support.gas(forces={"gravity": [0, 0, -0.05]})
        scene["walls"] = [{"axis": "z", "side": "low"}]
        out = self.path("open.gsd")
        with needlework.Simulation(scene) as sim:
            sim.run(time=5)
            needlework.to_gsd(sim, out)
            position, box = sim.position, sim.box
        self.assertGreater(position[:, 2].max(), box[2])
        with gsd.hoomd.open(out, MODE["r"]) as file:
            log, found = file[0].log, file[0].particles.position
            self.assertTrue(np.all(np.abs(found) <= file[0].configuration.box[:3] / 2))
            np.testing.assert_array_equal(log["edges"], box)
            np.testing.assert_allclose(found + log["centre"], position, atol=1e-5)

    def test_pistons_leave_their_place(self):
        walls = [{"axis": "z", "side": "low", "motion": {"velocity": 0.5}},
                 {"axis": "z", "side": "high"}]
        sim = needlework.Simulation({"needles": {"count": 50, "box": 5.0}, "walls": walls})
        sim.run(time=2)
        out = self.path("piston.gsd")
        needlework.to_gsd(sim, out)
        with gsd.hoomd.open(out, MODE["r"]) as file:
            box, position = file[0].configuration.box[:3], file[0].particles.position
        np.testing.assert_allclose(box, [5, 5, 4])
        self.assertTrue(np.all(np.abs(position) <= box / 2))
        frame = needlework.from_gsd(out)
        self.assertEqual((list(frame.box), list(frame.low)), ([5, 5, 4], [0, 0, 1]))
        np.testing.assert_allclose(frame.state.position, sim.position, atol=1e-6)
        other = needlework.Simulation({"walls": [{"axis": "z", "side": "both"}]}, **frame.state)
        np.testing.assert_allclose(other.position, sim.position - [0, 0, 1], atol=1e-6)

    def test_one_frame(self):
        out = self.path("last.gsd")
        with needlework.read(self.run) as run:
            self.assertEqual(needlework.to_gsd(run, out, frames=-1), 1)
            with gsd.hoomd.open(out, MODE["r"]) as file:
                self.assert_same(file[0], run.frames[-1])

    def test_state_of_a_simulation(self):
        sim = needlework.Simulation(support.ELASTIC)
        sim.advance(collisions=100)
        out = self.path("now.gsd")
        needlework.to_gsd(sim, out)
        with gsd.hoomd.open(out, MODE["r"]) as file:
            self.assert_same(file[0], sim)
            self.assertEqual(file[0].configuration.step, 100)
            self.assertAlmostEqual(file[0].particles.moment_inertia[0][0], 1 / 12, places=6)

    def test_needles_are_drawn_as_long_as_they_are(self):
        scene = {"needles": {"box": 9}, "species": [{"name": "long", "count": 30, "length": 3}]}
        out = self.path("long.gsd")
        needlework.to_gsd(needlework.Simulation(scene), out)
        with gsd.hoomd.open(out, MODE["r"]) as file:
            shape, = file[0].particles.type_shapes
            self.assertEqual(shape, {"type": "Ellipsoid", "a": 0.06, "b": 0.06, "c": 1.5})

    def test_rods_are_as_wide_as_they_are(self):
        scene = {"needles": {"box": 9}, "species": [
            {"name": "rod", "count": 10, "length": 3, "diameter": 0.5, "inertia": 2},
            {"name": "ball", "count": 5, "length": 0, "diameter": 1.5}]}
        out = self.path("rods.gsd")
        needlework.to_gsd(needlework.Simulation(scene), out)
        with gsd.hoomd.open(out, MODE["r"]) as file:
            snapshot = file[0]
            rod, ball = snapshot.particles.type_shapes
            self.assertEqual(ball, {"type": "Sphere", "diameter": 1.5})
            self.assertEqual(rod["type"], "Mesh")
            self.assertEqual(np.abs(rod["vertices"]).max(axis=0).tolist(), [0.25, 0.25, 1.75])
            np.testing.assert_array_equal(snapshot.particles.diameter, [0.5] * 10 + [1.5] * 5)
            np.testing.assert_array_equal(snapshot.log["length"], [3, 0])
            np.testing.assert_array_equal(snapshot.log["diameter"], [0.5, 1.5])
            np.testing.assert_allclose(snapshot.particles.moment_inertia[[0, 10]],
                                       [[2, 2, 0], [0, 0, 0]])

    def test_capsules_are_closed_and_of_the_right_volume(self):
        length, diameter = 5.0, 2.0
        vertices, triangles = capsule(length, diameter, around=96, rings=24)
        # All vertices are on the surface.
        along = np.clip(vertices[:, 2], -length / 2, length / 2)
        axis = np.stack([0 * along, 0 * along, along], axis=1)
        np.testing.assert_allclose(np.linalg.norm(vertices - axis, axis=1), diameter / 2)
        # Each edge belongs to two triangles, which pass it in opposite directions.
        edges = {(a, b) for t in triangles.tolist() for a, b in zip(t, t[1:] + t[:1])}
        self.assertEqual(len(edges), 3 * len(triangles))
        self.assertEqual({(b, a) for a, b in edges}, edges)
        volume = np.linalg.det(vertices[triangles]).sum() / 6
        self.assertAlmostEqual(volume / (np.pi * (length + 2 * diameter / 3)), 1, delta=2e-3)

    def test_species_are_types(self):
        run = self.path("mixture.h5")
        species = [{"name": "short", "count": 20, "length": 0.5, "mass": 3, "k": 2},
                   {"name": "long", "count": 10, "length": 2}]
        with needlework.Simulation({"needles": {"box": 9}, "species": species,
                                    "output": {"file": run}}) as sim:
            sim.run(time=0.1)
        out = self.path("mixture.gsd")
        needlework.to_gsd(run, out)
        with gsd.hoomd.open(out, MODE["r"]) as file:
            particles = file[-1].particles
            self.assertEqual(particles.types, ["short", "long"])
            np.testing.assert_array_equal(particles.typeid, [0] * 20 + [1] * 10)
            np.testing.assert_array_equal(particles.mass, [3] * 20 + [1] * 10)
            np.testing.assert_array_equal(particles.diameter, [0.5] * 20 + [2] * 10)
            np.testing.assert_allclose(particles.moment_inertia[:, 0],
                                       [3 * 0.25 / 4] * 20 + [4 / 12] * 10, rtol=1e-6)
            self.assertEqual([shape["c"] for shape in particles.type_shapes], [0.25, 1])

    def test_a_frame_is_read_back(self):
        out = self.path("mixture.gsd")
        rods = {"needles": {"box": 9}, "species": [
            {"name": "rod", "count": 10, "length": 3, "diameter": 0.5, "inertia": 2},
            {"name": "ball", "count": 5, "length": 0, "diameter": 1.5, "mass": 0.1}]}
        sim = needlework.Simulation(rods)
        needlework.to_gsd(sim, out)
        frame = needlework.from_gsd(out)
        again = needlework.Simulation(rods, **frame.state)
        np.testing.assert_array_equal(frame.box, [9, 9, 9])
        for name in ("position", "velocity", "orientation", "angular_velocity"):
            np.testing.assert_allclose(getattr(again, name), getattr(sim, name), atol=1e-5)
        self.assertEqual(dict(frame.state.bodies)["name"], ("rod", "ball"))
        silent = needlework.Simulation({"needles": {"box": 9}}, **frame.state)
        self.assertAlmostEqual(silent.totals.t_rot, sim.totals.t_rot, places=5)
        with self.assertRaisesRegex(needlework.InputError, "frame 7: expected one of those"):
            needlework.from_gsd(out, 7)

    def test_rotation_of_hoomd_blue_is_read(self):
        snapshot = SNAPSHOT()
        snapshot.configuration.box = [6, 6, 6, 0, 0, 0]
        particles = snapshot.particles
        particles.N = 1
        particles.types = ["A"]
        particles.type_shapes = [{"type": "Ellipsoid", "a": 0.1, "b": 0.1, "c": 1.0}]
        particles.typeid = [0]
        particles.position, particles.velocity = [[-2, 0, 1]], [[1, 0, 0]]
        particles.mass, particles.moment_inertia = [3.0], [[0.5, 0.5, 0.1]]
        half = np.sqrt(0.5)
        q = np.array([half, half, 0, 0])  # a quarter turn about x: the director is -y
        particles.orientation = [q]
        # 2 q (0, L) with L = (1, 2, 0.3) in the frame of the particle
        w, axis, momentum = q[0], q[1:], np.array([1, 2, 0.3])
        particles.angmom = [[-2 * axis @ momentum, *2 * (w * momentum + np.cross(axis, momentum))]]
        out = self.path("hoomd.gsd")
        with gsd.hoomd.open(out, MODE["w"]) as file:
            file.append(snapshot)
        frame = needlework.from_gsd(out)
        state = frame.state
        np.testing.assert_allclose(state.position, [[1, 3, 4]])
        np.testing.assert_allclose(state.orientation, [[0, -1, 0]], atol=1e-7)
        # L / I = (2, 4) along x and y of the particle, which are x and z of the box
        np.testing.assert_allclose(state.angular_velocity, [[2, 0, 4]], atol=1e-6)
        self.assertEqual({name: value[0] for name, value in state.bodies.items()},
                         {"length": 2, "diameter": 0, "mass": 3, "k": 12})
        self.assertTrue(np.isnan(frame.time))

    def test_bodies_that_differ_are_read_back(self):
        scene = {"needles": {"box": 7.0},
                 "species": [{"name": "a", "count": 30, "mass": {"density": 2},
                              "length": {"distribution": "gamma", "mean": 1, "width": 0.3},
                              "diameter": {"aspect": 4}},
                             {"name": "b", "count": 5, "length": 0, "diameter": 0.5, "fixed": True}]}
        sim, out = needlework.Simulation(scene), self.path("differing.gsd")
        needlework.to_gsd(sim, out)
        with gsd.hoomd.open(out, MODE["r"]) as file:
            particles = file[0].particles
            np.testing.assert_array_equal(particles.mass, sim.mass.astype(np.float32))
            np.testing.assert_array_equal(particles.diameter, sim.diameter.astype(np.float32))
            np.testing.assert_array_equal(particles.moment_inertia[:, 0],
                                          sim.inertia.astype(np.float32))
        state = needlework.from_gsd(out).state
        for name in ("length", "diameter", "mass", "inertia"):
            np.testing.assert_array_equal(state[name], getattr(sim, name))
        again = needlework.Simulation({"needles": {"box": 7.0}}, **state)
        self.assertAlmostEqual(again.totals.energy, sim.totals.energy, places=5)
        self.assertTrue(np.isinf(again.state.bodies.mass[1]))

    def test_particles_of_other_programs_may_differ(self):
        snapshot = SNAPSHOT()
        snapshot.configuration.box = [6, 6, 6, 0, 0, 0]
        particles = snapshot.particles
        particles.N = 2
        particles.types = ["A"]
        particles.type_shapes = [{"type": "Sphere", "diameter": 1.0}]
        particles.typeid = [0, 0]
        particles.position = [[-2, 0, 1], [2, 0, 1]]
        particles.mass, particles.diameter = [3.0, 4.0], [0.8, 1.2]
        out = self.path("hoomd.gsd")
        with gsd.hoomd.open(out, MODE["w"]) as file:
            file.append(snapshot)
        state = needlework.from_gsd(out).state
        sim = needlework.Simulation({"needles": {"box": 6.0}}, **state)
        np.testing.assert_array_equal(sim.mass, [3, 4])
        np.testing.assert_array_equal(sim.diameter, [0.8, 1.2])
        np.testing.assert_array_equal(sim.length, [0, 0])

    def test_sheared_boxes_have_their_tilt(self):
        box = np.array([5.0, 6.0, 7.0])
        for rate in (1.5, -0.8):
            run, out = self.path("sheared.h5"), self.path("sheared.gsd")
            scene = {"needles": {"count": 40, "box": list(box)}, "shear": {"rate": rate},
                     "collisions": {"epsilon": 0.9, "tc_relative": 1e-3},
                     "output": {"file": run, "frames": [0.1, 2.0, 4.3, 9.7]}}
            with needlework.Simulation(scene, force=True) as sim:
                sim.run(time=9.7)
                needlework.to_gsd(sim, out, force=True)
                self.assert_tilted(out, [sim], box, rate)
            needlework.to_gsd(run, out, force=True)
            with needlework.read(run) as recording:
                tilts = self.assert_tilted(out, recording.frames, box, rate)
                self.assertLess(min(tilts), 0)
                self.assertGreater(max(tilts), 0)
                again = needlework.Simulation({**scene, "needles": {"box": list(box)}, "output": {}},
                                              **needlework.from_gsd(out).state)
                np.testing.assert_allclose(again.velocity, recording.frames[-1].velocity, rtol=1e-6,
                                           atol=1e-6)

    def assert_tilted(self, path, frames, box, rate):
        """Centres in the cell, and the same paths in its lattice; returns the tilts."""
        close, tilts = np.testing.assert_allclose, []
        with gsd.hoomd.open(path, MODE["r"]) as file:
            self.assertEqual(len(file), len(frames))
            for number, (snapshot, frame) in enumerate(zip(file, frames)):
                self.assertEqual(snapshot.configuration.box[4:].tolist(), [0, 0])
                tilt = snapshot.configuration.box[3] * box[1]
                tilts.append(tilt)
                self.assertLessEqual(abs(tilt), box[0] / 2)
                cell = np.array([[box[0], 0, 0], [tilt, box[1], 0], [0, 0, box[2]]])
                found = snapshot.particles.position.astype(float)
                self.assertLess(np.abs(found @ np.linalg.inv(cell)).max(), 0.5 + 1e-6)
                paths = found + cell.sum(axis=0) / 2 + snapshot.particles.image @ cell
                slide = frame.state["flow"]["slide"]
                rows = np.array([[box[0], 0, 0], [slide, box[1], 0], [0, 0, box[2]]])
                close(paths, frame.position + frame.image @ rows, atol=2e-5)
                back = needlework.from_gsd(path, number).state
                self.assertEqual(dict(back["flow"]), dict(frame.state["flow"]))
                self.assertAlmostEqual(back["flow"]["shear_rate"], rate, places=12)
                close(back.position + back.image @ rows, paths, atol=2e-5)
        return tilts

    def test_tilts_of_other_programs_are_slides(self):
        snapshot = SNAPSHOT()
        particles = snapshot.particles
        particles.N, particles.types, particles.typeid = 1, ["A"], [0]
        particles.position, particles.velocity = [[-2, 0, 1]], [[1, 0, 0]]
        particles.orientation, particles.image = [[1, 0, 0, 0]], [[3, 2, 1]]
        out = self.path("hoomd.gsd")
        for tilts, expected in (([-0.5, 0, 0], 3.0), ([0, 0.5, 0], "xz = 0.5: expected 0"),
                                ([0, 0, 0.25], "yz = 0.25: expected 0")):
            snapshot.configuration.box = [6, 6, 6, *tilts]
            with gsd.hoomd.open(out, MODE["w"]) as file:
                file.append(snapshot)
            if isinstance(expected, str):
                with self.assertRaisesRegex(needlework.InputError, expected):
                    needlework.from_gsd(out)
                continue
            state = needlework.from_gsd(out).state
            self.assertEqual(state["flow"], {"slide": expected, "shear_rate": 0})
            np.testing.assert_array_equal(state.position, [[-2 + 1.5, 3, 4]])
            np.testing.assert_array_equal(state.image, [[3 - 2, 2, 1]])

    def test_existing_files_are_kept(self):
        out = self.path("run.gsd")
        needlework.to_gsd(self.run, out)
        with self.assertRaisesRegex(needlework.IoError, "exists already: .* force=True"):
            needlework.to_gsd(self.run, out)
        needlework.to_gsd(self.run, out, force=True)

    def test_quaternions_of_directors_along_the_axis(self):
        directors = np.array([[0, 0, 1.0], [0, 0, -1.0], [1, 0, 0], [0, -1, 0], [6e-9, 0, -1]])
        np.testing.assert_allclose(turned(quaternions(directors)), directors, atol=1e-7)


if __name__ == "__main__":
    unittest.main()
