"""Score stated shares of overturning against the outcomes of shake-table tests.

python -m validation.score TESTS.csv [--plot reliability.png] [--out shares.csv] [--json]
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.asked import option
from rocking_cli.ask.ground_motions import Motions, files_of, pulse_in
from rocking_cli.ask.groups import Around, OfJoints, ReadsRecords, WithTable, plot_file, table_file
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.kinds import WHOLE
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, RockingError, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import MAX_NEIGHBOURS
from rocking_cli.structure import Structure, check_opening
from validation.command import Command, run
from validation.picture import draw_reliability
from validation.rules import Scored, score_tests
from validation.table import TableOfTests, parse_columns, read_tests
from validation.view import columns, reason, view

MAX_NAMED_TESTS = 20  # tests that cannot be simulated, in a message
MAX_RECORDS_IN_MEMORY = 16  # tests under one record are simulated together


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
      python -m validation.score tests.csv
      python -m validation.score tests.csv --plot reliability.png --out shares.csv
      python -m validation.score tests.csv --amplitude-deviation 2% --json
    """

    tests: Any = option(
        "A table of tests as a CSV file, whose paths are relative to its folder; or its columns by their headings (a "
        "frame of pandas is one), with paths relative to the current folder; validation/README.md lists the columns.",
        where="input", default=..., typed="TESTS.csv",
    )  # fmt: skip
    neighbours: int = option(
        "Number of neighbouring motions to simulate for each test.", WHOLE, default=200, ge=1, le=MAX_NEIGHBOURS
    )
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, usual="one for each processor")
    out: Path | None = table_file("Write what is stated of each test (.csv or .parquet).", ".csv", ".parquet")
    plot: Path | None = plot_file("Plot observed against stated shares, a reliability diagram")


@verb(ScoreAsked)
def score(asked: ScoreAsked, watch: Watcher) -> Answer[Scored]:
    """Score stated shares of overturning against the outcomes of shake-table tests.

    Returns
    -------
    Answer of Scored
        `tests` are the stated shares, `scores` those of each rule with intervals, `bins` the calibration.

    Raises
    ------
    InputError
        If the table has wrong rows, which the error lists, or a value is out of range.

    Notes
    -----
    An interval is the range from 5 to 95 % of 2000 draws of clusters of tests with replacement.
    """
    check_opening(asked.opening)
    table = tests_of(asked.tests)
    structures = _structures(table, watch, asked.opening)

    def structure_named(name: str) -> Structure:
        structure = structures[name]
        if isinstance(structure, RockingError):
            raise structure
        return structure

    around = asked.neighbourhood(asked.neighbours)
    with watch.progress(len(table.tests), "tests") as advance:
        result = score_tests(
            table.tests, structure_named, motions_of(table, asked), around, threads=asked.jobs, progress=advance
        )
    for each in result.failed[:MAX_NAMED_TESTS]:
        watch.incomplete(f"{table.file}:{each.test.line}: {reason(each)}")
    if (more := len(result.failed) - MAX_NAMED_TESTS) > 0:
        watch.incomplete(f"{more} more tests could not be simulated: JSON and {named('out')} have their errors")
    diagram = partial(draw_reliability, result)
    return Answer("score", result, view(result, table.file), partial(columns, result), diagram)


def tests_of(given: Any) -> TableOfTests:
    """Read a table of tests from its file, or take its columns. Raises `InputError`."""
    return read_tests(Path(given)) if isinstance(given, str | Path) else parse_columns(given)


def motions_of(table: TableOfTests, asked: ReadsRecords) -> Callable[[str], GroundMotion]:
    """Return the function that reads the record of a test, or samples its pulse; it keeps the last ones."""
    return lru_cache(MAX_RECORDS_IN_MEMORY)(partial(_motion, table.folder, Motions((), asked.reading.check())))


def _structures(table: TableOfTests, watch: Watcher, opening: float) -> dict[str, Structure | RockingError]:
    """Return each structure, read once, or its error if it cannot be used."""
    structures: dict[str, Structure | RockingError] = {}
    for file in dict.fromkeys(test.structure for test in table.tests):
        try:
            structure = structure_of(table.folder / file, watch, opening)
            structure.model("nonlinear")
            structures[file] = structure
        except RockingError as error:
            structures[file] = error
    return structures


def _motion(folder: Path, motions: Motions, name: str) -> GroundMotion:
    """Read the record of a test without warnings of doubts, or sample its pulse."""
    if (pulse := pulse_in(name)) is not None:
        return motions.reading.on_floor(pulse.sampled())
    files = files_of(str(folder / name))
    if len(files) > 1:
        raise InputError(f"{len(files)} motions are given where one is expected: ask for one after the other")
    return motions.read(files[0]).motion


command = Command("score", ScoreAsked, score)

if __name__ == "__main__":
    run(command)
