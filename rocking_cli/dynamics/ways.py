"""The three ways to run a kernel, and the choice between them.

The kernels have one source. The first way that works is taken: the machine code that is shipped (`shipped`); numba
(`compiled`), an extra for authors of kernels; or Python, which takes some sixty times longer and gives a warning. All
ways give the same numbers.
"""

from __future__ import annotations

import functools
import importlib
import os
import threading
import warnings
from collections.abc import Callable
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from types import FunctionType
from typing import Any

from rocking_cli.dynamics import compiled
from rocking_cli.dynamics.calling import HISTORIES, PULSES, SETS, TIED, KernelSet
from rocking_cli.errors import InputError, KernelWarning

CHOSEN = "ROCKING_KERNELS"
"""The variable of the environment that names a way, and then no other one is tried."""
READY, JIT, PYTHON = "ready", "jit", "python"
WAYS = (READY, JIT, PYTHON)
OF_FILE = {compiled.HISTORIES: (HISTORIES, TIED), compiled.PULSES: (PULSES,)}
"""The sets of each kernel that commands call."""

Kernel = Callable[..., None]
_LOCK = threading.RLock()


def kernel(of: KernelSet) -> Kernel:
    """Return the function of a kernel, with the arguments that it has in its source."""
    return _chosen(of.name)[1]


def way(of: KernelSet) -> str:
    """Return the way in which a kernel is run: `READY`, `JIT` or `PYTHON`."""
    return _chosen(of.name)[0]


def forget() -> None:
    """Forget the chosen way, for tests with another environment or another cache."""
    from rocking_cli.dynamics import shipped

    _choose.cache_clear()
    shipped.forget()


def _chosen(name: str) -> tuple[str, Kernel]:
    with _LOCK:  # the threads of a batch come at once
        return _choose(name)


@functools.cache
def _choose(name: str) -> tuple[str, Kernel]:
    of, asked = SETS[name], os.environ.get(CHOSEN) or None
    if asked is not None and asked not in WAYS:
        raise InputError(f"{CHOSEN} is {asked!r}: give one of {', '.join(WAYS)}")
    reasons: list[str] = []
    for each in (asked,) if asked else WAYS:
        if each == PYTHON and reasons:
            _say_slow(reasons[0])
        try:
            return each, MAKE[each](of)
        except ImportError as error:
            reasons.append(str(error))
    raise InputError(f"{CHOSEN} is {asked!r}, but {'; '.join(reasons)}: leave it out")


def _ready(of: KernelSet) -> Kernel:
    from rocking_cli.dynamics import shipped  # not every Python has ctypes

    entry = shipped.load(of)

    def run(*arguments: Any) -> None:
        shipped.call(entry, of, arguments)

    return run


@functools.cache
def compiled_module(module: str) -> dict[str, Any]:
    """Return the functions of a kernel module, compiled by numba, by name."""
    source = importlib.import_module(module)
    return compiled.compile_source(source.SOURCE, inline=source.INLINE)


def _jit(of: KernelSet) -> Kernel:
    function: Kernel = compiled_module(of.module)[of.function]
    return function


@functools.cache
def _say_slow(why: str) -> None:
    """Warn that kernels are slow, once in this process."""
    text = f"time histories are computed by Python itself, which takes some sixty times longer ({why})"
    warnings.warn(KernelWarning(f"{text}; rocking-cli[jit] would compile them"), stacklevel=2)


def in_python(of: KernelSet) -> Kernel:
    """Return a kernel as a Python function that computes like machine code.

    Integers are truncated like those of machine code, and floating-point errors such as a division by zero raise
    nothing.
    """
    import numpy as np

    module = importlib.import_module(of.module)
    namespace = {**vars(module), "int": _truncated, "ceil": _raised}
    for each in module.SOURCE:
        twin = FunctionType(each.__code__, namespace, each.__name__, each.__defaults__)
        namespace[each.__name__] = twin
    function = namespace[of.function]

    def run(*arguments: Any) -> None:
        with np.errstate(all="ignore"):
            function(*arguments)

    return run


LEAST = -(2**63)
"""What a processor makes of a number that is too large for a whole one, or of none."""


def _truncated(value: float) -> int:
    try:
        return int(value)
    except (ValueError, OverflowError):
        return LEAST


def _raised(value: float) -> int:
    from math import ceil

    try:
        return ceil(value)
    except (ValueError, OverflowError):
        return LEAST


MAKE = {READY: _ready, JIT: _jit, PYTHON: in_python}


def needs_compiling(file: str = compiled.HISTORIES) -> bool:
    """Return whether numba will compile a kernel at its next call, which takes some seconds."""
    return way(OF_FILE[file][0]) == JIT and compiled.needs_compiling(file)


def is_ready(file: str) -> bool:
    """Return whether a kernel can be used without being compiled first."""
    asked = os.environ.get(CHOSEN)
    for each in (asked,) if asked else WAYS:
        if each == READY and _is_shipped():
            return True
        if each == JIT and find_spec("numba") is not None:
            return not compiled.needs_compiling(file)
    return True


def _is_shipped() -> bool:
    try:
        from rocking_cli.dynamics import shipped
    except ImportError:
        return False
    return shipped.is_there()


def versions() -> dict[str, str]:
    """Return the versions of the installed packages that compile kernels, by name."""
    found = {}
    for name in ("llvmlite", "numba"):
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


def prepare(file: str) -> None:
    """Compile what a kernel may need, whichever of its functions is called first."""
    for each in OF_FILE[file]:
        kernel(each)


def has_run(file: str) -> None:
    """Record for later processes that a kernel is compiled."""
    if way(OF_FILE[file][0]) == JIT:
        compiled.has_run(file)
