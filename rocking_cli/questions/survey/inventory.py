"""A collection as its owner lists it: objects with their sides, weights, rooms and supports, each as a structure.

A list has no column of mechanisms. Its words are those of `data/inventory.toml`.
"""

from __future__ import annotations

import re
import tomllib
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import cache, cached_property
from importlib.resources import files
from math import inf, pi
from typing import Any, NamedTuple
from unicodedata import combining, normalize

import numpy as np
from pydantic import ValidationError

from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.registry import Registry
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.io.field_problems import of_arguments
from rocking_cli.io.spreadsheet import Row, Spreadsheet, unit_in
from rocking_cli.processing.oscillator import Floor, peak_displacement
from rocking_cli.questions.margin.study import Limits
from rocking_cli.studies.engines.solid_body import SolidBody
from rocking_cli.text import cut, one_line
from rocking_cli.units import UnitError, kind_of, read
from rocking_cli.verification.code import SiteFile

UNITS = {
    "height": "m", "width": "m", "depth": "m", "diameter": "m", "foot": "m", "foot_depth": "m", "centre": "m",
    "mass": "kg", "friction": "", "edge": "m", "gap": "m", "wax_area": "m2", "wax_tension": "Pa", "wax_shear": "Pa",
    "wire": "N", "wire_height": "m", "period": "s", "damping": "%", "stroke": "m",
}  # fmt: skip
"""Fields that are numbers, with the unit in which they are kept; a damping in % is kept as a ratio."""
SIDES = ("height", "width", "depth", "diameter", "foot", "foot_depth", "centre", "mass")
BARE = ("friction", "damping", "period")
"""Fields whose numbers may have no unit."""
SAME_SIDE = 0.01  # relative difference of sides that count as equal
NEAREST_HEADING = 0.8  # similarity of a heading to a word, from which that is named
SOLID = 0.5  # of the density of a material, above which nothing is hollow
LIGHTEST = 0.02  # of the mass of a solid: a lighter body is questioned
FAR_GROUND = 40.0  # m: half of the width of the ground below objects on objects, which none of them leaves
DEFAULT_DAMPING = 0.05
ROMAN = ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII")
LIKELY_SIDES = 0.02, 5.0  # m, between which a side is not questioned
MOST_FRICTION = 2.0
NEVER_ROCKS = 1.0  # half of the foot over the height of the centroid, from which no usual friction lets it rock
AT_REST = GroundMotion("at rest", 0.01, np.zeros(2), unit="m/s2")  # tells whether an isolator can be
BALLAST_HEIGHT = 0.05  # of the middle of what is put in its foot, over the height of an object
_LETTER = r"height|width|depth|diam(?:eter)?|dia|altezza|larghezza|profondita|alt|largh?|prof|h|w|d|l|p|ø"
_SIDE = re.compile(
    rf"\(?(?P<before>{_LETTER})?\)?[\s.:]*(?P<number>[0-9]+(?:[.,][0-9]+)?)\s*(?P<unit>mm|cm|m|in|ft)?\.?"
    rf"\s*\(?(?P<after>{_LETTER})?\)?\s*(?P<last>mm|cm|m|in)?\.?"
)
_LETTERS = {"h": "height", "alt": "height", "height": "height", "altezza": "height", "w": "width", "l": "width",
            "larg": "width", "largh": "width", "width": "width", "larghezza": "width", "d": "depth", "p": "depth",
            "prof": "depth", "depth": "depth", "profondita": "depth", "ø": "diameter", "diam": "diameter",
            "dia": "diameter", "diameter": "diameter"}  # fmt: skip
_QUANTITY = re.compile(r"(?<![\w.,])([0-9]*[.,]?[0-9]+)\s*(kPa|MPa|Pa|kN|N|mm2|cm2|m2|mm|cm|m|in|s|%)?(?![\w])")
_TRAILING = re.compile(r"(?i)(.*?)[\s,_/]+(?:in\s+)?(mm|cm|m|kg|g|lb|ft)\.?")
_CLAUSES = re.compile(r"\s*[;+]\s*|,\s+|,(?=\D)")


@cache
def catalogue() -> Mapping[str, Any]:
    """Return the words of lists, by kind of word and then by what they mean."""
    return tomllib.loads((files("rocking_cli") / "data" / "inventory.toml").read_text(encoding="utf-8"))


def plain(text: str) -> str:
    """Return a text in small letters, without accents and signs.

    Examples
    --------
    >>> plain("Inv. no."), plain("Profondità"), plain("N_INV")
    ('inv no', 'profondita', 'n inv')
    """
    letters = "".join(sign for sign in normalize("NFKD", text.casefold()) if not combining(sign))
    return " ".join(re.sub(r"[^\w°ø%]+|_", " ", letters).split())


class Isolator(NamedTuple):
    """A base that lets an object move sideways: period [s], damping ratio, and stroke [m]."""

    period: float
    damping: float
    stroke: float

    @property
    def floor(self) -> Floor:
        """The oscillator that it is, as a floor."""
        return Floor(self.period, self.damping, 1.0, 1.0)


