"""Picture of an import: bodies with their names, joints, the ground, what was mended and what was left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from rocking_cli.arrays import Points
from rocking_cli.plotting import style
from rocking_cli.questions.import_drawing.study import Imported

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MAX_NAMED = 150  # bodies with names
TICK = 0.012  # length of the tick of a joint over the size drawn
ROOM = 0.08
ANY_SIZE = complex(inf, inf)


def draw_import(found: Imported, title: str, tolerance: float) -> Figure:
    """Draw the bodies that a drawing gave, to check them against it."""
    outlines = [body.ring.chords(tolerance) for body in found.bodies]
    z = np.concatenate(outlines)
    width, height = float(np.ptp(z.real)), float(np.ptp(z.imag))
    size = max(width, height)
    shape = min(max(height / max(width, 1e-9), 0.35), 1.4)
    figure, axes = style.one_panel(style.page_width() * shape * 0.8 + 0.8, title)
    for ground in found.ground:
        axes.add_patch(_patch(ground, facecolor="none", edgecolor=style.EARTH, hatch="////", linewidth=style.THIN))
    for line in found.grey:
        axes.plot(line.real, line.imag, color=style.FAINT, linewidth=style.THIN, zorder=1.5)
    for k, (body, outline) in enumerate(zip(found.bodies, outlines, strict=True)):
        fill = style.BODIES[k % len(style.BODIES)]
        axes.add_patch(_patch(outline, facecolor=fill, edgecolor="none", zorder=1))
        axes.add_patch(_patch(outline, facecolor="none", edgecolor=style.INK, linewidth=style.THIN, zorder=2))
        for hole in body.openings:
            edge = hole.chords(tolerance)
            axes.add_patch(_patch(edge, facecolor=style.PAPER, edgecolor=style.INK, linewidth=style.THIN, zorder=1))
    _draw_joints(axes, found, TICK * size)
    _draw_attached(axes, found)
    if found.mended:
        at_mended = np.array(found.mended)
        axes.plot(
            at_mended.real, at_mended.imag, linestyle="none", marker="o", markersize=7, markerfacecolor="none",
            markeredgecolor=style.CURSOR, markeredgewidth=style.MEDIUM, zorder=4, label="mended",
        )  # fmt: skip
    if found.grey:
        axes.plot([], [], color=style.FAINT, linewidth=style.THIN, label="left out")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    room = ROOM * size
    low, high = complex(z.real.min(), z.imag.min()), complex(z.real.max(), z.imag.max())
    axes.dataLim.set_points(np.array([[low.real - room, low.imag - room], [high.real + room, high.imag + room]]))
    axes.margins(0.0)
    if axes.get_legend_handles_labels()[0]:
        style.legend_below(figure, ncols=5, grows=True)
    _draw_names(axes, found, outlines)
    return figure


def _draw_names(axes: Axes, found: Imported, outlines: Sequence[Points]) -> None:
    """Write the names of the largest bodies: upright, in lines or turned, as large as fits, and none over another."""
    if style.given() is None and isinstance(axes.figure, Figure):
        style.lay_out(axes.figure)
    axes.apply_aspect()
    scale = style.inches(axes).real / float(np.ptp(axes.get_xlim()))
    boxes = [scale * complex(np.ptp(each.real), np.ptp(each.imag)) for each in outlines]
    middles, extents = np.empty(0, np.complex128), np.empty(0, np.complex128)
    for k in sorted(range(len(boxes)), key=lambda k: -min(boxes[k].real, boxes[k].imag))[:MAX_NAMED]:
        name, at = style.plain(found.bodies[k].name), found.bodies[k].moments.centroid
        ways = [(name, 0, boxes[k]), (name.replace(" ", "\n"), 0, boxes[k]), (name, 90, boxes[k])]
        tried = [*product((style.TICK, style.SMALL, style.TINY), ways), (style.TINY, (name, 0, ANY_SIZE))]
        for points, (text, turn, box) in tried:
            size = style.size_of(text, points)
            extent = complex(size.imag, size.real) if turn else size
            away, least = middles - scale * at, (extents + extent) / 2
            apart = (np.abs(away.real) >= least.real) | (np.abs(away.imag) >= least.imag)
            if apart.all() and extent.real <= box.real and extent.imag <= box.imag:
                axes.text(
                    at.real, at.imag, text, ha="center", va="center", fontsize=points, rotation=turn, zorder=5,
                    color=style.INK, path_effects=style.HALO, clip_on=True,
                )  # fmt: skip
                middles, extents = np.append(middles, scale * at), np.append(extents, extent)
                break


def _draw_attached(axes: Axes, found: Imported) -> None:
    """Draw ties as lines, and masses, forces and supports as marks."""

    def points(places: Sequence[Mapping[str, Any]]) -> list[list[float]]:
        return [place.get("at") or place["ground"] for place in places]

    for tie in found.fields.get("ties", ()):
        x, y = zip(*points(tie.get("path") or (tie["from"], tie["to"])), strict=True)
        axes.plot(x, y, **style.TIE, zorder=3)
    loads = found.fields.get("loads", ())
    marks = {
        "mass": ("o", [load["at"] for load in loads if "mass" in load]),
        "force": ("v", [load["at"] for load in loads if "force" in load]),
        "support": (">", [[at.real, at.imag] for at in found.supports]),
    }
    for name, (mark, places) in marks.items():
        if places:
            x, y = zip(*places, strict=True)
            axes.plot(x, y, linestyle="none", marker=mark, markersize=6, color=style.BLACK, zorder=6, label=name)


def _patch(outline: Points, **look: Any) -> Polygon:
    return Polygon(np.stack([outline.real, outline.imag], axis=1), closed=True, **look)


def _draw_joints(axes: Axes, found: Imported, length: float) -> None:
    """Draw a tick across the middle of each joint."""
    ticks = []
    for joint in found.joints:
        start, end = joint.ends
        middle, along = (start + end) / 2, (end - start) / abs(end - start)
        step = 1j * along * length
        ticks.append([((middle - step).real, (middle - step).imag), ((middle + step).real, (middle + step).imag)])
    axes.add_collection(LineCollection(ticks, colors=style.MEASURE, linewidths=style.BOLD, zorder=3))
