"""What the header of a text states about its record (rate, points, peaks), and whether the record agrees."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import Doubt
from rocking_cli.excitation.records.header_words import WORDS, component, plain
from rocking_cli.excitation.records.record_units import TIME_UNITS, is_unit
from rocking_cli.text import cut, regex
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
