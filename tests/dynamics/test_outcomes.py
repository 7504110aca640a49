"""What is said of a run by what the kernel noted of it: the rule of until when, on moments of our own."""

from dataclasses import replace
from math import inf, isnan
from types import SimpleNamespace

import numpy as np
import pytest

from mechanisms.block import Block
from rocking_cli.dynamics import kernels, openings, stepping
from rocking_cli.dynamics.deck import lay_out, read_marks
from rocking_cli.dynamics.joints import check_of
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, Outcome
from rocking_cli.dynamics.verdict import disagree, known_until, peak_time, remedy
from rocking_cli.excitation.base import GroundMotion
from tests.following import build_model, respond

NEVER = float("nan")
PHI_CR = 0.2, 0.4
REACH = 0.5
BLOCK = Block(width=0.7, height=2.8)


def read(status=kernels.AT_REST, side=0, **noted):
    """The outcome of one run: peaks of .1 and .3 rad, two impacts, uplift at 1 s and an end at 9 s unless noted."""
    marks = np.full((1, stepping.MARKS), NEVER)
    usual = {"FIRST_UPLIFT": 1.0, "IMPACTS": 2, "ENDED": 9.0, "LARGEST": 0.001}
    for name, value in (usual | noted).items():
        marks[0, getattr(stepping if hasattr(stepping, name) else openings, name)] = value
    marks[0, [stepping.STATUS, stepping.SIDE]] = status, side
    marks[0, stepping.PEAK : stepping.PEAK + 2] = 0.1, 0.3
    marks[0, stepping.RATE_PEAK : stepping.RATE_PEAK + 2] = 0.7, 0.6
    if "PASSED" in noted:
        marks[0, openings.PASSED_PEAK : openings.PASSED_PEAK + 2] = 0.05, 0.04
        marks[0, openings.PASSED_IMPACTS] = 1
    if "WARNED" in noted:
        marks[0, openings.WARNED_PEAK : openings.WARNED_PEAK + 2] = 0.02, 0.06
    return read_marks(marks, np.array([PHI_CR]), np.array([REACH])).by_field(lambda values: values[0])


def made(**fields):
    """Outcomes of which all is known, but for what is given."""
    many = len(next(iter(fields.values())))
    flags = {"still_rocking", "failed", "unknown"}
    usual = {
        name: name not in flags and (0 if name in ("fell_to", "impact_count") else np.nan) for name in OUTCOME_FIELDS
    }
    return Outcome(**{name: np.array(fields.get(name, [value] * many)) for name, value in usual.items()})


def test_of_a_run_that_is_known_all_is_said():
    found = read()
    assert not found.unknown and isnan(found.known_to) and isnan(found.warned) and isnan(found.lower_bound)
    assert (found.peak_positive, found.peak_negative, found.peak_ratio) == pytest.approx((0.1, 0.3, 0.75))
    assert (found.peak_rate_positive, found.peak_rate_negative, found.peak_rate) == (0.7, 0.6, 0.7)
    assert (found.uplift_time, found.impact_count, found.end_time, found.opening) == (1.0, 2, 9.0, 0.002)
    assert found.at_rest and found.lifted and found.fell_to == 0 and isnan(found.overturning_time)


def test_of_a_run_that_is_not_all_is_until_the_moment_at_which_a_joint_passes_its_limit():
    found = read(PASSED=3.0, WARNED=2.0)
    assert found.unknown and found.known_to == 3.0 and found.warned == 2.0 and found.impact_count == 1
    assert (found.peak_positive, found.peak_negative, found.peak_ratio) == pytest.approx((0.05, 0.04, 0.25))
    assert found.lower_bound == pytest.approx(0.15)  # of .02 and .06 rad, over .2 and .4
    assert isnan(found.end_time) and found.uplift_time == 1.0
    assert not found.at_rest and not found.still_rocking and found.overturned is None
    assert "unknown" in found.words


def test_without_a_warning_before_it_the_bound_is_the_peak_until_then():
    for noted in ({}, {"WARNED": 3.5}):
        found = read(PASSED=3.0, **noted)
        assert isnan(found.warned) and found.lower_bound == pytest.approx(0.25)
    assert read(PASSED=3.0, WARNED=3.0).warned == 3.0  # at the same moment


