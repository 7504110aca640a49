"""Base class of single rigid bodies, which rotate about the foot corner on the side to which they rock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import atan2, isclose

from rocking_cli.core import (
    Angle,
    Contact,
    Direction,
    Joint,
    Length,
    Mechanism,
    Outline,
    Reals,
    RigidMotion,
    Sketch,
    rotation,
)


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
