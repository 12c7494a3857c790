"""Pictures show what they should: the measured points, the theory and the needles."""

import unittest

from support import InFolder, gas, require

require("matplotlib", "h5py")
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import needlework  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import pyplot  # noqa: E402
from needlework import Simulation, plot, read  # noqa: E402


class Pictures(InFolder):
    def setUp(self):
        super().setUp()
        self.addCleanup(pyplot.close, "all")
        path = self.folder / "run.h5"
        self.sim = Simulation(gas(output={"file": str(path)}))
        samples = [self.sim.totals]
        for time in np.geomspace(0.1, 10, 10):
            self.sim.run(time=time)
            samples.append(self.sim.totals)
        self.series = needlework.Series.of(samples)
        self.sim.close()
        self.recording = read(path)
        self.addCleanup(self.recording.close)

    def test_cooling_has_the_series_and_the_theory(self):
        for axes, series in ((plot.cooling(self.recording), self.recording.series),
                             (plot.cooling(self.series, gas=self.sim.gas), self.series)):
            theory, measured = axes.lines
            np.testing.assert_array_equal(measured.get_xdata(), series.time[1:])
            np.testing.assert_array_equal(measured.get_ydata(),
                                          series.energy[1:] / series.energy[0])
            # 200 needles in one box: the theory is not far away.
            np.testing.assert_allclose(theory.get_ydata(), measured.get_ydata(), rtol=0.3)

    def test_temperature_ratio_starts_with_that_of_the_state(self):
        _, axes = pyplot.subplots()
        self.assertIs(plot.temperature_ratio(self.recording, axes=axes), axes)
        theory, measured = axes.lines
        self.assertAlmostEqual(measured.get_ydata()[0], 1, places=1)
        np.testing.assert_allclose(theory.get_ydata(), measured.get_ydata(), rtol=0.5)

    def test_temperatures_are_those_of_the_series(self):
        axes = plot.temperatures(self.recording)
        _, t_tr, _, t_rot = axes.lines
        np.testing.assert_array_equal(t_tr.get_ydata(), self.recording.series.t_tr[1:])
        np.testing.assert_array_equal(t_rot.get_ydata(), self.recording.series.t_rot[1:])
        self.assertEqual(len(axes.get_legend().get_texts()), 3)

    def test_rough_spheres_have_the_energy_of_their_rotation(self):
        path = self.folder / "spheres.h5"
        sphere = {"length": 0, "diameter": 1.0}
        with Simulation({"needles": {"box": 9.0},
                         "collisions": {"epsilon": 0.9, "beta": 0, "tc_relative": 1e-3},
                         "species": [{"name": "one", "count": 60, **sphere},
                                     {"name": "other", "count": 60, **sphere}],
                         "output": {"file": str(path)}}) as sim:
            sim.run(time=2)
        with read(path) as recording:
            all_of, _, of_one, _, of_other, _ = plot.cooling(recording).lines
            one, ratio = plot.temperatures(recording), plot.temperature_ratio(recording)
        for line in (of_one, of_other):  # alike
            np.testing.assert_allclose(line.get_ydata(), all_of.get_ydata(), rtol=0.05)
        for axes in (one, ratio):
            self.assertTrue(np.all(np.isfinite(axes.lines[0].get_ydata())))

    def test_spheres_have_no_ratio_of_temperatures(self):
        sim = Simulation({"needles": {"box": 6.0},
                          "species": [{"name": "balls", "count": 20, "length": 0,
                                       "diameter": 1.0}]})
        self.addCleanup(sim.close)
        samples = [sim.totals]
        sim.run(time=0.1)
        series = needlework.Series.of([*samples, sim.totals])
        with self.assertRaisesRegex(needlework.InputError, "spheres do not rotate"):
            plot.temperature_ratio(series, gas=sim.gas)
        theory, measured = plot.cooling(series, gas=sim.gas).lines
        self.assertEqual(len(theory.get_xdata()), len(measured.get_xdata()))

    def test_nothing_is_cut_off_and_labels_within_a_decade_are_plain(self):
        for picture in (plot.cooling, plot.temperature_ratio):
            axes = picture(self.recording)
            axes.figure.canvas.draw()
            inside, whole = axes.get_tightbbox(), axes.figure.bbox
            self.assertGreaterEqual(inside.x0, whole.x0)
            self.assertGreaterEqual(inside.y0, whole.y0)
            low, high = axes.get_ylim()
            self.assertLess(high, 10 * low)
            labels = [label.get_text() for label in axes.get_yticklabels()]
            self.assertGreater(len(labels), 2)
            for label in labels:
                self.assertRegex(label, r"^\d+\.\d+$")
            self.assertEqual([label.get_text() for label in axes.get_yticklabels(minor=True)], [])

    def test_labels_over_decades_are_powers_of_ten(self):
        axes = plot.cooling(self.recording)
        axes.figure.canvas.draw()
        self.assertIn("10^", axes.get_xticklabels()[0].get_text())

    def test_needles_are_lines_of_their_length(self):
        for state in (self.sim, self.recording.frames[0]):
            lines, = plot.needles(state).collections
            ends = np.array(lines._segments3d)
            self.assertEqual(ends.shape, (200, 2, 3))
            np.testing.assert_allclose(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), 1)

    def test_needles_that_differ_are_as_long_as_they_are(self):
        sim = needlework.Simulation({"needles": {"box": 6.0}, "species": [
            {"name": "a", "count": 20,
             "length": {"distribution": "uniform", "mean": 1, "width": 0.3}}]})
        ends = np.array(plot.needles(sim).collections[0]._segments3d)
        np.testing.assert_allclose(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), sim.length)

    def test_spheres_are_discs_beside_needles(self):
        sim = needlework.Simulation({"needles": {"box": 6.0}, "species": [
            {"name": "rods", "count": 20, "diameter": 0.1},
            {"name": "balls", "count": 10, "length": 0, "diameter": 0.5},
            {"name": "large", "count": 5, "length": 0, "diameter": 1}]})
        lines, discs = plot.needles(sim).collections
        self.assertEqual(len(lines._segments3d), 20)
        self.assertEqual(len(discs.get_array()), 15)
        areas = np.sort(discs.get_sizes())
        np.testing.assert_allclose(areas[10:], 4 * areas[0])

    def test_theory_of_bodies_with_a_width_is_that_of_low_density(self):
        def label_of(species):
            sim = Simulation({"needles": {"box": 6.0}, "species": [{"name": "a", "count": 20,
                                                                    **species}]})
            self.addCleanup(sim.close)
            samples = [sim.totals]
            sim.run(time=0.1)
            series = needlework.Series.of([*samples, sim.totals])
            return plot.cooling(series, gas=sim.gas).lines[0].get_label()

        self.assertEqual(label_of({"length": 0, "diameter": 1.0}), "kinetic theory at low density")
        self.assertEqual(label_of({"diameter": 0.1}), "kinetic theory at low density")
        self.assertEqual(label_of({}), "kinetic theory")

    def test_needles_in_a_flow_are_coloured_by_their_speeds_beside_it(self):
        path = self.folder / "sheared.h5"
        sim = Simulation({"needles": {"count": 20, "box": 6.0}, "shear": {"rate": 2.0},
                          "output": {"file": str(path)}})
        sim.run(time=1)
        speed = np.linalg.norm(sim.peculiar_velocity, axis=1)
        sim.close()
        with read(path) as recording:
            lines, = plot.needles(recording.frames[-1]).collections
        np.testing.assert_allclose(lines.get_array(), speed, rtol=1e-9)

    def test_needles_of_something_else_say_what_is_expected(self):
        for other in (self.recording, self.recording.path):
            with self.assertRaisesRegex(needlework.InputError, "expected a Simulation or a frame"):
                plot.needles(other)

    def test_a_path_is_read(self):
        for read_here, read_before in zip(plot.cooling(self.recording.path).lines,
                                          plot.cooling(self.recording).lines):
            np.testing.assert_array_equal(read_here.get_xydata(), read_before.get_xydata())

    def test_a_series_alone_needs_the_gas(self):
        with self.assertRaisesRegex(needlework.InputError, "gas is missing"):
            plot.cooling(self.series)


