"""Fields that every structure may have, whatever its mechanism, and how a structure is made from fields."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Never, Self, final

from pydantic import ConfigDict, Field, SerializeAsAny, ValidationError, model_validator

from rocking_cli.core.fields import Described, Name, Vertex, geometry_error, length, point, quantity
from rocking_cli.core.hung.attachments import RefusedFields
from rocking_cli.core.hung.element import Interlock, Load
from rocking_cli.core.hung.ties import Tie
from rocking_cli.core.kinematics import Direction
from rocking_cli.errors import FieldError, Problem
from rocking_cli.plugins.errors import blame

KINEMATIC = "kinematic"
"""Value of `rebound` in a file if it follows from the shape."""
NEEDS_A_SIDE = "requires one_sided: otherwise the structure rocks through to the other side"


Eta = Annotated[float, Field(gt=0, le=5)]  # `check_restitution` applies the stricter bound of a structure


class DirectionalRestitution(Described):
    """Coefficients of restitution that differ between impacts ending positive and negative rotation."""

    positive_to_negative: Eta = Field(description="eta of an impact that ends positive rotation")
    negative_to_positive: Eta = Field(description="eta of an impact that ends negative rotation")


class Crushing(Described):
    """Every pivot moves inwards by u = N/(2 strength depth), with the normal force N that it carries at rest."""

    strength: float = quantity("compressive strength", unit="Pa", example=1e6, gt=0, le=1e12)
    depth: float | None = length("length of the pivot out of plane; if omitted, that of the structure", default=None)

    @property
    def words(self) -> str:
        """Sentence, without a full stop, that crushing moves the pivots."""
        return (
            f"pivots moved inwards by crushing at {self.strength / 1e6:g} MPa under the forces at rest, and kept there "
            "over the whole motion"
        )


class Strength(Described):
    """Strength of the contacts of a structure: stress times width times depth of the structure."""

    stress: float = quantity("compressive strength of the material", unit="Pa", example=3e6, gt=0, le=1e12)
    width: float = length("width of the contact, in the plane", example=0.05)

    def force(self, depth: float) -> float:
        """Return the largest normal force of a contact [N], of a structure with depth `depth` [m]."""
        return self.stress * self.width * depth


class Uncertainty(Described):
    """Standard deviations of the measured data of a structure."""

    slenderness: float | None = quantity(
        "standard deviation of ln slenderness: usually 0.05 if measured on site, 0.03 if machined; 0.10 if omitted",
        example=0.05,
        default=None,
        ge=0,
        lt=1,
    )
    restitution: float | None = quantity(
        "standard deviation of the coefficient of restitution; by default 0.03 if restitution is given, else 0.05",
        example=0.02,
        default=None,
        ge=0,
        lt=1,
    )


class Stop(Described):
    """A rigid wall that a point of a body meets when it has moved sideways by a gap."""

    name: Name = Field("the stop", description="what to call it")
    body: Name | None = Field(None, description="the body, by its name in the picture; optional for a single body")
    point: Vertex = point("the point of the body that meets it")
    gap: float = quantity(
        "distance to it at rest, to the right of the point; negative: to the left",
        unit="m",
        example=0.05,
        ge=-1e6,
        le=1e6,
    )
    restitution: float | None = quantity(
        "rate after meeting it over that before; if omitted, time histories end there",
        example=0.3,
        default=None,
        ge=0,
        le=1,
    )


@contextmanager
def _of_arguments(cls: type[StructureFields]) -> Iterator[None]:
    """Raise a validation error of fields that are given in Python as `FieldError`."""
    try:
        yield
    except ValidationError as error:
        from rocking_cli.io.field_problems import of_arguments

        raise FieldError(*of_arguments(cls, error.errors(include_url=False), cls.mechanism)) from None


def _fields_by_name(cls: type[StructureFields]) -> Problem:
    """Return the problem of fields that are given without their names: which names there are, required ones first."""
    from rocking_cli.io.field_problems import spellings, unit_at

    required, others = list[str](), list[str]()
    own_first = sorted(cls.model_fields.items(), key=lambda item: item[0] in StructureFields.model_fields)
    for key, info in own_first:
        name = spellings(key, info)[0]
        unit = unit_at(cls, (name,))
        (required if info.is_required() else others).append(f"{name} [{unit}]" if unit else name)
    names = "; also ".join(", ".join(each) for each in (required, others) if each)
    example = ", ".join(f"{each.partition(' ')[0]}=..." for each in required)
    return Problem(f"takes its fields by name: {names}", field=cls.__name__, hint=f"such as {cls.__name__}({example})")


class StructureFields(Described):
    """Fields that every structure may have beside those of its mechanism, and properties that follow from them."""

    model_config = ConfigDict(defer_build=True)  # no structure is made of a base class, and few of most mechanisms

    refused: ClassVar[Mapping[str, str]] = {
        "dampers": "a damper is not in this version: leave it out",
        "inerters": "an inerter is not in this version: leave it out",
        "damping": "has no meaning: a structure that rocks loses energy at its impacts, by its field `restitution`",
        "opening": "is a limit of time histories, not of the structure: leave it out, give `opening` to the analysis",
    }
    meanings: ClassVar[Mapping[str, str]] = {"eta": "restitution", "g": "gravity", "mu": "friction"}
    """Symbols of fields, by which they are not read but found."""
    mechanism: ClassVar[str]
    """The name of the mechanism, that of its entry point."""

    _weights: ClassVar[Sequence[str]] = ()
    """Remarks on weights that were read as masses; a structure made by `from_fields` has its own remarks."""
    _folder: ClassVar[Path | None] = None
    """Folder of the files that fields name; a structure made by `from_fields` has its own."""

    name: Name | None = Field(None, description="what to call the structure")
    gravity: float = Field(
        9.80665, gt=0, le=1000, description="gravitational acceleration", json_schema_extra={"unit": "m/s2"}
    )
    restitution: Eta | DirectionalRestitution | None = Field(
        None, description="coefficient of restitution eta; computed from kinematics if omitted"
    )
    density: float | None = quantity(
        "density; with depth it gives the masses", unit="kg/m3", example=1800.0, default=None, gt=0, le=1e6
    )
    depth: float | None = quantity("size out of plane", unit="m", example=1.0, default=None, gt=0, le=1e6)
    mass: float | None = quantity("mass of the whole structure", unit="kg", example=5000.0, default=None, gt=0, le=1e15)
    one_sided: Literal["positive", "negative"] | None = Field(
        None,
        examples=["positive"],
        description="the only direction it rocks in, such as away from side walls that it leans on",
    )
    rebound: float | None = quantity(
        "rate after an impact on them over that before; of a plain rectangle also `kinematic`",
        example=0.5,
        default=None,
        ge=0,
        lt=1,
    )
    loads: list[Load] | None = Field(
        None,
        max_length=1000,
        examples=[[{"name": "floor", "mass": 1000.0, "at": [0.0, 2.0]}]],
        description="masses and forces on the structure; `rocking mechanisms loads` lists their fields",
    )
    ties: list[SerializeAsAny[Tie]] | None = Field(
        None,
        max_length=1000,
        examples=[[{"name": "bar", "from": {"ground": [-3.0, 2.0]}, "to": {"at": [0.0, 2.0]}, "stiffness": 1e6}]],
        description="ties, tendons and springs; `rocking mechanisms ties` lists their fields",
    )
    crushing: Crushing | None = Field(
        None,
        examples=[{"strength": 1e6}],
        description="crushing strength at the pivots, which then move inwards; `rocking mechanisms crushing` lists its "
        "fields",
    )
    interlock: Interlock | None = Field(
        None,
        examples=[{"courses": 10, "overlap": 0.2, "thickness": 0.5, "walls": 2, "height": 2.0}],
        description="friction of walls that cross it; `rocking mechanisms interlock` lists its fields",
    )
    friction: float | None = quantity(
        "coefficient of friction of its joints, which time histories are checked against",
        example=0.6,
        default=None,
        gt=0,
        le=10,
    )
    stops: list[Stop] | None = Field(
        None,
        max_length=100,
        examples=[[{"point": [0.35, 2.8], "gap": 0.05, "restitution": 0.3}]],
        description="walls that it meets as it rocks; `rocking mechanisms stops` lists their fields",
    )
    uncertainty: Uncertainty | None = Field(
        None,
        examples=[{"slenderness": 0.05, "restitution": 0.02}],
        description="how well it is known; `rocking mechanisms uncertainty` lists its fields",
    )
    unusual: list[Name] | None = Field(None, examples=[["width"]], description="fields whose unusual values are meant")
    strength: Strength | None = Field(
        None,
        examples=[{"stress": 3e6, "width": 0.05}],
        description="strength of its contacts; `rocking mechanisms strength` lists its fields",
    )

    @model_validator(mode="before")
    @classmethod
    def _rebound_from_impacts(cls, data: Any) -> Any:
        """Treat `rebound: kinematic` as a rebound that is not given, so that the theory of impacts gives it."""
        if not isinstance(data, dict) or data.get("rebound") != KINEMATIC:
            return data
        if data.get("one_sided") is None:
            raise geometry_error("rebound", NEEDS_A_SIDE)
        return {**data, "rebound": None}

    @model_validator(mode="after")
    def _crushes_under_a_weight(self) -> Self:
        if self.crushing is not None and not self.has_mass:
            raise geometry_error("crushing", "needs the weight of the structure: give density and depth, or its mass")
        if self.crushing is not None and self.crushing.depth is None and self.depth is None:
            raise geometry_error(("crushing", "depth"), "is missing: give the length of the pivot out of plane")
        return self

    def __init__(self, /, *by_place: Never, **fields: Any) -> None:
        if by_place:
            raise FieldError(_fields_by_name(type(self)))
        with _of_arguments(type(self)):
            super().__init__(**fields)
            self._hold_together()

    # With this mark, Pydantic validates files and copies without calling `__init__`.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @final
    def replace(self, /, **fields: Any) -> Self:
        """Return a new structure with other values of some fields; all other fields are kept.

        Parameters
        ----------
        **fields
            Values by field, as where a structure is made: numbers in SI units, or texts with units; None for a field
            that is no longer given.

        Raises
        ------
        InputError
            If they are not valid fields of this mechanism, or do not fit together with those that are kept.

        Examples
        --------
        >>> import rocking_cli as rk
        >>> block = rk.Block(name="pillar", width=0.7, height=2.8)
        >>> block.replace(height="3 m", restitution=0.9)
        Block(name='pillar', restitution=0.9, width=0.7, height=3.0)
        """
        with _of_arguments(type(self)):
            return self.model_copy(update=fields)

    def __replace__(self, /, **fields: Any) -> Self:
        return self.replace(**fields)

    @final
    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy as `replace` does, but raise `pydantic.ValidationError`."""
        changed, fields = update or {}, type(self).model_fields
        kept = {key: getattr(self, key) for key in self.model_fields_set if key not in changed}
        if not changed.keys() <= fields.keys():  # perhaps other spellings of fields
            from rocking_cli.io.field_problems import spellings

            kept = {key: value for key, value in kept.items() if changed.keys().isdisjoint(spellings(key, fields[key]))}
        copy = type(self).from_fields({**kept, **changed}, self._folder)
        if set(changed) <= {"name", "ties"}:
            vars(copy)["_weights"] = self._weights
        return copy

    @final
    @classmethod
    def from_fields(
        cls, fields: Mapping[str, Any], folder: Path | None = None, checked: Callable[[], object] | None = None
    ) -> Self:
        """Make a structure of this mechanism from its fields.

        Parameters
        ----------
        fields : mapping
            Names and values of the fields.
        folder : Path, optional
            Folder of the files that fields name, by default the current one; `folder` in the context of the validation.
        checked : callable, optional
            Called when the fields are valid, before the structure is analysed, which may take long.

        Raises
        ------
        pydantic.ValidationError
            If they are not valid fields of this mechanism, or do not fit together.
        PluginError
            If a validator of the plugin fails in any other way.
        """
        with blame(f"the mechanism {cls.mechanism} failed on these fields", cls.__module__, but=ValidationError):
            # Validators add a remark to "weights" for each weight that they read as a mass.
            context: dict[str, Any] = {"folder": folder, "weights": []}
            structure = cls.model_validate(dict(fields), context=context)
            # Kept like cached properties: they are no fields, and do not count where structures are compared.
            vars(structure).update(_weights=list(dict.fromkeys(context["weights"])), _folder=folder)
            if checked is not None:
                checked()
            structure._hold_together()
            return structure

    def __eq__(self, other: object) -> bool:
        """Compare the fields alone: what is derived from them may be arrays."""
        if type(self) is not type(other):
            return NotImplemented
        return all(getattr(self, key) == getattr(other, key) for key in type(self).model_fields)

    def _hold_together(self) -> None:
        """Raise `ValidationError` with the fields that do not fit together; here, none."""

    @property
    def remarks(self) -> Sequence[str]:
        """Sentences, without a full stop, on weights that were read as masses, and on masses per metre."""
        depth = self.depth or 0.0
        over = [
            f"{load.name}: {load.on_a_metre:.6g} kg/m over a depth of {depth:g} m is "
            f"{load.on_a_metre * depth:.6g} kg{load.carried_in_words}"
            for load in self.loads or () if load.on_a_metre is not None
        ]  # fmt: skip
        return [*self._weights, *over]

    @property
    def restitution_is_kinematic(self) -> bool:
        """Whether the restitution follows from the shape, as none is given (of one-sided rocking: the rebound)."""
        return (self.restitution if self.rocks_both_ways else self.rebound) is None

    @property
    def directions(self) -> Sequence[Direction]:
        """Directions in which the structure can rock."""
        return list(Direction) if self.one_sided is None else [Direction[self.one_sided.upper()]]

    @property
    def sides(self) -> tuple[Direction, Direction]:
        """Directions of positive and of negative motion; the same direction twice if it rocks to one side only."""
        return self.directions[0], self.directions[-1]

    @property
    def rocks_both_ways(self) -> bool:
        """Whether the structure rocks to both sides, without a support that prevents one."""
        return self.one_sided is None

    @property
    def has_mass(self) -> bool:
        """Whether the structure has masses; without them, moments and inertias are per kilogram of its total mass.

        By default, whether a field with a unit of mass, such as kg or kg/m3, is given. A mechanism that has its masses
        from elsewhere overrides this property.
        """
        for key, info in type(self).model_fields.items():
            unit = info.json_schema_extra.get("unit") if isinstance(info.json_schema_extra, dict) else None
            if isinstance(unit, str) and re.match(r"(kg|t)\b", unit) and getattr(self, key) is not None:
                return True
        return False

    @property
    def is_laden(self) -> bool:
        """Whether loads, ties or crossing walls are given."""
        return bool(self.loads or self.ties or self.interlock)

    @property
    def given_depth(self) -> float:
        """Size out of plane [m], which `density` requires. Raises `RefusedFields` if it is not given."""
        if self.depth is None:
            raise RefusedFields((), "depth", "is missing: density needs the size out of plane")
        return self.depth
