"""What the Italian code requires: limit states of displacement, with their limits and periods, and a zeta_E at each.

Clauses: C8.7.1.2.1.6 and formulas C8.7.1.10-11 of the Circolare, and NTC 2018, 8.3 and 8.4.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

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
"""Rules of the limit states of displacement, from the most frequent to the rarest; the first one decides by default."""
FIRST_STATE = RULES[0].state
FURTHER_STATES = (*(rule.state for rule in RULES[1:]), "SLD")
"""Limit states with fields of their own in a site file and its floor. At SLD only the onset of rocking is verified."""
STATES = ("SLD", *(rule.state for rule in RULES))
"""All limit states that are verified, from the most frequent to the rarest."""
STATES_OF_SITE = ("SLO", *STATES)
"""Limit states that a site may have: SLO is shown, and not verified."""
LONG_PERIOD = 4.0  # s; above it the code requires a study of the site, or records
DAMAGE, LINEAR, NONLINEAR = "damage", "linear", "nonlinear"
OF_STATE = {
    FIRST_STATE: (DAMAGE, NONLINEAR),
    **{rule.state: (f"{DAMAGE}_{rule.state}", f"{NONLINEAR}_{rule.state}") for rule in RULES[1:]},
}
"""Both methods of each limit state, by onset of rocking and by displacement; the larger capacity governs."""
STATE_OF_METHOD = {key: state for state, pair in OF_STATE.items() for key in pair} | {LINEAR: FIRST_STATE, "SLD": "SLD"}


class Threshold(NamedTuple):
    """The zeta_E that is required: `least`, or that before an intervention and `more`, if that counts and is known."""

    least: float | None
    more: float | None = None

    def at(self, state: str, before: Mapping[str, float | None]) -> float | None:
        """Return the zeta_E required at a limit state, from those before; at SLD at least 1, unless these decide."""
        zeta = before.get(state)
        if state == "SLD" and self.more != 0:
            return 1.0
        return self.least if self.more is None or zeta is None else zeta + self.more


THRESHOLDS: Mapping[str, Threshold] = {
    "": Threshold(1.0),
    "local": Threshold(None, 0.0),
    "improvement": Threshold(None, 0.1),
    **dict.fromkeys(("improvement_IV", "improvement_school"), Threshold(0.6)),
    **dict.fromkeys(("improvement_I", "improvement_heritage"), Threshold(0.0, 0.0)),
    **dict.fromkeys(("upgrading_a", "upgrading_b", "upgrading_d"), Threshold(1.0)),
    **dict.fromkeys(("upgrading_c", "upgrading_e"), Threshold(0.8)),
}
"""Thresholds by intervention, with its case or what else decides [§8.4]; by an empty text that of an assessment."""