class PicturesOfAMixture(InFolder):
    def setUp(self):
        super().setUp()
        self.addCleanup(pyplot.close, "all")
        self.path = self.folder / "run.h5"
        species = [{"name": "light", "count": 60, "diameter": 0.1},
                   {"name": "heavy", "count": 30, "diameter": 0.1, "mass": 5.0},
                   {"name": "balls", "count": 30, "diameter": 0.4, "length": 0}]
        scene = gas(output={"file": str(self.path)}, until={"collisions_per_needle": 3})
        scene["needles"] = {"box": 8.0, "seed": 3}
        with Simulation({**scene, "species": species}) as sim:
            sim.run()
        with read(self.path) as recording:
            self.series, self.sums = recording.series, recording.observable("species")

    def measured(self, axes):
        """The points by their names in the legend, beside how many lines of theory there are."""
        named = {text.get_text() for text in axes.get_legend().get_texts()}
        points = {line.get_label(): line for line in axes.lines if line.get_marker() == "o"}
        self.assertEqual(named, {*points, "kinetic theory at low density"})
        self.assertEqual(len(axes.lines), 2 * len(points))
        self.assertEqual(len({(line.get_color(), line.get_markerfacecolor())
                              for line in points.values()}), len(points))
        return points

    def test_energy_is_that_of_each_species(self):
        points = self.measured(plot.cooling(self.path))
        self.assertEqual(list(points), ["120 needles", "light", "heavy", "balls"])
        energy = 1.5 * self.sums.t_tr + self.sums.t_rot
        for n, name in enumerate(("light", "heavy", "balls")):
            np.testing.assert_array_equal(points[name].get_ydata(),
                                          energy[1:, n] / self.series.energy[0])

    def test_temperatures_are_those_of_each_species_that_turns(self):
        points = self.measured(plot.temperatures(self.path))
        self.assertEqual(len(points), 2 + 2 + 2 + 1)
        np.testing.assert_array_equal(points[r"$T_{\rm rot}$ of heavy"].get_ydata(),
                                      self.sums.t_rot[1:, 1])
        self.assertNotIn(r"$T_{\rm rot}$ of balls", points)

    def test_the_ratio_of_temperatures_is_that_of_each_species_that_turns(self):
        points = self.measured(plot.temperature_ratio(self.path))
        self.assertEqual(list(points), ["120 needles", "light", "heavy"])
        np.testing.assert_array_equal(points["light"].get_ydata(),
                                      self.sums.t_tr[1:, 0] / self.sums.t_rot[1:, 0])


