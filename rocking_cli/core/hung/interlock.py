"""Friction of crossing walls, which restrain a facade through the courses of masonry that they share with it."""

from __future__ import annotations

from pydantic import Field

from rocking_cli.core.fields import Described, Name, length, quantity
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.hung.elements import ConstantForce

NAME = "interlock"
SHARE = 0.4  # share of the sliding force of all courses that the code counts, for blocks laid with care
ARM = 1 / 3  # height of the resultant friction of courses under their own weight, over the height


class Interlock(Described):
    """Friction between the courses of a facade and of its crossing walls [Circolare 7/2019, C8.7.1.2].

    F = 0.4 n (n + 1) (h_b/l) mu l^2 t_s w of each crossing wall, at a third of the height above the foot: constant,
    against the motion in either direction, and without inertia. The load on the crossing walls is neglected, and so is
    the separation of blocks that have slid by their overlap: a time history is not valid beyond that.
    """

    courses: int = quantity("number of courses in the height", symbol="n", example=40, ge=1, le=10_000)
    overlap: float = quantity("length by which blocks overlap", unit="m", symbol="l", example=0.2, gt=0, le=3)
    thickness: float = quantity("thickness of a crossing wall", unit="m", symbol="t_s", example=0.5, gt=0, le=20)
    friction: float = quantity("coefficient of friction", symbol="mu", example=0.577, default=0.577, gt=0, le=2)
    walls: int = quantity("number of crossing walls", example=2, default=1, ge=1, le=100)
    height: float = length("height of the courses above the foot", symbol="h", example=8.0)
    density: float | None = quantity(
        "density of the crossing walls; if omitted, that of the structure", unit="kg/m3", default=None, gt=0, le=1e6
    )
    body: Name | None = Field(
        None, description="the body they hold, by its name in the picture; optional for a single body"
    )

    def force(self, density: float, gravity: float) -> float:
        """Return the friction force of one crossing wall [N].

        Parameters
        ----------
        density : float
            Density of the crossing walls [kg/m3].
        gravity : float
            Gravitational acceleration [m/s2].

        Examples
        --------
        >>> walls = Interlock(courses=40, overlap=0.2, thickness=0.5, walls=2, height=8.0)
        >>> round(walls.force(18000 / 9.80665, 9.80665))
        136264
        """
        n, course = self.courses, self.height / self.courses
        weight = density * gravity  # w, per volume
        return SHARE * n * (n + 1) * (course / self.overlap) * self.friction * self.overlap**2 * self.thickness * weight

    def attached(self, foot: Spot, density: float, gravity: float) -> ConstantForce:
        """Return the friction of all crossing walls as one force on the body whose foot is at a point."""
        spot = Spot(foot.body, foot.at + 1j * ARM * self.height)
        return ConstantForce(NAME, spot, complex(-self.walls * self.force(density, gravity)), friction=True)
