"""DXF drawings: every line with its arcs exactly, what is left out and why, and what is refused."""

import io
import re
from math import pi, sqrt, tan

import ezdxf
import numpy as np
import pytest
from ezdxf.enums import TextEntityAlignment
from ezdxf.xclip import XClip

from rocking_cli.io.drawings import dxf
from rocking_cli.io.drawings.contract import DrawingError, OmittedKind
from tests.io.drawings.areas import area

HALF = 1.0  # bulge of half a circle
QUARTER = tan(pi / 8)
R2000 = ["0 SECTION", "2 HEADER", "9 $ACADVER", "1 AC1015", "0 ENDSEC"]
MIRRORED = {"extrusion": (0, 0, -1)}


def new(version="R2018", **header):
    document = ezdxf.new(version)
    for name, value in header.items():
        document.header[f"${name}"] = value
    return document, document.modelspace()


def content(document, binary=False):
    if binary:
        document.write(stream := io.BytesIO(), fmt="bin")
        return stream.getvalue()
    document.write(stream := io.StringIO())
    return document.encode(stream.getvalue())


def read(document, binary=False):
    return dxf.read(content(document, binary), "wall.dxf")


def written(*lines, head=()):
    """A drawing without tables, as a script writes it: group codes and values in turn."""
    groups = [*head, "0 SECTION", "2 ENTITIES", *lines, "0 ENDSEC", "0 EOF"]
    return "\r\n".join(part for each in groups for part in each.split(" ", 1)).encode() + b"\r\n"


def only(drawing):
    (chain,) = drawing.chains
    return chain


def near(chain, points, bulges=None, closed=None):
    np.testing.assert_allclose(chain.points, points, atol=1e-12)
    np.testing.assert_allclose(chain.bulges, np.zeros(len(points)) if bulges is None else bulges, atol=1e-12)
    assert closed is None or chain.closed is closed


def refused(data, kind, words):
    with pytest.raises(DrawingError, match=words) as error:
        dxf.read(data, "wall.dxf")
    assert error.value.refused == kind
    assert "wall.dxf: " in str(error.value)


@pytest.mark.parametrize(
    ("version", "binary"), [("R12", False), ("R12", True), ("R2000", True), ("R2007", False), ("R2018", True)]
)
def test_every_version_is_read_ascii_and_binary(version, binary):
    document, space = new(version)
    document.layers.add("Età di pietra")
    layer = {"layer": "Età di pietra"}
    line = space.add_line((0, 0, 1), (3, 4, 1), layer)
    space.add_arc((1, 1), 2, 350, 80, dxfattribs=layer)
    space.add_polyline2d([(0, 0, 0), (1, 0, 1), (1, 2, 0)], format="xyb", close=True, dxfattribs=layer)
    space.add_text("età", dxfattribs=layer).set_placement((0.5, 0.25))
    space.add_point((7, 8), layer)
    data = content(document, binary)
    assert dxf.sniff(data, ".txt")
    drawing = dxf.read(data, "wall.dxf")
    straight, arc, polyline = drawing.chains
    near(straight, [0, 3 + 4j], closed=False)
    assert (straight.layer, straight.kind, straight.handle) == ("Età di pietra", "LINE", line.dxf.handle)
    assert straight.heights == (1.0, 1.0) and straight.shape == "" and not straight.is_fill
    start, end = (1 + 1j + 2 * np.exp(1j * np.radians(each)) for each in (350, 80))
    near(arc, [start, end], [tan(pi / 8), 0], closed=False)
    near(polyline, [0, 1, 1 + 2j], [0, HALF, 0], closed=True)
    assert [(each.text, each.at, each.layer) for each in drawing.labels] == [("età", 0.5 + 0.25j, "Età di pietra")]
    assert [(each.at, each.kind) for each in drawing.spots] == [(7 + 8j, "POINT")]
    assert drawing.left_out == []


