"""Figure 8, directors and velocities, and alignment inside clusters beyond the paper."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ..reading import Frame, Recording
from ..values import Table
from . import style
from .cells import DENSE_EXCESS, places_in_cells
from .course import SHOWN_BOTH_WAYS, SHOWN_COLLISIONS, mean_of, measure
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns


def measure_alignment(runs: PaperRuns) -> Result:
    """Histograms of Q = 3 (u . v/|v|)^2 - 1 over all needles and seeds, at the start and after
    600 collisions per needle, beside the law of random directors."""
    result = Result(("k", "t_rot0", "q", "start", "after", "random"))
    for point in runs.points("dense"):
        gas = point.conditions
        borders = point.first.observable("alignment", "borders")
        counts = [_counts(run, 0.0, SHOWN_COLLISIONS) for run in point.runs]
        start, after = np.sum(counts, axis=0)
        widths = np.diff(borders)
        result.add_rows(gas.k, gas.t_rot, (borders[1:] + borders[:-1]) / 2,
                        start / start.sum() / widths, after / start.sum() / widths,
                        _random_shares(borders) / widths)
        for collisions in SHOWN_BOTH_WAYS:
            at = f"{gas.start}, at {collisions:g}"
            result.add("velocity-alignment", measure(
                point, lambda run: _mean_q(_counts(run, collisions)[0], borders)), at)
            result.add("global-order", measure(
                point, lambda run: _nematic_order(run, collisions)), at)
    return result


def draw_alignment(table: Table) -> Figure:
    """Both histograms and the law of random directors, for each start."""
    starts = list(parts(table, "k", "t_rot0"))
    figure, axes = style.panels(r"Directors and velocities: $Q = 3\,(u \cdot v/|v|)^2 - 1$",
                                len(starts), columns=2)
    for panel, (start, part) in zip(axes, starts):
        style.histogram(panel, part.q, part.start, label="start", color=style.COLOURS[0])
        style.histogram(panel, part.q, part.after, label="after 600", color=style.COLOURS[1])
        panel.plot(part.q, part.random, color=style.COLOURS[2], label="random")
        style.label(panel, "$Q$", "probability density", style.start_label(*start), log="y")
    return figure


def _counts(run: FinishedRun, *collisions: float) -> np.ndarray:
    """Needles in the bins of Q at the samples nearest to so many collisions per needle."""
    return run.observable("alignment", "along_velocity")[[*map(run.sample_near, collisions)]]


def _random_shares(borders: np.ndarray) -> np.ndarray:
    """Shares of random directors in bins of Q: sqrt((Q + 1) / 3) of them lie below Q."""
    return np.diff(np.sqrt((borders + 1) / 3))


def _mean_q(counts: np.ndarray, borders: np.ndarray) -> float:
    """The mean of Q by its histogram, less that of random directors by the same bins."""
    middles = (borders[1:] + borders[:-1]) / 2
    return float(middles @ (counts / counts.sum() - _random_shares(borders)))


def _nematic_order(run: FinishedRun, collisions: float) -> float:
    """The largest eigenvalue of the order tensor of all needles."""
    tensor = run.observable("alignment", "order_tensor")[run.sample_near(collisions)]
    return float(np.linalg.eigvalsh(tensor.reshape(3, 3))[-1])


class Alignment(NamedTuple):
    """Order in the dense cells of a frame and in the others."""

    dense_share: float
    """Needles in dense cells."""
    dense_q: float
    """Mean of Q along the velocity in dense cells."""
    other_q: float
    """The same elsewhere."""
    dense_p2: float
    """Mean of P2 = (3 (u . u')^2 - 1) / 2 over pairs of needles of one cell, in dense cells. That
    is the square of the nematic order of a cell on average, and vanishes for random directors
    however few there are."""
    other_p2: float
    """The same elsewhere."""


def measure_clusters(runs: PaperRuns) -> Result:
    """Order inside clusters and elsewhere, in the frames nearest to 600 collisions per needle."""
    result = Result(("k", "t_rot0", "seed", "frame_time", *Alignment._fields))
    for point in runs.points("dense"):
        gas, found = point.conditions, []
        for run in point.runs:
            with Recording(run.path) as recording:
                frame = frame_near(run, recording, SHOWN_COLLISIONS)
                found.append(_alignment_in_cells(frame, gas.cells))
                result.rows.append((gas.k, gas.t_rot, run.seed, frame.time, *found[-1]))
        result.add("cluster-velocity-alignment",
                   mean_of([one.dense_q - one.other_q for one in found]), gas.start)
        result.add("cluster-order",
                   mean_of([one.dense_p2 - one.other_p2 for one in found]), gas.start)
    return result


def draw_clusters(table: Table) -> Figure:
    """Means over seeds, for each start."""
    figure, axes = style.panels("Alignment inside clusters", 2, width=4.2)
    starts = list(parts(table, "k", "t_rot0"))
    for panel, name in zip(axes, ("q", "p2")):
        for shift, where in ((-0.06, "dense"), (0.06, "other")):
            means = [mean_of(part[f"{where}_{name}"]) for _, part in starts]
            style.points(panel, np.arange(len(starts)) + shift, [mean.value for mean in means],
                         [mean.error for mean in means], label=f"{where} cells")
        panel.set_xticks(range(len(starts)), [f"{k:g}, {t_rot0:g}" for (k, t_rot0), _ in starts])
    x = r"start: $k$, $T_{\rm rot}(0)$"
    style.label(axes[0], x, r"$\langle Q \rangle$", "Along the velocity")
    style.label(axes[1], x, r"$\langle P_2 \rangle$", "Among needles of a cell")
    return figure


def frame_near(run: FinishedRun, recording: Recording, collisions: float) -> Frame:
    """The frame nearest in time to the sample nearest to so many collisions per needle."""
    time = run.series.time[run.sample_near(collisions)]
    return recording.frames[int(np.argmin(np.abs(recording.frames.time - time)))]


def _alignment_in_cells(frame: Frame, cells: tuple[int, int, int]) -> Alignment:
    director, velocity = frame.orientation, frame.velocity
    place, size = places_in_cells(frame.position, frame.box, cells), int(np.prod(cells))
    count = np.bincount(place, minlength=size)
    along = np.sum(director * velocity, axis=1)**2 / np.sum(velocity**2, axis=1)
    q = np.bincount(place, 3 * along - 1, size)
    # Sums over the needles of a cell of 3/2 u u - 1/2; the square of that is the sum of P2 over
    # all pairs, with that of each needle with itself, 1.
    order = np.array([[np.bincount(place, 1.5 * director[:, a] * director[:, b] - 0.5 * (a == b),
                                   size) for a in range(3)] for b in range(3)])
    p2 = 2 / 3 * np.sum(order**2, axis=(0, 1)) - count
    pairs = count * (count - 1)
    dense = count > (1 + DENSE_EXCESS) * len(place) / size
    means = [sums[where].sum() / numbers[where].sum()
             for sums, numbers in ((q, count), (p2, pairs)) for where in (dense, ~dense)]
    return Alignment(count[dense].sum() / len(place), *means)
