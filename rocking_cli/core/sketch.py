"""What a mechanism adds to its drawing, beside its bodies and their motion: shapes, hinges, dimensions.

Points are complex numbers x + iy [m] in the rest position. All of it is optional: a drawing derives what is missing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import degrees, floor, log10

import numpy as np

from rocking_cli.core.kinematics import Direction
from rocking_cli.short_repr import short_repr

Outline = Sequence[complex]
"""A closed polygon; the last corner need not repeat the first."""


@dataclass(frozen=True)
class Hinge:
    """A point about which bodies rotate relative to one another, or to the ground.

    Parameters
    ----------
    letter : str
        Letter of the hinge in the paper; may be empty.
    point : complex
        Position at rest [m].
    bodies : tuple of str
        Names of the two bodies it joins, or of the one that it joins to the ground.
    slide : complex
        For a guide on the ground, the direction in which the point may move.
    roll : float
        Radius of a rounded edge on which the body rolls, instead of rotating about a point [m].
    """

    letter: str
    point: complex
    bodies: tuple[str, ...]
    slide: complex = 0j
    roll: float = 0.0


@dataclass(frozen=True)
class Length:
    """A length to show between two points; its value is their distance.

    Parameters
    ----------
    symbol : str
        The paper's symbol.
    start, end : complex
        End points [m].
    direction : Direction, optional
        Direction of rocking in which it is shown; None for both.
    derived : bool
        Whether it follows from lengths that are shown: the drawing leaves it out, and lists of lengths do not.
    """

    symbol: str
    start: complex
    end: complex
    direction: Direction | None = None
    derived: bool = False

    @property
    def value(self) -> float:
        """Length [m]."""
        return abs(self.end - self.start)

    @property
    def text(self) -> str:
        """Symbol if there is one, value with three digits, and unit."""
        return f"{self.symbol}{' = ' if self.symbol else ''}{three_digits(self.value)} m"


@dataclass(frozen=True)
class Angle:
    """An angle of less than half a turn to show at `apex`, between the arms to `start` and `end`; see `Length`."""

    symbol: str
    apex: complex
    start: complex
    end: complex
    direction: Direction | None = None

    @property
    def value(self) -> float:
        """Angle [rad]."""
        return abs(float(np.angle((self.end - self.apex) / (self.start - self.apex))))

    @property
    def text(self) -> str:
        """Symbol, value with three digits, and unit."""
        return f"{self.symbol} = {three_digits(degrees(self.value))}°"


@dataclass(frozen=True)
class Line:
    """A line over the structure at rest, such as a line of thrust, with its meaning."""

    name: str
    points: Sequence[complex]
    direction: Direction | None = None


@dataclass(frozen=True)
class Forces:
    """Forces in the joints at rest, with their meaning: points of application [m] and sizes [N]."""

    name: str
    points: Sequence[complex]
    forces: Sequence[complex]
    direction: Direction | None = None


@short_repr
@dataclass(frozen=True)
class Sketch:
    """What a mechanism adds to its drawing.

    Parameters
    ----------
    outlines : mapping of str to sequence of Outline
        Shapes of the bodies, by name. A body without one is drawn as the disc of its mass and inertia.
    uniform : bool
        Whether every body is a uniform plate of its outlines; the contract test then checks the inertias against them.
    copies : mapping of str to sequence of complex
        For a body that represents several identical ones, the offset of each from the body [m], 0 for the body.
    hinges : mapping of Direction to sequence of Hinge
        The hinges of each direction. If empty, they are found from the motion, without letters.
    lengths, angles, lines, forces : sequence
        Items to show at rest.
    ground : sequence of sequence of complex
        Lines of the ground surface, with the ground on the right of their direction. If empty, the ground is level
        under the pivots.
    ground_names : sequence of str
        Names of these lines; empty if they have none.
    at_will : sequence of str
        Names of bodies whose outlines are only illustrative.
    notes : sequence of str
        Remarks on the drawing, such as parts that are not to scale because their size is not given.
    """

    outlines: Mapping[str, Sequence[Outline]] = field(default_factory=dict)
    uniform: bool = False
    copies: Mapping[str, Sequence[complex]] = field(default_factory=dict)
    hinges: Mapping[Direction, Sequence[Hinge]] = field(default_factory=dict)
    lengths: Sequence[Length] = ()
    angles: Sequence[Angle] = ()
    lines: Sequence[Line] = ()
    forces: Sequence[Forces] = ()
    ground: Sequence[Sequence[complex]] = ()
    notes: Sequence[str] = ()
    at_will: Sequence[str] = ()
    ground_names: Sequence[str] = ()

    def __post_init__(self) -> None:
        kinds = {"lengths": Length, "angles": Angle, "lines": Line, "forces": Forces, "notes": str}
        for name, kind in kinds.items():
            value = getattr(self, name)
            if isinstance(value, str) or not all(isinstance(each, kind) for each in value):
                what = "of texts" if kind is str else f"of {kind.__name__}"
                raise TypeError(f"{name} of a sketch must be a sequence {what}, got {value!r}")


def three_digits(value: float) -> str:
    """Return a positive number in text with three digits, and at least one decimal."""
    if not 1e-3 <= value < 1e5:
        return f"{value:.3g}"
    return f"{round(value, max(1, 2 - floor(log10(value)))):g}"


def rectangle(centre: complex, width: float, height: float) -> Outline:
    """Return the corners of a level rectangle `width` by `height` [m], anticlockwise from the lower left."""
    across, up = width / 2, 1j * height / 2
    return centre - across - up, centre + across - up, centre + across + up, centre - across + up


def disc(centre: complex, radius: float, corners: int = 48) -> Outline:
    """Return a circle [m] as a polygon."""
    return tuple(complex(centre + radius * np.exp(2j * np.pi * k / corners)) for k in range(corners))
