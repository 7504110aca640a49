"""The motion of one free body in three dimensions, and what it is worth: experimental."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import nan

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.names import ROCKS, STILL_ROCKING, UNKNOWN, outcome
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.engines.free import MOVED
from rocking_cli.studies.engines.solid_body import SolidBody

AGREEMENT = 0.05  # difference of the peaks of both over the larger, up to which the outcome is known
UNSETTLED = 0.1  # difference of their largest turn and path over the larger, up to which these are known
TURNED = 1e-3  # rad, below which a turn is not looked at
ROLLING = 0.01  # tilt over alpha above which a round foot rolls; below, it passes from one side to the other


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class SpaceHistory:
    """The motion of a body in three dimensions.

    Parameters
    ----------
    solid : SolidBody
        The body.
    time : ndarray, shape (n,)
        Times of the samples [s], those of the ground motion along x.
    moved : ndarray, shape (n, 3)
        Displacement of the point of its base that is below its centroid at rest [m].
    turned : ndarray, shape (n, 4)
        Its rotation from rest, as quaternions.
    rates : ndarray, shape (n, 6)
        Velocity of its centroid [m/s], and angular velocity about its own axes [rad/s].
    overturning_time : float
        Time at which its axis passes the tilt from which it has overturned [s]; NaN if it does not.
    at_rest : bool
        Whether it comes to rest, or was followed only until it could tilt no farther.
    failed : str
        Why the simulation is no answer, a clause; empty if it is one.
    """

    solid: SolidBody
    time: Reals
    moved: Reals
    turned: Reals
    rates: Reals
    overturning_time: float = nan
    at_rest: bool = False
    failed: str = ""

    @cached_property
    def lean(self) -> Reals:
        """Horizontal part of the unit vector along its axis, shape (n, 2)."""
        w, x, y, z = self.turned.T
        return np.stack([2 * (x * z + w * y), 2 * (y * z - w * x)], axis=1)

    @cached_property
    def tilt(self) -> Reals:
        """Angle of its axis from upright [rad]."""
        w, x, y, z = self.turned.T
        return np.asarray(np.arctan2(np.hypot(*self.lean.T), w**2 + z**2 - x**2 - y**2))

    @property
    def azimuth(self) -> Reals:
        """Direction to which its axis leans, anticlockwise from x [rad]."""
        return np.asarray(np.arctan2(self.lean[:, 1], self.lean[:, 0]))

    @cached_property
    def twist(self) -> Reals:
        """Rotation about its axis [rad]."""
        return np.asarray(np.unwrap(2 * np.arctan2(self.turned[:, 3], self.turned[:, 0])))

    @property
    def path(self) -> Reals:
        """Distance of its base from where it stood, in plan [m]."""
        return np.asarray(np.hypot(self.moved[:, 0], self.moved[:, 1]))

    @property
    def peak_ratio(self) -> float:
        """Largest tilt over alpha; up to overturning if it does."""
        return float(self.tilt.max()) / self.solid.alpha

    @cached_property
    def rolled(self) -> float:
        """Length on which the rim of a round foot rolls [m]; 0 for other feet.

        The point that touches travels along the rim while the body leans; from one side to the other through upright
        is no rolling.
        """
        w, x, y, z = self.turned.T
        down = 2 * (w * y - x * z) - 2j * (w * x + y * z)  # the lowest point of the rim, in the body
        start, end = down[:-1], down[1:]
        along = end - start
        share = np.clip(-(start * along.conj()).real / np.maximum(np.abs(along) ** 2, np.finfo(float).tiny), 0, 1)
        rolls = np.abs(start + share * along) > ROLLING * self.solid.alpha
        return self.solid.radius * float(np.abs(np.angle(end * start.conj()))[rolls].sum())

    @property
    def outcome(self) -> str:
        """What it does, in the words of `rocking_cli.names`."""
        return outcome(
            uplifts=self.peak_ratio > MOVED, overturned=np.isfinite(self.overturning_time),
            still_rocking=not self.at_rest, unknown=bool(self.failed),
            slides=bool(self.path.max() > MOVED * self.solid.height),
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class CheckedHistory:
    """A history, and a second one with half of step and softness, by which its error is known."""

    history: SpaceHistory
    halved: SpaceHistory

    @property
    def doubt(self) -> str:
        """Why the outcome is not known, a clause; empty if it is."""
        first, second = self.history, self.halved
        if why := first.failed or second.failed:
            return why
        # How long a round foot still rolls is no other outcome.
        words = [each.outcome.replace(STILL_ROCKING, ROCKS) for each in (first, second)]
        if words[0] != words[1]:
            return f"with half the time step it is another: {second.outcome}"
        peaks = sorted((first.peak_ratio, second.peak_ratio))
        if words[0] == ROCKS and peaks[1] - peaks[0] > AGREEMENT * peaks[1]:
            return f"with half the time step the peak is {second.peak_ratio:.3g} instead of {first.peak_ratio:.3g}"
        return ""

    @property
    def unsettled(self) -> str:
        """What else differs between the two by more than 10 %, in words: turn and path; empty if nothing does."""
        pairs = [(self.history, self.halved), (self.halved, self.history)]
        turns = [(np.abs(one.twist).max(), np.abs(other.twist).max(), TURNED) for one, other in pairs]
        paths = [(one.path.max(), other.path.max(), MOVED * one.solid.height) for one, other in pairs]
        differ = [
            any(one - other > UNSETTLED * one and one > least for one, other, least in each) for each in (turns, paths)
        ]
        return " and ".join(name for name, each in zip(("its turn", "its displacement"), differ, strict=True) if each)

    @property
    def outcome(self) -> str:
        """The outcome; unknown if the two histories differ."""
        return UNKNOWN if self.doubt else self.history.outcome
