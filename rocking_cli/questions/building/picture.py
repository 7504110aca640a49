"""The picture of a building: the elevation of each wall with its mechanisms, or with its section and loads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.plotting import style
from rocking_cli.questions.building.description import Building, BuildingWall
from rocking_cli.questions.building.made import held_levels, tie_height
from rocking_cli.questions.building.study import Assessed, Found
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.views.view import number

MAX_WALLS_DRAWN = 12
WALL_COLOUR, CONDITIONAL = style.RESTING_COLOUR, style.WORDS[style.STONE]
COLOURS = {
    Concluded.SATISFIED: style.SPARED,
    Concluded.SATISFIED_IF: CONDITIONAL,
    Concluded.NOT_SATISFIED: style.EXCEEDED,
}
"""Colours of mechanisms by their verdicts; others are dark."""
INCHES_A_ROW = 2.5
Say = Callable[..., str]


def draw_building(found: Assessed, say: Say) -> Figure:
    """Draw the elevations of the walls, the worst first, with each mechanism at its place and in its colour."""
    building = found.building
    order = list(dict.fromkeys(row.made.wall for row in found.rows))
    shown = [building.wall[name] for name in order[:MAX_WALLS_DRAWN]]
    figure, axes = _panels(len(shown), 1)
    for each, wall in zip(axes, shown, strict=False):
        _draw_elevation(each, building, wall)
        rows = [(rank, row) for rank, row in enumerate(found.rows, 1) if row.made.wall == wall.name]
        _draw_mechanisms(each, wall, rows)
        each.set_title(wall.name, fontsize=style.LABEL, color=style.INK, loc="left", parse_math=False)
    title = say("picture", name=building.name or say("building"))
    if len(order) > len(shown):
        title += say("picture_more", count=len(shown), of=len(order))
    style.heading_of_all(figure, title)
    return figure


def draw_description(building: Building, say: Say) -> Figure:
    """Draw each wall from outside, and its section with floors, thrusts and ties."""
    shown = building.walls[:MAX_WALLS_DRAWN]
    figure, axes = _panels(2 * len(shown), 2)
    for wall, (front, section) in zip(shown, zip(axes[::2], axes[1::2], strict=True), strict=False):
        _draw_elevation(front, building, wall, named=True)
        front.set_title(wall.name, fontsize=style.LABEL, color=style.INK, loc="left", parse_math=False)
        _draw_section(section, building, wall, say)
        section.set_title(
            say("section", name=wall.name), fontsize=style.LABEL, color=style.INK, loc="left", parse_math=False
        )
    title = say("description", name=building.name or say("building"))
    if len(building.walls) > len(shown):
        title += say("picture_more", count=len(shown), of=len(building.walls))
    style.heading_of_all(figure, title)
    return figure


def _panels(count: int, pairs: int) -> tuple[Figure, list[Axes]]:
    """Return a figure of drawings in two columns; the last may stay empty."""
    rows = ceil(count / 2)
    figure, axes = style.panels(INCHES_A_ROW * rows, rows, 2)
    every = list(axes.flat)
    for each in every:
        each.set_axis_off()
        each.set_aspect("equal")
        each.set_anchor("SW")
    return figure, every


def _draw_elevation(axes: Axes, building: Building, wall: BuildingWall, *, named: bool = False) -> None:
    """Draw a wall from outside: its storeys and openings, what stands on it, and the heights of its levels."""
    foot, top = wall.reaches(building.count)
    levels, right = building.levels, wall.length
    low, high = levels[foot], levels[top]
    _add(axes, Rectangle((0.0, low), right, high - low), WALL_COLOUR)
    for opening in wall.openings:
        sill = levels[opening.storey - 1] + opening.z
        _add(axes, Rectangle((opening.x, sill), opening.width, opening.height), "white")
    for gable in building.gables:
        if gable.wall == wall.name:
            base = gable.length or right
            corners = [((right - base) / 2, high), ((right + base) / 2, high), (right / 2, high + gable.height)]
            _add(axes, Polygon(corners), WALL_COLOUR)
    for on_top in (*building.parapets, *building.bell_gables):
        if on_top.wall == wall.name:
            base = on_top.length or right
            start = (right - base) / 2
            _add(axes, Rectangle((start, high), base, on_top.height), WALL_COLOUR)
            for hole in getattr(on_top, "openings", ()):
                _add(axes, Rectangle((start + hole.x, high + hole.z), hole.width, hole.height), "white")
    for z in levels[foot : top + 1]:
        axes.plot([0.0, right], [z, z], color=style.FAINT, linewidth=style.THIN, zorder=2)
        axes.text(-0.02 * right, z, f"{z:g}", fontsize=style.SMALL, color=style.FAINT, ha="right", va="center")
    for tie in building.ties:
        if wall.name in tie.walls:
            z = tie_height(building, tie)
            places = (np.arange(tie.bars) + 0.5) * right / tie.bars
            axes.plot(places, [z] * tie.bars, "x", color=style.TIE["color"], markersize=4, zorder=4)
    axes.plot([0.0, right], [levels[0]] * 2, color=style.EARTH, linewidth=style.MEDIUM, zorder=1)
    if named:
        axes.annotate("", (0.0, low - 0.4), (right, low - 0.4), annotation_clip=False,
                      arrowprops={"arrowstyle": "<->", "color": style.MEASURE})  # fmt: skip
        axes.text(
            right / 2, low - 0.5, f"{right:g} m", fontsize=style.SMALL, color=style.MEASURE, ha="center", va="top"
        )


def _add(axes: Axes, patch: Any, colour: str) -> None:
    patch.set(facecolor=colour, edgecolor=style.INK, linewidth=style.THIN, zorder=2)
    axes.add_patch(patch)


def _draw_mechanisms(axes: Axes, wall: BuildingWall, rows: Sequence[tuple[int, Found]]) -> None:
    """Draw hinges as lines, and spans that bend as arrows, each with its rank and its ratio, the worst on top."""
    taken: list[float] = []
    heights = [z for _, row in rows for z in row.made.hinge]
    gap = max(0.07 * (max(heights) - min(heights)), 0.04 * wall.length)  # of a line of text in a panel
    for k, (rank, row) in enumerate(rows):
        made, end = row.made, row.conclusion.concluded
        colour, (low, high) = COLOURS.get(end, style.RANKS[0]), made.hinge
        look: dict[str, Any] = {
            "color": colour,
            "linewidth": 2.2 if k == 0 else style.MEDIUM,
            "zorder": 5,
            "clip_on": False,
        }
        if made.kind == "bending":
            x = wall.length * 0.12
            axes.annotate("", (x, low), (x, high), arrowprops={"arrowstyle": "<->", "color": colour, "shrinkA": 0})
            at = (low + high) / 2
        elif made.kind == "arch":
            at = (low + high) / 2
            axes.annotate("", (0, at), (wall.length, at), arrowprops={"arrowstyle": "<->", "color": colour})
        elif made.kind == "corner":
            at_right = len(wall.sides) > 1 and made.other == wall.sides[1]
            corner = (wall.length, 0.9 * wall.length) if at_right else (0.0, 0.1 * wall.length)
            axes.plot(corner, [low, high], linestyle="--", **look)
            at = low
        else:
            axes.plot([0.0, wall.length], [low, low], **look)
            at = low
        while any(abs(at - other) < gap for other in taken):
            at += gap
        taken.append(at)
        text = f"{rank}: {number(row.ratio, 3)}"
        bold: dict[str, Any] = {"fontsize": style.TICK, "fontweight": "bold"} if k == 0 else {"fontsize": style.SMALL}
        axes.text(1.02 * wall.length, at, text, color=colour, va="center", path_effects=style.HALO, zorder=6, **bold)


def _draw_section(axes: Axes, building: Building, wall: BuildingWall, say: Say) -> None:
    """Draw the section of a wall, outside to the right: thicknesses, floors with their loads, thrusts, and ties."""
    foot, top = wall.reaches(building.count)
    levels = building.levels
    outer, reach = 0.0, 0.45 * (levels[top] - levels[foot])
    for storey in range(foot + 1, top + 1):
        t = wall.thick(storey)
        _add(axes, Rectangle((outer - t, levels[storey - 1]), t, levels[storey] - levels[storey - 1]), style.SHADE)
        middle = (levels[storey - 1] + levels[storey]) / 2
        axes.text(0.15, middle, f"{t:g} m", fontsize=style.SMALL, color=style.MEASURE, va="center")
    for name, level, each in building.bearing:
        if wall.name not in each.walls:
            continue
        z, inner = levels[level], outer - wall.thick(level)
        axes.plot([inner - reach, inner + (each.seat or 0.0)], [z, z], color=style.INK, linewidth=2.0, zorder=3)
        how = say("slides") if each.sliding else say("held")
        load = each.load * STANDARD_GRAVITY / 1e3
        text = f"{name}: {load:.3g} kN/m², {each.span:g} m, {how}"
        axes.text(
            inner - 0.1, z + 0.1, text, fontsize=style.SMALL, color=style.INK, va="bottom", ha="right", parse_math=False
        )
        if each.thrust:
            arrow = {"arrowstyle": "<-", "color": style.EXCEEDED}
            axes.annotate(f"{each.thrust / 1e3:g} kN/m", (outer + 0.1, z), (outer + 1.2, z), fontsize=style.SMALL,
                          color=style.EXCEEDED, va="center", arrowprops=arrow)  # fmt: skip
    for tie in building.ties:
        if wall.name in tie.walls:
            z = tie_height(building, tie)
            axes.plot([outer - reach - wall.thick(tie.level), outer], [z, z], zorder=4, **style.TIE)
            text = f"{tie.bars} ø {1e3 * tie.diameter:.0f} mm"
            axes.text(outer - reach, z - 0.1, text, fontsize=style.SMALL, color=style.TIE["color"], va="top")
    for level in held_levels(building, wall):
        axes.plot(outer, levels[level], "<", color=style.INK, markersize=3, zorder=5)
    low = levels[0]
    axes.plot([outer - reach - 1, outer + 1.5], [low, low], color=style.EARTH, linewidth=style.MEDIUM, zorder=1)
