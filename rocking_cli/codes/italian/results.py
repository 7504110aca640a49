"""Results of a verification by the Italian code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from math import inf, isclose
from typing import TYPE_CHECKING, Any

from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.rules import LONG_PERIOD, OF_STATE, STATE_OF_METHOD
from rocking_cli.core import Direction
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.conclusion import Concluded, Conclusion, LeftOut, worst
from rocking_cli.studies.remark import Remark
from rocking_cli.verification import results as frame
from rocking_cli.verification.results import CAPACITY_TOLERANCE, MotionPlace, Requirement

if TYPE_CHECKING:
    from rocking_cli.dynamics.history import History
    from rocking_cli.excitation.base import GroundMotion

HISTORIES = "histories"
"""The key of the method by time histories in a conclusion."""
PASSED: Mapping[Concluded | None, bool] = {Concluded.SATISFIED: True, Concluded.NOT_SATISFIED: False}
SAME_RATIO = 1e-9  # relative difference below which two directions are shown as one


@dataclass(frozen=True)
class LimitState:
    """A limit state on a capacity curve.

    Parameters
    ----------
    d, by, a, T : float, str, float, float
        Displacement capacity [m], what ends it (`ends`), acceleration of the curve there [m/s2], period of both [s].
    demand : float or None
        Displacement demand of the site [m]; None if the site file does not give this limit state.
    """

    d: float
    by: str
    a: float
    T: float
    demand: float | None

    @property
    def ratio(self) -> float | None:
        """Displacement capacity over demand; None without a demand."""
        return None if self.demand is None else self.d / self.demand


@short_repr
@dataclass(frozen=True)
class ItalianMethod(frame.Method):
    """Capacity of the structure by one method of verification, as ground acceleration on rock [g].

    Parameters
    ----------
    in_years : callable
        Returns the capacity as a return period [years], None if the hazard is not known, and whether it is beyond the
        table of the hazard; the return period is then the end of the table.
    """

    in_years: Callable[[], tuple[float | None, bool]] = field(default=lambda: (None, False), repr=False, compare=False)
    unit: str = field(default="g", kw_only=True)

    def __getstate__(self) -> dict[str, Any]:
        """Return what a pickle keeps: the return period is computed."""
        return {**vars(self), "in_years": partial(tuple, self.in_years())}

    @cached_property
    def return_period(self) -> float | None:
        """The capacity as a return period [years]; None if the hazard is not known."""
        return self.in_years()[0]

    @cached_property
    def beyond(self) -> bool:
        """Whether the capacity is beyond the table of the hazard."""
        return self.in_years()[1]

    @property
    def a_g(self) -> float | None:
        """Capacity as ground acceleration on rock [g]; None if the site lacks values for it."""
        return self.capacity

    @property
    def zeta(self) -> float | None:
        """zeta_E, capacity over demand."""
        return self.ratio

    @property
    def lasts(self) -> str:
        """The return period as printed, with > or < beyond the table; empty if it is not known."""
        if self.return_period is None:
            return ""
        mark = ("" if self.zeta is None else ">" if self.zeta >= 1 else "<") if self.beyond else ""
        return f"{mark}{self.return_period:.0f}"


@dataclass(frozen=True)
class RecordPeak:
    """Peak displacements under one record, with FC and without.

    Parameters
    ----------
    name : str
        Name of the record.
    with_confidence, without : float or None
        The peak displacement [m]; None if the structure overturned, or the outcome is unknown.
    known_to_with_confidence, known_to_without : float or None
        Time until which the history is known [s]; None if all of it is known.
    scale_factor : float
        Factor on the accelerations of the file.
    why : Remark or None
        Why the outcome with FC, or else that without, is not known longer; None if all of it is known.
    history : History, optional
        The history with FC that has the peak `with_confidence`, in the time of `dynamic.with_confidence`.
    """

    name: str
    with_confidence: float | None
    without: float | None
    known_to_with_confidence: float | None = None
    known_to_without: float | None = None
    scale_factor: float = 1.0
    why: Remark | None = None
    history: History | None = field(default=None, compare=False)

    def peak(self, *, confident: bool) -> float | None:
        """Return the peak displacement with FC, or without [m]."""
        return self.with_confidence if confident else self.without

    def known_to(self, *, confident: bool) -> float | None:
        """Return until when the outcome is known with FC, or without [s]; None if all of it is known."""
        return self.known_to_with_confidence if confident else self.known_to_without


@short_repr
@dataclass(frozen=True)
class Dynamic:
    """Results of the time histories in one direction, under the set of records of one limit state.

    Parameters
    ----------
    state : str
        The limit state to which the records belong.
    records : sequence of RecordPeak
        Peak displacements under each record.
    d0 : float
        Displacement d0* that no record may exceed [m].
    allowed : float
        The displacement that the mean may reach at the limit state [m].
    enough : int
        Number of records that the code requires.
    unchecked : str, optional
        Why the joints of the structure are not checked, see `Mechanism.unchecked`; then no outcome is unknown.
    motions : MotionPlace
        Kind of the motions: of the ground or of a floor.
    scaled : sequence of GroundMotion
        The scaled records as given, before they are carried to a floor of the site.
    refused : sequence of str
        Names of the records of the set that could not be used, and do not count.
    """

    state: str
    records: Sequence[RecordPeak]
    d0: float
    allowed: float
    enough: int
    unchecked: str | None = None
    motions: MotionPlace = field(default_factory=MotionPlace)
    scaled: Sequence[GroundMotion] = ()
    refused: Sequence[str] = ()

    @property
    def checked(self) -> bool:
        """Whether the joints of the structure are checked."""
        return self.unchecked is None

    def mean(self, *, confident: bool) -> float | None:
        """Return the mean of the peak displacements [m]; None if one overturned, exceeded d0* or is unknown."""
        peaks = self.peaks(confident=confident)
        known = [each for each in peaks if each is not None and each < self.d0]
        return sum(known) / len(peaks) if len(known) == len(peaks) else None

    def peaks(self, *, confident: bool) -> list[float | None]:
        """Return the peak displacement under each record [m]."""
        return [each.peak(confident=confident) for each in self.records]

    def largest(self, *, confident: bool) -> float | None:
        """Return the largest known peak [m], of the records that do not overturn the structure; None without one."""
        return max((d for d in self.peaks(confident=confident) if d is not None), default=None)

    @property
    def drawn(self) -> RecordPeak | None:
        """The record with the largest known peak with FC, whose history is drawn; None if no such peak is known."""
        known = [each for each in self.records if each.with_confidence is not None]
        return max(known, key=lambda each: each.with_confidence or 0.0, default=None)

    def passed(self, *, confident: bool) -> list[str]:
        """Return the names of the records that exceed d0* or overturn the structure."""
        known = [each for each in self.records if each.known_to(confident=confident) is None]
        pairs = [(each.name, each.peak(confident=confident)) for each in known]
        return [name for name, d in pairs if d is None or d >= self.d0]

    def unknown(self, *, confident: bool) -> list[str]:
        """Return the names of the records of unknown outcome."""
        return [each.name for each in self.records if each.known_to(confident=confident) is not None]

    @property
    def too_few(self) -> bool:
        """Whether the code requires more records before their mean may be used."""
        return len(self.records) < self.enough

    @property
    def requirement(self) -> Requirement | None:
        """The requirement on the mean of the histories with FC; None if the code requires more histories."""
        if self.too_few:
            return None
        mean, exceeding = self.mean(confident=True), self.passed(confident=True)
        if exceeding or (mean is not None and not self.holds(confident=True)):
            concluded = Concluded.NOT_SATISFIED
        else:
            concluded = Concluded.UNKNOWN if mean is None else Concluded.SATISFIED
        ratio = None if mean is None else (self.allowed / mean if mean else inf)
        motion = next(iter(exceeding + self.unknown(confident=True)), "")  # past d0*, or else unknown
        return Requirement(self.state, HISTORIES, ratio, concluded, [each.name for each in self.records], motion)

    def holds(self, *, confident: bool) -> bool:
        """Return whether the mean passes; with an unknown outcome it does not."""
        mean = self.mean(confident=confident)
        return mean is not None and mean <= self.allowed


@short_repr
@dataclass(frozen=True, eq=False)
class ItalianVerified(frame.Verified):
    """Result in one direction of rocking by the Italian code, in addition to that of every code.

    Parameters
    ----------
    first : str
        The limit state of displacement whose verification decides.
    required : mapping of str to float or None
        The zeta_E that the code requires at each limit state that it asks for; None if it depends on the structure
        before an intervention, which is not known.
    lambda_, a0, d0, M : float
        Uplift acceleration over g; a0* [m/s2]; d0* [m]; M* [kg], None without masses.
    exact : ExactCurve
        The capacity curve as the mechanism moves, with the control point and FC.
    states, straight_states : mapping of str to LimitState
        The limit states on the exact curve, and on the straight line.
    methods, straight_methods : mapping of str to ItalianMethod
        Result of each method on either curve.
    governing : mapping of str to str
        The method that governs at each limit state, SLD among them; `governs` is that at the first one.
    T0 : float, optional
        Period of an element that vibrates before it rocks [s].
    dynamic : mapping of str to Dynamic
        Results of time histories, by the limit state to which each set of records belongs; empty without records.
    letter : ItalianVerified, optional
        What the letter of the code gives, if weights of the mechanism itself do not move sideways.
    """

    methods: Mapping[str, ItalianMethod]
    first: str
    required: Mapping[str, float | None]
    lambda_: float
    a0: float
    d0: float
    M: float | None
    exact: ExactCurve
    states: Mapping[str, LimitState]
    straight_states: Mapping[str, LimitState]
    straight_methods: Mapping[str, ItalianMethod]
    governing: Mapping[str, str]
    T0: float | None = None
    dynamic: Mapping[str, Dynamic] = field(default_factory=dict)
    letter: ItalianVerified | None = None

    @property
    def zeta_E(self) -> float | None:
        """Capacity over demand as ground acceleration, by the static method that governs of all limit states."""
        static = [each for each in self.conclusions if each.method in self.methods]
        return self.methods[worst(static).method].zeta

    @property
    def chain(self) -> Chain:
        """The moving blocks, with their sums."""
        return self.exact.chain

    @property
    def counts(self) -> ItalianMethod:
        """The method that governs at the first limit state."""
        return self.methods[self.governs]

    def stands_back(self, method: str) -> bool:
        """Return whether a method is the onset of rocking at a further limit state, at which displacement governs."""
        return any(
            method == OF_STATE[state][0] != self.governing[state] for state in self.states if state != self.first
        )

    def decides(self, method: str) -> str:
        """Return the limit state at which a method governs; empty if it governs at none."""
        state = STATE_OF_METHOD[method]
        return state if self.governing[state] == method else ""

    def zeta_at(self, state: str) -> float | None:
        """Return zeta_E at a limit state, by the method that governs there."""
        return self.methods[self.governing[state]].zeta

    def concluded(self, state: str) -> Concluded | None:
        """Return what is concluded at a limit state by the static methods; None if it is not required."""
        if state not in self.required:
            return None
        zeta, required = self.zeta_at(state), self.required[state]
        if zeta is None or required is None:
            return Concluded.NOT_CHECKED if zeta is None and state == self.first else Concluded.NOT_DECIDED
        return Concluded.SATISFIED if zeta >= required * (1 - CAPACITY_TOLERANCE) else Concluded.NOT_SATISFIED

    def passes(self, state: str) -> bool | None:
        """Return whether the direction passes at a limit state; None if it is not required, or not decided."""
        return PASSED.get(self.concluded(state))

    @property
    def passed(self) -> bool | None:
        """Whether the direction passes at all limit states that are required, by the static methods."""
        outcomes = [self.passes(state) for state in self.required]
        return False if False in outcomes else None if None in outcomes else True

    @property
    def ratio(self) -> float | None:
        """Smallest zeta_E over the limit states that are required; None if one is not known."""
        known = [self.zeta_at(state) for state in self.required]
        return None if None in known else min(zeta for zeta in known if zeta is not None)

    @property
    def checks(self) -> Sequence[Requirement]:
        """Requirements at the limit states; those of time histories if there are enough of them.

        Above the longest period of the code's spectrum, the time histories of a limit state are in place of its static
        method.

        Histories under the whole ground motion decide only whether zeta_E reaches 1.
        """
        histories = {each.state: each for one in self.dynamic.values() if (each := one.requirement) is not None}
        checks = [
            Requirement(state, self.governing[state], self.zeta_at(state), concluded, required=required)
            for state, required in self.required.items()
            if (concluded := self.concluded(state)) and not (state in histories and self.is_long(state))
        ]  # fmt: skip
        for each in histories.values():
            required = self.required.get(each.state, 1.0)
            fails = each.concluded is not Concluded.SATISFIED
            known = each.concluded is not Concluded.UNKNOWN
            is_open = known and (required is None or required > 1 or (fails and required < 1))
            checks.append(each._replace(concluded=Concluded.NOT_DECIDED) if is_open else each)
        return checks

    def is_long(self, state: str) -> bool:
        """Return whether displacement governs at a limit state with a period beyond that of the code's spectrum."""
        return state in self.by_displacement and self.states[state].T > LONG_PERIOD

    @property
    def by_displacement(self) -> list[str]:
        """The required limit states at which displacement governs."""
        return [
            state for state, at in self.states.items()
            if state in self.required and at.demand is not None and OF_STATE[state][1] == self.governing[state]
        ]  # fmt: skip

    def is_like(self, other: frame.Verified) -> bool:
        """Return whether another direction has the same curve; False with histories, as motions are not symmetric."""
        assert isinstance(other, ItalianVerified)  # all directions are verified by the same code
        pairs = [(self.a0, other.a0), (self.d0, other.d0), (self.chain.e_star, other.chain.e_star)]
        pairs += [(self.states[key].a, other.states[key].a) for key in self.states]
        return not (self.dynamic or other.dynamic) and all(isclose(a, b, rel_tol=SAME_RATIO) for a, b in pairs)


