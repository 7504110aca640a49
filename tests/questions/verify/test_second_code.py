"""A code that has nothing in common with the Italian one works in every command, and fails in plain words."""

import json
import math
import re
import sys
from dataclasses import replace
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from textwrap import dedent
from typing import Literal

import pytest

import rocking_cli as rk
from rocking_cli.core import quantity
from rocking_cli.errors import InputError, Problem
from rocking_cli.testing import CodeContract
from rocking_cli.verification import Code, Formula, Method, Number, Site, Verified, governing
from rocking_cli.verification.code import Codes, codes
from rocking_cli.views.sheet.build import SheetOfCode
from rocking_cli.views.verification import Showing
from tests.cli.test_cli import run, run_json, some
from tests.conftest import EXAMPLES, PROJECT
from tests.questions.verify.printed import steps_of_page

G = 9.80665


class DemoSite(Site):
    frequent: float = quantity("acceleration of frequent earthquakes", unit="m/s2", example=0.8, gt=0)
    rare: float = quantity("acceleration of rare earthquakes", unit="m/s2", example=2.0, gt=0, le=50)
    importance: float = quantity("importance factor", symbol="gamma_I", default=1.0, ge=0.5)


class Demo(Code):
    key, name, edition = "UNI-demo", "demonstration code", "2026"
    site = DemoSite

    def verify(self, mechanism, site, control=None):
        directions = {}
        for direction in mechanism.directions:
            uplift = mechanism.uplift(direction) * mechanism.gravity
            methods = {
                "service": Method("onset of rocking", uplift, site.importance * site.frequent, "3.1", unit="m/s2"),
                "ultimate": Method("overturning", 1.5 * uplift, site.importance * site.rare, "3.2", unit="m/s2"),
            }
            directions[direction] = Verified(direction, methods, governing(methods), remarks=["A demonstration."])
        return self.found(mechanism, directions)


class WorkedSite(DemoSite):
    soil: Literal["rock", "sand"] = "rock"
    factor: float | Literal["usual"] = "usual"


class Worked(Demo):
    """With formulas in the signs of a sheet, a choice of words, and a structure that it refuses."""

    key, site = "worked", WorkedSite
    ONSET = Formula("λ_[0]", "Δ_[i] · β^[2]", "{D} · {b}^[2]", "m/s²", "3.1", meaning="onset of ω", standing="print")

    def verify(self, mechanism, site, control=None):
        if mechanism.height > 5:
            raise InputError(Problem("must be at most 5 m for this code", field="height"))
        found = super().verify(mechanism, site)
        line = self.ONSET.working(1.5, {"state": "rare"}, D=0.5, b=-3.0)
        directions = {each: replace(one, workings=[line]) for each, one in found.directions.items()}
        return self.found(mechanism, directions, workings=[line], remarks=["Of the whole."])


class Divides(Demo):
    key = "divides"

    def verify(self, mechanism, site, control=None):
        return 1 / 0


class Nothing(Demo):
    key = "nothing"

    def verify(self, mechanism, site, control=None):
        return None


class NoKey(Code):
    name, edition, site = "no key", "2026", DemoSite

    def verify(self, mechanism, site, control=None):
        return self.found(mechanism, {})


class NoMethod(Demo):
    key = "no_method"

    def verify(self, mechanism, site, control=None):
        found = super().verify(mechanism, site).directions
        return self.found(mechanism, {each: Verified(each, one.methods, "other") for each, one in found.items()})


class BadRatio(Verified):
    @property
    def ratio(self):
        return self.methods["none"].ratio


class NoRatio(Demo):
    key = "no_ratio"

    def verify(self, mechanism, site, control=None):
        found = super().verify(mechanism, site).directions
        return self.found(mechanism, {each: BadRatio(each, one.methods, "service") for each, one in found.items()})


class Unmade(Demo):
    key = "unmade"

    def __init__(self):
        raise KeyError("lost")


