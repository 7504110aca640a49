"""Formulas that are set: the tree of each, and the three ways in which it is written."""

import json
import re
import shutil
import subprocess
from functools import cache
from itertools import pairwise
from unicodedata import normalize
from xml.etree.ElementTree import fromstring

import pytest
from matplotlib.figure import Figure

from rocking_cli.codes.italian.sheet import build
from rocking_cli.documents import sheet_page, sheet_typst
from rocking_cli.documents.mathematics import MAX_WIDTH, Unreadable, pieces, width
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.questions.verify.printed import formula_of, rows_in, same, steps_of_document
from tests.questions.verify.test_formulas import MORE
from tests.questions.verify.test_sheet import CASES, FACADE, HEAVY, SITE, arithmetic, flat, parts_of, verified

EVERY = {name: (*case, None) for name, case in CASES.items()} | MORE
SVG = '<svg xmlns="http://www.w3.org/2000/svg"'
HOSTILE = "#[]$_*\\ </w:t> \U0001f600 <b>&amp; `x` @y //"


@cache
def formulas(name, language):
    """The symbols, formulas and numbers on the sheet of a case."""
    rows = rows_in(parts_of(*verified(*EVERY[name]), language))
    texts = {(text, False) for row in rows for text in (row.symbol, row.formula)}
    texts |= {(row.numbers, True) for row in rows}
    return {each for each in texts if each[0]}


def read_back(text):
    """A formula as it is read from its MathML."""
    elements = re.findall("<math.*?</math>", str(sheet_page.math(text)))
    return "".join(formula_of(fromstring(each)) for each in elements)


@pytest.mark.every(4)
@pytest.mark.parametrize("language", ["en", "it"])
@pytest.mark.parametrize("name", EVERY)
def test_every_formula_of_every_example_is_set_and_reads_as_it_is_written(name, language):
    every = formulas(name, language)
    assert len(every) > 80
    for text, is_numbers in every:
        found = read_back(text)
        assert same(found, text), text
        if is_numbers:  # parentheses that are left out change no value
            comma = language == "it"
            assert arithmetic(found, comma)[0] == pytest.approx(arithmetic(text, comma)[0], rel=1e-12), text


BY_HAND = {
    "T_[C]/3": "<mfrac>{<msub><mi>T</mi>{<mi N>C</mi>}</msub>}{<mn>3</mn>}</mfrac>",
    "−V/ln(1 − P)": "<mo P>−</mo><mfrac>{<mi>V</mi>}{<mi>ln</mi>"
    "{<mo>(</mo><mn>1</mn><mo>−</mo><mi>P</mi><mo>)</mo>}}</mfrac>",
    "1,68 π √(d/a)": "<mn>1,68</mn>_<mi>π</mi>_<msqrt>{<mfrac>{<mi>d</mi>}{<mi>a</mi>}</mfrac>}</msqrt>",
    "n d^[2]/4 f": "<mfrac>{<mi>n</mi>_<msup><mi>d</mi>{<mn>2</mn>}</msup>}{<mn>4</mn>}</mfrac>_<mi>f</mi>",
    "Σ P x/Σ P": "<mfrac>{<mi N>Σ</mi>_<mi>P</mi>_<mi>x</mi>}{<mi N>Σ</mi>_<mi>P</mi>}</mfrac>",
    "3n/(2n + 1)": "<mfrac>{<mn>3</mn><mi>n</mi>}{<mn>2</mn><mi>n</mi><mo>+</mo><mn>1</mn>}</mfrac>",
    "a^[*]_[SLV]": "<msubsup><mi>a</mi>{<mi>SLV</mi>}{<mi N>*</mi>}</msubsup>",
    "x′^[2]": "<msup><mi>x</mi>{<mi N>′</mi><mn>2</mn>}</msup>",
    "max(1; −2)": "<mi>max</mi>{<mo>(</mo><mn>1</mn><mo>;</mo><mo P>−</mo><mn>2</mn><mo>)</mo>}",
    "|Δx|": "{<mo>|</mo><mi>Δ</mi><mi>x</mi><mo>|</mo>}",
    "g FC": "<mi>g</mi>_<mi>FC</mi>",
}
"""Braces are rows, low lines thin spaces; N is upright and P a sign of one number."""


@pytest.mark.parametrize("text", BY_HAND)
def test_a_formula_is_set_as_by_hand(text):
    wanted = BY_HAND[text].replace(" N>", ' mathvariant="normal">').replace(" P>", ' form="prefix">')
    for sign, element in (("_", '<mspace width="0.17em"/>'), ("{", "<mrow>"), ("}", "</mrow>")):
        wanted = wanted.replace(sign, element)
    assert sheet_page.math(text) == f'<math displaystyle="true">{wanted}</math>'


