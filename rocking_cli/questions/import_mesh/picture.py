"""The body of a mesh: the compass of lambda in all directions, and a page on which the body can be turned."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from rocking_cli.arrays import Reals
from rocking_cli.plotting import style
from rocking_cli.plotting.moving import as_script, asset
from rocking_cli.questions.import_mesh.solid import Triangles, turned_to_least
from rocking_cli.questions.import_mesh.study import ImportedMesh
from rocking_cli.questions.import_mesh.view import sentences, view
from rocking_cli.text import printable
from rocking_cli.views.view import Table

HEIGHT, SPARE = 6.4, 1.0  # inches of the figure at most, and more than its width
MAX_MARKED_CORNERS = 40
TURN_SHARE = 0.07  # room outside the foot for the azimuths, over the radius
CARDINALS = "NESW"


def draw_compass(found: ImportedMesh, title: str, north: float | None = None) -> Figure:
    """Draw the foot of a body over the height of its centre of mass, with the azimuths around it.

    Parameters
    ----------
    found : ImportedMesh
        The body. The way from the centre to the rim is lambda towards there.
    title : str
        Heading.
    north : float, optional
        Azimuth of the north, anticlockwise from the x axis of the mesh [deg], which is then upwards; by default the x
        axis is to the right, and there are no points of the compass.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ((axes,),) = style.panels(min(HEIGHT, style.page_width() + SPARE))
    turn = np.exp(1j * np.radians(0.0 if north is None else 90 - north))
    rim = np.append(found.foot, found.foot[:1]) * turn / found.height
    weak, reach = found.weakest, float(np.abs(rim).max())
    step = _step(reach)
    outer = step * ceil(reach / step * (1 + TURN_SHARE))
    around = np.exp(2j * np.pi * np.linspace(0, 1, 361))
    for radius in np.arange(1, round(outer / step) + 1) * step:
        axes.plot(*_xy(radius * around), color=style.GRID, linewidth=style.THIN)
        axes.text(*_xy(radius * np.exp(1j * np.radians(67.5))), f"{radius:.3g}", fontsize=style.SMALL, color=style.INK,
                  ha="center", va="center", path_effects=style.HALO, zorder=3)  # fmt: skip
    for azimuth in range(0, 360, 30):
        way = np.exp(1j * np.radians(azimuth)) * turn
        axes.plot(*_xy(np.array([0, outer]) * way), color=style.GRID, linewidth=style.THIN)
        text = f"x, {azimuth}°" if azimuth == 0 else f"{azimuth}°"
        axes.text(*_xy((1 + TURN_SHARE) * outer * way), text, fontsize=style.TICK, color=style.INK, ha="center",
                  va="center")  # fmt: skip
    axes.fill(*_xy(rim), facecolor=style.BODIES[0], edgecolor=style.INK, linewidth=style.BOLD, zorder=1, alpha=0.8)
    marked = rim[:-1] if len(rim) <= MAX_MARKED_CORNERS else rim[:0]
    handles = (
        axes.plot(*_xy(marked), "o", color=style.INK, markersize=3.5, zorder=4, label="corners") if marked.size else []
    )
    way = weak.lambda_ * np.exp(1j * np.radians(weak.azimuth)) * turn
    label = f"weakest: {weak.lambda_:.3g} towards {weak.azimuth:.4g}°, edge {weak.number}"
    handles += axes.plot(*_xy(np.array([0, way])), color=style.CURSOR, linewidth=style.BOLD, zorder=5, label=label)
    edge = np.array([weak.start, weak.end]) * turn / found.height
    axes.plot(*_xy(edge), color=style.CURSOR, linewidth=2 * style.BOLD, solid_capstyle="round", zorder=3)
    if found.azimuths:
        ends = np.array([each.lambda_ * np.exp(1j * np.radians(each.azimuth)) for each in found.azimuths]) * turn
        handles += axes.plot(*_xy(ends), "D", markerfacecolor=style.PAPER, markeredgecolor=style.BLUE, markersize=5,
                             zorder=6, label="given directions")  # fmt: skip
    axes.plot(0, 0, "+", color=style.INK, markersize=9, zorder=6)
    if north is not None:
        for k, letter in enumerate(CARDINALS):
            axes.text(*_xy((1 + 2.4 * TURN_SHARE) * outer * 1j * (-1j) ** k), letter, fontsize=style.LABEL,
                      fontweight="bold", color=style.INK, ha="center", va="center")  # fmt: skip
    room = (1 + (3.2 if north is not None else 1.9) * TURN_SHARE) * outer
    axes.set_xlim(-room, room)
    axes.set_ylim(-room, room)
    axes.set_aspect("equal")
    axes.set_axis_off()
    style.heading(axes, title)
    level = f"foot within {1000 * found.options.level:g} mm of the ground"
    handles += axes.fill(
        [], [], facecolor=style.BODIES[0], edgecolor=style.INK, label=f"λ by azimuth = {level}, over h"
    )
    style.legend_below(figure, handles, ncols=2)
    return figure


def _step(reach: float) -> float:
    """Return a round step of three to five circles."""
    power = 10.0 ** np.floor(np.log10(reach / 3))
    return float(next(power * k for k in (1, 2, 5, 10) if power * k * 5 >= reach))


def _xy(z: complex | np.ndarray) -> tuple[object, object]:
    return np.real(z), np.imag(z)


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
    from markupsafe import Markup

    from rocking_cli.documents.figures import dark_figures, inline_svg, template

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