class BadShowing(Showing):
    def of_direction(self, found, each, where):
        yield "a first part"
        raise KeyError("lost")


class Shown(Demo):
    key = "shown"
    numbers = {"demo_number": Number("fails", of=lambda verified: 1 / 0)}  # noqa: RUF012

    def showing(self):
        return BadShowing()


class NoShowing(Demo):
    key = "no_showing"

    def showing(self):
        return "a table"


class BadSheet(Demo):
    """Its sheet fails; of histories it returns nothing."""

    key = "bad_sheet"

    def sheet(self):
        def context(language, found, site):
            return {"each": 1 / 0}

        return SheetOfCode("rocking_cli.codes.italian", context)

    def with_histories(self, found, structure, site, asked):
        return found.directions


class Unknown(Demo):
    """Of slender structures it does not know the capacity."""

    key = "unknown"

    def verify(self, mechanism, site, control=None):
        found = {}
        for direction in mechanism.directions:
            known = mechanism.uplift(direction) > 0.2
            found[direction] = Verified(direction, {"all": Method("all", 1.0 if known else None, 2.0)}, "all")
        return self.found(mechanism, found)


class StrictSite(DemoSite):
    @classmethod
    def between(cls, given, sound):
        if sound("rare") and sound("frequent") and given.get("rare", 1.0) < given.get("frequent", 0.0):
            yield ("rare",), "is below the acceleration of frequent earthquakes"


class Strict(Demo):
    key, site = "strict", StrictSite

    def verify(self, mechanism, site, control=None):
        raise rk.InputError(rk.Problem("cannot be used for a block", field="rare"))


class NoExampleSite(Site):
    soil: str = quantity("class of the soil: of the code")
    table: list[list[float]] = quantity("rows of\nperiod and acceleration", example=[[0.0, 1.0], [1.0, 0.5]])
    zone: str | None = quantity("zone", default=None)
    class_: str = quantity("class", default="II: normal", alias="class")


class NoExample(Demo):
    key, site = "no example", NoExampleSite


EVERY = (
    Worked, Demo, Divides, Nothing, NoMethod, NoRatio, Unmade, Shown, NoShowing, BadSheet, Unknown, Strict, NoExample,
)  # fmt: skip
MODULE = "tests.questions.verify.test_second_code"
HERE = r"\(.*test_second_code\.py:\d+\)"


def beside(monkeypatch, *points):
    """Install codes beside those that are installed."""
    real = entry_points

    def also(group):
        return [*real(group=group), *(points if group == Codes.group else ())]

    monkeypatch.setattr("rocking_cli.plugins.registry.entry_points", also)
    codes.cache_clear()


@pytest.fixture
def installed(monkeypatch):
    """Beside the Italian code, those of this file that can be listed."""
    beside(monkeypatch, *(EntryPoint(each.key, f"{MODULE}:{each.__name__}", Codes.group) for each in EVERY))
    yield
    codes.cache_clear()


@pytest.fixture
def demo(installed, tmp_path):
    """A block with lambda = 0.25, and a site of the code."""
    (tmp_path / "block.yaml").write_text("mechanism: block\nname: b\nwidth: 0.7\nheight: 2.8\n", encoding="utf-8")
    (tmp_path / "site.yaml").write_text("code: UNI-demo\nfrequent: 0.8\nrare: 2\n", encoding="utf-8")
    return "--site", "site.yaml"


def site_of(code):
    Path("site.yaml").write_text(f"code: {code.key}\nfrequent: 0.8\nrare: 2\n", encoding="utf-8")


def in_the_folder():
    return sorted(each.name for each in Path().iterdir())


pytestmark = pytest.mark.usefixtures("installed")


class TestContract(CodeContract):
    key = "UNI-demo"


