"""Shares of neighbours: against neighbours followed one by one, many more of them, and islands known exactly."""

from __future__ import annotations

import re

import numpy as np
import pytest

from rocking_cli.core import Direction, equivalent_block
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.history import respond
from rocking_cli.dynamics.model import build_model
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.excitation.records import read_record
from rocking_cli.structure import load_structure, parse_structure
from rocking_cli.studies.neighbours import Around, Neighbours, can_lift, governing, least_uplift, neighbours
from tests.conftest import EXAMPLES

BLOCK = parse_structure("mechanism: block\nwidth: 0.7\nheight: 2.8\n", "block", "block")
FRAME = load_structure(EXAMPLES / "frame.yaml")
ACCEL = read_record(EXAMPLES / "accel.csv")


def fate(mechanism, motion, factor, etas):
    """One neighbour by itself: its peak ratio, infinite if it overturns."""
    given = {"positive_to_negative": etas[0], "negative_to_positive": etas[1]}
    alone = type(mechanism).model_validate({**mechanism.model_dump(), "restitution": given})
    history = respond(alone, motion.scaled(factor), models=("nonlinear",))["nonlinear"]
    return np.inf if history.overturned else history.peak_ratio


class TestDraws:
    def test_factors_and_restitutions_are_uniform_and_not_correlated(self):
        around = Around(2000, 0.03, 0.01)
        model = build_model(FRAME, "nonlinear")
        factors, etas = around.factors(), around.etas(model)
        # A Latin hypercube: one number in each of 2000 equal parts.
        assert (np.sort(np.floor((factors - 0.97) / 0.06 * 2000).astype(int)) == np.arange(2000)).all()
        added = etas - np.array(model.eta)
        assert (np.sort(np.floor((added[:, 0] + 0.01) / 0.02 * 2000).astype(int)) == np.arange(2000)).all()
        np.testing.assert_allclose(added[:, 0], added[:, 1], atol=1e-15)
        assert abs(np.corrcoef(factors, added[:, 0])[0, 1]) < 0.1

    def test_they_are_the_same_every_time(self):
        assert Around().factors().tolist() == Around().factors().tolist()

    def test_restitution_stays_within_what_no_impact_exceeds(self):
        """That bound is 1 for a block, and the root of the ratio of the inertias at rest for a frame."""
        elastic = BLOCK.model_copy(update={"restitution": 0.995})
        etas = Around().etas(build_model(elastic, "nonlinear"))
        assert etas.max() == 1.0 and etas.min() == pytest.approx(0.975, abs=2e-4)
        inertia = {side: FRAME.kinetic_inertia(np.zeros(1), side)[0] for side in Direction}
        etas = Around(restitution=0.5).etas(build_model(FRAME, "nonlinear"))
        for column, side in enumerate(Direction):
            assert etas[:, column].max() == pytest.approx((inertia[side] / inertia[side.opposite]) ** 0.5, rel=1e-12)

    def test_restitution_stays_positive(self):
        dead = BLOCK.model_copy(update={"restitution": 0.01})
        assert Around().etas(build_model(dead, "nonlinear")).min() == 1e-3

    @pytest.mark.parametrize(
        "wrong", [{"count": -1}, {"count": 10**7}, {"amplitude": -0.1}, {"amplitude": 1.0}, {"restitution": np.nan}]
    )
    def test_wrong_numbers_are_refused(self, wrong):
        with pytest.raises(InputError, match="must be from 0"):
            Around(**wrong)


@pytest.mark.parametrize("mechanism", [BLOCK, FRAME], ids=["block", "frame"])
@pytest.mark.parametrize("scale", [0.6, 0.9])
def test_neighbours_are_what_each_would_be_alone(mechanism, scale):
    around = Around(30, 0.05, 0.03)
    model, motion = build_model(mechanism, "nonlinear"), ACCEL.scaled(scale)
    fates = np.array(
        [fate(mechanism, motion, *each) for each in zip(around.factors(), around.etas(model), strict=True)]
    )
    found = neighbours(model, motion, around)
    assert found.overturned == np.isinf(fates).mean()
    ranks = np.sort(fates)[[int(np.ceil(share * 30)) - 1 for share in (0.16, 0.5, 0.84)]]
    np.testing.assert_allclose(found.peak_ratio, ranks, rtol=1e-6)
    itself = respond(mechanism, motion, models=("nonlinear",))["nonlinear"].overturned
    assert found.as_itself == (np.isinf(fates) == itself).mean()
    assert found.sensitive == (found.as_itself < 0.9)


