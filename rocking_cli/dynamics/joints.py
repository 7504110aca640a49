"""Joints of a structure as the arrays by which the kernel checks time histories.

The forces of `rocking_cli.core.released` become cubics over q, the coordinate of the kernel. Most states of a history
are far from any limit of a joint: for these, two straight lines over q.^2 bound the ground accelerations at which all
joints hold.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Integers, Reals
from rocking_cli.core import Mechanism
from rocking_cli.core.equivalence import Statics
from rocking_cli.core.released import (
    ONE,
    PUSH,
    RATE,
    WEIGHT,
    Pieces,
    Released,
    Undetermined,
    released,
    stop_impulses,
    tabulated_impulses,
)
from rocking_cli.core.structure_fields import Strength
from rocking_cli.dynamics import openings
from rocking_cli.dynamics.modes import modes
from rocking_cli.dynamics.resting import EarlyMechanism, Rest, resting
from rocking_cli.dynamics.tables import DirectionTable
from rocking_cli.names import OPENING
from rocking_cli.short_repr import short_repr
from rocking_cli.text import in_short

FORCE_CELLS = 32  # cells of the forces from rest to phi_cr
REDUNDANT_CELLS = 40  # cells where joints are redundant, whose modes take longer to find
MAX_CELLS = 128
CELL_SPLITS = 4  # number of cells of the certain bounds in each cell of the forces
ZERO_TENSION = 1e-9  # tension over the weight that counts as zero, as rounding
MAX_OPENING_STEP = 3e-3  # longest step in which openings of joints are integrated, over 1/p
MAX_ACCELERATION = 1e6  # m/s2; larger than any ground acceleration
NO_BOUNDS = (np.inf, -1.0)  # stands for bounds that no q.^2 meets, where no q.^2 keeps all joints closed
WHOLE_RANGE = (-np.inf, np.inf)  # stands for: under any u_g'' no joint fails at rest
MAX_MISSING_WEIGHTS = 1e3  # force over the weight that no ground motion overcomes
BOUND_MARGIN = 0.01  # margin over the width of the certain bounds, as cubics may cross them between nodes
MAX_LISTED_NAMES = 4  # names listed in a message: enough for the hinges of a frame or an arch in both directions
EVENTS = (
    [openings.PASSED, openings.REASON, openings.WHERE],
    [openings.WARNED, openings.WARNED_WHERE],
    [openings.PARTED, openings.PARTED_WHERE],
)
"""Marks of each event at a joint, its time first."""
PLACE_KINDS = (("foot", "feet"), ("hinge", "hinges"), ("closed joint", "closed joints"))


@short_repr
@dataclass(frozen=True, eq=False)
class JointTables:
    """Joints of a structure, as arrays of the kernel.

    Parameters
    ----------
    labels : sequence of str
        Name of each joint in messages.
    contacts : ndarray of int, shape (joints, 2, 4)
        Rows of the two normal forces and of the shear force in either direction, -1 if there is none, and whether the
        joint has other contact points in the other direction.
    bearing : ndarray, shape (joints, 2)
        Coefficient of friction, NaN if none is given, and strength [N], infinite if none is given.
    rows : ndarray, shape (cells, 2, rows, 20)
        Cubics over q of the factors of 1, u_g'', q.^2 and v_g'' in each force [N], and of its compliance [1/kg].
    struck : ndarray, shape (2, rows, 2)
        Impulses in the direction that begins, over the rotation rate before the impact [N s per rad/s]: a constant, and
        the factor of eta.
    stopped : ndarray, shape (2, rows, 2)
        Impulses of a stop, over the rotation rate before it: a constant, and the factor of its restitution; zeros
        without a stop.
    within : ndarray, shape (cells, 2, 5)
        Quick test that no joint fails, for each cell of q and each direction: five numbers (a, b, c, d, e). All joints
        hold if a + b q.^2 <= u_g'' <= c + d q.^2 and q.^2 <= e. Outside these bounds the forces must be computed.
    reach : float
        D_cr: the largest displacement of a block's centroid from rest to phi_cr, of both directions the smaller [m].
    limit : float
        Largest opening with which a history remains valid, over `reach`.
    scales : bool
        Whether all forces scale with g.
    step : float
        Longest time step in which openings are integrated [s]; the kernel may use a shorter one.
    gravity : float
        Acceleration of gravity [m/s2].
    rest : ndarray, shape (joints, 3, 4)
        Normal forces and shear force of each joint at rest: the factors of 1, u_g'' and v_g'' [N], and the compliance
        [1/kg], which is 0 where there is no such force, or it is not known.
    steady : tuple of float
        Quick test that no joint fails at rest: least and largest u_g'' [m/s2].
    asserted : sequence of str
        Joints that are assumed to hold without a check, in words.
    sliding : collection of int
        Joints that slide in a mechanism at rest that opens others.
    redundant : bool
        Whether statics alone does not determine the forces at the joints; then rows are modes in which several joints
        open.
    calm : tuple of float
        Quick test that no joint fails anywhere up to phi_cr: two numbers (u, r). All joints hold as long as
        abs(u_g'')/u + q.^2/r <= 1. It is (infinity, -1) if the joints do not hold at rest, so that the test never
        passes.
    alone : bool
        Whether the only joint is that of a single body with the ground.
    checked : sequence of str
        Joints that are checked, by kind, in words.
    at_rest : bool
        Whether all joints are checked at rest too.
    """

    labels: Sequence[str]
    contacts: Integers
    bearing: Reals
    rows: Reals
    struck: Reals
    stopped: Reals
    within: Reals
    reach: float
    limit: float
    scales: bool
    step: float
    gravity: float
    rest: Reals
    steady: tuple[float, float]
    asserted: Sequence[str]
    sliding: Collection[int] = ()
    redundant: bool = False
    calm: tuple[float, float] = NO_BOUNDS
    alone: bool = False
    checked: Sequence[str] = ()
    at_rest: bool = True


@short_repr
@dataclass(frozen=True)
class JointCheck:
    """State of a structure's joints during one history; each joint is checked as if it alone could open.

    Parameters
    ----------
    limit : float
        Opening beyond which the history is not valid, over `reach`.
    reach : float
        D_cr: the largest displacement of a block from rest to phi_cr, of both directions the smaller [m].
    passed : float
        Time at which the opening passes the limit, a contact crushes or no weight holds the structure down [s]; NaN if
        never.
    reason : {"opens", "slides", "crushes", "weightless", "apart", "bound"} or None
        Which of these happens at `passed`; "weightless" means that no weight holds the structure down, "apart" that
        its columns may fall out of step, "bound" that it reaches the bound of its motion.
    joint : str
        The joint at which this happens; empty if none.
    warned : float
        First time at which a joint would open or slide [s]; NaN if never.
    warned_joint : str
        The joint of `warned`.
    largest : float
        Largest opening or slip of a joint [m], over the whole history.
    largest_joint : str
        Joint of the largest opening; empty if none opens.
    longest : float
        The longest time for which a joint is open, or slides [s].
    parted : float or None
        First time at which a joint that the model keeps closed would open [s]; NaN if never, None if there is no such
        joint.
    parted_joint : str
        The joint of `parted`.
    count : int
        Number of joints checked; 0 if none could open.
    alone : bool
        Whether the only joint is that of a single body with the ground.
    asserted : sequence of str
        Joints that are assumed to hold without a check, in words.
    checked : sequence of str
        Joints that are checked, by kind, in words.
    at_rest : bool
        Whether all joints were checked at rest too.
    """

    limit: float
    reach: float
    passed: float
    reason: str | None
    joint: str
    warned: float
    warned_joint: str
    largest: float
    largest_joint: str
    longest: float
    parted: float | None
    parted_joint: str
    count: int
    alone: bool
    asserted: Sequence[str] = ()
    checked: Sequence[str] = ()
    at_rest: bool = True


REASONS = ("opens", "slides", "crushes", "weightless", "apart", "bound")  # of failure, by their number in the kernel


def check_of(joints: JointTables | None, marks: Reals, overturning_time: float) -> JointCheck | None:
    """Return the check of the joints in one history from the marks of the kernel; None if they are not known.

    What happens to joints after `overturning_time` (NaN: never) is left out.
    """
    if joints is None:
        return None
    marks = marks.copy()
    for event in EVENTS:
        if marks[event[0]] > overturning_time:
            marks[event] = np.nan

    def label(column: int) -> str:
        at = marks[column]
        return joints.labels[int(at)] if np.isfinite(at) and at >= 0 else ""

    reason = None if np.isnan(marks[openings.REASON]) else REASONS[int(marks[openings.REASON])]
    if reason == "opens" and marks[openings.WHERE] in joints.sliding:
        reason = "slides"
    opens, where = (
        (openings.WARNED, openings.WARNED_WHERE) if joints.redundant else (openings.PARTED, openings.PARTED_WHERE)
    )
    stays_closed = joints.redundant or (joints.contacts[:, :, openings.OTHER] >= 0).any()
    return JointCheck(
        limit=joints.limit,
        reach=joints.reach,
        passed=float(marks[openings.PASSED]),
        reason=reason,
        joint=label(openings.WHERE),
        warned=float(marks[openings.WARNED]),
        warned_joint=label(openings.WARNED_WHERE),
        largest=float(marks[openings.LARGEST]),
        largest_joint=label(openings.LARGEST_WHERE),
        longest=float(marks[openings.LONGEST]),
        parted=float(marks[opens]) if stays_closed else None,
        parted_joint=label(where),
        count=len(joints.labels),
        alone=joints.alone,
        asserted=joints.asserted,
        checked=joints.checked,
        at_rest=joints.at_rest,
    )


def joints_of(
    mechanism: Mechanism, statics: Sequence[Statics], tables: Sequence[DirectionTable], p: float
) -> JointTables | None:
    """Return the joints of a structure as arrays of the kernel; None if they are not known.

    The rows of each direction are the forces at its joints, as statics gives them; where statics alone does not, the
    modes in which joints open. In a structure with supports that push back, those modes of supports follow.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    statics : sequence of Statics
        Statics of both directions.
    tables : sequence of DirectionTable
        Tables of both directions.
    p : float
        Frequency parameter [rad/s].

    Returns
    -------
    JointTables or None
        None if the joints are not known, so that no history is checked.
    """
    cells = max(FORCE_CELLS * table.end / table.q(side.reference) for table, side in zip(tables, statics, strict=True))
    cells = int(min(np.ceil(cells), MAX_CELLS))
    sides = list(zip(mechanism.sides, tables, strict=True))
    redundant = False
    try:
        answers: list[tuple[Released | None, Reals | None]] = [
            (released(mechanism, direction, _at(table, cells)), tabulated_impulses(mechanism, direction.opposite))
            for direction, table in sides
        ]
    except Undetermined as error:
        if not error.redundant:
            return None
        redundant, cells = True, min(cells, REDUNDANT_CELLS)
        answers = [
            modes(mechanism, direction, _at(table, cells), side.reference)
            for (direction, table), side in zip(sides, statics, strict=True)
        ]
    released_sides = [forces for forces, _ in answers if forces is not None]
    if len(released_sides) < len(sides) or not all(forces.contacts for forces in released_sides):
        return None
    still = resting(mechanism)
    push_modes = still.modes if mechanism.propped else ()  # these push supports back, and go on as the structure rocks
    known = [*released_sides, still.closed] if still.closed is not None else released_sides
    labels = list(dict.fromkeys(
        contact.label for forces in known
        for contact, (_, shear) in zip(forces.contacts, forces.rows, strict=True) if shear is not None
    ))  # fmt: skip
    contacts, bearing = _contacts(mechanism, released_sides, labels, still.modes)
    row_count = max(forces.force.shape[1] for forces in released_sides) + len(push_modes)
    weight = mechanism.gravity * sum(body.mass for body in mechanism.weighed())
    rows = np.zeros((cells, 2, row_count, 20))  # cubics of four factors and a compliance
    within = np.zeros((CELL_SPLITS * cells, 2, 5))
    struck, stopped = np.zeros((2, 2, row_count, 2))
    rest, steady = _at_rest(still, labels, bearing, weight)
    joint_count = len(labels)
    labels += [mode.joint for mode in still.modes]
    for d, ((direction, table), forces) in enumerate(zip(sides, released_sides, strict=True)):
        factors = _factors(forces, mechanism.coefficients(_at(table, cells), direction).I, weight)
        if push_modes:
            first, count = factors.shape[1], len(push_modes)  # their rows follow those of the joints
            contacts[-count:, d, 0] = contacts[-count:, d, 2] = np.arange(count) + first
            constant = np.array([[*mode.force, mode.compliance] for mode in push_modes])
            factors = np.concatenate([factors, np.tile(constant, (len(factors), 1, 1))], axis=1)
            pieces = Pieces(mechanism, mechanism.directions[0], np.zeros(1))
            # The velocities of the supports are -t before an impact and eta t after it.
            struck[d, first : factors.shape[1]] = [
                [float(pieces.momentum(pieces.dq)[0] @ mode.velocity)] * 2 for mode in push_modes
            ]
        cubics = _lines(factors) if redundant else _cubics(factors)
        rows[:, d, : factors.shape[1]] = cubics.reshape(cells, -1, 20)
        within[:, d] = _within(cubics, contacts[:, d], bearing)
        if (impact := answers[d][1]) is not None:
            struck[d, : len(impact)] = impact
        bound = mechanism.bounds[direction]
        if bound is not None and bound.restitution is not None and not redundant:
            by_stop = stop_impulses(mechanism, direction, bound)
            stopped[d, : len(by_stop)] = by_stop[:, None]
    sliding = {k for k, mode in enumerate(still.modes, joint_count) if mode.slides}
    return JointTables(
        labels, contacts, bearing, rows, struck, stopped, within, _reach(mechanism, statics), OPENING,
        not any(table.held.size for table in tables), MAX_OPENING_STEP / p, mechanism.gravity, rest, steady,
        mechanism.asserted(), sliding, redundant, _calm(within, tables, statics),
        len(mechanism.bodies()) == 1, checked_joints(mechanism), still.known,
    )  # fmt: skip


def _factors(one: Released, inertia: Reals, weight: float) -> Reals:
    """Return the factors of the forces of a direction and their compliances, shape (cells, rows, factors + 1).

    A normal force counts as compression up to a tension of `ZERO_TENSION` times the weight.
    """
    force = one.force.copy()
    force[:, [k for normal, _ in one.rows for k in normal], ONE] += ZERO_TENSION * weight
    force[:, :, RATE] /= inertia[:, None]  # phi.^2 = q.^2/I
    return np.concatenate([force, one.compliance[..., None]], axis=2)


def _at_rest(still: Rest, labels: Sequence[str], bearing: Reals, weight: float) -> tuple[Reals, tuple[float, float]]:
    """Return `rest` and `steady` of `JointTables`, and fill in the friction of joints that exist only at rest."""
    known = still.closed
    if known is None and not still.modes:
        return np.zeros((len(bearing), 3, 4)), WHOLE_RANGE
    rest, planes = np.zeros((len(bearing), 3, 4)), []
    if known is not None:
        factors = np.concatenate([known.force[0][:, [ONE, PUSH, WEIGHT]], known.compliance[0][:, None]], axis=1)
    for contact, (normal, shear) in zip(known.contacts, known.rows, strict=True) if known is not None else ():
        if shear is None:
            continue
        j = labels.index(contact.label)
        rest[j, : len(normal)] = factors[list(normal)]
        rest[j, : len(normal), 0] += ZERO_TENSION * weight
        rest[j, 2] = factors[shear]
        planes += list(rest[j, : len(normal), :3])
        if contact.friction is not None:
            bearing[j, 0] = contact.friction
            total = contact.friction * rest[j, :2, :3].sum(axis=0)
            planes += [total - rest[j, 2, :3], total + rest[j, 2, :3]]
    for j, mode in enumerate(still.modes, len(labels)):
        force = mode.force[[ONE, PUSH, WEIGHT]] + [ZERO_TENSION * weight, 0.0, 0.0]
        planes.append(force)
        if mode.opens:
            rest[j, 0] = *force, mode.compliance
            continue
        # The mechanism slides in one sense only: the large force prevents it in the other sense.
        bearing[j, 0] = 1.0
        rest[j, 0, :3] = force * [1.0, 0.0, 1.0] + [MAX_MISSING_WEIGHTS * weight, 0.0, 0.0]
        rest[j, 2] = MAX_MISSING_WEIGHTS * weight, -force[1], 0.0, mode.compliance
    plane = np.array(planes).reshape(1, -1, 3) * [1.0, 1.0, 0.0]  # v_g'' is left out, as the structure is at rest
    low, high = _range(plane, np.zeros(1))
    return rest, (float(low[0]), float(high[0]))


def _at(table: DirectionTable, cells: int) -> Reals:
    """Return the rotations at equal steps of q [rad]."""
    place = np.linspace(0.0, len(table.angles), cells + 1)
    k = np.minimum(place.astype(np.intp), len(table.angles) - 1)
    x = place - k
    a = table.angles[k]
    return np.asarray(a[:, 0] + x * (a[:, 1] + x * (a[:, 2] + x * a[:, 3])))


def _contacts(
    mechanism: Mechanism, released_sides: Sequence[Released], labels: Sequence[str], modes: Sequence[EarlyMechanism]
) -> tuple[Integers, Reals]:
    """Return `contacts` and `bearing` of `JointTables`, with rows of joints and then of mechanisms at rest."""
    count = len(labels) + len(modes)
    contacts = np.full((count, 2, 4), -1, np.int64)
    contacts[:, :, 3] = 0
    bearing = np.tile([np.nan, np.inf], (count, 1))
    points: dict[str, list[tuple[complex, ...]]] = {label: [(), ()] for label in labels}
    strength, depth, alike = mechanism.strength, mechanism.depth, mechanism.alike()
    for d, one in enumerate(released_sides):
        for contact, (normal, shear) in zip(one.contacts, one.rows, strict=True):
            if shear is None:
                continue
            j = labels.index(contact.label)
            contacts[j, d, : len(normal)] = normal
            contacts[j, d, 2] = shear
            points[contact.label][d] = contact.points
            bearing[j, 0] = np.nan if contact.friction is None else contact.friction
            if isinstance(strength, Strength) and depth is not None:
                bearing[j, 1] = strength.force(depth) * max(alike.get(name or "", 1) for name in contact.pieces)
    for j, label in enumerate(labels):
        contacts[j, :, 3] = points[label][0] != points[label][1]
    return contacts, bearing


def _cubics(values: Reals) -> Reals:
    """Return cubics through values at equidistant nodes, shape (cells, rows, columns, 4), by the four nearest nodes."""
    n = len(values)
    cubics = np.empty((n - 1, *values.shape[1:], 4))
    first = np.clip(np.arange(n - 1) - 1, 0, n - 4)
    for start in (0, 1, 2):  # position of a cell among its four nodes
        mine = np.flatnonzero(np.arange(n - 1) - first == start)
        nodes = np.arange(4.0) - start
        inverse = np.linalg.inv(np.vander(nodes, 4, increasing=True))
        cubics[mine] = np.einsum(
            "pk,ckrv->crvp", inverse, np.stack([values[first[mine] + k] for k in range(4)], axis=1)
        )
    return cubics


def _lines(values: Reals) -> Reals:
    """Return straight lines between values at equidistant nodes, in the form of `_cubics`; used for modes."""
    lines = np.zeros((len(values) - 1, *values.shape[1:], 4))
    lines[..., 0], lines[..., 1] = values[:-1], np.diff(values, axis=0)
    return lines


def _within(cubics: Reals, contacts: Integers, bearing: Reals) -> Reals:
    """Return the bounds of u_g'' and q.^2 inside which all joints of a direction hold, see `JointTables.within`.

    Each cell of the cubics is divided into `CELL_SPLITS` cells. The bounds of a cell hold at both of its ends, with a
    margin for the cubics in between.
    """
    fine = np.arange(CELL_SPLITS) / CELL_SPLITS
    powers = np.stack([np.append(fine, 1.0) ** k for k in range(4)], axis=-1)
    at = np.einsum("crvp,xp->cxrv", cubics, powers)
    nodes = np.concatenate([at[:, :-1].reshape(-1, *at.shape[2:]), at[-1:, -1]])
    planes = []  # rows of a + b u + c q.^2 >= 0
    for (one, other, shear, _), (friction, strength) in zip(contacts, bearing, strict=True):
        normals = [nodes[:, k, :3] for k in (one, other) if k >= 0]
        planes += normals
        if np.isfinite(strength):
            planes += [np.array([strength, 0.0, 0.0]) - normal for normal in normals]
        if np.isfinite(friction) and shear >= 0:
            total = friction * np.sum(normals, axis=0)
            planes += [total - nodes[:, shear, :3], total + nodes[:, shear, :3]]
    bounds = np.zeros((len(nodes) - 1, 5))
    if not planes:  # nothing to check
        bounds[:] = -np.inf, 0.0, np.inf, 0.0, np.inf
        return bounds
    plane = np.stack(planes, axis=1)
    fast = _fastest(plane)
    low, high = _range(plane, np.zeros(len(nodes)))
    low_fast, high_fast = _range(plane, fast)
    room = BOUND_MARGIN * np.minimum(high - low, 1e3)
    low, high, low_fast, high_fast = low + room, high - room, low_fast + room, high_fast - room
    fastest = np.minimum(fast[:-1], fast[1:])
    with np.errstate(divide="ignore", invalid="ignore"):
        rise, fall = (low_fast - low) / fast, (high_fast - high) / fast
    rise, fall = (np.where(np.isfinite(each), each, 0.0) for each in (rise, fall))
    bounds[:, 4] = fastest
    for column, base, slope, worse in ((0, low, rise, np.maximum), (2, high, fall, np.minimum)):
        ends = worse((base + slope * np.append(fastest, 0.0))[:-1], base[1:] + slope[1:] * fastest)
        begins = worse(base[:-1], base[1:])
        bounds[:, column] = begins
        with np.errstate(divide="ignore", invalid="ignore"):
            bounds[:, column + 1] = np.where(fastest > 0, (ends - begins) / fastest, 0.0)
    return bounds


def _calm(within: Reals, tables: Sequence[DirectionTable], statics: Sequence[Statics]) -> tuple[float, float]:
    """Return the largest u_g'' at q.^2 = 0 and the largest q.^2 at u_g'' = 0 at which all joints hold up to phi_cr.

    The pairs (u_g'', q.^2) at which the joints hold form a convex region in each cell. Therefore the joints also hold
    at every point below the straight line between these two points, see `JointTables.calm`.
    """
    push = fast = np.inf
    for d, (table, side) in enumerate(zip(tables, statics, strict=True)):
        line = within[: int(np.ceil(table.q(side.reference) / table.end * len(within))), d]
        push = min(push, -line[:, 0].max(), line[:, 2].min())
        for at, slope in ((-line[:, 0], -line[:, 1]), (line[:, 2], line[:, 3])):
            narrows = slope < 0
            fast = min(fast, np.min(at[narrows] / -slope[narrows], initial=np.inf))
        fast = min(fast, line[:, 4].min())
    return (float(push), float(fast)) if push > 0 and fast > 0 else NO_BOUNDS


def _range(plane: Reals, fast: Reals) -> tuple[Reals, Reals]:
    """Return the smallest and the largest u_g'' at which no joint fails, for given values of q.^2, shape (n,) each.

    Each row (a, b, c) of `plane` is a condition a + b u_g'' + c q.^2 >= 0.
    """
    base, push = plane[..., ONE] + plane[..., RATE] * fast[:, None], plane[..., PUSH]
    with np.errstate(divide="ignore", invalid="ignore"):
        bound = -base / push
    low = np.where(push > 0, bound, -MAX_ACCELERATION).max(axis=1, initial=-MAX_ACCELERATION)
    high = np.where(push < 0, bound, MAX_ACCELERATION).min(axis=1, initial=MAX_ACCELERATION)
    never = ((push == 0) & (base < 0)).any(axis=1)
    return np.where(never, MAX_ACCELERATION, low), np.where(never, -MAX_ACCELERATION, high)


def _fastest(plane: Reals) -> Reals:
    """Return a q.^2, halved from an estimate, at which some u_g'' meets all conditions, shape (n,); 0 if none does.

    The rows of `plane` are as in `_range`.
    """
    low, high = np.zeros(len(plane)), np.full(len(plane), 1.0)
    scale = np.abs(plane[..., ONE]).max(axis=1) / np.maximum(np.abs(plane[..., RATE]).max(axis=1), 1e-300)
    high *= np.minimum(scale, 1e12)
    for _ in range(12):
        one, other = _range(plane, high)
        low = np.where(other - one > 0, high, low)
        if (low == high).all():
            break
        high = np.where(low == high, high, (low + high) / 2)
    return low


def _reach(mechanism: Mechanism, statics: Sequence[Statics]) -> float:
    """Return D_cr, the smaller over both directions of the largest displacement of a piece up to phi_cr [m]."""
    reaches = []
    for direction, side in zip(mechanism.sides, statics, strict=True):
        bodies = {body.name: k for k, body in enumerate(mechanism.bodies())}
        motions = mechanism.motion(np.array([side.reference]), direction)
        moved = [
            abs(motions[bodies[each.of]].shifted(each.shift).carry(each.body.centroid)[0][0] - each.body.centroid)
            for each in mechanism.pieces(direction)
            if each.of is not None
        ]
        reaches.append(float(max(moved)))
    return min(reaches)


def checked_joints(mechanism: Mechanism) -> Sequence[str]:
    """Return the joints that are checked, by kind, such as "feet A, A'" and "closed joint low and high".

    Feet and hinges have the letters of drawings; joints that stay closed in both directions are named as in other
    messages, and so is a hinge without a letter.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    """
    letters: dict[str, set[str]] = {}  # letters of the hinges of each joint in drawings
    feet = set()
    for direction in mechanism.directions:
        drawn = {joint.point: joint.letter for joint in mechanism.joints(direction) if not joint.is_guide}
        for contact in mechanism.contacts(direction) or ():
            if contact.held is not None and not contact.pressed_by:
                continue
            known = letters.setdefault(contact.label, set())
            if len(contact.points) == 1 and contact.held is None:
                known.add(contact.letter or drawn.get(contact.points[0]) or contact.label)
            if None in contact.pieces:
                feet.add(contact.label)
    names: tuple[set[str], set[str], set[str]] = (set(), set(), set())
    for label, known in letters.items():
        names[2 if not known else 0 if label in feet else 1].update(known or {label})
    return [
        f"{PLACE_KINDS[k][len(each) > 1]} {in_short(sorted(each), most=MAX_LISTED_NAMES)}"
        for k, each in enumerate(names)
        if each
    ]


def laid_out(
    all_joints: Sequence[JointTables | None],
) -> tuple[Integers, Integers, Reals, Reals, Reals, Reals, Reals, Reals, Reals]:
    """Return the joints of several structures, one after the other, as the fields of `openings.Joints`."""
    counts = np.zeros((len(all_joints), 8), np.int64)
    numbers = np.ones((len(all_joints), 8))
    known = [each for each in all_joints if each is not None]
    first = rows_at = struck_at = within_at = 0
    for k, each in enumerate(all_joints):
        if each is None:
            continue
        counts[k] = (
            first, len(each.labels), each.rows.shape[2], len(each.rows), rows_at, struck_at, within_at,
            len(each.within),
        )  # fmt: skip
        numbers[k] = each.gravity, each.limit * each.reach, each.step, each.scales, *each.calm, *each.steady
        first += len(each.labels)
        rows_at += each.rows.size // openings.OF_ROW
        struck_at += each.struck.size // 2
        within_at += each.within.size // 5
    return (
        counts,
        np.concatenate([np.zeros((0, 2, 4), np.int64), *(each.contacts for each in known)]),
        np.concatenate([np.zeros((0, 2)), *(each.bearing for each in known)]),
        np.concatenate([np.zeros((0, openings.OF_ROW)), *(each.rows.reshape(-1, openings.OF_ROW) for each in known)]),
        np.concatenate([np.zeros((0, 2)), *(each.struck.reshape(-1, 2) for each in known)]),
        np.concatenate([np.zeros((0, 2)), *(each.stopped.reshape(-1, 2) for each in known)]),
        np.concatenate([np.zeros((0, 5)), *(each.within.reshape(-1, 5) for each in known)]),
        np.concatenate([np.zeros((0, 3, 4)), *(each.rest for each in known)]),
        numbers,
    )
