"""Delimited text: a column of accelerations, or a table with times and accelerations, with or without a header."""

from __future__ import annotations

import math
import re
from collections.abc import Container, Iterable, Sequence
from dataclasses import replace
from datetime import date
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Bools, Reals, median
from rocking_cli.errors import InputError, Problem, how_to_correct, named
from rocking_cli.excitation.base import MOST_SAMPLES, Doubt, GroundMotion
from rocking_cli.excitation.records.columns import (
    FEWEST_ROWS,
    MAX_COLUMNS,
    Choice,
    Label,
    choose,
    counts_rows,
    labels,
    runs_on,
)
from rocking_cli.excitation.records.lines import Lines, PrintedRows, unlike_the_others
from rocking_cli.excitation.records.prepared import read_header
from rocking_cli.excitation.records.record_units import ACCELERATIONS, WORDS, Wanted, component, other_quantity
from rocking_cli.excitation.records.statements import Statements, statements
from rocking_cli.text import regex
from rocking_cli.units import UNITS

TITLE = "delimited text"
SIGN = "a line that begins with a number"
TAKES_WANTED = True

_NUMBER = regex(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[EeDd][+-]?[0-9]+)?")
_NOT_FINITE = regex(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE)
_OTHER_TIME = regex(
    rf"(?<![a-z])(?:{WORDS['time']})[ _,/]*[\[(]?\s*({WORDS['milliseconds']}|min|minutes?)\b", re.IGNORECASE
)
_OF_SPECTRUM = regex(r"(?:natural )?(?:peri[oy]|fre[qck])", re.IGNORECASE)
_FIRST_CELL = regex(r'"([^"]*)"|[^\s,;]*')
_QUOTED = regex(r'"([^"]*)"')
# A date, a time of day or both, before other numbers of a row.
_STAMP = regex(
    r'\s*"?(?:(\d{4})[-/](\d\d?)[-/](\d\d?)[T ,;]+)?(\d\d?):(\d\d):(\d\d)(?:[.,](\d+))?(?:Z|[+-]\d\d:?\d\d)?"?'
    r'(?=[\s,;]+["\d.+-])'
)
_TOUCHING = regex(r"(?<![^\s+-])([+-]?\d*\.\d*(?:[EeDd][+-]?\d+)?)(?=[+-])")
_COMMA_NUMBER = regex(r"[+-]?\d*,\d+(?:[EeDd][+-]?\d+)?")
_SURE_COMMA = regex(r"[+-]?\d*,0\d|-\d*,\d\d|-0?,")  # no pair of whole numbers is written like that
_DAMAGED = regex(r"(?!.*[^\W\d_]{2})\S*\.\d\S*")
_WORD = regex(r"[^\W\d_]{2,}")
DESPITE = ("count", "header_peak")
"""Doubts that `despite_header` has in place of a refusal."""
_SEARCHED_CHARACTERS = 100_000  # the format is recognised within them, so that a large file is not searched to its end
_MAX_VALUE = 1e30  # above any time or acceleration in any unit, and far below overflow
_INTERVAL_RANGE = (1e-9, 1e6)  # s; sums overflow beyond these bounds, and no record has such intervals
MAX_NUMBERS = 4 * MOST_SAMPLES
_MOST_FALLS = 0.1  # share of steps backwards among damaged times
_DT_TOLERANCE = 1e-3  # relative difference; either the given interval or that of the file may be rounded


class Followed(InputError):
    """Error: from line index `end` on, something follows a record, which may be another record."""

    def __init__(self, end: int, problem: Problem) -> None:
        super().__init__(problem)
        self.end = end


def sniff(text: str) -> bool:
    """Return whether this looks like delimited text: a line begins with a number, and it is not JSON or XML."""
    head = text[:_SEARCHED_CHARACTERS]
    return not head.lstrip().startswith(("{", "[", "<")) and _first_row(head.split("\n")) is not None


