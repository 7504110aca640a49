"""The Italian sheet has no English word but those of the user, in its figures neither, and its numbers are Italian."""

import platform
import re
from html import unescape
from importlib.resources import files
from itertools import chain, cycle
from pathlib import Path
from string import Formatter

import pytest
import yaml
from markupsafe import Markup
from matplotlib.text import Text

import rocking_cli as rk
from rocking_cli.codes.italian.sheet import build
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.documents import sheet_page
from rocking_cli.errors import InputError
from rocking_cli.processing.oscillator import Floor
from rocking_cli.views.sheet.language import Language, texts_of
from rocking_cli.views.verification import view
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.questions.verify.test_sheet import ARCH, CASES, FLOOR, SITE, SLC, TIED, verified

PACKAGES = "rocking_cli.codes.italian", "rocking_cli.views.sheet", "rocking_cli.questions.survey"
FAMILIES = "drawing", "caution", "source", "version", "shape", "point", "reason", "doubt", "figure", "support", "shown"
OF_BOTH = """
    quadrature coordinate ordinate curve width m² ij scoreboard cos sin
    ab all allegato area base bc cd circolare cli computer data de dm fc ferris file formula in kg km kn lc lin loi mpa
    ii iii iv ntc per plugin python rad rocking sha slc sld slv software state tan tc tin validation δl δx π² s² t²
"""
"""Words of the English texts that Italian has too, symbols, and names."""
FUNCTION_WORDS = """
    an and are as at be been between beyond but by do does each for from given has have if into is it its made more most
    no none not of off on one or out over than that the their them then there these they this those to under until was
    were what when where which while with without
"""
STRUCTURES = sorted(
    each for each in EXAMPLES.rglob("*.yaml")
    if "plugin" not in each.parent.name and re.search("^mechanism:", each.read_text(encoding="utf-8"), re.MULTILINE)
    and each.stem != "statue_on_plate"  # of a museum: the numbers are refused as those of masonry
)  # fmt: skip
SITES = {"hazard": (EXAMPLES / "verify" / "site.yaml").read_text(encoding="utf-8"), "floor": SITE + FLOOR + SLC}
GROUND = (EXAMPLES / "verify" / "ground.yaml").read_text(encoding="utf-8")
NOT_TEXT = (
    re.escape(platform.platform(terse=True)), r"\S+\.yaml", r"\b[0-9a-f]{64}\b",
    r"(?<=meccanismo )[a-z_]+(?= rocking-cli)", "BSD-3-Clause", "Engineering Structures",
)  # fmt: skip
"""The system, files and checksums, the key of a mechanism, a licence, and a journal."""
NUMBER = re.compile(r"\d+[.,]\d+")
NAMED = "blocks", "bodies", "ground", "parts", "joints"
"""Fields with the names of the user as keys."""


def words(text):
    return {each.lower() for each in re.findall(r"[^\W\d_]{2,}", text)}


def english_words(packages):
    """The words of the English texts, and of what mechanisms say of themselves, that are not also Italian."""
    known = Registry()
    own = [known[key] for key in known if known[key].__module__.startswith("mechanisms.")]
    texts = [text for each in own for text in (each.title, each.caution, re.sub(r"[A-Z]\w+", "", each.source))]
    for package in packages:
        english, italian = (texts_of(package, key) for key in ("en", "it"))
        texts += english.values()
        texts += [re.sub(rf"^({'|'.join(FAMILIES)}|body_\w+) ", "", key) for key in italian
                  if not key.isidentifier() or ("_" not in key and key not in english)]  # fmt: skip
        folder = files(package) / "texts" / "en"
        pages = (each.read_text(encoding="utf-8") for each in (folder.iterdir() if folder.is_dir() else ()))
        texts += [re.sub(r"\{[{%].*?[%}]\}|<[^>]*>", "", page) for page in pages]
    return (words(re.sub(r"`[^`]*`|\{[^}]*\}", "", " ".join([*texts, FUNCTION_WORDS])))) - words(OF_BOTH)


ENGLISH = english_words(PACKAGES)


def names_of(data):
    """The names that a user gave in a file."""
    if isinstance(data, list):
        return set(chain.from_iterable(map(names_of, data)))
    if not isinstance(data, dict):
        return set()
    own = {str(data["name"])} if "name" in data else set()
    for key in NAMED:
        own |= {str(each) for each in data[key]} if isinstance(data.get(key), dict) else set()
    return own.union(*map(names_of, data.values()))