class TestLines:
    def test_a_circle_is_two_half_circles(self):
        document, space = new()
        space.add_circle((2, 1), 0.5)
        chain = only(read(document))
        near(chain, [2.5 + 1j, 1.5 + 1j], [HALF, HALF], closed=True)
        assert chain.kind == "CIRCLE" and not chain.is_straightened

    def test_a_long_arc_has_a_corner_at_its_middle(self):
        document, space = new()
        space.add_arc((0, 0), 1, 90, 0)
        chain = only(read(document))
        near(chain, [1j, np.exp(1.25j * pi), 1], [tan(3 * pi / 16)] * 2 + [0], closed=False)
        document, space = new()
        space.add_arc((0, 0), 1, 30, 390)
        assert only(read(document)).closed

    def test_a_polyline_that_ends_where_it_begins_is_closed(self):
        document, space = new()
        space.add_lwpolyline([(0, 0, 0), (2, 0, HALF), (2, 2, 0), (0, 0, 9)], format="xyb")
        near(only(read(document)), [0, 2, 2 + 2j], [0, HALF, 0], closed=True)

    def test_of_repeated_corners_the_last_has_the_bulge(self):
        document, space = new()
        corners = [(0, 0, 0), (2, 0, 5), (2, 0, HALF), (2, 2, 0), (0, 0, 7)]
        space.add_lwpolyline(corners, format="xyb", close=True)
        near(only(read(document)), [0, 2, 2 + 2j], [0, HALF, 0], closed=True)

    def test_the_bulge_after_an_open_end_is_nothing(self):
        document, space = new()
        space.add_lwpolyline([(0, 0, 0), (2, 0, QUARTER), (2, 2, HALF)], format="xyb")
        space.add_lwpolyline([(0, 0, QUARTER), (2, 0, HALF)], format="xyb")
        first, second = read(document).chains
        near(first, [0, 2, 2 + 2j], [0, QUARTER, 0], closed=False)
        near(second, [0, 2], [QUARTER, 0], closed=False)

    def test_mirrored_planes_mirror_x_and_every_bulge(self):
        document, space = new()
        space.add_lwpolyline([(0, 0, 0), (2, 0, QUARTER), (2, 2, 0)], format="xyb", close=True, dxfattribs=MIRRORED)
        space.add_arc((1, 0), 1, 0, 90, dxfattribs=MIRRORED)
        space.add_circle((1, 0, -3), 1, MIRRORED)
        space.add_text("name", dxfattribs=MIRRORED).set_placement((1, 2))
        drawing = read(document)
        polyline, arc, circle = drawing.chains
        near(polyline, [0, -2, -2 + 2j], [0, -QUARTER, 0], closed=True)
        near(arc, [-2, -1 + 1j], [-QUARTER, 0])
        near(circle, [-2, 0], [-HALF, -HALF], closed=True)
        assert circle.heights == (3.0, 3.0)
        assert drawing.labels[0].at == pytest.approx(-1 + 2j)

    def test_heights_are_those_of_all_corners(self):
        document, space = new()
        space.add_polyline3d([(0, 0, 1), (1, 0, 4), (1, 1, -2)], close=True)
        space.add_lwpolyline([(0, 0), (1, 0)], dxfattribs={"elevation": 2.5})
        space.add_circle((0, 0, 0), 1, {"extrusion": (1, 0, 0)})
        space.add_3dface([(0, 0, 1), (1, 0, 1), (1, 1, 5), (0, 1, 1)])
        high, level, steep, face = read(document).chains
        assert high.heights == (-2.0, 4.0) and high.closed and level.heights == (2.5, 2.5)
        np.testing.assert_allclose(steep.heights, (-1, 1), atol=1e-3)
        assert steep.is_straightened and np.ptp(steep.points.real) < 1e-12
        near(face, [0, 1, 1 + 1j, 1j], closed=True)
        assert face.heights == (1.0, 5.0)

    def test_a_solid_is_a_fill_whose_last_corners_are_the_other_way_round(self):
        document, space = new()
        space.add_solid([(0, 0), (1, 0), (0, 1), (1, 1)])
        space.add_solid([(0, 0), (1, 0), (0, 1)])
        four, three = read(document).chains
        near(four, [0, 1, 1 + 1j, 1j], closed=True)
        near(three, [0, 1, 1j], closed=True)
        assert four.is_fill and three.is_fill

    def test_a_curve_fitted_polyline_leaves_its_control_points_out(self):
        data = written(
            "0 POLYLINE", "8 A", "66 1", "70 5", "0 VERTEX", "10 9", "20 9", "70 16",
            *(part for x, y in [(0, 0), (1, 0), (1, 1)] for part in ("0 VERTEX", f"10 {x}", f"20 {y}", "70 8")),
            "0 SEQEND", "0 LINE", "10 0", "20 0", "11 1", "21 1",
        )  # fmt: skip
        polyline, line = dxf.read(data, "wall.dxf").chains
        near(polyline, [0, 1, 1 + 1j], closed=True)
        assert polyline.is_straightened and line.layer == "0"


