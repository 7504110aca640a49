"""One table stands for both directions of rocking only where they are the same to the last bit."""

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.dynamics import tables
from tests.conftest import EXAMPLES

BOTH = ("forces", "angles", "certain", "nodes", "held", "corners")


@pytest.mark.parametrize(
    ("file", "one"), [("block", True), ("walls/column_with_tendon", True), ("frame", False), ("walls/statue", False)]
)
def test_what_is_shared_is_what_either_direction_gives(file, one, monkeypatch):
    mechanism = rk.load_structure(EXAMPLES / f"{file}.yaml")
    shared = tables.tabulate(mechanism)
    assert (shared[0] is shared[1]) == one
    monkeypatch.setattr(tables, "_mirrored", lambda *of: False)
    for table, own in zip(shared, tables.tabulate(mechanism), strict=True):
        assert all(np.array_equal(getattr(table, key), getattr(own, key)) for key in BOTH)


def test_a_load_to_one_side_and_a_tie_that_goes_slack_have_two():
    load = {"name": "bust", "mass": 1.0, "at": [1e-6, 2.0]}
    ends = {"from": {"ground": [-3.0, 2.0]}, "to": {"at": [0.0, 2.0]}}
    tie = {"name": "bar", **ends, "stiffness": 1e3, "only": "tension"}
    for given in ({"loads": [load]}, {"ties": [tie]}):
        block = rk.Block(width=0.6, height=2.0, mass=900.0, **given)
        one, other = tables.tabulate(block)
        assert one is not other and not np.array_equal(one.forces, other.forces)
