"""Drawings in DXF, R12 to 2018, ASCII and binary: what each entity of model space is, and where inserts place it."""

from __future__ import annotations

import re
from cmath import isfinite
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import product
from math import cos, radians, sin
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnPoint, DrawnText, LineDrawing, OmittedKind
from rocking_cli.io.drawings.dxf_groups import (
    DWG,
    GROUPS_PER_ENTITY,
    MAX_ENTITIES,
    DxfEntity,
    DxfFile,
    is_dxf,
    library,
    read_groups,
)
from rocking_cli.io.drawings.dxf_shapes import DxfShape, Placing, plane_of, shapes_of

TITLE, ENDINGS = "DXF", (".dxf",)
UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 14: "dm"}
IMPERIAL = {"in": "inches", "ft": "feet"}
MAX_CORNERS = 300_000
MAX_BULGE = 1e6  # of a full turn but for 4e-6 rad
MAX_DEPTH = 32  # of blocks within blocks
FROZEN, XREF, HIDDEN = 1, 4 | 8, 1  # flags of a layer, a block and an attribute
FILLED = ("HATCH", "SOLID", "TRACE")
MODEL_SPACE = ("*model_space", "$model_space")
PAPER_SPACE = ("*paper_space", "$paper_space")
NO_BULGES = np.zeros(2)
SCREEN_CODE = re.compile(r"%%([0-9]{3}|.)", re.DOTALL)
SIGNS = {"c": "\u2300", "d": "\u00b0", "p": "\u00b1", "%": "%"}
NO_LENGTH, ON_PAPER = "without length", "in paper space"
IS_FROZEN, IS_OFF = "its layer is frozen", "its layer is off"
WHY = {
    **dict.fromkeys(("3DSOLID", "BODY", "SURFACE", "EXTRUDEDSURFACE", "LOFTEDSURFACE", "REVOLVEDSURFACE",
                     "SWEPTSURFACE", "PLANESURFACE", "MESH", "POLYLINE"), "a body in space"),
    **dict.fromkeys(("DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "LEADER", "MULTILEADER", "MLEADER",
                     "QLEADER", "TOLERANCE", "ACAD_TABLE"), "an annotation"),
    **dict.fromkeys(("IMAGE", "WIPEOUT", "OLEFRAME", "OLE2FRAME", "PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY"),
                    "a picture"),
    **dict.fromkeys(("XLINE", "RAY"), "without an end"),
    "ATTDEF": "the template of an attribute",
    "VIEWPORT": "a view of the drawing",
}  # fmt: skip
UNREAD = "of a kind that cannot be read: explode it"  # such as MLINE and REGION, and those of other programs


def sniff(data: bytes, ending: str, /) -> bool:
    """Return whether a file is a DXF or DWG file, or should be one by its name."""
    return ending in ENDINGS or data.startswith(DWG) or is_dxf(data)


def read(data: bytes, file: str, /) -> LineDrawing:
    """Read a drawing; see `DrawingReader`.

    Raises
    ------
    DrawingError
        not_dxf: a DWG, or a file that is damaged or cut short; xref: a reference to another file; too_large: more than
        the drawing of a structure has.
    InputError
        If ezdxf is not installed and needed: for curves, for texts of several lines and for binary files.
    """
    dxf = read_groups(data, file)
    model = _ModelSpace(dxf, file)
    blocks = [dxf.blocks[name].parts for name in MODEL_SPACE if name in dxf.blocks]
    with np.errstate(all="ignore"):  # numbers that are not finite are refused where chains are made
        for entities in (dxf.entities, *blocks):
            model.take(entities)
    for name, block in dxf.blocks.items():
        if name.startswith(PAPER_SPACE):
            for entity in block.parts:
                model.leave(entity, ON_PAPER)
    left_out = [OmittedKind(*key, count) for key, count in model.left_out.items()]
    unit, doubt = _unit(dxf)
    return LineDrawing(TITLE, model.chains, model.labels, model.spots, left_out, unit, doubt=doubt)


