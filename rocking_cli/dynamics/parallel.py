"""Work on the processors of this machine: kernels leave the interpreter to the others."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed


def in_parts(
    work: Callable[[int, int], object],
    count: int,
    size: int,
    threads: int | None,
    progress: Callable[[int], None] | None,
) -> None:
    """Do many things of one kind, so many at a time.

    Parameters
    ----------
    work : callable
        Does those from a number to before another.
    count : int
        How many there are.
    size : int
        Of a part, at most.
    threads : int, optional
        Parts at a time; without it, one for each processor.
    progress : callable, optional
        Called with how many are done since the last call.
    """
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        parts = {
            pool.submit(work, first, min(first + size, count)): min(size, count - first)
            for first in range(0, count, size)
        }
        try:
            for part in as_completed(parts):
                part.result()
                if progress is not None:
                    progress(parts[part])
        except BaseException:  # an interrupt: what has not begun is not begun
            pool.shutdown(cancel_futures=True)
            raise
