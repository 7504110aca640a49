"""Engines: who simulates the motion of a structure. One degree of freedom is the rule, free blocks are the witness."""

from __future__ import annotations

from collections.abc import Sequence

from rocking_cli.core import Mechanism
from rocking_cli.errors import InputError, Problem
from rocking_cli.studies.engines.exact import EXACT as EXACT
from rocking_cli.studies.engines.exact import Engine as Engine
from rocking_cli.studies.engines.exact import EngineName as EngineName
from rocking_cli.studies.engines.exact import follow as follow

FREE_NEIGHBOURS = 20  # number of neighbours by default if free blocks are simulated

ENGINES: tuple[EngineName, ...] = ("exact", "blocks", "auto")


def engine_of(name: str, mechanisms: Sequence[Mechanism] = ()) -> Engine:
    """Return an engine.

    Parameters
    ----------
    name : {"exact", "blocks", "auto"}
        One degree of freedom, free blocks, or free blocks where one degree of freedom does not tell the outcome.
    mechanisms : sequence of Mechanism
        The structures of the models whose outcomes will be requested.

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
