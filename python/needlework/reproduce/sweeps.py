"""Runs what is missing of a set, by `needlework sweep`, which also continues what was stopped."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Optional

from ..errors import IoError
from .runs import PaperRuns

STOPPED = 75
"""Exit code of what was stopped by a signal and can be continued."""

_PASSED_ON = tuple(getattr(signal, name) for name in
                   ("SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGXCPU"))


def run_set(runs: PaperRuns, name: str, program: str, *, threads: Optional[int] = None,
            quiet: bool = False, force: bool = False) -> int:
    """Runs the members of a set that are missing, ``threads`` at a time. With ``force`` also those
    whose file is of another version or scene. Returns the exit code of the program."""
    command = [program, "sweep", str(runs.grid(name)), "--out", str(runs.folder_of(name))]
    command += ["--threads", str(threads)] if threads else []
    command += [option for option, wanted in (("--quiet", quiet), ("--force", force)) if wanted]
    received: list[int] = []
    with _signals_go_to(received) as receivers:
        # The table that a sweep prints is not what this command is asked for.
        try:
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        except OSError as error:
            raise IoError(f"--program {program}: cannot be run: {error.strerror}") from None
        receivers.append(process)
        if received:  # between the handlers and the start
            process.send_signal(received[0])
        code = process.wait()
    return STOPPED if received or code < 0 else code


@contextmanager
def _signals_go_to(received: list[int]) -> Iterator[list[subprocess.Popen]]:
    """Passes signals on to the processes in the list, which save and end, rather than ending
    itself. What is ignored, as by nohup, stays so."""
    receivers: list[subprocess.Popen] = []

    def pass_on(number: int, _: Optional[FrameType]) -> None:
        received.append(number)
        for process in receivers:
            process.send_signal(number)

    before = {number: signal.getsignal(number) for number in _PASSED_ON}
    for number, handler in before.items():
        if handler != signal.SIG_IGN:
            signal.signal(number, pass_on)
    try:
        yield receivers
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
