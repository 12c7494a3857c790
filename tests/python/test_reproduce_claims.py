"""Verdicts follow from the numbers, and claims are read with their numbers and their errors."""

import math
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

from support import require

require("matplotlib", "h5py")
from needlework import InputError  # noqa: E402
from needlework.reproduce import (FIGURES, PAPER, Claim, Measured, Measurement, Row,  # noqa: E402
                                  read_claims, verdict)
from needlework.reproduce.claims import json_text, table_text  # noqa: E402

# The paper says 2.5, within 0.1.
STATED = Claim("s", "5a", "S increases to 2.5.", "S", paper=2.5, precision=0.1)


def judged(*measured, stated=STATED):
    return verdict(stated, Measured(*measured))


class Verdict(unittest.TestCase):
    def test_agrees_within_three_standard_errors_plus_the_precision(self):
        for measured in ((2.5, 0.01, 3), (2.62, 0.01, 3), (2.38, 0.01, 3), (2.59, 0, 3)):
            self.assertEqual(judged(*measured), "agrees", measured)

    def test_differs_beyond_that(self):
        for measured in ((2.64, 0.01, 3), (2.36, 0.01, 3), (2.61, 0, 3), (-2.5, 0.1, 30)):
            self.assertEqual(judged(*measured), "differs", measured)

    def test_is_open_without_a_number_or_a_precision(self):
        self.assertEqual(judged(2.5, 0.01, 3, stated=replace(STATED, paper=None)), "open")
        self.assertEqual(judged(2.5, 0.01, 3, stated=replace(STATED, precision=None)), "open")

    def test_is_open_with_fewer_than_three_seeds(self):
        self.assertEqual(judged(2.5, 0.01, 2), "open")
        self.assertEqual(judged(9.5, 0.01, 0), "open")

    def test_is_open_with_a_standard_error_above_the_precision(self):
        self.assertEqual(judged(2.5, 0.1, 3), "agrees")
        self.assertEqual(judged(2.5, 0.101, 3), "open")
        self.assertEqual(judged(9.5, 0.101, 3), "open")

    def test_is_open_without_a_measurement(self):
        for measured in ((math.nan, 0.01, 3), (2.5, math.nan, 3), (math.inf, 0.01, 3)):
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

    def test_have_the_keys_that_scripts_read(self):
        self.assertEqual(self.row(2.45, math.nan, 3).to_json(), {
            "id": "s [k = 6]", "figure": "5a", "paper": 2.5, "measured": 2.45, "error": None,
            "verdict": "open", "precision": 0.1, "seeds": 3, "claim": "s", "variant": "k = 6",
            "statement": "S increases to 2.5.", "quantity": "S", "where": None, "reading": None})

    def test_are_one_line_each(self):
        rows = [self.row(2.5, 0.01, 3), self.row(math.nan, math.nan, 3)]
        self.assertEqual(json_text(rows, "full").count("\n"), 4)
        self.assertNotIn("NaN", json_text(rows, "full"))
        self.assertEqual(table_text(rows).count("\n"), 3)


class Claims(unittest.TestCase):
    def test_of_the_paper_have_number_and_precision(self):
        claims = read_claims(PAPER / "claims.toml")
        claim = claims["equipartition-k"]
        self.assertEqual((claim.figure, claim.paper, claim.precision), ("3", 4.3607, 5e-5))
        self.assertIn("4.3607", claim.statement)
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
                 "a.paper is missing: expected the number that has this precision"),
                ('[a]\nfigure = "2"\nstatement = "S."\n',
                 "a.quantity is missing: expected a text"),
                (head + "where = 3\n", "a.where = 3: expected a text"),
                (head + "[a]\n",
                 "expected TOML: Cannot declare ('a',) twice (at line 5, column 3)")):
            self.assertEqual(self.error(text), expected)

    def error(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "claims.toml")
            path.write_text(text)
            try:
                read_claims(path)
            except InputError as error:
                return str(error).removeprefix(f"{path}: ")
        return None


if __name__ == "__main__":
    unittest.main()
