"""Where the units of a study are run: on the processors of this machine, or on a cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

from rocking_cli import __version__
from rocking_cli.errors import InputError, RockingError

A = TypeVar("A")
B = TypeVar("B")
AHEAD = 2  # units on their way for each worker: one at work, one that waits
TRIES = 5  # workers that may be lost with a unit before it is given up
PATIENCE = 10.0  # s for an answer of the scheduler


@dataclass(frozen=True)
class Engine:
    """Something that runs functions, so many at a time."""

    executor: Executor
    workers: int

    def map(self, function: Callable[[A], B], items: Iterable[A]) -> Iterator[B]:
        """What a function makes of each item, as they are finished; items are taken as there is room for them."""
        on_the_way: set[Future[B]] = set()
        try:
            for item in items:
                on_the_way.add(self.executor.submit(function, item))
                if len(on_the_way) >= AHEAD * self.workers:
                    done, on_the_way = wait(on_the_way, return_when=FIRST_COMPLETED)
                    yield from (each.result() for each in done)
            while on_the_way:
                done, on_the_way = wait(on_the_way, return_when=FIRST_COMPLETED)
                yield from (each.result() for each in done)
        finally:  # an error or an interrupt: what has not begun is not begun
            for each in on_the_way:
                each.cancel()


@contextmanager
def threads(jobs: int | None = None) -> Iterator[Engine]:
    """The processors of this machine: the history kernel leaves the interpreter to the others.

    Parameters
    ----------
    jobs : int, optional
        How many; without it, all.
    """
    workers = jobs or os.cpu_count() or 1
    with ThreadPoolExecutor(workers) as executor:
        yield Engine(executor, workers)


class ClusterError(RockingError):
    """A cluster that does not answer, or lost its workers."""

    exit_code = 1


@contextmanager
def cluster(address: str) -> Iterator[Engine]:
    """The workers of a dask.distributed cluster.

    Parameters
    ----------
    address : str
        Of its scheduler: tcp://host:8786.

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
    try:
        client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise ClusterError(f"no scheduler answers at {address}: {error}") from None
    with client:
        workers = _threads(client, address)
        try:
            yield Engine(client.get_executor(pure=False, retries=TRIES), workers)
        except (CancelledError, OSError, distributed.KilledWorker) as error:
            raise ClusterError(f"the cluster at {address} was lost: {error}") from error


def _threads(client: object, address: str) -> int:
    """How many units the workers of a cluster run at a time, after making sure that they can."""
    import distributed

    assert isinstance(client, distributed.Client)
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        raise ClusterError(
            f"the scheduler at {address} has no workers: start one with `dask worker {address}`"
        ) from None
    for worker, version in client.run(_version, on_error="return").items():
        if version != __version__:
            said = f"has rocking-cli {version}" if isinstance(version, str) else f"cannot run it ({version})"
            raise ClusterError(f"the worker {worker} {said}; this is {__version__}: install the same on all")
    return sum(client.nthreads().values())


def _version() -> str:
    from rocking_cli import __version__

    return __version__
