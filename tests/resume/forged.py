"""Checkpoints that somebody has forged, with right checksums, cannot crash or hang the program.

    forged.py NEEDLEWORK COUNT [SEED]

Numbers, lengths and texts of a checkpoint are changed at random, and its checksum is repaired. The
program refuses the file with exit code 3, and then has not changed the output file; or it finds
nothing wrong and continues the run, which a number can make fail later. It never crashes, hangs, or
takes much memory.
"""

import os
import random
import resource
import struct
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from pathlib import Path

from checkpoint_file import TYPES, Fields, content_of, mark_of, sealed
from files import command

SCENE = """
needles = { count = 12, box = 2.5, seed = 4 }
collisions = { %s }
until.collisions_per_needle = 20
output = { frames = 2, events = true, observables = ["displacement", "collision_statistics"] }
"""
RULES = {"contact time": "epsilon = 0.8, tc_relative = 1e-2",
         "sliding": "epsilon = 0.3, sliding = true"}
MOST_MEMORY = 100 << 20
MOST_SECONDS = 60

WHOLE = [0, 1, 2, 3, 7, 8, 12, 13, 255, 1000, 10**6, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**53,
         2**61, 2**62 - 1, 2**62, 2**63 - 1, 2**63, 2**64 - 2, 2**64 - 1]
REAL = [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 5e-324, 1e-308, 1e-200, 1e-30, 1e30, 1e154, 1e200, 1e308,
        -1e-300, -1e300, float("inf"), float("-inf"), float("nan")]
TEXTS = [b"", b"auto", b"all-pairs", b"x" * 100, b"\x1b[2J", b"\xff\xfe", b"/dev/zero", b"../x"]


class Forger:
    def __init__(self, file, draw, sliding):
        self.mark, self.content, self.draw = mark_of(file), content_of(file), draw
        self.names = defaultdict(list)
        for field in Fields(self.content, sliding).found:
            self.names[field[0]].append(field)

    def number(self, kind, old):
        if kind == "f64":
            near = [old * 2, old / 2, -old, old * (1 + 2**-40), old + 1]
            return struct.pack("<d", self.draw.choice(REAL + near))
        bits = 8 * struct.calcsize(TYPES[kind])
        near = [old + 1, old - 1, 2 * old, -old, old ^ 1 << self.draw.randrange(bits)]
        value = self.draw.choice(WHOLE + near) % 2**bits
        return value.to_bytes(bits // 8, "little")

    def changed(self, content, field):
        """With this field changed, and where the change was."""
        name, kind, place = field
        if kind == "text":
            at, size = place
            text = self.draw.choice(TEXTS)
            length = struct.pack("<Q", len(text))
            return content[:at - 8] + length + text + content[at + size:]
        size = struct.calcsize(TYPES[kind])
        old, = struct.unpack_from(TYPES[kind], content, place)
        return content[:place] + self.number(kind, old) + content[place + size:]

    def with_other_edges(self, content):
        """With another box, which is possible but not that of the scene."""
        edge = struct.pack("<d", self.draw.choice([2.75, 6.0, 1e9, 1e30, 1e300]))
        for _, _, place in self.names["box"]:
            content = content[:place] + edge + content[place + 8:]
        return content

    def garbled(self, content):
        """Bytes cut out, put in, or exchanged."""
        at, size = self.draw.randrange(len(content)), self.draw.choice([1, 8, 189, 1000])
        way = self.draw.randrange(3)
        if way == 0:
            return content[:at] + content[at + size:]
        if way == 1:
            return content[:at] + self.draw.randbytes(size) + content[at:]
        return content[:at] + self.draw.randbytes(size) + content[at + size:]

    def forge(self):
        """What was done, and the file."""
        if self.draw.random() < 0.1:
            return "garbled", sealed(self.mark, self.garbled(self.content))
        if self.draw.random() < 0.05:
            return "all edges", sealed(self.mark, self.with_other_edges(self.content))
        content, done = self.content, []
        # From the end on, so that places stay.
        chosen = [self.draw.choice(self.names[self.draw.choice(sorted(self.names))])
                  for _ in range(self.draw.choice([1, 1, 1, 2]))]
        begin = lambda field: field[2][0] if field[1] == "text" else field[2]
        for field in sorted(chosen, key=begin, reverse=True):
            content = self.changed(content, field)
            done.append(field[0])
        return ", ".join(done), sealed(self.mark, content)


def run_limited(arguments):
    """Runs a command; returns its exit status, what it says, its memory and time."""
    began = time.monotonic()
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=errors)
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() - began > MOST_SECONDS:
                process.kill()
                process.wait()
                return None, "", 0
            time.sleep(0.002)
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        return process.returncode, errors.read().decode(errors="replace"), usage.ru_maxrss << 10


def try_forged(program, rules, count, draw):
    """How often the program ended with which code."""
    ends = Counter()
    sliding = rules == "sliding"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.toml").write_text(SCENE % RULES[rules])
        file, checkpoint = folder / "run.h5", folder / "run.h5.checkpoint"
        code, _, errors = command(program, "run", str(folder / "scene.toml"), "--out", str(file),
                                  "--quiet", "--threads", "1")
        assert code == 0, errors
        rows = file.read_bytes()
        good = checkpoint.read_bytes()
        (folder / "run.h5.checkpoint.old").unlink()
        forger = Forger(good, draw, sliding)
        assert sealed(forger.mark, forger.content) == good
        sides = [content_of(good)[place] for _, _, place in forger.names["touch.side"]]
        assert not sliding or 2 in sides or 254 in sides, "no needles slide at the end"
        for _ in range(count):
            what, forged = forger.forge()
            checkpoint.write_bytes(forged)
            file.write_bytes(rows)
            code, errors, memory = run_limited(
                [program, "resume", str(file), "--quiet", "--threads", "1", "--set",
                 "until.collisions_per_needle=25", "--set", "until.wall_s=1"])
            kept = Path(os.environ.get("TMPDIR", "/tmp")) / "forged.checkpoint"
            try:
                assert code is not None, f"hangs for {MOST_SECONDS} s"
                assert code in (0, 3, 4, 75), f"exit code {code}"
                assert memory < MOST_MEMORY, f"{memory} bytes of memory"
                if code != 0:
                    assert errors.startswith("needlework: ") and errors.count("\n") == 1
                    assert "unexpected" not in errors and errors[:-1].isprintable()
                if what == "all edges":
                    assert code == 3, "a box that is not that of the scene"
                if code == 3:
                    assert str(checkpoint) in errors or str(file) in errors
                    assert file.read_bytes() == rows, "a refused file was changed"
            except AssertionError as error:
                kept.write_bytes(forged)
                raise AssertionError(f"{what}: {error}: {errors} (kept in {kept})") from None
            ends[code] += 1
            for left in folder.glob("run.h5.checkpoint.*"):
                left.unlink()
    return ends


def main():
    program, count = str(Path(sys.argv[1]).resolve()), int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    print(f"seed {seed}")
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    draw = random.Random(seed)
    for rules in RULES:
        ends = try_forged(program, rules, count // len(RULES), draw)
        print(f"{rules}: " + ", ".join(f"exit code {code}: {n}" for code, n in sorted(ends.items())))
        assert ends[3] > count // len(RULES) / 4


main()
