"""What `rocking calibrate` and `rk.calibrate` are asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.asked import AskedModel, option
from rocking_cli.ask.groups import plot_file
from rocking_cli.ask.kinds import FILE, output

if TYPE_CHECKING:
    from rocking_cli.ask.inputs import StructureLike
    from rocking_cli.questions.calibrate.study import Trace
else:  # heavy to import, and not checked by the model
    StructureLike = Trace = Any


class CalibrateAsked(AskedModel):
    """Find the coefficient of restitution of a structure from a trace of its free rocking.

    The whole trace is fitted at once: time and angle of the release, the restitution, and offset and drift of the
    instrument; the geometry is that of FILE. A restitution for each impact tells how much it scatters, which is what
    neighbours should draw. The trace may have lifting, holding and rest in it, any sampling, gaps and either sense. -o
    writes restitution and scatter, and with --free-geometry width and height, into a copy of FILE.

    What does not determine the restitution is refused with the reason: fewer than three impacts above the noise, a
    trace that is no free rocking of this structure.

    \b
    Example:
      rocking calibrate block.yaml --free trace.csv --plot fit.png
      rocking calibrate block.yaml --free trace.csv -o measured.yaml
    """

    structure: StructureLike = option("The structure, or its YAML file.", where="input", default=..., typed="FILE.yaml")
    free: str | Path | Trace = option(
        "Trace of a free-rocking test, a CSV file with the columns time [s] and angle [deg] or [rad]; - is standard "
        "input.",
        FILE._replace(metavar="TRACE.csv"), default=...,
    )  # fmt: skip
    free_geometry: bool = option(
        "Fit p and alpha to the trace too, of a free-standing block with alpha of 0.07 rad or more.", default=False
    )
    out: Path | None = option(
        "Write a copy of the structure's file with the fitted restitution and its scatter (`uncertainty`).",
        output(".yaml", ".yml"),
    )
    plot: Path | None = plot_file("Plot the trace with its fit and residuals")
