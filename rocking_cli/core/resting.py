"""Forces at the joints of a structure at rest, where all are closed: whether one slides, or opens, before it rocks.

At rest a joint touches at all points at which it touches in either direction of rocking. If statics determines the
forces there, each is affine in u_g'' and v_g'', as in `released`. Otherwise a structure on level feet is followed as
one body, which slides on the ground as a whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rocking_cli.core.contacts import Contact
from rocking_cli.core.hung.attached import PointMass
from rocking_cli.core.hung.elements import ConstantForce
from rocking_cli.core.kinematics import Direction
from rocking_cli.core.mechanism import Mechanism
from rocking_cli.core.released import ONE, PUSH, Pieces, Released, Undetermined, inverted


class Failure(NamedTuple):
    """How a structure at rest stops being at rest.

    Parameters
    ----------
    push : float
        Ground acceleration at which it does [m/s2].
    joint : str
        The joint that fails.
    slides : bool
        Whether this joint slides; otherwise one of its ends opens.
    """

    push: float
    joint: str
    slides: bool


SAME = 1e-6  # of the size of the structure: points that are one
FEET = "the ground and the feet"


def resting(mechanism: Mechanism) -> Released | None:
    """Tabulate the forces at the closed joints of a structure at rest, and their compliances.

    Parameters
    ----------
    mechanism : Mechanism
        A mechanism that rocks both ways, with loads and ties.

    Returns
    -------
    Released or None
        Tables of one rotation, 0; of factors those of phi.^2 are 0. None if the mechanism does not give its contacts,
        or rocks one way only, or forces at rest follow from no statics that is known.
    """
    if not mechanism.rocks_both_ways:
        return None
    sides = {direction: mechanism.contacts(direction) for direction in Direction}
    names = {direction: [piece.body.name for piece in mechanism.pieces(direction)] for direction in Direction}
    if not all(sides.values()) or names[Direction.POSITIVE] != names[Direction.NEGATIVE]:
        return None
    there = Pieces(mechanism, Direction.POSITIVE, np.zeros(1))
    closed = _closed([contact for contacts in sides.values() for contact in contacts or ()], SAME * there.scale.max())
    if closed is None:
        return None
    if sum(contact.forces for contact in closed) == there.dq.shape[1]:
        rates, rows = there.rates(closed)
        try:
            inverse = inverted(rates.dense() / there.scale) / there.scale[:, None]
        except Undetermined:
            return None
        compliance = 1 / np.einsum("nir,nir->nr", inverse, there.momenta(inverse))
        return Released(closed, rows, inverse.swapaxes(1, 2) @ there.held_still(), compliance)
    return _as_one(mechanism, there, closed)


def _closed(contacts: Sequence[Contact], near: float) -> list[Contact] | None:
    """Return the joints of both directions with all of their points; None if they are not those of one face."""
    found: dict[tuple[str, str | None], Contact] = {}
    for each in contacts:
        key = (each.label, each.held)
        known = found.setdefault(key, each)
        if abs(known.normal - each.normal) > SAME or known.pieces != each.pieces:
            return None
        apart = (each.points[0] - known.points[0]) * known.normal.conjugate()
        if each.held == "slide" and abs(apart.imag) > near:  # two lines of action
            return None
        if each.held is None:
            new = [at for at in each.points if min(abs(at - old) for old in known.points) > near]
            found[key] = replace(known, points=(*known.points, *new), face=None)
    return None if any(len(each.points) > 2 for each in found.values()) else list(found.values())


def _as_one(mechanism: Mechanism, there: Pieces, closed: Sequence[Contact]) -> Released | None:
    """Return the forces under level feet of a structure as one body; None if more than its feet holds it sideways."""
    feet = [contact for contact in closed if contact.held is None and None in contact.pieces]
    sideways = any(contact.held == "slide" for contact in closed)
    hung = all(isinstance(thing, PointMass | ConstantForce) for thing in mechanism.attached)
    friction = {contact.friction for contact in feet}
    level = all(contact.pieces[0] is None and abs(contact.normal - 1j) < SAME for contact in feet)
    if sideways or not hung or not level or len(friction) != 1 or None in friction:
        return None
    total = there.held_still()[0].reshape(-1, 3, 4).sum(axis=0)  # over the pieces
    force = np.stack([total[1], total[0]])[None]  # N, T
    mass = there.mass[0, :, 0, 0].sum()
    foot = Contact((None, None), (0j,), friction=friction.pop(), name=FEET)
    return Released([foot], [((0,), 1)], force, np.array([[0.0, 1 / mass]]))


def first_failure(found: Released, direction: Direction) -> Failure | None:
    """Return the joint that fails first at rest as a growing acceleration of the ground tips a structure one way."""
    fails = []
    for contact, (normal, shear) in zip(found.contacts, found.rows, strict=True):
        forces = [(found.force[0, row], False) for row in normal]
        if contact.friction is not None and shear is not None:
            total = contact.friction * found.force[0, list(normal)].sum(axis=0)
            forces += [(total - sense * found.force[0, shear], True) for sense in (1, -1)]
        for force, slides in forces:
            grows = -int(direction) * force[PUSH]  # a ground acceleration to the left tips it to the right
            if grows < 0:
                fails.append(Failure(max(float(force[ONE]), 0.0) / -grows, contact.label, slides))
    return min(fails, default=None)
