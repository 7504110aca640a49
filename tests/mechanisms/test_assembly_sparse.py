"""Walls of many blocks: sparse programmes, rigid parts and searches against dense and direct ways."""

from contextlib import suppress
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pytest import approx
from scipy.linalg import null_space as dense_null_space

from mechanisms._assembly import (
    AssemblyBlock,
    DoesNotStand,
    NothingMoves,
    collapse,
    contacts,
    first_violation,
    friction,
    linkage,
)
from mechanisms._assembly.problem import AssemblyProblem
from mechanisms._assembly.programme import MIN_INTERIOR_EQUATIONS
from mechanisms._assembly.unique import kept_rays, velocity_space
from rocking_cli.core import Direction
from rocking_cli.core.polygons import nearby
from tests.mechanisms.test_assembly import assembly
from tests.mechanisms.test_assembly_limit import FLOOR, cut, greatest, rectangle, unbalanced

POSITIVE, NEGATIVE = Direction.POSITIVE, Direction.NEGATIVE


def bond(columns, courses, seed=0, even=False):
    """A wall in running bond of bricks of .5 x .25 m, of densities that differ by a little unless `even`."""
    rng = np.random.default_rng(seed)
    blocks = []
    for course in range(courses):
        cuts = np.arange(0, columns + 0.1, 1) if course % 2 == 0 else np.array([0, *np.arange(0.5, columns), columns])
        for k, (x0, x1) in enumerate(pairwise(cuts)):
            density = 1.0 if even else rng.uniform(0.9, 1.1)
            blocks.append(rectangle(f"b{course}.{k}", x0 / 2, course / 4, x1 / 2, (course + 1) / 4, density=density))
    return blocks


def jumble(seed):
    """A leaning wall of up to 60 random bricks: as in `test_assembly_limit`, and larger."""
    rng = np.random.default_rng(1000 + seed)
    lean = rng.uniform(-0.1, 0.1)
    boxes = cut(rng, 0, 0, rng.uniform(1, 4), rng.uniform(2, 6), int(rng.integers(1, 6)))
    if rng.random() < 0.5:
        boxes += [(x0 + 9, y0, x1 + 9, y1) for x0, y0, x1, y1 in cut(rng, 0, 0, 3, 4, 4)]
    blocks = []
    for k, box in enumerate(boxes[:60]):
        plain = rectangle(f"b{k}", *box, density=rng.uniform(0.5, 2))
        corners = tuple(z + lean * z.imag for z in plain.corners)
        blocks.append(replace(plain, corners=corners, centroid=sum(corners) / 4))
    joints = contacts(blocks, [rectangle("ground", -10, -1, 20, 0)])
    mu = [None, 0.3, 0.6, 1.5][int(rng.integers(4))]
    return blocks, [replace(c, friction=mu) for c in joints], [POSITIVE, NEGATIVE][int(rng.integers(2))]


@pytest.mark.rest
def test_both_theorems_agree_on_a_hundred_assemblies():
    answered = most = 0
    for seed in range(100):
        blocks, joints, direction = jumble(seed)
        try:
            found = collapse(blocks, joints, (), direction)
        except (DoesNotStand, NothingMoves):
            continue
        answered, most = answered + 1, max(most, len(blocks))
        assert found.kinematic == approx(found.multiplier, rel=1e-9), seed
        if seed % 5 == 0:
            assert unbalanced(blocks, joints, found, direction) < 1e-9, seed
        assert found.opening.min() >= -1e-9, seed
        if seed % 10 == 0:
            assert found.multiplier == approx(greatest(blocks, joints, direction), rel=1e-6), seed
    assert answered > 60
    assert most > 30


@pytest.mark.rest
def test_a_wall_solved_by_interior_points_has_both_theorems():
    blocks = bond(14, 15)
    assert 3 * len(blocks) > MIN_INTERIOR_EQUATIONS
    joints = contacts(blocks, FLOOR, friction=0.6)
    found = collapse(blocks, joints)
    assert found.kinematic == approx(found.multiplier, rel=1e-12)  # corrected until what is left is rounding
    assert found.multiplier == approx(greatest(blocks, joints, POSITIVE), rel=1e-6)
    assert unbalanced(blocks, joints, found) < 1e-12
    assert friction(found).needed == 0.6  # it slides: any less and it would slide earlier


