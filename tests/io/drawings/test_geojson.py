"""GeoJSON drawings: rings, lines, points, names, degrees, and files that are refused."""

import json

import numpy as np
import pytest

from rocking_cli.io.drawings import geojson
from rocking_cli.io.drawings.contract import inside

RING = [[0, 0], [2, 0], [2, 3], [0, 3], [0, 0]]
HOLE = [[0.5, 1], [1, 1], [1, 2], [0.5, 1]]
WALL = {"type": "Polygon", "coordinates": [RING, HOLE]}


def drawn(item):
    return geojson.read(json.dumps(item).encode(), "x.geojson")


def feature(shape, **properties):
    return {"type": "Feature", "id": 7, "properties": properties, "geometry": shape}


def test_a_polygon_has_its_rings_in_one_shape_and_its_name_inside():
    drawing = drawn({"type": "FeatureCollection", "features": [
        feature(WALL, layer="MURO", name="b1"), feature(WALL, Layer=3)]})  # fmt: skip
    one, hole, two, _ = drawing.chains
    assert one.points.tolist() == [0, 2, 2 + 3j, 3j] and hole.points.tolist() == [0.5 + 1j, 1 + 1j, 1 + 2j]
    assert one.closed and one.shape == hole.shape != two.shape and not one.bulges.any() and len(one.bulges) == 4
    assert [each.layer for each in drawing.chains] == ["MURO", "MURO", "3", "3"] and one.handle == "7"
    (label,) = drawing.labels
    assert (label.text, label.layer) == ("b1", "MURO")
    assert 0 < label.at.real < 2 and 0 < label.at.imag < 3
    assert (drawing.unit, drawing.paper, drawing.doubt) == (None, None, "")


def test_all_shapes_are_read():
    shapes = [
        {"type": "MultiPolygon", "coordinates": [[RING], [[[x + 5, y, 0.1] for x, y in RING]]]},
        {"type": "LineString", "coordinates": [[0, 0], [5, 0]]},
        {"type": "LineString", "coordinates": RING},
        {"type": "MultiLineString", "coordinates": [[[0, 0, 1], [5, 0, 2]], [[1, 1], [2, 2]]]},
        {"type": "Point", "coordinates": [1, 2]},
        {"type": "MultiPoint", "coordinates": [[3, 4], [5, 6]]},
    ]
    nested = {"type": "GeometryCollection", "geometries": shapes[3:]}
    drawing = drawn({"type": "GeometryCollection", "geometries": [*shapes[:3], nested]})
    assert [len(each.points) for each in drawing.chains] == [4, 4, 2, 4, 2, 2]
    assert [each.closed for each in drawing.chains] == [True, True, False, True, False, False]
    assert [each.heights for each in drawing.chains][1:5:3] == [(0.1, 0.1), (1, 2)]
    assert [spot.at for spot in drawing.spots] == [1 + 2j, 3 + 4j, 5 + 6j]
    assert not any(each.shape for each in drawing.chains)


def test_empty_shapes_are_left_out_and_counted():
    shapes = [{"type": "Polygon", "coordinates": []}, {"type": "MultiLineString", "coordinates": [[]]}, None]
    shapes += [{"type": "Point", "coordinates": []}, {"type": "LineString", "coordinates": [[1, 1]]}, WALL]
    drawing = drawn({"type": "FeatureCollection", "features": [feature(each, layer="L") for each in shapes]})
    assert len(drawing.chains) == 2
    kinds = ["Polygon", "MultiLineString", "Feature", "Point", "LineString"]
    assert [(each.kind, each.layer, each.count) for each in drawing.left_out] == [(kind, "L", 1) for kind in kinds]


def moved(x, y, scale=1.0):
    return {"type": "Polygon", "coordinates": [[[x + scale * a, y + scale * b] for a, b in RING]]}


METRE = 1e-5  # degrees
CRS84 = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
UTM = {"type": "name", "properties": {"name": "WGS 84 / UTM zone 32N"}}


