"""The notebooks of docs/notebooks run from the first to the last cell, and have no outputs."""

import os
import tempfile
import unittest
from pathlib import Path

from support import require

require("nbclient", "nbformat", "ipykernel", "matplotlib", "h5py")
import nbclient  # noqa: E402
import nbformat  # noqa: E402

NOTEBOOKS = sorted((Path(__file__).resolve().parents[2] / "docs/notebooks").glob("*.ipynb"))


class Notebooks(unittest.TestCase):
    def test_run(self):
        self.assertGreaterEqual(len(NOTEBOOKS), 3)
        os.environ["MPLBACKEND"] = "Agg"
        for path in NOTEBOOKS:
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                notebook = nbformat.read(path, as_version=4)
                client = nbclient.NotebookClient(notebook, timeout=1800, kernel_name="python3",
                                                 resources={"metadata": {"path": folder}})
                client.execute()

    def test_have_no_outputs(self):
        for path in NOTEBOOKS:
            for cell in nbformat.read(path, as_version=4).cells:
                self.assertFalse(cell.get("outputs"), path)


if __name__ == "__main__":
    unittest.main()
