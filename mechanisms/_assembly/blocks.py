"""Parts of an assembly: rigid blocks, the joints between them, and errors that name them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rocking_cli.core.kinematics import Points, area_of


@dataclass(frozen=True)
class AssemblyBlock:
    """A rigid block, or a part of the ground.

    Parameters
    ----------
    name : str
        Name of the block, unique in the assembly.
    corners : tuple of complex
        Outline x + iy [m], a simple polygon in either order.
    mass : float
        Mass [kg]; not used for a part of the ground.
    centroid : complex
        Position of the centroid [m].
    inertia : float
        Moment of inertia about the centroid [kg m2]; it only decides whether confined blocks fall.
    """

    name: str
    corners: tuple[complex, ...]
    mass: float = 0.0
    centroid: complex = 0j
    inertia: float = 0.0

    @property
    def outline(self) -> Points:
        """Corners in anticlockwise order."""
        z = np.asarray(self.corners, np.complex128)
        return z if area_of(z) > 0 else z[::-1]


@dataclass(frozen=True)
class AssemblyContact:
    """A joint: the common part of an edge of one body and an edge of another.

    Parameters
    ----------
    a, b : str
        The two bodies: `a` is the ground or the supporting body.
    start, end : complex
        The two ends of the joint [m]; `b` is on the left of the line from start to end.
    normal : complex
        Unit vector from `a` into `b`, along which a positive normal force pushes `b`.
    friction : float, optional
        Coefficient of friction; None if the joint never slides.
    faces : tuple of str
        For each end, the body on whose face a corner of the other bears if the joint hinges there; empty means `a`.
    """

    a: str
    b: str
    start: complex
    end: complex
    normal: complex
    friction: float | None = None
    faces: tuple[str, str] = ("", "")

    @property
    def ends(self) -> tuple[complex, complex]:
        """Both ends [m]."""
        return self.start, self.end

    @property
    def length(self) -> float:
        """Length of the joint [m]."""
        return abs(self.end - self.start)

    def face_at(self, end: int) -> str:
        """Return the body whose face supports the corner of the other at an end, 0 or 1."""
        return self.faces[end] or self.a

    def turned(self) -> AssemblyContact:
        """Return the joint with its two bodies exchanged."""
        return replace(
            self, a=self.b, b=self.a, start=self.end, end=self.start, normal=-self.normal, faces=self.faces[::-1]
        )


MAX_NAMED_BLOCKS = 5


class AssemblyFault(Exception):
    """Error in an assembly, in one sentence without a full stop.

    Parameters
    ----------
    message : str
        The sentence.
    blocks : sequence of str
        Names of the blocks concerned.
    """

    def __init__(self, message: str, blocks: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.blocks = tuple(blocks)


class ContactFault(AssemblyFault):
    """Error: blocks overlap or touch nothing, or a named joint does not exist."""


class DoesNotStand(AssemblyFault):
    """Error: no contact forces balance the loads on the assembly at rest."""


class NothingMoves(AssemblyFault):
    """Error: contact forces balance any acceleration, so that there is no mechanism."""


class NoAnswer(AssemblyFault):
    """Error: the solver did not reach a reliable result."""


def listed(names: Sequence[str]) -> str:
    """Return names in quotes, joined by commas and a last `and`; of many names only the first ones."""
    quoted = [repr(name) for name in names[:MAX_NAMED_BLOCKS]]
    if len(names) > MAX_NAMED_BLOCKS:
        quoted.append(f"{len(names) - MAX_NAMED_BLOCKS} more")
    return " and ".join([", ".join(quoted[:-1]), quoted[-1]]) if len(quoted) > 1 else "".join(quoted)
