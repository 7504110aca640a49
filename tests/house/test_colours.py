"""Colours are in one file, and told apart by colour-blind readers, on a dark page, and on paper without colour."""

import re
from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from rocking_cli import names
from rocking_cli.documents.figures import inline_svg, svg
from rocking_cli.plotting import style
from tests.conftest import EXAMPLES
from tests.render import FIGURES

# Machado, Oliveira and Fernandes (2009): what a reader without one of the three cones sees, in linear RGB.
SEEN = {
    "all cones": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = np.array([0.9505, 1.0, 1.089])
AREAS = {name: colour for name, colour in style.REGIONS.items() if name != names.UNKNOWN}  # unknown is hatched
PAGES = {"light": lambda colour: colour, "dark": lambda colour: style.DARK[colour]}


def linear(colour):
    c = np.array(to_rgb(colour))
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    """CIE L*a*b*, in which a distance of 2.3 is just noticed between neighbouring areas."""
    x = TO_XYZ @ np.clip(rgb, 0, 1) / WHITE
    f = np.where(x > 216 / 24389, np.cbrt(x), (24389 / 27 * x + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def distance(one, other, sight):
    seen = np.array(SEEN[sight])
    return float(np.linalg.norm(lab(seen @ linear(one)) - lab(seen @ linear(other))))


def contrast(one, other):
    """The contrast of WCAG 2."""
    a, b = sorted(float(TO_XYZ[1] @ linear(each)) for each in (one, other))
    return (b + 0.05) / (a + 0.05)


def test_the_simulation_sees_what_is_known_of_it():
    assert distance("#ff0000", "#00a000", "deuteranopia") < distance("#ff0000", "#00a000", "all cones") / 2
    assert all(distance("#777777", "#777777", sight) == 0 for sight in SEEN)


@pytest.mark.parametrize("page", PAGES)
@pytest.mark.parametrize("sight", SEEN)
def test_curves_and_areas_are_told_apart(sight, page):
    shown = PAGES[page]
    for one, other in combinations(style.HUES, 2):
        assert distance(shown(one), shown(other), sight) > 16, (one, other)
    for one, other in combinations(AREAS.values(), 2):
        assert distance(shown(one), shown(other), sight) > 12, (one, other)
    assert distance(shown(style.SPARED), shown(style.EXCEEDED), sight) > 40


def test_nothing_rests_on_colour_alone():
    looks = [style.distinct(k) for k in range(6)]
    assert len({str(each["linestyle"]) for each in looks}) == len({each["marker"] for each in looks}) == 6
    assert len({style.LINES[name]["linestyle"] for name in style.LINES}) == 3
    lightness = sorted(lab(linear(colour))[0] for colour in AREAS.values())
    assert min(np.diff(lightness)) > 8  # regions, on paper without colour
    assert style.UNKNOWN["hatch"]


@pytest.mark.parametrize("page", PAGES)
def test_words_and_curves_stand_out_from_their_page(page):
    shown, paper = PAGES[page], PAGES[page](style.PAPER)
    for words in (style.INK, "#000000"):
        assert contrast(shown(words), paper) > 7
    names_of_curves = (style.WORDS.get(each, each) for each in style.HUES)
    for words in (*names_of_curves, style.MEASURE, style.CURSOR, style.TIE["color"]):
        assert contrast(shown(words), paper) > 4.5
    for curve in (*style.HUES, style.THRUST["color"], style.EARTH, style.RECORD_COLOUR):
        assert contrast(shown(curve), paper) > 3


def test_colours_and_sizes_are_in_one_file():
    for path in (EXAMPLES.parent / "rocking_cli").rglob("*.py"):
        if path.name != "style.py":
            text = path.read_text(encoding="utf-8")
            assert not re.findall(r"[\"']#[0-9a-fA-F]{6}[\"']", text), path
            assert not re.findall(r"fontsize=\d|labelsize=\d", text), path


@pytest.mark.every(9)
@pytest.mark.parametrize("name", FIGURES)
def test_every_colour_of_a_picture_has_one_for_dark_pages(name):
    drawn = svg(FIGURES[name](), name)
    used = set(re.findall(r"(?:fill|stroke): (#[0-9a-f]{6})", drawn))
    assert used
    assert used <= set(style.DARK)


def test_a_dark_page_recolours_words_lines_and_areas():
    figure = Figure()
    figure.subplots().plot([0, 1], color=style.BLUE)
    text = svg(figure, "one")
    rules = style.dark_rules("figure ")
    assert f"stroke: {style.BLUE}" in text
    assert f"figure [style*='stroke: {style.BLUE}'] {{ stroke: {style.DARK[style.BLUE]} !important }}" in rules
    assert "figure text:not([style*='fill'])" in rules


def test_marks_and_hatches_have_their_colours_where_a_dark_page_finds_them():
    def draw():
        figure = Figure()
        axes = figure.subplots()
        axes.plot([0], [0], marker="s", color=style.ORANGE, markerfacecolor=style.PAPER)
        axes.axhspan(0, 1, facecolor=style.SHADE, hatch="////", edgecolor=style.FAINT)
        return figure

    text = str(inline_svg(draw, "a"))
    assert not re.search(r'<path id="[^"]*" [^>]*style=', text)  # a rule does not reach the shape of a mark
    assert re.search(rf"<use [^>]*fill: {style.PAPER}; stroke: {style.ORANGE}", text)
    assert re.search(rf'<rect [^>]*style="fill: {style.SHADE}"', text) and 'fill="#' not in text
