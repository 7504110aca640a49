"""The statics, equivalent blocks and models of a structure are made once, and kept by no structure that is gone."""

import copy
import gc
import pickle
import sys
import weakref

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli import structure
from rocking_cli.structure import MOST_KEPT, Structure, build_models
from tests.conftest import EXAMPLES

PULSE = "sine:0.3g:0.8s"


@pytest.fixture
def block():
    return rk.Block(width=0.7, height=2.8)


@pytest.fixture
def built(monkeypatch):
    """Return the list of the models that are built from now on."""
    names, build = [], structure.build
    monkeypatch.setattr(structure, "build", lambda *given, **more: names.append(given[3]) or build(*given, **more))
    return names


def test_a_structure_that_is_asked_again_has_the_same_models(block):
    first = build_models(block)
    assert all(one is other for one, other in zip(first, build_models(block), strict=True))


@pytest.mark.parametrize("changed", [{"width": 0.71}, {"name": "pillar"}, {"restitution": 0.9}])
def test_a_changed_copy_has_models_of_its_own(block, changed):
    (first,), (other,) = build_models(block, ("nonlinear",)), build_models(block.replace(**changed), ("nonlinear",))
    assert not np.shares_memory(first.forces, other.forces)
    assert build_models(block, ("nonlinear",), opening=2.0)[0].joints is not first.joints


@pytest.mark.parametrize("more", [{}, {"restitution": 0.8}, {"opening": 2.0}])
def test_a_question_asked_twice_builds_once(block, built, more):
    """Also of a structure without a name, of which each question takes a copy that has one."""
    first = rk.respond(block, PULSE, **more)
    count = len(built)
    again = rk.respond(block, PULSE, **more)
    assert count == len(set(built)) == len(built) == 3
    assert np.array_equal(first["nonlinear"].phi, again["nonlinear"].phi)


def test_copies_and_pickles_go_without_them(block):
    whole = Structure(rk.load_structure(EXAMPLES / "frame.yaml"))
    shown, first = repr(block), build_models(block)
    whole.models()
    assert len(pickle.dumps(block)) < 1000 and len(pickle.dumps(whole)) < 10_000
    assert repr(block) == shown
    for other in (copy.copy(block), copy.deepcopy(block), pickle.loads(pickle.dumps(block)), block.model_copy()):
        assert other == block and build_models(other)[0] is not first[0]
    loaded = pickle.loads(pickle.dumps(whole))
    assert np.array_equal(loaded.model("nonlinear").forces, whole.model("nonlinear").forces)


def test_they_end_with_their_structure():
    block = rk.Block(width=0.7, height=2.8)
    model = weakref.ref(build_models(block, ("nonlinear",))[0])
    assert model() is not None
    del block
    gc.collect()
    assert model() is None


def test_they_end_when_many_others_are_asked():
    """A study with thousands of samples of geometry keeps the samples, and no more tables than without them."""
    blocks = [rk.Block(width=0.7 + 0.01 * k, height=2.8) for k in range(MOST_KEPT + 5)]
    models = [weakref.ref(build_models(each, ("nonlinear",))[0]) for each in blocks]
    gc.collect()
    assert [model() is not None for model in models] == [False] * 5 + [True] * MOST_KEPT


def test_no_one_can_change_what_others_are_given(block):
    model = build_models(block, ("nonlinear",))[0]
    for shared in (model.numbers, model.tables[0].forces, model.tables[0].nodes):
        with pytest.raises(ValueError, match="read-only"):
            shared[0] = 0.0


def test_a_structure_that_outlives_the_package_ends_in_silence(block, monkeypatch):
    """At its end Python empties modules while structures are still alive."""
    faults = []
    monkeypatch.setattr(sys, "unraisablehook", faults.append)
    passing = block.replace(width=0.8)
    build_models(passing, ("nonlinear",))
    monkeypatch.setattr(structure, "_KEPT", None)
    del passing
    gc.collect()
    assert not faults
