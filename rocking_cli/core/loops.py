"""Equations of a linkage: a tree of hinges places the bodies, and the other joints form loops that must close.

A hinge places a body relative to the body before it: along a tree of hinges from the ground, every position is a sum of
rotated arms, q = a + A e^(i psi) + u, with u the free position of a tree that no hinge connects to the ground. The
unknowns are psi and u. Positions and lengths here are divided by the size of the linkage.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Bools
from rocking_cli.core.kinematics import Points, Reals


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
        """Return the Jacobian of the loop equations, shape (n, m, unknowns)."""
        psi, u = self._parts(x)
        e = np.exp(1j * psi)
        w, gap = self._turned(e), self._k + e @ self._C.T + u @ self._S.T
        jacobian = np.empty((len(x), len(self._w), self.unknowns))
        jacobian[:, :, : self.count] = (w[:, :, None] * (1j * self._C) * e[:, None, :]).imag
        body = np.flatnonzero(self._turn >= 0)
        jacobian[:, body, self._turn[body]] -= (w * gap).real[:, body]
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
