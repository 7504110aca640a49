"""Sections as draughtsmen leave them: each way of spoiling a drawing keeps its lambda, or is refused with a way out."""

import re
import shlex
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pytest import approx

from rocking_cli.io.drawings.contract import DrawingError
from rocking_cli.questions.import_drawing.legend import parse_layers
from rocking_cli.questions.import_drawing.outlines import density_in
from rocking_cli.units import UnitError
from tests.questions.import_drawing.sheets import box, imported, lambdas, line, outline, sides, words

LOOSE = ("short of corners", "nearly closed")  # corners are the middles of ends
OVER, SHORT = 0.03, 4e-4  # length of an end beyond a corner, and short of it [m]


def section(random):
    """Corners of a wall of one to three courses, each narrower than the one below, on a level base; of one outline."""
    x, y, left, right = 0.0, 0.0, [], []
    width = random.uniform(0.6, 1.5)
    for _ in range(random.integers(1, 4)):
        height = random.uniform(0.5, 1.5)
        left += [(x, y), (x, y + height)]
        right += [(x + width, y), (x + width, y + height)]
        x, y, width = x + random.uniform(0.08, 0.15) * width, y + height, 0.75 * width
    return [*left[::-1], *right]


def along(a, b, from_a, beyond_b=0.0):
    """Points at a distance from one end of a side towards the other, and beyond the other."""
    a, b = complex(*a), complex(*b)
    unit = (b - a) / abs(b - a)
    return tuple((z.real, z.imag) for z in (a + from_a * unit, b + beyond_b * unit))


def each_side(corners):
    return pairwise([*corners, corners[0]])


def nearly_closed(corners):
    made = outline([*corners, (corners[0][0], corners[0][1] - SHORT)])
    return replace(made, closed=False)


def cut(corners, random):
    lines = []
    for a, b in each_side(corners):
        share = random.uniform(0.2, 0.8)
        middle = a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
        lines += [line(middle, a), line(middle, b)]
    return [lines[k] for k in random.permutation(len(lines))]


def lying_on(corners, random):
    (a, b), *_ = each_side(corners)
    return [*sides(corners), line(*along(a, b, 0.1, -0.1))]


def sloping(corners, random):
    """The base rises by .9 per cent at its right end, and nothing else does."""
    right = max(corners, key=lambda each: (-each[1], each[0]))
    return [outline([(x, y + 0.009 * x * ((x, y) == right)) for x, y in corners])]


def framed(corners, random):
    frame = box(-5, -5, 15, 15, "SHEET_A3")
    return [outline(corners, "FOGLIO"), frame, outline([(1, 9), (2, 9), (2, 9.5)], "FOGLIO_2")]


WAYS = {
    "crossing at corners": lambda c, r: [line(*along(a, b, -OVER, OVER)) for a, b in each_side(c)],
    "short of corners": lambda c, r: [line(*along(a, b, SHORT, -SHORT)) for a, b in each_side(c)],
    "doubled": lambda c, r: [*sides(c), *sides(c[::-1])],
    "lying on others": lying_on,
    "cut and shuffled": cut,
    "nearly closed": lambda c, r: [nearly_closed(c)],
    "a spike": lambda c, r: [outline(c), outline([c[0], c[1]])],
    "a crumb": lambda c, r: [*sides(c), line((5, 0), (5, SHORT))],
    "a base out of level": sloping,
    "dimensions and hatches": lambda c, r: [outline(c), line((0, -1), (2, -1), "COTAS"), box(0, 0, 9, 9, "SCHRAFFUR")],
    "walls of other languages": lambda c, r: [outline(c, r.choice(["Mauer", "MUROS", "mur_1", "WALL", "Pfeiler"]))],
    "a frame on a layer without a role": framed,
}  # fmt: skip


