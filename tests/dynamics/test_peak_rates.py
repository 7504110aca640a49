"""The peak angular velocity: by energy, by samples and by symmetry; the references of histories check it, too."""

from math import sqrt

import numpy as np
import pytest

import rocking_cli as rk
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from rocking_cli.core import Direction
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import build_models
from tests.conftest import PROJECT
from tests.following import respond

BLOCK = Block(width=0.7, height=2.8)
FRAME = AsymmetricFrame(
    column_width=1.0, left_height=6.0, right_height=7.5, spacing=8.0, beam_depth=1.0, density=2400.0, depth=1.0
)


def refined(times, by=20):
    """The example with so many samples for each of its own: between samples it is straight, so it is the same."""
    accel = rk.read_record(PROJECT / "examples" / "accel.csv")
    t = np.arange(accel.npts) * accel.dt
    fine = np.linspace(0, t[-1], (accel.npts - 1) * by + 1)
    return GroundMotion("fine", accel.dt / by, times * np.interp(fine, t, accel.acceleration), unit="m/s2")


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("mechanism", [BLOCK, FRAME], ids=["block", "frame"])
def test_a_release_is_fastest_as_it_first_lands(mechanism, sign):
    """I phi.^2/2 is then the energy of the start."""
    history = respond(mechanism, None, models=("nonlinear",), release=0.6 * sign)["nonlinear"]
    direction = Direction(sign)
    start = 0.6 * mechanism.critical_rotation(direction)
    ends = mechanism.coefficients(np.array([0.0, start]), direction)
    fastest = sqrt(2 * mechanism.gravity * (ends.V[1] - ends.V[0]) / ends.I[0])
    rates = (history.peak_rate_positive, history.peak_rate_negative)[::sign]
    assert rates[0] == history.peak_rate == pytest.approx(fastest, rel=1e-8)
    assert 0 < rates[1] < rates[0]


@pytest.mark.parametrize("model", ["nonlinear", "linear2"])
@pytest.mark.parametrize(("mechanism", "times"), [(BLOCK, 1.0), (FRAME, 1.4)], ids=["block", "frame"])
def test_no_sample_is_faster_and_the_fastest_is_as_fast(mechanism, times, model):
    history = respond(mechanism, refined(times, 100), models=(model,))[model]
    for s, peak in ((1, history.peak_rate_positive), (-1, history.peak_rate_negative)):
        before, other = (history.impacts[history.impacts[:, 1] == side, 2].max() for side in (s, -s))
        after = mechanism.eta(Direction(-s)) * other
        seen = max(np.abs(history.rate[s * history.phi > 0]).max(), before, after)
        assert seen <= peak * (1 + 1e-12) and peak == pytest.approx(seen, rel=1e-6)


def test_it_ends_where_the_outcome_becomes_unknown():
    history = rk.respond(
        PROJECT / "examples" / "arch.yaml", refined(1.5), model="nonlinear", engine="exact"
    )["nonlinear"]  # fmt: skip
    assert history.unknown and history.known_to < 4
    known = history.time <= history.known_to
    # It still grows then, by 0.3 rad/s2.
    assert np.abs(history.rate[known]).max() <= history.peak_rate
    assert history.peak_rate == pytest.approx(np.abs(history.rate[known]).max(), rel=1e-2)


def test_a_reversed_motion_swaps_the_directions_and_size_slows_a_release():
    (model,) = build_models(BLOCK, ("nonlinear",))
    one, other = (
        respond_many([model], [refined(1.0)], Runs.of(0, 0, polarity=sign)) for sign in (1, -1)
    )  # fmt: skip
    assert one.peak_rate_positive == pytest.approx(other.peak_rate_negative, rel=1e-9)
    assert one.peak_rate_positive != pytest.approx(other.peak_rate_positive, rel=1e-3)
    sizes = np.array([0.25, 1.0, 4.0])
    rates = respond_many([model], [None], Runs.of(0, 0, size=sizes), release=0.5).peak_rate
    np.testing.assert_allclose(rates, rates[1] / np.sqrt(sizes), rtol=1e-10)


def test_what_overturns_has_none_and_what_never_lifts_has_zero():
    (model,) = build_models(BLOCK, ("nonlinear",))
    found = respond_many([model], [refined(1.0)], Runs.of(0, 0, scale=[0.1, 1.0, 2.5]))
    assert found.fell.tolist() == [False, False, True]
    assert found.peak_rate[0] == 0 and found.peak_rate[1] > 0 and np.isnan(found.peak_rate[2])
    side = "peak_rate_positive" if found.fell_to[2] > 0 else "peak_rate_negative"
    assert np.isnan(getattr(found, side)[2])
