"""Animation of structures under a ground motion, with time histories below: as frames, their files, and an HTML page.

What stands still in the frames is drawn once. Only the structures, their ground and the cursor are drawn again for each
frame, by matplotlib's renderer, which smooths them. Videos are made by ffmpeg, which must be installed: H.264 in the
form that slides and browsers play.
"""

from __future__ import annotations

import html
import pathlib
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import cache
from io import BytesIO
from itertools import chain
from math import ceil
from tempfile import TemporaryDirectory, TemporaryFile
from typing import Any, BinaryIO

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Affine2D, Bbox, IdentityTransform
from PIL import Image, ImageDraw, ImageFont

from rocking_cli.arrays import Points, Reals
from rocking_cli.errors import InputError, Problem, Refused
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.plotting import hung, style
from rocking_cli.plotting.moving import (
    MAX_SHOWN_RATIO,
    as_script,
    asset,
    ground_chart,
    moving,
    ratio_chart,
    ratio_charts,
)
from rocking_cli.plotting.panels import PANEL_GAP, Page, Panel, place_row
from rocking_cli.plotting.structure import colour, draw_scale, hatches, weight
from rocking_cli.studies.film import Film, Scene
from rocking_cli.text import one_line, printable
from rocking_cli.views.animation import fate, scale_in_words, verdict_of, why_it_ends

DOTS_PER_INCH = 100
SUPERSAMPLING = 2  # factor of enlargement while the parts at rest are drawn
MAX_STRUCTURE_HEIGHT, MAX_ROWS_HEIGHT = 3.4, 4.8  # inches of structures in one row, and of several rows together
NAME_HEIGHT = 0.5  # inches of the name of one of several structures and of its outcome, below its panel
LINE_HEIGHT, FOOT_HEIGHT, TRACE_HEIGHT, LEFT_MARGIN = 0.17, 0.42, 0.95, 0.82  # inches
BLENDS = (0.2, 0.4, 0.6, 0.8)  # shares of a colour over its background, for smooth edges
HINGE_RADIUS = 3.0  # pixels
NEARLY_WHITE = 0.97
ARROW_HEAD_LENGTH = 0.13  # inches
ARROW_HEAD = np.array([0, 1 + 0.45j, 1 - 0.45j])
IDENTITY = IdentityTransform()
LAST_FRAME_DURATION = 1.5  # s


def frame_time(fps: float) -> float:
    """Return the duration of a frame [s]: a multiple of 0.01 s, and at least 0.02 s, as many programs require."""
    return max(2, round(100 / fps)) / 100


def write_gif(stream: BinaryIO, drawn: Iterator[Image.Image], count: int, fps: float) -> None:
    """Write an animated GIF.

    Parameters
    ----------
    stream : binary file
        Stream to write to.
    drawn : iterator of Image
        The frames, see `frames`.
    count : int
        Their number.
    fps : float
        Frames a second; see `frame_time`.
    """
    palette = _palette()
    frames = (each.quantize(palette=palette, dither=Image.Dither.NONE) for each in drawn)
    first = next(frames)
    delay, last = round(1000 * frame_time(fps)), round(1000 * LAST_FRAME_DURATION)
    first.save(
        stream, format="GIF", save_all=True, append_images=frames, loop=0, optimize=True, disposal=1,
        duration=[delay] * (count - 1) + [last],
    )  # fmt: skip


def frames(scene: Scene, title: str, times: Reals, advance: Callable[[int], None]) -> Iterator[Image.Image]:
    """Yield the frames of an animation, in colours.

    Parameters
    ----------
    scene : Scene
        The motions to show.
    title : str
        Heading.
    times : ndarray, shape (frames,)
        Time of each frame [s].
    advance : callable
        Called with the number of frames done since the last call.
    """
    stage = _Stage(scene, title, float(times[0]), float(times[-1]))
    for time in times.tolist():
        yield stage.frame(time)
        advance(1)


