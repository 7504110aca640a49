"""Polygons of many corners: the same verdicts as side by side, in a time that nobody notices."""

from itertools import combinations, pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mechanisms.block import Block
from mechanisms.rigid_body import MAX_CORNERS, RigidBody
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.polygons import any_alike, any_meet
from rocking_cli.errors import FieldError, MechanismError
from rocking_cli.questions.error.study import compare
from rocking_cli.structure import Structure
from rocking_cli.studies.picture import picture
from tests.cli.test_cli import run


def side(p, q, r):
    """Which side of pq the point r is on, in whole numbers."""
    turn = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    return (turn > 0) - (turn < 0)


def touches(a, b, c, d):
    """Whether ab and cd have a point in common."""

    def within(p, q, r):
        return side(p, q, r) == 0 and all(min(p[k], q[k]) <= r[k] <= max(p[k], q[k]) for k in (0, 1))

    if any((within(a, b, c), within(a, b, d), within(c, d, a), within(c, d, b))):
        return True
    return side(a, b, c) != side(a, b, d) and side(c, d, a) != side(c, d, b)


def any_touch(corners):
    """Side by side: those that share a corner are left out."""
    sides = list(pairwise([*corners, corners[0]]))
    return any(touches(*one, *other) for one, other in combinations(sides, 2) if len({*one, *other}) == 4)


def plane(corners):
    return np.array([complex(*corner) for corner in corners])


CORNERS = st.lists(st.tuples(st.integers(-6, 6), st.integers(-6, 6)), min_size=3, max_size=14)


@given(CORNERS)
def test_sides_meet_as_they_do_side_by_side(corners):
    assume(len(set(corners)) == len(corners))  # corners that are alike are refused before
    assert any_meet(plane(corners)) == any_touch(corners)


@given(st.integers(3, 40), st.randoms(use_true_random=False))
def test_stars_do_not_meet_themselves_until_two_corners_change_places(count, random):
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    corners = [
        (round(1000 * radius * np.cos(angle)), round(1000 * radius * np.sin(angle)))
        for angle, radius in zip(angles, (random.uniform(0.5, 1) for _ in angles), strict=True)
    ]
    assert any_meet(plane(corners)) == any_touch(corners)
    k = random.randrange(count - 2)
    corners[k], corners[k + 2] = corners[k + 2], corners[k]
    assert any_meet(plane(corners)) == any_touch(corners)


@given(CORNERS, st.sampled_from([0.0, 0.5, 1.0, 1.5]))
def test_corners_that_are_alike_are_found(corners, tolerance):
    near = any(np.hypot(p[0] - q[0], p[1] - q[1]) <= tolerance for p, q in combinations(corners, 2))
    assert any_alike(plane(corners), tolerance) == near


def tower(count):
    """An arch-shaped plate with this many corners."""
    angles = np.linspace(0.02, np.pi - 0.02, count - 2)
    return [[-0.5, 0.0], [0.5, 0.0], *([0.5 * float(np.cos(a)), 1 + 3 * float(np.sin(a))] for a in angles)]


def test_ten_thousand_corners_are_a_structure_and_more_are_refused():
    assert RigidBody(polygon=tower(MAX_CORNERS)).uplift(Direction.POSITIVE) == pytest.approx(
        RigidBody(polygon=tower(MAX_CORNERS // 10)).uplift(Direction.POSITIVE), rel=1e-4
    )
    with pytest.raises(ValueError, match="at most 10000 entries"):
        RigidBody(polygon=tower(MAX_CORNERS + 1))


def test_the_sides_of_many_corners_are_not_compared_one_by_one(monkeypatch):
    from rocking_cli.core import polygons

    calls = []
    meet = polygons._meet
    monkeypatch.setattr(polygons, "_meet", lambda *sides: calls.append(len(sides[0])) or meet(*sides))
    assert not any_meet(plane(tower(3000)))
    assert sum(calls) < 10 * 3000


@pytest.mark.parametrize("height", [0.0, 1e-9, 1e-7, -1e-7, 9e-7])
def test_feet_may_differ_by_what_nobody_measures(height):
    def block(y):
        return equivalent_block(RigidBody(polygon=[[0.0, 0.0], [1.0, y], [1.0, 3.0], [0.0, 3.0]]))

    level, uneven = block(0.0), block(height)
    for direction in Direction:
        for key, value in level[direction].as_dict().items():
            assert uneven[direction].as_dict()[key] == pytest.approx(value, rel=1e-5), key


def test_whole_numbers_are_rotations_too():
    block = Block(width=1.0, height=4.0)
    whole, real = (block.coefficients(np.array([0, 1], dtype), Direction.POSITIVE) for dtype in (int, float))
    for name in ("phi", "I", "J", "G", "B", "dG", "dB", "V"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(real, name))
    assert whole.G.dtype == np.float64
    assert block.potential_energy(np.array([1]), Direction.POSITIVE)[0] == pytest.approx(
        block.potential_energy(np.array([1.0]), Direction.POSITIVE)[0]
    )


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-200])
def test_what_is_too_small_to_be_drawn_is_refused(size):
    with pytest.raises(FieldError, match="must be at least 1e-06 m"):
        Block(width=size, height=size)
    with pytest.raises(MechanismError, match="too small to be drawn"):  # of a plugin that takes it
        picture(Block.model_construct(width=size, height=size))


def test_a_stocky_body_is_drawn_as_far_as_it_goes(tmp_path):
    (tmp_path / "flat.yaml").write_text("mechanism: block\nwidth: 99\nheight: 0.01\n")
    run("draw", "flat.yaml")
    assert "beyond the kinematic limit of the mechanism" in run("draw", "flat.yaml", "--at", "1", code=2).stderr


@pytest.mark.parametrize("height", [1e-9, 1e-300])
def test_no_warning_but_an_error_where_rounding_hides_the_motion(height):
    from rocking_cli.errors import SolverError

    flat = Block.model_construct(width=1e5, height=height)  # of a plugin that takes it
    with pytest.raises(SolverError, match="so stocky"):
        compare(Structure(flat), (0.5,), (2.0,))


def test_a_report_stands_without_the_error_of_the_block(tmp_path):
    (tmp_path / "flat.yaml").write_text("mechanism: block\nwidth: 1e6\nheight: 1e-6\n")
    run("report", "flat.yaml", "-o", "r.html")
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "The error of the equivalent block is left out" in page
    assert "Errors of the equivalent block in free period" not in page
