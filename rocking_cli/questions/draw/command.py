"""`rocking draw`: draw a structure at rest and displaced."""

from __future__ import annotations

from pathlib import Path

import click

from rocking_cli.cli import complete, options
from rocking_cli.cli.groups import Output
from rocking_cli.cli.quantities import NUMBER


@click.command(short_help="Draw a structure at rest and displaced, with dimensions.")
@options.structure
@click.option(
    "--at", type=NUMBER, metavar="RATIO",
    help="Rotation to draw, as a multiple of phi_cr, or of the kinematic limit if there is no phi_cr.  "
    "[default: 1, 0.1]",
)  # fmt: skip
@options.plot("Output file", "[default: FILE with .png, in this folder; none with --json or --dxf]")
@click.option(
    "--dxf", callback=options.output_path(".dxf"), metavar="FILE.dxf", shell_complete=complete.files,
    help="Write the drawing as DXF, in metres, from which `rocking import` makes the structure again.",
)  # fmt: skip
@options.as_json
@options.grouped(output=Output)
def command(file: str | Path, at: float | None, dxf: Path | None, output: Output) -> None:
    """Draw a structure at rest with its dimensions, and displaced in both directions, to scale.

    Check the drawing before you trust a number: is this the intended mechanism, and were the dimensions read correctly?
    It shows the bodies, the hinges with the letters of the paper, the centroids, and alpha or the angles of the
    linkage; for an arch, the voussoirs and the lines of thrust at uplift; the loads and the ties (dashed if slack) with
    their heights, and the walls behind a structure that rocks in one direction only.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking draw frame.yaml
      rocking draw arch.yaml --at 0.5 --plot arch.svg
      rocking draw wall.yaml --dxf wall.dxf
    """
    from rocking_cli.io.files import check_writable
    from rocking_cli.questions.draw.verb import draw

    if output.plot is None and dxf is None and not output.as_json:
        output = Output(as_json=False, plot=(plot := Path(f"{options.stem(file)}.png")))
        check_writable(plot)
    output.keep_apart(file)
    output.show(draw(file, at=at, dxf=dxf, watch=output.watch))
