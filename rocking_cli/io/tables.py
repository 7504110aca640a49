"""Tables as files, CSV, Parquet or .xlsx by the extension of the file name, written in blocks of rows."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from importlib.util import find_spec
from itertools import chain
from math import isfinite
from pathlib import Path
from typing import BinaryIO

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import write_whole
from rocking_cli.text import keeps_formulas, printable

Columns = Mapping[str, "Sequence[object] | np.ndarray"]
PARQUET, XLSX = ".parquet", ".xlsx"
NEEDED = {PARQUET: ("pyarrow", "parquet"), XLSX: ("xlsxwriter", "spreadsheet")}
"""Package that writes a kind of file, and the extra that installs it."""
MAX_SHEET_ROWS = 1_048_576
ROWS_PER_BLOCK = 4_000  # written at a time, so that the text of a large table is never in memory
_NUMBER = r"[-+]?[\d.,]+(?:[eE][-+]?\d+)?"
_FORMULA = re.compile(rf"\s*(?!{_NUMBER}(?:\s*;\s*{_NUMBER})*\Z)[=+\-@].", re.ASCII)
"""Beginning of a text that a spreadsheet would compute; numbers, and lists of them, stay numbers."""


def stacked(tables: Iterable[Mapping[str, object]]) -> dict[str, np.ndarray]:
    """Return tables one below the other: a value that is no sequence stands for a whole column.

    Examples
    --------
    >>> table = stacked([{"model": "one", "t": [0.0, 0.1], "slip": 0.0}, {"model": "two", "t": [0.0]}])
    >>> {name: values.tolist() for name, values in table.items()}
    {'model': ['one', 'one', 'two'], 't': [0.0, 0.1, 0.0], 'slip': [0.0, 0.0, nan]}
    """
    parts = [{name: column_of(values) for name, values in table.items()} for table in tables]
    sizes = [max((values.size for values in part.values() if values.ndim), default=1) for part in parts]
    heads = dict.fromkeys(name for part in parts for name in part)
    gap = np.array(np.nan)
    return {
        name: np.concatenate(
            [np.broadcast_to(part.get(name, gap), size) for part, size in zip(parts, sizes, strict=True)]
        )
        for name in heads
    }


def column_of(values: object) -> np.ndarray:
    """Return values as an array, of objects if they are words."""
    array = np.asarray(values)
    return array.astype(object) if array.dtype.kind in "US" else array


def check_table(path: Path | None) -> None:
    """Raise `InputError`, before any work, if a kind of file is requested whose package is not installed."""
    suffix = path.suffix.lower() if path is not None else ""
    package, extra = NEEDED.get(suffix, ("", ""))
    if package and find_spec(package) is None:
        hint = f"pip install 'rocking-cli[{extra}]', or give a name that ends in .csv"
        raise InputError(Problem(f"{suffix} needs the package {package}, which is not installed", str(path), hint=hint))


def write_table(
    path: Path, blocks: Iterable[Columns], *, separator: str = ",", decimal: str = ".", mark: bool = False
) -> None:
    """Write a table.

    Parameters
    ----------
    path : Path
        Path of the file. If it ends in .parquet, a Parquet file at full precision is written, with a row group for each
        block and null for NaN; if it ends in .xlsx, a sheet with an empty cell for NaN; otherwise text with nine
        digits, an empty field for NaN, and an apostrophe before names, texts and headings that a spreadsheet would
        compute.
    blocks : iterable of mapping of str to sequence
        Blocks of rows, all with the same columns; a column has words, integers or reals.
    separator, decimal : str
        What separates the cells of a text, and the decimal sign of its numbers.
    mark : bool
        Whether a text begins with the byte order mark, by which spreadsheets know UTF-8.
    """
    text = partial(write_csv, separator=separator, decimal=decimal, mark=mark)
    write = {PARQUET: _write_parquet, XLSX: _write_xlsx}.get(path.suffix.lower(), text)
    write_whole(path, lambda stream: write(stream, blocks))


def write_csv(
    stream: BinaryIO,
    blocks: Iterable[Columns],
    *,
    separator: str = ",",
    decimal: str = ".",
    mark: bool = False,
) -> None:
    """Write a table as text; see `write_table`."""
    text = io.TextIOWrapper(stream, encoding="utf-8-sig" if mark else "utf-8", newline="", write_through=True)
    writer = csv.writer(text, delimiter=separator, lineterminator="\n")
    for k, columns in enumerate(blocks):
        if k == 0:
            writer.writerow([_field(name, decimal) for name in columns])
        values = list(columns.values())
        numbers = all(isinstance(each, np.ndarray) and each.dtype == np.float64 for each in values)
        if numbers and (separator, decimal) == (",", "."):
            for start in range(0, len(values[0]), ROWS_PER_BLOCK):
                text.write(
                    _lines(np.column_stack([np.asarray(each[start : start + ROWS_PER_BLOCK]) for each in values]))
                )
        else:
            cells = ([_field(value, decimal) for value in column] for column in values)
            writer.writerows(zip(*cells, strict=True))
    text.detach()


def _lines(table: np.ndarray) -> str:
    """Return a table of numbers as lines of text, faster than field by field, as a history has millions of them."""
    line = ",".join(["%.9g"] * table.shape[1]) + "\n"
    return (line * len(table) % tuple((table + 0.0).ravel().tolist())).replace("nan", "")  # + 0.0 turns -0 into 0


def _field(value: object, decimal: str) -> object:
    if isinstance(value, str):
        text = printable(value)  # a name may have characters that cannot be encoded
        return f"'{text}" if _FORMULA.match(text) and not keeps_formulas.get() else text
    if not isinstance(value, float):
        return value
    if value != value:
        return ""
    return f"{value + 0.0:.9g}".replace(".", decimal)  # avoids -0


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


def _write_xlsx(stream: BinaryIO, blocks: Iterable[Columns]) -> None:
    from xlsxwriter import Workbook

    with Workbook(stream, {"constant_memory": True}) as book:  # also removes its temporary files after an error
        sheet = book.add_worksheet()
        sheet.freeze_panes(1, 0)
        blocks = iter(blocks)
        first = next(blocks)
        tables = (zip(*columns.values(), strict=True) for columns in chain([first], blocks))
        for line, row in enumerate(chain([first], chain.from_iterable(tables))):
            if line >= MAX_SHEET_ROWS:
                what = f"the table has more than the {MAX_SHEET_ROWS:,} rows of a sheet"
                raise InputError(Problem(what, hint="give a name that ends in .csv"))
            for place, value in enumerate(row):
                if isinstance(value, bool | np.bool_):
                    sheet.write_boolean(line, place, bool(value))
                elif isinstance(value, int | float | np.number) and isfinite(value):
                    sheet.write_number(line, place, value + 0.0)
                elif value is not None and value == value:
                    sheet.write_string(line, place, printable(str(value)))
