"""Beyond the paper: packings of spheres and rods that grow until they jam."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..order import nematic_order
from ..reading import Recording
from ..values import Table
from . import style
from .course import Measured, mean_and_error, mean_of
from .figure import Result, parts
from .nematic import random_order
from .runs import FinishedRun, PaperRuns, Point

EQUAL, TWO_SIZES, RODS = range(3)
"""The column kind of the data: equal spheres, spheres of two sizes, rods."""

SETS = {"packings-fast": EQUAL, "packings": EQUAL, "packings-slow": EQUAL,
        "packings-mixture": TWO_SIZES, "packings-rods": RODS}
"""Sets of runs, and of what they are."""

NAMES = ("equal spheres", "spheres 1 : 1.4", "rods")
"""As variants of claims and legends have them."""

KNOWN = {EQUAL: {0.1: 0.6213, 0.01: 0.6437, 0.001: 0.651}, TWO_SIZES: {0.1: 0.6238, 0.01: 0.6504}}
"""Where spheres jam by another program, of 500 spheres too, by the rate of growth."""

DENSEST = (0.45, 0.721)
"""L/D at which jammed disordered rods are densest, and their packing fraction (Imaz Gonzalez and
coworkers)."""

WITHOUT_GROWTH = {1.0: 0.675, 2.0: 0.64, 5.0: 0.53}
"""Packing fractions to which overlaps of rods at random could be removed, by L/D."""

NEAR = 300
"""P V / (N T) from which on it diverges with the distance from jamming."""

PRESSURES = np.geomspace(10, 1000, 9)
"""Of P V / (N T), borders of the bins in which its divergence is drawn."""


def measure_packings(runs: PaperRuns) -> Result:
    """Where bodies jam, how the pressure diverges, and the nematic order at the end: a row for each
    bin of the pressure, with the numbers of the whole runs in all of them."""
    result = Result(("kind", "shape", "rate", "packing", "packing_error", "d", "d_error", "order",
                     "order_error", "order_random", "seeds", "pressure", "distance",
                     "distance_error"))
    densest: dict[float, list[tuple[float, list[float]]]] = {}
    for name, kind in SETS.items():
        for point in runs.points(name):
            rate, shape = _rate(point), _shape(point)
            ends, slopes = zip(*(jam(*_course(run)) for run in point.runs))
            packing, d = mean_of(ends), mean_of(slopes)
            order = mean_of(point.values(_order)) if kind == RODS else Measured(np.nan, np.nan)
            courses = [distances(*_course(run), end) for run, end in zip(point.runs, ends)]
            result.add_rows(kind, shape, rate, *packing[:2], *d[:2], *order[:2],
                            random_order(point.conditions.count) if kind == RODS else np.nan,
                            point.seeds, np.sqrt(PRESSURES[1:] * PRESSURES[:-1]),
                            *mean_and_error(courses))
            of = f"L/D = {shape:g}, " if kind == RODS else ""
            variant = f"{of}rate = {rate:g}"
            if kind == RODS:
                _add_rods(result, variant, shape, packing, d, order)
                densest.setdefault(rate, []).append((shape, list(ends)))
            else:
                _add_spheres(result, kind, rate, packing, d)
    for rate, found in densest.items():
        result.add("packings-rods-densest", densest_shape(found), f"rate = {rate:g}")
    return result


def _add_spheres(result: Result, kind: int, rate: float, packing: Measured, d: Measured) -> None:
    variant = f"{NAMES[kind]}, rate = {rate:g}"
    if rate in KNOWN[kind]:
        claim = "packings-equal" if kind == EQUAL else "packings-two-sizes"
        result.add(claim, packing.over(KNOWN[kind][rate]), variant)
    else:
        result.add("packings-spheres", packing, variant)
    result.add("packings-divergence", d, variant)


def _add_rods(result: Result, variant: str, shape: float, packing: Measured, d: Measured,
              order: Measured) -> None:
    densest, known = DENSEST
    if shape == densest:
        result.add("packings-rods-maximum", packing, variant)
    elif shape in WITHOUT_GROWTH:
        result.add("packings-rods-bound", packing.over(WITHOUT_GROWTH[shape]), variant)
    else:
        result.add("packings-rods", packing, variant)
    result.add("packings-rods-divergence", d, variant)
    result.add("packings-rods-order", order, variant)


def _rate(point: Point) -> float:
    """Of the diameter over sqrt(T / m)."""
    return float(point.conditions.scene["driving"]["growth"]["rate"])


def _shape(point: Point) -> float:
    """L/D, 0 of spheres."""
    first = point.conditions.scene["species"][0]
    return first["length"] / first["diameter"]


def _course(run: FinishedRun) -> tuple[np.ndarray, np.ndarray]:
    """Packing fraction and P V / (N T) at the samples at which it has been measured."""
    packing, pressure = (run.observable("growth", name)
                         for name in ("packing_fraction", "pressure"))
    there = np.isfinite(pressure)
    return packing[there], pressure[there]


def jam(packing: np.ndarray, pressure: np.ndarray) -> tuple[float, float]:
    """The packing fraction phi_J and the number d of Z = d / (1 - phi / phi_J): a straight line of
    1 / Z from NEAR on, in which all samples have the same relative error."""
    near = pressure >= NEAR
    slope, at_zero = np.polyfit(packing[near], 1 / pressure[near], 1, w=pressure[near])
    return float(-at_zero / slope), float(1 / at_zero)


def distances(packing: np.ndarray, pressure: np.ndarray, end: float) -> np.ndarray:
    """Z (1 - phi / phi_J), which tends to d, as a mean in each bin of Z; NaN in those without a
    sample."""
    at = np.digitize(pressure, PRESSURES) - 1
    values = pressure * (1 - packing / end)
    return np.array([values[at == n].mean() if (at == n).any() else np.nan
                     for n in range(len(PRESSURES) - 1)])


def densest_shape(found: Sequence[tuple[float, Sequence[float]]]) -> Measured:
    """L/D of the densest packing of each seed, from packing fractions by L/D."""
    shapes, packings = zip(*found)
    return mean_of([shapes[int(np.argmax(seed))] for seed in zip(*packings)])


def _order(run: FinishedRun) -> float:
    with Recording(run.path) as recording:
        u = recording.frames[-1].orientation
    return float(nematic_order((3 * u.T @ u / len(u) - np.eye(3)) / 2).order)


def draw_packings(table: Table) -> Figure:
    """Where spheres jam against the rate of growth and rods against L/D, the divergence of the
    pressure, and the nematic order of the packings."""
    figure, (spheres, rods, divergence, order) = style.panels(
        "Bodies that grow until they jam", 4, columns=2, width=4.4, height=3.3)
    _draw_spheres(spheres, table)
    _draw_rods(rods, order, table)
    _draw_divergence(divergence, table)
    return figure


def _points(table: Table) -> Table:
    """A row for each point instead of each bin of the pressure."""
    first = np.sort(np.unique(np.array([table.kind, table.shape, table.rate]), axis=1,
                              return_index=True)[1])
    return Table({name: column[first] for name, column in table.items()})


def _draw_spheres(panel: Axes, table: Table) -> None:
    for (kind,), part in parts(_points(table), "kind"):
        if kind == RODS:
            continue
        look = {"color": style.COLOURS[int(kind)]}
        style.points(panel, part.rate, part.packing, part.packing_error, linestyle="-",
                     linewidth=0.8, label=NAMES[int(kind)], **look)
        known = KNOWN[int(kind)]
        panel.plot(list(known), list(known.values()), "D", mfc="none", markersize=6,
                   linestyle="none", label=f"{NAMES[int(kind)]}, known", **look)
    style.label(panel, r"$\Gamma$", r"$\phi_{\rm J}$", "Spheres, against the rate of growth",
                log="x")


def _draw_rods(panel: Axes, order: Axes, table: Table) -> None:
    points = _points(table)
    rods = points.kind == RODS
    for number, rate in enumerate(np.unique(points.rate[rods])):
        look = {"color": style.COLOURS[2 + number], "linestyle": "-", "linewidth": 0.8,
                "label": rf"$\Gamma = {rate:g}$"}
        # Spheres are the rods of L = 0.
        chosen = (points.kind != TWO_SIZES) & (points.rate == rate)
        part = Table({name: column[chosen] for name, column in points.items()})
        style.points(panel, part.shape, part.packing, part.packing_error, **look)
        part = Table({name: column[rods & chosen] for name, column in points.items()})
        style.points(order, part.shape, part.order, part.order_error, **look)
    panel.plot(*DENSEST, "*", markersize=9, color=style.COLOURS[1], linestyle="none",
               label="published maximum")
    panel.plot(list(WITHOUT_GROWTH), list(WITHOUT_GROWTH.values()), "^", mfc="none",
               color=style.COLOURS[5], linestyle="none", label="reached without growth")
    order.axhline(points.order_random[rods][0], color="grey", linewidth=0.9, linestyle=":",
                  label="directors at random")
    order.set_ylim(bottom=0)
    style.label(panel, "$L/D$", r"$\phi_{\rm J}$", "Rods, against their shape")
    style.label(order, "$L/D$", "nematic order", "Order of packings of rods")


def _draw_divergence(panel: Axes, table: Table) -> None:
    rods = table.kind == RODS
    slow = np.min(table.rate[rods])
    looks = iter(style.shade(share) for share in np.linspace(0, 1, len(np.unique(table.shape[rods]))))
    for (kind, shape, rate), part in parts(table, "kind", "shape", "rate"):
        if rate != slow:
            continue
        look = {"color": next(looks), "label": f"$L/D = {shape:g}$"} if kind == RODS else {
            "color": style.COLOURS[int(kind)], "label": NAMES[int(kind)], "marker": "s"}
        style.points(panel, part.pressure, part.distance, part.distance_error, linestyle="-",
                     linewidth=0.8, **look)
    for freedoms in (3, 5):
        panel.axhline(freedoms, color="grey", linewidth=0.9, linestyle=":")
    panel.set_ylim(2, 7)
    style.label(panel, "$Z = PV/NT$", r"$Z\,(1 - \phi/\phi_{\rm J})$",
                rf"Divergence of the pressure, $\Gamma = {slow:g}$", log="x", legend=False)
    panel.legend(ncols=2)
