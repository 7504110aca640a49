"""What `rocking calibrate` and `rk.calibrate` are asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from pydantic import model_validator

from rocking_cli.ask.asked import Idle, option
from rocking_cli.ask.groups import ReadsRecords, plot_file
from rocking_cli.ask.kinds import FILE, WHOLE, output, quantity, span
from rocking_cli.errors import InputError, named

if TYPE_CHECKING:
    from rocking_cli.ask.inputs import StructureLike
    from rocking_cli.questions.calibrate.trace import Trace
    from rocking_cli.questions.score.table import TableOfTests
else:  # heavy to import, and not checked by the model
    StructureLike = Trace = TableOfTests = Any

FACTORS = span(quantity("factor", "", "LOW:HIGH", "0.8", 1e-3, 1e3), "0.8:1.2", "LOW:HIGH")
RESTITUTIONS = span(quantity("restitution", "", "LOW:HIGH", "0.8", 1e-3, 1.0), "0.8:0.99", "LOW:HIGH")


class CalibrateAsked(ReadsRecords):
    """Find the coefficient of restitution of a structure from what was measured on it.

    With --free, the trace of a free-rocking test is fitted at once: time and angle of the release, the restitution, and
    offset and drift of the instrument; the geometry is that of FILE. A restitution for each impact tells how much it
    scatters, which is what neighbours should draw. The trace may have lifting, holding and rest in it, any sampling,
    gaps and either sense. -o writes restitution and scatter, and with --free-geometry width and height, into a copy of
    FILE.

    With --tests, the outcomes of shake-table tests give the likelihood over slenderness and restitution. Outcomes alone
    leave a ridge of pairs that explain them about as well: the region is shown, and nothing is written.

    What does not determine the restitution is refused with the reason: fewer than three impacts above the noise, a
    trace that is no free rocking of this structure, a best point on the edge of the grid.

    \b
    Example:
      rocking calibrate block.yaml --free trace.csv --plot fit.png
      rocking calibrate block.yaml --free trace.csv -o measured.yaml
      rocking calibrate block.yaml --tests tests.csv --points 13
    """

    structure: StructureLike = option("The structure, or its YAML file.", where="input", default=..., typed="FILE.yaml")
    free: str | Path | Trace | None = option(
        "Trace of a free-rocking test, a CSV file with the columns time [s] and angle [deg] or [rad]; - is standard "
        "input.",
        FILE._replace(metavar="TRACE.csv"),
    )
    tests: str | Path | Mapping[str, Sequence[Any]] | TableOfTests | None = option(
        "Table of shake-table tests, as for `rocking score`; those of the structure are used.",
        FILE._replace(metavar="TESTS.csv"),
    )
    free_geometry: bool = option(
        "Fit p and alpha to the trace too, of a free-standing block with alpha of 0.07 rad or more.", default=False
    )
    slenderness: tuple[float, float] = option(
        "Range of the factor on the slenderness, for tests.", FACTORS, default=(0.7, 1.3), usual="0.7:1.3"
    )
    restitution: tuple[float, float] = option(
        "Range of the restitution, for tests.", RESTITUTIONS, default=(0.7, 0.99), usual="0.7:0.99"
    )
    points: int = option("Number of values along each axis of the grid, for tests.", WHOLE, default=9, ge=3, le=101)
    neighbours: int = option(
        "Number of neighbours of each test at each point of the grid.", WHOLE, default=40, ge=1, le=100_000
    )
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, usual="one for each processor")
    out: Path | None = option(
        "Write a copy of the structure's file with the fitted restitution and its scatter (`uncertainty`).",
        output(".yaml", ".yml"),
    )
    plot: Path | None = plot_file("Plot the trace with its fit and residuals, or the likelihood over the grid")
    idle = (
        Idle("on a trace: give {tests}", lambda asked: asked.free is not None,
             ("slenderness", "restitution", "points", "neighbours", "jobs", *ReadsRecords.model_fields)),
        Idle("without a trace, as outcomes alone leave slenderness and restitution open: give {free}",
             lambda asked: asked.free is None, ("free_geometry", "out")),
    )  # fmt: skip

    @model_validator(mode="after")
    def _of_one(self) -> Self:
        """Refuse both a trace and tests, or neither."""
        if (self.free is None) == (self.tests is None):
            free, tests = named("free"), named("tests")
            raise InputError(f"give either {free}, a trace of free rocking, or {tests}, a table of shake-table tests")
        return self
