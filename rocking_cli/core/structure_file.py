"""Read a structure from its YAML file, with every problem placed at file:line:column, and write one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_fields import StructureFields
from rocking_cli.io.field_problems import problems
from rocking_cli.io.yaml_file import Document, block, parse, read_text
from rocking_cli.text import cut, one_line

TEMPLATE_HINT = "`rocking new block` prints a template"


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
    return parse_structure(read_text(Path(path), "structure"), str(path), default_name(path), registry)


def default_name(path: str | Path) -> str:
    """Return the name of a structure whose file gives none: that of the file."""
    return one_line(Path(path).stem).strip() or "structure"


def parse_structure(
    text: str, file: str, default_name: str, registry: Registry | None = None, **more: Any
) -> Mechanism:
    """Read a structure from YAML text; `file` is its name in messages. More arguments and errors: see `of_document`."""
    document = parse(text, file, "structure", TEMPLATE_HINT)
    return of_document(document, default_name, Path(file).parent, registry, **more)


def structure_text(mechanism: StructureFields, *comments: str) -> str:
    """Return the YAML text of a structure with the fields that it was given, below comments of a line each."""
    given = mechanism.model_dump(mode="json", by_alias=True, exclude_unset=True, exclude_none=True)
    return fields_text(mechanism.mechanism, given, comments)


def fields_text(mechanism: str, fields: Mapping[str, Any], above: Sequence[str], below: Sequence[str] = ()) -> str:
    """Return the YAML text of the fields of a mechanism, between comments of a line each above and below."""
    lines = [line for key, value in {"mechanism": mechanism, **fields}.items() for line in block(key, value)]
    above, below = ([f"# {one_line(each)}" for each in comments] for comments in (above, below))
    return "\n".join([*above, *lines, *below, ""])


def of_document(
    document: Document, default_name: str, folder: Path, registry: Registry | None = None, **more: Any
) -> Mechanism:
    """Make a structure from a parsed document whose file names are relative to `folder`. Raises as `load_structure`.

    Further arguments are those of `StructureFields.from_fields`.
    """
    cls = _mechanism(document, registry if registry is not None else Registry())
    fields = {key: value for key, value in document.data.items() if key != "mechanism"}
    if cls is not None:
        try:
            name = fields.get("name", default_name) or default_name
            mechanism = cls.from_fields({**fields, "name": name}, folder, **more)
        except ValidationError as error:
            lister = f"`rocking mechanisms {cls.mechanism}` lists the fields"
            errors = error.errors(include_url=False)
            document.problems += problems(document, cls, errors, owner=cls.mechanism, lister=lister)
    document.check()
    return mechanism


def _mechanism(document: Document, registry: Registry) -> type[Mechanism] | None:
    """Return the class of the mechanism that the file names; None, and a problem added, if it does not exist."""
    data = document.data
    if "mechanism" not in data:
        known = ", ".join(registry)
        similar = get_close_matches("mechanism", list(data), n=1)
        hint = (
            f"did you mean mechanism instead of {similar[0]}?"
            if similar
            else "this describes a building: `rocking building` takes it"
            if "walls" in data or "pareti" in data
            else f"add a line `mechanism: NAME`; known: {known}"
        )
        document.problems.append(document.problem("is missing", document.values[()], "mechanism", hint))
        return None
    name, mark = data["mechanism"], document.values[("mechanism",)]
    if not isinstance(name, str) or name not in registry:
        guess = registry.meant(str(name))
        document.problems.append(document.problem(f"unknown mechanism {cut(repr(name))}", mark, "mechanism", guess))
        return None
    return registry[name]
