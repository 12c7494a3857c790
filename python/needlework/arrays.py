"""Checks of the arrays that users pass."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .errors import InputError


def numbers(name: str, values: ArrayLike) -> np.ndarray:
    """The values in double precision."""
    if np.ma.is_masked(values):
        raise InputError(f"{name}: expected an array without masked values")
    try:
        array = np.asarray(values)
        if array.dtype.kind in "cmM":
            raise TypeError(f"not {array.dtype}")
        return np.asarray(array, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{name}: expected an array of numbers: {error}") from None


def flags(name: str, values: ArrayLike) -> np.ndarray:
    """The values as True and False; the numbers 1 and 0 stand for them, too."""
    if np.ma.is_masked(values):
        raise InputError(f"{name}: expected an array without masked values")
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise InputError(f"{name}: expected an array of True and False: {error}") from None
    if array.dtype.kind == "b":
        return array
    if array.dtype.kind not in "iufO":
        raise InputError(f"{name}: {array.dtype}: expected an array of True and False")
    bad = ~np.asarray((array == 0) | (array == 1), dtype=bool)
    if bad.any():
        raise InputError(f"{name} = {array[bad].flat[0]!r}: expected True or False, or 1 or 0")
    return array.astype(bool)


def column(name: str, values: ArrayLike, count: int) -> np.ndarray:
    """The values in double precision, of shape [count]."""
    array = numbers(name, values)
    if array.shape != (count,):
        raise InputError(f"{name}: shape {array.shape}: expected ({count},)")
    return array


def whole_numbers(name: str, values: ArrayLike, shape: tuple[int, ...], least: int,
                  most: int) -> np.ndarray:
    """The values as whole numbers from least to most, of this shape."""
    array = numbers(name, values)  # whole numbers are exact up to 2^53
    if array.shape != shape:
        raise InputError(f"{name}: shape {array.shape}: expected {shape}")
    bad = ~((array >= least) & (array <= most) & (array == np.floor(array)))
    if bad.any():
        place = tuple(int(index) for index in np.argwhere(bad)[0])
        index = f"[{', '.join(map(str, place))}]" if place else ""
        raise InputError(f"{name}{index} = {np.asarray(values)[place]}: "
                         f"expected a whole number from {least} to {most}")
    return array.astype(np.int64)


def vectors(name: str, values: ArrayLike) -> np.ndarray:
    """The values in double precision, of any shape [..., 3]."""
    array = numbers(name, values)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InputError(f"{name}: shape {array.shape}: expected (..., 3)")
    return array


def rows_of_vectors(name: str, values: ArrayLike, count: int | None = None) -> np.ndarray:
    """The values in double precision, of shape [count, 3]; any count if that is None."""
    array = numbers(name, values)
    if array.ndim != 2 or array.shape[1] != 3 or count not in (None, len(array)):
        raise InputError(f"{name}: shape {array.shape}: "
                         f"expected ({'N' if count is None else count}, 3)")
    return array
