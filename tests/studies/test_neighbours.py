"""Shares of neighbours: against neighbours followed one by one, many more of them, and islands known exactly."""

from dataclasses import replace
from math import exp, log

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

from rocking_cli.ask.read import read_record
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.studies.neighbours import (
    Draws,
    Neighbourhood,
    Neighbours,
    can_lift,
    least_uplift,
    neighbours,
    simulate_neighbours,
)
from rocking_cli.views.neighbours import neighbours_data, neighbours_in_words
from tests.conftest import EXAMPLES
from tests.following import build_model, conditions, respond

BLOCK = parse_structure("mechanism: block\nwidth: 0.7\nheight: 2.8\n", "block", "block")
FRAME = load_structure(EXAMPLES / "frame.yaml")
PORTAL = load_structure(EXAMPLES / "masonry" / "portal.yaml")
ACCEL = read_record(EXAMPLES / "accel.csv")


def alone(mechanism, motion, opening, amplitude, slender, etas):
    """The history of one neighbour by itself: the ground pushes the more slender the less, and lifts it as much."""
    given = {"positive_to_negative": etas[0], "negative_to_positive": etas[1]}
    single = type(mechanism).model_validate({**mechanism.model_dump(by_alias=True), "restitution": given})
    level = replace(motion, vertical=None).scaled(amplitude / slender)
    up = motion.vertical and motion.vertical.scaled(amplitude)
    return respond(single, replace(level, vertical=up), opening, models=("nonlinear",))["nonlinear"]


def fate(history):
    """Its peak ratio, infinite if it overturns or its outcome is unknown."""
    return np.inf if history.fell or history.unknown else history.peak_ratio


def one_in_each(uniform):
    """Whether there is one number in each of as many equal parts, as in a Latin hypercube."""
    return (np.sort(np.floor(uniform * uniform.size).astype(int)) == np.arange(uniform.size)).all()


class TestDraws:
    def test_they_are_lognormal_and_truncated_normal_and_not_correlated(self):
        drawn = Neighbourhood(2000, 0.03, 0.01, 0.08).drawn(build_model(FRAME, "nonlinear"))
        uniform = [ndtr(np.log(drawn.amplitude) / 0.03), ndtr(np.log(drawn.slender) / 0.08)]
        inertia = {side: FRAME.kinetic_inertia(np.zeros(1), side)[0] for side in Direction}
        for column, side in enumerate(Direction):
            eta, most = FRAME.eta(side), (inertia[side] / inertia[side.opposite]) ** 0.5
            uniform.append(ndtr((drawn.eta[:, column] - eta) / 0.01) / ndtr((most - eta) / 0.01))
        assert all(one_in_each(each) for each in uniform)
        np.testing.assert_allclose(uniform[2], uniform[3], atol=1e-12)  # of both directions the same
        assert (abs(np.corrcoef(uniform[:3])[np.triu_indices(3, 1)]) < 0.1).all()

    def test_restitution_is_drawn_again_above_what_no_impact_exceeds(self):
        """That bound is 1 for a block, and the root of the ratio of the inertias at rest for a frame."""
        elastic = BLOCK.model_copy(update={"restitution": 0.995})
        etas = Neighbourhood().drawn(build_model(elastic, "nonlinear")).eta
        assert 0.9995 < etas.max() < 1.0
        # Half a normal distribution, and a little more: none of those above 1 is put at 1.
        assert np.median(etas) == pytest.approx(0.995 + 0.03 * ndtri(0.5 * ndtr(0.005 / 0.03)), abs=2e-4)
        inertia = {side: FRAME.kinetic_inertia(np.zeros(1), side)[0] for side in Direction}
        etas = Neighbourhood(restitution=0.5).drawn(build_model(FRAME, "nonlinear")).eta
        for column, side in enumerate(Direction):
            most = (inertia[side] / inertia[side.opposite]) ** 0.5
            assert most - 0.01 < etas[:, column].max() < most
            share = ndtr((most - FRAME.eta(side)) / 0.5)
            assert np.median(etas[:, column]) == pytest.approx(FRAME.eta(side) + 0.5 * ndtri(share / 2), abs=5e-3)

    def test_restitution_stays_positive(self):
        dead = BLOCK.model_copy(update={"restitution": 0.01})
        etas = Neighbourhood().drawn(build_model(dead, "nonlinear")).eta[:, 0]
        assert etas.min() == 1e-3
        assert (etas == 1e-3).mean() == pytest.approx(ndtr((1e-3 - 0.01) / 0.03), abs=0.01)

    def test_deviations_of_nothing_are_the_structure_itself(self):
        model = build_model(FRAME, "nonlinear")
        drawn = Neighbourhood(7, 0.0, 0.0, 0.0).drawn(model)
        assert drawn.amplitude.tolist() == drawn.slender.tolist() == [1.0] * 7
        assert drawn.eta.tolist() == [list(model.eta)] * 7

    @pytest.mark.parametrize(
        "wrong",
        [
            {"count": -1}, {"count": 10**7}, {"amplitude": -0.1}, {"amplitude": 1.0}, {"restitution": np.nan},
            {"slenderness": -0.1}, {"slenderness": 1.0},
        ],
    )  # fmt: skip
    def test_wrong_numbers_are_refused(self, wrong):
        with pytest.raises(InputError, match="must be from 0"):
            Neighbourhood(**wrong)


