"""Beyond the paper: rods of finite width, which its outlook names as the next step."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from .. import theory
from ..values import Table
from . import style
from .course import late_ratio, measure
from .figure import Result, parts
from .runs import Conditions, FinishedRun, PaperRuns

SETTLED = 0.1
"""E/E(0) below which the ratio of temperatures is constant."""

GROWN_UNSTABLE = 0.02
"""E/E(0) above which dense rods have not yet formed patterns."""


def measure_rods(runs: PaperRuns) -> Result:
    """T_tr / T_rot of rods that cool against restitution and L/D, dilute and at a packing fraction
    of 0.2, beside kinetic theory at low density."""
    result = Result(("dense", "shape", "epsilon", "ratio_theory", "ratio", "ratio_error", "seeds"))
    for dense, name in enumerate(("rods", "rods-dense")):
        for point in runs.points(name):
            gas, c = point.conditions, ratio_of_rods(point.conditions)
            shape = 1 / diameter_of(gas)
            ratio = measure(point, _ratio_dense if dense else _ratio_settled)
            result.rows.append((dense, shape, gas.epsilon, c, ratio.value, ratio.error,
                                point.seeds))
            result.add("rods-ratio-dense" if dense else "rods-ratio", ratio.over(c),
                       f"L/D = {shape:g}, epsilon = {gas.epsilon:g}")
    return result


def draw_rods(table: Table) -> Figure:
    """Ratio of temperatures against restitution, theory as lines."""
    figure, axes = style.panels("Rods that cool: ratio of temperatures", 2, width=4.2, height=3.2)
    for number, ((shape,), part) in enumerate(parts(table, "shape")):
        for (dense,), points in parts(part, "dense"):
            look = {"color": style.COLOURS[number], "label": f"$L/D = {shape:g}$"}
            panel = axes[int(dense)]
            order = np.argsort(points.epsilon)
            panel.plot(points.epsilon[order], points.ratio_theory[order], color=look["color"])
            style.points(panel, points.epsilon, points.ratio, points.ratio_error, **look)
    for panel, title in zip(axes, ("Dilute", "Packing fraction 0.2")):
        panel.axhline(1, color=style.COLOURS[5], linewidth=0.6)
        style.label(panel, r"$\epsilon$", r"$T_{\rm tr} / T_{\rm rot}$",
                    title + ", theory of low density as lines")
    return figure


def diameter_of(gas: Conditions) -> float:
    """Of the rods, in units of the length of their axes."""
    return float(gas.scene["needles"]["diameter"])


def ratio_of_rods(gas: Conditions) -> float:
    """T_tr / T_rot that stays constant as a dilute gas of rods cools, by the rates of Gaussian
    velocities: where both temperatures fall by equal shares."""
    rods = {"counts": gas.count, "box": gas.box, "diameter": diameter_of(gas),
            "epsilon": gas.epsilon}
    low, high = 0.1, 10.0
    while high / low > 1 + 1e-12:
        c = np.sqrt(low * high)
        rates = theory.mixture_rates(rods, c, 1.0)
        # The ratio falls where it is too large.
        low, high = (low, c) if rates.t_tr[0] / c < rates.t_rot[0] else (c, high)
    return float(c)


def _ratio_settled(run: FinishedRun) -> float:
    return late_ratio(run, run.series.energy <= SETTLED * run.series.energy[0])


def _ratio_dense(run: FinishedRun) -> float:
    energy = run.series.energy / run.series.energy[0]
    return late_ratio(run, (energy <= SETTLED) & (energy >= GROWN_UNSTABLE))
