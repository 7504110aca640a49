"""Structures from drawings: check values that follow by hand, refusals with their places, and mended faults."""

from functools import cache
from math import atan, cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine
from rocking_cli.questions.import_drawing.legend import role_of
from rocking_cli.questions.import_drawing.rings import ArcRing
from tests.conftest import EXAMPLES
from tests.questions.import_drawing.sheets import (
    box,
    criticals,
    imported,
    lambdas,
    line,
    outline,
    sides,
    spot,
    text,
    words,
)

ROUND_TOP = outline([(0, 0), (1, 0), (1, 3), (0, 3)], bulges=[0, 0, 1, 0])
ROUND_CORNER = outline([(0, 0), (1.5, 0), (1.5, 2), (0.5, 3), (0, 3)], bulges=[0, 0, tan(pi / 8), 0, 0])
PORTAL = (box(0, 0, 0.8, 3), box(3.2, 0, 0.8, 3), box(0, 3, 4, 0.6))


def voussoir(k, layer="CONCI"):
    """Return one of Oppenheim's seven voussoirs from the left, with its arcs."""
    a, b = (radians(168.75 - 22.5 * j) for j in (k, k + 1))
    t = tan(radians(22.5) / 4)
    z = np.array([10.75 * np.exp(1j * a), 9.25 * np.exp(1j * a), 9.25 * np.exp(1j * b), 10.75 * np.exp(1j * b)])
    return DrawnLine(z, np.array([0, -t, 0, t]), True, layer, "LWPOLYLINE")


def springing(degrees, layer="TERRENO"):
    a = radians(degrees)
    z = np.array([9.1 * np.exp(1j * a), 10.9 * np.exp(1j * a)])
    down = 0.5j * np.exp(1j * a) * (1 if degrees > 90 else -1)
    return DrawnLine(np.append(z, z[::-1] + down), np.zeros(4), True, layer, "LWPOLYLINE")


@cache
def oppenheims_arch():
    chains = *map(voussoir, range(7)), springing(168.75), springing(11.25)
    return imported(*chains, density={"": 2400.0}, depth=1.0)


class TestCheckValues:
    """Closed forms, found without this code."""

    @pytest.mark.parametrize(
        ("chains", "options", "area", "lambda_", "phi_cr"),
        [
            ([box(0, 0, 0.6, 2.4)], {}, 1.44, (0.25, 0.25), (0.24497866, 0.24497866)),
            ([ROUND_TOP], {}, 3.392699082, (0.294432002, 0.294432002), (0.286340744, 0.286340744)),
            ([ROUND_CORNER], {}, 4.285398163, (0.540623129, 0.503894553), (0.49561558, 0.46675840)),
            ([box(0, 0, 2, 4), box(1, 1.8, 0.8, 1.2, "FINESTRE")], {}, 7.04, (0.54205607, 0.48598131),
             (0.49672378, 0.45236989)),
            ([box(0, 0, 0.3, 3, "PIETRA"), box(0.3, 0, 0.5, 3, "MATTONE")],
             {"density": {"PIETRA": 2200.0, "MATTONE": 1400.0}, "kind": "rigid_body"}, 2.4,
             (0.29607843, 0.23725490), (0.28785515, 0.23294778)),
            ([box(0, 0.21 * k, 0.4, 0.2) for k in range(5)], {"merge_gap": 0.012}, 0.416, (0.38461538, 0.38461538),
             (0.36717383, 0.36717383)),
        ],
        ids=["block", "round top", "round corner", "window", "leaves", "mortar"],
    )  # fmt: skip
    def test_area_lambda_and_phi_cr(self, chains, options, area, lambda_, phi_cr):
        found = imported(*chains, **options)
        assert sum(body.moments.area for body in found.bodies) == approx(area, rel=1e-9)
        assert lambdas(found) == approx(lambda_, rel=1e-6)
        assert criticals(found) == approx(phi_cr, rel=1e-6)

    def test_inertia_of_the_straightened_body(self):
        for chain, p in ((ROUND_TOP, 2.03793361), (box(0, 0, 0.6, 2.4), 2.4384739)):
            structure = imported(chain).structure
            (body,) = structure.bodies()
            arm = abs(body.centroid - structure.feet()[1])
            assert sqrt(9.80665 * arm / (arm**2 + body.inertia / body.mass)) == approx(p, rel=1e-6)

    def test_a_slope(self):
        turn = np.exp(-1j * radians(5))
        block = outline([((z * turn).real, (z * turn).imag) for z in (0, 0.6, 0.6 + 2.4j, 2.4j)])
        t = tan(radians(5))
        found = imported(block, line((-1, t), (2, -2 * t), "TERRENO"))
        assert found.kind == "assembly"
        assert lambdas(found) == approx([0.15903294, 0.34503533], rel=1e-6)
        assert criticals(found) == approx([0.15771220, 0.33224513], rel=1e-6)

    def test_a_running_bond(self):
        bricks = []
        for row in range(7):
            starts = [(0.0, 0.25), (0.26, 0.25), (0.52, 0.25), (0.78, 0.23)]
            if row % 2:
                starts = [(0.0, 0.12), (0.13, 0.25), (0.39, 0.25), (0.65, 0.36)]
            bricks += [box(x, 0.06 * row, width, 0.05) for x, width in starts]
        found = imported(*bricks, merge_gap=0.012)
        assert sum(body.moments.area for body in found.bodies) == approx(1.01 * 0.41, rel=1e-9)
        assert lambdas(found) == approx([1.01 / 0.41] * 2, rel=1e-6)
        assert criticals(found) == approx([atan(1.01 / 0.41)] * 2, rel=1e-6)

    def test_oppenheims_voussoirs_as_arcs(self):
        found = oppenheims_arch()
        for body in found.bodies:
            assert body.moments.area == approx(5.890486225, rel=1e-9)
            assert body.moments.polar == approx(8.661749669, rel=1e-9)
        arch = rk.load_structure(EXAMPLES / "arch.yaml")
        assert lambdas(found) == approx([arch.uplift(direction) for direction in Direction], rel=1e-5)


