"""Grade an equivalent block by its errors, and prefer one of its scalings (kappa): one rule for all commands.

Without an amplitude, the uplift acceleration is compared, which kappa2 keeps and kappa1 does not; at an amplitude, the
free period and the overturning time as well; under a ground motion, the time histories. Each comparison is a relative
error, and the largest error gives the grade. If the uplift acceleration of a kappa is in error by more than
`LARGE_ERROR`, that kappa is to be disregarded: any other agreement is chance.
"""

from __future__ import annotations

from enum import IntEnum
from math import tan
from typing import Literal

from rocking_cli.core.equivalence import Equivalence, EquivalentBlock
from rocking_cli.core.kinematics import Direction

# The paper finds small errors with either kappa for walls of alpha < 0.2: lambda_lin/lambda = 0.2/tan(0.2) there.
SLENDER_LAMBDA_RATIO = 0.2 / tan(0.2)
# Errors up to which a block agrees with its structure, and up to which it is good for a first estimate.
SMALL_ERROR, LARGE_ERROR = (0.05, 0.15)


class Grade(IntEnum):
    """Grade of an equivalent block, from good to bad."""

    AGREES = 0
    ESTIMATE = 1
    DISREGARD = 2

    @property
    def key(self) -> str:
        """Name of the grade in JSON."""
        return ("agrees", "first_estimate", "disregard")[self]


def grade(error: float, small: float = SMALL_ERROR, large: float = LARGE_ERROR) -> Grade:
    """Return the grade of an equivalent block with this error; NaN counts as too large.

    Parameters
    ----------
    error : float
        Relative error of either sign.
    small, large : float
        Largest errors at which the block agrees, and is good for a first estimate.

    Examples
    --------
    >>> grade(-0.04).key, grade(0.1).key, grade(0.2).key
    ('agrees', 'first_estimate', 'disregard')
    """
    size = abs(error)
    return Grade.AGREES if size <= small else Grade.ESTIMATE if size <= large else Grade.DISREGARD


def uplift_error(equivalence: Equivalence) -> float:
    """Return the relative error of the uplift acceleration with kappa1, in the direction where it is larger.

    With kappa2 this error is zero.
    """
    errors = [equivalence[each].lambda_lin / equivalence[each].lambda_ - 1 for each in Direction]
    return max(errors, key=abs)


def preferred_kappa(block: EquivalentBlock) -> Literal["kappa2", "either"]:
    """Return which kappa to use for an equivalent block, judged by the uplift of the linearised mechanism alone.

    lambda_lin/lambda is the paper's measure of effective slenderness: 1 for a slender structure, for which either will
    do.
    """
    return (
        "either" if SLENDER_LAMBDA_RATIO <= block.lambda_lin / block.lambda_ <= 1 / SLENDER_LAMBDA_RATIO else "kappa2"
    )
