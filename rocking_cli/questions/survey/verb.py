"""`rk.survey`: rank many structures by vulnerability."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import language_of, site_of, structure_of
from rocking_cli.ask.verbs import verb, write_files
from rocking_cli.ask.watcher import Advance, Watcher
from rocking_cli.errors import InputError, MechanismError, Problem, RockingError, named
from rocking_cli.questions.survey.asked import SurveyAsked
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.text import one_line

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.processing.oscillator import Floor
    from rocking_cli.processing.reading import Scaled
    from rocking_cli.questions.survey.study import Survey, SurveyEntry
    from rocking_cli.studies.provenance import TitleBlock
    from rocking_cli.verification.code import SiteFile
    from rocking_cli.views.sheet.language import Language

MIN_ROWS_FOR_PROCESSES, MIN_ROWS_FOR_PROCESSES_WITH_MOTION = 10_000, 1_000  # rows from which processes pay
SAMPLE_TIME = 3.0  # s of work from which the time of all is known
MAX_NAMED_ROWS = 20  # rows that cannot be used, in a message
MAX_LISTED_DOUBTS = 3  # doubts about sizes that are printed


@verb(SurveyAsked)
def survey(asked: SurveyAsked, watch: Watcher) -> Answer[Survey]:
    """Rank many structures by vulnerability.

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
    from rocking_cli.dynamics.parallel import MAX_PROCESSES
    from rocking_cli.io.tables import PARQUET, XLSX
    from rocking_cli.plotting.style import in_language
    from rocking_cli.questions.survey.inventory import Inventory
    from rocking_cli.questions.survey.study import survey as study
    from rocking_cli.questions.survey.view import blocks, columns, texts_in, title, view
    from rocking_cli.views.cautions import cautions_of

    where = None if asked.site is None else site_of(asked.site)
    language_of(asked.language, where, watch)
    requested = asked.ground_motions
    entries = _entries(asked.structures, requested.reading.floor, watch)
    is_list = isinstance(entries, Inventory)
    for name in () if is_list else ("remedies", "in_space"):
        if asked.has(name):
            raise InputError(Problem("requires a list of objects, by heights, widths and depths", field=named(name)))
    first, by_code = _first_site(entries, where), where is not None or bool(getattr(entries, "sites", ()))
    say = texts_in(language := language_of(asked.language, first, watch))
    if asked.sheets is not None and not by_code:
        raise InputError(f"{named('sheets')} requires a site to verify at: give {named('site')}")
    if asked.hands_over:
        from rocking_cli.questions.survey.director import check, write

        check(asked, entries)
    if asked.in_space:
        from rocking_cli.studies.engines.scene import engine_version

        engine_version()
    scaled = requested.gather(0.0, watch) if requested else []
    shaken = [each.motion.scaled(each.factor) for each in scaled]
    transverse = _transverse(asked, scaled, watch)
    writer = None
    if asked.sheets is not None:
        from rocking_cli.questions.survey.pages import SheetFolder

        writer = SheetFolder(asked.sheets, asked, where, language)
        writer.check(first)
    sheet = getattr(entries, "sheet", None)
    if asked.map is not None:
        from rocking_cli.questions.survey.structure_table import columns_of

        columns_of(sheet)
    shared = (asked.jobs or min(os.cpu_count() or 1, MAX_PROCESSES)) if asked.in_space else None  # threads do not share
    processes = shared or _processes(len(entries), asked.jobs, shaken=bool(shaken) or by_code)
    with watch.progress(len(entries), "structures") as advance:
        result = study(
            entries, shaken, asked.signs, site=where, around=asked.neighbourhood(Neighbourhood.count if shaken else 0),
            bounded=asked.neighbours is None, opening=asked.opening, cautions=cautions_of,
            every_remedy=asked.remedies == "all", in_space=asked.in_space, transverse=transverse, threads=asked.jobs,
            processes=processes if asked.in_processes else None, progress=_timed(advance, len(entries), watch),
        )  # fmt: skip
    _tell_bad(result, "structures" if sheet is None else sheet.file, watch)
    doubts = [f"{one_line(each.name)}: {each.doubt}" for each in result.rows if each.doubt is not None]
    _tell_first(watch.warn, doubts, "{:,} more structures have doubtful sizes: JSON lists them")
    if sheet is not None:  # weights of other structures were noted when they were opened
        remarks = list(dict.fromkeys(remark for each in result.rows for remark in each.remarks))
        _tell_first(watch.note, remarks, "further remarks on how fields were read: {:,}")
    # Spreadsheets open a CSV file, with their decimal sign, or numbers; Parquet keeps the cells that came in.
    suffix = asked.out.suffix.lower() if asked.out is not None else ""
    decimal = {PARQUET: None, XLSX: ""}.get(suffix, asked.decimal or ".")
    figure = in_language(say, drawn("questions.survey.picture.draw_survey", result, title(result)))
    if any(each.danger for each in result.rows):
        figure = drawn("questions.survey.portraits.draw_first", result, say)
    files = partial(blocks, result, decimal)
    answer = Answer("survey", result, view(result, asked.top, say), partial(columns, result), figure, files)
    write_files(answer, asked, watch)
    if asked.page is not None and not asked.has_document:
        source = "structures" if sheet is None else Path(sheet.file).name
        heading = asked.title(asked.origin or "rocking_cli.survey(...)", language)
        _write_page(asked.page, result, source, heading, say, watch)
    if asked.map is not None:
        _write_map(asked.map, result, title(result), say, watch)
    try:
        if asked.hands_over:
            write(asked, result, scaled, language, watch)
        if writer is not None:
            writer.write(result, entries, watch)
    except RockingError as error:
        watch.unwritten(error)
    return answer


