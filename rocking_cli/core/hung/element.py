"""Elements: forces N on a mechanism that follow from an elongation e, by any law.

    Q = N e',   Q' = N'(e) e'^2 + N e'',   U = the integral of N de

A law gives `force`, `slope` and `energy`. Each element states whether it has a memory, whether it resists by its rate,
and whether its law is piecewise linear; from this follows which questions have an answer for the structure.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from itertools import pairwise
from typing import Any, ClassVar, Literal

import numpy as np

from rocking_cli.arrays import Bools
from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.hung.attached import Follow, Push, Spot
from rocking_cli.core.kinematics import Direction, Points, Reals
from rocking_cli.plugins.errors import failed, guard

Sense = Literal["tension", "compression"]
Question = Literal["linear models", "equivalent block", "sizes", "verification", "trace"]
NO_ANSWER: dict[Question, str] = {
    "linear models": "the linear models do not hold",
    "equivalent block": "no single block is equivalent to it",
    "sizes": "spectra and maps are not available",
    "verification": "no code of practice here covers it",
    "trace": "no trace of free rocking can be fitted",
}
"""What a structure may be asked beside its nonlinear history, and what is said where its elements do not allow it."""

TOGETHER = 1e-9  # distance of points that coincide at rest [m], plus this share of their distance from the origin
ROUNDING = 1e-14  # elongations that count as zero [m], plus this share of that distance
NEAR = 1e-6  # rotation [rad] below which the distance of points that coincide at rest is its derivative times phi


class Element(ABC):
    """A force on a mechanism that follows from an elongation: a tie, a bed of springs, a constant force."""

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
        """Wrap the methods of elements of other packages, so that their failures name that package."""
        super().__init_subclass__(**named)
        if cls.__module__.partition(".")[0] != __name__.partition(".")[0]:
            guard(cls, (*vars(Element), "slack_at"), failed("element", "__name__"))

    @property
    @abstractmethod
    def words(self) -> str:
        """Description of the element in a few words, without its name."""

    @abstractmethod
    def as_dict(self) -> dict[str, Any]:
        """Return the kind, the place at rest and the parameters of the element, in SI units."""

    @abstractmethod
    def force(self, e: Reals) -> Reals:
        """Return the force N of one such element at elongations `e` [N], shape (n,); tension is positive."""

    @abstractmethod
    def slope(self, e: Reals, going: Reals) -> Reals:
        """Return dN/de [N/m], shape (n,); at a corner of the law, on the side given by the sign of `going` (e')."""

    @abstractmethod
    def energy(self, e: Reals) -> Reals:
        """Return the energy at elongations `e`, the integral of N from rest [J], shape (n,)."""

    @abstractmethod
    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """Return e [m] and its first two derivatives in phi, each shape (n,), in a direction of rocking."""

    @abstractmethod
    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the moment of the element to Q, with its derivative and its energy."""

    @abstractmethod
    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Return the forces of the element on bodies and the ground [N]."""

    @property
    def stretched(self) -> Sequence[Stretched]:
        """Ties along a path that together act as this element does; empty for a force."""
        return ()

    def refuses(self, question: Question) -> str | None:
        """Return why the element prevents an answer to a question, a clause that follows its name; None if not.

        An element with memory or with resistance to its rate has no single force at an elongation. One that is not
        piecewise linear has no linear model, and the codes of practice here do not cover it.
        """
        if self.has_memory or (self.has_rate and question != "equivalent block"):
            return self.departs or f"has {'a memory' if self.has_memory else 'a force that depends on its rate'}"
        if not self.is_linear and question in ("linear models", "verification"):
            return self.departs or "has a force that is no straight line over its elongation"
        return None


@dataclass(frozen=True)
class Stretched(Element):
    """An element stretched along a path of points, by any law.

    Parameters
    ----------
    name : str
        Name of the element.
    spots : sequence of Spot
        Two points or more; the length of the element is the sum of the distances between them.
    count : float
        Number of identical elements.
    only : {"tension", "compression"}, optional
        The only sense in which it acts, if any; its law then has a corner where `slack_at` is zero.
    """

    name: str
    spots: Sequence[Spot]
    _: KW_ONLY
    count: float = 1.0
    only: Sense | None = None

    @property
    def at_rest(self) -> tuple[float, float]:
        """Force [N] and stiffness [N/m] at rest."""
        rest = np.zeros(1)
        return float(self.force(rest)[0]), float(self.slope(rest, np.ones(1))[0])

    @property
    def stretched(self) -> Sequence[Stretched]:
        """The ties that together act as this element does: only the element itself."""
        return (self,)

    def as_dict(self) -> dict[str, Any]:
        """Return the path of the element, and its force and stiffness at rest."""
        force, stiffness = self.at_rest
        path = [spot.as_dict() for spot in self.spots]
        strength = {"stiffness": stiffness, "prestress": force, "only": self.only}
        return {"kind": "tie", "path": path, **strength, "count": self.count}

    def slack_at(self, e: Reals) -> Reals:
        """Return a value [N] that changes sign where a one-sided element goes slack or taut."""
        return self.force(e)

    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """Return e = L - L(0) [m] and the first two derivatives of L in phi, each shape (n,)."""
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
        """Add the moment N L' to Q."""
        e, first, second = self.elongation(follow)
        n = self.force(e)
        total.Q[:] += self.count * n * first
        total.dQ[:] += self.count * (self.slope(e, first) * first**2 + n * second)
        total.U[:] += self.count * self.energy(e)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Return the force N along each piece of the path, at both of its ends [N]."""
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
    """Return the scalar product of vectors of the plane, each a complex number."""
    return np.asarray((np.conj(u) * v).real)


def _apart(one: Spot, other: Spot) -> float:
    """Return the distance of two points at rest [m]; exactly 0 if they coincide to rounding."""
    rest = abs(other.at - one.at)
    return 0.0 if rest <= TOGETHER * (1 + abs(one.at)) else rest


def _met(d: Points, dd: Points, rest: float) -> Bools:
    """Return a mask of the rotations at which two points that coincide at rest are still very close together.

    At these rotations, their distance is taken as its derivative times phi.
    """
    return np.abs(d) <= NEAR * np.abs(dd) if rest == 0.0 else np.zeros(d.shape, bool)
