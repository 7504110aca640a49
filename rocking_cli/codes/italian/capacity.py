"""Capacity curves: acceleration against displacement of the equivalent oscillator, exact and as a straight line."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from math import inf, pi
from operator import attrgetter

import numpy as np
from pydantic import ValidationError

from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.rules import Rule
from rocking_cli.core import Mechanism
from rocking_cli.core.coefficients import NoCriticalRotation
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.hung.element import INTERLOCK_NAME as INTERLOCK
from rocking_cli.core.hung.element import ConstantForce, Element
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


@dataclass(frozen=True, order=True)
class Break:
    """End of a tie or of crossing walls: rotation [rad], name, and the elongation or slip at which it ends [m]."""

    phi: float
    name: str
    length: float


def against(chain: Chain) -> Sequence[str]:
    """Return the names of the forces against the motion, which may stand for ties."""
    loads, s = {load.name for load in chain.mechanism.loads or []}, chain.direction
    forces = [each for each in chain.mechanism.hung.elements if isinstance(each, ConstantForce) and each.name in loads]
    return [each.name for each in forces if s * each.in_direction(s).real < 0]


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
    def breaks(self) -> Sequence[Break]:
        """What ends on the way to the kinematic limit: ties, and the overlap of the courses of crossing walls."""
        mechanism, breaks = self.chain.mechanism, list[Break]()
        known = {tie.name: tie.known_elongation for tie in mechanism.ties or []}
        if mechanism.interlock is not None:
            known[INTERLOCK] = mechanism.interlock.overlap
        for each in mechanism.hung.elements:
            if most := known.get(each.name):
                slides = partial(self.slid, each.spot) if isinstance(each, ConstantForce) else None
                phi = self._reached(slides or partial(self._longer, each), most, mechanism.limit(self.chain.direction))
                breaks += [] if phi is None else [Break(phi, each.name, most)]
        return sorted(breaks)

    def slid(self, spot: Spot, phi: Reals) -> Reals:
        """Return the sideways displacement of a point, in either sense, at rotations, shape (n,) [m]."""
        path = self.chain.mechanism.followed(phi, self.chain.direction)(spot).z
        return np.asarray(np.abs((path - spot.at).real))

    def _longer(self, tie: Element, phi: Reals) -> Reals:
        return tie.elongation(self.chain.mechanism.followed(phi, self.chain.direction))[0]

    def _reached(self, way: Callable[[Reals], Reals], length: float, end: float) -> float | None:
        """Return the first rotation below an end at which a way has a length; None if there is none."""
        phi = np.linspace(0.0, end, STEPS_PER_CURVE + 1)[:-1]
        k = int((way(phi) >= length).argmax())
        return root(lambda x: float(way(np.array([x]))[0]) - length, phi[k - 1], phi[k]) if k else None

    @cached_property
    def _held(self) -> dict[Collection[str], Mechanism]:
        """The structure without what has ended so far, by names."""
        return {frozenset(): self.chain.mechanism}

    def without(self, gone: Collection[str]) -> Mechanism:
        """Return the structure without some of its ties, forces and crossing walls, by their names."""
        names, mechanism = frozenset(gone), self.chain.mechanism
        if names not in self._held:
            kept = {key: [each for each in getattr(mechanism, key) or [] if each.name not in names] or None
                    for key in ("loads", "ties")}  # fmt: skip
            interlock = None if INTERLOCK in names else mechanism.interlock
            self._held[names] = mechanism.model_copy(update={**kept, "interlock": interlock})
        return self._held[names]

    def standing(self, phi: float, *, after: bool = False) -> Mechanism:
        """Return the structure with what still restrains it at a rotation; where something ends before it, or `after`.

        At the end of the curve, it is the structure with what holds up to collapse.
        """
        if phi == self.end and not after:
            return self.without(self._last[1])
        return self.without({each.name for each in self.breaks if each.phi < phi or (after and each.phi == phi)})

    @property
    def lost(self) -> Sequence[Break]:
        """What ends before a* vanishes with it, so that d0* is that of the curve without it."""
        return [each for each in self.breaks if each.name in self._last[1] or each.phi == self.end]

    @property
    def let_go(self) -> Sequence[str]:
        """Names of ties and forces that never end, with which a* would not vanish, so that d0* is that without them."""
        return sorted(self._last[1] - {each.name for each in self.breaks})

    @property
    def end(self) -> float:
        """First rotation at which a* vanishes [rad], which ends the curve. Raises `InputError` if there is none."""
        return self._last[0]

    @cached_property
    def _last(self) -> tuple[float, set[str]]:
        """The end of the curve [rad], and the names of what does not hold up to there."""
        gone = set[str]()
        while more := {each.name for each in self.breaks if each.phi < self._vanishes(gone)} - gone:
            gone |= more
        if self._vanishes(gone) == inf:
            gone |= {*against(self.chain), *(tie.name for tie in self.chain.mechanism.ties or [])}
        end = self._vanishes(gone)
        if end == 0 and self.breaks:  # it does not stand without what ends first
            end, gone = self.breaks[0].phi, set()
        if not 0 < end < inf:
            raise InputError(
                Problem(
                    f"in the {self.chain.direction.label} direction, a* does not vanish before the kinematic limit: "
                    "the restraints would hold the structure at any displacement",
                    field="ties" if self.chain.mechanism.ties else "loads",
                    hint="the code counts only restraints that act up to collapse: leave out the others",
                )
            )
        self._hold_to_a_function(end)
        return end, gone

    @property
    def is_endless(self) -> bool:
        """Whether a* does not vanish before the kinematic limit if no tie ends."""
        return self._vanishes({INTERLOCK}) == inf

    def _vanishes(self, gone: Collection[str]) -> float:
        """Return the rotation at which a* vanishes without something [rad]: infinite if nowhere, 0 if at rest."""
        try:
            mechanism = self.without(gone)
            if not mechanism.coefficients(np.zeros(1), self.chain.direction).restoring(mechanism.gravity)[0] > 0:
                return 0.0
            return mechanism.critical_rotation(self.chain.direction)
        except ValidationError:  # it is refused, as it does not stand
            return 0.0
        except NoCriticalRotation:
            if not mechanism.attached:
                raise
            return inf

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

    def acceleration_at(self, phi: float, standing: Mechanism | None = None) -> float:
        """Return a* at a rotation [m/s2], of what is `standing` there; at the rotation of a break the value before."""
        mechanism = self.standing(phi) if standing is None else standing
        here = mechanism.coefficients(np.array([phi]), self.chain.direction)
        alpha = float(here.restoring(mechanism.gravity)[0] / (here.B[0] + self.chain.added(phi)))
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
        """Rotations computed so far, by displacement, as all views need the same few; at first rest and each break."""
        return {0.0: 0.0, **{self.displacement_at(each.phi): each.phi for each in self._reached_breaks}}

    @property
    def _reached_breaks(self) -> Sequence[Break]:
        return [each for each in self.breaks if each.phi < self.end]

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
        # A curve that rises up to a break has its maximum there.
        places = [*np.linspace(0.0, self.end, STEPS_PER_CURVE // 4 + 1), *(each.phi for each in self._reached_breaks)]
        return max(self.a0, *(self.acceleration_at(float(phi)) for phi in places))

    @cached_property
    def last_break(self) -> Break | None:
        """The break with which those so far take more than half of the largest a*; None if they do not."""
        for each in self._reached_breaks:
            whole, left = self.chain.mechanism, self.standing(each.phi, after=True)
            if self.acceleration_at(each.phi, whole) - self.acceleration_at(each.phi, left) > self.largest / 2:
                return each
        return None

    @property
    def broken(self) -> float | None:
        """Displacement at the last break [m]."""
        return None if self.last_break is None else self.displacement_at(self.last_break.phi)

    @cached_property
    def seat(self) -> Seat | None:
        """The first load that moves off its seat before the end of the curve; None if none does."""
        spots, lost = {mass.name: mass.spot for mass in self.chain.mechanism.hung.masses}, list[Seat]()
        for load in self.chain.mechanism.loads or []:
            if load.seat is not None:
                at = self._reached(partial(self.slid, spots[load.name]), load.seat, self.end)
                lost += [] if at is None else [Seat(load.name, load.seat, self.displacement_at(at))]
        return min(lost, key=attrgetter("d"), default=None)

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