def spoilt(way, seed):
    """The lambdas of a random section, those of it spoilt, and what was said; a refusal is obeyed once."""
    random = np.random.default_rng([seed, list(WAYS).index(way)])
    corners = section(random)
    good, drawn, options = lambdas(imported(outline(corners))), WAYS[way](corners, random), {}
    try:
        found = imported(*drawn)
    except DrawingError as error:
        given = re.findall(r"`layers` (\S+)", str(error).partition(" is taken for a frame")[0])
        layers = parse_layers([shlex.split(each)[0] for each in given])
        layers = {role: [name for name in names if name != "FOGLIO_2"] for role, names in layers.items()}
        options = {"layers": {**layers, "nothing": [*layers["nothing"], "FOGLIO_2"]}}
        found = imported(*drawn, **options)
    return good, lambdas(found), words(found)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.rest) for k in range(1, 8))])
def test_a_spoilt_section_keeps_its_lambda(way, seed):
    good, found, said = spoilt(way, seed)
    assert found == approx(good, rel=1e-6 if way not in LOOSE else 5e-3)
    if way == "a base out of level":
        assert re.search(r"1 corner put onto the level ground, by up to [\d.]+ mm", said)
    if way == "crossing at corners":
        assert "ends of lines beyond a corner left out, up to 30 mm" in said


def test_an_end_that_is_no_overshoot_is_not_dropped():
    corners = [(0, 0), (0.6, 0), (0.6, 2.4), (0, 2.4)]
    with pytest.raises(DrawingError, match="close nothing"):
        imported(*[line(*along(a, b, -0.2, 0)) for a, b in each_side(corners)])


def test_an_arc_that_goes_on_beside_its_tangent_leaves_slivers_out():
    height, radius, turn = 2.0, 0.5, np.radians(3)
    ends = [radius + radius * np.exp(1j * way) + 1j * height for way in (-turn, np.pi + turn)]
    top = line((ends[0].real, ends[0].imag), (ends[1].real, ends[1].imag), bulge=np.tan((np.pi + 2 * turn) / 4))
    walls = [line((0, 0), (1, 0)), line((1, 0), (1, height + 0.05)), line((0, height + 0.05), (0, 0))]
    found = imported(*walls, top)
    area = height + np.pi * radius**2 / 2
    (body,) = found.bodies
    assert abs(body.moments.area - area) < 1e-3 * (2 * height + np.pi * radius)  # `close` times the length
    assert "2 slivers between lines left out" in words(found)


def test_joints_that_cross_the_arcs_of_a_ring_part_it():
    """Of six voussoirs from 1 to 1.3 m; chords of its arcs end where joints cross them."""
    ring = [line((radius, 0), (-radius, 0), bulge=1.0) for radius in (1.0, 1.3)]
    for k in range(7):
        over, way = 0.02 * (0 < k < 6), np.exp(1j * np.pi * k / 6)
        ring.append(line(*((r * way.real, r * way.imag) for r in (1.0 - over, 1.3 + over))))
    found = imported(*ring, depth=1.0, density={"": 2000.0})
    area = np.pi * (1.3**2 - 1) / 12
    assert [body.moments.area for body in found.bodies] == approx([area] * 6, rel=1e-3)  # chords to .1 mm of 1.2 m
    assert "10 ends of lines beyond a corner left out, up to 20" in words(found)


def test_a_line_across_a_closed_one_cuts_it():
    found = imported(box(0, 0, 1, 2), line((-0.05, 1.2), (1.05, 1.2)), depth=1.0, density={"": 2000.0})
    assert [body.moments.area for body in found.bodies] == approx([1.2, 0.8], rel=1e-9)
    with pytest.raises(DrawingError, match="close nothing"):
        imported(box(0, 0, 1, 2), line((-0.5, 1.2), (1.5, 1.2)))


def test_how_far_a_base_is_levelled_is_said():
    found = imported(outline([(0, 0), (3, 0.027), (3, 2), (0, 2)]))
    assert "1 corner put onto the level ground, by up to 27 mm" in words(found)
    with pytest.raises(DrawingError, match="it stands on one corner, the next is ") as caught:
        imported(outline([(0, 0), (1, 0.05), (1, 2), (0, 2)]))
    assert "merge_gap" not in str(caught.value)


