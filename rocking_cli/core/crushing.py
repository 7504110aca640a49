"""Crushing of pivots: a corner of finite strength bears on a strip, and the pivot is in its middle."""

from __future__ import annotations

from collections.abc import Container, Sequence
from itertools import pairwise

import numpy as np

from rocking_cli.core.attached import TOGETHER, Attached, ConstantForce, Follow, PointMass, springs_of
from rocking_cli.core.fields import Described, length, quantity
from rocking_cli.core.kinematics import Direction


class Crushing(Described):
    """Every pivot moves inwards by u = N/(2 strength depth), with the normal force N that it carries at rest."""

    strength: float = quantity("compressive strength", unit="Pa", example=1e6, gt=0, le=1e12)
    depth: float | None = length("length of the pivot out of plane; if omitted, that of the structure", default=None)

    def enlarged(self, factor: float) -> Crushing:
        """The same strength of a structure of another size."""
        return self.model_copy(update={"depth": None if self.depth is None else factor * self.depth})


def pressing(
    things: Sequence[Attached], on: Container[str | None], direction: Direction, follow: Follow, gravity: float
) -> float:
    """Return the downward force at rest of what is attached to some bodies [N].

    Parameters
    ----------
    things : sequence of Attached
        All that is attached to the structure.
    on : container of str
        Names of the bodies.
    direction : Direction
        Of rocking, which decides where a tie without length at rest points to.
    follow : callable
        The paths of points, at rest.
    gravity : float
        [m/s2].
    """
    total = 0.0
    for thing in things:
        if isinstance(thing, PointMass) and thing.spot.body in on:
            total += thing.mass * thing.weight * gravity
        elif isinstance(thing, ConstantForce) and thing.spot.body in on:
            total -= thing.in_direction(direction).imag
        for spring in springs_of(thing):
            force = spring.count * float(spring.force(np.zeros(1))[0])
            for one, other in pairwise(spring.spots):
                along = other.at - one.at
                if abs(along) <= TOGETHER * (1 + abs(one.at)):
                    along = complex(follow(other).dz[0] - follow(one).dz[0])
                share = force * along.imag / (abs(along) or 1.0)
                total += share * ((other.body in on) - (one.body in on))
    return total
