"""Outcome of one motion or of many: the one result type of all solvers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from math import nan
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from rocking_cli import names
from rocking_cli.short_repr import short_repr

if TYPE_CHECKING:  # avoid importing numpy, which a single exact motion does not need
    import numpy as np
    from numpy.typing import NDArray

Flags = TypeVar("Flags")
Counts = TypeVar("Counts")
Numbers = TypeVar("Numbers")


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class Outcome(Generic[Flags, Counts, Numbers]):
    """Outcome of a motion, each field a number; or of many, each field an ndarray of one shape.

    Times and rotations that do not exist are NaN, and null in JSON.

    Parameters
    ----------
    still_rocking, failed : bool
        How the motion ended, if neither at rest nor by overturning: the structure still rocks, and will not overturn;
        the solver failed, and the other fields have no meaning.
    fell_to : int
        Sign of the direction in which the structure is known to overturn, which is to pass its critical rotation for
        good; 0 if it does not, or if that is not known.
    peak_positive, peak_negative : float
        Largest rotation in either direction [rad], >= 0; NaN in the direction of overturning.
    peak_ratio : float
        Largest rotation over the critical rotation; 0 without uplift, NaN after overturning.
    peak_rate_positive, peak_rate_negative : float
        Largest angular velocity while it rocks in either direction, outward or back [rad/s], >= 0; NaN in the direction
        of overturning.
    overturning_time : float
        Time at which the rotation passed the critical one for good [s]; NaN if it did not, or if not computed.
    uplift_time : float
        Time of the first uplift from rest [s]; NaN if there is none.
    impact_count : int
        Number of impacts before overturning, or up to the end of the motion, or up to where the solver stopped because
        the outcome could no longer change. All are counted, including the chatter before rest; `History.felt` has those
        of a history without it.
    end_time : float
        Time at which the structure came to rest for good, or was certain to overturn [s]; 0 if it never moved, the last
        time that was computed if it still rocks, and NaN if not computed.
    unknown : bool
        Whether a joint opened or slid so far, before the motion ended, that the model is not valid from then on: peaks,
        uplift and impacts are those until then.
    known_to : float
        Time until which the motion is valid [s]; NaN if all of it is.
    warned : float
        First time at which a joint would open or slide [s]; NaN if there is none.
    lower_bound : float
        Largest rotation over the critical rotation until `warned`, a lower bound of the peak ratio of the structure;
        NaN if `warned` is.
    opening : float
        Largest opening or slip of a joint, over that of the farthest block at the critical rotation; NaN if the joints
        are not known, so that nothing was checked. Of a `History` it is that of all of it; of many motions, each of
        which ends once it is unknown, that until there.
    by_blocks : bool
        Whether it was simulated with free blocks.
    slip : float
        Largest displacement of a body that slides and never rocks [m]; 0 if it does not slide, and for other
        structures.
    off_edge : bool
        Whether it overturns because a free block falls off an edge that the file draws.
    """

    still_rocking: Flags
    failed: Flags
    fell_to: Counts
    peak_positive: Numbers
    peak_negative: Numbers
    peak_ratio: Numbers
    peak_rate_positive: Numbers
    peak_rate_negative: Numbers
    overturning_time: Numbers
    uplift_time: Numbers
    impact_count: Counts
    end_time: Numbers
    unknown: Flags
    known_to: Numbers
    warned: Numbers
    lower_bound: Numbers
    opening: Numbers
    by_blocks: Flags
    slip: Numbers
    off_edge: Flags

    @property
    def peak_rate(self) -> Numbers:
        """Largest angular velocity in both directions [rad/s]; 0 without uplift, NaN after overturning."""
        one, other = self.peak_rate_positive, self.peak_rate_negative
        return one * (one >= other) + other * (other > one)  # type: ignore[operator,no-any-return]

    @property
    def fell(self) -> Flags:
        """Whether the structure is known to overturn; False if it does not, and if that is not known."""
        return self.fell_to != 0  # type: ignore[return-value]

    @property
    def overturned(self) -> Numbers | bool | None:
        """Whether the structure overturns; of one motion True or False, None if unknown or if the solver failed.

        Of many motions an ndarray of 1.0, 0.0, and NaN if unknown or if the solver failed: its sum and its mean are
        NaN as soon as one outcome is not known. Use `share` for the share that overturns.
        """
        hidden: Any = self.unknown | self.failed  # type: ignore[operator]
        if not getattr(hidden, "shape", ()):
            return None if hidden else bool(self.fell)
        import numpy as np

        return np.where(hidden, np.nan, self.fell)  # type: ignore[call-overload, no-any-return]

    def share(self: Outcomes) -> tuple[float, float]:
        """Return the lowest and the highest share of many motions that overturn the structure.

        In the lowest no motion of unknown outcome overturns the structure, in the highest all of them do. Motions that
        could not be simulated are left out. Both are NaN if no motion is left.

        Examples
        --------
        >>> import rocking_cli as rk
        >>> rk.respond_each("examples/block.yaml", "examples/accel.csv", scale=[1, 2, 3, 4])["nonlinear"].share()
        (0.25, 0.25)
        """
        ran = ~self.failed
        many = int(ran.sum())
        low, high = (int((of & ran).sum()) for of in (self.fell, self.fell | self.unknown))
        return (low / many, high / many) if many else (nan, nan)

    @property
    def at_rest(self) -> Flags:
        """Whether the structure came to rest in the end, or never uplifted."""
        moved_or_unknown: Any = self.fell | self.still_rocking | self.failed | self.unknown  # type: ignore[operator]
        return moved_or_unknown ^ True  # type: ignore[no-any-return]

    @property
    def lifted(self) -> Flags:
        """Whether the structure moved at all, by uplift or by a release from a tilt."""
        return (self.uplift_time >= 0) | self.fell | (self.peak_ratio > 0)  # type: ignore[operator, no-any-return]

    def by_field(self: Outcomes, change: Callable[..., Any], *others: Outcomes) -> Outcomes:
        """Return an outcome whose fields are `change` of the same field of this outcome and of `others`.

        Parameters
        ----------
        change : callable
            Function of an ndarray from each outcome that returns an ndarray.
        others : Outcome
            Further outcomes of many motions.
        """
        return Outcome(**{name: change(*(getattr(each, name) for each in (self, *others))) for name in OUTCOME_FIELDS})

    @property
    def words(self) -> str:
        """Outcome of one motion, in the words of `rocking_cli.names`."""
        return names.outcome(
            uplifts=bool(self.lifted),
            overturned=bool(self.fell),
            still_rocking=bool(self.still_rocking),
            unknown=bool(self.unknown),
            slides=bool(self.slip),
        )


UNCHECKED_FIELDS: dict[str, Any] = {
    "unknown": False,
    "known_to": nan,
    "warned": nan,
    "lower_bound": nan,
    "opening": nan,
    "by_blocks": False,
    "slip": 0.0,
    "off_edge": False,
}
"""The fields of a model that has no joints to be checked, such as an equivalent block."""

OneOutcome: TypeAlias = "Outcome[bool, int, float]"
"""Outcome of one motion."""
Outcomes: TypeAlias = "Outcome[NDArray[np.bool_], NDArray[np.int64], NDArray[np.float64]]"
"""Outcomes of many motions, as arrays."""

OUTCOME_FIELDS = tuple(field.name for field in fields(Outcome))
ROTATIONS = ("peak_positive", "peak_negative", "peak_rate_positive", "peak_rate_negative")
"""The fields that grow with the slenderness of a structure."""
