"""View of a report: the values of its templates, its answers in sentences, and all its content as plain data."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import inf, isclose, isnan, pi
from typing import Any, NamedTuple

from markupsafe import Markup

from rocking_cli.core.equivalence import EQUAL_DIRECTIONS
from rocking_cli.core.hung.element import ConstantForce, Element, SpringBed, SteelBar, Stretched
from rocking_cli.core.plausible import doubts as doubts_about_size
from rocking_cli.dynamics.verdict import disagree
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import peaks_over
from rocking_cli.questions.equiv.view import is_symmetric, kappa_in_words, sentence, sides_of
from rocking_cli.questions.error.view import trust
from rocking_cli.questions.margin.view import in_words, margin_data
from rocking_cli.questions.report.study import Assessment, MotionResult
from rocking_cli.studies.conclusion import are_alike, worst
from rocking_cli.studies.movements import Movements, Watched, largest
from rocking_cli.verification.results import Verification
from rocking_cli.views import verification
from rocking_cli.views.cautions import before_rocking, cautions_of
from rocking_cli.views.conclusion import (
    NEXT_STEPS,
    conclusion_data,
    counted,
    does,
    headline,
    next_in_words,
    of_verification,
)
from rocking_cli.views.neighbours import deviations, neighbours_in_words
from rocking_cli.views.response import fit_data, runs_data
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.sheet.document import Sentence, SheetPart, guarded, sections
from rocking_cli.views.sheet.language import Language, plain, texts_of
from rocking_cli.views.verdict import blocks_in_words, contact_words, ends, joints_in_words, why_unknown
from rocking_cli.views.view import View, force_unit, processing_data

PACKAGE = "rocking_cli.questions.report"
SYMBOLS = {
    "phi_cr": "φ_[cr]", "D_cr": "D_[cr]", "lambda_lin": "λ_[lin]", "lambda": "λ", "kappa1": "κ_[1]", "kappa2": "κ_[2]",
    "eta": "η", "phi": "φ", "theta": "θ",
}  # fmt: skip
SYMBOL = re.compile(rf"\b({'|'.join(SYMBOLS)})\b")


def language_of(key: str, *, is_plain: bool = False) -> Language:
    """Return a language with the texts of a report."""
    return Language(key, texts_of(PACKAGE, key), is_plain)


def printed(text: str) -> Markup:
    """Return a sentence of another view with its symbols as in print."""
    return guarded(SYMBOL.sub(lambda match: SYMBOLS[match[1]], plain(text, keep_code=True)))


class MotionWords(NamedTuple):
    """What a report says of one ground motion.

    Parameters
    ----------
    name, key : str
        Name of the motion, and anchor of its section.
    result : MotionResult
        The response.
    moves : mapping of str to Movements
        Peaks by model, in the polarity that governs.
    worst : Movements
        The larger peaks of the polarities, by the nonlinear model.
    disagree : bool
        Whether the models disagree on the outcome.
    english : mapping of str to object
        Sentences that the other commands print of it; empty in another language, whose templates have their own.
    """

    name: str
    key: str
    result: MotionResult
    moves: Mapping[str, Movements]
    worst: Movements
    disagree: bool
    english: Mapping[str, Any]


def context(content: Assessment, say: Language, verified: Verification | None = None) -> dict[str, Any]:
    """Return the values of the templates of a report."""
    mechanism, structure = content.mechanism, content.structure
    is_english, sides = say.key == "en", sides_of(structure)
    motions = _motions(content, is_english=is_english)
    free = [side.phi_cr is None for side in structure.statics]
    contacts = [contact for each in content.results for contact in each.contacts.values()]
    falls = [each for each in content.results if each.histories["nonlinear"].fell]
    strained = [(tie.force, tie.name, each.name) for each in motions for tie in each.worst.ties if not isnan(tie.force)]
    lambdas = [side.lambda_ for side in structure.statics]
    outcomes = [each.conclusion for each in content.results]
    governs = worst(outcomes) if outcomes else None
    hung = mechanism.hung if mechanism.attached else None
    steel = verified is not None and any(each.is_steel for each in mechanism.ties or [])
    strong = mechanism.at_strength() if steel else None
    why_alone = (structure.why_no_block or structure.misleading or "").removeprefix(f"{content.name}: ")
    early = [mechanism.own_caution()] * (mechanism.weaker_side() is not None) + before_rocking(mechanism)
    steps = {key: guarded(f"{_capital(say.texts.get(f'next_{key}', text))}.") for key, text in NEXT_STEPS.items()}
    cautions = map(printed, cautions_of(mechanism)) if is_english else map(guarded, cautions_of(mechanism, say))
    return {
        "language": say, "content": content, "verified": verified, "motions": motions,
        "english": _english(content) if is_english else {},
        "sides": sides[:1] if is_symmetric(structure) else sides,
        "reference": "limit" if all(free) else "mixed" if any(free) else "critical",
        "least_uplift": min(lambdas) * mechanism.gravity / STANDARD_GRAVITY,
        "strong": None if strong is None else min(map(strong.uplift, strong.directions)),
        "directions_differ": not isclose(*lambdas, rel_tol=EQUAL_DIRECTIONS),
        "unknown": [each for each in motions if each.result.unknown],
        "overturning": [each for each in motions if any(isnan(point.horizontal) for point in each.worst.points)],
        "close": all(each.close for each in falls) if falls else any(each.close for each in content.results),
        "decisive": all(each.decisive for each in content.results if each.close),
        "on_floor": any(each.motion.ground is not None for each in content.results),
        "not_holding": any(not contact.holds and not contact.followed for contact in contacts),
        "sliding": any(contact.assumed_friction is not None for contact in contacts),
        "governs": governs,
        "alike": [each for each in motions if governs is not None and are_alike(each.result.conclusion, governs)],
        "restitution_by": structure.restitution_source,
        "force": dict(zip(("per", "unit"), force_unit(mechanism), strict=True)),
        "step_texts": steps,
        "sizes": doubts_about_size(mechanism),
        "why_alone": "" if is_english else guarded(say.recognised("reason", why_alone)),
        "early": [printed(each) if is_english else guarded(say.recognised("caution", each)) for each in early],
        "structure_cautions": [*cautions],
        "elastic": any(tie.is_elastic for tie in mechanism.ties or []),
        "infinite": inf, "degree": 180 / pi,
        "strongest": max(strained, key=lambda each: abs(each[0]), default=None),
        "masses": [] if hung is None else hung.masses,
        "forces": [] if hung is None else [each for each in hung.elements if isinstance(each, ConstantForce)],
        "ties": [] if hung is None else [*map(_tie, hung.ties)],
    }  # fmt: skip


def _motions(content: Assessment, *, is_english: bool) -> list[MotionWords]:
    watched, motions = Watched(content.mechanism), []
    for k, each in enumerate(content.results):
        moves = {str(name): watched.peaks(run) for name, run in each.histories.items()}
        most = largest([watched.peaks(runs["nonlinear"]) for runs in each.runs.values()])
        english = _english_of(content, each) if is_english else {}
        name = each.given.motion.name
        motions.append(MotionWords(name, f"under-{k}", each, moves, most, disagree(each.histories), english))
    return motions


def _tie(tie: Element) -> dict[str, Any]:
    """Return a tie as a report lists it; it acts in "tension", "compression", "both", or as a constant "force"."""
    if isinstance(tie, SpringBed):
        return {
            "name": tie.name, "spots": (tie.start, tie.end), "along": True, "number": 1, "sense": "both",
            "prestress": 0.0, "stiffness": tie.count * tie.stiffness, "strength": None,
        }  # fmt: skip
    assert isinstance(tie, Stretched)  # the only other kind of element
    prestress, stiffness = tie.at_rest
    return {
        "name": tie.name, "spots": tie.spots, "along": False, "number": tie.count,
        "sense": (tie.only or "both") if stiffness else "force", "prestress": prestress, "stiffness": stiffness,
        "strength": tie.strength if isinstance(tie, SteelBar) else None,
    }  # fmt: skip


def _over(content: Assessment) -> str:
    """Return the reference of the peaks."""
    return peaks_over([side.phi_cr is None for side in content.structure.statics])


def _headline(content: Assessment, result: MotionResult) -> str:
    return f"{headline(result.conclusion, _over(content))}{' (close)' if result.close else ''}"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _english(content: Assessment) -> dict[str, Any]:
    """Return sentences on a structure that other commands print."""
    structure, mechanism = content.structure, content.mechanism
    why_alone = (structure.why_no_block or structure.misleading or "").removeprefix(f"{content.name}: ")
    texts = {
        "why_alone": f"{_capital(why_alone)}.",
        "misleading": structure.misleading or "",
        "no_error": content.no_error,
        "unchecked": mechanism.unchecked,
        "restitution": restitution_used(structure),
    }
    if content.results:
        texts["counted"] = counted([each.conclusion for each in content.results], _over(content))
        texts["deviations"] = deviations(content.results[0].margin.around)
    advice = [kappa_in_words(side.block) if side.block is not None else sentence(side) for side in sides_of(structure)]
    sizes = [each if each.endswith("?") else f"{each}." for each in doubts_about_size(mechanism)]
    return {
        **{key: printed(text) for key, text in texts.items()},
        "sizes": [*map(printed, sizes)],
        "advice": [*map(printed, advice)],
    }


def _english_of(content: Assessment, result: MotionResult) -> dict[str, Any]:
    """Return sentences on a ground motion that other commands print."""
    run, contact = result.histories["nonlinear"], result.contacts[result.polarity]
    called = {name: f"the equivalent block with kappa{name[-1]}" for name in result.histories}
    blocks = blocks_in_words(result.histories, result.agreement[result.polarity], called)
    hold = joints_in_words(run, contact.assumed_friction) if run.check is not None else ""
    needs = "" if isnan(contact.friction_needed) else contact_words(contact, content.mechanism)
    texts = {
        "headline": _headline(content, result),
        "why_unknown": why_unknown(run) or "",
        "neighbours": neighbours_in_words(result.neighbours[result.polarity]),
        "margin": in_words(result.margin),
        "blocks": " ".join(map(_capital, blocks)),
        "joints": f"{hold} {needs}".strip(),
        "next": next_in_words(result.conclusion),
        "pulse": "" if result.to_pulse is None else does(result.to_pulse.conclusion, _over(content)),
    }
    return {
        **{key: printed(text) for key, text in texts.items()},
        "ends": {sign: printed(ends(runs["nonlinear"])) for sign, runs in result.runs.items()},
        "doubts": [printed(f"{_capital(doubt.text)}.".replace("?.", "?")) for doubt in result.doubts],
    }


def view(content: Assessment, verified: Verification | None = None, language: str = "en") -> View:
    """Show a report: its answer in a sentence, and all its content as plain data."""
    say, watched = language_of("en", is_plain=True), Watched(content.mechanism)
    values = context(content, say, verified)

    def sentences(name: str, **more: Any) -> list[str]:
        return _sentences(sections(say, PACKAGE, name, {**values, **more}))

    motions = []
    for each in values["motions"]:
        result: MotionResult = each.result
        of_motion = {"each": each, "result": result, "key": ""}
        answers = sections(say, PACKAGE, "answers", {**values, **of_motion})
        motions.append(
            {
                "name": each.name,
                "file": result.file.name if result.file else None,
                "sha256": result.file.checksum if result.file else None,
                "factor": result.given.factor,
                "pga_g": result.pga_of_ground,
                **processing_data(result.motion),
                "headline": _headline(content, result),
                "unknown": result.unknown,
                "answers": {part.heading: " ".join(_sentences([part])) for part in answers},
                "doubts": sentences("checks", **of_motion),
                **runs_data(result, watched),
                "polarity": result.polarity,
                "margin": margin_data(result.margin),
                "pulses": [fit_data(fit) for fit in result.fits],
            }
        )
    both = (verified.conclusion if verified is not None else None, content.conclusion)
    outcomes = [end for end in both if end is not None]
    data = {
        "structure": {
            "mechanism": content.mechanism.mechanism,
            "name": content.name,
            "file": content.file.name,
            "sha256": content.file.checksum,
        },
        "answer": _answer(verified, values),
        "conclusion": conclusion_data(worst(outcomes)) if outcomes else None,
        "doubts": sentences("doubts"),
        "parameters": {side.direction.label: side.parameters for side in sides_of(content.structure)},
        "no_block": content.structure.why_no_block,
        "motions": motions,
        "linearisation": trust_of_block(content),
        **({"verification": verification.data(verified)} if verified is not None else {}),
        **content.title.known,
        "command": content.title.command,
        "date": content.title.date,
        "versions": dict(content.versions),
    }
    if language != "en":
        values = context(content, language_of(language, is_plain=True), verified)
    return View(data, [_answer(verified, values)])


def _answer(verified: Verification | None, values: Mapping[str, Any]) -> str:
    """Return the answer of a report in sentences, in the language of the values of its templates."""
    say = values["language"]
    answer = _sentences(sections(say, PACKAGE, "answer", values))
    if verified is None:
        return " ".join(answer)
    by_code = verification.showing(verified).in_language(say.key).say
    return " ".join([*of_verification(verified, by_code), *answer])


def _sentences(parts: list[SheetPart]) -> list[str]:
    return [item.text for part in parts for item in part.items if isinstance(item, Sentence)]


def trust_of_block(content: Assessment) -> str:
    """Return the error of the equivalent block in words, or why there is none."""
    if content.asked:
        return trust(content.curves, content.asked)
    none = "No equivalent block exists here, so there is no error to report"
    return f"{'The error of the equivalent block is left out' if content.has_block else none}: {content.no_error}."
