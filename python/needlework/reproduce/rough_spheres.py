"""Beyond the paper: rough spheres, the other half of the classic model by two of its authors."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..values import Table
from . import style
from .course import measure
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns

SETS = ("rough-spheres", "rough-spheres-smooth")

RELAXED = 150.0
"""Collisions of a sphere after which the ratio of temperatures is constant."""

Q = 2 / 5
"""4 I / (m D^2) of homogeneous spheres."""

BOLTZMANN = {
    0.9: {-0.9: (51.97, 0.16), -0.75: (1.008, 0.005), -0.5: (0.3252, 0.0006),
          -0.25: (0.4145, 0.0004), 0: (0.5458, 0.0006), 0.25: (0.6954, 0.0007),
          0.5: (0.8520, 0.0006), 0.75: (0.9962, 0.0010), 0.9: (1.0764, 0.0010),
          1: (1.1228, 0.0007)},
    0.7: {-0.9: (206.7, 0.6), -0.75: (24.08, 0.07), -0.5: (3.549, 0.004), -0.25: (1.419, 0.002),
          0: (1.124, 0.002), 0.25: (1.1245, 0.0012), 0.5: (1.1991, 0.0013), 0.75: (1.2826, 0.0010),
          0.9: (1.3367, 0.0012), 1: (1.3653, 0.0011)},
}
"""T_rot / T_tr of cooling spheres by direct simulation of the Boltzmann equation with 5e4 and 1e5
spheres, and its standard error, by normal and tangential restitution."""


def mean_field(epsilon: float, beta: np.ndarray) -> np.ndarray:
    """T_rot / T_tr if velocities stay Gaussian and independent of spins (Huthmann and Zippelius,
    Phys. Rev. E 56, R6275 (1997))."""
    eta = (1 + beta) * Q / (2 * (1 + Q))
    loss = (1 - epsilon**2) / 4 + eta * (1 - eta) - eta / Q * (1 - eta / Q)
    exchange = eta**2 / Q
    return (loss + np.hypot(loss, 2 * exchange)) / (2 * exchange)


def measure_rough_spheres(runs: PaperRuns) -> Result:
    """T_rot / T_tr of cooling spheres against tangential restitution, beside the Boltzmann equation
    and mean field."""
    result = Result(("epsilon", "beta", "mean_field", "boltzmann", "boltzmann_error", "ratio",
                     "ratio_error", "seeds"))
    for point in (point for name in SETS for point in runs.points(name)):
        gas, ratio = point.conditions, measure(point, relaxed_ratio)
        expected, error = BOLTZMANN[gas.epsilon][gas.beta]
        by_mean_field = float(mean_field(gas.epsilon, np.array(gas.beta)))
        result.rows.append((gas.epsilon, gas.beta, by_mean_field, expected, error, ratio.value,
                            ratio.error, point.seeds))
        variant = f"epsilon = {gas.epsilon:g}, beta = {gas.beta:g}"
        result.add("rough-spheres-ratio", ratio.over(expected), variant)
        result.add("rough-spheres-mean-field", ratio.over(by_mean_field), variant)
    return result


def draw_rough_spheres(table: Table) -> Figure:
    """The ratios, and how far they are from those of the Boltzmann equation."""
    figure, (values, differences) = style.panels("Rough spheres that cool", 2, width=4.4,
                                                 height=3.4)
    beta = np.linspace(-0.95, 1, 118)
    for (epsilon,), part in parts(table, "epsilon"):
        label = rf"$\epsilon = {epsilon:g}$"
        curve, = values.plot(beta, mean_field(epsilon, beta), linewidth=0.8, label=label)
        look = {"color": curve.get_color()}
        values.plot(part.beta, part.boltzmann, "x", markersize=7, **look)
        style.points(values, part.beta, part.ratio, part.ratio_error, **look)
        style.points(differences, part.beta, part.ratio / part.boltzmann,
                     part.ratio_error / part.boltzmann, label=label, **look)
        order = np.argsort(part.beta)
        differences.plot(part.beta[order], (part.mean_field / part.boltzmann)[order],
                         linewidth=0.8, **look)
    values.set_yscale("log")
    differences.axhspan(0.98, 1.02, color=style.COLOURS[5], alpha=0.2, linewidth=0)
    style.label(values, r"$\beta$", r"$T_{\rm rot} / T_{\rm tr}$",
                "Mean field (lines), Boltzmann equation (crosses)")
    style.label(differences, r"$\beta$", "over that of the Boltzmann equation",
                "Simulation (points), mean field (lines)")
    return figure


def relaxed_ratio(run: FinishedRun) -> float:
    """T_rot / T_tr over the rest of a run, of equal collisions; NaN before."""
    late = run.collisions >= RELAXED
    if not late.any():
        return np.nan
    # Samples are equally far apart in the logarithm of time, in which collisions are nearly so.
    return float((run.series.t_rot[late] / run.series.t_tr[late]).mean())
