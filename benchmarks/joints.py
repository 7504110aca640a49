"""What the check of joints costs beside histories, as ratios within one run.

    python benchmarks/joints.py

Each part prints a table in Markdown.
"""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from statistics import median

import numpy as np

from rocking_cli import load_structure, read_record
from rocking_cli.core import both_statics
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.joints import joints_of
from rocking_cli.structure import build_models

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
CASES = ("block", "wall", "frame", "arch", "masonry/portal", "masonry/buttressed_arch")
FACTORS = (0.4, 1.0, 2.0)
PAIRS, RUNS = 7, 400


def histories() -> None:
    """Neighbours of a motion with and without the check, in pairs of runs one after the other."""
    print("\nHistories with the check of joints over those without, one thread\n")
    print("| structure | factor | without, us | with, us | ratio | unknown |\n|---|---|---|---|---|---|")
    motion = read_record(EXAMPLES / "accel.csv")
    for name in CASES:
        (model,) = build_models(load_structure(EXAMPLES / f"{name}.yaml"), ("nonlinear",))
        for factor in FACTORS:
            runs = Runs.of(0, 0, scale=factor * np.linspace(0.9, 1.1, RUNS))
            times: dict[bool, list[float]] = {True: [], False: []}
            unknown = 0.0
            for _ in range(PAIRS + 1):
                for checked in (True, False):
                    start = time.perf_counter()
                    of = model if checked else replace(model, joints=None)
                    found = respond_many([of], [motion], runs, only_peaks=True, threads=1)
                    times[checked].append((time.perf_counter() - start) / RUNS)
                    unknown = found.unknown.mean() if checked else unknown
            without, with_ = (median(times[checked][1:]) for checked in (False, True))
            ratio = median(a / b for a, b in zip(times[True][1:], times[False][1:], strict=True))
            cells = (
                name,
                factor,
                f"{1e6 * without:.0f}",
                f"{1e6 * with_:.0f}",
                f"{ratio:.2f}",
                f"{100 * unknown:.0f} %",
            )
            print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def tables() -> None:
    """What the tables of the joints take, over the whole model."""
    print("\nTables of the joints, of the time that a model takes from its fields\n")
    print("| structure | model, ms | its joints, ms |\n|---|---|---|")
    for name in CASES:
        whole, part = [], []
        for _ in range(PAIRS):
            mechanism = load_structure(EXAMPLES / f"{name}.yaml")
            start = time.perf_counter()
            (model,) = build_models(mechanism, ("nonlinear",))
            whole.append(time.perf_counter() - start)
            statics = both_statics(mechanism)
            start = time.perf_counter()
            joints_of(mechanism, statics, model.tables or (), model.p)
            part.append(time.perf_counter() - start)
        print(f"| {name} | {1e3 * median(whole):.0f} | {1e3 * median(part):.0f} |", flush=True)


if __name__ == "__main__":
    histories()
    tables()
