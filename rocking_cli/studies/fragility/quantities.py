"""Limit states on the horizontal displacement of the top of a structure, such as `25 mm`.

Whether a run exceeds one follows from two rotations of its sample, one in each direction, at which the top has this
displacement. A study computes them, and its store keeps them, so that its runs can be counted without the structures.
The intensity measures of a study are those of `processing.intensity` by name, and the factor on the records.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.units import UnitError, kind_of, read, split

ROTATIONS_FACT = "displacements"  # name under which a store keeps the rotations
LIMIT_UNIT = "mm"
LIMIT_DIGITS = 10


def displacement_in_mm(text: str) -> str:
    """Return a displacement in mm, as limit states are spelt: `25 mm` for `2.5 cm`.

    Raises
    ------
    ValueError
        If the text is not a positive length.
    """
    try:
        value = read(text, LIMIT_UNIT)
    except UnitError as error:
        raise ValueError(str(error)) from None
    if not 0 < value < float("inf"):
        raise ValueError(f"a displacement must be positive, got {text!r}")
    return f"{value:.{LIMIT_DIGITS}g} {LIMIT_UNIT}"


def is_quantity(value: object) -> bool:
    """Return whether a value is a text with a number and a unit, so that a displacement may be meant."""
    parts = split(value) if isinstance(value, str) else None
    return parts is not None and bool(parts[1])


def metres(limit: str | float) -> float | None:
    """Return the displacement of the top at a limit state [m]; None if the limit state is not a displacement."""
    if not isinstance(limit, str) or not is_quantity(limit) or kind_of(limit.split()[-1]) != "length":
        return None
    return read(limit, "m")


def displacement_limits(limits: Sequence[str | float]) -> list[str]:
    """Return those limit states that are displacements."""
    return [limit for limit in limits if isinstance(limit, str) and metres(limit) is not None]


def kept(facts: Mapping[str, Any], limits: Sequence[str | float]) -> dict[str, Reals]:
    """Return the rotations of every sample [rad] that a store keeps for displacements among limit states.

    Parameters
    ----------
    facts : mapping
        The facts of the open store.
    limits : sequence of limit states
        The requested limit states; a store keeps rotations only for displacements that its study requests.

    Returns
    -------
    dict of str to ndarray, shape (samples, 2)
        Positive and negative rotation of each sample, by limit state; infinite if the top never moves that far.
    """
    requested = displacement_limits(limits)
    stored = facts[ROTATIONS_FACT] if requested else {}

    def table(pairs: Sequence[Sequence[float | None]]) -> Reals:
        return np.array([[np.inf if phi is None else phi for phi in pair] for pair in pairs], dtype=np.float64)

    return {limit: table(stored[limit]) for limit in requested}


PGA, PGV = "PGA", "PGV"
SCALE = "scale"
"""Name of the measure of levels that are plain factors on the records."""
USUAL_MEASURES = (PGA, PGV, "PGA/(g lambda)", "p PGV/(g lambda)")
"""Measures that every table of runs has, because every store has the values that they need."""


def standard_measure(text: str) -> str:
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
