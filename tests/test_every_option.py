"""Every argument of every verb, and every option of every command, has an effect or is refused by name.

Each is set to an odd value beside a question in which it means something, and the answer must change (its data, words,
columns, plot, notes and files) or an `InputError` must name it. `IDLE` has questions in which it means nothing.
"""

from __future__ import annotations

import inspect
import json
import re
from pathlib import Path

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.watcher import Watcher
from tests.conftest import EXAMPLES

BLOCK = rk.Block(width=0.7, height=2.8, name="block", friction=0.6)
OTHER = rk.Block(width=0.5, height=2.0, name="other")
WEAK = rk.Block(width=0.7, height=2.8, name="weak", friction=0.2)  # it slides before it rocks
PULSE, STRONG = "sine:0.3g:0.5s", "sine:0.9g:0.5s"
FRAME = rk.load_structure(EXAMPLES / "frame.yaml").model_copy(update={"friction": 0.3})
LEANING = WEAK.model_copy(update={"one_sided": "positive", "rebound": 0.5})
PORTAL = rk.load_structure(EXAMPLES / "assembly.yaml")
TIME = 0.01 * np.arange(200)
RECORD = rk.GroundMotion("record", 0.01, 3.0 * np.sin(2 * np.pi * TIME / 0.8) * np.exp(-TIME))
AROUND = {"neighbours": 3, "amplitude_deviation": 0.3, "slenderness_deviation": 0.3, "restitution_deviation": 0.3}
SITE = EXAMPLES / "verify" / "site.yaml"

