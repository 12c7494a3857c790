"""Reads what `needlework export` made of write_h5md_sample's files with ASE: extended XYZ and dumps of
LAMMPS."""
import os
import signal
import subprocess
import sys
import tempfile

import numpy as np

try:
    import ase.io
except ImportError:
    print("python3-ase is not installed")
    sys.exit(77)  # skipped

NEEDLES, FRAMES = 5, 7


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
        same(atoms.arrays["orientation"], np.stack([0 * one, i % 2 == 0, i % 2 == 1], axis=-1))
        same(atoms.arrays["angular_velocity"], np.stack([i + frame, 0 * one, 0 * one], axis=-1))
        info = {"Time": 0.5 * frame, "length": 1, "mass": 1, "k": 4.5, "epsilon": 0.75,
                "beta": -0.5}
        assert atoms.info == info, atoms.info


def check_dump(path):
    frames = ase.io.read(path, index=":", format="lammps-dump-text")
    assert len(frames) == FRAMES
    for frame, atoms in enumerate(frames):
        check_frame(atoms, frame)


def main(writer, program):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run([writer, folder], timeout=3600)
        assert result.returncode == -signal.SIGKILL, result.returncode
        for name, check in [("a.xyz", check_xyz), ("a.dump", check_dump)]:
            path = os.path.join(folder, name)
            subprocess.run([program, "export", os.path.join(folder, "sample.h5"), path], check=True,
                           timeout=3600)
            check(path)


if __name__ == "__main__":
    main(*sys.argv[1:])
