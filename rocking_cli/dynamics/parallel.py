"""Work in threads, which run in parallel because kernels release the interpreter lock, or else in processes."""

from __future__ import annotations

import functools
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from contextvars import copy_context  # messages of threads name arguments as they were given
from typing import TYPE_CHECKING, Any

from rocking_cli.errors import Refused

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController


@contextmanager
def matrices_by_one_thread() -> Iterator[None]:
    """Have matrices worked on by one thread: they are small, and threads wait for each other on busy cores."""
    with_scipy = "scipy.linalg" in sys.modules  # scipy brings a library of its own
    with _libraries_of_matrices(with_scipy).limit(limits=1, user_api="blas"):
        yield


@functools.cache
def _libraries_of_matrices(with_scipy: bool) -> ThreadpoolController:
    """Return the loaded libraries for matrices, which takes a millisecond to find."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


def in_parts(
    work: Callable[[int, int], object],
    count: int,
    size: int,
    threads: int | None,
    progress: Callable[[int], None] | None,
) -> None:
    """Do many tasks of one kind in threads, several tasks in each part.

    Parameters
    ----------
    work : callable
        Function (first, stop) that does the tasks from `first` to before `stop`.
    count : int
        Number of tasks.
    size : int
        Largest number of tasks in a part.
    threads : int, optional
        Number of threads; by default, one for each processor.
    progress : callable, optional
        Called with the number of tasks done since the last call.
    """
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        parts = {
            pool.submit(copy_context().run, work, first, min(first + size, count)): min(size, count - first)
            for first in range(0, count, size)
        }
        try:
            for part in as_completed(parts):
                part.result()
                if progress is not None:
                    progress(parts[part])
        except BaseException:  # after an interrupt, no further part is started
            pool.shutdown(cancel_futures=True)
            raise


MAX_PROCESSES = 8  # largest number of processes: each takes some 200 MB of memory
ENDED = (
    "the system ended a process of this work: is there enough memory? "
    'A script that starts processes requires `if __name__ == "__main__":`'
)

_work: Callable[[int, int], Any] | None = None


def in_processes(work: Callable[[int, int], Any], count: int, size: int, processes: int) -> Iterator[tuple[int, Any]]:
    """Do many tasks of one kind in processes, several tasks in each part.

    Parameters
    ----------
    work : callable
        Function (first, stop) that does the tasks from `first` to before `stop` and returns their result. It is sent to
        every process once.
    count : int
        Number of tasks.
    size : int
        Largest number of tasks in a part.
    processes : int
        Number of processes.

    Yields
    ------
    (int, object)
        The first task of a part that is done, and the result of this part.

    Raises
    ------
    Refused
        If the system ended a process.
    """
    # Every command with a history imports this module, and only surveys use processes.
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import get_context

    # A spawned process inherits no threads or locks.
    pool = ProcessPoolExecutor(processes, get_context("spawn"), begin, (work,))
    try:
        parts = {pool.submit(_part, first, min(first + size, count)): first for first in range(0, count, size)}
        for part in as_completed(parts):
            yield parts.pop(part), part.result()
    except BrokenProcessPool:
        raise Refused(ENDED) from None
    finally:
        pool.shutdown(cancel_futures=True)


def begin(work: Callable[[int, int], Any] | None = None) -> None:
    """Prepare a process before its first part of the work."""
    global _work
    _work = work
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent process ends this one
    sys.stdout = sys.stderr  # plugins may print
    warnings.simplefilter("ignore")  # the parent process issues each warning once
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    from multiprocessing import parent_process

    if (parent := parent_process()) is not None:
        parent.join()
        os._exit(1)


def _part(first: int, stop: int) -> Any:
    assert _work is not None
    with matrices_by_one_thread():
        return _work(first, stop)
