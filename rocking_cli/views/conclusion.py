"""Words of a conclusion, the same on every surface that shows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from math import isfinite
from typing import TYPE_CHECKING, Any

from rocking_cli import names
from rocking_cli.names import percent
from rocking_cli.studies.conclusion import (
    LEAST_SHARE,
    ByBlocks,
    Concluded,
    Conclusion,
    Effect,
    LeftOut,
    Limit,
    NeighbourShare,
    NextStep,
    are_alike,
    worst,
)
from rocking_cli.studies.remark import Remark
from rocking_cli.text import in_short
from rocking_cli.views.sheet.language import ENGLISH, Language
from rocking_cli.views.verdict import GO_ON, REMEDIES

if TYPE_CHECKING:
    from rocking_cli.verification.results import Verification

MAX_DIGITS = 9
POLARITIES = {1: "as given", -1: "reversed"}
NEXT_STEPS: Mapping[str, str] = {
    **REMEDIES,
    NextStep.STRENGTHEN: "hold the structure or change its size: `rocking design` finds a value with which it stands",
    NextStep.MARGIN: "`rocking margin` shows from which scale factor on neighbours overturn, or are unknown",
    NextStep.CONDITIONS: "check each condition and give what it names in the files",
    NextStep.YIELD_FORCE: "give the tie `steel` (or `yield`) in place of its stiffness or modulus, so that it counts",
    NextStep.MORE_MOTIONS: "give at least as many records as the code requires",
    NextStep.FIRST_MECHANISM: "describe the mechanism that starts first as a structure, and verify that structure",
    NextStep.SITE_VALUES: "give the values that the code requires in the site file (`rocking new site` prints one)",
    NextStep.RESPOND: "`rocking respond` under this motion says what ends what is known, and when",
    NextStep.FREE_BLOCKS: GO_ON.removesuffix("; "),
    NextStep.DESIGN: "`rocking design` finds the value of a field at which the ratio reaches what is required",
}


def of_verification(found: Verification, say: Language = ENGLISH, title: str | None = None) -> list[str]:
    """Return the conclusion of a verification as sentences; ties that do not count come first.

    Parameters
    ----------
    found : Verification
        The verification.
    say : Language
        The language.
    title : str, optional
        Name of the method that governs, in the language; by default that of the method.
    """
    end = found.conclusion
    covers = all(each.what != "mechanism" for each in end.left_out)
    first = end.concluded.value if covers or end.concluded is not Concluded.NOT_CHECKED else "not_covered"
    if end.concluded is Concluded.SATISFIED and (len(end.limit_states) > 1 or not end.required):
        first = "satisfied_at" if end.required else "not_asked"
    sentences = [say(f"end_{first}", states=", ".join(end.limit_states), reasons=reasons_of(end, say))]
    if end.concluded is not Concluded.NOT_CHECKED:
        sentences.append(_governs(end, say, title or say(_method(found, end))))
    sentences += [*replaced_in_words(end, say), *map(say, found.rules)]
    others = [
        each._replace(name=say.joint(found.mechanism.mechanism, each.name)) if each.what == "mechanism" else each
        for each in end.left_out if each.what != "tie"
    ]  # fmt: skip
    return uncounted_ties(end, say) + sentences + not_counted(others, say)


def limits_in_words(end: Conclusion, say: Language = ENGLISH) -> list[str]:
    """Return sentences on what limits a conclusion: its conditions, or why it is not decided; and replaced numbers."""
    reasons = reasons_of(end, say)
    return [say(f"end_{end.concluded.value}", reasons=reasons)] * bool(reasons.values) + replaced_in_words(end, say)


def reasons_of(end: Conclusion, say: Language = ENGLISH) -> Remark:
    """Return the conditions of a conclusion, or why it is not decided, as clauses; without values if there are none."""
    each = [_remark(limit, say) for limit in end.limits if limit.effect is not Effect.REPLACES]
    if end.concluded is Concluded.NOT_DECIDED and not each:
        shaken = end.ratio is not None or end.motion
        each = [Remark.of("end_before" if end.required is None else "end_whole" if shaken else "end_missing")]
    values = {f"reason{k}": reason for k, reason in enumerate(each)}
    return Remark("; ".join(f"{{{key}}}" for key in values), values)


def replaced_in_words(end: Conclusion, say: Language = ENGLISH) -> list[str]:
    """Return sentences on the numbers of a conclusion that count in place of others."""
    return [limit_in_words(each, say) for each in end.limits if each.effect is Effect.REPLACES]


def limit_in_words(limit: Limit, say: Language = ENGLISH) -> str:
    """Return what limits a conclusion: a clause, or a sentence on a number that is replaced."""
    return say(_remark(limit, say))


def _remark(limit: Limit, say: Language) -> Remark:
    values = dict(limit.values)
    if isinstance(text := values.get("text"), str):  # of a mechanism
        values["text"] = say.recognised("caution", text)
    key = f"end_{limit.key}"
    return Remark(key if key in say.texts else limit.key, values)


def uncounted_ties(end: Conclusion, say: Language = ENGLISH) -> list[str]:
    """Return a sentence on the ties that do not count, and the fields that make them count; empty if all do."""
    return not_counted([each for each in end.left_out if each.what == "tie"], say)


def not_counted(left_out: Sequence[LeftOut], say: Language = ENGLISH) -> list[str]:
    """Return a sentence for each reason for which something does not count, in a language."""
    of: dict[tuple[str, str], list[str]] = {}
    for each in left_out:
        of.setdefault((each.why, each.state), []).append(each.name)
    return [say(f"end_{why}", names=", ".join(names), state=state) for (why, state), names in of.items()]


def _governs(end: Conclusion, say: Language, method: str) -> str:
    if end.ratio is not None:
        key = f"end_ratio_{end.method}" if f"end_ratio_{end.method}" in say.texts else "end_ratio"
        ratio = Remark.of(key, ratio=end.ratio, digits=digits_beside(end.ratio, end.required or 1.0))
    else:
        missing = end.concluded is Concluded.NOT_DECIDED and not end.motion
        key = "end_missing" if missing else "end_unproven" if end.concluded is Concluded.UNKNOWN else "end_past"
        ratio = Remark.of(key, motion=end.motion)
    direction = Remark.of(f"end_direction_{end.direction}") if end.direction else ""
    values = {"state": end.limit_state, "direction": direction, "ratio": ratio}
    if end.limit_state:
        return say("end_governs_at", method=method, **values)
    return say("end_governs", method=f"{method[:1].upper()}{method[1:]}", **values)


def _method(found: Verification, end: Conclusion) -> str:
    each = next(iter(found.directions.values()))
    title = each.methods[end.method].title if end.method in each.methods else "time histories"
    return title.removesuffix(f" at {end.limit_state}")


def digits_beside(ratio: float, required: float = 1.0) -> int:
    """Return how many digits of a ratio show on which side of what is required it is, at least three."""
    shown = ((n, float(f"{ratio:.{n}g}")) for n in range(3, MAX_DIGITS))
    return next((n for n, printed in shown if (printed < required) == (ratio < required)), MAX_DIGITS)


CLAUSES = {
    Concluded.OVERTURNS: names.OVERTURNS,
    Concluded.FALLS_OFF: f"{names.FALLS_OFF} what it stands on",
    Concluded.UNKNOWN: "has an unknown outcome",
    Concluded.STILL_MOVES: "still moves",
    Concluded.ROCKS: names.ROCKS,
    Concluded.SLIDES: "slides and does not overturn",
    Concluded.COMES_TO_REST: names.COMES_TO_REST,
    Concluded.NO_UPLIFT: names.NO_UPLIFT,
}
"""Clauses on outcomes, the worst first."""
MAX_NAMED_MOTIONS = 6  # motions that a sentence names


def counted(ends: Sequence[Conclusion], over: str) -> str:
    """Return a sentence with the number of motions of each outcome, the worst first, and the motion that governs.

    Parameters
    ----------
    ends : sequence of Conclusion
        The conclusion under each motion, at least one.
    over : str
        Reference of the peaks, see `names.peaks_over`.
    """
    if len(ends) == 1:
        return f"under {ends[0].motion}, {does(ends[0], over)}."
    count, outcomes = len(ends), list[str]()
    for what, clause in CLAUSES.items():
        under = [end.motion for end in ends if end.concluded is what]
        if len(under) == count and what is Concluded.NO_UPLIFT:
            return f"the structure uplifts under none of {count} motions."
        if under:
            of = f"all {count}" if len(under) == count else f"{len(under)}{'' if outcomes else f' of {count}'}"
            bad = what in (Concluded.OVERTURNS, Concluded.FALLS_OFF, Concluded.UNKNOWN) and len(under) < count
            named = f" ({in_short(under, most=MAX_NAMED_MOTIONS)})" if bad else ""
            outcomes.append(f"{clause} under {of}{'' if outcomes else ' motions'}{named}")
    *before, last = outcomes
    return f"the structure {', '.join(before)}{' and ' if before else ''}{last}. {governing(ends, over)}"


def governing(ends: Sequence[Conclusion], over: str) -> str:
    """Return a sentence on which motion governs, or which ones equally; empty if none uplifts the structure.

    Parameters
    ----------
    ends : sequence of Conclusion
        The conclusion under each motion, at least one.
    over : str
        Reference of the peaks, see `names.peaks_over`.
    """
    end = worst(ends)
    which = [each.motion for each in ends if are_alike(each, end)]
    if end.concluded is Concluded.NO_UPLIFT and not (end.share is not None and end.share.highest):
        return ""
    if len(which) > 1:
        return f"{', '.join(which[:-1])} and {which[-1]} govern alike: under each, {does(end, over)}."
    return f"{which[0]} governs: {does(end, over)}."


def governing_polarity(ends: Mapping[int, Conclusion], governs: int | None, over: str) -> str:
    """Return a sentence on which of two polarities governs; arguments are those of `governing`."""
    if governs is None:
        return f"Neither polarity governs: with the motion as given and reversed, {does(ends[1], over)}."
    name, other = (POLARITIES[governs], POLARITIES[-governs])
    sentence = f"with the motion {name}, {does(ends[governs], over)}; {other}, {does(ends[-governs], over)}"
    return f"Polarity {governs} governs: {sentence}."


def of_margin(end: Conclusion, over: str, unknown: str = "") -> str:
    """Return the conclusion of a margin in sentences: the motion that governs, its outcome, share and factor.

    `unknown` stands in place of the factor if what is known ends there.
    """
    assert end.ratio is not None
    which = f"{end.motion} governs {len(end.motions)} motions: at" if len(end.motions) > 1 else "At"
    some = f"{percent(LEAST_SHARE)} or more"
    factor = unknown or (
        f"The smallest factor at which {some} may overturn is {end.ratio:.3g}."
        if isfinite(end.ratio)
        else f"At no factor tried may {some} overturn."
    )
    return " ".join(filter(None, [f"{which} a factor of 1, {does(end, over)}.", factor, next_in_words(end)]))


def does(end: Conclusion, over: str) -> str:
    """Return what the structure does, and the share of its neighbours that overturn; arguments as of `governing`."""
    if end.concluded is Concluded.UNKNOWN:
        itself = f"the outcome is {names.UNKNOWN} after {end.known_until:.4g} s"
    elif end.concluded is Concluded.ROCKS:
        itself = f"the structure {names.ROCKS} to {end.peak_ratio:.3g} {over}"
    elif end.concluded is Concluded.SLIDES:
        itself = f"the structure does not overturn and slides by up to {end.slip:.3g} m"
    else:
        itself = f"the structure {end.concluded.value.replace('_', ' ')}"
    if end.blocks is not None:
        itself += f"{' and' if end.share is None else ','} as free blocks it {blocks_end(end.blocks, over)}"
    return itself if end.share is None else f"{itself}, and {_of_neighbours(end.share)}"


def blocks_end(blocks: ByBlocks, over: str) -> str:
    """Return what free blocks do, in a few words that follow "it"; peaks are divided by `over`, such as "phi_cr"."""
    words = blocks.concluded.value.replace("_", " ")
    if blocks.time is not None:
        return f"{words} at {blocks.time:.4g} s"
    if blocks.concluded is Concluded.ROCKS and blocks.peak_ratio is not None:
        return f"{words} to {blocks.peak_ratio:.3g} {over}"
    return f"{words} by up to {blocks.slip:.3g} m" if blocks.slip is not None else words


def _of_neighbours(share: NeighbourShare) -> str:
    if share.highest > share.lowest:
        some = f"{percent(share.lowest)} to {percent(share.highest)}"
        return f"{some} of its {share.of} neighbours overturn, as some outcomes are unknown"
    if share.lowest in (0, 1):
        return f"{'all' if share.lowest else 'none'} of its {share.of} neighbours overturn{'' if share.lowest else 's'}"
    return f"{percent(share.lowest)} of its {share.of} neighbours overturn"


def next_in_words(end: Conclusion, say: Language = ENGLISH) -> str:
    """Return what to do next as a sentence; empty if there is nothing to do."""
    steps = "; ".join(say.texts.get(f"next_{each}", NEXT_STEPS[each]) for each in end.next)
    return say("Next: {steps}.", steps=steps) if steps else ""


def headline(end: Conclusion, over: str) -> str:
    """Return the conclusion in a few words, for a heading: with the peak, the limit state, or the end of validity.

    Peaks are divided by `over`, such as "phi_cr".
    """
    if end.blocks is not None:
        return f"{headline(replace(end, blocks=None), over)}; as free blocks it {blocks_end(end.blocks, over)}"
    if end.known_until is not None:
        return f"{names.UNKNOWN} after {end.known_until:.4g} s"
    if end.concluded is Concluded.ROCKS and end.peak_ratio is not None:
        return f"{names.ROCKS} to {end.peak_ratio:.3g} {over}"
    if end.concluded is Concluded.SLIDES:
        return f"{names.SLIDES} by up to {end.slip:.3g} m"
    words = concluded_in_words(end.concluded)
    if ties := [each.name for each in end.left_out if each.what == "tie"]:
        words = f"{words} without {in_short(ties)}"
    return f"{end.limit_state} {words}" if end.limit_state and end.concluded is not Concluded.SATISFIED else words


def concluded_in_words(concluded: Concluded | str) -> str:
    """Return a keyword of a conclusion as words."""
    words = concluded.replace("_", " ")
    return f"{words} ..." if concluded == Concluded.SATISFIED_IF else words


def conclusion_data(end: Conclusion) -> dict[str, Any]:
    """Return a conclusion as plain data: absent texts are null, and what does not apply is left out."""
    lists = ("rules", "limit_states", "motions", "polarities", "directions")
    data = {key: list(each) if key in lists else None if each == "" else each for key, each in asdict(end).items()}
    data["left_out"] = [each._asdict() for each in end.left_out]
    data["share"] = end.share._asdict() if end.share is not None else None
    if end.blocks is None:
        del data["blocks"]
    else:
        data["blocks"] = end.blocks._asdict()
    data["limits"] = [{"key": each.key, "effect": each.effect, "text": limit_in_words(each)} for each in end.limits]
    del data["remedy"], data["witness"]
    data["next"] = list(end.next)
    return data
