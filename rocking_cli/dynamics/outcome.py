"""What became of a motion, or of many: the one answer of every solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from math import nan
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from rocking_cli import names

if TYPE_CHECKING:  # numpy: who asks for one exact motion has not paid for it
    import numpy as np
    from numpy.typing import NDArray

Flags = TypeVar("Flags")
Counts = TypeVar("Counts")
Numbers = TypeVar("Numbers")


@dataclass(frozen=True, eq=False, kw_only=True)
class Outcome(Generic[Flags, Counts, Numbers]):
    """What became of a motion, each a number; or of many, each an ndarray of one shape.

    Times and rotations that do not exist are NaN, and null in JSON.

    Parameters
    ----------
    overturned, still_rocking, failed : bool
        How it ended, if not at rest: it passed its critical rotation for good; it was left rocking, and will not
        overturn; it could not be followed, and its other values mean nothing.
    fell_to : int
        Sign of the direction in which it overturned, 0 if it did not.
    peak_positive, peak_negative : float
        Largest rotation in either direction [rad], >= 0; NaN in a direction in which it overturned.
    peak_ratio : float
        Largest rotation over the critical rotation; 0 without uplift, NaN if it overturned.
    overturning_time : float
        When the rotation passed the critical one for good [s]; NaN if it did not, or this was not requested.
    uplift_time : float
        The first uplift from rest [s]; NaN if there is none.
    impact_count : int
        Number of impacts: before it overturned; else up to the end of the motion, or to where it was left because
        nothing could change any more.
    end_time : float
        When it came to rest for good, or was certain to overturn [s]; NaN if this was not requested.
    unknown : bool
        Whether a joint has opened or slid so far, before the motion ended, that what the model says of it from then on
        is no result: peaks, uplift and impacts are those until then.
    known_to : float
        Until when the motion is known [s]; NaN if all of it is.
    warned : float
        The first moment at which a joint would not bear [s]; NaN if there is none.
    lower_bound : float
        Largest rotation over the critical rotation until `warned`: the structure itself rocks no less. NaN without one.
    opening : float
        Largest opening or slip of a joint, over the least displacement of a block at the critical rotation; NaN if the
        joints are not known, so that nothing was checked.
    """

    overturned: Flags
    still_rocking: Flags
    failed: Flags
    fell_to: Counts
    peak_positive: Numbers
    peak_negative: Numbers
    peak_ratio: Numbers
    overturning_time: Numbers
    uplift_time: Numbers
    impact_count: Counts
    end_time: Numbers
    unknown: Flags
    known_to: Numbers
    warned: Numbers
    lower_bound: Numbers
    opening: Numbers

    @property
    def at_rest(self) -> Flags:
        """Whether it came to rest in the end, or never lifted."""
        left: Any = self.overturned | self.still_rocking | self.failed | self.unknown  # type: ignore[operator]
        return left ^ True  # type: ignore[no-any-return]

    @property
    def lifted(self) -> Flags:
        """Whether it moved at all, by uplift or by a release from a tilt."""
        return (self.uplift_time >= 0) | self.overturned | (self.peak_ratio > 0)  # type: ignore[operator, no-any-return]

    def by_field(self: Outcomes, change: Callable[..., Any], *others: Outcomes) -> Outcomes:
        """The outcome of which every field is `change` of that field here, and of that of others.

        Parameters
        ----------
        change : callable
            Takes an ndarray of each outcome, and gives one.
        others : Outcome
            Of many motions, too.
        """
        return Outcome(**{name: change(*(getattr(each, name) for each in (self, *others))) for name in OUTCOME})

    @property
    def words(self) -> str:
        """How one motion ended, in the words of `rocking_cli.names`."""
        return names.outcome(
            uplifts=bool(self.lifted),
            overturned=bool(self.overturned),
            still_rocking=bool(self.still_rocking),
            unknown=bool(self.unknown),
        )


UNCHECKED: dict[str, Any] = {"unknown": False, "known_to": nan, "warned": nan, "lower_bound": nan, "opening": nan}
"""The fields of a model that has no joints to be checked, such as an equivalent block."""

OneOutcome: TypeAlias = "Outcome[bool, int, float]"
"""Of one motion."""
Outcomes: TypeAlias = "Outcome[NDArray[np.bool_], NDArray[np.int64], NDArray[np.float64]]"
"""Of many motions, one a place."""

OUTCOME = tuple(field.name for field in fields(Outcome))
