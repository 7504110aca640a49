"""Every argument of every verb, and every option of every command, has an effect or is refused by name.

Each is set to an odd value beside a question in which it means something, and the answer must change (its data, words,
columns, plot, notes and files) or an `InputError` must name it. `IDLE` has questions in which it means nothing. An
option must change the arguments with which the command calls its verb, what it prints or what it writes.
"""

from __future__ import annotations

import inspect
import json
import pickle
import re
import shutil
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest
import yaml

import rocking_cli as rk
from rocking_cli.ask.watcher import Watcher
from rocking_cli.processing.reading_options import READING, SCALING
from tests.conftest import EXAMPLES
from tests.meshes import box, obj, ply

BLOCK = rk.Block(width=0.7, height=2.8, name="block", friction=0.6)
OTHER = rk.Block(width=0.5, height=2.0, name="other")
WEAK = rk.Block(width=0.7, height=2.8, name="weak", friction=0.26)  # it slides before it rocks far
PULSE, STRONG = "sine:0.3g:0.5s", "sine:0.9g:0.5s"
FRAME = rk.load_structure(EXAMPLES / "frame.yaml").model_copy(update={"friction": 0.3})
LEANING = WEAK.model_copy(update={"friction": 0.2, "one_sided": "positive", "rebound": 0.5})
PORTAL = rk.load_structure(EXAMPLES / "assembly.yaml")
TIME = 0.01 * np.arange(200)
RECORD = rk.GroundMotion("record", 0.01, 3.0 * np.sin(2 * np.pi * TIME / 0.8) * np.exp(-TIME), unit="m/s2")
SHORT = rk.Block(width=1.0, height=2.0, name="short")
BRIEF = rk.GroundMotion("brief", 0.01, 8.0 * np.sin(np.pi * np.arange(41) / 40), unit="m/s2")
AROUND = {"neighbours": 3, "amplitude_deviation": 0.3, "slenderness_deviation": 0.3, "restitution_deviation": 0.3}
SITE = EXAMPLES / "verify" / "site.yaml"
ACCEL, ACROSS, BLOCK_FILE = EXAMPLES / "accel.csv", EXAMPLES / "accel_transverse.csv", EXAMPLES / "block.yaml"
CODE = np.array([[0.1, 0.3], [0.5, 0.7], [1.0, 0.4], [4.0, 0.1]]).T
CANDIDATES = [rk.GroundMotion(f"r{k}", 0.01, RECORD.acceleration * np.cos(k * TIME), unit="m/s2") for k in range(6)]
TRACED = EXAMPLES / "calibrate" / "block.yaml"
NTC = {**yaml.safe_load(SITE.read_text("utf-8")), "FC": 1.2}
STUDY = {
    "structures": [
        {"file": str(EXAMPLES / "block.yaml"), "vary": {"width": {"normal": {"mean": 0.7, "deviation": 0.2}}}}
    ],
    "records": [{"pulse": "sine:0.9g:1.5s"}, {"pulse": "sine:0.6g:2s"}, {"pulse": STRONG}],
    "samples": 10,
    "polarity": "1",
    "levels": {"measure": "PGA", "least": 0.1, "most": 2, "count": 12},
    "limit_states": ["overturning"],
    "method": "stripes",
}
HOUSE = {
    "levels": [0.0, 3.0], "masonry": {"density": 1800.0}, "rebound": 0.3,
    "walls": [{"name": "long", "length": 5.0, "thickness": 0.5}, {"name": "short", "length": 4.0, "thickness": 0.3}],
    "ties": [{"level": 1, "walls": ["short"], "length": 4.0, "bars": 1, "diameter": 0.012, "steel": "S235"}],
    "roof": {"load": 200.0, "span": 4.0, "walls": ["long", "short"]},
}  # fmt: skip
OBSERVED = {
    "structure": [str(BLOCK_FILE)] * 4,
    "overturned": [0, 1, 1, 0],
    "record": ["sine:0.3g:1.5s", "sine:0.5g:1.5s", "sine:0.4g:2s", "sine:0.9g:1s"],
}

