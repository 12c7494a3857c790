"""Verdicts follow from the numbers, and claims are read with their numbers and their errors."""

import math
import unittest
from dataclasses import replace

from support import InFolder, require

require("matplotlib", "h5py")
from needlework import InputError  # noqa: E402
from needlework.reproduce import (FIGURES, PAPER, Claim, Measured, Measurement, Row,  # noqa: E402
                                  read_claims, verdict)
from needlework.reproduce.claims import json_text, table_text  # noqa: E402
from needlework.reproduce.student import central_probability, quantile  # noqa: E402

# The paper says 2.5, within 0.1.
STATED = Claim("s", "5a", "S increases to 2.5.", "S", paper=2.5, precision=0.1)


def judged(*measured, stated=STATED):
    return verdict(stated, Measured(*measured))


class Student(unittest.TestCase):
    """Tables of Student's t, and integrals of its density."""

    def test_has_the_quantiles_of_tables(self):
        for confidence, quantiles in (
                (0.95, {1: 12.70620, 2: 4.302653, 3: 3.182446, 5: 2.570582, 15: 2.131450,
                        30: 2.042272}),
                (0.99, {1: 63.65674, 2: 9.924843, 3: 5.840909, 4: 4.604095, 5: 4.032143,
                        11: 3.105807, 15: 2.946713, 30: 2.749996})):
            for degrees, expected in quantiles.items():
                self.assertAlmostEqual(quantile(confidence, degrees) / expected, 1, 6,
                                       (confidence, degrees))

    def test_is_normal_for_many_degrees_of_freedom(self):
        for sigmas in (0.5, 1, 2, 3):
            self.assertAlmostEqual(central_probability(sigmas, 100_000),
                                   math.erf(sigmas / math.sqrt(2)), 5)

    def test_integrates_its_density(self):
        for degrees in range(1, 12):
            norm = math.gamma((degrees + 1) / 2) / math.gamma(degrees / 2) / math.sqrt(
                math.pi * degrees)
            step = 3 / 20_000
            area = sum((1 + ((i + 0.5) * step) ** 2 / degrees) ** (-(degrees + 1) / 2)
                       for i in range(20_000))
            self.assertAlmostEqual(central_probability(3, degrees), 2 * norm * step * area, 8)

    def test_makes_three_standard_errors_of_three_runs_9_5_percent(self):
        self.assertAlmostEqual(1 - central_probability(3, 2), 0.0955, 4)
        self.assertAlmostEqual(1 - central_probability(3, 10**5), 0.0027, 4)

    def test_needs_a_degree_of_freedom_and_a_probability(self):
        for confidence, degrees in ((0.99, 0), (0, 2), (1, 2)):
            with self.assertRaises(ValueError):
                quantile(confidence, degrees)


class Verdict(unittest.TestCase):
    def test_agrees_if_the_whole_interval_lies_within_the_precision(self):
        for measured in ((2.5, 0.01, 3), (2.57, 0.003, 3), (2.43, 0.003, 3), (2.59, 0, 3),
                         (2.5, 0.036, 30)):
            self.assertEqual(judged(*measured), "agrees", measured)

    def test_differs_if_it_lies_outside_as_a_whole(self):
        for measured in ((2.7, 0.01, 3), (2.3, 0.01, 3), (2.61, 0, 3), (-2.5, 0.1, 30)):
            self.assertEqual(judged(*measured), "differs", measured)

    def test_is_open_if_it_lies_across_the_limits(self):
        for measured in ((2.61, 0.003, 3), (2.59, 0.003, 3), (2.41, 0.003, 3), (2.39, 0.003, 3)):
            self.assertEqual(judged(*measured), "open", measured)

    def test_does_not_take_a_large_error_for_doubt(self):
        # 1.02 +- 0.11 of three runs: from -0.07 to 2.11, and 2.4 is claimed at least.
        self.assertEqual(judged(1.02, 0.11, 3), "differs")

    def test_does_not_take_a_large_error_for_agreement(self):
        # 0.59 +- 0.14 of three runs: from -0.8 to 1.98, and 0.3 is claimed at most.
        below = replace(STATED, paper=0.0, precision=0.3)
        self.assertEqual(judged(0.59, 0.14, 3, stated=below), "open")
        self.assertEqual(judged(0.01, 0.18, 3, stated=below), "open")

    def test_depends_on_the_number_of_runs(self):
        # Three and a half standard errors beyond: a significance of 7 % for three runs.
        self.assertEqual(judged(2.635, 0.01, 3), "open")
        self.assertEqual(judged(2.635, 0.01, 30), "differs")
        self.assertEqual(judged(2.5, 0.011, 3), "open")
        self.assertEqual(judged(2.5, 0.011, 4), "agrees")

    def test_is_open_without_a_number(self):
        self.assertEqual(judged(2.5, 0.01, 3, stated=replace(STATED, paper=None, precision=None)),
                         "open")

    def test_is_open_with_a_single_run(self):
        self.assertEqual(judged(2.5, 0.0, 1), "open")
        self.assertEqual(judged(9.5, math.nan, 1), "open")
        self.assertEqual(judged(9.5, 0.01, 0), "open")
        self.assertEqual(judged(9.5, 0.01, 2), "differs")

    def test_is_open_without_a_measurement(self):
        for measured in ((math.nan, 0.01, 3), (2.5, math.nan, 3), (math.inf, 0.01, 3),
                         (9.5, math.inf, 3), (math.nan, 0, None)):
            self.assertEqual(judged(*measured), "open", measured)

    def test_needs_no_seeds_where_there_is_no_chance(self):
        self.assertEqual(judged(2.5, 0, None), "agrees")
        self.assertEqual(judged(2.7, 0, None), "differs")


