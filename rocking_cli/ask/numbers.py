"""Text in place of a number: verbs take numbers, in the units of their docstrings; options of records take text too."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from rocking_cli.errors import InputError, Problem
from rocking_cli.processing.reading_options import READING, SCALING
from rocking_cli.text import did_you_mean
from rocking_cli.units import UnitError, number_of

P = ParamSpec("P")
R = TypeVar("R")
UNITS = {
    "vertical_dt": "s", "tail": "s", "period": "s", "band": "s", "sizes": "s", "ag": "g", "top": "g",
}  # fmt: skip
"""Units of arguments that are quantities."""


def takes_numbers(verb: Callable[P, R]) -> Callable[P, R]:
    """Make a verb refuse unknown arguments, and text for arguments that are annotated as numbers."""
    meant = {
        name: given
        for name, given in verb.__annotations__.items()
        if re.search(r"\b(float|int)\b", given) and not re.search(r"\b(str|Literal|Callable)\b", given)
    }
    code = verb.__code__
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    more = verb.__annotations__.get("options", "")
    loose = [name for name in (*READING, *SCALING) if more and (name in READING or "Motion" in more)]

    @wraps(verb)
    def checked(*given: P.args, **options: P.kwargs) -> R:
        for name in options:
            if name not in names and name not in loose:
                scaled = "the motions of this question are not scaled" if more and name in SCALING else None
                raise InputError(
                    Problem(
                        "is not an argument", field=f"`{name}`", hint=scaled or did_you_mean(name, [*names, *loose])
                    )
                )
        for name, value in (*zip(names, given, strict=False), *options.items()):
            if name in meant and (text := _text(value)) is not None:
                raise InputError(_problem(name, meant[name], text))
        return verb(*given, **options)

    return checked


def _text(value: object) -> str | None:
    """Return the first text among the values given for numbers; None if there is none."""
    if isinstance(value, list | tuple):
        return next(filter(None, map(_text, value)), None)
    return value if isinstance(value, str) else None


def _problem(name: str, annotation: str, text: str) -> Problem:
    single = "tuple" not in annotation and "Sequence" not in annotation
    unit = UNITS.get(name, "")
    example: object = "(low, high)" if "tuple" in annotation else "[0.1, 0.2]" if not single else "a number"
    if single and (number := _number(text, unit)) is not None:
        example = f"{number:g}"
    what = "a number" if single else "two numbers" if "tuple" in annotation else "numbers"
    hint = f"give {example}{f', in {unit}' if unit else ''}"
    return Problem(f"must be {what}, got the text {text!r}", field=f"`{name}`", hint=hint)


def _number(text: str, unit: str) -> float | None:
    """Return the number of a text, in the unit of its argument; None if it is not one."""
    try:
        return number_of(text, unit)
    except UnitError:
        return None


def refuse_idle(why: str, **given: object) -> None:
    """Raise `InputError` if arguments are given that have no effect, and say why."""
    if names := [f"`{name}`" for name, value in given.items() if value]:
        raise InputError(f"{' and '.join(names)} {'has' if len(names) == 1 else 'have'} no effect {why}")
