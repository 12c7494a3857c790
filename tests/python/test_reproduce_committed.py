"""The results in docs/reproduction are those of the committed claims and figures."""

import hashlib
import json
import unittest
from pathlib import Path

from support import require

require("matplotlib", "h5py", "PIL")
import numpy as np  # noqa: E402
from needlework.reproduce import FIGURES, PAPER, Measured, read_claims, verdict  # noqa: E402
from needlework.reproduce.figure import read_table  # noqa: E402
from needlework.reproduce.style import styled  # noqa: E402
from PIL import Image  # noqa: E402

RESULTS = Path(__file__).resolve().parents[2] / "docs/reproduction"


class CommittedResults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        results = json.loads((RESULTS / "claims-all.json").read_text())
        cls.size, cls.rows = results["size"], results["claims"]
        cls.measured = {row["id"]: row["measured"] for row in cls.rows}

    def test_are_of_the_full_size(self):
        self.assertEqual(self.size, "full")

    def test_have_each_claim_with_its_numbers_and_verdicts(self):
        claims = read_claims(PAPER / "claims.toml")
        self.assertEqual({row["claim"] for row in self.rows}, set(claims))
        for row in self.rows:
            claim = claims[row["claim"]]
            for key in ("statement", "quantity", "paper", "precision", "where", "reading"):
                self.assertEqual(row[key], getattr(claim, key), row["id"])
            numbers = (np.nan if row[key] is None else row[key] for key in ("measured", "error"))
            self.assertEqual(row["verdict"], verdict(claim, Measured(*numbers, row["seeds"])),
                             f"{row['id']}: docs/reproduction/judge.py judges again")

    def test_have_a_line_for_each_claim(self):
        lines = (RESULTS / "claims-all.json").read_text().splitlines()
        self.assertEqual(len(lines), len(self.rows) + 2)

    def test_have_data_from_which_each_figure_is_drawn(self):
        # Not saved, which takes most of the time; that of the small paper is.
        for figure in FIGURES.values():
            with styled(), np.errstate(all="ignore"):
                picture = figure.draw(read_table(RESULTS / figure.data_file))
            self.assertTrue(all(axes.has_data() for axes in picture.axes), figure.name)

    def test_have_pictures_of_these_data(self):
        for figure in FIGURES.values():
            digest = hashlib.sha256((RESULTS / figure.data_file).read_bytes()).hexdigest()
            with Image.open(RESULTS / f"figure-{figure.name}.png") as picture:
                self.assertEqual(picture.text["Data"], digest,
                                 f"docs/reproduction/pictures.py {figure.name} draws it again")

    def test_have_data_of_the_same_runs_as_the_claims(self):
        """The numbers of claims that the data contain too, in seven digits."""
        def check(name, expected):
            np.testing.assert_allclose(self.measured[name], expected, rtol=1e-6, err_msg=name)

        table = read_table(RESULTS / FIGURES["3"].data_file)
        for epsilon, k, theory, ratio in zip(table.epsilon, table.k, table.ratio_theory,
                                             table.ratio):
            check(f"ratio-surface [epsilon = {epsilon:g}, k = {k:g}]", ratio / theory)
        table = read_table(RESULTS / FIGURES["rough"].data_file)
        for epsilon, beta, theory, ratio in zip(table.epsilon, table.beta, table.ratio_theory,
                                                table.ratio):
            check(f"rough-ratio [epsilon = {epsilon:g}, beta = {beta:g}]", ratio / theory)
        table = read_table(RESULTS / FIGURES["cells"].data_file)
        for cells, growth in zip(table.cells, table.growth):
            check(f"flow-order-growth [test, {cells:g} cells along each axis]", growth)
        table = read_table(RESULTS / FIGURES["2"].data_file)
        later = table.tau >= 1
        over = (table.energy / table.energy_theory)[later]
        check("energy-theory", over[np.argmax(np.abs(over - 1))])
        table = read_table(RESULTS / FIGURES["5a"].data_file)
        for k, t_rot0 in ((6, 1), (6, 0), (2, 1), (2, 0)):
            start = (table.k == k) & (table.t_rot0 == t_rot0) & (table.collisions == 0)
            check(f"flow-order-start [k = {k}, T_rot(0) = {t_rot0}]", *table.value[start])
        table = read_table(RESULTS / FIGURES["tc-dense"].data_file)
        for tc, s, moment in zip(*(table[name][table.collisions == 400]
                                   for name in ("tc_relative", "s", "moment"))):
            check(f"flow-order-growth [test, t_c = {tc:g} mean free times, at 400]", s)
            check(f"moment-growth [test, t_c = {tc:g} mean free times, at 400]", moment)


if __name__ == "__main__":
    unittest.main()