class TestVerify:
    def test_the_smaller_ratio_of_capacity_to_demand_governs(self, demo):
        found = run_json("verify", "block.yaml", *demo)
        assert (found["code"], found["edition"], found["governs"]) == ("UNI-demo", "2026", "positive")
        assert list(found["directions"]) == ["positive", "negative"]
        for each in found["directions"].values():
            assert each["governs"] == "ultimate" and each["passes"] is True
            assert each["ratio"] == pytest.approx(1.5 * 0.25 * G / 2.0)
            assert each["remarks"] == ["A demonstration."]
            service = each["methods"]["service"]
            assert service["capacity"] == pytest.approx(0.25 * G) and service["demand"] == 0.8
            assert (service["unit"], service["clause"], service["passes"]) == ("m/s2", "3.1", True)

    def test_it_is_a_table_and_a_sentence_without_words_of_another_code(self, demo):
        said = run("verify", "block.yaml", *demo).stdout
        assert "by the demonstration code (2026)" in said
        assert "Both directions: passes. Overturning governs: capacity 3.677, demand 2 m/s2, ratio 1.84." in said
        assert "onset of rocking" in said and "A demonstration." in said
        assert not [word for word in ("SLV", "FC", "zeta", "a_g", "NTC", "None") if word in said]

    def test_a_structure_that_does_not_pass_says_so(self, demo):
        Path("thin.yaml").write_text("mechanism: block\nwidth: 0.28\nheight: 2.8\n", encoding="utf-8")
        assert "Both directions: fails. Overturning governs" in run("verify", "thin.yaml", *demo).stdout
        each = run_json("verify", "thin.yaml", *demo)["directions"]["positive"]
        assert each["passes"] is False and each["ratio"] == pytest.approx(0.15 * G / 2.0)

    def test_directions_that_differ_are_compared(self, demo):
        Path("frame.yaml").write_text((EXAMPLES / "frame.yaml").read_text(encoding="utf-8"), encoding="utf-8")
        sides = run_json("equiv", "frame.yaml")["directions"]
        found = run_json("verify", "frame.yaml", *demo)
        ratios = {side: each["ratio"] for side, each in found["directions"].items()}
        assert ratios == pytest.approx({side: 1.5 * G * each["lambda"] / 2.0 for side, each in sides.items()})
        assert found["governs"] == min(ratios, key=ratios.get)
        assert f"The {found['governs']} direction governs" in run("verify", "frame.yaml", *demo, "--all").stdout

    def test_a_wrong_field_has_its_line(self, demo):
        Path("site.yaml").write_text("code: UNI-demo\nfrequent: 0.8\nrare: -2\nFC: 1.35\n", encoding="utf-8")
        said = run("verify", "block.yaml", *demo, code=2).stderr
        assert "site.yaml:3:7: rare must be more than 0 m/s2, got -2" in said
        assert "site.yaml:4:1: FC is not a field of the site" in said

    def test_what_a_code_itself_refuses_has_its_line(self, demo):
        site_of(Strict)
        assert "site.yaml:3:7: rare cannot be used for a block" in run("verify", *demo, code=2).stderr
        Path("site.yaml").write_text("code: strict\nfrequent: 3\nrare: 2\n", encoding="utf-8")
        said = run("verify", *demo, code=2).stderr
        assert "site.yaml:3:7: rare is below the acceleration of frequent earthquakes" in said

    def test_a_missing_field_has_a_hint_at_its_own_starter(self, demo):
        Path("site.yaml").write_text("code: UNI-demo\nfrequent: 0.8\n", encoding="utf-8")
        said = run("verify", "block.yaml", *demo, code=2).stderr
        assert "rare is missing: acceleration of rare earthquakes [m/s2]" in said and "the code UNI-demo" in said

    def test_a_code_that_is_not_installed_is_refused_with_a_guess(self, demo):
        Path("site.yaml").write_text("code: UNI-dem\n", encoding="utf-8")
        said = run("verify", "block.yaml", *demo, code=2).stderr
        assert "site.yaml:1:7: code: there is no code 'UNI-dem'" in said and "did you mean UNI-demo?" in said

    @pytest.mark.parametrize(
        ("options", "said"),
        [
            (("--sheet", "s.html"), "error: site.yaml: UNI-demo has no calculation sheet"),
            (("--control", "0.3,1"), "error: --control: UNI-demo takes no control point"),
            (("--record", EXAMPLES / "accel.csv"), "error: UNI-demo has no method with time histories"),
            (("--pulse", "sine:0.2g:1s", "--state", "SLC"), "error: UNI-demo has no method with time histories"),
            (("--plot", "p.png"), "error: UNI-demo has no picture of a verification"),
        ],
    )
    def test_what_it_does_not_have_is_refused_in_one_sentence(self, options, said, demo):
        before = in_the_folder()
        text = run("verify", "block.yaml", *demo, *options, code=2).stderr
        lines = [line for line in text.splitlines() if not line.startswith("--all shows")]
        assert lines[0] == said and lines[1].startswith("  ") and len(lines) == 2
        assert in_the_folder() == before

    @pytest.mark.parametrize("more", [(), ("--record", EXAMPLES / "accel.csv")])
    def test_a_report_without_a_sheet_is_refused_at_once(self, more, demo, monkeypatch):
        monkeypatch.setattr(
            "rocking_cli.questions.report.study.gather", lambda *given, **named: pytest.fail("too late")
        )
        before = in_the_folder()
        said = run("report", "block.yaml", "--verify", "site.yaml", *more, code=2).stderr
        assert said.splitlines()[0] == "error: site.yaml: UNI-demo has no calculation sheet"
        assert in_the_folder() == before


