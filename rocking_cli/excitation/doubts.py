"""What makes a ground motion doubtful, each doubt with the number that raised it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import Measures

COARSE = 0.1  # s between samples; strong-motion records have 0.02 or less
PLAUSIBLE = (0.002, 4.0)  # g; the strongest ground motions on record have some 2.5
SAMPLES = 5  # to a mean period; white noise has 3.6, well-sampled strong motion 10 and more
OFFSET = 0.02  # mean over rms acceleration; corrected records stay below 0.002
START = 0.05  # first acceleration over the peak
FINAL_VELOCITY = 0.1  # over the peak; corrected records stay below 0.06
FINAL_DISPLACEMENT = 0.5  # over the peak; a fling near a fault may leave as much
CLIPPED = 3  # equal samples in a row at an extreme
GROWTH = 0.1  # p dt: how much a motion near overturning grows from one sample to the next


class Doubt(NamedTuple):
    """Something to be careful about.

    Parameters
    ----------
    kind : str
        A word for programs: dt, mean_period, pga, offset, start, final_velocity, final_displacement, clipped or p_dt.
    value : float
        The number that raised it: in s, s, g, g, g, m/s, m, samples and 1.
    text : str
        A sentence for people.
    """

    kind: str
    value: float
    text: str


def doubts(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    """What a ground motion itself gives reason to doubt.

    Parameters
    ----------
    motion : GroundMotion
        As read, before any scaling: whether its PGA is plausible is one of the questions.
    measured : Measures
        Its measures.

    Returns
    -------
    list of Doubt
        Empty if there is none.
    """
    return _sampling(motion, measured) + _size(motion, measured) + _baseline(motion, measured) + _clipping(motion)


def coarse_for(motion: GroundMotion, p: float, what: str = "this structure") -> list[Doubt]:
    """Whether the samples are too far apart for a structure, called `what`, of frequency parameter p [rad/s]."""
    product = p * motion.dt
    if product <= GROWTH:
        return []
    text = (
        f"dt = {motion.dt:g} s is coarse for {what}: p dt = {product:.2g}, so that near overturning its "
        f"motion grows by {100 * np.expm1(min(product, 700.0)):.2g} % from sample to sample"
    )
    return [Doubt("p_dt", product, text)]


def _sampling(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    if motion.dt > COARSE:
        text = f"dt = {motion.dt:g} s is coarse for a ground motion: is the first column really time in seconds?"
        return [Doubt("dt", motion.dt, text)]
    period = measured.mean_period
    if period is not None and 0 < period < SAMPLES * motion.dt:
        text = (
            f"dt = {motion.dt:g} s is coarse for this motion: {period / motion.dt:.2g} samples to its mean period of "
            f"{period:.2g} s, so that peaks fall between them"
        )
        return [Doubt("mean_period", period, text)]
    return []


def _size(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    if PLAUSIBLE[0] <= measured.pga <= PLAUSIBLE[1]:
        return []
    text = f"a PGA of {measured.pga:.3g} g is unusual for a ground motion: is the unit really {motion.unit}?"
    return [Doubt("pga", measured.pga, text)]


def _baseline(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    found = []
    if abs(measured.mean) > OFFSET * measured.rms:
        share = 100 * abs(measured.mean) / measured.rms
        text = f"the mean acceleration is {measured.mean:.2g} g, {share:.0f} % of its rms: an offset of the baseline?"
        found.append(Doubt("offset", measured.mean, text))
    start = float(motion.acceleration[0]) / STANDARD_GRAVITY
    if abs(start) > START * measured.pga:
        share = 100 * abs(start) / measured.pga
        text = f"it starts at {start:.2g} g, {share:.0f} % of its peak, and not at rest: an offset, or cut off?"
        found.append(Doubt("start", start, text))
    if abs(measured.final_velocity) > FINAL_VELOCITY * measured.pgv:
        share = 100 * abs(measured.final_velocity) / measured.pgv
        text = (
            f"its velocity drifts: it ends at {measured.final_velocity:.2g} m/s, {share:.0f} % of its peak: "
            "an uncorrected baseline, or cut off?"
        )
        found.append(Doubt("final_velocity", measured.final_velocity, text))
    if abs(measured.final_displacement) > FINAL_DISPLACEMENT * measured.pgd:
        share = 100 * abs(measured.final_displacement) / measured.pgd
        text = (
            f"its displacement ends at {measured.final_displacement:.2g} m, {share:.0f} % of its peak: "
            "an uncorrected baseline, or a ground that stays displaced?"
        )
        found.append(Doubt("final_displacement", measured.final_displacement, text))
    return found


def _clipping(motion: GroundMotion) -> list[Doubt]:
    # Between two points of a film as high as each other there are any number of samples.
    a = motion.acceleration if motion.points is None else motion.acceleration[motion.points]
    peak = float(np.abs(a).max())
    what = "samples" if motion.points is None else "points"
    found = []
    for extreme in dict.fromkeys((float(a.max()), float(a.min()))):
        run = _longest_run(np.flatnonzero(a == extreme))
        if run >= CLIPPED and abs(extreme) > peak / 2:  # not the zeros that a one-sided pulse never goes below
            text = f"{run} {what} in a row stand at its extreme of {extreme / STANDARD_GRAVITY:.3g} g: clipped?"
            found.append(Doubt("clipped", float(run), text))
    return found


def _longest_run(indexes: NDArray[np.intp]) -> int:
    """How many of these ascending indexes follow one another without a gap, at most."""
    gaps = np.flatnonzero(np.diff(indexes) > 1)
    ends = np.concatenate([[-1], gaps, [indexes.size - 1]])
    return int(np.diff(ends).max())
