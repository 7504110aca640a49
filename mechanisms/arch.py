"""The circular masonry arch as a four-hinge mechanism [paper, Section 5.2; Oppenheim 1992]."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from math import ceil, floor, log10, pi, radians
from typing import ClassVar, Self

import numpy as np
from pydantic import model_validator

from mechanisms._arch_collapse import ArchCannotStand, Ring, collapse_hinges, least_thickness
from rocking_cli.core import (
    Body,
    Direction,
    Mechanism,
    Reals,
    RigidMotion,
    annular_sector,
    four_bar,
    four_bar_limit,
    geometry_error,
    length,
    quantity,
    rotation,
)
from rocking_cli.errors import MechanismError


class Arch(Mechanism):
    """A ring of constant thickness on fixed springings; its hinges are those of the least ground acceleration."""

    mechanism: ClassVar[str] = "arch"
    title: ClassVar[str] = "circular masonry arch, four hinges"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Section 5.2; Oppenheim (1992)"
    verified: ClassVar[str] = "static theorem (linear programme of the line of thrust); Oppenheim's arch, lambda = 0.37"

    radius: float = length("radius of the centre line", symbol="r", example=10.0)
    thickness: float = length("thickness of the ring", symbol="t", example=1.5)
    inclusion_angle_deg: float = quantity(
        "angle between the springings", unit="deg", symbol="beta", example=157.5, gt=0, le=180
    )
    voussoirs: int | None = quantity(
        "number of equal voussoirs, whose joints may open; absent: hinges anywhere",
        symbol="n",
        example=7,
        default=None,
        ge=3,
        le=10_000,
    )

    @model_validator(mode="after")
    def _rocks(self) -> Self:
        if self.thickness >= 2 * self.radius:
            raise geometry_error(
                "thickness", f"the ring has no intrados: thickness must be less than {2 * self.radius:g} m"
            )
        try:
            self.hinge_angles  # noqa: B018 - found once, here, so that a structure that exists can rock
        except ArchCannotStand:
            least = least_thickness(self._beta, self.voussoirs) * self.radius
            raise geometry_error(
                "thickness",
                f"too thin to stand under its own weight (t/r = {self.thickness / self.radius:.4g}): "
                f"the arch needs at least {_round_up(least, 6):.6g} m (t/r = {_round_up(least / self.radius, 4):.4g})",
            ) from None
        except MechanismError as error:
            raise geometry_error("thickness", str(error)) from None
        return self

    @property
    def _beta(self) -> float:
        return radians(self.inclusion_angle_deg)

    @cached_property
    def hinge_angles(self) -> tuple[float, float, float, float]:
        """Angles of A, B, C and D from the springing on the left (positive) or right (negative) [rad]."""
        return collapse_hinges(Ring(self.thickness / self.radius, self._beta), self.voussoirs)

    def hinges(self, direction: Direction) -> tuple[complex, complex, complex, complex]:
        """Rest positions of A, B, C and D [m]; the centre of the ring is the origin."""
        half = self.thickness / 2
        radii = (self.radius - half, self.radius + half) * 2  # intrados, extrados, intrados, extrados
        a, b, c, d = (
            complex(radius * np.exp(1j * (pi / 2 + direction * (self._beta / 2 - angle))))
            for radius, angle in zip(radii, self.hinge_angles, strict=True)
        )
        return a, b, c, d

    @cached_property
    def _cuts(self) -> tuple[float, ...]:
        # Bodies must be rigid in both directions: the ring is cut at the hinges of both.
        mirrored = [self._beta - angle for angle in self.hinge_angles]
        cuts = sorted({*self.hinge_angles, *mirrored})
        # A cut that is its own mirror image (up to rounding) is one cut, not a sliver between two.
        return tuple(cut for k, cut in enumerate(cuts) if k == 0 or cut - cuts[k - 1] > 1e-12)

    def bodies(self) -> Sequence[Body]:
        half = self.thickness / 2
        inner, outer = self.radius - half, self.radius + half
        density = 2 / (self._beta * (outer**2 - inner**2))  # 1 kg for the whole ring
        left = pi / 2 + self._beta / 2
        return tuple(
            annular_sector(f"segment {k + 1}", density, inner, outer, left - start, left - end)
            for k, (start, end) in enumerate(pairwise(self._cuts))
        )

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        hinges = self.hinges(direction)
        links = (rotation(phi, hinges[0], 0.0), *four_bar(phi, direction, *hinges), rotation(phi, hinges[3], 0.0))
        middles = (np.array(self._cuts[:-1]) + np.array(self._cuts[1:])) / 2
        along = middles if direction > 0 else self._beta - middles
        return tuple(links[k] for k in np.searchsorted(self.hinge_angles, along))

    def limit(self, direction: Direction) -> float:
        return four_bar_limit(direction, *self.hinges(direction))


def _round_up(value: float, digits: int) -> float:
    """A positive number rounded up to some digits, so that what an error recommends is accepted."""
    unit = 10.0 ** (floor(log10(value)) - digits + 1)
    return ceil(value / unit) * unit
