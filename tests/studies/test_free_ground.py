"""Ground and edges of free blocks, bodies that only slide, and structures that have no rocking model."""

import json
from dataclasses import replace
from math import atan, isnan

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli import names
from rocking_cli.ask.inputs import structure_of
from rocking_cli.dynamics.batch import Runs
from rocking_cli.errors import StructureError
from rocking_cli.studies.engines import blocks, engine_of
from rocking_cli.studies.engines import free as memory
from rocking_cli.studies.engines.blocks import BlockModel
from rocking_cli.studies.engines.free_blocks import FARTHEST_GROUND, HalfPlane, free_blocks
from tests.conftest import EXAMPLES, RECORDS, SHARED
from tests.following import free

pytest.importorskip("mujoco", reason="free blocks need mujoco")

G = 9.80665
FINDINGS = SHARED / "findings" / "boundaries"
RINALDI = RECORDS / "Rinaldi228.AT2"
needs_findings = pytest.mark.skipif(
    not (FINDINGS.is_dir() and RINALDI.is_file()), reason=f"no structures in {FINDINGS} or no record in {RECORDS}"
)


def box(left, right, low, high):
    return {"polygon": [[left, low], [right, low], [right, high], [left, high]]}


def assembly(blocks, ground, friction, **fields):
    return rk.Registry()["assembly"](
        density=2000.0, depth=1.0, friction=friction, blocks=blocks, ground=ground, **fields
    )


def sine(amplitude, period, sign=1):
    return rk.parse_pulse(f"sine:{amplitude:g}g:{period:g}s").sampled().scaled(sign)


def slip(motion, mu, until):
    """Return the displacement of a body that can only slide, at the samples: stick or Coulomb friction, by small steps.

    It shares nothing with the engine: u'' = -a_g - mu g sign(u'), or stuck as long as mu g is more than a_g.
    """
    fine = 20
    dt = motion.dt / fine
    time = np.arange(round(until / dt)) * dt
    ground = np.interp(time + dt / 2, np.arange(motion.npts) * motion.dt, motion.acceleration, right=0.0)
    u, v, path = 0.0, 0.0, [0.0]
    for push in (-ground).tolist():
        if v == 0 and abs(push) <= mu * G:
            path.append(u)
            continue
        way = np.sign(v) if v else np.sign(push)
        new = v + (push - mu * G * way) * dt
        stops = v != 0 and new * v <= 0
        u += v * dt / 2 if stops else (v + new) * dt / 2
        v = 0.0 if stops else new
        path.append(u)
    return np.array(path)[:: fine * motion.every]


@pytest.mark.every(4)
@pytest.mark.parametrize(("width", "height", "mu", "amplitude", "period"), [
    (1.0, 1.0, 0.2, 1.0, 1.0), (0.12, 0.3, 0.3, 0.8, 0.6), (0.024, 0.06, 0.2, 0.6, 0.3), (2.0, 6.0, 0.2, 0.9, 1.0),
])  # fmt: skip
def test_what_only_slides_slides_as_by_a_closed_form_and_does_not_tilt(width, height, mu, amplitude, period):
    free = free_blocks(rk.Block(width=width, height=height, friction=mu))
    motion = sine(amplitude, period)
    moved = BlockModel(free).simulate(motion).moved[:, 0]
    exact = slip(motion, mu, 1.2 * period)
    assert np.abs(exact).max() > 0.03
    assert moved[: len(exact), 0] == pytest.approx(exact[: len(moved)], abs=0.005 * np.abs(exact).max())
    assert np.abs(moved[:, 2]).max() < 1e-4 * atan(width / height)


def test_without_what_is_taken_from_sliding_contacts_the_same_body_tilts(monkeypatch):
    free = free_blocks(rk.Block(width=0.12, height=0.3, friction=0.3))
    monkeypatch.setattr(BlockModel, "_let_slide", staticmethod(lambda data: None))
    moved = BlockModel(free).simulate(sine(0.8, 0.6)).moved[:, 0]
    assert np.abs(moved[:, 2]).max() > 1e-3 * atan(0.4)


