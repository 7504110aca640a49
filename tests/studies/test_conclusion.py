"""One conclusion on every surface of a question: text, JSON, sheet, report, survey and Python."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html import unescape
from pathlib import Path

import numpy as np
import pytest
import yaml
from click.testing import CliRunner

import rocking_cli as rk
from rocking_cli.cli.main import main
from rocking_cli.studies.conclusion import (
    SEVERITY,
    ByBlocks,
    Concluded,
    Conclusion,
    LeftOut,
    NeighbourShare,
    NextStep,
    are_alike,
    worst,
)
from rocking_cli.studies.response import concluded
from rocking_cli.verification.results import Requirement
from rocking_cli.views.conclusion import (
    NEXT_STEPS,
    conclusion_data,
    digits_beside,
    governing,
    governing_polarity,
    next_in_words,
    of_verification,
)  # fmt: skip
from rocking_cli.views.view import Table
from tests.cli.test_cli import run, run_json, some
from tests.conftest import EXAMPLES, YAML_FILES
from tests.dynamics.test_rest import CRACKS, of
from tests.following import respond

PILLAR = {"mechanism": "block", "width": 0.5, "height": 2.2, "density": 1800, "depth": 0.5}
LEANING = rk.RigidBody(polygon=[[0, 0], [0.7, 0], [0.7, 2.8], [0.2, 2.8]], density=1800, depth=1)
SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2, "soil": "B"}


def further(SLC, SLD):
    """The fields of two more limit states, by their a_g [g], which are required too."""
    states = {"states": ["SLD", "SLV", "SLC"]}
    return states | {
        "SLC": {"ag": SLC, "F0": 2.5, "TC": 0.55, "S": 1.2},
        "SLD": {"ag": SLD, "F0": 2.5, "TC": 0.36, "S": 1.2},
    }


FURTHER = {
    "all pass": further(0.15, 0.08), "SLC fails": further(0.24, 0.08), "SLD fails": further(0.15, 0.3), "SLV alone": {},
}  # fmt: skip
EXPECTED = {"all pass": True, "SLC fails": "SLC", "SLD fails": "SLD", "SLV alone": True}


@pytest.fixture
def pillar(tmp_path):
    def of(case):
        (tmp_path / "pillar.yaml").write_text(yaml.safe_dump(PILLAR), encoding="utf-8")
        (tmp_path / "s.site.yaml").write_text(yaml.safe_dump({**SITE, **FURTHER[case]}), encoding="utf-8")
        (tmp_path / "rows.csv").write_text(
            "mechanism,name,width,height,density,depth\nblock,pillar,0.5,2.2,1800,0.5\n", encoding="utf-8"
        )
        return ("pillar.yaml", "--site", "s.site.yaml")

    return of


def text_of(page):
    return " ".join(unescape(re.sub(r"<[^>]+>", "", page)).split())


@pytest.mark.every(4)
@pytest.mark.parametrize("case", FURTHER)
def test_a_verification_concludes_the_same_everywhere(pillar, tmp_path, case):
    asked = pillar(case)
    data = run_json("verify", *asked, "--sheet", "it.html", "--language", "it")
    end, direction = data["conclusion"], data["directions"]["positive"]
    ratios = {name: each["zeta_E"] for name, each in direction["states"].items() if each["demand"] is not None}
    if direction["zeta"]["SLD"] is not None:
        ratios["SLD"] = direction["zeta"]["SLD"]
    least = min(ratios, key=ratios.get)
    passes = all(ratio >= 1 for ratio in ratios.values())
    assert passes == (EXPECTED[case] is True) and end["concluded"] == ("satisfied" if passes else "not_satisfied")
    assert (end["limit_state"], end["ratio"]) == (least, pytest.approx(ratios[least]))
    assert passes or EXPECTED[case] == least
    assert end["limit_states"] == list(ratios) and end["direction"] is None
    english = "is satisfied" if passes else "is not satisfied"
    italian = "è soddisfatta" if passes else "non è soddisfatta"
    said = run("verify", *asked, "--sheet", "en.html").stdout
    page = text_of((tmp_path / "en.html").read_text(encoding="utf-8"))
    if not passes and least != "SLD":  # zeta_E and a_g are of the limit state that the sentence names
        zeta = direction["zeta"][f"nonlinear_{least}"]
        assert f"{least}: the verification is not satisfied. ζE = {zeta:.4g};" in page
    (row,) = run_json("survey", "rows.csv", "--site", "s.site.yaml")["rows"]
    for text in (
        said.split(": a_g")[0], text_of((tmp_path / "en.html").read_text(encoding="utf-8")),
        *(_in_the_report(tmp_path, end) if case == "SLC fails" else ()),
    ):  # fmt: skip
        first = re.search(
            r"The verification (is not satisfied|is satisfied)[^.]*\. (\w+) governs", " ".join(text.split())
        )
        assert first is not None and (first[1], first[2]) == (english, least)
    first = re.search(r"La verifica (non è soddisfatta|è soddisfatta)[^.]*\. Governa lo (\w+)",
                      text_of((tmp_path / "it.html").read_text(encoding="utf-8")))  # fmt: skip
    assert first is not None and (first[1], first[2]) == (italian, least)
    assert (row["concluded"], row["limit_state"], row["ratio"]) == (end["concluded"], least, end["ratio"])
    answer = rk.verify("pillar.yaml", "s.site.yaml")
    assert conclusion_data(answer.conclusion) == end | {"left_out": []}
    assert english in repr(answer) or "..." in repr(answer)


def _in_the_report(folder, end):
    report = run_json("report", "pillar.yaml", "--verify", "s.site.yaml", "-o", "r.html")
    assert report["verification"]["conclusion"] == end == report["conclusion"]
    return text_of((folder / "r.html").read_text(encoding="utf-8")), report["answer"]


@pytest.mark.rest
def test_an_elastic_tie_is_named_in_the_conclusion(pillar, tmp_path):
    asked = pillar("all pass")
    bar = {"name": "bar", "path": [{"ground": [4.0, 2.0]}, {"at": [0.25, 2.0]}], "stiffness": 1e7}
    tied = {**PILLAR, "ties": [bar]}
    (tmp_path / "pillar.yaml").write_text(yaml.safe_dump(tied), encoding="utf-8")
    data = run_json("verify", *asked)
    assert data["conclusion"]["left_out"] == [
        {"what": "tie", "name": "bar", "why": "elastic", "give": "ties.bar.steel", "state": ""}
    ]
    said = "Not counted: bar, because an elastic tie has no strength: give its `steel` or `yield`, so that it counts."
    assert " ".join(run("verify", *asked).stdout.split()).startswith(said)
    (tmp_path / "rows.csv").write_text("file,name\npillar.yaml,tied\npillar.yaml,again\n", encoding="utf-8")
    assert run("survey", "rows.csv", "--site", "s.site.yaml").stdout.startswith(
        "Not counted: elastic ties of tied, again"
    )
    run("verify", *asked, "--sheet", "en.html")
    run("report", "pillar.yaml", "--verify", "s.site.yaml", "-o", "r.html")
    for page in ("en.html", "r.html"):
        assert "Summary Not counted: bar" in text_of(Path(page).read_text(encoding="utf-8"))
    rows = run_json("survey", "rows.csv", "--site", "s.site.yaml")["rows"]
    assert [row["not_counted"] for row in rows] == ["bar", "bar"]
    (table,) = (part for part in rk.survey("rows.csv", site="s.site.yaml").view.parts if isinstance(part, Table))
    assert table.rows[0][table.columns.index("not\ncounted")] == "bar"


def test_histories_count_only_if_there_are_as_many_as_the_code_requires():
    """One record decides nothing, and the sentence says that it takes the structure past its capacity; seven do."""
    site = {**SITE, **FURTHER["all pass"]}
    block = rk.Block(**{key: each for key, each in PILLAR.items() if key != "mechanism"})
    for pulse, why in (("sine:0.1g:0.5s", "too_few"), ("sine:2g:1s", "too_few_and_past")):
        one = rk.verify(block, site, motions=[pulse])
        end = one.conclusion
        assert end.concluded is Concluded.SATISFIED and [each.why for each in end.left_out] == [why]
        assert ("past its capacity" in " ".join(of_verification(one.result))) == (why == "too_few_and_past")
        weak, strong = (f"sine:0.1{k}g:0.5s" for k in range(7)), (f"sine:2.{k}g:1s" for k in range(7))
        seven = rk.verify(block, site, motions=list(weak if why == "too_few" else strong))
        end = seven.conclusion
        assert not end.left_out and len(end.motions) == 7
        assert end.concluded is (Concluded.SATISFIED_IF if why == "too_few" else Concluded.NOT_SATISFIED)
        assert [each.key for each in end.limits] == ["below_target"] * (why == "too_few")
    assert end.method == "histories"
    assert "sine:2g:1s takes the structure past its capacity" in " ".join(of_verification(seven.result))


def test_a_mechanism_that_does_not_start_first_is_not_satisfied():
    """Of the wall with two cracks, whose fixed crack opens before it rocks the other way."""
    weak = {key: (0.01 if key == "ag" else each) for key, each in SITE.items()}
    found = rk.verify(of(CRACKS), weak)
    assert found.conclusion.concluded is Concluded.NOT_CHECKED
    assert [(each.what, each.name) for each in found.conclusion.left_out] == [("mechanism", "middle and upper")]
    said = " ".join(of_verification(found.result))
    assert "does not cover the structure" in said and "is satisfied" not in said
    bonded = CRACKS.replace("middle]}", "middle], bonded: true}").replace("upper]}", "upper], bonded: true}")
    assert rk.verify(of(bonded), weak).conclusion.concluded is Concluded.SATISFIED


BAR = {"name": "bar", "path": [{"ground": [4.0, 2.0]}, {"at": [0.25, 2.0]}]}
CHANGES = {
    "left out": ({"ties": [{**BAR, "stiffness": 1e7}]}, FURTHER["all pass"], ()),
    "tied": ({"ties": [{**BAR, "stiffness": 0, "prestress": 500.0}]}, FURTHER["all pass"], ()),
    "overturns": ({}, FURTHER["all pass"], [f"sine:2.{k}g:1s" for k in range(7)]),
    "a record": ({}, FURTHER["all pass"], ["sine:2g:1s"]),
    "unknown": ({"friction": 0.3}, FURTHER["all pass"], [f"sine:0.5{k}g:0.6s" for k in range(7)]),
}


def outcome_of(*asked):
    """What a command prints, whatever its exit code: its result, or the error."""
    result = CliRunner().invoke(main, [str(each) for each in asked])
    assert "Traceback" not in result.stderr
    return result.stdout or result.stderr


def surfaces(folder, structure, states, pulses):
    """What each surface of a verification concludes, in its own words."""
    (folder / "p.yaml").write_text(yaml.safe_dump({**PILLAR, **structure}), encoding="utf-8")
    (folder / "s.site.yaml").write_text(yaml.safe_dump({**SITE, **states}), encoding="utf-8")
    (folder / "rows.csv").write_text("file,name\np.yaml,pillar\n", encoding="utf-8")
    asked = ("p.yaml", "--site", "s.site.yaml", *(part for pulse in pulses for part in ("--pulse", pulse)))
    found = {}
    said, data = (
        outcome_of("verify", *asked, "--sheet", f"{language}.html", "--language", language, *more)
        for language, more in (("en", ()), ("it", ("--json",)))
    )
    for name, sheet in (("English", "en.html"), ("Italian", "it.html")):
        page = text_of((folder / sheet).read_text(encoding="utf-8")) if (folder / sheet).exists() else said
        start = re.search("Not counted: bar|Catene non considerate|The verification|La verifica|The site does", page)
        found[name] = page[start.start() : start.start() + 330] if start else page
    found["text"] = " ".join(said.split("Site")[0].split())
    found["json"] = json.dumps(json.loads(data)["conclusion"]) if data.startswith("{") else data
    if not pulses:
        found["survey"] = outcome_of("survey", "rows.csv", "--site", "s.site.yaml")
        report = outcome_of("report", "p.yaml", "--verify", "s.site.yaml", "-o", "r.html", "--json")
        found["report"] = json.loads(report)["answer"] if report.startswith("{") else report
    return found


@pytest.fixture(scope="module")
def unchanged(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder := tmp_path_factory.mktemp("unchanged"))
        return surfaces(folder, {}, FURTHER["all pass"], ())


@pytest.mark.every(20)
@pytest.mark.parametrize("change", CHANGES)
def test_a_change_of_the_result_changes_every_surface(unchanged, tmp_path, change):
    """Whatever changes the conclusion is seen in text, data, both sheets, survey and report."""
    found = surfaces(tmp_path, *CHANGES[change])
    assert all(each.strip() for each in found.values())
    assert {name for name, each in found.items() if each == unchanged[name]} == set()


def test_a_margin_a_pulse_and_a_response_conclude_alike():
    """The same class and governing motion from three commands; a margin adds the share and the factor."""
    block, pulses = rk.Block(width=0.5, height=2.2), ["sine:0.35g:0.7s", "sine:2g:1s", "sine:0.1g:1s"]
    for pulse in pulses:
        alone, margin = rk.respond(block, pulse, neighbours=4), rk.margin(block, pulse, polarity="1", neighbours=4)
        assert alone.conclusion.concluded is margin.conclusion.concluded
        assert alone.conclusion.share == margin.conclusion.share
        _, ag, period = pulse.split(":")
        end = rk.pulse(block, shape="sine", ag=float(ag[:-1]), period=float(period[:-1])).conclusion
        assert end.concluded is alone.conclusion.concluded
        found = margin[margin.conclusion.motion]
        least = found.first(0.1, unknown=True)
        assert margin.conclusion.ratio == (np.inf if least is None else least)
    several = rk.margin(block, pulses, polarity="1", neighbours=4)
    assert several.conclusion.motion == several.sentences[0].split(". ")[1].split(" governs")[0] == "sine:2g:1s"
    assert several.conclusion.motions == pulses
    none = rk.margin(block, "sine:1e-3g:0.1s", polarity="1", neighbours=4)
    assert np.isinf(none.conclusion.ratio) and "At no factor tried may 10 % or more overturn." in none.sentences[0]
    assert none.to_dict()["conclusion"]["ratio"] is None


@pytest.mark.parametrize(
    ("aim", "motions", "expected"),
    [
        ("lambda >= 0.2", (), "satisfied"), ("lambda >= 2", (), "not_satisfied"),
        ("overturned <= 0.1", ("sine:0.5g:0.7s",), "satisfied"),
        ("overturned <= 0.1", ("sine:9g:3s",), "not_satisfied"),
    ],
)  # fmt: skip
def test_a_design_concludes_whether_any_value_meets_the_requirement(aim, motions, expected):
    around = {"neighbours": 10} if motions else {}
    found = rk.design(rk.Block(width=0.5, height=2), "width=0.2m:0.7m", aim, motions, points=5, **around)
    assert found.conclusion.concluded == expected == found.to_dict()["conclusion"]["concluded"]
    assert found.conclusion.motions == list(motions)
    assert ("holds at no value" in found.sentences[0]) == (expected == "not_satisfied")


def test_a_design_of_unknown_outcomes_is_unknown():
    found = rk.design(rk.Block(width=0.5, height=2), "width=1m:1.4m", "overturned <= 0.1", "sine:9g:3s", neighbours=10,
                      points=2)  # fmt: skip
    assert found.behind[1].unknown > 0.5 and found.conclusion.concluded is Concluded.UNKNOWN
    assert "Whether overturned <= 0.1 holds at any value of width tried" in found.sentences[0]


@pytest.mark.rest
def test_a_design_by_the_code_uses_the_limit_state_that_governs_and_no_mechanism_that_starts_later():
    block = rk.Block(**{key: each for key, each in PILLAR.items() if key != "mechanism"}).replace(depth=1.0)
    site = {**SITE, **FURTHER["SLC fails"]}
    found = rk.design(block, "width=0.5m:0.9m", "ratio >= 1", site=site, points=2)
    assert found.metric[0] == rk.verify(block, site).conclusion.ratio < 1
    assert rk.verify(block.model_copy(update={"width": found.value * 1.001}), site).conclusion.concluded == "satisfied"
    assert rk.verify(block.model_copy(update={"width": found.value * 0.999}), site).conclusion.limit_state == "SLC"
    cracks = rk.design(of(CRACKS), "density=1500kg/m3:2500kg/m3", "ratio >= 0.001", site=SITE, points=2)
    assert not cracks.holds and "another mechanism starts first" in " ".join(cracks.sentences)


def test_every_next_step_has_words_and_says_what_the_result_needs():
    assert set(NEXT_STEPS) == {*NextStep}
    unknown = Conclusion(concluded=Concluded.UNKNOWN, remedy=NextStep.HOLD_JOINT, witness=True)
    assert unknown.next == [NextStep.HOLD_JOINT, NextStep.FREE_BLOCKS, NextStep.MARGIN]
    assert replace(unknown, ratio=1.2).next == [
        NextStep.HOLD_JOINT,
        NextStep.FREE_BLOCKS,
    ]  # a margin need not name itself
    assert replace(unknown, witness=False).next == [NextStep.HOLD_JOINT, NextStep.MARGIN]
    fails = Conclusion(concluded=Concluded.NOT_SATISFIED, method="nonlinear", ratio=0.8)
    assert fails.next == [NextStep.DESIGN] and "`rocking design`" in next_in_words(fails)
    tie = [LeftOut("tie", "bar", "elastic")]
    assert replace(fails, left_out=tie).next == [NextStep.YIELD_FORCE, NextStep.DESIGN]
    first = replace(fails, concluded=Concluded.NOT_CHECKED, left_out=[LeftOut("mechanism", "a and b", "starts_first")])
    assert first.next == [NextStep.FIRST_MECHANISM]
    assert next_in_words(Conclusion(concluded=Concluded.NO_UPLIFT)) == ""
    rocks = Conclusion(concluded=Concluded.ROCKS, share=NeighbourShare(0.0, 0.0, 20))
    assert rocks.next == [] and replace(rocks, share=NeighbourShare(0.0, 0.1, 20)).next == [NextStep.MARGIN]
    assert replace(rocks, share=NeighbourShare(0.9, 1.0, 20)).next == [NextStep.MARGIN]
    assert replace(rocks, share=NeighbourShare(1.0, 1.0, 20)).next == []  # they all end alike


def test_the_worst_of_several_governs():
    checks = [
        Requirement.of("SLV", "nonlinear", 1.2, True), Requirement.of("SLC", "nonlinear_SLC", 1.05, True),
        Requirement.of("SLD", "SLD", None, None),
    ]  # fmt: skip
    ends = [Conclusion(concluded=each.concluded, limit_state=each.state, ratio=each.ratio) for each in checks]
    assert worst(ends[:2]).limit_state == "SLC" and worst(ends).concluded is Concluded.NOT_CHECKED
    rocks = [
        Conclusion(concluded=Concluded.ROCKS, motion=name, peak_ratio=peak) for name, peak in (("a", 0.2), ("b", 0.5))
    ]
    assert worst(rocks).motion == "b"
    near = [
        replace(rocks[0], share=NeighbourShare(0.1, 0.4, 200)),
        replace(rocks[1], share=NeighbourShare(0.2, 0.2, 200)),
    ]
    assert worst(near).motion == "a"
    blocks = [ByBlocks(Concluded.OVERTURNS, None, None, 3.0), ByBlocks(Concluded.ROCKS, 0.4, None, None)]
    open_ = [
        Conclusion(concluded=Concluded.UNKNOWN, motion=name, blocks=each)
        for name, each in zip("ab", blocks, strict=True)
    ]
    assert worst(open_).motion == "a" and worst([*open_, ended("c", Concluded.OVERTURNS)]).motion == "c"
    early, late = (replace(open_[0], motion=str(time), known_until=time) for time in (1.0, 2.0))
    assert worst([late, early]) is early and not are_alike(early, late)
    assert (open_[1].told.concluded, open_[1].told.peak_ratio) == (Concluded.ROCKS, 0.4)
    known = replace(rocks[0], blocks=blocks[0])
    assert known.told is known and known.concluded is Concluded.ROCKS
    assert SEVERITY.index(Concluded.UNKNOWN) < SEVERITY.index(Concluded.OVERTURNS)


def ended(motion, what, peak=None, *shares):
    """A conclusion under a motion, with the lowest and highest share of 40 neighbours that overturn."""
    until = 3.32 if what is Concluded.UNKNOWN else None
    share = NeighbourShare(*shares, 40) if shares else None
    return Conclusion(concluded=what, motion=motion, peak_ratio=peak, known_until=until, share=share)


@pytest.mark.parametrize(
    ("governs", "said"),
    [
        (ended("b", Concluded.OVERTURNS), "b governs: the structure overturns."),
        (ended("b", Concluded.OVERTURNS, None, 0.3, 0.3),
         "b governs: the structure overturns, and 30 % of its 40 neighbours overturn."),
        (ended("b", Concluded.UNKNOWN, None, 0.0, 1.0), "b governs: the outcome is unknown after 3.32 s, and 0 % to "
         "100 % of its 40 neighbours overturn, as some outcomes are unknown."),
        (ended("b", Concluded.ROCKS, 0.1, 0.6, 0.6),
         "b governs: the structure rocks to 0.1 phi_cr, and 60 % of its 40 neighbours overturn."),
        (ended("b", Concluded.ROCKS, 0.5), "b governs: the structure rocks to 0.5 phi_cr."),
        (ended("b", Concluded.ROCKS, 0.4 * (1 + 1e-9)),
         "a and b govern alike: under each, the structure rocks to 0.4 phi_cr."),
    ],
)  # fmt: skip
def test_the_motion_that_governs_is_named_with_what_the_structure_does(governs, said):
    shares = (0.4, 0.4) if governs.share is not None and governs.concluded is Concluded.ROCKS else ()
    assert governing([ended("a", Concluded.ROCKS, 0.4, *shares), governs], "phi_cr") == said


def test_no_motion_governs_if_none_uplifts_the_structure():
    assert governing([ended("a", Concluded.NO_UPLIFT, 0.0), ended("b", Concluded.NO_UPLIFT, 0.0)], "phi_cr") == ""


def test_the_polarity_that_governs_is_that_of_the_conclusion():
    falls, open_, rocks = (ended("a", Concluded.OVERTURNS), ended("a", Concluded.UNKNOWN),
                           ended("a", Concluded.ROCKS, 0.2))  # fmt: skip
    assert governing_polarity({1: open_, -1: falls}, -1, "phi_cr") == (
        "Polarity -1 governs: with the motion reversed, the structure overturns; as given, the outcome is unknown "
        "after 3.32 s."
    )
    assert governing_polarity({1: rocks, -1: rocks}, None, "of the limit") == (
        "Neither polarity governs: with the motion as given and reversed, the structure rocks to 0.2 of the limit."
    )
    for pulse in ("sine:0.35g:0.7s", "ricker:0.6g:0.7s", "sine:2g:1s"):
        both = rk.respond(LEANING, pulse, polarity="both", neighbours=5)
        end, data = both.conclusion, both.to_dict()
        assert data["governs"] == end.polarity
        said = "Neither polarity governs: " if end.polarity is None else f"Polarity {end.polarity} governs: "
        assert any(each.startswith(said) for each in both.sentences)
        alone = [rk.respond(LEANING, pulse, polarity=sign, neighbours=5).conclusion for sign in ("1", "-1")]
        assert end.concluded is max((each.concluded for each in alone), key=SEVERITY.index)


@pytest.mark.parametrize("ratio", [0.9999, 0.99999999, 1.0, 1.0001, 0.4, 12.345])
def test_a_printed_ratio_shows_on_which_side_of_one_it_is(ratio):
    printed = float(f"{ratio:.{digits_beside(ratio)}g}")
    assert (printed < 1) == (ratio < 1) and printed == pytest.approx(ratio, rel=5e-3)


@pytest.mark.every(8)
@pytest.mark.parametrize(
    ("pulse", "expected"),
    [("sine:0.1g:0.5s", "does_not_uplift"), ("sine:0.5g:0.4s", "rocks"), ("sine:2g:1s", "overturns")],
)
def test_a_response_concludes_the_same_in_text_json_and_report(tmp_path, pulse, expected):
    (tmp_path / "p.yaml").write_text(yaml.safe_dump({**PILLAR, "friction": 0.8}), encoding="utf-8")
    end = rk.respond("p.yaml", pulse, neighbours=5, polarity="both").to_dict()["conclusion"]
    assert end["concluded"] == expected and end["polarities"] == [1, -1] and end["polarity"] is None
    words = expected.replace("_", " ")
    report = run_json("report", "p.yaml", "--pulse", pulse, "--neighbours", 5, "-o", "r.html")
    assert report["conclusion"]["concluded"] == expected and words in report["answer"]
    assert report["motions"][0]["headline"].startswith(words)
    answer = rk.respond("p.yaml", pulse, neighbours=5)
    assert words in " ".join(answer.sentences) and words in answer.plot().axes[0].get_title(loc="left")
    assert answer.conclusion.concluded.value == expected
    near = answer.neighbours[1]
    assert answer.conclusion.share == NeighbourShare(near.overturned, near.at_most, 5)
    assert (answer.conclusion.peak_ratio is None) == (expected == "overturns")


def test_an_unknown_response_is_concluded_with_its_joint_and_time():
    answer = rk.respond(EXAMPLES / "masonry" / "portal.yaml", "sine:1g:0.8s", model="nonlinear", engine="exact")
    run_, end = answer["nonlinear"], answer.conclusion
    assert run_.unknown == (end.concluded is Concluded.UNKNOWN)
    assert end.known_until == (run_.known_to if run_.unknown else None)
    assert end.joint == (run_.check.joint if run_.unknown else "")
    assert np.isfinite(run_.known_to) == run_.unknown
    json.dumps(conclusion_data(end))


@pytest.mark.parametrize(
    ("fields", "what", "peak", "until"),
    [
        ({}, Concluded.ROCKS, 0.4, None),
        ({"peak_ratio": 0.0}, Concluded.NO_UPLIFT, 0.0, None),
        ({"fell_to": 1, "peak_ratio": np.nan}, Concluded.OVERTURNS, None, None),
        ({"unknown": True, "known_to": 3.0, "warned": 2.0}, Concluded.UNKNOWN, None, 3.0),
        ({"unknown": True, "known_to": 0.5, "peak_ratio": 0.0}, Concluded.UNKNOWN, None, 0.5),
    ],
)
def test_a_history_concludes_with_its_peak_or_until_when_it_is_known(fields, what, peak, until):
    rested = respond(rk.Block(width=0.7, height=2.8), release=0.4, models=("nonlinear",))["nonlinear"]
    end = concluded({1: {"nonlinear": replace(rested, **fields)}}, {}, "motion")
    assert (end.concluded, end.peak_ratio, end.known_until) == (what, pytest.approx(peak) if peak else peak, until)
    assert (end.remedy is None) == (until is None)


def test_motions_that_could_not_be_used_are_not_counted_silently(tmp_path):
    (tmp_path / "p.yaml").write_text(yaml.safe_dump(PILLAR), encoding="utf-8")
    (tmp_path / "bad.csv").write_text("no numbers\n", encoding="utf-8")
    how = ("respond", "p.yaml", "--pulse", "sine:0.1g:0.5s", "--pulse", "sine:0.2g:0.5s", "--neighbours", 0)
    assert "Not counted" not in run(*how).stdout
    record = EXAMPLES / "accel.csv"
    said = some("respond", "p.yaml", "--record", record, "--record", "bad.csv", "--neighbours", 0).stdout
    assert "Not counted: 1 of 2 motions (bad.csv), which could not be used." in " ".join(said.split())


@pytest.mark.rest
def test_a_report_does_not_call_a_constant_force_elastic_and_repeats_cautions_of_its_verification(tmp_path, pillar):
    pillar("all pass")
    bar = {"name": "bar", "path": [{"ground": [4.0, 2.0]}, {"at": [0.25, 2.0]}], "stiffness": 0, "prestress": 500.0}
    (tmp_path / "pillar.yaml").write_text(yaml.safe_dump({**PILLAR, "ties": [bar]}), encoding="utf-8")
    run("report", "pillar.yaml", "--verify", "s.site.yaml", "-o", "r.html")
    page = text_of((tmp_path / "r.html").read_text(encoding="utf-8"))
    assert "Ties are assumed elastic" not in page
    ends = [each for each in rk.verify("pillar.yaml", "s.site.yaml").sentences if "bar is not known to hold" in each]
    assert len(ends) == 1 and "The tie bar is not known to hold beyond d =" in page


@pytest.mark.every(8)
@pytest.mark.parametrize("number", range(len(YAML_FILES)), ids=lambda number: YAML_FILES[number].stem)
def test_every_surface_of_a_response_has_one_conclusion(number):
    """Text, data and Python of all shipped structures, under a weak and a strong pulse in turn."""
    file = YAML_FILES[number]
    if not yaml.safe_load(file.read_text(encoding="utf-8")).get("mechanism"):
        return
    pulse = ("sine:0.15g:0.5s", "sine:0.5g:0.7s")[number % 2]
    answer = rk.respond(file, pulse, model="nonlinear", neighbours=0, engine="exact")
    end, history = answer.conclusion, answer["nonlinear"]
    words = end.concluded.value.replace("_", " ")
    said = " ".join(answer.sentences)
    assert re.search(rf"\b{words}\b", said) and answer.to_dict()["conclusion"] == conclusion_data(end)
    assert history.words == words and history.overturned == {"overturns": True, "unknown": None}.get(words, False)
