"""Lets LAMMPS read what `needlework export` made of a run, and `needlework import` what LAMMPS wrote of
that: the needles are the same, bit for bit, or as far as the digits go that LAMMPS writes by default."""
import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

MOTION = "vx vy vz mux muy muz omegax omegay omegaz diameter mass"
COLUMNS = ("id type x y z ix iy iz vx vy vz mux muy muz omegax omegay omegaz diameter mass")
SCENE = """
needles.box = [6, 7, 8]
until.collisions_per_needle = 5
species = [{ name = "rod", count = 50, length = 1.7, mass = 2.5, k = 3.3 }]
"""
SCRIPT = f"""
units lj
atom_style hybrid sphere dipole
{{read}}
pair_style zero 1.0
pair_coeff * *
dump d all custom 1 back.dump {COLUMNS}
dump_modify d format float %.17g
dump s all custom 1 scaled.dump id type xs ys zs {MOTION}
dump u all custom 1 unwrapped.dump id type xu yu zu {MOTION}
dump z all custom/gz 1 short.dump.gz id type xsu ysu zsu {MOTION}
dump_modify s format float %.17g
dump_modify u format float %.17g
run 0
write_data back.data
"""
# Needles above the open side, and a wall that is behind the edge at the end.
BEYOND = """
needles = { count = 60, box = [5, 5, 6] }
initial.t_tr = 4
forces.gravity = [0, 0, -1]
until.time = 5
[[walls]]
axis = "z"
side = "low"
motion = { amplitude = 1, frequency = 0.05, phase = 3.2 }
"""
OPEN = """
units lj
atom_style hybrid sphere dipole
boundary p p fs
read_data beyond.data
pair_style zero 1.0
pair_coeff * *
run 0
"""
SHEARED = """
needles = { count = 50, box = [6, 7, 8] }
shear = { rate = RATE }
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
until.time = 7.3
"""
READ_DUMP = """
region box block 0 6 0 7 0 8
create_box 1 box
read_dump run.dump 1 x y z ix iy iz vx vy vz add keep box yes
"""


def run(folder, *command):
    subprocess.run(command, cwd=folder, check=True, timeout=3600, stdout=subprocess.DEVNULL)


def needles(path):
    """The last frame, in the order of ids."""
    with h5py.File(path) as file:
        group = file["particles/needles"]
        order = np.argsort(group["id"][:])
        names = ("position", "velocity", "orientation", "angular_velocity", "image")
        return {"tilt": group["box/edges/value"][-1, 1, 0],
                **{name: group[name]["value"][-1][order] for name in names}}


def lammps(folder, read, script=SCRIPT):
    with open(os.path.join(folder, "in.lammps"), "w") as file:
        file.write(script.format(read=read))
    run(folder, "lmp", "-in", "in.lammps", "-log", "none")


def lammps_reads_what_is_beyond_edges(folder, program):
    with open(os.path.join(folder, "beyond.toml"), "w") as file:
        file.write(BEYOND)
    run(folder, program, "run", "beyond.toml", "--out", "beyond.h5", "--quiet")
    run(folder, program, "export", "beyond.h5", "beyond.data")
    wanted = needles(os.path.join(folder, "beyond.h5"))
    heights = wanted["position"][:, 2]
    assert heights.max() > 6 and heights.min() < 0, (heights.min(), heights.max())
    lammps(folder, "", OPEN)  # an atom beyond the bounds is an error
    run(folder, program, "import", "beyond.data", "--out", "beyond")
    found = needles(os.path.join(folder, "beyond", "state.h5"))
    assert np.array_equal(found["position"], wanted["position"])


def path(needles, tilt):
    """Where needles would be without boundaries, in boxes that are tilted like this."""
    return needles["position"] + needles["image"] @ np.array([[6, 0, 0], [tilt, 7, 0], [0, 0, 8]])


def lammps_reads_sheared_boxes(folder, program, rate):
    with open(os.path.join(folder, "sheared.toml"), "w") as file:
        file.write(SHEARED.replace("RATE", str(rate)))
    run(folder, program, "run", "sheared.toml", "--out", "sheared.h5", "--quiet", "--force")
    for name in ("sheared.data", "sheared.dump"):
        run(folder, program, "export", "sheared.h5", name, "--frame", "last", "--force")
    wanted = needles(os.path.join(folder, "sheared.h5"))
    tilt = wanted["tilt"] - 6 * (wanted["tilt"] >= 3)
    lammps(folder, "read_data sheared.data")
    with open(os.path.join(folder, "sheared.dump")) as file:
        step = file.read().split("ITEM: TIMESTEP\n")[1].split()[0]
    shutil.copy(os.path.join(folder, "back.dump"), os.path.join(folder, "of_data.dump"))
    for name in ("of_data.dump", "back.data", "scaled.dump", "unwrapped.dump"):
        run(folder, program, "import", name, "--out", "sheared-back", "--force")
        found = needles(os.path.join(folder, "sheared-back", "state.h5"))
        assert abs(found["tilt"] - wanted["tilt"]) < 1e-14, (name, found["tilt"], wanted["tilt"])
        if name == "scaled.dump":
            apart = (found["position"] - wanted["position"]) @ np.linalg.inv(
                [[6, 0, 0], [tilt, 7, 0], [0, 0, 8]])
            assert np.max(np.abs(apart - np.round(apart))) < 1e-14, name
        else:
            error = np.max(np.abs(path(found, found["tilt"]) - path(wanted, wanted["tilt"])))
            assert error < 1e-12, (name, error)
        for key in ("velocity", "orientation", "angular_velocity"):
            assert np.max(np.abs(found[key] - wanted[key])) < 1e-14, (name, key)
    # As LAMMPS itself has them, from the dump.
    lammps(folder, READ_DUMP.replace("block 0 6 0 7 0 8", f"prism 0 6 0 7 0 8 {tilt} 0 0")
           .replace("run.dump 1", f"sheared.dump {step}"))
    table = np.loadtxt(os.path.join(folder, "back.dump"), skiprows=9)
    table = table[np.argsort(table[:, 0])]
    read = {"position": table[:, 2:5], "image": table[:, 5:8]}
    assert np.max(np.abs(path(read, tilt) - path(wanted, wanted["tilt"]))) < 1e-12
    assert np.max(np.abs(table[:, 8:11] - wanted["velocity"])) < 1e-14
    return tilt


