"""Types of options: numbers, quantities and ranges of them, by one grammar for all commands.

A quantity is a number with its unit. If the help names the unit of a bare number, the unit may be left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Any

import click

from rocking_cli.cli import terminal
from rocking_cli.units import UnitError, read, split

# The names of units stand here again so that `--help` needs no numpy; a test holds them together.
UNITS = ("g", "m/s2", "cm/s2", "mm/s2", "gal", "mg", "%g")


class Finite(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Finite number; above zero if `positive`."""

    name = "number"

    def __init__(self, *, positive: bool = False) -> None:
        self.positive = positive

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number of a text, or fail naming the option."""
        try:
            number = float(value)
        except ValueError:
            self.fail(f"{value!r} is not a number.", param, ctx)
        if not abs(number) < float("inf") or (self.positive and number <= 0):
            self.fail(f"{value} is not a {'positive' if self.positive else 'finite'} number.", param, ctx)
        return number


class Unit(click.Choice):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Unit of acceleration, in any spelling that the header of a record may have: `m/s^2` is `m/s2`.

    Units of velocity and length are accepted too, for records `--from` these, but not listed.
    """

    def __init__(self) -> None:
        super().__init__(UNITS)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the name of a spelling, or fail naming the option and the choices."""
        if value in UNITS:
            return value
        from rocking_cli.excitation.records.record_units import canonical
        from rocking_cli.excitation.records.sensor import quantity_of

        found = canonical(str(value))
        if found is None and quantity_of(str(value)) is not None:
            return "".join(str(value).split())
        return super().convert(found or value, param, ctx)


class Parsed(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Object that a parser of a lower layer makes from a text; the parser is imported only when needed.

    Parameters
    ----------
    name : str
        Name of the value, for the help.
    parser : callable
        Returns the parser, which raises `InputError`.
    """

    def __init__(self, name: str, parser: Callable[[], Callable[[str], Any]]) -> None:
        self.name, self._parser = name, parser

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the object of a text, or fail naming the option and a valid example."""
        if not isinstance(value, str):
            return value
        from rocking_cli.errors import InputError

        try:
            with terminal.plugins_apart():
                return self._parser()(value)
        except InputError as error:
            (problem,) = error.problems
            self.fail(f"{problem.message}{f': {problem.hint}' if problem.hint else ''}.", param, ctx)


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


AMPLITUDE = QuantityKind("acceleration", "g", "0.6g", "0.1g:2g", 1e-9, 1e6)  # of a pulse
PERIOD = QuantityKind("period", "s", "0.8s", "0.2s:4s", 1e-6, 1e6)
NUMBER = QuantityKind("number", "", "4", "0.5:10", 1e-6, 1e6)
PGA = QuantityKind("acceleration", "g", "0.35g")
PGV = QuantityKind("velocity", "m/s", "0.4m/s")
INTERVAL = QuantityKind("time", "s", "0.01s")
TAIL = QuantityKind("time", "s", "10s", most=3600, zero=True)


class Quantity(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Quantity above zero, in the unit of its kind.

    Parameters
    ----------
    kind : QuantityKind
        Kind of the quantity.
    """

    name = "quantity"

    def __init__(self, kind: QuantityKind) -> None:
        self.kind = kind

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number of a text, or fail naming the option and a valid example."""
        if isinstance(value, float):
            return value
        return self.checked(str(value), self.kind.example, param, ctx)

    def checked(self, text: str, example: str, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return one number, checked."""
        try:
            number = self._number(text)
        except UnitError as error:
            hint = error.hint or ""
            remedy = f"{hint} Give a value" if hint.endswith("?") else f"{hint}," if hint else "give a value"
            self.fail(f"{error.message}: {remedy} such as {example}.", param, ctx)
        kind = self.kind
        if not (0 < number < inf or (kind.zero and number == 0)):
            turn = "; --polarity -1 reverses the pulse" if kind is AMPLITUDE and number < 0 else ""
            self.fail(f"{text!r} is not positive: give a value such as {example}{turn}.", param, ctx)
        if not kind.least <= number <= kind.most:
            bounds = f"{kind.least:g} to {kind.most:g} {kind.unit}".strip()
            self.fail(f"{text!r} is outside the supported range: {bounds}.", param, ctx)
        return number

    def _number(self, text: str) -> float:
        parts, kind = split(text), self.kind
        if parts is None:
            raise UnitError(f"{text!r} is not a valid {kind.name}")
        number, unit = parts
        if not unit:
            if kind is AMPLITUDE:  # a bare 6 may be in g or in m/s2
                raise UnitError(f"{text!r} has no unit", f"give one of {', '.join(UNITS)}")
            return float(number)
        if kind.unit == "g":
            return _acceleration(float(number), unit)
        if kind.name == "period" and unit.lower() == "hz":
            return 1 / float(number) if float(number) else 0.0
        return read(text, kind.unit)


