"""A long run that is stopped, saved and continued many times ends as one that was never stopped.

    soak.py NEEDLEWORK COLLISIONS [RESUMES] [SEED] [GAS]

The same gas, one of GASES, runs twice: once in one piece,
once with another search in RESUMES + 1 pieces on changing numbers of threads and instruction sets,
half of them ended by kill -9. Checkpoints are written every few seconds, or more often where a
piece takes less than that. Both end with the same
totals, file and hash, and in neither does the memory of a process grow while it runs.
"""

import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from files import contents, differences

NEEDLES = 500
SCENE = f"""
needles = {{ count = {NEEDLES}, box = 7 }}
[output]
frames = 2
observables = ["velocity_moments", "displacement", "collision_statistics"]
"""
GASES = {
    "elastic": "",
    # vibrated and kicked, under gravity
    "effects": """
forces.gravity = [0, 0, -0.5]
driving = { kicks = { every = 0.2, translational = 0.1, rotational = 0.1 } }
collisions = { epsilon = 0.95, tc_relative = 1e-3 }
walls = [{ axis = "z", side = "low", epsilon = 0.95, motion = { amplitude = 0.1, frequency = 1.5 } }]
""",
    # with contacts that threads, pieces and checkpoints hold
    "sliding": """
collisions = { epsilon = 0.4, sliding = true }
driving.andersen = { rate = 0.3, temperature = 1 }
"""}
SEARCHES = ["linked-cells", "capsules"]  # of the whole run and of the one in pieces
THREADS = [1, 1, 1, 2]
ISAS = ["auto", "auto", "auto", "sse4", "scalar"]

# A process may take this much more in the second half of its time than in the first.
SLACK = 16 << 20


def resident(process):
    """Resident memory [bytes], or nothing when the process has ended."""
    try:
        for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
            if line.startswith("VmRSS:"):
                return 1024 * int(line.split()[1])
    except (FileNotFoundError, ProcessLookupError):
        pass
    return None


class Soak:
    def __init__(self, program, folder, collisions, seed):
        self.program, self.folder = program, Path(folder)
        self.collisions = collisions
        self.draw = random.Random(seed)
        self.scene = self.folder / "scene.toml"
        self.kills = 0

    def per_needle(self, share=1.0):
        return f"until.collisions_per_needle={2 * self.collisions * share / NEEDLES!r}"

    def run(self, arguments, lifetime=None):
        """Runs the program, for `lifetime` seconds at most; returns what it has printed."""
        began = time.monotonic()
        process = subprocess.Popen([self.program, *arguments, "--quiet", "--json"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        memory = []
        while process.poll() is None:
            time.sleep(0.05)
            memory.append(resident(process))
            if lifetime and time.monotonic() - began > lifetime:
                process.send_signal(signal.SIGKILL)
                process.communicate()
                self.kills += 1
                return None
        out, errors = process.communicate()
        assert process.returncode == 0, f"{arguments}: {process.returncode}: {errors}"
        memory = [size for size in memory if size]
        if len(memory) >= 20:
            middle = len(memory) // 2
            early, late = max(memory[:middle]), max(memory[middle:])
            print(f"  memory {early >> 10} kB, then {late >> 10} kB", flush=True)
            assert late <= early + SLACK, f"{arguments}: memory grew from {early} to {late} bytes"
        return json.loads(out)

    def whole(self):
        result = self.run(["run", str(self.scene), "--out", str(self.folder / "whole.h5"), "--set",
                           self.per_needle(), "--set", f"engine.search={SEARCHES[0]}"])
        assert result["collisions"] == self.collisions, result["collisions"]
        return result

    def options(self):
        return ["--threads", str(self.draw.choice(THREADS)), "--isa", self.draw.choice(ISAS)]

    def in_pieces(self, resumes, seconds_a_piece):
        file = str(self.folder / "pieces.h5")
        result = None
        for piece in range(resumes + 1):
            options = self.options()
            share = (piece + 1) / (resumes + 1)
            if piece == 0:
                begin = ["run", str(self.scene), "--out", file, "--set",
                         f"engine.search={SEARCHES[1]}"]
            else:
                begin = ["resume", file]
            lifetime = None
            if piece % 2 == 1 and piece < resumes:
                # Killed in the midst of more than one piece, which the next one makes up for.
                share, lifetime = 1, seconds_a_piece * (0.5 + self.draw.random())
            result = self.run([*begin, "--set", self.per_needle(share), *options], lifetime)
            print(f"  piece {piece}: {' '.join(options)}: "
                  f"{result['collisions'] if result else 'killed'}", flush=True)
        return result


def main():
    program, collisions = str(Path(sys.argv[1]).resolve()), int(float(sys.argv[2]))
    resumes = int(sys.argv[3]) if len(sys.argv) > 3 else 20
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    gas = GASES[sys.argv[5] if len(sys.argv) > 5 else "elastic"]
    print(f"seed {seed}")
    with tempfile.TemporaryDirectory() as folder:
        soak = Soak(program, folder, collisions, seed)
        every = 2 if collisions >= 10**7 else 0.05
        soak.scene.write_text(gas + SCENE + f"checkpoint_every = {every}\n")
        began = time.monotonic()
        whole = soak.whole()
        seconds = time.monotonic() - began
        print(f"{collisions} collisions in one piece: {seconds:.0f} s, hash "
              f"{whole['trajectory_hash']}", flush=True)
        pieces = soak.in_pieces(resumes, seconds / (resumes + 1))
        for key in ("trajectory_hash", "collisions", "time", "energy"):
            assert pieces[key] == whole[key], f"{key}: {pieces[key]}: expected {whole[key]}"
        differ = differences(contents(Path(folder) / "whole.h5"),
                             contents(Path(folder) / "pieces.h5"))
        assert differ == ["parameters/scene"], f"expected another search only: {differ}"
        print(f"the same in {resumes + 1} pieces, {soak.kills} of them ended by kill -9")


main()
