"""Lines of SVG: arcs against formulas, curves against their definition, and path data in several spellings."""

from math import asin, comb, cos, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rocking_cli.io.drawings import svg
from tests.io.drawings.areas import area

CIRCLE = "M10 0C10 {k} {k} 10 0 10S-10 {k}-10 0-{k}-10 0-10 10-{k} 10 0z"


def drawn(content, head='width="1m" viewBox="0 0 100 100"'):
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {head}>{content}</svg>'
    return svg.read(text.encode(), "x.svg")


def chain(content):
    (only,) = drawn(content).chains
    return only


def path(data):
    return chain(f'<path d="{data}"/>')


def segment(turn, r=5.0):
    return r**2 / 2 * (turn - sin(turn))


SMALL = 2 * asin(0.6)  # of a chord of 6 in a circle of radius 5


@pytest.mark.parametrize(("content", "expected"), [
    ('<rect x="1" y="2" width="10" height="5" rx="2"/>', 50 - (4 - pi) * 4),
    ('<rect width="10" height="5" ry="9" rx="2.5"/>', 50 - (4 - pi) * 2.5**2),
    ('<rect width="10" height="5" rx="2" ry="1" transform="scale(1 2) rotate(90)"/>', None),
    ('<circle cx="5" cy="7" r="3" transform="rotate(33) scale(-2, 2)"/>', 36 * pi),
    ('<ellipse cx="1" rx="3" ry="2" transform="rotate(20 3 4)scale(2,3)"/>', 36 * pi),
    ('<path d="M0 0A5 5 0 0 1 6 0z"/>', -segment(SMALL)),
    ('<path d="M0 0A5 5 0 1 0 6 0z"/>', segment(2 * pi - SMALL)),
    ('<path d="M0 0a1 1 0 0 0 6 0z"/>', pi * 9 / 2),
    ('<path d="M0 0a5 3 30 0 0 6 0z" transform="matrix(.6 0 0 1 0 0)rotate(-30)"/>',
     segment(2 * asin(abs(6 * cos(pi / 6) * 0.6 + 3j) / 6), r=3.0)),
    ('<path d="M0 3 h1 v-3 a.5.5 0 00-1 0z"/>', 3.392699082),
])  # fmt: skip
def test_arcs_have_the_area_of_their_formula(content, expected):
    only = chain(content)
    assert only.closed and only.arcs_found == 0
    if expected is None:
        assert only.is_straightened and not only.bulges.any()
    else:
        assert not only.is_straightened and len(only.points) <= 8
        assert area(only) == pytest.approx(expected, rel=1e-9) or area(only) == pytest.approx(-expected, rel=1e-9)
        if "A5" in content:
            assert area(only) * expected > 0


@pytest.mark.parametrize("large", [0, 1])
@pytest.mark.parametrize("sweep", [0, 1])
def test_an_arc_of_an_ellipse_lies_on_it_and_turns_as_its_flags_say(large, sweep):
    rx, ry, angle = 5.0, 3.0, radians(30)
    only = chain(f'<path d="M1 2a{rx} {ry} 30 {large}{sweep}4 1"/>')
    # A point of the ellipse and two more give its centre: the mean of those that are opposite to each other.
    unit = only.points.conj() * np.exp(-1j * angle)
    unit = unit.real / rx + 1j * unit.imag / ry
    chord = unit[-1] - unit[0]
    centre = (unit[0] + unit[-1]) / 2 + 1j * chord / abs(chord) * (1 - abs(chord) ** 2 / 4) ** 0.5 * (
        -1 if large == sweep else 1
    )
    np.testing.assert_allclose(abs(unit - centre), 1, rtol=1e-12)
    turns = np.angle((unit[1:] - centre) / (unit[:-1] - centre))
    assert (turns > 0).all() if sweep else (turns < 0).all()
    assert (abs(turns.sum()) > pi) == bool(large)


def test_half_a_turn_whose_ends_are_rounded_stays_half_a_turn():
    rounded = path("M10.1234 20A5.6789 5.6789 0 0 1 21.4811 20A5.6789 5.6789 0 0 1 10.1234 20z")
    assert area(rounded) == pytest.approx(-pi * 5.6789**2, rel=2e-5)
    assert path("M0 0a50 50 0 0 1 99 0z").bulges[0] == pytest.approx(-tan(asin(0.99) / 2))


@pytest.mark.parametrize("k", [5.522847498, 5.5228, 5.51915])
def test_a_circle_of_cubic_curves_is_a_circle(k):
    only = path(CIRCLE.format(k=k))
    assert (only.arcs_found, only.is_straightened, len(only.points)) == (4, False, 4)
    assert area(only) == pytest.approx(-100 * pi, rel=1e-12) or area(only) == pytest.approx(100 * pi, rel=1e-12)
    squeezed = chain(f'<path d="{CIRCLE.format(k=k)}" transform="scale(1, .9)"/>')
    assert squeezed.arcs_found == 0 and squeezed.is_straightened


