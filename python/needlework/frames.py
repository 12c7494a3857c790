"""Frames of H5MD files: those that runs have written, and those of other programs.

The layouts that are read are those of initial.file; docs/file-format.md lists them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import InputError, IoError
from .state import ARRAYS, NUMBERS_OF_BODIES, OWN_NUMBERS, Bodies, State, read_only
from .tilt import counted, reduced_tilt
from .values import NotPickled

if TYPE_CHECKING:
    import h5py

VECTORS = ("position", "velocity", "orientation", "angular_velocity")


class Frame(NotPickled):
    """All needles at one instant, in the order of the file, which is that of id where Needlework has
    written it. Arrays are read when they are asked for."""

    _instead = "frame.state, its arrays, or the path of the file"

    def __init__(self, needles: Needles, index: int) -> None:
        self._needles = needles
        self._index = index
        self.time: float = float(needles.times[index])
        """Since the start of the run [time]; not a number where the file does not say it."""
        self.collisions: int | None = None if needles.steps is None else int(needles.steps[index])
        """Number of collisions before this instant, which other programs than Needlework count as
        they like; None where the file does not say it."""

    def _vectors(self, name: str, dtype: type = np.float64) -> np.ndarray:
        return self._needles.row(name, 2, self._index, dtype)

    @cached_property
    def position(self) -> np.ndarray:
        """Centres in the box, [N, 3] [L]."""
        return self._vectors("position")

    @cached_property
    def velocity(self) -> np.ndarray:
        """Velocities, [N, 3] [L / time]."""
        return self._vectors("velocity")

    @cached_property
    def orientation(self) -> np.ndarray:
        """Unit directors, [N, 3]."""
        return self._vectors("orientation")

    @cached_property
    def angular_velocity(self) -> np.ndarray:
        """Angular velocities, normal to the directors, [N, 3] [1 / time]."""
        return self._vectors("angular_velocity")

    @cached_property
    def image(self) -> np.ndarray:
        """Number of boxes to add to each centre to follow its path, [N, 3]; 0 where the file does
        not hold it."""
        if "image" not in self._needles:
            return np.zeros((self._needles.count, 3), dtype=np.int32)
        image, edges = self._vectors("image", np.int32), self._slide[1]
        return image if edges == 0 else counted(image, edges)

    @cached_property
    def box(self) -> np.ndarray:
        """Edges of the box, [3] [L]."""
        return self._needles.box(self._index)

    @cached_property
    def low(self) -> np.ndarray:
        """Where the low edges are: 0, but where a wall with a velocity has moved one, [3] [L]."""
        return self._needles.low(self._index)

    @property
    def periodic(self) -> np.ndarray:
        """Along which axes the box is periodic, [3]; along the others there are walls."""
        return self._needles.periodic

    @cached_property
    def id(self) -> np.ndarray:
        """Ids of the needles, [N]; 0 to N - 1 where the file does not hold them."""
        if "id" not in self._needles:
            return np.arange(self._needles.count, dtype=np.uint32)
        return self._needles.row("id", 1, self._index, np.uint32)

    @cached_property
    def species(self) -> np.ndarray:
        """Species of the needles, [N], counted from 0; all 0 where the file does not hold them."""
        if "species" not in self._needles:
            return np.zeros(self._needles.count, dtype=np.uint8)
        return self._needles.row("species", 1, self._index, np.uint8)

    @property
    def length(self) -> np.ndarray:
        """Length of the axis of each needle, [N] [L]; not a number where the file does not say it,
        as for the next three."""
        return self._numbers("length")

    @property
    def diameter(self) -> np.ndarray:
        """Diameter of each needle, 0 of thin ones, [N] [L]."""
        return self._numbers("diameter")

    @property
    def mass(self) -> np.ndarray:
        """Mass of each needle, infinite of fixed ones, [N] [m]."""
        return self._numbers("mass")

    @property
    def inertia(self) -> np.ndarray:
        """Moment of inertia of each needle about axes normal to its director, [N] [m L^2]."""
        return self._numbers("inertia")

    @property
    def scale(self) -> float:
        """Sizes of bodies that grow in those of the start, which the other arrays have; 1 where bodies
        do not grow."""
        return self._scale or 1.0

    @cached_property
    def _scale(self) -> float | None:
        return self._needles.scale(self._index)

    @cached_property
    def _bodies(self) -> tuple[Bodies, dict[str, np.ndarray]]:
        """Of the species and, where these differ, of each needle, as large as they are now."""
        bodies, own = self._needles.bodies, self._needles.own
        if self._scale is None:
            return bodies, own
        return bodies.grown(self._scale), {
            name: column * self._scale if name in ("length", "diameter") else column
            for name, column in own.items()}

    def _numbers(self, name: str) -> np.ndarray:
        bodies, own = self._bodies
        return State({"species": self.species, "bodies": bodies, **own}).numbers(name)

    @property
    def state(self) -> State:
        """All needles: the arrays position, velocity, orientation, angular_velocity, image, id and
        species by name, those of length, diameter, mass and inertia where bodies of a species
        differ, box and low where walls with a velocity move edges, and bodies.
        ``Simulation(scene, **state)`` starts from it."""
        flow = (self._slide[0], self._needles.shear_rate)
        bodies, own = self._bodies
        return State.of((getattr(self, name) for name in ARRAYS), bodies,
                        flow if flow != (0, 0) else None, own,
                        (self.box, self.low) if "box/low" in self._needles else None)

    @property
    def _slide(self) -> tuple[float, int]:
        """By how much the box is tilted along x, reduced as in a state."""
        return reduced_tilt(self._needles.tilt(self._index), self.box[0])

    def __repr__(self) -> str:
        collisions = "" if self.collisions is None else f", {self.collisions} collisions"
        return f"<Frame {self._index} at time {self.time:g}{collisions}>"


class Frames(NotPickled, Sequence):
    """Frames by index: ``frames[-1]``, ``len(frames)``, ``for frame in frames``."""

    _instead = "the path of the file"

    def __init__(self, path: str, group: h5py.Group) -> None:
        self._needles = Needles(path, group)

    def __len__(self) -> int:
        return self._needles.frames

    def __getitem__(self, index: Any) -> Any:
        chosen = places("frames", len(self), index)
        if isinstance(chosen, range):
            return [Frame(self._needles, place) for place in chosen]
        return Frame(self._needles, chosen)

    @property
    def time(self) -> np.ndarray:
        """Times of all frames, [F] [time]; not numbers where the file does not hold them."""
        return self._needles.times.copy()

    def __repr__(self) -> str:
        return f"<{len(self)} Frames>"


def places(name: str, count: int, index: Any) -> int | range:
    """The place that an index means, or the places of a slice."""
    try:
        return range(count)[index]
    except IndexError:
        expected = f"an index from {-count} to {count - 1}" if count else "no index, as it is empty"
        raise IndexError(f"{name}[{index}]: expected {expected}") from None
    except TypeError:
        raise InputError(f"{name}: an index of the type {type(index).__name__}: expected a whole "
                         f"number or a slice; to choose by a mask, read all: {name}[:]") from None


def find_needles(path: str, file: h5py.File) -> h5py.Group:
    """The group of the needles: /particles/needles, or the only group under /particles."""
    import h5py

    groups = {}
    if isinstance(_get(file, "particles"), h5py.Group):
        particles = file["particles"]
        groups = {name: item for name in particles
                  if isinstance(item := _get(particles, name), h5py.Group)}
    if "needles" in groups:
        return groups["needles"]
    if len(groups) != 1:
        raise InputError(f"{path}: /particles: {len(groups)} groups: expected the file of a run, or "
                         "an H5MD file with one group of particles, or one named needles")
    return next(iter(groups.values()))


def _get(group: h5py.Group, name: str) -> Any:
    """What has this name, or None if nothing has, or a link leads nowhere."""
    try:
        return group.get(name)
    except (KeyError, OSError):
        return None


def _periodic(group: h5py.Group) -> np.ndarray:
    """Along which axes the box of a group is, which are all where the file does not say it."""
    boundary = _get(group, "box").attrs.get("boundary", ())
    words = [word.decode() if isinstance(word, bytes) else str(word) for word in np.ravel(boundary)]
    return np.array([word != "none" for word in words] if len(words) == 3 else [True] * 3)


def _bodies(group: h5py.Group) -> Bodies:
    """What a file says of its bodies in /parameters or, of the mass, with the particles; without
    what was assumed when the file was imported. See docs/file-format.md."""
    import h5py

    parameters = _get(group.file, "parameters")

    def dataset(name: str) -> h5py.Dataset | None:
        item = _get(parameters, name) if isinstance(parameters, h5py.Group) else None
        return item if isinstance(item, h5py.Dataset) else None

    def column(name: str) -> np.ndarray:
        item = dataset(name)
        if item is None or "assumed" in item.attrs or len(item.shape) > 1:
            return np.array([])
        if name == "species":
            names = item.asstr()[()] if h5py.check_string_dtype(item.dtype) else []
            return np.atleast_1d(np.array(names, dtype=object))
        return np.atleast_1d(item[()]) if item.dtype.kind in "iuf" else np.array([])

    known = {"name": column("species"), **{name: column(name) for name in NUMBERS_OF_BODIES}}
    by_assumed = any((item := dataset(name)) is not None and "assumed" in item.attrs
                     for name in ("length", "mass", "k"))
    if by_assumed or len(known["inertia"]) != len(known["length"]):
        known["inertia"] = np.array([])
    if dataset("diameter") is None:
        known["diameter"] = np.zeros(len(known["length"]))
    masses = _get(group, "mass")
    if isinstance(_get(group, "length"), h5py.Dataset):
        masses = None  # each body has its own
    if dataset("mass") is None and isinstance(masses, h5py.Dataset) and len(masses.shape) == 1:
        species = _get(group, "species")
        indices = species[()] if isinstance(species, h5py.Dataset) else np.zeros(len(masses), int)
        present = np.unique(indices)
        if np.shape(indices) == masses.shape and np.array_equal(present, range(len(present))):
            by_species = [np.unique(masses[()][indices == index]) for index in present]
            if all(len(each) == 1 for each in by_species):
                known["mass"] = np.concatenate(by_species) if by_species else np.array([])
    return Bodies.of(known)


def _own_numbers(path: str, group: h5py.Group, count: int) -> dict[str, np.ndarray]:
    """The columns of OWN_NUMBERS where particles have a length, which they have where bodies of a
    species differ."""
    import h5py

    columns = {}
    for name in OWN_NUMBERS if isinstance(_get(group, "length"), h5py.Dataset) else ():
        item = _get(group, name)
        if not isinstance(item, h5py.Dataset):
            continue
        if item.dtype.kind not in "iuf" or item.shape != (count,):
            raise InputError(f"{path}: {group.name}/{name}: type {item.dtype} and shape "
                             f"{list(item.shape)}: expected a number for each needle, [{count}]")
        columns[name] = item[()].astype(float)
        columns[name].setflags(write=False)
    return columns


class Element:
    """An H5MD element, a group with the dataset value and optionally step and time, or a plain
    dataset, which is read like an element without step and time."""

    def __init__(self, path: str, group: h5py.Group, name: str) -> None:
        import h5py

        item = _get(group, name)
        self._group = item if isinstance(item, h5py.Group) else None
        self.is_group = self._group is not None
        where = f"{group.name}/{name}"
        self._path = path
        self.name = where + "/value" if self.is_group else where
        self._value = _get(item, "value") if self.is_group else item
        if not isinstance(self._value, h5py.Dataset):
            self.reject("missing: expected a dataset")
        if self._value.dtype.kind not in "iuf":
            self.reject("the values are not numbers: expected floating point or integers")
        self.shape = self._value.shape or ()
        # The step of a row is written last.
        self.steps = self._grid("step", np.int64)
        self.rows = self.shape[0] if self.shape else 0
        if self.steps is not None:
            if len(self.steps) > self.rows:
                self.reject(f"{len(self.steps)} steps: expected {self.rows}, one for each row")
            self.rows = len(self.steps)
            if np.any(np.diff(self.steps) < 0):
                self.reject("steps that go back: expected them in order")

    def reject(self, reason: str) -> None:
        raise InputError(f"{self._path}: {self.name}: {reason}")

    @property
    def times(self) -> np.ndarray | None:
        """The time of each row, or None."""
        return self._grid("time", np.float64)

    def read(self, row: int | None, dtype: type) -> np.ndarray:
        """One row, or all of them, as numbers of this type."""
        if not self._value:
            raise IoError(f"{self._path}: is closed: expected an open file")
        try:
            values = self._value[()] if row is None else self._value[row]
        except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
            raise IoError(f"{self._path}: {self.name}: cannot be read: {error}") from error
        if values.dtype == dtype:
            return values
        with np.errstate(invalid="ignore"):
            converted = values.astype(dtype)
        if np.dtype(dtype).kind != "f" and not np.array_equal(converted, values):
            self.reject(f"expected whole numbers that {np.dtype(dtype).name} can hold")
        return converted

    def _grid(self, name: str, dtype: type) -> np.ndarray | None:
        """H5MD allows either one step and time for each row, or a scalar increment with an
        offset."""
        import h5py

        item = _get(self._group, name) if self.is_group else None
        if not isinstance(item, h5py.Dataset):
            return None
        if item.dtype.kind not in "iuf" or len(item.shape or ()) > 1:
            self.reject(f"{name} of type {item.dtype} and shape {item.shape}: expected one number "
                        "for each row")
        values = item[()]
        if item.shape:
            return values.astype(dtype)
        offset, rows = item.attrs.get("offset", 0), self.shape[0] if self.shape else 0
        if dtype is np.float64:
            return float(offset) + np.arange(rows) * float(values)
        grid = [int(offset) + row * int(values) for row in (0, max(rows - 1, 0))]
        if any(abs(number) >= 2**63 for number in grid):
            self.reject(f"steps up to {max(grid)}: expected numbers of 64 bits")
        return int(offset) + np.arange(rows, dtype=np.int64) * int(values)


class Needles:
    """The group of the needles of a file, and which rows of its elements belong to one frame.

    Frames are the steps that all elements with steps have. If elements differ in their steps, a
    frame is a step that is common to all, and the last row with that step belongs to it. Without
    steps a frame is a row of the positions.
    """

    def __init__(self, path: str, group: h5py.Group) -> None:
        self._elements = {name: Element(path, group, name) for name in VECTORS}
        for name in ("image", "id", "species", "box/edges", "box/low", "box/scale"):
            if _get(group, name) is not None:
                self._elements[name] = Element(path, group, name)
        if "box/edges" not in self:
            raise InputError(f"{path}: {group.name}/box/edges: missing: expected edges")
        position = self._elements["position"]
        if len(position.shape) not in (2, 3) or position.shape[-1] != 3:
            position.reject(f"shape {position.shape}: expected [frames][needles][3]")
        self.count = position.shape[-2]
        self._common: np.ndarray | None = None  # steps of the frames, if elements differ in them
        self.periodic = read_only(_periodic(group))
        self.shear_rate = float(np.ravel(_get(group, "box").attrs.get("shear_rate", 0))[0])
        self.bodies = _bodies(group)
        self.own = _own_numbers(path, group, self.count)
        if self.own and "diameter" not in self.own and not np.any(self.bodies.get("diameter", 0)):
            self.own["diameter"] = np.zeros(self.count)  # not written for thin needles
        self.frames = self._count_frames(position)
        self._require_shapes()
        self.steps, self.times = self._steps_and_times(position)

    def __contains__(self, name: str) -> bool:
        return name in self._elements

    def row(self, name: str, rank: int, frame: int, dtype: type) -> np.ndarray:
        """What an element, of which one frame has `rank` dimensions, holds of a frame."""
        element = self._elements[name]
        return element.read(self._row(element, rank, frame), dtype)

    def box(self, frame: int) -> np.ndarray:
        """Edges of the box in a frame, which may be vectors, the rows of a matrix."""
        edges, values = self._elements["box/edges"], self._vectors_of_box(frame).diagonal().copy()
        if not np.all((values > 0) & (values < math.inf)):
            edges.reject(f"{values.tolist()}: expected edges above 0")
        return values

    def low(self, frame: int) -> np.ndarray:
        """Where the low edges are in a frame, which files of Needlework say where walls move them."""
        if "box/low" not in self:
            return np.zeros(3)
        values = self.row("box/low", 1, frame, np.float64)
        if not np.all(np.isfinite(values)):
            self._elements["box/low"].reject(f"{values.tolist()}: expected finite numbers")
        return values

    def scale(self, frame: int) -> float | None:
        """Sizes of bodies that grow in those of the start; None where bodies do not grow."""
        if "box/scale" not in self:
            return None
        value = float(self.row("box/scale", 0, frame, np.float64))
        if not 0 < value < math.inf:
            self._elements["box/scale"].reject(f"{value}: expected a finite number > 0")
        return value

    def tilt(self, frame: int) -> float:
        """By how much the second edge of the box is tilted along x."""
        return float(self._vectors_of_box(frame)[1, 0])

    def _vectors_of_box(self, frame: int) -> np.ndarray:
        edges = self._elements["box/edges"]
        rank = 1 if len(edges.shape) == 1 or self._edges_by_row(edges) else 2
        values = edges.read(self._row(edges, rank, frame), np.float64)
        if values.ndim == 1:
            return np.diag(values)
        others = ~np.eye(3, dtype=bool)
        others[1, 0] = False
        if np.any(values[others] != 0) or not np.isfinite(values[1, 0]):
            edges.reject("edges that are not along the axes: expected a box that is rectangular or "
                         "tilted along x by y")
        return values

    def _count_frames(self, position: Element) -> int:
        timed = [element for element in self._elements.values() if element.steps is not None]
        if any(element.rows == 0 for element in timed):
            return 0  # a run has not written its first frame yet
        if not timed:
            return 1 if len(position.shape) == 2 else position.rows
        first = timed[0]
        if not all(np.array_equal(element.steps, first.steps) for element in timed):
            common = first.steps
            for element in timed:
                common = np.intersect1d(common, element.steps)
            if len(common) == 0:
                first.reject("no step in common with the other elements: expected one")
            self._common = common
        return first.rows if self._common is None else len(self._common)

    def _row(self, element: Element, rank: int, frame: int) -> int | None:
        """The row of this frame, or None if the element is one frame as a whole."""
        if len(element.shape) == rank:
            return None
        if element.rows == 0:
            element.reject("no frames: expected at least one")
        if element.steps is not None:
            if self._common is None:
                return frame
            return int(np.searchsorted(element.steps, self._common[frame], side="right")) - 1
        position = self._elements["position"]
        if len(position.shape) == 3 and element.rows != position.rows:
            element.reject(f"{element.rows} frames: expected {position.rows}, as in "
                           f"{position.name}")
        # Without steps, an element belongs to the rows of the positions.
        if element is not position and len(position.shape) == 3:
            return self._row(position, 2, frame)
        if element.rows == self.frames:
            return frame
        if frame + 1 == self.frames:
            return element.rows - 1
        element.reject(f"{element.rows} frames: expected {self.frames}")

    def _require_shapes(self) -> None:
        for name, element in self._elements.items():
            shape, count = element.shape, self.count
            if name == "box/edges":
                good = len(shape) in (1, 2, 3) and shape[-1] == 3
                good = good and (len(shape) < 3 or shape[1] == 3)
                expected = "[3], [3][3], [frames][3] or [frames][3][3]"
            elif name == "box/low":
                good = len(shape) in (1, 2) and shape[-1] == 3
                expected = "[3] or [frames][3]"
            elif name == "box/scale":
                good = len(shape) == 1
                expected = "[frames]"
            elif name in ("id", "species"):
                good = len(shape) in (1, 2) and shape[-1] == count
                expected = f"[{count}] or [frames][{count}]"
            else:
                good = shape[-2:] == (count, 3) and len(shape) in (2, 3)
                good = good and (len(shape) == 3 or not element.is_group)
                expected = f"[frames][{count}][3]"
            if not good:
                element.reject(f"shape {list(shape)}: expected {expected}")

    def _edges_by_row(self, edges: Element) -> bool:
        """Whether edges of shape [n][3] have one row for each frame. The shape [3][3] is read as a
        matrix unless it must be the edges of three frames."""
        if len(edges.shape) != 2:
            return False
        if edges.shape[0] != 3 or edges.steps is not None:
            return True
        position = self._elements["position"]
        if len(position.shape) != 3 or position.rows != 3:
            return False
        values = edges.read(None, np.float64)
        # Three equal rows are not a matrix, because the box would have no volume.
        return edges.is_group or bool(np.all(values == values[0]))

    def _steps_and_times(self, position: Element) -> tuple[np.ndarray | None, np.ndarray]:
        steps, times = position.steps, position.times
        rows = np.array([self._row(position, 2, frame) or 0 for frame in range(self.frames)], int)
        known = None if steps is None else steps[rows]
        if times is None or len(times) <= rows.max(initial=-1):
            return known, np.full(self.frames, np.nan)
        return known, times[rows]
