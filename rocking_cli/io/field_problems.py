"""Validation errors of pydantic as problems in plain words, with their places in a file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any, get_args, get_origin

from pydantic import AliasChoices, BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from rocking_cli.errors import Problem
from rocking_cli.io.yaml_file import Document, Place, spell
from rocking_cli.text import cut, did_you_mean

DECIMAL_POINT = "write a decimal point"
MIN_YIELD_STRESS = 1e7  # Pa; no other field has this bound
MAX_WORDED = 200  # errors that are put into words: more than are shown, the others are counted
OF_KIND: Any = {
    "float_type": (), "int_type": (), "string_type": (), "literal_error": (), "list_type": (), "model_type": (),
    "dict_type": (), list: ("list_type",), dict: ("model_type", "dict_type"),
}  # fmt: skip
"""Types of pydantic's errors on the kind of a value; under `list` and `dict`, those that apply to such a value."""


def problems(
    document: Document, model: type[BaseModel], errors: Iterable[ErrorDetails], *, owner: str, lister: str
) -> list[Problem]:
    """Return the errors of a validation as problems, each with its place in the file.

    Only the first `MAX_WORDED` in the file are put into words. All others are one problem, given as often as there are
    others, so that they are counted.

    Parameters
    ----------
    document : Document
        The file.
    model : type
        Model by which the data were validated.
    errors : iterable of ErrorDetails
        Errors, as from `pydantic.ValidationError.errors`.
    owner : str
        Name of what the top-level fields belong to, for messages: "block".
    lister : str
        Words that say which command lists the valid fields, for messages.
    """
    by_place: dict[Place, Problem] = {}
    errors = _of_words(errors)
    if len(errors) > MAX_WORDED:
        errors.sort(key=lambda error: document.at(place_of(document.data, error), "").line or 0)
    errors, others = errors[:MAX_WORDED], errors[MAX_WORDED:]
    for error in errors:
        if not _concerns(document.data, error, errors):
            continue
        place = place_of(document.data, error)
        if error["type"] == "geometry":
            place = (*place, *error["ctx"]["field"])
        message, hint = say(model, place, error, owner, lister)
        if error["type"] == "too_long" and _has_commas(document, place, error["input"]):
            hint = DECIMAL_POINT
        key = error["type"] == "extra_forbidden"
        by_place.setdefault(place, document.at(place, message, hint, key=key))
    unworded = [document.at(place_of(document.data, error), error["msg"]) for error in others[-1:]]
    return [*by_place.values(), *unworded * len(others)]


def _has_commas(document: Document, place: Place, value: Any) -> bool:
    """Return whether a list in one line seems to have decimal commas, which split its numbers into whole ones."""
    line = document.at(place, "").excerpt or ""
    split = isinstance(value, list) and all(isinstance(each, int) for each in value)
    return split and re.search(r"\d,\d", line) is not None and re.search(r"\d, ", line) is not None


def of_arguments(model: type[BaseModel], errors: Iterable[ErrorDetails], owner: str) -> list[Problem]:
    """Return the errors of a validation of arguments in Python as problems, each with the name of its argument."""
    by_place: dict[Place, Problem] = {}
    errors = _of_words(errors)
    errors, others = errors[:MAX_WORDED], errors[MAX_WORDED:]
    places = [_place_in(model, error) for error in errors]
    for error, place in zip(errors, places, strict=True):
        if error["type"] in OF_KIND and isinstance(error["input"], dict | list) and place[-1:] != error["loc"][-1:]:
            each = zip(errors, places, strict=True)
            if any(at[: len(place)] == place and (other["type"] not in OF_KIND or at != place) for other, at in each):
                continue  # the error is of another branch of the union
        place = place or tuple(error["loc"][:1])
        if error["type"] == "geometry":
            place = (*place, *error["ctx"]["field"])
        message, hint = say(model, place or (owner,), error, owner, f"`rocking mechanisms {owner}` lists the fields")
        by_place.setdefault(place, Problem(message, field=spell(place) if place else None, hint=hint))
    return [*by_place.values(), *[Problem("is wrong too")] * len(others)]


