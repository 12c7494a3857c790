"""Frames as GSD files, which HOOMD-blue, OVITO and freud read and write."""

from __future__ import annotations

import os
from typing import Any, Iterable, Union

import numpy as np

from . import _core
from .errors import InputError, IoError
from .reading import Recording, read
from .state import NUMBERS_OF_BODIES, OWN_NUMBERS, Bodies, State
from .tilt import counted, reduced_tilt
from .values import Values

__all__ = ["GsdFrame", "from_gsd", "to_gsd"]

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
    that OVITO draws needles; of rods of finite width they are meshes of cylinders with spherical
    caps, or spheres, and ``diameter`` is theirs. Length, diameter, mass, k and inertia of the types
    are in ``log``, in double precision; where bodies of a type differ they are means, and length,
    diameter, mass and inertia of each are in ``log["particles/length"]`` and so on. Masses of fixed
    bodies are infinite. The species of a mixture are its types. GSD has no
    angular velocity: it is in ``log["particles/angular_velocity"]``, in double precision, and the
    time is in ``log["time"]``. HOOMD-blue's boxes are periodic; ``log["periodic"]`` has 0 for axes
    with walls. Along these a box encloses bodies beyond its edges, as above an open side:
    ``log["edges"]`` are the edges of the run, and ``log["centre"]`` is where the origin of the file is
    in the run.
    A sheared box has the tilt xy, images that belong to it, and ``log["slide"]`` and
    ``log["shear_rate"]``.
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
            opened = gsd.hoomd.open(unfinished, _mode("w"))
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


class GsdFrame(Values):
    """A frame of a GSD file."""

    state: State
    """All needles, from which ``Simulation(scene, **frame.state)`` starts."""
    box: np.ndarray
    """Edges of the box, [3] [L]."""
    low: np.ndarray
    """Where the low edges are, [3] [L]."""
    periodic: np.ndarray
    """Along which axes the box is periodic, [3]."""
    time: float
    """Since the start of the run [time]; not a number where the file does not say it."""
    step: int
    """Of the other program; that of to_gsd() is the number of collisions."""


def from_gsd(path: str, frame: int = -1) -> GsdFrame:
    """Reads a frame of a GSD file, the last one unless another is asked for.

    ``Simulation({"needles": {"box": list(frame.box)}}, **frame.state)`` starts from it. The director
    of a particle is (0, 0, 1) turned by its quaternion, and positions are counted from the corner of
    the box. Angular velocities are those that to_gsd() writes or, of HOOMD-blue, follow from angmom
    and moment_inertia; the part along the director is left out. Types are species, of which mass
    and k = m L^2 / (2 I) follow from the particles, length and diameter from what to_gsd() writes or
    from type_shapes, Sphere or Ellipsoid. What follows from single precision is rounded to six
    digits. Particles of a type may differ in mass, moment of inertia and, as spheres, in diameter. A
    tilt xy is the slide of the state. Raises InputError for the tilts xz and yz. Needs python3-gsd.
    """
    import gsd.hoomd

    path = os.fsdecode(path)
    try:
        with _core.StandardDescriptors():
            opened = gsd.hoomd.open(path, _mode("r"))
        with opened as file:
            snapshot = file[frame]
    except IndexError:
        raise InputError(f"{path}: frame {frame}: expected one of those in the file") from None
    except (OSError, RuntimeError) as error:
        raise IoError(f"{path}: cannot be read: {error}") from error
    *edges, xy, xz, yz = (float(edge) for edge in snapshot.configuration.box)
    for name, tilt in ("xz", xz), ("yz", yz):
        if tilt != 0:
            raise InputError(f"{path}: box with the tilt {name} = {tilt}: expected 0, as rows of boxes "
                             "slide along x by y alone (xy)")
    particles, log = snapshot.particles, snapshot.log
    # Of files of to_gsd(), whose boxes enclose bodies beyond the edges of the run.
    box = np.asarray(log.get("edges", edges), dtype=float)
    slide, slid = reduced_tilt(xy * box[1], box[0])
    if "slide" in log:  # in double precision
        slide = float(log["slide"][0])
    rate = float(log["shear_rate"][0]) if "shear_rate" in log else 0.0
    centre = np.asarray(log.get("centre", (box + [xy * box[1], 0, 0]) / 2), dtype=float)
    quaternion = particles.orientation.astype(float)
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    if "particles/angular_velocity" in log:
        angular_velocity = log["particles/angular_velocity"].astype(float)
    else:
        angular_velocity = _angular_velocities(particles, quaternion)
    arrays = (particles.position + centre, particles.velocity.astype(float),
              _turned(quaternion, np.array([0.0, 0.0, 1.0])), angular_velocity,
              counted(particles.image, slid), np.arange(particles.N, dtype=np.uint32),
              particles.typeid.astype(np.uint8))
    bodies, own = _bodies_of(snapshot)
    low = np.asarray(log.get("low", np.zeros(3)), dtype=float)
    return GsdFrame({
        "state": State.of(arrays, bodies, (slide, rate) if (slide, rate) != (0, 0) else None, own,
                          (box, low) if "low" in log else None),
        "box": box,
        "low": low,
        "periodic": np.asarray(log.get("periodic", np.ones(3))).astype(bool),
        "time": float(log["time"][0]) if "time" in log else float("nan"),
        "step": int(snapshot.configuration.step)})


