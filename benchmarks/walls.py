"""What walls of many blocks cost, and how it grows, beside one plain linear programme of the same matrices.

    python benchmarks/walls.py

Processor time and peak memory of whole processes; memory only where the system tells it.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import tempfile
import time
from itertools import pairwise
from math import log
from pathlib import Path
from typing import Any

import numpy as np

PROJECT = Path(__file__).resolve().parents[1]
LONG, HIGH = 0.5, 0.25  # of a brick [m]
SIZES = ((5, 10), (7, 15), (10, 20), (14, 28), (22, 44))  # bricks in a course, and courses
GROWTH = (100, 1000)  # about so many blocks are compared


def wall(columns: int, courses: int) -> dict[str, Any]:
    """A wall in running bond whose densities differ a little, so that one mechanism is the weakest."""
    scatter = random.Random(1)
    blocks = {}
    for k in range(courses):
        edges = [i * LONG for i in range(columns + 1)]
        if k % 2:
            edges = [0.0, *(edge + LONG / 2 for edge in edges[:-1]), edges[-1]]
        for i, (left, right) in enumerate(pairwise(edges)):
            low, high = k * HIGH, (k + 1) * HIGH
            polygon = [[left, low], [right, low], [right, high], [left, high]]
            blocks[f"b{k}.{i}"] = {"polygon": polygon, "density": round(1800 * scatter.uniform(0.9, 1.1), 3)}
    far = columns * LONG + 1
    ground = {"floor": {"polygon": [[-1, -0.5], [far, -0.5], [far, 0], [-1, 0]]}}
    return {"mechanism": "assembly", "depth": 0.25, "friction": 0.6, "blocks": blocks, "ground": ground}


def plain(file: str) -> None:
    """Print lambda of both directions by scipy's interface as it comes, with dense matrices."""
    from scipy.optimize import linprog

    from mechanisms._assembly import AssemblyBlock, contacts
    from mechanisms._assembly.problem import AssemblyProblem
    from rocking_cli.core import Direction

    given = json.loads(Path(file).read_text(encoding="utf-8"))
    blocks = []
    for name, each in given["blocks"].items():
        corners = np.array([complex(*vertex) for vertex in each["polygon"]])
        side = corners[2] - corners[0]
        mass = each["density"] * given["depth"] * side.real * side.imag
        blocks.append(AssemblyBlock(name, tuple(corners), mass, complex(corners.mean())))
    ground = [AssemblyBlock("floor", tuple(complex(*vertex) for vertex in given["ground"]["floor"]["polygon"]))]
    joints = contacts(blocks, ground, friction=given["friction"])
    found = {}
    for direction in Direction:
        problem = AssemblyProblem.of(blocks, joints, (), direction)
        rays = problem.bearings.rays()
        equal = np.column_stack([rays.rates.T.toarray(), problem.live])
        bounds = [*((low, None) for low in rays.low), (0, None)]
        cost = np.append(np.zeros(rays.count), -1.0)
        found[direction.label] = -linprog(cost, A_eq=equal, b_eq=-problem.dead, bounds=bounds).fun
    print(json.dumps(found))


def measured(*command: str) -> tuple[float, float, str]:
    """Processor time [s], peak memory [MB; NaN if not told] and output of a process."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    start = time.perf_counter()
    with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
        process = subprocess.Popen([sys.executable, *command], stdout=output, env=environment, cwd=PROJECT)
        if hasattr(os, "wait4"):
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            spent, peak = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)
        else:
            process.wait()
            spent, peak = time.perf_counter() - start, float("nan")
        if process.returncode:
            sys.exit(process.returncode)
        output.seek(0)
        return spent, peak, output.read()


def walls() -> None:
    """All that `collapse` says of walls of more and more blocks, and the plain programme of both directions."""
    print("\n`rocking collapse --json`, both directions, over two plain linear programmes\n")
    print("| blocks | s | MB | plain, s | plain, MB | s over plain | lambda differs by |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    counts, times = [], []
    with tempfile.TemporaryDirectory() as folder:
        for columns, courses in SIZES:
            given = wall(columns, courses)
            file = Path(folder) / "wall.yaml"  # JSON is YAML
            file.write_text(json.dumps(given), encoding="utf-8")
            spent, peak, answer = measured("-m", "rocking_cli", "collapse", str(file), "--json")
            other, other_peak, multipliers = measured(str(Path(__file__)), str(file))
            ours, theirs = json.loads(answer)["directions"], json.loads(multipliers)
            apart = max(abs(ours[side]["lambda"] / theirs[side] - 1) for side in theirs)
            counts.append(len(given["blocks"]))
            times.append(spent)
            cells = f"{spent:.1f} | {peak:.0f} | {other:.1f} | {other_peak:.0f} | {spent / other:.2f} | {apart:.0e}"
            print(f"| {counts[-1]} | {cells} |", flush=True)
    one, two = (min(range(len(counts)), key=lambda k: abs(counts[k] - near)) for near in GROWTH)
    power = log(times[two] / times[one]) / log(counts[two] / counts[one])
    print(f"\nFrom {counts[one]} to {counts[two]} blocks the time grows with the power {power:.2f} of their number.")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        plain(sys.argv[1])
    else:
        walls()
