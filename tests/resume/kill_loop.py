"""Runs that are killed at random instants and continued end as if they had not been.

    kill_loop.py NEEDLEWORK KILLS [SEED]      KILLS of each scene of files.EFFECTS

Whenever the program is killed, the file can be read, all its complete rows are right, and a
continued run has the same collisions, rows and hash as one that was never stopped. The run goes on
with other numbers of threads and other instruction sets each time.
"""

import json
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from files import EFFECTS, command, complete_rows, contents, differences, require_prefix

ISAS = ["auto", "scalar"]


def cpu_seconds_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def cpu_seconds_of(process):
    """Of its first thread, to the nanosecond."""
    return 1e-9 * int(Path(f"/proc/{process.pid}/schedstat").read_text().split()[0])


def kill_after(program, arguments, seconds):
    """Starts the program and kills it when it has used so much CPU time, which does not depend on
    what else the machine does; returns whether it was still running."""
    process = subprocess.Popen([program, *arguments], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    while process.poll() is None:
        if cpu_seconds_of(process) >= seconds:
            process.send_signal(signal.SIGKILL)
            process.communicate()
            return process.returncode == -signal.SIGKILL
        time.sleep(0.001)
    errors = process.stderr.read()
    assert process.returncode == 0, f"{arguments}: exit code {process.returncode}: {errors}"
    return False


class Loop:
    def __init__(self, program, folder, seed, scene):
        self.program, self.folder = program, Path(folder)
        self.draw = random.Random(seed)
        self.scene = str(self.folder / "scene.toml")
        self.file = str(self.folder / "run.h5")
        Path(self.scene).write_text(scene)
        began = cpu_seconds_of_children()
        code, out, errors = command(program, "run", self.scene, "--out",
                                    str(self.folder / "whole.h5"), "--json", "--quiet")
        assert code == 0, errors
        self.duration = cpu_seconds_of_children() - began
        self.hash = json.loads(out)["trajectory_hash"]
        self.whole = contents(self.folder / "whole.h5")
        assert len(self.whole["series/step"]) > 20 and len(self.whole["events/time"]) > 1000
        self.kills = self.continued = self.too_early = self.rows = 0

    def options(self):
        return ["--quiet", "--threads", str(self.draw.choice([1, 1, 2])), "--isa",
                self.draw.choice(ISAS)]

    def arguments(self):
        """Of the command that goes on, or begins again where there is nothing to continue."""
        if not Path(self.file + ".checkpoint").exists() and not Path(
                self.file + ".checkpoint.old").exists():
            return ["run", self.scene, "--out", self.file, "--force", *self.options()]
        self.continued += 1
        return ["resume", self.file, *self.options()]

    def look(self):
        """At what a kill has left."""
        if not Path(self.file).exists():
            self.too_early += 1
            return
        found = contents(self.file)
        require_prefix(found, self.whole)
        self.rows += sum(complete_rows(found).values())

    def one_run(self, most_kills):
        for path in self.folder.glob("run.h5*"):
            path.unlink()
        killed = True
        for _ in range(self.draw.randint(1, most_kills)):
            # More often near the beginning and the end, where files are made, renamed and closed.
            share = self.draw.choice([self.draw.random(), self.draw.random() ** 4])
            killed = kill_after(self.program, self.arguments(), share * self.duration)
            if not killed:
                break
            self.kills += 1
            self.look()
        code, out, errors = command(self.program, *self.arguments(), "--json")
        assert code == 0, errors
        assert json.loads(out)["trajectory_hash"] == self.hash
        # A run that has ended continues to the same end.
        code, out, errors = command(self.program, "resume", self.file, "--quiet", "--json")
        assert code == 0, errors
        assert json.loads(out)["trajectory_hash"] == self.hash
        differ = differences(self.whole, contents(self.file))
        assert not differ, f"after kills: {differ}"
        left = sorted(path.name for path in self.folder.iterdir() if ".part" in path.name)
        assert len(left) <= self.kills, left


def main():
    program, kills = str(Path(sys.argv[1]).resolve()), int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    print(f"seed {seed}")
    for name, scene in EFFECTS.items():
        with tempfile.TemporaryDirectory() as folder:
            loop = Loop(program, folder, seed, scene)
            while loop.kills < kills:
                loop.one_run(4)
            print(f"{name}: {loop.kills} kills, {loop.too_early} before there was a file, "
                  f"{loop.continued} times continued, {loop.rows} rows found after kills")
            assert loop.continued > kills / 4 and loop.rows > kills


main()
