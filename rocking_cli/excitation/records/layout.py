"""Common parts of the data centres' formats: items of headers, Fortran's fixed-width numbers, and several channels."""

from __future__ import annotations

import math
import re
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import MOST_SAMPLES, NOT_SAID, STANDARD_GRAVITY, Doubt, GroundMotion, Origin
from rocking_cli.excitation.records.lines import Lines, PrintedRows, odd_digits, odd_row, split_numbers
from rocking_cli.excitation.records.record_units import (
    GAIN_EXAMPLE,
    QUANTITIES,
    Asked,
    Quantity,
    Wanted,
    units_of,
)
from rocking_cli.excitation.records.statements import origin
from rocking_cli.excitation.records.text import Followed, check_interval, numbers_in, sensible
from rocking_cli.text import regex

# The only letters in a row of numbers are exponents. Asterisks are overflows, which `numbers_in` refuses.
_NO_ROW = regex(r"[^\s\d.+\-*EeDd]")
_NOT_FINITE = regex(r"[+-]?(?:nan|inf|infinity)\b", re.IGNORECASE)
FIRST_ROW = regex(r"\s*[+-]?\.?\d")
_MAX_COLUMN_WIDTH = 1000  # characters
CUT = "the file may have been cut short or edited: download it again"
_LOST = "a character was lost or added, so that its values are wrong: download the file again"
_TOUCHING = "the rows do not keep to columns of {} characters, so that numbers that touch cannot be told apart"


@dataclass(frozen=True)
class RecordBlock:
    """Place and number of a block of numbers in a file.

    Parameters
    ----------
    start : int
        Index of the first line, from 0.
    count : int
        Number of values that the header states.
    width : int or None
        Characters per number; None for numbers that are not in columns.
    header_line : int
        Number of the header line that states `count`, from 1.
    margin : int, optional
        Characters before the first number of a line.
    after : int, optional
        Number of blanks at the end of each column.
    unset : float, optional
        Number that means a missing value, which is read as NaN.
    """

    start: int
    count: int
    width: int | None
    header_line: int
    margin: int = 0
    after: int = 0
    unset: float | None = None


@dataclass(frozen=True, eq=False)
class Channel:
    """One component of a record.

    Parameters
    ----------
    name : str
        Name in the file, such as an azimuth; empty if it has none.
    dt : float
        Interval between samples [s].
    acceleration : ndarray, shape (npts,)
        Ground acceleration [m/s2].
    unit : str
        Unit in the file.
    dt_line : int, optional
        Number of the line that states the interval.
    flaw : Problem, optional
        Why the channel cannot be used: this is shown in lists of channels, and if the channel is chosen.
    points : ndarray of int, optional
        Indexes of the samples that were recorded, if not all of them.
    remarks : tuple of Doubt, optional
        Doubts about how the channel is printed in the file.
    origin : Origin, optional
        The earthquake and the station.
    """

    name: str
    dt: float
    acceleration: Reals
    unit: str
    dt_line: int | None = None
    flaw: Problem | None = None
    points: NDArray[np.intp] | None = None
    remarks: tuple[Doubt, ...] = ()
    origin: Origin = NOT_SAID


class Numbers(NamedTuple):
    """Numbers read by `fixed_width`.

    Parameters
    ----------
    values : ndarray, shape (count,)
        The numbers.
    end : int
        Index of the line after the last one.
    remarks : tuple of Doubt
        Doubts about how the numbers are printed.
    """

    values: Reals
    end: int
    remarks: tuple[Doubt, ...]


def lines_of(text: str) -> Lines:
    """Return the lines of a file with columns, with blanks in place of the tabs that an editor may have put."""
    return Lines(text, tabs=True)


