#!/usr/bin/python3
"""Checks that Needlework and other engines, which you have built, do the same from the same state.

    bench/peers/cross_check.py --dynamo FOLDER --edmd FOLDER
    bench/peers/cross_check.py --dynamo FOLDER --case lines --events 1000

FOLDER is that of bench/peers/peers.py. Compares partners and times of the first collisions and hits of
walls with DynamO, collision rates and pressures of long runs with DynamO and EDMD, and lists small
inputs whose answer is known exactly, with what each engine says of them. Exits with 1 if first collisions or long
runs differ, or if Needlework errs on a small input; with 2 if an argument is wrong.
"""

import argparse
import math
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from time import gmtime, strftime

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import measured  # noqa: E402
from engines import Dynamo, Edmd, Needlework, Run, version_of, write_spheres  # noqa: E402
from peers import add_options, find_programs  # noqa: E402
from readme import put_result  # noqa: E402

# DynamO prints times with four decimals. Slower by this power of two, which changes no digit of a
# trajectory, they have six more.
SLOWER = 2.0**-20
TITLE = "Whether other engines do the same"
LIMIT_S = 10  # for a small input, which takes milliseconds
TOLERANCE = 1e-7  # of times of first collisions, in L sqrt(m/T)
ERRORS = 3  # by how many standard errors means of long runs may differ

NEEDLES = "needles = {{ count = {count}, box = {box!r} }}\n"
SPHERES = ("needles.box = {box!r}\n{more}"
           "[[species]]\nname = 'sphere'\ncount = {count}\nlength = 0\ndiameter = 1\n")
WALLS = "forces.gravity = [0, 0, -0.3]\nwalls = [{ axis = 'z', side = 'both' }]\n"
FIRST = {  # scene, time before, and how far its walls are moved outwards
    "lines": (NEEDLES.format(count=400, box=4.5), 0.5, 0),
    "spheres": (SPHERES.format(count=400, box=8.87, more=""), 0.5, 0),
    # Walls of DynamO stop the centres of lines; here none comes near them.
    "lines-falling": (NEEDLES.format(count=400, box=4.5) + WALLS, 0.5, 100),
    "spheres-falling": (SPHERES.format(count=400, box=8.87, more=WALLS), 0.5, 0),
}
LONG = {  # scene, bodies, diameter, box
    "long-lines-dilute": (NEEDLES, 1000, 0.0, 11.2),
    "long-lines-dense": (NEEDLES, 1000, 0.0, 4.42),
    "long-spheres-0.1": (SPHERES, 1000, 1.0, math.cbrt(1000 * math.pi / 0.6)),
    "long-spheres-0.3": (SPHERES, 1000, 1.0, math.cbrt(1000 * math.pi / 1.8)),
    "long-spheres-0.49": (SPHERES, 1000, 1.0, math.cbrt(1000 * math.pi / 2.94)),
}
PER_BLOCK = 20  # collisions per body


def slowed(configuration):
    """A configuration of DynamO in which all is slower by SLOWER."""
    def scaled(factor):
        return lambda found: found[1] + re.sub(
            r'"([^"]+)"', lambda number: f'"{float(number[1]) * factor!r}"', found[2])

    text = re.sub(r"(<[VO]\b)([^>]*)", scaled(SLOWER), configuration)
    return re.sub(r"(<g\b)([^>]*)", scaled(SLOWER**2), text)


def with_walls_apart(configuration, distance):
    """The same with each wall, which is normal to z, further away from the other."""
    def moved(found):
        z = float(found[2])
        return f'{found[1]}{math.copysign(abs(z) + distance, z)!r}'

    text = re.sub(r'(<Origin x="[^"]*" y="[^"]*" z=")([^"]+)', moved, configuration)
    return re.sub(r'(<SimulationSize x="[^"]*" y="[^"]*" z=")([^"]+)',
                  lambda found: f"{found[1]}{float(found[2]) + 4 * distance!r}", text)


