"""GeoJSON drawings: polygons, lines and points in metres or another unit of length.

The property `layer` (or `Layer`) of a feature is its layer, and `name` is a text within its shape. GeoJSON files are
meant for degrees, in which nothing can be measured. A file is refused if its `crs` says WGS 84, or if all numbers are
longitudes and latitudes and what is drawn is both smaller than 0.05 and farther than 100 times its size from the
origin: 0.05 degrees are five kilometres. A wall of 2 m x 3 m at (40, 12) passes, and so does one of 50 mm at (2, 3).
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.io.drawings import contract
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnPoint, DrawnText, LineDrawing, OmittedKind
from rocking_cli.text import cut

TITLE = "GeoJSON"
ENDINGS = (".geojson", ".json")

MAX_BYTES = 20_000_000
MAX_DEPTH = 50  # of collections within collections

_LARGEST_IN_DEGREES = 0.05
_DISTANCE_IN_DEGREES = 100  # sizes of what is drawn
_DEGREES = re.compile(r"(?i)crs84|epsg:+(?:[\d.]*:)?4326\b|wgs ?84'")
_LISTS = {"Point": 0, "MultiPoint": 1, "LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
"""Lists within lists that hold the positions of each shape."""
_COLLECTIONS = {"FeatureCollection": "features", "GeometryCollection": "geometries"}


def sniff(data: bytes, ending: str) -> bool:
    """Return whether a file is GeoJSON: by its ending, or as JSON with the type of a feature or shape."""
    start = data[:4096].replace(b"\0", b"")
    types = rb'"type"\s*:\s*"(?:Feature|FeatureCollection|GeometryCollection|(?:Multi)?(?:Point|LineString|Polygon))"'
    return ending == ".geojson" or (ending == ".json" and re.search(types, start) is not None)


def read(data: bytes, file: str) -> LineDrawing:
    """Return the drawing in a file. Raises `DrawingError`."""
    import shapely
    from shapely.geometry import shape

    contract.check_content(data, MAX_BYTES, file)
    whole, sides = _parsed(data, file), 0
    chains, labels, spots = list[DrawnLine](), list[DrawnText](), list[DrawnPoint]()
    left = Counter[tuple[str, str, str]]()
    for kind, value, feature in _shapes(whole, {}, file):
        layer, handle = _property(feature, "layer", "Layer"), _text(feature.get("id"))
        if value is None:
            left[kind, layer, "it has no shape"] += 1
            continue
        geometry = {"type": kind, "coordinates": _positions(kind, value, _LISTS[kind], file)}
        try:
            parts = [shape(geometry)] if "Point" in kind else shapely.get_parts(shape(geometry)).tolist()
        except (shapely.GEOSException, ValueError):  # of a line with one corner, or a ring with two
            parts = []
        parts = [part for part in parts if not part.is_empty]
        if not parts:
            left[kind, layer, "it is empty, or a point"] += 1
        for part in parts:
            rings = shapely.get_rings(part) if "Polygon" in kind else [part]
            corners = [shapely.get_coordinates(ring, include_z=True) for ring in rings]
            outlines: list[Points] = [each[:, :2] @ np.array([1, 1j]) for each in corners]
            first, of = outlines[0], f"{kind} {len(chains) + 1}" if len(rings) > 1 else ""
            is_closed = bool("Polygon" in kind or ("Line" in kind and len(first) > 3 and first[0] == first[-1]))
            if "Point" in kind:
                spots += [DrawnPoint(complex(each), layer, kind, handle) for each in first]
            else:
                for points, (*_, z) in zip(outlines, (each.T for each in corners), strict=True):
                    points, levels = points[: len(points) - is_closed], (float(z.min()), float(z.max()))
                    straight = np.zeros(len(points))
                    chains.append(DrawnLine(points, straight, is_closed, layer, kind, handle, of, heights=levels))
            if name := _property(feature, "name"):
                at = contract.inside(outlines) if is_closed else complex(first[: 2 - ("Point" in kind)].mean())
                labels.append(DrawnText(name, at, layer, "name", handle))
            sides += sum(map(len, outlines))
            contract.check_count(sides, contract.MAX_SIDES, "sides", file)
            contract.check_count(len(chains), contract.MAX_ELEMENTS, "lines", file)
    _check_degrees(np.concatenate([*(each.points for each in chains), [each.at for each in spots]]), whole, file)
    omitted = [OmittedKind(kind, layer, why, count) for (kind, layer, why), count in left.items()]
    return LineDrawing(TITLE, chains, labels, spots, omitted)


def _parsed(data: bytes, file: str) -> Any:
    """Return the content of a file."""

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        if len(members := dict(pairs)) < len(pairs):
            key = Counter(key for key, _ in pairs).most_common(1)[0][0]
            raise _fault(f"an object has the key `{cut(key)}` twice", file)
        return members

    def refuse(word: str) -> float:
        raise _fault(f"{word} is not a number that a drawing may have", file)

    try:
        text = data.decode(json.detect_encoding(data))
        return json.loads(text, object_pairs_hook=once, parse_constant=refuse, parse_int=float)
    except UnicodeDecodeError as error:
        raise _fault("not UTF-8 text", file, data[: error.start].count(b"\n") + 1) from None
    except json.JSONDecodeError as error:
        what = f"not valid JSON: {error.msg}" if text[error.pos :].strip() else "the file is cut short"
        raise _fault(what, file, error.lineno) from None
    except RecursionError:
        raise _fault("the values are nested too deep", file) from None


def _shapes(item: Any, feature: Mapping[str, Any], file: str, depth: int = 0) -> Iterator[tuple[str, Any, Any]]:
    """Yield the type, the coordinates and the feature of each shape; coordinates are None in a feature without one."""
    kind = str(item.get("type")) if isinstance(item, dict) else ""
    if depth > MAX_DEPTH:
        raise _fault("collections are nested too deep", file)
    if kind == "Feature" and item.get("geometry") is None:
        yield kind, None, item
    elif kind == "Feature":
        yield from _shapes(item["geometry"], item, file, depth + 1)
    elif kind in _LISTS or kind in _COLLECTIONS:
        key = _COLLECTIONS.get(kind, "coordinates")
        if not isinstance(value := item.get(key), list):
            raise _fault(f"`{kind}` without a list of `{key}`", file)
        if kind in _LISTS:
            yield kind, value, feature
        for each in value if kind in _COLLECTIONS else ():
            yield from _shapes(each, feature, file, depth + 1)
    else:
        what = f"the type `{cut(kind)}`" if kind else f"`{cut(str(item))}`"
        raise _fault(f"{what} is not a feature or a shape of GeoJSON", file)


def _positions(kind: str, value: Any, lists: int, file: str) -> list[Any]:
    """Return coordinates as positions of three numbers within some lists. Raises `DrawingError`."""
    if lists or value == []:
        if not isinstance(value, list):
            raise _fault(f"a `{kind}` has coordinates that are not nested as they must be", file)
        return [_positions(kind, each, lists - 1, file) for each in value if lists < 2 or each != []]
    if not (isinstance(value, list) and len(value) >= 2 and all(type(x) is float for x in value)):
        raise _fault(f"a `{kind}` has the position `{cut(str(value))}`: give two or three numbers", file)
    if not all(abs(x) < contract.MAX_NUMBER for x in value):
        raise DrawingError("number", f"a `{kind}` has a coordinate beyond {contract.MAX_NUMBER:g}", file)
    return [*value, 0.0][:3]


def _check_degrees(z: Points, whole: Mapping[str, Any], file: str) -> None:
    """Raise `DrawingError` if the numbers are degrees."""
    if not z.size or np.abs(z.real).max() > 180 or np.abs(z.imag).max() > 90:
        return
    size = max(np.ptp(z.real), np.ptp(z.imag))
    stated = _DEGREES.search(repr(whole.get("crs")))
    if stated or 0 < size < min(_LARGEST_IN_DEGREES, np.abs(z).max() / _DISTANCE_IN_DEGREES):
        why, hint = f"the coordinates look like degrees: {z[0].real:.6g}, {z[0].imag:.6g}", ""
        if stated:
            why, hint = "the file says in `crs` that its coordinates are degrees", "; if not, take `crs` out"
        hint = f"save it in a projection in metres, such as UTM{hint}"
        raise DrawingError("degrees", why, file, [[float(z[0].real), float(z[0].imag)]], hint)


def _fault(message: str, file: str, line: int | None = None) -> DrawingError:
    return DrawingError("not_geojson", message, file, line=line)


def _property(feature: Mapping[str, Any], *names: str) -> str:
    properties = feature.get("properties")
    values = [properties[name] for name in names if name in properties] if isinstance(properties, dict) else []
    return _text(values[0]) if values else ""


def _text(value: object) -> str:
    """Return a text or number as a text; empty for others."""
    return f"{value:.15g}" if isinstance(value, float) else value if isinstance(value, str) else ""