def _place_in(model: type[BaseModel], error: ErrorDetails) -> Place:
    """Return the path of an error in the data of a model, without the branches of unions that pydantic adds."""
    place: Place = ()
    for part in error["loc"]:
        if isinstance(part, int) or part in fields_at(model, place) or names_at(model, place):
            place = (*place, part)
    return place


def place_of(data: Any, error: ErrorDetails) -> Place:
    """Return the path of an error in the user's data, without the branches of unions that pydantic adds."""
    path: list[str | int] = []
    for k, part in enumerate(error["loc"]):
        last = k == len(error["loc"]) - 1
        if isinstance(data, dict) and (part in data or (last and error["type"] == "missing")):
            path.append(part)
            data = data.get(part)
        elif isinstance(data, list) and isinstance(part, int) and part < len(data):
            path.append(part)
            data = data[part]
    return tuple(path)


def _concerns(data: Any, error: ErrorDetails, errors: Iterable[ErrorDetails]) -> bool:
    """Return whether an error concerns the branch of a union that the user meant.

    For example, it is of no use to say that a mapping is not a number.
    """
    if error["type"] not in OF_KIND:
        return True
    place = place_of(data, error)
    value = data
    for part in place:
        value = value.get(part) if isinstance(value, dict) else value[part]
    if isinstance(value, str):
        others = {other["type"] for other in errors if place_of(data, other) == place}
        return error["type"] not in ("model_type", "dict_type", "list_type") or "literal_error" not in others
    if not isinstance(value, dict | list) or error["type"] in OF_KIND[type(value)]:
        return True
    kinds = [(other["type"], place_of(data, other)) for other in errors]
    return not any(at[: len(place)] == place and (kind not in OF_KIND or len(at) > len(place)) for kind, at in kinds)


def _of_words(errors: Iterable[ErrorDetails]) -> list[ErrorDetails]:
    """Return the errors, without superfluous ones on a mistyped word where a word or a number is allowed.

    pydantic reports both that the word is unknown and that it is not a number; only the first is kept.
    """
    errors = list(errors)
    wrong = [error["loc"] for error in errors if error["type"] == "literal_error"]
    # The last part is pydantic's name of the branch of a union that accepts only words.
    words = {place[:-1] for place in wrong if str(place[-1]).startswith("literal[")}
    return [
        error
        for error in errors
        if not (error["type"] == "float_type" and isinstance(error["input"], str) and error["loc"][:-1] in words)
    ]


BOUNDS = {
    "greater_than": ("gt", "more than"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "less than"),
    "less_than_equal": ("le", "at most"),
}


OF_TYPE = {
    **dict.fromkeys(("int_type", "int_parsing", "int_from_float"), "a whole number"),
    **dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), "a mapping"),
    "finite_number": "a finite number", "string_type": "text", "list_type": "a list",
}  # fmt: skip


def _got(value: Any) -> str:
    if value is None:
        return "got nothing"
    if isinstance(value, bool):
        return f"got {str(value).lower()}"
    if isinstance(value, str):
        return f"got the text {cut(repr(value))}"
    if isinstance(value, int | float):
        return f"got {cut(str(value))}"
    return f"got a {'list' if isinstance(value, list) else 'mapping'}"