LIFTED = replace(ACCEL, vertical=GroundMotion("up", 0.02, 4.0 * np.sin(np.arange(500) * 0.7), unit="m/s2"))


@pytest.mark.every(6)
@pytest.mark.parametrize("motion", [ACCEL, LIFTED], ids=["level", "vertical"])
@pytest.mark.parametrize("mechanism", [BLOCK, FRAME], ids=["block", "frame"])
@pytest.mark.parametrize("scale", [0.6, 0.9])
def test_neighbours_are_what_each_would_be_alone(mechanism, scale, motion):
    around = Neighbourhood(12, 0.05, 0.03, 0.08)
    opening = 1.0  # joints feel the ground as it is: see below
    model, motion = build_model(mechanism, "nonlinear", opening), motion.scaled(scale)
    drawn = zip(*around.drawn(model), strict=True)
    fates = np.array([fate(alone(mechanism, motion, opening, *each)) for each in drawn])
    found = neighbours(conditions(mechanism, around, opening), motion)
    assert found.overturned == np.isinf(fates).mean()
    assert found.unknown == 0
    ranks = np.sort(fates)[[int(np.ceil(share * 12)) - 1 for share in (0.16, 0.5, 0.84)]]
    np.testing.assert_allclose(found.peak_ratio, ranks, rtol=1e-6)
    itself = respond(mechanism, motion, opening, models=("nonlinear",))["nonlinear"].fell
    assert found.as_itself == (np.isinf(fates) == itself).mean()
    assert found.sensitive == (found.as_itself < 0.9)


@pytest.mark.parametrize(
    ("file", "opening", "scale", "some", "fell"),
    [
        pytest.param("arch", 0.005, 1.1, 0.6, 0.0, marks=pytest.mark.rest),
        ("wall", 0.0, 2.5, 0.3, 0.3),
    ],
)
def test_neighbours_of_unknown_outcome_are_what_each_would_be_alone(file, opening, scale, some, fell):
    structure = load_structure(EXAMPLES / f"{file}.yaml")
    around, motion = Neighbourhood(20, 0.1, 0.03, 0.0), ACCEL.scaled(scale)
    model = build_model(structure, "nonlinear", opening)
    histories = [alone(structure, motion, opening, *each) for each in zip(*around.drawn(model), strict=True)]
    found = neighbours(conditions(structure, around, opening), motion)
    assert found.unknown == np.mean([each.unknown for each in histories]) and some <= found.unknown < 1
    assert found.overturned == np.mean([each.fell for each in histories]) >= fell
    assert found.at_most == pytest.approx(np.mean([np.isinf(fate(each)) for each in histories]), abs=1e-12)
    ranks = np.sort([fate(each) for each in histories])[[int(np.ceil(share * 20)) - 1 for share in (0.16, 0.5, 0.84)]]
    np.testing.assert_allclose(found.peak_ratio, ranks, rtol=1e-6)
    itself = respond(structure, motion, opening, models=("nonlinear",))["nonlinear"]
    assert found.as_itself == np.mean([each.words == itself.words for each in histories])


