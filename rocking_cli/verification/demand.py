"""The demand of a site by a code of practice: elastic spectra at each limit state, with their parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.remark import Remark


class SupportSpectrum(Protocol):
    """Elastic spectrum at the support of an oscillator, the ground or a floor."""

    def acceleration(self, period: float, damping: float) -> float:
        """Return the spectral acceleration [m/s2] at a period [s] and a damping ratio."""
        ...

    def displacement(self, period: float, damping: float) -> float:
        """Return the spectral displacement [m] at a period [s] and a damping ratio."""
        ...


class DemandParameter(NamedTuple):
    """A parameter of the spectra of a site.

    Parameters
    ----------
    key : str
        Key in JSON and of `StateDemand.values`.
    symbol : str
        Symbol in plain characters.
    unit : str
        Unit; empty if it is dimensionless.
    meaning : str
        Meaning in a few words.
    """

    key: str
    symbol: str
    unit: str
    meaning: str


@short_repr
@dataclass(frozen=True)
class StateDemand:
    """Demand of a site at a limit state.

    Parameters
    ----------
    values : mapping of str to (float or None)
        Values of the parameters, by their keys; None for what the site does not give.
    ground : SupportSpectrum
        Spectrum of the ground.
    floor : SupportSpectrum or None
        Spectrum of the floor on which the structure stands; None on the ground.
    corners : sequence of float
        Periods at which a spectrum changes its form [s].
    last : float
        Longest period at which the spectra are known [s].
    """

    values: Mapping[str, float | None]
    ground: SupportSpectrum
    floor: SupportSpectrum | None
    corners: Sequence[float]
    last: float


class DemandTable(NamedTuple):
    """A table of numbers from which the demand follows.

    Parameters
    ----------
    key : str
        Key in JSON.
    title : str
        Title for readers.
    columns : mapping of str to str
        Unit of each column, by its key in JSON.
    rows : sequence of sequence of float
        Rows of the table.
    """

    key: str
    title: str
    columns: Mapping[str, str]
    rows: Sequence[Sequence[float]]


@short_repr
@dataclass(frozen=True)
class SiteDemand:
    """Demand of a site at the limit states that it gives.

    Parameters
    ----------
    parameters : sequence of DemandParameter
        The parameters of the spectra.
    states : mapping of str to StateDemand
        The limit states, from the most frequent to the rarest.
    first : str
        Name of the limit state that decides.
    headline : str or Remark
        What decides, in one sentence.
    remarks : sequence of (str or Remark)
        Further sentences.
    tables : sequence of DemandTable
        Tables from which the parameters follow.
    """

    parameters: Sequence[DemandParameter]
    states: Mapping[str, StateDemand]
    first: str
    headline: str | Remark
    remarks: Sequence[str | Remark] = ()
    tables: Sequence[DemandTable] = field(default=())


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