@cache
def _palette() -> Image.Image:
    """Return the colours of a GIF: those of the style, and shades of them. Few colours make small files."""
    colours = {to_rgb(style.PAPER), to_rgb(style.INK)}
    drawn = (style.RESTING_COLOUR, style.EARTH, style.CURSOR, style.INK, style.FAINT, style.TIE["color"])
    for each in (*style.BODIES, *style.HUES, *drawn):
        colour, white, ink = (np.array(to_rgb(c)) for c in (each, style.PAPER, style.INK))
        for other in (white, ink):
            colours |= {tuple(colour + share * (other - colour)) for share in (0.0, *BLENDS)}
    # The nearest colour of the palette is found approximately: nearly white must not become white.
    colours = {each for each in colours if min(each) < NEARLY_WHITE or min(each) == 1}
    image = Image.new("P", (1, 1))
    image.putpalette([round(255 * part) for colour in sorted(colours) for part in colour])
    return image


class _Actor:
    """One of the structures of an animation, which moves with its ground in a panel of the frames."""

    def __init__(self, scene: Scene, film: Film) -> None:
        self.film = film
        self._scene, self._picture = scene, film.picture.grouped
        low, high = scene.box(film)
        side = 0.15 if len(scene.films) == 1 else 0.4  # a slender structure needs room for its name
        around = np.maximum((side, side, 0.16, 0.15), hung.margins(film.picture)).tolist()
        self.panel = Panel(low, high, tuple(around))

    def draw_still(self, page: Page, name: str, look: dict[str, Any]) -> None:
        """Draw the scale, the place of the structure where the ground has not moved, and the name if there is one."""
        axes, panel = self.panel.axes(page), self.panel
        low, high = self._picture.extent
        axes.axvline((low + high).real / 2, color=style.FAINT, linewidth=style.THIN, linestyle=(0, (1, 4)))
        draw_scale(axes, panel)
        if name:
            where = page.add_axes(panel.corner - 0.35j, complex(0.3, 0.14))
            where.plot([0, 1], [0, 0], **look)
            where.set_axis_off()
            short = style.fitted(name, panel.inches.real - 0.4, style.TICK)
            page.text(
                panel.corner + 0.36 - 0.28j, short, va="center", fontsize=style.TICK, color=style.INK, parse_math=False
            )

    def draw(self, renderer: Any, time: float) -> list[tuple[str, complex]]:
        """Draw ground, parts and hinges; return the letters of the hinges and their positions [pixels]."""
        panel, picture = self.panel, self._picture
        places, ways = self._scene.seen(self.film, np.array([time]))
        pen = _Pen(renderer, panel, float(ways[0]))
        drawn, rotation = float(places[0]), float(self.film.rotation(np.array([time]))[0])
        for line in (*picture.ground, *picture.walls):
            pen.line(line, style.EARTH, style.BOLD)
            pen.strokes(hatches(line, panel), style.EARTH, style.THIN)
        outlines, pins = picture.placed(drawn)
        direction = picture.side(rotation)
        shown = hung.symbols(picture, drawn / self._scene.enlargement, panel.scale, self._scene.enlargement)
        self._draw_ties(pen, shown, behind=True)
        thick = weight(picture, panel.scale)
        edge = style.INK if time <= self.film.stops else style.FAINT
        for k, polygons in enumerate(outlines):
            for each in polygons:
                pen.fill(each, colour(picture, k, direction), edge, thick)
        self._draw_ties(pen, shown, behind=False)
        for outline in shown.weights:
            pen.fill(outline, style.INK, style.PAPER, style.THIN)
        for tail, tip in shown.forces:
            head = tip + (tail - tip) / abs(tail - tip) * ARROW_HEAD_LENGTH / panel.scale * ARROW_HEAD
            pen.line(np.array([tail, head.mean()]), style.CURSOR, style.BOLD)
            pen.fill(head, style.CURSOR, style.CURSOR, style.BOLD)
        seen = [] if rotation == 0 else [k for k, pin in enumerate(picture.pins) if pin.direction is direction]
        for pin in pins[seen].tolist():
            pen.ring(pin)
        return [(picture.pins[k].letter, pen.pixel(complex(pins[k]))) for k in seen]

    @staticmethod
    def _draw_ties(pen: _Pen, shown: hung.Symbols, *, behind: bool) -> None:
        """Draw ties and their anchorages: those that the structure may cover, or the others."""
        for line, loose, of_bed in shown.lines:
            if of_bed is behind:
                pen.line(line, style.TIE["color"], style.TIE["linewidth"], (3.5, 2.5) if loose else ())
        for at, of_bed in shown.anchors:
            if of_bed is behind:
                square = at + hung.ANCHOR_HALF_WIDTH / pen.panel.scale * hung.SQUARE
                pen.fill(square, style.EARTH, style.INK, style.THIN)


