"""Base class of mechanisms whose bodies are given one by one and move as a linkage."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from mechanisms._shapes import Member
from rocking_cli.core import Body, Direction, LinkageMotion, Mechanism, Reals, RigidMotion, geometry_error, rotation


class LinkedBodies(Mechanism):
    """A mechanism whose bodies are given one by one."""

    @property
    @abstractmethod
    def _members(self) -> Mapping[str, Member]:
        """The bodies by name, with the masses of the file, or relative ones."""

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
        """Return the given mass of the structure; None if the bodies have the masses of density, or their own."""
        return self.mass

    def bodies(self) -> Sequence[Body]:
        bodies = [each.body for each in self._members.values()]
        if self.has_mass:
            return bodies
        total = sum(body.mass for body in bodies)
        return [replace(body, mass=body.mass / total, inertia=body.inertia / total) for body in bodies]

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        if direction not in self.directions:  # it leans, and rests
            return [rotation(np.asarray(phi, np.float64), 0j, 0.0) for _ in self._members]
        found = self._linkage(direction).motions(phi)
        return [found[name] for name in self._members]

    def limit(self, direction: Direction) -> float:
        return self._linkage(direction).limit
