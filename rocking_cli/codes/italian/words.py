"""The sentences of a verification: whether it passes, what governs and why its methods differ."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.codes.italian.remarks import TEXTS
from rocking_cli.codes.italian.results import Dynamic, ItalianVerified
from rocking_cli.codes.italian.rules import OF_STATE
from rocking_cli.studies.verification.told import Told
from rocking_cli.views.verdict import unchecked

SAME = 0.005  # of an a_g: methods that differ by less agree
ORDINAL = {True: "With FC", False: "Without FC (`rocking respond` uses none)"}


def verdict(found: ItalianVerified, first: str, where: str) -> str:
    """State whether a direction passes at the first limit state, by what margin, and which method governs.

    `where` names the direction.
    """
    said = _verdict_at(found, first)
    return f"{where}: the site does not give {first}." if said is None else f"{where}, {said}"


def _verdict_at(found: ItalianVerified, state: str) -> str | None:
    """State whether a direction passes at a limit state; None if the site does not give it."""
    damage, nonlinear = OF_STATE[state]
    at, counts = found.states[state], found.methods[found.governing[state]]
    if at.demand is None or at.ratio is None or counts.a_g is None or counts.demand is None or counts.zeta is None:
        return None
    outcome = f"{state}: {'passes' if found.passes(state) else 'fails'}."
    held = (
        f"the displacement capacity, {at.d:.4g} m, is {at.ratio:.3g} times the demand of {at.demand:.4g} m at T = "
        f"{at.T:.3g} s"
    )
    capacity = f"Capacity a_g = {counts.a_g:.4g} g, demand {counts.demand:.4g} g: zeta_E = {counts.zeta:.3g}."
    if found.governing[state] == damage:
        by_displacement = found.methods[nonlinear].a_g or 0.0
        return (
            f"{outcome} The damage method governs: the structure does not start to rock below a_g = {counts.a_g:.4g} "
            f"g, while its capacity by displacement alone is {by_displacement:.4g} g; {held}. {capacity}"
        )
    return f"{outcome} The nonlinear method governs: {held}. {capacity}"


def differences(found: ItalianVerified, first: str) -> Iterator[Told]:
    """Explain why the linear method and the straight line differ from the method and curve that govern."""
    linear, counts, at = found.methods["linear"].a_g, found.counts.a_g, found.states[first]
    if linear is None or counts is None:
        return
    ratio, begins = linear / counts, found.methods["damage"].a_g or 0.0
    key = "linear_same" if abs(ratio - 1) <= SAME else "linear_less" if ratio < 1 else "linear_more"
    yield Told.of(
        TEXTS, key, linear=linear, state=first, ratio=ratio, share=100 * ratio, times=linear / begins, T=at.T, d=at.d
    )
    line = found.straight_methods["nonlinear"].a_g
    exact = found.methods["nonlinear"].a_g
    if line is not None and exact is not None and abs(line / exact - 1) > SAME:
        side = Told.of(TEXTS, "more" if line > exact else "less")
        yield Told.of(TEXTS, "straight", line=line, change=100 * abs(line / exact - 1), side=side)


def beyond_first(found: ItalianVerified, first: str) -> Iterator[str]:
    """State whether the direction passes at the other limit states that the site gives."""
    for name in found.states:
        said = _verdict_at(found, name) if name != first else None
        if said is not None:
            yield said
    damage = found.methods.get("SLD")
    if damage is not None and damage.zeta is not None and damage.demand is not None and damage.a_g is not None:
        yield (
            f"SLD: {'passes' if damage.passed else 'fails'}. Rocking starts at a_g = {damage.a_g:.4g} g; the demand "
            f"is {damage.demand:.4g} g."
        )


def of_histories(found: Dynamic, FC: float) -> Iterator[str]:
    """State what the records are, and the result of the time histories, with FC (the verdict) and without it."""
    (only,) = found.allowed
    yield (
        f"The records belong to {only} and are checked against this limit state alone. "
        f"{MOVES[found.motions.kind].format(floor=found.motions.floor)}."
    )
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
        yield unchecked()
    count = len(found.records)
    if count < found.enough:
        yield (
            f"{'Only one record was' if count == 1 else f'Only {count} records were'} used: the code requires at "
            f"least {found.enough} before the mean may be used."
        )


MOVES = {
    "as_given": "The motions act on the structure as given",
    "carried_to_floor": "The ground motions are carried to the floor of the site, {floor}, by its first mode",
    "carried_by_option": "The ground motions are carried to the floor given with the records, {floor}",
    "of_floor": "The motions are taken as motions of the floor, as stated, and not of the ground",
}
"""What the motions of the histories are, by `Moves`."""


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