@short_repr
@dataclass(frozen=True, eq=False)
class ItalianVerification(frame.Verification):
    """Verification of a structure by the Italian code.

    Parameters
    ----------
    variants : callable
        Returns the direction that decides without the ties, and by our reading of P + Q, by key; empty without either.
    """

    directions: Mapping[Direction, ItalianVerified]
    variants: Callable[[], Mapping[str, ItalianVerified]] = field(default=dict, kw_only=True)

    @property
    def first(self) -> str:
        """The limit state by which directions are compared."""
        return next(iter(self.directions.values())).first

    def compared(self, direction: Direction) -> float | None:
        """Return the smallest ratio of a direction at all limit states; None if unknown."""
        return self.directions[direction].ratio

    @property
    def conclusion(self) -> Conclusion:
        """The check that governs, with the records that are too few to count, and which of them exceed capacity."""
        conclusion, why = super().conclusion, dict[tuple[str, str], str]()
        for each in (one for side in self.directions.values() for one in side.dynamic.values() if one.too_few):
            past = each.passed(confident=True)
            for record in each.records:
                key = each.state, record.name
                why[key] = "too_few_and_past" if record.name in past else why.get(key, "too_few")
        uncounted = [LeftOut("motion", name, reason, state=state) for (state, name), reason in why.items()]
        return replace(conclusion, left_out=[*conclusion.left_out, *uncounted])
