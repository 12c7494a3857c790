"""Means over samples at equal phase of a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .errors import InputError
from .values import Values

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def mean_by_phase(phase: np.ndarray, values: ArrayLike, bins: int, weights: ArrayLike | None,
                  counted: np.ndarray) -> Values:
    """See Recording.by_phase(). ``phase`` [S] is in radians, and ``counted`` [S] says which of the
    samples count."""
    values = np.asarray(values, dtype=float)
    if values.shape[:1] != phase.shape:
        raise InputError(f"by_phase(): values of shape {values.shape}: expected {len(phase)} rows, "
                         "one for each sample")
    if bins < 1:
        raise InputError(f"by_phase(): bins = {bins}: expected 1 or more")
    weights = np.asarray(1 if weights is None else weights, dtype=float)
    if weights.shape == phase.shape:
        weights = weights.reshape(-1, *(1 for _ in values.shape[1:]))
    try:
        weights = np.where(np.isnan(values), 0, np.broadcast_to(weights, values.shape))
    except ValueError:
        raise InputError(f"by_phase(): weights of shape {weights.shape}: expected {phase.shape} or "
                         f"{values.shape}") from None
    terms = np.where(weights == 0, 0, values) * weights
    # Bins are centred, so that rounding moves no sample that is due at a multiple.
    place = np.rint(phase * (bins / (2 * np.pi))).astype(int) % bins
    total, weight = np.zeros((2, bins, *values.shape[1:]))
    np.add.at(total, place[counted], terms[counted])
    np.add.at(weight, place[counted], weights[counted])
    with np.errstate(invalid="ignore"):
        mean = total / weight
    return Values({"phase": np.arange(bins) * (2 * np.pi / bins), "mean": mean,
                   "samples": np.bincount(place[counted], minlength=bins)})
