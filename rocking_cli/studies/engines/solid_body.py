"""A free rigid body in three dimensions: its shape, and the structures that are such a body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import atan, atan2, pi, sqrt
from typing import Any, Self

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.core import Mechanism, polygon
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.kinematics import area_of, following
from rocking_cli.core.polygons import hull_of
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.engines.free_blocks import NEAR_SHARE
from rocking_cli.units import STANDARD_GRAVITY

NOT_FREE = ("loads", "ties", "interlock", "stops", "crushing", "one_sided")
"""Fields of a structure that a free body in three dimensions cannot have."""


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class SolidBody:
    """A rigid body that stands on level ground by its own weight; its mass has no effect.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Points whose convex hull is that of the body: x and y from below its centroid, z from the ground [m].
    level : float
        Height of the centroid [m].
    inertia : ndarray, shape (3, 3)
        Inertia about the centroid, over the mass [m2].
    radius : float
        Radius of the foot, if it is a circle about the point below the centroid [m]; 0 if it is a polygon.
    friction : float
        Coefficient of friction of the foot.
    assumes_friction : bool
        Whether this friction was not given.
    gravity : float
        Gravitational acceleration [m/s2].
    """

    points: Reals
    level: float
    inertia: Reals
    radius: float = 0.0
    friction: float = MASONRY_FRICTION
    assumes_friction: bool = False
    gravity: float = float(STANDARD_GRAVITY)

    @classmethod
    def box(cls, width: float, depth: float, height: float, **more: Any) -> Self:
        """Return a uniform box: `width` along x, `depth` along y [m]; `more` are further fields."""
        outline = width / 2 * np.array([-1, 1, 1, -1]) + 1j * height * np.array([0, 0, 1, 1])
        return cls.prism(outline, depth, **more)

    @classmethod
    def cylinder(cls, diameter: float, height: float, **more: Any) -> Self:
        """Return an upright uniform cylinder [m]; `more` are further fields."""
        r = diameter / 2
        across = (3 * r**2 + height**2) / 12
        return cls.turned(np.array([r, r + 1j * height]), r, height / 2, (across, r**2 / 2), **more)

    @classmethod
    def turned(cls, profile: Points, radius: float, level: float, inertia: tuple[float, float], **more: Any) -> Self:
        """Return a body of revolution.

        Parameters
        ----------
        profile : ndarray of complex
            Points of its outline, the distance from its axis and i times the height [m].
        radius, level : float
            Radius of its foot and height of its centroid [m].
        inertia : (float, float)
            Inertia about an axis through its centroid across it, and about its axis, over the mass [m2].
        **more
            Further fields.
        """
        sides = [[x, y, 0] for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        points = np.concatenate([z.real * np.array(sides) + [0, 0, z.imag] for z in profile])
        about = np.diag([inertia[0], inertia[0], inertia[1]])
        return cls(points=points, level=level, inertia=about, radius=radius, **more)

    @classmethod
    def prism(cls, outline: Points, depth: float, **more: Any) -> Self:
        """Return a uniform prism: its outline x + iz, anticlockwise, and its `depth` along y [m]."""
        centroid = polygon("body", 1.0, outline.tolist()).centroid
        corners = np.stack([outline - centroid, following(outline) - centroid], axis=1)
        parts = np.stack([corners.real, corners.imag], axis=2)  # side, end, axis
        ends = parts.sum(axis=1)
        squares = np.einsum("kpi,kpj->kij", parts, parts) + np.einsum("ki,kj->kij", ends, ends)
        twice = (corners[:, 0].conj() * corners[:, 1]).imag
        xx, zz, xz = (np.einsum("k,kij->ij", twice, squares) / (12 * twice.sum()))[[0, 1, 0], [0, 1, 1]]
        yy = depth**2 / 12
        inertia = np.array([[yy + zz, 0, -xz], [0, xx + zz, 0], [-xz, 0, xx + yy]])
        ground = float(outline.imag.min())
        points = np.array([(z.real, y, z.imag) for z in outline.tolist() for y in (-depth / 2, depth / 2)])
        points -= [centroid.real, 0, ground]
        return cls(points=points, level=centroid.imag - ground, inertia=inertia, **more)

    @property
    def size(self) -> float:
        """Diagonal of the box around it [m]."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    @property
    def height(self) -> float:
        """Height [m]."""
        return float(np.ptp(self.points[:, 2]))

    @property
    def unit_of_time(self) -> float:
        """sqrt(size/g) [s]."""
        return sqrt(self.size / self.gravity)

    @cached_property
    def foot(self) -> Points:
        """Corners of the foot in plan, anticlockwise, from below the centroid [m]; a few of a round one."""
        standing = self.points[self.points[:, 2] < NEAR_SHARE * self.size]
        return hull_of(standing[:, 0] + 1j * standing[:, 1])

    @cached_property
    def alpha(self) -> float:
        """Tilt about the weaker side of the foot at which the centroid is above it [rad]."""
        side = following(self.foot) - self.foot
        away = (self.foot.conj() * side).imag / np.abs(side)
        return atan(self.radius / self.level) if self.radius else atan2(float(away.min()), self.level)

    @cached_property
    def fallen(self) -> float:
        """Tilt from which it has overturned [rad]: between that over its farthest corner and a right angle."""
        return (atan(float(np.abs(self.foot).max()) / self.level) + pi / 2) / 2

    def checked(self) -> Self:
        """Return the body. Raises `InputError` if it does not stand."""
        if len(self.foot) < 3 or not self.alpha > 0:
            raise InputError(Problem("its centre of mass is not above its foot in three dimensions"))
        return self


