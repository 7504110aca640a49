"""What `rocking collapse` and `rk.collapse` are asked."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import OfStructure, plot_file
from rocking_cli.ask.kinds import output


class CollapseAsked(OfStructure):
    """Find the weakest mechanism of an assembly of rigid blocks in each direction, by limit analysis.

    Joints carry no tension. The output gives lambda, the hinges, the blocks that move together and those at rest, a
    line of thrust, the friction required, and the rotation at which another joint would open.

    The mechanism can be written as a linkage, whose hinges you can then change: the blocks are its bodies. A mechanism
    that slides, or has no rocking model for another reason, cannot be written.

    \b
    Example:
      rocking new assembly > portal.yaml
      rocking collapse portal.yaml --plot portal.png
      rocking collapse portal.yaml -o linkage.yaml
    """

    out: Path | None = option(
        "Write the mechanism as a structure file: a linkage of the blocks, for all other questions.",
        output(".yaml", ".yml"),
    )
    plot: Path | None = plot_file("Plot the mechanism and a line of thrust")
