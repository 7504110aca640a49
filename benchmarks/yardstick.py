"""Histories beside loops in C that compute less, or as much (yardstick.c): ratios within one run, and the goals.

    python benchmarks/yardstick.py [RECORD]

On a record of your own, or the shipped example. Needs a compiler, `cc` or that of the variable CC.
"""

from __future__ import annotations

import ctypes
import os
import shlex
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from math import inf
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np
from histories import ACCEL, PROJECT, Prepared, most_memory, table
from numpy.polynomial.chebyshev import cheb2poly, chebinterpolate, chebval

from rocking_cli import GroundMotion, load_structure, read_record
from rocking_cli.dynamics import kernels as at
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.structure import MAX_OPENING, build_models

RUNS, ROUNDS, MANY = 2000, 7, 1_000_000
REACH, FIT = 1.3, 1e-11  # of the polynomials over q_cr, and their largest error over the largest value
LOOPS = {
    "plain_libm": "RK4, one step a sample, no events, sin and cos of the C library",
    "plain_series": "the same with polynomials for sine and cosine",
    "plain_polynomial": "the same with polynomials of the tables",
    "crude_libm": "RK4, uplift and impact at samples, sin and cos of the C library",
    "exact_series": "the pair 6(4), event-exact, polynomials for sine and cosine",
}
OURS = {"single": "single histories, with samples", "batch": "`respond_many`, one thread"}
STRUCTURES = {
    "block": (7, "3.2 today", "0.5"), "frame": (8, "4.1 today", "0.6"), "wall": (12, "0.97 today", ""),
    "arch": (12, "", "0.7"),
}  # fmt: skip
"""The degree of their polynomials, and what single histories and a batch should take over RK4 with them."""
GOAL_OF_LIBM = "0.3"  # of a batch over RK4 with sin and cos of the C library


class Record(ctypes.Structure):
    """A ground motion as yardstick.c takes it."""

    _fields_ = [("size", ctypes.c_long), ("dt", ctypes.c_double), ("u", ctypes.c_void_p), ("ahead", ctypes.c_void_p)]


def compiled(folder: Path, degree: int) -> ctypes.CDLL:
    """The loops for polynomials of a degree; ends the program, and says why, if nothing here compiles them."""
    library = folder / f"yardstick-{degree}.so"
    words = [*shlex.split(os.environ.get("CC", "cc")), "-O3", "-march=native", f"-DTERMS={degree + 1}", "-shared"]
    words += ["-fPIC", "-o", str(library), str(PROJECT / "benchmarks" / "yardstick.c"), "-lm"]
    try:
        subprocess.run(words, check=True, capture_output=True, encoding="utf-8")
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"\nThe yardstick in C is not measured: {error}\n{getattr(error, 'stderr', None) or ''}")
        sys.exit()
    return ctypes.CDLL(str(library))


def polynomials(model: Model, degree: int) -> np.ndarray:
    """For each direction, `per_q`, and weight and drive of its tables as polynomials of per_q q - 1."""
    rows, x = [], np.linspace(-1, 1, 999)
    for d, numbers in enumerate(model.numbers):
        end = min(REACH * numbers[at.Q_CR], numbers[at.Q_END])

        def by_tables(x: np.ndarray, d: int = d, per_x: float = end / 2 * numbers[at.PER_CELL]) -> np.ndarray:
            place = (x + 1) * per_x
            k = np.minimum(place.astype(int), len(model.forces) - 1)
            powers = (place - k)[:, None] ** np.arange(4)
            return np.einsum("nfp,np->nf", model.forces[k, d].reshape(-1, 2, 4), powers) * [model.gravity, 1]

        series = chebinterpolate(by_tables, degree)
        if (abs(chebval(x, series).T - by_tables(x)) / abs(by_tables(x)).max(axis=0)).max() > FIT:
            raise ValueError(f"polynomials of degree {degree} do not represent {model.structure}")
        rows.append([2 / end, *cheb2poly(series[:, 0]), *cheb2poly(series[:, 1])])
    return np.array(rows)


