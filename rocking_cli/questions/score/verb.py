"""`rk.score`: score stated shares of overturning against shake-table tests."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import structure_of
from rocking_cli.ask.ground_motions import Motions, ReadingArguments, files_of, pulse_in
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import OPENING
from rocking_cli.processing.reading import reading_of
from rocking_cli.structure import Structure, check_opening
from rocking_cli.studies.neighbours import Neighbourhood

if TYPE_CHECKING:
    from rocking_cli.questions.score.study import Scored
    from rocking_cli.questions.score.table import TableOfTests

MAX_RECORDS_IN_MEMORY = 16  # tests under one record are simulated together


@takes_numbers
def score(
    tests: str | Path | Mapping[str, Sequence[Any]] | TableOfTests,
    *,
    neighbours: int = Neighbourhood.count,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float = OPENING,
    threads: int | None = None,
    usual: Mapping[str, Any] | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[ReadingArguments],
) -> Answer[Scored]:
    """Score stated shares of overturning against the outcomes of shake-table tests.

    Parameters
    ----------
    tests : str or Path, or mapping
        A table of tests as a CSV file, whose paths are relative to its folder; or its columns by their headings (a
        frame of pandas is one), with paths relative to the current folder. The columns are `structure`, `record`,
        `overturned` or `peak`, and optionally `censored`, `scale`, `time_scale`, `polarity`, `cluster`, `half`,
        `motion`, `pgv` and `pred_NAME`; see docs/commands.md.
    neighbours : int
        Number of neighbouring motions to simulate for each test, at least 1.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of each structure.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    threads : int, optional
        Number of tests at a time; by default, one for each processor.
    usual : mapping of str to object, optional
        Options for records that do not state their unit, interval or channel themselves.
    watch : Watcher
        Told how far the work is, and which tests cannot be simulated.
    **options
        How the records are read and corrected: see `rocking_cli.ask.ground_motions.ReadingArguments`.

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
    from rocking_cli.questions.score.view import columns, view

    around = Neighbourhood(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    check_opening(opening)
    table = tests_of(tests)
    structures = _structures(table, watch, opening)
    motion_of = motions_of(table, options, usual)
    with watch.progress(len(table.tests), "tests") as advance:
        result = score_tests(
            table.tests, partial(_known, structures), motion_of, around, threads=threads, progress=advance
        )
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


def motions_of(
    table: TableOfTests, options: ReadingArguments, usual: Mapping[str, Any] | None
) -> Callable[[str], GroundMotion]:
    """Return the function that reads the record of a test, or samples its pulse; it keeps the last ones."""
    motions = Motions((), reading_of(options, usual).check())
    return lru_cache(MAX_RECORDS_IN_MEMORY)(partial(_motion, table.folder, motions))


def _structures(table: TableOfTests, watch: Watcher, opening: float) -> dict[str, Structure | RockingError]:
    """Return each structure, read once, or its error if it cannot be used."""
    structures: dict[str, Structure | RockingError] = {}
    for named in dict.fromkeys(test.structure for test in table.tests):
        try:
            structure = structure_of(table.folder / named, watch, opening)
            structure.model("nonlinear")
            structures[named] = structure
        except RockingError as error:
            structures[named] = error
    return structures


def _known(structures: Mapping[str, Structure | RockingError], named: str) -> Structure:
    structure = structures[named]
    if isinstance(structure, RockingError):
        raise structure
    return structure


def _motion(folder: Path, motions: Motions, named: str) -> GroundMotion:
    """Read the record of a test without warnings of doubts, or sample its pulse."""
    if (pulse := pulse_in(named)) is not None:
        return motions.reading.on_floor(pulse.sampled())
    files = files_of(str(folder / named))
    if len(files) > 1:
        raise InputError(f"{len(files)} motions are given where one is expected: ask for one after the other")
    return motions.read(files[0]).motion
