"""What `rocking demand` and `rk.demand` are asked."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import SiteLike, WithTable, plot_file, table_file
from rocking_cli.ask.kinds import BELOW_ONE, SITE


class DemandAsked(WithTable):
    """Compute the elastic response spectra of a site by its code, at each limit state that the site file gives.

    The output has the parameters of each spectrum, from the hazard to the soil, and ordinates of acceleration and
    displacement: of the ground and, if the site file has a floor, of the floor. For a site by its coordinates it also
    has the nodes of the reference grid with their distances, and the hazard between them.

    \b
    Example:
      rocking new site > site.yaml
      rocking demand site.yaml --plot spectra.png
      rocking demand site.yaml --damping 8% --out spectra.csv
    """

    site: SiteLike = option("Fields of a site file, or the file.", SITE, where="input", default=...)
    damping: float = option("Damping ratio of the spectrum.", BELOW_ONE, default=0.05)
    out: Path | None = table_file("Write the spectra over all periods", ".parquet")
    plot: Path | None = plot_file("Plot the spectra of acceleration and displacement")