class PicturesOfRoughSpheres(InFolder):
    def test_rotation_has_three_components(self):
        self.addCleanup(pyplot.close, "all")
        path = self.folder / "run.h5"
        scene = gas(output={"file": str(path)}, until={"collisions_per_needle": 3})
        scene["needles"] = {"box": 8.0, "seed": 3}
        scene["collisions"] = {"epsilon": 0.9, "beta": 0.5}
        species = [{"name": "solid", "count": 60, "length": 0, "diameter": 0.5},
                   {"name": "hollow", "count": 60, "length": 0, "diameter": 1, "inertia": 1 / 6}]
        with Simulation({**scene, "species": species}) as sim:
            sim.run()
        lines = plot.cooling(path).lines
        _, of_all, _, solid, _, hollow = (line.get_ydata() for line in lines)
        np.testing.assert_allclose((solid + hollow) / 2, of_all, rtol=1e-12)
        for line in (*plot.temperatures(path).lines, *plot.temperature_ratio(path).lines):
            self.assertTrue(np.all(line.get_ydata() > 0))


class PicturesWithoutTheory(InFolder):
    """Of bodies that differ within a species, of fixed ones, and of gases that more than collisions
    acts on, whose cooling no theory follows."""

    def setUp(self):
        super().setUp()
        self.addCleanup(pyplot.close, "all")

    def recorded(self, *species, **effects):
        path = self.folder / "run.h5"
        scene = gas(output={"file": str(path)}, until={"collisions_per_needle": 3})
        scene["needles"] = {"box": 8.0, "seed": 3}
        with Simulation({**scene, **effects, "species": list(species)}, force=True) as sim:
            sim.run()
            return path, sim.gas

    def assert_points_alone(self, axes, names):
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], names)
        self.assertEqual([line.get_label() for line in axes.lines], names)
        self.assertTrue(all(len(line.get_xdata()) > 3 for line in axes.lines))

    def test_lengths_that_differ_have_points_alone(self):
        path, of_run = self.recorded({"name": "a", "count": 60,
                                      "length": {"distribution": "gamma", "mean": 1, "width": 0.4}})
        self.assertTrue(of_run.differ)
        with read(path) as recording:
            self.assertTrue(recording.gas.differ)
            series = recording.series
        self.assert_points_alone(plot.cooling(path), ["60 needles"])
        self.assert_points_alone(plot.cooling(series, gas=of_run), ["60 needles"])
        self.assert_points_alone(plot.temperature_ratio(path), ["60 needles"])
        self.assert_points_alone(plot.temperatures(path), [r"$T_{\rm tr}$ of 60 needles",
                                                           r"$T_{\rm rot}$ of 60 needles"])
        with self.assertRaisesRegex(needlework.InputError, "differ within a species"):
            needlework.theory.mixture_rates(of_run, 1, 1)

    def test_what_is_sheared_grows_or_is_driven_has_points_alone(self):
        for effects in ({"shear": {"rate": 0.5}}, {"driving": {"growth": {"rate": 0.01}}},
                        {"driving": {"andersen": {"rate": 1.0, "temperature": 1.0}}},
                        {"walls": [{"axis": "z", "side": "both"}]}):
            with self.subTest(effects):
                path, of_run = self.recorded({"name": "balls", "count": 60, "length": 0,
                                              "diameter": 0.5}, **effects)
                self.assertEqual(of_run.undisturbed_until, 0)
                with read(path) as recording:
                    self.assertEqual(recording.gas.undisturbed_until, 0)
                    series = recording.series
                self.assert_points_alone(plot.cooling(path), ["60 needles"])
                self.assert_points_alone(plot.cooling(series, gas=of_run), ["60 needles"])

    def test_a_mixture_with_fixed_ones_has_points_of_those_that_move(self):
        path, of_run = self.recorded({"name": "light", "count": 60},
                                     {"name": "still", "count": 40, "fixed": True})
        self.assertFalse(of_run.differ)
        self.assert_points_alone(plot.cooling(path), ["100 needles", "light"])
        self.assert_points_alone(plot.temperature_ratio(path), ["100 needles", "light"])
        with self.assertRaisesRegex(needlework.InputError, "fixed bodies"):
            needlework.theory.mixture_cooling(of_run, 1, 1, [1.0])


if __name__ == "__main__":
    unittest.main()
