"""Studies with free blocks: which engine gave each run, what the output says of it, and what is refused."""

import json
import os
import subprocess
import sys
import time

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, SolverError
from rocking_cli.questions.fragility import workers
from rocking_cli.questions.fragility.campaign import prepare
from rocking_cli.questions.fragility.store import COLUMNS, FAILED, OFF_EDGE, UNKNOWN, Store
from rocking_cli.questions.fragility.study import load_study
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import engine_of, scene
from tests.conftest import rows_of
from tests.questions.fragility.test_study_runs import finished
from tests.stores import command, contents, every_run

NEEDS_BLOCKS = pytest.mark.skipif(scene.find_spec("mujoco") is None, reason="free blocks need mujoco")
BLOCK = "mechanism: block\nname: pillar\nwidth: 0.7\nheight: 2.8\nrestitution: 0.9\nfriction: 0.3\n"
STUDY = """\
structures: [block.yaml]
records: [{pulse: "sine:1g:0.8s"}]
method: stripes
levels: {measure: PGA, values: [0.1, 1.5]}
polarity: -1
limit_states: [uplift, 0.5, overturning]
opening: 0
engine: auto
"""
"""Of two runs one has no uplift, and in the other the block slips by more than `opening`."""


class Heard(Watcher):
    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


def write(folder, text=STUDY, block=BLOCK, name="study"):
    (folder / "block.yaml").write_text(block, encoding="utf-8")
    path = folder / f"{name}.yaml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A study by both engines, and what it told."""
    folder, heard = tmp_path_factory.mktemp("engines"), Heard()
    path = write(folder)
    rk.fragility(path, jobs=1, watch=heard)
    return path, path.with_suffix(".runs"), heard.notes


@NEEDS_BLOCKS
def test_free_blocks_give_the_runs_that_one_degree_of_freedom_does_not_tell(whole, tmp_path):
    path, place, notes = whole
    rk.fragility(write(tmp_path, STUDY.replace("engine: auto\n", "")), jobs=1)
    both, exact = every_run(place), every_run(tmp_path / "study.runs")
    assert both.by_blocks.tolist() == [False, True] and not exact.by_blocks.any()
    assert exact.outcome.tolist() == [0, UNKNOWN]
    study = load_study(path)
    motion = study.sources[0].read().scaled(-float(both.scale[1]))
    history, _, _ = engine_of("blocks").follow(Structure(study.structures[0]), motion)
    assert both.outcome[1] == history.fell_to != 0
    assert both.overturning_time[1] == pytest.approx(history.overturning_time, rel=1e-9)
    for name in COLUMNS:
        assert np.array_equal(getattr(both, name)[:1], getattr(exact, name)[:1], equal_nan=True), name
    assert len(notes) == 1 and notes[0].startswith("Free blocks: 1 history of some ") and "1 at a time" in notes[0]


@NEEDS_BLOCKS
def test_the_output_names_the_engine_of_each_run(whole, tmp_path):
    _, place, _ = whole
    told = " ".join(command("results", place).stdout.split())
    data = json.loads(command("results", place, "--json").stdout)
    assert "study: stripes, 1 record, 2 runs (1 with free blocks), seed 0" in told
    sentence = "Engine: free blocks (MuJoCo) for 1 of 2 runs; one degree of freedom for all others."
    assert sentence in told and sentence in " ".join(data["notes"])
    assert (data["engine"], data["by_blocks"], data["outcomes"][0]["by_blocks"]) == ("auto", 1, 1)
    assert data["outcomes"][0]["checked"] and data["versions"]["mujoco"] == scene.engine_version()
    command("results", place, "--out", tmp_path / "runs.csv")
    assert [row["engine"] for row in rows_of(tmp_path / "runs.csv")] == ["exact", "blocks"]
    # With free blocks, lambda of the mechanism is not the exact uplift acceleration.
    assert "exactly" not in data["curves"][0]["why"]


