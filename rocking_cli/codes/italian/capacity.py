"""Capacity curves: acceleration over displacement of the equivalent oscillator; and the chain displaced along them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from math import inf, nan, pi, sqrt
from operator import attrgetter

import numpy as np
from pydantic import ValidationError

from rocking_cli.codes.italian.chain import Chain, ChainBlock
from rocking_cli.codes.italian.rules import Rule
from rocking_cli.core import Mechanism
from rocking_cli.core.coefficients import Coefficients, NoCriticalRotation
from rocking_cli.core.hung.attached import Follow, Spot
from rocking_cli.core.hung.element import INTERLOCK_NAME as INTERLOCK
from rocking_cli.core.hung.element import ConstantForce, Element, Spring
from rocking_cli.core.hung.ties import Tie, TieStrength
from rocking_cli.core.kinematics import Reals
from rocking_cli.errors import InputError, Problem, StructureError
from rocking_cli.short_repr import short_repr
from rocking_cli.verification.results import Control

STEPS_PER_CURVE = 256  # a curve is checked to be a function at these points only
MAX_HALVINGS = 200
BESIDE = 1e-3  # share of an interval by which points stand beside the zero of its chord
PARTS = 16  # into which an interval is divided, where many points cost little more than one
SHARE, BREAK, SEAT = "share", "break", "seat"
"""What may end the displacement capacity: the share of d0*, a break of the curve, or a lost seat."""


def root(rises: Callable[[float], float], low: float, high: float) -> float:
    """Return the zero of a function that is negative at `low` and positive at `high`, to rounding.

    Of three points one halves the interval, and the others stand a little on either side of where the chord is zero.
    """
    below = above = nan
    for k in range(3 * MAX_HALVINGS):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        side = (0.0, BESIDE, -BESIDE)[k % 3]
        chord = low + (high - low) * (below / (below - above) + side) if side and below < above else nan
        middle = chord if low < chord < high else middle
        if (value := rises(middle)) < 0:
            low, below = middle, value
        else:
            high, above = middle, value
    return high


def reached(way: Callable[[Reals], Reals], length: float, low: float, high: float) -> float:
    """Return where a way, shorter at `low` and not at `high`, has a length, to rounding; it takes an array."""
    for _ in range(MAX_HALVINGS):
        if not low < (low + high) / 2 < high:
            break
        points = np.linspace(low, high, PARTS + 1)
        k = 1 + int(np.append(way(points[1:-1]) >= length, True).argmax())
        low, high = float(points[k - 1]), float(points[k])
    return high


@dataclass(frozen=True)
class Seat:
    """Loss of a seat: name of the load, length of the seat [m], and displacement d at which the load leaves it [m]."""

    load: str
    length: float
    d: float


@dataclass(frozen=True, order=True)
class Break:
    """End of a tie or of crossing walls: rotation [rad], name, and the elongation or slip at which it ends [m]."""

    phi: float
    name: str
    length: float


def against(chain: Chain) -> Sequence[str]:
    """Return the names of the forces against the motion, which may stand for ties."""
    loads, s = {load.name for load in chain.mechanism.loads or []}, chain.direction
    forces = [each for each in chain.mechanism.hung.elements if isinstance(each, ConstantForce) and each.name in loads]
    return [each.name for each in forces if s * each.in_direction(s).real < 0]


@short_repr
@dataclass(frozen=True, eq=False)
class ExactCurve:
    """Capacity curve a*(d) computed from the exact motion of the mechanism.

    Parameters
    ----------
    chain : Chain
        The moving blocks of the mechanism.
    control : Control
        The control point.
    confidence : float
        Confidence factor FC, by which accelerations are divided.
    """

    chain: Chain
    control: Control
    confidence: float

    @cached_property
    def breaks(self) -> Sequence[Break]:
        """What ends on the way to the kinematic limit: ties, and the overlap of the courses of crossing walls."""
        mechanism, breaks = self.chain.mechanism, list[Break]()
        known = {tie.name: tie.known_elongation for tie in mechanism.ties or []}
        if mechanism.interlock is not None:
            known[INTERLOCK] = mechanism.interlock.overlap
        for each in mechanism.hung.elements:
            if most := known.get(each.name):
                way = partial(self.slid, each.spot) if isinstance(each, ConstantForce) else partial(self._longer, each)
                phi = self._reached(way, most, mechanism.limit(self.chain.direction))
                breaks += [] if phi is None else [Break(phi, each.name, most)]
        return sorted(breaks)

    def slid(self, spot: Spot, phi: Reals) -> Reals:
        """Return the sideways displacement of a point, in either sense, at rotations, shape (n,) [m]."""
        path = self.chain.mechanism.followed(phi, self.chain.direction)(spot).z
        return np.asarray(np.abs((path - spot.at).real))

    def _longer(self, tie: Element, phi: Reals) -> Reals:
        return tie.elongation(self.chain.mechanism.followed(phi, self.chain.direction))[0]

    def _reached(self, way: Callable[[Reals], Reals], length: float, end: float) -> float | None:
        """Return the first rotation below an end at which a way has a length; None if there is none."""
        phi = np.linspace(0.0, end, STEPS_PER_CURVE + 1)[:-1]
        k = int((way(phi) >= length).argmax())
        return reached(way, length, phi[k - 1], phi[k]) if k else None

    @cached_property
    def _held(self) -> dict[Collection[str], Mechanism]:
        """The structure without what has ended so far, by names."""
        return {frozenset(): self.chain.mechanism}

    def without(self, gone: Collection[str]) -> Mechanism:
        """Return the structure without some of its ties, forces and crossing walls, by their names."""
        names, mechanism = frozenset(gone), self.chain.mechanism
        if names not in self._held:
            kept = {key: [each for each in getattr(mechanism, key) or [] if each.name not in names] or None
                    for key in ("loads", "ties")}  # fmt: skip
            interlock = None if INTERLOCK in names else mechanism.interlock
            self._held[names] = mechanism.model_copy(update={**kept, "interlock": interlock})
        return self._held[names]

    def standing(self, phi: float, *, after: bool = False) -> Mechanism:
        """Return the structure with what still restrains it at a rotation; where something ends before it, or `after`.

        At the end of the curve, it is the structure with what holds up to collapse.
        """
        if phi == self.end and not after:
            return self.without(self._last[1])
        return self.without({each.name for each in self.breaks if each.phi < phi or (after and each.phi == phi)})

    @property
    def lost(self) -> Sequence[Break]:
        """What ends before a* vanishes with it, so that d0* is that of the curve without it."""
        return [each for each in self.breaks if each.name in self._last[1] or each.phi == self.end]

    @property
    def let_go(self) -> Sequence[str]:
        """Names of ties and forces that never end, with which a* would not vanish, so that d0* is that without them."""
        return sorted(self._last[1] - {each.name for each in self.breaks})

    @property
    def end(self) -> float:
        """First rotation at which a* vanishes [rad], which ends the curve. Raises `InputError` if there is none."""
        return self._last[0]

    @cached_property
    def _last(self) -> tuple[float, set[str]]:
        """The end of the curve [rad], and the names of what does not hold up to there."""
        gone = set[str]()
        end = self._vanishes(gone)
        while more := {each.name for each in self.breaks if each.phi < end} - gone:
            gone |= more
            end = self._vanishes(gone)
        if end == inf:
            gone |= {*against(self.chain), *(tie.name for tie in self.chain.mechanism.ties or [])}
            end = self._vanishes(gone)
        if end == 0 and self.breaks:  # it does not stand without what ends first
            end, gone = self.breaks[0].phi, set()
        if not 0 < end < inf:
            raise InputError(
                Problem(
                    f"in the {self.chain.direction.label} direction, a* does not vanish before the kinematic limit: "
                    "the restraints would hold the structure at any displacement",
                    field="ties" if self.chain.mechanism.ties else "loads",
                    hint="the code counts only restraints that act up to collapse: leave out the others",
                )
            )
        self._hold_to_a_function(end)
        return end, gone

    @property
    def is_endless(self) -> bool:
        """Whether a* does not vanish before the kinematic limit if no tie ends."""
        return self._vanishes({INTERLOCK}) == inf

    def _vanishes(self, gone: Collection[str]) -> float:
        """Return the rotation at which a* vanishes without something [rad]: infinite if nowhere, 0 if at rest."""
        try:
            mechanism = self.without(gone)
            if not mechanism.coefficients(np.zeros(1), self.chain.direction).restoring(mechanism.gravity)[0] > 0:
                return 0.0
            return mechanism.critical_rotation(self.chain.direction)
        except ValidationError:  # it is refused, as it does not stand
            return 0.0
        except NoCriticalRotation:
            if not mechanism.attached:
                raise
            return inf

    def _hold_to_a_function(self, end: float) -> None:
        phi = np.linspace(0.0, end, STEPS_PER_CURVE + 1)
        drives = self.chain.mechanism.coefficients(phi, self.chain.direction).B
        moves = np.diff(self.chain.displacement(phi, self.control))
        if not ((drives > 0).all() and (moves > 0).all()):
            raise StructureError(
                f"in the {self.chain.direction.label} direction, the displacement of the control point does not "
                "increase up to the critical rotation, so it cannot serve as the abscissa of a capacity curve; "
                "choose another control point"
            )

    def accelerations(self, phi: Reals, standing: Mechanism | None = None) -> Reals:
        """Return a* at rotations, shape (n,) [m/s2], of what is `standing` there; at a break the value before it."""
        if standing is None:
            values, gone = np.empty_like(phi), np.searchsorted([each.phi for each in self.breaks], phi)
            stretches = np.where(phi == self.end, -1, gone)
            for stretch in np.unique(stretches):
                inside = stretches == stretch
                values[inside] = self.accelerations(phi[inside], self.standing(phi[inside][0]))
            return values
        here = standing.coefficients(phi, self.chain.direction)
        alpha = here.restoring(standing.gravity) / (here.B + self.chain.added(phi))
        return np.asarray(alpha * standing.gravity / (self.chain.e_star * self.confidence))

    def acceleration_at(self, phi: float, standing: Mechanism | None = None) -> float:
        """Return a* at a rotation [m/s2], see `accelerations`."""
        return float(self.accelerations(np.array([phi]), standing)[0])

    def displacement_at(self, phi: float) -> float:
        """Return d at a rotation [m]."""
        return float(self.chain.displacement(np.array([phi]), self.control)[0])

    def rotation(self, d: float) -> float:
        """Return the rotation at a displacement on the curve [rad]."""
        if d not in self._rotations:
            self._rotations[d] = reached(lambda phi: self.chain.displacement(phi, self.control), d, 0.0, self.end)
        return self._rotations[d]

    @cached_property
    def _rotations(self) -> dict[float, float]:
        """Rotations computed so far, by displacement, as all views need the same few; at first rest and each break."""
        return {0.0: 0.0, **{self.displacement_at(each.phi): each.phi for each in self._reached_breaks}}

    @property
    def _reached_breaks(self) -> Sequence[Break]:
        return [each for each in self.breaks if each.phi < self.end]

    @cached_property
    def a0(self) -> float:
        """a* at rest [m/s2]."""
        return self.chain.alpha0 * self.chain.mechanism.gravity / (self.chain.e_star * self.confidence)

    @cached_property
    def d0(self) -> float:
        """Displacement d0* at which a* vanishes [m]."""
        return self.displacement_at(self.end)

    def acceleration(self, d: float) -> float:
        """Return a* at a displacement [m/s2]; at the displacement of a break the value before it."""
        return self.acceleration_at(self.rotation(d))

    @cached_property
    def largest(self) -> float:
        """The largest a* of the curve [m/s2]."""
        # A curve that rises up to a break has its maximum there.
        places = [*np.linspace(0.0, self.end, STEPS_PER_CURVE // 4 + 1), *(each.phi for each in self._reached_breaks)]
        return max(self.a0, float(self.accelerations(np.array(places)).max()))

    @cached_property
    def last_break(self) -> Break | None:
        """The break with which those so far take more than half of the largest a*; None if they do not."""
        for each in self._reached_breaks:
            whole, left = self.chain.mechanism, self.standing(each.phi, after=True)
            if self.acceleration_at(each.phi, whole) - self.acceleration_at(each.phi, left) > self.largest / 2:
                return each
        return None

    @property
    def broken(self) -> float | None:
        """Displacement at the last break [m]."""
        return None if self.last_break is None else self.displacement_at(self.last_break.phi)

    @cached_property
    def seat(self) -> Seat | None:
        """The first load that moves off its seat before the end of the curve; None if none does."""
        spots, lost = {mass.name: mass.spot for mass in self.chain.mechanism.hung.masses}, list[Seat]()
        for load in self.chain.mechanism.loads or []:
            if load.seat is not None:
                at = self._reached(partial(self.slid, spots[load.name]), load.seat, self.end)
                lost += [] if at is None else [Seat(load.name, load.seat, self.displacement_at(at))]
        return min(lost, key=attrgetter("d"), default=None)

    def points(self, count: int = 65) -> tuple[Reals, Reals]:
        """Return points of the curve: displacements [m] and accelerations [m/s2], shape (n,) each."""
        phi = np.linspace(0.0, self.end, count)
        return self.chain.displacement(phi, self.control), self.accelerations(phi)


@short_repr
@dataclass(frozen=True)
class StraightCurve:
    """Capacity curve a*(d) as a straight line from a0* [m/s2] at rest to zero at d0* [m]."""

    a0: float
    d0: float
    broken: float | None = None
    seat: Seat | None = None

    def acceleration(self, d: float) -> float:
        """Return a* at a displacement [m/s2]."""
        return self.a0 * (1 - d / self.d0)


CapacityCurve = ExactCurve | StraightCurve


def ends(curve: CapacityCurve, rule: Rule) -> dict[str, float]:
    """Return the displacements at which the capacity may end at a limit state, by what ends it; the least does [m]."""
    lost = {SHARE: rule.share * curve.d0}
    if rule.at_breaks and curve.broken is not None:
        lost[BREAK] = curve.broken
    if curve.seat is not None:
        lost[SEAT] = curve.seat.d
    return lost


def with_elastic_branch(a: float, d: float, T0: float | None) -> float:
    """Limit a* at a displacement to the elastic branch 4 pi^2 d/T0^2, if there is a T0 [m/s2]."""
    return a if T0 is None else min(a, 4 * pi**2 * d / T0**2)


MIN_TURN = 1e-9  # rad per rad; a block that turns less moves in a straight line
ROUNDING_SHARE = 1e-9  # share of the work of the weights, or of the masses, below which a remainder is zero


@dataclass(frozen=True)
class Moved:
    """A block in a displaced position of the chain, with its motion per unit rotation.

    Parameters
    ----------
    block : ChainBlock
        The block.
    gone : float
        Horizontal displacement of its barycentre, positive in the direction of rocking [m].
    at : complex
        Present position of the barycentre [m].
    turns : float
        Rotation of the block per unit rotation of the chain, positive in the direction of rocking.
    centre : complex or None
        Instantaneous centre of rotation [m]; None if the block translates.
    dx, dy : float
        Virtual displacements x' of the barycentre of P + Q, in the direction of rocking, and y' of that of P, upwards
        [m/rad].
    angle : float
        Rotation of the block from its position at rest, positive in the direction of rocking [rad].
    """

    block: ChainBlock
    gone: float
    at: complex
    turns: float
    centre: complex | None
    dx: float
    dy: float
    angle: float


@dataclass(frozen=True)
class ForceWork:
    """A force or tie in a position: force [N], velocity of its point per unit rotation [m], and work absorbed [N m]."""

    name: str
    force: float
    rate: float
    work: float


@dataclass(frozen=True, eq=False)
class DisplacedChain:
    """The chain at a rotation.

    Parameters
    ----------
    curve : ExactCurve
        The capacity curve of the chain.
    phi : float
        The rotation [rad].
    """

    curve: ExactCurve
    phi: float

    @property
    def chain(self) -> Chain:
        """The moving blocks."""
        return self.curve.chain

    @cached_property
    def _follow(self) -> Follow:
        return self.chain.mechanism.followed(np.array([self.phi]), self.chain.direction)

    @cached_property
    def blocks(self) -> Sequence[Moved]:
        """The blocks of the chain in this position."""
        return [self._moved(block) for block in self.chain.blocks]

    def _moved(self, block: ChainBlock) -> Moved:
        s, body = self.chain.direction, block.bodies[0]
        here, beside = (self._follow(Spot(body, at)) for at in (block.at, block.at + 1))
        velocity = complex(here.dz[0])
        now, spin = complex(here.z[0]), (complex(beside.dz[0]) - velocity) / (complex(beside.z[0]) - complex(here.z[0]))
        weights = [weight for weight in self.chain.weights if weight.spot.body in block.bodies]
        lifts = [weight.carried * float(self._follow(weight.spot).dz[0].imag) for weight in weights]
        lifted = sum(lifts) / (block.P or 1.0)  # y' of the barycentre of the carried weights
        turns = -s * spin.imag
        centre = None if abs(turns) < MIN_TURN else now - velocity / (1j * spin.imag)
        angle = -s * float(np.angle(complex(beside.z[0]) - now))
        return Moved(block, s * (now - block.at).real, now, turns, centre, s * velocity.real, lifted, angle)

    @property
    def lifted(self) -> float:
        """Sum of P y' over the blocks [N m]."""
        return sum(each.block.P * each.dy for each in self.blocks)

    @property
    def driven(self) -> float:
        """Sum of (P + Q) x' over the blocks [N m]."""
        return sum(each.block.PQ * each.dx for each in self.blocks)

    @cached_property
    def held(self) -> Sequence[ForceWork]:
        """The forces and ties in this position."""
        s, works = self.chain.direction, list[ForceWork]()
        for element in self.curve.standing(self.phi).hung.elements:
            if isinstance(element, ConstantForce):
                force, rate = element.in_direction(s), complex(self._follow(element.spot).dz[0])
                parts = [("x", s * force.real, s * rate.real), ("y", force.imag, rate.imag)]
                works += [ForceWork(f"{element.name}, {axis}", F, r, -F * r) for axis, F, r in parts if F]
                continue
            for tie in element.stretched:
                e, first, _ = tie.elongation(self._follow)
                total = Coefficients(np.zeros(1), *(np.zeros(1) for _ in range(7)))
                tie.act(total, s, self._follow)
                N = tie.count * float(tie.force(e)[0])
                works.append(ForceWork(tie.name, N, float(first[0]), float(total.Q[0])))
        return works

    @cached_property
    def _own(self) -> tuple[float, float]:
        """The derivative V' [N m] of the potential, and the coefficient B [kg m]."""
        standing, g = self.curve.standing(self.phi), self.chain.mechanism.gravity
        here = standing.coefficients(np.array([self.phi]), self.chain.direction)
        return float(here.restoring(g)[0]) * g, float(here.B[0])

    @property
    def alpha(self) -> float:
        """The multiplier in this position, V'/(g B)."""
        V, B = self._own
        return V / (self.chain.mechanism.gravity * B)

    @property
    def rest(self) -> float:
        """Remainder of V' that the listed weights, forces and ties do not explain [N m].

        It comes from the mechanism itself, and is set to 0 if it is only rounding.
        """
        known = self.lifted + sum(each.work for each in self.held)
        rest = self._own[0] - known
        scale = sum(abs(each.block.P * each.dy) for each in self.blocks) + sum(abs(each.work) for each in self.held)
        return rest if abs(rest) > ROUNDING_SHARE * max(scale, abs(self._own[0]), self.driven * 1e-6) else 0.0

    @property
    def more(self) -> float:
        """Remainder of g B that the listed weights do not explain: additional inertia of the mechanism itself [N m].

        It is set to 0 if it is only rounding.
        """
        more = self._own[1] * self.chain.mechanism.gravity - self.driven
        return more if abs(more) > ROUNDING_SHARE * abs(self.driven) else 0.0