def _turned(q: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors turned by unit quaternions (w, x, y, z), [N, 3]."""
    w, axis = q[:, :1], q[:, 1:]
    twice = 2 * np.cross(axis, vectors)
    return vectors + w * twice + np.cross(axis, twice)


def _angular_velocities(particles: Any, q: np.ndarray) -> np.ndarray:
    """Of HOOMD-blue, whose angmom is the quaternion 2 q (0, L), L the angular momentum in the frame
    of the particle, along the axis of which needles do not turn."""
    p = particles.angmom.astype(float)
    w, axis = q[:, :1], q[:, 1:]
    # The vector part of conj(q) p / 2.
    momentum = (w * p[:, 1:] - p[:, :1] * axis - np.cross(axis, p[:, 1:])) / 2
    inertia = particles.moment_inertia.astype(float)
    spin = np.divide(momentum, inertia, out=np.zeros_like(momentum), where=inertia > 0)
    spin[:, 2] = 0
    return _turned(q, spin)


def _bodies_of(snapshot: Any) -> tuple[Bodies, dict[str, np.ndarray]]:
    """What a frame says of its types, and of particles of a type that differ; see from_gsd()."""
    particles, log = snapshot.particles, snapshot.log
    types = range(len(particles.types))

    def differ(values: np.ndarray) -> bool:
        return any(len(np.unique(values[particles.typeid == n])) > 1 for n in types)

    def mean(values: np.ndarray) -> np.ndarray:
        """Of each type; none if there is a type without particles."""
        found = [values[particles.typeid == n].astype(float) for n in types]
        whole = all(len(numbers) for numbers in found)
        return np.array([np.mean(numbers) for numbers in found]) if whole else np.array([])

    known = {name: np.asarray(log[name], dtype=float)
             for name in NUMBERS_OF_BODIES if name in log}
    own = {name: np.asarray(log[f"particles/{name}"], dtype=float) for name in OWN_NUMBERS
           if f"particles/{name}" in log}
    sizes = [_size_of(shape) for shape in particles.type_shapes or []]
    if "length" not in known and len(sizes) == len(types) and None not in sizes:
        known["length"], known["diameter"] = (np.array(column) for column in zip(*sizes))
    inertia = particles.moment_inertia[:, 0]
    if not own and (differ(particles.mass) or differ(inertia)):
        own = {"mass": _rounded(particles.mass)}
        if np.all(inertia >= 0) and np.any(inertia > 0):
            own["inertia"] = _rounded(inertia)
    spheres = np.array([shape.get("type") == "Sphere" for shape in particles.type_shapes or []])
    if "particles/diameter" not in log and np.any(spheres) and np.all(spheres) \
            and differ(particles.diameter):
        own |= {"length": np.zeros(particles.N), "diameter": _rounded(particles.diameter)}
    if "mass" not in known:
        known["mass"] = _rounded(mean(particles.mass))
    if "k" not in known and len(known.get("length", ())) == len(known["mass"]) > 0:
        inertia = mean(inertia)
        if len(inertia) and np.all((inertia > 0) | (known["length"] == 0)):
            shape = known["mass"] * known["length"]**2
            turns = (shape > 0) & np.isfinite(inertia)
            known["k"] = _rounded(np.divide(shape, 2 * inertia, out=np.full_like(shape, 6.0),
                                            where=turns))
    if len(types) > 1:
        known["name"] = particles.types
    return Bodies.of(known), own


def _size_of(shape: dict[str, Any]) -> tuple[float, float] | None:
    """Length and diameter of a body that is drawn like this; a thin ellipsoid is a needle."""
    kind = shape.get("type")
    if kind == "Sphere":
        return 0.0, float(shape["diameter"])
    if kind == "Ellipsoid" and max(shape["a"], shape["b"]) < shape["c"]:
        return 2 * float(shape["c"]), 0.0
    return None


def _rounded(values: np.ndarray) -> np.ndarray:
    """Numbers that are known in single precision."""
    return np.array([float(f"{value:.6g}") for value in values])


def _frames_of(source: Any, frames: Any) -> list[Any]:
    if not isinstance(source, Recording):
        if frames is not None:
            raise InputError(f"frames = {frames!r}: expected none, as a simulation has one state")
        return [source]
    chosen = source.frames[slice(None) if frames is None else frames]
    return chosen if isinstance(chosen, list) else [chosen]


def _snapshot(frame: Any, gas: Any, names: list[str]) -> Any:
    import gsd.hoomd

    snapshot = (gsd.hoomd.Frame if hasattr(gsd.hoomd, "Frame") else gsd.hoomd.Snapshot)()
    count = len(frame.position)
    collisions = frame.collisions if hasattr(frame, "collisions") else frame.totals.collisions
    snapshot.configuration.step = collisions
    # One number, or one for each species of a mixture.
    columns = {name: np.atleast_1d(gas[name]) for name in ("length", "mass", "k")}
    columns["diameter"] = np.atleast_1d(gas.get("diameter", np.zeros_like(columns["length"])))
    state = frame.state
    bodies = Bodies({**Bodies.of(columns).grown(frame.scale), **state.bodies})
    lengths, diameters, masses = bodies["length"], bodies["diameter"], bodies["mass"]
    species = frame.species if len(lengths) > 1 else np.zeros(count, dtype=np.uint8)
    own = {name: np.asarray(state[name]) for name in OWN_NUMBERS if name in state}
    needles = State({"species": species, "bodies": bodies, **own})
    length, diameter, mass, inertia = (needles.numbers(name) for name in OWN_NUMBERS)
    low, high = _bounds(frame, np.max(length + diameter, initial=0) / 2)
    flow = state.get("flow")
    position, image, tilt = frame.position, frame.image, 0.0
    if flow:
        position, image, tilt = _in_tilted_cell(frame, flow["slide"])
    centre = (low + high + [tilt, 0, 0]) / 2
    snapshot.configuration.box = [*(high - low), tilt / frame.box[1], 0, 0]
    particles = snapshot.particles
    particles.N = count
    particles.types = names
    particles.type_shapes = [_shape(length, diameter) for length, diameter in
                             zip(lengths.tolist(), diameters.tolist())]
    particles.typeid = species.astype(np.uint32)
    particles.position = position - centre
    particles.image = image
    particles.velocity = frame.velocity
    particles.orientation = quaternions(frame.orientation)
    particles.mass = mass
    particles.moment_inertia = np.stack([inertia, inertia, np.where(length > 0, 0, inertia)], axis=1)
    particles.diameter = np.where(diameter > 0, diameter, length)
    snapshot.log = {"particles/angular_velocity": np.asarray(frame.angular_velocity),
                    "time": np.array([frame.time]),
                    **{name: bodies[name].astype(float) for name in NUMBERS_OF_BODIES
                       if name in bodies},
                    "periodic": frame.periodic.astype(np.uint8),
                    "edges": np.asarray(frame.box, dtype=float), "centre": centre}
    if "low" in state:
        snapshot.log["low"] = np.asarray(frame.low, dtype=float)
    snapshot.log |= {f"particles/{name}": numbers for name, numbers in own.items()}
    snapshot.log |= {name: np.array([number]) for name, number in (flow or {}).items()}
    return snapshot


def _in_tilted_cell(frame: Any, slide: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Centres in a cell that is tilted by at most half an edge, which HOOMD-blue asks for, their
    images, and the tilt [L]."""
    edge, edge_y = frame.box[:2]
    tilt, edges = reduced_tilt(slide, edge, -edge / 2)
    boxes = np.floor((frame.position[:, 0] - tilt * frame.position[:, 1] / edge_y) / edge)
    along_x = np.outer(boxes, [1, 0, 0])
    image = counted(frame.image, edges) + along_x.astype(np.int32)
    return frame.position - edge * along_x, image, tilt


def _mode(mode: str) -> str:
    """"r" or "w", as this version of the package names it: those before 2.8 say "rb" and "wb"."""
    import gsd.hoomd

    return mode if hasattr(gsd.hoomd, "Frame") else mode + "b"


def _bounds(frame: Any, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Of the box and, along axes with walls, of centres beyond it and so much more."""
    low = np.array(frame.low, dtype=float)
    high = low + frame.box
    if len(frame.position) > 0:
        least, most = np.min(frame.position, axis=0), np.max(frame.position, axis=0)
        low = np.where(~frame.periodic & (least < low), least - reach, low)
        high = np.where(~frame.periodic & (most > high), most + reach, high)
    return low, high


def _shape(length: float, diameter: float) -> dict[str, Any]:
    """How a body is drawn along the axis z. The format has no cylinders with caps."""
    if diameter == 0:
        width = DRAWN_RADIUS * length
        return {"type": "Ellipsoid", "a": width, "b": width, "c": length / 2}
    if length == 0:
        return {"type": "Sphere", "diameter": diameter}
    vertices, triangles = capsule(length, diameter)
    return {"type": "Mesh", "vertices": vertices.tolist(), "indices": triangles.tolist()}


def capsule(length: float, diameter: float, around: int = 24,
            rings: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [V, 3] on a cylinder along z with spherical caps, and triangles [T, 3] of them that
    face outwards: `rings` circles of vertices on each cap, and its pole."""
    heights = np.pi / 2 * np.arange(rings) / rings  # angles above the rim of a cap
    angles = 2 * np.pi * np.arange(around) / around
    circle = np.stack([np.cos(angles), np.sin(angles), np.zeros(around)], axis=1)
    cap = [diameter / 2 * (np.cos(h) * circle + [0, 0, np.sin(h)]) for h in heights]
    upper = [ring + [0, 0, length / 2] for ring in cap]
    circles = [ring * [1, 1, -1] for ring in upper[::-1]] + upper  # from below
    pole = (length + diameter) / 2
    vertices = np.concatenate([[[0, 0, -pole]], *circles, [[0, 0, pole]]])
    triangles, last = [], len(vertices) - 1
    for j in range(around):
        k = (j + 1) % around
        triangles.append([0, 1 + k, 1 + j])
        for ring in range(len(circles) - 1):
            a, b = 1 + ring * around, 1 + (ring + 1) * around
            triangles += [[a + j, a + k, b + k], [a + j, b + k, b + j]]
        triangles.append([last - around + j, last - around + k, last])
    return vertices, np.array(triangles)


def quaternions(directors: np.ndarray) -> np.ndarray:
    """Quaternions (w, x, y, z) of the shortest turns of (0, 0, 1) into the directors, [N, 4]."""
    x, y, z = np.asarray(directors).T
    w = np.sqrt((1 + z) / 2)
    down = w < 1e-8  # any half turn about an axis normal to z
    safe = np.where(down, 1, 2 * w)
    out = np.stack([w, -y / safe, x / safe, np.zeros_like(w)], axis=1)
    out[down] = [0, 1, 0, 0]
    return out / np.linalg.norm(out, axis=1, keepdims=True)
