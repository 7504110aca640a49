"""Linear programmes, by HiGHS: the dual simplex for small ones, interior points and a crossover for large ones.

A crossover ends at a vertex as the simplex does, so that both are as exact; of a thousand blocks it takes a quarter of
the time. It may go astray where there is hardly a point inside, and then the simplex takes over.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from threading import Thread
from typing import Any

import numpy as np

from mechanisms._assembly.faults import NoAnswer
from mechanisms._assembly.sparse import Sparse
from rocking_cli.core import Reals

TOLERANCE = 1e-10  # the solver's own 1e-7 is too coarse for a multiplier that two theorems must agree on
WAIT = 0.1  # s between looks whether someone interrupts
LARGE = 600  # equations: from as many on interior points are the faster
SOON = 4  # times the equations: more steps of a crossover are those of one that goes astray


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


def least(cost: Reals, equal: Sparse, right: Reals, low: Reals, high: Reals) -> Optimum | None:
    """The optimum of a programme that has a bounded cost; None if nothing satisfies it."""
    from scipy.optimize import linprog  # slow to import, and only an assembly needs it

    options = {"primal_feasibility_tolerance": TOLERANCE, "dual_feasibility_tolerance": TOLERANCE}
    bounds = np.column_stack([low, high])
    ways: list[tuple[str, dict[str, float]]] = [("highs-ds", {}), ("highs-ds", {"presolve": False})]
    if len(right) >= LARGE:
        ways.insert(0, ("highs-ipm", {"maxiter": SOON * len(right)}))
    for method, more in ways:
        solve = partial(
            linprog, cost, A_eq=equal, b_eq=right, bounds=bounds, method=method, options={**options, **more}
        )
        found = _beside(solve) if len(right) >= LARGE else solve()
        if found.status in (0, 2):
            break
    if found.status == 2:
        return None
    if found.status != 0:
        raise NoAnswer(f"the linear programme of the assembly found no answer: {found.message}")
    return Optimum(found.x, float(found.fun), found.eqlin.marginals, found.lower.marginals)


def _beside(solve: Callable[[], Any]) -> Any:
    """Solve in a thread of its own, because one that waits can be interrupted and the solver cannot."""
    found: list[Any] = []
    failed: list[BaseException] = []

    def run() -> None:
        try:
            found.append(solve())
        except BaseException as error:  # raised again below
            failed.append(error)

    thread = Thread(target=run, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(WAIT)
    if failed:
        raise failed[0]
    return found[0]
