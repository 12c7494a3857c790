"""The folder of a reproduction: which size it is of, and files that appear as a whole."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from ..errors import InputError, IoError

MARKER = "reproduction.toml"


def claim_folder(folder: Path, size: str, force: bool) -> None:
    """Makes the folder, or checks that it is one of this size; with ``force`` another folder is
    used all the same. Raises InputError for a folder with something else in it, and IoError."""
    marker = folder / MARKER
    record = f'# Made by needlework reproduce.\nsize = "{size}"\n'
    try:
        if marker.exists():
            if marker.read_text(encoding="utf-8", errors="replace") == record:
                return
            if not force:
                raise InputError(f"--out {folder}: holds another reproduction than the {size} one "
                                 f"({marker}): expected another folder, or --force")
        elif folder.is_dir() and any(folder.iterdir()) and not force:
            raise InputError(f"--out {folder}: expected a new folder, one of needlework reproduce, "
                             "or --force: it has other files in it")
    except OSError as error:
        raise IoError(f"--out {folder}: cannot be made: {error.strerror}") from None
    make_folder(folder)
    write_text(marker, record)


def make_folder(folder: Path) -> None:
    """Makes a folder and those above it, unless it is there. Raises IoError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise IoError(f"--out {folder}: cannot be made: {error.strerror}") from None


def write_text(path: Path, text: str) -> None:
    """Writes a text; the file has its name only when it is complete. Raises IoError."""
    write_file(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_file(path: Path, write: Callable[[Path], object]) -> None:
    """Has a function write a file at another path, and gives it its name. Raises IoError."""
    try:
        with tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as folder:
            temporary = Path(folder) / path.name
            write(temporary)
            os.replace(temporary, path)
    except OSError as error:
        raise IoError(f"{path}: cannot be written: {error.strerror}") from None
