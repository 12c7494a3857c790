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
"""


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
        else:
            run(sys.executable, "-m", "venv", "--system-site-packages", prefix)
            run(prefix / "bin/pip", "install", "--no-build-isolation", "--no-deps", folder)
            run(prefix / "bin/python", "-c", check, PYTHONPATH="")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]).resolve())
