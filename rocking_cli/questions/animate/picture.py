"""Animation of a structure under a ground motion, with time histories below: as GIF, and as an HTML page.

In a GIF, what stands still is drawn once. Only the structure and the cursor are drawn again for each frame, by
matplotlib's renderer, which smooths them.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Iterator
from functools import cache
from io import BytesIO
from math import ceil
from typing import Any, BinaryIO

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Affine2D, IdentityTransform
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.plotting import hung, style
from rocking_cli.plotting.moving import as_script, asset, ground_chart, moving, ratio_chart
from rocking_cli.plotting.panels import Page, Panel
from rocking_cli.plotting.structure import colour, draw_ground, draw_scale, weight
from rocking_cli.studies.film import Film
from rocking_cli.text import printable
from rocking_cli.views.animation import why_it_ends

Reals = NDArray[np.float64]
DOTS_PER_INCH = 100
SUPERSAMPLING = 2  # factor of enlargement while the parts at rest are drawn
MAX_STRUCTURE_HEIGHT = 3.4  # inches
TITLE_HEIGHT, FOOT_HEIGHT, TRACE_HEIGHT, PANEL_GAP, LEFT_MARGIN = 0.6, 0.42, 0.95, 0.12, 0.82  # inches
BLENDS = (0.2, 0.4, 0.6, 0.8)  # shares of a colour over its background, for smooth edges
HINGE_RADIUS = 3.0  # pixels
NEARLY_WHITE = 0.97
ARROW_HEAD_LENGTH = 0.13  # inches
LAST_FRAME_DURATION = 1.5  # s


def frame_time(fps: float) -> float:
    """Return the duration of a frame [s]: a multiple of 0.01 s, and at least 0.02 s, as many programs require."""
    return max(2, round(100 / fps)) / 100


def write_gif(
    stream: BinaryIO, film: Film, title: str, times: Reals, fps: float, advance: Callable[[int], None]
) -> None:
    """Write an animated GIF.

    Parameters
    ----------
    stream : binary file
        Stream to write to.
    film : Film
        The motion to show.
    title : str
        Heading.
    times : ndarray, shape (frames,)
        Time of each frame [s].
    fps : float
        Frames a second; see `frame_time`.
    advance : callable
        Called with the number of frames done since the last call.
    """
    stage = _Stage(film, title, float(times[0]), float(times[-1]))
    frames = _frames(stage, film, times, advance)
    first = next(frames)
    delay, last = round(1000 * frame_time(fps)), round(1000 * LAST_FRAME_DURATION)
    first.save(
        stream, format="GIF", save_all=True, append_images=frames, loop=0, optimize=True, disposal=1,
        duration=[delay] * (times.size - 1) + [last],
    )  # fmt: skip


def _frames(stage: _Stage, film: Film, times: Reals, advance: Callable[[int], None]) -> Iterator[Image.Image]:
    rotation = film.rotation(times)
    ratio = film.ratio(rotation)
    palette = _palette()
    for each in zip(times.tolist(), rotation.tolist(), ratio.tolist(), strict=True):
        yield stage.frame(*each).quantize(palette=palette, dither=Image.Dither.NONE)
        advance(1)


@cache
def _palette() -> Image.Image:
    """Return the colours of a GIF: those of the style, and shades of them. Few colours make small files."""
    colours = {to_rgb(style.PAPER), to_rgb(style.INK)}
    drawn = (style.RESTING_COLOUR, style.EARTH, style.CURSOR, style.INK, style.FAINT, style.TIE["color"])
    for each in (*style.BODIES, *drawn):
        colour, white, ink = (np.array(to_rgb(c)) for c in (each, style.PAPER, style.INK))
        for other in (white, ink):
            colours |= {tuple(colour + share * (other - colour)) for share in (0.0, *BLENDS)}
    # The nearest colour of the palette is found approximately: nearly white must not become white.
    colours = {each for each in colours if min(each) < NEARLY_WHITE or min(each) == 1}
    image = Image.new("P", (1, 1))
    image.putpalette([round(255 * part) for colour in sorted(colours) for part in colour])
    return image


class _Stage:
    """The still background of an animation, and the positions at which moving things are drawn [pixels]."""

    def __init__(self, film: Film, title: str, start: float, end: float) -> None:
        self._film = film
        low, high = film.box
        left, right, below, above = np.maximum((0.15, 0.15, 0.16, 0.15), hung.margins(film.picture)).tolist()
        panel = Panel(low, high, (left, right, below, above))
        size = panel.plane
        panel.scale = min(
            (style.page_width() - 2 * PANEL_GAP - panel.room.real) / size.real,
            (MAX_STRUCTURE_HEIGHT - panel.room.imag) / size.imag,
        )
        spare = style.page_width() - 2 * PANEL_GAP - panel.inches.real
        panel.around = left + spare / 2, right + spare / 2, below, above
        below = 2 * TRACE_HEIGHT + 3 * PANEL_GAP + FOOT_HEIGHT + 0.3
        panel.corner = complex(PANEL_GAP, below)
        tall = ceil((below + panel.inches.imag + TITLE_HEIGHT) * DOTS_PER_INCH) / DOTS_PER_INCH
        figure = Figure(figsize=(style.page_width(), tall), dpi=DOTS_PER_INCH * SUPERSAMPLING)
        figure.text(
            PANEL_GAP / style.page_width(), 1 - 0.1 / tall, style.fitted(title), va="top",
            fontsize=style.TITLE, color=style.INK, parse_math=False,
        )  # fmt: skip
        axes = panel.axes(Page(figure, complex(style.page_width(), tall)))
        draw_ground(axes, film.picture, panel)
        draw_scale(axes, panel)
        lower = figure.add_axes(
            (
                LEFT_MARGIN / style.page_width(),
                FOOT_HEIGHT / tall,
                1 - (LEFT_MARGIN + PANEL_GAP) / style.page_width(),
                TRACE_HEIGHT / tall,
            )
        )
        upper = figure.add_axes(
            (
                LEFT_MARGIN / style.page_width(),
                (FOOT_HEIGHT + TRACE_HEIGHT + PANEL_GAP) / tall,
                1 - (LEFT_MARGIN + PANEL_GAP) / style.page_width(),
                TRACE_HEIGHT / tall,
            )
        )
        _draw_traces(upper, lower, film, start, end)
        drawn = BytesIO()
        style.save(figure, drawn, format="png", dpi=DOTS_PER_INCH * SUPERSAMPLING)
        self._still = np.asarray(Image.open(drawn).convert("RGB").reduce(SUPERSAMPLING))
        height, width, _ = self._still.shape
        self._renderer: Any = RendererAgg(width, height, DOTS_PER_INCH)  # type: ignore[no-untyped-call]
        self._panel_scale, self._scale = panel.scale, panel.scale * DOTS_PER_INCH
        left = panel.low.real - panel.around[0] / panel.scale - PANEL_GAP / panel.scale
        self._origin = complex(left, panel.low.imag - (panel.around[2] + panel.corner.imag) / panel.scale)
        self._strip = [
            (
                *(axes.transData.transform((t, 0.0))[0] / SUPERSAMPLING for t in (start, end)),
                axes.bbox.y0 / SUPERSAMPLING,
                axes.bbox.y1 / SUPERSAMPLING,
            )
            for axes in (upper, lower)
        ]
        self._times = start, end
        # Small ratios of rotation to limit need more digits.
        self._digits = 5 if any(film.history.ends_at_limit) else 2

    def frame(self, time: float, rotation: float, ratio: float) -> Image.Image:
        """Return one frame, in colours."""
        pixels = np.asarray(self._renderer.buffer_rgba())
        pixels[..., :3] = self._still
        pixels[..., 3] = 255
        places = self._draw_structure(rotation)
        frame = Image.fromarray(pixels[..., :3])
        pen = ImageDraw.Draw(frame)
        for letter, place in places:
            pen.text(
                (place.real + 5, frame.height - place.imag - 5), letter, fill=style.INK, font=_font(12, bold=True),
                anchor="lb", stroke_width=2, stroke_fill=style.PAPER,
            )  # fmt: skip
        start, end = self._times
        share = (time - start) / (end - start) if end > start else 0.0
        for x0, x1, y0, y1 in self._strip:
            x = round(x0 + share * (x1 - x0))
            pen.line([(x, frame.height - y1), (x, frame.height - y0)], fill=style.CURSOR, width=2)
        over = style.over(self._film.history.ends_at_limit)
        now = f"t = {time:6.2f} s    {over} = {round(ratio, self._digits) + 0.0:+.{self._digits}f}"
        pen.text((frame.width - 12, 30), now, fill=style.INK, font=_font(13), anchor="ra")
        if time >= end:
            pen.text((12, 46), why_it_ends(self._film), fill=style.CURSOR, font=_font(13, bold=True))
        return frame

    def _draw_structure(self, rotation: float) -> list[tuple[str, complex]]:
        """Draw parts and hinges; return the letters of the hinges and their positions [pixels]."""
        picture = self._film.picture.grouped
        outlines, pins = picture.placed(rotation)
        direction = picture.side(rotation)
        shown = hung.symbols(picture, rotation, self._panel_scale)
        self._draw_ties(shown, behind=True)
        pen = self._pen(style.INK, weight(picture, self._panel_scale))
        for k, polygons in enumerate(outlines):
            fill = to_rgb(colour(picture, k, direction))
            for each in polygons:
                corners = self._pixels(np.append(each, each[0]))
                self._renderer.draw_path(pen, Path(corners, closed=True), IdentityTransform(), fill)
        pen.restore()
        self._draw_ties(shown, behind=False)
        self._draw_loads(shown)
        pen = self._pen(style.INK, style.MEDIUM)
        seen = [] if rotation == 0 else [k for k, pin in enumerate(picture.pins) if pin.direction is direction]
        for x, y in self._pixels(pins[seen]):
            ring = Affine2D().scale(HINGE_RADIUS).translate(x, y)
            self._renderer.draw_path(pen, Path.unit_circle(), ring, to_rgb(style.PAPER))
        pen.restore()
        places = self._pixels(pins[seen]) @ np.array([1, 1j])
        return [(picture.pins[k].letter, complex(place)) for k, place in zip(seen, places, strict=True)]

    def _pen(self, colour: str, points: float) -> Any:
        pen = self._renderer.new_gc()
        pen.set_foreground(colour)
        pen.set_linewidth(self._renderer.points_to_pixels(points))
        pen.set_joinstyle("round")
        pen.set_snap(False)  # drawings move by fractions of a pixel
        return pen

    def _draw_ties(self, shown: hung.Symbols, *, behind: bool) -> None:
        """Draw ties and their anchorages: those that the structure may cover, or the others."""
        for line, loose, of_bed in shown.lines:
            if of_bed is behind:
                pen = self._pen(style.TIE["color"], style.TIE["linewidth"])
                if loose:
                    pen.set_dashes(0, [self._renderer.points_to_pixels(each) for each in (3.5, 2.5)])
                self._renderer.draw_path(pen, Path(self._pixels(line)), IdentityTransform())
                pen.restore()
        pen = self._pen(style.INK, style.THIN)
        for at, of_bed in shown.anchors:
            if of_bed is behind:
                self._fill(pen, at + hung.ANCHOR_HALF_WIDTH / self._panel_scale * hung.SQUARE, style.EARTH)
        pen.restore()

    def _draw_loads(self, shown: hung.Symbols) -> None:
        pen = self._pen(style.PAPER, style.THIN)
        for outline in shown.weights:
            self._fill(pen, outline, style.INK)
        pen.restore()
        pen = self._pen(style.CURSOR, style.BOLD)
        for tail, tip in shown.forces:
            head = tip + (tail - tip) / abs(tail - tip) * ARROW_HEAD_LENGTH / self._panel_scale * np.array(
                [0, 1 + 0.45j, 1 - 0.45j]
            )
            self._renderer.draw_path(pen, Path(self._pixels(np.array([tail, head.mean()]))), IdentityTransform())
            self._fill(pen, head, style.CURSOR)
        pen.restore()

    def _fill(self, pen: Any, outline: NDArray[np.complex128], colour: str) -> None:
        corners = self._pixels(np.append(outline, outline[0]))
        self._renderer.draw_path(pen, Path(corners, closed=True), IdentityTransform(), to_rgb(colour))

    def _pixels(self, z: NDArray[np.complex128]) -> NDArray[np.float64]:
        """Return points in pixels from the lower left corner, shape (n, 2)."""
        away = (z - self._origin) * self._scale
        return np.stack([away.real, away.imag], axis=-1)


@cache
def _font(size: int, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(f"{matplotlib.get_data_path()}/fonts/ttf/{name}", size)


def _draw_traces(upper: Axes, lower: Axes, film: Film, start: float, end: float) -> None:
    time, ratio = ratio_trace(film)
    upper.plot(time, ratio, **style.TRACE)
    t, ground = ground_trace(film.motion)
    lower.plot(t, ground, **style.TRACE)
    for axes, values, label in (
        (upper, ratio, style.over(film.history.ends_at_limit, math=True)),
        (lower, ground, "ground [g]"),
    ):
        axes.set_xlim(start, max(end, start + 1e-3))
        tall = 1.1 * max(float(np.abs(values).max()), 1e-3)
        axes.set_ylim(-tall, tall)
        axes.yaxis.set_label_coords(-(LEFT_MARGIN - 0.3) / (style.page_width() - LEFT_MARGIN - PANEL_GAP), 0.5)
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
        style.tidy(axes, y=label)
    for level in (-1.0, 1.0):
        upper.axhline(level, color=style.FAINT, linewidth=style.THIN, linestyle=":")
    upper.tick_params(labelbottom=False)
    lower.set_xlabel("time [s]", fontsize=style.LABEL)


def ratio_trace(film: Film) -> tuple[Reals, Reals]:
    """Return times [s] and phi/phi_cr of a history, thinned to what is visible."""
    ratio = film.history.ratio[np.isfinite(film.history.ratio)]
    shown = style.visible(ratio)
    return film.history.time[shown], ratio[shown]


def ground_trace(motion: GroundMotion) -> tuple[Reals, Reals]:
    """Return times [s] and accelerations [g] of a ground motion, thinned to what is visible."""
    motion = motion.kept
    shown = style.visible(motion.acceleration)
    return shown.astype(np.float64) * motion.dt, motion.acceleration[shown] / STANDARD_GRAVITY


def animation_page(film: Film, title: str, speed: float = 1.0) -> str:
    """Return an HTML page in which the structure moves; it needs no other file and no network.

    Parameters
    ----------
    film : Film
        The motion to show.
    title : str
        Heading.
    speed : float
        Initial speed: seconds of motion per second.
    """
    model = film.history.model
    data = moving(
        film,
        [ratio_chart({model: film.history}), ground_chart(film.motion, [])],
        label=f"{title}, as it moves",
        speed=speed,
        moment=film.start,
    )
    data["about"] = f"{film.motion.name}, PGA {film.motion.of_ground.pga_g:.3g} g; {model} model"
    parts = {
        "TITLE": html.escape(title), "STYLE": asset("motion.css"), "SCRIPT": asset("motion.js"), "DATA": as_script(data)
    }  # fmt: skip
    # One pass for all parts: a name in one part must not be replaced as a placeholder of another.
    return printable(re.sub("@(TITLE|STYLE|SCRIPT|DATA)@", lambda match: parts[match[1]], asset("animation.html")))
