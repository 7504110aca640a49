"""Words that every command uses for one thing, and that cost nothing to import.

A motion ends in one of four ways: the structure does not uplift; it rocks, which is to lift and come back, to rest in
the end; it overturns; or it is still rocking, long after the ground is quiet, and not going to overturn.
"""

from __future__ import annotations

NO_UPLIFT = "does not uplift"
ROCKS = "rocks"
OVERTURNS = "overturns"
STILL_ROCKING = "still rocking"


def outcome(*, uplifts: bool, overturned: bool, still_rocking: bool = False) -> str:
    """What became of a structure, in the words above.

    Parameters
    ----------
    uplifts, overturned, still_rocking : bool
        Whether it lifts at all (a release from a tilt counts), whether it overturns, and whether it is left rocking.

    Examples
    --------
    >>> outcome(uplifts=True, overturned=False)
    'rocks'
    """
    if overturned:
        return OVERTURNS
    if still_rocking:
        return STILL_ROCKING
    return ROCKS if uplifts else NO_UPLIFT


def percent(share: float) -> str:
    """A share as people read it: two digits below ten per cent, whole numbers above, never a power of ten.

    Examples
    --------
    >>> percent(0.0489), percent(2.831), percent(0)
    ('4.9 %', '283 %', '0 %')
    """
    size = 100 * abs(share)
    sign = "-" if share < 0 else ""
    if size < 5e-3:
        return "0 %"
    return f"{sign}{size:.0f} %" if size >= 9.95 else f"{sign}{size:.2g} %"