class TestOtherCommands:
    def test_a_survey_is_ranked_by_its_ratio(self, demo):
        rows = "mechanism,name,width,height\nblock,wide,0.7,2.8\nblock,thin,0.28,2.8\nblock,middle,1,5\n"
        Path("t.csv").write_text(rows, encoding="utf-8")
        found = run_json("survey", "t.csv", *demo)
        assert found["ranked_by"] == "ratio"
        assert {each["name"]: each["ratio"] for each in found["rows"]} == pytest.approx(
            {"thin": 0.075 * G, "middle": 0.15 * G, "wide": 0.1875 * G}
        )
        assert [each["name"] for each in found["rows"]] == ["thin", "middle", "wide"]
        assert "0.7355" in run("survey", "t.csv", *demo).stdout

    def test_structures_without_a_ratio_come_last(self, demo):
        rows = "mechanism,name,width,height\nblock,slender,0.28,2.8\nblock,stout,0.7,2.8\n"
        Path("t.csv").write_text(rows, encoding="utf-8")
        site_of(Unknown)
        found = run_json("survey", "t.csv", *demo)
        assert [(each["name"], each["ratio"]) for each in found["rows"]] == [("stout", 0.5), ("slender", None)]
        lines = run("survey", "t.csv", *demo, "--out", "o.csv").stdout.splitlines()
        (slender,) = [line.split() for line in lines if line.split()[1:2] == ["slender"]]
        assert slender[3:6] == ["-", "not", "checked"]
        assert len(Path("o.csv").read_text(encoding="utf-8").splitlines()) == 3
        Path("slender.yaml").write_text("mechanism: block\nwidth: 0.28\nheight: 2.8\n", encoding="utf-8")
        assert "the site does not give what the code asks" in run("verify", "slender.yaml", *demo).stdout

    def test_a_structure_is_designed_for_its_ratio(self, demo):
        words = ("design", "block.yaml", "--vary", "width=0.3m:1m", "--until", "ratio >= 1", *demo)
        assert run_json(*words)["value"] == pytest.approx(2.8 * 2.0 / (1.5 * G), rel=1e-9)
        assert "ratio" in run(*words).stdout

    def test_numbers_of_another_code_are_refused_before_any_work(self, demo, monkeypatch):
        monkeypatch.setattr("rocking_cli.questions.design.study._at", lambda *given: pytest.fail("too late"))
        words = ("--vary", "width=0.3m:1m", "--until", "zeta_damage >= 1", *demo)
        said = run("design", "block.yaml", *words, code=2).stderr
        assert "zeta_damage is a number of NTC2018, but the site is for UNI-demo" in said and "`ratio`" in said

    def test_info_lists_it(self):
        listed = run_json("info")["plugins"]["codes"]
        found = {each["name"]: each for each in listed}
        assert found["NTC2018"]["broken"] is None and found["NTC2018"]["package"].startswith("rocking-cli ")
        assert found["UNI-demo"] == {"name": "UNI-demo", "package": "unknown package", "broken": None}
        assert "KeyError: 'lost'" in found["unmade"]["broken"]
        said = run("info").stdout
        assert "UNI-demo" in said and "broken: unmade" in said

    def test_it_can_be_had_in_python(self, demo):
        answer = rk.verify(rk.Block(width=0.7, height=2.8), {"code": "UNI-demo", "frequent": 0.8, "rare": 2.0})
        assert answer.ratio == pytest.approx(0.1875 * G)
        assert answer.to_dict()["directions"]["positive"]["governs"] == "ultimate"
        assert "ratio 1.84" in repr(answer.sentences)
        with pytest.raises(rk.InputError, match="no picture"):
            answer.plot()
        with pytest.raises(rk.InputError, match="no method with time histories"):
            rk.verify("block.yaml", "site.yaml", motions=["sine:0.2g:1s"])
        with pytest.raises(rk.InputError, match="takes no control point"):
            rk.verify("block.yaml", "site.yaml", control=(0.3, 1.0))
        pytest.importorskip("pandas", reason="no pandas here")
        frame = answer.to_frame()
        assert list(frame["method"]) == ["service", "ultimate"] * 2 and list(frame["governs"]) == [False, True] * 2
        assert list(frame["capacity"]) == pytest.approx([0.25 * G, 0.375 * G] * 2)


