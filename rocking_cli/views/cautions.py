"""Cautions on the results of a structure: what starts before it rocks, its restitution, and those of its mechanism."""

from __future__ import annotations

from math import isclose

from rocking_cli.core import Mechanism
from rocking_cli.core.equivalence import AGREEMENT
from rocking_cli.core.restitution import why_none
from rocking_cli.dynamics.resting import early_failures


def cautions_of(mechanism: Mechanism) -> list[str]:
    """Return all cautions on a structure, what starts before it rocks first."""
    return [*before_rocking(mechanism), *of_restitution(mechanism), *mechanism.cautions()]


def of_restitution(mechanism: Mechanism) -> list[str]:
    """Return what is odd about the restitution of a structure, in words: 0 or less, or above 1.

    Above 1 it may be right if the mechanisms of the two directions differ: a light part may turn faster after the
    impact than all did before, and the ratio of the energies never exceeds 1.
    """
    if not mechanism.rocks_both_ways:
        return []
    found: list[str] = []
    etas = {direction: mechanism.eta(direction) for direction in mechanism.directions}
    one = isclose(*etas.values(), rel_tol=AGREEMENT)
    for direction, eta in list(etas.items())[: 1 if one else 2]:
        at = "at impacts" if one else f"at impacts that end motion in the {direction.label} direction"
        if eta <= 0:
            why = f"{why_none(eta)}. Time histories require a measured `restitution`"
            found.append(f"The kinematics give eta = {eta:.4g} {at}: {why}.")
        elif eta > 1 + AGREEMENT:
            kept = 100 * (eta / mechanism.greatest_restitution(direction)) ** 2
            found.append(
                f"The eta of {eta:.4g} {at} compares the rates of two different mechanisms: such an impact keeps "
                f"{kept:.3g} % of the kinetic energy."
            )
    return found


def before_rocking(mechanism: Mechanism) -> list[str]:
    """Return which joint slides or opens at rest before the structure rocks, in words, a sentence a direction."""
    found: list[str] = []
    for direction, failure, lambda_ in early_failures(mechanism):
        push = failure.push / mechanism.gravity
        does = f"the joint between {failure.joint} {'slides' if failure.slides else 'opens'} from {push:.4g} g"
        if lambda_ is None:
            found.append(f"What props the structure is pushed back in the {direction.label} direction: {does}.")
        else:
            first = "Another mechanism starts first" if failure.opens else "The structure slides before it rocks"
            found.append(f"{first}: at rest {does}, below lambda = {lambda_:.4g}.")
    return list(dict.fromkeys(found))
