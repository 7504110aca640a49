"""The picture of a response shows what happened."""

from __future__ import annotations

import numpy as np
import pytest

from mechanisms.block import Block
from rocking_cli.dynamics.history import respond
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.plotting.history import draw_history

BLOCK = Block(width=0.7, height=2.8)
PULSE = GroundMotion("pulse", 0.01, -0.35 * STANDARD_GRAVITY * np.sin(np.linspace(0, 2 * np.pi, 81)))


def curves(axes):
    return {line.get_label(): line for line in axes.get_lines() if not line.get_label().startswith("_")}


def test_the_record_stands_above_and_the_responses_below_with_their_impacts():
    histories = respond(BLOCK, PULSE)
    figure = draw_history(histories, PULSE, "a block")
    above, below = figure.axes
    assert above.get_title(loc="left") == "a block"
    np.testing.assert_allclose(above.get_lines()[0].get_ydata(), PULSE.acceleration / STANDARD_GRAVITY)
    drawn = curves(below)
    assert len(drawn) == 3
    np.testing.assert_array_equal(drawn["nonlinear"].get_ydata(), histories["nonlinear"].ratio)
    marked = [line.get_xdata() for line in below.get_lines() if line.get_marker() == "|"]
    assert len(marked) == 3
    assert marked[0][0] == histories["nonlinear"].impacts[0, 0]
    assert "time [s]" in below.get_xlabel() and "phi" in below.get_ylabel()


def test_overturning_is_named_and_the_fall_is_cut_off():
    histories = respond(BLOCK, PULSE.scaled(5.0), models=("nonlinear",))
    figure = draw_history(histories, PULSE.scaled(5.0), "a block")
    below = figure.axes[1]
    assert list(curves(below)) == ["nonlinear, overturns"]
    assert below.get_ylim()[1] <= 1.6


@pytest.mark.parametrize("motion", [None, PULSE.scaled(0.01)])
def test_a_free_motion_and_a_structure_at_rest_can_be_drawn(motion):
    histories = respond(BLOCK, motion, release=0.3 if motion is None else None)
    figure = draw_history(histories, motion, "quiet")
    assert len(figure.axes) == (1 if motion is None else 2)
