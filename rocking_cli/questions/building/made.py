"""The mechanisms of a building as structures: what is above a hinge of a wall, between two floors, or on top.

Coordinates are those of a section: x from the middle of the wall at the hinge to the outside, y up from the hinge.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from math import floor, inf, sqrt, tan
from typing import Any, NamedTuple

import numpy as np
from pydantic import ValidationError

from rocking_cli.core import Direction, Mechanism, polygon
from rocking_cli.core.kinematics import area_of
from rocking_cli.core.registry import Registry
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.field_problems import of_arguments
from rocking_cli.questions.building.description import (
    Bearing,
    BellGable,
    Building,
    BuildingTie,
    BuildingWall,
    Courses,
    Gable,
    Hole,
    OnTop,
)
from rocking_cli.studies.remark import Remark

STRIPS = 6  # of a gable, each with its mean length: the mass is exact, the centroid 1.4 % too high
ARCH_THRUST, ARCH_RISE = 0.15, 1 / 1.2  # over f t and t, which give the strength f (t/L)^2 of EN 1996-1-1, 6.3.2
MOST_SLENDER_ARCH = 20.0  # length over thickness
MOST_ARCH_RATIO = 0.57  # g, as one rigid body of the inertia of two has at most 1/sqrt(3) as its ratio at rest
LEAST_OVERLAP = 1e-6  # share of an overlap below which nothing of it is left
LEAST_AREA = 1e-6  # m2, of a wedge; a smaller one is left out
OF_ITS_WEIGHT = 1e-9  # share of the weight of a wall; a smaller load on top is none


class NotMade(Exception):
    """A mechanism cannot be made of a description, or does not exist.

    Parameters
    ----------
    key : str
        Key of the reason among the texts, a clause.
    exists : bool
        Whether the mechanism exists all the same, and may govern.
    **values
        Values in the reason.
    """

    def __init__(self, key: str, *, exists: bool = True, **values: Any) -> None:
        super().__init__(key)
        self.why, self.exists = Remark(f"why_{key}", values), exists


class FallsAtRest(InputError):
    """A structure does not stand under its loads without an earthquake."""


class Strip(NamedTuple):
    """A part of a wall of constant section: heights above the foundation, thickness and length [m], density [kg/m3]."""

    low: float
    high: float
    thickness: float
    length: float
    density: float

    @property
    def mass(self) -> float:
        """Its mass [kg]."""
        return self.density * self.length * self.thickness * (self.high - self.low)


@dataclass(frozen=True)
class MadeMechanism:
    """A mechanism of a building.

    Parameters
    ----------
    kind : str
        "overturning", "bending", "arch", "gable", "corner", "parapet" or "bell_gable".
    wall : str
        The wall, or what stands on it.
    name : str
        Name of the structure.
    z : float
        Height above the foundation at which the motion of the building shakes it [m].
    hinge : tuple of (float, float)
        Where it begins and ends above the foundation [m].
    mechanism : str
        Name of the kind of structure.
    fields : mapping
        Its fields, as a structure file has them.
    angle : float or None
        Angle of the crack in crossing walls from the vertical [rad]; None without any.
    part, other : str
        What stands on the wall or where walls meet, by its name if it has one, and the other wall of a corner.
    without_gable : bool
        Whether the gable of the wall has fallen before.
    remarks : sequence of Remark
        What the structure leaves out of the mechanism.
    """

    kind: str
    wall: str
    name: str
    z: float
    hinge: tuple[float, float]
    mechanism: str
    fields: Mapping[str, Any]
    angle: float | None = None
    part: str = ""
    other: str = ""
    without_gable: bool = False
    remarks: Sequence[Remark] = ()

    @property
    def title(self) -> Remark:
        """What it is: the wall or part, how it moves, and where."""
        part = self.part or Remark.of(f"{self.kind}_on", wall=self.wall, other=self.other)
        key = f"{self.kind}_without" if self.without_gable else self.kind
        return Remark.of(key, wall=self.wall, name=part, z=self.hinge[0], top=self.hinge[1])

    def structure(self) -> Mechanism:
        """Return the structure. Raises `InputError` if its fields do not fit together, `FallsAtRest` if it falls."""
        cls = _registry()[self.mechanism]
        try:
            return cls.from_fields({"name": self.name, **self.fields})
        except ValidationError as error:
            problems = of_arguments(cls, error.errors(include_url=False), self.mechanism)
            falls = any(each.field in ("loads", "ties") for each in problems)
            raise (FallsAtRest if falls else InputError)(*problems) from None


@cache
def _registry() -> Registry:
    return Registry()


def strips(building: Building, wall: BuildingWall, low: float, high: float) -> list[Strip]:
    """Return the parts of a wall between two heights [m], shortened by openings. Raises `NotMade` if one has none."""
    levels, (foot, _) = building.levels, wall.reaches(building.count)
    holes = [(levels[each.storey - 1] + each.z, each) for each in wall.openings]
    cuts = {low, high, *(z for z in levels if low < z < high)}
    cuts |= {z for at, each in holes for z in (at, at + each.height) if low < z < high}
    parts = list[Strip]()
    for a, b in pairwise(sorted(cuts)):
        middle = (a + b) / 2
        storey = max(foot + 1, min(int(np.searchsorted(levels, middle)), wall.reaches(building.count)[1]))
        length = wall.length - sum(each.width for at, each in holes if at < middle < at + each.height)
        if length <= 0:
            raise NotMade("openings", z=middle)
        part = Strip(a, b, wall.thick(storey), length, wall.density or building.masonry.density)
        alike = parts and parts[-1][2:] == part[2:]
        parts = [*parts[:-1], parts[-1]._replace(high=b)] if alike else [*parts, part]
    return parts


def _rounded(value: float) -> float:
    """Return a coordinate in tenths of a millimetre, so that files are readable; it changes nothing that is known."""
    return round(value, 4) + 0.0


def _given(**fields: Any) -> dict[str, Any]:
    """Return the fields that are given: neither None nor an empty list."""
    return {key: value for key, value in fields.items() if value is not None and value != []}


def _rectangle(x0: float, x1: float, y0: float, y1: float) -> list[list[float]]:
    return [[_rounded(x), _rounded(y)] for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]


def _body(parts: Sequence[Strip], z: float, wedges: Sequence[Mapping[str, Any]] = ()) -> tuple[str, dict[str, Any]]:
    """Return the kind of structure and the fields of what stands above a hinge, with its outer faces flush."""
    first, top = parts[0], parts[-1].high - z
    depth = max(each.length for each in parts)
    if len(parts) == 1 and not wedges:
        fields = {"width": first.thickness, "height": _rounded(top), "depth": first.length, "density": first.density}
        return "block", fields
    outer = first.thickness / 2
    plates = list[dict[str, Any]]()
    for each in parts:
        corners = _rectangle(outer - each.thickness, outer, each.low - z, each.high - z)
        density = each.density if each.density != first.density else None
        plates.append(_given(polygon=corners, depth=_rounded(each.length), density=density))
    return "rigid_body", {"parts": [*plates, *wedges], "density": first.density, "depth": depth}


def _seats(building: Building, wall: BuildingWall, low: float) -> list[tuple[str, float, Bearing]]:
    """Return name, height and floor of what bears on a wall above a height [m]."""
    of = [(name, building.levels[level], each) for name, level, each in building.bearing if wall.name in each.walls]
    return [each for each in of if low < each[1]]


def _inner(building: Building, wall: BuildingWall, z: float, outer: float) -> float:
    """Return x of the inner face just below a height [m]."""
    storey = int(np.searchsorted(building.levels, z))
    return outer - wall.thick(max(storey, wall.reaches(building.count)[0] + 1))


def _bears_at(building: Building, wall: BuildingWall, z: float, outer: float, floor: Bearing) -> float:
    """Return x at which a floor bears: a third of its seat from the inner face, without one the axis of the wall."""
    inner = _inner(building, wall, z, outer)
    return inner + floor.seat / 3 if floor.seat is not None else (inner + outer) / 2


def _loads(building: Building, wall: BuildingWall, z: float, outer: float, depth: float) -> list[dict[str, Any]]:
    """Return the loads of floors and roof above a hinge."""
    loads = list[dict[str, Any]]()
    for name, height, each in _seats(building, wall, z):
        at = [_rounded(_bears_at(building, wall, height, outer, each)), _rounded(height - z)]
        mass = each.load if depth == wall.length else each.load * wall.length / depth
        how = "sliding" if each.sliding else "borne"
        loads.append(_given(name=name, mass_per_area=mass, span=each.span, at=at, floor=how, seat=each.seat))
        if each.thrust:
            push = [each.thrust * wall.length / depth, 0.0]
            loads.append({"name": f"thrust of {name}", "force_per_metre": push, "at": at})
    return loads


def tie_height(building: Building, tie: BuildingTie) -> float:
    """Return the height of ties above the foundation [m]."""
    return building.levels[tie.level] - tie.below


def _ties(building: Building, wall: BuildingWall, z: float, outer: float) -> list[dict[str, Any]]:
    """Return the ties of a wall above a hinge."""
    ties, names = list[dict[str, Any]](), [each.name for each in building.ties]
    for each in building.ties:
        y = tie_height(building, each)
        if wall.name not in each.walls or y <= z:
            continue
        inner, m = _inner(building, wall, y, outer), building.masonry
        given = each.model_dump(exclude_unset=True, by_alias=True)
        steel = {key: value for key, value in given.items() if key not in ("name", "level", "below", "walls", "length")}
        if each.plate is not None:
            thickness = _rounded(outer - inner)
            steel["wall"] = _given(
                thickness=thickness, compression=m.compression, shear=m.shear, gamma=m.gamma, source=m.source
            )
        name = each.name if names.count(each.name) == 1 else f"{each.name} at level {each.level}"
        ends = {"from": {"ground": [_rounded(inner - each.length), _rounded(y - z)]},
                "to": {"at": [_rounded(inner), _rounded(y - z)]}}  # fmt: skip
        ties.append({"name": name, **ends, **steel})
    return ties


def _sides(
    building: Building, wall: BuildingWall, z: float, high: float, angle: float
) -> tuple[list[dict[str, Any]], dict[str, Any] | None]:
    """Return the wedges of side walls that come along, cracked at an angle [rad], and the friction of their courses.

    A crack at an angle leaves l - h_b tan(angle) of each overlap, on which courses rub [C8.7.1.2 for a vertical crack].
    """
    courses = building.interlock
    if wall.connection != "interlock" or courses is None:
        return [], None
    crossing = list[tuple[float, BuildingWall]]()  # height above the hinge
    thickness, slope, reach = wall.thick(_storey(building, wall, z)), tan(angle), inf
    for side in map(building.wall.__getitem__, wall.sides):
        low, top = side.reaches(building.count)
        height = min(building.levels[top], high) - z
        if height > 0 and building.levels[low] <= z:
            crossing.append((height, side))
            reach = min(reach, _reach(building, side, thickness, z))
    inner, wedges = -thickness / 2, list[dict[str, Any]]()
    cuts = {0.0, *(height for height, _ in crossing)} | {y for _, side in crossing for y in _steps(building, side, z)}
    for foot, head in pairwise(sorted(cuts)) if slope and reach else ():
        sides = [side for height, side in crossing if height >= head]
        along = [(side.thick(_storey(building, side, z + foot)), _density(building, side)) for side in sides]
        depth = sum(thick for thick, _ in along)
        bend = min(max(reach / slope, foot), head)  # above it the side walls have no more
        back = [[inner - min(y * slope, reach), y] for y in (head, bend, foot)]
        corners = [[_rounded(x), _rounded(y)] for x, y in ((inner, foot), (inner, head), *back)]
        distinct = [each for k, each in enumerate(corners) if each != corners[k - 1]]
        if abs(area_of([complex(*each) for each in distinct])) < LEAST_AREA:  # no wider than a rounding
            continue
        density = sum(thick * density for thick, density in along) / depth
        wedges.append({"polygon": distinct, "depth": depth, "density": density})
    rubbing = [(height, _thinnest(building, side, z), _density(building, side), reach) for height, side in crossing]
    return wedges, _friction(building, courses, slope, rubbing)


def _reach(building: Building, side: BuildingWall, crossing: float, z: float) -> float:
    """Return what can come along of a wall beyond a crossing one of a thickness, above a hinge [m]: up to an opening.

    Which of its ends meets the crossing wall is not known, so the opening nearest to either end counts.
    """
    opened = [each for each in side.openings if building.levels[each.storey - 1] + each.z + each.height > z]
    ends = [side.length, *(end for each in opened for end in (each.x, side.length - each.x - each.width))]
    given = building.interlock.reach if building.interlock is not None else None
    reach = side.length - crossing if given is not None else min(ends) - crossing
    return max(min(reach, given or inf), 0.0)


def _density(building: Building, wall: BuildingWall) -> float:
    return wall.density or building.masonry.density


def _steps(building: Building, wall: BuildingWall, z: float) -> set[float]:
    """Return the heights above a hinge at which a wall may change its thickness [m]."""
    top = building.levels[wall.reaches(building.count)[1]]
    return {y - z for y in building.levels if z < y < top} if isinstance(wall.thickness, list) else set()


def _thinnest(building: Building, wall: BuildingWall, z: float) -> float:
    """Return the least thickness of a wall above a hinge [m], on which less weight rubs than on others."""
    return min(wall.thick(each) for each in range(_storey(building, wall, z), wall.reaches(building.count)[1] + 1))


def joints(building: Building, wall: BuildingWall) -> list[float]:
    """Return the heights of the bed joints of a wall that interlocks, courses down from where it meets another [m]."""
    courses, levels = building.interlock, building.levels
    if wall.connection != "interlock" or courses is None:
        return []
    foot, top = (levels[level] for level in wall.reaches(building.count))
    tops = {min(levels[building.wall[name].reaches(building.count)[1]], top) for name in wall.sides}
    counts = [(each, range(1, floor((each - foot) / courses.course) + 1)) for each in tops]
    # Rounded down, so that no course is lost by a rounding.
    return sorted({floor(1e3 * (each - n * courses.course) + 1e-6) / 1e3 for each, rows in counts for n in rows})


def _friction(
    building: Building, courses: Courses, slope: float, walls: Sequence[tuple[float, float, float, float]]
) -> dict[str, Any] | None:
    """Return the friction of courses of walls, each of a height, thickness, density, and reach, on a crack of a slope.

    They are given as equal ones of the height of the highest, with the moment about the hinge that they have together.
    A wall rubs up to where the crack has run through its reach: in the lowest share b of its height is the share
    3 b^2 - 2 b^3 of the moment, as the weight grows with the depth below the top.
    """
    left = courses.overlap - courses.course * slope
    rows = [int(round(height / courses.course, 6)) for height, *_ in walls]
    if left <= LEAST_OVERLAP * courses.overlap or not any(rows):
        return None
    most, density, thickness = max(rows), building.masonry.density, 0.0
    for n, (height, thick, weighs, reach) in zip(rows, walls, strict=True):
        b = min(1.0, reach / (slope * height)) if slope else 1.0
        share = n**2 * (n + 1) / (most**2 * (most + 1)) * b**2 * (3 - 2 * b)
        thickness += thick * weighs / density * share / len(walls)
    if thickness <= LEAST_OVERLAP * max(thick for _, thick, *_ in walls):
        return None
    return {"courses": most, "overlap": round(left, 6), "thickness": thickness, "walls": len(walls),
            "friction": courses.friction, "height": _rounded(most * courses.course), "density": density}  # fmt: skip


def _storey(building: Building, wall: BuildingWall, z: float) -> int:
    """Return the storey of a wall at and above a height; below it its first, above it its last."""
    foot, top = wall.reaches(building.count)
    return min(max(foot + 1, bisect_right(building.levels, z)), top)


def overturning(
    building: Building, wall: BuildingWall, z: float, angle: float | None = None, *, gable: bool = True
) -> MadeMechanism:
    """Return a wall that overturns about a hinge at a height [m], with what stands on it and what comes along.

    Parameters
    ----------
    building, wall : Building, BuildingWall
    z : float
        Height of the hinge above the foundation [m].
    angle : float, optional
        Angle of the crack in side walls that interlock with it [rad]; by default that of the file.
    gable : bool
        Whether its gable turns with it; otherwise it has fallen before.

    Raises
    ------
    NotMade
        If nothing is left of it at some height.
    """
    top = building.levels[wall.reaches(building.count)[1]]
    parts = [*strips(building, wall, z, top), *_on_top(building, wall, gable=gable)]
    crack = angle if angle is not None else given_angle(building)
    wedges, friction = _sides(building, wall, z, top, crack)
    kind, fields = _body(parts, z, wedges)
    outer = parts[0].thickness / 2
    depth = fields["depth"]
    loads, ties = _loads(building, wall, z, outer, depth), _ties(building, wall, z, outer)
    fields |= _given(
        one_sided="positive", rebound=building.rebound, loads=loads, ties=ties, interlock=friction,
        crushing=_crushing(building, parts[0], depth), unusual=_meant(building, friction),
    )  # fmt: skip
    held = friction is not None or bool(wedges)
    name = f"{wall.name}: overturning{'' if gable else ' without its gable'} about {z:.4g} m"
    hinge = z, max(each.high for each in parts)
    stand = [each for each in (*building.gables, *building.parapets, *building.bell_gables) if each.wall == wall.name]
    if wedges or len(stand) > 1:
        fields = _by_its_numbers(fields, outer, beside=len(stand) > 1)
    return MadeMechanism(
        "overturning", wall.name, name, z, hinge, kind, fields, crack if held else None, without_gable=not gable
    )


def _by_its_numbers(fields: dict[str, Any], outer: float, *, beside: bool) -> dict[str, Any]:
    """Return the fields of a wall whose wedges have its centroid behind its foot: it leans on the building at rest.

    A body by its parts must stand on its foot; one by its numbers has a left foot as far behind as the wedges go.
    Of things beside each other on a wall the parts would overlap: they are by their numbers too.
    """
    plates = [[complex(*corner) for corner in each["polygon"]] for each in fields["parts"]]
    weighs = [each.get("density", fields["density"]) * each["depth"] for each in fields["parts"]]
    masses = [abs(area_of(corners)) * each for corners, each in zip(plates, weighs, strict=True)]
    bodies = [polygon("part", 1.0, corners) for corners in plates]
    whole = sum(masses)
    centroid = sum(mass * each.centroid for mass, each in zip(masses, bodies, strict=True)) / whole
    inner = min(each.real for each in plates[0])
    if (stands := centroid.real > inner) and not beside:
        return fields
    inertia = sum(m * (b.inertia + abs(b.centroid - centroid) ** 2) for m, b in zip(masses, bodies, strict=True))
    top, behind = max(each.imag for each in plates[0]), min(each.real for corners in plates for each in corners)
    high = max(each.imag for corners in plates for each in corners)
    numbers: dict[str, Any] = {
        "mass": round(whole, 3), "inertia": round(inertia, 3),
        "centroid": [_rounded(centroid.real), _rounded(centroid.imag)],
        "left_foot": [inner if stands else behind, 0.0], "right_foot": [_rounded(outer), 0.0], "depth": fields["depth"],
        "polygon": [[plates[0][0].real, 0.0], [outer, 0.0], [outer, max(top, high)], [behind, high]],
    }  # fmt: skip
    return numbers | {key: value for key, value in fields.items() if key not in ("parts", "density", "depth")}


def _meant(building: Building, friction: Mapping[str, Any] | None) -> list[str] | None:
    """Return the fields whose unusual values are meant: also the thickness of courses, which only stand for others."""
    return building.unusual if friction is None else [*(building.unusual or ()), "interlock.thickness"]


def given_angle(building: Building) -> float:
    """Return the angle of cracks that the file gives [rad]; 0 if they are searched."""
    angle = building.interlock.angle if building.interlock is not None else 0.0
    return float(np.radians(angle)) if isinstance(angle, float | int) else 0.0


def _crushing(building: Building, foot: Strip | None = None, depth: float = 0.0) -> dict[str, float] | None:
    """Return how a hinge crushes, on the length of the part above it where that is less than the depth."""
    strength = building.masonry.crushing
    if strength is None:
        return None
    return {"strength": strength} | ({"depth": foot.length} if foot is not None and foot.length < depth else {})


def held_levels(building: Building, wall: BuildingWall) -> list[int]:
    """Return the levels at which a wall is held sideways: its foot, floors that do not slide, and ties."""
    foot, top = wall.reaches(building.count)
    floors = {level for _, level, each in building.bearing if wall.name in each.walls and not each.sliding}
    ties = {each.level for each in building.ties if wall.name in each.walls}
    return [foot, *sorted(level for level in floors | ties if foot < level <= top)]


def _held_height(building: Building, wall: BuildingWall, level: int) -> float:
    """Return the height at which a wall is held at a level: that of its floor, without one of its ties [m]."""
    bears = any(at == level and wall.name in each.walls and not each.sliding for _, at, each in building.bearing)
    ties = [tie_height(building, each) for each in building.ties if each.level == level and wall.name in each.walls]
    return building.levels[level] if bears or not ties else min(ties)


def bending(building: Building, wall: BuildingWall, foot: int, top: int) -> MadeMechanism:
    """Return a wall that bends vertically between two levels that hold it, under what stands above.

    Raises
    ------
    NotMade
        If it has two thicknesses between them, or bears a floor there.
    """
    low, high = building.levels[foot], _held_height(building, wall, top)
    parts = strips(building, wall, low, high)
    if len({each.thickness for each in parts}) > 1:
        raise NotMade("thickness")
    between = [name for name, z, _ in _seats(building, wall, low) if z < high]
    if between:
        raise NotMade("between", names=", ".join(between))
    thickness, outer, g = parts[0].thickness, parts[0].thickness / 2, STANDARD_GRAVITY
    above = building.levels[wall.reaches(building.count)[1]]
    weights = [
        (g * each.mass, outer - each.thickness / 2)
        for each in [*(strips(building, wall, high, above) if above > high else ()), *_on_top(building, wall)]
    ]
    for _, z, each in _seats(building, wall, low):
        at = _bears_at(building, wall, z, outer, each)
        weights.append((g * each.load * each.span * wall.length / 2, at))
    load = sum(weight for weight, _ in weights)
    mass = sum(each.mass for each in parts)
    loaded = {"overburden": round(load, 1)} if load > OF_ITS_WEIGHT * g * mass else {}
    if loaded:
        loaded["overburden_eccentricity"] = _rounded(sum(weight * at for weight, at in weights) / load)
    fields = {"thickness": thickness, "height": _rounded(high - low), "hinge": "weakest", **loaded,
              "depth": wall.length, "density": round(mass / (thickness * (high - low) * wall.length), 4)}  # fmt: skip
    fields |= _given(unusual=building.unusual, friction=building.masonry.friction)
    name = f"{wall.name}: bending between {low:.4g} and {high:.4g} m"
    if (crushing := _crushing(building)) is not None:  # the weakest hinge is that of pivots on the faces
        free: Any = _registry()["spanning_wall"].from_fields(fields)
        weaker = min(Direction, key=free.uplift)
        fields |= {"hinge": round(free.hinges(weaker)[1].imag / (high - low), 6), "crushing": crushing}
    return MadeMechanism("bending", wall.name, name, (low + high) / 2, (low, high), "spanning_wall", fields)


def _on_top(building: Building, wall: BuildingWall, *, gable: bool = True) -> list[Strip]:
    """Return the parts of what stands on a wall."""
    parts, foot = list[Strip](), building.levels[wall.reaches(building.count)[1]]
    for each in (*(building.gables if gable else ()), *building.parapets, *building.bell_gables):
        if each.wall == wall.name:
            parts += _parts(building, each, foot)
    return parts


def _parts(building: Building, each: OnTop, low: float) -> list[Strip]:
    """Return the parts of what stands on a wall, of a gable those above a height [m]."""
    wall = building.wall[each.wall]
    top = wall.reaches(building.count)[1]
    foot, thickness, length = building.levels[top], each.thickness or wall.thick(top), each.length or wall.length
    density = each.density or wall.density or building.masonry.density
    if isinstance(each, Gable):
        ends = np.linspace(low, foot + each.height, STRIPS + 1).tolist()
        shares = [1 - ((a + b) / 2 - foot) / each.height for a, b in pairwise(ends)]
        return [Strip(a, b, thickness, length * k, density) for (a, b), k in zip(pairwise(ends), shares, strict=True)]
    return _pierced(Strip(foot, foot + each.height, thickness, length, density), getattr(each, "openings", []))


def arch(building: Building, wall: BuildingWall) -> MadeMechanism:
    """Return the top storey of a wall that bends horizontally, as an arch in its thickness between what confines it.

    The thrust is that of three hinges of a tenth of the thickness at 1.5 times the strength; its arm gives the printed
    strength f t^2/L^2 [EN 1996-1-1, 6.3.2], and decreases to zero.

    Raises
    ------
    NotMade
        If its thrust is not resisted, its strength not known, or it has openings or is too slender for the formula.
    """
    top = wall.reaches(building.count)[1]
    low, high = building.levels[top - 1], building.levels[top]
    confined, strength = wall.confined, building.masonry.compression
    if confined is None:
        raise NotMade("unconfined", exists=False)
    if strength is None:
        raise NotMade("no_strength", exists=False)
    if any(each.storey == top for each in wall.openings):
        raise NotMade("opened", exists=False)
    t, span, height = wall.thick(top), confined.length or wall.length, high - low
    if span > MOST_SLENDER_ARCH * t:
        raise NotMade("slender", exists=False, length=span, most=MOST_SLENDER_ARCH)
    thrust = ARCH_THRUST * strength / (building.masonry.gamma or 1.0) * t * height
    if thrust > confined.resistance:
        raise NotMade("spread", exists=False, thrust=thrust / 1e3, resistance=confined.resistance / 1e3)
    density = wall.density or building.masonry.density
    mass, rise = density * t * height * span, ARCH_RISE * t
    ratio = 8 * thrust * rise / (mass * STANDARD_GRAVITY * span)
    remarks = [] if ratio <= MOST_ARCH_RATIO else [Remark("stronger_arch", {"ratio": ratio, "most": MOST_ARCH_RATIO})]
    ratio = min(ratio, MOST_ARCH_RATIO)
    # Both halves turn by phi: the middle moves by phi L/2, and their mass by half of it on average.
    fields = {"points": [[0.0, round(ratio, 6)], [_rounded(rise), 0.0]], "control_height": span / 2,
              "centroid_height": span / 4, "mass": round(mass, 3),
              "inertia": round(mass * span**2 / 12, 3)}  # fmt: skip
    name = f"{wall.name}: horizontal arch above {low:.4g} m"
    return MadeMechanism("arch", wall.name, name, (low + high) / 2, (low, high), "curve", fields, remarks=remarks)


def standing(building: Building, each: OnTop, z: float | None = None) -> MadeMechanism:
    """Return what stands on a wall as it turns about its foot, or a gable about a higher hinge at `z` [m].

    Raises
    ------
    NotMade
        If openings leave nothing of it at some height.
    """
    foot = building.levels[building.wall[each.wall].reaches(building.count)[1]]
    low = foot if z is None else z
    parts = _parts(building, each, low)
    kind, fields = _body(parts, low)
    leans = isinstance(each, Gable)  # the roof behind it holds it
    if isinstance(each, BellGable) and each.bells is not None:
        fields["loads"] = [{"name": "bells", "mass": each.bells, "at": [0.0, each.bells_height]}]
    fields |= _given(
        one_sided="positive" if leans else None, rebound=building.rebound if leans else None,
        plane="width" if kind == "block" and not leans else None, unusual=building.unusual,
        crushing=_crushing(building, parts[0], max(strip.length for strip in parts)),
    )  # fmt: skip
    what = {"Gable": "gable", "BellGable": "bell gable"}.get(type(each).__name__, "parapet")
    name = f"{each.name or f'{what} of {each.wall}'}: overturning about {low:.4g} m"
    height = min(low, building.height)  # above the last level the motion is that of its top
    hinge, key = (low, foot + each.height), what.replace(" ", "_")
    return MadeMechanism(key, each.wall, name, height, hinge, kind, fields, part=each.name or "")


def _pierced(whole: Strip, openings: Sequence[Hole]) -> list[Strip]:
    """Return the parts of what stands on a wall, shortened by openings. Raises `NotMade` if nothing is left of one."""
    edges = {whole.low + z for each in openings for z in (each.z, each.z + each.height)}
    parts = []
    for a, b in pairwise(sorted({whole.low, whole.high, *(z for z in edges if whole.low < z < whole.high)})):
        taken = sum(e.width for e in openings if whole.low + e.z < (a + b) / 2 < whole.low + e.z + e.height)
        if taken >= whole.length:
            raise NotMade("openings", z=(a + b) / 2)
        parts.append(whole._replace(low=a, high=b, length=whole.length - taken))
    return parts


def corner(building: Building, k: int, z: float, angle: float) -> MadeMechanism:
    """Return a corner that turns outwards along its diagonal about a height [m], by cracks at an angle [rad].

    The plane is that of the diagonal, x = 0 at the outer edge. Where the walls meet is a column; of each wall the wedge
    behind the crack comes along, and its courses rub on what is left of their overlap, against the motion. A point at s
    along a wall and d into it is at x = -(s + d)/sqrt(2).
    """
    given = building.corners[k]
    walls, courses = [building.wall[name] for name in given.walls], building.interlock
    assert courses is not None  # a corner without interlock was refused
    top = min(building.levels[each.reaches(building.count)[1]] for each in walls)
    height, slope = top - z, tan(angle)
    densities = [_density(building, each) for each in walls]
    a, b = (each.thick(_storey(building, each, z)) for each in walls)
    reaches = [_reach(building, each, t, z) for each, t in zip(walls, (b, a), strict=True)]
    size = (a + b) / sqrt(2)
    steps = {y for each in walls for y in _steps(building, each, z) if y < height}
    pieces = list[tuple[float, complex, float]]()
    for foot, head in pairwise(sorted({0.0, height, *steps})):
        c, d = (each.thick(_storey(building, each, z + foot)) for each in walls)
        mass, at = c * d * (head - foot) * sum(densities) / 2, complex(-(c + d) / sqrt(8), (foot + head) / 2)
        pieces.append((mass, at, mass * ((c**2 + d**2) / 24 + (head - foot) ** 2 / 12)))
        for t, other, start, density, reach in zip((c, d), (d, c), (b, a), densities, reaches, strict=True):
            if slope and reach:
                bend = min(max(reach / slope, foot), head)
                back = [complex(other - start - min(y * slope, reach), y) for y in (head, bend, foot)]
                corners = [complex(0, foot), complex(0, head), *back]
                corners = [each for m, each in enumerate(corners) if each != corners[m - 1]]
                wedge = polygon("wedge", 1.0, [complex(each.real / sqrt(2), each.imag) for each in corners])
                mass, at = density * t * abs(area_of(corners)), wedge.centroid - (other + t / 2) / sqrt(2)
                pieces.append((mass, at, mass * (wedge.inertia + t**2 / 24)))
    loads = list[dict[str, Any]]()
    furthest = size + max(min(height * slope, each) for each in reaches) / sqrt(2)
    for wall, other, reach in zip(walls, (b, a), reaches, strict=True):
        for name, level, each in _seats(building, wall, z):
            along, t = other + min((level - z) * slope, reach), -_inner(building, wall, level, 0.0)
            x = -(along / 2 + t - (each.seat / 3 if each.seat is not None else t / 2)) / sqrt(2)
            place = [_rounded(x), _rounded(level - z)]
            how, mass = "sliding" if each.sliding else "borne", round(each.load * each.span * along, 3)
            loads.append(_given(name=f"{name} on {wall.name}", mass=mass, at=place, floor=how, seat=each.seat))
            if each.thrust:
                push = round(each.thrust * along / sqrt(2), 3)
                loads.append({"name": f"thrust of {name} on {wall.name}", "force": [push, 0.0], "at": place})
    if given.thrust:
        place = [_rounded(-size / 2), _rounded(height)]
        loads.append({"name": "hip rafter", "force": [given.thrust, 0.0], "at": place})
    whole = sum(mass for mass, _, _ in pieces)
    centroid = sum(mass * at for mass, at, _ in pieces) / whole
    inertia = sum(of_piece + mass * abs(at - centroid) ** 2 for mass, at, of_piece in pieces)
    fields: dict[str, Any] = {
        "mass": round(whole, 3), "inertia": round(inertia, 3),
        "centroid": [_rounded(centroid.real), _rounded(centroid.imag)],
        "left_foot": [_rounded(-size if centroid.real > -size else -furthest), 0.0], "right_foot": [0.0, 0.0],
        "polygon": [[_rounded(x), _rounded(y)] for x, y in ((-size, 0), (0, 0), (0, height), (-furthest, height))],
        "one_sided": "positive",
    }  # fmt: skip
    thin = [_thinnest(building, each, z) for each in walls]
    rubbing = [(height, *each) for each in zip(thin, densities, reaches, strict=True)]
    if (friction := _friction(building, courses, slope, rubbing)) is not None:
        fields["interlock"] = friction
    fields |= _given(loads=loads, rebound=building.rebound, unusual=_meant(building, friction))
    remarks = [Remark("edge", {})] if building.masonry.crushing is not None else []
    first, second = given.walls
    name = f"{given.name or f'corner of {first} and {second}'}: overturning about {z:.4g} m"
    which = given.name or "", second
    return MadeMechanism("corner", first, name, z, (z, top), "rigid_body", fields, angle, *which, remarks=remarks)


def with_bars(building: Building, level: int, diameter: float) -> Building:
    """Return the building with bars of another diameter [m] in the ties of a level."""
    ties = [each.model_copy(update={"diameter": diameter}) if each.level == level else each for each in building.ties]
    return building.model_copy(update={"ties": ties})
