"""What a result looks like to people and to programs, before anybody shows it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from math import degrees, isnan
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism

ABSENT = "-"
FEW = 3  # motions, or records, of which each gets its own lines; of more there is a table


@dataclass(frozen=True)
class Table:
    """Rows under headings.

    Parameters
    ----------
    title : str
        Above it; empty for none.
    columns : sequence of str
        Headings; a line break in one, or in a cell, is kept.
    rows : sequence of sequence of str
        Cells.
    numbers : collection of int
        Places of columns that are aligned to the right; these and the first never wrap.
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: Collection[int] = ()


@dataclass(frozen=True)
class View:
    """One result.

    Parameters
    ----------
    data : mapping, or a function that makes it
        As plain data, for JSON; it is made only where it is shown.
    parts : sequence of Table or str
        As people read it, from top to bottom: tables and sentences.
    """

    data: Mapping[str, Any] | Callable[[], Mapping[str, Any]]
    parts: Sequence[Table | str]


def heading(mechanism: Mechanism) -> str:
    """A structure's name and kind, for a heading."""
    return f"{mechanism.name}: {mechanism.title}"


def number(value: float | None, digits: int = 6) -> str:
    """A number as people read it; a dash if it does not exist."""
    return ABSENT if value is None or isnan(value) else f"{value + 0.0:.{digits}g}"  # a sum that is never -0


def in_degrees(phi: float) -> str:
    """A rotation [rad] as people read it [deg]; a dash if it does not exist."""
    return number(degrees(phi), 5)
