"""A free-standing block in formulas, and the same block as a structure."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, hypot, sin, sqrt

from rocking_cli.core.registry import Registry
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.structure import Structure


@dataclass(frozen=True)
class FreeBlock:
    """A free-standing rectangular block [Housner, 1963].

    Parameters
    ----------
    width, height : float
        Width and height [m].
    """

    width: float
    height: float

    @property
    def alpha(self) -> float:
        """Angle between a side and a diagonal, which is the critical rotation [rad]."""
        return atan(self.width / self.height)

    @property
    def p(self) -> float:
        """Frequency parameter [rad/s], p^2 = 3 g/(4 R) with half the diagonal R."""
        return sqrt(1.5 * STANDARD_GRAVITY / hypot(self.width, self.height))

    @property
    def eta(self) -> float:
        """Coefficient of restitution, from the angular momentum about the new pivot."""
        return 1 - 1.5 * sin(self.alpha) ** 2

    def structure(self) -> Structure:
        """Return the block as a structure of the installed mechanism `block`."""
        return Structure(Registry()["block"].from_fields({"width": self.width, "height": self.height}))
