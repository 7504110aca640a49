"""Work in processes of their own: where it is Python that takes the time, threads wait for one another."""

from __future__ import annotations

import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context, parent_process
from typing import Any

from rocking_cli.errors import Refused

MOST = 8  # processes: each has the program in memory, some 200 MB

_work: Callable[[int, int], Any] | None = None


def in_processes(work: Callable[[int, int], Any], count: int, size: int, processes: int) -> Iterator[tuple[int, Any]]:
    """Do many things of one kind, so many at a time, each in a process of its own.

    Parameters
    ----------
    work : callable
        Does those from a number to before another, and gives what is found. It is sent to every process once.
    count : int
        How many there are.
    size : int
        Of a part, at most.
    processes : int
        Parts at a time.

    Yields
    ------
    (int, object)
        The first of a part that is done, and what was found.

    Raises
    ------
    Refused
        If the system ended a process.
    """
    # Whatever threads and locks there are here, a process begins without them.
    pool = ProcessPoolExecutor(processes, get_context("spawn"), _begin, (work,))
    try:
        parts = {pool.submit(_part, first, min(first + size, count)): first for first in range(0, count, size)}
        for part in as_completed(parts):
            yield parts.pop(part), part.result()
    except BrokenProcessPool:
        raise Refused("the system ended a process of this work: is there enough memory?") from None
    finally:
        pool.shutdown(cancel_futures=True)


def _begin(work: Callable[[int, int], Any]) -> None:
    """What a process does before its first part."""
    global _work
    _work = work
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the one that began it ends it
    sys.stdout = sys.stderr  # plugins print
    warnings.simplefilter("ignore")  # issued once, where the work was requested
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    if (parent := parent_process()) is not None:
        parent.join()
        os._exit(1)


def _part(first: int, stop: int) -> Any:
    assert _work is not None
    return _work(first, stop)
