#!/usr/bin/python3
"""What rods of finite width and spheres cost, beside needles: the table of
bench/results/rods.md.

Each gas of rods is compared with two gases of needles: one with as many collisions of a body while it
flies its own extent (L + D), and one with as many neighbours, n (L + D)^3. Instructions per collision
are counted by callgrind, which is repeatable; CPU time per collision is measured in interleaved rounds,
all gases one after the other, and compared within each round, so that others on the machine disturb all
of them alike.

    bench/rods_price.py                  both; about 10 minutes on two cores that are free
    bench/rods_price.py --rounds 0       instructions alone
"""

import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import measured
from instructions import Failure, build_of
from readme import put_table

BODIES = 2000
SHORT, LONG = 1.0, 3.0  # collisions per body that callgrind counts between
SETTLED = 10.0  # collisions per body before
GASES = [("rods of L/D = 5", 5.0, packing) for packing in (0.01, 0.1, 0.3)] + [
    ("spheres", 0.0, packing) for packing in (0.1, 0.49)]


@dataclass
class Gas:
    """A scene that starts from the state of a run before, in a folder."""

    name: str
    body: str  # of [[species]]
    edge: float  # of the box, in extents of a body
    length: float = 1.0
    rate: float = 0.0  # collisions of a body while it flies its extent, at T = m = 1

    def scene(self):
        return (f"needles.box = {self.edge!r}\n[[species]]\nname = 'body'\ncount = {BODIES}\n"
                f"{self.body}\n")


def rods(length_over_diameter, packing):
    """Of extent 1."""
    diameter = 1 / (length_over_diameter + 1)
    length = 1 - diameter
    volume = math.pi * diameter**2 * (length / 4 + diameter / 6)
    return (f"length = {length!r}\ndiameter = {diameter!r}",
            math.cbrt(BODIES * volume / packing))


class Bench:
    def __init__(self, program, folder, isa):
        self.program, self.folder, self.isa = program, folder, isa

    def run(self, scene, settings, tool=(), threads=1):
        """What `run --json` says, and what the tool says."""
        file = Path(self.folder) / f"scene{abs(hash((scene, tuple(settings), threads)))}.toml"
        file.write_text(scene)
        command = [*tool, self.program, "run", str(file), "--json", "--quiet", "--threads",
                   str(threads)]
        for setting in settings:
            command += ["--set", setting]
        # States are else read in a child process, whose instructions callgrind would print first.
        environment = {**os.environ, "NEEDLEWORK_FORK": "0"}
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True,
                              env=environment)
        if done.returncode != 0:
            raise Failure(f"{' '.join(command)}: exit code {done.returncode}: {done.stderr}")
        return json.loads(done.stdout), done.stderr

    def settle(self, gas):
        """Runs the gas to a state from which all others start; its rate is measured on the way."""
        result, _ = self.run(gas.scene(), [f"until.collisions_per_needle={SETTLED}",
                                           f"output.file='{gas.name}.h5'", "output.frames=1",
                                           "output.checkpoint_every=0"])
        gas.rate = 2 * result["collisions"] / BODIES / result["time"]
        return gas

    def going_on(self, gas):
        """The scene from that state."""
        return gas.scene() + f"[initial]\nfile = '{gas.name}.h5'\n"

    def instructions(self, gas, threads):
        def until(collisions_per_needle):
            tool = ["valgrind", "--fair-sched=yes", "--tool=callgrind",
                    "--callgrind-out-file=/dev/null"]
            settings = [f"until.collisions_per_needle={collisions_per_needle}",
                        f"engine.isa='{self.isa}'"]
            result, said = self.run(self.going_on(gas), settings, tool, threads)
            collected = re.search(r"Collected : (\d+)", said)
            if not collected:
                raise Failure(f"callgrind: expected a line 'Collected : N', got: {said}")
            return int(collected[1]), result["collisions"]

        (start, first), (end, last) = until(SHORT), until(LONG)
        return (end - start) / (last - first)

    def microseconds(self, gas, threads):
        settings = ["until.collisions_per_needle=20"]
        return self.run(self.going_on(gas), settings, (), threads)[0]["us_per_collision"]


