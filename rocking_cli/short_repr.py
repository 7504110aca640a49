"""A `repr` of one line, and a table in notebooks, for objects that hold arrays or many fields."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from html import escape
from inspect import cleandoc
from itertools import islice
from math import isnan
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

from rocking_cli.text import cut, one_line

C = TypeVar("C", bound=type)
MAX_LENGTH, MAX_PART_LENGTH = 200, 80  # characters of an object, and of one that is a part of another
MAX_TEXT_LENGTH = 40  # characters of a text
MAX_LISTED = 4  # numbers or texts of a list; the entries of other lists are counted
MAX_ENTRIES = 30  # entries of a dictionary that are looked at; more do not fit in a line
ENTRY = re.compile(r"^(\w+(?:, \w+)*) : .*\n((?: {4}.*(?:\n|$))+)", re.MULTILINE)
"""An entry of the parameters in a docstring: their names, and the description."""
UNIT = re.compile(r"\[((?:1/)?[A-Za-z][^\[\],.]*)\]")  # not [Eq. 22]
TEXT, TRUE, NUMBER, SEVERAL, PART, FALSE = range(6)
"""Kinds of values, in the order in which they are shown."""


def short_repr(cls: C) -> C:
    """Give a dataclass, a named tuple or a dictionary a `repr` of one line, and a table in notebooks.

    Both show texts first, then what is True, numbers with the units of the docstring, arrays by shape and range, lists
    by length, parts of other classes in short, and what is False. They leave out what is None, NaN or empty, and the
    line also the last that would make it too long.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.closed_form(3.0, 2.0, 0.9)
    <ClosedForm: D0 = 5.8026, conditions = 3 bool>
    """
    cls.__repr__ = line_of  # type: ignore[method-assign,assignment]
    cls._repr_html_ = _table_of  # type: ignore[attr-defined]
    return cls


def line_of(shown: Any, most: int = MAX_LENGTH, *, inner: bool = False) -> str:
    """Return an object in one line of at most `most` characters, see `short_repr`; `inner` if it is part of another."""
    name, parts = type(shown).__name__, [f"{key} = {words}" for key, words in _rows(shown, inner)]
    line = f"<{name}: {', '.join(parts)}>" if parts else f"<{name}>"
    while len(line) > most and parts:
        parts.pop()
        line = f"<{name}: {', '.join([*parts, '...'])}>"
    return line


def _table_of(shown: Any) -> str:
    rows = "".join(f"<tr><th>{escape(key)}</th><td>{escape(words)}</td></tr>" for key, words in _rows(shown))
    return f"<table><caption>{escape(type(shown).__name__)}</caption><tbody>{rows}</tbody></table>"


def _rows(shown: Any, inner: bool = False) -> list[tuple[str, str]]:
    """Return the names of the fields that are shown, in their order, with their values in words."""
    cls: Any = type(shown)
    units = _units(cls)
    rows = [(key, *_in_words(value, units.get(key, ""), inner)) for key, value in _fields(shown)]
    return [(key, words) for key, _, words in sorted(rows, key=lambda row: row[1]) if words]


def _fields(shown: Any) -> Iterable[tuple[str, Any]]:
    if isinstance(shown, dict):
        return [(one_line(cut(str(key), MAX_TEXT_LENGTH)), value) for key, value in islice(shown.items(), MAX_ENTRIES)]
    if isinstance(shown, tuple):
        return zip(shown._fields, shown, strict=True)  # type: ignore[attr-defined]
    if is_dataclass(shown):
        return [(each.name, getattr(shown, each.name)) for each in fields(shown) if each.repr]
    of_model: Iterable[tuple[str, Any]] = shown.__repr_args__()
    return of_model


@cache
def _units(cls: type) -> dict[str, str]:
    """Return the units of the fields of a class that its fields, its docstring or those of its bases state."""
    declared = {key: info.json_schema_extra or {} for key, info in getattr(cls, "model_fields", {}).items()}
    units = {key: str(extra["unit"]) for key, extra in declared.items() if extra.get("unit")}
    for base in reversed(cls.__mro__):
        for names, description in ENTRY.findall(cleandoc(base.__doc__ or "")):
            keys, stated = names.split(", "), UNIT.findall(description)
            if len(stated) in (1, len(keys)):
                units |= dict(zip(keys, stated * (len(keys) // len(stated)), strict=True))
    return {key: "g" if unit == "standard gravity" else unit for key, unit in units.items()}


def _in_words(value: Any, unit: str, inner: bool) -> tuple[int, str]:
    """Return the kind of a value and its words, which are empty if it is left out."""
    value = value.item() if getattr(value, "shape", None) == () else value
    after = f" {unit}" if unit else ""
    if isinstance(value, str | Path | Enum):
        return TEXT, _text(value)
    if isinstance(value, bool):
        return (TRUE, "True") if value else (FALSE, "False")
    if isinstance(value, int | float | complex):
        return NUMBER, f"{_number(value)}{after}" if value == value else ""
    if hasattr(value, "dtype"):
        return SEVERAL, _array(value, after)
    if type(value) in (list, tuple, set, frozenset, dict, MappingProxyType):
        return SEVERAL, _several([*(value.values() if isinstance(value, Mapping) else value)], after)
    return PART, "" if value is None or callable(value) else _part(value, inner)


def _text(value: str | Path | Enum) -> str:
    if isinstance(value, Enum) and not isinstance(value, str):
        return str(value.name)
    return repr(cut(str(value), MAX_TEXT_LENGTH)) if str(value) else ""


def _number(value: complex | None) -> str:
    return f"{value:.5g}" if isinstance(value, float | complex) else str(value)


def _array(values: Any, after: str) -> str:
    """Return the shape of an array, and the range of its numbers or how many of it are True."""
    shape, kind = "x".join(map(str, values.shape)), values.dtype.kind
    if kind == "b":
        return f"{int(values.sum())} of {shape} True" if values.any() else ""
    if kind not in "iuf":
        return f"{shape} {values.dtype.name}"
    known = values[values == values]
    after = after if values.ndim == 1 else ""  # the columns of others may have units of their own
    return f"{shape}{_range(known.min(), known.max())}{after}" if known.size else ""


def _range(low: float, high: float) -> str:
    return f" of {low:.5g}" if low == high else f" from {low:.5g} to {high:.5g}"


def _several(entries: list[Any], after: str) -> str:
    """Return a short list of numbers or texts, the range of many numbers, or how many entries of which class."""
    known = [each for each in entries if each is not None and not (isinstance(each, float) and isnan(each))]
    kinds = {type(each) for each in known}
    if not known:
        return ""
    if kinds <= {int, float}:
        few = f"({', '.join(map(_number, entries))})"
        return f"{few if len(entries) <= MAX_LISTED else f'{len(entries)}{_range(min(known), max(known))}'}{after}"
    if kinds == {str} and len(words := f"({', '.join(map(_text, known))})") <= MAX_TEXT_LENGTH:
        return words
    return f"{len(entries)} {kinds.pop().__name__ if len(kinds) == 1 else 'entries'}"


def _part(value: Any, inner: bool) -> str:
    """Return a part of an object: in short, or by class and name."""
    if getattr(type(value), "_repr_html_", None) is _table_of and not inner:
        return line_of(value, MAX_PART_LENGTH, inner=True)
    name = getattr(value, "name", None)
    return type(value).__name__ + (f" {_text(name)}" if isinstance(name, str) else "")