@NEEDS_BLOCKS
def test_free_blocks_that_fail_are_of_unknown_outcome(tmp_path, monkeypatch):
    monkeypatch.setattr("rocking_cli.studies.engines.free.recall", lambda keys: {})
    monkeypatch.setattr("rocking_cli.studies.engines.free.remember", lambda outcomes: None)
    monkeypatch.setattr("rocking_cli.studies.engines.blocks.BlockModel._fault", lambda *state: "a step diverged")
    monkeypatch.setattr("rocking_cli.studies.engines.free.FINER", (1.0,))
    answer = rk.fragility(write(tmp_path), jobs=1)
    assert every_run(tmp_path / "study.runs").outcome.tolist() == [0, UNKNOWN]
    told = command("results", tmp_path / "study.runs").stdout
    assert "1 of 2 runs (50 %) is of unknown outcome, because free blocks failed: a step diverged, or a body" in told
    assert answer.curves["overturning"].is_band


@NEEDS_BLOCKS
def test_runs_that_slide_and_runs_that_fall_off_an_edge_are_told_apart(tmp_path, monkeypatch):
    monkeypatch.setattr("rocking_cli.studies.engines.free.place", lambda: tmp_path / "blocks.sqlite")
    podium = "podium: {polygon: [[-0.3, -1], [9, -1], [9, 0], [-0.3, 0]]}"
    cube = "cube: {polygon: [[0, 0], [1, 0], [1, 1], [0, 1]]}"
    structure = f"mechanism: assembly\nname: cube\ndensity: 2000\ndepth: 1\nfriction: 0.2\nblocks: {{{cube}}}\n"
    text = STUDY.replace("opening: 0\n", "").replace("auto", "blocks").replace("0.8s", "1.5s")
    text = text.replace("[0.1, 1.5]", "[0.1, 0.35, 1.0]").replace("-1", "1").replace("0.5,", "100 mm,")
    path = write(tmp_path, text, f"{structure}ground: {{{podium}}}\n")
    answer = rk.fragility(path, jobs=1)
    rows = every_run(tmp_path / "study.runs")
    assert rows.outcome.tolist() == [0, 0, -OFF_EDGE]
    assert (rows.slip > 0.1).tolist() == [False, True, False]
    counts = {each.limit: each.curve.exceedances for each in answer.result}
    assert np.isinf(answer.runs()["peak_ratio"]).tolist() == [False, False, True]
    assert counts == {"uplift": 1, "100 mm": 2, "overturning": 1}
    shown = command("results", tmp_path / "study.runs", "--json", "--out", tmp_path / "runs.csv")
    assert json.loads(shown.stdout)["outcomes"][0]["off_edge"] == 1
    assert "In 1 of them, a block falls off an edge that the file draws: they count as overturned." in shown.stdout
    told = [(row["outcome"], row["fell_to"]) for row in rows_of(tmp_path / "runs.csv")]
    assert told == [("does not uplift", "0"), ("does not overturn; slides", "0"), ("falls off an edge", "-1")]


def units_of_blocks(tmp_path, text):
    """The work of each chunk of a study, simulated with free blocks."""
    path = write(tmp_path, text)
    prepared = prepare(load_study(path), store := Store.writing(tmp_path / "study.runs"))
    plan, study, motions = prepared.plan, prepared.study, prepared.motions
    numbers = (plan.numbers(*store.ends(k)) for k in store.chunks)
    return [workers.unit_of(each, plan, study, store.facts["hash"], motions, "blocks") for each in numbers]


def test_runs_of_blocks_that_do_not_stand_fail(tmp_path, monkeypatch):
    class Falls:
        def outcomes(self, *_, **__):
            raise SolverError("it does not stand")

    (unit,) = units_of_blocks(tmp_path, STUDY.replace("engine: auto\n", ""))
    monkeypatch.setattr(workers, "engine_of", lambda *_: Falls())
    rows = workers.carry_out(unit)
    assert (rows.outcome.tolist(), rows.by_blocks.tolist(), rows.failed) == ([FAILED] * 2, [True] * 2, 2)


