"""Compile the kernels in advance, by simulating the shortest motion that each kernel accepts."""

from __future__ import annotations

from dataclasses import dataclass
from time import monotonic

from rocking_cli.dynamics import ways
from rocking_cli.dynamics.compiled import HISTORIES, PULSES

CALLED = {HISTORIES: "histories", PULSES: "exact_pulses"}
"""The kernels, by the names that users know them by."""


@dataclass(frozen=True)
class Compiled:
    """A kernel that has been compiled or loaded, and can be used without delay.

    Parameters
    ----------
    kernel : str
        The kernel: `HISTORIES` or `PULSES`.
    before : bool
        Whether it was compiled before.
    seconds : float
        Time taken to compile or load the kernel [s].
    """

    kernel: str
    before: bool
    seconds: float


def compile_kernel(kernel: str) -> Compiled:
    """Compile a kernel, or load it if it was compiled before, and return how long this took."""
    from rocking_cli.studies.under_pulses import linear_block

    before, began = ways.is_ready(kernel), monotonic()
    ways.prepare(kernel)
    if kernel == HISTORIES:
        from rocking_cli.dynamics.history import follow

        follow(linear_block(0.5).model, None, release=0.5)
    else:
        from rocking_cli.dynamics.exact_batch import exact_many
        from rocking_cli.excitation.pulses.shapes import Sine

        exact_many(linear_block(0.5).equivalence, Sine(1.0, 1.0), 2.0, 1.0, kappa=2, gravity=1.0)
    return Compiled(kernel, before, monotonic() - began)