STARTER = """\
# A site, to verify a structure by the demonstration code (2026).
#   rocking new site --code UNI-demo > site.yaml
#   rocking verify block.yaml --site site.yaml
# Numbers are in the unit in brackets.
code: UNI-demo
# name: my site                   # what to call the site
frequent: 0.8                     # acceleration of frequent earthquakes [m/s2] (> 0)
rare: 2.0                         # acceleration of rare earthquakes [m/s2] (> 0, <= 50)
# importance: 1.0                 # importance factor, gamma_I (>= 0.5)
# language: it                    # language of all answers at this site, en or it
"""


class TestWorkings:
    def test_the_terminal_prints_them_in_plain_characters(self, demo):
        site_of(Worked)
        said = run("-v", "verify", "block.yaml", *demo).stdout
        row = next(line for line in said.splitlines() if line.split()[-2:] == ["of", "omega"])
        assert row.split() == "lambda0 Delta_i * beta^2 0.5 * (-3)^2 1.5 m/s2 3.1 onset of omega".split()  # noqa: SIM905
        assert "Every formula has been checked against the printed code." in said and "None" not in said
        assert "lambda0" in run("verify", "block.yaml", *demo, "--all").stdout  # of the site

    def test_json_has_what_belongs_to_no_direction(self, demo):
        site_of(Worked)
        found = run_json("verify", "block.yaml", *demo)
        assert found["site"] == {"lambda0 rare": 1.5} and found["remarks"] == ["Of the whole."]

    def test_a_refused_structure_is_named_with_its_field(self, demo):
        site_of(Worked)
        Path("tall.yaml").write_text("mechanism: block\nwidth: 1\nheight: 6\n", encoding="utf-8")
        assert "tall.yaml:3:9: height must be at most 5 m" in run("verify", "tall.yaml", *demo, code=2).stderr

    def test_and_in_a_table_with_its_line_once(self, demo):
        site_of(Worked)
        Path("t.csv").write_text("mechanism,width,height\nblock,1,3\nblock,1,6\n", encoding="utf-8")
        assert "error: t.csv:3: height must be at most 5 m" in some("survey", "t.csv", *demo).stderr

    def test_a_wrong_word_hides_no_wrong_number(self, demo):
        text = "code: worked\nfrequent: much\nrare: 2\nsoil: clay\nfactor: none\n"
        Path("site.yaml").write_text(text, encoding="utf-8")
        said = run("verify", "block.yaml", *demo, code=2).stderr
        for each in ("site.yaml:2:11: frequent must be a number", "site.yaml:4:7: soil", "site.yaml:5:9: factor"):
            assert said.count(each) == 1, each
        assert said.count("factor must be a number, or usual") == 1


