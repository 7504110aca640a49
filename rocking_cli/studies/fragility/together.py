"""What must hold between the fields of a study or site file, also where one of them is wrong by itself."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import Any, Self, get_args, get_origin

from pydantic import BaseModel, ConfigDict, model_validator

from rocking_cli.core.fields import geometry_error
from rocking_cli.io.yaml_file import Place, spell

Sound = Callable[..., bool]
"""Whether what stands at a path of keys, within a part of the file, is right by itself."""


class Part(BaseModel):
    """A part of a study file, or of a site file."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """What is wrong between fields, although each may be right.

        Parameters
        ----------
        given : dict
            The fields that the file gives, as it gives them.
        sound : callable
            Which of them can be looked at.

        Yields
        ------
        place : tuple
            Where, within this part; empty for the whole of it.
        message : str
            What is wrong there.
        """
        del given, sound
        return iter(())

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        for place, message in self.between(self.model_dump(exclude_unset=True), lambda *path: True):
            raise geometry_error(spell(place) or "", message)
        return self


def between_fields(
    annotation: Any, data: Any, wrong: Collection[Place], place: Place = ()
) -> Iterator[tuple[Place, str]]:
    """What is wrong between the fields of a part, and of all parts that it holds.

    pydantic looks between the fields of a part only if all of them are right: one mistake would hide another.

    Parameters
    ----------
    annotation : type
        A `Part`, or a list, a mapping or a choice of such.
    data : object
        What the file gives for it.
    wrong : collection of tuple
        The places of what is wrong by itself.
    place : tuple
        Where the data stand.

    Yields
    ------
    place : tuple
        Where something is wrong.
    message : str
        What it is.
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
