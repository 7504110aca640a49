"""Lines with arcs of the entities of a DXF file, mirrored, turned and scaled.

A shape is drawn in a plane of its own: that of its extrusion, or the one in which its ellipse is a circle. Its arcs
stay exact if the placing of the plane keeps circles; otherwise they become straight sides, as those of an ellipse do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from math import pi
from typing import Any, NamedTuple

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.io.drawings.contract import STRAIGHT_BULGE, inner_points, level_count

FULL_TURN = 1e-6  # rad that a full circle may be short of
SAME_SHARE = 1e-9  # share of its size within which points of a line coincide, and a placing keeps circles
MEETING_SHARE = 1e-6  # share of its size within which the edges of a hatch meet
FLATTENING_SHARE = 1e-6  # distance of a curve from its straight sides over its size
MIN_SIDES_PER_SPAN, MAX_CURVE_CORNERS = 8, 50_000
SPLINE_FIT, MESH, CONTROL_POINT = 4, 16 | 64, 16  # flags of a POLYLINE, and of its vertices
TEXT_BOX = 8  # flag of a loop of a HATCH


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


def shapes_of(entity: Any) -> list[DxfShape] | None:
    """Return the lines of an entity of ezdxf; None if it is not of a kind that has any.

    Raises `OverflowError` if its numbers are too many, and many kinds of errors if they do not describe what it is.
    """
    make = MAKERS.get(entity.dxftype())
    if make is None or (make is _polyline and entity.dxf.flags & MESH):
        return None
    return list(make(entity))


def _flat(points: Any, placing: Placing | None = None, **given: Any) -> DxfShape:
    """Return a line of straight sides through points in space."""
    x, y, z = np.array([(*each, 0.0)[:3] for each in points]).T
    return DxfShape(x + 1j * y, np.zeros(len(x)), z, placing=placing, **given)


def _level(points: Points, bulges: Reals, entity: Any, height: float, **given: Any) -> DxfShape:
    """Return a line in the plane of an entity's extrusion."""
    return DxfShape(points, bulges, np.full(len(points), height), placing=plane_of(entity), **given)


def plane_of(entity: Any) -> Placing | None:
    """Return the placing of the plane of an entity's extrusion; None for the plane of the drawing."""
    ocs = entity.ocs()
    return Placing(np.array([ocs.ux, ocs.uy, ocs.uz]).T, np.zeros(3)) if ocs.transform else None


def _line(entity: Any) -> Iterator[DxfShape]:
    yield _flat([entity.dxf.start, entity.dxf.end])


def _arc(centre: complex, radius: float, start: float, turn: float) -> tuple[Points, Reals, bool]:
    """Return the corners and bulges of an arc, and whether it is a full circle; angles in rad, of turn 0 to 2 pi."""
    full = not FULL_TURN < abs(turn) < 2 * pi - FULL_TURN
    count = 2 if full or abs(turn) > pi else 1  # the bulge of a longer arc would lose digits
    turn_each = np.copysign(2 * pi if full else turn, turn) / count
    points = centre + radius * np.exp(1j * (start + turn_each * np.arange(count + (not full))))
    bulges = np.full(len(points), np.tan(turn_each / 4))
    if not full:
        bulges[-1] = 0.0
    return points, bulges, full


def _circle(entity: Any) -> Iterator[DxfShape]:
    x, y, z = entity.dxf.center
    is_arc = entity.dxftype() == "ARC"
    start, end = (entity.dxf.start_angle, entity.dxf.end_angle) if is_arc else (0.0, 360.0)
    points, bulges, full = _arc(complex(x, y), entity.dxf.radius, np.radians(start), np.radians((end - start) % 360))
    yield _level(points, bulges, entity, z, closed=full)


def _ellipse(entity: Any) -> Iterator[DxfShape]:
    """Take an ellipse as a circle in a plane that is stretched, in which unequal axes make it straight sides."""
    dxf = entity.dxf
    placing = Placing(np.array([dxf.major_axis, entity.minor_axis, dxf.extrusion]).T, np.array(dxf.center))
    points, bulges, full = _arc(0j, 1.0, dxf.start_param, (dxf.end_param - dxf.start_param) % (2 * pi))
    yield DxfShape(points, bulges, np.zeros(len(points)), full, placing)


def _bulged(corners: Any) -> tuple[Points, Reals]:
    """Return corners and bulges from rows of x, y and bulge."""
    x, y, bulges = np.array(corners, float).T
    return x + 1j * y, bulges


def _lwpolyline(entity: Any) -> Iterator[DxfShape]:
    if len(entity):
        yield _level(*_bulged(entity.get_points("xyb")), entity, entity.dxf.elevation, closed=entity.closed)


def _polyline(entity: Any) -> Iterator[DxfShape]:
    corners = [each.dxf for each in entity.vertices if not each.dxf.flags & CONTROL_POINT]
    if not corners:
        return
    given = {"closed": entity.is_closed, "is_straightened": bool(entity.dxf.flags & SPLINE_FIT)}
    if entity.is_3d_polyline:
        yield _flat([each.location for each in corners], **given)
    else:
        points, bulges = _bulged([(*each.location.vec2, each.get("bulge", 0.0)) for each in corners])
        yield _level(points, bulges, entity, entity.dxf.elevation.z, **given)


