"""Meshes as structures: against closed forms, in every pose, and what is refused or said."""

import json
import re
from math import atan, cos, radians, sqrt
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import rocking_cli as rk
from rocking_cli.cli.main import main
from rocking_cli.core.polygons import fault_of
from rocking_cli.io.drawings.contract import DrawingError, MeshSurface
from rocking_cli.questions.import_mesh import solid
from rocking_cli.questions.import_mesh.options import MeshOptions
from rocking_cli.questions.import_mesh.picture import MAX_DRAWN, draw_compass, drawn_triangles, scene
from rocking_cli.questions.import_mesh.solid import settled
from rocking_cli.questions.import_mesh.study import imported
from rocking_cli.questions.import_mesh.view import data, sentences
from tests.browser import launch, opened
from tests.meshes import box, extruded, inwards, obj, ply, several, stl, turned, upright

STATUE = box((0.0, 0.0, 0.0), (0.6, 0.8, 2.4))
PRISM = upright([(0.0, 0.0), (1.0, 0.0), (0.5, sqrt(3) / 2)], 2.0)
ELL = extruded([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0), (0.5, 3.0), (0.0, 3.0)], 0.7)
HOLLOW = several(STATUE, inwards(box((0.1, 0.1, 0.4), (0.4, 0.4, 0.7))))


def taken(mesh, azimuths=(), **options):
    options = MeshOptions(**{"units": "m", "density": 2000.0, **options})
    return imported(MeshSurface("OBJ", *mesh), "a.obj", options, azimuths)


def lambdas(mesh, **options):
    return [row.lambda_ for row in taken(mesh, (0, 90, 180, 270), **options).azimuths]


def kinds(found):
    return {note.kind: note.count for note in found.notes}


def refusal(mesh, **options):
    with pytest.raises(DrawingError) as caught:
        taken(mesh, **options)
    return caught.value


def test_a_box_in_four_directions():
    found = taken(STATUE, (0, 30, 60, 90))
    expected = [0.25, 0.28867513, 0.38490018, 0.33333333]
    assert [row.lambda_ for row in found.azimuths] == pytest.approx(expected, abs=5e-9)
    assert [row.edge.phi_cr for row in found.azimuths] == pytest.approx(2 * [0.24497866] + 2 * [0.32175055], abs=5e-9)
    assert [row.edge.p for row in found.azimuths] == pytest.approx(2 * [2.4384739] + 2 * [2.4113540], abs=5e-8)
    assert [row.drive for row in found.azimuths] == pytest.approx([1, cos(radians(30)), cos(radians(30)), 1])
    assert (found.mass, found.weakest.azimuth) == (pytest.approx(2000 * 0.6 * 0.8 * 2.4), 0)
    for row, structure in zip(found.azimuths, found.structures, strict=True):
        block = rk.equiv(structure)
        for side in (block.positive, block.negative):
            assert (side.lambda_, side.phi_cr) == pytest.approx((row.lambda_, row.edge.phi_cr), rel=1e-7)
            assert side.p == pytest.approx(row.edge.p, rel=1e-7)


def test_towards_a_corner_the_weaker_edge_turns():
    corner = float(np.degrees(np.arctan2(0.4, 0.3)))
    (row,) = taken(STATUE, (corner,)).azimuths
    assert (row.edge.c, row.drive) == (pytest.approx(0.3), pytest.approx(0.6))
    assert row.lambda_ == pytest.approx(0.5 / 1.2)


@pytest.mark.parametrize(
    ("mesh", "azimuth", "lambda_", "phi_cr", "p"),
    [
        (PRISM, 270, (0.28867513, 0.57735027), (0.28103490, 0.52359878), 2.64558953),
        (ELL, 0, (0.5, 0.3), (0.46364761, 0.29145679), 2.21570056),
        (HOLLOW, 0, (0.24580454, 0.24777887), (atan(0.24580454), atan(0.24777887)), None),
    ],
)
def test_the_structure_of_a_mesh(mesh, azimuth, lambda_, phi_cr, p):
    (structure,) = taken(mesh, (azimuth,)).structures
    block = rk.equiv(structure)
    assert (block.positive.lambda_, block.negative.lambda_) == pytest.approx(lambda_, abs=2e-7)
    assert (block.positive.phi_cr, block.negative.phi_cr) == pytest.approx(phi_cr, abs=2e-7)
    assert p is None or block.positive.p == pytest.approx(p, abs=2e-7)


