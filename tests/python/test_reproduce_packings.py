"""Where runs jam whose pressure is known, and what is measured on the way."""

import unittest

import numpy as np
from support import require

require("matplotlib", "h5py")
from needlework.reproduce.packings import (PRESSURES, densest_shape, distances,  # noqa: E402
                                           jam)

END = 0.64


def course(d, of=lambda share: 0):
    """Packing fractions up to a millionth below END and the pressure that diverges there with d,
    and by what this part of the way changes it."""
    share = np.geomspace(1, 1e-6, 200)
    return END * (1 - share), d / share * (1 + of(share))


class Jamming(unittest.TestCase):
    def test_is_where_the_pressure_diverges(self):
        for d in (2.7, 3, 5):
            np.testing.assert_allclose(jam(*course(d)), (END, d), rtol=1e-9)

    def test_is_near_the_last_sample_for_all_noise(self):
        noise = np.random.default_rng(1).uniform(-0.1, 0.1, 200)
        packing, pressure = course(3, lambda _: noise)
        end, d = jam(packing, pressure)
        self.assertAlmostEqual(end / END, 1, 6)
        self.assertAlmostEqual(d / 3, 1, 1)

    def test_does_not_count_the_way_there(self):
        # A gas has Z = 1 + 4 phi, whatever it is that it will end in.
        packing, pressure = course(3, lambda share: np.where(share > 0.009, -0.5, 0))
        np.testing.assert_allclose(jam(packing, pressure), (END, 3), rtol=1e-9)


class Divergence(unittest.TestCase):
    def test_of_each_bin_is_the_mean_of_its_samples(self):
        packing, pressure = course(3)
        np.testing.assert_allclose(distances(packing, pressure, END), 3, rtol=1e-9)
        pair = PRESSURES[:2] * [1.01, 0.99]
        found = distances(END * (1 - np.array([2, 4]) / pair), pair, END)
        self.assertAlmostEqual(found[0], 3, 12)
        self.assertTrue(np.isnan(found[1:]).all())


class Densest(unittest.TestCase):
    def test_shape_is_found_for_each_seed(self):
        found = [(0.2, [0.66, 0.70]), (0.45, [0.70, 0.69]), (1.0, [0.68, 0.68])]
        value, error, seeds = densest_shape(found)
        self.assertAlmostEqual(value, (0.45 + 0.2) / 2, 12)
        self.assertAlmostEqual(error, 0.125, 12)
        self.assertEqual(seeds, 2)


if __name__ == "__main__":
    unittest.main()
