"""`rocking score`: score stated shares of overturning against shake-table tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import Output, ReadingOptions, read_table
from rocking_cli.cli.help import Command

MAX_NAMED_TESTS = 20  # tests that cannot be simulated, in a message


@click.command(cls=Command, short_help="Score stated shares of overturning against tests.")
@click.argument("file", metavar="TESTS.csv", type=click.Path())
@options.around()
@options.opening
@options.reading
@options.out(".csv", ".parquet", what="Write what is stated of each test (.csv or .parquet).")
@options.plot("Plot observed against stated shares (a reliability diagram)")
@options.as_json
@options.grouped(reading=ReadingOptions, output=Output)
def command(file: str, reading: ReadingOptions, output: Output, **around: Any) -> None:
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
    from rocking_cli.excitation.records.opening import name_of
    from rocking_cli.questions.score.table import parse_tests
    from rocking_cli.questions.score.verb import score
    from rocking_cli.questions.score.view import reason

    output.keep_apart(file)
    table = read_table(file, lambda sheet: parse_tests(sheet, Path()))
    answer = score(table, watch=output.watch, usual=reading.usual, **around, **reading.options)
    failed = answer.failed
    for each in failed[:MAX_NAMED_TESTS]:
        terminal.error(f"{name_of(file)}:{each.test.line}: {reason(each)}")
    if len(failed) > MAX_NAMED_TESTS:
        terminal.error(
            f"{len(failed) - MAX_NAMED_TESTS} more tests could not be simulated: JSON and --out have their errors"
        )
    output.watch.left_out += len(failed)
    output.show(answer)