def common_fields(mechanism: Mechanism) -> dict[str, Any]:
    """Return friction and gravity of a structure that is one free body, as fields of `SolidBody`.

    Raises
    ------
    InputError
        If it is not, by name.
    """
    leave = f"leave it out of the file, or leave out {named('in_space')}"
    if (count := sum(mechanism.alike().get(body.name, 1) for body in mechanism.bodies())) > 1:
        what = f"one free body is simulated in three dimensions, and {mechanism.name} has {count}"
        raise InputError(Problem(what, hint=f"leave out {named('in_space')}"))
    for field in NOT_FREE:
        if getattr(mechanism, field):
            raise InputError(Problem("cannot be simulated in three dimensions", field=field, hint=leave))
    if any(contact.roll for contact in mechanism.contacts_at_rest() or ()):
        raise InputError(Problem("cannot be simulated in three dimensions", field="corner_radius", hint=leave))
    friction, given = mechanism.friction or MASONRY_FRICTION, mechanism.friction is not None
    return {"friction": friction, "assumes_friction": not given, "gravity": mechanism.gravity}


def solid_of(mechanism: Mechanism) -> SolidBody:
    """Return the body that a structure is in three dimensions.

    Parameters
    ----------
    mechanism : Mechanism
        A block or a polygon with its `depth`, a round block, or a cone.

    Raises
    ------
    InputError
        If it is no free body, or its shape out of plane is not known.
    """
    common = common_fields(mechanism)
    (body,), sketch = mechanism.bodies(), mechanism.sketch()
    outlines = [np.array(each, np.complex128) for each in body.shapes(sketch.outlines)]
    if (foot := mechanism.round_foot()) is not None:
        inertia = body.inertia / body.mass, foot[1]
        return SolidBody.turned(outlines[0], foot[0], body.centroid.imag, inertia, **common)
    if not sketch.uniform or len(outlines) != 1:
        what = "its shape in three dimensions is not known"
        hint = f"give a block, a polygon or a cone, or the mesh of the body with {named('mesh')}"
        raise InputError(Problem(what, hint=hint))
    if mechanism.depth is None:
        hint = "give the size out of plane, or `section: round` in a block that is a cylinder"
        raise InputError(Problem("is missing for three dimensions", field="depth", hint=hint))
    outline = outlines[0] if area_of(outlines[0]) > 0 else outlines[0][::-1]
    return SolidBody.prism(outline, mechanism.depth, **common).checked()
