"""Runs what is missing of a set, by `needlework sweep`, which also continues what was stopped, or
by `needlework theory --boltzmann`."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Optional

from ..errors import IoError
from .equation import is_equation, questions
from .folder import make_folder, write_text
from .runs import PaperRuns
from .toml_files import read_toml

STOPPED = 75
"""Exit code of what was stopped by a signal and can be continued."""

_PASSED_ON = tuple(getattr(signal, name) for name in
                   ("SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGXCPU"))


def run_set(runs: PaperRuns, name: str, program: str, *, threads: Optional[int] = None,
            quiet: bool = False, force: bool = False) -> int:
    """Runs the members of a set that are missing, ``threads`` at a time. With ``force`` also those
    whose file is of another version or scene. Returns the exit code of the program."""
    if is_equation(read_toml(runs.grid(name))):
        return _solve_set(runs, name, program, threads=threads, quiet=quiet)
    command = [program, "sweep", str(runs.grid(name)), "--out", str(runs.folder_of(name))]
    command += ["--threads", str(threads)] if threads else []
    command += [option for option, wanted in (("--quiet", quiet), ("--force", force)) if wanted]
    # The table that a sweep prints is not what this command is asked for.
    return _call(command, stdout=subprocess.DEVNULL)[0]


def _solve_set(runs: PaperRuns, name: str, program: str, *, threads: Optional[int],
               quiet: bool) -> int:
    """Asks what has no answer yet. A simulation that is stopped begins again."""
    missing = [question for question in questions(runs, name) if not question.is_answered]
    environment = {**os.environ, **({"OMP_THREAD_LIMIT": str(threads)} if threads else {})}
    make_folder(runs.folder_of(name))
    for number, question in enumerate(missing, start=1):
        if not quiet:
            print(f"{number} of {len(missing)}: {question.path.stem}", file=sys.stderr, flush=True)
        code, text = _call([program, *question.words], stdout=subprocess.PIPE, env=environment)
        if code:
            return code
        write_text(question.path, question.record(text))
    return 0


def _call(command: Sequence[str], **options: object) -> tuple[int, str]:
    """Exit code and what the program has printed, if that goes to a pipe."""
    received: list[int] = []
    with _signals_go_to(received) as receivers:
        try:
            process = subprocess.Popen(command, text=True, **options)
        except OSError as error:
            raise IoError(f"--program {command[0]}: cannot be run: {error.strerror}") from None
        receivers.append(process)
        if received:  # between the handlers and the start
            process.send_signal(received[0])
        text, _ = process.communicate()
    return STOPPED if received or process.returncode < 0 else process.returncode, text or ""


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
