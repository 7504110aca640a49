"""Base class of all mechanism plugins: what follows from a mechanism, with the loads and ties attached to it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from math import nan, sqrt
from typing import Any, final

import numpy as np
from pydantic import ValidationError

from rocking_cli.core import equilibrium
from rocking_cli.core.answers import Jointed, Kinematics
from rocking_cli.core.checks import check
from rocking_cli.core.coefficients import Coefficients, coefficients
from rocking_cli.core.given import DirectionalRestitution
from rocking_cli.core.hung.attached import Attached, Follow
from rocking_cli.core.hung.attachments import (
    Carrier,
    Loc,
    RefusedFields,
    as_validation_error,
    attach,
    far_off,
    followed,
    interlocked,
)
from rocking_cli.core.hung.everything import Hung
from rocking_cli.core.hung.interlock import NAME as INTERLOCK
from rocking_cli.core.kinematics import Direction, Reals
from rocking_cli.core.restitution import kinematic_restitution
from rocking_cli.core.results import Extra
from rocking_cli.core.sketch import Outline
from rocking_cli.errors import InputError, Problem
from rocking_cli.plugins.errors import failed, guard


class Mechanism(Jointed):
    """A rocking structure with one degree of freedom.

    A plugin subclasses it, declares its geometry as fields made with `quantity`, and gives the motion of its rigid
    bodies in `bodies`, `motion` and `limit`. Energies, uplift, critical rotation, equivalence and restitution follow
    here from these, with the loads and ties of the structure. What is final cannot be overridden; all else can, with
    effect whether or not anything is attached. `sketch` adds to the drawing, and `contacts` gives the joints.

    If a structure gives no masses, its total mass is 1 kg, so that inertias and moments are per kilogram.
    """

    def _hold_together(self) -> None:
        """Check the masses, loads and ties against the bodies; raise `ValidationError` of the fields."""
        try:
            check(self)
        except RefusedFields as error:
            raise as_validation_error([error], self.mechanism) from error

    @classmethod
    def __pydantic_init_subclass__(cls, **named: Any) -> None:
        """Refuse overrides of what is final, and report any failure in the others as an error of the plugin."""
        super().__pydantic_init_subclass__(**named)
        for name in vars(cls):
            if any(_is_final(vars(base).get(name)) for base in cls.__mro__[1:]):
                hint = f": give a closed form as `{name}_alone`" if hasattr(cls, f"{name}_alone") else ""
                raise TypeError(f"{cls.__name__} cannot override {name}, which follows from bodies and motion{hint}")
        answers = [name for base in Mechanism.__mro__ if issubclass(base, Kinematics) for name in vars(base)]
        guard(cls, [name for name in answers if name[0] != "_"], failed("mechanism", "mechanism"), but=RefusedFields)

    def columns_alone(self) -> Sequence[Mechanism]:
        """Return each column by itself, one of those that are equal, if three or more carry one beam; else none."""
        return ()

    @final
    def cautions(self) -> Sequence[str]:
        """Return cautions on the results: the `caution` of the mechanism, and that of this structure."""
        return [text for text in (self.caution, self.own_caution()) if text]

    @final
    def borne(self, direction: Direction, *bodies: str) -> float:
        """Return the weight at rest of some bodies, or of all, with the loads and ties on them [N]."""
        on = bodies or tuple(body.name for body in self.bodies())
        weight = self.gravity * sum(body.mass for body in self.weighed() if body.name in on)
        return weight + self.hung.pressing(on, direction, self.followed(np.zeros(1), direction), self.gravity)

    @final
    def inwards(self, direction: Direction, joint: str) -> float:
        """Return the distance by which crushing moves a joint inwards [m], constant during the motion."""
        return self.moved_inwards[direction][joint] if self.crushing is not None else 0.0

    @cached_property
    @final
    def moved_inwards(self) -> Mapping[Direction, Mapping[str, float]]:
        """Distances u = N/(2 strength depth) by which joints of each direction move [m]; empty if none can move."""
        if self.crushing is None:
            return {}
        try:
            sound = self.model_copy(update={"crushing": None})
        except ValidationError as error:
            raise RefusedFields.first_of(error) from None
        per_metre = 2 * self.crushing.strength * (self.crushing.depth or self.depth or 1.0)
        moved = {direction: sound.bearing(direction) for direction in Direction}
        found = {s: {joint: max(force, 0.0) / per_metre for joint, force in moved[s].items()} for s in Direction}
        return found if all(found.values()) else {}

    @final
    def found(self, direction: Direction) -> Sequence[Extra]:
        """Return all further results: `extras`, and the distances by which crushing moves the pivots."""
        what = "how far crushing moves the {} inwards"
        moved = self.moved_inwards.get(direction, {}).items()
        return [*self.extras(direction), *(Extra(f"inwards_{key}", u, "m", what.format(key)) for key, u in moved)]

    @cached_property
    @final
    def hung(self) -> Hung:
        """Loads, forces and ties of the structure, with what the mechanism `carries`."""
        found: list[tuple[Loc, Attached]] = [((), thing) for thing in self.carries()]
        if self.is_laden:
            taken = [*(thing.name for _, thing in found), *([INTERLOCK] if self.interlock is not None else [])]
            found += attach(self.carrier, self.loads or [], self.ties or [], taken)
        if self.interlock is not None:
            friction = interlocked(self.interlock, self.carrier, self.density, self.gravity)
            found.append((("interlock",), friction))
        return Hung(found)

    @property
    @final
    def carrier(self) -> Carrier:
        """The bodies to which loads and ties are attached, with their outlines if these are known."""
        bodies = self.bodies()
        outlines: dict[str, Sequence[Outline]] = {body.name: [body.outline] for body in bodies if body.outline}
        if len(outlines) < len(bodies) and (sketch := self.sketch()).uniform:
            outlines = {**sketch.outlines, **outlines}
        return Carrier({body.name: body for body in bodies}, outlines, self.alike(), self.piece)

    @final
    def far_off(self) -> list[str]:
        """Return a sentence, without a full stop, for each load that is far from the body that carries it."""
        return list(far_off(self.carrier, self.loads)) if self.loads else []

    @property
    @final
    def attached(self) -> Sequence[Attached]:
        """All that is attached to the mechanism, as terms of its equation of motion."""
        return self.hung.things

    @final
    def slackness(self, phi: Reals, direction: Direction) -> Reals:
        """Return a value that is zero where a tie goes slack, for each one-sided tie, shape (ties, n)."""
        return self.hung.slackness(self.followed(np.asarray(phi, dtype=np.float64), direction), np.size(phi))

    @property
    def bends(self) -> bool:
        """Whether the restoring moment may have any shape, so that the linear models must be checked."""
        return bool(self.attached)

    @property
    def smooth(self) -> bool:
        """Whether the derivatives of the restoring moment have no corners, as where a tie goes slack."""
        return not self.hung.one_sided

    @property
    @final
    def is_bare(self) -> bool:
        """Whether the structure is the mechanism alone, without given masses, loads and ties."""
        return self.total_mass() is None and not self.hung.placed

    @final
    def followed(self, phi: Reals, direction: Direction) -> Follow:
        """Return a function that gives the path of a point over rotations, shape (n,) [rad]."""
        return followed(self.bodies(), self.motion(phi, direction), phi.shape)

    @final
    def coefficients(self, phi: Reals, direction: Direction) -> Coefficients:
        """Return the coefficients I, J, G, B of the equation of motion over `phi`, shape (n,) [paper, Eq. 8].

        They include loads and ties: see `rocking_cli.core.hung.attached`.
        """
        phi = _rotations(phi)
        bodies, motions = self.weighed(), self.motion(phi, direction)
        total = coefficients(phi, direction, bodies, motions)
        if self.hung.placed:
            self.hung.act(total, direction, followed(bodies, motions, phi.shape))
        return total

    @final
    def kinetic_inertia(self, phi: Reals, direction: Direction) -> Reals:
        """Return I(phi) [kg m2], shape (n,): the kinetic energy is I phi.^2 / 2."""
        return self.coefficients(phi, direction).I

    @final
    def potential_energy(self, phi: Reals, direction: Direction) -> Reals:
        """Return V(phi) [J], shape (n,), zero at rest; it includes the energy stored in ties."""
        here = self.coefficients(phi, direction)
        return self.gravity * here.V + here.U

    @final
    def uplift(self, direction: Direction) -> float:
        """Return lambda, the ground acceleration that starts rocking, over g [paper, Eq. 10]."""
        return equilibrium.uplift_acceleration(self.coefficients(np.zeros(1), direction), self.gravity)

    @final
    def critical_rotation(self, direction: Direction) -> float:
        """Return phi_cr, the rotation of unstable equilibrium [rad; paper, Eq. 9].

        Raises `NoCriticalRotation` if there is none.
        """
        alone = self.critical_rotation_alone(direction) if self.is_bare else None
        return self.solved_critical_rotation(direction) if alone is None else alone

    @final
    def solved_critical_rotation(self, direction: Direction) -> float:
        """Return phi_cr from the coefficients, without regard to a closed form [rad]. Raises `NoCriticalRotation`."""
        limit = self.limit(direction)
        grid = np.linspace(0.0, limit, equilibrium.SCAN_POINTS)[:-1]
        low, high = equilibrium.first_fall(self.coefficients(grid, direction), limit, self.gravity)
        phi = (low + high) / 2
        for _ in range(100):
            here = self.coefficients(np.array([phi]), direction)
            low, high, guess = equilibrium.narrowed(here, low, high, self.gravity)
            if abs(guess - phi) <= 4 * np.finfo(float).eps * phi:
                break
            phi = guess
        return phi

    @final
    def restitution_from_kinematics(self, direction: Direction) -> float:
        """Return eta of an impact that ends motion in `direction`, from the kinematics alone; it may be <= 0."""
        motions = self.motion(np.zeros(1), direction), self.motion(np.zeros(1), direction.opposite)
        return kinematic_restitution(self.weighed(), *motions, self.hung.masses)

    @final
    def greatest_restitution(self, direction: Direction) -> float:
        """Return the eta of an impact that ends motion in `direction` and keeps all energy.

        The inertia at rest is I(0) before the impact and I'(0), that of the other direction, after it. The ratio of the
        energies after and before the impact is eta^2 I'(0)/I(0), so the bound is sqrt(I(0)/I'(0)), which is 1 for a
        symmetric structure.
        """
        before, after = (float(self.kinetic_inertia(np.zeros(1), s)[0]) for s in (direction, direction.opposite))
        return sqrt(before / after)

    @final
    def eta(self, direction: Direction) -> float:
        """Return eta of an impact that ends motion in `direction`: as given, or else from the kinematics.

        If the structure rocks to one side only, this is the rebound: NaN if it is neither given nor known from the
        shape, as only time histories need it.
        """
        if not self.rocks_both_ways:
            rebound = self.rebound if self.rebound is not None else self.rebound_from_impacts()
            return nan if rebound is None else rebound
        if isinstance(self.restitution, DirectionalRestitution):
            given = self.restitution
            return given.positive_to_negative if direction > 0 else given.negative_to_positive
        return self.restitution if self.restitution is not None else self.restitution_from_kinematics(direction)


def _rotations(phi: Any) -> Reals:
    """Return rotations as an array of reals. Raises `InputError` if they are not numbers in an array."""
    try:
        found = np.asarray(phi, dtype=np.float64)  # whole numbers too, which hold no sums of reals
    except (TypeError, ValueError):
        found = np.zeros(())
    if found.ndim == 0:
        raise InputError(Problem(f"must be an array of rotations, got {phi!r}", field="phi", hint="write [0.1]"))
    return found


def _is_final(member: object) -> bool:
    """Return whether a method or a property of a class is marked as final."""
    return any(getattr(getattr(member, key, member), "__final__", False) for key in ("fget", "func", "__func__"))
