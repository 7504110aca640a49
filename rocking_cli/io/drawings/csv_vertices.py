"""CSV of vertices: a row a corner, with its coordinates x and y.

Headings are x and y, and if wanted `outline` (or `body`, `name`), `layer` and `bulge`, in any order; without headings
there are two columns, x and y. Rows of one `outline` belong together, or else a blank line ends an outline. All
outlines are closed, their first corner repeated or not, except that two corners are a line. A bulge is tan(turn/4) of
the arc to the next corner, positive if it turns anticlockwise. Lines that begin with # are comments. Commas,
semicolons, tabs or blanks separate the cells; unless commas do, numbers may have decimal commas.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Sequence
from itertools import chain, groupby
from typing import NamedTuple

import numpy as np

from rocking_cli.errors import InputError
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnText, LineDrawing, OmittedKind
from rocking_cli.io.drawings.limits import MAX_ELEMENTS, MAX_NUMBER, MAX_SIDES, check_content, check_count, inside
from rocking_cli.io.spreadsheet import NUMBER, decoded, unit_in
from rocking_cli.text import cut
from rocking_cli.units import KINDS

TITLE = "CSV of vertices"
ENDINGS = (".csv", ".tsv", ".txt")

MAX_BYTES = 20_000_000
SNIFFED_LINES = 50

_COLUMNS = {each: each for each in ("x", "y", "outline", "layer", "bulge")} | {"body": "outline", "name": "outline"}
_TWO_NUMBERS = re.compile(r"\s*[-+]?[\d.]+(?:,\d+)?(?:[eE][-+]?\d+)?[\s,;]+[-+]?[\d.]*\d", re.ASCII)


class _Corner(NamedTuple):
    """A row: its line, the name of its outline, or else how many blank lines are before it, and its values."""

    line: int
    outline: str | int
    layer: str
    at: complex
    bulge: float


def sniff(data: bytes, ending: str) -> bool:
    """Return whether a file is a CSV of vertices: by its ending, and a row of numbers near its start."""
    start = data[:10_000].replace(b"\0", b"").decode("latin-1").splitlines()[:SNIFFED_LINES]
    rows = [row for row in start if row.strip()]
    return ending in ENDINGS and (not rows or any(_TWO_NUMBERS.search(row[:200]) for row in rows))


def read(data: bytes, file: str) -> LineDrawing:
    """Return the drawing in a file. Raises `DrawingError`."""
    check_content(data, MAX_BYTES, file)
    try:
        text, _ = decoded(data, file)
    except InputError as error:
        (problem,) = error.problems
        raise DrawingError("not_csv", problem.message, file, hint=problem.hint, line=problem.line) from None
    table = _Table(text, file)
    chains: list[DrawnLine] = []
    labels: list[DrawnText] = []
    done: set[str | int] = set()
    for name, rows in groupby(table.corners(), lambda corner: corner.outline):
        first, *more = rows
        if name in done:
            raise table.fault(f"the outline `{cut(str(name))}` begins a second time", first.line)
        done.add(name)
        check_count(len(done), MAX_ELEMENTS, "outlines", file)
        for each in more:
            if each.layer != first.layer:
                message = f"the outline is on two layers, `{cut(first.layer)}` and `{cut(each.layer)}`"
                raise table.fault(message, each.line)
        corners = [first, *more]
        if more and first.at == more[-1].at:
            del corners[-1]
        if len(corners) < 2:
            raise table.fault("the outline that starts here has one corner", first.line)
        points, bulges = np.array([each.at for each in corners]), np.array([each.bulge for each in corners])
        is_closed, handle = len(points) > 2 or bool(bulges.any()), name if isinstance(name, str) else ""
        chains.append(DrawnLine(points, bulges, is_closed, first.layer, "outline", handle))
        if handle:
            labels.append(DrawnText(handle, inside([points]), first.layer, "name"))
    if not chains:
        raise DrawingError("empty", "the file has no rows of numbers", file)
    why = "it is not x, y, outline, layer or bulge"
    left = [OmittedKind(f"column `{cut(name)}`", "", why, 1) for name in table.unknown]
    return LineDrawing(TITLE, chains, labels, (), left)


class _Table:
    """The cells of a file, and what its columns are."""

    def __init__(self, text: str, file: str) -> None:
        lines = enumerate(io.StringIO(text, newline=None), start=1)
        self.rows: Iterator[tuple[int, str]] = ((line, row) for line, row in lines if not row.lstrip().startswith("#"))
        self.file = file
        line, row = first = next(((line, row) for line, row in self.rows if row.strip()), (0, ""))
        self.separator = _separator(row)
        cells = self._cells(line, row)
        self.unknown: list[str] = []
        self.places, self.width = {"x": 0, "y": 1}, 2
        if cells and self._number(cells[0]) is None:
            self._head(cells, line)
        else:
            self.rows = chain([first], self.rows)

    def _head(self, cells: Sequence[str], line: int) -> None:
        """Take the headings."""
        self.places, self.width = {}, len(cells)
        for k, cell in enumerate(cells):
            meaning = _COLUMNS.get(unit_in(cell, KINDS["length"])[0].lower())
            if meaning is None:
                self.unknown.append(cell)
            elif self.places.setdefault(meaning, k) != k:
                raise self.fault(f"two columns, `{cut(cell)}` is the second, mean the same: rename one", line)
        if not {"x", "y"} <= self.places.keys():
            raise self.fault(f"the headings have no x and y: `{cut(', '.join(cells))}`", line)

    def corners(self) -> Iterator[_Corner]:
        """Yield the corners of all outlines."""
        count = blanks = 0
        for line, row in self.rows:
            cells = self._cells(line, row)
            if not any(cells):
                blanks += 1
                continue
            count += 1
            check_count(count, MAX_SIDES, "sides", self.file)
            cells += [""] * (self.width - len(cells))
            if any(cells[self.width :]):
                hint = "separate cells with semicolons if numbers have decimal commas; more columns need headings"
                raise self.fault(f"the row has {len(cells)} cells instead of {self.width}", line, hint)
            given = {column: cells[place] for column, place in self.places.items()}
            x, y = (self._value(given[column], column, line) for column in "xy")
            bulge = self._value(given["bulge"], "bulge", line) if given.get("bulge") else 0.0
            yield _Corner(line, given.get("outline", blanks), given.get("layer", ""), complex(x, y), bulge)

    def _cells(self, line: int, row: str) -> list[str]:
        if self.separator is None:
            return row.split()
        if '"' not in row:
            return [cell.strip() for cell in row.split(self.separator)]
        try:
            return [cell.strip() for cell in next(csv.reader([row], delimiter=self.separator, strict=True))]
        except csv.Error as error:
            raise self.fault(f"the row is not valid CSV: {error}", line) from None

    def _number(self, cell: str) -> float | None:
        """Return the number in a cell; None if it is not one."""
        plain = cell if self.separator == "," or "." in cell else cell.replace(",", ".")
        return float(plain) if NUMBER.fullmatch(plain) else None

    def _value(self, cell: str, column: str, line: int) -> float:
        number = self._number(cell)
        if number is None:
            raise self.fault(f"{column} is `{cut(cell)}`, which is not a number", line)
        if not abs(number) < MAX_NUMBER:
            raise DrawingError("number", f"{column} is beyond {MAX_NUMBER:g}", self.file, line=line)
        return number

    def fault(self, message: str, line: int, hint: str | None = None) -> DrawingError:
        """Return the error for a file that is not a table of vertices."""
        return DrawingError("not_csv", message, self.file, hint=hint, line=line)


def _separator(row: str) -> str | None:
    """Return what separates the cells of a row; None for blanks."""
    for each in ";\t":
        if each in row:
            return each
    cells = row.split()
    are_numbers = len(cells) > 1 and all(re.fullmatch(r"[-+]?[\d.]+(?:,\d+)?", cell, re.ASCII) for cell in cells)
    return "," if "," in row and not are_numbers else None
