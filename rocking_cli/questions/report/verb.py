"""`rk.report`: write a report on a structure as a page of HTML, as PDF, or for a word processor."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import language_of, site_of, structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import RockingError
from rocking_cli.questions.report.asked import ReportAsked
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.report.document import PageOf
    from rocking_cli.questions.report.study import Assessment, MotionResult
    from rocking_cli.structure import Structure
    from rocking_cli.studies.neighbours import Neighbourhood


@verb(ReportAsked)
def report(asked: ReportAsked, watch: Watcher) -> Answer[Assessment]:
    """Write a report: one HTML file that opens in any browser and can be printed, a PDF, or a .docx file.

    Returns
    -------
    Answer of Assessment
        Contents of the report.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be read or written.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The report contains the results of `equiv`, `respond`, `margin`, `overturning_map` and `linearisation`, and those
    of `verify` if a site is given.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.report(rk.Block(width=0.7, height=2.8))
    >>> answer.has_block
    True
    """
    from rocking_cli.questions.report.document import VerifiedReport, document
    from rocking_cli.questions.report.study import gather
    from rocking_cli.questions.report.view import view
    from rocking_cli.questions.verify import sheets
    from rocking_cli.studies.neighbours import Conditions
    from rocking_cli.verification.check import refuse, with_histories
    from rocking_cli.verification.check import verify as study
    from rocking_cli.verification.results import Histories
    from rocking_cli.views.sheet.build import sheet_of

    requested, around = asked.ground_motions, asked.neighbourhood(asked.neighbours)
    site = site_of(asked.verify) if asked.verify is not None else None
    language = language_of(asked.language, site, watch)
    if site is not None:  # checked before long computations
        sheet_of(site)
        refuse(site, motions=bool(requested))
    ready = structure_of(asked.structure, watch, asked.opening, asked.restitution)
    page_of = _page_of(asked, ready, around) if asked.explore else None
    source = sheets.SheetOrigin.of(asked.origin or "rocking_cli.report(...)", ready)
    title = asked.title(source.command, language)
    chosen = requested.gather(ready.growth, watch) if requested else []
    verified = None
    if asked.verify is not None and site is not None:
        refused = requested.refused(chosen)
        histories = Histories(chosen, asked.signs, asked.state, asked.on_floor, refused=refused)
        verification = study(ready, site)
        if chosen:
            verification = with_histories(verification, ready, site, histories)
        sheet = sheets.sheet_for(verification, site, asked.verify, chosen, language, title, source)
        verified = VerifiedReport(verification, sheet)
    conditions = Conditions(ready, ready.default_models, asked.signs, around=around)
    with watch.progress(len(chosen) + 2, "parts of the report") as advance:
        content = gather(conditions, source.structure, chosen, title=title, progress=advance)
    if asked.out is not None:
        made = sheets.sources(ready.mechanism, asked.verify, chosen, source, site)
        try:
            sheets.write(asked.out, document(content, made, verified, language, page_of), watch, by_browser=True)
        except RockingError as error:
            watch.unwritten(error)
    shown = view(content, verified.found if verified is not None else None, language)
    figure = drawn("plotting.structure.draw_structure", content.picture, heading(content.mechanism))
    return Answer("report", content, shown, partial(_columns, content), figure)


def _page_of(asked: ReportAsked, ready: Structure, around: Neighbourhood) -> PageOf:
    """Return what writes the page on a structure under one of the motions. Raises `InputError` if none can be."""
    from rocking_cli.questions.explore.asked import options_of
    from rocking_cli.questions.explore.page import page
    from rocking_cli.questions.explore.study import Exploration, check

    check(ready)

    def written(result: MotionResult) -> str:
        history, options = result.runs[result.polarity]["nonlinear"], options_of(asked, result.given)
        return page(Exploration([ready], result.given, result.polarity, around, [history], "", options))

    return written


def _columns(found: Assessment) -> Columns:
    runs = [(each.given.motion.name, each.histories["nonlinear"]) for each in found.results]
    return {
        "motion": [name for name, _ in runs],
        "peak_ratio": [run.peak_ratio for _, run in runs],
        "overturned": [run.overturned for _, run in runs],
        "unknown": [run.unknown for _, run in runs],
    }
