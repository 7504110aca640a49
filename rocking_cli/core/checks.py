"""Check that the fields of a structure fit together; each check raises `RefusedFields` with the field at fault."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.given import KINEMATIC, NEEDS_A_SIDE, DirectionalRestitution, Given
from rocking_cli.core.hung.attachments import RefusedFields
from rocking_cli.core.hung.everything import Hung
from rocking_cli.core.kinematics import Direction
from rocking_cli.core.strength import Strength

ROUNDING = 1e-9  # by which a restitution may exceed its bound, which the kinematic one of equal sides reaches
AtRest = Mapping[Direction, Coefficients]
"""The coefficients of each direction that a structure can rock in, at phi = 0."""


def check_masses(given: Given) -> None:
    """Refuse a structure that has both `mass` and `density`."""
    if given.mass is not None and given.density is not None:
        raise RefusedFields((), "mass", "give mass, or density and depth: one of them")


def check_crushed(moved: Mapping[Direction, Mapping[str, float]], rest: AtRest, gravity: float) -> None:
    """Refuse `crushing` if it moves no joint, or moves joints (by `moved` [m]) so far that nothing stands."""
    if not moved:
        reason = "its pivots cannot be moved in this version, only those of single bodies and of walls: leave it out"
        raise RefusedFields((), "crushing", reason)
    for direction, here in rest.items():
        if not here.restoring(gravity)[0] > 0:
            far = max(moved[direction].values())
            reason = f"the structure cannot stand on what is left: a pivot moves inwards by {far:.4g} m"
            raise RefusedFields((), "crushing", reason)


def check_one_sided(given: Given, from_impacts: Callable[[], float | None]) -> None:
    """Check that `one_sided`, `rebound` and `restitution` fit together. Raises `RefusedFields`.

    A structure that rocks to both sides has no rebound, and one that rocks to one side only has a rebound and no
    restitution. The rebound may be `kinematic` only if it follows from the shape.
    """
    if given.one_sided is None and given.rebound is not None:
        raise RefusedFields((), "rebound", NEEDS_A_SIDE)
    if given.one_sided is not None and given.restitution is not None:
        raise RefusedFields((), "restitution", "cannot be combined with `one_sided`: give `rebound` instead")
    asked = "rebound" in given.model_fields_set and given.rebound is None
    if given.one_sided is not None and asked and from_impacts() is None:
        why = "only for a plain rectangle does it follow from the shape; give a number in [0, 1)"
        raise RefusedFields((), "rebound", f"cannot be {KINEMATIC}: {why}")


def check_restitution(given: Given, eta: Callable[[Direction], float], greatest: Callable[[Direction], float]) -> None:
    """Refuse a restitution with which an impact would add energy."""
    if given.restitution is None:
        return
    for direction in Direction:
        own, most = eta(direction), greatest(direction)
        if own > most * (1 + ROUNDING):
            field = "restitution"
            if isinstance(given.restitution, DirectionalRestitution):
                field = "positive_to_negative" if direction > 0 else "negative_to_positive"
            reason = f"must be at most {most:.6g}, got {own:g}: a larger value would add energy at an impact"
            raise RefusedFields(() if field == "restitution" else ("restitution",), field, reason)


def check_strength(given: Given) -> None:
    """Refuse a contact strength if the structure has no masses or no depth."""
    if not isinstance(given.strength, Strength):  # None, or a field of a plugin of that name
        return
    if not given.has_mass:
        raise RefusedFields((), "strength", "the structure has no masses: give density and depth, or its mass")
    if given.depth is None:
        raise RefusedFields((), "depth", "is missing: the contacts are as long as the structure is deep")


def check_weighs(given: Given) -> None:
    """Refuse loads, ties and crossing walls on a structure without masses."""
    if not given.has_mass:
        key = "loads" if given.loads else "ties" if given.ties else "interlock"
        raise RefusedFields((), key, "the structure has no masses: give density and depth, or its mass")


def check_stands(given: Given, hung: Hung, mass: float, rest: AtRest, bare: AtRest) -> None:
    """Refuse loads and ties under which the structure does not stand, if it stands without them.

    Parameters
    ----------
    given : Given
        The structure.
    hung : Hung
        What is attached to it.
    mass : float
        Mass of the bodies of the mechanism [kg].
    rest, bare : mapping
        Coefficients at rest of each direction, with loads and ties and without them.
    """
    weight = given.gravity * (mass + hung.carried)
    if hung.lifting >= weight:
        reason = f"forces lift it by {hung.lifting:.4g} N, more than all of its weight, {weight:.4g} N"
        raise RefusedFields((), "loads", reason)
    for direction, here in rest.items():
        if bare[direction].G[0] > 0 and not here.restoring(given.gravity)[0] > 0:
            raise RefusedFields(
                (),
                "loads" if given.loads else "ties",
                f"the structure cannot stand under them: at rest they turn it in the {direction.label} direction "
                f"with {-here.restoring(given.gravity)[0] * given.gravity:.4g} N m more than its weight holds",
            )