DRAWN = "outline,layer,x,y,bulge\n" + "".join(
    f"{name},{layer},{x},{y},{bulge}\n"
    for name, layer, corners in (
        ("low", "PIETRA", [(0, 0, 0), (1000, 0, 0), (1000, 900, 0), (0, 900, 0)]),
        ("top", "PIETRA", [(0, 903, 0), (1000, 903, 0), (1000, 2000, 0.2), (0, 2000, 0)]),
        ("side", "PIETRA", [(999.5, 0, 0), (1400, 0, 0), (1400, 500, 0), (999.5, 500, 0)]),
        ("hole", "FORI", [(300, 1300, 0), (500, 1300, 0), (500, 1500, 0), (300, 1500, 0)]),
        ("inner", "PIETRA", [(600, 300, 0), (700, 300, 0), (700, 400, 0), (600, 400, 0)]),
    )
    for x, y, bulge in corners
)
"""Two blocks with a joint of 3 mm, one beside them that overlaps, and openings of both kinds [mm]."""

DRAWN_FILE = EXAMPLES / "drawings" / "wall.svg"
PLOT = {"plot": "p.svg"}
TABLE = {"out": "o.csv", "separator": ";", "decimal": ","}

CALLS = {
    "equiv": ({"structures": BLOCK}, {"structures": [BLOCK, OTHER]} | TABLE),
    "collapse": ({"structure": PORTAL}, {"structure": PORTAL.enlarged(2.0), "out": "o.yaml"} | PLOT),
    "draw": ({"structure": BLOCK}, {"structure": OTHER, "at": 0.3, "dxf": "odd.dxf"} | PLOT),
    "import_drawing": (
        {"file": "in.csv", "units": "mm", "depth": 1.0, "density": 2000.0, "merge_gap": "6 mm", "nested": "openings",
         "out": "o.yaml"},
        {"file": "pillar.csv", "units": "km", "scale": "1:99999", "layers": {"nothing": ["FORI"]}, "density": 2500.0,
         "depth": 2.0, "merge_gap": 0.0, "close": "0.2 mm", "nested": None, "kind": "rigid_body", "tolerance": "9 mm",
         "plane": "yz", "out": "odd.yaml", "plot": "p.svg", "origin": "odd"},
    ),
    "error": ({"structure": BLOCK}, {"structure": WEAK, "at": [0.3], "a": [3.0]} | PLOT),
    "import_mesh": (
        {"file": "in.obj", "units": "m", "density": 2000.0, "out": "o.yaml"},
        {"file": "in.ply", "units": "ft", "density": 1800.0, "azimuth": 40.0, "level": 0.01, "settle": True,
         "hull": True, "up": "y", "north": 30.0, "out": "odd.yaml", "plot": "p.svg", "page": "p.html", "origin": "odd"},
    ),
    "respond": (
        {"structure": WEAK, "motions": STRONG, "neighbours": 2, "opening": 1.0},
        {"structure": BLOCK, "motions": PULSE, "model": "nonlinear", "polarity": "both", "vertical": RECORD,
         "vertical_dt": 0.1, "vertical_channel": "2", "with_pulse": "sine", "release": 0.2, "in_space": True,
         "transverse": "sine:0.2g:0.5s", "transverse_channel": "2", "mesh": "in.obj", "mesh_units": "m",
         "opening": 0.0, "restitution": 0.8, "engine": "auto", "impacts": True, "each_block": True, "title": "odd",
         "animate": "b.html", "plot": "p.svg"} | AROUND | TABLE,
    ),
    "respond_each": (
        {"structures": WEAK, "motions": STRONG},
        {"structures": [BLOCK, OTHER], "motions": PULSE, "model": "linear2", "scale": [0.5], "opening": 0.0,
         "polarity": [1, -1], "restitution": [0.8], "histories": True, "target_pga": 0.3} | TABLE,
    ),
    "respond_around": (
        {"structure": BLOCK, "one": RECORD, "other": RECORD, "model": "nonlinear"},
        {"structure": OTHER, "one": RECORD.scaled(2), "other": RECORD.scaled(2), "model": "linear2", "scale": 2.0,
         "release": 0.3, "rtol": 2.0},
    ),
    "animate": (
        {"structures": WEAK, "motions": STRONG, "out": "a.html", "neighbours": 2},
        {"structures": BLOCK, "motions": PULSE, "out": "b.html", "model": "linear2", "polarity": -1, "speed": 3.0,
         "fps": 0.1, "opening": 1.0} | AROUND,
    ),
    "pulse": (
        {"structure": WEAK, "ag": 0.9, "period": 0.5},
        {"structure": BLOCK, "ag": 0.4, "period": 0.7, "shape": "cosine", "polarity": "both", "a": 4.0, "omega": 6.0,
         "restitution": 0.8, "opening": 1.0},
    ),
    "spectrum": (
        {"structures": WEAK, "motions": [STRONG, PULSE], "count": 3, "sizes": (3.0, 6.0)},
        {"structures": BLOCK, "motions": RECORD, "slenderness": [0.2], "sizes": (1.0, 2.0), "count": 4,
         "model": "linear2", "restitution": 0.7, "polarity": "-1", "fractiles": (0.3, 0.7), "opening": 0.2}
        | TABLE | PLOT,
    ),
    "overturning_map": (
        {"structure": WEAK, "model": "nonlinear", "points": 3, "period": (0.3, 2.0), "ag": (0.2, 1.5)},
        {"structure": BLOCK, "shape": "cosine", "model": "linear1", "restitution": 0.7,
         "period": (0.2, 1.0), "ag": (0.3, 2.0), "omega": (1.0, 3.0), "a": (1.0, 3.0), "dimensionless": True,
         "polarity": "both", "points": 4, "opening": 1.0, "engine": "auto"},
    ),
    "overturning": (
        {"structures": WEAK, "model": "nonlinear", "points": 3, "period": (0.3, 2.0), "ag": (0.2, 1.5)},
        {"structures": BLOCK, "compare": True, "shape": "cosine", "model": "linear1", "restitution": 0.7,
         "period": (0.2, 1.0), "ag": (0.3, 2.0), "omega": (1.0, 3.0), "a": (1.0, 3.0), "dimensionless": True,
         "polarity": "both", "points": 4, "opening": 1.0, "engine": "auto", "out": "o.csv", "plot": "p.svg",
         "separator": ";", "decimal": ","},
    ),
    "overturning_curves": (
        {"structures": [WEAK, BLOCK], "points": 2, "period": (0.4, 1.0)},
        {"structures": [BLOCK, OTHER], "shape": "cosine", "model": "linear1", "restitution": 0.7, "period": (0.2, 1.0),
         "top": 0.9, "polarity": "both", "points": 3, "opening": 0.001},
    ),
    "margin": (
        {"structure": WEAK, "motions": STRONG, "neighbours": 2, "polarity": "1"},
        {"structure": BLOCK, "motions": PULSE, "polarity": "-1", "opening": 1.0, "restitution": 0.8,
         "engine": "auto"} | TABLE | PLOT | AROUND,
    ),
    "shares": (
        {"structure": FRAME, "motions": RECORD.scaled(3.0), "neighbours": 20},
        {"structure": WEAK, "motions": PULSE, "polarity": "-1", "opening": 0.0} | AROUND,
    ),
    "survey": (
        {"structures": [FRAME, WEAK], "motions": RECORD.scaled(1.5)},
        {"structures": [OTHER], "motions": PULSE, "polarity": "-1", "site": SITE, "opening": 1.0, "top": 1,
         "remedies": "all", "in_space": True, "transverse": PULSE, "labels": "l.pdf",
         "page": "p.html", "map": "m.png", "sheets": "odd", "sheet_format": "docx", "language": "it", "project": "odd",
         "out": "o.csv", "plot": "p.svg", "separator": ";", "decimal": ",",
         "place": "odd", "client": "odd", "author": "odd", "logo": "in.svg", "origin": "odd"} | AROUND,
    ),
    "design": (
        {"structure": LEANING, "vary": "width=0.5m:0.9m", "until": "peak_ratio < 0.2", "motions": RECORD, "points": 3,
         "neighbours": 4, "polarity": "-1"},
        {"structure": BLOCK, "vary": "height=2m:3m", "until": "overturned < 0.4", "motions": PULSE, "polarity": "1",
         "site": SITE, "points": 4, "opening": 1.0} | AROUND | TABLE | PLOT,
    ),
    "equivalent_pulses": (
        {"structures": [BLOCK, WEAK], "ag": 0.6, "period": 0.5},
        {"structures": [BLOCK, OTHER], "pulse": "sine:0.4g:0.7s", "ag": 0.5, "period": 0.7, "shape": "cosine",
         "polarity": -1, "kappa": 1, "restitution": 0.7, "opening": 0.0} | TABLE | PLOT,
    ),
    "response_spectrum": (
        {"motions": RECORD},
        {"motions": PULSE, "periods": [0.5, 1.0], "damping": 0.1, "scale": 2.0},
    ),
    "record": (
        {"motions": RECORD, "spectrum": True},
        {"motions": PULSE, "polarity": "both", "structure": BLOCK, "fit_pulse": True, "measures": "CAV",
         "spectrum": False, "period": (0.1, 1.0), "damping": 0.1, "out": "o.csv", "plot": "p.svg",
         "baseline": "linear", "highpass": 0.5, "lowpass": 20, "taper": 0.1, "trim": "0.2:1", "resample": 0.02},
    ),
    "select": (
        {"motions": CANDIDATES, "target": CODE, "band": (0.2, 1.0), "count": 2, "within": (0.01, 9.0),
         "one_per": "none"},
        {"motions": CANDIDATES[1:], "target": 0.5 * CODE, "band": (0.3, 2.0), "count": 3, "within": (0.9, 1.1),
         "state": "SLC", "damping": 0.1, "factors": (0.5, 1.0), "one_per": "event", "same_factor": True, "seed": 4,
         "out": "odd"} | PLOT,
    ),
    "calibrate": (
        {"structure": TRACED, "free": EXAMPLES / "calibrate" / "trace.csv"},
        {"structure": BLOCK, "free": "gone.csv", "free_geometry": True, "out": "o.yaml", "plot": "p.svg"},
    ),
    "verify": (
        {"structure": WEAK, "site": SITE, "motions": RECORD.scaled(2.0), "sheet": "s.html", "opening": 1.0},
        {"structure": OTHER, "site": NTC, "strengthened": BLOCK, "control": (0.3, 2.0),
         "motions": PULSE, "sets": {"SLC": PULSE}, "polarity": "both", "state": "SLC", "on_floor": True,
         "opening": 0.0001, "sheet": None,
         "language": "it", "project": "odd", "place": "odd", "client": "odd",
         "author": "odd", "logo": "in.svg", "in_full": False, "plot": "p.svg", "origin": "odd"},
    ),
    "demand": ({"site": SITE}, {"site": NTC | {"soil": "D"}, "damping": 0.1} | TABLE | PLOT),
    "fragility": (
        {**{name: each for name, each in STUDY.items() if name != "records"}, "motions": STUDY["records"]},
        {"store": "b.runs", "check": True, "scheduler": "odd", "restart": True, "share": "1/2", "plot": "p",
         "rank_measures": True, "quantiles": True, "nrml": "n.xml", "motions": RECORD,
         "structures": [STUDY["structures"][0] | {"name": "odd"}], "method": "ida",
         "levels": STUDY["levels"] | {"most": 3}, "polarity": "-1", "restitution": [0.8], "samples": 9,
         "sampling": "random", "seed": 3, "model": "linear2", "engine": "auto", "opening": 0.1,
         "limit_states": [0.5],
         "measures": ["PGV"], "bivariate": [["PGA", "PGV"]], "confidence": 0.8, "floor": "T1=0.4,z=6m,H=9m,n=3",
         "name": "odd", "hazard": {"points": [[0.1, 0.01], [1, 0.0001]]}, "processing": ["lowpass 5"]},
    ),
    "fit_fragility": (
        {"intensity": np.arange(1, 41), "exceeded": np.arange(40) + 9 * np.sin(np.arange(40)) > 20},
        {"intensity": np.arange(2, 42), "exceeded": np.arange(40) > 20, "clusters": np.arange(40) // 4,
         "curve": "logit", "confidence": 0.8, "label": "odd"},
    ),
    "report": (
        {"structure": WEAK, "motions": RECORD, "neighbours": 2},
        {"structure": OTHER, "motions": PULSE, "out": "o.html", "polarity": "1", "verify": SITE, "state": "SLC",
         "on_floor": True, "opening": 1.0, "restitution": 0.8, "language": "it", "project": "odd", "explore": True,
         "place": "odd", "client": "odd", "author": "odd", "logo": "in.svg", "origin": "odd"} | AROUND,
    ),
    "building": (
        {"building": HOUSE, "site": SITE, "motions": RECORD, "sheet": "s.html"},
        {"building": HOUSE | {"name": "odd"}, "site": NTC, "strengthened": HOUSE | {"levels": [0.0, 2.9]}, "worst": 1,
         "sets": {"SLC": PULSE}, "polarity": "both", "state": "SLC", "on_floor": True, "design": 1, "structures": "odd",
         "sheet": None, "appendix": True, "motions": PULSE, "language": "it", "project": "odd", "place": "odd",
         "client": "odd", "author": "odd", "logo": "in.svg", "origin": "odd", "out": "o.csv", "plot": "p.svg",
         "separator": ";", "decimal": ","},
    ),
    "explore": (
        {"structures": WEAK, "motions": STRONG, "neighbours": 2},
        {"structures": BLOCK, "motions": PULSE, "polarity": "-1", "opening": 1.0, "vary": "width=0.5m:0.72m",
         "out": "odd.html"} | AROUND,
    ),
}  # fmt: skip
"""A question of each verb, and an odd value of each of its arguments."""
LONG = "building", "report", "verify", "calibrate", "survey", "fragility", "overturning_map"
"""Verbs whose questions take longer: they are asked with the rest."""
OF_A_KNOWN_MOTION = {"structure": OTHER, "motions": "sine:0.3g:0.2s"}, {"contact": True, "tail": 0.05, "rtol": 1e-5}
"""Arguments of `respond` that change nothing where friction is given, or where the outcome is unknown."""
WITHOUT_EFFECT = {"watch", "jobs", "in_processes"}
"""Arguments that change no answer: the watcher, and how many processors work on it."""

