"""The ways to run a kernel, and the choice between them.

The kernels have one source. The machine code that is shipped (`shipped`) runs them, several histories of a batch at
once in the lanes of vectors, at the highest level that the processor has; if it cannot be used, Python does, which
takes some sixty times longer and gives a warning. All give the same numbers.
"""

from __future__ import annotations

import functools
import importlib
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from math import ceil
from types import FunctionType
from typing import Any

import numpy as np

from rocking_cli.dynamics.calling import LEVELS, SETS, KernelSet
from rocking_cli.errors import InputError, KernelWarning, warn

KERNELS_VARIABLE = "ROCKING_KERNELS"
"""Environment variable that selects how kernels are run; no alternative is then tried."""
MACHINE_CODE, SCALAR, PYTHON = "ready", "scalar", "python"
CHOICES = (MACHINE_CODE, *LEVELS, SCALAR, PYTHON)
"""What it accepts: machine code at the highest level, at a level, or without lanes; or Python."""

Kernel = Callable[..., Any]
_LOCK = threading.RLock()
_forced: str | None = None
last: str | None = None
"""The way that was taken last; None before there was any."""


def kernel(of: KernelSet) -> Kernel:
    """Return the function that runs a kernel in the chosen way, with the arguments of its source."""
    return _chosen()[1][of.name]


def lanes(of: KernelSet) -> Kernel | None:
    """Return the function that runs a kernel of lanes; None if histories are to be computed one by one."""
    return _chosen()[1].get(of.name)


def way() -> str:
    """Return the way in which kernels are run: the level of lanes, `SCALAR` or `PYTHON`."""
    return _chosen()[0]


def usable() -> tuple[str, ...]:
    """Return the ways that this machine has, the fastest first."""
    if fault_of_shipped() is not None:
        return (PYTHON,)
    from rocking_cli.dynamics import shipped

    return (*shipped.levels(), SCALAR, PYTHON)


@contextmanager
def forced(way: str) -> Iterator[None]:
    """Run kernels in one way, whatever the environment says."""
    global _forced
    before, _forced = _forced, way
    try:
        yield
    finally:
        _forced = before


def forget() -> None:
    """Forget which way was chosen and which library was loaded, for tests with other libraries."""
    from rocking_cli.dynamics import shipped

    _choose.cache_clear()
    shipped.loaded.cache_clear()


def _chosen() -> tuple[str, dict[str, Kernel]]:
    global last
    with _LOCK:  # the threads of a batch call this at the same time
        chosen = _choose(_forced or os.environ.get(KERNELS_VARIABLE) or None)
        last = chosen[0]
    return chosen


@functools.cache
def _choose(requested: str | None) -> tuple[str, dict[str, Kernel]]:
    if requested not in (None, *CHOICES):
        raise InputError(f"{KERNELS_VARIABLE} is {requested!r}: give one of {', '.join(CHOICES)}")
    fault = None if requested == PYTHON else fault_of_shipped()
    if fault is not None and requested is not None:
        raise InputError(f"{KERNELS_VARIABLE} is {requested!r}, but {fault}: leave it out") from fault
    if fault is not None:
        text = f"time histories are computed by Python itself, which takes some sixty times longer ({fault})"
        warn(KernelWarning(text))
    if fault is not None or requested == PYTHON:
        return PYTHON, {name: in_python(of) for name, of in SETS.items() if not of.lanes}
    here = usable()
    way = here[0] if requested in (None, MACHINE_CODE) else requested
    if way not in here:
        asked, way = way, here[0]  # those that it lacks are the highest
        warn(KernelWarning(f"{KERNELS_VARIABLE} is {asked!r}, which this processor has not: kernels run at {way}"))
    return way, {name: as_shipped(of, way) for name, of in SETS.items() if way != SCALAR or not of.lanes}


def fault_of_shipped() -> ImportError | None:
    """Return why the shipped kernels cannot be used, a `BrokenKernels` if they should be usable; None if they can."""
    try:
        for of in SETS.values():
            as_shipped(of)
    except ImportError as error:
        return error
    return None


def as_shipped(of: KernelSet, level: str = LEVELS[-1]) -> Kernel:
    """Return a kernel of the shipped library. Raises `ImportError` if it cannot be used."""
    from rocking_cli.dynamics import shipped  # some builds of Python have no ctypes

    entry = shipped.load(of, level)
    if of.lanes:
        return functools.partial(shipped.prepared, entry, of)

    def run(*arguments: Any) -> None:
        shipped.call(entry, of, arguments)

    return run


def in_python(of: KernelSet) -> Kernel:
    """Return a kernel as a Python function that computes like machine code.

    Integers are truncated like those of machine code, and floating-point errors such as a division by zero raise
    nothing.
    """
    source = importlib.import_module(of.module).SOURCE
    namespace = {**names_of(source), "int": _like_machine_code(int), "ceil": _like_machine_code(ceil)}
    for source_function in source:
        twin = FunctionType(source_function.__code__, namespace, source_function.__name__, source_function.__defaults__)
        namespace[source_function.__name__] = twin
    function = namespace[of.function]

    def run(*arguments: Any) -> None:
        with np.errstate(all="ignore"):
            function(*arguments)

    return run


def names_of(source: Iterable[Callable[..., object]]) -> dict[str, Any]:
    """Return the names of all modules from which the functions of a kernel are, in one namespace."""
    modules = dict.fromkeys(function.__module__ for function in source)
    return {name: value for module in modules for name, value in vars(importlib.import_module(module)).items()}


INT64_MIN = -(2**63)
"""Integer into which processors convert NaN, and numbers that are too large."""


def _like_machine_code(rounded: Callable[[float], int]) -> Callable[[float], int]:
    def whole(value: float) -> int:
        try:
            return rounded(value)
        except (ValueError, OverflowError):
            return INT64_MIN

    return whole
