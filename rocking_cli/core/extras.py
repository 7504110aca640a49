"""Further results of a mechanism, beside the parameters of its equivalent block."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Extra:
    """A result of one direction of rocking, such as the height of the hinge of a wall.

    Parameters
    ----------
    key : str
        Name of the result in JSON, other than those of the parameters of the equivalent block.
    value : float
        Value, in `unit`.
    unit : str
        Unit; empty if dimensionless.
    meaning : str
        Description, in a few words.
    """

    key: str
    value: float
    unit: str
    meaning: str
