"""Where the bodies of a structure are, and what its energies make of that.

A point is x + iy of the structure at rest, in metres. In what moves, x and y are two functions of their own: both are
taken off the real axis, to be differentiated.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

from .series import RADIUS, Booleans, Complexes, Reals, around, derivatives, differentiated

GROUND = "ground"
SIDES = (1, -1)
Point = complex | NDArray[Any]  # one point, or the many points of a bed
Slips = Mapping[str, tuple[complex, complex]]  # by how much a freed joint has parted, x and y
WHOLE: Slips = {}


class Rigid(NamedTuple):
    """A rigid body: its point `rest` is at (x, y), and it has turned anticlockwise by psi."""

    rest: complex
    x: Any
    y: Any
    psi: Any

    def at(self, point: Point) -> tuple[Any, Any]:
        """Where a point of it is."""
        arm = np.asarray(point)[..., None] - self.rest
        cos, sin = np.cos(self.psi), np.sin(self.psi)
        return self.x + arm.real * cos - arm.imag * sin, self.y + arm.real * sin + arm.imag * cos


FIXED = Rigid(0j, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Piece:
    """Mass and central inertia of a rigid body, and where its centroid is at rest."""

    name: str
    mass: float
    inertia: float
    centre: complex


@dataclass(frozen=True)
class Load:
    """A mass at a point of a body, and the shares of it that resist motion in x and y and that weigh."""

    body: str
    at: complex
    mass: float
    horizontal: float = 1.0
    vertical: float = 1.0
    weight: float = 1.0


class Springs(NamedTuple):
    """Springs in a row."""

    k: Reals
    n0: Reals
    acts: Reals  # 1: tension only, -1: compression only, 0: both


@dataclass(frozen=True)
class Link:
    """A path over points of bodies; of a bed, the paths of all its springs at once."""

    path: tuple[tuple[str, Complexes], ...]
    springs: Springs


Mode = Booleans  # whether every spring bears


class Terms(NamedTuple):
    """What T and V give at one rotation; ' is d/dphi."""

    inertia: float  # 2 T / phi.^2
    d_inertia: float
    V: float
    dV: float
    ddV: float
    G: float  # sum w M y'
    X: float  # sum h M x'


