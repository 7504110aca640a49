"""A mechanism's coefficients as tables over q, the coordinate in which its inertia is one: dq = sqrt(I) dphi.

Cubics with exact slopes at both ends of every cell. Near a rotation at which the mechanism locks, the inertia tends to
infinity, but q stays finite.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.core import Direction, Mechanism, both_statics
from rocking_cli.core.coefficients import check_continuous
from rocking_cli.core.equivalence import Statics
from rocking_cli.short_repr import short_repr

CRITICAL_CELLS = 512  # cells up to phi_cr; coefficients are then accurate to 1e-12, those of short links to 1e-10
MIN_CELLS, MAX_CELLS = 2048, 16384  # bounds on the number of cells from rest to the kinematic limit
MAX_CORNER_CELLS = 65536  # largest number of cells that put a corner of the force near rest on a node
PAIRS = (5, 6, 8, 10)  # numbers of pairs of powers from which that of the polynomials of the forces is chosen
MOST_PAIRS = PAIRS[-1]
SMOOTH = 2e-12  # largest difference of a polynomial, over the largest force
LIMIT_SHARE = 0.999  # end of the table over the kinematic limit, where a locking linkage has infinite inertia


@short_repr
@dataclass(frozen=True)
class DirectionTable:
    """Tables of the coefficients of one direction.

    Parameters
    ----------
    forces : ndarray, shape (n, 8)
        Cubics of (G + Q/g)/sqrt(I) and B/sqrt(I) in each cell, by powers 0 to 3 of the place 0..1 in the cell.
    angles : ndarray, shape (n, 8)
        Cubics of phi [rad] and dphi/dq = 1/sqrt(I), in the same form.
    certain : ndarray, shape (n,)
        Ground acceleration over g that cannot stop an outward motion, from the start of each cell on.
    nodes : ndarray, shape (n + 1,)
        phi at the ends of the cells [rad].
    cell : float
        Width of a cell, in q [kg^(1/2) m].
    held : ndarray, shape (n, 5)
        The cubic of Q/(g sqrt(I)), the part of the first force that does not scale with g, and from the start of each
        cell on the largest |Q|/(g |B|); without rows if the structure has no ties or forces.
    corners : ndarray of int, shape (n,)
        Number of corners of the force up to the start of each cell; a cell with a corner counts as one between two
        others.
    """

    forces: Reals
    angles: Reals
    certain: Reals
    nodes: Reals
    cell: float
    held: Reals = field(default_factory=lambda: np.zeros((0, 5)))
    corners: Integers = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def end(self) -> float:
        """The q at which the mechanism reaches its kinematic limit [kg^(1/2) m]."""
        return self.cell * len(self.forces)

    @property
    def rest_rate(self) -> float:
        """dphi/dq at rest."""
        return float(self.angles[0, 4])

    def phi(self, q: Reals) -> Reals:
        """Return the rotations [rad] at some q within the table."""
        k = np.clip((q / self.cell).astype(np.int64), 0, len(self.angles) - 1)
        a0, a1, a2, a3 = self.angles[k, :4].T
        x = q / self.cell - k
        return np.asarray(a0 + x * (a1 + x * (a2 + x * a3)))

    def q(self, phi: float) -> float:
        """Return q at a rotation [rad] within the table."""
        k = min(max(int(np.searchsorted(self.nodes, phi, side="right")) - 1, 0), len(self.angles) - 1)
        a0, a1, a2, a3 = self.angles[k, :4].tolist()
        x = (phi - a0) / a1
        for _ in range(4):  # Newton's method; the cubic is almost straight
            x -= (a0 - phi + x * (a1 + x * (a2 + x * a3))) / (a1 + x * (2 * a2 + x * 3 * a3))
        return self.cell * float(k + x)


def tabulate(mechanism: Mechanism, statics: Sequence[Statics] | None = None) -> tuple[DirectionTable, DirectionTable]:
    """Tabulate both directions of a mechanism, positive first, from rest to its kinematic limits.

    If the mechanism rocks to one side only, its table is returned twice.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    statics : sequence of Statics, optional
        Statics of both directions, if they are already computed.
    """
    # A linkage may lock far beyond phi_cr, while its coefficients change within phi_cr.
    reach = max(each.limit / each.reference for each in statics or both_statics(mechanism))
    cells = int(min(max(CRITICAL_CELLS * reach, MIN_CELLS), MAX_CELLS))
    if not mechanism.smooth:
        corners = np.concatenate([_corners(mechanism, direction, cells) for direction in mechanism.directions])
        cells = _cells_for(corners, cells)
    first, *other = mechanism.directions
    one = _one_direction(mechanism, first, cells)
    if not other or _mirrored(mechanism, one.nodes):
        return one, one
    return one, _one_direction(mechanism, other[0], cells)


def _mirrored(mechanism: Mechanism, nodes: Reals) -> bool:
    """Return whether both directions have the same table: equal coefficients at all nodes, to the last bit."""
    one, other = mechanism.directions
    if not mechanism.smooth or mechanism.limit(one) != mechanism.limit(other):
        return False
    for phi in (nodes[:: CRITICAL_CELLS // 4], nodes):  # a few nodes show most differences
        pair = [vars(mechanism.coefficients(phi, direction)) for direction in (one, other)]
        if not all(np.array_equal(pair[0][key], pair[1][key]) for key in pair[0]):
            return False
    return True


def _cells_for(corners: Reals, cells: int) -> int:
    """Return the number of cells for which the corners of the force are nearest to nodes.

    `corners` are fractions of the range of q. A cubic cannot represent a corner, such as where a tie goes slack. If a
    corner is near rest, the cells are so fine that it is beyond the first cell.
    """
    if not corners.size:
        return cells
    fewest = int(max(cells, min(np.ceil(1 / corners.min()), MAX_CORNER_CELLS)))
    counts = np.arange(fewest, fewest + cells)
    place = counts[:, None] * corners
    return int(counts[np.abs(place - np.round(place)).max(axis=1).argmin()])


def _corners(mechanism: Mechanism, direction: Direction, cells: int) -> Reals:
    """Return where ties go slack or taut, as fractions of the range of q in a direction."""
    shares = []
    phi, _ = _even_steps(mechanism, direction, cells)
    slack = partial(mechanism.slackness, direction=direction)
    sign, bent = _bent(mechanism, direction, phi)
    for row, k in zip(*np.nonzero(bent), strict=True):
        low, high = phi[k], phi[k + 1]
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if (slack(np.array([middle]))[row, 0] > 0) == sign[row, k] else (low, middle)
        shares.append((k + (low - phi[k]) / (phi[k + 1] - phi[k])) / cells)
    return np.array(shares)


def _bent(mechanism: Mechanism, direction: Direction, phi: Reals) -> tuple[Bools, Bools]:
    """Return, for each one-sided tie, whether it is taut at each rotation, and if this changes in each interval."""
    slack = mechanism.slackness(phi, direction)
    sign = slack > 0
    # A tie without force at rest is slack or taut as at the next rotation.
    sign[:, 0] = np.where(slack[:, 0] == 0, sign[:, 1], sign[:, 0])
    return sign, sign[:, :-1] != sign[:, 1:]


def _one_direction(mechanism: Mechanism, direction: Direction, cells: int) -> DirectionTable:
    phi, width = _even_steps(mechanism, direction, cells)
    at = mechanism.coefficients(phi, direction)
    c = 1 / np.sqrt(at.I)
    dc = -at.J * c**4  # derivative of c by q, as all slopes here; I' = 2 J

    bent: Bools = np.any(_bent(mechanism, direction, phi)[1], axis=0)

    def over_root(y: Reals, dy: Reals, energy: Reals | None = None) -> Reals:
        cubics = _cubics(width, y * c, dy * c**2 + y * dc)
        if energy is not None and bent.any():
            # In cells with a corner, use the parabola with the same ends and the same work.
            v0, v1, mean = (y * c)[:-1][bent], (y * c)[1:][bent], np.diff(energy)[bent] / width
            bow = 3 * (v0 + v1 - 2 * mean)
            cubics[bent] = np.stack([v0, v1 - v0 - bow, bow, np.zeros_like(bow)], axis=1)
        return cubics

    gravity = mechanism.gravity
    restoring = at.restoring(gravity)
    forces = [over_root(restoring, at.stiffness(gravity), at.V + at.U / gravity), over_root(at.B, at.dB)]
    # An outward motion gains energy as long as -V' - s B u >= 0, and for good if this holds up to the end.
    with np.errstate(divide="ignore", invalid="ignore"):
        enough = np.where(restoring < 0, -restoring / np.abs(at.B), -1.0)
        most_held = np.where(at.Q != 0, np.abs(at.Q) / (gravity * np.abs(at.B)), 0.0)
    certain = np.minimum.accumulate(enough[::-1])[::-1]
    held = np.zeros((0, 5))
    if at.Q.any():
        to_come = np.maximum.accumulate(most_held[::-1])[::-1]
        held = np.column_stack([over_root(at.Q / gravity, at.dQ / gravity, at.U / gravity), to_come[:-1]])
    return DirectionTable(
        np.hstack(forces),
        np.hstack([_cubics(width, phi, c), _cubics(width, c, dc)]),
        certain[:-1],
        phi,
        width,
        held,
        np.cumsum(np.concatenate([[False], bent[1:] | bent[:-1]])),
    )


def polynomials(mechanism: Mechanism, direction: Direction, table: DirectionTable, reach: float) -> tuple[int, Reals]:
    """Return the forces from rest up to q = reach as polynomials in y = 2 q/reach - 1.

    Returns
    -------
    int
        Number of pairs of powers; 0 if polynomials of no number are as accurate as the tables.
    ndarray, shape (4 MOST_PAIRS,)
        Even and odd power of (G + Q/g)/sqrt(I), then of B/sqrt(I), of each pair.
    """
    count = 2 * MOST_PAIRS
    nodes = np.cos(np.pi * (np.arange(count) + 0.5) / count)  # of Chebyshev
    places = (np.concatenate([nodes, np.linspace(-1.0, 1.0, 8 * count + 1)]) + 1) * (reach / 2)
    at = mechanism.coefficients(table.phi(places), direction)
    values = np.array([at.restoring(mechanism.gravity), at.B]) / np.sqrt(at.I)
    fitted = chebyshev.chebfit(nodes, values[:, :count].T, count - 1)
    between = places[count:] * (2 / reach) - 1
    largest = np.abs(values).max(axis=1)
    for pairs in PAIRS:
        powers = np.zeros((2, 2 * pairs))
        for row, each in zip(powers, fitted[: 2 * pairs].T, strict=True):
            series = chebyshev.cheb2poly(each)  # without trailing zeros
            row[: series.size] = series
        missed = polynomial.polyval(between, powers.T) - values[:, count:]
        if (np.abs(missed).max(axis=1) <= SMOOTH * largest).all():
            result = np.zeros(4 * MOST_PAIRS)
            result[: 4 * pairs] = powers.reshape(2, pairs, 2).transpose(1, 0, 2).ravel()
            return pairs, result
    return 0, np.zeros(4 * MOST_PAIRS)


def _even_steps(mechanism: Mechanism, direction: Direction, cells: int) -> tuple[Reals, float]:
    """Return rotations [rad] at equal steps of q from rest to the kinematic limit, and the size of a step."""
    # Integrate over x with phi = end x (2 - x): dq/dx stays smooth even if I grows like 1/(limit - phi).
    end = LIMIT_SHARE * mechanism.limit(direction)
    h = 0.5 / cells  # halved, as steps near rest are twice as wide as even ones
    x = np.linspace(0.0, 1.0, 2 * cells + 1)
    phi = end * x * (2 - x)
    dphi = 2 * end * (1 - x)
    at = mechanism.coefficients(phi, direction)
    check_continuous(mechanism.mechanism, direction, at, mechanism.jumps)
    root = np.sqrt(at.I)
    dq, ddq = root * dphi, at.J / root * dphi**2 - 2 * end * root
    # The Euler-Maclaurin rule with the first correction is accurate to 1e-12.
    q = np.concatenate([[0.0], np.cumsum(h / 2 * (dq[:-1] + dq[1:]) + h**2 / 12 * (ddq[:-1] - ddq[1:]))])
    width = float(q[-1] / cells)
    even = np.arange(1, cells) * width
    k = np.searchsorted(q, even, side="right") - 1
    a = _cubics(np.diff(q), phi, 1 / root)[k]
    y = (even - q[k]) / (q[k + 1] - q[k])
    inner = a[:, 0] + y * (a[:, 1] + y * (a[:, 2] + y * a[:, 3]))
    return np.concatenate([[0.0], inner, [end]]), width


def _cubics(width: float | Reals, value: Reals, slope: Reals) -> Reals:
    """Return the cubic Hermite polynomials of all cells, shape (n, 4), by powers of the place 0..1 in the cell."""
    v0, v1, d0, d1 = value[:-1], value[1:], width * slope[:-1], width * slope[1:]
    return np.stack([v0, d0, 3 * (v1 - v0) - 2 * d0 - d1, 2 * (v0 - v1) + d0 + d1], axis=1)
