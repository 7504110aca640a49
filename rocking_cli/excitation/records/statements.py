"""What headers state: rate, points and peaks, of which the record is held to, and its earthquake and station.

Of the earthquake what is uncertain is left out, and nothing is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import NOT_SAID, Doubt, Origin
from rocking_cli.excitation.records.record_units import TIME_UNITS, WORDS, component, is_unit, plain
from rocking_cli.text import cut, regex, seen
from rocking_cli.units import UNITS, header_unit

_INTERVAL_TOLERANCE = 1e-3  # relative difference; more, up to the second number, where few digits are printed
_MAX_ROUNDING = 1e-2
_PEAK_TOLERANCE = 1e-2  # relative difference
_CORRECT = "correct the one that is wrong"
_LONGEST_LINE = 1000  # characters

_N = r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[ed][+-]?\d{1,2}(?!\d))?"
_SIGNS = r"(?:[ :=]|\.(?![0-9]))*"
_BETWEEN = rf" *(?:[\[(]([^\])]{{0,20}})[\])])?{_SIGNS}(?:is|of|in [a-z]+)?{_SIGNS}"


def _words(*items: str) -> str:
    return rf"(?<![a-z])(?:{'|'.join(WORDS[item] for item in items)})(?![a-z])"


_INTERVAL = regex(rf"{_words('interval')}{_BETWEEN}({_N}) *[\[(]?([a-z]*)")
_RATE = regex(rf"{_words('rate')}{_BETWEEN}({_N}) *[\[(]?([a-z]*)")
_RATE_BEFORE = regex(rf"()({_N}) *(sps(?![a-z])|(?:{WORDS['counted']}) ?(?:/ ?s|(?:per|al|por) sec?))")
_COUNT = regex(
    rf"(?:{_words('count')} *(?:\([^)]*\))?{_SIGNS}(?:is )?|{_words('counted')} *[:=] *)"
    r"(\d+(?:,\d{3})*)(?:\.0*)?(?![\d.]| *(?:hz|sps|/))"
)
_COUNT_BEFORE = regex(rf"(?<![\d.,])(\d+) *{_words('counted')}(?= *(?:$|[,;)]|at\b|of (?:data|acc)))")
_COUNT_AND_INTERVAL = regex(rf"^(\d+)[ ,]+({_N})[ ,]+npts *, *dt(?![a-z])")
_PEAK = regex(
    rf"(?<!\b[a-z] ){_words('peak')}[ .]*(?:(?:values?|of|de|di|abs\w*|(?:{WORDS['acceleration']})\w*)[ .]*)*"
    rf"(?:[\[(]([^\])]{{1,20}})[\])])?{_SIGNS}"
)
_NAMED_VALUE = regex(
    rf"[ ,;]*(?:\(?([a-z][\w-]{{0,20}})\)?[ :=]+)?({_N})(?: *~ *({_N}))? *[\[(]?([a-z%][^\s,;\])]*)?[\])]?"
)
_ANOTHER = regex(_words("something else"))
_UNITS_OF_TIME = {item: regex(WORDS[item]) for item in ("seconds", "milliseconds", "hertz")}


class Statement(NamedTuple):
    """A number that a header states: its value in SI units, rounding, line number, text, and the component it is of."""

    value: float
    rounding: float
    line: int
    text: str
    unit: str = ""
    component: str | None = None


class Statements(NamedTuple):
    """Sampling intervals [s], numbers of points, and peaks that the header of a file states in known words."""

    file: str
    intervals: list[Statement]
    counts: list[Statement]
    peaks: list[Statement]

    def interval(self, requested: float | None) -> float | None:
        """Return the sampling interval [s], or the requested one within its digits; None if none is stated.

        Raises `InputError` if the header states several, or another than requested.
        """
        for each in self.intervals:
            statement = f"the header says {each.value:g} s ('{each.text}'), but"
            if requested is not None and not _agree(each, requested):
                message, hint = (
                    f"{statement} {named('dt')} says {requested:g} s",
                    f"leave {named('dt')} out: the file states its own",
                )
                raise InputError(Problem(message, self.file, each.line, hint=hint))
            first = self.intervals[0]
            if not _agree(each, first.value, first.rounding):
                message = f"{statement} {first.value:g} s in line {first.line} ('{first.text}')"
                raise InputError(Problem(message, self.file, each.line, hint=_CORRECT))
        return requested or next((each.value for each in self.intervals), None)

    def check_interval(self, interval: float, last_digit: float) -> None:
        """Raise `InputError` if the times, uncertain by `last_digit` a step, have another interval than stated."""
        for stated in self.intervals:
            if not _agree(stated, interval, last_digit):
                message = f"the header says {stated.value:g} s ('{stated.text}'), but the times {interval:g} s"
                raise InputError(Problem(message, self.file, stated.line, hint=_CORRECT))

    def check_count(self, rows: int, columns: int, *, despite: bool) -> tuple[Doubt, ...]:
        """Return a doubt if the header states other points, a component or in all; raise if not `despite`."""
        wrong = [each for each in self.counts if each.value not in (rows, rows * columns)]
        has = f"the file has {rows} points" + (f" in each of {columns} columns" if columns > 1 else "")
        return self._doubted(wrong, "count", float(rows), has, despite=despite)

    def check_peak(
        self, largest: Sequence[tuple[str, float]], chosen: int, unit: str, *, despite: bool
    ) -> tuple[Doubt, ...]:
        """Return a doubt if the header states another peak of the chosen column; raise if not `despite`.

        `largest` has name and largest absolute value [m/s2] of each column; `unit` is that of the values in the file.
        """
        values, names = [value for _, value in largest], [component(name) for name, _ in largest]
        value, name = largest[chosen][1], names[chosen]
        # A peak without component is that of any column, and a column without a known name has any peak of the others.
        wrong = [each for each in self.peaks if each.component is None and not _is_peak(each, values, unit)]
        wrong += [
            each for each in self.peaks if each.component == name is not None and not _is_peak(each, [value], unit)
        ]
        others = [each for each in self.peaks if each.component is not None and each.component not in names]
        if name is None and others and not any(_is_peak(each, [value], unit) for each in others):
            wrong += others
        has = f"the largest of its values is {value / UNITS[unit]:g} {unit}"
        return self._doubted(wrong, "header_peak", value / UNITS[unit], has, despite=despite)

    def _doubted(
        self, wrong: Sequence[Statement], kind: str, value: float, has: str, *, despite: bool
    ) -> tuple[Doubt, ...]:
        """Return a doubt about the first of some statements, if any; raise `InputError` instead if not `despite`."""
        for each in wrong[:1]:
            if not despite:
                message = f"the header says '{each.text}', but {has}"
                hint = f"{_CORRECT}; {named('despite_header')} takes a file that was cut on purpose"
                raise InputError(Problem(message, self.file, each.line, hint=hint))
            return (Doubt(kind, value, f"line {each.line} of its header says '{each.text}', but {has}"),)
        return ()


def statements(file: str, header: Sequence[tuple[int, str]]) -> Statements:
    """Return what the lines of a header, each with its number, state in known words."""
    stated = Statements(file, [], [], [])
    for number, line in header:
        text, line = plain(line[:_LONGEST_LINE]), cut(line.strip())
        if old := _COUNT_AND_INTERVAL.search(text):
            stated.counts.append(Statement(float(old[1]), 0.0, number, line))
            stated.intervals.extend(_interval(number, line, "s", old[2], "", is_rate=False))
            continue
        for pattern, is_rate in ((_INTERVAL, False), (_RATE, True), (_RATE_BEFORE, True)):
            for match in pattern.finditer(text):
                stated.intervals.extend(_interval(number, line, *match.groups(), is_rate=is_rate))
        if _ANOTHER.search(text):
            continue
        for match in (*_COUNT.finditer(text), *_COUNT_BEFORE.finditer(text)):
            stated.counts.append(Statement(float(match[1].replace(",", "")), 0.0, number, line))
        for match in _PEAK.finditer(text):
            stated.peaks.extend(_peaks(number, line, text, match.end(), match[1]))
    return stated


def _interval(
    number: int, line: str, before: str | None, printed: str, after: str, *, is_rate: bool
) -> Iterator[Statement]:
    """Yield the interval that a rate or an interval states, with a unit before or after it, if its unit is clear."""
    value, rounding = _number(printed)
    words = [word.strip() for word in (before, after) if word]
    unit = next((item for word in words for item, each in _UNITS_OF_TIME.items() if each.fullmatch(word)), "")
    unclear = any(word.endswith("hz") or word in TIME_UNITS for word in words)
    if not unit and not unclear:  # a rate below 1 is in s, and an interval of 1 may be in ms
        unit = "hertz" if is_rate and value >= 1 else "seconds" if value < 1 else ""
    if unit and 0 < value < math.inf:
        interval = 1 / value if unit == "hertz" else value * (1.0 if unit == "seconds" else 1e-3)
        yield Statement(interval, min(rounding / value, _MAX_ROUNDING) * interval, number, line)


def _peaks(number: int, line: str, text: str, start: int, unit: str | None) -> list[Statement]:
    """Return the peaks that stand in a line from a place on, with their components if these are named."""
    peaks = []
    while match := _NAMED_VALUE.match(text, start):
        name, first, last, after = match.groups()
        of = None if name is None else component(name)
        if name is not None and of is None:
            break
        if after and component(after) is not None:  # the next component, if not a unit
            start, after = match.start(4), None
        else:
            start = match.end()
        spelled = unit or after or ""
        if header_unit(spelled) is None and (is_unit(spelled) or (after and after not in ("at", "a"))):
            break
        values = [_number(each) for each in (first, last) if each]
        value, rounding = max(values, key=lambda each: abs(each[0]))
        peaks.append(Statement(abs(value), rounding, number, line, header_unit(spelled) or "", of))
    return peaks


def _number(printed: str) -> tuple[float, float]:
    """Return a number of a header, with a decimal comma or a point, and the size of its last digit."""
    mantissa, _, power = printed.replace(",", ".").replace("d", "e").partition("e")
    scale = 10.0 ** int(power or 0)
    return float(mantissa) * scale, scale * 10.0 ** -len(mantissa.partition(".")[2])


def _agree(stated: Statement, interval: float, rounding: float = 0.0) -> bool:
    tolerance = max(_INTERVAL_TOLERANCE * interval, 0.5 * stated.rounding)
    return abs(stated.value - interval) <= 1.000001 * tolerance + rounding


def _is_peak(stated: Statement, largest: Sequence[float], unit: str) -> bool:
    """Return whether one of the largest values [m/s2] is a stated peak, which may be in g if its unit is not stated."""
    sizes = [UNITS[each] for each in ([stated.unit] if stated.unit else [unit, "g"])]
    return any(
        abs(stated.value * size - each) <= max(_PEAK_TOLERANCE * each, 1.000001 * stated.rounding * size)
        for each in largest
        for size in sizes
    )


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
_PRINTED_PEAK_TOLERANCE = 1e-4  # relative difference; some headers print the peak with more digits than the values have


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
    tolerance = stated[1] + _PRINTED_PEAK_TOLERANCE * largest
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
