"""`rocking collapse`: the weakest mechanism of an assembly of blocks."""

from __future__ import annotations

from pathlib import Path

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="The weakest mechanism of an assembly of blocks, with hinges, thrust and friction.")
@click.argument("file", required=False, type=click.Path())
@options.plot("Draw the mechanism and a line of thrust to")
@options.as_json
def command(file: str | None, plot: Path | None, as_json: bool) -> None:
    """The weakest mechanism of an assembly of rigid blocks in either direction, by limit analysis.

    Joints bear no tension. It shows lambda, where it hinges, which blocks move as one and which rest, a line of thrust,
    the friction that it needs, and how far it can be displaced before another joint opens.

    \b
    Example:
      rocking new assembly > portal.yaml
      rocking collapse portal.yaml --plot portal.png
    """
    from rocking_cli.cli import structures
    from rocking_cli.io.files import check_writable, keep_apart
    from rocking_cli.studies.collapse import collapses
    from rocking_cli.views.collapse import view

    keep_apart([("--plot", plot)], [file])
    if plot is not None:
        check_writable(plot)
    mechanism = structures.load([file] if file else [])[0]
    found = collapses(mechanism)
    if plot is not None:
        from rocking_cli.cli.pictures import write_picture
        from rocking_cli.plotting.structure import draw_structure
        from rocking_cli.studies.picture import picture
        from rocking_cli.views.view import heading

        write_picture(plot, draw_structure(picture(mechanism), heading(mechanism), None))
    terminal.show(view(mechanism, found), as_json=as_json)
