"""The description of a building in one file: levels, walls, floors, roof, ties, and what stands on its walls."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from math import atan, degrees, inf
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, ValidationError

from rocking_cli.core.fields import Name, length, quantity
from rocking_cli.core.hung.ties import AnchorPlate, SteelName, partial_factor
from rocking_cli.errors import InputError
from rocking_cli.io.starters import italian
from rocking_cli.io.yaml_file import Document, Place, parse, read_text
from rocking_cli.studies.file_part import Part, Sound, problems_of
from rocking_cli.text import did_you_mean, in_short

HINT = "`rocking new building` prints one to start from"
USUAL_STOREY = (1.8, 12.0)  # m; other heights of a storey are asked about
USUAL_LOAD = (30.0, 2500.0)  # kg/m2, of a floor or roof
USUAL_THICKNESS = (0.08, 3.0)  # m
MOST_COURSE = 1.0  # m, of height and overlap of courses
MAX_WALLS = 500
NAMING = ("name", "wall", "walls", "sides", "on", "source")  # fields with words of the user

Height = Annotated[float, Field(ge=-1e3, le=1e3)]
Thickness = Annotated[float, Field(gt=0, le=1e3)]
Names = Annotated[list[Name], Field(min_length=1, max_length=MAX_WALLS)]


class Hole(Part):
    """A rectangular opening."""

    x: float = quantity("distance from the left end", unit="m", example=1.0, ge=0, le=1e3)
    z: float = quantity("height of its sill above the floor or foot", unit="m", example=0.9, ge=0, le=1e3)
    width: float = length("its width", example=1.0)
    height: float = length("its height", example=1.4)


class WallOpening(Hole):
    """An opening in a storey of a wall."""

    storey: int = quantity("storey in which it is, 1 at the foot", example=1, ge=1, le=200)


class Masonry(Part):
    """The masonry of the building."""

    density: float = quantity("its density, or weight per volume", unit="kg/m3", example=1800.0, gt=0, le=1e6)
    compression: float | None = quantity(
        "compressive strength, for anchor plates and horizontal bending", unit="Pa", default=None, ge=1e4, le=1e12
    )
    shear: float | None = quantity("shear strength, for anchor plates", unit="Pa", default=None, ge=1e3, le=1e12)
    gamma: float | None = partial_factor("both strengths are")
    source: Name | None = Field(None, description="where both strengths are from")
    friction: float | None = quantity(
        "coefficient of friction of the joints of walls that bend", default=None, gt=0, le=10
    )
    crushing: float | None = quantity(
        "compressive strength at which hinges crush; if omitted, unlimited", unit="Pa", default=None, gt=0, le=1e12
    )


class Courses(Part):
    """How blocks of crossing walls interlock, which decides what part of a side wall comes along with a wall."""

    course: float = length("height of a course", symbol="h_b", example=0.2)
    overlap: float = length("length by which blocks overlap", symbol="l", example=0.15)
    friction: float = quantity("coefficient of friction between courses", default=0.577, gt=0, le=2)
    angle: float | Literal["weakest"] = quantity(
        "angle of the crack in a side wall from the vertical, in degrees, or weakest: searched up to that of joints",
        default="weakest",
    )
    reach: float | None = length(
        "length of side walls that can come along, such as up to their first opening; if omitted, all", default=None
    )

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the crack is not flatter than its joints allow."""
        for key in ("course", "overlap"):
            if sound(key) and given.get(key, 0) > MOST_COURSE:
                guess = f": did you mean {given[key]:g} cm?" if given[key] / 100 <= MOST_COURSE else ""
                yield (key,), f"is {given[key]:g} m, more than blocks of masonry have, {MOST_COURSE:g} m{guess}"
        angle = given.get("angle")
        if isinstance(angle, float | int) and all(sound(key) for key in ("course", "overlap", "angle")):
            most = degrees(atan(given["overlap"] / given["course"]))
            if not 0 <= angle <= most:
                yield ("angle",), f"must be from 0 to {most:.4g} degrees, that of the joints (overlap over course)"

    @property
    def steepest(self) -> float:
        """The crack that follows the joints: its angle from the vertical [rad]."""
        return atan(self.overlap / self.course)


class Confinement(Part):
    """What resists the thrust of a wall that bends horizontally, as an arch between its ends."""

    resistance: float = quantity(
        "thrust that each end resists: of a buttress, a cross wall, or ties along the wall", unit="N", example=2e5,
        gt=0, le=1e12,
    )  # fmt: skip
    length: float | None = length("distance between what resists; if omitted, the length of the wall", default=None)


