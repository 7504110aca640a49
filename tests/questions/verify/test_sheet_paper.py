"""The calculation sheet as a paper: what decides first, the headings of the code, figures, and sums of each addend."""

import re
from math import pi, sqrt

import numpy as np
import pytest
from markupsafe import Markup
from matplotlib.figure import Figure

from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.ground import SiteGround, site_demand
from rocking_cli.codes.italian.sheet import build, figures
from rocking_cli.codes.italian.sheet.geometry import Composition
from rocking_cli.codes.italian.site import of_structure
from rocking_cli.core import Direction
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.documents import sheet_docx, sheet_page
from rocking_cli.documents.figures import inline_svg, svg, svg_element
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.questions.selfcheck.study import CHECKS
from rocking_cli.studies.picture import picture
from rocking_cli.views.view import Table
from tests.browser import launch
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES, PROJECT
from tests.questions.verify.printed import rows_in
from tests.questions.verify.test_sheet import (
    CASES,
    CASES_WRITTEN,
    FACADE,
    SITE,
    SLC,
    TABLE_OF_HAZARD,
    WALL,
    items_of,
    number,
    parts_of,
    verified,
)

pytestmark = pytest.mark.drawn

G = 9.80665
DOCS = PROJECT / "docs"
TIED_FACADE = (EXAMPLES / "verify" / "tied_facade.yaml").read_text(encoding="utf-8")
LINKAGE = (EXAMPLES / "linkage.yaml").read_text(encoding="utf-8")
HEADINGS = {
    "en": [
        "Summary", "Methods and remarks", "Assumptions", "Structure, capacity and demand",
        "Calculation by a program (NTC 2018, §10.2.1)",
        "Kind of analysis", "Origin and features of the program", "Reliability and validation of the program",
        "Presentation of the results", "General information on the calculation",
        "Reasoned judgement of the acceptability of the results",
        "Appendix A: workings", "How to read it", "Loads and ties", "Site data", "Site", "Ground at SLV",
        "Positive direction (clockwise)", "Kinematic chain, at rest", "Appendix B: files and versions",
        "Structure file", "Site file",
    ],
    "it": [
        "Sintesi", "Metodi e osservazioni", "Ipotesi di calcolo", "Struttura, capacità e domanda",
        "Calcolo mediante codice (NTC 2018, §10.2.1)",
        "Tipo di analisi svolta", "Origine e caratteristiche dei codici di calcolo",
        "Affidabilità e validazione dei codici utilizzati", "Modalità di presentazione dei risultati",
        "Informazioni generali sull'elaborazione", "Giudizio motivato di accettabilità dei risultati",
        "Appendice A: sviluppo dei calcoli", "Come leggere la relazione", "Carichi e catene", "Dati del sito", "Sito",
        "Azione sismica allo SLV", "Verso positivo (orario)", "Catena cinematica, a riposo",
        "Appendice B: file e versioni", "File della struttura", "File del sito",
    ],
}  # fmt: skip


def page_in(language, folder):
    """The page of a facade with loads and a tie in a language."""
    (folder / "s.yaml").write_text(TIED_FACADE, encoding="utf-8")
    (folder / "site.yaml").write_text(SITE, encoding="utf-8")
    files = (folder / "s.yaml", "--site", folder / "site.yaml", "--sheet", folder / "o.html")
    run("verify", *files, "--language", language)
    return (folder / "o.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module", params=["en", "it"])
