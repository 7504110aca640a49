"""Lines with arcs of the entities of a DXF file, mirrored, turned and scaled.

A shape is drawn in a plane of its own: that of its extrusion, or the one in which its ellipse is a circle. Its arcs
stay exact if the placing of the plane keeps circles; otherwise they become straight sides, as those of an ellipse do.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, islice, pairwise, product
from math import floor, pi
from typing import Any, NamedTuple

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.io.drawings.arcs import STRAIGHT_BULGE, inner_points, level_count
from rocking_cli.io.drawings.dxf_groups import DxfEntity, Groups, library

FULL_TURN = 1e-6  # rad that a full circle may be short of
SAME_SHARE = 1e-9  # share of its size within which points of a line coincide, and a placing keeps circles
MEETING_SHARE = 1e-6  # share of its size within which the edges of a hatch meet
FLATTENING_SHARE = 1e-6  # distance of a curve from its straight sides over its size
MIN_SIDES_PER_SPAN, MAX_CURVE_CORNERS = 8, 50_000
CLOSED, SPLINE_FIT, IS_3D, MESH = 1, 4, 8, 16 | 64  # flags of a POLYLINE
CONTROL_POINT = 16  # flag of a VERTEX
POLYLINE_LOOP, TEXT_BOX = 2, 8  # flags of a loop of a HATCH


class Placing(NamedTuple):
    """Where points of space are placed: at `matrix` p + `origin`, shapes (3, 3) and (3,)."""

    matrix: Reals
    origin: Reals

    def after(self, first: Placing | None) -> Placing:
        """Return the placing by `first`, and then by this one."""
        if first is None:
            return self
        return Placing(self.matrix @ first.matrix, self.matrix @ first.origin + self.origin)

    def carry(self, points: Points, heights: Reals) -> tuple[Points, Reals]:
        """Return placed points, and their heights."""
        x, y, z = self.matrix @ np.array([points.real, points.imag, heights]) + self.origin[:, None]
        return x + 1j * y, z

    @property
    def sense(self) -> int:
        """1 if circles of the level plane stay circles, -1 if their sense turns round, 0 if they become ellipses."""
        (a, b), (c, d) = self.matrix[:2, :2].tolist()
        same = SAME_SHARE * max(map(abs, (a, b, c, d)))
        if abs(a - d) <= same and abs(b + c) <= same:
            return 1
        return -1 if abs(a + d) <= same and abs(b - c) <= same else 0


@dataclass(frozen=True, eq=False)
class DxfShape:
    """A line in a plane, see `DrawnLine`: its bulges, heights over the plane, and the placing of the plane."""

    points: Points
    bulges: Reals
    heights: Reals
    closed: bool = False
    placing: Placing | None = None
    is_straightened: bool = False

    def placed(self, outer: Placing | None) -> DxfShape:
        """Return the line in the plane of the drawing, in which `outer` places it."""
        placing = self.placing if outer is None else outer.after(self.placing)
        if placing is None:
            return self
        points, bulges, sense = self.points, self.bulges, placing.sense
        curved = sense == 0 and bool(bulges.any())
        if curved:
            points, bulges = straightened(points, bulges), np.zeros(0)
        heights = np.broadcast_to(self.heights[0], points.shape) if curved else self.heights
        points, heights = placing.carry(points, heights)
        bulges = np.zeros(len(points)) if curved else sense * bulges
        return DxfShape(points, bulges, heights, self.closed, None, self.is_straightened or curved)

    def tidied(self) -> DxfShape | None:
        """Return the line without repeated corners, closed if it ends where it begins; None if nothing is left."""
        z, bulges, closed = self.points, self.bulges, self.closed
        if len(z) == 2 and not closed and z[0] != z[1] and not bulges[-1]:
            return self  # as most lines are
        tolerance = SAME_SHARE * (np.ptp(z.real) + np.ptp(z.imag))
        kept = np.abs(z - np.roll(z, -1)) > tolerance  # of two, the later one has the bulge that counts
        if not closed:
            closed = not kept[-1]
        if np.count_nonzero(kept) < 2:
            return None
        bulges = bulges[kept]
        if not closed:
            bulges[-1] = 0.0
        return DxfShape(z[kept], bulges, self.heights, closed, None, self.is_straightened)


def straightened(points: Points, bulges: Reals) -> Points:
    """Return corners whose straight sides enclose the area of a line with arcs; its own corners stay."""
    corners = []
    for start, end, bulge in zip(points.tolist(), np.roll(points, -1).tolist(), bulges.tolist(), strict=True):
        corners.append(np.array([start]))
        if abs(bulge) > STRAIGHT_BULGE:
            corners.append(inner_points(start, end, bulge, level_count, keeps_area=True))
    return np.concatenate(corners)


def shapes_of(entity: DxfEntity) -> Sequence[DxfShape] | None:
    """Return the lines of an entity; None if it is not of a kind that has any.

    Raises `ValueError` if its numbers do not describe what it is, `OverflowError` if they are too many, and
    `InputError` if it is a curve and ezdxf is not installed.
    """
    make = MAKERS.get(entity.kind)
    if make is None or (make is _polyline and entity.whole(70) & MESH):
        return None
    return list(make(entity))


def _flat(points: Sequence[complex] | Points, heights: Sequence[float] = (), **given: Any) -> DxfShape:
    """Return a line of straight sides."""
    z = np.array(points, np.complex128)
    return DxfShape(z, np.zeros(len(z)), np.array(heights) if len(heights) else np.zeros(len(z)), **given)


def _level(points: Points, bulges: Reals, entity: DxfEntity, height: float, **given: Any) -> DxfShape:
    """Return a line in the plane of an entity's extrusion."""
    return DxfShape(points, bulges, np.full(len(points), height), placing=plane_of(entity), **given)


