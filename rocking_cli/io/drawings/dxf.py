"""Drawings in DXF, R12 to 2018, ASCII and binary: what each entity of model space is, and where inserts place it.

ezdxf reads and mends the file. Its entities are taken one by one, as its paths have cubic curves in place of arcs.
"""

from __future__ import annotations

import io
import re
from cmath import isfinite
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from math import pi
from typing import Any, NamedTuple

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.drawings.contract import (
    STRAIGHT_BULGE,
    DrawingError,
    DrawnLine,
    DrawnPoint,
    DrawnText,
    LineDrawing,
    OmittedKind,
    inner_points,
    level_count,
)

FULL_TURN = 1e-6  # rad that a full circle may be short of
SAME_SHARE = 1e-9  # share of its size within which points of a line coincide, and a placing keeps circles
MEETING_SHARE = 1e-6  # share of its size within which the edges of a hatch meet
FLATTENING_SHARE = 1e-6  # distance of a curve from its straight sides over its size
MIN_SIDES_PER_SPAN, MAX_CURVE_CORNERS = 8, 50_000
SPLINE_FIT, POLYFACE, CONTROL_POINT = 4, 16 | 64, 16  # flags of a POLYLINE, and of its vertices
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
    if make is None or (make is _polyline and entity.dxf.flags & POLYFACE):
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

TITLE, ENDINGS = "DXF", (".dxf",)
BINARY, DWG = b"AutoCAD Binary DXF\r\n\x1a\x00", b"AC10"
START = re.compile(rb"(?:\xef\xbb\xbf)?\s*(?:999[ \t]*\r?\n[^\n]*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION\s")
ENTITY = re.compile(rb"\n[ \t]*0[ \t]*\r?\n[ \t]*[A-Z]")
UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 14: "dm"}
IMPERIAL = {"in": "inches", "ft": "feet"}
DOS_PAGE = re.compile(rb"\$DWGCODEPAGE\s+3\s+dos(\d+)", re.IGNORECASE)
ESCAPED = b"\\U+"  # begins a letter that ezdxf only decodes where it mends
HEAD_BYTES = 100_000  # within which a file says its page
MAX_BYTES = 64_000_000
MAX_ENTITIES = 100_000  # lines, polylines and so on, also those that blocks make
MAX_CORNERS = 300_000
MAX_BULGE = 1e6  # of a full turn but for 4e-6 rad
MAX_DEPTH = 32  # of blocks within blocks
FILLED = ("HATCH", "MPOLYGON", "SOLID", "TRACE")
TEXTS = ("TEXT", "MTEXT", "ATTRIB")
FROM_START = (0, 3, 5)  # horizontal alignments of a text on its base line whose point is that of insertion
ANNOTATION = "an annotation"
NO_LENGTH, IS_FROZEN, IS_OFF = "without length", "its layer is frozen", "its layer is off"
SPLIT_HINT = "save what is needed as a drawing of its own"
WHY = {
    **dict.fromkeys(("3DSOLID", "BODY", "SURFACE", "EXTRUDEDSURFACE", "LOFTEDSURFACE", "REVOLVEDSURFACE",
                     "SWEPTSURFACE", "PLANESURFACE", "MESH", "POLYLINE"), "a body in space"),
    **dict.fromkeys(("DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "LEADER", "MULTILEADER", "MLEADER",
                     "QLEADER", "TOLERANCE", "ACAD_TABLE"), ANNOTATION),
    **dict.fromkeys(("IMAGE", "WIPEOUT", "OLEFRAME", "OLE2FRAME", "PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY"),
                    "a picture"),
    **dict.fromkeys(("XLINE", "RAY"), "without an end"),
    "ATTDEF": "the template of an attribute",
    "VIEWPORT": "a view of the drawing",
}  # fmt: skip
UNFIT = (ArithmeticError, AttributeError, IndexError, RecursionError, TypeError, ValueError)
"""What ezdxf raises, besides errors of its own, for numbers that do not fit together."""
UNREAD = "of a kind that cannot be read: explode it"  # such as MLINE and REGION, and those of other programs


def sniff(data: bytes, ending: str, /) -> bool:
    """Return whether a file is a DXF or DWG file, or should be one by its name."""
    return ending in ENDINGS or data.startswith(DWG) or _is_dxf(data)


def _is_dxf(data: bytes) -> bool:
    return data.startswith(BINARY) or START.match(data[:4096]) is not None


