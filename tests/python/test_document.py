"""What docs/python.md shows works, in its order."""

import contextlib
import io
import os
import re
import tempfile
import unittest
import warnings
from pathlib import Path

from support import require

require("matplotlib", "h5py")
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import needlework  # noqa: E402

DOCUMENT = Path(__file__).resolve().parents[2] / "docs/python.md"


class Document(unittest.TestCase):
    def test_examples_run(self):
        blocks = re.findall(r"^```python\n(.*?)^```", DOCUMENT.read_text(), flags=re.M | re.S)
        self.assertGreater(len(blocks), 5)
        names, printed, here = {}, io.StringIO(), os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                with contextlib.redirect_stdout(printed), warnings.catch_warnings():
                    warnings.simplefilter("error", needlework.SceneWarning)
                    for block in blocks:
                        exec(compile(block, DOCUMENT.name, "exec"), names)
            finally:
                os.chdir(here)
            self.assertTrue(Path(folder, "cooling.png").exists())
        self.assertIn("stopped by energy", printed.getvalue())

    def test_fields_of_collisions_are_listed(self):
        text = DOCUMENT.read_text()
        for name in needlework.COLLISION_WITH_STATES.names:
            self.assertRegex(text, rf"\| .*`{name}`.* \|")


if __name__ == "__main__":
    unittest.main()
