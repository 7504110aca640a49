"""Forces at the joints of a structure at rest, where all are closed: whether one slides, or opens, before it rocks.

At rest a joint touches at all points at which it touches in either direction of rocking. If statics determines the
forces there, each is affine in u_g'' and v_g'', as in `released`. Otherwise limit analysis finds the first mechanism of
either sense, and a structure on level feet is also checked as one body, which slides on the ground as a whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rocking_cli.core.contacts import MASONRY_FRICTION, Contact
from rocking_cli.core.equivalence import EQUAL_DIRECTIONS
from rocking_cli.core.hung.attached import PointMass
from rocking_cli.core.hung.element import ConstantForce
from rocking_cli.core.kinematics import Direction, Reals
from rocking_cli.core.mechanism import Mechanism
from rocking_cli.core.released import ONE, PUSH, Pieces, Released, Undetermined, inverted, released

RELATIVE_TOLERANCE = 1e-6  # relative difference of equal points (over the structure's size) and equal accelerations
MAX_ACCELERATION_G = 30.0  # stronger ground accelerations are not analysed
ZERO_MISSING_FORCE = 1e-9  # missing force over the weight that counts as zero, as rounding
MAX_FRICTION = 10.0  # largest coefficient of friction of a field
FRICTION_ACCURACY = 1e-4  # relative error of the friction that is needed
FEET_PLACE = "the ground and the feet"


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
    opens : bool
        Whether any joint opens.
    """

    push: float
    joint: str
    slides: bool
    opens: bool


class EarlyMechanism(NamedTuple):
    """A mechanism in which a structure at rest fails, for a velocity of 1 at the joint that moves most.

    Parameters
    ----------
    joint : str
        The joint that moves most.
    slides : bool
        Whether this joint slides; otherwise it opens.
    opens : bool
        Whether any joint opens.
    force : ndarray, shape (4,)
        Work of the joints' forces on the mechanism [N]: coefficients of 1, u_g'', phi.^2, v_g''; below 0 it moves.
    compliance : float
        Acceleration of the mechanism over the work that is missing [1/kg].
    velocity : ndarray, shape (3 pieces,)
        Velocities of all pieces.
    """

    joint: str
    slides: bool
    opens: bool
    force: Reals
    compliance: float
    velocity: Reals


class Rest(NamedTuple):
    """Possible failures at rest: of joints whose forces are known, and by mechanisms that start before rocking.

    `known` is whether all joints at rest are known, so that nothing else may fail.
    """

    closed: Released | None
    modes: Sequence[EarlyMechanism] = ()
    known: bool = True


def resting(mechanism: Mechanism) -> Rest:
    """Find the possible failures of a structure at rest.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism, with loads and ties.

    Returns
    -------
    Rest
        Tables of the joints' forces at one rotation, 0, where statics determines them: their factors of phi.^2 are 0.
        None if the mechanism does not give its contacts at rest, or statics does not determine the forces and more than
        level feet holds the structure sideways. Mechanisms that start before rocking, or in the direction in which the
        structure cannot rock because another body props it.
    """
    contacts = mechanism.contacts_at_rest()
    names = {tuple(piece.body.name for piece in mechanism.pieces(direction)) for direction in mechanism.directions}
    if contacts is None or len(names) > 1:
        return Rest(None, known=False)
    there = Pieces(mechanism, mechanism.directions[0], np.zeros(1))
    closed = _closed(contacts, RELATIVE_TOLERANCE * there.scale.max())
    if closed is None:
        return Rest(None, known=False)
    if mechanism.rocks_both_ways and sum(contact.forces for contact in closed) == there.dq.shape[1]:
        rates, rows = there.rates(closed)
        try:
            inverse = inverted(rates.dense() / there.scale) / there.scale[:, None]
        except Undetermined:
            return Rest(None, known=False)
        compliance = 1 / np.einsum("nir,nir->nr", inverse, there.momenta(inverse))
        return Rest(Released(closed, rows, inverse.swapaxes(1, 2) @ there.held_still(), compliance))
    whole = _as_one(mechanism, there, closed)
    if mechanism.rocks_both_ways or mechanism.propped:
        known = Rest(whole if mechanism.rocks_both_ways else None)
        first_modes = [_first(mechanism, there, closed, direction, known) for direction in Direction]
        return known._replace(modes=[mode for mode in first_modes if mode is not None])
    (direction,) = mechanism.directions
    known = Rest(None, [] if whole is None else [_slides_out(whole, there, direction)])
    if any(each.held is None and len(each.points) == 1 for each in closed):  # only one point of the face is known
        return known._replace(known=len(mechanism.bodies()) == 1)
    mode = _first(mechanism, there, closed, direction, known, _leaning(mechanism, closed, direction))
    return known if mode is None else known._replace(modes=[*known.modes, mode])