def fixed_width(file: str, lines: Lines, block: RecordBlock, *, last: bool = True) -> Numbers:
    """Read numbers in columns of a constant width, with or without blanks between them.

    A single row that is not aligned to the columns has lost a character, and its numbers cannot be trusted. If most
    rows are not aligned, an editor has removed blanks: they are read as numbers separated by blanks, with a remark.

    Parameters
    ----------
    file : str
        The file, for the messages.
    lines : Lines
        All lines of the file.
    block : RecordBlock
        Place and number of the values.
    last : bool, optional
        Whether the block is the last, so that no other numbers may follow.

    Returns
    -------
    Numbers

    Raises
    ------
    InputError
        If a number is not finite, there are too many or too few, or a few rows are not aligned to the columns.
    """
    lines.check_lengths(file)
    values = array("d")  # a list would need an object per value
    index = block.start
    leaving: list[int] = []  # line numbers of rows that leave the columns
    unread: InputError | None = None
    for line in lines.since(block.start):
        has_words = _NO_ROW.search(line) and _NO_ROW.search(_NOT_FINITE.sub("0", line))
        if has_words or not line.strip() or (len(values) >= block.count and not last):
            break
        row = line.rstrip()
        index += 1
        cells = _cells(row, block)
        if cells is None:
            leaving.append(index)
            cells = split_numbers(row)
            try:
                numbers = _floats(file, index, row, cells, block)
            except InputError as error:
                unread = unread or error
                numbers = [math.nan] * len(cells)
        else:
            numbers = _floats(file, index, row, cells, block)
        values.extend(numbers)
    remarks: tuple[Doubt, ...] = ()
    rows = index - block.start
    if leaving:
        if 2 * len(leaving) <= rows and not lines.edited:
            more = f" (as in {len(leaving) - 1} more of {rows})" if len(leaving) > 1 else ""
            message = f"the numbers of this row do not end at their columns of {block.width} characters{more}"
            raise InputError(Problem(message, file, leaving[0], excerpt=lines[leaving[0] - 1][:100], hint=_LOST))
        if unread is not None:
            raise InputError(*(replace(problem, hint=_TOUCHING.format(block.width)) for problem in unread.problems))
        remarks = (_no_columns(leaving, rows, block),)
    if len(values) != block.count:
        excerpt = lines[index].strip()[:100] if index < len(lines) else None
        where = f", up to line {index}" if index < len(lines) else ""
        message = f"the header says {block.count} values, but {len(values)} follow{where}"
        hint = CUT
        if leaving:
            hint += f"; its rows leave columns of {block.width} characters, and numbers that touch are taken for one"
        raise InputError(Problem(message, file=file, line=block.header_line, excerpt=excerpt or None, hint=hint))
    if block.width is None or leaving:
        remarks += tuple(odd_digits(PrintedRows(lines, block.start, split_numbers, index)))
    return Numbers(np.array(values), index, remarks)


def _cells(row: str, block: RecordBlock) -> list[str] | None:
    """Split a row into cells; None if its numbers do not all end where their columns end."""
    if block.width is None:
        return [row]
    wide, rest = divmod(len(row) - block.margin + block.after, block.width)
    if rest or not wide or row[: block.margin].strip():
        return None
    first = block.margin - block.after
    cells = [row[max(first + k * block.width, 0) : first + (k + 1) * block.width] for k in range(wide)]
    return None if any(cell.endswith(" ") or len(cell.split()) != 1 for cell in cells) else cells


def _floats(file: str, line_number: int, row: str, cells: Sequence[str], block: RecordBlock) -> list[float]:
    """Return the values of cells, NaN for missing values."""
    try:
        values = [float(cell.upper().replace("D", "E")) for cell in cells]
    except ValueError:
        values = []
    if values and block.unset is not None:
        values = [math.nan if value == block.unset else value for value in values]
        if all(sensible(value) or math.isnan(value) for value in values):
            return values
    if not values or not all(map(sensible, values)):
        return numbers_in(file, line_number, row, cells)
    return values


def _no_columns(leaving: Sequence[int], rows: int, block: RecordBlock) -> Doubt:
    """Return the doubt that rows are read as free text, as they are not aligned to columns."""
    text = (
        f"{len(leaving)} of its {rows} rows, from line {leaving[0]} on, do not keep to columns of {block.width} "
        "characters: they were read as numbers with blanks between them. Did an editor save the file?"
    )
    return Doubt("columns", float(len(leaving)), text)


def aligned(file: str, rows: PrintedRows) -> tuple[Doubt, ...]:
    """Return doubts about digits; raise `InputError` if a few rows are not aligned to the columns of the others."""
    if (odd := odd_row(rows)) is not None:
        message = "the numbers of this row do not end at the columns of the other rows"
        raise InputError(Problem(message, file, odd[0], excerpt=odd[1][:100], hint=_LOST))
    return tuple(odd_digits(rows))


def stated_unit(file: str, line_number: int, unit: str, asked: Asked) -> tuple[str, float]:
    """Return name and size of the unit that a line of the header, or the definition of a format, states."""
    return asked.unit(file, [(line_number, f"units: {unit}")])


