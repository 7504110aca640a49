"""Compilation of the time-history kernels by numba, and the cache of their machine code.

Numba is imported only when a history is computed. Its cache is in NUMBA_CACHE_DIR, by default the user's cache folder
and not beside the installed source. If this folder cannot be written to, each process compiles again.
"""

from __future__ import annotations

import functools
import os
import platform
import sys
import tempfile
import warnings
import zlib
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from types import FunctionType
from typing import Any

from rocking_cli.errors import CacheWarning, InputError


def cache_folder() -> Path:
    """Return the folder of compiled kernels."""
    from platformdirs import user_cache_path

    return Path(os.environ.get("NUMBA_CACHE_DIR") or user_cache_path("rocking-cli") / "numba")


@functools.cache
def unwritable() -> str | None:
    """Return the system's reason why compiled kernels cannot be kept in the cache folder; None if they can."""
    try:
        cache_folder().mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=cache_folder()):
            return None
    except OSError as error:
        return error.strerror or str(error)


# A kernel releases the GIL and keeps IEEE arithmetic to the letter: a history that meets a NaN must show it, and a
# record scaled before or inside the kernel must give the same bits.
OPTIONS: dict[str, Any] = {"nogil": True, "fastmath": False, "error_model": "numpy"}


def _import_numba() -> None:
    """Import numba; errors from its settings in the environment are left for the user to correct."""
    if "numba" in sys.modules:
        return
    given = [f"{name}={value}" for name, value in sorted(os.environ.items()) if name.startswith("NUMBA_")]
    try:
        features = [each for each in os.environ.get("NUMBA_CPU_FEATURES", "").split(",") if each]
        if not all(each.startswith(("+", "-")) for each in features):  # LLVM would end the process
            raise ValueError("features of a processor begin with + or -")
        with warnings.catch_warnings():
            if given:  # what it cannot parse numba would take for absent, and show a traceback of its own
                warnings.filterwarnings("error", message="Environment variable", category=RuntimeWarning)
            import numba  # noqa: F401
    except Exception as error:
        if not given:
            raise ImportError(f"numba cannot be loaded: {error}") from error
        reason = next((line for line in str(error).splitlines() if line.strip()), type(error).__name__)
        what = f"numba, which compiles the histories, does not start with {', '.join(given)}: {reason}"
        raise InputError(f"{what}\n  unset these variables of the environment, or mend them") from error


def compile_inline(function: Callable[..., Any]) -> Any:
    """Compile a function so that kernels inline it: a call would cost more than the few sums inside."""
    _import_numba()
    from numba import njit

    return njit(forceinline=True, **OPTIONS)(function)


def compile_kernel(function: Callable[..., Any]) -> Any:
    """Return a function that numba compiles at its first call and, if possible, keeps on disk."""
    _import_numba()
    import numba
    from numba import njit

    config: Any = numba.config

    kernel = njit(**OPTIONS)(function)
    if unwritable() is not None or not hasattr(kernel, "enable_caching"):
        return kernel
    theirs = config.CACHE_DIR
    try:
        config.CACHE_DIR = str(cache_folder())
        kept = njit(cache=True, **OPTIONS)(function)
    except (OSError, RuntimeError):
        return kernel
    finally:
        config.CACHE_DIR = theirs
    # Where it may not write to its folder within ours, numba would go beside the source.
    if not Path(kept.stats.cache_path).is_relative_to(cache_folder()):
        return kernel
    _mend(kept._cache)
    return kept


def _mend(stored: Any) -> None:
    """Make numba empty a damaged cache and compile its kernels again.

    Without this, numba would fail on a cache that it could not write completely because the disk was full.
    """
    load = stored.load_overload

    def load_or_empty(*asked: Any) -> Any:
        try:
            return load(*asked)
        except MemoryError:
            raise
        except Exception:  # whatever a pickle of half a file raises
            _say_damaged()
            stored.flush()
            return None

    stored.load_overload = load_or_empty


@functools.cache
def _say_damaged() -> None:
    """Warn of the damaged cache, once in this process."""
    text = f"what is compiled in {cache_folder()} is damaged and is compiled again, which takes about ten seconds"
    warnings.warn(CacheWarning(text), stacklevel=2)


def compile_source(
    functions: Sequence[Callable[..., Any]], inline: Sequence[Callable[..., Any]] = ()
) -> dict[str, Any]:
    """Compile functions of a module, and leave the module's own functions to Python.

    Parameters
    ----------
    functions : sequence of callable
        The functions, each after those that it calls.
    inline : sequence of callable
        Functions among them to be inlined where they are called.

    Returns
    -------
    dict of str to callable
        The compiled functions by name.
    """
    namespace = dict(vars(sys.modules[functions[0].__module__]))
    for function in functions:
        # The same code, but the names in it mean what is compiled.
        twin = FunctionType(function.__code__, namespace, function.__name__)
        twin.__module__, twin.__qualname__ = function.__module__, function.__qualname__
        namespace[function.__name__] = compile_inline(twin) if function in inline else compile_kernel(twin)
    return {function.__name__: namespace[function.__name__] for function in functions}


HISTORIES, PULSES = "kernels", "pulse_motion"
"""The files of the kernels that commands call."""


def needs_compiling(kernel: str = HISTORIES) -> bool:
    """Return whether a kernel will be compiled at its next call, which takes some seconds."""
    return unwritable() is not None or not _stamp(kernel).exists()


@functools.cache
def has_run(kernel: str) -> None:
    """Record for later processes that a kernel is compiled."""
    if unwritable() is None:
        with suppress(OSError):
            _stamp(kernel).touch()


def _stamp(kernel: str) -> Path:
    """Return a file that exists if this version of a kernel was compiled by this Python and numba."""
    source = Path(__file__).with_name(f"{kernel}.py").read_bytes()
    made = f"{sys.version_info[:2]}, {version('numba')}, {platform.machine()}, {zlib.crc32(source)}"
    return cache_folder() / f"{kernel}-{zlib.crc32(made.encode()):08x}.compiled"
