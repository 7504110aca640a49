"""Contacts of free blocks: what they do to motion, energy and forces, against closed forms and other programs."""

import pytest

import rocking_cli as rk
from rocking_cli.studies.engines.blocks import BlockModel
from rocking_cli.studies.engines.free_blocks import free_blocks
from tests.conftest import EXAMPLES

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


@pytest.mark.parametrize("file", ["block", "arch", "frame", "masonry/buttressed_arch", "walls/floor_wall"])
@pytest.mark.parametrize("phi", [1e-4, -1e-4, 0.05, -0.05])
def test_blocks_that_move_as_the_mechanism_have_its_rotation(file, phi):
    mechanism = rk.load_structure(EXAMPLES / f"{file}.yaml")
    free = free_blocks(mechanism)
    assert free.rotation(free.tilted(mechanism, phi)[None])[0] == pytest.approx(phi, rel=1e-6)
