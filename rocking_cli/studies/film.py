"""A time history as an animation: the rotation to show at each time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isnan
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import History
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.picture import Picture, box_around

SECONDS_BEFORE, SECONDS_AFTER = 1.0, 1.5  # s shown before the first uplift and after the end of the motion
BOX_ROTATIONS = 25  # rotations sampled for the box around the motion


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
    """

    picture: Picture
    history: History
    motion: GroundMotion
    assumed_friction: float | None = None

    @cached_property
    def _moving(self) -> int:
        """Number of samples with a rotation: all, or those before the structure overturns or the outcome is unknown."""
        return int(np.isfinite(self.history.phi).sum())

    @property
    def end(self) -> float:
        """Time at which the animation ends [s]."""
        last = float(self.history.time[self._moving - 1])
        if self.history.fell or self.history.unknown or isnan(self.history.uplift_time):
            return last
        return min(last, self.history.end_time + SECONDS_AFTER)

    @property
    def start(self) -> float:
        """Time at which the animation starts, shortly before the first uplift [s]."""
        first = self.history.uplift_time
        return 0.0 if isnan(first) else max(0.0, first - SECONDS_BEFORE)

    def rotation(self, time: Reals) -> Reals:
        """Return the signed rotation at some times, shape (n,) [rad]; after the end the last rotation simulated."""
        moving = slice(0, self._moving)
        return np.interp(time, self.history.time[moving], self.history.phi[moving])

    def ratio(self, rotation: Reals) -> Reals:
        """Divide signed rotations [rad], shape (n,), by the critical rotation or kinematic limit of their side."""
        over = self.picture.reference
        first = over[self.picture.directions[0]]
        sides = over.get(Direction.NEGATIVE, first), over.get(Direction.POSITIVE, first)
        return rotation / np.where(rotation < 0, *sides)

    @cached_property
    def box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of the area that the structure covers during its motion [m]."""
        phi = self.history.phi[: self._moving]
        views = np.linspace(float(phi.min()), float(phi.max()), BOX_ROTATIONS)
        outlines = [each for turn in views for part in self.picture.placed(float(turn))[0] for each in part]
        hung = [z for turn in views for z in self.picture.held(float(turn))]
        return box_around([np.array([*self.picture.reach, *hung]), *outlines])

    def as_dict(self, step: float) -> dict[str, Any]:
        """Return the data of an animation on a page: rotations [rad] every `step` [s], and times [s]."""
        time = np.arange(0.0, self.end + step, step)
        return {
            "step": step,
            "end": self.end,
            "start": self.start,
            "rotation": [float(f"{value:.5g}") for value in self.rotation(time).tolist()],
            "low": [self.box[0].real, self.box[0].imag],
            "high": [self.box[1].real, self.box[1].imag],
        }
