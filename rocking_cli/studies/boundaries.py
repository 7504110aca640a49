"""Boundaries in the plane of a pulse where the linear block's motion up to its first impact is known in closed form.

Dimensionless as in Eq. 40: x = phi/phi_cr, tau = p t from uplift, and x'' = x - 1 + a sin(omega tau + theta_0) until
the pulse ends. Split into y = x' + x - 1, which grows, and z = x' - x + 1, which decays,

    y' = y + a sin(.),  z' = -z + a sin(.),  y = -1 and z = 1 at uplift,

the motion at the end of the pulse follows by two integrals. After it, y and z vary as exp(tau) and exp(-tau): the block
overturns without impact if y > 0; else its rate v at the first impact is given by v^2 - 1 = y z, if x >= 0 at the end
of the pulse. For the full sine these are the conditions (ii) and (iii) of Eqs. 41-42, and y z is -D0* of Eq. 42.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from rocking_cli.excitation.pulses import Pulse

Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Boundary:
    """A boundary in the plane of omega and a.

    Parameters
    ----------
    name : str
        `uplift`, `without_impact`, `after_one_impact` or `impact_at_end`.
    title : str
        The outcomes that the boundary separates, in words.
    level : callable
        Function of omega and a, arrays of one shape: zero on the boundary, positive above it, NaN where it is not
        valid.
    """

    name: str
    title: str
    level: Callable[[Reals, Reals], Reals]


def uplift_level(omega: Reals, a: Reals) -> Reals:
    """Return a - 1, which is positive where a pulse uplifts the block."""
    level: Reals = a - 1 + 0 * omega
    return level


UPLIFT = Boundary("uplift", "uplift, a = 1", uplift_level)


def boundaries(shape: Pulse, eta: float) -> list[Boundary]:
    """Return the boundaries of the linear block that are known for a pulse shape; uplift is known for every shape.

    Parameters
    ----------
    shape : Pulse
        Any pulse of the shape.
    eta : float
        Coefficient of restitution.
    """
    pieces = shape.segments()
    if len(pieces) != 1:
        return [UPLIFT]
    end = _End(shape)

    def without_impact(omega: Reals, a: Reals) -> Reals:
        y, _, _ = end(omega, a)
        return y

    def impact_at_end(omega: Reals, a: Reals) -> Reals:
        y, _, x = end(omega, a)
        return np.where(y < 0, x, np.nan)

    def after_one_impact(omega: Reals, a: Reals) -> Reals:
        y, yz, x = end(omega, a)
        level: Reals = np.where((y < 0) & (x >= 0), eta**2 * (1 + yz) - 1, np.nan)  # Eqs. 41-42
        return level

    return [
        UPLIFT,
        Boundary("without_impact", "overturning without impact", without_impact),
        Boundary("after_one_impact", "overturning after one impact", after_one_impact),
        Boundary("impact_at_end", "first impact at the end of the pulse", impact_at_end),
    ]


class _End:
    """Motion of the linear block at the end of a pulse, ignoring impacts before it.

    Called with omega and a, it returns y in units of exp(tau_e), y z, and x; NaN where the block does not uplift.
    """

    def __init__(self, shape: Pulse) -> None:
        (piece,) = shape.segments()
        self.phase = piece.phase
        self.turns = piece.omega * shape.duration  # [rad]
        self.periods = shape.duration / shape.period

    def __call__(self, omega: Reals, a: Reals) -> tuple[Reals, Reals, Reals]:
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            a = np.where(a > 1, a, np.nan)
            theta_0 = np.maximum(np.arcsin(1 / a), self.phase)
            theta_e = self.phase + self.turns
            rate = omega if self.turns > 0 else np.zeros_like(omega)
            tau_e = (theta_e - theta_0) / omega if self.turns > 0 else 2 * pi * self.periods / omega
            c = a / (1 + rate**2)
            sin_0, cos_0, sin_e, cos_e = np.sin(theta_0), np.cos(theta_0), np.sin(theta_e), np.cos(theta_e)
            y = c * (sin_0 + rate * cos_0 - np.exp(-tau_e) * (sin_e + rate * cos_e)) - 1
            z = np.exp(-tau_e) * (1 - c * (sin_0 - rate * cos_0)) + c * (sin_e - rate * cos_e)
            grown = np.exp(tau_e) * y
            return y, grown * z, 1 + (grown - z) / 2
