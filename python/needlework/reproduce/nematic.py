"""Beyond the paper: the nematic order and the pressure of elastic rods."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..values import Table
from . import style
from .course import mean_and_error, measure
from .figure import Result, parts
from .rods import diameter_of
from .runs import Conditions, FinishedRun, PaperRuns

STARTS = ("lattice", "crossed")
"""Packings of the start: in full order, and without order."""

STARTS_IN_WORDS = ("from a lattice of parallel rods", "from crossed blocks")

LATE = 1 / 2
"""Share of a run after which its order counts."""

STRETCHES = 10
"""Of a run, over each of which the course of its order is averaged."""


def measure_nematic(runs: PaperRuns) -> Result:
    """The nematic order and the pressure of elastic rods of L/D = 5 against their packing fraction,
    from a start in full order and from one without, and the course of the order: a row for each
    stretch of the runs, with the order and the pressure of the whole runs in all of them."""
    result = Result(("start", "packing", "order", "order_error", "order_random", "pressure",
                     "pressure_error", "seeds", "collisions", "course", "course_error"))
    late = {}
    for point in runs.points("nematic"):
        gas = point.conditions
        start = gas.scene["initial"]["packing"]
        packing = packing_of(gas)
        order = measure(point, lambda run: float(np.mean(_orders(run)[-_late_samples(run):])))
        pressure = measure(point, lambda run: _excess(run) + 1).over(1 / packing)
        courses = [_course(run) for run in point.runs]
        result.add_rows(STARTS.index(start), packing, *order[:2], random_order(gas.count),
                        *pressure[:2], point.seeds, np.mean([at for at, _ in courses], axis=0),
                        *mean_and_error([course for _, course in courses]))
        variant = f"packing fraction {packing:.3g}"
        result.add("nematic-order", order, f"{variant}, {start}")
        late.setdefault(variant, {})[start] = order
        if start == "crossed" and abs(packing - 0.31) < 2e-3:
            result.add("rods-pressure-isotropic", pressure, variant)
        if start == "crossed" and abs(packing - 0.352) < 2e-3:
            result.add("rods-pressure-denser", pressure, variant)
    for variant, orders in late.items():
        above, below = (orders[start] for start in STARTS)
        result.add("nematic-hysteresis", above.less(below), variant)
    return result


def random_order(count: int) -> float:
    """The mean order of so many random directors, whose greatest eigenvalue is not 0; to a few
    percent."""
    return 1.1 / np.sqrt(count)


def draw_nematic(table: Table) -> Figure:
    """The order and the pressure against the packing fraction, and the course of the order."""
    figure, (order, pressure, *courses) = style.panels("Elastic rods of $L/D = 5$", 4, columns=2,
                                                       width=4.2, height=3.1)
    for (start,), branch in parts(table, "start"):
        whole = [points for _, points in parts(branch, "packing")]
        packing, s, s_error, p, p_error = (
            np.array([points[name][0] for points in whole])
            for name in ("packing", "order", "order_error", "pressure", "pressure_error"))
        look = {"label": STARTS_IN_WORDS[int(start)], "color": style.COLOURS[int(start)]}
        style.points(order, packing, s, s_error, **look)
        style.points(pressure, packing, p, p_error, **look)
        for number, points in enumerate(whole):
            shade = {"color": style.shade(number / max(1, len(packing) - 1))}
            style.band(courses[int(start)], points.collisions, points.course, points.course_error,
                       label=rf"$\eta = {packing[number]:.3g}$", **shade)
        style.label(courses[int(start)], "collisions per rod", "nematic order $S$",
                    f"Start {STARTS_IN_WORDS[int(start)]}", legend=int(start) == 1)
        courses[int(start)].set_ylim(0, 1)
    order.plot(table.packing, table.order_random, color=style.COLOURS[5], linestyle="--",
               label="random directors")
    order.axvline(0.40, color=style.COLOURS[3], linewidth=1.0,
                  label="isotropic up to here, McGrother et al.")
    style.label(order, r"packing fraction $\eta$", "nematic order $S$", "Second half of the runs")
    pressure.plot([0.310, 0.352], [2.53, 3.63], "x", color=style.COLOURS[3],
                  label="McGrother et al.")
    style.label(pressure, r"packing fraction $\eta$", "$p v / T$", "Pressure by collisions")
    return figure


def packing_of(gas: Conditions) -> float:
    """Share of the box that the rods take up."""
    diameter = diameter_of(gas)
    return gas.density * (np.pi * diameter**2 / 4 + np.pi * diameter**3 / 6)


def _orders(run: FinishedRun) -> np.ndarray:
    """The largest eigenvalue of the order tensor at each sample."""
    return np.linalg.eigvalsh(run.observable("alignment", "order_tensor"))[:, -1]


def _late_samples(run: FinishedRun) -> int:
    return int(np.count_nonzero(run.collisions >= LATE * run.collisions[-1]))


def _course(run: FinishedRun) -> tuple[np.ndarray, np.ndarray]:
    """Collisions per rod in the middle of stretches, and the mean order of each."""
    borders = np.linspace(0, run.collisions[-1], STRETCHES + 1)
    stretch = np.clip(np.searchsorted(borders, run.collisions, side="right") - 1, 0, STRETCHES - 1)
    samples = np.bincount(stretch, minlength=STRETCHES)
    with np.errstate(invalid="ignore"):  # short runs have stretches without samples
        means = np.bincount(stretch, _orders(run), minlength=STRETCHES) / samples
    return (borders[1:] + borders[:-1]) / 2, means


def _excess(run: FinishedRun) -> float:
    """Z - 1 = sum of r12 . dp / (3 N T t) over the late part, T = 2 E / (5 N - 3)."""
    series, count = run.series, run.conditions.count
    temperature = 2 * series.energy[0] * count / (5 * count - 3)
    virial = run.observable("rods", "virial")
    first = len(series.time) - _late_samples(run)
    time = series.time[-1] - series.time[first]
    return float((virial[-1] - virial[first]) / (3 * count * temperature * time))
