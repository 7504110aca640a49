"""`rocking margin`: compute how close ground motions are to overturning a structure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import options
from rocking_cli.cli.groups import GroundMotions, Output
from rocking_cli.cli.help import Command


@click.command(cls=Command, short_help="Compute how close ground motions are to overturning.")
@options.structure
@options.ground_motions
@options.reading
@options.scaling("1", "-1", "both", default="both")
@options.around()
@options.opening
@options.engine
@options.plot("Plot the shares against the scale factor")
@options.as_json
@options.grouped(asked=GroundMotions, output=Output)
def command(file: str | Path, asked: GroundMotions, output: Output, **around: Any) -> None:
    """Compute how close ground motions are to overturning a structure.

    A structure may overturn at one scale factor and survive a larger one, so there is no single critical factor. At
    each of 60 factors from 0.2 to 5, neighbouring motions with slightly different amplitude, slenderness and
    restitution are simulated, and the share of them that overturn is computed. The output gives the factors at which
    this share first reaches 10, 50 and 90 %, and those from which on it is never below them. If the outcome of some is
    unknown, because a joint opens or slides that the model keeps closed, the first row counts them as overturning and
    governs; a second row has those known to overturn. With --polarity both, the worse of the two polarities governs.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A motion that
    cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking margin block.yaml --record accel.csv --plot margin.png
      rocking margin frame.yaml --record "records/*.AT2" --polarity 1
      rocking margin --pulse sine:0.5g:0.8s --neighbours 1000
      rocking margin arch.yaml --record accel.csv --engine auto
    """
    if not asked:
        raise click.UsageError("No ground motion given: add --record PLACE or --pulse PULSE, each repeatable.")
    asked.check()
    options.few_neighbours(around, None)
    from rocking_cli.questions.margin.verb import margin

    output.keep_apart(file, *asked.motions.records)
    output.show(margin(file, asked.motions, polarity=asked.polarity, watch=output.watch, **around))
