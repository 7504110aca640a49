"""Slider-crank mechanism: AB turns about A, BC follows, and C only moves vertically [extends the paper's Section 4]."""

from __future__ import annotations

from math import acos, atan2, hypot, pi

import numpy as np

from rocking_cli.core import Direction, Reals, RigidMotion, rotation


def slider_crank(
    phi: Reals, direction: Direction, a: complex, b: complex, c: complex
) -> tuple[RigidMotion, RigidMotion]:
    """Return the motions of the links AB, which turns by -s phi about A, and BC, whose C moves vertically only.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Rotations of AB in this direction [rad], from 0 to less than `slider_crank_limit`.
    direction : Direction
        Clockwise (positive) or anticlockwise (negative) rotation of AB.
    a, b, c : complex
        Rest positions of the hinges [m]; A is fixed and C above B.

    Returns
    -------
    tuple of RigidMotion
        Motions of AB and BC.

    Notes
    -----
    With d = C - B, d_x is known and |d| constant: its derivatives are those of d_y = sqrt(|d|^2 - d_x^2).
    """
    crank = rotation(phi, a, -direction)
    at_b, db, ddb = crank.carry(b)
    x, dx, ddx = c.real - at_b.real, -db.real, -ddb.real
    y = np.sqrt(abs(c - b) ** 2 - x**2)
    dy = -x * dx / y
    turn = -dx / y  # d' = i theta' d
    bend = (-ddx + dx * dy / y) / y
    turned = np.arctan2(y, x) - atan2((c - b).imag, (c - b).real)
    return crank, RigidMotion(b, at_b, db, ddb, turned, turn, bend)


def slider_crank_limit(direction: Direction, a: complex, b: complex, c: complex) -> float:
    """Return the rotation of AB at which AB lies flat, or BC does so that the linkage locks [rad]."""
    s = int(direction)
    crank, span = hypot(s * (b - a).real, (b - a).imag), abs(c - b)
    # In the positive direction B goes to the right until it is |BC| away from the line on which C is held.
    start = atan2((b - a).imag, s * (b - a).real)
    reach = (s * (c - a).real + span) / crank
    return min(pi / 2, start - acos(reach)) if reach < 1 else pi / 2
