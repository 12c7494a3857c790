"""The runs that the figures are made of: sets of points, each with one run per seed.

A set such as "dense" is the grid of a sweep, profiles/paper/SIZE/dense.toml, and lies in the
folder FOLDER/runs/dense, which `needlework sweep` fills. Nothing here starts a run; see sweeps.py.
"""

from __future__ import annotations

import copy
import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..reading import Recording, Series
from .toml_files import read_toml

PAPER = Path(__file__).parent / "paper"
"""Scenes, grids and claims, which the build copies from profiles/paper."""


@dataclass(frozen=True)
class Conditions:
    """What a run starts from, in units of the length L and the mass m of a needle."""

    count: int
    """Number of needles N."""
    box: np.ndarray
    """Edges of the box, [3] [L]."""
    k: float
    """m L^2 / (2 I)."""
    epsilon: float
    """Normal restitution."""
    beta: float
    """Tangential restitution, -1 for smooth needles."""
    t_tr: float
    """Translational temperature at the start."""
    t_rot: float
    """Rotational temperature at the start."""
    tc_relative: float | None
    """Contact time in mean free times."""
    cells: tuple[int, int, int] | None
    """Cells of the fields along each axis; None where the scene leaves them open."""
    scene: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)
    """All that the scene says, for what is not above: walls, gravity, driving."""

    @classmethod
    def of(cls, scene: dict[str, Any]) -> Conditions:
        """Those of a scene, with the defaults of keys that are not there."""
        needles, initial = scene["needles"], scene.get("initial", {})
        collisions = scene.get("collisions", {})
        grid = scene.get("output", {}).get("grid")
        bodies = scene.get("species", [needles])
        return cls(count=sum(int(each["count"]) for each in bodies),
                   box=np.broadcast_to(np.asarray(needles["box"], dtype=float), 3).copy(),
                   k=float(needles.get("k", 6.0)),
                   epsilon=float(collisions.get("epsilon", 1.0)),
                   beta=float(collisions.get("beta", -1.0)),
                   t_tr=float(initial.get("t_tr", 1.0)), t_rot=float(initial.get("t_rot", 1.0)),
                   tc_relative=collisions.get("tc_relative"),
                   cells=None if grid is None else tuple(np.broadcast_to(grid, 3).tolist()),
                   scene=scene)

    @property
    def density(self) -> float:
        """Number density n [1 / L^3]."""
        return self.count / float(np.prod(self.box))

    @property
    def needles_per_cell(self) -> float:
        """Mean number of needles in a cell of the fields."""
        return self.count / float(np.prod(self.cells))

    @property
    def start(self) -> str:
        """What tells the starts of the dense gas apart, as variants of claims name it."""
        return f"k = {self.k:g}, T_rot(0) = {self.t_rot:g}"


@dataclass(frozen=True)
class FinishedRun:
    """A run that is complete. What it has recorded is read when it is asked for."""

    path: Path
    seed: int
    conditions: Conditions = field(repr=False)

    @cached_property
    def series(self) -> Series:
        """Sums over all needles at the samples."""
        with Recording(self.path) as recording:
            return recording.series

    def observable(self, name: str, field: str) -> np.ndarray:
        """A field of an observable, one row for each sample of the series, or a constant."""
        with Recording(self.path) as recording:
            fields = recording.observable(name)
        if field not in fields:
            raise InputError(f"{self.path}: /series/{name}/{field} is missing: expected one of "
                             f"{', '.join(fields)}")
        return fields[field]

    @cached_property
    def collisions(self) -> np.ndarray:
        """Collisions per needle, 2 collisions / N, at the samples. A collision counts for both
        needles."""
        return 2 * self.series.collisions / self.conditions.count

    @cached_property
    def tau(self) -> np.ndarray:
        """Scaled times of the samples, gamma sqrt(T_tr(0)) t with gamma = (2/3) sqrt(pi) n."""
        gamma = 2 / 3 * np.sqrt(np.pi) * self.conditions.density
        return gamma * np.sqrt(self.conditions.t_tr) * self.series.time

    @cached_property
    def energy(self) -> np.ndarray:
        """Energy per needle over T_tr(0) at the samples."""
        return self.series.energy / self.conditions.t_tr

    def sample_near(self, collisions: float) -> int:
        """The sample nearest to so many collisions per needle."""
        return int(np.argmin(np.abs(self.collisions - collisions)))


