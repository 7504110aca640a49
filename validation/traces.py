"""Compare `rocking calibrate --free` with simulated traces of known restitution: docs/trust/traces.md.

    python -m validation.traces [COUNT]     # traces of each case, 200

The traces are integrated here by Runge and Kutta's method, by nothing of the package.
"""

from __future__ import annotations

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

Reals = NDArray[np.float64]

PART = Path(__file__).resolve().parents[1] / "docs" / "trust" / "traces.md"
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


def row(case: Case, found: Sequence[tuple[float, ...] | None]) -> str:
    """Return a line of the table."""
    kept = np.array([each for each in found if each is not None])
    bias, spread = kept.mean(axis=0), kept.std(axis=0, ddof=1)
    alpha = atan(0.1 / case.height)
    pull = np.sqrt(np.mean((kept[:, 0] / kept[:, 2]) ** 2))
    cells = [case.words, f"{alpha:.2f}", f"{bias[0]:+.5f}", f"{spread[0]:.5f}", f"{bias[2]:.5f}", f"{pull:.2f}"]
    if case.free:
        cells += [f"{100 * bias[k]:+.2f} +- {100 * spread[k]:.2f} %" for k in (6, 7)]
    else:
        cells += [f"{bias[1]:+.5f}", f"{spread[1]:.5f}", f"{bias[3]:.4f}", f"{bias[4]:.4f}"]
    return f"| {' | '.join(cells)} | {100 * bias[5]:.0f} % | {len(found) - len(kept)} |"


def sample() -> str:
    """Return a comment with the error of eta of the first trace of each kind, by which a stale part is noticed."""
    found = [fitted(case, 0) for case in (*CASES, *RECORDED, *WRONG, *FREE)]
    return (
        f"<!-- of the first traces: {', '.join('refused' if each is None else f'{each[0]:.5f}' for each in found)} -->"
    )


def page(rows: Sequence[str], recorded: Sequence[str], wrong: Sequence[str], free: Sequence[str], count: int) -> str:
    """Return the part of the page."""
    heads = (
        "| trace | alpha | bias of eta | deviation | as stated | error over stated | bias to the mean of its etas | "
        "deviation | scatter seen | written | caution | refused |"
    )
    other = (
        "| trace | alpha | bias of eta | deviation | as stated | error over stated | p | alpha | caution | refused |"
    )
    return f"""## Restitution from a trace

`rocking calibrate --free` on {count} simulated traces of each kind: a block let go at {RELEASE:g} alpha, seven
impacts, 100 Hz, noise of {100 * NOISE:g} % of the release, with and without a drift of 1 % of alpha a second.
`validation/traces.py` integrates them by a method of its own. 'As stated' is the mean of the standard deviations that
the fits state, 'error over stated' the root mean square of the ratio (1 if it covers), and 'caution' the share of fits
whose residual is said to leave a pattern. Where eta scatters from impact to impact (+- {SCATTER:g}), no single eta is
right: the fit is checked against the mean of the seven that the trace had, too. Etas above 1 are set to 1, which
lowers their mean in the rows of 0.98. Traces that are refused are left out of the other columns.

{heads}
{"|---" * 12}|
{chr(10).join(rows)}

The stated deviation has noise, the scatter over the number of impacts, and the error of the geometry: by default 10 %
of slenderness and 3.5 % of p. Seven impacts do not tell a small scatter from none, so the scatter is drawn towards .03,
that of other bodies, as by one more impact, and is never 0. Hence the stated deviation is much larger than the errors
where the file is exact and eta is constant.

With lifting and holding simulated, and a drift:

{heads}
{"|---" * 12}|
{chr(10).join(recorded)}

In the first two rows width and height of the file err at random, and `uncertainty` states by how much: only these
test whether the stated deviation covers such an error ('error over stated' below 1: too wide). In the others p or alpha
is {100 * OFF:g} % too large, and nothing states it; a missing caution does not show that the geometry is right:

{heads}
{"|---" * 12}|
{chr(10).join(wrong)}

With p and alpha fitted as well:

{other}
{"|---" * 10}|
{chr(10).join(free)}

{sample()}
"""


def main() -> int:
    """Write the part of the page."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else COUNT
    found = {}
    with Pool() as pool:
        for case in [*CASES, *RECORDED, *WRONG, *FREE]:
            found[case] = pool.map(partial(fitted, case), range(count), chunksize=5)
            print(case.words, file=sys.stderr)
    PART.parent.mkdir(exist_ok=True)
    text = page(*([row(case, found[case]) for case in cases] for cases in (CASES, RECORDED, WRONG, FREE)), count)
    PART.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
