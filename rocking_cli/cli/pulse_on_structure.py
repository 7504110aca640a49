"""`rocking pulse FILE`: a pulse on a structure, by its equivalent blocks and by its nonlinear history."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from math import degrees, pi
from typing import Any

import click

from rocking_cli import names
from rocking_cli.cli import structures, terminal
from rocking_cli.cli.pulse import YES_NO, closed_json, how_far_off, impacts, off_exact
from rocking_cli.cli.work import say_if_compiling
from rocking_cli.core import Equivalence, EquivalentBlock, Mechanism
from rocking_cli.core.advice import Grade, grade, uplift_error, uplift_in_words
from rocking_cli.dynamics.exact import ExactResponse, exact_response
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.dynamics.pulse_response import CONDITIONS, ClosedForm, closed_form
from rocking_cli.dynamics.sampled_pulse import SampledHistory, sampled_history
from rocking_cli.dynamics.verdict import SENSE
from rocking_cli.errors import InputError
from rocking_cli.excitation.pulses import Pulse, PulseShapes, parse_pulse
from rocking_cli.names import percent
from rocking_cli.views.response import pulse_data, restitution_data, restitution_used
from rocking_cli.views.view import ABSENT, heading, number

KAPPAS = {"linear1": 1, "linear2": 2}


@dataclass(frozen=True)
class Answer:
    """What one model says."""

    exact: bool
    overturned: bool
    overturning_direction: str | None
    overturning_time: float | None
    impacts_before_overturning: int | None
    peak_positive: float | None
    peak_negative: float | None
    peak_ratio: float | None
    uplift_time: float | None
    first_impact: float | None
    first_excursion: float | None
    first_rebound: float | None
    samples_per_period: int | None
    over_nonlinear: float | None = None

    @classmethod
    def of_exact(cls, found: ExactResponse) -> Answer:
        """From the exact response of an equivalent block."""
        known = {name: value for name, value in vars(found).items() if name in cls.__dataclass_fields__}
        direction = {None: None, 1: "positive", -1: "negative"}[found.fell_to]
        return cls(exact=True, overturning_direction=direction, samples_per_period=None, **known)

    @classmethod
    def of_sampled(cls, found: SampledHistory) -> Answer:
        """From a history under the sampled pulse."""
        history: History = found.history
        return cls(
            exact=False,
            overturned=history.overturned,
            overturning_direction=history.fell_to.label if history.fell_to else None,
            overturning_time=history.overturning_time,
            impacts_before_overturning=history.impact_count if history.overturned else None,
            peak_positive=history.peak_positive,
            peak_negative=history.peak_negative,
            peak_ratio=history.peak_ratio,
            uplift_time=history.uplift_time,
            first_impact=float(history.impacts[0, 0]) if len(history.impacts) else None,
            first_excursion=None,
            first_rebound=None,
            samples_per_period=found.per_period,
        )


@dataclass(frozen=True)
class Closed:
    """Eqs. 41-42 with one kappa, and by how much they miss the exact answer of the same equation.

    Parameters
    ----------
    closed : ClosedForm
        What they say.
    off_first_rebound, off_peak_ratio : float or None
        Eq. 41 less the exact peak of the first rebound, and less the largest of all; None where either has none.
    """

    closed: ClosedForm
    off_first_rebound: float | None
    off_peak_ratio: float | None


def run(file: str | None, shape: str, ag: str, period: float, polarity: str, as_json: bool) -> None:
    """Do all that is asked for and print it."""
    pulse = _pulse(shape, ag, period)
    structure = structures.prepared([file] if file else [])
    mechanism, equivalence = structure.mechanism, structure.equivalence
    signs = (1, -1) if polarity == "both" else (int(polarity),)
    answers = {sign: _answers(structure, pulse, sign) for sign in signs}
    closed = {}
    if pulse.name == "sine" and equivalence.symmetric:
        closed = _closed(mechanism, equivalence.positive, pulse, answers[signs[0]])
    if as_json:
        terminal.print_json(_as_json(mechanism, equivalence, pulse, polarity, closed, answers))
        return
    _print_pulse(mechanism, equivalence, pulse)
    for sign, found in answers.items():
        terminal.result()
        _print_answers(f"Polarity {sign}: {'as it is' if sign > 0 else 'reversed'}", found)
        terminal.result(_verdict(found))
    unfit = uplift_error(equivalence)
    if grade(unfit) is Grade.DISREGARD:
        terminal.result(f"Disregard linear1: its uplift acceleration is {uplift_in_words(unfit)}.")
    terminal.result()
    if not closed:
        terminal.result(_why_no_closed_form(pulse))
    elif any(each.closed.conditions["uplift"] for each in closed.values()):
        _print_closed(closed, answers[signs[0]])
    else:
        terminal.result(f"No closed form: by the equivalent blocks it {names.NO_UPLIFT} (a <= 1).")
    terminal.result(restitution_used(mechanism, equivalence))


def _pulse(shape: str, ag: str, period: float) -> Pulse:
    """The pulse of `--shape`, `--ag` and `--period`."""
    name, *further = shape.split(":")
    shapes = PulseShapes()
    if name not in shapes:
        raise click.BadParameter(f"{name!r} is not one of {', '.join(shapes)}.", param_hint="'--shape'")
    try:
        parse_pulse(f"sine:{ag}:1s")
    except InputError:
        raise click.BadParameter(
            f"{ag!r} is not a positive amplitude with its unit: give it as 0.6g, 5.9m/s2, 590cm/s2 or 590gal "
            "(--polarity -1 reverses the pulse).",
            param_hint="'--ag'",
        ) from None
    return parse_pulse(":".join((name, ag, f"{period!r}s", *further)))


def _answers(structure: Prepared, pulse: Pulse, polarity: int) -> dict[str, Answer]:
    """What the models say, linear ones exactly if the pulse has segments."""
    say_if_compiling()
    exact = bool(pulse.segments())
    sampled = {
        model.name: sampled_history(model, pulse, polarity)
        for model in structure.models(["nonlinear"] if exact else ["linear1", "linear2", "nonlinear"])
    }
    for name, found in sampled.items():
        if not found.converged:
            terminal.warning(
                f"{name}: {found.per_period} samples to a period do not settle it: it is close to another motion"
            )
    nonlinear = Answer.of_sampled(sampled["nonlinear"])
    answers = {
        name: Answer.of_exact(
            exact_response(
                structure.equivalence,
                pulse,
                kappa=1 if kappa == 1 else 2,
                gravity=structure.mechanism.gravity,
                polarity=polarity,
            )
        )
        if exact
        else Answer.of_sampled(sampled[name])  # type: ignore[index]
        for name, kappa in KAPPAS.items()
    }
    return {
        **{name: replace(answer, over_nonlinear=_over(answer, nonlinear)) for name, answer in answers.items()},
        "nonlinear": nonlinear,
    }


def _over(answer: Answer, nonlinear: Answer) -> float | None:
    return answer.peak_ratio / nonlinear.peak_ratio if answer.peak_ratio is not None and nonlinear.peak_ratio else None


def _scaled(mechanism: Mechanism, block: EquivalentBlock, pulse: Pulse) -> dict[str, float]:
    """Eq. 40: the pulse as the equivalent blocks see it."""
    return {
        "omega": 2 * pi / pulse.period / block.p,
        "a1": pulse.amplitude / (mechanism.gravity * block.lambda_lin),
        "a2": pulse.amplitude / (mechanism.gravity * block.lambda_),
        "eta": block.eta,
    }


def _closed(
    mechanism: Mechanism, block: EquivalentBlock, pulse: Pulse, answers: Mapping[str, Answer]
) -> dict[str, Closed]:
    scaled, found = _scaled(mechanism, block, pulse), {}
    for name, kappa in KAPPAS.items():
        closed, exact = closed_form(scaled[f"a{kappa}"], scaled["omega"], block.eta), answers[name]
        off = off_exact(closed, exact.first_rebound, exact.peak_ratio)
        found[name] = Closed(closed, **off)
    return found


def _directions(equivalence: Equivalence) -> dict[str, EquivalentBlock]:
    return {"positive": equivalence.positive, "negative": equivalence.negative}


def _as_json(
    mechanism: Mechanism,
    equivalence: Equivalence,
    pulse: Pulse,
    polarity: str,
    closed: Mapping[str, Closed],
    answers: Mapping[int, Mapping[str, Answer]],
) -> dict[str, Any]:
    each = {
        str(sign): {"responses": {name: asdict(answer) for name, answer in found.items()}}
        for sign, found in answers.items()
    }
    return {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "pulse": {**pulse_data(pulse), "polarity": polarity if polarity == "both" else int(polarity)},
        "restitution": restitution_data(mechanism, equivalence),
        "directions": {label: _scaled(mechanism, block, pulse) for label, block in _directions(equivalence).items()},
        "closed_form": {
            name: {
                **closed_json(found.closed),
                "off_first_rebound": found.off_first_rebound,
                "off_peak_ratio": found.off_peak_ratio,
            }
            for name, found in closed.items()
        }
        or None,
        **(each.popitem()[1] if len(each) == 1 else {"polarities": each}),
    }


def _print_pulse(mechanism: Mechanism, equivalence: Equivalence, pulse: Pulse) -> None:
    rows = []
    for label, block in _directions(equivalence).items():
        scaled = _scaled(mechanism, block, pulse)
        rows.append([label, *(number(scaled[key], 5) for key in ("omega", "a1", "a2", "eta"))])
    if equivalence.symmetric:
        rows = [["both", *rows[0][1:]]]
    terminal.table(
        f"{heading(mechanism)}, {pulse}",
        ["direction", "omega", "a\nkappa1", "a\nkappa2", "eta"],
        rows,
        numbers=range(1, 5),
    )


def _print_answers(title: str, answers: Mapping[str, Answer]) -> None:
    found = list(answers.values())

    def in_degrees(phi: float | None) -> str:
        return ABSENT if phi is None else number(degrees(phi), 5)

    rows = [
        ["pulse", *("exact" if each.exact else "sampled" for each in found), ""],
        ["outcome", *(_outcome(each) for each in found), ""],
        ["peak / phi_cr", *(number(each.peak_ratio, 5) for each in found), ""],
        ["  over nonlinear", *(number(each.over_nonlinear, 5) for each in found), ""],
        ["peak, clockwise", *(in_degrees(each.peak_positive) for each in found), "deg"],
        ["peak, anticlockwise", *(in_degrees(each.peak_negative) for each in found), "deg"],
        ["first excursion", *(number(each.first_excursion, 5) for each in found), ""],
        ["first rebound", *(number(each.first_rebound, 5) for each in found), ""],
        ["uplift", *(number(each.uplift_time, 5) for each in found), "s"],
        ["first impact", *(number(each.first_impact, 5) for each in found), "s"],
        ["overturning time", *(number(each.overturning_time, 5) for each in found), "s"],
    ]
    terminal.table(title, ["", *answers, "unit"], rows, numbers=range(1, len(found) + 1))


def _outcome(answer: Answer) -> str:
    said = names.outcome(uplifts=answer.uplift_time is not None, overturned=answer.overturned)
    return f"{said}\n{impacts(answer.impacts_before_overturning)}" if answer.overturned else said


def _verdict(answers: Mapping[str, Answer]) -> str:
    """What the nonlinear history says, and how the linear ones compare."""
    nonlinear = answers["nonlinear"]
    if nonlinear.uplift_time is None:
        return f"The structure {names.NO_UPLIFT}."
    if nonlinear.overturned:
        sense = next(sense for direction, sense in SENSE.items() if direction.label == nonlinear.overturning_direction)
        said = f"The structure {names.OVERTURNS} {sense}, {impacts(nonlinear.impacts_before_overturning)}."
    else:
        said = f"The structure {names.ROCKS} to {nonlinear.peak_ratio:.4g} of its critical rotation."
    for name in KAPPAS:
        answer = answers[name]
        if answer.over_nonlinear is not None:
            off = answer.over_nonlinear - 1
            said += f" {name} gives {percent(abs(off))} {'more' if off > 0 else 'less'}."
        elif answer.overturned != nonlinear.overturned:
            lifts = answer.uplift_time is not None
            said += f" By {name} it {names.outcome(uplifts=lifts, overturned=answer.overturned)}."
    return said


def _print_closed(found: Mapping[str, Closed], answers: Mapping[str, Answer]) -> None:
    closed = [each.closed for each in found.values()]
    rows = [
        ["D0* (Eq. 42)", *(number(each.D0) for each in closed)],
        ["max ratio (Eq. 41)", *(number(each.max_ratio) for each in closed)],
        ["  minus exact first rebound", *(number(each.off_first_rebound, 3) for each in found.values())],
        ["  minus exact peak", *(number(each.off_peak_ratio, 3) for each in found.values())],
        ["overturns after one impact", *(YES_NO[each.overturns] for each in closed)],
    ]
    rows += [
        [f"condition {place}", *(YES_NO[each.conditions[name]] for each in closed)]
        for place, name in enumerate(CONDITIONS, start=1)
    ]
    terminal.table("Closed form of a full sine", ["", *found], rows, numbers=range(1, len(found) + 1))
    for place, condition in enumerate(CONDITIONS.values(), start=1):
        terminal.result(f"{place}: {condition}")
    for name, each in found.items():
        terminal.result(f"{name}: {_trust(each, answers[name])}")


def _trust(found: Closed, exact: Answer) -> str:
    closed = found.closed
    if not closed.conditions["uplift"]:
        return f"it {names.NO_UPLIFT} (a <= 1)."
    use = "all conditions hold, the closed form can be used"
    said = use if closed.valid else f"do not use the closed form, {closed.reason}"
    return f"{said}{how_far_off(closed, exact.peak_ratio, overturns=exact.overturned)}."


def _why_no_closed_form(pulse: Pulse) -> str:
    if pulse.name != "sine":
        said = "No closed form: Eqs. 41-42 are for a full sine."
        if not pulse.segments():
            said += " This pulse has no exact answer either: the linear models are followed on a sampled one."
        return said
    return "No closed form: Eqs. 41-42 are for a structure whose directions agree."