def moments_by_parts(ring):
    """Return area, centroid and polar moment of a ring by those of the polygon of its corners and of each segment."""
    z, w = ring.z, np.roll(ring.z, -1)
    cross = (z.conj() * w).imag
    parts = [(cross / 2, cross / 6 * (z + w), cross / 12 * (abs(z) ** 2 + abs(w) ** 2 + (z.conj() * w).real))]
    for start, end, b in zip(z, w, ring.bulges, strict=True):
        if b:
            t, away = 4 * np.arctan(abs(b)), -1j * (end - start) / abs(end - start) * np.sign(b)
            r = abs(end - start) / 2 / sin(t / 2)
            centre, area = (start + end) / 2 - away * r * cos(t / 2), r**2 / 2 * (t - sin(t))
            along = 2 / 3 * (r * sin(t / 2)) ** 3
            polar = r**4 / 4 * (t - sin(t) * (2 + cos(t)) / 3) + 2 * along * (away.conjugate() * centre).real
            polar += area * abs(centre) ** 2
            parts.append(np.sign(b) * np.array([area, area * centre + along * away, polar]))
    area, first, polar = (sum(np.sum(part[k]) for part in parts) for k in range(3))
    return area.real, first / area, polar.real - area.real * abs(first / area) ** 2


def test_layers_say_their_roles_in_singular_and_plural():
    roles = {"LOAD": "loads", "LOADS": "loads", "HOLES": "openings", "LASTRE_FORI-2": "openings", "SOILS": "ground",
             "TIE": "ties", "Caténe": "ties", "TEXTS": "nothing", "BLOCKS": "bodies", "PROPERTIES": None, "0": None,
             "DOWNLOADS": None, "Élévation PIERRE": "bodies", "MURATURA_ESTERNA": "bodies",
             "MURATURA RINFORZATA": "bodies", "Background": None, "TESTIMONE": None, "SANDSTONE": "bodies",
             "MURO INCATENATO": "bodies", "INCATENATO": None, "CATENE_2": "ties"}  # fmt: skip
    assert {name: role_of(name) for name in roles} == roles


def test_a_flat_arc_adds_two_thirds_of_its_rise():
    ring = ArcRing.of(np.array([0, 2, 2 + 1j, 1j]), np.array([1e-5, 0, 0, 0]))
    assert ring.moments.area - 2 == approx(2 / 3 * 2 * 1e-5, rel=1e-9)


@pytest.mark.parametrize("bulge", [0.01, 1.0, 2.5, -0.3])
def test_moments_are_those_of_corners_and_segments(bulge):
    ring = ArcRing.of(np.array([0, 2, 2.2 + 1.5j, 0.3 + 1.2j]), np.array([0, bulge, 0, bulge / 2]))
    area, centroid, polar = moments_by_parts(ring)
    assert ring.moments.area == approx(area, rel=1e-12)
    assert ring.moments.centroid == approx(centroid, rel=1e-11)
    assert ring.moments.polar == approx(polar, rel=1e-9)
    turned = ArcRing.of(ring.z[::-1], -np.roll(ring.bulges[::-1], -1))
    assert turned.moments.area == approx(ring.moments.area, rel=1e-13)
    far = ArcRing(ring.z + 1.5e6 + 5e6j, ring.bulges)
    assert far.moments.polar == approx(ring.moments.polar, rel=1e-8)
    assert far.moments.centroid - 1.5e6 - 5e6j == approx(ring.moments.centroid, abs=1e-8)
    level = ArcRing(ring.level(), np.zeros(len(ring.level())))
    assert level.moments.area == approx(ring.moments.area, rel=1e-12)
    assert level.moments.polar == approx(ring.moments.polar, rel=2e-6)


