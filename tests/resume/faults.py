"""Whatever call that writes fails, nothing is lost that was in the file, and the run can go on.

    faults.py NEEDLEWORK FAULTS [EVERY]

FAULTS is the library of faults.c. A small run with rows, frames, collisions and checkpoints, and
another one that continues a run, are made again and again. In each, another call that writes fails
in another way: of all such calls in turn, or of every EVERY-th one and the first of each kind on
each file. Either the program goes on to the same file as without a fault, as it has to after a
write that is short or interrupted, or it ends with exit code 5 and a message that names a file and
the reason, as it has to where data or names may not be on the disk. All rows that were complete before the fault are in the file. Then the run is continued
without faults, and ends as if there had not been any.
"""

import errno
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from files import complete_rows, contents, differences, require_prefix

SCENE = """
needles = { count = 20, box = 4 }
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
until.collisions_per_needle = 3
engine.threads = 1
[output]
frames = 1
series_per_decade = 2
events = true
observables = ["displacement"]
checkpoint_every = 1e-9  # after each row
"""

PARTIAL = {"write", "pwrite", "pwrite64", "writev"}
INTERRUPTIBLE = PARTIAL | {"open", "ftruncate", "fsync", "fdatasync"}
# Others may fail unseen: a file that cannot be removed or closed may be one of no consequence, but
# not a checkpoint that cannot be closed.
ESSENTIAL = INTERRUPTIBLE | {"rename", "renameat2"}
# What the program has to continue from.
HARMLESS = {"short", errno.EINTR}
# A kind of fault, how many calls it fails, and on which calls it can happen.
FAULTS = [
    ("short", 10**9, PARTIAL),
    (errno.EINTR, 3, INTERRUPTIBLE),
    ("full", 10**9, None),
    (errno.ENOSPC, 1, None),
    (errno.EIO, 1, None),
    (errno.EDQUOT, 10**9, None),
    (errno.EROFS, 10**9, {"open", "rename", "renameat2", "unlink", "remove"}),
    ("kill", 1, None),
]


def sample(cases, every, first):
    """Every `every`-th case, and the first of each call on each file that is harmless or not."""
    firsts = {}
    for case in cases:
        _, call, name, (kind, _, _) = case
        if kind in HARMLESS or kind == errno.EIO:
            temporary = name.startswith(".needlework-")  # and then the number of the process
            firsts.setdefault((call, "" if temporary else name, kind), case)
    chosen = [*cases[first::every], *firsts.values()]
    return chosen if every > 1 else cases


def reason_of(kind):
    return os.strerror(errno.ENOSPC if kind == "full" else kind)