@dataclass(frozen=True, kw_only=True)
class ListedObject:
    """An object of a collection; lengths in m, masses in kg, stresses in Pa, forces in N, None where not given.

    Parameters
    ----------
    inventory : Inventory
        The list.
    row : Row
        Its row.
    code, title, room, kind, material : str
        Number, name, room, kind and material, as they are written, the kind as the list is read; empty if not given.
    sizes : mapping of str to float
        What the row gives of `UNITS`, by field.
    on : str
        Code of the object it stands on; empty for none.
    raised : bool
        Whether it stands on a shelf, or on something else that is taken as rigid.
    floor : Floor, optional
        The floor it stands on; None for that of the motions.
    storey : int, optional
        Number of storeys below it.
    plane : str
        "width" if it cannot rock about its depth; otherwise empty.
    ballast : float
        Mass put in its foot [kg].
    remarks, questions : sequence of str
        How the row was read, and what looks like a mistake in it.
    wrong : InputError, optional
        Why the row cannot be used.
    """

    inventory: Inventory
    row: Row
    code: str = ""
    title: str = ""
    room: str = ""
    kind: str = "block"
    material: str = ""
    sizes: Mapping[str, float] = field(default_factory=dict)
    on: str = ""
    raised: bool = False
    floor: Floor | None = None
    storey: int | None = None
    plane: str = ""
    ballast: float = 0.0
    remarks: Sequence[str] = ()
    questions: Sequence[str] = ()
    wrong: InputError | None = None

    @property
    def line(self) -> int:
        """Line of the row."""
        return self.row.line

    @property
    def name(self) -> str:
        """Code and name of the object."""
        return " ".join(filter(None, [self.code, self.title])) or f"row {self.line}"

    @property
    def is_round(self) -> bool:
        """Whether its foot is a circle."""
        return "diameter" in self.sizes

    @property
    def is_hollow(self) -> bool:
        """Whether there is room for sand or weights in it: by its kind, unless it is as heavy as half of a solid."""
        materials = _materials_in(self.material)
        dense = self.mass is not None and bool(materials) and self.density > SOLID * max(each[0] for each in materials)
        return self.kind in catalogue()["of_kinds"]["hollow"] and not dense

    @property
    def density(self) -> float:
        """Its mass over the volume of its sides [kg/m3]."""
        (width, _), (depth, _) = (self.widths(turned=turned) for turned in (False, True))
        return (self.mass or 0.0) / (width * depth * self.height * (pi / 4 if self.is_round else 1.0))

    @property
    def foot_area(self) -> float:
        """Area of its foot [m2]."""
        (_, foot), (_, deep) = (self.widths(turned=turned) for turned in (False, True))
        return foot * deep * (pi / 4 if self.is_round else 1.0)

    @property
    def cracks(self) -> bool:
        """Whether its material cracks rather than bends."""
        return self.material != "" and any(brittle for _, brittle, _ in _materials_in(self.material))

    @property
    def mass(self) -> float | None:
        """Its mass [kg]."""
        return self.sizes.get("mass")

    @property
    def height(self) -> float:
        """Its height [m]."""
        return self.sizes["height"]

    @property
    def centre(self) -> float:
        """Height of its centroid [m]."""
        return self.sizes.get("centre", self.height / 2)

    def widths(self, *, turned: bool = False) -> tuple[float, float]:
        """Return the width of the body and of its foot in a plane [m]: that of its width, or turned, of its depth."""
        sizes = self.sizes
        if self.is_round:
            return sizes["diameter"], sizes.get("foot", sizes["diameter"])
        width, depth = (sizes.get(key) for key in ("width", "depth"))
        body = (depth or width) if turned else (width or depth)
        assert body is not None  # checked when it was read
        foot, other = (sizes.get(key) for key in (("foot_depth", "foot") if turned else ("foot", "foot_depth")))
        if foot is None and other is not None:  # that of the other plane, which may be the wider one
            is_square = width is None or depth is None or abs(width / depth - 1) <= SAME_SIDE
            foot = other if is_square else min(body, other)
        return body, body if foot is None else foot

    @property
    def least_foot(self) -> float:
        """The smaller side of its foot [m]."""
        return min(self.widths(turned=turned)[1] for turned in (False, True))

    @property
    def chain(self) -> list[ListedObject]:
        """It and the objects below it, the lowest first. Raises `InputError` if one is missing, or they go round."""
        chain = [self]
        while chain[0].on:
            below = self.inventory.by_code.get(chain[0].on)
            if below is None or below in chain:
                what = f"stands on {cut(chain[0].on)}, which is not in the list" if below is None else (
                    "stands on itself, as " + ", ".join(f"{each.code} stands on {each.on}" for each in chain)
                )  # fmt: skip
                raise InputError(self._problem(what, "support"))
            chain.insert(0, below)
        return chain

    @property
    def carried(self) -> list[ListedObject]:
        """The objects that stand on it, and those on them."""
        above = [self]
        for below in above:  # grows
            rows = [each.row for each in above]
            above += [each for each in self.inventory.standing_on(below) if all(each.row is not row for row in rows)]
        return above[1:]

    @property
    def whole(self) -> tuple[float, float]:
        """Mass [kg] and height of the centroid [m] of it and all that stands on it; its mass is given."""
        loads = self._carries(self.height)
        masses = [self.mass or 0.0, *(each["mass"] for each in loads)]
        heights = [self.centre, *(each["at"][1] for each in loads)]
        return sum(masses), float(np.dot(masses, heights)) / sum(masses)

    def _problem(self, message: str, key: str = "", hint: str | None = None) -> Problem:
        return Problem(message, self.inventory.sheet.file, self.line, field=self.inventory.heading(key), hint=hint)

    def make(self) -> Mechanism:
        """Return the structure, in the weaker of its two planes.

        Raises
        ------
        InputError
            If the row cannot be used: the file, its line, and the heading of the column.
        """
        return self._made[0]

    @property
    def about_depth(self) -> bool:
        """Whether that plane is the one of its depth; a plain block knows its weaker side by itself."""
        return self._made[1]

    @cached_property
    def _made(self) -> tuple[Mechanism, bool]:
        if self.wrong is not None:
            raise self.wrong
        chain = self.chain
        for each in chain[:-1]:
            if each.wrong is not None:
                raise InputError(self._problem(f"stands on {each.name}, whose row cannot be used", "support"))
        if broken := [each for each in self.carried if each.wrong is not None]:
            raise InputError(self._problem(f"carries {broken[0].name}, whose row cannot be used", "support"))
        planes = [(self._built(chain, turned=turned), turned) for turned in self._planes(chain)]
        return min(planes, key=lambda each: round(lowest_uplift(each[0]), 9))

    def _planes(self, chain: Sequence[ListedObject]) -> tuple[bool, ...]:
        if self.plane == "width" or all("depth" not in each.sizes for each in chain):
            return (False,)
        return (False,) if len(chain) == 1 and not self._has_foot else (False, True)  # a block knows its weaker side

    @property
    def _has_foot(self) -> bool:
        widths = [self.widths(turned=turned) for turned in (False, True)]
        return "centre" in self.sizes or any(abs(foot / body - 1) > SAME_SIDE for body, foot in widths)

    def _built(self, chain: Sequence[ListedObject], *, turned: bool) -> Mechanism:
        if len(chain) == 1:
            mechanism, fields = self._alone(turned=turned)
        else:
            mechanism, fields = "assembly", self._stacked(chain, turned=turned)
        cls = _registry()[mechanism]
        try:
            made: Mechanism = cls.from_fields({"name": self.name, **fields})
        except ValidationError as error:
            problems = of_arguments(cls, error.errors(include_url=False), mechanism)
            raise InputError(*(replace(each, file=self.inventory.sheet.file, line=self.line) for each in problems)) \
                from None  # fmt: skip
        return made

    def _alone(self, *, turned: bool) -> tuple[str, dict[str, Any]]:
        """Return mechanism and fields of the object alone, with what it carries as masses."""
        (body, foot), mass, sizes = self.widths(turned=turned), self.mass, self.sizes
        fields: dict[str, Any] = {"friction": sizes["friction"]} if "friction" in sizes else {}
        if stops := self._neighbours(body, foot, 0.0):
            fields["stops"] = stops
        if loads := self._carries(self.height):
            fields["loads"] = loads
        if self.ballast:
            low = {"name": "ballast", "mass": self.ballast, "at": [0.0, BALLAST_HEIGHT * self.height]}
            fields["loads"] = [*fields.get("loads", ()), low]
        if not self._has_foot:
            given: dict[str, Any] = {"mass": mass} if mass is not None else {}
            if self.is_round:
                given["section"] = "round"
            elif "depth" in sizes:
                given["depth"] = sizes["depth"]
            given |= {"plane": "width"} if self.plane == "width" else {}
            return "block", {**fields, **given, "width": body, "height": self.height}
        return "rigid_body", {
            **fields, **self._of_body(body, 0.0), "left_foot": [-foot / 2, 0.0], "right_foot": [foot / 2, 0.0],
            "polygon": self.silhouette(body, foot, 0.0),
        }  # fmt: skip

    def _neighbours(self, body: float, foot: float, base: float) -> list[dict[str, Any]]:
        """Return what it would meet beside it, at its widest."""
        widest = base + (self.height if foot >= body else self.height / 2)
        return [
            {"name": side, "point": [sign * body / 2, widest], "gap": sign * self.sizes["gap"]}
            for side, sign in (("right neighbour", 1), ("left neighbour", -1)) if "gap" in self.sizes
        ]  # fmt: skip

    def _of_body(self, body: float, base: float) -> dict[str, Any]:
        """Return mass, centroid and inertia, about it, of a uniform body as wide and high as the object."""
        mass = 1.0 if self.mass is None else self.mass
        across = 0.75 * body**2 if self.is_round else body**2
        inertia = mass * (across + self.height**2) / 12
        return {"mass": mass, "centroid": [0.0, base + self.centre], "inertia": inertia}

    def silhouette(self, body: float, foot: float, base: float) -> list[list[float]]:
        """Return corners from foot to top: widest in the middle if the foot is smaller, on a plinth if it is larger."""
        if foot > body:
            level = base + self.height / 10
            right = [[foot / 2, base], [foot / 2, level], [body / 2, level], [body / 2, base + self.height]]
        else:
            right = [[foot / 2, base], [body / 2, base + self.height / 2], [foot / 2, base + self.height]]
        return [*right, *([-x, y] for x, y in reversed(right))]

    def weighed(self) -> float:
        """Return its mass [kg]. Raises `InputError` if it is not given, although one stands on another."""
        if self.mass is None:
            raise InputError(self._problem("has no weight, which is needed as it stands on another object", "mass"))
        return self.mass

    def _stacked(self, chain: Sequence[ListedObject], *, turned: bool) -> dict[str, Any]:
        """Return the fields of an assembly: the objects below it, it, and what it carries as masses."""
        blocks, frictions, base, below = dict[str, Any](), dict[str, float](), 0.0, "floor"
        for each in chain:
            each.weighed()
            body, foot = each.widths(turned=turned)
            if each._has_foot:
                shape = {"polygon": each.silhouette(body, foot, base), **each._of_body(body, base)}
            else:
                x, top = body / 2, base + each.height
                shape = {"polygon": [[-x, base], [x, base], [x, top], [-x, top]], "mass": each.mass}
            name = each.name if each.name not in blocks else f"{each.name} of line {each.line}"
            blocks[name] = shape
            if "friction" in each.sizes:
                frictions[f"{below} and {name}"] = each.sizes["friction"]
            foot_level, base, below = base, base + each.height, name
        floor = [[-FAR_GROUND, -1.0], [FAR_GROUND, -1.0], [FAR_GROUND, 0.0], [-FAR_GROUND, 0.0]]
        fields: dict[str, Any] = {"blocks": blocks, "ground": {"floor": {"polygon": floor}}}
        fields |= {"friction_of": frictions} if frictions else {}
        if stops := self._neighbours(*self.widths(turned=turned), foot_level):
            fields["stops"] = [{**stop, "body": below} for stop in stops]
        if loads := self._carries(base):
            fields["loads"] = [{**each, "body": below} for each in loads]
        return fields

    def _carries(self, top: float) -> list[dict[str, Any]]:
        """Return what stands on it, whose top is at a height [m], as masses."""
        tops, loads = {self.code: top}, list[dict[str, Any]]()
        for each in self.carried:
            below = tops[each.on]
            tops[each.code] = below + each.height
            loads.append({"name": each.name, "mass": each.weighed(), "at": [0.0, below + each.centre]})
        return loads

    @property
    def base(self) -> tuple[Floor | None, Isolator | None]:
        """The floor, if it is not that of the motions, and the isolator on which it and what is below it stand."""
        lowest, sizes = self.chain[0], self.chain[0].sizes
        isolated = Isolator(sizes["period"], sizes.get("damping", DEFAULT_DAMPING), sizes["stroke"]) \
            if "period" in sizes else None  # fmt: skip
        return lowest.floor, isolated

    def under(self, motions: Sequence[GroundMotion]) -> Sequence[GroundMotion]:
        """Return the motions of what it stands on, for those of the ground, or of a floor."""
        if self.wrong is not None or (base := self.base) == (None, None):
            return motions
        return self.inventory.motions_on(base, motions)

    def limits(self, motion: GroundMotion) -> Limits:
        """Return what decides besides rocking under a motion of what it stands on, at factors on it."""
        hold, (_, isolator) = self.holds_to() if motion.vertical is None else 0.0, self.base
        if hold:  # what it stands on may move with it
            hold = min([hold, *(lowest_uplift(each.make()) for each in self.chain[:-1])])
        ends = inf
        if isolator is not None:
            below = self.inventory.below_isolator(self, motion)
            moves = peak_displacement(below, isolator.period, isolator.damping)
            room = min(isolator.stroke, *(each.sizes.get(key, inf) for each in self.chain for key in ("gap", "edge")))
            ends = room / moves if moves > 0 else inf
        peak = motion.pga_g
        return Limits(self.room_to_slide, hold / peak if peak > 0 else 0.0, ends)

    def alone(self) -> ListedObject:
        """Return the object on what the lowest object below it stands on, without those between."""
        lowest = self.chain[0]
        base = {key: lowest.sizes[key] for key in ("period", "damping", "stroke") if key in lowest.sizes}
        return replace(self, on="", floor=lowest.floor, sizes={**self.sizes, **base})

    @property
    def room_to_slide(self) -> float:
        """How far it may slide before its foot passes an edge [m]; infinite if there is none, or it does not slide."""
        if "friction" not in self.sizes and not self.on:
            return inf
        return self.sizes.get("edge", inf)

    def holds_to(self) -> float:
        """Return the acceleration up to which wax and wires hold it at rest [standard gravity]; 0 without any.

        Notes
        -----
        They hold like glass: with all of their strength up to it, and not at all beyond. Wax of tension T pulls in the
        middle of the foot, of width b, and a wire with the force F at the height z: about the edge of the foot
        m a h_c = (m g + T) b/2 + F z. The shear m a is held by the wires and by wax, or without wax by friction.
        """
        sizes = self.sizes
        if self.mass is None or not {"wax_area", "wire"} & set(sizes):
            return 0.0
        area, force = sizes.get("wax_area", 0.0), sizes.get("wire", 0.0)
        mass, centre = self.whole
        weight = mass * STANDARD_GRAVITY
        pull = area * sizes.get("wax_tension", 0.0)
        height = sizes.get("wire_height", self.centre)
        turns = ((weight + pull) * self.least_foot / 2 + force * height) / (weight * centre)
        shear = area * sizes.get("wax_shear", 0.0) if area else sizes.get("friction", inf) * weight
        return min(turns, (shear + force) / weight)

    def solid(self) -> SolidBody:
        """Return its body in three dimensions, the weaker plane of the foot along x.

        Raises
        ------
        InputError
            If it stands on another object or carries one, is held, or its depth is not known.
        """
        sizes = self.sizes
        reasons = {
            "stands on another object": bool(self.on), "carries another object": bool(self.carried),
            "is held by wax or wires": self.holds_to() > 0, "stands on an isolator": "period" in sizes,
            "has a neighbour": "gap" in sizes, "has no depth": not self.is_round and not {"width", "depth"} <= {*sizes},
        }  # fmt: skip
        if why := [each for each, applies in reasons.items() if applies]:
            raise InputError(self._problem(f"is not simulated in three dimensions, as it {why[0]}"))
        friction = sizes.get("friction", MASONRY_FRICTION)
        how: dict[str, Any] = {"friction": friction, "assumes_friction": "friction" not in sizes}
        (body, foot), (deep, foot_deep) = sorted(
            (self.widths(turned=each) for each in (False, True)), key=lambda w: w[1]
        )
        inertia = [(across**2 + self.height**2) / 12 for across in (deep, body)]
        levels = ((0.0, foot, foot_deep), (self.height / 2, body, deep), (self.height, foot, foot_deep))
        if self.is_round:
            profile = np.array([width / 2 + 1j * z for z, width, _ in levels])
            about = (0.75 * body**2 + self.height**2) / 12, body**2 / 8
            return SolidBody.turned(profile, foot / 2, self.centre, about, **how)
        points = [[x * w / 2, y * d / 2, z] for z, w, d in levels for x in (-1, 1) for y in (-1, 1)]
        about_axis = (body**2 + deep**2) / 12
        return SolidBody(
            points=np.array(points), level=self.centre, inertia=np.diag([*inertia, about_axis]), **how
        )  # fmt: skip

    def site(self, usual: SiteFile | None) -> SiteFile | None:
        """Return the site of all objects."""
        return usual


