#!/usr/bin/python3
"""Compares the program with other event-driven engines that you have built.

    bench/peers/peers.py --dynamo FOLDER --edmd FOLDER
    bench/peers/peers.py --edmd FOLDER --scene spheres-0.49 --repetitions 20 --out peers.md

FOLDER holds dynarun of DynamO, or md of a variant of EDMD, or several variants; without one, says how
to get them. Engines run in turn, each on one thread, from the same state. Prints a Markdown table, or
writes it to a file, with the CPU time that an engine takes for a collision. Exits with 1 if an engine
fails or if the rates of collisions differ by more than 5 %, with 2 if an argument is wrong. README.md
says what is compared, and how.
"""

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import measured  # noqa: E402
import versus  # noqa: E402
from engines import Dynamo, Edmd, Needlework, Run, find_program, version_of, write_spheres  # noqa: E402
from readme import RESULTS, put_table  # noqa: E402
from scenes import all_scenes  # noqa: E402

TITLE = "# Beside other engines"
TOLERANCE = 0.05  # of rates: several times their scatter in these scenes


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
    our_rate: float = None  # in the same part of the scene, if it has another rate as a whole

    def measure(self):
        self.last, least = self.run(), self.least()
        collisions = self.last.collisions - least.collisions
        self.cpu.append(1e6 * (self.last.cpu_s - least.cpu_s) / collisions)
        self.wall.append(1e6 * (self.last.wall_s - least.wall_s) / collisions)


def our_side(program, scene, folder):
    """Ours, the run of a tenth of its collisions, and the state from which all start in start.h5,
    start.xml and, of spheres, init.sph."""
    ours = Needlework(program, folder)
    (folder / "scene.toml").write_text(scene.text)
    ours.result("scene.toml", f"until.collisions_per_needle={scene.settled!r}",
                "output.file=start.h5", "output.frames=1")
    ours.export("start.h5", "start.xml")
    if scene.spheres:
        write_spheres(folder / "start.xml", folder / "init.sph")

    def until(per_body):
        return ours.run("scene.toml", scene.count, "initial.file=start.h5",
                        f"until.collisions_per_needle={per_body!r}")

    side = Side("Needlework", "", lambda: until(scene.collisions), lambda: until(1 / scene.count))
    return side, until(scene.collisions / 10)


def dynamo_side(dynarun, scene, folder, tenth):
    """A tenth of the collisions, as lines take it a hundred times as long as ours. With walls these
    are collisions and hits together."""
    dynamo = Dynamo(dynarun, folder)
    events = tenth.collisions
    counted = dynamo.run("start.xml", events, scene.count, counts=True)

    def whole():
        run = dynamo.run("start.xml", events, scene.count)
        return Run(run.cpu_s, run.wall_s, counted.collisions, counted.rate, counted.pressure)

    return Side("DynamO", version_of(dynarun), whole,
                lambda: dynamo.run("start.xml", 1, scene.count), our_rate=tenth.rate)


def edmd_side(name, md, scene, folder):
    """For the time that it was built for, with velocities of its own."""
    edmd = Edmd(md, folder)
    edmd.blocks()
    return Side(name + (", with thermostat" if edmd.thermostat else ""), version_of(md),
                lambda: edmd.run(scene.count))


def with_interval(values):
    low, high = map(measured.number, versus.interval(values))
    return f"{measured.number(statistics.median(values))} ({low}–{high})"


def report(compared, about, repetitions):
    """The table, and whether the rates agree in all scenes. `compared` lists each scene's name, the
    scene, and its sides, ours first."""
    rows, notes = [], []
    for name, _, (ours, *others) in compared:
        for side in (ours, *others):
            rows.append([name, side.engine, side.version, side.last.collisions,
                         measured.number(side.last.rate), with_interval(side.cpu),
                         with_interval(side.wall),
                         "1" if side is ours
                         else with_interval(measured.quotients(side.cpu, ours.cpu))])
            difference = side.last.rate / (side.our_rate or ours.last.rate) - 1
            if not abs(difference) <= TOLERANCE:
                notes.append(f"**{name}, {side.engine}: its rate differs from ours by "
                             f"{100 * difference:+.1f} %, more than {100 * TOLERANCE:.0f} %. The two "
                             "did not do the same, and their times cannot be compared.**")
    agree = not notes
    if any(scene.falling and not scene.spheres for _, scene, _ in compared):
        notes.append("In *falling*, walls of DynamO stop balls around the centres of lines, where "
                     "ours stop their tips.")
    origin = (f"`bench/peers/peers.py`: medians of {repetitions} interleaved repetitions, with an "
              "interval that holds the true median in 95 of 100 cases or more. Rates are "
              "collisions of a particle in a unit of time. Needlework at commit "
              f"{about['commit']}, {about['compiler']}, {about['flags']}; "
              f"{measured.processor() or about['machine']}, "
              f"{about['cores']} cores, each engine on one thread; "
              f"{time.strftime('%Y-%m-%d', time.gmtime())}.")
    header = ["scene", "engine", "version", "collisions", "rate", "CPU us per collision",
              "wall us per collision", "CPU theirs / ours"]
    parts = [TITLE, origin, measured.table(header, rows).rstrip(), *notes]
    return "\n\n".join(parts) + "\n", agree


