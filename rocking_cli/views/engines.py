"""Who simulated a result, in words: one degree of freedom, or free blocks."""

from __future__ import annotations

from rocking_cli.core import Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.studies.engines import EngineName
from rocking_cli.studies.engines.free_blocks import COLLAPSE

ALL_EXACT = "Engine: one degree of freedom for all histories, as it tells every outcome."


def engines_in_words(engine: EngineName, by_blocks: int, mechanism: Mechanism) -> list[str]:
    """Return sentences on the histories that were simulated with free blocks; none if there are none.

    Parameters
    ----------
    engine : {"exact", "blocks", "auto"}
        The engine that was asked for.
    by_blocks : int
        Number of histories with free blocks.
    mechanism : Mechanism
        The structure.
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
    return [blocks_in_words(engine, histories, friction)]


def blocks_in_words(engine: EngineName, histories: str, friction: str) -> str:
    """Return which histories free blocks give, and how: their collapse, impacts and friction, in words."""
    others = "; one degree of freedom for all others" if engine == "auto" else ""
    return (
        f"Engine: free blocks (MuJoCo) for {histories}{others}. Overturning is collapse: {COLLAPSE}. Impacts lose the "
        f"energy that contact takes, whatever restitution the file gives. Friction is {friction}."
    )