def test_the_silhouette_is_what_shows_in_the_plane_of_motion():
    (along, across) = taken(ELL, (0, 90)).structures
    assert along.polygon == [[0.625, 0], [0.625, 1], [0.125, 1], [0.125, 3], [-0.375, 3], [-0.375, 0]]
    assert across.polygon == [[0.35, 0], [0.35, 3], [-0.35, 3], [-0.35, 0]]
    cone = upright([(cos(k), np.sin(k)) for k in np.linspace(0, 2 * np.pi, 60, endpoint=False)], 2.0)
    cone[0][60:, :2] *= 0.001
    z = np.array([complex(*each) for each in taken(cone).structures[0].polygon])
    assert fault_of(z) is None
    assert abs(np.ptp(z.real) - 2) < 0.01
    assert len(z) == 4


TURNS = [((0, 0, 1), 33.0), ((1, 2, 3), 17.0), ((1, 0, 0), 90.0), ((0, 1, 0), 179.0), ((1, 0, 0), 180.0)]


@pytest.mark.every(5)
@pytest.mark.parametrize(("axis", "degrees"), TURNS)
@pytest.mark.parametrize("mesh", [STATUE, HOLLOW, several(STATUE, box((3.0, 0.0, 0.0), (3.01, 0.02, 0.01)))])
def test_a_turned_mesh_gives_a_turned_table(mesh, axis, degrees):
    """About z, azimuths turn; about another axis, `settle` lays the mesh down on the side that points downwards."""
    moved = turned(mesh, axis, degrees)
    moved = moved[0] + np.array([3.0, -2.0, 5.0]), moved[1]
    if axis == (0, 0, 1):
        before, after = taken(mesh, range(0, 360, 15)), taken(moved, [k + degrees for k in range(0, 360, 15)])
        for one, other in zip(before.azimuths, after.azimuths, strict=True):
            assert (other.lambda_, other.drive) == pytest.approx((one.lambda_, one.drive), rel=1e-9)
            assert (other.edge.phi_cr, other.edge.p) == pytest.approx((one.edge.phi_cr, one.edge.p), rel=1e-9)
        return
    found = taken(moved, settle=True)
    down = turned((np.eye(3), None), axis, degrees)[0][:, 2]
    assert found.turned == pytest.approx(np.degrees(np.arccos(np.abs(down).max())), abs=1e-6)
    assert found.whole.volume == pytest.approx(taken(mesh).whole.volume)
    assert fault_of(np.array([complex(*each) for each in found.structures[0].polygon])) is None
    if not kinds(found).get("cavities"):
        lies = degrees == 90  # on a side of .6 x 2.4 m
        assert found.height == pytest.approx(0.4 if lies else 1.2)
        ways = [0.3, 0.3, 1.2, 1.2] if lies else [0.3, 0.3, 0.4, 0.4]
        assert sorted(each.c for each in found.edges) == pytest.approx(ways)
        assert lies or sorted(each.p for each in found.edges) == pytest.approx(2 * [2.411354] + 2 * [2.4384739])


def test_far_from_the_origin_in_single_precision():
    for away in (1000.0, 3000.0):
        far = STATUE[0] + np.array([away, 2 * away, 0.0])
        rounded = np.float32(far).astype(float), STATUE[1]
        assert lambdas(rounded) == pytest.approx(lambdas(STATUE), rel=1e-3 if away > 1000 else 2e-4)
    single = [((STATUE[0] + away).astype(np.float32), STATUE[1]) for away in (1000.0, 1e4, 1e6)]
    assert kinds(taken(single[0])) == {}
    (note,) = taken(single[1], level=0.01).notes
    assert "rounds its coordinates to 0.6 mm, 0.025 % of the size" in note.words
    assert refusal(single[2]).refused == "number"
    exact = STATUE[0] + np.array([4e6, 5e6, 100.0]), STATUE[1]
    assert lambdas(exact) == pytest.approx(lambdas(STATUE), rel=1e-7)


def test_axes_units_and_corners_that_are_not_shared(tmp_path):
    upwards = STATUE[0][:, [0, 2, 1]] * np.array([1, 1, -1]) * 1000.0, STATUE[1]  # y is up, millimetres
    assert lambdas(upwards, up="y", units="mm") == pytest.approx(lambdas(STATUE))
    for name, content in (("a.stl", stl(STATUE)), ("a.ply", ply(STATUE, "binary_little_endian"))):
        (tmp_path / name).write_bytes(content)
        found = rk.import_mesh(tmp_path / name, units="m", azimuth=[0, 90, 180, 270])
        assert [row.lambda_ for row in found.azimuths] == pytest.approx(lambdas(STATUE), rel=1e-6)
        assert len(found.points) == 8