class TestCurves:
    def test_an_ellipse_keeps_its_area(self):
        document, space = new()
        space.add_ellipse((3, 1), (2, 0), 0.25)
        chain = only(read(document))
        assert chain.is_straightened and chain.closed and not chain.bulges.any()
        assert area(chain) == pytest.approx(pi, rel=1e-9)
        off = (chain.points.real - 3) ** 2 / 4 + (chain.points.imag - 1) ** 2 / 0.25
        assert np.abs(off - 1).max() < 5e-4

    def test_an_ellipse_of_equal_axes_is_an_arc(self):
        document, space = new()
        space.add_ellipse((1, 0), (0, 2), 1, 0, pi / 2)
        space.add_ellipse((1, 0), (2, 0), 1, 0, pi / 2, MIRRORED)
        arc, mirrored = read(document).chains
        near(arc, [1 + 2j, -1], [QUARTER, 0])
        near(mirrored, [3, 1 - 2j], [-QUARTER, 0])
        assert not arc.is_straightened

    def test_a_parabola_keeps_1e_6(self):
        """A SPLINE of degree 2 encloses 2/3 of its box."""
        document, space = new()
        spline = space.add_spline(degree=2)
        spline.control_points = [(1e6, 0, 2), (1e6 + 0.6, 1.2, 2), (1e6 + 1.2, 0, 2)]
        spline.knots = [0, 0, 0, 1, 1, 1]
        chain = only(read(document))
        assert chain.is_straightened and chain.heights == (2.0, 2.0)
        assert abs(area(chain)) == pytest.approx(0.48, rel=5e-6)
        along = (chain.points.real - 1e6) / 1.2
        np.testing.assert_allclose(chain.points.imag, 2.4 * along * (1 - along), atol=1e-9)

    def test_rational_and_fitted_splines_are_read(self):
        document, space = new()
        spline = space.add_spline(degree=2)
        spline.control_points = [(1, 0), (1, 1), (0, 1)]
        spline.knots, spline.weights = [0, 0, 0, 1, 1, 1], [1, sqrt(0.5), 1]
        space.add_spline(fit_points=[(0, 0), (1, 1), (2, 0)])
        circle, fitted = read(document).chains
        np.testing.assert_allclose(np.abs(circle.points), 1, atol=1e-12)
        assert np.abs(fitted.points - (1 + 1j)).min() < 1e-9 and fitted.points[-1] == pytest.approx(2)


