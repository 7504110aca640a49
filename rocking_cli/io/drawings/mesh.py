"""Reader of meshes in OBJ, PLY and STL by trimesh, as they are: nothing is merged, turned or repaired."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.drawings.contract import DrawingError, MeshSurface

TITLE = "OBJ, PLY or STL mesh"
MESH = True
ENDINGS = (".obj", ".ply", ".stl")
MAX_BYTES = 110_000_000
MAX_TEXT_BYTES = 64_000_000  # numbers as text need more than ten times their size while they are read
MAX_TRIANGLES = 2_000_000
FEWER = f"reduce the mesh to a million triangles, and save it as binary PLY or STL; at most {MAX_TRIANGLES:,} are read"
STL_HEAD, STL_TRIANGLE = 84, 50  # bytes
_OBJ_LINE = re.compile(rb"^[ \t]*v[ \t]+[-+.\d]", re.MULTILINE)
_PLY_COUNT = re.compile(rb"^element[ \t]+(vertex|face)[ \t]+(\d+)[ \t\r]*$", re.MULTILINE)
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
    return "OBJ" if b"\0" not in head and _OBJ_LINE.search(head) else ""


def _is_ascii_stl(data: bytes) -> bool:
    head = data[:_SNIFFED].lstrip()
    return head[:5].lower() == b"solid" and b"facet" in head.lower() and b"\0" not in head


def _counted(data: bytes) -> int:
    """Return the size that a binary STL file announces [bytes]."""
    return STL_HEAD + STL_TRIANGLE * int.from_bytes(data[STL_HEAD - 4 : STL_HEAD], "little")


def read(data: bytes, file: str, /) -> MeshSurface:
    """Read a mesh. Raises `DrawingError` if it is damaged or too large, `InputError` if trimesh is not installed."""
    known = _format_of(data, file[file.rfind(".") :].lower()) if data else ""
    if not known:
        raise DrawingError("not_mesh", "is not a mesh in OBJ, PLY or STL" if data else "is empty", file)
    head = data[:_SNIFFED] if known == "PLY" else b""
    counts = {name.decode(): int(count) for name, count in _PLY_COUNT.findall(head)}
    if known == "STL" and not _is_ascii_stl(data):
        counts["face"] = (_counted(data) - STL_HEAD) // STL_TRIANGLE
        if len(data) < _counted(data):
            raise _cut(file, counts, 0, max(len(data) - STL_HEAD, 0) // STL_TRIANGLE)
    as_text = known == "OBJ" or (known == "STL" and not counts) or b"\nformat ascii" in head
    if len(data) > (MAX_TEXT_BYTES if as_text else MAX_BYTES):
        raise DrawingError("too_large", f"has {len(data) / 1e6:.0f} MB", file, hint=FEWER)
    if counts.get("face", 0) > MAX_TRIANGLES:
        raise DrawingError("too_large", f"announces {counts['face']:,} triangles", file, hint=FEWER)
    if known == "STL" and as_text and b"endsolid" not in data[-_SNIFFED:].lower():
        raise DrawingError("cut", "is cut short: its last line does not end the solid", file, hint="save it again")
    try:
        points, triangles = _joined(_loaded(data, known, as_text))
    except ImportError:
        hint = "pip install 'rocking-cli[mesh]'"
        raise InputError(Problem("is a mesh, which needs another package", file, hint=hint)) from None
    except Exception as error:  # trimesh raises what numpy does
        advice = "if its faces differ in their number of corners, save it with triangles alone"
        what = f"cannot be read as {known}: it is damaged or cut short ({error})"
        raise DrawingError("damaged", what, file, hint=advice if known == "PLY" else None) from None
    if len(points) < counts.get("vertex", 0) or len(triangles) < counts.get("face", 0):
        raise _cut(file, counts, len(points), len(triangles))
    if len(triangles) > MAX_TRIANGLES:
        raise DrawingError("too_large", f"has {len(triangles):,} triangles", file, hint=FEWER)
    if not len(points):
        raise DrawingError("empty", "has no points", file)
    if not np.isfinite(points).all():
        raise DrawingError("damaged", "has coordinates that are not numbers", file)
    return MeshSurface(known, points, triangles)


def _cut(file: str, counts: Mapping[str, int], points: int, faces: int) -> DrawingError:
    has = {"vertex": f"{points:,} points", "face": f"{faces:,} faces"}
    announced = " and ".join(f"{count:,}" for count in counts.values())
    what = f"is cut short: it announces {announced}, and has {' and '.join(has[key] for key in counts)}"
    return DrawingError("cut", what, file, hint="save it again")


def _loaded(data: bytes, known: str, as_text: bool) -> list[Mapping[str, Any]]:
    """Return the parts of a file, each with its vertices, and its faces if it has any."""
    from trimesh.exchange import obj, ply, stl

    loaded: Mapping[str, Any]
    if known == "OBJ":
        loaded = obj.load_obj(io.StringIO(data.decode("utf-8", "replace")), skip_materials=True)
    elif known == "PLY":
        loaded = ply.load_ply(io.BytesIO(data))
    elif as_text:
        loaded = stl.load_stl_ascii(io.BytesIO(data))
    else:
        loaded = stl.load_stl_binary(io.BytesIO(data[: _counted(data)]))
    return list(loaded["geometry"].values()) if "geometry" in loaded else [loaded]


def _joined(parts: list[Mapping[str, Any]]) -> tuple[Any, Any]:
    """Return the points and triangles of all parts of a file; faces of more corners are cut into triangles."""
    points, triangles, before = [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)], 0
    for part in parts:
        z = np.asarray(part["vertices"], np.float64).reshape(-1, 3)
        faces = np.asarray(part.get("faces", triangles[0]), np.int64)
        if faces.size:
            if faces.min() < 0 or faces.max() >= len(z):
                raise ValueError(f"a face names a point that does not exist, of {len(z)}")
            triangles += [faces[:, [0, k, k + 1]] + before for k in range(1, faces.shape[1] - 1)]
        points.append(z)
        before += len(z)
    return np.concatenate(points), np.concatenate(triangles)