def our_collisions(ours, configuration, bodies, events):
    """Times and partners of the first events of a configuration: two of collisions, one of hits."""
    import h5py

    folder = configuration.removesuffix(".xml")
    ours.import_configuration(configuration, folder)
    ours.result(f"{folder}/scene.toml", f"until.collisions_per_needle={2 * events / bodies!r}",
                f"output.file={folder}/run.h5", "output.events=true")
    with h5py.File(ours.folder / folder / "run.h5") as file:
        pairs = file["events/pair"][:]
        hits = file["events/kind"][:] if "kind" in file["events"] else [0] * len(pairs)
        return [(time, (int(pair[0]),) if hit else tuple(map(int, pair)))
                for time, pair, hit in zip(file["events/time"][:], pairs, hits)]


def their_collisions(dynamo, configuration, events, limit_s=None):
    """The same of DynamO."""
    (dynamo.folder / "trajectory.out").unlink(missing_ok=True)
    dynamo.run(configuration, events, 1, counts=True, options=["-L", "Trajectory"], limit_s=limit_s)
    text = (dynamo.folder / "trajectory.out").read_text()
    return [(float(time), tuple(int(number) for number in partners if number))
            for time, *partners in re.findall(
                r"Event Type=(?:CORE|WALL), t=([^,]+),[^\n]*\n\s*[12]PEvent: p1= *(\d+)"
                r"(?:, p2= *(\d+))?", text)]


def compare_first(name, program, dynarun, folder, events):
    """Row of the table, and whether pairs and times are the same."""
    scene, settled, apart = FIRST[name]
    ours, dynamo = Needlework(program, folder), Dynamo(dynarun, folder)
    (folder / "scene.toml").write_text(scene)
    # Not at a collision, of whose partners a configuration does not say that they have just met.
    ours.result("scene.toml", f"until.time={settled}", "output.file=start.h5", "output.frames=1")
    ours.export("start.h5", "start.xml")
    text = (folder / "start.xml").read_text()
    (folder / "slow.xml").write_text(slowed(with_walls_apart(text, apart) if apart else text))
    first = our_collisions(ours, "slow.xml", 400, events)[:events]
    second = their_collisions(dynamo, "slow.xml", events)[:events]
    largest, same = 0.0, 0
    for (time, partners), (other_time, other_partners) in zip(first, second):
        if partners != other_partners or abs(time - other_time) * SLOWER > TOLERANCE:
            break
        largest = max(largest, abs(time - other_time) * SLOWER)
        same += 1
    row = [name, f"first {events} events", f"{same} with the same partners and time",
           f"times within {largest:.1e}"]
    if same < events:
        def told(collisions):
            time, partners = collisions[same]
            return f"{' and '.join(map(str, partners))} at {time * SLOWER:.10f}"

        row[3] += (f"; then ours {told(first)}, theirs " +
                   (told(second) if same < len(second) else "none"))
    return row, same == events


def mean_and_error(values):
    if any(math.isnan(value) for value in values):  # pressures of needles, of which ours says nothing
        return math.nan, math.nan
    return statistics.fmean(values), statistics.stdev(values) / math.sqrt(len(values))


def our_blocks(ours, bodies, blocks):
    """Runs of one block after the other, the first of which is left out."""
    runs, state = [], "start.h5"
    for block in range(blocks + 1):
        runs.append(ours.run("scene.toml", bodies, f"initial.file={state}",
                             f"until.collisions_per_needle={PER_BLOCK}",
                             f"output.file=block{block}.h5", "output.frames=1"))
        state = f"block{block}.h5"
    return runs[1:]


def dynamo_blocks(dynamo, bodies, blocks):
    runs, state = [], "start.xml"
    for block in range(blocks + 1):
        runs.append(dynamo.run(state, bodies * PER_BLOCK // 2, bodies, counts=True,
                               end=f"block{block}.xml"))
        state = f"block{block}.xml"
    return runs[1:]


