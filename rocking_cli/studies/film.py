"""Time histories as an animation: what to show of each at each time, and how much larger than it is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import floor, inf, isnan, log10, radians

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import History
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.picture import Picture, box_around

SECONDS_BEFORE, SECONDS_AFTER = 1.0, 1.5  # s shown before the first uplift and after the end of the motion
BOX_ROTATIONS = 25  # rotations sampled for the box around the motion
SMALL_ROTATION = radians(2.0)  # peak below which displacements are enlarged
ENLARGED_ROTATION = radians(5.0)  # largest rotation that an enlargement leads to
ENLARGED_SHARE = 0.5  # and its largest share of the rotation at which the structure overturns or locks
MAX_ENLARGEMENT = 100.0  # a motion that is smaller still is not made to look like rocking
GROUND_SHARE = 0.2  # largest way of the ground in the drawing, over the larger side of the smallest structure
SLOWEST_GROUND = 0.1  # Hz; in drawings, slower parts of the displacement of a record are taken as drift
FILTER_ORDER = 4


@short_repr
@dataclass(frozen=True)
class Film:
    """Motion of a structure under a ground motion, for an animation.

    Parameters
    ----------
    picture : Picture
        Drawing of the structure.
    history : History
        Time history of the structure.
    motion : GroundMotion
        The ground motion.
    assumed_friction : float, optional
        Friction that the history assumes, see `ContactDemand`.
    called : str
        Name of the film beside others; by default that of the structure.
    """

    picture: Picture
    history: History
    motion: GroundMotion
    assumed_friction: float | None = None
    called: str = ""

    @property
    def name(self) -> str:
        """Name of the film beside others."""
        return self.called or self.picture.mechanism.name or self.picture.mechanism.mechanism

    @cached_property
    def _moving(self) -> int:
        """Number of samples with a rotation: all, or those before the structure overturns or the outcome is unknown."""
        return int(np.isfinite(self.history.phi).sum())

    @property
    def uplifts(self) -> bool:
        """Whether the structure moves on the ground."""
        return not isnan(self.history.uplift_time)

    @property
    def stops(self) -> float:
        """Time after which nothing is known or simulated [s]: overturning, or `known_to`; infinite without either."""
        return float(self.history.time[self._moving - 1]) if self.history.fell or self.history.unknown else inf

    @property
    def end(self) -> float:
        """Time at which the animation ends [s]."""
        last = float(self.history.time[self._moving - 1])
        if self.stops < inf or not self.uplifts:
            return last
        return min(last, self.history.end_time + SECONDS_AFTER)

    @property
    def start(self) -> float:
        """Time at which the animation starts, shortly before the first uplift [s]."""
        return max(0.0, self.history.uplift_time - SECONDS_BEFORE) if self.uplifts else 0.0

    def rotation(self, time: Reals) -> Reals:
        """Return the signed rotation at some times, shape (n,) [rad]; after the end the last rotation simulated."""
        moving = slice(0, self._moving)
        return np.interp(time, self.history.time[moving], self.history.phi[moving])

    def place(self, time: Reals) -> Reals:
        """Return at which number the picture places its parts as they are at some times, shape (n,): the rotation."""
        return self.rotation(time)

    def ratio(self, rotation: Reals) -> Reals:
        """Divide signed rotations [rad], shape (n,), by the critical rotation or kinematic limit of their side."""
        over = self.picture.reference
        first = over[self.picture.directions[0]]
        sides = over.get(Direction.NEGATIVE, first), over.get(Direction.POSITIVE, first)
        return rotation / np.where(rotation < 0, *sides)

    @cached_property
    def extremes(self) -> tuple[float, float]:
        """Lowest and highest signed rotation [rad]."""
        phi = self.history.phi[: self._moving]
        return float(phi.min()), float(phi.max())

    @property
    def enlargement(self) -> float:
        """Largest factor by which the rotations may be enlarged; 1 from a peak of `SMALL_ROTATION` on.

        It is a round number; infinite if the structure does not rotate.
        """
        low, high = self.extremes
        if max(-low, high) >= SMALL_ROTATION:
            return 1.0
        most = inf
        for direction, peak in ((Direction.NEGATIVE, -low), (Direction.POSITIVE, high)):
            if peak > 0:
                ends = min(self.picture.limit[direction], self.picture.reference[direction])
                most = min(most, MAX_ENLARGEMENT, ENLARGED_ROTATION / peak, ENLARGED_SHARE * ends / peak)
        return max(1.0, _round_below(most))

    def box(self, enlargement: float = 1.0) -> tuple[complex, complex]:
        """Return the lower left and upper right corner of the area that the structure covers on the ground [m].

        Its rotations are `enlargement` times those of the history.
        """
        views = enlargement * np.linspace(*self.extremes, BOX_ROTATIONS)
        outlines = [each for turn in views for part in self.picture.placed(float(turn))[0] for each in part]
        hung = [z for turn in views for z in self.picture.held(float(turn))]
        return box_around([np.array([*self.picture.reach, *hung]), *outlines])


@short_repr
@dataclass(frozen=True)
class Scene:
    """Films of one or more structures under one ground motion, on one clock and at one scale.

    Parameters
    ----------
    films : tuple of Film
        The films.
    """

    films: tuple[Film, ...]

    @property
    def _moving(self) -> list[Film]:
        return [each for each in self.films if each.uplifts] or list(self.films)

    @property
    def start(self) -> float:
        """Time at which the animation starts [s]."""
        return min(each.start for each in self._moving)

    @property
    def end(self) -> float:
        """Time at which the animation ends [s]."""
        return max(each.end for each in self._moving)

    @cached_property
    def enlargement(self) -> float:
        """How many times the rotations are enlarged: a round number, which the largest of them allows."""
        times = min(each.enlargement for each in self.films)
        return times if times < inf else 1.0

    @cached_property
    def ground_enlargement(self) -> float:
        """How many times the displacement of the ground is enlarged: as the rotations, or less to stay in view."""
        way = float(np.ptp(self._ground(np.linspace(self.start, self.end, 2000))))
        sizes = [each.picture.extent[1] - each.picture.extent[0] for each in self.films]
        room = GROUND_SHARE * min(max(size.real, size.imag) for size in sizes)
        return min(self.enlargement, _round_below(room / way)) if way > 0 else self.enlargement

    @cached_property
    def is_filtered(self) -> bool:
        """Whether drift is taken off the displacement of the ground; that of a pulse is exact."""
        return self.films[0].motion.format != "pulse"

    @cached_property
    def _displacement(self) -> tuple[Reals, Reals]:
        """Times [s] and displacements of the ground [m]."""
        motion = self.films[0].motion
        if not self.is_filtered:
            # From the end on, the velocity is constant: zero, unless the pulse has an impulse.
            end = max(self.end, motion.duration) + 1.0
            last = motion.displacement[-1] + motion.velocity[-1] * (end - motion.duration)
            return np.append(motion.time, end), np.append(motion.displacement, last)
        return drawn_displacement(motion.kept, self.end)

    def _ground(self, time: Reals) -> Reals:
        return np.interp(time, *self._displacement)

    def shift(self, time: Reals) -> Reals:
        """Return the displacement of the ground in the drawing at some times, to the right, shape (n,) [m]."""
        return self.ground_enlargement * self._ground(time)

    def seen(self, film: Film, time: Reals) -> tuple[Reals, Reals]:
        """Return the place of a structure, see `Film.place`, and the shift of its ground [m] as drawn, shapes (n,).

        Both stand still from the time on at which the film stops.
        """
        return self.enlargement * film.place(time), self.shift(np.minimum(time, film.stops))

    def box(self, film: Film) -> tuple[complex, complex]:
        """Return the corners of the area that a structure covers in the drawing, with the motion of its ground [m]."""
        low, high = film.box(self.enlargement)
        _, way = self.seen(film, np.linspace(self.start, self.end, 2000))
        return low + float(way.min()), high + float(way.max())


def drawn_displacement(motion: GroundMotion, end: float) -> tuple[Reals, Reals]:
    """Return times [s] and displacements [m] of a record up to a time: its acceleration integrated twice.

    Frequencies below `SLOWEST_GROUND`, which are mostly drift, are removed by a Butterworth filter without phase; the
    record is padded with zeros. It is good for a drawing only.
    """
    spare = round(2 / SLOWEST_GROUND / motion.dt)
    after = max(0, round(end / motion.dt) - motion.npts) + spare
    spectrum = np.fft.rfft(np.pad(motion.acceleration, (spare, after)))
    frequency = np.fft.rfftfreq(spare + motion.npts + after, motion.dt)
    frequency[0] = inf
    kept = 1 / (1 + (SLOWEST_GROUND / frequency) ** (2 * FILTER_ORDER))
    whole = np.fft.irfft(-kept * spectrum / (2 * np.pi * frequency) ** 2, spare + motion.npts + after)
    return np.arange(motion.npts + after, dtype=np.float64) * motion.dt, np.asarray(whole[spare:], np.float64)


def _round_below(most: float) -> float:
    """Return the largest of 1, 2 or 5 times a power of ten that is not above a number."""
    if most == inf:
        return inf
    unit = 10.0 ** floor(log10(most))
    return next(times * unit for times in (5, 2, 1) if times * unit <= most * (1 + 1e-9))