class Rows(unittest.TestCase):
    def row(self, *measured):
        return Row.of(FIGURES["5a"], Measurement("s", Measured(*measured), "k = 6"), {"s": STATED})

    def test_of_a_number_that_is_off_say_that_it_differs(self):
        self.assertEqual(self.row(2.5, 0.01, 3).verdict, "agrees")
        self.assertEqual(self.row(2.7, 0.01, 3).verdict, "differs")

    def test_give_half_of_the_interval(self):
        self.assertAlmostEqual(self.row(2.5, 0.01, 3).to_json()["half_width"], 0.09924843, 8)
        self.assertEqual(self.row(2.5, 0, None).to_json()["half_width"], 0)
        self.assertIsNone(self.row(2.5, 0, 1).to_json()["half_width"])

    def test_have_the_keys_that_scripts_read(self):
        self.assertEqual(self.row(2.45, math.nan, 3).to_json(), {
            "id": "s [k = 6]", "figure": "5a", "paper": 2.5, "measured": 2.45, "error": None,
            "verdict": "open", "precision": 0.1, "seeds": 3, "half_width": None, "claim": "s",
            "variant": "k = 6", "statement": "S increases to 2.5.", "quantity": "S", "where": None,
            "reading": None})

    def test_are_one_line_each(self):
        rows = [self.row(2.5, 0.01, 3), self.row(math.nan, math.nan, 3)]
        self.assertEqual(json_text(rows, "full").count("\n"), 4)
        self.assertNotIn("NaN", json_text(rows, "full"))
        self.assertEqual(table_text(rows).count("\n"), 3)


class Claims(InFolder):
    def test_of_the_paper_have_number_and_precision(self):
        claims = read_claims(PAPER / "claims.toml")
        claim = claims["equipartition-k"]
        self.assertEqual((claim.figure, claim.paper, claim.precision), ("3", 4.3607, 5e-5))
        self.assertIn("4.3607", claim.statement)
        self.assertEqual(claim.reading, "half a unit of the last digit")
        for claim in claims.values():
            self.assertIn(claim.figure, FIGURES, claim.id)
            self.assertTrue(claim.statement.endswith("."), claim.id)

    def test_with_errors_are_refused_with_their_place(self):
        head = '[a]\nfigure = "2"\nstatement = "S."\nquantity = "q"\n'
        self.assertIsNone(self.error(head))
        for text, expected in (
                ("paper = 1\n", "paper = 1: expected a claim, [ID]"),
                (head + "number = 1\n", "a.number = 1: expected one of figure, statement, where, "
                                        "quantity, paper, precision, reading"),
                (head + 'id = "b"\n', "a.id = 'b': expected one of figure, statement, where, "
                                      "quantity, paper, precision, reading"),
                (head + 'paper = "2"\n', "a.paper = '2': expected a number"),
                (head + "paper = true\n", "a.paper = True: expected a number"),
                (head + "paper = 2\nprecision = 0\n",
                 "a.precision = 0: expected a number greater than 0"),
                (head + "precision = 1\n",
                 "a.paper is missing: expected paper, precision and reading, or none of them"),
                (head + "paper = 1\nprecision = 1\n",
                 "a.reading is missing: expected paper, precision and reading, or none of them"),
                ('[a]\nfigure = "2"\nstatement = "S."\n',
                 "a.quantity is missing: expected a text"),
                (head + "where = 3\n", "a.where = 3: expected a text"),
                (head + "[a]\n",
                 "expected TOML: Cannot declare ('a',) twice (at line 5, column 3)")):
            self.assertEqual(self.error(text), expected)

    def error(self, text):
        path = self.folder / "claims.toml"
        path.write_text(text)
        try:
            read_claims(path)
        except InputError as error:
            return str(error).removeprefix(f"{path}: ")
        return None


if __name__ == "__main__":
    unittest.main()