def test_what_lifts_only_later_is_not_known_to_lift():
    assert isnan(read(PASSED=0.9).uplift_time) and read(PASSED=1.0).uplift_time == 1.0


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize(("passed", "falls"), [(None, True), (5.0, True), (4.0, True), (3.9, False)])
def test_overturning_is_known_if_it_is_past_its_critical_rotation_before_a_joint_passes(side, passed, falls):
    noted = {} if passed is None else {"PASSED": passed}
    found = read(kernels.OVERTURNED, side, CROSSED=4.0, **noted)
    assert (bool(found.fell), bool(found.unknown)) == (falls, not falls)
    assert found.fell_to == (1 - 2 * side if falls else 0)
    peaks = found.peak_positive, found.peak_negative
    assert [isnan(peak) for peak in peaks] == [falls and side == 0, falls and side == 1]
    rates = found.peak_rate_positive, found.peak_rate_negative
    assert [isnan(rate) for rate in rates] == [isnan(peak) for peak in peaks] and isnan(found.peak_rate) == falls
    assert (found.overturning_time == 4.0) == isnan(found.peak_ratio) == falls
    assert (found.end_time == 9.0) == falls == (found.impact_count == 2) == isnan(found.known_to)


def test_a_release_beyond_it_falls_unless_a_joint_passes():
    """It never crosses phi_cr, as it starts there: what passes, passes before."""
    assert read(kernels.OVERTURNED).fell
    assert not read(kernels.OVERTURNED, PASSED=0.1).fell


def test_what_failed_or_never_ran_is_neither_known_nor_unknown():
    for status in (kernels.STALLED, NEVER):
        found = read(status, PASSED=3.0)
        assert found.failed and not found.unknown and isnan(found.known_to) and found.overturned is None
        assert not found.at_rest


def test_still_rocking_is_said_only_of_what_is_known():
    assert read(kernels.STILL_ROCKING).still_rocking and not read(kernels.STILL_ROCKING).at_rest
    assert not read(kernels.STILL_ROCKING, PASSED=3.0).still_rocking


@pytest.mark.parametrize("known", [True, False])
def test_the_joints_say_what_happened_to_them_or_that_nothing_did(known):
    """A block has one joint, with the ground, and none that stays closed while it rocks."""
    model = build_model(BLOCK, "nonlinear")
    marks = np.full(stepping.MARKS, NEVER)
    marks[[openings.LARGEST, openings.LONGEST]] = 0.0
    if not known:
        marks[[openings.PASSED, openings.REASON, openings.WHERE, openings.WARNED, openings.WARNED_WHERE]] = (
            3,
            1,
            0,
            2,
            0,
        )
    found = check_of(model.joints, marks, NEVER)
    assert (found.reason, found.passed, found.warned) == pytest.approx(
        (None, NEVER, NEVER) if known else ("slides", 3.0, 2.0), nan_ok=True
    )
    assert (found.joint == found.warned_joint == "") == known
    assert found.parted is None and found.parted_joint == "" and found.count == 1
    assert check_of(None, marks, NEVER) is None
    later = check_of(model.joints, marks, 2.5)  # after overturning nothing is said of joints
    assert isnan(later.passed) and later.reason is None and (later.warned == 2.0) != known


def test_a_tendon_that_leaves_no_critical_rotation_leaves_the_limit_to_compare_with():
    """It pulls the harder the further the column leans: nothing but the end of its motion overturns it."""
    tendon = {"name": "tendon", "from": {"ground": [0.0, 0.0]}, "to": {"at": [0.0, 2.8]}, "stiffness": 1e9}
    tied = Block(width=0.7, height=2.8, density=2000.0, depth=1.0, ties=[tendon])
    assert build_model(BLOCK, "nonlinear").ends_at_limit == (False, False)
    assert build_model(tied, "nonlinear").ends_at_limit == (True, True)
    history = respond(tied, release=0.4, models=("nonlinear",))["nonlinear"]
    assert history.reference == "kinematic limit" and run().reference == "critical rotation"


