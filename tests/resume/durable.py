"""What takes the place of something else is on the disk first: its bytes, then its name.

    durable.py NEEDLEWORK FAULTS

FAULTS is the library of faults.c, which lists the calls that write. A crash of the power cannot be
made here, but the order of the calls on which its outcome depends can be read: before a checkpoint,
a bundle, the state of an audit or a finished member of a sweep gets its name, the file is flushed;
before anything is removed after that, its folder is.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

SCENE = """
needles = { count = 20, box = 4 }
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
until.collisions_per_needle = 3
engine.threads = 1
"""
FAILS = "needles = { count = 200, box = 6 }\ncollisions.epsilon = 0.3\nuntil.collisions_per_needle = 100\n"
GRID = 'scene = "scene.toml"\nseeds = [1]\n'
WRITES = {"write", "pwrite", "pwrite64", "writev", "ftruncate"}
REMOVES = {"unlink", "remove"}


def require_durable(calls, name):
    """Every rename to this name is between the two flushes."""
    draft, folder, renames = name + ".part", os.path.dirname(name), 0
    for number, (call, path) in enumerate(calls):
        if not call.startswith("rename") or path != name:
            continue
        renames += 1
        before = [call for call, path in calls[:number]
                  if path == draft and call in WRITES | {"fsync", "fdatasync"}]
        assert before and before[-1] not in WRITES, f"{name} is renamed before it is flushed"
        after = [(call, path) for call, path in calls[number + 1:]
                 if call in REMOVES or (call, path) == ("fsync", folder)]
        assert after and after[0][0] == "fsync", f"the name of {name} is not flushed: {after[:3]}"
    assert renames, f"nothing is renamed to {name}: the calls are not seen"
    print(f"{Path(name).name}: {renames} times")


def main():
    program, library = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as top:
        top = Path(top).resolve()
        work = top / "work"
        work.mkdir()
        for name, text in [("scene", SCENE), ("fails", FAILS), ("grid", GRID)]:
            (top / f"{name}.toml").write_text(text)

        def require(code, arguments, *names):
            log = top / "calls"
            log.unlink(missing_ok=True)
            environment = dict(os.environ, LD_PRELOAD=library, FAULT_FOLDER=str(work),
                               FAULT_LOG=str(log), ASAN_OPTIONS="verify_asan_link_order=0")
            done = subprocess.run([program, *arguments, "--quiet"], cwd=top, env=environment,
                                  capture_output=True, text=True)
            assert done.returncode == code, (arguments, done.returncode, done.stderr)
            calls = [tuple(line.split(" ", 1)) for line in log.read_text().splitlines()]
            for name in names:
                require_durable(calls, str(work / name))

        run, fails = str(work / "run.h5"), str(work / "fails.h5")
        require(0, ["run", "scene.toml", "--out", run], "run.h5.checkpoint")
        require(4, ["run", "fails.toml", "--out", fails], "fails.h5.failure")
        require(75, ["audit", "scene.toml", "--set", "until.wall_s=0",
                     "--state", str(work / "audit")], "audit")
        require(0, ["sweep", "grid.toml", "--out", str(work)], "seed=1.h5")


main()
