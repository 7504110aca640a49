"""Rules between the fields of a study or site file, checked even if some fields are invalid."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, Self, cast, get_args, get_origin

import numpy as np
from pydantic import BaseModel, ValidationError, model_validator

from rocking_cli.arrays import Reals
from rocking_cli.core.fields import Described, geometry_error
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.records.text import numbers_in
from rocking_cli.io.field_problems import place_of, problems
from rocking_cli.io.files import read_bytes
from rocking_cli.io.yaml_file import Document, Place
from rocking_cli.short_repr import short_repr
from rocking_cli.units import split

Sound = Callable[..., bool]
"""Function that returns whether the value at a path of keys, within a part of the file, is valid by itself."""
MAX_BYTES = 10_000_000
MAX_LISTED_PROBLEMS = 5


@short_repr
class Part(Described):
    """A part of a study file, or of a site file."""

    meanings: ClassVar[Mapping[str, str]] = {}
    """Words in small letters that mean a field of another name, and what to write instead, for hints."""

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Yield what is wrong between fields that are each valid.

        Parameters
        ----------
        given : dict
            The fields as the file gives them.
        sound : callable
            Returns whether a field, or an entry of it, is valid.

        Yields
        ------
        place : tuple
            Place of the problem within this part; empty for the whole part.
        message : str
            What is wrong there.
        """
        del given, sound
        return iter(())

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        for place, message in self.between(self.model_dump(exclude_unset=True, by_alias=True), lambda *path: True):
            raise geometry_error(place, message)
        return self


def problems_of(
    document: Document,
    model: type[BaseModel],
    error: ValidationError,
    *,
    owner: str,
    lister: str,
    known: Collection[Problem] = (),
) -> list[Problem]:
    """Return what is wrong with the fields of a file, each for itself and between them.

    Arguments are those of `field_problems.problems`; wrong fields among the `known` problems are left out.
    """
    already_listed = {(problem.field, problem.line) for problem in known}
    errors = error.errors(include_url=False)
    alone: Any = [each for each in errors if each["type"] != "geometry"]
    listed = problems(document, model, alone, owner=owner, lister=lister)
    listed = [problem for problem in listed if (problem.field, problem.line) not in already_listed]
    places = {place_of(document.data, each) for each in alone}
    # Numbers with units are compared once all fields are valid.
    given = {place: reduce(getitem, place, cast("Any", document.data)) for place in document.values}
    places |= {place for place, text in given.items() if isinstance(text, str) and (split(text) or ("", ""))[1]}
    listed += [document.at(place, message) for place, message in between_fields(model, document.data, places)]
    return listed if listed or known else problems(document, model, errors, owner=owner, lister=lister)


def between_fields(
    annotation: Any, data: Any, wrong: Collection[Place], place: Place = ()
) -> Iterator[tuple[Place, str]]:
    """Yield what is wrong between the fields of a part of a file, and of all parts inside it.

    pydantic checks rules between fields only if all fields are valid, so that one mistake would hide another.

    Parameters
    ----------
    annotation : type
        A `Part`, or a list, a mapping or a choice of such.
    data : object
        The data that the file gives for the annotation.
    wrong : collection of tuple
        Places of the fields that are invalid.
    place : tuple
        Place of the data in the file.

    Yields
    ------
    place : tuple
        Place of the problem.
    message : str
        The problem.
    """
    if isinstance(annotation, type) and issubclass(annotation, Part):
        if not isinstance(data, dict):
            return

        def sound(*path: str | int) -> bool:
            whole = (*place, *path)
            return not any(whole[: len(each)] == each[: len(whole)] for each in wrong)

        for where, message in annotation.between(data, sound):
            yield (*place, *where), message
        for name, field in annotation.model_fields.items():
            if name in data:
                yield from between_fields(field.annotation, data[name], wrong, (*place, name))
        return
    origin, held = get_origin(annotation), get_args(annotation)
    if origin is list:
        for k, each in enumerate(data if isinstance(data, list) else []):
            yield from between_fields(held[0], each, wrong, (*place, k))
    elif origin is dict:
        for key, each in data.items() if isinstance(data, dict) else ():
            yield from between_fields(held[1], each, wrong, (*place, key))
    else:
        for each in held:
            yield from between_fields(each, data, wrong, place)


class CurvePoints(NamedTuple):
    """The columns of a file, and the unit that the line above them names, if it names one."""

    x: Reals
    y: Reals
    unit: str | None


def separator_in(line: str) -> str | None:
    """Return the separator of the cells of a line; None for blanks."""
    return next((sign for sign in (";", "\t", ",") if sign in line), None)


def read_points(
    path: Path,
    what: str,
    columns: str,
    wrong_points: Callable[[Reals, Reals], list[tuple[int, str]]],
    remedy: Callable[[str], str | None] = lambda message: None,
    unit_in: Callable[[str, int, str], str | None] = lambda file, number, line: None,
) -> CurvePoints:
    """Read the points of a curve from a file of two columns.

    Parameters
    ----------
    path : Path
        A file whose lines each have two numbers, separated by a comma, a semicolon or blanks. Lines above the numbers,
        blank lines, and lines that begin with # are skipped.
    what : str
        Name of such a file in messages.
    columns : str
        What a line has, as a remedy.
    wrong_points : callable
        Returns the invalid points, counted from 0, each with a message; the number of points for what concerns all.
    remedy : callable, optional
        Returns the remedy for a message of a point.
    unit_in : callable, optional
        Returns the unit that a heading names, from file, line number and line.

    Raises
    ------
    InputError
        With file and line.
    """
    shown_path = str(path)
    try:
        lines = read_bytes(path, what, MAX_BYTES).decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise InputError(Problem("this is not UTF-8 text", shown_path, hint="save it as CSV in UTF-8")) from None
    used = [k for k, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#")]
    start = next((place for place, k in enumerate(used) if lines[k].lstrip()[0] in "+-.0123456789"), len(used))
    above, used = used[:start], used[start:]
    unit = unit_in(shown_path, above[-1] + 1, lines[above[-1]]) if above else None
    rows = [_row(shown_path, k + 1, lines[k], columns) for k in used]
    x, y = np.array(rows, dtype=np.float64).reshape(-1, 2).T
    problems = []
    for point, message in wrong_points(x, y):
        if point == len(used):
            message = f"{len(used)} point{'s' * (len(used) != 1)}: {message}"
            problems.append(Problem(message, shown_path, hint=columns))
        else:
            line = lines[used[point]].strip()[:100]
            problems.append(Problem(message, shown_path, used[point] + 1, excerpt=line, hint=remedy(message)))
    if problems:
        raise InputError(*problems[:MAX_LISTED_PROBLEMS])
    return CurvePoints(x, y, unit)


def _row(file: str, number: int, line: str, columns: str) -> list[float]:
    separator = separator_in(line)
    cells = [cell.strip() for cell in line.strip().split(separator)]
    if len(cells) > 2 and not any(cells[2:]):  # a spreadsheet leaves separators of empty columns
        cells = cells[:2]
    if len(cells) != 2:
        message = f"{len(cells)} column{'s' * (len(cells) > 1)}"
        raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint=columns))
    if separator != "," and any(re.fullmatch(r"[+-]?\d+,\d+", cell) for cell in cells):
        hint = "write numbers with a point: 0.25"
        raise InputError(Problem("a comma within a number", file, number, excerpt=line.strip()[:100], hint=hint))
    return numbers_in(file, number, line, cells)
