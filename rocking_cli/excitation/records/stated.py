"""Checks of the values of a record against their peak, its time and their duration as stated in the header."""

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
    """Return a doubt if the largest value, or its time, differs from that stated in the header.

    Parameters
    ----------
    values : ndarray, shape (npts,)
        Values as in the file.
    dt : float
        Sampling interval [s].
    unit : str
        Unit of the values.
    line : int
        Line number of the header.
    peak, time : str
        Peak, with any sign, and its time [s] as printed in the header, whose last digit may be rounded.

    Returns
    -------
    tuple of Doubt
        The doubts; empty if values and header agree, or the header does not have numbers.
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
    """Return a doubt if the duration differs from that in the header [s] by more than `tolerance` [s] and rounding."""
    stated = _value(length)
    if stated is None or abs(stated[0] - found) <= stated[1] + tolerance:
        return ()
    text = f"line {line} of its header states a length of {stated[0]:g} s, its samples make {found:g} s"
    return (Doubt("header_length", found, text),)


def _value(printed: str) -> tuple[float, float] | None:
    """Return a printed number and the size of its last digit; None if it is not a number."""
    match = _NUMBER.fullmatch(printed.strip())
    if match is None:
        return None
    power = int(match[3] or 0)
    value = float(match[0].upper().replace("D", "E"))
    return value, 10.0 ** (power - len(match[1] or match[2] or ""))
