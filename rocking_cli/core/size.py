"""Size of a structure, and warnings if it suggests a wrong unit."""

from __future__ import annotations

import numpy as np

from rocking_cli.core.kinematics import Direction
from rocking_cli.core.mechanism import Mechanism

SMALLEST, LARGEST = 0.01, 100.0  # m: what lies beyond is rarely meant


def extent(mechanism: Mechanism) -> float:
    """Return the largest length of a structure [m]: of the box around its bodies, or from a pivot to a centroid.

    Only the bodies and their motion are used, so that it works for any mechanism.
    """
    bodies = mechanism.bodies()
    z = np.array([point for body in bodies for point in (body.centroid, *body.outline)])
    moved = [motion.carry(body.centroid)[1][0] for body, motion in zip(
        bodies, mechanism.motion(np.zeros(1), Direction.POSITIVE), strict=True)]  # fmt: skip
    return float(max(abs(complex(np.ptp(z.real), np.ptp(z.imag))), *np.abs(moved)))


def doubtful_size(mechanism: Mechanism) -> str | None:
    """Return what is unusual about the size of a structure, a sentence without a full stop; None if nothing is.

    Parameters
    ----------
    mechanism : Mechanism
        Any structure. If its plugin fails here, the size is not judged.
    """
    try:
        with np.errstate(all="ignore"):
            size = extent(mechanism)
    except Exception:  # a plugin may fail in any way; whoever uses it next says so
        return None
    if SMALLEST <= size <= LARGEST or not np.isfinite(size):
        return None
    odd = []
    for key, info in type(mechanism).model_fields.items():
        extra, value = info.json_schema_extra, getattr(mechanism, key)
        if not isinstance(extra, dict) or extra.get("unit") != "m" or not isinstance(value, float | list):
            continue
        length = value if isinstance(value, float) else float(np.ptp(value, axis=0).max())
        says = f"{key} {'is' if isinstance(value, float) else 'spans'} {length:g} m"
        if size > LARGEST and length > LARGEST:
            odd.append((says, f"{length:g} mm"))
        elif size < SMALLEST and 0 < length < SMALLEST:
            odd.append((says, f"{1000 * length:g} m"))
    if not odd:
        return f"it is {size:.3g} m large: are the units right?"
    return f"{', '.join(says for says, _ in odd)}: did you mean {' and '.join(meant for _, meant in odd)}?"


def doubts(mechanism: Mechanism) -> list[str]:
    """Return what is unusual about the size of a structure or the places of its loads, as sentences."""
    size = doubtful_size(mechanism)
    return [*([size] if size is not None else []), *mechanism.far_off()]
