"""Where bodies that are apart at rest meet: against closed forms, and against shapely, which shares no code with it."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely import Polygon
from shapely.affinity import rotate

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.core.released import Pieces, released, stop_impulses
from tests.conftest import EXAMPLES

FLOOR = {"polygon": [[-9, -0.5], [9, -0.5], [9, 0], [-9, 0]]}


def box(left, bottom, right, top):
    return {"polygon": [[left, bottom], [right, bottom], [right, top], [left, top]]}


def assembly(blocks, **ground):
    return rk.Assembly(density=2000, depth=1, friction=2.0, blocks=blocks, ground={"floor": FLOOR, **ground})


def bookcase(**ground):
    return assembly({"shelf": box(0, 0, 0.4, 2.2)}, **ground)


def test_a_bookcase_meets_the_wall_beside_it_where_its_top_has_moved_by_the_gap():
    bounds = bookcase(right=box(0.43, 0, 0.9, 3), left=box(-0.5, 0, -0.05, 3)).bounds
    for direction, name, gap in ((Direction.POSITIVE, "right", 0.03), (Direction.NEGATIVE, "left", 0.05)):
        assert bounds[direction].phi == pytest.approx(math.asin(gap / 2.2), rel=1e-7)
        assert bounds[direction][1:4] == ("meets", name, "shelf")


def test_a_thin_mast_does_not_pass_a_thin_peg_between_two_rotations_of_the_search():
    mast = [[0, 0], [0.6, 0], [0.6, 0.4], [0.303, 0.4], [0.303, 2], [0.3, 2], [0.3, 0.4], [0, 0.4]]
    peg = box(0.82, 1.8, 0.821, 1.801)
    bound = assembly({"mast": {"polygon": mast}}, peg=peg).bounds[Direction.POSITIVE]
    # The right side of the mast, 1.8 m and more up, turns about the corner (0.6, 0) to the nearest corner of the peg.
    low, high = 0.0, 0.3
    for _ in range(60):
        phi = (low + high) / 2
        corner = 0.6 + (complex(0.82, 1.801) - 0.6) * np.exp(1j * phi)  # in the frame of the mast
        low, high = (phi, high) if corner.real > 0.303 else (low, phi)
    assert bound.phi == pytest.approx(phi, rel=1e-6)
    assert bound.name == "peg"


def test_a_body_meets_the_ground_on_which_it_stands_elsewhere():
    ground = [[-9, -1], [9, -1], [9, 0], [0.4, 0], [0.4, 0.06], [-9, 0.06]]
    bracket = [[0, 0.06], [0.4, 0.06], [0.4, 0.11], [1, 0.11], [1, 0.3], [0.4, 0.3], [0.4, 1.6], [0, 1.6]]
    structure = rk.Assembly(
        density=2000, depth=1, friction=2, blocks={"post": {"polygon": bracket}}, ground={"step": {"polygon": ground}}
    )
    bound = structure.bounds[Direction.POSITIVE]
    arm = complex(0.6, 0.05)  # from the pivot, on the edge of the step, to the corner of the bracket
    phi = math.atan(0.05 / 0.6) + math.asin(0.06 / abs(arm))
    assert bound[1:4] == ("leans", "step", "post")
    assert bound.phi == pytest.approx(phi, rel=1e-6)


def test_what_is_met_beyond_the_critical_rotation_is_leant_on_and_what_is_fallen_on_is_nothing():
    alpha = math.atan(0.4 / 2.2)
    leaning = bookcase(wall=box(0.4 + 2.2 * math.sin(1.5 * alpha), 0, 2, 3)).bounds[Direction.POSITIVE]
    assert (leaning.kind, leaning.phi) == ("leans", pytest.approx(1.5 * alpha, rel=1e-6))
    assert bookcase(wall=box(0.4 + 2.2 * math.sin(2.1 * alpha), 0, 3, 3)).bounds[Direction.POSITIVE] is None


@settings(max_examples=settings.default.max_examples // 3)
@given(
    gap=st.floats(0.01, 0.3), height=st.floats(0.8, 3), width=st.floats(0.2, 0.6), foot=st.floats(0, 1),
    top=st.floats(1, 3), lean=st.floats(-0.3, 0.3),
)  # fmt: skip
def test_a_meeting_is_where_shapely_finds_one(gap, height, width, foot, top, lean):
    assume(top > foot + 0.1)
    wall = [[width + gap, foot], [width + gap + 1, foot], [width + gap + 1 + lean, top], [width + gap + lean, top]]
    assume(min(x for x, _ in wall) > width + 0.005)
    phi_cr = math.atan(width / height)
    bound = assembly({"block": box(0, 0, width, height)}, wall={"polygon": wall}).bounds[Direction.POSITIVE]
    block, other = Polygon([(0, 0), (width, 0), (width, height), (0, height)]), Polygon(wall)

    def common(phi):
        return rotate(block, -phi, origin=(width, 0), use_radians=True).intersection(other).area

    phi = np.linspace(0, 2 * phi_cr, 30)
    met = [each for each in phi if common(each) > 1e-9]
    if not met:
        assert bound is None or bound.phi > phi[-2] or common(bound.phi + 1e-3) > 0
    else:
        assert bound is not None
        assert bound.phi <= met[0] + 1e-6
        assert common(bound.phi - 1e-4) < 1e-9 < common(bound.phi + 1e-2)


@pytest.mark.parametrize(
    "example", ["arch", "assembly", "frame", "linkage", "spanning_wall", "wall", "symmetric_frame"]
)
def test_mechanisms_that_nothing_is_near_have_no_bound(example):
    mechanism = rk.load_structure(EXAMPLES / f"{example}.yaml")
    assert set(mechanism.bounds.values()) == {None}


STOP = {"point": [0.2, 2.2], "gap": 0.05, "restitution": 0.4}


def pillar(**stop):
    return rk.Block(width=0.4, height=2.2, density=1000, depth=1, friction=0.9, stops=[{**STOP, **stop}])


def test_a_stop_is_met_where_its_point_has_moved_by_the_gap():
    to_the_right, to_the_left = pillar().bounds, pillar(gap=-0.05, point=[0.2, 2.0]).bounds
    assert to_the_right[Direction.POSITIVE].phi == pytest.approx(math.asin(0.05 / 2.2), rel=1e-7)
    assert to_the_right[Direction.NEGATIVE] is None
    # About the left corner: x = -.2 + .4 cos phi - 2 sin phi moves by -.05.
    phi = to_the_left[Direction.NEGATIVE].phi
    assert 0.4 * (math.cos(phi) - 1) - 2.0 * math.sin(phi) == pytest.approx(-0.05, rel=1e-6)


def test_the_impulse_of_a_stop_pulls_at_the_pivot_of_a_rising_body():
    mechanism, direction = pillar(), Direction.POSITIVE
    bound = mechanism.bounds[direction]
    mass, radius, alpha = 880.0, math.hypot(0.2, 1.1), math.atan(0.2 / 1.1)
    about_the_pivot = 4 / 3 * mass * radius**2
    x, y = radius * math.sin(alpha - bound.phi), radius * math.cos(alpha - bound.phi)
    height = 2.2 * math.cos(bound.phi)
    normal, shear = stop_impulses(mechanism, direction, bound)
    assert normal == pytest.approx(-mass * x, rel=1e-9)  # P_y = -(1 + e) m w b, for a rate of 1 that is taken
    assert shear == pytest.approx(about_the_pivot / height - mass * y, rel=1e-6)


@pytest.mark.parametrize("push", [-3.0, -4.5, -8.0])
def test_pressed_against_a_stop_the_pivot_bears_the_weight(push):
    mechanism, direction = pillar(), Direction.POSITIVE
    bound = mechanism.bounds[direction]
    at = np.array([bound.phi])
    here = mechanism.coefficients(at, direction)
    turning = float((-(mechanism.gravity * here.G + here.B * push) / here.I)[0])
    normal = released(mechanism, direction, at).force[0, 0] @ [1.0, push, 0.0, 0.0]
    assert turning > 0
    held = normal + turning * stop_impulses(mechanism, direction, bound)[0]
    assert held == pytest.approx(880.0 * mechanism.gravity, rel=1e-9)
    assert Pieces(mechanism, direction, at).mass[0, 0, 0, 0] == pytest.approx(880.0)


@pytest.mark.parametrize(
    ("stop", "field", "words"),
    [({"gap": 0}, "gap", "one_sided"), ({"body": "door"}, "body", "block"), ({"restitution": 1.5}, "restitution", "1")],
)
def test_a_stop_that_cannot_be_is_refused_with_its_field(stop, field, words):
    with pytest.raises(rk.InputError, match=words) as caught:
        pillar(**stop)
    assert field in str(caught.value)
