"""The contract of engines: another one agrees with the exact one, stands in for it, and fails in plain words."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import replace
from importlib.metadata import EntryPoint, entry_points
from math import atan, isnan, sin
from typing import ClassVar

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.engines import Engine, engine, engine_of, respond
from rocking_cli.engines.exact import Exact
from rocking_cli.engines.installed import Engines, engines
from rocking_cli.errors import InputError, MechanismError, PluginError
from rocking_cli.structure import Structure
from tests.conftest import EXAMPLES, PROJECT
from tests.test_cli import run, run_json

ACCEL = EXAMPLES / "accel.csv"
WIDTH, HEIGHT = 0.7, 2.8
BLOCK = rk.Block(width=WIDTH, height=HEIGHT)
MOTIONS = {
    "rocks": rk.read_record(ACCEL).scaled(-0.6),
    "rocks far": rk.parse_pulse("ricker:0.5g:0.6s").sampled(200),
    "overturns": rk.parse_pulse("sine:0.9g:1.2s").sampled(200),
    "does not uplift": rk.parse_pulse("sine:0.1g:1.2s").sampled(200),
}
BAR = {"name": "bar", "from": {"ground": [2, 0]}, "to": {"body": "block", "at": [0, 2]}, "stiffness": 1e3}
ALL = {"linear models", "releases", "vertical components", "joints"}


class Delegating(Engine):
    """Gives the history of the exact engine; each subclass spoils something."""

    name = "delegating"

    def refuses(self, structure):
        return None

    def history(self, structure, motion, *, model, release, tail, rtol):
        return self.spoilt(Exact().history(structure, motion, model=model, release=release, tail=tail, rtol=rtol))

    def spoilt(self, history):
        return replace(history, opening=float("nan"), check=None)


class Divides(Delegating):
    def spoilt(self, history):
        return 1 / 0


class Nothing(Delegating):
    def spoilt(self, history):
        return None


class Lists(Delegating):
    def spoilt(self, history):
        return replace(super().spoilt(history), time=history.time.tolist())


class Short(Delegating):
    def spoilt(self, history):
        return replace(super().spoilt(history), phi=history.phi[1:])


class Flat(Delegating):
    def spoilt(self, history):
        return replace(super().spoilt(history), impacts=history.impacts.ravel())


class Other(Delegating):
    def spoilt(self, history):
        return replace(super().spoilt(history), model="linear2")


class Checks(Delegating):
    def spoilt(self, history):
        return history


NO_MODEL = "model must be one of nonlinear, linear1, linear2, got 'linear3'"


class Spoils(Delegating):
    """Gives a history with some fields replaced."""

    fields: ClassVar = {}

    def spoilt(self, history):
        return replace(super().spoilt(history), **self.fields)


class Asks(Delegating):
    def refuses(self, structure):
        return {}["lost"]


class Lacks(Engine):
    name = "lacks"

    def refuses(self, structure):
        return None


class Misnamed(Delegating):
    name = "another"


class Claims(Delegating):
    name, knows = "claims", frozenset({"everything"})


class NotMade(Delegating):
    name = "not_made"

    def __init__(self):
        raise KeyError("lost")


class NoClass:
    pass


@pytest.fixture
def install(monkeypatch):
    """Install engines beside the exact one: an object of this file under each name."""
    real = entry_points

    def beside(**given):
        points = []
        for name, value in given.items():
            if isinstance(value, type):
                monkeypatch.setattr(value, "name", name)
                value = f"{__name__}:{value.__name__}"
            points.append(EntryPoint(name, value, Engines.group))
        monkeypatch.setattr(
            "rocking_cli.plugins.registry.entry_points",
            lambda group: [*real(group=group), *(points if group == Engines.group else ())],
        )
        engines.cache_clear()

    yield beside
    engines.cache_clear()


@pytest.fixture
def by_solve_ivp(install, monkeypatch):
    """The engine of the guide, registered as its package registers it."""
    folder = EXAMPLES / "engine"
    monkeypatch.syspath_prepend(folder)
    project = tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    install(**project["entry-points"][Engines.group])
    return engine("by_solve_ivp")


@pytest.fixture
def exact_refuses(monkeypatch):
    monkeypatch.setattr(Exact, "refuses", lambda self, structure: "it is made to refuse")


class TestAgreement:
    def test_both_use_the_restitution_of_housner(self):
        assert Structure(BLOCK).etas == pytest.approx((1 - 1.5 * sin(atan(WIDTH / HEIGHT)) ** 2,) * 2, rel=1e-14)

    @pytest.mark.every(3)
    @pytest.mark.parametrize("name", MOTIONS)
    def test_an_engine_that_shares_no_code_agrees_with_the_exact_one(self, by_solve_ivp, name):
        """Measured: 2e-8 of the rotations, 1e-8 s of the impacts."""
        motion, structure = MOTIONS[name], Structure(BLOCK)
        own, other = (each.follow(structure, motion, rtol=1e-11, tail=1.0) for each in (engine("exact"), by_solve_ivp))
        assert own.words == other.words == name.removesuffix(" far")
        assert (own.fell_to, own.impact_count, own.p) == (other.fell_to, other.impact_count, pytest.approx(other.p))
        for key in ("peak_positive", "peak_negative", "peak_ratio", "uplift_time", "overturning_time"):
            assert getattr(other, key) == pytest.approx(getattr(own, key), abs=1e-7, nan_ok=True), key
        np.testing.assert_allclose(other.impacts[:3], own.impacts[:3], rtol=0, atol=1e-7)
        both = min(own.time.size, other.time.size)
        np.testing.assert_allclose(other.time[:both], own.time[:both], rtol=1e-12)
        seen = np.isfinite(own.phi[:both]) & np.isfinite(other.phi[:both])
        assert seen.sum() > 0.7 * both
        np.testing.assert_allclose(other.phi[:both][seen], own.phi[:both][seen], rtol=0, atol=1e-7)

    def test_its_joints_are_not_checked_and_those_of_the_exact_one_are(self, by_solve_ivp):
        motion = MOTIONS["does not uplift"]
        for each in (by_solve_ivp, engine("exact")):
            assert ("joints" in each.knows) != isnan(each.follow(Structure(BLOCK), motion).opening)

    def test_the_comparison_of_the_guide_holds(self, by_solve_ivp):
        page = (PROJECT / "docs" / "plugins.md").read_text(encoding="utf-8")
        section = page.partition("## Write an engine\n")[2].partition("\n## ")[0].partition("Compare it with")[2]
        code = "\n".join(re.findall(r"^    (.*)", section.partition("`engine(name)")[0], re.M))
        assert code.count("assert") == 3
        exec(compile(code, "guide", "exec"), {})

    @pytest.mark.parametrize(
        ("structure", "said"),
        [
            (rk.SymmetricFrame(column_width=1.0, column_height=4.0, mass_ratio=1.0), "it has 2 bodies"),
            (rk.Cone(base_radius=1.0, height=4.0), "its type is cone, not block"),
            (rk.Block(width=WIDTH, height=HEIGHT, mass=1e3, ties=[BAR]), "loads or ties are attached to it"),
            (rk.Block(width=WIDTH, height=HEIGHT, one_sided="positive", rebound=0.5), "or it has side walls"),
        ],
    )
    def test_it_refuses_in_its_own_words_what_is_not_a_bare_block(self, by_solve_ivp, structure, said):
        with pytest.raises(InputError, match=f"the engine by_solve_ivp cannot simulate .*: .*{said}"):
            by_solve_ivp.follow(Structure(structure), MOTIONS["rocks"])


class TestWhichEngine:
    def test_the_exact_one_comes_first_and_no_other_is_looked_for(self, monkeypatch):
        monkeypatch.setattr(Engines, "__init__", lambda self: pytest.fail("engines were looked for"))
        engines.cache_clear()
        assert engine_of(Structure(BLOCK)) is engine("exact")
        assert rk.respond(BLOCK, "sine:0.1g:0.8s")["nonlinear"].words == "does not uplift"

    @pytest.mark.rest
    def test_one_that_is_installed_stands_in_where_the_exact_one_refuses(self, by_solve_ivp, exact_refuses, tmp_path):
        answer = rk.respond(BLOCK, MOTIONS["rocks"])
        assert list(answer) == ["nonlinear"] and isnan(answer["nonlinear"].opening)
        (tmp_path / "b.yaml").write_text(f"mechanism: block\nwidth: {WIDTH}\nheight: {HEIGHT}\n", encoding="utf-8")
        said = run("respond", "b.yaml", "--record", ACCEL, "--scale", "-0.6", "--neighbours", 0, "--json")
        found = json.loads(said.stdout)["responses"]
        assert found["nonlinear"]["peak_ratio"] == pytest.approx(answer["nonlinear"].peak_ratio, rel=1e-12)
        assert found["nonlinear"]["opening"] is None and list(found) == ["nonlinear"]
        assert "the engine by_solve_ivp has no linear models" in said.stderr

    def test_a_given_one_can_be_asked_where_the_exact_one_would_answer(self, by_solve_ivp):
        assert engine_of(Structure(BLOCK)).name == "exact" and by_solve_ivp.name == "by_solve_ivp"
        with pytest.raises(InputError, match=r"unknown engine: by_solve \(did you mean by_solve_ivp\?\)"):
            engine("by_solve")
        with pytest.raises(InputError, match=r"unknown engine: nope \(known: by_solve_ivp, exact\)"):
            engine("nope")

    def test_if_all_refuse_their_reasons_are_given(self, by_solve_ivp, exact_refuses):
        cone = rk.Cone(base_radius=1.0, height=4.0)
        said = "no engine can simulate cone (exact: it is made to refuse; by_solve_ivp: its type is cone, not block)"
        with pytest.raises(InputError, match=f"^{re.escape(said)}$"):
            rk.respond(cone, "sine:0.3g:0.8s")

    @pytest.mark.parametrize(
        ("asked", "said"),
        [
            ({"model": "linear1"}, "linear models"),
            ({"release": 0.5}, "releases"),
            ({"motion": replace(MOTIONS["rocks"], vertical=MOTIONS["rocks"])}, "vertical components"),
        ],
    )
    def test_what_an_engine_does_not_know_is_refused(self, by_solve_ivp, asked, said):
        with pytest.raises(InputError, match=f"^the engine by_solve_ivp does not simulate {said}$"):
            by_solve_ivp.follow(Structure(BLOCK), **{"motion": MOTIONS["rocks"], **asked})
        assert engine("exact").knows == ALL

    def test_info_lists_it_and_without_it_says_nothing_of_engines(self, by_solve_ivp, install):
        assert "by_solve_ivp" in {each["name"] for each in run_json("info")["plugins"]["engines"]}
        install()
        assert "engines" not in run_json("info")["plugins"]


class TestEnginesThatGoWrong:
    HERE = r"\(.*test_engines\.py:\d+\)"

    @pytest.mark.parametrize(
        ("cls", "said"),
        [
            (Divides, f"failed in history: ZeroDivisionError: division by zero {HERE}"),
            (Nothing, "failed in history: it must return a History, got NoneType"),
            (Lists, "failed in history: AttributeError: 'list' object has no attribute 'shape'"),
            (Short, "failed in history: time, phi, rate and ratio of its history differ in length"),
            (Flat, r"failed in history: impacts must have the shape \(k, 3\), got \(\d+,\)"),
            (Other, "failed in history: it must return a history of the model nonlinear, got linear2"),
            (Checks, "failed in history: its history has an opening of joints, but `joints` is not in what it knows"),
            (Asks, f"failed in refuses: KeyError: 'lost' {HERE}"),
        ],
    )
    def test_an_error_of_an_engine_is_its_own(self, install, cls, said):
        install(broken=cls)
        with pytest.raises(PluginError, match=f"^the engine broken {said}"):
            engine("broken").follow(Structure(BLOCK), MOTIONS["rocks"])

    @pytest.mark.parametrize(
        ("fields", "said"),
        [
            ({"fell_to": 2}, "fell_to of its history must be 1, -1 or 0, got 2"),
            ({"overturned": True}, rf"TypeError: .* unexpected keyword argument 'overturned' {HERE}"),
            ({"peak_negative": -0.1}, "a peak of its history must be at least 0, got -0.1"),
            ({"peak_positive": float("nan")}, "a peak of its history must be at least 0, got nan"),
            ({"impact_count": 0}, r"its history has \d+ impacts, but impact_count is 0"),
        ],
    )
    def test_a_history_that_contradicts_itself_is_none(self, install, monkeypatch, fields, said):
        install(broken=Spoils)
        monkeypatch.setattr(Spoils, "fields", fields)
        with pytest.raises(PluginError, match=f"^the engine broken failed in history: {said}$"):
            engine("broken").follow(Structure(BLOCK), MOTIONS["rocks"])

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            ((BLOCK, MOTIONS["rocks"]), "structure must be a Structure of rocking_cli.engines, got Block"),
            ((Structure(BLOCK), "sine:0.3g:0.8s"), "motion must be a GroundMotion, got str"),
            (
                (Structure(BLOCK), MOTIONS["rocks"], "linear3"),
                NO_MODEL,
            ),
        ],
    )
    def test_wrong_arguments_are_no_fault_of_an_engine(self, install, arguments, said):
        install(broken=Divides)
        structure, motion, *model = arguments
        with pytest.raises(InputError, match=f"^{re.escape(said)}$"):
            engine("broken").follow(structure, motion, **({"model": model[0]} if model else {}))

    @pytest.mark.parametrize(
        ("name", "cls", "said"),
        [
            ("lacks", "Lacks", "is not an engine: method history is missing"),
            ("misnamed", "Misnamed", "is not an engine: its class must have name = 'misnamed'"),
            ("claims", "Claims", "is not an engine: knows must be a set of 'linear models', 'releases', 'vertical"),
            ("exact", "Delegating", "the name exact is that of the engine of rocking-cli"),
            ("no_class", "NoClass", "is not an engine: it must be a class derived from Engine"),
            ("not_made", "NotMade", f"cannot be made: KeyError: 'lost' {HERE}"),
            ("not_there", "NotThere", "cannot be loaded: AttributeError"),
        ],
    )
    def test_one_that_is_no_engine_is_named_with_its_package(self, install, name, cls, said):
        install(**{name: f"{__name__}:{cls}"})
        with pytest.raises(MechanismError, match=rf"^plugin {name} of .* \(tests\.test_engines:{cls}\) .*{said}"):
            engines()[name]

    @pytest.mark.parametrize("cls", [Divides, Nothing, "Lacks"])
    def test_a_command_ends_with_its_exit_code_and_without_a_traceback(self, install, exact_refuses, cls):
        name = "broken" if isinstance(cls, type) else "lacks"
        install(**{name: cls if isinstance(cls, type) else f"{__name__}:{cls}"})
        said = run("respond", "--pulse", "sine:0.3g:0.8s", "--model", "nonlinear", code=3)
        assert name in said.stderr and "Traceback" not in said.stderr and said.stdout == ""

    def test_models_are_known_and_not_none(self):
        for models in ((), ("nonlinear", "linear3")):
            with pytest.raises(InputError, match=r"models must be of nonlinear, linear1, linear2, got (none|linear3)"):
                respond(Structure(BLOCK), MOTIONS["rocks"], models=models)