IDLE = [
    ("design", {"structure": BLOCK, "vary": "width=0.5m:0.9m", "until": "lambda >= 0.2", "points": 3},
     {"polarity": "-1", "opening": 0.1} | AROUND),
    ("survey", {"structures": [BLOCK, OTHER]},
     {"polarity": "-1", "opening": 0.1, "remedies": "all", "in_space": True, "transverse": PULSE, "map": "m.png",
      "sheets": "odd", "sheet_format": "docx",
      "project": "odd", "place": "odd", "client": "odd", "author": "odd", "logo": "in.svg", "origin": "odd"}),
    ("verify", {"structure": BLOCK, "site": SITE},
     {"polarity": "-1", "opening": 0.1, "state": "SLC", "on_floor": True, "project": "odd", "place": "odd",
      "client": "odd", "author": "odd", "logo": "in.svg", "origin": "odd"}),
    ("building", {"building": HOUSE, "site": SITE},
     {"polarity": "-1", "state": "SLC", "on_floor": True, "worst": 1, "appendix": True, "project": "odd",
      "place": "odd", "client": "odd", "author": "odd", "logo": "in.svg", "origin": "odd"}),
    ("report", {"structure": BLOCK},
     {"explore": True, "polarity": "-1", "opening": 0.1, "state": "SLC", "on_floor": True} | AROUND),
    ("pulse", {"a": 4.0, "omega": 6.0},
     {"structure": BLOCK, "ag": 0.5, "period": 0.7, "polarity": "-1", "opening": 0.1}),
    ("overturning", {"points": 3}, {"opening": 0.1}),
    ("overturning_map", {"points": 3}, {"opening": 0.1}),
    ("overturning_curves", {"structures": [BLOCK, OTHER], "model": "linear2", "points": 2}, {"opening": 0.1}),
    ("spectrum", {"structures": BLOCK, "motions": PULSE, "model": "linear2", "count": 2}, {"opening": 0.1}),
    ("animate", {"structures": BLOCK, "motions": PULSE, "out": "a.html", "neighbours": 0},
     {name: value for name, value in AROUND.items() if name != "neighbours"} | {"fps": 30.0}),
    ("respond", {"structure": BLOCK, "release": 0.3, "model": "nonlinear"},
     {"polarity": "-1", "with_pulse": "sine", "vertical_dt": 0.1, "vertical_channel": "2", "vertical": RECORD}
     | AROUND),
    ("respond", {"structure": BLOCK, "motions": PULSE, "model": "linear2"}, {"opening": 0.1}),
    ("fragility", {"structures": STUDY, "store": "c.runs", "check": True},
     {"jobs": 2, "scheduler": "tcp://odd:1", "restart": True, "share": "1/2", "rank_measures": True, "quantiles": True,
      "nrml": "n.xml", "plot": "p", "confidence": 0.8}),
    ("equivalent_pulses", {"structures": [BLOCK, OTHER], "pulse": PULSE},
     {"ag": 0.4, "period": 0.4, "shape": "cosine"}),
]  # fmt: skip
"""A question, and arguments that have no effect on it."""


