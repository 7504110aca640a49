"""Ties as masons build them: bars of steel with anchor plates on a masonry wall, and the strength that follows.

The least governs: the bars yield, a plate bends, punches through the wall, or crushes it. The formulas of the plates
are in common use; they have not been checked against a printed source.
"""

from __future__ import annotations

from math import pi
from typing import Any, Literal, NamedTuple

from pydantic import ConfigDict, Field

from rocking_cli.core.fields import Described, Name, length, quantity

SteelName = Literal["S235", "S275", "S355", "B450C", "FeB22k", "FeB32k", "FeB38k", "FeB44k"]
STEELS: dict[SteelName, float] = {
    "S235": 235e6, "S275": 275e6, "S355": 355e6, "B450C": 450e6,
    "FeB22k": 215e6, "FeB32k": 315e6, "FeB38k": 375e6, "FeB44k": 430e6,
}  # fmt: skip
"""Characteristic yield stress [Pa]: EN 10025-2 as in NTC 2018, table 4.2.I; B450C of NTC 2018, 11.3.2.1; FeB of the
Italian decree of 9 January 1996."""
STEEL_MODULUS = 210e9  # Pa, modulus of elasticity: NTC 2018, 11.3.4.1; EN 1993-1-1, 3.2.6
MAX_STRAIN = 0.02  # elongation of a tie over its length beyond which it is not known to hold, if the file gives none
MAX_NAMED_DIAMETER = 0.04  # m; the standards give thicker steel a lower yield stress than its name says
BAR_DIAMETERS = tuple(d / 1000 for d in (12, 14, 16, 18, 20, 22, 24, 26, 28, 30, 32))
"""Diameters of bars that are proposed [m]."""


def partial_factor(strength: str) -> Any:
    """Declare a partial factor on a strength, 1 if it is not given."""
    return quantity(f"partial factor by which {strength} divided", symbol="gamma", default=None, ge=1, le=10)


class AnchorPlate(Described):
    """The anchor plate of one bar; its bending counts if it has a thickness."""

    model_config = ConfigDict(validate_by_name=True)

    width: float = length("width of the plate, along the wall", symbol="b", example=0.3)
    height: float = length("height of the plate", symbol="h", example=0.3)
    thickness: float | None = quantity(
        "thickness of the plate, which then bends between the bar and its edges", unit="m", symbol="s", example=0.02,
        default=None, gt=0, le=1,
    )  # fmt: skip
    yield_stress: float = quantity(
        "yield stress of the plate; if omitted, 235 MPa", unit="Pa", symbol="f_y", default=235e6, ge=1e7, le=1e12,
        alias="yield",
    )  # fmt: skip
    gamma: float | None = partial_factor("its yield stress is")


class BearingWall(Described):
    """The masonry that an anchor plate bears on."""

    thickness: float = length("thickness of the wall", symbol="t", example=0.6)
    compression: float = quantity(
        "compressive strength of the masonry", unit="Pa", symbol="f_c", example=1e6, ge=1e4, le=1e12
    )
    shear: float = quantity("shear strength of the masonry", unit="Pa", symbol="f_v", example=5e4, ge=1e3, le=1e12)
    gamma: float | None = partial_factor("both strengths are")
    source: Name | None = Field(None, description="where both strengths are from, such as a test or a table of a code")


class TieStrength(NamedTuple):
    """Strength of a tie by each of its limits.

    Parameters
    ----------
    limits : dict of str to float
        Force [N] at which the bars yield (`yield`), and, if there are plates, at which these punch through the wall
        (`punching`), crush it (`bearing`) or, if their thickness is known, bend (`bending`).
    """

    limits: dict[str, float]

    @property
    def governs(self) -> str:
        """Key of the limit that governs, the least."""
        return min(self.limits, key=self.limits.__getitem__)

    @property
    def force(self) -> float:
        """The strength, the least of all limits [N]."""
        return self.limits[self.governs]


def tie_strength(
    section: float, stress: float, count: float, plate: AnchorPlate | None = None, wall: BearingWall | None = None
) -> TieStrength:
    """Return the strength of a tie of several bars.

    Parameters
    ----------
    section : float
        Area of the section of one bar [m2].
    stress : float
        Yield stress over its partial factor [Pa].
    count : float
        Number of bars, each with one plate.
    plate, wall : AnchorPlate, BearingWall, optional
        An anchor plate and the wall under it, both or neither. The plate punches out a cone at 45 degrees, and bends as
        a cantilever on either side of the bar, under an even pressure of the wall, until its section is plastic.

    Examples
    --------
    >>> wall = BearingWall(thickness=0.6, compression=1e6, shear=5e4)
    >>> strength = tie_strength(circle(0.024), STEELS["S235"], 2, AnchorPlate(width=0.3, height=0.3), wall)
    >>> strength.governs, round(strength.force)
    ('bearing', 180000)
    """
    limits = {"yield": count * section * stress}
    if plate is not None and wall is not None:
        b, h, t = plate.width, plate.height, wall.thickness
        limits["punching"] = count * 2 * t * (b + h + 2 * t) * wall.shear / (wall.gamma or 1)
        limits["bearing"] = count * b * h * wall.compression / (wall.gamma or 1)
        if (s := plate.thickness) is not None:
            limits["bending"] = count * 2 * s**2 * plate.yield_stress / (plate.gamma or 1) * min(b / h, h / b)
    return TieStrength(limits)


def circle(diameter: float) -> float:
    """Return the area of a circle [m2]."""
    return pi * diameter**2 / 4
