"""A structure from its YAML file, with every problem placed at file:line:column."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property, partial
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.dotted import copied, put, words
from rocking_cli.io.field_problems import (
    fields_at,
    is_plural,
    lists_models,
    names_at,
    of_arguments,
    problems,
    types_at,
    unit_at,
)
from rocking_cli.io.yaml_file import Document, Place, parse, read_text
from rocking_cli.text import cut, did_you_mean, one_line

HINT = "`rocking new block` prints one to start from"


def load_structure(path: str | Path, registry: Registry | None = None) -> Mechanism:
    """Read a structure from a YAML file.

    Parameters
    ----------
    path : str or Path
        The file: a mapping with `mechanism` and that mechanism's fields.
    registry : Registry, optional
        Where to look up the mechanism; by default all that are installed.

    Returns
    -------
    Mechanism
        Named after the file if it does not give a name.

    Raises
    ------
    InputError
        With every problem of the file: place, field, and what would be right.
    MechanismError
        If the mechanism's plugin cannot be used.
    """
    name = one_line(Path(path).stem).strip() or "structure"
    return parse_structure(read_text(Path(path), "structure"), str(path), name, registry)


def parse_structure(text: str, file: str, default_name: str, registry: Registry | None = None) -> Mechanism:
    """Read a structure from YAML text; `file` is what errors call it. Raises as `load_structure`."""
    document = parse(text, file, "structure", HINT)
    return of_document(document, default_name, Path(file).parent, registry)


def of_document(document: Document, default_name: str, folder: Path, registry: Registry | None = None) -> Mechanism:
    """A structure of data that were read; files that it names are in `folder`. Raises as `load_structure`."""
    cls = _mechanism(document, registry if registry is not None else Registry())
    fields = {key: value for key, value in document.data.items() if key != "mechanism"}
    if cls is not None:
        try:
            mechanism = cls.from_fields({"name": default_name, **fields}, folder)
        except ValidationError as error:
            lister = f"`rocking mechanisms {cls.mechanism}` lists the fields"
            found = error.errors(include_url=False)
            document.problems += problems(document, cls, found, owner=cls.mechanism, lister=lister)
    document.check()
    return mechanism


@dataclass(frozen=True)
class Varied:
    """A structure of which one number is another.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    field : str
        The number, with dots for what is inside and an entry of a list by its name or number: `ties.bar.prestress`.
    folder : Path, optional
        Where files that its fields name are, by default here.

    Raises
    ------
    InputError
        If it has no such field, or the field is no number.
    """

    mechanism: Mechanism
    field: str
    folder: Path | None = None

    def __post_init__(self) -> None:
        cls, path = type(self.mechanism), words(self.field)
        place = put(copied(self._data), path, 1.0, is_list=partial(lists_models, cls), grow=False)
        found: Place = ()
        for k, part in enumerate(place):
            if isinstance(part, str):
                named = names_at(cls, found)
                known = list(self._entries(found) if named else fields_at(cls, found))
                if part not in known:
                    within = ".".join(path[:k]) or cls.mechanism
                    message = f"{within} has no {cut(part)}" if named else f"{cut(part)} is not a field of {within}"
                    message, hint = message if k else f"is not a field of {within}", did_you_mean(part, known)
                    raise InputError(Problem(message, field=self.field, hint=hint))
            found = (*found, part)
        if float not in types_at(cls, place) or (isinstance(place[-1], str) and is_plural(cls, place)):
            raise InputError(Problem("is no number that could vary", field=self.field))
        object.__setattr__(self, "_place", place)

    @cached_property
    def _data(self) -> dict[str, Any]:
        return self.mechanism.model_dump(by_alias=True, exclude_unset=True)

    def _entries(self, place: Place) -> list[str]:
        """The names that the user chose at a place."""
        here: Any = self._data
        for part in place:
            here = (here or {}).get(part) if isinstance(part, str) else here[part]
        return list(here or {})

    @property
    def unit(self) -> str:
        """That of the number; empty if it has none."""
        return unit_at(type(self.mechanism), self._place)  # type: ignore[attr-defined]

    @property
    def value(self) -> float | None:
        """The number as it is; None if it is not given."""
        here: Any = self._data
        for part in self._place:  # type: ignore[attr-defined]
            here = here.get(part) if isinstance(here, dict) else here[part]
            if here is None:
                return None
        return float(here) if isinstance(here, int | float) else None

    def at(self, value: float) -> Mechanism:
        """The structure with another number. Raises `InputError` if it cannot be built."""
        data, cls = copied(self._data), type(self.mechanism)
        put(data, words(self.field), value, is_list=partial(lists_models, cls), grow=False)
        try:
            return cls.from_fields(data, self.folder)
        except ValidationError as error:
            raise InputError(*of_arguments(cls, error.errors(include_url=False), cls.mechanism)) from None


def _mechanism(document: Document, registry: Registry) -> type[Mechanism] | None:
    """The class the file asks for; None with a problem noted if there is no such mechanism."""
    data = document.data
    if "mechanism" not in data:
        known = ", ".join(registry)
        near = get_close_matches("mechanism", list(data), n=1)
        hint = f"is {near[0]} meant to be mechanism?" if near else f"add a line `mechanism: NAME`; known: {known}"
        document.problems.append(document.problem("is missing", document.values[()], "mechanism", hint))
        return None
    name, mark = data["mechanism"], document.values[("mechanism",)]
    if not isinstance(name, str) or name not in registry:
        guess = did_you_mean(str(name), list(registry))
        document.problems.append(document.problem(f"unknown mechanism {cut(repr(name))}", mark, "mechanism", guess))
        return None
    return registry[name]
