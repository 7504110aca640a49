"""What the intensity of a ground motion is measured by, alone or relative to the structure it shakes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.excitation.base import STANDARD_GRAVITY

Reals = NDArray[np.float64]

PGA, PGV = "PGA", "PGV"
PGA_RATIO, PGV_RATIO = "PGA/(g lambda)", "p PGV/(g lambda)"
MEASURES = (PGA, PGV, PGA_RATIO, PGV_RATIO)
UNITS = {PGA: "g", PGV: "m/s", PGA_RATIO: "", PGV_RATIO: ""}


@dataclass(frozen=True, eq=False)
class Scales:
    """What the dimensionless measures refer to, of one structure or of many: numbers, or arrays of one shape.

    Parameters
    ----------
    p : float or ndarray
        Frequency parameter [rad/s].
    lambda_ : float or ndarray
        Uplift acceleration over g.
    gravity : float or ndarray
        [m/s2].
    """

    p: float | Reals
    lambda_: float | Reals
    gravity: float | Reals


def intensity(measure: str, pga: float | Reals, pgv: float | Reals, scales: Scales) -> Reals:
    """The intensity of motions for structures.

    Parameters
    ----------
    measure : str
        One of `MEASURES`.
    pga, pgv : float or ndarray
        Peaks of the motions [standard gravity], [m/s].
    scales : Scales
        Of the structures; all arrays have one shape, that of the result.

    Notes
    -----
    PGA/(g lambda) is the a of a pulse [paper, Eq. 40]: 1 is needed to uplift. p PGV/(g lambda) is its velocity.
    """
    least = scales.gravity * scales.lambda_  # m/s2, uplifts
    if measure == PGA_RATIO:
        pga = pga * STANDARD_GRAVITY / least
    if measure == PGV_RATIO:
        pgv = scales.p * pgv / least
    return np.asarray(pga if measure in (PGA, PGA_RATIO) else pgv, dtype=np.float64)


def proportional(one: str, other: str) -> bool:
    """Whether two measures are in proportion for one structure: both of the acceleration, or both of the velocity."""
    return any(one in pair and other in pair for pair in ((PGA, PGA_RATIO), (PGV, PGV_RATIO)))


def label(measure: str) -> str:
    """A measure with its unit, for a heading."""
    return f"{measure} [{UNITS[measure]}]" if UNITS[measure] else measure