def test_nothing_is_known_of_joints_that_the_mechanism_does_not_name():
    found = neighbours(conditions(load_structure(EXAMPLES / "curve.yaml"), Neighbourhood(5)), ACCEL)
    assert found.unknown is None and found.at_most == found.overturned


def test_nor_where_nothing_can_lift_it():
    faint = ACCEL.scaled(0.01)
    for structure, unknown in ((load_structure(EXAMPLES / "curve.yaml"), None), (BLOCK, 0.0)):
        found = neighbours(conditions(structure, Neighbourhood(5)), faint)
        assert not found.lifted and found.unknown == unknown == neighbours_data(found)["unknown"]
        assert found.at_most == found.overturned == 0


@pytest.mark.rest
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
    structure, motion = load_structure(EXAMPLES / f"{file}.yaml"), parse_pulse(pulse).sampled()
    few, many = (neighbours(conditions(structure, Neighbourhood(count)), motion) for count in (200, 2_500))
    assert few.overturned == pytest.approx(many.overturned, abs=3.5 * 0.035)
    assert few.unknown == pytest.approx(many.unknown, abs=3.5 * 0.035)


@pytest.mark.every(2)
@pytest.mark.parametrize("varied", ["amplitude", "slenderness"])
def test_the_share_of_a_linear_block_is_that_of_its_islands(varied):
    """A linear block under a sine is solved exactly: the factors that overturn it are known, to the last island.

    Near boundaries, the share of neighbours is the lognormal probability of what lies between them; that of a more
    slender block is the same, as its motion is that under a weaker ground motion.
    """
    period, deviation = 0.6, 0.01
    block = equivalent_block(BLOCK)
    fine = np.linspace(2.0, 9.0, 70_001)
    falls = exact_many(block, Sine(1.0, period), fine, period, kappa=2, gravity=BLOCK.gravity).fell
    edges = fine[1:][np.diff(falls.astype(np.int8)) != 0]
    assert len(edges) >= 1
    checked = 0
    for edge in edges:
        for amplitude in edge * np.array([0.985, 0.995, 1.01]):
            below = ndtr(np.log(fine / amplitude) / deviation)
            assert below[0] < 1e-6 and below[-1] > 1 - 1e-6
            exact = np.diff(below)[falls[1:]].sum()
            dt = period / 2000
            motion = GroundMotion("sine", dt, Sine(amplitude, period).acceleration(np.arange(2001) * dt), unit="m/s2")
            deviations = {"amplitude": 0.0, "restitution": 0.0, "slenderness": 0.0, varied: deviation}
            found = neighbours(conditions(BLOCK, Neighbourhood(1000, **deviations), model="linear2"), motion)
            # Each part of the range has one sample: the share is off by a part at each boundary.
            assert found.overturned == pytest.approx(exact, abs=3e-3)
            checked += 0.05 < exact < 0.95
    assert checked >= 2


