"""Workers that simulate the units of a study: the processors of this machine, or a cluster."""

from __future__ import annotations

import logging
import os
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
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
from dataclasses import dataclass
from multiprocessing import get_context
from typing import TYPE_CHECKING, TypeVar

from rocking_cli import __version__
from rocking_cli.dynamics.parallel import ENDED, MAX_PROCESSES, begin
from rocking_cli.errors import InputError, Problem, Refused, RockingError, named
from rocking_cli.questions.fragility.store import CONTINUE_HINT

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
        raise ClusterError(
            f"the scheduler at {address} has no workers: start one with `dask worker {address}`"
        ) from None
    for worker, version in client.run(_version, on_error="return").items():
        if version != __version__:
            sentence = f"has rocking-cli {version}" if isinstance(version, str) else f"cannot run it ({version})"
            raise ClusterError(f"the worker {worker} {sentence}; this is {__version__}: install the same on all")


def _version() -> str:
    from rocking_cli import __version__

    return __version__