class TestDirections:
    def found(self, *capacities):
        directions = {
            direction: Verified(direction, {"m": Method("a method", each, 2.0)}, "m")
            for direction, each in zip(rk.Direction, capacities, strict=True)
        }
        return Demo().found(rk.Block(width=0.7, height=2.8), directions)

    @pytest.mark.parametrize(
        ("capacities", "governs", "alike"),
        [((4.0, 3.0), 1, False), ((3.0, 3.0 * (1 - 1e-14)), 0, True), ((-1.0, -1.0), 0, True), ((-1.0, -3.0), 1, False),
         ((None, None), 0, True), ((None, 3.0), 1, False)],
    )  # fmt: skip
    def test_the_smaller_ratio_governs_whatever_its_sign(self, capacities, governs, alike):
        found = self.found(*capacities)
        assert (found.governs, found.alike) == (list(rk.Direction)[governs], alike)
        assert len(found.distinct) == (1 if alike else 2)


class TestStarter:
    def test_it_is_made_from_the_fields_and_works_as_it_is(self, demo):
        made = run("new", "site", "--code", "UNI-demo")
        assert made.stdout == STARTER and made.stderr == ""
        lines = [line.removeprefix("# ") if ": " in line else line for line in STARTER.splitlines()]
        with_all = "\n".join(lines).replace("importance: 1.0", "importance: 1.5")
        for text, ratio in ((made.stdout, 0.1875), (with_all, 0.125)):  # as it is, and with what is commented out
            Path("made.yaml").write_text(text, encoding="utf-8")
            found = run_json("verify", "block.yaml", "--site", "made.yaml")
            assert found["directions"]["positive"]["ratio"] == pytest.approx(ratio * G)

    @pytest.mark.parametrize("code", ["NTC2018", "UNI-demo"])
    def test_json_has_the_schema_of_the_fields(self, code):
        found = run_json("new", "site", "--code", code)
        assert found["site"] == code and found["yaml"] == run("new", "site", "--code", code).stdout
        assert found["schema"] == json.loads(json.dumps(codes()[code].site.model_json_schema()))
        wanted = {"NTC2018": "FC", "UNI-demo": "rare"}[code]
        assert wanted in found["schema"]["properties"] and wanted in found["schema"]["required"]

    def test_that_of_the_italian_code_is_its_own(self):
        own = run("new", "site")
        assert own.stdout == run("new", "site", "--code", "NTC2018").stdout == codes()["NTC2018"].starter
        assert own.stderr == ""

    def test_what_has_no_example_is_to_be_filled_in(self):
        made = run("new", "site", "--code", "no example")
        assert "# Fill in soil: the code gives no example.\n" in made.stdout
        assert "\nsoil:                             # fill in: class of the soil: of the code\n" in made.stdout
        assert "\ntable: [[0.0, 1.0], [1.0, 0.5]]   # rows of period and acceleration\n" in made.stdout
        assert "\n# zone:                           # zone\n" in made.stdout
        assert "\n# class: 'II: normal'             # class\n" in made.stdout
        assert "\ncode: no example\n" in made.stdout and "--code 'no example' > site.yaml" in made.stdout
        assert "the examples of the code no example are not a valid site: this file does not work" in made.stderr
        assert "soil must be text, got nothing" in made.stderr

    @pytest.mark.parametrize(
        ("words", "said"),
        [
            (("site", "--code", "UNI-dmo"), "did you mean UNI-demo?"),
            (("site", "--code", "EN1998"), "unknown code: EN1998"),
            (("site", "--code"), "unknown code:  (known: NTC2018"),
            (("block", "--code", "UNI-demo"), "--code requires `site`"),
            (("study", "--code", "UNI-demo"), "--code requires `site`"),
            (("--code", "UNI-demo"), "Missing argument 'NAME'"),
            (("UNI-demo",), "UNI-demo is a code of practice, not a mechanism\n  `rocking new site --code UNI-demo`"),
            (("--plugin", "my_code", "--code", "other"), "give one name, not my_code and other"),
        ],
    )
    def test_other_ways_to_ask_for_it_are_refused(self, words, said):
        assert said in run("new", *words, code=2).stderr and in_the_folder() == []

    def test_its_name_is_completed_without_loading_it(self, monkeypatch):
        from rocking_cli.cli.help import CODES, completer

        monkeypatch.setattr(EntryPoint, "load", lambda point: pytest.fail("loaded"))
        assert [each.value for each in completer(CODES)(None, None, "U")] == ["UNI-demo"]
        assert "NTC2018" in [each.value for each in completer(CODES)(None, None, "")]


