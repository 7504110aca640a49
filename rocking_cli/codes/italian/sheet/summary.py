"""Summary of the sheet: whether each direction passes at each limit state, by which margin, and what governs.

The terminal shows the verdicts and the table of methods of this summary, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rocking_cli.codes.italian.remarks import differences
from rocking_cli.codes.italian.results import HISTORIES, ItalianVerification, ItalianVerified
from rocking_cli.codes.italian.rules import DAMAGE, LINEAR, NONLINEAR, OF_STATE
from rocking_cli.codes.italian.sheet.steps import title
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.verification.results import Remark, in_plain
from rocking_cli.views.conclusion import of_verification
from rocking_cli.views.sheet.document import Item, Sentence, SheetPart
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.view import Table

METHOD_NAMES = {
    "SLD": "onset of rocking", DAMAGE: "onset of rocking", LINEAR: "linear method", NONLINEAR: "nonlinear method",
    HISTORIES: "time histories",
}  # fmt: skip
"""Names of the methods within a sentence, by their kind."""
OTHER_ROLES = {DAMAGE: "not required", LINEAR: "comparison"}
"""Roles of the methods that decide at no limit state, by their kind: rocking may start before SLV and SLC."""
CAUTIONS = ("stretched", "wide", "same_mode")
"""Keys of the remarks that stand on the first page."""


def parts(
    say: Language, verification: ItalianVerification, directions: Mapping[str, ItalianVerified]
) -> Iterator[SheetPart]:
    """Yield what decides: the verdict, capacity and demand, cautions; and then the methods and further remarks."""
    end, mechanism = verification.conclusion, verification.mechanism
    answer = " ".join(of_verification(verification, say, say(METHOD_NAMES[end.method.split("_")[0]])))
    items: list[Item] = [Sentence(answer, answers=True, fails=end.concluded is not Concluded.SATISFIED)]
    items += [_states(say, where, each) for where, each in directions.items()]
    if len(directions) > 1:
        least = verification.governs
        ratio, rest = (verification.compared(direction) for direction in (least, least.opposite))
        if ratio is not None and rest is not None and not verification.alike:
            items.append(Sentence(say("which", least=say(least.label), ratio=ratio, rest=rest)))
    notes = [
        f"{where}: {say(text)}" if len(directions) > 1 else say(text)
        for where, each in directions.items() for text in differences(each, verification.first)
    ]  # fmt: skip
    remarks = [*(each for one in directions.values() for each in one.remarks), *verification.remarks]
    cautions = [say(each) for each in remarks if isinstance(each, Remark) and each.key in CAUTIONS]
    general = say.caution(mechanism.mechanism, mechanism.caution) if mechanism.caution else ""
    particular = say.caution(f"own_{mechanism.mechanism}", mechanism.own_caution()) if mechanism.own_caution() else ""
    cautions += [say("Caution: {text}", text=each) for each in (general, particular) if each]
    notes += [text for text in map(say, remarks) if text not in cautions]
    items += map(Sentence, dict.fromkeys(cautions))
    more: list[Item] = [Sentence(text) for where, each in directions.items() for text in verdicts(say, where, each)]
    more += [methods(say, where, each) for where, each in directions.items()]
    more += map(Sentence, dict.fromkeys(notes))
    yield SheetPart("summary", say("Summary"), items)
    yield SheetPart("remarks", say("Methods and remarks"), more)


def verdicts(say: Language, where: str, each: ItalianVerified) -> Iterator[str]:
    """Yield whether a direction passes at each limit state that the site gives, by what margin, and what governs."""
    for state, at in each.states.items():
        (damage, nonlinear), by = OF_STATE[state], each.governing[state]
        counts = each.methods[by]
        if at.demand is None or counts.a_g is None:
            if state == each.first:
                yield say("{where}: the site does not give {state}.", where=where, state=state)
            continue
        values = {"a_g": counts.a_g, "asked": counts.demand, "other": each.methods[nonlinear].a_g or 0.0}
        values |= {"d": at.d, "demand": at.demand, "ratio": at.ratio, "T": at.T}
        why = Remark("why_damage" if by == damage else "why_nonlinear", values)
        key = "verdict_passes" if each.passes(state) else "verdict_fails"
        yield say(key, where=where, state=state, zeta=counts.zeta, why=why)
    start = each.methods["SLD"]
    if start.zeta is not None:
        key = "verdict_passes" if start.passed else "verdict_fails"
        why = Remark.of("why_SLD", a_g=start.a_g, asked=start.demand)
        yield say(key, where=where, state="SLD", zeta=start.zeta, why=why)


def _states(say: Language, where: str, each: ItalianVerified) -> Table:
    rows = []
    for state, at in each.states.items():
        outcome = "not required" if at.ratio is None else "satisfied" if each.passes(state) else "not satisfied"
        by = say.number(None) if at.ratio is None else title(say, each.governing[state])
        zeta = each.methods[each.governing[state]].zeta
        rows.append([state, *(say.number(v, 4) for v in (at.d, at.demand, at.T, at.ratio)), say(outcome), by,
                     say.number(zeta, 4)])  # fmt: skip
    damage = each.methods["SLD"]
    if damage.zeta is not None:
        numbers = [f"{say.number(damage.a_g, 4)} g", f"{say.number(damage.demand, 4)} g", say.number(None)]
        outcome = say("satisfied" if damage.passed else "not satisfied")
        rows.append([say("{state}, onset of rocking", state="SLD"), *numbers, say.number(damage.zeta, 4), outcome,
                     title(say, "SLD"), say.number(damage.zeta, 4)])  # fmt: skip
    heads = [say("limit state"), f"{say('capacity')} [m]", f"{say('demand')} [m]", "T [s]", say("ratio")]
    caption = say("{where}: limit states, on the exact capacity curve", where=where)
    return Table(caption, [*heads, say("verification"), say("governs"), "ζ_[E]"], rows, (1, 2, 3, 4, 7))


def methods(say: Language, where: str, each: ItalianVerified) -> Table:
    """Return a table of the capacity by each method, on the exact curve and on the straight line."""
    known = any(method.return_period is not None for method in each.methods.values())
    rows = []
    for key, method in each.methods.items():
        if method.a_g is None or each.stands_back(key):
            continue
        numbers = (method.a_g, each.straight_methods[key].a_g, method.demand, method.zeta)
        years = [method.lasts or say.number(None)] if known else []
        role = say(OTHER_ROLES.get(key.split("_")[0], ""))
        if state := each.decides(key):
            role = say("decides {state}", state=state)
        rows.append([title(say, key), *(say.number(value, 4) for value in numbers), *years, method.clause, role])
    heads = [say("method"), f"a_[g] [g]\n{say('exact curve')}", f"a_[g] [g]\n{say('straight line')}"]
    heads += [f"a_[g] [g]\n{say('demand')}", "ζ_[E]", *([say("T_[R] [years]")] if known else [])]
    heads = [in_plain(each) if say.is_plain else each for each in heads]
    caption = say("{where}: capacity by each method", where=where)
    return Table(caption, [*heads, say("clause"), ""], rows, range(1, len(heads)))
