"""Lengths and angles on the drawing of a structure: outside it if they measure its edge, otherwise in place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rocking_cli.core import Angle, Length
from rocking_cli.plotting import style
from rocking_cli.plotting.labels import LabelPlace, Labels, mathematics
from rocking_cli.plotting.panels import Panel
from rocking_cli.studies.picture import Picture

ROW_SPACING = 0.26  # inches from a dimension line to the next
FIRST_ROW_OFFSET = 0.27  # inches from the structure to the first dimension line, beyond the ground
EDGE_TOLERANCE = 0.02  # share of the size within which a length lies at an edge, and is drawn outside of it
MAX_ARC_RADIUS = 0.42  # inches
TEXT_STYLE: dict[str, Any] = {"fontsize": style.LABEL, "color": style.MEASURE, "zorder": 6}
TEXT_BACKGROUND = {"facecolor": style.PAPER, "edgecolor": "none", "pad": 0.6}  # interrupts the line below a label
SIDE_MARGIN, TEXT_MARGIN = 0.16, 0.85  # inches at a side without dimension lines, and at one with labels
MIN_WIDE_ANGLE = 0.5  # rad
MAX_HEIGHTS = 5  # of more levels of loads and ties, none is measured
MAX_FLAT_ASPECT = 0.2  # height over width up to which there is no room for angles
SIDES = ("left", "right", "below", "above")
Rows = dict[str, list[list[Length]]]
"""The lengths of each side, in rows from the structure outwards."""


def heights(picture: Picture, lengths: Sequence[Length]) -> list[Length]:
    """Return the heights of loads and ties above the foot of a structure that no other length shows, lowest first."""
    low, high = picture.extent
    tolerance = 1e-6 * abs(high - low)
    ties = [end for tie in picture.ties if not tie.is_bed for piece in tie.pieces for end in (piece.start, piece.end)]
    levels = [load.point.imag for load in picture.loads] + [end.point.imag for end in ties if end.part is not None]
    upright = [each for each in lengths if abs((each.end - each.start).real) <= tolerance]
    shown = [low.imag, *(each.end.imag for each in upright if abs(each.start.imag - low.imag) <= tolerance)]
    measured: list[float] = []
    for level in sorted(levels):
        if all(abs(level - other) > tolerance for other in (*shown, *measured)):
            measured.append(level)
    lines = [Length("", low, complex(low.real, level)) for level in measured]
    return lines if len(lines) <= MAX_HEIGHTS else []


def in_rows(lengths: Sequence[Length], low: complex, high: complex) -> tuple[Rows, list[Length]]:
    """Return the lengths to draw in rows outside the box of a structure, and those to draw in place."""
    rows: Rows = {side: [] for side in SIDES}
    inside = []
    for each in lengths:
        side = _side(each, low, high)
        if side is None:
            inside.append(each)
            continue
        for row in rows[side]:  # place the length in the first row with room
            if all(_apart(each, other, side) for other in row):
                row.append(each)
                break
        else:
            rows[side].append([each])
    return rows, inside


def room(rows: Rows, low: complex, high: complex) -> tuple[float, float, float, float]:
    """Return the space for dimensions left, right, below and above a structure from `low` to `high` [inches]."""
    left, right, below, above = (
        FIRST_ROW_OFFSET + ROW_SPACING * len(rows[side]) + 0.06 if rows[side] else SIDE_MARGIN for side in SIDES
    )
    wide, tall = (high - low).real, (high - low).imag
    if tall > wide:  # a label may have no room inside a slender structure
        right = max(right, TEXT_MARGIN)
    if tall < MAX_FLAT_ASPECT * wide:
        above = max(above, 1.5 * MAX_ARC_RADIUS)
    return left, right, below, above


def draw_outside(axes: Axes, rows: Rows, panel: Panel, low: complex, high: complex, labels: Labels) -> None:
    """Draw the rows around the box of the structure from `low` to `high` [m]."""
    outwards = {"left": -1, "right": 1, "below": -1j, "above": 1j}
    edges = {"left": low.real, "right": high.real, "below": low.imag, "above": high.imag}
    short = []
    for side, out in outwards.items():
        upright = side in ("left", "right")
        for k, row in enumerate(rows[side]):
            level = edges[side] + (out.real + out.imag) * (FIRST_ROW_OFFSET - 0.06 + ROW_SPACING * k) / panel.scale
            for each in row:
                ends = [complex(level, z.imag) if upright else complex(z.real, level) for z in (each.start, each.end)]
                for z, end in zip((each.start, each.end), ends, strict=True):
                    past = end + out * 0.04 / panel.scale
                    axes.plot([z.real, past.real], [z.imag, past.imag], color=style.MEASURE, linewidth=style.HAIR)
                    labels.keep_off([z, past])
                _arrow(axes, *ends)
                text = mathematics(each)
                size = style.size_of(text, style.LABEL)
                middle = sum(ends) / 2 * panel.scale
                if each.value * panel.scale > size.real + 0.2:
                    place = LabelPlace(middle, 90.0 if upright else 0.0, 0.0)
                    labels.put(text, place, size, bbox=TEXT_BACKGROUND, **TEXT_STYLE)
                    labels.keep_off(ends)
                else:
                    short.append((text, ends, size))
    for text, ends, size in short:
        labels.keep_off(ends)
        labels.write(text, labels.along(ends[0], ends[1], size), **TEXT_STYLE)


def draw_inside(axes: Axes, lengths: Sequence[Length], angles: Sequence[Angle], panel: Panel, labels: Labels) -> None:
    """Draw and label lengths between their points, and angles at their apexes."""
    for each in lengths:
        _arrow(axes, each.start, each.end)
        labels.keep_off([each.start, each.end])
    arcs = [(angle, *_draw_arc(axes, angle, panel, labels)) for angle in angles]
    # A narrow angle has the fewest places for its label, a wide one the most.
    for angle, radius, towards in (each for each in arcs if each[0].value < MIN_WIDE_ANGLE):
        _write_angle(angle, radius, towards, labels)
    for each in sorted(lengths, key=lambda length: length.value):
        text = mathematics(each)
        labels.write(text, labels.along(each.start, each.end, style.size_of(text, style.LABEL)), **TEXT_STYLE)
    for angle, radius, towards in (each for each in arcs if each[0].value >= MIN_WIDE_ANGLE):
        _write_angle(angle, radius, towards, labels)


def _write_angle(angle: Angle, radius: float, towards: complex, labels: Labels) -> None:
    text = mathematics(angle)
    labels.write(text, labels.around(angle.apex, towards, radius, style.size_of(text, style.LABEL)), **TEXT_STYLE)


def _draw_arc(axes: Axes, angle: Angle, panel: Panel, labels: Labels) -> tuple[float, complex]:
    """Draw an angle; return the radius of its arc [inches], and the direction of its middle."""
    arms = angle.start - angle.apex, angle.end - angle.apex
    radius = min(MAX_ARC_RADIUS / panel.scale, 0.7 * abs(arms[1]))
    turn = float(np.angle(arms[1] / arms[0]))
    first = arms[0] / abs(arms[0])
    arc = angle.apex + radius * first * np.exp(1j * turn * np.linspace(0, 1, 40))
    axes.plot(arc.real, arc.imag, color=style.MEASURE, linewidth=style.THIN)
    labels.keep_off(arc)
    for arm in arms:
        end = angle.apex + arm / abs(arm) * min(abs(arm), 1.25 * radius)
        axes.plot(
            [angle.apex.real, end.real], [angle.apex.imag, end.imag],
            color=style.MEASURE, linewidth=style.HAIR, linestyle=(0, (4, 2)),
        )  # fmt: skip
        labels.keep_off([angle.apex, end])
    return radius * panel.scale, first * complex(np.exp(0.5j * turn))


def _side(each: Length, low: complex, high: complex) -> str | None:
    if each.direction is not None:
        return None
    tolerance = EDGE_TOLERANCE * abs(high - low)
    z = (each.start, each.end)
    if abs(each.start.real - each.end.real) < 1e-9 * abs(high - low):
        if min(abs(p.real - low.real) for p in z) <= tolerance:
            return "left"
        return "right" if min(abs(p.real - high.real) for p in z) <= tolerance else None
    if abs(each.start.imag - each.end.imag) < 1e-9 * abs(high - low):
        if min(abs(p.imag - low.imag) for p in z) <= tolerance:
            return "below"
        return "above" if min(abs(p.imag - high.imag) for p in z) <= tolerance else None
    return None


def _apart(one: Length, other: Length, side: str) -> bool:
    def span(each: Length) -> tuple[float, float]:
        ends = [z.imag if side in ("left", "right") else z.real for z in (each.start, each.end)]
        return min(ends), max(ends)

    (a, b), (c, d) = span(one), span(other)
    return b <= c + 1e-9 * (b - a) or d <= a + 1e-9 * (b - a)


def _arrow(axes: Axes, start: complex, end: complex) -> None:
    axes.annotate(
        "", (end.real, end.imag), (start.real, start.imag), annotation_clip=False,
        arrowprops={
            "arrowstyle": "<|-|>,head_width=0.12,head_length=0.3", "color": style.MEASURE, "linewidth": style.THIN,
            "shrinkA": 0, "shrinkB": 0,
        },
    )  # fmt: skip
