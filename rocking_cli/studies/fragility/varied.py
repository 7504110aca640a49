"""Distributions with units, such as `width: {uniform: {low: 800 mm, high: 1 m}}`, converted to units of fields."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.errors import Problem, RockingError
from rocking_cli.io.yaml_file import Document, Place
from rocking_cli.structure_file import load_structure
from rocking_cli.units import UnitError, read, split

PURE = ("dispersion",)  # what a distribution is given by and has no unit


def in_units_of_fields(document: Document, folder: Path) -> list[Problem]:
    """Convert texts with units in the distributions of a study to numbers; return the problems with them.

    Parameters
    ----------
    document : Document
        The study; its data are changed. Values that are not texts with a unit stay as they are.
    folder : Path
        The folder of the study.
    """
    entries = document.data.get("structures")
    found: list[Problem] = []
    for k, entry in enumerate(entries if isinstance(entries, list) else []):
        varied = entry.get("vary") if isinstance(entry, dict) else None
        if not isinstance(varied, dict) or not isinstance(entry.get("file"), str):
            continue
        structure: Mechanism | None = None
        for name, distribution in varied.items():
            if not _has_units(distribution):
                continue
            try:
                structure = structure or load_structure(folder / entry["file"])
            except RockingError:  # the study says so for itself
                break
            info = type(structure).model_fields.get(name)
            extra = info.json_schema_extra if info is not None else None
            unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
            varied[name] = _numbers(document, distribution, unit, ("structures", k, "vary", name), found)
    return found


def _has_units(value: Any) -> bool:
    if isinstance(value, dict | list):
        return any(_has_units(each) for each in (value.values() if isinstance(value, dict) else value))
    parts = split(value) if isinstance(value, str) else None
    return parts is not None and bool(parts[1])


def _numbers(document: Document, value: Any, unit: str, place: Place, problems: list[Problem]) -> Any:
    if isinstance(value, dict):
        return {key: _numbers(document, each, unit, (*place, key), problems) for key, each in value.items()}
    if isinstance(value, list):
        return [_numbers(document, each, unit, (*place, k), problems) for k, each in enumerate(value)]
    if not _has_units(value):
        return value
    try:
        return read(value, "" if place[-1] in PURE else unit)
    except UnitError as error:
        problems.append(document.at(place, error.message, error.hint))
        return value
