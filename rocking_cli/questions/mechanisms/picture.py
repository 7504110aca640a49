"""Thumbnails of mechanisms: each displaced, over its outline at rest."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking_cli.plotting import style
from rocking_cli.plotting.panels import Page
from rocking_cli.plotting.structure import draw_outline_at_rest, draw_parts, weight
from rocking_cli.studies.picture import Picture, box_around
from rocking_cli.views.mechanisms import InstalledMechanism

THUMBNAIL = complex(1.5, 1.2)  # inches
WORDS_HEIGHT, GAP = 0.72, 0.1  # inches of the words below a thumbnail, and between two of them
MARGIN = 0.05  # share of the size of a structure beside it


def draw_chooser(found: Sequence[tuple[InstalledMechanism, Picture | None]]) -> Figure:
    """Draw the thumbnails of mechanisms in a grid, each above its name and the structures that it suits."""
    columns = int(style.page_width() / (THUMBNAIL.real + GAP))
    rows, width, height = ceil(len(found) / columns), style.page_width() / columns, THUMBNAIL.imag + WORDS_HEIGHT
    page = Page.new(rows * height, 1)
    for k, (each, picture) in enumerate(found):
        middle, bottom = (k % columns + 0.5) * width, (rows - 1 - k // columns) * height + WORDS_HEIGHT
        draw_thumbnail(page.add_axes(complex(middle - THUMBNAIL.real / 2, bottom), THUMBNAIL), picture)
        words = style.folded(style.plain(each.meant_for), width - GAP, style.SMALL)
        look = {"ha": "center", "va": "top", "color": style.INK, "linespacing": 1.1}
        page.text(complex(middle, bottom - 0.06), each.name, fontsize=style.TICK, fontweight="bold", **look)
        page.text(complex(middle, bottom - 0.22), words, fontsize=style.SMALL, **look)
    return page.finished()


def draw_thumbnail(axes: Axes, picture: Picture | None) -> None:
    """Draw a structure displaced over its outline at rest, in proportion; nothing without a picture of it."""
    axes.set_axis_off()
    if picture is None:
        return
    picture = picture.grouped
    direction = picture.directions[0]
    turn = direction * picture.usual[direction] * picture.reference[direction]
    outlines, _ = picture.placed(turn)
    low, high = box_around(
        [z for part in outlines for z in part] + [z for part in picture.parts for z in part.outlines]
    )
    room = (1 + 2 * MARGIN) * (high - low)
    scale = min(THUMBNAIL.real / room.real, THUMBNAIL.imag / room.imag)
    half, middle = THUMBNAIL / scale / 2, (low + high) / 2
    line = weight(picture, scale)
    for edge in (*picture.ground, *picture.walls):
        axes.plot(edge.real, edge.imag, color=style.EARTH, linewidth=style.BOLD, zorder=1)
    draw_outline_at_rest(axes, picture, min(style.THIN, line))
    draw_parts(axes, picture, turn, line)
    axes.set_xlim(middle.real - half.real, middle.real + half.real)
    axes.set_ylim(middle.imag - half.imag, middle.imag + half.imag)
