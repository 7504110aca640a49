"""The tables a history runs on are the mechanism's own coefficients, over dq = sqrt(I) dphi."""

import numpy as np
import pytest
from scipy.integrate import quad

from rocking_cli.core import Direction
from rocking_cli.core.structure_file import load_structure
from rocking_cli.dynamics.tables import LIMIT_SHARE, tabulate
from tests.conftest import EXAMPLES

FILES = sorted(path.name for path in EXAMPLES.glob("*.yaml"))
every_direction = pytest.mark.parametrize("direction", list(Direction))
# The wall with its hinge high up is a short link that turns fast, and the second derivative of a curve given by points
# has jumps, which no cubic follows across. The motion of an assembly is found by Newton, to the last digits but a few.
LOOSER = {"spanning_wall.yaml": 1e-10, "curve.yaml": 1e-7, "assembly.yaml": 1e-11}


def interpolate(cells, width, q):
    """The two functions of a table at q, by numpy's own polynomials."""
    k = (q / width).astype(int)
    x = q / width - k
    return np.stack([sum(cells[k, 4 * part + power] * x**power for power in range(4)) for part in range(2)])


def reproduces(table, mechanism, direction, q, within):
    """Assert that a table gives the coefficients at q, and return the rotations there."""
    phi, rate = interpolate(table.angles, table.cell, q)
    at = mechanism.coefficients(phi, direction)
    for got, expected in zip(
        (rate, *interpolate(table.forces, table.cell, q)),
        (at.I**-0.5, at.G * at.I**-0.5, at.B * at.I**-0.5),
        strict=True,
    ):
        assert abs(got - expected).max() < within * abs(expected).max()
    return phi


@pytest.mark.every(3)
@every_direction
@pytest.mark.parametrize("file", FILES)
def test_tables_reproduce_the_coefficients_between_their_nodes(file, direction):
    mechanism = load_structure(EXAMPLES / file)
    table = tabulate(mechanism)[0 if direction > 0 else 1]
    q = np.random.default_rng(1).uniform(0, table.q(1.5 * mechanism.critical_rotation(direction)), 500)
    reproduces(table, mechanism, direction, q, LOOSER.get(file, 2e-12))
    assert table.rest_rate == pytest.approx(mechanism.kinetic_inertia(np.zeros(1), direction)[0] ** -0.5, rel=1e-14)


@every_direction
@pytest.mark.parametrize("file", ["frame.yaml", "arch.yaml", "wall.yaml"])
def test_tables_hold_up_to_where_a_linkage_locks(file, direction):
    # The inertia grows without bound there, phi over q stands all but still.
    mechanism = load_structure(EXAMPLES / file)
    table = tabulate(mechanism)[0 if direction > 0 else 1]
    q = np.random.default_rng(1).uniform(0.5 * table.end, table.end, 2000)
    assert reproduces(table, mechanism, direction, q, 2e-11).max() < LIMIT_SHARE * mechanism.limit(direction)


@pytest.mark.every(3)
@every_direction
@pytest.mark.parametrize("file", FILES)
def test_q_is_the_integral_of_the_root_of_the_inertia(file, direction):
    mechanism = load_structure(EXAMPLES / file)
    table = tabulate(mechanism)[0 if direction > 0 else 1]
    critical = mechanism.critical_rotation(direction)
    for phi in (0.01 * critical, 0.4 * critical, critical):
        q, _ = quad(
            lambda x: float(mechanism.coefficients(np.array([x]), direction).I[0] ** 0.5),
            0,
            phi,
            epsabs=0,
            epsrel=1e-13,
        )
        close = max(LOOSER.get(file, 0.0), 2e-12)
        assert table.q(phi) == pytest.approx(q, rel=close)
        assert interpolate(table.angles, table.cell, np.array([q]))[0, 0] == pytest.approx(phi, rel=close)


@pytest.mark.parametrize("file", ["block.yaml", "frame.yaml", "arch.yaml"])
def test_what_is_certain_to_overturn_can_not_be_turned_back_by_that_acceleration(file):
    mechanism = load_structure(EXAMPLES / file)
    table, _ = tabulate(mechanism)
    assert table.nodes[-1] == pytest.approx(LIMIT_SHARE * mechanism.limit(Direction.POSITIVE))
    nodes = table.nodes[:-1]
    at = mechanism.coefficients(nodes, Direction.POSITIVE)
    outside = nodes > mechanism.critical_rotation(Direction.POSITIVE)
    assert (table.certain[~outside] < 0).all()
    assert (np.diff(table.certain) >= 0).all()
    for first in np.flatnonzero(outside)[::97]:
        later = slice(first, None)
        push = at.G[later] + abs(at.B[later]) * max(table.certain[first], 0.0)
        assert push.max() <= 1e-9 * abs(at.G[later]).max()
