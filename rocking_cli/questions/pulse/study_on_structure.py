"""The response of a structure to a pulse: exact for its equivalent blocks, by closed form, and by nonlinear history."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Literal

from rocking_cli.core import EquivalentBlock, Mechanism
from rocking_cli.dynamics.exact import ClosedForm, ExactResponse, closed_form, exact_response
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Concluding
from rocking_cli.studies.engines import follow
from rocking_cli.studies.response import Histories, concluded

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
