"""The chain in a displaced position: positions and motions of its blocks, and the ties and forces that restrain it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import sqrt

import numpy as np

from rocking_cli.codes.italian.capacity import ExactCurve, against
from rocking_cli.codes.italian.chain import Chain, ChainBlock
from rocking_cli.core import Mechanism
from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.hung.attached import Follow, Spot
from rocking_cli.core.hung.element import ConstantForce, Spring
from rocking_cli.core.hung.ties import Tie, TieStrength

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
