"""A structure as free blocks: its rigid pieces, what does not move, and all that holds the pieces besides contact.

The engine of free blocks simulates these. What it cannot simulate is refused here, by name.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import inf, nan, sqrt
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.core import Body, Contact, Direction, Mechanism, PointMass, Spot, of_joints
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.hung.element import ConstantForce, Element, Spring, SteelBar
from rocking_cli.core.kinematics import area_of, distance
from rocking_cli.core.polygons import convex_pieces
from rocking_cli.errors import InputError, MechanismError, Problem
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.hung import walls
from rocking_cli.studies.picture import box_around, picture

FALL = 0.15  # of the structure's height: a block that falls by it has collapsed
TURN = 0.8  # rad: a block that turns by it has collapsed
COLLAPSE = f"a block falls by {FALL:g} of the structure's height, or turns by {TURN:g} rad"
NEAR_SHARE = 1e-6  # distance that counts as zero, over the size of the structure
LEAD_RATE = 1e-6  # difference of a rate of turning from that of phi that counts as zero
LEAD_SHARE = 0.5  # of the limit of the rotation, at which the body that leads still turns by phi
SAME_TURN = 1e-6  # turn from one normal to another that counts as none
FLAT_SHARE = 1e-6  # length of a foot, over the size of the structure, below which it is a point
FARTHEST_GROUND = (
    100.0  # over the size of the structure: how far ground without an edge reaches beside ground at another level
)
NEARBY = 2.0  # over the size of the structure: how far beside and below it ground is a piece of its own
LEVEL_SHARE = 2e-3  # distance of a foot from what it rests on, over its length, that counts as zero
STEEPEST = 0.5  # sine of the slope of a face, measured from upright, up to which nothing rests on it
THE_GROUND = "the ground"  # its name, if the file gives none


class HalfPlane(NamedTuple):
    """What does not move and has no edge: all that is behind a point, against a unit normal."""

    at: complex
    normal: complex

    def distance(self, points: Points) -> Reals:
        """Return the distance of points from its face [m]."""
        return np.abs(np.real((points - self.at) / self.normal))


class HeldPoint(NamedTuple):
    """A point of a block that is held: along one line (`along`), or in place (0)."""

    block: str
    at: complex
    along: complex


class Lead(NamedTuple):
    """The block whose rotation is phi, in a direction, and the motion of all blocks there.

    `rates` are the displacements of the blocks at rest, over phi, shape (blocks, 3) [m, m, rad].
    """

    direction: Direction
    block: str
    rates: Reals


@short_repr
@dataclass(frozen=True, eq=False)
class FreeBlocks:
    """A structure as free blocks.

    Parameters
    ----------
    bodies : sequence of Body
        Mass, moment of inertia and centroid of each block, with the masses that are fixed to it.
    shapes : mapping of str to sequence of ndarray of complex
        Convex pieces of each block at rest [m].
    ground : mapping of str to sequence of ndarray of complex or HalfPlane
        What does not move, by name: convex pieces [m], and half-planes of what has no edge.
    walls : sequence of HalfPlane
        Side walls that it leans on, without friction.
    friction : float
        Coefficient of friction of all contacts but those of `frictions`.
    frictions : mapping of tuple of str to float
        Coefficient of friction of single pairs of blocks; "" is the ground.
    guides : sequence of HeldPoint
        Points that are held.
    floors : sequence of PointMass
        Masses that only move up and down, as those of floors that are held sideways elsewhere.
    ties : sequence of Spring
        Elastic ties.
    leads : sequence of Lead
        The block of each direction whose rotation is phi; empty if the mechanism has no rotation, as one that slides.
    moves_with : mapping of str to (str or None, complex)
        The body of the mechanism with which each block moves (None: none), and how far beside it it stands [m].
    gravity : float
        Gravitational acceleration [m/s2].
    outlines : mapping of str to sequence of ndarray of complex
        Polygons of each block at rest, as they are drawn [m].
    block_of : mapping of str to str
        The block of which each piece of the mechanism is a part, by the name of the piece.
    """

    bodies: Sequence[Body]
    shapes: Mapping[str, Sequence[Points]]
    ground: Mapping[str, Sequence[Points | HalfPlane]]
    walls: Sequence[HalfPlane]
    friction: float
    frictions: Mapping[tuple[str, str], float]
    guides: Sequence[HeldPoint]
    floors: Sequence[PointMass]
    ties: Sequence[Spring]
    leads: Sequence[Lead]
    moves_with: Mapping[str, tuple[str | None, complex]]
    gravity: float
    outlines: Mapping[str, Sequence[Points]]
    block_of: Mapping[str, str]

    @cached_property
    def box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of all blocks at rest [m]."""
        return box_around([piece for pieces in self.shapes.values() for piece in pieces])

    @property
    def unit_of_time(self) -> float:
        """sqrt(size/g), of the diagonal of the box [s]."""
        low, high = self.box
        return sqrt(abs(high - low) / self.gravity)

    @property
    def height(self) -> float:
        """Height of the structure [m]."""
        low, high = self.box
        return (high - low).imag

    def rotation(self, moved: Reals) -> Reals:
        """Return phi from the displacements of the blocks, shape (n, blocks, 3): signed, shape (n,), or NaN [rad]."""
        return self._signed(moved, moved)

    def rotation_rate(self, moved: Reals, rates: Reals) -> Reals:
        """Return the rate of `rotation`, shape (n,) [rad/s]."""
        return self._signed(moved, rates)

    def _signed(self, moved: Reals, values: Reals) -> Reals:
        """Return the value of the block that leads the direction in which the blocks have moved, clockwise positive.

        That is the direction whose motion is nearest to theirs, weighed by mass: in one direction of an arch, the block
        that leads the other turns too, and farther.
        """
        if not self.leads:
            return np.full(len(moved), nan)
        names = [body.name for body in self.bodies]
        weights = np.array([[body.mass, body.mass, body.inertia] for body in self.bodies])
        furthest, signed = np.zeros(len(moved)), np.zeros(len(moved))
        for direction, block, rates in self.leads:
            k = names.index(block)
            along = np.einsum("nbc,bc->n", moved, weights * rates) / np.sqrt(np.sum(weights * rates**2))
            further = along > furthest
            furthest = np.where(further, along, furthest)
            signed = np.where(further, np.where(direction * moved[:, k, 2] < 0, -values[:, k, 2], 0.0), signed)
        return signed

    def edge_passed(self, block: str, moved: Reals) -> str:
        """Return on what a block rested whose edge the middle of its foot has passed: a block, or a part of the ground.

        Parameters
        ----------
        block : str
            The block.
        moved : ndarray, shape (blocks, 3)
            Displacements of all blocks [m, m, rad].

        Returns
        -------
        str
            Its name; empty if there is none. Faces in line that continue each other have no edge between them.
        """
        level = [piece for pieces in self.ground.values() for piece in pieces]
        below = {name: pieces for name, pieces in self.shapes.items() if name != block} | {"": level}
        for start, end in ((a, b) for z in self.shapes[block] for a, b in zip(z, np.roll(z, -1), strict=True)):
            long, along = abs(end - start), (end - start) / abs(end - start)
            tolerance = LEVEL_SHARE * long
            for name, pieces in below.items() if along.real > STEEPEST else ():  # anticlockwise, a foot goes right
                faces = _joined(_faces(pieces, start, along, tolerance), tolerance)
                for low, high in (each for each in np.clip(faces, 0.0, long).tolist() if each[1] - each[0] > tolerance):
                    at = self._carried(block, start + (low + high) / 2 * along, moved)
                    at = self._carried(name, at, moved, back=True) if name else at
                    place = ((at - start) / along).real
                    if not ((faces[:, 0] <= place) & (place <= faces[:, 1])).any():
                        return name or self._bearing(start, along, tolerance, low, high)
        return ""

    def _bearing(self, start: complex, along: complex, tolerance: float, low: float, high: float) -> str:
        """Return the name of the ground that bears a part of a foot."""
        faces = {name: _faces(pieces, start, along, tolerance) for name, pieces in self.ground.items()}
        return next(name for name, each in faces.items() if ((each[:, 0] < high) & (each[:, 1] > low)).any())

    def _carried(self, block: str, at: complex, moved: Reals, *, back: bool = False) -> complex:
        """Return where a block has carried a point, or from where to a point."""
        k = [body.name for body in self.bodies].index(block)
        about, (x, y, turned) = self.bodies[k].centroid, moved[k].tolist()
        if back:
            return complex(about + np.exp(-1j * turned) * (at - about - complex(x, y)))
        return complex(about + complex(x, y) + np.exp(1j * turned) * (at - about))

    def tilted(self, mechanism: Mechanism, phi: float) -> Reals:
        """Return the displacements of the blocks if the mechanism has rotated by phi (signed) [m, m, rad]."""
        at, moved = np.array([abs(phi)]), np.zeros((len(self.bodies), 3))
        names = [body.name for body in mechanism.bodies()]
        motions = mechanism.motion(at, Direction.POSITIVE if phi > 0 else Direction.NEGATIVE)
        for k, body in enumerate(self.bodies):
            of, shift = self.moves_with[body.name]
            if of is not None:
                motion = motions[names.index(of)]
                away = motion.carry(body.centroid - shift)[0][0] + shift - body.centroid
                moved[k] = away.real, away.imag, motion.psi[0]
        return moved


