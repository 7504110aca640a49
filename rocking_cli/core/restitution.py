"""Restitution from kinematics: the impulses of an impact do no work in the motion that follows."""

from __future__ import annotations

from collections.abc import Sequence

from rocking_cli.core.bodies import Body
from rocking_cli.core.hung.attached import PointMass
from rocking_cli.core.kinematics import RigidMotion


def kinematic_restitution(
    bodies: Sequence[Body],
    before: Sequence[RigidMotion],
    after: Sequence[RigidMotion],
    loads: Sequence[PointMass] = (),
) -> float:
    """Return eta, the ratio of the rotation rates after and before an impact.

    The velocity before the impact is projected on the mechanism that follows, in the mass inner product: eta =
    -<t_before, t_after> / <t_after, t_after> with t the velocity fields at rest. For a block this is Housner's 1 -
    (3/2) sin^2(alpha). This is an idealisation: measured values lie on either side of it. A value of zero or less means
    that the new mechanism cannot start as assumed.

    Parameters
    ----------
    bodies : sequence of Body
        Bodies that are rigid in both mechanisms.
    before, after : sequence of RigidMotion
        Motions of the bodies in the two directions; the first entry of each is at rest (phi = 0).
    loads : sequence of PointMass
        Masses on these bodies, whose shares enter the inner product; a tie or a force is no part of it.

    Returns
    -------
    float
        eta; it does not depend on the scale of the masses.
    """
    mixed = own = 0.0
    for body, old, new in zip(bodies, before, after, strict=True):
        u, v = old.carry(body.centroid)[1][0], new.carry(body.centroid)[1][0]
        mixed += body.mass * (u.conjugate() * v).real + body.inertia * old.dpsi[0] * new.dpsi[0]
        own += body.mass * abs(v) ** 2 + body.inertia * new.dpsi[0] ** 2
    by_name = {body.name: pair for body, pair in zip(bodies, zip(before, after, strict=True), strict=True)}
    for load in loads:
        old, new = by_name[load.spot.body or ""]
        u, v = (complex(motion.carry(load.spot.at)[1][0]) for motion in (old, new))
        mixed += load.product(u, v)
        own += load.product(v, v)
    return float(-mixed / own)


def why_none(eta: float) -> str:
    """Return in words why the kinematics give no valid restitution, from the sign of the one that they give.

    Parameters
    ----------
    eta : float
        Restitution from kinematics, not positive.
    """
    product = "zero" if eta == 0 else "positive"
    return (
        f"the mass inner product of its motions before and after, <t+, t->, is {product}, so that no rocking the other "
        "way follows the impact"
    )
