"""Lengths and angles written on a structure: outside of it where they measure its edge, else where they are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from rocking_cli.core import Angle, Length
from rocking_cli.plotting import style
from rocking_cli.plotting.panels import Panel

ROW = 0.24  # inches from a dimension line to the next
FIRST = 0.27  # inches from the structure to the first, with the ground between
EDGE = 0.02  # of the size: how near a length is to the edge that it is drawn outside of
ARC = 0.42  # inches: radius of an angle, at most
SIDES = ("left", "right", "below", "above")
Rows = dict[str, list[list[Length]]]
"""The lengths of each side, in rows from the structure outwards."""


def in_rows(lengths: Sequence[Length], low: complex, high: complex) -> tuple[Rows, list[Length]]:
    """Lengths outside of the box of a structure, and those that are drawn where they are."""
    rows: Rows = {side: [] for side in SIDES}
    inside = []
    for each in lengths:
        side = _side(each, low, high)
        if side is None:
            inside.append(each)
            continue
        for row in rows[side]:  # the first row in which there is room
            if all(_apart(each, other, side) for other in row):
                row.append(each)
                break
        else:
            rows[side].append([each])
    return rows, inside


def room(rows: Rows, side: str) -> float:
    """What the rows of a side need [inches]."""
    return FIRST + ROW * len(rows[side]) + 0.02 if rows[side] else 0.12


def draw_outside(axes: Axes, rows: Rows, panel: Panel, low: complex, high: complex) -> None:
    """Draw the rows around the box of the structure from `low` to `high` [m]."""
    outwards = {"left": -1, "right": 1, "below": -1j, "above": 1j}
    edges = {"left": low.real, "right": high.real, "below": low.imag, "above": high.imag}
    for side, out in outwards.items():
        upright = side in ("left", "right")
        for k, row in enumerate(rows[side]):
            level = edges[side] + (out.real + out.imag) * (FIRST - 0.06 + ROW * k) / panel.scale
            for each in row:
                ends = [complex(level, z.imag) if upright else complex(z.real, level) for z in (each.start, each.end)]
                for z, end in zip((each.start, each.end), ends, strict=True):
                    past = end + out * 0.04 / panel.scale
                    axes.plot([z.real, past.real], [z.imag, past.imag], color=style.MEASURE, linewidth=style.HAIR)
                _arrow(axes, *ends)
                beyond = 0.11 * out / panel.scale if each.value * panel.scale < _wide(each.text) else 0
                _write(axes, sum(ends) / 2 + beyond, "center", each.text, turned=90.0 if upright else 0.0)


def draw_inside(axes: Axes, lengths: Sequence[Length], angles: Sequence[Angle], panel: Panel) -> None:
    """Draw lengths between their points, and angles at their apexes."""
    for each in lengths:
        _arrow(axes, each.start, each.end)
        slope = float(np.degrees(np.angle(each.end - each.start)))
        upright = (slope + 90) % 180 - 90  # to be read from below or from the right
        if each.value * panel.scale > 0.85 * _wide(each.text):
            _write(axes, each.start + 0.55 * (each.end - each.start), "center", each.text, turned=upright)
        else:  # too short for its text, which goes to the right of it
            beside = each.start + 0.85 * (each.end - each.start) + 0.12 / panel.scale
            _write(axes, beside, "left", each.text)
    for angle in angles:
        arms = angle.start - angle.apex, angle.end - angle.apex
        radius = min(ARC / panel.scale, 0.7 * abs(arms[1]))
        turn = float(np.angle(arms[1] / arms[0]))
        first = arms[0] / abs(arms[0])
        arc = angle.apex + radius * first * np.exp(1j * turn * np.linspace(0, 1, 40))
        axes.plot(arc.real, arc.imag, color=style.MEASURE, linewidth=style.THIN)
        for arm in arms:
            end = angle.apex + arm / abs(arm) * min(abs(arm), 1.25 * radius)
            axes.plot(
                [angle.apex.real, end.real], [angle.apex.imag, end.imag],
                color=style.MEASURE, linewidth=style.HAIR, linestyle=(0, (4, 2)),
            )  # fmt: skip
        _write(axes, *_beside_arc(angle.apex, radius, first, turn, panel.scale), angle.text)


def _beside_arc(apex: complex, radius: float, first: complex, turn: float, scale: float) -> tuple[complex, str]:
    """Where an angle is written, and which end of the text that is: before the arc or, if it is small, at its side."""
    gap = 0.06 / scale
    middle = first * np.exp(0.5j * turn)
    if abs(turn) < 1:  # small: outside of the first arm, away from the second
        outside = -1j * np.sign(turn) * first
        place = apex + first * radius + outside * gap * (1 if abs(outside.real) > 0.5 else 1.6)
        return place, "right" if outside.real < -0.5 else "left"
    if abs(middle.real) > 0.5:
        return apex + middle * (radius + gap), "left" if middle.real > 0 else "right"
    return apex + middle * (radius + 2 * gap), "center"


def _side(each: Length, low: complex, high: complex) -> str | None:
    if each.direction is not None:
        return None
    near = EDGE * abs(high - low)
    z = (each.start, each.end)
    if abs(each.start.real - each.end.real) < 1e-9 * abs(high - low):
        if min(abs(p.real - low.real) for p in z) <= near:
            return "left"
        return "right" if min(abs(p.real - high.real) for p in z) <= near else None
    if abs(each.start.imag - each.end.imag) < 1e-9 * abs(high - low):
        if min(abs(p.imag - low.imag) for p in z) <= near:
            return "below"
        return "above" if min(abs(p.imag - high.imag) for p in z) <= near else None
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


def _wide(text: str) -> float:
    """About how wide a text is, with some room for the arrows [inches]."""
    return 0.075 * len(text) + 0.1


def _write(axes: Axes, place: complex, end: str, text: str, turned: float = 0.0) -> None:
    axes.annotate(
        text, (place.real, place.imag), ha=end, va="center", rotation=turned, fontsize=style.TICK,
        color=style.MEASURE, parse_math=False, annotation_clip=False, zorder=6,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.6},
    )  # fmt: skip
