"""Check of responses to pulses: amplitudes that overturn a linear block against those of the closed form."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import pi, tan

import numpy as np
from numpy.typing import NDArray

from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.pulse_response import closed_form
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.studies.selfcheck.comparing import largest_difference
from rocking_cli.studies.selfcheck.free_block import FreeBlock

Reals = NDArray[np.float64]
BLOCK = FreeBlock(0.7, 2.8)
ETAS = (0.9, 0.7, 0.8)
OMEGAS = (5.0, 2.5, 8.0, 1.5, 1.9, 3.2, 4.0, 6.3, 10.0, 20.0)
"""Frequencies omega_g/p of the pulses; up to some 6 blocks also overturn after an impact, in ranges of amplitudes."""
AMPLITUDES = np.geomspace(1.01, 100.0, 250)
"""Amplitudes a_g/(g lambda), two of which enclose each threshold."""
HALVINGS = 50  # beyond the last bit


def deviation(quick: bool) -> float:
    """Return the largest relative difference between amplitudes at which overturning begins or ends."""
    return max(_deviation(eta, OMEGAS[:2] if quick else OMEGAS) for eta in (ETAS[:1] if quick else ETAS))


def _deviation(eta: float, omegas: tuple[float, ...]) -> float:
    brackets = np.array([bracket for omega in omegas for bracket in _brackets(omega, eta)])
    omega, low, high, begins = brackets.T
    equivalence = BLOCK.structure().with_eta(eta).equivalence
    unit, periods = STANDARD_GRAVITY * tan(BLOCK.alpha), 2 * pi / (BLOCK.p * omega)

    def computed(a: Reals) -> NDArray[np.bool_]:
        found = exact_many(equivalence, Sine(1.0, 1.0), a * unit, periods, kappa=2, gravity=STANDARD_GRAVITY, threads=1)
        return found.fell

    def in_closed_form(a: Reals) -> NDArray[np.bool_]:
        return np.array([_overturns(*each, eta) is True for each in zip(a, omega, strict=True)])

    expected = _threshold(in_closed_form, low, high, begins)
    return largest_difference(_threshold(computed, low, high, begins) / expected, np.ones_like(expected))


def _brackets(omega: float, eta: float) -> list[tuple[float, float, float, bool]]:
    """Return each threshold: omega, two amplitudes that enclose it, and whether overturning begins there."""
    fates = [_overturns(a, omega, eta) for a in AMPLITUDES]
    return [
        (omega, AMPLITUDES[k], AMPLITUDES[k + 1], bool(after))
        for k, (before, after) in enumerate(pairwise(fates))
        if None not in (before, after) and before != after
    ]


def _overturns(a: float, omega: float, eta: float) -> bool | None:
    """Return whether the linear block overturns, after one impact or without any; None where no formula holds."""
    closed = closed_form(float(a), float(omega), eta)
    if closed.conditions["no_overturning_without_impact"] is False:
        return True
    return closed.overturns


def _threshold(overturns: Callable[[Reals], NDArray[np.bool_]], low: Reals, high: Reals, begins: Reals) -> Reals:
    """Bisect amplitudes between a low and a high one, of which the high one overturns where overturning begins."""
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        beyond = overturns(middle) == (begins == 1)
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return (low + high) / 2
