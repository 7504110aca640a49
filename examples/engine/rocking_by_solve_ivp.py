"""A free-standing block, from impact to impact by `solve_ivp` of scipy."""

from __future__ import annotations

from math import atan, cos, hypot, inf, nan, pi, sin, tan

import numpy as np
from scipy.integrate import solve_ivp

from rocking_cli.engines import UNCHECKED, Engine, GroundMotion, History, Structure

REST = 1e-6  # rate after an impact, over p alpha, below which the block is at rest
LONGEST = 60.0  # s after the ground motion: a block that has not come to rest by then is still rocking


def impact(t, y):
    """Zero at an impact."""
    return y[0]


def turn(t, y):
    """Zero at a peak."""
    return y[1]


def flat(t, y):
    """Zero on its side."""
    return y[0] - pi / 2


impact.terminal, impact.direction, turn.direction, flat.terminal = True, -1, -1, True


class BySolveIvp(Engine):
    """The nonlinear equation of motion of one block; its joint with the ground is not checked."""

    name = "by_solve_ivp"

    def refuses(self, structure: Structure) -> str | None:
        """Anything but a bare block that rocks both ways."""
        it = structure.mechanism
        if len(it.bodies()) > 1:
            return f"it has {len(it.bodies())} bodies"
        if it.mechanism != "block":
            return f"its type is {it.mechanism}, not block"
        if it.attached:
            return "loads or ties are attached to it"
        if it.crushing is not None or not it.rocks_both_ways:
            return "its corners crush, or it has side walls"
        return None

    def history(self, structure: Structure, motion: GroundMotion, *, model, release, tail, rtol) -> History:
        """Integrate phi'' = -p^2 (sin(alpha - phi) + s u''/g cos(alpha - phi)) in direction s, with phi >= 0."""
        it, time, ground = structure.mechanism, motion.time, motion.acceleration
        g, alpha = it.gravity, atan(it.width / it.height)
        p = (1.5 * g / hypot(it.width, it.height)) ** 0.5  # p^2 = 3 g / (4 R)
        etas = dict(zip((1, -1), structure.etas, strict=True))  # of impacts that end positive and negative motion
        keep = motion.dt * motion.every
        samples = np.arange(time[:: motion.every].size + round(tail / keep)) * keep

        def lifts(since):
            """When the ground next lifts the block, -s u'' > g tan(alpha), and in which direction s."""
            times, found = np.append(since, time[time > since]), [(inf, 1)]
            for s in (1, -1):
                excess = -s * np.interp(times, time, ground, right=0.0) - g * tan(alpha)
                if (k := int((excess > 0).argmax())) > 0:
                    before, step = excess[k - 1], times[k] - times[k - 1]
                    found.append((times[k - 1] + step * before / (before - excess[k]) + 1e-12, s))
                elif excess[0] > 0:
                    found.append((since, s))
            return min(found)

        t, s = uplift, _ = lifts(0.0)
        w, end, fell, crossed = 0.0, 0.0, 0, nan  # rate with which it starts in direction s; time at which it ended
        phi, rate = np.zeros(samples.size), np.zeros(samples.size)
        impacts, peaks, last = [], {1: 0.0, -1: 0.0}, motion.duration + LONGEST

        while t < last and not fell:

            def slopes(t, y, s=s):
                pull = s / g * np.interp(t, time, ground, right=0.0)
                return [y[1], -(p**2) * (sin(alpha - y[0]) + pull * cos(alpha - y[0]))]

            def critical(t, y):
                return y[0] - alpha

            run = solve_ivp(
                slopes, (t, last), [0.0, w], "DOP853", events=[impact, turn, flat, critical], dense_output=True,
                rtol=rtol, atol=rtol * 1e-3 * alpha, first_step=0.1 * REST / p, max_step=min(keep, 0.1 / p),
            )  # fmt: skip
            inside = (samples >= t) & (samples <= run.t[-1])
            if inside.any():
                phi[inside], rate[inside] = s * run.sol(samples[inside])
            peaks[s] = max([peaks[s], *(y[0] for y in run.y_events[1])])
            t = end = run.t[-1]
            if run.t_events[2].size:
                fell, crossed, peaks[s] = s, run.t_events[3][-1], nan
                phi[samples > t] = rate[samples > t] = nan
            elif t < last:
                impacts.append((t, s, -run.y[1, -1]))
                s, w = -s, -etas[s] * run.y[1, -1]
                if w < REST * p * alpha:
                    (t, s), w = lifts(t), 0.0

        return History(
            model=model,
            still_rocking=t == last,
            failed=False,
            fell_to=fell,
            peak_positive=peaks[1],
            peak_negative=peaks[-1],
            peak_ratio=nan if fell else max(peaks.values()) / alpha,
            overturning_time=crossed,
            uplift_time=nan if uplift == inf else uplift,
            impact_count=len(impacts),
            end_time=end,
            **UNCHECKED,
            time=samples,
            phi=phi,
            rate=rate,
            ratio=phi / alpha,
            impacts=np.array(impacts).reshape(-1, 3),
            p=p,
        )
