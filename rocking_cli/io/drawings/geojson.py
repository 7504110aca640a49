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
from collections.abc import Mapping
from typing import Any

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnPoint, DrawnText, LineDrawing, OmittedKind
from rocking_cli.io.drawings.limits import MAX_ELEMENTS, MAX_NUMBER, MAX_SIDES, check_content, check_count, inside
from rocking_cli.text import cut

TITLE = "GeoJSON"
ENDINGS = (".geojson", ".json")

MAX_BYTES = 20_000_000
MAX_DEPTH = 50  # of collections within collections

_LARGEST_IN_DEGREES = 0.05
_DISTANCE_IN_DEGREES = 100  # sizes of what is drawn
_DEGREES = re.compile(r"(?i)crs84|epsg:+(?:[\d.]*:)?4326\b|wgs ?84'")
_SHAPES = {"Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon"}


def sniff(data: bytes, ending: str) -> bool:
    """Return whether a file is GeoJSON: by its ending, or as JSON with the type of a feature or shape."""
    start = data[:4096].replace(b"\0", b"")
    types = rb'"type"\s*:\s*"(?:Feature|FeatureCollection|GeometryCollection|(?:Multi)?(?:Point|LineString|Polygon))"'
    return ending == ".geojson" or (ending == ".json" and re.search(types, start) is not None)


def read(data: bytes, file: str) -> LineDrawing:
    """Return the drawing in a file. Raises `DrawingError`."""
    check_content(data, MAX_BYTES, file)
    reader = _Features(file)
    whole = reader.parsed(data)
    reader.collect(whole)
    reader.check_degrees(whole)
    left = [OmittedKind(kind, layer, why, count) for (kind, layer, why), count in reader.left.items()]
    return LineDrawing(TITLE, reader.chains, reader.labels, reader.spots, left)


