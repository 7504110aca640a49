"""Linear programmes with sparse matrices, by HiGHS: dual simplex for small ones, interior points for large ones.

A crossover after interior points ends at a vertex as the simplex does, and for a thousand blocks takes a fifth of the
time. Both are only exact to their tolerance, and errors add up from course to course of a wall, so that the result of a
large programme may be refined. The residuals of equations, bounds and prices define a programme with the same matrix
for the correction, magnified until the solver's tolerance is small in comparison (Gleixner, Steffy and Wolter, 2012).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from threading import Thread
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mechanisms._assembly.blocks import NoAnswer
from rocking_cli.core import Reals

TOLERANCE = 1e-10  # the solver's own 1e-7 is too coarse for a multiplier that two theorems must agree on
TIGHT_OPTIONS = {"primal_feasibility_tolerance": TOLERANCE, "dual_feasibility_tolerance": TOLERANCE}
INTERRUPT_INTERVAL = 0.1  # s between two checks for an interrupt by the user
MIN_INTERIOR_EQUATIONS = 600  # equations from which interior points are faster
CROSSOVER_ITERATIONS = 1  # limit of iterations over the number of equations; longer crossovers do not converge
MAX_RESIDUAL = 1e-12  # residuals of a refined result, over its size
BOUND_DISTANCE = 1e-9  # distance from a bound that counts as on the bound, over the largest variable
MAX_REFINEMENTS, MAX_MAGNIFICATION = 4, 1e7


@dataclass(frozen=True)
class Optimum:
    """Minimum of cost . x subject to equal . x = right and bounds.

    Parameters
    ----------
    x : ndarray
        The variables at the minimum.
    value : float
        The minimum cost.
    prices : ndarray
        Derivatives of the minimum cost by `right`.
    at_lower : ndarray
        Derivatives of the minimum cost by the lower bounds.
    """

    x: Reals
    value: float
    prices: Reals
    at_lower: Reals


def least(cost: Reals, equal: Sparse, right: Reals, low: Reals, high: Reals, *, exact: bool = False) -> Optimum | None:
    """Return the optimum of a programme whose cost is bounded; None if it has no feasible point.

    Parameters
    ----------
    cost, right, low, high : ndarray
        The costs, the right sides of the equations, and the bounds.
    equal : sparse array
        Matrix of the equations.
    exact : bool
        Whether to refine the result of a large programme until its errors are rounding errors.

    Raises
    ------
    NoAnswer
        If the solver does not converge.
    """
    programme = _Programme(cost, equal, right, low, high)
    attempts: list[Callable[[], Optimum | None]] = [
        partial(programme.solve, "highs-ds", **TIGHT_OPTIONS),
        partial(programme.solve, "highs-ds", presolve=False, **TIGHT_OPTIONS),
        programme.refined,
    ]
    if len(right) >= MIN_INTERIOR_EQUATIONS:
        close = partial(programme.solve, "highs-ipm", maxiter=CROSSOVER_ITERATIONS * len(right), **TIGHT_OPTIONS)
        attempts = [programme.refined, *attempts[:2]] if exact else [close, programme.refined, *attempts[:2]]
    for way in attempts:
        try:
            return way()
        except _NotFound as error:
            why = error
    raise NoAnswer(f"the linear programme of the assembly found no answer: {why}")


class _NotFound(Exception):
    """Error: the solver did not converge."""


@dataclass(frozen=True, eq=False)
class _Programme:
    """A linear programme with the arguments of `least`."""

    cost: Reals
    equal: Sparse
    right: Reals
    low: Reals
    high: Reals

    def solve(self, method: str, **options: float) -> Optimum | None:
        """Return the optimum that the solver finds; None if there is no feasible point."""
        from scipy.optimize import linprog  # slow to import, and only an assembly needs it

        solve = partial(
            linprog, self.cost, A_eq=self.equal, b_eq=self.right, bounds=np.column_stack([self.low, self.high]),
            method=method, options=options,
        )  # fmt: skip
        result = _beside(solve) if len(self.right) >= MIN_INTERIOR_EQUATIONS else solve()
        if result.status == 2:
            return None
        if result.status != 0:
            raise _NotFound(result.message)
        return Optimum(result.x, float(result.fun), result.eqlin.marginals, result.lower.marginals)

    def refined(self) -> Optimum | None:
        """Return the optimum, corrected repeatedly until its errors are rounding errors.

        The corrections end earlier if the solver finds no further one.
        """
        nothing = np.zeros(len(self.cost))
        optimum = Optimum(nothing, 0.0, np.zeros(len(self.right)), nothing)
        for _ in range(MAX_REFINEMENTS):
            off, uneven = self._errors(optimum)
            if max(off, uneven) <= MAX_RESIDUAL:
                break
            wide, steep = (min(1 / max(error, MAX_RESIDUAL), MAX_MAGNIFICATION) for error in (off, uneven))
            correction = replace(
                self, cost=steep * self._rates(optimum), right=wide * (self.right - self.equal @ optimum.x),
                low=wide * (self.low - optimum.x), high=wide * (self.high - optimum.x),
            )  # fmt: skip
            try:
                more = correction.solve("highs-ipm", maxiter=CROSSOVER_ITERATIONS * len(self.right))
            except _NotFound:
                break
            if more is None:
                return None  # the solution was feasible only within the tolerance
            x, prices = optimum.x + more.x / wide, optimum.prices + more.prices / steep
            optimum = Optimum(x, float(self.cost @ x), prices, more.at_lower / steep)
        if max(self._errors(optimum)) > TOLERANCE:
            raise _NotFound("its errors remain large")
        return optimum

    def _rates(self, optimum: Optimum) -> Reals:
        return np.asarray(self.cost - self.equal.T @ optimum.prices)

    def _errors(self, optimum: Optimum) -> tuple[float, float]:
        """Return the largest relative residuals: of equations and bounds, and of the prices."""
        x, rates = optimum.x, self._rates(optimum)
        size = max(1.0, np.abs(x).max())
        off = max(np.abs(self.equal @ x - self.right).max(), (self.low - x).max(), (x - self.high).max())
        # A variable above its lower bound may have no positive rate, one below its upper bound no negative rate.
        rises, falls = rates[x - self.low > BOUND_DISTANCE * size], -rates[self.high - x > BOUND_DISTANCE * size]
        uneven = max(rises.max(initial=0.0), falls.max(initial=0.0))
        return float(off / size), float(uneven / max(1.0, np.abs(optimum.prices).max()))


def _beside(solve: Callable[[], Any]) -> Any:
    """Solve in a separate thread, so that the user can interrupt the wait for the solver."""
    results: list[Any] = []
    failed: list[BaseException] = []

    def run() -> None:
        try:
            results.append(solve())
        except BaseException as error:  # kept, and raised again in the calling thread
            failed.append(error)

    thread = Thread(target=run, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(INTERRUPT_INTERVAL)
    if failed:
        raise failed[0]
    return results[0]


REGULARISATION = 1e-12  # multiple of the unit matrix that is added, over the largest entry
Indices = NDArray[np.intp]
Sparse = Any  # scipy.sparse.csr_array, which has no types


def from_entries(rows: ArrayLike, columns: ArrayLike, values: ArrayLike, shape: tuple[int, int]) -> Sparse:
    """Build a matrix from the rows, columns and values of its entries; values in the same place are added."""
    from scipy.sparse import csr_array

    places = np.asarray(rows, np.intp), np.asarray(columns, np.intp)
    return csr_array((np.asarray(values, np.float64), places), shape=shape)


def beside(parts: Sequence[Sparse]) -> Sparse:
    """Join matrices side by side; vectors are columns."""
    from scipy.sparse import csc_array, hstack

    return hstack([csc_array(part[:, None] if part.ndim == 1 else part) for part in parts], format="csc")


def unit_columns(rows: ArrayLike, size: int) -> Sparse:
    """Build the columns of the unit matrix that belong to some rows, shape (size, rows)."""
    rows = np.asarray(rows, np.intp)
    return from_entries(rows, np.arange(len(rows)), np.ones(len(rows)), (size, len(rows)))


def solved(matrix: Sparse, right: Reals) -> Reals:
    """Solve a square system for the columns of `right`."""
    from scipy.sparse.linalg import splu

    return np.asarray(splu(matrix.tocsc()).solve(np.ascontiguousarray(right)))


def solver(squares: Sparse) -> Callable[[Reals], Reals]:
    """Factorise a positive semidefinite symmetric matrix, and return a function that solves it for a vector."""
    from scipy.sparse.linalg import splu

    # Order by pattern and do not exchange rows: this matrix is stable without it, and fill-in is smaller.
    factors = splu(squares.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return lambda right: np.asarray(factors.solve(right), np.float64)


def weighted_squares(matrix: Sparse, weights: Reals) -> Sparse:
    """Return M^T W M of a matrix M and weights W, plus a small multiple of the unit matrix for regularity."""
    from scipy.sparse import diags_array, eye_array

    squares = matrix.T @ diags_array(weights) @ matrix
    return squares + REGULARISATION * np.abs(squares.diagonal()).max() * eye_array(matrix.shape[1])


def components(one: ArrayLike, other: ArrayLike, count: int) -> Indices:
    """Return the number of the connected component of each node of a graph, given its edges."""
    from scipy.sparse.csgraph import connected_components

    graph = from_entries(one, other, np.ones(len(np.asarray(one))), (count, count))
    return np.asarray(connected_components(graph, directed=False)[1], np.intp)


def from_blocks(blocks: Sequence[Sequence[Any]]) -> Sparse:
    """Build a matrix from rows of matrices, which may be dense; None is a block of zeros."""
    from scipy.sparse import block_array, csr_array

    return block_array([[None if each is None else csr_array(each) for each in row] for row in blocks], format="csc")
