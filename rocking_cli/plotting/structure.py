"""A structure at rest and displaced, to scale, so that its mechanism and dimensions can be checked by eye."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import degrees, floor, log10
from textwrap import fill, shorten

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from rocking_cli.core import Angle, Direction, Length, Line
from rocking_cli.plotting import dimensions, style
from rocking_cli.plotting.panels import GAP, Panel, lay_out
from rocking_cli.studies.picture import Picture, Pin, box_around

Points = NDArray[np.complex128]
HEAD, FOOT = 0.42, 0.34  # inches above a panel for its heading, and below it for the scale
TITLE, NOTE, ROW = 0.34, 0.13, 0.13  # inches: of the title, and of a line of notes or under a panel
NARROWEST = 0.95  # inches: a slender structure still needs room for its words
EARTH = 0.08  # inches: depth of the hatches of the ground
LONGEST_BAR = 0.8  # inches: of the scale
WORDS = 46  # characters of a line under a panel
NOTES = 125  # characters of a line of notes
SENSE = {Direction.POSITIVE: "clockwise", Direction.NEGATIVE: "anticlockwise"}


def draw_structure(picture: Picture, title: str, ratio: float = 1.0) -> Figure:
    """Draw a structure displaced in the negative direction, at rest with its dimensions, and in the positive direction.

    Parameters
    ----------
    picture : Picture
        What to draw.
    title : str
        Heading.
    ratio : float
        Rotation of the displaced structure over the critical one.

    Returns
    -------
    matplotlib.figure.Figure
    """
    turned = {direction: direction * ratio * picture.phi_cr[direction] for direction in Direction}
    low, high = _box_at_rest(picture)
    shown = [each for each in picture.sketch.lengths if each.direction is not Direction.NEGATIVE]
    rows, inside = dimensions.in_rows(shown, low, high)
    rest = Panel(low, high, tuple(dimensions.room(rows, side) for side in dimensions.SIDES))  # type: ignore[arg-type]
    sides = {direction: _displaced_panel(picture, turn) for direction, turn in turned.items()}
    words = {direction: _words(picture, direction) for direction in Direction}
    foot = FOOT + ROW * max(text.count("\n") + bool(text) for text in words.values())
    named = [f"orange: {each.name}{_of(each)}" for each in _lines(picture)]
    notes = fill("; ".join([*named, *picture.sketch.notes]), NOTES)
    height = lay_out(sides[Direction.NEGATIVE], rest, sides[Direction.POSITIVE], HEAD, foot)
    below = GAP + NOTE * (notes.count("\n") + bool(notes))
    figure = Figure(figsize=(style.WIDTH, below + height + TITLE), dpi=style.DPI)
    for panel in (rest, *sides.values()):
        panel.corner += 1j * below
    width, height = figure.get_size_inches()
    for text, x, y, place, size in (
        (shorten(title, style.LONGEST, placeholder=" ..."), GAP, height - 0.09, "top", style.TITLE),
        (notes, GAP, 0.07, "bottom", style.SMALL),
    ):
        figure.text(x / width, y / height, text, va=place, fontsize=size, color=style.INK, parse_math=False)

    axes = rest.axes(figure)
    axes.set_title("at rest", fontsize=style.LABEL, color=style.INK)
    draw_ground(axes, picture, rest)
    _draw_parts(axes, picture, 0.0)
    _draw_lines(axes, picture)
    dimensions.draw_outside(axes, rows, rest, low, high)
    angles = [each for each in picture.sketch.angles if each.direction is not Direction.NEGATIVE]
    dimensions.draw_inside(axes, inside, angles, rest)
    _draw_pins(axes, picture, 0.0, _at_rest(picture), rest)
    draw_scale(axes, rest)
    for direction, panel in sides.items():
        axes = panel.axes(figure)
        phi = abs(turned[direction])
        times = "" if ratio == 1 else f"{ratio:g} "
        axes.set_title(
            f"{direction.label} ({SENSE[direction]})\nφ = {times}φ_cr = {phi:.4g} rad = {degrees(phi):.4g}°",
            fontsize=style.LABEL, color=style.INK,
        )  # fmt: skip
        draw_ground(axes, picture, panel)
        _draw_outline_at_rest(axes, picture)
        _draw_parts(axes, picture, turned[direction])
        _draw_pins(axes, picture, turned[direction], [pin for pin in picture.pins if pin.direction is direction], panel)
        draw_scale(axes, panel)
        axes.annotate(
            words[direction], (0.5, 0.0), (0, -72 * FOOT), xycoords="axes fraction", textcoords="offset points",
            ha="center", va="top", fontsize=style.SMALL, color=style.MEASURE, annotation_clip=False, parse_math=False,
        )  # fmt: skip
    return figure


def draw_at_rest(axes: Axes, picture: Picture, title: str) -> None:
    """Draw a structure at rest into axes of its own, in proportion, without measures."""
    low, high = picture.extent[0], picture.extent[1]
    axes.set_axis_off()
    axes.set_aspect("equal")
    for line in picture.ground:
        axes.plot(line.real, line.imag, color=style.EARTH, linewidth=style.BOLD, zorder=1)
    _draw_parts(axes, picture, 0.0)
    across, up = (high - low).real, (high - low).imag
    axes.set_xlim(low.real - 0.1 * across, high.real + 0.1 * across)
    axes.set_ylim(low.imag - 0.05 * up, high.imag + 0.05 * up)
    if title:
        axes.set_title(title, fontsize=style.TICK)


def _box_at_rest(picture: Picture) -> tuple[complex, complex]:
    """The box of the structure and of all that is measured [m]."""
    measured = [z for each in picture.sketch.lengths for z in (each.start, each.end)]
    measured += [each.apex for each in picture.sketch.angles]
    return box_around([np.array([*picture.extent, *measured])])


def _displaced_panel(picture: Picture, rotation: float) -> Panel:
    outlines, pins = picture.placed(rotation)
    low, high = box_around([np.array([*picture.extent, *pins]), *(each for part in outlines for each in part)])
    side = max(0.1, NARROWEST / 4)
    return Panel(low, high, (side, side, 0.16, 0.12))


def _words(picture: Picture, direction: Direction) -> str:
    """The lengths and angles of a direction, where the two differ."""
    every: list[Length | Angle] = [*picture.sketch.lengths, *picture.sketch.angles]
    if not any(each.direction is Direction.NEGATIVE for each in every):
        return ""
    return fill(
        ", ".join(each.text.replace(" ", "\N{NO-BREAK SPACE}") for each in every if each.direction is direction), WORDS
    )


def _of(line: Line) -> str:
    return f" ({line.direction.label} direction)" if line.direction is not None else ""


def _at_rest(picture: Picture) -> list[Pin]:
    """Hinges to mark at rest: those of the positive direction, and of the other what is called otherwise."""
    if not picture.sketch.hinges:  # found, without letters
        return list(picture.pins)
    positive = [pin for pin in picture.pins if pin.direction is Direction.POSITIVE]
    letters = {pin.letter for pin in positive}
    return positive + [pin for pin in picture.pins if pin not in positive and pin.letter not in letters]


def colour(picture: Picture, k: int) -> str:
    """The colour of a part: that of its body."""
    return style.BODIES[picture.parts[k].body % len(style.BODIES)]


def _draw_parts(axes: Axes, picture: Picture, rotation: float) -> None:
    outlines, _ = picture.placed(rotation)
    centroids = picture.at(np.array([rotation]))[0][:, 0]
    for k, (part, polygons) in enumerate(zip(picture.parts, outlines, strict=True)):
        dashes = (0, (3, 2)) if part.assumed else "-"
        for each in polygons:
            axes.add_patch(
                Polygon(
                    _xy(each), closed=True, facecolor=colour(picture, k), edgecolor=style.INK,
                    linewidth=style.MEDIUM, linestyle=dashes, joinstyle="round",
                )
            )  # fmt: skip
    axes.plot(
        centroids.real, centroids.imag, linestyle="none", marker="o", markersize=5, fillstyle="top", zorder=4,
        color=style.INK, markerfacecoloralt="white", markeredgewidth=style.THIN,
    )  # fmt: skip


def _draw_outline_at_rest(axes: Axes, picture: Picture) -> None:
    for part in picture.parts:
        for each in part.outlines:
            axes.add_patch(
                Polygon(_xy(each), closed=True, fill=False, edgecolor=style.FAINT, linewidth=style.THIN, linestyle="--")
            )


def _draw_pins(axes: Axes, picture: Picture, rotation: float, pins: Sequence[Pin], panel: Panel) -> None:
    """Mark hinges and pivots with their letters, joined by a line where all have one."""
    if not pins:
        return
    _, every = picture.placed(rotation)
    z = np.array([every[picture.pins.index(pin)] for pin in pins])
    centroids = picture.at(np.array([rotation]))[0][:, 0]
    for pin, place in zip(pins, z, strict=True):
        if picture.parts[pin.part].assumed:  # its shape is not known: show what carries it
            arm = np.array([place, centroids[pin.part]])
            axes.plot(arm.real, arm.imag, color=style.INK, linewidth=style.THIN, zorder=3)
        if pin.slide:
            guide = place + pin.slide / abs(pin.slide) * np.array([-0.22, 0.22]) / panel.scale
            axes.plot(guide.real, guide.imag, color=style.EARTH, linewidth=style.BOLD, zorder=3)
    if len(pins) > 2 and all(pin.letter for pin in pins):
        axes.plot(z.real, z.imag, color=style.INK, linewidth=style.THIN, linestyle=(0, (6, 2, 1, 2)), zorder=3)
    axes.plot(
        z.real, z.imag, linestyle="none", marker="o", markersize=4.5, zorder=5,
        color="white", markeredgecolor=style.INK, markeredgewidth=style.MEDIUM,
    )  # fmt: skip
    middle = (picture.extent[0] + picture.extent[1]) / 2
    for pin, place in zip(pins, z, strict=True):
        out = pin.point - middle
        side = complex(np.sign(round(out.real, 9)) or 1.0, 0.6)
        axes.annotate(
            pin.letter, (place.real, place.imag), (8 * side.real, 8 * side.imag), textcoords="offset points",
            ha="center", va="center", fontsize=style.LABEL, fontweight="bold", color=style.INK, zorder=7,
            annotation_clip=False, path_effects=[withStroke(linewidth=2, foreground="white")],
        )  # fmt: skip


def _draw_lines(axes: Axes, picture: Picture) -> None:
    for each in _lines(picture):
        z = np.asarray(each.points)
        axes.plot(z.real, z.imag, zorder=3, **style.THRUST)


def _lines(picture: Picture) -> list[Line]:
    """The lines that are drawn at rest."""
    return [each for each in picture.sketch.lines if each.direction is not Direction.NEGATIVE]


def draw_ground(axes: Axes, picture: Picture, panel: Panel) -> None:
    """Draw the ground, hatched."""
    for line in picture.ground:
        axes.plot(line.real, line.imag, color=style.EARTH, linewidth=style.BOLD, zorder=1)
        ticks: list[Points] = []
        for start, end in pairwise(line):
            along = (end - start) / abs(end - start)
            count = max(1, int(abs(end - start) * panel.scale / EARTH))
            at = start + (end - start) * (np.arange(count) + 0.5) / count
            ticks += [np.array([z, z + EARTH / panel.scale * along * np.exp(-2.4j)]) for z in at]
        axes.add_collection(LineCollection([_xy(each) for each in ticks], colors=style.EARTH, linewidths=style.THIN))


def draw_scale(axes: Axes, panel: Panel) -> None:
    """A bar of a round length under the panel."""
    longest = LONGEST_BAR / panel.scale
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


def _xy(z: Points) -> NDArray[np.float64]:
    return np.stack([z.real, z.imag], axis=-1)
