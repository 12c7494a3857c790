"""Pictures of runs, drawn with Matplotlib (python3-matplotlib).

``source`` is what needlework.read() gives or the path of such a file, or a Series beside the
``gas`` of its simulation. Each function draws into ``axes``, or into new ones, and returns them.
Kinetic theory is left out where bodies of a species differ or are fixed, or where walls, shear,
growth or driving act, whose cooling it does not follow.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, Union

import numpy as np

from . import theory
from .errors import InputError
from .reading import Recording, Series
from .values import Values

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

Source = Union[Recording, Series, str, "os.PathLike[str]"]

__all__ = ["cooling", "needles", "temperature_ratio", "temperatures"]

_MEASURED = {"color": "#d1495b", "marker": "o", "markersize": 4, "linestyle": "none"}
_THEORY = {"color": "#1d3557", "linewidth": 1.6, "label": "kinetic theory"}
# Of each species; of more, the first are drawn.
_SPECIES = ("#2a9d8f", "#e9a23b", "#6a4c93", "#5b8e3e", "#f3722c", "#577590", "#b56576", "#8d6e63")


def cooling(source: Source, gas: Values | None = None,
            axes: Axes | None = None) -> Axes:
    """The energy over its first value against time, beside kinetic theory. Of the file of a mixture
    also the energy per body of each species, over the first value of all."""
    series, gas, by_species = _series_and_gas(source, gas)
    start = series.energy[0]
    axes = axes or _new_axes()
    _draw(axes, series, gas, by_species, [("", lambda of: of.energy / start)])
    return _finished(axes, "E / E(0)")


def temperatures(source: Source, gas: Values | None = None,
                 axes: Axes | None = None) -> Axes:
    """The translational and the rotational temperature against time, beside kinetic theory; of the
    file of a mixture also those of each species. Spheres have no rotational temperature."""
    series, gas, by_species = _series_and_gas(source, gas)
    axes = axes or _new_axes()
    _draw(axes, series, gas, by_species, [(r"$T_{\rm tr}$", lambda of: of.t_tr),
                                          (r"$T_{\rm rot}$", lambda of: of.t_rot)])
    return _finished(axes, "temperature")


def temperature_ratio(source: Source, gas: Values | None = None,
                      axes: Axes | None = None) -> Axes:
    """The ratio of translational and rotational temperature against time, beside theory; of the
    file of a mixture also that of each species. Smooth spheres have no such ratio."""
    series, gas, by_species = _series_and_gas(source, gas)
    if not np.any(_turning(gas)):
        raise InputError("source: smooth spheres do not rotate: expected a gas of needles, rods or "
                         "rough spheres, which has a rotational temperature")
    axes = axes or _new_axes()
    _draw(axes, series, gas, by_species, [("", lambda of: of.t_tr / of.t_rot)])
    return _finished(axes, r"$T_{\rm tr} / T_{\rm rot}$")


def needles(state: Any, axes: Axes | None = None, *, length: float | None = None,
            most: int = 5000) -> Axes:
    """Needles as lines in three dimensions and spheres as discs about as large as they are,
    coloured by speed, in a sheared gas beside the flow.

    ``state`` is a Simulation or a frame; ``length`` that of all needles, each as long as it is
    unless that is given; ``most`` is how many needles are drawn, those with the lowest ids, because
    Matplotlib is slow with many.
    """
    needed = ["position", "orientation", "velocity", "box", "low"]
    if not all(hasattr(state, name) for name in needed + (["length"] if length is None else [])):
        raise InputError(f"state: {type(state).__name__}: expected a Simulation or a frame, such as "
                         "recording.frames[-1]")
    import matplotlib.pyplot as plt
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    axes = axes or plt.figure(figsize=(6, 6), layout="constrained").add_subplot(projection="3d")
    own = np.nan_to_num(state.length, nan=1.0) if length is None else np.full(most, length)
    centre = state.position[:most]
    own = own[:len(centre)]
    half = 0.5 * own[:, None] * state.orientation[:most]
    speed = np.linalg.norm(_beside_flow(state)[:most], axis=1)
    colours = {"cmap": "plasma", "norm": Normalize(np.min(speed, initial=np.inf),
                                                   np.max(speed, initial=0.0))}
    spheres = own == 0
    if not np.all(spheres):
        axes.add_collection3d(Line3DCollection(
            np.stack([centre - half, centre + half], axis=1)[~spheres], array=speed[~spheres],
            linewidths=1, **colours))
    if np.any(spheres):
        # Points per length, of a box that fills about half of the figure.
        scale = 36 * min(axes.figure.get_size_inches()) / np.max(state.box)
        axes.scatter(*centre[spheres].T, c=speed[spheres],
                     s=(scale * state.diameter[:most][spheres])**2, linewidths=0, **colours)
    for set_limits, low, edge in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), state.low,
                                     state.box):
        set_limits(low, low + edge)
    axes.set_box_aspect(tuple(state.box))
    axes.figure.colorbar(ScalarMappable(**colours), ax=axes, shrink=0.6, label="speed")
    return axes


def _beside_flow(state: Any) -> np.ndarray:
    """Velocities that are the same for all images, also in a uniform flow."""
    if hasattr(state, "peculiar_velocity"):
        return state.peculiar_velocity
    flow = getattr(getattr(state, "state", state), "flow", None)
    velocity = np.array(state.velocity)
    if flow is not None:
        velocity[:, 0] -= flow["shear_rate"] * state.position[:, 1]
    return velocity


def _series_and_gas(source: Source, gas: Values | None) -> tuple[Series, Values, Values | None]:
    """With the series by species of a mixture, whose theory starts from each of them."""
    if isinstance(source, Series):
        if gas is not None and "species" in gas:
            raise InputError("source: a Series of a mixture: expected the file of its run, which "
                             "has the temperatures of each species")
        if gas is None:
            raise InputError("gas is missing: expected that of the simulation, as in "
                             "plot.cooling(series, gas=sim.gas)")
        return source, gas, None
    if not isinstance(source, Recording):
        with Recording(source) as recording:
            return _series_and_gas(recording, gas)
    return (source.series, source.gas,
            source.observable("species") if "species" in source.gas else None)


def _draw(axes: Axes, series: Series, gas: Values, by_species: Values | None,
          quantities: list[tuple[str, Callable[[Any], np.ndarray]]]) -> None:
    """Of all bodies and of each species, each quantity as points beside the line of theory, where
    it is above 0."""
    has_theory = _has_theory(gas)
    times, curve, curve_by_species = (_theory(series, gas, by_species) if has_theory
                                      else (None, None, None))
    parts = [(f"{gas.count} needles", series, curve)]
    if by_species is not None:
        names = gas.species[:len(_SPECIES)]
        turning = _turning(gas)
        parts += [(name, _of_species(by_species, n, turning[n]),
                   _of_species(curve_by_species, n, turning[n]) if has_theory else None)
                  for n, name in enumerate(names)]
    colours = iter([_MEASURED["color"], *_SPECIES])
    line = dict(_THEORY)
    if np.any(np.greater(gas.get("diameter", 0.0), 0)):
        line["label"] += " at low density"  # whatever the density of bodies that have a width
    for name, measured, expected in parts:
        colour = next(colours)
        for (text, quantity), fill in zip(quantities, (colour, "none")):
            with np.errstate(divide="ignore", invalid="ignore"):
                values = quantity(measured)
                theoretical = quantity(expected) if has_theory else None
            shown = (series.time > 0) & np.isfinite(values) & (values > 0)
            if not np.any(shown):
                continue
            if has_theory:
                axes.loglog(times, theoretical, **line)
                line.pop("label", None)
            label = f"{text} of {name}" if text else name
            axes.loglog(series.time[shown], values[shown],
                        **{**_MEASURED, "color": colour}, markerfacecolor=fill, label=label)


def _turning(gas: Values) -> np.ndarray:
    """Half the rotational degrees of freedom of each species."""
    return np.where(gas.length > 0, 1.0, np.where(np.greater(gas.get("q", 0.0), 0), 1.5, 0.0))


def _of_species(sums: Values, n: int, turning: float) -> Values:
    t_tr, t_rot = sums.t_tr[:, n], sums.t_rot[:, n]
    return Values({"t_tr": t_tr, "t_rot": t_rot, "energy": 1.5 * t_tr + turning * t_rot})


def _has_theory(gas: Values) -> bool:
    """Whether the theory of a gas that cools follows this one, as that of the program does."""
    return (not gas.get("differ", False) and gas.get("undisturbed_until", np.inf) > 0
            and bool(np.all(np.isfinite(gas.mass))))


def _theory(series: Series, gas: Values,
            by_species: Values | None) -> tuple[np.ndarray, Values, Values | None]:
    """At the times of the series but 0, as long as the gas was left to itself: of all, and of each
    species of a mixture."""
    last = gas.get("undisturbed_until", np.inf)
    times = series.time[(series.time > 0) & (series.time <= last)]
    if by_species is not None:
        curve = theory.mixture_cooling(gas, by_species.t_tr[0], by_species.t_rot[0], times)
        turning = _turning(gas) * gas.counts
        with np.errstate(invalid="ignore"):  # of smooth spheres alone, which have no T_rot
            t_rot = curve.t_rot @ turning / np.sum(turning)
        return times, Values({"energy": curve.energy, "t_tr": curve.t_tr @ gas.counts / gas.count,
                              "t_rot": t_rot}), curve
    if "diameter" in gas:
        curve = theory.mixture_cooling(gas, series.t_tr[0], series.t_rot[0], times)
        return times, Values({"energy": curve.energy, "t_tr": curve.t_tr[:, 0],
                              "t_rot": curve.t_rot[:, 0]}), None
    # Needles of length L and mass m collide as often as those of length 1 and mass 1 at the
    # density n L^2 / sqrt(m).
    density = gas.count / np.prod(gas.box) * gas.length**2 / np.sqrt(gas.mass)
    return times, theory.cooling(gas.epsilon, gas.k, gas.beta, series.t_rot[0],
                                 theory.tau(times, density), series.t_tr[0]), None


def _finished(axes: Axes, label: str) -> Axes:
    axes.set_xlabel(r"time  [$L\sqrt{m/T}$]")
    axes.set_ylabel(label)
    axes.legend(frameon=False)
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if high < 10 * low:
            _label_plainly(axis)
    return axes


def _label_plainly(axis: Axis) -> None:
    """Labels 0.95 and 1.05: powers of ten are hard to read within a decade, and overlap."""
    from matplotlib.ticker import MaxNLocator, NullLocator, ScalarFormatter

    axis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]))
    axis.set_major_formatter(ScalarFormatter(useOffset=False))
    axis.set_minor_locator(NullLocator())


def _new_axes() -> Axes:
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(6, 4), layout="constrained")[1]
