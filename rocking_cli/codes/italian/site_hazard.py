"""Seismic hazard at a site by return period, and the effects of soil and topography [NTC 2018, 3.2]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log

import numpy as np

from rocking_cli.codes.italian.demand import GroundSpectrum
from rocking_cli.codes.italian.rules import RULES
from rocking_cli.errors import InputError, Problem

PROBABILITY = {"SLO": 0.81, "SLD": 0.63, **{rule.state: rule.probability for rule in RULES}}
"""Of being exceeded in the reference life, by limit state."""
SHORTEST, LONGEST = 30.0, 2475.0  # years: return periods beyond are taken as these
SOILS = {
    "A": (1.0, 0.0, 1.0, 1.0, 1.0, 0.0),
    "B": (1.40, 0.40, 1.0, 1.2, 1.10, -0.20),
    "C": (1.70, 0.60, 1.0, 1.5, 1.05, -0.33),
    "D": (2.40, 1.50, 0.9, 1.8, 1.25, -0.50),
    "E": (2.00, 1.10, 1.0, 1.6, 1.15, -0.40),
}
"""Of each soil: S_S = first - second F0 ag/g between third and fourth, C_C = fifth TC*^sixth."""
TOPOGRAPHY = {"T1": 1.0, "T2": 1.2, "T3": 1.2, "T4": 1.4}
"""S_T."""


def soil_factor(soil: str, F0: float, ag: float) -> float:
    """Return the factor S_S of a soil class, for a_g in g."""
    first, second, least, most, _, _ = SOILS[soil]
    return min(max(first - second * F0 * ag, least), most)


def corner_factor(soil: str, TC_star: float) -> float:
    """Return the factor C_C of a soil class, for TC* in s."""
    *_, factor, power = SOILS[soil]
    return factor * float(TC_star**power)


def return_period(life: float, state: str) -> float:
    """Return TR = -VR/ln(1 - P) of a limit state [years], with VR the reference life."""
    return -life / log(1 - PROBABILITY[state])


@dataclass(frozen=True)
class Hazard:
    """Seismic hazard of a site.

    Parameters
    ----------
    table : sequence of (TR, ag, F0, TC*)
        Return period [years], ground acceleration on rock [g], amplification, period [s].
    soil, topography : str
        Soil class A to E, and topographic class T1 to T4.
    """

    table: Sequence[Sequence[float]]
    soil: str
    topography: str

    @property
    def first(self) -> float:
        """Shortest return period that is used [years]."""
        return max(self.table[0][0], SHORTEST)

    @property
    def last(self) -> float:
        """Longest return period that is used [years]."""
        return min(self.table[-1][0], LONGEST)

    def parameters(self, TR: float) -> tuple[float, float, float]:
        """Return ag [g], F0 and TC* [s] at a return period [years], interpolated in logarithms."""
        known = np.log(np.array(self.table, dtype=np.float64))
        ag, F0, TC = (exp(np.interp(log(TR), known[:, 0], known[:, k])) for k in (1, 2, 3))
        return ag, F0, TC

    def spectrum(self, TR: float) -> GroundSpectrum:
        """Return the spectrum of the ground at a return period [years]."""
        ag, F0, TC_star = self.parameters(TR)
        S = soil_factor(self.soil, F0, ag) * TOPOGRAPHY[self.topography]
        return GroundSpectrum(ag, F0, corner_factor(self.soil, TC_star) * TC_star, S, self.soil)

    def counted(self, life: float, state: str) -> float:
        """Return the return period of a limit state, limited to the range that the code allows [years].

        Raises `InputError` if it is beyond the table of the hazard.
        """
        TR = min(max(return_period(life, state), SHORTEST), LONGEST)
        if not self.table[0][0] <= TR * (1 + 1e-9) or not self.table[-1][0] * (1 + 1e-9) >= TR:
            raise InputError(
                Problem(
                    f"has return periods from {self.table[0][0]:g} to {self.table[-1][0]:g} years: that of {state}, "
                    f"{TR:.4g} years, is not between",
                    field="hazard",
                )
            )
        return min(max(TR, self.table[0][0]), self.table[-1][0])
