"""Check that the fields of a structure fit together; each check raises `RefusedFields` with the field at fault."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.core.coefficients import coefficients
from rocking_cli.core.given import KINEMATIC, NEEDS_A_SIDE, DirectionalRestitution, Strength
from rocking_cli.core.hung.attachments import RefusedFields
from rocking_cli.core.hung.element import Element, Stretched
from rocking_cli.core.kinematics import Direction

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism

ROUNDING = 1e-9  # by which a restitution may exceed its bound, which the kinematic one of equal sides reaches
LOOKED_AT = 129  # rotations at which it is checked whether a tie stretches
STRETCHED = 1e-9  # elongation that counts, over the length of the path of a tie, or over 1 m if it is shorter
NO_MASSES = "the structure has no masses: give density and depth, or its mass"


def check(mechanism: Mechanism) -> None:
    """Refuse a structure whose fields do not fit together."""
    if mechanism.mass is not None and mechanism.density is not None:
        raise RefusedFields((), "mass", "give mass, or density and depth: one of them")
    check_crushed(mechanism)
    check_one_sided(mechanism)
    mechanism.total_mass()  # refuses a density without a volume
    check_strength(mechanism)
    if mechanism.is_laden and not mechanism.has_mass:
        key = "loads" if mechanism.loads else "ties" if mechanism.ties else "interlock"
        raise RefusedFields((), key, NO_MASSES)
    check_restitution(mechanism)
    if mechanism.is_laden:
        check_stretched(mechanism)
        check_stands(mechanism)


def check_crushed(mechanism: Mechanism) -> None:
    """Refuse `crushing` if it moves no joint, or moves joints so far that nothing stands."""
    if mechanism.crushing is None:
        return
    moved = mechanism.moved_inwards
    if not moved:
        reason = "its pivots cannot be moved in this version, only those of single bodies and of walls: leave it out"
        raise RefusedFields((), "crushing", reason)
    for direction in mechanism.directions:
        if not mechanism.coefficients(np.zeros(1), direction).restoring(mechanism.gravity)[0] > 0:
            far = max(moved[direction].values())
            reason = f"the structure cannot stand on what is left: a pivot moves inwards by {far:.4g} m"
            raise RefusedFields((), "crushing", reason)


def check_one_sided(mechanism: Mechanism) -> None:
    """Check that `one_sided`, `rebound` and `restitution` fit together.

    A structure that rocks to both sides has no rebound, and one that rocks to one side only has a rebound and no
    restitution. The rebound may be `kinematic` only if it follows from the shape.
    """
    if mechanism.one_sided is None and mechanism.rebound is not None:
        raise RefusedFields((), "rebound", NEEDS_A_SIDE)
    if mechanism.one_sided is not None and mechanism.restitution is not None:
        raise RefusedFields((), "restitution", "cannot be combined with `one_sided`: give `rebound` instead")
    asked = "rebound" in mechanism.model_fields_set and mechanism.rebound is None
    if mechanism.one_sided is not None and asked and mechanism.rebound_from_impacts() is None:
        why = "only for a plain rectangle does it follow from the shape; give a number in [0, 1)"
        raise RefusedFields((), "rebound", f"cannot be {KINEMATIC}: {why}")


def check_strength(mechanism: Mechanism) -> None:
    """Refuse a contact strength if the structure has no masses or no depth."""
    if not isinstance(mechanism.strength, Strength):  # None, or a field of a plugin of that name
        return
    if not mechanism.has_mass:
        raise RefusedFields((), "strength", NO_MASSES)
    if mechanism.depth is None:
        raise RefusedFields((), "depth", "is missing: the contacts are as long as the structure is deep")


def check_restitution(mechanism: Mechanism) -> None:
    """Refuse a restitution with which an impact would add energy."""
    given = mechanism.restitution
    for direction in Direction if given is not None else ():
        own, most = mechanism.eta(direction), mechanism.greatest_restitution(direction)
        if own > most * (1 + ROUNDING):
            reason = f"must be at most {most:.6g}, got {own:g}: a larger value would add energy at an impact"
            if isinstance(given, DirectionalRestitution):
                field = "positive_to_negative" if direction > 0 else "negative_to_positive"
                raise RefusedFields(("restitution",), field, reason)
            raise RefusedFields((), "restitution", reason)


def check_stretched(mechanism: Mechanism) -> None:
    """Refuse ties that no motion stretches, or none in the one sense in which they can act."""
    for loc, tie in mechanism.hung.placed:
        parts = tie.stretched if isinstance(tie, Element) else ()
        if parts and not any(stretches(mechanism, part, side) for part in parts for side in mechanism.directions):
            sense = f" in {parts[0].only}" if parts[0].only else ""
            reason = f"nothing stretches {tie.name!r}{sense}: no motion of the structure changes its length"
            raise RefusedFields(loc, "name", reason)


def stretches(mechanism: Mechanism, tie: Stretched, direction: Direction) -> bool:
    """Return whether the motion in a direction stretches a tie, in the sense in which it can act."""
    grid = np.linspace(0.0, mechanism.limit(direction), LOOKED_AT)[:-1]
    e, _, _ = tie.elongation(mechanism.followed(grid, direction))
    long = max(1.0, *(abs(b.at - a.at) for a, b in pairwise(tie.spots)))
    return bool(((np.abs(e) > STRETCHED * long) & (tie.only is None or tie.force(e) != 0)).any())


def check_stands(mechanism: Mechanism) -> None:
    """Refuse loads and ties under which the structure does not stand, if it stands without them."""
    bodies, g, rest = mechanism.bodies(), mechanism.gravity, np.zeros(1)
    weight = g * (sum(body.mass for body in mechanism.weighed()) + mechanism.hung.carried)
    if mechanism.hung.lifting >= weight:
        reason = f"forces lift it by {mechanism.hung.lifting:.4g} N, more than all of its weight, {weight:.4g} N"
        raise RefusedFields((), "loads", reason)
    for direction in mechanism.directions:
        bare = coefficients(rest, direction, bodies, mechanism.motion(rest, direction))
        moment = g * mechanism.coefficients(rest, direction).restoring(g)[0]
        if bare.G[0] > 0 and not moment > 0:
            raise RefusedFields(
                (),
                "loads" if mechanism.loads else "ties",
                f"the structure cannot stand under them: at rest they turn it in the {direction.label} direction "
                f"with {-moment:.4g} N m more than its weight holds",
            )