@dataclass
class Point:
    """Finished runs that differ in their seeds only."""

    conditions: Conditions
    runs: list[FinishedRun]

    @property
    def first(self) -> FinishedRun:
        """That of the first seed, which pictures of one run show."""
        return self.runs[0]

    @property
    def seeds(self) -> int:
        """How many runs there are."""
        return len(self.runs)

    def values(self, number: Callable[[FinishedRun], float]) -> list[float]:
        """A number of each run."""
        return [number(run) for run in self.runs]


class PaperRuns:
    """The sets of runs in a folder, in one of two sizes: "full", all that the paper shows, and
    "quick", which takes some minutes.

    ``paper`` is the folder of scenes, grids and claims, which may be one's own.
    """

    def __init__(self, folder: str | Path, size: str, paper: Path = PAPER) -> None:
        self.folder = Path(folder)
        self.size = size
        self.paper = Path(paper)

    def grid(self, name: str) -> Path:
        """The grid of a set, which `needlework sweep` takes."""
        return self.paper / self.size / f"{name}.toml"

    def folder_of(self, name: str) -> Path:
        """The folder of a set."""
        return self.folder / "runs" / name

    def has(self, name: str) -> bool:
        """Whether there is such a set in this size."""
        return self.grid(name).is_file()

    def points(self, name: str) -> list[Point]:
        """The points of a set in the order of its grid, with those of their runs that are
        finished, in the order of their seeds."""
        runs = sorted(_runs_in(self.folder_of(name)), key=lambda run: run["seed"])
        points = []
        for values, conditions in at_points(self.grid(name)):
            found = [FinishedRun(run["path"], int(run["seed"]), conditions) for run in runs
                     if _is_of(run, values)]
            if not found:
                at = ", ".join(f"{key} = {value}" for key, value in values.items())
                raise InputError(f"{self.folder_of(name)}: expected finished runs of all points "
                                 f"of {self.grid(name)}: there are none with {at}")
            points.append(Point(conditions, found))
        return points


def at_points(file: Path) -> Iterator[tuple[dict[str, Any], Conditions]]:
    """What is varied, by key, and the conditions at the points of a grid."""
    grid = read_toml(file)
    base = read_toml(file.parent / grid["scene"])
    for values in _points_of(grid.get("parameters", {})):
        yield values, Conditions.of(_overridden(base, values))


def seeds_of(grid: dict[str, Any]) -> list[int]:
    """The seeds of a grid."""
    seeds = grid["seeds"]
    if isinstance(seeds, dict):
        return list(range(seeds["first"], seeds["first"] + seeds["count"]))
    return list(seeds)


def _runs_in(folder: Path) -> list[dict[str, Any]]:
    """The finished members of a sweep: path, seed, and the values in their names, such as
    "k=6,t_rot=1,seed=3.h5"."""
    runs = []
    for path in sorted(folder.glob("*seed=*.h5")):
        if not path.name.endswith(".failed.h5"):
            named = (part.partition("=") for part in path.stem.split(","))
            runs.append({"path": path} | {key: _number_in(value) for key, _, value in named})
    return runs


def _number_in(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text


def _is_of(run: dict[str, Any], values: dict[str, Any]) -> bool:
    """Whether a run has these values; a key that does not vary is not in its name."""
    named = ((key.partition(".")[2], value) for key, value in values.items())
    return all(run.get(name, value) in (value, _text_in_name(value)) for name, value in named)


def _text_in_name(value: Any) -> str:
    """A truth value or an array as names of runs have it: true is true, [8, 8, 2.5] is 8-8-2.5."""
    if isinstance(value, bool):
        return str(value).lower()
    parts = value if isinstance(value, list) else [value]
    return "-".join(str(part).removesuffix(".0") for part in parts)


def _points_of(parameters: dict[str, Any]) -> list[dict[str, Any]]:
    """Values by key at the points of a grid; the last parameter varies fastest."""
    varied = [value if isinstance(value, list) else [value] for value in parameters.values()]
    return [dict(zip(parameters, values)) for values in itertools.product(*varied)]


def _overridden(scene: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """The scene with other values. A key goes through tables, "driving.kicks.every", and names a
    wall by axis and side, "walls.z-low.epsilon", and a species by its name, "species.a.count"."""
    scene = copy.deepcopy(scene)
    for key, value in values.items():
        *path, name = key.split(".")
        table: Any = scene
        for part in path:
            if isinstance(table, list):
                table = next(each for each in table if _name_of(each) == part)
            else:
                table = table.setdefault(part, {})
        table[name] = value
    return scene


def _name_of(entry: dict[str, Any]) -> str:
    """Of an entry of an array of tables, a species or a wall."""
    return entry.get("name") or f"{entry['axis']}-{entry['side']}"