def free_blocks(mechanism: Mechanism) -> FreeBlocks:
    """Return a structure as free blocks.

    Parameters
    ----------
    mechanism : Mechanism
        A structure whose bodies are polygons.

    Raises
    ------
    InputError
        If a body has no shape, or something is attached that free blocks cannot have.
    """
    return _Apart(mechanism).blocks()


class _Member(NamedTuple):
    """A piece of the structure, the body that it is of, and its polygons at rest."""

    body: Body
    of: str | None
    shift: complex
    polygons: Sequence[Points]


class _Held(NamedTuple):
    """Points of a block at which what does not move holds it, and the unit normal of that."""

    block: str
    normal: complex
    points: list[complex]


class _Apart:
    """A structure that is taken apart."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism, self.sketch = mechanism, mechanism.sketch()
        # Contacts of each direction, or hinges and guides where contacts are not known.
        self.contacts = [
            contact
            for direction in mechanism.directions
            for contact in mechanism.contacts(direction)
            or of_joints(mechanism.guiding_joints(direction), mechanism.friction)
        ]
        self._refuse()
        self.members = self._members()
        self.part_of = self._bonded()
        outlines = [z for member in self.members for z in member.polygons]
        self.box = box_around(outlines)
        self.size = abs(self.box[1] - self.box[0])
        self.friction = mechanism.friction if mechanism.friction is not None else MASONRY_FRICTION

    def blocks(self) -> FreeBlocks:
        """Return all of it."""
        outlines = [z for member in self.members for z in member.polygons]
        shapes, bodies = defaultdict[str, list[Points]](list), defaultdict[str, list[Body]](list)
        drawn_as = defaultdict[str, list[Points]](list)
        for member in self.members:
            block = self._block(member)
            bodies[block].append(member.body)
            drawn_as[block] += member.polygons
            for z in member.polygons:
                shapes[block] += convex_pieces(z, [other for other in outlines if other is not z])
        floors = []
        for load in self.mechanism.hung.masses:
            for spot, share in self._spots(load.spot):
                fixed, mass = load.horizontal, share * load.mass
                up, weight = load.vertical - fixed, load.weight - fixed
                bodies[spot.body or ""].append(Body(load.name, fixed * mass, 0.0, spot.at))
                if up > 0 and weight > 0:
                    floors.append(PointMass(load.name, spot, mass, 0.0, up, weight))
                elif up or weight:
                    shares = "its share that moves sideways is larger than that which moves up, or weighs"
                    raise self._cannot("loads", f"the mass {load.name}: {shares}")
        ties = [
            replace(spring, spots=[self._spot(spot) for spot in spring.spots])
            for element in self.mechanism.hung.elements
            for spring in element.stretched
            if isinstance(spring, Spring)
        ]
        leans = () if self.mechanism.propped else walls(self.mechanism, *self.box)
        ground = self._ground()
        guides = self._held(ground)
        moves_with = {self._block(member): (member.of, member.shift) for member in reversed(self.members)}
        united = [_united(name, each) for name, each in bodies.items()]
        return FreeBlocks(
            united, shapes, ground, [_half_plane(*line) for line in leans], self.friction, self._frictions(), guides,
            floors, ties, self._leads(united, moves_with), moves_with, self.mechanism.gravity, drawn_as,
            {member.body.name: self._block(member) for member in self.members},
        )  # fmt: skip

    def _cannot(self, field: str, what: str) -> InputError:
        return InputError(Problem(f"free blocks cannot have {what}", field=field))

    def _refuse(self) -> None:
        """Raise `InputError` for the first thing of the structure that free blocks cannot have."""
        if self.mechanism.crushing is not None:
            raise self._cannot("crushing", "pivots that crush")
        if self.mechanism.stops:
            raise self._cannot("stops", "stops: draw the wall as `ground` of an assembly")
        if self.mechanism.driven < 1:
            raise self._cannot("drive", "a drive below 1: they are plane, and their ground motion is that of the plane")
        for loc, attached in self.mechanism.hung.placed:
            field = str(loc[0]) if loc else ""
            if isinstance(attached, ConstantForce):
                what = (
                    "friction of crossing walls"
                    if attached.friction
                    else f"a constant force, as that of {attached.name}"
                )
                raise self._cannot(field, what)
            if isinstance(attached, Element):
                if isinstance(attached, SteelBar):
                    raise self._cannot(field, f"a tie that yields, as {attached.name}")
                springs = [each for each in attached.stretched if isinstance(each, Spring) and each.stiffness]
                on_alike = any(spot.body in self.mechanism.alike() for tie in springs for spot in tie.spots)
                if on_alike or not springs or len(springs) < len(attached.stretched):
                    raise self._cannot(field, f"{attached.name}, {attached.words}: only elastic ties on single bodies")
        if any(contact.roll for contact in self.contacts):
            raise self._cannot("corner_radius", "rounded feet")

    def _members(self) -> list[_Member]:
        bodies = {body.name: body for body in self.mechanism.weighed()}
        members = []
        for piece in self.mechanism.pieces(self.mechanism.directions[0]):
            of = bodies.get(piece.of or "", piece.body)
            drawn = () if of.name in self.sketch.at_will else of.shapes(self.sketch.outlines)
            shapes = [piece.body.outline] if piece.body.outline else [np.asarray(z) + piece.shift for z in drawn]
            if not shapes:
                advice = f": {self.mechanism.unchecked}" if self.mechanism.alike() else ""
                raise self._cannot("bodies", f"a body of unknown shape, as {of.name}{advice}")
            if not piece.body.mass > 0:
                raise self._cannot("bodies", f"a body without mass, as {of.name}")
            polygons = [np.asarray(z, np.complex128) for z in shapes]
            members.append(_Member(piece.body, piece.of, piece.shift, polygons))
        return members

    def _bonded(self) -> dict[str, str]:
        """Return the block of which each piece is a part, if it is bonded to another in every direction."""
        fixed = defaultdict[frozenset[str | None], set[bool]](set)
        for contact in self.contacts:
            fixed[frozenset(contact.pieces)].add(contact.held == "fixed")
        part_of: dict[str, str] = {}
        for pair in (pair for pair, always in fixed.items() if always == {True} and None not in pair):
            first, last = (part_of.get(name, name) for name in sorted(filter(None, pair)))
            part_of |= dict.fromkeys([last, *(each for each, of in part_of.items() if of == last)], first)
        return part_of

    def _block(self, member: _Member) -> str:
        return self.part_of.get(member.body.name, member.body.name)

    def _spots(self, spot: Spot) -> list[tuple[Spot, float]]:
        """Return where a load acts: one point, or as many as there are equal bodies, and its share on each."""
        copies = [member for member in self.members if member.of == spot.body and member.of in self.mechanism.alike()]
        if not copies:
            return [(self._spot(spot), 1.0)]
        return [(Spot(member.body.name, spot.at + member.shift), 1 / len(copies)) for member in copies]

    def _spot(self, spot: Spot) -> Spot:
        """Return a point of a body as one of its block; of a body that does not move as one of the ground."""
        if spot.body is None:
            return spot
        piece = self.mechanism.piece_at(spot.body, spot.at, self.mechanism.directions[0])
        known = any(member.body.name == piece for member in self.members)
        return Spot(self.part_of.get(piece, piece) if known else None, spot.at)

    def _ground(self) -> dict[str, list[Points | HalfPlane]]:
        """Return what does not move: bodies at rest, polygons of the ground, and the ground below its lines."""
        moving = {member.of for member in self.members}
        ground = defaultdict[str, list[Points]](list)
        for body in (body for body in self.mechanism.bodies() if body.name not in moving):
            ground[body.name] += [piece for z in body.shapes(self.sketch.outlines) for piece in convex_pieces(z)]
        lines = self.sketch.ground
        for name, z in zip(self.sketch.ground_names or [THE_GROUND] * len(lines), lines, strict=True):
            if len(z) > 3 and z[0] == z[-1]:
                ground[name] += convex_pieces(z[:-1])
        if not ground:
            return {THE_GROUND: [piece for line in picture(self.mechanism).ground for piece in self._endless(line)]}
        # Contacts with large pieces are less exact: what is near the structure is cut out of them.
        left, right = self.box[0].real - NEARBY * self.size, self.box[1].real + NEARBY * self.size
        cuts = ((1j, left), (-1j, -right)), ((-1j, -left),), ((1j, right),)
        deep = 1 + 0j, self.box[0].imag - NEARBY * self.size
        parts = {name: [_cut(z, (deep, *each)) for z in pieces for each in cuts] for name, pieces in ground.items()}
        least = (NEAR_SHARE * self.size) ** 2
        return {name: [z for z in each if len(z) > 2 and area_of(z) > least] for name, each in parts.items()}

    def _endless(self, line: Points) -> list[Points | HalfPlane]:
        """Return the ground on the right of a line, which goes on beyond both its ends.

        Beyond an end, where a block stands deeper than the ground there, it goes only halfway to this block.
        """
        corners = np.concatenate([z for member in self.members for z in member.polygons])
        before, after = (outward / abs(outward) for outward in (line[0] - line[1], line[-1] - line[-2]))
        reaches = []
        # The ground is on the left of a ray from the start of the line outward, and on the right of one from its end.
        for end, outward, ground_side in ((line[0], before, 1), (line[-1], after, -1)):
            from_end = (corners - end) / outward
            deeper = from_end.real[(from_end.real > 0) & (ground_side * from_end.imag > NEAR_SHARE * self.size)]
            reaches.append(float(deeper.min(initial=inf)) / 2)
        if reaches == [inf, inf] and len(line) == 2:
            return [_half_plane(*line)]
        reach_before, reach_after = (min(reach, FARTHEST_GROUND * self.size) for reach in reaches)
        start, end = line[0] + reach_before * before, line[-1] + reach_after * after
        return list(_below(np.array([start, *line[1:-1], end]), self.size))

    def _held(self, ground: dict[str, list[Points | HalfPlane]]) -> list[HeldPoint]:
        """Return the points that are held, and add the ground below feet that stand elsewhere than on `ground`."""
        guides = list[HeldPoint]()
        feet, slots = list[_Held](), list[_Held]()
        known = [piece for pieces in ground.values() for piece in pieces]
        for contact in self.contacts:
            bears, borne = contact.pieces
            if bears is not None or borne is None:
                continue
            block = self.part_of.get(borne, borne)
            if contact.held == "slide":
                _hold(slots, block, contact)
            elif contact.held is None and not any(self._touches(contact, piece) for piece in known):
                _hold(feet, block, contact)
        for block, normal, points in feet:
            start, end = sorted(points, key=lambda point: (point / normal).imag)[:: len(points) - 1 or 1][:2]
            if abs(end - start) > FLAT_SHARE * self.size:
                ground.setdefault(THE_GROUND, []).extend(self._endless(np.array([end, start])))
            else:  # it always turns about this point
                guides.append(HeldPoint(block, start, 0j))
        # Both directions may guide a block at points of their own; between them, its path is theirs to second order.
        guides += [HeldPoint(block, complex(np.mean(points)), 1j * normal) for block, normal, points in slots]
        return guides

    def _touches(self, contact: Contact, piece: Points | HalfPlane) -> bool:
        points = np.array(contact.points)
        off = piece.distance(points) if isinstance(piece, HalfPlane) else distance(points, piece)
        return bool(off.max() < NEAR_SHARE * self.size)

    def _frictions(self) -> dict[tuple[str, str], float]:
        """Return the friction of pairs of blocks that differ from all others: as given, or 0 of smooth contacts."""
        frictions = {}
        for contact in self.contacts:
            one, other = sorted(self.part_of.get(name or "", name or "") for name in contact.pieces)
            smooth = contact.held == "slide" and None not in contact.pieces
            mu = 0.0 if smooth else self.friction if contact.friction is None else contact.friction
            if contact.held is None or smooth:
                frictions[one, other] = mu
        return {pair: mu for pair, mu in frictions.items() if mu != self.friction}

    def _leads(self, bodies: Sequence[Body], moves_with: Mapping[str, tuple[str | None, complex]]) -> list[Lead]:
        """Return a block that turns by phi in each direction, and the rates of all blocks; empty if none does."""
        leads = []
        names = [body.name for body in self.mechanism.bodies()]
        try:
            moving = [
                self.mechanism.motion(np.array([0.0, LEAD_SHARE * self.mechanism.limit(direction)]), direction)
                for direction in self.mechanism.directions
            ]
        except MechanismError:
            return []
        for direction, each in zip(self.mechanism.directions, moving, strict=True):
            motions = dict(zip(names, each, strict=True))
            off = {name: np.abs(motion.dpsi + direction) for name, motion in motions.items()}
            alike = {name for name in names if off[name][0] < LEAD_RATE}  # at rest others may turn as fast
            turning = {name for name in alike if off[name][1] < LEAD_RATE} or alike
            rates = np.zeros((len(bodies), 3))
            for k, body in enumerate(bodies):
                of, shift = moves_with[body.name]
                if of is not None:
                    velocity = motions[of].carry(body.centroid - shift)[1][0]
                    rates[k] = velocity.real, velocity.imag, motions[of].dpsi[0]
            block = next(self._block(member) for member in self.members if member.of in turning)
            leads.append(Lead(direction, block, rates))
        return leads


def _hold(known: list[_Held], block: str, contact: Contact) -> None:
    """Add the points of a contact to those on the same block and face, or as the first of another."""
    for held in known:
        turned = contact.normal / held.normal
        off = min(abs(turned - 1), abs(turned + 1)) if contact.held == "slide" else abs(turned - 1)
        if held.block == block and off < SAME_TURN:
            held.points.extend(contact.points)
            return
    known.append(_Held(block, contact.normal, list(contact.points)))


def _half_plane(start: complex, end: complex) -> HalfPlane:
    """Return all that is on the right of a line."""
    return HalfPlane(start, 1j * (end - start) / abs(end - start))


def _faces(pieces: Sequence[Points | HalfPlane], start: complex, along: complex, tolerance: float) -> Reals:
    """Return from where to where faces are in line with a foot, from its start along it [m], shape (faces, 2)."""
    faces = [np.zeros((0, 2))]
    for piece in pieces:
        if isinstance(piece, HalfPlane):
            off = abs(((piece.at - start) / along).imag), tolerance * abs(piece.normal - 1j * along) / LEVEL_SHARE
            faces.append(np.array([[-inf, inf]] if max(off) < tolerance else np.zeros((0, 2))))
        else:  # anticlockwise: a face that bears a foot goes to the left
            ends = (np.stack([np.roll(piece, -1), piece], axis=-1) - start) / along
            inline = (np.abs(ends.imag).max(axis=1) < tolerance) & (ends.real[:, 0] < ends.real[:, 1])
            faces.append(ends.real[inline])
    return np.concatenate(faces)


def _joined(faces: Reals, tolerance: float) -> Reals:
    """Return faces in line, those that continue each other as one."""
    joined: list[list[float]] = []
    for low, high in sorted(faces.tolist()):
        if joined and low <= joined[-1][1] + tolerance:
            joined[-1][1] = max(joined[-1][1], high)
        else:
            joined.append([low, high])
    return np.array(joined).reshape(-1, 2)


def _cut(z: Points, levels: Sequence[tuple[complex, float]]) -> Points:
    """Return the part of a convex polygon that is above levels, each after a turn; empty if there is none."""
    for turn, level in levels:
        points, turned = [], (z * turn).tolist()
        for start, end in zip(turned, turned[1:] + turned[:1], strict=True):
            points += [start] if start.imag >= level else []
            if (start.imag - level) * (end.imag - level) < 0:
                points.append(start + (end - start) * (level - start.imag) / (end.imag - start.imag))
        z = np.array(points, np.complex128) / turn
    return z


def _below(line: Points, size: float) -> list[Points]:
    """Return the ground on the right of a line, as one piece for each of its segments, anticlockwise."""
    pieces = []
    for start, end in pairwise(line.tolist()):
        deep = -0.5j * size * (end - start) / abs(end - start)
        pieces.append(np.array([start + deep, end + deep, end, start]))
    return pieces


def _united(name: str, bodies: Sequence[Body]) -> Body:
    """Return bodies that are fixed to each other as one."""
    mass = sum(body.mass for body in bodies)
    centroid = sum(body.mass * body.centroid for body in bodies) / mass
    inertia = sum(body.inertia + body.mass * abs(body.centroid - centroid) ** 2 for body in bodies)
    return Body(name, mass, inertia, centroid)