def page(request, tmp_path_factory):
    """The language, and the page in it, without its pictures."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sheet_page, "inline_svg", lambda *_: "")
        return request.param, page_in(request.param, tmp_path_factory.mktemp("sheet"))


def plain(html):
    """The text of a piece of a page."""
    text = re.sub(r"<[^>]+>", "", html)
    for sign, entity in (("'", "&#39;"), ("&", "&amp;")):
        text = text.replace(entity, sign)
    return text


def in_order(wanted, found):
    rest = iter(found)
    return all(each in rest for each in wanted)


def test_headings_stand_in_their_order_and_the_contents_lead_to_them(page):
    language, text = page
    headings = [plain(each) for each in re.findall(r"<h[2-6][^>]*>(.*?)</h[2-6]>", text)]
    assert in_order(HEADINGS[language], headings)
    links = dict(re.findall(r'<a href="#([^"]+)">(.*?)</a>', text[text.index('<nav class="contents"') :]))
    sections = dict(re.findall(r'<section id="([^"]+)".*?\n<h\d[^>]*>(.*?)</h', text))
    assert links == sections and len(links) > 25


def test_the_first_page_has_what_decides_and_a_place_to_sign(page):
    language, text = page
    first = text[text.index("<header>") : text.index('<nav class="contents"')]
    words = plain(first)
    wanted = [
        "facade",
        "SLV",
        "Signature",
        "Stamp",
        "Client",
        "NTC 2018, §8.3",
        "Nonlinear method at SLV",
        "satisfied only if the plates of the tie bar are at least",
    ]
    if language == "it":
        wanted = ["facade", "SLV", "Firma", "Timbro", "Committente", "NTC 2018, §8.3", "Metodo non lineare allo SLV",
                  "soltanto se i capochiave della catena «bar» sono spessi"]  # fmt: skip
    assert all(each in words for each in wanted)
    assert "ul class=" not in first and first.count("<figure>") == 1  # the mechanism, and no workings
    assert first.count("<dd></dd>") == 4 + 4  # project, place, client and author are blanks, as is the signature
    assert text.count('<p class="open">') == 2  # what only the designer can write
    assert re.search(r"@page \{\s*size: A4; margin:", text)


def test_figures_have_the_numbers_of_the_structure(tmp_path, monkeypatch):
    def wide(draw, prefix):
        return Markup(f'<div class="wide">{svg_element(draw(), prefix)}</div>')

    monkeypatch.setattr(sheet_page, "inline_svg", wide)
    text = page_in("en", tmp_path)
    pictures = [" ".join(map(plain, re.findall(r"<text.*?</text>", each, re.DOTALL)))
                for each in re.findall(r'<div class="wide">(<svg.*?</svg>)', text, re.DOTALL)]  # fmt: skip
    assert len(pictures) == 4
    # 18 kN/m3 of a wall 0.6 x 8 x 5 m; half of 24 and of 18 kN/m over 5 m; one bar of 14 mm of 235 MPa.
    bar = pi * 0.014**2 / 4 * 235e3
    for each in (
        f"1 block: P = {18 * 0.6 * 8 * 5:.4g} kN", f"P = {24 * 5 / 2:.4g} kN", f"P = {18 * 5 / 2:.4g} kN",
        f"4 bar: {bar:.4g} kN (arm 7.5 m)", "b1, b2 = 0.3 m", "b3 = 0.45 m", "h2 = 8 m",
    ):  # fmt: skip
        assert each in pictures[1], each
    assert "spectrum of SLV, ξ = 8 %" in pictures[2] and "spectral displacement [m]" in pictures[3]


def test_capacity_and_demand_stand_where_they_are():
    """The spectrum is by hand: constant velocity between T_C = 0.4 s and T_D = 2.4 s, with 8 % damping."""
    found, given = verified(*CASES["facade"])
    side = found.distinct[0]
    demand = site_demand(SiteGround(of_structure(given, found.mechanism)).site)
    (axes,) = figures.draw_capacity(build.SHEET.language("en"), {"both": side}, "facade", demand=demand).axes
    lines = {each.get_label(): each for each in axes.get_lines()}
    at = side.states["SLV"]
    assert lines["capacity d_SLV"].get_xydata()[0] == pytest.approx([at.d, at.a])
    steep = (2 * pi / at.T) ** 2
    assert lines["demand at SLV"].get_xydata()[0] == pytest.approx([at.demand, steep * at.demand])
    assert lines["line of the period T_SLV"].get_slope() == pytest.approx(steep)
    x, y = lines["spectrum of SLV, ξ = 8 %"].get_xydata().T
    falling = slice(int(y.argmax()), int(x.argmax()))
    for T in (0.6, 1.0, 2.0):
        S_e = 0.2 * G * 1.2 * sqrt(10 / 13) * 2.5 * 0.4 / T
        d = S_e * (T / (2 * pi)) ** 2
        assert np.interp(d, x[falling], y[falling]) == pytest.approx(S_e, rel=1e-3)
    d, a = lines["exact curve"].get_xydata().T
    assert a[0] == pytest.approx(side.a0) and d[-1] == pytest.approx(side.d0) and a[-1] == pytest.approx(0, abs=1e-9)


def test_what_a_sheet_says_of_its_validation_is_what_the_pages_have(tmp_path, monkeypatch):
    """The numbers of the table: those of the pages of the documentation, and of `selfcheck`."""
    monkeypatch.setattr(sheet_page, "inline_svg", lambda *_: "")
    for file, text in (("s", FACADE), ("site", SITE)):
        (tmp_path / f"{file}.yaml").write_text(text, encoding="utf-8")
    sheet = tmp_path / "o.html"
    run("verify", tmp_path / "s.yaml", "--site", tmp_path / "site.yaml", "--sheet", sheet, "--pulse", "sine:0.05g:0.5s")
    words = plain(sheet.read_text(encoding="utf-8"))
    validation = (DOCS / "validation.md").read_text(encoding="utf-8").split("## ")
    rows = [each for part in validation[1:3] for each in part.splitlines() if each.startswith("| ")]
    rows = [each for each in rows if "| reference |" not in each]
    assert f"{len(rows)} formulas and numbers of the literature" in words
    assert f"in {len(CHECKS)} checks that rocking selfcheck repeats" in words
    cells = [each.split(" | ") for each in (DOCS / "scoreboard.md").read_text(encoding="utf-8").splitlines()]
    scores = {each[0].removeprefix("| "): each for each in cells if len(each) == 8}
    boulders, pulses, base = (scores[key] for key in (
        "granite boulders", "shakebot pulses", "shakebot pulses, by base rates"
    ))  # fmt: skip
    right = 100 * float(boulders[6].split()[0])
    assert f"{boulders[2]} shake-table tests of two granite boulders" in words and f"{right:.3g} % of the" in words
    assert f"{pulses[2]} further tests under pulses" in words
    assert float(pulses[3].split()[0]) >= float(base[3].split()[0])  # the Brier score is the smaller the better


def test_the_hazard_is_drawn_with_its_rows_and_the_limit_states():
    """The rows of CASES, and the ground of SLC at 975 years, where the table has a row."""
    found, given = verified(*CASES["laden, on a hazard"])
    ground = SiteGround(of_structure(given, found.mechanism))
    figure = figures.draw_hazard(build.SHEET.language("en"), ground, ground.hazard, "hazard")
    for k, axes in enumerate(figure.axes, 1):
        curve, rows, *states = axes.get_lines()
        assert rows.get_xydata().tolist() == [[row[0], row[k]] for row in TABLE_OF_HAZARD]
        assert [each.get_label() for each in states] == ["SLD", "SLV", "SLC"]
        TR = [-50 / np.log(1 - P) for P in (0.63, 0.1, 0.05)]
        x, y = np.array(TABLE_OF_HAZARD)[:, [0, k]].T
        wanted = np.exp(np.interp(np.log(TR), np.log(x), np.log(y)))
        assert np.array([each.get_xydata()[0] for each in states]) == pytest.approx(np.array([TR, wanted]).T)
        at = np.searchsorted(curve.get_xdata(), 475)
        assert curve.get_ydata()[at] == pytest.approx(y[3], rel=0.01)


@pytest.mark.parametrize(("name", "language"), CASES_WRITTEN[-2:])
def test_what_a_formula_stands_on_is_what_its_lines_are_marked_with(name, language):
    parts = parts_of(*verified(*CASES[name]), language)
    workings = next(each for each in parts if each.key == "workings")
    (table,) = [each for each in workings.parts[-1].items if isinstance(each, Table)]
    lines = [line for line in rows_in(workings.parts) if line.clause and line.standing != "plain"]
    marks = {"transcription": "(*)", "code": "(†)", "ours": "(‡)"}
    assert {(row[0], re.search(r"\(.\)$", row[3])[0]) for row in table.rows} == {
        (line.clause, marks[line.standing]) for line in lines
    }
    formulas = [(row[0], row[2]) for row in table.rows]
    assert len({*formulas}) == len(formulas) > 15 and {row[2] for row in table.rows} <= {
        line.formula or "–" for line in lines
    }


def test_a_force_has_its_size_beside_it_and_a_block_of_many_weights_its_sum():
    loads = [f"{{name: m{k}, mass: 1000, at: [0, {k}]}}" for k in range(1, 8)]
    text = WALL.replace("wall\nname", "block\nname").replace(
        "thickness: 0.3\nheight: 3", "width: 1\nheight: 8\nmass: 1000"
    )
    pushed = "{name: push, force: [-2 kN, 0 kN], at: [-0.5, 6]}"
    found, _ = verified(f"{text}loads: [{', '.join([*loads, pushed])}]\n", SITE)
    side = found.directions[Direction.POSITIVE]
    figure = figures.draw_chain(build.SHEET.language("en"), side)
    (axes,) = figure.axes
    assert {"1", "2"} < {each.get_text() for each in axes.texts}
    below = figure.texts[1].get_text().splitlines()
    assert f"1 block 1: P = {8 * G:.4g} kN" in below and "2 push: -2 kN (arm 6 m)".replace("-", "−") in below


def test_no_rounding_error_is_printed():
    for structure in (LINKAGE, TIED_FACADE):
        assert not re.search(r"10\^\[−(9|\d\d)", repr(items_of(*verified(structure, SITE))))


def test_names_of_bodies_are_in_italian_unless_they_are_the_users():
    wall = repr(items_of(*verified(WALL, SITE), "it"))
    assert "blocco superiore" in wall and "upper block" not in wall
    assert "upper" in repr(items_of(*verified(LINKAGE, SITE), "it"))
    arch = (EXAMPLES / "arch.yaml").read_text(encoding="utf-8")
    assert "concio 2" in repr(items_of(*verified(arch, SITE), "it"))


def test_a_document_has_the_figures_and_the_contents(tmp_path, monkeypatch):
    docx = pytest.importorskip("docx")
    monkeypatch.setattr(sheet_docx, "figure_of", lambda *_: Figure(figsize=(1, 1)))
    (tmp_path / "s.yaml").write_text(TIED_FACADE, encoding="utf-8")
    (tmp_path / "site.yaml").write_text(SITE, encoding="utf-8")
    run("verify", tmp_path / "s.yaml", "--site", tmp_path / "site.yaml", "--sheet", tmp_path / "o.docx")
    document = docx.Document(str(tmp_path / "o.docx"))
    described = [each._inline.docPr.get("descr") for each in document.inline_shapes]
    assert len(described) == 4 and all(each and not re.search(r"[_^]\[", each) for each in described)
    assert "TOC \\o &quot;1-2&quot;" in document.element.xml and "PAGE" in document.sections[0].footer._element.xml
    headings = [each.text for each in document.paragraphs if each.style.name.startswith("Heading")]
    assert in_order(HEADINGS["en"], headings)
    highlighted = [each for each in document.paragraphs if any(run.font.highlight_color for run in each.runs)]
    assert len(highlighted) == 2


@pytest.mark.parametrize("control", [None, (0.3, 8.0, "block")])
def test_what_it_would_be_without_ties_and_by_the_letter(control):
    """A facade with a tie, and floors that slide: each column is a verification of its own structure."""
    site = SITE + SLC
    slides = TIED_FACADE.replace("floor: borne", "floor: sliding")
    found, given = verified(slides, site, control)
    (table,) = (
        item for part in parts_of(found, given) for item in part.items
        if isinstance(item, Table) and item.title.startswith("As calculated, and otherwise")
    )  # fmt: skip
    assert table.columns == ["", "as calculated", "without ties", "P + Q by our reading"]
    rows = {row[0]: row[1:] for row in table.rows}
    bare, _ = verified(slides.partition("ties:")[0], site, control)
    shares = "horizontal: 0.5, vertical: 0.333333, weight: 0.5"
    literal, _ = verified(slides.replace("floor: sliding", shares), site, control)
    side = literal.deciding
    assert side.a0 == pytest.approx(found.deciding.a0, rel=1e-12)
    own = Chain(parse_structure(slides, "s.yaml", "test", Registry()).at_strength(), side.direction)
    for k, side in ((0, found.deciding), (1, bare.deciding)):
        assert number(rows["α_[0]"][k]) == pytest.approx(side.chain.alpha0, rel=5e-4)
        for state, at in side.states.items():
            assert number(rows[f"{state}: capacity d [m]"][k]) == pytest.approx(at.d, rel=5e-4)
            assert number(rows[f"{state}: demand d [m]"][k]) == pytest.approx(at.demand, rel=5e-4)
    assert number(rows["α_[0]"][2]) == pytest.approx(own.alpha0, rel=5e-4)
    assert number(rows["a_[0]^[*] [m/s²]"][2]) == pytest.approx(own.alpha0 * G / (own.e_star * 1.35), rel=5e-4)


@pytest.mark.parametrize(("name", "rows"), [
    ("facade", {"support": "on the ground", "direction": "both", "compressive strength": "unlimited"}),
    ("tied", {"support": "on the ground", "direction": "positive only", "ties": "act from rest on"}),
    ("parapet on a floor", {"support": "a floor at z = 6 m of a building 9 m high"}),
    ("on rock, by state", {"knowledge": "confidence factor FC = 1.35"}),
])  # fmt: skip
def test_assumptions_are_those_of_the_structure_and_its_site(name, rows):
    part = next(each for each in parts_of(*verified(*CASES[name])) if each.key == "assumptions")
    (table,) = (each for each in part.items if isinstance(each, Table))
    printed = dict(table.rows)
    assert all(printed[key].startswith(text) for key, text in rows.items())
    assert ("ties" in printed) == (name == "tied")


def test_pictures_of_a_page_have_the_digits_that_are_seen():
    figure = Figure()
    figure.subplots().plot(np.linspace(0, 1, 50), np.sin(np.linspace(0, 9, 50)))
    page = inline_svg(lambda: figure, "a").partition('<div class="narrow">')[0]
    lines, whole = (re.findall(r'<path[^>]* d="([^"]*)"', text) for text in (page, svg(figure, "a")))
    assert len(lines) == len(whole) > 3
    # Marks have the look of their uses, which the style sheet of a dark page finds.
    assert "<use" in page and not re.search(r'<path id="a-m[^>]*style', page)
    for line, other in zip(lines, whole, strict=True):
        assert "\n" not in line and not re.search(r"\.\d{3}", line)
        values = (np.array(re.findall(r"[-\d.]+", each), dtype=float) for each in (line, other))
        assert np.allclose(*values, atol=0.011)


PUSHED = """
mechanism: block
name: pushed
width: 0.6 m
height: 8 m
depth: 5 m
density: 18 kN/m3
one_sided: positive
loads:
  - {name: roof, mass: 12 kN/m, at: [0.0, 8.0], floor: borne, seat: 0.25}
  - {name: thrust of the rafters, force: [6 kN, 0], at: [0.0, 8.0]}
  - {name: thrust of the vault, force: [9 kN, -12 kN], at: [0.0, 8.0]}
  - {name: thrust of the arch, force: [4 kN, 0], at: [0.0, 8.0]}
  - {name: weight of the gutter, force: [1 kN, -2 kN], at: [0.0, 8.0]}
  - {name: floor, mass: 2 t, at: [-0.1, 4.0], floor: sliding, seat: 0.2}
  - {name: upper tie, force: [-4 kN, 0], at: [0.0, 8.0]}
  - {name: lower tie, force: [-3 kN, 0], at: [-0.3, 7.9]}
