"""Checks of what a header states of its values - their peak, its time, their duration - against the values."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rocking_cli.excitation.base import Doubt
from rocking_cli.patterns import regex

_NUMBER = regex(r"[+-]?(?:\d+\.?(\d*)|\.(\d+))(?:[EeDd]([+-]?\d{1,3}))?")
_PRINTED = 1e-4  # of a value: some print the peak with more digits in the header than among the values


def peak_doubts(
    values: NDArray[np.float64], dt: float, unit: str, line: int, peak: str, time: str | None = None
) -> tuple[Doubt, ...]:
    """Whether the largest value is the one that the header states, and where it states it.

    Parameters
    ----------
    values : ndarray, shape (npts,)
        As in the file.
    dt : float
        Interval between them [s].
    unit : str
        What they are in.
    line : int
        Line number of the header.
    peak, time : str
        Peak, of either sign, and its time [s] as the header prints them: their last digit may be rounded.

    Returns
    -------
    tuple of Doubt
        Empty if they agree, or the header does not print numbers.
    """
    stated, found = _value(peak), float(np.abs(values).max())
    if stated is None:
        return ()
    tolerance = stated[1] + _PRINTED * found
    if not abs(abs(stated[0]) - found) <= tolerance:
        text = (
            f"line {line} of its header states a peak of {abs(stated[0]):g} {unit}, the largest of its values is "
            f"{found:g}: a damaged number, or processed since?"
        )
        return (Doubt("header_peak", found, text),)
    when = _value(time) if time is not None else None
    if when is None:
        return ()
    times = dt * np.flatnonzero(np.abs(values) >= found - tolerance)
    if float(np.abs(times - when[0]).min()) <= when[1] + 1.01 * dt:  # some count from 0, some from dt
        return ()
    text = (
        f"line {line} of its header states the peak at {when[0]:g} s, but it is at {times[0]:g} s: "
        f"are values missing, or is the interval of {dt:g} s wrong?"
    )
    return (Doubt("header_time", float(times[0]), text),)


def length_doubts(found: float, line: int, length: str, tolerance: float) -> tuple[Doubt, ...]:
    """Whether a record is as long as its header states, in seconds, to a tolerance [s] and the last digit printed."""
    stated = _value(length)
    if stated is None or abs(stated[0] - found) <= stated[1] + tolerance:
        return ()
    text = f"line {line} of its header states a length of {stated[0]:g} s, its samples make {found:g} s"
    return (Doubt("header_length", found, text),)


def _value(printed: str) -> tuple[float, float] | None:
    """A printed number and the size of its last digit; None if it is not one."""
    match = _NUMBER.fullmatch(printed.strip())
    if match is None:
        return None
    power = int(match[3] or 0)
    value = float(match[0].upper().replace("D", "E"))
    return value, 10.0 ** (power - len(match[1] or match[2] or ""))
