"""The time histories on the capacity curve, as a table and sentences."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.studies.verification.results import Dynamic, Verified
from rocking_cli.views.sheet.document import Grid, Item, Part, Sentence
from rocking_cli.views.sheet.language import Language


def part(say: Language, each: Verified, found: Dynamic, key: str) -> Part:
    """The dynamic method in a direction."""
    rows = [
        [record.name, *(_peak(say, d, found.d0) for d in (record.with_confidence, record.without))]
        for record in found.records
    ]
    heads = [say.say("record"), say.say("with_FC"), say.say("without_FC")]
    items: list[Item] = [
        Sentence(say.say("dynamic_is", d0=found.d0)),
        Grid(say.say("dynamic_table"), heads, rows, (1, 2)),
    ]
    for confident in (True, False) if each.exact.confidence != 1 else (True,):
        items += _said(say, found, confident=confident)
    count = len(found.records)
    if count < found.enough:
        items.append(Sentence(say.say("one" if count == 1 else "few", count=count, enough=found.enough)))
    return Part(f"{key}-dynamic", say.say("dynamic"), items)


def _peak(say: Language, d: float | None, d0: float) -> str:
    if d is None:
        return say.say("overturns")
    return f"{say.number(d)} {say.say('past')}" if d >= d0 else say.number(d)


def _said(say: Language, found: Dynamic, *, confident: bool) -> Iterator[Sentence]:
    which = say.say("with_FC" if confident else "without_FC")
    which = f"{which[0].upper()}{which[1:]}"
    mean = found.mean(confident=confident)
    if mean is None:
        yield Sentence(say.say("past_d0", which=which, names=", ".join(found.passed(confident=confident))))
        return
    for state, allowed in found.allowed.items():
        key = "holds" if found.holds(state, confident=confident) else "holds_not"
        yield Sentence(say.say(key, which=which, state=state, mean=mean, allowed=allowed))