class TestHatches:
    def test_loops_of_a_hatch_share_its_shape(self):
        document, space = new()
        for shift in (0, 10):
            hatch = space.add_hatch(dxfattribs={"elevation": (0, 0, 3)})
            hatch.paths.add_polyline_path([(shift, 0, HALF), (shift + 2, 0, HALF)], flags=1)
            hatch.paths.add_polyline_path([(shift + 4, 0), (shift + 6, 0), (shift + 6, 2)], flags=1)
            hatch.paths.add_polyline_path([(shift + 1, 0), (shift + 1.2, 0), (shift + 1.2, 0.2)], flags=16)
            hatch.paths.add_polyline_path([(shift, 0), (shift + 1, 0), (shift + 1, 1)], flags=8)  # around a text
        chains = read(document).chains
        assert all(each.is_fill and each.closed and each.heights == (3.0, 3.0) for each in chains)
        shapes = [each.shape for each in chains]
        assert shapes == [shapes[0]] * 3 + [shapes[3]] * 3 and shapes[0] != shapes[3]
        near(chains[0], [0, 2], [HALF, HALF])
        near(chains[1], [4, 6, 6 + 2j])

    def test_edges_are_joined_out_of_order_and_against_their_sense(self):
        """A round-topped stone, a circle with two half ellipses, and an opening by a spline, all in disorder."""
        document, space = new()
        paths = space.add_hatch().paths
        stone = paths.add_edge_path()
        stone.add_line((1, 2.0000001), (1, 0))
        stone.add_line((0, 2), (0, 0))
        stone.add_arc((0.5, 2), 0.5, 0, 180, ccw=False)
        stone.add_line((0, 0), (1, 0))
        ring = paths.add_edge_path()
        ring.add_arc((5, 0), 1, 0, 360)
        ellipse = paths.add_edge_path()
        ellipse.add_ellipse((10, 0), (2, 0), 0.5, 180, 360)
        ellipse.add_ellipse((10, 0), (2, 0), 0.5, 0, 180, ccw=False)
        spline = paths.add_edge_path()
        spline.add_spline(control_points=[(20, 0), (20.6, 1.2), (21.2, 0)], degree=2, knot_values=[0, 0, 0, 1, 1, 1])
        spline.add_line((20, 0), (21.2, 0))
        backwards = paths.add_edge_path()
        backwards.add_line((30, 0), (32, 0))
        backwards.add_arc((31, 0), 1, 180, 360)
        *chains, bowl = read(document).chains
        assert area(bowl) == pytest.approx(-pi / 2)
        assert len(chains) == 4 and all(each.closed and each.shape == "HATCH 1" for each in chains)
        assert [abs(area(each)) for each in chains] == pytest.approx([2 + pi / 8, pi, 2 * pi, 0.48], rel=1e-5)
        assert [each.is_straightened for each in chains] == [False, False, True, True]
        assert sorted(np.abs(chains[0].bulges)) == pytest.approx([0, 0, 0, HALF])
        assert len(chains[0].points) == 4


class TestInserts:
    @staticmethod
    def block(name="STONE"):
        document, space = new()
        block = document.blocks.new(name, base_point=(1, 0))
        block.add_lwpolyline([(1, 0, 0), (3, 0, QUARTER), (3, 2, 0)], format="xyb", close=True)
        return document, space, block

    def test_layer_0_of_a_block_is_that_of_its_insert(self):
        document, space, block = self.block()
        block.add_line((1, 0), (2, 0), {"layer": "own"})
        space.add_blockref("stone", (0, 0), {"layer": "BODIES"})
        assert [each.layer for each in read(document).chains] == ["BODIES", "own"]

    @pytest.mark.parametrize(
        "given, points, sign",
        [
            ({}, [0, 2, 2 + 2j], 1),
            ({"rotation": 90}, [0, 2j, -2 + 2j], 1),
            ({"xscale": -1}, [0, -2, -2 + 2j], -1),
            ({"xscale": 2, "yscale": -2}, [0, 4, 4 - 4j], -1),
            ({"xscale": -1, "yscale": -1}, [0, -2, -2 - 2j], 1),
            ({**MIRRORED, "rotation": 90}, [0, 2j, 2 + 2j], -1),
        ],
    )
    def test_arcs_stay_exact(self, given, points, sign):
        document, space, _ = self.block()
        space.add_blockref("STONE", (0, 0), given)
        near(only(read(document)), points, [0, sign * QUARTER, 0], closed=True)

    def test_scaled_unequally_an_arc_is_part_of_an_ellipse(self):
        document, space, _ = self.block()
        space.add_blockref("STONE", (5, 0), {"xscale": 3, "rotation": 30})
        chain = only(read(document))
        assert chain.closed and chain.is_straightened and len(chain.points) > 30
        assert area(chain) == pytest.approx(3 * (2 + (pi / 2 - 1)), rel=1e-9)

    def test_arrays_nesting_and_attributes(self):
        document, space, _ = self.block()
        outer = document.blocks.new("PAIR")
        outer.add_blockref("STONE", (0, 0), {"row_count": 2, "row_spacing": 5, "column_count": 3, "column_spacing": 4})
        outer.add_attdef("NAME", (0, 0), "template")
        insert = space.add_blockref("PAIR", (100, 0), {"xscale": 2, "yscale": 2, "rotation": 90, "layer": "BODIES"})
        insert.add_attrib("NAME", "left pier", (101, 1))
        insert.add_attrib("HIDDEN", "part 7", (101, 1)).is_invisible = True
        drawing = read(document)
        starts = sorted((each.points[0] for each in drawing.chains), key=lambda z: (-z.real, z.imag))
        np.testing.assert_allclose(starts, [100 - 10 * row + 8j * column for row in (0, 1) for column in (0, 1, 2)])
        assert [(each.text, each.at, each.layer) for each in drawing.labels] == [("left pier", 101 + 1j, "BODIES")]
        left = {(each.kind, each.why, each.count) for each in drawing.left_out}
        assert left == {("ATTDEF", "the template of an attribute", 1), ("ATTRIB", "invisible", 1)}

    def test_a_curve_that_is_inserted_often_is_computed_once(self, monkeypatch):
        document, space, block = self.block()
        block.add_spline(fit_points=[(0, 0), (1, 1), (2, 0)])
        for k in range(50):
            space.add_blockref("STONE", (3 * k, 0), {"xscale": 2})
        count = []
        monkeypatch.setattr(dxf, "shapes_of", lambda entity, real=dxf.shapes_of: count.append(1) or real(entity))
        assert len(read(document).chains) == 100 and len(count) == 2


