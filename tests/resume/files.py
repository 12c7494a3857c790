"""What tests of runs that are stopped and continued share: a scene, and the contents of files."""

import subprocess

import h5py

OUTPUT = "[output]\nframes = 4\nevents = true\ncheckpoint_every = 0.02\n"
# With all that is remembered between samples, and collisions whose time is that of t_c.
SCENE = f"""
needles = {{ count = 400, box = 8.0 }}
collisions = {{ epsilon = 0.8, tc_relative = 1e-3 }}
until.energy_ratio = 0.02
{OUTPUT}observables = ["fields", "profiles", "flow_order", "distributions", "alignment",
               "velocity_moments", "temperature_by_axis", "pair_correlation", "structure_factor",
               "displacement", "time_correlation", "collision_statistics"]
"""

# Other scenes, whose effects remember something of needles, walls and random numbers.
EFFECTS = {
    "plain": SCENE,
    "walls": """
needles = { count = 250, box = [7, 7, 6], k = 5 }
forces.gravity = [0, 0, -1]
collisions = { epsilon = 0.9, beta = 0.3, tc_relative = 1e-3 }
until.time = 15.02
walls = [{ axis = "z", side = "low", epsilon = 0.9, \
           motion = { amplitude = 0.2, frequency = 1.7, phase = 0.4 } },
         { axis = "y", side = "both", temperature = 1.5 }]
""" + OUTPUT,
    "driving": """
needles.box = 7
collisions = { epsilon = 0.8, tc_relative = 1e-3 }
driving.kicks = { every = 0.05, translational = 1, rotational = 2 }
driving.andersen = { rate = 0.3, temperature = 2 }
until.time = 20.03
species = [{ name = "short", count = 150, length = 0.7 }, { name = "long", count = 60, mass = 3 }]
""" + OUTPUT + 'observables = ["displacement", "collision_statistics"]',
    "rods": """
needles = { count = 200, box = [7, 7, 6], diameter = 0.2 }
collisions = { epsilon = 0.9, tc_relative = 1e-3 }
driving.andersen = { rate = 0.3, temperature = 1 }
until.time = 15.02
walls = [{ axis = "z", side = "both" }]
""" + OUTPUT + 'observables = ["wall_profiles", "centre_of_mass"]',
    "sliding": """
needles = { count = 250, box = [5, 5, 6] }
collisions = { epsilon = 0.4, sliding = true }
driving.andersen = { rate = 0.3, temperature = 1 }
until.time = 8.02
walls = [{ axis = "z", side = "both" }]
""" + OUTPUT + 'observables = ["displacement", "collision_statistics"]'}

# The datasets whose lengths are the numbers of complete rows.
TABLES = ("series/step", "particles/needles/position/step", "events/time")

# What says how a file was made rather than what happened.
PROVENANCE = {"parameters/threads", "parameters/isa"}


def open_growing(path):
    """A file that a run is writing, opened as docs/file-format.md says."""
    return h5py.File(path, swmr=True)


def contents(path, opened=h5py.File):
    """All datasets as arrays, by name; those with several names by each."""
    found = {}

    def visit(group, prefix):
        for name, item in group.items():
            if isinstance(item, h5py.Group):
                visit(item, f"{prefix}{name}/")
            elif f"{prefix}{name}" not in PROVENANCE and f"{prefix}{name}" not in found:
                found[f"{prefix}{name}"] = item[()]

    with opened(path) as file:
        # First the numbers of rows, which stay open, because the file may grow meanwhile.
        counts = {name: file[name] for name in TABLES if name in file}
        found |= {name: dataset[()] for name, dataset in counts.items()}
        visit(file, "")
    return found


def bytes_of(value):
    if getattr(value, "dtype", None) == object:
        return value.tolist()  # texts, of which the array has but addresses
    return value.tobytes() if hasattr(value, "tobytes") else value


def differences(one, other):
    """Names of datasets that are not the same to the last bit."""
    return sorted(name for name in one.keys() | other.keys()
                  if name not in one or name not in other
                  or bytes_of(one[name]) != bytes_of(other[name]))


def complete_rows(found):
    """The number of complete rows of each table, by the name of its dataset of times."""
    return {name: len(found[name]) for name in TABLES if name in found}


def table_of(name):
    """The dataset of times of the table in which a dataset grows, or nothing."""
    if name.startswith("events/"):
        return "events/time"
    if name.startswith("series/") and (name.endswith("/value") or name in ("series/step",
                                                                           "series/time")):
        return "series/step"
    if name.startswith(("particles/needles/", "observables/")) and name.endswith(
            ("/value", "/step", "/time")):
        return "particles/needles/position/step"
    return None


def require_prefix(before, after):
    """Every complete row of `before` is in `after`, to the last bit."""
    rows = complete_rows(before)
    for name, value in before.items():
        table = table_of(name)
        if not table:
            continue
        count = rows[table]
        assert len(value) >= count, f"{name}: {len(value)} rows of {count}"
        assert bytes_of(value[:count]) == bytes_of(after[name][:count]), f"{name}: rows differ"


def command(program, *arguments):
    """Runs the program; returns what it has printed and its exit code."""
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr
