"""A column of a table, declared once for JSON, files, frames, terminals and pages, and the layouts of rows.

A view lists its columns at the top of its file. Whoever adds a number to an answer adds a line there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import nan
from operator import attrgetter, itemgetter
from typing import Any, Generic, TypeVar

from rocking_cli.views.view import ABSENT, ASIDE, Table, number

R = TypeVar("R")
P = TypeVar("P")
of = attrgetter
LONG_NAMES = {
    "a": "amplitude of the pulse over the uplift acceleration",
    "a_g": "ground acceleration",
    "ag": "amplitude of the pulse",
    "acceleration": "constant acceleration over the uplift acceleration",
    "amplitude": "amplitude over the critical rotation",
    "kappa": "linearisation coefficient of the equivalent block",
    "known_to": "time until which the outcome is known",
    "lambda": "uplift acceleration",
    "least": "smallest amplitude known to overturn",
    "omega": "frequency of the pulse over the frequency parameter",
    "opening": "largest opening of a joint over D_cr",
    "overturned": "whether, or by which share, it overturns",
    "peak_lower_bound": "lower bound of the peak ratio",
    "peak_rate": "peak angular velocity",
    "peak_ratio": "peak rotation over the critical rotation",
    "pga_g": "peak ground acceleration",
    "pgv": "peak ground velocity",
    "phi": "rotation",
    "phi_dot": "rate of rotation",
    "phi_ratio": "rotation over the critical rotation",
    "possible": "smallest amplitude that overturns or has an unknown outcome",
    "restitution": "coefficient of restitution as given",
    "scale": "scale factor",
    "size": "size, 2 pi/p",
    "t": "time",
    "target_pga": "peak ground acceleration after scaling",
    "unknown": "whether, or by which share, the outcome is unknown",
    "v_g": "vertical ground acceleration",
}
"""Meanings of names that are not words themselves."""


def plainly(value: Any) -> str:
    """Format a value as it is, but a number with four digits."""
    return number(value, 4) if isinstance(value, float) else str(value)


def rounded(digits: int, factor: float = 1.0) -> Callable[[float], str]:
    """Return a format of numbers, times a factor, with some digits; a dash for those that do not exist."""
    return lambda value: number(factor * value, digits)


@dataclass(frozen=True)
class Column(Generic[R]):
    """A quantity of a row, and how it is named and shown.

    Parameters
    ----------
    key : str or None
        Key in JSON; None for a column that JSON lacks.
    of : callable
        Returns the value of a row; `of("block.p")` reads attributes.
    unit : str
        Unit of the value.
    head : str, optional
        Heading on terminals and pages, with its line breaks; None for a column that these lack.
    form : callable
        Formats a value that exists for terminals and pages.
    name : str, optional
        Heading in files and frames, without the unit; the key by default, None for a column that these lack.
    words : str
        What the quantity is, for readers.
    text : bool
        Whether values are words: aligned to the left, and empty in files if they do not exist.
    rank : int
        Order in which columns leave a narrow terminal, the largest first; 0 for one that stays, `ASIDE` for one that
        terminals show in full only.
    """

    key: str | None
    of: Callable[[R], Any]
    unit: str = ""
    head: str | None = None
    form: Callable[[Any], str] = plainly
    name: str | None = ""
    words: str = ""
    text: bool = False
    rank: int = 0

    @property
    def heading(self) -> str:
        """The heading in files and frames, with the unit."""
        name = self.name or self.key or ""
        return f"{name} [{self.unit}]" if self.unit else name

    def cell(self, row: R) -> str:
        """Return the value of a row as it is shown; a dash if it does not exist."""
        value = self.of(row)
        return ABSENT if value is None else self.form(value)

    def filed(self, row: R) -> Any:
        """Return the value of a row for files: a value that does not exist is NaN, or an empty text."""
        value = self.of(row)
        return value if value is not None else "" if self.text else nan


def only_shown(
    head: str | None, of: Callable[[R], Any], form: Callable[[Any], str] = plainly, unit: str = "", **how: Any
) -> Column[R]:
    """Return a column that only terminals and pages have; `how` has `text`, `words` and `rank`."""
    return Column(None, of, unit, head, form, None, **how)


def of_part(columns: Iterable[Column[P]], part: Callable[[R], P | None]) -> list[Column[R]]:
    """Return the columns of a part of rows as columns of the rows, as they are shown; a row may have no such part."""

    def value_in(column: Column[P]) -> Callable[[R], Any]:
        return lambda row: None if (there := part(row)) is None else column.of(there)

    return [
        only_shown(each.head, value_in(each), each.form, each.unit, text=each.text, rank=each.rank, words=each.words)
        for each in columns
    ]


def text_columns(*heads: str) -> list[Column[Sequence[str]]]:
    """Return the columns of rows whose cells are texts already."""
    return [only_shown(head, itemgetter(k), text=True) for k, head in enumerate(heads)]


UNIT: Mapping[str, Callable[[Column[Any]], str]] = {"unit": of("unit")}


def data_of(columns: Iterable[Column[R]], row: R) -> dict[str, Any]:
    """Return a row as plain data.

    Examples
    --------
    >>> name, p = Column("name", str, head="", text=True), Column("p", len, "rad/s", "p")
    >>> first = only_shown("starts with", lambda name: name[0])
    >>> data_of([name, p, first], "wall")
    {'name': 'wall', 'p': 4}
    >>> frame_of([name, p, first], ["wall", "arch"])
    {'name': ['wall', 'arch'], 'p [rad/s]': [4, 4]}
    >>> table_of("Structures", [name, p, first], ["wall"]).rows
    [['wall', '4', 'w']]
    >>> table_across("Structures", [p, first], ["one", "two"], ["wall", "arch"]).rows
    [['p', '4', '4', 'rad/s'], ['starts with', 'w', 'a', '']]
    """
    return {column.key: column.of(row) for column in columns if column.key is not None}


def frame_of(columns: Iterable[Column[R]], rows: Sequence[R]) -> dict[str, list[Any]]:
    """Return rows as columns by their headings, as files and frames have them."""
    return {column.heading: [column.filed(row) for row in rows] for column in columns if column.name is not None}


def table_of(title: str, columns: Iterable[Column[R]], rows: Iterable[R]) -> Table:
    """Return a table with a line for each row."""
    seen = [column for column in columns if column.head is not None]
    heads = [column.head or "" for column in seen]
    numbers = [k for k, column in enumerate(seen) if not column.text]
    cells = [[column.cell(row) for column in seen] for row in rows]
    return Table(title, heads, cells, numbers, [column.rank for column in seen])


def table_across(
    title: str,
    columns: Iterable[Column[R]],
    heads: Sequence[str],
    rows: Sequence[R],
    after: Mapping[str, Callable[[Column[R]], str]] = UNIT,
    aside: Sequence[bool] = (),
) -> Table:
    """Return a table with a line for each column, and the rows side by side under their own headings.

    `after` has what follows in each line, by its heading. Terminals show the rows that are `aside`, and lines in which
    no other row has a value, in full only.
    """
    seen = [column for column in columns if column.head is not None]
    lines = [
        [column.head or "", *(column.cell(row) for row in rows), *(text_of(column) for text_of in after.values())]
        for column in seen
    ]
    ranks = [0, *(ASIDE * each for each in aside or [False] * len(rows)), *(0 for _ in after)]
    kept = [k for k in range(1, len(rows) + 1) if ranks[k] < ASIDE]
    values = [{line[k] for k in kept} for line in lines]
    asides = [k for k, column in enumerate(seen) if column.rank == ASIDE or values[k] == {ABSENT}]
    return Table(title, ["", *heads, *after], lines, range(1, len(rows) + 1), ranks, asides)


def long_name(name: str) -> str:
    """Return what a column stands for; its name in words if that is enough.

    Examples
    --------
    >>> long_name("peak_ratio"), long_name("uplift_time")
    ('peak rotation over the critical rotation', 'uplift time')
    """
    return LONG_NAMES.get(name, name.replace("_", " "))
