"""A tie whose force grows with the cube of its elongation, as a package of its own would give it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rocking_cli.core import Reals, Spot, quantity
from rocking_cli.core.hung import Element, Stretched, Tie


@dataclass(frozen=True)
class Cubic(Stretched):
    """N = N0 + k e + c e^3."""

    stiffness: float
    prestress: float
    cubic: float
    is_linear = False
    departs = "stiffens with the cube of its elongation"

    @property
    def words(self) -> str:
        return f"a tie of {self.stiffness / 1e3:.4g} kN/m that stiffens by {self.cubic / 1e3:.4g} kN/m3"

    def force(self, e: Reals) -> Reals:
        return self.prestress + self.stiffness * e + self.cubic * e**3

    def slope(self, e: Reals, going: Reals) -> Reals:
        return self.stiffness + 3 * self.cubic * e**2

    def energy(self, e: Reals) -> Reals:
        return self.prestress * e + self.stiffness * e**2 / 2 + self.cubic * e**4 / 4


class Stiffening(Tie):
    """An elastic tie that stiffens as it stretches."""

    law: Literal["stiffening"] = "stiffening"
    cubic: float = quantity("how it stiffens: force over the cube of the elongation", unit="N/m3", example=1e9, gt=0)

    def element(self, spots: Sequence[Spot], count: float) -> Element:
        return Cubic(self.name, spots, self.k, self.prestress, self.cubic, count=count)
