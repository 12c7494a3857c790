#!/usr/bin/python3
"""Instructions per collision, counted by callgrind: repeatable where times are not.

guard    compares the engine with the committed figures of instructions.json and fails when one has
         grown by more than 3 %; --update replaces them.
effects  counts what each effect costs when it is on; the table goes to results/effects.md, and what
         matters to users to docs/performance.md.
shares   lists which part of the program a collision's instructions are spent in; the table goes to
         results/shares.md.
baseline counts the classical method with several sides of its cells, to see that its own is good.

A figure is the difference between a long and a short run of one trajectory, over the collisions
between their ends, so that set-up drops out. Valgrind 3.19 does not know AVX-512, hence avx2.
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
from readme import put_result, put_table

BENCH = Path(__file__).resolve().parent
COMMITTED = BENCH / "instructions.json"
EFFECTS_TABLE = BENCH / "results/effects.md"
TOLERANCE = 0.03
NEEDLES = 2000
SHORT, LONG = 1.0, 3.0  # collisions per needle
DENSITIES = {"dilute": 10000 / 24**3, "dense": 20000 / 12**3}  # of the paper's scenes
CELL_SIDES = {0.1: (1.0, 1.36), DENSITIES["dilute"]: (1.17, 1.4), DENSITIES["dense"]: (1.15, 1.3)}
SKIPPED = 77  # exit code that ctest takes for a skipped test

# Where instructions go, by the first of these patterns that a function's name has.
SHARES = {
    "finding neighbours, SIMD": r"::(approaching|overlapping)$",
    "bracketing first roots, SIMD": r"::bracket",
    "choosing cells, transposing motions, sorting candidates":  # GCC makes one function of them
        r"candidates|Candidate|PairTable|PairFilter|CellScan|BallLists::look",
    "placing needles in cells": r"NearSearch::place|BoundingVolumes::|BallLists::|NeedleCells::",
    "collisions and their records":
        r"::meet$|::part$|collide|record|contact_geometry|set_rotation|Hash|director_after|normalised",
    "windows, counting needles, sorting the storage":
        r"Run::|Sizing|exact_sums|density_around|sort|permute|order_in_space|ContactIntegrals",
    "first contacts in double and double-double":
        r"kernels::|sine_cosine|make_pair|settle_touch|::predict|::consider",
    "calendar": r"Tournament|WinnerTree|EventTable",
    "the rest of the loop": r"",
}

# Not in equilibrium, or the program would compare each collision's time with theory.
PLAIN = ["initial.t_rot=0.999"]


@dataclass
class Effect:
    name: str
    neutral: list  # settings that have its code run but leave the trajectory as it is, or nearly so
    acting: list  # settings with which it acts
    flags: tuple = ()
    scene: str = ""  # what no setting can add
    long: float = LONG  # collisions per needle in which it acts often enough


MEAN_FREE_TIME = 1.1  # of the dilute scene, about
WALLS = "walls = [{ axis = 'z', side = 'both' }]"
SHAKEN = """forces.gravity = [0, 0, -0.1]
walls = [{ axis = 'z', side = 'low', motion = { amplitude = 0.05, frequency = 0.5 } }]
"""

TWO_THREADS = ("--threads", "2")  # valgrind runs them in turn and counts both

EFFECTS = [
    # By itself it ends in the collapse of a pair.
    Effect("normal restitution", ["collisions.epsilon=0.9999999999999999"], []),
    Effect("tangential restitution", ["collisions.beta=-0.9999999999999999"],
           ["collisions.beta=0"]),
    Effect("t_c rule", ["collisions.tc=1e-300"],
           ["collisions.epsilon=0.9", "collisions.tc_relative=1e-3"]),
    Effect("sliding contact", ["collisions.epsilon=0.9999999999999999", "collisions.sliding=true"],
           ["collisions.epsilon=0.9", "collisions.sliding=true"]),
    *(Effect(f"kicks every {name}", ["driving.kicks={every=1e6, translational=1e-300}"],
             [f"driving.kicks={{every={MEAN_FREE_TIME * times!r}, translational=0.01, "
              "rotational=0.01}"], long=max(LONG, SHORT + 2 * times))
      for name, times in (("10 mean free times", 10), ("mean free time", 1),
                          ("0.1 mean free times", 0.1))),
    Effect("thermostat", ["driving.andersen={rate=1e-9, temperature=1}"],
           ["driving.andersen={rate=1, temperature=1}"]),
    Effect("two walls along z", [], [], scene=WALLS),
    Effect("vibrated wall and gravity", [], [], scene=SHAKEN),
    Effect("uniform shear", ["shear.rate=1e-12"], [f"shear.rate={0.2 / MEAN_FREE_TIME!r}"]),
    Effect("rough, with t_c rule",
           ["collisions.epsilon=0.9999999999999999", "collisions.beta=-0.9999999999999999",
            "collisions.tc=1e-300"],
           ["collisions.epsilon=0.9", "collisions.beta=0", "collisions.tc_relative=1e-3"]),
    Effect("a file with the first and the last frame", [], [], ("--out", "out.h5")),
    Effect("10 frames per decade in a file", ["output.frames=10"], [], ("--out", "out.h5")),
    Effect("every collision in a file", ["output.events=true"], [], ("--out", "out.h5")),
    Effect("order of the flow, 10 samples per decade", ["output.observables=['flow_order']"], [],
           ("--out", "out.h5")),
    Effect("statistics of collisions", ["output.observables=['collision_statistics']"], [],
           ("--out", "out.h5")),
]


class Failure(Exception):
    """Something could not be measured."""


def in_folder(command, left="", scene=""):
    """Runs a command in a folder with this scene, scene.toml; returns its result and a file that it
    left there, if any."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "scene.toml").write_text(scene)
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise Failure(f"{' '.join(command)}: exit code {done.returncode}: {done.stderr}")
        return done, (Path(folder) / left).read_text() if left else ""


