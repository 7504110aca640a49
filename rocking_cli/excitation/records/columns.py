"""Columns of a table: their names, which of them are times or accelerations, and which one is requested.

Without labels, the steps between numbers tell components side by side from one series that runs on over the rows.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.records.record_units import (
    BRACKETED,
    WORDS,
    Wanted,
    component,
    header_units,
    is_acceleration,
    is_unit,
    other_quantity,
    quantity_of,
    without_sign,
)
from rocking_cli.text import regex

MAX_COLUMNS = 1000
MAX_LISTED_COLUMNS = 30
LABEL_LINES = 40  # number of lines above a table that may hold its labels
MAX_LABEL_CHARACTERS = 10_000

_TIME = regex(rf"[\"']?(?:{WORDS['time']})(?![a-z])", re.IGNORECASE)
_BARE_T = regex(r"t", re.IGNORECASE)  # a label that may stand for the time or the transverse component
_WORDS = regex(r"[^\s\[(]+(?: *(?:\[[^\]]*\]|\([^)]*\)))?")  # a word, with the brackets that follow it
_GAPS = regex(r"\s{2,}|\t")
_COLUMN = regex(r"col(?:umn)?\.? *(\d{1,4})")
_NO_NAME = regex(r"=|:$|^[+-]?\.?\d(?!\d{0,2} ?deg)")
_NO_AZIMUTH = regex(r"=|:$|^[+-]?\d*\.\d|^\d{4}")  # beside a time, numbers may be names
_BREAKS = regex(r"[;,\s]+")
_UNIT_BEHIND = regex(r"\s*(?:\[[^\]]*\]|\([^)]*\))\s*$")


@dataclass(frozen=True)
class Label:
    """Name and unit of a column, from the header.

    Parameters
    ----------
    name : str
        Name of the column, which may include a unit; empty if it has none.
    unit : str, optional
        Unit, if the header has a line of units.
    """

    name: str
    unit: str = ""

    def __str__(self) -> str:
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def is_time(self) -> bool:
        """Whether the name is that of a time."""
        return _TIME.match(self.name) is not None


@dataclass(frozen=True)
class Choice:
    """The chosen column of accelerations.

    Parameters
    ----------
    column : int
        Index of the column in the table.
    time : int or None
        Index of the column of times; None if there is none.
    channel : str
        Name of the column, or its number among the accelerations; empty if it is the only one.
    """

    column: int
    time: int | None
    channel: str


def labels(
    file: str, lines: Sequence[tuple[int, str]], delimiter: str | None, columns: int
) -> tuple[list[Label], list[int]]:
    """Return the names of the columns of a table, from the header above it.

    Labels are the nearest line above the table with as many words as there are columns, of which one is a time, a unit
    or a known component.

    Parameters
    ----------
    file : str
        The file, for messages.
    lines : sequence of (int, str)
        Line number and text of every line of the header.
    delimiter : str or None
        Delimiter of the columns; None for blanks.
    columns : int
        Number of columns.

    Returns
    -------
    list of Label
        A label for each column; empty labels if there are no labels.
    list of int
        Numbers of the lines from which the labels are.

    Raises
    ------
    InputError
        If two lines name the same components in another order.
    """
    nearest_lines = sorted(lines)[-LABEL_LINES:]
    rows = [(number, cells) for number, line in reversed(nearest_lines) if (cells := _cells(line, delimiter, columns))]
    fitting = [(number, cells) for number, cells in rows if any(map(_is_label, cells))]
    if not fitting:
        return [Label("")] * columns, []
    number, names = fitting[0]
    of = [[component(cell) for cell in cells] for _, cells in fitting]
    for (other, _), components in zip(fitting[1:], of[1:], strict=True):
        if components != of[0] and set(components) == set(of[0]):
            message = f"lines {other} and {number} name the columns in different orders"
            raise InputError(Problem(message, file, number, hint="take out the one that is wrong"))
    above = [row for row in rows if row[0] < number]
    if above and all(not cell or cell == "-" or is_unit(cell.strip("[]() ")) for cell in names):
        (above_number, above_names), units = above[0], [cell.strip("[]()- ") for cell in names]
        labelled = zip(above_names, units, strict=True)
        return [Label(without_sign(name), unit) for name, unit in labelled], [above_number, number]
    return [Label(without_sign(name)) for name in names], [number]


def _is_label(cell: str) -> bool:
    """Return whether a cell above a column is a time, a unit, a quantity or a known component."""
    named = Label(cell).is_time or component(cell) is not None or is_unit(cell.strip("[]() "))
    return named or bool(header_units(cell)) or other_quantity(cell) is not None or is_acceleration(cell)


class _Candidates(NamedTuple):
    """A table, and which of its columns are times or may be the requested values."""

    file: str
    table: Reals
    names: Sequence[Label]
    times: Sequence[int]
    values: Sequence[int]
    wanted: Wanted

    def place(self, requested: str | None) -> int:
        """Return the index in `values` of the requested column."""
        _, table, names, times, values, wanted = self
        listed = self.listed()
        if requested is None:
            message = f"the table has {len(values)} columns that may be {wanted.values}"
            hint = f"choose one with {named('channel')}, by place or name:{listed}"
            if not any(label.name for label in names) and not times and runs_on(table) is None:
                hint += "\n  if the values run on from line to line, and the columns are no components, give "
                hint += named("run_on")
            raise InputError(Problem(f"{message}, and only one can shake a structure", self.file, hint=hint))
        word = _plain(requested)
        if (number := _COLUMN.fullmatch(word)) and int(number[1]) - 1 in values:
            return values.index(int(number[1]) - 1)
        if word.isascii() and word.isdigit() and len(word) < 9 and 1 <= int(word) <= len(values):
            return int(word) - 1
        bare = [_plain(_UNIT_BEHIND.sub("", names[k].name)) for k in values]
        for spellings in ([_plain(str(names[k])) for k in values], bare):
            places = [place for place, name in enumerate(spellings) if name and name == word]
            if len(places) == 1:
                return places[0]
            if places:
                message, hint = f"{len(places)} columns are called '{requested}'", f"give the place of one:{listed}"
                raise InputError(Problem(message, self.file, field=named("channel"), hint=hint))
        message = f"there is no channel '{requested}'"
        hint = f"the file has:{listed}"
        raise InputError(Problem(message, self.file, field=named("channel"), hint=hint))

    def listed(self) -> str:
        """Return text that lists the columns that may be meant, with number, name, unit and peak, and the others."""
        _, table, names, times, values, wanted = self
        out = []
        for place, k in enumerate(values, start=1):
            units = _units(str(names[k]), wanted)
            unit = f"in {units.pop()}" if len(units) == 1 else "unit not stated"
            name = f"{names[k]}, " if names[k].name else ""
            out.append(f"\n    {place}: {name}column {k + 1}, {unit}, peak {float(np.abs(table[k]).max()):.4g}")
        for k, label in enumerate(names):
            if k not in values:
                what = "time" if k in times else f"no {wanted.quantity}"
                out.append(f"\n    column {k + 1}{f', {label},' if label.name else ''} is {what}")
        if len(out) > MAX_LISTED_COLUMNS:
            out[MAX_LISTED_COLUMNS:] = [f"\n    and {len(out) - MAX_LISTED_COLUMNS} more"]
        return "".join(out)


def choose(
    file: str,
    table: Reals,
    names: Sequence[Label],
    requested: str | None,
    increases: Callable[[Reals], bool],
    wanted: Wanted,
) -> Choice:
    """Return the requested column, or the only one with values of the requested quantity.

    Parameters
    ----------
    file : str
        The file, for the messages.
    table : ndarray, shape (columns, rows)
        The numbers.
    names : sequence of Label
        Label of each column.
    requested : str, optional
        Number among the columns with such values, from 1, or name; or `column 6`, counting all columns.
    increases : callable
        Function that returns whether a column increases evenly, as times do.
    wanted : Wanted
        Requested quantity, as a rule accelerations.

    Raises
    ------
    InputError
        If there are several such columns and none is requested, or the requested one does not exist; the message lists
        them.
    """
    times = _times(table, names, increases)
    values = [k for k in range(len(table)) if k not in times and _may_be(str(names[k]), wanted)]
    candidates = _Candidates(file, table, names, times, values, wanted)
    if not values:
        message = f"none of the columns holds {wanted.values}"
        raise InputError(Problem(message, file, hint=f"there are:{candidates.listed()}"))
    place = 0 if requested is None and len(values) == 1 else candidates.place(requested)
    column = values[place]
    time = max((k for k in times if k < column), default=min(times, default=None))
    channel = "" if len(values) == 1 else names[column].name or str(place + 1)
    return Choice(column, time, channel)


def _may_be(label: str, wanted: Wanted) -> bool:
    """Return whether the values under a label may be of the requested quantity."""
    if wanted.raw:
        return True
    if wanted.quantity == "acceleration":
        return not other_quantity(label)
    stated = {quantity_of(unit) for unit in BRACKETED.findall(label)} - {None}
    return wanted.quantity in stated if stated else not header_units(label)


def _cells(line: str, delimiter: str | None, columns: int) -> list[str]:
    """Split a line of labels into as many cells as there are columns; empty if no way of splitting gives so many."""
    if len(line) > MAX_LABEL_CHARACTERS:
        return []
    for cells in _ways(line, delimiter):
        stripped = [cell.strip().strip("\"'").strip() for cell in cells]
        no_name = _NO_AZIMUTH if stripped and Label(stripped[0]).is_time else _NO_NAME
        if len(stripped) == columns and not any(map(no_name.search, stripped)):
            # A phrase such as "acceleration in g" is not the labels of three columns.
            of_cells = any(map(header_units, stripped)) or all(is_unit(cell.strip("[]() ")) for cell in stripped)
            return stripped if of_cells or not header_units(line) else []
    return []


def _ways(line: str, delimiter: str | None) -> Iterator[list[str]]:
    """Yield a line of labels split in several ways: as the numbers are, then by usual delimiters."""
    line = line.strip().rstrip(",; \t")
    if delimiter is not None:
        try:
            yield next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
        except csv.Error:  # the cell is longer than csv allows, so not a label
            return
    yield _GAPS.split(line)
    yield _WORDS.findall(line)
    yield line.split()
    for mark in (";", "\t", ","):
        yield line.split(mark)
    yield _BREAKS.split(line.partition(":")[2].strip())  # for example: sequence: time U(+); N(+)


def _times(table: Reals, names: Sequence[Label], increases: Callable[[Reals], bool]) -> list[int]:
    """Return the columns whose name is a time, or else the first if it increases evenly, and repetitions of it."""
    called = [k for k, label in enumerate(names) if label.is_time]
    times = [k for k in called if (np.diff(table[k]) > 0).all()]
    if not times and increases(table[0]):
        times = [0, *(k for k in range(1, len(table) - 1) if np.array_equal(table[k], table[0]))]
    return times or [k for k in called if not _BARE_T.fullmatch(str(names[k]))]


def _plain(name: str) -> str:
    return " ".join(name.lower().split())


def _units(label: str, wanted: Wanted) -> set[str]:
    """Return the units that a label states for the requested quantity."""
    if wanted.raw or wanted.quantity == "acceleration":
        return header_units(label)
    return {unit for unit in BRACKETED.findall(label) if quantity_of(unit) == wanted.quantity}


FEWEST_ROWS = 10  # with which the steps of a table tell its shape
_MOST_RATIO = 2.0  # factor between mean steps that are still alike
_LEAST_RATIO = 1.4  # factor between mean steps that tell two shapes apart


def runs_on(table: Reals) -> bool | None:
    """Return whether values run on over the rows, by the steps between neighbours; None if nothing tells.

    In a series that runs on, a step from one row to the next is like a step within a row, and less than one down a
    column, which is several samples long. In a table of components, a step down a column is the smaller one.

    Parameters
    ----------
    table : ndarray, shape (columns, rows)
        The numbers.
    """
    if table.shape[1] < FEWEST_ROWS:
        return None
    within, across, down = (
        float(np.abs(steps).mean()) for steps in (np.diff(table, axis=0), table[0, 1:] - table[-1, :-1], np.diff(table))
    )
    if across / _MOST_RATIO <= within <= across * _MOST_RATIO and across * _LEAST_RATIO < down:
        return True
    return False if across > down * _LEAST_RATIO or within < across / _MOST_RATIO else None


def counts_rows(column: Reals) -> bool:
    """Return whether a column has the numbers of the rows."""
    return len(column) > 2 and bool((np.diff(column) == 1).all() and column[0] in (0, 1))