class _Pen:
    """Draws points of the plane [m] into a panel of a frame, moved to the right by a distance [m]."""

    def __init__(self, renderer: Any, panel: Panel, shift: float) -> None:
        self.panel = panel
        left, _, below, _ = panel.around
        self._origin = panel.low - complex(left, below) / panel.scale - panel.corner / panel.scale - shift
        self._renderer, self._scale = renderer, panel.scale * DOTS_PER_INCH
        corner, size = panel.corner * DOTS_PER_INCH, panel.inches * DOTS_PER_INCH
        self._clip = Bbox.from_bounds(corner.real, corner.imag, size.real, size.imag)

    def pixel(self, z: complex) -> complex:
        """Return a point in pixels from the lower left corner."""
        return (z - self._origin) * self._scale

    def line(self, z: Points, colour: str, points: float, dashes: Sequence[float] = ()) -> None:
        """Draw a line of a weight [pt]."""
        self._path(Path(self._pixels(z)), colour, points, dashes=dashes)

    def strokes(self, z: Points, colour: str, points: float) -> None:
        """Draw many straight lines, from their starts and ends, shape (n, 2)."""
        codes = np.tile([Path.MOVETO, Path.LINETO], len(z))
        self._path(Path(self._pixels(z.ravel()), codes), colour, points)

    def fill(self, z: Points, inside: str, edge: str, points: float) -> None:
        """Draw a polygon."""
        self._path(Path(self._pixels(np.append(z, z[0])), closed=True), edge, points, fill=to_rgb(inside))

    def ring(self, z: complex) -> None:
        """Draw the mark of a hinge."""
        at = self.pixel(z)
        place = Affine2D().scale(HINGE_RADIUS).translate(at.real, at.imag)
        self._path(Path.unit_circle(), style.INK, style.MEDIUM, place, to_rgb(style.PAPER))

    def _path(
        self,
        path: Path,
        colour: str,
        points: float,
        place: Affine2D | IdentityTransform = IDENTITY,
        fill: tuple[float, float, float] | None = None,
        dashes: Sequence[float] = (),
    ) -> None:
        context = self._renderer.new_gc()
        context.set_foreground(colour)
        context.set_linewidth(self._renderer.points_to_pixels(points))
        context.set_joinstyle("round")
        context.set_snap(False)  # drawings move by fractions of a pixel
        context.set_clip_rectangle(self._clip)
        if dashes:
            context.set_dashes(0, [self._renderer.points_to_pixels(each) for each in dashes])
        self._renderer.draw_path(context, path, place, fill)
        context.restore()

    def _pixels(self, z: Points) -> Reals:
        away = (z - self._origin) * self._scale
        return np.stack([away.real, away.imag], axis=-1)


