"""Kinetic theory of the homogeneous needle gas, for needles of length 1 and mass 1.

Rates are exact for Gaussian velocities. The cooling curve assumes that the gas stays Gaussian and
homogeneous (Huthmann, Aspelmeier, Zippelius, Phys. Rev. E 60, 654). Numbers out of range raise
InputError.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import numbers
from .errors import InputError
from .values import Table

__all__ = ["CoolingCurve", "collision_rate", "cooling", "equilibrium_rate", "equipartition_k",
           "ratio", "tau"]


class CoolingCurve(Table):
    """Temperatures of a cooling gas, arrays [M]."""

    tau: np.ndarray
    """Scaled times, see tau()."""
    t_tr: np.ndarray
    """Translational temperature, two thirds of the mean energy of translation."""
    t_rot: np.ndarray
    """Rotational temperature, the mean energy of rotation."""
    energy: np.ndarray
    """Energy of a needle, 3/2 t_tr + t_rot."""
    collisions_per_needle: np.ndarray
    """Collisions that a needle has taken part in since tau = 0."""


def tau(time: ArrayLike, n: ArrayLike) -> np.ndarray:
    """Scaled time (2/3) sqrt(pi) n time, for needles at number density n [1 / L^3]."""
    return 2 / 3 * np.sqrt(np.pi) * numbers("n", n) * numbers("time", time)


def collision_rate(k: ArrayLike, n: ArrayLike, t_tr: ArrayLike = 1.0,
                   t_rot: ArrayLike = 1.0) -> np.ndarray:
    """Collisions that one needle takes part in per unit of time [1 / time].

    Exact for Gaussian velocities at every density. Arguments are broadcast.

    Parameters
    ----------
    k : m L^2 / (2 I), 6 for a uniform rod.
    n : number density [1 / L^3].
    t_tr, t_rot : translational and rotational temperature.
    """
    return _core.collision_rate(k, _not_negative("n", n), t_tr, t_rot)


def equilibrium_rate(k: ArrayLike, count: ArrayLike, volume: ArrayLike,
                     energy: ArrayLike) -> np.ndarray:
    """Collision rate of one needle in elastic equilibrium, exact for a finite gas [1 / time].

    For ``count`` needles (at least 2) without total momentum, of the total energy ``energy``, in a
    box of the volume ``volume`` [L^3]. Arguments are broadcast.
    """
    return _core.equilibrium_rate(k, count, volume, _not_negative("energy", energy))


def ratio(epsilon: ArrayLike, k: ArrayLike, beta: ArrayLike = -1.0) -> np.ndarray:
    """Ratio T_tr / T_rot that a cooling gas tends to; NaN for an elastic gas.

    Arguments are broadcast: normal restitution epsilon in [0, 1], k = m L^2 / (2 I), and
    tangential restitution beta in [-1, 1], of which -1 is smooth.
    """
    return _core.ratio(epsilon, k, beta)


def cooling(epsilon: float, k: float, beta: float = -1.0, t_rot0: float = 1.0,
            tau: ArrayLike = (), t_tr0: float = 1.0) -> CoolingCurve:
    """Cooling curve: the temperatures at the scaled times ``tau``.

    Parameters
    ----------
    epsilon, k, beta : as in ratio().
    t_rot0, t_tr0 : temperatures at tau = 0.
    tau : array [M] of scaled times, finite and not negative, in any order; see tau().

    Returns
    -------
    CoolingCurve
        Arrays tau, t_tr, t_rot, energy and collisions_per_needle, [M] each.
    """
    taus = np.atleast_1d(numbers("tau", tau))
    t_tr, t_rot, collisions = _core.cooling(epsilon, k, beta, t_tr0, t_rot0, taus.reshape(-1))
    columns = {"tau": taus, "t_tr": t_tr, "t_rot": t_rot, "energy": 1.5 * t_tr + t_rot,
               "collisions_per_needle": collisions}
    return CoolingCurve({name: column.reshape(taus.shape) for name, column in columns.items()})


def equipartition_k() -> float:
    """The k at which both temperatures of a smooth cooling gas become equal, for every epsilon."""
    return _core.equipartition_k()


def _not_negative(name: str, values: ArrayLike) -> np.ndarray:
    """Checks what the library calls by another name than the argument here."""
    array = numbers(name, values)
    wrong = array[~(np.isfinite(array) & (array >= 0))]
    if wrong.size:
        raise InputError(f"{name} = {wrong[0]:g}: expected a finite number, 0 or more")
    return array
