"""SVG drawings: layers, texts, what is not drawn, units, and files that are refused."""

import gzip

import numpy as np
import pytest

from rocking_cli.io.drawings import contract, svg
from tests.conftest import EXAMPLES
from tests.io.drawings.areas import area

SPACES = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    'xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"'
)
BOX = '<rect id="r" width="2" height="1"/>'


def drawn(content, head='width="100mm" height="100mm" viewBox="0 0 100 100"'):
    return svg.read(f"<svg {SPACES} {head}>\n{content}</svg>".encode(), "x.svg")


def layers(content):
    return [each.layer for each in drawn(content).chains]


def left(content):
    return [(each.kind, each.layer, each.count) for each in drawn(content).left_out]


def test_y_is_up_and_things_have_their_names():
    (chain,) = drawn('<rect id="a" x="1" y="2" width="3" height="4"/>').chains
    assert chain.points.tolist() == [1 - 2j, 4 - 2j, 4 - 6j, 1 - 6j]
    assert (chain.kind, chain.handle, chain.shape, chain.closed) == ("rect", "a", "", True)
    line, polyline, polygon = drawn('<line x2="1"/><polyline points="0 0 1,1"/><polygon points="0,0 1 1-1,2"/>').chains
    assert not line.closed and not polyline.closed and polygon.closed
    assert polygon.points.tolist() == [0, 1 - 1j, -1 - 2j]


@pytest.mark.parametrize(("content", "layer"), [
    (BOX, ""),
    (f'<g id="g1"><g id="g2">{BOX}</g></g>', "g2"),
    (f'<g id="g1"><g>{BOX}</g></g>', "g1"),
    (f'<g id="g1" inkscape:label="Muro &lt;b&gt;"><g id="g2">{BOX}</g></g>', "Muro <b>"),
    (f'<g inkscape:label="one"><use href="#s"/></g><defs><g id="s">{BOX}</g></defs>', "one"),
    (f'<g id="one"><svg id="no">{BOX}</svg></g>', "one"),
])  # fmt: skip
def test_a_layer_is_the_nearest_label_or_else_the_nearest_id(content, layer):
    assert layers(content) == [layer]


def test_subpaths_of_a_path_are_one_shape_and_others_are_not():
    ring = "M0 0h9v9h-9zM2 2h1v1h-1z"
    one, two, three, four, alone = drawn(f'<path d="{ring}"/><path id="a" d="{ring}"/>{BOX}').chains
    assert one.shape == two.shape != three.shape == four.shape
    assert one.shape and three.shape and not alone.shape


@pytest.mark.parametrize("hidden", [
    'display="none"', 'style="fill:none; display : none !important"', 'class="a away"', 'visibility="hidden"',
    'style="visibility:collapse"', 'id="away"',
])  # fmt: skip
def test_what_is_hidden_is_left_out_and_counted(hidden):
    sheet = "<style>/* } */ .away, #away { display: none } @media print { rect { display: none } }</style>"
    content = f'{sheet}<g id="L"><g {hidden}><rect width="1" height="1"/><path d="M0 0 1 1"/></g></g>{BOX}'
    assert [each.handle for each in drawn(content).chains] == ["r"]
    assert sorted((kind, count) for kind, _, count in left(content)) == [("path", 1), ("rect", 1)]


def test_a_thing_within_a_hidden_group_may_be_visible():
    inner = '<rect width="1" height="1" visibility="visible"/>'
    assert len(drawn(f'<g visibility="hidden">{inner}</g>').chains) == 1
    assert len(drawn(f'<g style="display:none">{inner}</g>').chains) == 0
    assert len(drawn(f"<style>*{{visibility:hidden}}rect.a{{visibility:visible}}</style>{BOX}").chains) == 0
    assert len(drawn(f'<style>rect{{display:none}}</style><rect style="display:inline" {inner[6:]}').chains) == 1


def test_what_is_no_line_is_left_out_and_counted():
    content = f"""<defs>{BOX}</defs><symbol>{BOX}</symbol><clipPath>{BOX}</clipPath><mask>{BOX}</mask><title/>
      <pattern>{BOX}</pattern><marker>{BOX}</marker><image href="a.png"/><image/><sodipodi:namedview/>
      <g id="L"><flowRoot>{BOX}</flowRoot><rect width="1" height="1" clip-path="url(#c)" transform="scale(0)"/></g>
      <linearGradient/><use href="#none"/>"""
    kinds = {"clipPath": 1, "mask": 1, "pattern": 1, "marker": 1, "image": 2, "use": 1}
    found = left(content)
    assert {(kind, "", count) for kind, count in kinds.items()} <= set(found)
    assert {("flowRoot", "L", 1), ("rect", "L", 1), ("clipPath", "L", 1)} <= set(found) and len(found) == 9
    assert not drawn(content).chains


def test_use_has_a_place_a_transform_and_a_name():
    (chain,) = drawn(f'<defs>{BOX}</defs><use id="u" xlink:href="#r" x="3" y="4" transform="scale(2)"/>').chains
    assert chain.points.tolist() == [6 - 8j, 10 - 8j, 10 - 10j, 6 - 10j] and chain.handle == "u"


