"""Simulations of the Boltzmann equation beside runs of the gas, by `needlework theory --boltzmann`.

A set of them is a file such as profiles/paper/SIZE/boltzmann-dilute.toml: a scene and parameters
as those of a sweep, and a table [boltzmann] with the pairs, the number of needles and the times.
Its answers lie in the folder FOLDER/runs/boltzmann-dilute, a file for each question. Nothing here
starts a simulation; see sweeps.py.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..errors import InputError
from .runs import Conditions, PaperRuns, Point, at_points, seeds_of
from .toml_files import read_toml

SINGLE, ENCOUNTERS = "single", "encounters"


@dataclass(frozen=True)
class Question:
    """What one simulation is asked, and where its answer is."""

    path: Path
    words: tuple[str, ...]
    """Of the command, without the program."""
    pairs: str
    seed: int
    point: int
    conditions: Conditions = field(repr=False)

    @property
    def is_answered(self) -> bool:
        """Whether there is an answer to this question; of another one there is none."""
        return self._read() is not None

    @property
    def answer(self) -> dict[str, Any]:
        """What the program has said. Raises InputError if it has not been asked."""
        answer = self._read()
        if answer is None:
            raise InputError(f"{self.path}: expected the answer to needlework "
                             f"{' '.join(self.words)}")
        return answer

    def record(self, answer: str) -> str:
        """The text of the file. Raises InputError for what is no answer."""
        try:
            return json.dumps({**self._kept, "answer": json.loads(answer)}) + "\n"
        except ValueError as error:
            raise InputError(f"{self.path}: expected JSON of the program: {error}") from None

    @property
    def _kept(self) -> dict[str, Any]:
        # What is in the scene, not where it is.
        return {"question": list(self.words[:-1]), "scene": self.conditions.scene}

    def _read(self) -> dict[str, Any] | None:
        try:
            record = json.loads(self.path.read_text(encoding="utf-8"))
            answer = record.pop("answer")
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            return None
        return answer if record == self._kept else None


@dataclass(frozen=True)
class Solution:
    """An answer, with the names that a FinishedRun has for the same things."""

    question: Question

    @property
    def conditions(self) -> Conditions:
        """What it starts from."""
        return self.question.conditions

    @property
    def seed(self) -> int:
        """Of its random numbers."""
        return self.question.seed

    @cached_property
    def values(self) -> dict[str, Any]:
        """What the program has said."""
        return self.question.answer

    @cached_property
    def tau(self) -> np.ndarray:
        """Scaled times."""
        return np.array(self.values["tau"])

    @cached_property
    def series(self) -> SimpleNamespace:
        """Temperatures and the energy per needle at these times."""
        return SimpleNamespace(**{name: np.array(self.values[name])
                                  for name in ("t_tr", "t_rot", "energy")})

    @cached_property
    def energy(self) -> np.ndarray:
        """Energy per needle over T_tr(0)."""
        return self.series.energy / self.conditions.t_tr

    def excess(self, name: str) -> np.ndarray:
        """Of moments of the velocities over those of Gaussian ones: "tr", "rot" or "mixed"."""
        return np.array([np.nan if value is None else value
                         for value in self.values[f"excess_{name}"]])


def is_equation(grid: dict[str, Any]) -> bool:
    """Whether a set is one of these."""
    return "boltzmann" in grid


def questions(runs: PaperRuns, name: str) -> list[Question]:
    """All of a set, in the order of its points, its pairs and its seeds."""
    file = runs.grid(name)
    grid = read_toml(file)
    wanted = grid["boltzmann"]
    out = []
    for number, (values, conditions) in enumerate(at_points(file)):
        for pairs in wanted["pairs"]:
            for seed in seeds_of(grid):
                words = ["theory", "--boltzmann", pairs, "--json", "--seed", str(seed),
                         "--needles", str(wanted["needles"])]
                words += [word for key, value in values.items()
                          for word in ("--set", f"{key}={value}")]
                words += ["--tau", *(f"{tau:.12g}" for tau in times(wanted["tau"])),
                          str(file.parent / grid["scene"])]
                parts = [f"{key.partition('.')[2]}={value}" for key, value in values.items()]
                path = runs.folder_of(name) / ",".join([pairs, *parts, f"seed={seed}.json"])
                out.append(Question(path, tuple(words), pairs, seed, number, conditions))
    return out


def solutions(runs: PaperRuns, name: str, pairs: str) -> list[Point]:
    """The points of a set in the order of its file, with the solutions for these pairs."""
    points: dict[int, Point] = {}
    for question in questions(runs, name):
        if question.pairs == pairs:
            point = points.setdefault(question.point, Point(question.conditions, []))
            point.runs.append(Solution(question))
    return list(points.values())


def times(wanted: dict[str, float]) -> list[float]:
    """Scaled times from 0 on: at equal steps, or so many per decade."""
    return [0.0, *_after_start(wanted)]


def _after_start(wanted: dict[str, float]) -> Iterator[float]:
    first, last = wanted["first"], wanted["last"]
    if "step" in wanted:
        count = round((last - first) / wanted["step"]) + 1
        yield from (first + n * wanted["step"] for n in range(count))
    else:
        count = round(np.log10(last / first) * wanted["per_decade"]) + 1
        yield from (first * 10 ** (n / wanted["per_decade"]) for n in range(count))
