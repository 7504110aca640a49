"""The rectangular rocking block [paper, Section 2.1; Housner 1963], and what all bodies on two feet have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import atan2, cos, isclose, pi, sin
from typing import ClassVar, Literal, Self

from pydantic import model_validator

from rocking_cli.core import (
    Angle,
    Body,
    Contact,
    Direction,
    Joint,
    Length,
    Mechanism,
    Outline,
    Reals,
    RigidMotion,
    Sketch,
    Solid,
    box,
    geometry_error,
    length,
    quantity,
    rectangle,
    rotation,
)
from rocking_cli.core.equivalence import EQUAL_DIRECTIONS

ROUND_FOOT = "Its foot is round: it may roll on its rim, out of the plane of motion, which is not modelled."


class SingleBody(Mechanism):
    """A rigid body on two foot corners; a subclass gives its one body, its feet and its limit."""

    def feet(self) -> tuple[complex, complex]:
        """Return the left and right foot corner [m], by default symmetric about the centroid at x = 0."""
        raise NotImplementedError

    def rolls(self, direction: Direction) -> float:
        """Return the radius of the rounded edge on which the body rolls [m]; 0 if it is not rounded."""
        return 0.0

    def pivot(self, direction: Direction) -> complex:
        """Return the ground contact at the start of rocking [m]: the foot, moved inwards if the foot crushes."""
        left, right = self.feet()
        return (right if direction > 0 else left) - direction * self.inwards(direction, "foot")

    def bearing(self, direction: Direction) -> Mapping[str, float]:
        return {"foot": self.borne(direction)}

    def centre(self, direction: Direction) -> complex:
        """Return the centre of rotation at rest [m]: the pivot, or the centre of the circle on which the body rolls."""
        return self.pivot(direction) + 1j * self.rolls(direction)

    def arm(self, direction: Direction) -> complex:
        """Return the vector from the centre of rotation to the centroid [m]; its length is R."""
        return self.bodies()[0].centroid - self.centre(direction)

    def alpha(self, direction: Direction) -> float:
        """Return the angle of R from the vertical at rest [rad]."""
        arm = self.arm(direction)
        return atan2(-direction * arm.real, arm.imag)

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        turning, rolling = rotation(phi, self.centre(direction), -direction), direction * self.rolls(direction)
        return (replace(turning, q=turning.q + rolling * phi, dq=turning.dq + rolling),)  # the foot rolls without slip

    def joints(self, direction: Direction) -> Sequence[Joint]:
        # A rolling body changes its contact point: only the sum of its forces is known.
        return () if self.rolls(direction) else (self._foot_joint(direction),)

    def guiding_joints(self, direction: Direction) -> Sequence[Joint]:
        return (self._foot_joint(direction),)

    def contacts(self, direction: Direction) -> Sequence[Contact] | None:
        foot = Contact((None, self.bodies()[0].name), (self.centre(direction),), friction=self.friction)
        return [replace(foot, roll=self.rolls(direction))]

    def _foot_joint(self, direction: Direction) -> Joint:
        name = self.bodies()[0].name
        return Joint("O" + direction.prime, self.pivot(direction), (name,), roll=self.rolls(direction))

    def critical_rotation_alone(self, direction: Direction) -> float:
        return self.alpha(direction)  # the centroid stands over the pivot

    def outlines(self) -> Sequence[Outline]:
        """Return the shapes of the body; empty if they are not known."""
        return ()

    def lengths(self) -> Sequence[Length]:
        """Return the fields that are lengths, which drawings show beside alpha, instead of R."""
        return ()

    def sketch(self) -> Sketch:
        (body,) = self.bodies()
        centres = {side: self.centre(side) for side in Direction}
        alike = isclose(self.alpha(Direction.POSITIVE), self.alpha(Direction.NEGATIVE), rel_tol=1e-9)
        sides = [Direction.POSITIVE] if alike else list(Direction)
        subscript = {Direction.POSITIVE: "" if alike else "₊", Direction.NEGATIVE: "₋"}
        sizes = self.lengths()
        return Sketch(
            outlines={body.name: self.outlines()} if self.outlines() else {},
            hinges={side: [self._foot_joint(side)] for side in Direction},
            lengths=[*sizes, *(Length(f"R{subscript[s]}", centres[s], body.centroid, s, bool(sizes)) for s in sides)],
            angles=[Angle(f"α{subscript[s]}", centres[s], centres[s] + 1j, body.centroid, s) for s in sides],
        )


class Block(SingleBody):
    """A uniform rectangle on its base, or an upright cylinder."""

    mechanism: ClassVar[str] = "block"
    title: ClassVar[str] = "rectangular block"
    suits: ClassVar[str] = "pedestal, pillar, cabinet, parapet, facade free at its top"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Eqs. 1-6; Housner (1963)"
    verified: ClassVar[str] = "closed forms p^2 = 3g/(4R), lambda = tan(alpha), eta = 1 - 1.5 sin^2(alpha)"

    width: float = length("width of the base", symbol="2b", example=0.7)
    height: float = length("height", symbol="2h", example=2.8)
    plane: Literal["width"] | None = quantity(
        "`width` if it cannot rock about its depth, as a part of a wall or held by what the file does not name",
        example="width",
        default=None,
    )
    section: Literal["round"] | None = quantity(
        "`round` if its plan is a circle with the width as diameter", example="round", default=None
    )

    @model_validator(mode="after")
    def _round_has_no_depth(self) -> Self:
        for field in ("depth", "plane"):
            if self.section is not None and getattr(self, field) is not None:
                raise geometry_error(field, "cannot be combined with section: round, which has no other side")
        return self

    def bodies(self) -> Sequence[Body]:
        block = box("block", 1.0, self.width, self.height, 0.5j * self.height)
        if self.section is None:
            return (block,)
        return (replace(block, inertia=(0.75 * self.width**2 + self.height**2) / 12),)

    def round_foot(self) -> tuple[float, float] | None:
        return None if self.section is None else (self.width / 2, self.width**2 / 8)

    def volume(self) -> float:
        """Return the volume [m3], of a round block without regard to `depth`."""
        return super().volume() if self.section is None else pi / 4 * self.width**2 * self.height

    def solids(self) -> Mapping[str, Sequence[Solid]]:
        if self.section is None or self.density is None:
            return super().solids()
        return {"block": [Solid("disc", (self.width / 2,), self.density, self.height)]}

    def feet(self) -> tuple[complex, complex]:
        return -self.width / 2 + 0j, self.width / 2 + 0j

    def limit(self, direction: Direction) -> float:
        return pi / 2  # the block lies on its side

    def weaker_side(self) -> Mechanism | None:
        """Return the block as it rocks about its depth, if that is the weaker side; None if it is not, or not free.

        A block is taken to be alone, and not a part of a wall, if it leans on nothing, has no ties and no interlock,
        carries nothing but masses (no floor, no force, no mass per metre of wall), and `plane` is not given. Its masses
        are then above the middle of its depth; off the middle of its width, they may make this the weaker side. A wall
        given by the metre is at least as deep as it is thick, so that this never applies to it. With `crushing` the
        strip at its foot is known for the given side only.
        """
        if self.depth is None or not self.depth < self.width or not self.may_rock_about_depth():
            return None
        loads = self.loads or ()
        centred = [{**load.model_dump(exclude_unset=True), "at": [0.0, load.at[1]]} for load in loads]
        turned = self.model_copy(update={"width": self.depth, "depth": self.width, "loads": centred or None})
        aside = any(load.at[0] for load in loads)  # masses off the middle may make the width the weaker side
        upright, about_depth = (min(map(each.uplift, Direction)) for each in (self, turned))
        return None if aside and upright < (1 - EQUAL_DIRECTIONS) * about_depth else turned

    def may_rock_about_depth(self) -> bool:
        free = self.section is None and self.plane is None and self.one_sided is None
        alone = free and not (self.ties or self.interlock or self.crushing)
        return alone and all(load.mass is not None and load.floor is None for load in self.loads or ())

    def own_caution(self) -> str:
        """Return a caution if the block is round, or may rock about its depth, with its lambda, and about a corner."""
        if self.section is not None:
            return ROUND_FOOT
        weaker = self.weaker_side()
        if weaker is None:
            return ""
        lambda_, other = (min(map(each.uplift, Direction)) for each in (self, weaker))
        return (
            f"Its depth, {self.depth:.4g} m, is less than its width: about its depth lambda is {other:.4g} instead of "
            f"{lambda_:.4g}, and that side governs unless something holds it. Exchange the two to analyse it, or give "
            "`plane: width`. Under motion oblique to its sides it rocks about a corner, which is not modelled."
        )

    def rebound_from_impacts(self) -> float | None:
        """Return the rebound by Housner's impacts in sequence; None with masses on the block, or if it is round.

        See Sorrentino, Al Shawa and Decanini (2011).
        """
        laden = any(not load.is_force for load in self.loads or ())
        if self.section is not None or self.crushing is not None or laden:
            return None
        sine, cosine = sin(self.alpha(Direction.POSITIVE)), cos(self.alpha(Direction.POSITIVE))
        return (1 - 1.5 * sine**2) ** 2 * abs(1 - 1.5 * cosine**2)

    def outlines(self) -> Sequence[Outline]:
        return (rectangle(0.5j * self.height, self.width, self.height),)

    def lengths(self) -> Sequence[Length]:
        left, right = self.feet()
        return Length("2b", left, right), Length("2h", left, left + 1j * self.height)

    def sketch(self) -> Sketch:
        return replace(super().sketch(), uniform=self.section is None)
