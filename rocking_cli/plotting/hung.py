"""Symbols of loads and ties in drawings, of one size on paper: weights, forces, and ties as lines and springs."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from rocking_cli.arrays import Points
from rocking_cli.plotting import style
from rocking_cli.plotting.labels import MARK_COST, Labels
from rocking_cli.plotting.panels import Panel
from rocking_cli.studies.picture import Picture

SYMBOL_OFFSET = 0.1  # inches from a point to the symbol of a short spring
MAX_SPRING_LENGTH = 0.4  # inches; longest symbol of a spring
MAX_SPRING_SHARE = 0.6  # longest symbol of a spring, as a share of the length of its line
SPRING_TEETH, SPRING_HALF_WIDTH = 4, 0.045  # number, and inches
WEIGHT_HALF_WIDTH = 0.075  # inches
ARROW_LENGTH = 0.45  # inches
ANCHOR_HALF_WIDTH = 0.04  # inches
MAX_NAME_WIDTH = 1.7  # inches
NAME_MARGIN = 0.3  # inches at either side of a structure
BACKGROUND_ZORDER = 0.8  # layer of the symbols that the moving structure may cover
SQUARE: Points = np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j], np.complex128)
WEIGHT_OUTLINE: Points = np.array(
    [0, 0.35 + 0.7j, 1 + 0.7j, 0.7 + 2.1j, 0.3 + 2.1j, 0.3 + 2.6j, -0.3 + 2.6j, -0.3 + 2.1j, -0.7 + 2.1j, -1 + 0.7j,
     -0.35 + 0.7j], np.complex128,
)  # fmt: skip
"""A weight with its handle, of half width 1, that stands on its point with a tip: a centroid there stays visible."""
WEIGHT_HEIGHT = 2.6 * WEIGHT_HALF_WIDTH  # inches


class Symbols(NamedTuple):
    """Symbols of the loads and ties of a structure at one rotation [m].

    Parameters
    ----------
    lines : list of (ndarray of complex, bool, bool)
        The lines of ties; whether the tie is slack; whether it is a bed of springs, which the structure may cover.
    anchors : list of (complex, bool)
        Anchorages on the ground, and whether they belong to a bed.
    weights : list of ndarray of complex
        Outlines of masses.
    forces : list of (complex, complex)
        Tail and tip of each arrow.
    """

    lines: list[tuple[Points, bool, bool]]
    anchors: list[tuple[complex, bool]]
    weights: list[Points]
    forces: list[tuple[complex, complex]]


def symbols(picture: Picture, rotation: float, scale: float, enlargement: float = 1.0) -> Symbols:
    """Return the symbols of loads and ties at a signed rotation, at a scale in inches per metre.

    They are where they are at a rotation that is enlarged; ties are slack as at the rotation itself.
    """
    places, ties, _ = picture.hung(enlargement * rotation, SYMBOL_OFFSET / scale)
    _, _, slack = picture.hung(rotation, 0.0)
    lines, anchors = [], []
    for tie, ends, loose in zip(picture.ties, ties, slack, strict=True):
        for piece, (start, end) in zip(tie.pieces, ends, strict=True):
            lines.append((_drawn(start, end, piece.kind, scale), loose, tie.is_bed))
            held = [at for at, each in ((start, piece.start), (end, piece.end)) if each.part is None]
            anchors += [(at, tie.is_bed) for at in held]
    weights, forces = [], []
    first = picture.side(rotation) is picture.directions[0]
    for load, place in zip(picture.loads, places.tolist(), strict=True):
        if load.force is None:
            weights.append(place + WEIGHT_OUTLINE * WEIGHT_HALF_WIDTH / scale)
        elif load.force:
            forces.append((tail(load.acting(first=first), place, scale), place))
    return Symbols(lines, anchors, weights, forces)


def draw_hung(axes: Axes, picture: Picture, rotation: float, panel: Panel, labels: Labels) -> None:
    """Draw the loads and ties of a structure, and reserve their space against labels."""
    drawn = symbols(picture, rotation, panel.scale)
    for line, loose, behind in drawn.lines:
        dashes, order = style.SLACK if loose else "-", BACKGROUND_ZORDER if behind else 4.5
        axes.plot(line.real, line.imag, linestyle=dashes, zorder=order, **style.TIE)
        labels.keep_off(line)
    for at, behind in drawn.anchors:
        square = at + ANCHOR_HALF_WIDTH / panel.scale * SQUARE
        order = BACKGROUND_ZORDER if behind else 5
        axes.add_patch(
            Polygon(xy(square), facecolor=style.EARTH, edgecolor=style.INK, linewidth=style.THIN, zorder=order)
        )
        labels.keep_off([at], MARK_COST)
    look: dict[str, Any] = {"facecolors": style.INK, "edgecolors": style.PAPER, "linewidths": style.THIN, "zorder": 5}
    axes.add_collection(PolyCollection([xy(each) for each in drawn.weights], **look), autolim=False)
    for outline in drawn.weights:
        labels.keep_off([*outline, outline[0]], MARK_COST)
    for tail, tip in drawn.forces:
        axes.annotate(
            "", (tip.real, tip.imag), (tail.real, tail.imag), annotation_clip=False, zorder=6,
            arrowprops={
                "arrowstyle": "-|>,head_width=0.2,head_length=0.45", "color": style.CURSOR, "linewidth": style.BOLD,
                "shrinkA": 0, "shrinkB": 0,
            },
        )  # fmt: skip
        labels.keep_off([tail, tip], MARK_COST)


def name_hung(picture: Picture, panel: Panel, labels: Labels) -> None:
    """Write the names of loads and ties at rest, with the size of the loads."""
    look: dict[str, Any] = {"fontsize": style.TICK, "zorder": 7}
    places, ties, _ = picture.hung(0.0, SYMBOL_OFFSET / panel.scale)
    for load, place in zip(picture.loads, places.tolist(), strict=True):
        if not load.name:
            continue
        text, size = _fitted(load.name, f", {load.text}")
        if load.force:
            out = tail(load.force, place, panel.scale)
            labels.write(text, labels.around(out, out - place, 0.02, size), color=style.CURSOR, **look)
        else:
            middle = place + 0.5j * WEIGHT_HEIGHT / panel.scale
            spots = labels.around(middle, 1 + 0j, WEIGHT_HALF_WIDTH, size, turning=0.6)
            labels.write(text, spots, color=style.INK, **look)
    for tie, ends in zip(picture.ties, ties, strict=True):
        if not tie.name:
            continue
        text, size = _fitted(tie.name)
        apart = [pair for pair, piece in zip(ends, tie.pieces, strict=True) if not (piece.together or tie.is_bed)]
        if not apart:
            start, end = ends[len(ends) // 2]
            away = start - end if len(ends) > 1 else 1 - 0.3j
            at = start if len(ends) > 1 else (start + end) / 2
            labels.write(
                text, labels.around(at, away, SYMBOL_OFFSET, size, turning=0.6), color=style.TIE["color"], **look
            )
        else:
            longest = max(apart, key=lambda pair: abs(pair[1] - pair[0]))
            labels.write(text, labels.along(*longest, size), color=style.TIE["color"], **look)


def beside(picture: Picture) -> tuple[float, float, float, float]:
    """Return the space that springs along a face take left, right, below and above a structure [inches]."""
    left = right = below = above = 0.0
    for tie in picture.ties:
        for away in (SYMBOL_OFFSET * end.lead for end in tie.ground if abs(end.lead) > 1):
            left, right = max(left, ANCHOR_HALF_WIDTH - away.real), max(right, ANCHOR_HALF_WIDTH + away.real)
            below, above = max(below, ANCHOR_HALF_WIDTH - away.imag), max(above, ANCHOR_HALF_WIDTH + away.imag)
    return left, right, below, above


def margins(picture: Picture) -> tuple[float, float, float, float]:
    """Return the space that arrows and weights need left, right, below and above their points [inches]."""
    left = right = below = 0.0
    above = WEIGHT_HEIGHT + 0.03 if any(load.mass is not None for load in picture.loads) else 0.0
    for force in (load.acting(first=first) for load in picture.loads for first in (True, False)):
        if force:
            direction = -force / abs(force) * (ARROW_LENGTH + 0.03)
            left, right = max(left, -direction.real), max(right, direction.real)
            below, above = max(below, -direction.imag), max(above, direction.imag)
    return left, right, below, above


def tail(force: complex, place: complex, scale: float) -> complex:
    """Return the tail of the arrow of a force, whose tip is at the point of action [m]."""
    return place - force / abs(force) * ARROW_LENGTH / scale


def _drawn(start: complex, end: complex, kind: str, scale: float) -> Points:
    """Return the line of a piece of a tie."""
    long = abs(end - start)
    if kind == "line" or long == 0:
        return np.array([start, end])
    coil = long if kind == "symbol" else min(MAX_SPRING_LENGTH / scale, MAX_SPRING_SHARE * long)
    unit = (end - start) / long
    first = start + unit * (long - coil) / 2
    steps = np.arange(2 * SPRING_TEETH + 1)
    to_side = np.where(steps % 2 == 0, 0.0, np.where(steps % 4 == 1, 1.0, -1.0)) * SPRING_HALF_WIDTH / scale
    return np.array([start, *(first + unit * (coil * steps / (2 * SPRING_TEETH) + 1j * to_side)), end])


def _fitted(name: str, more: str = "") -> tuple[str, complex]:
    """Return a name, shortened to the available width, and its size [inches]."""
    text = style.plain(style.fitted(name, MAX_NAME_WIDTH, style.TICK)) + more
    return text, style.size_of(text, style.TICK)


def xy(z: Points) -> NDArray[np.float64]:
    """Return points of the complex plane as those of a plot."""
    return np.stack([z.real, z.imag], axis=-1)