def say(model: type[BaseModel], place: Place, error: ErrorDetails, owner: str, lister: str) -> tuple[str, str | None]:
    """Return an error in plain words, and a hint; the arguments are those of `problems`, and its place in the data."""
    kind, value, ctx = error["type"], error["input"], error.get("ctx", {})
    fields = fields_at(model, place[:-1])
    info = next((fields[part] for part in reversed(place) if isinstance(part, str) and part in fields), None)
    extra = info.json_schema_extra if info is not None and isinstance(info.json_schema_extra, dict) else {}
    unit = f" {extra['unit']}" if extra.get("unit") else ""
    got = _got(value)
    if kind == "geometry":
        return ctx["reason"], None
    if kind == "unit":
        return ctx["reason"], ctx["hint"]
    if kind == "missing":
        what = "is missing"
        if info is not None and info.description:
            what += f": {info.description}" + (f" [{unit.strip()}]" if unit else "")
        return what, lister
    if kind == "extra_forbidden":
        within, word = owner if len(place) == 1 else spell(place[:-1]), str(place[-1])
        if word in fields:  # a second name of a field that is there
            return f"is the same field as {fields[word].validation_alias.choices[0]}: give one of the two", None
        similar = word.replace("*", "_star")  # T_C* is not T_C, of which it would be a misspelling
        meanings = [getattr(each, "meanings", {}) for each in _models_at(model, place[:-1])]
        meant = next((known[word.lower()] for known in reversed(meanings) if word.lower() in known), None)
        hint = f"did you mean {meant}?" if meant is not None else by_meaning(word, fields)
        if word.isdecimal() and value is None:  # {S: 1,2} has a key 2
            hint = DECIMAL_POINT
        return f"is not a field of {within}", hint or did_you_mean(similar, list(fields))
    if kind in BOUNDS:
        key, words = BOUNDS[kind]
        is_yield = unit == " Pa" and key == "ge" and ctx[key] == MIN_YIELD_STRESS and value > 0
        hint = None
        if is_yield:  # that of a steel is some hundreds of MPa
            meant = "MPa" if value < 2e3 else "kg/cm2" if value < 2e4 else "kPa"
            hint = f"did you mean {value:g} {meant}?"
        return f"must be {words} {ctx[key]:g}{unit}, {got}", hint
    if kind == "float_type" and isinstance(value, int) and not isinstance(value, bool):
        return f"is outside the range of floating-point numbers, {got}", None  # an int may be larger than any float
    if kind in ("float_type", "float_parsing"):
        return f"must be a number{f' in{unit}' if unit else ''}, {got}", _of_comma(value)
    if kind in OF_TYPE:
        return f"must be {OF_TYPE[kind]}, {got}", "put it in quotes" if kind == "string_type" else None
    if kind == "literal_error":
        number = f"a number{f' in{unit}' if unit else ''}, or " if info and float in get_args(info.annotation) else ""
        close = did_you_mean(value, re.findall("'(.*?)'", ctx["expected"])) if isinstance(value, str) else None
        hint = close if close and close.startswith("did") else None  # the message lists the other fields
        # Quotes remain around signs, ',' or ';'.
        return re.sub(r"'(-?\w.*?)'", r"\1", f"must be {number}{ctx['expected']}, {got}"), _of_comma(value) or hint
    if kind in ("too_short", "too_long"):
        least, most = ctx.get("min_length"), ctx.get("max_length")
        wanted, count = ("at least", least) if least is not None else ("at most", most)
        has = ctx["actual_length"]
        has = len(value) if has is None and isinstance(value, dict) else has  # pydantic may not count them
        return f"must have {wanted} {count} entr{'y' if count == 1 else 'ies'}, has {has}", None
    if kind == "value_error":
        return str(ctx["error"]), _of_comma(value)
    return f"{error['msg'][0].lower()}{error['msg'][1:]}", None


def _of_comma(value: Any) -> str | None:
    """Return a hint for a text that is a number with a decimal comma, with or without a unit; None for others."""
    comma = isinstance(value, str) and re.fullmatch(r"\s*[-+]?\d+(,\d+)+\s*\D*", value)
    return DECIMAL_POINT if comma else None


MEANINGS = {
    "thickness": ("width", "column_width", "base_width", "polygon"),
    "width": ("thickness", "column_width", "base_width", "polygon"),
    "height": ("column_height", "polygon"),
    "length": ("depth",),
    "weight": ("mass",),
    "unit_weight": ("density",),
    "specific_weight": ("density",),
}
"""Words for a measure of a structure, and the fields that may hold it, of which a mechanism has one at most."""


