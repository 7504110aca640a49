"""The tables a history runs on are the mechanism's own coefficients."""

from __future__ import annotations

import numpy as np
import pytest

from rocking_cli.core import Direction
from rocking_cli.dynamics.tables import END, tabulate
from rocking_cli.structure import load_structure
from tests.conftest import EXAMPLES


def interpolate(table, phi):
    """c, q and r at phi from the cells, by numpy's own polynomials."""
    k = (phi / table.cell).astype(int)
    x = phi / table.cell - k
    return np.stack([
        sum(table.cells[k, 4 * part + power] * x**power for power in range(4)) for part in range(3)
    ])  # fmt: skip


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("file", sorted(path.name for path in EXAMPLES.glob("*.yaml")))
def test_tables_reproduce_the_coefficients_between_their_nodes(file, direction):
    mechanism = load_structure(EXAMPLES / file)
    table = tabulate(mechanism)[0 if direction > 0 else 1]
    phi = np.random.default_rng(1).uniform(0, 1.5 * mechanism.critical_rotation(direction), 500)
    at = mechanism.coefficients(phi, direction)
    expected = np.stack([at.I**-0.5, at.G * at.I**-0.5, at.B * at.I**-0.5])
    worst = abs(interpolate(table, phi) - expected).max(axis=1) / abs(expected).max(axis=1)
    assert worst.max() < 2e-12
    assert table.rest_rate == pytest.approx(mechanism.kinetic_inertia(np.zeros(1), direction)[0] ** -0.5, rel=1e-14)


@pytest.mark.parametrize("file", ["block.yaml", "frame.yaml", "arch.yaml"])
def test_what_is_certain_to_overturn_can_not_be_turned_back_by_that_acceleration(file):
    mechanism = load_structure(EXAMPLES / file)
    table, _ = tabulate(mechanism)
    nodes = np.arange(table.certain.size) * table.cell
    assert nodes[-1] == pytest.approx(END * mechanism.limit(Direction.POSITIVE))
    at = mechanism.coefficients(nodes, Direction.POSITIVE)
    outside = nodes > mechanism.critical_rotation(Direction.POSITIVE)
    assert (table.certain[~outside] < 0).all()
    assert (np.diff(table.certain) >= 0).all()
    for first in np.flatnonzero(outside)[::97]:
        later = slice(first, None)
        push = mechanism.gravity * at.G[later] + abs(at.B[later]) * max(table.certain[first], 0.0)
        assert push.max() <= 1e-9 * abs(mechanism.gravity * at.G[later]).max()