def rest_of(page, *sources):
    """The text of a page without its listings, the names of the user, and commands and fields."""
    text = re.sub(r"<(style|script|pre|code)\b.*?</\1>|<[^>]*>", " ", page, flags=re.DOTALL)
    text = " ".join(re.sub(r"`[^`]*`", " ", unescape(text)).split())
    for each in NOT_TEXT:
        text = re.sub(each, " ", text)
    names = chain.from_iterable(names_of(yaml.safe_load(each)) for each in sources)
    for name in sorted(names, key=len, reverse=True):
        text = re.sub(rf"(?<![\w.]){re.escape(' '.join(name.split()))}(?!\w)", " ", text)
    return text


def figures_as_text(monkeypatch):
    """Figures of pages are not rendered: their texts stand in their place."""

    def texts(figure, _):
        every = (each.get_text() for each in figure().findobj(Text) if each.get_visible())
        return Markup(" ").join(map(Markup.escape, every))

    monkeypatch.setattr(sheet_page, "inline_svg", texts)


@pytest.fixture
def text_of(tmp_path, monkeypatch):
    """Returns the text of the Italian sheet of a structure, with the texts of its figures, which are not rendered."""

    figures_as_text(monkeypatch)
    monkeypatch.chdir(tmp_path)

    def made(structure, site, **options):
        if isinstance(structure, str):
            Path("s.yaml").write_text(structure, encoding="utf-8")
            structure = Path("s.yaml")
        Path("t.yaml").write_text(site, encoding="utf-8")
        rk.verify(structure, "t.yaml", sheet="o.html", language="it", **options)
        names = yaml.safe_dump({"names": [{"name": each} for each in options.get("motions", ())]})
        return rest_of(
            (tmp_path / "o.html").read_text(encoding="utf-8"), structure.read_text(encoding="utf-8"), site, names
        )

    return made


SYMBOLS = {"alpha", "lambda", "eta", "kappa", "cr", "xi"}


def check(text):
    assert not {
        each: re.findall(rf".{{0,30}}{each}.{{0,30}}", text, re.IGNORECASE) for each in words(text) & ENGLISH - SYMBOLS
    }
    assert len(text) > 5000
    places = r"§\S+|\[C?\d[\d.]*\]|par\. [\d.]+|(rocking-cli|Python|numpy|scipy|matplotlib) [\d.]+\S*"
    numbers = re.sub(places, " ", text)
    assert not re.findall(r".{20}\d\.\d.{20}", numbers)
    assert not [each for each in re.findall(r"· 10 −(\d+)", numbers) if int(each) > 8]  # by rounding alone
    assert not re.search(r"\b(il|del|al|dal|nel|sul|fino al) (8\d*|11) ?[,%]", text)
    assert not re.search(r"\bdondol|tirant|\bd[ia] SL[DVCO]", text)


@pytest.mark.every(7)
@pytest.mark.parametrize("name", CASES)
def test_every_case_is_italian(name, text_of):
    check(text_of(*CASES[name]))


@pytest.mark.rest
@pytest.mark.parametrize(
    ("structure", "site"),
    [*zip(STRUCTURES, cycle(SITES))],
    ids=[f"{each.parent.name}-{each.stem}" for each in STRUCTURES],
)
def test_every_example_is_italian(structure, site, text_of):
    """On the ground and on a floor in turn."""
    check(text_of(structure, SITES[site]))


