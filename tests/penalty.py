"""Rectangles on each other, their corners on springs and dashpots: free blocks by no code of the package."""

from __future__ import annotations

from cmath import exp
from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

G = 9.80665
SUNK = 1e-5  # m, of a block on its corners
STEP = 2e-5  # s


@dataclass
class Plate:
    """A rectangle [m], of unit depth, by its density [kg/m3]."""

    width: float
    height: float
    density: float

    def __post_init__(self) -> None:
        self.mass = self.density * self.width * self.height
        self.inertia = self.mass * (self.width**2 + self.height**2) / 12
        self.at = self.rate = 0j
        self.turn = self.spin = 0.0
        self.feet = [complex(sign * self.width / 2, -self.height / 2) for sign in (-1, 1)]
        self.slips = [0.0, 0.0]


def stacked(
    plates: Sequence[Plate], friction: float, dt: float, push: Sequence[float], times: Sequence[float]
) -> np.ndarray:
    """Return the rotations of plates that stand on each other, ever narrower, at some times, anticlockwise [rad]."""
    top = 0.0
    for plate in plates:
        plate.at = 1j * (top + plate.height / 2)
        top += plate.height
    stiffness = G * sum(plate.mass for plate in plates) / SUNK
    damping = 2 * sqrt(stiffness * min(plate.mass for plate in plates))
    count = round(times[1] / STEP)
    ground = np.interp(np.arange(round(times[-1] / STEP) + 1) * STEP, np.arange(len(push)) * dt, push, right=0.0)
    found = [[plate.turn for plate in plates]]
    for k in range(len(ground) - 1):
        forces = [plate.mass * complex(-ground[k], -G) for plate in plates]
        moments = [0.0 for _ in plates]
        turns = [exp(1j * plate.turn) for plate in plates]
        for n, plate in enumerate(plates):
            below = plates[n - 1] if n else None
            face = turns[n - 1] if n else 1 + 0j
            for m, foot in enumerate(plate.feet):
                arm = foot * turns[n]
                away = plate.at + arm - (below.at if below else 0j)
                rate = plate.rate + 1j * plate.spin * arm
                if below is not None:
                    rate -= below.rate + 1j * below.spin * away
                local, slip = away / face, rate / face
                gap = local.imag - (below.height / 2 if below else 0.0)
                normal = max(-stiffness * gap - damping * slip.imag, 0.0) if gap < 0 else 0.0
                plate.slips[m] += slip.real * STEP
                shear = -stiffness * plate.slips[m] - damping * slip.real
                if abs(shear) > friction * normal:
                    shear = friction * normal * (1 if shear > 0 else -1)
                    plate.slips[m] = -shear / stiffness
                force = complex(shear, normal) * face
                forces[n] += force
                moments[n] += (arm.conjugate() * force).imag
                if below is not None:
                    forces[n - 1] -= force
                    moments[n - 1] -= (away.conjugate() * force).imag
        for plate, force, moment in zip(plates, forces, moments, strict=True):
            plate.rate += STEP * force / plate.mass
            plate.spin += STEP * moment / plate.inertia
            plate.at += STEP * plate.rate
            plate.turn += STEP * plate.spin
        if (k + 1) % count == 0:
            found.append([plate.turn for plate in plates])
    return np.array(found[: len(times)])
