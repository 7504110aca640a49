"""Shares of neighbours: how they are drawn, and what they are where that is known exactly."""

from math import log, sqrt
from statistics import NormalDist

import numpy as np
import pytest

from rocking_cli import GroundMotion, Registry
from rocking_cli.errors import InputError
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Conditions, Neighbourhood, neighbours
from rocking_cli.views.neighbours import deviations

NORMAL = NormalDist()


def model(name="block", **fields):
    return structure(name, **fields).model("nonlinear")


def structure(name="block", **fields):
    return Structure(Registry()[name](**(fields or {"width": 0.7, "height": 2.8})))


def held(level, push=-1):
    """A ground acceleration of one size, in g times lambda, for long."""
    return GroundMotion("held", 0.02, push * level * 9.80665 * np.ones(1501), unit="m/s2")


@pytest.mark.parametrize(("level", "restitution"), [(0.85, None), (0.9, None), (1.03, None), (1.1, None), (1.03, 0.5)])
def test_a_held_acceleration_overturns_the_share_that_is_exact(level, restitution):
    made = structure("block", width=0.7, height=2.8, restitution=restitution)
    found = neighbours(Conditions(made), held(level * made.model("nonlinear").lambda_[0]))
    assert found.overturned == pytest.approx(NORMAL.cdf(log(level) / sqrt(0.04**2 + 0.10**2)), abs=0.03)


def test_what_a_force_holds_is_not_scaled_with_the_slenderness():
    fields = {"width": 0.7, "height": 2.8, "depth": 1.0, "density": 2000.0}
    force = {"name": "strut", "force": [0.0, -20_000.0], "at": [0.0, 2.8]}
    made = model("block", **fields, loads=[force])
    own = model("block", **fields).lambda_[0]
    assert made.weight_share == pytest.approx(own / made.lambda_[0], rel=1e-9)
    drawn = Neighbourhood(2000).drawn(made)
    assert drawn.slender.std() == pytest.approx(0.10 * made.weight_share, rel=0.05)


def test_of_two_directions_the_weaker_says_what_the_weight_holds():
    fields = {"width": 0.7, "height": 2.8, "depth": 1.0, "density": 2000.0}
    made = model("block", **fields, loads=[{"name": "thrust", "force": [2000.0, 0.0], "at": [0.0, 2.0]}])
    own = model("block", **fields).lambda_[0]
    weak, strong = made.lambda_
    assert weak < own < strong
    assert made.weight_share == pytest.approx(own / weak, rel=1e-9)


def test_deviations_come_from_the_file_and_options_win():
    plain, given = model(), model("block", width=0.7, height=2.8, restitution=0.9)
    measured = model("block", width=0.7, height=2.8, uncertainty={"slenderness": 0.03, "restitution": 0.01})
    assert tuple(plain.scatter) == (0.05, 0.10)
    assert tuple(given.scatter) == (0.03, 0.10)
    assert tuple(measured.scatter) == (0.01, 0.03)
    exact = model("block", width=0.7, height=2.8, uncertainty={"slenderness": 0.0, "restitution": 0.0})
    assert tuple(exact.scatter) == (0.0, 0.0)  # none is not the same as not given
    assert deviations(Neighbourhood().of(measured)) == (
        "standard deviations 4 % of amplitude, 3 % of slenderness, 0.01 of restitution"
    )
    assert Neighbourhood(slenderness=0.07).of(measured).slenderness == 0.07
    with pytest.raises(InputError, match="slenderness_deviation must be from 0 to below 1"):
        Neighbourhood(slenderness=-0.1)
