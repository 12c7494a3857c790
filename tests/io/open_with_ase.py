"""Reads what `needlework export` made of write_h5md_sample's files with ASE: extended XYZ and dumps of
LAMMPS. A gas that has cooled, written by ASE with its 8 decimals, is imported again."""
import os
import signal
import subprocess
import sys
import tempfile

import h5py
import numpy as np

try:
    import ase.io
except ImportError:
    print("python3-ase is not installed")
    sys.exit(77)  # skipped

NEEDLES, FRAMES = 5, 7

COOLED = """
needles = { count = 500, box = 10 }
initial = { t_tr = 1e-8, t_rot = 1e-9 }
until.collisions_per_needle = 2
"""


def same(found, wanted):
    assert np.array_equal(found, wanted), (found, wanted)


def check_frame(atoms, frame):
    i = np.arange(NEEDLES)
    one = np.ones(NEEDLES)
    same(atoms.positions, np.stack([0.5 * i, (frame + 0.25) * one, i / 8], axis=-1))
    same(atoms.cell.array, np.diag([8, 9, 10]))
    assert atoms.pbc.all()


def check_xyz(path):
    frames = ase.io.read(path, index=":")
    assert len(frames) == FRAMES
    for frame, atoms in enumerate(frames):
        check_frame(atoms, frame)
        i = np.arange(NEEDLES)
        one = np.ones(NEEDLES)
        same(atoms.arrays["id"], 10 + i)
        same(atoms.arrays["velo"], np.stack([-1.0 * i, 0.5 * frame * one, 2.0 * i], axis=-1))
        same(atoms.arrays["director"], np.stack([0 * one, i % 2 == 0, i % 2 == 1], axis=-1))
        x, y, z, w = atoms.arrays["orientation"].T  # which turns (0, 0, 1) into the director
        turned = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
                          axis=-1)
        assert np.allclose(turned, atoms.arrays["director"], rtol=0, atol=1e-15)
        same(atoms.arrays["aspherical_shape"], np.tile([0.02, 0.02, 0.5], (NEEDLES, 1)))
        same(atoms.arrays["angular_velocity"], np.stack([i + frame, 0 * one, 0 * one], axis=-1))
        info = {"Time": 0.5 * frame, "length": 1, "mass": 1, "k": 4.5, "epsilon": 0.75,
                "beta": -0.5}
        assert atoms.info == info, atoms.info


def check_dump(path):
    frames = ase.io.read(path, index=":", format="lammps-dump-text")
    assert len(frames) == FRAMES
    for frame, atoms in enumerate(frames):
        check_frame(atoms, frame)


def check_way_back(program, folder):
    def run(*command):
        return subprocess.run([program, *command], cwd=folder, check=True, timeout=3600, text=True,
                              capture_output=True).stderr

    with open(os.path.join(folder, "cooled.toml"), "w") as file:
        file.write(COOLED)
    run("run", "cooled.toml", "--out", "cooled.h5", "--quiet")
    run("export", "cooled.h5", "cooled.xyz", "--frame", "last")
    atoms = ase.io.read(os.path.join(folder, "cooled.xyz"))
    ase.io.write(os.path.join(folder, "back.xyz"), atoms)
    said = run("import", "back.xyz", "--out", "back")
    assert "needles were projected" in said, said
    run("run", "back/scene.toml", "--quiet")
    frames = []
    for name in ("cooled.h5", "back/state.h5"):
        with h5py.File(os.path.join(folder, name)) as file:
            group = file["particles/needles"]
            frames.append({key: group[key]["value"][-1] for key in
                           ("position", "velocity", "orientation", "angular_velocity")})
    for key, wanted in frames[0].items():
        assert np.max(np.abs(frames[1][key] - wanted)) < 2e-8, key


SHEARED = """
needles = { count = 40, box = [5, 6, 7] }
shear = { rate = RATE }
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
until.time = 9
output.frames_every = 1.5
"""


