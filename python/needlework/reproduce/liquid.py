"""Beyond the paper: diffusion in the liquid of elastic needles, from correlations in time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from .. import theory
from ..values import Table, Values
from . import style
from .course import Measured, mean_and_error, mean_of, measure, slope
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns, Point

LAST = 1 / 4
"""Share of the time of a run up to which lags are used, so that each has several starting times."""

NOISE = 0.01
"""Share of its start below which a correlation of velocities is taken for noise."""

REVERSED = -0.05
"""Share of its start below which a correlation has changed its sign and is not noise."""

SEPARATED = 12.0
"""n L^3 from which on directors turn much more slowly than angular velocities change: D_R is the
rate at which <u(0).u(t)> falls, below that the integral of <w(0).w(t)>."""

TURNED = (0.7, 0.2)
"""<u(0).u(t)> between which its rate is taken, if it falls so far."""

ENSKOG_UP_TO, DOI_EDWARDS_UP_TO = 8.0, 48.0
"""n L^3 up to which Frenkel and Maguire find that Enskog theory works, and D_R ~ n^-2."""

SHORT = 0.1
"""Lags, in times of the decay of velocities, that are short enough for its first order."""

NAMES = ("rate", "d", "d_parallel", "d_perpendicular", "d_rot", "anisotropy")
"""What is measured; the columns with errors."""

SHOWN = ("velocity_parallel", "velocity_perpendicular", "angular_velocity", "p1", "p2", "parallel",
         "perpendicular")
"""Correlation functions of the second figure, and displacements."""

SETS = ("liquid-thin", "liquid", "liquid-dense")
"""Runs of as many needles at all densities."""

OTHER_SIZES = ("liquid-small", "liquid-large")


def measure_liquid(runs: PaperRuns) -> Result:
    """Collision rate and diffusion constants against density, beside those without correlations."""
    result = Result(("density", "count", "compared", "rate_exact", "d_uncorrelated", "d_rot_uncorrelated",
                     "seeds", *(column for name in NAMES for column in (name, f"{name}_error"))))
    points = [Studied.of(point) for name in SETS for point in runs.points(name)]
    others = [Studied.of(point) for name in OTHER_SIZES for point in runs.points(name)]
    for number, (point, of_runs) in enumerate(points + others):
        gas = point.conditions
        measured = {name: mean_of([run[name] for run in of_runs]) for name in NAMES}
        exact, free = exact_rate(point), theory.diffusion(gas.k, gas.density, gas.t_tr)
        result.rows.append((gas.density, gas.count, number >= len(points), exact, float(free.d), float(free.d_rot),
                            point.seeds, *(number for name in NAMES
                                           for number in measured[name][:2])))
        variant = f"n = {gas.density:.4g}"
        if gas.count != points[0].point.conditions.count:
            variant += f", N = {gas.count}"
        result.add("liquid-rate", measured["rate"].over(exact), variant)
        is_thin = gas.density < ENSKOG_UP_TO * (1 - 1e-6)
        for name, value in (("d", free.d), ("d_rot", free.d_rot)):
            result.add(f"liquid-{name.replace('_', '-')}-{'thin' if is_thin else 'dense'}",
                       measured[name].over(float(value)), variant)
        is_thinnest = gas.density < 1.5
        result.add(f"liquid-anisotropy-{'thin' if is_thinnest else 'dense'}",
                   measured["anisotropy"], variant)
    middle = [each for each in points if 0.99 * ENSKOG_UP_TO < each.point.conditions.density
              < 1.01 * DOI_EDWARDS_UP_TO]
    dense = [each for each in points if each.point.conditions.density > 0.99 * DOI_EDWARDS_UP_TO]
    for name, claim in (("d_rot", "rotation"), ("d_parallel", "along"),
                        ("d_perpendicular", "across")):
        for claimed, chosen in ((f"liquid-exponent-{claim}", middle),
                                (f"liquid-exponent-{claim}-dense", dense)):
            first, last = (each.point.conditions.density for each in (chosen[0], chosen[-1]))
            result.add(claimed, _exponent(chosen, name), f"n = {first:.3g} to {last:.3g}")
    return result


def draw_liquid(table: Table) -> Figure:
    """Diffusion over that without correlations, and along and across, against density."""
    figure, (over, both, turning) = style.panels("Diffusion in the liquid of elastic needles", 3,
                                                 width=4.0, height=3.4)
    main = next(part for (compared,), part in parts(table, "compared") if not compared)
    for number, (name, label) in enumerate((("d", "$D$"), ("d_rot", "$D_R$"))):
        free = f"{name}_uncorrelated"
        colour = style.COLOURS[number]
        style.points(over, main.density, main[name] / main[free], main[f"{name}_error"] / main[free],
                     color=colour, label=label)
        for (compared, count), part in parts(table, "compared", "count"):
            if not compared:
                continue
            style.points(over, part.density * (0.93 if count < main["count"][0] else 1.07),
                         part[name] / part[free], part[f"{name}_error"] / part[free], color=colour,
                         mfc="white", label=f"{label}, $N = {count:.0f}$")
    over.axhline(1, color="grey", linewidth=0.8)
    style.label(over, "$n L^3$", "over uncorrelated collisions", log="xy")
    for number, (name, label) in enumerate((("d_parallel", r"$D_\parallel$"),
                                            ("d_perpendicular", r"$D_\perp$"), ("d", "$D$"))):
        style.points(both, main.density, main[name], main[f"{name}_error"],
                     color=style.COLOURS[(2, 3, 0)[number]], label=label)
    both.plot(main.density, main.d_uncorrelated, color=style.COLOURS[0], linewidth=0.9,
              label="$D$ without correlations")
    style.label(both, "$n L^3$", r"$D / \sqrt{T L^2 / m}$", log="xy")
    style.points(turning, main.density, main.d_rot, main.d_rot_error, color=style.COLOURS[1],
                 label="$D_R$")
    turning.plot(main.density, main.d_rot_uncorrelated, color=style.COLOURS[1], linewidth=0.9,
                 label="without correlations")
    start = int(np.argmin(np.abs(main.density - 24)))
    shown = main.density >= 7
    turning.plot(main.density[shown], main.d_rot[start] * (main.density[shown] / 24) ** -2.0,
                 color=style.COLOURS[5], linestyle="--", label="$n^{-2}$")
    style.label(turning, "$n L^3$", r"$D_R / \sqrt{T / m L^2}$", log="xy")
    return figure


def measure_correlations(runs: PaperRuns) -> Result:
    """Correlation functions of velocities and directors, and displacements, against time."""
    result = Result(("density", "lag",
                     *(column for name in SHOWN for column in (name, f"{name}_error"))))
    for name in SETS:
        for point in runs.points(name):
            curves = [correlations(run) for run in point.runs]
            columns = [mean_and_error([curve[name] for curve in curves]) for name in SHOWN]
            result.add_rows(point.conditions.density, curves[0].lag,
                            *(column for pair in columns for column in pair))
            if _decay(point) * curves[0].lag[1] <= SHORT:
                result.add("liquid-ballistic", _ballistic(point),
                           f"n = {point.conditions.density:.4g}")
    return result


def draw_correlations(table: Table) -> Figure:
    """Against collisions per needle or time; a colour for each of some densities."""
    figure, axes = style.panels("Correlations in time in the liquid of elastic needles", 4,
                                columns=2, width=4.6, height=3.2)
    chosen = [part for number, part in enumerate(parts(table, "density")) if number % 2 == 0]
    for number, ((density,), part) in enumerate(chosen):
        look = {"color": style.COLOURS[number % len(style.COLOURS)], "label": f"$n = {density:.0f}$"}
        after = part.lag > 0
        for panel, name in ((axes[0], "velocity_parallel"), (axes[1], "angular_velocity")):
            panel.plot(part.lag[after], part[name][after] / part[name][0], **look)
        axes[0].plot(part.lag[after], part.velocity_perpendicular[after]
                     / part.velocity_perpendicular[0], color=look["color"], linestyle="--")
        axes[2].plot(part.lag[after], part.p1[after], **look)
        axes[3].plot(part.lag[after], part.parallel[after] / part.lag[after], **look)
        axes[3].plot(part.lag[after], part.perpendicular[after] / 2 / part.lag[after],
                     color=look["color"], linestyle="--")
    for panel, label, title in (
            (axes[0], "$C(t) / C(0)$", "Velocity along (lines) and across (dashes)"),
            (axes[1], r"$\langle \omega(0) \omega(t) \rangle / \langle \omega^2 \rangle$",
             "Angular velocity"),
            (axes[2], "$P_1$", "Directors"),
            (axes[3], r"$\langle \Delta r^2 \rangle / t$", "Displacement along (lines) and across, "
             "each direction (dashes)")):
        style.label(panel, r"$t \sqrt{T / m L^2}$", label, title,
                    log="xy" if panel is axes[3] else "x", legend=panel is axes[2])
        panel.title.set_fontsize(9)
    return figure


class Correlations(Values):
    """Of one run, means over all starting times, at lags from 0 to a share of its time."""


def correlations(run: FinishedRun) -> Correlations:
    """Those that the run has recorded."""
    def mean(name: str) -> np.ndarray:
        rows = run.observable("time_correlation", name)
        there = np.isfinite(rows).any(axis=0)
        return np.nanmean(rows[:, there], axis=0)

    lag = mean("lag")
    used = lag <= LAST * run.series.time[-1] * (1 + 1e-9)
    names = (*SHOWN, "velocity")
    return Correlations({"lag": lag[used], **{name: mean(name)[used] for name in names}})


class Transport(Values):
    """The numbers of NAMES of one run."""


def transport(run: FinishedRun) -> Transport:
    """Collision rate, diffusion constants and anisotropy."""
    curve, time = correlations(run), run.series.time[-1]
    # Where velocities have long been forgotten, further lags would add noise only.
    used = curve.lag <= 2 * curve.lag[_end_of_memory(curve.velocity) - 1]
    lag, along, across = (values[used] for values in (
        curve.lag, curve.velocity_parallel, curve.velocity_perpendicular))
    turns = (along < REVERSED * along[0]).any()
    # Two directions across. Their correlation becomes negative and has no tail of its own. So does
    # that along the director in thin gases, where needles turn round before they collide.
    return Transport({
        "rate": run.collisions[-1] / time,
        "d": _memory(curve.lag, curve.velocity) / 3,
        "d_parallel": (_integral(lag, along) if turns
                       else _memory(curve.lag, curve.velocity_parallel)),
        "d_perpendicular": _integral(lag, across) / 2,
        "d_rot": _rotational_diffusion(run, curve),
        "anisotropy": float(np.max(curve.parallel[1:] / (curve.perpendicular[1:] / 2))),
    })


class Studied(NamedTuple):
    """A point with the numbers of its runs."""

    point: Point
    of_runs: list[Transport]

    @classmethod
    def of(cls, point: Point) -> Studied:
        """Reads the runs of a point."""
        return cls(point, [transport(run) for run in point.runs])


def _rotational_diffusion(run: FinishedRun, curve: Correlations) -> float:
    gas = run.conditions
    if gas.density < SEPARATED:
        # Longer than any memory; further on there is only noise.
        decay = float(theory.diffusion(gas.k, gas.density, gas.t_tr).angular_velocity_decay)
        used = curve.lag <= 20 / decay
        return _integral(curve.lag[used], curve.angular_velocity[used]) / 2
    high, low = TURNED
    turned = (curve.p1 <= high) & (curve.p1 >= low)
    chosen = turned if np.count_nonzero(turned) >= 3 else _late(curve.lag) & (curve.p1 > 0)
    return -slope(curve.lag[chosen], np.log(curve.p1[chosen])) / 2


def _integral(x: np.ndarray, y: np.ndarray) -> float:
    """By cubic polynomials through the points, with slopes of the parabolas through three of them.
    Distances between lags grow with the lag, so that the trapezoidal rule gives an exponential
    function 0.4 % too much."""
    slopes = np.gradient(y, x, edge_order=2)
    return float(np.sum(np.diff(x) * (y[1:] + y[:-1]) / 2 - np.diff(x)**2 * np.diff(slopes) / 12))


def _late(lag: np.ndarray) -> np.ndarray:
    """Which lags are in the second half, where memory is taken to fall exponentially."""
    return lag >= lag[-1] / 2


def _end_of_memory(correlation: np.ndarray) -> int:
    """How many lags there are before the first at which only noise is left."""
    noise = correlation < NOISE * correlation[0]
    return int(np.argmax(noise)) if noise.any() else len(correlation)


def _memory(lag: np.ndarray, correlation: np.ndarray) -> float:
    """The integral of what decays to 0 from above. It is taken until only noise is left, or over all
    lags, and continued by an exponential function with the rate of the last factor of ten, or of the
    second half of all lags: without that, it would end up to a percent too early."""
    end = _end_of_memory(correlation)
    is_over = end < len(lag)
    lag, correlation = lag[:end], correlation[:end]
    late = correlation < 10 * NOISE * correlation[0] if is_over else _late(lag)
    rate = -slope(lag[late], np.log(correlation[late]))
    last = np.exp(np.mean(np.log(correlation[late])) - rate * (lag[-1] - lag[late].mean()))
    return _integral(lag, correlation) + float(last / rate)


def exact_rate(point: Point) -> float:
    """Collisions of a needle per time in equilibrium, of so many needles with this energy."""
    gas = point.conditions
    energy = gas.count * (1.5 * gas.t_tr + gas.t_rot)
    return float(theory.equilibrium_rate(gas.k, gas.count, float(np.prod(gas.box)), energy))


def _exponent(points: Sequence[Studied], name: str) -> Measured:
    """d ln of a number / d ln n, a straight line for each seed."""
    densities = np.log([each.point.conditions.density for each in points])
    by_seed = zip(*([run[name] for run in each.of_runs] for each in points))
    return mean_of([slope(densities, np.log(values)) for values in by_seed])


def _ballistic(point: Point) -> Measured:
    """Displacement at the shortest lag over that of velocities that decay exponentially at the rate
    that is exact at first."""
    def ratio(run: FinishedRun) -> float:
        curve = correlations(run)
        t = curve.lag[1]
        x = _decay(point) * t
        left = 2 * (x + np.expm1(-x)) / x**2
        return (curve.parallel[1] + curve.perpendicular[1]) / (3 * point.conditions.t_tr * t**2
                                                               * left)

    return measure(point, ratio)


def _decay(point: Point) -> float:
    """Of velocities at first, which is exact."""
    gas = point.conditions
    return float(theory.diffusion(gas.k, gas.density, gas.t_tr).velocity_decay)
