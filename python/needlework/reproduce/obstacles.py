"""Beyond the paper: diffusion of elastic needles among bodies that do not move."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .. import theory
from ..reading import Recording
from ..values import Table
from . import exact, liquid, style
from .course import Measured, mean_of, slope
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns, Point

NEEDLES, SPHERES, POINTS, LIQUID = range(4)
"""The column kind of the data: needles among fixed needles and among fixed spheres, points among
fixed spheres, and needles among each other."""

SETS = {"obstacles-thin": NEEDLES, "obstacles": NEEDLES, "obstacles-dense": NEEDLES,
        "obstacles-large": NEEDLES, "obstacles-spheres": SPHERES, "obstacles-beads": SPHERES,
        "obstacles-beads-dense": SPHERES, "obstacles-points": POINTS,
        **dict.fromkeys(liquid.SETS, LIQUID)}
"""Sets of runs, and of what they are."""

LARGE = "obstacles-large"
"""The set in larger boxes."""

LAGS = (1 / 4, 1 / 2)
"""Shares of the time of a run between which the mean square displacement is a straight line."""

SPEED = {5: 8 / (3 * np.sqrt(np.pi)), 3: 2 / np.sqrt(np.pi)}
"""The mean of sqrt(E) at T = 1, by degrees of freedom."""

KEPT = {5: 12 * (8 / 15)**2 / np.pi, 3: 32 / (9 * np.pi)}
"""<E^(1/2)> <E^(3/2)> / <E>^2 there: D of bodies that keep their energies over that of bodies of one
rate at which velocities are forgotten."""

POINT_SLOPE = 1.33
"""D of points over that of independent collisions is 1 - 1.33(3) n R^3 up to n R^3 = 0.1: by another
program, 250000 paths at each density."""


class Dilute(NamedTuple):
    """Of a body at T = 1 among n fixed ones per volume, over n: the rate of its collisions, exact at
    every density, and that at which its velocity is forgotten at first."""

    rate: float
    decay: float

    @classmethod
    def among_needles(cls, k: float) -> Dilute:
        """Of a thin needle among others as long."""
        return cls._of([(np.sqrt(np.pi / 8), _along(k))])

    @classmethod
    def among_spheres(cls, k: float, radius: float) -> Dilute:
        """Of a thin needle among overlapping spheres, which it meets with its side or an end."""
        area = 2 * np.pi * radius / np.sqrt(2 * np.pi)
        return cls._of([(area, _along(k)), (2 * radius * area, _at_an_end(k))])

    @classmethod
    def of_points(cls, radius: float) -> Dilute:
        """Of a point among spheres."""
        return cls._of([(4 * np.pi * radius**2 / np.sqrt(2 * np.pi), (np.ones(1), np.ones(1)))])

    @classmethod
    def _of(cls, contacts: Sequence[tuple[float, tuple[np.ndarray, np.ndarray]]]) -> Dilute:
        # A collision changes the velocity by 2 V_n / (m a) along the normal, a = 1 + m s^2 / I, and
        # V_n^2 is 2 T a / m in the mean. It forgets half the square of this change, of 3 T / m.
        rate = sum(size * float(weights @ np.sqrt(a)) for size, (a, weights) in contacts)
        decay = sum(4 / 3 * size * float(weights @ (1 / np.sqrt(a)))
                    for size, (a, weights) in contacts)
        return cls(rate, decay)


def _along(k: float) -> tuple[np.ndarray, np.ndarray]:
    x, weights = exact.points(-0.5, 0.5)
    return 1 + 2 * k * x**2, weights


def _at_an_end(k: float) -> tuple[np.ndarray, np.ndarray]:
    c, weights = exact.points(0, 1)
    return 1 + k / 2 * (1 - c**2), weights


class Series(NamedTuple):
    """Points of one kind and radius, by density."""

    name: str
    """As variants of claims have it."""
    density: list[float]
    diffusion: list[list[float]]
    """Of each density the values of all seeds."""


def measure_obstacles(runs: PaperRuns) -> Result:
    """Collision rate and diffusion constant against the density of what is fixed, and in the liquid
    of needles against that of all."""
    result = Result(("kind", "radius", "compared", "density", "count", "rate_exact",
                     "d_uncorrelated", "rate", "rate_error", "d", "d_error", "seeds"))
    series: dict[str, Series] = {}
    for name, kind in SETS.items():
        for point in runs.points(name):
            of = Obstacles.of(point, kind)
            rates, diffusion = zip(*(of.measure(run) for run in point.runs))
            rate, d = mean_of(rates), mean_of(diffusion)
            result.rows.append((kind, of.radius, name == LARGE, of.density, of.count, of.rate,
                                of.diffusion, *rate[:2], *d[:2], point.seeds))
            variant = f"{of.name}, n = {of.density:.4g}"
            if name == LARGE:
                variant += ", large box"
            if kind != LIQUID:
                result.add("obstacles-rate", rate.over(of.rate), variant)
            if kind == POINTS:
                known = of.of_independent * (1 - POINT_SLOPE * of.density * of.radius**3)
                result.add("obstacles-points", d.over(known), variant)
            else:
                result.add("obstacles-diffusion", d.over(of.diffusion), variant)
            if kind != POINTS and name != LARGE:
                found = series.setdefault(of.name, Series(of.name, [], []))
                found.density.append(of.density)
                found.diffusion.append(list(diffusion))
    for each in series.values():
        _add_slopes(result, each)
    return result


def _add_slopes(result: Result, series: Series) -> None:
    """Of neighbours, and the density at which D is least."""
    means = [mean_of(values) for values in series.diffusion]
    for n, (first, second) in enumerate(zip(means[:-1], means[1:])):
        value, error = local_slope(series.density[n:n + 2], (first.value, second.value),
                                   (first.error, second.error))
        result.add("obstacles-slope", Measured(value, error, min(first.seeds, second.seeds)),
                   f"{series.name}, n = {series.density[n]:.4g} to {series.density[n + 1]:.4g}")
    result.add("obstacles-minimum", least_at(series.density, series.diffusion), series.name)


def local_slope(density: Sequence[float], d: Sequence[float],
                error: Sequence[float]) -> tuple[float, float]:
    """d ln D / d ln n between two densities, with its standard error."""
    width = np.log(density[1] / density[0])
    return (float(np.log(d[1] / d[0]) / width),
            float(np.hypot(error[0] / d[0], error[1] / d[1]) / width))


def least_at(density: Sequence[float], diffusion: Sequence[Sequence[float]]) -> Measured:
    """The density at which D is least: the vertex of the parabola through the logarithms of up to
    five points around the least, one for each seed. NaN where D is least at an end."""
    least = int(np.argmin([np.mean(values) for values in diffusion]))
    if least in (0, len(density) - 1):
        return Measured(np.nan, np.nan, len(diffusion[0]))
    near = slice(max(least - 2, 0), least + 3)
    x = np.log(density[near])
    found = []
    for values in zip(*diffusion[near]):
        square, linear, _ = np.polyfit(x, np.log(values), 2)
        found.append(float(np.exp(-linear / (2 * square))))
    return mean_of(found)


class Obstacles(NamedTuple):
    """What is known of a point of a set."""

    kind: int
    name: str
    """As variants of claims have it."""
    radius: float
    """R [L]; of points the sum of both radii; NaN among needles."""
    density: float
    """Of what is fixed; of all needles in the liquid."""
    count: int
    """The same as a number of bodies."""
    rate: float
    """Of collisions of a body that moves, exact."""
    diffusion: float
    """D if velocities were forgotten at one rate, that at first, of each energy."""
    of_independent: float
    """D of points at low density."""

    @classmethod
    def of(cls, point: Point, kind: int) -> Obstacles:
        gas = point.conditions
        if kind == LIQUID:
            return cls(kind, "liquid", np.nan, gas.density, gas.count,
                       liquid.exact_rate(point),
                       float(theory.diffusion(gas.k, gas.density, gas.t_tr).d), np.nan)
        moving, still = gas.scene["species"]
        count, radius = int(still["count"]), still.get("diameter", np.nan) / 2
        density = count / float(np.prod(gas.box))
        if kind == NEEDLES:
            name, dilute = "fixed needles", Dilute.among_needles(gas.k)
        elif kind == SPHERES:
            name = f"fixed spheres, R = {radius:g}"
            dilute = Dilute.among_spheres(gas.k, radius)
        else:
            radius += moving["diameter"] / 2
            name, dilute = "points", Dilute.of_points(radius)
        return cls(kind, name, radius, density, count, density * dilute.rate,
                   KEPT[3 if kind == POINTS else 5] / (density * dilute.decay),
                   np.sqrt(8 / np.pi) / (3 * np.pi * density * radius**2))

    def measure(self, run: FinishedRun) -> tuple[float, float]:
        """Rate of collisions of a body that moves, and D."""
        if self.kind == LIQUID:
            found = liquid.transport(run)
            return found.rate, found.d
        moving = int(run.conditions.scene["species"][0]["count"])
        speed = _speed(run, moving, 3 if self.kind == POINTS else 5)
        rate = run.series.collisions[-1] / (moving * run.series.time[-1])
        lag, square = displacement(run)
        low, high = (share * run.series.time[-1] for share in LAGS)
        chosen = (lag > 0.99 * low) & (lag < 1.01 * high)
        return rate / speed, slope(lag[chosen], square[chosen]) / 6 / speed


def _speed(run: FinishedRun, moving: int, degrees: int) -> float:
    """The mean of sqrt(E), to which rate and D are proportional, over that at T = 1: the energies
    that were drawn stay."""
    with Recording(run.path) as recording:
        last = recording.frames[-1]
        energy = np.sum(last.velocity[:moving]**2, axis=1) / 2
        if degrees == 5:
            inertia = 1 / (2 * run.conditions.k)
            energy += inertia * np.sum(last.angular_velocity[:moving]**2, axis=1) / 2
    return float(np.mean(np.sqrt(energy)) / SPEED[degrees])


def displacement(run: FinishedRun) -> tuple[np.ndarray, np.ndarray]:
    """Lags, and the mean square displacement of the bodies that move, over all starting times."""
    lag, along, across = (run.observable("time_correlation", name)[:, 0]
                          for name in ("lag", "parallel", "perpendicular"))
    there = np.isfinite(lag).any(axis=0)
    return (np.nanmean(lag[:, there], axis=0),
            np.nanmean(along[:, there] + across[:, there], axis=0))


def draw_obstacles(table: Table) -> Figure:
    """D against density among needles and among spheres, local slopes, and D of points."""
    figure, (needles, spheres, slopes, points) = style.panels(
        "Diffusion of elastic needles among bodies that do not move", 4, columns=2, width=4.4,
        height=3.3)
    looks = iter((("o", style.COLOURS[0]), ("s", style.COLOURS[2]), ("^", style.COLOURS[3])))
    for (kind, radius), part in _series(table):
        if kind == POINTS:
            _draw_points(points, part)
            continue
        marker, colour = ("o", style.COLOURS[1]) if kind == LIQUID else next(looks)
        label = ("fixed needles" if kind == NEEDLES else "liquid: all move" if kind == LIQUID
                 else rf"fixed spheres, $R = {radius:g}\,L$")
        panel = spheres if kind == SPHERES else needles
        look = {"color": colour, "marker": marker}
        main = part.compared == 0
        for chosen, fill, name in ((main, colour, label), (~main, "white", "larger box")):
            if chosen.any():
                style.points(panel, part.density[chosen], part.d[chosen], part.d_error[chosen],
                             mfc=fill, label=name, **look)
        panel.plot(part.density[main], part.d_uncorrelated[main], color=colour, linewidth=0.9)
        _draw_slopes(slopes, part, main, look)
    for height, line, at, side, text in (
            (-1, "-", 0.98, "right", "uncorrelated collisions"),
            (0.8, ":", 0.02, "left", "point-like obstacles\nin a plane (another system)")):
        slopes.axhline(height, color="grey", linewidth=0.9, linestyle=line)
        slopes.annotate(text, (at, height), xycoords=("axes fraction", "data"), fontsize=7.5,
                        xytext=(0, -4), textcoords="offset points", va="top", ha=side,
                        color=style.COLOURS[5])
    slopes.set_ylim(-1.4, 1.4)
    lines = [Line2D([], [], color="grey", linewidth=0.9, label="uncorrelated collisions")]
    for panel, title in ((needles, "Among needles"), (spheres, "Among fixed spheres")):
        handles, _ = panel.get_legend_handles_labels()
        panel.legend(handles=handles + lines, fontsize=7.5)
        style.label(panel, "$n L^3$", r"$D / \sqrt{T L^2 / m}$", title, log="xy", legend=False)
    style.label(slopes, "$n L^3$", r"$d \ln D / d \ln n$", "Local slopes, coloured as above",
                log="x", legend=False)
    style.label(points, "$n R^3$", "$D$ / independent collisions", "Points among fixed spheres")
    return figure


def _series(table: Table) -> list[tuple[tuple[float, float], Table]]:
    """By kind and radius, which is NaN for some."""
    named = Table({**table, "radius": np.nan_to_num(table.radius)})
    return list(parts(named, "kind", "radius"))


def _draw_slopes(panel: Axes, part: Table, main: np.ndarray, look: dict[str, str]) -> None:
    density, d, error = (part[name][main] for name in ("density", "d", "d_error"))
    pairs = [slice(n, n + 2) for n in range(len(density) - 1)]
    found = np.array([local_slope(density[at], d[at], error[at]) for at in pairs]).reshape(-1, 2)
    between = np.sqrt(density[1:] * density[:-1])
    style.points(panel, between, found[:, 0], found[:, 1], linestyle="-", linewidth=0.8, **look)


def _draw_points(panel: Axes, part: Table) -> None:
    share = part.density * part.radius**3
    independent = np.sqrt(8 / np.pi) / (3 * np.pi * part.density * part.radius**2)
    style.points(panel, share, part.d / independent, part.d_error / independent,
                 color=style.COLOURS[4], label="measured")
    line = np.linspace(0, 1.05 * share.max())
    panel.plot(line, 1 - POINT_SLOPE * line, color="grey", linewidth=0.9,
               label=rf"known: $1 - {POINT_SLOPE}\,n R^3$")
