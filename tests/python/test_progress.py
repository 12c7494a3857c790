"""Progress: one line on a terminal, or below the cell of a notebook, and only where it is wanted."""

import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

from needlework import Simulation, read
from needlework.progress import NotebookLine, progress_line

from support import ELASTIC


def stderr_of(progress):
    printed = io.StringIO()
    with contextlib.redirect_stderr(printed):
        # Longer than the first half of a second, in which nothing is shown.
        Simulation(ELASTIC).run(time=1e12, wall_s=0.9, progress=progress)
    return printed.getvalue()


class Progress(unittest.TestCase):
    def test_a_line_is_drawn_and_taken_away(self):
        printed = stderr_of(True)
        lines = printed.split("\r")
        self.assertRegex(lines[1], r"^ *[0-9.]+ % done, .* left: \d+ collisions, "
                         r"drift E [-0-9.e+]+.*$")
        self.assertEqual(lines[-1], "")
        self.assertEqual(lines[-2].strip(), "")

    def test_items_that_do_not_fit_are_left_out_whole(self):
        printed = io.StringIO()
        with contextlib.redirect_stderr(printed), mock.patch.dict(os.environ, COLUMNS="40"):
            progress_line(True).show("42.3 % done, 9 s left: 17 collisions, time 404.2, P 3e-16")
        self.assertEqual(printed.getvalue(), "\r42.3 % done, 9 s left: 17 collisions")

    def test_nothing_is_shown_by_default(self):
        self.assertEqual(stderr_of(None), "")
        self.assertEqual(stderr_of(False), "")

    def test_an_exception_of_the_line_ends_the_run(self):
        class Broken(io.StringIO):
            def write(self, text):
                raise OSError("no terminal")

        sim = Simulation(ELASTIC)
        with contextlib.redirect_stderr(Broken()), self.assertRaisesRegex(OSError, "no terminal"):
            sim.run(time=1e12, wall_s=600, progress=True)
        sim.run(time=sim.time + 1)

    def test_a_run_goes_on_where_stderr_is_closed(self):
        # Closed before Python begins, and closed later.
        for before, closing in (("2>&-", ""), ("", "os.close(2)")):
            with tempfile.TemporaryDirectory() as folder:
                script = f"""
import os
{closing}
import needlework
sim = needlework.Simulation({{**{ELASTIC!r}, "output": {{"file": "run.h5"}}}})
sim.run(time=1e12, wall_s=0.9, progress=True)
sim.close()
with needlework.read("run.h5") as run:
    os._exit(0 if run.series.rows > 1 else 1)
"""
                done = subprocess.run(["sh", "-c", f'exec "$0" -c "$1" {before}', sys.executable,
                                       script], cwd=folder, check=False)
                self.assertEqual(done.returncode, 0, before + closing)
                with read(f"{folder}/run.h5") as run:
                    self.assertGreater(run.series.rows, 1)

    def test_outside_of_notebooks_there_is_no_notebook_line(self):
        self.assertIsNone(progress_line(None))
        self.assertNotIsInstance(progress_line(True), NotebookLine)


if __name__ == "__main__":
    unittest.main()
