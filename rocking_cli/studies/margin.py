"""How much stronger or weaker a ground motion would have to be to lift a structure, and to overturn it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction, Mechanism
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import build_models
from rocking_cli.errors import SolverError
from rocking_cli.excitation.base import GroundMotion

STEP = 1.01  # from one factor to the next
FACTORS: NDArray[np.float64] = STEP ** np.arange(-162.0, 163.0)  # 0.2 to 5, with 1 itself


@dataclass(frozen=True)
class Margin:
    """Factors on a ground motion.

    Parameters
    ----------
    uplift : float or None
        The least that lifts the structure, exact; None if none does.
    overturning : float or None
        The least of `FACTORS` with which it overturns; None if it does with none of them. Others between two of them
        may overturn it, too: overturning comes and goes with the factor.
    safe_again : float or None
        The largest of them above that with which it does not overturn; None if there is none.
    other : float or None
        The one nearest to 1 that decides otherwise than 1 whether it overturns; None if all decide alike.
    """

    uplift: float | None
    overturning: float | None
    safe_again: float | None
    other: float | None


def margin(
    mechanism: Mechanism,
    motion: GroundMotion,
    polarities: Sequence[int] = (1, -1),
    progress: Callable[[int], None] | None = None,
) -> Margin:
    """Find the factors on a motion that lift and that overturn a structure, by its nonlinear model.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    motion : GroundMotion
        What shakes it.
    polarities : sequence of int
        Of 1 and -1; with both, the worse counts.
    progress : callable, optional
        Called with the number of histories done since the last call, of `FACTORS.size * len(polarities)`.

    Raises
    ------
    InputError, MechanismError
        If the structure does not stand, or its restitution is not known.
    SolverError
        If a motion cannot be followed.
    """
    runs = Runs.every(1, 1, scales=FACTORS.tolist(), polarities=polarities)
    found = respond_many(build_models(mechanism, ("nonlinear",)), [motion], runs, only_peaks=True, progress=progress)
    if found.failed.any():
        raise SolverError(f"{runs.scale[int(found.failed.argmax())]:.3g} times {motion.name} cannot be followed")
    falls: NDArray[np.bool_] = np.any(found.overturned.reshape(FACTORS.size, len(polarities)), axis=1)
    least = int(falls.argmax())
    above = np.flatnonzero(~falls[least:]) + least if falls.any() else np.array([], dtype=np.int64)
    one = int(np.abs(np.log(FACTORS)).argmin())
    otherwise = np.flatnonzero(falls != falls[one])
    return Margin(
        uplift=_uplift(mechanism, motion, polarities),
        overturning=float(FACTORS[least]) if falls.any() else None,
        safe_again=float(FACTORS[above[-1]]) if above.size else None,
        other=float(FACTORS[otherwise[np.abs(otherwise - one).argmin()]]) if otherwise.size else None,
    )


def _uplift(mechanism: Mechanism, motion: GroundMotion, polarities: Sequence[int]) -> float | None:
    """Uplift when -s a_g/g exceeds lambda of the direction s."""
    needed = []
    for direction in Direction:
        for polarity in polarities:
            push = float(np.max(-direction * polarity * motion.acceleration))
            if push > 0:
                needed.append(mechanism.uplift(direction) * mechanism.gravity / push)
    return min(needed, default=None)
