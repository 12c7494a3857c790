"""First contacts: exact cases, shapes, and the same answers as the program."""

import unittest

import needlework
import numpy as np
from needlework import InputError, predict

from support import InFolder, printed_by

REST, X, Y, Z = np.zeros(3), *np.eye(3)


class Contacts(InFolder):
    def test_crossed_needles_meet_when_and_where_they_must(self):
        # The second needle falls onto the first from height 2 and hits it off its centre.
        contact = predict(REST, X, REST, REST, [0.25, 0.1, 2], Y, -Z, REST, 10)
        self.assertIsInstance(contact, needlework.FirstContacts)
        time, s12, s21 = contact
        self.assertAlmostEqual(time, 2, places=14)
        self.assertAlmostEqual(s12, 0.25, places=14)
        self.assertAlmostEqual(s21, -0.1, places=14)
        self.assertEqual(np.shape(time), ())

    def test_rods_meet_half_the_sum_of_their_diameters_apart(self):
        falling = [REST, X, REST, REST, [0.25, 0.125, 2], Y, -Z, REST, 10]
        contacts = predict(*falling, length1=3, length2=[1, 0], diameter1=0.5, diameter2=0.75)
        # The sphere falls onto the side of the rod, 0.125 from its axis.
        np.testing.assert_allclose(contacts.time, [2 - 0.625, 2 - np.sqrt(0.375)], rtol=1e-15)
        np.testing.assert_allclose(contacts.s12, 0.25)
        np.testing.assert_array_equal(contacts.s21, [-0.125, 0])
        with self.assertRaisesRegex(InputError, "^pair 1: the rods overlap: their axes are 2 "):
            predict(*falling, diameter1=1, diameter2=[1, 4])
        # A thin needle has a width of 0.
        np.testing.assert_allclose(predict(*falling, diameter1=1).time, 1.5, rtol=1e-15)
        with self.assertRaisesRegex(InputError, "^length2: expected an array of numbers"):
            predict(*falling, length2="long")
        with self.assertRaisesRegex(InputError, r"length1 \(3,\).*expected shapes that can be"):
            predict(*falling, length1=[1, 2, 3], diameter2=[1, 2])

    def test_no_contact_is_infinity_and_nan(self):
        time, s12, s21 = predict(REST, X, REST, REST, Z, Y, Z, REST, 10)
        self.assertEqual(time, np.inf)
        self.assertTrue(np.isnan(s12) and np.isnan(s21))
        self.assertEqual(predict(REST, X, REST, REST, 2 * Z, Y, -Z, REST, 1.5).time, np.inf)

    def test_a_pair_that_has_just_collided_is_skipped(self):
        arguments = REST, X, REST, REST, REST, Y, Z, REST, 10
        self.assertEqual(predict(*arguments, skip=True).time, np.inf)

    def test_arguments_are_broadcast(self):
        heights = np.arange(1.0, 7).reshape(2, 3)
        above = np.zeros((2, 3, 3))
        above[..., 2] = heights
        contacts = predict(REST, X, REST, REST, above, Y, -Z, REST, 10)
        np.testing.assert_allclose(contacts.time, heights, rtol=1e-14)
        self.assertEqual(contacts.s12.shape, (2, 3))
        horizons = predict(REST, X, REST, REST, 2 * Z, Y, -Z, REST, [1, 3])
        np.testing.assert_array_equal(horizons.time, [np.inf, 2])
        self.assertEqual(predict(*[np.zeros((0, 3))] * 8, 1).time.shape, (0,))

    def test_answers_are_those_of_the_program(self):
        rng = np.random.default_rng(5)
        columns = [rng.normal(size=(300, 3)) for _ in range(8)]
        for place in (0, 4):  # near each other, often
            columns[place] *= 0.2
        sizes = rng.uniform(0.1, 0.4, size=(300, 4))
        sizes[::4, 1] = 0  # spheres
        apart = columns[0] + 3 * rng.permutation(np.eye(3))[0]
        approaching = columns[2] + 0.6 * (columns[0] - apart) + 0.3 * columns[6]
        rods = {name: sizes[:, n] for n, name in
                enumerate(("length1", "length2", "diameter1", "diameter2"))}
        for accuracy, wide in (("fast", False), ("standard", False), ("rigorous", False),
                               ("standard", True)):
            if wide:
                columns[4], columns[6] = apart, approaching
            ours = predict(*columns, 5.0, accuracy=accuracy, **(rods if wide else {}))
            path = self.folder / "pairs.csv"
            path.write_text("".join(
                ",".join([str(i), "random", "5.0", *(repr(float(x)) for column in columns
                                                     for x in column[i]), "0",
                          *(repr(float(x)) for x in sizes[i] if wide)]) + "\n"
                for i in range(300)))
            printed = printed_by("predict", path, "--accuracy", accuracy)
            its = np.array([[float(x) for x in line.split(",")[1:]]
                            for line in printed.splitlines()]).T
            for column, expected in zip(ours, its):
                np.testing.assert_array_equal(column, expected)
            self.assertGreater(np.isfinite(ours.time).sum(), 20)

    def test_wrong_arguments_are_named(self):
        good = [REST, X, REST, REST, Z, Y, -Z, REST]
        for place, value, message in ((1, [1, 0], r"^u1: shape \(2,\): expected \(\.\.\., 3\)"),
                                      (4, "a", "^r2: expected an array of numbers"),
                                      (5, REST, "^pair 0: .*expected"),
                                      (2, np.zeros((5, 2, 3)), "expected shapes that can be")):
            arguments = list(good)
            arguments[place] = value
            with self.assertRaisesRegex(InputError, message):
                predict(*arguments, [1, 2, 3])
        with self.assertRaisesRegex(InputError, 'accuracy = "perfect": expected "fast"'):
            predict(*good, 1, accuracy="perfect")
        with self.assertRaisesRegex(InputError, "accuracy = 1: expected"):
            predict(*good, 1, accuracy=1)

    def test_horizons_and_flags_are_what_they_seem(self):
        pairs = [REST, X, REST, REST, Z, Y, -Z, REST]
        masked = np.ma.array([1, 1], mask=[False, True])
        for horizon, message in ((masked, "^horizon: .*masked"), ("ten", "^horizon: expected an array"),
                                 ([[1], [2, 3]], "^horizon: expected an array of numbers"),
                                 (1j, "^horizon"), (None, "horizon"), (np.nan, "horizon")):
            with self.subTest(horizon=horizon), self.assertRaisesRegex(InputError, message):
                predict(*pairs, horizon)
        for skip, message in ((masked == 1, "^skip: .*masked"), ("False", "^skip: .*True and False"),
                              (np.nan, "^skip = .*nan"), (2, "^skip = .*2"), (None, "^skip"),
                              ([[True], [True, False]], "^skip: "), (b"1", "^skip")):
            with self.subTest(skip=skip), self.assertRaisesRegex(InputError, message):
                predict(*pairs, 10, skip=skip)
        for skip in (False, 0, 0.0, np.float32(0), [False, 0], np.ma.array([0, 1]) == 1):
            self.assertTrue(np.isfinite(predict(*pairs, 10, skip=skip).time).any())


if __name__ == "__main__":
    unittest.main()
