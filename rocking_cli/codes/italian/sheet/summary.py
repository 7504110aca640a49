"""Summary of the sheet: whether each direction passes at each limit state, by which margin, and what governs.

The terminal shows the verdicts and the table of methods of this summary, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from markupsafe import Markup

from rocking_cli.codes.italian.remarks import differences
from rocking_cli.codes.italian.results import HISTORIES, ItalianVerification, ItalianVerified
from rocking_cli.codes.italian.rules import DAMAGE, LINEAR, NONLINEAR, OF_STATE
from rocking_cli.codes.italian.sheet.steps import PACKAGE, DirectionSteps, title
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.verification.results import Remark
from rocking_cli.views.conclusion import of_verification
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.sheet.template import tables
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