CALLS = {
    "equiv": ({"structures": BLOCK}, {"structures": [BLOCK, OTHER]}),
    "collapse": ({"structure": PORTAL}, {"structure": PORTAL.enlarged(2.0)}),
    "draw": ({"structure": BLOCK}, {"structure": OTHER, "at": 0.3}),
    "error": ({"structure": BLOCK}, {"structure": WEAK, "at": [0.3], "a": [3.0]}),
    "respond": (
        {"structure": WEAK, "motion": RECORD, "neighbours": 2, "opening": 1.0},
        {"structure": BLOCK, "motion": PULSE, "models": "nonlinear", "polarity": "both", "vertical": RECORD,
         "vertical_dt": 0.1, "vertical_channel": "2", "with_pulse": "sine", "release": 0.2,
         "opening": 0.0, "impacts": True, "title": "odd", "out": "o.csv", "plot": "p.svg"} | AROUND,
    ),
    "respond_each": (
        {"structures": WEAK, "motions": STRONG},
        {"structures": [BLOCK, OTHER], "motions": PULSE, "models": "linear2", "scales": [0.5], "opening": 0.0},
    ),
    "respond_around": (
        {"structure": BLOCK, "one": RECORD, "other": RECORD, "models": "nonlinear"},
        {"structure": OTHER, "one": RECORD.scaled(2), "other": RECORD.scaled(2), "models": "linear2", "scale": 2.0,
         "release": 0.3, "rtol": 2.0},
    ),
    "animate": (
        {"structure": WEAK, "motion": STRONG, "file": "a.html", "neighbours": 2},
        {"structure": BLOCK, "motion": PULSE, "file": "b.html", "model": "linear2", "polarity": -1, "speed": 3.0,
         "fps": 0.1, "opening": 1.0} | AROUND,
    ),
    "pulse": (
        {"structure": WEAK, "ag": 0.9, "period": 0.5},
        {"structure": BLOCK, "ag": 0.4, "period": 0.7, "shape": "cosine", "polarity": "both", "a": 4.0, "omega": 6.0,
         "eta": 0.8, "opening": 1.0},
    ),
    "spectrum": (
        {"structures": WEAK, "motions": [STRONG, PULSE], "count": 3, "sizes": (3.0, 6.0)},
        {"structures": BLOCK, "motions": RECORD, "slenderness": [0.2], "sizes": (1.0, 2.0), "count": 4,
         "model": "linear2", "eta": 0.7, "polarity": "-1", "fractiles": (0.3, 0.7), "opening": 0.2},
    ),
    "overturning_map": (
        {"structure": WEAK, "model": "nonlinear", "points": 3, "period": (0.3, 2.0), "ag": (0.2, 1.5)},
        {"structure": BLOCK, "shape": "cosine", "model": "linear1", "eta": 0.7, "period": (0.2, 1.0), "ag": (0.3, 2.0),
         "omega": (1.0, 3.0), "a": (1.0, 3.0), "dimensionless": True, "polarity": "both", "points": 4, "opening": 1.0},
    ),
    "overturning": (
        {"structures": WEAK, "model": "nonlinear", "points": 3, "period": (0.3, 2.0), "ag": (0.2, 1.5)},
        {"structures": BLOCK, "compare": True, "shape": "cosine", "model": "linear1", "eta": 0.7, "period": (0.2, 1.0),
         "ag": (0.3, 2.0), "omega": (1.0, 3.0), "a": (1.0, 3.0), "dimensionless": True, "polarity": "both", "points": 4,
         "opening": 1.0},
    ),
    "overturning_curves": (
        {"structures": [WEAK, BLOCK], "points": 2, "period": (0.4, 1.0)},
        {"structures": [BLOCK, OTHER], "shape": "cosine", "model": "linear1", "eta": 0.7, "period": (0.2, 1.0),
         "top": 0.9, "polarity": "both", "points": 3, "opening": 0.001},
    ),
    "margin": (
        {"structure": WEAK, "motions": STRONG, "neighbours": 2, "polarity": "1"},
        {"structure": BLOCK, "motions": PULSE, "polarity": "-1", "opening": 1.0} | AROUND,
    ),
    "shares": (
        {"structure": FRAME, "motion": RECORD.scaled(3.0), "neighbours": 20},
        {"structure": WEAK, "motion": PULSE, "polarity": "-1", "opening": 0.0} | AROUND,
    ),
    "survey": (
        {"structures": [FRAME, WEAK], "motions": RECORD},
        {"structures": [OTHER], "motions": PULSE, "polarity": "-1", "site": SITE, "opening": 1.0, "top": 1,
         "page": "p.html"},
    ),
    "design": (
        {"structure": LEANING, "vary": "width=0.5m:0.9m", "until": "peak_ratio < 0.2", "motions": RECORD, "points": 3,
         "neighbours": 4, "polarity": "-1"},
        {"structure": BLOCK, "vary": "height=2m:3m", "until": "overturned < 0.4", "motions": PULSE, "polarity": "1",
         "site": SITE, "points": 4, "opening": 1.0} | AROUND,
    ),
    "equivalent": (
        {"structures": [BLOCK, WEAK], "ag": 0.6, "period": 0.5},
        {"structures": [BLOCK, OTHER], "pulse": "sine:0.4g:0.7s", "ag": 0.5, "period": 0.7, "shape": "cosine",
         "polarity": -1, "kappa": 1, "eta": 0.7, "opening": 0.0},
    ),
    "response_spectrum": (
        {"motion": RECORD},
        {"motion": PULSE, "periods": [0.5, 1.0], "damping": 0.1, "scale": 2.0},
    ),
}  # fmt: skip
"""A question of each verb, and an odd value of each of its arguments."""
OF_A_KNOWN_MOTION = {"structure": OTHER, "motion": "sine:0.3g:0.2s"}, {"contact": True, "tail": 0.05, "rtol": 1e-5}
"""Arguments of `respond` that change nothing where friction is given, or where the outcome is unknown."""
WITHOUT_EFFECT = {"watch", "threads", "jobs", "processes"}
"""Arguments that change no answer: the watcher, and how many processors work on it."""
OTHER_TESTS = "record", "select", "score", "calibrate", "report", "verify", "fragility", "results", "selfcheck"
"""Verbs whose questions take longer; their arguments have tests of their own."""

