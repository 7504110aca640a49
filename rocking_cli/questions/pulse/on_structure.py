"""The response of a structure to a pulse: exact for its equivalent blocks, by closed form, and by nonlinear history."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import nan, pi
from operator import itemgetter
from typing import Any, Literal, NamedTuple

from rocking_cli import names
from rocking_cli.core import Direction, EquivalentBlock, Mechanism
from rocking_cli.core.equivalence import Grade, grade, uplift_error
from rocking_cli.dynamics.exact import ClosedForm, ExactResponse, closed_form, exact_response
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.names import percent
from rocking_cli.questions.pulse.view import CLOSED as OF_CLOSED
from rocking_cli.questions.pulse.view import (
    after_impacts,
    closed_data,
    how_far_off,
    impacts_before,
    why_not_valid,
)
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Concluding
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.engines import follow
from rocking_cli.studies.response import Histories, concluded
from rocking_cli.views.cautions import of_bounds
from rocking_cli.views.column import Column, data_of, of, of_part, only_shown, rounded, table_across, table_of
from rocking_cli.views.conclusion import conclusion_data
from rocking_cli.views.response import known_data, model_heads, not_checked, pulse_data
from rocking_cli.views.restitution import restitution_data, restitution_used
from rocking_cli.views.verdict import NO_JOINTS, ends, joints_in_words, uplift_in_words
from rocking_cli.views.view import Aside, Table, View, heading, in_degrees

KAPPAS: dict[ModelName, Literal[1, 2]] = {"linear1": 1, "linear2": 2}


def answers(structure: Structure, pulse: Pulse, polarity: int) -> dict[str, Answer]:
    """Return the responses of all models: exact ones of linear models, if there are any, else under the sampled pulse.

    A linear model has none if the pulse has no segments, or the structure rocks to one side only. A `polarity` of -1
    reverses the pulse.
    """
    structure.ask("linear models")
    exact = pulse.segments() and structure.mechanism.rocks_both_ways
    gravity, responses = structure.mechanism.gravity, dict[str, Answer]()
    nonlinear = sampled_history(structure, "nonlinear", pulse, polarity)
    for name, kappa in KAPPAS.items():
        if exact:
            responses[name] = exact_response(
                structure.equivalence, pulse, kappa=kappa, gravity=gravity, polarity=polarity
            )
        else:
            responses[name] = sampled_history(structure, name, pulse, polarity)
    return {**responses, "nonlinear": nonlinear}


def outcome(answer: Answer) -> ExactResponse | History:
    """Return the outcome of a model, exact or sampled."""
    return answer.history if isinstance(answer, SampledHistory) else answer


def with_conclusion(pulse: Pulse, found: Mapping[int, Mapping[str, Answer]]) -> Concluding[int, Mapping[str, Answer]]:
    """Return the responses to a pulse with their conclusion, by the nonlinear model under the worse polarity."""
    sampled = {sign: each["nonlinear"] for sign, each in found.items()}
    runs: dict[int, Histories] = {
        sign: {"nonlinear": each.history} for sign, each in sampled.items() if isinstance(each, SampledHistory)
    }
    return Concluding(found, concluded(runs, {}, str(pulse)))


def closed_forms(structure: Structure, pulse: Pulse) -> dict[str, ClosedForm]:
    """Return Eqs. 41-42 with each kappa; empty unless the pulse is a full sine and the structure is symmetric."""
    if pulse.name != "sine" or not structure.equivalence.symmetric or not structure.mechanism.rocks_both_ways:
        return {}
    block = structure.equivalence.positive
    seen = scaled(structure.mechanism, block, pulse)
    return {name: closed_form(seen[f"a{kappa}"], seen["omega"], block.eta) for name, kappa in KAPPAS.items()}


def scaled(mechanism: Mechanism, block: EquivalentBlock, pulse: Pulse) -> dict[str, float]:
    """Return the dimensionless parameters of Eq. 40: the pulse relative to the equivalent block."""
    return {
        "omega": 2 * pi / pulse.period / block.p,
        "a1": pulse.amplitude / (mechanism.gravity * block.lambda_lin),
        "a2": pulse.amplitude / (mechanism.gravity * block.lambda_),
        "eta": block.eta,
    }


MIN_SAMPLES_PER_PERIOD, MAX_SAMPLES_PER_PERIOD = 1000, 32_000
PEAK_TOLERANCE = 1e-6


@short_repr
@dataclass(frozen=True, eq=False)
class SampledHistory:
    """A history under a sampled pulse.

    Parameters
    ----------
    history : History
        The history under the finest sampling.
    motion : GroundMotion
        The pulse so sampled.
    per_period : int
        Number of samples in a period.
    converged : bool
        Whether half as many samples give the same outcome, and the same peak ratio within a relative 1e-6.
    """

    history: History
    motion: GroundMotion
    per_period: int
    converged: bool


Answer = ExactResponse | SampledHistory
"""Exact response of a linear model, or its history under the sampled pulse."""


def sampled_history(structure: Structure, model: ModelName, pulse: Pulse, polarity: int = 1) -> SampledHistory:
    """Simulate a model under a pulse, with the sampling refined until the result does not change.

    Parameters
    ----------
    structure : Structure
        The structure.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    pulse : Pulse
        Any pulse.
    polarity : {1, -1}
        -1 reverses the pulse.

    Returns
    -------
    SampledHistory

    Notes
    -----
    With n samples to a period, the error of the motion is of order n^-4 of its peak, n^-3 if it only just uplifts: the
    last halving of the interval changes the result at least seven times as much as the error that remains.
    """
    before, per_period = None, MIN_SAMPLES_PER_PERIOD
    while True:
        motion = pulse.sampled(per_period).scaled(polarity)
        history = follow(structure, motion, model=model, tail=0.0)
        converged = before is not None and _alike(before, history)
        if converged or per_period >= MAX_SAMPLES_PER_PERIOD:
            return SampledHistory(history, motion, per_period, converged)
        before, per_period = history, 2 * per_period


def _alike(one: History, other: History) -> bool:
    if one.unknown or other.unknown:
        return one.unknown and other.unknown
    if one.fell or other.fell:
        return (one.fell_to, one.impact_count) == (other.fell_to, other.impact_count)
    return abs(one.peak_ratio - other.peak_ratio) <= PEAK_TOLERANCE * other.peak_ratio


DIRECTIONS: tuple[Column[Mapping[str, Any]], ...] = (
    only_shown("direction", itemgetter("direction"), text=True),
    only_shown("omega", itemgetter("omega"), rounded(5)),
    only_shown("a\nkappa1", itemgetter("a1"), rounded(5)),
    only_shown("a\nkappa2", itemgetter("a2"), rounded(5)),
    only_shown("eta", itemgetter("eta"), rounded(5)),
)


class _Beside(NamedTuple):
    """A closed form, and the exact response that it approximates."""

    closed: ClosedForm
    exact: ExactResponse


CLOSED: tuple[Column[_Beside], ...] = (
    *of_part(OF_CLOSED, of("closed")),
    only_shown("minus exact first rebound", lambda each: each.closed.off(each.exact.first_rebound), rounded(3)),
    only_shown("minus exact peak", lambda each: each.closed.off(each.exact.peak_ratio), rounded(3)),
)
EXACT = {True: "exact", False: "sampled"}


def view(
    structure: Structure,
    pulse: Pulse,
    answers: Concluding[int, Mapping[str, Answer]],
    closed: Mapping[str, ClosedForm],
) -> View:
    """Show the responses of the models of a structure to a pulse.

    Parameters
    ----------
    structure : Structure
        The structure.
    pulse : Pulse
        The pulse as given.
    answers : Concluding, of int to mapping of str to Answer
        The responses of the models under each polarity to be analysed, 1 or -1.
    closed : mapping of str to ClosedForm
        Eqs. 41-42 with each kappa, shown with the responses in the first polarity; empty if they do not apply.
    """
    mechanism, equivalence = structure.mechanism, structure.equivalence
    blocks = {"positive": equivalence.positive, "negative": equivalence.negative}
    seen = {label: scaled(mechanism, block, pulse) for label, block in blocks.items()}
    polarity, first = next(iter(answers.items()))
    exact = {name: each for name, each in first.items() if isinstance(each, ExactResponse)}
    each = {
        str(sign): {
            "responses": {
                name: data_of(_columns(by_model), answer) | known_data(outcome(answer))
                for name, answer in by_model.items()
            }
        }
        for sign, by_model in answers.items()
    }
    data = {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "pulse": {**pulse_data(pulse), "polarity": polarity if len(answers) == 1 else "both"},
        "restitution": restitution_data(structure),
        "conclusion": conclusion_data(answers.conclusion),
        "directions": seen,
        "closed_form": {name: closed_data(form, exact[name]) for name, form in closed.items()} or None,
        **(each.popitem()[1] if len(each) == 1 else {"polarities": each}),
    }
    sides = {"both": seen["positive"]} if equivalence.symmetric else seen
    rows = [{"direction": label, **values} for label, values in sides.items()]
    titles = {sign: f"Polarity {sign}: {'as given' if sign > 0 else 'reversed'}" for sign in answers}
    parts: list[Table | str] = [
        f"{f'{titles[sign]}. ' * (len(answers) > 1)}{_verdict(by_model, mechanism)}"
        for sign, by_model in answers.items()
    ]
    parts.append(table_of(f"{heading(mechanism)}, {pulse}", DIRECTIONS, rows))
    for sign, by_model in answers.items():
        parts += ["", _answer_table(titles[sign], by_model)]
    unfit = uplift_error(equivalence)
    if grade(unfit) is Grade.DISREGARD:
        parts.append(f"Disregard linear1: its uplift acceleration is {uplift_in_words(unfit)}.")
    if not closed:
        parts.append(Aside(_why_no_closed_form(mechanism, pulse)))
    elif any(form.conditions["uplift"] for form in closed.values()):
        parts += _closed_parts(closed, exact)
    else:
        parts.append(Aside(f"No closed form: by the equivalent blocks, the structure {names.NO_UPLIFT} (a <= 1)."))
    runs = [run for each in answers.values() for run in map(outcome, each.values()) if isinstance(run, History)]
    parts += [f"Caution: {text}" for text in of_bounds(mechanism)]
    return View(data, [*parts, restitution_used(structure), *not_checked(mechanism, runs)])


def _columns(answers: Mapping[str, Answer], *, unknown: bool = False) -> list[Column[Answer]]:
    """Return the columns of a response; tables leave out those of blocks if the structure's outcome is unknown."""

    def value(name: str) -> Callable[[Answer], Any]:
        return lambda answer: getattr(outcome(answer), name)

    def exactly(name: str) -> Callable[[Answer], Any]:
        return lambda answer: getattr(answer, name) if isinstance(answer, ExactResponse) else None

    def end(answer: Answer) -> str | None:
        result = outcome(answer)
        if unknown and not result.unknown:
            return None
        words = names.outcome(uplifts=result.lifted, overturned=result.fell, unknown=result.unknown)
        # Impacts are stated only if the structure overturns; one that is still rocking counts as rocking.
        return f"{words}\n{after_impacts(result)}" if result.fell else words

    def bound(answer: Answer) -> float | None:
        return outcome(answer).lower_bound if outcome(answer).unknown else None

    def way(answer: Answer) -> str | None:
        return Direction(outcome(answer).fell_to).label if outcome(answer).fell else None

    until, least = ("known until", "lower bound of peak / phi_cr") if unknown else (None, None)
    over = partial(_over_nonlinear, answers=answers)
    return [
        Column("exact", lambda answer: isinstance(answer, ExactResponse), "", "pulse", EXACT.__getitem__),
        only_shown("outcome", end),
        only_shown(until, value("known_to"), rounded(5), "s"),
        Column("peak_ratio", value("peak_ratio"), "", "peak rotation / phi_cr", rounded(5)),
        Column("over_nonlinear", over, "", "  over that of nonlinear", rounded(5)),
        only_shown(least, bound, rounded(5)),
        Column("peak_positive", value("peak_positive"), "deg", "peak rotation, clockwise", in_degrees),
        Column("peak_negative", value("peak_negative"), "deg", "peak rotation, anticlockwise", in_degrees),
        Column("peak_rate", value("peak_rate"), "rad/s", "peak angular velocity", rounded(4)),
        Column("first_excursion", exactly("first_excursion"), "", "first excursion", rounded(5)),
        Column("first_rebound", exactly("first_rebound"), "", "first rebound", rounded(5)),
        Column("uplift_time", value("uplift_time"), "s", "uplift", rounded(5)),
        Column("first_impact", value("first_impact"), "s", "first impact", rounded(5)),
        Column("overturned", value("overturned")),
        Column("overturning_time", value("overturning_time"), "s", "overturning time", rounded(5)),
        Column("overturning_direction", way),
        Column("impacts_before_overturning", lambda answer: impacts_before(outcome(answer))),
        Column("samples_per_period", lambda each: each.per_period if isinstance(each, SampledHistory) else None),
    ]


