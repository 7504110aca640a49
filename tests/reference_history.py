"""Independent histories for the tests: slow, and by other means than the engine's.

Nonlinear: I phi'' + J phi'^2 + (g + v) G = -s B u on the mechanism's own coefficients (not the engine's
tables), by DOP853 at 1e-12; the linear model with vertical ground motion likewise.
Linear: phi'' = p^2 (phi - phi_cr - s kappa u/g) with 50 digits, its turning points from a quadratic in exp(p t).
"""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from mpmath import mp, mpf
from scipy.integrate import DOP853, solve_ivp
from scipy.optimize import brentq

from rocking_cli.core import Direction

mp.dps = 50
SIDES = (1, -1)
GAUSS = np.polynomial.legendre.leggauss(60)


def pieces(dt, u, vertical=None):
    """The straight pieces of both components, the vertical one as (dt, samples): start, length, u and v at both ends.

    Nothing after the end of both, in pieces of length dt for ever.
    """
    components = [(dt, u)] if vertical is None else [(dt, u), vertical]
    times = np.unique(np.concatenate([np.arange(len(samples)) * step for step, samples in components]))
    times = times[np.append(True, np.diff(times) > 1e-11)]

    def at(t, middle, step, samples):
        k = int(middle / step)
        return samples[k] + (samples[k + 1] - samples[k]) * (t / step - k) if k < len(samples) - 1 else 0.0

    for a, b in pairwise(times.tolist()):
        ends = [at(t, (a + b) / 2, *component) for component in components for t in (a, b)]
        yield a, b - a, *ends, *([0.0, 0.0] if vertical is None else [])
    end = float(times[-1])
    while True:
        yield end, dt, 0.0, 0.0, 0.0, 0.0
        end += dt


@dataclass
class Motion:
    """Impacts as (time, direction that ends, rate before), peaks by direction, upward crossings of phi_cr, the end.

    `rates` are the largest of |phi'| by direction.
    """

    impacts: list = field(default_factory=list)
    peaks: dict = field(default_factory=lambda: {1: 0.0, -1: 0.0})
    rates: dict = field(default_factory=lambda: {1: 0.0, -1: 0.0})
    crossings: list = field(default_factory=list)
    uplift: float | None = None
    ended: str = "stopped"
    end: float = 0.0


