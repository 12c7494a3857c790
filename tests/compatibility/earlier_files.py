#!/usr/bin/python3
"""Files of earlier versions are read, and their checkpoints continued or refused as COMPATIBILITY.md says.

    earlier_files.py NEEDLEWORK

Each folder beside this script has a scene of the version that names it, its output file, its checkpoint,
and what they hold. A version with the same first two numbers has the same trajectory. With the Python
package on PYTHONPATH, it reads the file, too.
"""

import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
MARK = re.compile(rb"needlework checkpoint (\d+) of (\d+\.\d+)\.\d+\n")
TWO_RUNS = "needles = { count = 2, box = 5 }\nuntil.time = 1e-3\noutput.file = \"mark.h5\"\n"


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def run(self, *arguments, code=0):
        done = subprocess.run([self.path, *arguments], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        assert done.returncode == code, (arguments, done.returncode, done.stdout, done.stderr)
        return done.stdout if code == 0 else done.stderr

    def mark(self):
        """Layout and version of its own checkpoints."""
        (self.folder / "mark.toml").write_text(TWO_RUNS)
        self.run("run", "mark.toml", "--force", "--quiet")
        return MARK.match((self.folder / "mark.h5.checkpoint").read_bytes()).groups()


def check_file(program, expected):
    """All that reads a file does."""
    described = program.run("info", "gas.h5")
    assert f"/particles/needles: {expected['needles']} particles" in described, described
    program.run("export", "gas.h5", "last.xyz", "--frame", "last")
    assert (program.folder / "last.xyz").read_text().startswith(f"{expected['needles']}\n")
    program.run("report", "gas.h5", "-o", "gas.html")
    program.run("view", "gas.h5", "-o", "gas.png")


def check_last_frame(program, expected):
    """A new run starts from the last frame."""
    result = json.loads(program.run("run", "gas.toml", "--set", "initial.file=gas.h5", "--out", "next.h5",
                                    "--json", "--quiet"))
    assert abs(result["energy_initial"] - expected["energy"]) <= 1e-12 * expected["energy"], result
    assert result["collisions"] >= expected["collisions"], result


RESUME = ("resume", "gas.h5", "--set", "until.collisions_per_needle=50", "--json", "--quiet")


def check_refused(program):
    """With what wrote it, what continues it and what else can be done, and nothing is changed."""
    names = ("gas.h5", "gas.h5.checkpoint")
    before = [(program.folder / name).read_bytes() for name in names]
    said = program.run(*RESUME, code=3)
    for part in (b" of ".join(MARK.match(before[1]).groups()).decode(),
                 b" of ".join(program.mark()).decode(), "initial.file"):
        assert part in said, (part, said)
    assert [(program.folder / name).read_bytes() for name in names] == before, "files have changed"


def check_checkpoint(program, expected):
    """Continued by versions with the same first two numbers, or refused; one of a version that there
    is not yet is refused in any case."""
    checkpoint = program.folder / "gas.h5.checkpoint"
    whole = checkpoint.read_bytes()
    checkpoint.write_bytes(re.sub(rb" of \d+\.", b" of 99.", whole, count=1))
    check_refused(program)
    checkpoint.write_bytes(whole)
    if MARK.match(whole)[2] != program.mark()[1]:
        check_refused(program)
        return "refused"
    result = json.loads(program.run(*RESUME))
    assert result["trajectory_hash"] == expected["resumed_hash"], result
    return "continued"


def check_trajectory(program, expected):
    """That of all versions with the same first two numbers."""
    result = json.loads(program.run("run", "gas.toml", "--out", "again.h5", "--json", "--quiet"))
    same = result["trajectory_hash"] == expected["hash"]
    written_by = MARK.match((program.folder / "gas.h5.checkpoint").read_bytes())[2]
    assert same or written_by != program.mark()[1], result


PYTHON = """
import json, needlework
expected = json.load(open("expected.json"))
with needlework.read("gas.h5") as run:
    assert len(run.frames[-1].position) == expected["needles"]
    assert run.series.collisions[-1] == expected["collisions"]
    assert len(run.events) == expected["events"]
    assert run.series.energy[-1] == expected["energy"]
    assert len(run.observable("velocity_moments").cumulant_v) == len(run.series.time)
    assert len(run.velocities_set.time) == 0 and run.data == {}
"""


def main(path):
    for version in sorted(folder for folder in HERE.iterdir() if (folder / "expected.json").exists()):
        expected = json.loads((version / "expected.json").read_text())
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for file in ("gas.toml", "gas.h5.checkpoint", "expected.json"):
                shutil.copy(version / file, folder)
            (folder / "gas.h5").write_bytes(gzip.decompress((version / "gas.h5.gz").read_bytes()))
            program = Program(Path(path).resolve(), folder)
            check_file(program, expected)
            check_last_frame(program, expected)
            check_trajectory(program, expected)
            if os.environ.get("PYTHONPATH"):
                subprocess.run([sys.executable, "-c", PYTHON], cwd=folder, check=True)
            print(f"{version.name}: read; its checkpoint is {check_checkpoint(program, expected)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
