"""View of a report: its answers in sentences, and all its content as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees, isclose

from rocking_cli import names
from rocking_cli.core import Direction
from rocking_cli.core.advice import Grade
from rocking_cli.core.equivalence import EQUAL_DIRECTIONS
from rocking_cli.core.mechanism import doubts as doubts_about_size
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import disagree
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.questions.equiv.view import sides_of
from rocking_cli.questions.error.view import trust
from rocking_cli.questions.margin.view import in_words, margin_data
from rocking_cli.questions.report.study import Assessment, MotionResult
from rocking_cli.studies.conclusion import worst
from rocking_cli.studies.movements import Watched
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.verification.results import Verification
from rocking_cli.views import processing, verification
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.column import Column, of, only_shown, table_of
from rocking_cli.views.conclusion import (
    POLARITIES,
    conclusion_data,
    counted,
    does,
    headline,
    next_in_words,
    of_verification,
)
from rocking_cli.views.contact import contact_words
from rocking_cli.views.neighbours import neighbour_columns, neighbours_in_words
from rocking_cli.views.response import fit_data, runs_data
from rocking_cli.views.restitution import restitution_source
from rocking_cli.views.verdict import NO_JOINTS, SENSE, blocks_in_words, ends, joints_in_words, why_unknown
from rocking_cli.views.view import Table, View

MODELS: Mapping[ModelName, str] = {
    "nonlinear": "nonlinear model",
    "linear1": "equivalent block with κ₁",
    "linear2": "equivalent block with κ₂",
}


@dataclass(frozen=True)
class MotionAnswers:
    """The answers for one ground motion.

    Parameters
    ----------
    name : str
        Name of the motion.
    headline : str
        The outcome in a few words.
    answers : mapping of str to str
        The answer to each question of the reader.
    doubts : tuple of str
        What is doubtful about the motion and the result.
    """

    name: str
    headline: str
    answers: Mapping[str, str]
    doubts: tuple[str, ...]


def view(content: Assessment, verified: Verification | None = None) -> View:
    """Show a report: its answer in a sentence, and all its content as plain data."""
    watched, answer = Watched(content.mechanism), in_a_sentence(content, verified)
    ends = [
        end for end in (verified.conclusion if verified is not None else None, content.conclusion) if end is not None
    ]
    data = {
        "structure": {
            "mechanism": content.mechanism.mechanism,
            "name": content.name,
            "file": content.file.name,
            "sha256": content.file.checksum,
        },
        "answer": answer,
        "conclusion": conclusion_data(worst(ends)) if ends else None,
        "doubts": doubts(content),
        "parameters": {side.direction.label: side.parameters for side in sides_of(content.structure)},
        "no_block": content.structure.why_no_block,
        "motions": [
            {
                "name": each.given.motion.name,
                "file": each.file.name if each.file else None,
                "sha256": each.file.checksum if each.file else None,
                "factor": each.given.factor,
                "pga": each.pga_of_ground,
                **processing.data(each.motion),
                "headline": verdict.headline,
                "unknown": each.unknown,
                "answers": dict(verdict.answers),
                "doubts": list(verdict.doubts),
                **runs_data(each, watched),
                "polarity": each.polarity,
                "margin": margin_data(each.margin),
                "pulses": [fit_data(fit) for fit in each.fits],
            }
            for each, verdict in zip(content.results, verdicts(content), strict=True)
        ],
        "linearisation": trust_of_block(content),
        **({"verification": verification.data(verified)} if verified is not None else {}),
        **content.title.known,
        "command": content.title.command,
        "date": content.title.date,
        "versions": dict(content.versions),
    }
    return View(data, [answer])


def verdicts(content: Assessment) -> list[MotionAnswers]:
    """Return the answers for each ground motion."""
    return [_verdict(content, each) for each in content.results]


def in_a_sentence(content: Assessment, verified: Verification | None = None) -> str:
    """Return the answer of the whole report: of its verification, if any, and of its ground motions."""
    sentences = [str(each) for each in of_verification(verified)] if verified is not None else []
    if not content.results:
        sentences.append(
            f"{content.name} starts to rock at a horizontal ground acceleration of {_ground(content, _least(content))}."
        )
        if verified is None:
            sentences.append(
                "No ground motion was given, so this report does not say whether an earthquake would overturn it."
            )
        return " ".join(sentences)
    sentences.append(f"{content.name}: {counted([each.conclusion for each in content.results], over(content))}")
    if unknown := [each for each in content.results if each.unknown]:
        then = "There, joints open or slide that the model keeps closed"
        if len(content.results) == 1:
            then = f"Then {why_unknown(unknown[0].histories['nonlinear'])}"
        sentences.append(f"{then}: the structure may overturn.")
    falls = [each for each in content.results if each.histories["nonlinear"].fell]
    if all(each.close for each in falls) if falls else any(each.close for each in content.results):
        sentences.append('The result is close to the other outcome: see "How close is that?" below.')
    contacts = [contact for each in content.results for contact in each.contacts.values()]
    if any(not contact.holds and not contact.followed for contact in contacts):
        sentences.append("But its joints do not hold: see below from which time the result is no longer valid.")
    if any(contact.assumed_friction is not None for contact in contacts):
        sentences.append("The result assumes that nothing slides: see below how much friction this requires.")
    return " ".join(sentences)


def over(content: Assessment) -> str:
    """Return what a peak is divided by, in words."""
    return names.peaks_over([side.phi_cr is None for side in content.structure.statics])


def overview(content: Assessment, over: str) -> Table:
    """Return a table with a row for each motion; `over` is what a peak is divided by."""

    def near(each: MotionResult) -> Neighbours:
        return each.neighbours[each.polarity]

    def peak(each: MotionResult) -> str:
        run = each.histories["nonlinear"]
        return run.words if run.fell or run.unknown else f"{run.peak_ratio:.3g}"

    columns: list[Column[MotionResult]] = [
        only_shown("ground motion", of("given.motion.name"), text=True),
        only_shown("PGA [g]", of("pga_of_ground"), "{:.3g}".format),
        only_shown(f"peak {over}", peak),
        *neighbour_columns(near, doubtful=any(near(each).unknown for each in content.results)),
    ]
    return table_of("All ground motions", columns, content.results)


def doubts(content: Assessment) -> list[str]:
    """Return what to check about the structure and the method, under any motion."""
    sentences = []
    if not content.mechanism.verified:
        sentences.append(
            f"The mechanism {content.mechanism.mechanism} has not been verified: check its results independently."
        )
    sentences += cautions_of(content.mechanism)
    sentences += [
        f"Check the sizes and their units: {doubt}{'' if doubt.endswith('?') else '.'}"
        for doubt in doubts_about_size(content.mechanism)
    ]
    etas = content.structure.etas
    is_given = restitution_source(content.mechanism) == "given"
    if not content.mechanism.rocks_both_ways:
        sentences.append(
            "The supports that it leans on are assumed not to move. "
            + ("" if is_given else "The rebound from them was computed for a sequence of impacts, not measured.")
        )
    elif min(etas) <= 0:
        sentences.append(
            "Time histories and the overturning map are left out: they need a measured restitution in the file."
        )
    elif not is_given:
        sentences.append(
            f"The coefficient of restitution (η = {min(etas):.3g}) was computed for rigid bodies that neither slide "
            "nor bounce. It was not measured, and the response depends on it."
        )
    if any(tie.is_elastic for tie in content.mechanism.ties or []):
        sentences.append(
            "Ties are assumed elastic: they do not yield, break or pull out of their anchorages. Check the largest "
            "tie forces in this report against the capacity of the ties and their anchorages."
        )
    if content.structure.misleading:
        sentences.append(
            f"{content.structure.misleading[0].upper()}{content.structure.misleading[1:]}: they are left out."
        )
    edges = "without crushing at their edges" if content.mechanism.crushing is None else "on pivots moved inwards"
    sentences.append(
        f"The bodies are assumed rigid, on rigid ground, in one plane, without sliding and {edges}; the section on "
        "joints shows the friction and forces that this requires. Vertical ground motion is not included. Worn edges "
        "and soft ground lower the resistance."
    )
    if content.mechanism.interlock is not None:
        sentences.append(
            "The friction of crossing walls is assumed constant. Blocks that have slid by their overlap of "
            f"{1000 * content.mechanism.interlock.overlap:.0f} mm come apart; no result is valid beyond that."
        )
    if any(each.histories["nonlinear"].check is None for each in content.results):
        sentences.append(f"The joints of this mechanism are not checked: {content.mechanism.unchecked}.")
    return sentences


def _verdict(content: Assessment, result: MotionResult) -> MotionAnswers:
    answers = {
        "Will it uplift?": _uplift(content, result),
        "Will it overturn?": _overturning(result),
        "How close is that?": _closeness(content, result),
        "Which model to trust?": _trusted(content, result),
    }
    run, contact = result.histories["nonlinear"], result.contacts[result.polarity]
    if demands := contact_words(contact, content.mechanism):  # empty if the structure does not rock
        joints = joints_in_words(run, contact.assumed_friction).replace("`", "") if run.check is not None else ""
        answers["Do its joints hold?"] = f"{joints} {demands}".lstrip()
    close = " (close)" if result.close else ""
    return MotionAnswers(result.given.motion.name, f"{headline(result.conclusion)}{close}", answers, _doubts(result))


def _uplift(content: Assessment, result: MotionResult) -> str:
    # PGA of the motion at the base of the structure, which may stand on a floor.
    best, pga = result.histories["nonlinear"], result.measured.pga
    least = _least(content)
    one, other = (side.lambda_ for side in content.structure.statics)
    both = "" if isclose(one, other, rel_tol=EQUAL_DIRECTIONS) else " in its weaker direction"
    needed = f"A ground acceleration of {_ground(content, least)} is enough to uplift it{both}"
    if best.uplift_time >= 0:
        return f"Yes, first at {best.uplift_time:.2f} s. {needed}; this motion reaches {pga:.3g} g."
    but = f"this motion reaches {pga:.3g} g"
    if pga >= least * content.mechanism.gravity / STANDARD_GRAVITY:
        but = f"this motion, of {pga:.3g} g, reaches it only in the other direction"
    factor = result.margin.uplift
    more = f" The motion would have to be {factor:.3g} times as strong to cause uplift." if factor is not None else ""
    no = f"Not up to {best.known_to:.4g} s, beyond which it is unknown" if best.unknown else "No"
    return f"{no}. {needed}; {but}.{more}"


def _overturning(result: MotionResult) -> str:
    sentences = []
    for sign in sorted(result.runs, key=lambda sign: sign != result.polarity):
        run = result.runs[sign]["nonlinear"]
        at = f" at {run.overturning_time:.2f} s" if run.fell else f" after {run.known_to:.4g} s" if run.unknown else ""
        sentences.append(f"With the motion {POLARITIES[sign]}, it {ends(run)}{at}.")
    if len(sentences) == 1:
        sentences.append("Only this polarity of the motion was analysed; the reverse may be worse.")
    return " ".join(sentences)


def _closeness(content: Assessment, result: MotionResult) -> str:
    best, sentences = result.histories["nonlinear"], []
    if best.peak_ratio > 0:
        side = Direction.POSITIVE if best.furthest == best.peak_positive else Direction.NEGATIVE
        statics = content.structure.statics[0 if side > 0 else 1]
        until = f" up to {best.known_to:.4g} s" if best.unknown else ""
        ratio = f"{100 * best.peak_ratio:.3g} % of" if best.peak_ratio < 10 else f"{best.peak_ratio:.3g} times"
        beyond = "beyond which it is pushed over instead of back"
        if statics.phi_cr is None:
            beyond = "at which the motion would end, and up to which it is pulled back: it has no critical rotation"
        sentences.append(
            f"Its largest rotation{until} is {degrees(best.furthest):.3g}° {SENSE[side]}. That is {ratio} the "
            f"{best.reference}, {degrees(statics.reference):.3g}°, {beyond}."
        )
        if best.unknown:
            sentences.append("It may rotate further afterwards.")
        if best.peak_ratio > 1:
            sentences.append("It exceeds this rotation and is brought back only by the subsequent ground motion.")
    neighbours = neighbours_in_words(result.neighbours[result.polarity])
    return " ".join([*sentences, neighbours, in_words(result.margin)])


def _trusted(content: Assessment, result: MotionResult) -> str:
    runs, agreed = result.histories, result.agreement[result.polarity]
    if len(runs) == 1:
        return f"The nonlinear model; no other is available. {why_alone(content)}"
    if runs["nonlinear"].unknown:
        return f"The nonlinear model until {runs['nonlinear'].known_to:.4g} s, and none beyond. {NO_JOINTS}"
    sentences = ["The nonlinear model, which simulates the structure without linearisation."]
    if disagree(runs):
        sentences = ["No single one: the models disagree on whether it overturns."]
    elif all(each.grade is Grade.AGREES for each in agreed.values()):
        sentences = ["Any of them: the three models agree closely."]
    of_blocks = blocks_in_words(runs, agreed, {name: f"the {model}" for name, model in MODELS.items()})
    sentences += [text[0].upper() + text[1:] for text in of_blocks]
    if disagree(runs):
        sentences.append("Run weaker and stronger motions as well before relying on any of them.")
    return " ".join(sentences)


def why_alone(content: Assessment) -> str:
    """Return sentences on why there are no linear models."""
    why = (content.structure.why_no_block or content.structure.misleading or "").removeprefix(f"{content.name}: ")
    return f"{why[0].upper()}{why[1:]}."


def trust_of_block(content: Assessment) -> str:
    """Return the error of the equivalent block in words, or why there is none."""
    if content.asked:
        return trust(content.curves, content.asked)
    none = "No equivalent block exists here, so there is no error to report"
    return f"{'The error of the equivalent block is left out' if content.has_block else none}: {content.no_error}."


def _doubts(result: MotionResult) -> tuple[str, ...]:
    sentences = [f"{each.text[0].upper()}{each.text[1:]}.".replace("?.", "?") for each in result.doubts]
    contact, factor = result.contacts[result.polarity], abs(result.given.factor)
    if result.unknown:
        sentences.append(
            f"The outcome is {headline(result.conclusion)} (see Joints): the structure may overturn. "
            f"{next_in_words(result.conclusion)}".replace("`", "")
        )
    elif not contact.stands:
        sentences.append(
            "Its joints do not hold under this motion (see Joints): the result is not valid beyond that time."
        )
    if result.close:
        sentences.append("The result is close to the other outcome. Do not base a decision on this computation alone.")
    if any(run.still_rocking for run in result.histories.values()):
        sentences.append("A model is still rocking long after the motion has ended; it is certain not to overturn.")
    if factor == 0:
        sentences.append("The motion was scaled by 0, so this result is meaningless.")
    elif factor != 1:
        more = " Motions scaled by large factors are unlike any recorded." if result.scaled_much else ""
        sentences.append(f"The motion was scaled by {result.given.factor:.4g}.{more}")
    return tuple(sentences)


def alone(result: MotionResult) -> str:
    """Return a sentence on the response to the best-fitting pulse of a motion alone."""
    if result.to_pulse is None:
        return "No pulse was found in this motion."
    over = names.peaks_over(result.histories["nonlinear"].ends_at_limit)
    return f"Under the {result.fits[0].pulse.title} of the table alone, {does(result.to_pulse.conclusion, over)}."


def _least(content: Assessment) -> float:
    """Return the smaller uplift acceleration of both directions, over g."""
    return min(side.lambda_ for side in content.structure.statics)


def _ground(content: Assessment, lambda_: float) -> str:
    """Format a horizontal ground acceleration in g, from a multiple of the structure's own gravity."""
    return f"{lambda_ * content.mechanism.gravity / STANDARD_GRAVITY:.3g} g"
