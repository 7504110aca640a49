"""A structure moving under a ground motion, the traces below: as an animated GIF, and as a page.

Of a GIF what stands still is drawn once; only the structure and the cursor are drawn anew for each frame, at twice the
size and then reduced, which smooths them: some 10 ms a frame.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Iterator
from functools import cache
from io import BytesIO
from math import ceil
from pathlib import Path
from textwrap import shorten
from typing import BinaryIO

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from rocking_cli.core import Direction
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.plotting import style
from rocking_cli.plotting.moving import as_script, asset, ground_chart, moving, ratio_chart
from rocking_cli.plotting.panels import Panel
from rocking_cli.plotting.structure import colour, draw_ground, draw_scale
from rocking_cli.plotting.thinning import visible
from rocking_cli.studies.film import Film
from rocking_cli.text import printable

Reals = NDArray[np.float64]
DOTS = 100  # an inch of a frame
FINER = 2  # times as large when the structure is drawn
TALLEST = 3.4  # inches of the structure
TITLE, FOOT, TRACE, GAP, LEFT = 0.6, 0.42, 0.95, 0.12, 0.62  # inches
SHADES = (0.25, 0.5, 0.75)  # between a colour and those it is drawn on, for smooth edges
HOLD = 1.5  # s that the last frame stays


def frame_time(fps: float) -> float:
    """How long a frame is shown [s]: a GIF counts in hundredths, and many programs show none for less than two."""
    return max(2, round(100 / fps)) / 100


def write_gif(
    stream: BinaryIO, film: Film, title: str, times: Reals, fps: float, advance: Callable[[int], None]
) -> None:
    """Write an animated GIF.

    Parameters
    ----------
    stream : binary file
        Where to.
    film : Film
        What is shown.
    title : str
        Heading.
    times : ndarray, shape (frames,)
        When each frame is [s].
    fps : float
        Frames a second; see `frame_time`.
    advance : callable
        Called with the number of frames done since the last call.
    """
    stage = _Stage(film, title, float(times[0]), float(times[-1]))
    frames = _frames(stage, film, times, advance)
    first = next(frames)
    delay, last = round(1000 * frame_time(fps)), round(1000 * HOLD)
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
    """The colours of a GIF: those of the style, and shades to white and to ink. Few colours make small files."""
    colours = {to_rgb("white"), to_rgb(style.INK)}
    for each in (*style.BODIES, style.EARTH, style.CURSOR, style.INK, style.FAINT):
        colour, white, ink = (np.array(to_rgb(c)) for c in (each, "white", style.INK))
        for other in (white, ink):
            colours |= {tuple(colour + share * (other - colour)) for share in (0.0, *SHADES)}
    image = Image.new("P", (1, 1))
    image.putpalette([round(255 * part) for colour in sorted(colours) for part in colour])
    return image


class _Stage:
    """What stands still, and where on it things move [pixels]."""

    def __init__(self, film: Film, title: str, start: float, end: float) -> None:
        self._film = film
        low, high = film.box
        panel = Panel(low, high, (0.15, 0.15, 0.16, 0.15))
        size = panel.plane
        panel.scale = min(
            (style.WIDTH - 2 * GAP - panel.room.real) / size.real, (TALLEST - panel.room.imag) / size.imag
        )
        spare = style.WIDTH - 2 * GAP - panel.inches.real
        panel.around = 0.15 + spare / 2, 0.15 + spare / 2, 0.16, 0.15
        below = 2 * TRACE + 3 * GAP + FOOT + 0.3
        panel.corner = complex(GAP, below)
        tall = ceil((below + panel.inches.imag + TITLE) * DOTS) / DOTS
        figure = Figure(figsize=(style.WIDTH, tall), dpi=DOTS * FINER)
        figure.text(
            GAP / style.WIDTH, 1 - 0.1 / tall, shorten(title, style.LONGEST, placeholder=" ..."), va="top",
            fontsize=style.TITLE, color=style.INK, parse_math=False,
        )  # fmt: skip
        axes = panel.axes(figure)
        draw_ground(axes, film.picture, panel)
        draw_scale(axes, panel)
        lower = figure.add_axes((LEFT / style.WIDTH, FOOT / tall, 1 - (LEFT + GAP) / style.WIDTH, TRACE / tall))
        upper = figure.add_axes(
            (LEFT / style.WIDTH, (FOOT + TRACE + GAP) / tall, 1 - (LEFT + GAP) / style.WIDTH, TRACE / tall)
        )
        _draw_traces(upper, lower, film, start, end)
        drawn = BytesIO()
        style.save(figure, drawn, format="png", dpi=DOTS * FINER)
        self._fine = Image.open(drawn).convert("RGB")
        self._coarse = self._fine.reduce(FINER)
        width, height = self._coarse.size
        top = height - round((panel.corner.imag + panel.inches.imag) * DOTS)
        bottom = height - round(panel.corner.imag * DOTS)
        self._region = 0, top, width, bottom
        self._scale = panel.scale * DOTS * FINER
        left = panel.low.real - panel.around[0] / panel.scale - GAP / panel.scale
        self._origin = complex(left, panel.high.imag + panel.around[3] / panel.scale)
        self._strip = [
            (
                *(axes.transData.transform((t, 0.0))[0] / FINER for t in (start, end)),
                axes.bbox.y0 / FINER,
                axes.bbox.y1 / FINER,
            )
            for axes in (upper, lower)
        ]
        self._times = start, end

    def frame(self, time: float, rotation: float, ratio: float) -> Image.Image:
        """One frame, in colours."""
        frame = self._coarse.copy()
        left, top, right, bottom = self._region
        fine = self._fine.crop(tuple(FINER * each for each in (left, top, right, bottom)))  # type: ignore[arg-type]
        self._draw_structure(ImageDraw.Draw(fine), rotation)
        frame.paste(fine.reduce(FINER), (left, top))
        pen = ImageDraw.Draw(frame)
        start, end = self._times
        share = (time - start) / (end - start) if end > start else 0.0
        for x0, x1, y0, y1 in self._strip:
            x = round(x0 + share * (x1 - x0))
            pen.line([(x, frame.height - y1), (x, frame.height - y0)], fill=style.CURSOR, width=2)
        now = f"t = {time:6.2f} s    φ/φ_cr = {round(ratio, 2) + 0.0:+.2f}"
        pen.text((frame.width - 12, 30), now, fill=style.INK, font=_font(13), anchor="ra")
        return frame

    def _draw_structure(self, pen: ImageDraw.ImageDraw, rotation: float) -> None:
        picture = self._film.picture
        outlines, pins = picture.placed(rotation)
        for k, polygons in enumerate(outlines):
            for each in polygons:
                pen.polygon(self._pixels(each), fill=colour(picture, k), outline=style.INK, width=3)
        direction = Direction.NEGATIVE if rotation < 0 else Direction.POSITIVE
        for pin, place in zip(picture.pins, pins, strict=True):
            if pin.direction is direction and rotation != 0:
                ((x, y),) = self._pixels(np.array([place]))
                pen.ellipse((x - 6, y - 6, x + 6, y + 6), fill="white", outline=style.INK, width=FINER)
                pen.text(
                    (x + 10, y - 10), pin.letter, fill=style.INK, font=_font(12 * FINER, bold=True), anchor="lb",
                    stroke_width=3, stroke_fill="white",
                )  # fmt: skip

    def _pixels(self, z: NDArray[np.complex128]) -> list[tuple[float, float]]:
        away = (z - self._origin) * self._scale
        return list(zip(away.real.tolist(), (-away.imag).tolist(), strict=True))


@cache
def _font(size: int, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    return ImageFont.truetype(str(folder / ("DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf")), size)


def _draw_traces(upper: Axes, lower: Axes, film: Film, start: float, end: float) -> None:
    time, ratio = ratio_trace(film)
    upper.plot(time, ratio, **style.TRACE)
    t, ground = ground_trace(film.motion)
    lower.plot(t, ground, **style.TRACE)
    for axes, values, label in ((upper, ratio, r"$\phi/\phi_{cr}$"), (lower, ground, "ground [g]")):
        axes.set_xlim(start, max(end, start + 1e-3))
        tall = 1.1 * max(float(np.abs(values).max()), 1e-3)
        axes.set_ylim(-tall, tall)
        axes.set_ylabel(label, fontsize=style.LABEL)
        axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
        style.tidy(axes)
    for level in (-1.0, 1.0):
        upper.axhline(level, color=style.FAINT, linewidth=style.THIN, linestyle=":")
    upper.tick_params(labelbottom=False)
    lower.set_xlabel("time [s]", fontsize=style.LABEL)


def ratio_trace(film: Film) -> tuple[Reals, Reals]:
    """Times [s] and phi/phi_cr of the history, as many as can be seen."""
    ratio = film.history.ratio[np.isfinite(film.history.ratio)]
    shown = visible(ratio)
    return film.history.time[shown], ratio[shown]


def ground_trace(motion: GroundMotion) -> tuple[Reals, Reals]:
    """Times [s] and accelerations [g] of a ground motion, as many as can be seen."""
    motion = motion.kept
    shown = visible(motion.acceleration)
    return shown.astype(np.float64) * motion.dt, motion.acceleration[shown] / STANDARD_GRAVITY


def animation_page(film: Film, title: str, speed: float = 1.0) -> str:
    """A page of its own in which the structure moves: HTML with all that it needs, and no network.

    Parameters
    ----------
    film : Film
        What is shown.
    title : str
        Heading.
    speed : float
        Seconds of motion a second, to begin with.
    """
    model = film.history.model
    data = moving(
        film,
        [ratio_chart({model: film.history}), ground_chart(film.motion, [])],
        label=f"{title}, as it moves",
        speed=speed,
        moment=film.start,
    )
    data["about"] = f"{film.motion.name}, PGA {film.motion.pga:.3g} g; {model} model"
    parts = {
        "TITLE": html.escape(title), "STYLE": asset("motion.css"), "SCRIPT": asset("motion.js"), "DATA": as_script(data)
    }  # fmt: skip
    # All in one pass: a name in one part must not be taken for the place of another.
    return printable(re.sub("@(TITLE|STYLE|SCRIPT|DATA)@", lambda match: parts[match[1]], asset("animation.html")))
