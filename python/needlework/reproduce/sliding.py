"""Sliding contact in place of the t_c rule: what the rule tends to, and the runs of the paper."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from .. import theory
from ..values import Table
from . import style
from .causes import energy_over_theory
from .course import (SHOWN_COLLISIONS, at_collisions, cooling_theory, late_ratio, mean_and_error,
                     mean_of, measure)
from .dense import (curve, curve_places, draw_growth, flow_order_growth, log_over_theory,
                    second_moment)
from .dilute import FIRST_TAU, LATE_TAU
from .figure import Result, parts
from .runs import FinishedRun, PaperRuns, Point

class Case(NamedTuple):
    """A point of the runs with sliding contact or with the t_c rule."""

    point: Point
    tc_relative: float
    """Contact time [mean free times]; 0 for sliding contact."""
    elastic_strikes: bool
    """Of sliding contact."""

    @property
    def name(self) -> str:
        """For variants of claims and legends."""
        if self.tc_relative:
            return f"t_c = {self.tc_relative:g} mean free times"
        return "elastic strikes" if self.elastic_strikes else "own strikes"


def measure_limit(runs: PaperRuns) -> Result:
    """Energies by the t_c rule, and with sliding contact and the needles' own strikes, over those
    with sliding contact and elastic strikes, of the same seeds at the same times, and numbers of
    collisions."""
    result = Result(("epsilon", "tc_relative", "tau", "energy_over_sliding", "error",
                     "collisions_over_sliding"))
    for epsilon, cases in _cases_by_epsilon(runs):
        reference = next(case.point for case in cases if case.elastic_strikes)
        last = min(len(run.tau) for case in cases for run in case.point.runs) - 1
        tau = reference.first.tau[1:last]
        shown, late = tau >= FIRST_TAU, tau >= tau[-1] / 10
        shortest = min(case.tc_relative for case in cases if case.tc_relative)
        for case in cases:
            if case.point is reference:
                continue
            ratios = _over(case.point, reference, lambda run: run.energy[1:last])
            price = mean_of(_over(case.point, reference, lambda run: run.collisions[-1]))
            result.add_rows(epsilon, case.tc_relative, tau[shown],
                            *mean_and_error([ratio[shown] for ratio in ratios]), price.value)
            name = f"epsilon = {epsilon:g}, {case.name}"
            energy = mean_of([float(ratio[late].mean()) for ratio in ratios])
            if case.tc_relative == 0:
                result.add("sliding-strikes", energy, name)
            else:
                result.add("sliding-limit" if case.tc_relative == shortest else "sliding-energy",
                           energy, name)
            result.add("sliding-price", price, name)
    return result


def draw_limit(table: Table) -> Figure:
    """Energies over those with elastic strikes against scaled time, a panel for each
    restitution."""
    by_epsilon = list(parts(table, "epsilon"))
    figure, axes = style.panels("Energy over that with sliding contact and elastic strikes",
                                len(by_epsilon))
    for panel, ((epsilon,), part) in zip(axes, by_epsilon):
        for (tc_relative,), case in parts(part, "tc_relative"):
            label = rf"$t_c = {tc_relative:g}$" if tc_relative else "own strikes"
            style.band(panel, case.tau, case.energy_over_sliding, case.error, label=label)
        panel.axhline(1, color="grey", linewidth=0.8)
        style.label(panel, r"$\tau$", "$E$ / sliding", rf"$\epsilon = {epsilon:g}$", log="x")
    return figure


def measure_dilute(runs: PaperRuns) -> Result:
    """Energy and ratio of temperatures of the dilute gas over theory, with sliding contact and
    with the t_c rule."""
    result = Result(("sliding", "tau", "energy_over_theory", "energy_error", "ratio_over_theory",
                     "ratio_error"))
    slides, rule = (runs.points(name)[0] for name in ("dilute-sliding", "dilute"))
    seeds = {run.seed for run in slides.runs}
    rule = Point(rule.conditions, [run for run in rule.runs if run.seed in seeds])
    last = min(len(run.tau) for run in (*slides.runs, *rule.runs)) - 1
    tau = slides.first.tau[1:last]
    shown = tau >= FIRST_TAU
    theory_there = cooling_theory(slides.conditions, tau[shown])
    ratio_there = theory_there.t_tr / theory_there.t_rot
    for sliding, point in ((1, slides), (0, rule)):
        energies = [run.energy[1:last][shown] / theory_there.energy for run in point.runs]
        ratios = [_ratio(run, last)[shown] / ratio_there for run in point.runs]
        result.add_rows(sliding, tau[shown], *mean_and_error(energies), *mean_and_error(ratios))
    c = float(theory.ratio(slides.conditions.epsilon, slides.conditions.k))
    result.add("energy-theory", measure(slides, energy_over_theory), "test, sliding contact")
    result.add("ratio-theory", measure(
        slides, lambda run: late_ratio(run, run.tau >= LATE_TAU) / c), "sliding contact")
    late = tau >= LATE_TAU
    for claim, number in (
            ("sliding-dilute-energy", lambda run: run.energy[1:last]),
            ("sliding-dilute-ratio", lambda run: _ratio(run, last))):
        over = _over(slides, rule, lambda run: number(run)[late])
        result.add(claim, mean_of([float(each.mean()) for each in over]))
    result.add("sliding-dilute-price", mean_of(
        _over(slides, rule, lambda run: run.collisions[-1])))
    return result


def draw_dilute(table: Table) -> Figure:
    """Both over theory against scaled time."""
    figure, axes = style.panels("The dilute gas with sliding contact in place of the t_c rule", 2,
                                width=4.2)
    for (sliding,), part in parts(table, "sliding"):
        for panel, name in zip(axes, ("energy", "ratio")):
            style.band(panel, part.tau, part[f"{name}_over_theory"], part[f"{name}_error"],
                       label=_label(sliding))
    for panel, label in zip(axes, (r"$E$", r"$T_{\rm tr} / T_{\rm rot}$")):
        panel.axhline(1, color="grey", linewidth=0.8)
        style.label(panel, r"$\tau$", f"{label} / theory", log="x")
    return figure


def measure_dense(runs: PaperRuns) -> Result:
    """Growth of S and of the second moment of the dense gas, with sliding contact and with the t_c
    rule."""
    result = Result(("sliding", "collisions", "s", "s_error", "moment", "moment_error"))
    slides, rule = (runs.points(name)[0] for name in ("dense-sliding", "dense"))
    places = curve_places(slides)
    places = places[places <= SHOWN_COLLISIONS]
    for sliding, point in ((1, slides), (0, rule)):
        result.add_rows(sliding, places, *curve(point, flow_order_growth, places),
                        *curve(point, second_moment, places))
    for claim, quantity in (("flow-order-growth", flow_order_growth),
                            ("moment-growth", second_moment)):
        result.add(claim, measure(
            slides, lambda run: at_collisions(run, quantity(run), SHOWN_COLLISIONS)),
            f"test, sliding contact, at {SHOWN_COLLISIONS:g}")
    for claim, name in (("departure-translation", "t_tr"), ("departure-rotation", "t_rot")):
        result.add(claim, measure(
            slides, lambda run: log_over_theory(run, name, SHOWN_COLLISIONS)),
            f"test, sliding contact, at {SHOWN_COLLISIONS:g}")
    return result


def draw_dense(table: Table) -> Figure:
    """S and the second moment against collisions per needle."""
    return draw_growth(table, "sliding", _label,
                       "The dense gas with sliding contact in place of the t_c rule", "$S$ / start")


def _cases_by_epsilon(runs: PaperRuns) -> Iterator[tuple[float, list[Case]]]:
    """All cases of each restitution, those of the rule first."""
    cases = []
    for point in (*runs.points("sliding-rule"), *runs.points("sliding")):
        elastic = point.conditions.scene["collisions"].get("elastic_strikes", False)
        cases.append(Case(point, point.conditions.tc_relative or 0.0, elastic))
    for epsilon in dict.fromkeys(case.point.conditions.epsilon for case in cases):
        yield epsilon, [case for case in cases if case.point.conditions.epsilon == epsilon]


def _over(point: Point, reference: Point,
          number: Callable[[FinishedRun], np.ndarray]) -> list[np.ndarray]:
    """What runs have over what the run of the same seed has that they are compared with."""
    others = {run.seed: run for run in reference.runs}
    return [number(run) / number(others[run.seed]) for run in point.runs if run.seed in others]


def _ratio(run: FinishedRun, last: int) -> np.ndarray:
    """T_tr / T_rot without the start, where needles may not rotate, up to a sample."""
    return run.series.t_tr[1:last] / run.series.t_rot[1:last]


def _label(sliding: float) -> str:
    return "sliding contact" if sliding else r"$t_c$ rule"
