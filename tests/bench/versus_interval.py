#!/usr/bin/python3
"""bench/versus.py holds the median as often as it says."""

import math
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
import versus  # noqa: E402


class Interval(unittest.TestCase):
    def test_holds_the_median_in_95_cases_of_100_and_is_as_short_as_that_allows(self):
        for n in range(6, 200):
            low, high = versus.interval(list(range(n)))
            self.assertEqual(low + high, n - 1)
            # The median lies below the value of rank r when no more than r values do.
            missed = [2 * sum(math.comb(n, k) for k in range(rank + 1)) / 2**n
                      for rank in (low, low + 1)]
            self.assertLessEqual(missed[0], 0.05)
            self.assertGreater(missed[1], 0.05)

    def test_does_not_depend_on_the_order(self):
        self.assertEqual(versus.interval([3, 1, 2, 6, 5, 4]), (1, 6))


if __name__ == "__main__":
    unittest.main()
