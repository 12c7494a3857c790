"""What the paper claims, and whether a measurement agrees with it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

from ..errors import InputError
from .course import Measured
from .figure import Figure, Measurement
from .student import quantile
from .toml_files import read_toml

CONFIDENCE = 0.99
"""Of the interval around a mean over seeds that a verdict is about."""


@dataclass(frozen=True)
class Claim:
    """A statement, with its number if it has one."""

    id: str
    figure: str
    """Name of the figure that measures it."""
    statement: str
    """In our words."""
    quantity: str
    """What is measured, in words."""
    where: Optional[str] = None
    """In the paper; None for what goes beyond it."""
    paper: Optional[float] = None
    """The number that is stated."""
    precision: Optional[float] = None
    """How precisely it is stated: what is claimed is the interval paper +- precision."""
    reading: Optional[str] = None
    """How number and precision follow from what is said."""


def half_width(measured: Measured) -> float:
    """Of the confidence interval of what was measured: its standard error times Student's t of one
    degree of freedom less than there are independent runs. 0 for what is computed without chance,
    and NaN for a single run, of which no error is known."""
    if measured.seeds is None:
        return 0.0
    if measured.seeds < 2 or not math.isfinite(measured.error):
        return math.nan
    return measured.error * quantile(CONFIDENCE, measured.seeds - 1)


def verdict(claim: Claim, measured: Measured) -> str:
    """ "agrees" if the whole confidence interval of the measurement lies within the interval that is
    stated, and "differs" if it lies outside as a whole. "open" where neither holds, which is
    undecided, and where no number is stated."""
    if claim.paper is None or claim.precision is None:
        return "open"
    distance, half = abs(measured.value - claim.paper), half_width(measured)
    if distance + half <= claim.precision:
        return "agrees"
    if claim.precision + half < distance < math.inf:
        return "differs"
    return "open"


def read_claims(path: Path) -> dict[str, Claim]:
    """Claims by id from a file in which each is a table. Raises InputError, "FILE: ID.KEY = VALUE:
    expected ...", for the first error."""
    claims = {}
    for name, table in read_toml(path).items():
        if not isinstance(table, dict):
            raise InputError(f"{path}: {name} = {table!r}: expected a claim, [ID]")
        for key, value in table.items():
            if expected := _expected(key, value):
                raise InputError(f"{path}: {name}.{key} = {value!r}: expected {expected}")
        for key in ("figure", "statement", "quantity"):
            if key not in table:
                raise InputError(f"{path}: {name}.{key} is missing: expected a text")
        missing = [key for key in ("paper", "precision", "reading") if key not in table]
        if len(missing) in (1, 2):
            raise InputError(f"{path}: {name}.{missing[0]} is missing: expected paper, precision "
                             "and reading, or none of them")
        claims[name] = Claim(id=name, **table)
    return claims


def _expected(key: str, value: Any) -> str:
    """What is expected instead of a value; empty if it is right."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if key == "paper":
        return "" if is_number and math.isfinite(value) else "a number"
    if key == "precision":
        return "" if is_number and 0 < value < math.inf else "a number greater than 0"
    if key not in Claim.__dataclass_fields__ or key == "id":
        return "one of figure, statement, where, quantity, paper, precision, reading"
    return "" if isinstance(value, str) and value else "a text"


@dataclass(frozen=True)
class Row:
    """A claim beside a measurement of it."""

    claim: Claim
    figure: str
    """That measured it."""
    measured: Measured
    variant: str
    verdict: str

    @classmethod
    def of(cls, figure: Figure, measurement: Measurement, claims: Mapping[str, Claim]) -> Row:
        """Compares a measurement of a figure with its claim."""
        claim = claims[measurement.claim]
        return cls(claim, figure.name, measurement.measured, measurement.variant,
                   verdict(claim, measurement.measured))

    @property
    def id(self) -> str:
        """The claim and its variant, unique among all rows."""
        return f"{self.claim.id} [{self.variant}]" if self.variant else self.claim.id

    def to_json(self) -> dict[str, Any]:
        """What scripts read."""
        value, error, seeds = self.measured
        return {"id": self.id, "figure": self.figure, "paper": _number(self.claim.paper),
                "measured": _number(value), "error": _number(error), "verdict": self.verdict,
                "precision": _number(self.claim.precision), "seeds": seeds,
                "half_width": _number(half_width(self.measured)),
                "claim": self.claim.id, "variant": self.variant or None,
                "statement": self.claim.statement, "quantity": self.claim.quantity,
                "where": self.claim.where, "reading": self.claim.reading}


def _number(value: Optional[float]) -> Optional[float]:
    return float(value) if value is not None and math.isfinite(value) else None


def json_text(rows: Iterable[Row], size: str) -> str:
    """The rows as one JSON object, {"size": ..., "claims": [...]}, a row a line."""
    lines = (json.dumps(row.to_json(), ensure_ascii=False, separators=(",", ":")) for row in rows)
    return f'{{"size": "{size}", "claims": [\n' + ",\n".join(lines) + "\n]}\n"


def table_text(rows: Iterable[Row]) -> str:
    """The rows as people read them."""
    lines = [f"{'verdict':8}  {'paper':>10}  {'measured':>12}  {'error':>9}  {'seeds':>5}  claim"]
    for row in rows:
        value, error, seeds = row.measured
        paper = "-" if row.claim.paper is None else f"{row.claim.paper:.6g}"
        lines.append(f"{row.verdict:8}  {paper:>10}  {value:>12.6g}  {error:>9.1e}  "
                     f"{'-' if seeds is None else seeds:>5}  {row.id}")
    return "\n".join(lines) + "\n"
