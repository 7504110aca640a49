"""View of the equivalent single rocking block, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, isclose, nan
from operator import itemgetter, methodcaller
from typing import Any, NamedTuple

from rocking_cli.core import Direction, EquivalentBlock, Mechanism, PointMass, Statics, one_block
from rocking_cli.core.bounds import Bound
from rocking_cli.core.equivalence import EQUAL_DIRECTIONS, Grade, alike, grade, preferred_kappa
from rocking_cli.core.hung.element import Element
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.structure import Structure
from rocking_cli.views.cautions import before_rocking, bound_data, cautions_of, of_bounds, of_restitution
from rocking_cli.views.column import UNIT, Column, data_of, of, only_shown, table_across
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.verdict import uplift_in_words
from rocking_cli.views.view import ASIDE, Aside, View, heading, number

KAPPAS = (
    "The rotation phi of the structure is kappa times the rotation theta of its equivalent block; both kappas preserve "
    "the critical rotation. How closely the block follows the structure depends on the amplitude: compare free periods "
    "and overturning times with `rocking error`, and time histories with `rocking respond`."
)


@dataclass(frozen=True)
class Parameter(Column[EquivalentBlock]):
    """A parameter of the equivalent block of one direction; its words are for readers of the paper.

    Parameters
    ----------
    symbol : str
        Symbol in print; an underscore starts a subscript.
    meaning : str
        Description for a reader who does not know the parameter.
    """

    key: str
    symbol: str = ""
    meaning: str = ""

    def unit_of(self, *, mass: bool) -> str:
        """Return the unit for a structure with or without masses."""
        return self.unit if mass else self.unit.removeprefix("kg ")


def _parameter(key: str, unit: str, symbol: str, words: str, meaning: str) -> Parameter:
    attribute = key if key != "lambda" else "lambda_"
    return Parameter(key, of(attribute), unit, words=words, symbol=symbol, meaning=meaning)


PARAMETERS = (
    _parameter("p", "rad/s", "p", "frequency parameter: small for large structures",
               "Frequency parameter. Near φ_cr the rotation grows as exp(p t) with time t. Large structures have a "
               "small p."),
    _parameter("phi_cr", "rad", "φ_cr", "critical rotation: unstable equilibrium",
               "Critical rotation. The structure is in unstable equilibrium there; beyond it, its weight overturns "
               "it."),
    _parameter("lambda", "g", "λ", "ground acceleration at uplift",
               "Uplift acceleration. A steady ground acceleration above λ times the structure's gravity g causes "
               "uplift."),
    _parameter("lambda_lin", "g", "λ_lin", "uplift acceleration of the linearised mechanism",
               "Uplift acceleration of the linearised mechanism. If it differs much from λ, the structure is not "
               "slender."),
    _parameter("kappa1", "", "κ₁", "phi/theta that keeps lambda_lin",
               "Scaling φ = κ₁ θ from the rotation θ of the equivalent block to φ of the structure, chosen to keep "
               "λ_lin."),
    _parameter("kappa2", "", "κ₂", "phi/theta that keeps lambda",
               "Scaling φ = κ₂ θ from the rotation θ of the equivalent block to φ, chosen to keep λ, the true uplift "
               "acceleration."),
    _parameter("theta_cr1", "rad", "θ_cr,1", "critical rotation of the block, kappa1",
               "Critical rotation of the equivalent block with κ₁: φ_cr/κ₁."),
    _parameter("theta_cr2", "rad", "θ_cr,2", "critical rotation of the block, kappa2",
               "Critical rotation of the equivalent block with κ₂: φ_cr/κ₂."),
    _parameter("eta", "", "η", "restitution when motion in this direction ends",
               "Coefficient of restitution: rate of rotation just after an impact that ends motion in this "
               "direction, over the rate just before."),
    _parameter("v_imp", "m/s", "v_imp", "ground velocity step that just overturns it",
               "Velocity step of the ground that just overturns the structure from rest, without linearisation."),
    _parameter("I_eq", "kg m2", "I_eq", "linearised inertia",
               "Moment of inertia of the mechanism at φ_cr."),
    _parameter("G_eq", "kg m", "G_eq", "linearised restoring moment over g",
               "Rate at which the restoring moment over g decreases with rotation at φ_cr."),
    _parameter("B_eq", "kg m", "B_eq", "linearised drive of the ground",
               "Moment by which the ground drives the mechanism at φ_cr, over its acceleration."),
)  # fmt: skip


def view(structure: Structure) -> View:
    """Show the parameters of both directions, in one column if they agree, and which kappa to prefer."""
    mechanism, sides = structure.mechanism, sides_of(structure)
    data = {
        "mechanism": mechanism.mechanism,
        "name": mechanism.name,
        "gravity": mechanism.gravity,
        "symmetric": is_symmetric(structure),
        "one_sided": mechanism.one_sided,
        "hung": hung_data(mechanism),
        "per_unit_mass": not mechanism.has_mass,
        "restitution": structure.restitution_source,
        "caution": " ".join(cautions_of(mechanism)) or None,
        "misleading": structure.misleading,
        "directions": {
            side.direction.label: _data(side, mechanism.bounds[side.direction]) | _extras(mechanism, side.direction)
            for side in sides
        },
    }
    shown = sides[:1] if is_symmetric(structure) else sides
    columns = _columns(mechanism, [side.direction for side in shown])
    heads = ["value"] if len(shown) == 1 else [side.direction.label for side in shown]
    rows = [side.parameters | _extras(mechanism, side.direction) for side in shown]
    table = table_across("", columns, heads, rows, {**UNIT, "meaning": of("words")})
    table = replace(table, ranks=[*table.ranks[:-1], ASIDE])
    labels = [f"{side.direction.label} direction" for side in shown]
    where = [f"{heading(mechanism)}, {labels[0]}", labels[-1].capitalize()] if shown[1:] else [heading(mechanism)]
    first = [f"{place}. {sentence(side)}" for place, side in zip(where, shown, strict=True)]
    first += [f"Caution: {text}" for text in before_rocking(mechanism)]
    sentences: list[str] = [] if structure.why_no_block else [Aside(KAPPAS)]
    sentences += [f"Caution: {structure.misleading}."] if structure.misleading else []
    sentences += [*hung_in_words(mechanism), *([] if mechanism.rocks_both_ways else [restitution_used(structure)])]
    sentences += [f"P{mechanism.crushing.words[1:]}."] if mechanism.crushing else []
    sentences += [
        f"Caution: {text}" for text in (*of_restitution(mechanism), *of_bounds(mechanism), *mechanism.cautions())
    ]
    return View(data, [*first, table, *sentences])


def _columns(mechanism: Mechanism, directions: Sequence[Direction]) -> Iterator[Column[Mapping[str, float]]]:
    """Yield the parameters, and the values that a mechanism found itself, which may differ between directions."""
    per_mass = "" if mechanism.has_mass else ", per unit mass"
    for each in PARAMETERS:
        words = each.words + (per_mass if each.unit.startswith("kg ") else "")
        how = {"words": words, "rank": ASIDE * each.key.endswith("_eq")}
        yield only_shown(each.key, itemgetter(each.key), number, each.unit_of(mass=mechanism.has_mass), **how)
    parameters = {direction: {each.key: each for each in mechanism.found(direction)} for direction in directions}
    for key in dict.fromkeys(key for those in parameters.values() for key in those):
        meanings = {direction: those[key].meaning for direction, those in parameters.items() if key in those}
        same = len(set(meanings.values())) == 1
        words = "; ".join(
            dict.fromkeys(meaning if same else f"{d.label}: {meaning}" for d, meaning in meanings.items())
        )
        unit = next(those[key].unit for those in parameters.values() if key in those)
        yield only_shown(key, methodcaller("get", key), number, unit, words=words)


def _extras(mechanism: Mechanism, direction: Direction) -> dict[str, float]:
    return {each.key: each.value for each in mechanism.found(direction)}


class EquivalentSide(NamedTuple):
    """A direction of rocking: its statics, its equivalent block (None if there is none), and its restitution."""

    direction: Direction
    statics: Statics
    block: EquivalentBlock | None
    eta: float

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters by key; without an equivalent block, NaN for those that require one."""
        if self.block is not None:
            return data_of(PARAMETERS, self.block)
        known = {"lambda": self.statics.lambda_, "eta": self.eta}
        if self.statics.phi_cr is not None:
            known["phi_cr"] = self.statics.phi_cr
        return {each.key: known.get(each.key, nan) for each in PARAMETERS}


