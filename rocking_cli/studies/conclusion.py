"""The conclusion of a study: what is concluded, what governs and by how much, until when and how sure. No words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from math import isclose
from typing import Any, NamedTuple, Self, TypeVar

from rocking_cli.short_repr import short_repr

LEAST_SHARE = 0.1  # share of overturning neighbours that defines the `ratio` of a margin
SAME_RATIO = 1e-6  # relative difference below which two conclusions are equally severe
K = TypeVar("K")
V = TypeVar("V")


class Concluded(StrEnum):
    """Possible conclusions on a response or a verification, the worst last."""

    NO_UPLIFT = "does_not_uplift"
    SLIDES = "slides"
    COMES_TO_REST = "comes_to_rest"
    ROCKS = "rocks"
    STILL_MOVES = "still_moves"
    SATISFIED = "satisfied"
    SATISFIED_IF = "satisfied_only_if"
    NOT_CHECKED = "not_checked"
    NOT_DECIDED = "not_decided"
    UNKNOWN = "unknown"
    FALLS_OFF = "falls_off_an_edge"
    OVERTURNS = "overturns"
    NOT_SATISFIED = "not_satisfied"


SEVERITY = list(Concluded)


class Effect(StrEnum):
    """What a remark does to a conclusion: another number counts, it holds on a condition, or it is not decided."""

    REPLACES = "replaces"
    CONDITION = "condition"
    UNDECIDED = "undecided"


LIMITED: Mapping[Effect, Mapping[Concluded, Concluded]] = {
    Effect.REPLACES: {},
    Effect.CONDITION: {Concluded.SATISFIED: Concluded.SATISFIED_IF},
    Effect.UNDECIDED: dict.fromkeys(
        (Concluded.SATISFIED, Concluded.SATISFIED_IF, Concluded.NOT_SATISFIED), Concluded.NOT_DECIDED
    ),
}
"""What a conclusion becomes by each effect; others stay as they are."""


class Limit(NamedTuple):
    """A remark that limits a conclusion: its key among the texts, the values in it, and its effect."""

    key: str
    values: Mapping[str, Any]
    effect: Effect

    def stands_with(self, concluded: Concluded) -> bool:
        """Return whether it stands beside a conclusion: the reasons of this conclusion do, and replaced numbers."""
        return self.effect is Effect.REPLACES or concluded in LIMITED[self.effect].values()


class NextStep(StrEnum):
    """Next step to advise: about a joint, a motion, an input that does not count, or a result that is too poor."""

    HINGE_AT_JOINT = "hinge_at_joint"
    HOLD_JOINT = "hold_joint"
    STRONGER_BAR = "stronger_bar"
    ASSUME_OVERTURNING = "assume_overturning"
    STRENGTHEN = "strengthen"
    CONDITIONS = "check_conditions"
    MARGIN = "margin"
    YIELD_FORCE = "give_yield_force"
    MORE_MOTIONS = "give_more_motions"
    FIRST_MECHANISM = "verify_first_mechanism"
    SITE_VALUES = "give_site_values"
    RESTITUTION = "give_restitution"
    RESPOND = "respond"
    FREE_BLOCKS = "free_blocks"
    DESIGN = "design"


OF_VERIFICATION = {
    Concluded.SATISFIED_IF: NextStep.CONDITIONS,
    Concluded.NOT_SATISFIED: NextStep.DESIGN,
    Concluded.UNKNOWN: NextStep.RESPOND,
    Concluded.NOT_CHECKED: NextStep.SITE_VALUES,
}
OF_LEFT_OUT = {"tie": NextStep.YIELD_FORCE, "motion": NextStep.MORE_MOTIONS, "mechanism": NextStep.FIRST_MECHANISM}


class LeftOut(NamedTuple):
    """An input that was given but does not count in the result.

    Parameters
    ----------
    what : {"tie", "motion", "mechanism"}
        Its kind.
    name : str
        Its name; of a mechanism the joint that opens or slides.
    why : {"elastic", "too_few", "too_few_and_past", "starts_first"}
        The reason: an elastic tie, which has no strength, counts with its force at rest alone; the code requires more
        records, one of which may take the structure past its capacity; another mechanism starts before the one that was
        verified.
    give : str
        Path of the field of the structure that makes it count; empty if none does.
    state : str
        The limit state at which it does not count; empty if at none.
    """

    what: str
    name: str
    why: str
    give: str = ""
    state: str = ""


class NeighbourShare(NamedTuple):
    """Share of neighbouring motions that overturn: its lowest and highest value, and their number.

    The two differ by the neighbours of unknown outcome.
    """

    lowest: float
    highest: float
    of: int


class ByBlocks(NamedTuple):
    """What free blocks do beside one degree of freedom: the outcome, peak over phi_cr, slip [m], and a time [s].

    The time is that of the fall, or that at which the simulation of blocks that still move ends. Numbers that do not
    exist are None.
    """

    concluded: Concluded
    peak_ratio: float | None
    slip: float | None
    time: float | None


@short_repr
@dataclass(frozen=True, kw_only=True)
class Conclusion:
    """Conclusion of a study of one structure.

    Parameters
    ----------
    concluded : Concluded
        What is concluded, of all that was asked the worst.
    limit_state, method, direction, motion : str
        What governs; empty if it does not apply, or none governs.
    joint : str
        The joint at which the response that governs becomes unknown; empty if none.
    polarity : int or None
        The polarity of the motion that governs, 1 or -1; None if neither does.
    ratio : float or None
        By how much: capacity over demand of a verification; the scale factor from which a tenth of the neighbours
        overturn, or are of unknown outcome, of a margin (infinite if none does).
    required : float or None
        The ratio that a code requires of what governs; None if not known, or for other than a verification.
    rules : sequence of str
        Keys of the rules of a code by which its limit states and the required ratio were chosen.
    peak_ratio : float or None
        Peak over phi_cr (or the limit) of the response that governs; None if it overturns or is unknown: its history
        has the peak until then.
    slip : float or None
        Largest displacement of a body that only slides [m]; None for others.
    known_until : float or None
        Time until which the response that governs is known, `known_to` of its history [s]; None if all of it is known.
    share : NeighbourShare or None
        How sure: the share of the neighbours of the motion that governs.
    limit_states, motions : sequence of str
        Over what it is concluded: limit states that were verified, motions that were simulated.
    polarities : sequence of int
        The polarities that were simulated.
    directions : sequence of str
        The directions that were verified.
    left_out : sequence of LeftOut
        What was given and does not count.
    remedy : NextStep or None
        What to do about the joint at which the response that governs ends; None if all of it is known.
    witness : bool
        Whether free blocks can simulate what follows then.
    blocks : ByBlocks or None
        What free blocks do, if they were simulated beside one degree of freedom, by which all else is concluded.
    limits : sequence of Limit
        The remarks that limit it: replaced numbers, conditions under which it holds, or why it is not decided.
    """

    concluded: Concluded
    limit_state: str = ""
    method: str = ""
    direction: str = ""
    motion: str = ""
    joint: str = ""
    polarity: int | None = None
    ratio: float | None = None
    required: float | None = None
    rules: Sequence[str] = ()
    peak_ratio: float | None = None
    slip: float | None = None
    known_until: float | None = None
    share: NeighbourShare | None = None
    limit_states: Sequence[str] = ()
    motions: Sequence[str] = ()
    polarities: Sequence[int] = ()
    directions: Sequence[str] = ()
    left_out: Sequence[LeftOut] = ()
    remedy: NextStep | None = None
    witness: bool = False
    blocks: ByBlocks | None = None
    limits: Sequence[Limit] = ()

    def limited(self, limits: Sequence[Limit]) -> Conclusion:
        """Return the conclusion with what limits it."""
        concluded = self.concluded
        for each in limits:
            concluded = LIMITED[each.effect].get(concluded, concluded)
        return replace(self, concluded=concluded, limits=[each for each in limits if each.stands_with(concluded)])

    @property
    def told(self) -> Conclusion:
        """What is concluded by free blocks, if one degree of freedom does not tell the outcome; else itself."""
        if self.blocks is None or self.concluded is not Concluded.UNKNOWN:
            return self
        concluded, peak, slip, _ = self.blocks
        return replace(
            self, concluded=concluded, peak_ratio=peak, slip=slip, known_until=None, joint="", remedy=None, blocks=None
        )

    @property
    def next(self) -> Sequence[NextStep]:
        """What to do next, the most useful step first."""
        steps = [] if self.remedy is None else [self.remedy]
        if self.told.concluded in (Concluded.FALLS_OFF, Concluded.OVERTURNS):
            steps.append(NextStep.STRENGTHEN)
        neighbours_differ = self.share is not None and self.share.highest > 0 and self.share.lowest < 1
        if self.witness and self.blocks is None:
            steps.append(NextStep.FREE_BLOCKS)
        if self.ratio is None and (self.remedy not in (None, NextStep.RESTITUTION) or neighbours_differ):
            steps.append(NextStep.MARGIN)
        steps += dict.fromkeys(OF_LEFT_OUT[each.what] for each in self.left_out)
        if self.method and NextStep.FIRST_MECHANISM not in steps and self.concluded in OF_VERIFICATION:
            steps.append(OF_VERIFICATION[self.concluded])
        return steps


@short_repr
class Concluding(dict[K, V]):
    """Results by their keys, with their common conclusion.

    Parameters
    ----------
    results : mapping
        The results.
    conclusion : Conclusion
        What is concluded of them together.
    """

    def __init__(self, results: Mapping[K, V], conclusion: Conclusion) -> None:
        super().__init__(results)
        self.conclusion = conclusion

    def __reduce__(self) -> tuple[type[Self], tuple[dict[K, V], Conclusion]]:
        """Return how a pickle builds it: a plain dictionary, and the conclusion."""
        return type(self), (dict(self), self.conclusion)


def worst(found: Iterable[Conclusion]) -> Conclusion:
    """Return the worst of several conclusions: by `concluded`, then by share of neighbours, ratio and peak."""
    return max(found, key=severity)


def are_alike(one: Conclusion, other: Conclusion) -> bool:
    """Return whether two conclusions differ by no more than rounding, so that neither governs."""
    return all(isclose(a, b, rel_tol=SAME_RATIO) for a, b in zip(severity(one), severity(other), strict=True))


def severity(conclusion: Conclusion) -> tuple[float, ...]:
    """Return how bad a conclusion is, to compare it with others: of unknown outcomes, that of free blocks decides.

    Of equal ones, that which overturns earlier as free blocks is worse, and then that which is unknown earlier.
    """
    told = conclusion.told
    share = conclusion.share.highest if conclusion.share is not None else 0.0
    # Without a ratio, a motion takes the structure past its capacity: this is the worst.
    ratio = 0.0 if conclusion.ratio is None else -conclusion.ratio
    places = SEVERITY.index(conclusion.concluded), SEVERITY.index(told.concluded)
    falls = conclusion.blocks.time if conclusion.blocks is not None else None
    times = -(falls or 0.0), -(conclusion.known_until or 0.0)
    return *places, share, ratio, told.peak_ratio or 0.0, told.slip or 0.0, *times