class TestLeftOut:
    def test_each_thing_is_counted_with_its_reason(self):
        document, space = new()
        for name in ("Cold", "Dark", "Shown"):
            document.layers.add(name)
        document.layers.get("Cold").freeze()
        document.layers.get("Dark").off()
        block = document.blocks.new("MIXED")
        block.add_line((0, 0), (1, 0))
        block.add_line((0, 0), (1, 0), {"layer": "shown"})
        document.blocks.new("NONE")
        for layer in ("COLD", "cold", "dark", "SHOWN"):
            space.add_line((0, 0), (1, 1), {"layer": layer})
        space.add_line((0, 0), (1, 1), {"invisible": 1})
        space.add_line((0, 0), (0, 0))
        for layer in ("Cold", "Dark"):
            space.add_blockref("MIXED", (0, 0), {"layer": layer})
        space.add_blockref("NONE", (0, 0)).add_attrib("NAME", "pier", (1, 2))
        space.add_blockref("LOST", (0, 0))
        space.add_xline((0, 0), (1, 0))
        space.add_mline([(0, 0), (1, 0)])
        with space.add_mesh().edit_data() as mesh:
            mesh.vertices, mesh.faces = [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]
        space.add_polyface().append_faces([[(0, 0), (1, 0), (1, 1)]])
        space.add_linear_dim((0, 2), (0, 0), (1, 0)).render()
        space.add_text(" ")
        document.layout("Layout1").add_line((0, 0), (1, 1))
        document.layouts.new("Second").add_circle((0, 0), 1)
        drawing = read(document)
        assert [each.layer for each in drawing.chains] == ["Shown", "Shown"]
        assert [each.text for each in drawing.labels] == ["pier"]
        left = set(drawing.left_out)
        expected = {
            OmittedKind("LINE", "Cold", "its layer is frozen", 2),
            OmittedKind("LINE", "Dark", "its layer is off", 2),  # one in the block
            OmittedKind("LINE", "0", "invisible", 1),
            OmittedKind("LINE", "0", "without length", 1),
            OmittedKind("INSERT", "Cold", "its layer is frozen", 1),
            OmittedKind("INSERT", "0", "its block NONE is empty", 1),
            OmittedKind("XLINE", "0", "without an end", 1),
            OmittedKind("MLINE", "0", "of a kind that cannot be read: explode it", 1),
            OmittedKind("MESH", "0", "a body in space", 1),
            OmittedKind("POLYLINE", "0", "a body in space", 1),
            OmittedKind("DIMENSION", "0", "an annotation", 1),
            OmittedKind("TEXT", "0", "empty", 1),
            OmittedKind("LINE", "0", "in paper space", 1),
            OmittedKind("CIRCLE", "0", "in paper space", 1),
        }
        assert any(
            "Deleted entity INSERT" in each for each in drawing.faults
        )  # ezdxf deletes an insert without a block
        assert expected <= left and {each.kind for each in left - expected} <= {"VIEWPORT"}


