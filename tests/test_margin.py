"""How much stronger a motion must be: against histories followed one by one, and a quotient."""

from __future__ import annotations

import numpy as np
import pytest

from rocking_cli.dynamics.history import respond
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.structure import load_structure, parse_structure
from rocking_cli.studies.margin import FACTORS, margin
from tests.conftest import EXAMPLES

BLOCK = parse_structure("mechanism: block\nwidth: 0.7\nheight: 2.8\n", "block", "block")


def falls(mechanism, motion, factor, polarities):
    return any(
        respond(mechanism, motion.scaled(sign * factor), models=("nonlinear",))["nonlinear"].overturned
        for sign in polarities
    )


def test_the_factors_have_the_motion_itself_among_them():
    assert 1.0 in FACTORS
    assert FACTORS[0] == pytest.approx(0.2, rel=0.01) and FACTORS[-1] == pytest.approx(5, rel=0.01)


@pytest.mark.parametrize("polarities", [(1,), (-1,), (1, -1)])
def test_the_least_factor_overturns_and_no_smaller_one_does(polarities):
    mechanism = load_structure(EXAMPLES / "frame.yaml")
    motion = parse_pulse("sine:0.3g:3s").sampled()
    found = margin(mechanism, motion, polarities)
    k = int(np.argmin(np.abs(FACTORS - found.overturning)))
    assert falls(mechanism, motion, FACTORS[k], polarities)
    assert not any(falls(mechanism, motion, factor, polarities) for factor in FACTORS[k - 8 : k])


def test_a_larger_factor_that_does_not_overturn_is_found():
    motion = parse_pulse("sine:0.8g:0.5s").sampled()
    found = margin(BLOCK, motion, (1,))
    fates = np.array([falls(BLOCK, motion, factor, (1,)) for factor in FACTORS])
    least = int(fates.argmax())
    above = [factor for factor, fell in zip(FACTORS[least:], fates[least:], strict=True) if not fell]
    assert found.overturning == FACTORS[least]
    assert found.safe_again == (above[-1] if above else None)
    assert len(above) > 1  # else this says little
    assert not fates[FACTORS == 1]
    assert found.other == FACTORS[fates & (FACTORS > 1)][0] or found.other == FACTORS[fates & (FACTORS < 1)][-1]


@pytest.mark.parametrize(("scale", "side"), [(1.05, -1), (1 / 1.05, 1)])
def test_the_nearest_factor_that_decides_otherwise_is_found(scale, side):
    least = margin(BLOCK, parse_pulse("sine:0.4g:1s").sampled(), (1,)).overturning
    motion = parse_pulse("sine:0.4g:1s").sampled().scaled(scale * least)
    found = margin(BLOCK, motion, (1,))
    assert falls(BLOCK, motion, 1.0, (1,)) is (side < 0)
    assert falls(BLOCK, motion, found.other, (1,)) is (side > 0)
    assert found.other == pytest.approx(1.05**side, rel=0.021)


def test_uplift_is_lambda_over_the_push_in_the_direction_that_it_lifts():
    one_sided = GroundMotion("push", 0.01, np.array([0.0, 4.0, 0.0, -1.0, 0.0]))
    lam = 0.7 / 2.8 * BLOCK.gravity
    assert margin(BLOCK, one_sided).uplift == pytest.approx(lam / 4, rel=1e-12)
    frame = load_structure(EXAMPLES / "frame.yaml")
    # Clockwise by the push to the left, anticlockwise by that to the right.
    positive, negative = 0.18801, 0.195274
    found = margin(frame, one_sided, (1,)).uplift
    assert found == pytest.approx(min(positive / 1, negative / 4) * 9.80665, rel=1e-5)
    found = margin(frame, one_sided, (-1,)).uplift
    assert found == pytest.approx(min(positive / 4, negative / 1) * 9.80665, rel=1e-5)
    assert margin(frame, GroundMotion("none", 0.01, np.zeros(4))).uplift is None
    assert margin(frame, GroundMotion("none", 0.01, np.zeros(4))).overturning is None
