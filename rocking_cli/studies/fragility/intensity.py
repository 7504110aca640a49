"""What the intensity of a ground motion is measured by, alone or relative to the structure it shakes.

One table, `MEASURES`. A measure of another quantity of the motion needs that quantity in `sources.Record`, and so in
the table `record` of a store, with a new `store_file.VERSION`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.excitation.base import STANDARD_GRAVITY

Reals = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Reference:
    """What dimensionless measures are relative to, of one structure or of many: numbers, or arrays of one shape.

    Parameters
    ----------
    p : float or ndarray
        Frequency parameter [rad/s]; NaN where there is none.
    lambda_ : float or ndarray
        Uplift acceleration over g.
    gravity : float or ndarray
        [m/s2].
    """

    p: float | Reals
    lambda_: float | Reals
    gravity: float | Reals

    @property
    def uplift(self) -> float | Reals:
        """The acceleration at uplift [m/s2]."""
        return self.gravity * self.lambda_


@dataclass(frozen=True)
class Measure:
    """A measure of intensity.

    Parameters
    ----------
    name, unit : str
        Of it; a dimensionless one has no unit.
    of : str
        Which quantity of the motion it is of: a field of `sources.Record`, in proportion to the factor on the motion.
    relative : callable, optional
        What it makes of that for a structure; without it the measure is that quantity itself.
    needs_p : bool
        Whether it asks for the frequency parameter, which a structure without an equivalent block has not.
    """

    name: str
    unit: str
    of: str
    relative: Callable[[float | Reals, Reference], float | Reals] | None = None
    needs_p: bool = False


PGA, PGV = "PGA", "PGV"
MEASURES: Mapping[str, Measure] = {
    each.name: each
    for each in (
        Measure(PGA, "g", "pga"),
        Measure(PGV, "m/s", "pgv"),
        # The a of a pulse [paper, Eq. 40]: 1 is needed to uplift.
        Measure("PGA/(g lambda)", "", "pga", lambda pga, of: pga * STANDARD_GRAVITY / of.uplift),
        Measure("p PGV/(g lambda)", "", "pgv", lambda pgv, of: of.p * pgv / of.uplift, needs_p=True),
    )
}


def intensity(measure: str, motion: Mapping[str, float | Reals], reference: Reference) -> Reals:
    """The intensity of motions for structures.

    Parameters
    ----------
    measure : str
        One of `MEASURES`.
    motion : mapping of str to float or ndarray
        The quantities that measures are of, such as `pga` [standard gravity] and `pgv` [m/s].
    reference : Reference
        Of the structures; all arrays have one shape, that of the result.
    """
    asked = MEASURES[measure]
    value = motion[asked.of]
    return np.asarray(value if asked.relative is None else asked.relative(value, reference), dtype=np.float64)


def quantities() -> tuple[str, ...]:
    """The quantities of a motion that measures are of, each once."""
    return tuple(dict.fromkeys(each.of for each in MEASURES.values()))


def of_the_motion(measure: str) -> bool:
    """Whether a measure, or the factor on the records, does not ask what is shaken."""
    return measure not in MEASURES or MEASURES[measure].relative is None


def proportional(one: str, other: str) -> bool:
    """Whether two measures are in proportion for one structure: both of the acceleration, or both of the velocity."""
    return one in MEASURES and other in MEASURES and MEASURES[one].of == MEASURES[other].of


def label(measure: str) -> str:
    """A measure with its unit, for a heading."""
    unit = MEASURES[measure].unit
    return f"{measure} [{unit}]" if unit else measure
