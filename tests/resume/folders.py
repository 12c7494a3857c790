"""What happens to a run whose file or folder changes while it is written.

    folders.py NEEDLEWORK

The run ends with exit code 5 and a message that names a file and the reason; never with a success
that is not in the file. Where the file is still there, all its rows are right, and the run continues
to its end when it can be written again. What only the superuser, or somebody else, can do is skipped
with a message.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from files import command, contents, differences, require_prefix

SCENE = """
needles = { count = 200, box = 6 }
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
until.collisions_per_needle = 400
output = { frames = 1, events = true, checkpoint_every = 0.02 }
"""
NOBODY = 65534


class Folders:
    def __init__(self, program, top):
        self.program, self.top = program, top
        self.scene = top / "scene.toml"
        self.scene.write_text(SCENE)
        code, out, errors = command(program, "run", str(self.scene), "--out", str(top / "whole.h5"),
                                    "--quiet", "--json")
        assert code == 0, errors
        self.hash = json.loads(out)["trajectory_hash"]
        self.whole = contents(top / "whole.h5")

    def folder(self, name):
        path = self.top / name
        path.mkdir()
        path.chmod(0o777)
        return path

    def start(self, folder, user=None):
        """A run that has saved something since its start."""
        process = subprocess.Popen(
            [self.program, "run", self.scene, "--out", folder / "run.h5", "--quiet"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, user=user)
        while not (folder / "run.h5.checkpoint.old").exists():
            assert process.poll() is None, process.stderr.read()
            time.sleep(0.002)
        return process

    def require_failure(self, process, *words):
        _, errors = process.communicate(timeout=600)
        assert process.returncode == 5, f"exit code {process.returncode}: {errors}"
        for word in words:
            assert str(word) in errors, f"{word}: {errors}"
        assert errors.count("\n") == 1, errors

    def require_end(self, folder):
        """The rows are right, and the run goes on to its end."""
        require_prefix(contents(folder / "run.h5"), self.whole)
        code, out, errors = command(self.program, "resume", str(folder / "run.h5"), "--quiet",
                                    "--json")
        assert code == 0, errors
        assert json.loads(out)["trajectory_hash"] == self.hash
        differ = differences(self.whole, contents(folder / "run.h5"))
        assert not differ, differ

    def file_removed(self):
        folder = self.folder("removed")
        run = self.start(folder)
        (folder / "run.h5").unlink()
        self.require_failure(run, folder / "run.h5", "has been removed, renamed or replaced")

    def file_replaced(self):
        folder = self.folder("replaced")
        run = self.start(folder)
        code, _, errors = command(self.program, "run", str(self.scene), "--out",
                                  str(folder / "run.h5"), "--force", "--quiet")
        assert code == 5 and "has the file open for writing" in errors, errors
        shutil.copy(self.top / "whole.h5", folder / "other.h5")
        os.replace(folder / "other.h5", folder / "run.h5")
        self.require_failure(run, folder / "run.h5", "has been removed, renamed or replaced")

    def folder_moved(self):
        folder = self.folder("moved")
        run = self.start(folder)
        other = self.top / "elsewhere"
        folder.rename(other)
        self.require_failure(run, folder)
        self.require_end(other)

    def folder_removed(self):
        folder = self.folder("gone")
        run = self.start(folder)
        while True:  # the run may be making a file
            try:
                shutil.rmtree(folder)
                break
            except OSError:
                pass
        self.require_failure(run, folder)

    def folder_read_only(self):
        if os.geteuid() == 0 and not self.nobody_can_run():
            print("skipped: a folder that becomes read-only: another user cannot run the program")
            return
        folder = self.folder("read-only")
        run = self.start(folder, user=NOBODY if os.geteuid() == 0 else None)
        folder.chmod(0o555)
        self.require_failure(run, folder, "Permission denied")
        folder.chmod(0o777)
        self.require_end(folder)

    def nobody_can_run(self):
        self.top.chmod(0o755)
        try:
            done = subprocess.run([self.program, "--version"], capture_output=True, user=NOBODY)
        except PermissionError:
            return False
        return done.returncode == 0

    def disk_full(self):
        folder = self.folder("small")
        mount = ["mount", "-t", "tmpfs", "-o", "size=600k", "tmpfs", str(folder)]
        if os.geteuid() != 0 or subprocess.run(mount, capture_output=True).returncode != 0:
            print("skipped: a full disk: file systems cannot be mounted here")
            return
        try:
            code, _, errors = command(self.program, "run", str(self.scene), "--out",
                                      str(folder / "run.h5"), "--quiet")
            assert code == 5, f"exit code {code}: {errors}"
            assert str(folder) in errors and "No space left on device" in errors, errors
            require_prefix(contents(folder / "run.h5"), self.whole)
            more = subprocess.run(["mount", "-o", "remount,size=20m", str(folder)])
            assert more.returncode == 0
            self.require_end(folder)
        finally:
            subprocess.run(["umount", str(folder)])


def main():
    with tempfile.TemporaryDirectory() as name:
        folders = Folders(Path(sys.argv[1]).resolve(), Path(name))
        for case in (folders.file_removed, folders.file_replaced, folders.folder_moved,
                     folders.folder_removed, folders.folder_read_only, folders.disk_full):
            case()
            print(case.__name__)


main()