class TestTexts:
    def test_texts_lose_their_codes(self):
        document, space = new()
        space.add_text("%%utie%%u %%c20 45%%d 100%%%").set_placement((1, 2), align=TextEntityAlignment.MIDDLE)
        space.add_mtext(r"{\fArial|b1;\C1;left}\Ppier \S1/2;", {"insert": (3, 4)})
        space.add_mtext("x" * 600)
        space.add_text(r"\U+00E8")
        text, several, long, escaped = read(document).labels
        assert (text.text, text.at) == ("tie \u00d820 45\u00b0 100%", 1 + 2j)
        assert (several.text, several.at, several.kind) == ("left\npier 1/2", 3 + 4j, "MTEXT")
        assert long.text == "x" * 600 and escaped.text == "è"

    def test_a_text_is_where_it_is_aligned(self):
        aligned = ["0 TEXT", "1 a", "10 1", "20 2", "11 3", "21 4"]
        data = written(*aligned, *aligned, "72 1", *aligned, "73 2", *aligned, "72 5")
        assert [each.at for each in dxf.read(data, "wall.dxf").labels] == [1 + 2j, 3 + 4j, 3 + 4j, 1 + 2j]

    @pytest.mark.parametrize("page, encoding, name", [
        ("ANSI_1251", "cp1251", "\u043a\u0430\u043c\u0435\u043d\u044c"),
        ("dos850", "cp850", "GEWÖLBE città"),
    ])  # fmt: skip
    def test_texts_are_in_the_code_page_of_the_file(self, page, encoding, name):
        head = ["0 SECTION", "2 HEADER", "9 $ACADVER", "1 AC1015", "9 $DWGCODEPAGE", f"3 {page}", "0 ENDSEC"]
        data = written("0 POINT", "8 NAME", "10 0", "20 0", head=head).replace(b"NAME", name.encode(encoding))
        assert dxf.read(data, "wall.dxf").spots[0].layer == name


class TestUnits:
    @pytest.mark.parametrize("number, unit", [(0, None), (2, "ft"), (5, "cm"), (14, "dm")])
    def test_the_unit_is_that_of_the_file(self, number, unit):
        drawing = read(new(INSUNITS=number, MEASUREMENT=0)[0])
        assert (drawing.unit, drawing.doubt) == (unit, "")

    @pytest.mark.parametrize("number, words", [(1, "inches"), (2, "feet")])
    def test_inches_are_not_believed_in_a_metric_drawing(self, number, words):
        drawing = read(new(INSUNITS=number, MEASUREMENT=1)[0])
        assert drawing.unit is None and drawing.doubt == f"the file states {words}, but its $MEASUREMENT is metric"

    def test_other_units_are_not_believed(self):
        drawing = read(new(INSUNITS=13)[0])
        assert drawing.unit is None and "the unit 13 of $INSUNITS" in drawing.doubt
        assert read(new("R12")[0]).unit is None


