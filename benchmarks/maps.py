"""What a map of overturning costs, and what the samples of its pulses do to it.

    python benchmarks/maps.py

Machines differ, and so does one machine from hour to hour. Each part prints a table in Markdown.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from math import pi
from pathlib import Path
from statistics import median

import numpy as np

from rocking_cli import load_structure
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import linear_model
from rocking_cli.questions.overturning.study import overturning_map
from rocking_cli.structure import Structure
from rocking_cli.studies.under_pulses import PulsedModel, linear_block, outcomes, parse_shape, pulsed_model

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
POINTS = 400
GOAL = 15  # us a point of a nonlinear map
PLANE = np.linspace(0.5, 10.0, POINTS)
SINE = parse_shape("sine")


def seconds(work: Callable[[], object], repeats: int = 5) -> tuple[float, float]:
    """Median time of a call after one to warm up, and that of the processors together: others may be at work."""
    work()
    passed, spent = [], []
    for _ in range(repeats):
        start = time.perf_counter(), time.process_time()
        work()
        passed.append(time.perf_counter() - start[0])
        spent.append(time.process_time() - start[1])
    return median(passed), median(spent)


def maps() -> None:
    structures: list[PulsedModel] = [linear_block(0.9)]
    for name in ("block", "frame"):
        structures.append(pulsed_model(Structure(load_structure(EXAMPLES / f"{name}.yaml")), "nonlinear", SINE))
    print(f"\nMaps of {POINTS} x {POINTS} full sines, omega and a from 0.5 to 10, on {os.cpu_count()} processors\n")
    print(f"| structure | model | s | of processors s | us a point, goal {GOAL} |\n| --- | --- | --- | --- | --- |")
    for each in structures:
        passed, spent = seconds(lambda s=each: overturning_map(s, SINE, PLANE, PLANE), 3)
        point = 1e6 * spent / POINTS**2
        print(f"| {each.name} | {each.model.name} | {passed:.2f} | {spent:.2f} | {point:.1f} |", flush=True)


def samples() -> None:
    """Least amplitude that overturns without impact, on samples over exactly."""
    block = linear_block(0.9)
    model = linear_model("block", "linear2", (block.block, block.block), 1.0)
    print("\nSamples to a period, and the amplitude that overturns the linear block, over the exact one\n")
    print("| samples | omega = 2 | 4 | 6 |\n| --- | --- | --- | --- |")

    def least(fell: Callable[[float], bool]) -> float:
        low, high = 1.0, 30.0
        while high - low > 1e-10:
            middle = (low + high) / 2
            low, high = (low, middle) if fell(middle) else (middle, high)
        return high

    for count in (50, 100, 200, 400, 800):
        row = []
        for omega in (2.0, 4.0, 6.0):
            period = 2 * pi / omega
            motion = replace(SINE, period=period).sampled(count)

            def exact(a: float, period: float = period) -> bool:
                return bool(outcomes(block, SINE, np.array([period]), np.array([a])).impact_count[0] == 0)

            def sampled(a: float, motion: object = motion) -> bool:
                run = respond_many([model], [motion], Runs.of(0, 0, scale=a), threads=1, only_peaks=True)
                return bool(run.fell[0] and run.impact_count[0] == 0)

            row.append(f"{least(sampled) / least(exact) - 1:+.1e}")
        print(f"| {count} | {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    maps()
    samples()