def sides_of(structure: Structure) -> list[EquivalentSide]:
    """Return the directions in which a structure can rock, with their statics and blocks."""
    sides = []
    for direction in structure.mechanism.directions:
        k = 0 if direction > 0 else 1
        statics = structure.statics[k]
        block = structure.equivalence[direction] if structure.why_no_block is None else None
        if block is None and statics.why_no_block is None:  # the other direction has no block
            block = one_block(structure.mechanism, direction, statics)
        sides.append(EquivalentSide(direction, statics, block, structure.etas[k]))
    return sides


def is_symmetric(structure: Structure) -> bool:
    """Return whether one column is enough for both directions."""
    if structure.why_no_block is None:
        return structure.equivalence.symmetric
    return alike(*structure.statics) and isclose(*structure.etas, rel_tol=EQUAL_DIRECTIONS)


def _data(side: EquivalentSide, bound: Bound | None) -> dict[str, Any]:
    """Return the parameters of a direction as plain data; null if there is no equivalent block, or no bound."""
    block = side.block
    return {
        **side.parameters,
        "prefer": preferred_kappa(block) if block is not None else None,
        "lambda_ratio": block.lambda_lin / block.lambda_ if block is not None else None,
        "stiffening": side.statics.stiffening,
        "limit": side.statics.limit,
        "no_block": side.statics.why_no_block,
        "bound": bound_data(bound) if bound is not None else None,
    }


