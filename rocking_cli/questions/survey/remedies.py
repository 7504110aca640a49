"""What to do about an object that may fall, as numbers: each remedy is tried under the same motions and neighbours."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import exp, floor, hypot, inf
from statistics import NormalDist

import numpy as np

from rocking_cli.dynamics.model import scatter_of
from rocking_cli.errors import RockingError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.processing.oscillator import peak_displacement
from rocking_cli.questions.margin.study import margin
from rocking_cli.questions.survey.inventory import ListedObject
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Conditions, Neighbourhood, simulate_neighbours

SAFE_SHARE = 0.05  # of the neighbours, which may overturn all the same
QUANTILE = NormalDist().inv_cdf(1 - SAFE_SHARE)
WIDENINGS = np.geomspace(0.02, 1.0, 18)  # of the base, over its smaller side
BALLASTS = np.geomspace(0.1, 1.0, 10)  # over the mass of the object
WIRE_HEIGHT = 2 / 3  # over the height of the object, if no height is given
OF_SLENDER = 0.8  # friction at which it slides, over b/h, below which it does not rock
LEAST_FRICTION = 0.05  # of what can be put below an object: PTFE on polished steel
PERIODS, ISOLATOR_DAMPING = (2.0, 2.5, 3.0, 4.0), 0.15  # s, of isolators that are tried
ROOM = ("edge", "gap")  # sizes by which a base, a slip or a stroke is limited
BENDS_FROM = 4.0  # height over foot from which a body that cracks is not held at its top


@dataclass(frozen=True)
class Remedy:
    """Something that may keep an object from falling.

    Parameters
    ----------
    kind : str
        "base", "ballast", "wires", "wax", "slide", "isolate"; "below" if it stands where what is below does, or "none"
        if nothing that was tried suffices.
    suffices : bool or None
        Whether at most 5 % of the neighbours of every motion overturn it; None if that depends on what is not given.
    numbers : mapping of str to float
        Its numbers: lengths in m, masses in kg, forces in N, areas in m2, periods in s.
    against : bool
        Whether it does harm: a slender body of stone that is held at its top bends, and may crack.
    """

    kind: str
    suffices: bool | None
    numbers: Mapping[str, float] = field(default_factory=dict)
    against: bool = False


@dataclass(frozen=True)
class _Trial:
    """An object under the motions of the ground, as remedies are tried on it."""

    item: ListedObject
    motions: Sequence[GroundMotion]
    polarities: Sequence[int]
    around: Neighbourhood
    room: float

    @property
    def may_be_held(self) -> bool:
        """Whether wires and wax are judged by the peak of what it stands on: not on isolators, nor if that lifts it."""
        return "period" not in self.item.sizes and all(each.vertical is None for each in self.motions)

    def conditions(self, item: ListedObject) -> Conditions:
        made = item.make()
        return Conditions(
            Structure(made.weaker_side() or made), ["nonlinear"], self.polarities, around=self.around
        )  # fmt: skip

    def share(self, item: ListedObject) -> float:
        """Return the largest share of neighbours that may overturn an object, of all motions; 1 if none is known."""
        try:
            conditions, worst = self.conditions(item), 0.0
            for motion in item.under(self.motions):
                limits = item.limits(motion)
                shares = margin(conditions, motion, factors=np.ones(1), limits=limits, threads=1)
                worst = max(worst, shares.share.highest)
                if worst > SAFE_SHARE:
                    break
        except RockingError:
            return 1.0
        return worst

    def least(self, changed: Callable[[float], ListedObject], values: Sequence[float]) -> float | None:
        """Return the least of some values with which it stands, as it does with the next one; None without one.

        Values are halved as if each that is larger than one that suffices did so too.
        """
        stands: list[bool | None] = [None] * len(values)

        def suffices(k: int) -> bool:
            if stands[k] is None:
                stands[k] = self.share(changed(values[k])) <= SAFE_SHARE
            return bool(stands[k])

        k = bisect_left(range(max(len(values) - 1, 0)), True, key=suffices)
        return values[k] if k < len(values) - 1 and suffices(k + 1) else None

    @property
    def strong(self) -> float:
        """The peak acceleration of what it stands on that 5 % of its neighbours exceed [standard gravity]."""
        usual = scatter_of(self.item.make()).slenderness
        spread = hypot(self.around.amplitude, usual if self.around.slenderness is None else self.around.slenderness)
        return exp(QUANTILE * spread) * max(each.pga_g for each in self.item.under(self.motions))


def remedies(
    item: ListedObject, motions: Sequence[GroundMotion], polarities: Sequence[int], around: Neighbourhood
) -> Iterator[Remedy]:
    """Yield remedies of an object in the order in which they are tried; the last is "none" if none of them suffices.

    Parameters
    ----------
    item : ListedObject
        The object, which is tried alone on what it stands on, if that is another object.
    motions : sequence of GroundMotion
        The ground motions.
    polarities : sequence of int
        Their polarities.
    around : Neighbourhood
        The neighbours.
    """
    room = min(item.sizes.get(key, inf) for key in ROOM)
    if item.on:
        (_, foot), (top, _) = min(
            ((item.widths(turned=turned), item.chain[-2].widths(turned=turned)) for turned in (False, True)),
            key=lambda each: each[1][0] - each[0][1],
        )
        room = min(room, (top - foot) / 2)
    trial = _Trial(item.alone(), motions, polarities, around, max(room, 0.0))
    any_suffices = bool(item.on) and trial.share(trial.item) <= SAFE_SHARE
    if any_suffices:
        yield Remedy("below", suffices=True)
        return
    for attempt in (_base, _ballast, _wires, _wax, _slide, _isolate):
        remedy = attempt(trial)
        if remedy is not None:
            any_suffices |= bool(remedy.suffices) and not remedy.against
            yield remedy
    if not any_suffices:
        yield Remedy("none", suffices=False)


def _with(item: ListedObject, **sizes: float) -> ListedObject:
    return replace(item, sizes={**item.sizes, **sizes})


def _widened(item: ListedObject, by: float) -> ListedObject:
    (_, foot), (_, deep) = (item.widths(turned=turned) for turned in (False, True))
    less = {key: item.sizes[key] - by / 2 for key in ROOM if key in item.sizes}
    wider = {"foot": foot + by} if item.is_round else {"foot": foot + by, "foot_depth": deep + by}
    return _with(item, **wider, **{key: max(each, 1e-6) for key, each in less.items()})


def _base(trial: _Trial) -> Remedy | None:
    """Return by how much a wider base makes it stand, the same to all sides."""
    item = trial.item
    values = WIDENINGS * item.least_foot
    by = trial.least(partial(_widened, item), values[values <= 2 * trial.room].tolist())
    return None if by is None else Remedy("base", suffices=True, numbers={"wider": by})


def _ballast(trial: _Trial) -> Remedy | None:
    """Return how much sand or weight in its foot makes it stand; None if it is not hollow."""
    item = trial.item
    if not item.is_hollow or item.mass is None:
        return None
    ballast = trial.least(lambda mass: replace(item, ballast=mass), (BALLASTS * item.mass).tolist())
    return None if ballast is None else Remedy("ballast", suffices=True, numbers={"mass": ballast})


def _bends(item: ListedObject) -> bool:
    return item.cracks and item.height / item.least_foot >= BENDS_FROM


def _wires(trial: _Trial) -> Remedy | None:
    """Return the horizontal force of wires that keep it from lifting and sliding: m a h_c = m g b/2 + F z."""
    item = trial.item
    if item.mass is None or not trial.may_be_held:
        return None
    mass, centre = item.whole
    height = item.sizes.get("wire_height", WIRE_HEIGHT * item.height)
    turning = (trial.strong * centre - item.least_foot / 2) / height
    if turning <= 0:  # it falls without lifting, such as over an edge
        return None
    force = mass * STANDARD_GRAVITY * max(turning, trial.strong - item.sizes.get("friction", inf))
    return Remedy("wires", suffices=True, numbers={"force": force, "height": height}, against=_bends(item))


def _wax(trial: _Trial) -> Remedy | None:
    """Return pull and shear of wax below the middle of its foot that keep it from moving, and the area if known."""
    item, sizes = trial.item, trial.item.sizes
    if item.mass is None or not trial.may_be_held:
        return None
    mass, centre = item.whole
    weight = mass * STANDARD_GRAVITY
    pull = max(weight * (2 * trial.strong * centre / item.least_foot - 1), 0.0)
    numbers = {"pull": pull, "shear": weight * trial.strong}
    strength = [sizes.get("wax_tension"), sizes.get("wax_shear")]
    if strength[0] is None or strength[1] is None:
        return Remedy("wax", suffices=None, numbers=numbers, against=_bends(item))
    area = max(pull / strength[0], numbers["shear"] / strength[1])
    return Remedy("wax", suffices=area <= item.foot_area, numbers={**numbers, "area": area}, against=_bends(item))


def _slide(trial: _Trial) -> Remedy | None:
    """Return a friction below which it slides instead, and how far, which 5 % of its neighbours exceed."""
    item = trial.item
    centre = item.whole[1] if item.mass is not None else item.centre
    friction = min(item.sizes.get("friction", inf), floor(100 * OF_SLENDER * item.least_foot / (2 * centre)) / 100)
    if friction < LEAST_FRICTION or "period" in item.sizes:
        return None
    sliding = _with(item, friction=friction)
    if trial.share(sliding) > SAFE_SHARE:
        return None
    slip = clearance(trial.conditions(sliding), sliding.under(trial.motions))
    return Remedy("slide", suffices=slip < trial.room, numbers={"friction": friction, "clearance": slip})


def clearance(conditions: Conditions, motions: Sequence[GroundMotion]) -> float:
    """Return the slip that one in twenty neighbours of a motion exceeds, the largest of some motions [m]."""
    draws, slips = conditions.around.drawn(conditions.model), [0.0]
    for motion in motions:
        outcomes = simulate_neighbours(conditions.model, motion, draws, threads=1)
        slips.append(float(np.quantile(outcomes.slip, 1 - SAFE_SHARE)))
    return max(slips)


def _isolate(trial: _Trial) -> Remedy | None:
    """Return the period of an isolator on which it stands, and the stroke that 5 % of its neighbours exceed."""
    for period in PERIODS:
        isolated = _with(trial.item, period=period, damping=ISOLATOR_DAMPING, stroke=inf)
        isolated = replace(isolated, sizes={key: each for key, each in isolated.sizes.items() if key not in ROOM})
        if trial.share(isolated) <= SAFE_SHARE:
            below = trial.item.under(trial.motions)
            stroke = max(peak_displacement(each, period, ISOLATOR_DAMPING) for each in below)
            stroke *= exp(QUANTILE * trial.around.amplitude)
            if stroke >= trial.room:
                return None
            return Remedy("isolate", suffices=True, numbers={"period": period, "stroke": stroke})
    return None
