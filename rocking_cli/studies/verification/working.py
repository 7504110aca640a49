"""How a number of a verification came about: its formula, what was put in, its clause, and how far that was checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Standing = Literal["code", "ours", "plain"]
"""Of a formula: of the code, and not yet checked against its printed text; ours, where the code leaves it open; or
plain mechanics and arithmetic, which need no code."""
MEANING: dict[Standing, str] = {
    "code": "a formula of the code that has not yet been checked against its printed text",
    "ours": "our reading, or our choice where the code leaves it open",
    "plain": "mechanics or arithmetic, which need no code",
}


@dataclass(frozen=True)
class Working:
    """A line of a calculation.

    Parameters
    ----------
    symbol : str
        What is computed, as the code calls it.
    meaning : str
        What it is, in a few words.
    formula : str
        By which formula, in plain text.
    numbers : str
        The same with numbers put in; empty where they are many.
    value : float
        The result.
    unit : str
        Its unit; empty for a pure number.
    clause : str
        Where in the code.
    standing : {"code", "ours", "plain"}
        How far the formula was checked, see `MEANING`.
    """

    symbol: str
    meaning: str
    formula: str
    numbers: str
    value: float
    unit: str
    clause: str
    standing: Standing = "code"
