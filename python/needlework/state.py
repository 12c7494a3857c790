"""The needles at one instant, by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, KeysView, Mapping, Sequence
from typing import Any

import numpy as np

from .values import Table

ARRAYS = ("position", "velocity", "orientation", "angular_velocity", "image", "id", "species")
NUMBERS_OF_BODIES = ("length", "diameter", "mass", "k")


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
    """Masses, [species] [m]."""
    k: np.ndarray
    """k = m L^2 / (2 I), [species]."""

    @classmethod
    def of(cls, columns: Mapping[str, Iterable]) -> Bodies:
        """The bodies of these columns, without those that are empty."""
        return cls({name: tuple(column) if name == "name" else np.array(column, dtype=float)
                    for name, column in columns.items() if len(column)})


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
    """What the species are made of, which another scene must not contradict."""

    @classmethod
    def of(cls, arrays: Iterable[np.ndarray], bodies: Bodies,
           flow: Sequence[Any] | None = None) -> State:
        """The state of these arrays, in the order of ARRAYS; `flow` under uniform shear: slide, rate."""
        values = {**dict(zip(ARRAYS, arrays)), "bodies": bodies}
        if flow is not None:
            values["flow"] = {"slide": flow[0], "shear_rate": flow[1]}
        return cls(values)

    # The items are the arrays, one row for each needle. keys() names the bodies, too, so that
    # ``**state`` hands them over.

    def __iter__(self) -> Iterator[str]:
        return iter(ARRAYS)

    def __len__(self) -> int:
        return len(ARRAYS)

    def keys(self) -> KeysView[str]:
        return self._values.keys()

    @property
    def columns(self) -> Mapping[str, Any]:
        return dict(self.items())
