"""Flow and density of fields that are known, and order in cells of needles that are."""

import unittest
from types import SimpleNamespace

import numpy as np
from support import require

require("matplotlib", "h5py")
from needlework.reproduce.cells import (CellFields, density_flow_correlation,  # noqa: E402
                                        flow_in_cells, flow_order, places_in_cells,
                                        strongest_shear_wave)
from needlework.reproduce.large import SLAB, in_slab  # noqa: E402

SIDE = 10


def at_rest():
    return CellFields(np.zeros((SIDE,) * 3), np.zeros((SIDE,) * 3 + (3,)), np.full(3, 12.0))


def wave(axis, number):
    """A wave along an axis, as fields are indexed."""
    along = np.sin(2 * np.pi * number * np.arange(SIDE) / SIDE)
    return along.reshape([SIDE if a == axis else 1 for a in range(3)])


class ShearWave(unittest.TestCase):
    def found(self, fields):
        wave = strongest_shear_wave(fields)
        return wave.gradient, wave.along, wave.number

    def test_of_one_wave_is_that_wave_with_all_the_energy(self):
        fields = at_rest()
        fields.flow[..., 2] = 0.2 * wave(1, 1)
        self.assertEqual(self.found(fields), (1, 2, 1))
        self.assertAlmostEqual(strongest_shear_wave(fields).share, 1, 12)

    def test_is_the_stronger_of_two_with_its_share(self):
        fields = at_rest()
        fields.flow[..., 0] = wave(2, 2)
        fields.flow[..., 1] = 0.5 * wave(0, 1)
        self.assertEqual(self.found(fields), (2, 0, 2))
        self.assertAlmostEqual(strongest_shear_wave(fields).share, 1 / 1.25, 12)

    def test_of_the_shortest_wave_has_all_its_energy_too(self):
        fields = at_rest()
        fields.flow[..., 1] = np.where(np.arange(SIDE) % 2, 1.0, -1.0)[:, None, None]
        self.assertEqual(self.found(fields), (0, 1, 5))
        self.assertAlmostEqual(strongest_shear_wave(fields).share, 1, 12)

    def test_leaves_out_compression(self):
        fields = at_rest()
        fields.flow[..., 0] = wave(0, 1)
        fields.flow[..., 2] = 0.1 * wave(0, 3)
        self.assertEqual(self.found(fields), (0, 2, 3))


class Film(unittest.TestCase):
    def test_has_needles_in_the_middle_with_the_flow_of_their_cells(self):
        # Two needles in one cell, one alone, and one out of the slab.
        frame = SimpleNamespace(
            position=np.array([[0.5, 0.5, 2 - 0.4 * SLAB], [0.2, 0.7, 2 - 0.3 * SLAB],
                               [3.0, 3.0, 2 + 0.4 * SLAB], [1.0, 1.0, 2 + 0.6 * SLAB]]),
            velocity=np.array([[0, 2.0, 0], [0, 4.0, 0], [0, -1.0, 0], [0, 0, 3.0]]),
            box=np.full(3, 4.0))
        chosen, flow = in_slab(frame, (2, 2, 2), 0, 1)
        self.assertEqual(chosen.tolist(), [True, True, True, False])
        thermal = np.sqrt((4 + 16 + 1 + 9) / 4 / 3)
        np.testing.assert_allclose(flow, np.array([3, 3, -1, 0]) / thermal)

    def test_has_no_flow_in_empty_cells(self):
        flow, count = flow_in_cells(np.array([2, 2]), np.array([[1.0, 0, 0], [2.0, 0, 1]]), 3)
        self.assertEqual(count.tolist(), [0, 0, 2])
        np.testing.assert_array_equal(flow, [[0, 0, 1.5], [0, 0, 0], [0, 0, 0.5]])


class Density(unittest.TestCase):
    def test_is_dense_above_one_and_a_half_of_the_mean(self):
        fields = at_rest()
        fields.excess.flat[3:6] = 0.51, 0.5, -0.9
        self.assertEqual(np.flatnonzero(fields.dense).tolist(), [3])

    def test_correlates_with_the_flow_where_the_dense_flows(self):
        fields = at_rest()
        dense = np.arange(SIDE**3).reshape(fields.excess.shape) % 2 == 1
        fields.excess[:] = np.where(dense, 0.4, -0.4)
        fields.flow[..., 1] = np.where(dense, -2.0, 0.5)
        self.assertAlmostEqual(density_flow_correlation(fields), 1, 12)
        fields.excess *= -1
        self.assertAlmostEqual(density_flow_correlation(fields), -1, 12)


class Cells(unittest.TestCase):
    def test_hold_the_positions_of_the_box_and_of_its_edge(self):
        position = np.array([[0, 0, 0], [1.9, 0, 3.1], [4, 4, 4], [0, 2, 0]], dtype=float)
        self.assertEqual(places_in_cells(position, np.full(3, 4.0), (2, 2, 2)).tolist(),
                         [0, 1, 7, 2])

    def test_have_the_order_of_the_flow_by_hand(self):
        # Two cells with means 1 and -2, relative velocities +-1 and +-3; one needle alone.
        position = np.array([[1, 1, 1], [1, 1, 1], [3, 1, 1], [3, 1, 1], [1, 3, 1]], dtype=float)
        velocity = np.zeros((5, 3))
        velocity[:, 0] = 2, 0, 1, -5, 4
        flow, thermal = 2 * 1 + 2 * 4 + 16, 2 * 1 + 2 * 9
        self.assertAlmostEqual(flow_order(position, velocity, np.full(3, 4.0), (2, 2, 2)),
                               flow / thermal)


if __name__ == "__main__":
    unittest.main()
