"""Joints of a mechanism: where bodies bear on one another and on the ground, and on which face."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.core.sketch import Hinge


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
