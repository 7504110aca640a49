"""`rk.survey`: rank many structures by vulnerability."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any, Unpack

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import SiteLike, StructureLike, around_of, language_of, site_of, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Advance, Watcher
from rocking_cli.errors import InputError, Problem, RockingError
from rocking_cli.names import OPENING
from rocking_cli.questions.survey.view import DEFAULT_ROWS
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.text import one_line

if TYPE_CHECKING:
    from rocking_cli.questions.survey.structure_table import StructureTable
    from rocking_cli.questions.survey.study import Survey, SurveyEntry
    from rocking_cli.views.sheet.language import Language

TableLike = str | Path | Mapping[str, Sequence[Any]]
"""CSV file, or columns by their headings."""
MIN_ROWS_FOR_PROCESSES, MIN_ROWS_FOR_PROCESSES_WITH_MOTION = 10_000, 1_000  # rows from which processes pay
SAMPLE_TIME = 3.0  # s of work from which the time of all is known
MAX_LISTED_DOUBTS = 3  # doubts about sizes that are printed


@takes_numbers
def survey(
    structures: TableLike | StructureTable | Sequence[StructureLike],
    motions: Motion | Motions | Sequence[Motion] = (),
    *,
    polarity: str | int = "1",
    site: SiteLike | None = None,
    neighbours: int | None = None,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float = OPENING,
    top: int = DEFAULT_ROWS,
    threads: int | None = None,
    processes: bool = False,
    page: str | Path | None = None,
    map: str | Path | None = None,
    sheets: str | Path | None = None,
    sheet_format: str = "html",
    language: str | None = None,
    project: str | None = None,
    place: str | None = None,
    client: str | None = None,
    author: str | None = None,
    logo: str | Path | None = None,
    origin: str | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[Survey]:
    """Rank many structures by vulnerability.

    Parameters
    ----------
    structures : str or Path, or mapping, or sequence of Mechanism, str or Path
        A table of structures as a CSV file, or its columns by their headings (a frame of pandas is one); or structures,
        or their YAML files.
    motions : GroundMotion, Pulse, str or Path, or a sequence of these
        Ground motions; without any, the structures are ranked by their uplift acceleration.
    polarity : {"1", "-1", "both"}
        Polarity of the motions: as given, reversed, or both, of which the worse governs.
    site : mapping, str or Path, optional
        Fields of a site file, or the file: each structure is verified by its code and ranked by the ratio of capacity
        to demand.
    neighbours : int, optional
        Number of neighbouring motions to simulate for each structure and motion, 0 for none; by default 200, or as many
        as take about a minute.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of each structure.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    top : int
        Number of structures in the tables of the answer.
    threads : int, optional
        Number of structures at a time; by default, one for each processor.
    processes : bool
        Whether processes share the work of thousands of structures; a script then needs `if __name__ == "__main__"`.
    page : str or Path, optional
        File for an HTML page with a plot, a map if rows have coordinates, and all rows in a sortable table.
    map : str or Path, optional
        File for a map of the structures by the columns longitude and latitude: .png, .svg or .pdf.
    sheets : str or Path, optional
        Folder for the calculation sheets of the verifications, one for each structure.
    sheet_format : {"html", "docx", "pdf"}
        Format of the sheets; "docx" needs an extra package, "pdf" another one or a browser.
    language : {"en", "it"}, optional
        Language of the answer, the page, plots and sheets; by default that of the site.
    project, place, client, author, logo : str, str, str, str, path, optional
        Entries for the heading of the sheets, and a picture in .png, .jpg or .svg.
    origin : str, optional
        What the sheets say of how they were made; by default this function.
    watch : Watcher
        Told what was read, how far the work is, what is doubtful, and which of several motions cannot be used.
    **options
        How the motions are read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    Answer of Survey
        `rows` are the ranked structures, `bad` the unusable ones with their reasons.

    Raises
    ------
    InputError
        If the table or a motion cannot be used, or a file cannot be written.

    Notes
    -----
    The blocks are those of DeJong and Dimitrakopoulos (2014), Section 3; see `equiv`.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> table = {"mechanism": ["block", "block"], "name": ["a", "b"], "width [mm]": [500, 300], "height": [2, 2]}
    >>> [row.name for row in rk.survey(table).rows]
    ['b', 'a']
    """
    from rocking_cli.plotting.language import in_language
    from rocking_cli.questions.survey.study import survey as study
    from rocking_cli.questions.survey.view import blocks, columns, texts_in, title, view

    if sheets is None:
        head = {"project": project, "place": place, "client": client, "author": author, "logo": logo}
        without = "without calculation sheets: give `sheets`"
        idle = {"sheet_format": sheet_format != "html", "origin": origin}
        refuse_idle(without, **idle, **head)
    elif site is None:
        raise InputError("`sheets` requires a site to verify at: give `site`")
    signs, where = signs_of(polarity), site_of(site) if site is not None else None
    say = texts_in(language := language_of(language, where, watch))
    entries, requested = _entries(structures, watch), Motions.of(motions, options)
    if not requested:
        refuse_idle("without ground motions", polarity=signs != (1,), opening=opening != OPENING, neighbours=neighbours)
    count = Neighbourhood.count if neighbours is None and requested else neighbours or 0
    around = around_of(count, amplitude_deviation, restitution_deviation, slenderness_deviation)
    shaken = [each.motion.scaled(each.factor) for each in requested.gather(0.0, watch)] if requested else []
    writer = None
    if sheets is not None and site is not None and where is not None:
        from rocking_cli.questions.survey.sheets import SheetFolder
        from rocking_cli.questions.verify.sheets import Head

        titled = Head(project, place, client, author, logo)
        call = origin or "rocking_cli.survey(...)"
        writer = SheetFolder(Path(sheets), where, site, f".{sheet_format}", language, titled, call)
        writer.check()
    if map is not None:
        from rocking_cli.questions.survey.coordinates import columns_of

        columns_of(getattr(entries, "sheet", None))
    processes_used = _processes(len(entries), bool(shaken) or where is not None) if processes else None
    with watch.progress(len(entries), "structures") as advance:
        result = study(
            entries, shaken, signs, site=where, around=around, bounded=neighbours is None, opening=opening,
            threads=threads, processes=processes_used, progress=_timed(advance, len(entries), watch),
        )  # fmt: skip
    _warn_of_sizes(result, watch)
    if hasattr(entries, "sheet"):  # a table: weights of other structures were noted when they were opened
        _note_remarks(result, watch)
    if page is not None and result.rows:
        file = getattr(entries, "sheet", None)
        _write_page(Path(page), result, Path(file.file).name if file is not None else "structures", say, watch)
    if map is not None and result.rows:
        _write_map(Path(map), result, title(result), say, watch)
    if writer is not None and result.rows:
        try:
            writer.write(result, entries, watch)
        except RockingError as error:
            watch.unwritten(error)
    figure, files = (
        in_language(say, drawn("questions.survey.picture.draw_survey", result, title(result))),
        partial(blocks, result, "."),
    )
    return Answer("survey", result, view(result, top, say), partial(columns, result), figure, files)


def _entries(given: Any, watch: Watcher) -> Sequence[SurveyEntry]:
    from rocking_cli.questions.survey.structure_table import StructureTable, of_mapping
    from rocking_cli.questions.survey.study import MadeStructure

    table = StructureTable.read(Path(given)) if isinstance(given, str | Path) else given
    if not isinstance(table, StructureTable):
        if isinstance(given, Mapping) or hasattr(given, "columns"):
            return of_mapping(given)
        return [MadeStructure(structure_of(each, watch).mechanism) for each in given]
    if not len(table):
        raise InputError(Problem("the table has no rows below its headings", table.sheet.file))
    if table.sheet.encoding == "Windows-1252":
        watch.note(f"{table.sheet.file} is not in UTF-8: read as Windows-1252")
    if short := table.short:
        lines = f"line {short[0]}" if len(short) == 1 else f"{len(short):,} lines, first in line {short[0]}"
        watch.warn(f"{table.sheet.file}: fewer cells than headings in {lines}: missing cells are read as empty")
    return table


def _processes(rows: int, shaken: bool) -> int | None:
    """Return the number of processes that share the work; None if threads are as fast."""
    from rocking_cli.dynamics.parallel import MAX_PROCESSES

    count = min(os.cpu_count() or 1, MAX_PROCESSES)
    if count < 2 or rows < (MIN_ROWS_FOR_PROCESSES_WITH_MOTION if shaken else MIN_ROWS_FOR_PROCESSES):
        return None
    return count


def _timed(advance: Advance, count: int, watch: Watcher) -> Callable[[int], None]:
    """Return a function that counts structures, and says once how long all take if that is more than a minute."""
    began, done, known = 0.0, 0, False

    def progress(new: int) -> None:
        nonlocal began, done, known
        advance(new)
        if not began:  # what starts the work is not of each structure
            began = monotonic()
            return
        done += new
        took = monotonic() - began
        if known or took < SAMPLE_TIME:
            return
        known = True
        if (minutes := took / done * count / 60) > 1:
            watch.note(f"{count:,} structures: about {minutes:.0f} minutes; Ctrl-C stops it")

    return progress


def _warn_of_sizes(found: Survey, watch: Watcher) -> None:
    doubtful = [each for each in found.rows if each.doubt is not None]
    for each in doubtful[:MAX_LISTED_DOUBTS]:
        watch.warn(f"{one_line(each.name)}: {each.doubt}")
    if len(doubtful) > MAX_LISTED_DOUBTS:
        watch.warn(f"{len(doubtful) - MAX_LISTED_DOUBTS:,} more structures have doubtful sizes: JSON lists them")


def _note_remarks(found: Survey, watch: Watcher) -> None:
    remarks = list(dict.fromkeys(remark for each in found.rows for remark in each.remarks))
    for remark in remarks[:MAX_LISTED_DOUBTS]:
        watch.note(remark)
    if len(remarks) > MAX_LISTED_DOUBTS:
        watch.note(f"further remarks on how fields were read: {len(remarks) - MAX_LISTED_DOUBTS:,}")


def _write_map(place: Path, found: Survey, title: str, say: Language, watch: Watcher) -> None:
    from rocking_cli.plotting.style import write
    from rocking_cli.questions.survey.coordinates import coordinates
    from rocking_cli.questions.survey.map_picture import draw_map

    where = coordinates(found)
    for wrong in where.wrong[:MAX_LISTED_DOUBTS]:
        watch.warn(f"not on the map: {wrong}")
    if len(where.wrong) > MAX_LISTED_DOUBTS:
        watch.warn(f"not on the map: {len(where.wrong) - MAX_LISTED_DOUBTS:,} more structures, for the same reason")
    from rocking_cli.plotting.language import in_language

    write(place, in_language(say, partial(draw_map, found, where, title))())
    watch.note(f"wrote {place}")


def _write_page(place: Path, found: Survey, table: str, say: Language, watch: Watcher) -> None:
    from rocking_cli import __version__
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.survey.page import render

    written = say("Written on {day} with rocking-cli {version}.", day=say.today(), version=__version__)
    page = render(found, table, [written], say).encode()
    write_whole(place, lambda stream: stream.write(page))
    watch.note(f"wrote {place} ({len(page) / 1e6:.2g} MB)")
