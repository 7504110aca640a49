"""Text in place of a number: verbs take numbers, in the units of their docstrings; options of records take text too."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from functools import wraps
from typing import ParamSpec, TypeVar

from rocking_cli.errors import InputError, Problem
from rocking_cli.processing.reading_options import READING, SCALING
from rocking_cli.text import cut, did_you_mean
from rocking_cli.units import UnitError, number_of

P = ParamSpec("P")
R = TypeVar("R")
UNITS = {
    "vertical_dt": "s", "tail": "s", "period": "s", "band": "s", "sizes": "s", "ag": "g", "top": "g",
}  # fmt: skip
"""Units of arguments that are quantities."""
MIN_LIKENESS = 0.8  # of a word and the name of a field that it means
MEANT = {
    "record": ("motion", "motions"), "records": ("motions", "motion"), "pulse": ("motion", "motions"),
    "mechanism": ("structure", "structures"), "mechanisms": ("structures", "structure"), "factor": ("scale", "scales"),
    "factors": ("scales", "scale"), "pga": ("target_pga",), "pgv": ("target_pgv",), "eta": ("restitutions",),
    "restitution": ("restitutions",),
}  # fmt: skip
"""Other words for arguments, and those that they may mean."""


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
        for name, value in options.items():
            if name not in names and name not in loose:
                unscaled = more and name in SCALING and f"{name}s" not in names
                scaled = "the motions of this question are not scaled" if unscaled else None
                hint = scaled or _instead_of(name, value, [*names, *loose], (*given, *options.values()))
                raise InputError(Problem("is not an argument", field=f"`{name}`", hint=hint))
        for name, value in (*zip(names, given, strict=False), *options.items()):
            if name in meant and (text := _text(value)) is not None:
                raise InputError(_problem(name, meant[name], text))
        return verb(*given, **options)

    return checked


def _instead_of(name: str, value: object, known: list[str], given: Sequence[object]) -> str | None:
    """Return a hint for a name that is no argument: the argument or the field of the structure that is meant.

    Parameters
    ----------
    name, value
        What was given.
    known : list of str
        The names of all arguments.
    given : sequence
        The values of all arguments, with the structures whose fields may be meant.
    """
    if meant := next((each for each in MEANT.get(name, ()) if each in known), None):
        return f"did you mean {meant}?"
    if not {"structure", "structures"} & set(known):
        return did_you_mean(name, known)
    from rocking_cli.core import Mechanism
    from rocking_cli.io.field_problems import by_meaning

    each_given = [each for value in given for each in (value if isinstance(value, list | tuple) else [value])]
    cls = next((type(each) for each in each_given if isinstance(each, Mechanism)), Mechanism)
    fields = cls.model_fields
    if name in cls.refused and name not in fields:
        return str(Problem(cls.refused[name], field=name))
    word = cls.meanings.get(name, name)
    field = next(iter(get_close_matches(word, [*known, *fields], n=1, cutoff=MIN_LIKENESS)), None)
    if field not in fields:
        return by_meaning(name, fields) or did_you_mean(name, known)
    new = cut(repr(value)) if isinstance(value, int | float | str) else "..."
    return f"{field} is a field of the structure: structure.replace({field}={new})"


def _text(value: object) -> str | None:
    """Return the first text among the values given for numbers; None if there is none."""
    if isinstance(value, list | tuple):
        return next(filter(None, map(_text, value)), None)
    return value if isinstance(value, str) else None


def _problem(name: str, annotation: str, text: str) -> Problem:
    single = "tuple" not in annotation and "Sequence" not in annotation
    unit = UNITS.get(name, "")
    example: object = "(low, high)" if "tuple" in annotation else "numbers such as [1, 2]" if not single else "a number"
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