MIN_ELONGATION = 1e-6  # m; a smaller one is rounding
MAX_OVERHANG_SHARE = 0.8
"""Displacement of the centroid of a block over half its thickness from which the output warns; it falls at 1."""


@dataclass(frozen=True)
class Pull:
    """A tie at a displacement, or a force against the motion that may represent a tie.

    Parameters
    ----------
    name : str
        Name of the tie or force.
    force : float
        Force at this displacement [N], tension positive; 0 where it is no longer known to hold.
    elongation : float
        Elongation since rest; for a force, displacement of its point against the force [m].
    strain : float or None
        The elongation over the length of the tie; None if the length is not known, as for a force.
    """

    name: str
    force: float
    elongation: float
    strain: float | None


def pulls(curve: ExactCurve, d: float) -> Sequence[Pull]:
    """Return the ties, and the forces against the motion, at a displacement; beds of springs are not among them."""
    chain, phi = curve.chain, curve.rotation(d)
    follow = chain.mechanism.followed(np.array([phi]), chain.direction)
    lengths = {tie.name: tie.length or tie.span for tie in chain.mechanism.ties or [] if tie.bed is None}
    forces, pulled = against(chain), []
    standing = {element.name for element in curve.standing(phi).hung.elements}
    for element in chain.mechanism.hung.elements:
        if isinstance(element, Spring):
            e, length = element.elongation(follow)[0], lengths[element.name]
            strain = float(e[0]) / length if length else None
            force = float(element.force(e)[0]) if element.name in standing else 0.0
            pulled.append(Pull(element.name, force, float(e[0]), strain))
        elif isinstance(element, ConstantForce) and element.name in forces:
            e = element.elongation(follow, chain.direction)[0]
            pulled.append(Pull(element.name, abs(element.thrust), float(e[0]), None))
    return pulled


