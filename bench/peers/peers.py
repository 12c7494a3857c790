#!/usr/bin/python3
"""Compares the program with other event-driven engines that you have built.

    bench/peers/peers.py --dynamo FOLDER
    bench/peers/peers.py --edmd FOLDER --scene dense --repetitions 20 --out peers.md

FOLDER holds dynarun of DynamO, or md of EDMD; without one, says how to get them. Engines run in
turn, each on one thread. Prints a Markdown table, or writes it to a file, with the CPU time that an
engine takes for a collision. Exits with 1 if an engine fails or if the rates of collisions differ
by more than 5 %, with 2 if an argument is wrong. README.md says what is compared, and how.
"""

import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import measured  # noqa: E402
import versus  # noqa: E402

# Restitution of the inelastic scenes: DynamO has no contact time, and lower values let needles
# collapse before the scenes end.
SCENES = {name + suffix: (*versus.SCENES[name], epsilon)  # needles, box, collisions per needle
          for suffix, epsilon in (("", 1.0), ("-inelastic", 0.98)) for name in ("dilute", "dense")}
TOLERANCE = 0.05  # of rates: several times their scatter in these scenes


@dataclass
class Run:
    """What a run took, as a whole process, and what it did."""

    cpu_s: float = 0.0
    wall_s: float = 0.0
    collisions: int = 0
    rate: float = math.nan  # collisions of a particle in a unit of time


@dataclass
class Side:
    """One engine in one scene, with the costs of all repetitions in us per collision."""

    engine: str
    version: str
    run: Callable[[], Run]
    least: Callable[[], Run] = Run  # the same up to the first collision, which is subtracted
    cpu: list = field(default_factory=list)
    wall: list = field(default_factory=list)
    last: Run = None

    def measure(self):
        self.last, least = self.run(), self.least()
        collisions = self.last.collisions - least.collisions
        self.cpu.append(1e6 * (self.last.cpu_s - least.cpu_s) / collisions)
        self.wall.append(1e6 * (self.last.wall_s - least.wall_s) / collisions)


def execute(command, folder):
    """Runs a program in a folder. Returns its CPU and wall time and what it printed."""
    begin = time.monotonic()
    with (folder / "stdout").open("w") as out, (folder / "stderr").open("w") as err:
        child = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                                 stderr=err, env={**os.environ, "OMP_NUM_THREADS": "1"})
        _, status, usage = os.wait4(child.pid, 0)
    wall_s = time.monotonic() - begin
    child.returncode = os.waitstatus_to_exitcode(status)
    printed, errors = ((folder / name).read_text(errors="replace") for name in ("stdout", "stderr"))
    if child.returncode != 0:
        lines = [line for line in (printed + "\n" + errors).split("\n") if line.strip()]
        raise ValueError(f"{' '.join(map(str, command))}: exit code {child.returncode}; its last "
                         "lines are\n" + "\n".join(lines[-5:]))
    return usage.ru_utime + usage.ru_stime, wall_s, printed


class Needles:
    """A scene of ours in a folder, with its initial state in start.h5."""

    def __init__(self, program, scene, folder):
        self.count, box, self.per_needle, self.epsilon = SCENES[scene]
        self.program, self.folder = program, folder
        drawn = self.needlework(f"needles.count={self.count}", f"needles.box={box!r}",
                                "until.collisions_per_needle=0", "output.file=start.h5")[2]
        self.exact_rate = drawn["collision_rate_exact"]  # null if inelastic

    def needlework(self, *settings):
        command = [self.program, "run", "/dev/null", "--json", "--quiet", "--threads", "1"]
        for setting in (f"collisions.epsilon={self.epsilon}", *settings):
            command += ["--set", setting]
        cpu_s, wall_s, printed = execute(command, self.folder)
        return cpu_s, wall_s, json.loads(printed)

    def run(self, until):
        cpu_s, wall_s, result = self.needlework("initial.file=start.h5", f"until.{until}")
        collisions = result["collisions"]
        return Run(cpu_s, wall_s, collisions, 2 * collisions / (self.count * result["time"]))


def run_dynamo(dynarun, events, needles, counts=False):
    """A run of start.xml. Without `counts` it is one without output plugins, the fastest."""
    command = [dynarun, "start.xml", "-c", str(events), "-o", "end.xml", "--out-data-file",
               "data.xml", *([] if counts else ["-E"])]
    cpu_s, wall_s, _ = execute(command, needles.folder)
    if not counts:
        return Run(cpu_s, wall_s, events)
    data = (needles.folder / "data.xml").read_text()
    found = re.search(r'<Duration\b[^>]* TwoParticleEvents="(\d+)"[^>]* Time="([^"]+)"', data)
    if not found:
        raise ValueError(f"{dynarun}: expected TwoParticleEvents and Time in its <Duration>")
    collisions, end = int(found[1]), float(found[2])
    return Run(cpu_s, wall_s, collisions, 2 * collisions / (needles.count * end))