SPANNING = "mechanism: spanning_wall\nname: w\nthickness: 0.3\nheight: 3\ndensity: 1800\ndepth: 1\noverburden: 5 kN\n"
COLUMNS = "mechanism: symmetric_frame\nname: c\ncolumn_width: 0.5\ncolumn_height: 5\nmass_ratio: 2\n"
ASSEMBLY = "mechanism: assembly\nname: m\ndensity: 2000\ndepth: 1\n"
SOIL = "ground: {soil: {polygon: [[-3, -0.5], [5, -0.5], [5, 0], [-3, 0]]}%s}\n"
LID = ", lid: {polygon: [[-2, 1.2], [2, 1.2], [2, 2], [-2, 2]]}"
TALL = "{polygon: [[0, 0], [1.2, 0], [1.2, 4], [0, 4]]}"
LOW = "{polygon: [[1.2, 0], [1.8, 0], [1.8, 1.5], [1.2, 1.5]]}"
GRAIN = "{polygon: [[3, 0], [3.000001, 0], [3.000001, 0.00001], [3, 0.00001]]}"
SQUAT = "{polygon: [[0, 0], [1, 0], [1, 1.2], [0, 1.2]]}"
ODD = {
    "hinge too low": SPANNING + "hinge: 0.5\n",
    "hinge near the top": SPANNING.replace("5 kN", "1 N") + "hinge: 0.5\n",
    "hinge not searched": SPANNING + "hinge: 0.6\nloads: [{name: a, mass: 5, at: [0, 1], body: lower block}]\n",
    "crushing": SPANNING + "hinge: 0.6\ncrushing: {strength: 2000000}\n",
    "columns": COLUMNS + "columns: 30\n",
    "glued": f"{ASSEMBLY}{SOIL % ''}blocks: {{tower: {TALL}, side: {LOW}}}\n",
    "arch with loads": ARCH + "density: 2000\ndepth: 1\nloads: [{name: a, mass: 5, at: [0, 10], body: segment 2}]\n",
    "arch of many voussoirs": re.sub("voussoirs:.*", "voussoirs: 400", ARCH),
    "elastic tie": TIED.replace("prestress: 9000", "prestress: 9"),
}
"""Structures with remarks, cautions and notes that no example has."""
NOT_VERIFIED = {
    "grain": f"{ASSEMBLY}{SOIL % ''}friction: 0.6\nblocks: {{tower: {TALL}, grain: {GRAIN}}}\n",
    "confined": f"{ASSEMBLY}{SOIL % LID}friction: 0.4\nblocks: {{squat: {SQUAT}}}\n",
    "top": SPANNING.replace("5 kN", "1 kN") + "hinge: 0.8\n",
}


@pytest.mark.rest
@pytest.mark.parametrize("name", ODD)
def test_what_no_example_has_is_italian(name, text_of):
    check(text_of(ODD[name], SITES["hazard"]))


@pytest.mark.parametrize("name", NOT_VERIFIED)
def test_cautions_are_italian_with_the_same_numbers(name):
    text = NOT_VERIFIED[name]
    caution = parse_structure(text, "s.yaml", "test", Registry()).own_caution()
    translated = build.SHEET.language("it").recognised("caution", caution)
    assert not words(re.sub(r"`[^`]*`", "", translated).replace("grain", "")) & ENGLISH
    assert [each.replace(",", ".") for each in NUMBER.findall(translated)] == NUMBER.findall(caution)


@pytest.mark.every(2)
@pytest.mark.parametrize("site", [*SITES.values(), GROUND])
def test_histories_are_italian(site, text_of):
    check(text_of(EXAMPLES / "verify" / "tied_facade.yaml", site, motions=["sine:0.09g:0.5s", "ricker:2g:1s"]))


def test_an_english_word_is_noticed(text_of):
    text = text_of(*CASES["facade"])
    for word in ("the", "Capacity", "at rest", "demand by direction"):
        with pytest.raises(AssertionError, match=word.split()[0].lower()):
            check(f"{text} {word}.")


def test_texts_of_mechanisms_are_recognised_whole_by_parts_and_otherwise_stay():
    say = build.SHEET.language("it")
    for family, text, translated in [
        ("source", "DeJong and Dimitrakopoulos (2014), Eqs. 1-6; Housner (1963)",
         "DeJong e Dimitrakopoulos (2014), eqq. 1-6; Housner (1963)"),
        ("source", "Doe (2020), Section 5.2, corrected, my way", "Doe (2020), par. 5.2, corrette, my way"),
        ("drawing", "orange: a line of thrust at uplift, 0.157 g (positive direction)",
         "in arancione: una linea delle pressioni all'attivazione, 0,157 g (verso positivo)"),
        ("caution", "My plugin is 0.5 wide, and more.", "My plugin is 0.5 wide, and more."),
        ("body_arch", "segment 3", "concio 3"), ("body_linkage", "segment 3", "segment 3"),
    ]:  # fmt: skip
        assert say.recognised(family, text) == translated
        assert build.SHEET.language("en").recognised(family, text) == text


def test_each_recognised_text_is_one_that_a_mechanism_writes():
    """Its words stand in the code."""
    folders = files("mechanisms"), files("rocking_cli")
    code = " ".join(each.read_text(encoding="utf-8") for folder in folders for each in folder.rglob("*.py"))
    known = words(code)
    keys = [
        each
        for package in PACKAGES
        for each in texts_of(package, "it")
        if each.startswith((*FAMILIES, "body_")) and " " in each
    ]
    assert len(keys) > 80
    for key in keys:
        assert not {each for each in words(key.partition(" ")[2]) if len(each) > 3 and each not in known}, key


