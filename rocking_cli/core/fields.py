"""Field types of structure files: quantities with units, lengths and names, and errors that point at a field."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Self

from pydantic import (
    AfterValidator,
    AliasChoices,
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import InitErrorDetails, PydanticCustomError, PydanticKnownError

from rocking_cli.short_repr import MAX_LENGTH, line_of
from rocking_cli.text import cut, is_one_line
from rocking_cli.units import STANDARD_GRAVITY, UnitError, mass_of_weight, read, split


def _shown_as_it_is(name: str) -> str:
    if not name.strip():
        raise ValueError("is empty")
    if not is_one_line(name):
        raise ValueError(f"must be printable characters in one line, got {cut(repr(name))}")
    return name


Restitution = Annotated[float, Field(gt=0, le=1)]
Name = Annotated[str, AfterValidator(_shown_as_it_is)]
"""A name given by the user, shown on terminals, in plots and on pages."""


MIN_BY_UNIT = {
    "m": 1e-6, "m2": 1e-12, "m3": 1e-18, "s": 1e-6, "kg": 1e-6, "kg/m": 1e-6, "kg/m2": 1e-6, "kg/m3": 1e-6,
    "kg m2": 1e-18, "N/m3": 1e-6, "Pa": 1e-3, "m/s2": 1e-6, "g": 1e-6, "deg": 1e-6, "years": 1e-6,
}  # fmt: skip
"""Least value of a quantity that must be positive, by its unit: far below any structure, far above underflow."""


LENGTH_POWERS = {"m": 1, "m2": 2, "m3": 3, "kg m2": 2, "kg/m": -1, "kg/m2": -2, "force_per_metre": -1}
"""Power of a scale factor on lengths, by a field or its unit; a load per metre falls, so that the whole stays."""


def quantity(
    description: str,
    *,
    unit: str = "",
    columns: Sequence[str] = (),
    symbol: str = "",
    example: Any = None,
    **bounds: Any,
) -> Any:
    """Declare a numeric field of a mechanism: its description, unit, symbol, example and bounds.

    Parameters
    ----------
    description : str
        What the field is, a few words.
    unit : str
        SI unit of the field, or degrees if its name says so; empty if dimensionless. A plain number is in this unit,
        and a text such as `800 mm` may have any unit of the same quantity, see `rocking_cli.units`; a dimensionless
        number may be a percentage, `5 %`.
    columns : sequence of str
        Units of the columns of a table instead.
    symbol : str
        The paper's symbol.
    example : any
        A valid value, printed by `rocking new`.
    **bounds
        Passed to `pydantic.Field`: `gt`, `ge`, `lt`, `le`, `default`, ...
    """
    extra: Any = {"unit": unit, "columns": [*columns], "symbol": symbol}
    return Field(description=description, examples=[example], json_schema_extra=extra, **bounds)


def length(description: str, *, symbol: str = "", example: Any = None, **bounds: Any) -> Any:
    """Declare a field in metres: positive, and at most a million, so that nothing overflows.

    Values in metres that were meant as millimetres are not found here: see `rocking_cli.core.mechanism`.
    """
    return quantity(description, unit="m", symbol=symbol, example=example, gt=0, le=1e6, **bounds)


def along_wall(description: str) -> Any:
    """Declare the `depth` of a wall, its length out of plane, which is read as `length` too."""
    names = AliasChoices("depth", "length")
    return length(description, example=1.0, default=None, validation_alias=names)


def geometry_error(field: str | tuple[str | int, ...], message: str) -> PydanticCustomError:
    """Return an error that a validator raises if fields are valid one by one but do not fit together.

    Parameters
    ----------
    field : str or tuple
        The field at fault, or the path to an entry in it: `("parts", 2, "polygon")`.
    message : str
        What is wrong and what would be right.
    """
    # Pydantic formats the message and would interpret braces.
    return PydanticCustomError(
        "geometry", "{reason}", {"reason": message, "field": (field,) if isinstance(field, str) else field}
    )


def in_unit(value: Any, units: str | Sequence[str], weights: list[str]) -> Any:
    """Return a value, or nested lists of values, with each text such as `800 mm` replaced by its number in its unit.

    Several units are those of columns. Other values stay as they are. A weight for a mass is divided by standard
    gravity, and `weights` receives a remark on it. Raises `ValidationError` with the places of all texts whose unit
    is wrong.
    """
    wrong: list[InitErrorDetails] = []

    def number(each: Any, place: tuple[int, ...]) -> Any:
        if isinstance(each, list | tuple):
            items = [number(item, (*place, k)) for k, item in enumerate(each)]
            return tuple(items) if isinstance(each, tuple) else items
        parts = split(each) if isinstance(each, str) else None
        unit = units if isinstance(units, str) else dict(enumerate(units)).get(place[-1] if place else 0, "")
        if parts is None or not parts[1] or not (unit or parts[1] == "%"):
            return each
        try:
            mass = mass_of_weight(each, unit)
            if mass is None:
                return read(each, unit)
            weights.append(
                f"{each} is a weight, taken as a mass: {mass:.6g} {unit} (divided by {STANDARD_GRAVITY} m/s2)"
            )
            return mass
        except UnitError as error:
            problem = PydanticCustomError("unit", "{reason}", {"reason": error.message, "hint": error.hint})
            wrong.append(InitErrorDetails(type=problem, loc=place, input=each))
            return each

    converted = number(value, ())
    if wrong:
        raise ValidationError.from_exception_data("quantity", wrong)
    return converted


def units_of_field(field: FieldInfo) -> Any:
    """Return the unit of a field, or those of its columns; None if it is not a quantity."""
    extra = field.json_schema_extra
    return extra.get("columns") or extra.get("unit", "") if isinstance(extra, dict) else None


def least(field: FieldInfo) -> float:
    """Return the least value of a field that must be positive; 0 if it need not be, or has no unit."""
    extra = field.json_schema_extra
    positive = any(getattr(rule, "gt", None) == 0 for rule in field.metadata)
    return MIN_BY_UNIT.get(str(extra.get("unit")), 0.0) if positive and isinstance(extra, dict) else 0.0


def _multiplied(value: Any, factor: float, power: int) -> Any:
    """Return a value for another size: its numbers times the factor to the power of length in their unit."""
    if isinstance(value, Described):
        return value.enlarged(factor)
    if isinstance(value, list | tuple):
        return type(value)(_multiplied(each, factor, power) for each in value)
    if isinstance(value, dict):
        return {key: _multiplied(each, factor, power) for key, each in value.items()}
    return value * factor**power if power and isinstance(value, float) else value


class Described(BaseModel):
    """Base class of what users describe by fields: refuses unknown fields, and reads texts with units."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)
    refused: ClassVar[Mapping[str, str]] = {}
    """Keys that are refused, such as those of planned fields, with the message of each."""

    @model_validator(mode="before")
    @classmethod
    def _no_such_field(cls, data: Any) -> Any:
        for key, reason in cls.refused.items():
            if isinstance(data, dict) and key in data and key not in cls.model_fields:
                raise geometry_error(key, reason)
        return data

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        """Yield the fields that were given, without those at their defaults."""
        return ((key, getattr(self, key)) for key in type(self).model_fields if key in self.model_fields_set)

    def __repr__(self) -> str:
        whole = super().__repr__()
        return whole if len(whole) <= MAX_LENGTH else line_of(self)

    __str__ = __repr__

    def enlarged(self, factor: float) -> Self:
        """Return a copy for a structure of another size: fields in m, m2, m3 or kg m2 are multiplied, others stay.

        Parameters
        ----------
        factor : float
            Factor on every length, > 0.

        Returns
        -------
        Described
            The copy for the new size. Given masses and loads stay the same, so that the behaviour of a structure need
            not scale; the positions of loads and ties are multiplied.

        Raises
        ------
        pydantic.ValidationError
            If a field of a structure is then out of its bounds.
        """
        changed = {}
        for key, info in type(self).model_fields.items():
            extra, value = info.json_schema_extra, getattr(self, key)
            unit = str(extra.get("unit")) if isinstance(extra, dict) else ""
            power = LENGTH_POWERS.get(key, LENGTH_POWERS.get(unit, 0))
            if (new := _multiplied(value, factor, power)) != value:
                changed[key] = new
        return self.model_copy(update=changed)

    @field_validator("*", mode="before")
    @classmethod
    def _with_a_unit(cls, value: Any, info: ValidationInfo) -> Any:
        """Convert texts with units to numbers in every field that has a unit, and tuples and arrays to lists."""
        value = value.tolist() if hasattr(value, "tolist") else value
        if isinstance(value, tuple) and "list[" in str(cls.model_fields[info.field_name or ""].annotation):
            value = list(value)
        if not isinstance(value, str | list | tuple):
            return value
        units, weights = units_of_field(cls.model_fields[info.field_name or ""]), list[str]()
        if units is not None:
            value = in_unit(value, units, weights)
        if info.context is not None:
            info.context["weights"] += weights
        return value

    @field_validator("*", mode="after")
    @classmethod
    def _not_too_small(cls, value: Any, info: ValidationInfo) -> Any:
        """Refuse a positive quantity so small that quantities derived from it would underflow to zero."""
        if isinstance(value, float) and 0 < value < least(cls.model_fields[info.field_name or ""]):
            raise PydanticKnownError("greater_than_equal", {"ge": least(cls.model_fields[info.field_name or ""])})
        return value


Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
Vertex = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
"""A point of the plane [x, y]."""


def point(description: str, **bounds: Any) -> Any:
    """Declare a field for a point [x, y] in metres, in the coordinates of the structure's drawing."""
    return quantity(description, unit="m", example=[0.0, 0.0], **bounds)
