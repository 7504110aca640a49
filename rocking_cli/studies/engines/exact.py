"""The contract of engines, and that of one degree of freedom, whose joints but those that open are only checked."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from math import isfinite
from typing import ClassVar, Literal, TypedDict, Unpack

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction
from rocking_cli.dynamics import history
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import RTOL, TAIL_SECONDS
from rocking_cli.structure import Structure

EngineName = Literal["exact", "blocks", "auto"]


class RunOptions(TypedDict, total=False):
    """Options of many motions, see `respond_many`."""

    release: float | Reals | None
    threads: int | None
    rtol: float
    only_peaks: bool
    progress: Callable[[int], None] | None


class Engine(ABC):
    """An engine: who simulates the motion of a structure."""

    name: ClassVar[EngineName]

    @abstractmethod
    def outcomes(
        self, models: Sequence[Model], motions: Sequence[GroundMotion | None], runs: Runs, **options: Unpack[RunOptions]
    ) -> Outcomes:
        """Simulate many motions; parameters and errors are those of `respond_many`."""


def follow(
    structure: Structure,
    motion: GroundMotion | None = None,
    *,
    model: ModelName = "nonlinear",
    release: float | None = None,
    tail: float = TAIL_SECONDS,
    rtol: float = RTOL,
) -> History:
    """Simulate the motion of a structure under a ground motion, after a release from a tilt, or both.

    Parameters
    ----------
    structure : Structure
        The structure.
    motion : GroundMotion, optional
        Ground acceleration, linear between its samples and zero after the last. With its vertical component, g becomes
        g + v_g''.
    model : {"nonlinear", "linear1", "linear2"}
        Equation of motion. Nonlinear: Eq. 8 by an error-controlled Runge-Kutta-Nystrom pair. Linear: Eq. 16, exact on
        every ramp of the record; with a vertical component, whose g changes along the ramp, by the same pair.
    release : float, optional
        Start at rest from this fraction of phi_cr, between -1 and 1; negative in the negative direction.
    tail : float
        Time after the record for which samples are kept [s]. The motion is always simulated to its end.
    rtol : float
        Relative local error of a step of the nonlinear motion.

    Returns
    -------
    History
        Outcome of the motion, with its peaks, impacts and samples.

    Raises
    ------
    InputError
        If there is neither a motion nor a release, a value is out of range, or the structure has no such model.
    SolverError
        If the motion cannot be simulated to its end.
    """
    check_motion(structure, motion, release, tail)
    simulated = history.follow(structure.model(model), motion, release=release or 0.0, tail=tail, rtol=rtol)
    if simulated.unknown and not simulated.crushes:
        from rocking_cli.studies.engines.free_blocks import free_blocks

        with suppress(InputError):  # raised of what free blocks cannot have
            return replace(simulated, witness=free_blocks(structure.mechanism) is not None)
    return simulated


def check_motion(structure: Structure, motion: GroundMotion | None, release: float | None, tail: float) -> None:
    """Raise `InputError` if there is nothing to simulate, or a value is out of range."""
    if not isinstance(motion, GroundMotion | None):
        raise InputError(f"motion must be a GroundMotion, got {type(motion).__name__}")
    if motion is None and release is None:
        raise InputError("nothing to respond to: give a ground motion, a release, or both")
    if release is not None and not 0 < abs(release) < 1:
        raise InputError(f"release must be a fraction of phi_cr between 0 and 1 (or 0 and -1), got {release:g}")
    of = structure.mechanism
    if release is not None and not of.rocks_both_ways and release * of.directions[0] < 0:
        supports = "release is against the supports that it leans on"
        raise InputError(f"{supports}: it rocks in the {of.one_sided} direction only")
    side = Direction.POSITIVE if (release or 0) > 0 else Direction.NEGATIVE
    bound = of.bounds.get(side) if release is not None else None
    if bound is not None and abs(release or 0) * structure.model("nonlinear").phi_cr[side < 0] > bound.phi:
        raise InputError(f"release is beyond the rotation at which {bound.words}: give less than that")
    if not (isfinite(tail) and tail >= 0):
        raise InputError(f"tail must be a time in seconds, 0 or more, got {tail:g}")


class Exact(Engine):
    """The engine of one degree of freedom."""

    name: ClassVar[EngineName] = "exact"

    def outcomes(
        self, models: Sequence[Model], motions: Sequence[GroundMotion | None], runs: Runs, **options: Unpack[RunOptions]
    ) -> Outcomes:
        """Simulate many motions, see `respond_many`."""
        return respond_many(models, motions, runs, **options)


EXACT = Exact()
