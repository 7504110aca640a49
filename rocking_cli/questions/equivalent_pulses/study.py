"""Pulses to which different structures are equivalently vulnerable [paper, Fig. 15]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import nan, pi
from typing import Literal

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Equivalence, EquivalentBlock, Mechanism, equivalent_block
from rocking_cli.dynamics.exact import exact_response
from rocking_cli.dynamics.history import History, follow
from rocking_cli.dynamics.model import ModelName, linear_model
from rocking_cli.dynamics.outcome import OneOutcome
from rocking_cli.errors import InputError, MechanismError, Problem, named, of_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies import engines
from rocking_cli.studies.under_pulses import check_eta, uplift, weakest_direction

SIMULATED_AFTER_PULSE = 12.0  # p times the duration that is simulated
MAX_PULSE_PERIODS = 1000  # periods simulated after the pulse, which may be far shorter than the motion


@short_repr
@dataclass(frozen=True, eq=False)
class PulsedStructure:
    """One structure under its own pulse, among structures that are compared.

    Parameters
    ----------
    name, mechanism : str
        Names of the structure and of its mechanism.
    block : EquivalentBlock
        Equivalent block of the direction in which the pulse first uplifts the structure.
    pulse : Pulse
        The pulse of this structure.
    eta : float
        Restitution of the impact that ends the first motion, as used.
    own_eta : float
        Restitution of the structure itself.
    history : History
        Nonlinear time history under this pulse.
    caution : str
        A caution about the lambda of the structure; empty if there is none.
    """

    name: str
    mechanism: str
    block: EquivalentBlock
    pulse: Pulse
    eta: float
    own_eta: float
    history: History
    caution: str = ""

    @property
    def amplitude(self) -> float:
        """Amplitude of the structure's pulse [standard gravity]."""
        return self.pulse.amplitude / STANDARD_GRAVITY


@short_repr
@dataclass(frozen=True, eq=False)
class EquivalentResponses:
    """Responses of structures to pulses of the same dimensionless amplitude a and frequency omega.

    Parameters
    ----------
    members : tuple of PulsedStructure
        The structures; the pulse was given for the first.
    a, omega : float
        Dimensionless amplitude and frequency of every pulse [paper, Eq. 40].
    kappa : {1, 2}
        The scaling: the uplift acceleration by which a is divided, 1: lambda_lin, 2: lambda.
    polarity : int
        1, or -1 for reversed pulses.
    direction : Direction
        The direction in which the pulse first uplifts the structures.
    alone : Outcome
        Outcome of the linear block that all structures share; exact if the pulse has an exact solution.
    linear : History
        Time history of the linear block under the first structure's pulse.
    tau : ndarray
        Dimensionless time p t of the samples, the same for all structures.
    """

    members: tuple[PulsedStructure, ...]
    a: float
    omega: float
    kappa: Literal[1, 2]
    polarity: int
    direction: Direction
    alone: OneOutcome
    linear: History
    tau: Reals

    @property
    def spread(self) -> float:
        """Largest minus smallest peak phi/phi_cr; NaN if any structure overturns or has an unknown outcome."""
        peaks = [nan if each.history.unknown else each.history.peak_ratio for each in self.members]
        return float(np.ptp(peaks))

    @property
    def relative_spread(self) -> float:
        """The spread over the peak of the linear block; NaN without a spread, or if this peak is not positive."""
        return self.spread / self.alone.peak_ratio if self.alone.peak_ratio > 0 else nan

    @property
    def one_eta(self) -> bool:
        """Whether all impacts have the same restitution, as the equivalence needs."""
        etas = [each.eta for each in self.members]
        return max(etas) - min(etas) < 1e-9

    @property
    def pulse_end(self) -> float:
        """Dimensionless time p t at the end of every pulse."""
        return self.members[0].block.p * self.members[0].pulse.duration

    def turned(self, history: History) -> Reals:
        """Return phi/phi_cr of a history, positive in the direction in which the pulse uplifts first."""
        return int(self.direction) * history.ratio


