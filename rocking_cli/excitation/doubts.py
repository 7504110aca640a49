"""Reasons to doubt a ground motion, each with the number that gives rise to it."""

from __future__ import annotations

import numpy as np

from rocking_cli.arrays import median
from rocking_cli.excitation.base import STANDARD_GRAVITY, Doubt, GroundMotion
from rocking_cli.excitation.measures import Measures

MAX_DT = 0.1  # s; strong-motion records have 0.02 or less
PLAUSIBLE_PGA = (0.002, 4.0)  # g; the strongest ground motions on record reach about 2.5
MIN_SAMPLES_PER_MEAN_PERIOD = 5  # white noise has 3.6, well-sampled strong motion at least 10
MAX_MEAN_OVER_RMS = 0.02  # corrected records stay below 0.002
MAX_START_OVER_PEAK = 0.05
FINAL_VELOCITY = 0.1  # share of the peak; corrected records stay below 0.06
FINAL_DISPLACEMENT = 0.5  # share of the peak; a fling near a fault may leave as much
CLIPPED_SAMPLES = 3  # consecutive equal samples at an extreme
SPIKE_RATIO = 8  # residual of a displaced sample over that of its surroundings; sound records stay below 5
DROPOUT_SAMPLES = 5  # consecutive equal samples between two jumps
MIN_JUMP_OVER_PEAK = 0.05
MIN_JUMP_OVER_STEP = 3  # times the median step; one step of the last digit is not a jump
MIN_RESIDUAL = 0.001  # share of the peak; smaller residuals around a sample are raised to it
MAX_GROWTH = 0.1  # p dt: growth of a motion near overturning from one sample to the next
_SMOOTH_SAMPLES = 18  # number of samples on either side with which a spike is compared