def _normal(entity: DxfEntity) -> Reals:
    """Return the extrusion of an entity, of length 1."""
    normal = np.array([entity.number(210), entity.number(220), entity.number(230, 1.0)])
    length = np.sqrt(normal @ normal)
    return normal / length if length > 0 else np.array([0.0, 0.0, 1.0])


def plane_of(entity: DxfEntity) -> Placing | None:
    """Return the placing of the plane of an entity's extrusion; None for the plane of the drawing."""
    if not {210, 220, 230} & entity.first.keys():
        return None
    normal = _normal(entity)
    if normal[2] == 1:
        return None
    is_steep = max(abs(normal[0]), abs(normal[1])) < 1 / 64  # the rule of the format for the axes
    across = np.cross([0.0, 1.0, 0.0] if is_steep else [0.0, 0.0, 1.0], normal)
    across /= np.sqrt(across @ across)
    return Placing(np.array([across, np.cross(normal, across), normal]).T, np.zeros(3))


def _line(entity: DxfEntity) -> Iterator[DxfShape]:
    (x, y, z), (u, v, w) = entity.point(10), entity.point(11)
    yield _flat([complex(x, y), complex(u, v)], [z, w])


def _arc(centre: complex, radius: float, start: float, turn: float) -> tuple[Points, Reals, bool]:
    """Return the corners and bulges of an arc, and whether it is a full circle; angles in rad, of turn 0 to 2 pi."""
    full = not FULL_TURN < abs(turn) < 2 * pi - FULL_TURN
    count = 2 if full or abs(turn) > pi else 1  # the bulge of a longer arc would lose digits
    each = np.copysign(2 * pi if full else turn, turn) / count
    points = centre + radius * np.exp(1j * (start + each * np.arange(count + (not full))))
    bulges = np.full(len(points), np.tan(each / 4))
    if not full:
        bulges[-1] = 0.0
    return points, bulges, full


def _circle(entity: DxfEntity) -> Iterator[DxfShape]:
    x, y, z = entity.point(10)
    start, end = 0.0, 360.0
    if entity.kind == "ARC":
        start, end = entity.number(50), entity.number(51)
    turn = np.radians((end - start) % 360)
    points, bulges, full = _arc(complex(x, y), entity.number(40), float(np.radians(start)), turn)
    yield _level(points, bulges, entity, z, closed=full)


def _ellipse(entity: DxfEntity) -> Iterator[DxfShape]:
    major = np.array(entity.point(11))
    minor = entity.number(40) * np.cross(_normal(entity), major)
    start, end = entity.number(41), entity.number(42, 2 * pi)
    placing = Placing(np.array([major, minor, _normal(entity)]).T, np.array(entity.point(10)))
    points, bulges, full = _arc(0j, 1.0, start, (end - start) % (2 * pi))
    yield DxfShape(points, bulges, np.zeros(len(points)), full, placing)


