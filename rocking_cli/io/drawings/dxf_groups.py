"""The entities of a DXF file, ASCII or binary, as its pairs of group code and value.

The groups are read here and not by ezdxf, which takes 2 s and 100 MB for 20 000 lines, mends damaged files without a
word, and makes what it cannot understand an empty drawing.
"""

from __future__ import annotations

import codecs
import io
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.drawings.contract import DrawingError

BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"
DWG = b"AC10"
START = re.compile(rb"(?:\xef\xbb\xbf)?\s*(?:999[ \t]*\r?\n[^\n]*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION\s")
MAX_BYTES = 64_000_000
MAX_ENTITIES = 100_000  # lines, polylines and so on, also those that blocks make
GROUPS_PER_ENTITY = 16  # one with more groups, such as a polyline with many corners, counts as several entities
LATEST_WITH_CODE_PAGE = "AC1018"
UNICODE = re.compile(r"\\U\+([0-9A-Fa-f]{4})")
Groups = list[tuple[int, Any]]


@dataclass
class DxfEntity:
    """An entity of a DXF file: a line, a layer, a block.

    Parameters
    ----------
    kind : str
        What it is, such as LWPOLYLINE.
    groups : list of (int, value)
        Its group codes and values: numbers, or texts that still stand for numbers; see `DxfFile.text`.
    parts : list of DxfEntity
        The vertices of a polyline, the attributes of an insert, the entities of a block.
    """

    kind: str
    groups: Groups
    parts: list[DxfEntity] = field(default_factory=list)

    @cached_property
    def first(self) -> dict[int, Any]:
        """The first value of each group code."""
        return dict(reversed(self.groups))

    def number(self, code: int, default: float = 0.0) -> float:
        """Return the first number of a group code."""
        return float(self.first.get(code, default))

    def whole(self, code: int, default: int = 0) -> int:
        """Return the first whole number of a group code."""
        return int(self.first.get(code, default))

    def point(self, code: int) -> tuple[float, float, float]:
        """Return the point whose x has a group code."""
        return self.number(code), self.number(code + 10), self.number(code + 20)

    def numbers(self, code: int) -> list[float]:
        """Return all numbers of a group code."""
        return [float(value) for each, value in self.groups if each == code]


@dataclass
class DxfFile:
    """What a DXF file holds.

    Parameters
    ----------
    header : dict
        First value of each variable.
    layers, blocks : dict
        The layers and blocks, by their names in small letters.
    entities : list of DxfEntity
        Its drawing: model space, and paper space where group 67 is 1.
    encoding : str
        Encoding of its texts.
    """

    header: dict[str, Any] = field(default_factory=dict)
    layers: dict[str, DxfEntity] = field(default_factory=dict)
    blocks: dict[str, DxfEntity] = field(default_factory=dict)
    entities: list[DxfEntity] = field(default_factory=list)
    encoding: str = "cp1252"

    def text(self, value: Any) -> str:
        """Return the value of a group as text."""
        plain = value.decode(self.encoding, "replace") if isinstance(value, bytes) else str(value)
        return UNICODE.sub(lambda match: chr(int(match[1], 16)), plain.strip("\r\n"))

    def name(self, entity: DxfEntity, code: int) -> str:
        """Return a name that an entity gives."""
        return self.text(entity.first.get(code, "")).strip()

    def begin(self, header: DxfEntity) -> None:
        """Take the variables of the drawing, and the encoding of its texts from them."""
        variable = ""
        for code, value in header.groups:
            if code == 9:
                variable = self.text(value).strip()
            else:
                self.header.setdefault(variable, value)
        page = self.text(self.header.get("$DWGCODEPAGE", "")).strip()
        self.encoding = "utf-8"
        if self.text(self.header.get("$ACADVER", "")).strip() <= LATEST_WITH_CODE_PAGE:
            self.encoding = f"cp{re.sub('[^0-9]', '', page)}"
            try:
                codecs.lookup(self.encoding)
            except LookupError:
                self.encoding = "cp1252"


def library() -> Any:
    """Return the package ezdxf. Raises `InputError` if it is not installed."""
    try:
        import ezdxf
    except ImportError:
        hint = "pip install 'rocking-cli[drawing]'"
        raise InputError(Problem("a DXF file needs the package ezdxf", hint=hint)) from None
    return ezdxf


