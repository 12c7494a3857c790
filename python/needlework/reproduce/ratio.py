"""Figure 3, the long-time ratio of temperatures, and that of rough needles beyond the paper."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import theory
from ..values import Table
from . import style
from .course import Measured, late_ratio, mean_of, measure
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns, Point

SETTLED = 0.1
"""E/E(0) below which the ratio of temperatures is constant."""

ROUGH_K = 6.0
"""k of all rough needles."""

COLUMNS = ("ratio_theory", "ratio", "ratio_error", "seeds")


def measure_ratio(runs: PaperRuns) -> Result:
    """T_tr / T_rot of smooth needles at points of restitution and k, beside theory."""
    points = runs.points("ratio")
    result = Result(("epsilon", "k", *COLUMNS))
    for point in points:
        gas = point.conditions
        variant = f"epsilon = {gas.epsilon:g}, k = {gas.k:g}"
        ratio, c = _add_point(result, point, gas.epsilon, gas.k)
        result.add("ratio-surface", ratio.over(c), variant)
        if _is_equipartition(gas.k):
            result.add("equipartition", ratio, variant)
    result.add("order-of-temperatures", mean_of(_shares_in_order(points)))
    result.add("equipartition-k", Measured(theory.equipartition_k()))
    return result


def draw_ratio(table: Table) -> Figure:
    """Theory as a map and as cuts at constant restitution, simulations as points."""
    figure, (plane, cuts) = style.panels(r"Long-time ratio $T_{\rm tr} / T_{\rm rot}$", 2,
                                         width=4.4, height=3.6)
    epsilon, k = np.linspace(0, 0.99, 34), np.linspace(0.5, 16.5, 65)
    values = theory.ratio(epsilon[None, :], k[:, None])
    colours = plane.contourf(epsilon, k, values, np.arange(0, values.max() + 0.2, 0.2),
                             cmap="viridis")
    plane.contour(colours, levels=[1.0], colors="white", linewidths=1.0)
    plane.scatter(table.epsilon, table.k, c=table.ratio, cmap=colours.cmap, norm=colours.norm,
                  edgecolors="black", linewidths=0.8, zorder=3, clip_on=False)
    figure.colorbar(colours, ax=plane, label=r"$T_{\rm tr} / T_{\rm rot}$")
    plane.grid(False)
    style.label(plane, r"$\epsilon$", "$k$", "Theory (colours) and simulation (points)",
                legend=False)
    for value, cut in parts(table, "epsilon"):
        _draw_pair(cuts, cut.k, cut, k, theory.ratio(value[0], k), rf"$\epsilon = {value[0]:g}$")
    style.label(cuts, "$k$", r"$T_{\rm tr} / T_{\rm rot}$", r"Cuts at constant $\epsilon$")
    return figure


def measure_rough_ratio(runs: PaperRuns) -> Result:
    """T_tr / T_rot of rough needles at points of normal and tangential restitution."""
    result = Result(("epsilon", "beta", *COLUMNS))
    for point in runs.points("rough"):
        gas = point.conditions
        ratio, c = _add_point(result, point, gas.epsilon, gas.beta)
        result.add("rough-ratio", ratio.over(c), f"epsilon = {gas.epsilon:g}, beta = {gas.beta:g}")
    return result


def draw_rough_ratio(table: Table) -> Figure:
    """Theory as lines, simulations as points, against tangential restitution; k = 6."""
    figure, (axes,) = style.panels("Rough needles: long-time ratio "
                                   r"$T_{\rm tr} / T_{\rm rot}$", 1, width=5.6, height=3.6)
    beta = np.linspace(-0.98, 0.98, 99)
    for value, cut in parts(table, "epsilon"):
        _draw_pair(axes, cut.beta, cut, beta, theory.ratio(value[0], ROUGH_K, beta),
                   rf"$\epsilon = {value[0]:g}$")
    style.label(axes, r"$\beta$", r"$T_{\rm tr} / T_{\rm rot}$",
                f"Theory (lines) and simulation (points), $k = {ROUGH_K:g}$")
    return figure


def _add_point(result: Result, point: Point, x: float, y: float) -> tuple[Measured, float]:
    """Adds a row; the ratio of temperatures, and c of theory."""
    gas = point.conditions
    c = float(theory.ratio(gas.epsilon, gas.k, gas.beta))
    ratio = measure(point, settled_ratio)
    result.rows.append((x, y, c, ratio.value, ratio.error, point.seeds))
    return ratio, c


def settled_ratio(run: FinishedRun) -> float:
    """T_tr / T_rot where the gas has lost most of its energy."""
    return late_ratio(run, run.series.energy <= SETTLED * run.series.energy[0])


def _is_equipartition(k: float) -> bool:
    return abs(k / theory.equipartition_k() - 1) < 1e-4


def _shares_in_order(points: list[Point]) -> list[float]:
    """In how many of the points, but those at k*, each seed has the hotter of the two motions on
    the right side."""
    others = [point for point in points if not _is_equipartition(point.conditions.k)]
    right = [[(settled_ratio(run) > 1) == (point.conditions.k > theory.equipartition_k())
              for run in point.runs] for point in others]
    return [float(np.mean(of_seed)) for of_seed in zip(*right)]


def _draw_pair(axes: Axes, x: np.ndarray, cut: Table, line_x: np.ndarray, line: np.ndarray,
               label: str) -> None:
    """Points with error bars and the line of theory in one colour."""
    curve, = axes.plot(line_x, line, label=label)
    style.points(axes, x, cut.ratio, cut.ratio_error, color=curve.get_color())
