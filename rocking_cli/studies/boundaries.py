"""Boundaries between outcomes of the linear block under a pulse, in closed form.

A pulse has a dimensionless frequency omega and amplitude a. In the plane of omega and a, boundaries separate pulses
that do not uplift the block, pulses that it survives, and pulses that overturn it without an impact or after one. They
are known exactly for pulses that are a single sine or a single constant.

The equation of motion is dimensionless as in Eq. 40, with x = phi/phi_cr and tau = p t from uplift: x'' = x - 1 +
a sin(omega tau + theta_0) until the pulse ends. The change of variables y = x' + x - 1 and z = x' - x + 1 gives

    y' = y + a sin(.),  z' = -z + a sin(.),  y = -1 and z = 1 at uplift.

Two integrals therefore give y and z at the end of the pulse. After it, y grows as exp(tau) and z decays as exp(-tau).
The block overturns without impact if y > 0 at the end of the pulse. Otherwise, if x >= 0 there, the block returns and
its rate v at the first impact follows from v^2 - 1 = y z. For the full sine these are the conditions (ii) and (iii) of
Eqs. 41-42, and y z is -D0* of Eq. 42.
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


UPLIFT = Boundary("uplift", "uplift, a = 1", lambda omega, a: a - 1 + 0 * omega)


def boundaries(shape: Pulse, eta: float) -> list[Boundary]:
    """Return the boundaries of the linear block that are known in closed form for a pulse shape.

    Uplift is known for every shape, the others only for a shape that is a single sine or a single constant.

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
    end = _end_of(shape)

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


def _end_of(shape: Pulse) -> Callable[[Reals, Reals], tuple[Reals, Reals, Reals]]:
    """Return the motion of the linear block at the end of a pulse, ignoring impacts before it.

    It is a function of omega and a, which returns y exp(-tau_e), y z and x at the end of the pulse, tau_e, with y and z
    as in the module; NaN if the block does not uplift.
    """
    (piece,) = shape.segments()
    turns, periods = piece.omega * shape.duration, shape.duration / shape.period  # [rad], -

    def end(omega: Reals, a: Reals) -> tuple[Reals, Reals, Reals]:
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            a = np.where(a > 1, a, np.nan)
            theta_0 = np.maximum(np.arcsin(1 / a), piece.phase)
            theta_e = piece.phase + turns
            rate = omega if turns > 0 else np.zeros_like(omega)
            tau_e = (theta_e - theta_0) / omega if turns > 0 else 2 * pi * periods / omega
            c = a / (1 + rate**2)
            sin_0, cos_0, sin_e, cos_e = np.sin(theta_0), np.cos(theta_0), np.sin(theta_e), np.cos(theta_e)
            y = c * (sin_0 + rate * cos_0 - np.exp(-tau_e) * (sin_e + rate * cos_e)) - 1
            z = np.exp(-tau_e) * (1 - c * (sin_0 - rate * cos_0)) + c * (sin_e - rate * cos_e)
            grown = np.exp(tau_e) * y
            return y, grown * z, 1 + (grown - z) / 2

    return end
