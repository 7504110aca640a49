"""Draw the section of a church for `rocking import`, in millimetres as from a survey.

    python church.py church.dxf

A diaphragm arch of thirteen voussoirs spans the nave between two walls with buttresses. It shows how to draw so that
the drawing becomes a structure file:

- **Layers say what is drawn on them**, in English or Italian: CONCI, MURATURA (bodies), TERRENO (ground), SOLAIO
  (supports), CARICHI (loads), CATENE (ties). QUOTE, ASSI, TESTI, RETINO and SQUADRATURA mean nothing, and are left out.
- **A body is a closed line**, or lines and arcs whose ends meet. Arcs stay exact: draw them as arcs or as bulges of
  polylines, not as short lines.
- **Mortar is a gap**: draw stones as they are; `--merge-gap` closes the joints between them.
- **Blocks (INSERT) may be turned, scaled and mirrored.** The right half of this section is the left one, mirrored.
- **A text inside a body is its name**; so is an attribute of its block. Write names without `and` and colons.
"""

from __future__ import annotations

import sys
from cmath import exp
from collections.abc import Sequence
from math import asin, pi, tan
from pathlib import Path

import ezdxf
from ezdxf.layouts import BaseLayout

MORTAR = 12.0  # mm, of every joint
RADIUS, RING = 3000.0, 600.0  # of the intrados, and thickness of the arch
COUNT = 13  # voussoirs
HEIGHT, WALL, COURSE = 4500.0, 1000.0, 1500.0  # springing above the floor, thickness of the walls, height of a course
STEPS = (600.0, 400.0)  # by which the buttress stands out from the wall, in the first course and above
TIE = 4200.0  # height of the tie
FLOOR = 3900.0  # height of the floor of the house on the left

LAYERS = {  # and their colours, which mean nothing to the import
    "MURATURA": 30, "CONCI": 40, "TERRENO": 94, "SOLAIO": 150, "CARICHI": 1, "CATENE": 5, "TESTI": 7, "QUOTE": 8,
    "ASSI": 8, "RETINO": 9, "SQUADRATURA": 7,
}  # fmt: skip
Corner = tuple[float, float, float]  # x, y, and the bulge of the side to the next corner


def box(left: float, low: float, right: float, high: float) -> list[Corner]:
    """Return the corners of a rectangle."""
    return [(left, low, 0.0), (right, low, 0.0), (right, high, 0.0), (left, high, 0.0)]


def courses() -> list[list[Corner]]:
    """Return the stones of the left wall and its buttress, which are bonded: a course is one stone, from below.

    Each stone is half a mortar joint away from the middle of the joint. The first one stands on the ground.
    """
    half, face, nave = MORTAR / 2, -RADIUS - WALL, -RADIUS
    low, middle, top = (
        box(face - step, k * COURSE + (half if k else 0.0), nave, (k + 1) * COURSE - half)
        for k, step in enumerate((*STEPS, 0.0))
    )
    foot = 2 * COURSE + half  # the buttress ends in the third course, with a sloping top
    slope = [(face, foot + 700, 0.0), (face - STEPS[-1], foot + 500, 0.0), (face - STEPS[-1], foot, 0.0)]
    return [low, middle, [*top[1:], *slope]]


def voussoir(k: int) -> list[Corner]:
    """Return the corners of a voussoir, counted from the left springing; 0 is the first.

    Its joints are on radii, and its sides half a mortar joint away from them and parallel to them: a corner at the
    radius r is off the radius of the joint by the angle asin(MORTAR/2/r). The bulge of an arc is tan(turn/4), positive
    if the arc turns anticlockwise.
    """
    start, end = (pi * (1 - each / COUNT) for each in (k, k + 1))
    corners = []
    for radius, way in ((RADIUS + RING, 1), (RADIUS, -1)):  # along the extrados, and back along the intrados
        off = asin(MORTAR / 2 / radius)
        bulge = -way * tan((start - end - 2 * off) / 4)
        for angle, of_side in zip((start - off, end + off)[::way], (bulge, 0.0), strict=True):
            z = radius * exp(1j * angle) + 1j * HEIGHT
            corners.append((z.real, z.imag, of_side))
    return corners


def middle(corners: Sequence[Corner]) -> tuple[float, float]:
    """Return a point inside a stone, for its name."""
    return sum(x for x, _, _ in corners) / len(corners), sum(y for _, y, _ in corners) / len(corners)


