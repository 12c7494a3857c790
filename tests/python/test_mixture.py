"""Several species: totals, states, files and theory by species."""

import json
import tempfile
import unittest
from pathlib import Path

from support import InFolder, printed_by, require

require("h5py")
import needlework  # noqa: E402
import numpy as np  # noqa: E402
from needlework import InputError, Simulation, read, theory  # noqa: E402

SPECIES = [{"name": "short", "count": 150, "length": 0.5, "mass": 0.5, "k": 3, "t_rot": 0.25},
           {"name": "rod", "count": 50, "length": 1.5, "mass": 2.0, "t_tr": 2}]
MIXTURE = {
    "needles": {"box": 6},
    "collisions": {"epsilon": 0.9, "tc_relative": 1e-3},
    "species": SPECIES,
    "pairs": [{"between": ["short", "rod"], "epsilon": 0.7, "beta": 0.5}],
}


def mixture(**sections):
    return {**MIXTURE, **sections}


def given(*unwanted):
    """The scene for a state that is given, without these keys of its species."""
    return mixture(species=[{key: value for key, value in each.items() if key not in unwanted}
                            for each in SPECIES])


def temperatures(sim, index):
    """Those of a species, from its needles."""
    of = sim.species == index
    mass, length, k = (sim.gas[name][index] for name in ("mass", "length", "k"))
    return (mass * np.sum(sim.velocity[of]**2) / (3 * of.sum()),
            mass * length**2 / (2 * k) * np.sum(sim.angular_velocity[of]**2) / (2 * of.sum()))


