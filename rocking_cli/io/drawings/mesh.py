"""Reader of meshes in OBJ, PLY and STL, as they are: nothing is merged, turned or repaired. trimesh reads PLY."""

from __future__ import annotations

import io
import re
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Integers
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.drawings.contract import DrawingError, MeshSurface
from rocking_cli.io.drawings.limits import MAX_NUMBER

TITLE = "OBJ, PLY or STL mesh"
MESH = True
ENDINGS = (".obj", ".ply", ".stl")
MAX_BYTES = 110_000_000
MAX_TEXT_BYTES = 64_000_000  # numbers as text need more than ten times their size while they are read
MAX_COUNT = 2_000_000
FEWER = f"reduce the mesh to a million triangles, and save it as binary PLY or STL; at most {MAX_COUNT:,} are read"
STL_HEAD = 84  # bytes
STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
_OBJ_POINT = re.compile(rb"^[ \t]*v[ \t]+([^#\n]*)", re.MULTILINE)
_OBJ_FACE = re.compile(rb"^[ \t]*f[ \t]+([^#\n]*)", re.MULTILINE)
_STL_POINT = re.compile(rb"^[ \t]*vertex[ \t]+(.*)", re.MULTILINE | re.IGNORECASE)
_PLY_COUNT = re.compile(rb"^element[ \t]+(\w+)[ \t]+(\d+)[ \t\r]*$", re.MULTILINE)
_SNIFFED = 4096  # bytes


def sniff(data: bytes, ending: str, /) -> bool:
    """Return whether a file is a mesh, by its content, or by its ending where the content may be anything."""
    return bool(_format_of(data, ending))


def _format_of(data: bytes, ending: str) -> str:
    head = data[:_SNIFFED]
    if re.match(rb"ply[ \t]*\r?\n", head):
        return "PLY"
    if _is_ascii_stl(data) or _counted(data) == len(data):
        return "STL"
    if ending in ENDINGS:
        return ending[1:].upper()
    return "OBJ" if b"\0" not in head and re.search(rb"^[ \t]*v[ \t]+[-+.\d]", head, re.MULTILINE) else ""


def _is_ascii_stl(data: bytes) -> bool:
    return bool(re.match(rb"\s*solid\b[^\0]*(facet|endsolid)", data[:_SNIFFED], re.IGNORECASE))


def _counted(data: bytes) -> int:
    """Return the size that a binary STL file announces [bytes]."""
    return STL_HEAD + STL_TRIANGLE.itemsize * int.from_bytes(data[STL_HEAD - 4 : STL_HEAD], "little")


def read(data: bytes, file: str, /) -> MeshSurface:
    """Read a mesh; its points are in single precision if the file has them so.

    Raises `DrawingError` if it is damaged or too large, `InputError` if it is PLY and trimesh is not installed.
    """
    known = _format_of(data, file[file.rfind(".") :].lower())
    as_text = known == "OBJ" or _is_ascii_stl(data) or b"\nformat ascii" in data[:_SNIFFED]
    if len(data) > (MAX_TEXT_BYTES if as_text else MAX_BYTES):
        raise DrawingError("too_large", f"has {len(data) / 1e6:.0f} MB", file, hint=FEWER)
    try:
        if known == "OBJ":
            points, triangles = _obj(data, file)
        elif known == "PLY":
            points, triangles = _ply(data, as_text, file)
        else:
            points, triangles = _stl(data, as_text, file)
    except InputError:
        raise
    except ImportError:
        hint = "pip install 'rocking-cli[mesh]'"
        raise InputError(Problem("is a mesh, which needs another package", file, hint=hint)) from None
    except Exception as error:  # trimesh raises what numpy does
        advice = "if its faces differ in their number of corners, save it with triangles alone"
        what = f"cannot be read as {known}: it is damaged or cut short ({error})"
        raise DrawingError("damaged", what, file, hint=advice if known == "PLY" else None) from None
    if not len(points):
        raise DrawingError("empty", "has no triangles" if known == "STL" else "has no points", file)
    if not np.isfinite(points).all():
        raise DrawingError("damaged", "has coordinates that are not numbers", file)
    if (most := float(np.abs(points).max())) > MAX_NUMBER:
        raise DrawingError("number", f"has a coordinate of {most:.3g}, beyond {MAX_NUMBER:g}", file)
    return MeshSurface(known, points, triangles)


def _bounded(count: int, of: str, file: str) -> None:
    if count > MAX_COUNT:
        raise DrawingError("too_large", f"has {count:,} {of}", file, hint=FEWER)


def _cut(file: str, announced: str, held: str) -> DrawingError:
    return DrawingError("cut", f"is cut short: it announces {announced}, and has {held}", file, hint="save it again")


def _more(file: str, announced: str) -> DrawingError:
    return DrawingError("damaged", f"has more data than the {announced} that it announces", file, hint="save it again")