def _acceleration(number: float, spelling: str) -> float:
    """Return an acceleration in g; its unit may have any spelling found in the headers of records."""
    from rocking_cli.excitation.base import STANDARD_GRAVITY
    from rocking_cli.excitation.records import record_units

    unit = record_units.canonical(spelling)
    if unit is None:
        raise UnitError(f"{spelling!r} is not a unit of acceleration", f"give one of {', '.join(UNITS)}")
    return number if unit == "g" else number * record_units.UNITS[unit] / STANDARD_GRAVITY


class Azimuth(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Angle in degrees; or the word `all`, for the commands that accept it."""

    name = "angle"
    ALL = "all"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the angle of a text, or fail naming the option."""
        if isinstance(value, float) or value == self.ALL:
            return value
        try:
            number = float(str(value).strip()) if _is_plain(str(value)) else read(str(value), "deg")
        except UnitError as error:
            self.fail(f"{error.message}: give degrees, such as 30.", param, ctx)
        if not abs(number) < inf:
            self.fail(f"{value} is not a finite angle.", param, ctx)
        return number


def _is_plain(text: str) -> bool:
    parts = split(text)
    return parts is not None and not parts[1]


class Tilt(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Tilt: a fraction of the critical rotation between -1 and 1, or an angle with its unit; not zero."""

    name = "tilt"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the `Release` of a text, or fail naming the option and the reason."""
        if not isinstance(value, str):
            return value
        from rocking_cli.errors import InputError
        from rocking_cli.studies.release import Release

        try:
            return Release.of(value)
        except InputError as error:
            (problem,) = error.problems
            self.fail(f"{problem.message}{f': {problem.hint}' if problem.hint else ''}.", param, ctx)


class Share(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Fraction: a number, or a percentage with its sign."""

    name = "share"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number of a text, or fail naming the option."""
        text = str(value).strip()
        try:
            number = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            self.fail(f"{value!r} is not a fraction: give a number such as 0.02 or 2%.", param, ctx)
        if not abs(number) < float("inf"):
            self.fail(f"{value} is not a finite number.", param, ctx)
        return number


class Range(Quantity):
    """Range: two quantities, the smaller first, separated by a colon."""

    name = "range"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the two numbers of a text, or fail naming the option and a valid example."""
        if isinstance(value, tuple):
            return value
        example = self.kind.ranged
        words = str(value).split(":")
        if len(words) != 2:
            self.fail(
                f"{value!r} is not a range: give the smallest and the largest value, such as {example}.", param, ctx
            )
        low, high = (self.checked(word, example, param, ctx) for word in words)
        if not low < high:
            self.fail(f"{value!r} is not increasing: give the smaller value first, such as {example}.", param, ctx)
        return low, high


class SizeRange(Range):
    """Two periods in s, the smaller first, and optionally the number of sizes between them."""

    name = "sizes"

    def __init__(self, count: int, most: int) -> None:
        super().__init__(QuantityKind("period", "s", "0.8s", "1s:10s", 1e-3, 1e4))  # blocks of 0.2 um to 19,000 km
        self.count, self.most = count, most

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the two periods and the number of a text, or fail naming the option and a valid example."""
        if isinstance(value, tuple):
            return value
        *ends, last = str(value).split(":")
        if len(ends) != 2:
            return *super().convert(value, param, ctx), self.count
        if not (last.strip().isdecimal() and 2 <= int(last) <= self.most):
            self.fail(
                f"{last!r} is not a number of sizes from 2 to {self.most}: give a range such as 1:10:60.", param, ctx
            )
        return *super().convert(":".join(ends), param, ctx), int(last)
