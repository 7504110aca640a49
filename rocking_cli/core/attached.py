"""Loads and ties attached to a mechanism beside its own bodies, as the equation of motion sees them.

    (I + ...) phi.. + (J + ...) phi.^2 + (g + v_g'') G + Q = -s B u_g'',   Q = N L' - F.r'

A load adds its mass to I, J, G and B by its shares; a tie and a force add to Q, which does not scale with g.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.kinematics import Direction, Points, Reals

TOGETHER = 1e-9  # m, and of the distance from the origin: points that are nearer at rest are one
ROUNDING = 1e-14  # m, and of that distance: elongations that are none
NEAR = 1e-6  # rad or so: two points that met at rest are still so near that their distance is its derivative times phi


class Path(NamedTuple):
    """Where a point goes over the rotations: its place and first two derivatives in phi, each shape (n,)."""

    z: Points
    dz: Points
    ddz: Points


class Spot(NamedTuple):
    """A point of a body, or of the ground (None), by its place at rest [m]."""

    body: str | None
    at: complex


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


@dataclass(frozen=True)
class ConstantForce:
    """A force of constant size and direction, such as the thrust of a vault; friction turns with the motion.

    Parameters
    ----------
    name : str
        What it is called.
    spot : Spot
        Where it acts.
    force : complex
        Fx + i Fy [N]; of friction, as it acts while the mechanism rocks in the positive direction.
    friction : bool
        Whether its horizontal part is against the motion in either direction.
    """

    name: str
    spot: Spot
    force: complex
    friction: bool = False

    def in_direction(self, direction: Direction) -> complex:
        """The force while the mechanism rocks in a direction [N]."""
        return complex(direction * self.force.real, self.force.imag) if self.friction else self.force

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add -F.r' to Q."""
        z, dz, ddz = follow(self.spot)
        force = self.in_direction(direction)
        total.Q[:] -= _dot(force, dz)
        total.dQ[:] -= _dot(force, ddz)
        total.U[:] -= _dot(force, z - self.spot.at)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Itself."""
        return (Push(self.spot, np.full(follow(self.spot).z.shape, self.in_direction(direction))),)


Sense = Literal["tension", "compression"]


@dataclass(frozen=True)
class Spring:
    """An elastic tie along a path of points: N = N0 + k e, in tension only, in compression only, or both.

    Parameters
    ----------
    name : str
        What it is called.
    spots : sequence of Spot
        Two or more; its length is the sum of the pieces between them.
    stiffness, prestress : float
        k [N/m], and N0 at rest [N], tension positive.
    only : {"tension", "compression"}, optional
        In which sense it can act.
    count : float
        How many of them there are.
    """

    name: str
    spots: Sequence[Spot]
    stiffness: float
    prestress: float = 0.0
    only: Sense | None = None
    count: float = 1.0

    def elongation(self, follow: Follow) -> tuple[Reals, Reals, Reals]:
        """e = L - L(0) [m] and the first two derivatives of L, each shape (n,)."""
        paths = [follow(spot) for spot in self.spots]
        e, first, second = (np.zeros(paths[0].z.shape) for _ in range(3))
        for (one, here), (other, there) in pairwise(zip(self.spots, paths, strict=True)):
            d, dd, ddd = there.z - here.z, there.dz - here.dz, there.ddz - here.ddz
            span, speed, rest = np.abs(d), np.abs(dd), _apart(one, other)
            met = _met(d, dd, rest)
            with np.errstate(divide="ignore", invalid="ignore"):
                rate = np.where(met, speed, _dot(d, dd) / span)  # L' = dr.dr'/L
                bend = np.where(met, _dot(dd, ddd) / speed, (speed**2 + _dot(d, ddd) - rate**2) / span)
            still = span + speed == 0  # points that stay together
            e += span - rest
            first += np.where(still, 0.0, rate)
            second += np.where(still, 0.0, bend)
        return np.where(np.abs(e) <= ROUNDING * self._reach, 0.0, e), first, second

    @property
    def _reach(self) -> float:
        return 1 + max(abs(spot.at) for spot in self.spots)

    @property
    def _sense(self) -> float:
        return -1.0 if self.only == "compression" else 1.0

    def force(self, e: Reals) -> Reals:
        """N of one of them at an elongation [N]."""
        n = self.prestress + self.stiffness * e
        if self.only == "tension":
            return np.maximum(n, 0.0)
        return np.minimum(n, 0.0) if self.only == "compression" else n

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add N L' to Q."""
        e, first, second = self.elongation(follow)
        n = self.force(e)
        # Taut from rest on, it acts as soon as it moves in its sense.
        acts = (n != 0) | ((self.prestress + self.stiffness * e == 0) & (self._sense * first > 0))
        slope = np.where(acts, self.stiffness, 0.0) if self.only is not None else self.stiffness
        total.Q[:] += self.count * n * first
        total.dQ[:] += self.count * (slope * first**2 + n * second)
        total.U[:] += self.count * self._energy(e)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """N along each piece of its path, on both of its ends."""
        n = self.count * self.force(self.elongation(follow)[0])
        paths = [follow(spot) for spot in self.spots]
        pushes = []
        for (one, here), (other, there) in pairwise(zip(self.spots, paths, strict=True)):
            d, dd = there.z - here.z, there.dz - here.dz
            along = np.where(_met(d, dd, _apart(one, other)), dd, d).astype(np.complex128)
            size = np.abs(along)
            pull = along * (n / np.where(size == 0, 1.0, size))  # points that stay together do not pull
            pushes += [Push(one, pull), Push(other, -pull)]
        return pushes

    def slack_at(self, e: Reals) -> Reals:
        """What changes its sign where it goes slack or comes into play, if it acts in one sense only [N]."""
        return self.prestress + self.stiffness * e

    def _energy(self, e: Reals) -> Reals:
        """The integral of N from rest [J]; what goes slack on the way stores no more."""
        if self.only is not None and self.stiffness > 0:
            with np.errstate(over="ignore"):
                slack = -np.float64(self.prestress) / self.stiffness  # the elongation at which it goes slack
            e = np.maximum(e, slack) if self.only == "tension" else np.minimum(e, slack)
        return self.prestress * e + self.stiffness * e**2 / 2


