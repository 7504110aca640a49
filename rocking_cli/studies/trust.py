"""The error of the equivalent block in words, for a practitioner: the rule of `rocking_cli.core.advice`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.core.advice import SMALL, Grade, grade, preferred_kappa, uplift_in_words
from rocking_cli.names import percent
from rocking_cli.studies.linearisation import Linearisation

NEVER = "infinite (it never uplifts)"
KEPT = 1e-9  # an error of the uplift acceleration that is none


@dataclass(frozen=True)
class Errors:
    """Largest errors of an equivalent block at the requested amplitudes, in the worse of the two directions.

    Parameters
    ----------
    uplift : float
        Relative error of the uplift acceleration, with its sign.
    period, overturning : float
        Absolute relative errors of the free period and of the overturning time; infinite if the block never uplifts.
    """

    uplift: float
    period: float
    overturning: float

    @property
    def grade(self) -> Grade:
        """Grade the block by its largest error."""
        return max(grade(self.uplift), grade(self.period), grade(self.overturning))


def errors(asked: Sequence[Linearisation], kappa: int) -> Errors:
    """Return the largest errors of the block with kappa1 or kappa2; see `trust`."""
    uplifts = [getattr(each, f"uplift_ratio{kappa}") - 1 for each in asked]
    return Errors(
        max(uplifts, key=abs),
        max(_worst(each.period_ratio) for each in asked),
        max(_worst(getattr(each, f"overturning_ratio{kappa}")) for each in asked),
    )


def preferred(asked: Sequence[Linearisation]) -> int | None:
    """Return which kappa to prefer at the requested amplitudes: 1, 2, 0 if either will do, None if neither does.

    The kappa with the better grade is preferred; if both have the same grade, `preferred_kappa` decides by the uplift
    acceleration.
    """
    one, two = (errors(asked, kappa).grade for kappa in (1, 2))
    if one is two is Grade.DISREGARD:
        return None
    if one is not two:
        return 1 if one < two else 2
    return 2 if any(preferred_kappa(each.block).prefer == "kappa2" for each in asked) else 0


def trust(curves: Sequence[Linearisation], asked: Sequence[Linearisation]) -> str:
    """Say which kappa to use, what error to expect, and when to use the nonlinear history instead.

    Parameters
    ----------
    curves : sequence of Linearisation
        The ratios over their ranges, increasing, one for each direction that differs.
    asked : sequence of Linearisation
        The same directions at the amplitudes and accelerations of interest.

    Returns
    -------
    str
        Some sentences; of two directions the larger error counts.
    """
    prefer = preferred(asked)
    order = (1, 2) if prefer == 1 else (2, 1)
    one, two = (_on(kappa, errors(asked, kappa)) for kappa in order)
    amplitudes = ", ".join(f"{r:g}" for r in asked[0].amplitude.tolist())
    accelerations = ", ".join(f"{a:g}" for a in asked[0].acceleration.tolist())
    worse = ", in the worse of the two directions" if len(asked) > 1 else ""
    where = f"At phi/phi_cr = {amplitudes} and {accelerations} times the uplift acceleration{worse}"
    said = [f"{where}: {one}; {two}."]
    if prefer is None:
        said.append("Rely on neither at these amplitudes: use the nonlinear time history of `rocking respond`.")
    elif prefer == 0:
        said.append("Either kappa is adequate at these amplitudes.")
    else:
        said.append(f"Prefer kappa{prefer} at these amplitudes.")
    if prefer is not None and min(errors(asked, kappa).grade for kappa in (1, 2)) is Grade.ESTIMATE:
        said.append("Base decisions on the nonlinear time history of `rocking respond`.")
    return " ".join([*said, *_ranges(curves, order[0])])


def _on(kappa: int, found: Errors) -> str:
    """Describe what the block with a kappa is good for, with its errors."""
    uplift = "kept" if abs(found.uplift) < KEPT else uplift_in_words(found.uplift)
    overturning = f"off by {percent(found.overturning)}" if np.isfinite(found.overturning) else NEVER
    numbers = (
        f"uplift acceleration {uplift}, free period off by {percent(found.period)}, overturning time {overturning}"
    )
    good = {
        Grade.AGREES: f"kappa{kappa} agrees",
        Grade.ESTIMATE: f"kappa{kappa} is good for a first estimate",
        Grade.DISREGARD: f"disregard kappa{kappa}",
    }[found.grade]
    return f"{good} ({numbers})"


def _ranges(curves: Sequence[Linearisation], kappa: int) -> list[str]:
    """Return sentences on the ranges in which errors are no longer small."""
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
        said.append(f"The free period is off by more than {percent(SMALL)} {where}.")
    slow = [each.acceleration[np.abs(getattr(each, f"overturning_ratio{kappa}") - 1) > SMALL] for each in curves]
    late = [values.max() for values in slow if values.size]
    if late:
        everywhere = any(values.size == each.acceleration.size for values, each in zip(slow, curves, strict=True))
        where = "at every acceleration" if everywhere else f"for accelerations below {max(late):.3g} times uplift"
        said.append(f"The overturning time with kappa{kappa} is off by more than {percent(SMALL)} {where}.")
    return said


def _worst(ratios: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    return float(np.abs(ratios - 1).max())
