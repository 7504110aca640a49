"""Run a study: read its records and structures, and simulate the runs that its store lacks."""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields, replace
from importlib.metadata import version
from itertools import chain
from math import isclose, isnan, nan
from typing import Any

import numpy as np

from rocking_cli import __version__
from rocking_cli.arrays import Bools, Integers
from rocking_cli.core import Mechanism, NoEquivalentBlock, both_statics, equivalent_block
from rocking_cli.core.mechanism import why_none
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics.model import NO_REBOUND, check_elements
from rocking_cli.errors import InputError, Problem, RockingError, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.intensity import all_measures, parse_measure
from rocking_cli.questions.fragility.definition import Definition
from rocking_cli.questions.fragility.plan import Measured, Plan, Trial, complete, described, weaker
from rocking_cli.questions.fragility.store import NO_RUNS, DamagedFile, RunRows, Store
from rocking_cli.questions.fragility.study import KeptMotions, Sample, Study, digest
from rocking_cli.questions.fragility.tally import UPLIFT_FACT, accelerations, rotations, samples_of
from rocking_cli.questions.fragility.workers import Workers, WorkUnit, carry_out, runs_per_chunk, unit_of
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import EngineName
from rocking_cli.studies.engines.scene import engine_version
from rocking_cli.studies.fragility.quantities import ROTATIONS_FACT, displacement_limits
from rocking_cli.text import in_short

Progress = Callable[[int, int], None]
"""Called with the numbers of runs that have finished and failed since the last call."""
PARAMETER_TOLERANCE = 1e-9  # relative difference between machines of parameters from the same mechanics
MAX_NAMED_CHANGES = 10  # changed samples that an error message names
Examined = Callable[[int], None]
Share = tuple[int, int]
"""Which part of the chunks of a study, counted from 1, and of how many parts."""
WHOLE: Share = (1, 1)
SIMULATED_BY: dict[EngineName, tuple[EngineName, ...]] = {
    "exact": ("exact",), "blocks": ("blocks",), "auto": ("exact", "blocks"),
}  # fmt: skip
"""The engines that simulate the runs of a study, one after the other: the second those that the first leaves."""


@dataclass(frozen=True)
class Prepared:
    """A study and its store, ready to run.

    Parameters
    ----------
    study : Study
        The study.
    plan : Plan
        The plan of its runs.
    motions : KeptMotions
        Its ground motions.
    store : Store
        The folder with its runs.
    mended : tuple of str
        Names of records that could not be used when the study was started, and now can.
    """

    study: Study
    plan: Plan
    motions: KeptMotions
    store: Store
    mended: tuple[str, ...]


def prepare(
    study: Study, store: Store, examined: Examined = lambda count: None, *, rank_measures: bool = False
) -> Prepared:  # fmt: skip
    """Read the records and structures of a study, and start its store or check the study against it.

    Parameters
    ----------
    study : Study
        The study.
    store : Store
        Open to write.
    examined : callable, optional
        Called with the number of records and structures examined since the last call.
    rank_measures : bool
        Whether to compute and store the values of all installed measures, and not only of those that the study
        requests.

    Raises
    ------
    InputError
        If anything on which the runs depend has changed since the store was started; the error lists every change. If
        no structure or no record can be used.
    """
    known = store.plan if not store.empty else None
    plan, motions = examine_study(study, examined, known)
    definition, records = study.definition, plan.records
    bad = {each.name for each in known.records if each.reason is not None} if known is not None else set()
    mended = tuple(each.name for each in records if each.reason is None and each.name in bad)
    description = study.description()
    facts: dict[str, Any] = {"description": description, "versions": versions(study), "hash": digest(description)}
    if known is None:
        _refuse_useless(plan)
        libraries = {"python": platform.python_version(), **{name: version(name) for name in ("numpy", "scipy")}}
        facts |= {"libraries": libraries, "runs_per_chunk": runs_per_chunk(plan, definition)}
    else:
        _refuse_changes(store, facts, known, plan)
    every = [str(each) for each in all_measures()] if rank_measures else []
    plan = complete(plan, study, motions, [*definition.asked_measures, *every], examined, origins=rank_measures)
    facts |= {
        "name": study.name,
        "definition": definition.model_dump(mode="json", exclude_unset=True, by_alias=True),
        # Plain data, so that the store does not depend on the file.
        "hazard": study.hazard and [study.hazard.intensity.tolist(), study.hazard.annual_rate.tolist()],
        "weights": study.weights,
        UPLIFT_FACT: accelerations(study, plan),
    }
    if limits := displacement_limits(definition.limit_states):
        facts[ROTATIONS_FACT] = rotations(study.samples, plan.trials, limits, store.facts.get(ROTATIONS_FACT, {}))
    if store.started_meanwhile():
        return prepare(study, store, rank_measures=rank_measures)
    store.keep(plan, facts)
    return Prepared(study, plan, motions, store, mended)


