"""The parts of a view: tables, sentences and plain data of one result, before output."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from math import degrees, isnan
from typing import TYPE_CHECKING, Any

from rocking_cli.short_repr import short_repr

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.excitation.base import GroundMotion

ABSENT = "-"
ASIDE = 9  # rank of a column, or of the line of a quantity, that terminals show in full only
MAX_DETAILED_MOTIONS = 3  # motions or records with lines of their own; more are listed in a table


class Aside(str):
    """Sentence that terminals print in full only: an explanation of terms, or a note on the method."""

    __slots__ = ()


@dataclass(frozen=True)
class Table:
    """A table of rows under headings.

    Parameters
    ----------
    title : str
        Title above the table; empty for none.
    columns : sequence of str
        Headings; a line break in one, or in a cell, is kept.
    rows : sequence of sequence of str
        Cells of each row.
    numbers : collection of int
        Indices of columns that are aligned to the right.
    ranks : sequence of int
        Rank of each column: if a terminal is too narrow, those with the largest leave first, and those with 0 never;
        `ASIDE` for those shown in full only. By default all are 0.
    asides : collection of int
        Indices of rows that terminals show in full only.
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: Collection[int] = ()
    ranks: Sequence[int] = ()
    asides: Collection[int] = ()


@short_repr
@dataclass(frozen=True)
class View:
    """One result as plain data, and as tables and sentences.

    Parameters
    ----------
    data : mapping, or a function that makes it
        The result as plain data, for JSON; a function is called only if the data are shown.
    parts : sequence of Table or str
        Tables and sentences, from top to bottom.
    """

    data: Mapping[str, Any] | Callable[[], Mapping[str, Any]]
    parts: Sequence[Table | str]

    def plain(self) -> Mapping[str, Any]:
        """Return the data."""
        return self.data() if callable(self.data) else self.data

    def plus(self, more: Callable[[], Mapping[str, Any]], parts: Sequence[Table | str] = ()) -> View:
        """Return the view with more data, which are computed if the data are shown, and more parts."""
        return View(lambda: {**self.plain(), **more()}, [*self.parts, *parts])


def heading(mechanism: Mechanism) -> str:
    """Return name and type of a structure, for a heading, and that it is not about its weaker side."""
    side = "" if mechanism.weaker_side() is None else ", about its width though its depth is the weaker side"
    return f"{mechanism.name}: {mechanism.title}{side}"


def force_unit(mechanism: Mechanism) -> tuple[float, str]:
    """Return the unit in which forces are shown, and its size [N]: per unit mass for a structure without masses."""
    return (1e3, "kN") if mechanism.has_mass else (1.0, "N/kg")


def number(value: float | None, digits: int = 6) -> str:
    """Format a number; a dash if it does not exist."""
    return ABSENT if value is None or isnan(value) else f"{value + 0.0:.{digits}g}"  # adding zero turns -0 into 0


def in_degrees(phi: float) -> str:
    """Format a rotation given in rad in degrees; a dash if it does not exist."""
    return number(degrees(phi), 5)


def processing_in_words(motion: GroundMotion) -> str:
    """Return the processing steps of a motion, and the file that was prepared by them, in a few words, if any."""
    from rocking_cli.excitation.records.record_units import QUANTITIES
    from rocking_cli.processing import reading

    steps = list(motion.processing)
    for quantity in QUANTITIES:
        if (step := f"from {quantity}") in steps:
            steps[steps.index(step)] += f" ({reading.in_words(quantity, motion.of_ground.dt)})"
    parts = [f"processed: {', '.join(steps)}"] if steps else []
    return "; ".join(parts + ([f"prepared from {motion.prepared_from}"] if motion.prepared_from else []))


def processing_data(motion: GroundMotion) -> dict[str, Any]:
    """Return the processing steps of a motion in order, as options spell them; for a floor also its peak [g].

    For a prepared record also its file.
    """
    entry: dict[str, Any] = {"processing": list(motion.processing)}
    if motion.prepared_from:
        entry["prepared_from"] = motion.prepared_from
    if motion.ground is not None:
        entry["floor_pga"] = motion.pga_g
    return entry
