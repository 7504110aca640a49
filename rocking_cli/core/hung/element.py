"""Elements: what pulls on a mechanism with a force N over an elongation e, by whatever law.

    Q = N e',   Q' = N'(e) e'^2 + N e'',   U = the integral of N de

A law answers `force`, `slope` and `energy`. What may be asked of a structure follows from what its elements say of
themselves: whether they remember, whether they resist by their rate, and whether their law is made of straight lines.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from itertools import pairwise
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.hung.attached import Follow, Push, Spot
from rocking_cli.core.kinematics import Direction, Points, Reals
from rocking_cli.plugins.errors import guard

Sense = Literal["tension", "compression"]
Question = Literal["linear models", "equivalent block", "sizes", "verification"]
NO_ANSWER: dict[Question, str] = {
    "linear models": "the linear models do not hold",
    "equivalent block": "no single block is equivalent to it",
    "sizes": "spectra and maps are not available",
    "verification": "no code of practice here covers it",
}
"""What a structure may be asked beside its nonlinear history, and what is said where its elements do not allow it."""

TOGETHER = 1e-9  # m, and of the distance from the origin: points that are nearer at rest are one
ROUNDING = 1e-14  # m, and of that distance: elongations that are none
NEAR = 1e-6  # rad or so: two points that met at rest are still so near that their distance is its derivative times phi


def _failed(cls: type, method: str) -> str:
    return f"the element {cls.__name__} failed in {method}"


class Element(ABC):
    """Something on a mechanism whose force follows from its elongation: a tie, a bed of springs, a constant force."""

    name: str
    has_memory: ClassVar[bool] = False
    """Whether its force depends on what it went through before, as that of a tie that yields."""
    has_rate: ClassVar[bool] = False
    """Whether its force depends on the rate of its elongation, as that of a damper."""
    is_linear: ClassVar[bool] = True
    """Whether its law is made of straight lines, so that its slope at the critical rotation stands for it."""
    departs: ClassVar[str] = ""
    """How its force departs from straight lines over its elongation, to follow its name: `yields`."""

    def __init_subclass__(cls, **named: Any) -> None:
        """Guard what an element of another package answers: whatever fails there is an error of that package."""
        super().__init_subclass__(**named)
        if cls.__module__.partition(".")[0] != __name__.partition(".")[0]:
            guard(cls, ("force", "slope", "energy", "slack_at", "elongation", "act", "forces"), _failed)

    @property
    @abstractmethod
    def words(self) -> str:
        """What it is, in a few words, without its name."""

    @abstractmethod
    def as_dict(self) -> dict[str, Any]:
        """Its kind, its place at rest and its numbers, in SI units."""

    @abstractmethod
    def force(self, e: Reals) -> Reals:
        """N of one of them at elongations, shape (n,) [N]; tension is positive."""

    @abstractmethod
    def slope(self, e: Reals, going: Reals) -> Reals:
        """dN/de [N/m], shape (n,); at a corner of its law, on the side to which `going` (e') has its sign."""

    @abstractmethod
    def energy(self, e: Reals) -> Reals:
        """The integral of N from rest [J], shape (n,)."""

    @abstractmethod
    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """e [m] and its first two derivatives in phi, each shape (n,); `direction` is that of rocking."""

    @abstractmethod
    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add its moment to Q, with its derivative and its energy."""

    @abstractmethod
    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """The forces that it exerts on bodies and the ground."""

    @property
    def stretched(self) -> Sequence[Stretched]:
        """The ties along a path that it acts as; none of a force."""
        return ()

    def refuses(self, question: Question) -> str | None:
        """Why it lets a question not be answered, to follow its name; None if it does.

        What remembers or resists by its rate has no one force over its elongation; what is not made of straight lines
        has no linear model, and no code of practice here knows it.
        """
        if self.has_memory or (self.has_rate and question != "equivalent block"):
            return self.departs or f"has {'a memory' if self.has_memory else 'a force that depends on its rate'}"
        if not self.is_linear and question in ("linear models", "verification"):
            return self.departs or "has a force that is no straight line over its elongation"
        return None


@dataclass(frozen=True)
class Stretched(Element):
    """An element that is stretched along a path of points, by any law.

    Parameters
    ----------
    name : str
        What it is called.
    spots : sequence of Spot
        Two or more; its length is the sum of the pieces between them.
    count : float
        How many of them there are.
    only : {"tension", "compression"}, optional
        In which sense it can act; it then has a corner where `slack_at` is zero.
    """

    name: str
    spots: Sequence[Spot]
    _: KW_ONLY
    count: float = 1.0
    only: Sense | None = None

    @property
    def at_rest(self) -> tuple[float, float]:
        """Its force [N] and its stiffness [N/m] at rest."""
        rest = np.zeros(1)
        return float(self.force(rest)[0]), float(self.slope(rest, np.ones(1))[0])

    @property
    def stretched(self) -> Sequence[Stretched]:
        """Itself."""
        return (self,)

    def as_dict(self) -> dict[str, Any]:
        """Its path, and its force and stiffness at rest."""
        force, stiffness = self.at_rest
        path = [spot.as_dict() for spot in self.spots]
        strength = {"stiffness": stiffness, "prestress": force, "only": self.only}
        return {"kind": "tie", "path": path, **strength, "count": self.count}

    def slack_at(self, e: Reals) -> Reals:
        """What changes its sign where it goes slack or comes into play, if it acts in one sense only [N]."""
        return self.force(e)

    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """e = L - L(0) [m] and the first two derivatives of L, each shape (n,)."""
        paths = [follow(spot) for spot in self.spots]
        e, first, second = (np.zeros(paths[0].z.shape) for _ in range(3))
        for (one, here), (other, there) in pairwise(zip(self.spots, paths, strict=True)):
            d, dd, ddd = there.z - here.z, there.dz - here.dz, there.ddz - here.ddz
            span, speed, rest = np.abs(d), np.abs(dd), _apart(one, other)
            met = _met(d, dd, rest)
            with np.errstate(divide="ignore", invalid="ignore"):
                rate = np.where(met, speed, dot(d, dd) / span)  # L' = dr.dr'/L
                bend = np.where(met, dot(dd, ddd) / speed, (speed**2 + dot(d, ddd) - rate**2) / span)
            still = span + speed == 0  # points that stay together
            e += span - rest
            first += np.where(still, 0.0, rate)
            second += np.where(still, 0.0, bend)
        reach = 1 + max(abs(spot.at) for spot in self.spots)
        return np.where(np.abs(e) <= ROUNDING * reach, 0.0, e), first, second

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add N L' to Q."""
        e, first, second = self.elongation(follow)
        n = self.force(e)
        total.Q[:] += self.count * n * first
        total.dQ[:] += self.count * (self.slope(e, first) * first**2 + n * second)
        total.U[:] += self.count * self.energy(e)

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


def dot(u: complex | Points, v: Points) -> Reals:
    """Product of vectors of the plane, each a complex number."""
    return np.asarray((np.conj(u) * v).real)


def _apart(one: Spot, other: Spot) -> float:
    """The distance of two points at rest [m]; 0 if they are one."""
    rest = abs(other.at - one.at)
    return 0.0 if rest <= TOGETHER * (1 + abs(one.at)) else rest


def _met(d: Points, dd: Points, rest: float) -> NDArray[np.bool_]:
    """Where two points that met at rest are still so near that their distance is its derivative times phi."""
    return np.abs(d) <= NEAR * np.abs(dd) if rest == 0.0 else np.zeros(d.shape, bool)
