"""Cautions on the results of a structure: what starts before it rocks, and those of its mechanism."""

from __future__ import annotations

from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.equivalence import AGREEMENT
from rocking_cli.dynamics.resting import first_failure, resting


def cautions_of(mechanism: Mechanism) -> list[str]:
    """Return all cautions on a structure, what starts before it rocks first."""
    return [*before_rocking(mechanism), *mechanism.cautions()]


def before_rocking(mechanism: Mechanism) -> list[str]:
    """Return which joint slides or opens at rest before the structure rocks, in words, a sentence a direction."""
    found: list[str] = []
    still, g = resting(mechanism), mechanism.gravity
    for direction in Direction if mechanism.propped else mechanism.directions:
        failure = first_failure(still, direction)
        if failure is None:
            continue
        does = (
            f"the joint between {failure.joint} {'slides' if failure.slides else 'opens'} from {failure.push / g:.4g} g"
        )
        if direction not in mechanism.directions:
            found.append(f"What props the structure is pushed back in the {direction.label} direction: {does}.")
        elif failure.push < (1 - AGREEMENT) * (lambda_ := mechanism.uplift(direction)) * g:
            first = "Another mechanism starts first" if failure.opens else "The structure slides before it rocks"
            found.append(f"{first}: at rest {does}, below lambda = {lambda_:.4g}.")
    return list(dict.fromkeys(found))
