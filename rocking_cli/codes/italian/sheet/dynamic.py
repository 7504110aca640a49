"""The time histories on the capacity curve, as a table and sentences, of the sheet and of the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.codes.italian.results import Dynamic, RecordPeak
from rocking_cli.views.sheet.document import Sentence
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.view import Table

SETS = {True: "with FC", False: "without FC"}


def items(say: Language, dynamic: Dynamic, FC: float) -> Iterator[Sentence | Table]:
    """Yield the results of the dynamic method in a direction at a limit state, as sentences and a table."""
    state = dynamic.state
    yield Sentence(say("dynamic_is", d0=dynamic.d0, state=state))
    yield Sentence(say(dynamic.motions.kind, floor=say.items(dynamic.motions.floor or "")))
    yield _table(say, dynamic)
    for confident in SETS if FC != 1 else (True,):
        yield from map(Sentence, _said(say, dynamic, confident=confident))
    if FC != 1 and dynamic.holds(confident=True) != dynamic.holds(confident=False):
        yield Sentence(say("The confidence factor FC changes the verdict at {state}.", state=state))
    if dynamic.refused:
        yield Sentence(say("refused", state=state, names=", ".join(dynamic.refused)))
    if dynamic.unchecked is not None:
        yield Sentence(say("not_checked", why=say(dynamic.unchecked)))
    if dynamic.too_few:
        count = len(dynamic.records)
        yield Sentence(say("one" if count == 1 else "few", count=count, enough=dynamic.enough, state=state))


def _table(say: Language, dynamic: Dynamic) -> Table:
    """Return a table of each record with its scale factor and peaks, of their mean and largest, and the capacity."""
    rows = [
        [
            record.name,
            say.number(record.scale_factor),
            *(_peak(say, record, dynamic.d0, confident=confident) for confident in SETS),
        ]
        for record in dynamic.records
    ]
    numbers: dict[str, list[float | None]] = {
        say("mean"): [dynamic.mean(confident=confident) for confident in SETS],
        say("largest known"): [dynamic.largest(confident=confident) for confident in SETS],
        say("capacity d_[{state}]", state=dynamic.state): [dynamic.allowed] * 2,
    }
    rows += [[name, "", *map(say.number, values)] for name, values in numbers.items()]
    heads = [say("record"), say("scale factor"), *map(say, SETS.values())]
    return Table(say("Peak displacement d [m]"), heads, rows, (1, 2, 3))


def _peak(say: Language, record: RecordPeak, d0: float, *, confident: bool) -> str:
    d, known_to = record.peak(confident=confident), record.known_to(confident=confident)
    if known_to is not None:
        return say("unknown after {time} s", time=say.number(known_to, 4))
    if d is None:
        return say("overturns")
    return f"{say.number(d)} {say('past d_[0]^[*]')}" if d >= d0 else say.number(d)


def _said(say: Language, dynamic: Dynamic, *, confident: bool) -> Iterator[str]:
    mean, unknown = dynamic.mean(confident=confident), dynamic.unknown(confident=confident)
    which = say(SETS[confident])
    values = {
        "which": f"{which[0].upper()}{which[1:]}",
        "state": dynamic.state,
        "mean": mean,
        "allowed": dynamic.allowed,
        "of": len(dynamic.records),
    }
    if passed := dynamic.passed(confident=confident):
        yield say("past_d0", **values, names=", ".join(passed), count=len(passed))
    if mean is not None:
        yield say("holds" if dynamic.holds(confident=confident) else "holds_not", **values)
    elif unknown:
        yield say("unknown_fails", **values, names=", ".join(unknown), count=len(unknown))
