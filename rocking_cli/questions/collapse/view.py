"""View of the weakest mechanism of an assembly, as text and as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, isclose
from operator import itemgetter
from typing import Any

from rocking_cli.core import CollapseHinge, CollapseMechanism, Direction, Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.names import digits_apart
from rocking_cli.text import in_short
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, rounded, table_of
from rocking_cli.views.view import Aside, Table, View, force_unit, heading, number

MAX_NAMED_BLOCKS = 6  # blocks of a part that are named; of a larger part, only SAMPLE_OF_BLOCKS
SAMPLE_OF_BLOCKS = 3
FRICTION_TOLERANCE = 1e-6  # relative difference within which a mechanism uses all of the given friction
PASSIVE = (
    "Ties of steel have no force before the structure moves: lambda is that without them. `rocking verify` counts "
    "their strength."
)
MAX_JOINT_ROWS = 24  # number of joints up to which all are listed; with more, only those that move


def view(mechanism: Mechanism, found: Mapping[Direction, CollapseMechanism]) -> View:
    """Show lambda, hinges, groups, thrust and friction of each direction."""
    starts = [f"lambda = {number(each.lambda_)} g in the {where.label} direction" for where, each in found.items()]
    parts: list[Table | str] = [f"{heading(mechanism)}. {'; '.join(starts)}."]
    for direction, each in found.items():
        parts += [_hinges(direction, each), *_sentences(mechanism, each)]
        parts += _thrust(direction, each, *force_unit(mechanism))
    parts += [PASSIVE] if mechanism.hung.bars else []
    parts += [f"Caution: {caution}"] if (caution := mechanism.own_caution()) else []
    theorems = (
        " lambda is both the greatest acceleration that can be carried without tension (static theorem) and the "
        "acceleration at which this mechanism starts (kinematic theorem)."
    )
    parts.append(
        Aside(
            "The forces shown are one equilibrium state with the least friction; where parts remain at rest, or bear "
            "on more joints than hold them, other states exist."
            + (theorems if all(each.associated is None for each in found.values()) else "")
        )
    )
    return View(
        lambda: {
            "directions": {d.label: data(each) for d, each in found.items()},
            "per_unit_mass": not mechanism.has_mass,
        },
        parts,
    )


def _hinges(direction: Direction, found: CollapseMechanism) -> Table | str:
    title = f"{direction.label.capitalize()} direction"
    if not found.hinges:
        return f"{title}, without hinges."
    return table_of(
        title, _of_hinge(by_joint=any(len(group) > MAX_NAMED_BLOCKS for group in found.groups)), found.hinges
    )


def _part(found: CollapseMechanism, group: Sequence[str]) -> str:
    """Return the name of a group of blocks: all their names, or of many some names and the hinges."""
    if len(group) <= MAX_NAMED_BLOCKS:
        return "+".join(group)
    letters = [each.letter for each in found.hinges if "+".join(group) in each.between]
    on = f", on {'hinge' if len(letters) == 1 else 'hinges'} {', '.join(letters)}" if letters else ""
    return f"{len(group)} blocks ({in_short(group, most=SAMPLE_OF_BLOCKS)}{on})"


def _sentences(mechanism: Mechanism, found: CollapseMechanism) -> list[str]:
    moves = "; ".join(_part(found, group) for group in found.groups)
    sentences = [
        f"Moving parts, each as one body: {moves}." + (f" At rest: {in_short(found.rest)}." if found.rest else "")
    ]
    if found.idle:
        sentences.append(
            "Other mechanisms start at the same acceleration. They are the same motion, in which "
            f"{in_short(found.idle)} may move along at no cost: the one with the fewest moving blocks is shown."
        )
    if found.lead:
        sentences.append(Aside(f"phi is the rotation of {found.lead}."))
    if found.lifted:
        sentences.append(f"Joints that open over their whole length, or slip off: {in_short(found.lifted)}.")
    if found.slides:
        flow = (
            "The flow rule is associated, which overestimates lambda where sliding joints also open."
            if found.associated is None
            else "Sliding joints do not dilate here (non-associated flow), and the confining forces of the sides, "
            "which are not known, are those with the least lambda."
        )
        sentences.append(
            f"The mechanism slides between {in_short(found.slides)}. lambda is the acceleration at which sliding "
            f"starts; no rocking model is available for it. {flow}"
        )
    if found.no_model:
        sentences.append(f"It has no rocking model: {found.no_model}.")
    if found.friction_needed is not None:
        sentences.append(_required(found.friction_needed, mechanism.friction))
    elif found.glued:
        sentences.append(
            f"No coefficient of friction is sufficient: {in_short(found.glued)} would have to carry shear without "
            "compression. Give `friction`: 0 for a joint that carries no shear."
        )
    if found.with_usual is not None:
        same = isclose(found.with_usual, found.lambda_, rel_tol=FRICTION_TOLERANCE)
        sentences.append(
            (Aside if same else str)(
                f"With a coefficient of friction of {MASONRY_FRICTION:g} in joints that are given none, lambda is "
                f"{number(found.with_usual)} g."
            )
        )
    if found.valid_to is not None and found.held_by is not None:
        sentences.append(
            f"In displaced equilibrium (at acceleration G/B), this mechanism is valid up to {number(found.valid_to)} "
            f"rad, where {number(found.held_by, 4)} g holds it and the joint between {found.opens} also opens. "
            "Beyond it joints may open or slide."
        )
    elif found.lead:
        sentences.append(
            "In displaced equilibrium (at acceleration G/B), this mechanism is valid up to its critical rotation."
        )
    return sentences


def _required(needed: float, given: float | None) -> str:
    """Return a sentence on the friction that a mechanism requires, with digits that tell it from the one given."""
    required = "It requires a coefficient of friction of {} in every joint"
    if given is None:
        return f"{required.format(number(needed, 4))}."
    if isclose(needed, given, rel_tol=FRICTION_TOLERANCE):
        return f"{required.format(number(given, 4))}: all that is given."
    return f"{required.format(number(needed, digits_apart(needed, given, 4)))}; {given:g} is given."


def _thrust(direction: Direction, found: CollapseMechanism, per: float, unit: str) -> list[Table | str]:
    """Return a table of the forces in the joints; of many joints only those that hinge or slide."""
    shown, rest = found.thrust, ""
    if len(shown) > MAX_JOINT_ROWS:
        moving = {*(each.joint for each in found.hinges), *found.slides}
        shown = [each for each in shown if each[0] in moving][:MAX_JOINT_ROWS]
        rest = Aside(f"{len(found.thrust)} joints bear; the JSON output has the forces in all of them.")
    if not shown:
        return [rest] if rest else []
    title = f"Joint forces at the onset of the mechanism, {direction.label}"
    forces = table_of(title, _of_joint(per, unit), shown)
    return [replace(forces, asides=range(len(shown))), *([rest] if rest else [])]


def table(found: Mapping[Direction, CollapseMechanism]) -> dict[str, list[Any]]:
    """Return a table with a row for each hinge."""
    rows = [(direction, each, hinge) for direction, each in found.items() for hinge in each.hinges]
    return {
        "direction": [direction.label for direction, _, _ in rows],
        "lambda": [each.lambda_ for _, each, _ in rows],
        **frame_of(_of_hinge(), [hinge for _, _, hinge in rows]),
    }


def _of_hinge(*, by_joint: bool = False) -> list[Column[CollapseHinge]]:
    """Return the columns of a hinge; tables show its joint if groups of blocks have too many names."""

    def between(hinge: CollapseHinge) -> str:
        return hinge.joint if by_joint and hinge.joint else " and ".join(hinge.between)

    return [
        Column("name", of("letter"), head="hinge", name="hinge", text=True),
        Column("between", lambda hinge: list(hinge.between), name=None),
        Column(None, between, head="between", name="between", text=True),
        Column("joint", of("joint"), name=None),
        Column("at", lambda hinge: _pair(hinge.at), name=None),
        Column(None, of("at.real"), "m", "x [m]", number, "x"),
        Column(None, of("at.imag"), "m", "y [m]", number, "y"),
    ]


def _of_joint(per: float = 1.0, unit: str = "N") -> list[Column[tuple[str, complex, complex]]]:
    """Return the columns of the forces in a joint; tables have them in a unit of `per` N."""
    return [
        Column("joint", itemgetter(0), head="joint", text=True),
        Column("at", lambda row: _pair(row[1])),
        only_shown("x [m]", lambda row: row[1].real, number),
        only_shown("y [m]", lambda row: row[1].imag, number),
        Column("force", lambda row: _pair(row[2])),
        only_shown(f"Fx [{unit}]", lambda row: row[2].real / per, rounded(4)),
        only_shown(f"Fy [{unit}]", lambda row: row[2].imag / per, rounded(4)),
    ]


def _pair(point: complex) -> list[float]:
    return [point.real, point.imag]


MECHANISM: tuple[Column[CollapseMechanism], ...] = (
    Column("lambda", of("lambda_")),
    Column("hinges", lambda found: [data_of(_of_hinge(), each) for each in found.hinges]),
    Column("groups", lambda found: [list(group) for group in found.groups]),
    Column("rest", lambda found: list(found.rest)),
    Column("idle", lambda found: list(found.idle)),
    Column("lifted", lambda found: list(found.lifted)),
    Column("slides", lambda found: list(found.slides)),
    Column("glued", lambda found: list(found.glued)),
    Column("lambda_with_usual", of("with_usual")),
    Column("confined", of("confined")),
    Column("lambda_associated", lambda found: None if found.associated == inf else found.associated),
    Column("search_complete", of("complete")),
    Column("no_model", lambda found: found.no_model or None),
    Column("lead", lambda found: found.lead or None),
    Column("friction_needed", of("friction_needed")),
    Column("valid_to", of("valid_to")),
    Column("opens", lambda found: found.opens or None),
    Column("held_by", of("held_by")),
    Column("thrust", lambda found: [data_of(_of_joint(), each) for each in found.thrust]),
)


def data(found: CollapseMechanism) -> dict[str, Any]:
    """Return the mechanism of a direction as plain data."""
    return data_of(MECHANISM, found)
