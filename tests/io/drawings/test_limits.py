"""Drawings that are too large are refused before they are computed with."""

import pytest

from rocking_cli.io.drawings import contract, csv_vertices, geojson, svg, svg_paths

LINES = '{"type": "MultiLineString", "coordinates": [' + ", ".join(["[[0, 0], [1, 1]]"] * 6) + "]}"


@pytest.mark.parametrize(("module", "limit", "reader", "text", "words"), [
    (svg, "MAX_CURVES", svg, '<svg><path d="M0 0q1 2 3 4 5 6 7 8 1 1 1 0t1 2 3 4 3 3"/></svg>', "more than 5 curves"),
    (contract, "MAX_SIDES", svg, '<svg><path d="M0 0h1h1h1h1h1h1"/></svg>', "more than 5 sides"),
    (contract, "MAX_SIDES", svg, '<svg><ellipse rx="2" ry="1"/></svg>', "more than 5 sides"),
    (svg_paths, "MAX_CHARACTERS", svg, '<svg><path d="M0 0h1"/></svg>', "a path of more than 5 characters"),
    (svg_paths, "MAX_TRANSFORM_CHARACTERS", svg, '<svg><g transform="scale(1)"/></svg>', "a transform of more than 5"),
    (contract, "MAX_ELEMENTS", geojson, LINES, "more than 5 lines"),
    (geojson, "MAX_BYTES", geojson, LINES, "more than 5e-06 MB"),
    (contract, "MAX_ELEMENTS", csv_vertices, "0,0\n1,1\n\n" * 6, "more than 5 outlines"),
    (contract, "MAX_SIDES", csv_vertices, "0,0\n1,1\n" * 3, "more than 5 sides"),
])  # fmt: skip
def test_drawings_beyond_a_limit_are_refused(module, limit, reader, text, words, monkeypatch):
    reader.read(text.encode(), "x")
    monkeypatch.setattr(module, limit, 5)
    with pytest.raises(reader.DrawingError, match=words):
        reader.read(text.encode(), "x")
