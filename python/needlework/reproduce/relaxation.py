"""Elastic relaxation: how the temperatures of translation and rotation become equal."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..values import Table
from . import style
from .course import Measured, cooling_theory, mean_and_error, measure, slope
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns

FIT_FROM, FIT_TO = 0.75, 0.08
"""Rates are those between these shares of the initial difference of temperatures."""

SHOWN_TO = 0.3 * FIT_TO
"""Share of the initial difference, by theory, until which the courses are shown."""

RELAXED = 1e-3
"""Share of the initial difference, by theory, from which on equipartition is expected."""


def measure_relaxation(runs: PaperRuns) -> Result:
    """|T_tr - T_rot| against scaled time at two k and two densities, and its rates."""
    result = Result(("k", "density", "tau", "difference", "difference_error", "theory"))
    at_full_density: dict[float, Measured] = {}
    for point in runs.points("relaxation"):
        gas, tau = point.conditions, point.first.tau
        variant = f"k = {gas.k:g}, n = {gas.density:.2g}"
        curve = cooling_theory(gas, tau)
        theory = gas.t_tr * np.abs(curve.t_tr - curve.t_rot)
        expected = _rate(tau, theory, point.first.series.energy[0])
        mean, error = mean_and_error([differences(run)[:len(tau)] for run in point.runs])
        shown = theory >= SHOWN_TO * theory[0]
        result.add_rows(gas.k, gas.density, tau[shown], mean[shown], error[shown], theory[shown])

        rate = measure(point, lambda run: _rate(run.tau, differences(run), run.series.energy[0]))
        result.add("relaxation-rate", rate, variant)
        result.add("relaxation-theory", rate.over(expected), variant)
        if theory[-1] <= RELAXED * theory[0]:
            late = theory <= RELAXED * theory[0]
            result.add("elastic-equipartition", measure(
                point, lambda run: np.mean(run.series.t_tr[late] / run.series.t_rot[late])),
                variant)
        full = at_full_density.setdefault(gas.k, rate)
        if full is not rate:
            result.add("relaxation-density", rate.over_measured(full), f"k = {gas.k:g}")
    return result


def draw_relaxation(table: Table) -> Figure:
    """Simulations as points, theory as lines."""
    figure, (axes,) = style.panels("Elastic relaxation to equipartition", 1, width=5.6,
                                   height=3.6)
    for (k, density), part in parts(table, "k", "density"):
        line, = axes.plot(part.tau, part.theory)
        axes.plot(part.tau[::2], part.difference[::2], "o", color=line.get_color(),
                  label=f"$k = {k:g}$, $n = {density:.2g}$")
    style.label(axes, r"$\tau$", r"$|T_{\rm tr} - T_{\rm rot}|$",
                r"$T_{\rm rot}(0) = 0.4\, T_{\rm tr}(0)$", log="y")
    return figure


def differences(run: FinishedRun) -> np.ndarray:
    """|T_tr - T_rot| at the samples."""
    return np.abs(run.series.t_tr - run.series.t_rot)


def _rate(tau: np.ndarray, differences: np.ndarray, energy: float) -> float:
    """The rate at which a difference of temperatures falls in tau = gamma t, over sqrt(E): the
    slope of its logarithm from FIT_FROM of its start until it first falls below FIT_TO."""
    share = differences / differences[0]
    below = share < FIT_TO
    end = int(np.argmax(below)) if below.any() else len(share)
    fitted = share[:end] <= FIT_FROM
    return -slope(tau[:end][fitted], np.log(differences[:end][fitted])) / np.sqrt(energy)
