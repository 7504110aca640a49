"""A linkage of any rigid bodies, described in the file without code."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import combinations
from math import inf
from typing import ClassVar, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from mechanisms._cracks import MIN_EDGE_DISTANCE, Crack, Cracked, active, cracked, weakest
from mechanisms._linkage_checks import (
    MAX_SINE,
    beside,
    closing,
    face_at,
    face_of,
    lowest_side,
    shared_sides,
    turns_the_wrong_way,
)
from mechanisms._linkage_sides import GROUND, Connection, LinkageSide, PlacedSide, mirrored
from mechanisms._linked_bodies import LinkedBodies
from mechanisms._shapes import Member, Shape
from rocking_cli.core import (
    Contact,
    Direction,
    Extra,
    Guide,
    Hinge,
    Joint,
    LinkageMotion,
    NoMotion,
    Piece,
    Pin,
    Sketch,
    geometry_error,
    of_joints,
)
from rocking_cli.core.fields import Name
from rocking_cli.core.hung.ties import Place, Tie
from rocking_cli.errors import MechanismError, StructureError

MAX_CRACKS = 2  # number of cracks in one direction
MIRROR_DISTANCE = 1e-6  # largest distance of a mirror image from its body, over the size of the structure

EXAMPLE_BODIES = {
    "lower": {"polygon": [[0.0, 0.0], [0.3, 0.0], [0.3, 1.5], [0.0, 1.5]]},
    "upper": {"polygon": [[0.0, 1.5], [0.3, 1.5], [0.3, 3.0], [0.0, 3.0]]},
}
EXAMPLE_SIDE = {
    "lead": "lower",
    "joints": {
        "A": {"pivot": "lower", "at": [0.3, 0.0]},
        "B": {"hinge": ["lower", "upper"], "at": [0.0, 1.5]},
        "C": {"slide": "upper", "at": [0.3, 3.0], "along": [0.0, 1.0]},
    },
}


class Linkage(LinkedBodies):
    """Bodies, and their joints for each direction."""

    mechanism: ClassVar[str] = "linkage"
    title: ClassVar[str] = "linkage of any rigid bodies"
    suits: ClassVar[str] = "bodies and joints that you list: portico, two storeys"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Section 2, for any joints"
    verified: ClassVar[str] = "block, walls, asymmetric frame and arch rebuilt; loop closure of each joint"

    starter: ClassVar[tuple[str, ...]] = ("density", "depth")

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True)

    members: dict[Name, Shape] = Field(
        alias="bodies",
        description="the bodies by their names: polygon, parts, disc, masses, or mass, centroid and inertia",
        examples=[EXAMPLE_BODIES],
        min_length=1,
        max_length=1000,
    )
    positive: LinkageSide | Literal["mirror", "none"] = Field(
        description="clockwise rocking: {lead, joints}; mirror: the image of the other; none: it cannot",
        examples=[EXAMPLE_SIDE],
    )
    negative: LinkageSide | Literal["mirror", "none"] = Field(
        "mirror", description="anticlockwise rocking, in the same way", examples=["mirror"]
    )

    cracks: dict[Name, Crack] | None = Field(
        None,
        description="cuts whose place is where lambda is least: {body, along: [[x, y], [x, y]], cut: horizontal}",
        examples=[{"K": {"body": "lower", "along": [[0.0, 0.2], [0.0, 1.3]], "cut": "horizontal"}}],
        min_length=1,
        max_length=4,
    )

    @model_validator(mode="after")
    def _moves(self) -> Self:
        self._check_cracks()
        if GROUND in self.members:
            raise geometry_error(("bodies", GROUND), "is what joints call the ground: give it another name")
        self._check_masses("bodies")
        sides = {direction: getattr(self, direction.label) for direction in Direction}
        for direction, side in sides.items():
            if direction in self._sides:
                self._check_names(direction, self._cracked.sides[direction])
            elif side == "mirror" and not isinstance(sides[direction.opposite], LinkageSide):
                raise geometry_error(direction.label, "is the mirror of the other direction, which gives no joints")
            elif side == "none" and self.one_sided != direction.opposite.label:
                raise geometry_error(
                    direction.label,
                    f"it cannot rock that way only if it leans: give one_sided: {direction.opposite.label}",
                )
        for direction in self.directions:
            self._check_moves(direction)
        return self

    def _check_cracks(self) -> None:
        for name, crack in (self.cracks or {}).items():
            shape = self.members.get(crack.body)
            if shape is None or shape.polygon is None or shape.inertia is not None:
                why = (
                    f"can only cut a polygon, and {crack.body!r} is not one"
                    if shape
                    else f"there is no body {crack.body!r}"
                )
                raise geometry_error(("cracks", name, "body"), why)
            others = {each.cut for each in (self.cracks or {}).values() if each.body == crack.body}
            if len(others) > 1:
                raise geometry_error(
                    ("cracks", name, "cut"), f"{crack.body} is also cut the other way: use one orientation per body"
                )
        for direction, side in self._sides.items():
            named = active(side, self.cracks or {})
            if len(named) > MAX_CRACKS:
                raise geometry_error(direction.label, f"{', '.join(named)} are too many: one or two in a direction")

    def _check_names(self, direction: Direction, side: LinkageSide) -> None:
        bodies = self._cracked.shapes
        known = ", ".join(bodies)
        if side.lead not in bodies:
            raise geometry_error((direction.label, "lead"), f"there is no body {side.lead!r}; the bodies are {known}")
        for name, each in side.joints.items():
            where = (direction.label, "joints", name)
            for body in each.bodies:
                if body not in bodies and not (body == GROUND and each.fixed is not None):
                    why = "use pivot, or slide with one body, for joints with the ground" if body == GROUND else (
                        f"there is no body {body!r}; the bodies are {known}"
                    )  # fmt: skip
                    raise geometry_error(where, why)
            if isinstance(each.at, str):
                raise geometry_error((*where, "at"), f"must be a point [x, y], got {each.at!r}")

    def _check_moves(self, direction: Direction) -> None:
        """Raise an error if the joints allow no motion, a motion the wrong way, or one that closes a face."""
        try:
            linkage = self._linkages[direction]
        except NoMotion as error:
            raise self._refused(direction, error.joint, error.reason) from None
        held, motions = self._held[direction], linkage.motions(np.zeros(1))
        if (wrong := turns_the_wrong_way(self._members, held.lead, motions, direction)) is not None:
            raise geometry_error(direction.label, wrong)
        for fault in (beside(self._members, held), closing(self._members, held, motions)):
            if fault is not None:
                raise self._refused(direction, *fault)

    def _refused(self, direction: Direction, joint: str | None, reason: str) -> PydanticCustomError:
        """Return an error at the place of a joint in the file; a mirrored joint has no place of its own."""
        has_joints = joint is not None and isinstance(getattr(self, direction.label), LinkageSide)
        return geometry_error((direction.label, "joints", joint or "") if has_joints else direction.label, reason)

    # Masses

    @cached_property
    def _whole(self) -> Mapping[str, Member]:
        """All bodies as given, before cracks divide them, by name."""
        return {name: shape.member(name, self.density, self.depth) for name, shape in self.members.items()}

    @cached_property
    def _members(self) -> Mapping[str, Member]:
        """The bodies by name, with the masses of the file, or relative ones."""
        shapes = self._cracked.shapes
        return {name: shape.member(name, self.density, self.depth) for name, shape in shapes.items()}

    @property
    def _shapes(self) -> Mapping[str, Shape]:
        return self._cracked.shapes

    # Motion

    @cached_property
    def _sides(self) -> Mapping[Direction, LinkageSide]:
        """The joints of the directions of rocking, as given or mirrored."""
        sides = {}
        for direction in self.directions:
            side, other = (getattr(self, each.label) for each in (direction, direction.opposite))
            if side == "mirror" and isinstance(other, LinkageSide):
                side = mirrored(other, self._middle, self._images(direction))
            if isinstance(side, LinkageSide):
                sides[direction] = side
        return sides

    @cached_property
    def _cracked(self) -> Cracked:
        """Bodies and joints, with the cracks where lambda is least."""
        cracks = self.cracks or {}
        return cracked(self.members, self._sides, cracks, self._shares)

    @cached_property
    def _shares(self) -> Mapping[Direction, Mapping[str, float]]:
        return {direction: self._weakest(direction, side) for direction, side in self._sides.items()}

    def _weakest(self, direction: Direction, side: LinkageSide) -> Mapping[str, float]:
        """Return the fractions along their lines at which the cracks of a direction give the least lambda."""
        cracks = {name: (self.cracks or {})[name] for name in active(side, self.cracks or {})}
        if not cracks:
            return {}

        def at(shares: Mapping[str, float]) -> float:
            shares_of_cracks = cracked(self.members, {direction: side}, cracks, {direction: shares})
            kept = {key: getattr(self, key) for key in ("density", "depth", "mass", "gravity") if getattr(self, key)}
            loads = [
                load.model_copy(update={"body": shares_of_cracks.piece(load.body, complex(*load.at))})
                if load.body
                else load
                for load in self.loads or []
            ]
            ties = [_on_pieces(tie, shares_of_cracks) for tie in self.ties or []]
            sides = {direction.label: shares_of_cracks.sides[direction], direction.opposite.label: "none"}
            leans = {"one_sided": direction.label, "rebound": 0.0}
            one = Linkage.from_fields(
                {
                    "members": shares_of_cracks.shapes,
                    **sides,
                    **leans,
                    **kept,
                    "loads": loads or None,
                    "ties": ties or None,
                }
            )
            return one.uplift(direction)

        failed: list[Exception] = []

        def lambda_at(shares: Mapping[str, float]) -> float:
            try:
                return at(shares)
            except (ValidationError, MechanismError) as error:
                failed.append(error)
                return inf

        shares_of_cracks = weakest(lambda_at, list(cracks))
        if not lambda_at(shares_of_cracks) < inf:
            raise failed[-1]
        return shares_of_cracks

    @property
    def _middle(self) -> float:
        """x of the vertical line halfway between the outermost points [m]."""
        x = [z.real for each in self._whole.values() for shape in each.outlines for z in shape]
        x += [each.body.centroid.real for each in self._whole.values()]
        return (min(x) + max(x)) / 2

    def _images(self, direction: Direction) -> Mapping[str, str]:
        """Return the mirror image of each body, which is another body or the same."""
        bodies = [member.body for member in self._whole.values()]
        points = [z for member in self._whole.values() for shape in member.outlines for z in shape]
        size = max(abs(z - self._middle) for z in [*points, *(body.centroid for body in bodies)])
        images = {}
        for body in bodies:
            at = complex(2 * self._middle - body.centroid.real, body.centroid.imag)
            images_of_body = [
                other.name
                for other in bodies
                if abs(other.centroid - at) <= MIRROR_DISTANCE * size
                and abs(other.mass - body.mass) <= MIRROR_DISTANCE * body.mass
                and abs(other.inertia - body.inertia) <= MIRROR_DISTANCE * (body.inertia + body.mass * size**2)
            ]
            if not images_of_body:
                raise geometry_error(
                    direction.label,
                    f"{body.name} has no mirror image among the bodies: give the joints of both directions",
                )
            images[body.name] = images_of_body[0]
        for name, crack in (self.cracks or {}).items():
            if images[crack.body] != crack.body or crack.cut == "vertical":
                why = f"the crack {name} has no mirror image: give the joints of both directions"
                raise geometry_error(direction.label, why)
        return images

    @cached_property
    def _held(self) -> Mapping[Direction, PlacedSide]:
        return {direction: PlacedSide.of(side) for direction, side in self._cracked.sides.items()}

    @cached_property
    def _linkages(self) -> Mapping[Direction, LinkageMotion]:
        centres = {name: each.body.centroid for name, each in self._members.items()}
        return {
            direction: LinkageMotion(centres, held.joints, held.lead, direction, held.fixed, held.ground, held.end)
            for direction, held in self._held.items()
        }

    def _linkage(self, direction: Direction) -> LinkageMotion:
        if direction not in self._linkages:
            raise StructureError(f"it cannot rock in the {direction.label} direction")
        return self._linkages[direction]

    def piece(self, body: str, at: complex) -> str:
        return self._cracked.piece(body, at)

    def extras(self, direction: Direction) -> Sequence[Extra]:
        extras = []
        for name, share in self._shares.get(direction, {}).items():
            crack = (self.cracks or {})[name]
            what = "height" if crack.cut == "horizontal" else "place"
            at_end = not 10 * MIN_EDGE_DISTANCE < share < 1 - 10 * MIN_EDGE_DISTANCE
            more = ", at the end of its line: beyond, lambda may be less" if at_end else ", where lambda is least"
            extras.append(Extra(f"crack_{name}", crack.level(share), "m", f"{what} of the crack {name}{more}"))
        return extras

    # Contacts and drawing

    def joints(self, direction: Direction) -> Sequence[Joint]:
        if direction not in self._held or not self._linkages[direction].determinate:
            return ()  # with redundant joints, the distribution of forces is unknown
        held = self._held[direction].joints
        if any(isinstance(each, Guide) and len(each.bodies) > 1 for each in held):
            return ()  # forces on a guide that turns with a body are not analysed
        return [self._joint(each, direction, self._linkages[direction].resting) for each in held]

    def _joint(self, each: Pin | Guide, direction: Direction, ground: Collection[str]) -> Joint:
        """Return a hinge with its face, or a guide of the ground; bodies in `ground` count as the ground."""
        names, letter = each.bodies, self._letter(each.name, direction)
        if isinstance(each, Guide):
            return Joint(letter, each.at, names, slide=each.along / abs(each.along))
        face = face_of(self._members, each, self._held[direction].given)
        normal = face.normal if face is not None else 1j
        if len(names) == 1:
            return Joint(letter, each.at, names, normal=normal)
        if any(name in ground for name in names):
            moves = next(name for name in names if name not in ground)
            return Joint(letter, each.at, (moves,), normal=normal if moves == names[1] else -normal)
        flat = names[face.inside] if face is not None and face.inside is not None else None
        if normal.imag < 0:  # the second body supports the first
            names, normal = names[::-1], -normal
        return Joint(letter, each.at, names, normal=normal, face=flat or names[0])

    def pieces(self, direction: Direction) -> Sequence[Piece]:
        """Return the bodies, without those at rest whose joint with the ground is not checked."""
        return [each for each in super().pieces(direction) if each.of not in self._anchored[direction]]

    @cached_property
    def _closed(self) -> Mapping[Direction, Mapping[tuple[str, str], Sequence[Contact]]]:
        """Fixed joints of a direction, and the faces on which they may open or slide; none if they are not checked."""
        closed: dict[Direction, dict[tuple[str, str], list[Contact]]] = {}
        for direction, held in self._held.items():
            of_pairs = closed.setdefault(direction, {})
            for each in held.given.values():
                if each.fixed is not None:
                    pair = (each.fixed[0], each.fixed[1])
                    others = of_pairs.get(pair, []) if each.face is not None else []  # a pair may have several faces
                    of_pairs[pair] = [*others, *self._faces_of(pair, each)]
        return closed

    def _faces_of(self, pair: tuple[str, str], joint: Connection) -> Sequence[Contact]:
        """Return the faces of a fixed joint, as given or as the shapes have them; none if it is bonded."""
        if joint.bonded:
            return []
        contacts = self._closed_faces(pair) if joint.ends is None else [_bearing(pair, joint.ends, joint.normal)]
        return [replace(each, friction=self._friction_of(joint)) for each in contacts]

    def _friction_of(self, joint: Connection) -> float | None:
        return self.friction if joint.friction is None else joint.friction

    def _closed_faces(self, pair: tuple[str, str]) -> Sequence[Contact]:
        """Return the faces between two bodies, or a body and the level ground below it, as closed joints."""
        shapes = [self._members[name].outlines for name in pair if name != GROUND]
        if len(shapes) == 1:
            (body,) = (name for name in pair if name != GROUND)
            ends = lowest_side(shapes[0])
            return [] if ends is None else [Contact((None, body), ends, face=None, friction=self.friction)]
        contacts: list[Contact] = []
        for normal, ends in shared_sides(*shapes):
            contact = replace(_bearing(pair, ends, normal), friction=self.friction)
            name = contact.label + (f", face {len(contacts) + 1}" if contacts else "")
            contacts.append(replace(contact, name=name))
        return contacts

    @cached_property
    def _anchored(self) -> Mapping[Direction, Collection[str]]:
        """Bodies that count as the ground, because no joint between them and the ground may open."""
        anchored = {}
        for direction, closed in self._closed.items():
            names = {GROUND}
            for _ in closed:
                names |= {
                    name for pair, faces in closed.items() if not faces and names.intersection(pair) for name in pair
                }
            anchored[direction] = names
        return anchored

    def contacts(self, direction: Direction) -> Sequence[Contact] | None:
        if direction not in self._held:
            return None
        bearing, ground = [], self._anchored[direction]
        for joint in self._held[direction].joints:
            if not isinstance(joint, Guide) or len(joint.bodies) == 1:
                friction = self._friction_of(self._held[direction].given[joint.name])
                bearing += of_joints([self._joint(joint, direction, ground)], friction)
                continue
            # A point of the first body on a line that turns with the second.
            point, line = (None if name in ground else name for name in joint.bodies)
            along = joint.along / abs(joint.along)
            bearing.append(Contact((line, point), (joint.at,), 1j * along, face=line, held="slide"))
        for pair, closed in self._closed[direction].items():
            if closed:
                bearing += [_on_ground(each, ground) for each in closed]
            elif not any(name in ground for name in pair):
                bearing.append(Contact(pair, (self._members[pair[0]].body.centroid,), held="fixed"))
        return bearing

    def contacts_at_rest(self) -> Sequence[Contact] | None:
        """Return the joints of all directions, faces on which bodies lie without a joint, and whole feet."""
        contacts = super().contacts_at_rest()
        if contacts is None:
            return None
        ground = self._anchored[self.directions[0]]
        for pair in combinations([name for name in self._members if name not in ground], 2):
            for k, face in enumerate(self._closed_faces(pair), 1):
                joined = [each for each in contacts if set(each.pieces) == set(pair)]
                if not any(each.held == "fixed" or _is_on(each, face) for each in joined):
                    contacts = [*contacts, replace(face, name=f"{face.pieces[0]} and {face.pieces[1]}, face {k}")]
        return [
            self._whole_face(each)
            if all(other.points == each.points for other in contacts if _is_of_one_face(each, other))
            else each
            for each in contacts
        ]

    def _whole_face(self, contact: Contact) -> Contact:
        """Return a joint that only hinges, at one point, with the whole face that touches at rest."""
        if contact.held is not None or len(contact.points) > 1:
            return contact
        (hinge,), bodies = contact.points, [name for name in contact.pieces if name is not None]
        # A joint of one body alone is on the ground, or on any of the bodies that count as the ground.
        fixed = [name for name in self._anchored[self.directions[0]] if name != GROUND]
        pairs = [bodies] if len(bodies) == 2 else [[name, *bodies] for name in fixed]
        faces = [face for one, other in pairs for face in self._closed_faces((one, other)) if _is_on(contact, face)]
        ends = [end for face in faces for end in face.points]
        if not ends and (face := face_at(self._members, bodies, hinge)) is not None:
            ends = [face.far]
        far = max(ends, key=lambda end: abs(end - hinge), default=hinge)
        return contact if far == hinge else replace(contact, points=(hinge, far), face=None)

    @property
    def propped(self) -> bool:
        """Whether two bodies press sideways on one another, in a structure that rocks one way."""
        if self.rocks_both_ways:
            return False
        faces = [each.normal for each in self.contacts_at_rest() or () if None not in each.pieces]
        return any(abs(normal.real) > abs(normal.imag) for normal in faces)

    def asserted(self) -> Sequence[str]:
        bonds = [pair for closed in self._closed.values() for pair, faces in closed.items() if not faces]
        words = dict.fromkeys(f"the bond of {' and '.join(sorted(pair, key=GROUND.__eq__))}" for pair in bonds)
        return [*super().asserted(), *words]

    def _letter(self, name: str, direction: Direction) -> str:
        """Return the letter of a joint, with a prime for a mirror image."""
        return f"{name}{direction.prime}" if getattr(self, direction.label) == "mirror" else name

    def sketch(self) -> Sketch:
        return Sketch(
            outlines={name: each.outlines for name, each in self._members.items() if each.outlines},
            hinges={direction: self._pictured(direction) for direction in self.directions},
            ground=self._under_what_rests(),
        )

    def _under_what_rests(self) -> Sequence[Sequence[complex]]:
        """Return a level ground line below bodies fixed to the ground; without it, ground is drawn at the pivots."""
        names = {name for held in self._held.values() for name in held.ground}
        points = [z for name in names for shape in self._members[name].outlines for z in shape]
        if not points:
            return []
        x, y = [z.real for z in points], min(z.imag for z in points)
        room = max(max(x) - min(x), 0.1 * abs(self._middle - min(x)))
        return [(complex(min(x) - room, y), complex(max(x) + room, y))]

    def _pictured(self, direction: Direction) -> Sequence[Hinge]:
        return self.joints(direction) or [
            Hinge(self._letter(each.name, direction), each.at, each.bodies)
            for each in self._held[direction].joints
            if not isinstance(each, Guide)
        ]


def _bearing(pair: tuple[str, str], ends: tuple[complex, complex], normal: complex) -> Contact:
    """Return a face between two bodies, or a body and the ground, as a closed joint; `normal` is out of the first."""
    one, other = (None if name == GROUND else name for name in pair)
    if other is None or (one is not None and normal.imag < 0):  # the second body supports the first
        one, other, normal = other, one, -normal
    return Contact((one, other), ends, normal, one)


def _on_ground(contact: Contact, ground: Collection[str]) -> Contact:
    """Return a joint in which the bodies that count as the ground are replaced by the ground."""
    one, other = (None if name in ground else name for name in contact.pieces)
    return replace(contact, pieces=(one, other), face=None if contact.face in ground else contact.face)


def _is_of_one_face(one: Contact, other: Contact) -> bool:
    """Return whether two contacts are one joint, in either direction of rocking."""
    return one.label == other.label and abs(one.normal - other.normal) <= MIRROR_DISTANCE


def _is_on(contact: Contact, face: Contact) -> bool:
    """Return whether a joint bears on a face between the same two bodies."""
    start, end = face.points
    along = (end - start) / abs(end - start)
    off = max(abs(((at - start) * along.conjugate()).imag) for at in contact.points)
    return off <= MIRROR_DISTANCE * abs(end - start) and abs((along.conjugate() * contact.normal).real) <= MAX_SINE


def _on_pieces(tie: Tie, pieces: Cracked) -> Tie:
    """Return a tie whose ends are on the pieces of cut bodies."""

    def moved(place: Place) -> Place:
        return place.model_copy(update={"body": pieces.piece(place.body, place.point)}) if place.body else place

    changed = {key: moved(place) for key in ("start", "end") if (place := getattr(tie, key)) is not None}
    return tie.model_copy(update={**changed, **({"path": [moved(each) for each in tie.path]} if tie.path else {})})
