"""The demand of a site by a code of practice: elastic spectra at each limit state, with their parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

from rocking_cli.short_repr import short_repr
from rocking_cli.verification.results import Remark


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
