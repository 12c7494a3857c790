"""Nematic order and its direction from the tensors that files hold."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .arrays import numbers
from .errors import InputError
from .values import Values


class NematicOrder(Values):
    """Of each tensor, arrays [...]; NaN where the tensor has NaN, as in a slab without needles."""

    order: np.ndarray
    """The largest eigenvalue: 1 for parallel directors, 0 for random ones, of the order 1/sqrt(n)
    for n of these."""
    director: np.ndarray
    """Its eigenvector, [..., 3], of either sign."""
    eigenvalues: np.ndarray
    """All three, [..., 3], the largest first. Directors in a plane, and random there, have 1/4,
    1/4 and -1/2."""


def nematic_order(tensor: ArrayLike) -> NematicOrder:
    """Order and director of tensors <(3 u u - 1) / 2>, [..., 3, 3].

    Those are ``order_tensor`` of the observables alignment, of all needles, and wall_profiles, in
    each slab. A mean over samples is to be taken of the tensors, weighted by the number of needles,
    as the order of few needles is never 0.
    """
    tensor = numbers("tensor", tensor)
    if tensor.shape[-2:] != (3, 3):
        raise InputError(f"tensor: shape {tensor.shape}: expected (..., 3, 3)")
    known = np.isfinite(tensor).all(axis=(-2, -1))
    values, vectors = np.linalg.eigh(np.where(known[..., None, None], tensor, 0))
    values = np.where(known[..., None], values[..., ::-1], np.nan)
    director = np.where(known[..., None], vectors[..., -1], np.nan)
    return NematicOrder({"order": values[..., 0], "director": director, "eigenvalues": values})
