#!/usr/bin/python3
"""Makes all tables and pictures of performance, accuracy, scaling and effects, on this machine.

    bench/all.py                      three quarters of an hour, on two cores of an EPYC with
                                      AVX-512; with other engines an hour and 40 minutes
    bench/all.py --list               what it does, and how long each step takes
    bench/all.py --time-budget 60     no step is begun after an hour; the same command continues
    bench/all.py --only rods effects  some steps
    bench/all.py --dynamo FOLDER --edmd FOLDER   beside other engines, too (bench/peers/README.md)

Build first, with tests and NEEDLEWORK_BENCH=ON, from a commit without changes. Says first how long it
will take: by what the steps took before, or else by estimates. Each step is a script of bench/ that can
be run by itself; it writes compact data into bench/results/MACHINE-ISA/ and its tables into the
documents. Steps that are complete at this commit and of this build are not repeated. `--quick` tries
each in a few minutes, on a few needles; then results stay in the folder of the build and documents as
they are.
"""

import argparse
import json
import math
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import measured

BENCH = Path(__file__).resolve().parent
PEERS = "peers", "cross-check"


@dataclass(frozen=True)
class Step:
    """A script with its options; its results, and how long it should take on two quiet cores."""

    name: str
    script: str
    options: tuple
    quick: tuple  # options in place of these
    minutes: float
    makes: str


STEPS = [
    Step("performance", "performance.py", ("--no-instructions",), ("--no-instructions", "--quick"),
         14, "times by search, calendar, instruction set, size, density and threads"),
    Step("accuracy", "accuracy/accuracy.py", ("--readme",), ("pairs", "--quick"), 25,
         "cost against error of each level of accuracy"),
    Step("rods", "rods_price.py", (), ("--rounds", "0", "--threads", "1", "--dry"), 2,
         "what rods and spheres cost"),
    Step("effects", "instructions.py", ("effects",), ("effects", "--only", "normal restitution",
                                                      "--out", "{folder}/effects.md"), 2,
         "instructions and bytes of each effect, off and on, on one and two threads"),
    Step("shares", "instructions.py", ("shares",), (), 1, "where instructions go"),
    Step("build", "build_cost.py", (), ("--dry",), 3,
         "how many event loops are compiled, sizes, and how long the compiler takes"),
    Step("peers", "peers/peers.py", ("--document",),
         ("--repetitions", "6", "--scene", "spheres-0.1", "--out", "{folder}/peers.md"), 28,
         "what a collision costs in other engines"),
    Step("cross-check", "peers/cross_check.py", ("--document",), ("--case", "small"), 25,
         "whether other engines do the same"),
]


class Progress:
    """Which steps are complete, and how long each took last, in the folder of the build."""

    def __init__(self, store):
        self.store = store
        content = store.load("all") or {}
        self.complete = content.get("complete", [])
        file = store.folder / "all-seconds.json"  # of any commit
        self.seconds = json.loads(file.read_text()) if file.exists() else {}

    def expected(self, step):
        """Seconds."""
        if step.name in self.seconds:
            return self.seconds[step.name]
        return 60 * (1 if self.store.quick else step.minutes)

    def add(self, step, seconds):
        self.complete.append(step.name)
        self.seconds[step.name] = round(seconds, 1)
        self.store.save("all", {"complete": self.complete})
        (self.store.folder / "all-seconds.json").write_text(json.dumps(self.seconds) + "\n")


def command_of(step, arguments, folder):
    options = step.quick if arguments.quick else step.options
    command = [sys.executable, str(BENCH / step.script),
               *(option.format(folder=folder) for option in options)]
    if step.name in PEERS:
        for name in ("dynamo", "edmd"):
            if folder_of_peer := getattr(arguments, name):
                command += [f"--{name}", str(folder_of_peer)]
    elif step.name in ("performance", "accuracy"):
        return [*command, "--build", str(arguments.build)]
    return [*command, "--program", str(arguments.build / "needlework")]


def minutes(seconds):
    return f"{max(1, math.ceil(seconds / 60))} min"


def describe(steps, progress):
    """What is to be done, and how long it takes."""
    left = [step for step in steps if step.name not in progress.complete]
    for step in steps:
        print(f"{step.name:12} {'done' if step not in left else minutes(progress.expected(step)):>7}"
              f"  {step.makes}")
    total = sum(map(progress.expected, left))
    print(f"{len(left)} of {len(steps)} steps are left, about {minutes(total)} on quiet cores",
          flush=True)
    return left


def main():
    names = [step.name for step in STEPS]
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=names, metavar="STEP",
                        help=f"some of {', '.join(names)}")
    parser.add_argument("--list", action="store_true", help="say what it would do, and end")
    parser.add_argument("--dynamo", type=Path, metavar="FOLDER")
    parser.add_argument("--edmd", type=Path, metavar="FOLDER")
    measured.add_options(parser)
    arguments = parser.parse_args()
    with_peers = arguments.dynamo or arguments.edmd
    if arguments.only and set(arguments.only) & set(PEERS) and not with_peers:
        parser.error(f"--only {' '.join(arguments.only)}: expected --dynamo FOLDER or --edmd FOLDER, "
                     "too")
    steps = [step for step in STEPS if step.name in (arguments.only or names)
             and (with_peers or step.name not in PEERS) and not (arguments.quick and not step.quick)]
    store = measured.store_of(arguments)
    progress = Progress(store)
    left = describe(steps, progress)
    if arguments.list:
        return
    store.folder.mkdir(parents=True, exist_ok=True)
    begin, failed = time.monotonic(), []
    for step in left:
        if time.monotonic() - begin > 60 * arguments.time_budget:
            print(f"the time budget is used up before {step.name}; the same command continues")
            return
        print(f"== {step.name}", flush=True)
        start = time.monotonic()
        done = subprocess.run(command_of(step, arguments, store.folder))
        if done.returncode == 0:
            progress.add(step, time.monotonic() - start)
        else:
            failed.append(f"{step.name} (exit code {done.returncode})")
    if failed:
        sys.exit(f"not complete: {', '.join(failed)}; the same command continues")
    print("all steps are complete")


if __name__ == "__main__":
    measured.run(main)
