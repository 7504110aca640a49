"""The limit states of displacement of the Italian code, with their limits and periods [§C8.7.1.2.1.6, C8.7.1.10-11]."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.codes.italian import clauses


@dataclass(frozen=True)
class Rule:
    """Rule for the displacement capacity and the demand at a limit state.

    Parameters
    ----------
    state : str
        Name of the limit state.
    share : float
        Share of d0* that is permitted.
    at_breaks : bool
        Whether the capacity ends where a break reduces a* by more than half of its largest value. The loss of a seat
        ends both limit states: what ends SLC must not have happened at SLV either.
    factor : float
        Factor on pi sqrt(d/a*) in its period.
    damping : float
        Damping ratio of the demand.
    clause : str
        Clause of the period.
    probability : float
        Probability of exceedance in the reference life.
    """

    state: str
    share: float
    at_breaks: bool
    factor: float
    damping: float
    clause: str
    probability: float


RULES = (
    Rule("SLV", 0.4, True, 1.68, 0.08, clauses.T_SLV, 0.10),
    Rule("SLC", 0.6, False, 1.56, 0.10, clauses.T_SLC, 0.05),
)
"""Rules of the limit states, from the most frequent to the rarest; the first one decides the verification."""
FIRST_STATE = RULES[0].state
FURTHER_STATES = (*(rule.state for rule in RULES[1:]), "SLD")
"""Limit states with fields of their own in a site file and its floor. At SLD only the onset of rocking is verified."""
STATES = ("SLD", *(rule.state for rule in RULES))
"""All limit states that are verified, from the most frequent to the rarest."""
STATES_OF_SITE = ("SLO", *STATES)
"""Limit states that a site may have: SLO is shown, and not verified."""
DAMAGE, LINEAR, NONLINEAR = "damage", "linear", "nonlinear"
OF_STATE = {
    FIRST_STATE: (DAMAGE, NONLINEAR),
    **{rule.state: (f"{DAMAGE}_{rule.state}", f"{NONLINEAR}_{rule.state}") for rule in RULES[1:]},
}
"""Both methods of each limit state, by onset of rocking and by displacement; the larger capacity governs."""
