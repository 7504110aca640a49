"""Loads and ties attached to a mechanism beside its own bodies, as the equation of motion sees them.

    (I + ...) phi.. + (J + ...) phi.^2 + (g + v_g'') G + Q = -s B u_g'',   Q = N L' - F.r'

A load adds its mass to I, J, G and B by its shares; a tie and a force add to Q, which does not scale with g.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.kinematics import Direction, Points


class Path(NamedTuple):
    """Where a point goes over the rotations: its place and first two derivatives in phi, each shape (n,)."""

    z: Points
    dz: Points
    ddz: Points


class Spot(NamedTuple):
    """A point of a body, or of the ground (None), by its place at rest [m]."""

    body: str | None
    at: complex

    def as_dict(self) -> dict[str, Any]:
        """Its body and its place [x, y]."""
        return {"body": self.body, "at": [self.at.real, self.at.imag]}


Follow = Callable[[Spot], Path]
"""Gives the path of a point."""


class Push(NamedTuple):
    """A force on a point of a body, or of the ground."""

    spot: Spot
    force: Points  # Fx + i Fy [N], shape (n,)


class Attached(Protocol):
    """Something attached to a mechanism."""

    @property
    def name(self) -> str:
        """What it is called."""
        ...

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add its share to coefficients."""
        ...

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """The forces that it exerts on bodies and the ground, beside inertia and weight."""
        ...


@dataclass(frozen=True)
class PointMass:
    """A load whose mass counts by three shares: for horizontal and vertical inertia, and as weight.

    Parameters
    ----------
    name : str
        What it is called.
    spot : Spot
        Where it acts.
    mass : float
        [kg].
    horizontal, vertical, weight : float
        Shares of the mass, 0 to 1.
    """

    name: str
    spot: Spot
    mass: float
    horizontal: float = 1.0
    vertical: float = 1.0
    weight: float = 1.0

    @property
    def words(self) -> str:
        """Its mass and its shares."""
        if (self.horizontal, self.vertical, self.weight) == (1, 1, 1):
            return f"{self.mass:.4g} kg"
        sideways, up, borne = (f"{share:.3g}" for share in (self.horizontal, self.vertical, self.weight))
        return (
            f"{self.mass:.4g} kg (share moved sideways {sideways}, share moved vertically {up}, share carried {borne})"
        )

    def as_dict(self) -> dict[str, Any]:
        """Its place, its mass and its shares."""
        shares = {"horizontal": self.horizontal, "vertical": self.vertical, "weight": self.weight}
        return {"kind": "load", **self.spot.as_dict(), "mass": self.mass, **shares}

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add it to I, J, G, B and V."""
        z, dz, ddz = follow(self.spot)
        across, up, down = (self.mass * share for share in (self.horizontal, self.vertical, self.weight))
        total.I[:] += across * dz.real**2 + up * dz.imag**2
        total.J[:] += across * dz.real * ddz.real + up * dz.imag * ddz.imag
        total.G[:] += down * dz.imag
        total.dG[:] += down * ddz.imag
        total.V[:] += down * (z.imag - self.spot.at.imag)
        total.B[:] += direction * across * dz.real
        total.dB[:] += direction * across * ddz.real

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """None: it has inertia and weight only."""
        return ()

    def product(self, one: complex, other: complex) -> float:
        """The mass inner product of two velocities of its point."""
        return self.mass * (self.horizontal * one.real * other.real + self.vertical * one.imag * other.imag)
