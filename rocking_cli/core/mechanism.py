"""Base class of all mechanism plugins: a plugin gives bodies and their motion, and all else follows from these."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, partial, wraps
from inspect import isfunction
from math import nan, sqrt
from typing import Any, ClassVar

import numpy as np
from pydantic import ValidationError

from rocking_cli.core import checks, equilibrium
from rocking_cli.core.bodies import Body, area_of, weighed
from rocking_cli.core.coefficients import Coefficients, coefficients
from rocking_cli.core.collapse import CollapseMechanism
from rocking_cli.core.contacts import Contact, Piece, of_joints
from rocking_cli.core.extras import Extra
from rocking_cli.core.given import DirectionalRestitution, Given
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
from rocking_cli.core.joints import Joint
from rocking_cli.core.kinematics import Direction, Reals, RigidMotion
from rocking_cli.core.restitution import kinematic_restitution
from rocking_cli.core.sketch import Sketch
from rocking_cli.errors import InputError, Problem
from rocking_cli.plugins.errors import failed, guard

ANSWERS = (
    "bodies", "motion", "limit", "sketch", "joints", "pieces", "piece_at", "contacts", "alike", "volume", "total_mass",
    "carries", "extras", "bearing",
    "coefficients", "kinetic_inertia", "potential_energy", "uplift", "rebound_from_impacts", "critical_rotation",
    "restitution_from_kinematics", "eta",
)  # fmt: skip
"""The methods of `Mechanism` in which a plugin says or overrides what its mechanics is."""
OF_THE_BARE = (
    "coefficients", "kinetic_inertia", "potential_energy", "uplift", "critical_rotation", "restitution_from_kinematics",
)  # fmt: skip
"""Those whose overrides are closed forms of the bare mechanism: with loads or ties the general solvers answer."""


class Mechanism(Given, ABC):
    """A rocking structure with one degree of freedom.

    A plugin subclasses it, declares its geometry as fields made with `quantity`, and gives the motion of its rigid
    bodies in `bodies`, `motion` and `limit`. Energies, uplift, critical rotation, equivalence and restitution are
    derived here; a plugin may override a solver by its closed form. `sketch` may add to the drawing.

    If a structure gives no masses, its total mass is 1 kg, so that inertias and moments are per kilogram.
    """

    title: ClassVar[str]
    """What it is, in a few words."""
    source: ClassVar[str]
    """The publication and its equations."""
    verified: ClassVar[str] = ""
    """What its numbers were checked against; empty means nobody has, and the tool says so."""
    caution: ClassVar[str] = ""
    """A sentence or two, which the tool shows, on where its answers are unsafe or mean less than they seem."""
    jumps: ClassVar[str] = ""
    """Cause of a jump of the motion, with a remedy, if the structure's file gives the motion; empty by default."""
    starter: ClassVar[tuple[str, ...]] = ()
    """Optional fields that a first file needs all the same, such as one of two ways to give the masses."""

    def _hold_together(self) -> None:
        """Check the masses, loads and ties against the bodies; raise `ValidationError` of the fields."""
        try:
            checks.check_masses(self)
            if self.crushing is not None:
                checks.check_crushed(self._inwards, self._at_rest(), self.gravity)
            checks.check_one_sided(self, self.rebound_from_impacts)
            self._mass_factor  # noqa: B018 - a density without a volume is refused here
            checks.check_strength(self)
            if self.is_laden:
                checks.check_weighs(self)
            checks.check_restitution(self, self.eta, self.greatest_restitution)
            if self.is_laden:
                self.hung.check_stretched(self.followed, self.limit, self.directions)
                bare = {
                    s: coefficients(np.zeros(1), s, self.bodies(), self.motion(np.zeros(1), s)) for s in self.directions
                }
                checks.check_stands(self, self.hung, sum(body.mass for body in self.weighed()), self._at_rest(), bare)
        except RefusedFields as error:
            raise as_validation_error([error], self.mechanism) from error

    def _at_rest(self) -> Mapping[Direction, Coefficients]:
        return {direction: self.coefficients(np.zeros(1), direction) for direction in self.directions}

    @classmethod
    def __pydantic_init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of a plugin, so that any failure in them is reported as an error of the plugin."""
        super().__pydantic_init_subclass__(**named)
        guard(cls, ANSWERS, failed("mechanism", "mechanism"), but=RefusedFields)
        for name in OF_THE_BARE:
            if isfunction(own := vars(cls).get(name)):
                setattr(cls, name, _of_the_bare(own))

    @abstractmethod
    def bodies(self) -> Sequence[Body]:
        """Return the rigid bodies, each rigid in both directions of rocking."""

    @abstractmethod
    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        """Return the motion of each body, in the order of `bodies`, over rotations `phi`, shape (n,) [rad, >= 0]."""

    @abstractmethod
    def limit(self, direction: Direction) -> float:
        """Return the rotation phi [rad] at which the mechanism ends, because it lies on the ground or locks."""

    def sketch(self) -> Sketch:
        """Return what a drawing shows beside the bodies and their motion; by default nothing."""
        return Sketch()

    def _shapes(self) -> Sketch:
        """Return the sketch of the bodies' shapes, without anything that is attached to them."""
        return self.sketch()

    def joints(self, direction: Direction) -> Sequence[Joint]:
        """Return the joints between bodies and with the ground, for the check of time histories; by default none."""
        return ()

    def pieces(self, direction: Direction) -> Sequence[Piece]:
        """Return the rigid blocks between all joints, also those that stay closed; by default the bodies."""
        return [Piece(body, body.name) for body in self.weighed()]

    def piece_at(self, body: str, at: complex, direction: Direction) -> str:
        """Return the name of the piece on which a point of a body lies; by default that of the body."""
        return body

    def contacts(self, direction: Direction) -> Sequence[Contact] | None:
        """Return the joints between pieces, and with the ground, in a direction; None if they are not known.

        Time histories are checked against them. By default they are the `joints` of a structure of one body; of several
        bodies it is not known which joints stay closed, so that their histories are not checked.
        """
        joints = self.joints(direction)
        return of_joints(joints, self.friction) if joints and len(self.bodies()) == 1 else None

    def contacts_at_rest(self) -> Sequence[Contact] | None:
        """Return the joints of a structure at rest; by default those of all its directions, None if not known.

        A joint of two directions is given twice, with the points at which it touches in each.
        """
        each = [self.contacts(direction) for direction in self.directions]
        return [contact for contacts in each for contact in contacts or ()] if all(each) else None

    @property
    def propped(self) -> bool:
        """Whether another of its bodies keeps a structure from rocking the other way; by default False."""
        return False

    def columns_alone(self) -> Sequence[Mechanism]:
        """Return each column by itself, one of those that are equal, if three or more carry one beam; else none."""
        return ()

    @property
    def unchecked(self) -> str:
        """Why `contacts` are not known, or what to give so that they are, in words."""
        return "it does not say which of them stay closed"

    def alike(self) -> Mapping[str, int]:
        """Return the number of identical bodies that a body represents, by name, if more than one; by default none."""
        return {}

    def collapse(self, direction: Direction) -> CollapseMechanism | None:
        """Return the weakest mechanism of a direction, if the structure searches for it; by default None."""
        return None

    def piece(self, body: str, at: complex) -> str:
        """Return the name of the part of a cracked body on which a point lies; by default that of the body."""
        return body

    def carries(self) -> Sequence[Attached]:
        """Return what the mechanism's own fields attach beside loads and ties, such as a floor; by default nothing."""
        return ()

    def cautions(self) -> Sequence[str]:
        """Return cautions on the results: the `caution` of the mechanism, and that of this structure."""
        return [text for text in (self.caution, self.own_caution()) if text]

    def own_caution(self) -> str:
        """Return a caution on the results of this structure in particular; by default an empty text."""
        return ""

    def asserted(self) -> Sequence[str]:
        """Return the joints that are assumed to hold without a check, in words: by default, supports."""
        each = [contact for direction in self.directions for contact in self.contacts(direction) or ()]
        held = [contact for contact in each if contact.held == "slide" and not contact.pressed_by]
        stops = [] if self.rocks_both_ways or self.propped or len(self.bodies()) == 1 else ["what it leans on"]
        return [*dict.fromkeys(contact.support for contact in held), *stops]

    def extras(self, direction: Direction) -> Sequence[Extra]:
        """Return further results of interest to users, such as the height of the hinge; shown by `equiv`."""
        return ()

    def bearing(self, direction: Direction) -> Mapping[str, float]:
        """Return the normal force at rest of each joint that `crushing` moves, by name [N]; empty if it can move none.

        This method is called on the structure without crushing. A mechanism that returns joints here moves them by
        `inwards`.
        """
        return {}

    def borne(self, direction: Direction, *bodies: str) -> float:
        """Return the weight at rest of some bodies, or of all, with the loads and ties on them [N]."""
        on = bodies or tuple(body.name for body in self.bodies())
        weight = self.gravity * sum(body.mass for body in self.weighed() if body.name in on)
        return weight + self.hung.pressing(on, direction, self.followed(np.zeros(1), direction), self.gravity)

    def inwards(self, direction: Direction, joint: str) -> float:
        """Return the distance by which crushing moves a joint inwards [m], constant during the motion."""
        return self._inwards[direction][joint] if self.crushing is not None else 0.0

    @cached_property
    def _inwards(self) -> Mapping[Direction, Mapping[str, float]]:
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

    def found(self, direction: Direction) -> Sequence[Extra]:
        """Return all further results: `extras`, and the distances by which crushing moves the pivots."""
        what = "how far crushing moves the {} inwards"
        moved = self._inwards.get(direction, {}).items()
        return [*self.extras(direction), *(Extra(f"inwards_{key}", u, "m", what.format(key)) for key, u in moved)]

    def volume(self) -> float:
        """Return the volume to which `density` applies [m3]: by default the area of the outlines times `depth`."""
        deep, sketch = self.given_depth, self.sketch()
        area = 0.0
        for body in self.bodies():
            shapes = body.shapes(sketch.outlines if sketch.uniform else {})
            if not shapes:
                raise RefusedFields((), "density", f"the shape of its {body.name} is not known: give its mass instead")
            area += sum(abs(area_of(shape)) for shape in shapes)
        return area * deep

    def total_mass(self) -> float | None:
        """Return the given mass of the structure [kg]; None if not given, or if `bodies` have their own masses."""
        if self.mass is not None or self.density is None:
            return self.mass
        return self.density * self.volume()

    @cached_property
    def _mass_factor(self) -> float:
        """Factor on the masses of `bodies` that gives the total mass."""
        total = self.total_mass()
        return 1.0 if total is None else total / sum(body.mass for body in self.bodies())

    def weighed(self) -> Sequence[Body]:
        """Return the bodies with the given masses of the structure."""
        return weighed(self.bodies(), self._mass_factor)

    @cached_property
    def hung(self) -> Hung:
        """Loads, forces and ties of the structure, with what the mechanism `carries`."""
        found: list[tuple[Loc, Attached]] = [((), thing) for thing in self.carries()]
        if self.is_laden:
            taken = [*(thing.name for _, thing in found), *([INTERLOCK] if self.interlock is not None else [])]
            found += attach(self._carrier, self.loads or [], self.ties or [], taken)
        if self.interlock is not None:
            friction = interlocked(self.interlock, self._carrier, self.density, self.gravity)
            found.append((("interlock",), friction))
        return Hung(found)

    @property
    def _carrier(self) -> Carrier:
        return Carrier.of(self.bodies(), self._shapes(), self.alike(), self.piece)

    def far_off(self) -> list[str]:
        """Return a sentence, without a full stop, for each load that is far from the body that carries it."""
        return list(far_off(self._carrier, self.loads)) if self.loads else []

    @property
    def attached(self) -> Sequence[Attached]:
        """All that is attached to the mechanism, as terms of its equation of motion."""
        return self.hung.things

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
    def is_bare(self) -> bool:
        """Whether the structure is the mechanism alone, without given masses, loads and ties."""
        return self.total_mass() is None and not self.hung.placed

    def followed(self, phi: Reals, direction: Direction) -> Follow:
        """Return a function that gives the path of a point over rotations, shape (n,) [rad]."""
        return followed(self.bodies(), self.motion(phi, direction), phi.shape)

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

    def kinetic_inertia(self, phi: Reals, direction: Direction) -> Reals:
        """Return I(phi) [kg m2], shape (n,): the kinetic energy is I phi.^2 / 2."""
        return self.coefficients(phi, direction).I

    def potential_energy(self, phi: Reals, direction: Direction) -> Reals:
        """Return V(phi) [J], shape (n,), zero at rest; it includes the energy stored in ties."""
        here = self.coefficients(phi, direction)
        return self.gravity * here.V + here.U

    def uplift(self, direction: Direction) -> float:
        """Return lambda, the ground acceleration that starts rocking, over g [paper, Eq. 10]."""
        return equilibrium.uplift_acceleration(partial(self.coefficients, direction=direction), self.gravity)

    def critical_rotation(self, direction: Direction) -> float:
        """Return phi_cr, the rotation of unstable equilibrium [rad; paper, Eq. 9].

        Raises `NoCriticalRotation` if there is none.
        """
        return equilibrium.critical_rotation(
            partial(self.coefficients, direction=direction), self.limit(direction), self.gravity
        )

    def restitution_from_kinematics(self, direction: Direction) -> float:
        """Return eta of an impact that ends motion in `direction`, from the kinematics alone; it may be <= 0."""
        motions = self.motion(np.zeros(1), direction), self.motion(np.zeros(1), direction.opposite)
        return kinematic_restitution(self.weighed(), *motions, self.hung.masses)

    def greatest_restitution(self, direction: Direction) -> float:
        """Return the eta of an impact that ends motion in `direction` and keeps all energy.

        The inertia at rest is I(0) before the impact and I'(0), that of the other direction, after it. The ratio of the
        energies after and before the impact is eta^2 I'(0)/I(0), so the bound is sqrt(I(0)/I'(0)), which is 1 for a
        symmetric structure.
        """
        before, after = (float(self.kinetic_inertia(np.zeros(1), s)[0]) for s in (direction, direction.opposite))
        return sqrt(before / after)

    def rebound_from_impacts(self) -> float | None:
        """Return the rebound from a theory of impacts in sequence; by default None, as there is none for the shape."""
        return None

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


def _of_the_bare(own: Callable[..., Any]) -> Callable[..., Any]:
    """Return a method that uses `own` for the bare mechanism, and the general solver of its name otherwise."""
    general = getattr(Mechanism, own.__name__)

    @wraps(own)
    def answer(self: Mechanism, *args: Any, **named: Any) -> Any:
        return own(self, *args, **named) if self.is_bare else general(self, *args, **named)

    return answer
