"""The runs of a study, numbered: which structure, record, restitution, level and polarity each number stands for.

What a study requests and its store does not hold yet is measured: values of records, samples and runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from math import nan, prod
from typing import Any

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.core import Equivalence, EquivalentBlock, NoEquivalentBlock, equivalent_block
from rocking_cli.dynamics.model import ModelName
from rocking_cli.processing.intensity import Measure, MotionMeasure, Reference, RunMeasure, parse_measure
from rocking_cli.questions.fragility.observed import INTENSITY_TOLERANCE
from rocking_cli.questions.fragility.study import KeptMotions, Record, Study
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fragility.quantities import PGA, PGV, SCALE
from rocking_cli.studies.under_pulses import uplift

EVERY_LEVEL = -1


@short_repr
@dataclass(frozen=True, eq=False)
class Sets:
    """The levels at which the records of a study are run; each field is an ndarray with an entry for each record.

    Parameters
    ----------
    level : ndarray of int
        Index of the one level at which the record is run; -1 for a record that is run at all levels.
    weight : ndarray
        Relative weight of the record, positive.
    one : ndarray of int
        Index of the first entry that is the same record, in another set or another direction.
    scaled : bool
        Whether records are scaled to their levels; otherwise they are used as they are, and a level only names its set.
    """

    level: Integers
    weight: Reals
    one: Integers
    scaled: bool

    @property
    def weighted(self) -> bool:
        """Whether the records have different weights."""
        return bool(np.ptp(self.weight) > INTENSITY_TOLERANCE * self.weight.max()) if self.weight.size else False


def described(description: dict[str, Any], weights: Sequence[float]) -> Sets:
    """Build the sets of a store from the description of its study and the weights last requested."""
    records, values = description["records"], np.array(description["levels"]["values"])
    at = [each.get("level") for each in records]
    level = [EVERY_LEVEL if each is None else np.argmin(np.abs(values - each)) for each in at]
    files = [each.get("file", each["name"]) for each in records]
    _, first, which = np.unique(files, return_index=True, return_inverse=True)
    scaled = description["levels"].get("scaled", True)
    return Sets(np.array(level, dtype=np.int64), np.array(weights, dtype=np.float64), first[which], scaled)


@short_repr
@dataclass(frozen=True, eq=False)
class Measured:
    """Values measured for a study, by name; NaN where there is none.

    Parameters
    ----------
    of_record : mapping of str to ndarray, shape (records,)
        Measures of the unscaled motions, by their standard spelling.
    of_sample : mapping of str to ndarray, shape (samples,)
        Fields of `Reference` that trials lack.
    of_run : mapping of str to ndarray, shape (samples, records, levels)
        Measures that are not proportional to a power of the factor on the record.
    """

    of_record: Mapping[str, Reals] = field(default_factory=dict)
    of_sample: Mapping[str, Reals] = field(default_factory=dict)
    of_run: Mapping[str, Reals] = field(default_factory=dict)


@short_repr
@dataclass(frozen=True)
class Trial:
    """One sample of a structure in a study, with its parameters.

    Parameters
    ----------
    structure : str
        The structure's name.
    number : int
        Number of the sample, from 0.
    drawn : dict of str to float
        The sampled fields, by name.
    reason : str or None
        Why the sample cannot be simulated; None if it can.
    p : float
        Frequency parameter [rad/s], 0 if there is no equivalent block. This and all further fields are 0 if the sample
        cannot be simulated.
    lambda_ : float
        Uplift acceleration of the model over g.
    gravity : float
        Gravitational acceleration [m/s2].
    phi_cr_positive, phi_cr_negative : float
        Critical rotations [rad]; the kinematic limit if there is no critical rotation.
    """

    structure: str
    number: int
    drawn: dict[str, float]
    reason: str | None = None
    p: float = 0.0
    lambda_: float = 0.0
    gravity: float = 0.0
    phi_cr_positive: float = 0.0
    phi_cr_negative: float = 0.0


def weaker(equivalence: Equivalence, model: ModelName) -> tuple[float, float]:
    """Return p and lambda of the direction that uplifts first, the reference of dimensionless measures."""
    block = weaker_block(equivalence, model)
    return block.p, uplift(block, model)


def weaker_block(equivalence: Equivalence, model: ModelName) -> EquivalentBlock:
    """Return the equivalent block of the direction that uplifts first."""
    return min((equivalence.positive, equivalence.negative), key=lambda each: uplift(each, model))


@short_repr
@dataclass(frozen=True, eq=False)
class Plan:
    """All runs of a study, numbered with the polarity changing fastest, then level, restitution, record and sample.

    Parameters
    ----------
    trials : sequence of Trial
        The samples of the structures.
    records : sequence of Record
        The ground motions.
    etas : sequence of float
        Coefficients of restitution; NaN for the one of the structure.
    measure : str
        Measure of the levels, or "scale" for factors on the records.
    levels : sequence of float
        The levels.
    polarities : sequence of int
        The polarities: 1, -1 or both.
    measured : Measured
        Values measured beyond the peaks of the records.
    sets : Sets
        The levels and the weight of each record.
    """

    trials: Sequence[Trial]
    records: Sequence[Record]
    etas: Sequence[float]
    measure: str
    levels: Sequence[float]
    polarities: Sequence[int]
    measured: Measured
    sets: Sets

    @property
    def structures(self) -> list[str]:
        """Names of the structures, in the order of the study."""
        return list(dict.fromkeys(trial.structure for trial in self.trials))

    @property
    def axes(self) -> tuple[object, ...]:
        """What its samples, records and levels are: plans in which this is equal share what was measured."""
        samples = [(each.structure, each.number) for each in self.trials]
        return samples, [each.name for each in self.records], self.measure, list(self.levels)

    @property
    def shape(self) -> tuple[int, int, int, int, int]:
        """Numbers of samples, records, restitutions, levels and polarities."""
        return len(self.trials), len(self.records), len(self.etas), len(self.levels), len(self.polarities)

    @property
    def block(self) -> int:
        """Number of runs of one sample under one record; their numbers are consecutive."""
        return prod(self.shape[2:])

    @property
    def base(self) -> MotionMeasure | None:
        """The measure of a record from which the factors on it follow; None if levels are factors."""
        return None if self.measure == SCALE else parse_measure(self.measure).base

    @cached_property
    def usable_samples(self) -> Bools:
        """Whether each sample can be simulated."""
        return np.array([each.reason is None for each in self.trials])

    @cached_property
    def usable_records(self) -> Bools:
        """Whether each record can be used at each level, shape (records, levels)."""
        at, levels = self.sets.level[:, None], np.arange(len(self.levels))
        usable = np.array([[each.reason is None] for each in self.records])
        return np.asarray(usable & ((at == EVERY_LEVEL) | (at == levels)))

    @cached_property
    def mechanics(self) -> Reals:
        """Parameters p, lambda and gravity of the samples."""
        return np.array([(each.p, each.lambda_, each.gravity) for each in self.trials])

    @property
    def total(self) -> int:
        """Number of runs that can be simulated: without samples and records that cannot be used."""
        return int(self.usable_samples.sum() * self.usable_records.sum()) * len(self.etas) * len(self.polarities)

    def numbers(self, first: int, stop: int) -> Integers:
        """Return the numbers of the runs from `first` to before `stop` that can be simulated."""
        runs = np.arange(first, min(stop, self.size))
        sample, record, _, level, _ = self.places(runs)
        return runs[self.usable_samples[sample] & self.usable_records[record, level]]

    @property
    def size(self) -> int:
        """Number of all combinations, whether or not they can be simulated."""
        return prod(self.shape)

    def places(self, runs: Integers) -> tuple[Integers, Integers, Integers, Integers, Integers]:
        """Return the indices of sample, record, restitution, level and polarity of runs."""
        sample, record, eta, level, polarity = np.unravel_index(runs, self.shape)
        return sample, record, eta, level, polarity

    def reference(self, sample: Integers) -> Reference:
        """Return the reference values of dimensionless measures for samples given by their indices."""
        columns = self.mechanics[sample]
        p = np.where(columns[:, 0] > 0, columns[:, 0], np.nan)
        steps = self.measured.of_sample.get("v_imp", np.full(len(self.trials), nan))
        return Reference(p, columns[:, 1], columns[:, 2], steps[sample])

    def of_records(self, measure: str) -> Reals:
        """Return a measure of the unscaled motions, shape (records,); NaN where it is not known."""
        if measure in (PGA, PGV):
            return np.array([each.pga if measure == PGA else each.pgv for each in self.records])
        return self.measured.of_record.get(measure, np.full(len(self.records), nan))

    def intensities(
        self, measure: str, sample: Integers, record: Integers, level: Integers, factor: float | Reals
    ) -> Reals:
        """Return the intensity of runs, from their indices and the factors on the records; NaN if not known."""
        parsed = parse_measure(measure)
        if parsed.base is None or parsed.power is None:
            table = self.measured.of_run.get(str(parsed), np.full((len(self.trials), len(self.records), 1), nan))
            return np.asarray(table[sample, record, np.minimum(level, table.shape[2] - 1)])
        value = self.of_records(str(parsed.base))[record] * np.power(factor, parsed.power)
        return np.asarray(parsed.relative(value, self.reference(sample)), dtype=np.float64)

    def factors(self, sample: Integers, record: Integers, level: Integers) -> Reals:
        """Return the factors that scale records to intensity levels, for arrays of indices of equal shape."""
        wanted = np.array(self.levels)[level]
        if not self.sets.scaled:
            return np.ones(wanted.shape)
        if self.measure == SCALE:
            return wanted
        power = parse_measure(self.measure).power
        assert power is not None
        ratio = wanted / self.intensities(self.measure, sample, record, level, 1.0)
        return np.asarray(ratio if power == 1 else ratio ** (1 / power))


V_IMP = "v_imp"
ORIGIN = ("magnitude", "distance")
"""Fields of a record's earthquake that are stored beside its measures, for the test of residuals."""