def _corners(groups: Groups) -> tuple[Points, Reals]:
    """Return the corners and bulges that groups list."""
    x, y, bulges = [], [], []
    for code, value in groups:
        if code == 10:
            x.append(float(value))
            bulges.append(0.0)
        elif code == 20:
            y.append(float(value))
        elif code == 42 and bulges:
            bulges[-1] = float(value)
    if len(x) != len(y):
        raise ValueError
    return np.array(x) + 1j * np.array(y), np.array(bulges)


def _lwpolyline(entity: DxfEntity) -> Iterator[DxfShape]:
    points, bulges = _corners(entity.groups)
    if len(points):
        yield _level(points, bulges, entity, entity.number(38), closed=bool(entity.whole(70) & CLOSED))


def _polyline(entity: DxfEntity) -> Iterator[DxfShape]:
    flags = entity.whole(70)
    corners = [each for each in entity.parts if not each.whole(70) & CONTROL_POINT]
    if not corners:
        return
    closed, curved = bool(flags & CLOSED), bool(flags & SPLINE_FIT)
    x, y, z = np.array([each.point(10) for each in corners]).T
    if flags & IS_3D:
        yield _flat(x + 1j * y, z, closed=closed, is_straightened=curved)
    else:
        bulges = np.array([each.number(42) for each in corners])
        yield _level(x + 1j * y, bulges, entity, entity.number(30), closed=closed, is_straightened=curved)


def _face(entity: DxfEntity) -> Iterator[DxfShape]:
    """Return the outline of a 3DFACE, or of a SOLID, whose last two corners are the other way round."""
    codes = (10, 11, 12, 13) if entity.kind == "3DFACE" else (10, 11, 13, 12)
    x, y, z = np.array([entity.point(code if code in entity.first else 12) for code in codes]).T
    placing = None if entity.kind == "3DFACE" else plane_of(entity)
    yield _flat(x + 1j * y, z, closed=True, placing=placing)


def _spline(entity: DxfEntity) -> Iterator[DxfShape]:
    x, y, z = _flattened(entity, 71, 41, 3)
    yield _flat(x + 1j * y, z, is_straightened=True)


def _flattened(entity: DxfEntity, degree: int, weight: int, dimensions: int) -> Reals:
    """Return the corners of straight sides along a curve, shape (dimensions, n); two numbers are group codes."""
    library()
    from ezdxf.math import BSpline, fit_points_to_cad_cv

    control, fitted = (np.array([entity.numbers(code + 10 * k) for k in range(dimensions)]).T for code in (10, 11))
    given = control if len(control) else fitted
    if len(given) > MAX_CURVE_CORNERS // MIN_SIDES_PER_SPAN:
        raise OverflowError
    if not len(given) or not np.isfinite(given).all():
        raise ValueError
    size = float(np.ptp(given, axis=0).sum())
    if size == 0:
        return given.T
    try:
        if len(control):
            order, knots, weights = entity.whole(degree) + 1, entity.numbers(40), entity.numbers(weight)
            curve = BSpline(control - given[0], order, knots or None, weights or None)
        else:
            curve = fit_points_to_cad_cv(fitted - given[0])
        sides = curve.flattening(FLATTENING_SHARE * size, MIN_SIDES_PER_SPAN)
        corners = np.array([point.xyz for point in islice(sides, MAX_CURVE_CORNERS)])
    except Exception:  # ezdxf raises many kinds
        raise ValueError from None
    if len(corners) == MAX_CURVE_CORNERS:
        raise OverflowError
    shifted: Reals = (corners[:, :dimensions] + given[0]).T
    return shifted


def _hatch(entity: DxfEntity) -> Iterator[DxfShape]:
    codes = [code for code, _ in entity.groups]
    begin = codes.index(91)
    end = codes.index(75, begin) if 75 in codes[begin:] else len(codes)
    for loop in _split(entity.groups[begin:end], 92):
        flags = int(loop[0][1])
        if flags & TEXT_BOX:  # around a text: not an opening
            continue
        if flags & POLYLINE_LOOP:
            rings = [(*_corners(loop), False)]
        else:
            edges = [_edge(DxfEntity("EDGE", each)) for each in _split(loop, 72)]
            straight = any(is_straightened for *_, is_straightened in edges)
            rings = [(*each, straight) for each in _joined([each[:2] for each in edges])]
        for points, bulges, is_straightened in rings:
            yield _level(points, bulges, entity, entity.number(30), closed=True, is_straightened=is_straightened)


