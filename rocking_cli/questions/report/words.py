"""The values that the templates of a report write out, and the sentences of other views in English."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from math import degrees, inf, isclose, isnan
from typing import Any, NamedTuple

from markupsafe import Markup

from rocking_cli.core import Mechanism
from rocking_cli.core.equivalence import EQUAL_DIRECTIONS, Grade
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.hung.element import ConstantForce, Element, SpringBed, SteelBar, Stretched
from rocking_cli.core.plausible import doubts as doubts_about_size
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.verdict import disagree
from rocking_cli.excitation.base import STANDARD_GRAVITY, Doubt
from rocking_cli.names import peaks_over, percent
from rocking_cli.questions.equiv.view import EquivalentSide, is_symmetric, kappa_in_words, sentence, sides_of
from rocking_cli.questions.margin.view import in_words
from rocking_cli.questions.report.study import Assessment, MotionResult
from rocking_cli.studies.conclusion import Conclusion, are_alike, worst
from rocking_cli.studies.movements import Movements, Watched, largest
from rocking_cli.text import in_short
from rocking_cli.verification.results import MINUS, Verification
from rocking_cli.views.cautions import before_rocking, cautions_of
from rocking_cli.views.conclusion import NEXT_STEPS, counted, does, headline, next_in_words
from rocking_cli.views.contact import contact_words
from rocking_cli.views.neighbours import deviations, neighbours_in_words
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.sheet.language import Language, plain
from rocking_cli.views.sheet.template import guarded
from rocking_cli.views.verdict import blocks_in_words, ends, joints_in_words, why_unknown
from rocking_cli.views.view import force_unit

PACKAGE = "rocking_cli.questions.report"
SYMBOLS = {
    "phi_cr": "φ_[cr]", "D_cr": "D_[cr]", "lambda_lin": "λ_[lin]", "lambda": "λ", "kappa1": "κ_[1]", "kappa2": "κ_[2]",
    "eta": "η", "phi": "φ", "theta": "θ",
}  # fmt: skip
SYMBOL = re.compile(rf"\b({'|'.join(SYMBOLS)})\b")


def printed(text: str) -> Markup:
    """Return a sentence of another view with its symbols as in print."""
    return guarded(SYMBOL.sub(lambda match: SYMBOLS[match[1]], plain(text, keep_code=True)))


class MotionWords(NamedTuple):
    """What a report says of one ground motion: its name and anchor, the result, and the movements of the structure.

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
    """

    name: str
    key: str
    result: MotionResult
    moves: Mapping[str, Movements]
    worst: Movements


class TieWords(NamedTuple):
    """A tie as a report lists it; `sense` is "tension", "compression", "both" or "force"."""

    name: str
    spots: Sequence[Spot]
    along: bool
    number: float
    sense: str
    stiffness: float
    prestress: float
    strength: float | None = None

    @classmethod
    def of(cls, tie: Element) -> TieWords:
        """Return the words of a tie."""
        if isinstance(tie, SpringBed):
            return cls(tie.name, (tie.start, tie.end), True, 1, "both", tie.count * tie.stiffness, 0.0)
        assert isinstance(tie, Stretched)  # the only other kind of element
        prestress, stiffness = tie.at_rest
        sense = (tie.only or "both") if stiffness else "force"
        strength = tie.strength if isinstance(tie, SteelBar) else None
        return cls(tie.name, tie.spots, False, tie.count, sense, stiffness, prestress, strength)


@dataclass(frozen=True)
class English:
    """Sentences of other views about a report, in English: each is the one that the other commands print."""

    content: Assessment

    @cached_property
    def over(self) -> str:
        """Reference of the peaks."""
        return peaks_over([side.phi_cr is None for side in self.content.structure.statics])

    def counted(self) -> Markup:
        """Return the outcome under one motion, or the number of motions of each outcome and which one governs."""
        return printed(counted([each.conclusion for each in self.content.results], self.over))

    def does(self, end: Conclusion) -> Markup:
        """Return what the structure does."""
        return printed(does(end, self.over))

    def headline(self, result: MotionResult) -> Markup:
        """Return the outcome in a few words."""
        return printed(f"{headline(result.conclusion, self.over)}{' (close)' if result.close else ''}")

    def why_unknown(self, result: MotionResult) -> Markup:
        """Return why an outcome is unknown, as a clause."""
        return printed(why_unknown(result.histories["nonlinear"]) or "")

    def ends(self, run: History) -> Markup:
        """Return the outcome of a history, as a clause."""
        return printed(ends(run))

    def neighbours(self, result: MotionResult) -> Markup:
        """Return how many neighbours overturn, and the peaks of the others."""
        return printed(neighbours_in_words(result.neighbours[result.polarity]))

    def deviations(self) -> Markup:
        """Return how the neighbours are drawn."""
        return printed(deviations(self.content.results[0].margin.around))

    def margin(self, result: MotionResult) -> Markup:
        """Return at which factors neighbours overturn."""
        return printed(in_words(result.margin))

    def blocks(self, result: MotionResult) -> Markup:
        """Return how well the equivalent blocks agree with the nonlinear model."""
        called = {name: f"the equivalent block with kappa{name[-1]}" for name in result.histories}
        texts = blocks_in_words(result.histories, result.agreement[result.polarity], called)
        return printed(" ".join(f"{each[0].upper()}{each[1:]}" for each in texts))

    def joints(self, result: MotionResult) -> Markup:
        """Return whether the joints hold, and what they need."""
        run, contact = result.histories["nonlinear"], result.contacts[result.polarity]
        hold = joints_in_words(run, contact.assumed_friction) if run.check is not None else ""
        return printed(f"{hold} {contact_words(contact, self.content.mechanism)}".strip())

    def next(self, result: MotionResult) -> Markup:
        """Return what to do next about a motion."""
        return printed(next_in_words(result.conclusion))

    def doubt(self, found: Doubt) -> Markup:
        """Return a doubt about a ground motion as a sentence."""
        return printed(f"{found.text[0].upper()}{found.text[1:]}.".replace("?.", "?"))

    def cautions(self) -> list[Markup]:
        """Return the cautions on the structure."""
        return [*map(printed, cautions_of(self.content.mechanism))]

    def sizes(self) -> list[Markup]:
        """Return what is unusual about the sizes of the structure."""
        return [
            printed(each if each.endswith("?") else f"{each}.") for each in doubts_about_size(self.content.mechanism)
        ]

    def why_alone(self) -> Markup:
        """Return why there are no linear models."""
        why = _why_alone(self.content)
        return printed(f"{why[0].upper()}{why[1:]}.")

    def misleading(self) -> Markup:
        """Return why the linear models mislead, as a clause."""
        return printed(self.content.structure.misleading or "")

    def no_error(self) -> Markup:
        """Return why there is no error of the equivalent block."""
        return printed(self.content.no_error)

    def unchecked(self) -> Markup:
        """Return why the joints are not checked."""
        return printed(self.content.mechanism.unchecked)

    def restitution(self) -> Markup:
        """Return the restitution that the histories use."""
        return printed(restitution_used(self.content.structure))

    def advice(self, side: EquivalentSide) -> Markup:
        """Return which kappa to prefer; without a block, why there is none."""
        text = kappa_in_words(side.block) if side.block is not None else sentence(side)
        return printed(text if side.block is not None else f"{text[0].upper()}{text[1:]}")


def _why_alone(content: Assessment) -> str:
    return (content.structure.why_no_block or content.structure.misleading or "").removeprefix(f"{content.name}: ")


def _translated(mechanism: Mechanism, say: Language) -> list[Markup]:
    """Return the cautions on a structure in another language."""
    return [*map(guarded, cautions_of(mechanism, say))]


def context(content: Assessment, say: Language, verified: Verification | None = None) -> dict[str, Any]:
    """Return the values of the templates of a report."""
    mechanism, structure = content.mechanism, content.structure
    watched, sides = Watched(mechanism), sides_of(structure)
    motions = [
        MotionWords(
            each.given.motion.name, f"under-{k}", each,
            {name: watched.peaks(run) for name, run in each.histories.items()},
            largest([watched.peaks(runs["nonlinear"]) for runs in each.runs.values()]),
        )
        for k, each in enumerate(content.results)
    ]  # fmt: skip
    free = [side.phi_cr is None for side in structure.statics]
    contacts = [contact for each in content.results for contact in each.contacts.values()]
    falls = [each for each in content.results if each.histories["nonlinear"].fell]
    strained = [(tie.force, tie.name, each.name) for each in motions for tie in each.worst.ties if not isnan(tie.force)]
    lambdas = [side.lambda_ for side in structure.statics]
    ends = [each.conclusion for each in content.results]
    governs = worst(ends) if ends else None
    hung = mechanism.hung if mechanism.attached else None

    steel = verified is not None and any(each.is_steel for each in mechanism.ties or [])
    strong = mechanism.at_strength() if steel else None

    def number(value: float | None, digits: int) -> Markup:
        return guarded(say.number(value, digits))

    return {
        "content": content, "verified": verified, "motions": motions, "english": English(content),
        "sides": sides[:1] if is_symmetric(structure) else sides,
        "reference": "limit" if all(free) else "mixed" if any(free) else "critical",
        "least_uplift": min(lambdas) * mechanism.gravity / STANDARD_GRAVITY,
        "strong": None if strong is None else min(map(strong.uplift, strong.directions)),
        "directions_differ": not isclose(*lambdas, rel_tol=EQUAL_DIRECTIONS),
        "unknown": [each.result for each in motions if each.result.unknown],
        "close": all(each.close for each in falls) if falls else any(each.close for each in content.results),
        "not_holding": any(not contact.holds and not contact.followed for contact in contacts),
        "sliding": any(contact.assumed_friction is not None for contact in contacts),
        "governs": governs,
        "alike": [each for each in content.results if governs is not None and are_alike(each.conclusion, governs)],
        "restitution_by": structure.restitution_source,
        "joint": lambda label: guarded(say.joint(mechanism.mechanism, label)),
        "force": dict(zip(("per", "unit"), force_unit(mechanism), strict=True)),
        "step": partial(next_step, say),
        "sizes": lambda: doubts_about_size(mechanism),
        "why_alone": lambda: guarded(say.recognised("reason", _why_alone(content))),
        "early": [
            printed(each) if say.key == "en" else guarded(say.recognised("caution", each))
            for each in before_rocking(mechanism)
        ],
        "translated_cautions": lambda: _translated(mechanism, say),
        "elastic": any(tie.is_elastic for tie in mechanism.ties or []),
        "printed": printed, "infinite": inf, "disagree": disagree,
        "all_agree": lambda result: all(
            each.grade is Grade.AGREES for each in result.agreement[result.polarity].values()
        ),
        "none_needed": lambda contact: isnan(contact.friction_needed),
        "percent": lambda share: guarded(say.formula(percent(share)).replace("-", MINUS)),
        "degrees": lambda angle: number(degrees(angle), 3),
        "names": lambda results: guarded(plain(in_short([each.given.motion.name for each in results]))),
        "overturning": [
            each.result for each in motions if any(isnan(point.horizontal) for point in each.worst.points)
        ],
        "strongest": max(strained, key=lambda each: abs(each[0]), default=None),
        "hung": {
            "masses": hung.masses,
            "forces": [each for each in hung.elements if isinstance(each, ConstantForce)],
            "ties": [TieWords.of(each) for each in hung.ties],
        }
        if hung is not None
        else None,
        "at": lambda spot: guarded(f"{say.number(spot.at.real, 4)}; {say.number(spot.at.imag, 4)}"),
        "place": lambda spot: guarded(say.body(mechanism.mechanism, spot.body) if spot.body else say("the ground")),
    }  # fmt: skip


def language_of(key: str, *, is_plain: bool = False) -> Language:
    """Return a language with the texts of a report."""
    from rocking_cli.views.sheet.language import texts_of

    return Language(key, texts_of(PACKAGE, key), is_plain)


def next_step(say: Language, step: str) -> Markup:
    """Return a next step as a sentence."""
    text = say.texts.get(f"next_{step}", NEXT_STEPS[step])
    start = text if text.startswith("`") else f"{text[0].upper()}{text[1:]}"
    return guarded(f"{start}.")
