"""Elastic spectra of a site by its code, at periods from 0 to where they end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.short_repr import short_repr
from rocking_cli.verification.check import code_of
from rocking_cli.verification.check import demand as demand_of
from rocking_cli.verification.code import SiteFile
from rocking_cli.verification.demand import SiteDemand, StateSpectra, spectra_at_states


@short_repr
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
    demand : SiteDemand
        Demand of the site by the code: parameters, the limit state that decides, tables and sentences.
    """

    code: str
    name: str
    edition: str
    site: str | None
    damping: float
    periods: Reals
    states: Mapping[str, StateSpectra]
    demand: SiteDemand


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
        raise InputError(Problem(message, field=named("damping"), hint="5 % is 0.05"))
    code, site_demand = code_of(site), demand_of(site)
    periods, states = spectra_at_states(site_demand, damping)
    return SpectraOfSite(code.key, code.name, code.edition, site.site.name, damping, periods, states, site_demand)
