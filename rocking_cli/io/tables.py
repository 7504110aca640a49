"""Tables as files, CSV or Parquet by the extension of the file name, written in blocks of rows."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import BinaryIO

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import write_whole
from rocking_cli.text import keeps_formulas, printable

Columns = Mapping[str, "Sequence[object] | np.ndarray"]
PARQUET = ".parquet"
ROWS_PER_BLOCK = 4_000  # written at a time, so that the text of a large table is never in memory
_NUMBER = r"[-+]?[\d.,]+(?:[eE][-+]?\d+)?"
_FORMULA = re.compile(rf"\s*(?!{_NUMBER}(?:\s*;\s*{_NUMBER})*\Z)[=+\-@].", re.ASCII)
"""Beginning of a text that a spreadsheet would compute; numbers, and lists of them, stay numbers."""


def check_table(path: Path | None) -> None:
    """Raise `InputError`, before any work, if a Parquet file is requested without pyarrow installed."""
    if path is not None and path.suffix.lower() == PARQUET and find_spec("pyarrow") is None:
        hint = "pip install 'rocking-cli[parquet]', or give a name that ends in .csv"
        raise InputError(Problem("Parquet needs the package pyarrow, which is not installed", str(path), hint=hint))


def write_table(
    path: Path, blocks: Iterable[Columns], *, separator: str = ",", decimal: str = ".", mark: bool = False
) -> None:
    """Write a table.

    Parameters
    ----------
    path : Path
        Path of the file. If it ends in .parquet, a Parquet file at full precision is written, with a row group for each
        block and null for NaN; otherwise text with nine digits, an empty field for NaN, and an apostrophe before names,
        texts and headings that a spreadsheet would compute.
    blocks : iterable of mapping of str to sequence
        Blocks of rows, all with the same columns; a column has words, integers or reals.
    separator, decimal : str
        What separates the cells of a text, and the decimal sign of its numbers.
    mark : bool
        Whether a text begins with the byte order mark, by which spreadsheets know UTF-8.
    """
    text = partial(write_csv, separator=separator, decimal=decimal, mark=mark)
    write = _write_parquet if path.suffix.lower() == PARQUET else text
    write_whole(path, lambda stream: write(stream, blocks))


def write_csv(
    stream: BinaryIO,
    blocks: Iterable[Columns],
    *,
    digits: int | None = 9,
    separator: str = ",",
    decimal: str = ".",
    mark: bool = False,
) -> None:
    """Write a table as text; see `write_table`. With `digits` None, numbers have all their digits."""
    text = io.TextIOWrapper(stream, encoding="utf-8-sig" if mark else "utf-8", newline="", write_through=True)
    writer = csv.writer(text, delimiter=separator, lineterminator="\n")
    for k, columns in enumerate(blocks):
        if k == 0:
            writer.writerow([_field(name, digits, decimal) for name in columns])
        values = list(columns.values())
        numbers = all(isinstance(each, np.ndarray) and each.dtype == np.float64 for each in values)
        if numbers and (digits, separator, decimal) == (9, ",", "."):
            for start in range(0, len(values[0]), ROWS_PER_BLOCK):
                text.write(
                    _lines(np.column_stack([np.asarray(each[start : start + ROWS_PER_BLOCK]) for each in values]))
                )
        else:
            cells = ([_field(value, digits, decimal) for value in column] for column in values)
            writer.writerows(zip(*cells, strict=True))
    text.detach()


def _lines(table: np.ndarray) -> str:
    """Return a table of numbers as lines of text, faster than field by field, as a history has millions of them."""
    line = ",".join(["%.9g"] * table.shape[1]) + "\n"
    return (line * len(table) % tuple((table + 0.0).ravel().tolist())).replace("nan", "")  # + 0.0 turns -0 into 0


def _field(value: object, digits: int | None, decimal: str) -> object:
    if isinstance(value, str):
        text = printable(value)  # a name may have characters that cannot be encoded
        return f"'{text}" if _FORMULA.match(text) and not keeps_formulas.get() else text
    if not isinstance(value, float):
        return value
    if value != value:
        return ""
    return (repr(value + 0.0) if digits is None else f"{value + 0.0:.{digits}g}").replace(".", decimal)  # avoids -0


def _write_parquet(stream: BinaryIO, blocks: Iterable[Columns]) -> None:
    import pyarrow
    from pyarrow import parquet

    writer = None
    for columns in blocks:
        arrays = [pyarrow.array(values, from_pandas=True) for values in columns.values()]  # NaN and None are null
        batch = pyarrow.table(arrays, names=list(columns))
        if writer is None:
            writer = parquet.ParquetWriter(stream, batch.schema)
        writer.write_table(batch.cast(writer.schema))
    if writer is not None:
        writer.close()
