"""The kernels as sets of functions, and how their arguments are laid out for code that is compiled ahead.

Machine code that any Python can call takes no array of numpy, but three rows of plain numbers: whole numbers, real
ones, and the addresses of arrays, whose shapes are among the whole numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

Layout: TypeAlias = "str | tuple[str, tuple[Layout, ...]]"
"""An argument: "i" a whole number, "b" a yes or no, "f" a real one, "R2" an array of real numbers with two axes, "I2"
one of whole numbers; or a tuple, by its name among the names of the kernel ("": without one), with what is in it."""

_JOINTS: Layout = ("Joints", ("I2", "I3", "R2", "R2", "R2", "R2", "R2", "R3", "R2"))
_SAMPLES: Layout = ("Samples", ("i", "R1", "R1", "R2", "R1"))
_ROOM: Layout = ("Room", ("R2", "R2", "R1", "I1"))
_SIDE: Layout = ("Side", ("f", "f", "f", "f"))


def _run(forces: str) -> tuple[Layout, ...]:
    """Arguments of `kernels.run`."""
    arrays = ("I2", "R3", forces, "R3", "R3", "R2", "R2", "I2", "R2", "R1", "R1", "R1", "R1", "R1", "R1", _JOINTS)
    return ("i", "i", "R2", ("Deck", arrays), "f", "i", "b", _SAMPLES, "R2", _ROOM)


@dataclass(frozen=True)
class KernelSet:
    """A function to call, with all that it calls, compiled for arguments of one kind.

    Parameters
    ----------
    name : str
        Name of its entry in the shipped libraries.
    module, function : str
        Module and name of the function in Python.
    arguments : tuple of Layout
        Layout of its arguments.
    lanes : bool
        Whether its loops are made of vectors, so that a library has it once for each of `LEVELS`.
    """

    name: str
    module: str
    function: str
    arguments: tuple[Layout, ...]
    lanes: bool = False


_LANES: Layout = ("Lanes", ("R1", "I2", "R2", "R3", "R3", "R2", "I2"))
_DECK: Layout = _run("R3")[3]
HISTORIES = KernelSet("histories", "rocking_cli.dynamics.kernels", "run", _run("R3"))
TIED = KernelSet("tied", "rocking_cli.dynamics.kernels", "run", _run("R4"))
"""The same where vertical motion meets a tie: see `kernels.Deck.forces`."""
PULSES = KernelSet(
    "pulses",
    "rocking_cli.dynamics.pulse_motion",
    "many",
    (("", (_SIDE, _SIDE)), "R2", "R1", "R1", "i", "i", "R2"),
)
LANES = KernelSet(
    "lanes",
    "rocking_cli.dynamics.lanes",
    "run_lanes",
    ("i", "i", "R2", _DECK, "I1", "i", "f", "i", "b", _SAMPLES, "R2", _LANES),
)
STEPS = KernelSet("steps", "rocking_cli.dynamics.lanes", "steps", ("R1", "i", "f"), lanes=True)
"""What `LANES` calls at each step."""
SETS = {each.name: each for each in (HISTORIES, TIED, PULSES, LANES, STEPS)}

ARRAYS = {
    f"{kind}{axes}": (np.dtype(dtype), axes)
    for kind, dtype in (("R", np.float64), ("I", np.int64))
    for axes in range(1, 5)
}

FUNCTIONS = {
    **dict.fromkeys(("asin", "ceil", "cos", "cosh", "expm1", "floor", "log", "log1p", "sin", "sinh"), "double double"),
    "memcpy": "ptr ptr ptr i64",
    "memset": "ptr ptr i32 i64",
}
"""Functions of C that kernels may call, with the types that LLVM knows the result and the arguments by."""


LEVELS = ("v4", "v3", "v1")
"""Levels of processors, the highest first, as in x86-64-v4; every processor has the last one."""


def symbol(name: str, level: str = "") -> str:
    """The name that a library has for the entry of a set, at a level if it has some, or for a function of C."""
    return f"rocking_{name}_{level}" if level else f"rocking_{name}"
