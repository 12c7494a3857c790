"""First contacts of pairs of needles."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import flags, numbers, vectors
from .errors import InputError


class FirstContacts(NamedTuple):
    """First contacts, one for each pair; ``time, s12, s21 = predict(...)``."""

    time: np.ndarray
    """Time of the first contact [time]; inf without one, 0 for a pair that has just collided and
    returns sooner than velocities in double precision resolve."""
    s12: np.ndarray
    """Distance of the contact from the centre of the first needle, along its director [L]; NaN
    without a contact."""
    s21: np.ndarray
    """The same on the second needle."""


def predict(r1: ArrayLike, u1: ArrayLike, v1: ArrayLike, w1: ArrayLike,
            r2: ArrayLike, u2: ArrayLike, v2: ArrayLike, w2: ArrayLike,
            horizon: ArrayLike, skip: ArrayLike = False,
            accuracy: str = "standard", *, length1: ArrayLike = 1.0, length2: ArrayLike = 1.0,
            diameter1: ArrayLike = 0.0, diameter2: ArrayLike = 0.0) -> FirstContacts:
    """First contact of each pair of needles, or of rods of finite width, within (0, horizon].

    They fly freely from time 0 on, without periodic images. All arguments are broadcast against
    each other, so that one pair or many pairs are equally simple.

    Parameters
    ----------
    r1, r2 : arrays [..., 3]
        Centres [L].
    u1, u2 : arrays [..., 3]
        Directors, of any length but 0.
    v1, v2 : arrays [..., 3]
        Velocities [L / time].
    w1, w2 : arrays [..., 3]
        Angular velocities [1 / time]; only the part normal to the director counts.
    horizon : array [...]
        Up to which time contacts are looked for [time].
    skip : array [...] of bool
        Whether the pair has collided at time 0; that contact is not found again.
    accuracy : "fast", "standard" or "rigorous"
        How reliable and precise the search is.
    length1, length2 : arrays [...]
        Lengths of the axes, without the caps of rods; 0 with a diameter: a sphere [L].
    diameter1, diameter2 : arrays [...]
        0 for needles. With diameters, rods meet when their axes are as near each other as half the
        sum of both; a needle and a rod never do, and are an error [L].

    Returns
    -------
    FirstContacts
        Arrays time, s12 and s21 of the shape that remains, [...].

    Raises
    ------
    InputError
        For a wrong shape, for rods that overlap, and for numbers that cannot be followed. Messages
        count pairs from 0.
    """
    named = {"r1": r1, "u1": u1, "v1": v1, "w1": w1, "r2": r2, "u2": u2, "v2": v2, "w2": w2}
    needles = {name: vectors(name, values) for name, values in named.items()}
    sizes = {name: numbers(name, values) for name, values in
             (("length1", length1), ("length2", length2),
              ("diameter1", diameter1), ("diameter2", diameter2), ("horizon", horizon))}
    skip = flags("skip", skip)
    if not isinstance(accuracy, str):
        raise InputError(f"accuracy = {accuracy!r}: "
                         "expected \"fast\", \"standard\" or \"rigorous\"")
    try:
        shape = np.broadcast_shapes(*(values.shape[:-1] for values in needles.values()),
                                    *(values.shape for values in sizes.values()), skip.shape)
    except ValueError:
        shapes = ", ".join(f"{name} {values.shape}" for name, values in
                           {**needles, **sizes, "skip": skip}.items())
        raise InputError(f"predict: {shapes}: expected shapes that can be broadcast") from None
    columns = [np.broadcast_to(values, (*shape, 3)).reshape(-1, 3) for values in needles.values()]
    numbered = [np.broadcast_to(values, shape).reshape(-1) for values in (*sizes.values(), skip)]
    return FirstContacts(*(column.reshape(shape)[()]
                           for column in _core.predict(*columns, *numbered, accuracy)))
