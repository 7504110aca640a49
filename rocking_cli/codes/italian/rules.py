"""The limit states of displacement of the Italian code [§C8.7.1.2.1.6, C8.7.1.10-11]."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.codes.italian import clauses


@dataclass(frozen=True)
class Rule:
    """A limit state.

    Parameters
    ----------
    state : str
        What it is called.
    share : float
        Of d0*, that it allows.
    at_breaks : bool
        Whether it ends where a tie breaks that takes more than half of the largest a*. Where a load is moved off its
        seat, both end: what ends SLC must not have happened at SLV either.
    factor : float
        Of pi sqrt(d/a*), its period.
    damping : float
        A ratio.
    clause : str
        That of its period.
    """

    state: str
    share: float
    at_breaks: bool
    factor: float
    damping: float
    clause: str


RULES = (
    Rule("SLV", 0.4, True, 1.68, 0.08, clauses.T_SLV),
    Rule("SLC", 0.6, False, 1.56, 0.10, clauses.T_SLC),
)
