"""A restitution that is given for a run: all that a verb answers is that of a structure which has it in its file."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text

import rocking_cli as rk
from rocking_cli.questions.report import study
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

ETA = 0.9
STRUCTURES = {each: rk.load_structure(EXAMPLES / f"{each}.yaml") for each in ("block", "frame")}
STRUCTURES["facade"] = rk.load_structure(EXAMPLES / "verify" / "facade.yaml")
PULSE = "sine:0.45g:0.9s"
OF_FACADE = "mavroeidis:0.15g:1s:0deg:5"
VERBS = {
    "respond": {"polarity": "both", "neighbours": 8, "impacts": True},
    "margin": {"polarity": "1", "neighbours": 2},
    "overturning": {"points": 5, "model": "nonlinear", "period": (0.5, 2.0), "ag": (0.3, 1.5)},
    "report": {"polarity": "1", "neighbours": 2},
}


def with_file_value(mechanism):
    return mechanism.replace(**{"restitution" if mechanism.rocks_both_ways else "rebound": ETA})


def plain(text):
    """A text without what says that the restitution is that of the run."""
    text = text.replace(" (given for this run)", "").replace("given for this run", "as given")
    text = text.replace(" per questa analisi", "").replace('"source": "run"', '"source": "given"')
    text = text.replace('"restitution": "run"', '"restitution": "given"')
    return re.sub(r", (eta|rebound) = 0\.9\b", "", re.sub(r"\s+", " ", text))


def drawn(figure):
    """The texts of a picture, and its lines."""
    texts = [plain(each.get_text()) for each in figure.findobj(Text)]
    lines = [np.asarray(line.get_xydata()).tolist() for axes in figure.axes for line in axes.get_lines()]
    return texts, json.dumps(lines)


def pulse_of(structure):
    return PULSE if structure.rocks_both_ways else OF_FACADE


def data_of(answer):
    return {key: value for key, value in answer.to_dict().items() if key != "given"}


def answered(verb, structure, **more):
    """All that a verb answers: data, words, frame and picture, and a report as a file."""
    motion = {} if verb == "overturning" else {"motions": pulse_of(structure)}
    answer = getattr(rk, verb)(structure, **motion, **VERBS[verb], **more)
    columns = {name: list(map(str, values)) for name, values in answer.columns().items()}
    parts = [each for each in answer.view.parts if verb != "margin" or "given for this run" not in str(each)]
    page = plain(Path("r.html").read_text(encoding="utf-8")) if verb == "report" else ""
    return plain(json.dumps(data_of(answer))), plain(str(parts)), columns, page, *drawn(answer.figure())


@pytest.fixture(autouse=True)
def quick(monkeypatch, tmp_path):
    monkeypatch.setattr(study, "MAP_POINTS", 5)
    monkeypatch.chdir(tmp_path)


@pytest.mark.every(4)
@pytest.mark.parametrize("name", STRUCTURES)
@pytest.mark.parametrize("verb", VERBS)
def test_all_that_is_answered_is_that_of_a_file_with_this_restitution(verb, name):
    mechanism = STRUCTURES[name]
    language = {"out": "r.html", "language": "it" if name == "frame" else "en"} if verb == "report" else {}
    ours = answered(verb, mechanism, restitution=ETA, **language)
    theirs = answered(verb, with_file_value(mechanism), **language)
    for one, other in zip(ours, theirs, strict=True):
        assert one == other
    asked = {} if verb == "overturning" else {"motions": pulse_of(mechanism)}
    assert plain(json.dumps(data_of(getattr(rk, verb)(mechanism, **asked, **VERBS[verb])))) != ours[0]


@pytest.mark.every(2)
@pytest.mark.parametrize("name", ["facade", "frame"])
def test_it_is_said_that_it_was_given_for_the_run(name):
    mechanism = STRUCTURES[name]
    value = "eta = 0.9" if mechanism.rocks_both_ways else "rebound = 0.9"
    for verb in ("respond", "margin"):
        answer = getattr(rk, verb)(mechanism, PULSE, neighbours=1, polarity="1", restitution=ETA)
        assert answer.to_dict()["restitution"]["source"] == "run"
        assert any("given for this run" in each for each in answer.view.parts if isinstance(each, str))
        assert any(value in each.get_text() for each in answer.figure().findobj(Text))
    found = rk.overturning(mechanism, points=4, restitution=ETA)
    assert "eta = 0.9 (given for this run)" in str(found.view.parts) and found.to_dict()["restitution"] == "run"
    both = rk.overturning([mechanism, STRUCTURES["block"]], compare=True, model="linear2", points=2, restitution=ETA)
    assert [each["restitution"] for each in both.to_dict()["structures"]] == ["run"] * 2
    assert "eta = 0.9" in str(both.view.parts)


def test_in_all_directions_too():
    motions = [rk.parse_pulse(each).sampled() for each in (PULSE, "sine:0.2g:0.9s")]
    block = STRUCTURES["block"]
    asked = rk.structure.Structure(block, restitution=ETA)
    ours, theirs = (rk.respond_around(each, *motions, model="nonlinear") for each in (asked, with_file_value(block)))
    assert "given for this run" in str(ours.view.parts) and ours.to_dict()["restitution"]["source"] == "run"
    np.testing.assert_array_equal(ours.outcomes["nonlinear"].peak_ratio, theirs.outcomes["nonlinear"].peak_ratio)


@pytest.mark.parametrize(
    ("name", "eta", "said"),
    [
        ("block", 1.2, "must be at most 1, got 1.2"),
        ("frame", 0.0, "must be more than 0, got 0.0"),
        ("facade", 1.0, "rebound: input should be less than 1, got 1"),
    ],
)
def test_one_that_the_structure_cannot_have_is_refused_by_the_name_of_the_option(name, eta, said):
    file = EXAMPLES / (f"{name}.yaml" if name != "facade" else "verify/facade.yaml")
    for words in (("respond", "--pulse", PULSE), ("margin", "--pulse", PULSE), ("overturning",), ("report",)):
        stderr = run(*words, file, "--restitution", eta, code=2).stderr
        assert "error: --restitution" in stderr and said in " ".join(stderr.split())


def test_free_blocks_refuse_it_by_name_and_auto_says_what_they_do():
    pytest.importorskip("mujoco")
    block = EXAMPLES / "block.yaml"
    asked = (("margin", "--pulse", PULSE), ("overturning", "--points", 3))
    for words in asked:
        refused = run(*words, block, "--restitution", ETA, "--engine", "blocks", code=2).stderr
        assert "--restitution has no effect with free blocks" in refused
    found = run_json("respond", "--pulse", PULSE, block, "--restitution", ETA, "--engine", "auto")
    assert found["restitution"]["source"] == "run"
    said, _ = rk.views.engines.engines_in_words("auto", 1, STRUCTURES["block"])
    assert "Impacts lose the energy that contact takes, whatever restitution is given." in said
