"""Reads files of runs: series, frames (in frames.py) and collisions as NumPy arrays.

Files are read with h5py rather than with the library, which reads last frames and series only:
h5py reads the frames and the collisions that are asked for and nothing else, whatever the size of
the file. docs/file-format.md describes what is in a file.
"""

from __future__ import annotations

import fcntl
import os
import struct
import time
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from .collisions import RECORDED_COLLISION, RECORDED_HAPPENING
from .data import value_of
from .errors import InputError, IoError
from .frames import Frame, Frames, find_needles, places
from .phases import mean_by_phase
from .sweeps import SweepSummary, read_summary
from .values import NotPickled, Table, Values, html_table, pandas_table, plain

if TYPE_CHECKING:
    import h5py
    import pandas
    from numpy.typing import ArrayLike


def read(path: str | os.PathLike[str]) -> Recording | SweepSummary:
    """Opens a file that a run has written, or is writing, or any other H5MD file of needles, of
    which there are the frames only. Of the summary.h5 of a sweep it gives the SweepSummary.

    What is already in the file at that moment can be read. Close it and open it again to see more.

    Raises IoError if the file cannot be read, and InputError if it does not hold needles: position,
    velocity, orientation and angular_velocity in /particles/needles, or in the only group under
    /particles, in one of the layouts that initial.file can have.
    """
    summary = read_summary(path)
    return Recording(path) if summary is None else summary


class Series(Table):
    """Sums over all needles at the times of the samples, arrays [S]."""

    # numbers of totals
    time: np.ndarray
    """Time since the start of the run [time]."""
    t_tr: np.ndarray
    """Translational temperature: two thirds of the mean energy of translation [energy]."""
    t_rot: np.ndarray
    """Rotational temperature: the mean energy of rotation per two degrees of freedom
    [energy]."""
    energy: np.ndarray
    """Kinetic energy per needle, and that in gravity between walls [energy]."""
    momentum: np.ndarray
    """Total momentum of all needles [mass times length per time], [S, 3]."""
    collisions: np.ndarray
    """Number of collisions since the start of the run."""
    tc_collisions: np.ndarray
    """Number of collisions since the start of the run that the contact-time rule made
    elastic."""
    # end of numbers

    @classmethod
    def of(cls, samples: Iterable[Mapping[str, Any]]) -> Series:
        """The series of the totals of a simulation at some times, in order of time."""
        samples = list(samples)
        return cls({name: np.array([sample[name] for sample in samples])
                    for name in cls.__annotations__})


class VelocitiesSet(Table):
    """Where a caller has replaced all velocities, arrays [C], and [C, 2] of what was before and
    after."""

    time: np.ndarray
    """Since the start of the run [time]."""
    collisions: np.ndarray
    """Number of collisions before."""
    # changes of totals
    t_tr: np.ndarray
    """Translational temperature: two thirds of the mean energy of translation [energy], [C,
    2]."""
    t_rot: np.ndarray
    """Rotational temperature: the mean energy of rotation per two degrees of freedom [energy],
    [C, 2]."""
    energy: np.ndarray
    """Kinetic energy per needle, and that in gravity between walls [energy], [C, 2]."""
    momentum: np.ndarray
    """Total momentum of all needles [mass times length per time], [C, 2, 3]."""
    # end of changes