IDLE = [
    ("design", {"structure": BLOCK, "vary": "width=0.5m:0.9m", "until": "lambda >= 0.2", "points": 3},
     {"polarity": "-1", "opening": 0.1} | AROUND),
    ("survey", {"structures": [BLOCK, OTHER]}, {"polarity": "-1", "opening": 0.1}),
    ("pulse", {"a": 4.0, "omega": 6.0}, {"opening": 0.1}),
    ("overturning", {"points": 3}, {"opening": 0.1}),
    ("overturning_map", {"points": 3}, {"opening": 0.1}),
    ("overturning_curves", {"structures": [BLOCK, OTHER], "model": "linear2", "points": 2}, {"opening": 0.1}),
    ("spectrum", {"structures": BLOCK, "motions": PULSE, "model": "linear2", "count": 2}, {"opening": 0.1}),
    ("animate", {"structure": BLOCK, "motion": PULSE, "file": "a.html", "neighbours": 0},
     {name: value for name, value in AROUND.items() if name != "neighbours"} | {"fps": 30.0}),
    ("respond", {"structure": BLOCK, "release": 0.3, "models": "nonlinear"},
     {"polarity": "-1", "with_pulse": "sine", "vertical_dt": 0.1, "vertical_channel": "2", "vertical": RECORD}
     | AROUND),
    ("respond", {"structure": BLOCK, "motion": PULSE, "models": "linear2"}, {"opening": 0.1}),
    ("equivalent", {"structures": [BLOCK, OTHER], "pulse": PULSE}, {"ag": 0.4, "period": 0.4, "shape": "cosine"}),
]  # fmt: skip
"""A question, and arguments that have no effect on it."""


class Listening(Watcher):
    def __init__(self):
        self.heard = []

    def note(self, text):
        self.heard.append(text)

    warn = note


def answered(verb, arguments):
    """Everything that a verb tells, or the error that it raises."""
    watch = Listening()
    for file in Path().iterdir():
        file.unlink()
    more = {"watch": watch} if "watch" in inspect.signature(verb).parameters else {}
    try:
        answer = verb(**arguments, **more)
    except rk.RockingError as error:
        return error
    columns = {name: list(map(str, values)) for name, values in answer.columns().items()}
    drawn = (*getattr(answer.figure, "args", ()), *getattr(answer.figure, "keywords", {}).values())
    how = [each for each in drawn if isinstance(each, int | float | str)]
    files = sorted((each.name, each.stat().st_size) for each in Path().iterdir())
    return json.dumps(answer.to_dict()), str(answer.view.parts), columns, how, files, watch.heard


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.every(3)
@pytest.mark.parametrize("name", CALLS)
def test_every_argument_has_an_effect_or_is_refused(name):
    verb, (call, odd) = getattr(rk, name), CALLS[name]
    known = {each for each in inspect.signature(verb).parameters if each != "options"} - WITHOUT_EFFECT
    assert known <= odd.keys() | ({"contact", "tail", "rtol"} if name == "respond" else set())
    assert not list(without_effect(verb, call, odd))


def without_effect(verb, call, odd):
    before = answered(verb, call)
    assert not isinstance(before, Exception), before
    for argument, value in odd.items():
        after = answered(verb, call | {argument: value})
        if (isinstance(after, Exception) and not re.search(rf"\b{argument}\b", str(after))) or after == before:
            yield argument, str(after)[:100]


def test_arguments_of_a_motion_that_is_known_to_its_end_have_an_effect():
    assert not list(without_effect(rk.respond, *OF_A_KNOWN_MOTION))


@pytest.mark.parametrize(("name", "call", "idle"), IDLE, ids=lambda value: value if isinstance(value, str) else "")
def test_an_argument_that_means_nothing_is_refused_by_name(name, call, idle):
    verb = getattr(rk, name)
    assert not isinstance(answered(verb, call), Exception)
    silent = []
    for argument, value in idle.items():
        after = answered(verb, call | {argument: value})
        if not isinstance(after, rk.InputError) or f"`{argument}`" not in str(after):
            silent.append((argument, str(after)[:100]))
    assert not silent


@pytest.mark.parametrize("name", [*CALLS, *OTHER_TESTS])
def test_an_unknown_argument_is_refused_with_a_suggestion(name):
    verb = getattr(rk, name)
    parameters = inspect.signature(verb).parameters
    needed = {each.name: None for each in parameters.values() if each.default is each.empty and each.name != "options"}
    last = list(parameters)[-1 if "options" not in parameters else -2]
    with pytest.raises(rk.InputError, match=rf"`{last}h` is not an argument\n  did you mean {last}\?"):
        verb(**needed, **{f"{last}h": 1})
