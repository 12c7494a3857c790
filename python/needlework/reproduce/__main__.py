"""The command: `needlework reproduce` calls it, and so does `python3 -m needlework.reproduce`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Optional

import numpy as np

from ..errors import InputError, IoError
from .claims import Row, json_text, read_claims, table_text
from .figure import Figure, csv_text, read_table
from .figures import FIGURES
from .folder import claim_folder, write_file, write_text
from .runs import PAPER, PaperRuns
from .style import styled
from .sweeps import STOPPED, run_set

BAD_USAGE, BAD_INPUT, IO_ERROR = 2, 3, 5


def main(words: Optional[Sequence[str]] = None) -> int:
    """Returns the exit code, which is one of those of the program."""
    arguments = _parser().parse_args(words)
    try:
        if arguments.data:
            return draw_again(arguments)
        return reproduce(arguments)
    except InputError as error:
        print_message(str(error))
        return BAD_INPUT
    except IoError as error:
        print_message(str(error))
        return IO_ERROR
    except KeyboardInterrupt:
        print_message(f"stopped; what is finished is kept, and {_command(arguments)} continues")
        return STOPPED


def reproduce(arguments: argparse.Namespace) -> int:
    """Runs what is missing, and makes the figures and the claims of what was asked for."""
    size = "quick" if arguments.quick else "full"
    runs = PaperRuns(_folder(arguments), size, arguments.paper)
    chosen = _chosen(arguments, runs)
    if not chosen:
        return BAD_USAGE
    claims = read_claims(runs.paper / "claims.toml")
    claim_folder(runs.folder, size, arguments.force)

    code = 0
    for name in dict.fromkeys(name for figure in chosen for name in figure.sets):
        if not arguments.quiet:
            print(f"runs of {name}", file=sys.stderr, flush=True)
        code = max(code, run_set(runs, name, arguments.program, threads=arguments.threads,
                                 quiet=arguments.quiet, force=arguments.force))
        if code == STOPPED:
            print_message(f"stopped; what is finished is kept, and {_command(arguments)} continues")
            break
    if code:
        return code

    rows = []
    for figure in chosen:
        rows += make(figure, runs, claims)
    text = json_text(rows, size)
    claims_file = runs.folder / f"claims-{arguments.figure}.json"
    write_text(claims_file, text)
    if arguments.json:
        print(text, end="")
    elif not arguments.quiet:
        print(table_text(rows), end="")
        print(f"pictures, data and {claims_file.name} are in {runs.folder}")
    return 0


def make(figure: Figure, runs: PaperRuns, claims: dict) -> list[Row]:
    """Makes a figure of runs that are finished: writes its data and its picture into their folder,
    and compares its measurements with their claims."""
    # Runs that are too short have no such number, which is then NaN.
    with np.errstate(all="ignore"):
        result = figure.measure(runs)
    write_text(runs.folder / figure.data_file, csv_text(result.columns, result.rows))
    draw(figure, runs.folder, runs.folder)
    return [Row.of(figure, measurement, claims) for measurement in result.measurements]


def draw(figure: Figure, data: Path, out: Path) -> None:
    """Draws the picture of a figure from its data in a folder."""
    path = data / figure.data_file
    table = read_table(path)
    try:
        with styled(), np.errstate(all="ignore"):
            picture = figure.draw(table)
            write_file(out / figure.picture_file, lambda file: picture.savefig(
                file, format="svg", metadata={"Date": None, "Title": figure.title}))
    except (AttributeError, KeyError) as error:
        raise InputError(f"{path}: expected the data of figure {figure.name}: {error}") from error


def draw_again(arguments: argparse.Namespace) -> int:
    """Draws pictures from the data of an earlier reproduction."""
    data = Path(arguments.data)
    out = Path(arguments.out) if arguments.out else data
    chosen = [figure for figure in FIGURES.values()
              if arguments.figure == figure.name
              or arguments.figure == "all" and (data / figure.data_file).is_file()]
    if not chosen:
        raise InputError(f"--from {data}: expected a folder with {FIGURES['2'].data_file} or other "
                         "data of needlework reproduce")
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise IoError(f"--out {out}: cannot be made: {error.strerror}") from None
    for figure in chosen:
        draw(figure, data, out)
    if not arguments.quiet:
        print(f"{len(chosen)} pictures are in {out}" if len(chosen) > 1 else
              f"1 picture is in {out}")
    return 0


def print_message(message: str) -> None:
    """One line on stderr, as all messages of the program are."""
    print(f"needlework: {' '.join(message.splitlines())}", file=sys.stderr, flush=True)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="needlework reproduce", description=(
        "Makes the figures of the paper and checks its claims; needlework reproduce --help says "
        "more."))
    parser.add_argument("figure", choices=["all", *FIGURES], metavar="FIGURE",
                        help="a figure of the paper, or all")
    parser.add_argument("--quick", action="store_true", help="smaller systems, fewer seeds")
    parser.add_argument("--out", metavar="DIR", help="folder for runs, data and pictures")
    parser.add_argument("--from", dest="data", metavar="DIR",
                        help="draw the pictures from the data in this folder, without runs")
    parser.add_argument("--threads", type=int, metavar="N", help="number of runs at a time")
    parser.add_argument("--json", action="store_true", help="print the claims as JSON")
    parser.add_argument("--quiet", action="store_true", help="no progress, no table")
    parser.add_argument("--force", action="store_true",
                        help="use a folder with something else in it")
    parser.add_argument("--program", default="needlework", help="the program that runs sweeps")
    parser.add_argument("--paper", type=Path, default=PAPER, metavar="DIR",
                        help="scenes, grids and claims in place of those of the paper")
    return parser


def _chosen(arguments: argparse.Namespace, runs: PaperRuns) -> list[Figure]:
    """The figures asked for. Without the runs of a figure in this size, `all` leaves it out."""
    chosen = []
    for figure in FIGURES.values():
        if arguments.figure not in ("all", figure.name):
            continue
        if all(map(runs.has, figure.sets)):
            chosen.append(figure)
        elif arguments.figure != "all":
            print_message(f"{figure.name} --quick: expected no --quick: its runs belong to the "
                          "full set only")
        elif not arguments.quiet:
            print_message(f"warning: {figure.name}: is left out, as its runs belong to the full "
                          "set only")
    return chosen


def _folder(arguments: argparse.Namespace) -> Path:
    return Path(arguments.out or ("reproduction-quick" if arguments.quick else "reproduction"))


def _command(arguments: argparse.Namespace) -> str:
    return (f"needlework reproduce {arguments.figure}{' --quick' if arguments.quick else ''} "
            f"--out {_folder(arguments)}")


if __name__ == "__main__":
    try:
        code = main()
        sys.stdout.flush()
    except OSError as error:  # a full disk, or nobody who reads the output
        print_message(f"standard output: cannot be written: {error.strerror}")
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = IO_ERROR
    sys.exit(code)