def beyond(pulled: Iterable[Pull]) -> list[str]:
    """Return the forces that move against themselves, of which no length is known, by name."""
    return [each.name for each in pulled if each.strain is None and each.elongation > MIN_ELONGATION]


def strengths(mechanism: Mechanism) -> dict[str, TieStrength]:
    """Return the strength of each tie of steel, by name."""
    return {tie.name: tie.strength(tie.number_of_bars(mechanism.depth)) for tie in mechanism.ties or [] if tie.is_steel}


def thickness_of_plate(tie: Tie, depth: float | None) -> float:
    """Return the thickness at which the plates of a tie bend at its strength without their bending [m]."""
    assert tie.plate is not None
    count, one_metre = tie.number_of_bars(depth), tie.plate.model_copy(update={"thickness": 1.0})
    limits = tie.model_copy(update={"plate": one_metre}).strength(count).limits
    return sqrt(tie.strength(count).force / limits["bending"])


def furthest(curve: ExactCurve, d: float) -> tuple[float, float]:
    """Return the sideways displacement of a block's centroid at a displacement, and the thickness of the block [m].

    The block is the one with the largest ratio of both; (0, 1) if no outline is known.
    """
    drawn = curve.chain.mechanism.sketch().outlines
    outlines = {body.name: [body.outline] for body in curve.chain.mechanism.bodies() if body.outline}
    moves = [(0.0, 1.0)]
    for moved in DisplacedChain(curve, curve.rotation(d)).blocks:
        lines = [line for name in moved.block.bodies for line in outlines.get(name) or drawn.get(name, ())]
        x = [complex(corner).real for line in lines for corner in line]
        if x and max(x) > min(x):
            moves.append((moved.gone, max(x) - min(x)))
    return max(moves, key=lambda pair: pair[0] / pair[1])


def elastic(mechanism: Mechanism) -> Sequence[Tie]:
    """Return the ties and beds of springs whose force increases with the elongation."""
    return [tie for tie in mechanism.ties or [] if tie.is_elastic]


def lasting(mechanism: Mechanism) -> Mechanism:
    """Return the structure, with constant forces in place of elastic ties that would hold it at any displacement.

    The capacity curve of the code ends at collapse. A tie whose force increases without limit has no such end, because
    the model does not know the strength of the tie. The constant force is the force of the tie at rest.
    """
    if not elastic(mechanism):
        return mechanism
    curves = [ExactCurve(chain, chain.barycentre, 1.0) for chain in (Chain(mechanism, s) for s in mechanism.directions)]
    return _as_at_rest(mechanism) if any(curve.is_endless for curve in curves) else mechanism


def _as_at_rest(mechanism: Mechanism) -> Mechanism:
    growing = {tie.name for tie in elastic(mechanism)}
    plain = {"stiffness": 0.0, "area": None, "modulus": None, "length": None}
    ties = [
        tie.model_copy(update=plain) if tie.name in growing else tie
        for tie in mechanism.ties or []
        if tie.name not in growing or tie.prestress
    ]
    return mechanism.model_copy(update={"ties": ties or None})