@pytest.mark.parametrize("turn", [0.02, 0.3, 1.0, 2.0])
def test_only_arcs_are_taken_for_arcs(turn):
    h = 4 / 3 * tan(turn / 4)
    tangent = (cos(turn) + h * sin(turn), sin(turn) - h * cos(turn))
    arc = path(f"M1 0C1 {h} {tangent[0]} {tangent[1]} {cos(turn)} {sin(turn)}")
    assert arc.arcs_found == 1 and arc.bulges[0] == pytest.approx(-tan(turn / 4))
    assert path(f"M1 0C1 {1.01 * h} {tangent[0]} {tangent[1]} {cos(turn)} {sin(turn)}").arcs_found == 0
    rise = tan(turn / 4) / 2
    parabola = path(f"M0 0C{1 / 3} {4 / 3 * rise} {2 / 3} {4 / 3 * rise} 1 0")
    assert parabola.arcs_found == (turn == 0.02)  # a millionth of its chord apart


CURVES = {
    "C": [0, 1 + 5j, 7 - 2j, 4 + 1j],
    "Q": [0, 3 + 4j, 6],
    "loop": [0, 9 + 5j, -5 + 5j, 4],
}


def bernstein(knots, s):
    n = len(knots) - 1
    return sum(comb(n, k) * s**k * (1 - s) ** (n - k) * np.conj(z) for k, z in enumerate(knots))


@pytest.mark.parametrize("name", CURVES)
def test_curves_are_straightened_to_a_millionth_with_corners_on_them(name):
    knots = CURVES[name]
    data = " ".join(f"{complex(z).real} {complex(z).imag}" for z in knots[1:])
    only = path(f"M0 0{'Q' if len(knots) == 3 else 'C'}{data}")
    count = len(only.points) - 1
    assert only.is_straightened and not only.closed and count < 2000
    np.testing.assert_allclose(only.points, bernstein(knots, np.arange(count + 1) / count), atol=1e-12)
    between = bernstein(knots, (np.arange(count)[:, None] + np.linspace(0, 1, 9)) / count)
    start, side = only.points[:-1, None], np.diff(only.points)[:, None]
    size = max(np.ptp(np.real(knots)), np.ptp(np.imag(knots)))
    assert abs(((between - start) / side).imag * abs(side)).max() <= 1e-6 * size


def test_sides_of_cubic_curves_that_are_straight_are_sides():
    only = path("M0 0C-1e-12 0 2 0 3 0 3 0 3 2 3 2Q1.5 2 0 2z")
    assert not only.is_straightened and only.points.tolist() == [0, 3, 3 - 2j, -2j]


NUMBERS = st.integers(-4000, 4000).map(lambda k: k / 100)
POINTS = st.builds(complex, NUMBERS, NUMBERS)
LETTERS = {"L": 1, "H": 1, "V": 1, "C": 3, "S": 2, "Q": 2, "T": 1, "A": 1}
PIECES = st.one_of(*(
    st.tuples(st.just(letter), st.lists(POINTS, min_size=count, max_size=count)) for letter, count in LETTERS.items()
))  # fmt: skip


@settings(max_examples=10)
@given(POINTS, st.lists(PIECES, min_size=1, max_size=6), st.booleans(), st.data())
def test_a_path_is_the_same_in_every_spelling(start, pieces, closed, data):
    spelled = [written(start, pieces, closed, data.draw), written(start, pieces, closed, None)]
    one, other = (list(drawn(f'<path d="{each}"/>').chains) for each in spelled)
    assert [each.closed for each in one] == [each.closed for each in other]
    for a, b in zip(one, other, strict=True):
        np.testing.assert_allclose(a.points, b.points, atol=1e-9)
        np.testing.assert_allclose(a.bulges, b.bulges, atol=1e-5, rtol=1e-5)


def written(start, pieces, closed, draw):
    """Path data: plain and absolute without `draw`; else relative or not, with commas, blanks, signs or nothing."""

    def number(value):
        plain = f"{round(value, 6):.6f}".rstrip("0").rstrip(".")
        if not draw:
            return f" {plain}"
        if draw(st.booleans()):
            plain = f"{value * 1000:.6f}e-3"
        elif plain.lstrip("-").startswith("0."):
            plain = plain.replace("0.", ".", 1)
        separators = [" ", ",", "\n\t , "] + [""] * (plain[0] == "-")
        return draw(st.sampled_from(separators)) + plain

    out, here, last = f"M{start.real} {start.imag}", start, "M"
    for letter, points in pieces:
        relative = bool(draw) and draw(st.booleans())
        base = here if relative else 0
        name = letter.lower() if relative else letter
        values = [part for z in points for part in ((z - base).real, (z - base).imag)]
        text = "".join(number(each) for each in values)
        if letter in "HV":
            here = complex(points[0].real, here.imag) if letter == "H" else complex(here.real, points[0].imag)
            text = number(values[0 if letter == "H" else 1])
        else:
            here = points[-1]
        if letter == "A":
            flags = draw(st.sampled_from(["01", "0 1,", "0,1 "])) if draw else "0 1 "
            text = f"50 30 10 {flags}" + text.lstrip(" ,\n\t")
        is_same = name == last and draw and draw(st.booleans())
        out += (text if text[0] in " -,\n" else f" {text}") if is_same else name + text.lstrip(" ,\n\t")
        last = name
    return out + ("z" if closed else "")


