"""What `rocking animate` and `rk.animate` are asked."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.ask.asked import Idle, option
from rocking_cli.ask.groups import (
    DEVIATIONS,
    Around,
    ModelName,
    OfJoints,
    OfStructures,
    OnePolarity,
    UnderMotions,
    neighbours,
    polarity,
)
from rocking_cli.ask.kinds import POSITIVE, output


class AnimateAsked(OfStructures, UnderMotions, OfJoints, Around):
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

    idle = (
        Idle("on a linear block, which has no joints", lambda asked: asked.model != "nonlinear", ("opening",)),
        Idle("on a page, which is drawn as fast as it is shown", lambda asked: asked.out.suffix.lower() == ".html",
             ("fps",)),
        Idle("without neighbours", lambda asked: not asked.neighbours, DEVIATIONS),
    )  # fmt: skip
    out: Path = option(
        "Output file: an animated GIF (.gif), a video (.mp4, requires ffmpeg), or a self-contained page with a slider "
        "(.html). Of several motions each has its own, with its name in the file name.",
        output(".html", ".gif", ".mp4"), default=...,
    )  # fmt: skip
    model: ModelName = option(
        "Model: nonlinear (the mechanism itself), or its equivalent block (linear1, linear2).", default="nonlinear"
    )
    speed: float | None = option(
        "Playback speed: seconds of motion per second.", POSITIVE, ge=1e-3, le=1e3,
        usual="1; a GIF is sped up to last at most 20 s",
    )  # fmt: skip
    fps: float = option("Frames per second of a GIF or a video.", POSITIVE, ge=1, le=50, default=20.0)
    polarity: OnePolarity = polarity(allowed="1 -1")
    neighbours: int = neighbours(default=200)
