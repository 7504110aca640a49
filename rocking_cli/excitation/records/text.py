"""Delimited text: one column (acceleration) or two (time, acceleration), with or without a header."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.units import UNITS, resolve_unit

TITLE = "delimited text"
SIGN = "a line that begins with a number"

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[EeDd][+-]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE)
_OTHER_TIME = re.compile(r"(?<![a-z])(?:t|time)[ _]*[\[(]?\s*(ms|msec|milliseconds?|min|minutes?)\b", re.IGNORECASE)
_TIME_LABEL = re.compile(r"[\"']?(?:t|time)(?![a-z])", re.IGNORECASE)
_HEAD = 100_000  # characters looked at to recognise a format: a large file is not searched to its end
_HUGE = 1e30  # no time or acceleration in any unit; far below where sums and conversions overflow
_DT_TOLERANCE = 1e-3  # a given interval may be the rounded form of the file's, or the other way round


def sniff(text: str) -> bool:
    """Whether this looks like delimited text: some line begins with a number, and it is not JSON or XML."""
    head = text[:_HEAD]
    return not head.lstrip().startswith(("{", "[", "<")) and _first_row(head.split("\n")) is not None


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read delimited text; arguments, result and errors are those of `registry.Reader.read`."""
    only_channel(file, channel)
    lines = Lines(text)
    start = _first_row(lines)
    if start is None:
        raise InputError(Problem("no numbers found", file=file))
    delimiter = _delimiter(lines[start])
    cells = _clean(lines[start]).split(delimiter)
    numbers_in(file, start + 1, lines[start], cells)  # a title such as "6 km south of" is no row of four columns
    columns = len(cells)
    if columns > 2:
        raise InputError(_too_many_columns(file, start + 1, lines[start], columns))
    header = _header(file, lines[:start], delimiter, columns)

    problems: list[Problem] = []
    unit = ""
    try:
        unit = resolve_unit(file, header, units)
    except InputError as error:
        problems.extend(error.problems)
    if columns == 1 and dt is None:
        hint = "give it with --dt, in seconds, or add a time column before the accelerations"
        problems.append(Problem("one column of accelerations, and no sample interval", file=file, hint=hint))
    if problems:
        raise InputError(*problems)

    table = _table(file, lines, start, delimiter, columns)
    if table.shape[1] < 2:
        raise InputError(Problem("a record needs at least two samples, this has one", file=file, line=start + 1))
    if columns == 2:
        own = _interval(file, lines, start, table[0])
        check_interval(file, None, own, dt)
        dt = own
    assert dt is not None  # one column without it was refused above
    return GroundMotion(Path(file).name, dt, table[-1] * UNITS[unit], unit, "text")


def usable(values: NDArray[np.float64]) -> bool:
    """Whether all values are finite, and not so large that no arithmetic can be done with them."""
    return bool((np.abs(values) < _HUGE).all())


def sensible(value: float) -> bool:
    """Whether one value is `usable`."""
    return abs(value) < _HUGE


def numbers_in(file: str, line_number: int, line: str, tokens: Sequence[str]) -> list[float]:
    """Values of the numbers printed on a line, Fortran's exponents included.

    Parameters
    ----------
    file, line_number, line : str, int, str
        Where they are, for the message.
    tokens : sequence of str
        The numbers as printed.

    Returns
    -------
    list of float
        Their values.

    Raises
    ------
    InputError
        At the first one that is not a finite number, or beyond all measure.
    """
    values = []
    for token in tokens:
        value = _value(token.strip())
        if value is None or not sensible(value):
            raise InputError(_not_a_number(file, line_number, line, token.strip(), known=value is not None))
        values.append(value)
    return values


def only_channel(file: str, asked: str | None) -> None:
    """Refuse any channel but the first, of a file that can hold no other."""
    if asked is not None and asked.strip() != "1":
        message = f"there is no channel '{asked}': the file holds one component"
        raise InputError(Problem(message, file=file, field="--channel", hint="leave --channel out"))


