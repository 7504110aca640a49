"""The elements that structure files know: a constant force, an elastic tie, and a bed of springs along a face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.hung.attached import Follow, Push, Spot
from rocking_cli.core.hung.element import Element, Stretched, dot
from rocking_cli.core.kinematics import Direction, Reals


@dataclass(frozen=True)
class ConstantForce(Element):
    """A force of constant size and direction, such as the thrust of a vault; friction turns with the motion.

    Its elongation is how far its point moves against it.

    Parameters
    ----------
    name : str
        What it is called.
    spot : Spot
        Where it acts.
    thrust : complex
        Fx + i Fy [N]; of friction, as it acts while the mechanism rocks in the positive direction.
    friction : bool
        Whether its horizontal part is against the motion in either direction.
    """

    name: str
    spot: Spot
    thrust: complex
    friction: bool = False

    @property
    def words(self) -> str:
        """Its two parts, or that it is friction."""
        if self.friction:
            at = f"at y = {self.spot.at.imag:.4g} m"
            return f"a constant friction of {abs(self.thrust) / 1000:.4g} kN against the motion {at}"
        return f"a force of {self.thrust.real / 1000:.4g} kN to the right and {self.thrust.imag / 1000:.4g} kN up"

    def as_dict(self) -> dict[str, Any]:
        """Its place and its two parts."""
        kind = "friction" if self.friction else "force"
        return {"kind": kind, **self.spot.as_dict(), "force": [self.thrust.real, self.thrust.imag]}

    def in_direction(self, direction: Direction) -> complex:
        """The force while the mechanism rocks in a direction [N]."""
        return complex(direction * self.thrust.real, self.thrust.imag) if self.friction else self.thrust

    def force(self, e: Reals) -> Reals:
        """Its size."""
        return np.full(e.shape, abs(self.thrust))

    def slope(self, e: Reals, going: Reals) -> Reals:
        """Nothing."""
        return np.zeros(e.shape)

    def energy(self, e: Reals) -> Reals:
        """What moving against it takes."""
        return abs(self.thrust) * e

    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """How far its point moves against it [m]; of no force, in no direction."""
        z, dz, ddz = follow(self.spot)
        way = self.in_direction(direction) / (abs(self.thrust) or 1.0)
        return -dot(way, z - self.spot.at), -dot(way, dz), -dot(way, ddz)

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add -F.r' to Q."""
        z, dz, ddz = follow(self.spot)
        force = self.in_direction(direction)
        total.Q[:] -= dot(force, dz)
        total.dQ[:] -= dot(force, ddz)
        total.U[:] -= dot(force, z - self.spot.at)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Itself."""
        return (Push(self.spot, np.full(follow(self.spot).z.shape, self.in_direction(direction))),)


@dataclass(frozen=True)
class Spring(Stretched):
    """An elastic tie along a path of points: N = N0 + k e, in tension only, in compression only, or both.

    Parameters
    ----------
    name, spots, count, only
        See `Stretched`.
    stiffness, prestress : float
        k [N/m], and N0 at rest [N], tension positive.
    """

    stiffness: float
    prestress: float = 0.0

    @property
    def words(self) -> str:
        """Its stiffness, its force at rest and its sense."""
        sense = f", {self.only} only" if self.only else ""
        force = f", {self.prestress / 1000:.4g} kN at rest" if self.prestress else ""
        many = f"{self.count:g} ties, each" if self.count != 1 else "a tie of"
        return f"{many} {self.stiffness / 1000:.4g} kN/m{force}{sense}"

    @property
    def at_rest(self) -> tuple[float, float]:
        """Its prestress and its stiffness, also of one that is slack."""
        return self.prestress, self.stiffness

    def force(self, e: Reals) -> Reals:
        """N of one of them at an elongation [N]."""
        n = self.slack_at(e)
        if self.only == "tension":
            return np.maximum(n, 0.0)
        return np.minimum(n, 0.0) if self.only == "compression" else n

    def slope(self, e: Reals, going: Reals) -> Reals:
        """k where it acts: taut from rest on, as soon as it moves in its sense."""
        if self.only is None:
            return np.full(e.shape, self.stiffness)
        sense = -1.0 if self.only == "compression" else 1.0
        acts = (self.force(e) != 0) | ((self.slack_at(e) == 0) & (sense * going > 0))
        return np.where(acts, self.stiffness, 0.0)

    def energy(self, e: Reals) -> Reals:
        """The integral of N from rest [J]; what goes slack on the way stores no more."""
        if self.only is not None and self.stiffness > 0:
            with np.errstate(over="ignore"):
                slack = -np.float64(self.prestress) / self.stiffness  # the elongation at which it goes slack
            e = np.maximum(e, slack) if self.only == "tension" else np.minimum(e, slack)
        return self.prestress * e + self.stiffness * e**2 / 2

    def slack_at(self, e: Reals) -> Reals:
        """N0 + k e [N]."""
        return self.prestress + self.stiffness * e


@dataclass(frozen=True)
class SpringBed(Element):
    """Springs all along a face of a body, from each of its points to where that rests: k ds each.

    Their moment is that of two springs at the points of Gauss, exactly: the squared distance is quadratic along the
    face of a rigid body. Its force and elongation are the resultant of one bed and the opening of its middle.

    Parameters
    ----------
    name : str
        What it is called.
    start, end : Spot
        The ends of the face, of one body.
    modulus : float
        [N/m per metre].
    count : float
        How many of them there are.
    """

    name: str
    start: Spot
    end: Spot
    modulus: float
    count: float = 1.0

    @property
    def words(self) -> str:
        """Its modulus."""
        return f"springs of {self.modulus / 1000:.4g} kN/m per metre of its face"

    @property
    def stiffness(self) -> float:
        """That of one bed when all of its face opens alike [N/m]."""
        return self.modulus * abs(self.end.at - self.start.at)

    @property
    def stretched(self) -> Sequence[Spring]:
        """The two springs that act as it does."""
        middle, half = (self.start.at + self.end.at) / 2, (self.end.at - self.start.at) / 2
        each = self.modulus * abs(half) * self.count
        places = (middle - half / np.sqrt(3), middle + half / np.sqrt(3))
        return [Spring(self.name, (Spot(None, at), Spot(self.start.body, at)), each) for at in places]

    def as_dict(self) -> dict[str, Any]:
        """Its face and its modulus."""
        return {"kind": "bed", "path": [self.start.as_dict(), self.end.as_dict()], "modulus": self.modulus}

    def force(self, e: Reals) -> Reals:
        """The resultant of one bed when its middle has opened by e [N]."""
        return self.stiffness * e

    def slope(self, e: Reals, going: Reals) -> Reals:
        """Its stiffness."""
        return np.full(e.shape, self.stiffness)

    def energy(self, e: Reals) -> Reals:
        """What it stores when all of its face has opened by e [J]."""
        return self.stiffness * e**2 / 2

    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """The opening of its middle."""
        at = (self.start.at + self.end.at) / 2
        middle = Spring(self.name, (Spot(None, at), Spot(self.start.body, at)), self.stiffness)
        return middle.elongation(follow, direction)

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add its moment to Q."""
        for spring in self.stretched:
            spring.act(total, direction, follow)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Those of its springs."""
        return [push for spring in self.stretched for push in spring.forces(direction, follow)]
