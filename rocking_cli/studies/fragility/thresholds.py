"""Thresholds of a structure: the PGA at which it uplifts, and the rotations at which its top has moved a distance."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import isclose
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Mechanism, both_statics, equivalent_block
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.studies.fragility.plan import Plan, Trial
from rocking_cli.studies.fragility.quantities import PGA, asked_for, metres
from rocking_cli.studies.fragility.study import Sample, Study
from rocking_cli.studies.movements import is_held, top
from rocking_cli.studies.under_pulses import uplift

Pair = tuple[float | None, float | None]
"""Values in the positive and the negative direction; None where a structure never gets there."""

WAY = 512  # rotations from rest to the end of a mechanism at which it is looked how far the top has moved
CLOSER = 32  # of a step, in each look at it from closer by
LOOKS = 10  # which are as many as leave no more than rounding


def rotations(
    samples: Sequence[Sample], trials: Sequence[Trial], limits: Sequence[str], known: Mapping[str, Sequence[Pair]]
) -> dict[str, Sequence[Pair]]:
    """Return the rotations of each sample at which its top reaches the displacements of limit states.

    Parameters
    ----------
    samples : sequence of Sample
        The structures.
    trials : sequence of Trial
        The trials of these samples; samples that cannot be simulated are skipped.
    limits : sequence of str
        Limit states such as `25 mm`.
    known : mapping of str to sequence of pair
        Rotations found before, which are kept.

    Returns
    -------
    dict of str to sequence of pair
        The rotations of all samples, by limit state, including the known ones.
    """
    missing = [limit for limit in limits if limit not in known]
    wanted = [value for value in map(metres, missing) if value is not None]
    found: dict[tuple[object, ...], list[Pair]] = {}
    table: list[list[Pair]] = []
    for sample, trial in zip(samples, trials, strict=True) if missing else ():
        key = (sample.structure, *sample.geometry)
        if trial.reason is None and key not in found:
            found[key] = of_a_structure(sample.mechanism, wanted)
        table.append(found.get(key, [(None, None)] * len(wanted)))
    return {**known, **{limit: [row[k] for row in table] for k, limit in enumerate(missing)}}


def held(study: Study) -> list[str]:
    """Return a sentence on each structure whose top is held sideways although limit states are on its displacement."""
    limits = asked_for(study.definition.limit_states)
    return [
        f"{structure.name or structure.mechanism}: its top is held to the side and a hinge moves more, but limits "
        f"such as {limits[0]} are of the top: use a ratio of rotations instead"
        for structure in (study.structures if limits else ())
        if is_held(structure)
    ]


def of_a_structure(mechanism: Mechanism, displacements: Sequence[float]) -> list[Pair]:
    """Return, for each displacement [m], the rotations of either sign at which the top first reaches it."""
    _, spot = top(mechanism)
    sides: dict[Direction, list[float | None]] = {}
    for direction in Direction:
        if direction not in mechanism.directions:  # it never turns there
            sides[direction] = [None] * len(displacements)
            continue

        def moved(phi: Reals, side: Direction = direction) -> Reals:
            return np.abs((mechanism.followed(phi, side)(spot).z - spot.at).real)

        end = float(np.nextafter(mechanism.limit(direction), 0.0))
        phi = np.linspace(0.0, end, WAY + 1)
        at = moved(phi)
        sides[direction] = [first_reached(moved, phi, at, each) for each in displacements]
    return list(zip(sides[Direction.POSITIVE], sides[Direction.NEGATIVE], strict=True))


def first_reached(moved: Callable[[Reals], Reals], phi: Reals, at: Reals, wanted: float) -> float | None:
    """Return the first rotation at which a displacement is reached, even if it decreases again; None if it never is.

    Parameters
    ----------
    moved : callable
        The displacement [m] over rotations (n,).
    phi, at : ndarray, shape (n,)
        Rotations from rest on [rad], and the displacements there.
    wanted : float
        The displacement [m].
    """
    for k in range(1, len(phi)):
        if at[k] >= wanted:
            return _crossing(moved, phi[k - 1], phi[k], wanted)
        turns_back = k + 1 < len(phi) and at[k - 1] <= at[k] > at[k + 1]
        if turns_back and (peak := _peak(moved, phi[k - 1], phi[k + 1], wanted)) is not None:
            return _crossing(moved, phi[k - 1], peak, wanted)
    return None


def _crossing(moved: Callable[[Reals], Reals], low: float, high: float, wanted: float) -> float:
    """Find by successive refinement where between two rotations a displacement is first reached."""
    for _ in range(LOOKS):
        fine = np.linspace(low, high, CLOSER + 1)
        k = max(int(np.argmax(moved(fine) >= wanted)), 1)
        low, high = float(fine[k - 1]), float(fine[k])
    return high


def _peak(moved: Callable[[Reals], Reals], low: float, high: float, wanted: float) -> float | None:
    """Return a rotation between two others at which a displacement is reached, although at neither of these.

    None if there is no such rotation.
    """
    for _ in range(LOOKS):
        fine = np.linspace(low, high, CLOSER + 1)
        at = moved(fine)
        k = int(np.argmax(at))
        if at[k] >= wanted:
            return float(fine[k])
        low, high = float(fine[max(k - 1, 0)]), float(fine[min(k + 1, CLOSER)])
    return None


FACT = "uplift"
"""Name under which a store keeps the uplift accelerations of its structures."""
SAME = 1e-9  # relative difference of accelerations that differ only by rounding


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


def _of_both(mechanism: Mechanism, model: ModelName) -> Pair:
    if model == "nonlinear":
        one, other = (side.lambda_ for side in both_statics(mechanism))
    else:
        block = equivalent_block(mechanism)
        one, other = uplift(block.positive, model), uplift(block.negative, model)
    return (one, other) if mechanism.rocks_both_ways else (max(one, other), None)


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
