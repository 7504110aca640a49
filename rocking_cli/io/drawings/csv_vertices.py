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
from itertools import groupby

import numpy as np

from rocking_cli.errors import InputError
from rocking_cli.io.drawings import contract
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnText, LineDrawing, OmittedKind
from rocking_cli.io.spreadsheet import NUMBER, decoded, unit_in
from rocking_cli.text import cut
from rocking_cli.units import KINDS

TITLE = "CSV of vertices"
ENDINGS = (".csv", ".tsv", ".txt")

MAX_BYTES = 20_000_000
SNIFFED_LINES = 50

_COLUMNS = {each: each for each in ("x", "y", "outline", "layer", "bulge")} | {"body": "outline", "name": "outline"}
_TWO_NUMBERS = re.compile(r"\s*[-+]?[\d.]+(?:,\d+)?(?:[eE][-+]?\d+)?[\s,;]+[-+]?[\d.]*\d", re.ASCII)


def sniff(data: bytes, ending: str) -> bool:
    """Return whether a file is a CSV of vertices: by its ending, and a row of numbers near its start."""
    start = data[:10_000].replace(b"\0", b"").decode("latin-1").splitlines()[:SNIFFED_LINES]
    rows = [row for row in start if row.strip()]
    return ending in ENDINGS and (not rows or any(_TWO_NUMBERS.search(row[:200]) for row in rows))


def read(data: bytes, file: str) -> LineDrawing:
    """Return the drawing in a file. Raises `DrawingError`."""
    contract.check_content(data, MAX_BYTES, file)
    try:
        text, _ = decoded(data, file)
    except InputError as error:
        (problem,) = error.problems
        raise DrawingError("not_csv", problem.message, file, hint=problem.hint, line=problem.line) from None
    left, chains, labels = list[OmittedKind](), list[DrawnLine](), list[DrawnText]()
    done = set[str]()
    for name, rows in groupby(_corners(text, file, left), lambda corner: corner[0]):
        _, lines, layers, points, bulges = (list(column) for column in zip(*rows, strict=True))
        if name in done:
            raise _fault(f"the outline `{cut(name)}` begins a second time", file, lines[0])
        done.add(name)
        contract.check_count(len(done), contract.MAX_ELEMENTS, "outlines", file)
        for line, layer in zip(lines, layers, strict=True):
            if layer != layers[0]:
                what = f"the outline is on two layers, `{cut(layers[0])}` and `{cut(layer)}`"
                raise _fault(what, file, line)
        count = len(points) - (len(points) > 1 and points[0] == points[-1])
        if count < 2:
            raise _fault("the outline that starts here has one corner", file, lines[0])
        z, turns, handle = np.array(points[:count]), np.array(bulges[:count]), name.lstrip("\n")
        chains.append(DrawnLine(z, turns, count > 2 or bool(turns.any()), layers[0], "outline", handle))
        if handle:
            labels.append(DrawnText(handle, contract.inside([z]), layers[0], "name"))
    if not chains:
        raise DrawingError("empty", "the file has no rows of numbers", file)
    return LineDrawing(TITLE, chains, labels, (), left)


def _corners(text: str, file: str, left: list[OmittedKind]) -> Iterator[tuple[str, int, str, complex, float]]:
    """Yield the outline, line, layer, place and bulge of each row; an outline without a name is its blank lines.

    Columns that mean nothing are added to `left`.
    """
    places, width, separator, blanks, count = dict[str, int](), 0, None, "", 0
    for line, row in enumerate(io.StringIO(text, newline=None), start=1):
        if row.lstrip().startswith("#"):
            continue
        if not width:
            separator = _separator(row)
        try:
            cells = next(csv.reader([row], delimiter=separator, strict=True)) if separator else row.split()
        except csv.Error as error:
            raise _fault(f"the row is not valid CSV: {error}", file, line) from None
        cells = [cell.strip() for cell in cells]
        if not any(cells):
            blanks += "\n"
            continue
        if not width:
            is_head = _number(cells[0], separator) is None
            width = len(cells) if is_head else 2
            places = _places(cells, file, line, left) if is_head else {"x": 0, "y": 1}
            if is_head:
                continue
        count += 1
        contract.check_count(count, contract.MAX_SIDES, "sides", file)
        cells += [""] * (width - len(cells))
        if any(cells[width:]):
            hint = "separate cells with semicolons if numbers have decimal commas; more columns need headings"
            raise _fault(f"the row has {len(cells)} cells instead of {width}", file, line, hint)
        given = {column: cells[place] for column, place in places.items()}
        numbers = {column: _number(given.get(column, ""), separator) for column in ("x", "y", "bulge")}
        for column, number in numbers.items():
            if number is None and (column != "bulge" or given.get(column)):
                raise _fault(f"{column} is `{cut(given[column])}`, which is not a number", file, line)
            if number is not None and not abs(number) < contract.MAX_NUMBER:
                raise DrawingError("number", f"{column} is beyond {contract.MAX_NUMBER:g}", file, line=line)
        x, y, bulge = (number or 0.0 for number in numbers.values())
        yield given.get("outline", blanks), line, given.get("layer", ""), complex(x, y), bulge


def _places(cells: Sequence[str], file: str, line: int, left: list[OmittedKind]) -> dict[str, int]:
    """Return the places of columns by their headings."""
    places = dict[str, int]()
    for k, cell in enumerate(cells):
        meaning = _COLUMNS.get(unit_in(cell, KINDS["length"])[0].lower())
        if meaning is None:
            left.append(OmittedKind(f"column `{cut(cell)}`", "", "it is not x, y, outline, layer or bulge", 1))
        elif places.setdefault(meaning, k) != k:
            raise _fault(f"two columns, `{cut(cell)}` is the second, mean the same: rename one", file, line)
    if not {"x", "y"} <= places.keys():
        raise _fault(f"the headings have no x and y: `{cut(', '.join(cells))}`", file, line)
    return places


def _number(cell: str, separator: str | None) -> float | None:
    """Return the number in a cell; None if it is not one."""
    plain = cell if separator == "," or "." in cell else cell.replace(",", ".")
    return float(plain) if NUMBER.fullmatch(plain) else None


def _fault(message: str, file: str, line: int, hint: str | None = None) -> DrawingError:
    return DrawingError("not_csv", message, file, hint=hint, line=line)


def _separator(row: str) -> str | None:
    """Return what separates the cells of a row; None for blanks."""
    for each in ";\t":
        if each in row:
            return each
    cells = row.split()
    are_numbers = len(cells) > 1 and all(re.fullmatch(r"[-+]?[\d.]+(?:,\d+)?", cell, re.ASCII) for cell in cells)
    return "," if "," in row and not are_numbers else None
