"""`rocking crosscheck`: compare the exact engine with free blocks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import complete, options
from rocking_cli.cli.groups import GroundMotions, Output
from rocking_cli.cli.help import Command


@click.command(cls=Command, short_help="Compare the exact engine with free blocks.")
@options.structure
@options.ground_motions
@options.reading
@options.scaling("1", "-1")
@options.release
@options.opening
@options.out(".csv", ".parquet", what="Write both rotations against time (.csv or .parquet).")
@options.plot("Plot both rotations against time")
@click.option(
    "--animate",
    callback=options.output_path(".gif", ".mp4", ".html"),
    metavar="FILE.html",
    shell_complete=complete.files,
    help="Animate both side by side: .gif, .mp4 (requires ffmpeg), or .html, a self-contained page with a slider.",
)
@options.as_json
@options.grouped(asked=GroundMotions, output=Output)
def command(file: str | Path, asked: GroundMotions, output: Output, **question: Any) -> None:
    """Compare the exact engine with free blocks, for one structure and one ground motion.

    The exact engine is the mechanism with one degree of freedom, whose other joints are checked. Free blocks are the
    same bodies with contact and friction, simulated by MuJoCo (pip install 'rocking-cli[blocks]'). The output has the
    outcome and the peak of each, when their rotations part, the friction that each requires, and how far the joints
    open that the mechanism keeps closed. If the exact outcome is unknown, free blocks are the witness.

    Restitution has no effect on free blocks: it is what their contacts give. They overturn when a block falls by 0.15
    of the structure's height, or turns by 0.8 rad. The exit code is 0 whatever the comparison finds.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking crosscheck portal.yaml --record accel.csv --plot both.png
      rocking crosscheck arch.yaml --record accel.csv --scale 0.6 --animate both.html
      rocking crosscheck block.yaml --release 0.5
    """
    if asked.records and asked.pulses:
        raise click.UsageError("--record and --pulse cannot be combined: choose one.")
    if not asked and question["release"] is None:
        raise click.UsageError("No excitation given: add --record FILE, --pulse PULSE or --release TILT.")
    asked.check()
    from rocking_cli.questions.crosscheck.verb import crosscheck

    output.keep_apart(file, *asked.motions.records)
    question |= {"polarity": asked.polarity, "animate": output.animate, "watch": output.watch}
    output.show(crosscheck(file, asked.motions or None, **question))
