"""Pictures of runs, drawn with Matplotlib (python3-matplotlib).

``source`` is a Simulation or what needlework.read() gives; both have a series and a gas. Each
function draws into ``axes``, or into new ones, and returns them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import theory

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["cooling", "needles", "temperature_ratio"]

_MEASURED = {"color": "#d1495b", "marker": "o", "markersize": 4, "linestyle": "none"}
_THEORY = {"color": "#1d3557", "linewidth": 1.6}


def cooling(source: Any, axes: Axes | None = None) -> Axes:
    """The energy over its first value against time, beside kinetic theory."""
    axes = axes or _new_axes()
    series = source.series
    later = series.time > 0
    time, start = series.time[later], series.energy[0]
    axes.loglog(time, _theory_of(source).energy / start, **_THEORY, label="kinetic theory")
    axes.loglog(time, series.energy[later] / start, **_MEASURED,
                label=f"{source.gas.count} needles")
    axes.set_xlabel(r"time  [$L\sqrt{m/T}$]")
    axes.set_ylabel("E / E(0)")
    axes.legend(frameon=False)
    return axes


def temperature_ratio(source: Any, axes: Axes | None = None) -> Axes:
    """The ratio of translational and rotational temperature against time, beside theory."""
    axes = axes or _new_axes()
    series = source.series
    later = (series.time > 0) & (series.t_rot > 0)
    curve = _theory_of(source)
    with np.errstate(divide="ignore"):
        axes.loglog(series.time[series.time > 0], curve.t_tr / curve.t_rot, **_THEORY,
                    label="kinetic theory")
    axes.loglog(series.time[later], series.t_tr[later] / series.t_rot[later], **_MEASURED,
                label=f"{source.gas.count} needles")
    axes.set_xlabel(r"time  [$L\sqrt{m/T}$]")
    axes.set_ylabel(r"$T_{\rm tr} / T_{\rm rot}$")
    axes.legend(frameon=False)
    return axes


def needles(state: Any, axes: Axes | None = None, *, length: float = 1.0,
            most: int = 5000) -> Axes:
    """Needles as lines in three dimensions, coloured by speed.

    ``state`` is a Simulation or a frame; ``most`` is how many needles are drawn, those with the
    lowest ids, because Matplotlib is slow with many.
    """
    import matplotlib.pyplot as plt
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    axes = axes or plt.figure(figsize=(6, 6)).add_subplot(projection="3d")
    centre, half = state.position[:most], 0.5 * length * state.orientation[:most]
    speed = np.linalg.norm(state.velocity[:most], axis=1)
    lines = Line3DCollection(np.stack([centre - half, centre + half], axis=1), cmap="plasma",
                             array=speed, linewidths=1)
    axes.add_collection3d(lines)
    for set_limits, edge in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), state.box):
        set_limits(0, edge)
    axes.set_box_aspect(state.box)
    axes.figure.colorbar(lines, ax=axes, shrink=0.6, label="speed")
    return axes


def _theory_of(source: Any) -> theory.CoolingCurve:
    """Of a source, at the times of its series but the first."""
    gas, series = source.gas, source.series
    # Needles of length L and mass m collide as often as those of length 1 and mass 1 at the
    # density n L^2 / sqrt(m).
    density = gas.count / np.prod(gas.box) * gas.length**2 / np.sqrt(gas.mass)
    return theory.cooling(gas.epsilon, gas.k, gas.beta, series.t_rot[0],
                          tau=theory.tau(series.time[series.time > 0], density),
                          t_tr0=series.t_tr[0])


def _new_axes() -> Axes:
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(6, 4))[1]
