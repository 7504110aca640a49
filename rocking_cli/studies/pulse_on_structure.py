"""The response of a structure to a pulse: exact for its equivalent blocks, by closed form, and by nonlinear history."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import Literal

from rocking_cli.core import EquivalentBlock, Mechanism
from rocking_cli.dynamics.exact import ClosedForm, ExactResponse, closed_form, exact_response
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Concluding
from rocking_cli.studies.response import Histories, concluded
from rocking_cli.studies.sampled_pulse import SampledHistory, sampled_history

KAPPAS: dict[ModelName, Literal[1, 2]] = {"linear1": 1, "linear2": 2}


Answer = ExactResponse | SampledHistory
"""Of a linear model, exactly; or by the history under the sampled pulse."""


def answers(structure: Structure, pulse: Pulse, polarity: int) -> dict[str, Answer]:
    """Return the responses of all models: exact ones of linear models, if there are any, else under the sampled pulse.

    A linear model has none if the pulse has no segments, or the structure rocks to one side only. A `polarity` of -1
    reverses the pulse.
    """
    structure.ask("linear models")
    exact = pulse.segments() and structure.mechanism.rocks_both_ways
    gravity, found = structure.mechanism.gravity, dict[str, Answer]()
    nonlinear = sampled_history(structure, "nonlinear", pulse, polarity)
    for name, kappa in KAPPAS.items():
        if exact:
            found[name] = exact_response(structure.equivalence, pulse, kappa=kappa, gravity=gravity, polarity=polarity)
        else:
            found[name] = sampled_history(structure, name, pulse, polarity)
    return {**found, "nonlinear": nonlinear}


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
