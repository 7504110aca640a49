"""The time histories on the capacity curve, as a table and sentences."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.codes.italian.results import Dynamic, ItalianVerified, RecordPeak
from rocking_cli.views.sheet.document import Grid, Item, Sentence, SheetPart
from rocking_cli.views.sheet.language import Language


def part(say: Language, each: ItalianVerified, found: Dynamic, key: str) -> SheetPart:
    """Return the part on the dynamic method in a direction."""
    rows = [
        [record.name, *(_peak(say, record, found.d0, confident=confident) for confident in (True, False))]
        for record in found.records
    ]
    heads = [say.say("record"), say.say("with_FC"), say.say("without_FC")]
    items: list[Item] = [
        Sentence(say.say("dynamic_is", d0=found.d0, state=next(iter(found.allowed)))),
        Sentence(say.say(found.motions.kind, floor=found.motions.floor)),
        Grid(say.say("dynamic_table"), heads, rows, (1, 2)),
    ]
    for confident in (True, False) if each.exact.confidence != 1 else (True,):
        items += _said(say, found, confident=confident)
    if not found.checked:
        items.append(Sentence(say.say("not_checked")))
    count = len(found.records)
    if count < found.enough:
        items.append(Sentence(say.say("one" if count == 1 else "few", count=count, enough=found.enough)))
    return SheetPart(f"{key}-dynamic", say.say("dynamic"), items)


def _peak(say: Language, record: RecordPeak, d0: float, *, confident: bool) -> str:
    d, known_to = record.peak(confident=confident), record.known_to(confident=confident)
    if known_to is not None:
        return say.say("unknown_after", time=say.number(known_to, 4))
    if d is None:
        return say.say("overturns")
    return f"{say.number(d)} {say.say('past')}" if d >= d0 else say.number(d)


def _said(say: Language, found: Dynamic, *, confident: bool) -> Iterator[Sentence]:
    which = say.say("with_FC" if confident else "without_FC")
    which = f"{which[0].upper()}{which[1:]}"
    mean, unknown = found.mean(confident=confident), found.unknown(confident=confident)
    if passed := found.passed(confident=confident):
        yield Sentence(say.say("past_d0", which=which, names=", ".join(passed)))
    if mean is None:
        for state in found.allowed if unknown else ():
            yield Sentence(say.say("unknown_fails", which=which, state=state, names=", ".join(unknown)))
        return
    for state, allowed in found.allowed.items():
        key = "holds" if found.holds(state, confident=confident) else "holds_not"
        yield Sentence(say.say(key, which=which, state=state, mean=mean, allowed=allowed))