def examine_study(
    study: Study, tell: Examined = lambda count: None, known: Plan | None = None
) -> tuple[Plan, KeptMotions]:
    """Examine the records and structures of a study.

    Parameters
    ----------
    study : Study
        The study.
    tell : callable, optional
        Called with the number of records and structures examined since the last call.
    known : Plan, optional
        The plan in the store: for records that could be used, only the checksum is computed again.

    Returns
    -------
    plan : Plan
        All runs.
    motions : KeptMotions
        The ground motions; those that were read stay in memory as far as there is room.
    """
    before = {each.name: each for each in known.records} if known is not None else {}
    motions = KeptMotions(study.sources)
    records, trials = [], []
    for k, source in enumerate(study.sources):
        records.append(motions.examine(k, before.get(source.name)))
        tell(1)
    for sample in study.samples:
        trials.append(_trial(study, sample))
        tell(1)
    asked, levels, sets = study.definition, study.definition.levels, described(study.description(), study.weights)
    etas = asked.restitution or [nan]
    plan = Plan(trials, records, etas, levels.measure, levels.levels(), asked.polarities, Measured(), sets)
    if known is not None and known.axes == plan.axes:
        plan = replace(plan, measured=known.measured)
    return complete(plan, study, motions, ()), motions


@dataclass(frozen=True)
class Left:
    """The chunks that a store lacks, wholly or in part.

    Parameters
    ----------
    chunks : list of int
        Their numbers.
    finished, failed : int
        Number of runs that the store has of all chunks, and of those among them that could not be simulated.
    total : int
        Number of all runs.
    """

    chunks: list[int]
    finished: int
    failed: int
    total: int


def left(
    prepared: Prepared, engine: EngineName, share: Share = WHOLE, damaged: Callable[[str], None] = lambda file: None
) -> Left:  # fmt: skip
    """Return what is left to simulate by one engine.

    Parameters
    ----------
    prepared : Prepared
        The result of `prepare`.
    engine : {"exact", "blocks"}
        The engine. In a study by both, runs of unknown outcome by one degree of freedom are left to free blocks.
    share : (int, int)
        Which part of the chunks, and of how many parts.
    damaged : callable, optional
        Called with each file that is damaged; its runs are left.
    """
    chunks, finished, failed, total = [], 0, 0, 0
    for k in prepared.store.chunks[share[0] - 1 :: share[1]]:
        rows, numbers = _lacking(prepared, k, engine, damaged)
        if numbers.size:
            chunks.append(k)
        final = rows.select(_is_final(prepared, rows))
        finished, failed = finished + len(final), failed + final.failed
        total += numbers.size + len(rows if engine == "exact" else final)
    return Left(chunks, finished, failed, total)


def run(prepared: Prepared, workers: Workers, engine: EngineName, chunks: Iterable[int], progress: Progress) -> None:
    """Simulate what chunks lack by one engine, and add it to the store.

    Parameters
    ----------
    prepared : Prepared
        The result of `prepare`.
    workers : Workers
        The processes or threads that simulate; results do not depend on them.
    engine : {"exact", "blocks"}
        Who simulates.
    chunks : iterable of int
        Numbers of the chunks.
    progress : callable
        See `Progress`.
    """
    store, study, plan = prepared.store, prepared.study, prepared.plan

    def units() -> Iterator[WorkUnit]:
        for k in chunks:
            rows, numbers = _lacking(prepared, k, engine)
            if numbers.size:
                yield unit_of(numbers, plan, study, store.facts["hash"], prepared.motions, engine)
            else:  # another process has been faster
                progress(len(rows), rows.failed)

    for rows in workers.map(carry_out, units()):
        store.add(rows)
        final = rows.select(_is_final(prepared, rows))
        progress(len(final), final.failed)