def test_the_smallest_object_rocks_as_the_largest_in_longer_time():
    found = []
    for scale in (1.0, 1e-2, 1e2):
        push = 4.4 * np.sin(2 * np.pi * np.arange(101) / 100)
        motion = rk.GroundMotion("pulse", 0.006 * scale**0.5, push, unit="m/s2")
        free = free_blocks(rk.Block(width=0.6 * scale, height=2.0 * scale, friction=1.0))
        found.append(BlockModel(free).simulate(motion, most=200 * motion.dt).moved[:200, 0, 2])
    assert np.abs(found[0]).max() > 0.05
    for other in found[1:]:
        assert other == pytest.approx(found[0], abs=1e-6 * np.abs(found[0]).max())


@pytest.mark.rest
@needs_findings
@pytest.mark.parametrize("file", ["plinth", "vase"])
def test_plinth_and_vase_slide_and_stay(file):
    structure = structure_of(FINDINGS / f"{file}.yaml")
    history = free(structure, rk.read_record(RINALDI))
    assert not history.fell and history.at_rest and not history.lifted
    assert 0.4 < history.blocks.moved[0] < 0.46 and history.blocks.turned[0] < 1e-4
    assert history.blocks.fell == history.blocks.off == ""


@pytest.mark.rest
@needs_findings
@pytest.mark.parametrize(
    ("amplitude", "period"), [(0.5, 2), (1, 1), (1.5, 1), (0.7, 2), (1, 2), (0.3, 2), (0.5, 1), (0.7, 1), (1, 0.5)]
)
def test_the_cube_slides_as_far_as_the_pulse_carries_it(amplitude, period):
    structure, motion = structure_of(FINDINGS / "cube.yaml"), sine(amplitude, period)
    history = free(structure, motion)
    exact = slip(motion, 0.2, 3.0 * period)
    assert history.at_rest and not history.fell
    assert history.blocks.moved[0] == pytest.approx(np.abs(exact).max(), rel=0.005)
    assert history.blocks.left[0] == pytest.approx(abs(exact[-1]), abs=0.01 * np.abs(exact).max())


@pytest.mark.parametrize(
    ("sign", "edge", "off"),
    [
        (1, 0.5, True),
        (-1, 3.0, False),
        *(pytest.param(*each, marks=pytest.mark.rest) for each in ((-1, 0.5, True), (1, 3.0, False))),
    ],
)
def test_a_block_falls_off_an_edge_only_where_one_is_drawn_within_its_reach(sign, edge, off):
    motion = sine(1.0, 1.5, sign)
    reach = np.abs(slip(motion, 0.2, 6.0)).max()
    assert 0.5 + 0.5 < reach < 3.0  # half of the block is over the edge after .5 + .5 m
    left, right = (edge, 9.0) if sign > 0 else (9.0, edge)
    cube = assembly({"cube": box(0, 1, 0, 1)}, {"podium": box(-left, 1 + right, -1, 0)}, 0.2)
    history = free(structure_of(cube), motion)
    assert (history.fell, history.off_edge) == (off, off)
    assert history.blocks.off == ("podium" if off else "")
    assert history.words == ("falls off the edge of podium" if off else "does not overturn; slides")
    if off:
        assert history.blocks.fell == "cube" and history.fell_to == -sign
        assert history.slid is None and history.slip == 0
    else:
        assert history.blocks.moved[0] == pytest.approx(reach, rel=0.005)


