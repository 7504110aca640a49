"""What can be typed for an option: numbers, quantities and ranges of them, by one grammar for all commands.

A number with its unit. Where the help says which unit a bare number has, the unit may be left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Any

import click

from rocking_cli.units import UnitError, read, split

# The names of units stand here again so that `--help` needs no numpy; a test holds them together.
UNITS = ("g", "m/s2", "cm/s2", "mm/s2", "gal", "mg", "%g")


class Finite(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """A finite number; `positive` ones more than zero."""

    name = "number"

    def __init__(self, *, positive: bool = False) -> None:
        self.positive = positive

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Turn a text into the number, or fail naming the option."""
        try:
            number = float(value)
        except ValueError:
            self.fail(f"{value!r} is not a number.", param, ctx)
        if not abs(number) < float("inf") or (self.positive and number <= 0):
            self.fail(f"{value} is not a {'positive' if self.positive else 'finite'} number.", param, ctx)
        return number


class Unit(click.Choice):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """A unit of acceleration, in any spelling that the header of a record may have: `m/s^2` is `m/s2`.

    Units of velocities and lengths are taken too, for records `--from` these, and not listed.
    """

    def __init__(self) -> None:
        super().__init__(UNITS)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a spelling into the name, or fail naming the option and the choices."""
        if value in UNITS:
            return value
        from rocking_cli.excitation.records.sensor import quantity_of
        from rocking_cli.excitation.records.units import canonical

        found = canonical(str(value))
        if found is None and quantity_of(str(value)) is not None:
            return "".join(str(value).split())
        return super().convert(found or value, param, ctx)


class Parsed(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """What a parser of a lower layer makes of a text; the parser is fetched when there is one to read.

    Parameters
    ----------
    name : str
        What it is, for the help.
    parser : callable
        Gives the parser, which raises `InputError`.
    """

    def __init__(self, name: str, parser: Callable[[], Callable[[str], Any]]) -> None:
        self.name, self._parser = name, parser

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into the object, or fail naming the option and what would be right."""
        if not isinstance(value, str):
            return value
        from rocking_cli.errors import InputError

        try:
            return self._parser()(value)
        except InputError as error:
            (problem,) = error.problems
            self.fail(f"{problem.message}{f': {problem.hint}' if problem.hint else ''}.", param, ctx)


@dataclass(frozen=True)
class Kind:
    """What is measured.

    Parameters
    ----------
    name : str
        As messages call it.
    unit : str
        Of the number that is given back; none of a pure number.
    example, ranged : str
        A quantity, and a range, as one would type them.
    least, most : float
        Bounds of what is followed: past these a motion would take hours, or is none.
    zero : bool
        Whether it may be zero.
    """

    name: str
    unit: str
    example: str
    ranged: str = ""
    least: float = 0.0
    most: float = inf
    zero: bool = False


AMPLITUDE = Kind("acceleration", "g", "0.6g", "0.1g:2g", 1e-9, 1e6)  # of a pulse
PERIOD = Kind("period", "s", "0.8s", "0.2s:4s", 1e-6, 1e6)
NUMBER = Kind("number", "", "4", "0.5:10", 1e-6, 1e6)
PGA = Kind("acceleration", "g", "0.35g")
PGV = Kind("velocity", "m/s", "0.4m/s")
INTERVAL = Kind("time", "s", "0.01s")
TAIL = Kind("time", "s", "10s", most=3600, zero=True)


