"""A question is asked by a model: its fields are the options of a command, the arguments of a verb and keys of a file.

A field says once what it is, its kind (how a text becomes its value), bounds and default. Of it are made the option and
its help, the signature and docstring of the verb, and the refusals, which name it as it was given.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Mapping, Sequence
from typing import Any, ClassVar, Literal, NamedTuple, Self, TypeVar, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field, ValidationError, ValidationInfo, field_validator, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.units import UnitError


class Kind(NamedTuple):
    """What a value is: how it is read, its unit, and its placeholder in the help.

    Parameters
    ----------
    read : callable
        Returns the value of a text, or checks a value that is none. Raises `ValueError`, `UnitError` or `InputError`.
    metavar : str
        Placeholder of the value in the help.
    unit : str
        Unit of a plain number; empty if it has none.
    words : str
        What completes it in a shell: "file", the entry-point group of plugins, or choices separated by spaces; by
        commas, if it takes several.
    """

    read: Callable[[Any], Any]
    metavar: str = ""
    unit: str = ""
    words: str = ""


class Told(dict[str, Any]):
    """What help and messages say of a field, beside pydantic's own; as a mapping, its unit for schemas.

    Parameters
    ----------
    kind : Kind or None
        How its value is read; None if pydantic reads it.
    typed : str
        Name of its option without dashes, if that is not its own; also its key in files.
    usual : str
        What the help says of its default.
    alone : str
        The value of an option that is given without one.
    where : {"", "input", "input option", "input in Python", "Python"}
        Empty for an option that is an argument by name in Python; "input" for a positional argument, which is the
        argument of a command, "input option" for one that is an option of it, and "input in Python" for one that no
        command has; "Python" for an argument by name that is no option.
    on_terminal : any
        Default of the command, if it is not that in Python; or a function (given, as_json) that returns it.
    repeat : bool
        Whether the option may be given several times; its value is a tuple.
    type : str
        Its type in Python, if that is not in its annotation.
    only_in : str
        The field of the file in which alone a command shows what the option asks for.
    bounds : mapping
        Bounds of the value, for the same field in a file.
    """

    kind: Kind | None = None
    typed: str = ""
    usual: str = ""
    alone: str = ""
    where: str = ""
    on_terminal: Any = None
    repeat: bool = False
    type: str = ""
    only_in: str = ""
    bounds: Mapping[str, Any]

    def __init__(self, kind: Kind | None, **told: Any) -> None:
        super().__init__({"unit": kind.unit} if kind is not None and kind.unit else {})
        vars(self).update(told, kind=kind)

    @property
    def written(self) -> bool:
        """Whether the value is a file that is written."""
        return self.kind is not None and self.kind.words == "output"


def option(text: str, kind: Kind | None = None, *, default: Any = None, **more: Any) -> Any:
    """Declare a field of a question: what it is, its kind, its default and bounds.

    Parameters
    ----------
    text : str
        What the field is, a sentence or two, for the help, the docstring and the pages.
    kind : Kind, optional
        How its value is read.
    default : any
        The default; `...` for a field that must be given.
    **more
        What is told of it, as in `Told`, and bounds of pydantic: `ge`, `le`, `min_length`, ...
    """
    told = {name: more.pop(name) for name in [*more] if name in Told.__annotations__}
    return Field(default, description=text, json_schema_extra=Told(kind, **told, bounds=more), **more)


def as_in(model: type[AskedModel], name: str, **changed: Any) -> Any:
    """Declare a field of a file that is a field of a question: with its text, bounds and default."""
    field = model.model_fields[name]
    return Field(**{"default": field.default, "description": field.description, **told_of(field).bounds, **changed})


def told_of(field: FieldInfo) -> Told:
    """Return what is told of a field."""
    assert isinstance(field.json_schema_extra, Told)
    return field.json_schema_extra


def choices(field: FieldInfo) -> tuple[str, ...]:
    """Return the words of which a field takes one; none if it takes others."""
    parts = [field.annotation] if get_origin(field.annotation) is Literal else [*get_args(field.annotation)]
    parts = [part for part in parts if part is not type(None)]
    words = get_args(parts[0]) if len(parts) == 1 and get_origin(parts[0]) is Literal else ()
    return tuple(each for each in words if isinstance(each, str))


class Idle(NamedTuple):
    """A rule: some fields have no effect if something holds of the question.

    Parameters
    ----------
    why : str
        The end of the sentence "... has no effect", such as "with free blocks"; a field in braces is named as given.
    holds : callable
        Whether it holds of a question.
    fields : tuple of str
        Names of the fields.
    """

    why: str
    holds: Callable[[Any], bool]
    fields: tuple[str, ...]


M = TypeVar("M", bound="AskedModel")


class AskedModel(BaseModel):
    """Base class of questions, and of groups of fields that several share."""

    model_config = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True, defer_build=True)
    heading: ClassVar[str] = "Options"
    """Heading of the fields that this class declares, in the help; not inherited."""
    idle: ClassVar[Sequence[Idle]] = ()
    """Fields that have no effect in some cases; those of base classes apply too."""
    writes_each: ClassVar[bool] = False
    """Whether the verb writes its files itself, as there may be one for each motion."""
    _usual: tuple[str, ...] = ()  # fields that are defaults of the command
    _order: tuple[str, ...] = ()  # fields that are given, in their order

    @field_validator("*", mode="before")
    @classmethod
    def _read(cls, value: Any, info: ValidationInfo) -> Any:
        """Read a value by the kind of its field."""
        field = cls.model_fields[info.field_name or ""]
        told, types = told_of(field), str(field.annotation)
        value = value.tolist() if hasattr(value, "tolist") and "input" not in told.where else value
        if isinstance(value, bool) and "bool" not in types:
            raise PydanticCustomError("unit", "{reason}", {"reason": f"takes a value, got {value}", "hint": None})
        if told.kind is None or value is None:
            return value
        try:
            return told.kind.read(value)
        except (UnitError, InputError) as error:
            first = error.problems[0] if isinstance(error, InputError) else error
            wrong: Any = {"reason": first.message, "hint": first.hint}
        except ValueError as error:
            wrong = {"reason": str(error), "hint": None}
        raise PydanticCustomError("unit", "{reason}", wrong)

    @model_validator(mode="after")
    def _has_effect(self, info: ValidationInfo) -> Self:
        """Refuse fields that have no effect, but those that are only defaults of the command."""
        self._usual = (info.context or {}).get("usual", ())
        self._order = (info.context or {}).get("order", ())
        for rule in self.idle_rules():
            self.refuse(rule.why, rule.fields)
        return self

    def idle_rules(self) -> list[Idle]:
        """Return the rules that hold, those of base classes too."""
        rules = [rule for cls in type(self).__mro__ for rule in vars(cls).get("idle", ())]
        return [rule for rule in rules if rule.holds(self)]

    def refuse(self, why: str, fields: Sequence[str]) -> None:
        """Raise `InputError` if any of these fields, which have no effect, was given and is no default."""
        if names := [name for name in fields if self.has(name) and name not in self._usual]:
            raise InputError(no_effect(names, why))

    def has(self, name: str) -> bool:
        """Return whether a field was given, and not as its default."""
        if name not in self.model_fields_set:
            return False
        value, default = getattr(self, name), type(self).model_fields[name].default
        return not (type(value) is type(default) and value == default)

    def given(self) -> dict[str, Any]:
        """Return the options that were given, for JSON: numbers and words as they are, all else as text."""
        shown = {}
        for name, field in in_order(type(self)).items():
            told, value = told_of(field), getattr(self, name)
            is_option = told.where in ("", "input option") and not told.written
            if is_option and self.has(name) and name not in self._usual:
                shown[name] = _plain(value)
        return shown

    def in_order_given(self, *names: Container[str]) -> dict[str, Any]:
        """Return the fields that were given and are among any of these names, in their order."""
        return {name: getattr(self, name) for name in self._order if any(name in each for each in names)}

    def part(self, group: type[AskedModel]) -> dict[str, Any]:
        """Return the fields of a group that were given, by name."""
        return {name: getattr(self, name) for name in group.model_fields if self.has(name)}


def _plain(value: Any) -> Any:
    """Return a value as JSON has it."""
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    return value if isinstance(value, str | int | float | None) else str(value)


def owner_of(model: type[AskedModel], name: str) -> type[AskedModel]:
    """Return the class that was the first to declare a field."""
    declaring = [cls for cls in model.__mro__ if name in vars(cls).get("__annotations__", ())]
    return declaring[-1]


def in_order(model: type[AskedModel]) -> dict[str, FieldInfo]:
    """Return the fields of a question in the order of the help: required, then own ones, then group by group."""
    fields = model.model_fields
    places = {name: (not fields[name].is_required(), model.__mro__.index(owner_of(model, name))) for name in fields}
    return {name: fields[name] for name in sorted(places, key=lambda name: places[name])}


def no_effect(names: Sequence[str], why: str) -> str:
    """Return the sentence that says that fields have no effect."""
    why = re.sub(r"\{(\w+)\}", lambda field: named(field[1]), why)
    return f"{' and '.join(map(named, names))} {'has' if len(names) == 1 else 'have'} no effect {why}"


def checked(model: type[M], given: Mapping[str, Any], usual: Mapping[str, Any] | None = None) -> M:
    """Return a question, checked.

    Parameters
    ----------
    model : type
        Its model.
    given : mapping
        Fields that are given.
    usual : mapping, optional
        Defaults of the command: where they have no effect, they are left out, not refused.

    Raises
    ------
    InputError
        With all that is wrong, each by the name of its field.
    """
    usual = {name: value for name, value in (usual or {}).items() if name not in given}
    try:
        asked = model.model_validate({**usual, **given}, context={"usual": tuple(usual), "order": (*usual, *given)})
        idle = {name for rule in asked.idle_rules() for name in rule.fields} & usual.keys()
        return asked if not idle else checked(model, given, {name: usual[name] for name in usual.keys() - idle})
    except ValidationError as error:
        from rocking_cli.io.field_problems import of_arguments

        errors = error.errors(include_url=False)
        missing = [str(each["loc"][0]) for each in errors if each["type"] == "missing"]
        problems = [Problem("is missing", field=name, hint=model.model_fields[name].description) for name in missing]
        problems += of_arguments(model, (each for each in errors if each["type"] != "missing"), "arguments")
        for k, problem in enumerate(problems):
            if problem.field:  # it is named as it was given
                name, dot, more = problem.field.partition(".")
                problems[k] = Problem(problem.message, field=named(name) + dot + more, hint=problem.hint)
        raise InputError(*problems) from None
