"""`rocking animate`: animate structures under a ground motion."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.defaults import as_declared
from rocking_cli.cli.groups import NEIGHBOUR_OPTIONS, GroundMotions
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import POSITIVE


@click.command(cls=Command, short_help="Animate structures under a ground motion (GIF, MP4 or HTML).")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@options.ground_motions
@options.reading
@options.scaling("1", "-1")
@options.model
@options.out(
    ".gif", ".mp4", ".html", required=True, metavar="FILE.html",
    what="Output file: an animated GIF (.gif), a video (.mp4, requires ffmpeg), or a self-contained page with a slider "
    "(.html).",
)  # fmt: skip
@click.option(
    "--speed", type=POSITIVE, metavar="TIMES",
    help="Playback speed: seconds of motion per second.  [default: 1; a GIF is sped up to last at most 20 s]",
)  # fmt: skip
@click.option(
    "--fps", type=POSITIVE, default=20.0, show_default=True, metavar="FRAMES",
    help="Frames per second of a GIF or a video.",
)  # fmt: skip
@options.around()
@options.opening
@options.as_json
@options.grouped(asked=GroundMotions)
def command(files: tuple[str, ...], asked: GroundMotions, out: Path, as_json: bool, **question: Any) -> None:
    """Animate structures under a ground motion, with the traces of rotation and ground below them.

    A GIF is for slides and mails, a video for slides; a page has a slider and works without a network. They show the
    time between uplift and rest or overturning, and end where the outcome becomes unknown, as a joint opens or slides
    too far. The ground moves too. If no rotation reaches 2 degrees, displacements are enlarged by a round factor, which
    is stated; numbers are never enlarged.

    Several FILEs are shown side by side, at one scale and on one clock, and the output has one row per structure.

    With several motions, each is written to a file with its name in the file name, and the output has one row per
    motion (with --json, one object per line). A motion that cannot be used is reported and skipped, and the exit code
    is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking animate frame.yaml --record accel.csv --out frame.html
      rocking animate arch.yaml --pulse sine:0.5g:1.2s --out arch.gif --speed 0.5
      rocking animate existing.yaml strengthened.yaml --record accel.csv --out both.mp4
    """
    if bool(asked.records) == bool(asked.pulses):
        raise click.UsageError("Give either --record FILE or --pulse PULSE.")
    asked.check()
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.io.files import keep_apart
    from rocking_cli.questions.animate.verb import animate

    if out.suffix.lower() == ".html":
        as_declared(question, "fps")
    if not question["neighbours"]:
        as_declared(question, *NEIGHBOUR_OPTIONS[1:])
    motions, watch = asked.motions, OnTerminal(as_json=as_json)
    keep_apart([("--out", out)], [*files, *(str(each.path) for each in motions.records)])
    if len(files) > 1:
        asked.check_strays(files)
    structure = files if len(files) > 1 else asked.structure(files)
    answer = animate(structure, motions, out, polarity=asked.polarity, watch=watch, **question)
    if not as_json or (motions.count == 1 and len(files) < 2):
        terminal.show(answer.view, as_json=as_json)
    watch.end()