def read(
    text: str,
    file: str,
    *,
    dt: float | None = None,
    units: str | None = None,
    channel: str | None = None,
    wanted: Wanted = ACCELERATIONS,
) -> GroundMotion:
    """Read delimited text; arguments, result and errors are those of `formats.Reader.read`."""
    rows = _rows(text, file)
    prepared = read_header(file, rows.lines[: rows.start])
    header = _header(file, rows, prepared.lines)
    names, label_lines = labels(file, header, rows.delimiter, rows.columns)
    _refuse_other_times(file, names, label_lines)
    if _OF_SPECTRUM.match(names[0].name):
        message = f"the first column is '{names[0]}', as in a spectrum, and no time"
        raise InputError(Problem(message, file, label_lines[0], hint="give the accelerations in time"))
    stated = statements(file, [*header, *rows.stated])
    interval = stated.interval(dt) or dt

    table, names, remarks = _shaped(file, rows, names, stated, wanted, channel)
    columns = len(names)
    choice = Choice(columns - 1, 0 if columns == 2 else None, "")
    if columns > 2 or (columns == 2 and (_are_components(table, names) or (channel is not None and label_lines))):
        choice = choose(file, table, names, channel, increasing if wanted.uneven else is_even, wanted)
        header = [entry for entry in header if entry[0] not in label_lines]
        header += [(number, str(names[choice.column])) for number in label_lines[:1]]
    elif channel is not None and channel.strip().lower() != names[-1].name.lower():
        only_channel(file, channel)
    if choice.time is not None and interval not in (None, 1.0):
        numbered = not names[choice.time].is_time and counts_rows(table[choice.time])
        choice = replace(choice, time=None if numbered else choice.time)

    problems: list[Problem] = []
    unit, size = "", 1.0
    try:
        unit, size = wanted.unit(file, header, units)
    except InputError as error:
        problems.extend(error.problems)
    if choice.time is None and interval is None:
        problems.append(_no_interval(file, wanted, columns))
    if problems:
        raise InputError(*problems)

    values, uneven = table[choice.column], None
    if choice.time is not None:
        column = _called(names, choice.time) if columns > 2 else None
        try:
            interval, values, uneven = _at_even_times(table[choice.time], values, as_it_comes=wanted.uneven)
        except UnevenTimeError as error:
            raise InputError(_uneven_row(file, rows, column, error)) from None
        stated.check_interval(interval, 0.5 * interval / (table.shape[1] - 1))
        check_interval(file, None, interval, dt)
    assert interval is not None  # a missing interval was refused above
    remarks += _against_header(stated, table, names, choice, unit, wanted)
    if columns == rows.columns:
        place = slice(choice.column, choice.column + 1)
        remarks += unlike_the_others(PrintedRows(rows.lines, rows.start, lambda line: rows.cells(line)[place]))
    if uneven is not None:
        remarks = (*remarks, uneven)
    name = Path(file).name + (f" channel {choice.channel}" if choice.channel else "")
    despite = ("despite header",) * any(each.kind in DESPITE for each in remarks)
    return GroundMotion(
        name, interval, values * size, source_unit=unit, format="text", remarks=(*prepared.remarks, *remarks),
        processing=(*prepared.processing, *despite), prepared_from=prepared.prepared_from, origin=prepared.origin,
    )  # fmt: skip


class _Rows(NamedTuple):
    """The rows of numbers of a text, how they are written, and a first line with number of points and interval."""

    lines: Lines
    start: int  # index of the first row
    end: int  # index after the last row that is as long as the others
    delimiter: str | None  # None for blanks
    commas: bool  # in place of decimal points
    columns: int
    tail: list[float]  # numbers of the last row, if it is shorter
    stated: list[tuple[int, str]]

    def cells(self, line: str) -> list[str]:
        """Return the numbers of a row as printed, also those that touch; none for a comment."""
        return _cells(_clean(line), self.delimiter)


