"""Check of the free motion: a released block against quadrature of the first integral of its equation of motion."""

from __future__ import annotations

from math import acosh, cosh, sin, sqrt

from scipy.integrate import quad

from rocking_cli.dynamics.history import follow
from rocking_cli.studies.selfcheck.comparing import largest_difference
from rocking_cli.studies.selfcheck.free_block import FreeBlock

IMPACTS = 8
BLOCKS = (FreeBlock(0.7, 2.8), FreeBlock(0.05, 0.3), FreeBlock(2.0, 5.0), FreeBlock(1.0, 8.0))
TILTS = (0.5, 0.05, -0.9, 0.99)
"""Releases, as fractions of the critical rotation."""


def deviation(quick: bool) -> float:
    """Return the largest difference between times of impacts [s]."""
    blocks, tilts = (BLOCKS[:1], TILTS[:1]) if quick else (BLOCKS, TILTS)
    return max(_deviation(block, tilt) for block in blocks for tilt in tilts)


def _deviation(block: FreeBlock, tilt: float) -> float:
    history = follow(block.structure().model("nonlinear"), None, release=tilt)
    return largest_difference(history.impacts[:IMPACTS, 0], impact_times(block, abs(tilt)))


def impact_times(block: FreeBlock, tilt: float) -> list[float]:
    """Return the times of the first impacts of a block released from a fraction of its critical rotation [s].

    With S = sin^2((alpha - phi)/2), the first integral of phi'' = -p^2 sin(alpha - phi) from rest at S = k is
    phi'^2 = 4 p^2 (S - k). By sin((alpha - phi)/2) = sqrt(k) cosh(y), the time from rest to the ground is an integral
    without singularity over y.
    """
    ground = sin(block.alpha / 2) ** 2
    k = sin(block.alpha * (1 - tilt) / 2) ** 2
    times: list[float] = []
    time = -_quarter(block.p, k, ground)  # it starts in the middle of an excursion
    for _ in range(IMPACTS):
        time += 2 * _quarter(block.p, k, ground)
        times.append(time)
        k = ground - block.eta**2 * (ground - k)  # the impact multiplies phi' at the ground by eta
    return times


def _quarter(p: float, k: float, ground: float) -> float:
    """Return the time from rest to the ground [s]."""
    found, _ = quad(lambda y: 1 / sqrt(1 - k * cosh(y) ** 2), 0.0, acosh(sqrt(ground / k)), epsabs=0.0, epsrel=1e-13)
    return float(found) / p
