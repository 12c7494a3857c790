"""Why theory is off: gases beside kinetic theory, the Boltzmann equation and whole encounters.

Kinetic theory takes velocities to be Gaussian and partners to be uncorrelated. The Boltzmann
equation with single collisions drops the first, that with encounters both, in the limit of low
density.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import theory
from ..values import Table
from . import style
from .course import Measured, cooling_theory, mean_and_error, mean_of, measure, slope
from .dilute import FIRST_TAU, farthest_from_one
from .equation import ENCOUNTERS, SINGLE, Solution, solutions
from .figure import Result, parts
from .ratio import settled_ratio
from .relaxation import differences
from .runs import FinishedRun, PaperRuns, Point

DILUTE = 0.06
"""n L^3 up to which a gas is taken to be in the limit of low density."""

GAUSSIAN, BY_SINGLE, BY_ENCOUNTERS, MEASURED = range(4)
"""The column ``kind`` of tables: whose numbers a row has."""

MOMENTS = {"cumulant_v": "tr", "cumulant_w": "rot", "speeds": "mixed"}
"""Moments of velocities as gases and as the Boltzmann equation name them; 0 for Gaussian ones."""

LABELS = {GAUSSIAN: "kinetic theory", BY_SINGLE: "Boltzmann, single collisions",
          BY_ENCOUNTERS: "Boltzmann, encounters"}

LINES = {GAUSSIAN: {"color": style.COLOURS[5], "linestyle": ":"},
         BY_SINGLE: {"color": style.COLOURS[3], "linestyle": "--"},
         BY_ENCOUNTERS: {"color": style.COLOURS[1]}}

FIT_FROM, FIT_TO = 0.75, 0.2
"""Rates of relaxation are those while theory has these shares of the initial difference of
temperatures left: the same times for all, and none at which the difference is noise."""

TAIL = (4, 16)
"""Collisions of an encounter between which the power law is fitted."""


def measure_relaxation(runs: PaperRuns) -> Result:
    """|T_tr - T_rot| of elastic gases against scaled time, its rate, and moments of velocities."""
    result = Result(("k", "kind", "density", "rate", "rate_error", "tau",
                     *_with_errors("difference", *MOMENTS)))
    gases = runs.points("low-relaxation") + runs.points("low-relaxation-thin")
    solved = {pairs: solutions(runs, "boltzmann-relaxation", pairs)
              for pairs in (SINGLE, ENCOUNTERS)}
    for single, whole in zip(solved[SINGLE], solved[ENCOUNTERS]):
        k, tau = single.conditions.k, single.first.tau
        curve = cooling_theory(single.conditions, tau)
        expected = np.abs(curve.t_tr - curve.t_rot)
        result.add_rows(k, GAUSSIAN, 0.0, 1.0, 0.0, tau, expected,
                        *[0.0] * (1 + 2 * len(MOMENTS)))
        rates = {}
        for kind, point in ((BY_SINGLE, single), (BY_ENCOUNTERS, whole)):
            rates[kind] = _add_relaxation(result, kind, 0.0, point, tau, expected)
            result.add("relaxation-theory", rates[kind], f"{LABELS[kind]}, k = {k:g}")
        for gas in gases:
            if gas.conditions.k != k:
                continue
            density = gas.conditions.density
            variant = f"k = {k:g}, n = {density:.2g}"
            rate = _add_relaxation(result, MEASURED, density, gas, tau, expected)
            result.add("relaxation-theory", rate, f"{variant}, 75 to 20 % left")
            result.add(_claim("relaxation-encounters", density),
                       rate.over_measured(rates[BY_ENCOUNTERS]), variant)
    return result


def draw_relaxation(table: Table) -> Figure:
    """Courses of both k, rates over theory against density, moments of k = 6."""
    figure, axes = style.panels("Elastic relaxation and the Boltzmann equation", 4, columns=2,
                                width=4.6, height=3.1)
    for panel, ((k,), of_k) in zip(axes, parts(table, "k")):
        for look, part in _curves(of_k):
            panel.plot(part.tau, part.difference, **look)
        panel.set_ylim(0.6 * min(table.difference[table.kind == GAUSSIAN]), None)
        style.label(panel, r"$\tau$", r"$|T_{\rm tr} - T_{\rm rot}|$", f"$k = {k:g}$", log="y")
    for number, ((k,), of_k) in enumerate(parts(table, "k")):
        colour = style.COLOURS[number]
        for (kind, density), part in parts(of_k, "kind", "density"):
            rate, error = part.rate[0], part.rate_error[0]
            if kind == MEASURED:
                style.points(axes[2], density, rate, error, color=colour)
            elif kind != GAUSSIAN:
                line = axes[2].axhline(rate, color=colour, linestyle=LINES[kind].get(
                    "linestyle", "-"), linewidth=1.1, label=f"{LABELS[kind]}, $k = {k:g}$")
                axes[2].axhspan(rate - error, rate + error, color=line.get_color(), alpha=0.15,
                                linewidth=0)
    style.label(axes[2], r"$n L^3$", "rate / theory", "Rates: gases (points)", log="x")
    axes[2].set_xlim(0.03, 1.2)
    axes[2].legend(fontsize=7)
    low, high = axes[2].get_ylim()
    axes[2].set_ylim(low, high + 0.5 * (high - low))
    last = list(parts(table, "k"))[-1]
    _draw_moments(axes[3], last[1], log="")
    axes[3].set_title(f"Departure from Gaussian velocities, $k = {last[0][0]:g}$")
    return figure


def measure_cooling(runs: PaperRuns) -> Result:
    """Energy and ratio of temperatures of figure 2 over those of theory, and moments."""
    result = Result(("kind", "density", "tau", *_with_errors("energy", "ratio", *MOMENTS)))
    gases = runs.points("low-dilute")
    solved = {pairs: solutions(runs, "boltzmann-dilute", pairs) for pairs in (SINGLE, ENCOUNTERS)}
    for number, (gas, single, whole) in enumerate(zip(gases, solved[SINGLE], solved[ENCOUNTERS])):
        density, tau = gas.conditions.density, whole.first.tau
        curve = cooling_theory(gas.conditions, tau)
        of_theory = {"energy": curve.energy, "ratio": curve.t_tr / curve.t_rot}
        courses = {MEASURED: gas, BY_ENCOUNTERS: whole}
        if number == 0:  # single collisions know neither density nor contact time
            courses[BY_SINGLE] = single
        values = {}
        for kind, point in courses.items():
            values[kind] = _over_theory(point, tau, of_theory)
            result.add_rows(kind, 0.0 if kind == BY_SINGLE else density, tau,
                            *(column for pair in values[kind].values() for column in pair))
        for name, claim in (("energy", "cooling-encounters"), ("ratio", "ratio-encounters")):
            (value, error), (other, other_error) = values[MEASURED][name], \
                values[BY_ENCOUNTERS][name]
            later = np.isfinite(value) & (tau >= FIRST_TAU)
            errors = value / other * np.hypot(error / value, other_error / other)
            result.add(_claim(claim, density), farthest_from_one(
                (value / other)[later], errors[later], gas.seeds), f"n = {density:.2g}")
    return result


def draw_cooling(table: Table) -> Figure:
    """Energy and ratio of temperatures over theory, and moments."""
    figure, axes = style.panels("Cooling of figure 2 and the Boltzmann equation", 3, width=4.4,
                                height=3.6)
    for panel, name, label in ((axes[0], "energy", "$E$"),
                               (axes[1], "ratio", r"$T_{\rm tr} / T_{\rm rot}$")):
        panel.axhline(1, label=LABELS[GAUSSIAN], **LINES[GAUSSIAN])
        for look, part in _curves(table):
            shown = np.isfinite(part[name]) & (part.tau >= 0.3)
            panel.plot(part.tau[shown], part[name][shown], **look)
            panel.fill_between(part.tau[shown], (part[name] - part[f"{name}_error"])[shown],
                               (part[name] + part[f"{name}_error"])[shown], color=look["color"],
                               alpha=0.12, linewidth=0)
        style.label(panel, r"$\tau$", f"{label} / theory", log="x")
    _draw_moments(axes[2], table, log="x")
    return figure


def measure_ratio(runs: PaperRuns) -> Result:
    """The long-time ratio of temperatures of figure 3 against restitution, k and density."""
    result = Result(("epsilon", "k", "density", "theory", *_with_errors(SINGLE, ENCOUNTERS,
                                                                        "measured")))
    solved = {(point.conditions.epsilon, point.conditions.k, round(point.conditions.density, 6),
               pairs): point for pairs in (SINGLE, ENCOUNTERS)
              for point in solutions(runs, "boltzmann-ratio", pairs)}
    for gas in runs.points("low-ratio"):
        epsilon, k = gas.conditions.epsilon, gas.conditions.k
        density = gas.conditions.density
        c = float(theory.ratio(epsilon, k))
        measured = measure(gas, settled_ratio)
        of = {pairs: measure(solved[epsilon, k, round(density, 6), pairs], settled_ratio)
              for pairs in (SINGLE, ENCOUNTERS)}
        result.rows.append((epsilon, k, density, c, *of[SINGLE][:2], *of[ENCOUNTERS][:2],
                            *measured[:2]))
        variant = f"epsilon = {epsilon:g}, k = {k:g}, n = {density:.2g}"
        result.add("ratio-surface", measured.over(c), variant)
        result.add(_claim("c-encounters", density), measured.over_measured(of[ENCOUNTERS]), variant)
    return result


def draw_ratio(table: Table) -> Figure:
    """Ratios over those of theory against restitution, a panel for each k."""
    figure, axes = style.panels(r"$T_{\rm tr} / T_{\rm rot}$ of figure 3 and the Boltzmann "
                                "equation", len(set(table.k)), width=4.4, height=3.4)
    for panel, ((k,), of_k) in zip(axes, parts(table, "k")):
        panel.axhline(1, label=LABELS[GAUSSIAN], **LINES[GAUSSIAN])
        for number, ((density,), part) in enumerate(parts(of_k, "density")):
            if density == table.density.min():
                for kind, name in ((BY_SINGLE, SINGLE), (BY_ENCOUNTERS, ENCOUNTERS)):
                    panel.errorbar(part.epsilon, part[name] / part.theory,
                                   part[f"{name}_error"] / part.theory, label=LABELS[kind],
                                   **LINES[kind])
            style.points(panel, part.epsilon + 0.004 * (number - 1), part.measured / part.theory,
                         part.measured_error / part.theory, color=_colour(number),
                         label=f"gas, $n = {density:.2g}$")
        style.label(panel, r"$\epsilon$", r"$T_{\rm tr} / T_{\rm rot}$ / theory", f"$k = {k:g}$")
    return figure


def measure_encounters(runs: PaperRuns) -> Result:
    """How many collisions encounters in elastic equilibrium have at least."""
    result = Result(("k", "collisions", *_with_errors("share")))
    for point in solutions(runs, "boltzmann-encounters", ENCOUNTERS):
        k = point.conditions.k
        shares, errors = mean_and_error([_shares(run) for run in point.runs])
        numbers = np.arange(1, len(shares) + 1)
        result.add_rows(k, numbers, shares, errors)
        variant = f"k = {k:g}"
        result.add("encounter-collisions", measure(point, _collisions_per_encounter), variant)
        result.add("encounter-not-first", measure(point, _met_before), variant)
        result.add("encounter-balance", measure(
            point, lambda run: _met_before(run) - 1 + 1 / _collisions_per_encounter(run)), variant)
        fitted = slice(TAIL[0] - 1, TAIL[1])
        result.add("encounter-exponent", measure(point, lambda run: slope(
            np.log(numbers[fitted]), np.log(_shares(run)[fitted]))), variant)
    return result


def draw_encounters(table: Table) -> Figure:
    """Shares beside the power law."""
    figure, (axes,) = style.panels("Collisions of an encounter", 1, width=5.0, height=3.6)
    for (k,), part in parts(table, "k"):
        style.points(axes, part.collisions, part.share, part.share_error, label=f"$k = {k:g}$")
    m = np.array([2.0, 32.0])
    axes.plot(m, 1.3 * m**-3, color=style.COLOURS[5], linestyle="--", label="$m^{-3}$")
    style.label(axes, "collisions $m$", "share of encounters with $m$ or more", log="xy")
    return figure


def _with_errors(*names: str) -> Iterator[str]:
    for name in names:
        yield from (name, f"{name}_error")


def _claim(name: str, density: float) -> str:
    """Of the dilute limit, or of what is denser."""
    return name if density <= DILUTE else f"{name}-denser"


def _moment(run: FinishedRun | Solution, name: str, tau: np.ndarray) -> np.ndarray:
    """A moment at scaled times; of a run linear between its samples, NaN outside."""
    if isinstance(run, Solution):
        return run.excess(MOMENTS[name])
    return np.interp(tau, run.tau, run.observable("velocity_moments", name), left=np.nan,
                     right=np.nan)


def _at(run: FinishedRun | Solution, values: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Positive values at scaled times, on straight lines of logarithms between samples."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.exp(np.interp(tau, run.tau, np.log(values), left=np.nan, right=np.nan))


def _add_relaxation(result: Result, kind: int, density: float, point: Point, tau: np.ndarray,
                    expected: np.ndarray) -> Measured:
    """Adds a course; its rate over that of theory by the same fit."""
    courses = [_at(run, differences(run), tau) for run in point.runs]
    share = expected / expected[0]
    fitted = (share <= FIT_FROM) & (share >= FIT_TO)
    rate = mean_of([-slope(tau[fitted], np.log(course[fitted])) for course in courses]).over(
        -slope(tau[fitted], np.log(expected[fitted])))
    columns = [mean_and_error(courses)]
    columns += [mean_and_error([_moment(run, name, tau) for run in point.runs])
                for name in MOMENTS]
    result.add_rows(point.conditions.k, kind, density, rate.value, rate.error, tau,
                    *(column for pair in columns for column in pair))
    return rate


def _over_theory(point: Point, tau: np.ndarray, of_theory: dict[str, np.ndarray]
                 ) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Means with errors at scaled times, energies and ratios over those of theory."""
    courses = {"energy": [_at(run, run.energy, tau) for run in point.runs],
               "ratio": [_at(run, run.series.t_tr / run.series.t_rot, tau) for run in point.runs]}
    out = {name: mean_and_error(np.array(courses[name]) / of_theory[name]) for name in courses}
    return out | {name: mean_and_error([_moment(run, name, tau) for run in point.runs])
                  for name in MOMENTS}


