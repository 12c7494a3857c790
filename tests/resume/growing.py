"""A file can be read at any time while a run writes to it: by h5py in SWMR mode, and by the program.

    growing.py NEEDLEWORK

The run writes frames, and so flushes its file, up to thousands of times in a second; between two of
them there are some ten collisions, so that all tables grow however slow the machine is. Readers
that do not expect a file to grow fail at every second to third attempt; if the file is shorter for
an instant than it says, one of some hundred openings fails.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from files import command, complete_rows, contents, open_growing, require_prefix

SCENE = """
needles = { count = 100, box = 5.4 }
collisions.epsilon = 0.9
collisions.tc_relative = 1e-3
driving.andersen = { rate = 0.3, temperature = 1 }
until.time = 5000
output = { series_every = 0.1, events = true, frames_every = 0.1, checkpoint_every = 1e6 }
"""
SECONDS = 4  # of reading, and half of it of opening


def main():
    program = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(SCENE)
        file, page = str(folder / "run.h5"), str(folder / "run.html")
        process = subprocess.Popen([program, "run", "scene.toml", "--out", file, "--quiet"],
                                   cwd=folder)
        try:
            while not (folder / "run.h5.checkpoint").exists():
                assert process.poll() is None, "the run has ended"
                time.sleep(0.05)
            reads, end = [], time.monotonic() + SECONDS
            while time.monotonic() < end or len(reads) < 3:
                reads.append(contents(file, open_growing))
                code, _, message = command(program, "report", file, "--force", "--out", page)
                assert code == 0, message
            openings, end = 0, time.monotonic() + SECONDS / 2
            while time.monotonic() < end or openings <= 500:
                open_growing(file).close()
                openings += 1
            assert process.poll() is None, "the run has ended"
        finally:
            process.kill()
            process.wait()
        after = contents(file)
        for read in reads:
            require_prefix(read, after)
        rows = [complete_rows(read) for read in reads]
        assert len(rows) >= 3, rows
        for table in rows[0]:
            assert rows[0][table] < rows[-1][table], f"{table} has not grown: {rows}"
        assert openings > 500, openings
        print(f"{openings} times opened; {len(rows)} times read by each, "
              f"rows from {rows[0]} to {rows[-1]}")


if __name__ == "__main__":
    main()
