"""Ties that go slack or come into play: a corner of the force, which no step of the integration may pass."""

import numpy as np
import pytest

from rocking_cli.core import Direction
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.tables import tabulate
from rocking_cli.structure import build_models
from tests.core.test_loads_and_ties import ON, bar, free
from tests.oracle import simulate
from tests.twins import shaking, twin

MINUS = Direction.NEGATIVE


def slackening(mechanism, stiffness, prestress):
    """A structure with a bar on its left that goes slack where it rocks to the left."""
    weight = ON[mechanism][4]
    return twin(mechanism, ties=[bar(mechanism, stiffness, only="tension", prestress=prestress * weight)])


@pytest.mark.parametrize("mechanism", ["block", "asymmetric_frame"])
def test_an_impact_behind_a_corner_is_right_to_1e_11_s(mechanism):
    both = slackening(mechanism, 0.5, 0.02)
    expected = simulate(both.oracle, release=-ON[mechanism][-1], impacts=1).impacts[0]
    assert free(both.tool, -ON[mechanism][-1]).impacts[0, 0] == pytest.approx(expected.time, abs=1e-10)


def test_a_tie_far_stiffer_than_the_structure_does_its_work_within_one_cell():
    """A cubic there would overshoot, and the energy of the corner be wrong by 1e-3."""
    both = slackening("block", 300.0, 0.02)
    expected = simulate(both.oracle, release=-0.1, impacts=1).impacts[0]
    found = free(both.tool, -0.1).impacts[0]
    assert found[0] == pytest.approx(expected.time, abs=1e-7)
    assert abs(found[2]) == pytest.approx(expected.before, rel=1e-9)


def test_the_table_has_its_corners_at_the_ends_of_the_cell_that_holds_them():
    tool = slackening("block", 0.5, 0.02).tool
    plus, minus = tabulate(tool)
    assert plus.corners.max() == 0 and minus.corners.max() in (1, 2)
    slack = tool.slackness(minus.nodes, MINUS)[0]
    (cell,) = np.flatnonzero(np.diff(np.sign(slack)))
    assert np.flatnonzero(np.diff(minus.corners)).tolist() == [cell - 1, cell]
    # In that cell the force is a parabola that does the work of the tie and the weight.
    work = minus.cell * tool.gravity * minus.forces[cell, :4] @ [1, 1 / 2, 1 / 3, 1 / 4]
    gained = np.diff(tool.potential_energy(minus.nodes[[cell, cell + 1]], MINUS))[0]
    assert work == pytest.approx(gained, rel=1e-9) and minus.forces[cell, 3] == 0


def test_a_tie_without_force_at_rest_has_no_corner_there():
    """Whatever rounding makes of its length at rest."""
    weight = ON["block"][4]
    for x in (-3.3, -0.7, -1.1, -2.7):
        tie = {"name": "t", "from": {"ground": [x, 0.1]}, "to": {"at": [-0.3, 2.7]}, "stiffness": weight}
        for only in ("tension", "compression"):
            tool = twin("block", ties=[{**tie, "only": only}]).tool
            assert not any(table.corners.any() for table in tabulate(tool))
            stiff = tool.coefficients(np.zeros(1), Direction.POSITIVE).dQ[0]
            assert (stiff > 0) == (only == "tension")


def test_a_record_is_followed_across_corners_and_alone_or_with_others_to_the_last_bit():
    names = ("block", "asymmetric_frame", "symmetric_frame")
    models = [build_models(slackening(name, 0.5, 0.02).tool, ("nonlinear",))[0] for name in names]
    models += [build_models(twin("block").tool, (name,))[0] for name in ("nonlinear", "linear2")]
    motion, _ = shaking(vertical=True, factor=0.9)
    together = respond_many(models, [motion], Runs.every(len(models), 1), threads=1)
    for k, model in enumerate(models):
        alone = follow(model, motion)
        assert np.array_equal(
            [alone.peak_positive, alone.peak_negative, alone.end_time],
            [together.peak_positive[k], together.peak_negative[k], together.end_time[k]],
            equal_nan=True,
        )