@pytest.mark.parametrize(("engine", "most"), [("blocks", 2), ("exact", 64)])
def test_chunks_have_few_runs_if_free_blocks_may_be_simulated(tmp_path, engine, most):
    text = STUDY.replace("engine: auto", f"engine: {engine}").replace("opening: 0\n", "")
    text = text.replace("values: [0.1, 1.5]", "least: 0.1, most: 1, count: 200")
    store = Store.writing(tmp_path / "study.runs")
    assert prepare(load_study(write(tmp_path, text)), store).store.size == most


def test_structures_are_simulated_with_free_blocks_one_by_one(tmp_path, monkeypatch):
    text = STUDY.replace("[block.yaml]", "[{file: block.yaml, vary: {height: {uniform: {low: 2.6, high: 3}}}}]")
    text = text.replace("[0.1, 1.5]", "[0.1]").replace("engine: auto", "samples: 3")
    units, seen = units_of_blocks(tmp_path, text), []

    class Counts:
        def outcomes(self, models, motions, runs, **options):
            seen.append((len(models), len(runs)))
            raise SolverError("enough")

    monkeypatch.setattr(workers, "engine_of", lambda *_: Counts())
    assert np.concatenate([workers.carry_out(each).run for each in units]).tolist() == [0, 1, 2]
    assert seen == [(1, 1)] * 3


@pytest.mark.parametrize(
    ("engine", "field", "said"),
    [
        ("auto", "model: linear2", ":9:8: model: linear2 cannot be combined with `engine: auto`"),
        ("blocks", "restitution: [0.9]", ":9:14: restitution has no effect with `engine: blocks`"),
        ("auto", "", ":6:15: limit_states: sliding cannot be combined with `engine: auto`"),
        ("blocks", "samples: 2", ":1:53: structures[1].vary.restitution has no effect with `engine: blocks`"),
    ],
)
def test_fields_without_meaning_are_refused_at_their_place(engine, field, said, tmp_path):
    text = STUDY.replace("opening: 0\n", "name: pillars\n").replace("engine: auto", f"engine: {engine}\n{field}")
    if "sliding" in said:
        text = text.replace("[uplift,", "[sliding,")
    if "vary" in said:
        varied = "{file: block.yaml, vary: {restitution: {values: [0.8, 0.9]}}}"
        text = text.replace("[block.yaml]", f"[{varied}]")
    with pytest.raises(InputError) as refused:
        load_study(write(tmp_path, text))
    assert f"study.yaml{said}" in str(refused.value).replace(str(tmp_path) + os.sep, "")


def test_a_structure_that_free_blocks_cannot_have_is_refused_by_name(tmp_path):
    with pytest.raises(InputError, match=r"block\.yaml: crushing: free blocks cannot have pivots that crush"):
        load_study(write(tmp_path, block=BLOCK + "density: 2000\ndepth: 1\ncrushing: {strength: 2 MPa}\n"))


def test_without_mujoco_one_sentence_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr(scene, "find_spec", lambda name: None)
    said = command("fragility", write(tmp_path), "--check", code=2).stderr
    assert "study.yaml:8:9: engine: free blocks are simulated by MuJoCo, which is not installed" in said
    assert "pip install 'rocking-cli[blocks]'" in said


@pytest.mark.rest
@NEEDS_BLOCKS
def test_a_study_that_is_killed_ends_with_the_same_bits_in_more_processes(tmp_path):
    text = STUDY.replace("[0.1, 1.5]", "[0.3, 0.5, 0.7, 0.9, 1.2, 1.5]").replace("opening: 0\n", "")
    path = write(tmp_path, text.replace("auto", "blocks"))
    whole, place = tmp_path / "whole.runs", tmp_path / "study.runs"
    rk.fragility(path, store=whole, jobs=1)
    given = [sys.executable, "-m", "rocking_cli", "fragility", str(path), "--jobs", "2"]
    alone = {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache")}
    process = subprocess.Popen(given, env=alone, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while not finished(place):
            assert process.poll() is None
            time.sleep(0.05)
    finally:
        process.kill()
        process.wait()
    assert 0 < finished(place) < 6
    again = subprocess.run(given, env=alone, capture_output=True, text=True, encoding="utf-8", check=True)
    assert "of 6 runs are in the store already" in again.stderr and "2 at a time" in again.stderr
    assert contents(place) == contents(whole)
