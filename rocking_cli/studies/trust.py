"""What the error of the equivalence means for a practitioner, in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rocking_cli.core.advice import preferred_kappa
from rocking_cli.studies.linearisation import Linearisation

SMALL, LARGE = 0.05, 0.15  # errors up to which an equivalent block serves design, and serves a first estimate


def trust(curves: Sequence[Linearisation], asked: Sequence[Linearisation]) -> str:
    """Say which kappa to use, what error to expect, and when to use the nonlinear history instead.

    Parameters
    ----------
    curves : sequence of Linearisation
        The ratios over their ranges, ascending, one for each direction that differs.
    asked : sequence of Linearisation
        The same directions at the amplitudes and accelerations of interest.

    Returns
    -------
    str
        Some sentences; of two directions the larger error counts.
    """
    said = [preferred_kappa(each.block).why for each in curves]
    if len(curves) > 1:
        said = [f"{each.direction.label}: {why}" for each, why in zip(curves, said, strict=True)]
    period = max(_worst(each.period_ratio) for each in asked)
    one, two = (max(_worst(getattr(each, f"overturning_ratio{k}")) for each in asked) for k in (1, 2))
    better = 2 if two <= one else 1
    said.append(
        f"Expect an error of {_percent(period)} in the free period and, with kappa{better}, of "
        f"{_percent(min(one, two))} in the overturning time (kappa{3 - better}: {_percent(max(one, two))})."
    )
    worst = max(period, min(one, two))
    if worst <= SMALL:
        said.append("The equivalent block serves design there.")
    elif worst <= LARGE:
        said.append("The equivalent block serves a first estimate there; decide by the nonlinear history.")
    else:
        said.append("Do not rely on the equivalent block there: use the nonlinear history.")
    return " ".join([*said, *_ranges(curves, better)])


def _ranges(curves: Sequence[Linearisation], kappa: int) -> list[str]:
    """Where the errors grow beyond what is small."""
    said = []
    far = [each.amplitude[np.abs(each.period_ratio - 1) > SMALL] for each in curves]
    wide = [values for values in far if values.size]
    if wide:
        low, high = min(values.min() for values in wide), max(values.max() for values in wide)
        where = (
            "at every amplitude"
            if any(values.size == each.amplitude.size for values, each in zip(far, curves, strict=True))
            else f"for phi/phi_cr from {low:.2g} to {high:.2g}"
        )
        said.append(f"The free period is off by more than {SMALL:.0%} {where}.")
    slow = [each.acceleration[np.abs(getattr(each, f"overturning_ratio{kappa}") - 1) > SMALL] for each in curves]
    late = [values.max() for values in slow if values.size]
    if late:
        everywhere = any(values.size == each.acceleration.size for values, each in zip(slow, curves, strict=True))
        where = "at every acceleration" if everywhere else f"for accelerations below {max(late):.3g} times uplift"
        said.append(f"The overturning time with kappa{kappa} is off by more than {SMALL:.0%} {where}.")
    return said


def _worst(ratios: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    return float(np.abs(ratios - 1).max())


def _percent(error: float) -> str:
    return "infinity (it never uplifts)" if np.isinf(error) else f"{100 * error:.2g} %"