@dataclass
class Measured:
    """A scene of the program, to be run under valgrind."""

    program: str
    density: float
    isa: str
    settings: list
    flags: tuple = ()
    scene: str = ""
    long: float = LONG

    def command(self, tool, needles, collisions_per_needle):
        settings = [f"needles.count={needles}",
                    f"needles.box={math.cbrt(needles / self.density)!r}",
                    f"until.collisions_per_needle={collisions_per_needle}", *self.settings]
        command = [*tool, self.program, "run", "scene.toml", "--isa", self.isa, "--json", "--quiet",
                   *self.flags]
        for setting in settings:
            command += ["--set", setting]
        return command

    def run(self, collisions_per_needle):
        tool = ["valgrind", "--fair-sched=yes", "--tool=callgrind",
                "--callgrind-out-file=/dev/null"]
        done, _ = in_folder(self.command(tool, NEEDLES, collisions_per_needle), "", self.scene)
        collected = re.search(r"Collected : (\d+)", done.stderr)
        if not collected:
            raise Failure(f"callgrind: expected a line 'Collected : N', got: {done.stderr}")
        result = json.loads(done.stdout)
        return int(collected[1]), result["collisions"], result["trajectory_hash"]

    def by_function(self, collisions_per_needle):
        """Instructions of each function, and the collisions."""
        tool = ["valgrind", "--tool=callgrind", "--callgrind-out-file=callgrind"]
        done, profile = in_folder(self.command(tool, NEEDLES, collisions_per_needle), "callgrind")
        with tempfile.NamedTemporaryFile("w") as file:
            file.write(profile)
            file.flush()
            listed = subprocess.run(["callgrind_annotate", "--threshold=100", "--show-percs=no",
                                     file.name], check=True, capture_output=True, text=True).stdout
        functions = {}
        for count, name in re.findall(r"^ *([\d,]+)\s+\S*?:(.*?)(?: \[.*\])?$", listed, re.MULTILINE):
            # Without arguments, and without the types that a loop is made of.
            name = name.replace("(anonymous namespace)", "anonymous").split("(")[0]
            name = re.sub(r"(Worker|EventLoop)<[^>]*>", r"\1", name)
            functions[name] = functions.get(name, 0) + int(count.replace(",", ""))
        return functions, json.loads(done.stdout)["collisions"]

    def instructions_per_collision(self):
        start, first, _ = self.run(SHORT)
        end, last, trajectory = self.run(self.long)
        return (end - start) / (last - first), trajectory

    def heap_of_the_loop(self, needles):
        """The most bytes that are held while events happen; setting up takes as many, for a while."""
        tool = ["valgrind", "--tool=massif", "--peak-inaccuracy=0.0", "--massif-out-file=massif"]
        _, massif = in_folder(self.command(tool, needles, 0.2), "massif", self.scene)
        snapshots = [(int(time), int(held)) for time, held in
                     re.findall(r"time=(\d+)\nmem_heap_B=(\d+)", massif)]
        end = snapshots[-1][0]
        return max(held for time, held in snapshots if 0.6 * end < time < 0.95 * end)