class Faults:
    def __init__(self, program, shim, folder):
        self.program, self.shim = program, shim
        self.top = Path(folder)
        self.work = self.top / "work"
        self.scene = self.top / "scene.toml"
        self.scene.write_text(SCENE)
        self.file = self.work / "run.h5"
        self.copy = self.top / "before.h5"
        self.ends = Counter()
        self.empty()
        done, _ = self.call(self.run())
        assert done.returncode == 0, done.stderr
        self.hash = json.loads(done.stdout)["trajectory_hash"]
        self.whole = contents(self.file)
        assert len(self.whole["events/time"]) == 30

    def run(self):
        return ["run", self.scene, "--out", self.file]

    def resume(self):
        return ["resume", self.file]

    def empty(self):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()

    def call(self, arguments, **faults):
        """Runs the program with faults; returns how it ended, and the calls that it made."""
        log = self.top / "calls"
        log.unlink(missing_ok=True)
        self.copy.unlink(missing_ok=True)
        environment = dict(os.environ, LD_PRELOAD=str(self.shim), FAULT_FOLDER=str(self.work),
                           FAULT_LOG=str(log), FAULT_WATCH=str(self.file),
                           FAULT_COPY=str(self.copy), **faults)
        # AddressSanitizer wants to be the first library.
        environment["ASAN_OPTIONS"] = "verify_asan_link_order=0"
        done = subprocess.run([self.program, *map(str, arguments), "--quiet", "--json"],
                              capture_output=True, text=True, env=environment)
        calls = [line.split() for line in log.read_text().splitlines()] if log.exists() else []
        return done, calls

    def require_end(self, done, call, file, kind):
        """A run that has not failed is whole; one that has says why."""
        if kind in HARMLESS:
            assert done.returncode == 0, "expected it to go on"
        if done.returncode == 0:
            essential = call in ESSENTIAL or (call == "close" and ".checkpoint" in file)
            assert kind in HARMLESS or not essential, "the failure was not noticed"
            assert json.loads(done.stdout)["trajectory_hash"] == self.hash
            differ = differences(self.whole, contents(self.file))
            assert not differ, f"a success that is not whole: {differ}"
            return "went on"
        if kind == "kill":
            assert done.returncode == -9, (done.returncode, done.stderr)
            return "killed"
        assert done.returncode == 5, f"exit code {done.returncode}: {done.stderr}"
        lines = done.stderr.splitlines()
        assert len(lines) == 1 and str(self.work) in lines[0], done.stderr
        assert reason_of(kind) in lines[0], done.stderr
        return "failed"

    def require_rows(self):
        """Those before the fault are there, and all rows are right."""
        if not self.file.exists():
            assert not self.copy.exists()
            return
        found = contents(self.file)
        require_prefix(found, self.whole)
        if self.copy.exists():
            rows = complete_rows(found)
            for table, count in complete_rows(contents(self.copy)).items():
                assert rows[table] >= count, f"{table}: {rows[table]} rows: expected {count}"

    def require_same_end(self):
        checkpoints = [self.file.with_name(self.file.name + end)
                       for end in (".checkpoint", ".checkpoint.old")]
        again = any(path.exists() for path in checkpoints)
        done, _ = self.call(self.resume() if again else [*self.run(), "--force"])
        assert done.returncode == 0, f"exit code {done.returncode}: {done.stderr}"
        assert json.loads(done.stdout)["trajectory_hash"] == self.hash
        differ = differences(self.whole, contents(self.file))
        assert not differ, differ
        assert not list(self.work.glob("*.checkpoint.part"))

    def all_faults(self, name, arguments, prepare, every, first):
        prepare()
        done, calls = self.call(arguments)
        assert done.returncode == 0, done.stderr
        cases = [(number, call, Path(path).name, fault) for number, (call, path) in enumerate(calls)
                 for fault in FAULTS if fault[2] is None or call in fault[2]]
        chosen = sample(cases, every, first)
        for number, call, file, (kind, times, _) in chosen:
            prepare()
            done, made = self.call(arguments, FAULT_AT=str(number), FAULT_TIMES=str(times),
                                   FAULT_KIND=str(kind))
            place = f"{name}: call {number}, {call} of {file}, {kind}"
            try:
                assert len(made) > number, "the fault has not come"
                self.ends[self.require_end(done, call, file, kind)] += 1
                self.require_rows()
                self.require_same_end()
            except Exception as error:
                error.args = (f"{place}: {error}: {done.stderr}",)
                raise
        counts = Counter(call for call, _ in calls)
        print(f"{name}: {len(calls)} calls ({', '.join(f'{n} {c}' for c, n in counts.items())}), "
              f"{len(chosen)} of {len(cases)} faults", flush=True)
        return Counter((call, Path(path).name) for call, path in calls)

    def prepare_half(self):
        """A run that was killed in the middle, between its checkpoints."""
        self.empty()
        half = self.top / "half"
        if not half.exists():
            _, calls = self.call(self.run())
            self.empty()
            done, _ = self.call(self.run(), FAULT_AT=str(len(calls) // 2), FAULT_KIND="kill")
            assert done.returncode == -9
            shutil.copytree(self.work, half)
        shutil.copytree(half, self.work, dirs_exist_ok=True)


def main():
    program, library = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    every = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    with tempfile.TemporaryDirectory() as folder:
        faults = Faults(program, library, folder)
        made = faults.all_faults("run", faults.run(), faults.empty, every, 0)
        made += faults.all_faults("resume", faults.resume(), faults.prepare_half, every, every // 2)
        file, checkpoint = faults.file.name, f"{faults.file.name}.checkpoint.part"
        for call, where in (("open", checkpoint), ("pwrite", file), ("pwrite", checkpoint),
                            ("ftruncate", file), ("fsync", file), ("fsync", checkpoint),
                            ("fsync", faults.work.name), ("close", checkpoint),
                            ("rename", f"{file}.checkpoint"), ("rename", f"{file}.checkpoint.old")):
            assert made[call, where] > 0, f"{call} of {where}: never called, or out of reach"
        assert min(faults.ends[end] for end in ("went on", "failed", "killed")) > 0, faults.ends
        print(dict(faults.ends))


main()