class _Stage:
    """The still background of an animation, and the actors that move before it."""

    def __init__(self, scene: Scene, title: str, start: float, end: float) -> None:
        self._scene, self._times = scene, (start, end)
        self._actors = [_Actor(scene, film) for film in scene.films]
        width, several = style.page_width(), len(scene.films) > 1
        below = 2 * TRACE_HEIGHT + 3 * PANEL_GAP + FOOT_HEIGHT + (0.1 if several else 0.3)
        top = _arranged([each.panel for each in self._actors], below, NAME_HEIGHT if several else 0.0)
        words = style.folded(scale_in_words(scene), width - 2 * PANEL_GAP, style.LABEL)
        # The title, the words on the scale, the readings, and how the motion of the only structure ends.
        rows = [0.1, 0.1 + 1.4 * LINE_HEIGHT, 0.16 + LINE_HEIGHT * (2.4 + words.count("\n"))]
        tall = ceil((top + rows[2] + LINE_HEIGHT * (1.5 if several else 2.2)) * DOTS_PER_INCH) / DOTS_PER_INCH
        self._row = round(rows[2] * DOTS_PER_INCH)
        figure = Figure(figsize=(width, tall), dpi=DOTS_PER_INCH * SUPERSAMPLING)
        page = Page(figure, complex(width, tall))
        for text, row_at, size in ((style.fitted(title), rows[0], style.TITLE), (words, rows[1], style.LABEL)):
            page.text(
                complex(PANEL_GAP, tall - row_at), text, va="top", fontsize=size, color=style.INK, parse_math=False
            )
        looks = [style.family(k) if several else style.TRACE for k in range(len(self._actors))]
        for actor, look in zip(self._actors, looks, strict=True):
            actor.draw_still(page, actor.film.name if several else "", look)
        across = complex(width - LEFT_MARGIN - PANEL_GAP, TRACE_HEIGHT)
        lower = page.add_axes(complex(LEFT_MARGIN, FOOT_HEIGHT), across)
        upper = page.add_axes(complex(LEFT_MARGIN, FOOT_HEIGHT + TRACE_HEIGHT + PANEL_GAP), across)
        _draw_traces(upper, lower, scene, start, end, looks)
        drawn = BytesIO()
        style.save(figure, drawn, format="png", dpi=DOTS_PER_INCH * SUPERSAMPLING)
        self._still = np.asarray(Image.open(drawn).convert("RGB").reduce(SUPERSAMPLING))
        tall_px, wide_px, _ = self._still.shape
        self._renderer: Any = RendererAgg(wide_px, tall_px, DOTS_PER_INCH)  # type: ignore[no-untyped-call]
        self._strip = [
            (
                *(axes.transData.transform((t, 0.0))[0] / SUPERSAMPLING for t in (start, end)),
                axes.bbox.y0 / SUPERSAMPLING,
                axes.bbox.y1 / SUPERSAMPLING,
            )
            for axes in (upper, lower)
        ]

    def frame(self, time: float) -> Image.Image:
        """Return one frame, in colours."""
        pixels = np.asarray(self._renderer.buffer_rgba())
        pixels[..., :3] = self._still
        pixels[..., 3] = 255
        letters = [each for actor in self._actors for each in actor.draw(self._renderer, time)]
        frame = Image.fromarray(pixels[..., :3])
        pen = ImageDraw.Draw(frame)
        for letter, place in letters:
            pen.text(
                (place.real + 5, frame.height - place.imag - 5), letter, fill=style.INK, font=_font(12, bold=True),
                anchor="lb", stroke_width=2, stroke_fill=style.PAPER,
            )  # fmt: skip
        start, end = self._times
        share = (time - start) / (end - start) if end > start else 0.0
        for x0, x1, y0, y1 in self._strip:
            x = round(x0 + share * (x1 - x0))
            pen.line([(x, frame.height - y1), (x, frame.height - y0)], fill=style.CURSOR, width=2)
        clock, left = f"t = {time:6.2f} s", round(PANEL_GAP * DOTS_PER_INCH)
        ended = [time >= min(actor.film.stops, end) for actor in self._actors]
        if len(self._actors) == 1:
            film = self._actors[0].film
            pen.text((left, self._row), f"{clock}    {_reading(film, time)}", fill=style.INK, font=_font(13))
            if ended[0]:
                under = (left, self._row + round(LINE_HEIGHT * DOTS_PER_INCH))
                pen.text(under, why_it_ends(film) or fate(film), fill=style.CURSOR, font=_font(13, bold=True))
            return frame
        pen.text((left, self._row), clock, fill=style.INK, font=_font(13))
        for actor, is_over in zip(self._actors, ended, strict=True):
            if is_over:
                below = actor.panel.corner * DOTS_PER_INCH - 37j
                under = (round(below.real), round(frame.height - below.imag))
                pen.text(under, fate(actor.film), fill=style.CURSOR, font=_font(12, bold=True))
        return frame