def _split(groups: Groups, code: int) -> Iterator[Groups]:
    """Yield the pieces of groups that begin with a code."""
    starts = [k for k, (each, _) in enumerate(groups) if each == code]
    for start, end in pairwise([*starts, len(groups)]):
        yield groups[start:end]


def _edge(edge: DxfEntity) -> tuple[Points, Reals, bool]:
    """Return the corners and bulges of an edge of a hatch, and whether it is straightened."""
    kind, sense = edge.whole(72), 1 if edge.whole(73) else -1
    (x, y, _), (u, v, _), radius = edge.point(10), edge.point(11), edge.number(40)
    if kind == 4:
        x, y = _flattened(edge, 94, 42, 2)
        return x + 1j * y, np.zeros(len(x)), True
    if kind in (2, 3):
        start, end = np.radians([edge.number(50), edge.number(51)])
        if kind == 3:  # angles from the centre, as parameters
            start, end = np.arctan2(np.sin([start, end]), radius * np.cos([start, end]))
        points, bulges, full = _arc(0j, 1.0, sense * start, sense * ((end - start) % (2 * pi)))
        if full:
            points, bulges = np.append(points, points[0]), np.append(bulges, 0.0)
        a, b = (radius, 0.0) if kind == 2 else (u, v)
        ratio = 1.0 if kind == 2 else radius
        placing = Placing(np.array([[a, -ratio * b, 0], [b, ratio * a, 0], [0, 0, 1]]), np.array([x, y, 0]))
        shape = DxfShape(points, bulges, np.zeros(len(points)), placing=placing).placed(None)
        return shape.points, shape.bulges, shape.is_straightened
    return np.array([complex(x, y), complex(u, v)]), np.zeros(2), False


def _joined(edges: Sequence[tuple[Points, Reals]]) -> Iterator[tuple[Points, Reals]]:
    """Yield the loops of edges, which may stand in any order and direction; a gap becomes a straight side."""
    every = np.concatenate([points for points, _ in edges])
    tolerance = MEETING_SHARE * float(np.ptp(every.real) + np.ptp(every.imag)) or 1.0
    ends = [(complex(points[0]), complex(points[-1])) for points, _ in edges]

    def cell(z: complex) -> tuple[int, int]:
        return floor(z.real / (4 * tolerance)), floor(z.imag / (4 * tolerance))

    there = defaultdict(list)
    for k, pair in enumerate(ends):
        for side, z in enumerate(pair):
            there[cell(z)].append((k, side))
    left = dict.fromkeys(range(len(edges)))

    def following(k: int, z: complex) -> tuple[int, int]:
        """Return the edge that goes on at a point, and its end there; if there is none, the next edge."""
        beside = {cell(z + tolerance * complex(*corner)) for corner in product((-1, 1), repeat=2)}
        for other, side in chain(((k + 1, 0), (k + 1, 1)), *(there[each] for each in beside)):
            if other in left and abs(ends[other][side] - z) <= tolerance:
                return other, side
        other = next(iter(left))
        return other, int(abs(ends[other][1] - z) < abs(ends[other][0] - z))

    while left:
        k, side = next(iter(left)), 0
        begin, at, loop = ends[k][0], ends[k][0], []  # type: complex, complex, list[tuple[Points, Reals]]
        while True:
            del left[k]
            points, bulges = edges[k]
            if side:
                points, bulges = points[::-1], np.append(-bulges[-2::-1], 0.0)
            if loop and abs(points[0] - at) <= tolerance:
                loop[-1] = loop[-1][0][:-1], loop[-1][1][:-1]
            loop.append((points, bulges))
            at = complex(points[-1])
            if not left or abs(at - begin) <= tolerance:
                break
            k, side = following(k, at)
        if abs(at - begin) <= tolerance:
            loop[-1] = loop[-1][0][:-1], loop[-1][1][:-1]
        yield np.concatenate([points for points, _ in loop]), np.concatenate([bulges for _, bulges in loop])


MAKERS: Mapping[str, Callable[[DxfEntity], Iterator[DxfShape]]] = {
    "3DFACE": _face,
    "ARC": _circle,
    "CIRCLE": _circle,
    "ELLIPSE": _ellipse,
    "HATCH": _hatch,
    "LINE": _line,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SOLID": _face,
    "SPLINE": _spline,
    "TRACE": _face,
}
