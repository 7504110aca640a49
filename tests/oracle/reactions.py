"""Forces in the joints: a joint is let go, and what it would do work on in the motion that this frees is its force.

All other joints hold, so that theirs do none (d'Alembert). What acts at a joint acts on what it bears: on the
structure at its feet, on the upper of two bodies, on the wall at its top.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .series import Reals, around, derivatives
from .structures import Mode, Structure

STEP = 1e-30


class Force(NamedTuple):
    """A force, x to the right and y up."""

    x: float
    y: float


class _Shift(NamedTuple):
    """How far everything moves per unit of parting at a joint: masses, rotations, springs and points of forces."""

    x: Reals
    y: Reals
    spin: Reals
    springs: Reals
    pushed: Reals


def _shift(structure: Structure, s: int, phi: float, joint: str, along: complex) -> _Shift:
    """By a complex step."""
    freed = {joint: (1j * STEP * along.real, 1j * STEP * along.imag)}
    # Of points that touch at rest the direction in which they part is that just after.
    bodies = structure.place(s, np.array([phi]), freed)
    *_, x, y = structure.masses(bodies)
    springs: list[Any] = []
    radius = structure.radius(s, phi)
    beginning = structure.spans(structure.place(s, around(phi, radius)))
    for ends, then in zip(structure.spans(bodies), beginning, strict=True):
        total: Any = 0.0
        for (dx, dy, _), (cx, cy, _) in zip(ends, then, strict=True):
            ux, uy = dx.real[:, 0], dy.real[:, 0]
            touch = np.hypot(ux, uy) < 1e-9
            ux, uy = (np.where(touch, derivatives(c, 1, radius)[1], now) for c, now in ((cx, ux), (cy, uy)))
            long = np.hypot(ux, uy)
            total = total + (ux * dx.imag[:, 0] + uy * dy.imag[:, 0]) / np.where(long > 0, long, 1.0)
        springs.append(total / STEP)
    pushed = [
        force.real * np.imag(px).sum() + force.imag * np.imag(py).sum()
        for name, at, force in structure.forces
        for px, py in [structure.body(bodies, name).at(at)]
    ]
    return _Shift(
        np.imag(x)[:, 0] / STEP,
        np.imag(y)[:, 0] / STEP,
        np.array([np.imag(np.broadcast_to(body.psi, 1))[0] for body in bodies]) / STEP,
        np.concatenate(springs) if springs else np.zeros(0),
        np.array(pushed) / STEP,
    )


def reactions(
    structure: Structure, s: int, phi: float, rate: float, u: float = 0.0, v: float = 0.0, mode: Mode | None = None
) -> dict[str, Force]:
    """The force at every joint, from phi, phi. and the ground accelerations [N]."""
    mode = structure.fresh(s, phi) if mode is None else mode
    pace = structure.acceleration(s, phi, rate, u, v, mode)
    # Accelerations by two derivatives in time along the motion, which need not be the true one for longer.
    within = structure.radius(s, phi) / max(abs(rate), abs(pace) ** 0.5, 1e-3)
    time = around(0.0, within)
    bodies = structure.place(s, phi + rate * time + pace * time**2 / 2)
    h, vert, w, x, y = structure.masses(bodies)
    ax, ay = derivatives(x, 2, within)[2], derivatives(y, 2, within)[2]
    turning = derivatives(np.array([np.broadcast_to(body.psi, time.shape) for body in bodies]), 2, within)[2]
    e = np.real(structure.elongations(s, np.array([phi])))[:, 0]
    axial = structure.pull(mode, e)
    inertia = np.array([piece.inertia for piece in structure.pieces()])

    def work(joint: str, along: complex) -> float:
        move = _shift(structure, s, phi, joint, along)
        momentum = (h * (ax + u)) @ move.x + (vert * ay + w * (structure.gravity + v)) @ move.y
        return float(momentum + (inertia * turning) @ move.spin + axial @ move.springs - move.pushed.sum())

    return {joint: Force(work(joint, 1 + 0j), work(joint, 1j)) for joint in structure.joints()}
