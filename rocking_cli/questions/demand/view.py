"""Elastic spectra of a site by its code, at periods from 0 to where they end, and their view."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.short_repr import short_repr
from rocking_cli.verification.check import code_of
from rocking_cli.verification.check import demand as demand_of
from rocking_cli.verification.code import SiteFile
from rocking_cli.verification.demand import SiteDemand, StateSpectra, spectra_at_states
from rocking_cli.views.column import Column, only_shown, rounded, table_across, table_of
from rocking_cli.views.verification import showing_by
from rocking_cli.views.view import Table, View

SHOWN_PERIODS = (0.0, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0)  # s, in the table
CURVES = (
    ("acceleration", "Sa", "g"),
    ("displacement", "Sd", "m"),
    ("floor_acceleration", "floor Sa", "g"),
    ("floor_displacement", "floor Sd", "m"),
)
"""Curves of each limit state: key, name in tables, and unit."""


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


def view(found: SpectraOfSite) -> View:
    """Show what decides, the parameters of the spectra, ordinates, and what the parameters follow from."""
    say = showing_by(found.code).say
    states = list(found.states)
    values = [each.values for each in found.states.values()]
    columns = [
        Column(each.key, itemgetter(each.key), each.unit, each.symbol, rounded(4), words=each.meaning)
        for each in found.demand.parameters
    ]
    after = {"unit": lambda column: column.unit, "": lambda column: column.words}
    parts: list[Table | str] = [say(found.demand.headline), table_across(title(found), columns, states, values, after)]
    for each in found.demand.tables:
        heads = [f"{key}\n[{unit}]" if unit else key for key, unit in each.columns.items()]
        shown = [only_shown(head, itemgetter(k), rounded(6)) for k, head in enumerate(heads)]
        parts.append(table_of(each.title, shown, each.rows))
    parts += [*_ordinates(found), *map(say, found.demand.remarks)]
    return View(lambda: data(found), parts)


def title(found: SpectraOfSite) -> str:
    """Return the site, the code and the damping, as a heading."""
    where = f"{found.site}: e" if found.site else "E"
    return f"{where}lastic spectra at {100 * found.damping:g} % damping, {found.name} ({found.edition})"


def data(found: SpectraOfSite) -> dict[str, Any]:
    """Return the spectra as plain data, in s, standard gravity and m."""
    say = showing_by(found.code).say
    return {
        "site": found.site,
        "code": found.code,
        "edition": found.edition,
        "damping": found.damping,
        "first": found.demand.first,
        "periods": found.periods.tolist(),
        "states": {
            state: {each.key: spectra.values[each.key] for each in found.demand.parameters}
            | {key: _known(getattr(spectra, key)) for key, *_ in CURVES}
            for state, spectra in found.states.items()
        },
        **{each.key: [dict(zip(each.columns, row, strict=True)) for row in each.rows] for each in found.demand.tables},
        "verdict": say(found.demand.headline),
        "remarks": list(map(say, found.demand.remarks)),
    }


def table(found: SpectraOfSite) -> Columns:
    """Return the columns of the spectra, with a row for each limit state and period."""
    return stacked(
        {"state": state, "period [s]": found.periods}
        | {f"{name} [{unit}]": curve for key, name, unit in CURVES if (curve := getattr(each, key)) is not None}
        for state, each in found.states.items()
    )


def _known(curve: Reals | None) -> list[float | None] | None:
    """Return the ordinates of a curve, None beyond its end; None without the curve."""
    return None if curve is None else [None if value != value else value for value in curve.tolist()]


def _ordinates(found: SpectraOfSite) -> Iterator[Table]:
    """Yield a table of ordinates for each quantity, with a column for each limit state."""
    shown = [int(np.abs(found.periods - T).argmin()) for T in SHOWN_PERIODS if found.periods[-1] >= T]
    for key, name, unit in CURVES:
        curves = {state: getattr(spectra, key) for state, spectra in found.states.items()}
        if any(each is None for each in curves.values()):
            continue
        columns = [only_shown("T\n[s]", found.periods.item, rounded(3))]
        columns += [only_shown(state, curve.item, rounded(4)) for state, curve in curves.items()]
        yield table_of(f"{name} [{unit}]", columns, shown)