class Nonlinear:
    """The equation of motion of a mechanism in both directions."""

    def __init__(self, mechanism):
        self.mechanism, self.g = mechanism, mechanism.gravity
        self.eta = {s: mechanism.eta(Direction(s)) for s in SIDES}
        self.phi_cr = {s: mechanism.critical_rotation(Direction(s)) for s in SIDES}
        self.limit = {s: mechanism.limit(Direction(s)) for s in SIDES}
        rest = {s: self.at(0.0, s) for s in SIDES}
        self.threshold = {s: self.g * rest[s].G[0] / rest[s].B[0] for s in SIDES}
        self.inertia = {s: rest[s].I[0] for s in SIDES}
        critical = {s: self.at(self.phi_cr[s], s) for s in SIDES}
        self.p = {s: np.sqrt(-self.g * critical[s].dG[0] / critical[s].I[0]) for s in SIDES}
        self.points = {}
        for s in SIDES:
            self._interpolate(s)
        self.size = 1e-3  # of the next step [s]
        self.barrier = {s: self.g * critical[s].V[0] for s in SIDES}

    def at(self, phi, s):
        return self.many(np.array([float(phi)]), s)

    def many(self, phi, s):
        return self.mechanism.coefficients(phi, Direction(s))

    def _interpolate(self, s):
        """I, J, G and B at Chebyshev points: with 49 of them up to 1.4 phi_cr what lies between is exact to 1e-12."""
        k = np.arange(49)
        low, high = -0.05 * self.phi_cr[s], 1.4 * self.phi_cr[s]
        points = low + (high - low) * (1 - np.cos(np.pi * k / 48)) / 2
        weights = (-1.0) ** k * np.where((k == 0) | (k == 48), 0.5, 1.0)
        c = self.many(points, s)
        self.points[s] = points, weights, np.stack([c.I, c.J, c.G, c.B], axis=1)
        for phi in np.linspace(0, high, 20):
            c = self.at(phi, s)
            exact = np.array([c.I[0], c.J[0], c.G[0], c.B[0]])
            sizes = abs(self.points[s][2]).max(axis=0)[[0, 0, 2, 3]]  # J may be nothing but rounding error of I
            assert (abs(self.four(phi, s) - exact) <= 1e-12 * sizes).all()

    def four(self, phi, s):
        """I, J, G and B: from the points in barycentric form, or else from the mechanism itself."""
        points, weights, values = self.points[s]
        if points[0] < phi < points[-1] and phi not in points:
            ratio = weights / (phi - points)
            return ratio @ values / ratio.sum()
        c = self.at(phi, s)
        return np.array([c.I[0], c.J[0], c.G[0], c.B[0]])

    def slopes(self, y, s, u, v=0.0):
        inertia, j, g, b = self.four(y[0], s)
        return np.array([y[1], -(j * y[1] ** 2 + (self.g + v) * g + s * b * u) / inertia])

    def energy(self, phi, rate, s):
        c = self.at(phi, s)
        return c.I[0] * rate**2 / 2 + self.g * c.V[0]

    def quarter(self, amplitude, s):
        """Time from rest at an amplitude to the ground: an integral smooth in x, phi = amplitude (1 - x^2)."""
        x, weight = (1 + GAUSS[0]) / 2, GAUSS[1] / 2
        phi = amplitude * (1 - x * x)
        # V(amplitude) - V(phi) as an integral of G, for the difference of two V would cancel.
        between = amplitude - np.outer(amplitude - phi, x)
        fall = (amplitude - phi) * (self.many(between.ravel(), s).G.reshape(between.shape) @ weight)
        return float(weight @ (2 * amplitude * x * np.sqrt(self.many(phi, s).I / (2 * self.g * fall))))

    def follow(self, dt, samples, release=0.0, impacts_after=3, vertical=None):
        """Follow a ground motion and on, until `impacts_after` more impacts, rest or the kinematic limit."""
        motion = Motion()
        s = -1 if release < 0 else 1
        y = np.array([abs(release) * self.phi_cr[s], 0.0])
        motion.peaks[s] = y[0]
        resting = y[0] == 0
        wanted = None
        quiet = max(step * (len(x) - 1) for step, x in ((dt, samples), vertical or (dt, samples)))
        for start, length, *ground in pieces(dt, np.asarray(samples, float), vertical):
            if start > quiet - 1e-11:
                wanted = len(motion.impacts) + impacts_after if wanted is None else wanted
                if resting:
                    motion.ended = "rest"
                    break
            tau = 0.0
            while tau < length:
                if resting:
                    tau, s = self._lifts(tau, length, *ground)
                    if s == 0:
                        break
                    resting, y = False, np.zeros(2)
                    motion.uplift = start + tau if motion.uplift is None else motion.uplift
                tau, y, hit = self._fly(motion, s, start, tau, length, y, *ground)
                if motion.ended == "fallen":
                    motion.end = start + tau
                    return motion
                if hit:
                    motion.impacts.append((start + tau, s, -y[1]))
                    y = np.array([0.0, -self.eta[s] * y[1]])
                    s = -s
                    if len(motion.impacts) == wanted:
                        motion.end = start + tau
                        return motion
                    # Rest: less kinetic energy than 1e-12 of what overturns, and nothing to lift it now.
                    faint = self.inertia[s] * y[1] ** 2 / 2 < 1e-12 * self.barrier[s]
                    if faint and all(self._excess(side, tau / length, *ground) < 0 for side in SIDES):
                        resting = True
        motion.end = start
        return motion

    def _excess(self, s, x, u0, u1, v0, v1):
        """How far the ground is beyond uplift at a fraction x of a piece."""
        return -s * (u0 + (u1 - u0) * x) - self.threshold[s] * (1 + (v0 + (v1 - v0) * x) / self.g)

    def _lifts(self, tau, end, *ground):
        found = []
        for s in SIDES:
            now, then = (self._excess(s, x / end, *ground) for x in (tau, end))
            if now > 0:
                found.append((tau, s))
            elif then > 0:
                found.append((tau - (end - tau) * now / (then - now), s))
        return min(found, default=(end, 0))

    def _fly(self, motion, s, start, tau, end, y, u0, u1, v0, v1):
        ramp, grade = (u1 - u0) / end, (v1 - v0) / end

        def f(t, z):
            return self.slopes(z, s, u0 + ramp * t, v0 + grade * t)

        tiny = 1e-14 * self.phi_cr[s] * np.array([1.0, self.p[s]])
        solver = DOP853(f, tau, y, end, rtol=1e-12, atol=tiny, first_step=min(end - tau, max(self.size, 1e-9)))
        while solver.status == "running":
            t0, y0 = solver.t, solver.y.copy()
            solver.step()
            assert solver.status != "failed"
            if solver.status == "running" or solver.t - t0 > self.size:
                self.size = solver.t - t0
            dense = solver.dense_output()

            def exact(x, t0=t0, y0=y0):
                return solve_ivp(f, (t0, x), y0, "DOP853", rtol=1e-12, atol=tiny).y[:, -1]

            def root(index, level, a, b, dense=dense, exact=exact, t0=t0):
                # Brent on the interpolant, then Newton on the integration itself.
                x = brentq(lambda t: dense(t)[index] - level, a, b, xtol=1e-16, rtol=1e-14)
                for _ in range(2 if x > t0 else 0):
                    z = exact(x)
                    x -= (z[index] - level) / f(x, z)[index]
                return x, exact(x)

            def gather(a, za, b, zb, dense=dense):
                speeds = [za[1], zb[1]]
                if f(a, za)[1] * f(b, zb)[1] < 0:
                    speeds.append(dense(brentq(lambda t: f(t, dense(t))[1], a, b, xtol=1e-16))[1])
                motion.rates[s] = max(motion.rates[s], *np.abs(speeds).tolist())

            grid = np.linspace(t0, solver.t, 9)
            z = dense(grid)
            z[:, 0], z[:, -1] = y0, solver.y
            for i in range(8):
                a, b = grid[i], grid[i + 1]
                stops = [(a, z[:, i]), (b, z[:, i + 1])]
                if z[1, i] * z[1, i + 1] < 0:
                    stops.insert(1, root(1, 0.0, a, b))
                for (ta, za), (tb, zb) in pairwise(stops):  # monotonic between these
                    motion.peaks[s] = max(motion.peaks[s], za[0], zb[0])
                    if za[0] < self.phi_cr[s] <= zb[0]:
                        motion.crossings.append(start + root(0, self.phi_cr[s], ta, tb)[0])
                    if zb[0] < za[0] and zb[0] <= 0:
                        x, hit = (tb, zb) if zb[0] == 0 else root(0, 0.0, ta, tb)
                        gather(ta, za, x, hit)
                        return x, hit, True
                    gather(ta, za, tb, zb)
                if z[0, i + 1] > 0.99 * self.limit[s]:
                    motion.ended = "fallen"
                    return b, z[:, i + 1], False
        return end, solver.y, False


