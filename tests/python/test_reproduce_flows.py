"""What is known of slow pistons and of flows between walls."""

import unittest
from types import SimpleNamespace

import numpy as np
from support import require

require("matplotlib", "h5py")
from needlework.reproduce import flows  # noqa: E402
from needlework.reproduce.runs import Conditions  # noqa: E402


def conditions(box, **scene):
    return Conditions.of({"needles": {"count": 100, "box": box}, **scene})


def piston(box, stop_at):
    return conditions(box, walls=[{}, {"motion": {"velocity": -1, "stop_at": stop_at}}])


class SlowPistons(unittest.TestCase):
    def test_keep_the_adiabat_of_an_ideal_gas(self):
        needles = flows.slow_piston(piston([4, 4, 20.5], 10.5), flows.NEEDLES)
        self.assertAlmostEqual(needles, 2 ** (200 / 498), 12)
        few = flows.slow_piston(piston([1e4, 1e4, 21], 11), flows.SPHERES)
        self.assertAlmostEqual(few, 2 ** (200 / 298), 6)
        # 100 spheres in 10 x 10 x 10 are a packing of pi / 60.
        dense = flows.slow_piston(piston([10, 10, 20], 10), flows.SPHERES)
        self.assertAlmostEqual(dense, (19 / 9) ** (200 / 298) * np.exp(8 / 3 * np.pi / 120), 12)


class Flows(unittest.TestCase):
    place = np.array([-0.25, 0, 0.25])

    def run_of(self, velocity, impulse, **scene):
        """A run of one steady state, with slabs whose middles are `place` in a channel of 8."""
        time = np.arange(11.0)
        fields = {"density": np.full((11, 1, 3), 0.5), "velocity": np.zeros((11, 1, 3, 3)),
                  "t_tr_beside_flow": np.full((11, 1, 3), 4.0), "p2": np.zeros((11, 1, 3)),
                  "position": 8 * (self.place + 0.5), "impulse_x": np.outer(time, impulse)}
        fields["velocity"][..., 0] = velocity
        return SimpleNamespace(series=SimpleNamespace(time=time),
                               conditions=conditions([2, 2, 8], **scene),
                               observable=lambda group, name: fields[name])

    def test_between_sliding_walls_have_the_viscosity_of_stress_over_rate(self):
        # A rate of 1/4 and a stress of 3 / (2 x 2), at a temperature of 4.
        run = self.run_of([-0.5, 0, 0.5], [-3, 3])
        self.assertAlmostEqual(flows._viscosity(run, flows.COUETTE), 0.75 / 0.25 / 2, 12)

    def test_along_a_channel_have_that_of_their_parabola(self):
        # v = 1 - z^2 / 16, n g = 0.5 x 0.1.
        run = self.run_of([0.75, 1, 0.75], [-1, -1], forces={"gravity": [0.1, 0, 0]})
        self.assertAlmostEqual(flows._viscosity(run, flows.CHANNEL), 0.05 / (2 / 16) / 2, 12)

    def test_leave_out_slabs_that_were_empty(self):
        run = self.run_of([-0.5, 0, 0.5], [-3, 3])
        run.observable("", "velocity")[::2, 0, 0] = np.nan
        run.observable("", "density")[::2, 0, 0] = 0
        self.assertAlmostEqual(flows._slabs(run).velocity[0], -0.5, 12)
        # One needle alone has a velocity, and no temperature beside it.
        run.observable("", "t_tr_beside_flow")[::3, 0, 1] = np.nan
        self.assertAlmostEqual(flows._slabs(run).temperature[1], 4, 12)


if __name__ == "__main__":
    unittest.main()
