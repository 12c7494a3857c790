"""Values by name, as items and as attributes: ``totals["energy"]`` and ``totals.energy``."""

from __future__ import annotations

import html
import sys
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas


class Values(Mapping):
    """A mapping that does not change; ``dict(values)`` is a dictionary of its own."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        object.__setattr__(self, "_values", dict(values))

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __getattr__(self, name: str) -> Any:
        # Copying and unpickling ask before __init__ has made _values.
        if name.startswith("_") or name not in self._values:
            raise AttributeError(f"{type(self).__name__} has no {name}: "
                                 f"expected {', '.join(self.__dict__.get('_values', ()))}")
        return self._values[name]

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{name}: a {type(self).__name__} cannot be changed")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._values]

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={short_text(value)}" for name, value in self.items())
        return f"{type(self).__name__}({inside})"

    def __reduce__(self) -> tuple:
        return type(self), (dict(self._values),)

    def _repr_html_(self) -> str:
        return html_table(self._values)


class Table(Values):
    """Columns of one length: arrays [rows] or [rows, 3]."""

    @property
    def columns(self) -> Mapping[str, Any]:
        """Those of the values that are columns, which are all unless a class says otherwise."""
        return self._values

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.columns.values()), ()))

    def to_pandas(self) -> pandas.DataFrame:
        """The table in pandas; a column of vectors becomes three, such as momentum_x."""
        return pandas_table(self.columns)

    def __repr__(self) -> str:
        return f"{type(self).__name__} of {self.rows} rows: {', '.join(self)}"

    def _repr_html_(self) -> str:
        shown = self.rows if self.rows <= 10 else 5
        flat = flat_columns(self.columns)
        head = "".join(f"<th>{html.escape(name)}</th>" for name in flat)
        rows = "".join("<tr>" + "".join(f"<td>{_shown(column[i])}</td>" for column in flat.values())
                       + "</tr>" for i in range(shown))
        return f"<table><tr>{head}</tr>{rows}</table><p>{self.rows} rows</p>"


def short_text(value: Any) -> str:
    """A value on one line: of long arrays their shape alone."""
    if not isinstance(value, np.ndarray):
        return repr(value)
    if value.size > 9:
        return f"array{list(value.shape)}"
    return np.array2string(value, separator=", ", max_line_width=sys.maxsize).replace("\n", "")


def _shown(value: Any) -> str:
    return html.escape(value) if isinstance(value, str) else f"{value:.6g}"


def flat_columns(columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Columns of single numbers: vectors by axis, pairs by number."""
    flat = {}
    for name, column in columns.items():
        column = np.asarray(column)
        if column.ndim == 1:
            flat[name] = column
            continue
        endings = "xyz" if column.shape[1] == 3 else range(1, column.shape[1] + 1)
        flat |= flat_columns({f"{name}_{end}": column[:, place]
                              for place, end in enumerate(endings)})
    return flat


class NotPickled:
    """What holds an open simulation or an open file, which no copy can share."""

    _instead = ""

    def __reduce_ex__(self, protocol: object) -> None:
        raise TypeError(f"a {type(self).__name__} cannot be pickled or copied: "
                        f"expected {self._instead}")


def pandas_table(columns: Mapping[str, np.ndarray]) -> pandas.DataFrame:
    """Columns [rows] or [rows, n] as a table of pandas."""
    try:
        import pandas
    except ImportError as error:
        raise ImportError("to_pandas() needs pandas: expected the package python3-pandas "
                          "to be installed") from error
    return pandas.DataFrame(flat_columns(columns))


def html_table(values: Mapping[str, Any]) -> str:
    """A table of names and values, for notebooks."""
    def text(value: Any) -> str:
        return f"{value:.8g}" if isinstance(value, float) else str(value)

    rows = "".join(f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
                   f"<td style='text-align:left'>{html.escape(text(value))}</td></tr>"
                   for name, value in values.items())
    return f"<table>{rows}</table>"


def plain(value: Any) -> Any:
    """Text for bytes, and numbers of Python for those of NumPy."""
    if isinstance(value, bytes):
        return value.decode()
    return value.item() if isinstance(value, np.generic) else value
