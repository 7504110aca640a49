"""How a number of a verification came about: its formula, what was put in, its clause, and how far that was checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Self

Standing = Literal["transcription", "code", "ours", "plain"]
"""Of a formula: of the code, and checked against a transcription of its text but not yet against its print; of the
code, and not yet checked; ours, where the code leaves it open; or plain mechanics and arithmetic."""
MEANING: dict[Standing, str] = {
    "transcription": "a formula of the code, checked against a transcription of its text but not yet against its print",
    "code": "a formula of the code that has not yet been checked against its text",
    "ours": "our reading, or our choice where the code leaves it open",
    "plain": "mechanics or arithmetic, which need no code",
}


class Clause(str):
    """A place in a code; transcribed if what it says was checked against a transcription of the text."""

    __slots__ = ("transcribed",)
    transcribed: bool

    def __new__(cls, place: str, *, transcribed: bool = False) -> Self:
        """Make a clause of a place."""
        clause = super().__new__(cls, place)
        clause.transcribed = transcribed
        return clause


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
    standing : {"transcription", "code", "ours", "plain"}
        How far the formula was checked, see `MEANING`; of a formula of the code its clause decides.
    """

    symbol: str
    meaning: str
    formula: str
    numbers: str
    value: float
    unit: str
    clause: str
    standing: Standing = "code"

    def __post_init__(self) -> None:
        if self.standing == "code" and isinstance(self.clause, Clause) and self.clause.transcribed:
            object.__setattr__(self, "standing", "transcription")
