"""What an assembly is made of: rigid blocks, the joints between them, and guides that hold a point sideways."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mechanisms._polygons import Points, area_of


@dataclass(frozen=True)
class AssemblyBlock:
    """A rigid block, or a part of the ground.

    Parameters
    ----------
    name : str
        What it is called; no two blocks have the same name.
    corners : tuple of complex
        Its outline x + iy [m], a simple polygon in either order.
    mass : float
        Mass [kg]; of no matter where it is ground.
    centroid : complex
        Where its mass is [m].
    """

    name: str
    corners: tuple[complex, ...]
    mass: float = 0.0
    centroid: complex = 0j

    @property
    def outline(self) -> Points:
        """Its corners anticlockwise."""
        z = np.asarray(self.corners, np.complex128)
        return z if area_of(z) > 0 else z[::-1]


@dataclass(frozen=True)
class AssemblyContact:
    """A joint: the common part of an edge of one body and an edge of another.

    Parameters
    ----------
    a, b : str
        The two bodies: `a` is ground, or the one that bears the other.
    start, end : complex
        Its two ends [m]; `b` lies on the left of the way from one to the other.
    normal : complex
        Unit vector from `a` into `b`, along which a positive normal force pushes `b`.
    friction : float, optional
        Coefficient of friction; None: it never slides.
    faces : tuple of str
        At each end the body whose face a corner of the other would bear on, if it hinged there; empty means `a`.
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
        """How far its ends are apart [m]."""
        return abs(self.end - self.start)

    def face_at(self, end: int) -> str:
        """The body whose face bears the corner of the other at an end, 0 or 1."""
        return self.faces[end] or self.a

    def turned(self) -> AssemblyContact:
        """The same joint seen from the other body."""
        return replace(
            self, a=self.b, b=self.a, start=self.end, end=self.start, normal=-self.normal, faces=self.faces[::-1]
        )


@dataclass(frozen=True)
class AssemblyGuide:
    """A support that holds a point of a block sideways to a line of the ground, both ways and without friction.

    Parameters
    ----------
    name : str
        What it is called.
    body : str
        The block it holds.
    at : complex
        The point that is held [m].
    along : complex
        The direction in which that point may move.
    """

    name: str
    body: str
    at: complex
    along: complex
