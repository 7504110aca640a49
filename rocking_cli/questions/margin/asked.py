"""What `rocking margin` and `rk.margin` are asked."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.ask.asked import Idle
from rocking_cli.ask.groups import (
    Around,
    ByEngine,
    OfJoints,
    OfRestitution,
    OfStructure,
    Polarity,
    UnderMotions,
    WithTable,
    plot_file,
    polarity,
    table_file,
)


class MarginAsked(OfStructure, UnderMotions, OfRestitution, ByEngine, OfJoints, Around, WithTable):
    """Compute how close ground motions are to overturning a structure.

    A structure may overturn at one scale factor and survive a larger one, so there is no single critical factor. At
    each of 60 factors from 0.2 to 5, neighbouring motions with slightly different amplitude, slenderness and
    restitution are simulated, and the share of them that overturn is computed. The output gives the factors at which
    this share first reaches 10, 50 and 90 %, and those from which on it is never below them. If the outcome of some is
    unknown, because a joint opens or slides that the model keeps closed, the first row counts them as overturning and
    governs; a second row has those known to overturn. Of two polarities, the worse governs.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A motion that
    cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking margin block.yaml --record accel.csv --plot margin.png
      rocking margin frame.yaml --record "records/*.AT2" --polarity 1
      rocking margin --pulse sine:0.5g:0.8s --neighbours 1000
      rocking margin arch.yaml --record accel.csv --engine auto
    """

    polarity: Polarity = polarity("both")
    out: Path | None = table_file("Write the shares")
    plot: Path | None = plot_file("Plot the shares against the scale factor")
    idle = (
        Idle(
            "with free blocks",
            lambda asked: asked.engine == "blocks",
            ("restitution_deviation", "restitution", "opening"),
        ),
    )


class SharesAsked(OfStructure, UnderMotions, OfJoints, Around):
    """Compute the shares of the neighbours of a motion by their outcome; of both polarities, their mean."""
