"""What a row of a survey says of several motions: which overturn it, of which the outcome is unknown, and the worst."""

from math import nan
from types import SimpleNamespace

import numpy as np
import pytest

from rocking_cli.questions.survey.study import Survey, Surveyed, SurveyResponse, _of_one
from rocking_cli.questions.survey.view import counts
from rocking_cli.studies.conclusion import Concluded
from tests.dynamics.test_outcomes import made

MOTIONS = [SimpleNamespace(name=name) for name in "abc"]
RECORD = np.array([0, 0, 1, 1, 2, 2])  # each in two polarities


def of_one(joints="known", ratio=(0.1, 0.2, 0.5, 0.3, 0.4, 0.1), **flags):
    usual = {"fell_to": [0] * 6, "unknown": [False] * 6, "failed": [False] * 6, "peak_ratio": list(ratio)}
    model = SimpleNamespace(joints=joints if joints == "known" else None, ends_at_limit=(False, False), structure="s")
    return _of_one(model, np.ones(6, bool), RECORD, made(**usual | flags), MOTIONS)


@pytest.mark.parametrize(
    ("flags", "overturned", "unknown", "peak", "worst", "concluded"),
    [
        ({}, 0, 0, 0.5, "b", Concluded.ROCKS),
        ({"fell_to": [0, 0, 0, 0, 0, -1]}, 1 / 3, 0, 0.5, "c", Concluded.OVERTURNS),
        ({"unknown": [False] * 5 + [True]}, 0, 1 / 3, 0.5, "c", Concluded.UNKNOWN),
        ({"unknown": [False, False, True, False, False, False]}, 0, 1 / 3, 0.4, "b", Concluded.UNKNOWN),
        # A polarity that overturns it decides, whatever the other one would do.
        ({"fell_to": [0, 0, 0, 1, 0, 0], "unknown": [False, False, True, False, True, False]},
         1 / 3, 1 / 3, 0.2, "b", Concluded.OVERTURNS),
        ({"unknown": [True] * 6}, 0, 1, nan, "a", Concluded.UNKNOWN),
    ],
)  # fmt: skip
def test_the_worse_polarity_of_each_motion_counts(flags, overturned, unknown, peak, worst, concluded):
    found = of_one(**flags)
    numbers = found.overturned, found.unknown, found.peak_ratio
    assert numbers == pytest.approx((overturned, unknown, peak), nan_ok=True)
    assert (found.worst, found.concluded) == (worst, concluded)
    assert found.at_most == pytest.approx(overturned + unknown)


def test_without_joints_it_is_null_but_for_outcomes_that_are_unknown_all_the_same():
    """Without weight no outcome is known, whatever is known of the joints."""
    assert of_one(joints="not known").unknown is None
    assert of_one(joints="not known", unknown=[True] + [False] * 5).unknown == pytest.approx(1 / 3)


def test_a_structure_is_counted_once_as_overturning_or_as_one_that_may():
    rows = [
        Surveyed(1, 2, name, "arch", "positive", 0.2, 0.2, 2.0, 0.1, 1.0, 1.0, 0.9, under=SurveyResponse(*under))
        for name, under in (
            ("falls or may", (0.3, 0.2, "a", "phi_cr", 0.3)), ("may", (0.0, 0.2, "a", "phi_cr", 0.3)),
            ("rocks", (0.0, 0.2, "a", "phi_cr", 0.0)), ("rests", (0.0, 0.0, "a", "phi_cr", None)),
        )
    ]  # fmt: skip
    (said,) = counts(Survey(rows, motions=["a", "b", "c"], by="response"))
    assert said.endswith("and 3 uplift. falls or may ranks first.")
    assert "1 of 4 structures overturns, 1 may overturn" in said
