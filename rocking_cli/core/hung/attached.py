"""Loads and ties attached to a mechanism, as terms of its equation of motion.

    (I + ...) phi.. + (J + ...) phi.^2 + (g + v_g'') G + Q = -s B u_g'',   Q = N L' - F.r'

A load adds its mass to I, J, G and B, each by the share that the load gives; ties and forces add to Q, which does not
scale with g.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.kinematics import Direction, Points


class Path(NamedTuple):
    """Path of a point over the rotations: its position [m] and first two derivatives in phi, each shape (n,)."""

    z: Points
    dz: Points
    ddz: Points


class Spot(NamedTuple):
    """A point of a body, or of the ground (body None), by its position at rest [m]."""

    body: str | None
    at: complex

    def as_dict(self) -> dict[str, Any]:
        """Return the body and the position [x, y] of the point [m]."""
        return {"body": self.body, "at": [self.at.real, self.at.imag]}


Follow = Callable[[Spot], Path]
"""A function that returns the path of a point."""


class Push(NamedTuple):
    """A force [N] on a point of a body, or of the ground."""

    spot: Spot
    force: Points  # Fx + i Fy [N], shape (n,)


class Attached(Protocol):
    """A load or an element attached to a mechanism."""

    @property
    def name(self) -> str:
        """Name of the attached thing."""
        ...

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the terms of the attached thing to the coefficients `total`."""
        ...

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Return the forces on bodies and the ground [N], other than inertia forces and weight."""
        ...


@dataclass(frozen=True)
class PointMass:
    """A load with mass, by its shares in the horizontal inertia, in the vertical inertia and in the weight.

    Parameters
    ----------
    name : str
        Name of the load.
    spot : Spot
        Point at which it acts.
    mass : float
        Mass [kg].
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
        """Description of the mass and its shares."""
        if (self.horizontal, self.vertical, self.weight) == (1, 1, 1):
            return f"{self.mass:.4g} kg"
        sideways, up, borne = (f"{share:.3g}" for share in (self.horizontal, self.vertical, self.weight))
        return (
            f"{self.mass:.4g} kg (share moved sideways {sideways}, share moved vertically {up}, share carried {borne})"
        )

    def as_dict(self) -> dict[str, Any]:
        """Return the point, the mass [kg] and the shares of the load."""
        shares = {"horizontal": self.horizontal, "vertical": self.vertical, "weight": self.weight}
        return {"kind": "load", **self.spot.as_dict(), "mass": self.mass, **shares}

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the inertia and the weight of the mass to I, J, G, B and V."""
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
        """Return no forces: a mass has only inertia and weight."""
        return ()

    def product(self, one: complex, other: complex) -> float:
        """Return the inner product of two velocities of the mass point, weighted with its mass and shares."""
        return self.mass * (self.horizontal * one.real * other.real + self.vertical * one.imag * other.imag)