TRANSFORMS = {
    "matrix": 6, "translate": 2, "scale": 2, "rotate": 3, "skewX": 1, "skewY": 1,
}  # fmt: skip


def matrix(name, v):
    """The matrix of the standard."""
    if name == "matrix":
        return np.array([[v[0], v[2], v[4]], [v[1], v[3], v[5]], [0, 0, 1]])
    if name == "translate":
        return np.array([[1, 0, v[0]], [0, 1, v[1]], [0, 0, 1]])
    if name == "scale":
        return np.diag([v[0], v[1], 1])
    if name == "rotate":
        turn = np.array([[cos(radians(v[0])), -sin(radians(v[0])), 0], [sin(radians(v[0])), cos(radians(v[0])), 0]])
        return matrix("translate", v[1:]) @ np.vstack([turn, [0, 0, 1]]) @ matrix("translate", [-v[1], -v[2]])
    skew = np.eye(3)
    skew[(0, 1) if name == "skewX" else (1, 0)] = tan(radians(v[0]))
    return skew


@settings(max_examples=10)
@given(st.lists(st.sampled_from(sorted(TRANSFORMS)), min_size=1, max_size=4), st.data())
def test_transforms_are_those_of_the_standard(names, data):
    steps = [(name, [data.draw(st.integers(1, 30)) / 8 for _ in range(TRANSFORMS[name])]) for name in names]
    whole = np.linalg.multi_dot([np.eye(3), np.eye(3), *(matrix(*step) for step in steps)])
    if abs(np.linalg.det(whole)) < 1e-6:
        return
    text = " ".join(f"{name}({', '.join(map(str, values))})" for name, values in steps)
    only = chain(f'<g transform="{text}"><path d="M1 2 3 5 8 1"/></g>')
    expected = whole @ np.array([[1, 3, 8], [2, 5, 1], [1, 1, 1]])
    np.testing.assert_allclose(only.points, expected[0] - 1j * expected[1], rtol=1e-9, atol=1e-9)


@pytest.mark.every(3)
@pytest.mark.parametrize("data", [
    "L1 1", "M1", "M1 2 3", "M1,,2", "M1 2,", "M1 2z3", "M1 2L", "M1 2B3", "M1 2C1 2 3 4", "M0 0A1 1 0 2 0 1 1",
    "M0 0A1 1 0 0 1 1", "M0 0L1_0 1", "M0 0L1e13 1", "M0 0 - 1", "M0 0L1 1;", "M0 0L٣ 1", "M0 0a5 5 0 0 1 1e99 0",
])  # fmt: skip
def test_paths_that_are_not_valid_are_refused_with_their_line(data):
    with pytest.raises(svg.DrawingError, match=r"^x.svg:2: `path`: ") as caught:
        drawn(f'\n<path d="{data}"/>')
    assert caught.value.refused == "not_svg"


@pytest.mark.every(3)
@pytest.mark.parametrize(("data", "count"), [
    ("none", 0), ("M1 1z", 0), ("M1 1L1 1", 0), ("M0 0 1 1M2 2", 1), ("M0 0 1 0 1 1zl-1 0", 2),
    ("M0 0a0 5 0 0 1 3 4", 1), ("m1 1 1 1zm1 0 1 1", 2), ("M0 0 1 0M5 5 6 5z", 2),
])  # fmt: skip
def test_subpaths_without_length_are_nothing(data, count):
    assert len(drawn(f'<path d="{data}"/>').chains) == count


def test_a_subpath_after_z_begins_where_the_one_before_began():
    chains = drawn('<path d="M1 1h2v2zl-1 0"/>').chains
    assert chains[0].closed and chains[1].points.tolist() == [1 - 1j, -1j]


def test_ends_that_meet_close_a_path():
    assert path("M0 0h3v3h-3L0 1e-10").closed
    assert not path("M0 0h3v3h-3L0 1e-3").closed
    assert path("M0 0h3v3h-3L0 1e-10").points.tolist() == [0, 3, 3 - 3j, -3j]