def by_meaning(word: str, fields: Mapping[str, FieldInfo]) -> str | None:
    """Return a hint on the field that holds what a word, also an Italian one, means; None if no field does."""
    from rocking_cli.io.starters import italian

    word = italian()["fields"].get(word.lower(), word)
    if word in fields:
        return f"did you mean {word}?"
    name = next((each for each in MEANINGS.get(word, ()) if each in fields), None)
    return None if name is None else f"its {word.replace('_', ' ')} is given by {name}: {fields[name].description}"


def unit_at(model: type[BaseModel], place: Place) -> str:
    """Return the unit of the number at a place in a model's data; empty if dimensionless, or if there is no field."""
    extras = [info.json_schema_extra for info, _ in _held(model, place) if info is not None]
    return next((str(extra["unit"]) for extra in extras[:1] if isinstance(extra, dict) and "unit" in extra), "")


def types_at(model: type[BaseModel], place: Place) -> set[Any]:
    """Return the elementary types allowed at a place, those in lists and unions one by one, a literal by its values."""
    return {leaf for _, annotation in _held(model, place)[:1] for leaf in _leaves(annotation)} if place else set()


def lists_models(model: type[BaseModel], place: Place) -> bool:
    """Return whether the value at a place is a list of mappings, such as `loads`."""
    held = _held(model, place)[:1] if place and isinstance(place[-1], str) else []
    return any("list[" in str(each) and any(map(_is_model, _choices(each))) for _, each in held)


def names_at(model: type[BaseModel], place: Place) -> bool:
    """Return whether the keys of the mapping at a place are chosen by the user, as those of `blocks` are."""
    return any(get_origin(each) is dict for _, annotation in _held(model, place) for each in _choices(annotation))


def is_plural(model: type[BaseModel], place: Place) -> bool:
    """Return whether the value at a place is a list or a mapping."""
    return any("list[" in str(annotation) or "dict[" in str(annotation) for _, annotation in _held(model, place))


def _leaves(annotation: Any) -> list[Any]:
    parts = get_args(annotation)
    return [leaf for part in parts for leaf in _leaves(part)] if parts else [annotation]


def fields_at(model: type[BaseModel], place: Place) -> dict[str, Any]:
    """Return the fields allowed at a place, of all models allowed there, by the names that users write."""
    return {name: info for each in _models_at(model, place) for name, info in _spelt(each).items()}


def _models_at(model: type[BaseModel], place: Place) -> list[type[BaseModel]]:
    return [each for _, annotation in _held(model, place) for each in _choices(annotation) if _is_model(each)]


def _held(model: type[BaseModel], place: Place) -> list[tuple[Any, Any]]:
    """Return the types that are allowed at a place of a model, as pairs (field, annotation).

    The field is None if the place is not named after a field, but is a key that the user chooses. Indices of lists are
    ignored.
    """
    held: list[tuple[Any, Any]] = [(None, model)]
    for part in place:
        if isinstance(part, str):
            choices = [each for _, annotation in held for each in _choices(annotation)]
            held = [(info, info.annotation) for each in choices if (info := _field(each, part)) is not None]
            held += [(None, get_args(each)[1]) for each in choices if get_origin(each) is dict]
    return held


def _choices(annotation: Any) -> list[Any]:
    """Return the models (with their other kinds), mappings and plain types that an annotation allows, also in lists."""
    if get_origin(annotation) is dict or not get_args(annotation):
        return [annotation, *(annotation.kinds() if hasattr(annotation, "kinds") else ())]
    return [inner for part in get_args(annotation) for inner in _choices(part)]


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _field(annotation: Any, name: str) -> Any:
    return _spelt(annotation).get(name) if _is_model(annotation) else None


def _spelt(model: type[BaseModel]) -> dict[str, Any]:
    """Return the fields of a model by the names that users write."""
    return {spelling: info for name, info in model.model_fields.items() for spelling in spellings(name, info)}


def spellings(name: str, info: FieldInfo) -> list[str]:
    """Return the names by which a field is read, that of this package first."""
    others = info.validation_alias
    return [str(each) for each in others.choices] if isinstance(others, AliasChoices) else [info.alias or name]