def _over_nonlinear(answer: Answer, answers: Mapping[str, Answer]) -> float:
    """Return the peak of a model over that of the nonlinear one; NaN if either does not exist or is unknown."""
    best = outcome(answers["nonlinear"])
    if outcome(answer) is best or best.unknown or not best.peak_ratio > 0:
        return nan
    return outcome(answer).peak_ratio / best.peak_ratio


def _answer_table(title: str, answers: Mapping[str, Answer]) -> Table:
    unknown = any(outcome(each).unknown for each in answers.values())
    heads = model_heads(answers, unknown=unknown)
    table = table_across(title, _columns(answers, unknown=unknown), heads, list(answers.values()))
    return replace(table, ranks=[0, *(3 - KAPPAS[name] if name in KAPPAS else 0 for name in answers), 0])


def _verdict(answers: Mapping[str, Answer], mechanism: Mechanism) -> str:
    """Return sentences on the nonlinear history, and on how the linear models compare."""
    sampled = answers["nonlinear"]
    assert isinstance(sampled, SampledHistory)
    nonlinear, joints = sampled.history, ""
    if nonlinear.check is not None or nonlinear.unknown:
        joints = joints_in_words(nonlinear, Contacts(mechanism).check(nonlinear, sampled.motion).assumed_friction)
    if nonlinear.unknown:
        return f"{joints} {NO_JOINTS}"
    sentence = f"The structure {ends(nonlinear)}{f', {after_impacts(nonlinear)}' if nonlinear.fell else ''}."
    if not nonlinear.lifted:
        return sentence
    sentence += f" {joints}".rstrip()
    for name in KAPPAS:
        linear, over = outcome(answers[name]), _over_nonlinear(answers[name], answers)
        if over >= 0:
            off = over - 1
            sentence += f" By {name} its peak is {percent(abs(off))} {'higher' if off > 0 else 'lower'}."
        elif linear.fell != nonlinear.fell:
            sentence += f" By {name} it {names.outcome(uplifts=linear.lifted, overturned=linear.fell)}."
    return sentence