def kappa_in_words(block: EquivalentBlock) -> str:
    """Return a sentence on which kappa to prefer for a block, by its uplift acceleration alone."""
    ratio = block.lambda_lin / block.lambda_
    if preferred_kappa(block) == "either":
        text = "Effectively slender, either kappa is adequate"
    else:
        text = "Disregard kappa1" if grade(ratio - 1) is Grade.DISREGARD else "By the uplift prefer kappa2"
    return (
        f"{text}: with kappa1 the uplift acceleration is {uplift_in_words(ratio - 1)} (lambda_lin/lambda = "
        f"{ratio:.4g}), with kappa2 it is kept."
    )


def sentence(side: EquivalentSide) -> str:
    """Return what the block of a direction means, and which kappa to prefer; without a block, why there is none."""
    if (block := side.block) is not None:
        known = f"Uplift at {block.lambda_:.4g} g, critical rotation {degrees(block.phi_cr):.4g} deg"
        return f"{known}, p = {block.p:.4g} rad/s. {kappa_in_words(block)}"
    statics = side.statics
    grows = "increases" if statics.stiffening > 0 else "decreases"
    ends = (
        "a motion is known until the tie yields"
        if statics.yields is not None
        else f"a motion can end only at the kinematic limit of {statics.limit:.4g} rad"
        if statics.phi_cr is None
        else f"the moment first vanishes at {statics.phi_cr:.4g} rad"
    )
    return (
        f"The structure has no equivalent single block: {statics.why_no_block}. It uplifts at {statics.lambda_:.4g} "
        f"g; its restoring moment then {grows} by {abs(statics.stiffening):.4g} times its initial value per rad; "
        f"{ends}. Nonlinear time histories are available; linear models, closed forms and maps in terms of p are not."
    )


def table(found: Sequence[Structure]) -> dict[str, list[Any]]:
    """Return a table of several structures, with a row for each direction."""
    rows = [(structure.mechanism, side, side.parameters) for structure in found for side in sides_of(structure)]
    return {
        "structure": [mechanism.name for mechanism, _, _ in rows],
        "mechanism": [mechanism.mechanism for mechanism, _, _ in rows],
        "direction": [side.direction.label for _, side, _ in rows],
        **{each.heading: [parameters[each.key] for _, _, parameters in rows] for each in PARAMETERS},
        "per unit mass": ["no" if mechanism.has_mass else "yes" for mechanism, _, _ in rows],
    }


def notes(mechanism: Mechanism) -> Iterator[str]:
    """Yield notes on how to read the parameters."""
    if mechanism.gravity != STANDARD_GRAVITY:
        yield (
            f"{mechanism.name}: lambda is relative to the structure's own gravity of {mechanism.gravity:g} m/s2; "
            f"records and PGA use standard gravity, {STANDARD_GRAVITY} m/s2"
        )


def hung_data(mechanism: Mechanism) -> list[dict[str, Any]]:
    """Return each load, force and tie as plain data, with its position at rest and its numbers, in SI units."""
    return [
        {
            "name": attachment.name,
            **(
                attachment.as_dict()
                if isinstance(attachment, PointMass | Element)
                else {"kind": type(attachment).__name__}
            ),
        }
        for attachment in mechanism.attached
    ]


def hung_in_words(mechanism: Mechanism) -> Iterator[str]:
    """Yield a sentence that lists the loads and ties of a structure, if it has any."""
    other = "its contribution to the equation of motion"
    listed = [
        f"{attachment.name}: {attachment.words if isinstance(attachment, PointMass | Element) else other}"
        for attachment in mechanism.attached
    ]
    if listed:
        yield f"With {'; '.join(listed)}."
