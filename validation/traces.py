"""Compare `rocking calibrate --free` with simulated traces of known restitution: traces.csv, in this folder.

    python -m validation.traces [COUNT]     # traces of each case, 200

The traces are integrated here by Runge and Kutta's method, by nothing of the package. A row of traces.csv is a case:
the error of eta of its first trace, and of all of them mean and standard deviation of the error of eta, the standard
deviation that the fits state, and the root mean square of error over that; mean and deviation of the error to the
mean eta of the trace; scatter seen and written; errors of p and alpha [%] if they are fitted; the share of fits whose
residual leaves a pattern [%], and the number that are refused.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from math import atan, cos, hypot, sin, sqrt
from multiprocessing import Pool
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rocking_cli import Block, InputError
from rocking_cli.questions.calibrate.study import Trace, fit_trace
from rocking_cli.structure import Structure
from validation.pages import table

Reals = NDArray[np.float64]

FILE = Path(__file__).with_name("traces.csv")
G, DT, STEPS, IMPACTS = 9.80665, 0.01, 20, 7
COUNT, NOISE, RELEASE = 200, 0.01, 0.7  # traces; noise over the release; release over alpha
SCATTER = 0.02
OFF = 0.03  # error of p and alpha in the file


def simulate(alpha: float, p: float, etas: Sequence[float], release: float, until: int) -> tuple[Reals, list[float]]:
    """Return the rotation of a block at samples until an impact, and the times of the impacts before.

    Parameters
    ----------
    alpha, p : float
        Slenderness [rad] and frequency parameter [rad/s].
    etas : sequence of float
        Restitution of each impact.
    release : float
        Rotation at which it is let go [rad].
    until : int
        Number of the impact with which the trace ends.
    """
    side = 1 if release > 0 else -1
    angle, rate, time, impacts, samples = release, 0.0, 0.0, [], [release]

    def after(angle: float, rate: float, h: float) -> tuple[float, float]:
        def turn(at: float) -> float:
            return -p * p * sin(side * alpha - at)

        k1, l1 = rate, turn(angle)
        k2, l2 = rate + h / 2 * l1, turn(angle + h / 2 * k1)
        k3, l3 = rate + h / 2 * l2, turn(angle + h / 2 * k2)
        k4, l4 = rate + h * l3, turn(angle + h * k3)
        return angle + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), rate + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)

    while True:
        for _ in range(STEPS):
            left = DT / STEPS
            while left > 0:
                ahead = after(angle, rate, left)
                if ahead[0] * side >= 0:
                    angle, rate, left = *ahead, 0.0
                    continue
                low, high = 0.0, left
                for _ in range(50):
                    middle = (low + high) / 2
                    low, high = (middle, high) if after(angle, rate, middle)[0] * side >= 0 else (low, middle)
                rate, angle, left, side = after(angle, rate, high)[1] * etas[len(impacts)], 0.0, left - high, -side
                impacts.append(time + DT / STEPS - left)
                if len(impacts) == until:
                    return np.array(samples), impacts[:-1]
            time += DT / STEPS
        samples.append(angle)


@dataclass(frozen=True)
class Case:
    """Traces of one kind."""

    words: str
    height: float  # of a block 0.1 m wide [m]
    eta: float
    drift: float = 0.0  # over alpha [1/s]
    scatter: float = 0.0
    free: bool = False
    wrong: tuple[float, float] = (1.0, 1.0)  # p and alpha of the file over the true ones
    rough: float = 0.0  # deviation of ln width and ln height of the file
    lift: float = 0.0  # time of lifting, and of holding before the release [s]
    hold: float = 0.3
    every: int = 1  # sample of 100 Hz that is kept

    def block(self, random: np.random.Generator) -> Block:
        """Return the block as a file has it."""
        p, alpha = self.wrong
        angle, diagonal = alpha * atan(0.1 / self.height), hypot(0.1, self.height) / p**2
        one, other = np.exp(self.rough * random.standard_normal(2))
        known = {"uncertainty": {"slenderness": self.rough * sqrt(2)}} if self.rough else {}
        return Block(width=diagonal * sin(angle) * one, height=diagonal * cos(angle) * other, **known)


def fitted(case: Case, seed: int) -> tuple[float, ...] | None:
    """Return of a trace the error of eta, that to its mean, deviation, scatter, caution, errors of p and alpha.

    The deviation is that stated; the scatter that seen and that written.
    """
    random = np.random.default_rng([seed, *case.words.encode(), case.free])
    alpha, p = atan(0.1 / case.height), sqrt(3 * G / (2 * hypot(0.1, case.height)))
    etas = np.minimum(case.eta + case.scatter * random.standard_normal(IMPACTS + 1), 1.0)
    angles, _ = simulate(alpha, p, etas.tolist(), RELEASE * alpha, IMPACTS + 1)
    rise = angles[0] * np.sin(np.linspace(0, np.pi / 2, round(case.lift / DT))) ** 2
    angles = np.concatenate([rise, np.full(round(case.hold / DT), angles[0]), angles])[:: case.every]
    times = case.every * DT * np.arange(angles.size)
    read = angles + case.drift * alpha * times + random.normal(0, NOISE * RELEASE * alpha, angles.size)
    try:
        found = fit_trace(Structure(case.block(random)), Trace("trace", times, read), free_geometry=case.free)
    except InputError:
        return None
    geometry = (found.p.value / p - 1, found.alpha.value / alpha - 1) if found.p and found.alpha else ()
    return (
        found.eta.value - case.eta,
        found.eta.value - etas[:-1].mean(),
        found.eta.deviation,
        found.pooled.seen,
        found.scatter,
        float(found.patterned),
        *geometry,
    )


CASES = [
    case
    for height, eta in ((0.5, 0.9323), (1.0, 0.98), (0.25, 0.8))
    for case in (
        Case(f"0.1 x {height:g} m, eta {eta:g}", height, eta),
        Case(f"0.1 x {height:g} m, eta {eta:g}, drift", height, eta, drift=0.01),
        Case(f"0.1 x {height:g} m, eta {eta:g} +- {SCATTER:g}", height, eta, scatter=SCATTER),
        Case(f"0.1 x {height:g} m, eta {eta:g} +- {SCATTER:g}, drift", height, eta, drift=0.01, scatter=SCATTER),
    )
]
RECORDED = [
    Case("lifted in 0.2 s and let go", 0.5, 0.9323, drift=0.01, lift=0.2, hold=0),
    Case("lifted in 10 s, held for 20 s", 0.5, 0.9323, drift=0.01, lift=10, hold=20),
    Case("lifted in 2 s, held for 5 s, 25 Hz", 0.5, 0.9323, drift=0.01, lift=2, hold=5, every=4),
]
WRONG = [
    Case("width and height off by 6 % (standard deviation)", 0.5, 0.9323, drift=0.01, rough=0.06),
    Case(f"the same, eta +- {SCATTER:g}", 0.5, 0.9323, drift=0.01, rough=0.06, scatter=SCATTER),
] + [
    Case(f"0.1 x {height:g} m, eta {eta:g}, {name} {100 * OFF:g} % too large", height, eta, wrong=wrong)
    for height, eta in ((0.5, 0.9323), (0.25, 0.8))
    for name, wrong in (("p", (1 + OFF, 1.0)), ("alpha", (1.0, 1 + OFF)))
]
FREE = [
    Case(f"0.1 x {height:g} m, eta {eta:g}{', drift' * (drift > 0)}", height, eta, drift=drift, free=True)
    for height, eta in ((0.5, 0.9323), (0.25, 0.8))
    for drift in (0.0, 0.01)
]


KINDS = {
    "restitution is constant": [each for each in CASES if not each.scatter],
    f"restitution scatters by {SCATTER:g}": [each for each in CASES if each.scatter],
    "lifted and held before the release": RECORDED,
    "sizes off by 6 %, as the file states": WRONG[:2],
    f"p or alpha {100 * OFF:g} % too large, not stated": WRONG[2:],
    "p and alpha fitted as well": FREE,
}
ALL = [case for cases in KINDS.values() for case in cases]
PAIRS = ("to_mean", "scatter", "p", "alpha")  # of these a case has two numbers
HEADS = ("kind", "trace", "traces", "first", "bias", "deviation", "stated", "over_stated",
         *(f"{name}_{k}" for name in PAIRS for k in (1, 2)), "caution", "refused")  # fmt: skip


def row(kind: str, case: Case, found: Sequence[tuple[float, ...] | None]) -> list[str]:
    """Return a line of the file."""
    kept = np.array([each for each in found if each is not None])
    bias, spread = kept.mean(axis=0), kept.std(axis=0, ddof=1)
    pull = np.sqrt(np.mean((kept[:, 0] / kept[:, 2]) ** 2))
    cells = [kind, case.words, str(len(found)), first(found[0]), f"{bias[0]:.5f}", f"{spread[0]:.5f}"]
    cells += [f"{bias[2]:.5f}", f"{pull:.2f}"]
    if case.free:
        cells += ["", "", "", "", *(f"{100 * each:.2f}" for k in (6, 7) for each in (bias[k], spread[k]))]
    else:
        cells += [f"{bias[1]:.5f}", f"{spread[1]:.5f}", f"{bias[3]:.4f}", f"{bias[4]:.4f}", "", "", "", ""]
    return [*cells, f"{100 * bias[5]:.0f}", str(len(found) - len(kept))]


def first(found: tuple[float, ...] | None) -> str:
    """Return the error of eta of the first trace of a case."""
    return "refused" if found is None else f"{found[0]:.5f}"


def rows() -> list[dict[str, str]]:
    """Return the lines of the file."""
    with FILE.open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def stale() -> list[str]:
    """Return the cases whose first trace is no longer what it was, but for a unit of the last digit."""
    kept, now = rows(), [first(fitted(case, 0)) for case in ALL]
    if [row["trace"] for row in kept] != [case.words for case in ALL]:
        return ["other cases"]
    return [
        row["trace"]
        for row, each in zip(kept, now, strict=True)
        if (was := row["first"]) != each and ("refused" in (was, each) or abs(float(was) - float(each)) > 1.01e-5)
    ]


def summary() -> str:
    """Return the table of the page: of each kind of trace the ranges of its cases."""

    def span(kind: str, column: str) -> str:
        low, *_, high = sorted((row[column] for row in rows() if row["kind"] == kind), key=float)
        return low if low == high else f"{low} to {high}"

    def refused(kind: str) -> str:
        own = [row for row in rows() if row["kind"] == kind]
        return f"{sum(int(row['refused']) for row in own)} of {sum(int(row['traces']) for row in own)}"

    heads = ("traces", "bias of eta", "deviation", "error over stated", "caution [%]", "refused")
    columns = ("bias", "deviation", "over_stated", "caution")
    return table(heads, ([kind, *(span(kind, each) for each in columns), refused(kind)] for kind in KINDS))


def main() -> int:
    """Write the file."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else COUNT
    made = []
    with Pool() as pool:
        for kind, cases in KINDS.items():
            for case in cases:
                made.append(row(kind, case, pool.map(partial(fitted, case), range(count), chunksize=5)))
                print(case.words, file=sys.stderr)
    with FILE.open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream, lineterminator="\n").writerows([HEADS, *made])
    return 0


if __name__ == "__main__":
    sys.exit(main())
