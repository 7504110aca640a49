"""What `rocking score` and `rk.score` are asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import Around, OfJoints, ReadsRecords, WithTable, plot_file, table_file
from rocking_cli.ask.kinds import WHOLE
from rocking_cli.names import MAX_NEIGHBOURS

if TYPE_CHECKING:
    from rocking_cli.questions.score.table import TableOfTests
else:  # heavy to import, and not checked by the model
    TableOfTests = Any


class ScoreAsked(Around, OfJoints, ReadsRecords, WithTable):
    """Score the stated shares of overturning against the outcomes of shake-table tests.

    Each row of the table is a test: the file of a `structure`, the file of a `record` or a pulse, and whether it
    `overturned` (0, 1, or empty if not observed), or its `peak` with a unit. Optional columns: `censored` (1: the peak
    was at least this), `scale`, `time_scale`, `polarity` (empty: both, averaged), `cluster` (tests that are not
    independent; by default those of one record), `half`, `motion` (recorded or commanded), `pgv` in m/s, and
    `pred_NAME` with the shares of other predictions. Paths are relative to the table. TESTS.csv may be - for standard
    input.

    The share of neighbours that overturn is compared with the base rate of other tests, with West's rule (PGA above
    lambda g), with the peak velocity over the velocity step that overturns, with a logistic curve over PGV that is
    fitted to other tests, and with each `pred_NAME`. Intervals are 5 to 95 % of 2000 draws of clusters.

    A test whose structure or record cannot be used is reported and is in no score, and the exit code is 5.

    \b
    Example:
      rocking score tests.csv
      rocking score tests.csv --plot reliability.png --out shares.csv
      rocking score tests.csv --amplitude-deviation 2% --json
    """

    tests: str | Path | Mapping[str, Sequence[Any]] | TableOfTests = option(
        "A table of tests as a CSV file, whose paths are relative to its folder; or its columns by their headings (a "
        "frame of pandas is one), with paths relative to the current folder; docs/commands.md lists the columns.",
        where="input", default=..., typed="TESTS.csv",
    )  # fmt: skip
    neighbours: int = option(
        "Number of neighbouring motions to simulate for each test.", WHOLE, default=200, ge=1, le=MAX_NEIGHBOURS
    )
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, usual="one for each processor")
    out: Path | None = table_file("Write what is stated of each test (.csv or .parquet).", ".csv", ".parquet")
    plot: Path | None = plot_file("Plot observed against stated shares, a reliability diagram")