@pytest.mark.every(2)
@pytest.mark.parametrize("sign", [1, -1])
def test_what_slides_is_said_to_slide_with_its_slip(sign, monkeypatch, tmp_path):
    monkeypatch.setattr(memory, "place", lambda: tmp_path / "blocks.sqlite")
    cube, motion = rk.Block(width=1.0, height=1.0, friction=0.2), sine(0.5, 1.0, sign)
    answer = rk.respond(cube, motion, engine="blocks", neighbours=3, slenderness_deviation=0, amplitude_deviation=0)
    exact = slip(motion, 0.2, 3.0)
    most, path = exact[np.abs(exact).argmax()], np.abs(np.diff(exact)).sum()
    told = answer.to_dict()["responses"]["blocks"]
    assert told["outcome"] == "at_rest" and answer.conclusion.concluded == "slides"
    assert told["slip"]["largest"] == pytest.approx(most, rel=0.005)
    assert told["slip"]["residual"] == pytest.approx(exact[-1], abs=0.01 * abs(most))
    assert told["slip"]["path"] == pytest.approx(path, rel=0.01)
    said = " ".join(str(part) for part in answer.view.parts)
    way = "right" if most > 0 else "left"
    far = f"{1000 * abs(told['slip']['largest']):.3g} mm to the {way}"
    assert f"the structure does not overturn, but slides by up to {far}" in said
    near = answer.neighbours[1]
    assert near.slides == 1 and list(near.slips) == pytest.approx([abs(told["slip"]["largest"])] * 3)
    columns = answer.columns()
    assert columns["slip [m]"][-1] == pytest.approx(told["slip"]["residual"])
    still = rk.respond(cube, motion.scaled(0.38), engine="blocks")["blocks"]
    assert still.words == "does not uplift" and still.slip == 0 and still.slid is None


def test_a_stele_that_overturns_at_an_edge_does_not_fall_off_it():
    stele = assembly({"stele": box(0, 0.4, 0, 2.4)}, {"podium": box(-0.05, 0.45, -1, 0)}, 0.8)
    history = free(structure_of(stele), sine(0.6, 1.0))
    assert history.fell and history.blocks.fell == "stele" and not history.off_edge
    assert history.words == "overturns"


def moved_by(free, block, x):
    moved = np.zeros((len(free.bodies), 3))
    moved[[body.name for body in free.bodies].index(block), 0] = x
    return moved


def test_edges_are_those_of_all_ground_in_line_and_of_blocks():
    ground = {"west": box(-2, 0.5, -1, 0), "east": box(0.5, 3, -1, 0), "step": box(3, 9, -2, -0.4)}
    free = free_blocks(assembly({"low": box(0, 1, 0, 1), "top": box(0.2, 0.8, 1, 2)}, ground, 0.7))
    assert free.edge_passed("low", moved_by(free, "low", 2.49)) == ""
    assert free.edge_passed("low", moved_by(free, "low", 2.51)) == "west"  # its middle, from .5 to beyond 3
    assert free.edge_passed("low", moved_by(free, "low", -2.51)) == "west"
    assert free.edge_passed("top", moved_by(free, "top", 0.49)) == ""
    assert free.edge_passed("top", moved_by(free, "top", -0.51)) == "low"
    both = moved_by(free, "top", 5.0) + moved_by(free, "low", 5.0)
    assert free.edge_passed("top", both) == ""  # it still is on the block, which has left the ground


@pytest.mark.every(3)
@pytest.mark.parametrize("file", ["block", "cone", "arch", "rigid_body", "linkages/portico", "walls/facade"])
def test_ground_that_nobody_drew_has_no_edge(file):
    free = free_blocks(rk.load_structure(EXAMPLES / f"{file}.yaml"))
    pieces = [piece for pieces in free.ground.values() for piece in pieces]
    assert pieces and all(isinstance(piece, HalfPlane) for piece in pieces)
    for body in free.bodies:
        far = moved_by(free, body.name, 1e6)
        assert free.edge_passed(body.name, far) in {"", *(other.name for other in free.bodies)}


def test_ground_at_two_levels_is_as_wide_as_the_step_between_them_allows():
    free = free_blocks(rk.load_structure(EXAMPLES / "frame.yaml"))
    corners = np.concatenate([z for pieces in free.ground.values() for z in pieces])
    low, high = free.box
    assert np.ptp(corners.real) > 2 * FARTHEST_GROUND * abs(high - low)