def test_frames_and_hatches_are_not_proposed_as_bodies():
    hatch = box(0, 0, 1, 1, "GRIGIO", is_fill=True, shape="HATCH 1")
    drawn = [box(0, 0, 1, 2, "A"), box(3, 0, 1, 2, "B"), box(-1, -1, 9, 9, "SHEET"), hatch]
    with pytest.raises(DrawingError, match=r"`layers` bodies=A,B `layers` nothing=SHEET,GRIGIO") as caught:
        imported(*drawn)
    assert caught.value.refused == "layers"
    found = imported(*drawn, layers=parse_layers(["bodies=A,B", "nothing=SHEET,GRIGIO"]))
    assert len(found.bodies) == 2


def test_a_wall_around_its_windows_may_be_no_frame():
    drawn = [box(0, 0, 4, 3, "PEZZO_1"), box(1, 1, 1, 1.5, "COSE")]
    said = "if it has openings, `layers` bodies=PEZZO_1 `layers` openings=COSE"
    with pytest.raises(DrawingError, match=f"PEZZO_1 is taken for a frame, as it is around all else: {said}"):
        imported(*drawn)
    named = [box(0, 0, 4, 3, "PARETE_1"), box(1, 1, 1, 1.5, "COSE")]
    with pytest.raises(DrawingError, match=r"by what is drawn there, `layers` openings=COSE \("):
        imported(*named)
    for pieces, layers in ((drawn, ["bodies=PEZZO_1", "openings=COSE"]), (named, ["openings=COSE"])):
        (body,) = imported(*pieces, layers=parse_layers(layers)).bodies
        assert body.moments.area == approx(12 - 1.5, rel=1e-9)


def test_what_is_around_one_of_several_bodies_is_no_frame():
    drawn = [box(9, 0, 1, 2, "MURO"), box(0, 0, 1, 2, "MURO"), box(-1, -1, 3, 4, "K")]
    with pytest.raises(DrawingError, match="by what is drawn there, `layers` bodies=K ") as caught:
        imported(*drawn)
    assert "frame" not in str(caught.value)
    drawn = [*sides([(0, 0), (1, 0), (1, 2), (0, 2)], "A"), box(-1, -1, 3, 4, "K")]
    with pytest.raises(DrawingError, match=r"`layers` bodies=A `layers` nothing=K \(K is taken for a frame"):
        imported(*drawn)


def test_a_layer_whose_name_drops_it_is_named():
    with pytest.raises(DrawingError, match="on BORDERS, whose name says that nothing on it counts: give `layers`"):
        imported(box(0, 0, 1, 2, "BORDERS"))


def circle(x, y, radius, **more):
    return outline([(x + radius, y), (x - radius, y)], bulges=[1, 1], **more)


def test_what_stands_on_a_curve_rolls():
    around = 2 * np.pi * np.arange(400) / 400
    ellipse = outline(zip(np.sin(around), 0.4 * np.cos(around), strict=True), is_straightened=True)
    bowl = outline([(0, 1), (1, 1)], bulges=[1, 0])
    for drawn in (circle(0, 0, 0.5), ellipse, bowl):
        with pytest.raises(DrawingError, match="a round foot rolls") as caught:
            imported(drawn)
        assert caught.value.refused == "point"
    # A half disc on its flat side: y_G = 4 r/(3 pi).
    assert lambdas(imported(outline([(0, 0), (1, 0)], bulges=[0, 1]))) == approx([0.75 * np.pi] * 2, rel=2e-6)


@pytest.mark.parametrize(
    ("text", "density"),
    [("2200 kg/m3", 2200), ("gamma = 22 kN/m3", 22000 / 9.80665), ("\u03b3=22,5 kN/m\u00b3", 22500 / 9.80665),
     ("2.200 kg/m\u00b3", 2200), ("1 800 kg/m3", 1800), ("2,2 t/m3", 2200), ("18 kN/mc", 18000 / 9.80665),
     ("pier 1/2", None), ("b1", None), ("12 kN/m", None)],
)  # fmt: skip
def test_densities_as_people_write_them(text, density):
    assert density_in(text) == (density if density is None else approx(density, rel=1e-12))


def test_a_density_that_cannot_be_read_is_no_name():
    for text in ("? kg/m3", "heavy t/m3", "22 stone/m3"):
        with pytest.raises(UnitError):
            density_in(text)
