"""All loads, forces and ties of a mechanism together, and their joint effect."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.hung.attached import Attached, Follow, PointMass
from rocking_cli.core.hung.attachments import Loc
from rocking_cli.core.hung.element import NO_ANSWER, ConstantForce, Element, Question, SteelBar, Stretched
from rocking_cli.core.kinematics import Direction, Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.short_repr import short_repr


@short_repr
@dataclass(frozen=True, eq=False)
class Hung:
    """Loads, forces and ties of a structure, and the friction of its crossing walls.

    Parameters
    ----------
    placed : sequence of (tuple, Attached)
        Each attached thing with its place among the fields of the structure.
    """

    placed: Sequence[tuple[Loc, Attached]]

    @cached_property
    def things(self) -> Sequence[Attached]:
        """All attached things, as terms of the equation of motion."""
        return [attached for _, attached in self.placed]

    @cached_property
    def elements(self) -> Sequence[Element]:
        """The attached things whose force follows from an elongation."""
        return [attached for attached in self.things if isinstance(attached, Element)]

    @property
    def masses(self) -> Sequence[PointMass]:
        """Loads that have a mass."""
        return [attached for attached in self.things if isinstance(attached, PointMass)]

    @property
    def ties(self) -> Sequence[Element]:
        """Elements that are stretched: ties and beds of springs."""
        return [each for each in self.elements if each.stretched]

    @property
    def bars(self) -> Sequence[SteelBar]:
        """Passive ties of steel."""
        return [each for each in self.elements if isinstance(each, SteelBar)]

    @cached_property
    def one_sided(self) -> Sequence[Stretched]:
        """Ties that act in one sense only, tension or compression."""
        return [tie for each in self.elements for tie in each.stretched if tie.only is not None]

    def refuses(self, question: Question) -> str | None:
        """Return why a question has no answer, as a sentence; None if it has one."""
        fault = self.fault(question)
        return f"{NO_ANSWER[question]}: {fault}" if fault is not None else None

    def fault(self, question: Question) -> str | None:
        """Return the element that prevents an answer to a question, and why, in words; None if there is none."""
        refusals = ((each.name, each.refuses(question)) for each in self.elements)
        return next((f"{name} {why}" for name, why in refusals if why), None)

    def ask(self, question: Question) -> None:
        """Raise `InputError` if the elements prevent an answer to a question."""
        if why := self.refuses(question):
            raise InputError(Problem(why, field="ties"))

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the terms of all attached things to the coefficients `total`."""
        for attached in self.things:
            attached.act(total, direction, follow)

    def slackness(self, follow: Follow, count: int) -> Reals:
        """Return a value that is zero where a tie goes slack, for each one-sided tie, shape (ties, count)."""
        if not self.one_sided:
            return np.zeros((0, count))
        return np.array([each.slack_at(each.elongation(follow)[0]) for each in self.one_sided])

    def pressing(self, on: Container[str | None], direction: Direction, follow: Follow, gravity: float) -> float:
        """Return the downward force at rest of the loads and ties on some bodies [N].

        Parameters
        ----------
        on : container of str
            Names of the bodies.
        direction : Direction
            Direction of rocking, which gives a tie of zero length at rest its direction.
        follow : callable
            Function that gives the path of a point, evaluated at rest.
        gravity : float
            Gravitational acceleration [m/s2].
        """
        weights = (attached.mass * attached.weight for attached in self.masses if attached.spot.body in on)
        pushes = (
            push for attached in self.things for push in attached.forces(direction, follow) if push.spot.body in on
        )
        return gravity * sum(weights) - sum(float(push.force.imag[0]) for push in pushes)

    @property
    def carried(self) -> float:
        """Sum of the loads' masses that count as weight [kg]."""
        return sum(attached.mass * attached.weight for attached in self.masses)

    @property
    def lifting(self) -> float:
        """Sum of the upward components of constant forces [N]."""
        return sum(each.thrust.imag for each in self.elements if isinstance(each, ConstantForce))
