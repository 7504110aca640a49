"""Origin of a record from its header: what is uncertain is left out, and nothing is refused.

The values of a record are checked against the peak and the duration that the header states.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.excitation.base import NOT_SAID, Doubt, Origin
from rocking_cli.text import regex, seen

MAX_NAME_CHARACTERS = 100
MAX_MAGNITUDE = 10.0
MAX_DISTANCE = 20_040.0  # km; half the circumference of the Earth

_NOTHING = regex(r"(?:unknown|undefined|not (?:known|available)|none|n/?a|-?12345|-?999)\.?", re.IGNORECASE)
_NUMBER = regex(r"[+-]?(?:\d{1,6}\.?\d{0,9}|\.\d{1,9})")
_DATE = regex(r"\d{1,2}/\d{1,2}/\d{2,4}")
# PEER before 2003: earthquake, date, time, station and component, with the number of the station in brackets.
_OLD_PEER = regex(r"(\S.*?\s\d{1,2}/\d{1,2}/\d{2}(?:,? +\d{4}| +\d{2}:\d{2})?), *(\S[^,]*?) *,[^,]*")
_CSMIP_EVENT = regex(r"^\s*(\S.*\bEARTHQUAKE\b.*\b(?:19|20)\d\d\b.*)", re.IGNORECASE)
_CSMIP_STATION = regex(r"STATION NO\. *(\d+)", re.IGNORECASE)
_CHANNEL = regex(r"\s*CHAN(?:NEL)? +\d+:", re.IGNORECASE)
_HYPOCENTRE = regex(r"HYPOCENTER", re.IGNORECASE)
_MAGNITUDES = tuple(regex(rf"\b{kind} *= *(\d+\.?\d*)", re.IGNORECASE) for kind in ("Mw", "ML", "Ms"))
_INFO = regex(r"PEER\b.{0,60}?\bDATABASE RECORD\W+(.{1,200}?),[^,]{0,20}\bACCELERATION TIME", re.IGNORECASE)


def origin(event: str | None, station: str | None, magnitude: object = None, distance: object = None) -> Origin:
    """Return the origin from the items of a header, without the items that are not plausible.

    Parameters
    ----------
    event, station : str or None
        Names as in the header; control characters are removed.
    magnitude, distance : object, optional
        Numbers, or their text in the header; the distance in km.
    """
    return Origin(
        name(event), name(station), _within(magnitude, 0.0, MAX_MAGNITUDE), _within(distance, -1.0, MAX_DISTANCE)
    )


def name(text: str | None) -> str | None:
    """Return a name in one line, fit for display; None if it has no meaning."""
    cleaned = seen(text or "").strip(" ,;:-*")
    if not re.search(r"[^\W_]", cleaned) or _NOTHING.fullmatch(cleaned):
        return None
    return cleaned[:MAX_NAME_CHARACTERS].rstrip()


def of_csmip(head: Sequence[str]) -> Origin:
    """Return the origin from the text header of a CSMIP channel, with the earthquake and its date in one line."""
    number = next((k for k, line in enumerate(head) if _CSMIP_STATION.match(line)), None)
    station = None
    if number is not None:  # the next line has the name
        below = head[number + 1 : number + 2]
        match = _CSMIP_STATION.match(head[number])
        station = name(below[0]) if below and not _CHANNEL.match(below[0]) else match[1] if match else None
    hypocentre = next((line for line in head if _HYPOCENTRE.match(line)), "")
    return origin(first_match(_CSMIP_EVENT, head), station, magnitude(hypocentre))


def magnitude(line: str) -> str | None:
    """Return the magnitude in a line such as ML=4.9, Mw=4.8(CIT): moment magnitude first; None if there is none."""
    return next((size for kind in _MAGNITUDES if (size := first_match(kind, [line]))), None)


def first_match(pattern: re.Pattern[str], lines: Iterable[str]) -> str | None:
    """Return the first group of a pattern in the first line that matches; None if no line does."""
    return next((match[1] for line in lines if (match := pattern.search(line[:1000]))), None)


def of_peer(line: str) -> Origin:
    """Return the origin from the second line of a PEER file: earthquake, date, station, component."""
    parts = [part.strip() for part in line[:1000].split(",")]
    if len(parts) >= 4 and _DATE.fullmatch(parts[1]):
        return origin(parts[0], ", ".join(parts[2:-1]))
    if old := _OLD_PEER.fullmatch(line[:1000].strip()):
        return origin(old[1], old[2])
    return NOT_SAID


def of_info(text: str) -> Origin:
    """Return the origin from the title of a PEER file, without its component, as another file quotes it."""
    match = _INFO.search(text[:2000])
    return of_peer(f"{match[1]}, component") if match else NOT_SAID


def _within(value: object, above: float, upper: float) -> float | None:
    """Return a number of a header if it is above `above` and at most `upper`; else None."""
    if isinstance(value, str):
        value = float(value) if _NUMBER.fullmatch(value := value.strip()) else None
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
    return number if math.isfinite(number) and above < number <= upper else None


_DIGITS = regex(r"[+-]?(?:\d+\.?(\d*)|\.(\d+))(?:[EeDd]([+-]?\d{1,3}))?")
_PEAK_TOLERANCE = 1e-4  # relative difference; some headers print the peak with more digits than the values have


def peak_doubts(
    values: Reals, dt: float, unit: str, line: int, peak: str, time: str | None = None
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
    stated, largest = _value(peak), float(np.abs(values).max())
    if stated is None:
        return ()
    tolerance = stated[1] + _PEAK_TOLERANCE * largest
    if not abs(abs(stated[0]) - largest) <= tolerance:
        text = (
            f"line {line} of its header states a peak of {abs(stated[0]):g} {unit}, the largest of its values is "
            f"{largest:g}: a damaged number, or processed since?"
        )
        return (Doubt("header_peak", largest, text),)
    when = _value(time) if time is not None else None
    if when is None:
        return ()
    times = dt * np.flatnonzero(np.abs(values) >= largest - tolerance)
    if float(np.abs(times - when[0]).min()) <= when[1] + 1.01 * dt:  # some headers count time from 0, others from dt
        return ()
    text = (
        f"line {line} of its header states the peak at {when[0]:g} s, but it is at {times[0]:g} s: "
        f"are values missing, or is the interval of {dt:g} s wrong?"
    )
    return (Doubt("header_time", float(times[0]), text),)


def length_doubts(duration: float, line: int, length: str, tolerance: float) -> tuple[Doubt, ...]:
    """Return a doubt if the duration differs from that in the header [s] by more than `tolerance` [s] and rounding."""
    stated = _value(length)
    if stated is None or abs(stated[0] - duration) <= stated[1] + tolerance:
        return ()
    text = f"line {line} of its header states a length of {stated[0]:g} s, its samples make {duration:g} s"
    return (Doubt("header_length", duration, text),)


def _value(printed: str) -> tuple[float, float] | None:
    """Return a printed number and the size of its last digit; None if it is not a number."""
    match = _DIGITS.fullmatch(printed.strip())
    if match is None:
        return None
    power = int(match[3] or 0)
    value = float(match[0].upper().replace("D", "E"))
    return value, 10.0 ** (power - len(match[1] or match[2] or ""))