class _Features:
    """Reading of one file."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.chains: list[DrawnLine] = []
        self.labels: list[DrawnText] = []
        self.spots: list[DrawnPoint] = []
        self.left: Counter[tuple[str, str, str]] = Counter()
        self.count = self.shapes = 0

    def fault(self, message: str, line: int | None = None) -> DrawingError:
        """Return the error for a file that is not GeoJSON."""
        return DrawingError("not_geojson", message, self.file, line=line)

    def parsed(self, data: bytes) -> Any:
        """Return the content of the file."""

        def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
            members = dict(pairs)
            if len(members) < len(pairs):
                key = Counter(key for key, _ in pairs).most_common(1)[0][0]
                raise self.fault(f"an object has the key `{cut(key)}` twice")
            return members

        def refuse(word: str) -> float:
            raise self.fault(f"{word} is not a number that a drawing may have")

        try:
            text = data.decode(json.detect_encoding(data))
            return json.loads(text, object_pairs_hook=once, parse_constant=refuse, parse_int=float)
        except UnicodeDecodeError as error:
            line = data[: error.start].count(b"\n") + 1
            raise self.fault("not UTF-8 text", line) from None
        except json.JSONDecodeError as error:
            ends = not text[error.pos :].strip()
            raise self.fault(
                "the file is cut short" if ends else f"not valid JSON: {error.msg}", error.lineno
            ) from None
        except RecursionError:
            raise self.fault("the values are nested too deep") from None

    def collect(self, item: Any, feature: Mapping[str, Any] | None = None, depth: int = 0) -> None:
        """Add a feature, a shape, or a collection of them."""
        kind = str(item.get("type")) if isinstance(item, dict) else ""
        if depth > MAX_DEPTH:
            raise self.fault("collections are nested too deep")
        if kind in ("FeatureCollection", "GeometryCollection"):
            for each in self._list(item, "features" if kind == "FeatureCollection" else "geometries"):
                self.collect(each, feature, depth + 1)
        elif kind == "Feature":
            if item.get("geometry") is None:
                self.left["Feature", _layer(item), "it has no shape"] += 1
            else:
                self.collect(item["geometry"], item, depth + 1)
        elif kind in _SHAPES:
            self._shape(kind, self._list(item, "coordinates"), feature or {})
        else:
            what = f"the type `{cut(kind)}`" if kind else f"`{cut(str(item))}`"
            raise self.fault(f"{what} is not a feature or a shape of GeoJSON")

    def _list(self, item: Mapping[str, Any], key: str) -> list[Any]:
        value = item.get(key)
        if not isinstance(value, list):
            raise self.fault(f"`{item['type']}` without a list of `{key}`")
        return value

    def _shape(self, kind: str, coordinates: list[Any], feature: Mapping[str, Any]) -> None:
        """Add the lines or points of each part of a shape."""
        layer = _layer(feature)
        match kind:
            case "Point":
                parts = [[[coordinates]]] if coordinates else []
            case "Polygon" | "MultiPolygon":
                parts = [coordinates] if kind == "Polygon" else coordinates
            case "MultiLineString":
                parts = [[line] for line in coordinates]
            case _:
                parts = [[coordinates]]
        parts = [part for part in parts if part not in ([], [[]])]
        if not parts:
            self.left[kind, layer, "it is empty"] += 1
        for part in parts:
            if not isinstance(part, list):
                raise self.fault(f"a `{kind}` has coordinates that are not nested as they must be")
            self._part(kind, layer, part, feature)

    def _part(self, kind: str, layer: str, part: list[Any], feature: Mapping[str, Any]) -> None:
        """Add one polygon, line, or set of points."""
        rings = [self._points(ring, kind) for ring in part]
        handle, name = _text(feature.get("id")), _text(_properties(feature).get("name"))
        outer = rings[0][0]
        is_closed = "Polygon" in kind or ("Line" in kind and len(outer) > 3 and bool(outer[0] == outer[-1]))
        if "Point" in kind:
            self.spots += (DrawnPoint(complex(each), layer, kind, handle) for each in outer)
            at = complex(outer[0])
        else:
            self.shapes += 1
            shape = f"{kind} {self.shapes}" if len(rings) > 1 else ""
            for points, heights in rings:
                z = points[:-1] if is_closed and points[0] == points[-1] else points
                if len(z) < 2:
                    self.left[kind, layer, "it is a point"] += 1
                    continue
                straight = np.zeros(len(z))
                self.chains.append(DrawnLine(z, straight, is_closed, layer, kind, handle, shape, heights=heights))
            at = inside([points for points, _ in rings]) if is_closed else complex(outer[:2].mean())
        if name:
            self.labels.append(DrawnText(name, at, layer, "name", handle))

    def _points(self, positions: Any, kind: str) -> tuple[Points, tuple[float, float]]:
        """Return the points of a list of positions, and their least and greatest z."""
        if not isinstance(positions, list) or not positions:
            raise self.fault(f"a `{kind}` has coordinates that are not nested as they must be")
        self.count += len(positions)
        check_count(len(self.chains) + 1, MAX_ELEMENTS, "lines", self.file)
        check_count(self.count, MAX_SIDES, "sides", self.file)
        for each in positions:
            if not (isinstance(each, list) and len(each) >= 2 and all(type(x) is float for x in each)):
                raise self.fault(f"a `{kind}` has the position `{cut(str(each))}`: give two or three numbers")
            if not all(abs(x) < MAX_NUMBER for x in each):
                raise DrawingError("number", f"a `{kind}` has a coordinate beyond {MAX_NUMBER:g}", self.file)
        z = [each[2] if len(each) > 2 else 0.0 for each in positions]
        return np.array([complex(each[0], each[1]) for each in positions]), (min(z), max(z))

    def check_degrees(self, whole: Mapping[str, Any]) -> None:
        """Raise `DrawingError` if the numbers are degrees."""
        points = [chain.points for chain in self.chains] + [np.array([spot.at]) for spot in self.spots]
        if not points:
            return
        z = np.concatenate(points)
        if np.abs(z.real).max() > 180 or np.abs(z.imag).max() > 90:
            return
        size = max(np.ptp(z.real), np.ptp(z.imag))
        stated = _DEGREES.search(repr(whole.get("crs")))
        looks_so = 0 < size < min(_LARGEST_IN_DEGREES, np.abs(z).max() / _DISTANCE_IN_DEGREES)
        if stated or looks_so:
            why, hint = f"the coordinates look like degrees: {z[0].real:.6g}, {z[0].imag:.6g}", ""
            if stated:
                why, hint = "the file says in `crs` that its coordinates are degrees", "; if not, take `crs` out"
            hint = f"save it in a projection in metres, such as UTM{hint}"
            raise DrawingError("degrees", why, self.file, [[float(z[0].real), float(z[0].imag)]], hint)


def _properties(feature: Mapping[str, Any]) -> Mapping[str, Any]:
    properties = feature.get("properties")
    return properties if isinstance(properties, dict) else {}


def _layer(feature: Mapping[str, Any]) -> str:
    properties = _properties(feature)
    return _text(properties.get("layer", properties.get("Layer")))


def _text(value: object) -> str:
    """Return a text or number as a text; empty for others."""
    if isinstance(value, float):
        return f"{value:.15g}"
    return value if isinstance(value, str) else ""
