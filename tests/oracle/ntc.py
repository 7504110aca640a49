"""The seismic action and the capacity curve of NTC 2018 and Circolare 7/2019, written from their text.

Lengths in m, weights in kN, accelerations in m/s2, but a_g in g; angles in rad. A chain is one block on the ground, or
three that hinge on one another and on the ground; it turns clockwise for s = 1.
"""

from __future__ import annotations

from cmath import exp
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import log, pi, sqrt
from typing import Any, NamedTuple

G = 9.80665
EXCEEDED = {"SLO": 0.81, "SLD": 0.63, "SLV": 0.10, "SLC": 0.05}  # probabilities in the reference life
CLASSES = {"I": 0.7, "II": 1.0, "III": 1.5, "IV": 2.0}
FACTORS = {"LC1": 1.35, "LC2": 1.2, "LC3": 1.0}
TOPOGRAPHY = {"T1": 1.0, "T2": 1.2, "T3": 1.2, "T4": 1.4}
# Table 3.2.IV: S_S is first - second F0 ag between least and most; C_C is factor TC*^power. Then T_E of table 3.2.VII.
SOILS = {
    "A": (1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 4.5),
    "B": (1.4, 0.4, 1.0, 1.2, 1.1, -0.2, 5.0),
    "C": (1.7, 0.6, 1.0, 1.5, 1.05, -0.33, 6.0),
    "D": (2.4, 1.5, 0.9, 1.8, 1.25, -0.5, 6.0),
    "E": (2.0, 1.1, 1.0, 1.6, 1.15, -0.4, 6.0),
}
DAMPING = {"SLV": 8.0, "SLC": 10.0}  # per cent, of the secant oscillator
SHARE = {"SLV": 0.4, "SLC": 0.6}  # of d0*
PERIOD = {"SLV": 1.68, "SLC": 1.56}
ROUNDED_ROW = 0.01  # how near the return periods of a table of four rows are to those of the limit states


