"""A mechanism's coefficients as tables over the rotation: cubics with exact slopes at both ends of every cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction, Mechanism

Reals = NDArray[np.float64]
TO_CRITICAL = 512  # cells from rest to phi_cr: coefficients are then interpolated to 1e-12 of their size
FEWEST, MOST = 2048, 16384  # cells from rest to the kinematic limit
END = 0.999  # of the kinematic limit: a locking linkage has infinite inertia at the limit itself


@dataclass(frozen=True)
class Table:
    """Tables of one direction.

    Parameters
    ----------
    cells : ndarray, shape (n, 12)
        In each cell the cubics of c = 1/sqrt(I), q = G c and r = B c, powers 0 to 3 of the place in the cell.
    cell : float
        Width of a cell [rad].
    end : float
        Rotation at which the motion counts as having reached the kinematic limit [rad].
    rest_rate : float
        c at rest.
    certain : ndarray, shape (n + 1,)
        At each node, the ground acceleration [m/s2] that no more stops an outward motion from there on.
    """

    cells: Reals
    cell: float
    end: float
    rest_rate: float
    certain: Reals


def tabulate(mechanism: Mechanism) -> tuple[Table, Table]:
    """Tabulate both directions of a mechanism, positive first, from rest to its kinematic limits."""
    # A linkage may lock far beyond phi_cr, while its coefficients change within phi_cr.
    reach = max(mechanism.limit(direction) / mechanism.critical_rotation(direction) for direction in Direction)
    cells = int(min(max(TO_CRITICAL * reach, FEWEST), MOST))
    return _one_direction(mechanism, Direction.POSITIVE, cells), _one_direction(mechanism, Direction.NEGATIVE, cells)


def _one_direction(mechanism: Mechanism, direction: Direction, cells: int) -> Table:
    end = END * mechanism.limit(direction)
    phi = np.linspace(0.0, end, cells + 1)
    at = mechanism.coefficients(phi, direction)
    c = 1 / np.sqrt(at.I)
    dc = -at.J * c**3  # I' = 2 J
    width = end / cells
    cubics = np.hstack(
        [
            _cubics(width, c, dc),
            _cubics(width, at.G * c, at.dG * c + at.G * dc),
            _cubics(width, at.B * c, at.dB * c + at.B * dc),
        ]
    )
    # An outward motion gains energy as long as -g G - s B u >= 0, and does so for good where that holds up to the end.
    with np.errstate(divide="ignore"):
        enough = np.where(at.G < 0, -mechanism.gravity * at.G / np.abs(at.B), -1.0)
    certain = np.minimum.accumulate(enough[::-1])[::-1]
    return Table(np.ascontiguousarray(cubics), width, end, float(c[0]), certain)


def _cubics(width: float, value: Reals, slope: Reals) -> Reals:
    """Cubic Hermite polynomials of all cells, shape (n, 4), in the place 0..1 inside the cell."""
    v0, v1, d0, d1 = value[:-1], value[1:], width * slope[:-1], width * slope[1:]
    return np.stack([v0, d0, 3 * (v1 - v0) - 2 * d0 - d1, 2 * (v0 - v1) + d0 + d1], axis=1)
