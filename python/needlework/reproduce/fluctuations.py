"""Fluctuations of the dilute gas: local density, flow and energy, beside those of an elastic gas.

Each quantity of a cell is given in the unit in which its variance is 1 in an ideal gas.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from ..values import Table
from . import style
from .course import mean_of
from .figure import Result
from .runs import Conditions, FinishedRun, PaperRuns, Point

COLD = 1e-5
"""E/E(0) below which the cooling gas is late."""

BINS = 40

LABELS = {"density": r"$(\rho - \langle\rho\rangle) / \langle\rho\rangle \cdot n^{1/2}$",
          "velocity": r"$U_x\, (n m / T_{\rm tr})^{1/2}$",
          "energy": r"$(e - \langle e\rangle) / \langle e\rangle \cdot (3 n / 2)^{1/2}$"}
"""The quantities, with n needles in a cell."""

Chosen = Callable[[FinishedRun], np.ndarray]
"""Which samples of a run count, [S]."""


@dataclass
class Spread:
    """A quantity over cells, samples and runs."""

    density: np.ndarray
    """Its probability density in the bins."""
    variances: list[float]
    """About 0, of each run."""


def measure_fluctuations(runs: PaperRuns) -> Result:
    """Histograms and variances over the cells, of the cooling gas when it is cold, before, and of
    the elastic one."""
    cooling, elastic = runs.points("dilute")[0], runs.points("elastic")[0]
    cold_energy = COLD * cooling.first.series.energy[0]
    cold = _spreads(cooling, lambda run: run.series.energy <= cold_energy)
    before = _spreads(cooling, lambda run: run.series.energy > cold_energy)
    equal = _spreads(elastic, lambda run: np.ones(run.series.rows, dtype=bool))

    result = Result([f"{name}_{column}" for name in LABELS
                     for column in ("value", "cooling", "elastic")])
    borders = _borders(cooling.conditions)
    result.add_rows(*(column for name in LABELS
                      for column in ((borders[name][1:] + borders[name][:-1]) / 2,
                                     cold[name].density, equal[name].density)))
    for name in LABELS:
        here = mean_of(cold[name].variances)
        result.add("local-fluctuations", here.over_measured(mean_of(equal[name].variances)), name)
        result.add("stationary-fluctuations",
                   here.over_measured(mean_of(before[name].variances)), name)
    return result


def draw_fluctuations(table: Table) -> Figure:
    """A histogram of each quantity."""
    figure, axes = style.panels("Local fluctuations: cooling gas and elastic gas", 3)
    for panel, (name, label) in zip(axes, LABELS.items()):
        for gas, colour in zip(("cooling", "elastic"), style.COLOURS):
            style.histogram(panel, table[f"{name}_value"], table[f"{name}_{gas}"], label=gas,
                            color=colour)
        style.label(panel, label, "probability density", name)
    return figure


def _borders(conditions: Conditions) -> dict[str, np.ndarray]:
    """Borders of the bins; of the density, one for each number of needles in a cell."""
    n = conditions.needles_per_cell
    wide = np.linspace(-5, 5, BINS + 1)
    return {"density": (np.arange(BINS + 1) - 0.5 - n) / np.sqrt(n), "velocity": wide,
            "energy": wide}


def _spreads(point: Point, chosen: Chosen) -> dict[str, Spread]:
    borders = _borders(point.conditions)
    of_runs = [_local(run, chosen(run)) for run in point.runs]
    spreads = {}
    for name in LABELS:
        values = np.concatenate([of_run[name] for of_run in of_runs])
        counts, _ = np.histogram(values, borders[name])
        width = borders[name][1] - borders[name][0]
        spreads[name] = Spread(counts / len(values) / width,
                               [float(np.mean(of_run[name]**2)) for of_run in of_runs])
    return spreads


def _local(run: FinishedRun, chosen: np.ndarray) -> dict[str, np.ndarray]:
    """The quantities of all cells at the samples that count."""
    density = run.observable("fields", "density")[chosen]
    flow = run.observable("fields", "flow")[chosen]
    thermal = run.observable("fields", "thermal_tr")[chosen]
    n, axes = run.conditions.needles_per_cell, (1, 2, 3)
    t_tr = run.series.t_tr[chosen][:, None, None, None]
    relative = density / density.mean(axis=axes, keepdims=True)
    in_cell = relative * n
    energy = thermal + np.sum(flow**2, axis=-1) / 2
    occupied = in_cell > 0
    return {"density": ((relative - 1) * np.sqrt(n)).ravel(),
            "velocity": (flow * np.sqrt(in_cell / t_tr)[..., None]).ravel(),
            "energy": ((energy / (1.5 * t_tr) - 1) * np.sqrt(1.5 * in_cell))[occupied]}