def _closed_parts(closed: Mapping[str, ClosedForm], exact: Mapping[str, ExactResponse]) -> Iterator[Table | str]:
    """Yield the closed form, its conditions, and a sentence on how far to trust it."""
    rows = [_Beside(form, exact[name]) for name, form in closed.items()]
    table = table_across("Closed form of a full sine", CLOSED, list(closed), rows, {"meaning": of("words")})
    yield replace(table, asides=range(len(table.rows)))
    for name, form in closed.items():
        yield Aside(f"{name}: {_trust(form, exact[name])}")


def _trust(closed: ClosedForm, exact: ExactResponse) -> str:
    if not closed.conditions["uplift"]:
        return f"it {names.NO_UPLIFT} (a <= 1)."
    use = "all conditions are met, so the closed form can be used"
    sentence = use if closed.valid else f"do not use the closed form here, because {why_not_valid(closed)}"
    return f"{sentence}{how_far_off(closed, exact)}."


def _why_no_closed_form(mechanism: Mechanism, pulse: Pulse) -> str:
    if not mechanism.rocks_both_ways:
        return "No closed form and no exact solution: both require a structure that rocks through to the other side."
    if pulse.name != "sine":
        sentence = "No closed form: Eqs. 41-42 apply to a full sine."
        if not pulse.segments():
            sentence += (
                " This pulse has no exact solution either: the linear models are simulated under the sampled pulse."
            )
        return sentence
    return "No closed form: Eqs. 41-42 apply to a structure with the same properties in both directions."
