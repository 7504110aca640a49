"""The kernels as sets of functions, and how their arguments are handed to code that is compiled ahead.

Machine code that any processor and Python can call takes no array of numpy, but three rows of plain numbers: whole
numbers, real ones, and the addresses of arrays, whose shapes are among the whole numbers.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

Layout: TypeAlias = "str | tuple[str, tuple[Layout, ...]]"
"""An argument: "i" a whole number, "b" a yes or no, "f" a real one, "R2" an array of real numbers with two axes, "I2"
one of whole numbers; or a tuple, by its name among the names of the kernel ("": without one), with what is in it."""

_JOINTS: Layout = ("Joints", ("I2", "I3", "R2", "R2", "R2", "R2", "R2"))
_SAMPLES: Layout = ("Samples", ("i", "R1", "R1", "R2", "R1"))
_ROOM: Layout = ("Room", ("R2", "R2", "R1", "I1"))
_SIDE: Layout = ("Side", ("f", "f", "f", "f"))


def _run(forces: str) -> tuple[Layout, ...]:
    """Arguments of `kernels.run`."""
    arrays = ("I2", "R3", forces, "R3", "R2", "R2", "I2", "R2", "R1", "R1", "R1", "R1", "R1", _JOINTS)
    return ("i", "i", "R2", ("Deck", arrays), "f", "i", "b", _SAMPLES, "R2", _ROOM)


@dataclass(frozen=True)
class KernelSet:
    """A function to call, with all that it calls, compiled for arguments of one kind.

    Parameters
    ----------
    name : str
        Of the file that it is shipped in.
    module, function : str
        Where it is.
    arguments : tuple of Layout
        What it takes.
    """

    name: str
    module: str
    function: str
    arguments: tuple[Layout, ...]


HISTORIES = KernelSet("histories", "rocking_cli.dynamics.kernels", "run", _run("R3"))
TIED = KernelSet("tied", "rocking_cli.dynamics.kernels", "run", _run("R4"))
"""The same where vertical motion meets a tie: see `kernels.Deck.forces`."""
PULSES = KernelSet(
    "pulses",
    "rocking_cli.dynamics.pulse_motion",
    "many",
    (("", (_SIDE, _SIDE)), "R2", "R1", "R1", "i", "i", "R2"),
)
SETS = {each.name: each for each in (HISTORIES, TIED, PULSES)}

ARRAYS = {
    f"{kind}{axes}": (np.dtype(dtype), axes)
    for kind, dtype in (("R", np.float64), ("I", np.int64))
    for axes in range(1, 5)
}
Entry: TypeAlias = Callable[[Any, Any, Any], int]


def call(entry: Entry, kernel: KernelSet, arguments: Sequence[Any]) -> None:
    """Call code that is compiled ahead.

    Raises
    ------
    TypeError
        If an array is not of the kind that the code takes: it would read what is not its own.
    RuntimeError
        If the code reports an error.
    """
    whole: list[int] = []
    real: list[float] = []
    places: list[int] = []
    _pack(kernel.arguments, arguments, whole, real, places)
    status = entry(
        (ctypes.c_int64 * len(whole))(*whole),
        (ctypes.c_double * len(real))(*real),
        (ctypes.c_int64 * len(places))(*places),
    )
    if status:
        raise RuntimeError(f"the kernel {kernel.name} ended with status {status}")


def _pack(
    layouts: Sequence[Layout], values: Sequence[Any], whole: list[int], real: list[float], places: list[int]
) -> None:
    """Append what arguments consist of to the three rows."""
    for layout, value in zip(layouts, values, strict=True):
        if isinstance(layout, tuple):
            _pack(layout[1], value, whole, real, places)
        elif layout == "f":
            real.append(value)
        elif layout in ("i", "b"):
            whole.append(value)
        else:
            dtype, axes = ARRAYS[layout]
            if value.dtype != dtype or value.ndim != axes or not value.flags.carray:
                raise TypeError(f"an array for a kernel is {value.dtype} {value.shape}, not a writable {layout}")
            # The quickest way to an address, of which there are forty in each call.
            places.append(ctypes.addressof(ctypes.c_char.from_buffer(value)) if value.size else 0)
            whole += value.shape
