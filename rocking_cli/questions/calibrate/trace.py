"""The trace of a free-rocking test: angle over time, from a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.ask.inputs import sheet_of
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.spreadsheet import DECIMAL_COMMA, Spreadsheet, unit_in
from rocking_cli.short_repr import short_repr
from rocking_cli.text import cut, one_line
from rocking_cli.units import UnitError, read, units_of

TIME_NAMES, ANGLE_NAMES = ("time", "t"), ("angle", "rotation", "theta", "phi", "tilt")
MAX_SHOWN_CELLS = 20  # unreadable cells that an error message names


@short_repr
@dataclass(frozen=True, eq=False)
class Trace:
    """Angle of a structure over time, as measured; cells without an angle are left out.

    Parameters
    ----------
    name : str
        Name of the file.
    times : ndarray, shape (n,)
        Times, which increase [s].
    angles : ndarray, shape (n,)
        Angles, of either sense [rad].
    """

    name: str
    times: Reals
    angles: Reals


def read_trace(path: Path) -> Trace:
    """Read a trace from a CSV file with the headings `time [s]` and `angle [deg]`, or other units.

    Raises
    ------
    InputError
        With every problem of the file, by line and column.
    """
    return parse_trace(sheet_of(path))


def parse_trace(sheet: Spreadsheet) -> Trace:
    """Return the trace in a table of text. Raises as `read_trace`."""
    (time, seconds), (angle, unit) = (
        _column(sheet, names, kind) for names, kind in ((TIME_NAMES, "s"), (ANGLE_NAMES, "rad"))
    )
    problems: list[Problem] = []
    times: list[float] = []
    angles: list[float] = []
    for row in sheet.rows:
        if row.cells[angle].lower() in ("", "nan"):
            continue  # a gap in the trace
        values = []
        for place, unit_of_column, kind in ((time, seconds, "s"), (angle, unit, "rad")):
            cell = row.cells[place]
            if sheet.decimal_comma and DECIMAL_COMMA.fullmatch(cell):
                cell = cell.replace(",", ".", 1)
            try:
                values.append(read(f"{cell} {unit_of_column}", kind))
            except UnitError:
                what = f"{cut(one_line(cell))!r} is not a number"
                problems.append(Problem(what, sheet.file, row.line, field=one_line(sheet.headings[place])))
        if len(values) == 2:
            if times and values[0] <= times[-1]:
                what = f"must be later than the row before, {times[-1]:g} s, got {values[0]:g} s"
                problems.append(Problem(what, sheet.file, row.line, field=one_line(sheet.headings[time])))
            times.append(values[0])
            angles.append(values[1])
    if problems:
        raise InputError(*problems[:MAX_SHOWN_CELLS])
    return Trace(sheet.file, np.array(times), np.array(angles))


def _column(sheet: Spreadsheet, names: Sequence[str], kind: str) -> tuple[int, str]:
    """Return the place and the unit of a column, by its name or else by its unit. Raises `InputError`."""
    columns = []
    for k, heading in enumerate(sheet.headings):
        name, unit = unit_in(heading, units_of(kind))
        if name.strip().lower() in names or unit in units_of(kind):
            columns.append((k, unit))
    if len(columns) != 1:
        what = f"one column must be the {names[0]}, {len(columns) or 'none'} of {len(sheet.headings)} is"
        hint = f"head the columns time [s] and angle [deg]; units of the {names[0]}: {', '.join(units_of(kind))}"
        raise InputError(Problem(what, sheet.file, sheet.line, hint=hint))
    place, unit = columns[0]
    if not unit and kind == "s":
        unit = "s"
    if unit not in units_of(kind):
        what = f"its unit must be one of {', '.join(units_of(kind))}" + (f", got {cut(one_line(unit))}" if unit else "")
        hint = "head the column time [s]" if kind == "s" else "head the column angle [deg] or angle [rad]"
        raise InputError(Problem(what, sheet.file, sheet.line, field=cut(one_line(sheet.headings[place])), hint=hint))
    return place, unit