class TestBadCodes:
    @pytest.mark.parametrize(
        ("code", "said"),
        [
            (Divides, rf"the code divides failed in verify: ZeroDivisionError: division by zero {HERE}"),
            (
                Nothing,
                "the code nothing failed in verify: it must return a Verification with at least one direction, .*",
            ),
            (NoMethod, "the code no_method failed in verify: it must return a Verification with at least one .*"),
            (NoRatio, rf"the code no_ratio failed in verify: KeyError: 'none' {HERE}"),
            (Shown, rf"BadShowing failed in of_direction: KeyError: 'lost' {HERE}"),
            (NoShowing, "the code no_showing failed in showing: it must return a Showing or None"),
            (Unmade, rf"plugin unmade of unknown package \({MODULE}:Unmade\) cannot be made: KeyError: 'lost' {HERE}"),
        ],
    )
    def test_they_are_one_line_that_names_the_plugin(self, code, said, demo):
        site_of(code)
        (line,) = run("verify", "block.yaml", *demo, "--all", code=3).stderr.splitlines()
        assert re.fullmatch(f"error: {said}", line), line

    @pytest.mark.parametrize(
        ("point", "said"),
        [
            (
                EntryPoint("bad", f"{MODULE}:NoKey", Codes.group),
                "is not a code: it needs key = 'bad', a name and an edition",
            ),
            (
                EntryPoint("bad", f"{MODULE}:DemoSite", Codes.group),
                "is not a code: it must derive from Code and be complete",
            ),
            (EntryPoint("bad", f"{MODULE}:Lost", "rocking.codes"), "cannot be loaded: AttributeError"),
        ],
    )
    def test_what_is_no_code_is_refused_and_leaves_the_others(self, point, said, demo, monkeypatch):
        beside(monkeypatch, point)
        Path("bad.yaml").write_text("code: bad\n", encoding="utf-8")
        (line,) = run("verify", "block.yaml", "--site", "bad.yaml", code=3).stderr.splitlines()
        assert line.startswith(f"error: plugin bad of unknown package ({point.value}) ") and said in line
        assert run("new", "site", "--code", "bad", code=3).stderr.splitlines() == [line]
        assert run("new", "site").stdout.startswith("# A site")

    @pytest.mark.parametrize(
        ("options", "said"),
        [
            (("--sheet", "s.html"), rf"the code bad_sheet failed in its sheet: ZeroDivisionError: .* {HERE}"),
            (("--pulse", "sine:0.2g:1s"), "the code bad_sheet failed in with_histories: it must return .*"),
        ],
    )
    def test_so_are_those_in_what_few_codes_have(self, options, said, demo):
        site_of(BadSheet)
        before = in_the_folder()
        *_, line = run("verify", "block.yaml", *demo, *options, code=3).stderr.splitlines()
        assert re.fullmatch(f"error: {said}", line), line
        assert in_the_folder() == before

    def test_a_number_that_fails_is_an_error_of_the_plugin(self, demo):
        site_of(Shown)
        words = ("--vary", "width=0.3m:1m", "--until", "demo_number >= 1", "--points", 2, *demo, "--json")
        reasons = json.loads(run("design", "block.yaml", *words).stdout)["not_built"]
        assert "the code shown failed in its number demo_number: ZeroDivisionError" in reasons[0]["reason"]

    def test_the_contract_finds_a_verdict_that_contradicts_the_ratio(self, monkeypatch):
        monkeypatch.setattr(Verified, "passed", property(lambda each: False))

        class Contract(CodeContract):
            key = "UNI-demo"

        with pytest.raises(AssertionError, match=r"passed is False, but the ratio is 1\.8"):
            Contract().test_it_passes_if_its_ratio_is_at_least_1()