def _transverse(asked: SurveyAsked, scaled: Sequence[Scaled], watch: Watcher) -> list[GroundMotion]:
    """Return the components across motions, read and scaled as they are. Raises `InputError` if one lacks another."""
    from rocking_cli.ask.ground_motions import Motions
    from rocking_cli.processing.reading_options import PREPARING

    if asked.transverse is None:
        return []
    read = Motions.of(asked.transverse, asked.in_order_given(PREPARING)).gather(0.0, watch)
    if len(read) != len(scaled):
        what = f"{len(read)} given for {len(scaled)} motions: give one for each, in their order"
        raise InputError(Problem(what, field=named("transverse")))
    return [each.motion.scaled(along.factor) for each, along in zip(read, scaled, strict=True)]


def _tell_bad(found: Survey, file: str, watch: Watcher) -> None:
    """Tell of the rows that cannot be used; raise their errors if none can be."""
    from rocking_cli.questions.survey.view import bad_lines

    lines = [*bad_lines(found.bad, file, MAX_NAMED_ROWS)]
    if lines and not found.rows:
        first = found.bad[0].error
        raise first if isinstance(first, MechanismError) else InputError(*lines)
    for line in lines:
        watch.incomplete(line)


def _entries(given: Any, floor: Floor | None, watch: Watcher) -> Sequence[SurveyEntry]:
    from rocking_cli.questions.survey.inventory import Inventory
    from rocking_cli.questions.survey.structure_table import table_of
    from rocking_cli.questions.survey.study import MadeStructure

    if not isinstance(given, str | Path | Mapping) and not hasattr(given, "columns"):
        return [MadeStructure(structure_of(each, watch).mechanism) for each in given]
    table = table_of(given, floor)
    if not len(table):
        raise InputError(Problem("the table has no rows below its headings", table.sheet.file))
    if table.sheet.encoding == "Windows-1252":
        watch.note(f"{table.sheet.file} is not in UTF-8: read as Windows-1252")
    if others := table.sheet.unread:
        watch.note(f"table: {table.sheet.file}; sheets not read: {', '.join(map(one_line, others))}")
    if short := [row.line for row in table.sheet.rows if row.short]:
        lines = f"line {short[0]}" if len(short) == 1 else f"{len(short):,} lines, first in line {short[0]}"
        watch.warn(f"{table.sheet.file}: fewer cells than headings in {lines}: missing cells are read as empty")
    for note in table.notes if isinstance(table, Inventory) else ():
        watch.note(note)
    return table


def _first_site(entries: Sequence[SurveyEntry], where: SiteFile | None) -> SiteFile | None:
    """Return the first site of a survey; None without one. Raises `InputError` if floors of rows lack a site."""
    from rocking_cli.questions.survey.structure_table import StructureTable

    if where is not None or not isinstance(entries, StructureTable):
        return where
    if entries.of_floor and not entries.sites:
        hint = f"give {named('site')}, or a column site with a site file for each row"
        sheet, heading = entries.sheet, entries.of_floor[0].heading
        raise InputError(Problem("requires a site", sheet.file, sheet.line, field=heading, hint=hint))
    return entries.first_site()


def _processes(rows: int, jobs: int | None, *, shaken: bool) -> int | None:
    """Return the number of processes that share the work; None if threads are as fast."""
    from rocking_cli.dynamics.parallel import MAX_PROCESSES

    count = jobs or min(os.cpu_count() or 1, MAX_PROCESSES)
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


def _tell_first(tell: Callable[[str], None], sentences: Sequence[str], others: str) -> None:
    """Tell the first of some sentences, and the number of the others."""
    for sentence in sentences[:MAX_LISTED_DOUBTS]:
        tell(sentence)
    if len(sentences) > MAX_LISTED_DOUBTS:
        tell(others.format(len(sentences) - MAX_LISTED_DOUBTS))


def _write_map(place: Path, found: Survey, title: str, say: Language, watch: Watcher) -> None:
    from rocking_cli.plotting.style import in_language, write
    from rocking_cli.questions.survey.picture import draw_map
    from rocking_cli.questions.survey.structure_table import coordinates

    where = coordinates(found)
    others = "not on the map: {:,} more structures, for the same reason"
    _tell_first(watch.warn, [f"not on the map: {wrong}" for wrong in where.wrong], others)
    write(place, in_language(say, partial(draw_map, found, where, title))())
    watch.note(f"wrote {place}")


def _write_page(place: Path, found: Survey, table: str, title: TitleBlock, say: Language, watch: Watcher) -> None:
    from rocking_cli import __version__
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.survey.pages import render

    about = [f"{say(name.capitalize())}: {text}." for name, text in title.known.items()]
    about.append(say("Written on {day} with rocking-cli {version}.", day=title.date, version=__version__))
    page = render(found, table, [*about, f"{say('Command')}: {title.command}"], say, title.logo).encode()
    write_whole(place, lambda stream: stream.write(page))
    watch.note(f"wrote {place} ({len(page) / 1e6:.2g} MB)")
