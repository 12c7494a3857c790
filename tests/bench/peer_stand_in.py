#!/usr/bin/python3
"""Behaves like dynarun of DynamO, or md of EDMD, as far as bench/peers/peers.py can see.

    peer_stand_in.py dynarun CONFIG -c EVENTS [-E] [-o FILE] [--out-data-file FILE]
    peer_stand_in.py md

dynarun takes the collisions of lines and their time from Needlework (STAND_IN_PROGRAM), which
imports CONFIG; with -E it does not simulate. md computes the collisions of the spheres in init.sph
from kinetic theory. After that, both take STAND_IN_US microseconds of CPU time per collision.
STAND_IN_SLOW multiplies all rates, STAND_IN_FAILS names a program that fails, and
STAND_IN_THERMOSTAT switches that of md on. Calls are appended to STAND_IN_LOG.
"""

import argparse
import math
import os
import sys
import time
from pathlib import Path

SLOW = float(os.environ.get("STAND_IN_SLOW", "1"))


def take_time(collisions):
    end = time.process_time() + 1e-6 * float(os.environ["STAND_IN_US"]) * collisions
    while time.process_time() < end:
        pass


def simulate_lines(config, needles, events):
    """The time at which Needlework has done as many collisions."""
    import json
    import subprocess

    program = os.environ["STAND_IN_PROGRAM"]
    subprocess.run([program, "import", config, "--out", "lines"], check=True, capture_output=True)
    done = subprocess.run([program, "run", "lines/scene.toml", "--json", "--quiet", "--set",
                           f"until.collisions_per_needle={2 * events / needles!r}"],
                          check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    result = json.loads(done.stdout)
    assert result["collisions"] == events, result
    return result["time"]


def dynarun(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("config")
    parser.add_argument("-c", "--events", type=int, required=True)
    parser.add_argument("-E", "--equilibrate", action="store_true")
    parser.add_argument("-o", "--out-config-file", default="config.out.xml.bz2")
    parser.add_argument("--out-data-file", default="output.xml.bz2")
    options = parser.parse_args(arguments)
    print("dynarun  Copyright (C) 2011  Marcus N Campbell Bannerman")
    misc = ""
    if not options.equilibrate:
        text = Path(options.config).read_text()
        assert 'Interaction Type="Lines"' in text
        end = simulate_lines(options.config, text.count("<Pt "), options.events) / SLOW
        misc = (f'<Misc><Duration Events="{options.events}" OneParticleEvents="0" TwoParticleEvents='
                f'"{options.events}" VirtualEvents="12345" Time="{end!r}"/></Misc>')
        print(f"Total events executed {options.events}\nSimulation end time  {end:g}")
    Path(options.out_data_file).write_text(f"<?xml version=\"1.0\"?><OutputData>{misc}</OutputData>")
    Path(options.out_config_file).write_text("<DynamOconfig/>")
    take_time(options.events)


def md(arguments):
    assert not arguments, arguments
    count, box, *spheres = Path("init.sph").read_text().splitlines()
    lengths = [float(x) for x in box.split()]
    assert len(spheres) == int(count) and all(line.split()[4] == "0.5" for line in spheres)
    print("Seed: 1\nPlacing particles\nStarting configuration read from init.sph")
    if os.environ.get("STAND_IN_THERMOSTAT"):
        print("Started thermostat")
    # Enskog's rate by the compressibility factor of Carnahan and Starling.
    eta = math.pi / 6 * len(spheres) / math.prod(lengths)
    compressibility = (1 + eta + eta**2 - eta**3) / (1 - eta)**3
    rate = SLOW * 6 / math.sqrt(math.pi) * (compressibility - 1)
    for t in range(11):
        # Spheres on a lattice begin to collide later.
        collisions = int(rate * len(spheres) / 2 * max(0, t - 0.5))
        print(f"Simtime: {t:f}, Collisions: {collisions}, Press: 1.000000, T: 1.000000, Listsizes: "
              "(1.000000, 0), Neigh: 0 - 3")
    take_time(collisions)
    print(f"Total time simulated  : {t:f}")


if __name__ == "__main__":
    name, *rest = sys.argv[1:]
    with open(os.environ["STAND_IN_LOG"], "a") as log:
        log.write(" ".join([name, *rest]) + "\n")
    if os.environ.get("STAND_IN_FAILS") == name:
        print("one\ntwo\nthree\nfour\nInitialising")
        print("Main(): Particle 7 has no species\n", file=sys.stderr)
        sys.exit(1)
    {"dynarun": dynarun, "md": md}[name](rest)
