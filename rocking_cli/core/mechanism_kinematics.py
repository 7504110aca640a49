"""What a mechanism answers: its drawing, its kinematics, its joints as contacts, and results of its own.

A plugin defines what has no default, and may override everything else here.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, final

from rocking_cli.core.bodies import Body, Solid, weighed
from rocking_cli.core.contacts import Contact, Joint, Piece, of_joints
from rocking_cli.core.hung.attached import Attached
from rocking_cli.core.hung.attachments import RefusedFields
from rocking_cli.core.kinematics import Direction, Reals, RigidMotion, area_of
from rocking_cli.core.sketch import Sketch
from rocking_cli.core.structure_fields import StructureFields
from rocking_cli.short_repr import short_repr


class Kinematics(StructureFields, ABC):
    """Bodies of a mechanism, their motion and their drawing, without loads and ties."""

    title: ClassVar[str]
    """Title of the mechanism, in a few words."""
    suits: ClassVar[str] = ""
    """Structures that it is meant for, in a few words; by default the list of mechanisms shows the title instead."""
    source: ClassVar[str]
    """The publication and its equations."""
    verified: ClassVar[str] = ""
    """Reference that its results were checked against; if empty, the tool warns that nobody has checked them."""
    caution: ClassVar[str] = ""
    """One or two sentences, shown to users, on cases in which its results are unsafe or of limited meaning."""
    jumps: ClassVar[str] = ""
    """Cause of a jump of the motion, with a remedy, if the structure's file gives the motion; empty by default."""
    starter: ClassVar[tuple[str, ...]] = ()
    """Optional fields that a template includes, such as one of two alternatives for the masses."""

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

    @property
    def driven(self) -> float:
        """Share of the horizontal ground motion that acts in the plane of motion, a factor on B; by default 1."""
        return 1.0

    def critical_rotation_alone(self, direction: Direction) -> float | None:
        """Return phi_cr without masses, loads and ties in closed form [rad]; by default None, for the solver."""
        return None

    def round_foot(self) -> tuple[float, float] | None:
        """Return radius of a round foot [m], and inertia of the body about its axis over its mass [m2]; None if not."""
        return None

    def rebound_from_impacts(self) -> float | None:
        """Return the rebound from a theory of impacts in sequence; by default None, as there is none for the shape."""
        return None

    def alike(self) -> Mapping[str, int]:
        """Return the number of identical bodies that a body represents, by name, if more than one; by default none."""
        return {}

    def piece(self, body: str, at: complex) -> str:
        """Return the name of the part of a cracked body on which a point lies; by default that of the body."""
        return body

    def carries(self) -> Sequence[Attached]:
        """Return what the mechanism's own fields attach beside loads and ties, such as a floor; by default nothing."""
        return ()

    def bearing(self, direction: Direction) -> Mapping[str, float]:
        """Return the normal force at rest of each joint that `crushing` moves, by name [N]; empty if it can move none.

        This method is called on the structure without crushing. A mechanism that returns joints here moves them by
        `inwards`.
        """
        return {}

    def extras(self, direction: Direction) -> Sequence[Extra]:
        """Return further results of interest to users, such as the height of the hinge; shown by `equiv`."""
        return ()

    def own_caution(self) -> str:
        """Return a caution on the results of this structure in particular; by default an empty text."""
        return ""

    def collapse(self, direction: Direction) -> CollapseMechanism | None:
        """Return the weakest mechanism of a direction, if the structure searches for it; by default None."""
        return None

    def as_linkage(self) -> StructureFields | None:
        """Return the linkage that moves as the weakest mechanisms, if the structure searches for them; by default None.

        Raises `RockingError` if a mechanism has no rocking model, or a linkage cannot have its fields.
        """
        return None

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

    def solids(self) -> Mapping[str, Sequence[Solid]]:
        """Return the uniform parts of each body whose mass follows from its sizes and density, by name.

        By default its outlines, as plates of the density and depth of the structure. A body without parts has its mass
        from elsewhere. A mechanism that overrides `volume` gives its parts here, which are written out in calculations.
        """
        if self.density is None or self.depth is None or self.mass is not None:
            return {}
        sketch, density, depth = self.sketch(), self.density, self.depth
        shapes = {body.name: body.shapes(sketch.outlines if sketch.uniform else {}) for body in self.bodies()}
        return {name: [Solid.of_outline(shape, density, depth) for shape in each] for name, each in shapes.items()}

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

    @final
    def weighed(self) -> Sequence[Body]:
        """Return the bodies with the given masses of the structure."""
        return weighed(self.bodies(), self._mass_factor)


