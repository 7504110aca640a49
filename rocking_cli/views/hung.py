"""The loads and ties of a structure, as sentences and as data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.core.attached import Attached, ConstantForce, PointMass, Spot, Spring, SpringBed


def hung_data(mechanism: Mechanism) -> list[dict[str, Any]]:
    """Each load, force and tie with its place at rest and its numbers, in SI units."""
    return [{"name": thing.name, **_data(thing)} for thing in mechanism.attached]


def hung_in_words(mechanism: Mechanism) -> Iterator[str]:
    """Yield a sentence that lists the loads and ties of a structure, if it has any."""
    if mechanism.attached:
        yield f"With {'; '.join(f'{thing.name}: {_words(thing)}' for thing in mechanism.attached)}."


def _data(thing: Attached) -> dict[str, Any]:
    if isinstance(thing, PointMass):
        shares = {"horizontal": thing.horizontal, "vertical": thing.vertical, "weight": thing.weight}
        return {"kind": "load", **_place(thing.spot), "mass": thing.mass, **shares}
    if isinstance(thing, ConstantForce):
        kind = "friction" if thing.friction else "force"
        return {"kind": kind, **_place(thing.spot), "force": [thing.force.real, thing.force.imag]}
    if isinstance(thing, Spring):
        path = [_place(spot) for spot in thing.spots]
        strength = {"stiffness": thing.stiffness, "prestress": thing.prestress, "only": thing.only}
        return {"kind": "tie", "path": path, **strength, "count": thing.count}
    if isinstance(thing, SpringBed):
        return {"kind": "bed", "path": [_place(thing.start), _place(thing.end)], "modulus": thing.modulus}
    return {"kind": type(thing).__name__}


def _place(spot: Spot) -> dict[str, Any]:
    return {"body": spot.body, "at": [spot.at.real, spot.at.imag]}


def _words(thing: Attached) -> str:
    if isinstance(thing, PointMass):
        shares = thing.horizontal, thing.vertical, thing.weight
        if shares == (1, 1, 1):
            return f"{thing.mass:.4g} kg"
        sideways, up, borne = (f"{share:.3g}" for share in shares)
        return (
            f"{thing.mass:.4g} kg (share moved sideways {sideways}, share moved vertically {up}, share carried {borne})"
        )
    if isinstance(thing, ConstantForce):
        if thing.friction:
            at = f"at y = {thing.spot.at.imag:.4g} m"
            return f"a constant friction of {abs(thing.force) / 1000:.4g} kN against the motion {at}"
        return f"a force of {thing.force.real / 1000:.4g} kN to the right and {thing.force.imag / 1000:.4g} kN up"
    if isinstance(thing, Spring):
        sense = f", {thing.only} only" if thing.only else ""
        force = f", {thing.prestress / 1000:.4g} kN at rest" if thing.prestress else ""
        many = f"{thing.count:g} ties, each" if thing.count != 1 else "a tie of"
        return f"{many} {thing.stiffness / 1000:.4g} kN/m{force}{sense}"
    if isinstance(thing, SpringBed):
        return f"springs of {thing.modulus / 1000:.4g} kN/m per metre of its face"
    return "its contribution to the equation of motion"
