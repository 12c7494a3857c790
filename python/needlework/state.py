"""The needles at one instant, by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, KeysView, Mapping, Sequence
from typing import Any

import numpy as np

from .values import Table, Values

ARRAYS = ("position", "velocity", "orientation", "angular_velocity", "image", "id", "species")
NUMBERS_OF_BODIES = ("length", "diameter", "mass", "k", "inertia")
OWN_NUMBERS = ("length", "diameter", "mass", "inertia")
"""Arrays of a state whose bodies differ within a species."""


def read_only(values: np.ndarray) -> np.ndarray:
    """The same array, which nobody can write to any more."""
    values.flags.writeable = False
    return values


class Bodies(Table):
    """What is known of the bodies of a state, one row for each species. What is not known is
    missing: name of a single species, or all of it in files of other programs."""

    name: tuple[str, ...]
    """Names of the species."""
    length: np.ndarray
    """Lengths of the axes, without caps, [species] [L]."""
    diameter: np.ndarray
    """Diameters, 0 of thin needles, [species] [L]."""
    mass: np.ndarray
    """Masses, infinite of fixed bodies, [species] [m]."""
    k: np.ndarray
    """k = m L^2 / (2 I), which says nothing of spheres, [species]."""
    inertia: np.ndarray
    """Moments of inertia, 0 of smooth spheres, infinite of fixed bodies that turn,
    [species] [m L^2]."""

    @classmethod
    def of(cls, columns: Mapping[str, Iterable]) -> Bodies:
        """The bodies of these columns, without those that are empty."""
        return cls({name: tuple(column) if name == "name" else read_only(np.array(column, dtype=float))
                    for name, column in columns.items() if len(column)})

    def grown(self, scale: float) -> Bodies:
        """The same with sizes larger by this factor; masses and moments of inertia stay."""
        powers = {"length": 1, "diameter": 1, "k": 2}
        return Bodies({name: read_only(column * scale**powers[name]) if name in powers else column
                       for name, column in self.items()})


class State(Table):
    """All needles at one instant, in order of id: what Simulation(scene, **state) starts from."""

    position: np.ndarray
    """Centres in the box, [N, 3] [L]."""
    velocity: np.ndarray
    """Velocities of the centres, [N, 3] [L / time]."""
    orientation: np.ndarray
    """Unit directors, [N, 3]."""
    angular_velocity: np.ndarray
    """Angular velocities, normal to the directors, [N, 3] [1 / time]."""
    image: np.ndarray
    """Number of box edges to add to each centre to follow its path, [N, 3]."""
    id: np.ndarray
    """Ids of the needles, [N]."""
    species: np.ndarray
    """Index of the species of each needle, from 0 in the order of the scene, [N]."""
    bodies: Bodies
    """What the species are made of now, which another scene must not contradict; means where
    their bodies differ."""
    # Where walls with a velocity move edges of the box:
    box: np.ndarray
    """Its edges, [3] [L]."""
    low: np.ndarray
    """Where its low edges are, [3] [L]; a simulation that starts moves them to 0."""
    # Under uniform shear:
    flow: Mapping[str, float]
    """slide, of the row of boxes above [L], and shear_rate [1 / time]."""
    # Where bodies of a species differ:
    length: np.ndarray
    """Lengths of the axes, [N] [L]."""
    diameter: np.ndarray
    """Diameters, [N] [L]."""
    mass: np.ndarray
    """Masses, infinite of fixed needles, [N] [m]."""
    inertia: np.ndarray
    """Moments of inertia about axes normal to the director, 0 of smooth spheres, [N] [m L^2]."""

    @classmethod
    def of(cls, arrays: Iterable[np.ndarray], bodies: Bodies, flow: Sequence[Any] | None = None,
           own: Mapping[str, np.ndarray] | None = None,
           edges: tuple[np.ndarray, np.ndarray] | None = None) -> State:
        """The state of these arrays, in the order of ARRAYS; `flow` under uniform shear: slide, rate;
        `own` where bodies of a species differ: arrays of OWN_NUMBERS; `edges` where walls with a
        velocity move them: box, low."""
        values = {**dict(zip(ARRAYS, arrays)), **(own or {}), "bodies": bodies}
        if flow is not None:
            values["flow"] = Values({"slide": flow[0], "shear_rate": flow[1]})
        if edges is not None:
            values["box"], values["low"] = edges
        return cls(values)

    def numbers(self, name: str) -> np.ndarray:
        """One of OWN_NUMBERS of each needle, its own or that of its species, [N]; not a number where
        that is not known."""
        if name in self._values:
            return self._values[name]
        bodies = self._values["bodies"]
        if name != "inertia" or "inertia" in bodies:
            known = np.asarray(bodies.get(name, np.nan), dtype=float)
        elif {"length", "mass", "k"} <= set(bodies):
            turns = bodies["length"] > 0
            shape = np.where(turns, bodies["mass"], 0) * bodies["length"]**2
            known = np.divide(shape, 2 * bodies["k"], out=np.zeros_like(shape), where=turns)
        else:
            known = np.asarray(np.nan)
        return read_only(np.broadcast_to(known, max(known.size, 1))[self._values["species"]])

    # The items are the arrays, one row for each needle. keys() names the bodies, too, so that
    # ``**state`` hands them over.

    def __iter__(self) -> Iterator[str]:
        return iter([*ARRAYS, *(name for name in OWN_NUMBERS if name in self._values)])

    def __len__(self) -> int:
        return len(list(iter(self)))

    def keys(self) -> KeysView[str]:
        return self._values.keys()

    @property
    def columns(self) -> Mapping[str, Any]:
        return dict(self.items())