def test_seams_and_shells_are_one_body():
    soup = STATUE[0][STATUE[1]].reshape(-1, 3), np.arange(36).reshape(-1, 3)
    assert lambdas(soup) == pytest.approx(lambdas(STATUE))
    stacked = several(box((0, 0, 0), (0.6, 0.8, 1.0)), inwards(box((0.1, 0.1, 1.0), (0.5, 0.7, 2.4))))
    found = taken(stacked)
    assert kinds(found) == {"parts": 1, "turned": 1, "glued": 1}
    assert found.whole.volume == pytest.approx(0.48 + 0.336)


def test_cavities_crumbs_and_surfaces_that_face_inwards():
    assert kinds(taken(HOLLOW)) == {"cavities": 1}
    assert kinds(taken(inwards(HOLLOW))) == {"cavities": 1, "turned": 2}
    assert lambdas(inwards(HOLLOW)) == pytest.approx(lambdas(HOLLOW))
    wrong = several(STATUE, inwards(inwards(box((0.1, 0.1, 0.4), (0.4, 0.4, 0.7)))))
    assert kinds(taken(wrong)) == {"within": 1}
    assert lambdas(wrong) == pytest.approx(lambdas(STATUE))
    crumbs = several(box((2, 0, 0), (2.01, 0.01, 0.01)), STATUE, inwards(box((-1, 0, 0), (-0.99, 0.02, 0.01))))
    found = taken(crumbs)
    assert kinds(found) == {"crumbs": 2}
    assert found.notes[0].words == "2 crumbs are left out, 3e-06 m3"
    assert lambdas(crumbs) == pytest.approx(lambdas(STATUE))
    lump = several(HOLLOW, box((0.2, 0.2, 0.5), (0.3, 0.3, 0.6)))  # lies in the cavity
    assert kinds(taken(lump)) == {"cavities": 1, "crumbs": 1}


def test_faces_drawn_twice_count_once_and_points_without_faces_are_counted():
    points, triangles = STATUE
    found = taken((np.vstack([points, [[0.1, 0.1, 0.1]]]), np.concatenate([triangles, np.roll(triangles, 1, axis=1)])))
    assert (kinds(found), found.whole.volume) == ({"again": 12, "loose": 1}, pytest.approx(0.6 * 0.8 * 2.4))
    assert refusal((points, np.concatenate([triangles, triangles[:, ::-1]]))).refused == "thin"


def test_a_surface_drawn_in_both_senses_is_refused():
    twice = several(STATUE, *(turn(box((3.0, 0.0, 0.0), (4.0, 1.0, 1.0))) for turn in (tuple, inwards)))
    assert "two of its surfaces lie on each other" in str(refusal(twice))


def stack(*boxes):
    """Solids of given widths [m], from below, .8 m deep, 1 m high, all with their left side at x = 0."""
    return several(*(box((0.0, 0.0, k), (wide, 0.8, k + 1.0)) for k, wide in enumerate(boxes)))


@pytest.mark.parametrize(("mesh", "words"), [
    (stack(0.6, 0.4), "1 part rests on another and counts as glued to it: alone, it would have lambda = 0.4 (0.32 m3 "
     "from 1 m above the ground)"),  # .2/.5
    (stack(0.6, 0.6), "it would have lambda = 0.6 (0.48 m3 from 1 m above the ground)"),  # of shared corners and sides
    (stack(0.6, 0.4, 0.4), "2 parts rest on others and count as glued to them: the weakest alone, with all it carries, "
     "would have lambda = 0.2 (0.64 m3 from 1 m above the ground)"),  # .2/1
    (stack(0.6, 0.2, 0.6), "2 parts rest on others and count as glued to them: the weakest alone, with all it carries, "
     "would not stand (0.64 m3"),  # on .2 m, with its centre of mass at .25 m
    (several(box((0, 0, 0), (0.4, 0.8, 1)), box((2, 0, 0), (2.4, 0.8, 1)), box((0, 0, 1), (2.4, 0.8, 1.5))),
     "lambda = 1.6 (0.96 m3"),  # a lintel, .4/.25 across
    (several(stack(0.6), box((0.0, 0.0, 1.01), (0.4, 0.8, 2.01))), None),
    (several(stack(0.6, 0.6), inwards(box((0.1, 0.1, 1.1), (0.5, 0.7, 1.5)))),
     f"lambda = {0.3 / ((0.48 * 0.5 - 0.096 * 0.3) / 0.384):.3g} (0.384 m3"),  # the upper one is hollow
])  # fmt: skip
def test_solids_that_rest_on_each_other_are_glued_and_the_upper_one_is_told(mesh, words):
    """lambda of a box alone is half its width over half its height, whatever carries it."""
    for moved, options in ((mesh, {}), (inwards(mesh), {}), (turned(mesh, (0, 1, 0), 3.0), {"settle": True})):
        found = taken(moved, **options)
        said = [note.words for note in found.notes if note.kind == "glued"]
        assert len(said) == (words is not None)
        assert words is None or words in said[0]
        assert ("parts" in kinds(found)) is bool(len(mesh[0]) > 8)
        assert found.whole.volume == pytest.approx(solid.moments(*mesh).volume)