def edmd_blocks(edmd, bodies):
    _, blocks = edmd.blocks()
    return [Run(rate=2 * collisions / (bodies * duration), pressure=pressure)
            for duration, collisions, pressure in blocks[1:]]


def compare_long(name, program, dynarun, variants, folder, blocks):
    """Rows of the table, and whether all means agree."""
    scene, bodies, diameter, box = LONG[name]
    ours = Needlework(program, folder)
    (folder / "scene.toml").write_text(scene.format(count=bodies, box=box, more=""))
    drawn = ours.result("scene.toml", "until.collisions_per_needle=0", "output.file=start.h5",
                        "output.frames=1")[2]
    ours.export("start.h5", "start.xml")
    of = {"Needlework": our_blocks(ours, bodies, blocks)}
    if dynarun:
        of["DynamO"] = dynamo_blocks(Dynamo(dynarun, folder), bodies, blocks)
    if diameter:
        write_spheres(folder / "start.xml", folder / "init.sph")
        of |= {variant: edmd_blocks(Edmd(md, folder), bodies) for variant, md in variants.items()}
    rows, agree = [], True
    for what in ("rate", "pressure"):
        means = {engine: mean_and_error([getattr(run, what) for run in runs])
                 for engine, runs in of.items()}
        if not diameter:  # needles exclude no volume
            means["exact"] = ((drawn["collision_rate_exact"] if what == "rate"
                               else bodies / box**3), 0.0)
        known = {engine: m for engine, m in means.items() if math.isfinite(m[0])}
        (first, (value, error)), *others = known.items()
        for engine, (other, other_error) in others:
            # An error may be 0 where nothing fluctuates; the texts have rounded numbers.
            deviation = (other - value) / max(math.hypot(error, other_error), 1e-9 * abs(value))
            agree &= abs(deviation) <= ERRORS
            rows.append([name, what, f"{first} {value:.5g} ± {error:.1g}, {engine} {other:.5g}"
                         + (f" ± {other_error:.1g}" if other_error else ""),
                         f"{deviation:+.1f} standard errors"])
    return rows, agree


SMALL_HEAD = '''<?xml version="1.0"?>
<DynamOconfig version="1.5.0">
  <Simulation>
    <Scheduler Type="NeighbourList"><Sorter Type="BoundedPQMinMax3"/></Scheduler>
    <SimulationSize x="12" y="12" z="12"/>
    <Genus><Species Mass="1" InertiaConstant="0.0833333333333333333" Name="Bulk" Type="SphericalTop">
      <IDRange Type="All"/></Species></Genus>
    <BC Type="PBC"/>
    <Topology/>
    <Interactions><Interaction Type="Lines" Length="1" Elasticity="1" Name="Bulk">
      <IDPairRange Type="All"/></Interaction></Interactions>
    <Locals/><Globals/><SystemEvents/>
    <Dynamics Type="Newtonian"/>
  </Simulation>
  <Properties/>
  <ParticleData OrientationData="Y">
'''


def line(number, centre, velocity, spin, axis):
    """A needle along x, y or z."""
    def vector(name, values):
        return f"<{name} " + " ".join(f'{c}="{v}"' for c, v in zip("xyz", values)) + "/>"

    half = math.sqrt(0.5)
    turn = {"x": (0, half, 0, half), "y": (-half, 0, 0, half), "z": (0, 0, 0, 1)}[axis]
    quaternion = "<U " + " ".join(f'{c}="{v!r}"' for c, v in zip("xyzw", turn)) + "/>"
    return (f'<Pt ID="{number}">' + vector("P", centre) + vector("V", velocity)
            + vector("O", spin) + quaternion + "</Pt>\n")


# Needle 1, along y, comes down on needle 0, along x, and touches it at t = 1. Where it is at t = 0
# follows from that; a third needle is far away. Spins of the two.
SMALL = {
    "lines turn about two axes": ((0, 0, 0.3), (0.2, 0, 0)),
    "about parallel axes": ((0, 0, 0.3), (0, 0, 0.2)),
    "one does not turn": ((0, 0, 0), (0.2, 0, 0)),
    "none turns": ((0, 0, 0), (0, 0, 0)),
}