def _rows(text: str, file: str) -> _Rows:
    """Find the rows of numbers in a text, their delimiter and the number of their columns."""
    lines = Lines(text)
    start = _first_row(lines)
    if start is None:
        raise InputError(Problem("no numbers found", file=file))
    lines.check_lengths(file)
    if _STAMP.match(lines[start]):
        lines = Lines(_with_seconds(lines, start))
    elif '"' in lines[start]:
        lines = Lines(_unquoted(file, start + 1, lines[start], text))
    stated = []
    if _is_count_and_interval(lines, start):
        stated = [(start + 1, f"{lines[start].strip()} NPTS, DT")]
        start += 1 + (_first_row(lines.since(start + 1)) or 0)
    first = _clean(lines[start])
    delimiter = next((mark for mark in (";", "\t", ",") if mark in first), None)  # None splits at blanks
    page = [row for line in next(lines.pages(start))[1] if (row := _clean(line))]
    commas = delimiter in (";", "\t") and any("," in row for row in page)
    if delimiter == "," and all(map(_COMMA_NUMBER.fullmatch, page)) and any(map(_SURE_COMMA.match, page)):
        delimiter, commas = None, True
    cells = _cells(first, delimiter)
    # A title such as "6 km south of" is not a row of four columns.
    numbers_in(file, start + 1, lines[start], [cell.replace(",", ".") for cell in cells] if commas else cells)
    columns = len(cells)
    if columns > MAX_COLUMNS:
        raise InputError(Problem(f"a table of {columns} columns cannot be a record", file, start + 1))
    last = next(index for index in range(len(lines) - 1, start - 1, -1) if _clean(lines[index]))
    ends = _cells(_clean(lines[last]), delimiter)
    tail = [value for cell in ends if (value := _value(cell)) is not None and sensible(value)]
    if not len(tail) == len(ends) < columns:
        return _Rows(lines, start, len(lines), delimiter, commas, columns, [], stated)
    return _Rows(lines, start, last, delimiter, commas, columns, tail, stated)


def _cells(row: str, delimiter: str | None) -> list[str]:
    """Split a clean row; numbers of Fortran that touch are parted at their signs."""
    return _TOUCHING.sub(r"\1 ", row).split() if delimiter is None else row.split(delimiter) if row else []


def _is_count_and_interval(lines: Lines, start: int) -> bool:
    """Return whether a row is a number of points and an interval [s], and not one of the table below."""
    below = (re.split(r"[,;\s]+", row) for line in lines.since(start) if (row := _clean(line)))
    rows = list(islice(below, 3))
    if len(rows) < 3 or len(rows[0]) != 2 or not rows[0][0].isdecimal() or not 0 < (_value(rows[0][1]) or 0) < 1:
        return False
    first, second = (_value(row[0]) or 0.0 for row in rows[1:])
    return len(rows[1]) != 2 or ("." in rows[1][0] and first < min(float(rows[0][0]), second))


def _with_seconds(lines: Lines, start: int) -> str:
    """Return the text with seconds since the first row in place of dates and times of day."""
    zero: int | None = None
    out = lines[:start]
    for line in lines.since(start):
        if match := _STAMP.match(line):
            *day, hours, minutes, seconds = (int(each or 1) for each in match.groups()[:-1])
            whole = ((date(*day).toordinal() * 24 + hours) * 60 + minutes) * 60 + seconds
            zero = whole if zero is None else zero
            line = f"{whole - zero}.{match[7] or 0}{line[match.end() :]}"
        out.append(line)
    return "\n".join(out)