def test_shells_may_touch_but_not_cross():
    for x, crosses in ((0.0, False), (1e-6, False), (1e-3, True)):
        brick = box((0.5 - x, 0.0, 1.0 - x), (1.0, 0.7, 2.0))  # lies in the notch
        if crosses:
            found = refusal(several(ELL, brick))
            assert found.refused == "shells"
            assert "two of its surfaces cross: one is partly inside the other, at (" in str(found)
            assert 0.499 <= found.at[0][0] <= 1
        else:
            assert kinds(taken(several(ELL, brick))) == {"parts": 1, "glued": 1}
    for bar in (box((-1, 0.1, 1), (2, 0.4, 1.3)), box((0.3, 0.2, 0), (1, 0.6, 1))):
        assert refusal(several(STATUE, bar)).refused == refusal(several(STATUE, inwards(bar))).refused == "shells"


def test_open_surfaces_are_refused_with_their_holes():
    points, triangles = STATUE
    found = refusal((points, triangles[:-2]))  # without the top
    assert found.refused == "open"
    assert "its surface is not closed: 4 loose sides, the largest hole 0.8 x 0.6 m" in str(found)
    assert refusal((points, triangles[1:])).at
    over = triangles.copy()
    over[0] = over[0, ::-1]
    assert "3 edges join triangles that face opposite ways" in str(refusal((points, over)))
    assert refusal((points, triangles[:0])).refused == "open"
    assert "cloud of 8 points" in str(refusal((points, triangles[:0])))
    assert refusal((points * [1, 1, 0], triangles)).refused == "thin"
    hull = taken((points, triangles[:0]), hull=True)
    assert kinds(hull) == {"hull": 1}
    assert [each.c for each in hull.edges] == pytest.approx([each.c for each in taken(STATUE).edges])
    assert "weighs 25 % more" in taken(ELL, hull=True).notes[0].words  # 2.5 m2 in place of 2


def test_a_body_that_does_not_stand_is_told_how_far_it_is_from_its_facet():
    tilted = turned(STATUE, (1, 1, 0), 1.5)
    found = refusal(tilted)
    assert found.refused == "point"
    assert "stands on one point within 1 mm of the ground, 1.50 degrees from a facet" in str(found)
    assert refusal(turned(STATUE, (0, 1, 0), 1.5)).refused == "point"  # a line
    settled = taken(tilted, settle=True)
    assert settled.turned == pytest.approx(1.5)
    leaning = extruded([(0.0, 0.0), (0.5, 0.0), (2.5, 3.0), (2.0, 3.0)], 1.0)
    found = refusal(leaning)
    assert found.refused == "falls"
    assert "its centre of mass is not above its foot within 1 mm of the ground, but 0.75 m beside it" in str(found)
    assert taken(leaning, settle=True).turned == pytest.approx(np.degrees(np.arctan2(3, 2)))


def test_the_level_rules_lambda_and_is_tabled():
    """A foot of four points on a rim that is 4 mm higher: at 2 mm a square of .2 m, at 5 mm one of .6 m."""
    inner, rim = [(0.2, 0.2), (0.4, 0.2), (0.4, 0.4), (0.2, 0.4)], [(0, 0), (0.6, 0), (0.6, 0.6), (0, 0.6)]
    points = np.array([(*p, z) for ring, z in ((inner, 0.0), (rim, 0.004), (rim, 2.0)) for p in ring])
    walls = [each for low in (0, 4) for k in range(4) for j in [(k + 1) % 4]
             for each in ((low + k, low + j, low + 4 + j), (low + k, low + 4 + j, low + 4 + k))]  # fmt: skip
    mesh = points, np.array([(0, 2, 1), (0, 3, 2), (8, 9, 10), (8, 10, 11), *walls])
    found = taken(mesh)
    ways = [row.lambda_ * found.height for row in found.levels]
    assert ways == pytest.approx([0.1, 0.1, 0.1, 0.3, 0.3, 0.3])
    assert (found.weakest.c, taken(mesh, level=0.005).weakest.c) == pytest.approx((0.1, 0.3))
    assert [row.level for row in found.levels] == [0, 0.001, 0.002, 0.005, 0.01, 0.02]


