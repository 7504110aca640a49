"""Voussoirs and bricks that an assembly lays by a rule: sizes, places and lintels by hand, and what is refused."""

from itertools import pairwise

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.errors import InputError

ARCH = {"span": 6.0, "rise": 2.0, "thickness": 0.5, "count": 9}
WALL = {"wall": [4.0, 3.0], "length": 0.5, "height": 0.25}


def arch(**changed):
    return rk.Assembly(density=2000.0, depth=1.0, voussoirs=ARCH | changed)


def wall(openings=(), **changed):
    return rk.Assembly(density=1800.0, depth=0.3, bricks=WALL | {"openings": list(openings)} | changed)


@pytest.fixture(scope="module")
def ring():
    return arch()


@pytest.fixture(scope="module")
def plain():
    return wall()


@pytest.fixture(scope="module")
def opened():
    return wall([[1.0, 0.0, 2.0, 1.5]])


def corners(structure, name):
    return np.array(structure.blocks[name].corners)


def area(structure, name):
    z = corners(structure, name)
    return 0.5 * abs(np.sum((np.conj(z) * np.roll(z, -1)).imag))


def box(structure, name):
    z = corners(structure, name)
    return pytest.approx([z.real.min(), z.imag.min(), z.real.max(), z.imag.max()])


def test_voussoirs_are_between_two_circles(ring):
    """By hand: radius (3^2 + 2^2)/(2 2) = 3.25 m, about a centre 1.25 m below the springings."""
    radii = [np.abs(corners(ring, f"v{k}") + 1.25j) for k in range(1, 10)]
    assert all(np.sort(r)[:5] == pytest.approx(3.25) and np.sort(r)[5:] == pytest.approx(3.75) for r in radii)
    assert box(ring, "v5").expected[3] == pytest.approx(2.5)  # the crown


def test_voussoirs_are_equal_and_joined(ring):
    areas = [area(ring, f"v{k}") for k in range(1, 10)]
    assert areas == pytest.approx(areas[:1] * 9)
    between_joints = np.arcsin(3.0 / 3.25) * (3.75**2 - 3.25**2)
    assert sum(areas) == pytest.approx(between_joints, rel=1e-3)
    points = [set(np.round(corners(ring, f"v{k}"), 9)) for k in range(1, 10)]
    assert [len(one & other) for one, other in pairwise(points)] == [2] * 8


def test_an_arch_stands_on_springings_or_on_what_is_given(ring):
    assert list(ring.ground) == ["left", "right"]
    assert ring.uplift(Direction.POSITIVE) == pytest.approx(arch(at=[3.0, 1.0]).uplift(Direction.POSITIVE))
    floor = {"floor": {"polygon": [[-5, -1], [5, -1], [5, 0], [-5, 0]]}}
    half = {"span": 4.0, "rise": 2.0, "thickness": 0.6, "count": 9, "at": [0.0, 1.0]}
    sides = {name: {"polygon": [[x, 0], [x + 1, 0], [x + 1, 1], [x, 1]]} for name, x in (("a", -3), ("b", 2))}
    on_piers = rk.Assembly(density=2000.0, depth=1.0, voussoirs=half, blocks=sides, ground=floor)
    assert list(on_piers.ground) == ["floor"] and list(on_piers.blocks)[:3] == ["a", "b", "v1"]
    alone = rk.Assembly(density=2000.0, depth=1.0, voussoirs=half)
    assert 0 < on_piers.uplift(Direction.POSITIVE) < alone.uplift(Direction.POSITIVE)


def test_the_arch_of_many_voussoirs_is_the_arch():
    span, rise = 2 * 9.25 * np.sin(np.radians(78.75)), 9.25 * (1 - np.cos(np.radians(78.75)))
    laid = arch(span=float(span), rise=float(rise), thickness=1.5, count=7)
    same = rk.Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7)
    assert laid.uplift(Direction.POSITIVE) == pytest.approx(same.uplift(Direction.POSITIVE), rel=1e-3)