def _shaped(
    file: str, rows: _Rows, names: list[Label], stated: Statements, wanted: Wanted, channel: str | None
) -> tuple[Reals, list[Label], tuple[Doubt, ...]]:
    """Return the table without numbers of its rows, or the series that runs on over them, with labels and doubts."""
    table, tail = _table(file, rows, names), rows.tail
    if len(table) > 1 and not names[-1].name and counts_rows(table[-1]):
        table, tail = table[:-1], tail[:-1]
    columns, count = table.shape
    names = names[:columns]
    may_run_on = columns > 1 and not any(label.name for label in names)
    may_run_on &= not (increasing if wanted.uneven else is_even)(table[0])
    may_run_on &= columns > 2 or _are_components(table, names)
    if wanted.run_on and not may_run_on:
        message = "its first column is a time or its columns are labelled, so that its values do not run on"
        raise InputError(Problem(message, file, field=named("run_on"), hint="leave it out"))
    stated_counts = {each.value for each in stated.counts}
    seen = False if stated_counts == {count} or not may_run_on else runs_on(table)
    if wanted.run_on or seen or (may_run_on and tail and stated_counts == {table.size + len(tail)}):
        text = f"its values are read as one series that runs on over the rows, {columns} in each"
        doubts = () if wanted.run_on else (Doubt("run_on", float(columns), text),)
        return np.append(table.T.ravel(), tail)[np.newaxis], [Label("")], doubts
    if rows.tail:
        hint = f"if the values run on from line to line, give {named('run_on')}" if may_run_on else None
        message = f"this row has {len(rows.tail)} column{'s' * (len(rows.tail) > 1)}, the rows before it have "
        excerpt = rows.lines[rows.end].strip()[:100]
        raise InputError(Problem(f"{message}{rows.columns}", file, rows.end + 1, excerpt=excerpt, hint=hint))
    if may_run_on and seen is None and channel is not None and count >= FEWEST_ROWS:
        text = f"nothing tells whether its {columns} columns are components, as it is read, or values that run on"
        return table, names, (Doubt("run_on", float(columns), text),)
    return table, names, ()


def _are_components(table: Reals, names: Sequence[Label]) -> bool:
    """Return whether the first of two columns is a component and not a time: by its name, or as it goes up and down."""
    falls = np.diff(table[0]) <= 0
    if names[0].is_time or not falls.any():
        return False
    return component(names[0].name) is not None or float(falls.mean()) > _MOST_FALLS


def _against_header(
    stated: Statements, table: Reals, names: Sequence[Label], choice: Choice, unit: str, wanted: Wanted
) -> tuple[Doubt, ...]:
    """Return doubts if points or peak are not those of the header; refuse the record without `despite_header`."""
    columns = [k for k in range(len(table)) if k != choice.time and not other_quantity(str(names[k]))]
    despite = wanted.despite_header
    doubts = stated.check_count(table.shape[1], len(columns), despite=despite)
    if wanted.raw or wanted.quantity != "acceleration":
        return doubts
    peaks = [(names[k].name, UNITS[unit] * float(np.abs(table[k]).max())) for k in columns]
    return doubts + stated.check_peak(peaks, columns.index(choice.column), unit, despite=despite)


def _no_interval(file: str, wanted: Wanted, columns: int) -> Problem:
    kind = wanted.values
    what = f"one column of {kind}" if columns == 1 else "no column is called time or is one"
    hint = f"give it with {named('dt')}, in seconds, or add a time column before the {kind}"
    return Problem(f"{what}, and no sample interval", file=file, hint=hint)


def _at_even_times(times: Reals, values: Reals, *, as_it_comes: bool) -> tuple[float, Reals, Doubt | None]:
    """Return the sampling interval [s] and the values, interpolated if uneven times are accepted, with a remark."""
    try:
        return even_interval(times), values, None
    except UnevenTimeError:
        if not as_it_comes or (gridded := on_grid(times, values)) is None:
            raise
        return gridded


def usable(values: Reals) -> bool:
    """Return whether all values are finite, and not too large for arithmetic."""
    return bool((np.abs(values) < _MAX_VALUE).all())


def sensible(value: float) -> bool:
    """Return whether one value is finite, and not too large for arithmetic."""
    return abs(value) < _MAX_VALUE


def numbers_in(file: str, line_number: int, line: str, tokens: Sequence[str]) -> list[float]:
    """Return the values of the numbers printed on a line, including those with Fortran's exponents.

    Parameters
    ----------
    file, line_number, line : str, int, str
        File, line number and text of the line, for messages.
    tokens : sequence of str
        The numbers as printed.

    Returns
    -------
    list of float
        Values of the numbers.

    Raises
    ------
    InputError
        At the first number that is not finite, or far too large.
    """
    values = []
    for token in tokens:
        value = _value(token.strip())
        if value is None or not sensible(value):
            raise InputError(_not_a_number(file, line_number, line, token.strip(), known=value is not None))
        values.append(value)
    return values


