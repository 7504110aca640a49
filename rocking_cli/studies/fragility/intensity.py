"""The intensity measures of a study, by name: those of `processing.intensity`, and the factor on the records."""

from __future__ import annotations

from rocking_cli.processing.intensity import parse_measure

PGA, PGV = "PGA", "PGV"
SCALE = "scale"
"""What levels are of that are plain factors on the records."""
ALWAYS = (PGA, PGV, "PGA/(g lambda)", "p PGV/(g lambda)")
"""Measures that every table of runs has, whatever is requested: every store knows what they are of."""


def spelled(text: str) -> str:
    """Return the standard spelling of a measure given in any case and spacing. Raises `InputError` if unknown."""
    return str(parse_measure(text))


def no_levels(measure: str) -> str | None:
    """Return a message why levels cannot be defined by a measure; None if they can."""
    power = parse_measure(measure).power
    if power is None:
        return f"{measure} is computed of every run, in no power of the factor on the record: levels cannot be of it"
    return f"{measure} is the same however a record is scaled: levels cannot be of it" if power == 0 else None


def of_the_motion(measure: str) -> bool:
    """Return whether a measure, or the factor on the records, depends on the motion alone and not on the structure."""
    return measure == SCALE or not parse_measure(measure).is_relative


def proportional(one: str, other: str) -> bool:
    """Return whether two measures of one structure are proportional under all motions, because they have one base."""
    if SCALE in (one, other):
        return False
    base = parse_measure(one).base
    return base is not None and base == parse_measure(other).base


def label(measure: str) -> str:
    """Return the name of a measure with its unit, for a heading."""
    return parse_measure(measure).label
