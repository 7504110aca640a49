"""`rocking demand`: show the response spectra of a site by a code."""

from __future__ import annotations

import click

from rocking_cli.cli import complete, options
from rocking_cli.cli.groups import Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import FRACTION


@click.command(cls=Command, short_help="Show the response spectra of a site by a code.")
@click.argument("site", metavar="SITE.yaml", type=click.Path(), shell_complete=complete.files)
@click.option(
    "--damping", type=FRACTION, default="5%", show_default=True, metavar="SHARE", help=options.HELP["damping"]
)
@options.out(".csv", ".parquet", what="Write the spectra over all periods (.csv or .parquet).")
@options.plot("Plot the spectra of acceleration and displacement")
@options.as_json
@options.grouped(output=Output)
def command(site: str, damping: float, output: Output) -> None:
    """Show the elastic response spectra of a site by its code, at each limit state that the site file gives.

    The command prints the parameters of each spectrum, from the hazard to the soil, and ordinates of acceleration and
    displacement: of the ground and, if the site file has a floor, of the floor. For a site by its coordinates it also
    prints the nodes of the reference grid with their distances, and the hazard between them.

    \b
    Example:
      rocking new site > site.yaml
      rocking demand site.yaml --plot spectra.png
      rocking demand site.yaml --damping 8% --out spectra.csv
    """
    from rocking_cli.questions.demand.verb import demand

    output.keep_apart(site)
    output.show(demand(site, damping=damping))
