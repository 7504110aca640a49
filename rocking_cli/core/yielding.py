"""The rotation at which a passive tie of steel yields. A motion is known up to it: beyond, it depends on its past."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.core.bounds import Bound, first_beyond
from rocking_cli.core.hung.element import SteelBar
from rocking_cli.core.kinematics import Direction, Reals

if TYPE_CHECKING:
    from rocking_cli.core.mechanism import Mechanism

NODES = 1025  # rotations between which it is looked for


def yields(mechanism: Mechanism, direction: Direction, end: float) -> Bound | None:
    """Return the first rotation in a direction at which a tie of steel reaches its strength; None if none does.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    direction : Direction
        Direction of rocking.
    end : float
        Rotation at which the search ends, below the kinematic limit [rad].
    """
    bounds = []
    for bar in mechanism.hung.bars:

        def beyond(phi: Reals, bar: SteelBar = bar) -> Reals:
            return bar.elongation(mechanism.followed(phi, direction))[0] - bar.yield_elongation

        phi = np.linspace(0.0, end, NODES)
        k = int((beyond(phi) > 0).argmax())
        if k:  # at rest it does not
            bounds.append(Bound(first_beyond(beyond, phi[k - 1], phi[k]), "yields", bar.name))
    return min(bounds, key=lambda bound: bound.phi, default=None)
