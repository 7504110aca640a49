"""An assembly of rigid blocks on the ground, which rocks in its weakest mechanism of each direction."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cached_property, wraps
from math import ceil, isclose, isfinite, nan
from typing import Annotated, Any, ClassVar, Self, TypeVar

import numpy as np
from pydantic import ConfigDict, Field, PrivateAttr, ValidationError, model_validator

from mechanisms import _assembly as analysis
from mechanisms._laid import Bricks, Voussoirs
from mechanisms._linkage_sides import GROUND, Connection, LinkageSide
from mechanisms._linked_bodies import LinkedBodies
from mechanisms._shapes import Member, Shape
from mechanisms.linkage import Linkage
from rocking_cli.core import (
    CollapseHinge,
    CollapseMechanism,
    Contact,
    Direction,
    Extra,
    Forces,
    Guide,
    Joint,
    Line,
    LinkageMotion,
    NoMotion,
    Outline,
    Pin,
    Reals,
    Sketch,
    Vertex,
    geometry_error,
    point,
    quantity,
    rotation,
)
from rocking_cli.core.coefficients import NoCriticalRotation
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.fields import Described, Name
from rocking_cli.core.polygons import fault_of, size_of
from rocking_cli.core.reactions import Going, loading
from rocking_cli.errors import InputError, MechanismError, StructureError
from rocking_cli.text import in_short, numbered

SAME_X = 1e-6  # difference in x of hinges above one another, over the width of all hinges
SLIDING_DIFFERENCE = 1e-6  # relative difference of the multiplier and the friction at which blocks slide
SLIP_CHECK_ROTATION = 0.01  # rotation at which it is checked how a slipping face moves, over the limit
GLUE_INCREASE = 0.01  # relative increase of lambda by shear without friction from which there is a caution
ZERO_OPENING = 1e-7  # opening of a joint that counts as zero, over its length
LIGHT_WEIGHT = 1e-9  # weight of blocks that the analysis does not see, over the total weight
MAX_NAMED_LIGHT = 3  # light blocks in a message
SAME_PLACE = 1e-6  # difference of equal normals; that of equal points, over the size of the assembly
MISFIT_SHARE = 0.01  # distance of ends of joints that should be one point, over the size of the smallest block
JOINT_DECIMALS = 12  # of the points of joints in a file [m]
ZERO_ROTATION_RATE = 1e-8  # rotation rates that count as zero, over the fastest one

Coefficient = Annotated[float, Field(ge=0, le=10)]

T = TypeVar("T")
KEEP_MARK = "kept for each direction"


def per_direction(method: Callable[[Any, Direction], T]) -> Callable[[Any, Direction], T]:
    """Decorate a method of a mechanism so that its result for each direction is kept, as by `cached_property`."""

    @wraps(method)
    def answer(self: Any, direction: Direction) -> T:
        kept = self.__dict__.setdefault(KEEP_MARK, {})
        key = method.__name__, direction
        if key not in kept:
            kept[key] = method(self, direction)
        value: T = kept[key]
        return value

    return answer


EXAMPLE_BLOCKS = {
    "left": {"polygon": [[0.0, 0.0], [0.8, 0.0], [0.8, 3.0], [0.0, 3.0]]},
    "right": {"polygon": [[3.2, 0.0], [4.0, 0.0], [4.0, 3.0], [3.2, 3.0]]},
    "lintel": {"polygon": [[0.0, 3.0], [4.0, 3.0], [4.0, 3.6], [0.0, 3.6]]},
}
EXAMPLE_GROUND = {"floor": {"polygon": [[-1.0, -0.5], [5.0, -0.5], [5.0, 0.0], [-1.0, 0.0]]}}


def _pairs(corners: Outline) -> list[list[float]]:
    return [[z.real, z.imag] for z in corners]


def _rounded(points: Sequence[complex]) -> list[list[float]]:
    """Return points of joints without their rounding errors."""
    return [[round(each, JOINT_DECIMALS) + 0.0 for each in pair] for pair in _pairs(points)]


class AssemblyGround(Described):
    """A part of the ground, which does not move."""

    polygon: list[Vertex] = quantity(
        "corners [x, y] in order around it", unit="m", example=[[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.0, 0.0]],
        min_length=3, max_length=10_000,
    )  # fmt: skip

    @model_validator(mode="after")
    def _is_a_polygon(self) -> Self:
        if fault := fault_of(np.array(self.corners)):
            raise geometry_error("polygon", fault)
        return self

    @property
    def corners(self) -> tuple[complex, ...]:
        """Corners, x + iy [m]."""
        return tuple(complex(*vertex) for vertex in self.polygon)


class Support(Described):
    """A support that restrains a point of a block sideways, in both senses, such as a floor tied to a wall's top."""

    slide: Name = Field(description="the block")
    at: Vertex = point("the point of it")
    along: Vertex = quantity("the direction in which it may move, [x, y]", example=[0.0, 1.0])

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        if not any(self.along):
            raise geometry_error("along", "is not a valid direction: give [x, y], not both zero")
        return self


class Leads(Described):
    """The blocks whose rotation is phi, one for each direction."""

    positive: Name | None = Field(None, description="in the positive direction")
    negative: Name | None = Field(None, description="in the negative one")