def only_channel(file: str, requested: str | None) -> None:
    """Raise `InputError` if a channel other than the first is requested of a file with one channel."""
    if requested is not None and requested.strip() != "1":
        message = f"there is no channel '{requested}': the file holds one component"
        raise InputError(Problem(message, file=file, field=named("channel"), hint=f"leave {named('channel')} out"))


def check_interval(file: str, line_number: int | None, interval: float, requested: float | None) -> None:
    """Raise `InputError` if the sampling interval of the file [s] is not valid, or differs from the given one."""
    if not _INTERVAL_RANGE[0] <= interval <= _INTERVAL_RANGE[1]:
        raise InputError(
            Problem(f"the sampling interval is {interval:g} s, which is not plausible", file=file, line=line_number)
        )
    if requested is not None and not math.isclose(interval, requested, rel_tol=_DT_TOLERANCE):
        message = f"the file's sample interval is {interval:g} s, but {named('dt')} says {requested:g} s"
        raise InputError(
            Problem(message, file=file, line=line_number, hint=f"leave {named('dt')} out: the file states its own")
        )


def _value(token: str) -> float | None:
    """Return the value of a printed number; None if it is not one. Stricter than `float`, which accepts 1_000."""
    if _NUMBER.fullmatch(token):
        return float(token.upper().replace("D", "E"))
    return math.nan if _NOT_FINITE.fullmatch(token) else None


def _clean(line: str) -> str:
    """Return a line without outer blanks and empty cells at its end; empty for a comment."""
    line = line.strip()
    return "" if line.startswith(("#", "%")) else line.rstrip(",; \t")


def _first_row(lines: Iterable[str]) -> int | None:
    """Return the index of the first data line, which begins with a number and is not a comment; None if none does."""
    for index, line in enumerate(lines):
        match = _FIRST_CELL.match(row := _clean(line))
        if _STAMP.match(row):
            return index
        if match and _value(match[0] if match[1] is None else match[1].strip().replace(",", ".")) is not None:
            return index
    return None


def _is_title(cells: Sequence[str], columns: int) -> bool:
    """Return whether a line among numbers has words, and is no damaged row: the header of another record."""
    numbers = sum(_value(cell.strip()) is not None for cell in cells)
    return bool(_WORD.search(cells[0])) and (len(cells) > 1 if columns == 1 else len(cells) != columns or not numbers)


def _unquoted(file: str, line_number: int, row: str, text: str) -> str:
    """Return the text with blanks in place of its quotation marks, after a check of its first row."""
    if any("," in cell for cell in _QUOTED.findall(row)) and not re.search(r"[;\t]", _QUOTED.sub("", row)):
        message = "the commas within quotation marks may be decimal ones, or part thousands"
        hint = "write decimals with a point, or separate the columns with semicolons"
        raise InputError(Problem(message, file, line_number, excerpt=row.strip()[:100], hint=hint))
    return text.replace('"', " ")


def _with_points(file: str, first: int, page: Sequence[str]) -> list[str]:
    """Return the rows of a page from line index `first` on, with points in place of decimal commas."""
    rows = [_clean(line) for line in page]
    for number, row in enumerate(rows, start=first + 1):
        if "." in row:
            message = "a point, in a table with decimal commas"
            hint = "write all decimals with a point, and no mark between thousands"
            raise InputError(Problem(message, file, number, excerpt=row[:100], hint=hint))
    return [row.replace(",", ".") for row in rows]