class Equivalent(Nonlinear):
    """The linear model with vertical ground motion: phi'' = p^2 ((1 + v/g) (phi - phi_cr) - s kappa u/g)."""

    def __init__(self, equivalence, kappa, gravity):
        blocks = {1: equivalence.positive, -1: equivalence.negative}
        self.g, self.size = gravity, 1e-3
        self.p, self.phi_cr, self.eta = (
            {s: float(getattr(block, name)) for s, block in blocks.items()} for name in ("p", "phi_cr", "eta")
        )
        self.kappa = {s: float(getattr(block, f"kappa{kappa}")) for s, block in blocks.items()}
        self.threshold = {s: gravity * self.phi_cr[s] / self.kappa[s] for s in SIDES}
        self.limit = dict.fromkeys(SIDES, 100.0)
        self.inertia = dict.fromkeys(SIDES, 1.0)
        self.barrier = {s: (self.p[s] * self.phi_cr[s]) ** 2 / 2 for s in SIDES}

    def four(self, phi, s):
        stiffness = self.p[s] ** 2 / self.g
        return 1.0, 0.0, stiffness * (self.phi_cr[s] - phi), stiffness * self.kappa[s]


class Linear:
    """The linear model of both directions, from p, phi_cr, kappa and eta as given, in 50 digits."""

    def __init__(self, equivalence, kappa, gravity):
        blocks = {1: equivalence.positive, -1: equivalence.negative}
        self.p = {s: mpf(block.p) for s, block in blocks.items()}
        self.phi_cr = {s: mpf(block.phi_cr) for s, block in blocks.items()}
        self.eta = {s: mpf(block.eta) for s, block in blocks.items()}
        self.kappa = {s: mpf(getattr(block, f"kappa{kappa}")) / mpf(gravity) for s, block in blocks.items()}
        self.threshold = {s: self.phi_cr[s] / self.kappa[s] for s in SIDES}

    def follow(self, dt, samples, release=0.0, impacts_after=3, most_impacts=10**6):
        u, dt = [mpf(float(x)) for x in samples], mpf(dt)
        motion = Motion(peaks={1: mpf(0), -1: mpf(0)}, rates={1: mpf(0), -1: mpf(0)})
        s = -1 if release < 0 else 1
        phi, rate = abs(mpf(release)) * self.phi_cr[s], mpf(0)
        motion.peaks[s] = phi
        resting = phi == 0
        wanted = None
        k, last = 0, len(u) - 1
        while True:
            start = k * dt
            u0, u1 = (u[k], u[k + 1]) if k < last else (mpf(0), mpf(0))
            k += 1
            if k > last:
                wanted = len(motion.impacts) + impacts_after if wanted is None else wanted
                if resting:
                    motion.ended = "rest"
                    break
                if phi > self.phi_cr[s] and rate >= 0:
                    motion.ended = "fallen"
                    break
            tau = mpf(0)
            while tau < dt:
                if resting:
                    tau, s = self._lifts(tau, dt, u0, u1)
                    if s == 0:
                        break
                    resting, phi, rate = False, mpf(0), mpf(0)
                    motion.uplift = start + tau if motion.uplift is None else motion.uplift
                tau, phi, rate, hit = self._fly(motion, s, start, tau, dt, phi, rate, u0, (u1 - u0) / dt)
                if hit:
                    motion.impacts.append((start + tau, s, -rate))
                    phi, rate, s = mpf(0), -self.eta[s] * rate, -s
                    if len(motion.impacts) in (wanted, most_impacts):
                        motion.end = start + tau
                        return motion
                    now = u0 + (u1 - u0) * tau / dt
                    if rate < mpf("1e-6") * self.p[s] * self.phi_cr[s]:
                        resting = all(-side * now < self.threshold[side] for side in SIDES)
        motion.end = k * dt
        return motion

    def _lifts(self, tau, dt, u0, u1):
        found = []
        for s in SIDES:
            now, then = (-s * (u0 + (u1 - u0) * x / dt) - self.threshold[s] for x in (tau, dt))
            if now > 0:
                found.append((tau, s))
            elif then > 0:
                found.append((tau - (dt - tau) * now / (then - now), s))
        return min(found, default=(dt, 0))

    def _fly(self, motion, s, start, tau, end, phi, rate, u0, ramp):
        # phi = balance + a e^(px) + c e^(-px), balance = phi_cr + s kappa u a straight line of slope m.
        p, m = self.p[s], s * self.kappa[s] * ramp
        balance = self.phi_cr[s] + s * self.kappa[s] * (u0 + ramp * tau)
        a, c = (phi - balance + (rate - m) / p) / 2, (phi - balance - (rate - m) / p) / 2

        def at(x):
            grow, fade = mp.exp(p * x), mp.exp(-p * x)
            return balance + m * x + a * grow + c * fade, m + p * (a * grow - c * fade)

        def gather(x):
            # phi'' = 0 is a z^2 + c = 0.
            turn = mp.log(-c / a) / (2 * p) if a * c < 0 else mpf(0)
            speeds = [abs(at(y)[1]) for y in (mpf(0), turn, x) if 0 <= y <= x]
            motion.rates[s] = max(motion.rates[s], *speeds)

        # phi' = 0 is p a z^2 + m z - p c = 0 in z = e^(px).
        span = end - tau
        turns = []
        if a == 0:
            turns = [p * c / m] if m != 0 else []
        elif m * m + 4 * p * p * a * c >= 0:
            root = mp.sqrt(m * m + 4 * p * p * a * c)
            turns = [(-m + root) / (2 * p * a), (-m - root) / (2 * p * a)]
        turns = sorted(mp.log(z) / p for z in turns if z > 0)
        small = span * mpf("1e-20")  # a start at uplift is a double root, known to half the digits
        stops = [mpf(0), *(x for x in turns if small < x < span), span]
        values = [phi, *(at(x)[0] for x in stops[1:])]
        for xa, xb, va, vb in zip(stops, stops[1:], values, values[1:], strict=False):
            if vb > va:
                motion.peaks[s] = max(motion.peaks[s], vb)
                if va < self.phi_cr[s] <= vb:
                    motion.crossings.append(start + tau + self._root(at, self.phi_cr[s], xa, xb))
            elif vb <= 0:
                x = self._root(at, mpf(0), xa, xb)
                gather(x)
                return tau + x, mpf(0), at(x)[1], True
        gather(span)
        return end, values[-1], at(span)[1], False

    @staticmethod
    def _root(at, level, low, high):
        """The one root of a monotonic phi - level in [low, high]: Newton inside a shrinking bracket."""
        rises = at(high)[0] > level
        x = (low + high) / 2
        for _ in range(300):
            value, slope = at(x)
            if (value > level) == rises:
                high = x
            else:
                low = x
            new = x - (value - level) / slope if slope else low
            if not low < new < high:
                new = (low + high) / 2
            if abs(new - x) < mpf("1e-44"):
                return new
            x = new
        raise AssertionError("no root")
