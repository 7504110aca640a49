"""Contacts of free blocks: what they do to motion, energy and forces, against closed forms and other programs."""

import pytest

import rocking_cli as rk
from rocking_cli.studies.engines.blocks import BlockModel
from rocking_cli.studies.engines.free_blocks import free_blocks

pytest.importorskip("mujoco", reason="free blocks need mujoco-core")

PEDESTAL = rk.Block(width=0.7, height=2.8)


def released(mechanism, tilt, finer=1.0, **how):
    """Return the blocks, their model, and their motion after a release from a tilt."""
    free = free_blocks(mechanism)
    model = BlockModel(free, finer)
    return free, model, model.simulate(None, start=free.tilted(mechanism, tilt), **how)


def test_a_block_that_turns_back_is_not_at_rest():
    free, _, moved = released(PEDESTAL, 0.4 * 0.24498)
    assert moved.at_rest and moved.time[-1] > 5
    assert abs(free.rotation(moved.moved)[-1]) < 1e-6