def _header(file: str, rows: _Rows, skipped: Container[int]) -> list[tuple[int, str]]:
    """Return line number and text of comments and header lines, with the column labels last.

    The header of a prepared record is skipped: its file names and gains belong to the original file.
    """
    comments, header = [], []
    above = rows.stated[0][0] - 1 if rows.stated else rows.start
    for number, line in enumerate(rows.lines[:above], start=1):
        line = line.strip()
        if number in skipped:
            continue
        if line.startswith(("#", "%")):
            comments.append((number, line.lstrip("#% \t")))
        elif line:
            header.append((number, line))
    columns = rows.columns
    if header and columns == 1 and _DAMAGED.fullmatch(header[-1][1]):
        raise InputError(_not_a_number(file, *header[-1], header[-1][1], known=False))
    if header and columns > 1:
        # A damaged first time, such as O.00 for 0.00, must not pass for a header, as its sample would be lost.
        number, line = header[-1]
        cells = [cell.strip() for cell in _clean(line).split(rows.delimiter)]
        if len(cells) == columns and all(_value(cell) is not None for cell in cells[1:]):
            raise InputError(_not_a_number(file, number, line, cells[0], known=False))
        if columns == 2 == len(cells) and Label(cells[1]).is_time and not Label(cells[0]).is_time:
            raise InputError(
                Problem("the time is in the second column", file, number, excerpt=line, hint="put the time first")
            )
    entries = comments + header
    if entries and columns == 2:
        _refuse_other_times(file, [Label(entries[-1][1])], [entries[-1][0]])
    return entries


def _refuse_other_times(file: str, names: Sequence[Label], lines: Sequence[int]) -> None:
    """Raise `InputError` if columns of times are not in seconds, by their labels on these lines."""
    for label in names:
        if match := _OTHER_TIME.search(str(label)):
            message = f"the time column is in '{match[1]}'"
            raise InputError(Problem(message, file=file, line=lines[0], hint="give the times in seconds"))


def _table(file: str, rows: _Rows, names: Sequence[Label]) -> Reals:
    """Return all columns as rows of an array, by numpy's parser, or the slower one for a page that numpy refuses."""
    columns, count = len(names), len(rows.lines) - rows.start
    if count > MOST_SAMPLES or count * columns > MAX_NUMBERS:  # checked before memory is reserved
        limit = MOST_SAMPLES if count > MOST_SAMPLES else MAX_NUMBERS // columns
        message = f"a record has at most {limit} samples in each column, this file has {count} lines"
        raise InputError(Problem(message, file))
    table = np.empty((columns, count))  # may be too wide, as blank lines and comments have no numbers
    filled = 0
    for first, page in rows.lines.pages(rows.start):
        page = page[: max(rows.end - first, 0)]
        if rows.commas:
            page = _with_points(file, first, page)
        part = _quick_table(page, rows.delimiter, columns)
        if part is None:  # try again without comments and empty cells, and with blanks between numbers that touch
            clean = [(rows.delimiter or " ").join(cells) for line in page if (cells := rows.cells(line))]
            part = _quick_table(clean, rows.delimiter, columns)
        if part is None:
            part = _careful_table(file, first, page, rows, names)
        table[:, filled : filled + len(part)] = part.T
        filled += len(part)
    if filled < 2 and not rows.tail:
        raise InputError(Problem("a record needs at least two samples, this has one", file=file, line=rows.start + 1))
    return table[:, :filled]


def _quick_table(lines: Sequence[str], delimiter: str | None, columns: int) -> Reals | None:
    """Parse lines with numpy; None if it cannot parse a line, or a value is not usable."""
    if not any(line.strip() for line in lines):  # numpy would warn of empty input
        return np.empty((0, columns))
    try:
        table = np.loadtxt(lines, dtype=np.float64, delimiter=delimiter, comments=None, ndmin=2)
    except ValueError:
        return None
    return table if table.shape[1] == columns and usable(table) else None


def _careful_table(file: str, first: int, lines: Sequence[str], rows: _Rows, names: Sequence[Label]) -> Reals:
    """Parse lines from index `first` on one by one, to report errors or accept numbers such as 1D-3."""
    values: list[float] = []
    columns = len(names)
    for number, line in enumerate(lines, start=first + 1):
        cells = rows.cells(line)
        if not cells:
            continue
        if number > rows.start + FEWEST_ROWS and _is_title(cells, columns):
            raise Followed(number - 1, _not_a_number(file, number, line, cells[0].strip(), known=False))
        if len(cells) != columns:
            numbers_in(file, number, line, cells)  # a word or an empty cell makes the better message
            message = f"this row has {len(cells)} column{'s' * (len(cells) > 1)}, the rows before it have {columns}"
            raise InputError(Problem(message, file=file, line=number, excerpt=line.strip()[:100]))
        for place, cell in enumerate(cells):
            try:
                values.extend(numbers_in(file, number, line, [cell]))
            except InputError as error:
                field = _called(names, place) if columns > 1 else None
                raise InputError(replace(error.problems[0], field=field)) from None
    return np.array(values).reshape(-1, columns)