class Events(NotPickled):
    """Collisions, and events of single needles, in the order of their times.

    ``events[i]`` is one of them and ``events[a:b]`` a structured array, for which nothing else is
    read; ``events["arms"]`` is one field of all, and ``events[:][mask]`` those that a mask chooses
    from all of them. The fields are those of Simulation.on_collisions, or, where the scene has
    other events than collisions, of on_happenings, with ``kind``; without sin_angle and
    energy_change, which files do not hold.
    """

    _instead = "events[:], the collisions as an array, or the path of the file"

    def __init__(self, group: h5py.Group) -> None:
        self._group = group
        self._count = len(group["time"])  # written last
        self.dtype = RECORDED_HAPPENING if "kind" in group else RECORDED_COLLISION

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: Any) -> np.ndarray:
        if isinstance(index, str):
            if index not in self.dtype.names:
                raise InputError(f"events[{index!r}]: expected one of "
                                 f"{', '.join(self.dtype.names)}")
            return self._group[index][:self._count].astype(self.dtype[index].base)
        chosen = places("events", self._count, index)
        if not isinstance(chosen, range):
            return self[chosen:chosen + 1][0]
        first, last = (min(chosen), max(chosen) + 1) if chosen else (0, 0)
        rows = np.empty(last - first, dtype=self.dtype)
        for name in self.dtype.names:
            rows[name] = self._group[name][first:last]
        return rows[::chosen.step] if chosen.step > 0 else rows[::-1][::-chosen.step]

    def __iter__(self) -> Iterator[np.void]:
        for begin in range(0, self._count, 8192):
            yield from self[begin:begin + 8192]

    def to_pandas(self) -> pandas.DataFrame:
        """All collisions as a table of pandas, with columns such as pair_1 and impulse_x."""
        return pandas_table({name: self[name] for name in self.dtype.names})

    def __repr__(self) -> str:
        return f"<{self._count} Events: {', '.join(self.dtype.names)}>"


