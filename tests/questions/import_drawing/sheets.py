"""Drawings made by the tests, in the contract of readers, without any file."""

import numpy as np

from rocking_cli.core import Direction
from rocking_cli.io.drawings.contract import DrawnLine, DrawnPoint, DrawnText, LineDrawing
from rocking_cli.questions.import_drawing.options import ImportOptions
from rocking_cli.questions.import_drawing.study import structure_from


def outline(points, layer="BLOCKS", bulges=None, **more):
    z = np.array([complex(*each) for each in points])
    bulges = np.zeros(len(z)) if bulges is None else np.array(bulges, float)
    return DrawnLine(z, bulges, True, layer, "LWPOLYLINE", **more)


def box(x, y, width, height, layer="BLOCKS", **more):
    return outline([(x, y), (x + width, y), (x + width, y + height), (x, y + height)], layer, **more)


def line(start, end, layer="BLOCKS", bulge=0.0):
    return DrawnLine(np.array([complex(*start), complex(*end)]), np.array([bulge, 0.0]), False, layer, "LINE")


def sides(points, layer="BLOCKS"):
    """Return the sides of a closed line as lines."""
    return [line(a, b, layer) for a, b in zip(points, [*points[1:], points[0]], strict=True)]


def text(words, x, y, layer="TESTI"):
    return DrawnText(words, complex(x, y), layer, "TEXT")


def spot(x, y, layer):
    return DrawnPoint(complex(x, y), layer, "POINT")


def imported(*chains, spots=(), labels=(), **options):
    options.setdefault("units", "m")
    drawing = LineDrawing("test", chains, labels=labels, spots=spots)
    return structure_from(drawing, ImportOptions(**options), "drawn", "drawn.dxf")


def lambdas(found):
    return [found.structure.uplift(direction) for direction in Direction]


def criticals(found):
    return [found.structure.critical_rotation(direction) for direction in Direction]


def words(found):
    return " / ".join(note.words for note in found.notes)
