"""Measure what a study requests and its store does not hold yet: values of records, samples and runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from math import nan

import numpy as np

from rocking_cli.arrays import Bools, Reals
from rocking_cli.core import Mechanism, NoEquivalentBlock, equivalent_block
from rocking_cli.dynamics.model import ModelName
from rocking_cli.processing.intensity import Measure, RunMeasure, parse_measure
from rocking_cli.processing.intensity.base import Reference
from rocking_cli.studies.fragility.plan import Plan, weaker_block
from rocking_cli.studies.fragility.quantities import PGA, PGV, SCALE
from rocking_cli.studies.fragility.sources import KeptMotions

V_IMP = "v_imp"
ORIGIN = ("magnitude", "distance")
"""What records may state of their earthquake, kept beside measures so that these can be checked against it."""
Told = Callable[[int], None]
"""Called with how many records have been gone through since the last call."""


def complete(
    plan: Plan,
    mechanisms: Sequence[Mechanism],
    model: ModelName,
    motions: KeptMotions,
    asked: Iterable[str],
    told: Told = lambda count: None,
    *,
    origins: bool = False,
) -> Plan:
    """Return a plan with all values that some measures need; values that are known are not measured again.

    Parameters
    ----------
    plan : Plan
        All runs, with what was measured for them.
    mechanisms : sequence of Mechanism
        The mechanisms of the plan's trials.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    motions : KeptMotions
        The motions of the plan's records.
    asked : iterable of str
        Names of the measures; the factor on the records is ignored.
    told : callable, optional
        Called with the number of records measured since the last call; see `Told`.
    origins : bool
        Whether to keep what the records state of their earthquake, too.

    Raises
    ------
    InputError
        If a record cannot be read any more, or is beyond the range of numbers.
    PluginError
        If the plugin of a measure fails.
    """
    measures = [parse_measure(each) for each in dict.fromkeys(asked) if each != SCALE]
    plan = _with_samples(plan, mechanisms, model, measures)
    bases = {str(each.base): each.base for each in measures if each.base is not None}
    of_run = {str(each): each for each in measures if isinstance(each, RunMeasure)}
    if plan.measure != SCALE:  # without these no run has a factor
        base = parse_measure(plan.measure).base
        assert base is not None
        bases[str(base)] = base
    names = [name for name in bases if name not in (PGA, PGV)] + list(ORIGIN if origins else ())
    new = {name: _copied(plan.measured.of_record, name, len(plan.records)) for name in names}
    samples, records, _, levels, _ = plan.shape
    runs = {name: _copied(plan.measured.of_run, name, samples, records, levels) for name in of_run}
    usable = np.array([trial.reason is None for trial in plan.trials])
    for k, record in enumerate(plan.records):
        told(1)
        if record.reason is not None:
            continue
        for name, values in new.items():
            if np.isnan(values[k]):
                value = bases[name].value(motions[k].of_ground) if name in bases else getattr(motions[k].origin, name)
                values[k] = nan if value is None else value
    plan = replace(plan, measured=replace(plan.measured, of_record={**plan.measured.of_record, **new}))
    plan = _without_unscalable(plan)
    for k, record in enumerate(plan.records):
        if record.reason is None:
            for name, values in runs.items():
                if np.isnan(values[usable, k]).any():
                    values[:, k] = _of_runs(plan, of_run[name], motions, k, usable)
    return replace(plan, measured=replace(plan.measured, of_run={**plan.measured.of_run, **runs}))


def _copied(known: Mapping[str, Reals], name: str, *shape: int) -> Reals:
    """Return a copy of the known values of a name, or an array of NaN."""
    return np.array(known[name]) if name in known else np.full(shape, np.nan)


def _with_samples(plan: Plan, mechanisms: Sequence[Mechanism], model: ModelName, measures: Sequence[Measure]) -> Plan:
    """Return a plan with the velocity steps that just overturn the samples, if a measure needs them."""
    if not any(V_IMP in each.needs for each in measures):
        return plan
    values = _copied(plan.measured.of_sample, V_IMP, len(plan.trials))
    for k, (trial, mechanism) in enumerate(zip(plan.trials, mechanisms, strict=True)):
        if trial.reason is None and np.isnan(values[k]):
            try:
                values[k] = weaker_block(equivalent_block(mechanism), model).v_imp
            except NoEquivalentBlock:
                continue
    return replace(plan, measured=replace(plan.measured, of_sample={**plan.measured.of_sample, V_IMP: values}))


def _without_unscalable(plan: Plan) -> Plan:
    """Return a plan with a reason at each record that no factor scales to the levels."""
    if plan.measure == SCALE:
        return plan
    base = parse_measure(plan.measure).base
    values = plan.of_records(str(base))
    why = f"its {base} is not above zero: it cannot be scaled to levels of {plan.measure}"
    records = [
        record if record.reason is not None or value > 0 else replace(record, reason=f"{record.name}: {why}")
        for record, value in zip(plan.records, values, strict=True)
    ]
    known = dict(plan.measured.of_record)
    if str(base) in known:  # to be measured anew when it is put right
        known[str(base)] = np.where(values > 0, values, nan)
    return replace(plan, records=records, measured=replace(plan.measured, of_record=known))


def _of_runs(plan: Plan, measure: RunMeasure, motions: KeptMotions, k: int, usable: Bools) -> Reals:
    """Return a measure of the runs of a record, shape (samples, levels); equal samples are computed once."""
    samples, _, _, levels, _ = plan.shape
    values = np.full((samples, levels), np.nan)
    known: dict[tuple[float, ...], float] = {}
    for sample in np.flatnonzero(usable).tolist():
        place = np.full(levels, sample)
        factors = plan.factors(place, np.full(levels, k), np.arange(levels))
        of = plan.reference(np.array([sample]))
        structure = [float(np.asarray(number)[0]) for number in (of.p, of.lambda_, of.gravity, of.v_imp)]
        for level, factor in enumerate(factors.tolist()):
            key = (factor, *structure)
            if key not in known:
                known[key] = measure.value(motions[k].of_ground.scaled(factor), Reference(*structure))
            values[sample, level] = known[key]
    return values