@pytest.mark.parametrize(("content", "box"), [
    (f'<svg x="10" y="20" width="8" height="8" viewBox="1 1 4 2">{BOX}</svg>', (8, 20, 12, 22)),
    (f'<svg width="8" height="8" viewBox="0 0 4 2" preserveAspectRatio="xMinYMax slice">{BOX}</svg>', (0, 0, 8, 4)),
    (f'<svg width="8" height="8" viewBox="0 0 4 2" preserveAspectRatio="none">{BOX}</svg>', (0, 0, 4, 4)),
    (f'<svg width="50%" height="8" viewBox="0 0 4 2" preserveAspectRatio="xMaxYMin">{BOX}</svg>', (34, 0, 42, 4)),
    (f'<symbol id="s" viewBox="0 0 2 1">{BOX}</symbol><use href="#s" x="5" width="4" height="2"/>', (5, 0, 9, 2)),
    (f'<symbol id="s" viewBox="0 0 2 2">{BOX}</symbol><use href="#s" x="5"/>', (5, 0, 105, 50)),
    ('<rect x="10%" y="1cm" width="96" height="1in"/>', (10, 96 / 2.54, 106, 96 / 2.54 + 96)),
])  # fmt: skip
def test_nested_drawings_and_symbols_fit_their_size(content, box):
    (chain,) = drawn(content).chains
    z = chain.points
    assert (z.real.min(), -z.imag.max(), z.real.max(), -z.imag.min()) == pytest.approx(box)


@pytest.mark.parametrize(("content", "text", "at"), [
    ('<text x="1" y="2"> b1\n  b </text>', "b1 b", 1 - 2j),
    ('<text x="1 2 3" y="4,5" transform="translate(1)">12 <tspan>kN</tspan></text>', "12 kN", 2 - 4j),
    ('<text><tspan x="3" y="4" sodipodi:role="line">b1</tspan><tspan x="3" y="9" sodipodi:role="line">2200 kg/m3'
     "</tspan></text>", "b1\n2200 kg/m3", 3 - 4j),
    ('<path id="p" display="none" d="M7 8h9"/><text><textPath href="#p">along</textPath></text>', "along", 7 - 8j),
])  # fmt: skip
def test_texts_are_labels_at_their_place(content, text, at):
    (label,) = drawn(f'<g id="L">{content}</g>').labels
    assert (label.text, label.at, label.layer, label.kind) == (text, at, "L", "text")


@pytest.mark.parametrize(("head", "paper"), [
    ('width="210mm" height="297mm" viewBox="0 0 210 297"', "0.001"),
    ('width="8.5in" height="11in" viewBox="0 0 612 792"', "0.0254/72"),
    ('width=" 6pc " viewBox="0 0 1 1"', "0.0254"),
    ('width="100mm" height="100mm" viewBox="0 0 200 100"', "0.0005"),
    ('width="100mm" height="100mm" viewBox="0 0 200 100" preserveAspectRatio="xMidYMid slice"', "0.001"),
    ('width="100mm" height="100%" viewBox="0 0 100 100"', "0.001"),
])  # fmt: skip
def test_the_size_of_a_unit_on_paper_is_exact(head, paper):
    over, _, under = paper.partition("/")
    drawing = drawn("", head)
    assert drawing.paper == pytest.approx(float(over) / float(under or 1), rel=1e-14, abs=0)
    assert (drawing.unit, drawing.doubt) == (None, "")


@pytest.mark.parametrize("head", [
    'width="793" height="1122" viewBox="0 0 793 1122"', 'width="793px" viewBox="0 0 793 1122"',
    'width="100%" viewBox="0 0 1 1"', 'viewBox="0 0 1 1"', 'width="210mm" height="297mm"', "",
    'width="210mm" height="200" viewBox="0 0 1 1"', 'width="2em" viewBox="0 0 1 1"',
])  # fmt: skip
def test_a_px_has_no_size(head):
    drawing = drawn(BOX, head)
    assert drawing.paper is None and "72, 90, 96 or 300 px per inch" in drawing.doubt


def test_sizes_out_of_range_are_refused():
    with pytest.raises(svg.DrawingError, match="out of range"):
        drawn(BOX, 'width="1e999mm" viewBox="0 0 1 1"')


def test_a_drawing_that_its_size_stretches_is_as_on_paper():
    drawing = drawn(BOX, 'width="100mm" height="50mm" viewBox="0 0 100 100" preserveAspectRatio="none"')
    assert drawing.paper == 0.001 and abs(area(drawing.chains[0])) == pytest.approx(1.0)
    assert np.ptp(drawing.chains[0].points.imag) == 0.5


def nested_uses(levels, count):
    groups = [f'<g id="g0">{BOX}</g>']
    groups += [f'<g id="g{k + 1}">' + count * f'<use href="#g{k}"/>' + "</g>" for k in range(levels)]
    return "".join(f"<defs>{each}</defs>" for each in groups) + f'<use href="#g{levels}"/>'