def _unit(dxf: DxfFile) -> tuple[str | None, str]:
    """Return the unit of a file, and why it is not believed."""
    number, is_metric = (_whole(dxf, variable) for variable in ("$INSUNITS", "$MEASUREMENT"))
    if not number:
        return None, ""
    unit = UNITS.get(number)
    if unit is None:
        known = ", ".join(f"{each} ({name})" for each, name in UNITS.items())
        return None, f"the file has the unit {number} of $INSUNITS, which is not one of {known}"
    if unit in IMPERIAL and is_metric:
        return None, f"the file states {IMPERIAL[unit]}, but its $MEASUREMENT is metric"
    return unit, ""


def _whole(dxf: DxfFile, variable: str) -> int:
    try:
        return int(dxf.header.get(variable, 0))
    except ValueError:
        return 0


class _ModelSpace:
    """What is drawn in model space, by and by."""

    def __init__(self, dxf: DxfFile, file: str) -> None:
        self.dxf, self.file = dxf, file
        self.chains: list[DrawnLine] = []
        self.labels: list[DrawnText] = []
        self.spots: list[DrawnPoint] = []
        self.left_out: Counter[tuple[str, str, str]] = Counter()
        self._layers: dict[Any, tuple[str, str]] = {}
        self._spelling: dict[str, tuple[str, str]] = {}
        self._shapes: dict[int, Sequence[DxfShape] | None] = {}
        self._sizes: dict[str, tuple[int, int]] = {}
        self._entities = self._corners = self._hatches = 0

    def take(
        self, entities: Sequence[DxfEntity], placing: Placing | None = None, inserted_on: str | None = None
    ) -> None:
        """Take entities that `placing` places; in a block, those of layer 0 are on the layer of its insert."""
        for entity in entities:
            try:
                layer, why = self._layer_of(entity, inserted_on)
                if entity.whole(67):
                    why = ON_PAPER
                elif entity.whole(60) or (entity.kind == "ATTRIB" and entity.whole(70) & HIDDEN):
                    why = "invisible"
                elif entity.kind == "INSERT" and why == IS_OFF:
                    why = ""  # its entities on other layers are seen
                if why:
                    self.left_out[entity.kind, layer, why] += 1
                elif entity.kind == "INSERT":
                    self._insert(entity, placing, layer, inserted_on is None)
                elif entity.kind in ("TEXT", "MTEXT", "ATTRIB"):
                    self._label(entity, placing, layer)
                elif entity.kind == "POINT":
                    at = self._carried(entity.point(10), None, placing)
                    self.spots.append(DrawnPoint(at, layer, entity.kind, self.dxf.name(entity, 5)))
                elif entity.kind == "LINE" and placing is None:
                    self._line(entity, layer)
                else:
                    self._lines(entity, placing, layer)
            except (ValueError, IndexError):
                what = f"{self._called(entity)} is damaged: its numbers do not describe it"
                raise self._refusal("not_dxf", what, "audit the file in a CAD program and save it again") from None
            except OverflowError:
                what = f"{self._called(entity)} has too many corners"
                raise self._refusal("too_large", what, "simplify it") from None

    def leave(self, entity: DxfEntity, why: str) -> None:
        """Leave an entity out."""
        self.left_out[entity.kind, self._layer_of(entity, None)[0], why] += 1

    def _refusal(self, refused: str, message: str, hint: str | None = None) -> DrawingError:
        return DrawingError(refused, message, self.file, hint=hint)

    def _called(self, entity: DxfEntity) -> str:
        """Return what an entity is called in messages."""
        name = self.dxf.name(entity, 5)
        return f"{entity.kind}{' ' * bool(name)}{name} on layer {self._layer_of(entity, None)[0]}"

    def _layer_of(self, entity: DxfEntity, inserted_on: str | None) -> tuple[str, str]:
        """Return the layer of an entity, and why its entities are left out."""
        given = entity.first.get(8, "0")
        state = self._layers.get(given)
        if state is None:
            name = self.dxf.text(given).strip()
            key, entry, why = name.lower(), self.dxf.layers.get(name.lower()), ""
            if entry is not None:
                name = self.dxf.name(entry, 2)
                why = IS_FROZEN if entry.whole(70) & FROZEN else IS_OFF if entry.whole(62, 7) < 0 else ""
            state = self._layers[given] = self._spelling.setdefault(key, (name, why))
        if state[0] == "0" and inserted_on is not None:
            return self._spelling.get(inserted_on.lower(), (inserted_on, ""))
        return state

    def _line(self, entity: DxfEntity, layer: str) -> None:
        """Take a straight line that no block places: the most frequent entity, in half the time of `_lines`."""
        (x, y, z), (u, v, w) = entity.point(10), entity.point(11)
        start, end = complex(x, y), complex(u, v)
        if start == end or not isfinite(start + end):
            return self._lines(entity, None, layer)
        self._corners += 2
        handle = self.dxf.name(entity, 5)
        self.chains.append(DrawnLine(
            np.array([start, end]), NO_BULGES, False, layer, "LINE", handle, heights=(min(z, w), max(z, w))
        ))  # fmt: skip
        return None

    def _lines(self, entity: DxfEntity, placing: Placing | None, layer: str) -> None:
        if id(entity) not in self._shapes:
            self._shapes[id(entity)] = shapes_of(entity)
        shapes = self._shapes[id(entity)]
        if shapes is None:
            self.left_out[entity.kind, layer, WHY.get(entity.kind, UNREAD)] += 1
            return
        self._hatches += entity.kind == "HATCH"
        shape, is_fill = f"HATCH {self._hatches}" * (entity.kind == "HATCH"), entity.kind in FILLED
        handle = self.dxf.name(entity, 5)
        placed = [each.placed(placing) for each in shapes]
        self._corners += sum(len(each.points) for each in placed)
        if self._corners > MAX_CORNERS:
            what = f"the drawing has more than {MAX_CORNERS} corners"
            raise self._refusal("too_large", what, "save what is needed as a drawing of its own")
        for each in placed:
            if not isfinite((each.points + each.bulges).sum()) or np.abs(each.bulges).max() > MAX_BULGE:
                raise ValueError
            drawn = each.tidied()
            if drawn is None:
                self.left_out[entity.kind, layer, NO_LENGTH] += 1
                continue
            heights = each.heights.tolist()
            self.chains.append(DrawnLine(
                drawn.points, drawn.bulges, drawn.closed, layer, entity.kind, handle, shape, is_fill,
                drawn.is_straightened, (min(heights), max(heights)),
            ))  # fmt: skip
        if not placed:
            self.left_out[entity.kind, layer, NO_LENGTH] += 1

    def _label(self, entity: DxfEntity, placing: Placing | None, layer: str) -> None:
        plane, code = plane_of(entity), 10
        if entity.kind == "MTEXT":
            library()
            from ezdxf.tools.text import plain_mtext

            plane = None
            pieces = [value for each, value in entity.groups if each == 3]
            text = str(plain_mtext("".join(map(self.dxf.text, [*pieces, entity.first.get(1, "")]))))
        else:
            text = SCREEN_CODE.sub(_sign, self.dxf.text(entity.first.get(1, "")))
            across, up = entity.whole(72), entity.whole(74 if entity.kind == "ATTRIB" else 73)
            if (up or across in (1, 2, 4)) and 11 in entity.first:
                code = 11
        if not text.strip():
            self.left_out[entity.kind, layer, "empty"] += 1
            return
        at = self._carried(entity.point(code), plane, placing)
        self.labels.append(DrawnText(text.strip(), at, layer, entity.kind, self.dxf.name(entity, 5)))

    def _carried(self, point: tuple[float, float, float], plane: Placing | None, placing: Placing | None) -> complex:
        """Return where a point of a plane is drawn."""
        total = plane if placing is None else placing.after(plane)
        z = np.array([complex(*point[:2])])
        if total is not None:
            z, _ = total.carry(z, np.array(point[2:]))
        if not isfinite(z[0]):
            raise ValueError
        return complex(z[0])

    def _insert(self, entity: DxfEntity, outer: Placing | None, layer: str, is_outermost: bool) -> None:
        self.take(entity.parts, outer, layer)
        name = self.dxf.name(entity, 2)
        block = self.dxf.blocks.get(name.lower())
        if block is None or not (block.parts or block.whole(70) & XREF):
            why = f"its block {name} is {'empty' if block else 'not in the file'}"
            self.left_out["INSERT", layer, why] += 1
            return
        if block.whole(70) & XREF:
            path = self.dxf.name(block, 1) or name
            raise self._refusal("xref", f"the drawing refers to another file, {path}", "bind it in the CAD program")
        if is_outermost:
            self._entities += self._size(entity)[0]
            if self._entities > MAX_ENTITIES:
                what = f"the inserts of the drawing make more than {MAX_ENTITIES} entities, such as lines"
                raise self._refusal("too_large", what, "save what is needed as a drawing of its own")
        matrix, places = _inserted(entity, block)
        for origin in places:
            placing = Placing(matrix, origin)
            self.take(block.parts, placing if outer is None else outer.after(placing), layer)

    def _size(self, insert: DxfEntity, above: tuple[str, ...] = ()) -> tuple[int, int]:
        """Return how many entities an insert makes, and how many blocks deep."""
        name = self.dxf.name(insert, 2).lower()
        if name in above:
            raise self._refusal("not_dxf", f"the block {self.dxf.name(insert, 2)} contains itself")
        if name not in self._sizes and len(above) <= MAX_DEPTH:
            parts = self.dxf.blocks[name].parts if name in self.dxf.blocks else []
            inner = [self._size(each, (*above, name)) for each in parts if each.kind == "INSERT"]
            direct = sum(1 + len(each.groups) // GROUPS_PER_ENTITY for each in parts)
            deep = 1 + max((each for _, each in inner), default=0)
            self._sizes[name] = 1 + direct + sum(size for size, _ in inner), deep
        size, deep = self._sizes.get(name, (0, len(above)))
        if deep > MAX_DEPTH:
            raise self._refusal("too_large", f"blocks are nested more than {MAX_DEPTH} deep", "explode them")
        return size * _count(insert, 70) * _count(insert, 71), deep


def _count(insert: DxfEntity, code: int) -> int:
    """Return the number of columns or rows of an insert."""
    return max(1, insert.whole(code, 1))


def _inserted(insert: DxfEntity, block: DxfEntity) -> tuple[Reals, Iterator[Reals]]:
    """Return the matrix with which an insert places its block, and the origins for its columns and rows."""
    turn = radians(insert.number(50))
    turned = np.array([[cos(turn), -sin(turn), 0], [sin(turn), cos(turn), 0], [0, 0, 1]])
    plane = plane_of(insert)
    axes = turned if plane is None else plane.matrix @ turned
    matrix = axes * [insert.number(code, 1.0) or 1.0 for code in (41, 42, 43)]
    at = np.array(insert.point(10)) if plane is None else plane.matrix @ insert.point(10)
    start = at - matrix @ block.point(10)
    steps = product(range(_count(insert, 71)), range(_count(insert, 70)))
    return matrix, (start + axes @ [k * insert.number(44), j * insert.number(45), 0] for j, k in steps)


def _sign(code: re.Match[str]) -> str:
    """Return the character that a code in a text stands for; nothing for underlines."""
    return chr(int(code[1])) if code[1].isdigit() else SIGNS.get(code[1].lower(), "")
