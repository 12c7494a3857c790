"""How runs go on, and means over seeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike

from .. import theory
from .runs import Conditions, FinishedRun, Point

SHOWN_COLLISIONS = 600.0
"""Collisions per needle after which the paper shows the dense gas."""

SHOWN_BOTH_WAYS = (SHOWN_COLLISIONS, 2 * SHOWN_COLLISIONS)
"""The same, if the paper counts a collision for both needles as we do, and if it counts it once."""


class Measured(NamedTuple):
    """A number that was measured, with its standard error over independent runs."""

    value: float
    error: float = 0.0
    """0 for what is computed without chance."""
    seeds: Optional[int] = None
    """Independent runs; None for what is computed."""

    def over(self, divisor: float) -> Measured:
        """In units of a number that is known exactly."""
        return Measured(self.value / divisor, self.error / divisor, self.seeds)

    def less(self, other: Measured) -> Measured:
        """The difference of two means with its joint standard error."""
        return Measured(self.value - other.value, float(np.hypot(self.error, other.error)),
                        min(self.seeds, other.seeds))

    def over_measured(self, other: Measured) -> Measured:
        """The ratio of two means with its joint standard error."""
        ratio = self.value / other.value
        error = abs(ratio) * np.hypot(self.error / self.value, other.error / other.value)
        return Measured(ratio, float(error), min(self.seeds, other.seeds))


def mean_of(values: Sequence[float]) -> Measured:
    """The mean over seeds with its standard error, sqrt(sum (x - mean)^2 / (n (n - 1)))."""
    n = len(values)
    error = np.std(values, ddof=1) / np.sqrt(n) if n > 1 else np.nan
    return Measured(float(np.mean(values)) if n else np.nan, float(error), n)


def measure(point: Point, number: Callable[[FinishedRun], float]) -> Measured:
    """Of each run of a point a number, and the mean of these."""
    return mean_of(point.values(number))


def mean_and_error(curves: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Means over the first axis, which is that of seeds, and their standard errors."""
    curves = np.asarray(curves)
    n = len(curves)
    errors = curves.std(axis=0, ddof=1) / np.sqrt(n) if n > 1 else np.full(curves.shape[1:], np.nan)
    return curves.mean(axis=0), errors


def at_collisions(run: FinishedRun, values: np.ndarray, collisions: ArrayLike) -> np.ndarray:
    """What a run has at so many collisions per needle, linear between its samples; NaN outside."""
    return np.interp(collisions, run.collisions, values, left=np.nan, right=np.nan)


def slope(x: np.ndarray, y: np.ndarray) -> float:
    """The slope of y over x by least squares."""
    dx = x - x.mean()
    return float(dx @ (y - y.mean()) / (dx @ dx))


def cooling_theory(conditions: Conditions, tau: ArrayLike) -> theory.CoolingCurve:
    """Kinetic theory of a gas from its start, temperatures in units of T_tr(0) at scaled times."""
    return theory.cooling(conditions.epsilon, conditions.k, conditions.beta,
                          conditions.t_rot / conditions.t_tr, tau)


def late_ratio(run: FinishedRun, late: np.ndarray) -> float:
    """T_tr / T_rot over the samples that a mask chooses, as a geometric mean; NaN for none."""
    if not late.any():
        return np.nan
    return float(np.exp(np.log(run.series.t_tr[late] / run.series.t_rot[late]).mean()))


def log_tc_collisions(run: FinishedRun) -> float:
    """log10 of the number of collisions by the t_c rule."""
    return float(np.log10(run.series.tc_collisions[-1]))