def small_inputs(program, dynarun, folder):
    """Rows of the table, and whether ours finds all contacts."""
    rows, right = [], True
    for name, (spin, other_spin) in SMALL.items():
        # At t = 1 needle 0 has turned about z, and is at y = 0.1 tan(turn) where x = 0.1.
        height = 2 - 0.1 * math.tan(spin[2]) * math.tan(other_spin[0])
        needles = [line(0, (0, 0, 0), (0, 0, 0.5), spin, "x"),
                   line(1, (0.1, 0, height), (0, 0, -1.5), other_spin, "y"),
                   line(2, (4, 4, -4), (0, 0, 1), (0.1, 0, 0), "z")]
        (folder / "small.xml").write_text(
            slowed(SMALL_HEAD + "".join(needles) + "  </ParticleData>\n</DynamOconfig>\n"))

        def said(find):
            try:
                collisions = find()
            except ValueError as error:
                return " ".join(str(error).split())[-120:]
            if not collisions:
                return "none"
            time, (i, j) = collisions[0]
            return f"{i} and {j} at {time * SLOWER:.8f}"

        first = said(lambda: our_collisions(Needlework(program, folder), "small.xml", 3, 1))
        second = said(lambda: their_collisions(Dynamo(dynarun, folder), "small.xml", 1,
                                               LIMIT_S))
        exact = "0 and 1 at 1.00000000"
        right &= first == exact
        verdict = "**ours errs**" if first != exact else (
            "same" if second.startswith(exact[:-2]) else "**DynamO errs**")
        rows.append([f"small: {name}", "first collision", f"exact: {exact}",
                     f"ours: {first}; DynamO: {second}", verdict])
    return rows, right


def origin(dynarun, variants):
    """What was compared, and when."""
    peers = [f"DynamO {version_of(dynarun)}"] if dynarun else []
    peers += [f"{name} {version_of(md)}" for name, md in variants.items()]
    return (f"`bench/peers/cross_check.py`: Needlework at commit {measured.commit()}, "
            f"{', '.join(peers)}; {strftime('%Y-%m-%d', gmtime())}. "
            "bench/peers/README.md says what is checked.\n\n")


def main():
    names = [*FIRST, *LONG, "small"]
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add_options(parser)
    parser.add_argument("--case", choices=names, action="append", dest="cases",
                        help="may be given several times; else all")
    parser.add_argument("--events", type=int, default=100, help="first ones to compare")
    parser.add_argument("--blocks", type=int, default=20, help="of a long run, for its errors")
    parser.add_argument("--document", action="store_true",
                        help="put the table into bench/results/cross-check.md, too")
    arguments = parser.parse_args()
    program, dynarun, variants = find_programs(parser, arguments)
    if arguments.events < 1:
        parser.error("--events: expected at least 1")
    if arguments.blocks < 5:
        parser.error("--blocks: expected at least 5, fewer have no error")
    rows, agree = [], True
    for name in arguments.cases or names:
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            if name in LONG:
                if not dynarun and not LONG[name][2]:
                    continue
                more, same = compare_long(name, program, dynarun, variants, folder, arguments.blocks)
            elif not dynarun:
                continue
            elif name in FIRST:
                more, same = compare_first(name, program, dynarun, folder, arguments.events)
                more = [more]
            else:
                more, same = small_inputs(program, dynarun, folder)
        rows += [row if len(row) == 5 else [*row, "same" if same else "**differ**"] for row in more]
        agree &= same
    text = measured.table(["case", "what", "found", "difference", "verdict"], rows)
    print(text, end="")
    if arguments.document and agree:
        put_result("cross-check.md", TITLE, origin(dynarun, variants) + text)
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"cross_check.py: {error}")