def _reading(film: Film, time: float) -> str:
    """Return the rotation at a time over the critical one (or the limit), as text."""
    at_limit = film.history.ends_at_limit
    digits = 5 if any(at_limit) or film.enlargement > 1 else 2  # small rotations
    ratio = float(film.ratio(film.rotation(np.array([time])))[0])
    return f"{style.over(at_limit)} = {round(ratio, digits) + 0.0:+.{digits}f}"


def _arranged(panels: Sequence[Panel], base: float, foot: float) -> float:
    """Place panels in rows at the largest scale that fits all, each with a foot; return the top of the uppermost row.

    Lengths are in inches.
    """

    def largest(lines: list[Sequence[Panel]]) -> float:
        room = MAX_STRUCTURE_HEIGHT if len(lines) == 1 else MAX_ROWS_HEIGHT / len(lines)
        return min(
            min(
                (style.page_width() - PANEL_GAP * (len(line) + 1) - sum(each.room.real for each in line))
                / sum(each.plane.real for each in line),
                *((room - each.room.imag) / each.plane.imag for each in line),
            )
            for line in lines
        )

    ways = [[panels[k : k + most] for k in range(0, len(panels), most)] for most in range(len(panels), 0, -1)]
    best = max(ways, key=largest)
    scale = largest(best)
    for line in reversed(best):
        base = place_row(line, scale, base + foot)
    return base