class TestLayers:
    def test_a_layer_without_a_role_beside_bodies_is_not_left_out(self):
        with pytest.raises(DrawingError, match="MATTE has no known role") as caught:
            imported(box(0, 0, 1, 1, "PIETRA"), box(0, 1, 1, 1, "MATTE"))
        assert caught.value.refused == "layers"
        found = imported(box(0, 0, 1, 1, "PIETRA"), box(0, 1, 1, 1, "MATTE"), layers={"bodies": ["MATTE"]})
        assert len(found.bodies) == 2
        found = imported(box(0, 0, 1, 1, "PIETRA"), box(0, 1, 1, 1, "MATTE"), layers={"nothing": ["MATTE"]})
        assert len(found.bodies) == 1 and "left out: 1 LWPOLYLINE on MATTE" in words(found)

    def test_lines_that_close_only_with_those_of_another_layer_are_not_left_out(self):
        walls = [box(0, 0, 1, 2, "SPALLE"), box(3, 0, 1, 2, "SPALLE")]
        lintel = [line((0, 2.5), (4, 2.5), "ALTO"), line((0, 2), (0, 2.5), "ALTO"), line((4, 2), (4, 2.5), "ALTO")]
        with pytest.raises(DrawingError, match="ALTO has 1") as caught:
            imported(*walls, *lintel)
        assert caught.value.refused == "layers"
        axes = [line((0.5, -1), (0.5, 3), "A1"), line((3.5, -1), (3.5, 3), "A1"), line((-1, 1), (5, 1), "A1")]
        assert "3 LINE on A1" in words(imported(*walls, *axes))

    def test_the_only_layer_with_outlines_is_taken_and_this_is_said(self):
        found = imported(box(0, 0, 1, 2, "0"), line((0, 3), (1, 3), "ROTTO"))
        assert "the layer 0 alone has outlines" in words(found) and "1 LINE on ROTTO" in words(found)

    def test_an_unknown_layer_is_refused(self):
        with pytest.raises(InputError, match="the drawing has no layer 'CONCI'"):
            imported(box(0, 0, 1, 2, "MURO"), layers={"bodies": ["CONCI"]})


class TestMended:
    def test_lines_and_arcs_that_close_are_exact(self):
        lines = [line((0, 0), (1, 0)), line((1, 3), (1, 0)), line((1, 3), (0, 3), bulge=1), line((0, 3), (0, 0))]
        found = imported(*lines)
        assert found.bodies[0].moments.area == approx(3 + pi / 8, rel=1e-12)

    def test_ends_within_the_closing_distance_are_joined(self):
        lines = [*sides([(0, 0), (0.6, 0.0), (0.6, 2.4), (0, 2.4)])[1:], line((0, 0), (0.6, 0.0008))]
        found = imported(*lines)
        assert "1 corner joined over gaps up to 0.8 mm" in words(found)
        assert lambdas(found) == approx([0.25, 0.25], rel=2e-3)

    def test_what_is_drawn_twice_counts_once(self):
        corners = [(0, 0), (0.6, 0), (0.6, 2.4), (0, 2.4)]
        twice = imported(box(0, 0, 0.6, 2.4), outline(corners[::-1]), *sides(corners))
        assert len(twice.bodies) == 1 and "drawn twice" in words(twice)
        assert twice.fields == imported(box(0, 0, 0.6, 2.4)).fields

    def test_small_overlaps_are_mended(self):
        found = imported(box(0, 0, 0.25, 0.055), box(0, 0.0541, 0.25, 0.055))
        assert "2 sides moved to close gaps or overlaps of 0.9 mm" in words(found)
        assert found.bodies[0].ring.z.imag.max() == approx(0.05455) == found.bodies[1].ring.z.imag.min()