@dataclass(frozen=True, kw_only=True)
class Structure(ABC):
    """Bodies that rock in two directions, and what is hung on them. Each `with_` gives another structure."""

    gravity: float = 9.80665
    loads: tuple[Load, ...] = ()
    links: tuple[Link, ...] = ()
    forces: tuple[tuple[str, complex, complex], ...] = ()

    # What a structure says of itself.

    @abstractmethod
    def pieces(self) -> Sequence[Piece]:
        """Its rigid bodies."""

    @abstractmethod
    def place(self, s: int, phi: Any, slips: Slips = WHOLE) -> Sequence[Rigid]:
        """Where they are at the rotation phi in direction s, were the joints to part by `slips`."""

    @abstractmethod
    def joints(self) -> Sequence[str]:
        """The names of its joints."""

    def locks(self, s: int) -> float:
        """The rotation at which it lies flat or can turn no further."""
        return pi / 2

    # What is hung on it.

    def with_load(
        self,
        body: str,
        at: complex,
        mass: float,
        horizontal: float = 1.0,
        vertical: float = 1.0,
        weight: float = 1.0,
    ) -> Self:
        """With a mass [kg] at a point of a body."""
        return replace(self, loads=(*self.loads, Load(body, at, mass, horizontal, vertical, weight)))

    def with_force(self, body: str, at: complex, force: complex) -> Self:
        """With a force Fx + i Fy [N], constant in size and direction, on a point of a body."""
        return replace(self, forces=(*self.forces, (body, at, force)))

    def with_tie(
        self,
        *path: tuple[str, Point],
        k: Any = 0.0,
        n0: Any = 0.0,
        acts: str = "tension",
    ) -> Self:
        """With a tie over the points of `path`, each a body (or "ground") and a point of it: N = n0 + k e.

        `acts` in "tension", "compression" or in "both".
        """
        points = tuple((body, np.atleast_1d(np.asarray(point, complex))) for body, point in path)
        size = max(len(point) for _, point in points)
        sense = {"tension": 1, "compression": -1, "both": 0}[acts]
        springs = Springs(*(np.broadcast_to(np.asarray(number, float), size) for number in (k, n0, sense)))
        return replace(self, links=(*self.links, Link(points, springs)))

    def with_bed(
        self, body: str, start: complex, end: complex, k: float, n0: float = 0.0, springs: int = 40, **more: Any
    ) -> Self:
        """With springs along a face of a body from `start` to `end`, tied to the ground where they are at rest.

        k [N/m] and n0 [N] are of each metre. The springs stand at the points of Gauss's rule and have its weights.
        """
        nodes, weights = np.polynomial.legendre.leggauss(springs)
        points = start + (end - start) * (1 + nodes) / 2
        share = abs(end - start) * weights / 2
        return self.with_tie((GROUND, points), (body, points), k=k * share, n0=n0 * share, **more)

    # Where all of it is.

    @cached_property
    def springs(self) -> Springs:
        """Those of all links."""
        none = [Springs(*[np.zeros(0)] * len(Springs._fields))]
        return Springs(
            *(np.concatenate(row) for row in zip(*none, *(link.springs for link in self.links), strict=True))
        )

    @cached_property
    def _points(self) -> tuple[tuple[Piece, ...], Mapping[str, int]]:
        pieces = tuple(self.pieces())
        return pieces, {piece.name: i for i, piece in enumerate(pieces)}

    def body(self, bodies: Sequence[Rigid], name: str) -> Rigid:
        """The body of that name among those of `place`."""
        return FIXED if name == GROUND else bodies[self._points[1][name]]

    def masses(self, bodies: Sequence[Rigid]) -> tuple[Reals, Reals, Reals, Any, Any]:
        """h M, v M, w M and x and y of all bodies and loads."""
        points = [body.at(piece.centre) for piece, body in zip(self._points[0], bodies, strict=True)]
        shares = [[piece.mass] * 3 for piece in self._points[0]]
        for load in self.loads:
            points.append(self.body(bodies, load.body).at(load.at))
            shares.append([load.mass * share for share in (load.horizontal, load.vertical, load.weight)])
        h, v, w = np.array(shares).T
        return h, v, w, np.array([x for x, _ in points]), np.array([y for _, y in points])

    def spans(self, bodies: Sequence[Rigid]) -> list[list[tuple[Any, Any, Any]]]:
        """Of each link the pieces of its path: x and y from one point to the next, and their length at rest."""
        found = []
        for link in self.links:
            ends = [self.body(bodies, name).at(point) for name, point in link.path]
            rest = [point for _, point in link.path]
            found.append(
                [
                    (np.atleast_2d(ends[i + 1][0] - ends[i][0]), np.atleast_2d(ends[i + 1][1] - ends[i][1]),
                     abs(rest[i + 1] - rest[i]))
                    for i in range(len(ends) - 1)
                ]
            )  # fmt: skip
        return found

    def elongations(self, s: int, phi: Any, bodies: Sequence[Rigid] | None = None) -> Any:
        """How much longer every spring is than at rest, springs by rotations."""
        bodies = self.place(s, phi) if bodies is None else bodies
        rows = []
        for pieces in self.spans(bodies):
            total: Any = 0.0
            for x, y, rest in pieces:
                # Of points that are one at rest, length is analytic in phi only with the sign of phi.
                unit = np.where((rest[:, None] < 1e-12) & (phi != 0), phi, 1.0)
                total = total + unit * np.sqrt((x**2 + y**2) / unit**2) - rest[:, None]
            rows.append(total)
        return np.concatenate(rows) if rows else np.zeros((0, np.size(phi)))

    def trial(self, e: Any) -> Any:
        """n0 + k e."""
        return self.springs.n0 + self.springs.k * e

    def pull(self, mode: Mode, e: Any) -> Any:
        """The axial forces at elongations e, as if no spring changed its mode."""
        return np.where(mode, self.trial(e), 0.0)

    def stored(self, mode: Mode, e: Any) -> Any:
        """The elastic energy in the springs: N^2/2k also with a prestress or a slack, n0 e of a constant force."""
        k, n0 = self.springs.k, self.springs.n0
        energy = np.where(k == 0, n0 * e, self.trial(e) ** 2 / (2 * np.where(k == 0, 1.0, k)))
        return np.where(mode, energy, 0.0)

    # Derivatives.

    @cached_property
    def _locks(self) -> Mapping[int, float]:
        return {s: self.locks(s) for s in SIDES}

    def limit(self, s: int) -> float:
        """The rotation at which it has fallen; where a linkage locks its motion has no derivative any more."""
        return 0.97 * self._locks[s]

    def radius(self, s: int, phi: float) -> float:
        """Of a circle that stays away from there."""
        return min(RADIUS, max(0.2 * (self._locks[s] - phi), 1e-3))

    def derivatives(self, s: int, phi: float, values: Callable[[Complexes], Any], order: int) -> Reals:
        """Value and derivatives at phi of a function of the rotation."""
        radius = self.radius(s, phi)
        return derivatives(values(around(phi, radius)), order, radius)

    # Modes.

    def fresh(self, s: int, phi: float) -> Mode:
        """The springs after a first slow push from rest to phi."""
        return self._bearing(self.trial(self.elongations(s, np.array([phi]))[:, 0]), self.levers(s, phi))

    def levers(self, s: int, phi: float) -> Reals:
        """L' of every spring."""
        lever: Reals = self.derivatives(s, phi, lambda circle: self.elongations(s, circle), 1)[1]
        return lever

    def _bearing(self, n: Reals, rate: Reals) -> Booleans:
        side = self.springs.acts * np.where(abs(n) > self._tiny, n, self.springs.k * rate)
        return np.asarray((self.springs.acts == 0) | (side > 0))

    @cached_property
    def _tiny(self) -> Reals:
        """Forces that are none."""
        return np.asarray(1e-12 * (abs(self.springs.n0) + self.springs.k))

    def settled(self, s: int) -> Mode:
        """The springs where a motion sets out from phi = 0 in direction s."""
        return self._bearing(self.springs.n0, self.levers(s, 0.0))

    # Lagrange.

    def terms(self, s: int, phi: float, mode: Mode | None = None) -> Terms:
        """T and V and their derivatives at phi, the springs in `mode`, or as a slow push from rest leaves them."""
        mode = self.fresh(s, phi) if mode is None else mode
        radius = self.radius(s, phi)
        circle = around(phi, radius)
        bodies = self.place(s, circle)
        h, v, w, x, y = self.masses(bodies)
        spin = np.array([np.broadcast_to(body.psi, circle.shape) for body in bodies])
        e = self.elongations(s, circle, bodies)
        speeds = [differentiated(values, radius) for values in (x, y, spin)]
        moments = [piece.inertia for piece in self._points[0]]
        inertia: Any = 0.0
        for shares, speed in zip((h, v, moments), speeds, strict=True):
            inertia = inertia + np.asarray(shares) @ speed**2
        V = self.gravity * (w @ (y - self._rest_heights[:, None]))
        for name, at, force in self.forces:
            px, py = self.body(bodies, name).at(at)
            V = V - force.real * (px - at.real) - force.imag * (py - at.imag)
        V = V + self.stored(mode, e.T).sum(axis=1)
        A, dA = derivatives(inertia, 1, radius)
        V0, dV, ddV = derivatives(V, 2, radius)
        G, X = (float(derivatives(sums, 1, radius)[1]) for sums in (w @ y, h @ x))
        return Terms(float(A), float(dA), float(V0), float(dV), float(ddV), G, X)

    @cached_property
    def _rest_heights(self) -> Reals:
        centres = [piece.centre for piece in self._points[0]] + [load.at for load in self.loads]
        return np.array(centres).imag

    def acceleration(
        self, s: int, phi: float, rate: float, u: float = 0.0, v: float = 0.0, mode: Mode | None = None
    ) -> float:
        """phi.. by d/dt (dT/dphi.) - dT/dphi + dV/dphi = 0 in the frame of a ground that accelerates by u and v."""
        it = self.terms(s, phi, mode)
        return -(it.d_inertia / 2 * rate**2 + it.dV + v * it.G + u * it.X) / it.inertia

    # What follows at once.

    def critical(self, s: int) -> float | None:
        """phi_cr: where V' passes through zero, downwards and without a jump; none before the limit, then None."""
        scan = np.linspace(0.0, self.limit(s), 160)

        def slope(phi: float) -> float:
            return self.terms(s, phi).dV

        values = [slope(phi) for phi in scan]
        for i in range(len(scan) - 1):
            if values[i] > 0 >= values[i + 1]:
                phi = float(brentq(slope, scan[i], scan[i + 1], xtol=1e-15, rtol=1e-14))
                return phi if abs(slope(phi)) < 1e-9 * values[0] else None
        return None

    def _critical(self, s: int) -> float:
        phi = self.critical(s)
        assert phi is not None, "no phi_cr"
        return phi

    def overturning_velocity(self, s: int) -> float:
        """The step of ground velocity, from rest, after which the structure just reaches phi_cr [m/s]."""
        rest = self.terms(s, 0.0)
        barrier, _ = quad(
            lambda phi: self.terms(s, phi).dV, 0.0, self._critical(s), epsabs=0.0, epsrel=1e-10, limit=200
        )
        # A step du of the ground gives the momentum -X du, hence the rate X du/A and the energy (X du)^2/2A.
        return float(np.sqrt(2 * rest.inertia * barrier) / abs(rest.X))

    def fields(self, s: int) -> tuple[Reals, Reals]:
        """Velocities per unit phi. at rest of all that has inertia, and the inertias: x, y, rotations."""
        circle = around(0.0)
        bodies = self.place(s, circle)
        h, v, _, x, y = self.masses(bodies)
        spin = np.array([np.broadcast_to(body.psi, circle.shape) for body in bodies])
        inertia = [piece.inertia for piece in self._points[0]]
        return derivatives(np.concatenate([x, y, spin]), 1)[1], np.concatenate([h, v, inertia])

    def eta(self, s: int) -> float:
        """Restitution where direction s ends: the jump of momentum does no work in the new mechanism."""
        (old, mass), (new, _) = self.fields(s), self.fields(-s)
        return float(-(old * mass) @ new / ((new * mass) @ new))