def equivalent_pulses(
    structures: Sequence[Structure],
    pulse: Pulse,
    *,
    polarity: int = 1,
    kappa: Literal[1, 2] = 2,
    eta: float | Literal["first", "own"] = "first",
) -> EquivalentResponses:
    """Simulate structures under pulses of the same a and omega, each scaled by the structure's own equivalent block.

    Parameters
    ----------
    structures : sequence of Structure
        The structures.
    pulse : Pulse
        The pulse on the first structure.
    polarity : int
        1, or -1 for reversed pulses.
    kappa : {1, 2}
        Definition of the dimensionless amplitude: a = a_g/(g lambda_lin) for 1, a = a_g/(g lambda) for 2.
    eta : float, "first" or "own"
        Restitution of all impacts: a number, the value of the first structure, or each structure's own value.

    Raises
    ------
    InputError
        If a restitution cannot be used, or a structure rocks to one side only, which the linear block does not.
    """
    mechanisms = [each.mechanism for each in structures]
    for each in mechanisms:
        if not each.rocks_both_ways:
            reason = (
                f"{_name(each)}: it rocks in the {each.one_sided} direction only, but the linear block rocks in both"
            )
            raise InputError(Problem(reason, field="one_sided"))
    first = _equivalence(mechanisms[0])
    ground = pulse.sampled().scaled(polarity)
    # The direction in which the pulse uplifts first; without uplift, that of a stronger pulse.
    lifts = {d: -d * ground.acceleration > first[d].lambda_ * mechanisms[0].gravity for d in Direction}
    lifted = [d for d in Direction if lifts[d].any()]
    direction = (
        min(lifted, key=lambda d: int(lifts[d].argmax())) if lifted else weakest_direction(first, pulse, (polarity,))
    )
    block = first[direction]
    scaling: ModelName = "linear1" if kappa == 1 else "linear2"
    a = pulse.amplitude / (mechanisms[0].gravity * uplift(block, scaling))  # Eq. 40
    omega = 2 * pi / (pulse.period * block.p)  # Eq. 40
    shared = _shared_eta(eta, block, mechanisms[0])
    members = [_member(each, pulse, a, omega, direction, polarity, scaling, shared) for each in structures]
    both = replace(block, eta=members[0].eta)
    linear = linear_model("linear block", scaling, (both, both), mechanisms[0].gravity)
    history = follow(linear, ground, tail=_tail(pulse, block.p))
    alone: OneOutcome = history
    if pulse.segments():  # an exact outcome, whereas the history is of the sampled pulse
        alone = exact_response(
            Equivalence(both, both), pulse, kappa=kappa, gravity=mechanisms[0].gravity, polarity=polarity
        )
    longest = max(len(run.time) for run in [history, *(each.history for each in members)])
    tau = ground.kept.dt * block.p * np.arange(longest, dtype=np.float64)
    return EquivalentResponses(tuple(members), a, omega, kappa, polarity, direction, alone, history, tau)


def _name(mechanism: Mechanism) -> str:
    return mechanism.name or mechanism.mechanism


def _equivalence(mechanism: Mechanism) -> Equivalence:
    if why := mechanism.hung.refuses("linear models"):
        raise InputError(Problem(f"{_name(mechanism)}: {why}", field="ties"))
    try:
        return equivalent_block(mechanism)
    except MechanismError as error:
        raise of_structure(error, _name(mechanism)) from error


def _shared_eta(eta: float | Literal["first", "own"], block: EquivalentBlock, first: Mechanism) -> float | None:
    if eta == "own":
        return None
    if eta != "first":
        check_eta(float(eta), "eta")
        return float(eta)
    if not 0 < block.eta <= 1:
        raise InputError(
            Problem(
                f"{_name(first)}: the kinematics give a restitution of {block.eta:.4g}, which cannot be that of all",
                hint=f"give one in (0, 1] for all with {named('restitution')}, or a measured one in its file",
            )
        )
    return block.eta


def _member(
    structure: Structure,
    pulse: Pulse,
    a: float,
    omega: float,
    direction: Direction,
    polarity: int,
    scaling: ModelName,
    eta: float | None,
) -> PulsedStructure:
    mechanism = structure.mechanism
    block = _equivalence(mechanism)[direction]
    scaled = replace(pulse, amplitude=a * mechanism.gravity * uplift(block, scaling), period=2 * pi / (omega * block.p))
    shaken = structure if eta is None else structure.under(restitution=eta)
    history = engines.follow(shaken, scaled.sampled().scaled(polarity), tail=_tail(scaled, block.p))
    return PulsedStructure(
        _name(mechanism), mechanism.mechanism, block, scaled, block.eta if eta is None else eta, block.eta, history,
        mechanism.own_caution(),
    )  # fmt: skip


def _tail(pulse: Pulse, p: float) -> float:
    return min(SIMULATED_AFTER_PULSE / p, MAX_PULSE_PERIODS * pulse.period)