def _called(names: Sequence[Label], place: int) -> str:
    """Return the name of a column in messages."""
    return f"column {place + 1}" + (f" ({names[place]})" if names[place].name else "")


def _uneven_row(file: str, rows: _Rows, column: str | None, error: UnevenTimeError) -> Problem:
    """Return the problem of uneven times at their row, counted without blank lines and comments.

    `column` is the name of the column of times, if there are several columns.
    """
    problem = Problem(error.message, file, field=column, hint=error.hint)
    if error.row is None:
        return problem
    below = enumerate(rows.lines.since(rows.start), start=rows.start + 1)
    number, line = next(islice(((number, line) for number, line in below if _clean(line)), error.row, None))
    return replace(problem, line=number, excerpt=line.strip()[:100])


def _not_a_number(file: str, line_number: int, line: str, token: str, *, known: bool) -> Problem:
    """Return the problem of a value that cannot be used; `known` for NaN, infinity and similar values."""
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


MAX_GRID_RATIO = 10  # samples of an even grid over recorded samples
_MIN_DT = 1e-9  # s; shortest sampling interval that is accepted
_MIN_DIGITS, _MAX_DIGITS = 5, 12  # significant digits with which programs print numbers
_MIN_FINE_SHARE = 0.01
"""Share of times that must be finer than the coarsest one; otherwise times have equal decimals, not equal digits."""


class UnevenTimeError(Exception):
    """Error: times have no constant interval.

    Parameters
    ----------
    message : str
        What is wrong with the times.
    hint : str
        Remedy.
    row : int or None
        Index of the first time that is not evenly spaced.
    """

    def __init__(self, message: str, hint: str, row: int | None) -> None:
        super().__init__(message)
        self.message, self.hint, self.row = message, hint, row


def even_interval(time: Reals) -> float:
    """Return the interval of evenly spaced times.

    Parameters
    ----------
    time : ndarray, shape (npts,)
        The times as printed [s], at least two.

    Returns
    -------
    float
        The interval [s].

    Raises
    ------
    UnevenTimeError
        At the first time that is not evenly spaced.
    """
    steps = np.diff(time)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 1
        what = "is repeated" if steps[row - 1] == 0 else f"comes after {time[row - 1]:g} s"
        hint = "the first column must be the time, increasing; printed times need enough decimals to tell rows apart"
        raise UnevenTimeError(f"time does not increase: {time[row]:g} s {what}", hint, row)

    dt = float((time[-1] - time[0]) / (len(time) - 1))
    written = float(f"{dt:.12g}")
    if abs(written - dt) <= 2 * np.spacing(dt):  # it differs by the rounding of the quotient only
        dt = written
    if dt < _MIN_DT:
        hint = "the first column must be the time, in seconds"
        raise UnevenTimeError(f"the times give a sample interval of {dt:g} s", hint, None)
    usual = median(steps)

    def odd(rounding: Reals) -> tuple[Bools, Bools]:
        # Rounding moves each time by up to half its last digit, and the difference of two times by a whole one.
        # The steps reveal a missing sample; the distances from the ends reveal steps that slowly grow.
        of_times = of_steps = np.maximum(0.01 * dt, 1.001 * rounding)
        if of_times.ndim:
            of_steps = np.maximum(of_times[1:], of_times[:-1])
            of_times = np.maximum(of_times, of_times[-1])
        return np.abs(steps - usual) > of_steps, np.abs(time - (time[0] + dt * np.arange(len(time)))) > of_times

    odd_step, out_of_step = odd(_of_decimals(time, dt))
    if (odd_step.any() or out_of_step.any()) and (rounding := _of_digits(time, dt)).any():
        odd_step, out_of_step = odd(rounding)
    if not (odd_step.any() or out_of_step.any()):
        return dt
    if odd_step.any():
        row = int(np.argmax(odd_step)) + 1
        message = f"time is uneven: a step of {steps[row - 1]:.6g} s here, of {usual:.6g} s elsewhere"
    else:
        row = int(np.argmax(out_of_step))
        message = f"time is uneven: {time[row]:.9g} s here, a constant interval would give {time[0] + dt * row:.9g} s"
    hint = (
        f"{how_to_correct('resample', f'{usual:.3g}')} puts it on an even grid; if only the printed times are rough, "
        f"keep the accelerations and give {named('dt')}"
    )
    raise UnevenTimeError(message, hint, row)