class TestAttached:
    def test_masses_forces_ties_and_supports(self):
        found = imported(
            *PORTAL, line((2, 4.5), (2, 3.6), "CARICHI"), line((0.4, 2.5), (3.6, 0.5), "CATENE"),
            spots=[spot(1, 3.3, "CARICHI")],
            labels=[
                text("roof 3 t", 1, 3.4, "CARICHI"), text("12 kN", 2.05, 4, "CARICHI"),
                text("chain: area 452 mm2, modulus 210 GPa", 2, 2.6, "CATENE"),
            ],
            density={"": 2000.0}, depth=1.0,
        )  # fmt: skip
        mass, force = found.fields["loads"]
        assert mass == {"name": "roof", "mass": "3 t", "at": [1.0, 3.3], "body": "b3"}
        assert force["force"] == approx([0.0, -12000.0]) and force["body"] == "b3" and force["at"] == [2.0, 3.6]
        (tie,) = found.fields["ties"]
        assert tie["name"] == "chain" and tie["area"] == "452 mm2" and tie["modulus"] == "210 GPa"
        assert tie["from"]["body"] == "b1" and tie["to"] == {"body": "b2", "at": [3.6, 0.5]}

    def test_a_tie_without_text_is_a_comment(self):
        found = imported(*PORTAL, line((0.4, 2.5), (3.6, 2.5), "CATENE"))
        (given,) = yaml.safe_load(found.comments[0])["ties"]
        assert given["name"] == "tie 1" and given["to"] == {"body": "b2", "at": [3.6, 2.5]}
        assert "ties" not in found.fields and "it is a comment" in words(found)

    def test_points_on_hinge_layers_make_a_linkage(self):
        wall = [box(-0.15, 0, 0.3, 1.5), box(-0.15, 1.5, 0.3, 1.5), line((0.15, 3), (1, 3), "SOLAIO")]
        sides = (1, "HINGES+"), (-1, "HINGES-")
        hinges = [spot(sign * x, y, layer) for sign, layer in sides for x, y in ((0.15, 0), (-0.15, 1.5))]
        found = imported(*wall, spots=hinges, density={"": 1800.0}, depth=1.0)
        assert found.kind == "linkage"
        assert found.fields["positive"]["joints"]["C"] == {"slide": "b2", "at": [0.3, 3.0], "along": [0.0, 1.0]}
        assert found.structure.uplift(Direction.POSITIVE) == approx(0.4)

    def test_texts_inside_are_names_and_densities(self):
        found = imported(
            box(0, 0, 1, 1), box(0, 1, 1, 1), box(0, 2, 1, 1), depth=1.0,
            labels=[
                text("pier and: left", 0.5, 0.5), text("2200 kg/m3", 0.5, 0.7), text("pier left", 0.5, 1.5),
                text("19 kN/m3", 0.5, 1.8), text("12", 0.5, 2.5), text("18 kN/m3", 0.5, 2.2), text("far", 5, 5),
            ],
        )  # fmt: skip
        assert list(found.fields["blocks"]) == ["pier left", "pier left-2", "b3"]
        assert found.fields["blocks"]["pier left"]["density"] == 2200

    def test_a_density_in_no_body_is_named_where_one_is_missing(self):
        arch = outline([(0, 0), (1, 0), (1, 2), (0, 2)], bulges=[0, 0, 0.2, 0]), box(1, 0, 1, 1)
        beside = text("tufo \u03b3 = 16 kN/m\u00b3", 5, 5), text("16 m", 5, 6)
        with pytest.raises(DrawingError, match=r"`density` and `depth`; a density in no body .* put 'tufo"):
            imported(*arch, labels=beside)
        found = imported(*arch, labels=beside, density={"": 1600.0}, depth=1.0)
        assert [note.count for note in found.notes if note.kind == "density"] == [1]

    def test_open_joints_are_refused_with_their_width(self):
        with pytest.raises(DrawingError, match=r"up to 8\.1 mm apart: give `merge_gap` 8\.1mm"):
            imported(box(0, 0, 1, 1), box(0, 1.00805, 1, 1))
        assert len(imported(box(0, 0, 1, 1), box(0, 1.00805, 1, 1), merge_gap=0.0081).joints) == 2

    def test_curves_are_counted(self):
        curved = outline([(0, 0), (1, 0), (1, 2), (0, 2)], arcs_found=2, is_straightened=True)
        found = imported(curved)
        assert "2 arcs recognised in the curves of the file" in words(found)
        assert "1 curve replaced by straight sides" in words(found)

    def test_a_file_that_no_command_takes_is_refused(self):
        ends = ((-1, -0.1), (0.9, 3.1), (4.1, 5))  # the ground stops beside the piers
        gaps = [line((start, 0), (end, 0), "TERRENO") for start, end in ends]
        with pytest.raises(DrawingError, match=r"does not stand by itself|touch nothing") as caught:
            imported(*PORTAL, *gaps)
        assert caught.value.refused == "mechanism"
        pair = imported(box(0, 0, 1, 3), box(3, 0, 1, 3))  # two columns alike, side by side
        assert "most commands refuse the file as it is" in words(pair) and "several mechanisms start" in words(pair)

    def test_the_origin_is_at_the_lower_left_and_said(self):
        found = imported(box(1.5e9, 5e9, 600, 2400), units="mm")
        assert found.shift == approx(1.5e9 + 5e9j) and found.fields["polygon"][2] == [0.6, 2.4]
        assert "(1.5e+09, 5e+09) of the drawing" in words(found)


