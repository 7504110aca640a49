"""A mechanism's coefficients as tables over q, the coordinate in which its inertia is one: dq = sqrt(I) dphi.

Cubics with exact slopes at both ends of every cell. Near a lock, where the inertia grows without bound, q stays finite.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.coefficients import check_continuous

Reals = NDArray[np.float64]
TO_CRITICAL = 512  # cells from rest to phi_cr: coefficients are then right to 1e-12, of thick short arches to 3e-11
FEWEST, MOST = 2048, 16384  # cells from rest to the kinematic limit
END = 0.999  # of the kinematic limit: a locking linkage has infinite inertia at the limit itself


@dataclass(frozen=True)
class Table:
    """Tables of one direction.

    Parameters
    ----------
    forces : ndarray, shape (n, 8)
        In each cell the cubics of G/sqrt(I) and B/sqrt(I), powers 0 to 3 of the place in the cell.
    angles : ndarray, shape (n, 8)
        Likewise phi [rad] and dphi/dq = 1/sqrt(I).
    certain : ndarray, shape (n,)
        From the start of each cell on, the ground acceleration over g that no more stops an outward motion.
    nodes : ndarray, shape (n + 1,)
        phi at the ends of the cells [rad].
    cell : float
        Width of a cell, in q [kg^(1/2) m].
    """

    forces: Reals
    angles: Reals
    certain: Reals
    nodes: Reals
    cell: float

    @property
    def end(self) -> float:
        """q at which the motion counts as having reached the kinematic limit."""
        return self.cell * len(self.forces)

    @property
    def rest_rate(self) -> float:
        """dphi/dq at rest."""
        return float(self.angles[0, 4])

    def q(self, phi: float) -> float:
        """q at a rotation [rad] within the table."""
        k = min(max(int(np.searchsorted(self.nodes, phi, side="right")) - 1, 0), len(self.angles) - 1)
        a0, a1, a2, a3 = self.angles[k, :4].tolist()
        x = (phi - a0) / a1
        for _ in range(4):  # Newton, on a cubic that is all but straight
            x -= (a0 - phi + x * (a1 + x * (a2 + x * a3))) / (a1 + x * (2 * a2 + x * 3 * a3))
        return self.cell * float(k + x)


def tabulate(mechanism: Mechanism) -> tuple[Table, Table]:
    """Tabulate both directions of a mechanism, positive first, from rest to its kinematic limits."""
    # A linkage may lock far beyond phi_cr, while its coefficients change within phi_cr.
    reach = max(mechanism.limit(direction) / mechanism.critical_rotation(direction) for direction in Direction)
    cells = int(min(max(TO_CRITICAL * reach, FEWEST), MOST))
    return _one_direction(mechanism, Direction.POSITIVE, cells), _one_direction(mechanism, Direction.NEGATIVE, cells)


def _one_direction(mechanism: Mechanism, direction: Direction, cells: int) -> Table:
    phi, width = _even_steps(mechanism, direction, cells)
    at = mechanism.coefficients(phi, direction)
    c = 1 / np.sqrt(at.I)
    dc = -at.J * c**4  # over q, as all slopes here; I' = 2 J
    forces = [_cubics(width, y * c, dy * c**2 + y * dc) for y, dy in ((at.G, at.dG), (at.B, at.dB))]
    # An outward motion gains energy as long as -g G - s B u >= 0, and does so for good where that holds up to the end.
    with np.errstate(divide="ignore"):
        enough = np.where(at.G < 0, -at.G / np.abs(at.B), -1.0)
    certain = np.minimum.accumulate(enough[::-1])[::-1]
    return Table(
        np.hstack(forces), np.hstack([_cubics(width, phi, c), _cubics(width, c, dc)]), certain[:-1], phi, width
    )


def _even_steps(mechanism: Mechanism, direction: Direction, cells: int) -> tuple[Reals, float]:
    """Rotations [rad] at even steps of q from rest to the kinematic limit, and the width of a step."""
    # First over x with phi = end x (2 - x): where I grows like 1/(limit - phi), dq/dx stays smooth.
    end = END * mechanism.limit(direction)
    h = 0.5 / cells  # finer, as the steps near rest are twice as wide as the even ones
    x = np.linspace(0.0, 1.0, 2 * cells + 1)
    phi = end * x * (2 - x)
    dphi = 2 * end * (1 - x)
    at = mechanism.coefficients(phi, direction)
    check_continuous(mechanism.mechanism, direction, at)
    root = np.sqrt(at.I)
    dq, ddq = root * dphi, at.J / root * dphi**2 - 2 * end * root
    # Euler and Maclaurin's rule with the first correction: right to 1e-12.
    q = np.concatenate([[0.0], np.cumsum(h / 2 * (dq[:-1] + dq[1:]) + h**2 / 12 * (ddq[:-1] - ddq[1:]))])
    width = float(q[-1] / cells)
    even = np.arange(1, cells) * width
    k = np.searchsorted(q, even, side="right") - 1
    a = _cubics(np.diff(q), phi, 1 / root)[k]
    y = (even - q[k]) / (q[k + 1] - q[k])
    inner = a[:, 0] + y * (a[:, 1] + y * (a[:, 2] + y * a[:, 3]))
    return np.concatenate([[0.0], inner, [end]]), width


def _cubics(width: float | Reals, value: Reals, slope: Reals) -> Reals:
    """Cubic Hermite polynomials of all cells, shape (n, 4), powers of the place 0..1 inside the cell."""
    v0, v1, d0, d1 = value[:-1], value[1:], width * slope[:-1], width * slope[1:]
    return np.stack([v0, d0, 3 * (v1 - v0) - 2 * d0 - d1, 2 * (v0 - v1) + d0 + d1], axis=1)
