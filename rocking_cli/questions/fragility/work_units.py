"""Units of work of a study: runs of one chunk with all that is needed to simulate them on any machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import ceil, isnan
from threading import Lock

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.questions.fragility.definition import SLIDING, Definition
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.sources import KeptMotions
from rocking_cli.questions.fragility.store import COLUMNS, FAILED, OFF_EDGE, UNKNOWN, RunRows
from rocking_cli.questions.fragility.study import Sample, Study
from rocking_cli.structure import Structure, with_restitution
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.engines import EngineName, engine_of

LEAST_RUNS = 64  # runs of a chunk: some 10 ms of work, against 3 ms for handing it out and writing it
MOST_RUNS: dict[EngineName, int] = {"exact": 4096, "auto": 16, "blocks": 2}  # free blocks take seconds a run
MOST_CHECKED_RUNS = 256  # runs of a chunk that is checked for sliding: each run takes some ms
CHUNKS = 256  # chunks of a study of usual size, so that all workers end together
MOST_RECORDS = 100  # of a chunk: some 4 million samples, 64 megabytes
MAX_MODELS = 16  # models in memory at a time: some 30 megabytes, 120 for arches


def runs_per_chunk(plan: Plan, definition: Definition) -> int:
    """Return the number of runs of a chunk, which depends on nothing but the study."""
    most = MOST_CHECKED_RUNS if SLIDING in definition.limit_states else MOST_RUNS[definition.engine]
    return min(most, max(LEAST_RUNS, ceil(plan.size / CHUNKS)), MOST_RECORDS * plan.block)


@dataclass(frozen=True, eq=False)
class WorkUnit:
    """Runs of a chunk, with their structures and ground motions.

    Parameters
    ----------
    id : ndarray of int
        Numbers of the runs in the study, increasing.
    runs : Runs
        The runs; their models and records are indices into the tuples below.
    study : str
        Digest of the study, which tells its models from those of others.
    samples : tuple of Sample
        The structures.
    motions : tuple of GroundMotion
    definition : Definition
        The study: equation of motion, opening, and whether runs are checked for sliding.
    engine : {"exact", "blocks"}
        Who simulates the runs.
    """

    id: Integers
    runs: Runs
    study: str
    samples: tuple[Sample, ...]
    motions: tuple[GroundMotion, ...]
    definition: Definition
    engine: EngineName = "exact"


def unit_of(
    runs: Integers, plan: Plan, study: Study, digest: str, motions: KeptMotions, engine: EngineName
) -> WorkUnit:  # fmt: skip
    """Return the unit of some runs of a study, given by their numbers; other parameters as in `WorkUnit`."""
    sample, record, eta, level, polarity = plan.places(runs)
    those, structure = np.unique(sample, return_inverse=True)
    records, motion = np.unique(record, return_inverse=True)
    samples = tuple(study.samples[k] for k in those)
    etas, drawn = np.array(plan.etas)[eta], np.array([each.eta for each in samples])[structure]
    scale, way = plan.factors(sample, record, level), np.array(plan.polarities)[polarity]
    each = Runs.of(structure, motion, scale=scale, polarity=way, eta=np.where(np.isnan(etas), drawn, etas))
    return WorkUnit(runs, each, digest, samples, tuple(motions[int(k)] for k in records), study.definition, engine)


def carry_out(unit: WorkUnit) -> RunRows:
    """Simulate a unit on one processor; results are the same to the last bit on machines of one kind."""
    most = 1 if unit.engine == "blocks" else MAX_MODELS
    parts = []
    for first in range(0, len(unit.samples), most):
        model = unit.runs.model - first
        those = (model >= 0) & (model < most)
        runs = Runs(**{name: values[those] for name, values in {**vars(unit.runs), "model": model}.items()})
        samples = unit.samples[first : first + most]
        parts.append(_simulated(replace(unit, id=unit.id[those], runs=runs, samples=samples)))
    return RunRows.joined(parts)


def _simulated(unit: WorkUnit) -> RunRows:
    models = [_model(unit, sample) for sample in unit.samples]
    mechanisms = [sample.mechanism for sample in unit.samples]
    start = {"run": unit.id, "scale": unit.runs.scale, "eta": unit.runs.eta}
    never = np.full(len(unit.id), np.nan)
    try:
        engine = engine_of(unit.engine, mechanisms)
        outcomes = engine.outcomes(models, unit.motions, unit.runs, threads=1, only_peaks=True)
    except SolverError:  # as free blocks, the structure does not stand by itself
        every = np.ones(len(unit.id), dtype=bool)
        return RunRows(**{**dict.fromkeys(COLUMNS, never), **start, "outcome": FAILED * every, "by_blocks": every})
    slides, lost = never, outcomes.failed
    if SLIDING in unit.definition.limit_states:
        slides, lost = _slide_times(unit, models, outcomes)
    fell = outcomes.fell_to * np.where(outcomes.off_edge, OFF_EDGE, 1)
    bound = np.where(outcomes.unknown, outcomes.lower_bound, np.nan)
    as_simulated = {name: getattr(outcomes, name) for name in COLUMNS if hasattr(outcomes, name)}
    known = {name: np.where(lost, np.nan, each) for name, each in {**as_simulated, "lower_bound": bound}.items()}
    outcome = np.where(lost, FAILED, np.where(outcomes.unknown, UNKNOWN, fell))
    return RunRows(**{**known, **start, "outcome": outcome, "slide_time": slides, "by_blocks": outcomes.by_blocks})


def _slide_times(unit: WorkUnit, models: Sequence[Model], found: Outcomes) -> tuple[Reals, Bools]:
    """Simulate runs again with samples; return when each first slides [s], and which have no complete history."""
    runs = unit.runs
    times, lost = np.where(found.slip > 0, found.warned, np.nan), found.failed.copy()

    @cache
    def contacts(model: int, eta: float | None) -> Contacts:
        mechanism = unit.samples[model].mechanism
        return Contacts(mechanism if eta is None else with_restitution(mechanism, eta))

    for k in np.flatnonzero(np.isfinite(found.uplift_time) & ~found.failed):  # a structure at rest has nothing to check
        model, eta = int(runs.model[k]), float(runs.eta[k])
        motion = unit.motions[runs.record[k]].scaled(float(runs.scale[k] * runs.polarity[k]))
        try:
            history = follow(models[model], motion, eta=eta)
        except SolverError:
            lost[k] = True
        else:
            times[k] = contacts(model, None if isnan(eta) else eta).check(history, motion).slides
    return times, lost


_MODELS: dict[tuple[object, ...], Model] = {}
"""The last models of this process, for samples that differ only in restitution, and for chunks of one sample."""
_LOCK = Lock()


def _model(unit: WorkUnit, sample: Sample) -> Model:
    asked, key = unit.definition, (unit.study, sample.structure, *sample.geometry)
    with _LOCK:
        if key not in _MODELS:
            while len(_MODELS) >= MAX_MODELS:
                del _MODELS[next(iter(_MODELS))]
            # The restitution is a placeholder that every run replaces, as the kinematics may not give any.
            eta = asked.restitution[0] if asked.restitution else None
            mechanism = sample.mechanism if eta is None else with_restitution(sample.mechanism, eta)
            _MODELS[key] = Structure(mechanism, opening=asked.opening).model(asked.model)
        return _MODELS[key]