def test_the_method_of_the_smallest_known_ratio_governs():
    one, other, unknown = Method("a", 2.0, 1.0), Method("b", 1.0, 1.0), Method("c", None, 1.0)
    assert governing({"a": one, "b": other, "c": unknown}) == "b"
    assert governing({"c": unknown, "d": unknown}) == "c"
    assert governing({"e": Method("e", 1.0, 0.0), "a": one}) == "a" and math.isinf(Method("e", 1.0, 0.0).ratio)


class TestGuide:
    """The code of docs/plugins.md works as it is printed there."""

    @pytest.fixture
    def guide(self, demo, monkeypatch, tmp_path):
        section = (PROJECT / "docs" / "plugins.md").read_text(encoding="utf-8")
        code, sheet, text, values = (
            dedent(section.partition(f"\n{before}\n")[2].partition(f"\n{after}")[0])
            for before, after in (
                ("A complete code:", "4. *Methods.*"),
                ("Its text is a Jinja template, `texts/en/sheet.md`:", "Further texts are in"),
                ("Further texts are in `texts/en.toml`:", "The values come"),
                ("The values come from the code:", "Blank lines separate"),
            )
        )  # fmt: skip
        package = tmp_path / "rocking_guide"
        (package / "texts" / "en").mkdir(parents=True)
        (package / "__init__.py").write_text(f"{code}\n{values}", encoding="utf-8")
        (package / "texts" / "en.toml").write_text(text, encoding="utf-8")
        (package / "texts" / "en" / "sheet.md").write_text(sheet, encoding="utf-8")
        monkeypatch.syspath_prepend(tmp_path)
        yield lambda name: beside(monkeypatch, EntryPoint("UNI-demo", f"rocking_guide:{name}", Codes.group))
        sys.modules.pop("rocking_guide", None)

    def test_its_code_verifies(self, guide, demo):
        guide("Demo")
        each = run_json("verify", "block.yaml", *demo)["directions"]["positive"]
        assert each["governs"] == "ultimate" and each["ratio"] == pytest.approx(0.1875 * G)
        for name, check in vars(CodeContract).items():
            if name.startswith("test_"):
                check(TestContract())

    def test_its_sheet_is_written(self, guide, demo, monkeypatch):
        guide("DemoWithSheet")
        run("verify", "block.yaml", *demo, "--sheet", "s.html")
        page = Path("s.html").read_text(encoding="utf-8")
        assert "The verification is satisfied." in page and "The ratio is 1.83" in page
        assert "1.5·2.45166" in "".join(each.numbers for each in steps_of_page(page))
        monkeypatch.setattr("rocking_cli.verification.check.verify", lambda *given: pytest.fail("too late"))
        said = run("verify", "block.yaml", *demo, "--sheet", "t.html", "--language", "it", code=2).stderr
        assert "--language: there is no calculation sheet in 'it'" in said and "known: en" in said
        assert not Path("t.html").exists()