@pytest.mark.every(3)
@pytest.mark.parametrize(("content", "refused", "words"), [
    (nested_uses(8, 10), "too_large", "more than 2,000 elements, with those that are used again"),
    (nested_uses(60, 1), "too_large", "nested more than 100 deep"),
    ("<g>" * 101 + "</g>" * 101, "too_large", "x.svg:2: elements are nested more than 100 deep"),
    ('<g id="a"><use href="#a"/></g>', "not_svg", "x.svg:2: `use` draws the element `a` within itself"),
    ('<use href="b.svg#a"/>', "xref", "`use` refers to another file, b.svg#a"),
    ('<rect width="1" height="-1"/>', "not_svg", "x.svg:2: `rect`: has a negative size"),
    ('<rect width="1ft" height="1"/>', "not_svg", "width `1ft`, which is not a length"),
    ('<circle r="1e13"/>', "not_svg", "has r `1e13`, which is too large"),
    ('<circle r="1e11" transform="scale(1e11)"/>', "not_svg", "a point beyond 1e\\+12"),
    ('<polygon points="1 2 3"/>', "not_svg", "odd number of coordinates"),
    ('<polygon points="1 nan"/>', "not_svg", "`1 nan` is not a list of numbers"),
    ('<g transform="rotate(1,2)"/>', "not_svg", "`rotate\\(1,2\\)` is not a list of transforms"),
    ('<g style="transform:rotate(3deg)"/>', "not_svg", "put it into the attribute"),
    ('<svg viewBox="0 0 0 1"/>', "not_svg", "the viewBox `0 0 0 1`"),
    ("<inkscape:g a:b='1'/>", "not_svg", "unbound prefix"),
])  # fmt: skip
def test_bad_drawings_are_refused_with_class_and_place(content, refused, words, monkeypatch):
    monkeypatch.setattr(contract, "MAX_ELEMENTS", 2000)
    with pytest.raises(svg.DrawingError, match=words) as caught:
        drawn(content)
    assert caught.value.refused == refused


@pytest.mark.every(3)
@pytest.mark.parametrize(("data", "refused", "words"), [
    (b"", "empty", "the file is empty"),
    (b"<html/>", "not_svg", "x.svg:1: the first element is not `svg`"),
    (b"<svg>", "not_svg", "the file is cut short"),
    (b"<?xml version='1.0' encoding='utf-99'?><svg/>", "not_svg", "encoding"),
    (b'<!DOCTYPE svg [<!ENTITY a "x">]>\n<svg><text>&a;</text></svg>', "not_svg", "x.svg:1: the file declares"),
    (b'<!DOCTYPE svg [<!ENTITY % a SYSTEM "/etc/passwd"> %a;]>\n<svg/>', "not_svg", "declares the entity `a`"),
    (gzip.compress(b"<svg/>")[:-9], "not_svg", "the compressed file is cut short"),
    (b"\x1f\x8bnothing", "not_svg", "the compressed file is damaged"),
])  # fmt: skip
def test_bad_files_are_refused_with_class_and_place(data, refused, words):
    with pytest.raises(svg.DrawingError, match=words) as caught:
        svg.read(data, "x.svg")
    assert caught.value.refused == refused


def test_a_small_file_that_unpacks_to_a_large_one_is_refused(monkeypatch):
    monkeypatch.setattr(svg, "MAX_BYTES", 1000)
    with pytest.raises(svg.DrawingError, match=r"more than 0\.001 MB"):
        svg.read(gzip.compress(b"<svg>" + b" " * 10**6), "x.svgz")


GOOD = f"""<?xml version="1.0"?><!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/svg11.dtd">
<svg {SPACES} width="1mm" viewBox="0 0 1 1"><g inkscape:label="è"><path d="M0 0a1 1 0 012 1zl.5-.5"/></g></svg>"""


@pytest.mark.parametrize("data", [
    GOOD.encode(), GOOD.encode("utf-8-sig"), GOOD.encode("utf-16"), gzip.compress(GOOD.encode()),
    GOOD.replace("?>", " encoding='windows-1252'?>", 1).encode("cp1252"),
])  # fmt: skip
def test_encodings_and_compressed_files(data):
    first, second = svg.read(data, "x").chains
    assert first.layer == second.layer == "è" and first.bulges.any()


def test_sniff_takes_svg_alone():
    assert svg.sniff(b"", ".svg") and svg.sniff(GOOD.encode("utf-16"), ".txt") and svg.sniff(b"\x1f\x8b", ".svgz")
    assert not svg.sniff(b"0,1\n2,3", ".csv") and not svg.sniff(b"", ".dxf")


def test_the_wall_of_the_examples_has_its_size_at_1_to_50():
    drawing = svg.read((EXAMPLES / "drawings" / "wall.svg").read_bytes(), "wall.svg")
    body, opening = drawing.chains
    assert (body.layer, opening.layer, drawing.labels[0].text) == ("Bodies", "Openings", "wall")
    assert (abs(area(body)) - abs(area(opening))) * (50 * drawing.paper) ** 2 == pytest.approx(7.04)
