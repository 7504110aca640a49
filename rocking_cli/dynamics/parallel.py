"""Work in threads, which run in parallel because kernels release the interpreter lock."""

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
