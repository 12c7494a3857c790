"""Frames as GSD files, which HOOMD-blue, OVITO and freud read."""

from __future__ import annotations

import os
from typing import Any, Iterable, Union

import numpy as np

from . import _core
from .errors import InputError, IoError
from .reading import Recording, read

__all__ = ["to_gsd"]

DRAWN_RADIUS = 0.02
"""Needles have no thickness. They are drawn with this radius in the middle, in lengths."""


def to_gsd(source: Union[Recording, str, os.PathLike, Any], path: str, frames: Any = None,
           force: bool = False) -> int:
    """Writes frames of a run, or the present state of a simulation, to a GSD file.

    Parameters
    ----------
    source : Recording, path of a file of a run, or Simulation
    path : str
        The file to write.
    frames : int or slice, optional
        Which frames of a run; all if it is not given.
    force : bool
        Whether an existing file may be replaced.

    Returns the number of frames written. GSD holds numbers in single precision. Centres are shifted
    by half the box, because its boxes have their centre in the origin. Its quaternion ``orientation``
    turns (0, 0, 1) into the director, and its ``type_shapes`` are thin ellipsoids along that axis, so
    that OVITO draws needles. The species of a mixture are its types. GSD has no angular velocity: it
    is in ``log["particles/angular_velocity"]``, in double precision, and the time is in
    ``log["time"]``. HOOMD-blue's boxes are periodic; ``log["periodic"]`` has 0 for axes with walls.
    The step of a frame is the number of collisions before it. Needs python3-gsd.
    """
    import gsd.hoomd

    path = os.fsdecode(path)
    if os.path.exists(path) and not force:
        raise IoError(f"{path}: exists already: expected a new file, or force=True to replace it")
    if isinstance(source, (str, os.PathLike)):
        with read(source) as run:
            return to_gsd(run, path, frames, force)
    chosen, gas = _frames_of(source, frames), source.gas
    names = list(gas.get("species", ["needle"]))
    unfinished = path + ".part"  # the file appears under its name when it is complete
    try:
        with _core.StandardDescriptors():
            opened = gsd.hoomd.open(unfinished, "wb")
        with opened as file:
            for frame in chosen:
                file.append(_snapshot(frame, gas, names))
        os.replace(unfinished, path)
    except OSError as error:
        raise IoError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if os.path.exists(unfinished):
            os.remove(unfinished)
    return len(chosen)


def _frames_of(source: Any, frames: Any) -> list[Any]:
    if not isinstance(source, Recording):
        if frames is not None:
            raise InputError(f"frames = {frames!r}: expected none, as a simulation has one state")
        return [source]
    chosen = source.frames[slice(None) if frames is None else frames]
    return chosen if isinstance(chosen, list) else [chosen]


def _snapshot(frame: Any, gas: Any, names: list[str]) -> Any:
    import gsd.hoomd

    snapshot = gsd.hoomd.Snapshot()
    count = len(frame.position)
    collisions = frame.collisions if hasattr(frame, "collisions") else frame.totals.collisions
    snapshot.configuration.step = collisions
    snapshot.configuration.box = [*frame.box, 0, 0, 0]
    # One number, or one for each species of a mixture.
    lengths, masses, shapes = (np.atleast_1d(value) for value in (gas.length, gas.mass, gas.k))
    inertia = masses * lengths**2 / (2 * shapes)
    species = frame.species if len(lengths) > 1 else np.zeros(count, dtype=np.uint8)
    particles = snapshot.particles
    particles.N = count
    particles.types = names
    particles.type_shapes = [{"type": "Ellipsoid", "a": DRAWN_RADIUS * length,
                              "b": DRAWN_RADIUS * length, "c": length / 2}
                             for length in lengths.tolist()]
    particles.typeid = species.astype(np.uint32)
    particles.position = frame.position - frame.box / 2
    particles.image = frame.image
    particles.velocity = frame.velocity
    particles.orientation = quaternions(frame.orientation)
    particles.mass = masses[species]
    particles.moment_inertia = np.stack([inertia, inertia, 0 * inertia], axis=1)[species]
    particles.diameter = lengths[species]
    snapshot.log = {"particles/angular_velocity": np.asarray(frame.angular_velocity),
                    "time": np.array([frame.time]),
                    "periodic": frame.periodic.astype(np.uint8)}
    return snapshot


def quaternions(directors: np.ndarray) -> np.ndarray:
    """Quaternions (w, x, y, z) of the shortest turns of (0, 0, 1) into the directors, [N, 4]."""
    x, y, z = np.asarray(directors).T
    w = np.sqrt((1 + z) / 2)
    down = w < 1e-8  # any half turn about an axis normal to z
    safe = np.where(down, 1, 2 * w)
    out = np.stack([w, -y / safe, x / safe, np.zeros_like(w)], axis=1)
    out[down] = [0, 1, 0, 0]
    return out / np.linalg.norm(out, axis=1, keepdims=True)
