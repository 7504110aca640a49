"""Text headers of the data centres' formats: where an item stands is a row of a table, read by one function."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import Origin
from rocking_cli.excitation.records.layout import number, whole_number
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.origins import origin

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
