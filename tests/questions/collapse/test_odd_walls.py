"""Walls of odd blocks: an answer as without them, or an error that names the place; and how large files are read."""

import hashlib
import signal
import threading
import time
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
import yaml
from pytest import approx
from scipy.sparse import diags_array, eye_array, random_array, vstack

from mechanisms._assembly import ContactFault, collapse, contacts, linkage, remaining
from mechanisms._assembly import programme as programmes
from mechanisms._assembly.displaced import DisplacedAssembly
from mechanisms._assembly.friction import friction
from mechanisms._assembly.problem import scaled
from rocking_cli.ask.inputs import structure_of
from rocking_cli.cli.terminal import OnTerminal
from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.io import yaml_file
from tests.conftest import EXAMPLES
from tests.mechanisms.test_assembly import assembly
from tests.mechanisms.test_assembly_limit import FLOOR, cut, multiplier, rectangle, weights

POSITIVE = Direction.POSITIVE
TALL = rectangle("a", 0, 0, 1, 4)


def brick(x0, y0, x1, y1):
    return {"polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]}


# --- blocks ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("thick", "refused"), [(1e-9, True), (1.9e-3, True), (3e-3, True), (5e-3, False)])
def test_what_is_thinner_than_the_gap_is_named(thick, refused):
    """Faces that touch may be 2 per mille of its size apart: across a sliver its neighbours would be joined."""
    blocks = [rectangle("low", 0, 0, 1, 1), rectangle("sheet", 0, 1, 1, 1 + thick),
              rectangle("top", 0, 1 + thick, 1, 2 + thick)]  # fmt: skip
    if refused:
        with pytest.raises(ContactFault, match=r"'sheet' is .* m thick"):
            contacts(blocks, FLOOR)
    else:
        assert {(c.a, c.b) for c in contacts(blocks, FLOOR)} == {("ground", "low"), ("low", "sheet"), ("sheet", "top")}
    assert len(contacts(blocks, FLOOR, within=thick / 10)) == 3


def test_a_sheet_beside_a_joint_is_no_bridge():
    """It lies on both of two blocks side by side, 3 mm thick where their faces may be 4 mm apart."""
    blocks = [rectangle("a", 0, 0, 1, 1), rectangle("b", 1, 0, 2, 1), rectangle("sheet", 0.5, 1, 1.5, 1.003)]
    assert len(contacts(blocks, FLOOR)) == 5


def test_a_needle_is_named():
    needle = replace(TALL, name="needle", corners=(1 + 0j, 1.00001 + 0j, 1 + 4j))
    with pytest.raises(ContactFault, match="'needle' is 1e-05 m thick"):
        contacts([TALL, needle], FLOOR)


def test_a_grain_is_said_to_be_too_light_to_be_seen():
    """Alone it would turn at .1 g; beside what weighs a million million times as much nobody sees it."""
    wall = {"a": brick(0.0, 0.0, 1.0, 4.0)}
    assert assembly(wall).own_caution() == ""
    found = assembly({**wall, "grain": brick(3.0, 0.0, 3 + 1e-6, 1e-5)})
    assert found.uplift(POSITIVE) == approx(0.25, rel=1e-9)
    assert found.own_caution().startswith("grain weighs no more than 1e-09 of the whole")


@pytest.mark.parametrize(("apart", "joined"), [(0.00999, True), (0.01001, False), (-0.00999, True), (-0.01001, None)])
def test_gaps_and_overlaps_about_the_tolerance(apart, joined):
    """1 cm between blocks of 1 x 4 m, on which lambda hardly depends."""
    blocks = [TALL, rectangle("b", 1 + apart, 0, 2 + apart, 4)]
    if joined is None:
        with pytest.raises(ContactFault, match="'a' and 'b' overlap"):
            contacts(blocks, FLOOR)
        return
    joints = contacts(blocks, FLOOR)
    assert len(joints) == (3 if joined else 2)
    assert collapse(blocks, joints).multiplier == approx((2 + apart) / 4 if joined else 0.25, rel=1e-9)


@pytest.mark.parametrize("other", [(0, 0, 1, 4), (0.3, 1, 0.6, 2)])
def test_two_alike_and_one_in_another_overlap(other):
    with pytest.raises(ContactFault, match="'a' and 'b' overlap"):
        contacts([TALL, rectangle("b", *other)], FLOOR)


# --- the joints that are left ----------------------------------------------------------------------------------------


def test_forces_near_a_state_balance_without_tension():
    """Whatever the state beside, what `near` returns is in balance; and it says nothing where there is tension."""
    rng = np.random.default_rng(5)
    answered = refused = 0
    for _ in range(6):
        blocks = [rectangle(f"b{k}", *box) for k, box in enumerate(cut(rng, 0, 0, 2, 4, 4))]
        joints = contacts(blocks, FLOOR)
        dead, live = weights(blocks)
        states = linkage(blocks, joints, (), collapse(blocks, joints)).states
        there = DisplacedAssembly(remaining(blocks, joints, (), states), float(np.abs(dead).sum()))
        forces = dead + multiplier(there, dead, live) * live
        (answer,) = there.admissible(forces)
        if answer.forces is None or answer.margin <= 0:
            continue
        rays = there.bearings.rays()
        for change in (0.0, 1e-3, 0.05):
            state = there.near(forces, answer.forces * rng.uniform(1 - change, 1 + change, rays.count))
            assert state is not None
            off = rays.rates.T @ state + scaled(forces, there.frame, there.weight)
            assert np.abs(off).max() < 1e-9
            assert (state[rays.one_sided] >= 0).all()
            answered += 1
        assert there.near(-forces, answer.forces) is None
        refused += 1
    assert answered > 5 and refused > 1


def test_friction_is_needed_as_given_where_the_mechanism_slides():
    """A slab slides on a block at .3; a joint that only rocks with .6 needs less."""
    blocks = [rectangle("low", 0, 0, 4, 1), rectangle("top", 1, 1, 3, 2)]
    joints = contacts(blocks, FLOOR, friction=0.6, per_pair={("low", "top"): 0.3})
    assert friction(collapse(blocks, joints)).needed == approx(0.3, rel=1e-6)
    assert friction(collapse([TALL], contacts([TALL], FLOOR, friction=0.6))).needed == approx(0.25, rel=2e-6)


# --- the solver's thread ---------------------------------------------------------------------------------------------


def test_what_is_solved_beside_is_returned_and_its_faults_are_raised():
    assert programmes._beside(lambda: 7) == 7
    with pytest.raises(ZeroDivisionError):
        programmes._beside(lambda: 1 // 0)


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="no signals to a thread")
def test_who_waits_for_the_solver_is_interrupted_at_once():
    """What is solved is as deaf as the solver: a signal is noticed once it ends."""

    def deaf(rounds):
        began = time.monotonic()
        hashlib.pbkdf2_hmac("sha256", b"", b"", rounds)
        return time.monotonic() - began

    short = deaf(200_000)
    caller = threading.get_ident()
    threading.Timer(short, lambda: signal.pthread_kill(caller, signal.SIGINT)).start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        programmes._beside(lambda: deaf(2_000_000))
    assert time.monotonic() - began < 6 * short + 2 * programmes.INTERRUPT_INTERVAL


# --- large files -----------------------------------------------------------------------------------------------------


def test_a_long_file_is_read_as_a_short_one(monkeypatch):
    data = {f"b{k}": {"polygon": [[k, 0.5], [k + 1, 1e3]], "name": "é é"} for k in range(40)}
    text = "on: off\nn: 012\nbig: 1e3\n" + yaml.safe_dump(data, allow_unicode=True)
    expected = yaml_file.parse(text, "f", "structure", "")
    monkeypatch.setattr(yaml_file, "MIN_FAST_CHARACTERS", 0)
    read = yaml_file.parse(text, "f", "structure", "")
    assert read.data == expected.data and read.data["n"] == 12 and read.data["on"] == "off"
    for one, other in ((read.keys, expected.keys), (read.values, expected.values)):
        assert {place: (mark.line, mark.column) for place, mark in one.items()} == {
            place: (mark.line, mark.column) for place, mark in other.items()
        }
    for wrong, line in (("a: 1\nb: [1, 2\nc: 3\n", 3), ("a: éééééééé\nb: \x01\n\n\n\n\n\n", 2), ("a: 1\na: 2\n", 2)):
        with pytest.raises(InputError) as caught:
            yaml_file.parse(wrong, "f", "structure", "").check()
        assert caught.value.problems[0].line == line


def test_deep_nesting_in_a_long_file_is_refused():
    blocks = "".join(f"{' ' * depth}a:\n" for depth in range(1500))
    for text in ("[" * 200_000, "a: " + "[" * 60_000 + "]" * 60_000, blocks):
        with pytest.raises(InputError) as caught:
            yaml_file.parse(text, "f", "structure", "")
        assert str(caught.value) == "f: nested too deep to be a structure"


@pytest.mark.parametrize("wrong", ["", "frction: 0.6\n"])
def test_what_many_blocks_take_is_said_once_unless_they_are_refused(wrong, tmp_path, capsys):
    file = tmp_path / "wall.yaml"
    text = (EXAMPLES / "assembly.yaml").read_text("utf-8")
    file.write_text(f"{text}{wrong}#{'polygon ' * (10_000 - text.count('polygon'))}\n")
    with pytest.raises(InputError) if wrong else nullcontext():
        structure_of(file, OnTerminal())
    said = " ".join(capsys.readouterr().err.split())
    assert said.count("10000 polygons: 100 minutes and 2000 MB at least") == said.count("Ctrl-C") == (0 if wrong else 1)


def test_too_many_entries_are_counted():
    wall = {f"b{k}": brick(2.0 * k, 0.0, 2.0 * k + 1, 1.0) for k in range(3)}
    text = yaml.safe_dump({"mechanism": "assembly", "density": 1, "depth": 1, "blocks": wall,
                           "ground": {f"g{k}": brick(0.0, -1.0, 1.0, 0.0) for k in range(101)}})  # fmt: skip
    from rocking_cli.core.structure_file import parse_structure

    with pytest.raises(InputError, match="at most 100 entries, has 101"):
        parse_structure(text, "wall.yaml", "wall")


def planned(seed, rows=80, columns=200):
    """A programme whose one optimum is known: at a vertex, with prices that say so; far from evenly scaled."""
    rng = np.random.default_rng(seed)
    equal = random_array((rows, columns), density=0.1, random_state=rng, format="csc") + eye_array(rows, columns)
    equal = equal.tocsc() @ diags_array(10.0 ** rng.uniform(-2, 2, columns))
    low, high = np.full(columns, -1.0), np.full(columns, np.inf)
    low[:10], high[100:130] = -np.inf, 2.0
    x, slope = low.copy(), rng.uniform(0.1, 1.0, columns)
    x[:rows], slope[:rows] = rng.uniform(0.0, 1.0, rows), 0.0  # those of the vertex
    x[100:130], slope[100:130] = 2.0, -slope[100:130]  # at their upper bounds
    prices = rng.normal(size=rows)
    return (slope + equal.T @ prices, equal.tocsc(), equal @ x, low, high), x, prices, np.maximum(slope, 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_a_programme_is_refined_until_its_errors_are_rounding(seed, monkeypatch):
    monkeypatch.setattr(programmes, "CROSSOVER_ITERATIONS", 100)
    programme, x, prices, slope = planned(seed)
    found = programmes._Programme(*programme).refined()
    assert found.x == pytest.approx(x, rel=1e-8, abs=1e-8)
    assert found.prices == pytest.approx(prices, rel=1e-8, abs=1e-8)
    assert found.at_lower == pytest.approx(slope, rel=1e-8, abs=1e-8)
    assert found.value == pytest.approx(float(programme[0] @ x), rel=1e-12)


def test_a_refined_programme_without_an_answer_has_none(monkeypatch):
    monkeypatch.setattr(programmes, "CROSSOVER_ITERATIONS", 100)
    (cost, equal, right, low, high), *_ = planned(0)
    row = np.asarray(equal[[0]].toarray()).ravel()
    twice = vstack([equal, equal[[0]]], format="csc")
    assert programmes._Programme(cost, twice, np.append(right, right[0]), low, high).refined() is not None
    apart = np.append(right, right[0] + 1e-8 * np.abs(row).max())  # within the solver's tolerance, which is not ours
    assert programmes._Programme(cost, twice, apart, low, high).refined() is None
