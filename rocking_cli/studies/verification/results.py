"""What a verification by any code found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Literal

from rocking_cli.core import Direction, Mechanism
from rocking_cli.studies.verification.capacity import ExactCurve
from rocking_cli.studies.verification.chain import Chain
from rocking_cli.studies.verification.working import Working

CLOSE = 1e-12  # of a demand: what rounding may take from a capacity that equals it
ALIKE = 1e-9  # of a ratio: of directions that differ by less none governs


@dataclass(frozen=True)
class State:
    """A limit state on a capacity curve.

    Parameters
    ----------
    d, a, T : float
        Displacement that it allows [m], acceleration there [m/s2], and the period of both [s].
    demand : float or None
        Displacement that the site asks for [m]; None where the site file does not give this limit state.
    """

    d: float
    a: float
    T: float
    demand: float | None

    @property
    def ratio(self) -> float | None:
        """Capacity over demand: it passes from 1."""
        return None if self.demand is None else self.d / self.demand

    @property
    def passes(self) -> bool | None:
        """Whether it does."""
        return None if self.ratio is None else self.ratio >= 1 - CLOSE


@dataclass(frozen=True)
class Method:
    """Capacity of the structure by one method of verification.

    Parameters
    ----------
    title : str
        What to call it.
    a_g : float or None
        Capacity, as ground acceleration on rock [g]; None if the site does not give what that depends on.
    asked : float or None
        Demand: that of its limit state at the site [g].
    clause : str
        Where in the code.
    return_period : float or None
        The same capacity as a return period, where the hazard is known [years].
    beyond : bool
        Whether the capacity is beyond the table, whose end the return period then is.
    """

    title: str
    a_g: float | None
    asked: float | None
    clause: str
    return_period: float | None = None
    beyond: bool = False

    @property
    def zeta(self) -> float | None:
        """zeta_E, capacity over demand."""
        return None if self.a_g is None or self.asked is None else self.a_g / self.asked

    @property
    def passes(self) -> bool | None:
        """Whether the capacity meets the demand; None if the site does not give the demand."""
        return None if self.zeta is None else self.zeta >= 1 - CLOSE


@dataclass(frozen=True)
class RecordPeak:
    """The largest displacement under one record, with FC and without.

    Parameters
    ----------
    name : str
        Of the record.
    with_confidence, without : float or None
        The displacement [m]; None where the structure overturned, or the outcome is unknown.
    known_to_with_confidence, known_to_without : float or None
        Until when the outcome is known [s], where it is unknown.
    """

    name: str
    with_confidence: float | None
    without: float | None
    known_to_with_confidence: float | None = None
    known_to_without: float | None = None

    def peak(self, *, confident: bool) -> float | None:
        """The displacement with FC, or without [m]."""
        return self.with_confidence if confident else self.without

    def known_to(self, *, confident: bool) -> float | None:
        """Until when the outcome is known with FC, or without [s]; None if all of it is known."""
        return self.known_to_with_confidence if confident else self.known_to_without


Moves = Literal["as_given", "carried_to_floor", "carried_by_option", "of_floor"]
"""What the motions of histories are: those given, where the site has no floor; ground motions carried to the floor of
the site, or to that given with the records; or motions of the floor, as the user states."""


@dataclass(frozen=True)
class Motions:
    """What moves the structure in histories.

    Parameters
    ----------
    kind : str
        One of `Moves`.
    floor : str or None
        The floor to which ground motions are carried: period [s], damping ratio, height over that of the building and
        participation factor.
    """

    kind: Moves = "as_given"
    floor: str | None = None


@dataclass(frozen=True)
class Dynamic:
    """What histories say of a direction.

    Parameters
    ----------
    records : sequence of RecordPeak
        What each record did.
    d0 : float
        Displacement that no record may pass [m].
    allowed : mapping of str to float
        The displacement that the mean may reach at the limit state to which the records belong [m].
    enough : int
        How many records the code wants.
    checked : bool
        Whether the joints of the structure are known; if not, no outcome is said to be unknown.
    motions : Motions
        What the records are motions of.
    """

    records: Sequence[RecordPeak]
    d0: float
    allowed: Mapping[str, float]
    enough: int
    checked: bool = True
    motions: Motions = Motions()

    def mean(self, *, confident: bool) -> float | None:
        """The mean of the largest displacements [m]; None where one overturned, passed d0* or is unknown."""
        found = self.peaks(confident=confident)
        known = [each for each in found if each is not None and each < self.d0]
        return sum(known) / len(found) if len(known) == len(found) else None

    def peaks(self, *, confident: bool) -> list[float | None]:
        """The largest displacement under each record [m]."""
        return [each.peak(confident=confident) for each in self.records]

    def passed(self, *, confident: bool) -> list[str]:
        """The records that pass d0*."""
        known = [each for each in self.records if each.known_to(confident=confident) is None]
        pairs = [(each.name, each.peak(confident=confident)) for each in known]
        return [name for name, d in pairs if d is None or d >= self.d0]

    def unknown(self, *, confident: bool) -> list[str]:
        """The records of unknown outcome."""
        return [each.name for each in self.records if each.known_to(confident=confident) is not None]

    def holds(self, state: str, *, confident: bool) -> bool:
        """Whether it holds at a limit state; with an unknown outcome it does not."""
        mean = self.mean(confident=confident)
        return mean is not None and mean <= self.allowed[state]


@dataclass(frozen=True, eq=False)
class Verified:
    """What was found in one direction of rocking.

    Parameters
    ----------
    direction : Direction
    lambda_, a0, d0, M : float
        Uplift acceleration over g; a0* [m/s2]; d0* [m]; M* [kg], None without masses.
    exact : ExactCurve
        The capacity curve as the mechanism moves, with the control point and FC.
    states, straight_states : mapping of str to State
        The limit states on the exact curve, and on the straight line.
    methods, straight_methods : mapping of str to Method
        What each method says on either.
    governing : mapping of str to str
        The method that governs at each limit state.
    governs : str
        The method that governs at the first one.
    workings : sequence of Working
        How its numbers came about.
    remarks : sequence of str
        Sentences on what to know of them.
    dynamic : Dynamic, optional
        What histories say.
    """

    direction: Direction
    lambda_: float
    a0: float
    d0: float
    M: float | None
    exact: ExactCurve
    states: Mapping[str, State]
    straight_states: Mapping[str, State]
    methods: Mapping[str, Method]
    straight_methods: Mapping[str, Method]
    governing: Mapping[str, str]
    governs: str
    workings: Sequence[Working]
    remarks: Sequence[str]
    dynamic: Dynamic | None = None

    @property
    def chain(self) -> Chain:
        """What moves, with its sums."""
        return self.exact.chain

    @property
    def counts(self) -> Method:
        """The method that governs at the first limit state."""
        return self.methods[self.governs]

    def passes(self, state: str) -> bool | None:
        """Whether it passes at a limit state by what governs; None where the site does not give it."""
        held = self.methods[self.governing[state]].passes
        return None if held is None else held or bool(self.states[state].passes)


@dataclass(frozen=True, eq=False)
class Verification:
    """Verification of a structure by a code.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    code, name, edition : str
        By which code, as site files call it and as people do, and which edition of it.
    first : str
        The limit state by which directions are compared.
    directions : mapping of Direction to Verified
        What was found in each direction that it can rock in.
    workings : sequence of Working
        Of what is the same in both, such as the ground.
    remarks : sequence of str
        Sentences on the whole.
    taken_otherwise : sequence of str
        Those of them on what was taken otherwise than the structure gives it.
    """

    mechanism: Mechanism
    code: str
    name: str
    edition: str
    first: str
    directions: Mapping[Direction, Verified]
    workings: Sequence[Working]
    remarks: Sequence[str]
    taken_otherwise: Sequence[str] = ()

    @property
    def governs(self) -> Direction:
        """The direction with the smaller ratio of displacements; the first of those that are alike."""
        ratios = self._ratios
        return next(direction for direction, ratio in ratios.items() if ratio <= min(ratios.values()) * (1 + ALIKE))

    @property
    def alike(self) -> bool:
        """Whether no direction has a smaller ratio than the other."""
        ratios = self._ratios.values()
        return max(ratios) <= min(ratios) * (1 + ALIKE)

    @property
    def _ratios(self) -> dict[Direction, float]:
        found = {direction: each.states[self.first].ratio for direction, each in self.directions.items()}
        return {key: ratio if ratio is not None and isfinite(ratio) else inf for key, ratio in found.items()}