def doubts(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    """Return the reasons to doubt a ground motion.

    Parameters
    ----------
    motion : GroundMotion
        The motion as read, before scaling, as its PGA is checked; for the motion of a floor, that of the ground.
    measured : Measures
        Measures of the motion.

    Returns
    -------
    list of Doubt
        The doubts; empty if there are none.
    """
    return [
        *motion.remarks,
        *_sampling(motion, measured),
        *_size(motion, measured),
        *_baseline(motion, measured),
        *of_samples(motion),
    ]


def of_samples(motion: GroundMotion, *, accelerations: bool = True) -> list[Doubt]:
    """Return the doubts about single samples; none for a corrected motion, in which corrections hide them.

    If the values are not `accelerations`, only isolated samples are doubted: a displacement of few digits that stays
    constant is not clipped.
    """
    if not all(each.startswith("gain ") for each in motion.processing):
        return []
    if accelerations:
        return [*_clipping(motion), *_spikes(motion), *_dropouts(motion)]
    alone = "isolated spike at {:.6g} s: is this sample corrupted?"
    return [each._replace(text=alone.format(each.value)) for each in _spikes(motion)]


def coarse_for(motion: GroundMotion, p: float, what: str = "this structure") -> list[Doubt]:
    """Return a doubt if dt is too long for a structure, called `what`, of frequency parameter p [rad/s]."""
    product = p * motion.dt
    if product <= MAX_GROWTH:
        return []
    text = (
        f"dt = {motion.dt:g} s is coarse for {what}: p dt = {product:.2g}, so that near overturning its "
        f"motion increases by {100 * np.expm1(min(product, 700.0)):.2g} % from sample to sample"
    )
    return [Doubt("p_dt", product, text)]


def _sampling(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    if motion.dt > MAX_DT:
        text = f"dt = {motion.dt:g} s is coarse for a ground motion: is the first column really time in seconds?"
        return [Doubt("dt", motion.dt, text)]
    period = measured.mean_period
    if period is not None and 0 < period < MIN_SAMPLES_PER_MEAN_PERIOD * motion.dt:
        text = (
            f"dt = {motion.dt:g} s is coarse for this motion: {period / motion.dt:.2g} samples to its mean period of "
            f"{period:.2g} s, so that peaks fall between them"
        )
        return [Doubt("mean_period", period, text)]
    return []


def _size(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    if PLAUSIBLE_PGA[0] <= measured.pga_g <= PLAUSIBLE_PGA[1]:
        return []
    text = f"a PGA of {measured.pga_g:.3g} g is unusual for a ground motion: is the unit really {motion.source_unit}?"
    return [Doubt("pga", measured.pga_g, text)]


def _baseline(motion: GroundMotion, measured: Measures) -> list[Doubt]:
    start = float(motion.acceleration[0]) / STANDARD_GRAVITY
    end, displacement = measured.final_velocity, measured.final_displacement
    checks = (  # keyword, value, reference, share of the reference above which the value is doubtful, text
        ("offset", measured.mean, measured.rms, MAX_MEAN_OVER_RMS,
         "the mean acceleration is {:.2g} g, {:.0f} % of its rms: an offset of the baseline?"),
        ("start", start, measured.pga_g, MAX_START_OVER_PEAK,
         "it starts at {:.2g} g, {:.0f} % of its peak, and not at rest: an offset, or cut off?"),
        ("final_velocity", end, measured.pgv, FINAL_VELOCITY,
         "its velocity drifts: it ends at {:.2g} m/s, {:.0f} % of its peak: an uncorrected baseline, or cut off?"),
        ("final_displacement", displacement, measured.pgd, FINAL_DISPLACEMENT,
         "its displacement ends at {:.2g} m, {:.0f} % of its peak: an uncorrected baseline, or a ground that stays "
         "displaced?"),
    )  # fmt: skip
    return [
        Doubt(kind, value, text.format(value, 100 * abs(value) / whole))
        for kind, value, whole, limit, text in checks
        if abs(value) > limit * whole
    ]


def _clipping(motion: GroundMotion) -> list[Doubt]:
    # In a digitised film, interpolation puts any number of equal samples between two equal points.
    a = motion.acceleration if motion.points is None else motion.acceleration[motion.points]
    peak = float(np.abs(a).max())
    what = "samples" if motion.points is None else "points"
    doubts = []
    for extreme in dict.fromkeys((float(a.max()), float(a.min()))):
        there = np.flatnonzero(a == extreme)
        ends = np.concatenate([[-1], np.flatnonzero(np.diff(there) > 1), [there.size - 1]])  # of runs in a row
        run = int(np.diff(ends).max())
        if run >= CLIPPED_SAMPLES and abs(extreme) > peak / 2:  # a one-sided pulse has many zeros at its other extreme
            text = f"{run} {what} in a row stand at its extreme of {extreme / STANDARD_GRAVITY:.3g} g: clipped?"
            doubts.append(Doubt("clipped", float(run), text))
    return doubts


def _spikes(motion: GroundMotion) -> list[Doubt]:
    """Return doubts about isolated samples, such as those with a lost sign or digit.

    Each sample is compared with the cubic through its four neighbours. One wrong sample leaves differences at itself
    and at its neighbours in the ratio of `pattern`, which nothing else does if the motion around is smooth.
    """
    a = motion.acceleration
    if a.size < 2 * _SMOOTH_SAMPLES:
        return []
    pattern = np.array([1, -4, 6, -4, 1]) / 6
    residuals = np.convolve(a, pattern, "valid")  # without the first and last two samples
    error = np.convolve(residuals, pattern[::-1], "valid") / (pattern @ pattern)
    least = MIN_RESIDUAL * float(np.abs(a).max())
    spikes = []
    for k in np.flatnonzero(np.abs(error) > SPIKE_RATIO * least).tolist():
        part = np.abs(residuals[k : k + 5] - error[k] * pattern)
        if abs(error[k]) <= SPIKE_RATIO * float(part.max()):
            continue
        around = np.concatenate(
            [residuals[max(k - _SMOOTH_SAMPLES, 0) : k], residuals[k + 5 : k + 5 + _SMOOTH_SAMPLES]]
        )
        if abs(error[k]) > SPIKE_RATIO * max(float(np.abs(around).max()), least):
            spikes.append(k)
    if not spikes:
        return []
    worst = max(spikes, key=lambda k: abs(error[k]))
    sample, time = worst + 4, (worst + 4) * motion.dt
    more = f", and {len(spikes) - 1} more like it" if len(spikes) > 1 else ""
    text = (
        f"sample {sample + 1}, at {time:.6g} s, stands alone{more}: {a[sample] / STANDARD_GRAVITY:.3g} g, where its "
        f"neighbours make {(a[sample] - error[worst]) / STANDARD_GRAVITY:.3g} g: a damaged number?"
    )
    return [Doubt("spike", time, text)]


def _dropouts(motion: GroundMotion) -> list[Doubt]:
    """Return doubts about intervals in which the motion stops and resumes suddenly, as lost values do."""
    a = motion.acceleration
    steps = np.diff(a)
    peak = float(np.abs(a).max())
    changes = np.flatnonzero(steps)
    if not changes.size:
        return []
    sizes = np.abs(steps[changes])
    jumps = sizes > max(MIN_JUMP_OVER_PEAK * peak, MIN_JUMP_OVER_STEP * median(sizes))
    level = np.abs(a[changes[1:]]) < peak  # equal samples at the peak are clipping
    lost = np.flatnonzero((np.diff(changes) >= DROPOUT_SAMPLES) & jumps[:-1] & jumps[1:] & level)
    if not lost.size:
        return []
    start, end = (int(place) for place in changes[lost[0] : lost[0] + 2])
    more = f", and {lost.size - 1} times more" if lost.size > 1 else ""
    text = (
        f"{end - start} samples from {(start + 1) * motion.dt:.6g} s on are all {a[end] / STANDARD_GRAVITY:.3g} g, "
        f"between two jumps{more}: values that were lost?"
    )
    return [Doubt("dropout", (start + 1) * motion.dt, text)]
