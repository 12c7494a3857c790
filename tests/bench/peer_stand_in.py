#!/usr/bin/python3
"""Behaves like dynarun of DynamO, or md of EDMD, as far as bench/peers/peers.py can see.

    peer_stand_in.py dynarun CONFIG -c EVENTS [-E] [-o FILE] [--out-data-file FILE]
    peer_stand_in.py md

dynarun takes collisions and their times from Needlework (STAND_IN_PROGRAM), which imports CONFIG; with
-E it does not simulate, and with -L Trajectory it writes trajectory.out. md computes the collisions of
the spheres in init.sph from kinetic theory. After that, both take STAND_IN_US microseconds of CPU time
per collision. STAND_IN_SLOW multiplies all rates, STAND_IN_FAILS names a program that fails,
STAND_IN_SWAPS a collision that has another pair in trajectory.out, and STAND_IN_THERMOSTAT switches that
of md on. Calls are appended to STAND_IN_LOG.
"""

import argparse
import math
import os
import re
import sys
import time
from pathlib import Path

SLOW = float(os.environ.get("STAND_IN_SLOW", "1"))


def take_time(collisions):
    end = time.process_time() + 1e-6 * float(os.environ["STAND_IN_US"]) * collisions
    while time.process_time() < end:
        pass


def simulate(config, particles, events, state):
    """Time and pressure at which Needlework has done as many collisions. Leaves the state that it
    reaches as a configuration, and collisions in run/run.h5."""
    import json
    import subprocess

    program = os.environ["STAND_IN_PROGRAM"]
    subprocess.run([program, "import", config, "--out", "run", "--force"], check=True,
                   capture_output=True)
    done = subprocess.run([program, "run", "run/scene.toml", "--json", "--quiet", "--force", "--set",
                           f"until.collisions_per_needle={2 * events / particles!r}", "--set",
                           "output.file=run/run.h5", "--set", "output.events=true"],
                          check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    subprocess.run([program, "export", "run/run.h5", state, "--force"], check=True,
                   capture_output=True)
    result = json.loads(done.stdout)
    assert result["collisions"] == events, result
    # Needles have the pressure of an ideal gas.
    volume = math.prod(float(x) for x in re.search(
        r'SimulationSize x="(.*?)" y="(.*?)" z="(.*?)"', Path(config).read_text()).groups())
    pressure = (result.get("rods") or {}).get("pressure")
    return result["time"], particles / volume if pressure is None else pressure


def write_trajectory():
    """As DynamO does, of collisions and of hits of walls."""
    sys.path.append(os.environ["STAND_IN_H5PY"])  # the start of Python without it is quicker
    import h5py

    with h5py.File("run/run.h5") as file:
        times, pairs = file["events/time"][:], file["events/pair"][:]
        hits = file["events/kind"][:] if "kind" in file["events"] else [0] * len(times)
    text = ""
    for number, (time_of_it, (i, j), hit) in enumerate(zip(times, pairs, hits), 1):
        if os.environ.get("STAND_IN_SWAPS") == str(number):
            j += 1
        begin, end = f"{number:08}, Source=", f"t={time_of_it:.4f}, dt=0.0001\n"
        text += (f"{begin}Local, SourceID=0, Event Type=WALL, {end}   1PEvent: p1={i}, Type=WALL, "
                 "delP1=<0,0,1>\n\n" if hit else
                 f"{begin}Interaction, SourceID=0, Event Type=CORE, {end}\n   2PEvent: p1={i:05}, "
                 f"p2={j:05}, delP1=<0,0,1>, |r12|=    1\n")
    Path("trajectory.out").write_text(text)


def dynarun(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("config")
    parser.add_argument("-c", "--events", type=int, required=True)
    parser.add_argument("-E", "--equilibrate", action="store_true")
    parser.add_argument("-o", "--out-config-file", default="config.out.xml.bz2")
    parser.add_argument("--out-data-file", default="output.xml.bz2")
    parser.add_argument("-L", "--load-plugin", default="")
    options = parser.parse_args(arguments)
    print("dynarun  Copyright (C) 2011  Marcus N Campbell Bannerman")
    misc = ""
    if not options.equilibrate:
        particles = Path(options.config).read_text().count("<Pt ")
        end, pressure = simulate(options.config, particles, options.events, options.out_config_file)
        end /= SLOW
        misc = (f'<Misc><Pressure Avg="{pressure!r}"><Tensor>1 0 0</Tensor></Pressure><Duration '
                f'Events="{options.events}" OneParticleEvents="0" TwoParticleEvents='
                f'"{options.events}" VirtualEvents="12345" Time="{end!r}"/></Misc>')
        print(f"Total events executed {options.events}\nSimulation end time  {end:g}")
        if options.load_plugin == "Trajectory":
            write_trajectory()
    else:
        Path(options.out_config_file).write_text("<DynamOconfig/>")
    Path(options.out_data_file).write_text(f"<?xml version=\"1.0\"?><OutputData>{misc}</OutputData>")
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
    pressure = len(spheres) / math.prod(lengths) * compressibility
    for t in range(11):
        # Times between collisions scatter.
        collisions = int(rate * len(spheres) / 2 * t * (1 + 0.004 * math.sin(t)))
        print(f"Simtime: {t:f}, Collisions: {collisions}, Press: {pressure + 0.01 * math.sin(t):f}, T: "
              "1.000000, Listsizes: (1.000000, 0), Neigh: 0 - 3")
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
