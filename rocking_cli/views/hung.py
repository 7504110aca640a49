"""The loads and ties of a structure, as sentences and as data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rocking_cli.core import Mechanism, PointMass
from rocking_cli.core.hung.element import Element


def hung_data(mechanism: Mechanism) -> list[dict[str, Any]]:
    """Return each load, force and tie as plain data, with its position at rest and its numbers, in SI units."""
    return [
        {
            "name": thing.name,
            **(thing.as_dict() if isinstance(thing, PointMass | Element) else {"kind": type(thing).__name__}),
        }
        for thing in mechanism.attached
    ]


def hung_in_words(mechanism: Mechanism) -> Iterator[str]:
    """Yield a sentence that lists the loads and ties of a structure, if it has any."""
    other = "its contribution to the equation of motion"
    listed = [
        f"{thing.name}: {thing.words if isinstance(thing, PointMass | Element) else other}"
        for thing in mechanism.attached
    ]
    if listed:
        yield f"With {'; '.join(listed)}."