def test_bricks_fill_the_wall_in_running_bond(plain):
    assert sum(area(plain, name) for name in plain.blocks) == pytest.approx(12.0)
    assert [sum(name.startswith(f"{k}.") for name in plain.blocks) for k in (1, 2, 12)] == [8, 9, 9]
    assert box(plain, "1.1") == [0, 0, 0.5, 0.25] and box(plain, "2.1") == [0, 0.25, 0.25, 0.5]
    for low, high in pairwise(range(1, 13)):
        joints = [{round(float(box(plain, name).expected[0]), 9) for name in plain.blocks
                   if name.startswith(f"{course}.")} for course in (low, high)]  # fmt: skip
        assert joints[0] & joints[1] == {0.0}


def test_an_opening_is_cut_at_bricks_and_has_a_lintel(opened):
    """By hand: 1.1 to 2.1 m goes to 1.0 to 2.0 m, and 1.6 m up to the nearer of 1.5 and 1.75 m."""
    structure = wall([[1.1, 0.0, 2.1, 1.6]])
    assert structure.remarks == ["bricks: opening 1 is cut at the edges of bricks, [1, 0, 2, 1.5] m"]
    assert box(structure, "lintel 1") == [0.75, 1.5, 2.25, 1.75]
    assert sum(area(structure, name) for name in structure.blocks) == pytest.approx(12.0 - 1.5)
    assert opened.remarks == []
    to_the_top = wall([[1.0, 0.5, 2.0, 1.0]], wall=[4.0, 1.0])
    assert "lintel 1" not in to_the_top.blocks


def test_courses_fill_the_height_equally(plain):
    structure = wall(height=0.24, wall=[4.0, 1.0])
    assert structure.remarks == ["bricks: 4 courses of 0.25 m fill the height of 1 m"] and len(plain.remarks) == 0
    odd = wall(wall=[4.1, 1.0])
    assert sum(area(odd, name) for name in odd.blocks) == pytest.approx(4.1)
    assert min(area(odd, name) for name in odd.blocks) == pytest.approx(0.25 * 0.25)  # no slivers


def test_a_wall_of_another_size_is_laid_once(opened):
    larger = opened.enlarged(2.0)
    assert larger.bricks is None and list(larger.blocks) == list(opened.blocks)
    assert box(larger, "lintel 1") == [1.5, 3.0, 4.5, 3.5]


@pytest.mark.parametrize(
    ("make", "field", "why"),
    [
        (lambda: arch(rise=3.1), "voussoirs.rise", "at most half the span, 3 m"),
        (lambda: wall([[1, 0, 4.5, 1]]), "bricks.openings[1]", "reaches beyond the wall, 4 m long and 3 m high"),
        (lambda: wall([[2, 0, 1, 1]]), "bricks.openings[1]", "with x0 < x1 and y0 < y1"),
        (lambda: wall([[1, 0, 1.1, 1]]), "bricks.openings[1]", "at least 0.25 m long and 0.25 m high"),
        (lambda: wall([[1, 0, 2, 1], [1, 1, 2, 2]]), "bricks.openings[1]", "leaves no place for its lintel"),
        (lambda: wall(length=0.001, height=0.001), "bricks.length", "at most 10000 can be analysed"),
        (lambda: rk.Assembly(density=1.0, depth=1.0), "blocks", "or `voussoirs` or `bricks`"),
        (
            lambda: rk.Assembly(
                density=1.0, depth=1.0, voussoirs=ARCH, blocks={"v1": {"polygon": [[0, 0], [1, 0], [0, 1]]}}
            ),
            "blocks.v1",
            "is the name of one of the voussoirs",
        ),
    ],
)
def test_what_cannot_be_laid_is_refused_with_its_field(make, field, why):
    with pytest.raises(InputError) as caught:
        make()
    (problem,) = caught.value.problems
    assert why in problem.message and problem.field == field
