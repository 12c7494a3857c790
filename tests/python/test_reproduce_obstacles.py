"""What is exact of bodies among fixed ones, slopes and minima, and displacements that are known."""

import unittest
from types import SimpleNamespace

import numpy as np
from support import require

require("matplotlib", "h5py")
from needlework.reproduce.obstacles import (KEPT, SPEED, Dilute, displacement,  # noqa: E402
                                            least_at, local_slope)


class DiluteBodies(unittest.TestCase):
    def test_collide_at_the_rates_that_are_known(self):
        self.assertAlmostEqual(Dilute.among_needles(6).rate, 0.864895165, 9)
        self.assertAlmostEqual(Dilute.among_needles(2).rate, 0.719272957, 9)
        for radius, rate in ((0.05, 0.194400673), (0.1, 0.431644626), (0.2, 1.034662371),
                             (0.5, 3.871954323)):
            self.assertAlmostEqual(Dilute.among_spheres(6, radius).rate, rate, 8)
        self.assertAlmostEqual(Dilute.of_points(0.5).rate, np.pi / 4 * np.sqrt(8 / np.pi), 12)

    def test_forget_their_velocities_as_they_collide(self):
        # <1 / sqrt(1 + 12 x^2)> is arsinh(sqrt 3) / sqrt 3.
        mean = np.arcsinh(np.sqrt(3)) / np.sqrt(3)
        self.assertAlmostEqual(Dilute.among_needles(6).decay, 4 / 3 * np.sqrt(np.pi / 8) * mean, 12)
        # A sphere sends points into all directions alike: at each speed the decay is the rate, and
        # of all, weighted with v^2, 4/3 of it.
        points = Dilute.of_points(0.3)
        self.assertAlmostEqual(points.decay / points.rate, 4 / 3, 12)
        # Large spheres meet ends of needles alone: <1 / sqrt(1 + 3 (1 - c^2))>.
        large = Dilute.among_spheres(6, 1e6)
        end = np.arcsin(np.sqrt(3 / 4)) / np.sqrt(3)
        self.assertAlmostEqual(large.decay * np.sqrt(2 * np.pi) / (4e12 * np.pi) / (4 / 3 * end), 1,
                               5)

    def test_have_means_of_their_energies(self):
        e = np.linspace(0, 60, 600001)[1:]
        for degrees in (3, 5):
            weight = e**(degrees / 2 - 1) * np.exp(-e)
            half, one, more = (np.sum(weight * e**power) / weight.sum() for power in (0.5, 1, 1.5))
            self.assertAlmostEqual(SPEED[degrees], half, 5)
            self.assertAlmostEqual(KEPT[degrees], half * more / one**2, 5)
        # So points diffuse as Lorentz has it, v / (3 n pi R^2).
        self.assertAlmostEqual(KEPT[3] / Dilute.of_points(1).decay,
                               np.sqrt(8 / np.pi) / (3 * np.pi), 12)


class Slopes(unittest.TestCase):
    def test_of_a_power_law_are_its_power(self):
        slope, error = local_slope((2, 6), (2.0**-1.3, 6.0**-1.3), (0, 0.01 * 6.0**-1.3))
        self.assertAlmostEqual(slope, -1.3, 12)
        self.assertAlmostEqual(error, 0.01 / np.log(3), 12)

    def test_vanish_where_it_is_least(self):
        density = [4, 8, 16, 32, 64]
        values = [[np.exp(height + np.log(n / least)**2) for least, height in ((20, 0), (24, 1))]
                  for n in density]
        value, error, seeds = least_at(density, values)
        self.assertAlmostEqual(value, 22, 10)
        self.assertAlmostEqual(error, 2, 10)
        self.assertEqual(seeds, 2)

    def test_have_no_least_value_at_an_end(self):
        self.assertTrue(np.isnan(least_at([1, 2, 4], [[3.0, 3.0], [2.0, 2.0], [1.0, 1.0]]).value))


class Displacements(unittest.TestCase):
    def test_are_of_those_that_move(self):
        # Of two species, the second fixed, and lags of which some have no value at a sample.
        nan = np.nan
        lag = np.array([[0, nan], [1, nan], [1, 2]])
        known = {"lag": lag, "parallel": 3 * lag**2, "perpendicular": lag**2}
        run = SimpleNamespace(observable=lambda _, name: np.stack(
            [known[name], lag if name == "lag" else 0 * lag], axis=1))
        found = displacement(run)
        np.testing.assert_allclose(found, ([2 / 3, 2], [8 / 3, 16]))


if __name__ == "__main__":
    unittest.main()