def read(data: bytes, file: str, /) -> LineDrawing:
    """Read a drawing; see `DrawingReader`.

    Raises
    ------
    DrawingError
        not_dxf: a DWG, or a file that is damaged or cut short; xref: a reference to another file; clipped: an insert of
        which a part is hidden; too_large: more than the drawing of a structure has.
    InputError
        If ezdxf is not installed.
    """
    document, faults = _document(data, file)
    model = _ModelSpace(document, file)
    with np.errstate(all="ignore"):  # numbers that are not finite are refused where chains are made
        model.take(document.modelspace())
    for layout in document.layouts:
        for entity in () if layout.is_modelspace else layout:
            model.leave(entity, "in paper space")
    left_out = [OmittedKind(*key, count) for key, count in model.left_out.items()]
    unit, doubt = _unit(document.header)
    return LineDrawing(
        TITLE, model.chains, model.labels, model.spots, left_out, unit, doubt=doubt, faults=faults,
        annotations=model.annotations,
    )  # fmt: skip


def ezdxf_module() -> Any:
    """Return the package ezdxf. Raises `InputError` if it is not installed."""
    try:
        import ezdxf
    except ImportError:
        hint = "pip install 'rocking-cli[drawing]'"
        raise InputError(Problem("a DXF file needs the package ezdxf", hint=hint)) from None
    return ezdxf


def _document(data: bytes, file: str) -> tuple[Any, list[str]]:
    """Return the document of ezdxf, and what it mended or found at fault."""

    def refusal(message: str, hint: str | None = None, refused: str = "not_dxf") -> DrawingError:
        return DrawingError(refused, message, file, hint=hint)

    if data.startswith(DWG):
        raise refusal("this is a DWG file", "save it as DXF")
    if not data.strip():
        raise refusal("the file is empty")
    if not _is_dxf(data):
        raise refusal("this is not a DXF file: it does not begin with a section")
    if len(data) > MAX_BYTES:
        raise refusal(f"the drawing is larger than {MAX_BYTES / 1e6:g} MB", SPLIT_HINT, "too_large")
    if not data.rstrip(b"\0\r\n\t ").endswith(b"EOF"):
        raise refusal("the file is cut short: it does not end with EOF", "save it again")
    if sum(1 for _ in ENTITY.finditer(data)) > MAX_ENTITIES:
        raise refusal(f"the drawing has more than {MAX_ENTITIES} entities, such as lines", SPLIT_HINT, "too_large")
    ezdxf_module()
    try:
        document, auditor = _loaded(data)
    except Exception as error:  # ezdxf raises many kinds
        hint = "open it in a CAD program, and save it again"
        raise refusal(f"the file is damaged: {error or type(error).__name__}", hint) from None
    return document, [each.message for each in (*auditor.fixes, *auditor.errors)]


def _loaded(data: bytes) -> tuple[Any, Any]:
    """Return the document and the auditor of ezdxf, which mends what it cannot load as it is."""
    from ezdxf import recover
    from ezdxf.document import Drawing
    from ezdxf.filemanagement import dxf_stream_info
    from ezdxf.lldxf.tagger import binary_tags_loader

    if data.startswith(BINARY):
        document = Drawing.load(binary_tags_loader(data, errors="surrogateescape"))
        return document, document.audit()
    with suppress(Exception):
        info = dxf_stream_info(io.TextIOWrapper(io.BytesIO(data), "latin-1"))
        if info.encoding != "utf-8" and (page := DOS_PAGE.search(data[:HEAD_BYTES])):  # ezdxf takes it for cp1252
            data = data.decode(f"cp{int(page[1])}", "replace").encode(info.encoding, "dxfreplace")
        if ESCAPED not in data:
            document = Drawing.read(io.TextIOWrapper(io.BytesIO(data), info.encoding, "surrogateescape"))
            return document, document.audit()
    return recover.read(io.BytesIO(data))


def _unit(header: Any) -> tuple[str | None, str]:
    """Return the unit of a file, and why it is not believed."""
    number, is_metric = header.get("$INSUNITS", 0), header.get("$MEASUREMENT", 0)
    if not number:
        return None, ""
    unit = UNITS.get(number)
    if unit is None:
        known = ", ".join(f"{each} ({name})" for each, name in UNITS.items())
        return None, f"the file has the unit {number} of $INSUNITS, which is not one of {known}"
    if unit in IMPERIAL and is_metric:
        return None, f"the file states {IMPERIAL[unit]}, but its $MEASUREMENT is metric"
    return unit, ""


