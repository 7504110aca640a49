"""Drawing of a structure at rest and displaced, to scale, so that mechanism and dimensions can be checked by eye."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import degrees, floor, log10
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch, PathPatch, Polygon
from matplotlib.path import Path

from rocking_cli.arrays import Points
from rocking_cli.core import Angle, Direction, Forces, Length, Line, three_digits
from rocking_cli.plotting import dimensions, hung, style
from rocking_cli.plotting.labels import EDGE_COST, MARK_COST, Labels, mathematics
from rocking_cli.plotting.panels import PANEL_GAP, Page, Panel, lay_out
from rocking_cli.studies.picture import MAX_SEPARATE_PARTS, DrawnHinge, DrawnPart, Picture, box_around

SCALE_HEIGHT = 0.34  # inches below a panel for the scale
LINE_HEIGHT, NOTE_HEIGHT = 0.16, 0.13  # inches of a line of a heading or a title, and of a note
MIN_PANEL_WIDTH = 0.95  # inches: a slender structure still needs room for its labels
HINGE_RADIUS = 0.035  # inches
HATCH_DEPTH = 0.08  # inches; depth of the hatching of the ground
MAX_SCALE_LENGTH = 0.8  # inches
MAX_STROKE_LENGTH, MAX_STROKE_SHARE = 0.3, 0.8  # longest stroke of a force: inches, and share of a block's smaller side
# Smaller forces than this share of the largest are not drawn, and the largest has a stroke of this weight [pt].
MIN_FORCE_SHARE, MAX_STROKE_WEIGHT = 0.003, 2.4
LINE_WEIGHT_SHARE = 0.04  # weight of outlines over the smaller side of a block, if there are dozens of blocks
NO_CRITICAL_TEXT = "no critical rotation: displaced to a visible angle"
STARTING_TEXT = "displaced as the mechanism starts, exaggerated"
NO_BREAK = "\u00a0"
SENSE = {Direction.POSITIVE: "clockwise", Direction.NEGATIVE: "anticlockwise"}


def draw_structure(picture: Picture, title: str, ratio: float | None = None, say: Callable[[str], str] = str) -> Figure:
    """Draw a structure displaced in the negative direction, at rest with its dimensions, and in the positive direction.

    A structure that rocks to one side only is displaced to that side alone.

    Parameters
    ----------
    picture : Picture
        The drawing of the structure.
    title : str
        Heading.
    ratio : float, optional
        Rotation of the displaced structure over the critical one, or over the kinematic limit if there is none; by
        default a rotation that is well visible.
    say : callable
        Function that returns an English note in the language of the drawing.

    Returns
    -------
    matplotlib.figure.Figure
    """
    picture = picture.grouped
    ratios = picture.usual if ratio is None else dict.fromkeys(picture.directions, ratio)
    turned = {side: side * times * picture.reference[side] for side, times in ratios.items()}
    measured = [z for each in picture.sketch.lengths for z in (each.start, each.end)]
    measured += [each.apex for each in picture.sketch.angles]
    low, high = box_around([np.array([*picture.extent, *measured])])
    lengths = [each for each in picture.sketch.lengths if _is_at_rest(picture, each) and not each.derived]
    lengths = [*dimensions.heights(picture, lengths), *lengths]  # the lowest is the nearest to the structure
    rows, inside = dimensions.in_rows(lengths, low, high)
    room = style.page_width() - 2 * PANEL_GAP
    width = (room - PANEL_GAP) / len(turned) if style.is_narrow() else room / (1 + len(turned))
    heads = {direction: _head(picture, direction, ratios[direction], width) for direction in turned}
    words = {direction: style.folded(_words(picture, direction), width, style.LABEL) for direction in turned}
    scale = 0.0
    for _ in range(2):  # at a larger scale, dimensions find more room beside ties
        rest = _rest_panel(picture, low, high, dimensions.room(rows, low, high), scale)
        sides = {side: _displaced_panel(picture, turn, heads[side], words[side]) for side, turn in turned.items()}
        in_order = [sides.get(Direction.NEGATIVE), rest, sides.get(Direction.POSITIVE)]
        height = lay_out([each for each in in_order if each is not None], rest)
        scale = rest.scale
    things: list[Line | Forces] = [*picture.sketch.lines, *picture.sketch.forces]
    named = [f"{_look(picture, each)[0]}: {each.name}{_of(each)}" for each in things]
    free = [] if None not in picture.phi_cr.values() else [NO_CRITICAL_TEXT if picture.start is None else STARTING_TEXT]
    notes = style.folded(style.plain("; ".join(map(say, [*named, *picture.sketch.notes, *free]))), room, style.SMALL)
    title = style.in_lines(title, room)
    below = PANEL_GAP + NOTE_HEIGHT * len(_lines(notes))
    height += below + LINE_HEIGHT * len(_lines(title)) + 0.18
    page = Page.new(height, 1 + len(sides))
    for panel in (rest, *sides.values()):
        panel.corner += 1j * below
    for text, x, y, place, size in (
        (title, PANEL_GAP, height - 0.09, "top", style.TITLE),
        (notes, PANEL_GAP, 0.07, "bottom", style.SMALL),
    ):
        plain_text = text.replace(r"\$", "$")
        page.text(complex(x, y), plain_text, va=place, fontsize=size, color=style.INK, parse_math=False)

    _draw_rest(rest.axes(page), picture, rest, (low, high), rows, inside)
    for direction, panel in sides.items():
        axes = panel.axes(page)
        axes.set_title(heads[direction], fontsize=style.LABEL, color=style.INK)
        _draw_displaced(axes, picture, panel, direction, turned[direction])
        page.text(
            panel.corner + panel.inches.real / 2 - 0.06j, words[direction],
            ha="center", va="top", fontsize=style.LABEL, color=style.MEASURE,
        )  # fmt: skip
    return page.finished()


def _lines(*texts: str) -> list[str]:
    """Return the lines of texts; an empty text has none."""
    return [line for text in texts for line in text.splitlines()]


def _draw_rest(
    axes: Axes,
    picture: Picture,
    panel: Panel,
    box: tuple[complex, complex],
    rows: dimensions.Rows,
    inside: Sequence[Length],
) -> None:
    """Draw a structure at rest, with its dimensions in rows beside its box [m] and inside it."""
    axes.set_title("at rest", fontsize=style.LABEL, color=style.INK)
    draw_ground(axes, picture, panel)
    labels = labels_of(axes, picture, panel, 0.0)
    draw_parts(axes, picture, 0.0, weight(picture, panel.scale))
    _draw_lines(axes, picture, labels)
    _draw_forces(axes, picture, panel.scale)
    hung.draw_hung(axes, picture, 0.0, panel, labels)
    pins = _draw_pins(axes, picture, 0.0, _at_rest(picture), panel, labels)
    left, right, below, above = (each / panel.scale for each in hung.beside(picture))
    dimensions.draw_outside(axes, rows, panel, box[0] - complex(left, below), box[1] + complex(right, above), labels)
    _draw_letters(picture, 0.0, pins, labels)
    angles = [each for each in picture.sketch.angles if _is_at_rest(picture, each)]
    dimensions.draw_inside(axes, inside, angles, panel, labels)
    hung.name_hung(picture, panel, labels)
    draw_scale(axes, panel)


def _draw_displaced(axes: Axes, picture: Picture, panel: Panel, direction: Direction, turn: float) -> None:
    """Draw a structure at a signed rotation [rad] over its outline at rest."""
    draw_ground(axes, picture, panel)
    draw_outline_at_rest(axes, picture, min(style.THIN, weight(picture, panel.scale)))
    draw_parts(axes, picture, turn, weight(picture, panel.scale))
    labels = labels_of(axes, picture, panel, turn)
    hung.draw_hung(axes, picture, turn, panel, labels)
    own_pins = [pin for pin in picture.pins if pin.direction is direction]
    pins = _draw_pins(axes, picture, turn, own_pins, panel, labels)
    _draw_letters(picture, turn, pins, labels)


def draw_at_rest(axes: Axes, picture: Picture, title: str) -> None:
    """Draw a structure at rest into given axes, in proportion, without dimensions."""
    low, high = picture.extent[0], picture.extent[1]
    axes.set_axis_off()
    axes.set_aspect("equal")
    for line in (*picture.ground, *picture.walls):
        axes.plot(line.real, line.imag, color=style.EARTH, linewidth=style.BOLD, zorder=1)
    draw_parts(axes, picture, 0.0, style.MEDIUM)
    across, up = (high - low).real, (high - low).imag
    axes.set_xlim(low.real - 0.1 * across, high.real + 0.1 * across)
    axes.set_ylim(low.imag - 0.05 * up, high.imag + 0.05 * up)
    if title:
        axes.set_title(title, fontsize=style.TICK)


def _rest_panel(
    picture: Picture, low: complex, high: complex, around: tuple[float, float, float, float], scale: float
) -> Panel:
    """Return the panel for the structure from `low` to `high`, its labels, loads and ties, at least at a scale."""
    far = box_around([np.array([low, high, *picture.held(0.0)])])
    beyond = (low - far[0]).real, (far[1] - high).real, (low - far[0]).imag, (far[1] - high).imag
    beside = np.add(around, hung.beside(picture)) - scale * np.array(beyond)
    left, right, below, above = np.maximum(np.maximum(beside, dimensions.SIDE_MARGIN), hung.margins(picture)).tolist()
    wider = hung.NAME_MARGIN if picture.loads or picture.ties else 0.0
    return Panel(*far, (left + wider, right + wider, below, above), head=LINE_HEIGHT + 0.1, foot=SCALE_HEIGHT)


def _displaced_panel(picture: Picture, rotation: float, head: str, words: str) -> Panel:
    """Return the panel for the structure at a rotation, with its heading and the words below it."""
    outlines, pins = picture.placed(rotation)
    moved = [*picture.extent, *pins, *picture.held(rotation)]
    low, high = box_around([np.array(moved), *(each for part in outlines for each in part)])
    side = max(0.1, MIN_PANEL_WIDTH / 4)
    left, right, below, above = np.maximum((side, side, 0.16, 0.12), hung.margins(picture)).tolist()
    tall, deep = (LINE_HEIGHT * len(_lines(text)) + 0.1 for text in (head, words))
    widest = max(style.size_of(line, style.LABEL).real for line in _lines(head, words))
    return Panel(low, high, (left, right, below, above), tall, deep, widest)


def _head(picture: Picture, direction: Direction, ratio: float, width: float) -> str:
    """Return the title of a panel that shows the displaced structure: direction and rotation, or how it starts."""
    if picture.start is not None:
        return f"{direction.label}\nas it starts"
    phi = ratio * picture.reference[direction]
    times = "" if ratio == 1 else f"{ratio:.3g} "
    of = "" if picture.phi_cr[direction] is None else rf"{times}$\phi_{{cr}}$ = "
    value = f"{phi:.3g} rad = {three_digits(degrees(phi))}°"
    lines = style.folded(rf"$\phi$ = {of}{value.replace(' ', NO_BREAK)}", width, style.LABEL)
    return f"{direction.label} ({SENSE[direction]})\n{lines.replace(NO_BREAK, ' ')}"


def _is_at_rest(picture: Picture, each: Length | Angle | Line | Forces | DrawnHinge) -> bool:
    """Return whether an item is drawn at rest: it belongs to both directions, or to the first."""
    return each.direction in (None, picture.directions[0])


def _words(picture: Picture, direction: Direction) -> str:
    """Return the lengths and angles of a direction as text, if the two directions differ."""
    lengths = [each for each in picture.sketch.lengths if not each.derived]
    every: list[Length | Angle] = [*lengths, *picture.sketch.angles]
    if not picture.mechanism.rocks_both_ways or not any(each.direction is Direction.NEGATIVE for each in every):
        return ""
    return ", ".join(mathematics(each) for each in every if each.direction is direction)


def _look(picture: Picture, each: Line | Forces) -> tuple[str, dict[str, Any]]:
    """Return the name and the look of a line or of forces: another for the second direction."""
    return ("orange", style.THRUST) if _is_at_rest(picture, each) else ("violet, dotted", style.OTHER_THRUST)


def _of(thing: Line | Forces) -> str:
    return f" ({thing.direction.label} direction)" if thing.direction is not None else ""


def _at_rest(picture: Picture) -> list[DrawnHinge]:
    """Return the pins to mark at rest: for a linkage those of the first direction, otherwise all."""
    first = [pin for pin in picture.pins if _is_at_rest(picture, pin)]
    if picture.sketch.hinges and len(first) > 1:
        return first
    return list({(pin.letter, pin.point): pin for pin in reversed(picture.pins)}.values())[::-1]


def colour(picture: Picture, k: int, direction: Direction) -> str:
    """Return the colour of a part while it rocks in a direction: that of its link."""
    shade = picture.shades[direction][k]
    return style.RESTING_COLOUR if shade is None else style.BODIES[shade]


def weight(picture: Picture, scale: float) -> float:
    """Return the width of the lines around parts [pt] at a scale [inches per m]; thinner for many small blocks."""
    if sum(len(part.outlines) for part in picture.parts) <= MAX_SEPARATE_PARTS:
        return style.MEDIUM
    share = LINE_WEIGHT_SHARE * _smaller_side(picture) * scale * style.POINTS_PER_INCH
    return min(style.MEDIUM, max(style.HAIR, share))


def draw_parts(axes: Axes, picture: Picture, rotation: float, line: float) -> None:
    """Draw the parts at a signed rotation [rad] with lines of a weight [pt], and their centroids."""
    outlines, _ = picture.placed(rotation)
    centroids = picture.marks(rotation)
    direction = picture.side(rotation)
    for k, (part, polygons) in enumerate(zip(picture.parts, outlines, strict=True)):
        moves = picture.shades[direction][k] is not None
        look = {
            "facecolor": colour(picture, k, direction),
            "edgecolor": style.INK if moves else style.EARTH,
            "linewidth": line if moves else min(line, style.THIN),
            "linestyle": (0, (3, 2)) if part.assumed else "-",
        }
        for patch in _patches(part, polygons, **look, joinstyle="round"):
            axes.add_patch(patch)
    axes.plot(
        centroids.real, centroids.imag, linestyle="none", marker="o", markersize=5, fillstyle="top", zorder=5.5,
        color=style.INK, markerfacecoloralt=style.PAPER, markeredgewidth=style.THIN,
    )  # fmt: skip


def draw_outline_at_rest(axes: Axes, picture: Picture, line: float) -> None:
    """Draw the outlines of the parts at rest, faint and dashed, with lines of a weight [pt]."""
    for part in picture.parts:
        look = {"facecolor": style.SHADE, "edgecolor": style.FAINT, "linestyle": "--", "linewidth": line}
        for patch in _patches(part, part.outlines, **look):
            axes.add_patch(patch)


def _patches(part: DrawnPart, polygons: Sequence[Points], **look: Any) -> list[Patch]:
    """Return the outlines of a part, the first at the back; those of many blocks as one path."""
    if not part.mass:
        return [Polygon(hung.xy(each), closed=True, **look) for each in polygons]
    paths = [Path(hung.xy(np.append(each, each[:1])), closed=True) for each in polygons]
    return [PathPatch(Path.make_compound_path(*paths), **look)]


def labels_of(axes: Axes, picture: Picture, panel: Panel, rotation: float) -> Labels:
    """Return the labels of a panel, which keep off edges and centroids of the structure, and off the ground."""
    labels = Labels(axes, panel)
    outlines, _ = picture.placed(rotation)
    for part, polygons in zip(picture.parts, outlines, strict=True):
        for each in [*polygons, *part.outlines]:
            labels.keep_off([*each, each[0]], EDGE_COST)
    for centroid in picture.marks(rotation):
        labels.keep_off([centroid], MARK_COST)
    for line in (*picture.ground, *picture.walls):
        labels.keep_off(line, EDGE_COST)
        labels.keep_off(np.concatenate([line[:1], hatches(line, panel).ravel()]), EDGE_COST / 2)
    return labels


def _draw_pins(
    axes: Axes, picture: Picture, rotation: float, pins: Sequence[DrawnHinge], panel: Panel, labels: Labels
) -> Sequence[DrawnHinge]:
    """Mark hinges and pivots; those of one link are joined by a line if all have a letter."""
    if not pins:
        return pins
    _, every = picture.placed(rotation)
    z = np.array([every[picture.pins.index(pin)] for pin in pins])
    centroids = picture.at(np.array([rotation]))[0][:, 0]
    for pin, place in zip(pins, z, strict=True):
        labels.keep_off([place], MARK_COST)
        if picture.parts[pin.part].assumed:  # its shape is unknown: an arm to its centroid is drawn
            arm = np.array([place, centroids[pin.part]])
            axes.plot(arm.real, arm.imag, color=style.INK, linewidth=style.THIN, zorder=3)
            labels.keep_off(arm, EDGE_COST)
        if pin.slide:
            guide = place + pin.slide / abs(pin.slide) * np.array([-0.22, 0.22]) / panel.scale
            axes.plot(guide.real, guide.imag, color=style.EARTH, linewidth=style.BOLD, zorder=3)
            labels.keep_off(guide)
    if len(pins) > 2 and all(pin.letter for pin in pins):
        line = np.array([each for chain in picture.chains(pins) for each in (*z[chain], np.nan)][:-1], np.complex128)
        axes.plot(line.real, line.imag, color=style.INK, linewidth=style.THIN, linestyle=(0, (6, 2, 1, 2)), zorder=3)
        for chain in picture.chains(pins):
            labels.keep_off(z[chain])
    axes.plot(
        z.real, z.imag, linestyle="none", marker="o", markersize=4.5, zorder=5,
        color=style.PAPER, markeredgecolor=style.INK, markeredgewidth=style.MEDIUM,
    )  # fmt: skip
    return pins


def _draw_letters(picture: Picture, rotation: float, pins: Sequence[DrawnHinge], labels: Labels) -> None:
    """Write the letters of the hinges, outside of the structure if there is room."""
    _, every = picture.placed(rotation)
    middle = (picture.extent[0] + picture.extent[1]) / 2
    look: dict[str, Any] = {"fontsize": style.LABEL, "fontweight": "bold", "color": style.INK, "zorder": 7}
    for pin in pins:
        if pin.letter:
            place = complex(every[picture.pins.index(pin)])
            side = complex(np.sign(round((pin.point - middle).real, 9)) or 1.0, 0.6)
            letter = style.plain(pin.letter)
            size = style.size_of(letter, style.LABEL, "bold")
            labels.write(letter, labels.around(place, side, HINGE_RADIUS, size, turning=0.6), **look)


def _draw_lines(axes: Axes, picture: Picture, labels: Labels) -> None:
    for each in picture.sketch.lines:
        z = np.asarray(each.points)
        axes.plot(z.real, z.imag, zorder=3, **_look(picture, each)[1])
        labels.keep_off(z)


def _draw_forces(axes: Axes, picture: Picture, scale: float) -> None:
    """Draw forces in joints as strokes along them, thicker for larger forces."""
    for each in picture.sketch.forces:
        longest = min(MAX_STROKE_LENGTH, MAX_STROKE_SHARE * _smaller_side(picture) * scale) / scale
        force = np.asarray(each.forces)
        share = np.abs(force) / np.abs(force).max()
        seen = share > MIN_FORCE_SHARE
        half = force[seen] / np.abs(force[seen]) * longest / 2
        middle = np.asarray(each.points)[seen]
        strokes = [hung.xy(np.array(ends)) for ends in zip(middle - half, middle + half, strict=True)]
        look = _look(picture, each)[1]
        dashes = "-" if look is style.THRUST else look["linestyle"]
        weights = MAX_STROKE_WEIGHT * np.sqrt(share[seen])
        drawn = LineCollection(strokes, colors=look["color"], linewidths=weights, linestyles=[dashes], zorder=3)
        axes.add_collection(drawn, autolim=False)


def _smaller_side(picture: Picture) -> float:
    """Return the median, over all outlines, of the smaller side of an outline [m]."""
    outlines = [each for part in picture.parts for each in part.outlines]
    return float(np.median([min(np.ptp(each.real), np.ptp(each.imag)) for each in outlines]))


def draw_ground(axes: Axes, picture: Picture, panel: Panel) -> None:
    """Draw the ground and side walls, hatched."""
    for line in (*picture.ground, *picture.walls):
        axes.plot(line.real, line.imag, color=style.EARTH, linewidth=style.BOLD, zorder=1)
        ticks = [hung.xy(each) for each in hatches(line, panel)]
        axes.add_collection(LineCollection(ticks, colors=style.EARTH, linewidths=style.THIN))


def hatches(line: Points, panel: Panel) -> Points:
    """Return start and end of the hatches under a line of the ground, shape (n, 2) [m]."""
    ticks: list[Points] = []
    for start, end in pairwise(line):
        along = (end - start) / abs(end - start)
        count = max(1, int(abs(end - start) * panel.scale / HATCH_DEPTH))
        at = start + (end - start) * (np.arange(count) + 0.5) / count
        ticks += [np.array([z, z + HATCH_DEPTH / panel.scale * along * np.exp(-2.4j)]) for z in at]
    return np.array(ticks)


def draw_scale(axes: Axes, panel: Panel) -> None:
    """Draw a scale bar of a round length under the panel."""
    longest = MAX_SCALE_LENGTH / panel.scale
    unit = 10.0 ** floor(log10(longest))
    length = next(times * unit for times in (5, 2, 1) if times * unit <= longest)
    half = length * panel.scale / panel.inches.real / 2
    below = -0.09 / panel.inches.imag
    axes.plot(
        [0.5 - half, 0.5 + half], [below] * 2, transform=axes.transAxes, clip_on=False, color=style.INK,
        linewidth=style.BOLD, marker="|", markersize=5,
    )  # fmt: skip
    axes.annotate(
        f"{length:g} m", (0.5, 0.0), (0, -9), xycoords="axes fraction", textcoords="offset points",
        ha="center", va="top", fontsize=style.SMALL, color=style.INK, annotation_clip=False,
    )  # fmt: skip
