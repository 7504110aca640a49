"""Reader of meshes in OBJ, PLY and STL by trimesh, as they are: nothing is merged, turned or repaired."""

from __future__ import annotations

import io
import re
import warnings
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Integers
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.drawings.contract import MAX_NUMBER, DrawingError, MeshSurface

TITLE = "OBJ, PLY or STL mesh"
MESH = True
ENDINGS = (".obj", ".ply", ".stl")
MAX_BYTES = 110_000_000
MAX_TEXT_BYTES = 64_000_000  # numbers as text need more than ten times their size while they are read
MAX_COUNT = 2_000_000
FEWER = f"reduce the mesh to a million triangles, and save it as binary PLY or STL; at most {MAX_COUNT:,} are read"
STL_HEAD, STL_TRIANGLE = 84, 50  # bytes
_OBJ_ROW = re.compile(rb"^[ \t]*([vf])[ \t]+(.*)", re.MULTILINE)
_OBJ_ASIDE = re.compile(rb"\\\r?\n|/\S*|#.*")  # ends of lines that go on, seams of texture and normals, comments
_INTEGERS = re.compile(rb"[-+]?\d{1,18}([ \t]+[-+]?\d{1,18})*[ \t\r]*")
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
    return STL_HEAD + STL_TRIANGLE * int.from_bytes(data[STL_HEAD - 4 : STL_HEAD], "little")


def read(data: bytes, file: str, /) -> MeshSurface:
    """Read a mesh; its points are in single precision if the file has them so.

    Raises `DrawingError` if it is damaged or too large, `InputError` if a package is missing.
    """
    known = _format_of(data, file[file.rfind(".") :].lower())
    as_text = known == "OBJ" or _is_ascii_stl(data) or b"\nformat ascii" in data[:_SNIFFED]
    if len(data) > (MAX_TEXT_BYTES if as_text else MAX_BYTES):
        raise DrawingError("too_large", f"has {len(data) / 1e6:.0f} MB", file, hint=FEWER)
    if not (find_spec("trimesh") and find_spec("shapely")):
        raise InputError(Problem("is a mesh, which needs more packages", file, hint="pip install 'rocking-cli[mesh]'"))
    if known == "STL" and as_text and not re.search(rb"\n\s*endsolid[^\n]*\s*\Z", data, re.IGNORECASE):
        raise DrawingError("cut", "is cut short: its last line does not end the solid", file, hint="save it again")
    if known == "STL" and not as_text:
        count, held = ((each - STL_HEAD) // STL_TRIANGLE for each in (_counted(data), max(len(data), STL_HEAD)))
        _check_size(len(data) - _counted(data), f"{count:,} faces", f"{held:,}", file)
    if known == "PLY" and as_text:
        head, _, body = data.partition(b"end_header")
        counts = {name: int(count) for name, count in _PLY_COUNT.findall(head)}
        count, faces = (counts.get(each, 0) for each in (b"vertex", b"face"))
        rows = len(body.strip().splitlines())
        has = f"{min(rows, count):,} and {max(rows - count, 0):,}"
        _check_size(rows - sum(counts.values()), f"{count:,} points and {faces:,} faces", has, file)
    points, triangles = _surface(known, data, file)
    for of, count in (("triangles", len(triangles)), ("points", len(points) if known != "STL" else 0)):
        if count > MAX_COUNT:
            raise DrawingError("too_large", f"has {count:,} {of}", file, hint=FEWER)
    if not len(points):
        raise DrawingError("empty", "has no triangles" if known == "STL" else "has no points", file)
    if not np.isfinite(points).all():
        raise DrawingError("damaged", "has coordinates that are not numbers", file)
    if (most := float(np.abs(points).max())) > MAX_NUMBER:
        raise DrawingError("number", f"has a coordinate of {most:.3g}, beyond {MAX_NUMBER:g}", file)
    return MeshSurface(known, points, triangles)


def _check_size(more: int, announced: str, held: str, file: str) -> None:
    """Raise `DrawingError` if a file has more or less data than it announces."""
    if more < 0:
        raise DrawingError("cut", f"is cut short: it announces {announced}, and has {held}", file, hint="save it again")
    if more > 0:
        what = f"has more data than the {announced} that it announces"
        raise DrawingError("damaged", what, file, hint="save it again")


def _damaged(known: str, why: object, file: str) -> DrawingError:
    advice = "if its faces differ in their number of corners, save it with triangles alone"
    what = f"cannot be read as {known}: it is damaged or cut short ({why})"
    return DrawingError("damaged", what, file, hint=advice if known == "PLY" else None)


def _surface(known: str, data: bytes, file: str) -> tuple[NDArray[Any], Integers]:
    """Return the points of a mesh, and its faces cut into triangles. Raises `DrawingError` "damaged"."""
    from trimesh.exchange import obj, ply, stl

    load: Any = {"OBJ": partial(obj.load_obj, maintain_order=True), "PLY": ply.load_ply, "STL": stl.load_stl}[known]
    stream = io.BytesIO(_plain(data, file) if known == "OBJ" else data)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # older versions of numpy warn of what is no number
        try:
            loaded = load(stream)
        except Exception as error:  # trimesh raises what numpy does
            raise _damaged(known, error, file) from None
    points, triangles = np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int64)
    for each in loaded.get("geometry", {"": loaded}).values():  # the solids of a file
        faces = np.asarray(triangles[:0] if each.get("faces") is None else each["faces"], np.int64) + len(points)
        if each["vertices"].shape[1:] != (3,):
            raise _damaged(known, "a point has no three coordinates", file)
        fans = [faces[:, [0, k, k + 1]] for k in range(1, faces.shape[1] - 1)]
        points, triangles = np.concatenate([points, each["vertices"]]), np.concatenate([triangles, *fans])
    if triangles.size and not 0 <= triangles.min() <= triangles.max() < len(points):
        raise _damaged(known, f"a face names a point that does not exist, of {len(points):,}", file)
    return points, triangles


def _plain(data: bytes, file: str) -> bytes:
    """Return an OBJ file with points and faces alone, whose corners are all numbered from 1, the first point.

    In OBJ a corner -1 is the last point above its face. trimesh takes it for the last point of the file, and does not
    notice corners that name no point.
    """
    rows, point_count = list[bytes](), 0
    for kind, row in _OBJ_ROW.findall(_OBJ_ASIDE.sub(b" ", data)):
        point_count += kind == b"v"
        if kind == b"f":
            if not _INTEGERS.fullmatch(row):
                raise _damaged("OBJ", "a face has corners that are not whole numbers", file)
            corners = [k + (point_count + 1) * (k < 0) for k in map(int, row.split())]
            if len(corners) < 3 or min(corners) < 1:
                raise _damaged("OBJ", "a face has fewer than three corners, or a point that does not exist", file)
            row = b" ".join(b"%d" % k for k in corners)
        rows.append(kind + b" " + row)
    return b"\n".join(rows)
