"""Figure 2: cooling of the dilute gas beside kinetic theory."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from .. import theory
from ..values import Table
from . import style
from .course import (Measured, cooling_theory, late_ratio, log_tc_collisions, mean_and_error,
                     measure, slope)
from .figure import Result
from .runs import FinishedRun, PaperRuns, Point

FIRST_TAU = 1.0
"""Simulation and theory are compared from this scaled time on; what is earlier is the start."""

LATE_TAU = 100.0
"""Both temperatures fall as one from this scaled time on."""


def measure_cooling(runs: PaperRuns) -> Result:
    """Energy and ratio of temperatures of the dilute gas against scaled time, means over seeds."""
    point = runs.points("dilute")[0]
    gas = point.conditions
    tau, energy, energy_error, ratio, ratio_error = _means(point)
    curve = cooling_theory(gas, tau)
    ratio_theory = curve.t_tr / curve.t_rot
    result = Result(("tau", "energy", "energy_error", "energy_theory",
                     "ratio", "ratio_error", "ratio_theory"))
    result.add_rows(tau, energy, energy_error, curve.energy, ratio, ratio_error, ratio_theory)

    later = tau >= FIRST_TAU
    result.add("energy-theory", farthest_from_one(
        (energy / curve.energy)[later], (energy_error / curve.energy)[later], point.seeds))
    c = float(theory.ratio(gas.epsilon, gas.k))
    result.add("ratio-theory", measure(
        point, lambda run: late_ratio(run, run.tau >= LATE_TAU) / c))
    result.add("ratio-theory-start", farthest_from_one(
        (ratio / ratio_theory)[later], (ratio_error / ratio_theory)[later], point.seeds))
    result.add("ratio-time", measure(point, lambda run: _log_time_to_share(run, c)))
    result.add("haff-dilute", measure(point, _haff_exponent))
    result.add("tc-instances", measure(point, log_tc_collisions), "dilute")
    return result


def draw_cooling(table: Table) -> Figure:
    """Energy, ratio of temperatures, and both over theory."""
    figure, axes = style.panels("Cooling of the dilute gas: simulation and theory", 3)
    for panel, name, label in ((axes[0], "energy", r"$E / T_{\rm tr}(0)$"),
                               (axes[1], "ratio", r"$T_{\rm tr} / T_{\rm rot}$")):
        style.points(panel, table.tau, table[name], table[f"{name}_error"], label="simulation")
        panel.plot(table.tau, table[f"{name}_theory"], label="theory", zorder=3)
        style.label(panel, r"$\tau$", label, log="xy")
    later = table.tau >= FIRST_TAU
    for name, label in (("energy", r"$E$"), ("ratio", r"$T_{\rm tr} / T_{\rm rot}$")):
        expected = table[f"{name}_theory"]
        style.points(axes[2], table.tau[later], (table[name] / expected)[later],
                     (table[f"{name}_error"] / expected)[later], label=label)
    axes[2].axhline(1, color="grey", linewidth=0.8)
    style.label(axes[2], r"$\tau$", "simulation / theory", log="x")
    return figure


def _means(point: Point) -> tuple[np.ndarray, ...]:
    """Scaled times that all runs have samples at, without the start and the last sample, which is
    the end of a run; there, energies and ratios of temperatures with their standard errors."""
    last = min(len(run.tau) for run in point.runs) - 1
    shared = slice(1, last)
    energies = [run.energy[shared] for run in point.runs]
    ratios = [(run.series.t_tr[shared] / run.series.t_rot[shared]) for run in point.runs]
    return (point.first.tau[shared], *mean_and_error(energies), *mean_and_error(ratios))


def farthest_from_one(values: np.ndarray, errors: np.ndarray, seeds: int) -> Measured:
    """The last of the values that are farthest from 1."""
    if not len(values):
        return Measured(1.0)
    distance = np.abs(values - 1)
    farthest = len(values) - 1 - int(np.argmax(distance[::-1]))
    return Measured(float(values[farthest]), float(errors[farthest]), seeds)


def _log_time_to_share(run: FinishedRun, c: float) -> float:
    """log10 of the tau at which T_rot / T_tr, which is 0 at the start, has come 1 - 1/e of its way
    to 1 / c; linear in log10 tau between samples."""
    share = (1 - np.exp(-1)) / c
    shares = run.series.t_rot[1:] / run.series.t_tr[1:]
    above = int(np.argmax(shares > share))
    if above == 0:
        return np.nan
    logs = np.log10(run.tau[above:above + 2])
    return float(np.interp(share, shares[above - 1:above + 1], logs))


def _haff_exponent(run: FinishedRun) -> float:
    """d ln E / d ln t over the last three decades of time."""
    late = run.tau >= run.tau[-1] / 1000
    return slope(np.log(run.tau[late]), np.log(run.energy[late]))
