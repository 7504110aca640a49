"""The pair that advances a nonlinear motion: its orders, measured, and the error it is asked to keep to."""

from functools import cache
from itertools import pairwise
from math import log2

import numpy as np
import pytest
from mpmath import mp

from mechanisms.block import Block
from rocking_cli.core import equivalent_block
from rocking_cli.dynamics.stepping import Ground, Law, State, by_table, nystrom
from rocking_cli.excitation.base import GroundMotion
from tests.following import respond
from tests.reference_history import Nonlinear

# q.. = -(g (1 - 0.8 q - 0.3 q^2 + 0.5 q^3) + u (0.7 + 0.4 q - 0.6 q^2 + 0.2 q^3)), all one cell of a table.
G, B = (1.0, -0.8, -0.3, 0.5), (0.7, 0.4, -0.6, 0.2)
FORCES = np.array([[G + B, G + B]])
LAW = Law(False, 0, 1.0, 1.0, 0.0, 1.0, 10.0, np.inf, 1.0, 0, 0.0)
GROUND = Ground(-1.5, 1.3, 1.1, -0.7)
STARTS = ((0.4, -0.3), (0.1, 0.5), (0.7, 0.2), (0.2, -0.6))


@cache
def solution(start):
    """A solution by Taylor series in 30 digits, which goes on from where it was computed last."""

    def slopes(t, y):
        push, g = GROUND.push + GROUND.ramp * t, GROUND.g + GROUND.grade * t
        return [y[1], -(g * mp.polyval(G[::-1], y[0]) + push * mp.polyval(B[::-1], y[0]))]

    return mp.odefun(slopes, 0, [mp.mpf(y) for y in start])


def exact(start, end):
    """q and w at the end."""
    with mp.workdps(30):
        return [float(y) for y in solution(start)(end)]


def advance(start, end, steps):
    """The state after so many steps, and the errors the last one reports."""
    h = end / steps
    state = State(*start, by_table(FORCES, LAW, start[0], GROUND.push, GROUND.g))
    for k in range(steps):
        state, e_q, e_w, _ = nystrom(by_table, FORCES, LAW, GROUND, k * h, state, h)
    return state, (e_q, e_w)


def test_a_motion_is_right_to_order_6_in_place_and_speed():
    right = np.array([exact(start, 1.0) for start in STARTS])
    errors = []
    for steps in (4, 8, 16):
        got = np.array([advance(start, 1.0, steps)[0][:2] for start in STARTS])
        errors.append(abs(got - right).max(axis=0))
    for coarse, fine in pairwise(errors):
        for one, other in zip(coarse, fine, strict=True):
            assert log2(one / other) == pytest.approx(6, abs=0.5)
    assert max(errors[-1]) < 1e-9


def test_one_step_is_right_to_the_7th_power_and_reports_the_5th():
    reports, errors = [], []
    for h in (0.2, 0.1, 0.05):
        steps = [advance(start, h, 1) for start in STARTS]
        reports.append(np.array([report for _, report in steps]).max(axis=0))
        right = np.array([exact(start, h) for start in STARTS])
        errors.append(abs(np.array([state[:2] for state, _ in steps]) - right).max(axis=0))
    for values, order in ((errors, 7), (reports, 5)):
        for coarse, fine in pairwise(values):
            for one, other in zip(coarse, fine, strict=True):
                assert log2(one / other) == pytest.approx(order, abs=0.5)
    # So what it reports is an error it does not make.
    assert (np.array(errors) < 0.1 * np.array(reports)).all()


def test_the_force_at_the_end_of_a_step_is_the_one_the_next_begins_with():
    state, _ = advance(STARTS[0], 0.5, 1)
    push, g = GROUND.push + 0.5 * GROUND.ramp, GROUND.g + 0.5 * GROUND.grade
    assert state.f == by_table(FORCES, LAW, state.q, push, g)


def test_a_violent_blow_in_a_calm_record_is_followed_by_steps_of_its_own():
    # In the calm a step spans the interval; the blow, thirty times uplift, needs many in it.
    block = Block(width=0.7, height=2.8)
    one = equivalent_block(block).positive
    shape = np.concatenate([[0.0], np.full(10, 1.01), [-30.0, 0.0]])
    samples = -one.lambda_ * block.gravity * shape
    dt = 0.3 / one.p
    expected = Nonlinear(block).follow(dt, samples)
    history = respond(block, GroundMotion("test", dt, samples, unit="m/s2"), models=("nonlinear",))["nonlinear"]
    assert expected.ended == "fallen"
    assert history.overturning_time == pytest.approx(expected.crossings[-1], abs=2e-12)
    assert history.impacts[0, 0] == pytest.approx(expected.impacts[0][0], abs=2e-12)


@pytest.mark.parametrize("interval", [0.5, 1.0, 2.0])
def test_the_tolerance_is_kept_however_coarse_the_record(interval):
    # Intervals of 0.5/p to 2/p: no step may be as long as they are.
    block = Block(width=0.7, height=2.8)
    one = equivalent_block(block).positive
    dt = interval / one.p
    samples = one.lambda_ * block.gravity * np.array([0.0, 0.5, -0.5, 0.6, 0.0])
    expected = Nonlinear(block).follow(dt, samples, 0.5)
    last, errors = len(expected.impacts), []
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10):
        history = respond(
            block, GroundMotion("test", dt, samples, unit="m/s2"), models=("nonlinear",), release=0.5, rtol=rtol
        )
        got = history["nonlinear"].impacts[:last]
        errors.append(max(abs(a[0] - b[0]) for a, b in zip(got, expected.impacts, strict=True)))
        assert errors[-1] < rtol
    assert errors[0] > 100 * errors[-1]  # it does less work if less accuracy is required
