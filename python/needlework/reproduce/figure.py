"""What a figure is made of, and what comes out of it."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError, IoError
from ..values import Table
from .course import Measured
from .runs import PaperRuns

if TYPE_CHECKING:
    import matplotlib.figure


@dataclass
class Measurement:
    """A number for a claim."""

    claim: str
    """Its id."""
    measured: Measured
    variant: str = ""
    """Of what it is, such as "k = 6, T_rot(0) = 1"; empty if there is one only."""


@dataclass
class Result:
    """A figure's data, which its picture shows, and its numbers for the claims."""

    columns: Sequence[str]
    rows: list[Sequence[float]] = field(default_factory=list)
    measurements: list[Measurement] = field(default_factory=list)

    def add_rows(self, *columns: Any) -> None:
        """Rows of columns that are broadcast against each other."""
        self.rows += zip(*(column.tolist() for column in np.broadcast_arrays(*columns)))

    def add(self, claim: str, measured: Measured, variant: str = "") -> None:
        """A number for a claim."""
        self.measurements.append(Measurement(claim, measured, variant))

    @property
    def table(self) -> Table:
        """The data by column."""
        return Table(dict(zip(self.columns, np.array(self.rows, dtype=float).T)))


@dataclass(frozen=True)
class Figure:
    """A figure of the paper, or one beyond it."""

    name: str
    """As the command takes it."""
    title: str
    sets: tuple[str, ...]
    """Runs that it needs."""
    measure: Callable[[PaperRuns], Result]
    """Makes data and measurements from finished runs."""
    draw: Callable[[Table], matplotlib.figure.Figure]
    """Draws the picture from the data alone."""

    @property
    def data_file(self) -> str:
        """Name of the file with the data."""
        return f"figure-{self.name}.csv"

    @property
    def picture_file(self) -> str:
        """Name of the file with the picture."""
        return f"figure-{self.name}.svg"


def parts(table: Table, *keys: str) -> Iterator[tuple[tuple[float, ...], Table]]:
    """The parts of a table in which these columns are constant, in the order in which they first
    appear, with the values there."""
    rows = list(zip(*(table[key] for key in keys)))
    for values in dict.fromkeys(rows):
        chosen = np.array([row == values for row in rows])
        yield values, Table({name: column[chosen] for name, column in table.items()})


def csv_text(columns: Sequence[str], rows: Iterable[Sequence[float]]) -> str:
    """Numbers in seven digits below the names of their columns; nothing for NaN."""
    lines = [",".join(columns)]
    lines += (",".join("" if np.isnan(number) else f"{number:.7g}" for number in row)
              for row in rows)
    return "\n".join(lines) + "\n"


def read_table(path: Path) -> Table:
    """The data of a figure from its file. Raises IoError and InputError."""
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise IoError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: expected text in UTF-8") from None
    columns, *rows = list(csv.reader(io.StringIO(text))) or [[]]
    numbers = []
    for line, row in enumerate(rows, start=2):
        if len(row) != len(columns):
            raise InputError(f"{path}: line {line}: {len(row)} numbers: expected {len(columns)}, "
                             f"{', '.join(columns)}")
        try:
            numbers.append([float(cell) if cell else np.nan for cell in row])
        except ValueError:
            raise InputError(f"{path}: line {line}: {','.join(row)}: expected numbers") from None
    if not numbers:
        raise InputError(f"{path}: expected lines of numbers below the names of columns")
    return Table(dict(zip(columns, np.array(numbers).T)))