def _face(entity: Any) -> Iterator[DxfShape]:
    """Return the outline of a 3DFACE, or of a SOLID, whose last two corners are the other way round."""
    corners = [entity.dxf.get(f"vtx{k}", entity.dxf.vtx2) for k in range(4)]
    if entity.dxftype() == "3DFACE":
        yield _flat(corners, closed=True)
    else:
        yield _flat([corners[k] for k in (0, 1, 3, 2)], plane_of(entity), closed=True)


def _spline(entity: Any) -> Iterator[DxfShape]:
    given = entity.control_points if len(entity.control_points) else entity.fit_points
    yield _flat(_flattened(entity.construction_tool, np.array(given)), is_straightened=True)


def _flattened(curve: Callable[[], Any], given: Reals) -> Reals:
    """Return the corners of straight sides along a curve of ezdxf, whose control or fit points are given."""
    if len(given) > MAX_CURVE_CORNERS // MIN_SIDES_PER_SPAN:
        raise OverflowError
    if not len(given) or not np.isfinite(given).all():
        raise ValueError
    size = float(np.ptp(given, axis=0).sum())
    if size == 0:
        return given
    sides = curve().flattening(FLATTENING_SHARE * size, MIN_SIDES_PER_SPAN)
    corners = np.array([point.xyz for point in islice(sides, MAX_CURVE_CORNERS)])
    if len(corners) == MAX_CURVE_CORNERS:
        raise OverflowError
    return corners


def _hatch(entity: Any) -> Iterator[DxfShape]:
    for path in entity.paths.paths:
        if path.path_type_flags & TEXT_BOX:  # around a text: not an opening
            continue
        if hasattr(path, "vertices"):
            rings = [(*_bulged(path.vertices), True, False)] if len(path.vertices) else []
        else:
            rings = list(_joined([_edge(each) for each in path.edges])) if path.edges else []
        for points, bulges, closed, is_straightened in rings:
            given = {"closed": closed, "is_straightened": is_straightened}
            yield _level(points, bulges, entity, entity.dxf.elevation.z, **given)


def _edge(edge: Any) -> tuple[Points, Reals, bool]:
    """Return the corners and bulges of an edge of a hatch, and whether it is straightened."""
    if hasattr(edge, "control_points"):
        given = edge.control_points or edge.fit_points
        x, y, *_ = np.array([(*each, 0.0) for each in _flattened(edge.construction_tool, np.array(given))]).T
        return x + 1j * y, np.zeros(len(x)), True
    if hasattr(edge, "center"):  # its angles run anticlockwise, in whatever sense the edge does
        if hasattr(edge, "radius"):
            axes, start, end = (edge.radius, 0.0, 1.0), np.radians(edge.start_angle), np.radians(edge.end_angle)
        else:
            axes, start, end = (*edge.major_axis, edge.ratio), edge.start_param, edge.end_param
        points, bulges, full = _arc(0j, 1.0, start, (end - start) % (2 * pi))
        if full:
            points, bulges = np.append(points, points[0]), np.append(bulges, 0.0)
        a, b, ratio = axes
        placing = Placing(np.array([[a, -ratio * b, 0], [b, ratio * a, 0], [0, 0, 1]]), np.array([*edge.center, 0.0]))
        shape = DxfShape(points, bulges, np.zeros(len(points)), placing=placing).placed(None)
        return shape.points, shape.bulges, shape.is_straightened
    return np.array([complex(*edge.start), complex(*edge.end)]), np.zeros(2), False


def _joined(edges: Sequence[tuple[Points, Reals, bool]]) -> Iterator[tuple[Points, Reals, bool, bool]]:
    """Yield the lines that edges make in any order and sense, and whether each is closed and straightened."""
    from ezdxf import edgeminer

    every = np.concatenate([points for points, _, _ in edges])
    tolerance = MEETING_SHARE * float(np.ptp(every.real) + np.ptp(every.imag)) or 1.0
    made = []
    for points, bulges, is_straightened in edges:
        start, end = ((z.real, z.imag) for z in (points[0], points[-1]))
        if abs(points[0] - points[-1]) <= tolerance:
            yield points[:-1], bulges[:-1], True, is_straightened
        else:
            made.append(edgeminer.make_edge(start, end, payload=(points, bulges, is_straightened)))
    if not made:
        return
    for chain in edgeminer.find_all_simple_chains(edgeminer.Deposit(made, gap_tol=tolerance)):
        corners, turns = [], []
        for edge in chain:
            points, bulges, _ = edge.payload
            if edge.is_reverse:
                points, bulges = points[::-1], np.append(-bulges[-2::-1], 0.0)
            corners.append(points[:-1])
            turns.append(bulges[:-1])
        closed = edgeminer.is_loop(chain, gap_tol=tolerance)
        if not closed:
            corners.append(points[-1:])
            turns.append(np.zeros(1))
        yield np.concatenate(corners), np.concatenate(turns), closed, any(each.payload[2] for each in chain)


MAKERS: Mapping[str, Callable[[Any], Iterator[DxfShape]]] = {
    "3DFACE": _face,
    "ARC": _circle,
    "CIRCLE": _circle,
    "ELLIPSE": _ellipse,
    "HATCH": _hatch,
    "LINE": _line,
    "LWPOLYLINE": _lwpolyline,
    "MPOLYGON": _hatch,
    "POLYLINE": _polyline,
    "SOLID": _face,
    "SPLINE": _spline,
    "TRACE": _face,
}
