"""Check of time histories: blocks under ground motions against a general solver of differential equations."""

from __future__ import annotations

from math import cos, nan, sin, tan
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.studies.selfcheck.comparing import largest_difference
from rocking_cli.studies.selfcheck.free_block import FreeBlock
from rocking_cli.studies.selfcheck.motions import MOTIONS

IMPACTS = 6  # of later ones the times depend on rounding
FREE = 10.0  # s after the motion within which each excursion ends
MODELS: tuple[ModelName, ...] = ("nonlinear", "linear2")
BLOCKS = (FreeBlock(0.7, 2.8), FreeBlock(0.3, 1.5), FreeBlock(1.0, 3.0))


def deviation(quick: bool) -> float:
    """Return the largest difference between times of uplift, impacts and overturning [s]."""
    blocks, motions = (BLOCKS[:1], MOTIONS[:2]) if quick else (BLOCKS, MOTIONS)
    return max(_deviation(*case) for case in ((b, m, name) for b in blocks for m in motions for name in MODELS))


def _deviation(block: FreeBlock, motion: GroundMotion, name: ModelName) -> float:
    history = follow(block.structure().model(name), motion)
    found = [history.uplift_time, *history.impacts[:IMPACTS, 0]]
    if history.fell:
        found.append(history.overturning_time)
    return largest_difference(found, event_times(block, motion, linear=name != "nonlinear"))


def event_times(block: FreeBlock, motion: GroundMotion, *, linear: bool) -> list[float]:
    """Return the times of uplift, of the first impacts, and of overturning if the block overturns before these [s]."""
    alpha, p, time, ground = block.alpha, block.p, motion.time, motion.acceleration / STANDARD_GRAVITY
    k, t = _uplift(time, np.abs(ground), tan(alpha))
    s, y, found, crossed = (-1 if ground[k + 1] > 0 else 1), [0.0, 0.0], [t], nan

    def slopes(t: float, y: Any) -> tuple[float, float]:
        push = s * (ground[k] + (ground[k + 1] - ground[k]) * (t - time[k]) / motion.dt) if k + 1 < time.size else 0.0
        if linear:
            return y[1], p**2 * (y[0] - alpha - alpha / tan(alpha) * push)  # of the equivalent block with kappa2
        return y[1], -(p**2) * (sin(alpha - y[0]) + push * cos(alpha - y[0]))

    while len(found) <= IMPACTS:
        stop = time[k + 1] if k + 1 < time.size else t + FREE
        run = solve_ivp(
            slopes, (t, stop), y, "DOP853", events=_events(alpha), rtol=1e-12, atol=1e-14, max_step=0.02
        )  # fmt: skip
        impact, passed, far = run.t_events
        crossed = passed[-1] if passed.size else crossed
        t, y = float(run.t[-1]), run.y[:, -1]
        if far.size:
            return [*found, float(crossed)]
        if impact.size:
            found.append(t)
            s, y = -s, [0.0, -block.eta * y[1]]
        else:
            k += 1
    return found


def _uplift(time: Any, ground: Any, threshold: float) -> tuple[int, float]:
    """Return when the ground acceleration over g first exceeds the threshold: the sample before, and the time [s]."""
    k = int((ground > threshold).argmax()) - 1
    return k, float(time[k] + (time[k + 1] - time[k]) * (threshold - ground[k]) / (ground[k + 1] - ground[k]))


def _events(alpha: float) -> list[Any]:
    """Return functions for the solver that vanish at an impact, at the critical rotation, and far beyond it."""

    def impact(t: float, y: Any) -> float:
        return float(y[0])

    def critical(t: float, y: Any) -> float:
        return float(y[0] - alpha)

    def far(t: float, y: Any) -> float:
        return float(y[0] - 2 * alpha)

    events: list[Any] = [impact, critical, far]
    for event, terminal, direction in zip(events, (True, False, True), (-1, 1, 1), strict=True):
        event.terminal, event.direction = terminal, direction
    return events