def test_a_resting_facet_that_is_a_sliver_has_the_turn_of_its_face():
    """Two points 2 micrometres apart stand out of the bottom by rounding, so that slivers lie below the centre."""
    points, triangles = STATUE
    more = [[0.3, 0.4, -3e-8], [0.300002, 0.4, -3e-8]]
    sides = [each for each in triangles.tolist() if (points[each][:, 2] > 0).any()]
    fan = [(8, 0, 2), (9, 6, 4), (8, 2, 9), (9, 2, 6), (9, 4, 8), (8, 4, 0)]
    mesh = np.vstack([points, more]), np.array([*sides, *fan])
    found = taken(turned(mesh, (1, 0.3, 0), 2.0), settle=True)
    assert found.turned == pytest.approx(2.0, abs=1e-4)
    assert sorted(each.c for each in found.edges) == pytest.approx([0.3, 0.3, 0.4, 0.4], rel=1e-5)


def test_hulls_take_time_as_their_points_and_are_bounded(monkeypatch):
    """A rim of many corners took minutes by the usual way of joining faces in one plane."""
    rim = 0.5 * np.exp(2j * np.pi * np.arange(10_000) / 10_000)
    drum = np.array([(z.real, z.imag, h) for h in (0.0, 2.0) for z in rim])
    points, triangles, planes = solid.hull_of(drum, "")
    whole = solid.moments(points, triangles)
    assert (whole.volume, settled(planes, whole.centroid)[1]) == pytest.approx((np.pi / 2, 0), rel=1e-6, abs=1e-9)
    for limit in ("MAX_HULL_POINTS", "MAX_HULL_CORNERS"):
        with monkeypatch.context() as patch:
            patch.setattr(solid, limit, 10)
            assert refusal((drum[::500], np.zeros((0, 3), int)), hull=True).refused == "too_large"


def test_round_feet_are_said_to_roll():
    drum = upright([(cos(k), np.sin(k)) for k in np.linspace(0, 2 * np.pi, 24, endpoint=False)], 2.0)
    found = taken(drum)
    assert "The foot has 24 sides: a body on a round foot rolls, which is not modelled." in sentences(found)
    assert not [each for each in sentences(taken(STATUE)) if "round foot" in each]


