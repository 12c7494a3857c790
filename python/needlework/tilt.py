"""Sheared boxes as cells with a tilt xy along x, of which the slide of a state is one.

A whole number of edges may be added to a tilt: the lattice stays the same, and boxes are counted
otherwise.
"""

from __future__ import annotations

import math

import numpy as np

__all__ = ["counted", "reduced_tilt"]


def reduced_tilt(tilt: float, edge: float, low: float = 0.0) -> tuple[float, int]:
    """A tilt less so many edges, from low to below low + edge [L], and their number."""
    edges = math.floor((tilt - low) / edge)
    rest = tilt - edges * edge
    if rest >= low + edge:  # so little below low that rounding reaches it
        return low, edges + 1
    return rest, edges


def counted(image: np.ndarray, edges: int) -> np.ndarray:
    """Boxes that were counted for a tilt, as they are for one of so many edges less."""
    return (image + edges * np.outer(image[:, 1], [1, 0, 0])).astype(np.int32)