def quantity_called(word: str) -> Quantity | None:
    """Return the quantity that a header calls by a word such as ACCEL or velocity; None if it is another."""
    return next((each for each in QUANTITIES if word.lower().startswith(each[:3])), None)


def lacking(file: str, wanted: Wanted, held: Sequence[str], line_number: int | None = None) -> InputError:
    """Return the error of a file that holds other quantities than the requested one, by their names in the file."""
    message = f"the file holds no {wanted.quantity}, but {', '.join(dict.fromkeys(held))}"
    hint = f"give the file with the {wanted.quantity}"
    if other := next(filter(None, map(quantity_called, held)), None):
        hint += f", or say {named('quantity')} {other}"
    elif not wanted.raw:
        hint += f", or the {named('gain')} of the instrument, such as {GAIN_EXAMPLE}"
    return InputError(Problem(message, file, line_number, hint=hint))


def check_end(file: str, lines: Lines, end: int) -> None:
    """Raise `Followed` if anything but blanks follows the only record of a file, from line index `end` on."""
    for index, line in enumerate(lines.since(end), start=end):
        if line.strip():
            message = "only blanks or another record may follow a record"
            raise Followed(index, Problem(message, file, index + 1, excerpt=line.strip()[:100]))


def whole_number(
    file: str, line_number: int, line: str, token: str, what: str, *, least: int = 1, most: int = MOST_SAMPLES
) -> int:
    """Return an integer of the header from `least` to `most`; `what` is its name in messages."""
    digits = token.strip()
    # `int` refuses thousands of digits, and accepts digits of other scripts.
    if re.fullmatch(r"[+-]?[0-9]{1,30}", digits) and least <= int(digits) <= most:
        return int(digits)
    quoted = digits if len(digits) <= 40 else f"{digits[:20]}... ({len(digits)} characters)"
    message = f"the {what} must be a whole number from {least} to {most}, this is {quoted or 'missing'}"
    raise InputError(Problem(message, file, line_number, excerpt=line.strip()[:100]))


def column_width(file: str, line_number: int, line: str, token: str) -> int:
    """Return the number of characters per number, from the format in the header."""
    return whole_number(file, line_number, line, token, "width of the columns", most=_MAX_COLUMN_WIDTH)


def number(file: str, line_number: int, line: str, token: str, what: str) -> float:
    """Return a number of the header, which must be positive; `what` is its name in messages."""
    (value,) = numbers_in(file, line_number, line, [token])
    if not value > 0:
        message = f"the {what} must be more than 0, this is {token.strip()}"
        raise InputError(Problem(message, file=file, line=line_number, excerpt=line.strip()[:100]))
    return value


def choose(file: str, form: str, channels: Sequence[Channel], asked: Asked) -> GroundMotion:
    """Return the ground motion of the requested channel, or of the only one.

    Parameters
    ----------
    file : str
        The file, for the messages and the name of the motion.
    form : str
        Name of the format.
    channels : sequence of Channel
        Channels of the file.
    asked : Asked
        The requested channel and its quantity, and the sampling interval [s], which must agree with the file.

    Returns
    -------
    GroundMotion
        Accelerations [m/s2], named after the file, and after the channel if there are several.
    """
    if asked.channel is None and len(channels) > 1:
        message = f"the file has {len(channels)} channels, and only one can shake a structure"
        hint = f"choose one with {named('channel')}:{_listed(channels, asked.wanted)}"
        raise InputError(Problem(message, file=file, hint=hint))
    chosen = channels[0] if asked.channel is None else _find(file, channels, asked.channel, asked.wanted)
    if chosen.flaw is not None:
        raise InputError(chosen.flaw)
    check_interval(file, chosen.dt_line, chosen.dt, asked.dt)
    name = Path(file).name
    if len(channels) > 1:
        name += f" channel {chosen.name or 1 + list(channels).index(chosen)}"
    return GroundMotion(
        name,
        chosen.dt,
        chosen.acceleration,
        source_unit=chosen.unit,
        format=form,
        points=chosen.points,
        remarks=chosen.remarks,
        origin=chosen.origin,
    )