def is_even(time: Reals) -> bool:
    """Return whether a column may be one of even times."""
    try:
        even_interval(time)
    except UnevenTimeError:
        return False
    return True


def increasing(time: Reals) -> bool:
    """Return whether a column may be one of uneven times."""
    return bool((np.diff(time) > 0).all())


def on_grid(time: Reals, values: Reals) -> tuple[float, Reals, Doubt] | None:
    """Interpolate values from uneven times linearly to even times.

    Parameters
    ----------
    time, values : ndarray, shape (npts,)
        Times [s], and the values at these times.

    Returns
    -------
    (float, ndarray, Doubt) or None
        The usual interval [s], the values at this interval, and how uneven the times are; None if times do not
        increase.

    Raises
    ------
    UnevenTimeError
        If most of the grid would lie in gaps between the samples.
    """
    steps = np.diff(time)
    if not increasing(time):
        return None
    dt = float(f"{median(steps):.6g}")  # sampling intervals are round numbers
    longest = int(steps.argmax())
    count = (time[-1] - time[0]) / dt * (1 + 1e-9)
    if not count < MAX_GRID_RATIO * len(time):
        message = f"gap in the record from {time[longest]:g} to {time[longest + 1]:g} s; the step is {dt:g} s elsewhere"
        raise UnevenTimeError(message, "cut the file there: straight lines over such gaps are not data", longest + 1)
    even = time[0] + dt * np.arange(int(count) + 1)
    odd = int((np.abs(steps - dt) > 0.01 * dt).sum())
    text = (
        f"its times are uneven: {odd} of {steps.size} steps are not within 1 % of {dt:g} s, they go from "
        f"{float(steps.min()):.3g} to {float(steps[longest]):.3g} s (at {float(time[longest]):.4g} s); between the "
        f"samples straight lines were taken, at {dt:g} s"
    )
    off = float(np.abs(steps - dt).max())
    return dt, np.interp(even, time, values), Doubt("uneven", off, text)


def _of_decimals(time: Reals, dt: float) -> Reals:
    """Return the resolution of times [s] with few decimals, less than a tenth of `dt`; 0 if they have more decimals."""
    decimals = math.floor(-math.log10(dt / 10) + 1e-9) + 1
    resolution = 10.0**-decimals
    rounded = (np.abs(time - np.round(time, decimals)) < 1e-6 * resolution).all()
    return np.array(resolution if rounded else 0.0)


def _of_digits(time: Reals, dt: float) -> Reals:
    """Return the resolution of each time [s] if all have the same number of digits, as printed by %g.

    These times have fewer decimals the larger they are. Their resolution may be up to half of `dt`, as the first times,
    which are finer, determine `dt`.
    """
    size = np.floor(np.log10(np.maximum(np.abs(time), dt / 1000)) + 1e-12)
    for digits in range(_MIN_DIGITS, _MAX_DIGITS + 1):
        each = 10.0 ** (size + 1 - digits)
        if _multiples(time, each).all():
            coarsest = each.max()
            if coarsest <= dt / 2 and np.mean(~_multiples(time, coarsest)) > _MIN_FINE_SHARE:
                return np.asarray(each)
            break
    return np.zeros(time.size)


def _multiples(time: Reals, resolution: Reals | float) -> Bools:
    return np.abs(time - resolution * np.round(time / resolution)) < 1e-6 * np.asarray(resolution)