def _closed(contacts: Sequence[Contact], tolerance: float) -> list[Contact] | None:
    """Return the joints of both directions, each with all its points; None if some are not on one face."""
    joints: dict[tuple[str, str | None, complex], Contact] = {}
    for contact in contacts:
        alike = (
            key
            for key in joints
            if key[:2] == (contact.label, contact.held) and abs(key[2] - contact.normal) <= RELATIVE_TOLERANCE
        )
        key = next(alike, (contact.label, contact.held, contact.normal))
        known = joints.setdefault(key, contact)
        if known.pieces != contact.pieces:
            return None
        apart = (contact.points[0] - known.points[0]) * known.normal.conjugate()
        if contact.held == "slide" and abs(apart.imag) > tolerance:  # the guides have different lines of action
            return None
        if contact.held is None:
            new = [at for at in contact.points if min(abs(at - old) for old in known.points) > tolerance]
            joints[key] = replace(known, points=(*known.points, *new), face=None)
    return None if any(len(contact.points) > 2 for contact in joints.values()) else list(joints.values())


def _as_one(mechanism: Mechanism, there: Pieces, closed: Sequence[Contact]) -> Released | None:
    """Return the forces under level feet of a structure as one body; None if more than its feet holds it sideways."""
    feet = [contact for contact in closed if contact.held is None and None in contact.pieces]
    sideways = any(contact.held == "slide" for contact in closed)
    hung = all(isinstance(attachment, PointMass | ConstantForce) for attachment in mechanism.attached)
    friction = {contact.friction for contact in feet}
    level = all(contact.pieces[0] is None and abs(contact.normal - 1j) < RELATIVE_TOLERANCE for contact in feet)
    if sideways or not hung or not level or len(friction) != 1 or None in friction:
        return None
    total = there.held_still()[0].reshape(-1, 3, 4).sum(axis=0)  # sum over the pieces
    force = np.stack([total[1], total[0]])[None]  # normal and shear force
    mass = there.mass[0, :, 0, 0].sum()
    foot = Contact((None, None), (0j,), friction=friction.pop(), name=FEET_PLACE)
    return Released([foot], [((0,), 1)], force, np.array([[0.0, 1 / mass]]))


