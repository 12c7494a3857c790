"""Beyond the paper: whether flow and clusters of the dense gas depend on its size, and its needles
coloured by flow."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from ..reading import Frame, Recording
from ..values import Table
from . import style
from .alignment import frame_near
from .cells import fields_near, flow_in_cells, places_in_cells, strongest_shear_wave
from .course import at_collisions, mean_and_error, mean_of, measure
from .dense import (SIZES_AT, curve, curve_places, flow_order, flow_order_growth, last_collisions,
                    second_moment)
from .figure import Result, parts
from .flow import AXES
from .runs import FinishedRun, PaperRuns, Point

SETS = ("box-middle", "box-large", "dense", "dense-large")
"""Boxes of equal density and equal start, the last one the largest that is known."""

WAVES_EVERY = 5
"""Points of the curves of S from one to the next of the waves."""

FILM_AT = (0.0, 150.0, 300.0, 600.0, 1000.0, 1500.0)
"""Collisions per needle of the pictures of a film."""

SLAB = 0.2
"""Thickness of the slab in the middle of the box whose needles a film shows [L]."""


class Wave(NamedTuple):
    """The strongest shear wave at one sample."""

    bands: float
    """Bands of the flow, two for each wave."""
    length: float
    """Of the wave [L]."""
    share: float
    """Of the energy of the flow."""


def measure_sizes(runs: PaperRuns) -> Result:
    """S, the second moment and the strongest shear wave in boxes of several sizes."""
    result = Result(("box", "needles", "collisions", *(
        column for name in ("s", "moment", *Wave._fields) for column in (name, f"{name}_error"))))
    for name in SETS:
        point = runs.points(name)[0]
        box, at = point.conditions.box[0], curve_places(point)
        waves = np.full((2, len(at), len(Wave._fields)), np.nan)
        waves[:, ::WAVES_EVERY] = mean_and_error([_waves(run, at[::WAVES_EVERY])
                                                  for run in point.runs])
        result.add_rows(box, point.conditions.count, at, *curve(point, flow_order, at),
                        *curve(point, second_moment, at), *(
                            waves[kind, :, number] for number in range(len(Wave._fields))
                            for kind in (0, 1)))
        for collisions in SIZES_AT:
            if collisions <= last_collisions(point):
                _add_numbers(result, point, collisions, f"box {box:g}, at {collisions:g}")
    return result


def draw_sizes(table: Table) -> Figure:
    """S, the second moment, and length and share of the wave, against collisions per needle."""
    figure, axes = style.panels("The dense gas of up to 100000 needles", 4, columns=2, width=4.4,
                                height=3.1)
    for (box, needles), part in parts(table, "box", "needles"):
        label = f"box {box:g}, $N = {needles:.0f}$"
        for panel, name in zip(axes, ("s", "moment", "length", "share")):
            there = np.isfinite(part[name])
            style.band(panel, part.collisions[there], part[name][there],
                       part[f"{name}_error"][there], label=label)
    for panel, y, title in zip(axes, (
            "$S$", "second moment / start", "length of the wave / $L$", "share of the energy of "
            "the flow"), ("Order of the flow", "Second moment of the density",
                          "Strongest shear wave", "Strongest shear wave")):
        style.label(panel, "collisions per needle", y, title, legend=panel is axes[0])
    return figure


def measure_film(runs: PaperRuns) -> Result:
    """Needles of the first seed in a slab along the strongest shear flow at the end, at several
    times, with the flow of their cells in units of the thermal velocity."""
    run = runs.points("dense-large")[0].first
    wave = strongest_shear_wave(fields_near(run, run.collisions[-1])[0])
    first, second = wave.gradient, wave.along
    result = Result(("collisions", "first_axis", "second_axis", "box", "x", "y", "dx", "dy",
                     "flow"))
    seen = set()
    with Recording(run.path) as recording:
        for collisions in FILM_AT:
            frame = frame_near(run, recording, collisions)
            if frame.time in seen or collisions > run.collisions[-1] + 1:
                continue
            seen.add(frame.time)
            chosen, flow = in_slab(frame, run.conditions.cells, first, second)
            # A hundredth is less than a pixel, and keeps the data small.
            position, director, flow = (np.round(values[chosen], 2) for values in (
                frame.position, frame.orientation, flow))
            result.add_rows(np.round(np.interp(frame.time, run.series.time, run.collisions), 1),
                            first, second, run.conditions.box[first], position[:, first],
                            position[:, second], director[:, first], director[:, second], flow)
    return result


def draw_film(table: Table) -> Figure:
    """A panel for each time, each needle as a line in the colour of the flow of its cell."""
    times = list(parts(table, "collisions"))
    figure, axes = style.panels("Needles in a slab of the dense gas, coloured by the flow",
                                len(times), columns=3, width=3.2, height=3.2)
    most = np.quantile(np.abs(table.flow), 0.98)
    first, second = (AXES[int(table[name][0])] for name in ("first_axis", "second_axis"))
    for panel, ((collisions,), part) in zip(axes, times):
        lines = _draw_needles(panel, part, most)
        style.label(panel, f"${first}$", f"${second}$",
                    f"{collisions:.0f} collisions per needle", legend=False)
    figure.colorbar(lines, ax=axes, shrink=0.6,
                    label=rf"$U_{second} / (T_{{\rm tr}}/m)^{{1/2}}$")
    return figure


def _waves(run: FinishedRun, at: np.ndarray) -> np.ndarray:
    """Numbers of the strongest shear waves, [C, 3]."""
    waves = [strongest_shear_wave(fields) for fields in fields_near(run, *at)]
    return np.array([Wave(2.0 * wave.number, run.conditions.box[wave.gradient] / wave.number,
                          wave.share) for wave in waves])


def _add_numbers(result: Result, point: Point, collisions: float, variant: str) -> None:
    """Those of the claims after so many collisions per needle."""
    for claim, quantity in (("large-flow-order", flow_order),
                            ("large-flow-growth", flow_order_growth),
                            ("large-moment", second_moment)):
        result.add(claim, measure(
            point, lambda run: at_collisions(run, quantity(run), collisions)), variant)
    waves = [_waves(run, np.array([collisions]))[0] for run in point.runs]
    for name, values in zip(Wave._fields, zip(*waves)):
        result.add(f"large-wave-{name}", mean_of(values), variant)


def in_slab(frame: Frame, cells: tuple[int, int, int], first: int,
            second: int) -> tuple[np.ndarray, np.ndarray]:
    """Which needles have their centres in the slab in the middle of the third axis, and the flow
    along the second axis in the cells of all needles in units of the thermal velocity."""
    third = 3 - first - second
    place = places_in_cells(frame.position, frame.box, cells)
    flow, _ = flow_in_cells(place, frame.velocity, int(np.prod(cells)))
    t_tr = np.mean(np.sum(frame.velocity**2, axis=1)) / 3
    chosen = np.abs(frame.position[:, third] - frame.box[third] / 2) < SLAB / 2
    return chosen, flow[second, place] / np.sqrt(t_tr)


def _draw_needles(panel: Axes, part: Table, most: float) -> LineCollection:
    middles = np.stack([part.x, part.y], axis=1)
    halves = np.stack([part.dx, part.dy], axis=1) / 2
    lines = LineCollection(np.stack([middles - halves, middles + halves], axis=1), cmap="coolwarm",
                           array=part.flow, linewidths=0.8, clim=(-most, most))
    panel.add_collection(lines)
    panel.grid(False)
    panel.set(xlim=(0, part.box[0]), ylim=(0, part.box[0]), aspect="equal")
    return lines