class TestFiles:
    @pytest.fixture(autouse=True)
    def folder(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        Path("statue.obj").write_bytes(obj(STATUE))

    def test_the_file_of_an_azimuth_is_a_structure(self):
        answer = rk.import_mesh("statue.obj", units="m", density=2000.0, azimuth="30", out="a.yaml")
        text = Path("a.yaml").read_text("utf-8").replace("\n# ", " ")
        assert "rocking towards 30 degrees, by: rk.import_mesh SHA-256" in text
        assert re.search(r"SHA-256 of the mesh: [0-9a-f]{64} ", text)
        assert "Not modelled: rolling from one edge to the next" in text
        found = rk.equiv("a.yaml")
        assert found.positive.lambda_ == pytest.approx(0.28867513, abs=1e-8)
        assert answer.to_dict()["written"] == ["a.yaml"]
        assert rk.draw("a.yaml").sketch.outlines["body"]

    def test_the_file_names_the_command_that_made_it(self):
        words = "statue.obj --azimuth 30 --level 2mm --settle --units m --density 2000"
        done = CliRunner().invoke(main, ["import", *words.split(), "-o", "c.yaml"])
        assert done.exit_code == 0
        assert f"by: rocking import {words}\n" in Path("c.yaml").read_text("utf-8").replace("\n# ", " ", 1)

    def test_several_azimuths_have_a_file_each(self):
        given = {"units": "m", "density": "2 t/m3", "level": "2mm"}
        answer = rk.import_mesh("statue.obj", azimuth="0:350:10", out="s.yaml", **given)
        assert (answer.options.density, answer.options.level) == (2000.0, 0.002)
        names = sorted(path.name for path in Path().glob("s-*.yaml"))
        assert (len(names), names[:2], names[-1]) == (36, ["s-000.yaml", "s-010.yaml"], "s-350.yaml")
        assert rk.equiv("s-090.yaml").positive.lambda_ == pytest.approx(1 / 3, rel=1e-7)

    def test_units_are_needed_and_told_with_the_sizes(self):
        with pytest.raises(DrawingError) as caught:
            rk.import_mesh("statue.obj")
        assert caught.value.refused == "units"
        assert "(it is 2.4 units large: 0.0024 m if mm, 0.024 m if cm, 2.4 m if m)" in str(caught.value)

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            ({"units": "foot"}, "`units` must be one of m, mm"),
            ({"density": -1.0}, "`density` must be above 0"),
            ({"level": "-1 mm"}, "`level`: '-1 mm' is not positive"),
            ({"azimuth": "north"}, "`azimuth` is not a direction: 'north'"),
            ({"azimuth": "90:0:10"}, "'90:0:10' is not increasing"),
            ({"azimuth": "0:350:0.01"}, "has more than 720 directions"),
            ({"azimuth": "inf"}, "or not finite ones"),
        ],
    )
    def test_wrong_arguments_are_refused_by_name(self, options, words):
        with pytest.raises(rk.InputError) as caught:
            rk.import_mesh("statue.obj", **{"units": "m", "density": 1.0, **options})
        assert words in str(caught.value)

    def test_a_name_with_line_breaks_stays_in_the_comment(self):
        name = "a\nmass: 1.obj"
        Path(name).write_bytes(obj(STATUE))
        rk.import_mesh(name, units="m", density=2000.0, out="n.yaml")
        assert rk.equiv("n.yaml").positive.lambda_ == pytest.approx(0.25)
        assert "\nmass: 1.obj" not in Path("n.yaml").read_text("utf-8")

    @pytest.mark.rest
    def test_the_page_turns_the_body(self):
        rk.import_mesh("statue.obj", units="m", density=2000.0, page="p.html")
        browser, driver = launch()
        try:
            with opened(browser, Path("p.html").resolve(), color_scheme="dark") as page:
                before = page.evaluate("document.getElementById('body').toDataURL()")
                page.focus("#body")
                page.keyboard.press("ArrowLeft")
                page.wait_for_timeout(100)
                assert page.evaluate("document.getElementById('around').value") == "-25"
                assert page.evaluate("document.getElementById('body').toDataURL()") != before
                page.set_viewport_size({"width": 390, "height": 800})
                assert page.evaluate("document.documentElement.scrollWidth") == 390
        finally:
            browser.close()
            driver.stop()


def test_a_page_draws_few_triangles_of_a_large_mesh():
    n = 120
    ring = np.exp(2j * np.pi * np.arange(n) / n)
    points = np.array([(z.real, z.imag, h) for h in np.linspace(0, 3, n) for z in ring])
    cells = [(k * n + j, k * n + (j + 1) % n) for k in range(n - 1) for j in range(n)]
    sides = [each for a, b in cells for each in ((a, b, b + n), (a, b + n, a + n))]
    top = (n - 1) * n
    caps = [each for k in range(1, n - 1) for each in ((0, k + 1, k), (top, top + k, top + k + 1))]
    found = taken((points, np.array([*sides, *caps])))
    few, triangles = drawn_triangles(found)
    assert 1000 < len(triangles) <= MAX_DRAWN < len(found.triangles)
    assert np.ptp(few, axis=0) == pytest.approx(np.ptp(found.points, axis=0), rel=0.05)
    assert len(json.dumps(scene(found))) < 300_000
    assert json.loads(json.dumps(data(found)))["edges"]


@pytest.mark.drawn
def test_the_compass_is_the_foot_over_the_height():
    found = taken(ELL, (0, 45))
    (axes,) = draw_compass(found, "ell").axes
    (foot,) = [patch for patch in axes.patches if len(patch.get_xy()) == 5]
    corners = np.unique(np.round(foot.get_xy(), 9), axis=0)
    assert corners == pytest.approx(np.array([(-0.3, -0.28), (-0.3, 0.28), (0.5, -0.28), (0.5, 0.28)]))
    (axes,) = draw_compass(found, "ell", north=0.0).axes  # the x axis points upwards
    (foot,) = [patch for patch in axes.patches if len(patch.get_xy()) == 5]
    assert foot.get_xy()[:, 1].max() == pytest.approx(0.5)
    assert {"N", "E", "S", "W", "x, 0°"} <= {each.get_text() for each in axes.texts}
