"""Beyond the paper: rods of finite width, which its outlook names as the next step."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from .. import theory
from ..values import Table
from . import style
from .cells import fields_near, strongest_shear_wave
from .course import at_collisions, late_ratio, mean_of, measure
from .dense import flow_order, flow_order_growth, second_moment
from .figure import Result, parts
from .flow import AXES, seen_in_plane_of_shear
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


FLOW_AT = (100.0, 300.0, 600.0)
"""Collisions per rod at which the flow of dense rods is measured."""


def measure_flow(runs: PaperRuns) -> Result:
    """Order of the flow and second moment of the density of dense rods that cool against collisions
    per rod, of the first seed, and its flow at the end in the plane of the strongest shear flow."""
    result = Result(("collisions", "energy", "s", "moment", "first_axis", "second_axis",
                     "x", "y", "u", "v"))
    point = runs.points("rods-flow")[0]
    run = point.first
    missing = np.nan
    result.add_rows(run.collisions, run.series.energy / run.series.energy[0], flow_order(run),
                    second_moment(run), *6 * (missing,))
    shown = fields_near(run, run.collisions[-1])[0]
    result.add_rows(shown.collisions, *3 * (missing,), *seen_in_plane_of_shear(shown))
    for collisions in FLOW_AT:
        variant = f"at {collisions:g}"
        for claim, quantity in (("rods-flow-order", flow_order),
                                ("rods-flow-growth", flow_order_growth),
                                ("rods-flow-moment", second_moment)):
            result.add(claim, measure(
                point, lambda run: at_collisions(run, quantity(run), collisions)), variant)
        waves = [strongest_shear_wave(fields_near(run, collisions)[0]) for run in point.runs]
        result.add("rods-shear-bands", mean_of([2.0 * wave.number for wave in waves]), variant)
        result.add("rods-shear-share", mean_of([wave.share for wave in waves]), variant)
    return result


def draw_flow(table: Table) -> Figure:
    """S and the second moment against collisions per rod, and arrows of the flow at the end."""
    figure, (order, moment, flow) = style.panels("Dense rods that cool", 3, width=3.6, height=3.4)
    curve = np.isfinite(table.s)
    order.plot(table.collisions[curve], table.s[curve])
    moment.plot(table.collisions[curve], table.moment[curve])
    style.label(order, "collisions per rod", "$S$", "Order of the flow", legend=False)
    style.label(moment, "collisions per rod", "second moment / start",
                "Second moment of the density", legend=False)
    flow.quiver(table.x[~curve], table.y[~curve], table.u[~curve], table.v[~curve],
                color=style.COLOURS[0], pivot="mid", width=0.006)
    first, second = (AXES[int(table[name][~curve][0])] for name in ("first_axis", "second_axis"))
    style.label(flow, f"${first}$", f"${second}$",
                f"Flow at {table.collisions[~curve][0]:.0f} collisions per rod", legend=False)
    flow.set(xlim=style.edges(table.x[~curve])[[0, -1]],
             ylim=style.edges(table.y[~curve])[[0, -1]], aspect="equal")
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
