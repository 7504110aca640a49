"""A `repr` of one line for objects that hold arrays or many fields."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from itertools import islice
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

from rocking_cli.text import cut, one_line

C = TypeVar("C", bound=type)
MAX_LENGTH, MAX_TEXT_LENGTH = 200, 40  # characters of an object, and of a text in it
MAX_ENTRIES = 30  # entries that are looked at; more do not fit in a line


def short_repr(cls: C) -> C:
    """Give a dataclass, a named tuple or a dictionary a `repr` of one line.

    It shows texts, numbers, arrays by shape and range, lists by length and parts by class and name. It leaves out what
    is None, NaN, empty or a function, and the last that would make the line too long.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.closed_form(3.0, 2.0, 0.9)
    <ClosedForm: D0 = 5.8026, conditions = 3 bool>
    """
    cls.__repr__ = line_of  # type: ignore[method-assign,assignment]
    return cls


def line_of(shown: Any) -> str:
    """Return an object in one line, see `short_repr`."""
    held: Iterable[tuple[str, Any]]
    if is_dataclass(shown):
        held = ((each.name, getattr(shown, each.name)) for each in fields(shown) if each.repr)
    elif isinstance(shown, dict):
        held = islice(shown.items(), MAX_ENTRIES)
    else:
        held = shown._asdict().items() if isinstance(shown, tuple) else shown.__repr_args__()  # type: ignore[attr-defined]
    parts = [f"{one_line(cut(key, MAX_TEXT_LENGTH))} = {words}" for key, value in held if (words := _in_words(value))]
    line = f"<{type(shown).__name__}: {', '.join(parts)}>" if parts else f"<{type(shown).__name__}>"
    while len(line) > MAX_LENGTH:
        parts.pop()
        line = f"<{type(shown).__name__}: {', '.join([*parts, '...'])}>"
    return line


def _in_words(value: Any) -> str:
    """Return a value in short; empty if it is left out."""
    if value is None or callable(value):
        return ""
    if shape := getattr(value, "shape", ()):
        known = value[value == value][: value.size if value.dtype.kind in "iuf" else 0]
        of = f"from {known.min():.5g} to {known.max():.5g}" if known.size else value.dtype.name
        return f"{'x'.join(map(str, shape))} {of}" if value.size else ""
    if isinstance(value, float | complex):
        return f"{value:.5g}" if value == value else ""
    if isinstance(value, str | Path):
        return repr(cut(str(value), MAX_TEXT_LENGTH)) if str(value) else ""
    if type(value) in (list, tuple, dict, MappingProxyType):
        kinds = {type(each).__name__ for each in (value.values() if isinstance(value, Mapping) else value)}
        return f"{len(value)} {kinds.pop() if len(kinds) == 1 else 'entries'}" if kinds else ""
    name = getattr(value, "name", None)
    if isinstance(value, int | Enum):
        return str(name or value)
    return type(value).__name__ + (f" {_in_words(name)}" if isinstance(name, str) else "")
