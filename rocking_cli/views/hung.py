"""The loads and ties of a structure, as sentences and as data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rocking_cli.core import Attached, Mechanism, PointMass
from rocking_cli.core.hung.element import Element


def hung_data(mechanism: Mechanism) -> list[dict[str, Any]]:
    """Return each load, force and tie as plain data, with its position at rest and its numbers, in SI units."""
    return [{"name": thing.name, **_data(thing)} for thing in mechanism.attached]


def hung_in_words(mechanism: Mechanism) -> Iterator[str]:
    """Yield a sentence that lists the loads and ties of a structure, if it has any."""
    if mechanism.attached:
        yield f"With {'; '.join(f'{thing.name}: {_words(thing)}' for thing in mechanism.attached)}."


def _data(thing: Attached) -> dict[str, Any]:
    return thing.as_dict() if isinstance(thing, PointMass | Element) else {"kind": type(thing).__name__}


def _words(thing: Attached) -> str:
    return thing.words if isinstance(thing, PointMass | Element) else "its contribution to the equation of motion"
