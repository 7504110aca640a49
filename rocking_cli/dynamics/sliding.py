"""Bodies that only slide: the rule by which they never rock, and their slip, integrated in closed form.

A single body on one level foot, from rest, with constant forces at most. While it sticks or slides, its horizontal
acceleration stays between those at which friction T = -+ mu N holds it. If both ends of the foot press at these two,
they press at all in between: the body never rocks while N > 0. Then its slip x, relative to the ground, follows from

    x.. = -(u_g'' + c) - sgn(x.) r,   c = T_0/m,   r = mu N/m,   N affine in v_g''

which is linear in time between samples, so that x is a cubic from one event to the next: it starts, stops or turns.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import inf, isclose, isnan, nan
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.core import Mechanism
from rocking_cli.core.bounds import Clearance, clearances
from rocking_cli.core.hung.attached import PointMass
from rocking_cli.core.hung.element import ConstantForce
from rocking_cli.core.released import ONE, PUSH, WEIGHT
from rocking_cli.core.structure_fields import Strength
from rocking_cli.dynamics import kernels, openings, stepping
from rocking_cli.dynamics.resting import resting
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr

LEVEL = 1e-6  # difference in height of the ends of a level foot, over its width
ZERO_TENSION = 1e-9  # tension over the weight that counts as zero, as rounding
MOST_VALUES = 200_000  # pieces times runs whose accelerations are found at once: 15 MB
RIGHT, LEFT = 1, -1  # sense of a slip, and place in arrays over it
BISECTIONS = 60  # halvings of the time in which a body arrives, to the last digit


@short_repr
@dataclass(frozen=True, eq=False)
class Sliding:
    """The foot of a single body at rest, from which it follows whether the body only slides.

    Parameters
    ----------
    joint : str
        Name of the joint with the ground.
    ends : ndarray, shape (2, 3)
        Normal force at each end of the foot [N]: factors of 1, of the horizontal and of the vertical acceleration.
    shear : ndarray, shape (3,)
        Shear force that holds the body still [N], to the right on the body, in the same way.
    friction : float
        Coefficient of friction.
    strength : float
        Largest normal force at an end [N].
    clear : tuple of Clearance
        How far it may slide to the left and to the right.
    """

    joint: str
    ends: Reals
    shear: Reals
    friction: float
    strength: float
    clear: tuple[Clearance, Clearance]

    @property
    def symmetric(self) -> bool:
        """Whether it may slide as far to the left as to the right."""
        return isclose(*(each.distance for each in self.clear), rel_tol=LEVEL)

    @property
    def friction_to_rock(self) -> float:
        """Coefficient of friction beyond which the body may rock under horizontal motion; infinite if it never does."""
        (still, push, _), normal = self.ends.T, float(self.ends[:, 0].sum())
        with np.errstate(divide="ignore"):
            at = -still / push * self.shear[1] + self.shear[0]  # shear force at which an end has no more to bear
        return float(np.abs(at).min()) / normal

    def holds(self, slender: Reals, lowest: Reals, highest: Reals) -> Bools:
        """Return whether bodies only slide, while their weight presses them down.

        Parameters
        ----------
        slender : ndarray, shape (n,)
            Factors on the slenderness of the body.
        lowest, highest : ndarray, shape (n,)
            Extremes of v_g'' [m/s2].
        """
        normal = self.ends.sum(axis=0)
        good = np.full(len(slender), bool(abs(self.shear[0]) < self.friction * normal[0]))
        for up in (lowest, highest):
            total = normal[0] + normal[2] * up
            good &= total > 0
            for sense in (-1, 1):
                push = (sense * self.friction * total - self.shear[0]) / self.shear[1] / slender
                for one, across, lift in self.ends.tolist():
                    force = one + across * push + lift * up
                    good &= (force >= -ZERO_TENSION * total) & (force <= self.strength)
        return good


class Slip(NamedTuple):
    """Slip of a body relative to the ground, each an ndarray of many motions, or a number.

    Parameters
    ----------
    largest : float
        Displacement where it is farthest from its place [m], positive to the right.
    residual : float
        Displacement at the end [m]; NaN if it is not known.
    path : float
        Length of its path [m].
    begins : float
        Time at which it first slides [s]; NaN if it does not.
    ends : float
        Time at which it stops for good, or has slid as far as it may [s]; 0 if it does not slide.
    arrives : float
        Time at which it has slid as far as it may [s]; NaN if it stops before.
    """

    largest: Reals
    residual: Reals
    path: Reals
    begins: Reals
    ends: Reals
    arrives: Reals


@short_repr
@dataclass(frozen=True, eq=False)
class Slid:
    """Slip of one history.

    Parameters
    ----------
    largest, residual, path : float
        See `Slip` [m].
    displacement : ndarray, shape (n,)
        Slip at the samples of the history [m]; NaN after it is no longer known.
    arrives : Clearance, optional
        Where it has arrived, beyond which it is not known; None if it stops before.
    """

    largest: float
    residual: float
    path: float
    displacement: Reals
    arrives: Clearance | None = None


def sliding_of(mechanism: Mechanism) -> Sliding | None:
    """Return the foot of a single body that may only slide; None for any other structure.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    """
    steady = all(isinstance(attachment, PointMass | ConstantForce) for attachment in mechanism.attached)
    if not (steady and mechanism.rocks_both_ways and len(mechanism.pieces(mechanism.directions[0])) == 1):
        return None
    closed = resting(mechanism).closed
    if closed is None or [contact.forces for contact in closed.contacts] != [3]:
        return None
    # With a tie or a spring, what follows would depend on how far it has slid.
    (foot,), ((normal, shear),) = closed.contacts, closed.rows
    left, right = sorted(foot.points, key=lambda point: point.real)
    level = abs(foot.normal - 1j) < LEVEL and abs((right - left).imag) <= LEVEL * abs(right - left)
    if foot.friction is None or foot.pieces[0] is not None or not level:
        return None
    strength = inf
    if isinstance(mechanism.strength, Strength) and mechanism.depth is not None:
        strength = mechanism.strength.force(mechanism.depth)
    columns = [ONE, PUSH, WEIGHT]
    force, clear = closed.force[0][:, columns], clearances(mechanism, left, right - 1j * foot.roll)
    return Sliding(foot.label, force[list(normal)], force[shear], foot.friction, strength, clear)


class _Pieces(NamedTuple):
    """Ground motions as pieces in which accelerations are straight, shape (pieces, motions); those of 0 s fill up."""

    span: Reals
    u: Reals
    u_rate: Reals
    v: Reals
    v_rate: Reals

    @classmethod
    def of(cls, motions: Iterable[GroundMotion]) -> _Pieces:
        each = [list(_pieces(motion)) for motion in motions]
        count = max(len(columns[0]) for columns in each)
        padded = [[np.pad(column, (0, count - len(column))) for column in columns] for columns in each]
        return cls(*np.ascontiguousarray(np.array(padded).transpose(1, 2, 0)))


def _pieces(motion: GroundMotion) -> Iterator[Reals]:
    """Yield the columns of `_Pieces` of one motion; each component is zero after its last sample."""
    up, times = motion.vertical, motion.time
    if up is not None:
        times = np.union1d(times, up.time)
    yield np.diff(times)
    for component in (motion, up):
        if component is None:
            yield from np.zeros((2, len(times) - 1))
            continue
        at = np.interp(times, component.time, component.acceleration)
        beyond = times[:-1] >= component.duration
        yield np.where(beyond, 0.0, at[:-1])
        yield np.where(beyond, 0.0, np.diff(at) / np.diff(times))


def slips(
    feet: Sequence[Sliding],
    motions: Sequence[GroundMotion],
    foot: Integers,
    record: Integers,
    factor: Reals,
    size: Reals,
    kept: list[tuple[float, float, float]] | None = None,
) -> Slip:
    """Integrate the slip of bodies that only slide, from rest.

    Parameters
    ----------
    feet : sequence of Sliding
        The feet.
    motions : sequence of GroundMotion
        The ground motions.
    foot, record : ndarray of int, shape (n,)
        Foot and ground motion of each run.
    factor : ndarray, shape (n,)
        Factor on the ground motion of each run, whose sign reverses the horizontal component.
    size : ndarray, shape (n,)
        Factor on the distances to which a body may slide.
    kept : list, optional
        Of a single run: filled with time, slip and rate at the end of each piece of the motion.
    """
    pieces, n = _Pieces.of(motions), len(foot)
    ends = np.array([each.ends.sum(axis=0) for each in feet])[foot]
    shear, mu = np.array([each.shear for each in feet])[foot], np.array([each.friction for each in feet])[foot]
    drives = _Drives(factor, abs(factor), *(np.array([shear[:, 0], *(mu * ends.T)[[0, 2]]]) / shear[:, 1]))
    before, beyond = (size * np.array([each.clear[k].distance for each in feet])[foot] for k in (0, 1))
    run = _Run(-before, beyond, np.zeros(n, np.int64), *np.zeros((6, n)), *np.full((2, n), nan))
    begun = np.cumsum(pieces.span, axis=0) - pieces.span
    chunk = max(MOST_VALUES // n, 1)
    for first in range(0, len(begun), chunk):
        span, *accelerations = (each[first : first + chunk, record] for each in pieces)
        gain, growth, quiet = drives.over(span, *accelerations)
        still = np.asarray(quiet.all(axis=1))
        for k in range(len(span)):
            if not still[k] or run.sense.any():
                run.go(begun[first + k, record], span[k], gain[:, k], growth[:, k], quiet[k])
            if kept is not None:
                kept.append((begun[first + k, 0] + span[k, 0], run.slip[0], run.speed[0]))
    # After the record, friction stops what still slides.
    gain, growth, _ = drives.over(*np.zeros((5, n)))
    run.advance(np.flatnonzero(run.sense), pieces.span.sum(axis=0)[record], np.full(n, inf), gain, growth)
    largest = np.where(run.high >= -run.low, run.high, run.low)
    residual = np.where(np.isnan(run.arrives), run.slip, nan)
    return Slip(largest, residual, run.path, run.begins, run.ends, run.arrives)


class _Drives(NamedTuple):
    """What drives many bodies, shape (n,) each: factors on both components of the motion, T_0/m and mu N/m."""

    factor: Reals
    v_factor: Reals
    thrust: Reals
    grip: Reals
    v_grip: Reals

    def over(self, span: Reals, u: Reals, u_rate: Reals, v: Reals, v_rate: Reals) -> tuple[Reals, Reals, Bools]:
        """Return how fast bodies that slide gain speed at the start of pieces, its rate, and where they stick.

        Of shape (3, ..., n) for those that stick (0), slide to the right (1) and to the left (-1).
        """
        a, a_rate = self.factor * u + self.thrust, self.factor * u_rate
        r, r_rate = self.grip + self.v_grip * self.v_factor * v, self.v_grip * self.v_factor * v_rate
        gain, growth = np.zeros((2, 3, *a.shape))
        gain[RIGHT], gain[LEFT] = -a - r, a - r
        growth[RIGHT], growth[LEFT] = -a_rate - r_rate, a_rate - r_rate
        return gain, growth, np.maximum(gain, gain + growth * span).max(axis=0) <= 0


@dataclass
class _Run:
    """State of many bodies: slip, speed and its sense (0: it sticks), and what has been so far, shape (n,) each."""

    least: Reals
    most: Reals
    sense: Integers
    slip: Reals
    speed: Reals
    path: Reals
    low: Reals
    high: Reals
    ends: Reals
    begins: Reals
    arrives: Reals

    def go(self, start: Reals, span: Reals, gain: Reals, growth: Reals, quiet: Bools) -> None:
        """Advance all bodies over a piece; those to which nothing happens at once, the others by their events."""
        every = np.arange(self.sense.size)
        more, rate = gain[self.sense, every], growth[self.sense, every]
        after = self.speed + span * (more + span * rate / 2)
        ahead = span * (self.speed + span * (more / 2 + span * rate / 6))
        slip = self.slip + self.sense * ahead
        calm = (after > 0) & ((more >= 0) | (rate <= 0)) & (slip > self.least) & (slip < self.most)
        calm = np.where(self.sense == 0, quiet, calm) | ~np.isnan(self.arrives)
        self.slip, self.speed = np.where(calm, slip, self.slip), np.where(calm, after, self.speed)
        self.path += np.where(calm, ahead, 0.0)
        if not calm.all():
            self.advance(np.flatnonzero(~calm), start, span, gain, growth)

    def advance(self, at: Integers, start: Reals, span: Reals, gains: Reals, growths: Reals) -> None:
        """Advance the bodies `at` over a piece, from one event to the next."""
        tau = np.zeros(at.size)
        while at.size:
            sense, speed, left = self.sense[at], self.speed[at], span[at] - tau
            gain, growth = gains[:, at], growths[:, at]
            gain = gain + np.where(growth == 0, 0.0, growth * tau)
            # What sticks starts in the sense in which the ground first overcomes friction.
            starts = _starts(gain, growth)
            towards = np.where(starts[RIGHT] <= starts[LEFT], RIGHT, LEFT)
            sticks, here = sense == 0, np.arange(at.size)
            gain, growth = gain[sense, here], growth[sense, here]
            gain = np.where(speed == 0, np.maximum(gain, 0.0), gain)
            lasts = np.where(sticks, starts[towards, here], _stops(speed, gain, growth))
            within = lasts < left
            step = np.where(within, lasts, np.where(sticks, 0.0, left))
            ahead = np.maximum(step * (speed + step * (gain / 2 + step * growth / 6)), 0.0)
            after = np.where(within | sticks, 0.0, np.maximum(speed + step * (gain + step * growth / 2), 0.0))
            slip = self.slip[at] + sense * ahead
            reached = ~sticks & ((slip <= self.least[at]) | (slip >= self.most[at]))
            for k in np.flatnonzero(reached):
                limit = self.most[at[k]] if sense[k] > 0 else self.least[at[k]]
                ahead[k] = max(sense[k] * (limit - self.slip[at[k]]), 0.0)
                slip[k] = limit
                step[k] = _arrival(ahead[k], speed[k], gain[k], growth[k], step[k])
                self.arrives[at[k]] = start[at[k]] + tau[k] + step[k]
            tau = tau + step
            self.slip[at], self.speed[at] = slip, np.where(reached, 0.0, after)
            self.path[at] += np.where(sticks, 0.0, ahead)
            self.low[at], self.high[at] = np.minimum(self.low[at], slip), np.maximum(self.high[at], slip)
            self.ends[at] = np.where(sticks, self.ends[at], start[at] + tau)
            self.begins[at] = np.fmin(self.begins[at], np.where(sticks & within, start[at] + tau, nan))
            self.sense[at] = np.where(reached, 0, np.where(within, np.where(sticks, towards, 0), sense))
            on = within & ~reached
            at, tau = at[on], tau[on]


def _starts(gain: Reals, growth: Reals) -> Reals:
    """Return after which time the gain of speed becomes positive, infinite if it does not."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(gain > 0, 0.0, np.where(growth > 0, -gain / growth, inf))