class Inventory(Sequence[ListedObject]):
    """The objects of a list.

    Parameters
    ----------
    sheet : Spreadsheet
        The list.
    floor : Floor, optional
        The floor to which motions are carried, whose building has the storeys of the rows.

    Raises
    ------
    InputError
        If it has no column of heights, or of widths or diameters, or a heading has no unit.
    """

    def __init__(self, sheet: Spreadsheet, floor: Floor | None = None) -> None:
        self.sheet, self.floor = sheet, floor
        self.places, self.unread = self._columns()
        self.items = [self._item(row) for row in sheet.rows]
        self.by_code: dict[str, ListedObject] = {}
        for k, each in enumerate(self.items):
            if each.code and self.by_code.setdefault(each.code, each) is not each:
                first = self.by_code[each.code].line
                self.items[k] = replace(each, questions=(*each.questions, f"code {each.code} is also in line {first}"))
        self._moved: dict[Any, tuple[GroundMotion, ...]] = {}

    @cached_property
    def _standing(self) -> Mapping[str, Sequence[ListedObject]]:
        """The objects that stand on another, by its code."""
        by_code = defaultdict[str, list[ListedObject]](list)
        for each in self.items:
            by_code[each.on].append(each)
        return by_code

    def standing_on(self, item: ListedObject) -> Sequence[ListedObject]:
        """Return what stands on an object; of several with its code, on the first."""
        first = self.by_code.get(item.code) if item.code else None
        return self._standing.get(item.code, ()) if first is not None and first.row is item.row else ()

    def __len__(self) -> int:
        return len(self.items)

    def __getitem__(self, k: Any) -> Any:
        return self.items[k]

    def heading(self, key: str) -> str | None:
        """Return the heading of the column of a field."""
        return cut(one_line(self.sheet.headings[self.places[key][0]])) if key in self.places else key or None

    @cached_property
    def notes(self) -> list[str]:
        """How the list was read, as sentences."""
        fields = ", ".join(f"{self.heading(key)} ({key.replace('_', ' ')})" for key in self.places)
        notes = [f"a list of {len(self)} objects, by its columns {fields}"]
        if self.unread:
            notes.append(f"columns that are kept and not read: {'; '.join(self.unread)}")
        if any(each.storey for each in self.items) and self.floor is None:
            notes.append(f"storeys have no effect on motions: give {named('floor')}, the building with its storeys n")
        return notes

    def motions_on(
        self, base: tuple[Floor | None, Isolator | None], motions: Sequence[GroundMotion]
    ) -> Sequence[GroundMotion]:
        """Return the motions of a floor, or of an isolator on it, made once."""
        key = base, *map(id, motions)
        if key not in self._moved:
            floor, isolator = base
            on_floor = [each if floor is None else floor.of(each.of_ground) for each in motions]
            if isolator is not None:
                on_floor = [replace(isolator.floor.of(each), ground=each.of_ground) for each in on_floor]
            self._moved[key] = tuple(on_floor)
        return self._moved[key]

    def below_isolator(self, item: ListedObject, motion: GroundMotion) -> GroundMotion:
        """Return the motion below the isolator of an object, for that on it."""
        floor, _ = item.base
        floor = self.floor if floor is None else floor
        return motion.of_ground if floor is None else floor.of(motion.of_ground)

    def _columns(self) -> tuple[dict[str, tuple[int, str]], list[str]]:
        """Return place and unit of each column that is read, and the headings of the others with the nearest field."""
        places, unread = dict[str, tuple[int, str]](), list[str]()
        for k, heading in enumerate(self.sheet.headings):
            name, unit = unit_in(heading, ())
            if not unit and (stated := _TRAILING.fullmatch(heading)):
                name, unit = stated.groups()
            name, unit = (name, unit) if not unit or kind_of(unit) or unit == "%" else (heading, "")
            key = _meaning(name, catalogue()["headings"])
            if key in SIDES and key in places:
                first = cut(one_line(self.sheet.headings[places[key][0]]))
                message, hint = f"is the same side as {first}", "rename the one that does not count, as `Other width`"
                raise InputError(
                    Problem(message, self.sheet.file, self.sheet.line, field=cut(one_line(heading)), hint=hint)
                )
            if key is None or key in places:
                close = get_close_matches(_bare(name), _words(catalogue()["headings"]), 1, NEAREST_HEADING)
                nearest = f" (did you mean {close[0]}?)" if close and key is None else ""
                unread += [cut(one_line(heading)) + nearest] if heading else []
                continue
            places[key] = k, unit
        missing = [] if "sizes" in places else [
            *(["height"] if "height" not in places else []),
            *(["width, or of diameters"] if not {"width", "depth", "diameter"} & set(places) else []),
        ]  # fmt: skip
        if missing:
            hint = f"such as `Height (cm)`; not read: {'; '.join(unread)}" if unread else "such as `Height (cm)`"
            what = f"a list of objects needs a column of {' and of '.join(missing)}"
            raise InputError(Problem(what, self.sheet.file, self.sheet.line, hint=hint))
        for key in SIDES:
            k, unit = places.get(key, (0, "m"))
            bare = [row for row in self.sheet.rows if not unit and self.sheet.number(row.cells[k]) is not None]
            if bare:
                heading, usual = cut(one_line(self.sheet.headings[k])), "kg" if key == "mass" else "cm"
                what = f"gives no unit, and {bare[0].cells[k]} in line {bare[0].line} has none"
                hint = f"write {heading} ({usual}) if all are in {usual}, or the unit in the cell"
                raise InputError(Problem(what, self.sheet.file, self.sheet.line, field=heading, hint=hint))
        return places, unread

    def _item(self, row: Row) -> ListedObject:
        """Return the object of a row, with what is wrong with it."""
        cells = {key: row.cells[k] for key, (k, _) in self.places.items()}
        item = ListedObject(
            inventory=self, row=row, code=cells.get("code", ""), title=one_line(cells.get("name", "")),
            room=one_line(cells.get("room", "")), material=one_line(cells.get("material", "")),
        )  # fmt: skip
        reading = _Reading(self, item, cells)
        try:
            return reading.item()
        except InputError as error:
            return replace(item, wrong=error, on=reading.on)