def solve(rises: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function that rises passes zero, by bisection."""
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if rises(middle) < 0 else (low, middle)
    return high


def eta(xi: float) -> float:
    """Return the correction for a damping in per cent [3.2.4]."""
    return max(sqrt(10 / (5 + xi)), 0.55)


@dataclass(frozen=True)
class Ground:
    """The elastic spectrum of the ground [3.2.2 to 3.2.12]."""

    ag: float
    F0: float
    TC: float
    S: float
    soil: str

    @classmethod
    def on(cls, ag: float, F0: float, TC_star: float, site: dict[str, Any]) -> Ground:
        """Return the ground on the soil of a site, from the parameters on rock."""
        first, second, least, most, factor, power, _ = SOILS[site["soil"]]
        S = min(max(first - second * F0 * ag, least), most) * TOPOGRAPHY[site.get("topography", "T1")]
        return cls(ag, F0, factor * TC_star**power * TC_star, S, site["soil"])

    @property
    def TB(self) -> float:
        return self.TC / 3

    @property
    def TD(self) -> float:
        return 4 * self.ag + 1.6

    @property
    def peak(self) -> float:
        return self.ag * self.S * G

    def S_e(self, T: float, xi: float) -> float:
        level = self.peak * eta(xi) * self.F0
        if T < self.TB:
            return self.peak * (1 + T / self.TB * (eta(xi) * self.F0 - 1))
        return level * (1 if self.TC > T else self.TC / T if self.TD > T else self.TC * self.TD / T**2)

    def S_De(self, T: float, xi: float) -> float:
        TE = SOILS[self.soil][-1]
        if TE >= T:
            return self.S_e(T, xi) * (T / (2 * pi)) ** 2
        rest = self.F0 * eta(xi)
        share = min((T - TE) / (10 - TE), 1)
        return 0.025 * self.peak * self.TC * self.TD * (rest + (1 - rest) * share)

    def start(self, own: float | None) -> float:
        """Return the acceleration that activates the mechanism at this ground."""
        return self.peak if own is None else self.S_e(own, 5)


@dataclass(frozen=True)
class Floor:
    """The spectrum at the height of a floor, by the first mode [C7.2.5 to C7.2.10, C8.7.1.12]."""

    ground: Ground
    z: float
    H: float
    n: int
    T1: float
    xi1: float

    @property
    def ag(self) -> float:
        return self.ground.ag

    @property
    def peak(self) -> float:
        gamma = 3 * self.n / (2 * self.n + 1)
        return self.ground.S_e(self.T1, 100 * self.xi1) * gamma * self.z / self.H * sqrt(1 + 4 * self.xi1**2)

    def S_eZ(self, T: float, xi: float) -> float:
        A = 1.1 * eta(xi) / sqrt(self.xi1)
        below, above = 1 - T / (0.8 * self.T1), T / (1.1 * self.T1) - 1
        off = below**1.6 if below > 0 else above**1.2 if above > 0 else 0.0
        return A * self.peak / (1 + (A - 1) * off)

    def S_De(self, T: float, xi: float) -> float:
        d = [self.S_eZ(T, xi) * (T / (2 * pi)) ** 2]
        if T > self.T1:
            d.append(self.ground.S_De(T, xi))
        if T > 1.1 * self.T1:
            d.append(self.S_eZ(self.T1, xi) * (1.1 * self.T1 / (2 * pi)) ** 2)
        return max(d)

    def start(self, own: float | None) -> float:
        if own is None:
            return self.peak
        alone = self.S_eZ(own, 5)
        return max(alone, self.ground.S_e(own, 5)) if own > self.T1 else alone


@dataclass(frozen=True)
class Site:
    """A site file."""

    given: dict[str, Any]

    @property
    def FC(self) -> float:
        FC = self.given["FC"]
        return FACTORS[FC] if isinstance(FC, str) else FC

    @property
    def life(self) -> float:
        CU = self.given.get("CU") or CLASSES[self.given["class"]]
        return max(self.given["VN"] * CU, 35)

    def period(self, state: str) -> float:
        """Return the return period of a limit state [3.2.0]."""
        return -self.life / log(1 - EXCEEDED[state])

    def row_of(self, state: str) -> list[float] | None:
        """Return the row of a table of four rows that is that of a limit state; None of any other table."""
        rows, periods = self.given["hazard"], [*map(self.period, EXCEEDED)]
        if len(rows) != 4 or any(abs(row[0] / T - 1) > ROUNDED_ROW for row, T in zip(rows, periods, strict=True)):
            return None
        return rows[[*EXCEEDED].index(state)]

    def on_rock(self, period: float) -> list[float]:
        """Return ag, F0 and TC* at a return period, by interpolation on logarithms."""
        rows = self.given["hazard"]
        k = max(1, next((k for k, row in enumerate(rows) if row[0] >= period), len(rows) - 1))
        (T_a, *a), (T_b, *b) = rows[k - 1 : k + 1]
        r = log(period / T_a) / log(T_b / T_a)
        return [low * (high / low) ** r for low, high in zip(a, b, strict=True)]

    def at(self, state: str, rock: Sequence[float] | None = None) -> Ground | Floor:
        """Return the demand at a limit state, or at what is given of the rock."""
        if rock is None and "hazard" in self.given:
            rock = (self.row_of(state) or [0, *self.on_rock(self.period(state))])[1:]
        ground = Ground.on(*(rock or (self.given[state][key] for key in ("ag", "F0", "TC_star"))), self.given)
        floor = dict(self.given.get("floor", {}))
        own = {key: floor.pop(key, {}) for key in ("SLD", "SLC")}
        return Floor(ground, **{**floor, **own.get(state, {})}) if floor else ground


def with_ag(demand: Ground | Floor, ag: float) -> Ground | Floor:
    """Return a demand with another ag on rock, and all else unchanged."""
    if isinstance(demand, Floor):
        return replace(demand, ground=replace(demand.ground, ag=ag))
    return replace(demand, ag=ag)


class Weight(NamedTuple):
    """A weight of a block: its place, what the block carries, and what it moves sideways."""

    block: int
    at: complex
    P: float
    PQ: float


@dataclass(frozen=True)
class Chain:
    """Blocks that turn, by their weights and hinges.

    Parameters
    ----------
    s : int
        1 clockwise, -1 anticlockwise.
    weights : sequence of Weight
    hinges : sequence of complex
        One on the ground; or four, of the leading block on the ground, of it and the second block, of that and the
        third, and of the third on the ground.
    blocks : sequence of int
        Number of each of these blocks.
    tie : tuple of complex, complex and float, optional
        Where a tie of constant force is fixed, where it meets the block, and its force.
    """

    s: int
    weights: Sequence[Weight]
    hinges: Sequence[complex]
    blocks: Sequence[int]
    tie: tuple[complex, complex, float] | None = None

    def moved(self, block: int, at: complex, phi: float) -> complex:
        """Return where a point of a block is at a rotation of the leading block."""
        turn = exp(-1j * self.s * phi)
        a = self.hinges[0]
        if block == self.blocks[0]:
            return a + (at - a) * turn
        _, b, c, d = self.hinges
        b1 = a + (b - a) * turn
        # The two bars from b1 and from d meet on the side on which they meet at rest.
        span, one, other = d - b1, abs(c - b), abs(c - d)
        along = (one**2 - other**2 + abs(span) ** 2) / (2 * abs(span))
        side = 1 if ((c - b) / (d - b)).imag > 0 else -1
        c1 = b1 + span / abs(span) * complex(along, side * sqrt(one**2 - along**2))
        if block == self.blocks[1]:
            return b1 + (at - b) * (c1 - b1) / (c - b)
        return d + (at - d) * (c1 - d) / (c - d)

    def rate(self, block: int, at: complex, phi: float, step: float = 1e-5) -> complex:
        """Return the virtual displacement of a point, towards the side to which the chain turns, and up."""
        rate = (self.moved(block, at, phi + step) - self.moved(block, at, phi - step)) / (2 * step)
        return complex(self.s * rate.real, rate.imag)

    def alpha(self, phi: float) -> float:
        """Return the multiplier by virtual work [C8.7.1.1]."""
        rates = [self.rate(each.block, each.at, phi) for each in self.weights]
        work = sum(each.P * rate.imag for each, rate in zip(self.weights, rates, strict=True))
        if self.tie:
            fixed, at, force = self.tie
            step = 1e-5
            longer, shorter = (abs(self.moved(1, at, phi + end) - fixed) for end in (step, -step))
            work += force * (longer - shorter) / (2 * step)
        return work / sum(each.PQ * rate.real for each, rate in zip(self.weights, rates, strict=True))

    @property
    def sums(self) -> tuple[float, float, float]:
        """The sums of P + Q, of their work at rest, and of that squared over each weight."""
        PQ, first, second = 0.0, 0.0, 0.0
        for block in {each.block for each in self.weights}:
            own = [each for each in self.weights if each.block == block]
            weight = sum(each.PQ for each in own)
            work = sum(each.PQ * self.rate(block, each.at, 0.0).real for each in own)
            PQ, first, second = PQ + weight, first + work, second + work**2 / weight
        return PQ, first, second

    @property
    def e_star(self) -> float:
        PQ, first, second = self.sums
        return first**2 / (PQ * second)

    def d(self, phi: float) -> float:
        """Return the displacement of the barycentre of all P + Q, over e* [C8.7.1.4]."""
        moved = sum(each.PQ * (self.moved(each.block, each.at, phi) - each.at).real for each in self.weights)
        return self.s * moved / self.sums[0] / self.e_star

    @property
    def end(self) -> float:
        """The rotation at which the multiplier vanishes."""
        step = 0.01
        phi = next(k * step for k in range(1, 200) if self.alpha(k * step) < 0)
        return solve(lambda each: -self.alpha(each), phi - step, phi)

    def turned(self, block: int) -> float:
        """Return the virtual rotation of a block at rest, clockwise for s = 1."""
        rate = self.rate(block, 1j, 0.0) - self.rate(block, 0j, 0.0)
        return rate.real
