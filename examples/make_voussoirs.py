"""Print the voussoirs of a circular arch, for the `blocks` of an assembly: to whole millimetres, as if surveyed.

    python make_voussoirs.py RADIUS THICKNESS ANGLE VOUSSOIRS [HEIGHT [EDGES]]

RADIUS is that of the centre line [m], ANGLE that between the springings [degrees], HEIGHT where the centre of the
circle is [m]. Each curved side is of EDGES straight ones.
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
    outer, inner = radius + thickness / 2, radius - thickness / 2
    found = {}
    for k in range(number):
        turns = np.exp(1j * np.linspace(joints[k], joints[k + 1], edges + 1))
        z = np.concatenate([outer * turns, inner * turns[::-1]]) + 1j * height
        corners = np.round(np.column_stack([z.real, z.imag]), 3) + 0.0  # + 0.0: no "-0.0"
        found[f"v{k + 1}"] = [[float(x), float(y)] for x, y in corners]
    return found


def lines(found: dict[str, list[list[float]]]) -> list[str]:
    """As they stand in a file."""
    return [f"  {name}: {{polygon: {corners}}}" for name, corners in found.items()]


if __name__ == "__main__":
    sizes, number, more = [float(each) for each in sys.argv[1:4]], int(sys.argv[4]), sys.argv[5:]
    height, edges = [*more, *("0", "3")[len(more) :]]
    print("\n".join(lines(voussoirs(*sizes, number, float(height), int(edges)))))