def shown_in(view):
    """The words of a view, without formulas and clauses."""
    for part in view.parts:
        if isinstance(part, str):
            yield part
            continue
        yield part.title
        kept = [k for k, head in enumerate(part.columns) if head not in ("formula", "clause", "norma")]
        yield from (text for row in (part.columns, *part.rows) for k, text in enumerate(row) if k in kept)


def english_in(texts, *names):
    """The English words of texts besides the names of the user, each with what stands around it."""
    text = re.sub(r"`[^`]*`|--all|JSON", " ", " ".join(texts))
    for name in names:
        text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", " ", text)
    found = words(text) & ENGLISH - SYMBOLS
    return {each: re.findall(rf".{{0,30}}\b{each}\b.{{0,30}}", text, re.IGNORECASE) for each in found}


PLACE = re.compile(r"§[\w.]+|\[C?[\d.]+\]")


@pytest.mark.every(4)
@pytest.mark.parametrize("in_short", [True, False])
@pytest.mark.parametrize("name", [*CASES, *ODD])
def test_the_terminal_is_italian_with_the_same_numbers(name, in_short):
    structure, site = CASES[name] if name in CASES else (ODD[name], SITES["hazard"])
    found, _ = verified(structure, site)
    english, italian = (view(found, "Norcia", language=key, in_short=in_short) for key in ("en", "it"))
    names = {*names_of(yaml.safe_load(structure)), "Norcia"}
    assert not english_in(shown_in(italian), *sorted(names, key=len, reverse=True))
    assert italian.data() == english.data()
    if not in_short:  # in short, remarks have their own numbers
        numbers = [sorted(NUMBER.findall(PLACE.sub("", " ".join(shown_in(each))))) for each in (english, italian)]
        assert sorted(each.replace(",", ".") for each in numbers[1]) == numbers[0] and not any(
            "." in n for n in numbers[1]
        )


def test_the_terminal_compares_and_shakes_in_italian():
    facade, site = EXAMPLES / "verify" / "facade.yaml", str(EXAMPLES / "verify" / "site.yaml")
    tied = EXAMPLES / "verify" / "tied_facade.yaml"
    for options in ({"strengthened": tied}, {"motions": ["sine:0.09g:0.5s", "ricker:2g:1s"], "polarity": "both"}):
        for in_short in (True, False):
            answer = rk.verify(facade, site, language="it", in_full=not in_short, **options)
            assert not english_in(shown_in(answer.view), "facade", "an example site", "roof", "floor", "bar", "sine")


def test_every_step_is_shown_in_italian():
    """With the meanings of steps as on the sheet; their formulas are those of the code."""
    found, _ = verified(*CASES["laden, on a hazard"])
    english, italian = (view(found, language=key, every_step=True) for key in ("en", "it"))
    tables = [part for part in italian.parts if not isinstance(part, str) and "significato" in part.columns]
    meanings = [row[-1] for each in tables for row in each.rows]
    assert len(meanings) > 60 and not english_in(meanings, "roof", "vault", "block")
    assert len(english.parts) == len(italian.parts)


@pytest.mark.usefixtures("small_maps")
def test_the_language_of_a_site_is_that_of_every_answer(tmp_path):
    site = yaml.safe_load((EXAMPLES / "verify" / "site.yaml").read_text(encoding="utf-8"))
    facade = EXAMPLES / "verify" / "facade.yaml"
    wall = {"mechanism": ["block"], "width": [0.6], "height": [8]}
    assert any("satisfied" in each for each in rk.verify(facade, site).sentences)
    site |= {"language": "it"}
    verify, survey, report = (tmp_path / f"{name}.html" for name in "vsr")
    for asked, pages in ((None, ({"sheet": verify}, {"page": survey}, {"out": report})), ("en", ({}, {}, {}))):
        for answer in (
            rk.verify(facade, site, language=asked, **pages[0]),
            rk.survey(wall, site=site, language=asked, **pages[1]),
            rk.report(facade, verify=site, language=asked, **pages[2]),
        ):
            assert ("soddisfa" in answer.sentences[0]) == (asked is None)
    assert all('lang="it"' in page.read_text("utf-8")[:200] for page in (verify, survey, report))
    with pytest.raises(InputError, match="language"):
        rk.verify(facade, site, language="de")


