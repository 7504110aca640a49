"""Print the voussoirs of a circular arch, for the `blocks` of an assembly: to whole millimetres, as a survey gives them.

    python make_voussoirs.py RADIUS THICKNESS ANGLE VOUSSOIRS [HEIGHT [EDGES]]

RADIUS is that of the centre line [m], ANGLE that between the springings [degrees], HEIGHT where the centre of the circle
is [m]. Each curved side is of EDGES straight ones.
"""

from __future__ import annotations

import sys

import numpy as np


def voussoirs(
    radius: float, thickness: float, angle: float, number: int, height: float = 0.0, edges: int = 3
) -> dict[str, list[list[float]]]:
    """Corners [x, y] of each voussoir, from the left, by its name."""
    half = np.radians(angle) / 2
    joints = np.pi / 2 + np.linspace(half, -half, number + 1)
    found = {}
    for k in range(number):
        turns = np.exp(1j * np.linspace(joints[k], joints[k + 1], edges + 1))
        z = np.concatenate([(radius + thickness / 2) * turns, (radius - thickness / 2) * turns[::-1]]) + 1j * height
        found[f"v{k + 1}"] = [[float(x) + 0.0, float(y) + 0.0] for x, y in zip(z.real.round(3), z.imag.round(3), strict=True)]
    return found


def lines(found: dict[str, list[list[float]]]) -> list[str]:
    """As they stand in a file."""
    return [f"  {name}: {{polygon: {corners}}}" for name, corners in found.items()]


if __name__ == "__main__":
    radius, thickness, angle, number, *more = sys.argv[1:]
    height, edges = [*more, *("0", "3")[len(more) :]]
    print("\n".join(lines(voussoirs(float(radius), float(thickness), float(angle), int(number), float(height), int(edges)))))
