"""`rk.demand`: the response spectra of a site by a code."""

from __future__ import annotations

from functools import partial

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.inputs import site_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.questions.demand.asked import DemandAsked
from rocking_cli.questions.demand.view import SpectraOfSite, spectra_of, table, title, view


@verb(DemandAsked)
def demand(asked: DemandAsked, watch: Watcher) -> Answer[SpectraOfSite]:
    """Compute the elastic response spectra of a site by its code, at each limit state that the site gives.

    Returns
    -------
    Answer of SpectraOfSite
        `states` holds, by limit state, `values` of the parameters and the arrays `acceleration` [standard gravity] and
        `displacement` [m] of the ground, and of the floor if there is one, over `periods` [s].

    Raises
    ------
    InputError
        If the site cannot be used, or its code has no spectra.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> site = {"FC": "LC1", "ag": 0.2, "F0": 2.5, "TC_star": 0.32, "soil": "C"}
    >>> slv = rk.demand(site).states["SLV"]
    >>> round(slv.values["S"], 3), round(slv.values["pga"], 4), slv.acceleration.round(3).max().item()
    (1.4, 0.28, 0.7)
    """
    spectra = spectra_of(site_of(asked.site), asked.damping)
    shown = (spectra.periods, spectra.states, spectra.demand.first, title(spectra))
    figure = drawn("plotting.spectra.draw_spectra_of_site", *shown)
    return Answer(
        "demand", spectra, view(spectra), partial(table, spectra), figure, dims=[Dimensions(("state", "period"))]
    )
