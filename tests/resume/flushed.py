"""The rows of a run without frames and checkpoints reach its file while it runs.

    flushed.py NEEDLEWORK

Then the run is killed, and the rows are still there.
"""

import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from files import complete_rows, contents, open_growing, require_prefix

SCENE = """
needles = { count = 100, box = 5 }
until.wall_s = 300
output = { series_every = 1000, checkpoint_every = 1e6 }
"""


def rows_of(file):
    return complete_rows(contents(file, open_growing))["series/step"]


def main():
    program = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(SCENE)
        file = folder / "run.h5"
        process = subprocess.Popen([program, "run", "scene.toml", "--out", str(file), "--quiet"],
                                   cwd=folder)
        try:
            # Its name comes first, then the checkpoint before the first collision, then rows.
            while not (folder / "run.h5.checkpoint").exists():
                assert process.poll() is None, "the run has ended"
                time.sleep(0.05)
            first = rows_of(file)
            # Long before the end of the run, when rows reach the file as well.
            rows, latest = first, time.monotonic() + 200
            while rows <= first + 1:
                assert time.monotonic() < latest, "no rows have come"
                time.sleep(0.5)
                rows = rows_of(file)
            readable = contents(file, open_growing)
        finally:
            process.send_signal(signal.SIGKILL)
            process.wait()
        require_prefix(readable, contents(file))
        print(f"{first} rows at the start, {rows} while it ran, {rows_of(file)} after the kill")


if __name__ == "__main__":
    main()
