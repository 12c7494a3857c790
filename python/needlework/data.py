"""Data of a user's own, which checkpoints and files carry by name."""

from __future__ import annotations

import json
from collections.abc import Iterator, MutableMapping
from typing import Any

import numpy as np

from . import _core
from .errors import InputError


class Data(MutableMapping):
    """Data of your own by name: ``sim.data["notes"] = {"lid": "open"}``.

    Bytes are kept as they are, and everything else as JSON: numbers, text, True, False, None, lists
    and dictionaries of these, and arrays of NumPy, which come back as lists. ``sim.data[name]`` is a
    new object each time: set it again to change it. ``del sim.data[name]`` removes it. Names have 1
    to 64 bytes, values at most 16 MiB.
    """

    def __init__(self, run: _core.Run) -> None:
        self._run = run

    def __getitem__(self, name: str) -> Any:
        return value_of(*self._run.data()[name])

    def __setitem__(self, name: str, value: Any) -> None:
        is_json = not isinstance(value, (bytes, bytearray, memoryview))
        self._run.set_data(_name(name), _json(name, value) if is_json else bytes(value), is_json)

    def __delitem__(self, name: str) -> None:
        if name not in self:
            raise KeyError(name)
        self._run.set_data(_name(name), None, False)

    def __iter__(self) -> Iterator[str]:
        return iter(self._run.data())

    def __len__(self) -> int:
        return len(self._run.data())

    def __repr__(self) -> str:
        return f"<Data: {', '.join(self)}>"


def value_of(is_json: bool, value: bytes) -> Any:
    """What was set."""
    return json.loads(value) if is_json else value


def _name(name: Any) -> bytes:
    if not isinstance(name, str):
        raise InputError(f"data: name = {name!r}: expected a string")
    return name.encode(errors="surrogateescape")


def _json(name: str, value: Any) -> bytes:
    try:
        return json.dumps(value, allow_nan=False, ensure_ascii=False, default=_plain).encode()
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"data: {name}: expected bytes or what JSON can hold: {error}") from None


def _plain(value: Any) -> Any:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"not {type(value).__name__}")
