"""The job of the user guide, which hands itself in again until its run is complete.

    batch_job.py NEEDLEWORK

A scheduler of this test takes the place of `sbatch`: it starts the script, and ends its time as soon
as the run has saved something new.
"""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from files import SCENE, command, contents, differences

GUIDE = Path(__file__).resolve().parents[2] / "docs/user-guide.md"


def script_of_guide():
    blocks = re.findall(r"```bash\n(#!/bin/bash\n#SBATCH.*?)```", GUIDE.read_text(), re.S)
    assert len(blocks) == 1, blocks
    return blocks[0]


class Scheduler:
    def __init__(self, folder, program):
        self.folder, self.queue = folder, folder / "queue"
        tools = folder / "bin"
        tools.mkdir()
        (tools / "needlework").symlink_to(program)
        (tools / "sbatch").write_text(f'#!/bin/sh\necho "$1" >> {self.queue}\n')
        (tools / "sbatch").chmod(0o755)
        self.environment = dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}")
        self.job = folder / "job.sh"
        self.job.write_text(script_of_guide())

    def saved_at(self):
        try:
            return (self.folder / "cooling.h5.checkpoint").stat().st_mtime_ns
        except FileNotFoundError:
            return None

    def start(self, ends_early):
        """Runs the job once; returns whether it has handed itself in again."""
        self.queue.unlink(missing_ok=True)
        before = self.saved_at()
        process = subprocess.Popen(["bash", self.job], cwd=self.folder, env=self.environment,
                                   stderr=subprocess.DEVNULL)
        while ends_early and process.poll() is None and self.saved_at() == before:
            time.sleep(0.005)
        if ends_early and process.poll() is None:
            process.send_signal(signal.SIGTERM)
        process.wait()
        return self.queue.exists() and self.queue.read_text().split() == [str(self.job)]


def main():
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "cooling.toml").write_text(SCENE)
        code, out, errors = command(program, "run", str(folder / "cooling.toml"), "--json",
                                    "--quiet", "--out", str(folder / "whole.h5"))
        assert code == 0, errors
        scheduler = Scheduler(folder, program)
        jobs = 1
        while scheduler.start(ends_early=jobs <= 5):
            jobs += 1
            assert jobs < 50
        assert jobs > 1, "the job was never stopped"
        code, again, errors = command(program, "resume", str(folder / "cooling.h5"), "--json",
                                      "--quiet")
        assert code == 0, errors
        assert json.loads(again)["trajectory_hash"] == json.loads(out)["trajectory_hash"]
        differ = differences(contents(folder / "whole.h5"), contents(folder / "cooling.h5"))
        assert not differ, differ
        print(f"{jobs} jobs, the same file")


main()
