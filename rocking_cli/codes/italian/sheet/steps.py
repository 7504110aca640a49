"""The steps of a verification: in a language for the sheet, and in plain characters for `workings`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianVerified
from rocking_cli.codes.italian.sheet import site
from rocking_cli.codes.italian.sheet.methods import Methods
from rocking_cli.codes.italian.sheet.states import Writer
from rocking_cli.studies.verification.working import Working
from rocking_cli.views.sheet.document import SheetPart, workings
from rocking_cli.views.sheet.language import Language, texts_of

ENGLISH = Language("en", texts_of("rocking_cli.codes.italian", "en"))
TERMINAL = replace(ENGLISH, is_plain=True)


def of_direction(say: Language, ground: SiteGround, found: ItalianVerified) -> Iterator[SheetPart]:
    """Yield the parts of a direction: chain, curve, limit states, methods."""
    key = found.direction.label
    yield from Writer(say, ground, found).parts(key)
    yield from Methods(say, ground, found).parts(key)


def workings_of_direction(ground: SiteGround, found: ItalianVerified) -> list[Working]:
    """Return the calculation steps of the verification in one direction, as text in plain characters."""
    return list(workings(of_direction(ENGLISH, ground, found)))


def workings_of_site(ground: SiteGround) -> list[Working]:
    """Return the values of the site file and the steps to the ground at each limit state, in plain characters."""
    whole = site.part(ENGLISH, ground)
    found = [each.in_plain(whole.heading) for each in site.given(ENGLISH, ground)]
    for part in whole.parts:
        state = part.key.removeprefix("site-")
        found += [replace(each, state=state) for each in workings([part])]
    return found + [each.in_plain(whole.heading) for each in site.amplifications(ENGLISH, ground)]
