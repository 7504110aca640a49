"""`rocking collapse`: find the weakest mechanism of an assembly of blocks."""

from __future__ import annotations

from pathlib import Path

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="Find the weakest mechanism of an assembly of blocks.")
@click.argument("file", required=False, type=click.Path())
@options.plot("Plot the mechanism and a line of thrust")
@options.as_json
def command(file: str | None, plot: Path | None, as_json: bool) -> None:
    """Find the weakest mechanism of an assembly of rigid blocks in each direction, by limit analysis.

    Joints carry no tension. The output gives lambda, the hinges, the blocks that move together and those at rest, a
    line of thrust, the friction required, and the rotation at which another joint would open.

    \b
    Example:
      rocking new assembly > portal.yaml
      rocking collapse portal.yaml --plot portal.png
    """
    from rocking_cli.ask.collapse import collapse
    from rocking_cli.cli import structures, waiting
    from rocking_cli.cli.written import write_picture
    from rocking_cli.io.files import check_writable, keep_apart

    keep_apart([("--plot", plot)], [file])
    if plot is not None:
        check_writable(plot)
    with waiting.blocks(file):
        answer = collapse(structures.load([file] if file else [])[0])
    if plot is not None:
        write_picture(plot, answer.figure())
    terminal.show(answer.view, as_json=as_json)
