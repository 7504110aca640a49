"""The parts of a calculation sheet that depend on the Italian code."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianVerification
from rocking_cli.codes.italian.sheet import dynamic, site, summary
from rocking_cli.codes.italian.sheet.steps import DirectionSteps
from rocking_cli.codes.italian.site import ItalianSite, of_structure
from rocking_cli.core import Direction
from rocking_cli.names import LANGUAGES
from rocking_cli.views.sheet.build import SheetOfCode
from rocking_cli.views.sheet.document import Drawing, SheetPart
from rocking_cli.views.sheet.language import Language, texts_of

DIRECTION_TITLES = {
    Direction.POSITIVE: "Positive direction (clockwise)",
    Direction.NEGATIVE: "Negative direction (anticlockwise)",
}


def parts(say: Language, verification: ItalianVerification, site_values: ItalianSite) -> Iterator[SheetPart]:
    """Yield summary, drawing, site, and each direction; one direction if both have the same numbers."""
    directions = {say(DIRECTION_TITLES[one.direction]): one for one in verification.distinct}
    if len(verification.distinct) < len(verification.directions):
        directions = {say("Both directions"): verification.distinct[0]}
    ground = SiteGround(of_structure(site_values, verification.mechanism))
    yield summary.part(say, verification, directions)
    name = verification.mechanism.name
    label = say("{name} at rest with its dimensions, and displaced to its critical rotation", name=name)
    yield SheetPart("drawing", say("Drawing"), [Drawing(label)])
    yield site.part(say, ground)
    for where, each in directions.items():
        key = each.direction.label
        subparts = list(DirectionSteps(say, ground, each).parts())
        if each.dynamic is not None:
            items = list(dynamic.items(say, each.dynamic, each.exact.confidence))
            subparts.append(SheetPart(f"{key}-dynamic", say("Dynamic method"), items))
        yield SheetPart(key, where, [], subparts)


SHEET = SheetOfCode({key: texts_of("rocking_cli.codes.italian", key) for key in LANGUAGES}, parts)