def measure_all(jobs):
    """The results of functions without arguments, by their names; as many at once as cores."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        futures = {name: pool.submit(job) for name, job in jobs.items()}
        return {name: future.result() for name, future in futures.items()}


def build_of(program):
    """Compiler and flags, on which the number of instructions depends."""
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    lines = dict(line.split(None, 1) for line in version.stdout.splitlines())
    return {"compiler": lines["compiler"].strip(), "flags": lines["flags"].strip()}, lines["ISA"]


def guard(program, update):
    build, offered = build_of(program)
    for isa in "scalar", "avx2":
        if isa not in offered.split():
            print(f"skipped: this CPU does not have {isa}")
            return SKIPPED
    jobs = {f"{scene}/{isa}": Measured(program, density, isa, []).instructions_per_collision
            for scene, density in DENSITIES.items() for isa in ("scalar", "avx2")}
    committed = json.loads(COMMITTED.read_text()) if COMMITTED.exists() else None
    if not update and committed is None:
        raise Failure(f"{COMMITTED}: expected it to exist (--update makes it)")
    if not update and committed["build"] != build:
        print(f"skipped: the figures are those of {committed['build']}, this program is {build}")
        return SKIPPED

    # Libraries choose their instructions by the CPU, and there are some that valgrind does not know.
    tried = subprocess.run(["valgrind", "--tool=none", program, "--version"], capture_output=True,
                           text=True)
    if "Unrecognised instruction" in tried.stderr:
        print("skipped: valgrind does not know an instruction of the libraries on this CPU")
        return SKIPPED

    counted = measure_all(jobs)
    for scene in DENSITIES:
        if counted[f"{scene}/scalar"][1] != counted[f"{scene}/avx2"][1]:
            raise Failure(f"{scene}: the trajectories by scalar and avx2 differ")
    figures = {name: round(count) for name, (count, _) in counted.items()}
    if update:
        content = {"what": "instructions per collision, by callgrind", "needles": NEEDLES,
                   "build": build, "figures": figures}
        COMMITTED.write_text(json.dumps(content, indent=1) + "\n")
    return judge(figures, figures if update else committed["figures"])


def judge(figures, expected):
    """Prints how figures compare with those expected; 1 if one has grown too much, else 0."""
    if expected.keys() != figures.keys():
        raise Failure(f"{COMMITTED}: figures: expected {', '.join(figures)}")
    grown = []
    for name, count in figures.items():
        change = count / expected[name] - 1
        verdict = "ok"
        if change > TOLERANCE:
            verdict = "GROWN"
            grown.append(name)
        elif change < -TOLERANCE:
            verdict = "less: commit it with --update, or it may be lost again unnoticed"
        print(f"{name:14} {count:8} per collision, committed {expected[name]:8}, "
              f"{100 * change:+6.2f} %  {verdict}")
    if grown:
        print(f"{', '.join(grown)}: more than {100 * TOLERANCE:g} % above bench/{COMMITTED.name}.\n"
              f"If that is worth it, commit the new figures with the change that causes them, and "
              f"say why:\n    bench/instructions.py guard --update")
    return 1 if grown else 0


def effects(program, out, only):
    chosen = [effect for effect in EFFECTS if only in effect.name]
    build, offered = build_of(program)
    isa = "avx2" if "avx2" in offered.split() else "scalar"

    def measured(settings, flags=(), scene="", long=LONG):
        return Measured(program, DENSITIES["dilute"], isa, PLAIN + settings, flags, scene, long)

    plain_bytes = measured([]).heap_of_the_loop(NEEDLES)
    jobs = {("off", 2): measured([], TWO_THREADS).instructions_per_collision}
    for long in {effect.long for effect in chosen}:
        jobs["off", 1, long] = measured([], long=long).instructions_per_collision
    for effect in chosen:
        on = measured(effect.neutral, effect.flags, effect.scene, effect.long)
        jobs[effect.name, "on"] = on.instructions_per_collision
        if not effect.flags:  # of what writes files, HDF5 holds much more than the engine
            jobs[effect.name, "bytes"] = lambda on=on: on.heap_of_the_loop(NEEDLES)
            in_action = measured(effect.acting or effect.neutral, TWO_THREADS, effect.scene,
                                 effect.long)
            jobs[effect.name, 2] = in_action.instructions_per_collision
        if effect.acting:
            acting = measured(effect.acting, long=effect.long)
            jobs[effect.name, "acting"] = acting.instructions_per_collision
    counted = measure_all(jobs)

    off_by_two = counted["off", 2][0]
    lines = [f"| effect | off | on | costs | in action | two threads ({off_by_two:.0f} without) | "
             "bytes per needle |",
             "|---|---|---|---|---|---|---|"]
    for effect in chosen:
        off, trajectory = counted["off", 1, effect.long]
        on, its_trajectory = counted[effect.name, "on"]
        same = "" if its_trajectory == trajectory else " *"
        acting = f"{counted[effect.name, 'acting'][0]:.0f}" if effect.acting else ""
        held = by_two = ""
        if not effect.flags:
            held = f"{(counted[effect.name, 'bytes'] - plain_bytes) / NEEDLES:+.1f}"
            by_two = f"{counted[effect.name, 2][0]:.0f}"
        until = f", to {effect.long:g}" if effect.long != LONG else ""
        costs = 100 * (on / off - 1)
        lines.append(f"| {effect.name}{until} | {off:.0f} | {on:.0f}{same} | {costs:+.1f} % "
                     f"| {acting} | {by_two} | {held} |")
    text = (f"Instructions per collision, from {SHORT} to {LONG} collisions per needle, or to as "
            f"many as a row says, of {NEEDLES} needles at n L^3 = {DENSITIES['dilute']:.2f}, {isa}; "
            f"{build['compiler']}, {build['flags']}.\n\n" + "\n".join(lines) + "\n")
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text)
    if out == EFFECTS_TABLE:
        put_table("effects", brief_effects(text), "performance.md")
    print(text, end="")
    return 0


def brief_effects(text):
    """What a collision with an effect costs more, in action where that is another trajectory, and
    bytes per needle, from the whole table."""
    rows = []
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) != 7 or not cells[1].isdigit():
            continue
        name, off, on, _, acting, _, held = cells
        price = 100 * (float(acting or on.rstrip(" *")) / float(off) - 1)
        rows.append([name, f"{round(price):+d} %", held])
    return measured.table(["effect", "instructions per collision", "bytes per needle"], rows)


def shares(program):
    build, offered = build_of(program)
    isa = "avx2" if "avx2" in offered.split() else "scalar"

    def count(density, collisions_per_needle):
        return lambda: Measured(program, density, isa, []).by_function(collisions_per_needle)

    counted = measure_all({(scene, length): count(density, length)
                           for scene, density in DENSITIES.items() for length in (SHORT, LONG)})
    columns = {}
    for scene in DENSITIES:
        (start, first), (end, last) = counted[scene, SHORT], counted[scene, LONG]
        sums = dict.fromkeys(SHARES, 0)
        for part, names in SHARES.items():
            if not any(re.search(names, function) for function in end):
                raise Failure(f"{scene}: no function is of the part '{part}': SHARES is out of date")
        for function, instructions in end.items():
            part = next(part for part, names in SHARES.items() if re.search(names, function))
            sums[part] += (instructions - start.get(function, 0)) / (last - first)
        columns[scene] = sums
    totals = {scene: sum(sums.values()) for scene, sums in columns.items()}
    heads = [f"{scene}, {1e-3 * totals[scene]:.0f} thousand" for scene in DENSITIES]
    lines = ["| | " + " | ".join(heads) + " |", "|---" * (1 + len(heads)) + "|"]
    for part in SHARES:
        cells = [f"{100 * columns[scene][part] / totals[scene]:.0f} %" for scene in DENSITIES]
        lines.append(f"| {part} | " + " | ".join(cells) + " |")
    text = (f"Instructions per collision, from {SHORT} to {LONG} collisions per needle of "
            f"{NEEDLES} needles, {isa}; {build['compiler']}, {build['flags']}.\n\n"
            + "\n".join(lines) + "\n")
    if COMMITTED.exists() and json.loads(COMMITTED.read_text())["build"] == build:
        put_result("shares.md", "Where the instructions of a collision go", text)
    else:
        print("Not put into results/shares.md: its table is of another compiler or flags.\n")
    print(text, end="")
    return 0


def baseline(program):
    classical = ["engine.search=linked-lists", "engine.queue=indexed-heap"]

    def count(density, side):
        sides = [f"engine.cell_side={side}"] if side else []
        return Measured(program, density, "scalar",
                        PLAIN + classical + sides).instructions_per_collision

    jobs = {(density, side): count(density, side) for density, sides in CELL_SIDES.items()
            for side in [None, *sides]}
    for (density, side), (figure, _) in measure_all(jobs).items():
        print(f"n L^3 = {density:5.2f}, cells of {side or 'its own choice':14}  {figure:.0f}")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["guard", "effects", "shares", "baseline"])
    parser.add_argument("--program", default=str(BENCH.parent / "build/release/needlework"))
    parser.add_argument("--update", action="store_true",
                        help="guard: write the figures instead of comparing with them")
    parser.add_argument("--out", type=Path, default=EFFECTS_TABLE,
                        help="effects: the file to write")
    parser.add_argument("--only", default="", metavar="TEXT",
                        help="effects: only those with this in their names; needs --out")
    arguments = parser.parse_args()
    if arguments.only and arguments.out == EFFECTS_TABLE:
        parser.error("--only needs --out: expected a file other than that of all effects")
    program = Path(arguments.program)
    arguments.program = measured.built(program.parent, program.name)
    try:
        if arguments.what == "guard":
            return guard(arguments.program, arguments.update)
        if arguments.what == "shares":
            return shares(arguments.program)
        if arguments.what == "baseline":
            return baseline(arguments.program)
        return effects(arguments.program, arguments.out, arguments.only)
    except (Failure, OSError, subprocess.CalledProcessError) as error:
        print(f"instructions.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