@pytest.mark.every(3)
@pytest.mark.parametrize(("shape", "crs", "degrees"), [
    (moved(0, 0), None, False), (moved(40, 12), None, False), (moved(0, 0, 0.001), None, False),
    (moved(0, 0), CRS84, True), (moved(0, 0), "EPSG:4326", True), (moved(0, 0), {"name": "urn:x:EPSG::4326"}, True),
    (moved(0, 0), UTM, False), (moved(500, 10, 0.01), None, False), (moved(681000, 4849000), None, False),
    (moved(11.25, 43.77, METRE), "EPSG:4258", True),
])  # fmt: skip
def test_degrees_are_refused_and_metres_are_not(shape, crs, degrees):
    whole = shape if crs is None else {**shape, "crs": crs}
    if not degrees:
        assert drawn(whole).chains
        return
    with pytest.raises(geojson.DrawingError, match="degrees") as caught:
        drawn(whole)
    assert caught.value.refused == "degrees" and len(caught.value.at) == 1


@pytest.mark.every(3)
@pytest.mark.parametrize(("text", "refused", "words"), [
    ("", "empty", "empty"), ("\ufeff \n", "empty", "empty"),
    ('{"type": "Point",\n', "not_geojson", "x:2: the file is cut short"),
    ('{"type": "Point", "type": "Point"}', "not_geojson", "the key `type` twice"),
    ('{"type": "Point", "coordinates": [NaN, 1]}', "not_geojson", "NaN is not a number"),
    ('{"type": "Point", "coordinates": [1e999, 1]}', "number", "beyond 1e\\+12"),
    ('{"type": "Point", "coordinates": ["1", 2]}', "not_geojson", "give two or three numbers"),
    ('{"type": "Point", "coordinates": [1]}', "not_geojson", "give two or three numbers"),
    ('{"type": "Point", "coordinates": 1}', "not_geojson", "without a list of `coordinates`"),
    ('{"type": "Polygon", "coordinates": [[1, 2], [3, 4]]}', "not_geojson", "position `1.0`"),
    ('{"type": "Polygon", "coordinates": [1, 2]}', "not_geojson", "not nested as they must be"),
    ('{"type": "Topology"}', "not_geojson", "the type `Topology` is not"),
    ('{"type": ["a"]}', "not_geojson", "is not a feature"), ("[1, 2]", "not_geojson", "is not a feature"),
    ('{"type": "Feature", "geometry": []}', "not_geojson", "is not a feature"),
    ("[" * 100_000, "not_geojson", "nested too deep"),
    ('{"type": "GeometryCollection", "geometries": [' * 60 + "]}" * 60, "not_geojson", "nested too deep"),
])  # fmt: skip
def test_bad_files_are_refused_with_class_and_words(text, refused, words):
    with pytest.raises(geojson.DrawingError, match=words) as caught:
        geojson.read(text.encode(), "x")
    assert caught.value.refused == refused


def test_encodings():
    text = json.dumps(feature(WALL, layer="è\x1b<b>"), ensure_ascii=False)
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        assert geojson.read(text.encode(encoding), "x").chains[0].layer == "è\x1b<b>"
    with pytest.raises(geojson.DrawingError, match="x:1: not UTF-8 text"):
        geojson.read(text.encode("latin-1"), "x")


def test_sniff_takes_geojson_alone():
    text = json.dumps(WALL).encode()
    assert geojson.sniff(text, ".json") and geojson.sniff(b"", ".geojson") and geojson.sniff(text, ".geojson")
    assert not geojson.sniff(b'{"type": "structure"}', ".json") and not geojson.sniff(text, ".txt")


def test_the_point_inside_a_frame_is_in_no_hole():
    frame, hole = (np.array([0, 1, 1 + 1j, 1j]) * 4, np.array([0, 1, 1 + 1j, 1j]) * 3.8 + 0.1 + 0.1j)
    at = inside([frame, hole])
    assert 0 < at.real < 4 and 0 < at.imag < 4 and not (0.1 < at.real < 3.9 and 0.1 < at.imag < 3.9)
    assert inside([np.array([0, 2])]) == 1
