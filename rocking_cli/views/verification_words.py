"""What a verification says in sentences: whether it passes, what governs and why its methods differ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rocking_cli.studies.verification.results import Dynamic, Verification, Verified
from rocking_cli.studies.verification.working import Working

SAME = 0.005  # of an a_g: methods that differ by less agree
ORDINAL = {True: "With FC", False: "Without FC, which is what `rocking respond` follows"}


def verdict(found: Verified, first: str, where: str) -> str:
    """Whether a direction passes at the first limit state, by how much, and what governs; `where` names it."""
    at, counts = found.states[first], found.counts
    if at.demand is None or at.ratio is None or counts.a_g is None or counts.asked is None or counts.zeta is None:
        return f"{where}: the site does not give {first}."
    held = (
        f"the displacement allowed, {at.d:.4g} m, is {at.ratio:.3g} times the {at.demand:.4g} m asked for at "
        f"{at.T:.3g} s"
    )
    passes = found.passes(first)
    if found.governs == "damage":
        by_displacement = found.methods["nonlinear"].a_g or 0.0
        return (
            f"{where}, {first}: {'passes' if passes else 'fails'}. Damage governs: below a_g = {counts.a_g:.4g} g it "
            f"does not begin to rock, and by displacement alone it could take {by_displacement:.4g} g; {held}. "
            f"Asked for are {counts.asked:.4g} g: zeta_E = {counts.zeta:.3g}."
        )
    return (
        f"{where}, {first}: {'passes' if passes else 'fails'}. The nonlinear method governs: {held}. It can take a_g = "
        f"{counts.a_g:.4g} g, asked for are {counts.asked:.4g} g: zeta_E = {counts.zeta:.3g}."
    )


def differences(found: Verified, first: str) -> Iterator[str]:
    """Why the methods differ: the linear one from what governs, and the straight line from the exact curve."""
    linear, counts, at = found.methods["linear"].a_g, found.counts.a_g, found.states[first]
    if linear is None or counts is None:
        return
    ratio, begins = linear / counts, found.methods["damage"].a_g or 0.0
    if abs(ratio - 1) <= SAME:
        yield f"The linear method says the same, {linear:.4g} g."
    elif ratio < 1:
        yield (
            f"The linear method allows {linear:.4g} g only, {100 * ratio:.3g} % of that: it is {linear / begins:.3g} "
            f"times the acceleration at which rocking begins, and does not count that the structure may go "
            f"{at.d:.3g} m once it rocks, at a period of {at.T:.3g} s."
        )
    else:
        yield (
            f"The linear method allows {linear:.4g} g, {ratio:.3g} times that: it is {linear / begins:.3g} times the "
            "acceleration at which rocking begins, and does not see that the structure would then go further than "
            f"the {at.d:.3g} m allowed. It is not on the safe side here."
        )
    line = found.straight_methods["nonlinear"].a_g
    exact = found.methods["nonlinear"].a_g
    if line is not None and exact is not None and abs(line / exact - 1) > SAME:
        more = "more" if line > exact else "less"
        yield (
            f"On the straight line from a0* to d0* the nonlinear method allows {line:.4g} g, "
            f"{100 * abs(line / exact - 1):.2g} % {more} than on the exact curve."
        )


def beyond_first(found: Verified, first: str) -> Iterator[str]:
    """Whether it passes at the other limit states that the site gives."""
    for name, at in found.states.items():
        if name != first and at.demand is not None and at.ratio is not None:
            yield (
                f"{name}: the displacement allowed, {at.d:.4g} m, is {at.ratio:.3g} times the {at.demand:.4g} m asked "
                f"for at {at.T:.3g} s: {'passes' if at.passes else 'fails'}."
            )
    damage = found.methods.get("SLD")
    if damage is not None and damage.zeta is not None and damage.asked is not None and damage.a_g is not None:
        yield (
            f"SLD: it begins to rock at a_g = {damage.a_g:.4g} g, asked for are {damage.asked:.4g} g: "
            f"{'passes' if damage.passes else 'fails'}."
        )


def of_histories(found: Dynamic, FC: float) -> Iterator[str]:
    """What histories say, with FC, which is the verdict, and without it."""
    for confident in (True, False) if FC != 1 else (True,):
        yield _of_some(found, confident=confident)
    if FC != 1:
        changed = [
            state
            for state in found.allowed
            if found.holds(state, confident=True) != found.holds(state, confident=False)
        ]
        if changed:
            yield f"FC changes the verdict at {' and '.join(changed)}."
    count = len(found.records)
    if count < found.enough:
        yield (
            f"{'This is one record' if count == 1 else f'These are {count} records'}: the code wants {found.enough} or "
            "more for a mean."
        )


def _of_some(found: Dynamic, *, confident: bool) -> str:
    passed, mean = found.passed(confident=confident), found.mean(confident=confident)
    start = ORDINAL[confident]
    if passed or mean is None:
        return f"{start}: it does not hold, {', '.join(passed)} {'takes' if len(passed) == 1 else 'take'} it past d0*."
    held = [
        f"{'within' if found.holds(state, confident=confident) else 'beyond'} d_{state} = {allowed:.4g} m"
        for state, allowed in found.allowed.items()
    ]
    return f"{start}: no record takes it past d0* = {found.d0:.4g} m; the mean of the peaks, {mean:.4g} m, is " + (
        f"{' and '.join(held)}."
    )


def which_direction(found: Verification) -> str:
    """Which direction governs, and by how much."""
    (one, other) = found.directions.values()
    ratios = [each.states[found.first].ratio for each in (one, other)]
    if None in ratios:
        return ""
    least = found.governs
    ratio = found.directions[least].states[found.first].ratio
    rest = found.directions[least.opposite].states[found.first].ratio
    if ratio is None or rest is None or found.alike:
        return ""
    return f"The {least.label} direction governs: d over demand is {ratio:.3g}, in the other {rest:.3g}."


def standing(workings: Sequence[Working]) -> str:
    """How far the formulas were checked."""
    ours = list(dict.fromkeys(each.symbol.partition(",")[0] for each in workings if each.standing == "ours"))
    return (
        "Clauses are where the code has the formulas; none was yet held against its printed text: have them checked "
        f"before you rely on a verdict. Ours, where the code leaves it open or reads otherwise: {', '.join(ours)}."
    )
