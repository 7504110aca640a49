"""Units of work of a study, and who simulates them on any machine: the processors of this one, or a cluster."""

from __future__ import annotations

import logging
import os
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace
from functools import cache
from math import ceil, isnan
from multiprocessing import get_context
from threading import Lock
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from rocking_cli import __version__
from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.dynamics.parallel import ENDED, MAX_PROCESSES, begin
from rocking_cli.errors import InputError, Problem, Refused, RockingError, SolverError, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.questions.fragility.definition import SLIDING, Definition
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.store import COLUMNS, CONTINUE_HINT, FAILED, OFF_EDGE, UNKNOWN, RunRows
from rocking_cli.questions.fragility.study import KeptMotions, Sample, Study
from rocking_cli.structure import Structure, with_restitution
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.engines import EngineName, engine_of

if TYPE_CHECKING:
    import distributed


A = TypeVar("A")
B = TypeVar("B")
UNITS_PER_WORKER = 2  # units for each worker: one at work, one waiting
MAX_LOST_WORKERS = 5  # workers lost with the same unit, before the study gives up
CHECK_INTERVAL = 20.0  # s without a finished unit, after which the workers are checked
SCHEDULER_TIMEOUT = 10.0  # s to wait for an answer of the scheduler


@dataclass(frozen=True)
class Workers:
    """An executor of functions, with the number of calls that it runs at a time.

    Parameters
    ----------
    executor : concurrent.futures.Executor
        The executor.
    count : callable
        Returns the number of calls that it runs at a time, which may change: workers of a cluster come and go.
    still_there : callable
        Called if no call has finished for a while; raises if none ever will.
    """

    executor: Executor
    count: Callable[[], int]
    still_there: Callable[[], None] = lambda: None

    def map(self, function: Callable[[A], B], items: Iterable[A]) -> Iterator[B]:
        """Yield the results of a function for each item as they finish; items are taken as there is room for them."""
        on_the_way: set[Future[B]] = set()
        try:
            for item in items:
                on_the_way.add(self.executor.submit(function, item))
                while len(on_the_way) >= UNITS_PER_WORKER * self.count():
                    on_the_way = yield from self._finished(on_the_way)
            while on_the_way:
                on_the_way = yield from self._finished(on_the_way)
        finally:  # after an error or an interrupt, no further unit starts
            for each in on_the_way:
                each.cancel()

    def _finished(self, on_the_way: set[Future[B]]) -> Generator[B, None, set[Future[B]]]:
        """Yield the next finished results; return the calls that are still running."""
        done, rest = wait(on_the_way, CHECK_INTERVAL, return_when=FIRST_COMPLETED)
        if not done:
            self.still_there()
        yield from (each.result() for each in done)
        return rest


@contextmanager
def threads(jobs: int | None = None) -> Iterator[Workers]:
    """Provide the processors of this machine as workers: the history kernel releases the interpreter to other threads.

    Parameters
    ----------
    jobs : int, optional
        Number of threads; by default one for each processor.
    """
    workers = jobs or os.cpu_count() or 1
    with ThreadPoolExecutor(workers) as executor:
        yield Workers(executor, lambda: workers)


@contextmanager
def processes(jobs: int | None = None) -> Iterator[Workers]:
    """Provide processes of this machine as workers, for work that holds the interpreter, as that of free blocks.

    Parameters
    ----------
    jobs : int, optional
        Number of processes; by default one for each processor, up to 8.

    Raises
    ------
    Refused
        If the system ended a process.
    """
    workers = jobs or min(os.cpu_count() or 1, MAX_PROCESSES)
    pool = ProcessPoolExecutor(workers, get_context("spawn"), begin)
    try:
        yield Workers(pool, lambda: workers)
    except BrokenProcessPool:
        raise Refused(ENDED) from None
    finally:
        pool.shutdown(cancel_futures=True)


class ClusterError(RockingError):
    """A cluster that does not answer, or lost its workers."""

    exit_code = 1


@contextmanager
def cluster(scheduler: str | distributed.Client) -> Iterator[Workers]:
    """Provide the workers of a dask.distributed cluster.

    Parameters
    ----------
    scheduler : str or distributed.Client
        Address of the scheduler, such as tcp://host:8786; or a client of it, which stays open.

    Raises
    ------
    InputError
        If dask.distributed is not installed.
    ClusterError
        If the scheduler does not answer, has no workers, or these have another version of this package.
    """
    try:
        import distributed
    except ImportError:
        raise InputError("a cluster needs dask.distributed: pip install 'rocking-cli[cluster]'") from None
    given = scheduler if isinstance(scheduler, distributed.Client) and not scheduler.asynchronous else None
    if given is None and not isinstance(scheduler, str):
        what = f"must be an address, or a synchronous Client of dask.distributed, got {type(scheduler).__name__}"
        raise InputError(Problem(what, field=named("scheduler")))
    address = str(scheduler) if given is None else str(given.scheduler.address)  # type: ignore[union-attr]
    try:
        with _quiet(), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph")  # large units are intended
            with _client(address) if given is None else nullcontext(given) as client:
                _check_workers(client, address)

                def count() -> int:
                    return sum(client.nthreads().values())

                def still_there() -> None:
                    if not count():
                        raise ClusterError(f"the cluster at {address} has no workers left: {CONTINUE_HINT}")

                yield Workers(client.get_executor(pure=False, retries=MAX_LOST_WORKERS), count, still_there)
    except (CancelledError, OSError, distributed.KilledWorker) as error:
        reason = str(error) or "its scheduler does not answer any more"
        raise ClusterError(f"the cluster at {address} was lost ({reason}): {CONTINUE_HINT}") from error


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep dask from printing its own tracebacks, as errors are reported once by this package."""
    logs = [logging.getLogger(name) for name in ("distributed", "distributed.client", "tornado.application")]
    levels = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for log, level in zip(logs, levels, strict=True):
            log.setLevel(level)


def _client(address: str) -> distributed.Client:
    import distributed

    try:
        return distributed.Client(address, timeout=SCHEDULER_TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise ClusterError(f"no scheduler answers at {address}: {error}") from None


def _check_workers(client: distributed.Client, address: str) -> None:
    """Raise `ClusterError` if a cluster has no workers, or some with another version."""
    try:
        client.wait_for_workers(1, timeout=SCHEDULER_TIMEOUT)
    except TimeoutError:
        what = f"the scheduler at {address} has no workers: start one with `dask worker {address}`"
        raise ClusterError(what) from None
    for worker, version in client.run(_version, on_error="return").items():
        if version != __version__:
            sentence = f"has rocking-cli {version}" if isinstance(version, str) else f"cannot run it ({version})"
            raise ClusterError(f"the worker {worker} {sentence}; this is {__version__}: install the same on all")


def _version() -> str:
    from rocking_cli import __version__

    return __version__


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