class Quantity(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """A quantity above zero, in the unit of its kind.

    Parameters
    ----------
    kind : Kind
        What is measured.
    """

    name = "quantity"

    def __init__(self, kind: Kind) -> None:
        self.kind = kind

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into the number, or fail naming the option and what would be right."""
        if isinstance(value, float):
            return value
        return self.checked(str(value), self.kind.example, param, ctx)

    def checked(self, text: str, example: str, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """One number."""
        try:
            number = self._number(text)
        except UnitError as error:
            self.fail(f"{error.message}: {error.hint + ', ' if error.hint else 'give '}such as {example}.", param, ctx)
        kind = self.kind
        if not (0 < number < inf or (kind.zero and number == 0)):
            turn = "; --polarity -1 reverses the pulse" if kind is AMPLITUDE and number < 0 else ""
            self.fail(f"{text!r} is not positive: give such as {example}{turn}.", param, ctx)
        if not kind.least <= number <= kind.most:
            bounds = f"{kind.least:g} to {kind.most:g} {kind.unit}".strip()
            self.fail(f"{text!r} is beyond what is followed: {bounds}.", param, ctx)
        return number

    def _number(self, text: str) -> float:
        parts, kind = split(text), self.kind
        if parts is None:
            raise UnitError(f"{text!r} is no {kind.name}")
        number, unit = parts
        if not unit:
            if kind is AMPLITUDE:  # of 6 nobody knows whether it is in g
                raise UnitError(f"{text!r} has no unit", f"give one of {', '.join(UNITS)}")
            return float(number)
        if kind.unit == "g":
            return _acceleration(float(number), unit)
        if kind.name == "period" and unit.lower() == "hz":
            return 1 / float(number) if float(number) else 0.0
        return read(text, kind.unit)


def _acceleration(number: float, spelling: str) -> float:
    """An acceleration in g, its unit in any spelling that the header of a record may have."""
    from rocking_cli.excitation.base import STANDARD_GRAVITY
    from rocking_cli.excitation.records import units

    unit = units.canonical(spelling)
    if unit is None:
        raise UnitError(f"{spelling!r} is no unit of acceleration", f"give one of {', '.join(UNITS)}")
    return number if unit == "g" else number * units.UNITS[unit] / STANDARD_GRAVITY


class Azimuth(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """An angle in degrees; or the word `all`, where a command takes all of them."""

    name = "angle"
    ALL = "all"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into the angle, or fail naming the option."""
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
    """A tilt: a fraction of the critical rotation between -1 and 1, or an angle with its unit; not zero."""

    name = "tilt"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into a `Release`, or fail naming the option and what would be right."""
        if not isinstance(value, str):
            return value
        from rocking_cli.dynamics.release import Release
        from rocking_cli.errors import InputError

        try:
            return Release.of(value)
        except InputError as error:
            (problem,) = error.problems
            self.fail(f"{problem.message}{f': {problem.hint}' if problem.hint else ''}.", param, ctx)


class Share(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """A share: a number, or per cent with their sign."""

    name = "share"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Turn a text into the number, or fail naming the option."""
        text = str(value).strip()
        try:
            number = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            self.fail(f"{value!r} is not a share: give such as 0.02 or 2%.", param, ctx)
        if not abs(number) < float("inf"):
            self.fail(f"{value} is not a finite number.", param, ctx)
        return number


class Range(Quantity):
    """Two quantities, the smaller first, with a colon between them."""

    name = "range"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into the two numbers, or fail naming the option and what would be right."""
        if isinstance(value, tuple):
            return value
        example = self.kind.ranged
        words = str(value).split(":")
        if len(words) != 2:
            self.fail(f"{value!r} is no range: give the least and the largest, such as {example}.", param, ctx)
        low, high = (self.checked(word, example, param, ctx) for word in words)
        if not low < high:
            self.fail(f"{value!r} does not grow: give the smaller first, such as {example}.", param, ctx)
        return low, high


class Sizes(Range):
    """Two periods in s, the smaller first, and how many sizes there are between them if a third number says so."""

    name = "sizes"

    def __init__(self, count: int, most: int) -> None:
        super().__init__(Kind("period", "s", "0.8s", "1s:10s", 1e-3, 1e4))  # blocks of 0.2 um to 19,000 km
        self.count, self.most = count, most

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into the two periods and the number, or fail naming the option and what would be right."""
        if isinstance(value, tuple):
            return value
        *ends, last = str(value).split(":")
        if len(ends) != 2:
            return *super().convert(value, param, ctx), self.count
        if not (last.strip().isdecimal() and 2 <= int(last) <= self.most):
            self.fail(f"{last!r} is no number of sizes from 2 to {self.most}: give such as 1:10:60.", param, ctx)
        return *super().convert(":".join(ends), param, ctx), int(last)