def check_sheared(program, folder, rate):
    """Cells of ASE are those of the frames, hold the atoms, and have them where they are, whether of
    XYZ or of a dump; what ASE writes of them is imported with its slide."""
    def run(*command):
        return subprocess.run([program, *command], cwd=folder, check=True, timeout=3600, text=True,
                              capture_output=True).stderr

    with open(os.path.join(folder, "sheared.toml"), "w") as file:
        file.write(SHEARED.replace("RATE", str(rate)))
    run("run", "sheared.toml", "--out", "sheared.h5", "--quiet", "--force")
    with h5py.File(os.path.join(folder, "sheared.h5")) as file:
        group = file["particles/needles"]
        edges, positions = group["box/edges/value"][:], group["position/value"][:]
    for name, form in (("sheared.xyz", "extxyz"), ("sheared.dump", "lammps-dump-text")):
        run("export", "sheared.h5", name, "--force")
        frames = ase.io.read(os.path.join(folder, name), index=":", format=form)
        assert len(frames) == len(edges) == 7
        tilts = []
        for atoms, cell, wanted in zip(frames, edges, positions):
            tilt = atoms.cell.array[1, 0]
            tilts.append(tilt)
            assert -2.5 <= tilt < 2.5, tilt
            off = (tilt - cell[1, 0]) / 5
            assert abs(off - round(off)) < 1e-15, (tilt, cell)
            assert np.allclose(np.delete(atoms.cell.array.ravel(), 3), np.delete(cell.ravel(), 3),
                               rtol=1e-15, atol=0)
            scaled = atoms.get_scaled_positions(wrap=False)
            assert np.all((scaled > -1e-14) & (scaled < 1 + 1e-14))
            apart = (atoms.positions - wanted) @ np.linalg.inv(cell)
            assert np.max(np.abs(apart - np.round(apart))) < 1e-14
        assert min(tilts) < 0 < max(tilts), tilts
    ase.io.write(os.path.join(folder, "back.xyz"), ase.io.read(os.path.join(folder, "sheared.xyz")))
    said = run("import", "back.xyz", "--out", "sheared-back", "--force")
    assert "shear" not in said, said
    run("run", "sheared-back/scene.toml", "--quiet")
    with h5py.File(os.path.join(folder, "sheared-back/state.h5")) as file:
        box = file["particles/needles/box"]
        assert abs(box["edges/value"][0, 1, 0] - edges[-1, 1, 0]) < 1e-7
        assert abs(box.attrs["shear_rate"] - rate) < 1e-15


DIFFERING = """
needles.box = 9
until.collisions_per_needle = 1
[[species]]
name = "rods"
count = 60
length = { distribution = "lognormal", mean = 1, width = 0.3 }
diameter.aspect = 5
mass.density = 3
[[species]]
name = "fixed"
count = 9
diameter = 0.5
fixed = true
"""


def check_bodies_that_differ(program, folder):
    """Arrays of ASE are those of the file, and what ASE writes of them is imported, with infinite
    masses of fixed rods."""
    def run(*command):
        return subprocess.run([program, *command], cwd=folder, check=True, timeout=3600, text=True,
                              capture_output=True).stderr

    with open(os.path.join(folder, "differing.toml"), "w") as file:
        file.write(DIFFERING)
    run("run", "differing.toml", "--out", "differing.h5", "--quiet")
    run("export", "differing.h5", "differing.xyz")
    with h5py.File(os.path.join(folder, "differing.h5")) as file:
        wanted = {name: file["particles/needles"][name][:]
                  for name in ("length", "diameter", "mass", "inertia")}
    atoms = ase.io.read(os.path.join(folder, "differing.xyz"))
    for name, numbers in wanted.items():
        same(atoms.arrays["masses" if name == "mass" else name], numbers)
    same(atoms.get_masses(), wanted["mass"])
    assert np.isinf(atoms.get_masses()[-9:]).all() and len(set(wanted["length"])) == 61
    same(atoms.arrays["aspherical_shape"],
         np.stack([wanted["diameter"] / 2, wanted["diameter"] / 2, wanted["length"]], axis=-1))
    ase.io.write(os.path.join(folder, "differing-back.xyz"), atoms)
    run("import", "differing-back.xyz", "--out", "differing-back")
    run("run", "differing-back/scene.toml", "--quiet")
    with h5py.File(os.path.join(folder, "differing-back/state.h5")) as file:
        for name, numbers in wanted.items():
            found = file["particles/needles"][name][:]
            finite = np.isfinite(numbers)
            same(np.isfinite(found), finite)
            assert np.max(np.abs(found[finite] - numbers[finite])) < 2e-8, name


def main(writer, program):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run([writer, folder], timeout=3600)
        assert result.returncode == -signal.SIGKILL, result.returncode
        for name, check in [("a.xyz", check_xyz), ("a.dump", check_dump)]:
            path = os.path.join(folder, name)
            subprocess.run([program, "export", os.path.join(folder, "sample.h5"), path], check=True,
                           timeout=3600)
            check(path)
        check_way_back(program, folder)
        check_bodies_that_differ(program, folder)
        for rate in (0.7, -0.45):
            check_sheared(program, folder, rate)


if __name__ == "__main__":
    main(*sys.argv[1:])