class TestRefusals:
    def test_what_is_no_dxf(self):
        refused(b"AC1032\0\0\0", "not_dxf", "this is a DWG file\n  save it as DXF")
        refused(b"", "not_dxf", "is empty")
        refused(b" \r\n", "not_dxf", "is empty")
        refused(b"no drawing\n" * 100, "not_dxf", "not a DXF file")
        refused(bytes(range(256)) * 20, "not_dxf", "not a DXF file")
        assert dxf.sniff(b"AC1032", ".x") and dxf.sniff(b"", ".dxf") and not dxf.sniff(b"0\nLINE\n", ".x")
        assert dxf.sniff(b"999\nmade by hand\n  0\r\nSECTION\r\n", ".x")

    @pytest.mark.parametrize("binary", [False, True])
    def test_what_is_cut_short(self, binary):
        document, space = new("R2000")
        space.add_line((0, 0), (1, 1))
        data = content(document, binary)
        for share in (0.1, 0.5, 0.9):
            refused(data[: int(share * len(data))], "not_dxf", "cut short|damaged")
        refused(data[: data.rindex(b"EOF")], "not_dxf", "cut short")

    def test_what_is_damaged(self):
        refused(
            written("0 LINE", "5 2F", "8 A", "10 zero", "20 0"),
            "not_dxf",
            "is damaged: Invalid floating point values near line: 16",
        )
        refused(written("0 LINE", "10 nan", "20 0", "11 1", "21 0"), "not_dxf", r"LINE \w+ on layer 0 is damaged")
        refused(written("0 LWPOLYLINE", "10 1", "20 0", "10 2"), "not_dxf", "is damaged: missing 'AcDbPolyline'")
        refused(written("0 SPLINE", "71 3"), "not_dxf", "is damaged: missing 'AcDbSpline'")
        refused(written("0 LINE", "x y"), "not_dxf", "Invalid group code .x. at line 7")

    @pytest.mark.parametrize("kind", ["1.0", "NAN"])
    def test_a_kind_without_anything_is_left_out(self, kind):
        document, space = new()
        space.add_line((0, 0), (3, 4))
        data = re.sub(rb"\n  0\r?\nLINE\b", b"\n  0\n" + kind.encode(), content(document))
        assert [(each.kind, each.layer) for each in dxf.read(data, "wall.dxf").left_out] == [(kind, "0")]

    def test_a_fault_of_the_program_is_no_damage(self, monkeypatch):
        document, space = new()
        space.add_line((0, 0), (3, 4))
        monkeypatch.setattr(dxf, "shapes_of", lambda entity: no_such_name)  # noqa: F821
        with pytest.raises(NameError):
            read(document)

    def test_a_file_that_is_not_bound_is_named(self):
        document, space = new()
        document.add_xref_def("../plans/section.dwg", "PLAN")
        space.add_blockref("PLAN", (0, 0), {"layer": "x"})
        refused(content(document), "xref", r"another file, \.\./plans/section\.dwg\n  bind it")
        document.layers.add("x").freeze()
        assert read(document).chains == []

    def test_an_insert_of_which_a_part_is_hidden(self):
        document, space = new()
        document.blocks.new("WALL").add_lwpolyline([(0, 0), (2, 0), (2, 3), (0, 3)], close=True)
        clip = XClip(space.add_blockref("WALL", (0, 0)))
        clip.set_wcs_clipping_path([(0, 0), (1, 3)])
        refused(content(document), "clipped", r"INSERT \w+ on layer 0 shows only a part of its block WALL \(XCLIP\)")
        clip.disable_clipping()
        assert len(read(document).chains) == 1

    def test_blocks_within_themselves(self):
        document, space = new()
        one, other = document.blocks.new("ONE"), document.blocks.new("OTHER")
        one.add_blockref("OTHER", (0, 0))
        other.add_blockref("one", (0, 0))
        space.add_blockref("ONE", (0, 0))
        refused(content(document), "not_dxf", "the block one contains itself")

    def test_bombs_are_counted_before_they_are_made(self):
        document, space = new()
        grid = {"row_count": 10, "column_count": 10}
        for k in range(8):
            block = document.blocks.new(f"B{k}")
            if k:
                block.add_blockref(f"B{k - 1}", (0, 0), {**grid, "row_spacing": 9, "column_spacing": 9})
            else:
                block.add_line((0, 0), (1, 0))
        space.add_blockref("B1", (0, 0))
        assert len(read(document).chains) == 100
        space.add_blockref("B7", (0, 0))
        refused(content(document), "too_large", "inserts .* more than 100000 entities")

    def test_blocks_that_are_nested_without_end(self):
        document, space = new()
        for k in range(100):
            block = document.blocks.new(f"B{k}")
            block.add_blockref(f"B{k + 1}", (0, 0))
        space.add_blockref("B0", (0, 0))
        refused(content(document), "too_large", "more than 32 deep")
        for k in range(100):  # the deepest first, so that each is known
            space.add_blockref(f"B{99 - k}", (0, 0))
        refused(content(document), "too_large", "more than 32 deep")

    @pytest.mark.rest
    def test_a_million_lines(self):
        line = b"0\nLINE\n8\nUNKNOWN\n10\n0.0\n20\n0.0\n11\n1.0\n21\n1.0\n"
        data = b"0\nSECTION\n2\nENTITIES\n" + line * 1_000_000 + b"0\nENDSEC\n0\nEOF\n"
        refused(data, "too_large", "more than 100000 entities")
        refused(data * 2, "too_large", "larger than 64 MB")

    @pytest.mark.rest
    def test_many_corners_and_curves(self):
        corners = [part for k in range(350_000) for part in (f"10 {k}", "20 0")]
        polyline = written("0 LWPOLYLINE", "100 AcDbEntity", "8 0", "100 AcDbPolyline", *corners, head=R2000)
        refused(polyline, "too_large", "more than 300000 corners")
        document, space = new()
        space.add_open_spline([(k, k % 2) for k in range(20_000)], degree=2)
        refused(content(document), "too_large", "too many corners")