def sides_dynamo(dynarun, program, scene, folder):
    """The same needles from the same state, for the same number of collisions."""
    needles = Needles(program, scene, folder)
    execute([program, "export", "start.h5", "start.xml", "--frame", "first"], folder)
    until, least = (f"collisions_per_needle={n!r}" for n in (needles.per_needle, 1 / needles.count))
    events = needles.run(until).collisions
    counted = run_dynamo(dynarun, events, needles, counts=True)

    def theirs():
        run = run_dynamo(dynarun, events, needles)
        return Run(run.cpu_s, run.wall_s, counted.collisions, counted.rate)

    return (Side("Needlework", "", lambda: needles.run(until), lambda: needles.run(least)),
            Side("DynamO, lines", version_of(dynarun), theirs,
                 lambda: run_dynamo(dynarun, 1, needles)))


def density_of_spheres(rate):
    """Spheres of diameter 1 in a unit of volume that collide as often as asked for, at temperature
    1 and mass 1: 4 sqrt(pi) n g, with g at contact of Carnahan and Starling, J. Chem. Phys. 51, 635
    (1969)."""
    low, high = 0.0, 0.9
    for _ in range(60):
        n = (low + high) / 2
        eta = math.pi / 6 * n
        g = (1 - eta / 2) / (1 - eta)**3
        low, high = (n, high) if 4 * math.sqrt(math.pi) * n * g < rate else (low, n)
    return low