def test_notes_are_italian(tmp_path):
    wall = "mechanism: block\nname: muro\nwidth: 0.6\nheight: 8\ndepth: 5\ndensity: 18 kN/m3\n"
    loads = "loads: [{name: tetto, mass: 12 kN/m, at: [0, 8], floor: borne}]\n"
    (tmp_path / "s.yaml").write_text(wall + loads)
    (tmp_path / "site.yaml").write_text(f"language: it\n{SITE}")
    said = run("verify", tmp_path / "s.yaml", "--site", tmp_path / "site.yaml", "--plot", tmp_path / "p.svg").stderr
    assert "18 kN/m3 è un peso, assunto come massa: 1835,49 kg/m3 (diviso per 9,80665 m/s2)" in " ".join(said.split())
    assert not english_in(said.splitlines(), "floor: borne", "p.svg", str(tmp_path))


@pytest.mark.rest
def test_a_survey_and_its_page_are_italian(tmp_path):
    rows = {
        "mechanism": ["block", "block", "block", "wall"], "name": ["A 1.5", "B", "C", "D"],
        "width": [0.6, 0.9, 1.5, None], "height": [8, 6, 4, 3], "thickness": [None, None, None, 0.3],
        "density": [1800] * 4, "depth": [5, 5, 0.9, 1], "longitude": [13.0, 13.1, 13.2, 13.3], "latitude": [42.0] * 4,
    }  # fmt: skip
    site = str(EXAMPLES / "verify" / "site.yaml")
    for options in ({"site": site}, {"motions": ["sine:0.3g:0.5s"], "neighbours": 20}, {},
                    {"motions": ["sine:0.3g:0.5s", "sine:2g:1s"]}):  # fmt: skip
        answer = rk.survey(rows, language="it", page=tmp_path / "p.html", **options)
        english = rk.survey(rows, language="en", **options)
        names = (
            "unusual",
            "A 1.5",
            "block",
            "wall",
            "sine",
            "lambda",
            "eta",
            "kappa",
            "structures",
            "table",
            "plane",
            "survey",
            "verify",
            "spanning_wall",
            "hinge: weakest",
            "floor",
            "width",
            "PGA",
            "both",
            "κ₂",
        )
        assert not english_in(shown_in(answer.view), *names)
        assert answer.to_dict() | {"given": None} == english.to_dict() | {"given": None}
        assert any("A 1.5" in text for text in shown_in(answer.view))
        page = (tmp_path / "p.html").read_text(encoding="utf-8")
        assert not english_in([rest_of(page)], *names)
        assert ("Insolito o mancante: width." in page) == ("site" in options)


def slots(text):
    return {name.partition(".")[0] for _, name, spec, _ in Formatter().parse(text) if name is not None for name in
            (name, *(each for _, each, _, _ in Formatter().parse(spec or "") if each))}  # fmt: skip


@pytest.mark.parametrize("package", [*PACKAGES, "rocking_cli.questions.report"])
def test_no_text_needs_a_value_that_its_english_form_has_not(package):
    """Short forms in either language have those of the English short or long text, from which remarks were written."""
    long, short = (texts_of(package, key) for key in ("en", "en_in_short"))
    for key in ("it", "it_in_short"):
        for name, text in texts_of(package, key).items():
            english = [each[name] for each in (long, short) if name in each] or [name]
            assert slots(text) <= set.union(*map(slots, english)), (key, name)
    assert texts_of(package, "it_in_short").keys() <= short.keys() | long.keys()


def test_a_sliding_floor_and_weights_of_the_mechanism_are_said_in_short_in_italian():
    """The letter of the code on both, of which no example has the first."""
    roof = {"name": "r", "mass": 6000.0, "at": [0.0, 8.0], "floor": "sliding", "seat": 0.3}
    wall = rk.Block(name="w", width=0.6, height=8.0, depth=5.0, density=1800.0, one_sided="positive", loads=[roof])
    said = " ".join(rk.verify(wall, yaml.safe_load(SITE), language="it", in_full=False).sentences)
    alpha = 0.3 * (43200 + 3000) / (4 * 43200 + 8 * 3000)  # rad: by the letter half of the roof moves sideways too
    assert f"alpha0 sarebbe {0.3 * 46200 / (4 * 43200):.4g} invece di {alpha:.4g}".replace(".", ",") in said


def test_the_floor_of_the_histories_is_rounded():
    floor = str(Floor.parse("T1=0.4,z=6m,H=9m,n=3"))
    assert "z/H=0.6666666666666666" in floor
    for language, wanted in (("en", "T1=0.4,xi=0.05,z/H=0.666667,n=3"), ("it", "T1=0,4; xi=0,05; z/H=0,666667; n=3")):
        assert Language(language, is_plain=True).items(floor) == wanted
