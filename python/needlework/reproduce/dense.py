"""Figure 5 and what the text says of the dense gas as it goes on.

flow_order of the runs has the order of the flow S (translational), the second moment of the
density, and the order of the rotation (rotational).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from ..values import Table
from . import style
from .course import (SHOWN_BOTH_WAYS, SHOWN_COLLISIONS, at_collisions, cooling_theory,
                     log_tc_collisions, mean_and_error, measure)
from .figure import Result, parts
from .runs import Conditions, FinishedRun, PaperRuns, Point

STEP = 10.0
"""Collisions per needle between the points of curves."""

HAFF_FROM = 100.0
"""Scaled time from which t^-2 is drawn; it holds late."""

SIZES_AT = (*SHOWN_BOTH_WAYS, 1500.0)
"""Collisions per needle at which boxes of several sizes are compared."""

Quantity = Callable[[FinishedRun], np.ndarray]
"""What a run has at its samples, [S]."""

ORDER_COLUMNS = ("k", "t_rot0", "collisions", "value", "error")


def flow_order(run: FinishedRun) -> np.ndarray:
    """S at the samples."""
    return run.observable("flow_order", "translational")


def flow_order_growth(run: FinishedRun) -> np.ndarray:
    """S at the samples over that at the start."""
    order = flow_order(run)
    return order / order[0]


def second_moment(run: FinishedRun) -> np.ndarray:
    """Second moment of the density at the samples, over that at the start."""
    moment = run.observable("flow_order", "second_moment")
    return moment / moment[0]


def rotation_order(run: FinishedRun) -> np.ndarray:
    """Order of the rotation at the samples over that of random velocities. A gas that starts
    without rotation has none at the start."""
    return run.observable("flow_order", "rotational") / _random_order(run.conditions)


def _random_order(conditions: Conditions) -> float:
    """C / (N - C) for C cells and N needles."""
    cells = float(np.prod(conditions.cells))
    return cells / (conditions.count - cells)


def measure_flow_order(runs: PaperRuns) -> Result:
    """S against collisions per needle, means over seeds, for each start."""
    result = Result(ORDER_COLUMNS)
    for point in runs.points("dense"):
        start = point.conditions.start
        _add_curve(result, point, flow_order)
        result.add("flow-order-start", measure(point, lambda run: flow_order(run)[0]), start)
        for collisions in SHOWN_BOTH_WAYS:
            at = f"{start}, at {collisions:g}"
            result.add("flow-order", measure(
                point, lambda run: at_collisions(run, flow_order(run), collisions)), at)
            result.add("flow-order-growth", measure(
                point, lambda run: at_collisions(run, flow_order_growth(run), collisions)), at)
        result.add("tc-instances", measure(point, log_tc_collisions), f"dense, {start}")
    return result


def draw_flow_order(table: Table) -> Figure:
    """S for each start."""
    return _draw_order(table, "Order of the flow $S$", "$S$")


def measure_second_moment(runs: PaperRuns) -> Result:
    """Second moment of the density against collisions per needle, means over seeds."""
    result = Result(ORDER_COLUMNS)
    for point in runs.points("dense"):
        start = point.conditions.start
        _add_curve(result, point, second_moment)
        for collisions in (400.0, 800.0):  # counted for both needles, and once
            result.add("moment-growth", measure(
                point, lambda run: at_collisions(run, second_moment(run), collisions)),
                f"{start}, at {collisions:g}")
        result.add("moment-peak", measure(point, _collisions_of_peak), start)
    return result


def draw_second_moment(table: Table) -> Figure:
    """The second moment for each start."""
    return _draw_order(table, "Second moment of the density over its start",
                       "second moment / start")


def measure_rotation(runs: PaperRuns) -> Result:
    """Order of the rotation against collisions per needle, means over seeds."""
    result = Result(ORDER_COLUMNS)
    for point in runs.points("dense"):
        _add_curve(result, point, rotation_order)
        for collisions in SHOWN_BOTH_WAYS:
            result.add("rotation-growth", measure(
                point, lambda run: at_collisions(run, rotation_order(run), collisions) - 1),
                f"{point.conditions.start}, at {collisions:g}")
    return result


def draw_rotation(table: Table) -> Figure:
    """The order of the rotation for each start."""
    return _draw_order(table, "Order of the rotation over that of random velocities",
                       "order / random order")


def measure_dense_cooling(runs: PaperRuns) -> Result:
    """Temperatures against scaled time, of the first seed, and how far all are from theory."""
    result = Result(("k", "t_rot0", "tau", "t_tr", "t_rot", "t_tr_theory", "t_rot_theory",
                     "collisions"))
    for point in runs.points("dense"):
        gas, first = point.conditions, point.first
        theory = cooling_theory(gas, first.tau)
        result.add_rows(gas.k, gas.t_rot, *(column[1:] for column in (
            first.tau, first.series.t_tr, first.series.t_rot, theory.t_tr, theory.t_rot,
            first.collisions)))
        for collisions in SHOWN_BOTH_WAYS:
            at = f"{gas.start}, at {collisions:g}"
            for claim, name in (("departure-translation", "t_tr"), ("departure-rotation", "t_rot")):
                result.add(claim, measure(
                    point, lambda run: log_over_theory(run, name, collisions)), at)
            result.add("late-exponent", measure(
                point, lambda run: _late_exponent(run, collisions)), at)
    return result


def draw_dense_cooling(table: Table) -> Figure:
    """Both temperatures and the law of Haff through the last value of theory, for each start."""
    starts = list(parts(table, "k", "t_rot0"))
    figure, axes = style.panels("Cooling of the dense gas", len(starts), columns=2)
    for panel, (start, part) in zip(axes, starts):
        panel.plot(part.tau, part.t_tr, label=r"$T_{\rm tr}$")
        panel.plot(part.tau, part.t_rot, label=r"$T_{\rm rot}$")
        late = part.tau[part.tau >= HAFF_FROM]
        if len(late):
            panel.plot(late, part.t_tr_theory[-1] * (late[-1] / late)**2, "--",
                       label=r"$\tau^{-2}$")
        style.label(panel, r"$\tau$", r"$T / T_{\rm tr}(0)$", style.start_label(*start), log="xy")
    return figure


def measure_box_sizes(runs: PaperRuns) -> Result:
    """S and the second moment in boxes of several sizes at equal density."""
    result = Result(("box", "needles", "collisions", "s", "s_error", "moment", "moment_error"))
    for name in ("box-small", "box-middle", "box-large", "dense"):
        point = runs.points(name)[0]
        box = point.conditions.box[0]
        places = curve_places(point)
        result.add_rows(box, point.conditions.count, places, *curve(point, flow_order, places),
                        *curve(point, second_moment, places))
        for collisions in SIZES_AT:
            if collisions > last_collisions(point):
                continue
            at = f"box {box:g}, at {collisions:g}"
            result.add("sizes-flow-order", measure(
                point, lambda run: at_collisions(run, flow_order(run), collisions)), at)
            result.add("sizes-moment", measure(
                point, lambda run: at_collisions(run, second_moment(run), collisions)), at)
            result.add("sizes-late-exponent", measure(
                point, lambda run: _late_exponent(run, collisions)), at)
    return result


def draw_box_sizes(table: Table) -> Figure:
    """S and the second moment against collisions per needle."""
    return draw_growth(table, "box", lambda box: f"box {box:g}",
                       "The dense gas in boxes of several sizes", "$S$")


def draw_growth(table: Table, by: str, label: Callable[[float], str], title: str,
                s_label: str) -> Figure:
    """S and the second moment against collisions per needle, a curve for each value of the column
    ``by``, which ``label`` words."""
    figure, axes = style.panels(title, 2, width=4.2)
    for (value,), part in parts(table, by):
        for panel, name in zip(axes, ("s", "moment")):
            style.band(panel, part.collisions, part[name], part[f"{name}_error"],
                       label=label(value))
    style.label(axes[0], "collisions per needle", s_label, "Order of the flow")
    style.label(axes[1], "collisions per needle", "second moment / start",
                "Second moment of the density")
    return figure


def last_collisions(point: Point) -> float:
    """Collisions per needle until which all runs go."""
    return float(min(run.collisions[-1] for run in point.runs))


def curve_places(point: Point) -> np.ndarray:
    """Collisions per needle of the points of a curve."""
    last = last_collisions(point)
    return np.linspace(0, last, int(last / STEP) + 1)


def curve(point: Point, quantity: Quantity,
          places: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """The mean over seeds of a quantity at so many collisions per needle, with its error."""
    return mean_and_error([at_collisions(run, quantity(run), places) for run in point.runs])


def _add_curve(result: Result, point: Point, quantity: Quantity) -> None:
    gas, places = point.conditions, curve_places(point)
    result.add_rows(gas.k, gas.t_rot, places, *curve(point, quantity, places))


def _draw_order(table: Table, title: str, label: str) -> Figure:
    figure, (axes,) = style.panels(title, 1, width=5.6, height=3.4)
    for start, part in parts(table, "k", "t_rot0"):
        style.band(axes, part.collisions, part.value, part.error,
                   label=style.start_label(*start))
    style.label(axes, "collisions per needle", label)
    return figure


def _collisions_of_peak(run: FinishedRun) -> float:
    """Collisions per needle at which the second moment is greatest, until about 600."""
    moment = run.observable("flow_order", "second_moment")
    return float(run.collisions[np.argmax(moment[:run.sample_near(SHOWN_COLLISIONS) + 1])])


def log_over_theory(run: FinishedRun, name: str, collisions: float) -> float:
    """How much slower than theory a temperature has fallen: ln of measured over theory, at the
    sample nearest to so many collisions per needle."""
    sample = run.sample_near(collisions)
    theory = cooling_theory(run.conditions, run.tau[[sample]])
    return float(np.log(run.series[name][sample] / run.conditions.t_tr / theory[name][0]))


def _late_exponent(run: FinishedRun, collisions: float) -> float:
    """d ln E / d ln C over the last fifth of the C collisions per needle."""
    earlier = 0.8 * collisions
    first, last = at_collisions(run, np.log(run.series.energy), [earlier, collisions])
    return float((last - first) / np.log(collisions / earlier))
