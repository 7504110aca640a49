"""Shapes that rock, in closed form; a joint can part in each."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np

from .structures import WHOLE, Piece, Rigid, Slips, Structure

NONE = (0.0, 0.0)


def box(name: str, mass: float, width: float, height: float, centre: complex) -> Piece:
    """A uniform rectangle."""
    return Piece(name, mass, mass * (width**2 + height**2) / 12, centre)


def turned_from(rest: complex, x: Any, y: Any) -> Any:
    """By how much (x, y) is turned against its direction at rest, up to a right angle."""
    return np.arctan((rest.real * y - rest.imag * x) / (rest.real * x + rest.imag * y))


@dataclass(frozen=True)
class Block(Structure):
    """A rectangle on the ground, or (inertia 0, centre) any body on a base of that width. Its body is "block"."""

    width: float
    height: float
    mass: float = 1.0
    inertia: float | None = None
    centre: complex | None = None

    def pieces(self) -> Sequence[Piece]:
        whole = box("block", self.mass, self.width, self.height, 0.5j * self.height)
        inertia = whole.inertia if self.inertia is None else self.inertia
        return (replace(whole, inertia=inertia, centre=whole.centre if self.centre is None else self.centre),)

    def place(self, s: int, phi: Any, slips: Slips = WHOLE) -> Sequence[Rigid]:
        dx, dy = slips.get("foot", NONE)
        foot = s * self.width / 2
        return (Rigid(complex(foot), foot + dx, 0.0 + dy, -s * phi),)

    def joints(self) -> Sequence[str]:
        return ("foot",)


@dataclass(frozen=True)
class Wall(Structure):
    """A wall between floors that opens at its foot and at half its height; its top is held on the foot's face.

    Its bodies are "lower" and "upper".
    """

    thickness: float
    height: float
    mass: float = 1.0

    def pieces(self) -> Sequence[Piece]:
        half = self.mass / 2, self.thickness, self.height / 2
        return [box(name, *half, at * self.height * 1j) for name, at in (("lower", 0.25), ("upper", 0.75))]

    def _corners(self, s: int) -> tuple[complex, complex, complex]:
        foot = s * self.thickness / 2
        return complex(foot), complex(-foot, self.height / 2), complex(foot, self.height)

    def place(self, s: int, phi: Any, slips: Slips = WHOLE) -> Sequence[Rigid]:
        foot, hinge, top = self._corners(s)
        (fx, fy), (hx, hy), (tx, _) = (slips.get(joint, NONE) for joint in self.joints())
        lower = Rigid(foot, foot.real + fx, 0.0 + fy, -s * phi)
        x, y = lower.at(hinge)
        x, y = x + hx, y + hy
        across = top.real + tx - x
        up = np.sqrt(abs(top - hinge) ** 2 - across**2)
        return lower, Rigid(hinge, x, y, turned_from(top - hinge, across, up))

    def joints(self) -> Sequence[str]:
        return ("foot", "hinge", "top")

    def locks(self, s: int) -> float:
        foot, hinge, top = self._corners(s)
        phi = np.linspace(0.0, pi / 2, 2000)
        x, _ = Rigid(foot, foot.real, 0.0, -s * phi).at(hinge)
        locked = abs(top.real - x) >= abs(top - hinge)
        return float(phi[locked.argmax() - 1] if locked.any() else pi / 2)


@dataclass(frozen=True)
class Frame(Structure):
    """A beam on two columns that stand `spacing` apart, their tops level; the left foot's middle is the origin.

    Equal heights make it symmetric. Its bodies are "left column", "beam" and "right column".
    """

    width: float
    height: float
    spacing: float
    depth: float
    column: float = 1.0
    beam: float = 1.0
    right_height: float | None = None
    right_column: float | None = None

    def pieces(self) -> Sequence[Piece]:
        short = self.height if self.right_height is None else self.right_height
        right = self.column if self.right_column is None else self.right_column
        axis, top = self.spacing, 1j * self.height
        return (
            box("left column", self.column, self.width, self.height, top / 2),
            box("beam", self.beam, axis + self.width, self.depth, axis / 2 + top + 0.5j * self.depth),
            box("right column", right, self.width, short, axis + top - 0.5j * short),
        )

    def _corners(self, s: int) -> tuple[complex, complex, complex, complex]:
        short = self.height if self.right_height is None else self.right_height
        b, top = s * self.width / 2, 1j * self.height
        return complex(b), top - b, top + self.spacing - b, top - 1j * short + self.spacing + b

    def place(self, s: int, phi: Any, slips: Slips = WHOLE) -> Sequence[Rigid]:
        a, b, c, d = self._corners(s)
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = (slips.get(joint, NONE) for joint in self.joints())
        left = Rigid(a, a.real + ax, a.imag + ay, -s * phi)
        x, y = left.at(b)
        x, y = x + bx, y + by
        # Triangle B, C and the foot E from which the beam's C is a column's length away.
        ex, ey = d.real + dx + cx, d.imag + dy + cy
        wx, wy = x - ex, y - ey
        far, tall, span = wx**2 + wy**2, abs(c - d), abs(c - b)
        along = (far + tall**2 - span**2) / (2 * far)
        aside = -np.sqrt(tall**2 / far - along**2)  # C is on the right of the line from E to B
        ux, uy = along * wx - aside * wy, along * wy + aside * wx
        right = Rigid(d, d.real + dx, d.imag + dy, turned_from(c - d, ux, uy))
        return left, Rigid(b, x, y, turned_from(c - b, ex + ux - x, ey + uy - y)), right

    def joints(self) -> Sequence[str]:
        return ("left foot", "left top", "right top", "right foot")

    def locks(self, s: int) -> float:
        phi = np.linspace(0.0, pi / 2, 2000)
        with np.errstate(invalid="ignore"):
            locked = np.isnan(np.broadcast_to(self.place(s, phi)[2].psi, phi.shape))
        return float(phi[locked.argmax() - 1] if locked.any() else pi / 2)
