"""Whatever a command is given to read, it ends within seconds: with what it was asked for, or with an
error that names the input, exit code 3 or 5, and with little memory.

    hostile_inputs.py NEEDLEWORK [FLIPS]

Each valid file is damaged by so many flipped bits, one at a time (1), and in other ways.
"""

import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SCENE = """
needles = { count = 5, box = 4 }
until.time = 1
output.file = "run.h5"
output.frames = 1
output.events = true
"""
PAIR = "7,hand,2,.25,-.125,-.5,1,0,0,0,0,.75,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0\n"
SECONDS = 60  # what is computed takes less than one
MEMORY = 1_500_000  # kB, of any process that was started


def whole_inputs(program, folder):
    """Valid inputs by the kind of file, as bytes."""

    def run(*arguments):
        subprocess.run([program, *arguments], cwd=folder, check=True, capture_output=True)

    (folder / "scene.toml").write_text(SCENE)
    run("run", "scene.toml", "--quiet")
    names = {"xyz": "a.xyz", "dump": "a.dump", "data": "a.data", "dynamo": "a.xml",
             "compressed dynamo": "a.xml.bz2"}
    for name in names.values():
        run("export", "run.h5", name, "--frame", "last")
    inputs = {kind: (folder / name).read_bytes() for kind, name in names.items()}
    inputs["run"] = (folder / "run.h5").read_bytes()
    inputs["checkpoint"] = (folder / "run.h5.checkpoint").read_bytes()
    inputs["scene"] = SCENE.replace('output.file = "run.h5"', "").encode()
    inputs["grid"] = ("seeds = [1, 2]" + SCENE.replace('output.file = "run.h5"', "")).encode()
    inputs["pairs"] = PAIR.encode()
    return inputs


# The kind of file that each command reads, and the arguments; {} is the file.
COMMANDS = [
    ("scene", "run {} --quiet"),
    ("scene", "check {}"),
    ("grid", "sweep {} --out {}.out --quiet"),
    ("pairs", "predict {}"),
    ("run", "info {}"),
    ("run", "run from.toml --quiet --set initial.file={}"),
    ("run", "export {} out.xyz --force"),
    ("run", "view {} -o out.svg --force"),
    ("run", "report {} -o out.html --force"),
    ("run", "resume {} --quiet"),
    ("checkpoint", "resume run.h5 --quiet"),
    ("xyz", "import {} --out imported --force"),
    ("dump", "import {} --out imported --force"),
    ("data", "import {} --out imported --force"),
    ("dynamo", "import {} --out imported --force"),
    ("compressed dynamo", "import {} --out imported --force"),
]


def make_folder(path):
    path.mkdir()


def make_sparse(path):
    path.touch()
    os.truncate(path, 10 << 30)


def no_files():
    """What is no valid file of any kind, and how it is made at a path."""
    yield "a folder", make_folder
    yield "a pipe", os.mkfifo
    yield "a device", lambda path: path.symlink_to("/dev/zero")
    yield "10 GB of zeros", make_sparse
    yield "an empty file", lambda path: path.touch()
    yield "a loop of links", lambda path: path.symlink_to(path.name)
    yield "deep brackets", lambda path: path.write_text("a=" + 300_000 * "[")
    yield "deep objects", lambda path: path.write_text(100_000 * '{"a":')


def damaged(whole, draw, flips):
    """Damage to a valid file; the changed file may still be valid."""
    yield "cut short", whole[: draw.randrange(len(whole))]
    for _ in range(flips):
        flipped = bytearray(whole)
        flipped[draw.randrange(len(whole))] ^= 1 << draw.randrange(8)
        yield "with a flipped bit", bytes(flipped)
    at = draw.randrange(len(whole))
    yield "with noise", whole[:at] + draw.randbytes(50) + whole[at:]


def main():
    program = os.path.abspath(sys.argv[1])
    flips = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    draw = random.Random(flips)
    failures = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        inputs = whole_inputs(program, folder)
        (folder / "from.toml").write_text('until.time = 1\ninitial.file = "none"\n')

        def attempt(kind, command, what, make, allowed):
            """Makes the input and runs the command on it."""
            path = folder / ("run.h5.checkpoint" if kind == "checkpoint" else "input")
            for old in (path, folder / "input.out", folder / "run.h5.checkpoint.old"):
                if old.is_dir() and not old.is_symlink():
                    shutil.rmtree(old)
                else:
                    old.unlink(missing_ok=True)
            (folder / "run.h5").write_bytes(inputs["run"])
            if kind == "run":  # of this file and of no other
                (folder / "input.checkpoint").write_bytes(inputs["checkpoint"])
            make(path)
            case = f"needlework {command.format('input', 'input')}, {kind}: {what}"
            try:
                done = subprocess.run([program, *command.format("input", "input").split()],
                                      cwd=folder, capture_output=True, text=True, errors="replace",
                                      timeout=SECONDS, stdin=subprocess.DEVNULL)
            except subprocess.TimeoutExpired:
                failures.append(f"{case}: still running after {SECONDS} s")
                return
            if done.returncode not in allowed:
                failures.append(f"{case}: exit code {done.returncode}: {done.stderr[-300:]}")
            elif done.returncode and "input" not in done.stderr and "run.h5" not in done.stderr:
                failures.append(f"{case}: does not name the file: {done.stderr}")

        for kind, command in COMMANDS:
            for what, make in no_files():
                empty_list = kind == "pairs" and what == "an empty file"
                attempt(kind, command, what, make, {0} if empty_list else {3, 5})
            for what, content in damaged(inputs[kind], draw, flips):
                attempt(kind, command, what, lambda path: path.write_bytes(content), {0, 3, 5})
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    if most > MEMORY:
        failures.append(f"a process took {most} kB: expected at most {MEMORY}")
    print("\n".join(failures) or f"every command ended as it should, with at most {most} kB")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