def _slides_out(whole: Released, there: Pieces, direction: Direction) -> EarlyMechanism:
    """Return the mechanism in which a structure slides as one body away from its side support."""
    (foot,), (normal, shear) = whole.contacts, whole.force[0]
    velocity = np.tile([float(direction), 0.0, 0.0], there.dq.shape[1] // 3)
    force = (foot.friction or 0.0) * normal + int(direction) * shear
    return EarlyMechanism(foot.label, True, False, force, float(whole.compliance[0, 1]), velocity)


def _leaning(mechanism: Mechanism, closed: Sequence[Contact], direction: Direction) -> list[Contact]:
    """Return smooth contacts of every piece with a side support of unknown shape, so that no piece moves into it."""
    at = {piece.body.name: {piece.body.centroid} for piece in mechanism.pieces(direction)}
    for contact in closed:
        for name in contact.pieces:
            if name is not None and contact.held is None:
                at[name].update(contact.points)
    return [
        Contact((None, name), (point,), complex(direction), friction=0.0)
        for name, points in at.items()
        for point in points
    ]


def _first(
    mechanism: Mechanism,
    there: Pieces,
    closed: Sequence[Contact],
    direction: Direction,
    known: Rest,
    leaning: Sequence[Contact] = (),
) -> EarlyMechanism | None:
    """Return the mechanism that starts first as the ground pushes a structure one way; None if it rocks or slides."""
    rocks = direction in mechanism.directions
    if not rocks and not mechanism.propped:
        return None
    uplift = mechanism.uplift(direction) if rocks else MAX_ACCELERATION_G
    if rocks and _bears_at_uplift(mechanism, direction, uplift):
        return None
    mode = _weakest(there, closed, leaning, -int(direction), mechanism.gravity)
    slides = first_failure(known, direction)
    push = min(uplift * mechanism.gravity, np.inf if slides is None else slides.push)
    return (
        mode if mode is not None and mode.force[ONE] < (1 - RELATIVE_TOLERANCE) * push * abs(mode.force[PUSH]) else None
    )


def _bears_at_uplift(mechanism: Mechanism, direction: Direction, uplift: float, friction: float | None = None) -> bool:
    """Return whether all joints bear at uplift in the forces of rocking, which are one state of equilibrium at rest.

    Joints that are given no friction have `friction`, or never slide.

    The accelerations of the ground that the joints can bear at rest are an interval, so that all of them up to uplift
    are borne: this saves the search for most structures.
    """
    try:
        rocking = released(mechanism, direction, np.zeros(1))
    except Undetermined:
        return False
    if rocking is None:
        return False
    push = -int(direction) * uplift * mechanism.gravity
    least = -ZERO_MISSING_FORCE * np.abs(rocking.force[0, :, ONE]).sum()
    return all(force[ONE] + push * force[PUSH] >= least for force, _, _ in _conditions(rocking, friction))


def _conditions(joints: Released, friction: float | None = None) -> Iterator[tuple[Reals, str, bool]]:
    """Yield each force that must not be negative at rest, its joint, and whether the joint slides if it is.

    A force is given by its factors, as in `Released`: it is affine in the ground accelerations.
    """
    for contact, (normal, shear) in zip(joints.contacts, joints.rows, strict=True):
        for row in normal:
            yield joints.force[0, row], contact.label, False
        mu = friction if contact.friction is None else contact.friction
        if mu is not None and shear is not None:
            total = mu * joints.force[0, list(normal)].sum(axis=0)
            for sense in (1, -1):
                yield total - sense * joints.force[0, shear], contact.label, True


def _weakest(
    there: Pieces, joints: Sequence[Contact], leaning: Sequence[Contact], sense: int, gravity: float
) -> EarlyMechanism | None:
    """Return the mechanism of the largest ground acceleration of one sense that the joints can bear, if any.

    A linear programme: of forces that are in equilibrium with the loads, joints press and friction is not exceeded. Its
    dual solution is the mechanism, in which a joint that slides opens by friction times slip.
    """
    from scipy.optimize import linprog  # slow to import, and only redundant joints need it

    closed = [*joints, *leaning]
    rates, rows = there.rates(closed)
    jacobian, scale, demand = rates.dense()[0], there.scale, there.held_still()[0]
    count = len(jacobian)
    unit = float(np.abs(demand[:, ONE]).max()) or 1.0
    low, high = np.full(count, -np.inf), np.full(count, np.inf)
    limits: list[Reals] = []
    at = 0
    borne: dict[int, Reals] = {}  # key: row of a guide under a load; value: what its friction can bear
    for contact, (normal, shear) in zip(closed, rows, strict=True):
        low[list(normal)] = 0.0
        if contact.pressed_by and contact.friction is not None:
            borne[at] = contact.friction * there.pressing(contact, still=True)[0]
            low[at], high[at] = np.array([-1, 1]) * borne[at][ONE] / unit
        elif shear is not None and contact.friction is not None:
            for sign in (1.0, -1.0):
                limit = np.zeros(count + 1)
                limit[shear], limit[list(normal)] = sign, -contact.friction
                limits.append(limit)
        at += contact.forces
    pushed = -demand[:, PUSH] * gravity / unit / scale
    solved = linprog(
        np.append(np.zeros(count), -float(sense)),
        A_ub=np.array(limits) if limits else None, b_ub=np.zeros(len(limits)) if limits else None,
        A_eq=np.column_stack([(jacobian / scale).T, pushed]), b_eq=demand[:, ONE] / scale / unit,
        bounds=[*zip(low, high, strict=True), (-MAX_ACCELERATION_G, MAX_ACCELERATION_G)], method="highs-ds",
    )  # fmt: skip
    if solved.status != 0 or sense * solved.x[-1] >= (1 - RELATIVE_TOLERANCE) * MAX_ACCELERATION_G:
        return None
    velocity = -np.asarray(solved.eqlin.marginals) / scale
    speed = jacobian @ velocity
    force = velocity @ demand
    if force[PUSH] * sense > 0:
        velocity, speed, force = -velocity, -speed, -force
    for row, holds in borne.items():
        force = force + abs(speed[row]) * holds
    names = [contact.label for contact in joints for _ in range(contact.forces)]
    speed = np.abs(speed[: len(names)])
    fastest = speed.max()
    plain = _undilated(jacobian, closed, rows, velocity, scale)
    presses = [row for normal, _ in rows for row in normal if row < len(names)]
    fastest_row = int(np.argmax(speed >= (1 - RELATIVE_TOLERANCE) * fastest))  # the first of equally fast rows
    return EarlyMechanism(
        names[fastest_row],
        fastest_row not in presses,
        bool(np.abs((jacobian @ plain)[presses]).max(initial=0.0) > RELATIVE_TOLERANCE * fastest),
        force / fastest,
        float(fastest**2 / (plain @ there.momentum(plain[None])[0])),
        velocity / fastest,
    )


def _undilated(
    jacobian: Reals,
    closed: Sequence[Contact],
    rows: Sequence[tuple[tuple[int, ...], int | None]],
    velocity: Reals,
    scale: Reals,
) -> Reals:
    """Return the motion corrected so that joints slide without opening; unchanged if that is not possible."""
    change = np.zeros(len(jacobian))
    for contact, (normal, shear) in zip(closed, rows, strict=True):
        if contact.friction is not None and shear is not None:
            change[list(normal)] = -contact.friction * abs(jacobian[shear] @ velocity)
    by = np.linalg.lstsq(jacobian / scale, change, rcond=None)[0] / scale
    off = np.abs(jacobian @ by - change).max(initial=0.0)
    return velocity + by if off <= RELATIVE_TOLERANCE * np.abs(jacobian @ velocity).max() else velocity


def first_failure(rest: Rest, direction: Direction) -> Failure | None:
    """Return the joint that fails first at rest as a growing acceleration of the ground tips a structure one way."""
    rows = [(mode.force, mode.joint, mode.slides, mode.opens) for mode in rest.modes]
    if rest.closed is not None:
        rows += [(force, joint, slides, not slides) for force, joint, slides in _conditions(rest.closed)]
    # A ground acceleration to the left tips the structure to the right.
    fails = [
        Failure(max(float(force[ONE]), 0.0) / (int(direction) * float(force[PUSH])), joint, slides, opens)
        for force, joint, slides, opens in rows if int(direction) * force[PUSH] > 0
    ]  # fmt: skip
    least = min((each.push for each in fails), default=0.0) * (1 + RELATIVE_TOLERANCE)
    return next((each for each in fails if each.push <= least), None)  # the first of equal failures


class EarlyFailure(NamedTuple):
    """How a structure fails at rest in a direction, and the lambda of that direction; None if it cannot rock so."""

    direction: Direction
    failure: Failure
    lambda_: float | None


def early_failures(mechanism: Mechanism) -> list[EarlyFailure]:
    """Return, by direction, which joint slides or opens before a structure rocks or pushes back its prop.

    At rest between two directions a tie of steel has no force.
    """
    if mechanism.rocks_both_ways:
        mechanism = mechanism.at_strength(on=False)
    still, failures = resting(mechanism), []
    for direction in Direction if mechanism.propped else mechanism.directions:
        failure = first_failure(still, direction)
        lambda_ = mechanism.uplift(direction) if direction in mechanism.directions else None
        if failure is not None and (
            lambda_ is None or failure.push < (1 - EQUAL_DIRECTIONS) * lambda_ * mechanism.gravity
        ):
            failures.append(EarlyFailure(direction, failure, lambda_))
    return failures


class Glued(NamedTuple):
    """How a structure whose joints are given no friction fails first in a direction if they have the usual one.

    Parameters
    ----------
    direction : Direction
    failure : Failure
        How it fails at rest with the usual friction of masonry.
    lambda_ : float
        The acceleration at which it rocks, or fails, without sliding [standard gravity of the structure].
    needed : float or None
        The least friction of all its joints with which this stays the same; None if it is larger than 10.
    """

    direction: Direction
    failure: Failure
    lambda_: float
    needed: float | None


def glued(mechanism: Mechanism) -> list[Glued]:
    """Return the directions in which joints that are given no friction need more than masonry usually has.

    None for a structure that searches for its mechanism, which compares both itself, and for a single body, which
    slides on the ground in place of rocking and does not overturn.
    """
    if len(mechanism.bodies()) == 1:
        return []
    ways = mechanism.directions
    lambdas = {direction: mechanism.uplift(direction) for direction in ways}
    if mechanism.friction is not None or all(
        _bears_at_uplift(mechanism, direction, lambdas[direction], MASONRY_FRICTION) for direction in ways
    ):
        return []
    if mechanism.collapse(ways[0]) is not None:
        return []
    lambdas |= {each.direction: each.failure.push / mechanism.gravity for each in early_failures(mechanism)}

    def fails(friction: float, direction: Direction) -> Failure | None:
        failure = first_failure(resting(mechanism.model_copy(update={"friction": friction})), direction)
        least = (1 - EQUAL_DIRECTIONS) * lambdas[direction] * mechanism.gravity
        return failure if failure is not None and failure.push < least else None

    unborne = []
    for direction in ways:
        if (failure := fails(MASONRY_FRICTION, direction)) is None:
            continue
        low, high = MASONRY_FRICTION, MAX_FRICTION
        suffices = fails(high, direction) is None
        while suffices and high - low > FRICTION_ACCURACY * high:
            middle = (low + high) / 2
            low, high = (low, middle) if fails(middle, direction) is None else (middle, high)
        unborne.append(Glued(direction, failure, lambdas[direction], high if suffices else None))
    return unborne
