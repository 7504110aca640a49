"""Base class of mechanisms whose bodies are given one by one and move as a linkage."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from mechanisms._shapes import Member, Shape
from mechanisms.rigid_body import RigidBody
from rocking_cli.core import (
    Body,
    Contact,
    Direction,
    Guide,
    Joint,
    LinkageMotion,
    Mechanism,
    Reals,
    RigidMotion,
    Solid,
    geometry_error,
    rotation,
)

EQUAL_COLUMNS = 1e-6  # relative difference of two columns that count as equal


OUT_OF_STEP = (
    "Three or more columns may fall out of step at an impact: a column that carries nothing then rocks alone. "
    "If that column ends otherwise than the structure, the outcome is unknown from the first impact; if not, peaks are "
    "those of columns in step."
)


class LinkedBodies(Mechanism):
    """A mechanism whose bodies are given one by one."""

    @property
    @abstractmethod
    def _members(self) -> Mapping[str, Member]:
        """The bodies by name, with the masses of the file, or relative ones."""

    @property
    @abstractmethod
    def _shapes(self) -> Mapping[str, Shape]:
        """The shapes of the bodies, by name."""

    @abstractmethod
    def _linkage(self, direction: Direction) -> LinkageMotion:
        """Return the motion of the bodies in a direction. Raises `MechanismError` if there is none."""

    def _check_masses(self, field: str) -> None:
        """Raise a geometry error at `field`, that of the bodies, if only some of them have masses."""
        weighs = {name: each.weighs for name, each in self._members.items()}
        if self.mass is not None or all(weighs.values()):
            return
        if self.density is not None:
            raise geometry_error("depth", "is missing: density needs the size out of plane")
        if any(weighs.values()):
            name = next(name for name, known in weighs.items() if not known)
            why = "has no mass, and others have: give the structure density and depth, or this its mass"
            raise geometry_error((field, name), why)

    @property
    def has_mass(self) -> bool:
        return self.mass is not None or all(each.weighs for each in self._members.values())

    def total_mass(self) -> float | None:
        """Return the given mass of the structure; None if the bodies have their own masses, or masses by density."""
        return self.mass

    def bodies(self) -> Sequence[Body]:
        bodies = [each.body for each in self._members.values()]
        if self.has_mass:
            return bodies
        total = sum(body.mass for body in bodies)
        return [replace(body, mass=body.mass / total, inertia=body.inertia / total) for body in bodies]

    def solids(self) -> Mapping[str, Sequence[Solid]]:
        if self.mass is not None:
            return {}
        return {name: shape.solids(self.density, self.depth) for name, shape in self._shapes.items()}

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        if direction not in self.directions:  # a one-sided structure rests against its support
            return [rotation(np.asarray(phi, np.float64), 0j, 0.0) for _ in self._members]
        motions = self._linkage(direction).motions(phi)
        return [motions[name] for name in self._members]

    def limit(self, direction: Direction) -> float:
        return self._linkage(direction).limit

    def guiding_joints(self, direction: Direction) -> Sequence[Joint]:
        return [
            Joint(each.name, each.at, each.bodies[::-1], slide=each.along)
            if isinstance(each, Guide)
            else Joint(each.name, each.at, each.bodies)
            for each in self._linkage(direction).joints
        ]

    def own_caution(self) -> str:
        """Return the caution that columns may fall out of step, if three or more carry one beam."""
        return OUT_OF_STEP if self.columns_alone() else ""

    def columns_alone(self) -> Sequence[Mechanism]:
        if not self.rocks_both_ways:
            return ()
        feet, names = zip(*(columns_of(self.contacts(direction) or ()) for direction in Direction), strict=True)
        columns: list[RigidBody] = []
        for body in self.weighed():
            if not all(body.name in each for each in names):
                continue
            right, left = (each[body.name] for each in feet)
            centroid, right = body.centroid - left, right - left
            if not any(_alike(each, body, centroid, right) for each in columns):
                columns.append(RigidBody(
                    mass=body.mass, inertia=body.inertia, centroid=[centroid.real, centroid.imag],
                    left_foot=[0.0, 0.0], right_foot=[right.real, right.imag],
                    gravity=self.gravity, friction=self.friction, restitution=self.restitution,
                ))  # fmt: skip
        return columns


def columns_of(contacts: Sequence[Contact]) -> tuple[Mapping[str, complex], Collection[str]]:
    """Return the feet of bodies that hinge on the ground, and the bodies of which three or more carry one together."""
    feet: dict[str, complex] = {}
    carried: dict[str, set[str]] = {}
    for contact in contacts:
        below, above = contact.pieces
        if contact.held is not None or len(contact.points) > 1 or above is None:
            continue
        if below is None:
            feet[above] = contact.points[0]
        else:
            carried.setdefault(above, set()).add(below)
    shares = [names & feet.keys() for names in carried.values()]
    return feet, {name for names in shares if len(names) > 2 for name in names}


def _alike(known: RigidBody, body: Body, centroid: complex, right: complex) -> bool:
    """Return whether a body is the same as a column found before."""
    one = [known.mass, known.inertia, *(known.centroid or ()), *(known.right_foot or ())]
    other = [body.mass, body.inertia, centroid.real, centroid.imag, right.real, right.imag]
    return bool(np.allclose(np.array(one, np.float64), other, rtol=EQUAL_COLUMNS, atol=EQUAL_COLUMNS * abs(centroid)))
