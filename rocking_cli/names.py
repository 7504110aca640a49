"""Words shared by all commands, in a module that imports nothing heavy.

A motion has one of six outcomes: the structure does not uplift; it slides and never rocks; it rocks, that is, it
uplifts and comes to rest; it overturns; it is still rocking long after the end of the ground motion, without going to
overturn; or the outcome is unknown, because a joint opens or slides that the model keeps closed, or something is met.
Free blocks have two more: one falls off an edge that the file draws, and counts as overturned; or all come to rest, in
a structure whose mechanism has no rotation.
"""

from __future__ import annotations

from typing import Literal, get_args

NO_UPLIFT = "does not uplift"
SLIDES = "does not overturn; slides"
ROCKS = "rocks"
OVERTURNS = "overturns"
STILL_ROCKING = "still rocking"
UNKNOWN = "unknown"
FALLS_OFF = "falls off the edge of"
COMES_TO_REST = "comes to rest"

Language = Literal["en", "it"]
LANGUAGES = get_args(Language)
"""Languages of calculation sheets and of templates."""

MAX_NEIGHBOURS = 1_000_000  # which take minutes
OPENING = 0.005
"""Largest opening of a joint up to which an outcome is known, over D_cr, unless another one is given."""
RTOL = 1e-9  # local error of a step by the lower order of the pair; peaks are then accurate to 1e-11
FINEST_RTOL = 1e-14  # a smaller tolerance is below rounding, so that no step is accepted
TAIL_SECONDS = 10.0  # s after the record for which samples are kept


def outcome(
    *, uplifts: bool, overturned: bool, still_rocking: bool = False, unknown: bool = False, slides: bool = False
) -> str:
    """Return the outcome of a motion, in the words of this module.

    Parameters
    ----------
    uplifts, overturned, still_rocking : bool
        Whether the structure uplifts (also by a release), whether it overturns, and whether it is still rocking.
    unknown : bool
        Whether the model ceases to hold before the motion ends.
    slides : bool
        Whether the structure only slides.

    Examples
    --------
    >>> outcome(uplifts=True, overturned=False)
    'rocks'
    """
    if unknown:
        return UNKNOWN
    if overturned:
        return OVERTURNS
    if still_rocking:
        return STILL_ROCKING
    return ROCKS if uplifts else SLIDES if slides else NO_UPLIFT


MIN_MOTIONS, MIN_MOTIONS_OF_MEDIAN = 18, 6
"""Least number of motions for the quantiles of 16 and 84 %, and for the median.

With fewer, the lowest and the highest peak do not enclose the quantile with a confidence of 95 %, so that no number of
motions ranked below and above it bounds the quantile.
"""
HALF_UP = 1e-9  # %: a share that ends in .5 is rounded up despite floating-point error


def percent(share: float) -> str:
    """Return a share in per cent: two digits below 10 %, whole numbers above; `100 %` stands for all alone.

    Examples
    --------
    >>> percent(0.0489), percent(2.831), percent(0), percent(0.995)
    ('4.9 %', '283 %', '0 %', '99.5 %')
    """
    size = 100 * abs(share)
    sign = "-" if share < 0 else ""
    if size < 5e-3:
        return "0 %"
    if 99.5 <= size < 100:
        return f"{sign}{min(size, 99.9):.3g} %"
    return f"{sign}{size + HALF_UP:.0f} %" if size >= 9.95 else f"{sign}{size:.2g} %"


def digits_apart(one: float, other: float, fewest: int) -> int:
    """Return the significant digits, from `fewest` to nine, that show which of two numbers is the greater.

    Examples
    --------
    >>> digits_apart(0.3204, 0.3088, 4), digits_apart(0.40001, 0.4, 4)
    (4, 5)
    """
    return next((n for n in range(fewest, 9) if f"{one:.{n}g}" != f"{other:.{n}g}"), 9)


def peaks_over(free: list[bool] | tuple[bool, ...]) -> str:
    """Return what peak rotations are divided by, in words.

    `free` states for each direction whether it has no critical rotation.
    """
    return "of the limit" if all(free) else "of phi_cr or the limit" if any(free) else "phi_cr"
