"""Who simulated a result, in words: one degree of freedom, or free blocks."""

from __future__ import annotations

from rocking_cli.core import Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import Engine, EngineName
from rocking_cli.studies.engines.free_blocks import COLLAPSE

BLOCKS_FAILED = "free blocks failed: a step diverged, or a body sank too deep into another"
ALL_EXACT = "Engine: one degree of freedom for all histories, as it tells every outcome."


def engines_in_words(engine: EngineName, by_blocks: int, mechanism: Mechanism, off_edge: int = 0) -> list[str]:
    """Return sentences on the histories that were simulated with free blocks; none if there are none.

    Parameters
    ----------
    engine : {"exact", "blocks", "auto"}
        The engine that was requested.
    by_blocks : int
        Number of histories with free blocks.
    mechanism : Mechanism
        The structure.
    off_edge : int
        Number of those of them in which a block falls off an edge.
    """
    if engine == "exact":
        return []
    if not by_blocks:
        return [ALL_EXACT]
    histories = "1 history" if by_blocks == 1 else f"{by_blocks} histories"
    given = mechanism.friction is not None
    friction = (
        f"{mechanism.friction:g}, as given" if given else f"{MASONRY_FRICTION:g}, as usual for masonry: none is given"
    )
    return [blocks_in_words(engine, histories, friction, off_edge)]


def blocks_in_words(engine: EngineName, histories: str, friction: str, off_edge: int) -> str:
    """Return which histories free blocks give, and how: their collapse, impacts, friction and falls, in words."""
    off = f" In {off_edge:,} of them, a block falls off an edge that the file draws: they count as overturned."
    others = "; one degree of freedom for all others" if engine == "auto" else ""
    return (
        f"Engine: free blocks (MuJoCo) for {histories}{others}. Overturning is collapse: {COLLAPSE}. Impacts lose the "
        f"energy that contact takes, whatever restitution is given. Friction is {friction}.{off * (off_edge > 0)}"
    )


def cost_in_words(
    engine: Engine, structure: Structure, motion: GroundMotion, count: int, processes: int | None = None
) -> str:
    """Return how long many histories will take, measured, as a sentence; empty for one degree of freedom.

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
    histories = "history" if count == 1 else "histories"
    most = "up to " if engine.name == "auto" else ""
    return (
        f"Free blocks: {most}{count} {histories} of some {each:.2g} s each, {processes} at a time: {most}"
        f"{_duration(count * each / processes)}. Histories that are done are kept: an interrupted run goes on."
    )


def _duration(seconds: float) -> str:
    for unit, long in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * long:
            return f"{seconds / long:.0f} {unit}"
    return f"{max(seconds, 1.0):.0f} s"
