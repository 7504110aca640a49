"""Joints of a linkage in one direction as users give them, and their mirror images."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import radians
from typing import Annotated, Self

from pydantic import Field, model_validator

from rocking_cli.core import Guide, Pin, Vertex, geometry_error, point, quantity
from rocking_cli.core.fields import Described, Name

GROUND = "ground"
JOINT_KINDS = ("pivot", "hinge", "slide", "fixed")
Pair = Annotated[list[Name], Field(min_length=2, max_length=2)]


class Connection(Described):
    """A joint: the bodies it joins, and its point."""

    pivot: Name | None = Field(None, description="the body that turns about a point of the ground")
    hinge: Pair | None = Field(None, description="two bodies that share a point")
    slide: Name | Pair | None = Field(
        None, description="the body of which a point stays on a line, of the ground or of a second body"
    )
    fixed: Pair | None = Field(None, description="two bodies that do not part, or a body and ground")
    bonded: bool = Field(False, description="of fixed: glued or cramped, so that what opens there is not checked")
    at: Vertex | Name | None = point("where it is; at a crack its name and end, such as: crack left", default=None)
    along: Vertex | None = quantity("the direction of the line of a slide, [x, y]", default=None)
    face: Annotated[list[Vertex], Field(min_length=2, max_length=2)] | None = quantity(
        "both ends of the face of the first of two bodies, or of the ground, with the last body on the left; if "
        "omitted, the face follows from the polygons", unit="m", default=None,
    )  # fmt: skip
    friction: float | None = quantity(
        "its coefficient of friction; if omitted, that of the structure", default=None, ge=0, le=10
    )

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        kinds = [key for key in JOINT_KINDS if getattr(self, key) is not None]
        if len(kinds) != 1:
            raise geometry_error(kinds[1] if kinds else "hinge", "give one of pivot, hinge, slide and fixed")
        kind = kinds[0]
        for key, needed in (("at", kind != "fixed"), ("along", kind == "slide")):
            if (getattr(self, key) is not None) != needed:
                what = f"is missing: a {kind} needs it" if needed else f"cannot be combined with {kind}"
                raise geometry_error(key, what)
        if self.bonded and kind != "fixed":
            raise geometry_error(
                "bonded", f"cannot be combined with {kind}: it says that bodies that are fixed are glued"
            )
        for key in ("face", "friction"):
            if getattr(self, key) is not None and (self.bonded or kind == "slide"):
                raise geometry_error(key, "is given of a joint that does not bear on a face: leave it out")
        if self.face is not None and self.face[0] == self.face[1]:
            raise geometry_error("face", "has both ends at the same point")
        if self.along is not None and not any(self.along):
            raise geometry_error("along", "is not a valid direction: give [x, y], not both zero")
        if len(set(self.bodies)) < len(self.bodies):
            raise geometry_error(kind, f"joins {self.bodies[0]} to itself")
        return self

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies that the joint connects, in the order of the file."""
        for each in (self.pivot, self.slide):
            if isinstance(each, str):
                return (each,)
        return tuple(self.hinge or self.fixed or self.slide or ())

    @property
    def ends(self) -> tuple[complex, complex] | None:
        """Both ends of the given face [m]; None if it is not given."""
        return None if self.face is None else (complex(*self.face[0]), complex(*self.face[1]))

    @property
    def normal(self) -> complex:
        """Unit normal of the given face towards the last body."""
        start, end = self.ends or (0j, 1 + 0j)
        return 1j * (end - start) / abs(end - start)

    def renamed(self, name: Callable[[str], str], **changed: object) -> Connection:
        """Return the joint with other names of its bodies, and other fields changed too."""
        for key in JOINT_KINDS:
            value = getattr(self, key)
            if value is not None:
                changed[key] = name(value) if isinstance(value, str) else [name(body) for body in value]
        return self.model_copy(update=changed)


class LinkageSide(Described):
    """One direction of rocking: the body whose rotation is phi, and the joints."""

    lead: Name = Field(description="the body whose rotation phi is")
    joints: dict[Name, Connection] = Field(
        description="what holds the bodies, by names", min_length=1, max_length=10_000
    )
    limit_deg: float | None = quantity(
        "where the motion ends at the latest; if omitted, where it locks or the leading body lies flat", unit="deg",
        default=None, gt=0, le=180,
    )  # fmt: skip


@dataclass(frozen=True)
class PlacedSide:
    """A side in which the points of all joints are known.

    Parameters
    ----------
    lead : str
        The body whose rotation is phi.
    joints : sequence of Pin or Guide
        Joints of the bodies.
    fixings : sequence of pairs of str
        Pairs of bodies that do not part, or of a body and `GROUND`.
    end : float or None
        Largest rotation of the motion [rad]; None if not given.
    given : mapping of str to Connection
        All joints as in the file, by name.
    """

    lead: str
    joints: Sequence[Pin | Guide]
    fixings: Sequence[tuple[str, str]]
    end: float | None
    given: Mapping[str, Connection]

    @property
    def fixed(self) -> list[tuple[str, str]]:
        """Pairs of bodies that move as one."""
        return [pair for pair in self.fixings if GROUND not in pair]

    @property
    def ground(self) -> list[str]:
        """Bodies at rest."""
        return [name for pair in self.fixings if GROUND in pair for name in pair if name != GROUND]

    @classmethod
    def of(cls, side: LinkageSide) -> PlacedSide:
        """Return a side whose joints all have their points as numbers."""
        joints: list[Pin | Guide] = []
        fixings: list[tuple[str, str]] = []
        for name, each in side.joints.items():
            at = complex(*each.at) if isinstance(each.at, list) else 0j
            if each.fixed is not None:
                one, other = each.bodies
                fixings.append((one, other))
            elif each.slide is not None:
                joints.append(Guide(name, each.bodies, at, complex(*(each.along or ()))))
            else:
                joints.append(Pin(name, each.bodies, at))
        end = None if side.limit_deg is None else radians(side.limit_deg)
        return cls(side.lead, joints, fixings, end, side.joints)


def mirrored(side: LinkageSide, middle: float, images: Mapping[str, str]) -> LinkageSide:
    """Return the joints of the other direction, mirrored about the vertical line x = `middle`.

    `images` has the mirror image of each body.
    """

    def image(point: Sequence[float]) -> list[float]:
        return [2 * middle - point[0], point[1]]

    def other(name: str) -> str:
        return images.get(name, name)

    joints: dict[str, Connection] = {}
    for name, each in side.joints.items():
        changed: dict[str, object] = {}
        if isinstance(each.at, list):
            changed["at"] = image(each.at)
        elif each.at is not None:
            swapped = {"left": "right", "right": "left"}
            *words, end = each.at.split(" ")
            changed["at"] = " ".join([*words, swapped.get(end, end)])
        if each.face is not None:
            changed["face"] = [image(end) for end in each.face[::-1]]
        if each.along is not None:
            changed["along"] = [-each.along[0], each.along[1]]
        joints[name] = each.renamed(other, **changed)
    return side.model_copy(update={"lead": other(side.lead), "joints": joints})
