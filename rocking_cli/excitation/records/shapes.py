"""Shapes of tables without labels: components side by side, one series that runs on over the rows, numbers of rows."""

from __future__ import annotations

import numpy as np

from rocking_cli.arrays import Reals

FEWEST_ROWS = 10  # with which the steps of a table tell its shape
_MOST_RATIO = 2.0  # factor between mean steps that are still alike
_LEAST_RATIO = 1.4  # factor between mean steps that tell two shapes apart


def runs_on(table: Reals) -> bool | None:
    """Return whether values run on over the rows, by the steps between neighbours; None if nothing tells.

    In a series that runs on, a step from one row to the next is like a step within a row, and less than one down a
    column, which is several samples long. In a table of components, a step down a column is the smaller one.

    Parameters
    ----------
    table : ndarray, shape (columns, rows)
        The numbers.
    """
    if table.shape[1] < FEWEST_ROWS:
        return None
    within, across, down = (
        float(np.abs(steps).mean()) for steps in (np.diff(table, axis=0), table[0, 1:] - table[-1, :-1], np.diff(table))
    )
    if across / _MOST_RATIO <= within <= across * _MOST_RATIO and across * _LEAST_RATIO < down:
        return True
    return False if across > down * _LEAST_RATIO or within < across / _MOST_RATIO else None


def counts_rows(column: Reals) -> bool:
    """Return whether a column has the numbers of the rows."""
    return len(column) > 2 and bool((np.diff(column) == 1).all() and column[0] in (0, 1))