def _find(file: str, channels: Sequence[Channel], requested: str, wanted: Wanted) -> Channel:
    """Return the channel with a number or name; a number such as 90 is tried as the channel's number first."""
    word = _plain(requested)
    if word.isdecimal() and 1 <= int(word) <= len(channels):
        return channels[int(word) - 1]
    of_name = [channel for channel in channels if channel.name and _plain(channel.name) == word]
    if len(of_name) == 1:
        return of_name[0]
    message = f"{len(of_name)} channels are called '{requested}'" if of_name else f"there is no channel '{requested}'"
    hint = f"there {'is' if len(channels) == 1 else 'are'}:{_listed(channels, wanted)}"
    raise InputError(Problem(message, file=file, field=named("channel"), hint=hint))


def _plain(name: str) -> str:
    """Return a name in lower case, with single blanks, and without the unit of an azimuth."""
    return re.sub(r"(?<=\d) ?deg(?:rees)?$", "", " ".join(name.lower().split()))


def _listed(channels: Sequence[Channel], wanted: Wanted) -> str:
    """Return text that lists all channels with number, name, points and peak, or why they cannot be used."""
    out = ""
    for place, channel in enumerate(channels, start=1):
        out += f"\n    {place}: {channel.name + ', ' if channel.name else ''}{channel.acceleration.size} points, "
        if channel.flaw:
            out += channel.flaw.message
        elif wanted.of_accelerations:
            out += f"PGA {float(np.abs(channel.acceleration).max()) / STANDARD_GRAVITY:.4g} g"
        else:
            unit = "" if wanted.raw else f" {units_of(wanted.quantity)[0]}"
            out += f"peak {float(np.abs(channel.acceleration).max()):.4g}{unit}"
    return out


_SEARCHED_PER_LINE = 1000


class Field(NamedTuple):
    """Where an item of a text header stands.

    Parameters
    ----------
    pattern : re.Pattern
        Pattern of its line; the groups are the texts of the item.
    what : str, optional
        Name of the item in messages; empty if a header may lack it.
    such : str, optional
        Spelling or example of the item, for the message that it is missing.
    line : int, optional
        Number of the only line that may have it, from 1 at the first line of the header.
    """

    pattern: re.Pattern[str]
    what: str = ""
    such: str = ""
    line: int | None = None


class Item(NamedTuple):
    """Item of a header: the number of its line in the file from 1, the line, and the groups of its pattern."""

    line_number: int
    line: str
    groups: tuple[str, ...]


@dataclass(frozen=True)
class RecordHead:
    """Items of a text header, as `read_head` finds them.

    Parameters
    ----------
    file : str
        The file, for messages.
    fields : mapping of str to Field
        Where the items stand, by name.
    items : mapping of str to Item
        The items that the header states, by name.
    """

    file: str
    fields: Mapping[str, Field]
    items: Mapping[str, Item]

    def __getitem__(self, name: str) -> Item:
        """Return an item that the header must state."""
        return self.items[name]

    def text(self, name: str) -> str | None:
        """Return the text of an item; None if the header does not state it."""
        return self.items[name].groups[0] if name in self.items else None

    def number(self, name: str, group: int = 0) -> float:
        """Return a positive number that the header must state."""
        item = self.items[name]
        return number(self.file, item.line_number, item.line, item.groups[group], self.fields[name].what)

    @property
    def count(self) -> int:
        """The item `count`, a number of points."""
        item = self.items["count"]
        return whole_number(self.file, item.line_number, item.line, item.groups[0], "number of points", least=2)

    @property
    def origin(self) -> Origin:
        """The items `event`, `station`, `magnitude` and `distance`, as far as the header states them."""
        return origin(*map(self.text, ("event", "station", "magnitude", "distance")))


def read_head(file: str, lines: Lines, fields: Mapping[str, Field], count: int, start: int = 0) -> RecordHead:
    """Read the text header of a channel, which has `count` lines from line index `start` on.

    Raises `InputError` if the header does not state an item that it must state.
    """
    head = [line.rstrip()[:_SEARCHED_PER_LINE] for line in lines[start : start + count]]
    items: dict[str, Item] = {}
    for name, field in fields.items():
        for place, line in enumerate(head, start=1):
            if field.line in (None, place) and (match := field.pattern.search(line)):
                items[name] = Item(start + place, line, match.groups())
                break
        else:
            if field.what:
                message = f"the header does not state the {field.what}{field.such}"
                raise InputError(Problem(message, file, start + 1))
    return RecordHead(file, fields, items)
