"""What a mechanism found beside the parameters of its equivalent block."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Extra:
    """A number of one direction of rocking, such as where a wall hinges.

    Parameters
    ----------
    key : str
        Its name in JSON; no parameter of the equivalent block may have it.
    value : float
        The number.
    unit : str
        Its unit; empty for a pure number.
    meaning : str
        What it is, in a few words.
    """

    key: str
    value: float
    unit: str
    meaning: str
