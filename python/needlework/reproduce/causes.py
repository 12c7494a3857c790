"""Whether what the paper leaves open explains differences: the cells, and the contact time t_c."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from ..reading import Recording
from ..values import Table
from . import style
from .alignment import frame_near
from .cells import flow_order as flow_order_of
from .course import SHOWN_COLLISIONS, Measured, cooling_theory, mean_and_error, measure
from .dense import curve, draw_growth, flow_order_growth, second_moment
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns, Point

CELLS = (8, 9, 10, 12)
"""Cells along each axis that are compared."""

STANDARD_ENERGY = 1e-4
"""E/E(0) of theory at which dilute gases are compared."""

SHOWN_ENERGY = 2e-5
"""E/E(0) of theory until which their courses are shown."""

STANDARD_COLLISIONS = 400.0
"""Collisions per needle at which dense gases are compared."""


def measure_cells(runs: PaperRuns) -> Result:
    """Growth of S until the frame next to 600 collisions per needle, with cells of several
    sizes."""
    point = runs.points("dense")[0]
    result = Result(("cells", "needles_per_cell", "growth", "error"))
    for cells in CELLS:
        growth = measure(point, lambda run: _growth_with_cells(run, cells))
        result.rows.append((cells, point.conditions.count / cells**3, growth.value, growth.error))
        result.add("flow-order-growth", growth, f"test, {cells} cells along each axis")
    return result


def draw_cells(table: Table) -> Figure:
    """Growth against the mean number of needles in a cell."""
    figure, (axes,) = style.panels("Growth of $S$ and the size of the cells", 1, width=4.6)
    style.points(axes, table.needles_per_cell, table.growth, table.error)
    style.label(axes, "needles per cell", "$S$ / start", legend=False)
    return figure


def measure_contact_time_dilute(runs: PaperRuns) -> Result:
    """Energy over that of theory for three contact times, over the same seeds."""
    result = Result(("tc_relative", "tau", "energy_over_theory", "error"))
    for name, point in _cases(runs, "dilute-tc", "dilute"):
        tau = point.first.tau
        theory = cooling_theory(point.conditions, tau).energy
        shown = np.flatnonzero((tau >= 1) & (theory >= SHOWN_ENERGY * theory[0]))
        result.add_rows(point.conditions.tc_relative, tau[shown], *mean_and_error(
            [run.energy[shown] / theory[shown] for run in point.runs]))
        result.add("energy-theory", measure(point, energy_over_theory), f"test, {name}")
        result.add("tc-share", measure(point, _tc_share), f"dilute, {name}")
    return result


def draw_contact_time_dilute(table: Table) -> Figure:
    """Energy over theory against scaled time."""
    figure, (axes,) = style.panels("Energy of the dilute gas over theory, for three contact times",
                                   1, width=5.6)
    for (tc_relative,), part in parts(table, "tc_relative"):
        style.band(axes, part.tau, part.energy_over_theory, part.error, label=_label(tc_relative))
    style.label(axes, r"$\tau$", "$E$ / theory", log="x")
    return figure


def measure_contact_time_dense(runs: PaperRuns) -> Result:
    """Growth of S and of the second moment for two contact times, over the same seeds."""
    result = Result(("tc_relative", "collisions", "s", "s_error", "moment", "moment_error"))
    places = np.linspace(0, STANDARD_COLLISIONS, 41)
    for name, point in _cases(runs, "dense-tc", "dense"):
        s = curve(point, flow_order_growth, places)
        moment = curve(point, second_moment, places)
        result.add_rows(point.conditions.tc_relative, places, *s, *moment)
        at = f"test, {name}, at {STANDARD_COLLISIONS:g}"
        for claim, (mean, error) in (("flow-order-growth", s), ("moment-growth", moment)):
            result.add(claim, Measured(float(mean[-1]), float(error[-1]), point.seeds), at)
        result.add("tc-share", measure(point, _tc_share), f"dense, {name}")
    return result


def draw_contact_time_dense(table: Table) -> Figure:
    """S and the second moment against collisions per needle."""
    return draw_growth(table, "tc_relative", _label, "The dense gas with another contact time",
                       "$S$ / start")


def _cases(runs: PaperRuns, name: str, reference: str) -> Iterator[tuple[str, Point]]:
    """The points of a set and, with the same seeds so that means are over the same initial states,
    the first point of another one, by their contact times."""
    points = runs.points(name)
    seeds = {run.seed for run in points[0].runs}
    other = runs.points(reference)[0]
    points.append(Point(other.conditions, [run for run in other.runs if run.seed in seeds]))
    for point in points:
        yield f"t_c = {point.conditions.tc_relative:g} mean free times", point


def _label(tc_relative: float) -> str:
    return rf"$t_c = {tc_relative:g}$ mean free times"


def energy_over_theory(run: FinishedRun) -> float:
    """At the first sample at which theory has lost all but STANDARD_ENERGY."""
    theory = cooling_theory(run.conditions, run.tau).energy
    low = theory <= STANDARD_ENERGY * theory[0]
    sample = int(np.argmax(low)) if low.any() else len(theory) - 1
    return float(run.energy[sample] / theory[sample])


def _tc_share(run: FinishedRun) -> float:
    """Collisions by the t_c rule among all."""
    return float(run.series.tc_collisions[-1] / run.series.collisions[-1])


def _growth_with_cells(run: FinishedRun, cells: int) -> float:
    """S in the frame next to 600 collisions per needle over S in the first one."""
    with Recording(run.path) as recording:
        start, after = (flow_order_of(frame.position, frame.velocity, frame.box, (cells,) * 3)
                        for frame in (recording.frames[0],
                                      frame_near(run, recording, SHOWN_COLLISIONS)))
    return after / start
