"""Drawings that are right in another way than expected, or wrong in a way that is easily missed."""

import sys
from math import pi, tan

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.io.drawings.contract import DrawingError
from rocking_cli.questions.import_drawing import outlines
from rocking_cli.questions.import_drawing.legend import DrawingFrame
from rocking_cli.questions.import_drawing.mortar import close_gaps
from rocking_cli.questions.import_drawing.outlines import DrawnBody
from rocking_cli.questions.import_drawing.rings import ArcRing
from rocking_cli.questions.import_drawing.study import check_overlaps
from tests.questions.import_drawing.sheets import box, imported, line, outline, text, words

WALL = box(0, 0, 0.6, 2.4)
WEIGHED = {"density": {"": 2000.0}, "depth": 1.0}


@pytest.mark.parametrize("layer", ["CATENE", "CARICHI", "SOLAIO"])
def test_a_closed_line_on_a_layer_of_lines_is_asked_about(layer):
    with pytest.raises(DrawingError, match="is closed, and the name of its layer says") as caught:
        imported(WALL, box(2, 0, 1, 1, layer))
    assert caught.value.refused == "layers"
    if layer == "CATENE":
        assert len(imported(WALL, box(0, 2.4, 0.6, 1, layer), layers={"bodies": [layer]}).bodies) == 2


def test_a_line_that_nearly_closes_on_an_unknown_layer_is_asked_about():
    nearly = outline([(2, 0), (3, 0), (3, 1), (2, 1), (2, 0.0005)], "FOGLIO")
    with pytest.raises(DrawingError, match="FOGLIO has no known role"):
        imported(WALL, type(nearly)(nearly.points, nearly.bulges, False, "FOGLIO", "LWPOLYLINE"))


def test_an_island_of_a_hatch_is_an_opening_in_a_drawn_outline_once():
    edges = [
        box(0, 0, 0.6, 2.4, is_fill=True, shape="HATCH 1"), box(0.2, 1, 0.2, 0.5, is_fill=True, shape="HATCH 1")
    ]  # fmt: skip
    for drawn in ([WALL, *edges], edges, [WALL, *edges, box(0.2, 1, 0.2, 0.5, "FORI")]):
        (body,) = imported(*drawn).bodies
        assert body.moments.area == pytest.approx(1.44 - 0.1)


def test_ground_of_several_lines_is_one():
    step = [line(a, b, "TERRENO") for a, b in [((1.5, 0), (1.5, 0.5)), ((4, 0.5), (1.5, 0.5)), ((-1, 0), (1.5, 0))]]
    found = imported(WALL, box(2, 0.5, 0.7, 2.4), *step, **WEIGHED)
    (ground,) = found.fields["ground"].values()
    assert len(ground["polygon"]) == 6 and [1.5, 0.5] in ground["polygon"] and len(found.joints) == 2


def test_a_rigid_body_on_ground_that_is_not_level_below_it_is_refused():
    assert imported(WALL, line((-1, 0), (2, 0), "TERRENO"), kind="rigid_body").kind == "rigid_body"
    for ends in (((-1, 0.1), (2, -0.2)), ((-1, -0.5), (2, -0.5))):
        with pytest.raises(DrawingError, match="not level or does not meet it") as caught:
            imported(WALL, line(*ends, "TERRENO"), kind="rigid_body")
        assert caught.value.refused == "below"


def test_faces_along_one_arc_and_corners_of_an_l_do_not_overlap():
    bulge = tan(pi / 16)
    below = outline([(0, 0), (2, 0), (2, 2), (0, 2)], bulges=[0, 0, bulge, 0])
    above = outline([(0, 2), (2, 2), (2, 4), (0, 4)], bulges=[-bulge, 0, 0, 0])
    assert len(imported(below, above, **WEIGHED).bodies) == 2
    seat = outline([(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)])
    assert len(imported(seat, box(0.9995, 0.9995, 1, 1.5), **WEIGHED).bodies) == 2
    with pytest.raises(DrawingError, match=r"2\.3\d* mm deep"):
        imported(seat, box(0.998, 0.998, 1, 1.5), **WEIGHED)


def test_a_turned_bond_closes_without_overlaps():
    turn = np.exp(-1j * pi / 60)

    def brick(i, j):
        z = turn * (np.array([0, 0.25, 0.25 + 0.06j, 0.06j]) + 0.26 * i + 0.13 * (j % 2) + 0.07j * j)
        return ArcRing(z, np.zeros(4))

    rings = [brick(i, j) for j in range(6) for i in range(10)]
    closed = close_gaps(rings, [], 0.010, 1e-3).rings
    bricks = [DrawnBody(ring, [WALL], name=f"b{k + 1}") for k, ring in enumerate(closed)]
    frame = DrawingFrame(1.0, 0j, 1e-3, "drawn.dxf")
    check_overlaps(bricks, [], frame)
    with pytest.raises(DrawingError, match=r"b2 and b60 overlap by 0\.0169 m2"):
        check_overlaps([*bricks[:59], DrawnBody(closed[1], [WALL], name="b60")], [], frame)


