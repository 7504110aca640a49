"""What can be wrong with an assembly of blocks, as sentences a person can read."""

from __future__ import annotations

from collections.abc import Sequence

NAMED = 5  # blocks that a sentence names at most


class AssemblyFault(Exception):
    """What is wrong with an assembly: one sentence without a full stop.

    Parameters
    ----------
    message : str
        The sentence.
    blocks : sequence of str
        The blocks it is about.
    """

    def __init__(self, message: str, blocks: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.blocks = tuple(blocks)


class ContactFault(AssemblyFault):
    """Blocks that overlap or touch nothing, or named joints that do not exist."""


class DoesNotStand(AssemblyFault):
    """No contact forces carry what acts on the assembly at rest."""


class NothingMoves(AssemblyFault):
    """Contact forces carry any acceleration: no mechanism is found."""


class NoAnswer(AssemblyFault):
    """The solver could not reach an answer that it can stand behind."""


def listed(names: Sequence[str]) -> str:
    """Names in quotes, joined by commas and a last `and`; of many only the first."""
    quoted = [repr(name) for name in names[:NAMED]]
    if len(names) > NAMED:
        quoted.append(f"{len(names) - NAMED} more")
    return " and ".join([", ".join(quoted[:-1]), quoted[-1]]) if len(quoted) > 1 else "".join(quoted)
