"""Joints of a mechanism, and the same as contacts: the pieces in contact, the contact points and the friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rocking_cli.core.bodies import Body
from rocking_cli.core.sketch import Hinge
from rocking_cli.short_repr import short_repr


@dataclass(frozen=True)
class Joint(Hinge):
    """A hinge at which a corner bears on a face, or a guide that restrains a point sideways.

    Parameters
    ----------
    letter : str
        Letter of the joint.
    point : complex
        Position at rest [m].
    bodies : tuple of str
        The two bodies it joins, the supporting one first; or the one that the ground supports.
    slide : complex
        For a guide, the direction in which its point may move. A guide has no face, and is not checked.
    normal : complex
        Normal of the face at rest, towards the last of `bodies`: upwards under a body that stands on the face.
    face : str, optional
        The body with which the face rotates; None if the face does not rotate, as that of the ground.
    level : bool
        Whether it represents several identical joints, at unknown places, that keep the body they support level. Forces
        are then sums over all of them, and moments on the last of `bodies` are distributed among them.
    """

    normal: complex = 1j
    face: str | None = None
    level: bool = False

    @property
    def is_guide(self) -> bool:
        """Whether the joint is a guide, which only restrains a point sideways."""
        return self.slide != 0


@dataclass(frozen=True)
class Piece:
    """A rigid block between joints: a whole body, or a part of a body that stays in contact with its other parts.

    Parameters
    ----------
    body : Body
        Mass, inertia and centroid of the piece, with the name of the piece.
    of : str or None
        The body of the mechanism with which the piece moves; None if it stays at rest.
    shift : complex
        How far beside that body the piece stands, if it is one of several that the body represents [m].
    """

    body: Body
    of: str | None
    shift: complex = 0j


MASONRY_FRICTION = 0.6
"""The coefficient of friction that joints of masonry usually have."""
Held = Literal["slide", "level", "fixed"]


@short_repr
@dataclass(frozen=True)
class Contact:
    """A contact, or another joint, in one direction of rocking.

    Parameters
    ----------
    pieces : tuple of str or None
        The supporting piece, and the piece that it supports; None for the ground, or a body at rest.
    points : tuple of complex
        Contact points at rest [m]: the one point of a hinge, or both ends of a joint that stays closed. A joint may
        have other contact points in the other direction of rocking.
    normal : complex
        Unit normal of the contact face at rest, from the first piece into the second. For a guide: the direction in
        which it restrains its point.
    face : str, optional
        The piece with which the normal rotates; None if the normal is fixed.
    friction : float, optional
        Coefficient of friction; None if the contact never slides.
    roll : float
        Radius of a rounded edge [m]; `points` has the centre of the edge, and the contact is below this centre.
    held : {"slide", "level", "fixed"}, optional
        A joint other than a contact, which can neither open nor slide: a guide that restrains its point along the
        normal, a restraint that keeps the second piece level, or a rigid connection of the two pieces.
    name : str
        Name of the contact; by default the names of both pieces. A joint has the same name in both directions.
    letter : str
        Letter of the hinge in drawings, see `Joint`; empty if it has none.
    pressed_by : str
        Of a guide that holds by friction under a load: the name of this load; empty if something else holds it.
    """

    pieces: tuple[str | None, str | None]
    points: tuple[complex, ...]
    normal: complex = 1j
    face: str | None = None
    friction: float | None = None
    roll: float = 0.0
    held: Held | None = None
    name: str = ""
    letter: str = ""
    pressed_by: str = ""

    @property
    def label(self) -> str:
        """Name of the contact in messages."""
        return self.name or " and ".join(name or "the ground" for name in self.pieces)

    @property
    def support(self) -> str:
        """Name of a guide in messages, by the piece that it supports."""
        one, other = self.pieces
        return f"the support of {other}" if one is None else f"the smooth contact of {one} and {other}"

    @property
    def forces(self) -> int:
        """Number of force components of the joint: of a contact, one at each point and one along its face."""
        return len(self.points) + 1 if self.held is None else {"slide": 1, "level": 1, "fixed": 3}[self.held]


def of_joints(joints: Sequence[Joint], friction: float | None) -> list[Contact]:
    """Return the hinges and guides of a direction of rocking as contacts.

    Parameters
    ----------
    joints : sequence of Joint
        Joints of the direction, as `Mechanism.joints` gives them.
    friction : float or None
        Coefficient of friction of all joints.
    """
    contacts = []
    for joint in joints:
        bears, borne = (None, *joint.bodies)[-2:]
        if joint.is_guide:
            contacts.append(Contact((None, borne), (joint.point,), 1j * joint.slide / abs(joint.slide), held="slide"))
            continue
        at = (joint.point,)
        contacts.append(
            Contact((bears, borne), at, joint.normal, joint.face, friction, joint.roll, letter=joint.letter)
        )
        if joint.level:
            contacts.append(Contact((bears, borne), at, held="level"))
    return contacts