class Recording(NotPickled):
    """The file of a run, or of needles; see read(). It is closed by close(), by ``with``, or when
    forgotten."""

    _instead = "recording.path, for needlework.read() elsewhere"

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fsdecode(path)
        self._file, self._held = _open(self.path)
        try:
            self._needles = find_needles(self.path, self._file)
            self._frames = Frames(self.path, self._needles)
        except BaseException:
            self.close()
            raise

    @cached_property
    def series(self) -> Series:
        """Sums over all needles, many times per decade of time. A file of an earlier version may
        lack some."""
        group = self._group("series", "a file of a run with a series")
        samples = len(group["step"])
        columns = {"time": group["time"][:samples]}
        columns |= {name: group[name]["value"][:samples]
                    for name in Series.__annotations__ if name != "time" and name in group}
        return Series(columns)

    def observable(self, name: str) -> Values:
        """What output.observables named, or what the run has without: "theory", "species",
        "walls", "rods", "contacts", "growth", "energy_budget", "pressure_tensor". Fields of one row
        per sample of the series, and constants such as the borders of bins."""
        series = self._group("series", "a file of a run with a series")
        names = [each for each in series if each not in ("step", *Series.__annotations__)]
        if name not in names:
            raise InputError(f"{self.path}: observable({name!r}): expected one of those of this run, "
                             f"{', '.join(names) or 'which has none'}; output.observables of its "
                             "scene names others")
        samples = len(series["step"])
        return Values({field: item["value"][:samples] if hasattr(item, "keys") else item[()]
                       for field, item in series[name].items()})

    def by_phase(self, values: ArrayLike, bins: int = 16, wall: int | None = None,
                 weights: ArrayLike | None = None, since: float = 0) -> Values:
        """Means of values over the samples at each phase of the motion of a wall.

        ``values`` has a row for each sample, [S, ...], as fields of observable() and columns of
        the series have. ``wall`` is the index of a wall in motion, as in wall_totals; without it,
        the first one. ``weights``, [S] or of the shape of the values, weight them, such as
        temperatures of slabs by densities. Samples before the time ``since`` are left out, and so
        are values that are NaN.

        Returns phase, [bins]: the middles of the bins, multiples of 2 pi / bins; mean,
        [bins, ...], NaN where there is nothing; and samples, [bins]: how many each bin has.
        """
        walls = self.observable("walls")
        moving = ([] if "phase" not in walls else
                  np.flatnonzero(~np.isnan(walls.phase).any(axis=0)).tolist())
        if not moving or wall not in (None, *moving):
            expected = f"that of one in motion, {moving}" if moving else "walls in motion"
            raise InputError(f"{self.path}: by_phase(): wall = {wall}: expected {expected}")
        phase = walls.phase[:, moving[0] if wall is None else wall]
        counted = self.series.time >= since
        return mean_by_phase(phase, values, bins, weights, counted)

    @cached_property
    def velocities_set(self) -> VelocitiesSet:
        """Where a caller has replaced all velocities; without rows where none has."""
        if not self._has("velocities_set"):  # of an earlier version, or another program
            columns = {name: np.empty((0, 2)) for name in VelocitiesSet.__annotations__}
            return VelocitiesSet(columns | {"time": np.empty(0), "collisions": np.empty(0),
                                            "momentum": np.empty((0, 2, 3))})
        group = self._file["velocities_set"]
        changes = len(group["step"])
        stored = {name: "step" if name == "collisions" else name
                  for name in VelocitiesSet.__annotations__}
        return VelocitiesSet({name: group[dataset][:changes] for name, dataset in stored.items()
                              if dataset in group})

    @cached_property
    def data(self) -> dict[str, Any]:
        """The user's own data by name, as Simulation.data had them last."""
        if not self._has("user_data"):
            return {}
        group, found = self._file["user_data"], {}
        entries = len(group["step"])
        columns = [group[name][:entries] for name in ("name", "json", "begin", "size")]
        for name, is_json, begin, size in zip(*columns):
            name = name.rstrip(b"\0").decode()
            found.pop(name, None)
            if size >= 0:
                value = group["bytes"][begin:begin + size].tobytes()
                found[name] = value_of(bool(is_json), value)
        return found

    @property
    def frames(self) -> Frames:
        """States of all needles, read one by one."""
        self._require_open()
        return self._frames

    @property
    def events(self) -> Events:
        """Collisions, if the scene asked for them with output.events = true."""
        return Events(self._group("events", "a run with output.events = true"))

    @cached_property
    def parameters(self) -> Values:
        """Scene and settings of the run: scene, version, seed, isa, threads, k, epsilon, ..."""
        group = self._group("parameters", "the parameters of a run")
        return Values({name: plain(data[()]) for name, data in group.items()})

    @cached_property
    def gas(self) -> Values:
        """What theory has to know: count, box, k, epsilon, beta, length and mass; of several
        species the arrays species (their names), counts, k, length and mass, [species], and
        epsilon and beta of each two, [species, species]; meet, of each two whether they do, where
        some pass through each other; diameter of rods of finite width, and q = 4 I / (m D^2)
        where spheres are rough, of each species of several; differ, whether bodies of a species do, of whom length, diameter, mass
        and k are means; and undisturbed_until, when a caller
        first replaced the velocities, 0 where more than collisions acts on the gas, or inf."""
        given, first = self.parameters, self.frames[0]
        facts = {"count": len(first.id), "box": first.box, "differ": "length" in self._needles}
        if "species" in given:
            facts |= {"species": tuple(name.decode() for name in given.species),
                      "counts": given.counts}
        if "mass" in given:
            facts["mass"] = given.mass
        else:  # of an older version, or of another program
            masses = self._needles["mass"][:1] if "mass" in self._needles else ()
            facts["mass"] = float(masses[0]) if len(masses) else 1.0
        for name in ("diameter", "meet"):
            if name in given:
                facts[name] = given[name]
        q = _q_of_spheres(given)
        if np.any(q > 0):
            facts["q"] = q
        return Values({**facts, "k": given.k, "epsilon": given.epsilon, "beta": given.beta,
                       "length": given.get("length", 1.0),
                       "undisturbed_until": undisturbed_until(
                           self._file.get("series/energy_budget", ()),
                           min(self.velocities_set.time, default=np.inf))})

    def close(self) -> None:
        """Closes the file. Arrays that were read stay."""
        self._held = []
        self._file.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def _require_open(self) -> None:
        if not self._file:
            raise IoError(f"{self.path}: is closed: expected an open file")

    def _has(self, name: str) -> bool:
        """Files of older versions have less."""
        return name in self._group("/", "the root")

    def _group(self, name: str, expected: str) -> h5py.Group:
        self._require_open()
        if name not in self._file:
            raise InputError(f"{self.path}: /{name} is missing: expected {expected}")
        return self._file[name]

    def __repr__(self) -> str:
        return f"<Recording {self.path}>" if self._file else f"<Recording {self.path}, closed>"

    def _repr_html_(self) -> str:
        facts = {"file": self.path}
        if self._file:
            frames = self.frames
            facts |= {"title": self.parameters.title if self._has("parameters") else "",
                      "needles": len(frames[0].id), "frames": len(frames),
                      "samples": self.series.rows if self._has("series") else "not recorded",
                      "events": len(self.events) if self._has("events") else "not recorded"}
        return html_table(facts)


