"""Cracks whose position the analysis finds: where bodies may be cut, and the structure with cut bodies."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from mechanisms._linkage_sides import Connection, LinkageSide
from mechanisms._shapes import Shape
from rocking_cli.core import Direction, Reals, Vertex, geometry_error, quantity
from rocking_cli.core.fields import Described, Name
from rocking_cli.core.kinematics import Points, area_of, distance, inside

SCAN_POINTS = 24  # places of a crack that are tried first; half as many of each of two cracks
MIN_EDGE_DISTANCE = 1e-6  # least distance of a crack from the ends of its line, over its length
SAME_PLACE = 1e-5  # distance of cracks of both directions that coincide, over the length of the line
INFINITE_LAMBDA = 1e100  # lambda if there is no mechanism; finite, as searches subtract values
CRACK_ACCURACY = 1e-9  # accuracy of the place of a crack, over the length of its line


class Crack(Described):
    """A cut through a body at any position along a line."""

    body: Name = Field(description="the body that it cuts, a polygon")
    along: Annotated[list[Vertex], Field(min_length=2, max_length=2)] = quantity(
        "from where to where it may be, two points", unit="m", example=[[0.0, 0.5], [0.0, 6.0]]
    )
    cut: Literal["horizontal", "vertical"] = Field("horizontal", description="which way it runs through the body")

    @model_validator(mode="after")
    def _runs(self) -> Self:
        one, other = (self.level_of(complex(*point)) for point in self.along)
        if one == other:
            coordinate = "height" if self.cut == "horizontal" else "x"
            raise geometry_error("along", f"both ends have the same {coordinate}: a {self.cut} crack has no room there")
        return self

    def level_of(self, z: complex) -> float:
        """Return the coordinate of a point across the crack [m]: its height, or its x for a vertical cut."""
        return z.imag if self.cut == "horizontal" else z.real

    def level(self, share: float) -> float:
        """Return the height or x of the crack [m] at a fraction of its line."""
        one, other = (self.level_of(complex(*point)) for point in self.along)
        return one + share * (other - one)

    @property
    def sides(self) -> tuple[str, str]:
        """Words for the position of the two pieces relative to the crack."""
        return ("below", "above") if self.cut == "horizontal" else ("left of", "right of")

    @property
    def ends(self) -> tuple[str, str]:
        """Words for the two ends of the crack, in the order of x or y."""
        return ("left", "right") if self.cut == "horizontal" else ("bottom", "top")


class Halves(NamedTuple):
    """The two pieces of a polygon, and the ends of the cut between them."""

    low: Points
    high: Points
    ends: tuple[complex, complex]


def halves(corners: Points, level: float, *, level_cut: bool) -> Halves | None:
    """Cut a polygon in two at a height, or at an x; None if the cut does not pass through it exactly once."""
    height: Reals = (corners.imag if level_cut else corners.real) - level
    low: list[complex] = []
    high: list[complex] = []
    ends: list[complex] = []
    for k, z in enumerate(corners):
        following = (k + 1) % len(corners)
        if height[k] == 0:
            return None
        (low if height[k] < 0 else high).append(complex(z))
        if height[k] * height[following] < 0:
            on = complex(z + (corners[following] - z) * height[k] / (height[k] - height[following]))
            on = complex(on.real, level) if level_cut else complex(level, on.imag)
            low.append(on)
            high.append(on)
            ends.append(on)
    if len(ends) != 2:
        return None
    one, other = sorted(ends, key=lambda z: z.real if level_cut else z.imag)
    return Halves(np.array(low), np.array(high), (one, other))


class Cracked(NamedTuple):
    """A structure with its cracks at given positions.

    Parameters
    ----------
    shapes : mapping of str to Shape
        The bodies, with cut bodies replaced by their pieces.
    sides : mapping of Direction to LinkageSide
        The joints of each direction, which name pieces and points.
    pieces : mapping of str to sequence of str
        Names of the pieces of each cut body.
    """

    shapes: Mapping[str, Shape]
    sides: Mapping[Direction, LinkageSide]
    pieces: Mapping[str, Sequence[str]]

    def piece(self, body: str, at: complex) -> str:
        """Return the piece of a body on which a point lies, or the nearest one; the body itself if it is not cut."""
        z = np.array([at])
        names = self.pieces.get(body, [body])
        return (
            min(names, key=lambda piece: float(_away(z, np.array(self.shapes[piece].corners)))) if names[1:] else body
        )


def active(side: LinkageSide, cracks: Mapping[str, Crack]) -> list[str]:
    """Return the cracks that a side names; all others are closed in its direction."""
    words = [side.lead, *(each.at for each in side.joints.values() if isinstance(each.at, str))]
    words += [name for each in side.joints.values() for name in each.bodies]
    return [
        name for name in cracks if any(word.split(" ")[-1] == name or word.startswith(f"{name} ") for word in words)
    ]


def cracked(
    shapes: Mapping[str, Shape],
    sides: Mapping[Direction, LinkageSide],
    cracks: Mapping[str, Crack],
    shares: Mapping[Direction, Mapping[str, float]],
) -> Cracked:
    """Return a structure with its cracks at fractions of their lines, in each direction.

    Raises a geometry error at the field at fault.
    """
    levels = {d: {name: cracks[name].level(share) for name, share in of.items()} for d, of in shares.items()}
    _join_equal(levels, cracks)
    shapes_of_pieces, pieces, ends = (
        dict(shapes),
        dict[str, Sequence[str]](),
        dict[tuple[str, float], tuple[complex, complex]](),
    )
    for body in dict.fromkeys(crack.body for crack in cracks.values()):
        body_cracks = {name: crack for name, crack in cracks.items() if crack.body == body}
        cuts = sorted({level for of in levels.values() for name, level in of.items() if name in body_cracks})
        if not cuts:
            continue
        rest, names = np.array(shapes[body].corners), []
        whole = abs(area_of(rest))
        flat = next(iter(body_cracks.values())).cut == "horizontal"
        for k, level in enumerate(cuts):
            cut = halves(rest, level, level_cut=flat)
            if cut is None:
                at = f"{'y' if flat else 'x'} = {level:.4g} m"
                why = f"at {at} it does not cut {body} in two: a crack goes through it once"
                raise geometry_error(("cracks", next(iter(body_cracks)), "along"), why)
            names.append(f"{body} {k + 1}")
            shapes_of_pieces[names[-1]] = _piece(shapes[body], cut.low, whole)
            ends[body, level] = cut.ends
            rest = cut.high
        names.append(f"{body} {len(cuts) + 1}")
        shapes_of_pieces[names[-1]] = _piece(shapes[body], rest, whole)
        del shapes_of_pieces[body]
        pieces[body] = names
    cut_structure = Cracked(shapes_of_pieces, {}, pieces)
    named_sides = {d: _Names(d, cracks, levels[d], cut_structure, ends).side(side) for d, side in sides.items()}
    return cut_structure._replace(sides=named_sides)


def _join_equal(levels: dict[Direction, dict[str, float]], cracks: Mapping[str, Crack]) -> None:
    """Make cracks of both directions at the same place, to rounding error, have exactly the same level."""
    known: dict[str, list[float]] = {}
    for of in levels.values():
        for name, level in of.items():
            span = abs(cracks[name].level(1.0) - cracks[name].level(0.0))
            equal_levels = [
                other for other in known.setdefault(cracks[name].body, []) if abs(other - level) < SAME_PLACE * span
            ]
            of[name] = equal_levels[0] if equal_levels else level
            known[cracks[name].body].append(of[name])


def _piece(shape: Shape, corners: Points, whole: float) -> Shape:
    changed: dict[str, object] = {"polygon": [[z.real, z.imag] for z in corners.tolist()]}
    if shape.mass is not None:
        changed["mass"] = shape.mass * abs(area_of(corners)) / whole
    return shape.model_copy(update=changed)


class _Names(NamedTuple):
    """Translation of the names that a side uses, with the cracks at given positions."""

    direction: Direction
    cracks: Mapping[str, Crack]
    levels: Mapping[str, float]
    made: Cracked
    ends: Mapping[tuple[str, float], tuple[complex, complex]]

    def side(self, side: LinkageSide) -> LinkageSide:
        """Return the side with the names of pieces and points, and with the closed cracks as fixed joints."""
        joints: dict[str, Connection] = {}
        for name, each in side.joints.items():
            at = self._point(each.at, name) if isinstance(each.at, str) else each.at
            moved = {} if at is None else {"at": at}
            joints[name] = each.renamed(partial(self._piece, at=at), **moved)
        for body, names in self.made.pieces.items():
            open_here = {level for crack, level in self.levels.items() if self.cracks[crack].body == body}
            cuts = sorted(level for cut_body, level in self.ends if cut_body == body)
            for k, level in enumerate(cuts):
                if level not in open_here:
                    joints[f"{names[k]}, {names[k + 1]}"] = Connection(fixed=[names[k], names[k + 1]])
        return side.model_copy(update={"lead": self._piece(side.lead, None), "joints": joints})

    def _point(self, text: str, joint: str) -> list[float]:
        """Return the point [x, y] of the end of a crack."""
        for name, level in self.levels.items():
            crack = self.cracks[name]
            for end, at in zip(crack.ends, self.ends[crack.body, level], strict=True):
                if text == f"{name} {end}":
                    return [at.real, at.imag]
        known = ", ".join(f"{name} {end}" for name, crack in self.cracks.items() for end in crack.ends)
        what = f"a point [x, y], or one of {known}" if known else "a point [x, y]"
        raise geometry_error((self.direction.label, "joints", joint, "at"), f"is {what}; got {text!r}")

    def _piece(self, name: str, at: object) -> str:
        """Return a piece by its name, such as `wall below K`; for the name of a cut body, the piece at its joint."""
        for crack, level in self.levels.items():
            body = self.cracks[crack].body
            for k, side in enumerate(self.cracks[crack].sides):
                if name == f"{body} {side} {crack}":
                    cuts = sorted(crack_level for other, crack_level in self.ends if other == body)
                    return self.made.pieces[body][cuts.index(level) + k]
        if isinstance(at, list):
            return self.made.piece(name, complex(*at))
        whole = not any(self.cracks[crack].body == name for crack in self.levels)
        # In this direction the body is not cut.
        return self.made.pieces[name][0] if whole and name in self.made.pieces else name


def _away(z: Points, corners: Points) -> float:
    """Return the distance of a point from a polygon [m]; 0 inside."""
    return 0.0 if inside(z, corners)[0] else float(distance(z, corners)[0])


def weakest(lambda_at: Callable[[Mapping[str, float]], float], names: Sequence[str]) -> dict[str, float]:
    """Return the fractions along their lines at which one or two cracks give the least lambda.

    Parameters
    ----------
    lambda_at : callable
        Function that returns the uplift acceleration with cracks at given fractions; infinite if there is no mechanism.
    names : sequence of str
        The cracks.
    """
    from scipy.optimize import Bounds, minimize, minimize_scalar

    def at(*shares: float) -> float:
        return min(lambda_at(dict(zip(names, map(float, shares), strict=True))), INFINITE_LAMBDA)

    shares = (np.arange(SCAN_POINTS) + 0.5) / SCAN_POINTS
    if len(names) == 1:
        values = np.array([at(share) for share in shares])
        k = int(values.argmin())
        low = MIN_EDGE_DISTANCE if k == 0 else float(shares[k - 1])
        high = 1 - MIN_EDGE_DISTANCE if k == SCAN_POINTS - 1 else float(shares[k + 1])
        minimum = minimize_scalar(at, bounds=(low, high), method="bounded", options={"xatol": CRACK_ACCURACY})
        return {names[0]: float(minimum.x)}
    coarse = shares[::2]
    grid = [(float(one), float(other)) for one in coarse for other in coarse]
    start = min(grid, key=lambda pair: at(*pair))
    result = minimize(
        lambda pair: at(*pair), start,
        method="Nelder-Mead", bounds=Bounds([MIN_EDGE_DISTANCE] * 2, [1 - MIN_EDGE_DISTANCE] * 2),
        options={"xatol": CRACK_ACCURACY, "fatol": 0.0},
    )  # fmt: skip
    return dict(zip(names, (float(place) for place in result.x), strict=True))