# --- of many runs no sum and no mean drops the unknown


def test_overturned_is_nan_where_it_is_not_known_and_the_share_is_a_range():
    found = made(fell_to=[1, 0, -1, 0, 0], unknown=[False, True, False, False, False], failed=[False] * 4 + [True])
    np.testing.assert_array_equal(found.overturned, [1.0, np.nan, 1.0, 0.0, np.nan])
    assert found.fell.tolist() == [True, False, True, False, False]
    assert np.isnan(found.overturned.sum()) and np.isnan(found.overturned.mean())
    assert found.share() == (0.5, 0.75)  # of the four that ran
    assert np.isnan(made(failed=[True]).share()).all()


def test_of_one_motion_it_is_yes_no_or_none():
    found = made(fell_to=[-1, 0, 0, 0], unknown=[False, False, True, False], failed=[False] * 3 + [True])
    single = [found.by_field(lambda each, k=k: each[k]).overturned for k in range(4)]
    assert single == [True, False, None, None]


# --- several histories of one structure


def run(known_to=None, **fields):
    """A block let go, which rocks until it rests, but for what is given."""
    rested = respond(BLOCK, release=0.4, models=("nonlinear",))["nonlinear"]
    known = {"unknown": known_to is not None, "known_to": NEVER if known_to is None else known_to}
    return replace(rested, **{"check": None} | known | fields)


def test_they_are_known_until_the_first_is_not_but_for_free_blocks():
    assert known_until({"nonlinear": run(), "linear1": run()}) == inf
    assert known_until({"nonlinear": run(3.0), "linear1": run(2.0), "linear2": run()}) == 2.0
    assert known_until({"nonlinear": run(3.0), "blocks": run()}) == inf


@pytest.mark.parametrize(
    ("others", "expected"),
    [
        ({"linear1": run(fell_to=1)}, True), ({"linear1": run()}, False),
        ({"linear1": run(fell_to=1, uplift_error=0.3)}, False),  # unfit for the structure
        ({"linear1": run(2.0, fell_to=1)}, False),
    ],
)  # fmt: skip
def test_models_disagree_if_they_are_fit_and_known(others, expected):
    assert disagree({"nonlinear": run(), **others}) is expected


def test_the_remedy_is_that_of_the_joint_and_of_none_where_no_joint_is_to_blame():
    def at(reason, alone=False, **fields):
        return remedy(run(2.0, check=SimpleNamespace(reason=reason, alone=alone), **fields))

    assert (at("slides"), at("slides", alone=True)) == ("hold_joint", "hold_joint")
    assert (at("opens"), at("opens", alone=True)) == ("hinge_at_joint", "assume_overturning")
    assert at("crushes") == at("weightless") == at("slides", apart=True) == "assume_overturning"
    assert remedy(run(2.0)) == "assume_overturning"


def test_the_peak_is_had_at_the_first_sample_that_is_as_large_but_for_rounding():
    for second, first in ((1.0005, True), (1.0015, False)):
        ratio = np.zeros(10)
        ratio[[3, 7]] = -0.5, 0.5 * second
        assert peak_time(run(ratio=ratio, time=np.arange(10.0))) == (3.0 if first else 7.0)


# --- what is still to come of a motion


def test_the_strongest_to_come_is_that_of_both_senses_and_of_the_vertical_one_by_sense():
    """Of samples of .01 s, and vertical ones of .005 s: from each on, the last not counted, as nothing follows it."""
    up = GroundMotion("up", 0.005, np.array([0.0, 1.0, -4.0, 2.0, -1.0, 3.0, 0.5]), unit="m/s2")
    motion = GroundMotion("push", 0.01, np.array([1.0, -5.0, 2.0, -3.0]), vertical=up, unit="m/s2")
    deck = lay_out([build_model(BLOCK, "nonlinear")], [motion])
    assert deck.ahead.tolist() == [5.0, 5.0, 3.0, 0.0]
    assert deck.v_ahead.tolist() == [4.0, 4.0, 1.0, 0.0]  # downwards, at 0, 2, 4 and 6 vertical samples
    assert deck.v_above.tolist() == [3.0, 3.0, 3.0, 0.0]
