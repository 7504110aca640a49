"""Capacity curves: acceleration against displacement of the equivalent oscillator, exact and as a straight line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.rules import Rule
from rocking_cli.core import Mechanism
from rocking_cli.core.equilibrium import NoCriticalRotation
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.hung.element import INTERLOCK_NAME as INTERLOCK
from rocking_cli.core.kinematics import Reals
from rocking_cli.errors import InputError, Problem, StructureError
from rocking_cli.short_repr import short_repr
from rocking_cli.verification.results import Control

STEPS_PER_CURVE = 256  # a curve is checked to be a function at these points only
MAX_HALVINGS = 200
SHARE, BREAK, SEAT = "share", "break", "seat"
"""What may end the displacement capacity: the share of d0*, a break of the curve, or a lost seat."""


def root(rises: Callable[[float], float], low: float, high: float) -> float:
    """Return the zero of a function that is negative at `low` and positive at `high`, to rounding, by bisection."""
    for _ in range(MAX_HALVINGS):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        low, high = (middle, high) if rises(middle) < 0 else (low, middle)
    return high


@dataclass(frozen=True)
class Seat:
    """Loss of a seat: name of the load, length of the seat [m], and displacement d at which the load leaves it [m]."""

    load: str
    length: float
    d: float


@short_repr
@dataclass(frozen=True, eq=False)
class ExactCurve:
    """Capacity curve a*(d) computed from the exact motion of the mechanism.

    Parameters
    ----------
    chain : Chain
        The moving blocks of the mechanism.
    control : Control
        The control point.
    confidence : float
        Confidence factor FC, by which accelerations are divided.
    """

    chain: Chain
    control: Control
    confidence: float

    @cached_property
    def _bare(self) -> Mechanism:
        """The structure without crossing walls, after their courses have slid apart."""
        return self.chain.mechanism.model_copy(update={"interlock": None})

    @cached_property
    def torn(self) -> float | None:
        """Rotation at which the courses of crossing walls have slid by their overlap [rad]; None if never."""
        interlock = self.chain.mechanism.interlock
        if interlock is None:
            return None
        spot = next(each.spot for each in self.chain.mechanism.hung.elements if each.name == INTERLOCK)  # type: ignore[attr-defined]
        phi = np.linspace(0.0, self.chain.mechanism.limit(self.chain.direction), STEPS_PER_CURVE + 1)[:-1]
        over = self._slid(spot, phi) >= interlock.overlap
        if not over.any():
            return None
        return self._lost(spot, interlock.overlap, phi, int(over.argmax()))

    def _slid(self, spot: Spot, phi: Reals) -> Reals:
        path = self.chain.mechanism.followed(phi, self.chain.direction)(spot).z
        return np.asarray(np.abs((path - spot.at).real))

    @cached_property
    def end(self) -> float:
        """First rotation at which a* vanishes [rad], which ends the curve. Raises `InputError` if there is none."""
        if self._first is None:
            raise InputError(
                Problem(
                    f"in the {self.chain.direction.label} direction, a* does not vanish before the kinematic limit: "
                    "the restraints would hold the structure at any displacement",
                    field="ties" if self.chain.mechanism.ties else "loads",
                    hint="the code counts only restraints that act up to collapse: leave out the others",
                )
            )
        self._hold_to_a_function(self._first)
        return self._first

    @property
    def is_endless(self) -> bool:
        """Whether a* does not vanish before the kinematic limit."""
        return self._first is None

    @cached_property
    def _first(self) -> float | None:
        return self._vanishes(self._bare if self.lost_on_the_way else self.chain.mechanism)

    def _vanishes(self, mechanism: Mechanism) -> float | None:
        try:
            return mechanism.critical_rotation(self.chain.direction)
        except NoCriticalRotation:
            if not mechanism.attached:
                raise
            return None

    def _hold_to_a_function(self, end: float) -> None:
        phi = np.linspace(0.0, end, STEPS_PER_CURVE + 1)
        drives = self.chain.mechanism.coefficients(phi, self.chain.direction).B
        moves = np.diff(self.chain.displacement(phi, self.control))
        if not ((drives > 0).all() and (moves > 0).all()):
            raise StructureError(
                f"in the {self.chain.direction.label} direction, the displacement of the control point does not "
                "increase up to the critical rotation, so it cannot serve as the abscissa of a capacity curve; "
                "choose another control point"
            )

    def acceleration_at(self, phi: float, *, after: bool = False) -> float:
        """Return a* at a rotation [m/s2]; at the rotation of a break the value before it, or `after` it."""
        gone = self.torn is not None and (phi > self.torn or (after and phi == self.torn))
        mechanism = self._bare if gone else self.chain.mechanism
        here = mechanism.coefficients(np.array([phi]), self.chain.direction)
        alpha = float(here.restoring(mechanism.gravity)[0] / here.B[0])
        return alpha * mechanism.gravity / (self.chain.e_star * self.confidence)

    def displacement_at(self, phi: float) -> float:
        """Return d at a rotation [m]."""
        return float(self.chain.displacement(np.array([phi]), self.control)[0])

    def rotation(self, d: float) -> float:
        """Return the rotation at a displacement on the curve [rad]."""
        if d not in self._rotations:
            self._rotations[d] = root(lambda phi: self.displacement_at(phi) - d, 0.0, self.end)
        return self._rotations[d]

    @cached_property
    def _rotations(self) -> dict[float, float]:
        """Rotations computed so far, by displacement, as all views need the same few; that of a break to begin with."""
        return {} if self.broken is None or self.torn is None else {self.broken: self.torn}

    @cached_property
    def a0(self) -> float:
        """a* at rest [m/s2]."""
        return self.chain.alpha0 * self.chain.mechanism.gravity / (self.chain.e_star * self.confidence)

    @cached_property
    def d0(self) -> float:
        """Displacement d0* at which a* vanishes [m]."""
        return self.displacement_at(self.end)

    def acceleration(self, d: float) -> float:
        """Return a* at a displacement [m/s2]; at the displacement of a break the value before it."""
        return self.acceleration_at(self.rotation(d))

    @cached_property
    def largest(self) -> float:
        """The largest a* of the curve [m/s2]."""
        places = np.linspace(0.0, self.end, STEPS_PER_CURVE // 4 + 1).tolist()
        if self.torn is not None and self.torn <= self.end:
            places.append(self.torn)  # a curve that rises up to its break has its maximum there
        return max(self.a0, *map(self.acceleration_at, places))

    @property
    def lost_on_the_way(self) -> bool:
        """Whether the courses of crossing walls slide apart before a* vanishes."""
        first = self._vanishes(self.chain.mechanism)
        return self.torn is not None and (first is None or self.torn < first)

    @cached_property
    def broken(self) -> float | None:
        """Displacement of a break at which a* loses more than half of its largest value [m]; None without one."""
        if self.torn is None or self.torn > self.end:
            return None
        lost = self.acceleration_at(self.torn) - self.acceleration_at(self.torn, after=True)
        return self.displacement_at(self.torn) if lost > self.largest / 2 else None

    @cached_property
    def seat(self) -> Seat | None:
        """The first load that moves off its seat before the end of the curve; None if none does."""
        phi, mechanism = np.linspace(0.0, self.end, STEPS_PER_CURVE + 1), self.chain.mechanism
        spots = {mass.name: mass.spot for mass in mechanism.hung.masses}
        lost = []
        for load in mechanism.loads or []:
            if load.seat is None:
                continue
            over = self._slid(spots[load.name], phi) >= load.seat
            if over.any():
                lost.append((self._lost(spots[load.name], load.seat, phi, int(over.argmax())), load.name, load.seat))
        if not lost:
            return None
        at, name, length = min(lost)
        return Seat(name, length, self.displacement_at(at))

    def _lost(self, spot: Spot, length: float, phi: Reals, k: int) -> float:
        return root(lambda x: float(self._slid(spot, np.array([x]))[0]) - length, phi[k - 1], phi[k])

    def points(self, count: int = 65) -> tuple[Reals, Reals]:
        """Return points of the curve: displacements [m] and accelerations [m/s2], shape (n,) each."""
        phi = np.linspace(0.0, self.end, count)
        return self.chain.displacement(phi, self.control), np.array([self.acceleration_at(float(x)) for x in phi])


@short_repr
@dataclass(frozen=True)
class StraightCurve:
    """Capacity curve a*(d) as a straight line from a0* [m/s2] at rest to zero at d0* [m]."""

    a0: float
    d0: float
    broken: float | None = None
    seat: Seat | None = None

    def acceleration(self, d: float) -> float:
        """Return a* at a displacement [m/s2]."""
        return self.a0 * (1 - d / self.d0)


CapacityCurve = ExactCurve | StraightCurve


def ends(curve: CapacityCurve, rule: Rule) -> dict[str, float]:
    """Return the displacements at which the capacity may end at a limit state, by what ends it; the least does [m]."""
    lost = {SHARE: rule.share * curve.d0}
    if rule.at_breaks and curve.broken is not None:
        lost[BREAK] = curve.broken
    if curve.seat is not None:
        lost[SEAT] = curve.seat.d
    return lost


def with_elastic_branch(a: float, d: float, T0: float | None) -> float:
    """Limit a* at a displacement to the elastic branch 4 pi^2 d/T0^2, if there is a T0 [m/s2]."""
    return a if T0 is None else min(a, 4 * pi**2 * d / T0**2)
