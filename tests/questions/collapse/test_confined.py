"""Blocks between fixed sides: mechanisms without dilation by hand formulas, and by all states of joints one by one."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import yaml
from pytest import approx
from scipy.optimize import linprog

import rocking_cli as rk
from mechanisms._assembly import AssemblyBlock, AssemblyFault, NothingMoves, collapse, confined, contacts
from rocking_cli.core import Direction, polygon
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.mechanisms.test_assembly_limit import rectangle

POSITIVE, NEGATIVE = Direction
FLOOR = rectangle("floor", -10, -1, 10, 0)


def found(blocks, ground, mu, direction=POSITIVE, per_pair=None):
    blocks = [replace(each, inertia=0.1 * each.mass) for each in blocks]
    return collapse(blocks, contacts(blocks, ground, friction=mu, per_pair=per_pair), (), direction)


def shape(name, *corners):
    body = polygon(name, 1.0, corners)
    return AssemblyBlock(name, corners, body.mass, body.centroid, body.inertia)


def lid(y, x=10.0):
    return rectangle("ceiling", -x, y, x, y + 1)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize(("mu", "h"), [(0.4, 2.4), (0.6, 2.0), (0.9, 1.5)])
def test_a_block_between_floor_and_ceiling_slides(mu, h, direction):
    """At mu without a force above; one that would tip before is pressed above by (mu h - 1)/2 of its weight."""
    here = found([rectangle("a", 0, 0, 1, h)], [FLOOR, lid(h)], mu, direction)
    assert here.multiplier == approx(max(mu, mu**2 * h), rel=1e-8)
    assert here.associated == np.inf and here.confined and here.complete
    assert here.kinematic == approx(here.multiplier, rel=1e-9)
    assert np.abs(here.sliding) == approx(1.0, rel=1e-9) and np.abs(here.opening).max() < 1e-9
    pressed = here.normal.sum(axis=1) / here.problem.weight
    assert sorted(pressed) == approx([max(0, mu * h - 1) / 2, 1 + max(0, mu * h - 1) / 2], abs=1e-8)


def test_what_slides_counts_before_what_rocks_later_by_associated_flow():
    blocks = [rectangle("a", 0, 0, 1, 1.2), rectangle("tower", 4, 0, 5, 2)]
    ground, given = [FLOOR, lid(1.2, 2.0)], {("tower", "floor"): None}
    slides = found(blocks, ground, 0.4, per_pair=given)
    assert slides.multiplier == approx(0.4, rel=1e-9) and slides.associated == approx(0.5, rel=1e-9)
    rocks = found(blocks, ground, 0.6, per_pair=given)
    assert rocks.multiplier == approx(0.5, rel=1e-9)
    assert rocks.associated is None and rocks.confined and rocks.complete


@pytest.mark.parametrize(("flare", "stands"), [(-0.1, True), (0.0, False), (0.1, False)])
def test_a_key_between_two_walls_falls_unless_it_is_a_wedge(flare, stands):
    """Whatever the friction; wider below it falls free of both walls, where no force could ever balance it."""
    key = shape("key", -flare + 0j, 1 + flare + 0j, 1 + 1j, 1j)
    walls = [shape("left", -2 + 0j, -flare + 0j, 1j, -2 + 1j), shape("right", 1 + flare + 0j, 3 + 0j, 3 + 1j, 1 + 1j)]
    problem = "'key' would slide down under weight alone: friction at the sides holds only if something presses them"
    for mu in (0.6, 5.0):
        with pytest.raises(AssemblyFault, match="^no acceleration sets" if stands else f"^{problem}"):
            found([key], walls, mu)


def test_what_could_go_down_but_stands_is_not_refused():
    """A block on a slope of 20 degrees, which friction holds without a squeeze: it slides at tan(phi - slope)."""
    turn = np.exp(1j * np.radians(20))
    on_slope = shape("b", *(20 + turn * np.array([0j, 1 + 0j, 1 + 0.4j, 0.4j])))
    slope = shape("slope", *(20 + turn * np.array([-1 - 1j, 2 - 1j, 2 + 0j, -1 + 0j])))
    blocks, ground = [rectangle("a", 0, 0, 1, 1.2), on_slope], [FLOOR, lid(1.2), slope]
    for direction in Direction:
        here = found(blocks, ground, 0.6, direction)
        # Up the slope it would slide at tan(phi + slope), later than the other block.
        least = min(np.tan(np.arctan(0.6) + int(direction) * np.radians(20)), 0.6)
        assert here.multiplier == approx(least, rel=1e-8)
        assert here.confined and here.complete


def test_free_assemblies_and_what_glue_alone_confines_are_not_searched():
    towers = [rectangle("left", 0, 0, 1, 4), rectangle("right", 1, 0, 2, 4)]
    assert not found(towers, [FLOOR], 0.6).confined
    assert not found(towers, [FLOOR], None, per_pair={("left", "right"): 0.001}).confined
    assert not rk.load_structure(EXAMPLES / "masonry" / "portal.yaml").collapse(POSITIVE).confined


# --- all states of the joints of a block, by statics of its own -------------------------------------------------------


def by_hand(block, joints, way):
    """The least multiplier of all states of the joints that a motion and forces in balance may have; infinite if none.

    In each state every end of a joint is shut or without force, and every joint holds, or slips one way or the other.
    """
    ends = [(joint, z, 1j * joint.normal) for joint in joints for z in joint.ends]

    def acts(z, force):
        arm = z - block.centroid
        return [force.real, force.imag, arm.real * force.imag - arm.imag * force.real]

    normals = np.array([acts(z, joint.normal) for joint, z, _ in ends])
    shears = np.array([acts(joint.start, (joint.end - joint.start) / joint.length) for joint in joints])
    n, m, least = len(ends), len(joints), np.inf
    live = [way * block.mass, 0.0, 0.0]
    for shut in product((False, True), repeat=n):
        for slips in product((-1, 0, 1), repeat=m):
            of_ends = [(0.0, 0.0) if each else (0.0, None) for each in shut]
            motion = linprog(
                np.zeros(3 + n + m),
                A_eq=np.block([
                    [normals, -np.eye(n), np.zeros((n, m))],
                    [shears, np.zeros((m, n)), -np.diag(slips)],
                    [np.array([live]), np.zeros((1, n + m))],
                ]),
                b_eq=np.append(np.zeros(n + m), 1.0), bounds=[(None, None)] * 3 + of_ends + [(0, None)] * m,
            )  # fmt: skip
            if motion.status == 2:
                continue
            limits = []
            for k, joint in enumerate(joints):
                for sign in (1, -1):
                    row = np.zeros(n + m + 1)
                    row[2 * k : 2 * k + 2], row[n + k] = -joint.friction, sign
                    limits.append((row, slips[k] == -sign))
            forces = linprog(
                np.append(np.zeros(n + m), 1.0),
                A_eq=np.vstack([np.column_stack([normals.T, shears.T, live]), *(row for row, full in limits if full)]),
                b_eq=np.append([0.0, block.mass, 0.0], np.zeros(sum(full for _, full in limits))),
                A_ub=np.array([row for row, _ in limits]), b_ub=np.zeros(2 * m),
                bounds=[(0, None if each else 0) for each in shut] + [(None, None)] * m + [(0, None)],
            )  # fmt: skip
            if forces.status == 0:
                least = min(least, forces.fun)
    return least


@pytest.mark.every(4)
@pytest.mark.parametrize("seed", [1, 2, 5, 6])
def test_it_is_the_least_of_all_states_of_the_joints(seed):
    rng = np.random.default_rng(seed)
    h, tilt = rng.uniform(0.8, 3.0), rng.uniform(-0.15, 0.15)
    block = shape("a", 0j, 1 + 0j, 1 + 1j * (h + tilt), 1j * h)
    above = shape("ceiling", -1 + 1j * (h - tilt), 2 + 1j * (h + 2 * tilt), 2 + 9j, -1 + 9j)
    joints = contacts([block], [FLOOR, above])
    joints = [replace(each, friction=rng.uniform(0.3, 1.0)) for each in joints]
    for direction in Direction:
        least = by_hand(block, joints, int(direction))
        try:
            here = collapse([block], joints, (), direction)
        except NothingMoves:
            assert least == np.inf
            continue
        assert here.confined and here.complete
        assert here.multiplier == approx(least, rel=1e-6)


# --- what is said -----------------------------------------------------------------------------------------------------


def box(x0, y0, x1, y1):
    return {"polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]}


@pytest.fixture
def infill(tmp_path):
    blocks = {"a": box(0.0, 0.0, 1.0, 1.2), "b": box(0.0, 1.2, 1.0, 2.4)}
    ground = {"floor": box(-2.0, -0.5, 3.0, 0.0), "ceiling": box(-2.0, 2.4, 3.0, 2.9)}
    given = {"mechanism": "assembly", "density": 2000.0, "depth": 1.0, "friction": 0.4}
    path = tmp_path / "infill.yaml"
    path.write_text(yaml.safe_dump({**given, "blocks": blocks, "ground": ground}), encoding="utf-8")
    return path


def test_collapse_and_equiv_name_both_values(infill):
    for each in run_json("collapse", infill)["directions"].values():
        assert each["lambda"] == approx(0.4, rel=1e-9) and each["confined"] and each["search_complete"]
        assert each["lambda_associated"] is None and each["lead"] is None
        assert each["slides"] == ["floor and a"] and each["lifted"] == ["ceiling and b"]
        assert each["groups"] == [["a", "b"]] and each["friction_needed"] == approx(0.4, rel=1e-6)
    said = " ".join(run("collapse", infill).stdout.split())
    assert "lambda is 0.4 g in the positive direction without dilation (associated flow would lock it)" in said
    assert "do not dilate here (non-associated flow), and the confining forces of the sides" in said
    assert "kinematic theorem" not in said and "of 0.4 in every joint: all that is given." in said
    refused = " ".join(run("equiv", infill, code=2).stderr.split())
    assert "slides between floor and a at 0.4 g without dilation (associated flow would lock it): no rocking" in refused


def test_a_key_that_only_a_squeeze_holds_is_refused(tmp_path):
    blocks = {"a": box(0.0, 2.0, 1.0, 3.0), "b": box(0.0, 3.0, 1.0, 3.8)}
    ground = {"left": box(-2.0, 0.0, 0.0, 3.0), "right": box(1.0, 0.0, 3.0, 3.0)}
    given = {"mechanism": "assembly", "density": 2000.0, "depth": 1.0, "blocks": blocks, "ground": ground}
    path = tmp_path / "hang.yaml"
    path.write_text(yaml.safe_dump({**given, "friction": 0.6}), encoding="utf-8")
    refused = " ".join(run("collapse", path, code=2).stderr.split())
    assert "blocks.a: 'a' and 'b' would slide down under weight alone: friction at the sides holds only if" in refused
    assert "Draw a support from below" in refused
    path.write_text(yaml.safe_dump(given), encoding="utf-8")  # glued between the walls
    found = run_json("collapse", path)["directions"]["positive"]
    assert found["lambda"] == approx(1.25) and found["lambda_with_usual"] == 0 and not found["confined"]


def test_a_search_that_ends_early_is_never_silent(infill, monkeypatch):
    for limit, value in (("MAX_JOINT_PROGRAMMES", 0), ("MAX_JOINTS", 2)):
        with monkeypatch.context() as short:
            short.setattr(confined, limit, value)
            refused = " ".join(run("collapse", infill, code=2).stderr.split())
            assert "locks its confined blocks, and they are too many to search" in refused
    # Beside a slender block that rocks before, which has a model.
    slender = {"c": box(4.0, 0.0, 4.2, 1.0)}
    given = yaml.safe_load(infill.read_text(encoding="utf-8"))
    given["blocks"].update(slender)
    given["ground"] = {"floor": box(-2.0, -0.5, 6.0, 0.0), "ceiling": box(-1.0, 2.4, 2.0, 2.9)}
    infill.write_text(yaml.safe_dump(given), encoding="utf-8")
    assert "is not complete" not in rk.load_structure(infill).own_caution()
    monkeypatch.setattr(confined, "MAX_JOINTS", 2)
    said = rk.load_structure(infill).own_caution()
    assert "is not complete in the positive direction and in the negative direction: lambda may be lower" in said
