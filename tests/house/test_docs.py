"""The documentation shows what the commands do today, and has a page for every one of them and every mechanism.

`make docs` holds the rest: every warning of Sphinx, such as a link that leads nowhere, is an error there.
"""

import re
from enum import Enum
from importlib import import_module
from inspect import getdoc, isclass, isfunction, signature
from pkgutil import resolve_name
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import rocking_cli
from rocking_cli import Registry, core, names
from rocking_cli.core import box
from rocking_cli.core.mechanism_kinematics import Jointed, Kinematics
from rocking_cli.core.released import released
from rocking_cli.io.starters import STARTERS, starter, template_of
from rocking_cli.plugins.rooms import commands
from rocking_cli.plugins.rooms import names as verbs
from rocking_cli.processing.intensity import IntensityMeasures
from rocking_cli.studies.conclusion import Concluded, NextStep
from rocking_cli.testing import contract
from rocking_cli.views.mechanisms import fields
from tests.conftest import PROJECT

pytestmark = pytest.mark.drawn

DOCS = PROJECT / "docs"
OWN = [PROJECT / "README.md", PROJECT / "CONTRIBUTING.md", PROJECT / "validation" / "README.md"]
FOLDERS = ("", "api/", "mechanisms/")
PAGES = sorted([*OWN, *(page for folder in FOLDERS for page in DOCS.glob(f"{folder}*.md"))])
MECHANISMS = [name for name in Registry() if Registry().package_of(name).startswith("rocking-cli ")]