@dataclass(frozen=True)
class SpringBed:
    """Springs all along a face of a body, from each of its points to where that rests: k ds each.

    Their moment is that of two springs at the points of Gauss, exactly: the squared distance is quadratic along the
    face of a rigid body.

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
    def springs(self) -> list[Spring]:
        """The two springs that act as it does."""
        middle, half = (self.start.at + self.end.at) / 2, (self.end.at - self.start.at) / 2
        each = self.modulus * abs(half) * self.count
        places = (middle - half / np.sqrt(3), middle + half / np.sqrt(3))
        return [Spring(self.name, (Spot(None, at), Spot(self.start.body, at)), each) for at in places]

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add its moment to Q."""
        for spring in self.springs:
            spring.act(total, direction, follow)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Those of its springs."""
        return [push for spring in self.springs for push in spring.forces(direction, follow)]


def springs_of(thing: Attached) -> Sequence[Spring]:
    """The elastic ties that a thing acts as; none of a load or a force."""
    return [thing] if isinstance(thing, Spring) else thing.springs if isinstance(thing, SpringBed) else []


def _apart(one: Spot, other: Spot) -> float:
    """The distance of two points at rest [m]; 0 if they are one."""
    rest = abs(other.at - one.at)
    return 0.0 if rest <= TOGETHER * (1 + abs(one.at)) else rest


def _met(d: Points, dd: Points, rest: float) -> NDArray[np.bool_]:
    """Where two points that met at rest are still so near that their distance is its derivative times phi."""
    return np.abs(d) <= NEAR * np.abs(dd) if rest == 0.0 else np.zeros(d.shape, bool)


def _dot(u: complex | Points, v: Points) -> Reals:
    return np.asarray((np.conj(u) * v).real)
