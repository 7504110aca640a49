"""What every single rigid body shares: it turns about the foot corner on the side it rocks to."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2

from rocking_cli.core import Direction, Mechanism, Reals, RigidMotion, rotation


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

    def critical_rotation(self, direction: Direction) -> float:
        return self.alpha(direction)  # the centroid stands over the pivot