def _obj(data: bytes, file: str) -> tuple[NDArray[Any], Integers]:
    data = data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")  # lines that go on
    rows = _OBJ_POINT.findall(data)
    _bounded(len(rows), "points", file)
    numbers, counts = _numbers(b"\n".join(rows), np.float64)
    points = numbers[(np.cumsum(counts) - counts)[:, None] + np.arange(3)]
    rows = _OBJ_FACE.findall(data)
    _bounded(len(rows), "faces", file)
    corners, counts = _numbers(re.sub(rb"/\S*", b"", b"\n".join(rows)), np.int64)
    if (corners < 0).any():  # these count back from the points before the face
        at, before = ([each.start() for each in kind.finditer(data)] for kind in (_OBJ_FACE, _OBJ_POINT))
        corners[corners < 0] += (np.repeat(np.searchsorted(before, at), counts) + 1)[corners < 0]
    return points, _triangles(corners - 1, counts, len(points), file)


def _stl(data: bytes, as_text: bool, file: str) -> tuple[NDArray[Any], Integers]:
    if as_text:
        if not re.match(rb"\s*endsolid", data.rstrip().rpartition(b"\n")[2], re.IGNORECASE):
            raise DrawingError("cut", "is cut short: its last line does not end the solid", file, hint="save it again")
        rows = _STL_POINT.findall(data)
        count, left = divmod(len(rows), 3)
        _bounded(count, "triangles", file)
        numbers, counts = _numbers(b"\n".join(rows), np.float64)
        if left or (counts != 3).any():
            raise ValueError("not every triangle has three corners of three coordinates")
        points: NDArray[Any] = numbers.reshape(-1, 3)
    else:
        count = (_counted(data) - STL_HEAD) // STL_TRIANGLE.itemsize
        if len(data) < _counted(data):
            held = max(len(data) - STL_HEAD, 0) // STL_TRIANGLE.itemsize
            raise _cut(file, f"{count:,} faces", f"{held:,}")
        if len(data) > _counted(data):
            raise _more(file, f"{count:,} faces")
        points = np.frombuffer(data, STL_TRIANGLE, count, STL_HEAD)["corners"].reshape(-1, 3).astype(np.float32)
        _bounded(count, "triangles", file)
    return points, np.arange(3 * count).reshape(-1, 3)


def _ply(data: bytes, as_text: bool, file: str) -> tuple[NDArray[Any], Integers]:
    head, _, body = data.partition(b"end_header")
    counts = {name.decode(): int(count) for name, count in _PLY_COUNT.findall(head)}
    count, faces_count = (counts.get(each, 0) for each in ("vertex", "face"))
    announced = f"{count:,} points and {faces_count:,} faces"
    _bounded(count, "points", file)
    _bounded(faces_count, "faces", file)
    if as_text and body.strip() and body.strip().count(b"\n") >= sum(counts.values()):
        raise _more(file, announced)
    from trimesh.exchange import ply

    loaded = ply.load_ply(io.BytesIO(data))
    points = np.asarray(loaded.get("vertices", np.zeros((0, 3))))
    faces = np.asarray(loaded.get("faces", np.zeros((0, 3))), np.int64)
    if len(points) < count or len(faces) < faces_count:
        raise _cut(file, announced, f"{len(points):,} and {len(faces):,}")
    return points, _triangles(faces.ravel(), np.full(len(faces), faces.shape[1]), len(points), file)


def _numbers(text: bytes, kind: type) -> tuple[NDArray[Any], Integers]:
    """Return the numbers of lines that have three or more each, all in a row, and how many each line has."""
    if not text:
        return np.zeros(0, kind), np.zeros(0, np.int64)
    code = np.frombuffer(b"\n" + text + b"\n", np.uint8)
    blank = code <= ord(" ")
    starts = np.flatnonzero(blank[:-1] & ~blank[1:])
    counts = np.diff(np.searchsorted(starts, np.flatnonzero(code == ord("\n"))))
    if counts.min() < 3:
        raise ValueError("a line has fewer than three numbers")
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # older versions of numpy warn of what newer ones refuse
        return np.fromstring(text, kind, sep=" "), counts


def _triangles(corners: Integers, counts: Integers, points: int, file: str) -> Integers:
    """Return the triangles of faces whose corners are all in a row; faces of more corners are cut into triangles."""
    _bounded(len(corners) - 2 * len(counts), "triangles", file)
    if corners.size and (corners.min() < 0 or corners.max() >= points):
        raise ValueError(f"a face names a point that does not exist, of {points:,}")
    face = np.repeat(np.arange(len(counts)), counts - 2)
    first, second = (np.cumsum(counts) - counts)[face], np.arange(len(face)) + 2 * face + 1
    return np.stack([corners[first], corners[second], corners[second + 1]], axis=1)