def text_of(name):
    return (DOCS / name).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def made():
    """How the pages are made: make_pages, and the modules it uses."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(DOCS)
        names = "make_chooser", "make_json", "make_pages", "make_reference", "make_runs", "make_sheets", "parts"
        yield SimpleNamespace(**{name: import_module(name) for name in names})


def on_the_site(made, name):
    """The text of a page, with what its markers stand for."""
    return made.parts.HERE.sub(
        lambda part: made.make_reference.made(part["kind"], " ".join(part["what"].split())), text_of(name)
    )


@pytest.fixture(scope="module")
def runs(made, tmp_path_factory):
    """Every command that is shown, run anew, once for all tests."""
    return made.make_runs.run(made.make_pages.commands(), tmp_path_factory.mktemp("shown"))


@pytest.mark.docs
def test_the_made_parts_of_the_pages_are_not_stale(made, runs):
    texts = {page.stem: page.read_text(encoding="utf-8") for page in PAGES}
    stale = [
        page
        for page, text in texts.items()
        if made.parts.renewed(text, lambda kind, what: made.make_pages.made(kind, what, runs)) != text
    ]
    assert stale == [], "run make docs"


COMMAND = re.compile(r"^(?:    (rocking .+?)(?:  +#.*)?|<!-- (?:run|draw): (.+) -->)$", re.M)
WRITES = re.compile(r"^python | (>|-o|--out|--store|--plugin|--structures) ")
SAMPLES = [(k / 200, round(20_000 * np.sin(k / 30))) for k in range(2000)]
READERS_OWN = {
    "uneven.txt": "time [s],acceleration [g]\n" + "\n".join(f"{t},{count / 2e5}" for t, count in SAMPLES),
    "raw.txt": "\n".join(f"{t} 0 0 0 0 {count}" for t, count in SAMPLES),
    "laser.txt": "\n".join(f"{t} {count / 2e3}" for t, count in SAMPLES),
}
"""Files that a reader has, and pages name, by what stands for them here."""
ELSEWHERE = "capped_block", "model.json"  # a package, and a model of another program, in tests of their own


@pytest.mark.docs
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_command_that_a_page_shows_runs(page, made, tmp_path):
    """In the order of the page, those before it in the same folder; outputs and pictures are held elsewhere."""
    found = [(plain or marked, bool(plain)) for plain, marked in COMMAND.findall(page.read_text(encoding="utf-8"))]
    found = [each for each in found if not any(name in each[0] for name in ELSEWHERE)]
    elsewhere = {command for command, alone in found if not alone}
    wanted = [command for command, alone in found if (alone and command not in elsewhere) or WRITES.search(command)]
    if not {*wanted} - elsewhere:
        return
    for name, text in READERS_OWN.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    made.make_runs.run(dict.fromkeys(wanted), tmp_path)


@pytest.mark.docs
def test_the_pictures_are_not_stale(made, runs):
    drawn = made.make_pages.drawn(runs)
    assert made.make_runs.stale(drawn) == [], "run make docs"
    assert {*made.make_runs.files(drawn), "content.json"} == {file.name for file in (DOCS / "pictures").iterdir()}
    assert list(made.make_chooser.stale()) == [], "run make docs"


@pytest.mark.docs
def test_the_calculation_sheets_are_not_stale(made):
    every = made.make_sheets.pages()
    assert made.make_sheets.stale(every) == [], "run make docs"
    page = every["facade.html"]
    others = {"facade.html": page.replace("1,31582", "1,31589"), "parapet.html": every["parapet.html"] + "<p>more</p>"}
    assert made.make_sheets.stale({**every, **others}) == [*others]
    assert made.make_sheets.stale({**every, "facade.html": page.replace("<p>", "<p class='other'>")}) == []


@pytest.mark.rest
def test_pages_of_a_sheet_are_drawn_the_same_each_time(made, tmp_path):
    drawn = [made.make_sheets.page_pictures(made.make_sheets.made("parapet"), 20) for _ in range(2)]
    assert drawn[0] == drawn[1] and all(each.startswith(b"\x89PNG") for each in drawn[0])


@pytest.mark.rest
def test_another_picture_is_not_alike(made, tmp_path):
    commands = {
        "pedestal": "rocking new block > pedestal.yaml",
        "drawing": "rocking draw pedestal.yaml --at 0.9 --plot drawing.png",
        "response": "rocking respond pedestal.yaml --record examples/accel.csv --scale 1.02 --plot response.png",
        "map": "rocking overturning pedestal.yaml --restitution 0.9 --plot map.png",
        "error": "rocking error examples/arch.yaml --at 0.6 --a 2 --plot error.png",
        "moving": "rocking animate examples/frame.yaml --record examples/accel.csv --speed 2 --fps 5 --out moving.gif",
    }
    others = made.make_runs.run(commands.values(), tmp_path)
    contents = {name: content for each in others.values() for name, content in each.pictures.items()}
    assert len(contents) == 5
    assert sorted(made.make_runs.stale(contents)) == sorted(contents)


def test_the_pictures_are_small():
    sizes = [file.stat().st_size for file in (DOCS / "pictures").iterdir()]
    assert max(sizes) < 250_000
    assert sum(sizes) < 9_000_000


@pytest.mark.parametrize(
    ("one", "other", "alike"),
    [
        ("peak 0.48125 rad", "peak    0.48127 rad", True),  # the last digits, and so the width of a column
        ("once in 1,747 years", "once in 1,750\nyears", True),
        ("+0.0 %", "-0.1 %", True),  # of a value that is zero but for rounding
        ("peak 0.48 rad", "peak 0.51 rad", False),
        ("peak 0.48 rad", "peak 0.48 deg", False),
        ("prefer kappa2", "prefer kappa1", False),
        ("below 1e-10", "below 1e-9", False),
    ],
)
def test_outputs_are_compared_by_words_and_by_numbers(one, other, alike, made):
    assert made.parts.same(one, other) == alike


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_page_can_be_read_as_a_file(page):
    text = page.read_text(encoding="utf-8")
    prose = re.sub(r"^```(?!{).*?^```|^    .*?$", "", text, flags=re.M | re.S)
    assert not re.search(r"^ *(`{3,}|~{3,}|:{3,}) *{", prose, re.M), "a directive"
    assert not re.search(r"{[\w:-]+}`", prose), "a role"
    assert not re.search(r"^\([\w-]+\)=$|^%", prose, re.M), "a label or a comment of MyST"
    assert "_generated" not in prose
    assert "$$" not in prose, "Markdown takes the backslashes of this: ```math keeps them"
    for formula in re.findall(r"\$([^$]+)\$", re.sub(r"`[^`]*`", "", prose)):
        assert not re.search(r"\\[^a-zA-Z]|\*|<[^ ]", formula), f"${formula}$: Markdown takes this for its own"


def test_every_command_is_explained(made):
    """On a page, as a command or in its text; what its options are is in the reference."""
    texts = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    shown = re.findall(r"(?:^ {4}|^<!-- \w+: |[`(])rocking (\w+)", texts, re.M)
    assert set(commands()) - {*shown} == set()
    reference = made.make_reference.command_line()
    assert [name for name in commands() if f"\n## rocking {name}\n" not in reference] == []


def test_json_has_the_keys_of_every_command_and_meanings_where_they_are_declared(made):
    page = made.make_json.page()
    held = {line.split()[0] for line in made.make_json.HELD.read_text(encoding="utf-8").splitlines() if line[0] != " "}
    assert held == set(re.findall(r"^## rocking (\w+)$", page, re.M)) == set(commands())
    assert re.search(r"^    - `lambda`: Uplift acceleration\..*\[g]$", page, re.M)
    assert re.search(r"^- `conclusion`\n(?:  .*\n)*  - `known_until`: Time until which .* \\\[s]; null", page, re.M)
    respond = page.partition("\n## rocking respond\n")[2].partition("\n## ")[0]
    of_a_run = respond.partition("\n  - `nonlinear`\n")[2].partition("\n- ")[0]
    for name in ("known_to", "known_to_reason", "opening", "outcome", "peak_lower_bound", "unknown"):
        assert re.search(rf"^    - `{name}`: \S", of_a_run, re.M), name
    assert (
        "  - `joint`: The joint at which the response" in respond and "  - `sensitive`: Whether under 90 %" in respond
    )
    last = page.partition("\n## Values of `next`\n")[2]
    assert re.findall(r"^- `(\w+)`: \S", last, re.M) == [*NextStep]


def test_the_outcomes_of_json_stand_beside_the_words_of_the_answer():
    rows = re.findall(r"^\| (.+) \| `(\w+)` \| `(\w+)`", text_of("histories.md").partition("| printed |")[2], re.M)
    words = {getattr(names, name) for name in dir(names) if name.isupper() and isinstance(getattr(names, name), str)}
    assert {said.removesuffix(" (free blocks)") for said, _, _ in rows} <= words
    assert {what for _, _, what in rows} <= {*Concluded} and {how for _, how, _ in rows} == {
        "at_rest", "still_rocking", "overturned", "unknown", "falls_off"
    }  # fmt: skip


@pytest.mark.parametrize("name", MECHANISMS)
def test_every_mechanism_has_its_page(name, made):
    assert f"(../pictures/draw_{name}.svg)" in text_of(f"mechanisms/{name}.md")
    assert f"(mechanisms/{name}.md)" in text_of("index.md")
    chooser = on_the_site(made, "structures.md")
    assert f"(static/mechanisms/{name}.svg) `{name}`](mechanisms/{name}.md): " in chooser
    own = [row["field"] for row in fields(Registry()[name]) if not row["common"]]
    page = on_the_site(made, f"mechanisms/{name}.md")
    assert own and all(f"| `{field}` |" in page for field in own)


def test_every_template_is_in_the_table():
    for name in STARTERS:
        mechanism = re.search(r"^mechanism: (\w+)$", starter(name), re.M)[1]
        row = rf"^\| !\[.+\]\(static/mechanisms/{name}\.svg\) \| `{name}` \| .+ \| `{mechanism}` \| `(\w+)` \|$"
        assert template_of(re.search(row, text_of("structures.md"), re.M)[1]) == name


def test_every_page_is_in_the_contents():
    pages = [page.relative_to(DOCS).as_posix() for page in PAGES if page not in OWN]
    assert [page for page in pages if page != "index.md" and f"({page})" not in text_of("index.md")] == []


@pytest.fixture(scope="module")
def documented(made):
    """What the pages of the Python reference document, by the names there."""
    pages = [page.stem for page in (DOCS / "api").glob("*.md")]
    listed = [name for page in pages for name in made.make_reference.names_of(page)]
    assert len(set(listed)) == len(listed)
    assert sorted(pages) == sorted(re.search(r"^<!-- here: index (.+) -->$", text_of("api.md"), re.M)[1].split())
    return {name: resolve_name(f"rocking_cli.{name}") for name in listed}


def test_every_public_name_is_documented(documented):
    assert {name for name in documented if "." not in name} == set(rocking_cli.__all__) - {"__version__", "mechanisms"}
    assert all(getdoc(each) for each in documented.values())


NOT_SHOWN = {
    "Counts", "Numbers",  # of an `Outcome`, where these are variables
    "Path",  # of the standard library
    "Spreadsheet",  # in which a table of structures stands
    "Dimensions",  # of which an answer makes its labelled arrays
}  # fmt: skip
"""Names of classes of the package that the fields of a result name, and that no page of the reference needs."""


def test_every_class_that_a_verb_returns_is_documented_and_so_is_what_it_holds(made, documented):
    """Classes have names of their own, so a word of an annotation is a class; a docstring names what `Any` does not."""
    files = (PROJECT / "rocking_cli").rglob("*.py")
    own = {name for file in files for name in re.findall(r"^class (\w+)", file.read_text("utf-8"), re.M)} - NOT_SHOWN
    typed = made.make_reference.typed
    texts = {name.rpartition(".")[2]: each for name, each in documented.items()}
    missing = []
    for verb in (getattr(rocking_cli, name) for name in verbs()):
        said = getdoc(verb).partition("Returns\n-------\n")[2].partition("\n")[0]
        returned = own & {*re.findall(r"\w+", f"{typed(verb)[1]} {said}")}
        assert returned - {"Answer", "Answers", "MappingAnswer"}, verb
        missing += [(verb.__name__, name) for name in returned - {*texts}]
        for name in returned & {*texts}:
            derived = (getattr(texts[name], each) for each in dir(texts[name]) if not each.startswith("_"))
            types = [each.fget.__annotations__["return"] for each in derived if isinstance(each, property)]
            held = own & {*re.findall(r"\w+", " ".join([typed(texts[name])[0], *types]))}
            missing += [(name, each) for each in held - {*texts}]
    assert not missing


def indented(section):
    """The code of a section of a page."""
    return "\n".join(line[4:] for line in section.split("\n") if line.startswith("    ") or not line)


def of_the_guide(title, head=""):
    """What the code of a section of the guide to plugins defines."""
    section = text_of("plugins.md").partition(f"## {title}\n")[2].partition("\n## ")[0]
    names = {"__name__": "guide"}
    exec(compile(head + indented(section), "guide", "exec", dont_inherit=True), names)
    return names


def test_the_hollow_body_of_the_guide_holds_the_contract():
    """The chimney less its shaft is made of its walls and its cap, each a box."""
    chimney = of_the_guide("Subtract a hole")["Chimney"](width=3.0, height=20.0, shaft=2.0, cap=1.0)
    assert [each for each in contract(chimney) if not each.passed] == []
    parts = [(19.0, 0.5, 3.0, side) for side in (-1.25, 1.25)] + [(19.0, 2.0, 0.5, 0.0)] * 2
    boxes = [box("wall", high * across * deep, across, high, x + 0.5j * high) for high, across, deep, x in parts]
    boxes.append(box("cap", 9.0, 3.0, 1.0, 19.5j))
    mass = sum(each.mass for each in boxes)
    centroid = sum(each.mass * each.centroid for each in boxes) / mass
    inertia = sum(each.inertia + each.mass * abs(each.centroid - centroid) ** 2 for each in boxes) / mass
    (body,) = chimney.bodies()
    assert (body.mass, body.centroid, body.inertia) == pytest.approx((1.0, centroid, inertia), rel=1e-12)


def test_the_braced_parapet_of_the_guide_holds_the_contract():
    """The brace keeps its length and its top on the back of the parapet, which turns: by hand."""
    made = of_the_guide("Move bodies by joints")["BracedParapet"]
    given = {"thickness": 0.3, "height": 1.5, "reach": 0.8, "rest": 1.1}
    parapet = made(brace_mass=0.1, **given)
    assert [each for each in contract(parapet) if not each.passed] == []
    phi = 0.1
    for s in core.Direction:
        turn, pivot = np.exp(-1j * s * phi), s * 0.15
        wall = pivot + (-0.15 - pivot) * turn  # the lower end of its back, whose direction is 1j turn
        foot = -0.95 - wall
        along = (foot * (1j * turn).conjugate()).real
        up = along + np.sqrt(along**2 + 0.8**2 + 1.1**2 - abs(foot) ** 2)
        top = wall + 1j * turn * up
        brace = parapet.motion(np.array([phi]), s)[1]
        assert brace.carry(complex(-0.15, 1.1))[0] == pytest.approx(top, rel=1e-12)
        assert made(brace_mass=0.0, **given).uplift(s) == pytest.approx(0.2, rel=1e-12)
    with pytest.raises(rocking_cli.InputError, match="higher than the parapet"):
        made(brace_mass=0.1, **{**given, "rest": 2.0})


def test_the_statue_of_the_guide_holds_the_contract_and_is_checked():
    """As rocking starts, the ends of its plinth bear what a bracket under u_g'' = lambda g does; then they open."""
    statue = of_the_guide("Name its joints")["Statue"](width=0.7, height=1.4, plinth=0.4, tall=1.0, share=0.3)
    assert [each for each in contract(statue) if not each.passed] == []
    g = statue.gravity
    for s in core.Direction:
        found = released(statue, s, np.zeros(1))
        lam = statue.uplift(s)
        assert lam == pytest.approx(0.35 * 1.3 / (0.7 + 0.3 * 1.9), rel=1e-12)
        foot, left, right = (found.rows[0][0][0], *found.rows[1][0])
        force = found.force[0] @ [1.0, -s * lam * g, 0.0, 0.0]
        tilt = 0.3 * lam * g * 0.5 / 0.4
        assert force[[foot, left, right]] == pytest.approx(
            [1.3 * g, 0.15 * g - s * tilt, 0.15 * g + s * tilt], rel=1e-9
        )
    weak, strong = (
        rocking_cli.respond(statue, f"sine:{level}g:0.6s", model="nonlinear")["nonlinear"] for level in (0.36, 0.8)
    )
    assert weak.lifted and not weak.unknown and weak.opening < 1e-4
    assert strong.unknown and strong.check.joint == "pedestal and statue" and strong.check.reason == "opens"


def test_the_ladder_of_the_linkages_is_refused_as_its_page_says(tmp_path):
    section = text_of("mechanisms/linkage.md").partition("## One that is refused\n")[2].partition("\n## ")[0]
    (said,) = re.findall(r"`(strut turns.*?)`", " ".join(section.split()))
    (tmp_path / "ladder.yaml").write_text(indented(section), encoding="utf-8")
    with pytest.raises(rocking_cli.InputError, match=re.escape(said)):
        rocking_cli.load_structure(tmp_path / "ladder.yaml")


def test_the_measure_of_the_guide_is_what_it_says():
    head = "from dataclasses import dataclass, field\nfrom rocking_cli.processing.intensity import MotionMeasure\n"
    measure = of_the_guide("Add a measure of intensity", head)["Bracketed"].read(["2", "8 s"])
    motion = rocking_cli.read_record(PROJECT / "examples" / "accel.csv")
    expected = sum((a / 9.80665) ** 2 for a in motion.acceleration[200:801]) / 601
    assert (str(measure), measure.value(motion)) == ("RMS(2.0:8.0)", pytest.approx(expected**0.5))
    assert measure.usually() == ("RMS(0:10)",)


def test_every_measure_is_explained(made):
    page = on_the_site(made, "fragility.md")
    for name in IntensityMeasures():
        assert re.search(rf"^\| `{re.escape(name)}[`(].* \| .+ \|", page, re.M), name


HELPERS = {name: each for name, each in vars(core).items() if name[0] != "_" and not isinstance(each, ModuleType)}


def helpers_of_the_guide(made):
    """The section on helpers, and what it says of each by its name: how it is called, and the sentence on it."""
    section = on_the_site(made, "plugins.md").partition("## Every helper\n")[2].partition("\n## ")[0]
    listed = re.findall(r"^- `(\w+)(.*?)`: (.+)$", section, re.M)
    assert len({name for name, *_ in listed}) == len(listed)
    return section, {name: (called, said) for name, called, said in listed}


def as_written(found):
    """A signature as its author wrote it."""
    text = re.sub(r"ForwardRef\('([^']*)'[^)]*\)", r"\1", str(found))
    text = re.sub(r"(: |-> )'([^']*)'", r"\1\2", text).replace("<factory>", "...").removesuffix(" -> None")
    return re.sub(r"^\(self(, )?", "(", text)


def test_every_helper_of_the_core_is_in_the_guide_to_plugins(made):
    """One that is missing: put its name into a `<!-- here: core ... -->` of docs/plugins.md."""
    section, listed = helpers_of_the_guide(made)
    kinds = {name for name in HELPERS if re.search(rf"`{name}` is\s", section)}
    assert kinds == {"Reals", "Outline", "Vertex"}  # what arguments are: they are not called
    assert set(HELPERS) - kinds - set(listed) == set()
    methods = {name for name in listed if hasattr(core.Mechanism, name)}
    assert set(listed) - set(HELPERS) - methods == set()
    answers = {name for each in (Kinematics, Jointed) for name, it in vars(each).items() if isfunction(it)}
    assert {name for name in answers if name[0] != "_"} - methods == set()


def test_the_guide_to_plugins_gives_the_signature_of_every_helper(made):
    _, listed = helpers_of_the_guide(made)
    bare = {name for name, (called, _) in listed.items() if not called}
    assert bare == {
        "Attached", "Mechanism", "NoEquivalentBlock", "NoMotion", "bends", "smooth", "has_mass", "directions",
        "unchecked", "propped", "driven",
    }  # fmt: skip
    for name, (called, said) in listed.items():
        each = HELPERS.get(name) or getattr(core.Mechanism, name)
        first = " ".join(getdoc(each).split("\n\n")[0].split())
        assert re.sub(r"\\(?=\W|_)", "", said) == first, name
        if isclass(each) and issubclass(each, Enum):
            assert f"{name}{called}" == ", ".join(f"{name}.{member.name}" for member in each)
        elif name not in bare:
            assert called == as_written(signature(each)), name


def test_the_correction_that_is_shown_repairs_what_was_doubtful(made, tmp_path):
    drifting = tmp_path / "drifting.csv"
    import_module("make_drifting").main.callback(drifting)
    before, after = (rocking_cli.record(drifting, baseline=each).to_dict() for each in (None, "linear"))
    assert [each["kind"] for each in before["warnings"]] == ["offset", "final_velocity", "final_displacement"]
    assert after["warnings"] == [] and after["pgd"] < 0.04 * before["pgd"]


@pytest.mark.parametrize("name", ["respond", "verify", "margin", "fragility", "collapse"])
def test_what_is_explained_of_an_output_is_printed(name):
    """One that is missing: the command prints another word now, so explain that."""
    section = text_of("how_to_read_it.md").partition(f"\n## `{name}`\n")[2].partition("\n## ")[0]
    assert f"<!-- run: rocking {name} " in section
    printed = " ".join(section.partition("```text\n")[2].partition("\n```")[0].split())
    explained = re.findall(r"^\| `(.+?)` \| \S", section, re.M)
    assert len(explained) > 5 and [each for each in explained if each not in printed] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_somewhere_in_the_repository_too(page):
    text = re.sub(r"^    .*", "", page.read_text(encoding="utf-8"), flags=re.M)  # without code
    for link in re.findall(r"\]\(([^)#\s]+)", text):
        if not link.startswith(("https:", "reference/", "../reference/")):  # Sphinx follows the latter
            assert (page.parent / link).exists(), link


@pytest.mark.parametrize("name", ["linkage", "assembly"])
def test_what_is_refused_is_said_in_the_words_of_the_code(name):
    """Each message of the table, between the names that it stands with."""
    section = text_of(f"mechanisms/{name}.md").partition("## What is refused, and what to do\n")[2]
    messages = [row.split("|")[1].strip() for row in section.split("\n") if row.startswith("| ")][1:]
    files = [*PROJECT.glob("mechanisms/**/*.py"), *PROJECT.glob("rocking_cli/core/*.py")]
    code = " ".join(" ".join(file.read_text(encoding="utf-8").split()) for file in files)
    code = re.sub(r'" f?"', "", code)
    assert len(messages) >= 8
    for message in messages:
        parts = re.split(r"\b[A-Z]\b(?:, [A-Z]\b)*|\.\.\.|[;:] |touches", f" {message} ")
        for words in (each.strip(" ,") for each in parts):
            assert words in code, (message, words)


def test_messages_that_are_explained_are_those_of_the_code():
    """Each message of the index of docs/faq.md, between the names and values that it stands with."""
    messages = re.findall(r"^\| `(.+?)` \|", text_of("faq.md").partition("## Messages\n")[2], re.M)
    files = [*PROJECT.glob("rocking_cli/**/*.py"), *PROJECT.glob("mechanisms/**/*.py")]
    code = re.sub('" f?"', "", " ".join(" ".join(file.read_text(encoding="utf-8").split()) for file in files))
    assert len(messages) > 20
    assert [each for each in messages if not all(part.strip() in code for part in each.split("..."))] == []
