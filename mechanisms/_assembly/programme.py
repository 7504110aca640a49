"""Linear programmes, by the dual simplex of HiGHS."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.faults import NoAnswer
from rocking_cli.core import Reals

TOLERANCE = 1e-10  # the solver's own 1e-7 is too coarse for a multiplier that two theorems must agree on


@dataclass(frozen=True)
class Optimum:
    """The least of cost . x over equal . x = right within bounds.

    Parameters
    ----------
    x : ndarray
        Where it is.
    value : float
        Cost there.
    prices : ndarray
        How the least cost grows with each of `right`.
    at_lower : ndarray
        How it grows with each lower bound.
    """

    x: Reals
    value: float
    prices: Reals
    at_lower: Reals


def least(cost: Reals, equal: Reals, right: Reals, low: Reals, high: Reals) -> Optimum | None:
    """The optimum of a programme that has a bounded cost; None if nothing satisfies it."""
    from scipy.optimize import linprog  # slow to import, and only an assembly needs it

    options = {"primal_feasibility_tolerance": TOLERANCE, "dual_feasibility_tolerance": TOLERANCE}
    bounds = np.column_stack([low, high])
    found = linprog(cost, A_eq=equal, b_eq=right, bounds=bounds, method="highs-ds", options=options)
    if found.status not in (0, 2):
        found = linprog(
            cost, A_eq=equal, b_eq=right, bounds=bounds, method="highs-ds", options={**options, "presolve": False}
        )
    if found.status == 2:
        return None
    if found.status != 0:
        raise NoAnswer(f"the linear programme of the assembly found no answer: {found.message}")
    return Optimum(found.x, float(found.fun), found.eqlin.marginals, found.lower.marginals)
