"""The base class of every mechanism plugin: say where the bodies are, the rest follows."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, partial, wraps
from inspect import isfunction
from math import nan, sqrt
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field, ValidationError, model_validator

from rocking_cli.core import equilibrium
from rocking_cli.core.attached import Attached, ConstantForce, Follow, PointMass, Spring, springs_of
from rocking_cli.core.attachments import (
    Carrier,
    Loc,
    Refused,
    as_validation_error,
    attach,
    check_stretched,
    far_off,
    followed,
)
from rocking_cli.core.bodies import Body, weighed
from rocking_cli.core.coefficients import Coefficients, coefficients
from rocking_cli.core.collapse import CollapseMechanism
from rocking_cli.core.contacts import Contact, Piece, of_joints
from rocking_cli.core.crushing import Crushing, pressing
from rocking_cli.core.extras import Extra
from rocking_cli.core.fields import Described, Name, geometry_error, quantity
from rocking_cli.core.interlock import NAME as INTERLOCK
from rocking_cli.core.interlock import Interlock
from rocking_cli.core.joints import Joint
from rocking_cli.core.kinematics import Direction, Reals, RigidMotion
from rocking_cli.core.loads import Load
from rocking_cli.core.restitution import kinematic_restitution
from rocking_cli.core.sketch import Outline, Sketch
from rocking_cli.core.strength import Strength
from rocking_cli.core.ties import Tie
from rocking_cli.core.uncertainty import Uncertainty
from rocking_cli.errors import FieldError, InputError, Problem
from rocking_cli.plugins.errors import blame, guard

ANSWERS = (
    "bodies", "motion", "limit", "sketch", "joints", "pieces", "piece_at", "contacts", "alike", "volume", "total_mass",
    "carries", "extras", "bearing",
    "coefficients", "kinetic_inertia", "potential_energy", "uplift", "rebound_from_impacts", "critical_rotation",
    "restitution_from_kinematics", "eta",
)  # fmt: skip
"""The methods of `Mechanism` in which a plugin says or overrides what its mechanics is."""
OF_THE_BARE = (
    "coefficients", "kinetic_inertia", "potential_energy", "uplift", "critical_rotation", "restitution_from_kinematics",
)  # fmt: skip
"""Those whose overrides are closed forms of the bare mechanism: with loads or ties the general solvers answer."""
KINEMATIC = "kinematic"
"""What a file says of a rebound that follows from the shape."""
NEEDS_A_SIDE = "requires one_sided: otherwise the structure rocks through to the other side"
LATER = {"dampers": "a damper", "inerters": "an inerter"}
"""What structures will have one day, and is refused by name until then."""
ROUNDING = 1e-9  # by which a restitution may exceed its bound, which the kinematic one of equal sides reaches
POWERS = {"m": 1, "m2": 2, "m3": 3, "kg m2": 2}  # of a length, by the unit of a field


def _is_mass(unit: object) -> bool:
    return isinstance(unit, str) and re.match(r"(kg|t)\b", unit) is not None


def _multiplied(value: Any, factor: float) -> Any:
    """A number, or every number of a list, times a factor; what is no number stays."""
    if isinstance(value, (list, tuple)):
        return type(value)(_multiplied(each, factor) for each in value)
    return value * factor if isinstance(value, float) else value


Eta = Annotated[float, Field(gt=0, le=5)]  # how much it may be at most depends on the structure


class DirectionalRestitution(Described):
    """Coefficients of restitution that differ between the two impacts."""

    positive_to_negative: Eta = Field(description="eta of an impact that ends positive rotation")
    negative_to_positive: Eta = Field(description="eta of an impact that ends negative rotation")


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
    ties: list[Tie] | None = Field(
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
    uncertainty: Uncertainty | None = Field(
        None,
        examples=[{"slenderness": 0.05, "restitution": 0.02}],
        description="how well it is known; `rocking mechanisms uncertainty` lists its fields",
    )
    opening: float = quantity(
        "largest opening or slip of a joint up to which a time history holds, over the displacement at phi_cr",
        example=0.005,
        default=0.005,
        ge=0,
        le=1000,
    )
    strength: Strength | None = Field(
        None,
        examples=[{"stress": 3e6, "width": 0.05}],
        description="strength of its contacts; `rocking mechanisms strength` lists its fields",
    )

    @model_validator(mode="before")
    @classmethod
    def _not_yet(cls, data: Any) -> Any:
        for key in LATER:
            if isinstance(data, dict) and key in data and key not in cls.model_fields:
                raise geometry_error(key, f"{LATER[key]} is not in this version: leave it out")
        return data

    @model_validator(mode="before")
    @classmethod
    def _rebound_from_impacts(cls, data: Any) -> Any:
        """Leave `rebound: kinematic` to the theory of impacts, as if it were not given."""
        if not isinstance(data, dict) or data.get("rebound") != KINEMATIC:
            return data
        if data.get("one_sided") is None:
            raise geometry_error("rebound", NEEDS_A_SIDE)
        return {**data, "rebound": None}

    def __init__(self, /, **fields: Any) -> None:
        try:
            super().__init__(**fields)
            self._hold_together()
        except ValidationError as error:
            from rocking_cli.io.field_problems import of_arguments

            raise FieldError(*of_arguments(type(self), error.errors(include_url=False), type(self).mechanism)) from None

    # As pydantic marks its own: files and copies are validated without it, and place their errors themselves.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @property
    def restitution_is_kinematic(self) -> bool:
        """Whether no restitution is given, so that it follows from the shape."""
        return (self.restitution if self.rocks_both_ways else self.rebound) is None

    @property
    def directions(self) -> Sequence[Direction]:
        """The directions it can rock in."""
        return list(Direction) if self.one_sided is None else [Direction[self.one_sided.upper()]]

    @property
    def sides(self) -> tuple[Direction, Direction]:
        """The directions that stand for positive and negative motion; where there is one only, it does for both."""
        return self.directions[0], self.directions[-1]

    @property
    def rocks_both_ways(self) -> bool:
        """Whether no support keeps it to one side."""
        return self.one_sided is None

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
    def from_fields(cls, fields: Mapping[str, Any], folder: Path | None = None) -> Self:
        """The mechanism with these fields.

        Parameters
        ----------
        fields : mapping
            Names and values.
        folder : Path, optional
            Where files that fields name are, by default here: `folder` in the context of the validation.

        Raises
        ------
        pydantic.ValidationError
            If they are not fields of this mechanism, or do not fit together.
        PluginError
            If a validator of the plugin fails in any other way.
        """
        with blame(f"the mechanism {cls.mechanism} failed on these fields", cls.__module__, but=ValidationError):
            made = cls.model_validate(dict(fields), context={"folder": folder})
            made._hold_together()
            return made

    def _hold_together(self) -> None:
        """Check the masses, loads and ties against the bodies; raise `ValidationError` of the fields."""
        try:
            if self.mass is not None and self.density is not None:
                raise Refused((), "mass", "give mass, or density and depth: one of them")
            self._check_crushing()
            self._check_one_sided()
            self._check_restitution()
            self._mass_factor  # noqa: B018 - a density without a volume is refused here
            self._check_strength()
            if not self._is_laden:
                return
            if not self.has_mass:
                key = "loads" if self.loads else "ties" if self.ties else "interlock"
                raise Refused((), key, "the structure has no masses: give density and depth, or its mass")
            tied = [thing for _, thing in self._hung if springs_of(thing)]
            limits = {direction: self.limit(direction) for direction in self.directions} if tied else {}
            follow = {direction: partial(self.followed, direction=direction) for direction in Direction}
            for loc, thing in self._hung:
                check_stretched(loc, thing, follow, limits)
            self._check_stands()
        except Refused as error:
            raise as_validation_error([error], self.mechanism) from error

    @model_validator(mode="after")
    def _crushes_under_a_weight(self) -> Self:
        if self.crushing is not None and not self.has_mass:
            raise geometry_error("crushing", "needs the weight of the structure: give density and depth, or its mass")
        if self.crushing is not None and self.crushing.depth is None and self.depth is None:
            raise geometry_error(("crushing", "depth"), "is missing: give the length of the pivot out of plane")
        return self

    def _check_crushing(self) -> None:
        if self.crushing is None:
            return
        if not self._inwards:
            reason = (
                "its pivots cannot be moved in this version, only those of single bodies and of walls: leave it out"
            )
            raise Refused((), "crushing", reason)
        for direction in self.directions:
            if not self.coefficients(np.zeros(1), direction).restoring(self.gravity)[0] > 0:
                far = max(self._inwards[direction].values())
                reason = f"the structure cannot stand on what is left: a pivot moves inwards by {far:.4g} m"
                raise Refused((), "crushing", reason)

    def _check_one_sided(self) -> None:
        if self.one_sided is None and self.rebound is not None:
            raise Refused((), "rebound", NEEDS_A_SIDE)
        if self.one_sided is not None and self.restitution is not None:
            raise Refused((), "restitution", "cannot be combined with `one_sided`: give `rebound` instead")
        asked = "rebound" in self.model_fields_set and self.rebound is None
        if self.one_sided is not None and asked and self.rebound_from_impacts() is None:
            why = "only for a plain rectangle does it follow from the shape; give a number in [0, 1)"
            raise Refused((), "rebound", f"cannot be {KINEMATIC}: {why}")

    def _check_strength(self) -> None:
        if not isinstance(self.strength, Strength):  # None, or a field of a plugin of that name
            return
        if not self.has_mass:
            raise Refused((), "strength", "the structure has no masses: give density and depth, or its mass")
        if self.depth is None:
            raise Refused((), "depth", "is missing: the contacts are as long as the structure is deep")

    def _check_restitution(self) -> None:
        """Refuse a restitution with which an impact would add energy."""
        if self.restitution is None:
            return
        for direction in Direction:
            eta, most = self.eta(direction), self.greatest_restitution(direction)
            if eta > most * (1 + ROUNDING):
                field = "restitution"
                if isinstance(self.restitution, DirectionalRestitution):
                    field = "positive_to_negative" if direction > 0 else "negative_to_positive"
                reason = f"must be at most {most:.6g}, got {eta:g}: a larger value would add energy at an impact"
                raise Refused(() if field == "restitution" else ("restitution",), field, reason)

    def _check_stands(self) -> None:
        """Refuse loads and ties under which the structure does not stand though it stands by itself."""
        lifted = sum(thing.force.imag for thing in self.attached if isinstance(thing, ConstantForce))
        borne = sum(thing.mass * thing.weight for thing in self.attached if isinstance(thing, PointMass))
        weight = self.gravity * (sum(body.mass for body in self.weighed()) + borne)
        if lifted >= weight:
            reason = f"forces lift it by {lifted:.4g} N, more than all of its weight, {weight:.4g} N"
            raise Refused((), "loads", reason)
        for direction in self.directions:
            here = self.coefficients(np.zeros(1), direction)
            own = coefficients(np.zeros(1), direction, self.bodies(), self.motion(np.zeros(1), direction))
            if own.G[0] > 0 and not here.restoring(self.gravity)[0] > 0:
                raise Refused(
                    (),
                    "loads" if self.loads else "ties",
                    f"the structure cannot stand under them: at rest they turn it in the {direction.label} direction "
                    f"with {-here.restoring(self.gravity)[0] * self.gravity:.4g} N m more than its weight holds",
                )

    @classmethod
    def __pydantic_init_subclass__(cls, **named: Any) -> None:
        """What a subclass says of its own mechanics is guarded: whatever fails there is an error of the plugin."""
        super().__pydantic_init_subclass__(**named)
        guard(cls, ANSWERS, _failed, but=Refused)
        for name in OF_THE_BARE:
            if isfunction(own := vars(cls).get(name)):
                setattr(cls, name, _of_the_bare(own))

    def enlarged(self, factor: float) -> Self:
        """A structure of another size: every field in m, m2, m3 or kg m2 is multiplied, all else stays.

        Parameters
        ----------
        factor : float
            On every length, > 0.

        Returns
        -------
        Mechanism
            Masses and loads that are given as such do not grow with it, so that it need not behave alike; where loads
            and ties are is multiplied.

        Raises
        ------
        pydantic.ValidationError
            If a field is then out of its bounds.
        """
        changed: dict[str, Any] = {}
        for key, field in type(self).model_fields.items():
            unit = field.json_schema_extra.get("unit") if isinstance(field.json_schema_extra, dict) else None
            power, value = POWERS.get(str(unit)), getattr(self, key)
            if power is not None:
                changed[key] = _multiplied(value, factor**power)
            elif isinstance(value, list) and value and hasattr(value[0], "enlarged"):
                changed[key] = [thing.enlarged(factor) for thing in value]
            elif isinstance(value, dict) and any(hasattr(thing, "enlarged") for thing in value.values()):
                changed[key] = {name: thing.enlarged(factor) for name, thing in value.items()}
            elif hasattr(value, "enlarged"):
                changed[key] = value.enlarged(factor)
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

    def _shapes(self) -> Sketch:
        """Sketch of the shapes of its bodies, before anything is attached to them."""
        return self.sketch()

    def joints(self, direction: Direction) -> Sequence[Joint]:
        """Where bodies bear on the ground and on one another, for the check of a history; by default unknown."""
        return ()

    def pieces(self, direction: Direction) -> Sequence[Piece]:
        """The rigid blocks between its joints, those that stay closed among them; by default its bodies."""
        return [Piece(body, body.name) for body in self.weighed()]

    def piece_at(self, body: str, at: complex, direction: Direction) -> str:
        """The piece on which a point of a body is; by default the body."""
        return body

    def contacts(self, direction: Direction) -> Sequence[Contact] | None:
        """The joints between its pieces, and with the ground, as they bear in a direction; None if they are not known.

        Time histories are checked against them. By default they are the `joints` of a single body: of several bodies it
        is not known which joints stay closed, so that their histories are not checked.
        """
        joints = self.joints(direction)
        return of_joints(joints, self.friction) if joints and len(self.bodies()) == 1 else None

    def alike(self) -> Mapping[str, int]:
        """Of bodies that stand for several which move alike: how many, by their names; by default none does."""
        return {}

    def collapse(self, direction: Direction) -> CollapseMechanism | None:
        """The weakest mechanism of a direction, of a structure that searched for it; by default none did."""
        return None

    def piece(self, body: str, at: complex) -> str:
        """The body that a point is on, of one that is in pieces where it cracked; by default none is."""
        return body

    def carries(self) -> Sequence[Attached]:
        """Return what its own fields attach beside loads and ties, such as the floor on a wall; by default nothing."""
        return ()

    def cautions(self) -> Sequence[str]:
        """What to bear in mind with its results, a text each: the `caution` of its kind, and its own."""
        return [text for text in (self.caution, self.own_caution()) if text]

    def own_caution(self) -> str:
        """What to bear in mind with the results of this very structure; by default nothing."""
        return ""

    def extras(self, direction: Direction) -> Sequence[Extra]:
        """What it found on the way and users want to know, such as where it hinges; shown by `equiv`."""
        return ()

    def bearing(self, direction: Direction) -> Mapping[str, float]:
        """The normal force at rest of each joint that `crushing` moves, by its name [N]; none if it can move none.

        Asked of the structure without crushing; a mechanism that gives some moves them by `inwards`.
        """
        return {}

    def borne(self, direction: Direction, *bodies: str) -> float:
        """Return the weight at rest of some bodies, or of all, with what is attached to them [N]."""
        on = bodies or tuple(body.name for body in self.bodies())
        weight = self.gravity * sum(body.mass for body in self.weighed() if body.name in on)
        return weight + pressing(self.attached, on, direction, self.followed(np.zeros(1), direction), self.gravity)

    def inwards(self, direction: Direction, joint: str) -> float:
        """How far crushing moves a joint inwards [m], over the whole motion."""
        return self._inwards[direction][joint] if self.crushing is not None else 0.0

    @cached_property
    def _inwards(self) -> Mapping[Direction, Mapping[str, float]]:
        """u = N/(2 strength depth) of the joints of each direction [m]; empty if there is none to move."""
        if self.crushing is None:
            return {}
        try:
            sound = self.model_copy(update={"crushing": None})
        except ValidationError as error:
            raise Refused.first_of(error) from None
        per_metre = 2 * self.crushing.strength * (self.crushing.depth or self.depth or 1.0)
        moved = {direction: sound.bearing(direction) for direction in Direction}
        found = {s: {joint: max(force, 0.0) / per_metre for joint, force in moved[s].items()} for s in Direction}
        return found if all(found.values()) else {}

    def found(self, direction: Direction) -> Sequence[Extra]:
        """All that it found: `extras`, and how far its pivots are moved."""
        what = "how far crushing moves the {} inwards"
        moved = self._inwards.get(direction, {}).items()
        return [*self.extras(direction), *(Extra(f"inwards_{key}", u, "m", what.format(key)) for key, u in moved)]

    @property
    def crushed(self) -> str | None:
        """That its pivots are moved, as a sentence without a full stop; None if they are not."""
        if self.crushing is None:
            return None
        return (
            f"pivots moved inwards by crushing at {self.crushing.strength / 1e6:g} MPa under the forces at rest, and "
            "kept there over the whole motion"
        )

    def volume(self) -> float:
        """The volume that `density` makes the mass of [m3]: by default that of the outlines, `depth` deep."""
        deep, sketch = self._given_depth, self.sketch()
        area = 0.0
        for body in self.bodies():
            known: Sequence[Outline] = sketch.outlines.get(body.name, ()) if sketch.uniform else ()
            shapes = [body.outline] if body.outline else known
            if not shapes:
                raise Refused((), "density", f"the shape of its {body.name} is not known: give its mass instead")
            area += sum(abs(_area(shape)) for shape in shapes)
        return area * deep

    @property
    def _given_depth(self) -> float:
        """Size out of plane that `density` needs [m]. Raises `Refused` if the file gives none."""
        if self.depth is None:
            raise Refused((), "depth", "is missing: density needs the size out of plane")
        return self.depth

    def total_mass(self) -> float | None:
        """The mass of the whole structure by the file [kg]; None where `bodies` have theirs, or there is none."""
        if self.mass is not None or self.density is None:
            return self.mass
        return self.density * self.volume()

    @cached_property
    def _mass_factor(self) -> float:
        """What the masses of `bodies` are multiplied by."""
        total = self.total_mass()
        return 1.0 if total is None else total / sum(body.mass for body in self.bodies())

    def weighed(self) -> Sequence[Body]:
        """The bodies with the masses of the file."""
        return weighed(self.bodies(), self._mass_factor)

    @cached_property
    def _hung(self) -> Sequence[tuple[Loc, Attached]]:
        """Everything attached to the structure, each with its place among the fields."""
        own: list[tuple[Loc, Attached]] = [((), thing) for thing in self.carries()]
        if not self._is_laden:
            return own
        carrier = self._carrier
        taken = [*(thing.name for _, thing in own), *([INTERLOCK] if self.interlock is not None else [])]
        found = [*own, *attach(carrier, self.loads or [], self.ties or [], taken)]
        if self.interlock is not None:
            density = self.interlock.density or self.density
            if density is None:
                raise Refused(
                    ("interlock",), "density", "is missing: the weight of the crossing walls is their friction"
                )
            foot = carrier.foot(self.interlock.body, ("interlock",))
            top = foot.at + 1j * self.interlock.height
            carrier.spot(foot.body, top, ("interlock",), "height")
            found.append((("interlock",), self.interlock.attached(foot, density, self.gravity)))
        return found

    @property
    def _carrier(self) -> Carrier:
        return Carrier.of(self.bodies(), self._shapes(), self.alike(), self.piece)

    def far_off(self) -> list[str]:
        """Return which of its loads are far off the bodies that carry them, a sentence each without a full stop."""
        return list(far_off(self._carrier, self.loads)) if self.loads else []

    @property
    def _is_laden(self) -> bool:
        return bool(self.loads or self.ties or self.interlock)

    @property
    def attached(self) -> Sequence[Attached]:
        """Everything attached to the structure, as its equation of motion sees it."""
        return [thing for _, thing in self._hung]

    @property
    def springs(self) -> Sequence[Spring]:
        """The elastic ones among its ties."""
        return [spring for thing in self.attached for spring in springs_of(thing)]

    def slackness(self, phi: Reals, direction: Direction) -> Reals:
        """For each tie that acts in one sense only: what is zero where it goes slack, shape (ties, n)."""
        springs = [spring for spring in self.springs if spring.only is not None]
        if not springs:
            return np.zeros((0, np.size(phi)))
        follow = self.followed(np.asarray(phi, dtype=np.float64), direction)
        return np.array([spring.slack_at(spring.elongation(follow)[0]) for spring in springs])

    @property
    def bends(self) -> bool:
        """Whether its restoring moment may have any shape, so that it is looked at whether linear models mislead."""
        return bool(self.attached)

    @property
    def smooth(self) -> bool:
        """Whether no derivative of its restoring moment has corners, as where a tie goes slack."""
        return all(spring.only is None for spring in self.springs)

    @property
    def is_bare(self) -> bool:
        """Whether it is the mechanism alone, without masses of the file, loads and ties."""
        return self.total_mass() is None and not self._hung

    def followed(self, phi: Reals, direction: Direction) -> Follow:
        """The paths of its points over rotations, shape (n,)."""
        return followed(self.bodies(), self.motion(phi, direction), phi.shape)

    def coefficients(self, phi: Reals, direction: Direction) -> Coefficients:
        """Coefficients I, J, G, B of the equation of motion over `phi`, shape (n,) [paper, Eq. 8].

        Includes what is attached to the structure: see `rocking_cli.core.attached`.
        """
        phi = _rotations(phi)
        bodies, motions = self.weighed(), self.motion(phi, direction)
        total = coefficients(phi, direction, bodies, motions)
        if self._hung:
            follow = followed(bodies, motions, phi.shape)
            for thing in self.attached:
                thing.act(total, direction, follow)
        return total

    def kinetic_inertia(self, phi: Reals, direction: Direction) -> Reals:
        """I(phi) [kg m2], shape (n,): the kinetic energy is I phi.^2 / 2."""
        return self.coefficients(phi, direction).I

    def potential_energy(self, phi: Reals, direction: Direction) -> Reals:
        """V(phi) [J], shape (n,), zero at rest; with what is stored in ties."""
        here = self.coefficients(phi, direction)
        return self.gravity * here.V + here.U

    def uplift(self, direction: Direction) -> float:
        """lambda: the ground acceleration that starts rocking, over g [paper, Eq. 10]."""
        return equilibrium.uplift_acceleration(partial(self.coefficients, direction=direction), self.gravity)

    def critical_rotation(self, direction: Direction) -> float:
        """phi_cr: the rotation of unstable equilibrium [rad; paper, Eq. 9]; `NoCriticalRotation` without one."""
        return equilibrium.critical_rotation(
            partial(self.coefficients, direction=direction), self.limit(direction), self.gravity
        )

    def restitution_from_kinematics(self, direction: Direction) -> float:
        """The eta of an impact that ends motion in `direction`, from the kinematics alone; it may be <= 0."""
        rest = np.zeros(1)
        motions = self.motion(rest, direction), self.motion(rest, direction.opposite)
        masses = [thing for thing in self.attached if isinstance(thing, PointMass)]
        return kinematic_restitution(self.weighed(), *motions, masses)

    def greatest_restitution(self, direction: Direction) -> float:
        """The eta of an impact that ends motion in `direction` and keeps all energy.

        The rates before and after are of phi on either side, where the inertia I(0) differs: the energy after an impact
        over that before is eta^2 I'(0)/I(0) with I' that of the other direction, so the bound is sqrt(I(0)/I'(0)), 1
        for a symmetric structure.
        """
        rest = np.zeros(1)
        before, after = (float(self.kinetic_inertia(rest, s)[0]) for s in (direction, direction.opposite))
        return sqrt(before / after)

    def rebound_from_impacts(self) -> float | None:
        """The rebound of its shape from a theory of impacts in sequence; by default there is none."""
        return None

    def eta(self, direction: Direction) -> float:
        """The eta of an impact that ends motion in `direction`: the user's, else that of the kinematics.

        Where it rocks to one side only, that is the rebound: NaN if it is neither given nor known from the shape, as
        only time histories need it.
        """
        if not self.rocks_both_ways:
            rebound = self.rebound if self.rebound is not None else self.rebound_from_impacts()
            return nan if rebound is None else rebound
        if isinstance(self.restitution, DirectionalRestitution):
            given = self.restitution
            return given.positive_to_negative if direction > 0 else given.negative_to_positive
        return self.restitution if self.restitution is not None else self.restitution_from_kinematics(direction)


def _rotations(phi: Any) -> Reals:
    """Rotations as an array of reals. Raises `InputError` for what is none."""
    try:
        found = np.asarray(phi, dtype=np.float64)  # whole numbers too, which hold no sums of reals
    except (TypeError, ValueError):
        found = np.zeros(())
    if found.ndim == 0:
        raise InputError(Problem(f"must be an array of rotations, got {phi!r}", field="phi", hint="write [0.1]"))
    return found


def _of_the_bare(own: Callable[..., Any]) -> Callable[..., Any]:
    """A method that answers for the bare mechanism, and leaves all else to the general solver of its name."""
    general = getattr(Mechanism, own.__name__)

    @wraps(own)
    def answer(self: Mechanism, *args: Any, **named: Any) -> Any:
        return own(self, *args, **named) if self.is_bare else general(self, *args, **named)

    return answer


def _area(shape: Sequence[complex]) -> float:
    """Signed area of a polygon [m2]."""
    z = np.asarray(shape) - shape[0]
    return float((z.conj() * np.roll(z, -1)).imag.sum() / 2)


def _failed(cls: type, method: str) -> str:
    return f"the mechanism {getattr(cls, 'mechanism', cls.__name__)} failed in {method}"
