"""The same history by scipy's `solve_ivp`: the same equation from the same tables, stopped at every impact."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from rocking_cli import GroundMotion
from rocking_cli.dynamics import kernels as at
from rocking_cli.dynamics.model import Model


def impact(t: float, y: list[float]) -> float:
    """Zero where q is."""
    return y[0]


def turn(t: float, y: list[float]) -> float:
    """Zero where q stands still."""
    return y[1]


impact.terminal, impact.direction, turn.direction = True, -1, -1  # type: ignore[attr-defined]


class BySolveIvp:
    """Histories of one structure under one record, in plain floats: numpy would be slower on numbers one at a time."""

    def __init__(self, model: Model, motion: GroundMotion, rtol: float) -> None:
        self.rtol, self.dt = rtol, motion.dt
        columns = ("lambda", "q_cr", "eta", "rate", "rest", "q_end", "per_cell")  # the kernel's, in its order
        self.rows = [dict(zip(columns, row, strict=False)) for row in model.numbers.tolist()]
        self.gravity = float(model.numbers[0, at.GRAVITY])
        self.cells = [model.forces[:, d].tolist() for d in range(2)]
        self.ground = motion.acceleration.tolist()
        self.model = model

    def outcome(self) -> float:
        """The largest |phi|/phi_cr, the motion followed to rest; if it overturns, minus the time of passing 1."""
        end = (len(self.ground) - 1) * self.dt
        t, d, w, peaks = 0.0, 0, 0.0, [0.0, 0.0]
        while True:
            if w == 0:
                lift = self._lifts_after(t)
                if lift is None:
                    return max(self._phi(d, q) / self.model.phi_cr[d] for d, q in enumerate(peaks))
                t, d = lift
            slopes = self._slopes(d)
            fall = slopes(t, [0.0, w])[1]
            # Its first step must not jump over a short hop, which it would not see.
            first = min(self.dt, -w / fall) if w > 0 and fall < 0 else 1e-6
            run = solve_ivp(
                slopes, (t, end + 60.0), [0.0, w], "DOP853", events=[impact, turn, *self._levels(d)],
                rtol=self.rtol, atol=self.rtol * 1e-2 * self.rows[d]["q_cr"], max_step=self.dt, first_step=first,
            )  # fmt: skip
            peaks[d] = max(peaks[d], *(y[0] for y in run.y_events[1]), 0.0)
            if run.t_events[2].size:
                return -float(run.t_events[3][-1])
            row, other = self.rows[d], self.rows[1 - d]
            t, d, w = run.t[-1], 1 - d, -row["eta"] * run.y[1, -1] * row["rate"] / other["rate"]
            if w < other["rest"]:
                w = 0.0

    def _at(self, t: float) -> float:
        k = int(t / self.dt)
        if k >= len(self.ground) - 1:
            return 0.0
        return self.ground[k] + (self.ground[k + 1] - self.ground[k]) * (t / self.dt - k)

    def _slopes(self, d: int) -> Callable[[float, list[float]], list[float]]:
        cells, per_cell, s = self.cells[d], self.rows[d]["per_cell"], 1 - 2 * d

        def slopes(t: float, y: list[float]) -> list[float]:
            place = y[0] * per_cell
            k = min(max(int(place), 0), len(cells) - 1)
            x = place - k
            a = cells[k]
            weight = a[0] + x * (a[1] + x * (a[2] + x * a[3]))
            drive = a[4] + x * (a[5] + x * (a[6] + x * a[7]))
            return [y[1], -(self.gravity * weight + s * self._at(t) * drive)]

        return slopes

    def _levels(self, d: int) -> list[Callable[[float, list[float]], float]]:
        """Zero where it has fallen, and where it passes phi_cr."""
        critical = self.rows[d]["q_cr"]

        def fall(t: float, y: list[float]) -> float:
            return y[0] - 2 * critical

        def cross(t: float, y: list[float]) -> float:
            return y[0] - critical

        fall.terminal, cross.direction = True, 1  # type: ignore[attr-defined]
        return [fall, cross]

    def _lifts_after(self, t: float) -> tuple[float, int] | None:
        """When the ground next passes the uplift acceleration, and the direction it lifts."""
        for k in range(int(t / self.dt), len(self.ground) - 1):
            for d in range(2):
                s, limit = 2 * d - 1, self.rows[d]["lambda"] * self.gravity
                now, then = s * self.ground[k] - limit, s * self.ground[k + 1] - limit
                start = max(t / self.dt - k, 0.0)
                if then > 0 or now + (then - now) * start > 0:
                    return (k + (max(-now / (then - now), start) if then > now else start)) * self.dt + 1e-12, d
        return None

    def _phi(self, d: int, q: float) -> float:
        k = int(q * self.rows[d]["per_cell"])
        return float(np.polynomial.Polynomial(self.model.angles[k, d, :4])(q * self.rows[d]["per_cell"] - k))
