"""Compiling the kernels ahead of what needs them: the smallest motion that each can follow, of no structure."""

from __future__ import annotations

from dataclasses import dataclass
from time import monotonic

from rocking_cli.dynamics import ways
from rocking_cli.dynamics.compiled import HISTORIES, PULSES

CALLED = {HISTORIES: "histories", PULSES: "exact_pulses"}
"""The kernels, by the names that users know them by."""


@dataclass(frozen=True)
class Compiled:
    """A kernel that can be used without delay from now on.

    Parameters
    ----------
    kernel : str
        Which: `HISTORIES` or `PULSES`.
    before : bool
        Whether it was compiled before.
    seconds : float
        How long compiling it took, or loading it [s].
    """

    kernel: str
    before: bool
    seconds: float


def compile_kernel(kernel: str) -> Compiled:
    """Compile a kernel, or load what was compiled before."""
    before, began = ways.is_ready(kernel), monotonic()
    ways.prepare(kernel)
    if kernel == HISTORIES:
        _follow()
    else:
        _answer_exactly()
    return Compiled(kernel, before, monotonic() - began)


def _follow() -> None:
    from rocking_cli.dynamics.history import follow
    from rocking_cli.studies.under_pulses import linear_block

    follow(linear_block(0.5).model, None, release=0.5)


def _answer_exactly() -> None:
    from rocking_cli.dynamics.exact_batch import exact_many
    from rocking_cli.excitation.pulses.shapes import Sine
    from rocking_cli.studies.under_pulses import linear_block

    exact_many(linear_block(0.5).equivalence, Sine(1.0, 1.0), 2.0, 1.0, kappa=2, gravity=1.0)
