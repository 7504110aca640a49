"""The equivalent single rocking block, as people and programs read it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees
from typing import Any

from rocking_cli.core import Equivalence, EquivalentBlock, Mechanism
from rocking_cli.core.advice import preferred_kappa
from rocking_cli.core.restitution import why_none
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.views.parameters import PARAMETERS, values
from rocking_cli.views.view import Table, View, heading, number


def view(mechanism: Mechanism, equivalence: Equivalence) -> View:
    """The parameters of both directions, in one column where they agree, and which kappa to prefer."""
    shown = [(name, values(block), preferred_kappa(block)) for name, block in _blocks(equivalence)]
    data = {
        "mechanism": mechanism.mechanism,
        "name": mechanism.name,
        "gravity": mechanism.gravity,
        "symmetric": equivalence.symmetric,
        "per_unit_mass": not mechanism.has_mass,
        "restitution": "given" if mechanism.restitution is not None else "kinematics",
        "caution": mechanism.caution or None,
        "directions": {
            name: {**block, "prefer": advice.prefer, "lambda_ratio": advice.ratio} for name, block, advice in shown
        },
    }
    if equivalence.symmetric:
        shown = [("value", *shown[0][1:])]
    per_mass = "" if mechanism.has_mass else ", per unit mass"
    rows = [
        [
            each.key,
            *(number(block[each.key]) for _, block, _ in shown),
            each.unit_of(mass=mechanism.has_mass),
            each.short + (per_mass if each.of_mass else ""),
        ]
        for each in PARAMETERS
    ]
    columns = ["", *(name for name, _, _ in shown), "unit", "meaning"]
    table = Table(heading(mechanism), columns, rows, numbers=range(1, len(shown) + 1))
    said = [
        f"{where}critical rotation {degrees(block['phi_cr']):.4g} deg. {advice.why}"
        for where, (_, block, advice) in zip(_where(equivalence), shown, strict=False)
    ]
    said.append(
        "The rotation phi of the structure is kappa times the rotation theta of its equivalent block; either kappa "
        "keeps the critical rotation. How alike they move depends on how far: `rocking error` compares free periods "
        "and overturning times, `rocking respond` motions."
    )
    said += [f"Caution: {mechanism.caution}"] if mechanism.caution else []
    return View(data, [table, *said])


def table(found: Sequence[tuple[Mechanism, Equivalence]]) -> dict[str, list[Any]]:
    """The columns of several structures, a row for each direction."""
    rows: list[list[Any]] = []
    for mechanism, equivalence in found:
        for name, block in _blocks(equivalence):
            per_mass = "no" if mechanism.has_mass else "yes"
            rows.append([mechanism.name, mechanism.mechanism, name, *values(block).values(), per_mass])
    units = [f"{each.key} [{each.unit}]" if each.unit else each.key for each in PARAMETERS]
    names = ["name", "mechanism", "direction", *units, "per unit mass"]
    return {name: [row[k] for row in rows] for k, name in enumerate(names)}


def warnings(mechanism: Mechanism, equivalence: Equivalence) -> Iterator[str]:
    """What to be careful about in the parameters."""
    for name, block in _blocks(equivalence)[: 1 if equivalence.symmetric else 2]:
        if block.eta <= 0:
            way = "" if equivalence.symmetric else f" ending {name} motion"
            yield (
                f"{mechanism.name}: the kinematics give eta = {block.eta:.4g}{way}: {why_none(block.eta)}; "
                "histories need a measured restitution in the file"
            )


def notes(mechanism: Mechanism) -> Iterator[str]:
    """What to know of the parameters."""
    if mechanism.gravity != STANDARD_GRAVITY:
        yield (
            f"{mechanism.name}: lambda is over its own gravity of {mechanism.gravity:g} m/s2; records and PGA are in "
            f"standard gravity, {STANDARD_GRAVITY} m/s2"
        )


def _where(equivalence: Equivalence) -> tuple[str, ...]:
    """What a sentence on each direction begins with."""
    return ("",) if equivalence.symmetric else ("positive: ", "negative: ")


def _blocks(equivalence: Equivalence) -> tuple[tuple[str, EquivalentBlock], tuple[str, EquivalentBlock]]:
    return ("positive", equivalence.positive), ("negative", equivalence.negative)
