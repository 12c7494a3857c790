"""A run writes the same file on any number of threads, but for that number.

    same_files.py NEEDLEWORK
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

SCENE = """
needles = { count = 200, box = 6.4 }
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
engine.team = "all"
until.energy_ratio = 0.2
[output]
frames = 4
events = true
observables = ["fields", "profiles", "flow_order", "distributions", "alignment",
               "velocity_moments", "temperature_by_axis", "pair_correlation", "structure_factor",
               "displacement", "time_correlation", "collision_statistics"]
"""


def contents(path):
    """Bytes of all datasets and attributes, by name."""
    found = {}

    def keep(name, item):
        if isinstance(item, h5py.Dataset):
            value = item[()]
            found[name] = value.tobytes() if hasattr(value, "tobytes") else value
        for key, value in item.attrs.items():
            found[f"{name}@{key}"] = bytes(value) if hasattr(value, "tobytes") else value

    with h5py.File(path) as file:
        file.visititems(keep)
    return found


def main():
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "scene.toml").write_text(SCENE)
        files = {}
        for threads in (1, 2, 3, 8):
            out = Path(folder) / f"{threads}.h5"
            subprocess.run([program, "run", "scene.toml", "--threads", str(threads), "--out",
                            str(out), "--quiet"], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
            files[threads] = contents(out)
        one = files[1]
        assert any(name.startswith("events/") for name in one), sorted(one)
        assert any(name.startswith("series/") for name in one), sorted(one)
        assert any(name.startswith("series/displacement/") for name in one), sorted(one)
        assert len(one["particles/needles/position/value"]) > 200 * 3 * 8, "expected several frames"
        for threads, other in files.items():
            differ = sorted(name for name in one.keys() | other.keys()
                            if one.get(name) != other.get(name))
            expected = [] if threads == 1 else ["parameters/threads"]
            assert differ == expected, f"{threads} threads: {differ}"
        print(f"{len(one)} datasets and attributes, the same on 1, 2, 3 and 8 threads")


main()
