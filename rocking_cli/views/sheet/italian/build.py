"""All parts of the sheet that the Italian code decides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rocking_cli.studies.verification.codes.italian.ground import Ground
from rocking_cli.studies.verification.codes.italian.site import ItalianSite
from rocking_cli.studies.verification.results import Verification, Verified
from rocking_cli.views.sheet.document import Drawing, Part
from rocking_cli.views.sheet.italian import dynamic, site, summary
from rocking_cli.views.sheet.italian.methods import Methods
from rocking_cli.views.sheet.italian.states import Writer
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.verification import alike


def parts(say: Language, found: Verification, given: ItalianSite) -> Iterator[Part]:
    """Summary, drawing, site, and each direction that has numbers of its own."""
    shown, ground = _shown(say, found), Ground(given)
    yield summary.part(say, found, shown)
    yield Part("drawing", say.say("drawing"), [Drawing(say.say("drawing_label", name=found.mechanism.name))])
    yield site.part(say, ground)
    for where, each in shown.items():
        key = each.direction.label
        below = [*Writer(say, ground, each).parts(key), *Methods(say, ground, each).parts(key)]
        if each.dynamic is not None:
            below.append(dynamic.part(say, each, each.dynamic, key))
        yield Part(key, where, [], below)


def _shown(say: Language, found: Verification) -> Mapping[str, Verified]:
    """The directions that differ, by what they are called."""
    each = list(found.directions.values())
    if len(each) == 2 and alike(*each):
        return {say.say("both"): each[0]}
    return {say.say(one.direction.label): one for one in each}
