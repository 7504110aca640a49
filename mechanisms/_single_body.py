"""What every single rigid body shares: it turns about the foot corner on the side it rocks to."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, isclose

from rocking_cli.core import (
    Angle,
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
        """Left and right foot corner [m], by default symmetric about the centroid at x = 0."""
        raise NotImplementedError

    def arm(self, direction: Direction) -> complex:
        """From the pivot of a direction to the centroid [m]; its length is R."""
        left, right = self.feet()
        return self.bodies()[0].centroid - (right if direction > 0 else left)

    def alpha(self, direction: Direction) -> float:
        """Angle of R from the vertical at rest [rad]."""
        arm = self.arm(direction)
        return atan2(-direction * arm.real, arm.imag)

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        left, right = self.feet()
        return (rotation(phi, right if direction > 0 else left, -direction),)

    def joints(self, direction: Direction) -> Sequence[Joint]:
        left, right = self.feet()
        foot = right if direction > 0 else left
        return (Joint("O" + direction.prime, foot, (self.bodies()[0].name,)),)

    def critical_rotation(self, direction: Direction) -> float:
        return self.alpha(direction)  # the centroid stands over the pivot

    def outlines(self) -> Sequence[Outline]:
        """The shapes of the body; none where they are not known."""
        return ()

    def lengths(self) -> Sequence[Length]:
        """The fields that are lengths, to show beside R and alpha."""
        return ()

    def sketch(self) -> Sketch:
        (body,) = self.bodies()
        pivots = dict(zip(Direction, reversed(self.feet()), strict=True))
        alike = isclose(self.alpha(Direction.POSITIVE), self.alpha(Direction.NEGATIVE), rel_tol=1e-9)
        shown = [Direction.POSITIVE] if alike else list(Direction)
        subscript = {Direction.POSITIVE: "" if alike else "₊", Direction.NEGATIVE: "₋"}
        return Sketch(
            outlines={body.name: self.outlines()} if self.outlines() else {},
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=[*self.lengths(), *(Length(f"R{subscript[s]}", pivots[s], body.centroid, s) for s in shown)],
            angles=[Angle(f"α{subscript[s]}", pivots[s], pivots[s] + 1j, body.centroid, s) for s in shown],
        )
