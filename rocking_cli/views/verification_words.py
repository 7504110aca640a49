"""The sentences of a verification: whether it passes, what governs and why its methods differ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rocking_cli.dynamics.holding import NOT_CHECKED
from rocking_cli.studies.verification.results import Dynamic, Verification, Verified
from rocking_cli.studies.verification.working import Working

SAME = 0.005  # of an a_g: methods that differ by less agree
ORDINAL = {True: "With FC", False: "Without FC, as in `rocking respond`"}


def verdict(found: Verified, first: str, where: str) -> str:
    """State whether a direction passes at the first limit state, by what margin, and which method governs.

    `where` names the direction.
    """
    at, counts = found.states[first], found.counts
    if at.demand is None or at.ratio is None or counts.a_g is None or counts.asked is None or counts.zeta is None:
        return f"{where}: the site does not give {first}."
    held = (
        f"the displacement capacity, {at.d:.4g} m, is {at.ratio:.3g} times the demand of {at.demand:.4g} m at T = "
        f"{at.T:.3g} s"
    )
    passes = found.passes(first)
    if found.governs == "damage":
        by_displacement = found.methods["nonlinear"].a_g or 0.0
        return (
            f"{where}, {first}: {'passes' if passes else 'fails'}. The damage method governs: the structure does not "
            f"start to rock below a_g = {counts.a_g:.4g} g, while its capacity by displacement alone is "
            f"{by_displacement:.4g} g; {held}. Capacity a_g = {counts.a_g:.4g} g, demand {counts.asked:.4g} g: zeta_E "
            f"= {counts.zeta:.3g}."
        )
    return (
        f"{where}, {first}: {'passes' if passes else 'fails'}. The nonlinear method governs: {held}. Capacity a_g = "
        f"{counts.a_g:.4g} g, demand {counts.asked:.4g} g: zeta_E = {counts.zeta:.3g}."
    )


def differences(found: Verified, first: str) -> Iterator[str]:
    """Explain why the linear method and the straight line differ from the method and curve that govern."""
    linear, counts, at = found.methods["linear"].a_g, found.counts.a_g, found.states[first]
    if linear is None or counts is None:
        return
    ratio, begins = linear / counts, found.methods["damage"].a_g or 0.0
    if abs(ratio - 1) <= SAME:
        yield f"The linear method gives the same capacity, {linear:.4g} g."
    elif ratio < 1:
        yield (
            f"The linear method gives only {linear:.4g} g, {100 * ratio:.3g} % of that capacity: it accepts "
            f"{linear / begins:.3g} times the acceleration at which rocking starts, and ignores that the structure may "
            f"then rock, with a period of {at.T:.3g} s, up to its displacement capacity of {at.d:.3g} m."
        )
    else:
        yield (
            f"The linear method gives {linear:.4g} g, {ratio:.3g} times that capacity: it accepts "
            f"{linear / begins:.3g} times the acceleration at which rocking starts, and ignores that the structure "
            f"would then exceed its displacement capacity of {at.d:.3g} m. It is unconservative here."
        )
    line = found.straight_methods["nonlinear"].a_g
    exact = found.methods["nonlinear"].a_g
    if line is not None and exact is not None and abs(line / exact - 1) > SAME:
        more = "more" if line > exact else "less"
        yield (
            f"With the straight line from a0* to d0*, the nonlinear method gives a capacity of {line:.4g} g, "
            f"{100 * abs(line / exact - 1):.2g} % {more} than with the exact curve."
        )


def beyond_first(found: Verified, first: str) -> Iterator[str]:
    """State whether the direction passes at the other limit states that the site gives."""
    for name, at in found.states.items():
        if name != first and at.demand is not None and at.ratio is not None:
            yield (
                f"{name}: {'passes' if at.passes else 'fails'}. The displacement capacity, {at.d:.4g} m, is "
                f"{at.ratio:.3g} times the demand of {at.demand:.4g} m at T = {at.T:.3g} s."
            )
    damage = found.methods.get("SLD")
    if damage is not None and damage.zeta is not None and damage.asked is not None and damage.a_g is not None:
        yield (
            f"SLD: {'passes' if damage.passes else 'fails'}. Rocking starts at a_g = {damage.a_g:.4g} g; the demand "
            f"is {damage.asked:.4g} g."
        )


def of_histories(found: Dynamic, FC: float) -> Iterator[str]:
    """State the result of the time histories, with FC (the verdict) and without it."""
    for confident in (True, False) if FC != 1 else (True,):
        yield _of_some(found, confident=confident)
    if FC != 1:
        changed = [
            state
            for state in found.allowed
            if found.holds(state, confident=True) != found.holds(state, confident=False)
        ]
        if changed:
            yield f"The confidence factor FC changes the verdict at {' and '.join(changed)}."
    if not found.checked:
        yield f"Caution: {NOT_CHECKED[0].lower()}{NOT_CHECKED[1:]}"
    count = len(found.records)
    if count < found.enough:
        yield (
            f"{'Only one record was' if count == 1 else f'Only {count} records were'} used: the code requires at "
            f"least {found.enough} before the mean may be used."
        )


def _of_some(found: Dynamic, *, confident: bool) -> str:
    passed, mean = found.passed(confident=confident), found.mean(confident=confident)
    unknown = found.unknown(confident=confident)
    start = ORDINAL[confident]
    if passed or mean is None:
        said = f"{start}: not satisfied."
        if passed:
            said += f" {', '.join(passed)} {'takes' if len(passed) == 1 else 'take'} the structure past d0*."
        if unknown:
            said += (
                f" The outcome under {', '.join(unknown)} is unknown, as a joint opens or slides that the model keeps "
                "closed: the record proves neither that the structure stands nor that it falls, and an unknown "
                f"outcome does not pass, at {' and '.join(found.allowed)}."
            )
        return said
    held = [
        f"{'within' if found.holds(state, confident=confident) else 'beyond'} d_{state} = {allowed:.4g} m"
        for state, allowed in found.allowed.items()
    ]
    return (
        f"{start}: no record takes the structure past d0* = {found.d0:.4g} m; the mean peak displacement, "
        f"{mean:.4g} m, is {' and '.join(held)}."
    )


def which_direction(found: Verification) -> str:
    """State which direction governs, with the ratios of both."""
    (one, other) = found.directions.values()
    ratios = [each.states[found.first].ratio for each in (one, other)]
    if None in ratios:
        return ""
    least = found.governs
    ratio = found.directions[least].states[found.first].ratio
    rest = found.directions[least.opposite].states[found.first].ratio
    if ratio is None or rest is None or found.alike:
        return ""
    return (
        f"The {least.label} direction governs: its ratio of displacement capacity to demand is {ratio:.3g}, against "
        f"{rest:.3g} in the other direction."
    )


def standing(workings: Sequence[Working]) -> str:
    """State how far the formulas were checked against the code."""
    ours = {each.symbol.partition(",")[0]: each.meaning for each in workings if each.standing == "ours"}
    said = (
        "The clauses name the place of each formula in the code. None of the formulas has been checked against the "
        "printed code yet: have them checked before you rely on a verdict."
    )
    if not ours:
        return said
    named = ", ".join(f"{symbol} ({meaning})" for symbol, meaning in ours.items())
    return f"{said} Our own choices ('ours'), where the code is silent or we depart from its wording: {named}."
