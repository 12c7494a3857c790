"""Kinetic theory: the same numbers as the program, arrays, and ranges."""

import json
import unittest

import numpy as np
from needlework import InputError, theory

from support import printed_by



class Theory(unittest.TestCase):
    def test_numbers_are_those_of_the_program(self):
        taus = [0, 0.5, 3, 100]
        printed = printed_by("theory", "--epsilon", "0.8", "--k", "6", "--beta", "0.3", "--t-rot0", "0",
             "--json", *(part for tau in taus for part in ("--tau", str(tau))))
        expected = json.loads(printed)
        curve = theory.cooling(0.8, 6, beta=0.3, t_rot0=0, tau=taus)
        for name in ("tau", "t_tr", "t_rot", "energy"):
            np.testing.assert_array_equal(curve[name], expected[name])
        self.assertEqual(theory.ratio(0.8, 6, 0.3), expected["c"])

    def test_rate_is_that_of_the_temperatures(self):
        # Needles that do not rotate: n sqrt(pi)/2 sqrt(T), as the integral is 1.
        self.assertAlmostEqual(theory.collision_rate(6, 0.7, 4, 0), 0.7 * np.sqrt(np.pi),
                               places=13)
        rates = theory.collision_rate(6, np.array([[1.0], [2.0]]), [1.0, 4.0, 9.0], 0)
        np.testing.assert_allclose(rates, np.sqrt(np.pi) / 2 * np.outer([1, 2], [1, 2, 3]))

    def test_rates_of_finite_gases_between_walls(self):
        factor = theory.factor_between_walls(6, [2, 2.5])
        np.testing.assert_allclose(factor, [2 * (2 - 0.753889) / 2.25, 2.5 * (2.5 - 0.753889) / 4],
                                   rtol=2e-6)
        periodic, walled = theory.equilibrium_rate(6, 1e6, 1e6, 2.5e6, [3, 2])
        self.assertAlmostEqual(periodic, float(theory.collision_rate(6, 1)), places=5)
        self.assertLess(walled, periodic)

    def test_diffusion_is_that_of_the_program_and_takes_arrays(self):
        printed = printed_by("theory", "--epsilon", "1", "--k", "6", "--density", "8", "--json")
        expected = json.loads(printed)["diffusion"]
        diffusion = theory.diffusion(6, [[8.0], [16.0]], [1.0, 4.0])
        for name, value in expected.items():
            self.assertEqual(diffusion[name].shape, (2, 2))
            self.assertEqual(diffusion[name][0, 0], value)
        np.testing.assert_allclose(diffusion.d, expected["d"] * np.array([[1, 2], [0.5, 1]]))
        with self.assertRaisesRegex(InputError, "^n = -1: expected"):
            theory.diffusion(6, -1)
        with self.assertRaisesRegex(InputError, "^temperature = 0: expected"):
            theory.diffusion(6, 1, 0)

    def test_ratio_takes_arrays_and_is_one_at_equipartition(self):
        ratios = theory.ratio([0.2, 0.9], theory.equipartition_k())
        np.testing.assert_allclose(ratios, 1, rtol=1e-10)
        self.assertTrue(np.isnan(theory.ratio(1, 6)))

    def test_a_table_has_columns_as_attributes_and_in_pandas(self):
        curve = theory.cooling(0.8, 6, tau=np.geomspace(0.1, 10, 5))
        self.assertEqual(curve.rows, 5)
        self.assertIs(curve.energy, curve["energy"])
        np.testing.assert_allclose(curve.energy, 1.5 * curve.t_tr + curve.t_rot)
        self.assertTrue(np.all(np.diff(curve.collisions_per_needle) > 0))
        self.assertIn("<table>", curve._repr_html_())

    def test_ranges_are_checked(self):
        for call, message in ((lambda: theory.cooling(2, 6, tau=[1]), "epsilon = 2: expected"),
                              (lambda: theory.collision_rate(-1, 1), "k = -1: expected"),
                              (lambda: theory.collision_rate(6, -1), "^n = -1: expected"),
                              (lambda: theory.equilibrium_rate(6, 9, 1, -1),
                               "^energy = -1: expected"),
                              (lambda: theory.equilibrium_rate(6, 9, 1, 1, 2.5),
                               "^conserved = 2.5: expected a whole number from 0 to 3"),
                              (lambda: theory.factor_between_walls(6, 0.9),
                               "gap = 0.9: expected"),
                              (lambda: theory.cooling(0.5, 6, tau="x"), "tau: expected an array"),
                              (lambda: theory.cooling(0.5, 6, tau=[-1]), "tau.* = -1: expected")):
            with self.assertRaisesRegex(InputError, message):
                call()


if __name__ == "__main__":
    unittest.main()
