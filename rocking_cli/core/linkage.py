"""Exact motion of linkages of rigid bodies with hinges, pivots and guides, driven by the rotation of one body.

A hinge places a body relative to the body before it: along a tree of hinges from the ground, every position is a sum of
rotated arms, q = a + A e^(i psi) + u, with u the free position of a tree that no hinge connects to the ground. The
other joints form loops that must close. The unknowns x are psi and u. Positions and lengths in these equations are
divided by the size of the linkage.

The loop equations and "the leading body turns by -s phi" are c(x, phi) = 0. Newton's method, continued in phi from
rest, gives x; x' and x'' follow from c_x x' = -c_phi and its derivative, so that all are exact.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools
from rocking_cli.core.kinematics import Direction, Points, Reals, RigidMotion, rotation


@dataclass(frozen=True)
class Pin:
    """A hinge: a point that two bodies share, or about which one body turns on the ground.

    Parameters
    ----------
    name : str
        Name of the hinge.
    bodies : tuple of str
        Two bodies, or one that turns about a point of the ground.
    at : complex
        The point at rest [m].
    """

    name: str
    bodies: tuple[str, ...]
    at: complex


@dataclass(frozen=True)
class Guide:
    """A point of a body that stays on a line of the ground, or on a line that turns with a second body.

    Parameters
    ----------
    name : str
        Name of the guide.
    bodies : tuple of str
        The body of the point, and the body of the line unless it is the ground.
    at : complex
        The point at rest [m].
    along : complex
        The direction of the line at rest.
    """

    name: str
    bodies: tuple[str, ...]
    at: complex
    along: complex


LinkageJoint = Pin | Guide


class Places(NamedTuple):
    """Positions of the reference points of all links and their first two derivatives, each of shape (n, links)."""

    q: Points
    dq: Points
    ddq: Points


class _Sum(NamedTuple):
    """A point as the sum of a constant, arms that rotate with the links, and the free position of a tree, if any."""

    constant: complex
    arms: Points
    tree: int | None


class Loops:
    """Equations that close the loops of a linkage.

    Parameters
    ----------
    centres : sequence of complex
        Reference point of each link, divided by the size of the linkage.
    joints : sequence of Pin or Guide
        Joints, whose points are divided by the size of the linkage.
    link_of : mapping of str to int or None
        The link of each body; None: the ground.
    """

    def __init__(
        self, centres: Sequence[complex], joints: Sequence[LinkageJoint], link_of: Mapping[str, int | None]
    ) -> None:
        self.count = len(centres)
        self._centres, self._link_of = list(centres), link_of
        tree, places = self._grown([joint for joint in joints if isinstance(joint, Pin)])
        self._a = np.array([place.constant for place in places])
        self._A = np.array([place.arms for place in places]).reshape(self.count, self.count)
        self._u = np.array([self._free(place) for place in places]).reshape(self.count, self.trees)
        self._gather([joint for joint in joints if not any(joint is used for used in tree)], places)

    # The tree of hinges

    def _ends(self, joint: LinkageJoint) -> tuple[int | None, int | None]:
        links = [self._link_of[name] for name in joint.bodies]
        return links[0], links[1] if len(links) > 1 else None

    def _grown(self, pins: Sequence[Pin]) -> tuple[list[Pin], list[_Sum]]:
        """Return the hinges of the trees that place the links, and the reference point of each link."""
        neighbours: dict[int | None, list[tuple[int | None, Pin]]] = {}
        for pin in pins:
            a, b = self._ends(pin)
            neighbours.setdefault(a, []).append((b, pin))
            neighbours.setdefault(b, []).append((a, pin))
        used: list[Pin] = []
        placed: dict[int, _Sum] = {}
        self.trees = 0

        def grow(start: int | None) -> None:
            waiting = [start]
            while waiting:
                here = waiting.pop(0)
                for there, pin in neighbours.get(here, []):
                    if there is None or there in placed:
                        continue
                    point = self._point(here, pin.at, placed)
                    point.arms[there] -= pin.at - self._centres[there]
                    placed[there] = point
                    used.append(pin)
                    waiting.append(there)

        grow(None)
        for link in range(self.count):
            if link not in placed:
                placed[link] = _Sum(self._centres[link], np.zeros(self.count, np.complex128), self.trees)
                self.trees += 1
                grow(link)
        return used, [placed[link] for link in range(self.count)]

    def _point(self, link: int | None, at: complex, placed: Mapping[int, _Sum] | Sequence[_Sum]) -> _Sum:
        """Return a point of a link already placed, or of the ground."""
        if link is None:
            return _Sum(at, np.zeros(self.count, np.complex128), None)
        arms = placed[link].arms.copy()
        arms[link] += at - self._centres[link]
        return placed[link]._replace(arms=arms)

    def _free(self, point: _Sum) -> Reals:
        """Return the factors of the free positions of all trees in a point."""
        return np.eye(self.trees)[point.tree] if point.tree is not None else np.zeros(self.trees)

    # Loop equations

    def _gather(self, joints: Sequence[LinkageJoint], places: Sequence[_Sum]) -> None:
        """Set up the equations that close the loops, from the joints that are not in the tree of hinges.

        The gap of a joint is the vector between the positions of its point on its two bodies, gap = k + C e^(i psi) + S
        u. A hinge demands that both components of its gap are zero; a guide, that the component across its line is
        zero. Each equation is Im(w e^(-i psi_b) gap) = 0. The unit number w selects the component; psi_b is the
        rotation of the body with which the line of a guide turns, and 0 for a hinge or a line fixed to the ground.
        """
        gaps: tuple[list[complex], list[Points], list[Reals]] = [], [], []
        weights, turns, names = [], [], []
        for joint in joints:
            a, b = self._ends(joint)
            one, other = (self._point(link, joint.at, places) for link in (a, b))
            gap = one.constant - other.constant, one.arms - other.arms, self._free(one) - self._free(other)
            kinds = [(1j, -1), (1.0, -1)] if isinstance(joint, Pin) else [
                (np.conj(joint.along) / abs(joint.along), -1 if b is None else b)
            ]  # fmt: skip
            for weight, turn in kinds:  # the imaginary part of i gap is its real part
                for into, value in zip(gaps, gap, strict=True):
                    into.append(value)  # type: ignore[attr-defined]
                weights.append(weight)
                turns.append(turn)
                names.append(joint.name)
        m = len(names)
        self._k = np.array(gaps[0], dtype=np.complex128)
        self._C = np.array(gaps[1], dtype=np.complex128).reshape(m, self.count)
        self._S = np.array(gaps[2], dtype=np.float64).reshape(m, self.trees)
        self._w = np.array(weights, dtype=np.complex128)
        self._turn = np.array(turns, dtype=np.intp)
        self.names: list[str] = names
        """Name of the joint of each equation."""

    @property
    def unknowns(self) -> int:
        """Number of unknowns."""
        return self.count + 2 * self.trees

    @property
    def size(self) -> int:
        """Number of entries of the Jacobian at one rotation."""
        return len(self.names) * self.unknowns

    def _parts(self, x: Reals) -> tuple[Reals, Points]:
        """Split the unknowns into psi, shape (n, links), and u, shape (n, trees)."""
        free = x[:, self.count :]
        return x[:, : self.count], np.asarray(free[:, : self.trees] + 1j * free[:, self.trees :])

    def _turned(self, e: Points) -> Points:
        """Return the factor w e^(-i psi_b) of each equation at rotations e = e^(i psi) of the links, shape (n, m).

        The factor turns the component of the gap that must be zero into the imaginary part; see `_gather`.
        """
        body = self._turn >= 0
        factors = np.broadcast_to(self._w, (len(e), len(self._w))).copy()
        factors[:, body] *= np.conj(e[:, self._turn[body]])
        return factors

    def residuals(self, x: Reals) -> Reals:
        """Return the residuals of the loop equations, shape (n, m), divided by the size of the linkage."""
        psi, u = self._parts(x)
        e = np.exp(1j * psi)
        return np.asarray((self._turned(e) * (self._k + e @ self._C.T + u @ self._S.T)).imag)

    def matrix(self, x: Reals) -> Reals:
        """Return the Jacobian of the loop equations, shape (n, m, unknowns).

        Its columns are the rotations psi of the links, then the real and the imaginary parts of u.
        """
        psi, u = self._parts(x)
        e = np.exp(1j * psi)
        w, gap = self._turned(e), self._k + e @ self._C.T + u @ self._S.T
        jacobian = np.empty((len(x), len(self._w), self.unknowns))
        jacobian[:, :, : self.count] = (w[:, :, None] * (1j * self._C) * e[:, None, :]).imag
        guides = np.flatnonzero(self._turn >= 0)  # equations whose line turns with a link
        jacobian[:, guides, self._turn[guides]] -= (w * gap).real[:, guides]
        jacobian[:, :, self.count : self.count + self.trees] = w.imag[:, :, None] * self._S
        jacobian[:, :, self.count + self.trees :] = w.real[:, :, None] * self._S
        return jacobian

    def bending(self, x: Reals, dx: Reals) -> Reals:
        """Return the second derivatives of the loop equations in phi without the terms in x'', shape (n, m)."""
        (psi, u), (dpsi, du) = self._parts(x), self._parts(dx)
        e = np.exp(1j * psi)
        gap = self._k + e @ self._C.T + u @ self._S.T
        rate = (1j * dpsi * e) @ self._C.T + du @ self._S.T
        pull = -(dpsi**2 * e) @ self._C.T
        body = self._turn >= 0
        spin = np.where(body, dpsi[:, self._turn], 0.0)
        return np.asarray((self._turned(e) * (pull - 2j * spin * rate - spin**2 * gap)).imag)

    def places(self, x: Reals, dx: Reals, ddx: Reals) -> Places:
        """Return the positions of the links and their derivatives, divided by the size of the linkage."""
        (psi, u), (dpsi, du), (ddpsi, ddu) = self._parts(x), self._parts(dx), self._parts(ddx)
        e = np.exp(1j * psi)
        q = self._a + e @ self._A.T + u @ self._u.T
        dq = (1j * dpsi * e) @ self._A.T + du @ self._u.T
        ddq = ((1j * ddpsi - dpsi**2) * e) @ self._A.T + ddu @ self._u.T
        return Places(q, dq, ddq)

    def moving(self, directions: Reals) -> Bools:
        """Return which links move in any of the given directions of motion from rest, shape (links,)."""
        still = np.zeros_like(directions)
        psi, _ = self._parts(directions)
        _, dq, _ = self.places(still, directions, still)
        return np.asarray((np.abs(dq) + np.abs(psi)).max(axis=0) > 1e-6)


RANK_TOLERANCE = 1e-9  # singular values below this share of the largest one count as zero
MAX_GAP = 1e-10  # largest gap of a joint, over the size of the linkage
FIRST_ROTATION = 1e-3  # rotation at which it is first checked whether the loops close [rad]
MAX_PREDICTION_ERROR = 3e-3  # largest error of a prediction before the step is halved [rad, or of the size]
MAX_RATE_ERROR = 0.1  # largest relative error of the prediction of x'; it is larger across a singular position
MAX_STEP = 0.05  # longest step [rad]
MIN_STEP = 1e-11  # shortest step: the motion ends there [rad]
MAX_ITERATIONS = 12  # number of steps of Newton's method
CONVERGED_STEP = 1e-10  # relative step of Newton's method at which it has converged
FLAT_ROTATION = np.pi / 2  # rotation at which the leading body lies flat [rad]
CACHED_MOTIONS = 8
MAX_ENTRIES = 4_000_000  # entries of the matrices that are solved at once: 64 MB of complex numbers


class NoMotion(ValueError):
    """Error: the joints leave no motion, or more than one.

    Parameters
    ----------
    reason : str
        Reason, a sentence without a full stop.
    joint : str, optional
        Name of the joint concerned.
    """

    def __init__(self, reason: str, *, joint: str | None = None) -> None:
        self.reason, self.joint = reason, joint
        super().__init__(reason)


class _Node(NamedTuple):
    """A state of the motion at one rotation: the unknowns and their first two derivatives."""

    phi: float
    x: Reals
    dx: Reals
    ddx: Reals


class LinkageMotion:
    """Motion of a linkage of bodies and joints in one direction of rocking.

    Parameters
    ----------
    bodies : mapping of str to complex
        Reference point of each body, such as its centroid [m].
    joints : iterable of Pin or Guide
        Joints between the bodies, and with the ground.
    lead : str
        Name of the leading body, whose rotation is phi.
    direction : Direction
        Direction in which the leading body turns.
    fixed : iterable of pairs of str, optional
        Bodies that move as one in this direction.
    ground : iterable of str, optional
        Bodies that stay at rest.
    end : float, optional
        Largest rotation of the motion [rad]; by default that at which the leading body lies flat.

    Raises
    ------
    NoMotion
        If the joints leave no motion, or more than one.

    Examples
    --------
    A wall that hinges at mid-height, its top held sideways:

    >>> from rocking_cli.core import Direction, Guide, LinkageMotion, Pin
    >>> wall = LinkageMotion(
    ...     {"lower": 0.75j, "upper": 2.25j},
    ...     [
    ...         Pin("A", ("lower",), 0.15 + 0j),
    ...         Pin("B", ("lower", "upper"), -0.15 + 1.5j),
    ...         Guide("C", ("upper",), 0.15 + 3j, 1j),
    ...     ],
    ...     "lower",
    ...     Direction.POSITIVE,
    ... )
    >>> round(wall.limit, 6)
    1.570796
    """

    def __init__(
        self,
        bodies: Mapping[str, complex],
        joints: Iterable[LinkageJoint],
        lead: str,
        direction: Direction,
        fixed: Iterable[tuple[str, str]] = (),
        ground: Iterable[str] = (),
        end: float | None = None,
    ) -> None:
        self.direction, self.joints = direction, list(joints)
        self._bodies = list(bodies)
        self._end = FLAT_ROTATION if end is None else end
        first = _merged(self._bodies, fixed, ground)
        links = list(dict.fromkeys(name for name in first.values() if name is not None))
        self._link_of = {
            name: None if first_body is None else links.index(first_body) for name, first_body in first.items()
        }
        self._check_held(lead)
        self._lead_name, self._lead = lead, self._link_of[lead] or 0
        points = [*bodies.values(), *(joint.at for joint in self.joints)]
        middle = sum(points) / len(points)
        self._size = 2 * max(abs(point - middle) for point in points) or 1.0
        self._centres = [bodies[link] / self._size for link in links]
        self._loops = self._of(self.joints)
        self._rows = self._independent()
        self._memory: dict[bytes, Sequence[RigidMotion]] = {}
        self._first = self._node(np.zeros((1, self._loops.unknowns)), np.zeros(1))
        self._check_closes()

    def _check_held(self, lead: str) -> None:
        if self._link_of[lead] is None:
            raise NoMotion(f"{lead} cannot lead: it is fixed to the ground")
        held = {self._link_of[name] for joint in self.joints for name in joint.bodies}
        for link in self._link_of.values():
            if link is not None and link not in held:
                what = " and ".join(other for other, own_link in self._link_of.items() if own_link == link)
                raise NoMotion(f"no joint holds {what}: if it stays at rest, fix it to the ground")

    def _of(self, joints: Sequence[LinkageJoint]) -> Loops:
        scaled = [replace(joint, at=joint.at / self._size) for joint in joints]
        return Loops(self._centres, scaled, self._link_of)

    # Degrees of freedom

    def _independent(self) -> NDArray[np.intp]:
        """Return the indices of as many linearly independent equations as there are unknowns, in increasing order.

        Redundant joints give more equations than unknowns. The equation that prescribes the rotation of the leading
        body, the last, is always among those chosen. The others are chosen at rest by Gram-Schmidt orthogonalisation:
        each time the row with the largest part perpendicular to the rows already chosen.
        """
        held = self._loops.matrix(np.zeros((1, self._loops.unknowns)))[0]
        matrix = np.vstack([held, self._turn_of_lead])
        self._check_rank(held, matrix)
        chosen, remainder = [len(held)], matrix.copy()
        for _ in range(self._loops.unknowns - 1):
            row = remainder[chosen[-1]] / np.linalg.norm(remainder[chosen[-1]])
            for _ in range(2):  # the second pass removes the rounding error
                remainder = remainder - np.outer(remainder @ row, row)
            chosen.append(int(np.linalg.norm(remainder, axis=1).argmax()))
        return np.array(sorted(chosen))

    @property
    def _turn_of_lead(self) -> Reals:
        row = np.zeros(self._loops.unknowns)
        row[self._lead] = 1.0
        return row

    def _check_rank(self, held: Reals, matrix: Reals) -> None:
        """Raise `NoMotion` if the joints at rest prevent all motion, or leave more than one degree of freedom."""
        free = _free(held)
        if not len(free):
            raise self._nothing_moves()
        if np.abs(free[:, self._lead]).max() < 1e-7:
            raise NoMotion(f"{self._lead_name} cannot lead, because it does not rotate; {self._movers(free)} can move")
        loose = _free(matrix)
        if len(loose):
            raise NoMotion(
                f"the linkage has more than one degree of freedom: with {self._lead_name} held still, "
                f"{self._movers(loose)} can still move. Add the missing joint"
            )

    def _nothing_moves(self) -> NoMotion:
        """Return the error that nothing can move, with the joints of which one must be removed."""
        able = []
        for joint in self.joints:
            loops = self._of([each for each in self.joints if each is not joint])
            if len(_free(loops.matrix(np.zeros((1, loops.unknowns)))[0])):
                able.append(joint.name)
        if not able:
            return NoMotion("nothing can move: there are too many joints")
        which = f"without {able[0]}" if len(able) == 1 else f"without one of {', '.join(able)}"
        return NoMotion(f"nothing can move: {which} it could", joint=able[-1])

    def _movers(self, free: Reals) -> str:
        """Return the names of the bodies that move in any of the given directions of motion, joined by "and"."""
        moved = self._loops.moving(free)
        return " and ".join(name for name, link in self._link_of.items() if link is not None and moved[link])

    def _check_closes(self) -> None:
        """Raise `NoMotion` if the loops cannot close at a small rotation from rest."""
        phi = np.array([min(FIRST_ROTATION, self._end / 2)])
        if self._stepped(self._first, float(phi[0])) is None:
            gaps = np.abs(self._residuals(self._newton(self._predicted(self._first, phi), phi), phi)[0][:-1])
            raise NoMotion(
                "the joints allow only an infinitesimal rotation: check whether three of them lie on one line, or two "
                "restrain the same movement",
                joint=self._loops.names[int(gaps.argmax())] if gaps.size else None,
            )

    # The motion

    def _residuals(self, x: Reals, phi: Reals) -> Reals:
        return np.column_stack([self._loops.residuals(x), x[:, self._lead] + self.direction * phi])

    def _matrix(self, x: Reals) -> Reals:
        """Return the Jacobian of the chosen independent equations, shape (n, unknowns, unknowns)."""
        lead = np.broadcast_to(self._turn_of_lead, (len(x), 1, self._loops.unknowns))
        return np.concatenate([self._loops.matrix(x), lead], axis=1)[:, self._rows]

    def _newton(self, x: Reals, phi: Reals) -> Reals:
        """Return the unknowns that solve the equations at `phi`, from guesses `x`, shape (n, unknowns)."""
        for _ in range(MAX_ITERATIONS):
            step = _solved(self._matrix(x), self._residuals(x, phi)[:, self._rows])
            x = x - step
            if not np.isfinite(step).all() or (np.abs(step) <= CONVERGED_STEP * (1 + np.abs(x))).all():
                break
        return x

    def _derivatives(self, x: Reals) -> tuple[Reals, Reals]:
        """Return x' and x'', the derivatives in phi of the unknowns `x`."""
        matrix = self._matrix(x)
        drive = np.zeros((len(x), len(self._rows)))
        drive[:, -1] = -self.direction
        dx = _solved(matrix, drive)
        bending = np.column_stack([self._loops.bending(x, dx), np.zeros(len(x))])
        return dx, -_solved(matrix, bending[:, self._rows])

    def _node(self, x: Reals, phi: Reals) -> _Node:
        dx, ddx = self._derivatives(x)
        return _Node(float(phi[0]), x[0], dx[0], ddx[0])

    def _predicted(self, node: _Node, phi: Reals) -> Reals:
        by = (phi - node.phi)[:, None]
        return np.asarray(node.x + by * node.dx + by**2 / 2 * node.ddx)

    def _stepped(self, node: _Node, by: float) -> _Node | None:
        """Return the node at a rotation larger by `by` [rad]; None if so long a step fails."""
        phi = np.array([node.phi + by])
        guess = self._predicted(node, phi)
        x = self._newton(guess, phi)
        if not np.abs(x - guess).max() <= MAX_PREDICTION_ERROR or not np.abs(self._residuals(x, phi)).max() <= MAX_GAP:
            return None
        if np.linalg.slogdet(self._matrix(x)[0])[0] != self._sign:
            return None
        stepped = self._node(x, phi)
        off = np.abs(stepped.dx - node.dx - by * node.ddx).max()
        return stepped if off <= MAX_RATE_ERROR * np.abs(stepped.dx).max() else None

    @cached_property
    def _sign(self) -> float:
        """Sign of the Jacobian's determinant at rest, which changes where the motion passes a singular position."""
        return float(np.linalg.slogdet(self._matrix(np.zeros((1, self._loops.unknowns)))[0])[0])

    @cached_property
    def _nodes(self) -> list[_Node]:
        """Nodes of the motion from rest to its end, so close that Newton converges between them."""
        nodes, by = [self._first], MAX_STEP / 4
        while nodes[-1].phi < self._end:
            by = min(by, self._end - nodes[-1].phi)
            if (node := self._stepped(nodes[-1], by)) is not None:
                nodes.append(node)
                by = min(1.5 * by, MAX_STEP)
            else:
                by /= 2
                if by < MIN_STEP:
                    break
        return nodes

    @property
    def resting(self) -> set[str]:
        """Names of the bodies that are fixed to the ground."""
        return {name for name, link in self._link_of.items() if link is None}

    @property
    def determinate(self) -> bool:
        """Whether the forces at the joints follow from statics alone, without redundant joints."""
        forces = sum(2 if isinstance(joint, Pin) else 1 for joint in self.joints)
        return forces == 3 * self._loops.count - 1

    @property
    def limit(self) -> float:
        """Rotation at which the motion ends [rad]: the leading body lies flat, the linkage locks, or `end`."""
        return self._nodes[-1].phi

    def motions(self, phi: Reals) -> dict[str, RigidMotion]:
        """Return the motion of every body at rotations, shape (n,) [rad]; beyond the limit, the motion at the limit."""
        phi = np.asarray(phi, dtype=np.float64)
        key = phi.tobytes()
        if key not in self._memory:
            if len(self._memory) >= CACHED_MOTIONS:
                self._memory.pop(next(iter(self._memory)))
            self._memory[key] = self._computed(phi)
        still = rotation(phi, 0j, 0.0)
        return {name: still if link is None else self._memory[key][link] for name, link in self._link_of.items()}

    def _computed(self, phi: Reals) -> Sequence[RigidMotion]:
        if phi.any():
            inside = np.clip(phi, 0.0, self.limit)
            count = min(inside.size, -(-inside.size * self._loops.size // MAX_ENTRIES)) or 1
            each = map(self._followed, np.array_split(inside, count))
            x, dx, ddx = (np.concatenate(parts) for parts in zip(*each, strict=True))
        else:  # at rest, the limit of the motion is not needed
            x, dx, ddx = (np.repeat(each[None], len(phi), axis=0) for each in self._first[1:])
        q, dq, ddq = (self._size * each for each in self._loops.places(x, dx, ddx))
        return [
            RigidMotion(self._size * centre, q[:, k], dq[:, k], ddq[:, k], x[:, k], dx[:, k], ddx[:, k])
            for k, centre in enumerate(self._centres)
        ]

    def _followed(self, phi: Reals) -> tuple[Reals, Reals, Reals]:
        """Return the unknowns and their first two derivatives at rotations up to the limit."""
        x = self._newton(self._between(phi), phi)
        return (x, *self._derivatives(x))

    def _between(self, phi: Reals) -> Reals:
        """Return first guesses of the unknowns, by quintic Hermite interpolation between the nodes."""
        at = np.array([node.phi for node in self._nodes])
        if len(at) == 1:
            return np.repeat(self._first.x[None], len(phi), axis=0)
        interval = np.clip(np.searchsorted(at, phi, side="right") - 1, 0, len(at) - 2)
        h = (at[interval + 1] - at[interval])[:, None]
        t = (phi - at[interval])[:, None] / h
        x, dx, ddx = (np.stack([getattr(node, key) for node in self._nodes]) for key in ("x", "dx", "ddx"))
        ends = [(x[k], h * dx[k], h**2 * ddx[k]) for k in (interval, interval + 1)]
        guess = np.zeros_like(ends[0][0])
        for (value, slope, bend), s, sign in zip(ends, (t, 1 - t), (1, -1), strict=True):
            guess += (1 - 10 * s**3 + 15 * s**4 - 6 * s**5) * value
            guess += sign * (s - 6 * s**3 + 8 * s**4 - 3 * s**5) * slope
            guess += (s**2 - 3 * s**3 + 3 * s**4 - s**5) / 2 * bend
        return guess


def _merged(names: Sequence[str], fixed: Iterable[tuple[str, str]], ground: Iterable[str]) -> dict[str, str | None]:
    """Return for each body the first of the bodies with which it moves as one; None for the ground."""
    link: dict[str, str | None] = {name: name for name in names}

    def put(old: str | None, new: str | None) -> None:
        for name, link_of_name in link.items():
            if link_of_name == old:
                link[name] = new

    for one, other in fixed:
        a, b = link[one], link[other]
        if a != b:
            put(*((a, b) if a is not None and (b is None or names.index(b) < names.index(a)) else (b, a)))
    for name in ground:
        if link[name] is not None:
            put(link[name], None)
    return link


def _free(matrix: Reals) -> Reals:
    """Return a basis of the null space of a matrix, as rows."""
    if not len(matrix):
        return np.eye(matrix.shape[1])
    _, values, basis = np.linalg.svd(matrix)
    rank = int((values > RANK_TOLERANCE * values.max(initial=0.0)).sum())
    return np.asarray(basis[rank:])


def _solved(matrix: Reals, right: Reals) -> Reals:
    """Return the solutions of many linear systems; NaN for all if one is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        return np.full(right.shape, np.nan)