class TestWithoutShaking:
    def test_nothing_is_followed_where_nothing_can_lift(self, monkeypatch):
        monkeypatch.setattr("rocking_cli.studies.engines.exact.respond_many", None)
        found = neighbours(conditions(BLOCK), ACCEL.scaled(0.01))
        assert (found.overturned, found.peak_ratio, found.sensitive) == (0.0, (0.0, 0.0, 0.0), False)

    @pytest.mark.parametrize("off", [-1e-9, 1e-9])
    def test_the_least_factor_that_lifts(self, off):
        model = build_model(FRAME, "nonlinear")
        least = least_uplift(model, ACCEL)
        lifted = respond(FRAME, ACCEL.scaled(least * (1 + off)), models=("nonlinear",))["nonlinear"].lifted
        assert can_lift(model, ACCEL, least * (1 + off)) == (off > 0) == lifted

    @pytest.mark.parametrize("off", [-1e-9, 1e-9])
    def test_the_neighbour_that_lifts_first_decides(self, off):
        model = build_model(BLOCK, "nonlinear")
        drawn = Neighbourhood().drawn(model)
        first = ACCEL.scaled(least_uplift(model, ACCEL) / (drawn.amplitude / drawn.slender).max())
        assert not can_lift(model, first, 1.2)
        assert neighbours(conditions(BLOCK), first.scaled(1 + off)).lifted == (off > 0)

    def test_a_release_by_an_angle_is_more_to_the_more_slender(self):
        found = neighbours(conditions(BLOCK, release=0.5, release_is_angle=True), None)
        expected = [0.5 * exp(0.1 * ndtri(share)) for share in (0.16, 0.5, 0.84)]
        assert found.overturned == 0 and found.peak_ratio == pytest.approx(tuple(expected), rel=2e-3)

    def test_a_release_by_an_angle_is_divided_by_the_slenderness_that_the_push_is_divided_by(self):
        """Each neighbour, tilted and pushed, is one of its own: both by the same k."""
        model, around = build_model(BLOCK, "nonlinear"), Neighbourhood(40, restitution=0.0)
        drawn, tilt = around.drawn(model), 0.6
        push = GroundMotion("push", 0.01, np.append(-0.11 * STANDARD_GRAVITY * np.ones(60), np.zeros(5)), unit="m/s2")
        found = neighbours(conditions(BLOCK, around, release=tilt, release_is_angle=True), push)
        alone = [
            simulate_neighbours(model, push, Draws(*(each[k : k + 1] for each in drawn)), release=tilt / k_e).fell[0]
            for k, k_e in enumerate(drawn.slender)
        ]
        assert 0.1 < np.mean(alone) < 0.9 and found.overturned == np.mean(alone)

    @pytest.mark.parametrize("sign", [1, -1])
    def test_a_release_next_to_the_critical_rotation_falls_as_often_as_it_is_beyond_it(self, sign):
        model = build_model(FRAME, "nonlinear")
        dull = Neighbourhood(restitution=0.0)
        found = neighbours(conditions(FRAME, dull, release=0.99 * sign, release_is_angle=True), None)
        assert found.overturned == (dull.drawn(model).slender < 0.99).mean()
        assert found.overturned == pytest.approx(ndtr(log(0.99) / 0.10), abs=0.01)
        assert neighbours(conditions(FRAME, dull, release=0.99 * sign), None).overturned == 0


NEAR = " (standard deviations 4 % of amplitude, 10 % of slenderness, 0.05 of restitution)."
OPEN = (0.1, np.inf, np.inf)


