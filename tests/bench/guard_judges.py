"""What the guard of instructions per collision makes of figures that have changed."""

import contextlib
import io
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
import instructions


def judge(figures, expected):
    with contextlib.redirect_stdout(io.StringIO()) as out:
        code = instructions.judge(figures, expected)
    return code, out.getvalue()


class GuardJudges(unittest.TestCase):
    def test_small_changes_pass(self):
        code, out = judge({"a": 1029, "b": 971}, {"a": 1000, "b": 1000})
        self.assertEqual(code, 0)
        self.assertNotIn("--update", out)

    def test_growth_fails_and_is_named(self):
        code, out = judge({"a": 1031, "b": 1000}, {"a": 1000, "b": 1000})
        self.assertEqual(code, 1)
        self.assertIn("a: more than 3 % above bench/instructions.json", out)
        self.assertIn("bench/instructions.py guard --update", out)

    def test_gains_pass_but_ask_to_be_committed(self):
        code, out = judge({"a": 900}, {"a": 1000})
        self.assertEqual(code, 0)
        self.assertIn("commit it with --update", out)

    def test_other_figures_are_refused(self):
        with self.assertRaisesRegex(instructions.Failure, "figures: expected a, b"):
            judge({"a": 1, "b": 1}, {"a": 1})


if __name__ == "__main__":
    unittest.main()
