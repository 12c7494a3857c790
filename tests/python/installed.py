"""The package runs where `cmake --install` or pip has put it.

    installed.py cmake BUILD
    installed.py pip SOURCE        builds the library once more
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

CHECK = """
import needlework
assert needlework.__file__.startswith({prefix!r}), needlework.__file__
sim = needlework.Simulation({{"needles": {{"count": 100, "box": 5}}}})
assert sim.run(time=1) == "time" and sim.totals.collisions > 0
from pathlib import Path
assert Path(needlework.__file__).with_name("py.typed").exists()
from needlework.reproduce import FIGURES, PAPER, read_claims
assert {{claim.figure for claim in read_claims(PAPER / "claims.toml").values()}} <= set(FIGURES)
"""

DATA = "needles_per_cell,growth,error\n20,19,2\n39,35,4\n"


def run(*command, **environment):
    subprocess.run([str(part) for part in command], check=True,
                   env={**os.environ, **environment}, stdout=subprocess.DEVNULL)


def main(way, folder):
    with tempfile.TemporaryDirectory() as temporary:
        prefix = Path(temporary, "prefix").resolve()
        check = CHECK.format(prefix=str(prefix))
        os.chdir(temporary)
        if way == "cmake":
            run("cmake", "--install", folder, "--prefix", prefix)
            package, = prefix.glob("lib/python*/*-packages/needlework")
            run(sys.executable, "-c", check, PYTHONPATH=str(package.parent))
            # The program finds the package that is installed with it.
            Path("figure-cells.csv").write_text(DATA)
            run(prefix / "bin/needlework", "reproduce", "cells", "--from", ".", PYTHONPATH="")
            assert Path("figure-cells.svg").exists()
        else:
            run(sys.executable, "-m", "venv", "--system-site-packages", prefix)
            run(prefix / "bin/pip", "install", "--no-build-isolation", "--no-deps", folder)
            run(prefix / "bin/python", "-c", check, PYTHONPATH="")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]).resolve())