class TestWords:
    def test_where_nothing_can_lift_it(self):
        found = neighbours(conditions(BLOCK), parse_pulse("sine:0.1g:1s").sampled())
        assert neighbours_in_words(found) == f"None of 200 neighbouring motions uplifts the structure{NEAR}"

    def sentence(self, overturned, peaks, unknown=0.0):
        around = Neighbourhood(restitution=0.05, slenderness=0.10)
        return neighbours_in_words(Neighbours(around, "nonlinear", overturned, peaks, 1.0, unknown=unknown))

    @pytest.mark.parametrize(
        ("as_itself", "unknown", "sensitive"),
        [(0.89, 0.0, True), (0.9, 0.0, False), (0.9, 0.1, False), (0.85, 0.05, None), (0.5, 0.2, True),
         (0.995, 0.995, None), (0.005, 0.995, None), (0.8, None, True)],
    )  # fmt: skip
    def test_an_outcome_is_sensitive_only_where_unknown_neighbours_do_not_leave_it_open(
        self, as_itself, unknown, sensitive
    ):
        found = Neighbours(Neighbourhood(200), "nonlinear", 0.0, OPEN, as_itself, unknown=unknown)
        assert found.sensitive is sensitive

    @pytest.mark.parametrize("unknown", [0.0, 0.25, None])
    def test_data_have_no_peak_where_a_neighbour_overturns_or_is_unknown(self, unknown):
        slips = np.repeat([0.02, np.inf], [5, 15])
        found = Neighbours(Neighbourhood(20), "nonlinear", 0.3, OPEN, 0.85, unknown=unknown, slips=slips)
        data = neighbours_data(found)
        assert data["peak_ratio"] == {"16": 0.1, "50": None, "84": None}
        assert data["slip"] == {"16": 0.02, "50": None, "84": None}
        assert (data["overturned"], data["unknown"], data["sensitive"]) == (0.3, unknown, None if unknown else True)

    @pytest.mark.parametrize(
        ("overturned", "unknown", "peaks", "said"),
        [
            (0.43, 0.0, (0.31, 0.52, np.inf), "86 (43 %) overturn the structure; the median peak is 0.52 phi_cr."),
            (0.7, 0.0, (0.81, np.inf, np.inf), "140 (70 %) overturn the structure; 16 % stay below 0.81 phi_cr."),
            (0.1, 0.0, (0.0, 0.0, 0.3), "; half do not uplift it; 84 % stay below 0.3 phi_cr."),
            (0.1, 0.0, (0.0, 0.2, np.inf), "; 16 % do not uplift it; the median peak is 0.2 phi_cr."),
            (1.0, 0.0, (np.inf,) * 3, "all overturn the structure."),
            (0.0, 0.0, (0.0, 0.0, 0.0), "none overturns the structure; at most one in six uplifts it."),
            (0.4, 0.1, OPEN, "80 (40 %) overturn the structure, and the outcome under 20 (10 %) is unknown; 16 %"),
            (0.005, 0.0, OPEN, "1 (0.5 %) overturns the structure; 16 % stay below 0.1 phi_cr."),
            (0.0, 0.25, OPEN, "none is known to overturn the structure, and the outcome under 50 (25 %) is unknown"),
            (0.0, 1.0, OPEN, "none is known to overturn the structure, and the outcome under all is unknown"),
            (0.4, None, OPEN, "80 (40 %) overturn the structure; 16 %"),
            (0.1, 0.0, (0.3, 0.6, 1.0), "; 84 % stay below 1 phi_cr."),
            (0.1, 0.0, (0.3, 0.6, 1.1), "; 16 % pass the critical rotation (1.1 phi_cr) or overturn."),
            (0.1, 0.1, (0.3, 0.6, 1.1), "; 16 % pass the critical rotation (1.1 phi_cr) or overturn or are unknown."),
            (0.7, 0.0, (1.2, np.inf, np.inf), "; 84 % pass the critical rotation (1.2 phi_cr) or overturn."),
        ],
    )
    def test_shares_and_peaks(self, overturned, unknown, peaks, said):
        words = self.sentence(overturned, peaks, unknown)
        assert words.startswith("Of 200 neighbouring motions, ") and words.endswith(NEAR)
        assert (f"{said[:-1]}{NEAR}" if said.endswith(".") else said) in words
        assert "unknown" in said or "unknown" not in words


@pytest.mark.parametrize(("friction", "unknown"), [(0.1, False), (0.21, True)])
def test_what_no_slenderness_leaves_standing_overturns_for_certain(friction, unknown):
    """Of two neighbours that slide one has no slenderness left: it has overturned, and its outcome is not unknown.

    That of the other is unknown unless it only slides, with less friction than .2.
    """
    block = parse_structure(f"mechanism: block\nwidth: 1\nheight: 5\nfriction: {friction}\n", "block", "block")
    model = build_model(block, "nonlinear")
    draws = Draws(np.ones(2), np.array([-0.1, 1.0]), np.full((2, 2), np.nan))
    found = simulate_neighbours(model, ACCEL, draws)
    assert found.fell.tolist() == [True, False] and found.unknown.tolist() == [False, unknown]
    assert np.isnan(found.peak_ratio[0]) and (found.slip > 0).tolist() == [False, not unknown]