class Jointed(Kinematics):
    """Joints of a mechanism, which time histories are checked against."""

    def joints(self, direction: Direction) -> Sequence[Joint]:
        """Return the joints between bodies and with the ground, for the check of time histories; by default none."""
        return ()

    def guiding_joints(self, direction: Direction) -> Sequence[Joint]:
        """Return the hinges and guides from which the motion follows; by default `joints`, empty if not known.

        The line of a guide with two bodies turns with the first. A joint with one body is on the ground.
        """
        return self.joints(direction)

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
    def unchecked(self) -> str:
        """Why `contacts` are not known, or what to give so that they are, in words."""
        return "it does not say which of them stay closed"

    @property
    def propped(self) -> bool:
        """Whether one of its own bodies keeps the structure from rocking to the other side; by default False."""
        return False

    def asserted(self) -> Sequence[str]:
        """Return the joints that are assumed to hold without a check, in words: by default, supports."""
        each = [contact for direction in self.directions for contact in self.contacts(direction) or ()]
        held = [contact for contact in each if contact.held == "slide" and not contact.pressed_by]
        stops = [] if self.rocks_both_ways or self.propped or len(self.bodies()) == 1 else ["what it leans on"]
        return [*dict.fromkeys(contact.support for contact in held), *stops]


@dataclass(frozen=True)
class CollapseHinge:
    """A hinge between two groups of blocks: its name, its point at rest [m] and its joint.

    The joint is the pair of blocks that touch at the hinge.
    """

    letter: str
    between: tuple[str, str]
    at: complex
    joint: str = ""


@short_repr
@dataclass(frozen=True)
class CollapseMechanism:
    """Weakest mechanism of one direction.

    Parameters
    ----------
    lambda_ : float
        Ground acceleration over g that starts it.
    lead : str
        The block whose rotation is phi; empty if it slides.
    hinges : sequence of CollapseHinge
        In order from the left.
    groups : sequence of sequence of str
        Blocks that move as one.
    rest, lifted, slides, glued : sequence of str
        Blocks that do not move; joints that open at both ends; joints that slide; joints that carry shear without a
        normal force in the state shown. A joint is named by its two blocks.
    with_usual : float or None
        Lambda if the joints without a coefficient of friction have that usual of masonry; None if all have one.
    no_model : str
        Why its motion cannot be simulated beyond its start, a sentence without a full stop; empty if it can.
    friction_needed : float or None
        The least coefficient of friction of all joints at which lambda stays the same; None if there is none.
    valid_to : float or None
        Rotation at which another joint opens in displaced equilibrium [rad]; None if none opens before the critical
        rotation.
    opens : str
        The joint that opens at `valid_to`.
    held_by : float or None
        G/B at `valid_to`, the acceleration over g of displaced equilibrium.
    thrust : sequence of (str, complex, complex)
        Joint, point [m] and force [N] of one possible state of forces at the start of motion.
    velocities : sequence of (complex, float)
        Velocity of each group at the start of motion, up to a common factor: of its point at (0, 0) [m/s], and its
        rotation rate, anticlockwise [rad/s]. Without them a mechanism that has no rocking model is not drawn.
    idle : sequence of str
        Blocks at rest that may also move at the same lambda: then the mechanism is not the only one with this lambda.
    confined : bool
        Whether blocks are confined between fixed sides, so that mechanisms in which joints slide without opening were
        searched too.
    associated : float or None
        Lambda by associated flow, if a mechanism without dilation has a lower one and is shown; infinite if nothing
        moves by associated flow.
    complete : bool
        Whether the search for mechanisms without dilation was complete; if not, lambda may be even lower.
    """

    lambda_: float
    lead: str
    hinges: Sequence[CollapseHinge]
    groups: Sequence[Sequence[str]]
    rest: Sequence[str]
    lifted: Sequence[str]
    slides: Sequence[str]
    glued: Sequence[str]
    with_usual: float | None
    no_model: str
    friction_needed: float | None
    valid_to: float | None
    opens: str
    held_by: float | None
    thrust: Sequence[tuple[str, complex, complex]]
    velocities: Sequence[tuple[complex, float]] = ()
    idle: Sequence[str] = ()
    confined: bool = False
    associated: float | None = None
    complete: bool = True


@dataclass(frozen=True)
class Extra:
    """A result of one direction of rocking, such as the height of the hinge of a wall.

    Parameters
    ----------
    key : str
        Name of the result in JSON, other than those of the parameters of the equivalent block.
    value : float
        Value, in `unit`.
    unit : str
        Unit; empty if dimensionless.
    meaning : str
        Description, in a few words.
    """

    key: str
    value: float
    unit: str
    meaning: str