class Yardstick:
    """The same runs of one structure by every program: scales from 0.2 to 0.9, or from where it first lifts."""

    def __init__(self, name: str, motion: GroundMotion, folder: Path) -> None:
        degree, structure = STRUCTURES[name][0], load_structure(PROJECT / "examples" / f"{name}.yaml")
        # No run ends early because a joint opens: RK4 does not look at joints.
        (self.model,) = build_models(structure, ("nonlinear",), opening=MAX_OPENING)
        self.name, self.motion, self.loops = name, motion, compiled(folder, degree)
        u, numbers = np.array(motion.acceleration), self.model.numbers
        uplift = numbers[:, at.LAMBDA] * self.model.gravity
        lifts = 1.0001 * min(uplift / [-u.min(), u.max()])
        self.scales = np.linspace(max(0.2, lifts), max(0.9, 2 * lifts), RUNS)
        self.kept = u, np.maximum.accumulate(abs(u[::-1]))[::-1].copy()  # as long as C reads them
        self.record = Record(u.size, motion.dt, *(each.ctypes.data for each in self.kept))
        eta = numbers[:, at.ETA] * numbers[:, at.RATE] / numbers[::-1, at.RATE]
        self.sides = []
        for unit in np.ones(2), numbers[:, at.RATE]:  # q of the tables, and phi of a block
            q_cr, rest = unit * numbers[:, at.Q_CR], unit * numbers[:, at.REST]
            columns = uplift, q_cr, eta, rest, numbers[:, at.P], np.sin(q_cr), np.cos(q_cr)
            self.sides.append(np.column_stack([*columns, polynomials(self.model, degree)]))
        self.one, self.ours = Prepared(self.model, motion), self.batch()
        rocks, falls = np.mean(self.ours.fell | (self.ours.peak_ratio > 0)), self.ours.fell.mean()
        self.runs = [f"{self.scales[0]:.2f} to {self.scales[-1]:.2f}", f"{rocks:.1%}", f"{falls:.0%}"]

    def in_c(self, loop: str) -> np.ndarray:
        """What a loop in C gives each run."""
        results, sides = np.empty(RUNS), self.sides[loop != "plain_polynomial"]
        places = [ctypes.c_void_p(each.ctypes.data) for each in (sides, self.scales, results)]
        getattr(self.loops, loop)(places[0], ctypes.byref(self.record), ctypes.c_long(RUNS), *places[1:])
        return results

    def single(self) -> None:
        """Each history alone."""
        for scale in self.scales:
            self.one.runs[0, [at.FACTOR, at.V_FACTOR]] = scale
            self.one.run()

    def batch(self) -> Outcomes:
        """All in one call."""
        return respond_many([self.model], [self.motion], Runs.of(0, 0, scale=self.scales), threads=1)

    def measured(self, loops: Iterable[str]) -> dict[str, list[float]]:
        """Processor time of each program in each round [us a run]: by turns, as others may be at work."""
        works: dict[str, Callable[[], object]] = {loop: lambda loop=loop: self.in_c(loop) for loop in loops}  # type: ignore[misc]
        works |= {"single": self.single, "batch": self.batch}
        spent: dict[str, list[float]] = {name: [] for name in works}
        for _ in range(ROUNDS):
            for name, work in works.items():
                start = time.process_time()
                work()
                spent[name].append(1e6 * (time.process_time() - start) / RUNS)
        return spent


def ratio(spent: dict[str, list[float]], one: str, other: str) -> str:
    return f"{median(a / b for a, b in zip(spent[one], spent[other], strict=True)):.2f}"


def of_block(block: Yardstick, spent: dict[str, list[float]]) -> None:
    rows = []
    for name, what in {**LOOPS, **OURS}.items():
        goals = [GOAL_OF_LIBM, STRUCTURES["block"][2]] if name == "batch" else ["", ""]
        ratios = [ratio(spent, name, other) for other in ("plain_libm", "plain_series")]
        rows.append([what, f"{median(spent[name]):.1f}", ratios[0], goals[0], ratios[1], goals[1]])
    scales, rocks, falls = block.runs
    table(
        f"The block under {block.motion.name}, {block.motion.npts} points, {RUNS} scales from {scales}: {rocks} of the "
        f"runs rock, {falls} overturn",
        ["program", "us a run", "of RK4, sin and cos", "goal", "of RK4, polynomials", "goal"],
        rows,
    )
    ours = np.where(block.ours.fell, inf, block.ours.peak_ratio)
    for loop in ("crude_libm", "exact_series"):
        theirs = block.in_c(loop)
        both = np.isfinite(ours) & np.isfinite(theirs)
        apart = abs(theirs[both] / ours[both] - 1)
        print(
            f"\n{LOOPS[loop]}: {np.sum(np.isfinite(ours) != np.isfinite(theirs))} other outcomes than ours, and "
            f"{np.mean(apart > 1e-3):.0%} of the peaks differ by more than 0.1 %, half by {np.median(apart):.0e}"
        )


def rates(block: Yardstick) -> None:
    """By the clock: the second core is what is asked for."""
    cores, times = min(2, os.cpu_count() or 1), []
    for count, threads in ((10 * RUNS, 1), (MANY, cores)):
        runs = Runs.of(0, 0, scale=np.resize(block.scales, count))
        before, start = most_memory(), time.perf_counter()
        respond_many([block.model], [block.motion], runs, threads=threads)
        times.append((time.perf_counter() - start) / count)
        grown = most_memory() - before
    rates = f"{1 / times[0]:,.0f}", f"{1 / times[1]:,.0f}", f"{times[0] / times[1] / cores:.0%}"
    table(
        f"{MANY:,} rocking runs of the block in one call",
        ["a second, one thread", f"a second, {cores} threads", "of threads x one", "memory grows by", "bytes a run"],
        [[*rates, f"{grown / 2**20:.0f} MiB", f"{grown / MANY:.0f}"]],
    )


def main() -> None:
    motion, rows = read_record(sys.argv[1] if len(sys.argv) > 1 else ACCEL), []
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # Windows keeps what is loaded
        for name, (degree, single, batch) in STRUCTURES.items():
            yardstick = Yardstick(name, motion, Path(folder))
            spent = yardstick.measured(LOOPS if name == "block" else ["plain_polynomial"])
            if name == "block":
                of_block(yardstick, spent)
                rates(yardstick)
            ratios = [ratio(spent, ours, "plain_polynomial") for ours in OURS]
            alone = f"{median(spent['plain_polynomial']):.1f}"
            rows.append([name, *yardstick.runs, str(degree), alone, ratios[0], single, ratios[1], batch])
    table(
        f"Over {LOOPS['plain_libm'].partition(', sin')[0]}, with polynomials of the structure's own tables",
        ["structure", "scales", "rock", "overturn", "degree", "RK4, us a run", "single", "goal", "batch", "goal"],
        rows,
    )


if __name__ == "__main__":
    main()
