"""What an import says of a drawing: each note with a number, and places."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.io.drawings.contract import DrawingError


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
    """The unit and the origin of a drawing, its closing distance [m] and its file.

    Metres are (units - origin) times `per`.
    """

    per: float
    origin: complex
    close: float
    file: str

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

    def refusal(self, refused: str, message: str, at: Iterable[complex] = (), hint: str | None = None) -> DrawingError:
        """Return the error of a class, with its places [m]; `<here>` in the message is the first one, in words."""
        points = list(at)
        if points:
            message = message.replace("<here>", self.place(points[0]))
        return DrawingError(refused, message, self.file, [[z.real, z.imag] for z in map(self.to_drawing, points)], hint)


def length_in_words(metres: float) -> str:
    """Return a small length in millimetres, a larger one in metres."""
    return f"{1000 * metres:.3g} mm" if metres < 1 else f"{metres:.4g} m"


def many(count: int, name: str) -> str:
    """Return a number of things: "1 line", "2 lines"."""
    return f"{count:,} {name}{'' if count == 1 else 's'}"
