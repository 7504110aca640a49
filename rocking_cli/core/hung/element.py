"""Elements: forces N on a mechanism that follow from an elongation e, by any law.

    Q = N e',   Q' = N'(e) e'^2 + N e'',   U = the integral of N de

A law gives `force`, `slope` and `energy`. Each element states whether it has a memory, whether it resists by its rate,
and whether its law is piecewise linear; from this follows which questions have an answer for the structure. Those of
structure files are constant forces, elastic ties, beds of springs and the friction of crossing walls.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from rocking_cli.arrays import Bools
from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.fields import Described, Name, Vertex, geometry_error, length, point, quantity
from rocking_cli.core.hung.attached import Follow, PointMass, Push, Spot
from rocking_cli.core.kinematics import Direction, Points, Reals
from rocking_cli.plugins.errors import failed, guard
from rocking_cli.units import kind_of, split

Sense = Literal["tension", "compression"]
Question = Literal["linear models", "equivalent block", "sizes", "verification", "trace"]
NO_ANSWER: dict[Question, str] = {
    "linear models": "the linear models do not hold",
    "equivalent block": "no single block is equivalent to it",
    "sizes": "spectra and maps are not available",
    "verification": "no code of practice here covers it",
    "trace": "no trace of free rocking can be fitted",
}
"""Analyses other than the nonlinear history, with the message if an element does not allow one."""

COINCIDENT_DISTANCE = 1e-9  # distance of coinciding points [m], plus this share of the distance to the origin
ZERO_ELONGATION = 1e-14  # elongations that count as zero [m], plus this share of the distance to the origin
SMALL_ROTATION = 1e-6  # rad; below it the distance of points that coincide at rest is its derivative times phi


class Element(ABC):
    """A force on a mechanism that follows from an elongation: a tie, a bed of springs, a constant force."""

    name: str
    has_memory: ClassVar[bool] = False
    """Whether its force depends on past deformations, as that of a tie that yields."""
    has_rate: ClassVar[bool] = False
    """Whether its force depends on the rate of its elongation, as that of a damper."""
    is_linear: ClassVar[bool] = True
    """Whether its law is piecewise linear, so that linear models may use its slope at the critical rotation."""
    departs: ClassVar[str] = ""
    """Verb after the name of an element in messages if its law is not piecewise linear, such as `yields`."""

    def __init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of elements of other packages, so that their failures name that package."""
        super().__init_subclass__(**named)
        if cls.__module__.partition(".")[0] != __name__.partition(".")[0]:
            guard(cls, (*vars(Element), "slack_at"), failed("element", "__name__"))

    @property
    @abstractmethod
    def words(self) -> str:
        """Description of the element in a few words, without its name."""

    @abstractmethod
    def as_dict(self) -> dict[str, Any]:
        """Return the kind, the place at rest and the parameters of the element, in SI units."""

    @abstractmethod
    def force(self, e: Reals) -> Reals:
        """Return the force N of one such element at elongations `e` [N], shape (n,); tension is positive."""

    @abstractmethod
    def slope(self, e: Reals, going: Reals) -> Reals:
        """Return dN/de [N/m], shape (n,); at a corner of the law, on the side given by the sign of `going` (e')."""

    @abstractmethod
    def energy(self, e: Reals) -> Reals:
        """Return the energy at elongations `e`, the integral of N from rest [J], shape (n,)."""

    @abstractmethod
    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """Return e [m] and its first two derivatives in phi, each shape (n,), in a direction of rocking."""

    @abstractmethod
    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the moment of the element to Q, with its derivative and its energy."""

    @abstractmethod
    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Return the forces of the element on bodies and the ground [N]."""

    @property
    def stretched(self) -> Sequence[Stretched]:
        """Ties along a path that together act as this element does; empty for a force."""
        return ()

    def refuses(self, question: Question) -> str | None:
        """Return why the element prevents an answer to a question, a clause that follows its name; None if not.

        An element with memory or with resistance to its rate has no single force at an elongation. One that is not
        piecewise linear has no linear model, and the codes of practice here do not cover it.
        """
        if self.has_memory or (self.has_rate and question != "equivalent block"):
            return self.departs or f"has {'a memory' if self.has_memory else 'a force that depends on its rate'}"
        if not self.is_linear and question in ("linear models", "verification"):
            return self.departs or "has a force that is no straight line over its elongation"
        return None


