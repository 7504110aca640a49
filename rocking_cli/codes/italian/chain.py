"""The blocks that move in a direction of rocking, as the code needs them: weights and virtual displacements at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.hung.attached import Attached, Follow, PointMass, Spot
from rocking_cli.core.kinematics import Reals
from rocking_cli.core.reactions import parts
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.short_repr import short_repr
from rocking_cli.verification.results import Control

MIN_SIDEWAYS_SHARE = 1e-9  # share of the largest virtual displacement from which a control point moves sideways
ROUNDING_SHARE = 1e-14  # share of the farthest coordinate below which a displacement is a rounding error


@dataclass(frozen=True)
class Weight:
    """A mass of the chain.

    Parameters
    ----------
    name : str
    spot : Spot
        Position of the mass.
    mass : float
        The mass [kg].
    w, h : float
        Shares of the mass that the block carries, and that move sideways with the block.
    gravity : float
        Acceleration of gravity [m/s2].
    """

    name: str
    spot: Spot
    mass: float
    w: float
    h: float
    gravity: float

    @property
    def carried(self) -> float:
        """P, the part of its weight that the block carries [N]."""
        return self.w * self.mass * self.gravity

    @property
    def inertial(self) -> float:
        """P + Q, the weight of the mass that moves sideways with the block [N]."""
        return self.h * self.mass * self.gravity


@dataclass(frozen=True)
class ChainBlock:
    """A block of the chain: pieces that move together, and the loads they carry.

    Parameters
    ----------
    bodies : sequence of str
        The pieces, by their names in the drawing.
    P, PQ : float
        Weights carried, and weights moved sideways [N].
    at : complex
        Barycentre of P + Q at rest [m]; of P where P + Q is zero.
    dx : float
        Virtual displacement x' of the barycentre of P + Q, positive in the direction of rocking [m/rad].
    dy : float
        Virtual displacement y' of the barycentre of P, positive upwards [m/rad].
    of_P : complex
        Barycentre of P at rest [m].
    """

    bodies: Sequence[str]
    P: float
    PQ: float
    at: complex
    dx: float
    dy: float
    of_P: complex


@short_repr
@dataclass(frozen=True, eq=False)
class Chain:
    """The moving blocks of a structure in one direction of rocking.

    Parameters
    ----------
    mechanism : Mechanism
        The structure, with what is attached to it.
    direction : Direction
        The direction of rocking.
    whole : bool
        Whether P + Q includes every weight carried, by the letter of the code, even one without horizontal inertia.
    """

    mechanism: Mechanism
    direction: Direction
    whole: bool = False

    def __post_init__(self) -> None:
        if self.mechanism.driven < 1:
            what = "below 1 cannot be verified by the code, whose forces act in the plane of the mechanism"
            hint = "leave it out, so that the whole motion acts in this plane, which is conservative"
            raise InputError(Problem(what, field="drive", hint=hint))

    @cached_property
    def weights(self) -> Sequence[Weight]:
        """The masses that move; masses at rest are left out."""
        moving = {name for name, number in parts(self.mechanism, self.direction).items() if number}
        g = self.mechanism.gravity
        of_bodies = [
            Weight(body.name, Spot(body.name, body.centroid), body.mass, 1.0, 1.0, g)
            for body in self.mechanism.weighed()
            if body.name in moving
        ]
        return of_bodies + [
            Weight(each.name, each.spot, each.mass, each.weight, each.horizontal + self._more(each), g)
            for each in self.mechanism.hung.masses
            if each.spot.body in moving
        ]

    def _more(self, each: PointMass) -> float:
        """Return the share of a mass that moves sideways by the letter of the code alone."""
        return max(each.weight - each.horizontal, 0.0) if self.whole else 0.0

    def added(self, phi: Reals) -> Reals:
        """Return the part of the sum of (P + Q) x' over g that the letter of the code adds at rotations [kg m]."""
        if not self.whole:
            return np.zeros_like(phi)
        more = [(each.mass * share, each.spot) for each in self.mechanism.hung.masses if (share := self._more(each))]
        follow = self.mechanism.followed(phi, self.direction)
        return self.direction * sum((mass * follow(spot).dz.real for mass, spot in more), np.zeros_like(phi))

    @cached_property
    def blocks(self) -> Sequence[ChainBlock]:
        """The blocks of the chain; the division of a block into pieces that move together has no effect."""
        numbers = parts(self.mechanism, self.direction)
        groups = [
            [name for name, number in numbers.items() if number == k] for k in range(1, 1 + max(numbers.values()))
        ]
        return [self._block(names, [each for each in self.weights if each.spot.body in names]) for names in groups]

    def _block(self, names: Sequence[str], weights: Sequence[Weight]) -> ChainBlock:
        P, PQ = (sum(getattr(each, key) for each in weights) for key in ("carried", "inertial"))
        shares = [each.inertial for each in weights] if PQ else [each.carried for each in weights]
        at = sum(share * each.spot.at for share, each in zip(shares, weights, strict=True)) / (sum(shares) or 1.0)
        velocity = [complex(self._follow_at_rest(each.spot).dz[0]) for each in weights]
        dx = sum(share * v.real for share, v in zip(shares, velocity, strict=True)) / (sum(shares) or 1.0)
        dy = sum(each.carried * v.imag for each, v in zip(weights, velocity, strict=True)) / (P or 1.0)
        of_P = sum(each.carried * each.spot.at for each in weights) / (P or 1.0)
        return ChainBlock(names, P, PQ, complex(at), self.direction * dx, dy, complex(of_P))

    @cached_property
    def _follow_at_rest(self) -> Follow:
        return self.mechanism.followed(np.zeros(1), self.direction)

    @property
    def inertial(self) -> float:
        """Sum of P + Q over the blocks [N]."""
        return sum(block.PQ for block in self.blocks)

    @property
    def first(self) -> float:
        """Sum of (P + Q) x' over the blocks [N m]."""
        return sum(block.PQ * block.dx for block in self.blocks)

    @property
    def second(self) -> float:
        """Sum of (P + Q) x'^2 over the blocks [N m2]."""
        return sum(block.PQ * block.dx**2 for block in self.blocks)

    @property
    def lifted(self) -> float:
        """Sum of P y' over the blocks [N m]."""
        return sum(block.P * block.dy for block in self.blocks)

    def held_by(self, *, ties: bool) -> float:
        """Return the work per unit rotation at rest that ties absorb, or that forces absorb [N m]."""
        hung = self.mechanism.hung
        return sum(self._moment(attached) for attached in hung.things if (attached in hung.ties) == ties)

    @property
    def works(self) -> dict[str, float]:
        """Work per unit rotation that each force and tie absorbs at rest, by name [N m]."""
        held = [attached for attached in self.mechanism.attached if not isinstance(attached, PointMass)]
        return {attached.name: self._moment(attached) for attached in held}

    def _moment(self, attached: Attached) -> float:
        rest = np.zeros(1)
        total = Coefficients(rest, *(np.zeros(1) for _ in range(7)))
        attached.act(total, self.direction, self._follow_at_rest)
        return float(total.Q[0])

    @property
    def alpha0(self) -> float:
        """Multiplier alpha0 that activates the mechanism."""
        return (self.lifted + self.held_by(ties=False) + self.held_by(ties=True)) / self.first

    @property
    def is_by_the_letter(self) -> bool:
        """Whether every weight carried has its full horizontal inertia, so that both wordings agree."""
        return all(each.carried <= each.inertial * (1 + 1e-12) for each in self.weights)

    @property
    def e_star(self) -> float:
        """Participating mass ratio e*."""
        return self.first**2 / (self.inertial * self.second)

    @property
    def barycentre(self) -> Control:
        """Default control point: the barycentre of P + Q."""
        return Control(sum(block.PQ * block.at for block in self.blocks) / self.inertial)

    def sideways(self, control: Control) -> float:
        """Return x' of a control point at rest [m/rad]. Raises `InputError` if it does not move in the direction."""
        dx = self.first / self.inertial
        if control.body is not None:
            dx = self.direction * float(self._follow_at_rest(Spot(control.body, control.at)).dz[0].real)
        if not dx > MIN_SIDEWAYS_SHARE * max(abs(block.dx) for block in self.blocks):
            raise InputError(
                f"{named('control')} does not move in the {self.direction.label} direction: its virtual "
                "displacement at "
                f"[{control.at.real:g}, {control.at.imag:g}] is {dx:.4g} m/rad; choose a point that moves that way"
            )
        return dx

    def moved(self, phi: Reals, control: Control) -> Reals:
        """Return the horizontal displacement d_C of a control point at rotations, shape (n,) [m]."""
        follow = self.mechanism.followed(phi, self.direction)
        if control.body is not None:
            way = self.direction * (follow(Spot(control.body, control.at)).z - control.at).real
        else:
            ways = [each.inertial * (follow(each.spot).z - each.spot.at).real for each in self.weights]
            way = self.direction * np.sum(ways, axis=0) / self.inertial
        farthest = max(abs(each) for each in (control.at, *(one.spot.at for one in self.weights)))
        return np.where(np.abs(way) < ROUNDING_SHARE * farthest, 0.0, way)

    def displacement(self, phi: Reals, control: Control) -> Reals:
        """Return d of the equivalent oscillator at rotations, shape (n,) [m]."""
        return np.asarray(self.moved(phi, control) * self.second / (self.sideways(control) * self.first))
