"""Elastic spectra of a site by its code, at periods from 0 to where they end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.verification.check import code_of
from rocking_cli.verification.check import demand as demand_of
from rocking_cli.verification.code import SiteFile
from rocking_cli.verification.demand import DemandParameter, DemandTable, StateDemand, SupportSpectrum
from rocking_cli.verification.results import Remark

FINE_STEP, COARSE_STEP = 0.01, 0.05  # s, below and above the longest period for which codes give accelerations
LONGEST_FINE_PERIOD = 4.0  # s


@dataclass(frozen=True, eq=False)
class StateSpectra:
    """Spectra at a limit state, over the periods of `SpectraOfSite`; NaN beyond their end.

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


@dataclass(frozen=True, eq=False)
class SpectraOfSite:
    """Elastic spectra of a site at the limit states that it gives.

    Parameters
    ----------
    code, name, edition : str
        Key, name and edition of the code.
    site : str or None
        Name of the site.
    damping : float
        Damping ratio of the spectra.
    periods : ndarray, shape (n,)
        Periods from 0, with those at which a spectrum changes its form [s].
    states : mapping of str to StateSpectra
        The limit states, from the most frequent to the rarest.
    first : str
        Name of the limit state that decides.
    headline : str or Remark
        What decides, in one sentence.
    parameters : sequence of DemandParameter
        The parameters of the spectra.
    origins : sequence of DemandTable
        Tables from which the parameters follow.
    remarks : sequence of (str or Remark)
        Further sentences.
    """

    code: str
    name: str
    edition: str
    site: str | None
    damping: float
    periods: Reals
    states: Mapping[str, StateSpectra]
    first: str
    headline: str | Remark
    parameters: Sequence[DemandParameter]
    origins: Sequence[DemandTable]
    remarks: Sequence[str | Remark]


def spectra_of(site: SiteFile, damping: float) -> SpectraOfSite:
    """Return the spectra of a site by its code.

    Parameters
    ----------
    site : SiteFile
        The site.
    damping : float
        Damping ratio, from 0 to below 1.

    Raises
    ------
    InputError
        If the damping ratio is out of range, the code has no spectra, or the site lacks values for them.
    """
    if not 0 <= damping < 1:
        message = f"a damping ratio is from 0 to below 1, got {damping:g}"
        raise InputError(Problem(message, field="`damping`", hint="5 % is 0.05"))
    code, site_demand = code_of(site), demand_of(site)
    last = max(each.last for each in site_demand.states.values())
    steps = [np.arange(0, min(LONGEST_FINE_PERIOD, last), FINE_STEP), np.arange(LONGEST_FINE_PERIOD, last, COARSE_STEP)]
    corners = [T for each in site_demand.states.values() for T in (*each.corners, each.last)]
    periods = np.unique(np.concatenate([*steps, corners]).round(9))
    states = {state: _at(each, periods, damping) for state, each in site_demand.states.items()}
    return SpectraOfSite(
        code.key, code.name, code.edition, site.site.name, damping, periods, states, site_demand.first,
        site_demand.headline, site_demand.parameters, site_demand.tables, site_demand.remarks,
    )  # fmt: skip


def _at(state: StateDemand, periods: Reals, damping: float) -> StateSpectra:
    def ordinates(spectrum: SupportSpectrum) -> tuple[Reals, Reals]:
        known = [min(T, state.last) for T in periods.tolist()]
        acceleration = np.array([spectrum.acceleration(T, damping) for T in known]) / STANDARD_GRAVITY
        displacement = np.array([spectrum.displacement(T, damping) for T in known])
        beyond = periods > state.last + 1e-9
        return np.where(beyond, np.nan, acceleration), np.where(beyond, np.nan, displacement)

    floor = (None, None) if state.floor is None else ordinates(state.floor)
    return StateSpectra(state.values, *ordinates(state.ground), *floor)
