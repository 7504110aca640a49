"""`rk.score`: score stated shares of overturning against shake-table tests."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.ground_motions import Motions, files_of, pulse_in
from rocking_cli.ask.groups import ReadsRecords
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, RockingError, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.questions.score.asked import ScoreAsked
from rocking_cli.structure import Structure, check_opening

if TYPE_CHECKING:
    from rocking_cli.questions.score.study import Scored
    from rocking_cli.questions.score.table import TableOfTests

MAX_NAMED_TESTS = 20  # tests that cannot be simulated, in a message
MAX_RECORDS_IN_MEMORY = 16  # tests under one record are simulated together


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

    Examples
    --------
    >>> import rocking_cli as rk
    >>> motions = ["sine:0.2g:0.8s", "sine:0.3g:0.8s", "sine:0.6g:0.8s"]
    >>> tests = {"structure": ["examples/block.yaml"] * 3, "record": motions, "overturned": [0, 0, 1]}
    >>> [each.share for each in rk.score(tests, neighbours=20).tests]
    [0.0, 0.0, 1.0]
    """
    from rocking_cli.questions.score.study import score_tests
    from rocking_cli.questions.score.view import columns, reason, view

    check_opening(asked.opening)
    table = tests_of(asked.tests)
    structures, motion_of = _structures(table, watch, asked.opening), motions_of(table, asked)
    around = asked.neighbourhood(asked.neighbours)
    with watch.progress(len(table.tests), "tests") as advance:
        result = score_tests(
            table.tests, partial(_known, structures), motion_of, around, threads=asked.jobs, progress=advance
        )
    for each in result.failed[:MAX_NAMED_TESTS]:
        watch.incomplete(f"{table.file}:{each.test.line}: {reason(each)}")
    if (more := len(result.failed) - MAX_NAMED_TESTS) > 0:
        watch.incomplete(f"{more} more tests could not be simulated: JSON and {named('out')} have their errors")
    figure = drawn("questions.score.picture.draw_reliability", result)
    return Answer("score", result, view(result, table.file), partial(columns, result), figure)


def tests_of(given: str | Path | Mapping[str, Sequence[Any]] | TableOfTests) -> TableOfTests:
    """Read a table of tests from its file, or take its columns. Raises `InputError`."""
    from rocking_cli.questions.score.table import TableOfTests, parse_columns, read_tests

    if isinstance(given, TableOfTests):
        return given
    if isinstance(given, str | Path):
        return read_tests(Path(given))
    return parse_columns(given)


def motions_of(table: TableOfTests, asked: ReadsRecords) -> Callable[[str], GroundMotion]:
    """Return the function that reads the record of a test, or samples its pulse; it keeps the last ones."""
    return lru_cache(MAX_RECORDS_IN_MEMORY)(partial(_motion, table.folder, Motions((), asked.reading.check())))


def _structures(table: TableOfTests, watch: Watcher, opening: float) -> dict[str, Structure | RockingError]:
    """Return each structure, read once, or its error if it cannot be used."""
    structures: dict[str, Structure | RockingError] = {}
    for each in dict.fromkeys(test.structure for test in table.tests):
        try:
            structure = structure_of(table.folder / each, watch, opening)
            structure.model("nonlinear")
            structures[each] = structure
        except RockingError as error:
            structures[each] = error
    return structures


def _known(structures: Mapping[str, Structure | RockingError], name: str) -> Structure:
    structure = structures[name]
    if isinstance(structure, RockingError):
        raise structure
    return structure


def _motion(folder: Path, motions: Motions, name: str) -> GroundMotion:
    """Read the record of a test without warnings of doubts, or sample its pulse."""
    if (pulse := pulse_in(name)) is not None:
        return motions.reading.on_floor(pulse.sampled())
    files = files_of(str(folder / name))
    if len(files) > 1:
        raise InputError(f"{len(files)} motions are given where one is expected: ask for one after the other")
    return motions.read(files[0]).motion
