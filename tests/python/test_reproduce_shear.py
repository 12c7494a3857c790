"""Order, its angle and the longest wave of sheared gases that are known."""

import unittest
from types import SimpleNamespace

import numpy as np
from support import require

require("matplotlib", "h5py")
from needlework.reproduce.runs import Conditions  # noqa: E402
from needlework.reproduce.shear import (angle_to_flow, greatest_order, jackknife,  # noqa: E402
                                        longest_wave, predicted_wave)

BOX, SLABS = np.array([3.0, 4.0, 5.0]), 8


def tensor(*directors):
    """Of the nematic order, as files have it."""
    return np.mean([(3 * np.outer(u, u) - np.eye(3)) / 2 for u in directors], axis=0)


def at_angle(degrees):
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0])


class Order(unittest.TestCase):
    def test_of_parallel_needles_has_their_angle(self):
        for degrees in (-80, -30, 0, 25, 89):
            order = tensor(at_angle(degrees))
            self.assertAlmostEqual(angle_to_flow(order), degrees, 10)
            self.assertAlmostEqual(greatest_order(order), 1, 12)

    def test_of_two_needles_has_the_angle_between(self):
        order = tensor(at_angle(10), -at_angle(40))
        self.assertAlmostEqual(angle_to_flow(order), 25, 10)
        self.assertAlmostEqual(greatest_order(order), (1 + 3 * np.cos(np.radians(30))) / 4, 12)

    def test_without_order_on_average_is_smaller_than_that_of_each_seed(self):
        seeds = [tensor(at_angle(0)), tensor(at_angle(90)), tensor([0, 0, 1])]
        self.assertAlmostEqual(jackknife(seeds, greatest_order).value, 0, 12)


class Errors(unittest.TestCase):
    def test_of_a_mean_are_those_over_seeds(self):
        samples = np.array([1.0, 2.0, 4.0, 9.0])
        value, error, seeds = jackknife(samples, float)
        self.assertEqual((value, seeds), (4, 4))
        self.assertAlmostEqual(error, np.std(samples, ddof=1) / 2, 12)

    def test_do_not_jump_where_directors_are_across_the_flow(self):
        seeds = [tensor(at_angle(degrees)) for degrees in (88, 89, 90, 91, 92)]
        self.assertAlmostEqual(jackknife(seeds, angle_to_flow, 180).error, np.sqrt(0.5), 2)

    def test_of_one_seed_are_not_known(self):
        self.assertTrue(np.isnan(jackknife([1.0], float).error))


class Waves(unittest.TestCase):
    def run_with(self, flow, count=600):
        """A run of two samples with this flow along x in slabs across z, density of 10, T_tr = 2,
        and P_yx = -3 by flights and -1 by collisions."""
        density = np.full((2, 3, SLABS), count / np.prod(BOX))
        velocity = np.zeros((2, 3, SLABS, 3))
        velocity[:, 2, :, 0] = flow
        known = {"density": density, "flow": velocity, "kinetic_xx": np.full(2, 20.0),
                 "kinetic_yx": np.full(2, -3.0), "collisional_yx": np.full(2, -1.0)}
        scene = {"needles": {"count": count, "box": BOX.tolist()}, "shear": {"rate": 0.5}}
        return SimpleNamespace(conditions=Conditions.of(scene),
                               observable=lambda _, name: known[name],
                               series=SimpleNamespace(time=np.arange(2.0), t_tr=np.full(2, 2.0)))

    def test_are_found_with_their_energy(self):
        # A flow of a sin(k z) has the amplitude N a / 2; of its slabs the means are a sinc times that.
        sinc = np.sinc(1 / SLABS)
        flow = 0.3 * sinc * np.sin(2 * np.pi * (np.arange(SLABS) + 0.5) / SLABS)
        over = (600 * 0.3 / 2) ** 2 / (600 * 2)
        self.assertAlmostEqual(longest_wave(self.run_with(flow)), 1 + over - 1 / sinc**2, 10)

    def test_of_half_the_length_do_not_count(self):
        flow = 0.3 * np.sin(4 * np.pi * np.arange(SLABS) / SLABS)
        self.assertAlmostEqual(longest_wave(self.run_with(flow)), 1 - 1 / np.sinc(1 / SLABS)**2, 10)

    def test_are_predicted_by_rate_and_viscosity(self):
        nu = 4 / (0.5 * 10)  # -P_yx / (gamma n m)
        expected = 1 + (0.5 / (nu * (2 * np.pi / 5)**2))**2 / 2
        self.assertAlmostEqual(predicted_wave(self.run_with(0)), expected, 12)


if __name__ == "__main__":
    unittest.main()
