"""Drawings in DXF, R12 to 2018, ASCII and binary: what each entity of model space is, and where inserts place it.

ezdxf reads and mends the file. Its entities are taken one by one, as its paths have cubic curves in place of arcs.
"""

from __future__ import annotations

import io
import re
from cmath import isfinite
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from typing import Any

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnPoint, DrawnText, LineDrawing, OmittedKind
from rocking_cli.io.drawings.dxf_shapes import DxfShape, Placing, plane_of, shapes_of

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
                raise self._refusal(
                    "too_large", f"{_called(entity, layer)} has too many corners", "simplify it"
                ) from None
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
