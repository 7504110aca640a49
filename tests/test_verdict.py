"""The words say what the histories did."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mechanisms.block import Block
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import Outcome, respond
from rocking_cli.dynamics.verdict import verdict

RESTED = respond(Block(width=0.7, height=2.8), release=0.4, models=("nonlinear",))["nonlinear"]


def peak(ratio):
    return replace(RESTED, peak_ratio=ratio)


def fell(direction):
    return replace(RESTED, outcome=Outcome.OVERTURNED, peak_ratio=None, fell_to=direction)


@pytest.mark.parametrize(
    ("histories", "words", "not_said"),
    [
        ({"nonlinear": peak(0.0), "linear2": peak(0.0)}, "does not uplift", "Far"),
        ({"nonlinear": peak(0.0), "linear1": peak(0.3)}, "uplift. Far from the nonlinear model: linear1", "rocks"),
        ({"nonlinear": peak(0.4), "linear1": peak(0.45)}, "rocks to 0.4 of", "Far"),
        ({"nonlinear": peak(0.4), "linear1": peak(0.6)}, "Far from the nonlinear model: linear1 (0.6)", "close"),
        ({"linear2": peak(0.9)}, "rocks to 0.9 of its critical rotation and does not overturn. That is close", "Far"),
        ({"nonlinear": peak(1.75)}, "passes its critical rotation, to 1.75 of it, and is brought back", "rocks to"),
        ({"nonlinear": fell(Direction.POSITIVE)}, "The structure overturns clockwise.", "disagree"),
        (
            {"nonlinear": fell(Direction.POSITIVE), "linear1": fell(Direction.NEGATIVE)},
            "disagree which way (nonlinear clockwise, linear1 anticlockwise)", "only",
        ),
        ({"nonlinear": peak(0.9), "linear1": fell(Direction.POSITIVE)}, "overturns by linear1 only", "rocks to"),
        ({"nonlinear": replace(peak(0.4), outcome=Outcome.STILL_ROCKING)}, "nonlinear: still rocking", "overturns"),
    ],
)  # fmt: skip
def test_the_verdict_says_what_happened(histories, words, not_said):
    said = verdict(histories)
    assert words in said
    assert not_said not in said
