"""Numbers with units on the command line, and ranges of them."""

from __future__ import annotations

import re
from typing import Any, Literal

import click

from rocking_cli.cli.options import UNITS

Kind = Literal["acceleration", "period", "number"]
_FORM = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([A-Za-z%].*)?", re.ASCII)
_EXAMPLES = {"acceleration": "0.6g", "period": "0.8", "number": "4"}
# Least and largest, in g, s or none: past these a motion would be followed for hours, or is none.
_BOUNDS = {"acceleration": (1e-9, 1e6, " g"), "period": (1e-6, 1e6, " s"), "number": (1e-6, 1e6, "")}
_RANGES = {"acceleration": "0.1g:2g", "period": "0.2:4", "number": "0.5:10"}


class Quantity(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """A positive number: an acceleration, which needs a unit, given back in g; a period in s; or a pure number."""

    name = "quantity"

    def __init__(self, kind: Kind) -> None:
        self.kind = kind
        self.bounds = _BOUNDS[kind]

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into the number, or fail naming the option and what would be right."""
        return self.read(value, _EXAMPLES[self.kind], param, ctx)

    def read(self, text: str, example: str, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """One number."""
        match = _FORM.fullmatch(text.strip())
        if match is None:
            self.fail(f"{text!r} is no {self.kind}: give such as {example}.", param, ctx)
        number, unit = float(match[1]), (match[2] or "").lower()
        if self.kind == "acceleration":
            from rocking_cli.excitation import base
            from rocking_cli.excitation.records import units

            unit = units.canonical(unit) or ""
            if not unit:
                has = f"{match[2]!r} is no unit of acceleration" if match[2] else f"{text!r} has no unit"
                self.fail(f"{has}: give one of {', '.join(UNITS)}, such as {example}.", param, ctx)
            number = number if unit == "g" else number * units.UNITS[unit] / base.STANDARD_GRAVITY
        elif unit not in (("", "s") if self.kind == "period" else ("",)):
            takes = "a period is in s" if self.kind == "period" else "this is a number without a unit"
            self.fail(f"{text!r}: {takes}, such as {example}.", param, ctx)
        if not 0 < number < float("inf"):
            self.fail(f"{text!r} is not positive: give such as {example}.", param, ctx)
        low, high, unit = self.bounds
        if not low <= number <= high:
            self.fail(f"{text!r} is beyond what is followed: {low:g} to {high:g}{unit}.", param, ctx)
        return number


class Range(Quantity):
    """Two such numbers, the smaller first, with a colon between them."""

    name = "range"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a text into the two numbers, or fail naming the option and what would be right."""
        if isinstance(value, tuple):
            return value
        example = _RANGES[self.kind]
        words = str(value).split(":")
        if len(words) != 2:
            self.fail(f"{value!r} is no range: give the least and the largest, such as {example}.", param, ctx)
        low, high = (self.read(word, example, param, ctx) for word in words)
        if not low < high:
            self.fail(f"{value!r} does not grow: give the smaller first, such as {example}.", param, ctx)
        return low, high


class Sizes(Range):
    """Two periods in s, the smaller first, and how many sizes there are between them if a third number says so."""

    name = "sizes"

    def __init__(self, count: int, most: int) -> None:
        super().__init__("period")
        self.bounds = (1e-3, 1e4, " s")  # blocks of 0.2 um to 19,000 km
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
