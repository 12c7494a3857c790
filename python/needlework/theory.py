"""Kinetic theory of the homogeneous needle gas, for needles of length 1 and mass 1, and of mixtures.

Rates are exact for Gaussian velocities. The cooling curve assumes that the gas stays Gaussian and
homogeneous (Huthmann, Aspelmeier, Zippelius, Phys. Rev. E 60, 654). Numbers out of range raise
InputError.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from .arrays import numbers, whole_numbers
from .errors import InputError
from .values import Table, Values

__all__ = ["CoolingCurve", "Diffusion", "MixtureCurve", "MixtureRates", "collision_rate", "cooling",
           "diffusion", "equilibrium_rate", "equipartition_k", "factor_between_walls",
           "mixture_cooling", "mixture_rates", "ratio", "tau"]


class CoolingCurve(Table):
    """Temperatures of a cooling gas, arrays [M]."""

    tau: np.ndarray
    """Scaled times, see tau()."""
    t_tr: np.ndarray
    """Translational temperature, two thirds of the mean energy of translation."""
    t_rot: np.ndarray
    """Rotational temperature, the mean energy of rotation per two degrees of freedom."""
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


def equilibrium_rate(k: ArrayLike, count: ArrayLike, volume: ArrayLike, energy: ArrayLike,
                     conserved: ArrayLike = 3) -> np.ndarray:
    """Collision rate of one needle in elastic equilibrium, exact for a finite gas [1 / time].

    For ``count`` needles (at least 2) without total momentum, of the total energy ``energy``, in a
    box of the volume ``volume`` [L^3]. ``conserved`` is the number of periodic axes, along which
    the momentum stays 0. With walls along one axis it is 2, and the rate is to be multiplied by
    factor_between_walls(). Arguments are broadcast.
    """
    return _core.equilibrium_rate(k, count, volume, _not_negative("energy", energy),
                                  whole_numbers("conserved", conserved, np.shape(conserved), 0, 3))


def factor_between_walls(k: ArrayLike, gap: ArrayLike, t_tr: ArrayLike = 1.0,
                         t_rot: ArrayLike = 1.0) -> np.ndarray:
    """Rate of collisions between two walls, over that in a periodic box of the same volume.

    For walls along one axis, ``gap`` [L] from each other, at least 1, and for needles of which
    nothing is known but that both tips are inside: in elastic equilibrium and in a drawn state.
    Exact to 1e-6. Arguments are broadcast.
    """
    return _core.factor_between_walls(k, gap, t_tr, t_rot)


class Diffusion(Values):
    """Of smooth elastic needles whose successive collisions are not correlated (Enskog)."""

    velocity_decay: np.ndarray
    """-d ln <v(0).v(t)> / dt at t = 0 [1 / time]; exact at every density."""
    angular_velocity_decay: np.ndarray
    """-d ln <w(0).w(t)> / dt at t = 0 [1 / time]; exact at every density."""
    d: np.ndarray
    """Diffusion constant of a centre, (T/m) / velocity_decay [L^2 / time]."""
    d_rot: np.ndarray
    """Diffusion constant of a director, (T/I) / angular_velocity_decay [1 / time]."""


def diffusion(k: ArrayLike, n: ArrayLike, t: ArrayLike = 1.0) -> Diffusion:
    """Diffusion of needles at number density n [1 / L^3] and temperature t, as far as kinetic
    theory without correlations gives it. Arguments are broadcast."""
    columns = np.broadcast_arrays(np.asarray(k, dtype=float), _not_negative("n", n),
                                  np.asarray(t, dtype=float))
    shape = columns[0].shape
    out = _core.diffusion(*(np.ascontiguousarray(column).ravel() for column in columns))
    return Diffusion({name: column.reshape(shape) for name, column in zip(
        ("velocity_decay", "angular_velocity_decay", "d", "d_rot"), out)})


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


class MixtureRates(Values):
    """What happens in a mixture at one instant."""

    collisions: np.ndarray
    """Of needles of each two species per unit of time, [species, species], symmetric [1 / time]."""
    t_tr: np.ndarray
    """Derivative of the translational temperature of each species, [species] [energy / time]."""
    t_rot: np.ndarray
    """Derivative of the rotational temperature of each species, [species] [energy / time]."""


class MixtureCurve(Table):
    """Temperatures of each species of a mixture, arrays [M, species]."""

    time: np.ndarray
    """Times, [M]."""
    t_tr: np.ndarray
    """Translational temperature of each species, [M, species]."""
    t_rot: np.ndarray
    """Rotational temperature of each species, [M, species]."""
    energy: np.ndarray
    """Energy per needle of all species together, [M]."""


def mixture_rates(gas: Mapping[str, Any], t_tr: ArrayLike, t_rot: ArrayLike) -> MixtureRates:
    """Rates of a mixture of these temperatures, [species] each, in the units of the mixture.

    Exact for Gaussian velocities, at every density.

    Parameters
    ----------
    gas : what ``Simulation.gas`` has, or a dictionary with box ([3]) and, by species, counts,
        length, mass and k ([species]); epsilon and beta of each two ([species, species]). One
        number stands for all, and length = 1, mass = 1, k = 6, epsilon = 1 and beta = -1 for what
        is not given. With a diameter they are rods of finite width, homogeneous where k is not
        given, for which this is exact at low density; with length = 0 spheres. Those that beta
        makes rough have q = 4 I / (m D^2) of their moment of inertia I, at most 2/3; without it,
        or with 0, they are homogeneous, q = 2/5. Bodies that differ within a species, and fixed
        ones, are refused.
    """
    given, size = _mixture(gas)
    collisions, d_tr, d_rot = _core.mixture_rates(*given, _each("t_tr", t_tr, size),
                                                  _each("t_rot", t_rot, size))
    return MixtureRates({"collisions": collisions, "t_tr": d_tr, "t_rot": d_rot})


def mixture_cooling(gas: Mapping[str, Any], t_tr0: ArrayLike, t_rot0: ArrayLike,
                    time: ArrayLike) -> MixtureCurve:
    """Temperatures of each species of a mixture at these times, from those at time 0.

    Assumes that the mixture stays homogeneous and Gaussian. ``gas`` is that of mixture_rates(),
    ``time`` an array [M], finite and not negative, in any order.
    """
    given, size = _mixture(gas)
    times = np.atleast_1d(numbers("time", time)).reshape(-1)
    t_tr, t_rot, energy = _core.mixture_cooling(*given, _each("t_tr0", t_tr0, size),
                                                _each("t_rot0", t_rot0, size), times)
    return MixtureCurve({"time": times, "t_tr": t_tr, "t_rot": t_rot, "energy": energy})


def equipartition_k() -> float:
    """The k at which both temperatures of a smooth cooling gas become equal, for every epsilon."""
    return _core.equipartition_k()


def homogeneous_k(length: ArrayLike, diameter: ArrayLike) -> np.ndarray:
    """k = m L^2 / (2 I) of homogeneous rods with spherical caps, 6 for needles; that of spheres
    means nothing, and is 6 as well."""
    length, width = np.broadcast_arrays(_not_negative("length", length),
                                        _not_negative("diameter", diameter))
    # Times 3 L + 2 D.
    inertia = length**3 / 4 + width * length**2 / 2 + 9 / 16 * width**2 * length + width**3 / 5
    turns = (length > 0) & (width > 0)
    return np.where(turns, length**2 * (3 * length + 2 * width)
                    / np.where(turns, 2 * inertia, 1), 6.0)


def _mixture(gas: Mapping[str, Any]) -> tuple[tuple[Any, ...], int]:
    """What _core takes of a mixture, up to its volume, and the number of species."""
    if gas.get("differ", False):
        raise InputError("gas: bodies that differ within a species: expected alike ones; "
                         "`needlework theory` has the rates of others")
    if np.any(np.isinf(numbers("mass", gas.get("mass", 1.0)))):
        raise InputError("gas: fixed bodies: expected finite masses; `needlework theory` has the "
                         "rates of those that move")
    counts = np.atleast_1d(numbers("counts", gas["counts"] if "counts" in gas else gas["count"]))
    size = counts.size
    if counts.ndim != 1 or size == 0:
        raise InputError(f"counts: shape {counts.shape}: expected one number for each species")
    counts = whole_numbers("counts", counts, (size,), 0, 2**32 - 2).astype(float)
    diameter = _each("diameter", gas.get("diameter", 0.0), size)
    length = _each("length", gas.get("length", 1.0), size)
    if not np.all(length + diameter > 0):
        raise InputError("length = 0: expected numbers > 0, or a diameter > 0")
    mass, k = (_each(name, gas.get(name, usual), size, positive=True)
               for name, usual in (("mass", 1.0), ("k", homogeneous_k(length, diameter))))
    q = _each("q", gas.get("q", 0.0), size)
    wrong = q[(q != 0) & ~((q >= 1e-9) & (q <= 2 / 3 * (1 + 1e-12)))]
    if wrong.size:
        raise InputError(f"q = {wrong[0]:g}: expected a number from 1e-9 to 2/3, at which all mass "
                         "is at the surface, or 0 for homogeneous spheres")
    epsilon, beta, meet = (_each_two(name, gas.get(name, usual), size, least)
                           for name, usual, least in (("epsilon", 1.0, 0.0), ("beta", -1.0, -1.0),
                                                      ("meet", 1.0, 0.0)))
    box = numbers("box", gas["box"])
    if box.shape not in ((), (3,)) or not np.all(np.isfinite(box) & (box > 0)):
        raise InputError(f"box = {box}: expected one or three edges > 0")
    volume = float(np.prod(np.broadcast_to(box, 3)))
    return (counts, length, mass, k, diameter, q, epsilon, beta, meet, volume), size


def _each(name: str, values: ArrayLike, size: int, positive: bool = False) -> np.ndarray:
    """One number for each species."""
    array = _not_negative(name, values)
    if array.shape not in ((), (size,)):
        raise InputError(f"{name}: shape {array.shape}: expected ({size},), by species")
    if positive and not np.all(array > 0):
        raise InputError(f"{name} = {array.min():g}: expected numbers > 0")
    return np.array(np.broadcast_to(array, size))


def _each_two(name: str, values: ArrayLike, size: int, least: float) -> np.ndarray:
    """One number for each two species, whatever their order."""
    array = numbers(name, values)
    if array.shape not in ((), (size, size)) or not np.array_equal(array, array.T):
        raise InputError(f"{name}: shape {array.shape}: expected a number, or a symmetric array "
                         f"({size}, {size})")
    wrong = array[~((array >= least) & (array <= 1))]
    if wrong.size:
        raise InputError(f"{name} = {wrong[0]:g}: expected a number from {least:g} to 1")
    return np.array(np.broadcast_to(array, (size, size)))


def _not_negative(name: str, values: ArrayLike) -> np.ndarray:
    """Checks what the library calls by another name than the argument here."""
    array = numbers(name, values)
    wrong = array[~(np.isfinite(array) & (array >= 0))]
    if wrong.size:
        raise InputError(f"{name} = {wrong[0]:g}: expected a finite number, 0 or more")
    return array
