"""Forces at each joint of a rocking mechanism, and its acceleration if this joint alone were released.

With the motion given, the forces at the contacts follow from the equations of motion of every piece. A contact fails if
its normal force is negative, or its shear force exceeds friction. Released alone, with all others closed, it opens with
the acceleration -c N, c = 1/(A^-1)_ii with A = J M^-1 J^T, M the mass matrix, and J the derivative of the velocities at
the contacts by those of the pieces. Forces are affine in u_g'', phi.^2 and v_g'', so that tables over the rotation
suffice.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking_cli.core.bounds import Bound
from rocking_cli.core.contacts import Contact, Piece
from rocking_cli.core.hung.attached import Path, PointMass, Spot
from rocking_cli.core.kinematics import Direction, Integers, Points, Rates, Reals, RigidMotion, VelocityTerm, rotation
from rocking_cli.core.mechanism import Mechanism

MIN_PIVOT = 1e-9  # 1/largest entry of the inverse of the rates over the size: below, forces are not determined
MAX_ENTRIES = 1_000_000  # entries of the matrices that are inverted at once: 8 MB of each
MASSLESS_SHARE = 1e-12  # mass given to a piece without mass, over the largest mass
ONE, PUSH, RATE, WEIGHT = range(4)  # columns of tables of forces: the factors of 1, u_g'', phi.^2 and v_g''


@dataclass(frozen=True, eq=False)
class Released:
    """Forces and compliances of all contacts of one direction, over rotations; a row for each force component.

    Parameters
    ----------
    contacts : sequence of Contact
        Contacts of the direction, with guides.
    rows : sequence of (tuple of int, int or None)
        For each contact, the rows of its normal forces (one for each point) and the row of its shear force; a guide has
        neither, unless a load presses on it: then the row of this load, and that of the force that the guide exerts.
    force : ndarray, shape (n, rows, 4)
        Force of each row [N]: its coefficients of 1, u_g'', phi.^2 and v_g''.
    compliance : ndarray, shape (n, rows)
        Acceleration of a contact that is released alone, divided by the force it would carry if closed [1/kg].
    """

    contacts: Sequence[Contact]
    rows: Sequence[tuple[tuple[int, ...], int | None]]
    force: Reals
    compliance: Reals


class Undetermined(Exception):
    """Error: statics alone does not determine the forces at the joints.

    Parameters
    ----------
    redundant : bool
        Whether there are too many joints (True) or too few (False).
    """

    def __init__(self, redundant: bool) -> None:
        super().__init__()
        self.redundant = redundant


def released(mechanism: Mechanism, direction: Direction, phi: Reals) -> Released | None:
    """Tabulate the forces at the contacts of a direction; None if the mechanism does not give its contacts.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism, with loads and ties.
    direction : Direction
        Direction of rocking.
    phi : ndarray, shape (n,)
        Rotations inside the direction [rad], >= 0, below the kinematic limit.

    Returns
    -------
    Released or None
        Tables of forces and compliances; None if the mechanism does not give its contacts.

    Raises
    ------
    Undetermined
        If the forces do not follow from the motion.
    """
    contacts = mechanism.contacts(direction)
    if not contacts:  # the mechanism names no joints
        return None
    _check_count(contacts, mechanism.pieces(direction))
    pieces = Pieces(mechanism, direction, np.asarray(phi, np.float64))
    rates, rows = pieces.rates(contacts)
    force, compliance = _solved(rates, pieces, pieces.demands())
    pressing = [pieces.pressing(contact) for contact in contacts if contact.pressed_by]
    if pressing:  # add a row for each load that presses on a guide; such a load never lifts off
        force = np.concatenate([force, np.stack(pressing, axis=1)], axis=1)
        compliance = np.concatenate([compliance, np.zeros((len(force), len(pressing)))], axis=1)
    return Released(contacts, _with_loads(contacts, rows), force, compliance)


def tabulated_impulses(mechanism: Mechanism, ended: Direction) -> Reals | None:
    """Tabulate the impulses at the contacts of the direction that begins with an impact.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism that rocks both ways and gives its contacts, with loads and ties.
    ended : Direction
        The direction that the impact ends.

    Returns
    -------
    ndarray, shape (rows, 2), or None
        Impulse of each row of `released` in the other direction over the rate before the impact [N s per rad/s]: a
        constant, and the factor of the restitution. None if the structure rebounds from a side wall.

    Raises
    ------
    Undetermined
        If the impulses do not follow from the motion.
    """
    if not mechanism.rocks_both_ways:
        return None
    contacts = mechanism.contacts(ended.opposite)
    if not contacts:  # the mechanism names no joints
        return None
    _check_count(contacts, mechanism.pieces(ended.opposite))
    rest = np.zeros(1)
    old, new = (Pieces(mechanism, direction, rest) for direction in (ended, ended.opposite))
    rates, _ = new.rates(contacts)
    # The velocities are -t_s before and eta t_-s after the impact, with t the derivatives by phi.
    jump = np.stack([old.momentum(old.dq), new.momentum(new.dq)], axis=-1)
    pressing = [[old.thrown(contact), new.thrown(contact)] for contact in contacts if contact.pressed_by]
    return np.concatenate([_solved(rates, new, jump)[0][0], np.reshape(pressing, (-1, 2))])


def stop_impulses(mechanism: Mechanism, direction: Direction, bound: Bound) -> Reals:
    """Return the impulses at the contacts of a direction where a stop takes its rate away.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism that gives its contacts.
    direction : Direction
        The direction.
    bound : Bound
        The stop: its rotation, and the body and its point that meet it.

    Returns
    -------
    ndarray, shape (rows,)
        Impulse of each row of `released`, over the rate that the stop takes [N s per rad/s].

    Raises
    ------
    Undetermined
        If the impulses do not follow from the motion.
    """
    contacts = mechanism.contacts(direction) or ()
    pieces = Pieces(mechanism, direction, np.array([bound.phi]))
    piece = mechanism.piece_at(bound.body, bound.at, direction)
    face = Contact((None, piece), (bound.at,), 1 + 0j, held="slide")
    rates, _ = pieces.rates([*contacts, face])
    # J^T P = M (q._after - q._before), with the force of the stop, which is not known either, as its last row.
    jacobian = rates.dense()[0] / pieces.scale
    momentum = -pieces.momentum(pieces.dq)[0] / pieces.scale
    return np.asarray((inverted(jacobian[None])[0].T @ momentum)[:-1])


def _with_loads(
    contacts: Sequence[Contact], rows: Sequence[tuple[tuple[int, ...], int | None]]
) -> Sequence[tuple[tuple[int, ...], int | None]]:
    """Return the rows of contacts with those of guides under a load, whose own rows come after all others."""
    all_rows, next_row = list(rows), sum(contact.forces for contact in contacts)
    for k, contact in enumerate(contacts):
        if contact.pressed_by:
            all_rows[k] = ((next_row,), sum(each.forces for each in contacts[:k]))
            next_row += 1
    return all_rows


def _check_count(contacts: Sequence[Contact], pieces: Sequence[Piece]) -> None:
    """Raise `Undetermined` unless the joints have as many force components as leave one degree of freedom."""
    forces, equations = sum(contact.forces for contact in contacts), 3 * len(pieces)
    if forces != equations - 1:
        raise Undetermined(forces >= equations)


def _solved(rates: Rates, pieces: Pieces, demand: Reals) -> tuple[Reals, Reals]:
    """Return the forces that balance the demands, shape (n, rows, k), and the compliances, shape (n, rows).

    The matrix of the rates, with the momentum of rocking as a further row, is inverted. Column i of the inverse has the
    velocities xi of all pieces if row i alone is released. The force of this row is xi.b, with b the demand, and
    (A^-1)_ii = xi.M xi.
    """
    # Rotations times the size of the structure, or those of small pieces would be lost.
    scale = pieces.scale
    rocking = pieces.momentum(pieces.dq) / scale
    rocking /= np.linalg.norm(rocking, axis=1, keepdims=True)
    force, compliance = [], []
    parts = min(len(rocking), -(-rocking.size * rocking.shape[1] // MAX_ENTRIES))
    for part in np.array_split(np.arange(len(rocking)), parts):
        square = np.concatenate([rates.rotations(part).dense() / scale, rocking[part, None, :]], axis=1)
        released = inverted(square)[:, :, :-1] / scale[:, None]
        moving = pieces.momenta(released, part)
        force.append(released.swapaxes(1, 2) @ demand[part])
        compliance.append(1 / np.einsum("nir,nir->nr", released, moving))
    return np.concatenate(force), np.concatenate(compliance)


def inverted(square: Reals) -> Reals:
    """Return the inverses of matrices of rates over the size. Raises `Undetermined` if they are as good as singular."""
    try:
        inverse = np.linalg.inv(square)
    except np.linalg.LinAlgError:
        raise Undetermined(redundant=False) from None
    if np.abs(inverse).max() > 1 / MIN_PIVOT:
        raise Undetermined(redundant=False)
    return np.asarray(inverse)


class Pieces:
    """The pieces of a mechanism at some rotations, with coordinates x, y and rotation of each piece in sequence.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism, with loads and ties.
    direction : Direction
        Direction of rocking.
    phi : ndarray, shape (n,)
        Rotations [rad].
    """

    def __init__(self, mechanism: Mechanism, direction: Direction, phi: Reals) -> None:
        self._mechanism, self._direction, self.phi = mechanism, direction, phi
        motions = {
            body.name: motion for body, motion in zip(mechanism.bodies(), mechanism.motion(phi, direction), strict=True)
        }
        self._parts = mechanism.pieces(direction)
        self._still = rotation(phi, 0j, 0.0)
        self._motions: Mapping[str, RigidMotion] = {
            each.body.name: self._still if each.of is None else motions[each.of].shifted(each.shift)
            for each in self._parts
        }
        self._column = {each.body.name: 3 * k for k, each in enumerate(self._parts)}
        self._centres = {
            each.body.name: self._motions[each.body.name].carry(each.body.centroid) for each in self._parts
        }
        self.dq, self.ddq = (self._coordinates(k) for k in (1, 2))
        attached = (*(mechanism.loads or ()), *(mechanism.ties or ()))
        self._each = {attachment.name for attachment in attached if attachment.each}
        masses = (load for load in mechanism.attached if isinstance(load, PointMass))
        self._masses = [mass for mass in masses if self._moves(mass.spot)]
        self.mass = self._mass()

    @property
    def scale(self) -> Reals:
        """Scale of each coordinate, shape (3 pieces,): 1 for a displacement, the structure's size for a rotation."""
        middles = np.array([each.body.centroid for each in self._parts])
        size = max(float(np.abs(middles - middles.mean()).max()), *(
            float(np.sqrt(each.body.inertia / each.body.mass)) if each.body.mass > 0 else 0.0 for each in self._parts
        )) or 1.0  # fmt: skip
        return np.tile([1.0, 1.0, size], len(self._parts))

    def _coordinates(self, order: int) -> Reals:
        derivatives = np.zeros((self.phi.size, 3 * len(self._parts)))
        for name, k in self._column.items():
            at, motion = self._centres[name][order], self._motions[name]
            derivatives[:, k], derivatives[:, k + 1] = at.real, at.imag
            derivatives[:, k + 2] = motion.dpsi if order == 1 else motion.ddpsi
        return derivatives

    def _carried(self, name: str | None, at: complex) -> Points:
        return (self._motions[name] if name is not None else self._still).carry(at)[0]

    def _piece(self, spot: Spot) -> str:
        return self._mechanism.piece_at(spot.body or "", spot.at, self._direction)

    def _moves(self, spot: Spot) -> bool:
        """Return whether a point lies on a piece: not on the ground, nor on a body at rest in this direction."""
        return spot.body is not None and self._piece(spot) in self._column

    def _shifts(self, name: str, *spots: Spot) -> Sequence[complex]:
        """Return the offsets [m] at which a load or tie acts: those of equal bodies if each has one, otherwise 0."""
        several = name in self._each and any(spot.body in self._mechanism.alike() for spot in spots)
        return list(dict.fromkeys(each.shift for each in self._parts)) if several else [0j]

    def _spread(self, spot: Spot, along: Points, shifts: Sequence[complex]) -> Reals:
        """Return the derivative of a point's velocity along a unit vector by all coordinates, shape (n, 3 pieces).

        With several `shifts`, this is the mean over the point moved by each of them.
        """
        derivative = np.zeros((self.phi.size, 3 * len(self._parts)))
        for shift in shifts:
            copies = (each.body.name for each in self._parts if (each.of, each.shift) == (spot.body, shift))
            name = next(copies, self._piece(spot)) if shift else self._piece(spot)
            k = self._column[name]
            derivative[:, k : k + 3] += self._factors(name, self._carried(name, spot.at + shift), along) / len(shifts)
        return derivative

    def _factors(self, name: str, at: Points, along: Points) -> Reals:
        """Return the derivative of a point's velocity along a unit vector by its piece's coordinates, shape (n, 3)."""
        arm = at - self._centres[name][0]
        return np.stack([along.real, along.imag, (arm.conjugate() * along).imag], axis=1)

    def _mass(self) -> Reals:
        """Return the mass matrix of each piece with its loads, shape (n, pieces, 3, 3)."""
        whole = np.array([np.diag([each.body.mass, each.body.mass, each.body.inertia]) for each in self._parts])
        matrix = np.tile(whole, (self.phi.size, 1, 1, 1))
        for load in self._masses:
            shifts = self._shifts(load.name, load.spot)
            for share, along in ((load.horizontal, 1 + 0j), (load.vertical, 1j)):
                for shift in shifts:
                    rate = self._spread(load.spot, np.full(self.phi.size, along), [shift])
                    rate = rate.reshape(self.phi.size, -1, 3)
                    matrix += load.mass / len(shifts) * share * rate[..., None] * rate[:, :, None, :]
        # A piece without mass has no accelerations: it is given a mass too small to change the others.
        least = MASSLESS_SHARE * np.abs(matrix).max()
        light = np.diagonal(matrix, axis1=2, axis2=3) < least
        return np.asarray(matrix + least * np.eye(3) * light[..., None, :])

    def momenta(self, rates: Reals, at: slice | Integers = slice(None)) -> Reals:
        """Return the momenta of all pieces for k velocity fields, both of shape (n, 3 pieces, k).

        With `at`, the velocities belong to a selection of the rotations.
        """
        each = rates.reshape(len(rates), len(self._parts), 3, -1)
        return np.asarray((self.mass[at] @ each).reshape(rates.shape))

    def momentum(self, rates: Reals) -> Reals:
        """Return the momentum of all pieces for one velocity, both of shape (n, 3 pieces)."""
        return np.asarray(self.momenta(rates[..., None])[..., 0])

    def demands(self) -> Reals:
        """Return the forces that contacts must exert on the pieces, shape (n, 3 pieces, 4).

        There is a force for each coordinate of each piece: its coefficients of 1, u_g'', phi.^2 and v_g''.
        """
        n = self.phi.size
        forces = self.held_still()
        along = self.momentum(self.dq)
        forces += along[..., None] * self._turning[:, None, :]
        forces[..., RATE] += self.momentum(self.ddq)
        for load in self._masses:
            # The point of a body has an acceleration of its own beside those of the coordinates: -psi.^2 times its arm.
            shifts = self._shifts(load.name, load.spot)
            across, up = (self._spread(load.spot, np.full(n, along), shifts) for along in (1 + 0j, 1j))
            name = self._piece(load.spot)
            arm = self._carried(name, load.spot.at) - self._centres[name][0]
            inwards = -(self._motions[name].dpsi ** 2) * arm
            moved = load.horizontal * inwards.real[:, None] * across + load.vertical * inwards.imag[:, None] * up
            forces[..., RATE] += load.mass * moved
        return forces

    @cached_property
    def _turning(self) -> Reals:
        """Coefficients of 1, u_g'', phi.^2 and v_g'' in phi.. [rad/s2], shape (n, 4)."""
        at, g = self._mechanism.coefficients(self.phi, self._direction), self._mechanism.gravity
        # phi.. = -(J phi.^2 + (g + v_g'') G + Q + s B u_g'')/I   [Eq. 8]
        return -np.stack([g * at.G + at.Q, int(self._direction) * at.B, at.J, at.G], axis=-1) / at.I[:, None]

    def pressing(self, contact: Contact, *, still: bool = False) -> Reals:
        """Return the vertical force of a guide's load [N] by coefficients of 1, u_g'', phi.^2, v_g'', shape (n, 4)."""
        load, (_, dz, ddz) = self._load(contact)
        up = np.zeros((self.phi.size, 4))
        if not still:
            up += load.vertical * dz.imag[:, None] * self._turning
            up[:, RATE] += load.vertical * ddz.imag
        up[:, ONE] += load.weight * self._mechanism.gravity
        up[:, WEIGHT] += load.weight
        return np.asarray(load.mass * up)

    def thrown(self, contact: Contact) -> float:
        """Return the vertical momentum at rest of the load on a guide, over the rotation rate [kg m]."""
        load, (_, dz, _) = self._load(contact)
        return float(load.mass * load.vertical * dz.imag[0])

    def _load(self, contact: Contact) -> tuple[PointMass, tuple[Points, Points, Points]]:
        load = next(mass for mass in self._masses if mass.name == contact.pressed_by)
        return load, self._motions[self._piece(load.spot)].carry(load.spot.at)

    def held_still(self) -> Reals:
        """Return the forces that contacts must exert on pieces that do not move, in the form of `demands`."""
        mechanism, direction, n = self._mechanism, self._direction, self.phi.size
        g = mechanism.gravity
        forces = np.zeros((n, 3 * len(self._parts), 4))
        for part in self._parts:
            k = self._column[part.body.name]
            forces[:, k, PUSH] += part.body.mass
            forces[:, k + 1, ONE] += part.body.mass * g
            forces[:, k + 1, WEIGHT] += part.body.mass
        for load in self._masses:
            shifts = self._shifts(load.name, load.spot)
            across, up = (self._spread(load.spot, np.full(n, along), shifts) for along in (1 + 0j, 1j))
            forces[..., PUSH] += load.mass * load.horizontal * across
            forces[..., ONE] += load.mass * load.weight * g * up
            forces[..., WEIGHT] += load.mass * load.weight * up

        for other in mechanism.attached:
            pushes = other.forces(direction, self._path)
            shifts = self._shifts(other.name, *(push.spot for push in pushes))
            for push in pushes:
                if self._moves(push.spot):
                    along = np.exp(1j * np.angle(push.force))  # a unit vector even if the force is zero
                    forces[..., ONE] -= np.abs(push.force)[:, None] * self._spread(push.spot, along, shifts)
        return forces

    def _path(self, spot: Spot) -> Path:
        return Path(*(self._motions[self._piece(spot)] if self._moves(spot) else self._still).carry(spot.at))

    def rates(self, contacts: Sequence[Contact]) -> tuple[Rates, list[tuple[tuple[int, ...], int | None]]]:
        """Return the velocities at contacts as linear functions of the velocities of the pieces, and their row numbers.

        A contact has one row for the opening velocity at each of its points, and then one row for the sliding velocity
        at the middle of these points. For each contact, the second result has the numbers of its opening rows and the
        number of its sliding row. Rows of guides are not listed: a guide has an empty tuple and None.
        """
        terms: list[list[VelocityTerm]] = []
        rows: list[tuple[tuple[int, ...], int | None]] = []
        for contact in contacts:
            normal = self.normal(contact)
            if contact.held is not None:
                terms += self._of_held(contact, normal)
                rows.append(((), None))
                continue
            points = [self._bears_at(contact, at, normal) for at in contact.points]
            first = len(terms)
            terms += [self._between(contact, at, normal) for at in points]
            middle = np.mean(points, axis=0)
            terms.append(self._between(contact, middle, -1j * normal))
            rows.append((tuple(range(first, first + len(points))), len(terms) - 1))
        return Rates.of(terms, len(self._parts), self.phi.size), rows

    def number(self, name: str | None) -> int:
        """Return the number of a piece, from 0; -1 for the ground."""
        return -1 if name is None else self._column[name] // 3

    def centres(self) -> Points:
        """Return the positions of the centroids of all pieces [m], shape (n, pieces)."""
        return np.stack([self._centres[name][0] for name in self._column], axis=1)

    def turned(self) -> Points:
        """Return the rotations of all pieces as e^(i psi), shape (n, pieces)."""
        return np.stack([np.exp(1j * self._motions[name].psi) for name in self._column], axis=1)

    def normal(self, contact: Contact) -> Points:
        """Return the unit normal of the contact's face in its rotated position, shape (n,)."""
        turned = self._motions[contact.face].psi if contact.face is not None else np.zeros(self.phi.size)
        return np.asarray(contact.normal * np.exp(1j * turned))

    def _of_held(self, contact: Contact, normal: Points) -> list[list[VelocityTerm]]:
        (at,) = (self._carried(contact.pieces[1], point) for point in contact.points[:1])
        if contact.held == "slide":
            return [self._between(contact, at, normal)]
        turn = np.tile([0.0, 0.0, 1.0], (self.phi.size, 1))
        turns = [
            VelocityTerm(self.number(name), sign * turn)
            for name, sign in zip(contact.pieces[::-1], (1.0, -1.0), strict=True)
            if name is not None and (sign > 0 or contact.held == "fixed")
        ]
        if contact.held == "level":
            return [turns]
        return [self._between(contact, at, normal), self._between(contact, at, -1j * normal), turns]

    def _bears_at(self, contact: Contact, at: complex, normal: Points) -> Points:
        where = self._carried(contact.pieces[1] if contact.pieces[1] is not None else contact.pieces[0], at)
        return where - contact.roll * normal

    def _between(self, contact: Contact, at: Points, along: Points) -> list[VelocityTerm]:
        """Return the velocity of the second piece relative to the first, at a point along a direction."""
        return [
            VelocityTerm(self.number(name), sign * self._factors(name, at, along))
            for name, sign in zip(contact.pieces[::-1], (1.0, -1.0), strict=True)
            if name is not None
        ]