@pytest.mark.parametrize("seed", range(6))
def test_rigid_parts_leave_the_velocities_that_one_dense_matrix_has(seed):
    blocks, joints, direction = jumble(seed)
    problem = AssemblyProblem.of(blocks, joints, (), direction)
    rays = problem.bearings.rays()
    _, _, raw = problem.greatest(rays)
    kept = kept_rays(rays, problem.dead, problem.live, raw)
    rng = np.random.default_rng(seed)
    for chosen in (kept, kept & (rng.random(len(kept)) < 0.7), np.zeros(len(kept), bool)):
        rows = rays.rates[chosen]
        expected = dense_null_space(rows.toarray(), rcond=1e-10) if chosen.any() else np.eye(3 * len(blocks))
        space = velocity_space(rows, problem.frame)
        assert space.shape == expected.shape
        if space.shape[1]:
            across = np.linalg.qr(space)[0]
            assert np.linalg.svd(across.T @ expected)[1].min() == approx(1, abs=1e-6)


def test_pairs_of_boxes_that_meet_are_those_of_all_pairs():
    rng = np.random.default_rng(3)
    for n, reach in ((1, 1.0), (40, 3.0), (700, 0.3), (600, 0.0)):
        low = rng.uniform(0, 10, n) + 1j * rng.uniform(0, 2, n) if reach else np.zeros(n, complex)
        high = low + rng.uniform(0, 1, n) * reach + 1j * rng.uniform(0, 1, n) * reach
        found = sorted(
            tuple(sorted(pair)) for i, j in nearby(low, high) for pair in zip(i.tolist(), j.tolist(), strict=True)
        )
        i, j = np.triu_indices(n, 1)
        meet = (np.maximum(low.real[i], low.real[j]) <= np.minimum(high.real[i], high.real[j])) & (
            np.maximum(low.imag[i], low.imag[j]) <= np.minimum(high.imag[i], high.imag[j])
        )
        assert found == list(zip(i[meet].tolist(), j[meet].tolist(), strict=True))


def test_the_friction_needed_is_a_bracket():
    """Just less does not carry the multiplier, and the coefficient itself does."""
    for seed in range(6):
        blocks, joints, direction = jumble(seed)
        try:
            found = collapse(blocks, joints, (), direction)
        except (DoesNotStand, NothingMoves):
            continue
        needed = friction(found).needed
        if not needed:
            continue
        reached = []
        for mu in (needed * (1 + 1e-9), needed * (1 - 1.1e-6)):
            less = [replace(c, friction=mu if c.friction is None else min(mu, c.friction)) for c in joints]
            problem = AssemblyProblem.of(blocks, less, (), direction)
            reached.append(problem.greatest(problem.bearings.rays())[0] / problem.strength)
        assert reached[0] >= found.multiplier * (1 - 2e-9), seed
        assert reached[1] < found.multiplier * (1 - 1e-10), seed


@pytest.mark.rest
def test_the_friction_needed_is_the_same_by_interior_points(monkeypatch):
    """Large walls are solved by interior points, whose multipliers are as exact only if they are corrected."""
    needed = []
    for large in (MIN_INTERIOR_EQUATIONS, 0):
        monkeypatch.setattr("mechanisms._assembly.programme.MIN_INTERIOR_EQUATIONS", large)
        needed.append([])
        for seed in range(0, 12):
            blocks, joints, direction = jumble(seed)
            with suppress(DoesNotStand, NothingMoves):
                needed[-1].append(friction(collapse(blocks, joints, (), direction)).needed)
    assert len(needed[0]) > 6 and any(needed[0])
    assert needed[1] == [one if one is None else approx(one, rel=1e-6, abs=1e-12) for one in needed[0]]


@pytest.mark.parametrize("root", [0.0312, 0.4, 0.99999])
@pytest.mark.parametrize("power", [1, 2, 7])
def test_a_first_violation_takes_few_margins(root, power):
    calls = []

    def margin(phi):
        calls.append(phi)
        return 1e-3 if phi < root and power == 1 else (root**power - phi**power)

    expected = root if power == 1 else (root**power + 1e-9) ** (1 / power)  # a tension of 1e-9 counts as none
    steps = np.linspace(0, 1, 33)
    found = first_violation(margin, steps, holds=lambda phi: 0 < phi < root - 0.04)
    assert found == approx(expected, abs=1.1e-8)
    assert len(calls) < 24


