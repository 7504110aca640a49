"""Rules between the fields of a study or site file, checked even if some fields are invalid."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from functools import reduce
from operator import getitem
from typing import Any, ClassVar, Self, cast, get_args, get_origin

from pydantic import BaseModel, ValidationError, model_validator

from rocking_cli.core.fields import Described, geometry_error
from rocking_cli.errors import Problem
from rocking_cli.io.field_problems import place_of, problems
from rocking_cli.io.yaml_file import Document, Place
from rocking_cli.short_repr import short_repr
from rocking_cli.units import split

Sound = Callable[..., bool]
"""Function that returns whether the value at a path of keys, within a part of the file, is valid by itself."""


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