def stones() -> list[tuple[str, str, list[Corner]]]:
    """Return name, layer and corners of each stone of the left half."""
    return [
        *((f"M{k + 1}", "MURATURA", corners) for k, corners in enumerate(courses())),
        *((f"C{k + 1}", "CONCI", voussoir(k)) for k in range(COUNT // 2)),
    ]


def write(text: str, x: float, y: float, layer: str, sheet: BaseLayout, height: float = 120.0) -> None:
    """Write a text with its left end at a point."""
    sheet.add_text(text, height=height, dxfattribs={"layer": layer, "insert": (x, y)})


def draw_masonry(sheet: BaseLayout, doc: ezdxf.document.Drawing) -> None:
    """Draw the stones: the left half as closed polylines, the right half as mirrored blocks."""
    for name, layer, corners in stones():
        x, y = middle(corners)
        sheet.add_lwpolyline(corners, format="xyb", close=True, dxfattribs={"layer": layer})
        write(name, x - 90, y - 60, "TESTI", sheet)  # a text inside is the name of the stone

        # The same stone as a block. What is on layer 0 in a block has the layer of the INSERT; so one block may be
        # inserted on several layers.
        block = doc.blocks.new(f"STONE_{name}")
        block.add_lwpolyline(corners, format="xyb", close=True, dxfattribs={"layer": "0"})
        block.add_attdef("NAME", insert=(x, y - 60), height=120)
        mirrored = sheet.add_blockref(block.name, (0, 0), dxfattribs={"layer": layer, "xscale": -1})
        mirrored.add_attrib("NAME", f"{name}d", (-x - 150, y - 60), {"height": 120, "layer": "TESTI"})

    # The keystone is drawn by hand: two lines and two arcs whose ends meet.
    corners = voussoir(COUNT // 2)
    for (x, y, bulge), (u, v, _) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if not bulge:
            sheet.add_line((x, y), (u, v), dxfattribs={"layer": "CONCI"})
    for radius in (RADIUS, RADIUS + RING):
        half = 90 / COUNT - asin(MORTAR / 2 / radius) * 180 / pi  # an ARC has degrees, anticlockwise
        sheet.add_arc((0, HEIGHT), radius, 90 - half, 90 + half, dxfattribs={"layer": "CONCI"})
    write("chiave", -190, HEIGHT + RADIUS + RING / 2 - 60, "TESTI", sheet)


def draw_what_acts(sheet: BaseLayout) -> None:
    """Draw ground, floor, loads and tie."""
    # An open line of the ground: below it is ground.
    sheet.add_line((-7500, 0), (7500, 0), dxfattribs={"layer": "TERRENO"})
    # A floor is one line; where it ends in a body, it holds the body. It is that of the house on the left, on 150 mm.
    face = RADIUS + WALL
    sheet.add_line((-7000, FLOOR), (150 - face, FLOOR), dxfattribs={"layer": "SOLAIO"})
    # A point with a mass beside it, and its name before the mass.
    at = RADIUS + 0.75 * WALL
    for name, x, beside in (("tetto sinistro", -at, -1700), ("tetto destro", at, 150)):
        sheet.add_point((x, HEIGHT - MORTAR / 2), dxfattribs={"layer": "CARICHI"})
        write(f"{name} 3 t", x + beside, HEIGHT + 60, "CARICHI", sheet)
    # A tie is a line between two bodies, with what it is made of beside it.
    sheet.add_line((-RADIUS, TIE), (RADIUS, TIE), dxfattribs={"layer": "CATENE"})
    write("catena: area 113 mm2, yield 235 MPa", -1500, TIE + 60, "CATENE", sheet)


def draw_the_rest(sheet: BaseLayout) -> None:
    """Draw what engineers need and the import leaves out: dimensions, axis, hatch, frame, title."""
    sheet.add_linear_dim((0, -700), (-RADIUS, 0), (RADIUS, 0), override={"dimtxt": 150}, dxfattribs={"layer": "QUOTE"})
    sheet.add_linear_dim(
        (6600, 0),
        (RADIUS + WALL + STEPS[0], 0),
        (RADIUS + WALL, HEIGHT),
        angle=90,
        override={"dimtxt": 150},
        dxfattribs={"layer": "QUOTE"},
    )
    for dimension in sheet.query("DIMENSION"):
        dimension.render()
    sheet.add_line((0, -300), (0, HEIGHT + RADIUS + RING + 300), dxfattribs={"layer": "ASSI"})
    hatch = sheet.add_hatch(dxfattribs={"layer": "RETINO"})
    hatch.set_pattern_fill("ANSI31", scale=40)
    hatch.paths.add_polyline_path([(x, y) for x, y, _ in courses()[0]])
    frame = [(-7800, -1700), (7800, -1700), (7800, 8700), (-7800, 8700)]
    sheet.add_lwpolyline(frame, close=True, dxfattribs={"layer": "SQUADRATURA"})
    write("Sezione trasversale, scala 1:50", 3300, -1500, "SQUADRATURA", sheet, 200)


def church() -> ezdxf.document.Drawing:
    """Return the drawing."""
    doc = ezdxf.new("R2010", units=ezdxf.units.MM)  # the unit stands in the file: $INSUNITS
    for name, colour in LAYERS.items():
        doc.layers.add(name, color=colour)
    sheet = doc.modelspace()
    draw_masonry(sheet, doc)
    draw_what_acts(sheet)
    draw_the_rest(sheet)
    return doc


def main() -> None:
    """Write the drawing."""
    if len(sys.argv) != 2 or Path(sys.argv[1]).suffix.lower() != ".dxf":
        sys.exit("usage: python church.py church.dxf")
    church().saveas(sys.argv[1])


if __name__ == "__main__":
    main()
