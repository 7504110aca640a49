"""What `rocking crosscheck` and `rk.crosscheck` are asked."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.ask.asked import Idle, option
from rocking_cli.ask.groups import Excited, MaybeUnderMotion, OfJoints, OfStructure, WithTable, plot_file, table_file
from rocking_cli.ask.kinds import output


class CrosscheckAsked(OfStructure, MaybeUnderMotion, Excited, OfJoints, WithTable):
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

    idle = (Idle("without a ground motion", lambda asked: not asked.ground_motions, ("polarity", "animate")),)
    out: Path | None = table_file("Write both rotations against time (.csv or .parquet).", ".csv", ".parquet")
    plot: Path | None = plot_file("Plot both rotations against time")
    animate: Path | None = option(
        "Animate both side by side: .gif, .mp4 (requires ffmpeg), or .html, a self-contained page with a slider.",
        output(".html", ".gif", ".mp4"),
    )