"""


def covered(figure):
    """Pairs of labels in a figure that cover one another, in pixels."""
    figure.canvas.draw()
    texts = [each for axes in figure.axes for each in axes.texts if each.get_text()]
    boxes = [each.get_window_extent() for each in texts]
    return [
        (texts[i].get_text(), texts[k].get_text())
        for i, one in enumerate(boxes) for k, other in enumerate(boxes[:i])
        if min(one.x1, other.x1) - max(one.x0, other.x0) > 1 and min(one.y1, other.y1) - max(one.y0, other.y0) > 1
    ]  # fmt: skip


@pytest.mark.parametrize("structure", [PUSHED, TIED_FACADE])
def test_labels_of_forces_do_not_cover_one_another(structure):
    found, _ = verified(structure, SITE)
    (side,) = found.distinct
    of_chain = figures.draw_chain(build.SHEET.language("it"), side)
    at_rest = draw_structure(picture(side.chain.mechanism), "pushed")
    assert not covered(of_chain) and not covered(at_rest)
    numbers = {each.get_text() for each in of_chain.axes[0].texts}
    below = of_chain.texts[1].get_text()
    names = [f"{each.name}: " for each in (*(side.chain.mechanism.loads or []), *(side.chain.mechanism.ties or []))]
    assert all(name in below for name in names) and {str(k) for k in range(1, len(names) + 2)} < numbers


def test_a_load_is_drawn_in_the_unit_of_the_file():
    texts = {each.name: each.text for each in picture(parse_structure(PUSHED, "s", "s")).loads}
    assert (texts["roof"], texts["floor"]) == ("12 kN/m", "2 t")


@pytest.mark.parametrize(("seat", "ends"), [(None, "d0"), (0.1, "seat")])
def test_a_capacity_curve_is_drawn_to_where_the_capacity_ends(seat, ends):
    load = f"{{name: roof, mass: 6 t, at: [0, 8]{'' if seat is None else f', seat: {seat}'}}}"
    found, _ = verified(CASES["facade"][0] + f"mass: 40000\nloads: [{load}]\n", SITE)
    side = found.distinct[0]
    (axes,) = figures.draw_capacity(build.SHEET.language("en"), {"both": side}, "facade").axes
    lines = {each.get_label(): each.get_xydata() for each in axes.get_lines()}
    x, y = lines["exact curve"][-1]
    # By hand: the top of a block of 0.6 x 8 m, 8 m above its foot, has moved sideways by 0.1 m.
    wanted = {"d0": side.d0, "seat": side.exact.seat.d if side.exact.seat else None}[ends]
    assert x == pytest.approx(wanted) and (ends == "seat" or y == pytest.approx(0.0, abs=1e-9))
    assert lines["straight line"][-1] == pytest.approx([x, side.a0 * (1 - x / side.d0)])
    assert (x < 0.7 * side.d0) == (ends == "seat")


def test_strips_of_their_own_lengths_are_drawn_from_the_front():
    gable = parse_structure((EXAMPLES / "walls" / "gable.yaml").read_text(encoding="utf-8"), "g.yaml", "gable")
    strips = Composition(gable).strips
    (axes,) = figures.draw_front(build.SHEET.language("it"), "gable", strips).axes
    boxes = [each.get_bbox().bounds for each in axes.patches]
    assert boxes == [pytest.approx((-L / 2, k, L, 1.0)) for k, L in enumerate((6.67, 4.0, 1.33))]
    assert [each.get_text() for each in axes.texts] == ["6,67 m", "4 m", "1,33 m"]
    assert not Composition(parse_structure(TIED_FACADE, "t.yaml", "t")).strips


@pytest.mark.rest
def test_pages_have_a_running_header(tmp_path):
    (tmp_path / "s.yaml").write_text(TIED_FACADE, encoding="utf-8")
    (tmp_path / "site.yaml").write_text(SITE, encoding="utf-8")
    head = "--project", 'Church "A" & B', "--place", "Norcia", "--client", "Town <1>"
    for suffix in (".html", ".docx"):
        files = (tmp_path / "s.yaml", "--site", tmp_path / "site.yaml", "--sheet", tmp_path / f"o{suffix}")
        run("verify", *files, *head)
    wanted = 'Calculation sheet: facade · Church "A" & B · Norcia · Town <1>'
    page = (tmp_path / "o.html").read_text(encoding="utf-8")
    written = re.search(r'@top-left { content: "(.*)"; font', page)[1]
    assert re.sub(r"\\([0-9a-f]+) ", lambda each: chr(int(each[1], 16)), written) == wanted
    assert '"' not in written and "<" not in written
    docx = pytest.importorskip("docx")
    assert docx.Document(str(tmp_path / "o.docx")).sections[0].header.paragraphs[0].text == wanted


@pytest.mark.rest
def test_at_most_six_pages_stand_before_the_workings(tmp_path):
    """Of two directions and in Italian, the longest of the examples, as a browser prints it."""
    browser, driver = launch()
    files = (EXAMPLES / "verify" / "parapet.yaml", "--site", EXAMPLES / "verify" / "site.yaml")
    run("verify", *files, "--sheet", tmp_path / "o.html", "--language", "it")
    try:
        page = browser.new_page()
        page.goto((tmp_path / "o.html").as_uri())
        printed = page.pdf(prefer_css_page_size=True, outline=True, tagged=True)
    finally:
        browser.close()
        driver.stop()
    (workings,) = re.findall(rb"Appendice A[^>]*/Dest \[(\d+) 0 R", printed)
    pages = re.findall(rb"(\d+) 0 obj\s*<</Type /Page\b", printed)
    assert 4 <= pages.index(workings) <= 6
