"""Values of a calculation sheet by the Italian code, for its templates."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib.metadata import metadata
from math import isclose
from typing import TYPE_CHECKING, Any

from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import Dynamic, ItalianVerification
from rocking_cli.codes.italian.sheet import dynamic, site, summary
from rocking_cli.codes.italian.sheet.chain import named
from rocking_cli.codes.italian.sheet.geometry import Composition
from rocking_cli.codes.italian.sheet.steps import PACKAGE, DirectionSteps, title
from rocking_cli.codes.italian.site import ItalianSite, of_structure
from rocking_cli.codes.italian.site_demand import site_demand
from rocking_cli.core import Direction
from rocking_cli.views.sheet.build import SheetOfCode
from rocking_cli.views.sheet.language import Language

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DIRECTION_TITLES = {
    Direction.POSITIVE: "Positive direction (clockwise)",
    Direction.NEGATIVE: "Negative direction (anticlockwise)",
}
OF_STRUCTURE = {"": "", "existing": ", existing", "strengthened": ", strengthened"}
"""Endings of the names of directions if two structures are compared."""
SAME_MULTIPLIER = 1e-6  # relative difference up to which two multipliers agree


def context(say: Language, verification: ItalianVerification, site_values: ItalianSite) -> dict[str, Any]:
    """Return the values for the templates."""
    ground = SiteGround(of_structure(site_values, verification.mechanism))
    strengthened = verification.strengthened
    if strengthened is None:
        subjects = [_subject(say, verification, site_values)]
    else:
        assert isinstance(strengthened, ItalianVerification)  # both are verified by the same code
        subjects = [
            _subject(say, verification, site_values, "existing"),
            _subject(say, strengthened, site_values, "strengthened"),
        ]
    return {
        "language": say, "verification": verification, "ground": ground, "site": site, "subjects": subjects,
        "both": None if strengthened is None else summary.both(verification, strengthened),
        "title": partial(title, say), "named": partial(named, say), "figure": partial(_figure, say, ground),
        "is_same": partial(isclose, rel_tol=SAME_MULTIPLIER),
        "dynamic": dynamic,
        "licence": metadata("rocking-cli")["License-Expression"],
    }  # fmt: skip


def _subject(say: Language, found: ItalianVerification, site_values: ItalianSite, state: str = "") -> dict[str, Any]:
    """Return the values of a structure, which is in the existing state or strengthened if two are compared.

    Both directions are one if they have the same numbers.
    """
    ground = SiteGround(of_structure(site_values, found.mechanism))
    both = say("Both directions") if len(found.distinct) < len(found.directions) else ""
    of = say(OF_STRUCTURE[state])
    sides = [
        DirectionSteps(ground, each, f"{both or say(DIRECTION_TITLES[each.direction])}{of}", state)
        for each in found.distinct
    ]
    return {
        "state": state, "ending": of, "of": f"{state}-" if state else "", "verification": found, "sides": sides,
        "variants": {"as_calculated": found.deciding, **found.variants()},
        "has_seats": any(load.seat for load in found.mechanism.loads or []),
        "structure": Composition(found.mechanism), "body": partial(say.body, found.mechanism.mechanism),
        **summary.context(say, found, sides),
    }  # fmt: skip


def _figure(
    say: Language, ground: SiteGround, kind: str, side: DirectionSteps | None = None, at: Dynamic | None = None
) -> Callable[[], Figure]:
    """Return what draws a figure of a kind; it is imported only for a sheet that is written."""

    def drawn() -> Figure:
        from rocking_cli.codes.italian.sheet import dynamic_figures, figures

        if at is not None:
            if side is None:
                label = say("Spectra of the records at {state}, 5 % damping", state=at.state)
                return dynamic_figures.draw_spectra(say, at, ground, label)
            return dynamic_figures.draw_history(say, side.found, at, at.drawn)
        if kind == "draw_hazard":
            assert ground.hazard is not None  # as the template draws it
            return figures.draw_hazard(say, ground, ground.hazard, say("Seismic hazard of the site, on rock"))
        demand = site_demand(ground.site)
        if side is None:
            return figures.draw_site(say, demand, say("Elastic spectra of the site, 5 % damping"))
        if kind == "draw_chain":
            return figures.draw_chain(say, side.found)
        heading = say("{name}: capacity and demand", name=side.found.chain.mechanism.name)
        return figures.draw_capacity(say, {side.where: side.found}, heading, demand=demand)

    return drawn


SHEET = SheetOfCode(PACKAGE, context)
