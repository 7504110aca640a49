"""A table of shake-table tests: which structure stood under which motion, and what was observed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import inf
from pathlib import Path
from typing import Any

from rocking_cli.ask.inputs import sheet_of
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.spreadsheet import DECIMAL_COMMA, Row, Spreadsheet, unit_in
from rocking_cli.short_repr import short_repr
from rocking_cli.text import cut, did_you_mean, one_line
from rocking_cli.units import UnitError, read, units_of

FORECAST_PREFIX = "pred_"
"""Prefix of the headings of columns with shares predicted by other rules."""
OWN_PREDICTORS = ("tool", "tool_with_unknown", "base_rate", "west", "velocity", "fitted_pgv")
"""Names of the rules that scoring computes itself."""
COMMENT_SIGN = "#"
"""First character of the headings of columns that are not read."""
HEADINGS = (
    "structure", "record", "overturned", "peak", "censored", "scale", "polarity", "cluster", "half", "motion",
    "time_scale", "pgv",
)  # fmt: skip
MOTIONS = ("recorded", "commanded")
POLARITIES = ("1", "-1", "both")
FLAGS = {"0": False, "0.0": False, "false": False, "1": True, "1.0": True, "true": True}
"""Texts that mean no and yes, as users and as frames of pandas write them."""
UNITS = {"peak": "rad", "pgv": "m/s"}
"""Units of the columns of quantities."""


@short_repr
@dataclass(frozen=True)
class ObservedTest:
    """One test: a structure under one motion, and what was observed.

    Parameters
    ----------
    line : int
        Line of the test in its file.
    structure, record : str
        The file of the structure, and the file of the motion or a pulse as text.
    overturned : bool or None
        Whether the structure overturned; None if that was not observed: the test is in no score.
    peak : float or None
        Largest rotation, of either direction [rad].
    censored : bool
        Whether the peak was at least this large, such as that of a structure caught by a rope.
    scale, time_scale : float
        Factors on the accelerations and on the times of the record.
    polarity : str
        "1" as recorded, "-1" reversed; "both" if it is not known.
    cluster : str
        Name shared by the tests that do not count as independent.
    half : str
        Name of the part of the table from which the base rate of this test is not taken; empty for none.
    commanded : bool
        Whether the record is what the table was told to do, and not what it did.
    pgv : float or None
        Peak velocity of the table in this test [m/s].
    forecasts : mapping of str to float
        Shares of overturning that other rules foretold, by their names.
    """

    line: int
    structure: str
    record: str
    overturned: bool | None = None
    peak: float | None = None
    censored: bool = False
    scale: float = 1.0
    time_scale: float = 1.0
    polarity: str = "both"
    cluster: str = ""
    half: str = ""
    commanded: bool = False
    pgv: float | None = None
    forecasts: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class TableOfTests:
    """The tests of a table.

    Parameters
    ----------
    file : str
        Name of the file in messages.
    folder : Path
        Folder to which the paths in it are relative.
    tests : sequence of ObservedTest
        Tests in the order of the rows.
    """

    file: str
    folder: Path
    tests: Sequence[ObservedTest]


def read_tests(path: Path) -> TableOfTests:
    """Read a table of tests from a CSV file.

    Raises
    ------
    InputError
        With every problem of the file, by line and column.
    """
    return parse_tests(sheet_of(path), path.parent)


def parse_columns(columns: Mapping[str, Sequence[Any]], name: str = "table") -> TableOfTests:
    """Read a table of tests from columns by their headings, such as a frame of pandas; paths as they are.

    Raises
    ------
    InputError
        As `read_tests`, with the number of the row instead of the line.
    """
    headings = tuple(str(each).strip() for each in columns)
    cells = [
        ["" if value is None or value != value else str(value).strip() for value in columns[key]] for key in columns
    ]
    if len({len(each) for each in cells}) > 1:
        raise InputError("the columns of a table must have the same length")
    rows = tuple(Row(k + 1, tuple(row)) for k, row in enumerate(zip(*cells, strict=True)))
    return parse_tests(Spreadsheet(name, 0, headings, rows, decimal_comma=False), Path())


def parse_tests(sheet: Spreadsheet, folder: Path) -> TableOfTests:
    """Return the tests of a table of text, whose paths are relative to `folder`. Raises as `read_tests`."""
    problems: list[Problem] = []
    places = _check_headings(sheet, problems)
    if not sheet.rows:
        problems.append(Problem("the table has no rows below its headings", sheet.file))
    tests = [_test(_Cells(sheet, row, places, problems)) for row in sheet.rows]
    if problems:
        raise InputError(*problems)
    return TableOfTests(sheet.file, folder, tests)


def _check_headings(sheet: Spreadsheet, problems: list[Problem]) -> dict[str, tuple[int, str]]:
    """Return the place and the unit of each column by its heading without the unit; add what is wrong to `problems`."""
    places: dict[str, tuple[int, str]] = {}
    wrong: set[str] = set()  # columns that exist, but cannot be read
    at = partial(Problem, file=sheet.file, line=sheet.line)
    for k, heading in enumerate(sheet.headings):
        if not heading or heading.startswith(COMMENT_SIGN):
            continue
        name, unit = unit_in(heading, [each for kind in UNITS.values() for each in units_of(kind)])
        shown = cut(one_line(heading))
        if name.startswith(FORECAST_PREFIX):
            if name == FORECAST_PREFIX or name.removeprefix(FORECAST_PREFIX) in OWN_PREDICTORS:
                problem = f"pred_ must be followed by a name other than {', '.join(OWN_PREDICTORS)}"
                problems.append(at(problem, field=shown))
        elif name not in HEADINGS:
            guess = did_you_mean(name, list(HEADINGS))
            hint = f"{guess}; other predictions are headed pred_NAME, and columns for people {COMMENT_SIGN}"
            problems.append(at("is not a column of a table of tests", field=shown, hint=hint))
        kind = UNITS.get(name)
        if unit and (kind is None or unit not in units_of(kind)):
            must = f"must be one of {', '.join(units_of(kind))}" if kind else "has no unit"
            problems.append(at(must, field=shown))
            wrong.add(name)
        if name in places:
            problems.append(at("is the heading of two columns", field=cut(one_line(name))))
        places[name] = k, unit
    for needed in ("structure", "record"):
        if needed not in places:
            problems.append(at("the column is missing", field=needed))
    if not {"overturned", "peak"} & set(places):
        problems.append(at("the column is missing: give what was observed", field="overturned", hint="or `peak`"))
    return {name: place for name, place in places.items() if name not in wrong}


class _Cells:
    """The cells of a row by their headings; what is wrong with them is added to `problems`."""

    def __init__(
        self, sheet: Spreadsheet, row: Row, places: Mapping[str, tuple[int, str]], problems: list[Problem]
    ) -> None:
        self.sheet, self.row, self.places, self.problems = sheet, row, places, problems
        if row.too_many is not None:
            what = f"has more cells than headings; the first extra cell is {cut(one_line(row.too_many))!r}"
            self.wrong("", what, "is a separator in a cell without quotes?")

    def wrong(self, name: str, what: str, hint: str | None = None) -> None:
        """Note a problem of a cell, or of the row if `name` is empty."""
        self.problems.append(Problem(what, self.sheet.file, self.row.line, field=name or None, hint=hint))

    def text(self, name: str) -> str:
        """Return a cell; empty if there is no such column."""
        return self.row.cells[self.places[name][0]] if name in self.places else ""

    def one_of(self, name: str, known: Sequence[str], usual: str) -> str:
        """Return a cell that must be one of some words; `usual` if it is empty."""
        cell = self.text(name)
        if cell and cell not in known:
            self.wrong(name, f"must be {', '.join(known[:-1])} or {known[-1]}, got {cut(one_line(cell))!r}")
        return cell or usual

    def flag(self, name: str) -> bool | None:
        """Return a cell of 0 or 1; None if it is empty."""
        cell = self.text(name)
        if cell and cell.lower() not in FLAGS:
            self.wrong(name, f"must be 0 or 1, got {cut(one_line(cell))!r}")
        return FLAGS.get(cell.lower())

    def number(self, name: str, unit: str = "", *, zero: bool = False, most: float = inf) -> float | None:
        """Return a positive number, or 0 if `zero` is allowed, in its unit; None if the cell is empty."""
        cell = self.text(name)
        if not cell:
            return None
        try:
            value = self._value(cell, self.places[name][1], unit)
        except (UnitError, ValueError) as error:
            what = str(error) if isinstance(error, UnitError) else f"{cut(one_line(cell))!r} is not a number"
            self.wrong(name, what, f"give a unit, such as {name} [{unit}] in the heading" if unit else None)
            return None
        if not ((value > 0 or (zero and value == 0)) and value <= most and value < inf):
            must = f"from 0 to {most:g}" if most < inf else "0 or more" if zero else "positive"
            self.wrong(name, f"must be {must}, got {value:g}")
        return value

    def _value(self, given: str, own: str, unit: str) -> float:
        if self.sheet.decimal_comma and DECIMAL_COMMA.fullmatch(given):
            given = given.replace(",", ".", 1)
        try:
            plain = float(given)
        except ValueError:
            return read(given, unit)
        if not unit:
            return plain
        # A number without a unit is in the unit of its heading; a rotation without any is refused.
        return read(f"{given} {own}", unit) if own or unit == "rad" else plain


def _test(cells: _Cells) -> ObservedTest:
    for name in ("structure", "record"):
        if name in cells.places and not cells.text(name):
            cells.wrong(name, "is empty")
    overturned, peak = cells.flag("overturned"), cells.number("peak", "rad", zero=True)
    forecasts = {
        name.removeprefix(FORECAST_PREFIX): cells.number(name, zero=True, most=1.0)
        for name in cells.places
        if name.startswith(FORECAST_PREFIX)
    }
    scale, time_scale = cells.number("scale"), cells.number("time_scale")
    return ObservedTest(
        cells.row.line,
        cells.text("structure"),
        cells.text("record"),
        overturned,
        peak,
        bool(cells.flag("censored")),
        1.0 if scale is None else scale,
        1.0 if time_scale is None else time_scale,
        cells.one_of("polarity", POLARITIES, "both"),
        cells.text("cluster") or cells.text("record"),
        cells.text("half"),
        cells.one_of("motion", MOTIONS, "recorded") == "commanded",
        cells.number("pgv", "m/s"),
        {name: value for name, value in forecasts.items() if value is not None},
    )
