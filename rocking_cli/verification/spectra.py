"""Elastic spectra of the demand of a site, at periods from 0 to where they end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.short_repr import short_repr
from rocking_cli.verification.demand import SiteDemand, StateDemand, SupportSpectrum

FINE_STEP, COARSE_STEP = 0.01, 0.05  # s, below and above the longest period for which codes give accelerations
LONGEST_FINE_PERIOD = 4.0  # s


@short_repr
@dataclass(frozen=True, eq=False)
class StateSpectra:
    """Spectra at a limit state, over the periods of `spectra_at_states`; NaN beyond their end.

    Parameters
    ----------
    values : mapping of str to (float or None)
        Values of the parameters, by their keys; None for what the site does not give.
    acceleration, displacement : ndarray, shape (n,)
        Spectra of the ground [standard gravity, m].
    floor_acceleration, floor_displacement : ndarray, shape (n,), or None
        Spectra of the floor; None on the ground.
    """

    values: Mapping[str, float | None]
    acceleration: Reals
    displacement: Reals
    floor_acceleration: Reals | None = None
    floor_displacement: Reals | None = None


def spectra_at_states(demand: SiteDemand, damping: float) -> tuple[Reals, Mapping[str, StateSpectra]]:
    """Return periods from 0 [s], with those at which a spectrum changes its form, and the spectra there by state.

    Parameters
    ----------
    demand : SiteDemand
        The demand of the site by its code.
    damping : float
        Damping ratio.
    """
    last = max(each.last for each in demand.states.values())
    steps = [np.arange(0, min(LONGEST_FINE_PERIOD, last), FINE_STEP), np.arange(LONGEST_FINE_PERIOD, last, COARSE_STEP)]
    corners = [T for each in demand.states.values() for T in (*each.corners, each.last)]
    periods = np.unique(np.concatenate([*steps, corners]).round(9))
    return periods, {state: _at(each, periods, damping) for state, each in demand.states.items()}


def _at(state: StateDemand, periods: Reals, damping: float) -> StateSpectra:
    def ordinates(spectrum: SupportSpectrum) -> tuple[Reals, Reals]:
        known = [min(T, state.last) for T in periods.tolist()]
        acceleration = np.array([spectrum.acceleration(T, damping) for T in known]) / STANDARD_GRAVITY
        displacement = np.array([spectrum.displacement(T, damping) for T in known])
        beyond = periods > state.last + 1e-9
        return np.where(beyond, np.nan, acceleration), np.where(beyond, np.nan, displacement)

    floor = (None, None) if state.floor is None else ordinates(state.floor)
    return StateSpectra(state.values, *ordinates(state.ground), *floor)
