"""Sparse matrices: building and joining them; scipy is imported when the first one is built."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.core import Reals

LITTLE = 1e-12  # multiple of the unit matrix that is added, over the largest entry
Indices = NDArray[np.intp]
Sparse = Any  # scipy.sparse.csr_array, which has no types


def from_entries(rows: ArrayLike, columns: ArrayLike, values: ArrayLike, shape: tuple[int, int]) -> Sparse:
    """Build a matrix from the rows, columns and values of its entries; those of one place are added."""
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

    # In the order of its pattern, and without exchanging rows: such a matrix needs none, and fills in less.
    factors = splu(squares.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return lambda right: np.asarray(factors.solve(right), np.float64)


def weighted_squares(matrix: Sparse, weights: Reals) -> Sparse:
    """Return M^T W M of a matrix M and weights W, plus a small multiple of the unit matrix for regularity."""
    from scipy.sparse import diags_array, eye_array

    squares = matrix.T @ diags_array(weights) @ matrix
    return squares + LITTLE * np.abs(squares.diagonal()).max() * eye_array(matrix.shape[1])


def components(one: ArrayLike, other: ArrayLike, count: int) -> Indices:
    """Return the number of the connected component of each node of a graph, given its edges."""
    from scipy.sparse.csgraph import connected_components

    graph = from_entries(one, other, np.ones(len(np.asarray(one))), (count, count))
    return np.asarray(connected_components(graph, directed=False)[1], np.intp)


def from_blocks(blocks: Sequence[Sequence[Any]]) -> Sparse:
    """Build a matrix from rows of matrices, which may be dense; None is a block of zeros."""
    from scipy.sparse import block_array, csr_array

    return block_array([[None if each is None else csr_array(each) for each in row] for row in blocks], format="csc")
