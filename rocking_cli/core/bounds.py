"""Rotations beyond which a structure does not move as its mechanism alone would: there it meets something."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Literal, NamedTuple

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.core.contacts import Contact
from rocking_cli.core.kinematics import Direction, RigidMotion, distance, inside, rotation
from rocking_cli.core.mechanism_kinematics import Jointed
from rocking_cli.core.polygons import convex_pieces, nearby

NODES = 65  # rotations from rest to the end of the search at which all bodies are looked at first
FINER = 33  # rotations inside an interval in which two bodies may meet
ROUNDS = 7  # refinements of an interval: its width is then below 1e-9 of the first one
SAME_MOTION = 1e-12  # difference of two motions that counts as none [rad], and over the distance to the origin
JOINT_GAP = 2e-3  # gap of a joint over width plus height of the smaller body, up to which an assembly joins them
TOUCHING = 1e-6  # distance, or depth of one body in another, over the size of the structure, that counts as touching
PATH_MARGIN = 1.25  # length of the path of a point between two rotations over the distance by its rates at both
JOINED = 0.125  # depth at half the rotation, over that at the whole: above, two bodies overlap from rest on


class Bound(NamedTuple):
    """Rotation of one direction beyond which the motion is not that of the mechanism alone.

    Parameters
    ----------
    phi : float
        The rotation [rad].
    kind : {"meets", "leans", "yields"}
        Whether two bodies, or a body and the ground, meet there, up to the critical rotation or beyond it; or a tie
        reaches its strength.
    name : str
        What is met, or the tie.
    body : str
        The body that meets it.
    at : complex
        Its point that meets a stop, at rest [m].
    restitution : float or None
        Ratio of the rates after and before, of a stop that throws the structure back; None: the model ends there.
    direction : Direction
        The direction.
    """

    phi: float
    kind: Literal["meets", "leans", "yields"]
    name: str
    body: str = ""
    at: complex = 0j
    restitution: float | None = None
    direction: Direction = Direction.POSITIVE

    @property
    def words(self) -> str:
        """What happens at the bound, a clause."""
        what = {"meets": f"{self.body} meets {self.name}", "leans": f"{self.body} leans on {self.name}"}
        return f"{what.get(self.kind, f'the tie {self.name} yields')} at {self.phi:.4g} rad"


@dataclass(frozen=True, eq=False)
class _Shape:
    """A convex part of a body or of the ground, with its place at rest [m] and its link."""

    name: str
    corners: Points
    link: int  # parts of one link do not move relative to each other; 0 is the ground

    def at(self, motions: Sequence[RigidMotion]) -> Points:
        """Return the corners over the rotations of the motions of all links, shape (n, corners) [m]."""
        motion = motions[self.link]
        return np.asarray(motion.q[:, None] + np.exp(1j * motion.psi)[:, None] * (self.corners - motion.rest))


def first_beyond(value: Callable[[Reals], Reals], low: float, high: float) -> float:
    """Return the first rotation between two at which a continuous value, positive at the second, is so.

    Parameters
    ----------
    value : callable
        Function of rotations, shape (n,) [rad].
    low, high : float
        The rotations [rad].
    """
    for _ in range(ROUNDS):
        phi = np.linspace(low, high, FINER)
        k = max(int((value(phi) > 0).argmax()), 1)
        low, high = phi[k - 1], phi[k]
    return float(high)


def meeting(mechanism: Jointed, direction: Direction, end: float) -> Bound | None:
    """Return the first rotation at which two bodies that do not touch, or a body and the ground, meet.

    Bodies that touch at rest count from where they have parted, or where they close elsewhere than at their hinge.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism; bodies without a shape, and ground that is not drawn as a polygon, are left out.
    direction : Direction
        Direction of rocking.
    end : float
        Rotation at which the search ends, below the kinematic limit [rad].
    """
    search = _Meetings(mechanism, direction, end)
    first: Bound | None = None
    for one, other in search.pairs():
        phi = search.meet(one, other, first.phi if first is not None else search.phi[-1])
        if phi is not None:
            moves, met = (one, other) if one.link else (other, one)
            first = Bound(phi, "meets", met.name, moves.name, direction=direction)
    return first


class _Meetings:
    """The search for meetings in one direction."""

    def __init__(self, mechanism: Jointed, direction: Direction, end: float) -> None:
        self.mechanism, self.direction = mechanism, direction
        self.phi = np.linspace(0.0, end, NODES)
        self.places: list[tuple[int, complex]] = []  # of each link but the ground: its body, and how far beside it
        self.links = [rotation(self.phi, 0j, 0.0)]
        self.parts = [
            _Shape(name, piece, link) for name, link, shapes in self._shapes() for z in shapes
            for piece in convex_pieces(z)
        ]  # fmt: skip
        corners = np.concatenate([part.corners for part in self.parts] or [np.zeros(1, np.complex128)])
        self.tolerance = TOUCHING * float(np.ptp(corners.real) + np.ptp(corners.imag))

    def _shapes(self) -> Iterator[tuple[str, int, Sequence[Points]]]:
        """Yield each body, and each polygon of the ground, with its link and its polygons at rest."""
        sketch, bodies = self.mechanism.sketch(), self.mechanism.bodies()
        motions = self.mechanism.motion(self.phi, self.direction)
        numbers = {body.name: k for k, body in enumerate(bodies)}
        for piece in self.mechanism.pieces(self.direction):
            body = bodies[numbers[piece.of]] if piece.of is not None else piece.body
            drawn = () if body.name in sketch.at_will else body.shapes(sketch.outlines)
            shapes = [piece.body.outline] if piece.body.outline else [np.asarray(z) + piece.shift for z in drawn]
            link = 0 if piece.of is None else self._link(motions, numbers[piece.of], piece.shift)
            yield piece.body.name, link, [np.asarray(z, np.complex128) for z in shapes]
        for name, line in zip(sketch.ground_names, sketch.ground, strict=False):
            yield name, 0, [np.asarray(line[:-1], np.complex128)]

    def _link(self, motions: Sequence[RigidMotion], body: int, shift: complex) -> int:
        """Return the link with which a body moves: one that is known, or a new one."""
        motion = motions[body].shifted(shift)
        reach = SAME_MOTION * (1 + float(np.abs(motion.q).max()))
        for k, known in enumerate(self.links):
            alike = np.abs(motion.psi - known.psi).max() <= SAME_MOTION
            if alike and np.abs(motion.carry(0j)[0] - known.carry(0j)[0]).max() <= reach:
                return k
        self.links.append(motion)
        self.places.append((body, shift))
        return len(self.links) - 1

    def pairs(self) -> Iterator[tuple[_Shape, _Shape]]:
        """Yield the parts of different links whose paths come near each other."""
        low, high = [], []
        for part in self.parts:
            z = part.at(self.links)
            room = (PATH_MARGIN * np.abs(np.diff(z, axis=0)).max() + self.tolerance) * (1 + 1j)
            low.append(complex(z.real.min(), z.imag.min()) - room)
            high.append(complex(z.real.max(), z.imag.max()) + room)
        for first, second in nearby(np.array(low), np.array(high)) if low else ():
            for i, k in zip(first.tolist(), second.tolist(), strict=True):
                if self.parts[i].link != self.parts[k].link:
                    yield self.parts[min(i, k)], self.parts[max(i, k)]

    def meet(self, one: _Shape, other: _Shape, before: float) -> float | None:
        """Return the first rotation below `before` at which two parts meet, or None."""
        touching = self._touching(one, other)
        apart, path = self._apart(one, other, self.phi, self.links)
        # Between two rotations at which they are apart, they cannot meet unless their path is as long as this.
        both = np.minimum(apart[:-1], apart[1:]) > touching
        may_meet = both & (apart[:-1] + apart[1:] < path)
        for k in np.flatnonzero((apart[1:] < -touching) | may_meet) + 1:
            low, high = self.phi[k - 1], self.phi[k]
            if low >= before:
                return None
            if apart[k] < -touching:
                free = apart[:k].max() > touching  # they were apart before
                half = np.array([high / 2])
                if not free and self._apart(one, other, half, self._motions(half))[0][0] < JOINED * apart[k]:
                    return None  # they overlap from rest on, as at a hinge that is not at a corner
                return self._first(one, other, low, high, 0.0 if free else -touching)
            if (phi := self._between(one, other, low, high)) is not None:
                return phi
        return None

    def _between(self, one: _Shape, other: _Shape, low: float, high: float) -> float | None:
        """Return the first rotation between two at which two parts that are apart at both meet, or None."""
        phi = np.linspace(low, high, FINER)
        apart, path = self._apart(one, other, phi, self._motions(phi))
        for k in range(1, FINER):
            if apart[k] < 0:
                return self._first(one, other, phi[k - 1], phi[k], 0.0)
            if apart[k - 1] + apart[k] < path[k - 1] and path[k - 1] > self.tolerance:
                phi_met = self._between(one, other, phi[k - 1], phi[k])
                if phi_met is not None:
                    return phi_met
        return None

    def _first(self, one: _Shape, other: _Shape, low: float, high: float, level: float) -> float:
        """Return the rotation at which the distance of two parts falls below a level, between two rotations."""
        return first_beyond(lambda phi: level - self._apart(one, other, phi, self._motions(phi))[0], low, high)

    def _motions(self, phi: Reals) -> list[RigidMotion]:
        """Return the motion of each link over other rotations."""
        motions = self.mechanism.motion(phi, self.direction)
        return [rotation(phi, 0j, 0.0), *(motions[body].shifted(shift) for body, shift in self.places)]

    def _touching(self, one: _Shape, other: _Shape) -> float:
        """Return the distance up to which two parts touch [m]: more if they are joined, as joints may be open."""
        least = JOINT_GAP * min(float(np.ptp(z.real) + np.ptp(z.imag)) for z in (one.corners, other.corners))
        names = {part.name if part.link else None for part in (one, other)}
        ground = next((part.corners for part in (one, other) if not part.link), None)
        for contact in self._contacts:
            if set(contact.pieces) == names:
                below = np.array(contact.points) - 2 * least * contact.normal
                if ground is None or (inside(below, ground) | (distance(below, ground) <= self.tolerance)).all():
                    return max(least, self.tolerance)
        return self.tolerance

    @cached_property
    def _contacts(self) -> Sequence[Contact]:
        return [
            contact for direction in self.mechanism.directions for contact in self.mechanism.contacts(direction) or ()
        ]

    def _apart(self, one: _Shape, other: _Shape, phi: Reals, motions: Sequence[RigidMotion]) -> tuple[Reals, Reals]:
        """Return how far two parts are apart over rotations, negative if they overlap, and their paths in between.

        The distance is along the best of the normals of their sides: where it is positive, they do not overlap, and it
        changes by no more than the parts move relative to each other.
        """
        a, b = one.at(motions), other.at(motions)
        apart = np.maximum(_beside(a, b), _beside(b, a))
        path = sum(PATH_MARGIN * np.abs(np.diff(z, axis=0)).max(axis=1) for z in (a, b))
        return apart, np.asarray(path)


def _beside(a: Points, b: Points) -> Reals:
    """Return the largest distance of polygons b from sides of convex polygons a, shape (n,); a is anticlockwise."""
    side = np.roll(a, -1, axis=1) - a
    outward = -1j * side / np.abs(side)
    off = (outward.conj()[:, :, None] * (b[:, None, :] - a[:, :, None])).real
    return np.asarray(off.min(axis=2).max(axis=1))


class Clearance(NamedTuple):
    """How far a body at rest may slide one way [m], infinite if nothing is there, and what it reaches then.

    `edge` is whether it reaches the edge of ground that has this name, and otherwise meets what has it.
    """

    distance: float
    name: str
    edge: bool = False

    @property
    def words(self) -> str:
        """What it reaches, in words."""
        return f"the edge of {self.name}" if self.edge else self.name


def clearances(mechanism: Jointed, left: complex, right: complex) -> tuple[Clearance, Clearance]:
    """Return how far a single body at rest may slide to the left and to the right on its level foot.

    It may slide until it meets something, such as a stop, or until an end of its foot passes the edge of the ground,
    if this is drawn.

    Parameters
    ----------
    mechanism : Mechanism
        A structure of one body.
    left, right : complex
        Ends of its foot [m].
    """
    direction = mechanism.directions[0]
    search = _Meetings(mechanism, direction, mechanism.limit(direction) / 2)
    still, moving = ([part for part in search.parts if (part.link > 0) is moves] for moves in (False, True))
    size = float(np.ptp(np.concatenate([np.array([left, right]), *(part.corners for part in moving)]).real))
    touching = max(JOINT_GAP * size, search.tolerance)
    clear = [list(_edges(still, (left, right), touching)), list(_edges(still, (left, right), touching, right=True))]
    for one in moving:
        for other in still:
            y = _heights(one.corners, other.corners)
            if np.ptp(y) <= search.tolerance:
                continue
            (from_, to), (begins, ends) = _spans(one.corners, y), _spans(other.corners, y)
            for side, gap in enumerate((float((from_ - ends).min()), float((begins - to).min()))):
                if gap > -touching:
                    clear[side].append(Clearance(max(gap, 0.0), other.name))
    for stop in mechanism.stops or ():
        clear[stop.gap > 0].append(Clearance(abs(stop.gap), stop.name))
    before, after = (min(each, default=Clearance(inf, "")) for each in clear)
    return before, after


def _edges(
    still: Sequence[_Shape], foot: tuple[complex, complex], touching: float, *, right: bool = False
) -> Iterator[Clearance]:
    """Yield how far a foot may slide one way to the edge of the ground on which it stands; nothing if it is not drawn.

    Level tops that touch each other are one.
    """
    sign, level = 1 if right else -1, foot[0].imag
    tops = []
    for part in still:
        x = part.corners.real[abs(part.corners.imag - level) <= touching]
        if x.size > 1 and part.corners.imag.max() <= level + touching:
            tops.append((float((sign * x).min()), float((sign * x).max()), part.name))
    end = sign * foot[right].real
    reach, name = end, ""
    for first, last, of in sorted(tops):
        if first <= reach + touching and last >= end - touching and last >= reach - touching:
            reach, name = max(last, reach), of
    if name:
        yield Clearance(reach - end, name, edge=True)


def _heights(one: Points, other: Points) -> Reals:
    """Return the heights at which convex polygons may meet first as one moves sideways: none if one is above."""
    y = np.concatenate([one.imag, other.imag])
    low, high = max(one.imag.min(), other.imag.min()), min(one.imag.max(), other.imag.max())
    return np.append(y[(y >= low) & (y <= high)], [low, high]) if low < high else np.zeros(1)


def _spans(z: Points, y: Reals) -> tuple[Reals, Reals]:
    """Return where a convex polygon begins and ends at each of some heights within it [m]."""
    a, b = z, np.roll(z, -1)
    crossed = (np.minimum(a.imag, b.imag) <= y[:, None]) & (y[:, None] <= np.maximum(a.imag, b.imag))
    rise = np.where(a.imag == b.imag, inf, b.imag - a.imag)  # a level side begins at a
    x = a.real + (y[:, None] - a.imag) / rise * (b.real - a.real)
    return np.where(crossed, x, inf).min(axis=1), np.where(crossed, x, -inf).max(axis=1)
