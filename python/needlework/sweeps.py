"""Summaries of sweeps, which `needlework sweep` writes: means over seeds with standard errors."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from .values import Table, Values, plain


class SweepSummary(Table):
    """Columns [P] of a sweep over P points: the varied keys, such as ``summary["needles.count"]``;
    ``members``, how many runs the means of a point are over; and of each result at the ends of the
    runs the mean and, as NAME_error, the standard error, such as ``summary.energy_error``.
    docs/sweeps.md describes them. NaN is the mean of nothing, and the error of a single member."""

    series: tuple[Table, ...]
    """For each point, at the times that all its members have: ``time`` [S], and means and, as
    NAME_error, errors of the sums over all needles, [S, 3] of momentum."""
    seeds: tuple[np.ndarray, ...]
    """For each point, the seeds of its members."""
    about: Values
    """The texts of ``grid`` and ``scene``, and the ``version`` of the program."""

    def __init__(self, values: Any, **rest: Any) -> None:
        super().__init__(values)
        for name in ("series", "seeds", "about"):
            object.__setattr__(self, name, rest[name])

    def __reduce__(self) -> tuple:
        return _again, (dict(self), {"series": self.series, "seeds": self.seeds, "about": self.about})


def _again(values: dict, rest: dict) -> SweepSummary:
    return SweepSummary(values, **rest)


def read_summary(path: str | os.PathLike[str]) -> SweepSummary | None:
    """The summary in a file; None if it is another file, or none that can be read."""
    import h5py
    try:
        with h5py.File(path, "r") as file:
            if not {"sweep", "members", "results", "series"} <= set(file):
                return None
            return _summary_of(file)
    except OSError:
        return None


def _summary_of(file: Any) -> SweepSummary:
    columns = {key: _values_of(data) for key, data in file["parameters"].items()}
    columns["members"] = file["members/count"][()]
    columns |= _means_and_errors(file["results"])
    series = tuple(Table({"time": group["time"][()]} | _means_and_errors(group))
                   for _, group in sorted(file["series"].items()))
    seeds, points = file["members/seeds"][()], file["members/point"][()]
    about = {name: plain(data[()]) for name, data in file["sweep"].items()}
    return SweepSummary(columns, series=series, about=Values(about),
                        seeds=tuple(seeds[points == point] for point in range(len(series))))


def _values_of(data: Any) -> np.ndarray:
    """Numbers, or else texts in TOML."""
    return data.asstr()[()] if data.dtype == object else data[()]


def _means_and_errors(group: Any) -> dict[str, np.ndarray]:
    found = {}
    for name, one in group.items():
        if hasattr(one, "items"):  # a group; the time of series is a dataset
            found |= {name: one["mean"][()], f"{name}_error": one["standard_error"][()]}
    return found
