"""Types of options: numbers, quantities and ranges of them, by one grammar for all commands.

A quantity is a number with its unit. If the help names the unit of a bare number, the unit may be left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import inf, isfinite
from typing import Any

import click

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError
from rocking_cli.processing.reading_options import UNITS
from rocking_cli.units import UnitError, read, split


class Parsed(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Value that a function makes of what was typed.

    Parameters
    ----------
    name : str
        Name of the value, for the help.
    parse : callable
        The function; it raises `InputError`, or `ValueError` with a sentence without its full stop.
    """

    def __init__(self, name: str, parse: Callable[[str], Any]) -> None:
        self.name, self._parse = name, parse

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the value of a text, or fail naming the option; a value that is not a text is a default."""
        if not isinstance(value, str):
            return value
        try:
            with terminal.plugins_apart():
                return self._parse(value)
        except InputError as error:
            (problem,) = error.problems
            text = f"{problem.message}{f': {problem.hint}' if problem.hint else ''}"
            self.fail(text if text.endswith("?") else f"{text}.", param, ctx)
        except ValueError as error:
            self.fail(f"{error}.", param, ctx)


@dataclass(frozen=True)
class QuantityKind:
    """Kind of a quantity, with its unit and bounds.

    Parameters
    ----------
    name : str
        Name in messages.
    unit : str
        Unit of the returned number; empty for a pure number.
    example, ranged : str
        A quantity, and a range, as typed.
    least, most : float
        Bounds of what can be simulated: beyond them a simulation would take hours, or is impossible.
    zero : bool
        Whether the quantity may be zero.
    """

    name: str
    unit: str
    example: str
    ranged: str = ""
    least: float = 0.0
    most: float = inf
    zero: bool = False


PULSE_AMPLITUDE = QuantityKind("acceleration", "g", "0.6g", "0.1g:2g", 1e-9, 1e6)
PERIOD = QuantityKind("period", "s", "0.8s", "0.2s:4s", 1e-6, 1e6)
RATIO = QuantityKind("number", "", "4", "0.5:10", 1e-6, 1e6)
INTERVAL = QuantityKind("time", "s", "0.01s")
TAIL = QuantityKind("time", "s", "10s", most=3600, zero=True)


def number(text: str) -> float:
    """Return a finite number."""
    try:
        value = float(text)
    except ValueError:
        raise ValueError(f"{text!r} is not a number") from None
    if not isfinite(value):
        raise ValueError(f"{text} is not a finite number")
    return value


def positive(text: str) -> float:
    """Return a finite number above zero."""
    if (value := number(text)) <= 0:
        raise ValueError(f"{text} is not a positive number")
    return value


def share(text: str) -> float:
    """Return a fraction: a number, or a percentage with its sign."""
    plain = text.strip()
    try:
        value = float(plain.removesuffix("%")) / (100 if plain.endswith("%") else 1)
    except ValueError:
        raise ValueError(f"{text!r} is not a fraction: give a number such as 0.02 or 2%") from None
    if not isfinite(value):
        raise ValueError(f"{text} is not a finite number")
    return value


def fraction(text: str) -> float:
    """Return a number from 0 to below 1."""
    if not 0 <= (value := share(text)) < 1:
        raise ValueError(f"{value:g} is out of range: give a number from 0 up to, but not including, 1")
    return value


def angle(text: str, unit: str) -> float:
    """Return the number of an angle, which is in this unit if the text gives none. Raises `UnitError`."""
    parts = split(text)
    return float(text) if parts is not None and not parts[1] else read(text, unit)


def tilt(text: str) -> Any:
    """Return the `Release` of a text: a fraction of the critical rotation, or an angle with its unit; not zero."""
    from rocking_cli.studies.release import Release

    return Release.of(text)


NUMBER, POSITIVE, SHARE = Parsed("number", number), Parsed("number", positive), Parsed("share", share)
FRACTION, TILT = Parsed("share", fraction), Parsed("tilt", tilt)


def quantity(kind: QuantityKind, text: str, example: str = "") -> float:
    """Return the number of a quantity above zero, in the unit of its kind; the error has a valid example."""
    example = example or kind.example
    try:
        value = _number(kind, text)
    except UnitError as error:
        hint = error.hint or ""
        remedy = f"{hint} Give a value" if hint.endswith("?") else f"{hint}," if hint else "give a value"
        raise ValueError(f"{error.message}: {remedy} such as {example}") from None
    if not (0 < value < inf or (kind.zero and value == 0)):
        turn = "; --polarity -1 reverses the pulse" if kind is PULSE_AMPLITUDE and value < 0 else ""
        raise ValueError(f"{text!r} is not positive: give a value such as {example}{turn}")
    if not kind.least <= value <= kind.most:
        bounds = f"{kind.least:g} to {kind.most:g} {kind.unit}".strip()
        raise ValueError(f"{text!r} is outside the supported range: {bounds}")
    return value


def _number(kind: QuantityKind, text: str) -> float:
    parts = split(text)
    if parts is None:
        raise UnitError(f"{text!r} is not a valid {kind.name}")
    number, unit = parts
    if not unit:
        if kind is PULSE_AMPLITUDE:  # a bare 6 may mean g or m/s2
            raise UnitError(f"{text!r} has no unit", f"give one of {', '.join(UNITS)}")
        return float(number)
    if kind.unit == "g":
        from rocking_cli.excitation.records.record_units import in_g

        return in_g(text)
    if kind.name == "period" and unit.lower() == "hz":
        return 1 / float(number) if float(number) else 0.0
    return read(text, kind.unit)


def span(kind: QuantityKind, text: str) -> tuple[float, float]:
    """Return two quantities, the smaller first, separated by a colon; the error has a valid example."""
    words = text.split(":")
    if len(words) != 2:
        raise ValueError(f"{text!r} is not a range: give the smallest and the largest value, such as {kind.ranged}")
    low, high = (quantity(kind, word, kind.ranged) for word in words)
    if not low < high:
        raise ValueError(f"{text!r} is not increasing: give the smaller value first, such as {kind.ranged}")
    return low, high


def quantity_of(kind: QuantityKind) -> Parsed:
    """Return the type of a quantity above zero."""
    return Parsed("quantity", partial(quantity, kind))


def range_of(kind: QuantityKind) -> Parsed:
    """Return the type of a range of quantities, such as 0.2s:4s."""
    return Parsed("range", partial(span, kind))
