"""What an import says of a drawing: each note with a number, and places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Points


@dataclass(frozen=True)
class ImportNote:
    """A thing that was mended, assumed or left out.

    Parameters
    ----------
    kind : str
        Its kind, such as "joined" or "left out".
    count : int
        How many times.
    words : str
        The sentence, without a full stop.
    at : sequence of complex
        Where [units of the drawing].
    """

    kind: str
    count: int
    words: str
    at: Sequence[complex] = ()


class DrawingFrame(NamedTuple):
    """The unit and the origin of a drawing: metres are (units - origin) times `per`."""

    per: float
    origin: complex

    def to_metres(self, z: Points) -> Points:
        """Return points in metres."""
        return (np.asarray(z) - self.origin) * self.per

    def to_drawing(self, z: complex) -> complex:
        """Return a point in units of the drawing."""
        return complex(z) / self.per + self.origin

    def place(self, z: complex) -> str:
        """Return a point in words, in units of the drawing."""
        at = self.to_drawing(z)
        return f"({at.real:.7g}, {at.imag:.7g})"

    def pairs(self, points: Sequence[complex]) -> list[list[float]]:
        """Return points as plain data, in units of the drawing."""
        return [[at.real, at.imag] for at in map(self.to_drawing, points)]


def length_in_words(metres: float) -> str:
    """Return a small length in millimetres, a larger one in metres."""
    return f"{1000 * metres:.3g} mm" if metres < 1 else f"{metres:.4g} m"


def many(count: int, name: str) -> str:
    """Return a number of things: "1 line", "2 lines"."""
    return f"{count:,} {name}{'' if count == 1 else 's'}"
