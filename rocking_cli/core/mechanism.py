"""The base class of every mechanism plugin: say where the bodies are, the rest follows."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, ClassVar, Self

import numpy as np
from pydantic import Field, ValidationError

from rocking_cli.core import equilibrium
from rocking_cli.core.bodies import Body
from rocking_cli.core.coefficients import Coefficients, coefficients
from rocking_cli.core.fields import Described, Name, Restitution
from rocking_cli.core.kinematics import Direction, Reals, RigidMotion
from rocking_cli.core.restitution import kinematic_restitution
from rocking_cli.core.sketch import Sketch
from rocking_cli.errors import FieldError
from rocking_cli.plugins.errors import blame, guard

ANSWERS = (
    "bodies", "motion", "limit", "sketch", "coefficients", "kinetic_inertia", "potential_energy", "uplift",
    "critical_rotation", "restitution_from_kinematics", "eta",
)  # fmt: skip
"""The methods of `Mechanism` in which a plugin says or overrides what its mechanics is."""
POWERS = {"m": 1, "m2": 2, "m3": 3}  # of a length, by the unit of a field


def _is_mass(unit: object) -> bool:
    return isinstance(unit, str) and re.match(r"(kg|t)\b", unit) is not None


def _multiplied(value: Any, factor: float) -> Any:
    """A number, or every number of a list, times a factor; what is no number stays."""
    if isinstance(value, (list, tuple)):
        return type(value)(_multiplied(each, factor) for each in value)
    return value * factor if isinstance(value, float) else value


class DirectionalRestitution(Described):
    """Coefficients of restitution that differ between the two impacts."""

    positive_to_negative: Restitution = Field(description="eta of an impact that ends positive rotation")
    negative_to_positive: Restitution = Field(description="eta of an impact that ends negative rotation")


class Mechanism(Described, ABC):
    """A rocking structure with one degree of freedom.

    A plugin subclasses it, declares its geometry as fields made with `quantity`, and says in `bodies`, `motion`
    and `limit` where its rigid bodies are. Energies, uplift, critical rotation, equivalence and restitution are
    derived here; a solver may be overridden by its closed form. `sketch` may say how its picture looks.

    Where a structure gives no masses its total mass is 1 kg, so that inertias and moments are per kilogram.
    """

    mechanism: ClassVar[str]
    """The name of the mechanism, that of its entry point."""
    title: ClassVar[str]
    """What it is, in a few words."""
    source: ClassVar[str]
    """The publication and its equations."""
    verified: ClassVar[str] = ""
    """What its numbers were checked against; empty means nobody has, and the tool says so."""
    caution: ClassVar[str] = ""
    """A sentence or two, which the tool shows, on where its answers are unsafe or mean less than they seem."""
    starter: ClassVar[tuple[str, ...]] = ()
    """Optional fields that a first file needs all the same, such as one of two ways to give the masses."""

    name: Name | None = Field(None, description="what to call the structure")
    gravity: float = Field(
        9.80665, gt=0, le=1000, description="gravitational acceleration", json_schema_extra={"unit": "m/s2"}
    )
    restitution: Restitution | DirectionalRestitution | None = Field(
        None, description="coefficient of restitution eta; absent: from kinematics"
    )

    def __init__(self, /, **fields: Any) -> None:
        try:
            super().__init__(**fields)
        except ValidationError as error:
            from rocking_cli.io.field_problems import of_arguments

            raise FieldError(*of_arguments(type(self), error.errors(include_url=False), type(self).mechanism)) from None

    # As pydantic marks its own: files and copies are validated without it, and place their errors themselves.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @property
    def has_mass(self) -> bool:
        """Whether the file gives masses. Without them, moments and inertias are per kilogram of the whole structure.

        By default: whether a field is given whose unit is of mass, such as kg or kg/m3. A mechanism that knows its
        masses otherwise overrides this.
        """
        extras = {key: info.json_schema_extra for key, info in type(self).model_fields.items()}
        of_mass = [key for key, extra in extras.items() if isinstance(extra, dict) and _is_mass(extra.get("unit"))]
        return any(getattr(self, key) is not None for key in of_mass)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy with some fields changed, validated anew: what was derived from the old ones must not survive."""
        kept = {key: getattr(self, key) for key in self.model_fields_set}
        return type(self).from_fields({**kept, **(update or {})})

    @classmethod
    def from_fields(cls, fields: Mapping[str, Any]) -> Self:
        """The mechanism with these fields.

        Raises
        ------
        pydantic.ValidationError
            If they are not fields of this mechanism, or do not fit together.
        PluginError
            If a validator of the plugin fails in any other way.
        """
        with blame(f"the mechanism {cls.mechanism} failed on these fields", cls.__module__, but=ValidationError):
            return cls.model_validate(dict(fields))

    @classmethod
    def __pydantic_init_subclass__(cls, **named: Any) -> None:
        """What a subclass says of its own mechanics is guarded: whatever fails there is an error of the plugin."""
        super().__pydantic_init_subclass__(**named)
        guard(cls, ANSWERS, _failed)

    def enlarged(self, factor: float) -> Self:
        """A structure of another size: every field in m, m2 or m3 is multiplied, all else stays.

        Parameters
        ----------
        factor : float
            On every length, > 0.

        Returns
        -------
        Mechanism
            Masses and loads that are given as such do not grow with it, so that it need not behave alike.

        Raises
        ------
        pydantic.ValidationError
            If a field is then out of its bounds.
        """
        changed = {}
        for key, field in type(self).model_fields.items():
            unit = field.json_schema_extra.get("unit") if isinstance(field.json_schema_extra, dict) else None
            power = POWERS.get(str(unit))
            if power is not None:
                changed[key] = _multiplied(getattr(self, key), factor**power)
        return self.model_copy(update=changed)

    @abstractmethod
    def bodies(self) -> Sequence[Body]:
        """The rigid bodies, each rigid in both directions of rocking."""

    @abstractmethod
    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        """The motion of each body, in the order of `bodies`, over rotations `phi`, shape (n,) [rad, >= 0]."""

    @abstractmethod
    def limit(self, direction: Direction) -> float:
        """Rotation phi at which the mechanism ends: it lies on the ground or locks [rad]."""

    def sketch(self) -> Sketch:
        """What a picture shows beside the bodies and their motion; optional, by default nothing."""
        return Sketch()

    def coefficients(self, phi: Reals, direction: Direction) -> Coefficients:
        """Coefficients I, J, G, B of the equation of motion over `phi`, shape (n,) [paper, Eq. 8]."""
        phi = np.asarray(phi, dtype=np.float64)  # whole numbers too, which hold no sums of reals
        return coefficients(phi, direction, self.bodies(), self.motion(phi, direction))

    def kinetic_inertia(self, phi: Reals, direction: Direction) -> Reals:
        """I(phi) [kg m2], shape (n,): the kinetic energy is I phi.^2 / 2."""
        return self.coefficients(phi, direction).I

    def potential_energy(self, phi: Reals, direction: Direction) -> Reals:
        """V(phi) [J], shape (n,), zero at rest."""
        return self.gravity * self.coefficients(phi, direction).V

    def uplift(self, direction: Direction) -> float:
        """lambda: the ground acceleration that starts rocking, over g [paper, Eq. 10]."""
        return equilibrium.uplift_acceleration(partial(self.coefficients, direction=direction))

    def critical_rotation(self, direction: Direction) -> float:
        """phi_cr: the rotation of unstable equilibrium [rad; paper, Eq. 9]."""
        return equilibrium.critical_rotation(partial(self.coefficients, direction=direction), self.limit(direction))

    def restitution_from_kinematics(self, direction: Direction) -> float:
        """The eta of an impact that ends motion in `direction`, from the kinematics alone; it may be <= 0."""
        rest = np.zeros(1)
        return kinematic_restitution(self.bodies(), self.motion(rest, direction), self.motion(rest, direction.opposite))

    def eta(self, direction: Direction) -> float:
        """The eta of an impact that ends motion in `direction`: the user's, else that of the kinematics."""
        if isinstance(self.restitution, DirectionalRestitution):
            given = self.restitution
            return given.positive_to_negative if direction > 0 else given.negative_to_positive
        return self.restitution if self.restitution is not None else self.restitution_from_kinematics(direction)


def _failed(cls: type, method: str) -> str:
    return f"the mechanism {getattr(cls, 'mechanism', cls.__name__)} failed in {method}"
