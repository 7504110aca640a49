"""What linkages and assemblies cost: tables over those of a mechanism that is written out, and limit analyses.

    python benchmarks/linkages.py

Machines differ, and so does one machine from hour to hour. Each part prints a table in Markdown.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import pi
from statistics import median

import numpy as np

import rocking_cli as rk
from rocking_cli import Direction, Mechanism
from rocking_cli.structure import Structure

REPEATS = 5
STOREYS = 3
VOUSSOIRS = (7, 25, 49)


def seconds(make: Callable[[], Mechanism], work: Callable[[Mechanism], object]) -> float:
    """Median time of the work on a structure just made, after one to warm up."""
    passed = []
    for _ in range(REPEATS + 1):
        start = time.perf_counter()
        work(make())
        passed.append(time.perf_counter() - start)
    return median(passed[1:])


def box(x: float, y: float, width: float, height: float) -> dict[str, object]:
    """A rectangle from its lower left corner."""
    return {"polygon": [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]}


def portals() -> Mechanism:
    """Ten bodies: portals on one another, whose left columns turn alike, and a block on top."""
    bodies: dict[str, object] = {}
    joints: dict[str, object] = {}
    for k in range(STOREYS):
        y = 5.0 * k
        for side, x in (("left", 0.0), ("right", 5.0)):
            bodies[f"{side} {k}"] = box(x, y, 1.0, 4.0)
            own, foot = f"{side} {k}", [x + 1.0, y]
            joints[f"foot {own}"] = {"hinge": [f"beam {k - 1}", own], "at": foot} if k else {"pivot": own, "at": foot}
            joints[f"top {own}"] = {"hinge": [own, f"beam {k}"], "at": [x, y + 4.0]}
        bodies[f"beam {k}"] = box(0.0, y + 4.0, 6.0, 1.0)
        if k:
            alike = {"slide": [f"left {k}", f"left {k - 1}"], "at": [0.5, y + 2.0], "along": [0.0, 1.0]}
            joints[f"alike {k}"] = alike
    bodies["block"] = box(2.5, 5.0 * STOREYS, 1.0, 2.0)
    joints["block"] = {"fixed": [f"beam {STOREYS - 1}", "block"]}
    side = {"lead": "left 0", "joints": joints}
    return rk.Linkage(bodies=bodies, positive=side, density=1800.0, depth=1.0, restitution=0.9)


def frame() -> Mechanism:
    """A mechanism with its kinematics written out."""
    sizes = {"column_width": 1.0, "left_height": 6.0, "right_height": 7.5, "spacing": 8.0, "beam_depth": 1.0}
    return rk.AsymmetricFrame(**sizes, density=2400.0, depth=1.0)


def ring(count: int) -> Mechanism:
    """An arch by its voussoirs."""
    radius, thickness, beta = 10.0, 1.5, 157.5 * pi / 180
    cuts = (pi + beta) / 2 - np.linspace(0.0, beta, count + 1)

    def wedge(start: float, end: float) -> dict[str, object]:
        turns = np.exp(1j * np.linspace(start, end, 5))
        corners = [*((radius + thickness / 2) * turns), *((radius - thickness / 2) * turns[::-1])]
        return {"polygon": [[z.real, z.imag] for z in corners]}

    def springing(angle: float, sense: int) -> dict[str, object]:
        turn, away = np.exp(1j * angle), sense * 1j * np.exp(1j * angle)
        inner, outer = (radius - thickness) * turn, (radius + thickness) * turn
        return {"polygon": [[z.real, z.imag] for z in (inner, outer, outer + away, inner + away)]}

    blocks = {f"v{k + 1}": wedge(cuts[k], cuts[k + 1]) for k in range(count)}
    ground = {"left": springing(cuts[0], 1), "right": springing(cuts[-1], -1)}
    return rk.Assembly(blocks=blocks, ground=ground, density=2400.0, depth=1.0)


def tables() -> None:
    """A linkage of ten bodies over a frame that is written out."""
    print("\nFrom the fields to the tables of both directions\n")
    print("| structure | bodies | ms | over the frame |\n| --- | --- | --- | --- |")
    base = 0.0
    for name, make in (("asymmetric_frame", frame), ("linkage", portals)):
        passed = seconds(make, lambda structure: Structure(structure).model("nonlinear"))
        base = base or passed
        print(f"| {name} | {len(make().bodies())} | {1e3 * passed:.0f} | {passed / base:.1f} |", flush=True)


def analyses() -> None:
    """Assemblies of more and more voussoirs."""
    print("\nAn arch by its voussoirs: both weakest mechanisms, and what `collapse` says of one\n")
    print("| voussoirs | found, ms | said, ms |\n| --- | --- | --- |")
    for count in VOUSSOIRS:
        found = seconds(lambda n=count: ring(n), lambda structure: structure)
        both = seconds(lambda n=count: ring(n), lambda structure: structure.collapse(Direction.POSITIVE))
        print(f"| {count} | {1e3 * found:.0f} | {1e3 * (both - found):.0f} |", flush=True)


if __name__ == "__main__":
    tables()
    analyses()
