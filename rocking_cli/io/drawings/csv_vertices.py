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
from dataclasses import dataclass, field
from itertools import chain

import numpy as np

from rocking_cli.errors import InputError
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnText, LineDrawing, OmittedKind
from rocking_cli.io.drawings.rings import MAX_ELEMENTS, MAX_NUMBER, MAX_SIDES, inside
from rocking_cli.io.spreadsheet import NUMBER, decoded, unit_in
from rocking_cli.text import cut
from rocking_cli.units import KINDS

TITLE = "CSV of vertices"
ENDINGS = (".csv", ".tsv", ".txt")

MAX_BYTES = 20_000_000
SNIFFED_LINES = 50

_COLUMNS = {
    "x": "x",
    "y": "y",
    "outline": "outline",
    "body": "outline",
    "name": "outline",
    "layer": "layer",
    "bulge": "bulge",
}
_TWO_NUMBERS = re.compile(r"\s*[-+]?[\d.]+(?:,\d+)?(?:[eE][-+]?\d+)?[\s,;]+[-+]?[\d.]*\d", re.ASCII)


@dataclass
class _OutlineRows:
    """Rows of one outline."""

    name: str
    layer: str
    line: int
    points: list[complex] = field(default_factory=list)
    bulges: list[float] = field(default_factory=list)


def sniff(data: bytes, ending: str) -> bool:
    """Return whether a file is a CSV of vertices: by its ending, and a row of numbers near its start."""
    start = data[:10_000].replace(b"\0", b"").decode("latin-1").splitlines()[:SNIFFED_LINES]
    rows = [row for row in start if row.strip()]
    return ending in ENDINGS and (not rows or any(_TWO_NUMBERS.search(row[:200]) for row in rows))


def read(data: bytes, file: str) -> LineDrawing:
    """Return the drawing in a file. Raises `DrawingError`."""
    if len(data) > MAX_BYTES:
        raise DrawingError("too_large", f"the drawing has more than {MAX_BYTES / 1e6:g} MB", file)
    try:
        text, _ = decoded(data, file)
    except InputError as error:
        (problem,) = error.problems
        raise DrawingError("not_csv", problem.message, file, hint=problem.hint, line=problem.line) from None
    lines = enumerate(io.StringIO(text, newline=None), start=1)
    rows = ((k, line) for k, line in lines if not line.lstrip().startswith("#"))
    first = next(((k, line) for k, line in rows if line.strip()), None)
    if first is None:
        raise DrawingError("empty", "the file has no rows", file)
    table = _Table(first, rows, file)
    outlines = list(table.outlines())
    if not outlines:
        raise DrawingError("empty", "the file has no rows of numbers", file)
    chains, labels = [], []
    for each in outlines:
        points, bulges = np.array(each.points), np.array(each.bulges)
        if len(points) > 1 and points[0] == points[-1]:
            points, bulges = points[:-1], bulges[:-1]
        if len(points) < 2:
            raise DrawingError("not_csv", "the outline that starts here has one corner", file, line=each.line)
        is_closed = len(points) > 2 or bool(bulges.any())
        chains.append(DrawnLine(points, bulges, is_closed, each.layer, "outline", each.name))
        if each.name:
            labels.append(DrawnText(each.name, inside([points]) if is_closed else points.mean(), each.layer, "name"))
    why = "it is not x, y, outline, layer or bulge"
    left = [OmittedKind(f"column `{cut(name)}`", "", why, 1) for name in table.unknown]
    return LineDrawing(TITLE, chains, labels, (), left)


