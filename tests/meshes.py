"""Meshes for tests, and their files in every format."""

import struct
from itertools import product

import numpy as np

QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def box(low, high):
    """The corners and triangles of a box that face outwards."""
    points = np.array(list(product(*zip(low, high, strict=True))), float)
    return points, np.array([each for a, b, c, d in QUADS for each in ((a, b, c), (a, c, d))])


def inwards(mesh):
    return mesh[0], mesh[1][:, ::-1]


def several(*meshes):
    before = np.cumsum([0, *(len(points) for points, _ in meshes)])
    triangles = [each + k for (_, each), k in zip(meshes, before, strict=False)]
    return np.concatenate([points for points, _ in meshes]), np.concatenate(triangles)


def extruded(outline, deep):
    """A polygon of the plane x, z whose corners all see the first, anticlockwise, from y = 0 to `deep`."""
    n = len(outline)
    flat = np.array([(x, 0.0, z) for x, z in outline])
    points = np.concatenate([flat, flat + np.array([0.0, deep, 0.0])])
    caps = [(0, k, k + 1) for k in range(1, n - 1)]
    sides = [each for k in range(n) for j in [(k + 1) % n] for each in ((j, k, k + n), (j, k + n, j + n))]
    return points, np.array([*caps, *((c + n, b + n, a + n) for a, b, c in caps), *sides])


def upright(outline, height):
    """A polygon of the plan, anticlockwise, whose corners all see the first, from z = 0 to `height`."""
    points, triangles = extruded(outline, height)
    return points[:, [0, 2, 1]], triangles[:, ::-1]


def turned(mesh, axis, degrees):
    """A mesh that is turned about an axis."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return mesh[0] @ turn.T, mesh[1]


def obj(mesh):
    points, triangles = mesh
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    return "\n".join([*lines, *(f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()), ""]).encode()


def ply(mesh, form="ascii"):
    points, triangles = mesh
    head = (
        f"ply\nformat {form} 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()
    if form == "ascii":
        rows = [*(f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()), *(f"3 {a} {b} {c}" for a, b, c in triangles)]
        return head + "\n".join([*rows, ""]).encode()
    order = "<" if "little" in form else ">"
    faces = np.zeros(len(triangles), [("n", "u1"), ("corners", f"{order}i4", 3)])
    faces["n"], faces["corners"] = 3, triangles
    return head + points.astype(f"{order}f4").tobytes() + faces.tobytes()


def stl(mesh):
    """Binary; no triangle shares a corner with another."""
    facets = np.zeros(len(mesh[1]), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    facets["corners"] = mesh[0][mesh[1]]
    return b"made by a test".ljust(80) + struct.pack("<I", len(facets)) + facets.tobytes()


def ascii_stl(mesh):
    loops = ["".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in each) for each in mesh[0][mesh[1]].tolist()]
    facets = [f"facet normal 0 0 0\nouter loop\n{each}endloop\nendfacet" for each in loops]
    return "\n".join(["solid body", *facets, "endsolid body", ""]).encode()