class BuildingWall(Part):
    """A wall, seen from outside: it overturns outwards."""

    refused: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("leaves", "cavity"),
        "a cavity wall is two walls that move apart: describe each leaf as a wall with its own thickness, and have the "
        "floors bear on the leaf that carries them",
    )

    name: Name = Field(description="what to call it")
    length: float = length("its length", example=8.0)
    thickness: float | list[Thickness] = quantity(
        "its thickness, or one for each of its storeys from below; outer faces are flush", unit="m",
        example=[0.6, 0.5, 0.4],
    )  # fmt: skip
    storeys: Annotated[list[int], Field(min_length=2, max_length=2)] | None = Field(
        None, description="first and last storey that it has; if omitted, all"
    )
    on: Name | None = Field(None, description="what carries a wall that does not begin at the foundation")
    density: float | None = quantity("density, if not that of the masonry", unit="kg/m3", default=None, gt=0, le=1e6)
    openings: list[WallOpening] = Field([], max_length=1000, description="its openings")
    sides: list[Name] = Field([], max_length=2, description="walls that it meets at its ends")
    connection: Literal["none", "interlock", "ties"] = Field("none", description="how they hold it")
    confined: Confinement | None = Field(None, description="what resists its thrust as a horizontal arch, if anything")

    def reaches(self, count: int) -> tuple[int, int]:
        """Return the levels at its foot and at its top, of a building of `count` storeys."""
        first, last = self.storeys or (1, count)
        return first - 1, last

    def thick(self, storey: int) -> float:
        """Return its thickness in a storey, from 1 [m]."""
        if isinstance(self.thickness, float):
            return self.thickness
        return self.thickness[storey - (self.storeys or (1, 0))[0]]


class Bearing(Part):
    """A floor or roof that walls bear."""

    load: float = quantity("its load in the earthquake, per area", unit="kg/m2", example=450.0, gt=0, le=1e9)
    span: float = length("its span, half of which each wall bears", example=5.0)
    walls: Names = Field(description="the walls that bear it")
    seat: float | None = length("length of its bearing on the wall", default=None)
    sliding: bool = Field(False, description="whether it slides on its bearing; otherwise it is held to the wall")
    thrust: float = quantity("its outward thrust for a metre of wall", unit="N/m", default=0.0, ge=0, le=1e9)


class BuildingFloor(Bearing):
    """A floor."""

    name: Name = Field(description="what to call it")
    level: int = quantity("level at which it is, 1 above the first storey", example=1, ge=1, le=200)


class BuildingTie(Part):
    """Steel ties at a level, each between two walls."""

    name: Name = Field("tie", description="what to call it")
    level: int = quantity("level at which they are", example=2, ge=1, le=200)
    below: float = quantity("how far below the level", unit="m", default=0.0, ge=0, le=100)
    walls: Names = Field(description="the walls that they hold")
    length: float = length("their free length, between the walls", example=5.0)
    bars: int = quantity("number of bars on each of these walls", example=2, ge=1, le=10_000)
    diameter: float = quantity("diameter of a bar", unit="m", symbol="d", example=0.024, gt=0, le=1)
    steel: SteelName | None = Field(None, description="steel of the bars")
    yield_stress: float | None = quantity(
        "instead of `steel`: its yield stress", unit="Pa", default=None, ge=1e7, le=1e12, alias="yield"
    )
    gamma: float | None = partial_factor("its yield stress is")
    source: Name | None = Field(None, description="where its yield stress is from, such as a test")
    plate: AnchorPlate | None = Field(None, description="anchor plate of each bar")
    elongation: float | None = quantity("elongation up to which they hold", default=None, gt=0, le=0.5)

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the steel is given once."""
        if (given.get("steel") is None) == (given.get("yield") is None):
            yield ("steel",), "give the steel, or its stress as `yield`: one of the two"


class OnTop(Part):
    """Something that stands on a wall."""

    name: Name | None = Field(None, description="what to call it")
    wall: Name = Field(description="the wall on which it stands")
    height: float = length("its height", example=2.5)
    thickness: float | None = length("its thickness; if omitted, that of the wall at its top", default=None)
    length: float | None = length("its length; if omitted, that of the wall", default=None)
    density: float | None = quantity("density, if not that of the wall", unit="kg/m3", default=None, gt=0, le=1e6)


class Gable(OnTop):
    """A triangular gable, of the length of its base."""


class Parapet(OnTop):
    """A parapet: it rocks to either side."""


class BellGable(OnTop):
    """A bell gable: a thin wall with openings for its bells, which rocks to either side."""

    openings: list[Hole] = Field([], max_length=20, description="its openings")
    bells: float | None = quantity("mass of the bells", unit="kg", default=None, gt=0, le=1e6)
    bells_height: float | None = length("height at which the bells hang, above its foot", default=None)

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that bells hang somewhere."""
        if (given.get("bells") is None) != (given.get("bells_height") is None):
            yield ("bells_height",), "bells have a mass and a height: give both"
        within = ("z", "height", "above the foot", "high"), ("x", "width", "from the left end", "long")
        openings = _list(given.get("openings")) if sound("openings") else []
        for k, each in enumerate(openings):
            for (at, size, where, what), key in zip(within, ("height", "length"), strict=True):
                if sound(key) and (end := each[at] + each[size]) > _number(given.get(key), inf):
                    yield ("openings", k), f"ends {end:g} m {where} of a gable {given[key]:g} m {what}"
            if any(_overlap(each, other) for other in openings[:k]):
                yield ("openings", k), "overlaps another opening of the gable"


