"""Compilation of the history kernel: where its machine code is kept, and whether it is there yet.

Numba is imported only when a history is asked for. Its cache must not land beside the installed source, which
may be read-only, so it goes to the user's cache folder unless NUMBA_CACHE_DIR says otherwise.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FunctionType
from typing import Any

import platformdirs


def cache_folder() -> Path:
    """The folder that keeps compiled kernels."""
    return Path(os.environ.get("NUMBA_CACHE_DIR") or platformdirs.user_cache_path("rocking-cli") / "numba")


# A kernel releases the GIL and keeps IEEE arithmetic to the letter: a history that meets a NaN must show it, and a
# record scaled before or inside the kernel must give the same bits.
OPTIONS: dict[str, Any] = {"nogil": True, "fastmath": False, "error_model": "numpy"}


def _start_numba() -> None:
    """Load numba without scipy.linalg, which it asks for only to see whether there is a BLAS: a tenth of a second.

    No kernel calls a BLAS; other code of numba that does still finds it, but for one-dimensional inner products, which
    numba then sums itself. Where other threads may want scipy.linalg at this moment it is left alone.
    """
    if "numba.np.arraymath" in sys.modules or "scipy.linalg" in sys.modules or threading.active_count() > 1:
        return
    sys.modules["scipy.linalg"] = None  # type: ignore[assignment]
    try:
        import numba.np.arraymath  # noqa: F401
    finally:
        del sys.modules["scipy.linalg"]


def compile_inline(function: Callable[..., Any]) -> Any:
    """`function`, set by the compiler into each place of a kernel that calls it: a call costs more than a few sums."""
    _start_numba()
    from numba import njit

    return njit(forceinline=True, **OPTIONS)(function)


def compile_kernel(function: Callable[..., Any]) -> Any:
    """`function` compiled by numba at its first call, and kept on disk where that is possible."""
    _start_numba()
    import numba
    from numba import njit

    config: Any = numba.config

    theirs = config.CACHE_DIR
    try:
        cache_folder().mkdir(parents=True, exist_ok=True)
        config.CACHE_DIR = str(cache_folder())
        return njit(cache=True, **OPTIONS)(function)
    except (OSError, RuntimeError):  # nowhere to write: compile anew in each process
        return njit(**OPTIONS)(function)
    finally:
        config.CACHE_DIR = theirs


def compile_source(
    functions: Sequence[Callable[..., Any]], inline: Sequence[Callable[..., Any]] = ()
) -> dict[str, Any]:
    """Functions of one module that Python can run as they stand, compiled beside it.

    Parameters
    ----------
    functions : sequence of callable
        In an order in which each follows those that it calls.
    inline : sequence of callable
        Those of them to be set into each place that calls them.

    Returns
    -------
    dict of str to callable
        The compiled functions by name; the module keeps its own.
    """
    namespace = dict(vars(sys.modules[functions[0].__module__]))
    for function in functions:
        # The same code, but the names in it mean what is compiled.
        twin = FunctionType(function.__code__, namespace, function.__name__)
        twin.__module__, twin.__qualname__ = function.__module__, function.__qualname__
        namespace[function.__name__] = compile_inline(twin) if function in inline else compile_kernel(twin)
    return {function.__name__: namespace[function.__name__] for function in functions}


HISTORIES, PULSES = "kernels.run", "pulse_motion.many"
"""The kernels that commands call: file and function."""


def needs_compiling(kernel: str = HISTORIES) -> bool:
    """Whether a kernel will have to be compiled when it is next called, some seconds once for this machine."""
    source = Path(__file__).with_name(kernel.split(".")[0] + ".py")
    tag = f"py{sys.version_info.major}{sys.version_info.minor}"
    indexes = cache_folder().glob(f"*/{kernel}-*.{tag}.nbi")
    try:
        return not any(index.stat().st_mtime >= source.stat().st_mtime for index in indexes)
    except OSError:  # another process is at work on the cache
        return False