class _Reading:
    """A row of a list that is being read."""

    def __init__(self, inventory: Inventory, item: ListedObject, cells: Mapping[str, str]) -> None:
        self.inventory, self.bare, self.cells = inventory, item, cells
        self.sizes, self.remarks, self.questions = dict[str, float](), list[str](), list[str]()
        self.on, self.raised, self.storey = "", False, None  # type: str, bool, int | None
        self.kind = "block"
        self.from_foot = bool({"foot", "piede"} & {*plain(cells.get("support", "")).split()})

    def item(self) -> ListedObject:
        """Return the object. Raises `InputError` if the row cannot be used."""
        if self.bare.row.too_many is not None:
            what = f"has more cells than headings; the first extra cell is {cut(one_line(self.bare.row.too_many))!r}"
            raise InputError(self.bare._problem(what, hint="is a separator in a cell without quotes?"))
        self._support(self.cells.get("support", ""))
        self._whole_sizes(self.cells.get("sizes", ""))
        for key, unit in UNITS.items():
            if (text := self.cells.get(key, "")) and plain(text) not in ("", "na", "n a"):
                self.sizes[key] = self._number(key, text, self.inventory.places[key][1] or unit * (key in BARE))
        self.kind, by_kind = self._kind()
        kind = self.kind
        if by_kind and kind in catalogue()["of_kinds"]["round"] and "diameter" not in self.sizes:
            sides = [self.sizes.pop(key) for key in ("width", "depth") if key in self.sizes]
            self.sizes |= {"diameter": min(sides)} if sides else {}
        floor = self._floor(self.cells.get("storey", ""))
        self._storey_of_room()
        self._check()
        if "edge" in self.sizes and "friction" not in self.sizes:
            self.questions.append("the distance to the edge has no effect, as nothing slides without a friction")
        if not by_kind and kind == "block":
            self.remarks.append("taken as a block of its sides")
        if floor is None and self.storey is not None and self.inventory.floor is not None:
            floor = self._at_storey(self.inventory.floor, self.storey)
        plane = "width" if plain(self.cells.get("plane", "")) in ("width", "larghezza") else ""
        return replace(
            self.bare, kind=kind, sizes=self.sizes, on=self.on, raised=self.raised, floor=floor, storey=self.storey,
            plane=plane, remarks=tuple(self.remarks), questions=tuple(self.questions),
        )  # fmt: skip

    def _fail(self, what: str, key: str, hint: str | None = None) -> InputError:
        return InputError(self.bare._problem(what, key, hint))

    def _number(self, key: str, text: str, unit: str) -> float:
        """Return the number of a cell in the unit in which it is kept; `unit` is that of a plain number."""
        text = _spelled(text)
        comma = self.inventory.sheet.decimal_comma
        if re.match(r"[0-9]{1,3}([.,][0-9]{3})+(?![0-9])(?:\s*mm)" + (r"|[0-9]{1,3}(\.[0-9]{3})+(?![0-9])" if comma
                    else r"|[0-9]{1,3}(,[0-9]{3})+(?![0-9])"), text):  # fmt: skip
            what = f"{cut(one_line(text))} may have a separator of thousands"
            raise self._fail(what, key, "write it without one")
        number, kept = self.inventory.sheet.number(text), UNITS[key]
        try:
            if kept in ("", "%"):
                plain_number = (number or text).replace("%", "").strip()
                share = float(plain_number.replace(",", "."))
                in_percent = "%" in text or unit == "%" or (kept == "%" and share > 1)
                value = share / 100 if in_percent else share
            else:
                value = read(f"{number} {unit}" if number is not None else text.replace(",", "."), kept)
        except UnitError as error:
            weight = key == "mass" and self._of_weight(text, number, unit)
            if not weight:
                raise self._fail(error.message, key, error.hint) from None
            value = float(weight)
        except ValueError:
            raise self._fail(f"must be a number, got {cut(one_line(text))!r}", key) from None
        if key == "friction" and value > MOST_FRICTION:
            raise self._fail(f"must be at most {MOST_FRICTION:g}, got {cut(one_line(text))}", key)
        if not value > 0 and not (key in ("edge", "friction") and value == 0):
            raise self._fail(f"must be above 0, got {cut(one_line(text))}", key)
        return value

    def _of_weight(self, text: str, number: str | None, unit: str) -> float | None:
        """Return the mass of a weight [kg]; None if it is none."""
        try:
            return read(f"{number} {unit}" if number is not None else text, "N") / STANDARD_GRAVITY
        except UnitError:
            return None

    def _whole_sizes(self, text: str) -> None:
        """Read all sides in one cell: 182 x 48 x 36 cm as height, width and depth, or each with its letter."""
        if not text:
            return
        usual, shown = self.inventory.places["sizes"][1], cut(one_line(text))
        bare = re.sub(
            r"(?<=[0-9a-z])\s*\([^()]*[0-9][^()]*\)\s*$",
            "",
            text.strip().replace("\N{MULTIPLICATION SIGN}", "x").lower(),
        )
        sides = [
            _SIDE.fullmatch(each)
            for each in re.split(rf"\s*(?:\bx\b|(?<=[0-9])x(?=[0-9])|,\s+|;)\s*|(?<=[0-9])\s+(?=(?:{_LETTER})\b)", bare)
        ]
        known = [each for each in sides if each is not None]
        stated = [each["unit"] or each["last"] or "" for each in known]
        letters = [_LETTERS.get(each["before"] or each["after"] or "", "") for each in known]
        words = [each["before"] or each["after"] or "" for each in known]
        if {"w", "width", "larg", "largh", "larghezza"} & {*words}:  # then L is the length, along the depth
            letters = ["depth" if word == "l" else key for word, key in zip(words, letters, strict=True)]
        units = [*filter(None, stated)]
        shared = usual if not units else units[0] if units == stated[-1:] else ""
        free = ["height"] if "diameter" in letters else ["height", "width", "depth"]
        free = [key for key in free if key not in letters]
        hint = "such as 182 x 48 x 36, as height, width and depth"
        unclear = len(known) < len(sides) or letters.count("") > len(free)
        unclear |= any(re.search(r"[0-9][.,][0-9]{3}$", each["number"]) for each in known)  # of thousands, perhaps
        unclear |= len(set(filter(None, letters))) < len([*filter(None, letters)])
        if unclear or not all(each or shared for each in stated):
            raise self._fail(f"{shown!r} is not understood, or a side lacks its unit", "sizes", hint)
        if "" in letters:
            self.remarks.append("sides are read as height x width x depth")
        for key, each, unit in zip(letters, known, stated, strict=True):
            number = each["number"].replace(",", ".")
            self.sizes[key or free.pop(0)] = read(f"{number} {unit or shared}", "m")

    def _kind(self) -> tuple[str, bool]:
        """Return the kind of the object, and whether a column of kinds gives it, or else its name."""
        kinds = catalogue()["kinds"]
        by_column = _word_in(self.cells.get("kind", ""), kinds)
        if by_column is None and "diameter" in self.sizes:
            return _word_in(self.bare.title, kinds) or "cylinder", True
        return by_column or _word_in(self.bare.title, kinds) or "block", by_column is not None

    def _floor(self, text: str) -> Floor | None:
        """Read what a cell says of the storey: a number or a word, or a whole floor."""
        if "=" in text:
            try:
                return Floor.parse(text)
            except InputError as error:
                raise self._fail(error.problems[0].message, "storey", error.problems[0].hint) from None
        if text:
            number = self.inventory.sheet.number(text)
            is_whole = number is not None and float(number) >= 0 and float(number).is_integer()
            self.storey = int(float(number)) if number is not None and is_whole else _ordinal(text)
            if self.storey is None or (number is not None and not is_whole):
                self._on_unknown_floor(text)
        return None

    def _storey_of_room(self) -> None:
        if self.storey is None and re.search(
            r"(?i)\b(floor|piano|storey|level|livello|attic|mezzanin[eo]|soffitta)\b", self.bare.room
        ):
            self.storey = _ordinal(self.bare.room)
            if self.storey:
                self.remarks.append(f"storeys below it, by its room: {self.storey}")
            elif self.storey is None:
                self._on_unknown_floor(self.bare.room)

    def _on_unknown_floor(self, text: str) -> None:
        """Question a floor that is not understood; where floors move, raise `InputError`."""
        shown = cut(one_line(text))
        if self.inventory.floor is not None:
            raise self._fail(f"floor {shown!r} is not understood", "storey", "give the number of storeys below it")
        self.questions.append(f"floor {shown!r} is not understood: taken as on the ground")

    def _at_storey(self, floor: Floor, storey: int) -> Floor:
        storeys = round(floor.participation / (3 - 2 * floor.participation)) if floor.participation < 1.5 else 0
        if not storeys or storey > storeys:
            has = f"has {storeys}" if storeys else "gives no number of storeys n"
            raise self._fail(f"stands {storey} storeys above the ground, but {named('floor')} {has}", "storey")
        return replace(floor, height=storey / storeys)

    def _support(self, text: str) -> None:
        """Read what the object stands on, phrase by phrase; words that mean nothing are questioned."""
        unused, clauses = list[str](), list[str]()
        for clause in filter(None, map(str.strip, _CLAUSES.split(text))):
            if clauses and not _idle_words(clause) and _phrases(clause, catalogue()["supports"])[0][0] is None:
                clauses[-1] += f" {clause}"  # numbers alone belong to the words before
            else:
                clauses.append(clause)
        for clause in clauses:
            rest = clause
            if on := self._object_in(clause):
                self.on, rest = on[0], on[1]
            phrases = _phrases(rest, {key: words for key, words in catalogue()["supports"].items() if key != "object"})
            for word, phrase in phrases:
                if word is not None:
                    self._clause(word, phrase)
            if self.storey is None and (storey := _ordinal(clause)) is not None:
                self.storey = storey
            elif idle := [each for each in _idle_words(rest) if _ordinal(clause) is None]:
                unused.append(f"{clause!r} ({', '.join(idle)})" if phrases[1:] or phrases[0][0] else repr(clause))
        if unused:
            what = cut(one_line(", ".join(unused)))
            self.questions.append(f"of its support {what} is not understood, and has no effect")

    def _object_in(self, clause: str) -> tuple[str, str] | None:
        """Return the code of the object that a clause names after words such as `on`, and the rest; None without one.

        Raises `InputError` if the clause names a number that is not in the list.
        """
        bare = f" {plain(clause)} "
        words = [each for each in catalogue()["supports"]["object"] if f" {each} " in bare]
        if words:
            before, _, after = bare.partition(f" {max(words, key=len)} ")
        else:  # a number alone, or after the word of what bears it
            before, after = (
                "",
                " ".join(each for each in bare.split() if each not in catalogue()["idle"]["bearers"]) + " ",
            )
            if after.strip() not in {plain(each) for each in self.inventory_codes}:
                return None
        codes = {f" {plain(each)} ": each for each in self.inventory_codes if each != self.bare.code}
        shortened = f" {' '.join(each.lstrip('0') for each in after.split())} "
        others = {key: each for key, each in catalogue()["supports"].items() if key in ("raised", "isolator")}
        if _word_in(after, others) is not None:
            return None  # as on 2 trestles
        named_codes = [each for each in codes if each in f" {after}"] or [
            each for each in codes if f" {each.strip().lstrip('0')} " in shortened
        ]  # fmt: skip
        if named_codes:
            code = max(named_codes, key=len)
            if [each for each in named_codes if each.strip() not in code]:
                raise self._fail("stands on two objects: list it on the one that bears it", "support")
            return codes[code], before
        own_code = plain(self.bare.code)
        if own_code and f" {own_code} " in f" {after}":
            return self.bare.code, before
        known = {key: each for key, each in catalogue()["supports"].items() if key != "object"}
        if not any(sign.isdigit() for sign in after) or _word_in(after, known) is not None:
            return None
        raise self._fail(f"stands on {cut(after.strip())}, which is not in the list", "support")

    def _clause(self, word: str, clause: str) -> None:
        """Read a clause of a support that a word begins."""
        shown = cut(one_line(clause))
        if re.search(r"[0-9]\s*[-\u2013]\s*[0-9]", clause):
            raise self._fail(f"{shown!r} is a range: give one number", "support")
        plain_text = clause.replace("\N{SUPERSCRIPT TWO}", "2")
        numbers = [(float(number.replace(",", ".")), unit) for number, unit in _QUANTITY.findall(plain_text)]
        by_unit = {unit: f"{number} {unit}" for number, unit in numbers}
        lengths = [read(f"{number} {unit}", "m") for number, unit in numbers if unit in ("mm", "cm", "m", "in")]
        if word == "raised":
            self.raised = True
            at = f", {lengths[0]:g} m above the floor" if lengths else ""
            self.remarks.append(f"what it stands on{at} is taken as rigid and fixed to the floor")
        elif word == "friction":
            coefficients = [number / (100 if unit == "%" else 1) for number, unit in numbers if unit in ("", "%")]
            if coefficients and coefficients[-1] > MOST_FRICTION:
                raise self._fail(f"{shown!r}: friction must be at most {MOST_FRICTION:g}", "support")
            if coefficients:
                self.sizes.setdefault("friction", coefficients[-1])
            else:
                self.questions.append(f"{shown!r} gives no coefficient of friction: it is taken not to slide")
        elif word in ("edge", "gap"):
            if not lengths:
                raise self._fail(f"{shown!r} has no length with its unit, such as {word} 5 cm", "support")
            self.sizes.setdefault(word, lengths[0])
        elif word == "wax":
            stresses = [read(f"{number} {unit}", "Pa") for number, unit in numbers if unit in ("Pa", "kPa", "MPa")]
            areas = [read(by_unit[unit], "m2") for unit in ("mm2", "cm2", "m2") if unit in by_unit]
            keys = zip(("wax_area", "wax_tension", "wax_shear"), (areas[:1] or [0.0]) + stresses, strict=False)
            self.sizes = {**{key: value for key, value in keys if value > 0}, **self.sizes}
        elif word == "wire":
            forces = [read(by_unit[unit], "N") for unit in ("N", "kN") if unit in by_unit]
            if not forces:
                raise self._fail(f"{shown!r} has no force, such as wires 600 N at 1.5 m", "support")
            self.sizes = {**dict(zip(("wire", "wire_height"), forces[:1] + lengths, strict=False)), **self.sizes}
        elif word == "isolator":
            given = {"period": by_unit.get("s"), "damping": by_unit.get("%")}
            if given["period"] is None or not lengths:
                what = "the isolator has no stroke" if given["period"] else f"{shown!r} has no period"
                raise self._fail(what, "support", "such as isolator 2.5 s 15 % 25 cm: period, damping and stroke")
            numbers_ = {key: self._number(key, text, "") for key, text in given.items() if text}
            self.sizes = {**numbers_, "stroke": lengths[0], **self.sizes}

    @cached_property
    def inventory_codes(self) -> set[str]:
        """The codes of all rows."""
        if "code" not in self.inventory.places:
            return set()
        k, _ = self.inventory.places["code"]
        return {row.cells[k] for row in self.inventory.sheet.rows}

    def _check(self) -> None:
        """Raise `InputError` for what is missing or impossible, and question what looks like a mistake."""
        sizes = self.sizes
        if "height" not in sizes:
            raise self._fail("is missing", "height")
        if not {"width", "depth", "diameter"} & set(sizes):
            raise self._fail("is missing: give width and depth, or a diameter", "width")
        if "period" in sizes and "stroke" not in sizes:
            hint = "give how far it can move; without it, no outcome is known"
            raise self._fail("the isolator has no stroke", "stroke", hint)
        if {"wax_area", "wire"} & set(sizes) and "mass" not in sizes:
            raise self._fail("is missing, and decides how far wax and wires hold", "mass")
        if "wax_area" in sizes and not {"wax_tension", "wax_shear"} <= set(sizes):
            hint = "such as `wax 20 cm2 40 kPa 30 kPa`: area, tension and shear that the adhesive holds"
            raise self._fail("the wax has no strength in tension and in shear", "support", hint)
        if "period" in sizes:
            try:
                Isolator(sizes["period"], sizes.get("damping", DEFAULT_DAMPING), sizes["stroke"]).floor.of(AT_REST)
            except InputError as error:
                raise self._fail(f"the isolator: {error.problems[0].message}", "period") from None
        if self.on and "period" in sizes:
            raise self._fail("an isolator between two objects is not modelled", "support")
        if sizes.get("wire_height", 0.0) > sizes["height"]:
            raise self._fail(f"is above the top, {sizes['height']:g} m", "wire_height")
        flat = replace(self.bare, sizes=sizes)
        if sizes.get("wax_area", 0.0) > flat.foot_area:
            raise self._fail(f"is larger than the foot, {1e4 * flat.foot_area:.4g} cm2", "wax_area")
        if sizes.get("centre", 0.0) >= sizes["height"]:
            raise self._fail(f"is not below the height, {sizes['height']:g} m", "centre")
        sides = [sizes[key] for key in ("width", "depth") if key in sizes]
        if "diameter" in sizes and sides:
            self.questions.append("it has a diameter and other sides: the smaller ones were used")
            if min(sides) < sizes["diameter"]:
                del sizes["diameter"]
        if "vase" in (self.kind, _word_in(self.bare.title, catalogue()["kinds"])) and not {"foot", "foot_depth"} & {
            *sizes
        }:
            self.questions.append("a vase without the size of its foot: taken as wide as the body")
        if "diameter" in sizes and "foot" in sizes:
            self.remarks.append("its foot is round: it may roll on its rim, out of the plane, which is not modelled")
        feet = [sizes[key] for key in ("foot", "foot_depth") if key in sizes] or [
            sizes[key] for key in ("width", "depth", "diameter") if key in sizes
        ]
        if "friction" not in sizes and min(feet) >= NEVER_ROCKS * 2 * sizes.get("centre", sizes["height"] / 2):
            sizes["friction"] = MASONRY_FRICTION
            self.remarks.append(
                f"wider than high: no floor holds it so that it rocks. It slides, with a friction of "
                f"{MASONRY_FRICTION:g} unless another is given"
            )
        self.questions += self._doubts(min(feet))

    def _doubts(self, foot: float) -> Iterator[str]:
        sizes = self.sizes
        across = [sizes[key] for key in ("width", "depth", "diameter") if key in sizes]
        for key in ("foot", "foot_depth"):
            body = sizes.get("diameter", sizes.get("width" if key == "foot" else "depth", inf))
            if sizes.get(key, 0.0) > body * (1 + SAME_SIDE):
                yield f"the foot, {sizes[key]:g} m, is larger than the body, {body:g} m: are the two columns exchanged?"
        low, high = LIKELY_SIDES
        for key in ("height", "width", "depth", "diameter"):
            if key in sizes and not low <= sizes[key] <= high:
                yield f"the {key} is {sizes[key]:.4g} m: is the unit right?"
        if self._is_flat(across):
            yield f"it is {sizes['height']:g} m high and {max(across):g} m wide: are height and width exchanged?"
        if "edge" in sizes and sizes["edge"] == 0:
            yield "the edge is at the foot: it falls when it begins to slide"
        elif "edge" in sizes and sizes["edge"] < foot / 2 and not self.from_foot:
            yield (
                f"the edge, {sizes['edge']:g} m away, is closer than half of the foot: if it is the distance from the "
                "foot, and not from the middle, write `edge 5 cm from the foot`"
            )
        if "mass" in sizes:
            yield from self._of_mass(across)

    def _is_flat(self, across: Sequence[float]) -> bool:
        upright = _word_in(self.bare.title, {key: catalogue()["kinds"][key] for key in ("vase", "statue", "bookcase")})
        return upright is not None and self.sizes["height"] < min(across)

    def _of_mass(self, across: Sequence[float]) -> Iterator[str]:
        """Yield a question if a body is heavier than a solid of its material, or much lighter."""
        sizes = self.sizes
        base = pi / 4 * sizes["diameter"] ** 2 if "diameter" in sizes else max(across) * min(across)
        materials = _materials_in(self.bare.material)
        most = max((density for density, _, _ in materials), default=23_000.0)
        density = sizes["mass"] / (base * sizes["height"])
        if density > most:
            of = f"solid {self.bare.material}" if materials else "the heaviest metal"
            heaviest = float(f"{most * base * sizes['height']:.3g}")
            yield f"it weighs {sizes['mass']:g} kg, but {of} of its sides {heaviest:g} kg at most: are units right?"
        elif materials and all(brittle for _, brittle, _ in materials) and density < LIGHTEST * most:
            yield f"it weighs {sizes['mass']:g} kg, {density / most:.1%} of a solid of {self.bare.material}: check it"