@cache
def _font(size: int, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(f"{matplotlib.get_data_path()}/fonts/ttf/{name}", size)


def _draw_traces(
    upper: Axes, lower: Axes, scene: Scene, start: float, end: float, looks: Sequence[dict[str, Any]]
) -> None:
    reach = 0.0
    for film, look in zip(scene.films, looks, strict=True):
        ratio = film.history.ratio[np.isfinite(film.history.ratio)]
        shown = style.visible(ratio)
        upper.plot(film.history.time[shown], ratio[shown], **look)
        reach = max(reach, float(np.abs(ratio).max()))
    motion = scene.films[0].motion.kept
    ground = motion.acceleration / STANDARD_GRAVITY
    style.draw_samples(lower, ground, motion.dt, **style.TRACE)
    at_limit = [each for film in scene.films for each in film.history.ends_at_limit]
    for axes, most, label in (
        (upper, min(reach, MAX_SHOWN_RATIO), style.over(at_limit, math=True)),
        (lower, float(np.abs(ground).max()), "ground [g]"),
    ):
        axes.set_xlim(start, max(end, start + 1e-3))
        tall = 1.1 * max(most, 1e-3)
        axes.set_ylim(-tall, tall)
        axes.yaxis.set_label_coords(-(LEFT_MARGIN - 0.3) / (style.page_width() - LEFT_MARGIN - PANEL_GAP), 0.5)
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
        style.tidy(axes, y=label)
    for level in (-1.0, 1.0):
        upper.axhline(level, color=style.FAINT, linewidth=style.THIN, linestyle=":")
    upper.tick_params(labelbottom=False)
    lower.set_xlabel("time [s]", fontsize=style.LABEL)


def animation_page(films: Film | Sequence[Film], title: str, speed: float = 1.0) -> str:
    """Return an HTML page in which structures move; it needs no other file and no network.

    Parameters
    ----------
    films : Film, or a sequence of them
        The motions to show, under one ground motion.
    title : str
        Heading.
    speed : float
        Initial speed: seconds of motion per second.
    """
    first, *others = [films] if isinstance(films, Film) else films
    model, motion = first.history.model, first.motion
    models = dict.fromkeys(each.history.model for each in (first, *others))
    ratios = ratio_charts([first, *others]) if others else ratio_chart({model: first.history})
    start = Scene((first, *others)).start
    label = "as it moves" if others else f"{title}, as it moves"
    data = moving(first, [ratios, ground_chart(motion, [])], label=label, speed=speed, moment=start, beside=others)
    of = f"PGA of the ground {motion.of_ground.pga_g:.3g} g, of the floor" if motion.ground is not None else "PGA"
    about = f"{motion.name}, {of} {motion.pga_g:.3g} g; {' and '.join(models)} model{'s' * (len(models) > 1)}"
    verdicts = [f"{each.name}: {verdict_of(each)}" if others else verdict_of(each) for each in (first, *others)]
    parts = {
        "TITLE": html.escape(title),
        "ABOUT": html.escape(about),
        "VERDICTS": "\n".join(f"<p>{html.escape(each)}</p>" for each in verdicts),
        "STYLE": asset("motion.css"),
        "SCRIPT": asset("motion.js"),
        "DATA": as_script(data),
    }
    # One pass for all parts: a name in one part must not be replaced as a placeholder of another.
    return printable(re.sub(f"@({'|'.join(parts)})@", lambda match: parts[match[1]], asset("animation.html")))


# The sides must be even. Whatever plays the file can start before all of it is there.
OUTPUT = ("-c:v", "h264", "-pix_fmt", "yuv420p", "-movflags", "+faststart")
MAX_MESSAGE = 300  # characters


def ffmpeg(file: pathlib.Path) -> str:
    """Return the path of ffmpeg. Raises `InputError`, which names the file to write, if it is not installed."""
    program = shutil.which("ffmpeg")
    if program is None:
        hint = "install it from ffmpeg.org or by your package manager, or give a name that ends in .gif or .html"
        raise InputError(Problem("an MP4 video requires the program ffmpeg, which is not found", str(file), hint=hint))
    return program


def write_mp4(stream: BinaryIO, program: str, drawn: Iterator[Image.Image], fps: float) -> None:
    """Write a video.

    Parameters
    ----------
    stream : binary file
        Stream to write to.
    program : str
        Path of ffmpeg.
    drawn : iterator of Image
        The frames, all of one size.
    fps : float
        Frames per second.

    Raises
    ------
    Refused
        If ffmpeg fails or is ended.
    """
    first = next(drawn)
    pad = f"pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,tpad=stop_mode=clone:stop_duration={LAST_FRAME_DURATION}"
    # An MP4 is not written in one pass, so it cannot come through a pipe.
    with TemporaryDirectory() as folder, TemporaryFile() as messages:
        made = pathlib.Path(folder) / "video.mp4"
        size = f"{first.width}x{first.height}"
        given = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", size, "-framerate", f"{fps:g}", "-i", "pipe:0"]
        command = [program, "-nostdin", "-loglevel", "error", *given, "-vf", pad, *OUTPUT, str(made)]
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=messages)
        assert process.stdin is not None
        try:
            for each in chain([first], drawn):
                try:
                    process.stdin.write(each.tobytes())
                except OSError:  # ffmpeg no longer reads: its exit code and its messages tell why
                    break
            with suppress(OSError):
                process.stdin.close()
            code = process.wait()
        finally:
            process.kill()
            process.wait()
        if code != 0 or not made.exists():
            messages.seek(0)
            why = one_line(messages.read().decode(errors="replace").strip())[-MAX_MESSAGE:]
            raise Refused(f"ffmpeg did not write the video (exit code {code}){f': {why}' if why else ''}")
        with made.open("rb") as video:
            shutil.copyfileobj(video, stream)