@pytest.mark.parametrize("text", ["a/", "(a", "a)", "√a", "a ^ b", "a × b", "{x}", "a]", "|a", "·a"])
def test_what_is_no_formula_stays_a_text(text):
    with pytest.raises(Unreadable):
        pieces(text)
    assert "<math" not in sheet_page.math(f"T_[<{text}>]·/")


def test_what_is_wider_than_a_line_can_be_broken():
    text = " + ".join(["(12.3456 · 7.89012)"] * 9)
    rows = pieces(f"({text})/({text})")
    assert len(rows) > 15 and all(width(each) <= MAX_WIDTH for each in rows)
    assert same(read_back(f"({text})/({text})"), f"({text})/({text})")
    assert (
        sheet_page.is_wide("1.23456 · 2.45166 · 3.14159 · 2.71828 · 9.80665")
        and not sheet_page.is_wide("T_[C]/3")
        and not sheet_page.is_wide("{")
    )
    assert "/" in [each.text for row in rows for each in row.parts]  # no line, which could not be broken


@pytest.fixture(scope="module", params=["en", "it"])
def sheet_files(request, tmp_path_factory):
    """The language, and what writes a sheet of a structure file in it."""
    folder = tmp_path_factory.mktemp("set")
    (folder / "site.yaml").write_text(SITE, encoding="utf-8")

    def written(structure, suffix, *more, code=0):
        (folder / "s.yaml").write_text(structure, encoding="utf-8")
        out = folder / f"o{suffix}"
        out.unlink(missing_ok=True)
        asked = ("--site", folder / "site.yaml", "--sheet", out, "--language", request.param, *more)
        result = run("verify", folder / "s.yaml", *asked, code=code)
        return result if code else out

    return request.param, written


def quoted(text):
    return json.dumps(text, ensure_ascii=False)


def words_of(pdf):
    if (program := shutil.which("pdftotext")) is None:
        pytest.skip("no pdftotext to read a PDF")
    return subprocess.run([program, pdf, "-"], capture_output=True, check=True).stdout.decode("utf-8")


class TestPdf:
    @pytest.fixture(autouse=True)
    def needs_typst(self):
        pytest.importorskip("typst")

    @pytest.mark.rest
    def test_it_is_a4_with_a_title_and_the_same_each_time(self, sheet_files, monkeypatch):
        language, written = sheet_files
        monkeypatch.setenv("PATH", "")  # no browser
        content = written(FACADE, ".pdf").read_bytes()
        assert content == written(FACADE, ".pdf").read_bytes() and content.startswith(b"%PDF-")
        boxes = {tuple(map(float, each.split())) for each in re.findall(rb"/MediaBox ?\[([^]]*)\]", content)}
        assert len(boxes) == 1 and boxes.pop() == pytest.approx((0, 0, 210 / 25.4 * 72, 297 / 25.4 * 72), abs=0.5)
        assert re.search(rb"<dc:title>.*?facade", content, re.DOTALL)
        assert re.search(rb"/Lang ?\(" + language.encode(), content)

    @pytest.mark.every(2)
    def test_it_has_headings_results_signs_and_pages(self, sheet_files):
        language, written = sheet_files
        words = words_of(written(HEAVY, ".pdf"))
        names = {
            "en": ["Summary", "Contents", "Appendix A: workings", "Appendix B: files and versions"],
            "it": ["Sintesi", "Indice", "Appendice A: sviluppo dei calcoli", "Appendice B: file e versioni"],
        }
        places = [words.index(each) for each in names[language]]
        assert places == sorted(places)
        count = len(words.split("\f")) - 1
        assert count > 8 and all(f"{k} / {count}" in words for k in range(1, count + 1))
        signs = "Σξζρφη†‡§≥⇒′√·" + ("à" if language == "it" else "")
        assert not [each for each in signs if each not in normalize("NFKC", words)]  # italic letters as others
        found, given = verified(HEAVY, SITE)
        say = build.SHEET.language(language)
        steps = rows_in(parts_of(found, given, language))
        assert len(steps) > 40 and all(flat(say.number(each.value, each.digits)) in words for each in steps)

    @pytest.mark.rest
    @pytest.mark.parametrize("name", ["logo.svg", "logo.png"])
    def test_hostile_names_and_a_logo_are_as_they_are(self, sheet_files, name, tmp_path):
        from PIL import Image

        _, written = sheet_files
        logo = tmp_path / name
        if name.endswith("png"):
            Image.new("RGB", (40, 20), "red").save(logo)
        else:
            logo.write_text(
                '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><rect width="9" height="9"/></svg>'
            )
        structure = HEAVY.replace("name: facade", f"name: {quoted(HOSTILE)}")
        words = " ".join(words_of(written(structure, ".pdf", "--logo", logo, "--project", HOSTILE)).split())
        assert words.count(r"#[]$_*\ </w:t>") > 2 and "<b>&amp; `x` @y //" in words

    @pytest.mark.rest
    def test_a_logo_that_typst_cannot_read_is_said(self, sheet_files, tmp_path):
        _, written = sheet_files
        (tmp_path / "logo.svg").write_text(f'{SVG} width="0" height="0"/>')
        result = written(FACADE, ".pdf", "--logo", tmp_path / "logo.svg", code=1)
        assert "the PDF could not be laid out" in result.stderr and "facade" in result.stdout

    @pytest.mark.rest
    def test_a_long_file_is_listed_over_pages(self, sheet_files, monkeypatch):
        _, written = sheet_files
        monkeypatch.setattr(
            sheet_typst, "figure_of", lambda *_: Figure(figsize=(1, 1))
        )  # a drawing of 300 loads is slow
        loads = "".join(f"  - {{name: load {k}, mass: 10, at: [0, {k / 50}]}}\n" for k in range(1, 300))
        words = words_of(written(f"{HEAVY}loads:\n{loads}", ".pdf"))
        assert "name: load 150," in words and "load 299" in words


