"""A mesh as a rigid body that rocks about the edges of its foot, and its silhouette in the plane in which it rocks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.errors import named
from rocking_cli.io.drawings.contract import DrawingError, MeshSurface
from rocking_cli.questions.import_mesh.options import MeshOptions
from rocking_cli.questions.import_mesh.solid import (
    AzimuthRow,
    FootEdge,
    LevelRow,
    MeshNote,
    Moments,
    Triangles,
    closed,
    edges_of,
    foot_of,
    glued,
    hull_of,
    levels_of,
    merged,
    moments,
    settled,
    solid,
    towards,
    weakest_of,
)
from rocking_cli.short_repr import short_repr
from rocking_cli.units import KINDS

MAX_HEIGHTS = 80  # heights at which the ends are taken; those of the corners if they are fewer
BESIDE = 1e-6  # distance from these heights to the cuts below and above them, over the size
LEAST_WIDTH = 1e-6  # over the size, so that its two sides do not touch
FLAT = 1e-4  # distance of the polygon from the silhouette, over the size


@dataclass(frozen=True, eq=False)
class Cuts:
    """Level cuts through a body: their heights [m], the ends of their lines, shape (n, 3) each, and the size [m]."""

    heights: Reals
    ends: Sequence[Reals]
    size: float


def cuts_of(points: Reals, triangles: Triangles) -> Cuts:
    """Return cuts above the lowest corner, below and above the next, ..., below the highest."""
    from trimesh import Trimesh
    from trimesh.intersections import mesh_plane

    size = float(np.ptp(points, axis=0).max())
    body = Trimesh(points / size, triangles, process=False)
    z: Reals = points[:, 2] / size
    heights = np.unique(z)
    heights = heights[np.diff(heights, prepend=-1) > 4 * BESIDE]
    if heights.size > MAX_HEIGHTS:
        heights = np.linspace(heights[0], heights[-1], MAX_HEIGHTS)
    heights = np.repeat(heights, 2)[1:-1]
    ends = [
        size * mesh_plane(body, [0, 0, 1], [0, 0, height], cached_dots=z - height).reshape(-1, 3)
        for height in heights + BESIDE * (-1) ** np.arange(len(heights))
    ]
    return Cuts(size * heights, ends, size)


def silhouette(cuts: Cuts, azimuth: float) -> Points:
    """Return the silhouette of a body as a polygon x + iy [m], anticlockwise; hollows that show sideways are filled.

    Parameters
    ----------
    cuts : Cuts
        Cuts through it.
    azimuth : float
        Direction of x in plan [rad].
    """
    import shapely

    along, level = np.array([np.cos(azimuth), np.sin(azimuth), 0]), cuts.heights
    spans = [((x := each @ along).min(), x.max()) if len(each) else (np.nan, np.nan) for each in cuts.ends]
    left, right = np.array(spans).T
    gap = np.isnan(left)  # between parts that do not touch
    for each in (left, right):
        each[gap] = np.interp(level[gap], level[~gap], each[~gap])
    middle, half = (left + right) / 2, np.maximum(right - left, LEAST_WIDTH * cuts.size) / 2
    ring = np.stack([[*(middle + half), *(middle - half)[::-1]], [*level, *level[::-1]]], axis=1)
    plain = shapely.simplify(shapely.linearrings(ring), FLAT * cuts.size, preserve_topology=False)
    outline: Points = shapely.get_coordinates(plain)[:-1] @ np.array([1, 1j])
    return outline


UPWARDS = {"z": np.eye(3), "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])}
"""Turns from the axes of a file to z upwards, by the axis that points upwards there."""
DIGITS = 7  # decimals of lengths in a file [m]
ROLLS = 12  # sides of a foot from which it is called round
GUESSES = ("mm", "cm", "m")
LEAST_SIZE, MOST_SIZE = 1e-3, 1e4  # of a body [m]
ROUNDING = 2.0**-24  # of coordinates in single precision, over the largest
NOTED_ROUNDING, REFUSED_ROUNDING = 1e-4, 1e-2  # rounding over the size from which it is said, and refused


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class ImportedMesh:
    """The body of a mesh, its foot, and how it starts to rock.

    Parameters
    ----------
    file : str
        The file.
    format : str
        Its format.
    options : MeshOptions
        How it was read.
    points : ndarray, shape (n, 3)
        Its points as it stands: z from the ground, x and y from below its centre of mass [m].
    triangles : ndarray of int, shape (m, 3)
        The triangles of its surface.
    shift : sequence of float
        Position of the origin, turned as the body is, from that of the file [m].
    whole : Moments
        Its volume, its centre of mass in these coordinates, and its inertia over the density.
    turned : float
        Angle by which it was laid down [deg].
    foot : sequence of complex
        Corners of its foot in plan, anticlockwise [m].
    edges : sequence of FootEdge
        The edges of its foot.
    azimuths : sequence of AzimuthRow
        How it starts to rock in the directions that were given.
    weakest : FootEdge
        The edge of least lambda.
    levels : sequence of LevelRow
        Its foot by other heights up to which points count as standing on the ground.
    notes : sequence of MeshNote
        What was done to the mesh.
    """

    file: str
    format: str
    options: MeshOptions
    points: Reals
    triangles: Triangles
    shift: Sequence[float]
    whole: Moments
    turned: float
    foot: Sequence[complex]
    edges: Sequence[FootEdge]
    azimuths: Sequence[AzimuthRow]
    weakest: FootEdge
    levels: Sequence[LevelRow]
    notes: Sequence[MeshNote]

    @property
    def height(self) -> float:
        """Height of the centre of mass [m]."""
        return float(self.whole.centroid[2])

    @property
    def mass(self) -> float | None:
        """Mass [kg]; None without a density."""
        return None if self.options.density is None else self.options.density * self.whole.volume

    @property
    def is_round(self) -> bool:
        """Whether the foot has so many sides that it rolls."""
        return len(self.edges) >= ROLLS

    @cached_property
    def _cuts(self) -> Cuts:
        return cuts_of(self.points, self.triangles)

    @cached_property
    def structures(self) -> Sequence[Mechanism]:
        """The structure of each azimuth, or that of the weakest edge if none is given.

        Raises `DrawingError` without a density.
        """
        return [self.structure_of(row) for row in self.azimuths] or [self.structure_of(None)]

    @property
    def structure(self) -> Mechanism:
        """The structure of the first azimuth, or that of the weakest edge. Raises `DrawingError` without a density."""
        return self.structures[0]

    def structure_of(self, row: AzimuthRow | None) -> Mechanism:
        """Return the structure that rocks as the body does towards an azimuth, or over its weakest edge."""
        if self.mass is None:
            raise DrawingError("density", f"the mass of the body is not known: give {named('density')}", self.file)
        edge, drive = (self.weakest, 1.0) if row is None else (row.edge, row.drive)
        back = (row or towards(self.edges, edge.azimuth, self.height)).back
        outline = silhouette(self._cuts, np.radians(edge.azimuth))
        fields: dict[str, Any] = {
            "mass": _short(self.mass),
            "centroid": [0.0, round(self.height, DIGITS)],
            "inertia": _short(edge.inertia * self.mass),
            "left_foot": [-round(back, DIGITS), 0.0],
            "right_foot": [round(edge.c, DIGITS), 0.0],
            "polygon": [[round(z.real, DIGITS) + 0.0, round(z.imag, DIGITS) + 0.0] for z in outline.tolist()],
        }
        if _short(drive) < 1:
            fields["drive"] = _short(drive)
        return Registry()["rigid_body"](**fields)


def imported(surface: MeshSurface, file: str, options: MeshOptions, azimuths: Sequence[float] = ()) -> ImportedMesh:
    """Return the body that a mesh encloses, as it stands on the ground.

    Parameters
    ----------
    surface : MeshSurface
        The mesh, as the file has it.
    file : str
        Name of the file, for messages.
    options : MeshOptions
        Units, density, and how it stands.
    azimuths : sequence of float
        Directions of the motion, anticlockwise from the x axis of the mesh [deg].

    Raises
    ------
    DrawingError
        If the units are missing; if the surface is not closed or encloses nothing; if the body does not stand.
    """
    scale = _scale(surface, file, options.units)
    turn = UPWARDS[options.up]
    points, triangles, notes = surface.points @ turn.T * scale, surface.triangles, _rounding(surface, file, scale)
    if len(triangles):
        if loose := len(points) - len(np.unique(triangles)):
            words = f"{loose:,} points of no face are" if loose > 1 else "1 point of no face is"
            notes.append(MeshNote("loose", loose, f"{words} left out: the file may be cut short"))
        points, triangles, again = merged(points, triangles)
        if again:
            words = f"{again:,} triangles that repeat others are" if again > 1 else "1 triangle that repeats another is"
            notes.append(MeshNote("again", again, f"{words} left out"))
    if options.hull:
        enclosed = _volume(points, triangles)
        points, triangles, planes = hull_of(points, file)
    elif not len(triangles):
        what = f"is a cloud of {len(points):,} points without faces, which encloses nothing"
        advice = f"make a surface of the points, or give {named('hull')} for the convex hull, which is heavier"
        raise DrawingError("open", what, file, hint=advice)
    else:
        closed(points, triangles, file)
    triangles, part, shells = solid(points, triangles, file)
    notes += [replace(each, at=(np.array(each.at) @ turn).tolist()) for each in shells]
    used, triangles = np.unique(triangles, return_inverse=True)
    points = points[used]
    whole, turned = moments(points, triangles), 0.0
    if options.hull:
        more = "more than the body" if enclosed is None else f"{100 * (whole.volume / enclosed - 1):.2g} % more"
        notes.append(MeshNote("hull", 1, f"the body is the convex hull of the mesh, which weighs {more}"))
    if options.settle:
        way, turned = settled(planes if options.hull else hull_of(points, file)[2], whole.centroid)
        notes.append(MeshNote("settled", 1, f"turned by {turned:.3g} degrees to stand on a facet of its hull"))
        points = points @ way.T
        whole = Moments(whole.volume, way @ whole.centroid, way @ whole.inertia @ way.T)
    shift = np.array([*whole.centroid[:2], points[:, 2].min()])
    points = points - shift
    whole = Moments(whole.volume, whole.centroid - shift, whole.inertia)
    height = float(whole.centroid[2])
    corners = foot_of(points, options.level)
    edges = _standing(points, whole, corners, options.level, file)
    notes += glued(points, triangles, part, options.level)
    return ImportedMesh(
        file=file, format=surface.format, options=options, points=points, triangles=triangles, shift=shift.tolist(),
        whole=whole, turned=turned, foot=corners, edges=edges,
        azimuths=[towards(edges, azimuth, height) for azimuth in azimuths], weakest=weakest_of(edges),
        levels=levels_of(points, whole), notes=notes,
    )  # fmt: skip


def _scale(surface: MeshSurface, file: str, units: str | None) -> float:
    """Return the size of a unit of a mesh [m]. Raises `DrawingError` if it is not given or not plausible."""
    size = float(np.ptp(surface.points, axis=0).max())
    if units is None:
        sizes = ", ".join(f"{size * float(KINDS['length'][unit]):.4g} m if {unit}" for unit in GUESSES)
        what = f"a mesh does not say its units: give {named('units')} (it is {size:.4g} units large: {sizes})"
        raise DrawingError("units", what, file)
    scale = float(KINDS["length"][units])
    if not LEAST_SIZE <= size * scale <= MOST_SIZE:
        raise DrawingError("units", f"the body would be {size * scale:.3g} m large: give other {named('units')}", file)
    return scale


def _rounding(surface: MeshSurface, file: str, scale: float) -> list[MeshNote]:
    """Return a note if the numbers of a file are coarse for the size of the body; `DrawingError` if much too coarse."""
    far, size = (scale * float(each) for each in (np.abs(surface.points).max(), np.ptp(surface.points, axis=0).max()))
    step = far * ROUNDING
    if surface.points.dtype != np.float32 or step <= NOTED_ROUNDING * size:
        return []
    words = (
        f"the file rounds its coordinates to {1000 * step:.2g} mm, {100 * step / size:.2g} % of the size of the body, "
        f"because it has single precision and the body is {far:.3g} m from its origin"
    )
    if step > REFUSED_ROUNDING * size:
        raise DrawingError("number", words, file, hint="move the mesh to its origin in the program that made it")
    return [MeshNote("rounded", 1, words)]


def _short(number: float) -> float:
    """Return a number without the digits of rounding errors."""
    return float(f"{number:.12g}")


def _volume(points: Reals, triangles: Triangles) -> float | None:
    """Return the volume that a surface encloses [m3]; None if it encloses none."""
    try:
        closed(points, triangles, "")
        return moments(points, solid(points, triangles, "")[0]).volume if len(triangles) else None
    except DrawingError:
        return None


def _standing(points: Reals, whole: Moments, corners: Sequence[complex], level: float, file: str) -> Sequence[FootEdge]:
    """Return the edges of a foot. Raises `DrawingError` if the body does not stand on it."""
    within = f"within {1000 * level:g} mm"
    if len(corners) < 3:
        angle = settled(hull_of(points, file)[2], whole.centroid)[1]
        on = "one point" if len(corners) < 2 else "a line"
        what = f"stands on {on} {within} of the ground, {angle:.2f} degrees from a facet of its hull"
        at = [[each.real, each.imag] for each in corners]
        raise DrawingError(
            "point", what, file, at, f"{named('settle')} lays it down; a larger {named('level')} takes in more points"
        )
    edges = edges_of(corners, whole)
    least = min(each.c for each in edges)
    if not least > 0:
        what = f"its centre of mass is not above its foot {within} of the ground, but {-least:.3g} m beside it"
        raise DrawingError(
            "falls",
            what,
            file,
            [[0.0, 0.0]],
            f"{named('settle')} lays it down; check {named('up')} and {named('level')}",
        )
    return edges
