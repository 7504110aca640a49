"""Errors of assemblies of blocks, with messages for users."""

from __future__ import annotations

from collections.abc import Sequence

NAMED = 5  # blocks named in a message, at most


class AssemblyFault(Exception):
    """Error in an assembly, in one sentence without a full stop.

    Parameters
    ----------
    message : str
        The sentence.
    blocks : sequence of str
        Names of the blocks concerned.
    """

    def __init__(self, message: str, blocks: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.blocks = tuple(blocks)


class ContactFault(AssemblyFault):
    """Error: blocks overlap or touch nothing, or a named joint does not exist."""


class DoesNotStand(AssemblyFault):
    """Error: no contact forces balance the loads on the assembly at rest."""


class NothingMoves(AssemblyFault):
    """Error: contact forces balance any acceleration, so that there is no mechanism."""


class NoAnswer(AssemblyFault):
    """Error: the solver did not reach a reliable result."""


def listed(names: Sequence[str]) -> str:
    """Return names in quotes, joined by commas and a last `and`; of many names only the first ones."""
    quoted = [repr(name) for name in names[:NAMED]]
    if len(names) > NAMED:
        quoted.append(f"{len(names) - NAMED} more")
    return " and ".join([", ".join(quoted[:-1]), quoted[-1]]) if len(quoted) > 1 else "".join(quoted)