class Listening(Watcher):
    def __init__(self):
        self.heard = []

    def note(self, text):
        self.heard.append(text)

    warn = note


def sent(answer):
    return pickle.loads(pickle.dumps(deepcopy(answer)))


def answered(verb, arguments, copied=lambda answer: answer):
    """Everything that a verb tells, or the error that it raises."""
    watch = Listening()
    for file in Path().iterdir():
        if file.stem != "in":
            shutil.rmtree(file) if file.is_dir() else file.unlink()
    more = {"watch": watch} if "watch" in inspect.signature(verb).parameters else {}
    try:
        answer = copied(verb(**arguments, **more))
    except rk.RockingError as error:
        return error
    columns = {name: list(map(str, values)) for name, values in answer.columns().items()}
    drawn = (*getattr(answer.figure, "args", ()), *getattr(answer.figure, "keywords", {}).values())
    how = [each for each in drawn if isinstance(each, int | float | str)]
    files = sorted((each.name, each.stat().st_size) for each in Path().iterdir())
    return json.dumps(answer.to_dict()), str(answer.view.parts), columns, how, files, watch.heard


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # for certain, as files are removed there
    monkeypatch.setattr("rocking_cli.questions.report.study.MAP_POINTS", 4)
    monkeypatch.setattr("rocking_cli.questions.overturning.study.SCAN_AMPLITUDES", 25)
    for name in ("FACTORS", "FEW_FACTORS"):
        monkeypatch.setattr(f"rocking_cli.questions.margin.study.{name}", np.array([0.3, 0.8, 1.0, 2.0]))
    Path("in.yaml").write_text("mechanism: block\nwidth: 0.7\nheight: 2.8\nfriction: 0.26\n")
    rows = zip(TIME, RECORD.acceleration, strict=True)
    Path("in.txt").write_text("time,a\n" + "".join(f"{t},{a}\n" for t, a in rows))
    Path("in.csv").write_text(DRAWN)
    Path("pillar.csv").write_text("0,0\n600,0\n600,2400\n0,2400\n")
    Path("in.obj").write_bytes(obj(box((0.0, 0.0, 0.0), (0.6, 0.8, 2.4))))
    Path("in.ply").write_bytes(ply(box((0.0, 0.0, 0.0), (0.5, 0.9, 2.0))))
    Path("in.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>')


@pytest.mark.every(4)
@pytest.mark.parametrize(
    "name",
    [pytest.param(each, marks=[pytest.mark.rest] * (each in LONG)) for each in CALLS],
)
def test_every_argument_has_an_effect_or_is_refused(name):
    verb, (call, odd) = getattr(rk, name), CALLS[name]
    known = {each for each in inspect.signature(verb).parameters if each != "options"} - WITHOUT_EFFECT
    known -= {*READING, *SCALING}
    assert known <= odd.keys() | ({"contact", "tail", "rtol"} if name == "respond" else set())
    assert not list(without_effect(verb, call, odd))


def without_effect(verb, call, odd):
    first, before = answered(verb, call), answered(verb, call, sent)  # so every answer can be sent to another process
    assert not isinstance(before, Exception), before
    assert first == before or "store" in call  # the second finds that of the first
    for argument, value in odd.items():
        after = answered(verb, call | {argument: value})
        named = rf"\b{argument}\b|^{re.escape(str(value))}"  # a file by its own name
        if (isinstance(after, Exception) and not re.search(named, str(after))) or after == before:
            yield argument, str(after)[:100]


def test_arguments_of_a_motion_that_is_known_to_its_end_have_an_effect():
    assert not list(without_effect(rk.respond, *OF_A_KNOWN_MOTION))


def test_arguments_of_a_store_have_an_effect():
    for store, study in (("in.runs", STUDY), ("in.store", STUDY | {"seed": 3})):
        rk.fragility(study, store=store, jobs=1)
    odd = {
        "store": "in.store",
        "quantiles": True,
        "rank_measures": True,
        "curves": "c.csv",
        "nrml": "n.xml",
        "pelicun": "q",
        "out": "o.csv",
        "plot": "p",
    }
    assert not list(without_effect(rk.results, {"store": "in.runs"}, odd))


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
