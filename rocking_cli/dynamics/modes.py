"""Ways in which redundant joints let go, where statics alone does not say what each bears.

The ground accelerations and rates under which some forces can be borne are a convex set at each rotation. Each edge of
it belongs to a motion of the pieces, a mode, that opens joints and closes none: at the edge the forces begin to do work
on it. A mode is followed as a single joint is where statics determines the forces (there the modes are the rows
themselves): with all others holding, it goes by 1/(xi.M xi) times the work that is missing, xi its velocities for an
opening of 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.contacts import Contact
from rocking_cli.core.released import ONE, PUSH, RATE, Pieces, Released

Reals = NDArray[np.float64]
NODES = 5  # rotations up to phi_cr at which edges are sought
WAYS = 8  # directions in which the set is first looked at; between corners it is then refined
MOST_CORNERS = 24  # of a set
FAR = 30.0  # times the acceleration at uplift, and the square of the fastest rate: beyond, nothing is sought
TIGHT = 1e-6  # of the largest velocity at a joint: one that does not move
ALONE = 1e-7  # of the largest singular value: a mode is the only one of its pattern
MOST_THROWN = 6  # modes of one impact
CLOSED = 1e-5  # of the largest velocity at a joint: by so much one may seem to close
SAME = 1e-6  # of the set: corners that are one


class Pattern(NamedTuple):
    """Which rows a mode leaves alone: of each contact the sense of its slip, and the ends that stay shut."""

    slips: tuple[int, ...]
    shut: tuple[tuple[bool, ...], ...]


class Modes(NamedTuple):
    """The modes of one direction over rotations, as rows.

    Parameters
    ----------
    released : Released
        A contact and a row for each mode.
    struck : ndarray, shape (modes, 2), or None
        Impulse of each at an impact that begins the direction, over the rate before; see `impulses`.
    """

    released: Released
    struck: Reals | None


def modes(mechanism: Mechanism, direction: Direction, phi: Reals, critical: float) -> Modes:
    """Find the modes in which the joints of a direction let go.

    Parameters
    ----------
    mechanism : Mechanism
        A structure with redundant joints.
    direction : Direction
        Direction of rocking.
    phi : ndarray, shape (n,)
        Rotations of the tables [rad].
    critical : float
        Rotation up to which the edges are sought [rad].
    """
    contacts = mechanism.contacts(direction) or ()
    there = _Placed(mechanism, direction, contacts, phi)
    within = np.flatnonzero(phi <= critical * (1 + TIGHT))
    places = np.unique(within[np.linspace(0, within.size - 1, NODES).astype(np.intp)])
    push = mechanism.uplift(direction) * mechanism.gravity
    fast = 2 * mechanism.potential_energy(np.array([critical]), direction)[0]
    fast /= float(mechanism.kinetic_inertia(np.zeros(1), direction)[0])
    patterns: dict[Pattern, None] = {}
    for k in places:
        for velocity in _edges(there, int(k), push, fast):
            patterns.setdefault(there.pattern(velocity, int(k)))
    jump = there.jump(mechanism)
    for velocity in _thrown(there, jump) if jump is not None else ():
        patterns.setdefault(there.pattern(velocity, 0))
    found = [each for each in (there.followed(pattern) for pattern in patterns) if each is not None]
    labels = [Contact((None, None), (0j,), name=there.label(each.velocity[0])) for each in found]
    names: dict[str, int] = {}
    for k, label in enumerate(labels):  # several modes may open one joint most
        names[label.name] = names.get(label.name, 0) + 1
        again = f" ({names[label.name]})" if names[label.name] > 1 else ""
        labels[k] = Contact((None, None), (0j,), name=f"{label.name}{again}")
    force = np.stack([each.force for each in found], axis=1) if found else np.zeros((phi.size, 0, 4))
    compliance = np.stack([each.compliance for each in found], axis=1) if found else np.zeros((phi.size, 0))
    struck = None if jump is None else np.array([each.velocity[0] @ jump for each in found]).reshape(-1, 2)
    rows: list[tuple[tuple[int, ...], int | None]] = [((k,), k) for k in range(len(found))]
    return Modes(Released(labels, rows, force, compliance), struck)


class _Followed(NamedTuple):
    """A mode over rotations: velocities (n, coordinates), force (n, 4) and compliance (n,) for an opening of 1."""

    velocity: Reals
    force: Reals
    compliance: Reals


class _Placed:
    """The rates at the contacts of a direction, and what they must bear, over rotations."""

    def __init__(self, mechanism: Mechanism, direction: Direction, contacts: Sequence[Contact], phi: Reals) -> None:
        self._direction, self._contacts = direction, contacts
        self.pieces = Pieces(mechanism, direction, phi)
        self.rates, self.rows = self.pieces.rates(contacts)
        self.demand = self.pieces.demands()
        self.one_sided = np.zeros(self.rates.shape[1], bool)
        for normal, _ in self.rows:
            self.one_sided[list(normal)] = True

    def friction(self, k: int) -> float | None:
        """Coefficient of friction of a contact; None if it never slides."""
        return self._contacts[k].friction

    def label(self, velocity: Reals) -> str:
        """What to call the contact that a mode opens most, at the first rotation."""
        speed = np.abs(self.rates[0] @ velocity)
        most = [max((speed[row] for row in (*normal, *([] if shear is None else [shear]))), default=0.0)
                for normal, shear in self.rows]  # fmt: skip
        return self._contacts[int(np.argmax(most))].label

    def jump(self, mechanism: Mechanism) -> Reals | None:
        """The jump of momentum at an impact over the rate before, a constant and a factor of the restitution."""
        if not mechanism.rocks_both_ways:
            return None
        old = Pieces(mechanism, self._direction.opposite, np.zeros(1))
        return np.stack([old.momentum(old.dq)[0], self.pieces.momentum(self.pieces.dq)[0]], axis=-1)

    def pattern(self, velocity: Reals, k: int) -> Pattern:
        """Which rows a mode leaves alone at a rotation."""
        speed = self.rates[k] @ velocity
        still = TIGHT * float(np.abs(speed).max())
        slips, shut = [], []
        for contact, (normal, shear) in zip(self._contacts, self.rows, strict=True):
            slip = 0.0 if shear is None or contact.friction is None else float(speed[shear])
            sense = 0 if abs(slip) <= still else int(np.sign(slip))
            dilates = abs(slip) * (contact.friction or 0.0) if sense else 0.0
            slips.append(sense)
            shut.append(tuple(bool(speed[row] - dilates <= still) for row in normal))
        return Pattern(tuple(slips), tuple(shut))

    def held(self, pattern: Pattern, *, dilates: bool) -> Reals:
        """The rows that a mode leaves alone, shape (n, rows, coordinates)."""
        found: list[Reals] = []
        taken = np.zeros(self.rates.shape[1], bool)
        for contact, (normal, shear), slip, shut in zip(
            self._contacts, self.rows, pattern.slips, pattern.shut, strict=True
        ):
            for row, closed in zip(normal, shut, strict=True):
                taken[row] = True
                if not closed:
                    continue
                mine = self.rates[:, row]
                if slip and dilates and shear is not None:
                    mine = mine - slip * (contact.friction or 0.0) * self.rates[:, shear]
                found.append(mine)
            if shear is not None:
                taken[shear] = True
                if not slip:
                    found.append(self.rates[:, shear])
        found += [self.rates[:, row] for row in np.flatnonzero(~taken)]  # guides
        return np.stack(found, axis=1)

    def followed(self, pattern: Pattern) -> _Followed | None:
        """A mode over all rotations; None if its rows leave more than one way to move at rest."""
        alone = self._alone(self.held(pattern, dilates=True))
        if alone is None:
            return None
        velocity, exists = alone
        speed = np.einsum("nrc,nc->nr", self.rates, velocity)
        opens = speed[:, self.one_sided]
        sign = np.where(opens.max(axis=1, initial=0) >= -opens.min(axis=1, initial=0), 1.0, -1.0)
        factor = sign / np.abs(speed).max(axis=1)
        velocity, speed = velocity * factor[:, None], speed * factor[:, None]
        force = np.einsum("nc,ncf->nf", velocity, self.demand)
        force[~(exists & self._closes_nothing(speed))] = self._bears
        plain = velocity
        if any(pattern.slips):  # what slides does not dilate as it goes
            without = self._alone(self.held(pattern, dilates=False))
            if without is not None:
                size = np.abs(np.einsum("nrc,nc->nr", self.rates, without[0])).max(axis=1)
                plain = without[0] / size[:, None]
        moving = self.pieces.momentum(plain)
        return _Followed(velocity, force, 1 / np.einsum("nc,nc->n", plain, moving))

    @property
    def _bears(self) -> Reals:
        """The force of a mode where it does not exist: it bears whatever comes."""
        whole = np.zeros(4)
        whole[ONE] = np.abs(self.demand[0, :, ONE]).sum()
        return whole

    def _closes_nothing(self, speed: Reals) -> NDArray[np.bool_]:
        """Whether no joint would have to close, or to slide without dilating, shape (n,)."""
        good = np.ones(len(speed), bool)
        for contact, (normal, shear) in zip(self._contacts, self.rows, strict=True):
            slip = np.abs(speed[:, shear]) if shear is not None else 0.0
            for row in normal:
                good &= speed[:, row] >= (contact.friction or 0.0) * slip - CLOSED
        return good

    def _alone(self, held: Reals) -> tuple[Reals, NDArray[np.bool_]] | None:
        """The velocities that leave rows alone, without those of rocking itself, shape (n, coordinates).

        And at which rotations there are any; elsewhere they are those of a rotation before.
        """
        scale = self.pieces.scale
        rocking = self.pieces.momentum(self.pieces.dq) / scale
        rocking /= np.linalg.norm(rocking, axis=1, keepdims=True)
        matrix = np.concatenate([held / scale, rocking[:, None, :]], axis=1)
        unknown = matrix.shape[2]
        _, s, vt = np.linalg.svd(matrix, full_matrices=matrix.shape[1] < unknown)
        padded = np.zeros((len(s), unknown))
        padded[:, : s.shape[1]] = s
        if padded[0, -2] < ALONE * padded[0, 0]:
            return None
        found = vt[:, -1] / scale
        flips = np.sign(np.einsum("nc,nc->n", found[1:], found[:-1]))
        found[1:] *= np.cumprod(np.where(flips == 0, 1.0, flips))[:, None]
        # Where its rows leave more, or nothing, it is what it was before.
        good = (padded[:, -2] >= ALONE * padded[:, 0]) & (padded[:, -1] <= TIGHT * padded[:, 0])
        last = np.maximum.accumulate(np.where(good, np.arange(len(good)), 0))
        return found[last], good


def _edges(there: _Placed, k: int, push: float, fast: float) -> Iterator[Reals]:
    """The modes of the edges of the set of (u_g'', phi.^2) at a rotation."""
    unit = np.array([push, fast])
    corners: list[tuple[float, Reals]] = []  # the direction that found each, and its place
    ways = [2 * np.pi * i / WAYS for i in range(WAYS)]
    while ways:
        way = ways.pop()
        solved = _corner(there, k, np.array([np.cos(way), np.sin(way)]) / unit, unit)
        if solved is None:
            continue
        place, velocity = solved
        if velocity is not None:
            yield velocity
        if any(np.abs(place - other).max() <= SAME for _, other in corners) or len(corners) >= MOST_CORNERS:
            continue
        corners.append((way, place))
        middle = np.mean([each for _, each in corners], axis=0)
        corners.sort(key=lambda corner: float(np.arctan2(*(corner[1] - middle)[::-1])))
        at = next(i for i, (_, other) in enumerate(corners) if other is place)
        for one, other in ((corners[at - 1][1], place), (place, corners[(at + 1) % len(corners)][1])):
            side = other - one
            if np.abs(side).max() > SAME:
                ways.append(float(np.arctan2(-side[0], side[1])))


def _corner(there: _Placed, k: int, way: Reals, unit: Reals) -> tuple[Reals, Reals | None] | None:
    """The farthest (u_g'', phi.^2) that can be borne in a direction, over `unit`; and the mode that lets go there."""
    from scipy.optimize import linprog  # slow to import, and only redundant joints need it

    rates, demand, scale = there.rates[k], there.demand[k], there.pieces.scale
    count = len(rates)
    equal = np.column_stack([rates.T, -demand[:, PUSH] * unit[0], -demand[:, RATE] * unit[1]]) / scale[:, None]
    size = float(np.abs(demand[:, ONE]).max())
    low = np.where(there.one_sided, 0.0, -np.inf)
    bounds = [*((each, None) for each in low), (-FAR, FAR), (0.0, FAR)]
    cones = []
    for j, (normal, shear) in enumerate(there.rows):
        friction = there.friction(j)
        if friction is None or shear is None:
            continue
        for sense in (1.0, -1.0):
            row = np.zeros(count + 2)
            row[list(normal)], row[shear] = -friction, sense
            cones.append(row)
    cost = np.append(np.zeros(count), -way * unit)
    equal[:, :count] *= size
    solved = linprog(
        cost, A_eq=equal, b_eq=demand[:, ONE] / scale, bounds=bounds, method="highs-ds",
        A_ub=np.array(cones) if cones else None, b_ub=np.zeros(len(cones)) if cones else None,
    )  # fmt: skip
    if solved.status != 0:
        return None
    place = np.asarray(solved.x[count:])
    velocity = -np.asarray(solved.eqlin.marginals) / scale
    work = float(velocity @ demand[:, [ONE, PUSH, RATE]] @ np.array([1.0, place[0] * unit[0], place[1] * unit[1]]))
    moves = np.abs(rates @ velocity).max() > 0
    at_edge = abs(work) <= SAME * float(np.abs(velocity) @ np.abs(demand[:, ONE]) or 1.0)
    return place, velocity if moves and at_edge else None


def _thrown(there: _Placed, jump: Reals) -> Iterator[Reals]:
    """The modes on which the impulses of an impact do work against what holds them, the one with most work first."""
    from scipy.optimize import linprog  # slow to import, and only redundant joints need it

    rates, scale = there.rates[0], there.pieces.scale
    total = jump.sum(axis=1)  # with all of the rate kept: the most that is thrown
    above: list[Reals] = []
    free = np.ones(len(rates), bool)
    for j, (normal, shear) in enumerate(there.rows):
        friction = there.friction(j)
        for row in normal:
            free[row] = False
            if shear is None or not friction:
                above.append(-rates[row])
            else:
                above += [sense * friction * rates[shear] - rates[row] for sense in (1.0, -1.0)]
        if shear is not None and friction is not None:
            free[shear] = False
    normals = np.flatnonzero(there.one_sided)
    above.append(rates[normals].sum(axis=0))
    most = np.append(np.zeros(len(above) - 1), 1.0)
    held = [*(rates[row] for row in np.flatnonzero(free)), there.pieces.momentum(there.pieces.dq)[0]]
    for _ in range(MOST_THROWN):
        solved = linprog(
            total / scale, A_ub=np.array(above) / scale, b_ub=most, A_eq=np.array(held) / scale,
            b_eq=np.zeros(len(held)), bounds=(None, None), method="highs-ds",
        )  # fmt: skip
        if solved.status != 0 or solved.fun > -TIGHT * float(np.abs(total / scale).max()):
            return
        velocity = np.asarray(solved.x) / scale
        yield velocity
        held.append(rates[normals[int(np.argmax(rates[normals] @ velocity))]])  # the next keeps that end shut
