"""Forty assemblies, the same everywhere, by the engine of one degree of freedom and by that of free blocks."""

from __future__ import annotations

from cmath import exp
from contextlib import suppress
from itertools import pairwise
from math import pi
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import numpy as np

from rocking_cli import GroundMotion, Registry, parse_pulse, read_record
from rocking_cli.dynamics.batch import Runs
from rocking_cli.errors import StructureError
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import engine_of
from rocking_cli.studies.neighbours import Neighbourhood, simulate_neighbours

ACCEL = Path(__file__).resolve().parents[1] / "examples" / "accel.csv"
SEED = 60
KINDS = ("portal", "rider", "stack", "arch", "buttressed")
LEVELS = (1.25, 1.2, 1.4, 1.6, 1.7, 2.2, 2.6, 4.5)  # peak acceleration over that of uplift
GROUND = 0.5  # m

# Free blocks differ from one degree of freedom by less than neighbours in a prediction do.
NEAR = Neighbourhood(100, amplitude=0.01, restitution=0.01, slenderness=0.0)
CHAOTIC = (0.05, 0.95)  # share of neighbours that overturn, between which an outcome is chance
CLOSE = 0.05  # of a peak

Polygon = list[complex]


class Case(NamedTuple):
    """An assembly and a motion."""

    name: str
    structure: Structure
    motion: GroundMotion


class _Dice:
    """Numbers that are the same with every version of Python and numpy, and that a file would have."""

    def __init__(self, *seed: object) -> None:
        self._random = Random(" ".join(map(str, seed)))

    def between(self, low: float, high: float) -> float:
        return round(low + (high - low) * self._random.random(), 3)

    def count(self, low: int, high: int) -> int:
        return low + int((high - low + 1) * self._random.random())


def box(left: float, right: float, low: float, high: float) -> Polygon:
    """Corners of a rectangle."""
    return [complex(left, low), complex(right, low), complex(right, high), complex(left, high)]


def ring(radius: float, thickness: float, count: int, opening: float) -> dict[str, Polygon]:
    """Voussoirs of a circular arch about 0, from the left; `opening` is the angle between its springings."""
    cuts = [exp(1j * (pi / 2 + opening * (0.5 - k / count))) for k in range(count + 1)]
    inner, outer = radius - thickness / 2, radius + thickness / 2
    return {
        f"v{k + 1}": [inner * one, inner * other, outer * other, outer * one]
        for k, (one, other) in enumerate(pairwise(cuts))
    }


def portal(dice: _Dice) -> dict[str, Polygon]:
    """Two piers, of one block or of two, and a lintel."""
    height, span, left, right = dice.between(2, 4), dice.between(1, 2.5), dice.between(0.7, 1.1), dice.between(0.7, 1.1)
    far = left + span + right
    cuts = [0, dice.between(0.4, 0.6) * height, height] if dice.count(0, 1) else [0, height]
    blocks = {}
    for k, (low, high) in enumerate(pairwise(cuts)):
        blocks |= {f"L{k}": box(0, left, low, high), f"R{k}": box(far - right, far, low, high)}
    over = dice.between(0.05, 0.2)
    return blocks | {"lintel": box(-over, far + over, height, height + dice.between(0.4, 0.7))}


def rider(dice: _Dice) -> dict[str, Polygon]:
    """A portal with a block on its lintel."""
    blocks = portal(dice)
    start, end = blocks["lintel"][3].real, blocks["lintel"][2].real
    left, top = start + dice.between(0.3, 0.5) * (end - start), blocks["lintel"][2].imag
    return blocks | {"rider": box(left, left + dice.between(0.5, 0.9), top, top + dice.between(0.3, 0.8))}


def stack(dice: _Dice) -> dict[str, Polygon]:
    """Blocks on each other, ever narrower and not quite above each other."""
    low, width, blocks = 0.0, dice.between(0.7, 1.1), dict[str, Polygon]()
    for k in range(dice.count(2, 4)):
        middle, high = dice.between(-0.04, 0.04) * (k > 0), low + dice.between(0.8, 1.8)
        blocks[f"s{k}"] = box(middle - width / 2, middle + width / 2, low, high)
        low, width = high, width * dice.between(0.8, 0.95)
    return blocks


def arch(dice: _Dice) -> dict[str, Polygon]:
    """An arch on the ground."""
    radius = dice.between(2, 5)
    return ring(radius, radius * dice.between(0.15, 0.22), dice.count(5, 9), dice.between(2.5, 2.8))


def buttressed(dice: _Dice) -> dict[str, Polygon]:
    """Half a circle on two buttresses."""
    radius, width, high = dice.between(2, 3), dice.between(1.2, 1.7), dice.between(1.5, 2.2)
    thickness = radius * dice.between(0.17, 0.23)
    voussoirs = ring(radius, thickness, dice.count(5, 8), pi)
    inner = radius - thickness / 2 - dice.between(0.0, 0.1)
    return {
        "left": box(-inner - width, -inner, 0, high),
        "right": box(inner, inner + width, 0, high),
        **{name: [z + 1j * high for z in corners] for name, corners in voussoirs.items()},
    }


def below(one: complex, other: complex) -> Polygon:
    """Corners of the ground on the right of a line."""
    deep = -1j * GROUND * (other - one) / abs(other - one)
    return [one, one + deep, other + deep, other]


