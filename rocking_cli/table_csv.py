"""A table as comma-separated text."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import BinaryIO


def write_table_csv(stream: BinaryIO, columns: Mapping[str, Sequence[object]]) -> None:
    """Write columns under their headings, a line a row.

    Parameters
    ----------
    stream : binary file
        Where to.
    columns : mapping of str to sequence
        Words, whole numbers, and other numbers, which are written with nine digits, NaN as an empty field.
    """
    text = io.TextIOWrapper(stream, encoding="utf-8", newline="", write_through=True)
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*([_field(value) for value in column] for column in columns.values()), strict=True))
    text.detach()


def _field(value: object) -> object:
    if not isinstance(value, float):
        return value
    return "" if value != value else f"{value:.9g}"