def check_interval(file: str, line_number: int | None, own: float, given: float | None) -> None:
    """Refuse a sample interval [s] given by the user that is not the one of the file."""
    if given is not None and not math.isclose(own, given, rel_tol=_DT_TOLERANCE):
        message = f"the file's sample interval is {own:g} s, but --dt says {given:g} s"
        raise InputError(Problem(message, file=file, line=line_number, hint="leave --dt out: the file states its own"))


def _value(token: str) -> float | None:
    """Value of a printed number; None if it is not one. Stricter than `float`, which takes 1_000."""
    if _NUMBER.fullmatch(token):
        return float(token.upper().replace("D", "E"))
    return math.nan if _NOT_FINITE.fullmatch(token) else None


def _clean(line: str) -> str:
    """Strip outer blanks and empty cells at the end; nothing at all is left of a comment."""
    line = line.strip()
    return "" if line.startswith(("#", "%")) else line.rstrip(",; \t")


def _first_row(lines: Iterable[str]) -> int | None:
    """Index of the first line of data: the first that begins with a number and is not a comment."""
    for index, line in enumerate(lines):
        if _value(re.split(r"[\s,;]", _clean(line), maxsplit=1)[0]) is not None:
            return index
    return None


def _delimiter(row: str) -> str | None:
    """Find what separates the columns, from the first row of data; None stands for blanks."""
    return next((mark for mark in (";", "\t", ",") if mark in _clean(row)), None)


def _header(file: str, lines: Sequence[str], delimiter: str | None, columns: int) -> list[tuple[int, str]]:
    """Line number and text of comments and header lines, the column labels last."""
    comments, header = [], []
    for number, line in enumerate(lines, start=1):
        line = line.strip()
        if line.startswith(("#", "%")):
            comments.append((number, line.lstrip("#% \t")))
        elif line:
            header.append((number, line))
    if header and columns == 2:
        # A spoilt first time, such as O.00 for 0.00, must not pass for a header and lose its sample.
        number, line = header[-1]
        cells = _clean(line).split(delimiter)
        if len(cells) == 2 and _value(cells[1].strip()) is not None:
            raise InputError(_not_a_number(file, number, line, cells[0].strip(), known=False))
        if len(cells) == 2 and _TIME_LABEL.match(cells[1].strip()) and not _TIME_LABEL.match(cells[0].strip()):
            raise InputError(
                Problem("the time is in the second column", file, number, excerpt=line, hint="put the time first")
            )
    found = comments + header
    if found and columns == 2 and (match := _OTHER_TIME.search(found[-1][1])):
        message = f"the time column is in '{match[1]}'"
        raise InputError(Problem(message, file=file, line=found[-1][0], hint="give the times in seconds"))
    return found


def _table(file: str, lines: Lines, start: int, delimiter: str | None, columns: int) -> NDArray[np.float64]:
    """All columns as the rows of an array; by numpy's own, fast parser, by the careful one on a page it gives up."""
    table = np.empty((columns, len(lines) - start))  # rather too wide: blank lines and comments hold nothing
    filled = 0
    for first, page in lines.pages(start):
        part = _quick_table(page, delimiter, columns)
        if part is None:  # perhaps only because of comments or empty cells
            part = _quick_table([row for line in page if (row := _clean(line))], delimiter, columns)
        if part is None:
            part = _careful_table(file, first, page, delimiter, columns)
        table[:, filled : filled + len(part)] = part.T
        filled += len(part)
    return table[:, :filled]


def _quick_table(lines: Sequence[str], delimiter: str | None, columns: int) -> NDArray[np.float64] | None:
    """Parse the lines with numpy; None if it does not understand one of them, or a value is not usable."""
    if not any(line.strip() for line in lines):  # numpy warns of that
        return np.empty((0, columns))
    try:
        table = np.loadtxt(lines, dtype=np.float64, delimiter=delimiter, comments=None, ndmin=2)
    except ValueError:
        return None
    return table if table.shape[1] == columns and usable(table) else None