def assembly(kind: str, dice: _Dice) -> dict[str, Any]:
    """Fields of an assembly."""
    blocks = globals()[kind](dice)
    if kind == "arch":
        first, last = blocks["v1"], [*blocks.values()][-1]
        ground = {"left": below(first[3], first[0]), "right": below(last[1], last[2])}
    else:
        edges = [z.real for corners in blocks.values() for z in corners]
        ground = {"floor": box(min(edges) - 3, max(edges) + 3, -GROUND, 0)}
    return {
        "density": 2000 + 100 * dice.count(0, 5), "depth": 1.0,
        "friction": dice.between(0.55, 0.85), "blocks": _written(blocks), "ground": _written(ground),
    }  # fmt: skip


def _written(polygons: dict[str, Polygon]) -> dict[str, Any]:
    return {
        name: {"polygon": [[round(z.real, 4), round(z.imag, 4)] for z in corners]} for name, corners in polygons.items()
    }


def case(kind: str, number: int) -> Case:
    """Return an assembly that rocks before it slides, with its motion."""
    dice = _Dice(SEED, kind, number)
    while True:
        made = Structure(Registry()["assembly"](name=f"{kind} {number}", **assembly(kind, dice)))
        with suppress(StructureError):
            lam = min(made.model("nonlinear").lambda_)
            break
    if number % 2:
        motion = read_record(ACCEL)
    else:
        shape = ("sine", "cosine")[number // 2 % 2]
        motion = parse_pulse(f"{shape}:1g:{dice.between(0.5, 1.2)}s").sampled()
    level = LEVELS[number - 1] * dice.between(0.95, 1.05)
    return Case(
        made.name, made, motion.scaled(level * lam * made.mechanism.gravity / np.abs(motion.acceleration).max())
    )


def forty() -> list[Case]:
    """Eight assemblies of each kind, from uplift to collapse."""
    return [case(kind, number) for kind in KINDS for number in range(1, 9)]


class Pair(NamedTuple):
    """The outcome of a case by both engines.

    Parameters
    ----------
    name : str
        The case.
    exact, free : bool or None
        Whether it overturns by one degree of freedom, and as free blocks; None if unknown.
    share : float
        Share of the neighbours of known outcome, by one degree of freedom, that overturns.
    peak, free_peak : float
        Largest rotation by one degree of freedom, and as free blocks [rad].
    range : (float, float)
        Smallest and largest of these rotations of the neighbours that are known not to overturn [rad].
    """

    name: str
    exact: bool | None
    free: bool | None
    share: float
    peak: float
    free_peak: float
    range: tuple[float, float]

    @property
    def known(self) -> bool:
        """Whether one degree of freedom knows the outcome."""
        return self.exact is not None

    @property
    def chaotic(self) -> bool:
        """Whether neighbours disagree on the outcome."""
        return CHAOTIC[0] < self.share < CHAOTIC[1]

    @property
    def stands(self) -> bool:
        """Whether it does not overturn by either engine, so that there are two peaks."""
        return self.exact is False and self.free is False

    @property
    def close(self) -> bool:
        """Whether both peaks are close."""
        return abs(self.free_peak - self.peak) <= CLOSE * self.peak

    @property
    def agree(self) -> bool:
        """Whether both peaks are close, or that of free blocks is among those of neighbours."""
        return self.close or self.range[0] <= self.free_peak <= self.range[1]


def side_by_side(cases: list[Case], threads: int) -> list[Pair]:
    """Simulate cases by both engines, free blocks in so many processes."""
    structures = [each.structure for each in cases]
    models = [structure.model("nonlinear") for structure in structures]
    motions = [each.motion for each in cases]
    runs = Runs.of(range(len(cases)), range(len(cases)))
    exact = engine_of("exact").outcomes(models, motions, runs)
    free = engine_of("blocks", [each.mechanism for each in structures]).outcomes(models, motions, runs, threads=threads)
    pairs = []
    for k, each in enumerate(cases):
        near = simulate_neighbours(models[k], motions[k], NEAR.drawn(models[k]))
        known, peaks = ~near.unknown, np.fmax(near.peak_positive, near.peak_negative)
        stand = peaks[known & ~near.fell]
        pairs.append(
            Pair(
                each.name,
                *(None if found.unknown[k] else bool(found.fell[k]) for found in (exact, free)),
                near.fell[known].mean() if known.any() else np.nan,
                *(float(np.fmax(found.peak_positive[k], found.peak_negative[k])) for found in (exact, free)),
                (float(stand.min(initial=np.inf)), float(stand.max(initial=-np.inf))),
            )
        )
    return pairs


class Agreement(NamedTuple):
    """On how many cases both engines agree.

    Parameters
    ----------
    cases, known : int
        All cases, and those whose outcome one degree of freedom knows.
    sure, outcomes : int
        Of these, those of which neighbours agree on the outcome, and those of them in which free blocks have it too.
    peaks, near, close : int
        Known cases that overturn by neither engine, those whose peaks agree, and those whose peaks are close.
    stand, collapse, failed : int
        Of the others, those that stand, collapse, and could not be simulated as free blocks.
    """

    cases: int
    known: int
    sure: int
    outcomes: int
    peaks: int
    near: int
    close: int
    stand: int
    collapse: int
    failed: int


def agreement(pairs: list[Pair]) -> Agreement:
    """Count on what both engines agree."""
    known = [pair for pair in pairs if pair.known]
    sure = [pair for pair in known if not pair.chaotic]
    peaks = [pair for pair in known if pair.stands]
    others = [pair.free for pair in pairs if not pair.known]
    return Agreement(
        len(pairs), len(known), len(sure), sum(pair.free == pair.exact for pair in sure), len(peaks),
        sum(pair.agree for pair in peaks), sum(pair.close for pair in peaks), others.count(False), others.count(True),
        others.count(None),
    )  # fmt: skip