# --- mechanisms that differ by idle blocks alone ---------------------------------------------------------------------

TOWER = rectangle("tower", 0, 0, 1, 4)
GRAIN = 1e-6


def test_a_grain_of_the_same_slenderness_is_idle():
    """A tower of slenderness 1/4 and a grain of the same: the multipliers are equal, and the grain's work is none."""
    grain = rectangle("grain", 3, 0, 3 + GRAIN, 4 * GRAIN)
    blocks = [grain, TOWER]
    found = collapse(blocks, contacts(blocks, FLOOR))
    assert found.multiplier == approx(0.25, rel=1e-9)
    assert found.unique
    assert found.idle == ("grain",)
    assert linkage(blocks, contacts(blocks, FLOOR), (), found).groups == (("tower",),)
    # Of a size at which it does work it is a mechanism of its own.
    grain = rectangle("grain", 3, 0, 3.5, 2)
    found = collapse([grain, TOWER], contacts([grain, TOWER], FLOOR))
    assert not found.unique
    assert found.idle == ()


def test_what_is_idle_is_said_and_what_is_another_mechanism_is_refused(tmp_path):
    def brick(x0, wide, high):
        return {"polygon": [[x0, 0.0], [x0 + wide, 0.0], [x0 + wide, high], [x0, high]]}

    from rocking_cli.questions.collapse.view import view

    found = assembly({"tower": brick(0.0, 1.0, 4.0), "grain": brick(3.0, GRAIN, 4 * GRAIN)})
    each = found.collapse(POSITIVE)
    assert (each.idle, each.groups, each.rest) == (("grain",), (("tower",),), ["grain"])
    shown = view(found, {POSITIVE: each})
    assert any("grain may move along at no cost" in part for part in shown.parts if isinstance(part, str))
    assert shown.data()["directions"]["positive"]["idle"] == ["grain"]


def test_towers_that_may_push_each_other_differ():
    """Each turns about its own toe: not the same motion, although the pushing one works for nothing."""
    blocks = [TOWER, replace(rectangle("right", 1, 0, 2, 4))]
    found = collapse(blocks, contacts(blocks, FLOOR, per_pair={("tower", "right"): 0.0}))
    assert not found.unique
    assert {each.moves for each in found.several} == {("right",), ("tower", "right")}


def test_a_stack_that_slides_has_a_mechanism_for_each_joint():
    """The top alone, or both, slide at the friction: another joint slides, so they are not the same motion."""
    blocks = [rectangle("low", 0, 0, 4, 1), rectangle("top", 0, 1, 4, 2)]
    found = collapse(blocks, contacts(blocks, FLOOR, friction=0.3))
    assert found.multiplier == approx(0.3, rel=1e-9)
    assert {each.moves for each in found.several} == {("top",), ("low", "top")}


# --- odd walls -------------------------------------------------------------------------------------------------------


def test_walls_of_odd_blocks_have_an_answer_or_a_place():
    sliver = AssemblyBlock("sliver", (1 + 0j, 1.0001 + 0j, 1.0001 + 4j, 1 + 4j), 4e-4, 1.00005 + 2j)
    found = collapse([TOWER, sliver], contacts([TOWER, sliver], FLOOR, friction=0.6, within=1e-5))
    assert found.kinematic == approx(found.multiplier, rel=1e-9)
    gap = contacts([TOWER, rectangle("low", 1 + 0.0099, 0, 2, 4)], FLOOR)
    assert len(gap) == 3
    assert len(contacts([TOWER, rectangle("low", 1 + 0.0101, 0, 2, 4)], FLOOR)) == 2


def test_a_thousand_blocks_on_one_point_overlap_at_once():
    from mechanisms._assembly import ContactFault

    blocks = [rectangle(f"b{k}", 0, 0, 1, 4) for k in range(1000)]
    with pytest.raises(ContactFault, match="'b0' and 'b1' overlap"):
        contacts(blocks, FLOOR)
