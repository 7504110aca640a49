"""The summary of a report in sentences: uplift, overturning, margin, and which model to trust."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees, isclose, isnan

from rocking_cli import names
from rocking_cli.core import Direction, Statics
from rocking_cli.core.advice import Grade
from rocking_cli.core.equivalence import AGREEMENT
from rocking_cli.core.size import doubts as doubts_about_size
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import agreements, disagree, remedy
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.studies.assessment import Assessment, MotionResult
from rocking_cli.studies.verification.results import Verification
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.conclusion import governing, headline, of_verification
from rocking_cli.views.contact import contact_words
from rocking_cli.views.error import trust
from rocking_cli.views.margin import in_words
from rocking_cli.views.neighbours import neighbours_cells, neighbours_in_words
from rocking_cli.views.restitution import restitution_source, restitution_used
from rocking_cli.views.verdict import REMEDIES, SENSE, blocks_in_words, joints_in_words, unknown_after, why_unknown

MODELS: Mapping[ModelName, str] = {
    "nonlinear": "nonlinear model",
    "linear1": "equivalent block with κ₁",
    "linear2": "equivalent block with κ₂",
}


@dataclass(frozen=True)
class ReaderAnswer:
    """A question of the reader, and the answer."""

    question: str
    answer: str


@dataclass(frozen=True)
class MotionAnswers:
    """The answers for one ground motion.

    Parameters
    ----------
    name : str
        Name of the motion.
    headline : str
        The outcome in a few words.
    answers : tuple of ReaderAnswer
        The answer to each question.
    doubts : tuple of str
        What is doubtful about the motion and the result.
    """

    name: str
    headline: str
    answers: tuple[ReaderAnswer, ...]
    doubts: tuple[str, ...]


def verdicts(content: Assessment) -> tuple[MotionAnswers, ...]:
    """Return the answers for each ground motion."""
    return tuple(_verdict(content, each) for each in content.results)


def in_a_sentence(content: Assessment, verified: Verification | None = None) -> str:
    """Return the answer of the whole report: of its verification, if any, and of its ground motions."""
    return " ".join([*(of_verification(verified) if verified is not None else []), _under_motions(content, verified)])


def _under_motions(content: Assessment, verified: Verification | None) -> str:
    name = content.name
    if not content.results:
        starts = f"{name} starts to rock at a horizontal ground acceleration of {_ground(content, _least(content))}."
        if verified is not None:
            return starts
        return (
            f"{starts} No ground motion was given, so this report does not say whether an earthquake would overturn it."
        )
    falls = [each for each in content.results if _overturns(each)]
    unknown = [each for each in content.results if each.unknown]
    doubtful = all(each.close for each in falls) if falls else any(each.close for each in content.results)
    close = ' The result is close to the other outcome: see "How close is that?" below.' if doubtful else ""
    contacts = [contact for each in content.results for contact in each.contacts.values()]
    if any(not contact.holds and not contact.followed for contact in contacts):
        close += " But its joints do not hold: see below from which time the result is no longer valid."
    if any(contact.assumed_friction is not None for contact in contacts):
        close += " The result assumes that nothing slides: see below how much friction this requires."
    if falls:
        under = _listed([each.given.motion.name for each in falls])
        of = f" ({len(falls)} of {len(content.results)} ground motions)" if len(content.results) > 1 else ""
        beside = f" Under {_named(unknown)} its outcome is {names.UNKNOWN}." if unknown else ""
        return f"{name} {names.OVERTURNS} under {under}{of}.{beside}{close}"
    if unknown:
        return f"{_not_known(content, unknown)}{close}"
    moved = [each for each in content.results if _worst_ratio(each) > 0]
    if not moved:
        under = _listed([each.given.motion.name for each in content.results])
        are = "are" if len(content.results) > 1 else "is"
        return f"{name} {names.NO_UPLIFT}: {under} {are} too weak to cause uplift.{close}"
    worst = max(moved, key=_worst_ratio)
    which = worst.given.motion.name
    run = worst.histories["nonlinear"]
    share = f"{degrees(run.furthest):.3g}°, " if any(run.ends_at_limit) else ""
    share += f"{_share(_worst_ratio(worst))} {_end(run)}"
    if len(content.results) == 1:
        return f"{name} {names.ROCKS} under {which} and does not overturn: its largest rotation is {share}.{close}"
    return (
        f"{name} rocks under {len(moved)} of {len(content.results)} ground motions and overturns under none: its "
        f"largest rotation is {share}, under {which}.{close}"
    )


def _not_known(content: Assessment, unknown: Sequence[MotionResult]) -> str:
    """Return the answer of a report on a structure that overturns under no motion, but has unknown outcomes."""
    if len(content.results) == 1:
        after = unknown_after(unknown[0].histories["nonlinear"]).removeprefix("The outcome")
        return f"The outcome of {content.name} under {_named(unknown)}{after} The structure may overturn."
    others = len(content.results) - len(unknown)
    rest = f" It overturns under none of the {others} other{'s' if others > 1 else ''}." if others else ""
    return (
        f"The outcome of {content.name} is {names.UNKNOWN} under {_named(unknown)} ({len(unknown)} of "
        f"{len(content.results)} ground motions), as joints open or slide that the model keeps closed: it may overturn."
        f"{rest}"
    )


def _named(results: Sequence[MotionResult]) -> str:
    return _listed([each.given.motion.name for each in results])


def overview_columns(content: Assessment, over: str) -> list[str]:
    """Return the headings of `overview`, with what a peak is divided by."""
    unknown = ["neighbours of unknown outcome"] if _neighbours_unknown(content) else []
    return ["ground motion", "PGA [g]", f"peak {over}", "neighbours that overturn", *unknown, "their median peak"]


def overview(content: Assessment) -> list[list[str]]:
    """Return a row for each motion: name, PGA [g], nonlinear peak, shares of its neighbours, and their median."""
    rows = []
    for each in content.results:
        near, run = each.neighbours[each.polarity], each.histories["nonlinear"]
        itself = run.words if run.fell or run.unknown else f"{run.peak_ratio:.3g}"
        share, unknown, median = neighbours_cells(near)
        shares = [share, unknown] if _neighbours_unknown(content) else [share]
        rows.append([each.given.motion.name, f"{each.pga_of_ground:.3g}", itself, *shares, median])
    return rows


def _neighbours_unknown(content: Assessment) -> bool:
    return any(each.neighbours[each.polarity].unknown for each in content.results)


def governs(content: Assessment) -> str:
    """Return a sentence on the motion that governs."""
    return governing([each.conclusion for each in content.results], _over(content))


def _over(content: Assessment) -> str:
    """Return what a peak is divided by, in words."""
    return names.peaks_over([side.phi_cr is None for side in content.structure.statics])


def doubts(content: Assessment) -> list[str]:
    """Return what to check about the structure and the method, under any motion."""
    said = []
    if not content.mechanism.verified:
        said.append(
            f"The mechanism {content.mechanism.mechanism} has not been verified: check its results independently."
        )
    said += cautions_of(content.mechanism)
    said += [
        f"Check the sizes and their units: {doubt}{'' if doubt.endswith('?') else '.'}"
        for doubt in doubts_about_size(content.mechanism)
    ]
    etas = content.structure.etas
    given = restitution_source(content.mechanism) == "given"
    if not content.mechanism.rocks_both_ways:
        said.append(
            "The supports that it leans on are assumed not to move. "
            + ("" if given else "The rebound from them was computed for a sequence of impacts, not measured.")
        )
    elif min(etas) <= 0:
        said.append(
            "Time histories and the overturning map are left out: they need a measured restitution in the file."
        )
    elif not given:
        said.append(
            f"The coefficient of restitution (η = {min(etas):.3g}) was computed for rigid bodies that neither slide "
            "nor bounce. It was not measured, and the response depends on it."
        )
    if any(tie.is_elastic for tie in content.mechanism.ties or []):
        said.append(
            "Ties are assumed elastic: they do not yield, break or pull out of their anchorages. Check the largest "
            "tie forces in this report against the capacity of the ties and their anchorages."
        )
    if content.structure.misleading:
        said.append(f"{content.structure.misleading[0].upper()}{content.structure.misleading[1:]}: they are left out.")
    edges = "without crushing at their edges" if content.mechanism.crushing is None else "on pivots moved inwards"
    said.append(
        f"The bodies are assumed rigid, on rigid ground, in one plane, without sliding and {edges}; the section on "
        "joints shows the friction and forces that this requires. Vertical ground motion is not included. Worn edges "
        "and soft ground lower the resistance."
    )
    if content.mechanism.interlock is not None:
        said.append(
            "The friction of crossing walls is assumed constant. Blocks that have slid by their overlap of "
            f"{1000 * content.mechanism.interlock.overlap:.0f} mm come apart; no result is valid beyond that."
        )
    if any(each.histories["nonlinear"].check is None for each in content.results):
        said.append(f"The joints of this mechanism are not checked: {content.mechanism.unchecked}.")
    return said


def _verdict(content: Assessment, result: MotionResult) -> MotionAnswers:
    return MotionAnswers(
        result.given.motion.name,
        f"{headline(result.conclusion)}{' (close)' if result.close else ''}",
        (
            ReaderAnswer("Will it uplift?", _uplift(content, result)),
            ReaderAnswer("Will it overturn?", _overturning(result)),
            ReaderAnswer("How close is that?", _closeness(content, result)),
            ReaderAnswer("Which model to trust?", _trusted(content, result)),
            *_joints(content, result),
        ),
        tuple(_doubts(result)),
    )


def _joints(content: Assessment, result: MotionResult) -> tuple[ReaderAnswer, ...]:
    """Answer whether the joints hold, in the polarity that governs; empty for a structure that does not rock."""
    run, contact = result.histories["nonlinear"], result.contacts[result.polarity]
    said = [joints_in_words(run, contact.assumed_friction).replace("`", "") if run.check is not None else ""]
    said.append(contact_words(contact, content.mechanism))
    return (ReaderAnswer("Do its joints hold?", " ".join(filter(None, said))),) if said[1] else ()


def _uplift(content: Assessment, result: MotionResult) -> str:
    best, pga = result.histories["nonlinear"], result.measured.pga  # that which reaches it: of a floor its own
    least = _least(content)
    needed = f"A ground acceleration of {_ground(content, least)} is enough to uplift it"
    one, other = (side.lambda_ for side in content.structure.statics)
    both = "" if isclose(one, other, rel_tol=AGREEMENT) else " in its weaker direction"
    if best.uplift_time >= 0:
        return f"Yes, first at {best.uplift_time:.2f} s. {needed}{both}; this motion reaches {pga:.3g} g."
    factor = result.margin.uplift
    weak = pga < least * content.mechanism.gravity / STANDARD_GRAVITY
    but = (
        f"this motion reaches {pga:.3g} g"
        if weak
        else f"this motion, of {pga:.3g} g, reaches it only in the other direction"
    )
    more = f" The motion would have to be {factor:.3g} times as strong to cause uplift." if factor is not None else ""
    no = f"Not up to {best.known_to:.4g} s, beyond which it is unknown" if best.unknown else "No"
    return f"{no}. {needed}{both}; {but}.{more}"


def _overturning(result: MotionResult) -> str:
    said = [f"{_fate(result.histories['nonlinear'], capital=True)}, {_way(result.polarity)}."]
    others = [(sign, runs["nonlinear"]) for sign, runs in result.runs.items() if sign != result.polarity]
    said += [f"{_way(sign).capitalize()}: {_fate(run)}." for sign, run in others]
    if len(result.runs) == 1:
        said.append("Only this polarity of the motion was analysed; the reverse may be worse.")
    return " ".join(said)


def _fate(run: History, *, capital: bool = False) -> str:
    if run.unknown:
        said = f"unknown beyond {run.known_to:.4g} s, when {why_unknown(run)}"
    elif run.fell:
        said = f"yes, it overturns, {SENSE[Direction(run.fell_to)]} at {run.overturning_time:.2f} s"
    elif run.lifted:
        said = f"no, it rocks to {_share(run.peak_ratio)} the {run.reference}"
    else:
        said = f"no, it {names.NO_UPLIFT}"
    return said[0].upper() + said[1:] if capital else said


def _way(polarity: int) -> str:
    return "with the motion as given" if polarity == 1 else "with the motion reversed"


def _closeness(content: Assessment, result: MotionResult) -> str:
    best, found = result.histories["nonlinear"], result.margin
    said = []
    if best.peak_ratio > 0:
        side = Direction.POSITIVE if best.furthest == best.peak_positive else Direction.NEGATIVE
        statics = content.structure.statics[0 if side > 0 else 1]
        until = f" up to {best.known_to:.4g} s" if best.unknown else ""
        said.append(
            f"Its largest rotation{until} is {degrees(best.furthest):.3g}° {SENSE[side]}. "
            f"{_what_that_is(best, statics)}"
        )
        if best.unknown:
            said.append("It may rotate further afterwards.")
        if best.peak_ratio > 1:
            said.append("It exceeds this rotation and is brought back only by the subsequent ground motion.")
    said.append(neighbours_in_words(result.neighbours[result.polarity]))
    said.append(in_words(found, result.pga_of_ground))
    return " ".join(said)


def _what_that_is(run: History, statics: Statics) -> str:
    """Return a sentence that compares the largest rotation with the critical rotation or the kinematic limit."""
    share = f"That is {_share(run.peak_ratio)} the {run.reference}, {degrees(statics.reference):.3g}°"
    if statics.phi_cr is None:
        return (
            f"{share}, at which the motion would end. Up to that rotation the structure is pulled back: it has no "
            "critical rotation."
        )
    if statics.why_no_block is None and run.reference == "critical rotation":
        return f"{share}, beyond which its weight pushes it over instead of back."
    return f"{share}, beyond which it is pushed over instead of back."


def _least(content: Assessment) -> float:
    """Return the smaller uplift acceleration of both directions, over g."""
    return min(side.lambda_ for side in content.structure.statics)


def _end(run: History) -> str:
    """Return in plain words the rotation with which a peak is compared."""
    if run.reference == "critical rotation":
        return "the critical rotation, beyond which it would fall"
    return "the kinematic limit, at which its motion would end"


def _trusted(content: Assessment, result: MotionResult) -> str:
    runs = result.histories
    if len(runs) == 1:
        return f"The nonlinear model; no other is available. {why_alone(content)}"
    best = runs["nonlinear"]
    if best.unknown:
        return (
            f"The nonlinear model until {best.known_to:.4g} s, and none beyond: the equivalent blocks have no joints, "
            "and cannot tell the outcome."
        )
    itself = "The nonlinear model simulates the structure without linearisation; its results are quoted here."
    called = {name: f"the {model}" for name, model in MODELS.items()}
    grades = {each.grade for each in agreements(runs).values()}
    if disagree(runs):
        first = "No single one: the models disagree on whether it overturns."
    elif len({run.fell for run in runs.values()}) == 1 and best.fell:
        first = "By all three models, it overturns."
    elif grades == {Grade.AGREES}:
        lifted = "the three models agree closely" if best.peak_ratio else f"by all three models it {names.NO_UPLIFT}"
        first = f"Any of them: {lifted}."
    else:
        first = "The nonlinear model."
        itself = "It simulates the structure without linearisation; its results are quoted here."
    said = [first, itself, *(text[0].upper() + text[1:] for text in blocks_in_words(runs, agreements(runs), called))]
    if disagree(runs):
        said.append("Run weaker and stronger motions as well before relying on any of them.")
    return " ".join(said)


def why_alone(content: Assessment) -> str:
    """Return sentences on why there are no linear models."""
    why = content.structure.why_no_block or content.structure.misleading or ""
    why = why.removeprefix(f"{content.name}: ")
    return f"{why[0].upper()}{why[1:]}."


def trust_of_block(content: Assessment) -> str:
    """Return the error of the equivalent block in words, or why there is none."""
    if content.asked:
        return trust(content.curves, content.asked)
    none = "No equivalent block exists here, so there is no error to report"
    return f"{'The error of the equivalent block is left out' if content.has_block else none}: {content.no_error}."


def _doubts(result: MotionResult) -> list[str]:
    said = [f"{each.text[0].upper()}{each.text[1:]}." for each in result.doubts]
    contact = result.contacts.get(result.polarity)
    best = result.histories["nonlinear"]
    if best.unknown:
        said_next = REMEDIES[remedy(best)]
        said.append(
            f"The outcome is unknown after {best.known_to:.4g} s (see Joints): the structure may overturn. "
            f"{said_next[0].upper()}{said_next[1:]}."
        )
    elif contact is not None and not contact.stands:
        said.append("Its joints do not hold under this motion (see Joints): the result is not valid beyond that time.")
    if result.close:
        said.append("The result is close to the other outcome. Do not base a decision on this computation alone.")
    if any(run.still_rocking for run in result.histories.values()):
        said.append("A model is still rocking long after the motion has ended; it is certain not to overturn.")
    factor = abs(result.given.factor)
    if factor == 0:
        said.append("The motion was scaled by 0, so this result is meaningless.")
    elif factor != 1:
        more = " Motions scaled by large factors are unlike any recorded." if result.scaled_much else ""
        said.append(f"The motion was scaled by {result.given.factor:.4g}.{more}")
    return [text.replace("?.", "?") for text in said]


def _overturns(result: MotionResult) -> bool:
    return result.histories["nonlinear"].fell


def _worst_ratio(result: MotionResult) -> float:
    best = result.histories["nonlinear"]
    return 0.0 if best.fell or best.unknown else best.peak_ratio


def alone(result: MotionResult) -> str:
    """Return a sentence on the response to the best-fitting pulse of a motion alone."""
    ratio = result.alone
    if ratio is None:
        return "No pulse was found in this motion."
    pulse = f"The {result.fits[0].pulse.title} of the table, without the rest of the motion,"
    if isnan(ratio) and not result.alone_unknown:
        return f"{pulse} overturns the structure."
    if ratio == 0:
        return f"{pulse} does not cause uplift."
    of = result.histories["nonlinear"].reference
    if result.alone_unknown:
        return f"{pulse} has an unknown outcome, as a joint opens or slides that the model keeps closed."
    return f"{pulse} rocks the structure to {_share(ratio)} its {of}."


def _ground(content: Assessment, lambda_: float) -> str:
    """Format a horizontal ground acceleration in g, from a multiple of the structure's own gravity."""
    return f"{lambda_ * content.mechanism.gravity / STANDARD_GRAVITY:.3g} g"


def _share(ratio: float) -> str:
    """Return a ratio as words before a noun: "50 % of", "12 times"."""
    return f"{100 * ratio:.3g} % of" if ratio < 10 else f"{ratio:.3g} times"


def restitution(content: Assessment) -> str:
    """Return a sentence on the restitution that the histories used, and on its source."""
    return restitution_used(content.structure).replace("eta", "η")


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
