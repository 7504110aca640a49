"""Write the table of --out into a file, or to standard output for `-`."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import terminal
from rocking_cli.cli.options import STANDARD_OUTPUT

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns


def write(out: Path, blocks: Iterable[Columns]) -> None:
    """Write a table to a file and report it, or write CSV to standard output and keep everything else off it."""
    from rocking_cli.io.tables import write_csv, write_table

    if str(out) == STANDARD_OUTPUT:
        with terminal.results_as_bytes() as stream:
            write_csv(stream, blocks)
        return
    write_table(out, blocks)
    terminal.note(f"wrote {out}")
