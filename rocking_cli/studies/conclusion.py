"""The conclusion of a study: what is concluded, what governs and by how much, until when and how sure. No words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple


class Concluded(StrEnum):
    """What is concluded, of a response or of a verification; the worst last."""

    NO_UPLIFT = "does_not_uplift"
    ROCKS = "rocks"
    SATISFIED = "satisfied"
    NOT_CHECKED = "not_checked"
    UNKNOWN = "unknown"
    OVERTURNS = "overturns"
    NOT_SATISFIED = "not_satisfied"


ORDER = list(Concluded)


class LeftOut(NamedTuple):
    """What was given and does not count.

    Parameters
    ----------
    what : {"tie", "motion", "mechanism"}
        Its kind.
    name : str
        Its name; of a mechanism the joint that opens or slides.
    why : {"elastic", "too_few", "too_few_and_past", "starts_first"}
        The reason: an elastic tie counts with its force at rest alone; the code requires more records, one of which may
        take the structure past its capacity; another mechanism starts before the one that was verified.
    """

    what: str
    name: str
    why: str


class NeighbourShare(NamedTuple):
    """Share of neighbouring motions that overturn: its lowest and highest value, and their number.

    The two differ by the neighbours of unknown outcome.
    """

    lowest: float
    highest: float
    of: int


@dataclass(frozen=True, kw_only=True)
class Conclusion:
    """Conclusion of a study of one structure.

    Parameters
    ----------
    concluded : Concluded
        What is concluded, of all that was asked the worst.
    limit_state, method, direction, motion, joint : str
        What governs; empty if it does not apply, or none governs.
    polarity : int or None
        The polarity of the motion that governs, 1 or -1; None if neither does.
    ratio : float or None
        By how much: capacity over demand of a verification, peak over phi_cr (or the limit) of a response.
    known_until : float or None
        Time until which the response that governs is known [s]; None if all of it is known.
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
    """

    concluded: Concluded
    limit_state: str = ""
    method: str = ""
    direction: str = ""
    motion: str = ""
    joint: str = ""
    polarity: int | None = None
    ratio: float | None = None
    known_until: float | None = None
    share: NeighbourShare | None = None
    limit_states: Sequence[str] = ()
    motions: Sequence[str] = ()
    polarities: Sequence[int] = ()
    directions: Sequence[str] = ()
    left_out: Sequence[LeftOut] = ()


def worst(found: Iterable[Conclusion]) -> Conclusion:
    """Return the worst of several conclusions: by what is concluded, then by the neighbours, then by the ratio."""
    return max(found, key=_severity)


def _severity(found: Conclusion) -> tuple[int, float, float]:
    share = found.share.highest if found.share is not None else 0.0
    ratio = 0.0 if found.ratio is None else found.ratio
    return ORDER.index(found.concluded), share, -ratio if found.limit_state or found.method else ratio
