"""The rotation at which a passive tie of steel yields. A motion is known up to it: beyond, it depends on its past."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.core.bounds import Bound
from rocking_cli.core.hung.element import SteelBar
from rocking_cli.core.kinematics import Direction

if TYPE_CHECKING:
    from rocking_cli.core.mechanism import Mechanism

NODES = 1025  # rotations from rest to the kinematic limit between which it is looked for
PARTS, ROUNDS = 128, 7  # the interval is divided into parts so often that its size is that of rounding


def yields(mechanism: Mechanism, direction: Direction) -> Bound | None:
    """Return the first rotation in a direction at which a tie of steel reaches its strength; None if none does.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    direction : Direction
        Direction of rocking.
    """
    reached = ((_yield(mechanism, direction, bar), bar.name) for bar in mechanism.hung.bars)
    bounds = [Bound(phi, "yields", name) for phi, name in reached if phi is not None]
    return min(bounds, key=lambda bound: bound.phi, default=None)


def _yield(mechanism: Mechanism, direction: Direction, bar: SteelBar) -> float | None:
    """Return the first rotation at which one tie reaches its strength [rad]; None if it does at none."""
    phi = np.linspace(0.0, mechanism.limit(direction), NODES)[:-1]
    for _ in range(ROUNDS):
        e, _, _ = bar.elongation(mechanism.followed(phi, direction))
        k = int((e >= bar.yield_elongation).argmax())  # at rest it is not
        if k == 0:
            return None
        phi = np.linspace(phi[k - 1], phi[k], PARTS + 1)
    return float(phi[-1])