class Mixture(unittest.TestCase):
    def test_totals_are_by_name_and_those_of_the_needles(self):
        sim = Simulation(MIXTURE)
        sim.run(collisions=500)
        self.assertEqual(list(sim.species_totals), ["short", "rod"])
        self.assertEqual([totals.count for totals in sim.species_totals.values()], [150, 50])
        np.testing.assert_array_equal(sim.species, [0] * 150 + [1] * 50)
        for index, totals in enumerate(sim.species_totals.values()):
            t_tr, t_rot = temperatures(sim, index)
            self.assertAlmostEqual(totals.t_tr, t_tr, places=12)
            self.assertAlmostEqual(totals.t_rot, t_rot, places=12)
        self.assertEqual(list(sim.collisions_by_pair), ["short-short", "short-rod", "rod-rod"])
        self.assertEqual(sum(sim.collisions_by_pair.values()), 500)
        self.assertGreater(sim.collisions_by_pair["short-rod"], 50)

    def test_species_may_pass_through_each_other(self):
        pairs = [{"between": ["short", "rod"], "meet": False}]
        sim = Simulation(mixture(pairs=pairs))
        sim.run(collisions=100)
        np.testing.assert_array_equal(sim.gas.meet, [[1, 0], [0, 1]])
        self.assertEqual(sim.collisions_by_pair["short-rod"], 0)
        rates = theory.mixture_rates(sim.gas, [1, 2], [0.25, 1])
        self.assertEqual(rates.collisions[0, 1], 0)
        self.assertGreater(rates.collisions[0, 0], 0)
        self.assertNotIn("meet", Simulation(MIXTURE).gas)

    def test_gas_has_properties_by_species(self):
        gas = Simulation(MIXTURE).gas
        self.assertEqual(gas.species, ("short", "rod"))
        np.testing.assert_array_equal(gas.counts, [150, 50])
        np.testing.assert_array_equal(gas.length, [0.5, 1.5])
        np.testing.assert_array_equal(gas.mass, [0.5, 2])
        np.testing.assert_array_equal(gas.k, [3, 6])
        np.testing.assert_array_equal(gas.epsilon, [[0.9, 0.7], [0.7, 0.9]])
        np.testing.assert_array_equal(gas.beta, [[-1, 0.5], [0.5, -1]])

    def test_a_state_starts_another_simulation_in_any_order(self):
        sim = Simulation(MIXTURE)
        sim.run(collisions=100)
        other = Simulation(given("t_tr", "t_rot"), **sim.state)
        np.testing.assert_array_equal(other.species, sim.species)
        np.testing.assert_array_equal(other.velocity, sim.velocity)
        order = np.random.default_rng(3).permutation(200)
        mixed = Simulation(given("t_tr", "t_rot", "count"),
                           **{name: values[order] for name, values in sim.state.items()})
        other.run(collisions=200)
        mixed.run(collisions=200)
        self.assertEqual(mixed.hash, other.hash)
        self.assertEqual(mixed.collisions_by_pair, other.collisions_by_pair)

    def test_species_that_do_not_fit_are_refused(self):
        sim = Simulation(MIXTURE)
        plain = given("t_tr", "t_rot")
        wrong = {"species": np.zeros(200, int)}, {"species": [0.5] * 200}, {"species": [0, 1]}
        for change, expected in zip(wrong, ("species.count = 150 of short: expected 200, as in the state",
                                            "whole number from 0 to 254", r"expected \(200,\)")):
            with self.assertRaisesRegex(InputError, expected):
                Simulation(plain, **{**sim.state, **change})

    def test_one_species_has_species_too(self):
        sim = Simulation({"needles": {"count": 20, "box": 5}})
        sim.run(collisions=5)
        np.testing.assert_array_equal(sim.species, np.zeros(20))
        self.assertEqual(sim.species_totals[""].t_tr, sim.totals.t_tr)
        self.assertEqual(list(sim.collisions_by_pair.values()), [5])


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name, "run.h5")
        with Simulation(mixture(output={"file": str(cls.path), "frames": [0.5]})) as sim:
            sim.run(time=1)
            cls.sim = sim

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.run_ = read(self.path)
        self.addCleanup(self.run_.close)

    def test_hold_the_gas_and_the_species_of_needles(self):
        for name, value in self.sim.gas.items():
            np.testing.assert_array_equal(self.run_.gas[name], value, err_msg=name)
        np.testing.assert_array_equal(self.run_.frames[-1].species, self.sim.species)
        np.testing.assert_array_equal(self.run_.frames[-1].state.species, self.sim.species)

    def test_frames_start_simulations(self):
        frame = self.run_.frames[-1]
        again = Simulation(given("t_tr", "t_rot", "count"), **frame.state)
        np.testing.assert_array_equal(again.velocity, self.sim.velocity)
        self.assertEqual(again.species_totals["rod"].count, 50)

    def test_series_by_species_end_with_the_totals(self):
        series = self.run_.observable("species")
        samples = self.run_.series.rows
        self.assertEqual(series.t_tr.shape, (samples, 2))
        self.assertEqual(series.collisions.shape, (samples, 3))
        totals = list(self.sim.species_totals.values())
        np.testing.assert_array_equal(series.t_tr[-1], [each.t_tr for each in totals])
        np.testing.assert_array_equal(series.t_rot[-1], [each.t_rot for each in totals])
        np.testing.assert_array_equal(series.collisions[-1],
                                      list(self.sim.collisions_by_pair.values()))
        np.testing.assert_array_equal(series.collisions.sum(axis=1), self.run_.series.collisions)

    def test_a_run_that_is_continued_has_the_file_of_the_whole_one(self):
        import h5py
        names = ["fields", "flow_order", "distributions", "pair_correlation", "structure_factor",
                 "displacement", "collision_statistics"]
        files = []
        for name, cut in (("whole.h5", None), ("parts.h5", 0.4)):
            files.append(Path(self.folder.name, name))
            sim = Simulation(mixture(output={"file": str(files[-1]), "observables": names}))
            if cut:
                sim.run(time=cut)
                sim.checkpoint()
                sim.run(time=0.7)
                del sim
                sim = Simulation.resume(files[-1])
                self.assertEqual(sim.gas.species, ("short", "rod"))
            sim.run(time=1)
            sim.close()
        with h5py.File(files[0]) as whole, h5py.File(files[1]) as parts:
            seen = []
            whole.visititems(lambda name, item: seen.append(name)
                             if isinstance(item, h5py.Dataset) else None)
            self.assertIn("series/collision_statistics/chains/value", seen)
            for name in seen:
                if name != "parameters/scene":
                    np.testing.assert_array_equal(whole[name][()], parts[name][()], err_msg=name)

    def test_plots_are_beside_the_theory_of_the_mixture(self):
        require("matplotlib")
        import matplotlib
        matplotlib.use("Agg")
        lines = needlework.plot.cooling(self.run_).lines
        # Theory and engine of all, then of each species, of which there are fewer needles.
        self.assertEqual(len(lines), 2 * (1 + len(self.run_.gas.species)))
        for n in range(0, len(lines), 2):
            curve, measured = lines[n], lines[n + 1]
            np.testing.assert_array_equal(curve.get_xdata(), measured.get_xdata())
            np.testing.assert_allclose(curve.get_ydata(), measured.get_ydata(),
                                       rtol=0.1 if n == 0 else 0.25)
        with self.assertRaisesRegex(InputError, "expected the file of its run"):
            needlework.plot.cooling(self.run_.series, gas=self.run_.gas)