@pytest.mark.parametrize(
    ("file", "pulse"),
    [
        ("block", "sine:0.42g:0.9s"),
        ("block", "ricker:0.9g:0.6s"),
        ("frame", "mavroeidis:0.35g:2s:90:3"),
        ("arch", "sine:0.9g:1s"),
    ],
)
def test_two_hundred_tell_the_share_of_thousands(file, pulse):
    """On smooth cases and on fractal ones; independent samples would scatter by 3.5 % about a half."""
    model, motion = build_model(load_structure(EXAMPLES / f"{file}.yaml"), "nonlinear"), parse_pulse(pulse).sampled()
    few, many = (neighbours(model, motion, Around(count)) for count in (200, 2_500))
    assert few.overturned == pytest.approx(many.overturned, abs=3.5 * 0.035)


def test_the_share_of_a_linear_block_is_that_of_its_islands():
    """A linear block under a sine is solved exactly: the factors that overturn it are known, to the last island.

    Where boundaries cross the two per cent about an amplitude, the share of neighbours is the length of what lies
    between them.
    """
    period, half = 0.6, 0.02
    block = equivalent_block(BLOCK)
    model = build_model(BLOCK, "linear2")
    fine = np.linspace(2.0, 9.0, 70_001)
    falls = exact_many(block, Sine(1.0, period), fine, period, kappa=2, gravity=BLOCK.gravity).overturned
    edges = fine[1:][np.diff(falls.astype(np.int8)) != 0]
    assert len(edges) >= 1
    checked = 0
    for edge in edges:
        for amplitude in edge * np.array([0.985, 0.995, 1.01]):
            within = (fine > amplitude * (1 - half)) & (fine < amplitude * (1 + half))
            exact = falls[within].mean()
            motion = GroundMotion(
                "sine", period / 20_000, Sine(amplitude, period).acceleration(np.arange(20_001) * period / 20_000)
            )
            found = neighbours(model, motion, Around(1000, half, 0.0))
            # Each part of the range has one sample: the share is off by a part at each boundary.
            assert found.overturned == pytest.approx(exact, abs=3e-3)
            checked += 0.05 < exact < 0.95
    assert checked >= 2


class TestWithoutShaking:
    def test_nothing_is_followed_where_nothing_can_lift(self, monkeypatch):
        monkeypatch.setattr("rocking_cli.studies.neighbours.respond_many", None)
        found = neighbours(build_model(BLOCK, "nonlinear"), ACCEL.scaled(0.01))
        assert (found.overturned, found.peak_ratio, found.sensitive) == (0.0, (0.0, 0.0, 0.0), False)

    @pytest.mark.parametrize("off", [-1e-9, 1e-9])
    def test_the_least_factor_that_lifts(self, off):
        model = build_model(FRAME, "nonlinear")
        least = least_uplift(model, ACCEL)
        lifted = respond(FRAME, ACCEL.scaled(least * (1 + off)), models=("nonlinear",))["nonlinear"].lifted
        assert can_lift(model, ACCEL, least * (1 + off)) == (off > 0) == lifted

    def test_a_motion_that_pushes_to_one_side_only_lifts_to_that_side(self):
        push = GroundMotion("push", 0.1, np.array([0.0, 5.0, 0.0]))
        assert least_uplift(build_model(BLOCK, "nonlinear"), push) == pytest.approx(0.25 * BLOCK.gravity / 5.0)
        assert least_uplift(build_model(BLOCK, "nonlinear"), push.scaled(0)) is None

    def test_a_release_alone_has_neighbours_too(self):
        found = neighbours(build_model(BLOCK, "nonlinear"), None, release=0.5)
        expected = 0.5 * np.quantile(Around().factors(), (0.16, 0.5, 0.84), method="inverted_cdf")
        assert found.overturned == 0 and found.peak_ratio == pytest.approx(tuple(expected), rel=1e-9)

    @pytest.mark.parametrize("sign", [1, -1])
    def test_a_release_next_to_the_critical_rotation_falls_as_often_as_it_is_beyond_it(self, sign):
        found = neighbours(build_model(FRAME, "nonlinear"), None, release=0.99 * sign)
        assert found.overturned == (0.99 * Around().factors() > 1).mean() == pytest.approx(0.245, abs=0.01)


