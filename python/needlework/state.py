"""The needles at one instant, by name."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from .values import Table

ARRAYS = ("position", "velocity", "orientation", "angular_velocity", "image", "id", "species")


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

    @classmethod
    def of(cls, arrays: Iterable[np.ndarray]) -> State:
        """The state of these arrays, in the order of ARRAYS."""
        return cls(dict(zip(ARRAYS, arrays)))
