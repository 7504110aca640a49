"""Ties of a structure, as users give them: ties between points, and springs along a face."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import EntryPoint
from itertools import pairwise
from math import pi
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self, cast

from pydantic import ConfigDict, Field, ModelWrapValidatorHandler, PrivateAttr, model_validator

from rocking_cli.core.fields import Described, Name, Vertex, geometry_error, length, point, quantity
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.hung.element import BarAtStrength, Element, Spring, SpringBed, SteelBar
from rocking_cli.errors import MechanismError
from rocking_cli.plugins.registry import Plugins, origin
from rocking_cli.text import did_you_mean

SteelName = Literal["S235", "S275", "S355", "B450C", "FeB22k", "FeB32k", "FeB38k", "FeB44k"]
STEELS: dict[SteelName, float] = {
    "S235": 235e6, "S275": 275e6, "S355": 355e6, "B450C": 450e6,
    "FeB22k": 215e6, "FeB32k": 315e6, "FeB38k": 375e6, "FeB44k": 430e6,
}  # fmt: skip
"""Characteristic yield stress [Pa]: EN 10025-2 as in NTC 2018, table 4.2.I; B450C of NTC 2018, 11.3.2.1; FeB of the
Italian decree of 9 January 1996."""
STEEL_MODULUS = 210e9  # Pa, modulus of elasticity: NTC 2018, 11.3.4.1; EN 1993-1-1, 3.2.6
MAX_STRAIN = 0.02  # elongation of a tie over its length beyond which it is not known to hold, if the file gives none
MAX_NAMED_DIAMETER = 0.04  # m; the standards give thicker steel a lower yield stress than its name says
BAR_DIAMETERS = tuple(d / 1000 for d in (12, 14, 16, 18, 20, 22, 24, 26, 28, 30, 32))
"""Diameters of bars that are proposed [m]."""


def partial_factor(strength: str) -> Any:
    """Declare a partial factor on a strength, 1 if it is not given."""
    return quantity(f"partial factor by which {strength} divided", symbol="gamma", default=None, ge=1, le=10)


class AnchorPlate(Described):
    """The anchor plate of one bar; its bending counts if it has a thickness."""

    model_config = ConfigDict(validate_by_name=True)

    width: float = length("width of the plate, along the wall", symbol="b", example=0.3)
    height: float = length("height of the plate", symbol="h", example=0.3)
    thickness: float | None = quantity(
        "thickness of the plate, which then bends between the bar and its edges", unit="m", symbol="s", example=0.02,
        default=None, gt=0, le=1,
    )  # fmt: skip
    yield_stress: float = quantity(
        "yield stress of the plate; if omitted, 235 MPa", unit="Pa", symbol="f_y", default=235e6, ge=1e7, le=1e12,
        alias="yield",
    )  # fmt: skip
    gamma: float | None = partial_factor("its yield stress is")


class BearingWall(Described):
    """The masonry that an anchor plate bears on."""

    thickness: float = length("thickness of the wall", symbol="t", example=0.6)
    compression: float = quantity(
        "compressive strength of the masonry", unit="Pa", symbol="f_c", example=1e6, ge=1e4, le=1e12
    )
    shear: float = quantity("shear strength of the masonry", unit="Pa", symbol="f_v", example=5e4, ge=1e3, le=1e12)
    gamma: float | None = partial_factor("both strengths are")
    source: Name | None = Field(None, description="where both strengths are from, such as a test or a table of a code")


class TieStrength(NamedTuple):
    """Strength of a tie by each of its limits.

    Parameters
    ----------
    limits : dict of str to float
        Force [N] at which the bars yield (`yield`), and, if there are plates, at which these punch through the wall
        (`punching`), crush it (`bearing`) or, if their thickness is known, bend (`bending`).
    """

    limits: dict[str, float]

    @property
    def governs(self) -> str:
        """Key of the limit that governs, the least."""
        return min(self.limits, key=self.limits.__getitem__)

    @property
    def force(self) -> float:
        """The strength, the least of all limits [N]."""
        return self.limits[self.governs]


def tie_strength(
    section: float, stress: float, count: float, plate: AnchorPlate | None = None, wall: BearingWall | None = None
) -> TieStrength:
    """Return the strength of a tie of several bars.

    Parameters
    ----------
    section : float
        Area of the section of one bar [m2].
    stress : float
        Yield stress over its partial factor [Pa].
    count : float
        Number of bars, each with one plate.
    plate, wall : AnchorPlate, BearingWall, optional
        An anchor plate and the wall under it, both or neither. The plate punches out a cone at 45 degrees, and bends as
        a cantilever on either side of the bar, under an even pressure of the wall, until its section is plastic.

    Examples
    --------
    >>> wall = BearingWall(thickness=0.6, compression=1e6, shear=5e4)
    >>> strength = tie_strength(circle(0.024), STEELS["S235"], 2, AnchorPlate(width=0.3, height=0.3), wall)
    >>> strength.governs, round(strength.force)
    ('bearing', 180000)
    """
    limits = {"yield": count * section * stress}
    if plate is not None and wall is not None:
        b, h, t = plate.width, plate.height, wall.thickness
        limits["punching"] = count * 2 * t * (b + h + 2 * t) * wall.shear / (wall.gamma or 1)
        limits["bearing"] = count * b * h * wall.compression / (wall.gamma or 1)
        if (s := plate.thickness) is not None:
            limits["bending"] = count * 2 * s**2 * plate.yield_stress / (plate.gamma or 1) * min(b / h, h / b)
    return TieStrength(limits)


def circle(diameter: float) -> float:
    """Return the area of a circle [m2]."""
    return pi * diameter**2 / 4


LATER_FIELDS = {
    "break": "an elongation at which it breaks", "damper": "a damper", "damping": "a damper",
    "inerter": "an inerter", "inertance": "an inerter", "exponent": "the exponent of a damper",
}  # fmt: skip
STEEL_FIELDS = {
    key: "yield" if key == "yield_stress" else key
    for key in ("bars", "spacing", "diameter", "steel", "yield_stress", "gamma", "source", "plate", "wall")
}
"""Fields of a tie of steel, and how files write them."""


class Place(Described):
    """A point of the ground or of a body."""

    ground: Vertex | None = point("a point of the ground", default=None)
    body: Name | None = Field(None, description="a body, by its name in the picture; optional for a single body")
    at: Vertex | None = point("a point of that body", default=None)

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if (self.ground is None) == (self.at is None):
            raise geometry_error("ground", "give {ground: [x, y]} or {body: NAME, at: [x, y]}")
        if self.ground is not None and self.body is not None:
            raise geometry_error("body", "a point of the ground has no body")
        return self

    @property
    def point(self) -> complex:
        """Position at rest, x + iy [m]."""
        return complex(*(self.ground or self.at or ()))


class Face(Described):
    """A straight face of a body with springs to the ground along it."""

    model_config = ConfigDict(validate_by_name=True)

    body: Name | None = Field(None, description="the body, by its name in the picture; optional for a single body")
    start: Vertex = point("one end of the face", alias="from")
    end: Vertex = point("its other end", alias="to")


class Tie(Described):
    """A tie along a path of two or more points, elastic or of steel, or a bed of springs along a face.

    A tie of another law derives from this class: it adds its fields and returns its own `element`, see `Laws`.
    """

    model_config = ConfigDict(validate_by_name=True)
    refused: ClassVar[Mapping[str, str]] = {
        key: f"{what} of a tie is not supported in this version: leave it out" for key, what in LATER_FIELDS.items()
    }

    name: Name = Field(description="what to call it")
    start: Place | None = Field(None, alias="from", description="where it begins")
    end: Place | None = Field(None, alias="to", description="where it ends")
    path: Annotated[list[Place], Field(min_length=2, max_length=100)] | None = Field(
        None, description="instead of both: the points it runs over, such as a tendon in a duct"
    )
    bed: Face | None = Field(None, description="instead of both: a face with springs from each point to where it rests")
    stiffness: float | None = quantity("its stiffness", unit="N/m", example=1e6, default=None, ge=0, le=1e15)
    area: float | None = quantity("area of its section", unit="m2", example=5e-4, default=None, gt=0, le=1e6)
    modulus: float | None = quantity(
        "modulus of elasticity, of steel 210 GPa unless given; for a bed, stiffness per metre of face and per metre of "
        "displacement", unit="Pa", example=2e11, default=None, gt=0, le=1e15,
    )  # fmt: skip
    length: float | None = quantity(
        "length over which it stretches; if omitted, that of its path", unit="m", default=None, gt=0, le=1e6
    )
    prestress: float = quantity("its force at rest, tension positive", unit="N", default=0.0, ge=-1e12, le=1e12)
    bars: Annotated[int, Field(ge=1, le=10_000)] | None = Field(
        None, description="number of bars of steel in the whole structure"
    )
    spacing: float | None = quantity(
        "instead of `bars`: distance between bars along the wall; the depth of the structure over it is their number",
        unit="m", default=None, gt=0, le=1e6,
    )  # fmt: skip
    diameter: float | None = quantity(
        "diameter of a bar", unit="m", symbol="d", example=0.024, default=None, gt=0, le=1
    )
    steel: SteelName | None = Field(
        None, description="steel of the tie, which then pulls only while it is stretched, until it yields"
    )
    yield_stress: float | None = quantity(
        "instead of `steel`: its yield stress", unit="Pa", symbol="f_y", example=2.35e8, default=None, ge=1e7, le=1e12,
        alias="yield",
    )  # fmt: skip
    gamma: float | None = partial_factor("its yield stress is")
    source: Name | None = Field(None, description="where its yield stress is from, such as a test")
    plate: AnchorPlate | None = Field(
        None, description="anchor plate of each bar; its strength and that of the wall count"
    )
    wall: BearingWall | None = Field(None, description="masonry that the anchor plates bear on")
    elongation: float | None = quantity(
        "elongation over its length up to which it is known to hold, such as that of its steel at its greatest force; "
        "of anchorages that give way before the bars yield it says nothing; if omitted, 0.02",
        example=0.05, default=None, gt=0, le=0.5,
    )  # fmt: skip
    only: Literal["tension", "compression"] | None = Field(None, description="the one sense in which it can act")
    each: bool = Field(False, description="whether each of several bodies that move alike has one")
    _at_strength: bool = PrivateAttr(default=False)

    @model_validator(mode="wrap")
    @classmethod
    def _by_its_law(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Validate a tie that names an installed law with the class of that law."""
        if cls is not Tie or not isinstance(data, dict) or "law" not in data or not laws():
            return handler(data)
        if (law := data["law"]) not in laws():
            guess = did_you_mean(str(law), list(laws())) or f"known: {', '.join(laws())}"
            raise geometry_error("law", f"there is no law {law!r}: {guess}")
        return cast("Self", laws()[law].model_validate(data))

    @classmethod
    def kinds(cls) -> Sequence[type[Tie]]:
        """Return the tie classes of other laws, whose fields may be given instead of those of this class."""
        return list(laws().values()) if cls is Tie else ()

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        kinds = [self.start is not None or self.end is not None, self.path is not None, self.bed is not None]
        if sum(kinds) != 1 or (kinds[0] and (self.start is None or self.end is None)):
            raise geometry_error("from", "give one of: `from` and `to`, `path`, or `bed`")
        if self.bed is not None and type(self) is not Tie:
            raise geometry_error("bed", "cannot be combined with `law`: a bed of springs is elastic")
        if self.bed is not None:
            self._check_bed()
        else:
            self._check_bar()
        return self

    def _check_bed(self) -> None:
        for key in ("stiffness", "area", "length", "only", "prestress", "elongation", *STEEL_FIELDS):
            if getattr(self, key):
                raise geometry_error(STEEL_FIELDS.get(key, key), "a bed has a modulus and nothing else")
        if self.bed is not None and self.bed.start == self.bed.end:
            raise geometry_error("bed", "its face has no length")
        if self.modulus is None:
            raise geometry_error("modulus", "a bed needs its modulus, N/m per metre of the face")

    def _check_bar(self) -> None:
        if any(getattr(self, key) is not None for key in STEEL_FIELDS):
            self._check_steel()
        else:
            self._check_elastic()
        if self.stiffness is None and self.length is None and self.span == 0:
            raise geometry_error("length", "its ends are together at rest: give the length over which it stretches")
        if (self.only == "tension" and self.prestress < 0) or (self.only == "compression" and self.prestress > 0):
            raise geometry_error("prestress", f"it acts in {self.only} only: its force at rest must have that sign")

    def _check_elastic(self) -> None:
        bar = [self.area, self.modulus]
        if (self.stiffness is None) == (None in bar) or (self.stiffness is not None and bar != [None, None]):
            raise geometry_error(
                "stiffness",
                "give stiffness, or area and modulus: one of them (`stiffness: 0` with `prestress` for a constant "
                "force), or steel bars by `bars`, `diameter` and `steel`",
            )
        if self.stiffness is not None and self.length is not None:
            raise geometry_error("length", "cannot be combined with `stiffness`: use it with `area` and `modulus`")

    def _check_steel(self) -> None:
        """Refuse fields of a tie of steel that do not fit together."""
        if type(self) is not Tie:
            key = next(key for key in STEEL_FIELDS if getattr(self, key) is not None)
            raise geometry_error(STEEL_FIELDS[key], "cannot be combined with `law`, which gives the force")
        if self.steel is None and self.yield_stress is None:
            named = ", ".join(STEELS)
            raise geometry_error("steel", f"is missing: name one of {named}, or give the yield stress as `yield`")
        if self.steel is not None and self.yield_stress is not None:
            raise geometry_error("yield", "cannot be combined with `steel`: give one of the two")
        for key, why in (("stiffness", "has its stiffness from its section"), ("prestress", "has no force at rest")):
            if getattr(self, key):
                raise geometry_error(key, f"a tie of steel {why}: leave it out, or leave out the steel")
        if self.only == "compression":
            raise geometry_error("only", "a tie of steel acts in tension")
        self._check_bars()
        if (self.plate is None) != (self.wall is None):
            missing, there = ("plate", "wall") if self.plate is None else ("wall", "plate")
            raise geometry_error(missing, f"is missing, which `{there}` requires: give both, or leave out `{there}`")

    def _check_bars(self) -> None:
        """Refuse the number and the size of the bars of a tie of steel if they do not fit together."""
        if self.area is None and self.diameter is None:
            reason = "is missing: give `diameter` with `bars` or `spacing`, or the `area` of the whole tie"
            raise geometry_error("diameter", reason)
        if self.area is not None and self.diameter is not None:
            raise geometry_error("area", "cannot be combined with `diameter`: give one of the two")
        for key in ("bars", "spacing", "plate") if self.area is not None else ():
            if getattr(self, key) is not None:
                raise geometry_error(key, "requires `diameter` instead of `area`, which is that of the whole tie")
        if self.area is not None:
            return
        if self.bars is not None and self.spacing is not None:
            raise geometry_error("spacing", "cannot be combined with `bars`: give the number of bars or their spacing")
        if self.bars is None and self.spacing is None:
            raise geometry_error("bars", "is missing: give the number in the whole structure, or their `spacing`")
        if self.each:
            raise geometry_error("each", "cannot be combined with `bars` and `spacing`, which count all: leave it out")
        if self.steel is not None and self.diameter is not None and self.diameter > MAX_NAMED_DIAMETER:
            most = f"{1000 * MAX_NAMED_DIAMETER:g} mm"
            raise geometry_error("steel", f"thicker bars than {most} yield at less than this steel: give `yield`")

    @property
    def places(self) -> list[Place]:
        """Points along the path of the tie; empty for a bed of springs."""
        if self.start is not None and self.end is not None:
            return [self.start, self.end]
        return list(self.path or [])

    @property
    def span(self) -> float:
        """Length of the tie at rest [m]."""
        points = [place.point for place in self.places]
        return sum(abs(b - a) for a, b in pairwise(points))

    @property
    def known_elongation(self) -> float | None:
        """Elongation up to which the tie is known to hold [m]; None without a length, as for a bed of springs."""
        return (self.elongation or MAX_STRAIN) * (self.length or self.span) or None

    @property
    def is_steel(self) -> bool:
        """Whether the tie is of steel, and yields."""
        return self.steel is not None or self.yield_stress is not None

    @property
    def yield_of_steel(self) -> float:
        """Yield stress of a tie of steel [Pa]."""
        stress = self.yield_stress if self.steel is None else STEELS[self.steel]
        assert stress is not None
        return stress

    def number_of_bars(self, depth: float | None) -> float:
        """Return the number of bars: depth [m] over the spacing, not rounded, or else as given; 1 without either."""
        if self.spacing is not None and depth is not None:
            return depth / self.spacing
        return float(self.bars or 1)

    def strength(self, count: float) -> TieStrength:
        """Return the strength of a tie of steel with this number of bars."""
        return tie_strength(self.section, self.yield_of_steel / (self.gamma or 1), count, self.plate, self.wall)

    def at_strength(self, *, on: bool) -> Self:
        """Return the tie as methods of codes count it, or, without `on`, as motions do: it matters for one of steel."""
        tie = self.model_copy()
        tie._at_strength = on
        return tie

    @property
    def section(self) -> float:
        """Area of the section of the tie, or of one of its bars [m2]."""
        section = self.area if self.diameter is None else circle(self.diameter)
        assert section is not None
        return section

    @property
    def k(self) -> float:
        """Stiffness of the tie, or of one of its bars [N/m]."""
        if self.stiffness is not None:
            return self.stiffness
        return self.section * (self.modulus or STEEL_MODULUS) / (self.length or self.span)

    @property
    def is_elastic(self) -> bool:
        """Whether the force increases with the elongation without end, as that of a tie of steel does not."""
        return self.bed is not None or (not self.is_steel and self.k > 0)

    def element(self, spots: Sequence[Spot], count: float) -> Element:
        """Return `count` such ties, with all their bars, through points as one element.

        The points of a bed are the ends of its face.
        """
        if self.bed is not None:
            assert self.modulus is not None
            return SpringBed(self.name, spots[0], spots[1], self.modulus, count)
        if self.is_steel:
            number, count = (count, 1.0) if self.diameter is not None else (1.0, count)
            strength = self.strength(number).force
            if self._at_strength:
                return BarAtStrength(self.name, tuple(spots), 0.0, strength, count=count)
            return SteelBar(self.name, tuple(spots), number * self.k, strength=strength, count=count)
        return Spring(self.name, tuple(spots), self.k, self.prestress, only=self.only, count=count)

    def enlarged(self, factor: float) -> Self:
        """Return the tie on a structure of another size: its lengths are multiplied, its stiffness and force stay."""
        kept: dict[str, Any] = {}
        if self.is_steel:  # the spacing is enlarged as the depth is, so that the number of bars stays
            kept = {"area": self.area, "diameter": self.diameter, "yield_stress": self.strength(1).force / self.section}
            kept |= {"steel": None, "gamma": None, "plate": None, "wall": None, "length": self.length or self.span}
        elif self.bed is None:
            kept = {"stiffness": self.k, "area": None, "modulus": None, "length": None}
        return super().enlarged(factor).model_copy(update=kept)


class Laws(Plugins[type[Tie]]):
    """Tie classes of other laws than the elastic one, by the name of the law: the entry points `rocking.laws`.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is no tie, or has a name that two packages claim.
    """

    group = "rocking.laws"
    kind = "law"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> type[Tie]:
        """Return the loaded class of ties. Raises `MechanismError` if it is none, or its `law` is not its name."""
        if not (isinstance(loaded, type) and issubclass(loaded, Tie)):
            raise MechanismError(f"{origin(point)} is not a law: it must be a class derived from Tie")
        if "law" not in loaded.model_fields or loaded.model_fields["law"].default != point.name:
            wanted = f'law: Literal["{point.name}"] = "{point.name}"'
            raise MechanismError(f"{origin(point)} is not a law: it must have the field {wanted}")
        return loaded


@cache
def laws() -> Laws:
    """Return the installed laws of ties."""
    return Laws()
