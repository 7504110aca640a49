"""Modes in which redundant joints open, where statics alone does not determine the forces.

At each rotation, consider the pairs of ground acceleration u_g'' and squared rotation rate phi.^2 at which the joints
can balance the loads, inertia included. These pairs form a convex set, the admissible set. Each edge of this set
belongs to a mode: a motion of the pieces that opens joints and closes none. Beyond the edge, the loads do positive work
on the mode, and the joints open. A mode is then treated like a single joint whose forces statics determines: with all
other joints closed, its opening accelerates by 1/(xi.M xi) times the work that the joints cannot balance. Here xi are
the velocities of the pieces in the mode, for an opening velocity of 1, and M is the mass matrix.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Points, Reals
from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.contacts import Contact
from rocking_cli.core.kinematics import GROUND, Rates
from rocking_cli.core.released import ONE, PUSH, RATE, Pieces, Released

if TYPE_CHECKING:
    from scipy.sparse import csr_array as Sparse

Integers = NDArray[np.intp]
EDGE_ROTATIONS = 5  # rotations up to phi_cr at which edges are searched
FIRST_DIRECTIONS = 8  # first search directions; more follow between corners
MAX_CORNERS = 24  # corners of the admissible set
MAX_SEARCHED = 30.0  # search bounds, over the uplift acceleration and the square of the fastest rate
ZERO_VELOCITY = 1e-6  # velocity that counts as zero, over the largest velocity at a joint
RANK_TOLERANCE = 1e-7  # singular value that counts as zero, over the largest one
MAX_THROWN_MODES = 6  # largest number of modes of a single impact
CLOSING_TOLERANCE = 1e-5  # closing velocity that counts as zero, over the largest velocity at a joint
ZERO_FACTOR = 1e-14  # factor that counts as zero, over the largest factor
MAX_PROGRAMME_FORCE = (
    1e5  # bound on forces over their scale: with larger ones, the solver's absolute tolerances are too coarse
)
ZERO_CROSS = 1e-12  # cross product of two lines that count as parallel
EQUAL_CORNERS = 1e-6  # distance of corners that coincide, over the size of the admissible set
MIN_SINE_SQUARED = 1e-6  # squared sine of the least angle between two different directions
MIN_DISTANCE_SQUARED = 1e-10  # squared distance over squared arms from which lines of action have no common point


class Pattern(NamedTuple):
    """The components of joint velocities that are zero in a mode, by which modes at different rotations are recognised.

    Parameters
    ----------
    slips : tuple of int
        For each contact, the sign of its sliding velocity; 0 if it does not slide.
    shut : tuple of tuple of bool
        For each contact, whether each of its ends stays closed.
    """

    slips: tuple[int, ...]
    shut: tuple[tuple[bool, ...], ...]


class Modes(NamedTuple):
    """The modes of one direction over rotations, as rows of `Released`.

    Parameters
    ----------
    released : Released
        A contact and a row for each mode.
    struck : ndarray, shape (modes, 2), or None
        Impulse of each mode at an impact that begins the direction, over the rotation rate before; see `impulses`.
    """

    released: Released
    struck: Reals | None


def modes(mechanism: Mechanism, direction: Direction, phi: Reals, critical: float) -> Modes:
    """Find the modes in which the joints of a direction open.

    Parameters
    ----------
    mechanism : Mechanism
        A structure with redundant joints.
    direction : Direction
        Direction of rocking.
    phi : ndarray, shape (n,)
        Rotations of the tables [rad].
    critical : float
        Largest rotation at which modes are sought [rad].
    """
    contacts = mechanism.contacts(direction) or ()
    there = _Placed(mechanism, direction, contacts, phi)
    within = np.flatnonzero(phi <= critical * (1 + ZERO_VELOCITY))
    places = np.unique(within[np.linspace(0, within.size - 1, EDGE_ROTATIONS).astype(np.intp)])
    push = mechanism.uplift(direction) * mechanism.gravity
    fast = 2 * mechanism.potential_energy(np.array([critical]), direction)[0]
    fast /= float(mechanism.kinetic_inertia(np.zeros(1), direction)[0])
    known: dict[Pattern, _Followed | None] = {}

    def follow(velocity: Reals, k: int) -> None:
        pattern = there.pattern(velocity, k)
        if pattern not in known:
            known[pattern] = there.followed(pattern)

    for k in places:
        for velocity in _edges(there, int(k), np.array([push, fast]), known):
            follow(velocity, int(k))
    jump = there.jump(mechanism)
    for velocity in _thrown(there, jump) if jump is not None else ():
        follow(velocity, 0)
    existing = [mode for mode in known.values() if mode is not None]
    labels = [Contact((None, None), (0j,), name=there.label(mode)) for mode in existing]
    names: dict[str, int] = {}
    for k, label in enumerate(labels):  # number modes that open the same joint most
        names[label.name] = names.get(label.name, 0) + 1
        again = f" ({names[label.name]})" if names[label.name] > 1 else ""
        labels[k] = Contact((None, None), (0j,), name=f"{label.name}{again}")
    force = np.stack([mode.force for mode in existing], axis=1) if existing else np.zeros((phi.size, 0, 4))
    compliance = np.stack([mode.compliance for mode in existing], axis=1) if existing else np.zeros((phi.size, 0))
    struck = None
    if jump is not None:  # a mode that does not exist at rest has no impulse
        struck = np.array([mode.velocity[0] @ jump * mode.exists[0] for mode in existing]).reshape(-1, 2)
    rows: list[tuple[tuple[int, ...], int | None]] = [((k,), k) for k in range(len(existing))]
    return Modes(Released(labels, rows, force, compliance), struck)


class _Followed(NamedTuple):
    """One mode at all n rotations of the tables, for an opening velocity of 1.

    Parameters
    ----------
    velocity : ndarray, shape (n, coordinates)
        Velocities of all pieces; meaningless at rotations where the mode does not exist.
    force : ndarray, shape (n, 4)
        Work of the required joint forces on the mode: its coefficients of 1, u_g'', phi.^2 and v_g''.
    compliance : ndarray, shape (n,)
        Acceleration of the opening, divided by the missing work.
    exists : ndarray of bool, shape (n,)
        Whether the mode is a motion that closes no joint.
    """

    velocity: Reals
    force: Reals
    compliance: Reals
    exists: Bools


class _Placed:
    """Velocities at the contacts of a direction, and the forces required there, over rotations."""

    def __init__(self, mechanism: Mechanism, direction: Direction, contacts: Sequence[Contact], phi: Reals) -> None:
        self._direction, self.contacts = direction, contacts
        self.pieces = Pieces(mechanism, direction, phi)
        self.rates, self.rows = self.pieces.rates(contacts)
        self.demand = self.pieces.demands()
        self._rocking = self.pieces.momentum(self.pieces.dq)
        self._centres, self._turned = self.pieces.centres(), self.pieces.turned()
        count = len(self.rates.pieces)
        self.one_sided = np.zeros(count, bool)
        self.shear = np.full(count, -1)  # for each row, the shear row of its contact if it may slide
        self.friction = np.zeros(count)  # coefficient of friction of that contact
        for contact, (normal, shear) in zip(contacts, self.rows, strict=True):
            self.one_sided[list(normal)] = True
            if shear is not None and contact.friction is not None:
                self.shear[[*normal, shear]] = shear
                self.friction[[*normal, shear]] = contact.friction

    def rays(self, k: int) -> tuple[Sparse, int]:
        """Return the extreme forces that joints can exert at rotation `k`, and the number of those that press.

        Those that press come first. With friction, the two extreme forces of a contact are inclined to either side of
        its normal. Each row has the velocities on which a force does work, in the axes of `sparse`.
        """
        from scipy.sparse import vstack

        rates = self.sparse(k)
        leans = self.one_sided & (self.friction > 0)
        shears = rates[self.shear[leans]].multiply(self.friction[leans][:, None])
        presses = [rates[self.one_sided & ~leans], rates[leans] + shears, rates[leans] - shears]
        all_rays = vstack([*presses, rates[~self.one_sided & (self.shear < 0)]], format="csr")
        return all_rays, sum(each.shape[0] for each in presses)

    def sparse(self, k: int) -> Sparse:
        """Return the velocities at the contacts at rotation `k` as a sparse matrix, shape (rows, coordinates).

        The velocities of each piece are expressed in axes that turn with the piece. In these axes, most contact faces
        keep their direction at rest and have a single non-zero factor, which makes linear programmes faster.
        """
        from scipy.sparse import csr_array

        row, side = np.nonzero(self.rates.pieces != GROUND)
        piece, factors = self.rates.pieces[row, side], self.rates.factors[k, row, side]
        values = _turn(factors, self._turned[k, piece].conj())
        values[np.abs(values) <= ZERO_FACTOR * np.abs(values).max(initial=0.0)] = 0.0
        columns = 3 * piece[:, None] + np.arange(3)
        places = np.repeat(row, 3), columns.ravel()
        matrix = csr_array((values.ravel(), places), shape=(len(self.one_sided), 3 * self.rates.count))
        matrix.eliminate_zeros()
        return matrix

    def turned(self, vectors: Reals, k: int, sense: int) -> Reals:
        """Return vectors of all coordinates, shape (coordinates, ...), in the axes of `sparse`; back if sense is -1."""
        each = np.moveaxis(vectors.reshape(self.rates.count, 3, -1), 1, 2)
        turns = self._turned[k] if sense < 0 else self._turned[k].conj()
        return np.moveaxis(_turn(each, turns[:, None]), 2, 1).reshape(vectors.shape)

    def label(self, mode: _Followed) -> str:
        """Return the name of the contact that a mode opens most, at the first rotation where the mode exists."""
        first = int(np.argmax(mode.exists))
        speed = np.abs(self.rates.rotations([first]).at(mode.velocity[first][None])[0])
        speeds = [max((speed[row] for row in (*normal, *([] if shear is None else [shear]))), default=0.0)
                for normal, shear in self.rows]  # fmt: skip
        # Choose the first of several contacts that open equally fast.
        return self.contacts[int(np.argmax(np.array(speeds) >= (1 - ZERO_VELOCITY) * max(speeds)))].label

    def jump(self, mechanism: Mechanism) -> Reals | None:
        """Return the change of momentum at an impact, over the rate before: a constant, and the factor of eta."""
        if not mechanism.rocks_both_ways:
            return None
        old = Pieces(mechanism, self._direction.opposite, np.zeros(1))
        return np.stack([old.momentum(old.dq)[0], self._rocking[0]], axis=-1)

    def pattern(self, velocity: Reals, k: int) -> Pattern:
        """Return the pattern of a mode at rotation `k`: which rows have no motion."""
        speed = self.rates.rotations([k]).at(velocity[None])[0]
        still = ZERO_VELOCITY * float(np.abs(speed).max())
        slip = np.where((self.shear >= 0) & (np.abs(speed[self.shear]) > still), speed[self.shear], 0.0)
        sense = np.sign(slip).astype(int)
        shut = speed - np.abs(slip) * self.friction <= still
        return Pattern(
            tuple(0 if shear is None else int(sense[shear]) for _, shear in self.rows),
            tuple(tuple(bool(shut[row]) for row in normal) for normal, _ in self.rows),
        )

    def held(self, pattern: Pattern, *, dilates: bool) -> Rates:
        """Return the rows in which a mode has no motion; if `dilates`, slip opens a joint by friction times slip."""
        kept = np.ones(len(self.one_sided), bool)
        factors = self.rates.factors
        for contact, (normal, shear), slip, shut in zip(
            self.contacts, self.rows, pattern.slips, pattern.shut, strict=True
        ):
            kept[list(normal)] = shut
            if not slip or shear is None:
                continue
            kept[shear] = False
            if dilates and contact.friction:
                factors = factors.copy() if factors is self.rates.factors else factors
                factors[:, list(normal)] -= slip * contact.friction * self.rates.factors[:, [shear]]
        return Rates(self.rates.count, self.rates.pieces, factors).rows(kept)

    def followed(self, pattern: Pattern) -> _Followed | None:
        """Return the mode of a pattern over all rotations; None if it is not unique at rest, or exists nowhere."""
        alone = self._alone(pattern, dilates=True)
        if alone is None:
            return None
        velocity, moves = alone
        speed = self.rates.at(velocity)
        opens = speed[:, self.one_sided]
        sign = np.where(opens.max(axis=1, initial=0) >= -opens.min(axis=1, initial=0), 1.0, -1.0)
        factor = sign / np.abs(speed).max(axis=1)
        velocity, speed = velocity * factor[:, None], speed * factor[:, None]
        exists = moves & self._closes_nothing(speed)
        if not exists.any():
            return None
        force = np.einsum("nc,ncf->nf", velocity, self.demand)
        force[~exists] = 0.0
        force[~exists, ONE] = np.abs(self.demand[0, :, ONE]).sum()  # a force so large that the joint never opens there
        plain = velocity
        if any(pattern.slips):  # sliding joints do not dilate as the motion continues
            without = self._alone(pattern, dilates=False)
            if without is not None:
                plain = without[0] / np.abs(self.rates.at(without[0])).max(axis=1)[:, None]
        moving = self.pieces.momentum(plain)
        return _Followed(velocity, force, 1 / np.einsum("nc,nc->n", plain, moving), exists)

    def _closes_nothing(self, speed: Reals) -> Bools:
        """Return whether no joint closes, or slides without dilating, at each rotation, shape (n,)."""
        least = np.where(self.shear >= 0, self.friction * np.abs(speed[:, self.shear]), 0.0) - CLOSING_TOLERANCE
        return np.asarray((speed >= least)[:, self.one_sided].all(axis=1))

    def _alone(self, pattern: Pattern, *, dilates: bool) -> tuple[Reals, Bools] | None:
        """Return the single motion, beside rocking, in which a pattern's rows have no velocity; None if not unique.

        Velocities have the shape (n, coordinates). The flags are False at rotations without such a motion, or with
        several; there the velocities are those of the last rotation with one.
        """
        held = self.held(pattern, dilates=dilates)
        one = stuck(held, self._centres)
        if not one.count:
            return None
        scale = self.pieces.scale[: 3 * one.count]
        rocking = one.gathered(self._rocking) / scale
        rocking /= np.linalg.norm(rocking, axis=1, keepdims=True)
        matrix = np.concatenate([one.contracted(held).dense() / scale, rocking[:, None, :]], axis=1)
        at_rest = _values(np.linalg.svd(matrix[0], compute_uv=False), matrix)
        if at_rest[-2] < RANK_TOLERANCE * at_rest[0]:  # the motion at rest is not unique, as with most patterns
            return None
        _, s, vt = np.linalg.svd(matrix, full_matrices=matrix.shape[1] < matrix.shape[2])
        padded = _values(s, matrix)
        motion = one.spread(vt[:, -1] / scale)
        flips = np.sign(np.einsum("nc,nc->n", motion[1:], motion[:-1]))
        motion[1:] *= np.cumprod(np.where(flips == 0, 1.0, flips))[:, None]
        # At rotations where the motion is not unique, or does not exist, use the last one before.
        good = (padded[:, -2] >= RANK_TOLERANCE * padded[:, 0]) & (padded[:, -1] <= ZERO_VELOCITY * padded[:, 0])
        last = np.maximum.accumulate(np.where(good, np.arange(len(good)), 0))
        return motion[last], good


def _turn(vectors: Reals, by: Points) -> Reals:
    """Return vectors (x, y, rotation), shape (..., 3), with x and y multiplied as x + iy by unit numbers."""
    across = (vectors[..., 0] + 1j * vectors[..., 1]) * by
    return np.stack([across.real, across.imag, vectors[..., 2]], axis=-1)


def _values(singular: Reals, matrix: Reals) -> Reals:
    """Return the singular values of a matrix, with zeros appended up to its number of columns."""
    missing = matrix.shape[-1] - singular.shape[-1]
    return np.concatenate([singular, np.zeros((*singular.shape[:-1], missing))], axis=-1)


def _edges(there: _Placed, k: int, unit: Reals, known: Mapping[Pattern, _Followed | None]) -> Iterator[Reals]:
    """Yield a mode for each edge of the admissible set of (u_g'', phi.^2) at rotation `k`.

    The set is a convex polygon, see the module. The search finds its farthest point, a corner, in a number of
    directions; after each new corner, it also searches perpendicular to the lines from that corner to its neighbours.
    Directions in which the `known` modes already bound the set are skipped; the caller may add each yielded mode to
    `known` at once.

    Parameters
    ----------
    there : _Placed
        Contacts and required forces of the direction.
    k : int
        Index of the rotation.
    unit : ndarray, shape (2,)
        Values of u_g'' and phi.^2 by which both are divided in the search.
    known : mapping of Pattern to _Followed or None
        The modes found so far; None for patterns that are no mode.
    """
    corners: list[tuple[float, Reals]] = []  # search direction and position of each corner
    angles = [2 * np.pi * i / FIRST_DIRECTIONS for i in range(FIRST_DIRECTIONS)]
    while angles:
        angle = angles.pop()
        along = np.array([np.cos(angle), np.sin(angle)])
        if corners and _farthest(along, _lines(known, k, unit)) <= max(at @ along for _, at in corners) + EQUAL_CORNERS:
            continue  # the known modes allow nothing beyond that corner
        solved = _corner(there, k, along / unit, unit)
        if solved is None:
            continue
        place, velocity = solved
        if velocity is not None:
            yield velocity
        if any(np.abs(place - other).max() <= EQUAL_CORNERS for _, other in corners) or len(corners) >= MAX_CORNERS:
            continue
        corners.append((angle, place))
        middle = np.mean([each for _, each in corners], axis=0)
        corners.sort(key=lambda corner: float(np.arctan2(*(corner[1] - middle)[::-1])))
        at = next(i for i, (_, other) in enumerate(corners) if other is place)
        for one, other in ((corners[at - 1][1], place), (place, corners[(at + 1) % len(corners)][1])):
            side = other - one
            if np.abs(side).max() > EQUAL_CORNERS:
                angles.append(float(np.arctan2(-side[0], side[1])))


def _lines(known: Mapping[Pattern, _Followed | None], k: int, unit: Reals) -> Reals:
    """Return straight lines that bound the admissible set at rotation `k`: those of known modes, and the search limits.

    Each row (a, b, c) stands for a + b x + c y >= 0, where x and y are u_g'' and phi.^2, each divided by its `unit`.
    """
    rows = [each.force[k, [ONE, PUSH, RATE]] * [1.0, *unit] for each in known.values() if each is not None]
    lines = np.array(
        [[MAX_SEARCHED, 1.0, 0.0], [MAX_SEARCHED, -1.0, 0.0], [0.0, 0.0, 1.0], [MAX_SEARCHED, 0.0, -1.0], *rows]
    )
    steep = np.abs(lines[:, 1:]).max(axis=1)
    return np.asarray((lines / np.where(steep > 0, steep, 1.0)[:, None])[steep > 0])


def _farthest(along: Reals, lines: Reals) -> float:
    """Return the largest extent along a direction within the bounds; infinity if they leave no point."""
    one, other = np.triu_indices(len(lines), 1)
    crossings = np.cross(lines[one], lines[other])  # a + b x + c y as a product with (1, x, y)
    meet = np.abs(crossings[:, 0]) > ZERO_CROSS
    points = crossings[meet] / crossings[meet, :1]
    inside = (points @ lines.T >= -EQUAL_CORNERS * (1 + np.abs(lines[:, 0]))).all(axis=1)
    return float((points[inside, 1:] @ along).max(initial=-np.inf)) if inside.any() else np.inf


def _corner(there: _Placed, k: int, along: Reals, unit: Reals) -> tuple[Reals, Reals | None] | None:
    """Return the farthest point of the admissible set in one direction, and the mode that opens there.

    A linear programme finds the point (u_g'', phi.^2), divided by `unit`; the mode is its dual solution. The result is
    None if the programme has no solution, and the mode is None if only the limits of the search bound the set there.
    """
    from scipy.optimize import linprog  # slow to import, and only redundant joints need it
    from scipy.sparse import coo_array, hstack

    (rays, press), demand, scale = there.rays(k), there.turned(there.demand[k], k, 1), there.pieces.scale
    count, unit_force = rays.shape[0], float(np.abs(demand[:, ONE]).max()) / MAX_PROGRAMME_FORCE
    rays.data = rays.data / scale[rays.indices] * MAX_PROGRAMME_FORCE
    demand = demand / unit_force
    pushed = -demand[:, [PUSH, RATE]] * unit / scale[:, None]
    low = np.where(np.arange(count) < press, 0.0, -np.inf)
    solved = linprog(
        np.append(np.zeros(count), -along * unit), A_eq=hstack([rays.T, coo_array(pushed)], format="csc"),
        b_eq=demand[:, ONE] / scale,
        bounds=[*((each, None) for each in low), (-MAX_SEARCHED, MAX_SEARCHED), (0.0, MAX_SEARCHED)],
        method="highs-ds",
    )  # fmt: skip
    if solved.status != 0:
        return None
    place = np.asarray(solved.x[count:])
    velocity = -np.asarray(solved.eqlin.marginals) / scale
    constant, *others = velocity @ demand[:, [ONE, PUSH, RATE]] * np.array([1.0, *unit])
    # If these values are zero but for rounding, a bound of the search limits the point, and no mode does.
    bounds_it = np.abs(others).max() > ZERO_VELOCITY
    at_edge = abs(constant + others @ place) <= EQUAL_CORNERS * float(np.abs(velocity) @ np.abs(demand[:, ONE]) or 1.0)
    return place, there.turned(velocity / unit_force, k, -1) if bounds_it and at_edge else None


def _thrown(there: _Placed, jump: Reals) -> Iterator[Reals]:
    """Yield the modes on which the impulses of an impact do work, the one with the most work first."""
    from scipy.optimize import linprog  # slow to import, and only redundant joints need it
    from scipy.sparse import csr_array, vstack

    (rays, press), rates, scale = there.rays(0), there.sparse(0), there.pieces.scale
    total = jump.sum(axis=1)  # impulses without any loss of rate, which open joints the most
    normals = rates[there.one_sided]

    def scaled(rows: Sparse) -> Sparse:
        copy = csr_array(rows)
        copy.data = copy.data / scale[copy.indices]
        return copy

    def row(values: Reals) -> Sparse:
        return csr_array(values[None])

    above = scaled(vstack([-rays[:press], row(np.asarray(normals.sum(axis=0)))]))
    bounds = np.append(np.zeros(press), 1.0)
    held = vstack([rays[press:], row(there.pieces.momentum(there.pieces.dq)[0])])
    for _ in range(MAX_THROWN_MODES):
        solved = linprog(
            total / scale, A_ub=above, b_ub=bounds, A_eq=scaled(held),
            b_eq=np.zeros(held.shape[0]), bounds=(None, None), method="highs-ds",
        )  # fmt: skip
        if solved.status != 0 or solved.fun > -ZERO_VELOCITY * float(np.abs(total / scale).max()):
            return
        velocity = np.asarray(solved.x) / scale
        yield velocity
        held = vstack([held, normals[[int(np.argmax(normals @ velocity))]]])  # the next mode keeps that end closed


@dataclass(frozen=True, eq=False)
class Stuck:
    """Pieces joined to rigid parts because they cannot move relative to one another in a mode, at n rotations.

    Parameters
    ----------
    count : int
        Number of parts that are not stuck to the ground.
    part : ndarray of int, shape (pieces,)
        The part of each piece, -1 for pieces fixed to the ground.
    arm : ndarray of complex, shape (n, pieces)
        From the reference point of its part to the centroid of each piece [m].
    """

    count: int
    part: Integers
    arm: Points

    def spread(self, parts: Reals) -> Reals:
        """Return the velocities of the pieces, shape (n, 3 pieces), from those of the parts, shape (n, 3 parts)."""
        n = len(parts)
        moved = np.concatenate([parts.reshape(n, self.count, 3), np.zeros((n, 1, 3))], axis=1)[:, self.part]
        x, y, turn = np.moveaxis(moved, 2, 0)
        return np.stack([x - turn * self.arm.imag, y + turn * self.arm.real, turn], axis=2).reshape(n, -1)

    def gathered(self, pieces: Reals) -> Reals:
        """Return the momenta of the parts, shape (n, 3 parts), from those of the pieces, shape (n, 3 pieces)."""
        n = len(pieces)
        momenta = np.zeros((n, self.count + 1, 3))
        each = _about(pieces.reshape(n, -1, 3), self.arm)
        for k, part in enumerate(self.part):
            momenta[:, part] += each[:, k]
        return momenta[:, :-1].reshape(n, -1)

    def contracted(self, rates: Rates) -> Rates:
        """Return the rates as functions of the velocities of the parts.

        Rows between two pieces of the same part are left out, because they are always zero.
        """
        part = np.append(self.part, GROUND)[rates.pieces]
        apart = np.flatnonzero(part[:, 0] != part[:, 1])
        arm = np.where(part == GROUND, 0j, np.append(self.arm, np.zeros_like(self.arm[:, :1]), axis=1)[:, rates.pieces])
        factors = np.where(part[..., None] == GROUND, 0.0, _about(rates.factors, arm))
        return Rates(self.count, part[apart], factors[:, apart])


def _about(force: Reals, arm: Points) -> Reals:
    """Return forces and moments, shape (..., 3), about points at the distance `arm` from their points of action."""
    x, y, moment = np.moveaxis(force, -1, 0)
    return np.stack([x, y, moment + arm.real * y - arm.imag * x], axis=-1)


def stuck(held: Rates, centres: Points) -> Stuck:
    """Join the pieces among which the given rows, whose velocities are zero, allow no relative motion.

    Fewer unknowns are left. Two parts are joined if the rows between them allow no relative motion at any rotation,
    until no more can be joined. Joining fewer parts than possible costs time, but is never wrong.

    Parameters
    ----------
    held : Rates
        Rows whose velocities are zero.
    centres : ndarray of complex, shape (n, pieces)
        Centroids of the pieces [m].
    """
    from scipy.sparse import coo_array  # slow to import, and only redundant joints need it
    from scipy.sparse.csgraph import connected_components

    count = held.count
    ends = np.where(held.pieces == GROUND, count, held.pieces)  # the ground has the last number
    first = np.where(ends[:, 0] == count, 1, 0)  # for each row, a side that is a piece and not the ground
    row = np.arange(len(ends))
    wrench, place = held.factors[:, row, first], centres[:, np.minimum(ends[row, first], count - 1)]
    label = np.arange(count + 1)
    while True:
        low, high = np.sort(label[ends], axis=1).T
        apart = np.flatnonzero(low != high)
        pairs, first, number = np.unique(
            np.array([low[apart], high[apart]]), axis=1, return_index=True, return_inverse=True
        )
        # Take wrenches about one point for each pair, near its joints.
        number = number.ravel()
        about = _about(wrench[:, apart], place[:, apart] - place[:, apart[first[number]]])
        joined = pairs[:, _leave_nothing(number, about)]
        if not joined.size:
            break
        graph = coo_array((np.ones(joined.shape[1]), (joined[0], joined[1])), shape=(count + 1, count + 1))
        label = connected_components(graph, directed=False)[1][label]
    free = label[:-1] != label[-1]
    _, leader, part_of_free = np.unique(label[:-1][free], return_index=True, return_inverse=True)
    part = np.full(count, GROUND, np.intp)
    part[free] = part_of_free
    reference = np.append(centres[:, free][:, leader], np.zeros_like(centres[:, :1]), axis=1)
    return Stuck(len(leader), part, centres - reference[:, part])


def _leave_nothing(number: Integers, wrench: Reals) -> Bools:
    """Return which pairs of parts have no relative motion: their wrenches span two translations and a rotation."""
    order = np.argsort(number, kind="stable")
    starts = np.flatnonzero(np.diff(number[order], prepend=-1))
    each = np.moveaxis(wrench[:, order], 1, 0)
    gram = np.add.reduceat(each[..., :, None] * each[..., None, :], starts, axis=0)
    xx, yy, xy = gram[..., 0, 0], gram[..., 1, 1], gram[..., 0, 1]
    across = xx * yy - xy**2
    two = across > MIN_SINE_SQUARED * (xx + yy) ** 2
    mx, my, mm = gram[..., 0, 2], gram[..., 1, 2], gram[..., 2, 2]
    left = mm - (mx**2 * yy + my**2 * xx - 2 * mx * my * xy) / np.where(two, across, 1.0)
    return np.asarray((two & (left > MIN_DISTANCE_SQUARED * mm)).all(axis=1))
