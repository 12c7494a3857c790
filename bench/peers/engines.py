"""Needlework, DynamO and EDMD as whole processes of one thread: how a run is asked for, and what it
says that it has done. README.md names what is relied on.
"""

import json
import math
import os
import re
import resource
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import measured


@dataclass
class Run:
    """What a run took, as a whole process, and what it did."""

    cpu_s: float = 0.0
    wall_s: float = 0.0
    collisions: int = 0  # of pairs
    rate: float = math.nan  # collisions of a particle in a unit of time
    pressure: float = math.nan


def execute(command, folder, limit_s=None):
    """Runs a program in a folder, for at most so many seconds of CPU time. Returns its CPU and wall
    time and what it printed."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (limit_s, limit_s))

    begin = time.monotonic()
    with (folder / "stdout").open("w") as out, (folder / "stderr").open("w") as err:
        child = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                                 stderr=err, env={**os.environ, "OMP_NUM_THREADS": "1"},
                                 preexec_fn=limit if limit_s else None)
        _, status, usage = os.wait4(child.pid, 0)
    wall_s = time.monotonic() - begin
    child.returncode = os.waitstatus_to_exitcode(status)
    if limit_s and child.returncode == -signal.SIGKILL:
        raise ValueError(f"no answer in {limit_s} s of CPU time")
    printed, errors = ((folder / name).read_text(errors="replace") for name in ("stdout", "stderr"))
    if child.returncode != 0:
        lines = [line for line in (printed + "\n" + errors).split("\n") if line.strip()]
        raise ValueError(f"{' '.join(map(str, command))}: exit code {child.returncode}; its last "
                         "lines are\n" + "\n".join(lines[-5:]))
    return usage.ru_utime + usage.ru_stime, wall_s, printed


def find_program(folder, places):
    """The first of the programs that is in the folder; None if none is."""
    found = (folder / place for place in places)
    return next((file.resolve() for file in found if file.is_file() and os.access(file, os.X_OK)),
                None)


def version_of(program):
    """The commit of the checkout that a program lies in, unless that is ours."""
    git = ["git", "-C", str(program.parent), "rev-parse"]
    top = subprocess.run([*git, "--show-toplevel"], capture_output=True, text=True)
    if top.returncode != 0 or Path(top.stdout.strip()) == measured.ROOT:
        return "unknown"
    return measured.output_of([*git, "--short=12", "HEAD"]).strip()


class Needlework:
    """Runs scenes in a folder."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def result(self, scene, *settings):
        """CPU time, wall time and what `run --json` says of a scene file."""
        command = [self.program, "run", scene, "--json", "--quiet", "--force", "--threads",
                   "1"]
        for setting in settings:
            command += ["--set", setting]
        cpu_s, wall_s, printed = execute(command, self.folder)
        return cpu_s, wall_s, json.loads(printed)

    def run(self, scene, count, *settings):
        cpu_s, wall_s, result = self.result(scene, *settings)
        collisions = result["collisions"]
        return Run(cpu_s, wall_s, collisions, 2 * collisions / (count * result["time"]),
                   (result.get("rods") or {}).get("pressure") or math.nan)

    def export(self, state, out, frame="last"):
        execute([self.program, "export", state, out, "--frame", frame, "--force"], self.folder)

    def import_configuration(self, configuration, folder):
        execute([self.program, "import", configuration, "--out", folder, "--force"], self.folder)


class Dynamo:
    """Runs configurations in a folder."""

    PLACES = ["dynarun", "bin/dynarun"]

    def __init__(self, dynarun, folder):
        self.dynarun, self.folder = dynarun, folder

    def run(self, configuration, events, count, counts=False, options=(), end="end.xml",
            limit_s=None):
        """Without `counts` it is a run without output plugins, the fastest."""
        command = [self.dynarun, configuration, "-c", str(events), "-o", end, "--out-data-file",
                   "data.xml", *options, *([] if counts else ["-E"])]
        cpu_s, wall_s, _ = execute(command, self.folder, limit_s)
        if not counts:
            return Run(cpu_s, wall_s, events)
        data = (self.folder / "data.xml").read_text()
        found = re.search(r'<Duration\b[^>]* TwoParticleEvents="(\d+)"[^>]* Time="([^"]+)"', data)
        if not found:
            raise ValueError(f"{self.dynarun}: expected TwoParticleEvents and Time in its <Duration>")
        pressure = re.search(r'<Pressure Avg="([^"]+)"', data)
        collisions, time_of_end = int(found[1]), float(found[2])
        return Run(cpu_s, wall_s, collisions, 2 * collisions / (count * time_of_end),
                   float(pressure[1]) if pressure else math.nan)


class Edmd:
    """Runs init.sph of a folder, for the time that EDMD was built for."""

    VARIANTS = ["Single", "Multi", "Cell"]

    def __init__(self, md, folder):
        self.md, self.folder = md, folder
        self.thermostat = False  # of the last run

    @staticmethod
    def programs(folder):
        """Those built in a checkout, or the one of a variant's folder, by name."""
        found = {f"EDMD {name}": find_program(folder, [f"{name}/md"]) for name in Edmd.VARIANTS}
        found["EDMD"] = find_program(folder, ["md"])
        return {name: program for name, program in found.items() if program}

    def blocks(self):
        """A run as a whole, and its time, collisions and pressure between two lines that it
        prints."""
        cpu_s, wall_s, printed = execute([self.md], self.folder)
        found = re.findall(r"Simtime: ([\d.]+), Collisions: (\d+), Press: ([\d.]+)", printed)
        if "fcc crystal" in printed or len(found) < 3:
            raise ValueError(f"{self.md}: expected a build that reads init.sph (initialconfig = 0) "
                             "and prints time and collisions three times or more (writeinterval)")
        self.thermostat = "Started thermostat" in printed
        lines = [(float(t), int(n), float(p)) for t, n, p in found]
        return Run(cpu_s, wall_s, lines[-1][1]), [
            (after[0] - before[0], after[1] - before[1], after[2])
            for before, after in zip(lines, lines[1:])]

    def run(self, count):
        run, blocks = self.blocks()
        duration = sum(block[0] for block in blocks)
        run.rate = 2 * sum(block[1] for block in blocks) / (count * duration)
        run.pressure = sum(block[0] * block[2] for block in blocks) / duration
        return run


def write_spheres(configuration, file):
    """The spheres of a configuration of DynamO of diameter 1, as EDMD reads them."""
    text = configuration.read_text()

    def vectors(name):
        return re.findall(rf'<{name} x="([^"]+)" y="([^"]+)" z="([^"]+)"', text)

    [edges], centres = vectors("SimulationSize"), vectors("P")
    lines = [str(len(centres)), " ".join(edges)]
    lines += [f"a {x} {y} {z} 0.5" for x, y, z in centres]
    file.write_text("\n".join(lines) + "\n")