class Theory(InFolder):
    GAS = {"counts": [800, 200], "box": 10, "length": [1, 0.5], "mass": [1, 0.25], "k": [6, 3],
           "epsilon": [[0.9, 0.6], [0.6, 1]]}

    def test_one_species_twice_is_that_species(self):
        halves = {"counts": [300, 700], "box": [10, 10, 10], "k": 4, "epsilon": 0.8}
        times = [3, 0.5, 20]
        mixture = theory.mixture_cooling(halves, 1, 0.5, times)
        one = theory.cooling(0.8, 4, t_rot0=0.5, tau=theory.tau(times, 1))
        # A species of N needles has N - 1 partners of its own, so that two halves lack some pairs.
        np.testing.assert_allclose(mixture.t_tr[:, 0], one.t_tr, rtol=3e-3)
        np.testing.assert_allclose(mixture.t_rot[:, 1], one.t_rot, rtol=3e-3)
        np.testing.assert_allclose(mixture.energy, one.energy, rtol=3e-3)

    def test_cooling_follows_the_rates(self):
        rates = theory.mixture_rates(self.GAS, [1, 2], [0.5, 1])
        step = 1e-5
        later = theory.mixture_cooling(self.GAS, [1, 2], [0.5, 1], step)
        np.testing.assert_allclose(later.t_tr[0], [1, 2] + step * rates.t_tr, rtol=1e-8)
        np.testing.assert_allclose(later.t_rot[0], [0.5, 1] + step * rates.t_rot, rtol=1e-8)
        np.testing.assert_array_equal(rates.collisions, rates.collisions.T)

    def test_numbers_that_cannot_be_are_named(self):
        for change, expected in (({"length": [1, 2, 3]}, r"length: shape \(3,\): expected \(2,\)"),
                                 ({"mass": 0}, "mass = 0: expected numbers > 0"),
                                 ({"epsilon": 1.5}, "epsilon = 1.5: expected a number from 0 to 1"),
                                 ({"beta": [[0, 1], [0.5, 0]]}, "beta: .* symmetric"),
                                 ({"box": [1, 2]}, "box = .*: expected one or three edges"),
                                 ({"counts": [1.5, 2]}, r"counts\[0\] = 1.5: expected a whole")):
            with self.assertRaisesRegex(InputError, expected):
                theory.mixture_rates({**self.GAS, **change}, 1, 1)
        with self.assertRaisesRegex(InputError, r"t_tr: shape \(3,\)"):
            theory.mixture_rates(self.GAS, [1, 1, 1], 1)
        with self.assertRaises(InputError):
            theory.mixture_cooling(self.GAS, 1, 1, [-1])
        with self.assertRaisesRegex(InputError, "length = 0: .* or a diameter > 0"):
            theory.mixture_rates({**self.GAS, "length": 0}, 1, 1)

    def test_gas_of_rods_has_their_diameter(self):
        # The theory of needles would be another one.
        bodies = ([{"name": "rod", "count": 20, "length": 2, "diameter": 0.4}],
                  [{"name": "rod", "count": 20, "length": 2, "diameter": 0.4},
                   {"name": "ball", "count": 10, "length": 0, "diameter": 0.6}])
        for species in bodies:
            file = self.folder / f"{len(species)}.h5"
            with needlework.Simulation({"needles": {"box": 8}, "species": species,
                                        "output": {"file": str(file)}}) as sim:
                sim.run(time=0.1)
                gas = sim.gas
            with needlework.read(file) as run:
                recorded = run.gas
            given = {"box": [8, 8, 8], "counts": [each["count"] for each in species],
                     **{name: [each[name] for each in species]
                        for name in ("length", "diameter")}}
            expected = theory.mixture_rates(given, 1, 1).collisions
            for found in (gas, recorded):
                np.testing.assert_allclose(found.diameter, given["diameter"])
                np.testing.assert_allclose(theory.mixture_rates(found, 1, 1).collisions,
                                           expected, rtol=1e-12)

    # Hollow ones beside homogeneous ones, and alone.
    HOLLOW = {"name": "hollow", "count": 120, "length": 0, "diameter": 0.8, "mass": 0.5,
              "inertia": 0.5 * 0.8**2 / 6, "t_rot": 0.5}
    SOLID = {"name": "solid", "count": 80, "length": 0, "diameter": 0.6}

    def test_rough_spheres_have_the_moments_of_inertia_of_the_gas(self):
        for species, q in (([self.HOLLOW, self.SOLID], [2 / 3, 0.4]), ([self.HOLLOW], 2 / 3)):
            file, scene = (self.folder / f"{len(species)}.{ending}" for ending in ("h5", "toml"))
            with Simulation({"needles": {"box": 8}, "species": species,
                             "collisions": {"epsilon": 0.9, "beta": 0.3, "tc_relative": 1e-3},
                             "until": {"time": 1}, "output": {"file": str(file)}}) as sim:
                gas = sim.gas
                scene.write_text(sim.scene)
            with read(file) as run:
                recorded = run.gas
            by_program = json.loads(printed_by("theory", scene, "--json", "--time", 2, "--time", 9))
            of_each = [by_program["species"][each["name"]] for each in species]
            t_tr, t_rot = np.ones(len(species)), [each.get("t_rot", 1) for each in species]
            for its in (gas, recorded):
                np.testing.assert_allclose(its.q, q, rtol=1e-12)
                rates = theory.mixture_rates(its, t_tr, t_rot)
                curve = theory.mixture_cooling(its, t_tr, t_rot, [2, 9])
                for n, each in enumerate(species):
                    for name in ("t_tr", "t_rot"):
                        self.assertAlmostEqual(rates[name][n],
                                               by_program[f"{name}_per_time"][each["name"]], 12)
                        np.testing.assert_allclose(curve[name][:, n], of_each[n][name], rtol=1e-9)
                np.testing.assert_allclose(curve.energy, by_program["energy"], rtol=1e-9)
            homogeneous = theory.mixture_rates({**gas, "q": 0}, t_tr, t_rot)
            self.assertGreater(homogeneous.t_tr[0], 0.9 * rates.t_tr[0])  # spins take up less
            np.testing.assert_array_equal(
                theory.mixture_rates({**gas, "q": 0.4}, t_tr, t_rot).t_tr, homogeneous.t_tr)
        self.assertNotIn("q", Simulation({"needles": {"box": 8}, "species": [self.HOLLOW]}).gas)
        with self.assertRaisesRegex(InputError, "q = 0.7: expected a number from 1e-9 to 2/3"):
            theory.mixture_rates({**gas, "q": 0.7}, 1, 1)

    def test_smooth_spheres_have_no_energy_of_rotation(self):
        spheres = {"counts": 100, "box": 8, "length": 0, "diameter": 1, "epsilon": 0.9}
        self.assertEqual(theory.mixture_cooling(spheres, 1, 1, 0).energy, 1.5)
        self.assertEqual(theory.mixture_cooling({**spheres, "beta": 0}, 1, 1, 0).energy, 3)

    def test_a_diameter_makes_rods(self):
        for length, diameter, rate in ((0, 1, 7.0898154), (5, 1, 91.75811), (2.5, 0.5, 22.939528)):
            rods = {"counts": 100000, "box": 1000, "length": length, "diameter": diameter}
            rates = theory.mixture_rates(rods, 1, 1 if length else 0)
            # Collisions per rod and time over n D^2 sqrt(T/m).
            found = 2 * rates.collisions[0, 0] / 99999 / 1e-4
            self.assertAlmostEqual(found / rate, 1, places=6)
        self.assertAlmostEqual(float(theory.homogeneous_k(2.5, 0.5)), 4.544240, places=6)
        self.assertEqual(float(theory.homogeneous_k(1, 0)), 6)


if __name__ == "__main__":
    unittest.main()