class WallCorner(Part):
    """A corner of two walls that interlock, which may turn outwards along its diagonal."""

    name: Name | None = Field(None, description="what to call it")
    walls: Annotated[list[Name], Field(min_length=2, max_length=2)] = Field(description="the two walls")
    thrust: float = quantity("thrust of a hip rafter on it, along the diagonal", unit="N", default=0.0, ge=0, le=1e9)


class Building(Part):
    """A building by its walls, of which all mechanisms out of plane follow."""

    meanings: ClassVar[Mapping[str, str]] = {"storeys": "levels", "heights": "levels", "chains": "ties"}

    name: Name | None = Field(None, description="what to call it")
    site: dict[str, Any] | str | None = Field(None, description="its site: the file, or its fields")
    levels: Annotated[list[Height], Field(min_length=2, max_length=200)] = quantity(
        "heights of foot, floors and top of the walls above the foundation", unit="m", example=[0.0, 3.5, 6.5]
    )
    language: Literal["en", "it"] | None = Field(None, description="language of answers on it, en or it")
    T1: float | None = quantity(
        "first period of the undamaged building; if omitted, 0.05 H^(3/4)", unit="s", default=None, gt=0, le=10
    )
    masonry: Masonry = Field(description="its masonry")
    interlock: Courses | None = Field(None, description="how its walls interlock")
    walls: Annotated[list[BuildingWall], Field(min_length=1, max_length=MAX_WALLS)] = Field(description="its walls")
    floors: list[BuildingFloor] = Field([], max_length=MAX_WALLS, description="its floors")
    roof: Bearing | None = Field(None, description="its roof, at the last level")
    ties: list[BuildingTie] = Field([], max_length=MAX_WALLS, description="its ties")
    gables: list[Gable] = Field([], max_length=MAX_WALLS, description="its gables")
    parapets: list[Parapet] = Field([], max_length=MAX_WALLS, description="its parapets")
    bell_gables: list[BellGable] = Field([], max_length=MAX_WALLS, description="its bell gables")
    corners: list[WallCorner] = Field([], max_length=MAX_WALLS, description="its corners")
    rebound: float | None = quantity(
        "rate after an impact on the building over that before, for time histories", default=None, ge=0, lt=1
    )
    unusual: list[Name] | None = Field(None, description="fields whose unusual values are meant")

    @property
    def count(self) -> int:
        """Number of storeys."""
        return len(self.levels) - 1

    @property
    def height(self) -> float:
        """H, from the foundation to the top of the walls [m]."""
        return self.levels[-1]

    @cached_property
    def wall(self) -> Mapping[str, BuildingWall]:
        """The walls by their names."""
        return {each.name: each for each in self.walls}

    @property
    def bearing(self) -> list[tuple[str, int, Bearing]]:
        """Floors and roof with their names and levels."""
        of = [(each.name, each.level, each) for each in self.floors]
        return [*of, ("roof", self.count, self.roof)] if self.roof is not None else [*of]

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that levels grow, and that walls, floors, ties and all else are where others need them."""
        levels, walls, meant = given.get("levels"), _list(given.get("walls")), given.get("unusual") or ()
        if not levels or not sound("levels"):
            return
        for k, (low, high) in enumerate(pairwise(levels), 1):
            if high <= low:
                yield ("levels", k), f"is at {high:g} m, not above level {k - 1} at {low:g} m: storeys overlap"
                return
            if not USUAL_STOREY[0] <= high - low <= USUAL_STOREY[1] and "levels" not in meant:
                guess = f"did you mean {high - low:g} cm? " if USUAL_STOREY[0] <= (high - low) / 100 <= 12 else ""
                yield ("levels", k), f"makes storey {k} {high - low:g} m high: {guess}{_if_meant('levels')}"
        if not all(isinstance(each, dict) and isinstance(each.get("name"), str) for each in walls or [None]):
            return
        strengths: Any = given.get("masonry") if isinstance(given.get("masonry"), dict) else {}
        for k, each in enumerate(_list(given.get("ties"))):
            if isinstance(each, dict) and each.get("plate") and not {"compression", "shear"} <= {*strengths}:
                yield ("ties", k, "plate"), "bears on masonry: give `compression` and `shear` of `masonry`"
        named = {each["name"]: each for each in walls}
        for name, count in Counter(each["name"] for each in walls).items():
            if count > 1:
                yield ("walls",), f"has {count} walls called {name}: give each a name of its own"
        for k, each in enumerate(walls):
            if sound("walls", k):
                for place, message in _of_wall(each, named, given, meant):
                    yield ("walls", k, *place), message
        for place, message in _of_what_bears(given, named):
            if sound(*place):
                yield place, message


def _list(value: Any) -> list[Any]:
    """Return a list that may be wrong or left out, then as an empty one."""
    return value if isinstance(value, list) else []


def _number(value: Any, otherwise: float = 0.0) -> float:
    """Return a number that may be wrong or left out, then as another one."""
    return float(max(-1e300, min(value, 1e300))) if isinstance(value, float | int) else otherwise


def _if_meant(name: str) -> str:
    return f"if it is meant, add `unusual: [{name}]`"


def _reach(wall: Mapping[str, Any], count: int) -> tuple[int, int]:
    first, last = wall.get("storeys") or (1, count)
    return first - 1, last


def _of_wall(
    wall: Mapping[str, Any], named: Mapping[str, Any], given: Mapping[str, Any], meant: Sequence[str]
) -> Iterator[tuple[Place, str]]:
    """Yield what is wrong with a wall among the others."""
    levels = given["levels"]
    count, (foot, top) = len(levels) - 1, _reach(wall, len(levels) - 1)
    if not 0 <= foot < top <= count:
        yield ("storeys",), f"must be from 1 to {count}, the first not above the last: got {wall['storeys']}"
        return
    if foot > 0 and wall.get("on") is None:
        yield (
            ("storeys",),
            (
                f"begins at storey {foot + 1}, with nothing below: name what carries it, such as `on: beam`, or let it "
                "begin at storey 1"
            ),
        )
    thick = wall["thickness"] if isinstance(wall["thickness"], list) else [wall["thickness"]] * (top - foot)
    if len(thick) != top - foot:
        yield ("thickness",), f"has {len(thick)} values for {top - foot} storeys: give one for each, or one for all"
        return
    for each in thick:
        if not USUAL_THICKNESS[0] <= each <= USUAL_THICKNESS[1] and "thickness" not in meant:
            guess = f"did you mean {each:g} cm? " if USUAL_THICKNESS[0] <= each / 100 <= USUAL_THICKNESS[1] else ""
            yield ("thickness",), f"is {each:g} m: {guess}{_if_meant('thickness')}"
            break
    openings = wall.get("openings") or []
    for k, one in enumerate(openings):
        storey = one["storey"]
        if not foot < storey <= top:
            yield ("openings", k, "storey"), f"is {storey}, but the wall has storeys {foot + 1} to {top}"
            continue
        high = levels[storey] - levels[storey - 1]
        if (end := one["x"] + one["width"]) > wall["length"]:
            yield ("openings", k), f"ends {end:g} m from the left end of a wall {wall['length']:g} m long"
        if one["z"] + one["height"] > high:
            yield ("openings", k), f"ends {one['z'] + one['height']:g} m above the floor of a storey {high:g} m high"
        if any(one is not other and _overlap(one, other) for other in openings[:k]):
            yield ("openings", k), "overlaps another opening of the wall"
    others = {name: each for name, each in named.items() if name != wall["name"]}
    for k, each in enumerate(sides := wall.get("sides") or []):
        if each not in others:
            yield ("sides", k), f"there is no other wall called {each}: {_known(each, others)}"
        elif each in sides[:k]:
            yield ("sides", k), f"is {each} again: name each wall that it meets once"
    if wall.get("connection") == "interlock":
        if not given.get("interlock"):
            yield ("connection",), "needs `interlock` of the building: height of courses and overlap of blocks"
        if not wall.get("sides"):
            yield ("connection",), "interlocks with no wall: name the walls at its ends in `sides`"
    ties = [each for each in _list(given.get("ties")) if isinstance(each, dict)]
    holds = [each for each in ties if wall["name"] in _list(each.get("walls"))]
    if wall.get("connection") == "ties" and not holds:
        yield ("connection",), "is by ties, but no tie of the file is on this wall: add it to the `walls` of a tie"


def _overlap(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    sides = (("x", "width"), ("z", "height"))
    pairs = ((one, other), (other, one))
    return one.get("storey") == other.get("storey") and all(
        a[at] < b[at] + b[size] for at, size in sides for a, b in pairs
    )


def _thick(wall: Mapping[str, Any], k: int) -> float:
    """Return the thickness of a wall in a storey, from 0 at its foot [m]; infinite if it is wrong."""
    thick = wall.get("thickness")
    return _number((thick[k] if k < len(thick) else None) if isinstance(thick, list) else thick, inf)


def _known(name: str, named: Mapping[str, Any]) -> str:
    return did_you_mean(name, list(named)) or f"walls are {in_short(list(named)) or 'none'}"


def _of_what_bears(given: Mapping[str, Any], named: Mapping[str, Any]) -> Iterator[tuple[Place, str]]:
    """Yield what is wrong with floors, roof, ties, corners and what stands on walls."""
    count = len(given["levels"]) - 1

    def on_walls(place: Place, part: Mapping[str, Any], level: int) -> Iterator[tuple[Place, str]]:
        if not 1 <= level <= count:
            yield (*place, "level"), f"must be from 1 to {count}, got {level}"
            return
        for k, name in enumerate(_list(part.get("walls"))):
            if not isinstance(name, str):
                continue
            if name not in named:
                yield (*place, "walls", k), f"there is no wall called {name}: {_known(name, named)}"
            elif not (reach := _reach(named[name], count))[0] < level <= reach[1]:
                what = f"the wall {name} goes from level {reach[0]} to {reach[1]}, and does not reach level {level}"
                yield (*place, "walls", k), what
            elif _number(part.get("seat")) > (thick := _thick(named[name], level - 1 - reach[0])):
                yield (*place, "seat"), f"is more than the thickness of {name} below it, {thick:g} m"

    borne: list[tuple[Place, Any]] = [(("roof",), given.get("roof"))]
    borne += [((key, k), part) for key in ("floors", "ties") for k, part in enumerate(_list(given.get(key)))]
    taken = set[tuple[str, ...]]()
    for place, part in borne:
        if not isinstance(part, dict):
            continue
        is_tie, level = place[0] == "ties", count if place == ("roof",) else part.get("level")
        for wall in dict.fromkeys(map(str, _list(part.get("walls")))):
            called = part.get("name", "tie" if is_tie else "roof")
            if (mark := (wall, str(called), str(is_tie and level))) in taken:
                yield (*place, "name"), f"is that of another on {wall}: give each a name of its own"
            taken.add(mark)
        if isinstance(level, int):
            yield from on_walls(place, part, level)
            if is_tie and 1 <= level <= count:
                yield from (((*place, *field), why) for field, why in _of_tie(part, given, named))
        load = _number(part.get("load"), USUAL_LOAD[0])
        if not USUAL_LOAD[0] <= load <= USUAL_LOAD[1] and "load" not in _list(given.get("unusual")):
            guess = f"did you mean {load:g} {'kN/m2' if load < USUAL_LOAD[0] else 'N/m2'}? "
            yield (*place, "load"), f"is {load:.4g} kg/m2: {guess}{_if_meant('load')}"
    for key in ("gables", "parapets", "bell_gables"):
        for k, each in enumerate(_list(given.get(key))):
            if not isinstance(each, dict) or not isinstance(name := each.get("wall"), str):
                continue
            if name not in named:
                yield (key, k, "wall"), f"there is no wall below called {name}: {_known(name, named)}"
            elif _number(each.get("length")) > _number(named[name].get("length"), inf):
                yield (key, k, "length"), f"is more than that of the wall, {named[name]['length']:g} m"
    for k, each in enumerate(_list(given.get("corners"))):
        for m, name in enumerate(_list(each.get("walls")) if isinstance(each, dict) else ()):
            if not isinstance(name, str):
                continue
            if name not in named:
                yield ("corners", k, "walls", m), f"there is no wall called {name}: {_known(name, named)}"
            elif name in each["walls"][:m]:
                yield ("corners", k, "walls", m), f"is {name} again: a corner is of two walls"
            elif m and (other := named.get(str(each["walls"][0]))) is not None:
                reaches = _reach(named[name], count), _reach(other, count)
                if max(foot for foot, _ in reaches) >= min(top for _, top in reaches):
                    yield ("corners", k, "walls", m), f"has no storey in common with {other['name']}"
        if not given.get("interlock"):
            yield ("corners", k), "needs `interlock` of the building: without it the walls overturn each for itself"


def _of_tie(tie: Mapping[str, Any], given: Mapping[str, Any], named: Mapping[str, Any]) -> Iterator[tuple[Place, str]]:
    """Yield what is wrong with the height of ties."""
    levels, level, below = given["levels"], tie["level"], _number(tie.get("below"))
    if below >= levels[level] - levels[level - 1]:
        yield ("below",), "is more than the height of the storey: name the level next above it"
    plate: Any = tie.get("plate")
    half = _number(plate.get("height")) / 2 if isinstance(plate, dict) else 0.0
    gabled = [each.get("wall") for each in _list(given.get("gables")) if isinstance(each, dict)]
    for name in (each for each in _list(tie.get("walls")) if isinstance(each, str) and each in named):
        is_top = level == _reach(named[name], len(levels) - 1)[1] and name not in gabled
        if is_top and below < half:
            yield ("below",), f"has plates that end above the top of {name}: give at least `below: {half:g}`"


def one_sided_toothing(building: Building) -> list[tuple[str, str]]:
    """Return the pairs of walls of which the first interlocks with the second, and the second with none."""
    interlocks = [each for each in building.walls if each.connection == "interlock"]
    return [(each.name, name) for each in interlocks for name in each.sides if building.wall[name].connection == "none"]


def read_building(path: Path) -> Building:
    """Read a building from its file, in English or Italian. Raises `InputError` with every problem of the file."""
    return building_of(parse(read_text(path, "building"), str(path), "building", HINT))


def is_building(given: object) -> bool:
    """Return whether the argument of a command is the file of a building: YAML that gives levels and no mechanism."""
    if not isinstance(given, str | Path) or Path(given).suffix.lower() not in (".yaml", ".yml"):
        return False
    try:
        keys = parse(read_text(Path(given), "structure"), str(given), "structure", "").data
    except InputError:  # the reader of structures says what is wrong
        return False
    return "mechanism" not in keys and not keys.keys().isdisjoint(("levels", "livelli", "walls", "pareti"))


def building_of(document: Document) -> Building:
    """Return the building in a parsed file. Raises `InputError` with every problem: place, field, and remedy."""
    if "mechanism" in document.data:
        problem = document.at(("mechanism",), "is of a structure, and this command takes a building", HINT, key=True)
        raise InputError(*document.problems, problem)
    _in_english(document)
    building = None
    try:
        building = Building.model_validate(document.data)
    except ValidationError as error:
        document.problems += problems_of(document, Building, error, owner="the building", lister=HINT)
    document.check()
    assert building is not None  # a file without a valid building was refused
    return building


def _in_english(document: Document) -> None:
    """Give the fields of a file, and words that are values of fields, their English names."""
    fields, words = italian()["building"], italian()["building_words"]

    def of(value: Any, place: Place = ()) -> Any:
        if isinstance(value, dict):
            english: dict[Any, Any] = {}
            for key, each in value.items():
                if (name := fields.get(key, key)) in english:
                    document.problems.append(document.at((*place, key), f"is {name}, which is given too", key=True))
                if name == "unusual":
                    each = [fields.get(word, word) if isinstance(word, str) else word for word in _list(each)] or each
                english[name] = each if name in NAMING and not _has_parts(each) else of(each, (*place, key))
            return english
        if isinstance(value, list):
            return [of(each, (*place, k)) for k, each in enumerate(value)]
        word = words.get(value, value) if isinstance(value, str) else value
        return {"true": True, "false": False}.get(word, word) if isinstance(word, str) else word

    document.data = of(document.data)
    for marks in (document.keys, document.values):
        renamed = {
            tuple(fields.get(each, each) if isinstance(each, str) else each for each in at): marks[at] for at in marks
        }
        marks.clear()
        marks.update(renamed)


def _has_parts(value: Any) -> bool:
    return isinstance(value, list) and any(isinstance(each, dict) for each in value)