class Assembly(LinkedBodies):
    """Rigid blocks in contact along joints without tension, on ground that does not move."""

    mechanism: ClassVar[str] = "assembly"
    title: ClassVar[str] = "assembly of rigid blocks, by its weakest mechanism"
    suits: ClassVar[str] = "dry blocks, weakest mechanism unknown: portal, arch on piers"
    source: ClassVar[str] = (
        "Livesley (1978), limit analysis of rigid blocks; DeJong and Dimitrakopoulos (2014), Section 2"
    )
    verified: ClassVar[str] = "arches, portals and stacks by hand; static and kinematic multiplier; brute force"
    caution: ClassVar[str] = (
        "The assembly rocks on the joints that open first. `rocking collapse` gives the rotation up to which no other "
        "joint opens if it is pushed slowly; beyond it joints may open or slide. Time histories state until when they "
        "are known. If friction is given, a joint that slides is assumed to open as well (associated flow), which "
        "overestimates lambda: by up to 11 % for the walls of Ferris and Tin-Loi (2001)."
    )

    starter: ClassVar[tuple[str, ...]] = ("density", "depth", "blocks", "ground")
    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True)

    _laid: tuple[str, ...] = PrivateAttr(())

    blocks: dict[Name, Shape] = Field(
        {}, description="what can move, by names: polygons, each with density and depth, or mass, centroid and inertia",
        examples=[EXAMPLE_BLOCKS], max_length=10_000,
    )  # fmt: skip
    ground: dict[Name, AssemblyGround] = Field(
        {}, description="what cannot, by names: polygons; if omitted, springings of voussoirs, a floor of bricks",
        examples=[EXAMPLE_GROUND], max_length=100,
    )  # fmt: skip
    voussoirs: Voussoirs | None = Field(
        None, description="blocks v1, v2, ... from the left: a circular arch, {span, rise, thickness, count}",
        examples=[{"span": 6.0, "rise": 2.0, "thickness": 0.5, "count": 11}],
    )  # fmt: skip
    bricks: Bricks | None = Field(
        None, description="blocks 1.1, 1.2, ... by courses: a wall in running bond, {wall, length, height, openings}",
        examples=[{"wall": [6.0, 4.0], "length": 0.5, "height": 0.25, "openings": [[2.0, 0.0, 3.0, 2.0]]}],
    )  # fmt: skip
    supports: dict[Name, Support] | None = Field(
        None, alias="joints", min_length=1, max_length=100,
        examples=[{"C": {"slide": "lintel", "at": [4.0, 3.6], "along": [0.0, 1.0]}}],
        description="what holds points sideways, by names: {slide: block, at: [x, y], along: [0, 1]}",
    )  # fmt: skip
    friction: float | None = quantity(
        "coefficient of friction of every joint; if omitted, joints do not slide",
        example=0.6,
        default=None,
        gt=0,
        le=10,
    )
    friction_of: dict[Name, Coefficient] | None = Field(
        None,
        description="coefficient of friction of single joints; may be 0",
        min_length=1,
        max_length=1000,
        examples=[{"left and lintel": 0.3}],
    )
    lead: Leads | None = Field(
        None,
        description="the block whose rotation phi is; if omitted, the one on the ground that turns most",
        examples=[{"positive": "left", "negative": "right"}],
    )
    gap: float | None = quantity(
        "how far apart faces may be that touch, and are fitted; if omitted, 2 per mille of the smaller block", unit="m",
        example=0.005, default=None, gt=0, le=10,
    )  # fmt: skip

    @model_validator(mode="after")
    def _holds_together(self) -> Self:
        self._lay()
        for name, shape in self.blocks.items():
            if shape.polygon is None:
                raise geometry_error(
                    ("blocks", name, "polygon"), "is missing: blocks touch along the sides of polygons"
                )
        for name in self.ground:
            if name in self.blocks:
                raise geometry_error(("ground", name), "is a block too: give it another name")
        self._check_masses("blocks")
        for name, each in (self.supports or {}).items():
            self._known(each.slide, ("joints", name, "slide"))
        for direction in Direction:
            lead = getattr(self.lead, direction.label, None)
            if lead is not None:
                self._known(lead, ("lead", direction.label))
        self._contacts  # noqa: B018 - what overlaps, or touches nothing, is refused here
        return self

    def _lay(self) -> None:
        """Add the voussoirs and bricks to the blocks, and their supports to the ground if no ground is given."""
        self._laid = () if self.bricks is None else tuple(self.bricks.notes())
        laid = {key: each for key in ("voussoirs", "bricks") if (each := getattr(self, key)) is not None}
        blocks, ground = dict(self.blocks), dict(self.ground)
        for key, each in laid.items():
            for name, corners in each.blocks().items():
                if name in blocks:
                    raise geometry_error(("blocks", name), f"is the name of one of the {key}: choose another")
                blocks[name] = Shape(polygon=_pairs(corners))
            if not self.ground:
                ground |= {name: AssemblyGround(polygon=_pairs(corners)) for name, corners in each.ground().items()}
        for field, value in (("blocks", blocks), ("ground", ground)):
            if not value:
                raise geometry_error(field, "is missing: give polygons by names, or `voussoirs` or `bricks`")
            if laid:
                object.__setattr__(self, field, value)  # the model is frozen once it is made
        for key in laid:
            object.__setattr__(self, key, None)  # a copy of another size would lay them again

    def _known(self, block: str, where: tuple[str, ...]) -> None:
        if block not in self.blocks:
            raise geometry_error(where, f"there is no block {block!r}; the blocks are {in_short(list(self.blocks))}")

    def _hold_together(self) -> None:
        try:
            super()._hold_together()
        except StructureError:  # the last checks need a motion; `collapse` shows mechanisms without one
            if not any(self._no_model(direction) for direction in self.directions):
                raise
        for direction in self.directions:
            self._check_collapses(direction)
        for direction in self.directions:
            if self._collapse(direction).unique:
                self._check_lead(direction)

    def _check_collapses(self, direction: Direction) -> None:
        try:
            self._collapse(direction)
        except analysis.DoesNotStand as error:
            raise self._refused(("blocks", *error.blocks[:1]), str(error)) from None
        except analysis.NothingMoves as error:
            why = (
                f"in the {direction.label} direction {error}: all joints stay closed. Add a block that can "
                "rotate, or give `friction`, because joints without it never slide"
            )
            if self.rocks_both_ways:
                why += f"; if it leans there, give one_sided: {direction.opposite.label}"
            if misfit := self._misfit():
                why = f"in the {direction.label} direction {error}, as {misfit}"
            raise self._refused(("blocks",), why) from None
        except analysis.AssemblyFault as error:
            raise StructureError(str(error)) from None

    def _check_lead(self, direction: Direction) -> None:
        """Raise a geometry error if a given block cannot lead a mechanism."""
        told = getattr(self.lead, direction.label, None)
        if told is None or (mechanism := self._groups(direction)).slides:
            return
        number = next((k for k, group in enumerate(mechanism.groups) if told in group), None)
        turns = 0.0 if number is None else -int(direction) * float(mechanism.velocity[number, 2])
        fastest = float(np.abs(mechanism.velocity[:, 2]).max())
        if turns > ZERO_ROTATION_RATE * fastest:
            return
        does = (
            "turns the other way"
            if turns < -ZERO_ROTATION_RATE * fastest
            else "rests"
            if number is None
            else "does not turn"
        )
        able = [
            name
            for group, velocity in zip(mechanism.groups, mechanism.velocity, strict=True) for name in group
            if -int(direction) * velocity[2] > ZERO_ROTATION_RATE * fastest
        ]  # fmt: skip
        why = f"{told} {does} in the {direction.label} direction: it cannot lead; {in_short(able)} could"
        raise self._refused(("lead", direction.label), why)

    @staticmethod
    def _refused(field: tuple[str, ...], reason: str) -> Exception:
        from rocking_cli.core.hung.attachments import RefusedFields, as_validation_error

        return as_validation_error([RefusedFields(field[:-1], field[-1], reason)], Assembly.mechanism)

    # Blocks, joints and loads

    @property
    def _shapes(self) -> Mapping[str, Shape]:
        return self.blocks

    @cached_property
    def _members(self) -> Mapping[str, Member]:
        return {name: shape.member(name, self.density, self.depth) for name, shape in self.blocks.items()}

    @cached_property
    def _blocks(self) -> Sequence[analysis.AssemblyBlock]:
        return [
            analysis.AssemblyBlock(
                body.name, tuple(self.blocks[body.name].corners), body.mass, body.centroid, body.inertia
            )
            for body in self.weighed()
        ]

    @cached_property
    def _contacts(self) -> Sequence[analysis.AssemblyContact]:
        blocks = [analysis.AssemblyBlock(name, tuple(shape.corners)) for name, shape in self.blocks.items()]
        ground = [analysis.AssemblyBlock(name, each.corners) for name, each in self.ground.items()]
        pairs: dict[tuple[str, str], float | None] = {self._pair(words): mu for words, mu in self._frictions.items()}
        try:
            return analysis.contacts(blocks, ground, friction=self.friction, per_pair=pairs, within=self.gap)
        except analysis.ContactFault as error:
            names = [name for name in error.blocks if name in self.blocks]
            keys = [words for words in self._frictions if set(self._pair(words)) == set(error.blocks)]
            where = ("friction_of", keys[0]) if keys else ("blocks", *names[:1])
            raise geometry_error(where, str(error)) from None

    @property
    def _frictions(self) -> Mapping[str, float]:
        return self.friction_of or {}

    @property
    def remarks(self) -> Sequence[str]:
        """Sentences, without a full stop, on how the file was read."""
        return [*super().remarks, *self._laid]

    def _pair(self, words: str) -> tuple[str, str]:
        """Return the two bodies of a joint from words such as `a and b`; their names may contain `and` too."""
        parts = words.split(" and ")
        splits = [(" and ".join(parts[:k]), " and ".join(parts[k:])) for k in range(1, len(parts))]
        names = {*self.blocks, *self.ground}
        pairs = [pair for pair in splits if names.issuperset(pair)]
        if len(pairs) != 1 or pairs[0][0] == pairs[0][1]:
            why = (
                "fits several pairs of bodies"
                if pairs[1:]
                else "does not name a joint: write the names of two bodies, as `a and b`"
            )
            raise geometry_error(
                ("friction_of", words),
                f"{why}; the blocks are {in_short(list(self.blocks))}, on {in_short(list(self.ground))}",
            )
        return pairs[0]

    @cached_property
    def _guides(self) -> Sequence[Guide]:
        return [
            Guide(name, (each.slide,), complex(*each.at), complex(*each.along))
            for name, each in (self.supports or {}).items()
        ]

    # The weakest mechanism

    @per_direction
    def _collapse(self, direction: Direction) -> analysis.Collapse:
        bodies, rest, push = self.weighed(), np.zeros(1), -int(direction) * self.gravity
        dead, both = (
            loading(
                bodies, [rotation(rest, 0j, 0.0)] * len(bodies), self.attached, direction, self.gravity,
                Going(rest, rest, np.full(1, ground, np.complex128)),
            )[0]
            for ground in (0.0, push)
        )  # fmt: skip
        return analysis.collapse(
            self._blocks, self._contacts, self._guides, direction, dead=dead, live=both - dead, gravity=self.gravity
        )

    @per_direction
    def _groups(self, direction: Direction) -> analysis.AssemblyLinkage:
        try:
            return analysis.linkage(self._blocks, self._contacts, self._guides, self._collapse(direction))
        except analysis.AssemblyFault as error:
            raise StructureError(f"in the {direction.label} direction {error}") from None

    def _as_it_rocks(self, direction: Direction) -> Assembly:
        """Return the assembly whose weakest mechanism moves: itself, or a block that slides on its joint, frictionless.

        Joints without a coefficient of friction never slide. Time histories check whether it slides instead.
        """
        return self._unable_to_slide if len(self._contacts) == 1 and self._groups(direction).slides else self

    @cached_property
    def _unable_to_slide(self) -> Assembly:
        try:
            return self.model_copy(update={"friction": None, "friction_of": None})
        except ValidationError:  # it is confined, and can only slide
            return self

    def _joint(self, k: int) -> str:
        return _name(self._contacts[k])

    def _lead(self, direction: Direction) -> str:
        """Return the block whose rotation is phi: as given, or one of the leading group, on the ground if one is."""
        told = getattr(self.lead, direction.label, None)
        if told is not None:
            return str(told)
        mechanism = self._as_it_rocks(direction)._groups(direction)
        k = analysis.leading(mechanism, direction)
        group = mechanism.groups[k if k is not None else 0]
        hinged = {self._contacts[h.contact].b for h in mechanism.hinges if None in (h.one, h.other)}
        return next((name for name in group if name in hinged), group[0])

    @per_direction
    def _linkage(self, direction: Direction) -> LinkageMotion:
        if direction not in self.directions:
            raise StructureError(f"it cannot rock in the {direction.label} direction")
        rocking = self._as_it_rocks(direction)
        mechanism = rocking._groups(direction)  # raises an error of its own if it does not stand
        if not rocking._collapse(direction).unique:
            raise StructureError(rocking._several(direction))
        if mechanism.slides:
            where = in_short([self._joint(k) for k in mechanism.slides])
            raise StructureError(
                f"in the {direction.label} direction the mechanism slides between {where} at "
                f"{self._collapse(direction).multiplier:.4g} g{self._beside(direction)}: no rocking model exists for "
                "sliding, which free blocks can simulate. `rocking collapse` shows the mechanism and the friction "
                "required"
            )
        pins = [
            Pin(letter, tuple(name for name in (contact.a, contact.b) if name in self.blocks), at)
            for letter, contact, at in self._hinges(direction)
        ]
        fixed = [(group[0], name) for group in mechanism.groups for name in group[1:]]
        centres = {name: member.body.centroid for name, member in self._members.items()}
        rest = [name for name in mechanism.rest if name in self.blocks]
        lead = self._lead(direction)
        try:
            linkage = LinkageMotion(centres, [*pins, *mechanism.guides], lead, direction, fixed, rest)
        except NoMotion as error:
            why = error.reason
            if mechanism.lifted and self._collapse(direction).associated is not None:
                joints = [self._joint(k) for k in mechanism.lifted]
                why = f"{in_short(joints, ' and ')} slip or open without pressing: no rocking model exists for that"
            elif mechanism.lifted:
                joints = [self._joint(k) for k in mechanism.lifted]
                why = (
                    f"{in_short(joints, ' and ')} open at both ends but still carry shear, because joints without "
                    f"friction never slide: give `friction`, or `friction_of: {{{joints[0]}: 0}}`"
                )
            elif joints := [self._joint(k) for k in analysis.sheared(self._needed(direction), self._contacts)]:
                mu = f"{MASONRY_FRICTION:g}"
                why = (
                    f"the mechanism at {self._collapse(direction).multiplier:.4g} g cannot move on. More shear than a "
                    f"friction of {mu} allows is carried between {in_short(joints, ', and between ')}, because joints "
                    f"without friction never slide: give `friction`, such as {mu}"
                )
            raise StructureError(f"in the {direction.label} direction {why}") from None
        self._check_slips_off(direction, linkage)
        turns = float(linkage.motions(np.zeros(1))[lead].dpsi[0])
        number = next(k for k, group in enumerate(mechanism.groups) if lead in group)
        if turns * mechanism.velocity[number, 2] < 0:
            raise StructureError(
                f"in the {direction.label} direction {lead} turns the other way as the rest goes {direction.label}: "
                "let another block lead"
            )
        return linkage

    def _several(self, direction: Direction) -> str:
        """Return which mechanisms start together, and what makes one of them start first."""
        collapse = self._collapse(direction)
        moving = in_short(list(dict.fromkeys(in_short(each.moves, " and ") for each in collapse.several)), "; ")
        what = "Change a size or a density by a little, tie what should not part, or simulate it as free blocks"
        if self.friction is not None and isclose(collapse.multiplier, self.friction, rel_tol=SLIDING_DIFFERENCE):
            what = "This equals the friction given: the blocks slide, which free blocks alone can simulate"
        return (
            f"in the {direction.label} direction several mechanisms start at {collapse.multiplier:.6g} g, with these "
            f"moving blocks: {moving}. {what}"
        )

    def _check_slips_off(self, direction: Direction, linkage: LinkageMotion) -> None:
        """Raise an error if a corner that slips along a frictionless face does not lift off this face."""
        mechanism, phi = self._groups(direction), np.array([SLIP_CHECK_ROTATION * linkage.limit])
        motions = linkage.motions(phi)

        def carried(name: str, at: complex) -> tuple[complex, complex]:
            if name not in motions:
                return at, 1 + 0j
            return complex(motions[name].carry(at)[0][0]), complex(np.exp(1j * motions[name].psi[0]))

        for k in mechanism.lifted:
            contact = self._contacts[k]
            for end, at in enumerate(contact.ends):
                (a, turn_a), (b, turn_b) = (carried(name, at) for name in (contact.a, contact.b))
                turn = turn_a if contact.face_at(end) == contact.a else turn_b
                gap = ((b - a) * (contact.normal * turn).conjugate()).real
                if gap <= ZERO_OPENING * contact.length:
                    what = "goes into" if gap < -ZERO_OPENING * contact.length else "slides along"
                    raise StructureError(
                        f"in the {direction.label} direction {contact.b} {what} {contact.a} as it moves: no "
                        "rocking model exists for that"
                    )

    def _hinges(self, direction: Direction) -> list[tuple[str, analysis.AssemblyContact, complex]]:
        """Return letter, joint and point of each hinge, from the left."""
        hinges = self._as_it_rocks(direction)._groups(direction).hinges
        order = from_the_left([hinge.point for hinge in hinges])
        letters = [chr(65 + n) if n < 26 else f"{chr(65 + n // 26 - 1)}{chr(65 + n % 26)}" for n in range(len(order))]
        return [
            (letter + direction.prime, self._contacts[hinges[k].contact], hinges[k].point)
            for letter, k in zip(letters, order, strict=True)
        ]

    def joints(self, direction: Direction) -> Sequence[Joint]:
        if direction not in self.directions:
            return ()
        mechanism = self._groups(direction)
        joints = []
        for letter, contact, at in self._hinges(direction):
            end = 0 if abs(at - contact.start) <= abs(at - contact.end) else 1
            face = contact.face_at(end)
            names = tuple(name for name in (contact.a, contact.b) if name in self.blocks)
            joints.append(Joint(letter, at, names, normal=contact.normal, face=face if face in self.blocks else None))
        for guide in mechanism.guides:
            joints.append(Joint(guide.name, guide.at, guide.bodies, slide=guide.along / abs(guide.along)))
        return joints

    def contacts(self, direction: Direction) -> Sequence[Contact] | None:
        if direction not in self.directions:
            return None
        contacts = []
        for contact, ends in self._bearing(direction):
            # A hinge turns with the face that the corner bears on; both bodies of a closed joint turn alike.
            a, b, face = (
                name if name in self.blocks else None
                for name in (contact.a, contact.b, contact.face_at(ends[0]) if len(ends) == 1 else contact.a)
            )
            points = tuple(contact.ends[end] for end in ends)
            contacts.append(Contact((a, b), points, contact.normal, face, contact.friction, name=_name(contact)))
        for guide in self._guides:
            along = guide.along / abs(guide.along)
            contacts.append(Contact((None, guide.bodies[0]), (guide.at,), 1j * along, held="slide", name=guide.name))
        return contacts

    def _bearing(self, direction: Direction) -> Iterator[tuple[analysis.AssemblyContact, Sequence[int]]]:
        """Yield the joints that still bear in a mechanism, and at which ends: one if it hinges, or else both."""
        bear = {
            analysis.Opening.CLOSED: (0, 1), analysis.Opening.SLIDES: (0, 1),
            analysis.Opening.START: (0,), analysis.Opening.END: (1,),
        }  # fmt: skip
        states = self._as_it_rocks(direction)._groups(direction).states
        for contact, state in zip(self._contacts, states, strict=True):
            if state in bear:
                yield contact, bear[state]

    # The mechanism as a linkage

    def as_linkage(self) -> Linkage:
        """Return the linkage that moves as the weakest mechanisms: its bodies are the blocks.

        Raises `MechanismError` if a mechanism has no rocking model, `InputError` if a linkage cannot have its fields.
        """
        common = self.model_fields_set & Linkage.model_fields.keys()
        kept: dict[str, Any] = {key: value for key in common if (value := getattr(self, key)) is not None}
        if not self.rocks_both_ways:
            kept[self.directions[0].opposite.label] = "none"

        def linkage(faces: Collection[Collection[str | None]] | None) -> Linkage:
            sides = {direction.label: self._side(direction, faces) for direction in self.directions}
            return Linkage(**{"bodies": self.blocks, **kept, **sides})

        # If a drawing is rounded, a linkage does not find in the polygons which faces touch, and how they slope.
        try:
            plain = linkage(())
        except InputError:
            return linkage(None)
        tolerance = SAME_PLACE * size_of(np.concatenate([shape.corners for shape in self.blocks.values()]))
        faces = {
            pair for direction in self.directions
            for pair in _different(self.contacts(direction) or (), plain.contacts(direction) or (), tolerance)
        }  # fmt: skip
        return linkage(faces) if faces else plain

    def _side(self, direction: Direction, faces: Collection[Collection[str | None]] | None) -> LinkageSide:
        """Return the joints of a direction as those of a linkage: hinges by their letters, supports, closed joints.

        Joints of the pairs in `faces` state their faces, or all joints if it is None.
        """
        self._linkage(direction)  # raises an error if there is no rocking model
        letters = {(contact, at): letter for letter, contact, at in self._hinges(direction)}
        supports = {
            name: {"slide": each.slide, "at": each.at, "along": each.along}
            for name, each in (self.supports or {}).items()
        }
        hinges: dict[str, dict[str, Any]] = {letter: {} for letter in letters.values()}  # in the order of their letters
        closed: dict[str, dict[str, Any]] = {}
        for contact, ends in self._bearing(direction):
            at, turns = contact.ends[ends[0]], len(ends) == 1
            # The first body of a joint has the face.
            turned = turns and contact.a in self.blocks and contact.face_at(ends[0]) == contact.b
            placed = contact.turned() if turned else contact
            one, other = (name if name in self.blocks else None for name in (placed.a, placed.b))
            fields: dict[str, Any] = {}
            if faces is None or frozenset((one, other)) in faces:
                fields["face"] = _rounded(placed.ends)
            if contact.friction != self.friction:
                fields["friction"] = contact.friction
            if turns:
                fields |= {"pivot": other} if one is None else {"hinge": [one, other]}
                # Another hinge about a point at which hinges with letters imply it has no letter of its own.
                name = letters.get((contact, at)) or numbered(_name(contact), "", hinges)
                hinges[name] = {**fields, "at": _rounded([at])[0]}
            else:
                closed[numbered(_name(contact), "", closed)] = {**fields, "fixed": [one or GROUND, other]}
        joints: dict[str, Connection] = {}
        for name, fields in [item for each in (hinges, supports, closed) for item in each.items()]:
            joints[numbered(name, "", joints)] = Connection(**fields)
        return LinkageSide(lead=self._lead(direction), joints=joints)

    # Cautions and extra results

    def own_caution(self) -> str:
        """Return cautions: on confined and light blocks, and by how much joints that never slide raise lambda."""
        raised = []
        for direction in self.directions:
            lambda_, usual = self._collapse(direction).multiplier, self._with_usual(direction)
            if usual is not None and usual < (1 - GLUE_INCREASE) * lambda_:
                raised.append(f"{usual:.4g} g instead of {lambda_:.4g} g in the {direction.label} direction")
        sentences = [super().own_caution(), self._of_grains(), self._of_confined()]
        if raised:
            sentences.append(
                "Joints without `friction` never slide and may carry shear without a normal force, which raises "
                f"lambda. With a friction of {MASONRY_FRICTION:g} it would be {' and '.join(raised)}: give `friction`."
            )
        return " ".join(filter(None, sentences))

    def _beside(self, direction: Direction) -> str:
        """Return the lambda by associated flow, in brackets, for a mechanism without dilation; else an empty text."""
        associated = self._collapse(direction).associated
        if associated is None:
            return ""
        gives = f"gives {associated:.4g} g" if isfinite(associated) else "would lock it"
        return f" without dilation (associated flow {gives})"

    def _of_confined(self) -> str:
        """Return sentences on mechanisms without dilation of confined blocks."""
        lower, early = [], []
        for direction in self.directions:
            collapsed, where = self._collapse(direction), f"in the {direction.label} direction"
            if collapsed.associated is not None:
                lower.append(f"{collapsed.multiplier:.4g} g {where}{self._beside(direction)}")
            if not collapsed.complete:
                early.append(where)
        sentences = []
        if lower:
            sentences.append(
                f"Fixed sides confine blocks, and joints slide without opening: lambda is {' and '.join(lower)}."
            )
        if early:
            sentences.append(
                "Fixed sides confine blocks, where associated flow may overestimate lambda by any amount. The search "
                f"for mechanisms that slide without opening is not complete {' and '.join(early)}: lambda may be "
                "lower. Analyse fewer blocks."
            )
        return " ".join(sentences)

    def _of_grains(self) -> str:
        """Return a sentence on blocks that are too light for the analysis."""
        masses = [block.mass for block in self._blocks]
        grains = [block.name for block in self._blocks if block.mass <= LIGHT_WEIGHT * sum(masses)]
        if not grains:
            return ""
        verb = "weighs" if len(grains) == 1 else "weigh"
        return (
            f"{in_short(grains, most=MAX_NAMED_LIGHT)} {verb} no more than {LIGHT_WEIGHT:g} of the whole: the analysis "
            "does not see whether that moves earlier. Leave it out, or analyse it alone."
        )

    @per_direction
    def _with_usual(self, direction: Direction) -> float | None:
        """Return lambda with the usual friction in joints without given friction; None if all have one."""
        return analysis.with_usual(self._collapse(direction))

    @per_direction
    def _no_model(self, direction: Direction) -> str:
        """Return why the mechanism cannot be simulated, a sentence without a full stop; empty if it can."""
        try:
            self._linkage(direction)
        except MechanismError as error:
            return str(error)
        return ""

    def collapse(self, direction: Direction) -> CollapseMechanism:
        """Return the weakest mechanism of a direction. Raises `StructureError` if there is none."""
        mechanism = self._groups(direction)
        state = self._collapse(direction)
        friction, thrust = self._needed(direction), self._thrust(direction)
        parts = {name: "+".join(group) for group in mechanism.groups for name in group}
        no_model = "" if mechanism.slides and state.unique else self._no_model(direction)
        moves = not mechanism.slides and not no_model
        valid = self._valid_to(direction) if moves else None
        return CollapseMechanism(
            lambda_=self.uplift(direction) if moves else state.multiplier,
            lead=self._lead(direction) if moves else "",
            hinges=[
                CollapseHinge(
                    letter,
                    (parts.get(contact.a, contact.a), parts.get(contact.b, contact.b)),
                    at,
                    _name(contact),
                )
                for letter, contact, at in (self._hinges(direction) if not mechanism.slides else ())
            ],
            groups=mechanism.groups,
            rest=[name for name in mechanism.rest if name in self.blocks],
            lifted=[self._joint(k) for k in mechanism.lifted],
            slides=[self._joint(k) for k in mechanism.slides],
            glued=[self._joint(k) for k in friction.glued],
            with_usual=self._with_usual(direction),
            no_model=no_model,
            friction_needed=friction.needed,
            valid_to=valid[0] if valid else None,
            opens=self._joint(valid[1]) if valid else "",
            held_by=valid[2] if valid else None,
            thrust=[(self._joint(passage.contact), passage.point, passage.force) for passage in thrust.passages],
            velocities=[(complex(vx, vy), float(turn)) for vx, vy, turn in mechanism.velocity],
            idle=state.idle,
            confined=state.confined,
            associated=state.associated,
            complete=state.complete,
        )

    def _held(self, direction: Direction, phi: Reals) -> list[tuple[analysis.DisplacedAssembly, Reals, float]]:
        """Return the displaced assembly at each rotation, the forces on its blocks, and G/B.

        G/B is the acceleration over g of displaced equilibrium. All rotations are computed in one call, which takes as
        long as a single one.
        """
        there = self.coefficients(phi, direction)
        shares: Reals = there.restoring(self.gravity) / there.B
        still = np.zeros(len(phi))
        going = Going(still, still, np.asarray(-int(direction) * shares * self.gravity, np.complex128))
        bodies, motions = self.weighed(), self.motion(phi, direction)
        forces = loading(bodies, motions, self.attached, direction, self.gravity, going)
        centres = np.array([motion.carry(body.centroid)[0] for body, motion in zip(bodies, motions, strict=True)])
        turns = np.exp(1j * np.array([motion.psi for motion in motions]))
        weight, joints = self._collapse(direction).problem.weight, self._remaining(direction)
        return [
            (analysis.DisplacedAssembly(joints.moved(centres[:, k], turns[:, k]), weight), forces[k], share)
            for k, share in enumerate(shares.tolist())
        ]

    @per_direction
    def _remaining(self, direction: Direction) -> analysis.Bearings:
        """Return the joints that still bear in the mechanism of a direction."""
        return analysis.remaining(self._blocks, self._contacts, self._guides, self._groups(direction).states)

    @per_direction
    def _valid_to(self, direction: Direction) -> tuple[float, int, float] | None:
        """Return the rotation at which another joint opens in displaced equilibrium, this joint, and G/B there.

        None if no joint opens.
        """
        try:
            end = self.critical_rotation(direction)
        except NoCriticalRotation:
            # A tie prevents overturning; at the limit itself the linkage may lock.
            end = self.limit(direction) * (1 - 1e-6)
        steps = np.linspace(0.0, end, analysis.SEARCH_STEPS + 1)
        places = dict(zip(steps.tolist(), self._held(direction, steps), strict=True))
        known: Reals | None = None  # joint forces at the last rotation at which all joints hold

        def at(phi: float) -> tuple[analysis.DisplacedAssembly, Reals, float]:
            return places[phi] if phi in places else self._held(direction, np.array([phi]))[0]

        def held(phi: float) -> analysis.Admissible:
            here, forces, _ = at(phi)
            try:
                return here.admissible(forces[None])[0]
            except analysis.NoAnswer:
                why = self._misfit() or "its joints jam as it moves, and no forces in them were found"
                raise StructureError(why) from None

        def margin(phi: float) -> float:
            nonlocal known
            state = held(phi)
            known = state.forces if state.margin > 0 else None
            return state.margin

        def holds(phi: float) -> bool:
            nonlocal known
            if known is not None:
                here, forces, _ = at(phi)
                known = here.near(forces, known)
            return known is not None

        first = analysis.first_violation(margin, steps, holds=holds)
        if first is None:
            return None
        state = held(first)
        return first, state.contact if state.contact is not None else 0, at(first)[2]

    def _misfit(self) -> str:
        """Return which joints do not fit, so that bodies jam: their ends are next to each other; empty if all fit."""
        ends = [(end, contact) for contact in self._contacts for end in contact.ends]
        z = np.array([end for end, _ in ends])
        apart = np.abs(z[:, None] - z)
        least = np.array([min(size_of(np.array(shape.corners)) for shape in self.blocks.values())])
        misfit = (apart > SAME_PLACE * size_of(z)) & (apart <= MISFIT_SHARE * least)
        if not misfit.any():
            return ""
        i, j = np.unravel_index(np.where(misfit, apart, 0.0).argmax(), apart.shape)
        (at, one), (_, other) = ends[int(i)], ends[int(j)]
        return (
            f"joints do not fit, so that it jams: the ends of `{_name(one)}` and `{_name(other)}` at ({at.real:.6g}, "
            f"{at.imag:.6g}) are {1000 * apart[i, j]:.3g} mm apart, and {np.count_nonzero(misfit) // 2 - 1} more such "
            f"pairs are. Draw corners that meet at one point, or give `gap` {ceil(1000 * apart[i, j])} mm: within it, "
            "joints are fitted"
        )

    @per_direction
    def _needed(self, direction: Direction) -> analysis.Friction:
        return analysis.friction(self._collapse(direction))

    def extras(self, direction: Direction) -> Sequence[Extra]:
        rocks = self._as_it_rocks(direction)
        needed, glued = rocks._needed(direction).needed, [self._joint(k) for k in rocks._needed(direction).glued]
        if needed is not None:
            friction = Extra("friction_needed", needed, "", "friction in every joint without which lambda is less")
        else:
            which = in_short(glued) or "joints"
            up_to = f"no friction up to {analysis.MAX_FRICTION:g} does"
            why = f"{up_to}: {which} would carry shear without pressing, and lambda be less"
            friction = Extra("friction_needed", nan, "", why)
        usual = self._with_usual(direction)
        meaning = f"lambda with a friction of {MASONRY_FRICTION:g} in joints without any given"
        known = (friction,) if usual is None else (friction, Extra("lambda_with_usual", usual, "g", meaning))
        end = rocks._valid_to(direction)
        if end is None:
            return known
        phi, k, share = end
        return (
            *known,
            Extra("valid_to", phi, "rad", f"rotation at which, held there, the joint of {self._joint(k)} opens too"),
            Extra("held_by", share, "g", "the acceleration that holds it there, G/B"),
        )

    def sketch(self) -> Sketch:
        ground = []
        for shape in self.ground.values():
            z = list(analysis.AssemblyBlock("", shape.corners).outline)[::-1]  # clockwise: the ground is on the right
            ground.append([*z, z[0]])
        return Sketch(
            hinges={direction: self.joints(direction) for direction in self.directions},
            lines=[line for direction in self.directions if (line := self._thrust_line(direction)) is not None],
            forces=[forces for direction in self.directions if (forces := self._joint_forces(direction)) is not None],
            ground=ground,
            ground_names=list(self.ground),
        )

    @per_direction
    def _thrust(self, direction: Direction) -> analysis.Thrust:
        friction = self._needed(direction)
        return analysis.thrust(self._contacts, list(self.blocks), friction.normal, friction.shear)

    def _thrust_line(self, direction: Direction) -> Line | None:
        rocks = self._as_it_rocks(direction)
        line = rocks._thrust(direction)
        if not line.chain:
            return None
        name = f"a line of thrust at uplift, {rocks._collapse(direction).multiplier:.3g} g"
        return Line(name, [each.point for each in line.passages], direction)

    def _joint_forces(self, direction: Direction) -> Forces | None:
        """Return the joint forces of one state at uplift, if they do not form a line of thrust; else None."""
        line = self._thrust(direction)
        if line.chain or not line.passages:
            return None
        lambda_ = self._collapse(direction).multiplier
        name = f"forces in the joints at uplift, {lambda_:.3g} g, in one state of equilibrium"
        points, forces = zip(*((each.point, each.force) for each in line.passages), strict=True)
        return Forces(name, points, forces, direction)


