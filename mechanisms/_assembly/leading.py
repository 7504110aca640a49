"""Choice of the group of blocks whose rotation measures a mechanism."""

from __future__ import annotations

import numpy as np

from mechanisms._assembly.mechanism import STILL, AssemblyLinkage
from rocking_cli.core import Direction


def leading(found: AssemblyLinkage, direction: Direction) -> int | None:
    """Return the group whose rotation measures a mechanism; None if no group rotates.

    Groups that hinge on blocks at rest are preferred, then those that turn clockwise in the positive direction, then
    the fastest one; of groups that turn equally fast, the first.
    """
    turns = -int(direction) * found.velocity[:, 2]
    most = float(np.abs(turns).max(initial=0.0))
    grounded = {g for h in found.hinges if None in (h.one, h.other) for g in (h.one, h.other) if g is not None}
    able = [k for k in range(len(turns)) if abs(turns[k]) > STILL * most]
    if not able:
        return None

    best = max((k in grounded, bool(turns[k] > 0)) for k in able)
    able = [k for k in able if (k in grounded, bool(turns[k] > 0)) == best]
    fastest = max(abs(turns[k]) for k in able)
    return next(k for k in able if abs(turns[k]) >= fastest * (1 - STILL))