@dataclass(frozen=True)
class Stretched(Element):
    """An element stretched along a path of points, by any law.

    Parameters
    ----------
    name : str
        Name of the element.
    spots : sequence of Spot
        Two points or more; the length of the element is the sum of the distances between them.
    count : float
        Number of identical elements.
    only : {"tension", "compression"}, optional
        The only sense in which it acts, if any; its law then has a corner where `slack_at` is zero.
    """

    name: str
    spots: Sequence[Spot]
    _: KW_ONLY
    count: float = 1.0
    only: Sense | None = None

    @property
    def at_rest(self) -> tuple[float, float]:
        """Force [N] and stiffness [N/m] at rest."""
        rest = np.zeros(1)
        return float(self.force(rest)[0]), float(self.slope(rest, np.ones(1))[0])

    @property
    def stretched(self) -> Sequence[Stretched]:
        """The ties that together act as this element does: only the element itself."""
        return (self,)

    def as_dict(self) -> dict[str, Any]:
        """Return the path of the element, and its force and stiffness at rest."""
        force, stiffness = self.at_rest
        path = [spot.as_dict() for spot in self.spots]
        strength = {"stiffness": stiffness, "prestress": force, "only": self.only}
        return {"kind": "tie", "path": path, **strength, "count": self.count}

    def slack_at(self, e: Reals) -> Reals:
        """Return a value [N] that changes sign where a one-sided element goes slack or taut."""
        return self.force(e)

    def pull(self, e: Reals, going: Reals) -> Reals:
        """Return the force N with which one such element acts at elongations `e` that change by `going` (e') [N]."""
        return self.force(e)

    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """Return e = L - L(0) [m] and the first two derivatives of L in phi, each shape (n,)."""
        paths = [follow(spot) for spot in self.spots]
        e, first, second = (np.zeros(paths[0].z.shape) for _ in range(3))
        for (one, here), (other, there) in pairwise(zip(self.spots, paths, strict=True)):
            d, dd, ddd = there.z - here.z, there.dz - here.dz, there.ddz - here.ddz
            span, speed, rest = np.abs(d), np.abs(dd), _apart(one, other)
            met = _met(d, dd, rest)
            with np.errstate(divide="ignore", invalid="ignore"):
                rate = np.where(met, speed, dot(d, dd) / span)  # L' = dr.dr'/L
                bend = np.where(met, dot(dd, ddd) / speed, (speed**2 + dot(d, ddd) - rate**2) / span)
            still = span + speed == 0  # points that stay together
            e += span - rest
            first += np.where(still, 0.0, rate)
            second += np.where(still, 0.0, bend)
        reach = 1 + max(abs(spot.at) for spot in self.spots)
        return np.where(np.abs(e) <= ZERO_ELONGATION * reach, 0.0, e), first, second

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the moment N L' to Q."""
        e, first, second = self.elongation(follow)
        n = self.pull(e, first)
        total.Q[:] += self.count * n * first
        total.dQ[:] += self.count * (self.slope(e, first) * first**2 + n * second)
        total.U[:] += self.count * self.energy(e)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Return the force N along each piece of the path, at both of its ends [N]."""
        n = self.count * self.pull(*self.elongation(follow)[:2])
        paths = [follow(spot) for spot in self.spots]
        pushes = []
        for (one, here), (other, there) in pairwise(zip(self.spots, paths, strict=True)):
            d, dd = there.z - here.z, there.dz - here.dz
            along = np.where(_met(d, dd, _apart(one, other)), dd, d).astype(np.complex128)
            size = np.abs(along)
            pull = along * (n / np.where(size == 0, 1.0, size))  # points that stay together do not pull
            pushes += [Push(one, pull), Push(other, -pull)]
        return pushes


def dot(u: complex | Points, v: Points) -> Reals:
    """Return the scalar product of vectors of the plane, each a complex number."""
    return np.asarray((np.conj(u) * v).real)


def _apart(one: Spot, other: Spot) -> float:
    """Return the distance of two points at rest [m]; exactly 0 if they coincide to rounding."""
    rest = abs(other.at - one.at)
    return 0.0 if rest <= COINCIDENT_DISTANCE * (1 + abs(one.at)) else rest


def _met(d: Points, dd: Points, rest: float) -> Bools:
    """Return a mask of the rotations at which two points that coincide at rest are still very close together.

    At these rotations, their distance is taken as its derivative times phi.
    """
    return np.abs(d) <= SMALL_ROTATION * np.abs(dd) if rest == 0.0 else np.zeros(d.shape, bool)


@dataclass(frozen=True)
class ConstantForce(Element):
    """A force of constant size and direction, such as the thrust of a vault; or friction, which opposes the motion.

    Its elongation is the displacement of its point against the force.

    Parameters
    ----------
    name : str
        Name of the force.
    spot : Spot
        Point at which it acts.
    thrust : complex
        Fx + i Fy [N]; for friction, its value while the mechanism rocks in the positive direction.
    friction : bool
        Whether the horizontal component reverses with the direction of rocking.
    """

    name: str
    spot: Spot
    thrust: complex
    friction: bool = False

    @property
    def words(self) -> str:
        """Description of the force by its two components, or as friction."""
        if self.friction:
            at = f"at y = {self.spot.at.imag:.4g} m"
            return f"a constant friction of {abs(self.thrust) / 1000:.4g} kN against the motion {at}"
        return f"a force of {self.thrust.real / 1000:.4g} kN to the right and {self.thrust.imag / 1000:.4g} kN up"

    def as_dict(self) -> dict[str, Any]:
        """Return the point and the two components of the force [N]."""
        kind = "friction" if self.friction else "force"
        return {"kind": kind, **self.spot.as_dict(), "force": [self.thrust.real, self.thrust.imag]}

    def in_direction(self, direction: Direction) -> complex:
        """Return the force Fx + i Fy while the mechanism rocks in a direction [N]."""
        return complex(direction * self.thrust.real, self.thrust.imag) if self.friction else self.thrust

    def force(self, e: Reals) -> Reals:
        """Return the size of the force [N], shape (n,)."""
        return np.full(e.shape, abs(self.thrust))

    def slope(self, e: Reals, going: Reals) -> Reals:
        """Return zeros: the force is constant."""
        return np.zeros(e.shape)

    def energy(self, e: Reals) -> Reals:
        """Return the work done against the force [J]."""
        return abs(self.thrust) * e

    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """Return the displacement of the point against the force [m] and its derivatives; zeros for no force."""
        z, dz, ddz = follow(self.spot)
        along = self.in_direction(direction) / (abs(self.thrust) or 1.0)
        return -dot(along, z - self.spot.at), -dot(along, dz), -dot(along, ddz)

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the moment -F.r' to Q."""
        z, dz, ddz = follow(self.spot)
        force = self.in_direction(direction)
        total.Q[:] -= dot(force, dz)
        total.dQ[:] -= dot(force, ddz)
        total.U[:] -= dot(force, z - self.spot.at)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Return the force itself, at its point."""
        return (Push(self.spot, np.full(follow(self.spot).z.shape, self.in_direction(direction))),)


@dataclass(frozen=True)
class Spring(Stretched):
    """An elastic tie along a path of points: N = N0 + k e, in tension only, in compression only, or both.

    Parameters
    ----------
    name, spots, count, only
        See `Stretched`.
    stiffness, prestress : float
        Stiffness k [N/m], and force N0 at rest [N], tension positive.
    """

    stiffness: float
    prestress: float = 0.0

    @property
    def words(self) -> str:
        """Description of the stiffness, of the force at rest and of the sense in which the tie acts."""
        many = f"{self.count:g} ties, each" if self.count != 1 else "a tie of"
        sense = f", {self.only} only" if self.only else ""
        if self.stiffness == 0:
            return f"{many} a constant {self.prestress / 1000:.4g} kN{sense}"
        force = f", {self.prestress / 1000:.4g} kN at rest" if self.prestress else ""
        return f"{many} {self.stiffness / 1000:.4g} kN/m{force}{sense}"

    @property
    def at_rest(self) -> tuple[float, float]:
        """Prestress [N] and stiffness [N/m], also if the tie is slack at rest."""
        return self.prestress, self.stiffness

    def force(self, e: Reals) -> Reals:
        """Return the force N of one tie at elongations `e` [N]."""
        n = self.slack_at(e)
        if self.only == "tension":
            return np.maximum(n, 0.0)
        return np.minimum(n, 0.0) if self.only == "compression" else n

    def slope(self, e: Reals, going: Reals) -> Reals:
        """Return the stiffness dN/de at elongations `e` [N/m]: k if the tie acts, 0 if it is slack.

        At the elongation at which the tie goes slack or taut, it acts if `going` (e') has the sign that stretches it
        further.
        """
        if self.only is None:
            return np.full(e.shape, self.stiffness)
        sense = -1.0 if self.only == "compression" else 1.0
        acts = (self.force(e) != 0) | ((self.slack_at(e) == 0) & (sense * going > 0))
        return np.where(acts, self.stiffness, 0.0)

    def energy(self, e: Reals) -> Reals:
        """Return the integral of N from rest [J]; a slack tie stores no more energy."""
        if self.only is not None and self.stiffness > 0:
            with np.errstate(over="ignore"):
                slack = -np.float64(self.prestress) / self.stiffness  # elongation at which the tie goes slack
            e = np.maximum(e, slack) if self.only == "tension" else np.minimum(e, slack)
        return self.prestress * e + self.stiffness * e**2 / 2

    def slack_at(self, e: Reals) -> Reals:
        """Return N0 + k e [N], the force of a tie that acts in both senses."""
        return self.prestress + self.stiffness * e


@dataclass(frozen=True)
class SteelBar(Spring):
    """A passive tie of steel: N = k e while it is longer than at rest, until it yields; slack otherwise.

    Parameters
    ----------
    name, spots, stiffness, count
        See `Spring`.
    strength : float
        Force of one such tie at which it yields, or its anchorage fails [N].
    """

    _: KW_ONLY
    strength: float
    only: Sense | None = "tension"

    @property
    def words(self) -> str:
        """Description of the stiffness and of the strength."""
        return f"{super().words}, with a strength of {self.strength / 1000:.4g} kN"

    def as_dict(self) -> dict[str, Any]:
        """Return the path of the tie, its stiffness and its strength."""
        return {**super().as_dict(), "strength": self.strength}

    @property
    def yield_elongation(self) -> float:
        """Elongation at which it yields [m]."""
        return self.strength / self.stiffness


@dataclass(frozen=True)
class BarAtStrength(Spring):
    """A tie of steel as methods of codes count it: with its strength, as a constant force, unless it is slack.

    It is slack while it is shorter than at rest, and at rest in a direction in which it becomes shorter.
    """

    def force(self, e: Reals) -> Reals:
        """Return the strength [N], shape (n,); 0 where the tie is shorter than at rest."""
        return np.where(e < 0, 0.0, self.prestress)

    def pull(self, e: Reals, going: Reals) -> Reals:
        """Return the force with which one tie acts [N], at rest in a direction that stretches it."""
        # A tie across the motion neither stretches nor shortens at first, whatever rounding says of its rate [m/rad].
        return np.where((e == 0) & (going < -COINCIDENT_DISTANCE), 0.0, self.force(e))

    def energy(self, e: Reals) -> Reals:
        """Return the work of the strength [J]; a slack tie takes up none."""
        return self.prestress * np.maximum(e, 0.0)


@dataclass(frozen=True)
class SpringBed(Element):
    """Springs distributed along a face of a body, from each point of the face to its place at rest: k ds each.

    Two springs at the Gauss points of the face have exactly the same moment, as the squared distance is quadratic along
    the face of a rigid body. Force and elongation of the bed are its resultant and the opening at mid-face.

    Parameters
    ----------
    name : str
        Name of the bed.
    start, end : Spot
        Ends of the face, on the same body.
    modulus : float
        Stiffness per length of the face [N/m per metre].
    count : float
        Number of identical beds.
    """

    name: str
    start: Spot
    end: Spot
    modulus: float
    count: float = 1.0

    @property
    def words(self) -> str:
        """Description of the bed by its modulus."""
        return f"springs of {self.modulus / 1000:.4g} kN/m per metre of its face"

    @property
    def stiffness(self) -> float:
        """Stiffness of one bed if all of its face opens by the same amount [N/m]."""
        return self.modulus * abs(self.end.at - self.start.at)

    @property
    def stretched(self) -> Sequence[Spring]:
        """The two springs, at the Gauss points, that act as the bed does."""
        middle, half = (self.start.at + self.end.at) / 2, (self.end.at - self.start.at) / 2
        each = self.modulus * abs(half) * self.count
        places = (middle - half / np.sqrt(3), middle + half / np.sqrt(3))
        return [Spring(self.name, (Spot(None, at), Spot(self.start.body, at)), each) for at in places]

    def as_dict(self) -> dict[str, Any]:
        """Return the face and the modulus of the bed."""
        return {"kind": "bed", "path": [self.start.as_dict(), self.end.as_dict()], "modulus": self.modulus}

    def force(self, e: Reals) -> Reals:
        """Return the resultant of one bed whose mid-face has opened by `e` [N]."""
        return self.stiffness * e

    def slope(self, e: Reals, going: Reals) -> Reals:
        """Return the stiffness of one bed [N/m], shape (n,)."""
        return np.full(e.shape, self.stiffness)

    def energy(self, e: Reals) -> Reals:
        """Return the energy of one bed if all of its face has opened by `e` [J]."""
        return self.stiffness * e**2 / 2

    def elongation(self, follow: Follow, direction: Direction = Direction.POSITIVE) -> tuple[Reals, Reals, Reals]:
        """Return the opening at mid-face [m] and its first two derivatives in phi."""
        at = (self.start.at + self.end.at) / 2
        middle = Spring(self.name, (Spot(None, at), Spot(self.start.body, at)), self.stiffness)
        return middle.elongation(follow, direction)

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the moment of the bed to Q."""
        for spring in self.stretched:
            spring.act(total, direction, follow)

    def forces(self, direction: Direction, follow: Follow) -> Sequence[Push]:
        """Return the forces of the springs of the bed [N]."""
        return [push for spring in self.stretched for push in spring.forces(direction, follow)]


INTERLOCK_NAME = "interlock"
COUNTED_SHARE = 0.4  # share of the sliding force of all courses that the code counts, for blocks laid with care
FRICTION_HEIGHT = 1 / 3  # height of the resultant friction of courses under their own weight, over the height


class Interlock(Described):
    """Friction between the courses of a facade and of its crossing walls [Circolare 7/2019, C8.7.1.2].

    F = 0.4 n (n + 1) (h_b/l) mu l^2 t_s w of each crossing wall, at a third of the height above the foot: constant,
    against the motion in either direction, and without inertia. The load on the crossing walls is neglected, and so is
    the separation of blocks that have slid by their overlap: a time history is not valid beyond that.
    """

    courses: int = quantity("number of courses in the height", symbol="n", example=40, ge=1, le=10_000)
    overlap: float = quantity("length by which blocks overlap", unit="m", symbol="l", example=0.2, gt=0, le=3)
    thickness: float = quantity("thickness of a crossing wall", unit="m", symbol="t_s", example=0.5, gt=0, le=20)
    friction: float = quantity("coefficient of friction", symbol="mu", example=0.577, default=0.577, gt=0, le=2)
    walls: int = quantity("number of crossing walls", example=2, default=1, ge=1, le=100)
    height: float = length("height of the courses above the foot", symbol="h", example=8.0)
    density: float | None = quantity(
        "density of the crossing walls; if omitted, that of the structure", unit="kg/m3", default=None, gt=0, le=1e6
    )
    body: Name | None = Field(
        None, description="the body they hold, by its name in the picture; optional for a single body"
    )

    def force(self, density: float, gravity: float) -> float:
        """Return the friction force of one crossing wall [N].

        Parameters
        ----------
        density : float
            Density of the crossing walls [kg/m3].
        gravity : float
            Gravitational acceleration [m/s2].

        Examples
        --------
        >>> walls = Interlock(courses=40, overlap=0.2, thickness=0.5, walls=2, height=8.0)
        >>> round(walls.force(18000 / 9.80665, 9.80665))
        136264
        """
        n, course = self.courses, self.height / self.courses
        weight = density * gravity  # w, weight per volume [N/m3]
        return (
            COUNTED_SHARE
            * n
            * (n + 1)
            * (course / self.overlap)
            * self.friction
            * self.overlap**2
            * self.thickness
            * weight
        )

    def attached(self, foot: Spot, density: float, gravity: float) -> ConstantForce:
        """Return the friction of all crossing walls as one force on the body whose foot is at a point."""
        spot = Spot(foot.body, foot.at + 1j * FRICTION_HEIGHT * self.height)
        return ConstantForce(INTERLOCK_NAME, spot, complex(-self.walls * self.force(density, gravity)), friction=True)


def _unit_kind(value: Any) -> str | None:
    """Return the quantity that the unit of a text measures; None for other values."""
    parts = split(value) if isinstance(value, str) else None
    return kind_of(parts[1]) if parts is not None else None


Share = Annotated[float, Field(ge=0, le=1)]
Newtons = Annotated[float, Field(ge=-1e12, le=1e12)]
FLOOR_MATERIALS: dict[str, dict[str, float]] = {
    "borne": {"vertical": 1 / 3, "weight": 1 / 2},
    "sliding": {"horizontal": 0.0, "vertical": 1 / 3, "weight": 1 / 2},
    "dragged": {"horizontal": 1.0, "vertical": 1 / 3, "weight": 1 / 2},
}
"""Shares of the mass of a floor that turns about a support at its far end, by how the near end is supported."""
BY_UNIT = {
    ("mass", "mass per length"): "mass_per_metre", ("mass", "stiffness"): "mass_per_metre",
    ("mass", "mass per area"): "mass_per_area", ("mass", "pressure"): "mass_per_area",
    ("force", "stiffness"): "force_per_metre",
}  # fmt: skip
"""What `mass` and `force` are in a unit of a quantity; a weight per metre has that of a stiffness."""


class Load(Described):
    """A mass or a constant force at a point of a body.

    A mass counts by three shares, each 1 by default: in the horizontal inertia, in the vertical inertia and as weight.
    A force has no inertia.
    """

    name: Name = Field(description="what to call it")
    mass: float | None = quantity("its mass, or weight", unit="kg", example=1000.0, default=None, gt=0, le=1e12)
    mass_per_metre: float | None = quantity(
        "instead of mass: that of a metre of wall, over the depth of the structure; `mass: 12 kN/m` is this field",
        unit="kg/m", example=1200.0, default=None, gt=0, le=1e12,
    )  # fmt: skip
    mass_per_area: float | None = quantity(
        "instead of mass: that of a square metre of floor, with its span; `mass: 2.5 kN/m2` is this field",
        unit="kg/m2", example=250.0, default=None, gt=0, le=1e9,
    )  # fmt: skip
    span: float | None = quantity("span of that floor", unit="m", example=5.0, default=None, gt=0, le=1e3)
    force: Annotated[list[Newtons], Field(min_length=2, max_length=2)] | None = quantity(
        "a constant force [Fx, Fy], to the right and up", unit="N", example=[0.0, -1000.0], default=None
    )
    force_per_metre: Annotated[list[Newtons], Field(min_length=2, max_length=2)] | None = quantity(
        "instead of force: that of a metre of wall; `force: [4 kN/m, -9 kN/m]` is this field",
        unit="N/m", example=[0.0, -1000.0], default=None,
    )  # fmt: skip
    at: Vertex = point(
        "where it acts, [x, y] in the coordinates of `rocking draw`; of a block from the middle of its base, to the "
        "right and up"
    )
    body: Name | None = Field(
        None, description="the body it acts on, by its name in the picture; optional for a single body"
    )
    horizontal: Share | None = Field(None, description="share of the mass that moves sideways with the body")
    vertical: Share | None = Field(None, description="share that moves up with it")
    weight: Share | None = Field(None, description="share of the weight that the body carries")
    floor: Literal["borne", "sliding", "dragged"] | None = Field(
        None,
        description="sets the shares for a floor that is also supported at its far end; `mass` is then that of the "
        "whole floor",
    )
    seat: float | None = quantity(
        "bearing length of the supported member, such as a beam; its support is lost when it is displaced sideways by "
        "this length", unit="m",
        default=None, gt=0, le=100,
    )  # fmt: skip
    each: bool = Field(False, description="whether each of several bodies that move alike has one")

    @model_validator(mode="before")
    @classmethod
    def _by_its_unit(cls, data: Any) -> Any:
        """Take loads per metre or per area as such, and refuse a weight where a force or a share is expected."""
        if not isinstance(data, dict):
            return data
        for key in ("force", "weight"):
            if _unit_kind(data.get(key)) == "force":
                raise geometry_error(
                    key,
                    f"has two meanings in {data[key]}: write `mass: {data[key]}` for a weight that moves with the "
                    f"structure, or `force: [0, -{data[key]}]` for a force without inertia",
                )
        for key in data.keys() & {"mass", "force"}:
            values = data[key] if isinstance(data[key], list | tuple) else [data[key]]
            of_unit = next((each for value in values if (each := BY_UNIT.get((key, _unit_kind(value) or "")))), key)
            if of_unit not in data:
                data = {of_unit if name == key else name: value for name, value in data.items()}
        return data

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        kinds = ("mass", "mass_per_metre", "mass_per_area", "force", "force_per_metre")
        if [getattr(self, key) for key in kinds].count(None) != len(kinds) - 1:
            raise geometry_error("mass", "give one of `mass` and `force`, as a whole, per metre or per area")
        if (self.span is None) != (self.mass_per_area is None):
            raise geometry_error("span", "belongs to a load per area, such as `mass: 2.5 kN/m2`: give both")
        shares = [key for key in ("horizontal", "vertical", "weight") if getattr(self, key) is not None]
        if self.is_force and (shares or self.floor is not None):
            raise geometry_error(shares[0] if shares else "floor", "a force has no mass to share")
        if self.is_force and self.seat is not None:
            raise geometry_error("seat", "a force has no seat: it is of a mass")
        if self.floor is not None:
            for key in shares:
                if key in FLOOR_MATERIALS[self.floor]:
                    raise geometry_error(key, f"is already set by floor: {self.floor}; give one of the two")
        return self

    @property
    def is_force(self) -> bool:
        """Whether the load is a force, without a mass."""
        return self.force is not None or self.force_per_metre is not None

    @property
    def on_a_metre(self) -> float | None:
        """Mass on a metre of wall [kg/m]; None of a load that is given as a whole."""
        return self.mass_per_metre if self.mass_per_area is None else self.mass_per_area * (self.span or 0.0)

    def whole(self, depth: float | None) -> float | complex | None:
        """Return the mass [kg] or force [N] on a structure of a depth; None if that depth is needed and not given."""
        whole = self.mass if self.force is None else complex(*self.force)
        if whole is not None or depth is None:
            return whole
        return depth * (complex(*self.force_per_metre) if self.force_per_metre else self.on_a_metre or 0.0)

    @property
    def carried_in_words(self) -> str:
        """How much of the weight of a floor the structure carries, after its mass; empty for other loads."""
        if self.floor is None:
            return ""
        return (
            f", of which the structure carries {100 * FLOOR_MATERIALS[self.floor]['weight']:g} % (floor: {self.floor})"
        )

    def attached(self, body: str, whole: float | complex, count: float) -> PointMass | ConstantForce:
        """Return `count` such loads, each of a mass [kg] or a force [N], as one term of the equation of motion."""
        spot = Spot(body, complex(*self.at))
        if isinstance(whole, complex):
            return ConstantForce(self.name, spot, count * whole)
        shares = {"horizontal": self.horizontal, "vertical": self.vertical, "weight": self.weight}
        given_shares = {key: value for key, value in shares.items() if value is not None}
        return PointMass(
            self.name, spot, count * whole, **{**FLOOR_MATERIALS.get(self.floor or "", {}), **given_shares}
        )