class _Table:
    """The cells of a file, and what its columns are."""

    def __init__(self, first: tuple[int, str], rows: Iterator[tuple[int, str]], file: str) -> None:
        self.file = file
        line, row = first
        self.separator = _separator(row)
        cells = self._cells(line, row)
        self.unknown: list[str] = []
        self.places = {"x": 0, "y": 1}
        self.width = 2
        if not cells or self._number(cells[0]) is None:
            self._head(cells, line)
            self.rows = rows
        else:
            self.rows = chain([first], rows)

    def _head(self, cells: Sequence[str], line: int) -> None:
        """Take the headings."""
        self.places, self.width = {}, len(cells)
        for k, cell in enumerate(cells):
            heading = unit_in(cell, KINDS["length"])[0].lower()
            meaning = _COLUMNS.get(heading)
            if meaning is None:
                self.unknown.append(cell)
            elif meaning in self.places:
                raise self._fault(f"two columns, `{cut(cell)}` is the second, mean the same: rename one", line)
            else:
                self.places[meaning] = k
        if not {"x", "y"} <= self.places.keys():
            raise self._fault(f"the headings have no x and y: `{cut(', '.join(cells))}`", line)

    def outlines(self) -> Iterator[_OutlineRows]:
        """Yield the outlines."""
        current: _OutlineRows | None = None
        done: set[str] = set()
        is_named, count, rings = "outline" in self.places, 0, 0
        for line, row in self.rows:
            cells = self._cells(line, row)
            if not any(cells):
                if current and not is_named:
                    yield current
                    current = None
                continue
            cells += [""] * (self.width - len(cells))
            if any(cells[self.width :]):
                hint = "separate cells with semicolons if numbers have decimal commas; more columns need headings"
                raise self._fault(f"the row has {len(cells)} cells instead of {self.width}", line, hint)
            name, layer = (cells[self.places[key]] if key in self.places else "" for key in ("outline", "layer"))
            if current and name != current.name:
                yield current
                done.add(current.name)
                current = None
            if current is None:
                if name in done:
                    raise self._fault(f"the outline `{cut(name)}` begins a second time", line)
                current = _OutlineRows(name, layer, line)
                rings += 1
                if rings > MAX_ELEMENTS:
                    raise DrawingError("too_large", f"the drawing has more than {MAX_ELEMENTS:,} outlines", self.file)
            elif layer != current.layer:
                message = f"the outline is on two layers, `{cut(current.layer)}` and `{cut(layer)}`"
                raise self._fault(message, line)
            count += 1
            if count > MAX_SIDES:
                raise DrawingError("too_large", f"the drawing has more than {MAX_SIDES:,} sides", self.file)
            current.points.append(complex(self._value(cells, "x", line), self._value(cells, "y", line)))
            bulge = "bulge" in self.places and cells[self.places["bulge"]]
            current.bulges.append(self._value(cells, "bulge", line) if bulge else 0.0)
        if current:
            yield current

    def _cells(self, line: int, row: str) -> list[str]:
        if self.separator is None:
            return row.split()
        if '"' not in row:
            return [cell.strip() for cell in row.split(self.separator)]
        try:
            return [cell.strip() for cell in next(csv.reader([row], delimiter=self.separator, strict=True))]
        except csv.Error as error:
            raise self._fault(f"the row is not valid CSV: {error}", line) from None

    def _number(self, cell: str) -> float | None:
        """Return the number in a cell; None if it is not one."""
        plain = cell if self.separator == "," or "." in cell else cell.replace(",", ".")
        return float(plain) if NUMBER.fullmatch(plain) else None

    def _value(self, cells: Sequence[str], column: str, line: int) -> float:
        cell = cells[self.places[column]]
        number = self._number(cell)
        if number is None:
            raise self._fault(f"{column} is `{cut(cell)}`, which is not a number", line)
        if not abs(number) < MAX_NUMBER:
            raise DrawingError("number", f"{column} is beyond {MAX_NUMBER:g}", self.file, line=line)
        return number

    def _fault(self, message: str, line: int, hint: str | None = None) -> DrawingError:
        return DrawingError("not_csv", message, self.file, hint=hint, line=line)


def _separator(row: str) -> str | None:
    """Return what separates the cells of a row; None for blanks."""
    for each in ";\t":
        if each in row:
            return each
    cells = row.split()
    are_numbers = len(cells) > 1 and all(re.fullmatch(r"[-+]?[\d.]+(?:,\d+)?", cell, re.ASCII) for cell in cells)
    return "," if "," in row and not are_numbers else None
