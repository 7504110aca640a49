"""Units of a study: groups of runs with all that is needed to simulate them on any machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, isnan

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.core import Mechanism
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import OPENING
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.sources import KeptMotions
from rocking_cli.questions.fragility.store import COLUMNS, FAILED, OFF_EDGE, UNKNOWN, RunRows
from rocking_cli.questions.fragility.study import Sample
from rocking_cli.structure import Structure, with_restitution
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.engines import EngineName, engine_of

MIN_RUNS, MAX_RUNS = 64, 4096  # runs of a unit: some 10 ms to 1 s of work, against 1 to 10 ms for handing it out
MAX_CHECKED_RUNS = 256  # runs of a unit that is checked for sliding: each run takes some ms
MAX_BLOCK_RUNS = 2  # runs of a unit of free blocks: each run takes seconds
MIN_UNITS_PER_WORKER = 16  # units for each worker, so that all workers end together
MAX_SAMPLES = 4_000_000  # samples of the records of a unit: 64 megabytes
MAX_MODELS = 16  # models of a unit: some 30 megabytes, 120 for arches


@dataclass(frozen=True, eq=False)
class WorkUnit:
    """A group of runs with their models and ground motions.

    Parameters
    ----------
    id : ndarray of int
        Numbers of the runs in the study.
    runs : Runs
        The runs; their models and records are indices into the tuples below.
    models : tuple of Model
    motions : tuple of GroundMotion
    mechanisms : tuple of Mechanism
        The structures of the models if free blocks are simulated or runs are checked for sliding; otherwise empty.
    engine : {"exact", "blocks"}
        Who simulates the runs.
    checked : bool
        Whether the runs are checked for sliding.
    """

    id: Integers
    runs: Runs
    models: tuple[Model, ...]
    motions: tuple[GroundMotion, ...]
    mechanisms: tuple[Mechanism, ...] = ()
    engine: EngineName = "exact"
    checked: bool = False


def carry_out(unit: WorkUnit) -> RunRows:
    """Simulate a unit on one processor; the results are the same to the last bit on every machine.

    Those of free blocks are the same on machines of one kind.
    """
    engine = engine_of(unit.engine, unit.mechanisms)
    try:
        outcomes = engine.outcomes(unit.models, unit.motions, unit.runs, threads=1, only_peaks=True)
    except SolverError:  # as free blocks, the structure does not stand by itself
        missing, each = dict.fromkeys(COLUMNS[4:], np.full(len(unit.id), np.nan)), np.ones(len(unit.id))
        outcome = np.full(len(unit.id), FAILED)
        return RunRows(unit.id, unit.runs.scale, unit.runs.eta, outcome, **missing, by_blocks=each)
    slides = None
    if unit.checked:
        slides, lost = _slide_times(unit, outcomes)
        outcomes = replace(outcomes, failed=outcomes.failed | lost)

    def known(values: Reals) -> Reals:
        return np.where(outcomes.failed, np.nan, values)

    outcome = np.where(outcomes.unknown, UNKNOWN, outcomes.fell_to * np.where(outcomes.off_edge, OFF_EDGE, 1))
    return RunRows(
        id=unit.id,
        scale=unit.runs.scale,
        eta=unit.runs.eta,
        outcome=np.where(outcomes.failed, FAILED, outcome).astype(np.int64),
        peak_ratio=known(outcomes.peak_ratio),
        peak_positive=known(outcomes.peak_positive),
        peak_negative=known(outcomes.peak_negative),
        uplift_time=known(outcomes.uplift_time),
        overturning_time=known(outcomes.overturning_time),
        known_to=known(outcomes.known_to),
        lower_bound=known(np.where(outcomes.unknown, outcomes.lower_bound, np.nan)),
        opening=known(outcomes.opening),
        slip=known(outcomes.slip),
        slide_time=slides,
        by_blocks=outcomes.by_blocks.astype(np.float64),
    )


def _slide_times(unit: WorkUnit, found: Outcomes) -> tuple[Reals, Bools]:
    """Simulate runs again with samples; return when each first slides [s], and which have no complete history."""
    runs = unit.runs
    times, lost = np.where(found.slip > 0, found.warned, np.nan), np.zeros(len(runs), dtype=bool)
    checks: dict[tuple[int, float | None], Contacts] = {}
    for k in np.flatnonzero(np.isfinite(found.uplift_time) & ~found.failed):  # a structure at rest has nothing to check
        model, eta = int(runs.model[k]), float(runs.eta[k])
        restitution = None if isnan(eta) else eta
        if (model, restitution) not in checks:
            mechanism = unit.mechanisms[model]
            checks[model, restitution] = Contacts(
                mechanism if restitution is None else with_restitution(mechanism, restitution)
            )
        motion = unit.motions[runs.record[k]].scaled(float(runs.scale[k] * runs.polarity[k]))
        try:
            history = follow(unit.models[model], motion, eta=eta)
        except SolverError:
            lost[k] = True
        else:
            times[k] = checks[model, restitution].check(history, motion).slides
    return times, lost


def units(
    plan: Plan,
    samples: Sequence[Sample],
    motions: KeptMotions,
    model: ModelName,
    finished: Callable[[int, int], Integers],
    size: int,
    *,
    engine: EngineName = "exact",
    checked: bool = False,
    opening: float = OPENING,
) -> Iterator[WorkUnit]:
    """Yield the runs that are still to be simulated, grouped into units, each made when it is needed.

    Parameters
    ----------
    plan : Plan
        All runs.
    samples : sequence of Sample
        The structures of the plan's trials.
    motions : KeptMotions
        The ground motions of the plan's records.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    finished : callable
        Function (first, stop) that returns the numbers of the finished runs from `first` to before `stop`.
    size : int
        Largest number of runs of a unit.
    engine : {"exact", "blocks"}
        Who simulates them.
    checked : bool
        Whether the runs are checked for sliding.
    opening : float
        Largest opening of a joint up to which a run holds, over D_cr.
    """
    models = _Models(samples, plan.etas, model, opening)
    size = min(size, MAX_CHECKED_RUNS) if checked else size
    most_models = MAX_MODELS
    if engine == "blocks":
        size, most_models = MAX_BLOCK_RUNS, 1
    unit = partial(_unit, plan, models=models, motions=motions, engine=engine, checked=checked)
    waiting: list[Integers] = []
    trials: set[int] = set()
    records: set[int] = set()
    held, npts = 0, 0
    for sample, record, part in _parts(plan, finished, size):
        more = plan.records[record].npts if record not in records else 0
        if waiting and (held + len(part) > size or len(trials | {sample}) > most_models or npts + more > MAX_SAMPLES):
            yield unit(np.concatenate(waiting))
            waiting, trials, records, held, npts = [], set(), set(), 0, 0
            more = plan.records[record].npts
        waiting.append(part)
        trials.add(sample)
        records.add(record)
        held, npts = held + len(part), npts + more
    if waiting:
        yield unit(np.concatenate(waiting))


def _parts(
    plan: Plan, finished: Callable[[int, int], Integers], size: int
) -> Iterator[tuple[int, int, Integers]]:  # fmt: skip
    """Yield the runs to simulate of each sample under each usable record, at most `size` at a time."""
    records, levels = len(plan.records), len(plan.levels)
    there = [np.broadcast_to(plan.of_sets.there(r, levels)[:, None], plan.shape[2:]).ravel() for r in range(records)]
    for k, trial in enumerate(plan.trials):
        if trial.reason is not None:
            continue
        first = k * records * plan.block
        done = np.zeros(records * plan.block, dtype=bool)
        done[finished(first, first + done.size) - first] = True
        for r, record in enumerate(plan.records):
            to_do = np.flatnonzero(~done[r * plan.block : (r + 1) * plan.block] & there[r])
            if record.reason is None:
                for start in range(0, len(to_do), size):
                    yield k, r, first + r * plan.block + to_do[start : start + size]


def unit_size(runs: int, workers: int) -> int:
    """Return the number of runs of a unit, for a number of runs and of workers."""
    return min(max(ceil(runs / (MIN_UNITS_PER_WORKER * workers)), MIN_RUNS), MAX_RUNS)


def _unit(
    plan: Plan, runs: Integers, *, models: _Models, motions: KeptMotions, engine: EngineName, checked: bool
) -> WorkUnit:
    sample, record, eta, level, polarity = plan.places(runs)
    trials, model = np.unique(sample, return_inverse=True)
    records, motion = np.unique(record, return_inverse=True)
    etas = np.array(plan.etas)[eta]
    drawn = np.array([models.samples[k].eta for k in trials])[model]
    return WorkUnit(
        runs,
        Runs.of(
            model,
            motion,
            scale=plan.factors(sample, record, level),
            polarity=np.array(plan.polarities)[polarity],
            eta=np.where(np.isnan(etas), drawn, etas),
        ),
        tuple(models[int(k)] for k in trials),
        tuple(motions[int(k)] for k in records),
        tuple(models.samples[k].mechanism for k in trials) if checked or engine == "blocks" else (),
        engine,
        checked,
    )


class _Models:
    """Models of samples; the last ones are kept, as samples that differ only in restitution share a model."""

    KEPT = 64

    def __init__(self, samples: Sequence[Sample], etas: Sequence[float], name: ModelName, opening: float) -> None:
        self.samples = samples
        self._name, self._opening = name, opening
        self._eta = None if isnan(etas[0]) else etas[0]
        self._kept: dict[tuple[object, ...], Model] = {}

    def __getitem__(self, k: int) -> Model:
        sample = self.samples[k]
        key = (sample.structure, *sample.geometry)
        if key not in self._kept:
            if len(self._kept) == self.KEPT:
                del self._kept[next(iter(self._kept))]
            # The restitution is a placeholder that every run replaces, as the kinematics may not give any.
            mechanism = sample.mechanism if self._eta is None else with_restitution(sample.mechanism, self._eta)
            self._kept[key] = Structure(mechanism, opening=self._opening).model(self._name)
        return self._kept[key]
