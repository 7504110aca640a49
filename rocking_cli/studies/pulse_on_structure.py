"""A pulse on a structure: its equivalent blocks, exactly and by the closed form, beside its nonlinear history."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Literal

from rocking_cli.core import EquivalentBlock, Mechanism
from rocking_cli.dynamics.exact import ExactResponse, exact_response
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.dynamics.pulse_response import ClosedForm, closed_form
from rocking_cli.dynamics.sampled_pulse import SampledHistory, sampled_history
from rocking_cli.excitation.pulses import Pulse

KAPPAS: dict[ModelName, Literal[1, 2]] = {"linear1": 1, "linear2": 2}


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


def sampled_histories(structure: Prepared, pulse: Pulse, polarity: int) -> dict[ModelName, SampledHistory]:
    """Follow the models that have no exact answer: the nonlinear one, and all if the pulse has no segments."""
    models = structure.models(["nonlinear"] if pulse.segments() else [*KAPPAS, "nonlinear"])
    return {model.name: sampled_history(model, pulse, polarity) for model in models}


def answers(
    structure: Prepared, pulse: Pulse, polarity: int, sampled: Mapping[ModelName, SampledHistory]
) -> dict[str, Answer]:
    """What the models say, the linear ones exactly unless they were sampled.

    Parameters
    ----------
    structure : Prepared
        What the pulse shakes.
    pulse : Pulse
        Any.
    polarity : {1, -1}
        -1 reverses the pulse.
    sampled : mapping of str to SampledHistory
        What `sampled_histories` gives for them.
    """
    nonlinear = Answer.of_sampled(sampled["nonlinear"])
    found: dict[str, Answer] = {}
    for name, kappa in KAPPAS.items():
        if name in sampled:
            linear = Answer.of_sampled(sampled[name])
        else:
            gravity = structure.mechanism.gravity
            exact = exact_response(structure.equivalence, pulse, kappa=kappa, gravity=gravity, polarity=polarity)
            linear = Answer.of_exact(exact)
        found[name] = replace(linear, over_nonlinear=_over(linear, nonlinear))
    return {**found, "nonlinear": nonlinear}


def _over(answer: Answer, nonlinear: Answer) -> float | None:
    return answer.peak_ratio / nonlinear.peak_ratio if answer.peak_ratio is not None and nonlinear.peak_ratio else None


def closed_forms(structure: Prepared, pulse: Pulse) -> dict[str, ClosedForm]:
    """Eqs. 41-42 with each kappa; none if the pulse is no full sine or the directions differ."""
    if pulse.name != "sine" or not structure.equivalence.symmetric:
        return {}
    block = structure.equivalence.positive
    seen = scaled(structure.mechanism, block, pulse)
    return {name: closed_form(seen[f"a{kappa}"], seen["omega"], block.eta) for name, kappa in KAPPAS.items()}


def scaled(mechanism: Mechanism, block: EquivalentBlock, pulse: Pulse) -> dict[str, float]:
    """Eq. 40: the pulse as the equivalent blocks see it."""
    return {
        "omega": 2 * pi / pulse.period / block.p,
        "a1": pulse.amplitude / (mechanism.gravity * block.lambda_lin),
        "a2": pulse.amplitude / (mechanism.gravity * block.lambda_),
        "eta": block.eta,
    }