def from_the_left(points: Sequence[complex]) -> list[int]:
    """Return the order of points from left to right, and from bottom to top at equal x, up to rounding."""
    x = np.array([each.real for each in points])
    order = np.argsort(x, kind="stable")
    columns = np.cumsum(np.diff(x[order], prepend=x[order][:1]) > SAME_X * np.ptp(x)) if x.size else x
    pairs = sorted(zip(columns.tolist(), order.tolist(), strict=True), key=lambda pair: (pair[0], points[pair[1]].imag))
    return [k for _, k in pairs]


def _different(ours: Sequence[Contact], others: Sequence[Contact], tolerance: float) -> set[frozenset[str | None]]:
    """Return the pairs of pieces that do not have the same contacts in two lists, to within a `tolerance` [m]."""
    by_pair: dict[frozenset[str | None], tuple[list[Contact], list[Contact]]] = {}
    for k, contacts in enumerate((ours, others)):
        for each in contacts:
            if each.held is None:
                by_pair.setdefault(frozenset(each.pieces), ([], []))[k].append(each)
    return {
        pair for pair, (one, other) in by_pair.items()
        if len(one) != len(other) or not all(any(_same(a, b, tolerance) for b in other) for a in one)
    }  # fmt: skip


def _same(one: Contact, other: Contact, tolerance: float) -> bool:
    """Return whether two contacts of the same pieces bear at the same points of the same face."""
    normal = other.normal if one.pieces == other.pieces else -other.normal
    return (
        len(one.points) == len(other.points)
        and all(min(abs(at - there) for there in other.points) <= tolerance for at in one.points)
        and abs(one.normal - normal) <= SAME_PLACE
        and (one.face == other.face or len(one.points) > 1)
    )


def _name(contact: analysis.AssemblyContact) -> str:
    """Return the name of a joint from its two bodies."""
    return f"{contact.a} and {contact.b}"
