"""The parts of a calculation sheet that depend on the Italian code."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianVerification
from rocking_cli.codes.italian.rules import RULES
from rocking_cli.codes.italian.sheet import dynamic, site, summary, texts_en, texts_it
from rocking_cli.codes.italian.sheet.steps import of_direction
from rocking_cli.codes.italian.site import ItalianSite, of_structure
from rocking_cli.views.sheet.build import SheetOfCode
from rocking_cli.views.sheet.document import Drawing, SheetPart
from rocking_cli.views.sheet.language import Language


def parts(say: Language, found: ItalianVerification, given: ItalianSite) -> Iterator[SheetPart]:
    """Yield summary, drawing, site, and each direction; one direction if both have the same numbers."""
    shown = {say.say(one.direction.label): one for one in found.distinct}
    if len(found.distinct) < len(found.directions):
        shown = {say.say("both"): found.distinct[0]}
    ground = SiteGround(of_structure(given, found.mechanism))
    yield summary.part(say, found, shown)
    yield SheetPart("drawing", say.say("drawing"), [Drawing(say.say("drawing_label", name=found.mechanism.name))])
    yield site.part(say, ground)
    for where, each in shown.items():
        key = each.direction.label
        below = list(of_direction(say, ground, each))
        if each.dynamic is not None:
            below.append(dynamic.part(say, each, each.dynamic, key))
        yield SheetPart(key, where, [], below)


SPELLED = {
    "alpha0": "α_[0]",
    "lambda": "λ",
    "a0*": "a_[0]^[*]",
    "d0*": "d_[0]^[*]",
    "a*": "a^[*]",
    **{f"d_{rule.state}": f"d_[{rule.state}]" for rule in RULES},
    "xi1^-1/2 eta(xi)": "ξ_[1]^[−1/2] η(ξ)",
    "xi1": "ξ_[1]",
    "S_Z": "S_[Z]",
    "a_g": "a_[g]",
    "T0": "T_[0]",
    "m/s2": "m/s²",
}
"""The symbols of plain sentences, as they are printed."""
SHEET = SheetOfCode({"en": texts_en.TEXTS, "it": texts_it.TEXTS}, SPELLED, parts)
