"""The peak acceleration at which a structure uplifts, known without any run."""

from __future__ import annotations

from collections.abc import Sequence
from math import isclose
from typing import NamedTuple

import numpy as np

from rocking_cli.core import Mechanism, both_statics, equivalent_block
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.studies.fragility.intensity import PGA
from rocking_cli.studies.fragility.plan import Plan
from rocking_cli.studies.fragility.study import Study
from rocking_cli.studies.under_pulses import uplift

FACT = "uplift"
"""Name under which a store keeps the uplift accelerations of its structures."""
SAME = 1e-9  # relative difference of accelerations that differ only by rounding
Pair = Sequence[float | None]
"""Uplift accelerations over g of both directions; None for a direction that never rocks."""


class Onset(NamedTuple):
    """Intensity up to which no motion uplifts a structure, and whether every motion uplifts it beyond."""

    at: float
    exact: bool


def accelerations(study: Study, plan: Plan) -> dict[str, Pair]:
    """Return the uplift accelerations over g of each structure, in its first sample that can be simulated.

    Empty if a motion has a vertical component or is that of a floor: its horizontal PGA then does not decide.
    """
    if any(source.vertical is not None or source.reading.floor is not None for source in study.sources):
        return {}
    found: dict[str, Pair] = {}
    for sample, trial in zip(study.samples, plan.trials, strict=True):
        if trial.reason is None and trial.structure not in found:
            found[trial.structure] = _of_both(sample.mechanism, study.definition.model)
    return found


def _of_both(mechanism: Mechanism, model: ModelName) -> list[float | None]:
    if model == "nonlinear":
        both = [side.lambda_ for side in both_statics(mechanism)]
    else:
        block = equivalent_block(mechanism)
        both = [uplift(block.positive, model), uplift(block.negative, model)]
    return [*both] if mechanism.rocks_both_ways else [max(both), None]


def onset(plan: Plan, samples: range, pair: Pair | None, measure: str) -> Onset | None:
    """Return at which intensity a structure uplifts; None if that is not known over a measure.

    Parameters
    ----------
    plan : Plan
        The plan of the study's runs.
    samples : range
        Indices of the structure's samples.
    pair : (float or None, float or None), optional
        Its uplift accelerations over g, as the store keeps them.
    measure : str
        The measure: PGA, or PGA over the uplift acceleration.
    """
    asked = parse_measure(measure)
    if pair is None or str(asked.base) != PGA or asked.power != 1:
        return None
    usable = [k for k in samples if plan.trials[k].reason is None]
    accelerations = np.array([plan.trials[k].lambda_ * plan.trials[k].gravity for k in usable])
    if np.ptp(accelerations) > SAME * accelerations.max():  # a property varies on which it depends
        return None
    pga = accelerations[:1] / STANDARD_GRAVITY
    at = float(asked.relative(pga, plan.reference(np.array(usable[:1])))[0])
    one, other = pair
    return Onset(at, one is not None and other is not None and isclose(one, other, rel_tol=SAME))
