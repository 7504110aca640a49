"""What a structure is made of, for the start of the sheet: its sizes, bodies, materials, masses, loads and ties.

All of it is data without words: rows of tables, and lines of formulas that are written in a language later.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, isclose, log10
from typing import Any
from unicodedata import lookup

from rocking_cli.codes.italian import formulas as F
from rocking_cli.core import Body, Mechanism, PointMass, Solid
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.hung.element import ConstantForce, SpringBed
from rocking_cli.core.hung.ties import Tie, circle
from rocking_cli.core.kinematics import area_of
from rocking_cli.core.structure_fields import StructureFields
from rocking_cli.verification.results import Evaluated, Formula

KILO = 1e3
MEGA = 1e6
USUAL_DIGITS, SPARE_DIGITS, MAX_DIGITS = 9, 2, 15  # of coordinates; how many of them differences may lose; at most
SHARE_OF_ROUNDING = 1e-11  # share of the size of a structure below which a coordinate is zero
SAME_SIZE = 1e-9  # relative difference of sizes of equal bodies
SAME_MASS = 1e-9  # relative difference of the mass of a body and of the sum of its parts
MAX_WRITTEN_CORNERS = 24  # corners of a polygon whose area is written out
GREEK_NAME = re.compile(r"\b(alpha|beta|gamma|xi)\b")
SIZE_UNITS = ("m", "deg", "")


@dataclass(frozen=True)
class Dimension:
    """A size of the structure: the key of its field, its description in English, symbol, value and unit."""

    mechanism: str
    key: str
    description: str
    symbol: str
    value: float | str
    unit: str


@dataclass(frozen=True)
class BodyRow:
    """A body: its number, name, centroid at rest [m], area in the plane [m2; None if its shape is not known], mass."""

    number: int
    name: str
    centroid: complex
    area: float | None
    mass: float


@dataclass(frozen=True)
class PartRow:
    """A polygon whose area is written out: the subscript of its area and mass, and its corners [m]."""

    number: str
    corners: Sequence[complex]


@dataclass(frozen=True)
class MaterialRow:
    """A property of a material: its key, the body or tie it is of (empty: of the structure), symbol, value and unit.

    The strengths of a tie have a partial factor and a source, as far as they are given.
    """

    key: str
    of: str
    symbol: str
    value: float
    unit: str
    gamma: float | None = None
    source: str = ""


@dataclass(frozen=True)
class LoadRow:
    """A weight or a force on the structure.

    Parameters
    ----------
    name, body : str
        Its name, and the body on which it acts; the name of a body for its own weight.
    at : complex
        The point on which it acts, at rest [m].
    mass : float or None
        Mass [kg]; None for a force.
    weight : float or None
        Its weight [kN, or N/kg without masses]; None for a force.
    per_metre : float or None
        The weight over the depth of the structure [kN/m]; None if this is not known.
    carried, sideways : float
        Shares of the weight that the body carries, and of the mass that moves sideways with it.
    force : complex or None
        Fx + i Fy of a force [kN].
    reverses : bool
        Whether the horizontal part of a force is always against the motion, as that of friction.
    seat : float or None
        Length of the seat of a load [m]; None if it has none.
    floor : str
        What the file says of a floor; empty without it.
    """

    name: str
    body: str
    at: complex
    mass: float | None = None
    weight: float | None = None
    per_metre: float | None = None
    carried: float = 1.0
    sideways: float = 1.0
    force: complex | None = None
    reverses: bool = False
    seat: float | None = None
    floor: str = ""


@dataclass(frozen=True)
class TieRow:
    """A tie: the points that it runs over, force at rest [kN], area of all its bars [m2], stiffness [kN/m], length [m].

    A bed of springs has the ends of its face as points, and the stiffness of all of its springs. Another tie is `known`
    to hold up to an elongation [m], which follows from the file if `is_given`.
    """

    name: str
    spots: Sequence[Spot]
    force: float
    area: float | None
    stiffness: float
    length: float | None
    is_bed: bool
    known: float | None = None
    is_given: bool = False


@dataclass(frozen=True, eq=False)
class Composition:
    """Tables and lines on what a structure is made of.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    """

    mechanism: Mechanism

    @property
    def dimensions(self) -> Sequence[Dimension]:
        """The sizes that the structure file gives, and its depth."""
        mechanism, rows = self.mechanism, []
        for key, info in type(mechanism).model_fields.items():
            extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else None
            value, unit = getattr(mechanism, key), str((extra or {}).get("unit", ""))
            is_size = isinstance(value, int | float | str) and not isinstance(value, bool) and unit in SIZE_UNITS
            if extra is None or not is_size or (key in StructureFields.model_fields and key != "depth"):
                continue
            symbol = _in_marks(str(extra.get("symbol", "")))
            rows.append(Dimension(mechanism.mechanism, key, info.description or key, symbol, value, unit))
        return rows

    @property
    def bodies(self) -> Sequence[BodyRow]:
        """The bodies, those at rest too."""
        rows = []
        for k, body in enumerate(self.mechanism.weighed(), 1):
            solids = self._solids[body.name]
            plates = [each.sign * each.count * each.area for each in solids if each.kind != "cone"]
            area = sum(plates) if plates else abs(area_of(body.outline)) if body.outline else None
            rows.append(BodyRow(k, body.name, self._near(body.centroid), area, body.mass))
        return rows

    def _near(self, at: complex) -> complex:
        """Return a point with rounding errors about zero removed [m]."""
        return cleared(at, max(abs(body.centroid) for body in self.mechanism.bodies()))

    @cached_property
    def _solids(self) -> Mapping[str, Sequence[Solid]]:
        """The uniform parts of each body, by name; none if the mass of a body does not follow from them."""
        solids, bodies = self.mechanism.solids(), self.mechanism.weighed()
        parts = {body.name: (body.mass, solids.get(body.name, ())) for body in bodies}
        return {
            name: solids if isclose(sum(each.mass for each in solids), mass, rel_tol=SAME_MASS) else ()
            for name, (mass, solids) in parts.items()
        }

    # Masses

    @property
    def masses(self) -> Sequence[Evaluated]:
        """The lines to the mass of each body, those of equal bodies once."""
        solids, whole = self._solids, sum(body.mass for body in self.mechanism.weighed())
        groups: list[tuple[Sequence[Solid], list[int]]] = []
        lines: list[Evaluated] = []
        for k, body in enumerate(self.mechanism.weighed(), 1):
            if not (parts := solids[body.name]):
                lines.append(self._told(k, body, whole))
                continue
            alike = next((numbers for first, numbers in groups if _are_alike(first, parts)), None)
            if alike is None:
                groups.append((parts, [k]))
            else:
                alike.append(k)
        return [*(line for parts, numbers in groups for line in _weighed(ranges(numbers), parts)), *lines]

    def _told(self, k: int, body: Body, whole: float) -> Evaluated:
        """Return the line for a mass that does not follow from sizes."""
        mechanism = self.mechanism
        shared = mechanism.mass is not None or not mechanism.has_mass
        if shared and len(mechanism.bodies()) > 1:
            return F.SHARE_OF_MASS.line(body.mass, {"k": k}, M=whole, share=body.mass / whole)
        is_given = mechanism.mass is not None or not mechanism.solids().get(body.name)
        return (F.MASS_GIVEN if is_given else F.MASS_OF_MECHANISM).line(body.mass, {"k": k})

    @property
    def strips(self) -> Sequence[Solid]:
        """The plates of the structure, if they have different lengths out of plane."""
        plates = [each for parts in self._solids.values() for each in parts if each.corners and each.sign > 0]
        lengths = sorted(each.depth for each in plates)
        return plates if plates and not isclose(lengths[0], lengths[-1], rel_tol=SAME_SIZE) else []

    @property
    def polygons(self) -> Sequence[PartRow]:
        """The polygons whose areas are written out, with their corners."""
        rows = []
        for k, parts in enumerate(self._solids.values(), 1):
            for number, part in _numbered(str(k), parts):
                if part.kind == "polygon" and len(part.corners) <= MAX_WRITTEN_CORNERS:
                    rows.append(PartRow(number, part.corners))
        return rows

    # Materials, loads and ties

    @property
    def materials(self) -> Sequence[MaterialRow]:
        """The properties of the materials that the structure file gives."""
        return [*self._densities(), *self._of_contacts(), *self._of_ties()]

    def _densities(self) -> Iterator[MaterialRow]:
        mechanism = self.mechanism
        densities = {name: {each.density for each in parts} for name, parts in self._solids.items()}
        pairs = [("", mechanism.density)] if mechanism.density is not None else []
        pairs += [
            (name, value) for name, each in densities.items() for value in sorted(each) if value != mechanism.density
        ]
        for of, value in pairs:
            yield MaterialRow("density", of, "ρ", value, "kg/m³")
            yield MaterialRow("unit_weight", of, "γ", value * mechanism.gravity / KILO, "kN/m³")

    def _of_contacts(self) -> Iterator[MaterialRow]:
        mechanism = self.mechanism
        if mechanism.crushing is not None:
            yield MaterialRow("crushing", "", "f_[m]", mechanism.crushing.strength / MEGA, "MPa")
        if mechanism.strength is not None:
            yield MaterialRow("strength", "", "f_[m]", mechanism.strength.stress / MEGA, "MPa")
        if mechanism.friction is not None:
            yield MaterialRow("friction", "", "μ", mechanism.friction, "")
        if mechanism.interlock is not None:
            yield MaterialRow("friction_of_courses", "", "μ", mechanism.interlock.friction, "")
        for direction in mechanism.directions:
            if not mechanism.restitution_is_kinematic:
                key = f"restitution_{direction.label}" if mechanism.rocks_both_ways else "rebound"
                yield MaterialRow(key, "", "η", mechanism.eta(direction), "")

    def _of_ties(self) -> Iterator[MaterialRow]:
        for tie in self.mechanism.ties or []:
            if tie.is_steel:
                source = tie.steel or tie.source or ""
                yield MaterialRow("yield", tie.name, "f_[y]", tie.yield_of_steel / MEGA, "MPa", tie.gamma, source)
            if (plate := tie.plate) is not None and plate.thickness is not None:
                yield MaterialRow("bending", tie.name, "f_[y]", plate.yield_stress / MEGA, "MPa", plate.gamma)
            if tie.modulus is not None:
                yield MaterialRow("bed" if tie.bed is not None else "modulus", tie.name, "E", tie.modulus / MEGA, "MPa")
            if (wall := tie.wall) is not None:
                by = ("MPa", wall.gamma, wall.source or "")
                yield MaterialRow("bearing", tie.name, "f_[c]", wall.compression / MEGA, *by)
                yield MaterialRow("punching", tie.name, "f_[v]", wall.shear / MEGA, *by)

    @property
    def loads(self) -> Sequence[LoadRow]:
        """Each weight and each force on the structure: of its bodies, of loads, and of crossing walls."""
        mechanism = self.mechanism
        rows = [
            LoadRow(body.name, body.name, self._near(body.centroid), **self._weight(body.mass))
            for body in mechanism.weighed()
        ]
        for attached in mechanism.hung.things:
            if isinstance(attached, PointMass):
                name, (body, at) = attached.name, attached.spot
                values = self._weight(attached.mass) | {"carried": attached.weight, "sideways": attached.horizontal}
                load = next((load for load in mechanism.loads or [] if load.name == name), None)
                values |= {"seat": load.seat, "floor": load.floor or ""} if load is not None else {}
                rows.append(LoadRow(name, body or "", at, **values))
            elif isinstance(attached, ConstantForce):
                name, (body, at) = attached.name, attached.spot
                rows.append(LoadRow(name, body or "", at, force=attached.thrust / KILO, reverses=attached.friction))
        return rows

    @property
    def forces(self) -> Sequence[LoadRow]:
        """The forces among the loads."""
        return [row for row in self.loads if row.force is not None]

    @property
    def weight_unit(self) -> str:
        """Unit of weights: kN, or N/kg if the structure file gives no masses."""
        return "kN" if self.mechanism.has_mass else "N/kg"

    def _weight(self, mass: float) -> dict[str, Any]:
        """Return a mass with its weight and the weight per metre of depth."""
        weight = mass * self.mechanism.gravity / (KILO if self.mechanism.has_mass else 1.0)
        depth = self.mechanism.depth
        return {"mass": mass, "weight": weight, "per_metre": None if depth is None else weight / depth}

    @property
    def ties(self) -> Sequence[TieRow]:
        """The ties, tendons and beds of springs."""
        return [self._tie(tie) for tie in self.mechanism.ties or []]

    def _tie(self, tie: Tie) -> TieRow:
        element = next(each for each in self.mechanism.hung.ties if each.name == tie.name)
        if isinstance(element, SpringBed):
            spots, length = [element.start, element.end], abs(element.end.at - element.start.at)
            return TieRow(tie.name, spots, 0.0, None, element.count * element.stiffness / KILO, length, True)
        (stretched,) = element.stretched
        force, stiffness = (stretched.count * each / KILO for each in stretched.at_rest)
        bars = tie.number_of_bars(self.mechanism.depth) if tie.is_steel else 1.0
        area = bars * circle(tie.diameter) if tie.diameter is not None else tie.area
        known = (tie.known_elongation, tie.elongation is not None)
        return TieRow(tie.name, stretched.spots, force, area, stiffness, tie.length or tie.span, False, *known)


def _in_marks(symbol: str) -> str:
    """Return a symbol in plain characters with Greek letters and the marks of subscripts: `x_P`, `alpha`."""
    greek = GREEK_NAME.sub(lambda name: lookup(f"GREEK SMALL LETTER {name[0].upper()}"), symbol)
    return re.sub(r"_(\w+)", r"_[\1]", greek)


def cleared(at: complex, size: float) -> complex:
    """Return a point with coordinates that are zero but for rounding, over a size [m], set to zero."""
    return complex(*(0.0 if abs(part) < SHARE_OF_ROUNDING * size else part for part in (at.real, at.imag)))


def sharpened(formula: Formula, loss: float) -> Formula:
    """Return a formula with so many digits that five remain where its differences lose a factor `loss`."""
    digits = min(MAX_DIGITS, USUAL_DIGITS + max(0, ceil(log10(loss)) - SPARE_DIGITS))
    return replace(formula, numbers=formula.numbers.replace(f":{USUAL_DIGITS}}}", f":{digits}}}"), digits=digits)


def _are_alike(one: Sequence[Solid], other: Sequence[Solid]) -> bool:
    """Return whether two bodies are of equal parts, so that one line has the mass of both; never of polygons."""
    return len(one) == len(other) and all(
        (a.kind, a.sign, a.count) == (b.kind, b.sign, b.count) and a.kind != "polygon"
        and all(isclose(x, y, rel_tol=SAME_SIZE) for x, y in zip(
            (*a.sizes, a.density, a.depth), (*b.sizes, b.density, b.depth), strict=True
        ))
        for a, b in zip(one, other, strict=True)
    )  # fmt: skip


def ranges(numbers: Sequence[int]) -> str:
    """Return increasing numbers as text, of those in a row the first and the last."""
    rows: list[list[int]] = []
    for number in numbers:
        if rows and number == rows[-1][-1] + 1:
            rows[-1].append(number)
        else:
            rows.append([number])
    return ", ".join(str(row[0]) if len(row) == 1 else f"{row[0]}–{row[-1]}" for row in rows)


def _numbered(k: str, parts: Sequence[Solid]) -> list[tuple[str, Solid]]:
    """Return the parts of a body with their subscripts: that of the body, and a second number if there are several."""
    return [(k if len(parts) == 1 else f"{k},{i}", part) for i, part in enumerate(parts, 1)]


def _weighed(k: str, parts: Sequence[Solid]) -> Iterator[Evaluated]:
    """Yield the lines from the sizes of the parts of a body to its mass."""
    for number, part in _numbered(k, parts):
        yield from _of_part(number, part)
    if len(parts) > 1:
        masses = [part.mass for part in parts]
        yield F.SUM_OF_PARTS.line(sum(masses), {"k": k}, M=masses)


def _of_part(k: str, part: Solid) -> Iterator[Evaluated]:
    """Yield the lines from the sizes of a part to its mass, which is negative for a part that is taken out."""
    rho, names, sizes = part.sign * part.density, {"k": k}, part.sizes
    if part.kind == "polygon":
        x, y = ([getattr(corner, axis) for corner in part.corners] for axis in ("real", "imag"))
        nexts = {"xn": [*x[1:], x[0]], "yn": [*y[1:], y[0]]}
        formula = F.AREA if len(x) <= MAX_WRITTEN_CORNERS else F.AREA_OF_MANY
        loss = sum(abs(one * other) for one, other in zip(x, nexts["yn"], strict=True)) / part.area
        yield sharpened(formula, max(loss, 1.0)).line(part.area, names, x=x, y=y, **nexts)
        yield F.PLATE.line(part.mass, names, rho=rho, A=part.area, L=part.depth)
    elif part.kind == "rectangle":
        several = {"n": part.count} if part.count != 1 else {}
        formula = F.SEVERAL if several else F.RECTANGLE
        yield formula.line(part.mass, names, rho=rho, b=sizes[0], h=sizes[1], L=part.depth, **several)
    elif part.kind == "sector":
        inner, outer, angle = sizes
        yield F.SECTOR.line(part.mass, names, rho=rho, re=outer, ri=inner, beta=angle, L=part.depth)
    elif part.kind == "disc":
        yield F.DISC.line(part.mass, names, rho=rho, r=sizes[0], L=part.depth)
    else:
        radius, height, removed = sizes
        formula = F.HOLLOW_CONE if removed else F.CONE
        yield formula.line(part.mass, names, rho=rho, r=radius, h=height, c=removed)
