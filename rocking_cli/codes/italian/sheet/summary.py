"""Summary of the sheet: whether each direction passes at each limit state, by which margin, and what governs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rocking_cli.codes.italian.results import ItalianVerification, ItalianVerified
from rocking_cli.codes.italian.rules import OF_STATE
from rocking_cli.codes.italian.sheet.methods import title
from rocking_cli.codes.italian.words import differences
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.views.conclusion import of_verification
from rocking_cli.views.sheet.document import Grid, Item, Sentence, SheetPart
from rocking_cli.views.sheet.language import Language, plain


def part(say: Language, found: ItalianVerification, shown: Mapping[str, ItalianVerified]) -> SheetPart:
    """Return the part with the summary."""
    end = found.conclusion
    method = say.say(f"short_{end.method.split('_')[0]}")
    said = [say.remark(each) for each in of_verification(found, method)]
    fails = end.concluded is not Concluded.SATISFIED
    items: list[Item] = [Sentence(" ".join(said), answers=True, fails=fails)]
    items += [
        verdict(say, end.limit_state if end.limit_state in each.states else found.first, where, each)
        for where, each in shown.items()
    ]
    for where, each in shown.items():
        items += _starts_later(say, found.first, where, each)
    if len(shown) > 1:  # which direction governs
        least = found.governs
        ratio, rest = (found.compared(direction) for direction in (least, least.opposite))
        if ratio is not None and rest is not None and not found.alike:
            items.append(Sentence(say.say("which", least=say.say(f"short_{least.label}"), ratio=ratio, rest=rest)))
    for where, each in shown.items():
        items += [_states(say, where, each), _methods(say, where, each)]
    caution = found.mechanism.caution
    remarks = [remark for each in shown.values() for remark in each.remarks]
    said = [
        f"{where}: {say.remark(text)}" if len(shown) > 1 else say.remark(text)
        for where, each in shown.items() for text in differences(each, found.first)
    ]  # fmt: skip
    said += [say.remark(each) for each in dict.fromkeys([*remarks, *found.remarks])]
    if caution:
        said.append(say.say("caution", text=say.caution(found.mechanism.mechanism, caution)))
    if own := found.mechanism.own_caution():
        said.append(say.say("caution", text=plain(own)))
    under = [SheetPart("remarks", say.say("remarks"), [*map(Sentence, said)])] if said else []
    return SheetPart("summary", say.say("summary"), items, under)


def verdict(say: Language, first: str, where: str, each: ItalianVerified) -> Sentence:
    """Return the sentence with the verdict on a direction."""
    (damage, nonlinear), by = OF_STATE[first], each.governing[first]
    at, counts, passes = each.states[first], each.methods[by], each.passes(first)
    if passes is None or at.demand is None or at.ratio is None or counts.a_g is None or counts.demand is None:
        return Sentence(say.say("no_state", where=where, state=first))
    if by == damage:
        other = each.methods[nonlinear].a_g or 0.0
        why = say.say("why_damage", a_g=counts.a_g, other=other, asked=counts.demand)
    else:
        why = say.say(
            "why_nonlinear", d=at.d, ratio=at.ratio, demand=at.demand, T=at.T, a_g=counts.a_g, asked=counts.demand
        )
    key = "verdict_passes" if passes else "verdict_fails"
    text = say.say(key, where=where, state=first, zeta=counts.zeta, why="@").replace("@", why)
    return Sentence(text)


def _starts_later(say: Language, first: str, where: str, each: ItalianVerified) -> Iterator[Item]:
    """Yield remarks on further limit states at which the onset of rocking governs, not the displacement ratio."""
    for state in each.states:
        (damage, nonlinear), counts = OF_STATE[state], each.methods[each.governing[state]]
        if state != first and each.governing[state] == damage and each.passes(state) is not None:
            other = each.methods[nonlinear].a_g or 0.0
            why = say.say("why_damage", a_g=counts.a_g, other=other, asked=counts.demand)
            key = "verdict_passes" if each.passes(state) else "verdict_fails"
            yield Sentence(say.say(key, where=where, state=state, zeta=counts.zeta, why="@").replace("@", why))


def _states(say: Language, where: str, each: ItalianVerified) -> Grid:
    rows = []
    for state, at in each.states.items():
        known = at.ratio is not None
        outcome = say.say("unknown" if not known else "yes" if each.passes(state) else "no")
        rows.append([state, *(say.number(v, 4) for v in (at.d, at.demand, at.T, at.ratio)), outcome])
    damage = each.methods.get("SLD")
    if damage is not None and damage.zeta is not None:
        numbers = [say.number(v, 4) for v in (damage.a_g, damage.demand, None, damage.zeta)]
        numbers[:2] = [f"{text} g" for text in numbers[:2]]
        rows.append([say.say("begins", state="SLD"), *numbers, say.say("yes" if damage.passed else "no")])
    heads = [say.say("limit_state"), f"{say.say('allowed')} [m]", f"{say.say('asked')} [m]", "T [s]", say.say("ratio")]
    return Grid(say.say("states", where=where), [*heads, say.say("outcome")], rows, (1, 2, 3, 4))


def _methods(say: Language, where: str, each: ItalianVerified) -> Grid:
    known = any(method.return_period is not None for method in each.methods.values())
    rows = []
    for key, method in each.methods.items():
        if method.a_g is None or each.stands_back(key):
            continue
        line = each.straight_methods[key]
        numbers = [say.number(v, 4) for v in (method.a_g, line.a_g, method.demand, method.zeta)]
        years = [method.lasts or say.number(None)] if known else []
        rows.append(
            [title(say, key), *numbers, *years, say.say("governs", state=state) if (state := each.decides(key)) else ""]
        )
    heads = [say.say("method"), f"a_[g] [g], {say.say('exact')}", f"a_[g] [g], {say.say('line')}"]
    heads += [f"{say.say('asked')} [g]", "ζ_[E]", *([say.say("TR_years")] if known else []), ""]
    return Grid(say.say("methods", where=where), heads, rows, range(1, len(heads) - 1))