def test_the_bound_on_the_time_after_a_motion_is_named(monkeypatch):
    monkeypatch.setattr(blocks, "LONGEST_TAIL", 0.5)
    answer = rk.respond(rk.Block(width=0.7, height=2.8), sine(0.4, 0.8), engine="blocks", tail=0.1)
    run, told = answer["blocks"], answer.to_dict()
    assert run.still_rocking and run.words == "still rocking"
    ends = f"still moves at {0.8 + 0.5:.4g} s, where the simulation ends"
    assert f"As free blocks, it {ends}. Until then it rocks to" in told["verdict"] and "stays" not in told["verdict"]
    assert f"do not agree yet: by the exact engine the structure {names.OVERTURNS}" in told["engines"]["verdict"]
    assert ends in told["engines"]["verdict"] and "rocks" not in told["engines"]["verdict"]
    end = answer.conclusion.blocks
    assert (end.concluded, end.time) == ("still_moves", run.end_time) and run.peak_ratio == end.peak_ratio
    assert f"As free blocks, it still moves at {run.end_time:.4g} s" in answer.view.parts[0]
    assert told["responses"]["blocks"]["blocks"]["residual"] is None
    assert "at rest" not in " ".join(sentence for sentence in answer.sentences)


def test_a_bridge_that_still_slides_has_not_come_to_rest(monkeypatch):
    monkeypatch.setattr(blocks, "LONGEST_TAIL", 0.0)
    answer = rk.respond(BRIDGE, sine(0.8, 0.8), engine="blocks", tail=0.0)
    assert answer.conclusion.concluded == "still_moves" and answer["blocks"].words == "still rocking"
    said = answer.to_dict()["verdict"]
    assert said.startswith("As free blocks, the structure still moves at 0.8 s, where the simulation ends. deck moves")


BRIDGE = assembly(
    {"deck": box(0, 6, 3, 3.5)}, {"left": box(-2, 0.5, 0, 3), "right": box(5.5, 8, 0, 3)}, 0.3, name="bridge"
)
COLUMNS = {f"c{k}": box(3 * k, 3 * k + 0.8, 0, 4) for k in range(3)}
ARCHITRAVES = assembly(
    COLUMNS | {"a1": box(0, 3.4, 4, 4.6), "a2": box(3.4, 6.8, 4, 4.6)}, {"floor": box(-5, 12, -0.5, 0)}, 0.6
)


@pytest.mark.every(2)
@pytest.mark.parametrize("engine", ["blocks", "auto"])
def test_a_bridge_on_seats_has_an_outcome_and_no_rotation(engine):
    motion = sine(0.8, 0.8)
    answer = rk.respond(BRIDGE, motion, engine=engine, tail=1.0)
    exact = slip(motion, 0.3, 3.0)
    data = answer.to_dict()
    told = data["responses"]["blocks"]
    assert list(answer) == ["blocks"] and told["outcome"] == "at_rest" and told["overturned"] is False
    assert [told[key] for key in ("peak_ratio", "peak_positive", "impacts", "uplift_time")] == [None] * 4
    assert data["restitution"] is None and answer.conclusion.concluded == "comes_to_rest"
    assert told["blocks"]["displacement"] == pytest.approx(np.abs(exact).max(), rel=0.01)
    assert told["blocks"]["residual"] == pytest.approx(abs(exact[-1]), abs=0.01 * np.abs(exact).max())
    assert told["blocks"]["displacement_of"] == "deck" and told["blocks"]["falls"] is None
    said = " ".join(str(part) for part in answer.view.parts)
    assert "the structure comes to rest. deck moves by up to" in said and "no rocking model exists for sliding" in said
    json.dumps(data, allow_nan=False)
    with pytest.raises(StructureError, match="no rocking model"):
        rk.respond(BRIDGE, motion)
    with pytest.raises(rk.InputError, match="`neighbours` has no effect"):
        rk.respond(BRIDGE, motion, engine=engine, neighbours=10)


def test_a_deck_falls_off_its_seat():
    answer = rk.respond(BRIDGE, sine(0.9, 1.5, -1), engine="blocks")
    told = answer.to_dict()["responses"]["blocks"]
    assert told["outcome"] == "falls_off" and told["overturned"] is True
    assert told["blocks"]["falls"] == "deck" and told["blocks"]["falls_off"] == "left"
    assert told["blocks"]["residual"] is None
    assert answer.conclusion.concluded == "falls_off_an_edge" and answer.conclusion.next[0] == "strengthen"
    assert "where deck falls off the edge of left" in answer.to_dict()["verdict"]


