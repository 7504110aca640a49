"""The body of a mesh as a page of HTML on which it can be turned; the page needs no other file and no network."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from markupsafe import Markup

from rocking_cli.arrays import Reals
from rocking_cli.documents.figures import dark_figures, inline_svg, template
from rocking_cli.plotting.moving import as_script, asset
from rocking_cli.questions.import_mesh.picture import draw_compass
from rocking_cli.questions.import_mesh.solid import Triangles, turned_to_least
from rocking_cli.questions.import_mesh.study import ImportedMesh
from rocking_cli.questions.import_mesh.view import sentences, view
from rocking_cli.text import printable
from rocking_cli.views.view import Table

MAX_DRAWN = 12_000  # triangles that a page draws as fast as a reader turns them
CELLS = 64  # cells along the body in which corners of a larger mesh are one, to begin with
STEPS = 2000  # steps along the body in which a page has places


def render(found: ImportedMesh, title: str, about: Sequence[str], north: float | None = None) -> str:
    """Return the page of a body.

    Parameters
    ----------
    found : ImportedMesh
        The body.
    title : str
        Heading; every text is escaped.
    about : sequence of str
        Further lines of the heading, such as the command.
    north : float, optional
        Azimuth of the north [deg], see `draw_compass`.
    """
    page = template("mesh.html").render(
        title=title,
        about=about,
        said=[each.replace("`", "") for each in sentences(found)],
        tables=[each for each in view(found).parts if isinstance(each, Table)],
        picture=inline_svg(lambda: draw_compass(found, "", north), "compass"),
        drawn=len(drawn_triangles(found)[1]),
        all=len(found.triangles),
        data=Markup(as_script(scene(found))),
        style=Markup(asset("motion.css")),
        script=Markup(asset("mesh.js")),
        dark_figures=dark_figures(),
    )
    return printable(page)


def scene(found: ImportedMesh) -> Mapping[str, Any]:
    """Return what the page draws; lengths are in steps of the size of the body."""
    points, triangles = drawn_triangles(found)
    size = float(np.ptp(found.points, axis=0).max())
    steps = np.rint(points / size * STEPS).astype(int)
    weak, unit = found.weakest, STEPS / size
    return {
        "points": steps.ravel().tolist(),
        "triangles": triangles.ravel().tolist(),
        "foot": [[round(each.real * unit, 1), round(each.imag * unit, 1)] for each in found.foot],
        "weakest": [[round(each.real * unit, 1), round(each.imag * unit, 1)] for each in (weak.start, weak.end)],
        "azimuth": weak.azimuth,
        "height": round(found.height * unit, 1),
        "steps": STEPS,
    }


def drawn_triangles(found: ImportedMesh) -> tuple[Reals, Triangles]:
    """Return the mesh, or one with so few triangles that it is drawn fast: corners in one cell of a grid become one."""
    points, triangles, cells = found.points, found.triangles, CELLS
    size = float(np.ptp(points, axis=0).max())
    while len(triangles) > MAX_DRAWN:
        cell = np.rint(found.points / size * cells).astype(np.int64) @ np.array([1, 4096, 4096**2])
        names = np.unique(cell, return_inverse=True)[1]
        count = np.bincount(names)
        points = np.stack([np.bincount(names, found.points[:, k]) / count for k in range(3)], axis=1)
        corners = names[found.triangles]
        a, b, c = corners.T
        triangles = np.unique(turned_to_least(corners[(a != b) & (b != c) & (c != a)]), axis=0)
        cells = cells * 3 // 4
    return points, triangles
