"""A table as comma-separated text."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import BinaryIO

from rocking_cli.text import printable


def write_table_csv(stream: BinaryIO, columns: Mapping[str, Sequence[object]]) -> None:
    """Write columns under their headings, a line a row.

    Parameters
    ----------
    stream : binary file
        Where to.
    columns : mapping of str to sequence
        Words, whole numbers, and other numbers, which are written with nine digits, NaN as an empty field.
    """
    write_blocks_csv(stream, [columns])


def write_blocks_csv(stream: BinaryIO, blocks: Iterable[Mapping[str, Sequence[object]]]) -> None:
    """Write a long table block by block; each has the same columns. See `write_table_csv`."""
    text = io.TextIOWrapper(stream, encoding="utf-8", newline="", write_through=True)
    writer = csv.writer(text, lineterminator="\n")
    for k, columns in enumerate(blocks):
        if k == 0:
            writer.writerow([printable(name) for name in columns])
        writer.writerows(zip(*([_field(value) for value in column] for column in columns.values()), strict=True))
    text.detach()


def _field(value: object) -> object:
    if isinstance(value, str):
        return printable(value)  # a name may hold what no text file can
    if not isinstance(value, float):
        return value
    return "" if value != value else f"{value + 0.0:.9g}"  # no -0
