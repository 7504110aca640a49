"""Origin of a record from its header: what is uncertain is left out, and nothing is refused."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence

from rocking_cli.excitation.base import NOT_SAID, Origin
from rocking_cli.patterns import regex
from rocking_cli.text import seen

LONGEST = 100  # characters of a name
LARGEST = 10.0  # magnitude
FARTHEST = 20_040.0  # km, half way round the Earth

_NOTHING = regex(r"(?:unknown|undefined|not (?:known|available)|none|n/?a|-?12345|-?999)\.?", re.IGNORECASE)
_NUMBER = regex(r"[+-]?(?:\d{1,6}\.?\d{0,9}|\.\d{1,9})")
_DATE = regex(r"\d{1,2}/\d{1,2}/\d{2,4}")
# Of PEER before 2003: the earthquake, date and time, the station, the component, with the station's number in brackets.
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
    return Origin(name(event), name(station), _within(magnitude, 0.0, LARGEST), _within(distance, -1.0, FARTHEST))


def name(text: str | None) -> str | None:
    """Return a name in one line, fit for display; None if it has no meaning."""
    found = seen(text or "").strip(" ,;:-*")
    if not re.search(r"[^\W_]", found) or _NOTHING.fullmatch(found):
        return None
    return found[:LONGEST].rstrip()


def of_csmip(head: Sequence[str]) -> Origin:
    """Return the origin from the text header of a CSMIP channel, with the earthquake and its date in one line."""
    number = next((k for k, line in enumerate(head) if _CSMIP_STATION.match(line)), None)
    station = None
    if number is not None:  # its name is in the line below
        below = head[number + 1 : number + 2]
        match = _CSMIP_STATION.match(head[number])
        station = name(below[0]) if below and not _CHANNEL.match(below[0]) else match[1] if match else None
    hypocentre = next((line for line in head if _HYPOCENTRE.match(line)), "")
    return origin(first_match(_CSMIP_EVENT, head), station, magnitude(hypocentre))


def magnitude(line: str) -> str | None:
    """Return the magnitude in a line such as ML=4.9, Mw=4.8(CIT): moment magnitude first; None if there is none."""
    return next((found for kind in _MAGNITUDES if (found := first_match(kind, [line]))), None)


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


def _within(value: object, above: float, most: float) -> float | None:
    """Return a number of a header if it is above `above` and at most `most`; else None."""
    if isinstance(value, str):
        value = float(value) if _NUMBER.fullmatch(value := value.strip()) else None
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
    return number if math.isfinite(number) and above < number <= most else None