def undisturbed_until(effects: Iterable[str], velocities_set: float) -> float:
    """How long kinetic theory may follow a gas of these numbers of the energy budget: 0 where
    walls, shear, growth or driving act on it, else until a caller replaces the velocities."""
    return 0.0 if set(effects) - {"pairs", "velocities_set"} else velocities_set


def _q_of_spheres(given: Values) -> np.ndarray | float:
    """4 I / (m D^2), which only rough spheres have: 0 of others, and of fixed ones, whose mass and
    moment of inertia are infinite."""
    if "inertia" not in given:
        return 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        q = 4 * np.divide(given.inertia, np.multiply(given.mass, np.square(given.diameter)))
    return plain(np.where((np.asarray(given.length) == 0) & np.isfinite(q), q, 0.0)[()])


def _open(path: str) -> tuple[h5py.File, list[h5py.Dataset]]:
    """The file, and what has to stay open while it is."""
    try:
        import h5py
    except ImportError as error:
        raise ImportError("needlework.read() needs h5py: expected the package python3-h5py "
                          "to be installed") from error
    try:
        with _core.StandardDescriptors():
            written, can_lock = _locks(path)
            grows = written or not can_lock
            lock = {} if can_lock else {"locking": False}
            # Again if this process was kept waiting meanwhile, so that the file is longer than its
            # size was; and without SWMR mode if this process has opened it without.
            for _ in range(3 if grows else 0):
                try:
                    file = h5py.File(path, "r", swmr=written, **lock)
                    break
                except OSError:
                    time.sleep(0.001)
            else:
                file = h5py.File(path, "r", **lock)
        try:
            return file, _datasets(file) if grows else []
        except BaseException:
            file.close()
            raise
    except (OSError, RuntimeError, KeyError) as error:
        number = getattr(error, "errno", None)
        reason = os.strerror(number) if number else str(error)
        raise IoError(f"{path}: cannot be read: {reason}") from error


def _datasets(file: h5py.File) -> list[h5py.Dataset]:
    """All datasets of a file that grows, which keep their numbers of rows while they are open. When
    one that was closed is opened again, HDF5 reads again only what has left its cache: a new number
    of rows with an old index of chunks gives rows of zeros. The numbers of complete rows come
    first, even before the others are listed: all else has as many rows by then, or more."""
    held = [file[name] for name in ("particles/needles/position/step", "series/step",
                                     "velocities_set/step", "user_data/step", "events/time")
            if name in file]
    names: list[str] = []
    file.visit(names.append)
    return held + [item for item in map(file.__getitem__, names) if hasattr(item, "shape")]


def _locks(path: str) -> tuple[bool, bool]:
    """Whether a run has the file open, as far as locks show that, and whether there are locks. In
    the first case, and only then, it is read in SWMR mode (single writer, multiple readers), in
    which HDF5 takes endless time to refuse a damaged file."""
    lock = struct.Struct("hhqqi4x")  # type, whence, start, length and process of struct flock
    with open(path, "rb") as file:
        if os.environ.get("HDF5_USE_FILE_LOCKING") in ("FALSE", "0"):
            return False, False
        try:
            found = fcntl.fcntl(file, fcntl.F_GETLK, lock.pack(fcntl.F_RDLCK, os.SEEK_SET, 0, 0, 0))
            written = lock.unpack(found)[0] != fcntl.F_UNLCK
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:  # another program writes it
            return written, True
        except OSError:  # a file system without locks
            return False, False
    return written, True