def brief(compared):
    """For readers of docs/performance.md: CPU time of ours, and how many times that others take."""
    engines = list(dict.fromkeys(side.engine for _, _, (_, *others) in compared for side in others))
    rows = []
    for name, _, (ours, *others) in compared:
        found = {side.engine: measured.quotients(side.cpu, ours.cpu) for side in others}
        rows.append([name, measured.number(statistics.median(ours.cpu)),
                     *(measured.number(statistics.median(found[engine])) if engine in found else ""
                       for engine in engines)])
    return measured.table(["scene", "Needlework, µs", *(f"{engine}, times that" for engine in engines)],
                          rows)


def how_to_get_peers():
    """That section of the README."""
    readme = (Path(__file__).parent / "README.md").read_text()
    return readme.split("## How to get the peers\n")[1].split("\n## ")[0].strip()


def add_options(parser):
    """Where the programs are."""
    parser.add_argument("--dynamo", type=Path, metavar="FOLDER")
    parser.add_argument("--edmd", type=Path, metavar="FOLDER")
    parser.add_argument("--program", type=Path, default=measured.ROOT / "build/release/needlework")


def find_programs(parser, arguments):
    """Ours, dynarun and the variants of EDMD; ends the script, saying how to get a peer, without
    any."""
    if not (arguments.dynamo or arguments.edmd):
        print(f"{parser.prog}: expected --dynamo FOLDER or --edmd FOLDER, with a program that you "
              f"have built.\n\n{how_to_get_peers()}", file=sys.stderr)
        sys.exit(2)

    def missing(option, folder, places):
        parser.error(f"{option} {folder}: expected an executable program {' or '.join(places)} "
                     "there")

    program = find_program(arguments.program.parent, [arguments.program.name])
    if not program:
        missing("--program", arguments.program.parent, [arguments.program.name])
    dynarun = arguments.dynamo and find_program(arguments.dynamo, Dynamo.PLACES)
    if arguments.dynamo and not dynarun:
        missing("--dynamo", arguments.dynamo, Dynamo.PLACES)
    variants = Edmd.programs(arguments.edmd) if arguments.edmd else {}
    if arguments.edmd and not variants:
        missing("--edmd", arguments.edmd, ["md", *(f"{name}/md" for name in Edmd.VARIANTS)])
    return program, dynarun, variants


def main():
    scenes = all_scenes()
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add_options(parser)
    parser.add_argument("--scene", choices=scenes, action="append", dest="scenes",
                        help="may be given several times; else all. EDMD has spheres in a periodic "
                             "box only")
    parser.add_argument("--repetitions", type=int, default=10)
    parser.add_argument("--out", type=Path, metavar="FILE", help="instead of the standard output")
    parser.add_argument("--document", action="store_true",
                        help="put the table into bench/results/MACHINE-ISA/peers.md, and its quotients "
                             "into docs/performance.md, too")
    arguments = parser.parse_args()
    program, dynarun, variants = find_programs(parser, arguments)
    of_edmd = [name for name, scene in scenes.items() if scene.spheres and not scene.falling]
    names = arguments.scenes or (list(scenes) if dynarun else of_edmd)
    if not dynarun and (other := [name for name in names if name not in of_edmd]):
        parser.error(f"--scene {other[0]}: EDMD has spheres in a periodic box only; expected "
                     f"{', '.join(of_edmd)}")
    if arguments.repetitions < 6:
        parser.error("--repetitions: expected at least 6, fewer have no interval")
    if arguments.out and not arguments.out.parent.is_dir():
        parser.error(f"--out {arguments.out}: expected a folder {arguments.out.parent}")

    about, compared = measured.about(program.parent), []
    for name in names:
        scene = scenes[name]
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            ours, tenth = our_side(program, scene, folder)
            sides = [ours]
            if dynarun:
                sides.append(dynamo_side(dynarun, scene, folder, tenth))
            if name in of_edmd:
                sides += [edmd_side(variant, md, scene, folder) for variant, md in variants.items()]
            for repetition in range(arguments.repetitions):
                print(f"{name}: repetition {repetition + 1} of {arguments.repetitions}",
                      file=sys.stderr)
                first = repetition % len(sides)
                for side in sides[first:] + sides[:first]:
                    side.measure()
        sides[0].version = about["version"]
        compared.append((name, scene, sides))
        text, agree = report(compared, about, arguments.repetitions)
        if arguments.out:  # after each scene, so that a run that is stopped leaves a table
            arguments.out.write_text(text)
    if not arguments.out:
        print(text, end="")
    if arguments.document and agree:
        place = RESULTS / measured.machine_name(program.parent)
        place.mkdir(parents=True, exist_ok=True)
        (place / "peers.md").write_text(text)
        put_table("peers", brief(compared), "performance.md")
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"peers.py: {error}")