def _lacking(
    prepared: Prepared, k: int, engine: EngineName, damaged: Callable[[str], None] = lambda file: None
) -> tuple[RunRows, Integers]:  # fmt: skip
    """Return the runs of a chunk in the store, and the numbers of those that an engine still has to simulate."""
    try:
        rows = prepared.store.chunk(k)
    except DamagedFile as file:
        damaged(str(file))
        rows = NO_RUNS
    done = rows.run if engine == "exact" else rows.run[_is_final(prepared, rows)]
    return rows, np.setdiff1d(prepared.plan.numbers(*prepared.store.ends(k)), done, assume_unique=True)


def _is_final(prepared: Prepared, rows: RunRows) -> Bools:
    """Return which runs are finished, and not left to free blocks."""
    return ~rows.unknown | rows.by_blocks | (prepared.study.definition.engine == "exact")


def left_of_each(prepared: Prepared, chunks: Iterable[int]) -> Iterator[tuple[str, Structure, GroundMotion, int]]:
    """Yield each structure, one of its samples, a motion of usual length, and how many runs are left to free blocks."""
    plan = prepared.plan
    durations = sorted((each.dt * each.npts, k) for k, each in enumerate(plan.records) if each.reason is None)
    motion = prepared.motions[durations[len(durations) // 2][1]]
    each = np.zeros(len(plan.trials), dtype=np.int64)
    for k in chunks:
        each += np.bincount(plan.places(_lacking(prepared, k, "blocks")[1])[0], minlength=each.size)
    for name in plan.structures:
        samples = samples_of(plan, name)
        if count := int(each[samples.start : samples.stop].sum()):
            first = samples[int(np.flatnonzero(each[samples.start : samples.stop])[0])]
            yield name, Structure(prepared.study.samples[first].mechanism), motion, count


def versions(study: Study) -> dict[str, str]:
    """Return the versions of this program, of the packages of the structures' mechanisms, and of the free blocks."""
    registry = Registry()
    plugins = {f"mechanism {each.mechanism}": registry.package_of(each.mechanism) for each in study.structures}
    blocks = {"mujoco": engine_version()} if study.definition.engine != "exact" else {}
    return {"rocking-cli": __version__, **plugins, **blocks}


def _trial(study: Study, sample: Sample) -> Trial:
    mechanism, asked = sample.mechanism, study.definition
    start = (mechanism.name or mechanism.mechanism, sample.number, sample.drawn)
    try:
        if asked.model == "nonlinear":
            check_elements(mechanism)
        mechanics = _mechanics(mechanism, asked)
        least = min(mechanism.eta(side) for side in mechanism.directions)
        if asked.restitution is None and isnan(least):
            raise InputError(NO_REBOUND)
        if asked.restitution is None and mechanism.rocks_both_ways and least <= 0:
            raise InputError(f"its kinematics give a restitution of {least:.4g}: {why_none(least)}")
    except RockingError as error:
        return Trial(*start, str(error))
    return Trial(*start, None, *mechanics)


def _mechanics(mechanism: Mechanism, asked: Definition) -> tuple[float, float, float, float, float]:
    """Return p, lambda, gravity and the reference rotations of a structure, with or without an equivalent block.

    Raises `NoEquivalentBlock` if there is none and the study needs one.
    """
    try:
        block = equivalent_block(mechanism)
    except NoEquivalentBlock as error:
        needs = [f"the model {asked.model}"] if asked.model != "nonlinear" else []
        needs = needs or [name for name in asked.asked_measures if parse_measure(name).needs]
        if needs:
            raise NoEquivalentBlock(f"{' and '.join(needs)} cannot be had of it: {error}") from error
        sides = both_statics(mechanism)
        return 0.0, min(side.lambda_ for side in sides), mechanism.gravity, sides[0].reference, sides[1].reference
    return *weaker(block, asked.model), mechanism.gravity, block.positive.phi_cr, block.negative.phi_cr


def _refuse_useless(plan: Plan) -> None:
    for what, those in (("structure", plan.trials), ("record", plan.records)):
        if all(each.reason is not None for each in those):
            reasons = dict.fromkeys(each.reason or "" for each in those)
            raise InputError(*(Problem(f"no {what} can be used: {reason}") for reason in list(reasons)[:10]))


def _refuse_changes(store: Store, facts: dict[str, Any], known: Plan, now: Plan) -> None:
    """Raise `InputError` with every difference between the study in the store and the present one."""
    changes = [*differences(store.facts["description"], facts["description"])]
    changes += [f"version of {package}" for package in differences(store.facts["versions"], facts["versions"])]
    checksums = {each.name: each.checksum for each in known.records if each.reason is None}
    changed = [each.name for each in now.records if checksums.get(each.name, each.checksum) != each.checksum]
    changes += [f"the record {name} has changed, or cannot be read any more" for name in changed]
    if not changes:  # fields are equal, but the mechanism may derive other parameters from them
        changes = [*chain.from_iterable(map(_other_mechanics, known.trials, now.trials))][:MAX_NAMED_CHANGES]
    if changes:
        hint = f"give {named('restart')} to run everything again, or {named('store')} OTHER to keep both"
        *others, last = [Problem(change, field="changed since the store was created") for change in changes]
        raise InputError(*others, replace(last, hint=hint))


def _other_mechanics(before: Trial, now: Trial) -> list[str]:
    """Return sentences on parameters that a mechanism of the same version and fields computes otherwise than before."""
    name = f"sample {now.number} of {now.structure}"
    if (before.reason is None) != (now.reason is None):
        return [f"{name} {'can be run now' if now.reason is None else f'cannot be run any more: {now.reason}'}"]
    pairs = {each.name: (getattr(before, each.name), getattr(now, each.name)) for each in fields(Trial)}
    pairs |= {f"drawn {key}": (value, now.drawn.get(key, nan)) for key, value in before.drawn.items()}
    return [
        f"{key.rstrip('_')} of {name} was {old:.10g}, is now {new:.10g}"
        for key, (old, new) in pairs.items()
        if isinstance(old, float) and not isclose(old, new, rel_tol=PARAMETER_TOLERANCE)
    ]


def differences(before: Any, now: Any, where: str = "") -> list[str]:
    """Return sentences on the places where two pieces of plain data differ, with both values."""
    if isinstance(before, dict) and isinstance(now, dict):
        pairs = [(f"{where}.{key}".lstrip("."), before.get(key), now.get(key)) for key in {**before, **now}]
    elif isinstance(before, list) and isinstance(now, list):
        if len(before) != len(now):
            gone = [_one(each) for each in before if each not in now]
            new = [_one(each) for each in now if each not in before]
            parts = [f"{word} {in_short(those, most=3)}" for word, those in (("without", gone), ("with", new)) if those]
            return [f"{where} is now {' and '.join(parts) or 'another number of the same'}"]
        pairs = [(f"{where}[{k}]", *pair) for k, pair in enumerate(zip(before, now, strict=True), 1)]
    elif isinstance(before, float) and isinstance(now, float) and isclose(before, now, rel_tol=PARAMETER_TOLERANCE):
        return []
    else:
        return [] if before == now else [f"{where} was {_one(before)}, is now {_one(now)}"]
    inside = [difference for place, one, other in pairs for difference in differences(one, other, place)]
    if len(inside) > 1 and all(isinstance(each, int | float) for each in (*before, *now)):
        ends = [f"{len(values)} numbers from {min(values)} to {max(values)}" for values in (before, now)]
        return [f"{where} was {ends[0]}, is now {ends[1]}"]
    return inside


def _one(value: Any) -> str:
    """Return a value in words, an entry with a name by it."""
    if isinstance(value, dict):
        return str(value.get("name", value))
    return "absent" if value is None else str(value)