def write_spheres(count, density, file):
    """Spheres on a simple cubic lattice, with its vacancies spread evenly, as EDMD reads them."""
    box, edge = (count / density)**(1 / 3), math.ceil(count**(1 / 3) - 1e-9)
    lines = [f"{count}", f"{box!r} {box!r} {box!r}"]
    for i in range(count):
        site = i * edge**3 // count
        place = (site % edge, site // edge % edge, site // edge**2)
        lines.append("a " + " ".join(repr((x + 0.5) * box / edge) for x in place) + " 0.5")
    file.write_text("\n".join(lines) + "\n")


def run_edmd(md, needles):
    """A run of init.sph, and the time at which it ended. The rate is that of the second half, when
    nothing is left of the lattice."""
    cpu_s, wall_s, printed = execute([md], needles.folder)
    found = re.findall(r"Simtime: ([\d.]+), Collisions: (\d+)", printed)
    if "fcc crystal" in printed or len(found) < 3:
        raise ValueError(f"{md}: expected a build that reads init.sph (initialconfig = 0) and "
                         "prints time and collisions three times or more (writeinterval)")
    times, collisions = [float(t) for t, _ in found], [int(n) for _, n in found]
    half = len(found) // 2
    rate = 2 * (collisions[-1] - collisions[half]) / (needles.count * (times[-1] - times[half]))
    return Run(cpu_s, wall_s, collisions[-1], rate), times[-1], "Started thermostat" in printed


def sides_edmd(md, program, scene, folder):
    """As many spheres as needles, which collide as often, for the time that EDMD was built for."""
    needles = Needles(program, scene, folder)
    write_spheres(needles.count, density_of_spheres(needles.exact_rate), folder / "init.sph")
    _, end, thermostat = run_edmd(md, needles)
    engine = "EDMD, spheres" + (", with thermostat" if thermostat else "")
    return (Side("Needlework", "", lambda: needles.run(f"time={end!r}")),
            Side(engine, version_of(md), lambda: run_edmd(md, needles)[0]))


def version_of(program):
    """The commit of the checkout that a program lies in, unless that is ours."""
    git = ["git", "-C", str(program.parent), "rev-parse"]
    top = subprocess.run([*git, "--show-toplevel"], capture_output=True, text=True)
    if top.returncode != 0 or Path(top.stdout.strip()) == measured.ROOT:
        return "unknown"
    return measured.output_of([*git, "--short=12", "HEAD"]).strip()


def with_interval(values):
    low, high = map(measured.number, versus.interval(values))
    return f"{measured.number(statistics.median(values))} ({low}–{high})"


def report(compared, about, repetitions):
    """The table, and whether the rates agree in all scenes."""
    rows, notes = [], []
    for scene, (ours, theirs) in compared:
        ratio = with_interval(measured.quotients(theirs.cpu, ours.cpu))
        rows += [[scene, side.engine, side.version, side.last.collisions,
                  measured.number(side.last.rate), with_interval(side.cpu),
                  with_interval(side.wall), "1" if side is ours else ratio]
                 for side in (ours, theirs)]
        difference = theirs.last.rate / ours.last.rate - 1
        if not abs(difference) <= TOLERANCE:
            notes.append(f"**{scene}, {theirs.engine}: its rate differs from ours by "
                         f"{100 * difference:+.1f} %, more than {100 * TOLERANCE:.0f} %. The two "
                         "did not do the same, and their times cannot be compared.**")
    agree = not notes
    if any("spheres" in row[1] for row in rows):
        notes.append("Spheres are another problem, simpler than needles: the time of a collision "
                     "stands beside that of needles at the same number and rate.")
    origin = (f"`bench/peers/peers.py`: medians of {repetitions} interleaved repetitions, with an "
              "interval that holds the true median in 95 of 100 cases or more. Rates are "
              "collisions of a particle in a unit of time. Needlework at commit "
              f"{about['commit']}, {about['compiler']}, {about['flags']}; {about['machine']}, "
              f"{about['cores']} cores, each engine on one thread; "
              f"{time.strftime('%Y-%m-%d', time.gmtime())}.")
    header = ["scene", "engine", "version", "collisions", "rate", "CPU us per collision",
              "wall us per collision", "CPU theirs / ours"]
    parts = ["# Beside other engines", origin, measured.table(header, rows).rstrip(), *notes]
    return "\n\n".join(parts) + "\n", agree


def how_to_get_peers():
    """That section of the README."""
    readme = (Path(__file__).parent / "README.md").read_text()
    return readme.split("## How to get the peers\n")[1].split("\n## ")[0].strip()


def find(parser, option, folder, places):
    """The program in the folder of an option."""
    for place in places:
        if os.access(folder / place, os.X_OK) and (folder / place).is_file():
            return (folder / place).resolve()
    parser.error(f"{option} {folder}: expected an executable program {' or '.join(places)} there")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dynamo", type=Path, metavar="FOLDER")
    parser.add_argument("--edmd", type=Path, metavar="FOLDER")
    parser.add_argument("--program", type=Path, default=measured.ROOT / "build/release/needlework")
    parser.add_argument("--scene", choices=SCENES, action="append", dest="scenes",
                        help="may be given several times; else all. EDMD has the elastic ones only")
    parser.add_argument("--repetitions", type=int, default=10)
    parser.add_argument("--out", type=Path, metavar="FILE", help="instead of the standard output")
    arguments = parser.parse_args()
    if not (arguments.dynamo or arguments.edmd):
        print("peers.py: expected --dynamo FOLDER or --edmd FOLDER, with a program that you have "
              f"built.\n\n{how_to_get_peers()}", file=sys.stderr)
        sys.exit(2)
    program = find(parser, "--program", arguments.program.parent, [arguments.program.name])
    scenes = arguments.scenes or list(SCENES)
    jobs = []
    if arguments.dynamo:
        dynarun = find(parser, "--dynamo", arguments.dynamo, ["dynarun", "bin/dynarun"])
        jobs += [(sides_dynamo, dynarun, scene) for scene in scenes]
    if arguments.edmd:
        md = find(parser, "--edmd", arguments.edmd, ["md", "Single/md"])
        jobs += [(sides_edmd, md, scene) for scene in scenes if SCENES[scene][3] == 1]
    if not jobs:
        parser.error("--scene: EDMD has elastic collisions only; expected dilute or dense")
    if arguments.repetitions < 6:
        parser.error("--repetitions: expected at least 6, fewer have no interval")
    if arguments.out and not arguments.out.parent.is_dir():
        parser.error(f"--out {arguments.out}: expected a folder {arguments.out.parent}")

    about, compared = measured.about(program.parent), []
    for sides_of, peer, scene in jobs:
        with tempfile.TemporaryDirectory() as folder:
            sides = sides_of(peer, program, scene, Path(folder))
            for repetition in range(arguments.repetitions):
                print(f"{scene}, {sides[1].engine}: repetition {repetition + 1} of "
                      f"{arguments.repetitions}", file=sys.stderr)
                for side in sides if repetition % 2 == 0 else sides[::-1]:
                    side.measure()
        sides[0].version = about["version"]
        compared.append((scene, sides))
    text, agree = report(compared, about, arguments.repetitions)
    if arguments.out:
        arguments.out.write_text(text)
    else:
        print(text, end="")
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"peers.py: {error}")
