"""Reads files in TOML, with Python's own module since 3.11 and with the package tomli before."""

from __future__ import annotations

from pathlib import Path
from typing import Any

try:
    import tomllib
except ModuleNotFoundError:
    import tomli as tomllib

from ..errors import InputError, IoError


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a file, in its order. Raises IoError and InputError."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise IoError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:  # of TOML, and of UTF-8
        raise InputError(f"{path}: expected TOML: {error}") from None
