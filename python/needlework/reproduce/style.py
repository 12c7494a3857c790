"""The look of the pictures: Matplotlib figures that become SVG with text as text."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

COLOURS = ("#1f5fa8", "#d1495b", "#2a8a5f", "#e0902f", "#7a4fa3", "#4c4c4c")
"""Of curves, in this order; distinct for the colour-blind by their lightness too."""

_SETTINGS = {
    "figure.facecolor": "white", "font.size": 9.0, "axes.titlesize": 9.5, "axes.grid": True,
    "grid.color": "#e4e4e4", "grid.linewidth": 0.6, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
    "legend.fontsize": 8.5, "lines.linewidth": 1.4, "lines.markersize": 3.5,
    "axes.prop_cycle": matplotlib.cycler(color=COLOURS),
    # Text stays text, which browsers can find and which is smaller, and the same data make the
    # same bytes.
    "svg.fonttype": "none", "svg.hashsalt": "needlework", "mathtext.fontset": "dejavusans",
}


def shade(share: float) -> tuple[float, ...]:
    """Of curves of a quantity that grows, from its least (0) to its greatest value (1)."""
    return tuple(matplotlib.colormaps["viridis"](0.92 * share))


def styled() -> AbstractContextManager[Any]:
    """While it lasts, figures are made and drawn in this look."""
    return matplotlib.rc_context(_SETTINGS)


def panels(title: str, count: int, *, columns: int | None = None, width: float = 3.6,
           height: float = 2.9) -> tuple[Figure, list[Axes]]:
    """A figure with so many axes in rows, each of a size in inches."""
    columns = min(count, columns or count)
    rows = -(-count // columns)
    figure = Figure(figsize=(columns * width, rows * height + 0.3), layout="constrained")
    figure.suptitle(title, fontsize=11)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for unused in axes[count:]:
        unused.remove()
    return figure, list(axes[:count])


def points(axes: Axes, x: Any, y: Any, error: Any = None, *, marker: str = "o",
           **look: Any) -> None:
    """Measured points, with their standard errors where they are given."""
    axes.errorbar(x, y, error, fmt=marker, capsize=1.5, elinewidth=0.8, **look)


def band(axes: Axes, x: Any, y: Any, error: Any, **look: Any) -> None:
    """A mean over seeds as a line, within a standard error as a band."""
    line, = axes.plot(x, y, **look)
    axes.fill_between(x, y - error, y + error, color=line.get_color(), alpha=0.18, linewidth=0)


def edges(middles: Any) -> np.ndarray:
    """The borders of equal bins or cells with these middles."""
    middles = np.unique(middles)
    width = middles[1] - middles[0] if len(middles) > 1 else 1.0
    return np.append(middles - width / 2, middles[-1] + width / 2)


def histogram(axes: Axes, middles: Any, values: Any, **look: Any) -> None:
    """The values of equal bins as steps."""
    axes.stairs(values, edges(middles), linewidth=1.4, **look)


def label(axes: Axes, x: str, y: str, title: str = "", *, log: str = "",
          legend: bool = True) -> None:
    """Labels, a legend, and logarithmic axes, those that ``log`` names: "x", "y" or "xy"."""
    axes.set(xlabel=x, ylabel=y, title=title)
    if "x" in log:
        axes.set_xscale("log")
    if "y" in log:
        axes.set_yscale("log")
    if legend:
        axes.legend()


def start_label(k: float, t_rot0: float) -> str:
    """A start of the dense gas, for legends and titles."""
    return rf"$k = {k:g},\ T_{{\rm rot}}(0) = {t_rot0:g}$"