class _ModelSpace:
    """What is drawn in model space, by and by."""

    def __init__(self, document: Any, file: str) -> None:
        self.document, self.file = document, file
        self.chains: list[DrawnLine] = []
        self.labels: list[DrawnText] = []
        self.spots: list[DrawnPoint] = []
        self.annotations: list[Points] = []
        self.left_out: Counter[tuple[str, str, str]] = Counter()
        self._layers: dict[str, tuple[str, str]] = {}
        self._shapes: dict[Any, list[DxfShape] | None] = {}
        self._sizes: dict[str, tuple[int, int]] = {}
        self._entities = self._corners = self._hatches = 0
        self._unfit = (*UNFIT, ezdxf_module().DXFError)

    def take(self, entities: Iterable[Any], placing: Placing | None = None, inserted_on: str | None = None) -> None:
        """Take entities that `placing` places; in a block, those of layer 0 are on the layer of its insert."""
        for entity in entities:
            kind = entity.dxftype()
            layer, why = self._layer_of(entity, inserted_on)
            if (entity.dxf.hasattr("invisible") and entity.dxf.invisible) or (kind == "ATTRIB" and entity.is_invisible):
                why = "invisible"
            elif kind == "INSERT" and why == IS_OFF:
                why = ""  # its entities on other layers are seen
            try:
                if why:
                    self.left_out[kind, layer, why] += 1
                elif kind == "INSERT":
                    self._insert(entity, placing, layer, inserted_on is None)
                elif kind in TEXTS:
                    self._label(entity, placing, layer)
                elif kind == "POINT":
                    at = _carried(entity.dxf.location, None, placing)
                    self.spots.append(DrawnPoint(at, layer, kind, _handle(entity)))
                else:
                    self._lines(entity, placing, layer)
            except DrawingError:
                raise
            except OverflowError:
                what = f"{_called(entity, layer)} has too many corners"
                raise self._refusal("too_large", what, "simplify it") from None
            except self._unfit as error:
                what = f"{_called(entity, layer)} is damaged: its numbers do not describe it"
                raise self._refusal("not_dxf", what, "audit the file in a CAD program and save it again") from error

    def leave(self, entity: Any, why: str) -> None:
        """Leave an entity out."""
        self.left_out[entity.dxftype(), self._layer_of(entity, None)[0], why] += 1

    def _refusal(self, refused: str, message: str, hint: str | None = None) -> DrawingError:
        return DrawingError(refused, message, self.file, hint=hint)

    def _layer_of(self, entity: Any, inserted_on: str | None) -> tuple[str, str]:
        """Return the layer of an entity, and why its entities are left out."""
        given = entity.dxf.layer if entity.dxf.hasattr("layer") else "0"  # `get` fails for kinds unknown
        given = inserted_on if given == "0" and inserted_on is not None else given
        key = given.lower()
        if key not in self._layers:
            name, why = given, ""
            if self.document.layers.has_entry(given):
                entry = self.document.layers.get(given)
                name, why = entry.dxf.name, IS_FROZEN if entry.is_frozen() else IS_OFF if entry.is_off() else ""
            self._layers[key] = name, why
        return self._layers[key]

    def _lines(self, entity: Any, placing: Placing | None, layer: str) -> None:
        kind = entity.dxftype()
        if entity not in self._shapes:
            self._shapes[entity] = shapes_of(entity)
        shapes = self._shapes[entity]
        if shapes is None:
            self.left_out[kind, layer, WHY.get(kind, UNREAD)] += 1
            if WHY.get(kind) == ANNOTATION:
                with suppress(*self._unfit):  # the structure does not need it
                    lines = [line for part in entity.virtual_entities() for line in shapes_of(part) or ()]
                    self.annotations += [line.placed(placing).points for line in lines]
            return
        self._hatches += kind == "HATCH"
        shape, is_fill = f"HATCH {self._hatches}" * (kind == "HATCH"), kind in FILLED
        placed = [each.placed(placing) for each in shapes]
        self._corners += sum(len(each.points) for each in placed)
        if self._corners > MAX_CORNERS:
            raise self._refusal("too_large", f"the drawing has more than {MAX_CORNERS} corners", SPLIT_HINT)
        for each in placed:
            if not isfinite((each.points + each.bulges).sum()) or np.abs(each.bulges).max() > MAX_BULGE:
                raise ValueError
            drawn = each.tidied()
            if drawn is None:
                self.left_out[kind, layer, NO_LENGTH] += 1
                continue
            heights = each.heights.tolist()
            self.chains.append(DrawnLine(
                drawn.points, drawn.bulges, drawn.closed, layer, kind, _handle(entity), shape, is_fill,
                drawn.is_straightened, (min(heights), max(heights)),
            ))  # fmt: skip
        if not placed:
            self.left_out[kind, layer, NO_LENGTH] += 1

    def _label(self, entity: Any, placing: Placing | None, layer: str) -> None:
        kind, at = entity.dxftype(), entity.dxf.get("insert", (0, 0, 0))
        if kind != "MTEXT" and (entity.dxf.halign not in FROM_START or entity.dxf.valign):
            at = entity.dxf.get("align_point", at)
        if not (text := entity.plain_text().strip()):
            self.left_out[kind, layer, "empty"] += 1
            return
        plane = None if kind == "MTEXT" else plane_of(entity)
        self.labels.append(DrawnText(text, _carried(at, plane, placing), layer, kind, _handle(entity)))

    def _insert(self, entity: Any, outer: Placing | None, layer: str, is_outermost: bool) -> None:
        from ezdxf.xclip import XClip

        self.take(entity.attribs, outer, layer)
        name, block = entity.dxf.name, entity.block()
        head: Any = None if block is None else block.block
        if block is None or not (len(block) or head.is_xref or head.is_xref_overlay):
            why = f"its block {name} is {'not in the file' if block is None else 'empty'}"
            self.left_out["INSERT", layer, why] += 1
            return
        if head.is_xref or head.is_xref_overlay:
            what = f"the drawing refers to another file, {head.dxf.xref_path or name}"
            raise self._refusal("xref", what, "bind it in the CAD program")
        clip = XClip(entity)
        if clip.has_clipping_path and clip.is_clipping_enabled:
            what = f"{_called(entity, layer)} shows only a part of its block {name} (XCLIP)"
            raise self._refusal("clipped", what, "explode it in the CAD program, and trim what is hidden")
        if is_outermost:
            self._entities += self._size(entity)[0]
            if self._entities > MAX_ENTITIES:
                what = f"the inserts of the drawing make more than {MAX_ENTITIES} entities, such as lines"
                raise self._refusal("too_large", what, SPLIT_HINT)
        for each in entity.multi_insert() if entity.mcount > 1 else (entity,):
            rows = np.array(list(each.matrix44().rows()))
            placing = Placing(rows[:3, :3].T, rows[3, :3])
            self.take(block, placing if outer is None else outer.after(placing), layer)

    def _size(self, insert: Any, above: tuple[str, ...] = ()) -> tuple[int, int]:
        """Return how many entities an insert makes, and how many blocks deep."""
        name, block = insert.dxf.name.lower(), insert.block()
        if name in above:
            raise self._refusal("not_dxf", f"the block {insert.dxf.name} contains itself")
        if name not in self._sizes and len(above) <= MAX_DEPTH and block is not None:
            inner = [self._size(each, (*above, name)) for each in block.query("INSERT")]
            deep = 1 + max((each for _, each in inner), default=0)
            self._sizes[name] = 1 + len(block) + sum(size for size, _ in inner), deep
        size, deep = self._sizes.get(name, (0, len(above)))
        if deep > MAX_DEPTH:
            raise self._refusal("too_large", f"blocks are nested more than {MAX_DEPTH} deep", "explode them")
        return size * max(1, insert.mcount), deep


def _handle(entity: Any) -> str:
    return entity.dxf.handle or ""


def _called(entity: Any, layer: str) -> str:
    """Return what an entity is called in messages."""
    return f"{' '.join(filter(None, (entity.dxftype(), _handle(entity))))} on layer {layer}"


def _carried(point: Any, plane: Placing | None, placing: Placing | None) -> complex:
    """Return where a point of a plane is drawn."""
    x, y, z = (*point, 0.0)[:3]
    total = plane if placing is None else placing.after(plane)
    at = np.array([complex(x, y)])
    if total is not None:
        at, _ = total.carry(at, np.array([z]))
    if not isfinite(at[0]):
        raise ValueError
    return complex(at[0])
