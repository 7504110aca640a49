"""Units of accelerations: their spellings and sizes, and where a header states them. A unit is never guessed."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.patterns import regex
from rocking_cli.units import UnitError, number_of, split

UNITS: dict[str, float] = {
    "g": STANDARD_GRAVITY,
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "mm/s2": 0.001,
    "gal": 0.01,
    "mg": STANDARD_GRAVITY / 1000,
    "%g": STANDARD_GRAVITY / 100,
}
"""Size of each unit that can be read [m/s2], under its canonical name."""

CHOICES = ", ".join(UNITS)

_S = r"s(?:ec)?"
_PER_S2 = rf"(?: ?/ ?{_S} ?(?:\^|\*\*)? ?2| ?/ ?{_S} ?/ ?{_S}|[ .·*]?{_S} ?(?:\^|\*\*)? ?-2|[ p]?s2)"
# A unit ends where its word ends, and is not the first part of something else: g/10, cm/s of cm/s2, g = 9.81.
_END = r"(?! ?[/^*=]|\w)"
_OF_G = r"milli-? ?g|mg|(?:%|percent|pct) ?g"
_SPELLED = rf"(?:(?:mm|cm|m){_PER_S2}|gal|{_OF_G}){_END}"  # says what it is by itself; a bare "g" does not
_UNIT = rf"(?:{_SPELLED}|g{_END})"
_SPEED = rf"(?:mm|cm|m|km|in|ft)(?: ?/ ?(?:{_S}|h)| s-1){_END}"
_LENGTH = rf"(?:mm|cm|m|km|inch(?:es)?|ft|feet){_END}"
_FOREIGN = rf"(?:(?:km|in|ft){_PER_S2}|counts?){_END}"

_ACCELERATION = r"\bacc(?:l|n|el|eln|els|eleration|elerations)?(?![a-z])\.?"
_MOTION = regex(r"\b(?:vel|velocity|velocities|disp|displ|displacements?)\b")
_GAP = r"[ ,:;=-]*(?:in |of )?"
_UNITS_OF = r"\bunits?[ :=]*(?:of |are |is |in )?[ :=]*"

_BRACKETED = regex(rf"[\[(]\s*({_UNIT})\s*[\])](?! ?/)")
_NAMED = [
    regex(pattern)
    for pattern in (
        rf"{_ACCELERATION}{_GAP}({_UNIT})",  # accel_g, acceleration, m/s2
        rf"{_ACCELERATION}.*\bin ({_UNIT})",  # acceleration time series in g
        rf"{_UNITS_OF}({_UNIT})",  # units of g, units: cm/s2
        rf"\bin ({_SPELLED})",
        rf"\ba ?g?[ ,:;=-]*({_SPELLED})",  # a_m/s2; but a_g is the ground acceleration, in any unit
        rf"^(?:s|secs?|seconds?)[ ,;\t]+({_UNIT})$",  # a row of units: s,g
        rf"^({_SPELLED})$",
    )
]
# A line about one value, such as the peak, which may well be in another unit than the record.
_ABOUT_A_VALUE = regex(r"\b(?:pg[avd]|peak|max\w*|min|minimum|rms|arias|scaled?|factor|gravity)\b")
_NOT_USABLE = regex(rf"(?:{_UNITS_OF}|{_ACCELERATION}{_GAP})[\[(]?({_SPEED}|{_FOREIGN})|{_UNITS_OF}({_LENGTH})")
# What stands where a unit should: after the word, or in brackets in the label of a column that is not the time.
_SAID = regex(
    r"\bunits? *(?:[:=]|of |are |is |in )[ :=]*[\[(]?(?!(?:acc\w*|the|time)\b)([^\s,;\])]{1,20})", re.IGNORECASE
)
_SAID_LABEL = regex(r"[\[(] *(?!(?:m?s|secs?|seconds?|-*) *[\])])([^\])\s]{1,20}) *[\])](?! ?[/^*])", re.IGNORECASE)
_NOT_USABLE_LABEL = regex(rf"[\[(]\s*({_SPEED}|{_LENGTH}|{_FOREIGN})\s*[\])]")


def canonical(spelling: str) -> str | None:
    """Return the canonical name of a unit of acceleration, ``"m/s2"`` for ``"M/SEC**2"``; None if it is not one."""
    word = _normal(spelling)
    if not re.fullmatch(_UNIT, word):
        return None
    if word in ("g", "gal"):
        return word
    if re.fullmatch(_OF_G, word):
        return "mg" if word.startswith("m") else "%g"
    return word[: word.index("s")].rstrip(" ./·*p") + "/s2"


def in_g(given: object) -> float:
    """Return an acceleration in standard gravity, from a number or a text with a unit in any spelling of headers.

    Raises `UnitError`.
    """
    parts = split(given) if isinstance(given, str) else None
    if parts is None or not parts[1]:
        return number_of(given, "g")
    unit = canonical(parts[1])
    if unit is None:
        raise UnitError(f"{parts[1]!r} is not a unit of acceleration", f"give one of {CHOICES}")
    return float(parts[0]) if unit == "g" else float(parts[0]) * UNITS[unit] / STANDARD_GRAVITY


def is_unit(word: str) -> bool:
    """Return whether a word is the unit of a time, a length, a speed or an acceleration, and nothing else."""
    return re.fullmatch(rf"m?s|secs?|seconds?|{_UNIT}|{_SPEED}|{_LENGTH}|{_FOREIGN}", _normal(word)) is not None


def header_units(line: str) -> set[str]:
    """Return the canonical units that a header line states for the accelerations; units in brackets come first."""
    line = _normal(line)
    if _ABOUT_A_VALUE.search(line):
        return set()
    found = _BRACKETED.findall(line) or [match for pattern in _NAMED for match in pattern.findall(line)]
    return {unit for spelling in found if (unit := canonical(spelling))}


def resolve_unit(file: str, header: Sequence[tuple[int, str]], units: str | None) -> str:
    """Return the unit of the accelerations in a file, from its header or as given by the user.

    Parameters
    ----------
    file : str
        The file, for the messages.
    header : sequence of (int, str)
        Line number and text of every header line; the column labels, if there are any, come last.
    units : str, optional
        The unit the user gave.

    Returns
    -------
    str
        One of `UNITS`.

    Raises
    ------
    InputError
        If neither header nor user gives a unit, the two differ, the header has several, or is not about acceleration.
    """
    given = None if units is None else canonical(units)
    if units is not None and given is None:
        raise InputError(Problem(f"unknown unit '{units}'", field="`units`", hint=f"choose one of: {CHOICES}"))
    stated = {unit: number for number, line in reversed(header) for unit in sorted(header_units(line))}
    _refuse_other_quantities(file, header)
    if given and stated and not any(_same(given, unit) for unit in stated):
        unit, number = next(iter(stated.items()))
        message = f"the header says the unit is {unit}, but `units` says {given}"
        raise InputError(Problem(message, file=file, line=number, hint="leave `units` out, or correct the header"))
    if given:
        return next((unit for unit in stated if _same(given, unit)), given)
    if not stated:
        raise InputError(_not_said(file, header))
    if not all(_same(unit, other) for unit in stated for other in stated):
        message = f"the header names more than one unit: {', '.join(stated)}"
        hint = f"say which one holds for the accelerations with `units`: {CHOICES}"
        raise InputError(Problem(message, file=file, line=max(stated.values()), hint=hint))
    return next(iter(stated))


def _not_said(file: str, header: Sequence[tuple[int, str]]) -> Problem:
    """Return the problem of a header without a unit, or with one that is not in `UNITS`."""
    hint = f"say which it is with `units`: {CHOICES}"
    for index, (number, line) in enumerate(header):
        if _ABOUT_A_VALUE.search(_normal(line)):
            continue
        match = _SAID.search(line) or (_SAID_LABEL.search(line) if index == len(header) - 1 else None)
        if match and canonical(match[1]) is None:
            message = f"the header says '{match[1]}', which is not a known unit of acceleration"
            return Problem(message, file=file, line=number, hint=hint)
    return Problem("the file does not say what unit its accelerations are in", file=file, hint=hint)


def _refuse_other_quantities(file: str, header: Sequence[tuple[int, str]]) -> None:
    """Raise `InputError` if a header states a velocity or displacement, or a unit that cannot be read."""
    about_acceleration = any(header_units(line) or re.search(_ACCELERATION, _normal(line)) for _, line in header)
    for index, (number, line) in enumerate(header):
        label = index == len(header) - 1
        what = other_quantity(line, label=label)
        # Only the labels are about the columns for sure: elsewhere "peak velocity" is just information.
        if what and (label or not about_acceleration):
            hint = f"give the ground acceleration, in one of: {CHOICES}"
            raise InputError(Problem(what, file=file, line=number, excerpt=line.strip()[:100], hint=hint))


def other_quantity(line: str, *, label: bool = True) -> str | None:
    """Return why a header line contradicts accelerations in a usable unit, a sentence; None if it does not.

    Parameters
    ----------
    line : str
        The line, or the label of one column.
    label : bool, optional
        Whether the line certainly labels columns, so that a unit in brackets is that of the values.

    Returns
    -------
    str or None
        What is wrong with the line, as a sentence.
    """
    if header_units(line):
        return None
    line = _normal(line)
    match = _NOT_USABLE.search(line) or (_NOT_USABLE_LABEL.search(line) if label else None)
    if match:
        unit = match[match.lastindex or 0]
        if re.fullmatch(_FOREIGN, unit):
            return f"accelerations in '{unit}' cannot be read"
        return f"the header gives the unit '{unit}': a velocity or displacement, not an acceleration"
    if _MOTION.search(line) and not re.search(_ACCELERATION, line):
        return "the header speaks of velocity or displacement, not acceleration"
    return None


def _same(unit: str, other: str) -> bool:
    """Return whether two units have the same size, as cm/s2 and gal do."""
    return math.isclose(UNITS[unit], UNITS[other])


def _normal(line: str) -> str:
    """Return a line in lower case, with one spelling of powers and minus signs, and spaces for underscores."""
    for old, new in (("_", " "), ("²", "2"), ("⁻", "-"), ("\N{MINUS SIGN}", "-"), ('"', " "), ("'s", "")):
        line = line.lower().replace(old, new)
    return line.strip()