@pytest.mark.rest
def test_columns_that_start_together_move_as_each_alone():
    ground, motion = {"floor": box(-5, 12, -0.5, 0)}, sine(0.3, 0.8)
    pair = assembly({"a": box(0, 1, 0, 4), "b": box(5, 6, 0, 4)}, ground, 0.6)
    with pytest.raises(StructureError, match=r"several mechanisms start at 0\.25 g, with these moving blocks: a; b"):
        rk.respond(pair, motion)
    answer = rk.respond(pair, motion, engine="auto")
    alone = rk.respond(assembly({"a": box(0, 1, 0, 4)}, ground, 0.6), motion, engine="blocks")["blocks"]
    turned = answer.to_dict()["responses"]["blocks"]["blocks"]["rotation"]
    assert turned == pytest.approx(max(alone.peak_positive, alone.peak_negative), rel=0.02)


@pytest.mark.rest
def test_architraves_over_one_column_and_several_motions():
    answers = rk.respond(ARCHITRAVES, [sine(0.3, 0.3), sine(1.0, 1.5)], engine="auto")
    first, second = (each["blocks"] for each in answers.values())
    assert not first.fell and second.fell and isnan(first.peak_ratio)
    assert "comes to rest" in answers.view.parts[0] and "overturns" in answers.view.parts[0]


def test_shares_count_those_that_fall_off_an_edge(monkeypatch, tmp_path):
    monkeypatch.setattr(memory, "place", lambda: tmp_path / "blocks.sqlite")
    block = assembly({"block": box(0, 1, 0, 2)}, {"podium": box(-9, 1.3, -1, 0)}, 0.55)
    structure = structure_of(block)
    motion = sine(1.2, 1.0, -1)
    found = engine_of("blocks", [block]).outcomes(
        [structure.model("nonlinear")], [motion], Runs.of(0, 0, scale=[0.1, 1.0]), threads=1
    )
    assert found.off_edge.dtype == bool and not (found.off_edge & ~found.fell).any() and not found.off_edge[0]
    told = rk.margin(block, motion, engine="exact", polarity="1", neighbours=10).to_dict()["motions"][0]
    assert told["off_edge"] == 0
    from rocking_cli.views.engines import engines_in_words

    said = " ".join(engines_in_words("blocks", 12, block, 3))
    assert "In 3 of them, a block falls off an edge that the file draws: they count as overturned." in said
    assert "edge" not in " ".join(engines_in_words("blocks", 12, block))


def test_a_mirrored_edge_is_the_mirrored_edge():
    ground = {"seat": box(-2, 0.6, -1, 0)}
    free = free_blocks(assembly({"a": box(0, 1, 0, 1)}, ground, 0.7))
    other = replace(free, ground={"seat": [np.array([0.4 - 1j, 3 - 1j, 3 + 0j, 0.4 + 0j])]})
    assert free.edge_passed("a", moved_by(free, "a", 0.31)) == other.edge_passed("a", moved_by(free, "a", -0.31))
    assert free.edge_passed("a", moved_by(free, "a", 0.29)) == other.edge_passed("a", moved_by(free, "a", -0.29)) == ""


@pytest.mark.rest
def test_deep_ground_is_as_shallow_ground():
    motion, found = sine(0.5, 0.7), []
    for wide, deep in ((9.0, 1.0), (900.0, 30.0)):
        portal = assembly(
            {"left": box(0, 0.9, 0, 3.4), "right": box(2.9, 3.7, 0, 3.4), "lintel": box(-0.1, 3.9, 3.4, 4.1)},
            {"floor": box(-wide, wide, -deep, 0)}, 0.7,
        )  # fmt: skip
        found.append(BlockModel(free_blocks(portal)).simulate(motion, most=2.0).moved)
    assert np.abs(found[0][..., 2]).max() > 0.05
    assert found[1] == pytest.approx(found[0], abs=1e-3 * np.abs(found[0]).max())
