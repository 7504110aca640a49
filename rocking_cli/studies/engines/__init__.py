"""Engines: who simulates the motion of a structure. One degree of freedom is the rule, free blocks are the witness."""

from __future__ import annotations

from collections.abc import Sequence

from rocking_cli.core import Mechanism
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import Structure
from rocking_cli.studies.engines.contract import Engine as Engine
from rocking_cli.studies.engines.contract import EngineName as EngineName
from rocking_cli.studies.engines.exact import EXACT as EXACT
from rocking_cli.studies.engines.exact import follow as follow
from rocking_cli.studies.engines.exact import respond as respond

FREE_NEIGHBOURS = 20  # number of neighbours by default if free blocks are simulated

ENGINES: tuple[EngineName, ...] = ("exact", "blocks", "auto")


def cost_in_words(
    engine: Engine, structure: Structure, motion: GroundMotion, count: int, processes: int | None = None
) -> str:
    """Return how long many histories will take, as a sentence; empty for the engine of one degree of freedom.

    Parameters
    ----------
    engine : Engine
        Who simulates them.
    structure : Structure
        The structure.
    motion : GroundMotion
        One of the motions.
    count : int
        Number of histories.
    processes : int, optional
        Number of histories at a time; by default, one for each processor.

    Raises
    ------
    InputError
        If the structure has something that free blocks cannot have.
    """
    if engine.name == "exact":
        return ""
    from rocking_cli.studies.engines.free import cost

    each, usual = cost(structure, motion)
    processes = processes or usual
    most = "up to " if engine.name == "auto" else ""
    return (
        f"Free blocks: {most}{count} histories of some {each:.2g} s each, on {processes} processors: {most}"
        f"{duration_in_words(count * each / processes)}. Histories that are done are kept: an interrupted run goes on."
    )


def duration_in_words(seconds: float) -> str:
    """Return a duration in its usual unit."""
    for unit, long in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * long:
            return f"{seconds / long:.0f} {unit}"
    return f"{max(seconds, 1.0):.0f} s"


def engine_of(name: str, mechanisms: Sequence[Mechanism] = ()) -> Engine:
    """Return an engine.

    Parameters
    ----------
    name : {"exact", "blocks", "auto"}
        One degree of freedom, free blocks, or free blocks where one degree of freedom does not tell the outcome.
    mechanisms : sequence of Mechanism
        The structures of the models whose outcomes will be asked for.

    Raises
    ------
    InputError
        If there is no such engine, or MuJoCo, which simulates free blocks, is not installed.
    """
    if name not in ENGINES:
        raise InputError(Problem(f"must be one of {', '.join(ENGINES)}, got {name!r}", field="engine"))
    if name == "exact":
        return EXACT
    from rocking_cli.studies.engines.free import Auto, Blocks

    return Blocks(mechanisms) if name == "blocks" else Auto(mechanisms)
