"""How far a run is: one line that is drawn again and again, in a notebook or on a terminal."""

from __future__ import annotations

import errno
import shutil
import sys
from typing import Any


def in_notebook() -> bool:
    """Whether this is the kernel of a Jupyter notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return getattr(shell, "kernel", None) is not None


def progress_line(wanted: bool | None) -> NotebookLine | TerminalLine | None:
    """The line to draw, if any; None shows progress in notebooks only."""
    if wanted is None:
        wanted = in_notebook()
    if not wanted:
        return None
    return NotebookLine() if in_notebook() else TerminalLine()


class TerminalLine:
    """On stderr. A run goes on where that is closed."""

    def __init__(self) -> None:
        self._width = 0

    def show(self, text: str) -> None:
        text = _whole_items(text, shutil.get_terminal_size().columns - 1)
        self._width = max(self._width, len(text))
        _write_stderr(f"\r{text:<{self._width}}")

    def clear(self) -> None:
        if self._width:
            _write_stderr(f"\r{'':<{self._width}}\r")


def _whole_items(text: str, columns: int) -> str:
    """As many of the items at its beginning as fit, as the program shows them; what matters most
    comes first."""
    while len(text) > columns:
        shorter = text.rpartition(", ")[0]
        text = shorter or text[:columns]
    return text


def _write_stderr(text: str) -> None:
    # None: its descriptor was closed when Python began.
    if sys.stderr is None or sys.stderr.closed:
        return
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except OSError as error:
        if error.errno != errno.EBADF:  # its descriptor was closed since
            raise


class NotebookLine:
    """Below the cell."""

    def __init__(self) -> None:
        self._handle: Any = None

    def show(self, text: str) -> None:
        from IPython.display import display

        content = {"text/plain": text}
        if self._handle is None:
            self._handle = display(content, raw=True, display_id=True)
        else:
            self._handle.update(content, raw=True)

    def clear(self) -> None:
        if self._handle is not None:
            self._handle.update({"text/plain": ""}, raw=True)