@st.composite
def drawn_walls(draw):
    """Draw a wall of blocks, some with arcs, and return its outlines: corners and bulges."""
    columns, rows = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    width, height = draw(st.floats(0.3, 1.0)), draw(st.floats(0.3, 1.0))
    top = draw(st.sampled_from([0.0, 0.2, 1.0]))
    outlines = []
    for i in range(columns):
        for j in range(rows):
            x, y = i * (width + 0.5), j * height
            corners = [x + 1j * y, x + width + 1j * y, x + width + 1j * (y + height), x + 1j * (y + height)]
            outlines.append((corners, [0, 0, top if j == rows - 1 else 0, 0]))
    return outlines


def cut(corners, bulges, data, shake):
    """Return the sides of an outline as lines, cut into pieces, reversed, repeated and disturbed."""
    lines = []
    for start, end, b in zip(corners, [*corners[1:], corners[0]], bulges, strict=True):
        share = data.draw(st.sampled_from([None, 0.3, 0.5]))
        turn = 4 * np.arctan(b)
        if share is None:
            parts = [(start, end, b)]
        else:
            middle = start + share * (end - start)
            if b:
                centre = (start + end) / 2 + 1j * (end - start) * (1 - b**2) / (4 * b)
                middle = centre + (start - centre) * np.exp(1j * turn * share)
            parts = [(start, middle, np.tan(turn * share / 4)), (middle, end, np.tan(turn * (1 - share) / 4))]
        for a, z, bulge in parts:
            a, z = (each + complex(*(shake * data.draw(st.floats(-1, 1)) for _ in "xy")) for each in (a, z))
            if data.draw(st.booleans()):
                a, z, bulge = z, a, -bulge
            lines += [line((a.real, a.imag), (z.real, z.imag), bulge=bulge)] * data.draw(st.integers(1, 2))
    return lines


@given(st.data())
@settings(max_examples=1)
def test_cut_shuffled_turned_and_repeated_drawings_give_one_file(data):
    give_one_file(data)


@pytest.mark.rest
@given(st.data())
@settings(max_examples=12)
def test_many_cut_shuffled_turned_and_repeated_drawings_give_one_file(data):
    give_one_file(data)


def give_one_file(data):
    walls = data.draw(drawn_walls())
    options = {"density": {"": 2000.0}, "depth": 1.0}
    plain = imported(*(outline([(z.real, z.imag) for z in of], bulges=b) for of, b in walls), **options)
    chains = []
    for corners, bulges in walls:
        if data.draw(st.booleans()):
            chains += cut(corners, bulges, data, 0.0)
        else:
            k = data.draw(st.integers(0, 3))
            z, b = np.roll(corners, k), np.roll(bulges, k)
            if data.draw(st.booleans()):
                z, b = z[::-1], -np.roll(b[::-1], -1)
            chains += [outline([(each.real, each.imag) for each in z], bulges=b)] * data.draw(st.integers(1, 2))
    found = imported(*data.draw(st.permutations(chains)), **options)
    assert_close(found.fields, plain.fields, 2e-7)
    shaken = [each for corners, bulges in walls for each in cut(corners, bulges, data, 2e-4)]
    found = imported(*data.draw(st.permutations(shaken)), **options)
    assert found.kind == plain.kind and [body.name for body in found.bodies] == [body.name for body in plain.bodies]
    areas = [body.moments.area for body in plain.bodies]
    assert [body.moments.area for body in found.bodies] == approx(areas, rel=4e-3)


def assert_close(found, expected, tolerance):
    """Assert that two plain values are the same but for the last digit of their numbers."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys()
        for key in expected:
            assert_close(found[key], expected[key], tolerance)
    elif isinstance(expected, list):
        assert len(found) == len(expected)
        for one, other in zip(found, expected, strict=True):
            assert_close(one, other, tolerance)
    elif isinstance(expected, float):
        assert found == approx(expected, rel=tolerance, abs=tolerance)
    else:
        assert found == expected