@pytest.fixture(scope="module")
def document(sheet_files):
    docx = pytest.importorskip("docx")
    structure = (EXAMPLES / "verify" / "tied_facade.yaml").read_text(encoding="utf-8")
    return docx.Document(str(sheet_files[1](structure, ".docx")))


@pytest.mark.rest
class TestDocument:
    def test_columns_are_as_wide_as_their_cells_and_tables_as_the_text(self, document):
        section = document.sections[0]
        text_width = section.page_width - section.left_margin - section.right_margin
        for table in document.tables:
            widths = [each.width for each in table.columns]
            assert all([cell.width for cell in row.cells] == widths for row in table.rows)
            assert sum(widths) == pytest.approx(text_width, rel=1e-3) and table.autofit is False
            properties = [row._tr.trPr.xpath("*") for row in table.rows]
            names = [{each.tag.rpartition("}")[2] for each in row} for row in properties]
            assert all("cantSplit" in each for each in names)
            assert not any("tblHeader" in each for each in names[1:])

    def test_headings_and_captions_stay_with_what_follows(self, document):
        body = [*document.element.body]
        heads = 0
        for each, after in pairwise(body):
            if after.tag.endswith("}tbl") and after.xpath(".//w:tblHeader"):
                heads += 1
                assert each.xpath("w:pPr/w:keepNext") and all(
                    p.xpath("w:pPr/w:keepNext") for p in after.tr_lst[0].xpath(".//w:p")
                )
        assert heads > 8
        levels = {each.style.name for each in document.paragraphs if each.style.name.startswith("Heading")}
        assert all(document.styles[each].paragraph_format.keep_with_next for each in levels)
        assert sum(bool(each.paragraph_format.page_break_before) for each in document.paragraphs) == 3

    def test_mathematics_has_the_elements_of_office(self, document):
        space = "http://schemas.openxmlformats.org/officeDocument/2006/math"
        found = document.element.body.xpath(".//m:oMath")
        assert len(found) > 120  # of the appendix of the limit state that decides
        inside = {"f": ["num", "den"], "rad": ["radPr", "deg", "e"], "d": ["dPr", "e"], "sSub": ["e", "sub"],
                  "sSup": ["e", "sup"], "sSubSup": ["e", "sub", "sup"]}  # fmt: skip
        seen = set()
        for each in (each for formula in found for each in formula.iter()):
            uri, _, name = each.tag[1:].partition("}")
            seen.add(name)
            assert uri == space
            if name in inside:
                assert [child.tag.rpartition("}")[2] for child in each] == inside[name]
        assert seen > {*inside, "t", "r", "nor"}

    @pytest.mark.rest
    def test_hostile_names_are_as_they_are(self, sheet_files):
        docx = pytest.importorskip("docx")
        _, written = sheet_files
        structure = HEAVY.replace("name: facade", f"name: {quoted(HOSTILE)}").replace("rebound: 0.4\n", (
            f"rebound: 0.4\nloads: [{{name: {quoted('a_[0]' + HOSTILE)}, mass: 2 t, at: [0, 8]}}]\n"
        ))  # fmt: skip
        out = docx.Document(str(written(structure, ".docx")))
        assert HOSTILE in out.paragraphs[0].text and len(steps_of_document(out)) > 30
        page = written(structure, ".html").read_text(encoding="utf-8")
        assert "</w:t>" not in page and "<b>" not in page and "&lt;/w:t&gt; \U0001f600" in page
