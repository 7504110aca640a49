"""Constant sampling interval from printed times, within the uncertainty of their rounding."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rocking_cli.excitation.base import Doubt

SPARSE = 10  # times as many samples as were recorded, that an even grid may have
_LEAST = 1e-9  # s
_FEWEST, _MOST = 5, 12  # significant digits that programs print numbers with
_FINE = 0.01  # share of times that must be finer than the coarsest one, or they have decimals and no digits in common


class UnevenTimeError(Exception):
    """Error: times have no constant interval.

    Parameters
    ----------
    message : str
        What is wrong with the times.
    hint : str
        Remedy.
    row : int or None
        Index of the first time that is not evenly spaced.
    """

    def __init__(self, message: str, hint: str, row: int | None) -> None:
        super().__init__(message)
        self.message, self.hint, self.row = message, hint, row


def even_interval(time: NDArray[np.float64]) -> float:
    """Return the interval of evenly spaced times.

    Parameters
    ----------
    time : ndarray, shape (npts,)
        The times as printed [s], at least two.

    Returns
    -------
    float
        The interval [s].

    Raises
    ------
    UnevenTimeError
        At the first time that is not evenly spaced.
    """
    steps = np.diff(time)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 1
        what = "is repeated" if steps[row - 1] == 0 else f"comes after {time[row - 1]:g} s"
        hint = "the first column must be the time, increasing; printed times need enough decimals to tell rows apart"
        raise UnevenTimeError(f"time does not increase: {time[row]:g} s {what}", hint, row)

    dt = _as_written(float((time[-1] - time[0]) / (len(time) - 1)))
    if dt < _LEAST:
        hint = "the first column must be the time, in seconds"
        raise UnevenTimeError(f"the times give a sample interval of {dt:g} s", hint, None)
    usual = np.median(steps)

    def odd(rounding: NDArray[np.float64]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        # Rounding moves each time by up to half its last digit: a step, or a time against the ends, by a whole one.
        # The steps find a missing sample where it is; the distances find steps that grow bit by bit.
        of_times = of_steps = np.maximum(0.01 * dt, 1.001 * rounding)
        if of_times.ndim:
            of_steps = np.maximum(of_times[1:], of_times[:-1])
            of_times = np.maximum(of_times, of_times[-1])
        return np.abs(steps - usual) > of_steps, np.abs(time - (time[0] + dt * np.arange(len(time)))) > of_times

    odd_step, out_of_step = odd(_of_decimals(time, dt))
    if (odd_step.any() or out_of_step.any()) and (rounding := _of_digits(time, dt)).any():
        odd_step, out_of_step = odd(rounding)
    if not (odd_step.any() or out_of_step.any()):
        return dt
    if odd_step.any():
        row = int(np.argmax(odd_step)) + 1
        message = f"time is uneven: a step of {steps[row - 1]:.6g} s here, of {usual:.6g} s elsewhere"
    else:
        row = int(np.argmax(out_of_step))
        message = f"time is uneven: {time[row]:.9g} s here, a constant interval would give {time[0] + dt * row:.9g} s"
    hint = (
        f"`resample` puts it on an even grid, such as {usual:.3g}; if only the printed times are rough, keep the "
        "accelerations and give `dt`"
    )
    raise UnevenTimeError(message, hint, row)


def is_even(time: NDArray[np.float64]) -> bool:
    """Return whether a column may be one of even times."""
    try:
        even_interval(time)
    except UnevenTimeError:
        return False
    return True


def increasing(time: NDArray[np.float64]) -> bool:
    """Return whether a column may be one of uneven times."""
    return bool((np.diff(time) > 0).all())


def _as_written(value: float) -> float:
    """Return the number of at most twelve digits that differs from a quotient by rounding only, or the quotient."""
    written = float(f"{value:.12g}")
    return written if abs(written - value) <= 2 * np.spacing(value) else value


def on_grid(time: NDArray[np.float64], values: NDArray[np.float64]) -> tuple[float, NDArray[np.float64], Doubt] | None:
    """Interpolate values from uneven times linearly to even times.

    Parameters
    ----------
    time, values : ndarray, shape (npts,)
        Times [s], and the values at these times.

    Returns
    -------
    (float, ndarray, Doubt) or None
        The usual interval [s], the values at this interval, and how uneven the times are; None if times do not
        increase.

    Raises
    ------
    UnevenTimeError
        If most of the grid would lie in gaps between the samples.
    """
    steps = np.diff(time)
    if not increasing(time):
        return None
    dt = float(f"{np.median(steps):.6g}")  # a clock ticks in a number that people write
    longest = int(steps.argmax())
    count = (time[-1] - time[0]) / dt * (1 + 1e-9)
    if not count < SPARSE * len(time):
        message = f"gap in the record from {time[longest]:g} to {time[longest + 1]:g} s; the step is {dt:g} s elsewhere"
        raise UnevenTimeError(message, "cut the file there: straight lines over such gaps are not data", longest + 1)
    even = time[0] + dt * np.arange(int(count) + 1)
    odd = int((np.abs(steps - dt) > 0.01 * dt).sum())
    text = (
        f"its times are uneven: {odd} of {steps.size} steps are not within 1 % of {dt:g} s, they go from "
        f"{float(steps.min()):.3g} to {float(steps[longest]):.3g} s (at {float(time[longest]):.4g} s); between the "
        f"samples straight lines were taken, at {dt:g} s"
    )
    off = float(np.abs(steps - dt).max())
    return dt, np.interp(even, time, values), Doubt("uneven", off, text)


def _of_decimals(time: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Return the resolution of times [s] with few decimals, less than a tenth of `dt`; 0 if they have more decimals."""
    decimals = math.floor(-math.log10(dt / 10) + 1e-9) + 1
    resolution = 10.0**-decimals
    rounded = (np.abs(time - np.round(time, decimals)) < 1e-6 * resolution).all()
    return np.array(resolution if rounded else 0.0)


def _of_digits(time: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Return the resolution of each time [s] if all have the same number of digits, as printed by %g.

    These times have fewer decimals the larger they are. Their resolution may be up to half of `dt`, as the first times,
    which are finer, determine `dt`.
    """
    size = np.floor(np.log10(np.maximum(np.abs(time), dt / 1000)) + 1e-12)
    for digits in range(_FEWEST, _MOST + 1):
        each = 10.0 ** (size + 1 - digits)
        if _multiples(time, each).all():
            coarsest = each.max()
            if coarsest <= dt / 2 and np.mean(~_multiples(time, coarsest)) > _FINE:
                return np.asarray(each)
            break
    return np.zeros(time.size)


def _multiples(time: NDArray[np.float64], resolution: NDArray[np.float64] | float) -> NDArray[np.bool_]:
    return np.abs(time - resolution * np.round(time / resolution)) < 1e-6 * np.asarray(resolution)
