"""A motion from impact to impact: DOP853 at 1e-12, cut where anything of the equation of motion is not smooth."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from .series import Reals
from .structures import SIDES, Structure

FAINT = 1e-12  # of V'(0) times 0.1 rad: less kinetic energy than that after an impact is rest


@dataclass(frozen=True)
class Ground:
    """Ground accelerations, straight between `times` and nothing after the last [s, m/s2]."""

    times: Sequence[float]
    horizontal: Sequence[float]
    vertical: Sequence[float] | None = None

    def pieces(self, until: float) -> Iterator[tuple[float, float, Reals, Reals]]:
        """Start, end, and both components at each."""
        times = np.asarray(self.times, float)
        both = np.array([self.horizontal, np.zeros(len(times)) if self.vertical is None else self.vertical], float)
        for i in range(len(times) - 1):
            yield float(times[i]), float(times[i + 1]), both[:, i], both[:, i + 1]
        if until > times[-1]:
            yield float(times[-1]), until, np.zeros(2), np.zeros(2)


QUIET = Ground([0.0], [0.0])


class Impact(NamedTuple):
    """phi. before it, of the direction `side` that ends."""

    time: float
    side: int
    before: float


class Peak(NamedTuple):
    """A turning point of phi."""

    time: float
    side: int
    phi: float


@dataclass
class History:
    """What happened."""

    impacts: list[Impact] = field(default_factory=list)
    peaks: list[Peak] = field(default_factory=list)
    uplifts: list[float] = field(default_factory=list)
    switched: list[float] = field(default_factory=list)  # when a spring goes slack, or bears again
    ended: str = "time"  # or "rest", "overturned", "impacts"
    end: float = 0.0
    side: int = 1
    phi: float = 0.0
    rate: float = 0.0
    flights: list[tuple[float, float, int, Callable[[Any], Any]]] = field(default_factory=list, repr=False)

    def at(self, time: float) -> tuple[float, float]:
        """The signed rotation and its rate; zero at rest."""
        for start, end, side, solution in self.flights:
            if start <= time <= end:
                phi, rate = solution(time)
                return side * float(phi), side * float(rate)
        return 0.0, 0.0


def simulate(
    structure: Structure,
    ground: Ground = QUIET,
    *,
    release: float = 0.0,
    impacts: float = inf,
    until: float = 100.0,
) -> History:
    """Let a structure go, at rest or turned slowly by `release` (signed).

    At an impact phi. becomes eta times as fast in the other direction, eta that of the direction that ends.
    """
    motion = _Motion(structure, release)
    history = motion.history
    for start, end, first, last in ground.pieces(until):
        motion.follow(start, end, first, last, impacts)
        if history.ended != "time" or (motion.resting and end == until):
            break
    if history.ended == "time" and motion.resting:
        history.ended = "rest"
    history.end, history.side = motion.since if motion.resting else motion.t, motion.s
    history.phi, history.rate = (float(x) for x in motion.y)
    return history


class _Motion:
    def __init__(self, structure: Structure, release: float) -> None:
        self.structure, self.history = structure, History()
        self.s = -1 if release < 0 else 1
        self.t = 0.0
        self.y = np.array([abs(release), 0.0])  # phi, phi.
        self.resting, self.since = release == 0, 0.0
        self.eta = {s: structure.eta(s) for s in SIDES}
        self.mode = structure.fresh(self.s, abs(release))
        self.limit = {s: structure.limit(s) for s in SIDES}
        self.faint = FAINT * 0.1 * max(structure.terms(s, 0.0).dV for s in SIDES)

    def e(self, phi: float) -> Reals:
        return np.asarray(self.structure.elongations(self.s, np.array([phi])).real[:, 0], float)

    def follow(self, start: float, end: float, first: Reals, last: Reals, impacts: float) -> None:
        """From `start` to `end`, the ground accelerations straight in between."""
        self.ground = start, first, (last - first) / (end - start)
        self.t = start
        while self.t < end and self.history.ended == "time":
            if self.resting and not self._lifts(end):
                self.t = end
                return
            self._fly(end)
            if len(self.history.impacts) >= impacts:
                self.history.ended = "impacts"

    def _accelerations(self, t: float) -> Any:
        start, first, grade = self.ground
        return first + grade * (t - start)

    def _demand(self, s: int, t: float) -> float:
        """The force that holds the structure down in direction s."""
        mode = self.structure.settled(s)
        it = self.structure.terms(s, 0.0, mode)
        u, v = self._accelerations(t)
        return float(it.dV + v * it.G + u * it.X)

    def _lifts(self, end: float) -> bool:
        """Whether the ground lifts it before `end`; if so, sets out from there."""
        found = []
        for s in SIDES:
            now, then = self._demand(s, self.t), self._demand(s, end)
            if now < 0:
                found.append((self.t, s))
            elif then < 0:
                found.append((self.t + (end - self.t) * now / (now - then), s))
        if not found:
            return False
        self.t, self.s = min(found)
        self.y[:] = 0.0
        self.mode = self.structure.settled(self.s)
        self.resting = False
        self.history.uplifts.append(self.t)
        return True

    def slopes(self, t: float, y: Reals) -> list[float]:
        it = self.structure.terms(self.s, y[0], self.mode)
        u, v = self._accelerations(t)
        power = -(u * it.X + v * it.G)
        return [y[1], (power - it.d_inertia / 2 * y[1] ** 2 - it.dV) / it.inertia]

    def _room(self, y: Reals) -> Reals:
        """How far every spring is from going slack or taut, in numbers without dimension."""
        row = self.structure.springs
        n = self.structure.trial(self.e(y[0]))
        size = abs(row.n0) + row.k + 1e-300
        steady = (row.acts == 0) | (row.k == 0)
        return np.where(steady, inf, np.where(self.mode, 1, -1) * row.acts * n / size)

    def _switch(self) -> None:
        """A spring leaves its mode."""
        room = self._room(self.y)
        self.mode = self.mode.copy()
        for spring in np.flatnonzero(room <= room.min() + 1e-11).tolist():  # equal springs do the same
            self.mode[spring] ^= True
        self.history.switched.append(self.t)

    def _fly(self, end: float) -> None:
        """To `end`, or to the next impact, change of a spring, or fall."""

        def hits(t: float, y: Reals) -> float:
            return float(y[0])

        def falls(t: float, y: Reals) -> float:
            return float(self.limit[self.s] - y[0])

        def turns(t: float, y: Reals) -> float:
            return float(y[1])

        def switches(t: float, y: Reals) -> float:
            return float(self._room(y).min())

        stops: list[Any] = [hits, falls, turns] + ([switches] if self.structure.links else [])
        for event in stops:
            event.terminal, event.direction = event is not turns, -1
        # The first step is well within a hop: an impact within a first step would not be seen.
        pace = self.slopes(self.t, self.y)[1]
        hop = self.y[1] / -pace if pace < 0 and self.y[0] == 0 and self.y[1] > 0 else 1e-3
        first = min(0.1 * hop, 1e-3, end - self.t)
        options: Any = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16}
        solution = solve_ivp(
            self.slopes, (self.t, end), self.y, events=stops, dense_output=True, first_step=first, **options
        )
        assert solution.success, solution.message
        for t, y in zip(solution.t_events[2], solution.y_events[2], strict=True):
            if not self.history.peaks or t > self.history.peaks[-1].time + 1e-9:  # unloading starts at a peak too
                self.history.peaks.append(Peak(float(t), self.s, float(y[0])))
        which = [i for i, times in enumerate(solution.t_events) if len(times) and i != 2]
        start, self.t, self.y = self.t, float(solution.t[-1]), solution.y[:, -1]
        event = stops[which[0]] if which else None
        if event is not None:
            # A spring that has no force at rest goes slack where the structure hits the ground.
            event = hits if self.y[0] < 1e-11 and self.y[1] < 0 else event
            self._sharpen(event, float(solution.t[-2]), solution.y[:, -2], options)
        self.history.flights.append((start, self.t, self.s, solution.sol))
        if event is hits:
            self._impact()
        elif event is falls:
            self.history.ended = "overturned"
        elif event is not None:
            self._switch()

    def _sharpen(self, event: Any, before: float, y: Reals, options: Any) -> None:
        """The event by Newton's method on the integration itself; the interpolant found it to some 1e-10."""
        for _ in range(2):
            if self.t <= before:
                return
            self.y = solve_ivp(self.slopes, (before, self.t), y, **options).y[:, -1]
            step, slope = 1e-6, np.array(self.slopes(self.t, self.y))
            rate = (event(self.t, self.y + step * slope) - event(self.t, self.y - step * slope)) / (2 * step)
            miss = event(self.t, self.y) / rate if rate else 0.0
            self.t -= miss
            self.y = self.y - miss * slope

    def _impact(self) -> None:
        """The end of a direction."""
        before, s = -self.y[1], self.s
        self.s, after = -s, self.eta[s] * before
        energy = self.structure.terms(self.s, 0.0, self.mode).inertia * after**2 / 2
        self.y[:] = 0.0, after
        self.mode = self.structure.settled(self.s)
        self.history.impacts.append(Impact(self.t, s, float(before)))
        if energy < self.faint and all(self._demand(side, self.t) >= 0 for side in SIDES):
            self.resting, self.since = True, self.t
            self.y[1] = 0.0
