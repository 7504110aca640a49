"""Results of a history for design: displacements of named points, forces of ties, and velocities of impacts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import isnan, nan

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.hung.attached import PointMass, Spot
from rocking_cli.core.hung.element import INTERLOCK_NAME as INTERLOCK
from rocking_cli.core.hung.element import ConstantForce, Element, Stretched
from rocking_cli.core.reactions import parts
from rocking_cli.dynamics.history import History
from rocking_cli.short_repr import short_repr

PATH_ROTATIONS = 257  # rotations between rest and a peak, sampled for the largest displacement
ROUNDING_SHARE = 1e-13  # share of the distance from the origin below which a displacement is zero
LEVEL_SHARE = 1e-9  # share of the height of the structure by which level corners may differ


@dataclass(frozen=True)
class PointPeak:
    """Peak horizontal and vertical displacement of a point [m], absolute values; NaN if the structure overturns."""

    name: str
    at: complex
    horizontal: float
    vertical: float


@dataclass(frozen=True)
class TiePeak:
    """Peak force [N] and peak elongation [m] of a tie, with their signs; tension is positive.

    If a tie acts in one sense only, the elongation is the largest in this sense.
    """

    name: str
    force: float
    elongation: float


@short_repr
@dataclass(frozen=True)
class Movements:
    """Peak movements in a history: of points, of ties, and at impacts.

    Parameters
    ----------
    points : sequence of PointPeak
        The top, and the points of loads and ties.
    ties : sequence of TiePeak
        The ties in the order of the file; of several with equal movement, one.
    impact_velocity : float
        The largest velocity with which a foot lands [m/s]; 0 without an impact, NaN if the feet are not known.
    known_to : float
        Time until which the history is known, and for which these peaks hold [s]; NaN if all of it is known.
    """

    points: Sequence[PointPeak]
    ties: Sequence[TiePeak]
    impact_velocity: float
    known_to: float = nan


@dataclass(frozen=True)
class Watched:
    """The points and ties of a structure whose movement is reported.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    """

    mechanism: Mechanism

    @cached_property
    def points(self) -> Mapping[str, Spot]:
        """The top, and the points of loads and ties, by name."""
        return dict([top(self.mechanism), *_where_it_bends(self.mechanism), *_hung(self.mechanism)])

    @cached_property
    def control(self) -> str:
        """Name of the point whose displacement stands for the structure: the top, or a hinge if the top is held."""
        bending = [name for name, _ in _where_it_bends(self.mechanism)]
        return bending[0] if bending else next(iter(self.points))

    @cached_property
    def ties(self) -> Sequence[Element]:
        """The ties, in the order of the file."""
        return self.mechanism.hung.ties

    @cached_property
    def _limits(self) -> Mapping[Direction, float]:
        return {direction: self.mechanism.limit(direction) for direction in self.mechanism.directions}

    def peaks(self, history: History) -> Movements:
        """Return the peaks of a history, also between samples, as displacements depend on the rotation alone.

        If the history overturns, or a linear one exceeds the kinematic limit, points have no peak. Forces of ties and
        impacts are then those until overturning is certain.
        """
        reached = {
            direction: history.peak_positive if direction > 0 else history.peak_negative
            for direction in self.mechanism.directions
        }
        if history.fell or any(not phi < self._limits[side] for side, phi in reached.items()):
            reached = {direction: self._before(history, direction) for direction in self.mechanism.directions}
            points = [PointPeak(name, spot.at, nan, nan) for name, spot in self.points.items()]
        else:
            points = [self._point(name, spot, reached) for name, spot in self.points.items()]
            if history.slip:  # all points move as its foot does
                points = [replace(point, horizontal=history.slip) for point in points]
        ties = [self._tie(tie, reached) for tie in self.ties]
        return Movements(points, ties, self._impact_velocity(history), history.known_to)

    def is_torn_apart(self, history: History) -> bool:
        """Return whether courses of crossing walls slide by more than their overlap, so that they hold nothing."""
        interlock = self.mechanism.interlock
        if interlock is None:
            return False
        moved = next(point.horizontal for point in self.peaks(history).points if point.name == INTERLOCK)
        return not moved <= interlock.overlap  # NaN for a history that overturns

    def columns(self, phi: Reals, slip: Reals | float = 0.0) -> Iterator[tuple[str, Reals]]:
        """Yield displacements of points [m], elongations [m] and forces [N] of ties, at signed rotations (n,).

        With a slip [m], the body has moved sideways by it.

        Values are NaN without a rotation, and beyond the kinematic limit, which linear models may exceed.
        """
        for name, spot in self.points.items():
            moved = self._signed(phi, partial(self._displacement, spot))
            yield f"{name} u_x [m]", moved.real + slip
            yield f"{name} u_y [m]", moved.imag
        for tie in self.ties:
            both = self._signed(phi, partial(_strained, self.mechanism, tie))
            yield f"{tie.name} elongation [m]", both.real
            yield f"{tie.name} force [N]", both.imag

    def bodies(self, history: History) -> Iterator[tuple[str, NDArray[np.complex128], Reals]]:
        """Yield name, place of the centroid (n,) [m] and clockwise rotation (n,) [rad] of each body in a history."""
        slip = 0.0 if history.slid is None else history.slid.displacement
        for k, body in enumerate(self.mechanism.bodies()):

            def place(phi: Reals, way: Direction, k: int = k, at: complex = body.centroid) -> NDArray[np.complex128]:
                return self.mechanism.motion(phi, way)[k].carry(at)[0]

            def turn(phi: Reals, way: Direction, k: int = k) -> NDArray[np.complex128]:
                return np.asarray(-self.mechanism.motion(phi, way)[k].psi, np.complex128)

            yield body.name, self._signed(history.phi, place) + slip, self._signed(history.phi, turn).real

    def _before(self, history: History, direction: Direction) -> float:
        """Return the largest sampled rotation of a history in a direction before it overturns [rad]."""
        end = history.overturning_time if history.fell else np.inf
        turned = direction * history.phi[np.isfinite(history.phi) & (history.time <= end)]
        return float(np.clip(turned, 0.0, np.nextafter(self._limits[direction], 0.0)).max(initial=0.0))

    def _point(self, name: str, spot: Spot, reached: Mapping[Direction, float]) -> PointPeak:
        moved = np.concatenate([self._displacement(spot, _way(phi), side) for side, phi in reached.items()])
        return PointPeak(name, spot.at, float(np.abs(moved.real).max()), float(np.abs(moved.imag).max()))

    def _tie(self, tie: Element, reached: Mapping[Direction, float]) -> TiePeak:
        both = np.concatenate([_strained(self.mechanism, tie, _way(phi), side) for side, phi in reached.items()])
        elongation, force = both.real, both.imag
        only = tie.only if isinstance(tie, Stretched) else None
        counts = elongation if only == "tension" else -elongation if only == "compression" else np.abs(elongation)
        return TiePeak(tie.name, float(force[np.abs(force).argmax()]), float(elongation[counts.argmax()]))

    def _displacement(self, spot: Spot, phi: Reals, direction: Direction) -> NDArray[np.complex128]:
        moved = np.asarray(self.mechanism.followed(phi, direction)(spot).z - spot.at)
        least = ROUNDING_SHARE * abs(spot.at)  # points held by a joint move only by rounding
        x, y = (np.where(np.abs(each) <= least, 0.0, each) for each in (moved.real, moved.imag))
        return np.asarray(x + 1j * y)

    def _signed(self, phi: Reals, of: Callable[[Reals, Direction], NDArray[np.complex128]]) -> NDArray[np.complex128]:
        values = np.full(phi.shape, complex(np.nan, np.nan))
        for direction in Direction:
            if direction not in self._limits:
                continue
            mine = (phi * direction > 0) | ((phi == 0) & (direction is self.mechanism.directions[0]))
            mine &= np.abs(phi) < self._limits[direction]
            if mine.any():
                values[mine] = of(np.abs(phi[mine]), direction)
        return values

    def _impact_velocity(self, history: History) -> float:
        if not len(history.impacts):
            return 0.0
        rates = {
            direction: np.abs(history.impacts[history.impacts[:, 1] == direction, 2]).max(initial=0.0)
            for direction in self.mechanism.directions
        }
        return max(float(rate) * _landing(self.mechanism, direction) for direction, rate in rates.items() if rate > 0)


def largest(every: Sequence[Movements]) -> Movements:
    """Return the peaks over several histories of a structure, and until when all are known; NaN if one is NaN."""
    points = [
        replace(each[0], horizontal=_most(p.horizontal for p in each), vertical=_most(p.vertical for p in each))
        for each in zip(*(moved.points for moved in every), strict=True)
    ]
    ties = [
        replace(each[0], force=_most(t.force for t in each), elongation=_most(t.elongation for t in each))
        for each in zip(*(moved.ties for moved in every), strict=True)
    ]
    known_to = [moved.known_to for moved in every if not isnan(moved.known_to)]
    return Movements(points, ties, _most(moved.impact_velocity for moved in every), min(known_to, default=nan))


def _most(values: Iterable[float]) -> float:
    peaks = list(values)
    return nan if any(np.isnan(peaks)) else max(peaks, key=abs)


def largest_on_the_way(of: Callable[[Reals, Direction], Reals], reached: Reals, direction: Direction) -> Reals:
    """Return the largest absolute value of a function of rotation between rest and each rotation, shape (n,).

    Parameters
    ----------
    of : callable
        The function, of rotations in a direction.
    reached : ndarray, shape (n,)
        Rotations [rad]; the value at an infinite one is infinite.
    direction : Direction
        The direction of the rotations.
    """
    there = np.isfinite(reached)
    phi = np.union1d(_way(float(reached[there].max(initial=0.0))), reached[there])
    so_far = np.maximum.accumulate(np.abs(of(phi, direction)))
    values = np.full(reached.shape, np.inf)
    values[there] = so_far[np.searchsorted(phi, reached[there])]
    return values


def centroid_moved(mechanism: Mechanism, phi: Reals, direction: Direction) -> Reals:
    """Return the horizontal displacement of the centroid of all mass that moves sideways [m], shape (n,).

    It is the control point that `verify` has by default.
    """
    follow, moving = mechanism.followed(phi, direction), parts(mechanism, direction)
    masses = [(body.mass, Spot(body.name, body.centroid)) for body in mechanism.weighed()]
    masses += [(load.mass * load.horizontal, load.spot) for load in mechanism.hung.masses]
    masses = [(mass, spot) for mass, spot in masses if moving[spot.body or ""]]
    moved = sum(mass * (follow(spot).z - spot.at).real for mass, spot in masses)
    return np.where(phi == 0, 0.0, moved / sum(mass for mass, _ in masses))  # no rounding at rest


def drifts(mechanism: Mechanism, phi: Reals, direction: Direction) -> Reals:
    """Return the largest horizontal displacement of a point over its height above the lowest corner, shape (n,).

    The points are the top, and the hinges of a structure whose top is held.
    """
    follow = mechanism.followed(phi, direction)
    spots = [spot for _, spot in (top(mechanism), *_where_it_bends(mechanism))]
    corners = [np.asarray(shape).imag.min() for shapes in mechanism.carrier.outlines.values() for shape in shapes]
    base = float(min(corners, default=0.0))
    heights = [(spot, spot.at.imag - base) for spot in spots]
    over = [np.abs((follow(spot).z - spot.at).real) / h for spot, h in heights if h > 0]
    return np.where(phi == 0, 0.0, np.max(over, axis=0))  # no rounding at rest


def largest_tie_force(mechanism: Mechanism, phi: Reals, direction: Direction) -> Reals:
    """Return the largest absolute force of a tie at rotations [N], shape (n,)."""
    follow = mechanism.followed(phi, direction)
    forces = [np.abs(tie.force(tie.elongation(follow)[0])) for tie in mechanism.hung.ties]
    return np.asarray(np.max(forces, axis=0))


def _way(phi: float) -> Reals:
    return np.linspace(0.0, phi, PATH_ROTATIONS)


def _strained(mechanism: Mechanism, tie: Element, phi: Reals, direction: Direction) -> NDArray[np.complex128]:
    """Return elongation [m] + i force [N] of a tie at rotations."""
    e, _, _ = tie.elongation(mechanism.followed(phi, direction))
    return np.asarray(e + 1j * tie.force(e))


def _landing(mechanism: Mechanism, direction: Direction) -> float:
    """Return the largest velocity, per unit rate of rotation, of the feet that land [m]; NaN if unknown.

    The feet are those about which the structure turns in the other direction. Also NaN if they do not move: a body that
    turns about the ground in one direction may rest in the other.
    """
    hinges = mechanism.sketch().hinges.get(direction.opposite, ())
    feet = [Spot(hinge.bodies[0], hinge.point) for hinge in hinges if len(hinge.bodies) == 1 and not hinge.slide]
    if not feet:
        return float("nan")
    follow = mechanism.followed(np.zeros(1), direction)
    fastest = max(abs(complex(follow(foot).dz[0])) for foot in feet)
    return fastest if fastest > 0 else float("nan")


def top(mechanism: Mechanism) -> tuple[str, Spot]:
    """Return the midpoint of the highest corners of the highest body; its centroid, so named, if no shape is known."""
    sketch = mechanism.sketch()
    corners = {}
    for body in mechanism.bodies():
        drawn = sketch.outlines.get(body.name, ()) if body.name not in sketch.at_will else ()
        shapes = [body.outline] if body.outline else list(drawn)
        corners[body.name] = np.concatenate([np.asarray(shape) for shape in shapes] or [np.array([body.centroid])])
    highest = max(corners, key=lambda name: float(corners[name].imag.max()))
    z = corners[highest]
    level = z[z.imag >= z.imag.max() - LEVEL_SHARE * float(np.ptp(z.imag) + 1e-300)]
    spot = Spot(highest, complex(level.real.min() + level.real.max(), 2 * level.imag.max()) / 2)
    return "top" if len(z) > 1 else "centroid", spot


def _where_it_bends(mechanism: Mechanism) -> Iterator[tuple[str, Spot]]:
    """Yield the hinges of a structure whose top is held sideways: there it moves most."""
    if is_held(mechanism):
        for joint in mechanism.joints(mechanism.directions[0]):
            if len(joint.bodies) == 2:
                yield f"joint {joint.letter}", Spot(joint.bodies[0], joint.point)


def is_held(mechanism: Mechanism) -> bool:
    """Return whether the top of a structure is held sideways, so that it moves most at a hinge below."""
    return any(joint.is_guide for joint in mechanism.joints(mechanism.directions[0]))


def _hung(mechanism: Mechanism) -> Iterator[tuple[str, Spot]]:
    for attachment in mechanism.attached:
        if isinstance(attachment, PointMass | ConstantForce):
            yield attachment.name, attachment.spot
        elif isinstance(attachment, Stretched):
            ends = [spot for spot in (attachment.spots[0], attachment.spots[-1]) if spot.body is not None]
            for k, spot in enumerate(ends):
                yield (attachment.name if len(ends) == 1 else f"{attachment.name} {('from', 'to')[k]}"), spot