def _curves(table: Table) -> Iterator[tuple[dict, Table]]:
    """The courses in a table with their looks. Of encounters, which differ between densities by the
    contact time only, that of the lowest density."""
    densities = sorted(set(table.density[table.kind == MEASURED]))
    for (kind, density), part in parts(table, "kind", "density"):
        if kind == MEASURED:
            yield {"color": _colour(densities.index(density)), "marker": "o", "markersize": 2.5,
                   "linewidth": 0.8, "label": f"gas, $n = {density:.2g}$"}, part
        elif kind != BY_ENCOUNTERS or density in (0.0, densities[0]):
            yield {"label": LABELS[int(kind)], **LINES[int(kind)]}, part


def _draw_moments(axes: Axes, table: Table, log: str) -> None:
    """Moments of the most dilute gas as points, by encounters as lines."""
    density = table.density[table.kind == MEASURED].min()
    names = {"cumulant_v": "$v^4$", "cumulant_w": r"$\omega^4$", "speeds": r"$v^2 \omega^2$"}
    for number, (name, label) in enumerate(names.items()):
        colour = style.COLOURS[number]
        for (kind, of), part in parts(table, "kind", "density"):
            shown = np.isfinite(part[name]) & (part.tau > 0)
            x, y, error = (part[column][shown] for column in ("tau", name, f"{name}_error"))
            if kind == MEASURED and of == density:
                style.points(axes, x, y, error, color=colour, label=f"{label}, gas, $n = {of:.2g}$")
            elif kind == BY_ENCOUNTERS and of in (0.0, density):
                axes.plot(x, y, color=colour, label=f"{label}, encounters")
            elif kind == BY_SINGLE:
                axes.plot(x, y, color=colour, linestyle="--", label=f"{label}, single")
    style.label(axes, r"$\tau$", "excess over Gaussian", log=log)
    # Of needles that start without rotation the excess of w^4 begins a hundred times above the rest.
    if "x" in log:
        axes.set_yscale("symlog", linthresh=0.2, linscale=2)
    axes.legend(fontsize=7, ncols=2)


def _colour(number: int) -> str:
    return (style.COLOURS[0], style.COLOURS[2], style.COLOURS[4])[number % 3]


def _counts(run: Solution) -> np.ndarray:
    return np.array(run.values["encounters_of"], dtype=float)


def _shares(run: Solution) -> np.ndarray:
    """Of encounters with m collisions or more, from m = 1 on."""
    counts = _counts(run)
    return counts[::-1].cumsum()[::-1] / counts.sum()


def _collisions_per_encounter(run: Solution) -> float:
    """Its mean. In equilibrium, collisions per needle are 2 collisions / N from the start on."""
    return float(run.values["collisions_per_needle"][-1] * run.values["needles"] / 2
                 / run.values["encounters"])


def _met_before(run: Solution) -> float:
    """The share of contacts that are not the first of their pair."""
    met = run.values["met_before"]
    return float(met / (met + run.values["encounters"]))