def needles(bench, name, density):
    gas = Gas(name, "length = 1.0", math.cbrt(BODIES / density))
    if gas.edge < 2.02:
        raise Failure(f"{name}: a box of {gas.edge:.2f}: expected 2.02 or more; take more bodies")
    return bench.settle(gas)


def measure(bench, rounds, threads):
    """The gases with their needles, figures by name and threads."""
    triples = []
    for number, (name, ratio, packing) in enumerate(GASES):
        body, edge = rods(ratio, packing)
        gas = bench.settle(Gas(f"rods{number}", body, edge))
        as_near = needles(bench, f"near{number}", BODIES / edge**3)
        # The rate of needles is proportional to their density, as they exclude no volume.
        density = BODIES / as_near.edge**3 * gas.rate / as_near.rate
        as_often = needles(bench, f"often{number}", density)
        triples.append((f"{name}, η = {packing:g}", gas, as_often, as_near))
    gases = [gas for triple in triples for gas in triple[1:]]
    with ThreadPoolExecutor(measured.cores()) as pool:
        jobs = {(gas.name, n): pool.submit(bench.instructions, gas, n)
                for gas in gases for n in threads}
        counted = {key: job.result() for key, job in jobs.items()}
    times = {key: [] for key in counted}
    for _ in range(rounds):
        for n in threads:
            for gas in gases:
                times[gas.name, n].append(bench.microseconds(gas, n))
    return triples, counted, times


def table(triples, counted, times, threads):
    by = {1: "one thread", 2: "two threads"}
    rows = []
    for name, gas, as_often, as_near in triples:
        for n in threads:
            key = gas.name, n
            row = [name if n == threads[0] else "", by[n], f"{gas.rate:.3g}",
                   f"{1e-3 * counted[key]:.1f}"]
            for other in (as_near, as_often):
                density = BODIES / other.edge**3
                cell = f"{counted[key] / counted[other.name, n]:.2f}"
                if times[key]:
                    quotients = measured.quotients(times[key], times[other.name, n])
                    cell += f"; {measured.spread(quotients)}"
                row += [f"{density:.3g}", cell]
            rows.append(row)
    return measured.table(
        ["gas", "", "collisions per flight of L + D", "thousand instructions per collision",
         "needles with as many neighbours: n L³", "rods over these: instructions; CPU time",
         "needles that collide as often: n L³", "rods over these: instructions; CPU time"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(measured.ROOT / "build/release/needlework"))
    parser.add_argument("--rounds", type=int, default=5, help="of CPU times")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2], choices=[1, 2])
    parser.add_argument("--dry", action="store_true", help="print the table, leave the file")
    arguments = parser.parse_args()
    program = Path(arguments.program)
    program = measured.built(program.parent, program.name)
    build, offered = build_of(program)
    isa = "avx2" if "avx2" in offered.split() else "scalar"
    try:
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(program, folder, isa)
            triples, counted, times = measure(bench, arguments.rounds, arguments.threads)
    except (Failure, OSError, subprocess.CalledProcessError) as error:
        print(f"rods_price.py: {error}", file=sys.stderr)
        return 2
    rounds = (f"; CPU time: median (range) of {arguments.rounds} interleaved repetitions of "
              f"20 collisions per body, {offered.split()[-1]}" if arguments.rounds else "")
    text = (f"Instructions per collision, from {SHORT:g} to {LONG:g} collisions per body of {BODIES}, "
            f"{isa}{rounds}; {build['compiler']}, {build['flags']}.\n\n"
            + table(triples, counted, times, arguments.threads))
    if not arguments.dry:
        put_table("price", text, "../bench/results/rods.md")
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