def _careful_table(
    file: str, first: int, lines: Sequence[str], delimiter: str | None, columns: int
) -> NDArray[np.float64]:
    """Parse the lines from index `first` on one by one: to say which is wrong, or take what numpy does not, 1D-3."""
    values: list[float] = []
    for number, line in enumerate(lines, start=first + 1):
        row = _clean(line)
        if not row:
            continue
        cells = row.split(delimiter)
        if len(cells) != columns:
            numbers_in(file, number, line, cells)  # a word or an empty cell is the better thing to point at
            message = f"this row has {len(cells)} column{'s' * (len(cells) > 1)}, the rows before it have {columns}"
            raise InputError(Problem(message, file=file, line=number, excerpt=line.strip()[:100]))
        values.extend(numbers_in(file, number, line, cells))
    return np.array(values).reshape(-1, columns)


def _interval(file: str, lines: Lines, start: int, time: NDArray[np.float64]) -> float:
    """Interval of evenly spaced times [s]; an error at the first time that is out of step."""
    steps = np.diff(time)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 1
        what = "is repeated" if steps[row - 1] == 0 else f"comes after {time[row - 1]:g} s"
        hint = "the first column must be the time, increasing; printed times need enough decimals to tell rows apart"
        raise InputError(_at_row(file, lines, start, row, f"time does not increase: {time[row]:g} s {what}", hint))

    dt = float((time[-1] - time[0]) / (len(time) - 1))
    if dt < 1e-9:
        hint = "the first column must be the time, in seconds"
        raise InputError(Problem(f"the times give a sample interval of {dt:g} s", file=file, hint=hint))
    usual = float(np.median(steps))
    even = time[0] + dt * np.arange(len(time))
    # Rounding moves each time by up to half its last digit: a step, or a time against the ends, by a whole one.
    tolerance = max(0.01 * dt, 1.001 * _rounding(time, dt))
    # The steps find a missing sample where it is; the distances find steps that grow bit by bit.
    odd_step = np.abs(steps - usual) > tolerance
    out_of_step = np.abs(time - even) > tolerance
    if odd_step.any():
        row = int(np.argmax(odd_step)) + 1
        message = f"time is uneven: a step of {steps[row - 1]:.6g} s here, of {usual:.6g} s elsewhere"
    elif out_of_step.any():
        row = int(np.argmax(out_of_step))
        message = f"time is uneven: {time[row]:.9g} s here, a constant interval would give {even[row]:.9g} s"
    else:
        return dt
    hint = "resample at a constant interval; if only the printed times are rough, keep the accelerations and give --dt"
    raise InputError(_at_row(file, lines, start, row, message, hint))


def _rounding(time: NDArray[np.float64], dt: float) -> float:
    """Find the resolution times are printed with [s], if it is below a tenth of `dt` but not negligible; else 0."""
    decimals = math.floor(-math.log10(dt / 10) + 1e-9) + 1
    resolution = 10.0**-decimals
    return resolution if (np.abs(time - np.round(time, decimals)) < 1e-6 * resolution).all() else 0.0


def _at_row(file: str, lines: Lines, start: int, row: int, message: str, hint: str) -> Problem:
    """Place a problem at a row of the table, counted from 0; blank lines and comments are no rows."""
    numbers = (number for number, line in enumerate(lines, start=1) if number > start and _clean(line))
    number = next(islice(numbers, row, None))
    return Problem(message, file=file, line=number, excerpt=lines[number - 1].strip()[:100], hint=hint)


def _not_a_number(file: str, line_number: int, line: str, token: str, *, known: bool) -> Problem:
    """Describe a value that cannot be used; `known` for NaN, infinity and the like, which are numbers of a kind."""
    hint = None
    if known:
        message = f"'{token}' is not a finite number of sensible size"
        hint = "repair the record first: every sample must have a value"
    elif not token:
        message = "a value is missing"
    else:
        message = f"'{token}' is not a number"
        hint = "correct it, or begin the line with # if it is a header or a comment"
        if re.search(r"\d,\d", line) and "." not in line:
            hint = "write decimals with a point, not a comma"
    return Problem(message, file=file, line=line_number, excerpt=line.strip()[:100], hint=hint)


def _too_many_columns(file: str, line_number: int, line: str, columns: int) -> Problem:
    """Describe a table that is wider than time and acceleration."""
    message = f"{columns} columns: only one (acceleration) or two (time, acceleration) can be read for now"
    hint = "keep the time and one acceleration, or give the file as the data centre made it"
    return Problem(message, file=file, line=line_number, excerpt=line.strip()[:100], hint=hint)
