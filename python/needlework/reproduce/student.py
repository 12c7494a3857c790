"""Confidence intervals of means over few independent runs, by Student's t."""

from __future__ import annotations

import math


def central_probability(t: float, degrees: int) -> float:
    """The probability that Student's t of so many degrees of freedom lies between -t and t.

    With t = sqrt(degrees) tan(a) it is the integral of cos^(degrees - 1) from 0 to a, over that from
    0 to pi/2."""
    a = math.atan(t / math.sqrt(degrees))
    return _cosine_integral(degrees - 1, a) / _cosine_integral(degrees - 1, math.pi / 2)


def quantile(confidence: float, degrees: int) -> float:
    """The t within which, on both sides of 0, Student's t lies with this probability, to rounding.
    Raises ValueError without degrees of freedom, and for a confidence that is not between 0 and 1."""
    if degrees < 1 or not 0 < confidence < 1:
        raise ValueError(f"quantile({confidence}, {degrees}): expected a confidence between 0 and "
                         "1, and 1 degree of freedom or more")
    low, high = 0.0, 1.0
    while central_probability(high, degrees) < confidence:
        low, high = high, 2 * high
    while low < (middle := (low + high) / 2) < high:
        if central_probability(middle, degrees) < confidence:
            low = middle
        else:
            high = middle
    return high


def _cosine_integral(power: int, a: float) -> float:
    """The integral of cos^power from 0 to a, by parts from that of power - 2."""
    value = math.sin(a) if power % 2 else a
    for n in range(power % 2 + 2, power + 1, 2):
        value = math.cos(a) ** (n - 1) * math.sin(a) / n + (n - 1) / n * value
    return value
