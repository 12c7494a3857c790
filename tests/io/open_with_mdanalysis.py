"""Reads what write_h5md_sample wrote as a trajectory of MDAnalysis."""
import os
import signal
import subprocess
import sys
import tempfile
import warnings

warnings.filterwarnings("ignore", category=DeprecationWarning)

import MDAnalysis as mda
import numpy as np

NEEDLES, FRAMES = 5, 7


def check_frame(universe, frame):
    step = universe.trajectory[frame]
    i = np.arange(NEEDLES)
    one = np.ones(NEEDLES)
    assert step.frame == frame
    assert step.time == 0.5 * frame
    assert step.data["step"] == 100 * frame
    assert np.array_equal(step.dimensions, [8, 9, 10, 90, 90, 90]), step.dimensions
    # The numbers of the sample are exact in single precision, in which MDAnalysis keeps them.
    position = np.stack([0.5 * i, (frame + 0.25) * one, i / 8], axis=-1)
    velocity = np.stack([-1.0 * i, 0.5 * frame * one, 2.0 * i], axis=-1)
    assert np.array_equal(universe.atoms.positions, position), universe.atoms.positions
    assert np.array_equal(universe.atoms.velocities, velocity), universe.atoms.velocities
    # Observables are those of the frame, although the file has fewer samples than frames.
    assert step.data["energy"] == 3 / (1 + frame), step.data
    assert step.data["t_tr"] == 1 / (1 + frame), step.data
    assert step.data["collisions"] == 100 * frame, step.data
    assert np.array_equal(step.data["momentum"], [0.25 * frame, -frame, 0]), step.data


def check_file(path):
    universe = mda.Universe.empty(NEEDLES, trajectory=False)
    universe.load_new(path, format="H5MD", convert_units=False)
    assert universe.trajectory.n_frames == FRAMES
    assert universe.trajectory.n_atoms == NEEDLES
    for frame in range(FRAMES):
        check_frame(universe, frame)
    assert len([step.time for step in universe.trajectory]) == FRAMES
    check_frame(universe, 2)
    universe.trajectory.close()


def check_topology(folder, program):
    """An export of one frame is a topology, so that a universe is made in one line."""
    path = os.path.join(folder, "sample.h5")
    first = os.path.join(folder, "first.xyz")
    subprocess.run([program, "export", path, first, "--frame", "first"], check=True, timeout=3600)
    universe = mda.Universe(first, path, format="H5MD", convert_units=False)
    assert universe.trajectory.n_frames == FRAMES
    for frame in range(FRAMES):
        check_frame(universe, frame)


def main(writer, program):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run([writer, folder], timeout=3600)
        assert result.returncode == -signal.SIGKILL, result.returncode
        check_file(os.path.join(folder, "sample.h5"))
        check_file(os.path.join(folder, "killed.h5"))
        check_topology(folder, program)


if __name__ == "__main__":
    main(*sys.argv[1:])
