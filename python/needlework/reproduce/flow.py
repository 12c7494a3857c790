"""Figures 4, 6 and 7: flow and density of the dense gas in space."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..values import Table
from . import style
from .cells import (CellFields, density_flow_correlation, fields_near, strongest_shear_wave)
from .course import SHOWN_BOTH_WAYS, SHOWN_COLLISIONS, mean_of
from .figure import Result, parts
from .runs import PaperRuns

AXES = "xyz"


def measure_flow_field(runs: PaperRuns) -> Result:
    """The flow of the first seed after 600 collisions per needle, in the plane of the strongest
    shear flow and averaged along the third axis; the shear waves of all seeds."""
    result = Result(("k", "t_rot0", "seed", "collisions", "first_axis", "second_axis",
                     "x", "y", "u", "v"))
    for point in runs.points("dense"):
        gas = point.conditions
        fields = [fields_near(run, *SHOWN_BOTH_WAYS) for run in point.runs]
        shown = fields[0][0]
        first, second, *seen = seen_in_plane_of_shear(shown)
        result.add_rows(gas.k, gas.t_rot, point.first.seed, shown.collisions, first, second, *seen)
        for collisions, now in zip(SHOWN_BOTH_WAYS, zip(*fields)):
            waves = [strongest_shear_wave(of_run) for of_run in now]
            variant = f"{gas.start}, at {collisions:g}"
            result.add("shear-bands", mean_of([2.0 * wave.number for wave in waves]), variant)
            result.add("shear-share", mean_of([wave.share for wave in waves]), variant)
    return result


def draw_flow_field(table: Table) -> Figure:
    """Arrows of the flow, for each start."""
    starts = list(parts(table, "k", "t_rot0"))
    figure, axes = style.panels("Flow of the dense gas after 600 collisions per needle",
                                len(starts), columns=2, width=3.8, height=3.7)
    for panel, (start, part) in zip(axes, starts):
        panel.quiver(part.x, part.y, part.u, part.v, color=style.COLOURS[0], pivot="mid",
                     width=0.006)
        first, second = (AXES[int(part[name][0])] for name in ("first_axis", "second_axis"))
        style.label(panel, f"${first}$", f"${second}$", style.start_label(*start), legend=False)
        panel.set(xlim=style.edges(part.x)[[0, -1]], ylim=style.edges(part.y)[[0, -1]],
                  aspect="equal")
    return figure


def measure_density(runs: PaperRuns) -> Result:
    """How many of the cells along z are dense, of the first seed at the start and after 600
    collisions per needle; the shares of dense cells of all seeds."""
    result = Result(("k", "t_rot0", "seed", "x", "y", "dense_start", "dense_after"))
    for point in runs.points("dense"):
        gas = point.conditions
        fields = [fields_near(run, 0.0, SHOWN_COLLISIONS) for run in point.runs]
        start, after = fields[0]
        y, x = np.meshgrid(start.middles(1), start.middles(0), indexing="ij")
        result.add_rows(gas.k, gas.t_rot, point.first.seed, x.ravel(), y.ravel(),
                        *(of.dense.sum(axis=2).T.ravel() for of in (start, after)))
        for claim, now in zip(("dense-cells-before", "dense-cells-after"), zip(*fields)):
            shares = [float(np.mean(of_run.dense)) for of_run in now]
            result.add(claim, mean_of(shares), gas.start)
    return result


def draw_density(table: Table) -> Figure:
    """Maps of the numbers of dense cells, for each start."""
    starts = list(parts(table, "k", "t_rot0"))
    figure, axes = style.panels("Cells with more than 1.5 times the mean density",
                                2 * len(starts), columns=4, width=2.6, height=2.7)
    most = max(table.dense_start.max(), table.dense_after.max(), 1)
    for number, (start, part) in enumerate(starts):
        x, y = style.edges(part.x), style.edges(part.y)
        for panel, column, when in ((axes[2 * number], "dense_start", "at the start"),
                                    (axes[2 * number + 1], "dense_after", "after 600")):
            # The cells as one small picture inside the SVG.
            colours = panel.imshow(part[column].reshape(len(y) - 1, len(x) - 1), origin="lower",
                                   extent=(x[0], x[-1], y[0], y[-1]), vmin=0, vmax=most,
                                   cmap="viridis", interpolation="nearest")
            panel.grid(False)
            style.label(panel, "$x$", "$y$", f"{style.start_label(*start)},\n{when}", legend=False)
    figure.colorbar(colours, ax=axes, label="dense cells along $z$", shrink=0.6)
    return figure


def measure_line_profiles(runs: PaperRuns) -> Result:
    """Flow and density along x after 600 collisions per needle, in the cells just below y = 6 and
    averaged over z, of all seeds; correlations of flow and density over all cells."""
    result = Result(("k", "t_rot0", "seed", "collisions", "x", "uy", "uz", "excess"))
    for point in runs.points("dense"):
        gas = point.conditions
        fields = [fields_near(run, *SHOWN_BOTH_WAYS) for run in point.runs]
        for run, (shown, _) in zip(point.runs, fields):
            row = shown.excess.shape[1] // 2 - 1
            flow = shown.flow[:, row].mean(axis=1) / np.sqrt(shown.t_tr)
            result.add_rows(gas.k, gas.t_rot, run.seed, shown.collisions, shown.middles(0),
                            flow[:, 1], flow[:, 2], shown.excess[:, row].mean(axis=1))
        for collisions, now in zip(SHOWN_BOTH_WAYS, zip(*fields)):
            correlations = [density_flow_correlation(of_run) for of_run in now]
            result.add("density-flow-correlation", mean_of(correlations),
                       f"{gas.start}, at {collisions:g}")
    return result


def draw_line_profiles(table: Table) -> Figure:
    """Flow in units of the thermal velocity, and density, of the first seed."""
    starts = list(parts(table, "k", "t_rot0"))
    figure, axes = style.panels("Flow and density along $x$, after 600 collisions per needle",
                                len(starts), columns=2)
    for panel, (start, part) in zip(axes, starts):
        _, shown = next(parts(part, "seed"))
        panel.plot(shown.x, shown.uy, label=r"$U_y / (T_{\rm tr}/m)^{1/2}$")
        panel.plot(shown.x, shown.uz, label=r"$U_z / (T_{\rm tr}/m)^{1/2}$")
        panel.plot(shown.x, shown.excess, "--", label=r"$\rho / \langle\rho\rangle - 1$")
        style.label(panel, "$x$", "flow and density", style.start_label(*start))
    return figure


def seen_in_plane_of_shear(fields: CellFields) -> tuple:
    """The axis of the gradient and that of the flow of the strongest shear wave; for each cell of
    their plane its middle and its flow along both axes, the first axis fastest."""
    wave = strongest_shear_wave(fields)
    first, second = wave.gradient, wave.along
    mean = fields.flow.mean(axis=3 - first - second)
    if first < second:
        mean = mean.swapaxes(0, 1)  # now [second, first]
    y, x = np.meshgrid(fields.middles(second), fields.middles(first), indexing="ij")
    return (first, second, x.ravel(), y.ravel(), mean[..., first].ravel(),
            mean[..., second].ravel())
