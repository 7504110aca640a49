"""Summary of the sheet: whether each direction passes at each limit state, by which margin, and what governs.

The terminal shows the verdicts, the table of methods and the time histories of this summary, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from markupsafe import Markup

from rocking_cli.codes.italian.remarks import differences
from rocking_cli.codes.italian.results import HISTORIES, Dynamic, ItalianVerification, ItalianVerified, RecordPeak
from rocking_cli.codes.italian.rules import DAMAGE, LINEAR, NONLINEAR, OF_STATE
from rocking_cli.codes.italian.sheet.steps import PACKAGE, DirectionSteps, title
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.studies.remark import Remark
from rocking_cli.views.conclusion import of_verification
from rocking_cli.views.sheet.document import Sentence, tables
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.view import Table

METHOD_NAMES = {
    "SLD": "onset of rocking", DAMAGE: "onset of rocking", LINEAR: "linear method", NONLINEAR: "nonlinear method",
    HISTORIES: "time histories",
}  # fmt: skip
"""Names of the methods within a sentence, by their kind."""
CAUTIONS = ("wide", "same_mode", "letter", "onset_alone", "unsupported", "long")
"""Keys of the remarks that stand on the first page."""


def context(say: Language, verification: ItalianVerification, sides: Sequence[DirectionSteps]) -> dict[str, Any]:
    """Return the values of the summary: the answer, cautions, verdicts and remarks."""
    end, mechanism = verification.conclusion, verification.mechanism
    notes = [
        f"{side.where}: {say(text)}" if len(sides) > 1 else say(text)
        for side in sides for text in differences(side.found, verification.first)
    ]  # fmt: skip
    remarks = [*(each for side in sides for each in side.found.remarks), *verification.remarks]
    only = next((each for each in remarks if isinstance(each, Remark) and each.key == "bends"), Remark.of("only_this"))
    remarks = [
        each for each in remarks if not (isinstance(each, Remark) and each.key == "unlimited")
    ]  # is an assumption
    cautions = [each for each in remarks if isinstance(each, Remark) and each.key in CAUTIONS]
    general = say.caution(mechanism.mechanism, mechanism.caution) if mechanism.caution else ""
    particular = say.recognised("caution", mechanism.own_caution())
    of_mechanism = [say("Caution: {text}", text=each) for each in (general, particular) if each]
    notes += [say(each) for each in remarks if each not in (*cautions, only)]
    sentences = [Markup(each) for side in sides for each in verdicts(say, side.where, verification, side.found)]
    return {
        "answer": Markup(" ".join(of_verification(verification, say, say(METHOD_NAMES[end.method.split("_")[0]])))),
        "only": Markup(say(only)),
        "fails": end.concluded is not Concluded.SATISFIED,
        "holds": end.concluded in (Concluded.SATISFIED, Concluded.SATISFIED_IF),
        "cautions": [Markup(each) for each in dict.fromkeys([*map(say, cautions), *of_mechanism])],
        "verdicts": sentences,
        "notes": [Markup(each) for each in dict.fromkeys(notes)],
    }


def both(existing: ItalianVerification, strengthened: ItalianVerification) -> dict[str, ItalianVerified]:
    """Return the columns of the comparison of two structures: each in the direction that decides."""
    return {"existing": existing.deciding, "strengthened": strengthened.deciding}


def comparison(say: Language, existing: ItalianVerification, strengthened: ItalianVerification) -> list[Table]:
    """Return a table of the existing structure and the strengthened one, each in the direction that decides."""
    structures = {"existing": existing, "strengthened": strengthened}
    values = {"columns": both(existing, strengthened), "structures": structures, "outcome": partial(outcome, say)}
    return tables(say, PACKAGE, "comparison", values)


def outcome(say: Language, found: ItalianVerification, each: ItalianVerified, state: str) -> str:
    """Return what is concluded on a direction at a limit state, in words."""
    concluded = found.concluded(each, state) if state in each.required else "not required"
    return say("satisfied on conditions" if concluded == Concluded.SATISFIED_IF else concluded.replace("_", " "))


def verdicts(say: Language, where: str, found: ItalianVerification, each: ItalianVerified) -> Iterator[str]:
    """Yield what is concluded at each limit state that is required, by what margin, and what governs."""
    for state in each.required:
        by = each.governing[state]
        counts, at = each.methods[by], each.states.get(state)
        if counts.zeta is None:
            yield say("{where}: the site does not give {state}.", where=where, state=state)
            continue
        values: dict[str, Any] = {"a_g": counts.a_g, "asked": counts.demand}
        if at is not None:
            other = each.methods[OF_STATE[state][1]].a_g or 0.0
            values |= {"d": at.d, "demand": at.demand, "ratio": at.ratio, "T": at.T, "other": other}
        why = Remark(f"why_{by.split('_')[0]}", values)
        beside = state in each.dynamic and any(one.state == state and one.method == by for one in each.checks)
        ends = say("{where}, static methods", where=where) if beside else where
        yield say(f"verdict_{found.concluded(each, state)}", where=ends, state=state, zeta=counts.zeta, why=why)


def methods(say: Language, where: str, each: ItalianVerified) -> list[Table]:
    """Return a table of the capacity by each method, on the exact curve and on the straight line."""
    return tables(say, PACKAGE, "methods", {"where": where, "each": each, "title": partial(title, say)})


SETS = {True: "with FC", False: "without FC"}


def histories(say: Language, dynamic: Dynamic, FC: float) -> Iterator[Sentence | Table]:
    """Yield the results of the dynamic method in a direction at a limit state, as sentences and a table."""
    state = dynamic.state
    yield Sentence(say("dynamic_is", d0=dynamic.d0, state=state))
    yield Sentence(say(dynamic.motions.kind, floor=say.items(dynamic.motions.floor or "")))
    yield _table(say, dynamic)
    for confident in SETS if FC != 1 else (True,):
        yield from map(Sentence, _on_histories(say, dynamic, confident=confident))
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


def _on_histories(say: Language, dynamic: Dynamic, *, confident: bool) -> Iterator[str]:
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
        every = [each.why or Remark.of("unknown_other") for each in dynamic.records if each.name in unknown]
        why = list(dict.fromkeys(map(say, every)))
        yield say("unknown_fails", **values, names=", ".join(unknown), count=len(unknown), why=why)