def complete(
    plan: Plan,
    study: Study,
    motions: KeptMotions,
    asked: Iterable[str],
    told: Callable[[int], None] = lambda count: None,
    *,
    origins: bool = False,
) -> Plan:
    """Return a plan with all values that some measures need; values that are known are not measured again.

    Parameters
    ----------
    plan : Plan
        All runs, with what was measured for them.
    study : Study
        The study.
    motions : KeptMotions
        The motions of the plan's records.
    asked : iterable of str
        Names of the measures; the factor on the records is ignored.
    told : callable, optional
        Called with the number of records measured since the last call.
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
    plan = _with_samples(plan, study, measures)
    bases = {str(each.base): each.base for each in measures if each.base is not None}
    of_run = {str(each): each for each in measures if isinstance(each, RunMeasure)}
    if (base := plan.base) is not None:
        bases[str(base)] = base
    names = [name for name in bases if name not in (PGA, PGV)] + list(ORIGIN if origins else ())
    new = {name: _copied(plan.measured.of_record, name, len(plan.records)) for name in names}
    samples, records, _, levels, _ = plan.shape
    runs = {name: _copied(plan.measured.of_run, name, samples, records, levels) for name in of_run}
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
                if np.isnan(values[plan.usable_samples, k]).any():
                    values[:, k] = _of_runs(plan, of_run[name], motions, k)
    return replace(plan, measured=replace(plan.measured, of_run={**plan.measured.of_run, **runs}))


def _copied(known: Mapping[str, Reals], name: str, *shape: int) -> Reals:
    """Return a copy of the known values of a name, or an array of NaN."""
    return np.array(known[name]) if name in known else np.full(shape, np.nan)


def _with_samples(plan: Plan, study: Study, measures: Sequence[Measure]) -> Plan:
    """Return a plan with the velocity steps that just overturn the samples, if a measure needs them."""
    if not any(V_IMP in each.needs for each in measures):
        return plan
    values = _copied(plan.measured.of_sample, V_IMP, len(plan.trials))
    for k, (trial, sample) in enumerate(zip(plan.trials, study.samples, strict=True)):
        if trial.reason is None and np.isnan(values[k]):
            with suppress(NoEquivalentBlock):
                values[k] = weaker_block(equivalent_block(sample.mechanism), study.definition.model).v_imp
    return replace(plan, measured=replace(plan.measured, of_sample={**plan.measured.of_sample, V_IMP: values}))


def _without_unscalable(plan: Plan) -> Plan:
    """Return a plan with a reason at each record that no factor scales to the levels."""
    if (base := plan.base) is None:
        return plan
    values = plan.of_records(str(base))
    why = f"its {base} is not above zero: it cannot be scaled to levels of {plan.measure}"
    records = [
        record if record.reason is not None or value > 0 else replace(record, reason=f"{record.name}: {why}")
        for record, value in zip(plan.records, values, strict=True)
    ]
    known = dict(plan.measured.of_record)
    if str(base) in known:  # remove the value, so that it is measured again once the record is corrected
        known[str(base)] = np.where(values > 0, values, nan)
    return replace(plan, records=records, measured=replace(plan.measured, of_record=known))


def _of_runs(plan: Plan, measure: RunMeasure, motions: KeptMotions, k: int) -> Reals:
    """Return a measure of the runs of a record, shape (samples, levels); equal samples are computed once."""

    @cache
    def value(factor: float, *structure: float) -> float:
        return measure.value(motions[k].of_ground.scaled(factor), Reference(*structure))

    values = np.full((len(plan.trials), len(plan.levels)), nan)
    usable = np.broadcast_to(plan.usable_samples[:, None], values.shape)
    sample, level = np.nonzero(usable)
    factors, of = plan.factors(sample, np.full_like(sample, k), level), plan.reference(sample)
    numbers = np.column_stack([factors, of.p, of.lambda_, of.gravity, of.v_imp])
    values[usable] = [value(*each) for each in numbers.tolist()]
    return values
