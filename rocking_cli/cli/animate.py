"""`rocking animate`: animate a structure under a ground motion."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import click

from rocking_cli.cli import motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions, Near
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import Finite
from rocking_cli.errors import INCOMPLETE, InputError, Problem, RockingError
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.structure import Structure
    from rocking_cli.studies.film import Film
    from rocking_cli.studies.neighbours import Neighbours
    from rocking_cli.studies.picture import Picture

# The names of the models stand here again so that `--help` needs no numpy.
MODELS = ("nonlinear", "linear1", "linear2")
LONGEST = 20.0  # s of a GIF whose speed is not given
MOST_FRAMES = 3000
FPS = 20.0


def _fps(ctx: click.Context, param: click.Parameter, value: float) -> float:
    if not 1 <= value <= 50:
        raise click.BadParameter(f"{value:g} is not between 1 and 50, the range of a GIF.", ctx, param)
    return value


def _speed(ctx: click.Context, param: click.Parameter, value: float | None) -> float | None:
    if value is not None and not 1e-3 <= value <= 1e3:
        raise click.BadParameter(f"{value:g} is not between 0.001 and 1000 s of motion per second.", ctx, param)
    return value


@dataclass(frozen=True)
class Pace:
    """Playback speed and number of frames per second."""

    speed: float | None
    fps: float


@click.command(cls=Command, short_help="Animate a structure under a ground motion (GIF or HTML).")
@click.argument("files", metavar="[FILE]", nargs=-1, type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1")
@click.option("--model", type=click.Choice(MODELS), default="nonlinear", show_default=True, help=options.HELP["model"])
@options.out(
    ".gif", ".html", required=True, metavar="FILE.html",
    what="Output file: an animated GIF (.gif), or a self-contained page with a slider (.html).",
)  # fmt: skip
@click.option(
    "--speed", type=Finite(positive=True), callback=_speed, metavar="TIMES",
    help="Playback speed: seconds of motion per second.  [default: 1; a GIF is sped up to last at most 20 s]",
)  # fmt: skip
@click.option(
    "--fps", type=Finite(positive=True), default=FPS, show_default=True, callback=_fps, metavar="FRAMES",
    help="Frames per second of a GIF.",
)  # fmt: skip
@options.around
@options.opening
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, pace=Pace, near=Near)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    asked: GroundMotions,
    model: str,
    out: Path,
    pace: Pace,
    near: Near,
    as_json: bool,
) -> None:
    """Animate a structure under a ground motion, with the traces of rotation and ground below it.

    A GIF is for slides and mails; it shows the time between uplift and rest or overturning. A page (.html) has a
    slider, works without a network, and shows the whole motion. The motion of the bodies is relative to the ground and
    drawn to scale, not enlarged. Both end where the outcome becomes unknown, as a joint opens or slides too far.

    With several motions, each is written to a file with its name in the file name, and the output has one row per
    motion (with --json, one object per line). A motion that cannot be used is reported and skipped, and the exit code
    is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking animate frame.yaml --record accel.csv --out frame.html
      rocking animate arch.yaml --pulse sine:0.5g:1.2s --out arch.gif --speed 0.5
    """
    _check(asked)
    paths, missing = motion_files.find(asked.records)
    several = len(paths) + missing + len(asked.pulses) > 1
    if not paths and not asked.pulses:
        ctx.exit(InputError.exit_code)
    from rocking_cli.cli import inputs
    from rocking_cli.cli.waiting import compile_first
    from rocking_cli.io.files import keep_apart
    from rocking_cli.studies.picture import picture
    from rocking_cli.views import animation as views

    read = [*files, *(str(each.path) for each in paths)]
    keep_apart([("--out", out)], read)
    structure = inputs.structure(files, asked.records)
    given, refused = inputs.gather(paths, asked, structure.growth, several=several)
    if not given:
        ctx.exit(InputError.exit_code)
    places = motion_files.separate(out, given, several=several)
    keep_apart([("--out", place) for place in places], read)
    compile_first()
    structure.model(cast("ModelName", model))  # what cannot be followed is refused before any motion
    camera = _Camera(structure, cast("ModelName", model), picture(structure.mechanism), pace, near)
    title, rows = heading(structure.mechanism), []
    for each, place in zip(given, places, strict=True):
        motion = each.motion.scaled(asked.signs[0] * each.factor)
        try:
            film, found, beside = camera.shoot(motion, title, place)
        except RockingError as error:
            if not several:
                raise
            terminal.error(f"{motion.name}: {error}")
            refused += 1
            continue
        rows.append(views.row(film, beside))
        if as_json or not several:
            terminal.show(views.view(structure, film, beside, {**found, "file": str(place)}), as_json=as_json)
    if several and rows and not as_json:
        terminal.show(views.several(structure, film, rows), as_json=False)
    if missing or refused:
        ctx.exit(INCOMPLETE)


def _check(asked: GroundMotions) -> None:
    if bool(asked.records) == bool(asked.pulses):
        raise click.UsageError("Give either --record FILE or --pulse PULSE.")
    asked.check()


@dataclass(frozen=True, eq=False)
class _Camera:
    """A structure in motion, and the settings of its animation."""

    structure: Structure
    model: ModelName
    picture: Picture
    pace: Pace
    near: Near

    def shoot(
        self, motion: GroundMotion, title: str, out: Path | None
    ) -> tuple[Film, dict[str, float | int | None], Neighbours | None]:
        """Simulate a motion, write its animation, and simulate its neighbours."""
        from rocking_cli.engines import engine_of
        from rocking_cli.studies.film import Film
        from rocking_cli.studies.neighbours import neighbours

        assert out is not None
        history = engine_of(self.structure).follow(self.structure, motion, model=self.model)
        film = Film(self.picture, history, motion)
        found = _write(out, film, title, self.pace.speed, self.pace.fps)
        model = self.structure.model(self.model)
        return film, found, neighbours(model, motion, self.near.around) if self.near.neighbours else None


def _write(out: Path, film: Film, title: str, speed: float | None, fps: float) -> dict[str, float | int | None]:
    """Write the page or the GIF; return the playback speed, and the number of frames of a GIF."""
    from rocking_cli.io.files import write_whole

    frames = None
    if out.suffix.lower() == ".html":
        from rocking_cli.plotting.animation import animation_page

        speed = speed or 1.0
        page = animation_page(film, title, speed)
        write_whole(out, lambda stream: stream.write(page.encode()))
    else:
        speed = speed or max(1.0, (film.end - film.start) / LONGEST)
        frames = _write_gif(out, film, f"{title}, under {film.motion.name}", speed, fps)
    terminal.note(f"wrote {out}")
    return {"speed": speed, "frames": frames}


def _write_gif(out: Path, film: Film, title: str, speed: float, fps: float) -> int:
    """Write the GIF, and return its number of frames."""
    import numpy as np

    from rocking_cli.io.files import write_whole
    from rocking_cli.plotting.animation import frame_time, write_gif

    step = speed * frame_time(fps)
    count = int((film.end - film.start) / step) + 1
    if count > MOST_FRAMES:
        problem = f"a GIF of {count:,} frames is too long (at most {MOST_FRAMES:,})"
        raise InputError(Problem(problem, field="--speed", hint="raise --speed, lower --fps, or write .html"))
    times = np.append(film.start + step * np.arange(count), film.end)
    if speed != 1:
        terminal.note(f"shown at {speed:.3g} times its speed, from {film.start:.4g} to {film.end:.4g} s")
    with terminal.progress(times.size, "frames") as advance:
        write_whole(out, lambda stream: write_gif(stream, film, title, times, fps, advance))
    return int(times.size)