def lowest_uplift(mechanism: Mechanism) -> float:
    """Return the uplift acceleration of a structure in its weaker direction and plane [its gravity]."""
    weaker = mechanism.weaker_side() or mechanism
    return min(map(weaker.uplift, Direction))


def _spelled(text: str) -> str:
    """Return a quantity as `rocking_cli.units` reads it, such as 86 in for 7'2" and 7 ft 2 in."""
    text = re.sub(r"(?i)^(ca\.?|circa|approx\.?|about|~)\s*", "", text.strip())
    if feet := re.fullmatch(r"(?i)([0-9]+)\s*(?:'|ft|feet)\s*([0-9.]+)\s*(?:\"|''|in|inch(?:es)?)?", text):
        return f"{12 * int(feet[1]) + float(feet[2]):g} in"
    spelt = {r'"|\binch(es)?\b': " in", r"'|\bfeet\b": " ft", r"\b(lbs|pounds?)\b\.?": "lb", r"\blb\.": "lb"}
    for pattern, unit in spelt.items():
        text = re.sub(f"(?i){pattern}", unit, text)
    return text


def _phrases(text: str, words: Mapping[str, Sequence[str]]) -> list[tuple[str | None, str]]:
    """Return a text in pieces that begin with a word that is known, and what it means; None before the first."""
    pieces = list[tuple[str | None, str]]()
    for word in text.split():
        meaning = _word_in(word, words)
        if meaning is not None or not pieces:
            pieces.append((meaning, word))
        else:
            pieces[-1] = pieces[-1][0], f"{pieces[-1][1]} {word}"
    return pieces or [(None, "")]


