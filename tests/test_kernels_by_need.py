"""Which kernel simulates a structure: the first that serves all of its elements, wherever histories are needed."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from threading import Lock

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Spot
from rocking_cli.core.hung.elements import Spring
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.dispatch import ELASTIC, KERNELS, kernel_for, register
from rocking_cli.dynamics.history import follow
from rocking_cli.studies.neighbours import Neighbourhood
from tests.following import build_model
from tests.test_batch import same
from tests.test_cli import run, some

BLOCK = "mechanism: block\nname: {}\nwidth: {}\nheight: 2.8\ndensity: 1800\ndepth: 1\n"
TIES = "ties:\n  - {name: bar, from: {ground: [0.4, 2.0]}, to: {at: [0.1, 2.0]}, stiffness: 2.0e+3}\n"
STUDY = """\
name: two blocks
structures: [tied.yaml, bare.yaml]
records: [{pulse: sine:1g:0.4s}, {pulse: sine:1g:0.5s}]
method: stripes
levels: {measure: PGA, least: 0.5, most: 0.9, count: 2}
limit_states: [0.5, overturning]
"""
FILES = {
    "tied.yaml": BLOCK.format("tied", 0.8) + TIES,
    "bare.yaml": BLOCK.format("bare", 0.7),
    "site.yaml": "FC: 1.2\nag: 0.9\nF0: 2.5\nTC: 0.5\nS: 1.2\n",
    "table.csv": "file\ntied.yaml\nbare.yaml\n",
    "alone.csv": "file\ntied.yaml\n",
    "study.yaml": STUDY,
    "alone.yaml": STUDY.replace(", bare.yaml", ""),
}
PULSE = "--pulse", "sine:0.6g:0.6s"
PLANE = "--ag", "0.3g:2g", "--period", "0.4:0.8", "--points", 3
WHY = (
    "bar of tied: its force depends on its past deformation (memory), which no time-history kernel can simulate in "
    "this structure: use an elastic element instead"
)
# What is asked of the tied block alone, by its nonlinear model alone.
ASKED = {
    "respond": ["tied.yaml", *PULSE, "--model", "nonlinear", "--neighbours", 3, "--out", "history.csv"],
    "margin": ["tied.yaml", *PULSE, "--neighbours", 2],
    "verify": ["tied.yaml", "--site", "site.yaml", *PULSE, "--sheet", "sheet.html"],
    "survey": ["alone.csv", *PULSE, "--out", "survey.csv"],
    "animate": ["tied.yaml", *PULSE, "--model", "nonlinear", "--neighbours", 2, "--out", "film.html"],
    "overturning": ["tied.yaml", "--model", "nonlinear", *PLANE, "--out", "map.csv"],
    "spectrum": ["tied.yaml", *PULSE, "--model", "nonlinear", "--sizes", "3.2:3.6:2", "--out", "spectrum.csv"],
    "fragility": ["alone.yaml", "--jobs", 2],
}
# And what is asked of others too, or of linear models.
MIXED = {
    "pulse": ["tied.yaml", "--ag", "0.6g", "--period", 0.6],
    "equivalent": ["tied.yaml", "bare.yaml", "--ag", "2g", "--period", 0.4],
}


@pytest.fixture(autouse=True)
def _files(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)


def let_ties_remember(monkeypatch):
    """Have ties say that they remember, and let them be asked all the same what such ties usually refuse."""
    monkeypatch.setattr(Spring, "has_memory", True)
    monkeypatch.setattr(Spring, "refuses", lambda self, question: None)


@pytest.fixture
def memory(monkeypatch):
    """Ties whose forces depend on what they went through before, or so they say."""
    let_ties_remember(monkeypatch)


@pytest.fixture
def ran(monkeypatch):
    """How many histories each kernel has run: the elastic one, and a second one that serves ties with memory."""
    count, lock = {"elastic": 0, "second": 0}, Lock()

    def counted(name):
        def lay_out(models, motions):
            assert {model.kernel for model in models} == {name}
            return ELASTIC.lay_out(models, motions)

        def run(deck, runs, marks, first=0, stop=None, **how):
            with lock:
                count[name] += (len(runs) if stop is None else stop) - first
            ELASTIC.run(deck, runs, marks, first, stop, **how)

        return replace(ELASTIC, name=name, lay_out=lay_out, run=run)

    monkeypatch.setitem(KERNELS, "elastic", counted("elastic"))
    register(replace(counted("second"), meets=frozenset({"has_memory"})))
    yield count
    del KERNELS["second"]


def made(name):
    return rk.load_structure(name)


def written():
    """What the folder holds, and files of text say."""
    return {
        each.name: each.read_text() if each.suffix in (".csv", ".html") else "" for each in sorted(Path().iterdir())
    }


@pytest.mark.every(3)
@pytest.mark.parametrize("command", ASKED)
def test_a_command_follows_a_structure_by_the_kernel_that_serves_it(command, monkeypatch, ran):
    words = [command, *ASKED[command]]
    expected = run(*words, "--json").stdout, written()
    assert ran["elastic"] > 0 and ran["second"] == 0  # without such an element nothing touches it
    for name in set(written()) - set(FILES):
        Path(name).unlink()
    count = ran["elastic"]
    let_ties_remember(monkeypatch)
    assert (run(*words, "--json").stdout, written()) == expected
    assert ran == {"elastic": count, "second": count}


@pytest.mark.parametrize("command", [*ASKED, *MIXED])
def test_a_command_names_the_element_that_no_kernel_serves(command, memory):
    before = written()
    said = run(command, *(ASKED | MIXED)[command], code=2).stderr
    (line,) = [line for line in said.splitlines() if "error" in line]
    assert line.startswith("error: ") and line.endswith(f": {WHY}") and "bar" not in said.replace(line, "")
    assert written() == before


def test_of_several_structures_those_are_left_out_that_no_kernel_serves(memory):
    for words in (["survey", "table.csv", *PULSE], ["fragility", "study.yaml", "--jobs", 2]):
        found = some(*words)
        assert WHY in found.stderr and "bare" in found.stdout and "tied" not in found.stdout


def test_design_says_why_no_value_could_be_tried(memory):
    words = "--neighbours", 2, "--points", 2, "--vary", "width=0.7:0.8", "--until", "overturned<1"
    assert WHY in " ".join(run("design", "tied.yaml", *PULSE, *words).stdout.split())


def test_a_study_runs_each_structure_by_its_own_kernel(memory, ran):
    run("fragility", "study.yaml", "--jobs", 2)
    assert ran == {"elastic": 4, "second": 4}


class TestPython:
    @pytest.mark.kernels
    def test_it_follows_by_the_kernel_that_serves(self, memory, ran, monkeypatch):
        motion = rk.parse_pulse("sine:0.6g:0.6s").sampled()
        assert rk.respond("tied.yaml", motion, models="nonlinear")["nonlinear"].lifted
        assert ran == {"elastic": 0, "second": 1}
        rk.respond("tied.yaml", motion, models="linear2")
        rk.respond("bare.yaml", motion, models="nonlinear")
        assert ran == {"elastic": 2, "second": 1}
        monkeypatch.setattr("rocking_cli.studies.neighbours.Neighbourhood", lambda: Neighbourhood(2))
        rk.margin("tied.yaml", motion)
        assert ran["elastic"] == 2 and ran["second"] > 1

    @pytest.mark.parametrize("ask", [rk.respond, rk.margin])
    def test_it_names_the_element_that_no_kernel_serves(self, ask, memory):
        with pytest.raises(rk.InputError, match=r"^(tied.yaml: )?bar of tied: its force depends on its past .*\Z"):
            ask("tied.yaml", rk.parse_pulse("sine:0.6g:0.6s").sampled())


class TestBatch:
    def models(self):
        """Of blocks with a tie, without and with; and the linear one of the first."""
        tools = [made("tied.yaml"), made("bare.yaml"), made("tied.yaml").model_copy(update={"width": 1.0})]
        return [*(build_model(tool, "nonlinear") for tool in tools), build_model(tools[0], "linear2")]

    def runs(self):
        drawn = np.random.default_rng(5)
        of = drawn.integers(0, 4, 700)
        return Runs.of(
            of, drawn.integers(0, 2, 700), scale=drawn.uniform(0.5, 3, 700), slender=drawn.uniform(1, 2, 700)
        )

    @pytest.mark.parametrize("threads", [1, 3])
    def test_each_part_is_run_by_its_own_kernel_in_the_order_of_the_runs(self, threads, monkeypatch, ran):
        motions = [rk.parse_pulse(f"sine:0.6g:{period}s").sampled() for period in (0.5, 0.9)]
        runs, release = self.runs(), np.linspace(-0.5, 0.5, 700)
        expected = respond_many(self.models(), motions, runs, release=release)
        assert ran == {"elastic": 700, "second": 0}
        let_ties_remember(monkeypatch)
        models, done = self.models(), []
        assert [model.kernel for model in models] == ["second", "elastic", "second", "elastic"]
        models = pickle.loads(pickle.dumps(models))  # as they travel to other processes
        same(respond_many(models, motions, runs, release=release, threads=threads, progress=done.append), expected)
        own = int(np.isin(runs.model, [0, 2]).sum())
        assert ran == {"elastic": 1400 - own, "second": own} and sum(done) == 700
        alone = follow(models[0], motions[0].scaled(0.7))
        (many,) = respond_many(models, motions, Runs.of(0, 0, scale=0.7)).peak_ratio
        assert alone.peak_ratio == many and ran["second"] == own + 2

    def test_models_without_runs_are_no_trouble(self, memory, ran):
        motion = rk.parse_pulse("sine:0.6g:0.5s").sampled()
        found = respond_many(self.models(), [motion], Runs.of([1, 3], 0))
        assert found.overturned.shape == (2,) and ran == {"elastic": 2, "second": 0}
        assert not len(respond_many(self.models(), [motion], Runs.of([], [])).overturned)


class TestChoice:
    @pytest.fixture
    def both(self):
        """A block with a tie with memory, and one whose force depends on how fast it stretches."""

        class Damper(Spring):
            has_rate = True

        class Yielding(Spring):
            has_memory = True

        class Both(type(made("bare.yaml"))):
            def carries(self):
                spots = Spot(None, 0.4 + 2j), Spot("block", 0.1 + 2j)
                return [Yielding("fuse", spots, 1e3), Damper("dashpot", spots, 1e3)]

        return Both(name="b", width=0.8, height=2.8, density=1800, depth=1)

    def register(self, monkeypatch, *kernels):
        for name, meets in kernels:
            monkeypatch.setitem(KERNELS, name, replace(ELASTIC, name=name, meets=frozenset(meets)))

    def test_one_kernel_has_to_serve_all_elements(self, both, monkeypatch):
        self.register(monkeypatch, ("fuses", ["has_memory"]), ("dampers", ["has_rate"]))
        with pytest.raises(rk.InputError) as error:
            kernel_for(both)
        one, other = str(error.value).splitlines()
        assert one.startswith("fuse of b: its force depends on its past deformation (memory), which no")
        assert other.startswith("dashpot of b: its force depends on its rate of deformation, which no")
        self.register(monkeypatch, ("all", ["has_memory", "has_rate"]))
        assert kernel_for(both).name == "all" and build_model(both, "nonlinear").kernel == "all"

    def test_the_first_that_serves_is_taken(self, memory, monkeypatch):
        self.register(monkeypatch, ("all", ["has_memory", "has_rate"]), ("fuses", ["has_memory"]))
        assert kernel_for(made("tied.yaml")).name == "all" and kernel_for(made("bare.yaml")) is ELASTIC

    def test_a_kernel_builds_the_model_that_it_runs(self, memory, monkeypatch):
        def rebuilt(*args):
            return replace(ELASTIC.model(*args), uplift_error=7.0)

        self.register(monkeypatch, ("own", ["has_memory"]))
        monkeypatch.setitem(KERNELS, "own", replace(KERNELS["own"], model=rebuilt))
        model = build_model(made("tied.yaml"), "nonlinear")
        assert (model.kernel, model.uplift_error) == ("own", 7.0)
        assert build_model(made("tied.yaml"), "linear1").kernel == "elastic"
