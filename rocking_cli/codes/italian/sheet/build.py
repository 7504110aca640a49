"""Values of a calculation sheet by the Italian code, for its templates."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib import import_module
from importlib.metadata import metadata
from math import isclose
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking_cli.codes.italian.ground import SiteGround, site_demand
from rocking_cli.codes.italian.results import Dynamic, ItalianVerification, ItalianVerified
from rocking_cli.codes.italian.rules import STATES
from rocking_cli.codes.italian.sheet import site, summary
from rocking_cli.codes.italian.sheet.chain import named
from rocking_cli.codes.italian.sheet.geometry import Composition
from rocking_cli.codes.italian.sheet.steps import PACKAGE, DirectionSteps, title
from rocking_cli.codes.italian.site import ItalianSite, of_structure
from rocking_cli.core import Direction, Mechanism
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


def context(
    say: Language, verification: ItalianVerification, site_values: ItalianSite, *, in_full: bool = False
) -> dict[str, Any]:
    """Return the values for the templates; the lines are those of the limit state that decides, or of all `in_full`."""
    ground = SiteGround(of_structure(site_values, verification.mechanism))
    strengthened = verification.strengthened
    if strengthened is None:
        subjects = [_subject(say, verification, site_values, in_full)]
    else:
        assert isinstance(strengthened, ItalianVerification)  # both are verified by the same code
        subjects = [
            _subject(say, verification, site_values, in_full, "existing"),
            _subject(say, strengthened, site_values, in_full, "strengthened"),
        ]
    return {
        "language": say, "verification": verification, "ground": ground, "site": site, "subjects": subjects,
        "both": None if strengthened is None else summary.both(verification, strengthened),
        "structures": {each["state"]: each["verification"] for each in subjects},
        "title": partial(title, say), "named": partial(named, say), "figures": SheetFigures(say, ground),
        "is_same": partial(isclose, rel_tol=SAME_MULTIPLIER),
        "histories": partial(summary.histories, say), "outcome": partial(summary.outcome, say),
        "given_FC": site_values.FC,
        "counts": [state for state in STATES if any(state in each["counts"] for each in subjects)], "in_full": in_full,
        "licence": metadata("rocking-cli")["License-Expression"],
    }  # fmt: skip


def _subject(
    say: Language, found: ItalianVerification, site_values: ItalianSite, in_full: bool, state: str = ""
) -> dict[str, Any]:
    """Return the values of a structure, which is in the existing state or strengthened if two are compared.

    Both directions are one if they have the same numbers.
    """
    ground = SiteGround(of_structure(site_values, found.mechanism))
    both = say("Both directions") if len(found.distinct) < len(found.directions) else ""
    of, counts = say(OF_STRUCTURE[state]), "" if in_full else found.conclusion.limit_state
    sides = [
        DirectionSteps(ground, each, f"{both or say(DIRECTION_TITLES[each.direction])}{of}", state, counts)
        for each in found.distinct
    ]
    variants = {"as_calculated": found.deciding, **found.variants()}
    return {
        "state": state, "ending": of, "of": f"{state}-" if state else "", "verification": found, "sides": sides,
        "counts": [counts] if counts else STATES, "variants": variants,
        "failing_without_ties": _failing(variants.get("without_ties")),
        "has_seats": any(load.seat for load in found.mechanism.loads or []),
        "structure": Composition(found.mechanism), "body": partial(say.body, found.mechanism.mechanism),
        **summary.context(say, found, sides),
    }  # fmt: skip


def _failing(side: ItalianVerified | None) -> dict[str, float]:
    """Return the zeta_E of each required limit state that a direction does not pass."""
    if side is None:
        return {}
    return {
        state: zeta for state in side.required if (zeta := side.zeta_at(state)) is not None and not side.passes(state)
    }


class SheetFigures(NamedTuple):
    """What draws the figures of a sheet, in a language, for a site."""

    say: Language
    ground: SiteGround

    def chain(self, side: DirectionSteps) -> Callable[[], Figure]:
        """Return what draws the weights, forces and arms of a direction."""
        return _drawn("figures", "draw_chain", self.say, side.found)

    def capacity(self, side: DirectionSteps) -> Callable[[], Figure]:
        """Return what draws the capacity curve of a direction with the demand."""
        heading = self.say("{name}: capacity and demand", name=side.found.chain.mechanism.name)
        sides, demand = {side.where: side.found}, site_demand(self.ground.site)
        return _drawn("figures", "draw_capacity", self.say, sides, heading, demand=demand)

    def front(self, mechanism: Mechanism) -> Callable[[], Figure]:
        """Return what draws the parts of a structure from the front."""
        return _drawn("figures", "draw_front", self.say, mechanism.name, Composition(mechanism).strips)

    def hazard(self) -> Callable[[], Figure]:
        """Return what draws the hazard of the site."""
        heading = self.say("Seismic hazard of the site, on rock")
        return _drawn("figures", "draw_hazard", self.say, self.ground, self.ground.hazard, heading)

    def site(self) -> Callable[[], Figure]:
        """Return what draws the spectra of the site."""
        heading = self.say("Elastic spectra of the site, 5 % damping")
        return _drawn("figures", "draw_site", self.say, site_demand(self.ground.site), heading)

    def history(self, side: DirectionSteps, at: Dynamic) -> Callable[[], Figure]:
        """Return what draws one history of a direction at a limit state."""
        return _drawn("figures", "draw_history", self.say, side.found, at, at.drawn)

    def records(self, at: Dynamic) -> Callable[[], Figure]:
        """Return what draws the spectra of the records of a limit state."""
        heading = self.say("Spectra of the records at {state}, 5 % damping", state=at.state)
        return _drawn("figures", "draw_spectra", self.say, at, self.ground, heading)


def _drawn(module: str, function: str, *args: Any, **named: Any) -> Callable[[], Figure]:
    """Return what draws a figure; its module is imported only for a sheet that is written."""

    def draw() -> Figure:
        figure: Figure = getattr(import_module(f"{__package__}.{module}"), function)(*args, **named)
        return figure

    return draw


SHEET = SheetOfCode(PACKAGE, context)