def _idle_words(text: str) -> list[str]:
    """Return the words of a clause that mean nothing: no known word, number, unit, or filler."""
    known = {*_words(catalogue()["supports"]), *catalogue()["idle"]["fillers"]}
    bare = _QUANTITY.sub(" ", text.replace("\N{SUPERSCRIPT TWO}", "2"))
    words = [each for each in plain(bare).split() if not each.isdigit()]
    return [each for each in words if each not in known]


def is_inventory(sheet: Spreadsheet) -> bool:
    """Return whether a table without mechanisms is a list of objects: it has sides, and more that is known."""
    keys = {_meaning(unit_in(each, ())[0], catalogue()["headings"]) for each in sheet.headings} - {None}
    misspelt = get_close_matches("mechanism", [each.lower() for each in sheet.headings], 1)
    return bool(keys & {"sizes", "height", "width", "depth", "diameter"}) and len(keys) > 1 and not misspelt


def _words(words: Mapping[str, Sequence[str]]) -> list[str]:
    return [each for some in words.values() for each in some]


def _meaning(heading: str, words: Mapping[str, Sequence[str]]) -> str | None:
    """Return the field that a heading means; None if it is not known."""
    bare = _bare(heading)
    return next((key for key, some in words.items() if bare in some), None)


def _bare(heading: str) -> str:
    """Return a heading without words that change nothing, such as `overall` and `of the object`."""
    words = plain(heading).split()
    return " ".join([each for each in words if each not in catalogue()["idle"]["words"]] or words)


