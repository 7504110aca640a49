"""One conclusion on every surface of a question: text, JSON, sheet, report, survey and Python."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html import unescape

import numpy as np
import pytest
import yaml

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.studies.conclusion import ORDER, Concluded, Conclusion, NeighbourShare, worst
from rocking_cli.studies.verification.results import Requirement
from rocking_cli.views.conclusion import conclusion_data, digits_beside_one, of_verification
from tests.conftest import EXAMPLES
from tests.test_cli import run, run_json, some
from tests.test_rest import CRACKS, of

PILLAR = {"mechanism": "block", "width": 0.5, "height": 2.2, "density": 1800, "depth": 0.5}
SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2, "soil": "B"}


def further(SLC, SLD):
    """The fields of two more limit states, by their a_g [g]."""
    return {"SLC": {"ag": SLC, "F0": 2.5, "TC": 0.55, "S": 1.2}, "SLD": {"ag": SLD, "F0": 2.5, "TC": 0.36, "S": 1.2}}


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


@pytest.mark.parametrize("case", FURTHER)
def test_a_verification_concludes_the_same_everywhere(pillar, tmp_path, case):
    asked = pillar(case)
    data = run_json("verify", *asked)
    end, direction = data["conclusion"], data["directions"]["positive"]
    ratios = {name: each["ratio"] for name, each in direction["states"].items() if each["demand"] is not None}
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
    run("verify", *asked, "--sheet", "it.html", "--language", "it")
    (row,) = run_json("survey", "rows.csv", "--site", "s.site.yaml")["rows"]
    for text in (
        said.split("Site")[0], text_of((tmp_path / "en.html").read_text(encoding="utf-8")),
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
    assert report["verification"]["conclusion"] == end
    return text_of((folder / "r.html").read_text(encoding="utf-8")), report["answer"]


def test_what_does_not_count_is_not_shown_as_if_it_failed(pillar):
    """The onset of rocking at SLC, where displacement governs."""
    said = run("verify", *pillar("SLC fails")).stdout
    assert "onset of rocking at SLV" in said and "onset of rocking at SLC" not in said


def test_an_elastic_tie_is_named_in_the_conclusion(pillar, tmp_path):
    asked = pillar("all pass")
    bar = {"name": "bar", "path": [{"ground": [4.0, 2.0]}, {"at": [0.25, 2.0]}], "stiffness": 1e7}
    tied = {**PILLAR, "ties": [bar]}
    (tmp_path / "pillar.yaml").write_text(yaml.safe_dump(tied), encoding="utf-8")
    data = run_json("verify", *asked)
    assert data["conclusion"]["left_out"] == [{"what": "tie", "name": "bar", "why": "elastic"}]
    assert "Not counted: the stiffness of bar" in " ".join(run("verify", *asked).stdout.split())


def test_histories_count_only_if_there_are_as_many_as_the_code_requires():
    """One record decides nothing, and it is said that it takes the structure past its capacity; seven do."""
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
        assert end.concluded is (Concluded.SATISFIED if why == "too_few" else Concluded.NOT_SATISFIED)
    assert end.method == "histories"
    assert "a motion takes the structure past its capacity" in " ".join(of_verification(seven.result))


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


def test_the_worst_of_several_governs():
    checks = [
        Requirement.of("SLV", "nonlinear", 1.2, True), Requirement.of("SLC", "nonlinear_SLC", 1.05, True),
        Requirement.of("SLD", "SLD", None, None),
    ]  # fmt: skip
    ends = [Conclusion(concluded=each.concluded, limit_state=each.state, ratio=each.ratio) for each in checks]
    assert worst(ends[:2]).limit_state == "SLC" and worst(ends).concluded is Concluded.NOT_CHECKED
    rocks = [
        Conclusion(concluded=Concluded.ROCKS, motion=name, ratio=ratio) for name, ratio in (("a", 0.2), ("b", 0.5))
    ]
    assert worst(rocks).motion == "b"
    near = [
        replace(rocks[0], share=NeighbourShare(0.1, 0.4, 200)),
        replace(rocks[1], share=NeighbourShare(0.2, 0.2, 200)),
    ]
    assert worst(near).motion == "a"
    assert ORDER.index(Concluded.UNKNOWN) < ORDER.index(Concluded.OVERTURNS)


@pytest.mark.parametrize("ratio", [0.9999, 0.99999999, 1.0, 1.0001, 0.4, 12.345])
def test_a_printed_ratio_shows_on_which_side_of_one_it_is(ratio):
    printed = float(f"{ratio:.{digits_beside_one(ratio)}g}")
    assert (printed < 1) == (ratio < 1) and printed == pytest.approx(ratio, rel=5e-3)


@pytest.mark.every(3)
@pytest.mark.parametrize(
    ("pulse", "expected"),
    [("sine:0.1g:0.5s", "does_not_uplift"), ("sine:0.5g:0.4s", "rocks"), ("sine:2g:1s", "overturns")],
)
def test_a_response_concludes_the_same_in_text_json_and_report(tmp_path, pulse, expected):
    (tmp_path / "p.yaml").write_text(yaml.safe_dump({**PILLAR, "friction": 0.8}), encoding="utf-8")
    how = ("p.yaml", "--pulse", pulse, "--neighbours", 20)
    data = run_json("respond", *how, "--polarity", "both")
    end = data["conclusion"]
    assert end["concluded"] == expected and end["polarities"] == [1, -1] and end["polarity"] is None
    words = expected.replace("_", " ")
    assert words in " ".join(run("respond", *how).stdout.split())
    report = run_json("report", *how, "-o", "r.html")
    assert report["conclusion"]["concluded"] == expected and words in report["answer"]
    assert report["motions"][0]["headline"].startswith(words)
    answer = rk.respond("p.yaml", pulse, neighbours=20)
    assert words in answer.plot().axes[0].get_title(loc="left")
    assert answer.conclusion.concluded.value == expected
    near = answer.neighbours[1]
    assert answer.conclusion.share == NeighbourShare(near.overturned, near.at_most, 20)
    assert (answer.conclusion.ratio is None) == (expected == "overturns")


def test_an_unknown_response_is_concluded_with_its_joint_and_time():
    answer = rk.respond(EXAMPLES / "masonry" / "portal.yaml", "sine:1g:0.8s", models="nonlinear")
    run_, end = answer["nonlinear"], answer.conclusion
    assert run_.unknown == (end.concluded is Concluded.UNKNOWN)
    assert end.known_until == (run_.known_to if run_.unknown else None)
    assert end.joint == (run_.check.joint if run_.unknown else "")
    assert np.isfinite(run_.known_to) == run_.unknown
    json.dumps(conclusion_data(end))


def test_directions_that_differ_name_the_one_that_governs():
    leaning = rk.RigidBody(polygon=[[0, 0], [0.7, 0], [0.7, 2.8], [0.2, 2.8]], density=1800, depth=1)
    found = rk.verify(leaning, SITE)
    least = min(found.directions, key=lambda direction: found.directions[direction].ratio)
    assert found.conclusion.direction == least.label
    assert found.conclusion.ratio == found.directions[least].ratio
    assert set(found.conclusion.directions) == {each.label for each in Direction}


def test_motions_that_could_not_be_used_are_not_counted_silently(tmp_path):
    (tmp_path / "p.yaml").write_text(yaml.safe_dump(PILLAR), encoding="utf-8")
    (tmp_path / "bad.csv").write_text("no numbers\n", encoding="utf-8")
    how = ("respond", "p.yaml", "--pulse", "sine:0.1g:0.5s", "--pulse", "sine:0.2g:0.5s", "--neighbours", 0)
    assert "Not counted" not in run(*how).stdout
    record = EXAMPLES / "accel.csv"
    said = some("respond", "p.yaml", "--record", record, "--record", "bad.csv", "--neighbours", 0).stdout
    assert "Not counted: 1 of 2 motions, which could not be used." in " ".join(said.split())


def test_a_report_does_not_call_a_constant_force_elastic_and_repeats_cautions_of_its_verification(tmp_path, pillar):
    pillar("all pass")
    bar = {"name": "bar", "path": [{"ground": [4.0, 2.0]}, {"at": [0.25, 2.0]}], "stiffness": 0, "prestress": 500.0}
    (tmp_path / "pillar.yaml").write_text(yaml.safe_dump({**PILLAR, "ties": [bar]}), encoding="utf-8")
    run("report", "pillar.yaml", "--verify", "s.site.yaml", "-o", "r.html")
    page = text_of((tmp_path / "r.html").read_text(encoding="utf-8"))
    assert "Ties are assumed elastic" not in page
    cautions = [each for each in rk.verify("pillar.yaml", "s.site.yaml").sentences if each.startswith("Caution: at d_")]
    assert len(cautions) > 1 and page.count("the tie bar is") == 2


def test_a_row_of_a_survey_has_the_outcome_that_the_structure_has_alone(tmp_path):
    rows = "mechanism,name,width,height\nblock,slender,0.5,4\nblock,stout,1.2,3\nblock,middle,0.6,2.4\n"
    (tmp_path / "rows.csv").write_text(rows, encoding="utf-8")
    pulse = ("--pulse", "sine:0.35g:0.7s")
    for row in run_json("survey", "rows.csv", *pulse)["rows"]:
        line = rows.splitlines()[row["row"]].split(",")
        block = rk.Block(width=float(line[2]), height=float(line[3]))
        alone = rk.respond(block, "sine:0.35g:0.7s", polarity="both", neighbours=0)
        assert row["outcome"] == alone.conclusion.concluded.value


@pytest.mark.every(8)
@pytest.mark.parametrize("pulse", ["sine:0.15g:0.5s", "sine:0.5g:0.7s"])
@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("**/*.yaml")), ids=lambda file: file.stem)
def test_every_surface_of_a_response_has_one_conclusion(file, pulse):
    """Text, data and Python of all shipped structures."""
    if not yaml.safe_load(file.read_text(encoding="utf-8")).get("mechanism"):
        return
    answer = rk.respond(file, pulse, models="nonlinear", neighbours=0)
    end, history = answer.conclusion, answer["nonlinear"]
    words = end.concluded.value.replace("_", " ")
    said = " ".join(answer.sentences)
    assert re.search(rf"\b{words}\b", said) and answer.to_dict()["conclusion"] == conclusion_data(end)
    assert history.words == words and history.overturned == {"overturns": True, "unknown": None}.get(words, False)
