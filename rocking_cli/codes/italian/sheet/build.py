"""The parts of a calculation sheet that depend on the Italian code."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianVerification, ItalianVerified
from rocking_cli.codes.italian.sheet import basis, dynamic, site, summary
from rocking_cli.codes.italian.sheet.steps import DirectionSteps
from rocking_cli.codes.italian.site import ItalianSite, of_structure
from rocking_cli.codes.italian.site_demand import site_demand
from rocking_cli.core import Direction
from rocking_cli.names import LANGUAGES
from rocking_cli.verification.demand import SiteDemand
from rocking_cli.views.sheet.build import SheetOfCode
from rocking_cli.views.sheet.document import Drawing, Item, SheetPart
from rocking_cli.views.sheet.language import Language, texts_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DIRECTION_TITLES = {
    Direction.POSITIVE: "Positive direction (clockwise)",
    Direction.NEGATIVE: "Negative direction (anticlockwise)",
}


def parts(say: Language, verification: ItalianVerification, site_values: ItalianSite) -> Iterator[SheetPart]:
    """Yield the summary, what the code says of programs, input, figures, and the workings of site and directions.

    Both directions are one if they have the same numbers.
    """
    directions = {say(DIRECTION_TITLES[one.direction]): one for one in verification.distinct}
    if len(verification.distinct) < len(verification.directions):
        directions = {say("Both directions"): verification.distinct[0]}
    ground = SiteGround(of_structure(site_values, verification.mechanism))
    yield from summary.parts(say, verification, directions)
    yield basis.part(say, verification)
    yield _input(say, verification, directions, ground)
    yield _figures(say, verification, directions, site_demand(ground.site))
    yield site.part(say, ground)
    for where, each in directions.items():
        key = each.direction.label
        subparts = list(DirectionSteps(say, ground, each).parts())
        if each.dynamic is not None:
            items = list(dynamic.items(say, each.dynamic, each.exact.confidence))
            subparts.append(SheetPart(f"{key}-dynamic", say("Dynamic method"), items))
        yield SheetPart(key, where, [], subparts, appended=True)


def _input(
    say: Language, found: ItalianVerification, directions: Mapping[str, ItalianVerified], ground: SiteGround
) -> SheetPart:
    """Return the part on the structure, its weights and ties, and the site."""
    name = found.mechanism.name
    at_rest = say("{name} at rest with its dimensions, and displaced to its critical rotation", name=name)
    items: list[Item] = [Drawing(at_rest)]
    for where, each in directions.items():
        label = say("forces_of", where=where)
        items.append(Drawing(label, partial(_drawn, "draw_chain", say, found, each)))
    return SheetPart("input", say("Input"), [*items, site.given_table(say, ground)])


def _figures(
    say: Language, found: ItalianVerification, directions: Mapping[str, ItalianVerified], demand: SiteDemand
) -> SheetPart:
    """Return the part with the capacity curves and the spectra."""
    heading = say("{name}: capacity and demand", name=found.mechanism.name)
    of_site = say("Elastic spectra of the site, 5 % damping")
    items = [
        Drawing(
            say("capacity_and_demand", where=where),
            partial(_drawn, "draw_capacity", say, {where: each}, heading, demand=demand),
        )
        for where, each in directions.items()
    ]
    spectra = Drawing(of_site, partial(_drawn, "draw_site", say, demand, of_site))
    return SheetPart("figures", say("Capacity and demand"), [*items, spectra])


def _drawn(function: str, *args: Any, **named: Any) -> Figure:
    """Return a figure; what draws it is imported only for a sheet that is written."""
    from rocking_cli.codes.italian.sheet import figures

    figure: Figure = getattr(figures, function)(*args, **named)
    return figure


SHEET = SheetOfCode({key: texts_of("rocking_cli.codes.italian", key) for key in LANGUAGES}, parts)