def test_a_gap_is_not_closed_across_a_third_body():
    found = imported(box(0, 0, 1, 0.5), box(0, 0.51, 1, 0.03), box(0, 0.55, 1, 0.5), merge_gap=0.06)
    heights = [sorted({y for _, y in block["polygon"]}) for block in found.fields["blocks"].values()]
    assert heights == [[0, 0.505], [0.505, 0.545], [0.545, 1.05]]


def test_a_gap_above_the_ground_is_closed_by_the_body_alone():
    found = imported(box(0, 0.008, 1, 1), line((-1, 0), (2, 0), "TERRENO"), merge_gap=0.012)
    assert found.kind == "rigid_body" and {y for _, y in found.fields["polygon"]} == {-0.008, 1.0}


def test_a_gap_wider_than_mortar_is_refused(tmp_path):
    (tmp_path / "a.csv").write_text("0,0\n1,0\n1,3\n0,3\n")
    with pytest.raises(InputError, match=r"12 is outside the supported range: 0 to 0.2 m"):
        rk.import_drawing(tmp_path / "a.csv", units="m", merge_gap=12)
    stepped = outline([(0, 0), (1, 0), (1, 0.05), (0.9, 0.15), (0.9, 1), (0, 1)])
    with pytest.raises(DrawingError, match="crosses itself once its gaps are closed"):
        imported(stepped, box(1.15, 0, 1, 0.05), merge_gap=0.2)


def test_bodies_may_have_the_names_of_the_ground():
    stones = [box(0, 0, 1, 1), box(0, 1, 1, 1)]
    found = imported(*stones, labels=[text("floor", 0.5, 0.5), text("ground", 0.5, 1.5)])
    assert [*found.fields["blocks"]] == ["floor-2", "ground-2"] and "floor" in found.fields["ground"]


def test_outlines_at_other_heights_and_arcs_at_the_edge_of_the_drawing():
    assert "up to 55 m apart in z" in words(imported(WALL, box(0, 2.4, 0.6, 1, heights=(55.0, 55.0))))
    assert "apart in z" not in words(imported(WALL))
    (hung,) = imported(outline([(1, 0), (3, 0), (3, 2), (1, 2)], bulges=[0, 0, 0, 0.1]), **WEIGHED).bodies
    assert hung.ring.z.real.min() == pytest.approx(0.1, abs=2e-5)  # the arc reaches x = 0, its corners do not


def test_a_size_on_paper_taken_as_real_is_said(tmp_path):
    file = tmp_path / "pillar.svg"
    file.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="210mm" height="297mm" viewBox="0 0 210 297">'
        '<g id="STONES"><rect x="50" y="40" width="60" height="240"/></g></svg>'
    )
    said = " ".join(note.words for note in rk.import_drawing(file, units="mm").notes)
    assert "the size on paper (if it is drawn to a scale, give `scale`)" in said
    assert "y upwards from the upper edge" in said
    scaled = rk.import_drawing(file, scale="1:10")
    assert "if it is drawn to a scale" not in " ".join(note.words for note in scaled.notes)


def test_without_shapely_the_package_to_install_is_named(monkeypatch, tmp_path):
    (tmp_path / "a.csv").write_text("0,0\n1,0\n1,3\n0,3\n")
    monkeypatch.setitem(sys.modules, "shapely", None)
    with pytest.raises(InputError, match="needs the package shapely") as caught:
        rk.import_drawing(tmp_path / "a.csv", units="m")
    assert "rocking-cli[drawing]" in str(caught.value)


def test_more_than_a_structure_file_holds_is_refused_at_once(monkeypatch):
    for limit in ("MAX_BODIES", "MAX_CORNERS"):
        monkeypatch.setattr(outlines, limit, 20)
    many = [box(0.01 * k, 0, 0.009, 1) for k in range(21)]
    round_ = np.exp(2j * pi * np.arange(21) / 21)
    for drawn, what in ((many, "21 outlines"), ([outline([(z.real, z.imag) for z in round_])], "21 corners")):
        with pytest.raises(DrawingError, match=what) as caught:
            imported(*drawn)
        assert caught.value.refused == "too_large"


def test_lines_across_one_another_and_outlines_about_one_centre_are_refused_at_once():
    ends = np.exp(2j * np.pi * np.random.default_rng(1).random((700, 2)))
    with pytest.raises(DrawingError, match="too many of its 700 lines lie across one another") as caught:
        imported(*(line((a.real, a.imag), (b.real, b.imag)) for a, b in ends))
    assert caught.value.refused == "too_large"
    with pytest.raises(DrawingError, match="lies within"):
        imported(*(box(0.001 * k, 0.001 * k, 9 - 0.002 * k, 9 - 0.002 * k) for k in range(300)))


def test_so_many_open_lines_that_they_are_not_searched_are_asked_about(monkeypatch):
    monkeypatch.setattr(outlines, "MAX_MEETING", 40)
    lines = [line((k, 0), (k + 0.5, 1), "RILIEVO") for k in range(41)]
    with pytest.raises(DrawingError, match="RILIEVO"):
        imported(WALL, *lines)
    assert "left out" in words(imported(WALL, *lines[:20]))


def test_a_ring_is_the_same_wherever_its_sides_are_cut():
    cut = ArcRing(np.array([2 + 2j, 1 + 2j, 2j, 0, 1, 2]), np.zeros(6))
    assert cut.tidied(1e-3).z.tolist() == [0, 2, 2 + 2j, 2j]
