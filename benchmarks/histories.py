"""What a history costs, as ratios within one run: machines differ, and so does one machine from hour to hour.

    python benchmarks/histories.py [RECORD]

On a record of your own, or the shipped example. Each part prints a table in Markdown.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from by_solve_ivp import BySolveIvp

from rocking_cli import GroundMotion, load_structure, read_record, respond_each
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics import kernels as at
from rocking_cli.dynamics import stepping
from rocking_cli.dynamics.batch import HISTORIES_PER_TASK
from rocking_cli.dynamics.deck import MAX_IMPACTS, lay_out, run_deck
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.names import RTOL
from rocking_cli.structure import build_models

PROJECT = Path(__file__).resolve().parents[1]
ACCEL = PROJECT / "examples" / "accel.csv"
CASES = [("block", 0.3), ("block", 0.5), ("block", 0.7), ("frame", 0.5)]
WANTED = 1e-8  # relative error of the peak at which solvers are compared
BATCH = 100_000


def seconds(work: Callable[[], object], repeats: int = 50) -> float:
    """Median time of one call, after one to warm up."""
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return median(times)


def most_memory() -> float:
    """Bytes this process has held at most; NaN where the system does not tell."""
    try:
        import resource
    except ImportError:  # Windows
        return float("nan")
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def table(title: str, columns: list[str], rows: list[list[str]]) -> None:
    print(f"\n{title}\n")
    for row in (columns, ["---"] * len(columns), *rows):
        print("| " + " | ".join(row) + " |")
    sys.stdout.flush()


class Prepared:
    """One history, ready for the kernel: what a batch or a design loop pays for each."""

    def __init__(self, model: Model, motion: GroundMotion) -> None:
        self.deck = lay_out([model], [motion])
        self.model = model
        self.runs, self.marks = np.zeros((1, at.RUN_COLUMNS)), np.empty((1, stepping.MARKS))
        self.runs[0, [at.FACTOR, at.V_FACTOR, at.SIZE]] = 1.0
        self.runs[0, [at.ETA_POSITIVE, at.ETA_NEGATIVE]] = np.nan
        phi, rate, impacts = np.empty(motion.npts), np.empty(motion.npts), np.empty((0, 3))
        self.samples = at.Samples(1, phi, rate, impacts, np.empty(stepping.MARKS))

    def run(self, rtol: float = RTOL) -> float:
        """Peak |phi|/phi_cr; if it overturns, minus the time at which it passes phi_cr."""
        run_deck(self.deck, self.runs, self.marks, rtol=rtol, samples=self.samples)
        if self.marks[0, at.STATUS] == at.OVERTURNED:
            return -float(self.marks[0, stepping.CROSSED])
        return float((self.marks[0, at.PEAK : at.PEAK + 2] / self.model.phi_cr).max())


def against_solvers(motion: GroundMotion, models: dict[str, list[Model]]) -> None:
    rows = []
    for name, scale in CASES:
        shaken = motion.scaled(scale)
        nonlinear = models[name][0]
        one = Prepared(nonlinear, shaken)
        ours, fast = one.run(), seconds(one.run)
        if ours == 0:  # this record does not lift it
            continue
        error = abs(ours / one.run(1e-14) - 1)
        for rtol in (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12):
            start = time.perf_counter()
            other = BySolveIvp(nonlinear, shaken, rtol).outcome()
            slow = time.perf_counter() - start
            if abs(other / ours - 1) <= WANTED:
                break
        whole = seconds(lambda m=nonlinear, s=shaken: follow(m, s, tail=0.0))
        linear = seconds(Prepared(models[name][2], shaken).run)
        what = f"{ours:.6f}" if ours > 0 else f"falls at {-ours:.4f} s"
        rows.append([
            name, f"{scale:g}", what, f"{error:.0e}", f"{1e3 * fast:.3f}",
            f"{1e3 * whole:.3f}", f"{slow:.2f}", f"{rtol:.0e}", f"{slow / fast:.0f}",
            f"{1e3 * linear:.3f}",
        ])  # fmt: skip
    table(
        f"One history on {motion.name}, {motion.npts} points at {motion.dt:g} s, to rest or certain overturning, warm",
        ["structure", "scale", "peak", "its error", "nonlinear ms", "in Python ms", "solve_ivp s", "at rtol",
         "solve_ivp / ours", "linear ms"],
        rows,
    )  # fmt: skip


def against_pybullet(motion: GroundMotion, models: dict[str, list[Model]]) -> None:
    try:
        from by_pybullet import STEPS, by_pybullet
    except ImportError:
        print("\nPyBullet is not installed: pip install '.[bench]'")
        return
    rows = []
    for scale in (0.3, 0.5, 0.7):
        shaken = motion.scaled(scale)
        one = Prepared(models["block"][0], shaken)
        start = time.perf_counter()
        worst = by_pybullet(0.7, 2.8, shaken)
        slow = time.perf_counter() - start
        theirs = worst / models["block"][0].phi_cr[0]
        peaks = [f"{peak:.3f}" if 0 <= peak < 1 else "falls" for peak in (one.run(), theirs)]
        rows.append([f"{scale:g}", *peaks, f"{slow:.2f}", f"{slow / seconds(one.run):.0f}"])
    table(
        f"The block by PyBullet, {STEPS} steps a sample, friction 2, no restitution",
        ["scale", "peak, ours", "peak, PyBullet", "PyBullet s", "PyBullet / ours"],
        rows,
    )


def tolerance(models: dict[str, list[Model]]) -> None:
    """Coarser and coarser samples of a sine that keeps the block rocking."""
    model = models["block"][0]
    p, strength = float(model.numbers[0, at.P]), 1.5 * float(model.numbers[0, at.LAMBDA]) * 9.80665
    rows = []
    for p_dt in (0.02, 0.1, 0.5):
        time_over_p = np.arange(round(12 / p_dt)) * p_dt
        one = Prepared(model, GroundMotion("sine", p_dt / p, strength * np.sin(5 * time_over_p), unit="m/s2"))
        exact = one.run(1e-14)
        for rtol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
            error = abs(one.run(rtol) / exact - 1)
            spent = seconds(lambda r=rtol, o=one: o.run(r)) / time_over_p.size
            rows.append([f"{p_dt:g}", f"{rtol:.0e}", f"{error:.0e}", f"{1e9 * spent:.0f}"])
    table("Tolerance, error of the peak, and price", ["p dt", "rtol", "error of the peak", "ns a sample"], rows)


def bulk(motion: GroundMotion) -> None:
    """`respond_each` against the kernel alone, which has its rows ready: what Python adds to many runs."""
    block, scales, etas = Registry()["block"](width=0.7, height=2.8), np.linspace(0.2, 0.9, BATCH // 4), [0.85, 0.9]
    (model,) = build_models(block, ("nonlinear",))
    rows = np.zeros((BATCH, at.RUN_COLUMNS))
    rows[:, at.FACTOR] = np.repeat(scales, 4) * np.tile([1, 1, -1, -1], scales.size)
    rows[:, at.V_FACTOR] = abs(rows[:, at.FACTOR])
    rows[:, [at.SIZE, at.SLENDER]] = 1.0
    rows[:, at.ETA_POSITIVE] = rows[:, at.ETA_NEGATIVE] = np.tile(etas, BATCH // 2)

    def kernel() -> None:
        run = partial(run_deck, lay_out([model], [motion]), rtol=RTOL, most_impacts=MAX_IMPACTS)
        in_parts(partial(run, rows, np.empty((BATCH, stepping.MARKS))), BATCH, HISTORIES_PER_TASK, None, None)

    def verb() -> Any:
        return respond_each(block, motion, model="nonlinear", scale=scales, polarity="both", restitution=etas)

    answer = verb()
    alone, whole, frame = seconds(kernel, 3), seconds(verb, 3), seconds(answer.to_frame, 3)
    table(
        "Many runs: scales, polarities and restitutions on the block",
        ["runs", "kernel s", "respond_each / kernel", "to_frame / kernel"],
        [[f"{BATCH:,}", f"{alone:.2f}", f"{whole / alone:.3f}", f"{frame / alone:.3f}"]],
    )


def length() -> None:
    """Cost of a sample of a noise that keeps a large block rocking, short and long."""
    structure = Registry()["block"](width=44.8, height=179.2, restitution=0.8)  # so large that it does not overturn
    noise = np.random.default_rng(3).normal(size=1_000_000)
    ground = 2.5 * np.convolve(noise, np.hanning(40) / np.sqrt(40), "same")
    rows = []
    for model in build_models(structure, ("nonlinear", "linear2")):
        for n in (1_000, 10_000, 100_000, 1_000_000):
            one = Prepared(model, GroundMotion("noise", 0.01, ground[:n], unit="m/s2"))
            spent = seconds(one.run, max(3, 200_000 // n))
            impacts, rocking = one.marks[0, at.IMPACTS], np.mean(one.samples.phi != 0)
            row = [
                model.name,
                f"{n:,}",
                f"{1e9 * spent / n:.0f}",
                f"{1e3 * impacts / n:.0f}",
                f"{rocking:.0%}",
            ]
            rows.append(row)
    table("Cost of a sample", ["model", "samples", "ns a sample", "impacts in 1000", "rocking"], rows)


def main() -> None:
    motion = read_record(sys.argv[1] if len(sys.argv) > 1 else ACCEL)
    structures = {
        "block": Registry()["block"](width=0.7, height=2.8),
        "frame": load_structure(PROJECT / "examples" / "frame.yaml"),
    }
    models = {name: build_models(structure) for name, structure in structures.items()}
    against_solvers(motion, models)
    tolerance(models)
    bulk(motion)
    length()
    against_pybullet(motion, models)


if __name__ == "__main__":
    main()
