"""Paths in the data of a structure as users write them, with dots: `width`, `loads.0.mass`, `ties.bar.prestress`.

For a list, a number is the index of an entry, from 0, and a word is the `name` of an entry.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.yaml_file import MAX_DEPTH, Place
from rocking_cli.text import cut, did_you_mean

MAX_LIST_ENTRIES = 10_000
HOLE: Any = ...
"""Placeholder for a list entry that has no value yet."""


def words(text: str) -> tuple[str, ...]:
    """Return the words of a path. Raises `InputError` if there are none."""
    parts = tuple(part.strip() for part in text.strip().split("."))
    if not all(parts):
        hint = "write words with a dot between them, such as loads.0.mass"
        raise InputError(Problem(f"{cut(repr(text))} is not a valid field", hint=hint))
    if len(parts) > MAX_DEPTH:
        raise InputError(Problem(f"{cut(repr(text))} has more than {MAX_DEPTH} parts: no field lies so deep"))
    return parts


def put(
    data: dict[str, Any],
    path: tuple[str, ...],
    value: Any,
    *,
    is_list: Callable[[Place], bool] = lambda place: False,
    grow: bool = True,
) -> Place:
    """Put a value at a path in plain data, which is changed, and return its place.

    Parameters
    ----------
    data : dict
        Nested mappings and lists, which are changed.
    path : tuple of str
        Path, as returned by `words`.
    value : any
        The new value.
    is_list : callable
        Function that returns whether a missing item at a place is a list, even if a name follows and not a number.
    grow : bool
        Whether new entries may be added to lists; an entry added by name gets this name. Entries skipped by a number
        are placeholders, which `closed` removes.

    Returns
    -------
    tuple
        The place: keys of mappings and indices of lists.

    Raises
    ------
    InputError
        If a list has no such entry, or the path goes through a number or a text.
    """
    here: Any = data
    place: Place = ()
    for k, word in enumerate(path):
        key: Any = _entry(here, word, path[:k], grow=grow) if isinstance(here, list) else word
        place = (*place, key)
        if k == len(path) - 1:
            here[key] = value
            break
        inner = here[key] if isinstance(here, list) else here.get(key)
        if inner is None or inner is HOLE:
            inner = here[key] = [] if path[k + 1].isdecimal() or is_list(place) else {}
        if not isinstance(inner, dict | list):
            raise InputError(Problem(f"{'.'.join(path[: k + 1])} is {cut(repr(inner))}, and holds no {path[k + 1]}"))
        here = inner
    return place


def replace_at(data: Any, place: Place, value: Any) -> None:
    """Replace the value at an existing place, as returned by `put`."""
    for part in place[:-1]:
        data = data[part]
    data[place[-1]] = value


def _entry(entries: list[Any], word: str, before: tuple[str, ...], *, grow: bool) -> int:
    """Return the index of an entry by its number or name; a new entry is added if `grow` is True."""
    names = [each.get("name") if isinstance(each, dict) else None for each in entries]
    if word in names:
        return names.index(word)
    of = ".".join(before)
    number = int(word) if word.isdecimal() and len(word) < 10 else MAX_LIST_ENTRIES
    if word.isdecimal() and number < len(entries):
        return number
    if not grow:
        raise InputError(Problem(f"{of} has no entry {cut(word)}", hint=_known(word, names)))
    if word.isdecimal():
        if number >= MAX_LIST_ENTRIES:
            raise InputError(Problem(f"{cut(word)} is not a valid place in a list: at most {MAX_LIST_ENTRIES - 1}"))
        entries += [HOLE] * (number + 1 - len(entries))
        return number
    entries.append({"name": word})
    return len(entries) - 1


def _known(word: str, names: list[Any]) -> str:
    named = [str(each) for each in names if isinstance(each, str)]
    numbers = f"numbers count from 0, here to {len(names) - 1}" if names else "it has none"
    guess = did_you_mean(word, named) if named else None
    return f"{guess} {numbers}" if guess and guess.endswith("?") else f"{guess}; {numbers}" if guess else numbers


def closed(data: Any) -> Any:
    """Return the data without the placeholders of list entries that received no value."""
    if isinstance(data, dict):
        return {key: closed(value) for key, value in data.items()}
    return [closed(each) for each in data if each is not HOLE] if isinstance(data, list) else data
