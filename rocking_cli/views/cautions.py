"""Cautions on the results of a structure: on what starts before it rocks, on its restitution, and of its mechanism."""

from __future__ import annotations

from math import isclose
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.core.bounds import Bound
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.equivalence import EQUAL_DIRECTIONS
from rocking_cli.core.mechanism import why_none
from rocking_cli.dynamics.resting import MAX_FRICTION, early_failures, glued
from rocking_cli.dynamics.sliding import sliding_of
from rocking_cli.errors import named
from rocking_cli.names import digits_apart, percent
from rocking_cli.views.sheet.language import ENGLISH, Language
from rocking_cli.views.verdict import SENSE

OPENING_CAUTION = (
    "lambda and what follows from it are unconservative: describe the structure so that this joint can move"
)
STOCKY_ETA = 0.7  # restitution from kinematics of a block that is twice as high as wide: 1 - 1.5 sin^2(alpha)
SLIDING_CAUTION = "Stronger motions move it by sliding, which is not modelled: prevent this, for instance by dowels"
ONLY_SLIDES = "Stronger motions make it slide and not rock: time histories give the slip"
NEAR_FRICTION = 0.2  # relative difference of friction from that which decides, up to which there is a caution


def cautions_of(mechanism: Mechanism, say: Language = ENGLISH) -> list[str]:
    """Return all cautions on a structure; those on what starts before it rocks come first."""
    limits = mechanism.friction is not None or mechanism.strength is not None or bool(mechanism.attached)
    # A body on its foot neither slides nor opens before it rocks: that need not be computed of each row of a table.
    early = limits or len(mechanism.bodies()) > 1
    cautions = [*before_rocking(mechanism), *of_friction(mechanism)] if early else []
    cautions += [*of_restitution(mechanism), *of_bounds(mechanism), *mechanism.cautions()]
    return [in_language(mechanism.mechanism, mechanism.caution, each, say) for each in cautions]


def in_language(mechanism: str, of_all: str, caution: str, say: Language) -> str:
    """Return a caution in a language; `of_all` is that on all structures of the mechanism."""
    return say.caution(mechanism, caution) if caution == of_all else say.recognised("caution", caution)


def of_bounds(mechanism: Mechanism) -> list[str]:
    """Return what happens at the bound of each direction, beyond which its motion is not known, in words."""
    return [
        f"{SENSE[direction].capitalize()}, {bound.words}: "
        + (
            "time histories are unknown from there on."
            if bound.restitution is None
            else f"it is thrown back with {bound.restitution:g} times its rate."
        )
        for direction, bound in mechanism.bounds.items()
        if bound is not None
    ]


def bound_data(bound: Bound) -> dict[str, Any]:
    """Return the bound of a direction as plain data; the point is that which meets a stop."""
    at = [bound.at.real, bound.at.imag] if bound.at else None
    return bound._asdict() | {"body": bound.body or None, "at": at, "direction": bound.direction.label}


def of_restitution(mechanism: Mechanism) -> list[str]:
    """Return what is odd about the restitution of a structure, in words: 0 or less, above 1, or that of a stocky body.

    Above 1 it may be right if the mechanisms of the two directions differ: a light part may turn faster after the
    impact than all did before, and the ratio of the energies never exceeds 1.
    """
    cautions = _of_stocky(mechanism)
    if not mechanism.rocks_both_ways:
        return cautions
    etas = {direction: mechanism.eta(direction) for direction in mechanism.directions}
    one = isclose(*etas.values(), rel_tol=EQUAL_DIRECTIONS)
    for direction, eta in list(etas.items())[: 1 if one else 2]:
        at = "at impacts" if one else f"at impacts that end motion in the {direction.label} direction"
        if eta <= 0:
            why = f"{why_none(eta)}. Time histories require a measured {named('restitution')}"
            cautions.append(f"The kinematics give eta = {eta:.4g} {at}: {why}.")
        elif eta > 1 + EQUAL_DIRECTIONS:
            kept = 100 * (eta / mechanism.greatest_restitution(direction)) ** 2
            cautions.append(
                f"The eta of {eta:.4g} {at} compares the rates of two different mechanisms: such an impact keeps "
                f"{kept:.3g} % of the kinetic energy."
            )
    return cautions


def _of_stocky(mechanism: Mechanism) -> list[str]:
    """Return a caution on a single body so stocky that it bounces, see Lipscombe and Pellegrino (1993)."""
    if len(mechanism.bodies()) > 1:
        return []
    eta = min(map(mechanism.restitution_from_kinematics, mechanism.directions))
    if not eta < STOCKY_ETA * (1 - EQUAL_DIRECTIONS):
        return []
    return [
        f"It is stocky: its kinematics give eta = {eta:.3g}, below {STOCKY_ETA:g} as for a block lower than twice its "
        "width. Tests of such bodies found bouncing and losses that the model does not have (Lipscombe and Pellegrino "
        "1993)."
    ]


def of_friction(mechanism: Mechanism) -> list[str]:
    """Return that the friction of a body is close to that at which it may rock, in words."""
    sliding = sliding_of(mechanism)
    if sliding is None or abs(sliding.friction / (decides := sliding.friction_to_rock) - 1) > NEAR_FRICTION:
        return []
    return [
        f"The friction of {sliding.friction:.4g} is within {percent(NEAR_FRICTION)} of {decides:.4g}, up to which the "
        "structure only slides, and above which it may rock. Neighbours do not vary friction: vary it yourself."
    ]


def before_rocking(mechanism: Mechanism) -> list[str]:
    """Return which joint slides or opens at rest before the structure rocks, in which direction, and what to do."""
    joints: dict[tuple[str, str], list[str]] = {}
    sliding = sliding_of(mechanism)
    only_slides = sliding is not None and sliding.friction <= sliding.friction_to_rock
    for direction, failure, lambda_ in early_failures(mechanism):
        push = failure.push / mechanism.gravity
        does = f"the joint between {failure.joint} {'slides' if failure.slides else 'opens'} from"
        if lambda_ is None:
            first = "What props the structure is pushed back"
            what = f"{does} {push:.4g} g. Beyond it the structure loses that support: no result is valid there"
        else:
            digits = digits_apart(push, lambda_, 4)
            what = f"at rest {does} {push:.{digits}g} g, below lambda = {lambda_:.{digits}g}. "
            first = "Another mechanism starts first" if failure.opens else "The structure slides before it rocks"
            what += OPENING_CAUTION if failure.opens else ONLY_SLIDES if only_slides else SLIDING_CAUTION
        joints.setdefault((first, what), []).append(direction.label)
    early = [
        f"{first} in {'both directions' if len(labels) > 1 else f'the {labels[0]} direction'}: {what}."
        for (first, what), labels in joints.items()
    ]
    return [*early, *_of_glue(mechanism)]


def _of_glue(mechanism: Mechanism) -> list[str]:
    """Return what friction joints without any given need, and when the structure starts with the usual one."""
    sides = glued(mechanism)
    if not sides:
        return []
    needed = [f"more than {MAX_FRICTION:g}" if each.needed is None else f"{each.needed:.3g}" for each in sides]
    starts = [f"{each.failure.push / mechanism.gravity:.4g} g instead of {each.lambda_:.4g} g" for each in sides]
    needs, would = (
        " and ".join(f"{text} in the {each.direction.label} direction" for text, each in zip(texts, sides, strict=True))
        for texts in (needed, starts)
    )
    return [
        "Joints without `friction` never slide and may carry shear without a normal force, which raises lambda. They "
        f"need a friction of {needs}. With a friction of {MASONRY_FRICTION:g} it would be {would}: give `friction`."
    ]
