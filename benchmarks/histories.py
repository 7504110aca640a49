"""How fast a history is, as ratios within one run: machines differ, and so does one machine from hour to hour.

    python benchmarks/histories.py [RECORD]

Times the compiled kernel, warm and to the end of the motion, on a record of your own or the shipped example; for the
block also against scipy's `solve_ivp` on Eq. 3, stopped at every impact.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from functools import partial
from math import cos, sin
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from rocking_cli import GroundMotion, equivalent_block, load_structure, read_record
from rocking_cli.core import EquivalentBlock
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import MODELS, build_models

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
SCALES = {"block": (0.5, 0.6), "frame": (0.5, 1.0)}


def median_time(work: Callable[[], object], repeats: int = 30) -> float:
    """Median seconds of one call, after one to warm up."""
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def by_solve_ivp(block: EquivalentBlock, motion: GroundMotion, t: float, s: float) -> None:
    """Eq. 3 in plain floats by `solve_ivp`, stopped at impacts, from uplift at t to side s."""
    grid = (np.arange(motion.npts) * motion.dt).tolist()
    ground = (motion.acceleration / 9.80665).tolist()
    state = [1e-12, 0.0]
    for _ in range(500):
        side = s

        def slopes(t: float, y: list[float], s: float = side) -> list[float]:
            k = min(int(t / motion.dt), motion.npts - 2)
            a = ground[k] + (ground[k + 1] - ground[k]) * (t - grid[k]) / motion.dt
            return [y[1], block.p**2 * (-sin(block.phi_cr - y[0]) - s * a * cos(block.phi_cr - y[0]))]

        def impact(t: float, y: list[float]) -> float:
            return y[0]

        impact.terminal, impact.direction = True, -1  # type: ignore[attr-defined]
        run = solve_ivp(
            slopes, (t, grid[-1]), state, "DOP853", events=impact, rtol=1e-8, atol=1e-10, max_step=2 * motion.dt
        )
        if run.status != 1 or run.y[0].max() > 2 * block.phi_cr or abs(run.y[1][-1]) < 1e-5:
            return
        t, state, s = run.t[-1], [0.0, -block.eta * run.y[1][-1]], -s


def main() -> None:
    motion = read_record(sys.argv[1] if len(sys.argv) > 1 else EXAMPLES / "accel.csv")
    print(f"{motion.name}: {motion.npts} points, dt = {motion.dt:g} s; medians, warm")
    print(f"{'structure':<10} {'scale':>5} {'model':<10} {'ms':>8} {'ns/sample':>10} {'solve_ivp/kernel':>17}")
    for name, scale in ((name, scale) for name, scales in SCALES.items() for scale in scales):
        mechanism, shaken = load_structure(EXAMPLES / f"{name}.yaml"), motion.scaled(scale)
        equivalence = equivalent_block(mechanism)
        for model in build_models(mechanism, MODELS):
            work = partial(follow, model, shaken, tail=0.0)
            fast, ratio = median_time(work), ""
            if name == "block" and model.name == "nonlinear":
                run = work()
                slow = partial(by_solve_ivp, equivalence.positive, shaken, run.uplift_time, run.impacts[0, 1])
                ratio = f"{median_time(slow, 1) / fast:17.0f}"
            print(
                f"{name:<10} {scale:5.2g} {model.name:<10} {fast * 1e3:8.3f} {fast / motion.npts * 1e9:10.0f} {ratio}"
            )


if __name__ == "__main__":
    main()
