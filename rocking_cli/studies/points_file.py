"""A curve from a file of two columns, such as a target spectrum or a hazard curve."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.records.text import numbers_in
from rocking_cli.io.files import read_bytes

MAX_BYTES = 10_000_000
MAX_LISTED_PROBLEMS = 5


class CurvePoints(NamedTuple):
    """The columns of a file, and the unit that the line above them names, if it names one."""

    x: Reals
    y: Reals
    unit: str | None


def separator_in(line: str) -> str | None:
    """Return the separator of the cells of a line; None for blanks."""
    return next((sign for sign in (";", "\t", ",") if sign in line), None)


def read_points(
    path: Path,
    what: str,
    columns: str,
    wrong_points: Callable[[Reals, Reals], list[tuple[int, str]]],
    remedy: Callable[[str], str | None] = lambda message: None,
    unit_in: Callable[[str, int, str], str | None] = lambda file, number, line: None,
) -> CurvePoints:
    """Read the points of a curve from a file of two columns.

    Parameters
    ----------
    path : Path
        A file whose lines each have two numbers, separated by a comma, a semicolon or blanks. Lines above the numbers,
        blank lines, and lines that begin with # are skipped.
    what : str
        Name of such a file in messages.
    columns : str
        What a line has, as a remedy.
    wrong_points : callable
        Returns the invalid points, counted from 0, each with a message; the number of points for what concerns all.
    remedy : callable, optional
        Returns the remedy for a message of a point.
    unit_in : callable, optional
        Returns the unit that a heading names, from file, line number and line.

    Raises
    ------
    InputError
        With file and line.
    """
    shown_path = str(path)
    try:
        lines = read_bytes(path, what, MAX_BYTES).decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise InputError(Problem("this is not UTF-8 text", shown_path, hint="save it as CSV in UTF-8")) from None
    used = [k for k, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#")]
    start = next((place for place, k in enumerate(used) if lines[k].lstrip()[0] in "+-.0123456789"), len(used))
    above, used = used[:start], used[start:]
    unit = unit_in(shown_path, above[-1] + 1, lines[above[-1]]) if above else None
    rows = [_row(shown_path, k + 1, lines[k], columns) for k in used]
    x, y = np.array(rows, dtype=np.float64).reshape(-1, 2).T
    problems = []
    for point, message in wrong_points(x, y):
        if point == len(used):
            message = f"{len(used)} point{'s' * (len(used) != 1)}: {message}"
            problems.append(Problem(message, shown_path, hint=columns))
        else:
            line = lines[used[point]].strip()[:100]
            problems.append(Problem(message, shown_path, used[point] + 1, excerpt=line, hint=remedy(message)))
    if problems:
        raise InputError(*problems[:MAX_LISTED_PROBLEMS])
    return CurvePoints(x, y, unit)


def _row(file: str, number: int, line: str, columns: str) -> list[float]:
    separator = separator_in(line)
    cells = [cell.strip() for cell in line.strip().split(separator)]
    if len(cells) > 2 and not any(cells[2:]):  # a spreadsheet leaves separators of empty columns
        cells = cells[:2]
    if len(cells) != 2:
        message = f"{len(cells)} column{'s' * (len(cells) > 1)}"
        raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint=columns))
    if separator != "," and any(re.fullmatch(r"[+-]?\d+,\d+", cell) for cell in cells):
        hint = "write numbers with a point: 0.25"
        raise InputError(Problem("a comma within a number", file, number, excerpt=line.strip()[:100], hint=hint))
    return numbers_in(file, number, line, cells)
