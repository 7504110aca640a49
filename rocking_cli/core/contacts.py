"""The joints of a mechanism as contacts: which pieces bear on one another, at which points, and with what friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rocking_cli.core.bodies import Body
from rocking_cli.core.joints import Joint


@dataclass(frozen=True)
class Piece:
    """A rigid block between joints: a whole body, or a part of one that other parts of it stay in contact with.

    Parameters
    ----------
    body : Body
        Its mass, inertia and centroid, under a name of its own.
    of : str or None
        The body of the mechanism that it moves with; None: it rests.
    """

    body: Body
    of: str | None


MASONRY = 0.6
"""The coefficient of friction that joints of masonry usually have."""
Held = Literal["slide", "level", "fixed"]


@dataclass(frozen=True)
class Contact:
    """A joint as it bears in one direction of rocking.

    Parameters
    ----------
    pieces : tuple of str or None
        The piece that bears, and the one that it bears; None: the ground, or what rests.
    points : tuple of complex
        Where it bears, at rest [m]: the one point of a hinge, or both ends of a joint that stays closed. The joint has
        another role in the other direction of rocking if it bears at other points there.
    normal : complex
        Unit normal of its face at rest, from the first piece into the second. Of a guide: the direction in which it
        holds its point.
    face : str, optional
        The piece with which the normal turns; None: it does not turn.
    friction : float, optional
        Coefficient of friction; None: it never slides.
    roll : float
        Radius of a rounded edge, about the centre of which `points` is [m]: the piece bears below that centre.
    held : {"slide", "level", "fixed"}, optional
        What is no contact, and can neither open nor slide: a guide that holds its point along the normal, what keeps
        the second piece level, or what makes the two pieces one.
    name : str
        What to call it; by default the names of both pieces. The same joint has one name in both directions.
    letter : str
        The letter of a hinge in drawings, see `Joint`; empty if it has none.
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

    @property
    def label(self) -> str:
        """What messages call it."""
        return self.name or " and ".join(name or "the ground" for name in self.pieces)

    @property
    def forces(self) -> int:
        """How many forces it can exert: one at each point and one along its face, or what it holds."""
        return len(self.points) + 1 if self.held is None else {"slide": 1, "level": 1, "fixed": 3}[self.held]


def of_joints(joints: Sequence[Joint], friction: float | None) -> list[Contact]:
    """Return the hinges and guides of a direction as contacts.

    Parameters
    ----------
    joints : sequence of Joint
        See `Mechanism.joints`.
    friction : float or None
        Coefficient of friction of all of them.
    """
    found = []
    for joint in joints:
        bears, borne = (None, *joint.bodies)[-2:]
        if joint.is_guide:
            found.append(Contact((None, borne), (joint.point,), 1j * joint.slide / abs(joint.slide), held="slide"))
            continue
        at = (joint.point,)
        found.append(Contact((bears, borne), at, joint.normal, joint.face, friction, joint.roll, letter=joint.letter))
        if joint.level:
            found.append(Contact((bears, borne), at, held="level"))
    return found