def is_dxf(data: bytes) -> bool:
    """Return whether a file begins as a DXF file, ASCII or binary."""
    return data.startswith(BINARY) or START.match(data[:4096]) is not None


def read_groups(data: bytes, file: str) -> DxfFile:
    """Read the entities of a DXF file.

    Raises
    ------
    DrawingError
        If the file is a DWG, is not a DXF file, is damaged or cut short, or holds too much.
    InputError
        If it is binary and ezdxf is not installed.
    """

    def refusal(message: str, hint: str | None = None, refused: str = "not_dxf") -> DrawingError:
        return DrawingError(refused, message, file, hint=hint)

    if data.startswith(DWG):
        raise refusal("this is a DWG file", "save it as DXF")
    if not data.strip():
        raise refusal("the file is empty")
    if not is_dxf(data):
        raise refusal("this is not a DXF file: it does not begin with a section")
    smaller = "save what is needed as a drawing of its own"
    if len(data) > MAX_BYTES:
        raise refusal(f"the drawing is larger than {MAX_BYTES / 1e6:g} MB", smaller, "too_large")

    dxf, size, block, parent = DxfFile(), 0, None, None
    try:
        for section, entity in _entities(_binary(data) if data.startswith(BINARY) else _lines(data)):
            if section == "HEADER":
                dxf.begin(entity)
            elif section == "TABLES" and entity.kind == "LAYER":
                dxf.layers.setdefault(dxf.name(entity, 2).lower(), entity)
            elif section not in ("BLOCKS", "ENTITIES") or entity.kind == "SECTION":
                continue
            elif entity.kind == "BLOCK":
                block = entity
                dxf.blocks.setdefault(dxf.name(entity, 2).lower(), entity)
            elif entity.kind in ("ENDBLK", "ENDSEC", "SEQEND"):
                parent = None
            elif parent is not None and entity.kind in ("VERTEX", "ATTRIB"):
                parent.parts.append(entity)
            else:
                (dxf.entities if section == "ENTITIES" or block is None else block.parts).append(entity)
                parent = entity if entity.kind in ("POLYLINE", "INSERT") else None
            size += 1 + len(entity.groups) // GROUPS_PER_ENTITY
            if size > MAX_ENTITIES:
                raise refusal(f"the drawing has more than {MAX_ENTITIES} entities, such as lines", smaller, "too_large")
    except EOFError:
        raise refusal("the file is cut short: it does not end with EOF", "save it again") from None
    except ValueError as error:
        raise refusal(f"the file is damaged: {error}", "open it in a CAD program, and save it again") from None
    return dxf


def _lines(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the groups of an ASCII file."""
    lines = iter(io.BytesIO(data.removeprefix(codecs.BOM_UTF8)))
    for n, (code, value) in enumerate(zip(lines, lines, strict=False)):
        try:
            yield int(code), value
        except ValueError:
            raise ValueError(f"its line {2 * n + 1} is not a group code") from None


def _binary(data: bytes) -> Iterator[tuple[int, Any]]:
    """Yield the groups of a binary file."""
    library()
    from struct import error

    from ezdxf.lldxf.tagger import binary_tags_loader

    try:
        for tag in binary_tags_loader(data):
            yield tag.code, tag.value
    except (error, IndexError, ValueError):
        raise EOFError from None


def _entities(groups: Iterable[tuple[int, Any]]) -> Iterator[tuple[str, DxfEntity]]:
    """Yield the entities of a file, each with the name of its section."""
    kind, section, held = "", "", []  # type: str, str, Groups
    for code, value in groups:
        if code:
            held.append((code, value))
            continue
        if kind == "SECTION":
            section = _word(next((name for each, name in held if each == 2), b""))
        if kind:
            yield section, DxfEntity(kind, held)
        kind, held = _word(value), []
        if kind == "EOF":
            return
    raise EOFError


def _word(value: Any) -> str:
    """Return a word of the format, in capitals."""
    text = value.decode("ascii", "replace") if isinstance(value, bytes) else str(value)
    return text.strip().upper()
