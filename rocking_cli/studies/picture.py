"""Drawing of a structure as plain data: its parts, their hinges, and their positions at any rotation.

A program that draws it, on paper or as an animation, only has to place the parts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, pairwise
from typing import Any

import numpy as np

from rocking_cli.arrays import Bools, Points, Reals
from rocking_cli.core import (
    Angle,
    Body,
    CollapseMechanism,
    Direction,
    Hinge,
    Length,
    Mechanism,
    Outline,
    RigidMotion,
    Sketch,
    disc,
)
from rocking_cli.core.bounds import Bound
from rocking_cli.core.coefficients import NoCriticalRotation
from rocking_cli.core.mechanism import extent
from rocking_cli.errors import RockingError, StructureError
from rocking_cli.plugins.errors import plugin_error
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.hung import Carried, End, Strand, carried, strands, walls

NODES_PER_SIDE = 60  # linear interpolation in the table of positions has an error of 1e-4 of the size
MAX_LIMIT_SHARE = 0.999  # a linkage has no derivatives at its kinematic limit
SAME_POINT_SHARE = 1e-6  # share of the size within which points coincide
MIN_SIZE = 1e-150  # m; scales of smaller drawings overflow
MIN_TURN = 1e-9  # rate below which a body does not turn
START_SHARE = 0.05  # displacement of the fastest part over the size, in a drawing of an initial motion
MAX_SEPARATE_PARTS = 40  # above this number, parts that move together are drawn as one
SHADE_COUNT = 3  # number of shades: enough to tell each link from its neighbours
SHOWN_LIMIT_SHARE = 0.1  # share of the kinematic limit that is drawn if there is no critical rotation

ASSUMED_NOTE = (
    "dashed: a body whose shape the mechanism does not give, as a disc of the same mass and inertia, or as a point"
)


@short_repr
@dataclass(frozen=True)
class DrawnPart:
    """A body as it is drawn; or one of the equal copies for which a body stands.

    Parameters
    ----------
    name : str
        Name of the body.
    body : int
        Index of the body.
    centroid : complex
        Centroid at rest [m].
    outlines : tuple of ndarray of complex
        Closed polygons at rest [m].
    assumed : bool
        Whether the outline is only that of a disc of the same mass and inertia.
    shift : complex
        Position relative to the body of which it is a copy [m].
    mass : float
        Mass of the blocks that are drawn as one part, see `Picture.grouped` [kg].
    """

    name: str
    body: int
    centroid: complex
    outlines: tuple[Points, ...]
    assumed: bool
    shift: complex = 0j
    mass: float = 0.0


@dataclass(frozen=True)
class DrawnHinge:
    """A hinge of one direction as it is drawn: its position at rest [m], and the index of the part that carries it."""

    letter: str
    point: complex
    part: int
    direction: Direction
    slide: complex = 0j


@short_repr
@dataclass(frozen=True, eq=False)
class Start:
    """Initial motion of mechanisms without a rocking model: bodies move straight on, with phi from 0 to 1.

    Parameters
    ----------
    centroids : mapping of str to complex
        Centroids of all bodies, in their order [m].
    size : float
        Diagonal of the box around their outlines [m].
    found : mapping of Direction to CollapseMechanism
        The mechanisms.
    """

    centroids: Mapping[str, complex]
    size: float
    found: Mapping[Direction, CollapseMechanism]

    def motion(self, phi: Reals, direction: Direction) -> list[RigidMotion]:
        """Return the motion of each body, scaled so that the fastest bodies move visibly."""
        mechanism = self.found[direction]
        rates = {
            name: rate for group, rate in zip(mechanism.groups, mechanism.velocities, strict=True) for name in group
        }
        at = np.array(list(self.centroids.values()))
        velocity = np.array([rates.get(name, (0j, 0.0)) for name in self.centroids])
        speed = np.abs(velocity[:, 0] + 1j * velocity[:, 1] * at).max()
        velocity *= START_SHARE * self.size / speed
        zero, still = np.zeros_like(phi), np.zeros(phi.shape, np.complex128)
        return [
            RigidMotion(0j, v * phi + still, v + still, still, turn.real * phi, turn.real + zero, zero)
            for v, turn in velocity
        ]


@short_repr
@dataclass(frozen=True)
class Picture:
    """A structure to be drawn; see `picture`.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    parts : tuple of DrawnPart
        The parts, the first at the back.
    pins : tuple of DrawnHinge
        The hinges and pivots of both directions.
    phi_cr, limit : mapping of Direction to float
        Critical rotation (None if it does not exist), and largest rotation that can be drawn [rad], of each direction
        in which the structure can rock.
    ground : tuple of ndarray of complex
        Lines of the ground, which is on the right of someone who walks along them [m].
    sketch : Sketch
        Lengths, angles, lines and notes.
    loads : tuple of Carried
        Masses and forces on the structure.
    ties : tuple of Strand
        The ties.
    start : Start or None
        Initial motion of a structure without a rocking model; None for others.
    """

    mechanism: Mechanism
    parts: tuple[DrawnPart, ...]
    pins: tuple[DrawnHinge, ...]
    phi_cr: Mapping[Direction, float | None]
    limit: Mapping[Direction, float]
    ground: tuple[Points, ...]
    sketch: Sketch
    loads: tuple[Carried, ...] = ()
    ties: tuple[Strand, ...] = ()
    start: Start | None = None

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        """Return the motion of each body at rotations in a direction."""
        return self.mechanism.motion(phi, direction) if self.start is None else self.start.motion(phi, direction)

    @property
    def directions(self) -> Sequence[Direction]:
        """The directions in which the structure can rock."""
        return list(self.limit)

    @property
    def reference(self) -> Mapping[Direction, float]:
        """Reference rotation of each direction [rad]: the critical one, or the limit if there is none."""
        return {side: self.limit[side] / MAX_LIMIT_SHARE if phi is None else phi for side, phi in self.phi_cr.items()}

    @property
    def usual(self) -> Mapping[Direction, float]:
        """Default displacement in each direction, as a fraction of the reference rotation.

        It is 1 if the direction has a critical rotation, less if the body lies flat before, and `SHOWN_LIMIT_SHARE`
        without one.
        """
        if self.start is not None:
            return dict.fromkeys(self.directions, 1.0)
        there = min((self.limit[side] / phi for side, phi in self.phi_cr.items() if phi is not None), default=1.0)
        return {side: SHOWN_LIMIT_SHARE if phi is None else min(1.0, there) for side, phi in self.phi_cr.items()}

    def side(self, rotation: float) -> Direction:
        """Return the direction of a signed rotation; at rest, the first direction in which the structure can rock."""
        if rotation == 0:
            return self.directions[0]
        return Direction.NEGATIVE if rotation < 0 else Direction.POSITIVE

    def at(self, rotation: Reals) -> tuple[Points, Reals]:
        """Return the positions of the parts at signed rotations.

        Parameters
        ----------
        rotation : ndarray, shape (n,)
            Rotations [rad], positive clockwise; those beyond the limit are set to the limit.

        Returns
        -------
        centroids : ndarray of complex, shape (parts, n)
            Positions of the centroids [m].
        psi : ndarray, shape (parts, n)
            Rotations of the parts [rad], positive anticlockwise.
        """
        centroids = np.empty((len(self.parts), rotation.size), np.complex128)
        psi = np.empty(centroids.shape)
        for direction in Direction:
            here = rotation >= 0 if direction > 0 else rotation < 0
            phi = np.minimum(np.abs(rotation[here]), self.limit.get(direction, 0.0))
            motions = self.motion(phi, direction)
            for k, part in enumerate(self.parts):
                centroids[k, here] = motions[part.body].carry(part.centroid - part.shift)[0] + part.shift
                psi[k, here] = motions[part.body].psi
        return centroids, psi

    def marks(self, rotation: float) -> Points:
        """Return the marked centroids at one signed rotation [m]: of each part, or of each link of many blocks."""
        centroids = self.at(np.array([rotation]))[0][:, 0]
        mass = np.array([part.mass for part in self.parts])
        if not mass.any():
            return centroids
        links = self.links[self.side(rotation)]
        link = np.array([-1 if links[part.name] is None else links[part.name] for part in self.parts])
        groups = [(link == k) & (mass > 0) for k in np.unique(link[link >= 0])]
        return np.array([np.average(centroids[here], weights=mass[here]) for here in groups if here.any()])

    def placed(self, rotation: float) -> tuple[list[list[Points]], Points]:
        """Return the outlines of every part, and the pins, shape (pins,), at one signed rotation [m]; see `at`."""
        carry = self._carry(rotation)
        outlines = [[carry(k, each) for each in part.outlines] for k, part in enumerate(self.parts)]
        return outlines, np.array([complex(carry(pin.part, np.array(pin.point))) for pin in self.pins])

    def hung(self, rotation: float, symbol: float) -> tuple[Points, list[list[tuple[complex, complex]]], list[bool]]:
        """Return the loads and ties of the structure at one signed rotation.

        Parameters
        ----------
        rotation : float
            The signed rotation [rad].
        symbol : float
            Length of the symbol of a spring whose ends are together at rest [m].

        Returns
        -------
        loads : ndarray of complex, shape (loads,)
            Points at which the loads act [m].
        ties : list of list of (complex, complex)
            The ends of the pieces of each tie [m].
        slack : list of bool
            Whether each tie is slack.
        """
        carry = self._carry(rotation)

        def place(end: End) -> complex:
            here = np.array([end.point, end.point + symbol * end.lead])
            return complex((here if end.part is None else carry(end.part, here))[1])

        loads = np.array([complex(carry(each.part, np.array(each.point))) for each in self.loads], np.complex128)
        ties = [[(place(piece.start), place(piece.end)) for piece in tie.pieces] for tie in self.ties]
        return loads, ties, [bool(row[0]) for row in self._slack(np.array([rotation]))]

    def held(self, rotation: float) -> list[complex]:
        """Return the points of all loads and ties at one signed rotation [m], without symbols."""
        loads, ties, _ = self.hung(rotation, 0.0)
        return [*loads.tolist(), *(end for tie in ties for piece in tie for end in piece)]

    def _carry(self, rotation: float) -> Callable[[int, Points], Points]:
        """Return a function that moves points of a part to their positions at one signed rotation."""
        centroids, psi = (values[:, 0] for values in self.at(np.array([rotation])))

        def carry(part: int, points: Points) -> Points:
            moved: Points = centroids[part] + np.exp(1j * psi[part]) * (points - self.parts[part].centroid)
            return moved

        return carry

    def _slack(self, rotation: Reals) -> list[Bools]:
        """Return for each tie a mask of the signed rotations at which it is slack, shape (n,)."""
        rows = []
        for tie in self.ties:
            row = np.zeros(rotation.shape, bool)
            for side, limit in self.limit.items() if self.start is None else ():
                here = rotation * side >= 0
                row[here] = tie.slack(self.mechanism, np.minimum(np.abs(rotation[here]), limit), side)
            rows.append(row)
        return rows

    @cached_property
    def links(self) -> Mapping[Direction, Mapping[str, int | None]]:
        """For each direction, the link of each body, counted along the hinges; None for a body at rest."""
        size = abs(self.extent[1] - self.extent[0])
        bodies = [body.name for body in self.mechanism.bodies()]
        by_direction: dict[Direction, Mapping[str, int | None]] = {}
        for direction in self.directions:
            motions = self.motion(np.array([0.5 * self.reference[direction]]), direction)
            # Bodies are one link if they turn at the same rate and would move one point at the same velocity.
            speeds = [np.array([size * motion.dpsi[0], motion.carry(0j)[1][0]]) for motion in motions]
            of_body = dict(zip(bodies, speeds, strict=True))
            along = [name for hinge in self.sketch.hinges.get(direction, ()) for name in hinge.bodies]
            of_link: list[Points] = []
            links: dict[str, int | None] = dict.fromkeys(bodies)
            for name in dict.fromkeys([*(name for name in along if name in of_body), *bodies]):
                if np.abs(of_body[name]).max() <= SAME_POINT_SHARE * size:
                    continue
                alike = (
                    k
                    for k, speed in enumerate(of_link)
                    if np.abs(of_body[name] - speed).max() <= SAME_POINT_SHARE * size
                )
                links[name] = next(alike, len(of_link))
                if links[name] == len(of_link):
                    of_link.append(of_body[name])
            by_direction[direction] = links
        return by_direction

    @cached_property
    def shades(self) -> Mapping[Direction, tuple[int | None, ...]]:
        """For each direction, a shade of each part, different from its neighbours'; None for a part at rest."""
        by_direction: dict[Direction, tuple[int | None, ...]] = {}
        for direction, links in self.links.items():
            beside: dict[int, set[int]] = {link: set() for link in links.values() if link is not None}
            for hinge in self.sketch.hinges.get(direction, ()):
                here = {link for name in hinge.bodies if (link := links.get(name)) is not None}
                for link in here:
                    beside[link] |= here - {link}
            shades: dict[int | None, int | None] = {None: None}
            for link in sorted(beside):
                taken = {shades.get(other) for other in beside[link]}
                able = [shade % SHADE_COUNT for shade in range(link, link + SHADE_COUNT)]
                shades[link] = next((shade for shade in able if shade not in taken), able[0])
            by_direction[direction] = tuple(shades[links[part.name]] for part in self.parts)
        return by_direction

    def in_language(self, say: Callable[[str], str]) -> Picture:
        """Return a copy whose lengths, and loads that the user did not name, are named by a function of the English."""
        given = {each.name for each in self.mechanism.loads or []}
        lengths = [replace(each, symbol=say(each.symbol)) for each in self.sketch.lengths]
        loads = (each if each.name in given else replace(each, name=say(each.name)) for each in self.loads)
        return replace(self, sketch=replace(self.sketch, lengths=lengths), loads=tuple(loads))

    @cached_property
    def grouped(self) -> Picture:
        """Copy of the drawing with parts that move together joined into one part, if there are many parts."""
        if len(self.parts) <= MAX_SEPARATE_PARTS:
            return self
        masses = {body.name: body.mass for body in self.mechanism.weighed()}
        groups: dict[Any, list[int]] = {}
        for k, part in enumerate(self.parts):
            alike = *(links[part.name] for links in self.links.values()), part.assumed, part.shift
            groups.setdefault(alike, []).append(k)
        group_of = {k: n for n, group in enumerate(groups.values()) for k in group}
        parts = []
        for group in groups.values():
            members = [self.parts[k] for k in group]
            mass = np.array([masses[part.name] for part in members])
            at = np.average([part.centroid for part in members], weights=mass if mass.any() else None)
            outlines = tuple(each for part in members for each in part.outlines)
            parts.append(replace(members[0], centroid=complex(at), outlines=outlines, mass=float(mass.sum())))

        def moved(end: End) -> End:
            return end if end.part is None else end._replace(part=group_of[end.part])

        return replace(
            self,
            parts=tuple(parts),
            pins=tuple(replace(pin, part=group_of[pin.part]) for pin in self.pins),
            loads=tuple(replace(load, part=group_of[load.part]) for load in self.loads),
            ties=tuple(
                replace(
                    tie,
                    pieces=tuple(each._replace(start=moved(each.start), end=moved(each.end)) for each in tie.pieces),
                )
                for tie in self.ties
            ),
        )

    def chains(self, pins: Sequence[DrawnHinge]) -> list[list[int]]:
        """Return chains of pins that are joined by links, as indices: pins in their order first, then the others."""
        held = []  # moving links of each pin
        for pin in pins:
            hinges, links = self.sketch.hinges.get(pin.direction, ()), self.links[pin.direction]
            here = [hinge.bodies for hinge in hinges if (hinge.letter, hinge.point) == (pin.letter, pin.point)]
            held.append({link for bodies in here for name in bodies if (link := links.get(name)) is not None})
        chains: list[list[int]] = []
        for k in range(1, len(pins)):
            if held[k - 1] & held[k]:
                if chains and chains[-1][-1] == k - 1:
                    chains[-1].append(k)
                else:
                    chains.append([k - 1, k])
        for link in sorted(set().union(*held)):
            on = [k for k, links in enumerate(held) if link in links]
            chains += [[one, other] for one, other in pairwise(on) if other - one > 1]
        return chains

    @property
    def furthest(self) -> float:
        """The largest displacement that can be drawn in both directions, over the reference rotation."""
        return min(self.limit[direction] / phi for direction, phi in self.reference.items())

    @cached_property
    def extent(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of the structure at rest [m]."""
        points = np.array([*(part.centroid for part in self.parts), *(pin.point for pin in self.pins)])
        return box_around([outline for part in self.parts for outline in part.outlines] + [points])

    @cached_property
    def reach(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of the structure with its loads and ties, at rest [m]."""
        ends = [end.point for tie in self.ties for piece in tie.pieces for end in (piece.start, piece.end)]
        return box_around([np.array([*self.extent, *ends, *(each.point for each in self.loads)])])

    @cached_property
    def walls(self) -> tuple[Points, ...]:
        """Side walls behind a structure that rocks to one side only, as lines like those of the ground [m]."""
        return walls(self.mechanism, *self.extent)

    @property
    def nodes(self) -> Reals:
        """The rotations at which a table has the positions of the parts, shape (n,)."""
        ends = [np.linspace(0.0, self.limit.get(direction, 0.0), NODES_PER_SIDE + 1) for direction in Direction]
        return np.unique(np.concatenate([-ends[1][:0:-1], ends[0]]) + 0.0)

    def as_dict(self) -> dict[str, Any]:
        """Return the whole drawing as plain data, for a page: points are [x, y] in m, angles in rad.

        `x`, `y` (of its centroid) and `psi` (anticlockwise) place a part at each `rotation`, with linear interpolation;
        its outlines and the points that it carries are relative to its centroid. A `part` of null is the ground.
        """
        rotation = self.nodes
        centroids, psi = self.at(rotation)
        return {
            "mechanism": self.mechanism.mechanism,
            "name": self.mechanism.name,
            "title": self.mechanism.title,
            "phi_cr": {direction.label: phi for direction, phi in self.phi_cr.items()},
            "reference": {direction.label: phi for direction, phi in self.reference.items()},
            "limit": {direction.label: limit for direction, limit in self.limit.items()},
            "one_sided": self.mechanism.one_sided,
            "rotation": _rounded(rotation),
            "parts": [_part(*each) for each in zip(self.parts, centroids, psi, strict=True)],
            "pins": [
                {
                    "letter": pin.letter,
                    "direction": pin.direction.label,
                    "part": pin.part,
                    "point": _pairs([pin.point - self.parts[pin.part].centroid])[0],
                }
                for pin in self.pins
            ],
            "lengths": [_measure(each, [each.start, each.end]) for each in self.sketch.lengths],
            "angles": [_measure(each, [each.apex, each.start, each.end]) for each in self.sketch.angles],
            "lines": [
                {"name": each.name, "direction": _label(each.direction), "points": _pairs(each.points)}
                for each in self.sketch.lines
            ],
            "forces": [
                {
                    "name": each.name,
                    "direction": _label(each.direction),
                    "points": _pairs(each.points),
                    "forces": _pairs(each.forces),
                }
                for each in self.sketch.forces
            ],
            "ground": [_pairs(each) for each in self.ground],
            "walls": [_pairs(each) for each in self.walls],
            "loads": [self._load(each) for each in self.loads],
            "ties": [self._tie(*each) for each in zip(self.ties, self._slack(rotation), strict=True)],
            "notes": list(self.sketch.notes),
        }

    def _load(self, load: Carried) -> dict[str, Any]:
        return {
            "name": load.name,
            "text": load.text,
            "mass": load.mass,
            "force": None if load.force is None else _pairs([load.force])[0],
            "friction": load.friction,
            **self._end(End(load.part, load.point)),
        }

    def _tie(self, tie: Strand, slack: Bools) -> dict[str, Any]:
        return {
            "name": tie.name,
            "bed": tie.is_bed,
            "only": tie.only,
            "pieces": [
                {"kind": piece.kind, "ends": [self._end(end) for end in (piece.start, piece.end)]}
                for piece in tie.pieces
            ],
            "slack": slack.tolist(),
        }

    def _end(self, end: End) -> dict[str, Any]:
        """Return an end of a tie as plain data: part, point relative to its centroid [m], and offset of the symbol."""
        about = 0j if end.part is None else self.parts[end.part].centroid
        point, lead = _pairs([end.point - about, end.lead])
        return {"part": end.part, "point": point, "lead": lead}


def picture(mechanism: Mechanism, collapses: Mapping[Direction, CollapseMechanism] | None = None) -> Picture:
    """Build the drawing of a structure.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism. Whatever its `sketch` leaves out is derived: outlines from mass and inertia, pivots and hinges
        from the motion, the ground from the pivots.
    collapses : mapping of Direction to CollapseMechanism, optional
        The mechanisms that a search found. If one of them has no rocking model, the drawing shows their initial motion.

    Raises
    ------
    StructureError
        If the plugin fails.
    """
    try:
        return _picture(mechanism, collapses or {})
    except RockingError:
        raise
    except Exception as error:  # a plugin may return anything
        what = f"the mechanism {mechanism.mechanism} failed to be drawn"
        raise plugin_error(what, type(mechanism).__module__, error) from error


def box_around(outlines: Sequence[Points]) -> tuple[complex, complex]:
    """Return the lower left and upper right corner of the box around points [m]."""
    z = np.concatenate([np.ravel(each) for each in outlines])
    return complex(z.real.min(), z.imag.min()), complex(z.real.max(), z.imag.max())


def _picture(mechanism: Mechanism, collapses: Mapping[Direction, CollapseMechanism]) -> Picture:
    bodies, sketch = mechanism.bodies(), mechanism.sketch()
    phi_cr: dict[Direction, float | None] = dict.fromkeys(mechanism.directions)
    limit = dict.fromkeys(mechanism.directions, MAX_LIMIT_SHARE)
    met: dict[Direction, Bound] = {}
    starts = not all(each.lead or not each.velocities for each in collapses.values())
    if not starts:
        phi_cr = {direction: _critical(mechanism, direction) for direction in mechanism.directions}
        limit = {direction: MAX_LIMIT_SHARE * mechanism.limit(direction) for direction in mechanism.directions}
        turns = [*limit.values(), *(phi for phi in phi_cr.values() if phi is not None)]
        if not (min(turns) > 0 and extent(mechanism) > MIN_SIZE):
            raise StructureError("it is too small to be drawn: check the sizes and their units")
        met = {side: each for side, each in mechanism.bounds.items() if each is not None and each.kind != "yields"}
        limit |= {direction: bound.phi for direction, bound in met.items()}
        sketch = replace(sketch, notes=[*sketch.notes, *(f"{side.label}: {each.words}" for side, each in met.items())])
    seen = {direction: limit[direction] if phi is None else phi for direction, phi in phi_cr.items()}
    parts = tuple(
        DrawnPart(
            body.name,
            k,
            body.centroid + shift,
            tuple(np.asarray(each, np.complex128) + shift for each in _outlines(body, sketch)),
            assumed=body.name not in sketch.outlines and not body.outline,
            shift=shift,
        )
        for k, body in enumerate(bodies)
        for shift in sketch.copies.get(body.name, (0j,))
    )
    pins: list[DrawnHinge] = []
    for direction in mechanism.directions:
        phi = np.linspace(0.0, seen[direction], 5)
        hinges = sketch.hinges.get(direction, ())
        if not (hinges or starts):
            hinges = _hinges_of_motion(bodies, mechanism.motion(phi, direction))
        for hinge in hinges:  # drawn on the first body, or each copy of it; only one gets the letter
            carriers = [k for k, part in enumerate(parts) if part.name == hinge.bodies[0]]
            for k in carriers:
                letter, point = hinge.letter if k == carriers[0] else "", hinge.point + parts[k].shift
                pins.append(DrawnHinge(letter, point, k, direction, hinge.slide))
    outlines = [outline for part in parts for outline in part.outlines]
    if not (sketch.lengths or any(part.assumed for part in parts)):
        low, high = box_around(outlines)
        corner = complex(low.real, high.imag)
        sketch = replace(sketch, lengths=[Length("width", corner, high), Length("height", low, corner)])
    lines = [np.asarray(each, np.complex128) for each in sketch.ground]
    whole = [name in {each.name for each in met.values()} for name in sketch.ground_names] or [False] * len(lines)
    ground = tuple(
        face for line, drawn in zip(lines, whole, strict=True) for face in ([line] if drawn else _faces(line, outlines))
    ) or _level_ground(parts, pins)
    if any(part.assumed for part in parts):
        sketch = replace(sketch, notes=[*sketch.notes, ASSUMED_NOTE])
    if mechanism.crushing:
        sketch = replace(sketch, notes=[*sketch.notes, mechanism.crushing.words])
    copies = {body.name: [(k, part.shift) for k, part in enumerate(parts) if part.name == body.name] for body in bodies}
    loads = tuple(carried(mechanism, copies))
    ties = tuple(strands(mechanism, copies, [part.centroid for part in parts]))
    start = None
    if starts:
        low, high = box_around(outlines)
        start = Start({body.name: body.centroid for body in bodies}, abs(high - low), collapses)
    return Picture(mechanism, parts, tuple(pins), phi_cr, limit, ground, sketch, loads, ties, start)


def _critical(mechanism: Mechanism, direction: Direction) -> float | None:
    try:
        return mechanism.critical_rotation(direction)
    except NoCriticalRotation:
        if not mechanism.attached:
            raise
        return None


def _outlines(body: Body, sketch: Sketch) -> Sequence[Outline]:
    if body.name in sketch.outlines:
        return sketch.outlines[body.name]
    if body.outline:
        return [body.outline]
    radius = np.sqrt(2 * body.inertia / body.mass) if body.mass > 0 else 0.0  # radius of a disc, I = m r^2 / 2
    return [disc(body.centroid, float(radius))] if radius > 0 else []


def _hinges_of_motion(bodies: Sequence[Body], motions: Sequence[RigidMotion]) -> list[Hinge]:
    """Return the points about which a body always turns, against the ground or against another body, as hinges."""
    centroids = [body.centroid for body in bodies]
    size = max(abs(one - other) for one in centroids for other in [*centroids, 0j]) or 1.0
    hinges: list[Hinge] = []

    def add(centre: complex, names: tuple[str, ...], gap: Points) -> None:
        # Relative to a body at rest, a body turns about a pivot that is already known.
        known = len(names) > 1 and any(abs(centre - other.point) <= SAME_POINT_SHARE * size for other in hinges)
        if np.abs(gap).max() <= SAME_POINT_SHARE * size and not known:
            hinges.append(Hinge("", centre, names))

    speeds = []  # velocity at the origin, and rate of turning, of each body at rest
    for body, motion in zip(bodies, motions, strict=True):
        _, velocity, _ = motion.carry(body.centroid)
        turning = float(motion.dpsi[0])
        speeds.append((complex(velocity[0]) - 1j * turning * body.centroid, turning))
    for body, motion, (speed, turning) in zip(bodies, motions, speeds, strict=True):
        if abs(turning) > MIN_TURN:
            centre = 1j * speed / turning  # speed + i turning centre = 0
            add(centre, (body.name,), motion.carry(centre)[0] - centre)
    for i, j in combinations(range(len(bodies)), 2):
        (speed, turning), (other_speed, other_turning) = speeds[i], speeds[j]
        if abs(turning - other_turning) > MIN_TURN:
            centre = 1j * (speed - other_speed) / (turning - other_turning)
            gap = motions[i].carry(centre)[0] - motions[j].carry(centre)[0]
            add(centre, (bodies[i].name, bodies[j].name), gap)
    return hinges


def _faces(line: Points, outlines: Sequence[Points]) -> list[Points]:
    """Return a line of the ground; of a closed one, a block of the ground, the faces upwards and those at a part."""
    if len(line) < 3 or line[0] != line[-1]:
        return [line]
    corners = np.concatenate(outlines)
    faces: list[Points] = []
    last = None
    for start, end in pairwise(line):
        place = (corners - start) / (end - start)
        tolerance = SAME_POINT_SHARE
        touched = (np.abs(place.imag) <= tolerance) & (place.real > tolerance) & (place.real < 1 - tolerance)
        if (end - start).real > tolerance * abs(end - start) or touched.any():
            if last == start:
                faces[-1] = np.append(faces[-1], end)
            else:
                faces.append(np.array([start, end]))
            last = end
    return faces


def _level_ground(parts: Sequence[DrawnPart], pins: Sequence[DrawnHinge]) -> tuple[Points, ...]:
    """Return level ground at the lowest of the pivots, wider than the structure."""
    z = [point for part in parts for each in part.outlines for point in each.tolist()]
    z += [part.centroid for part in parts]
    level = min((pin.point.imag for pin in pins), default=min(point.imag for point in z))
    left, right = min(point.real for point in z), max(point.real for point in z)
    margin = 0.25 * max(right - left, max(point.imag for point in z) - level)
    return (np.array([complex(left - margin, level), complex(right + margin, level)]),)


def _part(part: DrawnPart, centroid: Points, psi: Reals) -> dict[str, Any]:
    return {
        "name": part.name,
        "assumed": part.assumed,
        "outlines": [_pairs(each - part.centroid) for each in part.outlines],
        "x": _rounded(centroid.real),
        "y": _rounded(centroid.imag),
        "psi": _rounded(psi),
    }


def _measure(each: Length | Angle, points: list[complex]) -> dict[str, Any]:
    return {
        "symbol": each.symbol,
        "text": each.text,
        "value": each.value,
        "direction": _label(each.direction),
        "points": _pairs(points),
    }


def _label(direction: Direction | None) -> str | None:
    return direction.label if direction is not None else None


def _pairs(points: Sequence[complex] | Points) -> list[list[float]]:
    z = np.asarray(points, np.complex128)
    return [_rounded(pair) for pair in np.stack([z.real, z.imag], axis=-1)]


def _rounded(values: Reals) -> list[float]:
    """Round values to seven digits: more than can be seen, and half the text."""
    return [float(f"{value:.7g}") for value in values.tolist()]
