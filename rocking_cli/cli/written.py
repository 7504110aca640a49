"""Files that a command writes: plots and tables; and the table that one reads, also from standard input."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from rocking_cli.cli import terminal
from rocking_cli.cli.options import STANDARD_OUTPUT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.spreadsheet import Spreadsheet
    from rocking_cli.io.tables import Columns

T = TypeVar("T")


def save(path: Path, figure: Figure) -> None:
    """Write a figure completely or not at all, in the format of the suffix of the path."""
    from rocking_cli.io.files import write_whole
    from rocking_cli.plotting import style

    write_whole(path, lambda stream: style.save(figure, stream, format=path.suffix[1:].lower()))


def write_picture(path: Path, figure: Figure) -> None:
    """Write a figure, and report it."""
    save(path, figure)
    terminal.note(f"wrote {path}")


def write_table(out: Path, blocks: Iterable[Columns]) -> None:
    """Write a table to a file and report it, or write CSV to standard output and keep everything else off it."""
    from rocking_cli.io import tables

    if str(out) == STANDARD_OUTPUT:
        with terminal.results_as_bytes() as stream:
            tables.write_csv(stream, blocks)
        return
    tables.write_table(out, blocks)
    terminal.note(f"wrote {out}")


def read_table(file: str, parse: Callable[[Spreadsheet], T]) -> T | str:
    """Return what `parse` makes of the table on standard input, or the name of any other file."""
    if file != STANDARD_OUTPUT:
        return file
    from rocking_cli.excitation.records.opening import name_of, original
    from rocking_cli.io.spreadsheet import parse_sheet

    return parse(parse_sheet(original(file), name_of(file)))