def _stops(speed: Reals, gain: Reals, growth: Reals) -> Reals:
    """Return after which time speed + gain t + growth t^2/2 falls to zero, infinite if it does not."""
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(gain**2 - 2 * growth * speed)
        slow = 2 * speed / (root - gain)  # no difference of like numbers, as the gain is not positive
        fast = (gain + root) / -growth
        rests = (speed == 0) & (gain == 0) & (growth > 0)
        first = np.where(gain > 0, np.where(growth < 0, fast, inf), np.where(speed == 0, 0.0, slow))
    return np.where(rests | np.isnan(first), inf, first)


def _arrival(ahead: float, speed: float, gain: float, growth: float, longest: float) -> float:
    """Return the time after which a body has slid a distance ahead, in a piece in which it slides farther."""
    low, high = 0.0, longest
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        far = middle * (speed + middle * (gain / 2 + middle * growth / 6)) > ahead
        low, high = (low, middle) if far else (middle, high)
    return high


def settle(
    marks: Reals,
    feet: Sequence[Sliding | None],
    motions: Sequence[GroundMotion | None],
    runs: Reals,
    kept: list[tuple[float, float, float]] | None = None,
) -> tuple[Reals, Slip | None]:
    """Settle the runs in which a body only slides, and return the largest slip of all runs, 0 of others, shape (n,).

    Parameters
    ----------
    marks : ndarray, shape (n, MARKS)
        What the kernel found, which is corrected.
    feet : sequence of Sliding or None
        The foot of each structure; None if it may do more than slide.
    motions : sequence of GroundMotion or None
        The ground motions.
    runs : ndarray
        Runs of the kernel.
    kept : list, optional
        See `slips`.

    Returns
    -------
    largest : ndarray, shape (n,)
        The largest slips [m].
    slip : Slip or None
        The slip of all runs in which a body only slides; None without any.
    """
    structure, record = (runs[:, column].astype(np.int64) for column in (kernels.STRUCTURE, kernels.RECORD))
    slender, largest = runs[:, kernels.SLENDER], np.zeros(len(runs))
    stands, shaken = (np.array([each is not None for each in every], np.bool_) for every in (feet, motions))
    able = np.asarray(stands[structure] & shaken[record] & (runs[:, kernels.START] == 0))
    if not able.any():
        return largest, None
    up = np.array([_extremes(motion) for motion in motions])[record] * runs[:, kernels.V_FACTOR, None]
    for k in np.unique(structure[able]).tolist():
        foot, mine = feet[k], np.flatnonzero(able & (structure == k))
        assert foot is not None
        able[mine] = foot.holds(slender[mine], *up[mine].T)
    slides = np.flatnonzero(able)
    if not slides.size:
        return largest, None
    # Only the structures and motions of these runs.
    (bodies, stands_on), (grounds, under) = (np.unique(of[slides], return_inverse=True) for of in (structure, record))
    slip = slips(
        [foot for k in bodies if (foot := feet[k]) is not None],
        [motion for k in grounds if (motion := motions[k]) is not None],
        stands_on,
        under,
        runs[slides, kernels.FACTOR] * slender[slides],
        runs[slides, kernels.SIZE],
        kept,
    )
    arrived = ~np.isnan(slip.arrives)
    known = np.full((slides.size, stepping.MARKS), nan)
    for column in (stepping.PEAK, stepping.RATE_PEAK, openings.PASSED_PEAK):
        known[:, column : column + 2] = 0.0
    known[:, [stepping.SIDE, stepping.IMPACTS, openings.PASSED_IMPACTS, openings.LARGEST, openings.LONGEST]] = 0.0
    known[:, stepping.STATUS], known[:, stepping.ENDED] = kernels.AT_REST, slip.ends
    known[:, openings.WARNED], known[:, openings.PASSED] = slip.begins, slip.arrives
    known[:, openings.WARNED_PEAK : openings.WARNED_PEAK + 2] = 0.0
    known[arrived, openings.REASON], known[arrived, openings.WHERE] = openings.SLIDES, 0.0
    marks[slides], largest[slides] = known, abs(slip.largest)
    return largest, slip


def _extremes(motion: GroundMotion | None) -> tuple[float, float]:
    """Return the lowest and the highest vertical acceleration of a ground motion [m/s2], which begins and ends at 0."""
    if motion is None or motion.vertical is None:
        return 0.0, 0.0
    return min(float(motion.vertical.acceleration.min()), 0.0), max(float(motion.vertical.acceleration.max()), 0.0)


def slid_of(sliding: Sliding, slip: Slip, kept: Sequence[tuple[float, float, float]], time: Reals) -> Slid:
    """Return the slip of one history at its samples; `kept` is that of `slips`."""
    ends, at, rate = (np.array([0.0, *column]) for column in zip(*kept, strict=True))
    largest, residual, path, _, stops, arrives = (float(each[0]) for each in slip)
    displacement = np.interp(time, ends, at)  # the samples of a history are among the ends of pieces
    if not isnan(arrives):
        displacement[time > arrives] = nan
        return Slid(largest, residual, path, displacement, sliding.clear[largest > 0])
    if rate[-1]:  # after the record it slows down evenly
        share = np.clip((time - ends[-1]) / (stops - ends[-1]), 0.0, 1.0)
        displacement += (residual - at[-1]) * share * (2 - share)
    return Slid(largest, residual, path, displacement)
