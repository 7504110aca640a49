"""`rocking collapse`: find the weakest mechanism of an assembly of blocks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from rocking_cli.cli import options
from rocking_cli.cli.groups import Output


@click.command(short_help="Find the weakest mechanism of an assembly of blocks.")
@options.structure
@options.out(
    ".yaml",
    ".yml",
    what="Write the mechanism as a structure file: a linkage of the blocks, for all other commands.",
    metavar="FILE.yaml",
)
@options.plot("Plot the mechanism and a line of thrust")
@options.as_json
@options.grouped(output=Output)
def command(file: str | Path, output: Output) -> None:
    """Find the weakest mechanism of an assembly of rigid blocks in each direction, by limit analysis.

    Joints carry no tension. The output gives lambda, the hinges, the blocks that move together and those at rest, a
    line of thrust, the friction required, and the rotation at which another joint would open.

    -o writes the mechanism as a linkage, whose hinges you can then change: the blocks are its bodies. A mechanism that
    slides, or has no rocking model for another reason, cannot be written.

    \b
    Example:
      rocking new assembly > portal.yaml
      rocking collapse portal.yaml --plot portal.png
      rocking collapse portal.yaml -o linkage.yaml
    """
    from rocking_cli.questions.collapse.verb import collapse

    output.keep_apart(file)
    answer = collapse(file, out=output.out, watch=output.watch)
    replace(output, out=None).show(answer)  # it is no table
    output.watch.end()
