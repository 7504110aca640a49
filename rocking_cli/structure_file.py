"""Read a structure from its YAML file, with every problem placed at file:line:column."""

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

HINT = "`rocking new block` prints a template"


def load_structure(path: str | Path, registry: Registry | None = None) -> Mechanism:
    """Read a structure from a YAML file.

    Parameters
    ----------
    path : str or Path
        The file: a mapping with `mechanism` and that mechanism's fields.
    registry : Registry, optional
        Registry of mechanisms; by default that of all installed ones.

    Returns
    -------
    Mechanism
        Structure, named after the file if it does not give a name.

    Raises
    ------
    InputError
        With every problem of the file: its place, its field and a remedy.
    MechanismError
        If the mechanism's plugin cannot be used.
    """
    name = one_line(Path(path).stem).strip() or "structure"
    return parse_structure(read_text(Path(path), "structure"), str(path), name, registry)


def parse_structure(text: str, file: str, default_name: str, registry: Registry | None = None) -> Mechanism:
    """Read a structure from YAML text; errors name it `file`. Raises as `load_structure`."""
    document = parse(text, file, "structure", HINT)
    return of_document(document, default_name, Path(file).parent, registry)


def of_document(document: Document, default_name: str, folder: Path, registry: Registry | None = None) -> Mechanism:
    """Make a structure from a document that was read; it names files in `folder`. Raises as `load_structure`."""
    cls = _mechanism(document, registry if registry is not None else Registry())
    fields = {key: value for key, value in document.data.items() if key != "mechanism"}
    if cls is not None:
        try:
            mechanism = cls.from_fields({**fields, "name": fields.get("name", default_name) or default_name}, folder)
        except ValidationError as error:
            lister = f"`rocking mechanisms {cls.mechanism}` lists the fields"
            found = error.errors(include_url=False)
            document.problems += problems(document, cls, found, owner=cls.mechanism, lister=lister)
    document.check()
    return mechanism


@dataclass(frozen=True)
class Varied:
    """A structure with one numeric field that varies.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    field : str
        Path of the field, with dots, and entries of lists by name or number: `ties.bar.prestress`.
    folder : Path, optional
        Folder of the files that its fields name; by default the current one.

    Raises
    ------
    InputError
        If the structure does not have the field, or the field is not numeric.
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
            raise InputError(Problem("is not a numeric field, so it cannot be varied", field=self.field))
        object.__setattr__(self, "_place", place)

    @cached_property
    def _data(self) -> dict[str, Any]:
        return self.mechanism.model_dump(by_alias=True, exclude_unset=True)

    def _entries(self, place: Place) -> list[str]:
        """Return the names that the user chose at a place."""
        here: Any = self._data
        for part in place:
            here = (here or {}).get(part) if isinstance(part, str) else here[part]
        return list(here or {})

    @property
    def unit(self) -> str:
        """Unit of the field; empty if it is dimensionless."""
        return unit_at(type(self.mechanism), self._place)  # type: ignore[attr-defined]

    @property
    def value(self) -> float | None:
        """Current value of the field; None if it is not given."""
        here: Any = self._data
        for part in self._place:  # type: ignore[attr-defined]
            here = here.get(part) if isinstance(here, dict) else here[part]
            if here is None:
                return None
        return float(here) if isinstance(here, int | float) else None

    def at(self, value: float) -> Mechanism:
        """Return the structure with another value of the field. Raises `InputError` if it cannot be built."""
        data, cls = copied(self._data), type(self.mechanism)
        put(data, words(self.field), value, is_list=partial(lists_models, cls), grow=False)
        try:
            return cls.from_fields(data, self.folder)
        except ValidationError as error:
            raise InputError(*of_arguments(cls, error.errors(include_url=False), cls.mechanism)) from None


def _mechanism(document: Document, registry: Registry) -> type[Mechanism] | None:
    """Return the class of the mechanism in the file; None, with a problem added, if it does not exist."""
    data = document.data
    if "mechanism" not in data:
        known = ", ".join(registry)
        near = get_close_matches("mechanism", list(data), n=1)
        hint = (
            f"did you mean mechanism instead of {near[0]}?" if near else f"add a line `mechanism: NAME`; known: {known}"
        )
        document.problems.append(document.problem("is missing", document.values[()], "mechanism", hint))
        return None
    name, mark = data["mechanism"], document.values[("mechanism",)]
    if not isinstance(name, str) or name not in registry:
        guess = did_you_mean(str(name), list(registry))
        document.problems.append(document.problem(f"unknown mechanism {cut(repr(name))}", mark, "mechanism", guess))
        return None
    return registry[name]
