"""The base shear of a history: what the ground exerts sideways, against the second program."""

import numpy as np
import pytest

from mechanisms.block import Block
from mechanisms.wall import Wall
from rocking_cli.dynamics.history import follow
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.studies.contact import Contacts
from tests import oracle
from tests.following import build_model

TIME = 0.005 * np.arange(500)
SHAKING = GroundMotion("two sines", 0.005, 3.2 * np.sin(5 * TIME) * np.sin(1.3 * TIME), unit="m/s2")
MASS = 5000.0


def test_of_a_tied_block_it_is_what_the_second_program_finds_at_the_foot():
    bar = {"name": "bar", "from": {"ground": [-4.0, 3.0]}, "to": {"at": [-0.5, 4.0]}, "stiffness": 2e4}
    block = Block(width=1.0, height=5.0, mass=MASS, ties=[bar])
    other = oracle.Block(1.0, 5.0, mass=MASS).with_tie(
        (oracle.GROUND, -4 + 3j), ("block", -0.5 + 4j), k=2e4, acts="both"
    )
    history = follow(build_model(block, "nonlinear"), SHAKING)
    shear = Contacts(block).base_shear(history, SHAKING)
    rocking = np.flatnonzero(np.isfinite(shear))
    assert rocking.size > 100 and shear.size == history.time.size
    for k in rocking[:: rocking.size // 12]:
        s = 1 if history.phi[k] > 0 else -1
        u = float(np.interp(history.time[k], SHAKING.time, SHAKING.acceleration, right=0.0))
        foot = oracle.reactions(other, s, abs(history.phi[k]), s * history.rate[k], u=u)["foot"]
        assert shear[k] == pytest.approx(foot.x, rel=1e-6, abs=1e-3 * MASS * 1e-3)
    check = Contacts(block).check(history, SHAKING)
    assert np.nanmax(np.abs(shear)) <= check.base_shear <= 1.3 * np.nanmax(np.abs(shear))


def test_what_holds_the_top_of_a_wall_is_no_base_shear():
    wall = Wall(thickness=0.3, height=3.0, mass=1000.0)
    history = follow(build_model(wall, "nonlinear"), SHAKING.scaled(2.2))
    shear = Contacts(wall).base_shear(history, SHAKING.scaled(2.2))
    found = Contacts(wall).check(history, SHAKING.scaled(2.2))
    assert 0 < np.nanmax(np.abs(shear)) <= found.base_shear
    # Two equal blocks share the drive between foot and top: the foot takes well less than all of it.
    assert found.base_shear < 0.9 * 1000.0 * 2.2 * SHAKING.pga_g * 9.80665


def test_at_rest_there_is_none():
    block = Block(width=3.0, height=1.0, mass=MASS)
    history = follow(build_model(block.model_copy(update={"restitution": 0.5}), "nonlinear"), SHAKING)
    contacts = Contacts(block)
    assert np.isnan(contacts.base_shear(history, SHAKING)).all()
    assert np.isnan(contacts.check(history, SHAKING).base_shear)