def _word_in(text: str, words: Mapping[str, Sequence[str]]) -> str | None:
    """Return what the first word of a text that is known means, of several the longest; None if there is none."""
    bare = f" {plain(text)} "
    places = [(bare.find(f" {each} "), -len(each), key) for key, some in words.items() for each in some]
    return min((each for each in places if each[0] >= 0), default=(0, 0, None))[2]


def _materials_in(text: str) -> list[tuple[float, bool, str]]:
    """Return density, whether it cracks, and word of each material in a text."""
    bare = f" {plain(text)} "
    every = [(density, brittle, word) for density, brittle, *words in catalogue()["materials"].values()
             for word in words]  # fmt: skip
    return [each for each in every if f" {each[2]} " in bare]


def _ordinal(text: str) -> int | None:
    """Return the number of storeys below a floor by its words, such as 2 of `L1 (2nd floor)`; None if it has none."""
    ordinals = catalogue()["ordinals"]
    before = re.search(r"(?i)(\S+)\s+(?:floor|piano|storey|level|livello)\b", text)
    key = _word_in(before[1], ordinals) if before else None
    key = key if key is not None else _word_in(text, ordinals)
    if key is not None:
        return int(key)
    if match := re.search(r"(?i)\b([0-9]+)(?:st|nd|rd|th) +(?:floor|storey|level)\b|\b([0-9]+)f\b", text):
        return int(match[1] or match[2])
    if match := re.search(
        r"(?i)\b(?:floor|piano|storey|level|livello|p)\s*([0-9]+)\b(?!\s*(?:mm|cm|m)\b)|\b([0-9]+)p\b", text
    ):
        return int(match[1] or match[2])
    roman = re.search(r"\b(I{1,3}|IV|VI{0,3}) (?i:piano)\b|\b(?i:piano) (I{1,3}|IV|VI{0,3})\b", text)
    return ROMAN.index(roman[1] or roman[2]) if roman else None


@cache
def _registry() -> Registry:
    return Registry()