@pytest.mark.parametrize(
    ("off", "said"), [(1e-9, "No motion governs: one, other have the same effect."), (1e-4, "other governs: 40 %")]
)
def test_what_differs_by_rounding_does_not_govern(off, said):
    assert governing({"one": (0.4, np.inf, 0.5), "other": (0.4, np.inf, 0.5 * (1 + off))}).startswith(said)


NEAR = "(with amplitudes up to 2 % higher or lower and a coefficient of restitution up to 0.02 higher or lower)"


class TestWords:
    def test_where_nothing_can_lift_it(self):
        found = neighbours(build_model(BLOCK, "nonlinear"), parse_pulse("sine:0.1g:1s").sampled())
        assert str(found) == f"None of 200 neighbouring motions {NEAR} uplifts the structure."

    def sentence(self, overturned, peaks):
        return str(Neighbours(Around(), "nonlinear", overturned, peaks, 1.0))

    def test_a_share(self):
        said = self.sentence(0.43, (0.31, 0.52, np.inf))
        assert said == (
            f"Of 200 neighbouring motions {NEAR} 43 % overturn the structure; 16 % keep its peak rotation within 0.31 "
            "phi_cr, half within 0.52."
        )

    def test_most(self):
        assert self.sentence(0.7, (0.81, np.inf, np.inf)).endswith(
            " 70 % overturn the structure; 16 % keep its peak rotation within 0.81 phi_cr."
        )

    @pytest.mark.parametrize(
        ("peaks", "said"),
        [
            ((0.0, 0.0, 0.3), "; half do not uplift it, 84 % keep its peak rotation within 0.3 phi_cr."),
            (
                (0.0, 0.2, 0.3),
                "; 16 % do not uplift it, half keep its peak rotation within 0.2 phi_cr, 84 % within 0.3.",
            ),
            ((0.0, np.inf, np.inf), "; 16 % do not uplift it."),
        ],
    )
    def test_some_stay_where_they_are(self, peaks, said):
        assert self.sentence(0.1, peaks).endswith(said)

    def test_all_and_none(self):
        assert self.sentence(1.0, (np.inf,) * 3) == f"Of 200 neighbouring motions {NEAR} all overturn the structure."
        said = (
            "none overturns the structure; 16 % keep its peak rotation within 0.1 phi_cr, half within 0.2, 84 % within "
            "0.3."
        )
        assert self.sentence(0.0, (0.1, 0.2, 0.3)).endswith(said)
        assert self.sentence(0.0, (0.0, 0.0, 0.0)).endswith(
            "none overturns the structure; at most one in six uplifts it."
        )

    @pytest.mark.parametrize("scale", [0.3, 0.7, 0.8, 0.9, 1.1])
    def test_the_numbers_are_those_of_the_neighbours(self, scale):
        model, motion, around = build_model(BLOCK, "nonlinear"), ACCEL.scaled(scale), Around(400, 0.05)
        runs = Runs.of(0, 0, scale=around.factors(), eta=around.etas(model))
        fallen = respond_many([model], [motion], runs).overturned.mean()
        said = str(neighbours(model, motion, around))
        if not can_lift(model, motion, 1.05):
            assert said == f"None of 400 neighbouring motions ({around.words}) uplifts the structure." and fallen == 0
            return
        assert f"Of 400 neighbouring motions ({around.words})" in said
        share = re.search(r"\) ([\d.]+) % overturn", said)
        told = float(share[1]) / 100 if share else {"all": 1.0, "none": 0.0}[re.search(r"\) (all|none)", said)[1]]
        assert told == pytest.approx(fallen, abs=5e-4)