DIFFERING = """
needles.box = [6, 7, 8]
until.collisions_per_needle = 5
[[species]]
name = "a"
count = 50
length = { distribution = "gamma", mean = 1.2, width = 0.3 }
mass = { distribution = "uniform", mean = 2, width = 0.2 }
"""


def lammps_reads_needles_that_differ(folder, program):
    """Its diameters are their lengths, its masses theirs, and what it writes is imported."""
    with open(os.path.join(folder, "differing.toml"), "w") as file:
        file.write(DIFFERING)
    run(folder, program, "run", "differing.toml", "--out", "differing.h5", "--quiet")
    run(folder, program, "export", "differing.h5", "differing.data")
    lammps(folder, "read_data differing.data")

    def bodies(path):
        with h5py.File(os.path.join(folder, path)) as file:
            group = file["particles/needles"]
            order = np.argsort(group["id"][:])
            return {name: group[name][:][order] for name in ("length", "mass", "inertia")}

    wanted = bodies("differing.h5")
    assert len(set(wanted["length"])) == len(set(wanted["mass"])) == 50
    table = np.loadtxt(os.path.join(folder, "back.dump"), skiprows=9)
    table = table[np.argsort(table[:, 0])]
    for column, name in ((17, "length"), (18, "mass")):
        assert np.max(np.abs(table[:, column] / wanted[name] - 1)) < 1e-15, name
    for name in ("back.dump", "back.data"):
        run(folder, program, "import", name, "--out", "differing-back", "--force")
        found = bodies("differing-back/state.h5")
        for key, numbers in wanted.items():
            assert np.max(np.abs(found[key] / numbers - 1)) < 5e-15, (name, key)


def main(_writer, program):
    if not shutil.which("lmp"):
        print("lammps is not installed")
        sys.exit(77)  # skipped
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "scene.toml"), "w") as file:
            file.write(SCENE)
        run(folder, program, "run", "scene.toml", "--out", "run.h5", "--quiet")
        run(folder, program, "export", "run.h5", "run.data")
        lammps(folder, "read_data run.data")
        wanted = needles(os.path.join(folder, "run.h5"))
        paths = wanted["position"] + wanted["image"] * [6, 7, 8]
        # write_data has 16 digits, which are not enough for all numbers. Positions with 17 digits
        # are scaled by LAMMPS; where it is not told how many, it writes six.
        for name, tolerance in [("back.dump", 0), ("back.data", 1e-14), ("scaled.dump", 1e-14),
                                ("unwrapped.dump", 1e-14), ("short.dump.gz", 1e-4)]:
            run(folder, program, "import", name, "--out", name + "-folder")
            found = needles(os.path.join(folder, name + "-folder", "state.h5"))
            if name in ("unwrapped.dump", "short.dump.gz"):
                found["position"] += found["image"] * [6, 7, 8]
            for key, numbers in wanted.items():
                if key == "image" and name in ("scaled.dump", "short.dump.gz"):
                    continue  # not in it, or of another box where digits end at a border
                if key == "position" and name in ("unwrapped.dump", "short.dump.gz"):
                    numbers = paths
                error = np.max(np.abs(found[key] - numbers))
                assert error <= tolerance, (name, key, error)

        run(folder, program, "export", "run.h5", "run.dump", "--frame", "last")
        with open(os.path.join(folder, "run.dump")) as file:
            step = file.read().split("ITEM: TIMESTEP\n")[1].split()[0]
        lammps(folder, READ_DUMP.replace("run.dump 1", f"run.dump {step}"))
        table = np.loadtxt(os.path.join(folder, "back.dump"), skiprows=9)
        table = table[np.argsort(table[:, 0])]
        for key, columns in [("position", slice(2, 5)), ("image", slice(5, 8)),
                             ("velocity", slice(8, 11))]:
            assert np.array_equal(table[:, columns], wanted[key]), key
        lammps_reads_what_is_beyond_edges(folder, program)
        lammps_reads_needles_that_differ(folder, program)
        tilts = [lammps_reads_sheared_boxes(folder, program, rate) for rate in (0.6, -0.5)]
        assert min(tilts) < 0 < max(tilts), tilts


if __name__ == "__main__":
    main(*sys.argv[1:])
